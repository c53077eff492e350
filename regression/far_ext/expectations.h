// SPDX-License-Identifier: Apache-2.0
//
// Expectations of the values that a refiner computes.  Each of these functions fails the
// running test with a fatal failure.
#ifndef OPENSUBDIVHEX_REGRESSION_FAR_EXT_EXPECTATIONS_H
#define OPENSUBDIVHEX_REGRESSION_FAR_EXT_EXPECTATIONS_H

#include "referenceMatch.h"
#include "taggedMatch.h"
#include "valueLevels.h"

#include "far_ext/stencilTableFactory.h"

namespace OpenSubdivHex::Regression {

/// The difference that the arithmetic of one row of weights may make.
template <typename REAL>
inline constexpr double kRowTolerance = sizeof(REAL) == 8 ? 1e-12 : 2e-6;

/// Every level passes its own checks.
void ExpectValid(FarExt::TopologyRefiner const &refiner);

/// \brief Children have the numbers that INDEXING.md gives them, whatever step but truncation makes
/// them, and know their parents; face-uniform data follows the parents.
void ExpectNumbering(FarExt::TopologyRefiner const &refiner);

/// \brief All levels of a mesh equal the reference: topology, numbering (but for truncation, which has
/// a numbering of its own), and vertex data with each mask and varying data as ExpectVertexValuesEqual()
/// and ExpectVaryingValuesEqual() have it.
void ExpectMeshEqual(Shape const &shape, int numLevels, Sdc::Options options = Sdc::Options(),
                     FarExt::HexSchemeOptions const &schemeOptions = FarExt::HexSchemeOptions());

/// Rows that the reference does not know (values that no corner has) are skipped.
void ExpectLevelsEqual(std::vector<ReferenceValues> const &actual,
                       std::vector<ReferenceValues> const &expected, double tolerance);

/// \brief The stencils of one mode applied to their sources give \p levels.
/// \param flags  bits of generateControlVerts, generateIntermediateLevels and
///               factorizeIntermediateLevels
template <typename REAL>
void ExpectTable(FarExt::TopologyRefiner const &refiner, std::vector<ReferenceValues> const &levels,
                 FarExt::StencilMode mode, int channel, int flags);

/// Vertex data of \p refiner, which has \p mask: refined primvars and stencil tables of both
/// precisions against the reference.
void ExpectVertexValuesEqual(FarExt::TopologyRefiner const &refiner, TaggedMatch const &match,
                             ReferenceMask mask, ReferenceValues const &base);

/// Compares varying data.
void ExpectVaryingValuesEqual(FarExt::TopologyRefiner const &refiner, TaggedMatch const &match,
                              ReferenceValues const &base);

/// Compares the face-varying channel that \p match is of.
void ExpectChannelValuesEqual(FarExt::TopologyRefiner const &refiner, TaggedMatch const &match,
                              ReferenceMask mask, ReferenceValues const &base, int channel);

} // namespace OpenSubdivHex::Regression

#endif

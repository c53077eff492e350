// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_FAR_EXT_REFERENCE_MATCH_H
#define OPENSUBDIVHEX_REGRESSION_FAR_EXT_REFERENCE_MATCH_H

#include "far_ext/topologyRefinerFactory.h"
#include "regression/reference/reference.h"
#include "regression/shapes/shapes.h"

#include <memory>
#include <string>
#include <vector>

namespace OpenSubdivHex::Regression {

inline constexpr ReferenceMask kMasks[] = {ReferenceMask::Average, ReferenceMask::Cosine,
                                           ReferenceMask::Smooth};

FarExt::FaceMask ToFaceMask(ReferenceMask mask);
char const *ToString(ReferenceMask mask);

/// The library's refiner of a shape, with all relations in its last level too; \p mask takes the
/// place of that of \p schemeOptions.
std::unique_ptr<FarExt::TopologyRefiner>
CreateRefiner(Shape const &shape, ReferenceMask mask, int level,
              Sdc::Options options = Sdc::Options(),
              FarExt::HexSchemeOptions schemeOptions = FarExt::HexSchemeOptions());

/// The positions of a shape, a row per vertex.
ReferenceValues GetPositions(Shape const &shape);

/// The largest absolute value, the scale of tolerances.
double GetSize(ReferenceValues const &values);

/// \brief A shape refined by the reference, and which of the library's components its components
/// are.  The matching uses what each component was made from, never positions.
class ReferenceMatch {
public:
    /// Refines to \p numLevels levels above the base.  Failures to match are reported by
    /// GetError().
    ReferenceMatch(Shape const &shape, int numLevels);

    /// Empty when every component has its partner.
    std::string const &GetError() const { return _error; }

    int GetMaxLevel() const { return int(_levels.size()) - 1; }
    ReferenceMesh const &GetMesh(int level) const { return _levels[level].mesh; }
    ReferenceLevel const &GetLevel(int level) const { return _levels[level]; }

    /// The library's numbers of the reference's vertices and faces.
    std::vector<int> const &GetVertices(int level) const { return _vertices[level]; }
    std::vector<int> const &GetFaces(int level) const { return _faces[level]; }

    /// Values of all levels from those of the base, rows in the library's order of vertices.
    std::vector<ReferenceValues> InterpolateAll(ReferenceMask mask,
                                                ReferenceValues const &base) const;
    std::vector<ReferenceValues> InterpolateVaryingAll(ReferenceValues const &base) const;

private:
    bool matchLevel(FarExt::TopologyLevel const &pLevel, int level);
    ReferenceValues toLibraryOrder(ReferenceValues const &values, int level) const;

    std::vector<ReferenceLevel> _levels;
    std::vector<std::vector<int>> _vertices;
    std::vector<std::vector<int>> _faces;
    std::string _error;
};

} // namespace OpenSubdivHex::Regression

#endif

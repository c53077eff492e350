// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_FUZZ_ORACLE_CASE_H
#define OPENSUBDIVHEX_REGRESSION_FUZZ_ORACLE_CASE_H

#include "far_ext/topologyRefiner.h"
#include "regression/reference/reference.h"
#include "regression/shapes/shapes.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace OpenSubdivHex::Regression {

/// \brief A base mesh, how it is refined, and what of the much that could be compared is.
struct OracleCase {
    Shape shape;
    Sdc::Options sdcOptions;
    ReferenceMask mask = ReferenceMask::Average;
    FarExt::SchemeType schemeType = FarExt::SchemeType::Hexagonal;
    FarExt::FirstStep firstStep = FarExt::FirstStep::Same;
    int level = 1;
    bool isCoplanar = false;
    double angleTolerance = 0.1; ///< of a coplanar refinement
    bool closeGaps = true;       ///< of a coplanar refinement
    unsigned checks = 0;         ///< a number that all choices of checks follow from

    /// \brief Returns the difference by which equal values may differ, as a part of their size: \p rounding, but with
    /// Chaikin's rule more.
    ///
    /// Chaikin's rule makes means of sharpness, floats whose last bits depend on the order of a sum.
    double GetTolerance(double rounding) const;
};

/// Any bytes make a case.  Its mesh is what a Far::TopologyDescriptor may hold: no index is out of
/// range, but faces may join in any way, and a face may have a vertex twice.
OracleCase MakeOracleCase(std::uint8_t const *data, std::size_t size);

/// C++ statements that make the case.
std::string Print(OracleCase const &oracleCase);

/// \brief Takes away faces, vertices, tags, channels, levels and options while \p fails is true of
/// what is left.
OracleCase Shrink(OracleCase oracleCase, std::function<bool(OracleCase const &)> const &fails);

/// The refiner of a case, refined, all relations in its last level too; null with a status if it is
/// refused.
std::unique_ptr<FarExt::TopologyRefiner> CreateRefiner(OracleCase const &oracleCase,
                                                       FarExt::CallStatus *status);

} // namespace OpenSubdivHex::Regression

#endif

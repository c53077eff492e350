// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_FAR_EXT_EXPECTED_ROWS_H
#define OPENSUBDIVHEX_REGRESSION_FAR_EXT_EXPECTED_ROWS_H

#include "far_ext/limit/rowSteps.h"
#include "far_ext/topologyRefiner.h"
#include "far_ext/vtr/hierarchy.h"

#include <gtest/gtest.h>

namespace OpenSubdivHex::Regression {

/// Makes rows of the last level of a refiner, which are not found yet.
inline FarExt::internal::LimitRows MakeLimitRows(FarExt::TopologyRefiner const &refiner) {
    auto const &level = refiner.GetHierarchy().mesh.levels[std::size_t(refiner.GetMaxLevel())];
    return {level, refiner.GetSchemeOptions(), refiner.GetHexSchemeOptions()};
}

/// The limit at vertices of the last level, from that level, as rows in terms of a level before.
class ExpectedRows {
public:
    ExpectedRows(FarExt::TopologyRefiner const &refiner, int level)
        : _refiner(refiner), _level(level), _rows(MakeLimitRows(refiner)) {
        EXPECT_TRUE(_rows.Find().IsOk());
    }

    /// Expects that the row of a vertex is \p row.
    void Expect(Far::Index vert, FarExt::internal::SteppedRow const &row) const {
        Far::Index sources[FarExt::internal::PlainNeighborhoodGatherer::kNumRegular];
        FarExt::internal::SteppedRow left = FarExt::internal::StepRowBack(
            _refiner.GetHierarchy().mesh, _refiner.GetHexSchemeOptions(),
            _rows.GetRow(vert, 0, sources), _refiner.GetMaxLevel(), _level);
        for (auto const &[source, weights] : row) {
            for (std::size_t i = 0; i < weights.size(); ++i) {
                left[source][i] -= weights[i];
            }
        }
        for (auto const &[source, weights] : left) {
            for (double const weight : weights) {
                ASSERT_NEAR(weight, 0, 1e-8) << "vertex " << vert << ", source " << source;
            }
        }
    }

private:
    FarExt::TopologyRefiner const &_refiner;
    int const _level;
    FarExt::internal::LimitRows _rows;
};

} // namespace OpenSubdivHex::Regression

#endif

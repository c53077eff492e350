// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_FAR_EXT_PROPERTIES_H
#define OPENSUBDIVHEX_REGRESSION_FAR_EXT_PROPERTIES_H

#include "referenceMatch.h"
#include "valueLevels.h"

#include "regression/shapes/featureShapes.h"

#include <gtest/gtest.h>

namespace OpenSubdivHex::Regression {

inline constexpr auto kNone = Sdc::Options::VTX_BOUNDARY_NONE;
inline constexpr auto kEdgeOnly = Sdc::Options::VTX_BOUNDARY_EDGE_ONLY;
inline constexpr auto kEdgeAndCorner = Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER;
inline constexpr float kInfinite = 10;

inline Sdc::Options MakeBoundaryOptions(Sdc::Options::VtxBoundaryInterpolation rule) {
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(rule);
    return options;
}

/// Calls check(shape, options) for each feature shape, boundary rule and creasing method.
template <typename CHECK>
void ForEachFeature(CHECK const &check) {
    for (Shape const &shape : GetFeatureShapes()) {
        for (auto rule : {kNone, kEdgeOnly, kEdgeAndCorner}) {
            for (auto method : {Sdc::Options::CREASE_UNIFORM, Sdc::Options::CREASE_CHAIKIN}) {
                SCOPED_TRACE(testing::Message()
                             << shape.name << ", boundary " << rule << ", creases " << method);
                Sdc::Options options = MakeBoundaryOptions(rule);
                options.SetCreasingMethod(method);
                check(shape, options);
                if (testing::Test::HasFatalFailure()) {
                    return;
                }
            }
        }
    }
}

inline std::vector<ReferenceValues> RefinePositions(Shape const &shape, ReferenceMask mask,
                                                    int numLevels, Sdc::Options options) {
    return InterpolateLevels(*CreateRefiner(shape, mask, numLevels, options), GetPositions(shape));
}

} // namespace OpenSubdivHex::Regression

#endif

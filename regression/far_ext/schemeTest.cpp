// SPDX-License-Identifier: Apache-2.0
//
// Doo-Sabin, tri-hex, and a tri-hex step first: every shape against the reference.
#include "expectations.h"

#include "regression/shapes/featureShapes.h"
#include "regression/shapes/flatShapes.h"

#include <gtest/gtest.h>

namespace OpenSubdivHex::Regression {

using FarExt::FaceKind;
using FarExt::SchemeOptions;
using FarExt::SchemeType;
using FarExt::TopologyLevel;

namespace {

struct NamedScheme {
    char const *name;
    SchemeType schemeType;
    bool triHexFirst;
};

constexpr NamedScheme kSchemes[] = {{"Doo-Sabin", SchemeType::DooSabin, false},
                                    {"tri-hex", SchemeType::TriHex, false},
                                    {"tri-hex, then hexagonal", SchemeType::Hexagonal, true},
                                    {"tri-hex, then Doo-Sabin", SchemeType::DooSabin, true}};

constexpr Sdc::Options::VtxBoundaryInterpolation kBoundaries[] = {
    Sdc::Options::VTX_BOUNDARY_NONE, Sdc::Options::VTX_BOUNDARY_EDGE_ONLY,
    Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER};

std::unique_ptr<FarExt::TopologyRefiner> createRefiner(Shape const &shape, ReferenceMask mask,
                                                       NamedScheme const &scheme, int level,
                                                       Sdc::Options options = Sdc::Options()) {
    SchemeOptions schemeOptions;
    schemeOptions.schemeType = scheme.schemeType;
    schemeOptions.triHexFirst = scheme.triHexFirst;
    return CreateRefiner(shape, mask, level, options, schemeOptions);
}

/// Calls check(shape, scheme, options) for all shapes without flaws, and without their channels.
template <typename CHECK>
void forEach(CHECK const &check) {
    for (auto const *shapes : {&GetManifoldShapes(), &GetFlatShapes()}) {
        for (Shape shape : *shapes) {
            shape.fvarChannels.clear();
            for (NamedScheme const &scheme : kSchemes) {
                for (auto boundary : kBoundaries) {
                    if (shape.closed && boundary != Sdc::Options::VTX_BOUNDARY_NONE) {
                        continue;
                    }
                    SCOPED_TRACE(testing::Message()
                                 << shape.name << ", " << scheme.name << ", boundary " << boundary);
                    Sdc::Options options;
                    options.SetVtxBoundaryInterpolation(boundary);
                    check(shape, scheme, options);
                    if (testing::Test::HasFatalFailure()) {
                        return;
                    }
                }
            }
        }
    }
}

} // namespace

TEST(Scheme, EqualsReference) {
    forEach([](Shape const &shape, NamedScheme const &scheme, Sdc::Options options) {
        int const numLevels = GetTestLevel(shape, 3, 6000);
        auto const topology =
            createRefiner(shape, ReferenceMask::Average, scheme, numLevels, options);
        TaggedMatch const match(shape, *topology);
        ASSERT_EQ(match.GetError(), "");
        ASSERT_NO_FATAL_FAILURE(ExpectValid(*topology));
        ReferenceValues const positions = GetPositions(shape);
        for (ReferenceMask mask : kMasks) {
            SCOPED_TRACE(ToString(mask));
            auto const refiner = createRefiner(shape, mask, scheme, numLevels, options);
            ASSERT_NO_FATAL_FAILURE(ExpectVertexValuesEqual(*refiner, match, mask, positions));
        }
        ASSERT_NO_FATAL_FAILURE(ExpectVaryingValuesEqual(*topology, match, positions));
    });
}

} // namespace OpenSubdivHex::Regression

// SPDX-License-Identifier: Apache-2.0
//
// RefinementEvaluator against stencil tables in double precision and against PrimvarRefiner.
#include "evaluators.h"
#include "guardedArray.h"

#include "far_ext/primvarRefiner.h"
#include "far_ext/stencilTableFactory.h"
#include "far_ext/topologyRefinerFactory.h"
#include "osd_ext/refinementEvaluator.h"
#include "regression/shapes/featureShapes.h"
#include "regression/shapes/flatShapes.h"
#include "regression/shapes/shapeDescriptor.h"
#include "regression/shapes/torus.h"

#include <opensubdiv/osd/cpuVertexBuffer.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

namespace OpenSubdivHex::Regression::refinementEvaluatorTest {

using FarExt::FaceMask;
using FarExt::TopologyRefiner;
using OsdExt::RefinementEvaluator;

namespace {

constexpr FaceMask kMasks[] = {FaceMask::Average, FaceMask::Cosine, FaceMask::Smooth};
constexpr Sdc::Options::FVarLinearInterpolation kLinearInterpolations[] = {
    Sdc::Options::FVAR_LINEAR_NONE,          Sdc::Options::FVAR_LINEAR_CORNERS_ONLY,
    Sdc::Options::FVAR_LINEAR_CORNERS_PLUS1, Sdc::Options::FVAR_LINEAR_CORNERS_PLUS2,
    Sdc::Options::FVAR_LINEAR_BOUNDARIES,    Sdc::Options::FVAR_LINEAR_ALL};

/// A few roundings per level, for values up to 1 in size.
constexpr double kTolerance = 1e-6;
constexpr float kGuard = -12345.678f;
constexpr FarExt::HexSchemeOptions kTruncateFirst{FaceMask::Smooth, FarExt::SchemeType::Hexagonal,
                                                  FarExt::FirstStep::Truncate};

/// Without the relations of the last level, which nobody may read.
std::unique_ptr<TopologyRefiner> createRefiner(Shape const &shape,
                                               FarExt::HexSchemeOptions schemeOptions, int level,
                                               Sdc::Options sdcOptions = Sdc::Options()) {
    FarExt::TopologyRefinerFactory::Options options;
    options.hexSchemeOptions = schemeOptions;
    FarExt::CallStatus status;
    ShapeDescriptor const descriptor(shape);
    auto refiner =
        FarExt::TopologyRefinerFactory::Create(descriptor.Get(), sdcOptions, options, &status);
    if (!refiner || !refiner->RefineUniform(level, &status)) {
        throw std::runtime_error(shape.name + ": " + status.GetErrorMessage());
    }
    return refiner;
}

std::unique_ptr<TopologyRefiner> createRefiner(Shape const &shape, FaceMask mask, int level,
                                               Sdc::Options sdcOptions = Sdc::Options()) {
    FarExt::HexSchemeOptions schemeOptions;
    schemeOptions.faceMask = mask;
    return createRefiner(shape, schemeOptions, level, sdcOptions);
}

std::unique_ptr<RefinementEvaluator> createEvaluator(TopologyRefiner const &refiner,
                                                     FarExt::StencilMode mode, int channel = 0) {
    RefinementEvaluator::Options options;
    options.interpolationMode = mode;
    options.fvarChannel = channel;
    return RefinementEvaluator::Create(refiner, options);
}

float controlValue(int element, int k) {
    return float((element * 7919 + k * 3571) % 1009) / 505 - 1;
}

std::vector<float> makeControlValues(int count, int length) {
    std::vector<float> values;
    for (int i = 0; i < count; ++i) {
        for (int k = 0; k < length; ++k) {
            values.push_back(controlValue(i, k));
        }
    }
    return values;
}

Descriptor packed(int length) { return {0, length, length}; }

/// Levels 1 ... L behind one another, packed.
std::vector<float> evaluateAll(RefinementEvaluator &evaluator, int length) {
    std::vector<float> const src = makeControlValues(evaluator.GetNumElements(0), length);
    std::vector<float> dst(std::size_t(evaluator.GetNumElementsAllLevels() * length), kGuard);
    EXPECT_TRUE(
        evaluator.EvaluateAllLevels(src.data(), packed(length), dst.data(), packed(length)));
    return dst;
}

bool haveSameBits(float const *a, float const *b, std::size_t count) {
    return count == 0 || std::memcmp(a, b, count * sizeof(float)) == 0;
}

/// Each level alone has the bits that it has among all, and level 0 is a copy.
void expectSameLevelByLevel(RefinementEvaluator &evaluator, std::vector<float> const &all,
                            int length) {
    std::vector<float> const src = makeControlValues(evaluator.GetNumElements(0), length);
    std::size_t first = 0;
    for (int level = 0; level <= evaluator.GetMaxLevel(); ++level) {
        std::size_t const size = std::size_t(evaluator.GetNumElements(level) * length);
        std::vector<float> dst(size, kGuard);
        ASSERT_TRUE(
            evaluator.Evaluate(src.data(), packed(length), dst.data(), packed(length), level));
        float const *const expected = level == 0 ? src.data() : all.data() + first;
        ASSERT_TRUE(haveSameBits(dst.data(), expected, size)) << "level " << level;
        first += level == 0 ? 0 : size;
    }
    ASSERT_EQ(first, all.size());
}

/// All levels equal a table of double precision.
void expectEqualsTable(TopologyRefiner const &refiner, FarExt::StencilMode mode, int channel,
                       int length) {
    SCOPED_TRACE(testing::Message()
                 << "mode " << mode << ", channel " << channel << ", length " << length);
    FarExt::StencilTableFactoryReal<double>::Options options;
    options.interpolationMode = mode;
    options.fvarChannel = channel;
    auto const table = FarExt::StencilTableFactoryReal<double>::Create(refiner, options);
    auto const evaluator = createEvaluator(refiner, mode, channel);
    ASSERT_TRUE(table && evaluator);
    ASSERT_EQ(evaluator->GetNumElements(0), table->GetNumControlVertices());
    ASSERT_EQ(evaluator->GetNumElementsAllLevels(), table->GetNumStencils());
    std::vector<float> const values = evaluateAll(*evaluator, length);
    for (int i = 0; i < table->GetNumStencils(); ++i) {
        int const offset = table->GetOffsets()[std::size_t(i)];
        for (int k = 0; k < length; ++k) {
            double expected = 0;
            for (int j = offset; j < offset + table->GetSizes()[std::size_t(i)]; ++j) {
                expected += table->GetWeights()[std::size_t(j)] *
                            double(controlValue(table->GetControlIndices()[std::size_t(j)], k));
            }
            ASSERT_NEAR(values[std::size_t(i * length + k)], expected, kTolerance)
                << "element " << i << " float " << k;
        }
    }
    ASSERT_NO_FATAL_FAILURE(expectSameLevelByLevel(*evaluator, values, length));
}

/// Values near the largest float have the bits of small ones but for the exponent, in packed
/// elements and others.
void expectScales(TopologyRefiner const &refiner, FarExt::StencilMode mode, int length) {
    constexpr int kExponent = 127;
    if (refiner.GetMaxLevel() == 0) {
        return; // of a shape that is too large for this test
    }
    auto const evaluator = createEvaluator(refiner, mode);
    std::vector<float> expected = evaluateAll(*evaluator, length);
    for (float &value : expected) {
        value = std::ldexp(value, kExponent);
    }
    for (int stride : {length, length + 1}) {
        Descriptor const desc = {0, length, stride};
        std::vector<float> const small = makeControlValues(evaluator->GetNumElements(0), length);
        std::vector<float> src(std::size_t(evaluator->GetNumElements(0) * stride), kGuard);
        for (std::size_t i = 0; i < small.size(); ++i) {
            src[i / length * stride + i % length] = std::ldexp(small[i], kExponent);
        }
        std::vector<float> dst(std::size_t(evaluator->GetNumElementsAllLevels() * stride));
        ASSERT_TRUE(evaluator->EvaluateAllLevels(src.data(), desc, dst.data(), desc));
        for (std::size_t i = 0; i < expected.size(); ++i) {
            ASSERT_EQ(dst[i / length * stride + i % length], expected[i]) << i;
        }
        int const last = evaluator->GetNumElements(evaluator->GetMaxLevel());
        ASSERT_TRUE(
            evaluator->Evaluate(src.data(), desc, dst.data(), desc, evaluator->GetMaxLevel()));
        for (std::size_t i = 0; i < std::size_t(last * length); ++i) {
            ASSERT_EQ(dst[i / length * stride + i % length],
                      expected[expected.size() - std::size_t(last * length) + i])
                << i;
        }
    }
}

/// Calls check(shape, options) for every shape and boundary rule.
template <class CHECK>
void forEachShape(CHECK const &check) {
    for (Shape const &shape : GetAllShapes()) {
        for (auto boundary : kBoundaries) {
            SCOPED_TRACE(testing::Message() << shape.name << ", boundary " << boundary);
            Sdc::Options options;
            options.SetVtxBoundaryInterpolation(boundary);
            ASSERT_NO_FATAL_FAILURE(check(shape, options));
        }
    }
}

/// Three floats with the interface that Far's primvar refiner asks for.
struct Element {
    void Clear() { std::fill_n(value, 3, 0.0f); }
    void AddWithWeight(Element const &other, float weight) {
        for (int k = 0; k < 3; ++k) {
            value[k] += weight * other.value[k];
        }
    }
    float value[3];
};

/// Where the elements of a source and a destination lie.
struct Layout {
    char const *name;
    Descriptor src;
    Descriptor dst;
    bool isOneBuffer;
    GuardedEnd guardedEnd;
};

std::vector<Layout> makeLayouts(int length, int numSources) {
    int const wide = length + 2;
    int const twice = 2 * length;
    return {
        {"packed", packed(length), packed(length), false, GuardedEnd::Last},
        {"packed, guarded before", packed(length), packed(length), false, GuardedEnd::First},
        {"offsets", {5, length, length}, {2, length, length}, false, GuardedEnd::Last},
        {"source strided", {5, length, length + 3}, packed(length), false, GuardedEnd::Last},
        {"destination strided", packed(length), {2, length, length + 1}, false, GuardedEnd::Last},
        {"behind", packed(length), {numSources * length, length, length}, true, GuardedEnd::Last},
        {"strided behind",
         {1, length, wide},
         {numSources * wide + 2, length, wide},
         true,
         GuardedEnd::First},
        {"side by side", {0, length, twice}, {length, length, twice}, true, GuardedEnd::Last},
    };
}

/// Floats up to the end of the last element, and no more.
std::size_t getNumFloats(Descriptor const &desc, std::int64_t numElements) {
    return std::size_t(desc.offset + (numElements - 1) * desc.stride + desc.length);
}

/// Runs evaluate(src, srcDesc, dst, dstDesc) in the layout: the elements have the bits of
/// \p expected, which is packed, and nothing else changes.
template <class EVALUATE>
void expectInLayout(Layout const &layout, int numSources, std::vector<float> const &expected,
                    EVALUATE const &evaluate) {
    int const length = layout.src.length;
    std::int64_t const numElements = std::int64_t(expected.size()) / length;
    std::vector<float> src(getNumFloats(layout.src, numSources), kGuard);
    for (int i = 0; i < numSources; ++i) {
        for (int k = 0; k < length; ++k) {
            src[std::size_t(layout.src.offset + i * layout.src.stride + k)] = controlValue(i, k);
        }
    }
    std::size_t const numDst = getNumFloats(layout.dst, numElements);
    if (layout.isOneBuffer) {
        src.resize(std::max(src.size(), numDst), kGuard);
    }
    GuardedArray<float> const srcArray(src, layout.guardedEnd);
    std::unique_ptr<GuardedArray<float>> otherArray;
    if (!layout.isOneBuffer) {
        otherArray = std::make_unique<GuardedArray<float>>(std::vector<float>(numDst, kGuard),
                                                           layout.guardedEnd);
    }
    GuardedArray<float> const &dstArray = otherArray ? *otherArray : srcArray;
    std::vector<float> after(dstArray.data(), dstArray.data() + dstArray.size());
    for (std::int64_t i = 0; i < numElements; ++i) {
        for (int k = 0; k < length; ++k) {
            after[std::size_t(layout.dst.offset + i * layout.dst.stride + k)] =
                expected[std::size_t(i * length + k)];
        }
    }
    ASSERT_TRUE(evaluate(srcArray.data(), layout.src, dstArray.data(), layout.dst));
    ASSERT_TRUE(haveSameBits(dstArray.data(), after.data(), after.size()));
}

TEST(RefinementEvaluator, LargeValuesAreAsSmallOnes) {
    forEachShape([](Shape const &shape, Sdc::Options options) {
        for (FaceMask mask : kMasks) {
            auto const refiner = createRefiner(shape, mask, GetTestLevel(shape, 2), options);
            for (int length : {1, 3}) {
                ASSERT_NO_FATAL_FAILURE(expectScales(*refiner, FarExt::INTERPOLATE_VERTEX, length));
            }
            if (!shape.fvarChannels.empty()) {
                ASSERT_NO_FATAL_FAILURE(
                    expectScales(*refiner, FarExt::INTERPOLATE_FACE_VARYING, 2));
            }
        }
    });
}

TEST(RefinementEvaluator, EqualsTables) {
    int seed = 0;
    forEachShape([&](Shape const &shape, Sdc::Options options) {
        int const level = GetTestLevel(shape, 3, 2500);
        for (FaceMask const mask : kMasks) {
            SCOPED_TRACE(int(mask));
            auto const refiner = createRefiner(shape, mask, level, options);
            int const length = 1 + seed++ % 5;
            ASSERT_NO_FATAL_FAILURE(
                expectEqualsTable(*refiner, FarExt::INTERPOLATE_VERTEX, 0, length));
            ASSERT_NO_FATAL_FAILURE(
                expectEqualsTable(*refiner, FarExt::INTERPOLATE_VARYING, 0, 1 + seed % 5));
        }
    });
}

TEST(RefinementEvaluator, EqualsTablesOfCreasesByChaikin) {
    forEachShape([&](Shape const &shape, Sdc::Options options) {
        if (!shape.creaseSharpness.empty()) {
            options.SetCreasingMethod(Sdc::Options::CREASE_CHAIKIN);
            auto const refiner =
                createRefiner(shape, FaceMask::Smooth, GetTestLevel(shape, 3, 2500), options);
            ASSERT_NO_FATAL_FAILURE(expectEqualsTable(*refiner, FarExt::INTERPOLATE_VERTEX, 0, 3));
        }
    });
}

TEST(RefinementEvaluator, EqualsTablesOfFaceVaryingChannels) {
    int seed = 0;
    forEachShape([&](Shape const &shape, Sdc::Options options) {
        for (int channel = 0; channel < int(shape.fvarChannels.size()); ++channel) {
            for (auto const linear : kLinearInterpolations) {
                SCOPED_TRACE(testing::Message() << "linear " << linear);
                options.SetFVarLinearInterpolation(linear);
                auto const refiner =
                    createRefiner(shape, kMasks[seed % 3], GetTestLevel(shape, 3, 2500), options);
                ASSERT_NO_FATAL_FAILURE(expectEqualsTable(
                    *refiner, FarExt::INTERPOLATE_FACE_VARYING, channel, 1 + seed++ % 5));
            }
        }
    });
}

TEST(RefinementEvaluator, EqualsTablesOfOtherSchemes) {
    int seed = 0;
    std::vector<Shape> shapes = GetManifoldShapes();
    shapes.insert(shapes.end(), GetFlatShapes().begin(), GetFlatShapes().end());
    for (Shape &shape : shapes) {
        shape.fvarChannels.clear();
        for (FarExt::HexSchemeOptions schemeOptions :
             {FarExt::HexSchemeOptions{FaceMask::Average, FarExt::SchemeType::DooSabin},
              FarExt::HexSchemeOptions{FaceMask::Average, FarExt::SchemeType::TriHex},
              FarExt::HexSchemeOptions{FaceMask::Average, FarExt::SchemeType::Hexagonal,
                                       FarExt::FirstStep::TriHex},
              FarExt::HexSchemeOptions{FaceMask::Average, FarExt::SchemeType::Hexagonal,
                                       FarExt::FirstStep::Truncate}}) {
            SCOPED_TRACE(testing::Message()
                         << shape.name << ", scheme " << int(schemeOptions.schemeType)
                         << ", first step " << int(schemeOptions.firstStep));
            schemeOptions.faceMask = kMasks[seed % 3];
            auto const refiner = createRefiner(shape, schemeOptions, GetTestLevel(shape, 3, 2500));
            ASSERT_NO_FATAL_FAILURE(
                expectEqualsTable(*refiner, FarExt::INTERPOLATE_VERTEX, 0, 1 + seed++ % 5));
            ASSERT_NO_FATAL_FAILURE(
                expectEqualsTable(*refiner, FarExt::INTERPOLATE_VARYING, 0, 1 + seed % 5));
        }
    }
}

// Lines pass vertices, in half polygons and in faces that they cross.
TEST(RefinementEvaluator, EqualsTablesBehindATruncation) {
    FarExt::HexSchemeOptions schemeOptions;
    schemeOptions.firstStep = FarExt::FirstStep::Truncate;
    int seed = 0;
    forEachShape([&](Shape const &shape, Sdc::Options options) {
        if (options.GetVtxBoundaryInterpolation() == Sdc::Options::VTX_BOUNDARY_NONE) {
            return;
        }
        schemeOptions.faceMask = kMasks[seed % 3];
        auto const refiner =
            createRefiner(shape, schemeOptions, GetTestLevel(shape, 3, 2500), options);
        ASSERT_NO_FATAL_FAILURE(
            expectEqualsTable(*refiner, FarExt::INTERPOLATE_VERTEX, 0, 1 + seed++ % 5));
        ASSERT_NO_FATAL_FAILURE(
            expectEqualsTable(*refiner, FarExt::INTERPOLATE_VARYING, 0, 1 + seed % 5));
        for (int channel = 0; channel < int(shape.fvarChannels.size()); ++channel) {
            ASSERT_NO_FATAL_FAILURE(
                expectEqualsTable(*refiner, FarExt::INTERPOLATE_FACE_VARYING, channel, 2));
        }
    });
}

TEST(RefinementEvaluator, EqualsTablesOfCoplanarRefinements) {
    std::vector<Shape> shapes = GetFeatureShapes();
    shapes.insert(shapes.end(), GetFlatShapes().begin(), GetFlatShapes().end());
    int seed = 0;
    for (Shape const &shape : shapes) {
        SCOPED_TRACE(shape.name);
        Sdc::Options sdcOptions;
        sdcOptions.SetVtxBoundaryInterpolation(kBoundaries[seed % 3]);
        sdcOptions.SetFVarLinearInterpolation(kLinearInterpolations[seed % 6]);
        auto const refiner = createRefiner(shape, kMasks[seed % 3], 0, sdcOptions);
        TopologyRefiner::CoplanarOptions options(GetTestLevel(shape, 3, 2500));
        options.angleTolerance = 30;
        options.closeGaps = seed % 2 == 0;
        ASSERT_TRUE(refiner->RefineCoplanar(shape.positions.data(), options));
        ASSERT_NO_FATAL_FAILURE(
            expectEqualsTable(*refiner, FarExt::INTERPOLATE_VERTEX, 0, 1 + seed++ % 5));
        ASSERT_NO_FATAL_FAILURE(
            expectEqualsTable(*refiner, FarExt::INTERPOLATE_VARYING, 0, 1 + seed % 5));
        for (int channel = 0; channel < int(shape.fvarChannels.size()); ++channel) {
            ASSERT_NO_FATAL_FAILURE(expectEqualsTable(*refiner, FarExt::INTERPOLATE_FACE_VARYING,
                                                      channel, 1 + seed % 5));
        }
    }
}

TEST(RefinementEvaluator, EqualsTablesForEveryLengthAndLevel) {
    for (char const *const name : {"mixedPatch", "prism12", "tetrahedron"}) {
        for (FaceMask const mask : kMasks) {
            for (int level = 0; level <= 4; ++level) {
                SCOPED_TRACE(testing::Message()
                             << name << ", mask " << int(mask) << ", level " << level);
                auto const refiner = createRefiner(GetShape(name), mask, level);
                for (int const length : {1, 2, 3, 4, 5, 6, 7, 8, 9, 12}) {
                    ASSERT_NO_FATAL_FAILURE(
                        expectEqualsTable(*refiner, FarExt::INTERPOLATE_VERTEX, 0, length));
                }
            }
        }
    }
}

/// All levels equal those that interpolate(level, src, dst) makes one from the other.
template <class INTERPOLATE>
void expectEqualsLevels(TopologyRefiner const &refiner, FarExt::StencilMode mode,
                        INTERPOLATE const &interpolate) {
    SCOPED_TRACE(testing::Message() << "mode " << mode);
    auto const evaluator = createEvaluator(refiner, mode);
    std::vector<float> const values = evaluateAll(*evaluator, 3);
    std::vector<Element> src(std::size_t(evaluator->GetNumElements(0)));
    for (std::size_t i = 0; i < src.size(); ++i) {
        for (int k = 0; k < 3; ++k) {
            src[i].value[k] = controlValue(int(i), k);
        }
    }
    float const *value = values.data();
    for (int level = 1; level <= refiner.GetMaxLevel(); ++level) {
        std::vector<Element> dst(std::size_t(evaluator->GetNumElements(level)));
        interpolate(level, src, dst);
        for (Element const &element : dst) {
            for (int k = 0; k < 3; ++k, ++value) {
                ASSERT_NEAR(*value, element.value[k], kTolerance) << "level " << level;
            }
        }
        src = std::move(dst);
    }
}

void expectEqualsPrimvarRefiner(TopologyRefiner const &refiner) {
    FarExt::PrimvarRefiner const primvarRefiner(refiner);
    ASSERT_NO_FATAL_FAILURE(expectEqualsLevels(refiner, FarExt::INTERPOLATE_VERTEX,
                                               [&](int level, auto const &src, auto &dst) {
                                                   primvarRefiner.Interpolate(level, src, dst);
                                               }));
    ASSERT_NO_FATAL_FAILURE(expectEqualsLevels(
        refiner, FarExt::INTERPOLATE_VARYING, [&](int level, auto const &src, auto &dst) {
            primvarRefiner.InterpolateVarying(level, src, dst);
        }));
    if (refiner.GetNumFVarChannels() > 0) {
        ASSERT_NO_FATAL_FAILURE(expectEqualsLevels(
            refiner, FarExt::INTERPOLATE_FACE_VARYING, [&](int level, auto const &src, auto &dst) {
                primvarRefiner.InterpolateFaceVarying(level, src, dst);
            }));
    }
}

TEST(RefinementEvaluator, EqualsPrimvarRefiner) {
    forEachShape([&](Shape const &shape, Sdc::Options options) {
        auto const refiner =
            createRefiner(shape, FaceMask::Cosine, GetTestLevel(shape, 4, 10000), options);
        ASSERT_NO_FATAL_FAILURE(expectEqualsPrimvarRefiner(*refiner));
    });
}

namespace {

constexpr int kManyCorners = 150000;

/// The first level of so many face-vertices that kernels take it in many tiles, in any build.
int getLevelOfManyTiles(Shape const &shape) {
    int level = 0;
    for (int corners = shape.GetNumCorners(); corners <= kManyCorners; corners *= 4) {
        ++level;
    }
    return level;
}

} // namespace

TEST(RefinementEvaluator, EqualsPrimvarRefinerInManyTiles) {
    Sdc::Options sharp;
    sharp.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
    for (Shape const *const shape :
         {&GetShape("cube"), &GetShape("mixedPatch"), &GetShape("prism64"),
          &GetFeatureShape("creasedBall"), &GetFeatureShape("cubeOfCharts")}) {
        SCOPED_TRACE(shape->name);
        for (Sdc::Options const options : {Sdc::Options(), sharp}) {
            auto const refiner =
                createRefiner(*shape, FaceMask::Smooth, getLevelOfManyTiles(*shape), options);
            ASSERT_GT(refiner->GetLevel(refiner->GetMaxLevel()).GetNumFaceVertices(), kManyCorners);
            ASSERT_NO_FATAL_FAILURE(expectEqualsPrimvarRefiner(*refiner));
        }
    }
}

// Where tiles begin anew in each level, or once more after the first.
TEST(RefinementEvaluator, EqualsPrimvarRefinerInManyTilesOfOtherSchemes) {
    FarExt::HexSchemeOptions dooSabin;
    dooSabin.schemeType = FarExt::SchemeType::DooSabin;
    FarExt::HexSchemeOptions triHexFirst;
    triHexFirst.firstStep = FarExt::FirstStep::TriHex;
    FarExt::HexSchemeOptions truncateFirst;
    truncateFirst.firstStep = FarExt::FirstStep::Truncate;
    for (FarExt::HexSchemeOptions const schemeOptions : {dooSabin, triHexFirst, truncateFirst}) {
        auto const refiner = createRefiner(GetShape("prism64"), schemeOptions,
                                           getLevelOfManyTiles(GetShape("prism64")));
        ASSERT_GT(refiner->GetLevel(refiner->GetMaxLevel()).GetNumFaceVertices(), kManyCorners);
        ASSERT_NO_FATAL_FAILURE(expectEqualsPrimvarRefiner(*refiner));
    }
}

TEST(RefinementEvaluator, HasTheSameBitsInEveryLayout) {
    struct Case {
        Shape const &shape;
        int level; // from 4 on all kernels take part
        FarExt::StencilMode mode;
    };
    Case const cases[] = {{GetShape("mixedPatch"), 2, FarExt::INTERPOLATE_VERTEX},
                          {GetShape("mixedPatch"), 4, FarExt::INTERPOLATE_VERTEX},
                          {GetShape("prism12"), 4, FarExt::INTERPOLATE_VERTEX},
                          {GetShape("prism12"), 2, FarExt::INTERPOLATE_VARYING},
                          {GetFeatureShape("creasedBall"), 2, FarExt::INTERPOLATE_VERTEX},
                          {GetFeatureShape("cubeOfCharts"), 2, FarExt::INTERPOLATE_FACE_VARYING}};
    for (Case const &testCase : cases) {
        SCOPED_TRACE(testCase.shape.name);
        auto const refiner = createRefiner(testCase.shape, FaceMask::Cosine, testCase.level);
        auto const evaluator = createEvaluator(*refiner, testCase.mode);
        int const numSources = evaluator->GetNumElements(0);
        for (int length = 1; length <= 9; ++length) {
            std::vector<float> const all = evaluateAll(*evaluator, length);
            std::vector<float> const last(
                all.end() - std::ptrdiff_t(evaluator->GetNumElements(testCase.level) * length),
                all.end());
            for (Layout const &layout : makeLayouts(length, numSources)) {
                SCOPED_TRACE(testing::Message() << layout.name << ", length " << length);
                ASSERT_NO_FATAL_FAILURE(
                    expectInLayout(layout, numSources, all, [&](auto... arguments) {
                        return evaluator->EvaluateAllLevels(arguments...);
                    }));
                ASSERT_NO_FATAL_FAILURE(
                    expectInLayout(layout, numSources, last, [&](auto... arguments) {
                        return evaluator->Evaluate(arguments..., testCase.level);
                    }));
                ASSERT_NO_FATAL_FAILURE(expectInLayout(
                    layout, numSources, makeControlValues(numSources, length),
                    [&](auto... arguments) { return evaluator->Evaluate(arguments..., 0); }));
            }
        }
    }
}

TEST(RefinementEvaluator, HasTheSameBitsOfEachFloatForEveryLength) {
    auto const refiner = createRefiner(GetFeatureShape("creasedBall"), FaceMask::Cosine, 4);
    auto const evaluator = createEvaluator(*refiner, FarExt::INTERPOLATE_VERTEX);
    std::vector<float> const longest = evaluateAll(*evaluator, 9);
    for (int length = 1; length < 9; ++length) {
        std::vector<float> const values = evaluateAll(*evaluator, length);
        for (std::size_t i = 0; i < values.size(); ++i) {
            std::size_t const element = i / std::size_t(length);
            ASSERT_EQ(values[i], longest[element * 9 + i % std::size_t(length)]);
        }
    }
}

TEST(RefinementEvaluator, HasTheSameBitsForAnyNumberOfThreads) {
    // Large enough for several threads.
    struct Case {
        Shape const &shape;
        int level;
        FarExt::StencilMode mode;
        FarExt::HexSchemeOptions schemeOptions;
    };
    FarExt::HexSchemeOptions const plain;
    Case const cases[] = {
        {GetShape("cube"), 8, FarExt::INTERPOLATE_VERTEX, plain},
        {GetShape("cube"), 7, FarExt::INTERPOLATE_VARYING, plain},
        {GetShape("mixedPatch"), 7, FarExt::INTERPOLATE_VERTEX, plain},
        {GetFeatureShape("creasedBall"), 6, FarExt::INTERPOLATE_VERTEX, plain},
        {GetFeatureShape("creasedBall"), 6, FarExt::INTERPOLATE_VERTEX, kTruncateFirst},
        {GetFeatureShape("cubeOfCharts"), 7, FarExt::INTERPOLATE_FACE_VARYING, plain},
        {GetFeatureShape("cubeOfCharts"), 6, FarExt::INTERPOLATE_FACE_VARYING, kTruncateFirst}};
    for (Case const &testCase : cases) {
        SCOPED_TRACE(testCase.shape.name);
        auto const refiner = createRefiner(testCase.shape, testCase.schemeOptions, testCase.level);
        auto const evaluator = createEvaluator(*refiner, testCase.mode);
        for (int const length : {3, 5}) {
            std::vector<float> expected;
            for (int const numThreads : {1, 2, 3, 8}) {
                EvaluatorScope const scope(OsdExt::GetSimdLevel(), numThreads);
                std::vector<float> const values = evaluateAll(*evaluator, length);
                if (numThreads == 1) {
                    expected = values;
                }
                ASSERT_TRUE(haveSameBits(values.data(), expected.data(), expected.size()))
                    << numThreads << " threads, length " << length;
            }
        }
    }
}

TEST(RefinementEvaluator, HasTheSameBitsAtEverySimdLevel) {
    constexpr int kMaxLength = 9;
    struct Case {
        Shape shape;
        int level;
        FarExt::FirstStep firstStep;
    };
    Case const cases[] = {
        {MakeTorus(7, 5, TorusFaces::Quads), 4, FarExt::FirstStep::Same},
        {MakeTorus(7, 5, TorusFaces::Triangles), 4, FarExt::FirstStep::Same},
        {MakeTorus(7, 5, TorusFaces::IrregularTriangles), 4, FarExt::FirstStep::Same},
        {MakeTorus(7, 5, TorusFaces::Triangles), 3, FarExt::FirstStep::Truncate},
        {MakeTiling(Tiling::Triangles, 6, 4), 4, FarExt::FirstStep::Truncate},
        {MakeTiling(Tiling::Quads, 6, 4), 4, FarExt::FirstStep::Same},
        {GetFeatureShape("creasedBall"), 3, FarExt::FirstStep::Truncate}};
    Sdc::Options sharpBorders;
    sharpBorders.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    for (Case const &testCase : cases) {
        SCOPED_TRACE(testing::Message()
                     << testCase.shape.name << ", first step " << int(testCase.firstStep));
        FarExt::HexSchemeOptions schemeOptions;
        schemeOptions.faceMask = FaceMask::Smooth;
        schemeOptions.firstStep = testCase.firstStep;
        auto const refiner =
            createRefiner(testCase.shape, schemeOptions, testCase.level, sharpBorders);
        auto const evaluator = createEvaluator(*refiner, FarExt::INTERPOLATE_VERTEX);
        for (int length = 1; length <= kMaxLength; ++length) {
            std::vector<float> const src = makeControlValues(evaluator->GetNumElements(0), length);
            for (int const stride : {length, length + 1}) {
                std::vector<float> expected;
                for (OsdExt::SimdLevel const simdLevel : GetSimdLevels()) {
                    EvaluatorScope const scope(simdLevel, 1);
                    std::vector<float> values(
                        std::size_t(evaluator->GetNumElementsAllLevels() * stride), kGuard);
                    ASSERT_TRUE(evaluator->EvaluateAllLevels(src.data(), packed(length),
                                                             values.data(), {0, length, stride}));
                    if (simdLevel == OsdExt::SimdLevel::Portable) {
                        expected = values;
                    }
                    ASSERT_TRUE(haveSameBits(values.data(), expected.data(), expected.size()))
                        << OsdExt::GetSimdLevelName(simdLevel) << ", length " << length
                        << ", stride " << stride;
                }
            }
        }
    }
}

TEST(RefinementEvaluator, IsUsedAgainWithOtherLengthsAndLevels) {
    auto const refiner = createRefiner(GetShape("quadGrid"), FaceMask::Average, 3);
    auto const used = createEvaluator(*refiner, FarExt::INTERPOLATE_VERTEX);
    for (int const length : {3, 1, 8, 3, 2}) {
        auto const fresh = createEvaluator(*refiner, FarExt::INTERPOLATE_VERTEX);
        std::vector<float> const expected = evaluateAll(*fresh, length);
        ASSERT_EQ(evaluateAll(*used, length), expected);
        ASSERT_NO_FATAL_FAILURE(expectSameLevelByLevel(*used, expected, length));
    }
}

TEST(RefinementEvaluator, TakesBuffers) {
    auto const refiner = createRefiner(GetShape("mixedPatch"), FaceMask::Average, 2);
    auto const evaluator = RefinementEvaluator::Create(*refiner);
    ASSERT_TRUE(evaluator);
    EXPECT_EQ(&evaluator->GetTopologyRefiner(), refiner.get());
    int const numSources = evaluator->GetNumElements(0);
    std::vector<float> const expected = evaluateAll(*evaluator, 3);
    std::vector<float> const src = makeControlValues(numSources, 3);
    std::unique_ptr<Osd::CpuVertexBuffer> const buffer(
        Osd::CpuVertexBuffer::Create(3, numSources + int(evaluator->GetNumElementsAllLevels())));
    buffer->UpdateData(src.data(), 0, numSources);
    Descriptor const behind(numSources * 3, 3, 3);
    ASSERT_TRUE(evaluator->EvaluateAllLevels(buffer.get(), packed(3), buffer.get(), behind));
    float const *const values = buffer->BindCpuBuffer() + behind.offset;
    EXPECT_TRUE(haveSameBits(values, expected.data(), expected.size()));
    ASSERT_TRUE(evaluator->Evaluate(buffer.get(), packed(3), buffer.get(), behind, 1));
    EXPECT_TRUE(haveSameBits(values, expected.data(), expected.size()));

    Osd::CpuVertexBuffer *const null = nullptr;
    EXPECT_FALSE(evaluator->Evaluate(null, packed(3), buffer.get(), behind, 1));
    EXPECT_FALSE(evaluator->EvaluateAllLevels(buffer.get(), packed(3), null, behind));
}

TEST(RefinementEvaluator, RefusesWhatItCannotEvaluate) {
    auto const refiner = createRefiner(GetShape("cube"), FaceMask::Average, 2);
    auto const evaluator = createEvaluator(*refiner, FarExt::INTERPOLATE_VERTEX);
    std::vector<float> const src = makeControlValues(8, 3);
    std::vector<float> const before(1000, kGuard);
    std::vector<float> dst = before;
    auto const expectRefused = [&](bool isDone, FarExt::CallStatus const &status) {
        EXPECT_FALSE(isDone);
        EXPECT_EQ(status.GetCode(), FarExt::StatusCode::InvalidArgument);
        EXPECT_FALSE(status.GetErrorMessage().empty());
        EXPECT_TRUE(haveSameBits(dst.data(), before.data(), before.size()));
    };
    FarExt::CallStatus status;
    for (int const level : {-1, 3, 1000}) {
        bool const isDone =
            evaluator->Evaluate(src.data(), packed(3), dst.data(), packed(3), level, &status);
        expectRefused(isDone, status);
        EXPECT_EQ(status.GetComponentType(), FarExt::ComponentType::Level);
        EXPECT_EQ(status.GetComponentIndex(), level);
    }
    struct Case {
        float const *src;
        Descriptor srcDesc;
        float *dst;
        Descriptor dstDesc;
    };
    Case const cases[] = {
        {nullptr, packed(3), dst.data(), packed(3)},
        {src.data(), packed(3), nullptr, packed(3)},
        {src.data(), packed(3), dst.data(), packed(2)},
        {src.data(), packed(0), dst.data(), packed(0)},
        {src.data(), {0, -1, 3}, dst.data(), {0, -1, 3}},
        {src.data(), {0, 3, 2}, dst.data(), packed(3)},
        {src.data(), packed(3), dst.data(), {0, 3, 2}},
        {src.data(), {-1, 3, 3}, dst.data(), packed(3)},
        {src.data(), packed(3), dst.data(), {-1, 3, 3}},
    };
    for (Case const &c : cases) {
        status = FarExt::CallStatus();
        expectRefused(evaluator->Evaluate(c.src, c.srcDesc, c.dst, c.dstDesc, 1, &status), status);
        status = FarExt::CallStatus();
        expectRefused(evaluator->EvaluateAllLevels(c.src, c.srcDesc, c.dst, c.dstDesc, &status),
                      status);
    }
    EXPECT_TRUE(evaluator->Evaluate(src.data(), packed(3), dst.data(), packed(3), 1, &status));
    EXPECT_TRUE(status.IsOk());

    dst = before;
    // Also with as many levels as before.
    for (int const level : {1, 2}) {
        ASSERT_TRUE(refiner->RefineUniform(level));
        status = FarExt::CallStatus();
        expectRefused(evaluator->Evaluate(src.data(), packed(3), dst.data(), packed(3), 1, &status),
                      status);
    }
}

TEST(RefinementEvaluator, RefusesChannelsThatAreNotThere) {
    auto const refiner =
        createRefiner(GetFeatureShape("cubeOfCharts"), FaceMask::Average, 1); // two channels
    RefinementEvaluator::Options options;
    options.interpolationMode = FarExt::INTERPOLATE_FACE_VARYING;
    for (int const channel : {-1, 0, 1, 2}) {
        options.fvarChannel = channel;
        FarExt::CallStatus status;
        auto const evaluator = RefinementEvaluator::Create(*refiner, options, &status);
        bool const isThere = channel == 0 || channel == 1;
        EXPECT_EQ(evaluator != nullptr, isThere);
        EXPECT_EQ(status.IsOk(), isThere);
    }
}

} // namespace
} // namespace OpenSubdivHex::Regression::refinementEvaluatorTest

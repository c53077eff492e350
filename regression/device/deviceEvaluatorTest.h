// SPDX-License-Identifier: Apache-2.0
//
// Tests of evaluators of all devices, against RefinementEvaluator.  Each has a program of its own that
// instantiates these tests.
#ifndef OPENSUBDIVHEX_REGRESSION_DEVICE_DEVICE_EVALUATOR_TEST_H
#define OPENSUBDIVHEX_REGRESSION_DEVICE_DEVICE_EVALUATOR_TEST_H

#include "hostEvaluator.h"

#include "far_ext/topologyRefinerFactory.h"
#include "osd_ext/polygonIndices.h"
#include "osd_ext/refinementEvaluator.h"
#include "regression/shapes/featureShapes.h"
#include "regression/shapes/meshOperations.h"
#include "regression/shapes/shapeDescriptor.h"
#include "regression/shapes/torus.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

namespace OpenSubdivHex::Regression {

/// A rounding of values up to 1 in size.
constexpr float kUnit = 0x1p-23f;
constexpr float kBlank = 9;

/// Floats up to 1 in size.
inline std::vector<float> MakeValues(int count, int stride) {
    std::vector<float> values;
    for (std::int64_t i = 0; i < std::int64_t(count) * stride; ++i) {
        values.push_back(float(i * 7919 % 1009) / 505 - 1);
    }
    return values;
}

inline std::unique_ptr<FarExt::TopologyRefiner>
MakeRefiner(Shape const &shape, int level, Sdc::Options::VtxBoundaryInterpolation boundary,
            FarExt::HexSchemeOptions schemeOptions = {}, bool fullTopologyInLastLevel = false) {
    Sdc::Options sdcOptions;
    sdcOptions.SetVtxBoundaryInterpolation(boundary);
    FarExt::TopologyRefinerFactory::Options options;
    options.hexSchemeOptions = schemeOptions;
    ShapeDescriptor const descriptor(shape);
    FarExt::CallStatus status;
    auto refiner =
        FarExt::TopologyRefinerFactory::Create(descriptor.Get(), sdcOptions, options, &status);
    FarExt::TopologyRefiner::UniformOptions uniform(level);
    uniform.fullTopologyInLastLevel = fullTopologyInLastLevel;
    if (!refiner || !refiner->RefineUniform(uniform, &status)) {
        throw std::runtime_error(shape.name + ": " + status.GetErrorMessage());
    }
    return refiner;
}

/// Tori of lattice faces, of quads, triangles and hexagons: of these alone, and around a sharp vertex.
inline std::vector<Shape> GetLatticeShapes() {
    Shape const triangles = MakeTorus(9, 8, TorusFaces::Triangles);
    std::vector<Shape> shapes = {MakeTorus(9, 8, TorusFaces::Quads), triangles,
                                 MakeDual("hexagons", triangles)};
    for (std::size_t i = 0; i < 3; ++i) {
        Shape shape = shapes[i];
        shape.name += " with a sharp vertex";
        shape.cornerVertices = {30};
        shape.cornerSharpness = {1.5f};
        shapes.push_back(shape);
    }
    return shapes;
}

/// Names tests after what runs the kernels.
struct KindName {
    template <class KIND>
    static std::string GetName(int) {
        return KIND::kName;
    }
};

/// \tparam KIND  has
///  - kName,
///  - Evaluator and Buffer, which this binds,
///  - GetMissing(): empty, or why there is none; and IsNeeded(): whether that is a failure,
///  - MakeBuffer(values, stride) and Read(buffer, numFloats),
///  - GetIntegers(buffer): where triangles are written.
template <class KIND>
class DeviceEvaluator : public testing::Test {
protected:
    using Descriptor = Osd::BufferDescriptor;
    using Evaluator = typename KIND::Evaluator;
    using Buffer = std::unique_ptr<typename KIND::Buffer>;
    using Options = OsdExt::RefinementEvaluator::Options;

    void SetUp() override {
        if (std::string const missing = kind.GetMissing(); !missing.empty()) {
            ASSERT_FALSE(kind.IsNeeded()) << missing;
            GTEST_SKIP() << missing;
        }
    }

    void TearDown() override {
        this->RecordProperty("largestDifferenceInUnits", std::to_string(largest));
    }

    Buffer makeBlank(std::size_t numFloats, int stride) {
        return kind.MakeBuffer(std::vector<float>(numFloats, kBlank), stride);
    }

    /// Whether floats that the processor and the device made differ by rounding alone.
    void expectFloats(Buffer &buffer, std::vector<float> const &expected, float numUnits) {
        std::vector<float> const values = kind.Read(*buffer, expected.size());
        ASSERT_EQ(values.size(), expected.size());
        for (std::size_t i = 0; i < values.size(); ++i) {
            float const difference = std::abs(values[i] - expected[i]) / kUnit;
            ASSERT_LE(difference, numUnits)
                << "units, float " << i << ": " << values[i] << " instead of " << expected[i];
            largest = std::max(largest, difference);
        }
    }

    /// Whether the buffer has the floats, bit for bit; a zero may have another sign.
    void expectBits(Buffer const &buffer, std::vector<float> const &expected) {
        std::vector<float> const values = kind.Read(*buffer, expected.size());
        for (std::size_t i = 0; i < values.size(); ++i) {
            ASSERT_TRUE(values[i] == expected[i])
                << "float " << i << ": " << values[i] << " instead of " << expected[i];
        }
    }

    /// All levels together and each alone.
    void expectEqual(FarExt::TopologyRefiner const &refiner, Options options, int length) {
        SCOPED_TRACE(testing::Message() << "mode " << options.interpolationMode << ", channel "
                                        << options.fvarChannel << ", length " << length);
        FarExt::CallStatus status;
        auto const expected = OsdExt::RefinementEvaluator::Create(refiner, options);
        auto const evaluator = Evaluator::Create(refiner, options, &status);
        ASSERT_TRUE(evaluator) << status.GetErrorMessage();
        ASSERT_EQ(evaluator->GetMaxLevel(), expected->GetMaxLevel());
        ASSERT_EQ(evaluator->GetNumElementsAllLevels(), expected->GetNumElementsAllLevels());
        Descriptor const desc(0, length, length);
        std::vector<float> const src = MakeValues(expected->GetNumElements(0), length);
        Buffer const srcBuffer = kind.MakeBuffer(src, length);
        std::vector<float> dst(std::size_t(expected->GetNumElementsAllLevels() * length));
        ASSERT_TRUE(expected->EvaluateAllLevels(src.data(), desc, dst.data(), desc));
        Buffer dstBuffer = makeBlank(dst.size(), length);
        ASSERT_TRUE(
            evaluator->EvaluateAllLevels(srcBuffer.get(), desc, dstBuffer.get(), desc, &status))
            << status.GetErrorMessage();
        ASSERT_NO_FATAL_FAILURE(expectFloats(dstBuffer, dst, kNumUnits));
        for (int level = 0; level <= expected->GetMaxLevel(); ++level) {
            SCOPED_TRACE(testing::Message() << "level " << level);
            dst.assign(std::size_t(expected->GetNumElements(level) * length), 0);
            ASSERT_EQ(evaluator->GetNumElements(level), expected->GetNumElements(level));
            ASSERT_TRUE(expected->Evaluate(src.data(), desc, dst.data(), desc, level));
            dstBuffer = makeBlank(dst.size(), length);
            ASSERT_TRUE(evaluator->Evaluate(srcBuffer.get(), desc, dstBuffer.get(), desc, level));
            ASSERT_NO_FATAL_FAILURE(expectFloats(dstBuffer, dst, kNumUnits));
        }
    }

    /// The limit of a level: points alone, and with derivatives.
    void expectEqualLimit(FarExt::TopologyRefiner const &refiner, int level, int length) {
        SCOPED_TRACE(testing::Message() << "level " << level << ", length " << length);
        FarExt::CallStatus status;
        auto const expected = OsdExt::RefinementEvaluator::Create(refiner);
        auto const evaluator = Evaluator::Create(refiner, {}, &status);
        ASSERT_TRUE(evaluator) << status.GetErrorMessage();
        std::vector<float> const src = MakeValues(expected->GetNumElements(0), length);
        Buffer const srcBuffer = kind.MakeBuffer(src, length);
        Descriptor const desc(0, length, length);
        auto const size = std::size_t(expected->GetNumElements(level) * length);
        std::vector<float> points(size);
        std::vector<float> du(size);
        std::vector<float> dv(size);
        bool const isThere =
            expected->EvaluateLimit(src.data(), desc, points.data(), desc, du.data(), desc,
                                    dv.data(), desc, level, &status);
        Buffer pointBuffer = makeBlank(size, length);
        Buffer duBuffer = makeBlank(size, length);
        Buffer dvBuffer = makeBlank(size, length);
        FarExt::CallStatus deviceStatus;
        ASSERT_EQ(evaluator->EvaluateLimit(srcBuffer.get(), desc, pointBuffer.get(), desc,
                                           duBuffer.get(), desc, dvBuffer.get(), desc, level,
                                           &deviceStatus),
                  isThere)
            << deviceStatus.GetErrorMessage();
        if (!isThere) {
            EXPECT_EQ(deviceStatus.GetErrorMessage(), status.GetErrorMessage());
            return;
        }
        // Derivatives are differences of near values, scaled up at each level.
        float const numUnitsOfDerivatives = float(kNumUnits) + float(level);
        ASSERT_NO_FATAL_FAILURE(expectFloats(pointBuffer, points, kNumUnits));
        ASSERT_NO_FATAL_FAILURE(expectFloats(duBuffer, du, numUnitsOfDerivatives));
        ASSERT_NO_FATAL_FAILURE(expectFloats(dvBuffer, dv, numUnitsOfDerivatives));
        ASSERT_TRUE(expected->EvaluateLimit(src.data(), desc, points.data(), desc, level));
        pointBuffer = makeBlank(size, length);
        ASSERT_TRUE(
            evaluator->EvaluateLimit(srcBuffer.get(), desc, pointBuffer.get(), desc, level));
        ASSERT_NO_FATAL_FAILURE(expectFloats(pointBuffer, points, kNumUnits));
    }

    /// In the last places of 1, over three levels.
    static constexpr int kNumUnits = 4;

    KIND kind;
    float largest = 0; ///< units
};

TYPED_TEST_SUITE_P(DeviceEvaluator);

TYPED_TEST_P(DeviceEvaluator, GivesTheValuesOfTheCpu) {
    for (Shape const &shape : GetAllShapes()) {
        for (auto boundary :
             {Sdc::Options::VTX_BOUNDARY_NONE, Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER}) {
            SCOPED_TRACE(testing::Message() << shape.name << ", boundary " << boundary);
            auto const refiner = MakeRefiner(shape, shape.GetNumFaces() > 100 ? 1 : 3, boundary);
            ASSERT_NO_FATAL_FAILURE(this->expectEqual(*refiner, {}, 3));
            for (int channel = 0; channel < refiner->GetNumFVarChannels(); ++channel) {
                ASSERT_NO_FATAL_FAILURE(
                    this->expectEqual(*refiner, {FarExt::INTERPOLATE_FACE_VARYING, channel}, 2));
            }
        }
    }
}

TYPED_TEST_P(DeviceEvaluator, GivesTheLimitOfTheCpu) {
    for (Shape const &shape : GetAllShapes()) {
        if (shape.GetNumFaces() > 100) {
            continue;
        }
        for (auto mask :
             {FarExt::FaceMask::Average, FarExt::FaceMask::Cosine, FarExt::FaceMask::Smooth}) {
            for (auto boundary :
                 {Sdc::Options::VTX_BOUNDARY_NONE, Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER}) {
                SCOPED_TRACE(testing::Message()
                             << shape.name << ", mask " << int(mask) << ", boundary " << boundary);
                FarExt::HexSchemeOptions schemeOptions;
                schemeOptions.faceMask = mask;
                bool const isSmooth = mask == FarExt::FaceMask::Smooth;
                auto const refiner =
                    MakeRefiner(shape, isSmooth ? 3 : 2, boundary, schemeOptions, true);
                ASSERT_NO_FATAL_FAILURE(
                    this->expectEqualLimit(*refiner, refiner->GetMaxLevel(), 3));
            }
        }
    }
}

// Regular faces of several levels, vertices that are listed, and every length.
TYPED_TEST_P(DeviceEvaluator, GivesTheLimitOfEveryLevelAndLength) {
    for (char const *name : {"torus", "cubeOfCharts"}) {
        SCOPED_TRACE(name);
        bool const hasCharts = std::string("cubeOfCharts") == name;
        FarExt::HexSchemeOptions schemeOptions;
        schemeOptions.faceMask = FarExt::FaceMask::Smooth;
        auto const refiner = MakeRefiner(hasCharts ? GetFeatureShape(name) : GetShape(name), 4,
                                         Sdc::Options::VTX_BOUNDARY_EDGE_ONLY, schemeOptions, true);
        for (int level = 0; level <= 4; ++level) {
            ASSERT_NO_FATAL_FAILURE(this->expectEqualLimit(*refiner, level, 3));
        }
        for (int length : {1, 2, 4, 7}) {
            ASSERT_NO_FATAL_FAILURE(this->expectEqualLimit(*refiner, 3, length));
        }
    }
}

// Lattice faces make all vertices in them from level 0.
TYPED_TEST_P(DeviceEvaluator, GivesTheLimitInLatticeFaces) {
    for (Shape const &shape : GetLatticeShapes()) {
        SCOPED_TRACE(shape.name);
        bool const isSharp = !shape.cornerVertices.empty();
        FarExt::HexSchemeOptions schemeOptions;
        schemeOptions.faceMask = isSharp ? FarExt::FaceMask::Smooth : FarExt::FaceMask::Average;
        auto const refiner =
            MakeRefiner(shape, 3, Sdc::Options::VTX_BOUNDARY_NONE, schemeOptions, true);
        for (int level = 1; level <= 3; ++level) {
            ASSERT_NO_FATAL_FAILURE(this->expectEqualLimit(*refiner, level, 3));
        }
        ASSERT_NO_FATAL_FAILURE(this->expectEqualLimit(*refiner, 3, isSharp ? 1 : 5));
    }
}

TYPED_TEST_P(DeviceEvaluator, RefusesLimitsAsTheCpu) {
    Osd::BufferDescriptor const desc(0, 3, 3);
    auto const buffer = this->makeBlank(3 * 1000, 3);
    auto const expectRefused = [&](FarExt::TopologyRefiner &refiner,
                                   OsdExt::RefinementEvaluator::Options options, int level,
                                   std::string const &message) {
        auto const evaluator = TypeParam::Evaluator::Create(refiner, options);
        FarExt::CallStatus status;
        EXPECT_FALSE(
            evaluator->EvaluateLimit(buffer.get(), desc, buffer.get(), desc, level, &status));
        EXPECT_EQ(status.GetCode(), FarExt::StatusCode::InvalidArgument);
        EXPECT_EQ(status.GetErrorMessage(), message);
    };
    auto const refiner = MakeRefiner(GetShape("cube"), 2, Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    expectRefused(*refiner, {}, 3, "level 3 is not between 0 and 2");
    expectRefused(*refiner, {FarExt::INTERPOLATE_VARYING, 0}, 1,
                  "there is a limit for INTERPOLATE_VERTEX alone");
    expectRefused(*refiner, {}, 2,
                  "level 2 has no full topology: see UniformOptions::fullTopologyInLastLevel");
    EXPECT_EQ(this->kind.Read(*buffer, 3000), std::vector<float>(3000, kBlank));
}

TYPED_TEST_P(DeviceEvaluator, TakesEveryLengthMaskSchemeAndMode) {
    for (char const *name : {"cubeOfCharts", "cube"}) {
        for (auto type : {FarExt::SchemeType::Hexagonal, FarExt::SchemeType::DooSabin,
                          FarExt::SchemeType::TriHex}) {
            bool const isHexagonal = type == FarExt::SchemeType::Hexagonal;
            bool const hasCharts = std::string("cubeOfCharts") == name;
            if (hasCharts != isHexagonal) {
                continue; // the others have no rules for charts
            }
            for (auto mask :
                 {FarExt::FaceMask::Average, FarExt::FaceMask::Cosine, FarExt::FaceMask::Smooth}) {
                FarExt::HexSchemeOptions schemeOptions;
                schemeOptions.schemeType = type;
                schemeOptions.faceMask = mask;
                if (mask == FarExt::FaceMask::Smooth && isHexagonal) {
                    schemeOptions.firstStep = FarExt::FirstStep::Truncate;
                }
                auto const refiner =
                    MakeRefiner(hasCharts ? GetFeatureShape(name) : GetShape(name), 3,
                                Sdc::Options::VTX_BOUNDARY_EDGE_ONLY, schemeOptions);
                for (int length : {1, 4, 7}) {
                    ASSERT_NO_FATAL_FAILURE(this->expectEqual(*refiner, {}, length));
                }
                ASSERT_NO_FATAL_FAILURE(
                    this->expectEqual(*refiner, {FarExt::INTERPOLATE_VARYING, 0}, 3));
                for (int channel = 0; channel < refiner->GetNumFVarChannels(); ++channel) {
                    ASSERT_NO_FATAL_FAILURE(this->expectEqual(
                        *refiner, {FarExt::INTERPOLATE_FACE_VARYING, channel}, 2));
                }
            }
        }
    }
}

TYPED_TEST_P(DeviceEvaluator, TakesEveryFirstStep) {
    for (auto firstStep : {FarExt::FirstStep::TriHex, FarExt::FirstStep::Truncate}) {
        FarExt::HexSchemeOptions schemeOptions;
        schemeOptions.faceMask = FarExt::FaceMask::Smooth;
        schemeOptions.firstStep = firstStep;
        std::vector<Shape> shapes{GetShape("torus")};
        if (firstStep == FarExt::FirstStep::Truncate) {
            // Lines pass vertices, in half polygons and in faces that they cross.
            for (char const *name : {"creaseLoopQuads", "mixedSharpnessQuads"}) {
                shapes.push_back(GetFeatureShape(name));
            }
            shapes.push_back(GetShape("mixedPatch"));
        }
        for (Shape const &shape : shapes) {
            SCOPED_TRACE(testing::Message() << shape.name << ", first step " << int(firstStep));
            auto const refiner =
                MakeRefiner(shape, 3, Sdc::Options::VTX_BOUNDARY_EDGE_ONLY, schemeOptions, true);
            ASSERT_NO_FATAL_FAILURE(this->expectEqual(*refiner, {}, 3));
            ASSERT_NO_FATAL_FAILURE(this->expectEqualLimit(*refiner, 3, 3));
        }
    }
}

// Runs of faces of 3, 5, 7 and more sides, each with weights of its own and not.
TYPED_TEST_P(DeviceEvaluator, TakesRunsOfEveryFaceSize) {
    for (int const size : {3, 5, 7, 13}) {
        constexpr int kNumFaces = 300;
        Shape shape;
        shape.name = "polygons of " + std::to_string(size) + " sides";
        for (int face = 0; face < kNumFaces; ++face) {
            shape.faceSizes.push_back(size);
            for (int i = 0; i < size; ++i) {
                shape.faceVertices.push_back(face * size + i);
            }
        }
        shape.positions.resize(std::size_t(3 * size * kNumFaces));
        for (auto mask : {FarExt::FaceMask::Average, FarExt::FaceMask::Cosine}) {
            SCOPED_TRACE(testing::Message() << shape.name << ", mask " << int(mask));
            FarExt::HexSchemeOptions schemeOptions;
            schemeOptions.faceMask = mask;
            auto const refiner =
                MakeRefiner(shape, 2, Sdc::Options::VTX_BOUNDARY_NONE, schemeOptions);
            ASSERT_NO_FATAL_FAILURE(this->expectEqual(*refiner, {}, 3));
        }
    }
}

// The memory of an evaluator for the limit in lattice faces.
TYPED_TEST_P(DeviceEvaluator, KeepsFewBytesOfLatticeFaces) {
    constexpr std::int64_t kMaxBytesOfWeights = 1 << 16; // which all faces have in common
    for (Shape const &shape : GetLatticeShapes()) {
        if (!shape.cornerVertices.empty()) {
            continue;
        }
        SCOPED_TRACE(shape.name);
        auto const refiner = MakeRefiner(shape, 4, Sdc::Options::VTX_BOUNDARY_NONE, {}, true);
        auto const evaluator = TypeParam::Evaluator::Create(*refiner, {});
        std::int64_t const numBytes = evaluator->GetNumDeviceBytes();
        Osd::BufferDescriptor const desc(0, 1, 1);
        auto const src = this->makeBlank(std::size_t(evaluator->GetNumElements(0)), 1);
        auto const dst = this->makeBlank(std::size_t(evaluator->GetNumElements(4)), 1);
        ASSERT_TRUE(evaluator->EvaluateLimit(src.get(), desc, dst.get(), desc, 4));
        EXPECT_LE(evaluator->GetNumDeviceBytes() - numBytes,
                  4 * evaluator->GetNumElements(4) + kMaxBytesOfWeights);
    }
}

// Long runs of faces and vertices, and what an evaluator keeps of them.
TYPED_TEST_P(DeviceEvaluator, KeepsFewBytesOfLargeLevels) {
    auto const refiner =
        MakeRefiner(GetShape("torus"), 5, Sdc::Options::VTX_BOUNDARY_EDGE_ONLY, {}, true);
    ASSERT_NO_FATAL_FAILURE(this->expectEqual(*refiner, {}, 3));
    auto const evaluator = TypeParam::Evaluator::Create(*refiner, {});
    std::int64_t const numBytes = evaluator->GetNumDeviceBytes();
    EXPECT_LE(numBytes, 8 * evaluator->GetNumElements(5));
    Osd::BufferDescriptor const desc(0, 1, 1);
    auto const src = this->makeBlank(std::size_t(evaluator->GetNumElements(0)), 1);
    auto const dst = this->makeBlank(std::size_t(evaluator->GetNumElements(5)), 1);
    ASSERT_TRUE(evaluator->EvaluateLimit(src.get(), desc, dst.get(), desc, 5));
    EXPECT_LE(evaluator->GetNumDeviceBytes() - numBytes, 28 * evaluator->GetNumElements(5));
}

// Where numbering alone tells where vertices are, sums are in the order of the processor's.
// The corners of dense faces that have the row of plain ones are made by another sum there.
TYPED_TEST_P(DeviceEvaluator, GivesMostBitsOfTheCpu) {
    for (auto mask : {FarExt::FaceMask::Average, FarExt::FaceMask::Smooth}) {
        FarExt::HexSchemeOptions schemeOptions;
        schemeOptions.faceMask = mask;
        auto const refiner =
            MakeRefiner(GetShape("torus"), 5, Sdc::Options::VTX_BOUNDARY_EDGE_ONLY, schemeOptions);
        auto const expected = OsdExt::RefinementEvaluator::Create(*refiner);
        auto const evaluator = TypeParam::Evaluator::Create(*refiner, {});
        Osd::BufferDescriptor const desc(0, 3, 3);
        std::vector<float> const src = MakeValues(expected->GetNumElements(0), 3);
        auto const srcBuffer = this->kind.MakeBuffer(src, 3);
        for (int level = 1; level <= 5; ++level) {
            std::vector<float> dst(std::size_t(expected->GetNumElements(level)) * 3);
            ASSERT_TRUE(expected->Evaluate(src.data(), desc, dst.data(), desc, level));
            auto const dstBuffer = this->makeBlank(dst.size(), 3);
            ASSERT_TRUE(evaluator->Evaluate(srcBuffer.get(), desc, dstBuffer.get(), desc, level));
            std::vector<float> const values = this->kind.Read(*dstBuffer, dst.size());
            std::ptrdiff_t const numOthers = std::inner_product(
                values.begin(), values.end(), dst.begin(), std::ptrdiff_t(0), std::plus<>(),
                [](float a, float b) { return std::ptrdiff_t(a != b); });
            EXPECT_LE(numOthers, std::ptrdiff_t(dst.size() / 4)) << "level " << level;
        }
    }
}

// The results behind the control values, in one buffer whose vertices have more floats, which stay.
TYPED_TEST_P(DeviceEvaluator, IsEvaluatedInPlace) {
    constexpr int kLength = 3;
    constexpr int kStride = 5;
    auto const refiner =
        MakeRefiner(GetShape("cube"), 3, Sdc::Options::VTX_BOUNDARY_EDGE_ONLY, {}, true);
    auto const expected = OsdExt::RefinementEvaluator::Create(*refiner);
    auto const evaluator = TypeParam::Evaluator::Create(*refiner, {});
    int const numControl = expected->GetNumElements(0);
    int const numPoints = expected->GetNumElements(3);
    Osd::BufferDescriptor const srcDesc(1, kLength, kStride);
    Osd::BufferDescriptor const dstDesc(numControl * kStride + 1, kLength, kStride);
    Osd::BufferDescriptor const duDesc((numControl + numPoints) * kStride + 1, kLength, kStride);
    Osd::BufferDescriptor const dvDesc((numControl + 2 * numPoints) * kStride, kLength, kStride);
    std::vector<float> values = MakeValues(numControl + 3 * numPoints, kStride);
    auto buffer = this->kind.MakeBuffer(values, kStride);
    ASSERT_TRUE(expected->EvaluateAllLevels(values.data(), srcDesc, values.data(), dstDesc));
    ASSERT_TRUE(evaluator->EvaluateAllLevels(buffer.get(), srcDesc, buffer.get(), dstDesc));
    this->expectFloats(buffer, values, this->kNumUnits);
    EXPECT_TRUE(
        evaluator->Evaluate(buffer.get(), srcDesc, buffer.get(), dstDesc, 2)); // the first ones
    EXPECT_TRUE(expected->Evaluate(values.data(), srcDesc, values.data(), dstDesc, 2));
    this->expectFloats(buffer, values, this->kNumUnits);
    EXPECT_TRUE(evaluator->EvaluateLimit(buffer.get(), srcDesc, buffer.get(), dstDesc, buffer.get(),
                                         duDesc, buffer.get(), dvDesc, 3));
    EXPECT_TRUE(expected->EvaluateLimit(values.data(), srcDesc, values.data(), dstDesc,
                                        values.data(), duDesc, values.data(), dvDesc, 3));
    this->expectFloats(buffer, values, float(this->kNumUnits << 4));
}

// The kernels give the same numbers wherever they run: so testing them on the processor tests them
// for devices that are not there.
TYPED_TEST_P(DeviceEvaluator, GivesTheBitsOfTheKernelsOnTheProcessor) {
    constexpr int kLength = 3;
    Osd::BufferDescriptor const desc(0, kLength, kLength);
    std::vector<Shape> shapes = GetLatticeShapes();
    for (Shape const &shape : GetAllShapes()) {
        if (shape.GetNumFaces() <= 100) {
            shapes.push_back(shape);
        }
    }
    for (Shape const &shape : shapes) {
        SCOPED_TRACE(shape.name);
        FarExt::HexSchemeOptions schemeOptions;
        schemeOptions.faceMask = FarExt::FaceMask::Smooth;
        auto const refiner =
            MakeRefiner(shape, 3, Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER, schemeOptions, true);
        auto const evaluator = TypeParam::Evaluator::Create(*refiner, {});
        auto const host = HostEvaluator::Create(*refiner);
        std::vector<float> const src = MakeValues(host->GetNumElements(0), kLength);
        auto const srcBuffer = this->kind.MakeBuffer(src, kLength);
        std::vector<float> points(std::size_t(host->GetNumElements(3)) * kLength);
        std::vector<float> du(points.size());
        std::vector<float> dv(points.size());
        auto const pointBuffer = this->makeBlank(points.size(), kLength);
        auto const duBuffer = this->makeBlank(points.size(), kLength);
        auto const dvBuffer = this->makeBlank(points.size(), kLength);
        ASSERT_TRUE(host->Evaluate(src.data(), desc, points.data(), desc, 3));
        ASSERT_TRUE(evaluator->Evaluate(srcBuffer.get(), desc, pointBuffer.get(), desc, 3));
        ASSERT_NO_FATAL_FAILURE(this->expectBits(pointBuffer, points));
        if (host->EvaluateLimit(src.data(), desc, points.data(), desc, du.data(), desc, dv.data(),
                                desc, 3)) {
            ASSERT_TRUE(evaluator->EvaluateLimit(srcBuffer.get(), desc, pointBuffer.get(), desc,
                                                 duBuffer.get(), desc, dvBuffer.get(), desc, 3));
            ASSERT_NO_FATAL_FAILURE(this->expectBits(pointBuffer, points));
            ASSERT_NO_FATAL_FAILURE(this->expectBits(duBuffer, du));
            ASSERT_NO_FATAL_FAILURE(this->expectBits(dvBuffer, dv));
        }
    }
}

TYPED_TEST_P(DeviceEvaluator, MakesTheTrianglesOfTheCpu) {
    OsdExt::DrawOptions options;
    options.cutBaseFaces = false;
    options.cutCreases = OsdExt::CreaseCuts::NoCreases;
    options.drawHoles = true;
    options.vertexOffset = 5;
    for (Shape const &shape : GetAllShapes()) {
        if (shape.GetNumFaces() > 100) {
            continue;
        }
        for (auto boundary :
             {Sdc::Options::VTX_BOUNDARY_NONE, Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER}) {
            auto const refiner = MakeRefiner(shape, 3, boundary);
            auto const evaluator = TypeParam::Evaluator::Create(*refiner, {});
            for (int level = 0; level <= 3; ++level) {
                SCOPED_TRACE(testing::Message() << shape.name << ", level " << level);
                auto const expected =
                    OsdExt::CreateTriangleIndices(refiner->GetLevel(level), options);
                ASSERT_EQ(evaluator->GetNumTriangles(level), expected.GetNumTriangles());
                auto const buffer = this->makeBlank(expected.vertices.size(), 1);
                FarExt::CallStatus status;
                ASSERT_TRUE(evaluator->MakeTriangleIndices(this->kind.GetIntegers(*buffer), level,
                                                           options.vertexOffset, &status))
                    << status.GetErrorMessage();
                std::vector<float> const bits = this->kind.Read(*buffer, expected.vertices.size());
                std::vector<int> triangles(bits.size());
                std::memcpy(triangles.data(), bits.data(), bits.size() * sizeof(int));
                ASSERT_EQ(triangles, expected.vertices);
                EXPECT_FALSE(evaluator->MakeTriangleIndices(this->kind.GetIntegers(*buffer), level,
                                                            -1, &status));
                EXPECT_EQ(status.GetCode(), FarExt::StatusCode::InvalidArgument);
            }
        }
    }
}

REGISTER_TYPED_TEST_SUITE_P(DeviceEvaluator, GivesTheValuesOfTheCpu, GivesTheLimitOfTheCpu,
                            GivesTheLimitOfEveryLevelAndLength, GivesTheLimitInLatticeFaces,
                            RefusesLimitsAsTheCpu, TakesEveryLengthMaskSchemeAndMode,
                            TakesEveryFirstStep, TakesRunsOfEveryFaceSize,
                            KeepsFewBytesOfLatticeFaces, KeepsFewBytesOfLargeLevels,
                            GivesMostBitsOfTheCpu, IsEvaluatedInPlace,
                            GivesTheBitsOfTheKernelsOnTheProcessor, MakesTheTrianglesOfTheCpu);

} // namespace OpenSubdivHex::Regression

#endif

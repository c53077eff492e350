// SPDX-License-Identifier: Apache-2.0
//
// RefinementEvaluator::EvaluateLimit against limit stencil tables in double precision.
#include "far_ext/executor.h"
#include "far_ext/stencilTableFactory.h"
#include "far_ext/topologyRefinerFactory.h"
#include "osd_ext/refinementEvaluator.h"
#include "osd_ext/simdLevel.h"
#include "regression/shapes/featureShapes.h"
#include "regression/shapes/meshOperations.h"
#include "regression/shapes/shapeDescriptor.h"
#include "regression/shapes/torus.h"

#include <opensubdiv/osd/cpuVertexBuffer.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace OpenSubdivHex::Regression::limitEvaluatorTest {

using FarExt::TopologyRefiner;
using OsdExt::RefinementEvaluator;
using Factory = FarExt::LimitStencilTableFactoryReal<double>;

namespace {

constexpr float kUntouched = -12345.678f;

std::unique_ptr<TopologyRefiner>
createRefiner(Shape const &shape, int level, bool isFull = true,
              Sdc::Options::VtxBoundaryInterpolation boundary = Sdc::Options::VTX_BOUNDARY_NONE,
              FarExt::HexSchemeOptions schemeOptions = {FarExt::FaceMask::Smooth}) {
    Sdc::Options sdcOptions;
    sdcOptions.SetVtxBoundaryInterpolation(boundary);
    FarExt::TopologyRefinerFactory::Options options;
    options.hexSchemeOptions = schemeOptions;
    auto refiner =
        FarExt::TopologyRefinerFactory::Create(ShapeDescriptor(shape).Get(), sdcOptions, options);
    TopologyRefiner::UniformOptions uniformOptions(level);
    uniformOptions.fullTopologyInLastLevel = isFull;
    if (!refiner || !refiner->RefineUniform(uniformOptions)) {
        throw std::runtime_error(shape.name + " cannot be refined");
    }
    return refiner;
}

std::vector<float> makeValues(int count) {
    std::vector<float> values;
    for (int i = 0; i < count; ++i) {
        values.push_back(float(std::sin(i * 1.7) / 2));
    }
    return values;
}

/// Elements of \p length floats, \p stride apart, behind \p offset others that nobody may write.
struct Output {
    Output(int numElements, int length, int stride, int offset)
        : desc(offset, length, stride),
          floats(std::size_t(offset) + std::size_t(numElements) * std::size_t(stride), kUntouched) {
    }

    float Get(int element, int i) const {
        return floats[std::size_t(desc.offset + element * desc.stride + i)];
    }

    Osd::BufferDescriptor desc;
    std::vector<float> floats;
};

void expectOutput(Output const &output, Factory::Table const &table,
                  std::vector<double> const &weights, std::vector<float> const &base,
                  double tolerance, std::string const &name) {
    std::size_t numTouched = 0;
    for (int i = 0; i < table.GetNumStencils(); ++i) {
        for (int f = 0; f < output.desc.length; ++f) {
            double expected = 0;
            int const offset = table.GetOffsets()[std::size_t(i)];
            for (int k = offset; k < offset + table.GetSizes()[std::size_t(i)]; ++k) {
                int const index = table.GetControlIndices()[std::size_t(k)];
                expected += weights[std::size_t(k)] *
                            double(base[std::size_t(index * output.desc.length + f)]);
            }
            ASSERT_NEAR(output.Get(i, f), expected, tolerance)
                << name << " of vertex " << i << ", float " << f;
            ++numTouched;
        }
    }
    std::size_t numUntouched = 0;
    for (float value : output.floats) {
        numUntouched += value == kUntouched;
    }
    EXPECT_EQ(numTouched + numUntouched, output.floats.size()) << name;
}

/// \param gap  floats between the elements that are written
void expectLimits(TopologyRefiner const &refiner, int length, int gap = 2) {
    auto const evaluator = RefinementEvaluator::Create(refiner);
    ASSERT_TRUE(evaluator);
    Osd::BufferDescriptor const srcDesc(0, length, length);
    std::vector<float> const base = makeValues(evaluator->GetNumElements(0) * length);
    for (int level = refiner.GetHexSchemeOptions().GetSurfaceLevel();
         level <= evaluator->GetMaxLevel(); ++level) {
        SCOPED_TRACE(testing::Message() << "level " << level << ", length " << length);
        Factory::Options options;
        options.level = level;
        auto const table = Factory::Create(refiner, options);
        ASSERT_TRUE(table);
        int const count = evaluator->GetNumElements(level);
        Output points(count, length, length + gap, 1);
        Output du(count, length, length, 3);
        Output dv(count, length, length + gap / 2 * length, 0);
        FarExt::CallStatus status;
        ASSERT_TRUE(evaluator->EvaluateLimit(base.data(), srcDesc, points.floats.data(),
                                             points.desc, du.floats.data(), du.desc,
                                             dv.floats.data(), dv.desc, level, &status))
            << status.GetErrorMessage();
        ASSERT_NO_FATAL_FAILURE(
            expectOutput(points, *table, table->GetWeights(), base, 2e-6, "point"));
        // Sums of weights of derivatives are 16 at most.
        ASSERT_NO_FATAL_FAILURE(expectOutput(du, *table, table->GetDuWeights(), base, 2e-5, "du"));
        ASSERT_NO_FATAL_FAILURE(expectOutput(dv, *table, table->GetDvWeights(), base, 2e-5, "dv"));
        Output alone(count, length, length, 0);
        ASSERT_TRUE(
            evaluator->EvaluateLimit(base.data(), srcDesc, alone.floats.data(), alone.desc, level));
        ASSERT_NO_FATAL_FAILURE(
            expectOutput(alone, *table, table->GetWeights(), base, 2e-6, "point alone"));
    }
}

} // namespace

// No lattices, whose faces are made as a whole.
TEST(LimitEvaluator, ValuesThatAreNoNumbersSpreadNoFurtherThanInTables) {
    for (Shape const &shape : {GetShape("icosahedron"), GetFeatureShape("mixedSharpnessQuads")}) {
        auto const refiner = createRefiner(shape, 1, true, Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
        auto const evaluator = RefinementEvaluator::Create(*refiner);
        Osd::BufferDescriptor const desc(0, 1, 1);
        for (int level = 0; level <= 1; ++level) {
            Factory::Options options;
            options.level = level;
            auto const table = Factory::Create(*refiner, options);
            ASSERT_TRUE(table);
            for (int wrong = 0; wrong < shape.GetNumVertices(); ++wrong) {
                std::vector<float> values = makeValues(shape.GetNumVertices());
                values[std::size_t(wrong)] = std::numeric_limits<float>::quiet_NaN();
                std::vector<float> points(std::size_t(table->GetNumStencils()));
                ASSERT_TRUE(
                    evaluator->EvaluateLimit(values.data(), desc, points.data(), desc, level));
                for (std::size_t i = 0; i < points.size(); ++i) {
                    auto const first = table->GetControlIndices().begin() + table->GetOffsets()[i];
                    if (std::count(first, first + table->GetSizes()[i], wrong) == 0) {
                        ASSERT_FALSE(std::isnan(points[i]))
                            << shape.name << ", level " << level << ", vertex " << i;
                    }
                }
            }
        }
    }
}

TEST(LimitEvaluator, IsThatOfLimitStencilTables) {
    for (Shape const &shape : GetAllShapes()) {
        if (shape.GetNumCorners() > 60) {
            continue;
        }
        for (auto boundary : kBoundaries) {
            SCOPED_TRACE(testing::Message() << shape.name << ", boundary " << boundary);
            ASSERT_NO_FATAL_FAILURE(expectLimits(*createRefiner(shape, 2, true, boundary), 3));
        }
    }
}

TEST(LimitEvaluator, IsThatOfLimitStencilTablesBehindATruncation) {
    FarExt::HexSchemeOptions schemeOptions{FarExt::FaceMask::Smooth};
    schemeOptions.firstStep = FarExt::FirstStep::Truncate;
    for (Shape const &shape : GetAllShapes()) {
        if (shape.GetNumCorners() <= 40) {
            SCOPED_TRACE(shape.name);
            ASSERT_NO_FATAL_FAILURE(expectLimits(
                *createRefiner(shape, 2, true, Sdc::Options::VTX_BOUNDARY_EDGE_ONLY, schemeOptions),
                3));
        }
    }
}

TEST(LimitEvaluator, TakesAnyLengthAndSimdLevel) {
    auto const refiner = createRefiner(GetShape("dodecahedron"), 3);
    auto const saved = OsdExt::GetSimdLevel();
    for (auto simdLevel :
         {OsdExt::SimdLevel::Portable, OsdExt::SimdLevel::Avx2, OsdExt::SimdLevel::Avx512}) {
        if (simdLevel > OsdExt::GetMaxSimdLevel()) {
            continue;
        }
        OsdExt::SetSimdLevel(simdLevel);
        for (int length : {1, 2, 3, 4, 7, 8, 11}) {
            ASSERT_NO_FATAL_FAILURE(expectLimits(*refiner, length));
            ASSERT_NO_FATAL_FAILURE(expectLimits(*refiner, length, 0));
        }
    }
    OsdExt::SetSimdLevel(saved);
}

// Most vertices are made of regular faces: from level 0 on, from a later level on, near irregular
// vertices and borders.
TEST(LimitEvaluator, TakesRegularFacesOfAnyMask) {
    for (auto faceMask :
         {FarExt::FaceMask::Average, FarExt::FaceMask::Cosine, FarExt::FaceMask::Smooth}) {
        for (char const *name :
             {"hexTorus", "dodecahedron", "octahedron", "hexGrid", "mixedPatch"}) {
            for (auto boundary :
                 {Sdc::Options::VTX_BOUNDARY_NONE, Sdc::Options::VTX_BOUNDARY_EDGE_ONLY}) {
                SCOPED_TRACE(testing::Message()
                             << name << ", mask " << int(faceMask) << ", boundary " << boundary);
                auto const refiner = createRefiner(GetShape(name), 3, true, boundary, {faceMask});
                ASSERT_NO_FATAL_FAILURE(expectLimits(*refiner, 3, 0));
                ASSERT_NO_FATAL_FAILURE(expectLimits(*refiner, 3));
                ASSERT_NO_FATAL_FAILURE(expectLimits(*refiner, 5));
            }
        }
    }
}

// Faces of a lattice make all vertices in them from level 0; beside them are those near a sharp vertex.
TEST(LimitEvaluator, TakesLatticeFacesOfAnyLengthAndSimdLevel) {
    auto const saved = OsdExt::GetSimdLevel();
    for (Shape shape : {MakeTorus(9, 8, TorusFaces::Quads), MakeTorus(9, 8, TorusFaces::Triangles),
                        MakeDual("hexagons", MakeTorus(9, 8, TorusFaces::Triangles))}) {
        for (auto faceMask :
             {FarExt::FaceMask::Average, FarExt::FaceMask::Cosine, FarExt::FaceMask::Smooth}) {
            // With Smooth vertices depend on fewer.
            bool const isSharp = faceMask == FarExt::FaceMask::Smooth;
            if (isSharp) {
                shape.cornerVertices = {30};
                shape.cornerSharpness = {1.5f};
            }
            auto const refiner =
                createRefiner(shape, 4, true, Sdc::Options::VTX_BOUNDARY_NONE, {faceMask});
            for (auto simdLevel : {OsdExt::SimdLevel::Portable, OsdExt::SimdLevel::Avx2,
                                   OsdExt::SimdLevel::Avx512}) {
                if (simdLevel > OsdExt::GetMaxSimdLevel()) {
                    continue;
                }
                SCOPED_TRACE(testing::Message() << shape.name << ", mask " << int(faceMask)
                                                << ", SIMD level " << int(simdLevel));
                OsdExt::SetSimdLevel(simdLevel);
                ASSERT_NO_FATAL_FAILURE(expectLimits(*refiner, 3, 0));
                ASSERT_NO_FATAL_FAILURE(expectLimits(*refiner, isSharp ? 3 : 6));
            }
        }
    }
    OsdExt::SetSimdLevel(saved);
}

// Up to half of the largest float: sums of such values are larger.
TEST(LimitEvaluator, LargeValuesAreAsSmallOnes) {
    for (Shape const &shape : {GetShape("hexTorus"), MakeTorus(7, 6, TorusFaces::Quads),
                               MakeTorus(7, 6, TorusFaces::Triangles)}) {
        auto const refiner = createRefiner(shape, 3);
        auto const evaluator = RefinementEvaluator::Create(*refiner);
        constexpr float kFactor = 0x1p127f;
        Osd::BufferDescriptor const desc(0, 3, 3);
        std::vector<float> base = makeValues(3 * evaluator->GetNumElements(0));
        auto const evaluate = [&] {
            std::vector<float> points(std::size_t(3 * evaluator->GetNumElements(3)));
            EXPECT_TRUE(evaluator->EvaluateLimit(base.data(), desc, points.data(), desc, 3));
            return points;
        };
        std::vector<float> const small = evaluate();
        for (float &value : base) {
            value *= kFactor;
        }
        std::vector<float> const large = evaluate();
        for (std::size_t i = 0; i < small.size(); ++i) {
            ASSERT_EQ(large[i], small[i] * kFactor) << "float " << i;
        }
    }
}

TEST(LimitEvaluator, SameBitsForAnyNumberOfThreads) {
    for (Shape const &shape : {GetShape("dodecahedron"), MakeTorus(20, 18, TorusFaces::Quads)}) {
        auto const refiner = createRefiner(shape, 5);
        auto const evaluate = [&](int numThreads) {
            FarExt::SetNumThreads(numThreads);
            auto const evaluator = RefinementEvaluator::Create(*refiner);
            int const count = 3 * evaluator->GetNumElements(5);
            std::vector<float> const base = makeValues(3 * evaluator->GetNumElements(0));
            std::vector<float> result(std::size_t(3 * count));
            Osd::BufferDescriptor const desc(0, 3, 3);
            EXPECT_TRUE(evaluator->EvaluateLimit(base.data(), desc, result.data(), desc,
                                                 result.data() + count, desc,
                                                 result.data() + 2 * count, desc, 5));
            return result;
        };
        std::vector<float> const expected = evaluate(1);
        for (int numThreads : {2, 3, 8}) {
            EXPECT_EQ(evaluate(numThreads), expected) << numThreads << " threads";
        }
        FarExt::SetNumThreads(0);
    }
}

TEST(LimitEvaluator, RefusesBadArgumentsAndWritesNothing) {
    auto const refiner = createRefiner(GetShape("cube"), 2, false);
    auto const evaluator = RefinementEvaluator::Create(*refiner);
    Osd::BufferDescriptor const desc(0, 3, 3);
    std::vector<float> const base = makeValues(3 * 8);
    std::vector<float> result(std::size_t(3 * evaluator->GetNumElements(2)), kUntouched);
    std::vector<float> const untouched = result;
    FarExt::CallStatus status;
    auto const expectRefused = [&](bool isEvaluated, std::string const &cause) {
        EXPECT_FALSE(isEvaluated);
        EXPECT_EQ(status.GetCode(), FarExt::StatusCode::InvalidArgument);
        EXPECT_NE(status.GetErrorMessage().find(cause), std::string::npos)
            << status.GetErrorMessage();
        EXPECT_EQ(result, untouched);
    };
    float *const dst = result.data();
    auto const evaluate = [&](RefinementEvaluator &of, float *du,
                              Osd::BufferDescriptor const &duDesc, int level) {
        return of.EvaluateLimit(base.data(), desc, dst, desc, du, duDesc, dst, desc, level,
                                &status);
    };
    expectRefused(evaluate(*evaluator, dst, desc, 2), "full topology");
    expectRefused(evaluate(*evaluator, dst, desc, 3), "level 3");
    expectRefused(evaluate(*evaluator, nullptr, desc, 1), "null");
    expectRefused(evaluate(*evaluator, dst, Osd::BufferDescriptor(0, 2, 3), 1), "lengths");
    RefinementEvaluator::Options options;
    options.interpolationMode = FarExt::INTERPOLATE_VARYING;
    auto const varying = RefinementEvaluator::Create(*refiner, options);
    expectRefused(evaluate(*varying, dst, desc, 1), "INTERPOLATE_VERTEX");
}

TEST(LimitEvaluator, TakesBuffers) {
    auto const refiner = createRefiner(GetShape("cube"), 1);
    auto const evaluator = RefinementEvaluator::Create(*refiner);
    int const count = evaluator->GetNumElements(1);
    Osd::BufferDescriptor const desc(0, 3, 3);
    std::unique_ptr<Osd::CpuVertexBuffer> const src(Osd::CpuVertexBuffer::Create(3, 8));
    std::vector<float> const base = makeValues(3 * 8);
    src->UpdateData(base.data(), 0, 8);
    std::unique_ptr<Osd::CpuVertexBuffer> buffers[3];
    for (auto &buffer : buffers) {
        buffer.reset(Osd::CpuVertexBuffer::Create(3, count));
    }
    ASSERT_TRUE(evaluator->EvaluateLimit(src.get(), desc, buffers[0].get(), desc, buffers[1].get(),
                                         desc, buffers[2].get(), desc, 1));
    std::vector<float> points(std::size_t(3 * count));
    ASSERT_TRUE(evaluator->EvaluateLimit(base.data(), desc, points.data(), desc, 1));
    float const *const ofBuffer = buffers[0]->BindCpuBuffer();
    for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_NEAR(ofBuffer[i], points[i], 1e-6);
    }
}

} // namespace OpenSubdivHex::Regression::limitEvaluatorTest

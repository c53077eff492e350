// SPDX-License-Identifier: Apache-2.0
//
// EvalPatches: against OpenSubdiv's, for tables of any kind.
#include "far_ext/patchTableFactory.h"
#include "far_ext/topologyRefinerFactory.h"
#include "osd_ext/cpuEvaluator.h"
#include "regression/shapes/featureShapes.h"
#include "regression/shapes/shapeDescriptor.h"

#include <opensubdiv/far/patchTableFactory.h>
#include <opensubdiv/far/topologyRefinerFactory.h>
#include <opensubdiv/osd/cpuEvaluator.h>
#include <opensubdiv/osd/cpuPatchTable.h>
#include <opensubdiv/osd/cpuVertexBuffer.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <vector>

namespace OpenSubdivHex::Regression::patchEvaluationTest {

namespace {

namespace OsdFar = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;

struct Coords {
    Osd::PatchCoord *BindCpuBuffer() { return coords.data(); }
    int GetNum() const { return int(coords.size()); }
    std::vector<Osd::PatchCoord> coords;
};

struct Buffer {
    float *BindCpuBuffer() { return values.data(); }
    std::vector<float> values;
};

Shape const &findShape(std::string const &name) {
    for (Shape const &shape : GetAllShapes()) {
        if (shape.name == name) {
            return shape;
        }
    }
    throw std::out_of_range(name);
}

// An adaptive table of OpenSubdiv's own schemes, whose points are numbered without gaps.
std::unique_ptr<OsdFar::PatchTable> makeTable(Shape const &shape, Sdc::SchemeType scheme,
                                              bool hasFVar, int *numPoints) {
    ShapeDescriptor const descriptor(shape);
    Sdc::Options sdcOptions;
    sdcOptions.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
    sdcOptions.SetFVarLinearInterpolation(Sdc::Options::FVAR_LINEAR_NONE);
    std::unique_ptr<OsdFar::TopologyRefiner> const refiner(
        OsdFar::TopologyRefinerFactory<OsdFar::TopologyDescriptor>::Create(
            descriptor.Get(), OsdFar::TopologyRefinerFactory<OsdFar::TopologyDescriptor>::Options(
                                  scheme, sdcOptions)));
    OsdFar::PatchTableFactory::Options options(3);
    options.SetEndCapType(OsdFar::PatchTableFactory::Options::ENDCAP_GREGORY_BASIS);
    options.generateFVarTables = hasFVar;
    options.generateFVarLegacyLinearPatches = false;
    refiner->RefineAdaptive(options.GetRefineAdaptiveOptions());
    std::unique_ptr<OsdFar::PatchTable> table(OsdFar::PatchTableFactory::Create(*refiner, options));
    *numPoints = refiner->GetNumVerticesTotal() + table->GetNumLocalPoints();
    if (hasFVar) {
        *numPoints = refiner->GetNumFVarValuesTotal(0) + table->GetNumLocalPointsFaceVarying(0);
    }
    return table;
}

// Places of all patches, several of each, corners and sides among them; in order or not.
Coords makeCoords(OsdFar::PatchTable const &table, bool isRandom) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> number(0, 1);
    Coords result;
    bool const isTriangular =
        table.GetPatchArrayDescriptor(0).GetType() == OsdFar::PatchDescriptor::LOOP ||
        table.GetPatchArrayDescriptor(0).GetType() == OsdFar::PatchDescriptor::GREGORY_TRIANGLE;
    int patchIndex = 0;
    for (int array = 0; array < table.GetNumPatchArrays(); ++array) {
        for (int i = 0; i < table.GetNumPatches(array); ++i, ++patchIndex) {
            OsdFar::PatchTable::PatchHandle handle;
            handle.arrayIndex = array;
            handle.patchIndex = patchIndex;
            handle.vertIndex = i * table.GetPatchArrayDescriptor(array).GetNumControlVertices();
            // In the patch; Osd takes places in its face.
            std::vector<std::pair<float, float>> places = {{0, 0}, {0.25f, 0}, {0.5f, 0.25f}};
            if (!isTriangular) {
                places.insert(places.end(), {{1, 0.5f}, {1, 1}});
            }
            for (int k = 0; k < 3; ++k) {
                float const s = number(random);
                places.emplace_back(s, isTriangular ? (1 - s) * number(random) : number(random));
            }
            for (auto place : places) {
                OsdFar::PatchParam const param = table.GetPatchParam(array, i);
                if (isTriangular) {
                    param.UnnormalizeTriangle(place.first, place.second);
                } else {
                    param.Unnormalize(place.first, place.second);
                }
                result.coords.emplace_back(handle, place.first, place.second);
            }
        }
    }
    if (isRandom) {
        std::shuffle(result.coords.begin(), result.coords.end(), random);
    }
    return result;
}

Buffer makePoints(int numPoints, Osd::BufferDescriptor const &desc) {
    Buffer buffer;
    for (int i = 0; i < desc.offset + desc.stride * numPoints; ++i) {
        buffer.values.push_back(float(std::sin(0.7 * i) + 0.2 * std::cos(1.3 * i)));
    }
    return buffer;
}

// Evaluates by both, and compares.
template <typename EVALUATOR>
void compare(OsdFar::PatchTable const &table, int numPoints, Coords coords, int length, int stride,
             int numOutputs, int fvarChannel = -1) {
    std::unique_ptr<Osd::CpuPatchTable> const cpuTable(Osd::CpuPatchTable::Create(&table));
    Osd::BufferDescriptor const src(2, length, stride);
    Osd::BufferDescriptor const dst(1, length, stride + 1);
    Buffer points = makePoints(numPoints, src);
    constexpr float kUnset = 17;
    Buffer expected[6];
    Buffer found[6];
    for (int i = 0; i < 6; ++i) {
        auto const size = std::size_t(1 + (stride + 1) * coords.GetNum());
        expected[i].values.assign(size, kUnset);
        found[i].values.assign(size, kUnset);
    }
    auto const run = [&](auto *evaluator, Buffer *out) {
        using Evaluator = std::remove_pointer_t<decltype(evaluator)>;
        if (fvarChannel >= 0) {
            return Evaluator::EvalPatchesFaceVarying(&points, src, out, dst, out + 1, dst, out + 2,
                                                     dst, coords.GetNum(), &coords, cpuTable.get(),
                                                     fvarChannel);
        }
        switch (numOutputs) {
        case 1:
            return Evaluator::EvalPatches(&points, src, out, dst, coords.GetNum(), &coords,
                                          cpuTable.get());
        case 3:
            return Evaluator::EvalPatches(&points, src, out, dst, out + 1, dst, out + 2, dst,
                                          coords.GetNum(), &coords, cpuTable.get());
        default:
            return Evaluator::EvalPatches(&points, src, out, dst, out + 1, dst, out + 2, dst,
                                          out + 3, dst, out + 4, dst, out + 5, dst, coords.GetNum(),
                                          &coords, cpuTable.get());
        }
    };
    ASSERT_TRUE(run(static_cast<Osd::CpuEvaluator *>(nullptr), expected));
    ASSERT_TRUE(run(static_cast<EVALUATOR *>(nullptr), found));
    for (int i = 0; i < 6; ++i) {
        double size = 1;
        for (float value : expected[i].values) {
            size = std::max(size, double(std::abs(value)));
        }
        for (std::size_t k = 0; k < found[i].values.size(); ++k) {
            ASSERT_NEAR(found[i].values[k], expected[i].values[k], 4e-6 * size)
                << "output " << i << ", float " << k;
        }
    }
}

void compareAll(OsdFar::PatchTable const &table, int numPoints) {
    for (bool isRandom : {false, true}) {
        Coords const coords = makeCoords(table, isRandom);
        for (int length : {1, 3, 4, 7}) {
            for (int numOutputs : {1, 3, 6}) {
                SCOPED_TRACE(testing::Message() << "length " << length << ", outputs " << numOutputs
                                                << ", random " << isRandom);
                ASSERT_NO_FATAL_FAILURE(compare<OsdExt::CpuEvaluator>(
                    table, numPoints, coords, length, length + 2, numOutputs));
                ASSERT_NO_FATAL_FAILURE(compare<OsdExt::ParallelEvaluator>(
                    table, numPoints, coords, length, length, numOutputs));
            }
        }
    }
}

std::unique_ptr<FarExt::TopologyRefiner> makeRefiner(Shape const &shape, int level) {
    ShapeDescriptor const descriptor(shape);
    Sdc::Options sdcOptions;
    sdcOptions.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    auto refiner = FarExt::TopologyRefinerFactory::Create(descriptor.Get(), sdcOptions);
    refiner->RefineUniform(FarExt::PatchTableFactory::Options(level).GetRefineUniformOptions());
    return refiner;
}

} // namespace

// With boundaries, creases and corners: regular patches and Gregory ones at several levels.
TEST(EvalPatches, IsOsdsOfCatmullClark) {
    for (char const *name : {"cube", "quadGrid", "mixedPatch", "creaseLoopQuads"}) {
        SCOPED_TRACE(name);
        int numPoints = 0;
        auto const table =
            makeTable(findShape(name), OpenSubdiv::Sdc::SCHEME_CATMARK, false, &numPoints);
        ASSERT_NO_FATAL_FAILURE(compareAll(*table, numPoints));
    }
}

TEST(EvalPatches, IsOsdsOfLoop) {
    int numPoints = 0;
    auto const table =
        makeTable(findShape("icosahedron"), OpenSubdiv::Sdc::SCHEME_LOOP, false, &numPoints);
    ASSERT_NO_FATAL_FAILURE(compareAll(*table, numPoints));
}

TEST(EvalPatches, IsOsdsOfPatchTableFactory) {
    for (char const *name : {"cube", "icosahedron", "mixedPatch"}) {
        SCOPED_TRACE(name);
        auto const refiner = makeRefiner(findShape(name), 1);
        auto const table = FarExt::PatchTableFactory::Create(*refiner, 1);
        ASSERT_TRUE(table);
        ASSERT_NO_FATAL_FAILURE(
            compareAll(*table, refiner->GetLevel(0).GetNumVertices() + table->GetNumLocalPoints()));
    }
}

TEST(EvalPatches, IsOsdsOfFaceVaryingData) {
    Shape shape = GetShape("quadGrid");
    shape.fvarChannels = {MakeVertexChannel(shape)};
    int numPoints = 0;
    auto const table = makeTable(shape, OpenSubdiv::Sdc::SCHEME_CATMARK, true, &numPoints);
    ASSERT_EQ(table->GetNumFVarChannels(), 1);
    ASSERT_NO_FATAL_FAILURE(
        compare<OsdExt::CpuEvaluator>(*table, numPoints, makeCoords(*table, true), 2, 2, 3, 0));
}

// Both patches of a side give the same bits, where the places are the same.
TEST(EvalPatches, SidesAreTheSameBits) {
    auto const refiner = makeRefiner(GetShape("cube"), 2);
    auto const table = FarExt::PatchTableFactory::Create(*refiner, 2);
    ASSERT_TRUE(table);
    std::unique_ptr<Osd::CpuPatchTable> const cpuTable(Osd::CpuPatchTable::Create(table.get()));
    Osd::BufferDescriptor const desc(0, 3, 3);
    Buffer points =
        makePoints(refiner->GetLevel(0).GetNumVertices() + table->GetNumLocalPoints(), desc);
    auto const evaluate = [&](int patch, int side, float part) {
        float const s[] = {part, 1, 1 - part, 0};
        float const t[] = {0, part, 1, 1 - part};
        OsdFar::PatchTable::PatchHandle handle;
        handle.arrayIndex = 0;
        handle.patchIndex = patch;
        handle.vertIndex = 20 * patch;
        Coords coords{{Osd::PatchCoord(handle, s[side], t[side])}};
        Buffer out{std::vector<float>(3)};
        EXPECT_TRUE(OsdExt::CpuEvaluator::EvalPatches(&points, desc, &out, desc, 1, &coords,
                                                      cpuTable.get()));
        return out.values;
    };
    int numShared = 0;
    for (int a = 0; a < table->GetNumPatchesTotal(); ++a) {
        for (int b = a + 1; b < table->GetNumPatchesTotal(); ++b) {
            auto const ofA = table->GetPatchVertices(0, a);
            auto const ofB = table->GetPatchVertices(0, b);
            for (int i = 0; i < 4; ++i) {
                for (int k = 0; k < 4; ++k) {
                    if (ofA[5 * i + 1] != ofB[5 * ((k + 1) % 4) + 2]) {
                        continue;
                    }
                    ++numShared;
                    for (float part : {0.125f, 0.375f, 0.5f, 0.8125f}) {
                        EXPECT_EQ(evaluate(a, i, part), evaluate(b, k, 1 - part));
                    }
                }
            }
        }
    }
    EXPECT_EQ(numShared, 2 * table->GetNumPatchesTotal());
}

TEST(EvalPatches, RefusesWhatIsWrong) {
    auto const refiner = makeRefiner(GetShape("cube"), 1);
    auto const table = FarExt::PatchTableFactory::Create(*refiner, 1);
    std::unique_ptr<Osd::CpuPatchTable> const cpuTable(Osd::CpuPatchTable::Create(table.get()));
    Osd::BufferDescriptor const desc(0, 3, 3);
    Buffer points =
        makePoints(refiner->GetLevel(0).GetNumVertices() + table->GetNumLocalPoints(), desc);
    Coords coords = makeCoords(*table, false);
    Buffer out{std::vector<float>(3 * std::size_t(coords.GetNum()), 17)};
    Buffer const before = out;
    using Evaluator = OsdExt::CpuEvaluator;
    Buffer *const none = nullptr;
    auto const run = [&](Osd::BufferDescriptor const &src, Osd::BufferDescriptor const &dst) {
        return Evaluator::EvalPatches(&points, src, &out, dst, coords.GetNum(), &coords,
                                      cpuTable.get());
    };
    EXPECT_FALSE(run(desc, Osd::BufferDescriptor(0, 2, 3)));
    EXPECT_FALSE(run(Osd::BufferDescriptor(0, 0, 3), Osd::BufferDescriptor(0, 0, 3)));
    EXPECT_FALSE(run(Osd::BufferDescriptor(-1, 3, 3), desc));
    EXPECT_FALSE(run(desc, Osd::BufferDescriptor(0, 3, 2)));
    EXPECT_FALSE(
        Evaluator::EvalPatches(none, desc, &out, desc, coords.GetNum(), &coords, cpuTable.get()));
    EXPECT_FALSE(Evaluator::EvalPatches(&points, desc, &out, desc, coords.GetNum(), &coords,
                                        static_cast<Osd::CpuPatchTable *>(nullptr)));
    EXPECT_EQ(out.values, before.values);
    EXPECT_TRUE(Evaluator::EvalPatches(&points, desc, &out, desc, 0, &coords, cpuTable.get()));
    EXPECT_EQ(out.values, before.values);
    // Outputs that are not there are left out.
    EXPECT_TRUE(Evaluator::EvalPatches(&points, desc, none, desc, &out, desc, none, desc,
                                       coords.GetNum(), &coords, cpuTable.get()));
    EXPECT_NE(out.values, before.values);
}

} // namespace OpenSubdivHex::Regression::patchEvaluationTest

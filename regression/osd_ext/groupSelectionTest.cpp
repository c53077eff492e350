// SPDX-License-Identifier: Apache-2.0
//
// Parts of refinements, which some vertices need, against the whole.
#include "osd_ext/refinement/groupSelection.h"
#include "osd_ext/refinement/refinementKernel.h"

#include "far_ext/topologyRefinerFactory.h"
#include "far_ext/vtr/hierarchy.h"
#include "regression/shapes/featureShapes.h"
#include "regression/shapes/shapeDescriptor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <stdexcept>
#include <vector>

namespace OpenSubdivHex::Regression::groupSelectionTest {

using FarExt::TopologyRefiner;
using FarExt::internal::MeshLevels;
using OsdExt::internal::PreparedRefinement;
using OsdExt::internal::RefinementGroups;
using OsdExt::internal::RefinementTask;

namespace {

constexpr int kLength = 3;
constexpr int kNumTiles = 2;
constexpr float kUntouched = 0x1p100f;

/// One more float may be read.
std::vector<float> makeElements(int count, float value) {
    return std::vector<float>(std::size_t(count) * kLength + 1, value);
}

std::unique_ptr<TopologyRefiner> createRefiner(Shape const &shape, FarExt::FirstStep firstStep,
                                               int level) {
    FarExt::TopologyRefinerFactory::Options options;
    options.schemeOptions.faceMask = FarExt::FaceMask::Smooth;
    options.schemeOptions.firstStep = firstStep;
    auto refiner = FarExt::TopologyRefinerFactory::Create(ShapeDescriptor(shape).Get(),
                                                          Sdc::Options(), options);
    if (!refiner || !refiner->RefineUniform(level)) {
        throw std::runtime_error(shape.name + " cannot be refined");
    }
    return refiner;
}

/// Some vertices, near one another and not: a part of the faces makes them.
std::vector<unsigned char> chooseVertices(int numVertices, std::mt19937 &random) {
    constexpr unsigned kOneIn = 150;
    constexpr int kSpan = 9;
    std::vector<unsigned char> marks(std::size_t(numVertices), 0);
    for (int i = 0; i < numVertices; ++i) {
        if (random() % kOneIn == 0) {
            for (int k = i; k < std::min(numVertices, i + kSpan); k += 1 + int(random() % 4)) {
                marks[std::size_t(k)] = 1;
            }
        }
    }
    return marks;
}

/// Gives whether there was a part to be compared.
bool expectPart(PreparedRefinement const &prepared, FarExt::internal::Refinement const &refinement,
                std::vector<float> const &src, std::vector<float> const &whole,
                std::mt19937 &random) {
    int const numVertices = refinement.child->numVertices;
    std::vector<unsigned char> const isNeeded = chooseVertices(numVertices, random);
    auto const groups = OsdExt::internal::SelectGroups(prepared, refinement, isNeeded);
    if (!groups) {
        return false;
    }
    std::vector<float> part = makeElements(numVertices, kUntouched);
    OsdExt::internal::RefineElements(
        {{&prepared, {src.data(), kLength}, {part.data(), kLength}, &*groups}}, kLength);
    std::size_t numUntouched = 0;
    for (int vert = 0; vert < numVertices; ++vert) {
        for (int i = 0; i < kLength; ++i) {
            auto const at = std::size_t(vert * kLength + i);
            // Others may be made along with those that are needed.
            if (isNeeded[std::size_t(vert)] == 0 && part[at] == kUntouched) {
                ++numUntouched;
            } else {
                EXPECT_EQ(part[at], whole[at]) << "vertex " << vert;
            }
        }
    }
    EXPECT_GT(numUntouched, 0u);
    return true;
}

/// Gives the number of parts.
int expectParts(TopologyRefiner const &refiner, std::mt19937 &random) {
    MeshLevels const &mesh = refiner.GetHierarchy().mesh;
    OsdExt::internal::TileMap tileMap(mesh.levels[0], kNumTiles);
    std::vector<FarExt::internal::Refinement const *> refinements;
    std::vector<float> src = makeElements(mesh.levels[0].numVertices, 0);
    for (std::size_t i = 0; i < src.size(); ++i) {
        src[i] = float(std::sin(double(i) * 1.7));
    }
    int numParts = 0;
    for (std::size_t level = 0; level < mesh.refinements.size(); ++level) {
        if (level > 0) {
            tileMap.Refine(*refinements[level - 1], level > 1 ? refinements[level - 2] : nullptr);
        }
        FarExt::internal::Refinement const &refinement = mesh.refinements[level];
        refinements.push_back(&refinement);
        PreparedRefinement prepared;
        OsdExt::internal::PrepareRefinement(
            FarExt::internal::GetRules(mesh.levels[level], refiner.GetHexSchemeOptions(),
                                       FarExt::Interpolation::Vertex),
            refinements, tileMap, prepared);
        std::vector<float> dst = makeElements(refinement.child->numVertices, kUntouched);
        OsdExt::internal::RefineElements(
            {{&prepared, {src.data(), kLength}, {dst.data(), kLength}}}, kLength);
        numParts += int(expectPart(prepared, refinement, src, dst, random));
        src = std::move(dst);
    }
    return numParts;
}

} // namespace

TEST(GroupSelection, MakesTheSameBits) {
    std::mt19937 random(5);
    int numParts = 0;
    int numLevels = 0;
    for (Shape const &shape : GetAllShapes()) {
        if (shape.GetNumCorners() > 60) {
            continue;
        }
        for (auto firstStep : {FarExt::FirstStep::Same, FarExt::FirstStep::Truncate}) {
            SCOPED_TRACE(testing::Message() << shape.name << ", step " << int(firstStep));
            auto const refiner = createRefiner(shape, firstStep, 4);
            numParts += expectParts(*refiner, random);
            numLevels += refiner->GetMaxLevel();
            if (HasFailure()) {
                return;
            }
        }
    }
    // Else most would be done as a whole.
    EXPECT_GT(numParts, numLevels / 2);
}

} // namespace OpenSubdivHex::Regression::groupSelectionTest

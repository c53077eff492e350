// SPDX-License-Identifier: Apache-2.0
#include "referenceMatch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <memory>

namespace OpenSubdivHex::Regression {

using FarExt::Status;
using FarExt::StatusCode;
using FarExt::TopologyLevel;
using FarExt::internal::Buffer;
using FarExt::internal::LevelTopology;

namespace {

template <typename T, typename VALUES>
void append(std::vector<T> &to, VALUES const &values) {
    to.insert(to.end(), values.begin(), values.end());
}

template <typename T>
void assign(Buffer<T> &buffer, std::vector<T> const &values) {
    buffer.Resize(values.size());
    std::copy(values.begin(), values.end(), buffer.data());
}

/// The arrays of a level, as its public queries tell them.
std::unique_ptr<LevelTopology> copyLevel(TopologyLevel const &level) {
    auto copy = std::make_unique<LevelTopology>();
    copy->numVertices = level.GetNumVertices();
    copy->numEdges = level.GetNumEdges();
    copy->numFaces = level.GetNumFaces();
    copy->numCorners = level.GetNumFaceVertices();
    copy->numFreeBoundaries = level.GetTopology().numFreeBoundaries;
    copy->numSharpBoundariesA = level.GetTopology().numSharpBoundariesA;
    copy->numSharpBoundariesB = level.GetTopology().numSharpBoundariesB;
    copy->depth = level.GetDepth();
    copy->hasFullTopology = true;
    copy->isHexagonal = level.GetTopology().isHexagonal;
    copy->numVVertices = level.GetTopology().numVVertices;
    copy->numVFaces = level.GetTopology().numVFaces;

    using Indices = std::vector<Far::Index>;
    using LocalIndices = std::vector<Far::LocalIndex>;
    Indices faceFirstCorner{0}, faceVerts, faceEdges;
    for (int f = 0; f < level.GetNumFaces(); ++f) {
        append(faceVerts, level.GetFaceVertices(f));
        append(faceEdges, level.GetFaceEdges(f));
        faceFirstCorner.push_back(int(faceVerts.size()));
    }
    Indices edgeVerts, edgeFaces, boundaryEdges;
    LocalIndices edgeFaceLocals;
    for (int e = 0; e < level.GetNumEdges(); ++e) {
        append(edgeVerts, level.GetEdgeVertices(e));
        append(edgeFaces, level.GetEdgeFaces(e));
        append(edgeFaceLocals, level.GetEdgeFaceLocalIndices(e));
        if (level.IsEdgeBoundary(e)) {
            boundaryEdges.push_back(e);
            edgeFaces.push_back(level.GetTopology().edgeFaces[2 * std::size_t(e) + 1]);
            edgeFaceLocals.push_back(0);
        }
    }
    Indices const faceChildFaces(level.GetTopology().faceChildFaces.begin(),
                                 level.GetTopology().faceChildFaces.end());
    Indices halfFaces;
    for (int f = 0; f < level.GetNumFaces(); ++f) {
        if (level.IsFaceHalf(f)) {
            halfFaces.push_back(f);
        }
    }
    Indices vertFirstFace{0}, vertFaces, vertFirstEdge{0}, vertEdges;
    LocalIndices vertFaceLocals, vertEdgeLocals;
    for (int v = 0; v < level.GetNumVertices(); ++v) {
        append(vertFaces, level.GetVertexFaces(v));
        append(vertFaceLocals, level.GetVertexFaceLocalIndices(v));
        append(vertEdges, level.GetVertexEdges(v));
        append(vertEdgeLocals, level.GetVertexEdgeLocalIndices(v));
        vertFirstFace.push_back(int(vertFaces.size()));
        vertFirstEdge.push_back(int(vertEdges.size()));
    }
    assign(copy->faceFirstCorner, faceFirstCorner);
    assign(copy->faceVerts, faceVerts);
    assign(copy->faceEdges, faceEdges);
    assign(copy->edgeVerts, edgeVerts);
    assign(copy->edgeFaces, edgeFaces);
    assign(copy->edgeFaceLocals, edgeFaceLocals);
    assign(copy->boundaryEdges, boundaryEdges);
    assign(copy->halfFaces, halfFaces);
    assign(copy->vertFirstFace, vertFirstFace);
    assign(copy->vertFaces, vertFaces);
    assign(copy->vertFaceLocals, vertFaceLocals);
    assign(copy->vertFirstEdge, vertFirstEdge);
    assign(copy->vertEdges, vertEdges);
    assign(copy->vertEdgeLocals, vertEdgeLocals);
    assign(copy->faceChildFaces, faceChildFaces);
    return copy;
}

/// Leaves the face-vertices alone, as in a last level.
void clearRelations(LevelTopology &level) {
    level.hasFullTopology = false;
    for (Buffer<Far::Index> *array : {&level.faceEdges, &level.edgeVerts, &level.edgeFaces,
                                      &level.boundaryEdges, &level.halfFaces, &level.vertFirstFace,
                                      &level.vertFaces, &level.vertFirstEdge, &level.vertEdges}) {
        array->Resize(0);
    }
    for (Buffer<Far::LocalIndex> *array :
         {&level.edgeFaceLocals, &level.vertFaceLocals, &level.vertEdgeLocals}) {
        array->Resize(0);
    }
}

bool isValid(LevelTopology const &topology, Status *status = nullptr) {
    return TopologyLevel(&topology).Validate(status);
}

/// Puts wrong values in every place of an array, one at a time; each must be found.
template <typename T>
void expectEveryChangeIsFound(LevelTopology const &topology, Buffer<T> &buffer, char const *name,
                              std::function<bool(std::size_t)> const &isMeaningful) {
    for (std::size_t i = 0; i < buffer.size(); ++i) {
        if (!isMeaningful(i)) {
            continue;
        }
        T const original = buffer[i];
        // Negative entries tell kinds of boundary; which of them is a tag.
        for (int wrong : {int(original) + 1, int(original) - 1, 60000}) {
            if (int(original) < 0 && wrong < 0) {
                continue;
            }
            buffer[i] = T(wrong);
            Status status;
            EXPECT_FALSE(isValid(topology, &status))
                << name << "[" << i << "] = " << wrong << " instead of " << original;
            EXPECT_EQ(status.GetCode(), StatusCode::InvalidTopology);
            EXPECT_FALSE(status.GetMessage().empty());
        }
        buffer[i] = original;
    }
    EXPECT_TRUE(isValid(topology));
    std::vector<T> const all(buffer.begin(), buffer.end());
    if (!all.empty()) {
        buffer.Resize(all.size() - 1);
        EXPECT_FALSE(isValid(topology)) << name << " one short";
        assign(buffer, all);
    }
}

void expectEveryChangeIsFound(LevelTopology &topology) {
    auto const always = [](std::size_t) { return true; };
    // The place of the second face of a boundary edge has no meaning.
    auto const hasFace = [&](std::size_t i) { return topology.edgeFaces[i] >= 0; };
    expectEveryChangeIsFound(topology, topology.faceFirstCorner, "faceFirstCorner", always);
    expectEveryChangeIsFound(topology, topology.faceVerts, "faceVerts", always);
    expectEveryChangeIsFound(topology, topology.faceEdges, "faceEdges", always);
    expectEveryChangeIsFound(topology, topology.edgeVerts, "edgeVerts", always);
    expectEveryChangeIsFound(topology, topology.edgeFaces, "edgeFaces", always);
    expectEveryChangeIsFound(topology, topology.edgeFaceLocals, "edgeFaceLocals", hasFace);
    expectEveryChangeIsFound(topology, topology.boundaryEdges, "boundaryEdges", always);
    expectEveryChangeIsFound(topology, topology.vertFirstFace, "vertFirstFace", always);
    expectEveryChangeIsFound(topology, topology.vertFaces, "vertFaces", always);
    expectEveryChangeIsFound(topology, topology.vertFaceLocals, "vertFaceLocals", always);
    expectEveryChangeIsFound(topology, topology.vertFirstEdge, "vertFirstEdge", always);
    expectEveryChangeIsFound(topology, topology.vertEdges, "vertEdges", always);
    expectEveryChangeIsFound(topology, topology.vertEdgeLocals, "vertEdgeLocals", always);
}

} // namespace

TEST(Validate, FindsEveryWrongEntry) {
    for (char const *name : {"tetrahedron", "quadGrid", "mixedPatch", "closedAndOpen"}) {
        SCOPED_TRACE(name);
        for (auto rule : {Sdc::Options::VTX_BOUNDARY_NONE, Sdc::Options::VTX_BOUNDARY_EDGE_ONLY}) {
            Sdc::Options options;
            options.SetVtxBoundaryInterpolation(rule);
            auto const refiner = CreateRefiner(GetShape(name), ReferenceMask::Average, 1, options);
            for (int level = 0; level <= 1; ++level) {
                SCOPED_TRACE("level " + std::to_string(level));
                auto const topology = copyLevel(refiner->GetLevel(level));
                ASSERT_TRUE(isValid(*topology));
                expectEveryChangeIsFound(*topology);
            }
        }
    }
}

TEST(Validate, FindsWrongFaceVerticesWithoutOtherRelations) {
    auto const refiner = CreateRefiner(GetShape("quadGrid"), ReferenceMask::Average, 0);
    auto const topology = copyLevel(refiner->GetLevel(0));
    clearRelations(*topology);
    ASSERT_TRUE(isValid(*topology));
    for (int corner = 0; corner < topology->numCorners; ++corner) {
        Far::Index const original = topology->faceVerts[corner];
        Far::Index const inSameFace = topology->faceVerts[corner ^ 2];
        for (Far::Index wrong : {-1, topology->numVertices, inSameFace}) {
            topology->faceVerts[corner] = wrong;
            Status status;
            EXPECT_FALSE(isValid(*topology, &status)) << corner << " " << wrong;
            EXPECT_EQ(status.GetComponentType(), FarExt::ComponentType::Face);
            EXPECT_EQ(status.GetComponentIndex(), corner / 4);
        }
        topology->faceVerts[corner] = original;
    }
    topology->faceFirstCorner[3] -= 2;
    EXPECT_FALSE(isValid(*topology));
}

TEST(Validate, FindsFacesThatAreNotTheParents) {
    auto const refiner = CreateRefiner(GetShape("mixedPatch"), ReferenceMask::Average, 2);
    auto const parent = copyLevel(refiner->GetLevel(0));
    auto const child = copyLevel(refiner->GetLevel(1));
    child->parent = parent.get();
    parent->child = child.get();
    clearRelations(*child);
    ASSERT_TRUE(isValid(*child));
    for (int f = 0; f < child->numFaces; ++f) {
        // Another valid start of the same face is another numbering, so it is wrong too.
        auto *const first = child->faceVerts.data() + child->faceFirstCorner[f];
        auto *const last = child->faceVerts.data() + child->faceFirstCorner[f + 1];
        std::rotate(first, first + 1, last);
        Status status;
        EXPECT_FALSE(isValid(*child, &status)) << f;
        EXPECT_EQ(status.GetComponentType(), FarExt::ComponentType::Face);
        EXPECT_EQ(status.GetComponentIndex(), f);
        std::rotate(first, last - 1, last);
    }
    EXPECT_TRUE(isValid(*child));
}

TEST(Validate, NamesTheComponent) {
    auto const refiner = CreateRefiner(GetShape("quadGrid"), ReferenceMask::Average, 0);
    auto const topology = copyLevel(refiner->GetLevel(0));
    topology->faceVerts[4 * 7 + 2] = topology->faceVerts[4 * 7];
    Status status;
    EXPECT_FALSE(isValid(*topology, &status));
    EXPECT_EQ(status.GetComponentType(), FarExt::ComponentType::Face);
    EXPECT_EQ(status.GetComponentIndex(), 7);
    EXPECT_NE(status.GetMessage().find("face 7"), std::string::npos) << status.GetMessage();
}

} // namespace OpenSubdivHex::Regression

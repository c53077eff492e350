// SPDX-License-Identifier: Apache-2.0
#include "referenceMatch.h"

#include "far_ext/vtr/validator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <memory>

namespace OpenSubdivHex::Regression::validateTest {

using FarExt::CallStatus;
using FarExt::StatusCode;
using FarExt::TopologyLevel;
using FarExt::internal::Buffer;
using FarExt::internal::IndexPair;
using FarExt::internal::Level;
using FarExt::internal::LocalIndexPair;
using FarExt::internal::Refinement;

namespace {

template <typename T, typename VALUES>
void append(std::vector<T> &to, VALUES const &values) {
    to.insert(to.end(), values.begin(), values.end());
}

/// The arrays of a level, as its public queries tell them.
std::unique_ptr<Level> copyLevel(TopologyLevel const &level) {
    auto copy = std::make_unique<Level>();
    Level const &original = level.GetLevel();
    copy->numVertices = level.GetNumVertices();
    copy->numEdges = level.GetNumEdges();
    copy->numFaces = level.GetNumFaces();
    copy->numCorners = level.GetNumFaceVertices();
    copy->numFreeBoundaries = original.numFreeBoundaries;
    copy->numSharpBoundariesA = original.numSharpBoundariesA;
    copy->numSharpBoundariesB = original.numSharpBoundariesB;
    copy->depth = level.GetDepth();
    copy->hasFullTopology = true;
    copy->isHexagonal = original.isHexagonal;
    copy->numVVertices = original.numVVertices;
    copy->numFFaces = original.numFFaces;
    copy->numVFaces = original.numVFaces;

    using Indices = std::vector<Far::Index>;
    using LocalIndices = std::vector<Far::LocalIndex>;
    Indices faceFirstCorner{0}, faceVerts, faceEdges, halfFaces;
    for (int f = 0; f < level.GetNumFaces(); ++f) {
        append(faceVerts, level.GetFaceVertices(f));
        append(faceEdges, level.GetFaceEdges(f));
        faceFirstCorner.push_back(int(faceVerts.size()));
        if (level.IsFaceHalf(f)) {
            halfFaces.push_back(f);
        }
    }
    std::vector<IndexPair> edgeVerts, edgeFaces;
    std::vector<LocalIndexPair> edgeFaceLocals;
    Indices boundaryEdges;
    for (int e = 0; e < level.GetNumEdges(); ++e) {
        auto const verts = level.GetEdgeVertices(e);
        auto const faces = level.GetEdgeFaces(e);
        auto const locals = level.GetEdgeFaceLocalIndices(e);
        bool const isBoundary = level.IsEdgeBoundary(e);
        edgeVerts.push_back({verts[0], verts[1]});
        edgeFaces.push_back({faces[0], isBoundary ? original.edgeFaces[e][1] : faces[1]});
        edgeFaceLocals.push_back({locals[0], isBoundary ? Far::LocalIndex(0) : locals[1]});
        if (isBoundary) {
            boundaryEdges.push_back(e);
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
    copy->faceFirstCorner.Assign(faceFirstCorner);
    copy->faceVerts.Assign(faceVerts);
    copy->faceEdges.Assign(faceEdges);
    copy->edgeVerts.Assign(edgeVerts);
    copy->edgeFaces.Assign(edgeFaces);
    copy->edgeFaceLocals.Assign(edgeFaceLocals);
    copy->boundaryEdges.Assign(boundaryEdges);
    copy->halfFaces.Assign(halfFaces);
    copy->vertFirstFace.Assign(vertFirstFace);
    copy->vertFaces.Assign(vertFaces);
    copy->vertFaceLocals.Assign(vertFaceLocals);
    copy->vertFirstEdge.Assign(vertFirstEdge);
    copy->vertEdges.Assign(vertEdges);
    if (!copy->HasImpliedVertexEdges()) {
        copy->vertEdgeLocals.Assign(vertEdgeLocals);
    }
    return copy;
}

/// Leaves the face-vertices alone, as in a last level.
void clearRelations(Level &level) {
    level.hasFullTopology = false;
    Level::ForEachRelation(level, [](auto &array, std::size_t size) {
        if (size == 0) {
            array.Resize(0);
        }
    });
    level.vertFirstEdge.Resize(0);
}

bool isValid(Level const &level, Refinement const *refinement, CallStatus *status = nullptr) {
    CallStatus const result = FarExt::internal::Validate(level, refinement);
    if (status) {
        *status = result;
    }
    return result.IsOk();
}
bool isValid(Level const &level, CallStatus *status = nullptr) {
    return isValid(level, nullptr, status);
}

/// Entries of arrays of numbers, and of pairs of numbers.
template <typename T>
std::size_t countEntries(Buffer<T> const &buffer) {
    return buffer.size();
}
template <typename T>
T &getEntry(Buffer<T> &buffer, std::size_t i) {
    return buffer[i];
}
template <typename T>
std::size_t countEntries(Buffer<std::array<T, 2>> const &buffer) {
    return 2 * buffer.size();
}
template <typename T>
T &getEntry(Buffer<std::array<T, 2>> &buffer, std::size_t i) {
    return buffer[i / 2][i % 2];
}

/// Puts wrong values in every place of an array, one at a time; each must be found.
template <typename T>
void expectEveryChangeIsFound(Level const &topology, Buffer<T> &buffer, char const *name,
                              std::function<bool(std::size_t)> const &isMeaningful) {
    for (std::size_t i = 0; i < countEntries(buffer); ++i) {
        if (!isMeaningful(i)) {
            continue;
        }
        auto &entry = getEntry(buffer, i);
        auto const original = entry;
        // Negative entries tell kinds of boundary; which of them is a tag.
        for (int wrong : {int(original) + 1, int(original) - 1, 60000}) {
            if (int(original) < 0 && wrong < 0) {
                continue;
            }
            entry = static_cast<std::decay_t<decltype(entry)>>(wrong);
            CallStatus status;
            EXPECT_FALSE(isValid(topology, &status))
                << name << "[" << i << "] = " << wrong << " instead of " << original;
            EXPECT_EQ(status.GetCode(), StatusCode::InvalidTopology);
            EXPECT_FALSE(status.GetErrorMessage().empty());
        }
        entry = original;
    }
    EXPECT_TRUE(isValid(topology));
    std::vector<T> const all(buffer.begin(), buffer.end());
    if (!all.empty()) {
        buffer.Resize(all.size() - 1);
        EXPECT_FALSE(isValid(topology)) << name << " one short";
        buffer.Assign(all);
    }
}

void expectEveryChangeIsFound(Level &topology) {
    auto const always = [](std::size_t) { return true; };
    // The place of the second face of a boundary edge has no meaning.
    auto const hasFace = [&](std::size_t i) { return getEntry(topology.edgeFaces, i) >= 0; };
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
            CallStatus status;
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
    Refinement refinement;
    refinement.parent = parent.get();
    refinement.child = child.get();
    clearRelations(*child);
    ASSERT_TRUE(isValid(*child, &refinement));
    for (int f = 0; f < child->numFaces; ++f) {
        // Another valid start of the same face is another numbering, so it is wrong too.
        auto *const first = child->faceVerts.data() + child->faceFirstCorner[f];
        auto *const last = child->faceVerts.data() + child->faceFirstCorner[f + 1];
        std::rotate(first, first + 1, last);
        CallStatus status;
        EXPECT_FALSE(isValid(*child, &refinement, &status)) << f;
        EXPECT_EQ(status.GetComponentType(), FarExt::ComponentType::Face);
        EXPECT_EQ(status.GetComponentIndex(), f);
        std::rotate(first, last - 1, last);
    }
    EXPECT_TRUE(isValid(*child, &refinement));
}

TEST(Validate, NamesTheComponent) {
    auto const refiner = CreateRefiner(GetShape("quadGrid"), ReferenceMask::Average, 0);
    auto const topology = copyLevel(refiner->GetLevel(0));
    topology->faceVerts[4 * 7 + 2] = topology->faceVerts[4 * 7];
    CallStatus status;
    EXPECT_FALSE(isValid(*topology, &status));
    EXPECT_EQ(status.GetComponentType(), FarExt::ComponentType::Face);
    EXPECT_EQ(status.GetComponentIndex(), 7);
    EXPECT_NE(status.GetErrorMessage().find("face 7"), std::string::npos)
        << status.GetErrorMessage();
}

} // namespace OpenSubdivHex::Regression::validateTest

// SPDX-License-Identifier: Apache-2.0
#include "baseDifference.h"

#include "far_ext/vtr/hierarchy.h"

#include <algorithm>
#include <cstring>

namespace OpenSubdivHex::Regression {

namespace {

using FarExt::internal::FVarChannel;
using FarExt::internal::Level;
using FarExt::internal::SharpVertex;

/// The bytes of an array of elements without padding.
template <typename ARRAY>
std::string getBytes(ARRAY const &array) {
    auto const *const bytes = reinterpret_cast<char const *>(array.data());
    return {bytes, bytes + array.size() * sizeof(*array.data())};
}

/// Returns the bytes of sharp vertices, one member after the other.
std::string getBytes(std::vector<SharpVertex> const &verts) {
    std::string result;
    auto const add = [&](auto const &value) {
        result.append(reinterpret_cast<char const *>(&value), sizeof(value));
    };
    for (SharpVertex const &vert : verts) {
        add(vert.vert);
        add(vert.rule);
        add(vert.vertexWeight);
        add(vert.faceWeight);
        add(vert.neighbors);
        add(vert.neighborWeights);
    }
    return result;
}

/// All of a level, array by array.
std::vector<std::string> getArrays(Level const &level) {
    std::vector<int> const counts = {level.numVertices,
                                     level.numEdges,
                                     level.numFaces,
                                     level.numCorners,
                                     level.numFreeBoundaries,
                                     level.numSharpBoundariesA,
                                     level.numSharpBoundariesB,
                                     level.numVertsOfAnyValence,
                                     int(level.hasFullTopology),
                                     int(level.isHexagonal)};
    std::vector<std::string> arrays{getBytes(counts), getBytes(level.faceSizes)};
    Level::ForEachRelation(level, [&](auto const &array, std::size_t size) {
        arrays.push_back(array.size() == size ? getBytes(array) : "of another size");
    });
    Level::ForEachTag(level, [&](auto const &array) { arrays.push_back(getBytes(array)); });
    return arrays;
}

std::string findDifference(Level const &a, Level const &b) {
    std::vector<std::string> const arraysOfA = getArrays(a);
    std::vector<std::string> const arraysOfB = getArrays(b);
    for (std::size_t i = 0; i < arraysOfA.size(); ++i) {
        if (arraysOfA[i] != arraysOfB[i]) {
            return "array " + std::to_string(i) + " differs";
        }
    }
    return "";
}

std::string findDifference(FVarChannel const &a, FVarChannel const &b) {
    if (a.numValues != b.numValues || a.linearInterpolation != b.linearInterpolation ||
        getBytes(a.valuesOfVertices) != getBytes(b.valuesOfVertices) ||
        getBytes(a.faceValues) != getBytes(b.faceValues)) {
        return "its values differ";
    }
    return findDifference(a.values.levels[0], b.values.levels[0]);
}

} // namespace

std::string FindBaseDifference(FarExt::TopologyRefiner const &a, FarExt::TopologyRefiner const &b) {
    auto const &channelsOfA = a.GetHierarchy().channels;
    auto const &channelsOfB = b.GetHierarchy().channels;
    std::string difference =
        findDifference(a.GetHierarchy().mesh.levels[0], b.GetHierarchy().mesh.levels[0]);
    if (difference.empty() && channelsOfA.size() != channelsOfB.size()) {
        return "other channels";
    }
    for (std::size_t i = 0; i < channelsOfA.size() && difference.empty(); ++i) {
        difference = findDifference(channelsOfA[i], channelsOfB[i]);
        if (!difference.empty()) {
            difference = "channel " + std::to_string(i) + ": " + difference;
        }
    }
    return difference;
}

std::string FindFarDifference(FarExt::TopologyRefiner const &refiner,
                              Far::TopologyLevel const &farLevel) {
    FarExt::TopologyLevel const &level = refiner.GetLevel(0);
    Level const &arrays = level.GetLevel();
    auto const equal = [](Far::ConstIndexArray a, Far::ConstIndexArray b) {
        return std::equal(a.begin(), a.end(), b.begin(), b.end());
    };
    for (int f = 0; f < farLevel.GetNumFaces(); ++f) {
        std::string const face = "face " + std::to_string(f);
        if (!equal(level.GetFaceVertices(f), farLevel.GetFaceVertices(f))) {
            return face + " has other vertices";
        }
        for (int i = 0; i < level.GetFaceVertices(f).size(); ++i) {
            int const edge = level.GetFaceEdges(f)[i];
            int const line = arrays.GetEdgeLine(edge);
            int const farEdge = farLevel.GetFaceEdges(f)[i];
            if ((line == Far::INDEX_INVALID ? edge : line) != farEdge) {
                return face + " has other edges";
            }
            if (level.IsEdgeNonManifold(edge) != farLevel.IsEdgeNonManifold(farEdge)) {
                return "edge " + std::to_string(farEdge) + " is non-manifold in one of both";
            }
        }
    }
    for (int v = 0; v < farLevel.GetNumVertices(); ++v) {
        if (!level.IsVertexNonManifold(v) &&
            (farLevel.IsVertexNonManifold(v) ||
             !equal(level.GetVertexFaces(v), farLevel.GetVertexFaces(v)) ||
             !equal(level.GetVertexEdges(v), farLevel.GetVertexEdges(v)))) {
            return "vertex " + std::to_string(v) + " has other faces or edges";
        }
    }
    return "";
}

} // namespace OpenSubdivHex::Regression

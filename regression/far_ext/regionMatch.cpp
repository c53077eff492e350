// SPDX-License-Identifier: Apache-2.0
#include "regionMatch.h"

#include "far_ext/baseFaceMap.h"
#include "referenceMatch.h"
#include "regression/reference/baseRegions.h"
#include "taggedMatch.h"

#include <algorithm>
#include <set>
#include <sstream>

namespace OpenSubdivHex::Regression {

namespace {

using FarExt::TopologyLevel;

Shape makeSharp(Shape shape) {
    std::set<std::pair<int, int>> edges;
    auto vertex = shape.faceVertices.begin();
    for (int size : shape.faceSizes) {
        for (int i = 0; i < size; ++i) {
            edges.insert(std::minmax(vertex[i], vertex[(i + 1) % size]));
        }
        vertex += size;
    }
    shape.creaseVertexPairs.clear();
    shape.creaseSharpness.clear();
    for (auto const &[v0, v1] : edges) {
        if (v0 != v1) {
            shape.creaseVertexPairs.insert(shape.creaseVertexPairs.end(), {v0, v1});
            shape.creaseSharpness.push_back(kInfiniteSharpness);
        }
    }
    shape.fvarChannels.clear();
    shape.holeFaces.clear();
    return shape;
}

// Compares the base faces of a face with the reference, which has the base faces of its halves.
std::string findFaceError(Shape const &shape, TopologyLevel const &level,
                          FarExt::BaseFaceMap const &map, int face, int const (&regions)[2]) {
    std::ostringstream error;
    bool const isSplit = regions[0] != regions[1];
    if (level.IsFaceBaseSplit(face) != isSplit || map.IsSplit(face) != isSplit) {
        error << "face " << face << " is split, or not, against the reference";
    }
    int numHoles = 0;
    for (int half = 0; half < 2; ++half) {
        if (level.GetFaceBaseFace(face, half) != regions[half] ||
            map.GetBaseFace(face, half) != regions[half]) {
            error << "half " << half << " of face " << face << " lies in base face "
                  << level.GetFaceBaseFace(face, half) << " or " << map.GetBaseFace(face, half)
                  << ", not " << regions[half];
        }
        bool const isHole =
            std::count(shape.holeFaces.begin(), shape.holeFaces.end(), regions[half]) > 0;
        numHoles += isHole ? 1 : 0;
        if (level.IsFaceHole(face, half) != isHole) {
            error << "half " << half << " of face " << face << " is a hole, or not";
        }
    }
    if (level.IsFaceHole(face) != (numHoles == 2)) {
        error << "face " << face << " is a hole, or not";
    }
    return error.str();
}

} // namespace

std::string FindRegionError(Shape const &shape, FarExt::TopologyRefiner const &refiner) {
    Shape const sharp = makeSharp(shape);
    auto const sharpRefiner = CreateRefiner(sharp, ReferenceMask::Average, refiner.GetMaxLevel(),
                                            refiner.GetSchemeOptions());
    TaggedMatch const match(sharp, *sharpRefiner);
    if (!match.GetError().empty()) {
        return "with sharp edges, " + match.GetError();
    }
    FarExt::BaseFaceMap const map(refiner);
    std::vector<TaggedMesh> meshes;
    for (int depth = 0; depth <= refiner.GetMaxLevel(); ++depth) {
        meshes.push_back(match.GetMesh(depth));
        std::vector<int> const regions = FindBaseRegions(meshes);
        TopologyLevel const &level = refiner.GetLevel(depth);
        std::vector<int> halves[2];
        halves[0] = halves[1] = std::vector<int>(std::size_t(level.GetNumFaces()), -1);
        for (int f = 0; f < int(regions.size()); ++f) {
            for (int half = 0; half < 2; ++half) {
                if (match.GetLibraryHalf(depth, f) != 1 - half) {
                    halves[half][std::size_t(match.GetLibraryFace(depth, f))] =
                        regions[std::size_t(f)];
                }
            }
        }
        for (int face = 0; face < level.GetNumFaces(); ++face) {
            std::string const error =
                findFaceError(shape, level, map, face,
                              {halves[0][std::size_t(face)], halves[1][std::size_t(face)]});
            if (!error.empty()) {
                return "level " + std::to_string(depth) + ": " + error;
            }
        }
    }
    return "";
}

} // namespace OpenSubdivHex::Regression

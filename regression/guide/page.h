// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_GUIDE_PAGE_H
#define OPENSUBDIVHEX_REGRESSION_GUIDE_PAGE_H

#include "far_ext/primvarRefiner.h"
#include "far_ext/topologyRefinerFactory.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <vector>

/// \brief Base meshes and checks that the programs of the guide's pages use and do not show.
namespace Page {

namespace Far = OpenSubdiv::Far;

/// The cube of side 2 around the origin.
inline constexpr float kCubePositions[] = {-1, -1, -1, 1, -1, -1, -1, 1, -1, 1, 1, -1,
                                           -1, -1, 1,  1, -1, 1,  -1, 1, 1,  1, 1, 1};

inline Far::TopologyDescriptor DescribeCube() {
    static constexpr int kSizes[] = {4, 4, 4, 4, 4, 4};
    static constexpr int kVertices[] = {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4,
                                        2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5};
    Far::TopologyDescriptor descriptor;
    descriptor.numVertices = 8;
    descriptor.numFaces = 6;
    descriptor.numVertsPerFace = kSizes;
    descriptor.vertIndicesPerFace = kVertices;
    return descriptor;
}

/// Two by two squares; vertex 3 y + x is at (x, y, 0).
inline Far::TopologyDescriptor DescribeSheet() {
    static constexpr int kSizes[] = {4, 4, 4, 4};
    static constexpr int kVertices[] = {0, 1, 4, 3, 1, 2, 5, 4, 3, 4, 7, 6, 4, 5, 8, 7};
    Far::TopologyDescriptor descriptor;
    descriptor.numVertices = 9;
    descriptor.numFaces = 4;
    descriptor.numVertsPerFace = kSizes;
    descriptor.vertIndicesPerFace = kVertices;
    return descriptor;
}

/// \brief Five by five squares, with a channel whose values are the vertices; vertex 6 y + x is at (x, y).
class Grid {
public:
    Grid() {
        for (int v = 0; v < 36; ++v) {
            int const x = v % 6, y = v / 6;
            positions.insert(positions.end(), {float(x), float(y), 0});
            uvs.insert(uvs.end(), {float(x), float(y)});
            if (x < 5 && y < 5) {
                _corners.insert(_corners.end(), {v, v + 1, v + 7, v + 6});
            }
        }
        _channel.numValues = 36;
        _channel.valueIndices = _corners.data();
        descriptor.numVertices = 36;
        descriptor.numFaces = int(_sizes.size());
        descriptor.numVertsPerFace = _sizes.data();
        descriptor.vertIndicesPerFace = _corners.data();
        descriptor.numFVarChannels = 1;
        descriptor.fvarChannels = &_channel;
    }
    Grid(Grid const &) = delete;
    Grid &operator=(Grid const &) = delete;

    Far::TopologyDescriptor descriptor;
    std::vector<float> positions; ///< x, y and 0 of each vertex
    std::vector<float> uvs;       ///< x and y of each vertex

private:
    std::vector<int> _sizes = std::vector<int>(25, 4);
    std::vector<int> _corners;
    Far::TopologyDescriptor::FVarChannel _channel;
};

struct Point {
    void Clear() { x = y = z = 0; }
    void AddWithWeight(Point const &point, float weight) {
        x += weight * point.x;
        y += weight * point.y;
        z += weight * point.z;
    }
    bool operator==(Point const &point) const {
        return x == point.x && y == point.y && z == point.z;
    }
    float x, y, z;
};

inline std::vector<Point> GetSheetPoints() {
    std::vector<Point> points;
    for (int i = 0; i < 9; ++i) {
        points.push_back({float(i % 3), float(i / 3), 0});
    }
    return points;
}

/// The points of the last level.
inline std::vector<Point> Refine(OpenSubdivHex::FarExt::TopologyRefiner const &refiner,
                                 std::vector<Point> points) {
    OpenSubdivHex::FarExt::PrimvarRefiner const primvarRefiner(refiner);
    for (int level = 1; level <= refiner.GetMaxLevel(); ++level) {
        std::vector<Point> children(std::size_t(refiner.GetLevel(level).GetNumVertices()));
        primvarRefiner.Interpolate(level, points, children);
        points.swap(children);
    }
    return points;
}

inline int numFailures = 0;

inline void Expect(bool holds, char const *what) {
    if (!holds) {
        std::fprintf(stderr, "does not hold: %s\n", what);
        ++numFailures;
    }
}

inline int GetExitStatus() { return numFailures == 0 ? 0 : 1; }

} // namespace Page

#endif

// SPDX-License-Identifier: Apache-2.0
#include "baseRegions.h"

#include <cmath>

namespace OpenSubdivHex::Regression {

namespace {

using Point = std::array<double, 2>;

Point mean(Point const &a, Point const &b) { return {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2}; }

// The trapezoid between a side and the side of a polygon of half the size around a centre.
ReferencePolygon makeTrapezoid(Point const &start, Point const &end, Point const &center) {
    return {start, end, mean(end, center), mean(start, center)};
}

ReferencePolygon halve(ReferencePolygon polygon, Point const &center) {
    for (Point &point : polygon) {
        point = mean(point, center);
    }
    return polygon;
}

} // namespace

std::vector<int> FindBaseRegions(std::vector<TaggedMesh> const &levels) {
    TaggedMesh const &last = levels.back();
    std::vector<int> regions(last.faces.size(), -1);
    std::vector<bool> hasSeveral(last.faces.size(), false);
    std::vector<std::vector<int>> neighbors(last.faces.size());
    for (TaggedMesh::Edge const &edge : last.edges) {
        if (edge.sides.size() == 2 && edge.sharpness < kInfiniteSharpness) {
            neighbors[edge.sides[0].face].push_back(edge.sides[1].face);
            neighbors[edge.sides[1].face].push_back(edge.sides[0].face);
        }
    }
    for (std::size_t f = 0; f < last.faces.size(); ++f) {
        // From the faces that were made of faces ever since the first level.
        int region = int(f);
        for (std::size_t level = levels.size() - 1; level > 0 && region >= 0; --level) {
            region = levels[level].faceOrigins[region].face;
        }
        if (region < 0) {
            continue;
        }
        std::vector<int> waiting{int(f)};
        while (!waiting.empty()) {
            int const face = waiting.back();
            waiting.pop_back();
            if (regions[face] == region) {
                continue;
            }
            if (regions[face] >= 0) {
                hasSeveral[face] = true;
                continue;
            }
            regions[face] = region;
            waiting.insert(waiting.end(), neighbors[face].begin(), neighbors[face].end());
        }
    }
    for (std::size_t f = 0; f < regions.size(); ++f) {
        regions[f] = hasSeveral[f] ? -1 : regions[f];
    }
    return regions;
}

std::vector<ReferencePolygon> DivideRegularPolygon(int size, int numLevels) {
    double const turn = 2 * std::acos(-1.0) / size;
    ReferencePolygon polygon{{0, 0}};
    Point center{0, 0};
    for (int i = 1; i < size; ++i) {
        polygon.push_back({polygon.back()[0] + std::cos(turn * (i - 1)),
                           polygon.back()[1] + std::sin(turn * (i - 1))});
        center = {center[0] + polygon.back()[0] / size, center[1] + polygon.back()[1] / size};
    }
    std::vector<ReferencePolygon> trapezoids;
    for (int level = 0; level < numLevels; ++level) {
        std::vector<ReferencePolygon> children;
        for (ReferencePolygon const &trapezoid : trapezoids) {
            Point const middle = mean(trapezoid[0], trapezoid[1]);
            children.push_back(halve(trapezoid, middle));
            for (int i = 1; i < 4; ++i) {
                children.push_back(makeTrapezoid(trapezoid[i], trapezoid[(i + 1) % 4], middle));
            }
        }
        for (int i = 0; i < size; ++i) {
            children.push_back(makeTrapezoid(polygon[i], polygon[(i + 1) % size], center));
        }
        polygon = halve(polygon, center);
        trapezoids = std::move(children);
    }
    trapezoids.insert(trapezoids.begin(), polygon);
    return trapezoids;
}

} // namespace OpenSubdivHex::Regression

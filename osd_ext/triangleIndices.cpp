// SPDX-License-Identifier: Apache-2.0
#include "polygonIndices.h"

#include "far_ext/vtr/parallel.h"

#include <algorithm>

namespace OpenSubdivHex::OsdExt {

namespace {

using Far::Index;

// Where a polygon has its corners, and its triangles.
struct TrianglePlace {
    TrianglePlace &operator+=(TrianglePlace const &other) {
        corner += other.corner;
        triangle += other.triangle;
        return *this;
    }

    std::size_t corner = 0;
    std::size_t triangle = 0;
};

// Calls addTriangle(i, j, k) for the triangles of a polygon, from both ends to the middle in turn.
template <typename FUNCTION>
void forEachTriangle(int size, FUNCTION addTriangle) {
    int low = 0;
    int high = size - 1;
    while (high - low >= 2) {
        addTriangle(low, low + 1, high);
        ++low;
        if (high - low >= 2) {
            addTriangle(low, high - 1, high);
            --high;
        }
    }
}

class Triangulator {
public:
    explicit Triangulator(PolygonIndices const &polygons) : _polygons(polygons) {}

    TriangleIndices Run() {
        Index const numPolygons = _polygons.GetNumPolygons();
        auto const places =
            FarExt::internal::ParallelSums<TrianglePlace>(numPolygons, [&](Index begin, Index end) {
                TrianglePlace sum;
                for (Index i = begin; i < end; ++i) {
                    std::size_t const size = std::size_t(_polygons.sizes[std::size_t(i)]);
                    sum += {size, std::max(size, std::size_t(2)) - 2};
                }
                return sum;
            });
        forEachArray([&](auto const &polygons, auto &triangles, int width) {
            triangles.resize(polygons.empty() ? 0 : std::size_t(width) * places.back().triangle);
        });
        FarExt::internal::ParallelForRange(numPolygons, [&](Index begin, Index end) {
            TrianglePlace const place =
                places[std::size_t(begin / FarExt::internal::kParallelRange)];
            forEachArray([&](auto const &polygons, auto &triangles, int width) {
                if (!polygons.empty()) {
                    write(polygons, triangles, width, begin, end, place);
                }
            });
        });
        _result.drawnVertices = _polygons.drawnVertices;
        return std::move(_result);
    }

private:
    // Calls function(array of the polygons, array of the triangles, width) for all arrays.  The width
    // is 1 of those by face, and three times that of a corner else.
    template <typename FUNCTION>
    void forEachArray(FUNCTION function) {
        _result.fvarValues.resize(_polygons.fvarValues.size());
        function(_polygons.vertices, _result.vertices, 3);
        for (std::size_t i = 0; i < _polygons.fvarValues.size(); ++i) {
            function(_polygons.fvarValues[i], _result.fvarValues[i], 3);
        }
        function(_polygons.sides, _result.sides, 3);
        function(_polygons.baseCoords, _result.baseCoords, 6);
        function(_polygons.faces, _result.faces, 1);
        function(_polygons.baseFaces, _result.baseFaces, 1);
        function(_polygons.labels, _result.labels, 1);
    }

    // Writes the triangles of polygons [begin, end), which begin at place.
    template <typename T>
    void write(std::vector<T> const &polygons, std::vector<T> &triangles, int width, Index begin,
               Index end, TrianglePlace const &place) const {
        T const *from = polygons.data() + std::size_t(width / 3) * place.corner;
        T *to = triangles.data() + std::size_t(width) * place.triangle;
        for (Index i = begin; i < end; ++i) {
            int const size = _polygons.sizes[std::size_t(i)];
            if (width == 1) {
                to = std::fill_n(to, size - 2, polygons[std::size_t(i)]);
                continue;
            }
            int const cornerWidth = width / 3;
            forEachTriangle(size, [&](int a, int b, int c) {
                for (int corner : {a, b, c}) {
                    to = std::copy_n(from + corner * cornerWidth, cornerWidth, to);
                }
            });
            from += size * cornerWidth;
        }
    }

    PolygonIndices const &_polygons;
    TriangleIndices _result;
};

} // namespace

TriangleIndices CreateTriangleIndices(PolygonIndices const &polygons) {
    return Triangulator(polygons).Run();
}

TriangleIndices CreateTriangleIndices(FarExt::TopologyLevel const &level,
                                      DrawOptions const &options, FarExt::CallStatus *status) {
    return CreateTriangleIndices(CreatePolygonIndices(level, options, status));
}

} // namespace OpenSubdivHex::OsdExt

// SPDX-License-Identifier: Apache-2.0
#include "vertexSeparator.h"

#include "far_ext/vtr/parallel.h"
#include "far_ext/vtr/report.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>
#include <string>

namespace OpenSubdivHex::OsdExt::internal {

using FarExt::CallStatus;
using FarExt::StatusCode;
using FarExt::internal::ParallelFor;

namespace {

constexpr std::int64_t kMaxIndex = std::numeric_limits<Far::Index>::max();

CallStatus fail(std::int64_t count, std::string const &what) {
    return FarExt::internal::Failure(StatusCode::TooLarge, "there would be " +
                                                               std::to_string(count) + " " + what +
                                                               ", more than 32-bit indices reach");
}

} // namespace

VertexSeparator::VertexSeparator(Index numVertices, Index vertexOffset, PolygonIndices &polygons)
    : _numVertices(numVertices), _vertexOffset(vertexOffset), _polygons(polygons),
      _firstCorners(new std::atomic<Index>[std::size_t(numVertices)]) {}

CallStatus VertexSeparator::Run() {
    auto const numCorners = std::int64_t(_polygons.vertices.size());
    if (numCorners > kMaxIndex) {
        return fail(numCorners, "corners of separate vertices");
    }
    findBaseFaces();
    findFirstCorners();
    std::vector<Index> const corners =
        FarExt::internal::ParallelSelect(Index(numCorners), [&](Index corner) {
            return !isSame(_firstCorners[std::size_t(getVertex(corner))], corner);
        });
    std::vector<Index> const numbers = addVertices(corners);
    std::int64_t const numDrawn = _numVertices + std::int64_t(_added.size());
    if (_vertexOffset + numDrawn > kMaxIndex) {
        return fail(numDrawn, "separate vertices");
    }
    describe();
    for (std::size_t i = 0; i < corners.size(); ++i) {
        _polygons.vertices[std::size_t(corners[i])] = _vertexOffset + _numVertices + numbers[i];
    }
    return CallStatus();
}

Far::Index VertexSeparator::getVertex(Index corner) const {
    return _polygons.vertices[std::size_t(corner)] - _vertexOffset;
}

// Whether two corners of a vertex have the same.
bool VertexSeparator::isSame(Index a, Index b) const {
    auto const hasSame = [=](std::vector<int> const &values) {
        return values[std::size_t(a)] == values[std::size_t(b)];
    };
    std::vector<float> const &coords = _polygons.baseCoords;
    auto const isSamePlace = [&, i = 2 * std::size_t(a), j = 2 * std::size_t(b)] {
        return coords[i] == coords[j] && coords[i + 1] == coords[j + 1];
    };
    return (_polygons.sides.empty() || hasSame(_polygons.sides)) &&
           (coords.empty() || (hasSame(_baseFaces) && isSamePlace())) &&
           std::all_of(_polygons.fvarValues.begin(), _polygons.fvarValues.end(), hasSame);
}

void VertexSeparator::findBaseFaces() {
    if (_polygons.baseCoords.empty()) {
        return;
    }
    _baseFaces.resize(_polygons.vertices.size());
    Index const numPolygons = _polygons.GetNumPolygons();
    auto const firsts =
        FarExt::internal::ParallelSums<std::size_t>(numPolygons, [&](Index begin, Index end) {
            return std::accumulate(_polygons.sizes.begin() + begin, _polygons.sizes.begin() + end,
                                   std::size_t(0));
        });
    FarExt::internal::ParallelForRange(numPolygons, [&](Index begin, Index end) {
        auto corner = _baseFaces.begin() +
                      std::ptrdiff_t(firsts[std::size_t(begin / FarExt::internal::kParallelRange)]);
        for (Index i = begin; i < end; ++i) {
            corner = std::fill_n(corner, _polygons.sizes[std::size_t(i)],
                                 _polygons.baseFaces[std::size_t(i)]);
        }
    });
}

// The least of all, in whatever order threads come to them.
void VertexSeparator::findFirstCorners() {
    auto const numCorners = Index(_polygons.vertices.size());
    ParallelFor(_numVertices, [&](Index vert) {
        _firstCorners[std::size_t(vert)].store(numCorners, std::memory_order_relaxed);
    });
    ParallelFor(numCorners, [&](Index corner) {
        std::atomic<Index> &first = _firstCorners[std::size_t(getVertex(corner))];
        Index known = first.load(std::memory_order_relaxed);
        while (corner < known &&
               !first.compare_exchange_weak(known, corner, std::memory_order_relaxed)) {
        }
    });
}

// Gives each corner, of those that have other than the first one of their vertex, an added vertex.
std::vector<Far::Index> VertexSeparator::addVertices(std::vector<Index> const &corners) {
    std::vector<Index> lastAdded(corners.empty() ? 0 : std::size_t(_numVertices),
                                 Far::INDEX_INVALID);
    std::vector<Index> numbers;
    numbers.reserve(corners.size());
    for (Index corner : corners) {
        Index const vert = getVertex(corner);
        Index &last = lastAdded[std::size_t(vert)];
        Index number = last;
        while (number >= 0 && !isSame(_added[std::size_t(number)].corner, corner)) {
            number = _added[std::size_t(number)].before;
        }
        if (number < 0) {
            number = Index(_added.size());
            _added.push_back({vert, corner, last});
            last = number;
        }
        numbers.push_back(number);
    }
    return numbers;
}

// Writes what the vertices are.
void VertexSeparator::describe() {
    DrawnVertices &result = _polygons.drawnVertices;
    std::size_t const numDrawn = std::size_t(_numVertices) + _added.size();
    result.vertices.resize(numDrawn);
    result.sides.resize(_polygons.sides.empty() ? 0 : numDrawn);
    result.fvarValues.assign(_polygons.fvarValues.size(), std::vector<int>(numDrawn));
    result.baseCoords.resize(_baseFaces.empty() ? 0 : 2 * numDrawn);
    result.baseFaces.resize(_baseFaces.empty() ? 0 : numDrawn, Far::INDEX_INVALID);
    auto const describeVertex = [&](std::size_t number, Index vert, Index corner) {
        bool const isDrawn = corner < Index(_polygons.vertices.size());
        result.vertices[number] = vert;
        if (!result.sides.empty()) {
            result.sides[number] = isDrawn ? _polygons.sides[std::size_t(corner)] : vert;
        }
        for (std::size_t i = 0; i < result.fvarValues.size(); ++i) {
            result.fvarValues[i][number] =
                isDrawn ? _polygons.fvarValues[i][std::size_t(corner)] : 0;
        }
        if (isDrawn && !_baseFaces.empty()) {
            std::copy_n(&_polygons.baseCoords[2 * std::size_t(corner)], 2,
                        &result.baseCoords[2 * number]);
            result.baseFaces[number] = _baseFaces[std::size_t(corner)];
        }
    };
    ParallelFor(_numVertices, [&](Index vert) {
        describeVertex(std::size_t(vert), vert, _firstCorners[std::size_t(vert)]);
    });
    ParallelFor(Index(_added.size()), [&](Index i) {
        Added const &added = _added[std::size_t(i)];
        describeVertex(std::size_t(_numVertices) + std::size_t(i), added.vert, added.corner);
    });
}

} // namespace OpenSubdivHex::OsdExt::internal

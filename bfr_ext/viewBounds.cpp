// SPDX-License-Identifier: Apache-2.0
#include "viewBounds.h"

#include "cell/cellMeasures.h"

#include "far_ext/vtr/parallel.h"

#include <algorithm>

namespace OpenSubdivHex::BfrExt {

ViewBounds::ViewBounds(SurfaceFactory const &factory, Options options)
    : _factory(factory), _options(options),
      _measures(std::make_unique<internal::MeshMeasures>(factory.GetNumFaces())) {}

ViewBounds::~ViewBounds() = default;

std::size_t ViewBounds::GetMemory() const { return _measures->memory; }

void ViewBounds::Clear() {
    _points.clear();
    for (internal::FaceMeasures &face : _measures->faces) {
        face = {};
    }
    _measures->memory = 0;
}

// Forgets what depends on positions that are not those of the last call.
template <typename REAL>
void ViewBounds::setPoints(REAL const *meshPoints, std::ptrdiff_t stride) {
    auto const numVertices = std::size_t(_factory.GetLevel().GetNumVertices());
    std::vector<char> isChanged;
    if (_points.empty()) {
        _points.resize(3 * numVertices);
    } else {
        isChanged.resize(numVertices);
    }
    auto const forEachVertex = [&](auto const &function) {
        FarExt::internal::ParallelFor(Index(numVertices), [&](Index vertex) {
            function(std::size_t(vertex), meshPoints + vertex * stride,
                     &_points[3 * std::size_t(vertex)]);
        });
    };
    if (!isChanged.empty()) {
        forEachVertex([&](std::size_t vertex, REAL const *point, double const *last) {
            isChanged[vertex] =
                !std::equal(last, last + 3, point, [](double a, REAL b) { return a == double(b); });
        });
        forget(isChanged);
    }
    forEachVertex(
        [](std::size_t, REAL const *point, double *last) { std::copy_n(point, 3, last); });
}

template void ViewBounds::setPoints(float const *, std::ptrdiff_t);
template void ViewBounds::setPoints(double const *, std::ptrdiff_t);

// Forgets the faces that have a control point which has changed.
void ViewBounds::forget(std::vector<char> const &isChanged) {
    if (std::find(isChanged.begin(), isChanged.end(), char(true)) == isChanged.end()) {
        return;
    }
    struct State {
        Surface<double> surface;
        std::vector<Index> points;
    };
    constexpr Index kFacesOfRange = 64;
    FarExt::internal::ParallelForRange(
        _factory.GetNumFaces(), [] { return State(); },
        [&](State &state, Index begin, Index end) {
            for (Index face = begin; face < end; ++face) {
                internal::FaceMeasures &measures = _measures->faces[std::size_t(face)];
                if (measures.cells.empty()) {
                    continue;
                }
                bool const hasSurface = _factory.InitVertexSurface(face, &state.surface);
                state.points.resize(std::size_t(state.surface.GetNumControlPoints()));
                state.surface.GetControlPointIndices(state.points.data());
                if (!hasSurface ||
                    std::any_of(state.points.begin(), state.points.end(),
                                [&](Index point) { return isChanged[std::size_t(point)]; })) {
                    _measures->memory -= measures.GetMemory();
                    measures = {};
                }
            }
        },
        kFacesOfRange);
}

// Counts what a face has come to have, and forgets it if that is too much.
void ViewBounds::trim(Index face, std::size_t memoryBefore) {
    internal::FaceMeasures &measures = _measures->faces[std::size_t(face)];
    std::size_t const memory = measures.GetMemory();
    if (memory != memoryBefore &&
        (_measures->memory += memory - memoryBefore) > _options.GetMaxMemory()) {
        _measures->memory -= memory;
        measures = {};
    }
}

} // namespace OpenSubdivHex::BfrExt

// SPDX-License-Identifier: Apache-2.0
#include "viewBounds.h"

#include "stream/boundsData.h"

#include "far_ext/vtr/parallel.h"

#include <algorithm>

namespace OpenSubdivHex::BfrExt {

ViewBounds::ViewBounds(SurfaceFactory const &factory, Options options)
    : _data(std::make_unique<internal::BoundsData>(factory, options)) {}

ViewBounds::~ViewBounds() = default;

SurfaceFactory const &ViewBounds::GetFactory() const { return _data->factory; }

ViewBounds::Options const &ViewBounds::GetOptions() const { return _data->options; }

std::size_t ViewBounds::GetMemory() const { return _data->memory; }

void ViewBounds::Clear() { _data->Clear(); }

namespace internal {

void BoundsData::Clear() {
    points.clear();
    for (FaceMeasures &face : faces) {
        face = {};
    }
    memory = 0;
}

template <typename REAL>
void BoundsData::SetPoints(REAL const *meshPoints, std::ptrdiff_t stride) {
    auto const numVertices = std::size_t(factory.GetLevel().GetNumVertices());
    std::vector<char> isChanged;
    if (points.empty()) {
        points.resize(3 * numVertices);
    } else {
        isChanged.resize(numVertices);
    }
    auto const forEachVertex = [&](auto const &function) {
        FarExt::internal::ParallelFor(Index(numVertices), [&](Index vertex) {
            function(std::size_t(vertex), meshPoints + vertex * stride,
                     &points[3 * std::size_t(vertex)]);
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

template void BoundsData::SetPoints(float const *, std::ptrdiff_t);
template void BoundsData::SetPoints(double const *, std::ptrdiff_t);

// Forgets the faces that have a control point which has changed.
void BoundsData::forget(std::vector<char> const &isChanged) {
    if (std::find(isChanged.begin(), isChanged.end(), char(true)) == isChanged.end()) {
        return;
    }
    struct State {
        Surface<double> surface;
        std::vector<Index> points;
    };
    constexpr Index kFacesOfRange = 64;
    FarExt::internal::ParallelForRange(
        factory.GetNumFaces(), [] { return State(); },
        [&](State &state, Index begin, Index end) {
            for (Index face = begin; face < end; ++face) {
                FaceMeasures &measures = faces[std::size_t(face)];
                if (measures.cells.empty()) {
                    continue;
                }
                bool const hasSurface = factory.InitVertexSurface(face, &state.surface);
                state.points.resize(std::size_t(state.surface.GetNumControlPoints()));
                state.surface.GetControlPointIndices(state.points.data());
                if (!hasSurface ||
                    std::any_of(state.points.begin(), state.points.end(),
                                [&](Index point) { return isChanged[std::size_t(point)]; })) {
                    memory -= measures.GetMemory();
                    measures = {};
                }
            }
        },
        kFacesOfRange);
}

void BoundsData::Trim(Index face, std::size_t memoryBefore) {
    FaceMeasures &measures = faces[std::size_t(face)];
    std::size_t const memoryNow = measures.GetMemory();
    if (memoryNow != memoryBefore &&
        (memory += memoryNow - memoryBefore) > options.GetMaxMemory()) {
        memory -= memoryNow;
        measures = {};
    }
}

} // namespace internal

} // namespace OpenSubdivHex::BfrExt

// SPDX-License-Identifier: Apache-2.0
#include "surfacePlaces.h"

#include "far_ext/stencil/interpolationMode.h"
#include "far_ext/vtr/parallel.h"
#include "far_ext/vtr/report.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

namespace OpenSubdivHex::BfrExt {

using FarExt::CallStatus;

template <typename REAL>
std::unique_ptr<SurfacePlaces<REAL>>
SurfacePlaces<REAL>::Create(SurfaceFactory const &factory, int numPlaces, Index const faces[],
                            REAL const uvs[], Options options, CallStatus *status) {
    CallStatus const result =
        numPlaces >= 0
            ? FarExt::internal::CheckStencilMode(factory.GetMesh(), options.interpolationMode,
                                                 options.fvarChannel)
            : CallStatus(FarExt::StatusCode::InvalidArgument, FarExt::ComponentType::NoComponent, 0,
                         "the number of places is " + std::to_string(numPlaces));
    if (!FarExt::internal::Report(result, status)) {
        return nullptr;
    }
    std::vector<Index> order(static_cast<std::size_t>(numPlaces));
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](Index a, Index b) { return faces[a] < faces[b]; });
    std::unique_ptr<SurfacePlaces> places(new SurfacePlaces());
    places->_numbers.reserve(order.size());
    places->_uvs.reserve(2 * order.size());
    FarExt::Interpolation const interpolation = FarExt::internal::GetModeInterpolation(
        factory.GetMesh(), options.interpolationMode, options.fvarChannel);
    int const channel =
        options.interpolationMode == FarExt::INTERPOLATE_FACE_VARYING ? options.fvarChannel : -1;
    Index lastFace = Far::INDEX_INVALID;
    for (Index const number : order) {
        Index const face = faces[number];
        if (places->_surfaces.empty() || face != lastFace) {
            lastFace = face;
            places->_firstPlaces.push_back(Index(places->_numbers.size()));
            places->_surfaces.emplace_back();
            CallStatus const found =
                factory.TryInit(face, interpolation, channel, places->_surfaces.back());
            if (!FarExt::internal::Report(found, status)) {
                return nullptr;
            }
        }
        REAL const *const uv = uvs + 2 * std::ptrdiff_t(number);
        if (!std::isfinite(uv[0]) || !std::isfinite(uv[1])) {
            FarExt::internal::Report({FarExt::StatusCode::InvalidArgument,
                                      FarExt::ComponentType::Face, face,
                                      "u and v of place " + std::to_string(number) +
                                          " are not finite, in face " + std::to_string(face)},
                                     status);
            return nullptr;
        }
        places->_numbers.push_back(number);
        places->_uvs.insert(places->_uvs.end(), uv, uv + 2);
    }
    places->_firstPlaces.push_back(Index(places->_numbers.size()));
    return places;
}

template <typename REAL>
void SurfacePlaces<REAL>::Evaluate(REAL const meshPoints[], PointDescriptor const &meshPointDesc,
                                   REAL p[], REAL du[], REAL dv[],
                                   PointDescriptor const &resultDesc) const {
    constexpr Index kRange = 4; // faces whose patch points take some microseconds each
    PointDescriptor const desc(meshPointDesc.size);
    FarExt::internal::ParallelForRange(
        Index(_surfaces.size()), [] { return std::vector<REAL>(); },
        [&](std::vector<REAL> &points, Index begin, Index end) {
            for (auto face = std::size_t(begin); face < std::size_t(end); ++face) {
                Surface<REAL> const &surface = _surfaces[face];
                points.resize(std::size_t(surface.GetNumPatchPoints()) * std::size_t(desc.size));
                surface.PreparePatchPoints(meshPoints, meshPointDesc, points.data(), desc);
                for (auto i = std::size_t(_firstPlaces[face]);
                     i < std::size_t(_firstPlaces[face + 1]); ++i) {
                    REAL const *const uv = &_uvs[2 * i];
                    std::ptrdiff_t const result = std::ptrdiff_t(_numbers[i]) * resultDesc.stride;
                    if (du) {
                        surface.Evaluate(uv, points.data(), desc, p + result, du + result,
                                         dv + result);
                    } else {
                        surface.Evaluate(uv, points.data(), desc, p + result);
                    }
                }
            }
        },
        kRange);
}

template class SurfacePlaces<float>;
template class SurfacePlaces<double>;

} // namespace OpenSubdivHex::BfrExt

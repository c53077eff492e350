// SPDX-License-Identifier: Apache-2.0
#include "surfaceSamples.h"

#include "pointRows.h"

#include <algorithm>
#include <cmath>

namespace OpenSubdivHex::BfrExt::internal {

namespace {

bool isSame(std::vector<double> const &a, std::vector<double> const &b) {
    constexpr double kTolerance = 1e-9;
    return std::equal(a.begin(), a.end(), b.begin(),
                      [](double x, double y) { return std::abs(x - y) < kTolerance; });
}

} // namespace

SurfaceSamples::SurfaceSamples(CellType const &type) {
    constexpr int kNumSteps = 2;
    std::vector<std::vector<double>> stencils;
    ForDescendants(
        type, PointRows(type), kNumSteps, [&](CellType const &descendant, PointRows const &rows) {
            for (std::vector<double> const &corner : descendant.GetCornerPoints()) {
                std::vector<double> stencil = rows.Sum(corner);
                auto const isKnown = [&](auto const &known) { return isSame(known, stencil); };
                if (std::none_of(stencils.begin(), stencils.end(), isKnown)) {
                    stencils.push_back(std::move(stencil));
                }
            }
        });
    _matrix = PlaceMatrix<double>(stencils.size(), std::size_t(type.GetNumPoints()));
    for (std::size_t i = 0; i < stencils.size(); ++i) {
        _matrix.Set(i, stencils[i]);
    }
}

SurfaceSamples const &SurfaceSamples::Find(CellType const &type) {
    return type.GetPatterns().Get<SurfaceSamples>(
        PatternTable::GetKind<double>(PatternOf::SurfaceSamples), nullptr, nullptr,
        [&] { return SurfaceSamples(type); });
}

void SurfaceSamples::Evaluate(double const *points, std::ptrdiff_t stride, std::size_t size,
                              std::vector<double> &samples) const {
    samples.resize(_matrix.GetNumPlaces() * size);
    SumUpPlaces(_matrix, {points, stride, size, nullptr, samples.data(), std::ptrdiff_t(size)});
}

} // namespace OpenSubdivHex::BfrExt::internal

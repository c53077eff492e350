// SPDX-License-Identifier: Apache-2.0
#include "regularVertices.h"

#include "rowSteps.h"

#include "far_ext/vtr/parallel.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace OpenSubdivHex::FarExt::internal {

using Far::Index;

namespace {

constexpr int kNumSources = PlainNeighborhoodGatherer::kNumRegular;

// The mask in a level before that makes the row of a vertex, if all its sources are those of a
// regular vertex there.
std::optional<LimitMask> findMask(MeshLevels const &mesh, HexSchemeOptions const &schemeOptions,
                                  LimitRows const &rows, int level, Index vert) {
    Index sources[kNumSources];
    SteppedRow row = StepRowBack(mesh, schemeOptions, rows.GetRow(vert, 0, sources),
                                 rows.GetLevel().depth, level);
    PlainNeighborhoodGatherer::GatherRegular(mesh.levels[std::size_t(level)], vert, sources);
    LimitMask mask;
    LimitMask::Tangents &tangents = mask.sides.emplace_back();
    for (Index const source : sources) {
        LimitWeights const weights = row[source];
        mask.weights.push_back(weights[0]);
        tangents.du.push_back(weights[1]);
        tangents.dv.push_back(weights[2]);
        row.erase(source);
    }
    // Others may be left over from rounding.
    bool const isNothingLeft =
        std::all_of(row.begin(), row.end(), [](SteppedRow::value_type const &left) {
            return std::all_of(left.second.begin(), left.second.end(),
                               [](double weight) { return std::abs(weight) < kWeightTolerance; });
        });
    return isNothingLeft ? std::optional(mask) : std::nullopt;
}

} // namespace

RegularVertices::RegularVertices(MeshLevels const &mesh, HexSchemeOptions const &schemeOptions,
                                 LimitRows const &rows, std::vector<Index> const &verts)
    : _mesh(mesh), _levels(std::size_t(rows.GetLevel().depth)), _others(verts) {
    int const last = rows.GetLevel().depth;
    // Vertices keep their index in hexagonal steps.
    int first = last;
    while (first > 0 && mesh.levels[std::size_t(first)].isHexagonal) {
        --first;
    }
    for (int depth = first; depth < last; ++depth) {
        Level const &level = mesh.levels[std::size_t(depth)];
        std::vector<VertexMark> const marks = MarkFeatures(level);
        PlainNeighborhoodGatherer const gatherer(level);
        auto const end = std::lower_bound(_others.begin(), _others.end(), level.numVertices);
        std::vector<Index> const regular =
            ParallelSelect(Index(end - _others.begin()), [&](Index i) {
                return gatherer.IsRegular(_others[std::size_t(i)], marks);
            });
        if (regular.empty()) {
            continue;
        }
        // In each step the faces around a vertex turn alike: its E-faces are in the order of its edges.
        std::optional<LimitMask> mask =
            findMask(mesh, schemeOptions, rows, depth, _others[std::size_t(regular.front())]);
        if (!mask) {
            continue;
        }
        OfLevel &ofLevel = _levels[std::size_t(depth)];
        ofLevel.mask = std::move(*mask);
        for (Index const i : regular) {
            ofLevel.verts.push_back(_others[std::size_t(i)]);
        }
        std::vector<Index> others;
        std::set_difference(_others.begin(), _others.end(), ofLevel.verts.begin(),
                            ofLevel.verts.end(), std::back_inserter(others));
        _others.swap(others);
    }
}

LimitRow RegularVertices::GetRow(int level, Index vert, Index sources[kNumSources]) const {
    PlainNeighborhoodGatherer::GatherRegular(_mesh.levels[std::size_t(level)], vert, sources);
    LimitMask const &mask = _levels[std::size_t(level)].mask;
    LimitMask::Tangents const &tangents = mask.sides[0];
    return {kNumSources, sources, mask.weights.data(), tangents.du.data(), tangents.dv.data()};
}

} // namespace OpenSubdivHex::FarExt::internal

// SPDX-License-Identifier: Apache-2.0
#include "limitStencils.h"

#include "far_ext/limit/limitMultiplier.h"
#include "far_ext/vtr/parallel.h"

#include <atomic>
#include <optional>

namespace OpenSubdivHex::FarExt::internal {

using Far::Index;

void LimitStencils::KeptRow::Clear() {
    sources.clear();
    for (std::vector<double> &ofSum : weights) {
        ofSum.clear();
    }
}

void LimitStencils::KeptRow::Add(Index source, double weight, double du, double dv) {
    std::size_t i = 0;
    while (i < sources.size() && sources[i] != source) {
        ++i;
    }
    if (i == sources.size()) {
        sources.push_back(source);
        for (std::vector<double> &ofSum : weights) {
            ofSum.push_back(0);
        }
    }
    weights[0][i] += weight;
    weights[1][i] += du;
    weights[2][i] += dv;
}

void LimitStencils::KeptRow::Append(LimitRow const &row) {
    sources.insert(sources.end(), row.sources, row.sources + row.size);
    weights[0].insert(weights[0].end(), row.weights, row.weights + row.size);
    weights[1].insert(weights[1].end(), row.du, row.du + row.size);
    weights[2].insert(weights[2].end(), row.dv, row.dv + row.size);
}

LimitRow LimitStencils::KeptRow::Get(int begin, int end) const {
    return {end - begin, sources.data() + begin, weights[0].data() + begin,
            weights[1].data() + begin, weights[2].data() + begin};
}

CallStatus LimitStencils::Form(Hierarchy const &hierarchy, int channel,
                               HexSchemeOptions const &schemeOptions, int level, Index numRows,
                               std::function<LimitRow(Index, KeptRow &)> const &getRow) {
    Index const numVerts = hierarchy.GetMesh(channel).levels[std::size_t(level)].numVertices;
    // The rows of each range, and the sources of all.
    struct RangeRows {
        KeptRow all;
        std::vector<int> firsts;
    };
    std::vector<RangeRows> rows(std::size_t(GetNumParallelRanges(numRows, kRange)));
    std::vector<std::atomic<unsigned char>> marks(
        static_cast<std::size_t>(numVerts)); // by several threads
    ParallelForRange(
        numRows, [] { return KeptRow(); },
        [&](KeptRow &kept, Index begin, Index end) {
            RangeRows &range = rows[std::size_t(begin / kRange)];
            range.firsts.push_back(0);
            for (Index number = begin; number < end; ++number) {
                LimitRow const row = getRow(number, kept);
                range.all.Append(row);
                range.firsts.push_back(int(range.all.sources.size()));
                row.ForEachPart([&](int i) {
                    marks[std::size_t(row.sources[i])].store(1, std::memory_order_relaxed);
                });
            }
        },
        kRange);
    std::optional<LevelStencils> stencils;
    if (level > 0) {
        std::vector<std::vector<Index>> wanted(std::size_t(level) + 1);
        wanted.back() = ParallelSelect(numVerts, [&](Index vert) {
            return marks[std::size_t(vert)].load(std::memory_order_relaxed) != 0;
        });
        stencils.emplace(hierarchy, schemeOptions, std::move(wanted), channel);
        if (CallStatus result = stencils->Form(); !result.IsOk()) {
            return result;
        }
    } else if (channel >= 0) {
        Buffer<Index> const &values = hierarchy.channels[std::size_t(channel)].valuesOfVertices;
        for (RangeRows &range : rows) {
            for (Index &source : range.all.sources) {
                source = values[source];
            }
        }
    }
    constexpr Index kGroup = 16; // rows that are near one another, and share sources
    static_assert(kGroup <= kMaxLimitRows && kRange % kGroup == 0);
    Index const firstSource = stencils ? stencils->GetFirst(level) : 0;
    Index const numControlPoints = hierarchy.GetNumControlPoints(channel);
    _ranges.assign(std::size_t(GetNumParallelRanges(numRows, kRange)), Range());
    ParallelForRange(
        numRows,
        [&] {
            return LimitMultiplier<double>(stencils ? &*stencils : nullptr, numControlPoints, true);
        },
        [&](LimitMultiplier<double> &multiplier, Index begin, Index end) {
            RangeRows const &ofRange = rows[std::size_t(begin / kRange)];
            Range &range = _ranges[std::size_t(begin / kRange)];
            range.firsts = {0};
            for (Index group = begin; group < end; group += kGroup) {
                multiplier.Clear();
                for (Index row = group; row < std::min(end, group + kGroup); ++row) {
                    auto const i = std::size_t(row - begin);
                    multiplier.AddRow(ofRange.all.Get(ofRange.firsts[i], ofRange.firsts[i + 1]),
                                      firstSource);
                }
                auto const columns = multiplier.FindColumns();
                std::size_t firsts[kGroup];
                int const numInGroup = multiplier.GetNumRows();
                for (int row = 0; row < numInGroup; ++row) {
                    auto const size =
                        int(std::count_if(columns.rows, columns.rows + columns.size,
                                          [row](auto bits) { return (bits >> row & 1) != 0; }));
                    firsts[row] = std::size_t(range.firsts.back());
                    range.firsts.push_back(range.firsts.back() + size);
                }
                auto const size = std::size_t(range.firsts.back());
                range.indices.resize(size);
                for (std::vector<double> &weights : range.weights) {
                    weights.resize(size);
                }
                LimitStencilPlace<double> places[kGroup];
                for (int row = 0; row < numInGroup; ++row) {
                    std::size_t const first = firsts[row];
                    places[row] = {range.indices.data() + first, range.weights[0].data() + first,
                                   range.weights[1].data() + first,
                                   range.weights[2].data() + first};
                }
                multiplier.Fill(columns, places);
            }
        },
        kRange);
    return CallStatus();
}

auto LimitStencils::Get(Index row) const -> Stencil {
    Range const &range = _ranges[std::size_t(row / kRange)];
    auto const i = std::size_t(row % kRange);
    auto const first = std::size_t(range.firsts[i]);
    return {range.firsts[i + 1] - range.firsts[i],
            range.indices.data() + first,
            {range.weights[0].data() + first, range.weights[1].data() + first,
             range.weights[2].data() + first}};
}

} // namespace OpenSubdivHex::FarExt::internal

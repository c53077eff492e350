// SPDX-License-Identifier: Apache-2.0
#include "preparedLimit.h"

#include "far_ext/vtr/parallel.h"

#include <algorithm>
#include <limits>
#include <string>
#include <unordered_map>

namespace OpenSubdivHex::OsdExt::internal {

using Far::Index;
using FarExt::ComponentType;
using FarExt::Status;
using FarExt::StatusCode;
using FarExt::internal::LimitRow;
using FarExt::internal::LimitRows;
using FarExt::internal::PlainNeighborhoodGatherer;

namespace {

// Vertices, of some ten nanoseconds each.
constexpr Index kRange = 1024;

// A row and room for its sources.
struct Reader {
    LimitRow Read(LimitRows const &rows, Index vert) { return rows.GetRow(vert, 0, sources); }

    Index sources[PlainNeighborhoodGatherer::kNumRegular];
};

} // namespace

void PreparedLimit::addWeights(LimitRow const &row) {
    _weights.insert(_weights.end(), row.weights, row.weights + row.size);
    _duWeights.insert(_duWeights.end(), row.du, row.du + row.size);
    _dvWeights.insert(_dvWeights.end(), row.dv, row.dv + row.size);
}

Status PreparedLimit::Prepare(LimitRows const &rows) {
    FarExt::internal::Level const &level = rows.GetLevel();
    _blocks.Resize(std::size_t(level.numVertices));
    std::unordered_map<double const *, int> firstWeights; // of the types, by their weights
    std::int64_t numIndices = 0;
    Reader reader;
    for (Index vert = 0; vert < level.numVertices; ++vert) {
        LimitRow const row = reader.Read(rows, vert);
        // The sides of a vertex share the weights of its point.
        auto const [found, isNew] = firstWeights.try_emplace(row.du, int(_weights.size()));
        if (isNew) {
            addWeights(row);
        }
        _blocks[std::size_t(vert)] = {vert, 1, row.size, int(numIndices), found->second};
        numIndices += row.size;
        if (std::max(numIndices, std::int64_t(_weights.size())) > std::numeric_limits<int>::max()) {
            return Status(StatusCode::TooLarge, ComponentType::Level, level.depth,
                          "the limit of level " + std::to_string(level.depth) +
                              " has more sources than 32-bit offsets reach");
        }
    }
    _indices.Resize(std::size_t(numIndices));
    FarExt::internal::ParallelForRange(
        level.numVertices, [] { return Reader(); },
        [&](Reader &rangeReader, Index begin, Index end) {
            for (Index vert = begin; vert < end; ++vert) {
                LimitRow const row = rangeReader.Read(rows, vert);
                std::copy_n(row.sources, row.size,
                            _indices.data() + _blocks[std::size_t(vert)].firstIndex);
            }
        },
        kRange);
    return Status();
}

void PreparedLimit::Evaluate(Elements<float const> values, int length, Elements<float> points,
                             Elements<float> du, Elements<float> dv) const {
    StencilTask task;
    task.src = values.data;
    task.srcStride = values.stride;
    task.length = length;
    task.rows.blocks = _blocks.data();
    task.rows.indices = _indices.data();
    task.outputs[0] = {points.data, points.stride, _weights.data()};
    task.outputs[1] = {du.data, du.stride, _duWeights.data()};
    task.outputs[2] = {dv.data, dv.stride, _dvWeights.data()};
    task.numOutputs = du.data ? 3 : 1;
    StencilKernel const kernel = GetStencilKernel();
    struct Nothing {};
    FarExt::internal::ParallelForRange(
        Index(_blocks.size()), [] { return Nothing(); },
        [&](Nothing, Index begin, Index end) { kernel(task, begin, end, 0); }, kRange);
}

} // namespace OpenSubdivHex::OsdExt::internal

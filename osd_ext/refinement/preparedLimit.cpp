// SPDX-License-Identifier: Apache-2.0
#include "preparedLimit.h"

#include "far_ext/vtr/parallel.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>

namespace OpenSubdivHex::OsdExt::internal {

using Far::Index;
using FarExt::CallStatus;
using FarExt::internal::LimitOrigins;
using FarExt::internal::LimitRow;
using FarExt::internal::LimitRows;
using FarExt::internal::RegularFaces;

namespace {

// Groups of vertices, of some ten nanoseconds each.
constexpr Index kRange = 256;

// Vertices among which groups of a type are looked for: few enough for what they depend on to stay in
// the cache, and enough for groups to be full.
constexpr std::size_t kWindow = 8192;

// Sets the places of a group's sources.
void setPlaces(VertexGroup const &group, int member, LimitRow const &row, std::uint32_t *places) {
    std::uint32_t *place = places + group.firstPlace + member;
    row.ForEachPart([&](int i) {
        *place = std::uint32_t(row.sources[i]) * RegularFaceGroup::kPointStride;
        place += VertexGroup::kSize;
    });
}

} // namespace

CallStatus CheckLimitPlaces(int level, std::int64_t numVertices) {
    constexpr std::int64_t kMaxVertices =
        std::numeric_limits<std::uint32_t>::max() / RegularFaceGroup::kPointStride;
    if (numVertices <= kMaxVertices) {
        return CallStatus();
    }
    return CallStatus(FarExt::StatusCode::TooLarge, FarExt::ComponentType::Level, level,
                      "level " + std::to_string(level) + " has " + std::to_string(numVertices) +
                          " vertices, more than the " + std::to_string(kMaxVertices) +
                          " of a level from which limits can be evaluated");
}

CallStatus PreparedLimit::Prepare(FarExt::internal::MeshLevels const &mesh,
                                  FarExt::HexSchemeOptions const &schemeOptions, LimitRows &rows) {
    for (int i = 0; i <= rows.GetLevel().depth; ++i) {
        CallStatus status = CheckLimitPlaces(i, mesh.levels[std::size_t(i)].numVertices);
        if (!status.IsOk()) {
            return status;
        }
    }
    LimitOrigins origins(mesh, rows);
    CallStatus result = origins.Find(schemeOptions);
    if (!result.IsOk()) {
        return result;
    }
    _lattice.Prepare(origins.GetLatticeFaces());
    int const last = rows.GetLevel().depth;
    for (int i = 0; i <= last; ++i) {
        LevelLimit &ofLevel = _levels.emplace_back();
        ofLevel.level = &mesh.levels[std::size_t(i)];
        prepareFaces(origins.GetFaces()[std::size_t(i)], ofLevel);
        prepareVertices(origins, ofLevel);
    }
    return result;
}

void PreparedLimit::prepareFaces(RegularFaces::OfLevel const &faces, LevelLimit &result) {
    for (RegularFaces::Set const *set : {&faces.fVertices, &faces.ownVertices}) {
        if (!set->faces.empty()) {
            result.sets.push_back({MakeRegularFaceGroups(*result.level, set->faces),
                                   set->firstVertex, MakeRegularLimitWeights(set->mask)});
        }
    }
}

void PreparedLimit::prepareVertices(LimitOrigins const &origins, LevelLimit &result) {
    int const level = result.level->depth;
    std::vector<Index> verts = origins.GetVertices(level);
    if (level == 0) {
        verts.erase(std::remove_if(verts.begin(), verts.end(),
                                   [&](Index vert) { return _lattice.IsMade(vert); }),
                    verts.end());
    }
    struct Other {
        Index vert;
        int numSources;
        std::size_t firstWeight;
    };
    std::vector<Other> others;
    others.reserve(verts.size());
    Index sources[LimitOrigins::kMaxSources];
    for (Index const vert : verts) {
        LimitRow const row = origins.GetRow(level, vert, sources);
        int numSources = 0;
        row.ForEachPart([&](int) { ++numSources; });
        others.push_back({vert, numSources, _weights.Add(row)});
    }
    std::size_t numPlaces = 0;
    for (std::size_t begin = 0; begin < others.size(); begin += kWindow) {
        auto const first = others.begin() + std::ptrdiff_t(begin);
        auto const end = others.begin() + std::ptrdiff_t(std::min(begin + kWindow, others.size()));
        std::stable_sort(first, end, [](Other const &a, Other const &b) {
            return a.firstWeight < b.firstWeight;
        });
        for (auto other = first; other != end;) {
            auto const last = std::find_if_not(
                other, std::min(other + VertexGroup::kSize, end),
                [&](Other const &next) { return next.firstWeight == other->firstWeight; });
            VertexGroup group = {{}, other->numSources, numPlaces, other->firstWeight};
            for (int i = 0; i < VertexGroup::kSize; ++i) {
                group.verts[i] = (other + i < last ? other + i : last - 1)->vert;
            }
            result.vertexGroups.push_back(group);
            numPlaces += std::size_t(group.numSources) * VertexGroup::kSize;
            other = last;
        }
    }
    result.places.Resize(numPlaces);
    FarExt::internal::ParallelForRange(
        Index(result.vertexGroups.size()), [] { return FarExt::internal::Nothing(); },
        [&](FarExt::internal::Nothing, Index begin, Index end) {
            Index ofVertex[LimitOrigins::kMaxSources];
            for (Index i = begin; i < end; ++i) {
                VertexGroup const &group = result.vertexGroups[std::size_t(i)];
                for (int k = 0; k < VertexGroup::kSize; ++k) {
                    setPlaces(group, k, origins.GetRow(level, group.verts[k], ofVertex),
                              result.places.data());
                }
            }
        },
        kRange);
}

int PreparedLimit::GetLastLevel() const {
    int level = int(_levels.size()) - 1;
    while (level > 0 && !IsNeeded(level)) {
        --level;
    }
    return level;
}

LimitTask PreparedLimit::makeTask(Elements<float const> values, bool isReadBehind, int length,
                                  Outputs const &outputs) {
    LimitTask task;
    task.length = length;
    task.values = values;
    task.isReadBehind = isReadBehind;
    task.numOutputs = int(outputs.size());
    std::copy(outputs.begin(), outputs.end(), task.outputs);
    return task;
}

void PreparedLimit::EvaluateLattice(Elements<float const> values, int length,
                                    Outputs const &outputs) const {
    _lattice.Evaluate(makeTask(values, true, length, outputs));
}

void PreparedLimit::Evaluate(int level, Elements<float const> values, bool isReadBehind, int length,
                             Outputs const &outputs) const {
    LevelLimit const &ofLevel = _levels[std::size_t(level)];
    LimitTask const common = makeTask(values, isReadBehind, length, outputs);
    evaluateFaces(ofLevel, common);
    // Behind the faces, which write something for all their vertices.
    VertexLimitTask task;
    static_cast<LimitTask &>(task) = common;
    task.groups = ofLevel.vertexGroups.data();
    task.places = ofLevel.places.data();
    task.weights = _weights.Get().data();
    EvaluateLimit(task, Index(ofLevel.vertexGroups.size()));
}

void PreparedLimit::evaluateFaces(LevelLimit const &ofLevel, LimitTask const &common) const {
    for (FaceSet const &set : ofLevel.sets) {
        RegularLimitTask task;
        static_cast<LimitTask &>(task) = common;
        for (int i = 0; i < task.numOutputs; ++i) {
            task.outputs[i].data += std::ptrdiff_t(set.firstVertex) * task.outputs[i].stride;
        }
        task.groups = set.groups.data();
        task.weights = &set.weights;
        EvaluateLimit(task, Index(set.groups.size()));
    }
}

} // namespace OpenSubdivHex::OsdExt::internal

// SPDX-License-Identifier: Apache-2.0
#include "preparedLimit.h"

#include "far_ext/vtr/parallel.h"

#include <algorithm>
#include <unordered_map>

namespace OpenSubdivHex::OsdExt::internal {

using Far::Index;
using FarExt::Status;
using FarExt::internal::LimitRow;
using FarExt::internal::LimitRows;
using FarExt::internal::PlainNeighborhoodGatherer;
using FarExt::internal::RegularFaces;

namespace {

// Groups of vertices, of some ten nanoseconds each.
constexpr Index kRange = 256;

// Vertices among which groups of a type are looked for: few enough for what they depend on to stay in
// the cache, and enough for groups to be full.
constexpr std::size_t kWindow = 8192;

// A row and room for its sources.
struct Reader {
    LimitRow Read(LimitRows const &rows, Index vert) { return rows.GetRow(vert, 0, sources); }

    Index sources[PlainNeighborhoodGatherer::kNumRegular];
};

// Sets the places of a group's sources.
void setPlaces(VertexGroup const &group, LimitRows const &rows, Reader &reader,
               std::uint32_t *places) {
    for (int k = 0; k < VertexGroup::kSize; ++k) {
        LimitRow const row = reader.Read(rows, group.verts[k]);
        std::uint32_t *place = places + group.firstPlace + k;
        for (int i = 0; i < row.size; ++i, place += VertexGroup::kSize) {
            *place = std::uint32_t(row.sources[i]) * RegularFaceGroup::kPointStride;
        }
    }
}

// What all tasks have.
void setTask(Elements<float const> values, bool isReadBehind, int length,
             PreparedLimit::Outputs const &outputs, LimitTask &task) {
    task.length = length;
    task.values = values;
    task.isReadBehind = isReadBehind;
    task.numOutputs = int(outputs.size());
    std::copy(outputs.begin(), outputs.end(), task.outputs);
}

} // namespace

Status PreparedLimit::Prepare(FarExt::internal::MeshLevels const &mesh,
                              FarExt::HexSchemeOptions const &schemeOptions, LimitRows &rows) {
    RegularFaces regularFaces(mesh, rows.GetLevel().depth);
    Status result = regularFaces.FindMasks(schemeOptions, rows);
    if (!result.IsOk()) {
        return result;
    }
    prepareOthers(regularFaces.GetOthers(), rows);
    std::vector<RegularFaces::OfLevel> const &levels = regularFaces.GetLevels();
    for (std::size_t i = 0; i < levels.size(); ++i) {
        prepareFaces(mesh.levels[i], levels[i]);
    }
    return result;
}

void PreparedLimit::prepareFaces(FarExt::internal::Level const &level,
                                 RegularFaces::OfLevel const &faces) {
    FaceLevel &result = _faceLevels.emplace_back(FaceLevel{&level, {}, {}});
    std::vector<unsigned char> isBeyond(std::size_t(level.numFaces), 0);
    RegularFaces::Set const *const sets[] = {&faces.fVertices, &faces.ownVertices};
    for (RegularFaces::Set const *set : sets) {
        for (FarExt::internal::RegularFace const &face : set->faces) {
            for (Index const beyond : face.beyond) {
                isBeyond[std::size_t(beyond)] = 1;
            }
        }
    }
    result.summedFaces = FarExt::internal::ParallelSelect(
        level.numFaces, [&](Index face) { return isBeyond[std::size_t(face)] != 0; });
    FarExt::internal::Buffer<Index> sumsOfFaces;
    sumsOfFaces.Resize(isBeyond.size());
    FarExt::internal::ParallelFor(Index(result.summedFaces.size()), [&](Index i) {
        Index &face = result.summedFaces[std::size_t(i)];
        sumsOfFaces[std::size_t(face)] = i;
        face = level.faceFirstCorner[face];
    });
    for (RegularFaces::Set const *set : sets) {
        if (!set->faces.empty()) {
            result.sets.push_back({MakeRegularFaceGroups(level, set->faces, sumsOfFaces),
                                   set->firstVertex, MakeRegularLimitWeights(set->mask),
                                   set->mask.HasOneTip()});
        }
    }
}

void PreparedLimit::prepareOthers(std::vector<Index> const &verts, LimitRows const &rows) {
    struct Other {
        Index vert;
        int numSources;
        std::size_t firstWeight;
    };
    std::vector<Other> others;
    others.reserve(verts.size());
    std::unordered_map<double const *, std::size_t> firstWeights; // of the types, by their weights
    Reader reader;
    for (Index const vert : verts) {
        LimitRow const row = reader.Read(rows, vert);
        // The sides of a vertex share the weights of its point.
        auto const [found, isNew] = firstWeights.try_emplace(row.du, _weights.size());
        for (int i = 0; i < row.size && isNew; ++i) {
            _weights.insert(_weights.end(),
                            {float(row.weights[i]), float(row.du[i]), float(row.dv[i])});
        }
        others.push_back({vert, row.size, found->second});
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
            _vertexGroups.push_back(group);
            numPlaces += std::size_t(group.numSources) * VertexGroup::kSize;
            other = last;
        }
    }
    _places.Resize(numPlaces);
    FarExt::internal::ParallelForRange(
        Index(_vertexGroups.size()), [] { return Reader(); },
        [&](Reader &rangeReader, Index begin, Index end) {
            for (Index i = begin; i < end; ++i) {
                setPlaces(_vertexGroups[std::size_t(i)], rows, rangeReader, _places.data());
            }
        },
        kRange);
}

std::vector<unsigned char> PreparedLimit::FindSources(Index numVertices) const {
    FaceLevel const &faces = _faceLevels.back();
    if (faces.sets.empty() && !HasOthers()) {
        return {};
    }
    std::vector<unsigned char> isSource(std::size_t(numVertices), 0);
    auto const markPlace = [&](std::uint32_t place) {
        isSource[place / RegularFaceGroup::kPointStride] = 1;
    };
    for (FaceSet const &set : faces.sets) {
        for (RegularFaceGroup const &group : set.groups) {
            for (RegularFaceGroup::Places const *places :
                 {&group.verts, &group.neighbors, &group.next, &group.previous}) {
                for (auto const &ofCorner : *places) {
                    std::for_each(std::begin(ofCorner), std::end(ofCorner), markPlace);
                }
            }
        }
    }
    for (Index const firstCorner : faces.summedFaces) {
        Index const *const verts = faces.level->faceVerts.data() + firstCorner;
        for (int i = 0; i < FarExt::internal::kRegularFaceSize; ++i) {
            isSource[std::size_t(verts[i])] = 1;
        }
    }
    std::for_each(_places.data(), _places.data() + _places.size(), markPlace);
    return isSource;
}

void PreparedLimit::EvaluateFaces(int level, Elements<float const> values, int length,
                                  Outputs const &outputs) {
    if (!HasFaces(level)) {
        return;
    }
    FaceLevel const &faces = _faceLevels[std::size_t(level)];
    RegularLimitTask task;
    task.faceVerts = faces.level->faceVerts.data();
    task.sums.stride = RegularLimitTask::GetSumStride(length);
    _sums.Resize(faces.summedFaces.size() * std::size_t(task.sums.stride));
    task.sums.data = _sums.data();
    task.summedFaces = faces.summedFaces.data();
    setTask(values, true, length, outputs, task);
    SumFaces(task, Index(faces.summedFaces.size()));
    for (FaceSet const &set : faces.sets) {
        setTask(values, true, length, outputs, task);
        for (int i = 0; i < task.numOutputs; ++i) {
            task.outputs[i].data += std::ptrdiff_t(set.firstVertex) * task.outputs[i].stride;
        }
        task.groups = set.groups.data();
        task.weights = &set.weights;
        task.hasOneTip = set.hasOneTip;
        EvaluateLimit(task, Index(set.groups.size()));
    }
}

void PreparedLimit::EvaluateOthers(Elements<float const> values, bool isReadBehind, int length,
                                   Outputs const &outputs) const {
    VertexLimitTask task;
    setTask(values, isReadBehind, length, outputs, task);
    task.groups = _vertexGroups.data();
    task.places = _places.data();
    task.weights = _weights.data();
    EvaluateLimit(task, Index(_vertexGroups.size()));
}

} // namespace OpenSubdivHex::OsdExt::internal

// SPDX-License-Identifier: Apache-2.0
#include "plainFaces.h"

#include "faceDescendants.h"
#include "plainNeighborhood.h"

#include "far_ext/vtr/parallel.h"

#include <algorithm>
#include <string>
#include <unordered_map>

namespace OpenSubdivHex::FarExt::internal {

using Far::Index;

namespace {

constexpr Index kRange = 64; // of faces, which take some microseconds each

// Number of faces that take as long to make by the rows of a type as finding these rows.
constexpr int kMinFaces = 4;

// Two steps before the last level, but behind the first: there the types are few, and many vertices are
// made of each face.
int findLevel(MeshLevels const &mesh, int last) {
    int level = std::max(last - 2, std::min(last - 1, 1));
    for (int i = last; i > level; --i) {
        if (!mesh.levels[std::size_t(i)].isHexagonal) {
            level = i;
        }
    }
    return level;
}

std::vector<Index> selectUnmarked(std::vector<unsigned char> const &marks) {
    return ParallelSelect(Index(marks.size()),
                          [&](Index vert) { return marks[std::size_t(vert)] == 0; });
}

} // namespace

/// The faces of a range that are plain.
struct PlainFaces::Candidates {
    struct Face {
        Index face;
        std::string key;
        std::size_t firstSource;
        int numSources;
    };
    std::vector<Face> faces;
    std::vector<Index> sources;
};

PlainFaces::PlainFaces(MeshLevels const &mesh, int level, std::vector<unsigned char> isMade)
    : _mesh(mesh), _last(level), _level(findLevel(mesh, level)), _isMade(std::move(isMade)) {
    _isMade.resize(std::size_t(mesh.levels[std::size_t(level)].numVertices), 0);
    if (_level < _last && !selectUnmarked(_isMade).empty()) {
        findFaces();
        setOutputs();
    }
    claimOutputs();
}

void PlainFaces::findFaces() {
    Level const &level = _mesh.levels[std::size_t(_level)];
    std::vector<Candidates> ofRanges(std::size_t(GetNumParallelRanges(level.numFaces, kRange)));
    struct Scratch {
        PlainNeighborhoodGatherer gatherer;
        PlainNeighborhood neighborhood;
        std::vector<Index> outputs;
    };
    ParallelForRange(
        level.numFaces,
        [&] {
            return Scratch{PlainNeighborhoodGatherer(level), {}, {}};
        },
        [&](Scratch &scratch, Index begin, Index end) {
            Candidates &result = ofRanges[std::size_t(begin / kRange)];
            PlainNeighborhood &neighborhood = scratch.neighborhood;
            for (Index face = begin; face < end; ++face) {
                if (!scratch.gatherer.GatherFace(face, neighborhood) ||
                    !makesAny(face, scratch.outputs)) {
                    continue;
                }
                result.faces.push_back({face, neighborhood.key, result.sources.size(),
                                        int(neighborhood.sources.size())});
                result.sources.insert(result.sources.end(), neighborhood.sources.begin(),
                                      neighborhood.sources.end());
            }
        },
        kRange);
    keepSharedTypes(ofRanges);
}

bool PlainFaces::makesAny(Index face, std::vector<Index> &outputs) const {
    listOutputs(face, outputs);
    return std::any_of(outputs.begin(), outputs.end(),
                       [this](Index vert) { return _isMade[std::size_t(vert)] == 0; });
}

// Types are numbered by their first faces.
void PlainFaces::keepSharedTypes(std::vector<Candidates> const &ofRanges) {
    struct Shared {
        int numFaces = 0;
        int type = -1;
    };
    std::unordered_map<std::string, Shared> ofKeys;
    std::vector<Shared *> ofFaces;
    for (Candidates const &candidates : ofRanges) {
        for (Candidates::Face const &face : candidates.faces) {
            ofFaces.push_back(&ofKeys[face.key]);
            ++ofFaces.back()->numFaces;
        }
    }
    auto shared = ofFaces.begin();
    for (Candidates const &candidates : ofRanges) {
        for (Candidates::Face const &face : candidates.faces) {
            Shared &ofKey = **shared++;
            if (ofKey.numFaces < kMinFaces) {
                continue;
            }
            if (ofKey.type < 0) {
                ofKey.type = int(_types.size());
                _types.push_back({face.numSources, 0, {}, Index(_faces.size())});
            }
            _faces.push_back({ofKey.type, _sources.size(), 0});
            _indices.push_back(face.face);
            auto const first = candidates.sources.begin() + std::ptrdiff_t(face.firstSource);
            _sources.insert(_sources.end(), first, first + face.numSources);
        }
    }
}

// Lists those of its vertices of which the face is the first.
void PlainFaces::listOutputs(Index face, std::vector<Index> &outputs) const {
    Level const &level = _mesh.levels[std::size_t(_level)];
    outputs.clear();
    for (Index const vert : level.GetFaceVertices(face)) {
        if (level.vertFaces[level.vertFirstFace[vert]] == face) {
            outputs.push_back(vert);
        }
    }
    ForEachDescendant(_mesh, _level, _last, face, [&](Index vert) { outputs.push_back(vert); });
}

void PlainFaces::setOutputs() {
    // A vertex that occurs twice in one face of a type does so in all.
    std::vector<std::vector<std::size_t>> places(_types.size());
    _samples.resize(_types.size());
    std::vector<Index> listed;
    for (std::size_t i = 0; i < _types.size(); ++i) {
        listOutputs(_indices[std::size_t(_types[i].sample)], listed);
        for (std::size_t place = 0; place < listed.size(); ++place) {
            std::vector<Index> &sample = _samples[i];
            if (std::find(sample.begin(), sample.end(), listed[place]) == sample.end()) {
                sample.push_back(listed[place]);
                places[i].push_back(place);
            }
        }
        _types[i].numOutputs = int(places[i].size());
    }
    std::size_t numOutputs = 0;
    for (Face &face : _faces) {
        face.firstOutput = numOutputs;
        numOutputs += std::size_t(_types[std::size_t(face.type)].numOutputs);
    }
    _outputs.Resize(numOutputs);
    ParallelForRange(
        Index(_faces.size()), [] { return std::vector<Index>(); },
        [&](std::vector<Index> &ofFace, Index begin, Index end) {
            for (Index i = begin; i < end; ++i) {
                Face const &face = _faces[std::size_t(i)];
                listOutputs(_indices[std::size_t(i)], ofFace);
                Index *output = _outputs.data() + face.firstOutput;
                for (std::size_t const place : places[std::size_t(face.type)]) {
                    *output++ = ofFace[place];
                }
            }
        },
        kRange);
}

// In the order of the faces, whatever the threads.
void PlainFaces::claimOutputs() {
    std::vector<unsigned char> isClaimed = _isMade;
    std::for_each_n(_outputs.data(), _outputs.size(), [&](Index &output) {
        unsigned char &mark = isClaimed[std::size_t(output)];
        output = mark ? Far::INDEX_INVALID : output;
        mark = 1;
    });
    _others = selectUnmarked(isClaimed);
}

CallStatus PlainFaces::FindRows(HexSchemeOptions const &schemeOptions, LimitRows &rows) {
    std::vector<Index> verts = _others;
    for (std::vector<Index> const &sample : _samples) {
        verts.insert(verts.end(), sample.begin(), sample.end());
    }
    SortUnique(verts, Index(_isMade.size()));
    CallStatus result = rows.Find(verts);
    if (!result.IsOk()) {
        return result;
    }
    std::vector<unsigned char> isComplete(_types.size(), 1);
    ParallelForRange(
        Index(_types.size()), [] { return Nothing(); },
        [&](Nothing, Index begin, Index end) {
            for (Index i = begin; i < end; ++i) {
                Type &type = _types[std::size_t(i)];
                PatchRows patchRows(_mesh, schemeOptions, _level, _last,
                                    GetSources(_faces[std::size_t(type.sample)]), type.numSources);
                for (Index const vert : _samples[std::size_t(i)]) {
                    Index sources[PlainNeighborhoodGatherer::kNumRegular];
                    type.rows.push_back(patchRows.Find(rows.GetRow(vert, 0, sources)));
                    isComplete[std::size_t(i)] &= !type.rows.back().empty();
                }
            }
        },
        1);
    bool const areAllComplete = std::all_of(isComplete.begin(), isComplete.end(),
                                            [](unsigned char mark) { return mark != 0; });
    if (areAllComplete) {
        return result;
    }
    _types.clear();
    _faces.clear();
    _others = selectUnmarked(_isMade);
    return rows.Find(_others);
}

} // namespace OpenSubdivHex::FarExt::internal

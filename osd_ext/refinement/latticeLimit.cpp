// SPDX-License-Identifier: Apache-2.0
#include "latticeLimit.h"

#include "latticeWeights.h"

#include "far_ext/vtr/parallel.h"

#include <algorithm>
#include <cstddef>
#include <map>

namespace OpenSubdivHex::OsdExt::internal {

using Far::Index;
using FarExt::internal::Buffer;
using FarExt::internal::LatticeFaces;

namespace {

// Some of the entries of some faces, which have count each, as entries of groups of faces: of each entry
// those of all faces, the last of which fills the last group up.
template <typename T, typename CONVERT>
void group(std::vector<Index> const &faces, Buffer<Index> const &entries, int count,
           std::vector<int> const &some, Buffer<T> &result, CONVERT convert) {
    constexpr std::size_t kSize = RegularFaceGroup::kSize;
    std::size_t const numFaces = faces.size();
    std::size_t const numGroups = (numFaces + kSize - 1) / kSize;
    std::size_t const size = numGroups * kSize * some.size();
    result.Resize(size);
    FarExt::internal::ParallelFor(Index(numGroups), [&](Index i) {
        std::size_t const first = std::size_t(i) * kSize;
        T *next = result.data() + first * some.size();
        for (int const k : some) {
            for (std::size_t face = first; face < first + kSize; ++face) {
                auto const from = std::size_t(faces[std::min(face, numFaces - 1)]);
                *next++ = convert(entries[from * std::size_t(count) + std::size_t(k)]);
            }
        }
    });
}

// Outputs that are made between the asking for memory and the writing there, or a group.
constexpr int kNumAhead = 200;

// Keeps some of the vertices of a group: each vertex is one of them, or between two that are less than a
// cache line of points apart.
Index *keepAhead(Index *begin, Index *end) {
    constexpr Index kReach = 5;
    std::sort(begin, end);
    Index *kept = begin + 1;
    for (Index *vert = begin + 1; vert != end; ++vert) {
        Index const last = kept[-1];
        bool const isReached = *vert - last <= kReach;
        bool const isNextReached = vert + 1 != end && vert[1] - last <= kReach;
        if (!isReached || (!isNextReached && *vert != last)) {
            *kept++ = *vert;
        }
    }
    return kept;
}

int countPairs(LatticeFaces::Set const &set) {
    return int(std::count_if(set.orbits.begin(), set.orbits.end(),
                             [](auto const &orbit) { return orbit.isPair; }));
}

// The pairs of a face whose mirror images all belong to other faces.
std::vector<int> findHalves(LatticeFaces::Set const &set, Index face) {
    Index const *const outputs =
        set.outputs.data() + std::size_t(face) * std::size_t(set.numOutputs);
    int const faceSize = set.patch.GetFaceSize();
    Index const inside = outputs[set.numOutputs - faceSize];
    std::vector<int> halves;
    for (int pair = 0; pair < countPairs(set); ++pair) {
        Index const *const images = outputs + std::ptrdiff_t(2 * pair + 1) * faceSize;
        if (std::all_of(images, images + faceSize, [&](Index vert) { return vert == inside; })) {
            halves.push_back(pair);
        }
    }
    return halves;
}

} // namespace

void LatticeLimit::Prepare(LatticeFaces const &faces) {
    for (LatticeFaces::Set const &of : faces.GetSets()) {
        std::map<std::vector<int>, std::vector<Index>> facesWithHalves;
        for (Index face = 0; face < Index(of.faces.size()); ++face) {
            facesWithHalves[findHalves(of, face)].push_back(face);
        }
        for (auto const &[halves, some] : facesWithHalves) {
            addSet(of, some, halves);
        }
    }
}

void LatticeLimit::addSet(LatticeFaces::Set const &of, std::vector<Index> const &faces,
                          std::vector<int> const &halves) {
    Set &set = _sets.emplace_back();
    set.faceSize = of.patch.GetFaceSize();
    int const numPairs = countPairs(of);
    set.numHalves = int(halves.size());
    set.numPairs = numPairs - set.numHalves;
    set.numAxes = int(of.orbits.size()) - numPairs;
    constexpr Index kSize = RegularFaceGroup::kSize;
    set.numGroups = (Index(faces.size()) + kSize - 1) / kSize;
    SourceOrbits const sources = FindSourceOrbits(of);
    set.isCompact = sources.isCompact;
    std::vector<int> places;
    auto const addOrbit = [&](int first, int numOrbits, std::vector<int> &entries) {
        for (int i = 0; i < numOrbits * set.faceSize; ++i) {
            entries.push_back(first * set.faceSize + i);
        }
    };
    for (int const orbit : sources.axes) {
        addOrbit(orbit, 1, places);
    }
    for (int const orbit : sources.pairs) {
        addOrbit(orbit, 2, places);
    }
    group(faces, of.sources, of.patch.GetNumPlaces(), places, set.places, [](Index vert) {
        return std::uint32_t(vert) * std::uint32_t(RegularFaceGroup::kPointStride);
    });
    std::vector<int> outputs;
    auto const addOutputs = [&](int orbit, int first, int numOrbits) {
        addOrbit(first, numOrbits, outputs);
        AddOrbitWeights(sources, of.patch, of.orbits[std::size_t(orbit)], set.weights);
    };
    for (int pair = 0; pair < numPairs; ++pair) {
        if (std::find(halves.begin(), halves.end(), pair) == halves.end()) {
            addOutputs(pair, 2 * pair, 2);
        }
    }
    for (int const pair : halves) {
        addOutputs(pair, 2 * pair, 1);
    }
    for (int i = 0; i < set.numAxes; ++i) {
        addOutputs(numPairs + i, 2 * numPairs + i, 1);
    }
    group(faces, of.outputs, of.numOutputs, outputs, set.verts, [](Index vert) { return vert; });
    auto const numVerts = std::ptrdiff_t(outputs.size()) * kSize;
    set.numGroupsAhead = 1 + int(kNumAhead / numVerts);
    Buffer<Index> ahead;
    ahead.Resize(set.verts.size());
    std::copy(set.verts.begin(), set.verts.end(), ahead.data());
    std::vector<Index *> ends(std::size_t(set.numGroups));
    FarExt::internal::ParallelFor(set.numGroups, [&](Index i) {
        Index *const first = ahead.data() + i * numVerts;
        ends[std::size_t(i)] = keepAhead(first, first + numVerts);
    });
    for (Index i = 0; i < set.numGroups; ++i) {
        set.firstAhead.push_back(Index(set.ahead.size()));
        set.ahead.insert(set.ahead.end(), ahead.data() + i * numVerts, ends[std::size_t(i)]);
    }
    set.firstAhead.resize(std::size_t(set.numGroups + set.numGroupsAhead) + 1,
                          Index(set.ahead.size()));
}

void LatticeLimit::Evaluate(LimitTask const &common) const {
    for (Set const &set : _sets) {
        LatticeTask task;
        static_cast<LimitTask &>(task) = common;
        task.faceSize = set.faceSize;
        task.isCompact = set.isCompact;
        task.numPairs = set.numPairs;
        task.numHalves = set.numHalves;
        task.numAxes = set.numAxes;
        task.places = set.places.data();
        task.verts = set.verts.data();
        task.ahead = set.ahead.data();
        task.firstAhead = set.firstAhead.data();
        task.numGroupsAhead = set.numGroupsAhead;
        task.weights = set.weights.data();
        EvaluateLimit(task, set.numGroups);
    }
}

} // namespace OpenSubdivHex::OsdExt::internal

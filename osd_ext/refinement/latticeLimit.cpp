// SPDX-License-Identifier: Apache-2.0
#include "latticeLimit.h"

#include "latticeWeights.h"

#include "far_ext/vtr/parallel.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <iterator>
#include <optional>

namespace OpenSubdivHex::OsdExt::internal {

using Far::Index;
using FarExt::internal::Buffer;
using FarExt::internal::LatticeFaces;

namespace {

// Some of the entries of some faces as entries of groups of faces: of each entry those of all faces, the
// last of which fills the last group up.  getEntry(face, entry) gives one.
template <typename T, typename GET_ENTRY>
void group(std::vector<Index> const &faces, std::vector<int> const &entries, Buffer<T> &result,
           GET_ENTRY getEntry) {
    constexpr std::size_t kSize = RegularFaceGroup::kSize;
    std::size_t const numFaces = faces.size();
    std::size_t const numGroups = (numFaces + kSize - 1) / kSize;
    result.Resize(numGroups * kSize * entries.size());
    FarExt::internal::ParallelFor(Index(numGroups), [&](Index i) {
        std::size_t const first = std::size_t(i) * kSize;
        T *next = result.data() + first * entries.size();
        for (int const entry : entries) {
            for (std::size_t face = first; face < first + kSize; ++face) {
                *next++ =
                    getEntry(std::size_t(faces[std::min(face, numFaces - 1)]), std::size_t(entry));
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

// Whether output first[i] + 1 of all of some faces is output next[i].
bool areConsecutive(LatticeFaces::Set const &set, std::vector<Index> const &faces,
                    std::vector<int> const &first, std::vector<int> const &next) {
    return std::all_of(faces.begin(), faces.end(), [&](Index face) {
        Index const *const outputs =
            set.outputs.data() + std::size_t(face) * std::size_t(set.numOutputs);
        return std::equal(first.begin(), first.end(), next.begin(), next.end(),
                          [&](int a, int b) { return outputs[a] + 1 == outputs[b]; });
    });
}

// Finds LatticeTask::areConsecutive for outputs that begin with number begin.
bool isPairConsecutive(LatticeFaces::Set const &set, std::vector<Index> const &faces, int begin) {
    int const size = set.patch.GetFaceSize();
    std::vector<int> images;
    std::vector<int> next;
    for (int i = 0; i < size; ++i) {
        images.push_back(begin + size + i);
        next.push_back(begin + (i + size - 1) % size);
    }
    return areConsecutive(set, faces, images, next);
}
bool isOrbitConsecutive(LatticeFaces::Set const &set, std::vector<Index> const &faces, int begin) {
    std::vector<int> first;
    std::vector<int> next;
    for (int i = 0; i + 1 < set.patch.GetFaceSize(); ++i) {
        first.push_back(begin + i);
        next.push_back(begin + i + 1);
    }
    return areConsecutive(set, faces, first, next);
}

// Appends the places, or outputs, of some orbits.
void addOrbits(int first, int numOrbits, int faceSize, std::vector<int> &entries) {
    for (int i = 0; i < numOrbits * faceSize; ++i) {
        entries.push_back(first * faceSize + i);
    }
}

} // namespace

void LatticeLimit::Prepare(LatticeFaces const &faces) {
    for (LatticeFaces::Set const &of : faces.GetSets()) {
        UsedOrbits const sources = findSources(of);
        Corners const corners = makeCorners(faces, of, sources);
        for (auto const &[halves, some] : GroupByHalves(of)) {
            Set &set = _sets.emplace_back();
            set.faceSize = of.patch.GetFaceSize();
            set.numGroups =
                (Index(some.size()) + RegularFaceGroup::kSize - 1) / Index(RegularFaceGroup::kSize);
            setSources(of, sources, some, set);
            setOutputs(of, sources, corners, some, halves, set);
            setAhead(set);
        }
    }
    std::sort(_madeCorners.begin(), _madeCorners.end());
}

LatticeLimit::UsedOrbits LatticeLimit::findSources(LatticeFaces::Set const &of) {
    if (std::optional<SourceOrbits> const compact = FindCompactSourceOrbits(of)) {
        return {true, *compact};
    }
    return {false, GetAllSourceOrbits(of.patch)};
}

LatticeLimit::Corners LatticeLimit::makeCorners(LatticeFaces const &faces,
                                                LatticeFaces::Set const &of,
                                                UsedOrbits const &sources) {
    Corners corners;
    auto const faceSize = std::size_t(of.patch.GetFaceSize());
    // For triangles one corner in six is made.
    if (!of.corners || faceSize == 3) {
        return corners;
    }
    if (sources.areCompact && !DependsOnThese(sources.orbits, of.patch, *of.corners)) {
        return corners;
    }
    corners.resize(of.faces.size() * faceSize, Far::INDEX_INVALID);
    for (Index const vert : faces.GetVertices()) {
        LatticeFaces::VertexPlace const place = faces.FindPlace(vert);
        if (place.set == &of) {
            corners[place.face * faceSize + std::size_t(place.corner)] = vert;
            _madeCorners.push_back(vert);
        }
    }
    return corners;
}

void LatticeLimit::setSources(LatticeFaces::Set const &of, UsedOrbits const &sources,
                              std::vector<Index> const &faces, Set &set) {
    set.isCompact = sources.areCompact;
    std::vector<int> places;
    for (int const orbit : sources.orbits.axes) {
        addOrbits(orbit, 1, set.faceSize, places);
    }
    for (int const orbit : sources.orbits.pairs) {
        addOrbits(orbit, 2, set.faceSize, places);
    }
    auto const numPlaces = std::size_t(of.patch.GetNumPlaces());
    group(faces, places, set.places, [&](std::size_t face, std::size_t place) {
        return std::uint32_t(of.sources[face * numPlaces + place]) *
               std::uint32_t(RegularFaceGroup::kPointStride);
    });
}

void LatticeLimit::setOutputs(LatticeFaces::Set const &of, UsedOrbits const &sources,
                              Corners const &corners, std::vector<Index> const &faces,
                              std::vector<int> const &halves, Set &set) {
    int const numPairs = CountPairs(of);
    int const numInside = int(of.orbits.size()) - numPairs;
    set.numHalves = int(halves.size());
    set.numPairs = numPairs - set.numHalves;
    set.numAxes = numInside + (corners.empty() ? 0 : 1);
    std::vector<int> outputs;
    auto const addWeights = [&](LatticeFaces::Orbit const &orbit) {
        AddOrbitWeights(sources.orbits, of.patch, orbit, set.weights);
    };
    auto const addOutputs = [&](int orbit, int first, int numOrbits) {
        addOrbits(first, numOrbits, set.faceSize, outputs);
        int const begin = first * set.faceSize;
        set.areConsecutive.push_back(numOrbits == 2 ? isPairConsecutive(of, faces, begin)
                                                    : isOrbitConsecutive(of, faces, begin));
        addWeights(of.orbits[std::size_t(orbit)]);
    };
    for (int pair = 0; pair < numPairs; ++pair) {
        if (std::find(halves.begin(), halves.end(), pair) == halves.end()) {
            addOutputs(pair, 2 * pair, 2);
        }
    }
    for (int const pair : halves) {
        addOutputs(pair, 2 * pair, 1);
    }
    // Corners stand behind the outputs of LatticeFaces.  They are made before those inside, one of which
    // stands for what is not made.
    assert(numInside > 0);
    auto const numOutputs = std::size_t(of.numOutputs);
    if (!corners.empty()) {
        addOrbits(int(numOutputs) / set.faceSize, 1, set.faceSize, outputs);
        set.areConsecutive.push_back(0);
        addWeights(*of.corners);
    }
    for (int i = 0; i < numInside; ++i) {
        addOutputs(numPairs + i, 2 * numPairs + i, 1);
    }
    group(faces, outputs, set.verts, [&](std::size_t face, std::size_t output) {
        if (output < numOutputs) {
            return of.outputs[face * numOutputs + output];
        }
        Index const corner = corners[face * std::size_t(set.faceSize) + output - numOutputs];
        return corner >= 0 ? corner : of.GetStandIn(face);
    });
}

void LatticeLimit::setAhead(Set &set) {
    auto const numVerts = std::ptrdiff_t(set.verts.size()) / set.numGroups; // of a group
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
        task.areConsecutive = set.areConsecutive.data();
        task.ahead = set.ahead.data();
        task.firstAhead = set.firstAhead.data();
        task.numGroupsAhead = set.numGroupsAhead;
        task.weights = set.weights.data();
        EvaluateLimit(task, set.numGroups);
    }
}

} // namespace OpenSubdivHex::OsdExt::internal

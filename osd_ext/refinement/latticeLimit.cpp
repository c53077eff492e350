// SPDX-License-Identifier: Apache-2.0
#include "latticeLimit.h"

#include "latticeWeights.h"

#include "far_ext/vtr/parallel.h"

#include <algorithm>
#include <numeric>

namespace OpenSubdivHex::OsdExt::internal {

using Far::Index;
using FarExt::internal::Buffer;
using FarExt::internal::LatticeFaces;

namespace {

// Some of the entries of all faces, which have count each, as entries of groups of faces: of each entry
// those of all faces, the last of which fills the last group up.
template <typename T, typename CONVERT>
void group(Buffer<Index> const &entries, int count, std::vector<int> const &some, Buffer<T> &result,
           CONVERT convert) {
    constexpr std::size_t kSize = RegularFaceGroup::kSize;
    std::size_t const numFaces = entries.size() / std::size_t(count);
    std::size_t const numGroups = (numFaces + kSize - 1) / kSize;
    std::size_t const size = numGroups * kSize * some.size();
    result.Resize(size + LatticeTask::kNumAhead);
    std::fill_n(result.data() + size, LatticeTask::kNumAhead, T(0));
    FarExt::internal::ParallelFor(Index(numGroups), [&](Index i) {
        std::size_t const first = std::size_t(i) * kSize;
        T *next = result.data() + first * some.size();
        for (int const k : some) {
            for (std::size_t face = first; face < first + kSize; ++face) {
                *next++ = convert(
                    entries[std::min(face, numFaces - 1) * std::size_t(count) + std::size_t(k)]);
            }
        }
    });
}

} // namespace

void LatticeLimit::Prepare(LatticeFaces const &faces) {
    for (LatticeFaces::Set const &of : faces.GetSets()) {
        Set &set = _sets.emplace_back();
        set.faceSize = of.patch.GetFaceSize();
        set.numPairs = int(std::count_if(of.orbits.begin(), of.orbits.end(),
                                         [](auto const &orbit) { return orbit.isPair; }));
        set.numAxes = int(of.orbits.size()) - set.numPairs;
        constexpr Index kSize = RegularFaceGroup::kSize;
        set.numGroups = (Index(of.faces.size()) + kSize - 1) / kSize;
        SourceOrbits const sources = FindSourceOrbits(of);
        set.isCompact = sources.isCompact;
        std::vector<int> places;
        auto const addPlaces = [&](int orbit) {
            for (int i = 0; i < set.faceSize; ++i) {
                places.push_back(orbit * set.faceSize + i);
            }
        };
        for (int const orbit : sources.axes) {
            addPlaces(orbit);
        }
        for (int const orbit : sources.pairs) {
            addPlaces(orbit);
            addPlaces(orbit + 1);
        }
        group(of.sources, of.patch.GetNumPlaces(), places, set.places, [](Index vert) {
            return std::uint32_t(vert) * std::uint32_t(RegularFaceGroup::kPointStride);
        });
        std::vector<int> outputs(std::size_t(of.numOutputs));
        std::iota(outputs.begin(), outputs.end(), 0);
        group(of.outputs, of.numOutputs, outputs, set.verts, [](Index vert) { return vert; });
        for (LatticeFaces::Orbit const &orbit : of.orbits) {
            AddOrbitWeights(sources, of.patch, orbit, set.weights);
        }
    }
}

void LatticeLimit::Evaluate(LimitTask const &common) const {
    for (Set const &set : _sets) {
        LatticeTask task;
        static_cast<LimitTask &>(task) = common;
        task.faceSize = set.faceSize;
        task.isCompact = set.isCompact;
        task.numPairs = set.numPairs;
        task.numAxes = set.numAxes;
        task.places = set.places.data();
        task.verts = set.verts.data();
        task.weights = set.weights.data();
        EvaluateLimit(task, set.numGroups);
    }
}

} // namespace OpenSubdivHex::OsdExt::internal

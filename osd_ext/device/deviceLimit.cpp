// SPDX-License-Identifier: Apache-2.0
#include "deviceLimit.h"

#include "far_ext/limit/limitOrigins.h"
#include "far_ext/vtr/parallel.h"
#include "far_ext/vtr/report.h"
#include "osd_ext/refinement/latticeWeights.h"
#include "osd_ext/refinement/limitKernel.h"
#include "osd_ext/refinement/limitRowWeights.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <string>

namespace OpenSubdivHex::OsdExt::internal {

using Far::Index;
using FarExt::CallStatus;
using FarExt::StatusCode;
using FarExt::internal::kRegularFaceSize;
using FarExt::internal::LatticeFaces;
using FarExt::internal::Level;
using FarExt::internal::LimitOrigins;
using FarExt::internal::LimitRow;
using FarExt::internal::LimitRows;
using FarExt::internal::RegularFace;
using FarExt::internal::RegularFaces;

namespace {

constexpr int kBitsOfLocal = 3;

DeviceRegularFace makeRegularFace(Level const &level, RegularFace const &face) {
    DeviceRegularFace result = {std::uint32_t(face.firstCorner), {}, 0};
    for (int i = 0; i < kRegularFaceSize; ++i) {
        Index const first = level.faceFirstCorner[std::size_t(face.beyond[i])];
        Index const *const verts = level.faceVerts.data() + first;
        auto const local =
            unsigned(std::find(verts, verts + kRegularFaceSize, face.neighbors[i]) - verts);
        result.beyond[i] = std::uint32_t(first);
        result.locals |= local << unsigned(kBitsOfLocal * i);
    }
    return result;
}

DeviceOwnFace makeOwnFace(Level const &level, RegularFace const &face) {
    DeviceOwnFace result = {std::uint32_t(level.faceVerts[std::size_t(face.firstCorner)]), {}};
    for (int i = 0; i < kRegularFaceSize; ++i) {
        std::uint32_t(&around)[kRegularFaceSize] = result.around[i];
        around[0] = std::uint32_t(face.neighbors[i]);
        around[1] = std::uint32_t(face.previous[i]);
        for (int k = 0; k < RegularFace::kNumOthers; ++k) {
            around[2 + k] = std::uint32_t(face.GetOther(level, i, k));
        }
        around[kRegularFaceSize - 1] = std::uint32_t(face.next[i]);
    }
    return result;
}

// Adds the faces of a set, made by \p make.
template <typename FACE, typename MAKE>
DeviceLimit::Set addFaces(Level const &level, RegularFaces::Set const &set, MAKE const &make,
                          std::vector<FACE> &faces) {
    std::size_t const first = faces.size();
    DeviceLimit::Set result;
    result.count = std::uint32_t(set.faces.size());
    result.firstFace = std::uint32_t(first);
    result.firstVertex = std::uint32_t(set.firstVertex);
    if (!set.faces.empty()) {
        RegularLimitWeights<Scalar> const weights = MakeRegularLimitWeights(set.mask);
        static_assert(sizeof(weights) == sizeof(result.weights));
        std::memcpy(result.weights, &weights, sizeof(weights));
    }
    faces.resize(first + set.faces.size());
    FarExt::internal::ParallelFor(Index(set.faces.size()), [&](Index i) {
        faces[first + std::size_t(i)] = make(level, set.faces[std::size_t(i)]);
    });
    return result;
}

// Adds the orbits of some faces of a set: the pairs that have both halves, then the halves of others and
// the orbits on axes.
void addLattice(LatticeFaces::Set const &set, std::vector<int> const &halves,
                std::vector<Index> const &faces, DeviceLimit &limit) {
    DeviceLimit::Lattice &lattice = limit.lattices.emplace_back();
    int const faceSize = set.patch.GetFaceSize();
    int const numPairs = CountPairs(set);
    std::vector<int> orbits;
    std::vector<std::size_t> outputs;
    auto const addOrbit = [&](int orbit, int firstOutput, int numOutputs) {
        orbits.push_back(orbit);
        for (int i = 0; i < numOutputs; ++i) {
            outputs.push_back(std::size_t(firstOutput + i));
        }
    };
    for (int pair = 0; pair < numPairs; ++pair) {
        if (!std::binary_search(halves.begin(), halves.end(), pair)) {
            addOrbit(pair, 2 * pair * faceSize, 2 * faceSize);
        }
    }
    lattice.numPairs = std::uint32_t(orbits.size());
    for (int const pair : halves) {
        addOrbit(pair, 2 * pair * faceSize, faceSize);
    }
    for (int orbit = numPairs; orbit < int(set.orbits.size()); ++orbit) {
        addOrbit(orbit, (numPairs + orbit) * faceSize, faceSize);
    }
    auto const numPlaces = std::size_t(set.patch.GetNumPlaces());
    auto const numOutputs = std::size_t(set.numOutputs);
    std::size_t const numFaces = faces.size();
    std::size_t const firstIndex = limit.latticeIndices.size();
    std::size_t const firstOutput = firstIndex + numFaces * numPlaces;
    lattice.faceSize = faceSize;
    lattice.numFaces = std::uint32_t(numFaces);
    lattice.firstIndex = std::uint32_t(firstIndex);
    lattice.firstOutput = std::uint32_t(firstOutput);
    limit.latticeIndices.resize(firstOutput + numFaces * outputs.size());
    std::uint32_t *const indices = limit.latticeIndices.data();
    FarExt::internal::ParallelFor(Index(numFaces), [&](Index i) {
        auto const face = std::size_t(faces[std::size_t(i)]);
        for (std::size_t place = 0; place < numPlaces; ++place) {
            indices[firstIndex + place * numFaces + std::size_t(i)] =
                std::uint32_t(set.sources[face * numPlaces + place]);
        }
        // Duplicate indices, in slots that another face owns, occur again later.
        Index const standIn = set.GetStandIn(face);
        for (std::size_t k = 0; k < outputs.size(); ++k) {
            Index const output = set.outputs[face * numOutputs + outputs[k]];
            bool const isOfOther = output == standIn && k + std::size_t(faceSize) < outputs.size();
            indices[firstOutput + k * numFaces + std::size_t(i)] =
                isOfOther ? DeviceLimit::kNoVertex : std::uint32_t(output);
        }
    });
    SourceOrbits const sources = GetAllSourceOrbits(set.patch);
    for (int const orbit : orbits) {
        AddOrbitWeights(sources, set.patch, MakePair(set.orbits[std::size_t(orbit)]),
                        lattice.weights);
    }
    lattice.numOrbits = std::uint32_t(orbits.size());
}

void addLattices(LatticeFaces const &faces, DeviceLimit &limit) {
    for (LatticeFaces::Set const &set : faces.GetSets()) {
        for (auto const &[halves, some] : GroupByHalves(set)) {
            addLattice(set, halves, some, limit);
        }
    }
}

// Adds the vertices whose limit is a sum of vertices of a level.
void addVertices(LimitOrigins const &origins, int level, LimitRowWeights &weights,
                 DeviceLimit &limit) {
    Index sources[LimitOrigins::kMaxSources];
    for (Index const vert : origins.GetVertices(level)) {
        LimitRow const row = origins.GetRow(level, vert, sources);
        std::size_t const firstSource = limit.sources.size();
        row.ForEachPart([&](int i) { limit.sources.push_back(std::uint32_t(row.sources[i])); });
        limit.vertices.push_back({std::uint32_t(vert),
                                  std::uint32_t(limit.sources.size() - firstSource),
                                  std::uint32_t(firstSource), std::uint32_t(weights.Add(row))});
    }
}

} // namespace

CallStatus MakeDeviceLimit(FarExt::internal::MeshLevels const &mesh,
                           FarExt::HexSchemeOptions const &schemeOptions, LimitRows &rows,
                           DeviceLimit &limit) {
    LimitOrigins origins(mesh, rows);
    CallStatus result = origins.Find(schemeOptions);
    if (!result.IsOk()) {
        return result;
    }
    addLattices(origins.GetLatticeFaces(), limit);
    LimitRowWeights weights;
    for (int i = 0; i <= rows.GetLevel().depth; ++i) {
        Level const &level = mesh.levels[std::size_t(i)];
        RegularFaces::OfLevel const &faces = origins.GetFaces()[std::size_t(i)];
        DeviceLimit::OfLevel &ofLevel = limit.levels.emplace_back();
        ofLevel.fVertices = addFaces(level, faces.fVertices, makeRegularFace, limit.regularFaces);
        ofLevel.ownVertices = addFaces(level, faces.ownVertices, makeOwnFace, limit.ownFaces);
        ofLevel.firstVertex = std::uint32_t(limit.vertices.size());
        addVertices(origins, i, weights, limit);
        ofLevel.numVertices = std::uint32_t(limit.vertices.size()) - ofLevel.firstVertex;
    }
    limit.weights = weights.Get();
    constexpr auto kWordsOf = [](auto const &array) {
        return array.size() * sizeof(array[0]) / sizeof(std::uint32_t);
    };
    std::size_t const numWords = kWordsOf(limit.regularFaces) + kWordsOf(limit.ownFaces) +
                                 kWordsOf(limit.vertices) + kWordsOf(limit.sources) +
                                 limit.latticeIndices.size();
    if (std::max(numWords, limit.weights.size()) > std::numeric_limits<std::uint32_t>::max()) {
        return FarExt::internal::Failure(
            StatusCode::TooLarge, "the limit has " + std::to_string(numWords) + " indices and " +
                                      std::to_string(limit.weights.size()) +
                                      " weights, more than 32 bits reach");
    }
    return result;
}

} // namespace OpenSubdivHex::OsdExt::internal

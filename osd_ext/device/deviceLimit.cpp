// SPDX-License-Identifier: Apache-2.0
#include "deviceLimit.h"

#include "far_ext/vtr/parallel.h"
#include "osd_ext/refinement/limitKernel.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <string>
#include <unordered_map>

namespace OpenSubdivHex::OsdExt::internal {

using Far::Index;
using FarExt::Status;
using FarExt::StatusCode;
using FarExt::internal::kRegularFaceSize;
using FarExt::internal::Level;
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
        Index const *const verts =
            level.faceVerts.data() + level.faceFirstCorner[std::size_t(face.beyond[i])];
        // Of a vertex that has no face beyond, three of the face itself.
        int count = 2;
        for (int k = 0; k < kRegularFaceSize && count < kRegularFaceSize - 1; ++k) {
            if (verts[k] != face.neighbors[i] && verts[k] != face.next[i] &&
                verts[k] != face.previous[i]) {
                around[count++] = std::uint32_t(verts[k]);
            }
        }
        around[0] = std::uint32_t(face.neighbors[i]);
        around[1] = std::uint32_t(face.previous[i]);
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
        RegularLimitWeights<Scalar> const weights = MakeRegularLimitWeights(set.mask, false);
        static_assert(sizeof(weights) == sizeof(result.weights));
        std::memcpy(result.weights, &weights, sizeof(weights));
    }
    faces.resize(first + set.faces.size());
    FarExt::internal::ParallelFor(Index(set.faces.size()), [&](Index i) {
        faces[first + std::size_t(i)] = make(level, set.faces[std::size_t(i)]);
    });
    return result;
}

void addVertices(std::vector<Index> const &verts, LimitRows const &rows, DeviceLimit &limit) {
    std::unordered_map<double const *, std::uint32_t>
        firstWeights; // of the types, by their weights
    Index regularSources[FarExt::internal::PlainNeighborhoodGatherer::kNumRegular];
    for (Index const vert : verts) {
        LimitRow const row = rows.GetRow(vert, 0, regularSources);
        auto const [found, isNew] =
            firstWeights.try_emplace(row.du, std::uint32_t(limit.weights.size()));
        for (int i = 0; i < row.size && isNew; ++i) {
            limit.weights.insert(limit.weights.end(),
                                 {float(row.weights[i]), float(row.du[i]), float(row.dv[i])});
        }
        limit.vertices.push_back({std::uint32_t(vert), std::uint32_t(row.size),
                                  std::uint32_t(limit.sources.size()), found->second});
        limit.sources.insert(limit.sources.end(), row.sources, row.sources + row.size);
    }
}

} // namespace

Status MakeDeviceLimit(FarExt::internal::MeshLevels const &mesh,
                       FarExt::HexSchemeOptions const &schemeOptions, LimitRows &rows,
                       DeviceLimit &limit) {
    RegularFaces regularFaces(mesh, rows.GetLevel().depth);
    Status result = regularFaces.FindMasks(schemeOptions, rows);
    if (!result.IsOk()) {
        return result;
    }
    std::vector<RegularFaces::OfLevel> const &levels = regularFaces.GetLevels();
    for (std::size_t i = 0; i < levels.size(); ++i) {
        Level const &level = mesh.levels[i];
        limit.levels.push_back(
            {addFaces(level, levels[i].fVertices, makeRegularFace, limit.regularFaces),
             addFaces(level, levels[i].ownVertices, makeOwnFace, limit.ownFaces)});
    }
    addVertices(regularFaces.GetOthers(), rows, limit);
    constexpr auto kWordsOf = [](auto const &array) {
        return array.size() * sizeof(array[0]) / sizeof(std::uint32_t);
    };
    std::size_t const numWords = kWordsOf(limit.regularFaces) + kWordsOf(limit.ownFaces) +
                                 kWordsOf(limit.vertices) + kWordsOf(limit.sources);
    if (std::max(numWords, limit.weights.size()) > std::numeric_limits<std::uint32_t>::max()) {
        return FarExt::internal::Failure(
            StatusCode::TooLarge, "the limit has " + std::to_string(numWords) + " indices and " +
                                      std::to_string(limit.weights.size()) +
                                      " weights, more than 32 bits reach");
    }
    return result;
}

} // namespace OpenSubdivHex::OsdExt::internal

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

DeviceRegularFace makeFace(Level const &level, RegularFace const &face) {
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

// The limit kernels take the weights one by one, in this order, but for the last two: the mask of
// F-vertices has one tip.
void addWeights(FarExt::internal::RegularFaceMask const &mask, std::vector<float> &weights) {
    RegularLimitWeights<Scalar> const ofMask = MakeRegularLimitWeights(mask);
    constexpr std::size_t kNumWeights = 52;
    static_assert(sizeof(ofMask) == (kNumWeights + 2) * sizeof(float));
    weights.resize(weights.size() + kNumWeights);
    std::memcpy(weights.data() + weights.size() - kNumWeights, &ofMask,
                kNumWeights * sizeof(float));
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
    RegularFaces regularFaces(mesh, rows.GetLevel().depth, false);
    Status result = regularFaces.FindMasks(schemeOptions, rows);
    if (!result.IsOk()) {
        return result;
    }
    for (int i = 0; i < rows.GetLevel().depth; ++i) {
        RegularFaces::Set const &ofLevel = regularFaces.GetLevels()[std::size_t(i)].fVertices;
        std::size_t const first = limit.faces.size();
        limit.levels.push_back({std::uint32_t(ofLevel.faces.size()), std::uint32_t(first),
                                std::uint32_t(limit.weights.size())});
        if (ofLevel.faces.empty()) {
            continue;
        }
        addWeights(ofLevel.mask, limit.weights);
        limit.faces.resize(first + ofLevel.faces.size());
        FarExt::internal::ParallelFor(Index(ofLevel.faces.size()), [&](Index k) {
            limit.faces[first + std::size_t(k)] =
                makeFace(mesh.levels[std::size_t(i)], ofLevel.faces[std::size_t(k)]);
        });
    }
    addVertices(regularFaces.GetOthers(), rows, limit);
    constexpr std::size_t kWordsOfFace = sizeof(DeviceRegularFace) / sizeof(std::uint32_t);
    constexpr std::size_t kWordsOfVertex = sizeof(DeviceLimitVertex) / sizeof(std::uint32_t);
    std::size_t const numWords = kWordsOfFace * limit.faces.size() +
                                 kWordsOfVertex * limit.vertices.size() + limit.sources.size();
    if (std::max(numWords, limit.weights.size()) > std::numeric_limits<std::uint32_t>::max()) {
        return FarExt::internal::Failure(
            StatusCode::TooLarge, "the limit has " + std::to_string(numWords) + " indices and " +
                                      std::to_string(limit.weights.size()) +
                                      " weights, more than 32 bits reach");
    }
    return result;
}

} // namespace OpenSubdivHex::OsdExt::internal

// SPDX-License-Identifier: Apache-2.0
#include "patchTableFactory.h"

#include "far_ext/patch/farPatchTable.h"
#include "far_ext/patch/patchChecks.h"
#include "far_ext/patch/varyingPoints.h"
#include "far_ext/stencil/interpolationMode.h"
#include "far_ext/vtr/buffer.h"
#include "far_ext/vtr/report.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <numeric>
#include <string>

namespace OpenSubdivHex::FarExt {

using Far::Index;
using internal::LocalPoints;
using internal::PointStencils;

namespace {

// A table whose arrays are given.
class FilledStencilTable : public Far::StencilTable {
public:
    FilledStencilTable(int numControlVertices, std::vector<int> sizes, std::vector<Index> indices,
                       std::vector<float> weights)
        : Far::StencilTable(numControlVertices) {
        _sizes = std::move(sizes);
        _indices = std::move(indices);
        _weights = std::move(weights);
        _offsets.resize(_sizes.size());
        std::exclusive_scan(_sizes.begin(), _sizes.end(), _offsets.begin(), 0);
    }
};

LocalPoints toLocalPoints(int numControlPoints, PointStencils<float> stencils) {
    return {numControlPoints,
            std::move(stencils.sizes),
            std::move(stencils.indices),
            std::move(stencils.weights),
            {}};
}
LocalPoints toLocalPoints(int numControlPoints, PointStencils<double> stencils) {
    return {numControlPoints,
            std::move(stencils.sizes),
            std::move(stencils.indices),
            {},
            std::move(stencils.weights)};
}

template <typename REAL, typename POINTS>
CallStatus makeLocalPoints(POINTS const &points, int numControlPoints, LocalPoints &result) {
    PointStencils<REAL> stencils;
    CallStatus status = points.MakeStencils(stencils);
    result = toLocalPoints(numControlPoints, std::move(stencils));
    return status;
}

template <typename POINTS>
CallStatus makeLocalPoints(bool isDouble, POINTS const &points, int numControlPoints,
                           LocalPoints &result) {
    return isDouble ? makeLocalPoints<double>(points, numControlPoints, result)
                    : makeLocalPoints<float>(points, numControlPoints, result);
}

std::vector<Index> shift(std::vector<Index> points, int offset) {
    for (Index &point : points) {
        point += offset;
    }
    return points;
}

// Kites have depth 1 in the terms of Far: their sides are half as long as those of their neighbours, where
// patches have a transition.
std::vector<Far::PatchParam> makeParams(internal::MeshLevels const &mesh,
                                        internal::PatchCells const &cells) {
    std::vector<Far::PatchParam> params;
    params.reserve(std::size_t(cells.GetNumPatches()));
    for (int depth = cells.GetFirstLevel(); depth <= cells.GetLastLevel(); ++depth) {
        internal::Level const &level = mesh.levels[std::size_t(depth)];
        for (internal::PatchCell const &cell : cells.GetCells(depth)) {
            internal::FaceCells const ofFace = internal::FindFaceCells(level, cell.face);
            bool const isKite = ofFace.HasKites(cell.half);
            unsigned short transitions = 0;
            auto const addTransition = [&](int side, internal::FaceCells const &other, Index face,
                                           int half) {
                bool const hasKites = other.HasKites(half) && cells.HasCell(depth, face, half);
                transitions |= hasKites ? 1u << side : 0u;
            };
            if (ofFace.IsCut() && !isKite) {
                addTransition(0, ofFace, cell.face, 1 - cell.half);
            }
            for (int side = ofFace.IsCut() ? 1 : 0; side < 4 && !isKite; ++side) {
                int const local = ofFace.GetLocal(cell.half, side);
                Index const edge = level.faceEdges[level.faceFirstCorner[cell.face] + local];
                for (int i = 0; i < 2; ++i) {
                    Index const face = level.edgeFaces[edge][i];
                    if (face >= 0) {
                        internal::FaceCells const other = internal::FindFaceCells(level, face);
                        int const half = other.GetHalfOfEdge(level.edgeFaceLocals[edge][i]);
                        addTransition(side, other, face, half);
                    }
                }
            }
            for (int i = 0; i < ofFace.GetNumPatches(cell.half); ++i) {
                Far::PatchParam param;
                param.Set(Index(params.size()), 0, 0, isKite ? 1 : 0, isKite, 0, transitions,
                          false);
                params.push_back(param);
            }
        }
    }
    return params;
}

std::unique_ptr<Far::StencilTable const> makeTable(LocalPoints points) {
    return std::make_unique<FilledStencilTable const>(
        points.numControlPoints, std::move(points.sizes), std::move(points.indices),
        std::move(points.weights));
}

// The channels that are asked for.
CallStatus findChannels(TopologyRefiner const &refiner, PatchTableFactory::Options const &options,
                        std::vector<int> &channels) {
    if (!options.generateFVarTables) {
        return CallStatus();
    }
    int const numChannels = refiner.GetNumFVarChannels();
    if (options.numFVarChannels < 0) {
        channels.resize(std::size_t(numChannels));
        std::iota(channels.begin(), channels.end(), 0);
        return CallStatus();
    }
    if (options.numFVarChannels > 0 && !options.fvarChannelIndices) {
        return internal::Failure(StatusCode::InvalidArgument,
                                 "there are numFVarChannels without fvarChannelIndices");
    }
    for (int i = 0; i < options.numFVarChannels; ++i) {
        int const channel = options.fvarChannelIndices[i];
        if (CallStatus result = internal::CheckChannel(channel, numChannels); !result.IsOk()) {
            return result;
        }
        channels.push_back(channel);
    }
    return CallStatus();
}

// \p cells are those of the mesh.
CallStatus makeChannel(TopologyRefiner const &refiner, PatchTableFactory::Options const &options,
                       internal::PatchCells const &cells, int channel,
                       internal::PatchTableContent::Channel &result) {
    internal::Hierarchy const &hierarchy = refiner.GetHierarchy();
    std::vector<Index> patches;
    internal::PatchCells const ofValues(hierarchy.channels[std::size_t(channel)], hierarchy.mesh,
                                        cells, patches);
    int const numValues = hierarchy.GetNumControlPoints(channel);
    auto const setValues = [&](std::vector<Index> const &points) {
        std::size_t const numOfPatch = points.size() / patches.size();
        result.values.reserve(points.size());
        for (Index const patch : patches) {
            auto const first = points.begin() + std::ptrdiff_t(numOfPatch) * patch;
            std::transform(first, first + std::ptrdiff_t(numOfPatch),
                           std::back_inserter(result.values),
                           [&](Index point) { return numValues + point; });
        }
    };
    result.isLinear = options.generateFVarLegacyLinearPatches ||
                      refiner.GetFVarLinearInterpolation(channel) == Sdc::Options::FVAR_LINEAR_ALL;
    if (result.isLinear) {
        internal::VaryingPoints const points(refiner, channel, ofValues);
        setValues(points.GetPatchPoints());
        return makeLocalPoints(options.fvarPatchPrecisionDouble, points, numValues, result.points);
    }
    internal::PatchBuilder builder(hierarchy, channel, refiner.GetSchemeOptions(),
                                   refiner.GetHexSchemeOptions(), ofValues);
    if (CallStatus status = builder.Build(); !status.IsOk()) {
        return status;
    }
    setValues(builder.GetPatchPoints());
    return makeLocalPoints(options.fvarPatchPrecisionDouble, builder, numValues, result.points);
}

} // namespace

std::unique_ptr<Far::PatchTable const>
PatchTableFactory::Create(TopologyRefiner const &refiner, Options options, CallStatus *status) {
    std::optional<internal::PatchCells> cells;
    std::vector<int> channels;
    CallStatus checked = findChannels(refiner, options, channels);
    if (checked.IsOk()) {
        checked = internal::FindPatchCells(refiner, options, cells);
    }
    if (!internal::Report(checked, status)) {
        return nullptr;
    }
    internal::Hierarchy const &hierarchy = refiner.GetHierarchy();
    int const numControlVerts = refiner.GetLevel(0).GetNumVertices();
    internal::PatchTableContent content;
    content.isDouble = options.patchPrecisionDouble;
    internal::PatchBuilder builder(hierarchy, -1, refiner.GetSchemeOptions(),
                                   refiner.GetHexSchemeOptions(), *cells);
    CallStatus result = builder.Build();
    if (result.IsOk()) {
        result = makeLocalPoints(content.isDouble, builder, numControlVerts, content.points);
    }
    if (result.IsOk() && options.generateVaryingTables) {
        internal::VaryingPoints const points(refiner, -1, *cells);
        content.varyingVertices = shift(points.GetPatchPoints(), numControlVerts);
        result = makeLocalPoints(content.isDouble, points, numControlVerts, content.varyingPoints);
    }
    content.isFVarDouble = options.fvarPatchPrecisionDouble;
    for (int const channel : channels) {
        if (result.IsOk()) {
            content.channels.emplace_back();
            result = makeChannel(refiner, options, *cells, channel, content.channels.back());
        }
    }
    if (!internal::Report(result, status)) {
        return nullptr;
    }
    content.vertices = shift(builder.GetPatchPoints(), numControlVerts);
    content.params = makeParams(hierarchy.mesh, *cells);
    auto table = internal::MakeFarPatchTable(std::move(content));
    internal::Report(table ? CallStatus()
                           : internal::Failure(StatusCode::Unsupported,
                                               "this version of OpenSubdiv makes no table of "
                                               "Gregory patches"),
                     status);
    return table;
}

std::unique_ptr<Far::StencilTable const>
PatchTableFactory::CreateLocalPointStencilTable(TopologyRefiner const &refiner, Options options,
                                                CallStatus *status) {
    std::optional<internal::PatchCells> cells;
    if (!internal::Report(internal::FindPatchCells(refiner, options, cells), status)) {
        return nullptr;
    }
    internal::PatchBuilder builder(refiner.GetHierarchy(), -1, refiner.GetSchemeOptions(),
                                   refiner.GetHexSchemeOptions(), *cells);
    CallStatus result = builder.Build();
    LocalPoints points;
    if (result.IsOk()) {
        result = makeLocalPoints(false, builder, refiner.GetLevel(0).GetNumVertices(), points);
    }
    return internal::Report(result, status) ? makeTable(std::move(points)) : nullptr;
}

std::unique_ptr<Far::StencilTable const> PatchTableFactory::CreateLocalPointFaceVaryingStencilTable(
    TopologyRefiner const &refiner, Options options, int channel, CallStatus *status) {
    std::optional<internal::PatchCells> cells;
    CallStatus result = internal::CheckChannel(channel, refiner.GetNumFVarChannels());
    if (result.IsOk()) {
        result = internal::FindPatchCells(refiner, options, cells);
    }
    internal::PatchTableContent::Channel content;
    if (result.IsOk()) {
        options.fvarPatchPrecisionDouble = false;
        result = makeChannel(refiner, options, *cells, channel, content);
    }
    return internal::Report(result, status) ? makeTable(std::move(content.points)) : nullptr;
}

std::unique_ptr<Far::StencilTable const> PatchTableFactory::AppendLocalPointStencilTable(
    Far::StencilTable const *base, Far::StencilTable const *localPoints, CallStatus *status) {
    auto const fail = [&](StatusCode code, std::string const &message) {
        internal::Report(internal::Failure(code, message), status);
        return nullptr;
    };
    if (!base || !localPoints) {
        return fail(StatusCode::InvalidArgument, "a stencil table to be joined is null");
    }
    int const numControlVerts = base->GetNumControlVertices();
    if (numControlVerts != localPoints->GetNumControlVertices()) {
        return fail(StatusCode::InvalidArgument,
                    "stencils of " + std::to_string(numControlVerts) +
                        " control vertices cannot be joined to local points of " +
                        std::to_string(localPoints->GetNumControlVertices()));
    }
    std::size_t const numWeights = base->GetWeights().size() + localPoints->GetWeights().size();
    if (numWeights > std::size_t(std::numeric_limits<Index>::max())) {
        return fail(StatusCode::TooLarge, "both tables have " + std::to_string(numWeights) +
                                              " weights, more than Far's 32-bit offsets reach");
    }
    auto const join = [&](auto const &first, auto const &second) {
        auto result = first;
        result.insert(result.end(), second.begin(), second.end());
        return result;
    };
    internal::Report(CallStatus(), status);
    return std::make_unique<FilledStencilTable const>(
        numControlVerts, join(base->GetSizes(), localPoints->GetSizes()),
        join(base->GetControlIndices(), localPoints->GetControlIndices()),
        join(base->GetWeights(), localPoints->GetWeights()));
}

} // namespace OpenSubdivHex::FarExt

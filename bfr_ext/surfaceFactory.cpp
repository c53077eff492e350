// SPDX-License-Identifier: Apache-2.0
#include "surfaceFactory.h"

#include "cell/cellType.h"
#include "cell/surfaceTurns.h"

#include "far_ext/limit/limitRows.h"
#include "far_ext/limit/plainCell.h"

#include <algorithm>
#include <string>

namespace OpenSubdivHex::BfrExt {

using FarExt::ComponentType;
using FarExt::Interpolation;
using FarExt::Status;
using FarExt::StatusCode;
using FarExt::internal::CellPatch;
using FarExt::internal::FVarChannel;
using FarExt::internal::Level;
using FarExt::internal::VertexMark;

namespace {

// Vertices with fewer faces have limit stencils, whatever their features.
constexpr int kManyFaces = 64;

bool isAtFreeBoundary(Level const &level, Far::Index vert) {
    Far::ConstIndexArray const edges = level.GetVertexEdges(vert);
    return std::any_of(edges.begin(), edges.end(), [&](Far::Index edge) {
        return level.edgeFaces[edge][1] == FarExt::internal::kFreeBoundary;
    });
}

} // namespace

SurfaceFactory::SurfaceFactory(FarExt::TopologyRefiner const &refiner, Options options)
    : _refiner(refiner), _options(options),
      _types(options.GetExternalCache() ? options.GetExternalCache()->_types
                                        : std::make_shared<internal::CellTypes>()) {
    FarExt::internal::Hierarchy const &hierarchy = refiner.GetHierarchy();
    for (int channel = -1; channel < refiner.GetNumFVarChannels(); ++channel) {
        _marks.push_back(FarExt::internal::MarkFeatures(hierarchy.GetMesh(channel).levels[0]));
    }
}

SurfaceFactory::~SurfaceFactory() = default;

std::unique_ptr<SurfaceFactory> SurfaceFactory::Create(FarExt::TopologyRefiner const &refiner,
                                                       Options options, Status *status) {
    Status const result =
        FarExt::internal::CheckLimitLevel(refiner.GetHierarchy(), refiner.GetHexSchemeOptions(), 0);
    if (!FarExt::internal::Report(result, status)) {
        return nullptr;
    }
    return std::unique_ptr<SurfaceFactory>(new SurfaceFactory(refiner, options));
}

Status SurfaceFactory::checkFace(Index face) const {
    auto const fail = [face](StatusCode code, std::string const &message) {
        return Status(code, ComponentType::Face, face, "face " + std::to_string(face) + message);
    };
    Level const &level = _refiner.GetHierarchy().mesh.levels[0];
    if (face < 0 || face >= level.numFaces) {
        return fail(StatusCode::InvalidArgument, " is not one of the " +
                                                     std::to_string(level.numFaces) +
                                                     " faces of the base mesh");
    }
    if (level.GetHoles(face) == FarExt::internal::kHole) {
        return fail(StatusCode::InvalidArgument, " is a hole, which has no surface");
    }
    for (Index const vert : level.GetFaceVertices(face)) {
        if (isAtFreeBoundary(level, vert)) {
            return fail(StatusCode::Unsupported,
                        " has vertex " + std::to_string(vert) +
                            " on a boundary that VTX_BOUNDARY_NONE leaves without a limit");
        }
    }
    return Status();
}

bool SurfaceFactory::FaceHasLimitSurface(Index face, Status *status) const {
    return FarExt::internal::Report(checkFace(face), status);
}

Parameterization SurfaceFactory::GetFaceParameterization(Index face) const {
    return Parameterization(_refiner.GetHierarchy().mesh.levels[0].GetFaceSize(face));
}

// Plain faces, which are most, are known by a short key; of each, the type is found from the patch once.
internal::CellType const &SurfaceFactory::findType(Level const &level,
                                                   std::vector<VertexMark> const &marks, Index face,
                                                   internal::CellRules const &rules,
                                                   std::vector<Index> &points) const {
    // What it has taken of memory is kept for the next face.
    static thread_local FarExt::internal::PlainCellGatherer gatherer;
    static thread_local FarExt::internal::PlainCell plain;
    bool const isPlain = gatherer.Gather(level, marks, face, plain);
    if (isPlain) {
        internal::CellTypes::AddRules(rules, plain.key);
        if (internal::CellType const *const type = _types->FindPlain(plain.key)) {
            points = plain.sources;
            return *type;
        }
    }
    CellPatch cell;
    GatherBaseCell(level, face, cell);
    points = cell.patch.sources;
    internal::CellType const &type = _types->Find(std::move(cell), rules);
    if (isPlain) {
        _types->AddPlain(plain.key, type);
    }
    return type;
}

template <typename REAL>
bool SurfaceFactory::init(Index face, Interpolation interpolation, int channel,
                          Surface<REAL> *surface, Status *status) const {
    surface->Clear();
    Status result = checkFace(face);
    if (!result.IsOk()) {
        return FarExt::internal::Report(result, status);
    }
    FarExt::internal::Hierarchy const &hierarchy = _refiner.GetHierarchy();
    FVarChannel const *const values =
        channel < 0 ? nullptr : &hierarchy.channels[std::size_t(channel)];
    Level const &level = hierarchy.GetMesh(channel).levels[0];
    Index const levelFace = values ? values->levels[0].valueFaces[face] : face;

    std::vector<Index> controlPoints;
    internal::CellType const &type =
        findType(level, _marks.begin()[channel + 1], levelFace,
                 {_refiner.GetSchemeOptions(),
                  FarExt::internal::GetStepsToLimit(_refiner.GetHexSchemeOptions()), interpolation},
                 controlPoints);
    if (values) {
        for (Index &point : controlPoints) {
            point = values->valuesOfVertices[point];
        }
    }
    Far::ConstIndexArray const verts = level.GetFaceVertices(levelFace);
    bool const hasManyFaces = std::any_of(verts.begin(), verts.end(), [&](Index vert) {
        return level.GetNumVertexFaces(vert) >= kManyFaces;
    });
    if (hasManyFaces && !type.HasCorners()) {
        result = Status(StatusCode::Unsupported, ComponentType::Face, face,
                        "the limit of face " + std::to_string(face) +
                            " cannot be computed: the steps around a vertex do not converge");
        return FarExt::internal::Report(result, status);
    }
    surface->_type = std::shared_ptr<internal::CellType const>(_types, &type);
    surface->_turns = std::make_shared<internal::SurfaceTurns const>(
        internal::SurfaceTurns{FindBaseCellTurns(level, levelFace)});
    surface->_controlPoints = std::move(controlPoints);
    surface->_parameterization = Parameterization(verts.size());
    return FarExt::internal::Report(result, status);
}

template <typename REAL>
bool SurfaceFactory::InitVertexSurface(Index face, Surface<REAL> *surface, Status *status) const {
    return init(face, Interpolation::Vertex, -1, surface, status);
}

template <typename REAL>
bool SurfaceFactory::InitVaryingSurface(Index face, Surface<REAL> *surface, Status *status) const {
    return init(face, Interpolation::Varying, -1, surface, status);
}

template <typename REAL>
bool SurfaceFactory::InitFaceVaryingSurface(Index face, Surface<REAL> *surface, FVarID channel,
                                            Status *status) const {
    if (channel < 0 || channel >= GetNumFVarChannels()) {
        surface->Clear();
        return FarExt::internal::Report(
            FarExt::internal::Failure(StatusCode::InvalidArgument,
                                      "channel " + std::to_string(channel) + " is not one of the " +
                                          std::to_string(GetNumFVarChannels()) +
                                          " face-varying channels"),
            status);
    }
    bool const isLinear =
        _refiner.GetFVarLinearInterpolation(channel) == Sdc::Options::FVAR_LINEAR_ALL;
    return init(face, isLinear ? Interpolation::Varying : Interpolation::Vertex, channel, surface,
                status);
}

template bool SurfaceFactory::InitVertexSurface(Index, Surface<float> *, Status *) const;
template bool SurfaceFactory::InitVertexSurface(Index, Surface<double> *, Status *) const;
template bool SurfaceFactory::InitVaryingSurface(Index, Surface<float> *, Status *) const;
template bool SurfaceFactory::InitVaryingSurface(Index, Surface<double> *, Status *) const;
template bool SurfaceFactory::InitFaceVaryingSurface(Index, Surface<float> *, FVarID,
                                                     Status *) const;
template bool SurfaceFactory::InitFaceVaryingSurface(Index, Surface<double> *, FVarID,
                                                     Status *) const;

} // namespace OpenSubdivHex::BfrExt

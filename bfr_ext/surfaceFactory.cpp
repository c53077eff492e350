// SPDX-License-Identifier: Apache-2.0
#include "surfaceFactory.h"

#include "cell/cellType.h"
#include "cell/latticeWalk.h"

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
                                        : std::make_shared<internal::CellTypes>()),
      _lattices(std::make_unique<internal::LatticeWalks>()) {
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

Status SurfaceFactory::checkIsFace(Index face) const {
    Level const &level = _refiner.GetHierarchy().mesh.levels[0];
    if (0 <= face && face < level.numFaces && level.GetHoles(face) != FarExt::internal::kHole) {
        return Status();
    }
    std::string const name = "face " + std::to_string(face);
    return Status(StatusCode::InvalidArgument, ComponentType::Face, face,
                  0 <= face && face < level.numFaces
                      ? name + " is a hole, which has no surface"
                      : name + " is not one of the " + std::to_string(level.numFaces) +
                            " faces of the base mesh");
}

Status SurfaceFactory::checkFace(Index face) const {
    Status result = checkIsFace(face);
    if (!result.IsOk()) {
        return result;
    }
    Level const &level = _refiner.GetHierarchy().mesh.levels[0];
    for (Index const vert : level.GetFaceVertices(face)) {
        if (isAtFreeBoundary(level, vert)) {
            return Status(StatusCode::Unsupported, ComponentType::Face, face,
                          "face " + std::to_string(face) + " has vertex " + std::to_string(vert) +
                              " on a boundary that VTX_BOUNDARY_NONE leaves without a limit");
        }
    }
    return result;
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
    Status result = checkIsFace(face);
    if (!result.IsOk()) {
        surface->Clear();
        return FarExt::internal::Report(result, status);
    }
    FarExt::internal::Hierarchy const &hierarchy = _refiner.GetHierarchy();
    FVarChannel const *const values =
        channel < 0 ? nullptr : &hierarchy.channels[std::size_t(channel)];
    Level const &level = hierarchy.GetMesh(channel).levels[0];
    Index const levelFace = values ? values->levels[0].valueFaces[face] : face;
    std::vector<VertexMark> const &marks = _marks.begin()[channel + 1];
    int const size = level.GetFaceSize(levelFace);
    auto const setType = [&](internal::CellType const &type, int numPoints) {
        if (surface->_types != _types) {
            surface->_types = _types;
        }
        surface->_type = &type;
        surface->_numControlPoints = numPoints;
        surface->_points.resize(std::size_t(numPoints) + 2 * std::size_t(size));
        surface->_parameterization = Parameterization(size);
    };

    internal::LatticeWalks::Entry const *const lattice = _lattices->Find(size, interpolation);
    bool isInLattice = false;
    if (lattice) {
        setType(*lattice->type, lattice->walk.GetNumPoints());
        Index *const points = surface->_points.data();
        isInLattice = lattice->walk.Gather(level, marks, levelFace, points,
                                           points + surface->_numControlPoints);
    }
    if (!isInLattice) {
        surface->Clear();
        result = checkFace(face);
        if (!result.IsOk()) {
            return FarExt::internal::Report(result, status);
        }
        std::vector<Index> points;
        internal::CellType const &type = findType(
            level, marks, levelFace,
            {_refiner.GetSchemeOptions(),
             FarExt::internal::GetStepsToLimit(_refiner.GetHexSchemeOptions()), interpolation},
            points);
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
        _lattices->Add(type, interpolation);
        setType(type, int(points.size()));
        std::copy(points.begin(), points.end(), surface->_points.begin());
        FindBaseCellTurns(level, levelFace, surface->_points.data() + points.size());
    }
    if (values) {
        std::for_each_n(surface->_points.begin(), surface->_numControlPoints,
                        [&](Index &point) { point = values->valuesOfVertices[point]; });
    }
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

// SPDX-License-Identifier: Apache-2.0
#include "surfaceFactory.h"

#include "cell/baseType.h"
#include "cell/facePatches.h"
#include "cell/typeCache.h"

#include "far_ext/limit/limitRows.h"
#include "far_ext/stencil/interpolationMode.h"
#include "far_ext/vtr/report.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

namespace OpenSubdivHex::BfrExt {

using FarExt::CallStatus;
using FarExt::ComponentType;
using FarExt::Interpolation;
using FarExt::StatusCode;
using FarExt::SurfaceFaces;
using FarExt::internal::CellPatch;
using FarExt::internal::FVarChannel;
using FarExt::internal::Level;

namespace {

// Interpolations of data of vertices.
constexpr int kNumInterpolations = 2;

// Vertices with fewer faces have limit stencils, whatever their features.
constexpr int kManyFaces = 64;

bool isAtFreeBoundary(Level const &level, Far::Index vert) {
    Far::ConstIndexArray const edges = level.GetVertexEdges(vert);
    return std::any_of(edges.begin(), edges.end(), [&](Far::Index edge) {
        return level.edgeFaces[edge][1] == FarExt::internal::kFreeBoundary;
    });
}

// Which of the vertices of a face has so many faces that it may have no limit stencil; as many as there are: none.
int findVertexOfManyFaces(SurfaceFaces const &faces, Far::Index face) {
    int const size = faces.GetShape(face).size;
    int local = 0;
    while (local < size &&
           faces.GetLevel().GetNumVertexFaces(faces.GetVertex(face, local)) < kManyFaces) {
        ++local;
    }
    return local;
}

internal::CellRules getRules(FarExt::TopologyRefiner const &refiner, Interpolation interpolation) {
    return {refiner.GetSchemeOptions(),
            FarExt::internal::GetStepsToLimit(refiner.GetHexSchemeOptions()), interpolation};
}

std::shared_ptr<internal::TypeCache> getCache(SurfaceFactory::Options const &options) {
    SurfaceFactoryCache own;
    return (options.GetExternalCache() ? *options.GetExternalCache() : own).GetTypes();
}

} // namespace

SurfaceFactoryCache::SurfaceFactoryCache(std::size_t maxMemory)
    : _types(std::make_shared<internal::TypeCache>(maxMemory)) {}

SurfaceFactoryCache::~SurfaceFactoryCache() = default;

std::size_t SurfaceFactoryCache::GetMaxMemory() const { return _types->GetMaxMemory(); }

std::size_t SurfaceFactoryCache::GetMemory() const { return _types->GetMemory(); }

std::size_t SurfaceFactoryCache::GetNumTypes() const { return _types->GetNumTypes(); }

SurfaceFactory::SurfaceFactory(FarExt::TopologyRefiner const &refiner, Options options)
    : _refiner(refiner), _level(refiner.GetLevel(refiner.GetHexSchemeOptions().GetSurfaceLevel())),
      _faces(_level.GetLevel()), _numRefinements(refiner.GetNumRefinements()), _options(options),
      _cache(getCache(options)) {
    FarExt::internal::Hierarchy const &hierarchy = refiner.GetHierarchy();
    for (int channel = -1; channel < refiner.GetNumFVarChannels(); ++channel) {
        _walks.push_back(std::make_unique<internal::FaceWalk>(
            hierarchy.GetMesh(channel).levels[std::size_t(_level.GetDepth())]));
    }
}

// Some types of the cache, with the faces that are kept of them.  Surfaces own it.
struct SurfaceFactory::Types {
    Types(SurfaceFactory const &factory, std::shared_ptr<internal::CellTypes> ofCache)
        : cellTypes(std::move(ofCache)),
          kept(factory.GetNumFaces(),
               std::size_t(kNumInterpolations + factory.GetNumFVarChannels()),
               factory._cache->GetMaxMemory() / 4, cellTypes->GetMemory()) {
        for (Interpolation const interpolation : {Interpolation::Vertex, Interpolation::Varying}) {
            plain[std::size_t(interpolation)] =
                &cellTypes->GetPlainFaces(getRules(factory._refiner, interpolation));
        }
    }

    std::shared_ptr<internal::CellTypes> const cellTypes;
    std::array<internal::PlainFaceTypes *, kNumInterpolations> plain{}; // by interpolation
    // The faces that are kept: of the mesh, by interpolation, and then of each channel.
    internal::KeptFaces<internal::BaseType> mutable kept;
};

// Returns the types that the cache has now: new ones when the ones before are full.
auto SurfaceFactory::getTypes() const -> std::shared_ptr<Types const> {
    std::shared_ptr<Types const> before; // goes without the lock
    std::lock_guard<std::mutex> const lock(_mutex);
    if (!_types || _cache->IsFull(*_types->cellTypes)) {
        before = std::move(_types);
        _types = std::make_shared<Types const>(*this, _cache->Get());
        _currentTypes.store(_types.get(), std::memory_order_release);
    }
    return _types;
}

SurfaceFactory::~SurfaceFactory() = default;

int SurfaceFactory::getPatchLevel(internal::BaseType const &type) const {
    int const level =
        type.IsSharp() ? _options.GetApproxLevelSharp() : _options.GetApproxLevelSmooth();
    return std::clamp(level, internal::kFirstPatchLevel, internal::kLastPatchLevel);
}

std::unique_ptr<SurfaceFactory> SurfaceFactory::Create(FarExt::TopologyRefiner const &refiner,
                                                       Options options, CallStatus *status) {
    FarExt::HexSchemeOptions const schemeOptions = refiner.GetHexSchemeOptions();
    int const level = schemeOptions.GetSurfaceLevel();
    CallStatus const result =
        level <= refiner.GetMaxLevel()
            ? FarExt::internal::CheckLimitLevel(refiner.GetHierarchy(), schemeOptions, level)
            : CallStatus(StatusCode::InvalidArgument, ComponentType::Level, level,
                         "the refiner is not refined to level " + std::to_string(level) +
                             ", whose faces have the surfaces behind a first step");
    if (!FarExt::internal::Report(result, status)) {
        return nullptr;
    }
    return std::unique_ptr<SurfaceFactory>(new SurfaceFactory(refiner, options));
}

// Level 0 stays.
bool SurfaceFactory::hasRefinedAgain() const {
    return _level.GetDepth() > 0 && _refiner.GetNumRefinements() != _numRefinements;
}

bool SurfaceFactory::isFace(Index face) const {
    return 0 <= face && face < GetNumFaces() && !hasRefinedAgain() && !_faces.IsHole(face);
}

CallStatus SurfaceFactory::checkIsFace(Index face) const {
    if (isFace(face)) {
        return CallStatus();
    }
    if (hasRefinedAgain()) {
        return FarExt::internal::Failure(
            StatusCode::InvalidArgument,
            "the refiner has refined again since the factory was made");
    }
    bool const isHole = 0 <= face && face < GetNumFaces();
    std::string const name = "face " + std::to_string(face);
    return CallStatus(StatusCode::InvalidArgument, ComponentType::Face, face,
                      isHole ? name + " is a hole, which has no surface"
                             : name + " is not one of the " + std::to_string(GetNumFaces()) +
                                   " faces of level " + std::to_string(_level.GetDepth()));
}

CallStatus SurfaceFactory::CheckFace(Index face) const {
    CallStatus result = checkIsFace(face);
    if (!result.IsOk()) {
        return result;
    }
    for (int local = 0; local < _faces.GetShape(face).size; ++local) {
        Index const vert = _faces.GetVertex(face, local);
        if (_walks.front()->IsAtFeature(vert) && isAtFreeBoundary(_level.GetLevel(), vert)) {
            return CallStatus(StatusCode::Unsupported, ComponentType::Face, face,
                              "face " + std::to_string(face) + " has vertex " +
                                  std::to_string(vert) +
                                  " on a boundary that VTX_BOUNDARY_NONE leaves without a limit");
        }
    }
    return checkCrowd(face, -1, face);
}

// Returns the number of a base face in the mesh (channel -1), or in the value mesh of a channel.
Far::Index SurfaceFactory::getOwnFace(Index face, int channel) const {
    if (channel < 0) {
        return face;
    }
    FVarChannel const &values = _refiner.GetHierarchy().channels[std::size_t(channel)];
    auto const [levelFace, half] = _faces.GetLevelFace(face);
    auto const [valueFace, valueHalf] =
        values.levels[std::size_t(_level.GetDepth())].GetValueCell({levelFace, half});
    return SurfaceFaces(_walks.begin()[channel + 1]->GetLevel()).GetFace({valueFace, valueHalf});
}

// Whether the patch of a face, of the mesh (channel -1) or of a channel, is not too large.
CallStatus SurfaceFactory::checkCrowd(Index face, int channel, Index ownFace) const {
    internal::FaceWalk const &walk = *_walks.begin()[channel + 1];
    internal::FaceWalk::Crowd const *const crowd =
        walk.FindCrowd(SurfaceFaces(walk.GetLevel()).GetLevelFace(ownFace).face);
    if (!crowd) {
        return CallStatus();
    }
    auto const str = [](int number) { return std::to_string(number); };
    bool const isFace = crowd->face != Far::INDEX_INVALID;
    std::string const prefix = "face " + str(face) + " has no limit surface";
    std::string const suffix =
        ", more than the " + str(crowd->maxSize) + " up to which surfaces are made";
    if (channel >= 0) {
        return CallStatus(StatusCode::Unsupported, ComponentType::Face, face,
                          prefix + " of channel " + str(channel) + ": " + str(crowd->size) +
                              (isFace ? " values are around one face" : " faces share one value") +
                              suffix);
    }
    return isFace ? CallStatus(StatusCode::Unsupported, ComponentType::Face, crowd->face,
                               prefix + ": face " + str(crowd->face) + " has " + str(crowd->size) +
                                   " vertices" + suffix)
                  : CallStatus(StatusCode::Unsupported, ComponentType::Vertex, crowd->vert,
                               prefix + ": vertex " + str(crowd->vert) + " has " +
                                   str(crowd->size) + " faces" + suffix);
}

bool SurfaceFactory::FaceHasLimitSurface(Index face, CallStatus *status) const {
    CallStatus result = CheckFace(face);
    if (result.IsOk() && findVertexOfManyFaces(_faces, face) < _faces.GetShape(face).size) {
        std::vector<Index> points;
        findType(*_cache->Get(), -1, face, face, Interpolation::Vertex, points, result);
    }
    bool const hasSurface = result.IsOk();
    if (status) {
        *status = std::move(result);
    }
    return hasSurface;
}

Parameterization SurfaceFactory::GetFaceParameterization(Index face) const {
    return Parameterization(_faces.GetShape(face));
}

// The type of a face that is not plain, from all of its patch; null, and a status, where it has no limit.
internal::CellType const *SurfaceFactory::findType(internal::CellTypes &types, int channel,
                                                   Index ownFace, Index face,
                                                   Interpolation interpolation,
                                                   std::vector<Index> &points,
                                                   CallStatus &status) const {
    status = CheckFace(face);
    if (status.IsOk() && channel >= 0) {
        status = checkCrowd(face, channel, ownFace);
    }
    if (!status.IsOk()) {
        return nullptr;
    }
    SurfaceFaces const faces(_walks.begin()[channel + 1]->GetLevel());
    CellPatch cell;
    internal::CellRules const rules = getRules(_refiner, interpolation);
    GatherBaseCell(faces, ownFace, rules.sdcOptions, cell);
    std::size_t const numPoints = cell.patch.sources.size();
    points.assign(cell.patch.sources.begin(), cell.patch.sources.end());
    internal::CellType const &type = types.Find(cell, rules);
    int const size = faces.GetShape(ownFace).size;
    int const withManyFaces = findVertexOfManyFaces(faces, ownFace);
    if (withManyFaces < size && !type.HasCorners()) {
        Index const vert = _faces.GetVertex(face, withManyFaces);
        status = CallStatus(StatusCode::Unsupported, ComponentType::Vertex, vert,
                            "the limit of face " + std::to_string(face) + " at vertex " +
                                std::to_string(vert) +
                                " cannot be computed: the steps around it do not converge");
        return nullptr;
    }
    points.resize(numPoints + 2 * std::size_t(size));
    FarExt::internal::FindBaseCellTurns(faces, ownFace, points.data() + numPoints);
    return &type;
}

// A thread's means to make faces; their memory is kept for the next face.
struct SurfaceFactory::FaceMaker {
    internal::PlainFaceGatherer gatherer;
    std::vector<Index> points; // of a face that is not plain
    std::vector<std::byte> bytes;
};

// Makes what the surface of a face is made of, of the bytes; null, and a status, where it has none.
internal::BaseFace const *SurfaceFactory::makeFace(Types const &types, Index face,
                                                   Interpolation interpolation, int channel,
                                                   FaceMaker &maker, CallStatus &status) const {
    if (!isFace(face)) {
        status = checkIsFace(face);
        return nullptr;
    }
    FarExt::internal::Hierarchy const &hierarchy = _refiner.GetHierarchy();
    FVarChannel const *const values =
        channel < 0 ? nullptr : &hierarchy.channels[std::size_t(channel)];
    Index const ownFace = getOwnFace(face, channel);
    int const size = _faces.GetShape(face).size;
    internal::FacePoints<internal::BaseType> points(maker.bytes);
    internal::BaseType type;
    if (internal::PlainFaceType const *const plain =
            _faces.IsHalfOfCut(face)
                ? nullptr
                : maker.gatherer.Find(*types.plain[std::size_t(interpolation)],
                                      *_walks.begin()[channel + 1], ownFace, points)) {
        type = internal::BaseType(*plain);
    } else if (internal::CellType const *const cellType = findType(
                   *types.cellTypes, channel, ownFace, face, interpolation, maker.points, status)) {
        type = internal::BaseType(*cellType);
        points.resize(maker.points.size());
        std::copy(maker.points.begin(), maker.points.end(), points.data());
    } else {
        return nullptr;
    }
    // Vertices of the value mesh of a later level are its values.
    if (values && _level.GetDepth() == 0) {
        std::for_each_n(points.data(), int(points.size()) - 2 * size,
                        [&](Index &point) { point = values->valuesOfVertices[point]; });
    }
    return &points.Make(type, size);
}

template <typename REAL>
CallStatus SurfaceFactory::TryInit(Index face, Interpolation interpolation, int channel,
                                   Surface<REAL> &surface) const {
    // A surface that has these types already keeps them: most do, and no lock is taken.
    auto const *types = static_cast<Types const *>(surface._owner.get());
    std::shared_ptr<Types const> owner;
    if (!types || types != _currentTypes.load(std::memory_order_acquire) ||
        _cache->IsFull(*types->cellTypes)) {
        owner = getTypes();
        types = owner.get();
    }
    auto const kind = std::size_t(channel < 0 ? int(interpolation) : kNumInterpolations + channel);
    internal::BaseFace const *const kept =
        hasRefinedAgain() ? nullptr : types->kept.Find(kind, face);
    if (kept) {
        set(*kept, true, owner, surface);
        return CallStatus();
    }
    // Where memory runs out, the surface stays as it was.
    static thread_local FaceMaker maker;
    CallStatus status;
    internal::BaseFace const *const own =
        makeFace(*types, face, interpolation, channel, maker, status);
    if (!own) {
        surface.Clear();
    } else if (internal::BaseFace const *const added = types->kept.Add(kind, face, *own)) {
        set(*added, true, owner, surface);
    } else {
        surface._ownFace.swap(maker.bytes);
        set(*own, false, owner, surface);
    }
    return status;
}

// Makes the surface that of a face, which is kept or is its own; a null owner: it has that already.
template <typename REAL>
void SurfaceFactory::set(internal::BaseFace const &face, bool isKept,
                         std::shared_ptr<Types const> &owner, Surface<REAL> &surface) const {
    if (owner) {
        surface._owner = std::move(owner);
    }
    surface._keptFace = isKept ? &face : nullptr;
    surface._patches = {};
    surface._patchLevel = getPatchLevel(face.type);
    surface._numControlPoints = face.numPoints;
    FarExt::FaceShape const shape = face.type.GetShape(face.size);
    if (surface._parameterization.GetFaceShape() != shape) { // mostly that of the face before
        surface._parameterization = Parameterization(shape);
    }
}

template <typename REAL>
bool SurfaceFactory::InitVertexSurface(Index face, Surface<REAL> *surface,
                                       CallStatus *status) const {
    return FarExt::internal::Report(TryInit(face, Interpolation::Vertex, -1, *surface), status);
}

template <typename REAL>
bool SurfaceFactory::InitVaryingSurface(Index face, Surface<REAL> *surface,
                                        CallStatus *status) const {
    return FarExt::internal::Report(TryInit(face, Interpolation::Varying, -1, *surface), status);
}

template <typename REAL>
bool SurfaceFactory::InitFaceVaryingSurface(Index face, Surface<REAL> *surface, FVarID channel,
                                            CallStatus *status) const {
    CallStatus const result = FarExt::internal::CheckChannel(channel, GetNumFVarChannels());
    if (!result.IsOk()) {
        surface->Clear();
        return FarExt::internal::Report(result, status);
    }
    return FarExt::internal::Report(
        TryInit(face, FarExt::internal::GetChannelInterpolation(_refiner, channel), channel,
                *surface),
        status);
}

template <typename REAL>
bool SurfaceFactory::InitSurfaces(Index face, Surface<REAL> *vertex, Surface<REAL> *channels,
                                  FVarID const ids[], int numIds, Surface<REAL> *varying,
                                  CallStatus *status) const {
    FVarID const defaultId = _options.GetDefaultFVarID();
    if (!ids && numIds == 0) {
        ids = &defaultId;
        numIds = 1;
    }
    int const numChannels = channels ? numIds : 0;
    CallStatus result;
    auto const initNext = [&](Interpolation interpolation, int channel, Surface<REAL> *surface) {
        if (surface && result.IsOk()) {
            result = TryInit(face, interpolation, channel, *surface);
        }
    };
    initNext(Interpolation::Vertex, -1, vertex);
    initNext(Interpolation::Varying, -1, varying);
    for (int i = 0; i < numChannels && result.IsOk(); ++i) {
        FVarID const channel = ids ? ids[i] : i;
        result = FarExt::internal::CheckChannel(channel, GetNumFVarChannels());
        if (result.IsOk()) {
            initNext(FarExt::internal::GetChannelInterpolation(_refiner, channel), channel,
                     &channels[i]);
        }
    }
    if (!result.IsOk()) {
        for (Surface<REAL> *const surface : {vertex, varying}) {
            if (surface) {
                surface->Clear();
            }
        }
        std::for_each_n(channels, numChannels, [](Surface<REAL> &surface) { surface.Clear(); });
    }
    return FarExt::internal::Report(result, status);
}

template CallStatus SurfaceFactory::TryInit(Index, Interpolation, int, Surface<float> &) const;
template CallStatus SurfaceFactory::TryInit(Index, Interpolation, int, Surface<double> &) const;
template bool SurfaceFactory::InitVertexSurface(Index, Surface<float> *, CallStatus *) const;
template bool SurfaceFactory::InitVertexSurface(Index, Surface<double> *, CallStatus *) const;
template bool SurfaceFactory::InitVaryingSurface(Index, Surface<float> *, CallStatus *) const;
template bool SurfaceFactory::InitVaryingSurface(Index, Surface<double> *, CallStatus *) const;
template bool SurfaceFactory::InitFaceVaryingSurface(Index, Surface<float> *, FVarID,
                                                     CallStatus *) const;
template bool SurfaceFactory::InitFaceVaryingSurface(Index, Surface<double> *, FVarID,
                                                     CallStatus *) const;
template bool SurfaceFactory::InitSurfaces(Index, Surface<float> *, Surface<float> *,
                                           FVarID const[], int, Surface<float> *,
                                           CallStatus *) const;
template bool SurfaceFactory::InitSurfaces(Index, Surface<double> *, Surface<double> *,
                                           FVarID const[], int, Surface<double> *,
                                           CallStatus *) const;

} // namespace OpenSubdivHex::BfrExt

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_SURFACE_FACTORY_H
#define OPENSUBDIVHEX_BFR_EXT_SURFACE_FACTORY_H

#include "surface.h"

#include "far_ext/surfaceFaces.h"
#include "far_ext/topologyRefiner.h"

#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace OpenSubdivHex::FarExt {
enum class Interpolation;
} // namespace OpenSubdivHex::FarExt

namespace OpenSubdivHex::BfrExt {

namespace internal {
class CellType;
class CellTypes;
class FaceWalk;
class TypeCache;
} // namespace internal

/// \brief Keeps the weights that surfaces of faces that look alike share, as Bfr::SurfaceFactoryCache.
///
/// Faces whose neighbourhoods have the same topology and tags have one *type*, in one mesh or in several, with any
/// options.  The weights of a type are found once.  Every SurfaceFactory has a cache of its own unless it is given one:
///
/// \code
///     BfrExt::SurfaceFactoryCache cache; // for several meshes
///     BfrExt::SurfaceFactory::Options options;
///     options.SetExternalCache(&cache);
/// \endcode
///
/// Any number of threads and of factories may share a cache.  It grows by some hundred bytes with each type
/// of faces that it meets.  When a surface of the type is first evaluated, or at once where a feature is
/// near, it grows by some kilobytes for it and for each type of cell that evaluation goes through.  It also keeps the
/// weights of evaluated tessellations, for types of faces or of cells.
///
/// **Memory**, with what factories keep of faces, is bounded by the constructor's argument.  When half of it is taken, the
/// cache forgets all types, and finds those that are asked for again: results keep their bits.  The other half is for the
/// generation of types before: surfaces keep their type until they are initialised again or destroyed.  GetMemory() exceeds
/// the bound if surfaces of several generations live at once, or if one generation needs more.  If a model has more types
/// than memory holds, types are found again in each frame, in some milliseconds each.
///
/// Surfaces keep what they need of the cache, so that it may go before them.
class OPENSUBDIVHEX_API SurfaceFactoryCache {
public:
    /// \param maxMemory  bytes that it takes at most; by default a gibibyte
    explicit SurfaceFactoryCache(std::size_t maxMemory = std::size_t(1) << 30);
    ~SurfaceFactoryCache();

    SurfaceFactoryCache(SurfaceFactoryCache const &) = delete;
    SurfaceFactoryCache &operator=(SurfaceFactoryCache const &) = delete;

    /// The number that was given.
    std::size_t GetMaxMemory() const;
    /// Bytes that types take, with those that surfaces have kept, within some percent.
    std::size_t GetMemory() const;
    /// Types that are there: those of faces, and those of the cells that evaluation went through.
    std::size_t GetNumTypes() const;

    /// The types, for the classes of this library.
    std::shared_ptr<internal::TypeCache> const &GetTypes() const { return _types; }

private:
    std::shared_ptr<internal::TypeCache> _types;
};

/// \brief Makes the surfaces of base faces, as Bfr::RefinerSurfaceFactory.
///
/// \code
///     auto factory = BfrExt::SurfaceFactory::Create(*refiner); // no refinement needed
///     BfrExt::Surface<float> surface;
///     factory->InitVertexSurface(face, &surface);
/// \endcode
///
/// A factory takes level 0 of a refiner, and refers to it.  Sharpness, corners, boundaries, non-manifold parts and
/// face-varying seams are as in refinement.
///
/// **Behind a first step** (FarExt::FirstStep) level 1 takes the place of level 0: base faces, edges and
/// vertices in BfrExt are then those of this *surface level*
/// (FarExt::HexSchemeOptions::GetSurfaceLevel()), GetLevel() says which, and control points are its
/// vertices and values.  The refiner has to be refined so far, with full topology, and stays as it is;
/// its evaluators make the control points.  GetFaceBaseFace() leads to the faces of level 0, with their materials.
/// A face of the surface level that an infinitely sharp crease crosses is two base faces: GetFaces() has the numbers of
/// base faces and edges.
///
/// Holes have no surface, nor have the few faces that FaceHasLimitSurface() names and, with VTX_BOUNDARY_NONE, faces at a
/// boundary, because such a boundary has no limit.
///
/// **Memory.** The first surface of a mesh, or of a channel, takes 8 bytes for each corner and each vertex of the mesh.  When a face gets its
/// second surface, about 200 bytes are kept for it, in up to a fourth of the cache: further surfaces of the face, as in the
/// frames of an animation, are a look-up.  Faces beyond it are gathered again for each surface.
///
/// Any number of threads may call its functions at once.  std::bad_alloc passes through.
class OPENSUBDIVHEX_API SurfaceFactory {
public:
    /// A face.
    using Index = Far::Index;
    /// A face-varying channel.
    using FVarID = int;

    /// \brief Options of all surfaces of a factory, as in Bfr.
    class Options {
    public:
        /// Channel 0, and a cache of its own.
        Options() = default;

        /// Sets the channel of InitFaceVaryingSurface() without one.
        Options &SetDefaultFVarID(FVarID id) {
            _defaultFVarID = id;
            return *this;
        }
        /// The channel that was set.
        FVarID GetDefaultFVarID() const { return _defaultFVarID; }

        /// Sets a cache to share, which must live as long as the factory; null: one of its own.
        Options &SetExternalCache(SurfaceFactoryCache *cache) {
            _externalCache = cache;
            return *this;
        }
        /// The cache that was set.
        SurfaceFactoryCache *GetExternalCache() const { return _externalCache; }

        /// Sets the level of the patches of Surface::Evaluate() at (u, v), 2 to 6: each level has about an eighth of the
        /// error, and four times the weights, which types of faces share.
        Options &SetApproxLevelSmooth(int level) {
            _approxLevelSmooth = level;
            return *this;
        }
        /// The level that was set; by default 3.
        int GetApproxLevelSmooth() const { return _approxLevelSmooth; }
        /// Sets this level for faces whose control points include a sharp or semi-sharp edge, a corner or a boundary.  If the
        /// two levels differ, faces of both kinds agree about their edge within the error of the coarser one.
        Options &SetApproxLevelSharp(int level) {
            _approxLevelSharp = level;
            return *this;
        }
        /// The level that was set; by default 3.
        int GetApproxLevelSharp() const { return _approxLevelSharp; }

    private:
        FVarID _defaultFVarID = 0;
        SurfaceFactoryCache *_externalCache = nullptr;
        int _approxLevelSmooth = 3;
        int _approxLevelSharp = 3;
    };

    /// \brief Makes a factory for \p refiner, which must live as long.
    ///
    /// \return  null on failure: Unsupported where levels are not made by hexagonal steps, which alone
    ///          have limits; InvalidArgument where the surface level is not there, or lacks full
    ///          topology (FarExt::TopologyRefiner::UniformOptions)
    static std::unique_ptr<SurfaceFactory> Create(FarExt::TopologyRefiner const &refiner,
                                                  Options options,
                                                  FarExt::CallStatus *status = nullptr);
    /// Overload with default options.
    static std::unique_ptr<SurfaceFactory> Create(FarExt::TopologyRefiner const &refiner,
                                                  FarExt::CallStatus *status = nullptr) {
        return Create(refiner, Options(), status);
    }
    ~SurfaceFactory();

    SurfaceFactory(SurfaceFactory const &) = delete;
    SurfaceFactory &operator=(SurfaceFactory const &) = delete;

    /// The refiner that was given.
    FarExt::TopologyRefiner const &GetMesh() const { return _refiner; }
    /// Its options of boundaries and creases.
    OpenSubdiv::Sdc::Options GetSchemeOptions() const { return _refiner.GetSchemeOptions(); }
    /// The surface level, whose faces have the surfaces: level 0, or level 1 behind a first step.
    FarExt::TopologyLevel const &GetLevel() const { return _level; }
    /// Base faces and edges: the faces and edges of GetLevel(), where faces that a crease cuts are two.
    FarExt::SurfaceFaces const &GetFaces() const { return _faces; }
    /// Base faces.
    int GetNumFaces() const { return _faces.GetNumFaces(); }
    /// The face of level 0 that a base face lies in: FarExt::TopologyLevel::GetFaceBaseFace().
    Index GetFaceBaseFace(Index face) const {
        FarExt::SurfaceFaces::LevelFace const levelFace = _faces.GetLevelFace(face);
        return _level.GetFaceBaseFace(levelFace.face, levelFace.half);
    }
    /// Face-varying channels.
    int GetNumFVarChannels() const { return _refiner.GetNumFVarChannels(); }

    /// \brief Finds the base face, and (u, v) in it, of a place on the control mesh.
    ///
    /// Behind FarExt::FirstStep::Truncate this leads to the surface level; without a first step the place itself is returned.
    /// A truncation cuts a third off each end of an edge.  What is left of a face of level 0 becomes its F-face, and each corner a
    /// part of the V-face of its vertex.  Triangles are mapped to triangles: from edges to the centre or, in a corner, the vertex.
    /// A place on an edge is the same point of the surface from both faces.  A vertex is its V-vertex, or the centre of its V-face.
    ///
    /// \param controlFace  face of level 0
    /// \param controlUv    u and v in it, as in Bfr::Parameterization; inside the face
    /// \param face         gets the base face, which may be a hole
    /// \param uv           gets u and v in it
    /// \return             false, with nothing written: InvalidArgument for a face out of range, for u or v that is not finite,
    ///                     or for a refiner that refined again behind a first step; Unsupported behind
    ///                     FarExt::FirstStep::TriHex
    template <typename REAL>
    bool FindSurfacePlace(Index controlFace, REAL const controlUv[2], Index *face, REAL uv[2],
                          FarExt::CallStatus *status = nullptr) const;

    /// \brief Whether a face has a surface.  False is no failure: an error callback (FarExt::SetErrorCallback()) is not called.
    ///
    /// \param status  the reason:
    ///                 - InvalidArgument: a face out of range; a hole; behind a first step, a refiner that has refined
    ///                   again since the factory was made
    ///                 - Unsupported: a face at a boundary with VTX_BOUNDARY_NONE; a face whose surface depends on too many
    ///                   faces.  The status names the vertex of the face, or its neighbour by an edge, with more than 512
    ///                   faces (128 unless all of its edges are alike, then 64 if some of them are semi-sharp), or its face
    ///                   with more than 1,024 vertices.  At a non-manifold vertex that stays, such as a pole that faces name
    ///                   twice, each fan may have 4,096 faces
    bool FaceHasLimitSurface(Index face, FarExt::CallStatus *status = nullptr) const;
    /// As FaceHasLimitSurface(), without the test of vertices of many faces, which takes long.
    FarExt::CallStatus CheckFace(Index face) const;
    /// The parameterization of a face, which is in range.
    Parameterization GetFaceParameterization(Index face) const;

    /// @name Surfaces
    /// \return  false, and \p surface is invalid, where the face has none: with the causes of
    ///          FaceHasLimitSurface(), or InvalidArgument for a channel out of range
    /// @{

    /// For vertex data, whose control points are vertices of GetLevel().
    template <typename REAL>
    bool InitVertexSurface(Index face, Surface<REAL> *surface,
                           FarExt::CallStatus *status = nullptr) const;
    /// For varying data, likewise.
    template <typename REAL>
    bool InitVaryingSurface(Index face, Surface<REAL> *surface,
                            FarExt::CallStatus *status = nullptr) const;
    /// For face-varying data of a channel, whose control points are values of GetLevel().
    template <typename REAL>
    bool InitFaceVaryingSurface(Index face, Surface<REAL> *surface, FVarID channel,
                                FarExt::CallStatus *status = nullptr) const;
    /// Overload for the default channel.
    template <typename REAL>
    bool InitFaceVaryingSurface(Index face, Surface<REAL> *surface,
                                FarExt::CallStatus *status = nullptr) const {
        return InitFaceVaryingSurface(face, surface, _options.GetDefaultFVarID(), status);
    }
    /// \brief Some of these at once, all of which are invalid where one cannot be made.
    ///
    /// \param vertex    for vertex data, or null
    /// \param channels  for face-varying data, one for each of \p ids, or null
    /// \param ids       their channels; null: 0 ... \p numIds - 1, or for no \p numIds the default channel
    /// \param numIds    how many they are
    /// \param varying   for varying data, or null
    template <typename REAL>
    bool InitSurfaces(Index face, Surface<REAL> *vertex, Surface<REAL> *channels,
                      FVarID const ids[] = nullptr, int numIds = 0,
                      Surface<REAL> *varying = nullptr, FarExt::CallStatus *status = nullptr) const;
    /// @}

    /// @name Surfaces of one's own
    /// \return  null, with the same causes, where the face has none
    /// @{

    /// For vertex data.
    template <typename REAL>
    std::unique_ptr<Surface<REAL>> CreateVertexSurface(Index face,
                                                       FarExt::CallStatus *status = nullptr) const {
        auto surface = std::make_unique<Surface<REAL>>();
        return InitVertexSurface(face, surface.get(), status) ? std::move(surface) : nullptr;
    }
    /// For varying data.
    template <typename REAL>
    std::unique_ptr<Surface<REAL>>
    CreateVaryingSurface(Index face, FarExt::CallStatus *status = nullptr) const {
        auto surface = std::make_unique<Surface<REAL>>();
        return InitVaryingSurface(face, surface.get(), status) ? std::move(surface) : nullptr;
    }
    /// For face-varying data of a channel.
    template <typename REAL>
    std::unique_ptr<Surface<REAL>>
    CreateFaceVaryingSurface(Index face, FVarID channel,
                             FarExt::CallStatus *status = nullptr) const {
        auto surface = std::make_unique<Surface<REAL>>();
        return InitFaceVaryingSurface(face, surface.get(), channel, status) ? std::move(surface)
                                                                            : nullptr;
    }
    /// For face-varying data of the default channel.
    template <typename REAL>
    std::unique_ptr<Surface<REAL>>
    CreateFaceVaryingSurface(Index face, FarExt::CallStatus *status = nullptr) const {
        return CreateFaceVaryingSurface<REAL>(face, _options.GetDefaultFVarID(), status);
    }
    /// @}

    /// \brief Makes a surface of any kind of data, without calling an error callback if the face has none.
    ///
    /// \param face           whose surface it is
    /// \param interpolation  how the data are refined
    /// \param channel        of face-varying data, in range; -1: data of vertices
    /// \param surface        is invalid on failure
    template <typename REAL>
    FarExt::CallStatus TryInit(Index face, FarExt::Interpolation interpolation, int channel,
                               Surface<REAL> &surface) const;

private:
    struct FaceMaker;
    struct Types;

    SurfaceFactory(FarExt::TopologyRefiner const &refiner, Options options);

    std::shared_ptr<Types const> getTypes() const;
    int getPatchLevel(internal::BaseType const &type) const;
    bool hasRefinedAgain() const;
    bool isFace(Index face) const;
    FarExt::CallStatus checkIsFace(Index face) const;
    Index getOwnFace(Index face, int channel) const;
    FarExt::CallStatus checkCrowd(Index face, int channel, Index ownFace) const;
    internal::CellType const *findType(internal::CellTypes &types, int channel, Index ownFace,
                                       Index face, FarExt::Interpolation interpolation,
                                       std::vector<Index> &points,
                                       FarExt::CallStatus &status) const;
    internal::KeptFace<internal::BaseType> const *makeFace(Types const &types, Index face,
                                                           FarExt::Interpolation interpolation,
                                                           int channel, FaceMaker &maker,
                                                           FarExt::CallStatus &status) const;
    template <typename REAL>
    void set(internal::KeptFace<internal::BaseType> const &face, bool isKept,
             std::shared_ptr<Types const> &owner, Surface<REAL> &surface) const;

    FarExt::TopologyRefiner const &_refiner;
    FarExt::TopologyLevel const _level;
    FarExt::SurfaceFaces const _faces;
    int const _numRefinements; // of the refiner, when the factory was made
    Options const _options;
    std::shared_ptr<internal::TypeCache> const _cache;
    std::vector<std::unique_ptr<internal::FaceWalk>> _walks; // of the mesh, and of each channel
    mutable std::mutex _mutex;
    mutable std::shared_ptr<Types const> _types; // of which surfaces are made; null: nobody asked
    mutable std::atomic<void const *> _currentTypes{nullptr}; // the same, to compare with
};

} // namespace OpenSubdivHex::BfrExt

#endif

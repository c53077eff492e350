// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_PATCH_STREAM_H
#define OPENSUBDIVHEX_BFR_EXT_PATCH_STREAM_H

#include "cellForest.h"
#include "surfaceFactory.h"

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

namespace OpenSubdivHex::BfrExt {

/// \brief How fine the patches of a stream are: a level of refinement for the inside of each base face
/// and one for each edge of the base mesh, 0 ... LevelTessellation::kLastLevel.
///
/// An edge is named by its number in SurfaceFactory::GetFaces(), whichever face asks: so neighbours fit.
class PatchLevels {
public:
    /// Gives the level of a face, or of an edge.  Called by any thread, by several at once.
    using Function = std::function<int(Far::Index)>;

    /// One level everywhere.
    explicit PatchLevels(int level)
        : _ofFaces([=](Far::Index) { return level; }), _ofEdges(_ofFaces) {}
    /// A level for each face and one for each edge; as arrays, [&](int face) { return levels[face]; }.
    PatchLevels(Function ofFaces, Function ofEdges)
        : _ofFaces(std::move(ofFaces)), _ofEdges(std::move(ofEdges)) {}

    /// The level of the inside of a face.
    int GetFaceLevel(Far::Index face) const { return _ofFaces(face); }
    /// The level of an edge.
    int GetEdgeLevel(Far::Index edge) const { return _ofEdges(edge); }

private:
    Function _ofFaces;
    Function _ofEdges;
};

namespace internal {
class StreamData;
}

/// \brief What the streams of both precisions have in common: options, and the tessellations of patches.
class OPENSUBDIVHEX_API PatchTessellations {
public:
    /// A base face or an edge of the base mesh.
    using Index = Far::Index;

    /// \brief Facets and memory.
    class Options {
    public:
        /// Triangles, no derivatives, and 4 megabytes.
        Options() = default;

        /// Sets the options of facets; strides of coordinates are ignored.
        Options &SetTessellationOptions(LevelTessellation::Options const &options) {
            _tessellationOptions = options;
            return *this;
        }
        /// The options of facets.
        LevelTessellation::Options const &GetTessellationOptions() const {
            return _tessellationOptions;
        }

        /// Sets whether patches have the derivatives of their points: their cross products are normals.
        Options &SetDerivatives(bool hasDerivatives) {
            _hasDerivatives = hasDerivatives;
            return *this;
        }
        /// Whether patches have derivatives.
        bool HasDerivatives() const { return _hasDerivatives; }

        /// \brief Sets the bytes that all tessellations of a time take, over all threads, and making them.
        ///
        /// Patches with the same levels share a tessellation.  If not all tessellations fit, patches that share one are made
        /// in succession, so that few tessellations are made twice.
        ///
        /// Making a tessellation takes about 300 bytes a point: a face may take a fourth of the bytes that are set, or 3
        /// megabytes if these are more (4 with derivatives).  Faces that take more come in sections.  A single cell is never
        /// cut: it has all points that finer edges of the face, or cells beside it, have on its sides.
        ///
        /// The types of faces are not counted: they are in the cache, which has a bound of its own (SurfaceFactoryCache).
        Options &SetMaxMemory(std::size_t bytes) {
            _maxMemory = bytes;
            return *this;
        }
        /// The number that was set.
        std::size_t GetMaxMemory() const { return _maxMemory; }

    private:
        LevelTessellation::Options _tessellationOptions;
        bool _hasDerivatives = false;
        std::size_t _maxMemory = std::size_t(4) << 20;
    };

    /// The number of patches of a face: 1, or its sections.  The face is in range, and its levels or tree are valid.
    int GetNumSections(Index face) const;
    /// The tessellation of such a face as a whole, however much memory it takes.
    LevelTessellation MakeTessellation(Index face) const;
    /// The tessellation of a section, 0 ... GetNumSections(face) - 1, as the patches of the face have it.
    LevelTessellation MakeTessellation(Index face, int section) const;

    /// Takes the face and the tessellation of a patch, as a sink takes a patch.
    using TessellationSink = std::function<bool(Index face, LevelTessellation const &tessellation)>;
    /// \brief Hands out the tessellations of all patches, as PatchStream::Run() makes them, without points: for callers that
    /// must know all patches before the first point.
    ///
    /// \return  as that of PatchStream::Run()
    bool RunTessellations(TessellationSink const &sink, FarExt::CallStatus *status = nullptr) const;

    /// \brief The sections of a face, as polygons in it.
    ///
    /// A *corner* is a vertex of one of these polygons, in the order of the boundary of the section's tessellation
    /// (LevelTessellation::GetVertexPlace()).  Where sections meet, their corners have the same vertex.
    struct SectionPolygons {
        std::vector<int> firstCorners; ///< by section; then their end
        std::vector<int> vertices;     ///< by corner
        /// By vertex: the edge of the face on which it lies, for a vertex of the face the edge that begins there; -1: inside
        /// the face.
        std::vector<int> edges;
        /// By vertex on an edge: the number of its point among those of LevelTessellation::GetEdgeCoords() of the whole
        /// face; -1: it is the vertex of the face.
        std::vector<int> edgePoints;
    };
    /// The sections of a face with more than one (GetNumSections()); empty for other faces.
    SectionPolygons GetSectionPolygons(Index face) const;

    /// The factory that was given.
    SurfaceFactory const &GetFactory() const;
    /// The levels that were given; with a forest: 0.
    PatchLevels const &GetLevels() const;
    /// The forest that was given, or null.
    CellForest const *GetForest() const;
    /// The options that were given.
    Options const &GetOptions() const;

protected:
    /// \param forest  null: levels
    PatchTessellations(SurfaceFactory const &factory, PatchLevels levels, CellForest const *forest,
                       Options const &options);

    std::shared_ptr<internal::StreamData const> _data; ///< never null: copied where it is moved
};

/// \brief Evaluates the surfaces of all base faces in bounded memory: hands each to a *sink* and forgets it.
///
/// \code
///     BfrExt::PatchStream<float> const stream(*factory, BfrExt::PatchLevels(5));
///     stream.Run(positions, 3, [&](BfrExt::PatchStream<float>::Patch const &patch) {
///         return Write(patch.points, patch.tessellation.GetNumCoords()); // false ends the stream
///     });
/// \endcode
///
/// The sink gets a *patch* for each base face that is no hole: a tessellation, its points and, if asked for, derivatives
/// and values of varying and face-varying data.  (Patches of a Far::PatchTable are something else.)
///
/// **Memory** is the sum of Options::SetMaxMemory() and the cache of the factory, with 8 bytes for each corner and vertex of
/// the mesh, and with a thread's own during a call: its patch, and up to 1.2 megabytes for points and for each of the Values.
///
/// A face whose tessellation would take more than a fourth of SetMaxMemory() has a patch for each of its *sections*
/// (LevelTessellation::GetSection()).  Neighbouring sections share the points on their boundaries, as faces do.  Points have
/// the bits that they have in the whole face.  Facets are the same, too, except that a hexagon between two sections comes as
/// two halves where facets are polygons.
///
///  - Two patches that share an edge have the same points on it, to the bit.  Exceptions are those of Surface::Evaluate() of a
///    tessellation.
///  - With a CellForest, patches have the tessellations of its trees: each is made with its patch and forgotten with it.
///  - A patch depends on its face and the options alone, to the bit: not on the number of threads, nor on the other faces of
///    the call.  So several processes may share the faces of a mesh.  Their machines and builds must all use AVX-512 or AVX2
///    with FMA, or all use neither: these fuse products with sums.
///  - Points inside a face are those of Surface::Evaluate(), except for rounding.
///
/// Several threads may call Run() of one stream at once.  std::bad_alloc passes through.
template <typename REAL>
class OPENSUBDIVHEX_API PatchStream : public PatchTessellations {
public:
    /// The size of points and the distance from one to the next.
    using PointDescriptor = typename Surface<REAL>::PointDescriptor;

    /// \brief The patch of a base face, or of a section of it, that a sink gets; valid during the call.
    struct Patch {
        Index face; ///< the base face
        LevelTessellation const
            &tessellation;  ///< the places of the points, and the facets between them
        REAL const *points; ///< tessellation.GetNumCoords() points, without gaps
        int pointSize;      ///< numbers of a point
        /// As many derivatives by u as points, of the same size; null unless options ask for them.
        REAL const *du = nullptr;
        REAL const *dv = nullptr; ///< by v
        /// By number of what Run() was given besides: tessellation.GetNumCoords() values, without gaps.
        REAL const *const *values = nullptr;
    };

    /// \brief Values that patches have in addition to points: varying or face-varying data.
    struct Values {
        /// No channel: varying data.
        static constexpr int kVarying = -1;

        REAL const *values; ///< of SurfaceFactory::GetLevel(), by vertex or by value of the channel
        PointDescriptor desc;   ///< their size, and the distance from one to the next
        int channel = kVarying; ///< of face-varying data
    };

    /// \brief Takes a patch.
    ///
    /// It is called by the threads of the call, several at once, each time with another patch, in any
    /// order.  What it throws ends the stream and passes through.
    ///
    /// \return  false to end the stream: some patches may still come
    using Sink = std::function<bool(Patch const &)>;

    /// A stream of surfaces for vertex data.
    ///
    /// \param factory  makes the surfaces; it must live as long
    /// \param levels   how fine they are
    /// \param options  facets and memory
    PatchStream(SurfaceFactory const &factory, PatchLevels levels,
                Options const &options = Options())
        : PatchTessellations(factory, std::move(levels), nullptr, options) {}

    /// \brief A stream of the cells of trees.
    ///
    /// \param factory  makes the surfaces; it must live as long
    /// \param forest   of the same refiner, after MatchEdges(); it must live as long
    /// \param options  facets and memory
    PatchStream(SurfaceFactory const &factory, CellForest const &forest,
                Options const &options = Options())
        : PatchTessellations(factory, PatchLevels(0), &forest, options) {}
    /// Moving copies. Copies share tessellations.
    PatchStream(PatchStream const &) = default;
    /// \copydoc PatchStream(PatchStream const &)
    PatchStream &operator=(PatchStream const &) = default;
    ~PatchStream() = default;

    /// \brief Hands the patches of all faces to a sink.
    ///
    /// \param meshPoints     of SurfaceFactory::GetLevel()
    /// \param meshPointDesc  their size, and the distance from one to the next
    /// \param sink           takes patches
    /// \param status         Ok if the sink ended the stream
    /// \return               whether all patches were handed out.  Failures before the first patch: InvalidArgument for a
    ///                       level or options that LevelTessellation refuses, or for a forest that is not matched or is of
    ///                       another refiner; Unsupported for a face without a surface (SurfaceFactory) that is no hole.
    ///                       A failure on the way: Unsupported for a vertex without a limit stencil
    bool Run(REAL const meshPoints[], PointDescriptor const &meshPointDesc, Sink const &sink,
             FarExt::CallStatus *status = nullptr) const {
        return Run(meshPoints, meshPointDesc, 0, GetFactory().GetNumFaces(), sink, status);
    }
    /// \brief Overload for faces \p beginFace ... \p endFace - 1: the share of a process.
    ///
    /// \return  false, with InvalidArgument, for a range beyond the faces, too
    bool Run(REAL const meshPoints[], PointDescriptor const &meshPointDesc, Index beginFace,
             Index endFace, Sink const &sink, FarExt::CallStatus *status = nullptr) const {
        return Run(meshPoints, meshPointDesc, {}, beginFace, endFace, sink, status);
    }
    /// \brief Overload with further values.
    ///
    /// \param values  what patches have as Patch::values, in this order
    /// \return        false, with InvalidArgument, for a channel that the mesh does not have, too
    bool Run(REAL const meshPoints[], PointDescriptor const &meshPointDesc,
             std::vector<Values> const &values, Index beginFace, Index endFace, Sink const &sink,
             FarExt::CallStatus *status = nullptr) const;
    /// \brief Overload for a list of faces, in any order: CellForest::FindChangedFaces() has those that a camera changes.
    ///
    /// A face that is listed twice has its patches twice.
    /// \return  false, with InvalidArgument, for a number that is no face, too
    bool Run(REAL const meshPoints[], PointDescriptor const &meshPointDesc,
             std::vector<Values> const &values, std::vector<Index> const &faces, Sink const &sink,
             FarExt::CallStatus *status = nullptr) const;
};

extern template class PatchStream<float>;
extern template class PatchStream<double>;

} // namespace OpenSubdivHex::BfrExt

#endif

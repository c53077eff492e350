// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_PATCH_TABLE_FACTORY_H
#define OPENSUBDIVHEX_FAR_EXT_PATCH_TABLE_FACTORY_H

#include "indexing.h"
#include "topologyRefiner.h"

#include <opensubdiv/far/patchTable.h>
#include <opensubdiv/far/stencilTable.h>

#include <array>
#include <memory>
#include <vector>

namespace OpenSubdivHex::FarExt {

/// \brief Makes a Far::PatchTable of the limit surface, for OpenSubdiv's evaluators, patch maps and tessellation shaders.
///
/// \code
///     FarExt::PatchTableFactory::Options options(2); // the faces of level 2
///     refiner->RefineUniform(options.GetRefineUniformOptions());
///     auto table = FarExt::PatchTableFactory::Create(*refiner, options);
/// \endcode
///
/// All patches are bicubic Gregory patches of 20 points (GREGORY_BASIS), in one array: one for each half
/// of a hexagon, one for each quad, and in other faces one for each corner, a *kite* with that corner,
/// the middle of the next side, the centre and the middle of the side before.  They are ordered by level, face,
/// half (as in kHexagonHalves) and corner; PatchMap says where they lie.  Holes have none.
///
/// **Points.** The corners of patches lie on the limit surface.  Between them patches are close to it: the
/// guide has numbers.  Patches that meet share the points and tangent planes of their common side.  Exceptions: a side of a
/// kite that is half of its neighbour's has points of its own; at sharp edges each side has its own tangent planes.
///
/// The 20 points of every patch are local points, and the indices of patches count the control vertices
/// first: point i of the local points has the index GetLevel(0).GetNumVertices() + i.  So a buffer has the control
/// vertices and, behind them, the results of Far::PatchTable::GetLocalPointStencilTable().  If other vertices lie
/// between, as with AppendLocalPointStencilTable(), give evaluators a descriptor whose offset is larger by as many elements.
///
/// **Face-varying channels** have a patch for each patch of the surface, with the same s and t: bilinear ones (QUADS)
/// or Gregory patches of the channel's values.  Gregory patches are close to the limit of the channel, as those of the surface
/// are to the limit surface; a seam is a boundary on both sides.  Points of channels are local points, too: indices count the
/// values of level 0 first, then the points of CreateLocalPointFaceVaryingStencilTable().  The patch table contains the
/// stencils of Gregory patches (Far::PatchTable::GetLocalPointFaceVaryingStencilTable()); a Far::PatchTable never contains
/// those of QUADS.
///
/// **Parameters.** Each patch is a face of its own, with the index of the patch, in the terms of
/// Far::PatchParam and Far::PatchMap: s and t are those of the patch, from 0 to 1.
///
/// Several threads may call it at once, also for the same refiner.  std::bad_alloc passes through.
class OPENSUBDIVHEX_API PatchTableFactory {
public:
    /// \brief The fields of Far::PatchTableFactory::Options that have a meaning here, and those for patches of
    /// several levels.
    struct Options {
        /// Patches of the faces of level \p isolationLevel alone, and the defaults.
        Options(int isolationLevel) : maxIsolationLevel(isolationLevel) {}

        /// The finest level of patches: that of the surface (HexSchemeOptions::GetSurfaceLevel()) or
        /// more, and less than refiner.GetMaxLevel().
        int maxIsolationLevel;
        /// \brief The coarsest level of patches; -1: maxIsolationLevel, so that all are of one level.
        ///
        /// From this level on faces are refined by \p tolerance.  If \p tolerance is 0, faces are refined that are no hexagons
        /// or have an irregular vertex (of other than three faces) and, up to sharpIsolationLevel, faces with a sharp edge or
        /// vertex.  A face is refined as a whole, if need be with the face beyond an edge: no corner of a patch lies inside
        /// a side of another patch, so that patches of different levels fit.
        int minIsolationLevel = -1;
        /// The finest level of faces with a sharp edge or vertex; -1: maxIsolationLevel.
        int sharpIsolationLevel = -1;
        /// \brief The largest distance of patches from the limit surface, in the units of \p positions; 0: the levels above
        /// decide.
        ///
        /// The distance is measured at some 20 points of each patch, at right angles to it.  Not measured are patches of
        /// maxIsolationLevel, and those of faces that are no hexagons and no quads, which are refined up to that level.
        double tolerance = 0;
        float const *positions =
            nullptr; ///< x, y, z of each control vertex, if there is a tolerance
        /// \brief x, y, z of an eye, or null.  With an eye the tolerance grows with the distance from it, and is \p tolerance
        /// at distance 1.
        ///
        /// For an error of n pixels in a perspective picture, \p tolerance is the size of n pixels at distance 1.
        float const *eye = nullptr;
        bool generateVaryingTables =
            true; ///< with points of their own, as generateVaryingLocalPoints has
        /// Whether the stencils of points, of varying ones too, are of type double; else float.
        bool patchPrecisionDouble = false;

        /// Whether there are patches of face-varying channels.
        bool generateFVarTables = false;
        /// \brief Whether the patches of all channels are QUADS of the values of the levels; else those of
        /// channels with FVAR_LINEAR_ALL alone, and of others patches as the surface's.
        bool generateFVarLegacyLinearPatches = true;
        int numFVarChannels = -1; ///< of fvarChannelIndices; -1: all channels of the mesh
        int const *fvarChannelIndices =
            nullptr; ///< the channels of the table, which are 0, 1 ... there
        /// Whether the stencils of face-varying points are of type double; else float.
        bool fvarPatchPrecisionDouble = false;

        /// Sets patchPrecisionDouble, for float or double.
        template <typename REAL>
        void SetPatchPrecision() {
            patchPrecisionDouble = sizeof(REAL) == sizeof(double);
        }
        /// Sets fvarPatchPrecisionDouble, likewise.
        template <typename REAL>
        void SetFVarPatchPrecision() {
            fvarPatchPrecisionDouble = sizeof(REAL) == sizeof(double);
        }

        /// \brief How to refine the refiner for these patches: one level further than the patches, with full topology,
        /// because the surface in the middle of edges is a limit of that level.
        TopologyRefiner::UniformOptions GetRefineUniformOptions() const {
            TopologyRefiner::UniformOptions options(maxIsolationLevel + 1);
            options.fullTopologyInLastLevel = true;
            return options;
        }
    };

    /// \brief Makes the table.
    ///
    /// Weights of a local point sum to 1; some are negative.  The same bits for any number of threads.
    ///
    /// \return  null on failure:
    ///          - InvalidArgument: a level out of range or without full topology (GetRefineUniformOptions()); a channel that the
    ///            mesh does not have; a tolerance that is negative, no number, or without positions; an eye without tolerance
    ///          - Unsupported: levels of other than hexagonal steps; a boundary with VTX_BOUNDARY_NONE, whose edge is named; a
    ///            vertex or face without a limit (LimitStencilTableFactory); a mesh of holes alone
    ///          - TooLarge: more than 2^28 - 1 patches, or 2^31 - 1 weights of points
    static std::unique_ptr<Far::PatchTable const>
    Create(TopologyRefiner const &refiner, Options options, CallStatus *status = nullptr);

    /// \brief The stencils of the local points alone, as the table has them, for those who evaluate the
    /// points with others: see AppendLocalPointStencilTable().
    ///
    /// \return  null on failure, as Create()
    static std::unique_ptr<Far::StencilTable const>
    CreateLocalPointStencilTable(TopologyRefiner const &refiner, Options options,
                                 CallStatus *status = nullptr);

    /// \brief The stencils of the points of a face-varying channel of the mesh, as its patches have them.
    ///
    /// \return  null on failure, as Create(); InvalidArgument for a channel that the mesh does not have
    static std::unique_ptr<Far::StencilTable const>
    CreateLocalPointFaceVaryingStencilTable(TopologyRefiner const &refiner, Options options,
                                            int channel = 0, CallStatus *status = nullptr);

    /// \brief Joins the stencils of \p base, as StencilTableFactory makes them, and those of local points,
    /// in this order: as Far::StencilTableFactory::AppendLocalPointStencilTable().  The same for varying and
    /// face-varying points.
    ///
    /// \return  null on failure: InvalidArgument (a null pointer, or tables of different numbers of control
    ///          vertices) or TooLarge (more than 2^31 - 1 weights)
    static std::unique_ptr<Far::StencilTable const>
    AppendLocalPointStencilTable(Far::StencilTable const *base,
                                 Far::StencilTable const *localPoints,
                                 CallStatus *status = nullptr);
};

/// \brief Finds the patch of PatchTableFactory that has a point (face, u, v) of the mesh, and (s, t) in it, as
/// Far::PatchMap does for ptex faces.
///
/// \code
///     FarExt::PatchMap const map(*refiner, patchOptions);
///     FarExt::PatchMap::Place const place = map.FindPlace(face, 0.5, 0.5);
///     Osd::PatchCoord const coord(FarExt::PatchMap::GetHandle(place.patch), float(place.s), float(place.t));
/// \endcode
///
/// Faces are the SurfaceFaces of the *surface level* (HexSchemeOptions::GetSurfaceLevel(): level 0, or 1 behind a first
/// step); (u, v) are those of Bfr::Parameterization and TopologyLevel::GetFaceSurfaceCoords().  A patch is a quadrilateral in the plane
/// of TopologyLevel::GetFaceBaseCoords(), in which (s, t) are bilinear.
///
/// The map does not refer to the refiner.  Several threads may use it at once.
class OPENSUBDIVHEX_API PatchMap {
public:
    /// A face or a patch.
    using Index = Far::Index;

    /// (s, t) in a patch.
    struct Place {
        Index patch; ///< INDEX_INVALID: none
        double s;    ///< from corner 0 to corner 1, from 0 to 1
        double t;    ///< from corner 0 to corner 3
    };

    /// \brief The map of the patches that PatchTableFactory makes of \p refiner with \p options.
    ///
    /// \p status is set as by PatchTableFactory::Create(); on failure there are no patches.
    PatchMap(TopologyRefiner const &refiner, PatchTableFactory::Options options,
             CallStatus *status = nullptr);

    /// Patches, as in the table.
    int GetNumPatches() const { return int(_patches.size()); }
    /// Surface faces.
    int GetNumFaces() const { return int(_roots.size()); }

    /// The surface face that a patch lies in.
    Index GetFace(Index patch) const { return _patches[std::size_t(patch)].face; }
    /// The face of level 0, as TopologyLevel::GetFaceBaseFace(): of its material, or of its texture.
    Index GetBaseFace(Index patch) const { return _patches[std::size_t(patch)].baseFace; }
    /// The four corners in the plane of the face: two coordinates of each.
    std::array<double, 8> const &GetCoords(Index patch) const {
        return _patches[std::size_t(patch)].coords;
    }
    /// (u, v) in the face, of (s, t) in a patch.
    void GetFacePlace(Place const &place, double *u, double *v) const;

    /// \brief The patch, and (s, t) in it, of (u, v) in a face of the surface level.
    ///
    /// A place between patches is found in one of them; one outside of the face, in the patch
    /// nearest to it in its direction from the centre, with s or t outside of 0 to 1.
    ///
    /// \return  no patch where the face is a hole, or none of the mesh
    Place FindPlace(Index face, double u, double v) const;

    /// The handle that Osd::PatchCoord takes beside s and t.
    static Far::PatchTable::PatchHandle GetHandle(Index patch) {
        constexpr int kNumPoints = 20;
        Far::PatchTable::PatchHandle handle;
        handle.arrayIndex = 0;
        handle.patchIndex = patch;
        handle.vertIndex = kNumPoints * patch;
        return handle;
    }

private:
    struct Patch {
        Index face;
        Index baseFace;
        std::array<double, 8> coords;
    };
    // A cell: its children, first that of its face, then those of its edges; or its patches.
    struct Node {
        Index firstChild;
        Index firstPatches[2]; // by half, if the face is cut
    };
    class TreeBuilder;

    std::vector<FaceShape> _shapes; // by face
    std::vector<Node> _roots;       // by face
    std::vector<Node> _children;
    std::vector<Patch> _patches;
};

} // namespace OpenSubdivHex::FarExt

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_PATCH_MAP_H
#define OPENSUBDIVHEX_FAR_EXT_PATCH_MAP_H

#include "patchTableFactory.h"

#include <array>
#include <vector>

namespace OpenSubdivHex::FarExt {

/// \brief Finds the patch of PatchTableFactory that has a point (face, u, v) of the mesh, and (s, t) in it, as
/// Far::PatchMap does for ptex faces.
///
/// \code
///     FarExt::PatchMap const map(*refiner, patchOptions);
///     FarExt::PatchMap::Place const place = map.FindPlace(face, 0.5, 0.5);
///     Osd::PatchCoord const coord(FarExt::PatchMap::GetHandle(place.patch), float(place.s), float(place.t));
/// \endcode
///
/// Faces are those of the *surface level* (HexSchemeOptions::GetSurfaceLevel(): level 0, or 1 behind a first step); (u, v)
/// are those of Bfr::Parameterization and TopologyLevel::GetFaceSurfaceCoords().  A patch is a quadrilateral in the plane
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
    /// Faces of the surface level.
    int GetNumFaces() const { return int(_roots.size()); }

    /// The face of the surface level that a patch lies in.
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
        Index firstPatch;
    };
    class TreeBuilder;

    std::vector<int> _faceSizes;
    std::vector<Node> _roots; // by face
    std::vector<Node> _children;
    std::vector<Patch> _patches;
};

} // namespace OpenSubdivHex::FarExt

#endif

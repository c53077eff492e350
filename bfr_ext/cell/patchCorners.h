// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_PATCH_CORNERS_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_PATCH_CORNERS_H

#include "far_ext/limit/limitPatch.h"
#include "far_ext/rules/quadPath.h"

#include <cstddef>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// The corners of a patch, as far as rings need to know them.
class PatchCorners {
public:
    explicit PatchCorners(FarExt::internal::LimitPatch const &patch) : _patch(patch) {
        _faces.reserve(patch.faceVerts.size());
        int first = 0;
        for (int const size : patch.faceSizes) {
            for (int i = 0; i < size; ++i) {
                _faces.push_back({first, size});
            }
            first += size;
        }
    }

    FarExt::internal::LimitPatch const &GetPatch() const { return _patch; }
    int GetFaceSize(int corner) const { return _faces[std::size_t(corner)].size; }
    int GetVertex(int corner) const { return _patch.faceVerts[std::size_t(corner)]; }
    /// So many places further on in the face, at most its size.
    int GetNext(int corner, int numPlaces) const {
        Face const &face = _faces[std::size_t(corner)];
        int const next = corner + numPlaces;
        return next < face.first + face.size ? next : next - face.size;
    }
    int GetBefore(int corner) const { return GetNext(corner, GetFaceSize(corner) - 1); }

    /// Finds the corners at the vertex of one, counter-clockwise from that on.
    /// \return  false where the vertex has a boundary; then the result is of no use
    bool FindRing(int first, std::vector<int> &ring) const {
        ring.clear();
        int corner = first;
        do {
            ring.push_back(corner);
            corner = _patch.otherCorners[std::size_t(GetBefore(corner))];
            if (corner < 0 || ring.size() == _faces.size()) {
                return false;
            }
        } while (corner != first);
        return true;
    }

    /// FarExt::internal::FindQuadFlag() of the vertex of a corner; 0 where that has a boundary.
    /// \param ring  scratch
    int FindFlag(int corner, std::vector<int> &ring) const {
        if (!FindRing(corner, ring)) {
            return 0;
        }
        return FarExt::internal::FindQuadFlag(
            int(ring.size()), [&](int i) { return GetFaceSize(ring[std::size_t(i)]); });
    }

private:
    struct Face {
        int first; // corner
        int size;
    };

    FarExt::internal::LimitPatch const &_patch;
    std::vector<Face> _faces; // by corner
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif

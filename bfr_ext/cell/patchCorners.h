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
        _corners.resize(patch.faceVerts.size());
        Corner *corner = _corners.data();
        int first = 0;
        for (int const size : patch.faceSizes) {
            int before = first + size - 1;
            for (int i = 0; i < size; ++i, ++corner) {
                *corner = {first, size, patch.otherCorners[std::size_t(before)]};
                before = first + i;
            }
            first += size;
        }
    }

    FarExt::internal::LimitPatch const &GetPatch() const { return _patch; }
    int GetFaceSize(int corner) const { return _corners[std::size_t(corner)].size; }
    int GetVertex(int corner) const { return _patch.faceVerts[std::size_t(corner)]; }
    /// So many places further on in the face, at most its size.
    int GetNext(int corner, int numPlaces) const {
        Corner const &face = _corners[std::size_t(corner)];
        int const next = corner + numPlaces;
        return next < face.first + face.size ? next : next - face.size;
    }
    int GetBefore(int corner) const { return GetNext(corner, GetFaceSize(corner) - 1); }
    /// The next corner at the vertex of one, counter-clockwise; negative where a boundary comes.
    int GetNextAround(int corner) const { return _corners[std::size_t(corner)].nextAround; }

    /// Finds the corners at the vertex of one, counter-clockwise from that on.
    /// \return  false where the vertex has a boundary; then the result is of no use
    bool FindRing(int first, std::vector<int> &ring) const {
        ring.clear();
        int corner = first;
        do {
            ring.push_back(corner);
            corner = GetNextAround(corner);
            if (corner < 0 || ring.size() == _corners.size()) {
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
    struct Corner {
        int first; // of the face
        int size;  // of the face
        int nextAround;
    };

    FarExt::internal::LimitPatch const &_patch;
    std::vector<Corner> _corners;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif

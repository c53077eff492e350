// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_PATCH_CORNERS_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_PATCH_CORNERS_H

#include "far_ext/limit/limitPatch.h"

#include <cstddef>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// The corners of a patch, as far as rings need to know them.
class PatchCorners {
public:
    explicit PatchCorners(FarExt::internal::LimitPatch const &patch) : _patch(patch) {
        int first = 0;
        for (int const size : patch.faceSizes) {
            _firsts.insert(_firsts.end(), std::size_t(size), first);
            _sizes.insert(_sizes.end(), std::size_t(size), size);
            first += size;
        }
    }

    int GetFaceSize(int corner) const { return _sizes[std::size_t(corner)]; }
    int GetVertex(int corner) const { return _patch.faceVerts[std::size_t(corner)]; }
    /// So many places further on in the face.
    int GetNext(int corner, int numPlaces) const {
        int const first = _firsts[std::size_t(corner)];
        return first + (corner - first + numPlaces) % GetFaceSize(corner);
    }
    int GetBefore(int corner) const { return GetNext(corner, GetFaceSize(corner) - 1); }

    /// The corners at the vertex of one, counter-clockwise from that on; none where it has a boundary.
    std::vector<int> FindRing(int first) const {
        std::vector<int> ring;
        int corner = first;
        do {
            ring.push_back(corner);
            corner = _patch.otherCorners[std::size_t(GetBefore(corner))];
            if (corner < 0 || ring.size() == _sizes.size()) {
                return {};
            }
        } while (corner != first);
        return ring;
    }

private:
    FarExt::internal::LimitPatch const &_patch;
    // By corner, of its face: the first corner, and the size.
    std::vector<int> _firsts;
    std::vector<int> _sizes;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif

// SPDX-License-Identifier: Apache-2.0
#include "faceWalk.h"

#include <utility>

namespace OpenSubdivHex::BfrExt::internal {

// A loop of several threads might take up work of its callers, which wait for this.
void FaceWalk::findNexts() const {
    std::vector<Index> places(_level.faceVerts.size()); // by corner
    for (std::size_t place = 0; place < places.size(); ++place) {
        places[std::size_t(_level.GetVertexCorner(Index(place)))] = Index(place);
    }
    std::vector<Next> nexts(places.size());
    for (Index face = 0; face < _level.numFaces; ++face) {
        Index const end = _level.faceFirstCorner[face + 1];
        Index before = end - 1;
        for (Index corner = _level.faceFirstCorner[face]; corner < end; before = corner++) {
            nexts[std::size_t(places[std::size_t(before)])] = {_level.faceVerts[corner],
                                                               places[std::size_t(corner)]};
        }
    }
    _nexts = std::move(nexts);
}

} // namespace OpenSubdivHex::BfrExt::internal

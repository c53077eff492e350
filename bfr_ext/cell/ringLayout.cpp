// SPDX-License-Identifier: Apache-2.0
#include "ringLayout.h"

#include "patchCorners.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace OpenSubdivHex::BfrExt::internal {

using FarExt::internal::LimitPatch;

RingLayout RingLayout::From(int firstFace) const {
    int const numFaces = int(faceSizes.size());
    firstFace = (firstFace + numFaces) % numFaces;
    int first = 0;
    for (int face = 0; face < firstFace; ++face) {
        first += int(Ring::GetNumOthers(RingStep::First)) + faceSizes[std::size_t(face)];
    }
    RingLayout result = *this;
    auto const rotate = [](std::vector<int> &numbers, int begin) {
        std::rotate(numbers.begin(), numbers.begin() + begin, numbers.end());
    };
    rotate(result.faceSizes, firstFace);
    rotate(result.verts, first);
    rotate(result.flags, result.flags.empty() ? 0 : firstFace);
    return result;
}

std::vector<RingLayout> FindRingLayouts(LimitPatch const &patch, std::vector<int> const &corners,
                                        bool hasFlags) {
    PatchCorners const ofPatch(patch);
    int const numVerts = int(patch.sources.size());
    std::vector<RingLayout> layouts;
    layouts.reserve(corners.size());
    std::vector<int> ring;
    std::vector<int> ringOfNeighbor;
    for (int const firstCorner : corners) {
        RingLayout layout;
        ofPatch.FindRing(firstCorner, ring);
        std::size_t numVertsOfRing = 0;
        for (int const corner : ring) {
            numVertsOfRing +=
                Ring::GetNumOthers(RingStep::First) + std::size_t(ofPatch.GetFaceSize(corner));
        }
        layout.faceSizes.reserve(ring.size());
        layout.verts.reserve(numVertsOfRing);
        for (int const corner : ring) {
            int const size = ofPatch.GetFaceSize(corner);
            layout.faceSizes.push_back(size);
            layout.verts.push_back(ofPatch.GetVertex(corner));
            layout.verts.push_back(ofPatch.GetVertex(ofPatch.GetNext(corner, 1)));
            for (int i = 0; i < size; ++i) {
                layout.verts.push_back(numVerts + ofPatch.GetNext(corner, i));
            }
            if (hasFlags) {
                layout.flags.push_back(
                    ofPatch.FindFlag(ofPatch.GetNext(corner, 1), ringOfNeighbor));
            }
        }
        layouts.push_back(std::move(layout));
    }
    return layouts;
}

std::vector<RingLayout> FindInnerLayouts(LimitPatch const &patch,
                                         std::vector<RingLayout> const &rings) {
    // The vertices that the step makes of the patch: F-vertices by the vertices of the level at their corners and behind
    // these, and V-vertices by their vertex and none.
    std::map<std::pair<int, int>, int> made;
    PatchCorners const corners(patch);
    int const numVerts = int(patch.sources.size());
    for (int vert = 0; vert < numVerts; ++vert) {
        made[{patch.sources[std::size_t(vert)], RingLayout::kNone}] = vert;
    }
    auto const getSource = [&](int corner) {
        return patch.sources[std::size_t(corners.GetVertex(corner))];
    };
    for (int corner = 0; corner < int(patch.faceVerts.size()); ++corner) {
        made[{getSource(corner), getSource(corners.GetNext(corner, 1))}] = numVerts + corner;
    }
    auto const find = [&](int vert, int next) {
        auto const found = made.find({vert, next});
        return found == made.end() ? RingLayout::kNone : found->second;
    };
    std::vector<RingLayout> layouts;
    layouts.reserve(rings.size());
    for (RingLayout const &ring : rings) {
        int const outerCenter = ring.verts[0];
        int const center = find(outerCenter, RingLayout::kNone);
        RingLayout layout = {ring.faceSizes, {}, {}};
        auto const addFVertices = [&](int const *verts, int size) {
            for (int i = 0; i < size; ++i) {
                layout.verts.push_back(find(verts[i], verts[(i + 1) % size]));
            }
        };
        // The block of a face: the vertex, the neighbour where the face begins, and the F-vertices.
        int const *neighbor = &ring.verts[1];
        int const *lastBefore = &ring.verts.back();
        int const *firstBefore = lastBefore - (ring.faceSizes.back() - 1);
        for (int const size : ring.faceSizes) {
            int const *const verts = neighbor + 1;
            std::array<int, 6> const hexagon = {outerCenter, *firstBefore, *lastBefore,
                                                *neighbor,   verts[1],     verts[0]};
            layout.verts.push_back(center);
            layout.verts.push_back(find(verts[0], RingLayout::kNone));
            addFVertices(hexagon.data(), int(hexagon.size()));
            addFVertices(verts, size);
            firstBefore = verts;
            lastBefore = verts + size - 1;
            neighbor += int(Ring::GetNumOthers(RingStep::First)) + size;
        }
        layouts.push_back(std::move(layout));
    }
    return layouts;
}

} // namespace OpenSubdivHex::BfrExt::internal

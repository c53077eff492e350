// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_RING_LAYOUT_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_RING_LAYOUT_H

#include "memoryCount.h"

#include "far_ext/limit/limitPatch.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// The step that has made the points of rings.
enum class RingStep { First, Second };

/// \brief The sizes of the faces of a ring.  Those of most are the same, and take no memory of their own, which
/// would mostly not be in the cache.
class RingFaceSizes {
public:
    /// \param sizes  of one face at least
    explicit RingFaceSizes(std::vector<int> const &sizes)
        : _numFaces(int(sizes.size())), _firstSize(sizes[0]) {
        if (std::any_of(sizes.begin(), sizes.end(), [&](int size) { return size != sizes[0]; })) {
            _sizes = sizes;
        }
    }

    int GetNumFaces() const { return _numFaces; }
    bool AreSame() const { return _sizes.empty(); }
    std::size_t GetHeapSize() const { return internal::GetHeapSize(_sizes); }
    int operator[](int face) const { return AreSame() ? _firstSize : _sizes[std::size_t(face)]; }

private:
    int _numFaces;
    int _firstSize;
    std::vector<int> _sizes; // none where they are the same
};

/// \brief A ring of VertexRings or InnerRings, as far as its points do not depend on where they come from.
///
/// The points of a ring lie one behind the other.  First come two for its vertex, whose sums begin with
/// face 0 and face 1; then the *blocks* of the faces, counter-clockwise.  The last face has its block
/// before that of face 0, and face 0 has its own behind that of the last, too, so that the blocks
/// from any of these on are one behind the other.
struct Ring {
    RingFaceSizes faceSizes;
    std::size_t firstPoints[2]; ///< by step: of all rings, that which is its vertex from face 0 on
    /// Whether the faces around the vertex and its neighbours are a piece of a regular lattice.
    bool isInLattice;

    std::size_t GetHeapSize() const { return faceSizes.GetHeapSize(); }
    int GetNumFaces() const { return faceSizes.GetNumFaces(); }
    /// The size of a face; face -1 is the last.
    int GetFaceSize(int face) const { return faceSizes[face < 0 ? GetNumFaces() - 1 : face]; }
    std::size_t GetBlockSize(int face, RingStep step) const {
        return GetNumOthers(step) + std::size_t(GetFaceSize(face));
    }
    /// The points of the blocks from face 0 up to another one, or of all.
    std::size_t GetOffset(int endFace, RingStep step) const {
        if (faceSizes.AreSame()) {
            return std::size_t(endFace) * GetBlockSize(0, step);
        }
        std::size_t size = 0;
        for (int face = 0; face < endFace; ++face) {
            size += GetBlockSize(face, step);
        }
        return size;
    }
    /// Number of points of a block before the F-vertices of its face.
    static constexpr std::size_t GetNumOthers(RingStep step) {
        return step == RingStep::First ? 1 : 9;
    }
    std::size_t GetNumPoints(RingStep step) const {
        return 2 + GetBlockSize(-1, step) + GetBlockSize(0, step) + GetOffset(GetNumFaces(), step);
    }
    /// The point of its vertex, from face 0 or 1 on.
    std::size_t GetCenter(int firstFace, RingStep step) const {
        return firstPoints[std::size_t(step)] + std::size_t(firstFace);
    }
    /// The first point of the block of face -1, 0 or 1.
    std::size_t GetBlock(int face, RingStep step) const {
        std::size_t const first = GetCenter(2, step);
        if (face < 0) {
            return first;
        }
        return first + GetBlockSize(-1, step) + (face == 0 ? 0 : GetBlockSize(0, step));
    }
};

/// \brief Layout of a ring, in vertices of the level that the step makes.
///
/// Two sets of rings with equal layouts make equal children, except for the numbers of vertices.
struct RingLayout {
    /// Marks entries that are no vertices of the level, or that are not used.
    static constexpr int kNone = -1;

    int center;
    std::vector<int> faceSizes;
    std::vector<int> verts; ///< from the block of face 0 to that of the last
    /// With masks that depend on those, by face: the flag of the neighbor where it begins, see FindQuadFlag.
    std::vector<int> flags;

    /// The layout of the first step from another face on.
    RingLayout From(int firstFace) const;
};
/// The layout of the first step from a patch.
///
/// \param corners   those of VertexRings::Init(), which finds rings there
/// \param hasFlags  whether masks depend on flags of neighbors, as Smooth's do
std::vector<RingLayout> FindRingLayouts(FarExt::internal::LimitPatch const &patch,
                                        std::vector<int> const &corners, bool hasFlags);
/// The layout of the second step, from a patch that the first step makes.
///
/// \param rings  those of the first step
std::vector<RingLayout> FindInnerLayouts(FarExt::internal::LimitPatch const &patch,
                                         std::vector<RingLayout> const &rings);

} // namespace OpenSubdivHex::BfrExt::internal

#endif

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
/// A face numbers the faces around its vertex from itself on; its *turn* is the number of those that come before it in
/// the vertex's own order, which all of them know.  The points of a ring are the *blocks* of the faces, counter-clockwise
/// in the vertex's order, so that they are the same, and in the same places, whichever face makes them.
struct Ring {
    RingFaceSizes faceSizes;
    std::size_t firstPoints[2]; ///< by step, among the points of all rings
    /// Whether the faces around the vertex and its neighbours are a piece of a regular lattice.
    bool isInLattice;

    std::size_t GetHeapSize() const { return faceSizes.GetHeapSize(); }
    int GetNumFaces() const { return faceSizes.GetNumFaces(); }
    /// The size of a face; face -1 is the last.
    int GetFaceSize(int face) const { return faceSizes[face < 0 ? GetNumFaces() - 1 : face]; }
    std::size_t GetBlockSize(int face, RingStep step) const {
        return GetNumOthers(step) + std::size_t(GetFaceSize(face));
    }
    /// Number of points of a block before the F-vertices of its face.
    static constexpr std::size_t GetNumOthers(RingStep step) {
        return step == RingStep::First ? 2 : 8;
    }
    std::size_t GetNumPoints(RingStep step) const { return getNumPoints(0, GetNumFaces(), step); }
    /// A turn that was counted on by up to a round, or back by one.
    int GetTurn(int turn) const {
        return turn < 0 ? turn + GetNumFaces() : turn < GetNumFaces() ? turn : turn - GetNumFaces();
    }
    /// The face that comes first in the vertex's order.
    int GetFirstFace(int turn) const { return turn == 0 ? 0 : GetNumFaces() - turn; }
    /// \brief Where in the ring a block begins.
    ///
    /// \param turn  of face 0
    /// \param face  not before -1
    std::size_t GetBlock(int turn, int face, RingStep step) const {
        int const number = GetTurn(turn + face); // in the vertex's order
        return getNumPoints(face - number, face, step);
    }

private:
    // The points of the blocks of some faces, the first of which may be negative.
    std::size_t getNumPoints(int beginFace, int endFace, RingStep step) const {
        if (faceSizes.AreSame()) {
            return std::size_t(endFace - beginFace) * GetBlockSize(0, step);
        }
        std::size_t size = 0;
        for (int face = beginFace; face < endFace; ++face) {
            size += GetBlockSize(face < 0 ? face + GetNumFaces() : face, step);
        }
        return size;
    }
};

/// Where the points of a ring lie, seen from one of its faces.
struct RingPoints {
    int first;  ///< of the ring
    int count;  ///< of the ring
    int offset; ///< in the ring, to the block of the face
};

/// \brief Layout of a ring, in vertices of the level that the step makes.
///
/// Two sets of rings with equal layouts make equal children, except for the numbers of vertices.
struct RingLayout {
    /// Marks entries that are no vertices of the level.
    static constexpr int kNone = -1;

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

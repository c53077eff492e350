// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_INNER_RINGS_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_INNER_RINGS_H

#include "ringLayout.h"
#include "ringMasks.h"

#include <cstddef>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

class PatchCorners;

/// \brief The second step by its masks, around vertices of the base mesh, from the points of their rings.
///
/// As those of a ring, points are sums that depend on the ring alone.
///
/// The block of a face has the V-vertex of the vertex; that of the face's F-vertex there; the F-vertices of the E-face
/// of the edge where the face begins, from the vertex of the ring on and counter-clockwise; and those of the F-face.
class InnerRings {
public:
    /// Around a vertex; each of them has a sum of all.
    static constexpr std::size_t kMaxFaces = 32;

    /// Whether there are any.
    bool IsUsed() const { return !_rings.empty(); }
    std::size_t GetHeapSize() const { return internal::GetHeapSize(_rings); }

    /// \brief Finds what the second step makes around corners of a patch, where rings are.
    ///
    /// \return  false around vertices of more than kMaxFaces, whose faces make the second step by themselves;
    ///          plain base faces have none
    bool Init(PatchCorners const &ofPatch, std::vector<int> const &corners, RingMasks &masks);

    /// \brief Writes the points of a ring from those of the first step.
    ///
    /// \param number      of the ring
    /// \param turn        of face 0
    /// \param paddedSize  numbers of a point, a multiple of StepMatrix::kPadding
    /// \tparam PADDED_SIZE  the same if it is known, else 0
    template <std::size_t PADDED_SIZE, typename REAL>
    void Apply(Ring const &ring, std::size_t number, int turn, std::size_t paddedSize,
               REAL const *first, REAL *second) const;

private:
    using Weights = RingMasks::Weights;

    class MaskFinder;
    struct Spoke {
        Weights const *hexagon; // of its E-face, a row for each F-vertex
        Weights const *face;    // of the F-face behind it: of the F-vertex at place 0
    };
    struct Center {
        std::size_t GetHeapSize() const { return internal::GetHeapSize(spokes); }

        Weights const *vertex;  // its own, and that of F-vertices
        Weights const *fVertex; // of F-vertices there: its own, of its F-face and of its E-faces
        std::vector<Spoke> spokes;
    };

    template <std::size_t PADDED_SIZE, typename REAL>
    static void applyFaces(Spoke const &spoke, std::size_t faceSize, REAL const *outer,
                           REAL const *lastBefore, REAL const *firstBefore, std::size_t paddedSize,
                           REAL *inner);
    template <std::size_t PADDED_SIZE, typename REAL>
    static void writeCenter(Ring const &ring, Center const &center, int firstFace,
                            REAL const *outer, std::size_t paddedSize, REAL *blocks);

    std::vector<Center> _rings;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_VERTEX_RINGS_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_VERTEX_RINGS_H

#include "cellType.h"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief The first step by its masks, around some vertices of the base mesh: of each the *ring*, which is
/// what the step makes of the faces around the vertex and of its neighbours.
///
/// Each point is a sum that depends on the ring alone, and on neither the base face nor the numbers of its
/// control points: an F-vertex begins with the vertex of its own corner, and the V-vertex of a neighbour
/// with the vertex that has the ring.  So all faces at the vertex get the same points, to the bit.
///
/// The points of a ring lie one behind the other.  First come two for its vertex, whose sums begin with
/// face 0 and face 1; then the *blocks* of the faces, counter-clockwise: the V-vertex of the neighbour
/// where the face begins, and its F-vertices, from that at the vertex on.  The last face has its block
/// before that of face 0, and face 0 has its own behind that of the last, too, so that the blocks
/// from any of these on are one behind the other.
class VertexRings {
public:
    /// A ring, as far as its points do not depend on where they come from.
    struct Ring {
        std::vector<int> faceSizes;
        std::size_t firstPoint; ///< of all rings, that which is its vertex from face 0 on
        /// Whether the faces around the vertex and its neighbours are a piece of a regular lattice.
        bool isInLattice;

        int GetNumFaces() const { return int(faceSizes.size()); }
        /// The size of a face; face -1 is the last.
        int GetFaceSize(int face) const {
            return face < 0 ? faceSizes.back() : faceSizes[std::size_t(face)];
        }
        std::size_t GetBlockSize(int face) const { return 1 + std::size_t(GetFaceSize(face)); }
        std::size_t GetNumPoints() const;
    };

    /// \brief Finds the rings around corners of a patch, which say what face 0 is.
    ///
    /// \param rules  those of the step
    /// \return       false where a ring or a neighbour is not plain; then the result is of no use
    bool Init(FarExt::internal::LimitPatch const &patch, std::vector<int> const &corners,
              CellRules const &rules);

    std::vector<Ring> const &GetRings() const { return _rings; }
    /// Points of all rings.
    std::size_t GetNumPoints() const { return _numPoints; }
    /// The point of a ring's vertex, from face 0 or 1 on.
    std::size_t GetCenter(int ring, int firstFace) const {
        return _rings[std::size_t(ring)].firstPoint + std::size_t(firstFace);
    }
    /// The first point of the block of face -1, 0 or 1.
    std::size_t GetBlock(int ring, int face) const {
        Ring const &ofRing = _rings[std::size_t(ring)];
        std::size_t const first = ofRing.firstPoint + 2;
        if (face < 0) {
            return first;
        }
        return first + ofRing.GetBlockSize(-1) + (face == 0 ? 0 : ofRing.GetBlockSize(0));
    }

    /// \brief Writes the points of all rings from those of the patch.
    ///
    /// \param paddedSize  numbers of a point, a multiple of StepMatrix::kPadding
    template <typename REAL>
    void Apply(REAL const *points, std::size_t paddedSize, REAL *result) const;
    /// Writes the point of a ring's vertex, from any face on, as Apply() writes it from face 0 on.
    ///
    /// \param rings  what Apply() wrote
    template <typename REAL>
    void ApplyCenter(int ring, int firstFace, REAL const *points, REAL const *rings,
                     std::size_t paddedSize, REAL *result) const;

private:
    using Number = std::uint16_t;

    // What the program of a ring begins with: its vertex, its number of faces and the two weights of its
    // V-vertex.
    static constexpr std::size_t kHeaderSize = 4;

    class Builder;
    template <typename REAL>
    REAL const *getWeights() const;
    template <std::size_t PADDED_SIZE, typename REAL>
    static Number const *applyFace(Number const *program, REAL const *weights, REAL const *center,
                                   REAL const *points, std::size_t paddedSize, REAL *result);
    template <std::size_t PADDED_SIZE, typename REAL>
    static void applyCenter(Ring const &ring, int firstFace, REAL vertexWeight, REAL faceWeight,
                            REAL const *center, REAL const *blocks, std::size_t paddedSize,
                            REAL *result);
    template <std::size_t PADDED_SIZE, typename REAL>
    void apply(REAL const *points, std::size_t paddedSize, REAL *result) const;

    std::size_t _numPoints = 0;
    std::vector<Ring> _rings;
    std::vector<Number> _firsts;  // by ring, in the program
    std::vector<Number> _program; // what Apply() does, ring by ring
    std::vector<double> _weights; // those that differ
    std::vector<float> _floatWeights;
};

/// \brief What is where in a ring, in vertices of the level that the step makes of a patch.
///
/// What the step makes of two sets of rings is alike where their layouts are, but for the numbers of
/// vertices.
struct RingLayout {
    int center;
    std::vector<int> faceSizes;
    std::vector<int> verts; ///< from the block of face 0 to that of the last
    /// By neighbour, its number of faces, and what these are: numFaces kNumFacesAround + facesAround.
    std::vector<int> neighbors;

    /// The same from another face on.
    RingLayout From(int firstFace) const;
};
/// \param corners  those of VertexRings::Init(), which finds rings there
std::vector<RingLayout> FindRingLayouts(FarExt::internal::LimitPatch const &patch,
                                        std::vector<int> const &corners);

} // namespace OpenSubdivHex::BfrExt::internal

#endif

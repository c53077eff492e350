// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_VERTEX_RINGS_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_VERTEX_RINGS_H

#include "innerRings.h"
#include "lanes.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief The first step by its masks, around some vertices of the base mesh: of each the *ring*, which is
/// what the step makes of the faces around the vertex and of its neighbours.
///
/// Each point is a sum that depends on the ring alone, and on neither the base face nor the numbers of its
/// control points: an F-vertex begins with the vertex of its own corner, the V-vertex of a neighbour
/// with the vertex that has the ring, and that of the vertex with the face that comes first in the vertex's order.  So
/// all faces at the vertex get the same points, to the bit.
///
/// The block of a face has the V-vertex of the vertex, that of the neighbour where the face begins, and the face's
/// F-vertices, from that at the vertex on.  Among the points of all rings those of InnerRings come last, where there
/// are any.
class VertexRings {
public:
    /// \brief Finds the rings around corners of a patch, which say what face 0 is.
    ///
    /// \param masks  of the rules of the steps
    /// \return       false where a ring or a neighbour is not plain; then the result is of no use
    bool Init(PatchCorners const &ofPatch, std::vector<int> const &corners, RingMasks &masks);

    std::vector<Ring> const &GetRings() const { return _rings; }
    std::size_t GetHeapSize() const {
        return GetHeapSizes(_rings, _firsts, _masks, _program, _inner);
    }
    /// Points of all rings, of all steps.
    std::size_t GetNumPoints() const { return _numPoints; }
    /// The last step that made points.
    RingStep GetLastStep() const { return _inner.IsUsed() ? RingStep::Second : RingStep::First; }
    /// The vertex of a ring, as a point of the patch.
    int GetVertex(std::size_t ring) const { return _program[_firsts[ring] + kVertex]; }
    /// Where the points of a ring lie among those of all rings, seen from a face.
    RingPoints GetPoints(int ring, int turn, int face, RingStep step) const {
        Ring const &ofVertex = _rings[std::size_t(ring)];
        return {int(ofVertex.firstPoints[std::size_t(step)]), int(ofVertex.GetNumPoints(step)),
                int(ofVertex.GetBlock(turn, face, step))};
    }

    /// \brief Writes the points of a ring from those of the patch.
    ///
    /// \param turn        of face 0
    /// \param points      of the patch, and behind them one whose numbers are 0
    /// \param paddedSize  numbers of a point, a multiple of StepMatrix::kPadding
    /// \param first       the points of the first step
    /// \param second      those of the second step, if GetLastStep() is this one
    template <typename REAL>
    void Apply(std::size_t ring, int turn, REAL const *points, std::size_t paddedSize, REAL *first,
               REAL *second) const;
    /// Writes the points of all rings, whose turns are 0.
    template <typename REAL>
    void Apply(REAL const *points, std::size_t paddedSize, REAL *result) const {
        for (std::size_t ring = 0; ring < _rings.size(); ++ring) {
            std::size_t const(&firsts)[2] = _rings[ring].firstPoints;
            Apply(ring, 0, points, paddedSize, result + firsts[0] * paddedSize,
                  result + firsts[1] * paddedSize);
        }
    }

private:
    using Number = std::uint16_t;

    // Places in the headers of the program.  A mask is its number among those of the face.
    enum RingHeader : std::uint8_t { kVertex, kVertexMask, kRingHeaderSize };
    enum FaceHeader : std::uint8_t {
        kFaceSize,
        kFaceMask,
        kNeighborMask,
        kNumRuns,
        kFaceHeaderSize
    };

    // Points that are added up at once: what a run has less is filled up with zeros, since loops of different
    // lengths cost more than sums.
    static constexpr std::size_t kRunStep = 4;
    static constexpr std::size_t kLastNumber = std::numeric_limits<Number>::max();
    static constexpr std::size_t kNumOthers = Ring::GetNumOthers(RingStep::First);

    // The mask of a vertex: its own weight, and that of F-vertices; of an F-vertex: the weights of the face's vertices from
    // its own on; or of a neighbour: its own weight, and those of *runs*, the points of which have one weight.
    struct Mask {
        std::size_t GetHeapSize() const { return GetHeapSizes(weights, numSteps, places); }

        RingMasks::Weights weights;
        // Of a neighbour, by run: how many times kRunStep points it has, and which they are of those around the neighbour.
        std::vector<Number> numSteps;
        std::vector<Number> places;
    };

    class Builder;
    template <std::size_t PADDED_SIZE, typename REAL>
    Number const *applyFace(Number const *program, Lanes<REAL> const &center, REAL const *points,
                            std::size_t paddedSize, REAL *result) const;
    template <std::size_t PADDED_SIZE, typename REAL>
    void apply(std::size_t number, int turn, REAL const *points, std::size_t paddedSize,
               REAL *first, REAL *second) const;

    std::size_t _numPoints = 0;
    std::vector<Ring> _rings;
    std::vector<std::uint32_t> _firsts; // by ring, in the program
    std::vector<Mask const *> _masks;
    // Each ring has a header and then its faces; a face has a header, its vertices behind that of the ring, the first of
    // which is the neighbour where the face begins, and the runs of this neighbour, each their number of steps and their
    // points.  All that a face needs is read from end to end, and mostly not in the cache.
    std::vector<Number> _program;
    InnerRings _inner;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif

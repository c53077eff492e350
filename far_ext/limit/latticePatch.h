// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_LIMIT_LATTICE_PATCH_H
#define OPENSUBDIVHEX_FAR_EXT_LIMIT_LATTICE_PATCH_H

#include "far_ext/vtr/level.h"

#include <complex>
#include <vector>

namespace OpenSubdivHex::FarExt::internal {

/// \brief How many orbits there are among the vertices of a LatticePatch, or among the nearest of them,
/// which are enough where farther ones weigh nothing, as with FaceMask::Smooth.
///
/// An *orbit* is what becomes of one place as the face turns, one for each corner.  A mirror that keeps
/// corner 0 keeps an orbit on an *axis*, and exchanges the two of a *pair*.
template <int FACE_SIZE, bool IS_COMPACT>
struct LatticeOrbits {
    static constexpr int kNumAxes = FACE_SIZE == 4 || IS_COMPACT ? 2 : 3;
    static constexpr int kNumPairs = IS_COMPACT ? 1 : FACE_SIZE == 6 ? 2 : 3;
};

/// \brief The vertices that the surface of a face depends on in the regular lattice of triangles, six at a vertex, of
/// quads, or of hexagons: the vertices of the faces at its vertices and at their neighbours.
///
/// Vertices are numbered by their places: orbit after orbit, those on axes first, then pair after pair.
/// Place i of an orbit is place 0 turned by i corners; of a pair, place 0 of the second orbit is that
/// of the first in the mirror.
class OPENSUBDIVHEX_API LatticePatch {
public:
    using Index = Far::Index;
    using Point = std::complex<double>;

    static constexpr int kMaxPlaces = 42;

    /// For triangles, quads or hexagons.
    explicit LatticePatch(int faceSize);

    int GetFaceSize() const { return _faceSize; }
    /// The faces around each vertex.
    int GetValence() const { return 2 * _faceSize / (_faceSize - 2); }
    int GetNumPlaces() const { return int(_points.size()); }
    int GetNumAxes() const { return _numAxes; }
    int GetNumPairs() const { return (GetNumPlaces() / _faceSize - _numAxes) / 2; }

    /// Where the vertices are in the plane: the face around 0, corner 0 on the real axis, edges 1 long.
    std::vector<Point> const &GetPoints() const { return _points; }
    /// A point turned by some corners, to the next ones.
    Point Turn(Point point, int corners) const;
    /// The place that a place comes to.
    int TurnPlace(int place, int corners) const;
    int MirrorPlace(int place) const;

    /// \brief Gathers the vertices of a face that isOfLattice(vertex) tells to be of the lattice, as all
    /// its sources must.
    ///
    /// \param isOfLattice  whether a vertex has GetValence() faces of the size and no feature
    /// \return             whether all around is the lattice, and no vertex comes twice
    template <typename IS_OF_LATTICE>
    bool Gather(Level const &level, Index face, IS_OF_LATTICE isOfLattice, Index *verts) const {
        FaceCorner corners[kMaxSteps];
        std::fill_n(verts, _points.size(), Far::INDEX_INVALID);
        for (std::size_t i = 0; i < _steps.size(); ++i) {
            Step const &step = _steps[i];
            corners[i] = i == 0 ? FaceCorner{face, level.faceFirstCorner[face]}
                                : follow(level, corners[std::size_t(step.from)], step.isAcross);
            Index const found = level.faceVerts[corners[i].corner];
            Index &vert = verts[step.place];
            if (vert == found) {
                continue;
            }
            if (vert != Far::INDEX_INVALID || !isOfLattice(found)) {
                return false;
            }
            vert = found;
        }
        return areDifferent(verts);
    }

private:
    /// The way to a corner: from another one to the next of its face, or to the corner there on the
    /// other side of the edge.
    struct Step {
        int from;
        bool isAcross;
        int place; ///< of its vertex
    };
    struct Directed;

    static constexpr int kMaxSteps = 128;

    static FaceCorner follow(Level const &level, FaceCorner from, bool isAcross);
    bool areDifferent(Index const *verts) const;
    void addStep(Step step, Point point);
    void setPlaces();
    int findPlace(Point point) const;

    int _faceSize;
    int _numAxes = 0;
    std::vector<Point> _points;
    std::vector<Step> _steps;
};

} // namespace OpenSubdivHex::FarExt::internal

#endif

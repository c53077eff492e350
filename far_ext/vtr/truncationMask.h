// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_TRUNCATION_MASK_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_TRUNCATION_MASK_H

#include "refinement.h"

#include "far_ext/hexSchemeOptions.h"

#include <vector>

namespace OpenSubdivHex::FarExt::internal {

/// The end of an edge, 2 e at its first vertex and 2 e + 1 at the other, where a face begins to run
/// along it in \p corner.
inline std::size_t FindEdgeEnd(Level const &level, Far::Index corner) {
    Far::Index const edge = level.faceEdges[corner];
    return 2 * std::size_t(edge) + (level.GetSideCorner(edge, 0) == corner ? 0 : 1);
}

/// The vertex that a truncation makes beside an end of an edge of the parent.
Far::Index GetEdgeEndVertex(Refinement const &truncation, std::size_t end);

/// \brief The masks of a truncation: the sources of each vertex that it makes, with their weights.
///
/// Beside a vertex the mask is that of ComputeTruncateMask for the faces around it.  On a sharp edge
/// V-W it is T = (2 V + W)/3, and along a crease V' = (7 V + V_l + V_r)/9: new points have the second
/// moment 2/9 along it, as all have in a regular mesh of triangles.  Between two sharp edges of V
/// there are as many faces as beside an interior vertex with twice as many; what the mean of all
/// their centroids would bring is what it brings along the line, (V_l + V_r - 2 V)/6.  A free
/// boundary follows the rules of a sharp one here.  Where a vertex that is cut is smooth, V' is the
/// mean of what the T around it would be.  Rules of semi-sharp edges and vertices are blended as in
/// the hexagonal step.  Varying data are linear: T = (2 V + W)/3 and V' = V.
class OPENSUBDIVHEX_API TruncationMask {
public:
    using Index = Far::Index;

    /// Sources of a vertex; one source may occur several times.
    struct Sources {
        std::vector<Index> verts;
        std::vector<double> weights;

        void Add(Index vert, double weight) {
            verts.push_back(vert);
            weights.push_back(weight);
        }
    };

    /// Refers to \p truncation and its parent.
    TruncationMask(Refinement const &truncation, Interpolation interpolation)
        : _refinement(truncation), _parent(*truncation.parent), _interpolation(interpolation) {}

    void GetSources(Index cVert, Sources &sources) const;

private:
    /// How much of each rule a vertex has: the rest is that of a corner.
    struct RuleShares {
        double smooth;
        double crease;
        double border; ///< that of a crease, along a free boundary in place of the smooth rule
    };

    RuleShares getShares(Index vert, SharpVertex const *sharp) const;
    int countSector(Index corner) const;
    void addCentroids(Index vert, Index corner, TruncateMask const &mask, Sources &sources) const;
    double addAlongLine(Index vert, SharpVertex const *sharp, RuleShares const &shares,
                        double weight, Sources &sources) const;
    void addEdgeVertex(std::size_t end, Sources &sources) const;
    void addVVertex(Index vert, Sources &sources) const;

    Refinement const &_refinement;
    Level const &_parent;
    Interpolation _interpolation;
};

} // namespace OpenSubdivHex::FarExt::internal

#endif

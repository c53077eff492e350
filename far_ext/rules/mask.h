// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_RULES_MASK_H
#define OPENSUBDIVHEX_FAR_EXT_RULES_MASK_H

#include "far_ext/hexSchemeOptions.h"

#include <cstdint>

namespace OpenSubdivHex::FarExt {

/// \brief The kind of data that is interpolated: Far's vertex, varying and face-varying primvars.
enum class Interpolation {
    Vertex, ///< the scheme's own masks
    Varying ///< linear: V' = V and P = (V + centroid)/2
};

/// \brief Writes the \p n weights of the vertices 0 ... n-1 places around a face of \p n sides.
///
/// The weights are non-negative, symmetric (w[j] == w[n-j]) and sum to 1.  \p n is at least 3.
OPENSUBDIVHEX_API void ComputeFaceVertexMask(FaceMask mask, Interpolation interpolation, int n,
                                             double *weights);

/// \brief Writes the \p n x \p n weights of a half face V, W, Q_2 ... Q_n-1, half of a polygon of 2 (n - 1) sides whose
/// side V-W is a sharp boundary or crease: row i has the weights of the vertices for the F-vertex of corner i.
///
/// \p n is at least 3, and 4 for half a hexagon.  On the long side P_V = (3 V + W)/4.  The other corners follow the mask of
/// the polygon that is completed by ghosts, the mirror images of the Q across V-W.  With the vertices of the polygon at the
/// angles pi p/(n - 1) around its centre, from V on, a ghost and its Q sum to (1 + cos) V + (1 - cos) W.  So those of half
/// a hexagon V, W, Q, P are (3 V + W)/2 - P and (V + 3 W)/2 - Q.
///
/// The eigenvalues are those along the side, 1 and 1/2, and the mask's own of the polygon that are odd across it: with
/// Smooth 1/2, 1/4, and 1/8 for the rest; from n = 7 on 1/6 for the rest, without which weights would be negative.
OPENSUBDIVHEX_API void ComputeHalfFaceVertexMask(FaceMask mask, Interpolation interpolation, int n,
                                                 double *weights);

/// \brief Writes the \p n weights for the new point of the edge from vertex 0 to vertex 1 of a
/// face, in the tri-hex scheme: P = (V_0 + V_1 + centroid)/3, for vertex and for varying data.
///
/// The masks of Claes, Beets and Van Reeth (2002) are not public; of the masks on one face that are
/// symmetric and reproduce linear functions this is the smoothest.
OPENSUBDIVHEX_API void ComputeTriHexMask(int n, double *weights);

/// \brief The faces up to which the masks of FirstStep::Truncate take all faces around a vertex, and not
/// those alone that an edge lies between.
inline constexpr int kMaxTruncatedAround = 8;

/// \brief The mask of FirstStep::Truncate beside a vertex V: the vertex on the edge between faces with
/// the centroids G and G' is
/// T = vertexWeight V + besideWeight (G + G') + aroundWeight (the mean of the centroids around V).
struct TruncateMask {
    double vertexWeight; ///< of V
    double besideWeight; ///< of each of G and G'
    double aroundWeight; ///< of the mean of the centroids of all faces of V
};

/// \brief Returns the mask of FirstStep::Truncate beside a vertex with \p numFaces faces, k.
///
/// | k            | 3     | 4     | 5    | 6   | 7     | 8     | more                    |
/// |--------------|-------|-------|------|-----|-------|-------|-------------------------|
/// | vertexWeight | 0     | 1/32  | 1/14 | 1/6 | 4/16  | 20/64 | 1 - 2 besideWeight      |
/// | besideWeight | 27/64 | 12/32 | 5/14 | 1/3 | 5/16  | 19/64 | (4 - 2 cos(2 pi/k))/9   |
/// | aroundWeight | 10/64 | 7/32  | 3/14 | 1/6 | 2/16  | 6/64  | 0                       |
///
/// At k = 6 all new points of a regular mesh of triangles have the same second moments, alike in all
/// directions, so that quadratics are kept but for a constant; these are those of the points on sharp
/// edges, 2/9 of the square of an edge.  The others are fits: at 3 and 4 to the tetrahedron and the
/// octahedron, at 5, 7 and 8 to hulls of points on a sphere and the icosahedron, whose mean curvature
/// they make as even as it gets.  Weights are not negative, linear functions are kept.
OPENSUBDIVHEX_API TruncateMask ComputeTruncateMask(int numFaces);

/// \brief The least sector that ComputeSectorShrink is for.
inline constexpr double kMinShrunkSector = 3;

/// \brief Factor s by which F-vertices in a wide sector are drawn towards their vertex:
/// P = s (mask of the face) + (1 - s) V.
///
/// A sector is what lies at a vertex between two sharp edges (boundaries or creases); its size k is
/// the number of its faces, k >= 3.  With the plain masks the surface approaches the sharp curve in
/// such a sector as at an interior vertex of valence 2k, with an eigenvalue above the curve's 1/2;
/// from k = 4 on a second mode passes 1/2, and the tangent plane is lost.  With
///
///     s = 1/(alpha + beta cos(pi/k)),  Average: 0.98, 0.305,  Cosine and Smooth: 1.31, 0.515
///
/// the first mode across has the eigenvalue 1/2 (within 0.002) for every k, the next less.  The
/// constants are a fit to numerical solutions for k = 3 ... 12.  Curve and topology are untouched.
OPENSUBDIVHEX_API double ComputeSectorShrink(FaceMask mask, double sectorSize);

/// \brief The mask of an old vertex: V' = vertexWeight V + sum over its faces of faceWeight P_i.
struct VertexVertexMask {
    double vertexWeight; ///< of the vertex itself
    double faceWeight;   ///< of the F-vertex in each face
};

/// \brief Returns the mask of a vertex with \p numFaces incident faces: both weights are
/// 1/(numFaces + 1) for vertex data (the paper's stage 2); 1 and 0 for varying data.
OPENSUBDIVHEX_API VertexVertexMask ComputeVertexVertexMask(Interpolation interpolation,
                                                           int numFaces);

/// \brief The faces from which on a vertex inside the mesh is irregular, and Smooth has masks of its
/// own around it.
inline constexpr int kMinIrregularFaces = 4;

/// The vertices of a hexagon.
inline constexpr int kHexagon = 6;

/// \brief The kind of all faces around an irregular vertex when hexagonal steps began, which made them
/// hexagons; as far as it matters.
enum class FacesAround : std::uint16_t {
    Others,    ///< anything else
    Quads,     ///< four quads
    Triangles, ///< five triangles or more
};
inline constexpr int kNumFacesAround = 3; ///< values of that

/// \brief The hexagonal steps from which on the masks of irregular vertices, of quads and beside quads do
/// not change any more.
inline constexpr int kNumStepsToConstantMasks = 4;

/// \brief The masks of Smooth around an irregular vertex V, where four hexagons or more meet.
///
/// The vertices of a hexagon at V are V, N, A, B, C and M in turn: N and M are neighbours of V.
/// Weights are in the order that the vertices have from the one whose F-vertex is made, on the way
/// around the face.
struct IrregularVertexMask {
    double atVertex[6];      ///< of the F-vertex at V, for V, N, A, B, C, M
    double atNeighbor[6];    ///< of that at N, for N, A, B, C, M, V; at M the same the other way
    VertexVertexMask vertex; ///< of V' itself
};

/// \brief Returns the masks around a vertex inside the mesh with \p numFaces hexagons,
/// kMinIrregularFaces or more, after \p numSteps hexagonal steps, 1 or more; for less, those that many
/// steps lead to.
///
/// \param facesAround  what its faces were before these steps
///
/// With the mask of all hexagons curvature would grow there from level to level without bound, by
/// 1.14 with 4 faces and 1.32 with 6.  These keep the square of the sub-dominant eigenvalue as the
/// next one for 4 to 7 faces, so that it is bounded, and nearly do beyond: it grows by 1.08 at 8
/// and by 1.30 at 64.  Weights are not negative, linear functions are kept.
///
/// With C = cos(pi w/k), D = cos(2 pi w/k) and the weights nN of N, nA of A, nM of M in atNeighbor,
/// frequency w around k faces has as eigenvalues the roots x of
///
///     (x - 2 c1 C)(x^2 - nA^2) = 2 a2 (x (nN + nM D) + nA C (nN + nM))
///
/// where atVertex is (a, c1, a2, 0, a2, c1).  x = lambda at w = 1 and x = lambda^2 at w = 2 give c1
/// and a2, and the same for w = 0 the weight of V'.
///
/// Around a vertex the points of the first levels are uneven, and with four to eight faces the F-vertices
/// have other weights there, which make surfaces more even: three steps long with four quads, else two.
/// Searches found them (see docs/guide/masks.md); they have no bearing on the limit of curvature.
OPENSUBDIVHEX_API IrregularVertexMask ComputeIrregularVertexMask(
    int numFaces, int numSteps, FacesAround facesAround = FacesAround::Others);

/// \brief The masks of Smooth in quads, and in hexagons that share an edge with one.
///
/// Weights are in the order that the vertices have from the one whose F-vertex is made, on the way
/// around the face.
struct QuadMask {
    static constexpr int kNumRows = 2; ///< the most

    double inQuad[4]; ///< of the F-vertices of the quad
    /// The rows of \c beside that there are: 0 where all hexagons have the same mask.
    int numRows;
    /// Weights of the F-vertex of a hexagon at an end of the shared edge, along that edge first; and at a vertex
    /// that is one edge away from it, away from it first.
    double beside[kNumRows][6];
};

/// \brief Returns the masks in quads and beside them, after \p numSteps hexagonal steps.
///
/// They are those of ComputeFaceVertexMask() before the first step, and from kNumStepsToConstantMasks
/// steps on.  In between the points of quads are uneven, and a search found weights that make surfaces
/// more even, as those around vertices among quads.  Only after two steps
/// there is the second row.  Weights are not negative, linear functions are kept.
OPENSUBDIVHEX_API QuadMask ComputeQuadMask(int numSteps);

} // namespace OpenSubdivHex::FarExt

#endif

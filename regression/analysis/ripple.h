// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_ANALYSIS_RIPPLE_H
#define OPENSUBDIVHEX_REGRESSION_ANALYSIS_RIPPLE_H

#include "surfaceLevels.h"

#include "regression/shapes/featureShapes.h"

#include <vector>

namespace OpenSubdivHex::Regression {

enum class DiskPart { Whole, Half };

/// \brief A flat, open mesh of \p valence equal sectors around its vertex 0, at the origin: a regular
/// tiling with its edges of length 1, of which a vertex has been given other faces.
///
/// A sector is a quarter plane of quads, a sixth of triangles, a third of hexagons; its points keep
/// their distance from the origin, and their angle is scaled so that the sectors go around once.
///
/// \param numRings  of faces around the vertex
/// \param part      Half: the sectors go around half a turn, counter-clockwise from the x axis
Shape MakeVertexDisk(Tiling tiling, int valence, int numRings, DiskPart part = DiskPart::Whole);

/// The vertices of \p mesh in a ring around the z axis: between the distances 2^-ring and 2^-(ring + 1), of which the
/// larger counts as outside.
///
/// \throws std::runtime_error  where there are none
std::vector<int> FindRing(PolygonMesh const &mesh, int ring);

/// The function that lifts the control points of a mesh: x^2 + y^2, or x^2 - y^2.
enum class Quadratic { Elliptic, Hyperbolic };

/// \brief How uneven curvature is around a vertex of \p valence, ring by ring.
///
/// The control mesh is a MakeVertexDisk whose points are lifted, by very little, to a quadratic of
/// which curvature is the same everywhere: mean curvature of the elliptic one, Gaussian curvature of
/// the hyperbolic one.  Ripple is the root of the mean square, by area, by which this curvature of
/// the refined mesh deviates from its mean over a ring, divided by the modulus of that mean.  What
/// grows toward the vertex alike in all directions shows from ring to ring and is no ripple but
/// within a ring.
///
/// \param tiling  the faces of the control mesh; Loop takes triangles alone
/// \param level   of the refined mesh; the rings need about three more than they are
/// \throws std::runtime_error  for a ring without vertices, and as RefineSurface
/// \return        by ring, the outermost first: ring i lies between the distances 2^-i and 2^-(i + 1)
///                from the vertex, in edges of the control mesh
std::vector<double> MeasureRipple(Tiling tiling, int valence, AnyScheme const &scheme,
                                  Quadratic quadratic, int numRings, int level);

} // namespace OpenSubdivHex::Regression

#endif

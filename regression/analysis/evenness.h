// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_ANALYSIS_EVENNESS_H
#define OPENSUBDIVHEX_REGRESSION_ANALYSIS_EVENNESS_H

#include "surfaceLevels.h"

#include "regression/shapes/torus.h"

#include <vector>

namespace OpenSubdivHex::Regression {

enum class Curvature { Mean, Gaussian };

/// \brief How even a curvature of a surface is where it should be the same: the root of the mean
/// square by which it deviates from its mean, over that mean.  By area.
///
/// \param vertices  those that are looked at
/// \param groups    by entry of \p vertices: deviations are from the mean of the same group.  The
///                  modulus of the mean of all is what they are divided by
double MeasureUnevenness(PolygonMesh const &mesh, std::vector<int> const &vertices,
                         std::vector<int> const &groups, Curvature curvature = Curvature::Mean);

/// The deviations whose norm that is, by entry of \p vertices.
Eigen::VectorXd MeasureDeviations(PolygonMesh const &mesh, std::vector<int> const &vertices,
                                  std::vector<int> const &groups, Curvature curvature);

/// By vertex: its part of the areas of its faces.
std::vector<double> ComputeVertexAreas(PolygonMesh const &mesh);

/// Over the whole of \p mesh, as of a sphere.
double MeasureSphereUnevenness(PolygonMesh const &mesh);

/// Vertices of a mesh, and the group that each is in.
struct VertexGroups {
    std::vector<int> vertices;
    std::vector<int> groups;
};

/// The vertices of a refined MakeTorus(numU, ...) that MeasureTorusUnevenness measures.
VertexGroups FindTorusSector(PolygonMesh const &mesh, int numU);

/// The vertices beside a line around the axis that MeasureTorusStrips() measures in its strip \p strip.
VertexGroups FindTorusStrip(PolygonMesh const &mesh, int numU, double line, double rowWidth,
                            int strip);

/// \brief Within the parallels of a refined MakeTorus(numU, ...): over one of the \p numU sectors
/// that look alike, in groups of the same angle around the tube, 128 to a turn.
double MeasureTorusUnevenness(PolygonMesh const &mesh, int numU);

/// \brief Measures unevenness beside a sharp line that runs around the axis: for some consecutive strips,
/// each as wide as a row of faces of the control mesh.
///
/// The first strip begins at an eighth of a row from the line, so that curvature is not estimated
/// across it.
///
/// \param line      the angle of the line's vertices around the tube, in turns; the line itself is a
///                  cubic spline over them, nearer to the axis
/// \param rowWidth  of a row, in turns; negative where strips follow one another backwards
std::vector<double> MeasureTorusStrips(PolygonMesh const &mesh, int numU, double line,
                                       double rowWidth, int numStrips);

/// MakeTorus() with an infinitely sharp crease around the axis, along the outermost line.
Shape MakeCreasedTorus(int numU, int numV, TorusFaces faces);

/// MakeTorus() without the row of faces above the outermost line, which is a border then.
Shape MakeOpenTorus(int numU, int numV, TorusFaces faces);

/// The regular tetrahedron, octahedron and icosahedron: triangles, 3, 4 and 5 at a vertex.
std::vector<Shape> MakeTrianglePlatonics();

/// \brief \p numPoints points on a sphere that keep away from each other, and their hull of
/// triangles: most vertices have six of them, some five or seven.
///
/// \param numSteps  of relaxation; with few, the points are less even and valences spread
Shape MakeSphereHull(int numPoints, int numSteps);

/// Three quads of each triangle of \p shape, or four of each quad, with their vertices on the unit sphere.
Shape MakeSphereOfQuads(Shape const &shape);

} // namespace OpenSubdivHex::Regression

#endif

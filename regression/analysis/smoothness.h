// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_ANALYSIS_SMOOTHNESS_H
#define OPENSUBDIVHEX_REGRESSION_ANALYSIS_SMOOTHNESS_H

#include "localSubdivision.h"
#include "surfaceLevels.h"

#include <array>
#include <vector>

namespace OpenSubdivHex::Regression {

/// \brief How far a mesh is from smooth.
struct Smoothness {
    /// The largest angle between the normals of faces that share an edge, in radians.
    double maxNormalAngle = 0;
    /// The largest such angle by the distance of the faces' centroids: curvature across an edge.
    double maxCurvature = 0;
};

/// Measures all interior edges of \p mesh.  A face's normal is that of its vector area.
Smoothness MeasureSmoothness(PolygonMesh const &mesh);

/// The vertices of the faces that touch \p vertex or a neighbour of it, \p vertex first.
std::vector<int> FindNearVertices(PolygonMesh const &mesh, int vertex);

/// \brief The principal curvatures of a mesh near one of its vertices, the smaller first.
///
/// Principal curvatures at the vertex of the quadratic that fits the FindNearVertices() best, over the plane through
/// the vertex whose normal is the mean of its faces' normals.
std::array<double, 2> EstimateCurvatures(PolygonMesh const &mesh, int vertex);

/// \brief The largest modulus of a principal curvature at the vertices of the faces that touch the
/// center, those at the center included.
double MeasureCurvature(PolygonMesh const &mesh, MeshCenter center);

/// The faces of a neighbourhood as a mesh with the positions \p map, one per vertex, in the plane
/// z = 0; without edges.
PolygonMesh MakePlanarMesh(LocalSubdivision const &subdivision, Eigen::VectorXcd const &map);

/// \brief The largest modulus of a principal curvature at the center of a neighbourhood, in it and
/// after each of \p numSteps steps: as MeasureCurvature, of the vertices at the center alone, but
/// many more levels than a mesh can have.
///
/// The neighbourhood begins as a flat bowl and saddle over its characteristic map z, of height
/// h (|z|^2 + Re z^2); curvatures are divided by h.  Up to about 18 steps they are well above
/// rounding.
std::vector<double> TraceCurvature(LocalSubdivision const &subdivision, int numSteps);

} // namespace OpenSubdivHex::Regression

#endif

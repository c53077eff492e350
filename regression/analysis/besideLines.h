// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_ANALYSIS_BESIDE_LINES_H
#define OPENSUBDIVHEX_REGRESSION_ANALYSIS_BESIDE_LINES_H

#include "surfaceLevels.h"

#include "regression/shapes/featureShapes.h"

#include <vector>

namespace OpenSubdivHex::Regression {

/// \brief An open tube of radius 1 around the z axis, from z = 0 upward: \p numAround quads around the axis, in
/// \p numRows rows.
///
/// \param rowHeight  of a row, as a part of the width of its quads
Shape MakeTube(int numAround, int numRows, double rowHeight);

/// \brief How much a border bends a refined MakeTube(): the mean curvature of its surface over that of a cylinder, by
/// quarter rows from the border on.  1 where the border bends nothing.
///
/// The cylinder is, for each vertex, the one around the axis that it lies on.  Vertices nearer to the border than a
/// fiftieth of a row do not count, since their curvature is estimated from one side.
///
/// \param rowHeight    of a row of the control mesh, in units of z
/// \param numQuarters  that are looked at
std::vector<double> MeasureTube(PolygonMesh const &mesh, double rowHeight, int numQuarters);

/// The height of a row of MakeTube(), in units of z.
double GetTubeRowHeight(int numAround, double rowHeight);

/// \brief Half of a disk, as MakeVertexDisk() makes it, around a border vertex with \p numFaces faces, with its border along
/// the x axis.
///
/// Its points are lifted, by very little, to x^2, so that mean curvature should be the same everywhere.
Shape MakeHalfDisk(Tiling tiling, int numFaces);

/// \brief How uneven mean curvature of a refined MakeHalfDisk() is, by ring: ring i lies between the distances 2^-i and
/// 2^-(i + 1) from the vertex, as of MeasureRipple().
///
/// \throws std::runtime_error  for a ring without vertices
std::vector<double> MeasureHalfDisk(PolygonMesh const &mesh, int numRings);
/// Overload for MakeHalfDisk() refined to \p level, with its border as VTX_BOUNDARY_EDGE_ONLY has it.
std::vector<double> MeasureHalfDisk(Tiling tiling, int numFaces, AnyScheme const &scheme,
                                    int numRings, int level);

} // namespace OpenSubdivHex::Regression

#endif

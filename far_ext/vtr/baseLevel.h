// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_BASE_LEVEL_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_BASE_LEVEL_H

#include "corners.h"

namespace OpenSubdivHex::FarExt::internal {

/// \brief The sides of an edge of level 0, each by the corner where its face begins to run along
/// the edge.  A boundary edge has a BoundaryKind in place of the second corner.
struct EdgeSides {
    Far::Index corners[2];
};

/// \brief Derives all relations of \p level from its faces (numVertices, numFaces, numCorners,
/// faceFirstCorner and faceVerts, which the caller has filled) and from its edges.
///
/// Every corner is a side of exactly one edge; a B boundary is edge 0 of its face.  The faces of a
/// vertex are joined to fans across interior edges; edges that are joined nowhere else may share
/// both vertices.
///
/// \return  the vertices with several fans, ascending
std::vector<Far::Index> BuildBaseLevel(OpenSubdiv::Vtr::ConstArray<EdgeSides> edges, Level &level);

/// \brief The last step of it: derives the relations of vertices from all those of faces and edges,
/// with boundaryEdges, and from \p corners.
std::vector<Far::Index> FinishBaseLevel(Corners const &corners, Level &level);

/// Variant for vertFaces with the corners of the faces, in order but at corners.oddVerts, and with the first
/// side of each edge at the lower corner.
std::vector<Far::Index> FinishOrderedLevel(Corners const &corners, Level &level);

/// \brief Begins the relations of vertices: finds vertFirstEdge, where the relations of faces and edges, with
/// boundaryEdges, and vertFirstFace are there, and room for those of vertices.
void BeginVertices(Level &level);

/// \brief Finds the sizes of the faces of \p level that occur.
void FindFaceSizes(Level &level);

/// \brief The last step of a level without full topology: leaves no relation of a refinement before.
void FinishFaces(Level &level);

} // namespace OpenSubdivHex::FarExt::internal

#endif

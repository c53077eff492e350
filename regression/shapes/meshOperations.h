// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_SHAPES_MESH_OPERATIONS_H
#define OPENSUBDIVHEX_REGRESSION_SHAPES_MESH_OPERATIONS_H

#include "shapes.h"

namespace OpenSubdivHex::Regression {

/// \brief Operations on shapes that make other shapes; the names are Conway's.
/// Only positions and faces are made; tags do not carry over.
/// @{

/// One vertex per face, one face per vertex of the closed \p shape.
Shape MakeDual(std::string name, Shape const &shape);

/// Cuts the corners of the closed \p shape: n-gons become 2n-gons, vertices faces.
Shape MakeTruncated(std::string name, Shape const &shape);

/// Cuts the edges of the closed \p shape: a smaller copy of each face, a hexagon for each edge.
Shape MakeChamfered(std::string name, Shape const &shape);

/// A quad for each corner of the closed \p shape, from the corner to the middles of the edges and the centre of the face.
Shape MakeOrtho(std::string name, Shape const &shape);

/// Both shapes in one, \p second moved by \p offset along x.
Shape MakeUnion(std::string name, Shape const &first, Shape const &second, double offset);

/// Gives each fan of faces at a vertex a vertex of its own, in place of one that they share.
Shape MakeSplit(std::string name, Shape const &shape);
/// @}

/// The number of edges with a face on one side only.
int CountBoundaryEdges(Shape const &shape);

/// Whether no two faces run an edge the same way and the faces of each vertex form one fan.
bool IsManifold(Shape const &shape);

/// Moves the positions by a smooth map without symmetries, close enough to the identity to keep
/// closed shapes free of folds.
void Deform(Shape &shape);

} // namespace OpenSubdivHex::Regression

#endif

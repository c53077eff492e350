// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_LEVEL_TOPOLOGY_H
#define OPENSUBDIVHEX_FAR_EXT_LEVEL_TOPOLOGY_H

#include "buffer.h"
#include "indexing.h"

namespace OpenSubdivHex::FarExt::internal {

/// \brief The arrays of one level.  TopologyLevel is the public view of them.
///
/// Invariants of every level, level 0 included:
///  - a face's vertices run in its orientation; its edge i joins its vertices i and i + 1;
///  - an edge's first face runs from the edge's first vertex to its second, the other face back;
///    a boundary edge has INDEX_INVALID in place of the second face;
///  - the edges and faces of a vertex are in counter-clockwise order: face i lies between edges i
///    and i + 1; at a boundary vertex the first and the last edge are boundaries.
struct LevelTopology {
    using Index = Far::Index;
    using LocalIndex = Far::LocalIndex;

    HexIndexing ChildIndexing() const {
        return HexIndexing(numVertices, numEdges, numFaces, numCorners);
    }

    /// Empties all relations but the face-vertices.
    void ClearRelations() {
        hasFullTopology = false;
        for (Buffer<Index> *array : {&faceEdges, &edgeVerts, &edgeFaces, &boundaryEdges,
                                     &vertFirstFace, &vertFaces, &vertFirstEdge, &vertEdges}) {
            array->Resize(0);
        }
        for (Buffer<LocalIndex> *array : {&edgeFaceLocals, &vertFaceLocals, &vertEdgeLocals}) {
            array->Resize(0);
        }
    }

    int depth = 0;
    LevelTopology const *parent = nullptr;
    LevelTopology const *child = nullptr;

    Index numVertices = 0;
    Index numEdges = 0;
    Index numFaces = 0;
    Index numCorners = 0;       ///< entries of faceVerts
    Index numBoundaryEdges = 0; ///< edges with one face

    /// False when only the face-vertices were made (the last level, unless asked for more).
    bool hasFullTopology = false;

    Buffer<Index> faceFirstCorner; ///< numFaces + 1 positions in faceVerts and faceEdges
    Buffer<Index> faceVerts;       ///< numCorners
    Buffer<Index> faceEdges;       ///< numCorners

    Buffer<Index> edgeVerts;           ///< 2 per edge
    Buffer<Index> edgeFaces;           ///< 2 per edge
    Buffer<LocalIndex> edgeFaceLocals; ///< 2 per edge: the edge's place in each face
    Buffer<Index> boundaryEdges;       ///< numBoundaryEdges, ascending

    Buffer<Index> vertFirstFace; ///< numVertices + 1 positions in vertFaces, vertFaceLocals
    Buffer<Index> vertFaces;
    Buffer<LocalIndex> vertFaceLocals; ///< the vertex's place in each of its faces
    Buffer<Index> vertFirstEdge;       ///< numVertices + 1 positions in vertEdges, vertEdgeLocals
    Buffer<Index> vertEdges;
    Buffer<LocalIndex> vertEdgeLocals; ///< 0 or 1: the vertex's place in each of its edges

    Buffer<Index> faceChildFaces; ///< numFaces, of a level that was refined
};

} // namespace OpenSubdivHex::FarExt::internal

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_TOPOLOGY_LEVEL_H
#define OPENSUBDIVHEX_FAR_EXT_TOPOLOGY_LEVEL_H

#include "levelTopology.h"

#include <opensubdiv/sdc/crease.h>

namespace OpenSubdivHex {

namespace Sdc = OpenSubdiv::Sdc;

namespace FarExt {

/// \brief What a face of a refined level was made from.
enum class FaceKind {
    Base, ///< a face of level 0
    Face, ///< F-face: the smaller copy of a parent face, with as many sides
    Edge  ///< E-face: the hexagon of a parent edge (a quad along a boundary)
};

/// \brief Read access to one level of a refined mesh, with the names and types of
/// Far::TopologyLevel, so that templates written for Far's levels take it.
///
/// Owned by a TopologyRefiner; references hold until the refiner refines again or is destroyed.
/// INDEXING.md states the numbering and the order inside each relation.
///
/// The last level has only face-vertices unless UniformOptions::fullTopologyInLastLevel was set:
/// its other relations are then empty arrays and its edge and vertex queries are not answered
/// (HasFullTopology() tells).
class TopologyLevel {
public:
    using Index = Far::Index;
    using ConstIndexArray = Far::ConstIndexArray;
    using ConstLocalIndexArray = Far::ConstLocalIndexArray;

    explicit TopologyLevel(internal::LevelTopology const *topology) : _topology(topology) {}

    /// @name Inventory
    /// @{
    int GetNumVertices() const { return _topology->numVertices; }
    int GetNumFaces() const { return _topology->numFaces; }
    int GetNumEdges() const { return _topology->numEdges; }
    /// Sum of all face sizes: the number of corners.
    int GetNumFaceVertices() const { return _topology->numCorners; }
    /// Edges with one face.
    int GetNumBoundaryEdges() const { return _topology->numBoundaryEdges; }
    /// Depth of this level; 0 is the base.
    int GetDepth() const { return _topology->depth; }
    /// Whether all relations are there, not face-vertices alone.
    bool HasFullTopology() const { return _topology->hasFullTopology; }
    /// @}

    /// @name Incident components and their local indices, as in Far::TopologyLevel
    /// @{
    ConstIndexArray GetFaceVertices(Index f) const { return span(_topology->faceVerts, _topology->faceFirstCorner, f); }
    ConstIndexArray GetFaceEdges(Index f) const { return span(_topology->faceEdges, _topology->faceFirstCorner, f); }
    /// The first face of the edge runs from the first vertex to the second.
    ConstIndexArray GetEdgeVertices(Index e) const;
    ConstIndexArray GetEdgeFaces(Index e) const;
    ConstIndexArray GetVertexFaces(Index v) const;
    ConstIndexArray GetVertexEdges(Index v) const;
    ConstLocalIndexArray GetVertexFaceLocalIndices(Index v) const;
    ConstLocalIndexArray GetVertexEdgeLocalIndices(Index v) const;
    ConstLocalIndexArray GetEdgeFaceLocalIndices(Index e) const;
    /// The edge between two vertices, or INDEX_INVALID.
    Index FindEdge(Index v0, Index v1) const;
    /// Position of the face's first vertex in the level's array of all face-vertices.
    Index GetFaceFirstCorner(Index f) const { return _topology->faceFirstCorner[f]; }
    /// The corner (position in the array of all face-vertices) of a vertex in its i'th face.
    Index GetVertexCorner(Index v, int i) const {
        Index const k = _topology->vertFirstFace[v] + i;
        return GetFaceFirstCorner(_topology->vertFaces[k]) + _topology->vertFaceLocals[k];
    }
    /// @}

    /// @name Topological properties, as in Far::TopologyLevel
    /// @{
    bool IsEdgeNonManifold(Index) const { return false; }
    bool IsVertexNonManifold(Index) const { return false; }
    bool IsEdgeBoundary(Index e) const;
    bool IsVertexBoundary(Index v) const;
    /// Whether the vertex has exactly one face.
    bool IsVertexCorner(Index v) const { return GetVertexFaces(v).size() == 1; }
    /// Regular is three faces in the interior, as in the hexagonal lattice, and one or two at a
    /// boundary.
    bool IsVertexValenceRegular(Index v) const;
    /// @}

    /// @name Relations between levels
    /// @{
    /// How the face was made.
    FaceKind GetFaceKind(Index f) const;
    /// The face of level 0 that this face lies in; for an E-face, that of the first face of its
    /// parent edge.
    Index GetFaceBaseFace(Index f) const;
    /// The parent face of an F-face; for an E-face, the first face of its parent edge.
    Index GetFaceParentFace(Index f) const;
    /// The parent edge of an E-face, INDEX_INVALID for other faces.
    Index GetFaceParentEdge(Index f) const;

    /// The numbering of the next level, made or not.
    HexIndexing GetChildIndexing() const { return _topology->ChildIndexing(); }

    /// The F-face of a face: one element.  Empty in a level that was not refined, as are the
    /// relations below.
    ConstIndexArray GetFaceChildFaces(Index f) const;
    /// The F-vertices of a face, in the order of its vertices.
    ConstIndexArray GetFaceChildVertices(Index f) const;
    /// The edges of the F-face, in the order of its vertices.
    ConstIndexArray GetFaceChildEdges(Index f) const;
    /// The child edge of a boundary edge; interior edges have none.
    ConstIndexArray GetEdgeChildEdges(Index e) const;
    /// The E-face of an edge.
    Index GetEdgeChildFace(Index e) const;
    /// The V-vertex of a vertex.
    Index GetVertexChildVertex(Index v) const;
    /// INDEX_INVALID: a face has one child vertex per corner (GetFaceChildVertices) ...
    Index GetFaceChildVertex(Index) const { return Far::INDEX_INVALID; }
    /// ... and an edge has none.
    Index GetEdgeChildVertex(Index) const { return Far::INDEX_INVALID; }
    /// @}

    /// \brief Checks every invariant of the level by direct search, the order around vertices and
    /// the relation to the parent level included.
    ///
    /// \return  whether all hold; \p status names the first component that breaks one.
    bool Validate(Status *status = nullptr) const;

private:
    template <typename T>
    using View = OpenSubdiv::Vtr::ConstArray<T>;

    /// The part of \p array that the offsets \p first give to component \p i.
    template <typename T>
    static View<T> span(internal::Buffer<T> const &array, internal::Buffer<Index> const &first,
                        Index i) {
        return array.empty() ? View<T>()
                             : View<T>(array.data() + first[i], first[i + 1] - first[i]);
    }

    internal::LevelTopology const *_topology;
};

} // namespace FarExt
} // namespace OpenSubdivHex

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_TOPOLOGY_LEVEL_H
#define OPENSUBDIVHEX_FAR_EXT_TOPOLOGY_LEVEL_H

#include "indexing.h"

#include <opensubdiv/sdc/crease.h>
#include <opensubdiv/vtr/types.h>

namespace OpenSubdivHex::FarExt {

namespace internal {
struct Hierarchy;
struct Level;
struct Refinement;
struct FVarLevel;
} // namespace internal

/// \brief The component of the level before that made a face.
enum class FaceKind {
    Base,  ///< a face of level 0
    Face,  ///< F-face: the smaller copy of a parent face, with as many sides
    Edge,  ///< E-face: the hexagon of a parent edge (a quad along a boundary, or of a flat edge)
    Vertex ///< V-face: made for a parent vertex by a scheme or option that makes such faces
};

/// \brief Read access to one level of a refined mesh, with the names and types of
/// Far::TopologyLevel, so that templates written for Far's levels take it.
///
/// \code
///     FarExt::TopologyLevel const &level = refiner->GetLevel(3);
///     for (int face = 0; face < level.GetNumFaces(); ++face) {
///         Far::ConstIndexArray const vertices = level.GetFaceVertices(face); // mostly six
///     }
/// \endcode
///
/// Owned by a TopologyRefiner; references hold until the refiner refines again or is destroyed.
/// INDEXING.md states the numbering and the order inside each relation.
///
/// The last level has only face-vertices unless UniformOptions::fullTopologyInLastLevel was set:
/// its other relations are then empty arrays, and queries of edges and vertices, IsFaceHalf and the
/// face-varying match queries are not answered (HasFullTopology() tells).
class OPENSUBDIVHEX_API TopologyLevel {
public:
    /// A vertex, an edge, a face, a corner or a value.
    using Index = Far::Index;
    /// Indices in the memory of the level.
    using ConstIndexArray = Far::ConstIndexArray;
    /// Places within faces or edges, in the memory of the level.
    using ConstLocalIndexArray = Far::ConstLocalIndexArray;

    /// An array of one index, or of none.
    class ChildFaceArray {
    public:
        /// Has \p face, or is empty if \p face is INDEX_INVALID.
        explicit ChildFaceArray(Index face) : _face(face) {}

        /// 1 or 0.
        int size() const { return _face == Far::INDEX_INVALID ? 0 : 1; }
        /// Whether there is none.
        bool empty() const { return size() == 0; }
        /// The index.
        Index operator[](int) const { return _face; }
        /// The range, for loops.
        Index const *begin() const { return &_face; }
        /// Its end.
        Index const *end() const { return &_face + size(); }

    private:
        Index _face;
    };

    /// Level number \p depth of those of a refiner.
    TopologyLevel(internal::Hierarchy const &hierarchy, int depth);

    /// @name Inventory
    /// @{

    /// Vertices.
    int GetNumVertices() const { return _numVertices; }
    /// Faces, holes included.
    int GetNumFaces() const { return _numFaces; }
    /// Edges.
    int GetNumEdges() const { return _numEdges; }
    /// Sum of all face sizes: the number of corners.
    int GetNumFaceVertices() const { return _faceFirstCorner[_numFaces]; }
    /// Edges with one face.
    int GetNumBoundaryEdges() const;
    /// Depth of this level; 0 is the base.
    int GetDepth() const { return _depth; }
    /// Whether all relations are there, not face-vertices alone.
    bool HasFullTopology() const;
    /// @}

    /// @name Incident components and their local indices, as in Far::TopologyLevel
    /// @{

    /// The vertices of a face, in its orientation.
    ConstIndexArray GetFaceVertices(Index f) const {
        return {_faceVerts + _faceFirstCorner[f], _faceFirstCorner[f + 1] - _faceFirstCorner[f]};
    }
    /// The edges of a face; edge i joins its vertices i and i + 1.
    ConstIndexArray GetFaceEdges(Index f) const;
    /// The first face of the edge runs from the first vertex to the second.
    ConstIndexArray GetEdgeVertices(Index e) const;
    /// The one or two faces of an edge.
    ConstIndexArray GetEdgeFaces(Index e) const;
    /// The faces of a vertex, counter-clockwise, fan by fan.
    ConstIndexArray GetVertexFaces(Index v) const;
    /// The edges of a vertex, counter-clockwise, fan by fan.
    ConstIndexArray GetVertexEdges(Index v) const;
    /// Which vertex of each of its faces the vertex is.
    ConstLocalIndexArray GetVertexFaceLocalIndices(Index v) const;
    /// Which vertex of each of its edges the vertex is: 0 or 1.
    ConstLocalIndexArray GetVertexEdgeLocalIndices(Index v) const;
    /// Which edge of each of its faces the edge is.
    ConstLocalIndexArray GetEdgeFaceLocalIndices(Index e) const;
    /// The edge between two vertices, or INDEX_INVALID.
    Index FindEdge(Index v0, Index v1) const;
    /// Position of the face's first vertex in the level's array of all face-vertices.
    Index GetFaceFirstCorner(Index f) const { return _faceFirstCorner[f]; }
    /// The corner (position in the array of all face-vertices) of a vertex in its i'th face.
    Index GetVertexCorner(Index v, int i) const;
    /// @}

    /// @name Whole relations, for those who hand them on without a copy
    /// Valid as long as the level.  Without full topology those of edges and vertices are empty.
    /// @{

    /// GetNumFaces() + 1 positions: the vertices of face f are the elements
    /// [offsets[f], offsets[f + 1]) of GetAllFaceVertices(), and likewise its edges.
    ConstIndexArray GetFaceOffsets() const { return {_faceFirstCorner, _numFaces + 1}; }
    /// The vertices of all faces: GetNumFaceVertices() elements.
    ConstIndexArray GetAllFaceVertices() const { return {_faceVerts, GetNumFaceVertices()}; }
    /// The edges of all faces: GetNumFaceVertices() elements.
    ConstIndexArray GetAllFaceEdges() const;
    /// The vertices of all edges: two elements for each.
    ConstIndexArray GetAllEdgeVertices() const;
    /// The faces of all edges: two elements for each; the second of a boundary edge is negative.
    ConstIndexArray GetAllEdgeFaces() const;
    /// GetNumVertices() + 1 positions in GetAllVertexFaces().
    ConstIndexArray GetVertexFaceOffsets() const;
    /// The faces of all vertices: GetNumFaceVertices() elements.
    ConstIndexArray GetAllVertexFaces() const;
    /// GetNumVertices() + 1 positions in GetAllVertexEdges().
    ConstIndexArray GetVertexEdgeOffsets() const;
    /// The edges of all vertices: 2 GetNumEdges() elements.
    ConstIndexArray GetAllVertexEdges() const;
    /// @}

    /// @name Topological properties, as in Far::TopologyLevel
    /// @{

    /// Whether the edge, of level 0, had neither one face nor two of the same orientation.  Such an edge comes apart into
    /// one boundary edge for each face: INDEXING.md.
    bool IsEdgeNonManifold(Index e) const;
    /// Whether the faces of the vertex form more than one fan, or it lies on a non-manifold edge.
    bool IsVertexNonManifold(Index v) const;
    /// Whether the edge has one face.
    bool IsEdgeBoundary(Index e) const;
    /// Whether the vertex lies on a boundary edge.
    bool IsVertexBoundary(Index v) const;
    /// Whether the vertex has exactly one face.
    bool IsVertexCorner(Index v) const { return GetVertexFaces(v).size() == 1; }
    /// Regular is three faces in the interior, as in the hexagonal lattice, and one or two at a
    /// boundary.
    bool IsVertexValenceRegular(Index v) const;
    /// @}

    /// @name Tags, as in Far::TopologyLevel
    /// @{

    /// Sharpness of the edge at this level; infinite for sharp boundaries, 0 for those that follow
    /// the paper's rule (VTX_BOUNDARY_NONE).
    float GetEdgeSharpness(Index e) const;
    /// Sharpness of the vertex at this level, as a corner.
    float GetVertexSharpness(Index v) const;
    /// Whether the sharpness of the edge is infinite.
    bool IsEdgeInfSharp(Index e) const { return Sdc::Crease::IsInfinite(GetEdgeSharpness(e)); }
    /// Whether the sharpness of the edge is above 0 and finite.
    bool IsEdgeSemiSharp(Index e) const { return Sdc::Crease::IsSemiSharp(GetEdgeSharpness(e)); }
    /// Whether the sharpness of the vertex is infinite.
    bool IsVertexInfSharp(Index v) const { return Sdc::Crease::IsInfinite(GetVertexSharpness(v)); }
    /// Whether the sharpness of the vertex is above 0 and finite.
    bool IsVertexSemiSharp(Index v) const {
        return Sdc::Crease::IsSemiSharp(GetVertexSharpness(v));
    }
    /// Whether all of the face lies in faces of level 0 that are holes.
    bool IsFaceHole(Index f) const;
    /// Whether half 0 or 1 of the face does, as in GetFaceBaseFace.  A hexagon with one half in a hole
    /// is drawn as the other half.
    bool IsFaceHole(Index f, int half) const;
    /// The rule that moves the vertex to the next level.  At a free boundary it is RULE_SMOOTH.
    Sdc::Crease::Rule GetVertexRule(Index v) const;

    /// Sharpness of the crease that crosses the face, along a diagonal; 0 where none does.
    float GetFaceDiagonalSharpness(Index f) const;
    /// The vertex of the face where a diagonal ends which begins at vertex 0, be it a crease, a seam or between
    /// base faces: 3, but for faces that a truncation made of a vertex which a crease passes.
    int GetFaceDiagonalEnd(Index f) const;
    /// Whether the face is half a polygon, mostly half a hexagon, cut by a sharp boundary along its edge 0.
    bool IsFaceHalf(Index f) const;
    /// @}

    /// @name Face-varying data, as in Far::TopologyLevel
    /// @{

    /// Face-varying channels of the mesh.
    int GetNumFVarChannels() const;
    /// Values of a channel at this level.
    int GetNumFVarValues(int channel = 0) const;
    /// The values of a face, by corner.  Of a face that a seam crosses, the two corners on the seam
    /// have a value to either side; those of the first half are given here.
    ConstIndexArray GetFaceFVarValues(Index f, int channel = 0) const;
    /// Whether a seam crosses the face, from its vertex 0 to GetFaceDiagonalEnd().
    bool IsFaceFVarSplit(Index f, int channel = 0) const;
    /// The values of half 0 or 1 of a face that a seam crosses, in the order of GetPlaceInHalves(): of a hexagon for the
    /// vertices 0, 3, 4, 5 of the face or 3, 0, 1, 2.
    ConstIndexArray GetFaceFVarValues(Index f, int channel, int half) const;
    /// Whether the values on both sides of the edge are the same.
    bool DoesEdgeFVarTopologyMatch(Index e, int channel = 0) const;
    /// Whether all faces around a vertex have one value there.
    bool DoesVertexFVarTopologyMatch(Index v, int channel = 0) const;
    /// Whether each vertex of a face has one value in all faces around it.
    bool DoesFaceFVarTopologyMatch(Index f, int channel = 0) const;
    /// @}

    /// @name Relations between levels
    /// @{

    /// How the face was made.
    FaceKind GetFaceKind(Index f) const;
    /// \brief The face of level 0 in which a half of the face lies, exactly.
    ///
    /// Vertices persist, so that an edge of level 0 becomes a polyline of the edges and the diagonals
    /// of hexagons, from vertex 0 to vertex 3, of every level, and the faces and halves of hexagons
    /// between these are the region of a base face.  A hexagon that is not cut in its drawing counts
    /// to the base face of half 0.
    ///
    /// Quads of flat edges (RefineCoplanar, Doo-Sabin) and V-faces lie across such polylines, and
    /// count to the first base face: that of the first face of the quad's edge, that around the last
    /// F-vertex of the V-face.  Behind a truncation the V-faces of level 1 alone do, and
    /// UniformOptions::faceLabels keep them in base faces of one label.
    ///
    /// Closed form, without memory; the time is proportional to the depth.  BaseFaceMap has those of
    /// all faces.
    ///
    /// \param half  0 or 1, as in kHexagonHalves; both are the same for a face in one base face
    Index GetFaceBaseFace(Index f, int half = 0) const;
    /// Whether the halves of the face lie in two faces of level 0.
    bool IsFaceBaseSplit(Index f) const;

    /// \brief Coordinates of the face's vertices in a plane of its base face, for textures and pictures.
    ///
    /// The plane has edge 0 of the base face from (0, 0) to (1, 0), and the face to its left: a quad is the unit
    /// square, a triangle has its third vertex at (0, 1), and others are regular polygons.  V-vertices stay, and
    /// an F-vertex is
    /// the middle between its vertex and the centre: of the base face that of the polygon, of half a
    /// hexagon the middle of its long edge; so the children of each are affine images of it or of
    /// its halves, and tile it.  (Of a quad at a boundary that follows the paper's rule the centre is
    /// the mean of its vertices.)  The coordinates of a vertex are the same, to the bit, from all
    /// faces of the base face and at all levels; those of a closed mesh's quads are multiples of
    /// 2^-(depth + 2), and exact.
    ///
    /// \param half  of a face with two base faces, the half that is meant
    /// \param uv    gets u and v of each vertex: of the face or, when it has two base faces, of the
    ///              half, in the order of GetPlaceInHalves()
    /// \return      false, and \p uv is not written, behind a FirstStep and behind all other steps that are not hexagonal
    bool GetFaceBaseCoords(Index f, int half, float *uv) const;
    /// \copydoc GetFaceBaseCoords(Index, int, float *) const
    bool GetFaceBaseCoords(Index f, int half, double *uv) const;

    /// \brief The face of the surface level (HexSchemeOptions::GetSurfaceLevel()) that the face lies
    /// in, or the half of one that is cut, as numbered by SurfaceFaces: a BfrExt::SurfaceFactory has its surface.  Without a
    /// first step that is the base face.
    ///
    /// \param half  0 or 1, as in GetPlaceInHalves(); both are the same for a face in one such face
    /// \return      INDEX_INVALID before the surface level, and where not all steps behind it are
    ///              hexagonal
    Index GetFaceSurfaceFace(Index f, int half = 0) const;
    /// \brief (u, v) of the face's vertices in that face: where its surface has their limits.
    ///
    /// The coordinates are those of Bfr::Parameterization.  In triangles and quads they equal GetFaceBaseCoords() in that
    /// face.  Other faces have a sub-face for each corner, the kite of the corner, the middles of two edges and the centre,
    /// in which coordinates are bilinear.  A point between two sub-faces is in the second of them.
    ///
    /// \param half  of a face that lies in two, the half that is meant
    /// \param uv    gets u and v of each vertex, in the order of GetFaceBaseCoords()
    /// \return      false, and \p uv is not written, where there is no such face
    bool GetFaceSurfaceCoords(Index f, int half, float *uv) const;
    /// \copydoc GetFaceSurfaceCoords(Index, int, float *) const
    bool GetFaceSurfaceCoords(Index f, int half, double *uv) const;

    /// The parent face of an F-face; for an E-face, the first face of its parent edge; for a
    /// V-face, that of its last F-vertex.
    Index GetFaceParentFace(Index f) const;
    /// The parent edge of an E-face, INDEX_INVALID for other faces.
    Index GetFaceParentEdge(Index f) const;
    /// The parent vertex of a V-face, INDEX_INVALID for other faces.
    Index GetFaceParentVertex(Index f) const;

    /// The numbering of the next level, made or not, when the hexagonal step makes it.
    HexIndexing GetChildIndexing() const {
        return HexIndexing(_numVertices, _numFaces, GetNumFaceVertices());
    }

    /// The F-face of a face: one element.  Empty in a level that was not refined, as are the
    /// relations below.
    ChildFaceArray GetFaceChildFaces(Index f) const;
    /// The F-vertices of a face, in the order of its vertices; behind a truncation two for each: the
    /// one beside it on the edge that leads to the vertex, then the one on the edge that leads on.
    ConstIndexArray GetFaceChildVertices(Index f) const;
    /// The edges of the F-face, in the order of its vertices.
    ConstIndexArray GetFaceChildEdges(Index f) const;
    /// The edge of the E-face of a boundary edge that is on the boundary again; other edges have
    /// none, a B edge because its children belong to its vertices and its face.
    ConstIndexArray GetEdgeChildEdges(Index e) const;
    /// The E-face of an edge; INDEX_INVALID for one that makes none, as a B edge of a sharp
    /// boundary.
    Index GetEdgeChildFace(Index e) const;
    /// The V-vertex of a vertex; INDEX_INVALID for one that makes none.
    Index GetVertexChildVertex(Index v) const;
    /// INDEX_INVALID: a face has one child vertex per corner (GetFaceChildVertices) ...
    Index GetFaceChildVertex(Index) const { return Far::INDEX_INVALID; }
    /// ... and an edge has none.
    Index GetEdgeChildVertex(Index) const { return Far::INDEX_INVALID; }
    /// @}

    /// \brief Checks every invariant of the level's topology by direct search, the order around
    /// vertices and the relation to the parent level included, also of the face-varying channels.
    ///
    /// \return  whether all hold; \p status names the first component that breaks one.
    bool Validate(CallStatus *status = nullptr) const;

    /// The arrays of the level, for the library's own use.
    internal::Level const &GetLevel() const { return *_level; }
    /// All levels, for the library's own use.
    internal::Hierarchy const &GetHierarchy() const { return *_hierarchy; }

private:
    internal::Refinement const *refinementTo() const;
    internal::Refinement const *refinementFrom() const;
    internal::FVarLevel const &fvarLevel(int channel) const;

    internal::Hierarchy const *_hierarchy;
    internal::Level const *_level;
    int _depth;
    Index _numVertices;
    Index _numEdges;
    Index _numFaces;
    Index const *_faceFirstCorner;
    Index const *_faceVerts;
};

} // namespace OpenSubdivHex::FarExt

#endif

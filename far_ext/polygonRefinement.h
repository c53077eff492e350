// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_POLYGON_REFINEMENT_H
#define OPENSUBDIVHEX_FAR_EXT_POLYGON_REFINEMENT_H

#include "schemeOptions.h"
#include "topologyRefinement.h"
#include "vertexFan.h"

namespace OpenSubdivHex::FarExt::internal {

/// \brief Which polygons a step makes, beside the F-face of every face.
struct PolygonRules {
    SchemeType scheme = SchemeType::Hexagonal;
    /// Of Hexagonal, by edge: whether an interior edge makes a quad, of its F-vertices alone.
    /// Empty when none does.
    std::vector<unsigned char> flatEdges;
    /// Of Hexagonal: whether faces at the vertices close the gaps that quads leave.
    bool closeGaps = true;
};

struct FVarLevel;

/// The same rules for the value mesh of a channel of \p mesh; no seam is among the flat edges.
PolygonRules GetRulesOfChannel(LevelTopology const &mesh, PolygonRules const &rules,
                               FVarLevel const &channel);

/// \brief A step from a parent level to polygons of any kind: all but the plain hexagonal step,
/// which RefineTopology makes at once.
///
/// An interior edge makes a hexagon, a quad or, in tri-hex, no face; a boundary edge what it makes
/// in the hexagonal step and, in the other schemes, nothing.  At each vertex follow V-faces:
///  - Doo-Sabin: per closed fan of k faces the polygon of its k F-vertices;
///  - tri-hex: likewise, with two F-vertices of each face;
///  - hexagonal: per maximal run of quad edges the polygon of the V-vertex and the F-vertices of
///    the faces between which they run; with quads all around a vertex that of the F-vertices
///    alone, in place of the V-vertex.
/// Where it would have two vertices alone there is no V-face: the two quads share an edge.
///
/// The last vertex of a V-face is the F-vertex of a corner at its vertex.  INDEXING.md has the
/// numbering.
class PolygonStep {
public:
    /// Plans the step; \p parent is written by Refine alone.
    PolygonStep(LevelTopology &parent, PolygonRules rules, Sdc::Options sdcOptions);

    /// The sizes of the child; those of boundaries are left 0.
    LevelSizes GetSizes() const { return _sizes; }

    /// Makes \p child, whose sizes must fit 32 bits, as RefineTopology does.
    void Refine(bool fullTopology, LevelTopology &child);

private:
    using Index = Far::Index;
    class Builder;

    // The faces around a vertex that a V-face joins, as a range of _vFaceCorners.
    struct VFace {
        std::size_t firstCorner;
        Index vVertex; // in the polygon too, or INDEX_INVALID
    };

    bool isHexagonal() const { return _rules.scheme == SchemeType::Hexagonal; }
    bool isTriHex() const { return _rules.scheme == SchemeType::TriHex; }
    bool isQuad(Index pEdge) const;
    bool makesEFace(Index pEdge) const;
    Index inEdge(Index k) const {
        Index const corner = _parent.GetVertexCorner(k);
        return _parent.faceEdges[_parent.GetPrevCorner(_parent.vertFaces[k], corner)];
    }

    void planVertices();
    void planEdges();
    void addVFace(Index vVertex, VertexFan const &fan, Index begin, Index count);
    void planFan(Index pVert, VertexFan const &fan);
    void relateParent();
    void buildFaces(Builder &builder) const;
    void buildEFace(Index pEdge, Builder &builder) const;
    void buildVFace(VFace const &vFace, std::size_t endCorner, Builder &builder) const;
    void joinDigons();
    std::size_t endAt(Index startCorner) const;

    LevelTopology &_parent;
    PolygonRules const _rules;
    Sdc::Options const _sdcOptions;
    LevelSizes _sizes{};

    std::vector<Index> _vertChildVerts; // INDEX_INVALID when dropped
    std::vector<Index> _spokes;         // by corner, INDEX_INVALID when there is none
    /// By edge and end: the edge that joins the F-vertices of its faces there; in tri-hex one for
    /// both ends; of a boundary edge, first, the one that stays on the boundary.
    std::vector<Index> _endEdges;
    std::vector<std::pair<std::size_t, std::size_t>> _digons; ///< ends at vertices with two faces
    std::vector<VFace> _vFaces;
    std::vector<Index> _vFaceCorners; // counter-clockwise
};

} // namespace OpenSubdivHex::FarExt::internal

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_POLYGON_REFINEMENT_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_POLYGON_REFINEMENT_H

#include "childCounts.h"
#include "far_ext/hexSchemeOptions.h"
#include "refinement.h"
#include "vertexFan.h"

namespace OpenSubdivHex::FarExt::internal {

/// \brief Which polygons a refinement makes, beside the F-face of every face.
struct PolygonRules {
    StepType step = StepType::Hexagonal;
    /// For Truncate, by face of level 0: faces with other labels are kept apart.  Empty when all have
    /// the same.
    Far::ConstIndexArray faceLabels;
    /// For Hexagonal, by edge: whether an interior edge makes a quad of its F-vertices.
    /// Empty when none does.
    std::vector<unsigned char> flatEdges;
    /// For Hexagonal: whether faces at the vertices close the gaps that quads leave.
    bool closeGaps = true;
};

struct FVarLevel;

/// Rules for the value mesh of a channel of \p mesh; no seam is among the flat edges.
PolygonRules GetRulesOfChannel(Level const &mesh, PolygonRules const &rules,
                               FVarLevel const &channel);

/// \brief Makes refinements to polygons of any kind: all but the plain hexagonal one, which
/// RefineHexagonally makes at once.
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
///
/// The children of each component are counted first.  Then they are written to places that follow from the counts,
/// so that components can be taken in parallel.
class PolygonRefiner {
public:
    /// Counts what the refinement of \p parent, which it refers to, makes.
    PolygonRefiner(Level const &parent, PolygonRules rules, TagOptions tagOptions);

    LevelSizes GetSizes() const { return _sizes; }

    /// Makes \p child, whose sizes must fit 32 bits, as RefineHexagonally does.  Once.
    void Refine(bool fullTopology, Refinement &refinement, Level &child);

private:
    using Index = Far::Index;
    template <bool FULL>
    class Builder;

    /// Two ends of edges, as positions in _endEdges, at a vertex with two faces: the quads there
    /// share the edge of the first, which has the lower position.
    struct Digon {
        std::size_t end;
        std::size_t joinedEnd;
    };

    bool isHexagonal() const { return _rules.step == StepType::Hexagonal; }
    bool isTriHex() const { return _rules.step == StepType::TriHex; }
    bool isQuad(Index pEdge) const {
        return isHexagonal() ? !_rules.flatEdges.empty() && _rules.flatEdges[std::size_t(pEdge)]
                             : !isTriHex() && !_parent.IsBoundary(pEdge);
    }
    bool makesEFace(Index pEdge) const;
    bool makesVVertex(Index pVert) const;
    std::size_t findEnd(Index startCorner) const;
    /// The kind of edges without such a parent.
    BoundaryKind getBoundaryKind() const;

    template <typename ADD_VFACE, typename ADD_DIGON>
    void forEachVFace(Index pVert, bool hasVVertex, ADD_VFACE addVFace, ADD_DIGON addDigon) const;
    template <typename FUNCTION>
    void forEachRunOfQuads(VertexFan const &fan, FUNCTION function) const;
    template <typename FUNCTION>
    void forEachSpoke(Index beginFace, Index endFace, FUNCTION function) const;

    void countVertices();
    void findDigons();
    void markEndEdges();
    void countEdges();
    void countSpokes();
    void countBoundaries();
    void relate(Refinement &refinement) const;
    void numberEdges();

    Level const &_parent;
    PolygonRules const _rules;
    TagOptions const _tagOptions;
    LevelSizes _sizes{};

    // By range, the counts that the components before the range make.
    std::vector<ChildCounts> _vertexCounts; ///< V-vertices, V-faces and digons
    std::vector<ChildCounts> _edgeCounts;   ///< edges of _endEdges, E-faces
    std::vector<ChildCounts> _spokeCounts;  ///< spokes, by range of faces

    /// By edge and end: the edge that joins the F-vertices of its faces there; in tri-hex one for
    /// both ends; of a boundary edge, first, the one that stays on the boundary.
    Buffer<Index> _endEdges;
    std::vector<Digon> _digons; ///< by joinedEnd, ascending
    Buffer<Index> _spokes;      ///< by corner, INDEX_INVALID when there is none
};

} // namespace OpenSubdivHex::FarExt::internal

#endif

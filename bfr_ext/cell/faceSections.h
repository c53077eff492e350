// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_FACE_SECTIONS_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_FACE_SECTIONS_H

#include "cellMesh.h"

#include <cmath>
#include <memory>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// The levels of a face: those of its edges, then that of the inside.
struct FaceLevels {
    FaceShape shape;
    std::vector<int> levels;
};

/// The levels of the places of a face.
struct PlaceLevels {
    PlaceLevels() = default;
    explicit PlaceLevels(FaceLevels const &levels);
    /// \param edges  by edge of the face, with all points that the tree has there
    PlaceLevels(CellTree const &tree, std::vector<Polyline> const &edges);

    std::vector<int> ofEdges; ///< by edge, the level of which it has the polyline; -1: none
    int ofInside = 0;         ///< the highest
    int ofAll = 0;            ///< the highest, with those on the border
};

/// \brief A base face whose cells are too many to be made at once, cut into *sections*: cells with all
/// that they are refined to, each of which is tessellated by itself.
///
/// The sections are the cells of a coarse tree, whose mesh tells which vertices they share and where they
/// meet: each side of a section's polygon in that mesh is that of one other section, too, or lies on an
/// edge of the face.
class FaceSections {
public:
    /// \param maxLeaves  cells of a section that are not refined, where it can be cut
    FaceSections(FaceLevels const &levels, int maxLeaves);
    /// \param tree   must live as long
    /// \param edges  by edge of the face, in its direction; with all points that the tree has there
    FaceSections(CellTree const &tree, std::vector<Polyline> edges, int maxLeaves);

    FaceSections(FaceSections const &) = delete;
    FaceSections &operator=(FaceSections const &) = delete;

    /// How many cells are not refined where all have a level; at most so many where edges have others.
    static double CountLeaves(FaceShape shape, int level) {
        return level == 0 ? 1 : 1 + shape.GetNumSectors() * (std::ldexp(1.0, 2 * level) - 1) / 3;
    }

    FaceShape GetFaceShape() const { return _cells.GetFaceShape(); }
    int GetNumSections() const { return int(_sections.size()); }
    /// Levels of edges, then of the inside; empty for a tree.
    std::vector<int> const &GetLevels() const { return _levels; }
    /// Those of the whole face.
    PlaceLevels const &GetPlaceLevels() const { return _placeLevels; }
    /// The points of an edge of the face.
    Polyline const &GetEdge(int edge) const { return _edges[std::size_t(edge)]; }

    /// The vertices of the sections.
    std::vector<CellMesh::Vertex> const &GetVertices() const { return _mesh->GetVertices(); }
    /// Vertices of a section, counter-clockwise, with those that other sections have on its sides.
    std::vector<int> GetPolygon(int section) const {
        return _mesh->GetPolygon(_sections[std::size_t(section)]);
    }
    /// \brief The tree of the face as far as it tells what a section has: what is in the section, and all
    /// cells that have a point in common with it.
    ///
    /// \param shape  of the section in that tree
    CellTree MakeTree(int section, CellShape *shape) const;

    /// The edge of the face that a vertex lies on, and where; of a vertex of the face that which begins there.
    EdgePlace<int> FindEdge(CellMesh::Vertex const &vertex) const {
        EdgePlace<std::int32_t> const found = FindOnEdge(GetFaceShape(), vertex, CellShape::kOne);
        return {found.edge, found.end / (CellShape::kOne / Polyline::kLength)};
    }
    /// Whether the line from one vertex to the next of a polygon lies on an edge of the face: that of the
    /// first.
    bool AreOnEdge(CellMesh::Vertex const &start, CellMesh::Vertex const &end) const;
    /// The points of an edge before a place on it.
    int CountPointsBefore(EdgePlace<int> const &place) const;

private:
    template <typename COUNT>
    void cut(int maxLeaves, COUNT const &count);
    bool isRefined(CellTree const &tree, int cell, int wholeCell) const;
    int getWholeChild(int wholeCell, int child) const;

    std::vector<int> const _levels;
    CellTree const *const _tree; // null of levels
    PlaceLevels const _placeLevels;
    std::vector<Polyline> const _edges;
    CellTree _cells;
    std::vector<int> _parents; // by cell of these
    std::vector<CellShape> _sections;
    std::unique_ptr<CellMesh const> _mesh;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif

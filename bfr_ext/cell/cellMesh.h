// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_CELL_MESH_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_CELL_MESH_H

#include "cellShape.h"

#include <functional>
#include <unordered_map>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief A base face cut into the cells of a tree that are not refined further, in its plane.
///
/// A place is enough to know a vertex by, and cells that meet smaller ones find their vertices on their own
/// sides.
class CellMesh {
public:
    /// Coordinates in a sector, in units of 2^-kBits.
    using Place = CellShape::Place;
    /// A vertex, by the one name of its place, NameOf().
    using Vertex = SectorPlace<Place>;

    /// \param tree     must live as long
    /// \param edges    by edge of the face, in its direction; with all points that the tree has there
    /// \param section  the cell whose polygons are asked for, with what is in it
    CellMesh(CellTree const &tree, Polyline const edges[],
             CellShape const &section = CellShape::MakeFace());

    /// Vertices of coarser levels come first.
    std::vector<Vertex> const &GetVertices() const { return _verts; }
    /// The vertices of the face.
    std::vector<Vertex> GetFaceVertices() const {
        return {_verts.begin(), _verts.begin() + _shape.size};
    }
    /// The vertex at a place of a sector, or -1.
    int Find(int sector, Place const &place) const;
    /// Appends the vertices between two places of a side of a cell.
    void AppendBetween(int sector, Place const &start, Place const &end,
                       std::vector<int> &verts) const;
    /// The polygon of a cell that is not refined, with the vertices that others have on its sides.
    std::vector<int> GetPolygon(CellShape const &cell) const;

    /// A cell, or two halves of a hexagon: vertices, counter-clockwise, and the level.
    struct Polygon {
        std::vector<int> verts;
        int level;
    };
    /// \brief Calls function(polygon) for all cells, with the vertices that others have on their sides.
    void ForEachCell(std::function<void(Polygon &)> const &function) const;
    /// \brief Returns the polygons, with two halves of a hexagon merged into one where they share only the ends of
    /// its diagonal.
    std::vector<Polygon> GetMergedPolygons() const;

private:
    static std::uint64_t getKey(Vertex const &name);
    void add(Vertex const &place);
    template <typename FUNCTION>
    void visit(CellShape const &cell, int level, FUNCTION const &function) const;
    template <typename FUNCTION>
    void forEachCellByLevel(CellShape const &root, FUNCTION const &function) const;
    void setPolygon(CellShape const &cell, Polygon &polygon) const;

    CellTree const &_tree;
    FaceShape const _shape;
    int const _maxLevel;
    CellShape const _section;
    std::vector<Vertex> _verts;
    std::unordered_map<std::uint64_t, int> _numbers;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif

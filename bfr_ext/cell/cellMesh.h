// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_CELL_MESH_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_CELL_MESH_H

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief A base face cut into cells that are not refined further, in its parameter plane.
///
/// All lines are straight there: half cells are trapezoids, and what an edge becomes lies on it.  So a
/// place is enough to know a vertex by, and cells that meet smaller ones find their vertices on their
/// own sides.
class CellMesh {
public:
    /// A vertex: its sector and the coordinates a and b there, in units of 2^-kBits.  On the line from
    /// the centre to a corner it is in the sector that begins there.
    struct Vertex {
        int sector;
        std::int64_t a;
        std::int64_t b;
    };
    static constexpr int kBits = 40;

    /// \param edgeLevels  by edge of the face; all levels as Tessellation says
    CellMesh(int faceSize, std::vector<int> const &edgeLevels, int level);

    /// Vertices of coarser levels come first.
    std::vector<Vertex> const &GetVertices() const { return _verts; }
    /// The vertices of an edge of the face, from its first corner to its second.
    std::vector<int> GetEdgeVertices(int edge) const;

    /// \brief The cells, counter-clockwise, with the vertices that others have on their sides.
    ///
    /// \param isMerged  whether two halves of one hexagon that meet in nothing but its diagonal's ends
    ///                  make one polygon
    std::vector<std::vector<int>> GetPolygons(bool isMerged) const;

private:
    using Place = std::array<std::int64_t, 2>;
    struct Cell {
        bool isWhole;
        int depth;
        int sector;                   // of half cells
        std::int64_t scale;           // of whole ones: how far their corners are from the centre
        std::array<Place, 4> corners; // of half cells, in their sector
    };
    struct Hash {
        std::size_t operator()(std::array<std::int64_t, 3> const &key) const;
    };

    static std::array<std::int64_t, 3> getKey(int faceSize, int sector, Place const &place);
    int find(int sector, Place const &place) const;
    int add(int sector, Place const &place);
    bool isRefinable(Cell const &cell, std::vector<int> const &edgeLevels) const;
    void refine(Cell const &cell, std::vector<Cell> &children);
    void addLine(int sector, Place const &start, Place const &end, bool isLong, int depth,
                 int level);
    void appendSide(int sector, Place const &start, Place const &end, bool isLong,
                    std::vector<int> &verts) const;
    void appendSides(Cell const &cell, int first, int count, std::vector<int> &polygon) const;

    int const _faceSize;
    std::vector<Vertex> _verts;
    std::unordered_map<std::array<std::int64_t, 3>, int, Hash> _numbers;
    std::vector<Cell> _leaves;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_PATCH_PATCH_CELLS_H
#define OPENSUBDIVHEX_FAR_EXT_PATCH_PATCH_CELLS_H

#include "far_ext/indexing.h"
#include "far_ext/vtr/hierarchy.h"

#include <functional>
#include <vector>

namespace OpenSubdivHex::FarExt::internal {

/// \brief A cell that is a patch, or several: a quad is one patch, half a hexagon is one, and each other is a *kite* for each
/// of its corners.
struct PatchCell {
    Far::Index face;
    int half; ///< of a face that is cut, as in GetPlaceInHalves(); else 0
};

/// The cells of a face: its two halves if it is a hexagon, or has an infinitely sharp diagonal; else itself.
struct FaceCells {
    bool IsCut() const { return diagonalEnd > 0; }
    /// Whether cells are halves of regular polygons with the first side across.
    bool AreHalves() const { return IsCut() || isHalf; }
    /// The corners of a cell.
    int GetNumCorners(int half) const {
        return IsCut() ? GetHalfSize(half, faceSize, diagonalEnd) : faceSize;
    }
    /// Whether a cell is made of kites.
    bool HasKites(int half) const { return GetNumCorners(half) != 4; }
    /// The patches of a cell.
    int GetNumPatches(int half) const { return HasKites(half) ? GetNumCorners(half) : 1; }
    /// The patches of the face.
    int GetNumPatches() const { return GetNumPatches(0) + (IsCut() ? GetNumPatches(1) : 0); }
    /// The place in the face of a corner of a cell, or of the edge that is so many sides behind its first, which is the
    /// diagonal where the face is cut.
    int GetLocal(int half, int corner) const {
        return IsCut() ? GetPlaceInHalves(half, corner, diagonalEnd) : corner;
    }
    /// @name The cell that has edge \p local of the face, and which side of the cell that is
    /// @{
    int GetHalfOfEdge(int local) const {
        return IsCut() ? FarExt::GetHalfOfEdge(local, diagonalEnd) : 0;
    }
    int GetSideOfEdge(int local) const {
        return IsCut() ? GetEdgeInHalf(local, diagonalEnd) : local;
    }
    /// @}

    int faceSize;
    int diagonalEnd; ///< the vertex where the diagonal between the halves ends; 0: there is none
    bool isHalf;     ///< a half face
};

/// Returns the cells of a face without a sharp diagonal, or of half a face.
constexpr FaceCells MakeFaceCells(FaceShape shape) {
    return {shape.size, HasHalves(shape.size) && !shape.isHalf ? kDiagonalEnd : 0, shape.isHalf};
}
/// Returns the cells of a face.
FaceCells FindFaceCells(Level const &level, Far::Index face);

/// \brief Which cells of which levels are patches: together they are all of the surface but its holes.
///
/// Faces are refined whole, both halves of a hexagon together, and an E-face only if both faces of its edge
/// were.  So every border between cells of different levels is one edge of the coarser level, and the
/// diagonal of its E-face in the finer one, half of which is a cell: no corner lies inside of a side.
class PatchCells {
public:
    using Index = Far::Index;

    /// All cells of one level.
    PatchCells(MeshLevels const &mesh, int level);
    /// One cell of a level.
    PatchCells(MeshLevels const &mesh, int level, PatchCell cell);
    /// Cells of some of its faces.
    PatchCells(MeshLevels const &mesh, int level, std::vector<Index> const &faces);

    /// Which faces are to be refined: those for which this is called, of one level at a time; it returns a
    /// mark for each.  A face that has to be for the sake of others is refined, too.
    using FindRefined =
        std::function<std::vector<unsigned char>(int level, std::vector<Index> const &faces)>;
    /// Cells of levels \p firstLevel to \p lastLevel, at which no face is refined.
    PatchCells(MeshLevels const &mesh, int firstLevel, int lastLevel,
               FindRefined const &findRefined);
    /// \brief The faces of the value mesh of a channel that are cells \p ofMesh.
    ///
    /// \param patches  which patch of theirs each patch of the mesh is, in the order of these
    PatchCells(FVarChannel const &channel, MeshLevels const &mesh, PatchCells const &ofMesh,
               std::vector<Index> &patches);

    int GetFirstLevel() const { return _firstLevel; }
    int GetLastLevel() const { return _firstLevel + int(_cells.size()) - 1; }
    /// Cells of a level, by ascending face and half.
    std::vector<PatchCell> const &GetCells(int level) const {
        return _cells[std::size_t(level - _firstLevel)];
    }
    /// Whether a cell of a level is among them.
    bool HasCell(int level, Index face, int half) const {
        return level >= _firstLevel && level <= GetLastLevel() &&
               (_marks[std::size_t(level - _firstLevel)][std::size_t(face)] >> half & 1) != 0;
    }
    /// All patches.
    std::int64_t GetNumPatches() const { return _numPatches; }

private:
    using Marks = std::vector<unsigned char>; ///< by face: bits of halves

    void addCells(MeshLevels const &mesh, int level, Marks existing);

    int _firstLevel;
    std::vector<std::vector<PatchCell>> _cells;
    std::vector<Marks> _marks;
    std::int64_t _numPatches = 0;
};

} // namespace OpenSubdivHex::FarExt::internal

#endif

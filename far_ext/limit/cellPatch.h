// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_LIMIT_CELL_PATCH_H
#define OPENSUBDIVHEX_FAR_EXT_LIMIT_CELL_PATCH_H

#include "limitMask.h"

#include "far_ext/surfaceFaces.h"
#include "far_ext/vtr/refinementRules.h"

#include <functional>

namespace OpenSubdivHex::FarExt::internal {

// All functions here work on the calling thread alone, however large a patch is: callers hold locks, and memory that they
// keep for the thread, while an executor may have it do other work of the same kind.

/// Corners of a cell that is no whole face: the ends of the edge that made it and, beside the second
/// and the first of these, those of the edge across from it.
inline constexpr int kNumHalfCellCorners = HexIndexing::kNumBoundaryEFaceCorners;

/// Kinds of cells, and of what is shared by those that meet.
enum class CellKind {
    Whole,       ///< a base face, or the F-face that comes of it step by step
    HalfPolygon, ///< the same, where the base face is a half face or half a face
    Half,        ///< half of a hexagon, or a half face, of four corners, that an edge made
    Edge,        ///< an edge that runs along an edge of level 0
    LongEdge,    ///< the same across a face, or along a half face
    Vertex       ///< a vertex of level 0, or its V-vertex
};

/// \brief A cell, with the patch that all of the surface in it depends on.
///
/// So that neighbours agree on what they share to the bit, edges and vertices have patches of their
/// own, whose numbering does not depend on the cell that asks for them.
///
/// The patch has the face of the cell, or one beside the edge or vertex, as its face 0.  Face 0 begins at the cell's first
/// corner: a cell that is half of a face is half 0.
struct CellPatch {
    CellKind kind = CellKind::Whole;
    std::vector<int> locals;         ///< the corners, or ends, as places in face 0
    std::vector<Far::Index> corners; ///< the vertices there
    LimitPatch patch;

    int GetNumCorners() const { return int(locals.size()); }
};

/// Gathers the cell of a surface face.
OPENSUBDIVHEX_API void GatherBaseCell(SurfaceFaces const &faces, Far::Index face,
                                      Sdc::Options sdcOptions, CellPatch &cell);

/// \brief Makes the cell of a base face that GatherBaseCell() gathers where no feature is near, but for the
/// sources, which are the numbers of the points themselves.
///
/// \param cell  its patch has the faces, the base face first, and the corners across their edges; all else is empty, or as
///              such a cell had it
OPENSUBDIVHEX_API void FinishPlainBaseCell(int numPoints, CellPatch &cell);

/// \brief Writes what the edges and vertices of a surface face are in its own eyes, which all faces that
/// share one need to number it alike: its *turns*.
///
/// \param turns  by edge, whether it runs against the face, 1 or 0; then by vertex, how many faces of
///               its fan lie before the face
OPENSUBDIVHEX_API void FindBaseCellTurns(SurfaceFaces const &faces, Far::Index face, int *turns);

/// \brief The edges and then the vertices of a base cell, whose patch's vertices are their sources.
///
/// \param onlyItem  the one that is gathered, others being empty; -1: all are
OPENSUBDIVHEX_API std::vector<CellPatch> GatherBorder(CellPatch const &baseCell, int const *turns,
                                                      Sdc::Options sdcOptions, int onlyItem = -1);

/// \brief The children of a cell in one step: cells, and the vertices that their patches
/// have, each once, in terms of those of the cell's patch.
struct CellRefinement {
    std::vector<CellPatch> children;
    PatchRefinement step;
    std::vector<std::vector<int>> rows; ///< by child, which rows of the step its vertices are
};

/// \brief The cells that a step makes of a cell: first the F-face, or the same half of it, then the
/// half cells on this side of the edges, which are those behind corner 0 and so on of a whole cell
/// and behind corner 1 and so on of a half cell and of a half polygon.
///
/// An edge becomes the long edge between its ends; a long edge becomes the edge at its start, the long
/// edge in its middle and the edge at its end; a vertex becomes the V-vertex.
///
/// \param hasStep  else there are only children
OPENSUBDIVHEX_API CellRefinement RefineCell(CellPatch const &cell, Sdc::Options sdcOptions,
                                            HexSchemeOptions const &schemeOptions,
                                            Interpolation interpolation, bool hasStep = true);

/// Calls function(refinement, masks) for a hexagonal step of a patch and the masks of the step behind it.
OPENSUBDIVHEX_API void
UseNextMasks(LimitPatch const &patch, Sdc::Options sdcOptions,
             HexSchemeOptions const &schemeOptions, Interpolation interpolation,
             std::function<void(Refinement const &, RefinementRules const &)> const &function);

/// \brief The limit at a corner of a cell, and the first derivatives there on the side of the cell, in
/// terms of the vertices of the patch.  LimitStencilTableFactory says what they are derivatives by.
/// Edges and vertices have none.
struct CornerLimit {
    std::vector<double> weights;
    LimitMask::Tangents tangents;
};

/// \return  by corner; empty where \p finder does not find one
OPENSUBDIVHEX_API std::vector<CornerLimit> FindCornerLimits(CellPatch const &cell,
                                                            LimitMaskFinder &finder);

} // namespace OpenSubdivHex::FarExt::internal

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_BASE_EDGES_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_BASE_EDGES_H

#include "baseLevel.h"

#include "far_ext/status.h"

namespace OpenSubdivHex::FarExt::internal {

/// \brief A side of an edge of the base mesh that comes apart: that has three or more faces, or a
/// face twice, or two that run it in the same direction, or that joins a vertex to itself.
struct ApartSide {
    Far::Index edge;   ///< in the numbering of the base
    Far::Index corner; ///< where the face begins to run along the edge
};

/// \brief Finds the edges of \p level, which has its faces alone, and derives all relations.
///
/// Edges are numbered as Far does: in the order in which corners come to them.  Corners that join
/// the same two vertices are sides of one edge, but for those of a face that has one already, and
/// of degenerate edges: each of these begins an edge.  INDEXING.md says what comes apart.
///
/// \param boundary       the kind of edges with one face
/// \param repeatedVerts  those that a face has several times, ascending
/// \param fanned         gets the vertices with several fans, ascending
/// \return               a CallStatus that may have warnings; TooLarge with too many edges
CallStatus BuildLevelOfFaces(BoundaryKind boundary, std::vector<Far::Index> const &repeatedVerts,
                             Level &level, std::vector<Far::Index> &fanned);

/// \brief Overload for a base that has edges already.
///
/// \param edges  of the base; those that come apart have any sides
/// \param sides  of all that come apart
CallStatus BuildLevelOfEdges(Buffer<EdgeSides> edges, std::vector<ApartSide> sides, Level &level,
                             std::vector<Far::Index> &fanned);

/// Ok, or TooLarge, which names \p count, for more than 32-bit indices reach.
CallStatus CheckCount(std::int64_t count, std::string const &what);

} // namespace OpenSubdivHex::FarExt::internal

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_CHILD_COUNTS_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_CHILD_COUNTS_H

#include "parallel.h"
#include "refinement.h"

#include <cstdint>
#include <vector>

namespace OpenSubdivHex::FarExt::internal {

/// \brief Counts of children, where they differ between components of the parent.
///
/// ParallelSums() gives what the ranges of components before each range make, and behind them what
/// all make: so ranges can be taken in parallel.
struct ChildCounts {
    ChildCounts &operator+=(ChildCounts const &other) {
        vertices += other.vertices;
        edges += other.edges;
        faces += other.faces;
        corners += other.corners;
        digons += other.digons;
        return *this;
    }

    std::int64_t vertices = 0;
    std::int64_t edges = 0;
    std::int64_t faces = 0;
    std::int64_t corners = 0;
    std::int64_t digons = 0; ///< V-faces that would have two vertices, and are not made
};

/// \brief Numbers the V-vertices of \p refinement in the order of the vertices that make them.
///
/// \param counts   those of vertices, by range
/// \param isMade   isMade(pVert): whether a vertex makes a V-vertex
template <typename IS_MADE>
void NumberVVertices(std::vector<ChildCounts> const &counts, IS_MADE isMade,
                     Refinement &refinement) {
    using Far::Index;
    Index const numParents = refinement.parent->numVertices;
    refinement.vertChildVerts.Resize(std::size_t(numParents));
    refinement.vVertexParents.Resize(std::size_t(counts.back().vertices));
    ParallelForRange(numParents, [&](Index begin, Index end) {
        Index cVert = Index(counts[std::size_t(begin / kParallelRange)].vertices);
        for (Index pVert = begin; pVert < end; ++pVert) {
            bool const makesVertex = isMade(pVert);
            refinement.vertChildVerts[std::size_t(pVert)] =
                makesVertex ? cVert : Far::INDEX_INVALID;
            if (makesVertex) {
                refinement.vVertexParents[std::size_t(cVert++)] = pVert;
            }
        }
    });
}

} // namespace OpenSubdivHex::FarExt::internal

#endif

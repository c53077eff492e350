// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_LIMIT_REGULAR_VERTICES_H
#define OPENSUBDIVHEX_FAR_EXT_LIMIT_REGULAR_VERTICES_H

#include "limitRows.h"

#include <vector>

namespace OpenSubdivHex::FarExt::internal {

/// \brief The vertices of a level that were regular in a level before: their limit follows from that
/// one, which is smaller.
///
/// Vertices persist, and a regular vertex of any level has the same mask, but for the direction and
/// the length of its derivatives.  Both are those of the last level.
class OPENSUBDIVHEX_API RegularVertices {
public:
    using Index = Far::Index;

    /// \brief Those of \p verts, which ascend, by the first level in which they are regular.
    ///
    /// \param mesh  is referred to
    /// \param rows  of the level of \p verts, one of \p mesh; they are found for these
    RegularVertices(MeshLevels const &mesh, HexSchemeOptions const &schemeOptions,
                    LimitRows const &rows, std::vector<Index> const &verts);

    /// Those that are regular in \p level, which is before that of the rows, and in none before it;
    /// ascending.
    std::vector<Index> const &GetVertices(int level) const {
        return _levels[std::size_t(level)].verts;
    }
    /// The row of one of them, in terms of the vertices of \p level.  Valid until \p sources is used
    /// again.
    LimitRow GetRow(int level, Index vert,
                    Index sources[PlainNeighborhoodGatherer::kNumRegular]) const;
    /// The other vertices, ascending.
    std::vector<Index> const &GetOthers() const { return _others; }

private:
    struct OfLevel {
        std::vector<Index> verts;
        LimitMask mask; ///< empty without vertices
    };

    MeshLevels const &_mesh;
    std::vector<OfLevel> _levels;
    std::vector<Index> _others;
};

} // namespace OpenSubdivHex::FarExt::internal

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_LIMIT_LIMIT_ORIGINS_H
#define OPENSUBDIVHEX_FAR_EXT_LIMIT_LIMIT_ORIGINS_H

#include "latticeFaces.h"
#include "regularFaces.h"

#include <algorithm>
#include <optional>
#include <vector>

namespace OpenSubdivHex::FarExt::internal {

/// \brief Sources of the limit at each vertex of a level, for evaluation without tables.
///
/// Vertices in lattice faces are made from level 0.  Else most are F-vertices of regular faces of a level
/// before, or vertices of F-faces.  The others are sums of vertices of the last level.
class OPENSUBDIVHEX_API LimitOrigins {
public:
    using Index = Far::Index;

    /// Sources of a row that GetRow() may gather.
    static constexpr int kMaxSources =
        std::max(LatticePatch::kMaxPlaces, PlainNeighborhoodGatherer::kNumRegular);

    /// Prepares side 0 of each vertex of the level of \p rows, a level of \p mesh.  Both are referred to.
    LimitOrigins(MeshLevels const &mesh, LimitRows &rows);

    /// \return  as LimitRows; the others may be asked only when it is well
    CallStatus Find(HexSchemeOptions const &schemeOptions);

    LatticeFaces const &GetLatticeFaces() const { return _latticeFaces; }
    /// By level, from 0 to that of the rows.
    std::vector<RegularFaces::OfLevel> const &GetFaces() const {
        return _regularFaces->GetLevels();
    }
    /// The vertices whose limit is a sum of vertices of \p level: of the last one, or of level 0.
    std::vector<Index> GetVertices(int level) const;
    /// The row of one of these.  Valid until \p sources is used again.
    LimitRow GetRow(int level, Index vert, Index sources[kMaxSources]) const;

private:
    MeshLevels const &_mesh;
    LimitRows &_rows;
    LatticeFaces _latticeFaces;
    std::optional<RegularFaces> _regularFaces;
};

} // namespace OpenSubdivHex::FarExt::internal

#endif

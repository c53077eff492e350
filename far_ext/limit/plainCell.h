// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_LIMIT_PLAIN_CELL_H
#define OPENSUBDIVHEX_FAR_EXT_LIMIT_PLAIN_CELL_H

#include "plainNeighborhood.h"

#include <string>
#include <vector>

namespace OpenSubdivHex::FarExt::internal {

/// \brief What the surface of a base face depends on, where no feature is near: CellPatch in short.
///
/// The sources are those of the patch, in the same order, and patches of the same key have the same
/// signature.
struct PlainCell {
    std::vector<Far::Index> sources;
    std::string key;
};

/// \brief Gathers what the surfaces of base faces depend on.  One thread uses it at a time.
class OPENSUBDIVHEX_API PlainCellGatherer {
public:
    using Index = Far::Index;

    /// \param level  level 0 of a mesh; another one may follow
    /// \param marks  those of MarkFeatures()
    /// \return       false where there is a feature, or something that a key cannot tell; then the
    ///               result is of no use
    bool Gather(Level const &level, std::vector<VertexMark> const &marks, Index face,
                PlainCell &result);

private:
    bool addVertex(Index vert, PlainCell &result);
    bool addFace(Level const &level, Index k, PlainCell &result);
    bool addFan(Level const &level, Index vert, Index first, PlainCell &result);

    IndexMap _numbers; // of the sources
    IndexMap _faces;   // that have been added
    Index _numFaces = 0;
    std::vector<Index> _neighbors; // of a vertex
};

} // namespace OpenSubdivHex::FarExt::internal

#endif

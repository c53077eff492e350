// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_STENCIL_STENCIL_SELECTION_H
#define OPENSUBDIVHEX_FAR_EXT_STENCIL_STENCIL_SELECTION_H

#include "stencilPlan.h"

#include "far_ext/vtr/refinementRows.h"

#include <vector>

namespace OpenSubdivHex::FarExt::internal {

/// A face, or one half of a hexagon: bit h of halves is set for half h, both for all of a face.
struct FacePart {
    Far::Index face;
    unsigned halves;
};
inline constexpr unsigned kAllHalves = 3;

/// \brief The faces of levels 0 ... \p lastLevel that lie in one of \p baseFaces, in ascending order.
///
/// The work is proportional to its amount, but for logarithms.
std::vector<std::vector<FacePart>>
FindFacesOfBaseFaces(MeshLevels const &mesh, Far::ConstIndexArray baseFaces, int lastLevel);

/// The vertices of parts of a level or, with a \p channel of 0 or more, their values; ascending.
std::vector<Far::Index> FindVerticesOfFaces(Hierarchy const &hierarchy, int level, int channel,
                                            std::vector<FacePart> const &parts);

/// Overload for all levels of a plan, and their faces in base faces; empty for levels that the table does not
/// have.
std::vector<std::vector<Far::Index>> FindVerticesOfBaseFaces(StencilPlan const &plan,
                                                             Far::ConstIndexArray baseFaces);

/// \brief The least parts of all refinements that make wanted vertices, in terms of the control
/// vertices.
struct StencilSelection {
    /// \param wanted     vertices of each level of the plan, ascending
    /// \param hasWholes  whether a level that is needed for the most part is taken whole, with all
    ///                   before it, level 0 in any case: that takes less time than to find the part
    StencilSelection(StencilPlan const &plan, std::vector<std::vector<Far::Index>> wanted,
                     bool hasWholes = false);

    int wholeLevel; ///< the last that is taken whole, or -1
    /// Parts of the refinements that make levels 1, 2 ...; empty up to that of the whole level.
    std::vector<RefinementRows::Part> parts;
    std::vector<Far::Index> sources; ///< of parts[0].verts, as numbers in indices
    std::vector<Far::Index> indices; ///< ascending; what the stencils refer to
};

} // namespace OpenSubdivHex::FarExt::internal

#endif

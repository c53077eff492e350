// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_STENCIL_STENCIL_PLAN_H
#define OPENSUBDIVHEX_FAR_EXT_STENCIL_STENCIL_PLAN_H

#include "far_ext/hexSchemeOptions.h"
#include "far_ext/rules/mask.h"
#include "far_ext/vtr/hierarchy.h"

#include <vector>

namespace OpenSubdivHex::FarExt::internal {

/// \brief Which levels of which mesh a stencil table is made of.
struct StencilPlan {
    using Index = Far::Index;

    /// The level of the mesh or, for face-varying stencils, of the value mesh.
    Level const &GetLevel(int level) const { return hierarchy.GetMesh(channel).levels[level]; }
    /// The refinement that makes a level of these, 1 or more.
    Refinement const &GetRefinement(int level) const {
        return hierarchy.GetMesh(channel).refinements[level - 1];
    }
    /// Number of vertices of a level, or of control points: what stencils are made for, and refer to.
    Index GetNumVertices(int level) const {
        return level == 0 ? hierarchy.GetNumControlPoints(channel) : GetLevel(level).numVertices;
    }
    /// Returns the sources that vertices of a level stand for; in a value mesh, the user's values.
    std::vector<Index> GetSources(int level, std::vector<Index> verts) const;
    /// Overload for all vertices.
    std::vector<Index> GetSources(int level) const;
    /// How many sources the stencils of a level have to choose from.
    Index GetNumSources(int level) const { return GetNumVertices(factorize ? 0 : level - 1); }

    /// Whether the stencils of a level are made from those of the level before.
    bool HasParentStencils(int level) const { return factorize && level > firstBuilt; }

    Hierarchy const &hierarchy;
    HexSchemeOptions hexSchemeOptions;
    int channel = -1; ///< face-varying channel, or -1
    Interpolation interpolation = Interpolation::Vertex;
    bool factorize = true;
    int lastLevel = 0;
    int firstStored = 1;          ///< in the table, behind the control vertices
    int firstBuilt = 1;           ///< as a source of later levels, or to be stored
    Index numControlStencils = 0; ///< that come first in the table
};

} // namespace OpenSubdivHex::FarExt::internal

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_HIERARCHY_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_HIERARCHY_H

#include "fvarLevel.h"
#include "refinement.h"

#include <deque>

namespace OpenSubdivHex::FarExt::internal {

/// \brief The levels of a mesh and what relates them: refinements[i] leads from level i to the
/// next.  Deques, since levels and refinements refer to one another.
struct MeshLevels {
    std::deque<Level> levels;
    std::deque<Refinement> refinements;
};

/// \brief A face-varying channel: its value mesh, which refines beside the mesh of the vertices,
/// and what relates the two at each level.
struct FVarChannel {
    Sdc::Options::FVarLinearInterpolation linearInterpolation =
        Sdc::Options::FVAR_LINEAR_CORNERS_ONLY;
    MeshLevels values;
    std::deque<FVarLevel> levels;

    // For level 0, whose value mesh may have more vertices than there are values: see FVarLevel.
    Far::Index numValues = 0;            ///< of the user
    Buffer<Far::Index> valuesOfVertices; ///< by vertex of the value mesh
    Buffer<Far::Index> faceValues;       ///< by corner of the mesh
};

/// \brief All levels of a TopologyRefiner, of which numLevels are in use; the memory of the others
/// is kept for the next refinement.
struct Hierarchy {
    MeshLevels mesh;
    std::deque<FVarChannel> channels;
    int numLevels = 1;
    int surfaceLevel = 0; ///< HexSchemeOptions::GetSurfaceLevel()

    /// The mesh of the vertices, or the value mesh of a \p channel of 0 or more.
    MeshLevels const &GetMesh(int channel) const {
        return channel < 0 ? mesh : channels[std::size_t(channel)].values;
    }
    /// The vertices of level 0, or the values that the user has.
    Far::Index GetNumControlPoints(int channel) const {
        return channel < 0 ? mesh.levels[0].numVertices : channels[std::size_t(channel)].numValues;
    }
};

} // namespace OpenSubdivHex::FarExt::internal

#endif

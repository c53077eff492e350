// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_ANALYSIS_MESH_CENTER_H
#define OPENSUBDIVHEX_REGRESSION_ANALYSIS_MESH_CENTER_H

#include "far_ext/topologyLevel.h"

#include <opensubdiv/far/topologyLevel.h>

namespace OpenSubdivHex::Regression {

enum class CenterKind { Vertex, Face };

/// The vertex or face of a mesh whose neighbourhood is looked at.
struct MeshCenter {
    CenterKind kind = CenterKind::Vertex;
    int index = -1; ///< -1: none is looked at
};

/// The child of \p center of \p level in the next level, \p cLevel: V-vertex, V-face or F-face.
MeshCenter FindChild(MeshCenter center, FarExt::TopologyLevel const &level,
                     FarExt::TopologyLevel const &cLevel);

/// Overload for a refiner of Far, by Catmull-Clark or, of vertices alone, by Loop: always a vertex.
MeshCenter FindChild(MeshCenter center, OpenSubdiv::Far::TopologyLevel const &level,
                     OpenSubdiv::Far::TopologyLevel const &cLevel);

} // namespace OpenSubdivHex::Regression

#endif

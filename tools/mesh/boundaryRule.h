// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_BOUNDARY_RULE_H
#define OPENSUBDIVHEX_TOOLS_BOUNDARY_RULE_H

#include "far_ext/topologyRefiner.h"
#include "fileError.h"

#include <string>

namespace OpenSubdivHex::Tools {

/// Throws FileError, naming \p input, if boundaries have no limit, which --adaptive needs.
inline void RequireBoundaryRule(FarExt::TopologyRefiner const &refiner, std::string const &input) {
    using Options = OpenSubdiv::Sdc::Options;
    if (refiner.GetSchemeOptions().GetVtxBoundaryInterpolation() != Options::VTX_BOUNDARY_NONE) {
        return;
    }
    FarExt::TopologyLevel const &base = refiner.GetLevel(0);
    for (int edge = 0; edge < base.GetNumEdges(); ++edge) {
        if (base.IsEdgeBoundary(edge)) {
            throw FileError(input, "--adaptive needs --boundary edge-only or edge-and-corner: the "
                                   "mesh has boundary edges, one at vertex " +
                                       std::to_string(base.GetEdgeVertices(edge)[0]) +
                                       " (counted from 0)");
        }
    }
}

} // namespace OpenSubdivHex::Tools

#endif

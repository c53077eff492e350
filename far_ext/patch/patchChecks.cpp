// SPDX-License-Identifier: Apache-2.0
#include "patchChecks.h"

#include "farPatchTable.h"

#include "far_ext/limit/limitRows.h"

#include <string>

namespace OpenSubdivHex::FarExt::internal {

using Far::Index;

namespace {

// A level that has limits, and the next one, which the middles of edges are limits of.
CallStatus checkLevels(TopologyRefiner const &refiner, int level) {
    Hierarchy const &hierarchy = refiner.GetHierarchy();
    HexSchemeOptions const schemeOptions = refiner.GetHexSchemeOptions();
    CallStatus result = CheckLimitLevel(hierarchy, schemeOptions, level);
    if (!result.IsOk()) {
        return result;
    }
    result = CheckLimitLevel(hierarchy, schemeOptions, level + 1);
    if (!result.IsOk()) {
        return CallStatus(result.GetCode(), ComponentType::Level, level + 1,
                          "patches of level " + std::to_string(level) +
                              " need the level behind it: " + result.GetErrorMessage() +
                              "; see PatchTableFactory::Options::GetRefineUniformOptions");
    }
    if (!refiner.IsUniform()) {
        return CallStatus(StatusCode::Unsupported, ComponentType::Level, level,
                          "there are no patches of coplanar refinements");
    }
    return result;
}

} // namespace

CallStatus FindPatchCells(TopologyRefiner const &refiner, PatchTableFactory::Options const &options,
                          std::optional<PatchCells> &cells) {
    int const level = options.maxIsolationLevel;
    if (CallStatus const result = checkLevels(refiner, level); !result.IsOk()) {
        return result;
    }
    MeshLevels const &mesh = refiner.GetHierarchy().mesh;
    Level const &base = mesh.levels[0];
    for (Index const edge : base.boundaryEdges) {
        if (base.edgeFaces[edge][1] == kFreeBoundary) {
            return CallStatus(
                StatusCode::Unsupported, ComponentType::Edge, edge,
                "edge " + std::to_string(edge) +
                    " lies on a boundary that follows the paper's rule "
                    "(VTX_BOUNDARY_NONE), where the surface has no limit that patches "
                    "could meet");
        }
    }
    cells.emplace(mesh, level);
    if (cells->GetNumPatches() == 0) {
        return CallStatus(StatusCode::Unsupported, ComponentType::Level, level,
                          "there are no patches: all faces are holes");
    }
    if (cells->GetNumPatches() > kMaxPatches) {
        return CallStatus(StatusCode::TooLarge, ComponentType::Level, level,
                          "level " + std::to_string(level) + " would have " +
                              std::to_string(cells->GetNumPatches()) +
                              " patches, more than Far::PatchParam can number");
    }
    return CallStatus();
}

} // namespace OpenSubdivHex::FarExt::internal

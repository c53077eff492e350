// SPDX-License-Identifier: Apache-2.0
#include "patchChecks.h"

#include "farPatchTable.h"
#include "patchDeviation.h"

#include "far_ext/limit/limitRows.h"
#include "far_ext/vtr/report.h"

#include <algorithm>
#include <cmath>
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

CallStatus checkIsolation(TopologyRefiner const &refiner, PatchTableFactory::Options const &options,
                          int minLevel) {
    int const level = options.maxIsolationLevel;
    int const surfaceLevel = refiner.GetHexSchemeOptions().GetSurfaceLevel();
    auto const fail = [](std::string const &message) {
        return Failure(StatusCode::InvalidArgument, message);
    };
    if (minLevel < surfaceLevel || minLevel > level) {
        return fail("patches of levels " + std::to_string(minLevel) + " to " +
                    std::to_string(level) + " are asked for, of which the first is not one of " +
                    std::to_string(surfaceLevel) + " to " + std::to_string(level));
    }
    if (!(options.tolerance >= 0) || !std::isfinite(options.tolerance)) {
        return fail("the tolerance of patches is negative or no number");
    }
    if (options.tolerance > 0 && !options.positions) {
        return fail("there is a tolerance of patches without positions");
    }
    if (options.eye && !(options.tolerance > 0)) {
        return fail("there is an eye without a tolerance of patches");
    }
    return CallStatus();
}

bool isSharp(Level const &level, Index face) {
    Far::ConstIndexArray const verts = level.GetFaceVertices(face);
    return level.GetDiagonalSharpness(face) > 0 || level.IsHalfFace(face) ||
           std::any_of(verts.begin(), verts.end(),
                       [&](Index vert) { return level.FindSharpVertex(vert) != nullptr; });
}

// But for what is so because it is sharp.
bool isIrregular(Level const &level, Index face) {
    Far::ConstIndexArray const verts = level.GetFaceVertices(face);
    return (!HasHalves(level.GetFaceSize(face)) && !level.IsHalfFace(face)) ||
           std::any_of(verts.begin(), verts.end(), [&](Index vert) {
               constexpr int kRegular = 3;
               return level.GetNumVertexFaces(vert) != kRegular && !level.FindSharpVertex(vert);
           });
}

} // namespace

CallStatus FindPatchCells(TopologyRefiner const &refiner, PatchTableFactory::Options const &options,
                          std::optional<PatchCells> &cells) {
    int const level = options.maxIsolationLevel;
    if (CallStatus result = checkLevels(refiner, level); !result.IsOk()) {
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
    int const minLevel = options.minIsolationLevel < 0 ? level : options.minIsolationLevel;
    if (CallStatus result = checkIsolation(refiner, options, minLevel); !result.IsOk()) {
        return result;
    }
    if (minLevel == level) {
        cells.emplace(mesh, level);
    } else if (options.tolerance > 0) {
        PatchDeviation const deviation(refiner, options.positions, options.eye, level - 1);
        CallStatus result;
        cells.emplace(mesh, minLevel, level, [&](int depth, std::vector<Index> const &faces) {
            std::vector<unsigned char> isRefined(faces.size(), 0);
            std::vector<double> distances;
            if (result.IsOk()) {
                result = deviation.Measure(depth, faces, distances);
            }
            for (std::size_t i = 0; i < faces.size() && result.IsOk(); ++i) {
                isRefined[i] = !(distances[i] <= options.tolerance);
            }
            return isRefined;
        });
        if (!result.IsOk()) {
            return result;
        }
    } else {
        int const sharpLevel =
            options.sharpIsolationLevel < 0 ? level : options.sharpIsolationLevel;
        cells.emplace(mesh, minLevel, level, [&](int depth, std::vector<Index> const &faces) {
            Level const &topology = mesh.levels[std::size_t(depth)];
            std::vector<unsigned char> isRefined(faces.size(), 0);
            for (std::size_t i = 0; i < faces.size(); ++i) {
                isRefined[i] = isIrregular(topology, faces[i]) ||
                               (depth < sharpLevel && isSharp(topology, faces[i]));
            }
            return isRefined;
        });
    }
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

// SPDX-License-Identifier: Apache-2.0
#include "inputChecks.h"

#include "parallel.h"

#include "far_ext/vtr/report.h"

#include <cstdio>
#include <utility>

namespace OpenSubdivHex::FarExt::internal {

using Far::Index;

namespace {

// An array of a descriptor that has a count.
CallStatus checkArray(int count, void const *array, std::string const &name) {
    if (count < 0) {
        return Failure(StatusCode::InvalidArgument,
                       "the descriptor has " + std::to_string(count) + " entries in " + name);
    }
    if (count > 0 && !array) {
        return Failure(StatusCode::InvalidArgument, "the descriptor has no array " + name +
                                                        ", but " + std::to_string(count) +
                                                        " entries in it");
    }
    return CallStatus();
}

template <typename ENUM>
CallStatus checkEnum(int value, ENUM last, std::string const &name) {
    return IsInEnum(value, last) ? CallStatus()
                                 : Failure(StatusCode::InvalidArgument,
                                           "there is no " + name + " " + std::to_string(value));
}

} // namespace

CallStatus CheckOptions(HexSchemeOptions schemeOptions, Sdc::Options sdcOptions) {
    for (CallStatus const &status :
         {checkEnum(int(schemeOptions.faceMask), FaceMask::Smooth, "faceMask"),
          checkEnum(int(schemeOptions.schemeType), SchemeType::TriHex, "schemeType"),
          checkEnum(int(schemeOptions.firstStep), FirstStep::Truncate, "firstStep"),
          checkEnum(sdcOptions.GetVtxBoundaryInterpolation(),
                    Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER, "VtxBoundaryInterpolation"),
          checkEnum(sdcOptions.GetFVarLinearInterpolation(), Sdc::Options::FVAR_LINEAR_ALL,
                    "FVarLinearInterpolation"),
          checkEnum(sdcOptions.GetCreasingMethod(), Sdc::Options::CREASE_CHAIKIN,
                    "CreasingMethod")}) {
        if (!status.IsOk()) {
            return status;
        }
    }
    return CallStatus();
}

CallStatus CheckCounts(int numVertices, int numFaces) {
    if (numVertices > 0 && numFaces > 0) {
        return CallStatus();
    }
    if (numVertices < 0 || numFaces < 0) {
        return Failure(StatusCode::InvalidTopology,
                       "the mesh has " + std::to_string(numVertices) + " vertices and " +
                           std::to_string(numFaces) + " faces, but counts are 0 or more");
    }
    return Failure(StatusCode::InvalidTopology, "the mesh is empty: it has " +
                                                    std::to_string(numVertices) + " vertices and " +
                                                    std::to_string(numFaces) + " faces");
}

// Not a number is less than 0, too.
CallStatus SharpnessFailure(float sharpness, ComponentType component, Index index,
                            std::string const &name) {
    char number[32];
    std::snprintf(number, sizeof number, "%g", double(sharpness));
    return CallStatus(StatusCode::InvalidTopology, component, index,
                      name + " has sharpness " + number + ", but a sharpness is 0 or more");
}

CallStatus IndexFailure(Index index, int count, ComponentType component, std::string const &name) {
    std::pair<char const *, char const *> names = {"value", "values"};
    switch (component) {
    case ComponentType::Face:
        names = {"face", "faces"};
        break;
    case ComponentType::Edge:
        names = {"edge", "edges"};
        break;
    case ComponentType::Vertex:
        names = {"vertex", "vertices"};
        break;
    case ComponentType::NoComponent:
    case ComponentType::Level:
        break;
    }
    std::string const range =
        count > 0 ? " go from 0 to " + std::to_string(count - 1) : " are none";
    return CallStatus(StatusCode::InvalidTopology, component, index,
                      name + " refers to " + names.first + " " + std::to_string(index) + ", but " +
                          names.second + range);
}

CallStatus CheckValues(Index const *values, Index numCorners, Index numValues, int channel) {
    std::vector<Index> const wrong = ParallelSelect(numCorners, [values, numValues](Index corner) {
        return unsigned(values[corner]) >= unsigned(numValues);
    });
    return wrong.empty() ? CallStatus()
                         : IndexFailure(values[wrong[0]], numValues, ComponentType::NoComponent,
                                        "corner " + std::to_string(wrong[0]) +
                                            " of face-varying channel " + std::to_string(channel));
}

CallStatus CheckArrays(Far::TopologyDescriptor const &descriptor) {
    CallStatus status;
    auto const check = [&](int count, void const *array, std::string const &name) {
        if (status.IsOk()) {
            status = checkArray(count, array, name);
        }
    };
    check(descriptor.numFaces, descriptor.numVertsPerFace, "numVertsPerFace");
    check(descriptor.numFaces, descriptor.vertIndicesPerFace, "vertIndicesPerFace");
    check(descriptor.numCreases, descriptor.creaseVertexIndexPairs, "creaseVertexIndexPairs");
    check(descriptor.numCreases, descriptor.creaseWeights, "creaseWeights");
    check(descriptor.numCorners, descriptor.cornerVertexIndices, "cornerVertexIndices");
    check(descriptor.numCorners, descriptor.cornerWeights, "cornerWeights");
    check(descriptor.numHoles, descriptor.holeIndices, "holeIndices");
    check(descriptor.numFVarChannels, descriptor.fvarChannels, "fvarChannels");
    for (int channel = 0; channel < descriptor.numFVarChannels && status.IsOk(); ++channel) {
        Far::TopologyDescriptor::FVarChannel const &fvar = descriptor.fvarChannels[channel];
        if (fvar.numValues < 0 || !fvar.valueIndices) {
            status = Failure(StatusCode::InvalidArgument,
                             "face-varying channel " + std::to_string(channel) +
                                 (fvar.valueIndices
                                      ? " has " + std::to_string(fvar.numValues) + " values"
                                      : " has no array valueIndices"));
        }
    }
    return status;
}

// Schemes without rules for sharp features and seams take none.
CallStatus CheckScheme(HexSchemeOptions schemeOptions, Hierarchy const &base) {
    Level const &level = base.mesh.levels[0];
    auto const unsupported = [](ComponentType component, Index index, std::string const &what) {
        return CallStatus(StatusCode::Unsupported, component, index,
                          what + ", which only the hexagonal scheme has rules for");
    };
    if (schemeOptions.schemeType == SchemeType::Hexagonal &&
        schemeOptions.firstStep != FirstStep::TriHex) {
        return CallStatus();
    }
    if (!level.nonManifoldEdges.empty()) {
        Index const edge = level.nonManifoldEdges[0];
        return unsupported(ComponentType::Edge, edge,
                           "edge " + std::to_string(edge) + " is non-manifold");
    }
    for (Index edge = 0; edge < level.numEdges; ++edge) {
        if (Sdc::Crease::IsSharp(level.GetEdgeSharpness(edge))) {
            return unsupported(ComponentType::Edge, edge,
                               "edge " + std::to_string(edge) + " is a crease");
        }
    }
    for (Index vert = 0; vert < level.numVertices; ++vert) {
        // Borders are dropped, and Far takes vertices without faces for sharp.
        int const numFaces = level.GetNumVertexFaces(vert);
        bool const isInterior = numFaces > 0 && level.GetVertexEdges(vert).size() == numFaces;
        if (isInterior && Sdc::Crease::IsSharp(level.GetVertexSharpness(vert))) {
            return unsupported(ComponentType::Vertex, vert,
                               "vertex " + std::to_string(vert) + " is a sharp corner");
        }
    }
    if (!base.channels.empty()) {
        return unsupported(ComponentType::NoComponent, Far::INDEX_INVALID,
                           "the mesh has face-varying channels");
    }
    return CallStatus();
}

} // namespace OpenSubdivHex::FarExt::internal

// SPDX-License-Identifier: Apache-2.0
#include "topologyRefinerFactory.h"

#include "far_ext/vtr/baseMesh.h"
#include "far_ext/vtr/inputChecks.h"
#include "far_ext/vtr/report.h"

#include <algorithm>

namespace OpenSubdivHex::FarExt {

using Far::Index;
using internal::CheckIndex;
using internal::CheckSharpness;

struct BaseTopology::Channel {
    int numValues;
    Sdc::Options::FVarLinearInterpolation interpolation;
    internal::Buffer<Index> values; // by corner
};

BaseTopology::BaseTopology(internal::BaseMesh &mesh) : _mesh(mesh) {}

BaseTopology::~BaseTopology() = default;

void BaseTopology::refuse(CallStatus const &status) {
    if (_status.IsOk()) {
        _status = status;
    }
}

bool BaseTopology::isIn(Stage stage, char const *function) {
    if (_stage == stage) {
        return true;
    }
    refuse(internal::Failure(StatusCode::InvalidArgument, std::string(function) + " is for " +
                                                              getName(stage) + ", not for " +
                                                              getName(_stage)));
    return false;
}

void BaseTopology::refuseIndex(Stage stage, char const *function, Index index, int count,
                               ComponentType component) {
    if (isIn(stage, function)) {
        refuse(internal::IndexFailure(index, count, component, function));
    }
}

char const *BaseTopology::getName(Stage stage) {
    switch (stage) {
    case Stage::Resize:
        return "resizeComponentTopology";
    case Stage::Assign:
        return "assignComponentTopology";
    case Stage::AssignTags:
        return "assignComponentTags";
    case Stage::AssignFaceVarying:
        break;
    }
    return "assignFaceVaryingTopology";
}

namespace {

constexpr Index kUnassigned = Far::INDEX_INVALID;

void fill(internal::Buffer<Index> &array, std::size_t size, Index value) {
    array.Resize(size);
    std::fill_n(array.data(), size, value);
}

CallStatus failedCount(char const *function, int count) {
    return internal::Failure(StatusCode::InvalidArgument,
                             std::string(function) + " was given " + std::to_string(count));
}

} // namespace

void MeshRefinerFactoryBase::setNumBaseVertices(BaseTopology &base, int count) {
    if (!base.isIn(BaseTopology::Stage::Resize, "setNumBaseVertices")) {
        return;
    }
    if (count < 0) {
        base.refuse(failedCount("setNumBaseVertices", count));
    } else {
        base._mesh.SetNumVertices(count);
    }
}

void MeshRefinerFactoryBase::setNumBaseFaces(BaseTopology &base, int count) {
    if (!base.isIn(BaseTopology::Stage::Resize, "setNumBaseFaces")) {
        return;
    }
    if (count < 0) {
        base.refuse(failedCount("setNumBaseFaces", count));
        return;
    }
    base._mesh.SetNumFaces(count);
    base._numFaces = count;
    base._faceSizes = base._mesh.GetFaceSizes();
    std::fill_n(base._faceSizes, count, 0);
}

int MeshRefinerFactoryBase::getNumBaseVertices(BaseTopology const &base) {
    return base._mesh.GetLevel().numVertices;
}

int MeshRefinerFactoryBase::getNumBaseEdges(BaseTopology const &base) {
    return base._mesh.GetNumBaseEdges();
}

Index MeshRefinerFactoryBase::findBaseEdge(BaseTopology const &base, Index v0, Index v1) {
    int const numVertices = getNumBaseVertices(base);
    bool const isInRange = 0 <= std::min(v0, v1) && std::max(v0, v1) < numVertices;
    return isInRange && getNumBaseEdges(base) > 0 ? base._mesh.FindEdge(v0, v1)
                                                  : Far::INDEX_INVALID;
}

void MeshRefinerFactoryBase::setBaseEdgeSharpness(BaseTopology &base, Index edge, float sharpness) {
    if (!base.isIn(BaseTopology::Stage::AssignTags, "setBaseEdgeSharpness")) {
        return;
    }
    CallStatus status = CheckIndex(edge, getNumBaseEdges(base), ComponentType::Edge,
                                   [] { return "setBaseEdgeSharpness"; });
    if (status.IsOk()) {
        status = CheckSharpness(sharpness, ComponentType::Edge, edge,
                                [&] { return "edge " + std::to_string(edge); });
    }
    if (status.IsOk()) {
        base._mesh.SetEdgeSharpness(edge, sharpness);
    } else {
        base.refuse(status);
    }
}

void MeshRefinerFactoryBase::setBaseVertexSharpness(BaseTopology &base, Index vert,
                                                    float sharpness) {
    if (!base.isIn(BaseTopology::Stage::AssignTags, "setBaseVertexSharpness")) {
        return;
    }
    CallStatus status = CheckIndex(vert, getNumBaseVertices(base), ComponentType::Vertex,
                                   [] { return "setBaseVertexSharpness"; });
    if (status.IsOk()) {
        status = CheckSharpness(sharpness, ComponentType::Vertex, vert,
                                [&] { return "vertex " + std::to_string(vert); });
    }
    if (status.IsOk()) {
        base._mesh.SetVertexSharpness(vert, sharpness);
    } else {
        base.refuse(status);
    }
}

void MeshRefinerFactoryBase::setBaseFaceHole(BaseTopology &base, Index face, bool isHole) {
    if (!base.isIn(BaseTopology::Stage::AssignTags, "setBaseFaceHole")) {
        return;
    }
    if (0 <= face && face < base._numFaces) {
        base._mesh.SetHole(face, isHole);
    } else {
        base.refuse(
            internal::IndexFailure(face, base._numFaces, ComponentType::Face, "setBaseFaceHole"));
    }
}

int MeshRefinerFactoryBase::createBaseFVarChannel(BaseTopology &base, int numValues) {
    return createBaseFVarChannel(base, numValues, base._mesh.GetSchemeOptions());
}

int MeshRefinerFactoryBase::createBaseFVarChannel(BaseTopology &base, int numValues,
                                                  Sdc::Options const &options) {
    if (!base.isIn(BaseTopology::Stage::AssignFaceVarying, "createBaseFVarChannel")) {
        return Far::INDEX_INVALID;
    }
    if (numValues < 0) {
        base.refuse(failedCount("createBaseFVarChannel", numValues));
        return Far::INDEX_INVALID;
    }
    base.refuse(internal::CheckOptions(HexSchemeOptions(), options));
    base._channels.push_back({numValues, options.GetFVarLinearInterpolation(), {}});
    fill(base._channels.back().values, std::size_t(base._mesh.GetLevel().numCorners), kUnassigned);
    return int(base._channels.size()) - 1;
}

MeshRefinerFactoryBase::IndexArray
MeshRefinerFactoryBase::getBaseFaceFVarValues(BaseTopology &base, Index face, int channel) {
    if (!base.isIn(BaseTopology::Stage::AssignFaceVarying, "getBaseFaceFVarValues")) {
        return IndexArray();
    }
    int const numChannels = int(base._channels.size());
    if (channel < 0 || channel >= numChannels) {
        base.refuse(CallStatus(StatusCode::InvalidTopology, ComponentType::NoComponent, channel,
                               "getBaseFaceFVarValues refers to channel " +
                                   std::to_string(channel) + ", but there are " +
                                   std::to_string(numChannels)));
        return IndexArray();
    }
    if (face < 0 || face >= base._numFaces) {
        base.refuse(internal::IndexFailure(face, base._numFaces, ComponentType::Face,
                                           "getBaseFaceFVarValues"));
        return IndexArray();
    }
    Index const first = base._firstCorner[face];
    return IndexArray(base._channels[std::size_t(channel)].values.data() + first,
                      base._firstCorner[face + 1] - first);
}

std::unique_ptr<TopologyRefiner>
MeshRefinerFactoryBase::create(Sdc::Options sdcOptions, TopologyRefinerFactory::Options options,
                               CallStatus *status, Function const &resize, Function const &assign,
                               Function const &assignTags, Function const &assignFaceVarying) {
    return TopologyRefinerFactory::create(
        sdcOptions, options, status, [&](internal::BaseMesh &mesh) {
            BaseTopology base(mesh);
            internal::Level &level = mesh.GetLevel();
            using Stage = BaseTopology::Stage;
            auto const call = [&](Function const &function, Stage stage) {
                base._stage = stage;
                if (!function(base)) {
                    base.refuse(internal::Failure(StatusCode::InvalidTopology,
                                                  std::string(BaseTopology::getName(stage)) +
                                                      " returned false"));
                }
                return base._status;
            };
            CallStatus result = call(resize, Stage::Resize);
            base._faceSizes = nullptr;
            if (result.IsOk()) {
                result = mesh.CompleteSizes();
            }
            if (result.IsOk()) {
                fill(level.faceVerts, std::size_t(level.numCorners), kUnassigned);
                base._firstCorner = level.faceFirstCorner.data();
                base._faceVerts = level.faceVerts.data();
                result = call(assign, Stage::Assign);
                base._faceVerts = nullptr;
            }
            if (result.IsOk()) {
                result = mesh.CheckFaces();
            }
            if (result.IsOk()) {
                result = mesh.CompleteTopology();
            }
            CallStatus const topology = result; // with its warnings
            if (result.IsOk()) {
                result = call(assignTags, Stage::AssignTags);
            }
            if (result.IsOk()) {
                mesh.CompleteTags();
                result = call(assignFaceVarying, Stage::AssignFaceVarying);
            }
            for (std::size_t i = 0; i < base._channels.size() && result.IsOk(); ++i) {
                BaseTopology::Channel &channel = base._channels[i];
                result = internal::CheckValues(channel.values.data(), level.numCorners,
                                               channel.numValues, int(i));
                if (result.IsOk()) {
                    result = mesh.AddChannel(channel.numValues, std::move(channel.values),
                                             channel.interpolation);
                }
            }
            return result.IsOk() ? topology : result;
        });
}

} // namespace OpenSubdivHex::FarExt

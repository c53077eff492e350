// SPDX-License-Identifier: Apache-2.0
#include "topologyRefinerFactory.h"

#include "far_ext/vtr/baseMesh.h"
#include "far_ext/vtr/inputChecks.h"
#include "far_ext/vtr/parallel.h"
#include "far_ext/vtr/report.h"

#include <algorithm>

namespace OpenSubdivHex::FarExt {

namespace internal {

namespace {

using Far::ConstIndexArray;
using Far::ConstLocalIndexArray;
using Far::Index;

// Reads a refiner step by step.
class RefinerReader {
public:
    RefinerReader(Far::TopologyRefiner const &base, BaseMesh &mesh)
        : _refiner(base), _base(base.GetLevel(0)), _mesh(mesh), _level(mesh.GetLevel()) {}

    CallStatus Read();

private:
    CallStatus readFaces();
    CallStatus readEdges();
    bool isSide(Index edge, Index face, int local) const;
    bool readEdge(Index edge, EdgeSides &sides) const;
    CallStatus readApartEdge(Index edge, std::vector<ApartSide> &sides) const;
    CallStatus readTags();
    bool isHole(Index face) const;
    CallStatus readChannel(int channel);

    bool isFree() const {
        return _mesh.GetSchemeOptions().GetVtxBoundaryInterpolation() ==
               Sdc::Options::VTX_BOUNDARY_NONE;
    }

    Far::TopologyRefiner const &_refiner;
    Far::TopologyLevel const &_base;
    BaseMesh &_mesh;
    Level &_level;
};

CallStatus RefinerReader::readFaces() {
    _mesh.SetNumVertices(_base.GetNumVertices());
    _mesh.SetNumFaces(_base.GetNumFaces());
    ParallelFor(_level.numFaces, [&](Index face) {
        _mesh.GetFaceSizes()[face] = _base.GetFaceVertices(face).size();
    });
    CallStatus status = _mesh.CompleteSizes();
    if (!status.IsOk()) {
        return status;
    }
    // The vertices of faces follow one another in Far's levels, too.
    ParallelForRange(_level.numFaces, [&](Index begin, Index end) {
        Index const first = _level.faceFirstCorner[begin];
        std::copy_n(_base.GetFaceVertices(begin).begin(), _level.faceFirstCorner[end] - first,
                    _level.faceVerts.data() + first);
    });
    return _mesh.CheckFaces();
}

// Whether a face has an edge where this says it has.
bool RefinerReader::isSide(Index edge, Index face, int local) const {
    if (face < 0 || face >= _level.numFaces || local >= _level.GetFaceSize(face) ||
        _base.GetFaceEdges(face)[local] != edge) {
        return false;
    }
    ConstIndexArray const verts = _base.GetEdgeVertices(edge);
    Index const corner = _level.faceFirstCorner[face] + local;
    Index const start = _level.faceVerts[corner];
    Index const end = _level.faceVerts[_level.GetNextCorner(face, corner)];
    return (start == verts[0] && end == verts[1]) || (start == verts[1] && end == verts[0]);
}

// Takes an edge that bounds one face, or joins two which run it in opposite directions; false for
// any other.
bool RefinerReader::readEdge(Index edge, EdgeSides &sides) const {
    ConstIndexArray const verts = _base.GetEdgeVertices(edge);
    ConstIndexArray const faces = _base.GetEdgeFaces(edge);
    ConstLocalIndexArray const locals = _base.GetEdgeFaceLocalIndices(edge);
    int const numFaces = faces.size();
    if (numFaces < 1 || numFaces > 2 || verts[0] == verts[1] || _base.IsEdgeNonManifold(edge)) {
        return false;
    }
    sides = {{Far::INDEX_INVALID, isFree() ? kFreeBoundary : kSharpBoundaryA}};
    for (int i = 0; i < numFaces; ++i) {
        if (!isSide(edge, faces[i], locals[i])) {
            return false;
        }
        // The first of two sides runs from the first vertex to the second.
        Index const corner = _level.faceFirstCorner[faces[i]] + locals[i];
        sides.corners[numFaces == 2 && _level.faceVerts[corner] == verts[1]] = corner;
    }
    return sides.corners[0] >= 0 &&
           (numFaces == 1 || (sides.corners[1] >= 0 && faces[0] != faces[1]));
}

// Adds the sides of an edge that comes apart, once it is sure that the base is right there.
CallStatus RefinerReader::readApartEdge(Index edge, std::vector<ApartSide> &sides) const {
    auto const refuse = [&](std::string const &what) {
        return CallStatus(StatusCode::InvalidTopology, ComponentType::Edge, edge,
                          "edge " + std::to_string(edge) + what);
    };
    ConstIndexArray const verts = _base.GetEdgeVertices(edge);
    ConstIndexArray const faces = _base.GetEdgeFaces(edge);
    ConstLocalIndexArray const locals = _base.GetEdgeFaceLocalIndices(edge);
    if (faces.empty()) {
        return refuse(" has no face");
    }
    std::vector<Index> corners;
    for (int i = 0; i < faces.size(); ++i) {
        if (!isSide(edge, faces[i], locals[i])) {
            return refuse(", of vertices " + std::to_string(verts[0]) + " and " +
                          std::to_string(verts[1]) + ", is not edge " + std::to_string(locals[i]) +
                          " of face " + std::to_string(faces[i]));
        }
        corners.push_back(_level.faceFirstCorner[faces[i]] + locals[i]);
        sides.push_back({edge, corners.back()});
    }
    std::sort(corners.begin(), corners.end());
    if (std::adjacent_find(corners.begin(), corners.end()) != corners.end()) {
        return refuse(" has a side of a face twice");
    }
    return CallStatus();
}

CallStatus RefinerReader::readEdges() {
    if (_mesh.CompleteTopology(_base)) {
        return CallStatus();
    }
    Index const numEdges = _base.GetNumEdges();
    std::vector<std::int64_t> const numSides =
        ParallelSums<std::int64_t>(numEdges, [this](Index begin, Index end) {
            std::int64_t sum = 0;
            for (Index edge = begin; edge < end; ++edge) {
                sum += _base.GetEdgeFaces(edge).size();
            }
            return sum;
        });
    if (numSides.back() != _level.numCorners) {
        return Failure(StatusCode::InvalidTopology,
                       "the edges of the base have " + std::to_string(numSides.back()) +
                           " faces together, but its faces have " +
                           std::to_string(_level.numCorners) + " edges");
    }
    Buffer<EdgeSides> edges;
    edges.Resize(std::size_t(numEdges));
    std::vector<Index> const apart = ParallelSelect(
        numEdges, [&](Index edge) { return !readEdge(edge, edges[std::size_t(edge)]); });
    std::vector<ApartSide> sides;
    for (Index edge : apart) {
        if (CallStatus status = readApartEdge(edge, sides); !status.IsOk()) {
            return status;
        }
    }
    return _mesh.CompleteTopology(std::move(edges), std::move(sides));
}

// With VTX_BOUNDARY_NONE Far makes holes of all faces at the boundary, to leave them out of its limit
// surface; the paper's rule keeps them.
bool RefinerReader::isHole(Index face) const {
    ConstIndexArray const verts = _base.GetFaceVertices(face);
    return _base.IsFaceHole(face) &&
           !(isFree() && std::any_of(verts.begin(), verts.end(),
                                     [&](Index vert) { return _base.IsVertexBoundary(vert); }));
}

CallStatus RefinerReader::readTags() {
    auto const isNotSmooth = [](float sharpness) { return !(sharpness == 0); };
    for (Index edge : ParallelSelect(_base.GetNumEdges(), [&](Index edge) {
             return isNotSmooth(_base.GetEdgeSharpness(edge));
         })) {
        float const sharpness = _base.GetEdgeSharpness(edge);
        ConstIndexArray const verts = _base.GetEdgeVertices(edge);
        CallStatus status = CheckSharpness(sharpness, ComponentType::Edge, edge, [&] {
            return "edge " + std::to_string(edge) + ", of vertices " + std::to_string(verts[0]) +
                   " and " + std::to_string(verts[1]) + ",";
        });
        if (!status.IsOk()) {
            return status;
        }
        _mesh.SetEdgeSharpness(edge, sharpness);
    }
    for (Index vert : ParallelSelect(_base.GetNumVertices(), [&](Index vert) {
             return isNotSmooth(_base.GetVertexSharpness(vert));
         })) {
        float const sharpness = _base.GetVertexSharpness(vert);
        CallStatus status = CheckSharpness(sharpness, ComponentType::Vertex, vert,
                                           [&] { return "vertex " + std::to_string(vert); });
        if (!status.IsOk()) {
            return status;
        }
        _mesh.SetVertexSharpness(vert, sharpness);
    }
    for (Index face :
         ParallelSelect(_level.numFaces, [this](Index face) { return isHole(face); })) {
        _mesh.SetHole(face, true);
    }
    _mesh.CompleteTags();
    return CallStatus();
}

CallStatus RefinerReader::readChannel(int channel) {
    Buffer<Index> values;
    values.Resize(_level.numCorners);
    ParallelForRange(_level.numFaces, [&](Index begin, Index end) {
        Index const first = _level.faceFirstCorner[begin];
        std::copy_n(_base.GetFaceFVarValues(begin, channel).begin(),
                    _level.faceFirstCorner[end] - first, values.data() + first);
    });
    Index const numValues = _base.GetNumFVarValues(channel);
    CallStatus status = CheckValues(values.data(), _level.numCorners, numValues, channel);
    return status.IsOk() ? _mesh.AddChannel(numValues, std::move(values),
                                            _refiner.GetFVarLinearInterpolation(channel))
                         : status;
}

CallStatus RefinerReader::Read() {
    CallStatus status = readFaces();
    if (status.IsOk()) {
        status = readEdges();
    }
    CallStatus const topology = status; // with its warnings
    if (status.IsOk()) {
        status = readTags();
    }
    for (int channel = 0; channel < _base.GetNumFVarChannels() && status.IsOk(); ++channel) {
        status = readChannel(channel);
    }
    return status.IsOk() ? topology : status;
}

// Reads a descriptor step by step.
class DescriptorReader {
public:
    DescriptorReader(Far::TopologyDescriptor const &descriptor, BaseMesh &mesh)
        : _descriptor(descriptor), _mesh(mesh), _level(mesh.GetLevel()) {}

    CallStatus Read();

private:
    CallStatus readFaces();
    CallStatus readCreases();
    CallStatus readTags();
    CallStatus readChannel(int channel);
    void copyCorners(Index const *from, Buffer<Index> &to) const;

    Far::TopologyDescriptor const &_descriptor;
    BaseMesh &_mesh;
    Level &_level;
};

// Copies an item for each corner of all faces; in left-handed faces the other way round, from their
// first corner on.
void DescriptorReader::copyCorners(Index const *from, Buffer<Index> &to) const {
    to.Resize(_level.numCorners);
    ParallelForRange(_level.numFaces, [&](Index begin, Index end) {
        Index const first = _level.faceFirstCorner[begin];
        std::copy(from + first, from + _level.faceFirstCorner[end], to.data() + first);
        for (Index face = begin; face < end && _descriptor.isLeftHanded; ++face) {
            std::reverse(to.data() + _level.faceFirstCorner[face] + 1,
                         to.data() + _level.faceFirstCorner[face + 1]);
        }
    });
}

CallStatus DescriptorReader::readFaces() {
    CallStatus status = CheckCounts(_descriptor.numVertices, _descriptor.numFaces);
    if (status.IsOk()) {
        status = CheckArrays(_descriptor);
    }
    if (!status.IsOk()) {
        return status;
    }
    _mesh.SetNumVertices(_descriptor.numVertices);
    _mesh.SetNumFaces(_descriptor.numFaces);
    ParallelForRange(_level.numFaces, [&](Index begin, Index end) {
        std::copy(_descriptor.numVertsPerFace + begin, _descriptor.numVertsPerFace + end,
                  _mesh.GetFaceSizes() + begin);
    });
    status = _mesh.CompleteSizes();
    if (!status.IsOk()) {
        return status;
    }
    copyCorners(_descriptor.vertIndicesPerFace, _level.faceVerts);
    status = _mesh.CheckFaces();
    return status.IsOk() ? _mesh.CompleteTopology() : status;
}

// Far skips a crease that is no edge with a warning; here it is an error.
CallStatus DescriptorReader::readCreases() {
    for (int i = 0; i < _descriptor.numCreases; ++i) {
        Index const *verts = _descriptor.creaseVertexIndexPairs + 2 * std::ptrdiff_t(i);
        float const sharpness = _descriptor.creaseWeights[i];
        CallStatus status = CheckSharpness(sharpness, ComponentType::Vertex, verts[0], [&] {
            return "crease " + std::to_string(i) + ", of vertices " + std::to_string(verts[0]) +
                   " and " + std::to_string(verts[1]) + ",";
        });
        for (int end = 0; end < 2 && status.IsOk(); ++end) {
            status = CheckIndex(verts[end], _level.numVertices, ComponentType::Vertex,
                                [&] { return "crease " + std::to_string(i); });
        }
        if (!status.IsOk()) {
            return status;
        }
        Index const edge = _mesh.FindEdge(verts[0], verts[1]);
        if (edge == Far::INDEX_INVALID) {
            return CallStatus(StatusCode::InvalidTopology, ComponentType::Vertex, verts[0],
                              "crease " + std::to_string(i) + " joins vertices " +
                                  std::to_string(verts[0]) + " and " + std::to_string(verts[1]) +
                                  ", but no face has that edge");
        }
        _mesh.SetEdgeSharpness(edge, sharpness);
    }
    return CallStatus();
}

CallStatus DescriptorReader::readTags() {
    CallStatus status = readCreases();
    for (int i = 0; i < _descriptor.numCorners && status.IsOk(); ++i) {
        Index const vert = _descriptor.cornerVertexIndices[i];
        float const sharpness = _descriptor.cornerWeights[i];
        status = CheckIndex(vert, _level.numVertices, ComponentType::Vertex,
                            [&] { return "corner " + std::to_string(i); });
        if (status.IsOk()) {
            status = CheckSharpness(sharpness, ComponentType::Vertex, vert, [&] {
                return "corner " + std::to_string(i) + ", vertex " + std::to_string(vert) + ",";
            });
        }
        if (status.IsOk()) {
            _mesh.SetVertexSharpness(vert, sharpness);
        }
    }
    for (int i = 0; i < _descriptor.numHoles && status.IsOk(); ++i) {
        Index const face = _descriptor.holeIndices[i];
        status = CheckIndex(face, _level.numFaces, ComponentType::Face,
                            [&] { return "hole " + std::to_string(i); });
        if (status.IsOk()) {
            _mesh.SetHole(face, true);
        }
    }
    if (status.IsOk()) {
        _mesh.CompleteTags();
    }
    return status;
}

CallStatus DescriptorReader::readChannel(int channel) {
    Far::TopologyDescriptor::FVarChannel const &fvar = _descriptor.fvarChannels[channel];
    CallStatus status = CheckValues(fvar.valueIndices, _level.numCorners, fvar.numValues, channel);
    if (!status.IsOk()) {
        return status;
    }
    Buffer<Index> values;
    copyCorners(fvar.valueIndices, values);
    return _mesh.AddChannel(fvar.numValues, std::move(values),
                            _mesh.GetSchemeOptions().GetFVarLinearInterpolation());
}

CallStatus DescriptorReader::Read() {
    CallStatus status = readFaces();
    CallStatus const topology = status; // with its warnings
    if (status.IsOk()) {
        status = readTags();
    }
    for (int channel = 0; channel < _descriptor.numFVarChannels && status.IsOk(); ++channel) {
        status = readChannel(channel);
    }
    return status.IsOk() ? topology : status;
}

} // namespace
} // namespace internal

// The refiner of a base that read(mesh) reads.
std::unique_ptr<TopologyRefiner>
TopologyRefinerFactory::create(Sdc::Options sdcOptions, Options options, CallStatus *status,
                               std::function<CallStatus(internal::BaseMesh &)> const &read) {
    CallStatus result = internal::CheckOptions(options.hexSchemeOptions, sdcOptions);
    internal::BaseMesh mesh(sdcOptions);
    if (result.IsOk()) {
        result = read(mesh);
    }
    std::unique_ptr<internal::Hierarchy> hierarchy = mesh.Release();
    if (result.IsOk()) {
        if (CallStatus scheme = internal::CheckScheme(options.hexSchemeOptions, *hierarchy);
            !scheme.IsOk()) {
            result = std::move(scheme);
        }
    }
    if (!internal::Report(result, status)) {
        return nullptr;
    }
    return std::make_unique<TopologyRefiner>(std::move(hierarchy), sdcOptions,
                                             options.hexSchemeOptions);
}

std::unique_ptr<TopologyRefiner> TopologyRefinerFactory::Create(Far::TopologyRefiner const &base,
                                                                Options options,
                                                                CallStatus *status) {
    return create(base.GetSchemeOptions(), options, status, [&](internal::BaseMesh &mesh) {
        return internal::RefinerReader(base, mesh).Read();
    });
}

std::unique_ptr<TopologyRefiner>
TopologyRefinerFactory::Create(Far::TopologyDescriptor const &descriptor, Sdc::Options sdcOptions,
                               Options options, CallStatus *status) {
    return create(sdcOptions, options, status, [&](internal::BaseMesh &mesh) {
        return internal::DescriptorReader(descriptor, mesh).Read();
    });
}

} // namespace OpenSubdivHex::FarExt

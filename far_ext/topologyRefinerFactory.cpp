// SPDX-License-Identifier: Apache-2.0
#include "topologyRefinerFactory.h"

#include "baseLevel.h"
#include "fvarLevel.h"
#include "parallel.h"
#include "sharpFeatures.h"
#include "vertexFan.h"

#include <opensubdiv/far/topologyRefinerFactory.h>
#include <opensubdiv/vtr/fvarLevel.h>

#include <algorithm>
#include <limits>
#include <set>

namespace OpenSubdivHex::FarExt {

using Far::ConstIndexArray;
using Far::Index;
using internal::EdgeSides;
using internal::LevelTopology;

namespace {

std::string str(std::int64_t number) { return std::to_string(number); }

Status invalid(ComponentType component, Index index, std::string message) {
    return Status(StatusCode::InvalidTopology, component, index, std::move(message));
}

// Checks what can be wrong in face-vertices alone; used for both kinds of input.
class FaceVertexChecker {
public:
    explicit FaceVertexChecker(Index numVertices) : _numFaces(numVertices, 0) {}

    Status Check(Index face, ConstIndexArray verts) {
        if (verts.size() < 3) {
            return invalid(ComponentType::Face, face,
                           "face " + str(face) + " has " + str(verts.size()) +
                               " vertices, but a face needs at least 3");
        }
        if (verts.size() > OpenSubdiv::Vtr::VALENCE_LIMIT) {
            return Status(StatusCode::TooLarge, ComponentType::Face, face,
                          "face " + str(face) + " has " + str(verts.size()) +
                              " vertices, more than the " + str(OpenSubdiv::Vtr::VALENCE_LIMIT) +
                              " that OpenSubdiv's local indices reach");
        }
        for (Index vert : verts) {
            if (vert < 0 || vert >= Index(_numFaces.size())) {
                return invalid(ComponentType::Face, face,
                               "face " + str(face) + " refers to vertex " + str(vert) +
                                   ", but vertices go from 0 to " + str(_numFaces.size() - 1));
            }
            // Far counts the edges of a vertex, of which a boundary vertex has one more.
            if (++_numFaces[vert] >= OpenSubdiv::Vtr::VALENCE_LIMIT) {
                return Status(StatusCode::TooLarge, ComponentType::Vertex, vert,
                              "vertex " + str(vert) + " has " + str(_numFaces[vert]) +
                                  " faces, as many as OpenSubdiv's valences reach");
            }
        }
        return Status();
    }

private:
    std::vector<int> _numFaces; // of a vertex
};

Status checkInventory(std::int64_t numVertices, std::int64_t numFaces) {
    if (numVertices <= 0 || numFaces <= 0) {
        return invalid(ComponentType::None, Far::INDEX_INVALID,
                       "the mesh is empty: it has " + str(numVertices) + " vertices and " +
                           str(numFaces) + " faces");
    }
    return Status();
}

Status checkRange(std::string const &name, Index index, int count, ComponentType component) {
    if (0 <= index && index < count) {
        return Status();
    }
    return invalid(component, index,
                   name + " refers to " + str(index) + ", but indices go from 0 to " +
                       str(count - 1));
}

Status invalidArgument(std::string message) {
    return Status(StatusCode::InvalidArgument, ComponentType::None, Far::INDEX_INVALID,
                  std::move(message));
}

// An array of a descriptor that has a count.
Status checkArray(int count, void const *array, std::string const &name) {
    if (count < 0) {
        return invalidArgument("the descriptor has " + str(count) + " entries in " + name);
    }
    if (count > 0 && !array) {
        return invalidArgument("the descriptor has no array " + name + ", but " + str(count) +
                               " entries in it");
    }
    return Status();
}

template <typename ENUM>
Status checkEnum(int value, ENUM last, std::string const &name) {
    return internal::IsInEnum(value, last)
               ? Status()
               : invalidArgument("there is no " + name + " " + str(value));
}

Status checkOptions(SchemeOptions schemeOptions, Sdc::Options sdcOptions) {
    for (Status const &status :
         {checkEnum(int(schemeOptions.faceMask), FaceMask::Smooth, "faceMask"),
          checkEnum(int(schemeOptions.schemeType), SchemeType::TriHex, "schemeType"),
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
    return Status();
}

// Not a number is less than 0, too.
Status checkSharpness(float sharpness, ComponentType component, Index index,
                      std::string const &name) {
    if (sharpness >= 0) {
        return Status();
    }
    return invalid(component, index,
                   name + " has sharpness " + std::to_string(sharpness) +
                       ", but a sharpness is 0 or more");
}

// Far skips a crease that is no edge with a warning; here it is an error.
Status checkCreases(Far::TopologyDescriptor const &descriptor) {
    using Pair = std::pair<Index, Index>;
    std::set<Pair> missing;
    for (int i = 0; i < descriptor.numCreases; ++i) {
        Index const *verts = descriptor.creaseVertexIndexPairs + 2 * std::ptrdiff_t(i);
        Status sharp = checkSharpness(descriptor.creaseWeights[i], ComponentType::Vertex, verts[0],
                                      "crease " + str(i) + ", of vertices " + str(verts[0]) +
                                          " and " + str(verts[1]) + ",");
        if (!sharp.IsOk()) {
            return sharp;
        }
        for (int end = 0; end < 2; ++end) {
            Status status = checkRange("crease " + str(i), verts[end], descriptor.numVertices,
                                       ComponentType::Vertex);
            if (!status.IsOk()) {
                return status;
            }
        }
        missing.insert(std::minmax(verts[0], verts[1]));
    }
    Index const *verts = descriptor.vertIndicesPerFace;
    for (Index face = 0; face < descriptor.numFaces && !missing.empty(); ++face) {
        int const size = descriptor.numVertsPerFace[face];
        for (int i = 0; i < size; ++i) {
            missing.erase(std::minmax(verts[i], verts[(i + 1) % size]));
        }
        verts += size;
    }
    if (missing.empty()) {
        return Status();
    }
    return invalid(ComponentType::Vertex, missing.begin()->first,
                   "a crease joins vertices " + str(missing.begin()->first) + " and " +
                       str(missing.begin()->second) + ", but no face has that edge");
}

Status checkArrays(Far::TopologyDescriptor const &descriptor) {
    Status status;
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
            status = invalidArgument("face-varying channel " + str(channel) +
                                     (fvar.valueIndices ? " has " + str(fvar.numValues) + " values"
                                                        : " has no array valueIndices"));
        }
    }
    return status;
}

Status checkTags(Far::TopologyDescriptor const &descriptor) {
    Status status = checkCreases(descriptor);
    for (int i = 0; i < descriptor.numCorners && status.IsOk(); ++i) {
        Index const vert = descriptor.cornerVertexIndices[i];
        status =
            checkRange("corner " + str(i), vert, descriptor.numVertices, ComponentType::Vertex);
        if (status.IsOk()) {
            status = checkSharpness(descriptor.cornerWeights[i], ComponentType::Vertex, vert,
                                    "corner " + str(i) + ", vertex " + str(vert) + ",");
        }
    }
    for (int i = 0; i < descriptor.numHoles && status.IsOk(); ++i) {
        status = checkRange("hole " + str(i), descriptor.holeIndices[i], descriptor.numFaces,
                            ComponentType::Face);
    }
    std::int64_t numCorners = 0;
    for (Index face = 0; face < descriptor.numFaces; ++face) {
        numCorners += descriptor.numVertsPerFace[face];
    }
    for (int channel = 0; channel < descriptor.numFVarChannels; ++channel) {
        Far::TopologyDescriptor::FVarChannel const &fvar = descriptor.fvarChannels[channel];
        for (std::int64_t corner = 0; corner < numCorners && status.IsOk(); ++corner) {
            status =
                checkRange("corner " + str(corner) + " of face-varying channel " + str(channel),
                           fvar.valueIndices[corner], fvar.numValues, ComponentType::None);
        }
    }
    return status;
}

Status checkDescriptor(Far::TopologyDescriptor const &descriptor) {
    Status status = checkInventory(descriptor.numVertices, descriptor.numFaces);
    if (status.IsOk()) {
        status = checkArrays(descriptor);
    }
    if (!status.IsOk()) {
        return status;
    }
    std::int64_t numCorners = 0;
    for (Index face = 0; face < descriptor.numFaces; ++face) {
        numCorners += descriptor.numVertsPerFace[face];
    }
    if (numCorners > std::numeric_limits<Index>::max()) {
        return Status(StatusCode::TooLarge, ComponentType::Level, 0,
                      "level 0 would have " + str(numCorners) +
                          " face-vertices, more than 32-bit indices reach");
    }
    FaceVertexChecker checker(descriptor.numVertices);
    Index const *verts = descriptor.vertIndicesPerFace;
    for (Index face = 0; face < descriptor.numFaces && status.IsOk(); ++face) {
        int const size = descriptor.numVertsPerFace[face];
        status = checker.Check(face, ConstIndexArray(verts, size));
        verts += size;
    }
    return status.IsOk() ? checkTags(descriptor) : status;
}

Status checkFaces(Far::TopologyLevel const &base) {
    Status status = checkInventory(base.GetNumVertices(), base.GetNumFaces());
    FaceVertexChecker checker(base.GetNumVertices());
    for (Index face = 0; face < base.GetNumFaces() && status.IsOk(); ++face) {
        status = checker.Check(face, base.GetFaceVertices(face));
    }
    return status;
}

Status checkSharpnesses(Far::TopologyLevel const &base) {
    Status status;
    for (Index edge = 0; edge < base.GetNumEdges() && status.IsOk(); ++edge) {
        if (!(base.GetEdgeSharpness(edge) >= 0)) {
            ConstIndexArray const verts = base.GetEdgeVertices(edge);
            status = checkSharpness(base.GetEdgeSharpness(edge), ComponentType::Edge, edge,
                                    "edge " + str(edge) + ", of vertices " + str(verts[0]) +
                                        " and " + str(verts[1]) + ",");
        }
    }
    for (Index vert = 0; vert < base.GetNumVertices() && status.IsOk(); ++vert) {
        if (!(base.GetVertexSharpness(vert) >= 0)) {
            status = checkSharpness(base.GetVertexSharpness(vert), ComponentType::Vertex, vert,
                                    "vertex " + str(vert));
        }
    }
    return status;
}

// Takes apart a base level into faces and edges, and puts them together as level 0.
class Importer {
public:
    Importer(Far::TopologyRefiner const &base, bool const *isHole)
        : _base(base.GetLevel(0)), _baseRefiner(base), _isHole(isHole) {}

    /// Null with a status when an edge has no face; the status may have warnings.
    std::unique_ptr<LevelTopology> Import(Status &status);

private:
    void importFaces();
    Status importEdges();
    Status warnOfInconsistentOrientation(std::vector<Index> const &edges) const;
    bool joinSides(Index edge, int numCorners);
    void importTags();
    void importVertexTags();
    bool isPinned(Index vert) const;
    Status importChannel(int channel);
    Status followVertex(Index vert, int channel, std::vector<Index> const &faceValues,
                        std::vector<float> &sharpness) const;

    bool isFree() const {
        return _baseRefiner.GetSchemeOptions().GetVtxBoundaryInterpolation() ==
               Sdc::Options::VTX_BOUNDARY_NONE;
    }
    bool isHole(Index face) const;
    // Whether a side of an edge starts at the first vertex that the base gives the edge.
    bool isForward(Index edge, int side) const {
        return _level->faceVerts[_edges[edge].corners[side]] == _base.GetEdgeVertices(edge)[0];
    }

    Far::TopologyLevel const &_base;
    Far::TopologyRefiner const &_baseRefiner;
    bool const *_isHole; // by face; null when only the base knows

    std::unique_ptr<LevelTopology> _level;
    std::vector<Index> _faceOfCorner;
    std::vector<EdgeSides> _edges;
};

std::unique_ptr<LevelTopology> Importer::Import(Status &status) {
    _level = std::make_unique<LevelTopology>();
    _level->numVertices = _base.GetNumVertices();
    _level->numFaces = _base.GetNumFaces();
    _level->numCorners = _base.GetNumFaceVertices();
    importFaces();
    status = importEdges();
    if (!status.IsOk()) {
        return nullptr;
    }
    internal::BuildBaseLevel({_edges.data(), Index(_edges.size())}, *_level);
    importTags();
    internal::ComputeSharpMasks(_baseRefiner.GetSchemeOptions(), *_level);
    for (int channel = 0; channel < _base.GetNumFVarChannels() && status.IsOk(); ++channel) {
        if (Status result = importChannel(channel); !result.IsOk()) {
            status = std::move(result);
        }
    }
    return std::move(_level);
}

void Importer::importFaces() {
    _level->faceFirstCorner.Resize(std::size_t(_level->numFaces) + 1);
    _level->faceVerts.Resize(_level->numCorners);
    _faceOfCorner.resize(_level->numCorners);
    OpenSubdiv::Vtr::internal::Level const &base = _baseRefiner.getLevel(0);
    internal::ParallelFor(_level->numFaces, [&](Index face) {
        Index corner = base.getOffsetOfFaceVertices(face);
        _level->faceFirstCorner[face] = corner;
        for (Index vert : _base.GetFaceVertices(face)) {
            _faceOfCorner[corner] = face;
            _level->faceVerts[corner++] = vert;
        }
    });
    _level->faceFirstCorner[_level->numFaces] = _level->numCorners;
}

// Gives the sides of an edge that bounds one face, or joins two which run it in opposite
// directions, their order; false for any other edge.
bool Importer::joinSides(Index edge, int numCorners) {
    ConstIndexArray const verts = _base.GetEdgeVertices(edge);
    if (verts[0] == verts[1] || _base.IsEdgeNonManifold(edge)) {
        return false;
    }
    EdgeSides &sides = _edges[edge];
    if (numCorners == 1) {
        sides.corners[1] = isFree() ? internal::kFreeBoundary : internal::kSharpBoundaryA;
        return true;
    }
    if (numCorners != 2 || isForward(edge, 0) == isForward(edge, 1) ||
        _faceOfCorner[sides.corners[0]] == _faceOfCorner[sides.corners[1]]) {
        return false;
    }
    if (!isForward(edge, 0)) {
        std::swap(sides.corners[0], sides.corners[1]);
    }
    return true;
}

// An edge of any other kind comes apart: every face gets an edge of its own, the first of them with
// the edge's index.
Status Importer::importEdges() {
    _edges.assign(_base.GetNumEdges(), {{Far::INDEX_INVALID, Far::INDEX_INVALID}});
    std::vector<int> numCorners(_base.GetNumEdges(), 0);
    std::vector<std::pair<Index, Index>> others; // edge and corner, of third and later sides
    Index corner = 0;
    for (Index face = 0; face < _level->numFaces; ++face) {
        for (Index edge : _base.GetFaceEdges(face)) {
            if (numCorners[edge] < 2) {
                _edges[edge].corners[numCorners[edge]] = corner;
            } else {
                others.emplace_back(edge, corner);
            }
            ++numCorners[edge];
            ++corner;
        }
    }
    std::vector<Index> const irregular = internal::ParallelSelect(
        _base.GetNumEdges(), [&](Index edge) { return !joinSides(edge, numCorners[edge]); });
    std::vector<Index> inconsistent;             // edges that two faces run in the same direction
    std::vector<std::pair<Index, Index>> second; // sides of edges that come apart, with the edge
    for (Index edge : irregular) {
        EdgeSides &sides = _edges[edge];
        Index const start = _base.GetEdgeVertices(edge)[0];
        Index const end = _base.GetEdgeVertices(edge)[1];
        if (numCorners[edge] == 0) {
            return invalid(ComponentType::Edge, edge, "edge " + str(edge) + " has no face");
        }
        if (numCorners[edge] == 2 && start != end && isForward(edge, 0) == isForward(edge, 1) &&
            _faceOfCorner[sides.corners[0]] != _faceOfCorner[sides.corners[1]]) {
            inconsistent.push_back(edge);
        }
        _level->lineEdges.push_back({edge, edge});
        if (numCorners[edge] > 1) {
            second.emplace_back(sides.corners[1], edge);
        }
    }
    for (auto const &[edge, otherCorner] : others) {
        second.emplace_back(otherCorner, edge);
    }
    std::sort(second.begin(), second.end());
    Status status = warnOfInconsistentOrientation(inconsistent);
    for (Index edge : irregular) {
        _edges[edge].corners[1] = internal::kSharpBoundaryA;
    }
    for (auto const &[secondCorner, edge] : second) {
        _level->lineEdges.push_back({Index(_edges.size()), edge});
        _edges.push_back({{secondCorner, internal::kSharpBoundaryA}});
    }
    for (internal::LineEdge const &line : _level->lineEdges) {
        _level->nonManifoldEdges.push_back(line.edge);
    }
    return status;
}

// The edges still have both of their sides.
Status Importer::warnOfInconsistentOrientation(std::vector<Index> const &edges) const {
    Status status;
    if (!edges.empty()) {
        Index const edge = edges[0];
        ConstIndexArray const verts = _base.GetEdgeVertices(edge);
        status.AddWarning({WarningCode::InconsistentOrientation, ComponentType::Edge, edge,
                           std::int64_t(edges.size()),
                           "inconsistent orientation, taken as non-manifold: faces run " +
                               str(edges.size()) + (edges.size() == 1 ? " edge" : " edges") +
                               " in the same direction, first edge " + str(edge) +
                               " between vertices " + str(verts[0]) + " and " + str(verts[1]) +
                               ", of faces " + str(_faceOfCorner[_edges[edge].corners[0]]) +
                               " and " + str(_faceOfCorner[_edges[edge].corners[1]])});
    }
    return status;
}

bool Importer::isHole(Index face) const {
    if (_isHole) {
        return _isHole[face];
    }
    // With VTX_BOUNDARY_NONE Far makes holes of all faces at the boundary, to leave them out of its
    // limit surface; the paper's rule keeps them.
    ConstIndexArray const verts = _base.GetFaceVertices(face);
    bool const isImplied = isFree() && std::any_of(verts.begin(), verts.end(), [&](Index vert) {
                               return _base.IsVertexBoundary(vert);
                           });
    return _base.IsFaceHole(face) && !isImplied;
}

void Importer::importTags() {
    LevelTopology &level = *_level;
    // Edges that came apart are boundaries, so that the base's edges are all that can be creases.
    auto const isCrease = [&](Index edge) {
        return !level.IsBoundary(edge) && Sdc::Crease::IsSharp(_base.GetEdgeSharpness(edge));
    };
    if (!internal::ParallelSelect(_base.GetNumEdges(), isCrease).empty()) {
        level.edgeSharpness.Resize(level.numEdges);
        internal::ParallelFor(level.numEdges, [&](Index edge) {
            level.edgeSharpness[edge] = level.IsBoundary(edge) ? 0 : _base.GetEdgeSharpness(edge);
        });
    }
    importVertexTags();
    std::vector<Index> const holes =
        internal::ParallelSelect(level.numFaces, [this](Index face) { return isHole(face); });
    if (!holes.empty()) {
        level.faceHoles.Resize(level.numFaces);
        std::fill_n(level.faceHoles.data(), level.numFaces, static_cast<unsigned char>(false));
        for (Index face : holes) {
            level.faceHoles[face] = true;
        }
    }
}

// As Far's rule for non-manifold vertices: they stay, unless two edges that came apart meet there,
// with no other boundary, and more faces than the base has edges there: the vertex then lies inside
// of a curve that three or more sheets share.  A vertex that a face has several times stays, too.
bool Importer::isPinned(Index vert) const {
    std::set<Index> lines;
    Index numInterior = 0;
    for (Index i = _level->vertFirstEdge[vert]; i < _level->vertFirstEdge[vert + 1]; ++i) {
        Index const edge = _level->vertEdges[i];
        Index const line = _level->GetEdgeLine(edge);
        Index const *const verts = _level->edgeVerts.data() + 2 * std::size_t(edge);
        if (verts[0] == verts[1] || (_level->IsBoundary(edge) && line == Far::INDEX_INVALID)) {
            return true;
        }
        if (_level->IsBoundary(edge)) {
            lines.insert(line);
        } else {
            ++numInterior;
        }
    }
    std::set<Index> const faces(_level->vertFaces.begin() + _level->vertFirstFace[vert],
                                _level->vertFaces.begin() + _level->vertFirstFace[vert + 1]);
    Index const numFaces = _level->vertFirstFace[vert + 1] - _level->vertFirstFace[vert];
    return lines.size() != 2 || numFaces <= numInterior + 2 || Index(faces.size()) < numFaces;
}

// Far overlooks some of the vertices that a face has several times.
void Importer::importVertexTags() {
    LevelTopology &level = *_level;
    level.nonManifoldVerts = internal::ParallelSelect(level.numVertices, [&](Index vert) {
        int numFans = 0;
        internal::ForEachFan(level, vert, [&](internal::VertexFan const &) { ++numFans; });
        return numFans > 1 || _base.IsVertexNonManifold(vert);
    });
    // Long faces are looked at below.
    std::vector<Index> const candidates = internal::ParallelSelect(level.numFaces, [&](Index face) {
        constexpr Index kShort = 16;
        Index const *const verts = level.faceVerts.data() + level.faceFirstCorner[face];
        Index const *const end = level.faceVerts.data() + level.faceFirstCorner[face + 1];
        bool isRepeated = end - verts > kShort;
        for (Index const *vert = verts; vert < end && !isRepeated; ++vert) {
            isRepeated = std::find(verts, vert, *vert) != vert;
        }
        return isRepeated;
    });
    for (Index face : candidates) {
        std::vector<Index> verts(level.faceVerts.begin() + level.faceFirstCorner[face],
                                 level.faceVerts.begin() + level.faceFirstCorner[face + 1]);
        std::sort(verts.begin(), verts.end());
        for (std::size_t i = 1; i < verts.size(); ++i) {
            if (verts[i] == verts[i - 1]) {
                level.nonManifoldVerts.push_back(verts[i]);
            }
        }
    }
    for (internal::LineEdge const &line : level.lineEdges) {
        Index const *const verts = level.edgeVerts.data() + 2 * std::size_t(line.edge);
        level.nonManifoldVerts.insert(level.nonManifoldVerts.end(), verts, verts + 2);
    }
    std::sort(level.nonManifoldVerts.begin(), level.nonManifoldVerts.end());
    level.nonManifoldVerts.erase(
        std::unique(level.nonManifoldVerts.begin(), level.nonManifoldVerts.end()),
        level.nonManifoldVerts.end());
    auto const isSharp = [&](Index vert) {
        return Sdc::Crease::IsSharp(_base.GetVertexSharpness(vert));
    };
    if (level.nonManifoldVerts.empty() &&
        internal::ParallelSelect(level.numVertices, isSharp).empty()) {
        return;
    }
    level.vertSharpness.Resize(level.numVertices);
    internal::ParallelFor(level.numVertices, [&](Index vert) {
        level.vertSharpness[vert] = _base.GetVertexSharpness(vert);
    });
    for (Index vert : level.nonManifoldVerts) {
        if (isPinned(vert)) {
            level.vertSharpness[vert] = Sdc::Crease::SHARPNESS_INFINITE;
        }
    }
}

// What a value without seams at a non-manifold vertex needs to move as the vertex does, where that
// lies inside of a curve of several sheets: each fan of faces has a value of its own, which sees the
// sharp edges of its fan alone.
Status Importer::followVertex(Index vert, int channel, std::vector<Index> const &faceValues,
                              std::vector<float> &sharpness) const {
    LevelTopology const &level = *_level;
    std::vector<Index> corners;
    for (Index k = level.vertFirstFace[vert]; k < level.vertFirstFace[vert + 1]; ++k) {
        corners.push_back(level.GetVertexCorner(k));
    }
    auto const isSeam = [&](Index corner) { return faceValues[corner] != faceValues[corners[0]]; };
    if (std::any_of(corners.begin(), corners.end(), isSeam)) {
        return Status();
    }
    float sharpest = 0;
    for (Index i = level.vertFirstEdge[vert]; i < level.vertFirstEdge[vert + 1]; ++i) {
        sharpest = std::max(sharpest, level.GetEdgeSharpness(level.vertEdges[i]));
    }
    if (Sdc::Crease::IsInfinite(std::max(sharpest, level.GetVertexSharpness(vert)))) {
        for (Index corner : corners) {
            sharpness[corner] = Sdc::Crease::SHARPNESS_INFINITE;
        }
        return Status();
    }
    bool isSeenByAll = !Sdc::Crease::IsSharp(sharpest);
    internal::ForEachFan(level, vert, [&](internal::VertexFan const &fan) {
        Index const first = level.GetVertexCorner(fan.begin);
        Index const last =
            level.GetPrevCorner(level.vertFaces[fan.end - 1], level.GetVertexCorner(fan.end - 1));
        isSeenByAll =
            isSeenByAll && !fan.isClosed &&
            level.GetEdgeLine(level.faceEdges[first]) != level.GetEdgeLine(level.faceEdges[last]);
    });
    if (isSeenByAll) {
        return Status();
    }
    return Status(StatusCode::Unsupported, ComponentType::Vertex, vert,
                  "face-varying channel " + str(channel) + " has no seam at vertex " + str(vert) +
                      ", where faces do not all meet both ends of a non-manifold curve, or a "
                      "semi-sharp crease meets it");
}

// Far's tags tell which values stay (corners, and all boundary values with linear boundaries) and
// which follow a curve along their seams.
Status Importer::importChannel(int channel) {
    OpenSubdiv::Vtr::internal::FVarLevel const &fvar =
        _baseRefiner.getLevel(0).getFVarLevel(channel);
    std::vector<Index> faceValues;
    faceValues.reserve(_level->numCorners);
    for (Index face = 0; face < _level->numFaces; ++face) {
        ConstIndexArray const values = _base.GetFaceFVarValues(face, channel);
        faceValues.insert(faceValues.end(), values.begin(), values.end());
    }
    // By corner, since every vertex that a value is shared by has its own rule.
    std::vector<float> sharpness(_level->numCorners, 0.0f);
    for (Index vert = 0; vert < _level->numVertices && !fvar.isLinear(); ++vert) {
        ConstIndexArray const faces = _base.GetVertexFaces(vert);
        auto const tags = fvar.getVertexValueTags(vert);
        auto const siblings = fvar.getVertexFaceSiblings(vert);
        for (int i = 0; i < faces.size(); ++i) {
            auto const tag = tags[siblings[i]];
            float valueSharpness = _level->GetVertexSharpness(vert);
            if (tag.isMismatch() && !tag.isSemiSharp()) {
                valueSharpness = tag.isInfSharp() ? Sdc::Crease::SHARPNESS_INFINITE
                                                  : Sdc::Crease::SHARPNESS_SMOOTH;
            }
            Index const corner =
                _level->faceFirstCorner[faces[i]] + _base.GetVertexFaceLocalIndices(vert)[i];
            sharpness[corner] = valueSharpness;
        }
    }
    for (Index vert : _level->nonManifoldVerts) {
        Status status =
            fvar.isLinear() ? Status() : followVertex(vert, channel, faceValues, sharpness);
        if (!status.IsOk()) {
            return status;
        }
    }
    Sdc::Options options = _baseRefiner.GetSchemeOptions();
    options.SetFVarLinearInterpolation(_baseRefiner.GetFVarLinearInterpolation(channel));
    _level->fvarLevels.push_back(std::make_unique<internal::FVarLevel>());
    internal::BuildFVarLevel(*_level, _base.GetNumFVarValues(channel), faceValues, sharpness,
                             options, *_level->fvarLevels.back());
    return Status();
}

// Schemes without rules for sharp features and seams take none.
Status checkScheme(SchemeOptions schemeOptions, LevelTopology const &level) {
    auto const unsupported = [](ComponentType component, Index index, std::string const &what) {
        return Status(StatusCode::Unsupported, component, index,
                      what + ", which only the hexagonal scheme has rules for");
    };
    if (schemeOptions.IsHexagonal()) {
        return Status();
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
        bool const isInterior = level.vertFirstFace[vert] < level.vertFirstFace[vert + 1] &&
                                !TopologyLevel(&level).IsVertexBoundary(vert);
        if (isInterior && Sdc::Crease::IsSharp(level.GetVertexSharpness(vert))) {
            return unsupported(ComponentType::Vertex, vert,
                               "vertex " + std::to_string(vert) + " is a sharp corner");
        }
    }
    if (!level.fvarLevels.empty()) {
        return unsupported(ComponentType::None, Far::INDEX_INVALID,
                           "the mesh has face-varying channels");
    }
    return Status();
}

std::unique_ptr<TopologyRefiner> create(Far::TopologyRefiner const &base, bool const *isHole,
                                        TopologyRefinerFactory::Options options, Status *status) {
    Status result = checkOptions(options.schemeOptions, base.GetSchemeOptions());
    if (result.IsOk()) {
        result = checkFaces(base.GetLevel(0));
    }
    if (result.IsOk()) {
        result = checkSharpnesses(base.GetLevel(0));
    }
    std::unique_ptr<LevelTopology> level;
    if (result.IsOk()) {
        level = Importer(base, isHole).Import(result);
    }
    if (result.IsOk()) {
        if (Status scheme = checkScheme(options.schemeOptions, *level); !scheme.IsOk()) {
            result = std::move(scheme);
        }
    }
    if (!internal::Report(result, status)) {
        return nullptr;
    }
    return std::make_unique<TopologyRefiner>(std::move(level), base.GetSchemeOptions(),
                                             options.schemeOptions);
}

} // namespace

std::unique_ptr<TopologyRefiner> TopologyRefinerFactory::Create(Far::TopologyRefiner const &base,
                                                                Options options, Status *status) {
    return create(base, nullptr, options, status);
}

std::unique_ptr<TopologyRefiner>
TopologyRefinerFactory::Create(Far::TopologyDescriptor const &descriptor, Sdc::Options sdcOptions,
                               Options options, Status *status) {
    Status result = checkOptions(options.schemeOptions, sdcOptions);
    if (result.IsOk()) {
        result = checkDescriptor(descriptor);
    }
    if (!internal::Report(result, status)) {
        return nullptr;
    }
    using FarFactory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
    std::unique_ptr<Far::TopologyRefiner> const base(FarFactory::Create(
        descriptor, FarFactory::Options(OpenSubdiv::Sdc::SCHEME_CATMARK, sdcOptions)));
    if (!base) {
        internal::Report(invalid(ComponentType::None, Far::INDEX_INVALID,
                                 "OpenSubdiv refuses the mesh; its error callback has the cause"),
                         status);
        return nullptr;
    }
    auto const isHole = std::make_unique<bool[]>(descriptor.numFaces);
    for (int i = 0; i < descriptor.numHoles; ++i) {
        isHole[descriptor.holeIndices[i]] = true;
    }
    return create(*base, isHole.get(), options, status);
}

} // namespace OpenSubdivHex::FarExt

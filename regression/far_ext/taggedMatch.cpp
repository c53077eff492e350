// SPDX-License-Identifier: Apache-2.0
#include "taggedMatch.h"

#include "regression/shapes/shapeDescriptor.h"

#include <opensubdiv/vtr/fvarLevel.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

namespace OpenSubdivHex::Regression {

using FarExt::TopologyLevel;

namespace {

/// Corner arrays as Far turns them for left-handed faces: the first corner of each stays.
std::vector<int> rightHanded(Shape const &shape, std::vector<int> corners) {
    auto first = corners.begin();
    for (int size : shape.faceSizes) {
        if (shape.leftHanded) {
            std::reverse(first + 1, first + size);
        }
        first += size;
    }
    return corners;
}

/// Whether a face has a vertex several times.  Far takes some edges of such faces for non-manifold
/// that are not.
bool hasRepeatedVertex(Shape const &shape) {
    auto first = shape.faceVertices.begin();
    bool result = false;
    for (int size : shape.faceSizes) {
        result = result || int(std::set<int>(first, first + size).size()) < size;
        first += size;
    }
    return result;
}

/// Chaikin's rule makes means, floats whose last bits depend on the order of their sums; what is sharp
/// must be so in both.
bool areAsSharp(TaggedMesh const &mesh, float sharpness, float expected) {
    float const allowed = mesh.chaikin ? 1e-6f * std::max(1.0f, expected) : 0.0f;
    return (sharpness > 0) == (expected > 0) && std::abs(sharpness - expected) <= allowed;
}

/// By corner: Far's own tags tell which values its FVarLinearInterpolation keeps in place.  Corners
/// that Far does not know, of faces that repeat a vertex, do as the vertex does.  Far takes some
/// vertices that a face has twice for manifold, and so would let their values move.
std::vector<float> valueSharpness(Far::TopologyRefiner const &base, int channel,
                                  TaggedMesh const &mesh) {
    Far::TopologyLevel const &level = base.GetLevel(0);
    OpenSubdiv::Vtr::internal::FVarLevel const &values = base.getLevel(0).getFVarLevel(channel);
    std::vector<float> sharpness;
    for (TaggedMesh::Face const &face : mesh.faces) {
        for (int v : face.vertices) {
            sharpness.push_back(values.isLinear() ? 0 : mesh.vertices[v].sharpness);
        }
    }
    for (int v = 0; v < level.GetNumVertices() && !values.isLinear(); ++v) {
        auto const faces = level.GetVertexFaces(v);
        auto const tags = values.getVertexValueTags(v);
        auto const siblings = values.getVertexFaceSiblings(v);
        for (int i = 0; i < faces.size(); ++i) {
            auto const tag = tags[siblings[i]];
            float own = mesh.vertices[v].sharpness;
            if (tag.isMismatch() && !tag.isSemiSharp()) {
                bool const stays = tag.isInfSharp() || mesh.vertices[v].isNonManifold;
                own = stays ? kInfiniteSharpness : 0;
            }
            if (tags.size() == 1 && mesh.vertices[v].isNonManifold && IsPinned(mesh, v)) {
                own = kInfiniteSharpness;
            }
            int const local = level.GetVertexFaceLocalIndices(v)[i];
            sharpness[base.getLevel(0).getOffsetOfFaceVertices(faces[i]) + local] = own;
        }
    }
    return sharpness;
}

} // namespace

TaggedMatch::TaggedMatch(Shape const &shape, FarExt::TopologyRefiner const &refiner, int channel,
                         bool closeGaps)
    : _refiner(refiner), _channel(channel), _closeGaps(closeGaps) {
    makeBase(shape);
    for (int level = 0; level <= refiner.GetMaxLevel(); ++level) {
        if (level > 0) {
            _levels.push_back(Refine(_levels.back(), makeStep(level)));
        }
        if (!matchFaces(level) || !matchVertices(level) || !matchEdges(level)) {
            return;
        }
    }
}

void TaggedMatch::makeBase(Shape const &shape) {
    Sdc::Options const options = _refiner.GetSchemeOptions();
    auto const farBase = CreateFarRefiner(shape, options);
    TaggedBase base;
    base.numVertices = shape.GetNumVertices();
    base.faceSizes = shape.faceSizes;
    base.faceVertices = rightHanded(shape, shape.faceVertices);
    base.creasePairs = shape.creaseVertexPairs;
    base.creaseSharpness = shape.creaseSharpness;
    base.holes = shape.holeFaces;
    Far::TopologyLevel const &farLevel = farBase->GetLevel(0);
    for (int e = 0; e < farLevel.GetNumEdges() && hasRepeatedVertex(shape); ++e) {
        if (farLevel.IsEdgeNonManifold(e)) {
            base.nonManifoldPairs.push_back(farLevel.GetEdgeVertices(e)[0]);
            base.nonManifoldPairs.push_back(farLevel.GetEdgeVertices(e)[1]);
        }
    }
    auto const boundary = options.GetVtxBoundaryInterpolation();
    base.freeBoundaries = boundary == Sdc::Options::VTX_BOUNDARY_NONE;
    base.chaikin = options.GetCreasingMethod() == Sdc::Options::CREASE_CHAIKIN;
    base.vertexSharpness.resize(base.numVertices);
    for (std::size_t i = 0; i < shape.cornerVertices.size(); ++i) {
        base.vertexSharpness[shape.cornerVertices[i]] = shape.cornerSharpness[i];
    }
    std::vector<int> numFaces(base.numVertices);
    for (int v : base.faceVertices) {
        ++numFaces[v];
    }
    for (int v = 0; v < base.numVertices; ++v) {
        if (boundary == Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER && numFaces[v] == 1) {
            base.vertexSharpness[v] = kInfiniteSharpness;
        }
    }
    _levels.push_back(MakeTaggedMesh(base));
    TaggedMesh const mesh = _levels[0];
    std::vector<TaggedMesh> values;
    for (std::size_t channel = 0; channel < shape.fvarChannels.size(); ++channel) {
        std::vector<int> valuesOfVertices;
        values.push_back(
            MakeValueMesh(mesh, rightHanded(shape, shape.fvarChannels[channel].valueIndices),
                          valueSharpness(*farBase, int(channel), mesh), valuesOfVertices));
    }
    _cuts = FindCuts(mesh, values);
    if (_channel >= 0) {
        _levels[0] =
            MakeValueMesh(mesh, rightHanded(shape, shape.fvarChannels[_channel].valueIndices),
                          valueSharpness(*farBase, _channel, mesh), _valuesOfVertices);
    }
}

bool TaggedMatch::fail(int level, std::string const &cause) {
    _error = "level " + std::to_string(level) + ": " + cause;
    return false;
}

int TaggedMatch::GetLibraryEdge(int level, TaggedMesh::Edge const &edge) const {
    if (edge.isLong && edge.sides.size() == 2) {
        return -1;
    }
    Place const &place = _places[level][edge.sides[0].face];
    int const corner = place.corners[edge.sides[0].place];
    return _refiner.GetLevel(level).GetFaceEdges(place.face)[corner];
}

ReferenceStep TaggedMatch::makeStep(int level) const {
    ReferenceStep step;
    switch (_refiner.GetHexSchemeOptions().GetStepOfLevel(level)) {
    case FarExt::StepType::Hexagonal:
        step.scheme = ReferenceScheme::Hexagonal;
        break;
    case FarExt::StepType::DooSabin:
        step.scheme = ReferenceScheme::DooSabin;
        break;
    case FarExt::StepType::TriHex:
        step.scheme = ReferenceScheme::TriHex;
        break;
    case FarExt::StepType::Truncate:
        step.scheme = ReferenceScheme::Truncate;
        step.cuts = _cuts;
        break;
    }
    if (_refiner.IsUniform()) {
        return step;
    }
    step.closeGaps = _closeGaps;
    TopologyLevel const &pLevel = _refiner.GetLevel(level - 1);
    for (TaggedMesh::Edge const &edge : _levels[level - 1].edges) {
        int const libraryEdge = GetLibraryEdge(level - 1, edge);
        bool isFlat = false;
        if (libraryEdge >= 0 && !pLevel.IsEdgeBoundary(libraryEdge)) {
            int const face = pLevel.GetEdgeChildFace(libraryEdge);
            isFlat = face >= 0 && _refiner.GetLevel(level).GetFaceVertices(face).size() == 4;
        }
        step.flatEdges.push_back(isFlat);
    }
    return step;
}

/// The vertices of a face from the lowest that is not negative on.
std::vector<int> fromLowest(std::vector<int> vertices) {
    auto const isLess = [](int a, int b) { return unsigned(a) < unsigned(b); };
    std::rotate(vertices.begin(), std::min_element(vertices.begin(), vertices.end(), isLess),
                vertices.end());
    return vertices;
}

TaggedMatch::VFaces TaggedMatch::findVFaces(int level) const {
    TopologyLevel const &library = _refiner.GetLevel(level);
    TopologyLevel const &pLevel = _refiner.GetLevel(level - 1);
    int firstFVertex = 0;
    for (int v = 0; v < pLevel.GetNumVertices(); ++v) {
        firstFVertex += pLevel.GetVertexChildVertex(v) >= 0;
    }
    VFaces vFaces;
    for (int f = 0; f < library.GetNumFaces(); ++f) {
        if (library.GetFaceKind(f) == FarExt::FaceKind::Vertex) {
            std::vector<int> vertices;
            for (int v : library.GetFaceVertices(f)) {
                vertices.push_back(v < firstFVertex ? -1 : v);
            }
            vFaces.emplace(fromLowest(std::move(vertices)), f);
        }
    }
    return vFaces;
}

TaggedMatch::Place TaggedMatch::placeOfVFace(TaggedMesh::Face const &face, VFaces const &vFaces,
                                             int level) const {
    TopologyLevel const &pLevel = _refiner.GetLevel(level - 1);
    // The library's vertex of each corner; negative for a V-vertex.
    std::vector<int> vertices;
    for (int v : face.vertices) {
        TaggedMesh::VertexOrigin const &origin = _levels[level].vertexOrigins[v];
        vertices.push_back(-1);
        if (origin.face >= 0) {
            Place const &pPlace = _places[level - 1][origin.face];
            auto const made = pLevel.GetFaceChildVertices(pPlace.face);
            int corner = pPlace.corners[origin.place];
            if (_levels[level].madeBy == ReferenceScheme::Truncate) {
                // Two on each edge, behind that at the end of the edge before.
                corner = (2 * corner + (origin.isFar ? 2 : 1)) % made.size();
            }
            vertices.back() = made[corner];
        }
    }
    Place place;
    if (face.isHalf && face.vertices.size() > 1 &&
        _levels[level].edges[face.edges[0]].sides.size() == 2) {
        return placeOfHalfVFace(vertices, level);
    }
    auto const found = vFaces.find(fromLowest(vertices));
    if (found == vFaces.end()) {
        return _channel < 0 || !face.isHalf ? place : placeOfHalfVFace(vertices, level);
    }
    place.face = found->second;
    auto const actual = _refiner.GetLevel(level).GetFaceVertices(place.face);
    int const size = actual.size();
    for (int first = 0; first < size && size == int(vertices.size()); ++first) {
        bool isSame = true;
        for (int i = 0; i < size; ++i) {
            isSame = isSame && (vertices[i] < 0 || vertices[i] == actual[(first + i) % size]);
        }
        if (isSame) {
            place.corners.resize(size);
            std::iota(place.corners.begin(), place.corners.end(), 0);
            std::rotate(place.corners.begin(), place.corners.begin() + first, place.corners.end());
            break;
        }
    }
    return place;
}

// The place of a half of a V-face that a crease or seam crosses.
TaggedMatch::Place TaggedMatch::placeOfHalfVFace(std::vector<int> const &vertices,
                                                 int level) const {
    TopologyLevel const &library = _refiner.GetLevel(level);
    Place place;
    for (int f = 0; f < library.GetNumFaces(); ++f) {
        auto const all = library.GetFaceVertices(f);
        int const end = library.GetFaceDiagonalEnd(f);
        if (library.GetFaceKind(f) != FarExt::FaceKind::Vertex || end >= all.size()) {
            continue;
        }
        for (int half : {0, 1}) {
            std::vector<int> corners;
            std::vector<int> ofHalf;
            for (int i = 0; i < FarExt::GetHalfSize(half, all.size(), end); ++i) {
                corners.push_back(FarExt::GetPlaceInHalves(half, i, end));
                ofHalf.push_back(all[corners.back()]);
            }
            // In a channel the end of a seam has no vertex of the mesh of its own.
            bool isSame = ofHalf.size() == vertices.size();
            for (std::size_t i = _channel < 0 ? 0 : 1; isSame && i < vertices.size(); ++i) {
                isSame = ofHalf[i] == vertices[i];
            }
            if (isSame) {
                place.face = f;
                place.corners = corners;
            }
        }
    }
    return place;
}

TaggedMatch::Place TaggedMatch::placeOf(TaggedMesh::FaceOrigin const &origin,
                                        TopologyLevel const &pLevel, int level) const {
    std::vector<Place> const &pPlaces = _places[level - 1];
    if (origin.face >= 0) {
        Place place = pPlaces[origin.face];
        place.face = pLevel.GetFaceChildFaces(place.face)[0];
        if (_levels[level].madeBy == ReferenceScheme::Truncate) {
            std::vector<int> const corners = std::move(place.corners);
            place.corners.clear();
            for (int corner : corners) {
                place.corners.push_back(2 * corner);
                place.corners.push_back(2 * corner + 1);
            }
        }
        return place;
    }
    // The order that INDEXING.md tells: an E-face begins where its edge's first face does.
    TaggedMesh::Edge const &edge = _levels[level - 1].edges[origin.edge];
    TaggedMesh::Side const side = edge.sides[origin.side];
    Place const &pPlace = pPlaces[side.face];
    int const corner = pPlace.corners[side.place];
    int const libraryEdge = pLevel.GetFaceEdges(pPlace.face)[corner];
    bool const isFirst = pLevel.GetEdgeFaces(libraryEdge)[0] == pPlace.face &&
                         pLevel.GetEdgeFaceLocalIndices(libraryEdge)[0] == corner;
    Place place;
    place.face = pLevel.GetEdgeChildFace(libraryEdge);
    if (place.face < 0) {
        return place;
    }
    bool const isQuad = _refiner.GetLevel(level).GetFaceVertices(place.face).size() == 4;
    if (pLevel.IsEdgeBoundary(libraryEdge)) {
        place.corners = {0, 1, 2, 3};
    } else if (isQuad) {
        place.corners = isFirst ? std::vector<int>{0, 1, 2, 3} : std::vector<int>{2, 3, 0, 1};
    } else if (edge.sides.size() == 2 && edge.sharpness <= 0) {
        place.corners = {0, 1, 2, 3, 4, 5};
        if (!isFirst) {
            std::rotate(place.corners.begin(), place.corners.begin() + 3, place.corners.end());
        }
    } else {
        place.corners = isFirst ? std::vector<int>{0, 3, 4, 5} : std::vector<int>{3, 0, 1, 2};
    }
    return place;
}

bool TaggedMatch::matchFaces(int level) {
    TaggedMesh const &mesh = _levels[level];
    TopologyLevel const &library = _refiner.GetLevel(level);
    std::vector<Place> places(mesh.faces.size());
    std::vector<std::vector<int>> covered(library.GetNumFaces());
    VFaces const vFaces = level == 0 ? VFaces() : findVFaces(level);
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        TaggedMesh::Face const &face = mesh.faces[f];
        Place &place = places[f];
        if (level == 0) {
            place.face = int(f);
            place.corners.resize(face.vertices.size());
            std::iota(place.corners.begin(), place.corners.end(), 0);
        } else if (mesh.faceOrigins[f].vertex >= 0) {
            place = placeOfVFace(face, vFaces, level);
        } else {
            TaggedMesh::FaceOrigin const &origin = mesh.faceOrigins[f];
            TopologyLevel const &pLevel = _refiner.GetLevel(level - 1);
            place = placeOf(origin, pLevel, level);
            if (origin.mergedWith >= 0) {
                Place const other = placeOf(mesh.mergedOrigins[origin.mergedWith], pLevel, level);
                if (other.face != place.face || int(place.corners.size() + other.corners.size()) !=
                                                    int(face.vertices.size()) + 2) {
                    return fail(level, "halves of two faces");
                }
                place.corners.insert(place.corners.begin() + 1, other.corners.begin() + 2,
                                     other.corners.end());
            }
        }
        std::string const name = "face " + std::to_string(place.face);
        if (place.face < 0 || place.face >= library.GetNumFaces() ||
            place.corners.size() != face.vertices.size()) {
            return fail(level, name + " is not the face");
        }
        int const size = library.GetFaceVertices(place.face).size();
        bool const isWhole = int(place.corners.size()) == size;
        std::vector<int> &all = covered[place.face];
        if (!isWhole && !face.isHalf) {
            return fail(level, name + " is not whole");
        }
        if (_channel < 0 && library.IsFaceHalf(place.face) != (isWhole && face.isHalf)) {
            return fail(level, name + " has other tags");
        }
        for (int i = 0; i < int(face.holes.size()) && _channel < 0; ++i) {
            int const half = place.corners[i] < library.GetFaceDiagonalEnd(place.face) ? 1 : 0;
            bool const isHole = isWhole && !face.isHalf ? library.IsFaceHole(place.face, half)
                                : isWhole               ? library.IsFaceHole(place.face)
                                          : library.IsFaceHole(place.face, GetHalf(place));
            if (isHole != face.holes[i]) {
                return fail(level, name + " is a hole elsewhere");
            }
        }
        if (_channel >= 0 && library.IsFaceFVarSplit(place.face, _channel) !=
                                 (!isWhole && mesh.edges[face.edges[0]].sides.size() == 1)) {
            return fail(level, name + " is split differently");
        }
        all.insert(all.end(), place.corners.begin(), place.corners.end());
    }
    for (int f = 0; f < library.GetNumFaces(); ++f) {
        std::vector<int> expected(library.GetFaceVertices(f).size());
        std::iota(expected.begin(), expected.end(), 0);
        if (covered[f].size() != expected.size()) {
            expected.insert(expected.end(),
                            {0, library.GetFaceDiagonalEnd(f)}); // halves share the line
        }
        std::sort(covered[f].begin(), covered[f].end());
        std::sort(expected.begin(), expected.end());
        if (covered[f] != expected) {
            return fail(level, "face " + std::to_string(f) + " is not covered once");
        }
    }
    _places.push_back(std::move(places));
    return true;
}

bool TaggedMatch::matchVertices(int level) {
    TaggedMesh const &mesh = _levels[level];
    TopologyLevel const &library = _refiner.GetLevel(level);
    std::vector<int> vertices(mesh.vertices.size(), -1);
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        Place const &place = _places[level][f];
        for (std::size_t i = 0; i < place.corners.size(); ++i) {
            int actual = -1;
            if (_channel < 0) {
                actual = library.GetFaceVertices(place.face)[place.corners[i]];
            } else if (library.IsFaceFVarSplit(place.face, _channel)) {
                actual = library.GetFaceFVarValues(place.face, _channel, GetHalf(place))[int(i)];
            } else {
                actual = library.GetFaceFVarValues(place.face, _channel)[place.corners[i]];
            }
            int &vertex = vertices[mesh.faces[f].vertices[i]];
            if (vertex >= 0 && vertex != actual) {
                return fail(level, "vertices " + std::to_string(vertex) + " and " +
                                       std::to_string(actual) + " are one");
            }
            vertex = actual;
        }
    }
    if (_channel >= 0 && level == 0) {
        if (vertices != _valuesOfVertices) {
            return fail(level, "other values");
        }
        _vertices.push_back(std::move(vertices));
        return true;
    }
    // Vertices without faces.
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        if (vertices[v] < 0) {
            vertices[v] = level == 0 ? int(v)
                                     : _refiner.GetLevel(level - 1).GetVertexChildVertex(
                                           _vertices[level - 1][mesh.vertexOrigins[v].vertex]);
        }
    }
    std::set<int> const all(vertices.begin(), vertices.end());
    int const count = _channel < 0 ? library.GetNumVertices() : library.GetNumFVarValues(_channel);
    if (all.size() != vertices.size()) {
        return fail(level, "several vertices are one");
    }
    // Values that no corner has are no vertices of the reference.
    if (*all.begin() < 0 || *all.rbegin() >= count || (_channel < 0 && int(all.size()) != count)) {
        return fail(level, "the number of vertices differs");
    }
    if (_channel < 0) {
        for (std::size_t v = 0; v < vertices.size(); ++v) {
            if (library.GetVertexSharpness(vertices[v]) != mesh.vertices[v].sharpness) {
                return fail(level, "vertex " + std::to_string(vertices[v]) + " is as sharp as " +
                                       std::to_string(library.GetVertexSharpness(vertices[v])));
            }
            static Sdc::Crease::Rule const kRules[] = {
                Sdc::Crease::RULE_SMOOTH, Sdc::Crease::RULE_DART, Sdc::Crease::RULE_CREASE,
                Sdc::Crease::RULE_CORNER};
            Sdc::Crease::Rule const rule = library.GetVertexRule(vertices[v]);
            if (rule != kRules[int(GetRule(mesh, int(v)))]) {
                return fail(level, "vertex " + std::to_string(vertices[v]) + " has rule " +
                                       std::to_string(rule));
            }
        }
    }
    _vertices.push_back(std::move(vertices));
    return true;
}

bool TaggedMatch::matchEdges(int level) {
    if (_channel >= 0) {
        return true;
    }
    TaggedMesh const &mesh = _levels[level];
    TopologyLevel const &library = _refiner.GetLevel(level);
    std::set<int> edges;
    std::set<int> cutFaces;
    for (TaggedMesh::Edge const &edge : mesh.edges) {
        Place const &place = _places[level][edge.sides[0].face];
        if (edge.isLong && edge.sides.size() == 2) {
            cutFaces.insert(place.face);
            if (!areAsSharp(mesh, library.GetFaceDiagonalSharpness(place.face), edge.sharpness)) {
                return fail(level,
                            "diagonal of face " + std::to_string(place.face) + " is as sharp as " +
                                std::to_string(library.GetFaceDiagonalSharpness(place.face)));
            }
            continue;
        }
        std::set<int> own;
        for (TaggedMesh::Side side : edge.sides) {
            Place const &sidePlace = _places[level][side.face];
            own.insert(library.GetFaceEdges(sidePlace.face)[sidePlace.corners[side.place]]);
        }
        int const e = *own.begin();
        std::string const name = "edge " + std::to_string(e);
        if (own.size() != 1 || !edges.insert(e).second ||
            library.GetEdgeFaces(e).size() != int(edge.sides.size())) {
            return fail(level, name + " joins other faces");
        }
        if (!areAsSharp(mesh, library.GetEdgeSharpness(e), edge.sharpness)) {
            return fail(level, name + " is as sharp as " +
                                   std::to_string(library.GetEdgeSharpness(e)) + ", not " +
                                   std::to_string(edge.sharpness));
        }
    }
    if (int(edges.size()) != library.GetNumEdges()) {
        return fail(level, "the number of edges differs");
    }
    for (int f = 0; f < library.GetNumFaces(); ++f) {
        if (library.GetFaceDiagonalSharpness(f) > 0 && cutFaces.count(f) == 0) {
            return fail(level, "face " + std::to_string(f) + " has a diagonal");
        }
    }
    return true;
}

template <typename STEP>
std::vector<ReferenceValues> TaggedMatch::interpolate(ReferenceValues const &base,
                                                      STEP const &step) const {
    ReferenceValues values = base;
    if (_channel >= 0) {
        values.resize(Eigen::Index(_valuesOfVertices.size()), base.cols());
        for (std::size_t v = 0; v < _valuesOfVertices.size(); ++v) {
            values.row(Eigen::Index(v)) = base.row(_valuesOfVertices[v]);
        }
    }
    std::vector<ReferenceValues> result{base};
    for (int level = 1; level <= GetMaxLevel(); ++level) {
        values = step(_levels[level - 1], _levels[level], values);
        TopologyLevel const &library = _refiner.GetLevel(level);
        // Rows of values that no corner has stay unknown.
        int const count =
            _channel < 0 ? library.GetNumVertices() : library.GetNumFVarValues(_channel);
        result.push_back(ReferenceValues::Constant(count, base.cols(), std::nan("")));
        for (Eigen::Index i = 0; i < values.rows(); ++i) {
            result.back().row(_vertices[level][i]) = values.row(i);
        }
    }
    return result;
}

std::vector<ReferenceValues> TaggedMatch::InterpolateAll(ReferenceMask mask,
                                                         ReferenceValues const &base) const {
    return interpolate(base, [mask](TaggedMesh const &parent, TaggedMesh const &child,
                                    ReferenceValues const &values) {
        return Interpolate(parent, child, mask, values);
    });
}

std::vector<ReferenceValues> TaggedMatch::InterpolateVaryingAll(ReferenceValues const &base) const {
    return interpolate(
        base, [](TaggedMesh const &parent, TaggedMesh const &child, ReferenceValues const &values) {
            return InterpolateVarying(parent, child, values);
        });
}

} // namespace OpenSubdivHex::Regression

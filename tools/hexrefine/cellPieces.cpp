// SPDX-License-Identifier: Apache-2.0
#include "cellPieces.h"

#include "faceLoop.h"
#include "tools/mesh/fileError.h"
#include "tools/mesh/meshCheck.h"
#include "tools/mesh/patchCreases.h"

#include <algorithm>
#include <limits>

namespace OpenSubdivHex::Tools {

using BfrExt::LevelTessellation;

namespace {

// Cells that a piece has at least, if it is not the last one of its label.
constexpr int kMinNumCells = 1 << 15;

} // namespace

/// The facets of a base face.
struct CellPieces::Patch {
    explicit Patch(LevelTessellation cells)
        : tessellation(std::move(cells)), facets(std::size_t(tessellation.GetNumFacetVertices())),
          sizes(std::size_t(tessellation.GetNumFacets())), levels(sizes.size()) {
        tessellation.GetFacets(facets.data());
        tessellation.GetFacetSizes(sizes.data());
        tessellation.GetFacetLevels(levels.data());
    }

    LevelTessellation tessellation;
    std::vector<int> facets; // places of all
    std::vector<int> sizes;
    std::vector<int> levels;
    int face = 0;
    std::vector<int> boundary; // the forest's numbers of its places
    std::vector<float> positions;
    std::vector<float> properties;
    std::vector<std::vector<float>> values; // by channel
};

CellPieces::CellPieces(BfrExt::SurfaceFactory const &factory, BfrExt::CellForest const &forest,
                       Mesh const &mesh, std::string const &input)
    : _factory(factory), _forest(forest), _mesh(mesh), _input(input), _level(factory.GetLevel()),
      _frontValues(mesh.channels.size()), _piece(mesh) {
    std::size_t const width = mesh.vertexProperties.size();
    _properties.resize(width * std::size_t(mesh.GetNumVertices()));
    for (std::size_t i = 0; i < _properties.size(); ++i) {
        _properties[i] = mesh.vertexProperties[i % width].values[i / width];
    }
    _piece.labels.clear();
    _piece.faceLabels.clear();
    clearPiece();
    _front.vertexProperties = _piece.vertexProperties;
    numberFront();
}

// Numbers the points that some face has, in the order of the forest.
void CellPieces::numberFront() {
    _frontVerts.assign(std::size_t(_forest.GetNumBoundaryPoints()), -1);
    for (int face = 0; face < _forest.GetNumFaces(); ++face) {
        if (!hasFace(face)) {
            continue;
        }
        FarExt::SurfaceFaces const &faces = _factory.GetFaces();
        for (int local = 0; local < faces.GetShape(face).size; ++local) {
            _frontVerts[std::size_t(faces.GetVertex(face, local))] = 0;
            int const edge = faces.GetEdge(face, local).edge;
            std::fill_n(_frontVerts.begin() + _forest.GetFirstEdgePoint(edge),
                        _forest.GetPolyline(edge).GetNumPoints(), 0);
        }
    }
    for (int &vert : _frontVerts) {
        vert = vert == 0 ? int(_numVerts++) : vert;
    }
    _front.positions.resize(3 * std::size_t(_numVerts));
    for (VertexProperty &property : _front.vertexProperties) {
        property.values.resize(std::size_t(_numVerts));
    }
    for (FrontValues &values : _frontValues) {
        values.places.resize(std::size_t(_numVerts));
    }
}

void CellPieces::clearPiece() {
    _piece.positions.clear();
    _piece.faceSizes.clear();
    _piece.faceVertices.clear();
    _piece.baseFaces.clear();
    _piece.tags = MeshTags();
    for (VertexProperty &property : _piece.vertexProperties) {
        property.values.clear();
    }
    for (FVarChannel &channel : _piece.channels) {
        channel.values.clear();
        channel.faceValues.clear();
    }
    _faceLevels.clear();
}

// The end of the next faces, which have enough cells together and one label.
int CellPieces::takeFaces() {
    int numCells = 0;
    int label = -1;
    int end = _nextFace;
    for (; end < _forest.GetNumFaces() && numCells < kMinNumCells; ++end) {
        if (!hasFace(end)) {
            continue;
        }
        if (!_mesh.faceLabels.empty()) {
            int const own = _mesh.faceLabels[std::size_t(_factory.GetFaceBaseFace(end))];
            if (label >= 0 && own != label) {
                break;
            }
            label = own;
        }
        numCells += _forest.GetTree(end).GetNumLeaves();
    }
    return end;
}

bool CellPieces::MakeNext() {
    clearPiece();
    MeshStart start = {_numVerts};
    for (FrontValues const &values : _frontValues) {
        start.values.push_back(values.numValues);
    }
    int const firstFace = _nextFace;
    _nextFace = takeFaces();
    std::vector<std::unique_ptr<Patch>> patches(std::size_t(_nextFace - firstFace));
    ForEachFace(int(patches.size()), [&](int i) {
        if (hasFace(firstFace + i)) {
            patches[std::size_t(i)] = std::make_unique<Patch>(_forest.GetTessellation(
                firstFace + i, LevelTessellation::Options().SetFacetSize(0)));
            evaluate(firstFace + i, *patches[std::size_t(i)]);
        }
    });
    for (std::unique_ptr<Patch> &patch : patches) {
        if (patch) {
            add(*patch);
            patch.reset();
        }
    }
    CheckFinite(_piece, _input, "--adaptive: ", start);
    return !_piece.faceSizes.empty();
}

void CellPieces::evaluate(BfrExt::Surface<float> const &surface, Patch const &patch,
                          std::vector<float> const &values, int width,
                          std::vector<float> &result) const {
    std::vector<float> control(std::size_t(surface.GetNumControlPoints()) * std::size_t(width));
    surface.GatherControlPoints(values.data(), width, control.data(), width);
    result.resize(std::size_t(patch.tessellation.GetNumCoords()) * std::size_t(width));
    surface.Evaluate(patch.tessellation, control.data(), width, result.data(), width);
}

void CellPieces::evaluate(int face, Patch &patch) const {
    patch.face = face;
    patch.boundary.resize(std::size_t(patch.tessellation.GetNumBoundaryCoords()));
    _forest.GetBoundaryPoints(face, patch.boundary.data());
    BfrExt::Surface<float> surface;
    _factory.InitVertexSurface(face, &surface);
    evaluate(surface, patch, _mesh.positions, 3, patch.positions);
    if (!_properties.empty()) {
        _factory.InitVaryingSurface(face, &surface);
        evaluate(surface, patch, _properties, int(_mesh.vertexProperties.size()), patch.properties);
    }
    for (std::size_t i = 0; i < _mesh.channels.size(); ++i) {
        FVarChannel const &channel = _mesh.channels[i];
        _factory.InitFaceVaryingSurface(face, &surface, int(i));
        evaluate(surface, patch, channel.values, channel.width, patch.values.emplace_back());
    }
}

// Values on the boundary are those of the last face that has them.
void CellPieces::add(Patch const &patch) {
    auto const numPlaces = std::size_t(patch.tessellation.GetNumCoords());
    std::size_t const numBoundary = patch.boundary.size();
    if (_numVerts + std::int64_t(numPlaces) > std::numeric_limits<int>::max()) {
        throw FileError(_input, "--adaptive makes more than 2147483647 vertices");
    }
    std::vector<int> verts(numPlaces);
    std::size_t const width = _mesh.vertexProperties.size();
    for (std::size_t place = 0; place < numPlaces; ++place) {
        float const *const position = &patch.positions[3 * place];
        if (place < numBoundary) {
            verts[place] = _frontVerts[std::size_t(patch.boundary[place])];
            std::copy_n(position, 3, &_front.positions[3 * std::size_t(verts[place])]);
        } else {
            verts[place] = int(_numVerts++);
            _piece.positions.insert(_piece.positions.end(), position, position + 3);
        }
        for (std::size_t k = 0; k < width; ++k) {
            float const value = patch.properties[width * place + k];
            if (place < numBoundary) {
                _front.vertexProperties[k].values[std::size_t(verts[place])] = value;
            } else {
                _piece.vertexProperties[k].values.push_back(value);
            }
        }
    }
    _piece.faceSizes.insert(_piece.faceSizes.end(), patch.sizes.begin(), patch.sizes.end());
    _piece.baseFaces.insert(_piece.baseFaces.end(), patch.sizes.size(),
                            _factory.GetFaceBaseFace(patch.face));
    _faceLevels.insert(_faceLevels.end(), patch.levels.begin(), patch.levels.end());
    for (int const place : patch.facets) {
        _piece.faceVertices.push_back(verts[std::size_t(place)]);
    }
    AddPatchCreases(_level, patch.face, patch.tessellation, verts, &_piece.tags);
    for (std::size_t channel = 0; channel < _mesh.channels.size(); ++channel) {
        addValues(patch, verts, channel);
    }
}

// In the order in which faces have them.
void CellPieces::addValues(Patch const &patch, std::vector<int> const &verts, std::size_t channel) {
    FVarChannel &result = _piece.channels[channel];
    FrontValues &front = _frontValues[channel];
    auto const width = std::size_t(result.width);
    std::vector<int> numbers(verts.size(), -1); // by place
    auto const add = [&](float const *value) {
        result.values.insert(result.values.end(), value, value + width);
        return front.numValues++;
    };
    auto const findOnFront = [&](int vert, float const *value) {
        std::vector<int> &known = front.places[std::size_t(vert)];
        for (int const place : known) {
            if (std::equal(value, value + width, &front.values[width * std::size_t(place)])) {
                return front.numbers[std::size_t(place)];
            }
        }
        known.push_back(int(front.numbers.size()));
        front.values.insert(front.values.end(), value, value + width);
        front.numbers.push_back(add(value));
        return front.numbers.back();
    };
    for (int const placeOfFacet : patch.facets) {
        auto const place = std::size_t(placeOfFacet);
        if (numbers[place] < 0) {
            float const *const value = &patch.values[channel][width * place];
            numbers[place] =
                place < patch.boundary.size() ? findOnFront(verts[place], value) : add(value);
        }
        result.faceValues.push_back(numbers[place]);
    }
}

Mesh CellPieces::TakeFront() {
    CheckFinite(_front, _input, "--adaptive: ");
    return std::move(_front);
}

} // namespace OpenSubdivHex::Tools

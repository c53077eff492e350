// SPDX-License-Identifier: Apache-2.0
#include "cellView.h"

#include "tools/hexrefine/faceLoop.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace OpenSubdivHex::Tools {

using BfrExt::LevelTessellation;
using BfrExt::SurfaceFactory;

namespace {

void requireOk(bool isOk, FarExt::CallStatus const &status) {
    if (!isOk) {
        throw std::runtime_error(status.GetErrorMessage());
    }
}

/// The control points of a surface, of \p width numbers each.
std::vector<float> gather(BfrExt::Surface<float> const &surface, std::vector<float> const &points,
                          int width) {
    std::vector<float> result(std::size_t(surface.GetNumControlPoints()) * std::size_t(width));
    surface.GatherControlPoints(points.data(), width, result.data(), width);
    return result;
}

/// Makes the evaluator of a refiner's last level; null where that is level 0.
std::unique_ptr<OsdExt::RefinementEvaluator> makeEvaluator(FarExt::TopologyRefiner const &refiner,
                                                           FarExt::StencilMode mode, int channel) {
    if (refiner.GetMaxLevel() == 0) {
        return nullptr;
    }
    OsdExt::RefinementEvaluator::Options options;
    options.interpolationMode = mode;
    options.fvarChannel = channel;
    FarExt::CallStatus status;
    auto evaluator = OsdExt::RefinementEvaluator::Create(refiner, options, &status);
    requireOk(evaluator != nullptr, status);
    return evaluator;
}

/// Values of a level from those of level 0, by its evaluator.
std::vector<float> evaluate(std::vector<float> const &values, int width,
                            OsdExt::RefinementEvaluator *evaluator, int level) {
    if (!evaluator) {
        return values;
    }
    OpenSubdiv::Osd::BufferDescriptor const desc(0, width, width);
    std::vector<float> result(std::size_t(evaluator->GetNumElements(level)) * std::size_t(width));
    FarExt::CallStatus status;
    requireOk(evaluator->Evaluate(values.data(), desc, result.data(), desc, level, &status),
              status);
    return result;
}

} // namespace

CellView::CellView(Mesh const &mesh, std::unique_ptr<FarExt::TopologyRefiner> refiner,
                   int uvChannel)
    : _refiner(std::move(refiner)), _baseSides(getBase()) {
    FarExt::CallStatus status;
    _factory = SurfaceFactory::Create(*_refiner,
                                      SurfaceFactory::Options().SetExternalCache(&_cache), &status);
    requireOk(_factory != nullptr, status);
    _bounds.emplace(*_factory);
    _evaluator = makeEvaluator(*_refiner, FarExt::INTERPOLATE_VERTEX, 0);
    if (uvChannel >= 0) {
        FVarChannel const &channel = mesh.channels[std::size_t(uvChannel)];
        _uvWidth = channel.width;
        _uvs = evaluate(channel.values, _uvWidth,
                        makeEvaluator(*_refiner, FarExt::INTERPOLATE_FACE_VARYING, uvChannel).get(),
                        _refiner->GetMaxLevel());
    }
    _faces.resize(std::size_t(_factory->GetNumFaces()));
    for (int number = 0; number < int(_faces.size()); ++number) {
        Face &face = _faces[std::size_t(number)];
        if (_factory->GetFaces().IsHole(number)) {
            continue;
        }
        requireOk(_factory->InitVertexSurface(number, &face.surface, &status), status);
        if (uvChannel >= 0) {
            requireOk(_factory->InitFaceVaryingSurface(number, &face.uvSurface, uvChannel, &status),
                      status);
        }
    }
    _statistics.numTypes = int(_cache.GetNumTypes());
}

// The points that surfaces take.
std::vector<float> CellView::findPoints(std::vector<float> const &controlPoints) const {
    return evaluate(controlPoints, kLength, _evaluator.get(), _refiner->GetMaxLevel());
}

void CellView::Refine(BfrExt::View const &view, std::vector<float> const &controlPoints) {
    BfrExt::View::Counts counts;
    std::vector<float> const points = findPoints(controlPoints);
    _forest = view.MakeForest<float>(*_bounds, points.data(), kLength,
                                     _forest ? &*_forest : nullptr, &counts);
    _statistics.counts = std::move(counts);
    ForEachFace(int(_faces.size()), [&](int number) {
        Face &face = _faces[std::size_t(number)];
        if (face.surface.IsValid()) {
            auto const tessellate = [&](int facetSize) {
                return std::make_unique<LevelTessellation>(_forest->GetTessellation(
                    number, LevelTessellation::Options().SetFacetSize(facetSize)));
            };
            face.polygons = tessellate(0);
            face.triangles = tessellate(kLength);
        }
    });
    numberPlaces();
    findTopology();
}

// Points on edges come first, in the order of the forest, then those inside of faces.  Vertices of the
// surface level have sides; edges have one, or where they are sharp one for each face.
void CellView::numberPlaces() {
    FarExt::TopologyLevel const base = getBase();
    FarExt::SurfaceFaces const &faces = _factory->GetFaces();
    int const numVertices = base.GetNumVertices();
    int numPoints = int(_forest->GetNumBoundaryPoints());
    std::vector<int> sidesOfPoints(std::size_t(numPoints - numVertices), -1);
    std::vector<unsigned> &sideVertices = _topology.sideVertices;
    sideVertices.clear();
    for (int side = 0; side < _baseSides.GetNumSides(); ++side) {
        sideVertices.push_back(unsigned(_baseSides.GetVertex(side)));
    }
    auto const addSide = [&](int point) {
        sideVertices.push_back(unsigned(point));
        return int(sideVertices.size()) - 1;
    };
    for (int number = 0; number < int(_faces.size()); ++number) {
        Face &face = _faces[std::size_t(number)];
        if (!face.surface.IsValid()) {
            continue;
        }
        LevelTessellation const &tessellation = *face.polygons;
        face.points.resize(std::size_t(tessellation.GetNumCoords()));
        face.sides.clear();
        _forest->GetBoundaryPoints(number, face.points.data());
        auto const [levelFace, half] = faces.GetLevelFace(number);
        for (int local = 0; local < tessellation.GetFaceSize(); ++local) {
            face.sides.push_back(
                _baseSides.FindSide(base, levelFace, faces.GetPlace(number, local), half));
            int const edge = faces.GetEdge(number, local).edge;
            // Diagonals are sharp.
            bool const isSharp = edge >= base.GetNumEdges() || base.IsEdgeInfSharp(edge);
            for (int i = 0; i < tessellation.GetNumEdgeCoords(local); ++i) {
                int const point = face.points[face.sides.size()];
                int &side = sidesOfPoints[std::size_t(point - numVertices)];
                if (side < 0 || isSharp) {
                    side = addSide(point);
                }
                face.sides.push_back(side);
            }
        }
        while (face.sides.size() < face.points.size()) {
            face.points[face.sides.size()] = numPoints;
            face.sides.push_back(addSide(numPoints++));
        }
    }
    _statistics.numPoints = numPoints;
}

void CellView::findTopology() {
    _topology.polygonSizes.clear();
    _topology.polygonSides.clear();
    _topology.triangleSides.clear();
    _topology.coords.clear();
    _topology.triangleFaces.clear();
    for (int number = 0; number < int(_faces.size()); ++number) {
        Face const &face = _faces[std::size_t(number)];
        if (!face.surface.IsValid()) {
            continue;
        }
        auto const addTo = [&face](std::vector<int> &sides, std::vector<int> const &places) {
            std::transform(places.begin(), places.end(), std::back_inserter(sides),
                           [&](int place) { return face.sides[std::size_t(place)]; });
        };
        std::vector<int> sizes(std::size_t(face.polygons->GetNumFacets()));
        face.polygons->GetFacetSizes(sizes.data());
        std::vector<int> places(std::size_t(face.polygons->GetNumFacetVertices()));
        face.polygons->GetFacets(places.data());
        _topology.polygonSizes.insert(_topology.polygonSizes.end(), sizes.begin(), sizes.end());
        addTo(_topology.polygonSides, places);
        addTriangles(number, face);
    }
}

void CellView::addTriangles(int number, Face const &face) {
    LevelTessellation const &triangles = *face.triangles;
    std::vector<int> places(std::size_t(triangles.GetNumFacetVertices()));
    triangles.GetFacets(places.data());
    std::vector<int> levels(std::size_t(triangles.GetNumFacets()));
    triangles.GetFacetLevels(levels.data());
    // Texture coordinates, or places in the face.
    auto const width = std::size_t(_uvWidth > 0 ? _uvWidth : 2);
    std::vector<float> coords(width * std::size_t(triangles.GetNumCoords()));
    if (_uvWidth > 0) {
        std::vector<float> const control = gather(face.uvSurface, _uvs, _uvWidth);
        face.uvSurface.Evaluate(triangles, control.data(), _uvWidth, coords.data(), _uvWidth);
    } else {
        triangles.GetPlaneCoords(coords.data());
    }
    for (int const place : places) {
        _topology.triangleSides.push_back(face.sides[std::size_t(place)]);
        float const *const coord = &coords[width * std::size_t(place)];
        _topology.coords.insert(_topology.coords.end(), coord, coord + 2);
    }
    int const baseFace = _factory->GetFaceBaseFace(number);
    for (int const level : levels) {
        _topology.triangleFaces.push_back(baseFace);
        _topology.triangleFaces.push_back(level);
    }
}

// Where faces share a vertex, the last face counts: points are the same to the bit, normals nearly so.
void CellView::Evaluate(std::vector<float> const &controlPoints) {
    struct Values {
        std::vector<float> points;
        std::vector<float> du;
        std::vector<float> dv;
    };
    std::vector<Values> ofFaces(_faces.size());
    std::vector<float> const surfacePoints = findPoints(controlPoints);
    ForEachFace(int(_faces.size()), [&](int number) {
        Face const &face = _faces[std::size_t(number)];
        if (face.surface.IsValid()) {
            Values &values = ofFaces[std::size_t(number)];
            for (std::vector<float> *const array : {&values.points, &values.du, &values.dv}) {
                array->resize(kLength * face.points.size());
            }
            std::vector<float> const control = gather(face.surface, surfacePoints, kLength);
            face.surface.Evaluate(*face.polygons, control.data(), kLength, values.points.data(),
                                  values.du.data(), values.dv.data(), kLength);
        }
    });
    constexpr std::size_t kNormalLength = 4;
    _points.assign(kLength * std::size_t(_statistics.numPoints), 0);
    _normals.assign(kNormalLength * _topology.sideVertices.size(), 0);
    for (std::size_t number = 0; number < _faces.size(); ++number) {
        Values const &values = ofFaces[number];
        for (std::size_t i = 0; i < values.points.size(); i += kLength) {
            std::size_t const place = i / kLength;
            std::copy_n(&values.points[i], kLength,
                        &_points[kLength * std::size_t(_faces[number].points[place])]);
            float const *const du = &values.du[i];
            float const *const dv = &values.dv[i];
            double const normal[kLength] = {double(du[1]) * dv[2] - double(du[2]) * dv[1],
                                            double(du[2]) * dv[0] - double(du[0]) * dv[2],
                                            double(du[0]) * dv[1] - double(du[1]) * dv[0]};
            double const length = std::hypot(normal[0], normal[1], normal[2]);
            float *const result =
                &_normals[kNormalLength * std::size_t(_faces[number].sides[place])];
            for (int k = 0; k < kLength; ++k) {
                result[k] = length > 0 ? float(normal[k] / length) : 0;
            }
        }
    }
}

} // namespace OpenSubdivHex::Tools

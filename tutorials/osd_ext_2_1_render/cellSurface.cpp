// SPDX-License-Identifier: Apache-2.0
#include "cellSurface.h"

#include "far_ext/topologyRefinerFactory.h"
#include "tools/mesh/mesh.h"
#include "tools/mesh/patchCreases.h"
#include "tools/mesh/topologyDescriptor.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace OpenSubdivHex::Tools {

using BfrExt::LevelTessellation;

namespace {

// The picture of a camera whose image plane may be shifted lies in that of one that looks along its
// axis, with pixels of the same size.
BfrExt::Camera findCamera(Camera const &camera, int height) {
    constexpr float kDegreesOfRadian = 57.29578F;
    Vec3 const right = camera.GetRight();
    Vec3 const up = camera.GetUp();
    Vec3 const forward = Cross(up, right);
    float side = 0; // at depth 1, from the axis
    float top = 0;
    float pictureHeight = 0;
    for (float const y : {0.0F, 1.0F}) {
        for (float const x : {0.0F, 1.0F}) {
            Vec3 const direction = camera.GetDirection(x, y);
            float const depth = Dot(direction, forward);
            side = std::max(side, std::fabs(Dot(direction, right) / depth));
            top = std::max(top, std::fabs(Dot(direction, up) / depth));
            pictureHeight += (y == 0 ? 0.5F : -0.5F) * Dot(direction, up) / depth;
        }
    }
    BfrExt::Camera result;
    Vec3 const eye = camera.GetPosition();
    Vec3 const target = eye + forward;
    std::copy_n(&eye.x, 3, result.eye);
    std::copy_n(&target.x, 3, result.target);
    std::copy_n(&up.x, 3, result.up);
    result.fieldOfView = double(2 * kDegreesOfRadian * std::atan(top));
    float const pixels = float(height) / pictureHeight; // of a length of 1 at depth 1
    result.width = int(std::ceil(2 * side * pixels));
    result.height = int(std::ceil(2 * top * pixels));
    return result;
}

// Where the surface is evaluated in one face.
struct Patch {
    LevelTessellation tessellation;
    std::vector<int> points; // by place
    std::vector<float> p;
    std::vector<float> du;
    std::vector<float> dv;
};

// Points and derivatives of a face at the places of its tessellation.
void evaluate(BfrExt::SurfaceFactory const &factory, int face, std::vector<float> const &positions,
              Patch *patch) {
    BfrExt::Surface<float> surface;
    factory.InitVertexSurface(face, &surface);
    std::vector<float> control(3 * std::size_t(surface.GetNumControlPoints()));
    surface.GatherControlPoints(positions.data(), 3, control.data(), 3);
    for (std::vector<float> *const values : {&patch->p, &patch->du, &patch->dv}) {
        values->resize(3 * std::size_t(patch->tessellation.GetNumCoords()));
    }
    surface.Evaluate(patch->tessellation, control.data(), 3, patch->p.data(), patch->du.data(),
                     patch->dv.data(), 3);
}

} // namespace

CellSurface::CellSurface(FarExt::TopologyRefiner const &refiner) {
    FarExt::CallStatus status;
    _factory = BfrExt::SurfaceFactory::Create(
        refiner, BfrExt::SurfaceFactory::Options().SetExternalCache(&_cache), &status);
    for (int face = 0; _factory && status.IsOk() && face < _factory->GetNumFaces(); ++face) {
        if (!_factory->GetFaces().IsHole(face)) {
            _factory->FaceHasLimitSurface(face, &status);
        }
    }
    // Behind a first step, surfaces take points of level 1.
    if (status.IsOk() && _factory->GetLevel().GetDepth() > 0) {
        _evaluator = OsdExt::RefinementEvaluator::Create(refiner, &status);
    }
    if (!status.IsOk()) {
        throw std::runtime_error(status.GetErrorMessage());
    }
    _bounds.emplace(*_factory);
}

void CellSurface::Update(std::vector<float> const &positions, Camera const &camera, int height,
                         double pixelError) {
    BfrExt::View const view(findCamera(camera, height),
                            BfrExt::View::Options().SetFlatness(pixelError));
    if (!view.IsValid()) {
        throw std::runtime_error("the camera has no picture");
    }
    FarExt::TopologyLevel const &base = _factory->GetLevel();
    _points = positions;
    if (_evaluator) {
        _points.resize(3 * std::size_t(base.GetNumVertices()));
        OpenSubdiv::Osd::BufferDescriptor const desc(0, 3, 3);
        _evaluator->Evaluate(positions.data(), desc, _points.data(), desc, base.GetDepth());
    }
    _forest = view.MakeForest(*_bounds, _points.data(), 3, _forest ? &*_forest : nullptr);

    // Points on edges are numbered by the forest, and those inside of faces follow.
    Mesh mesh;
    std::vector<Patch> patches;
    std::vector<int> corners; // of all polygons: the place in the patch
    int numPoints = int(_forest->GetNumBoundaryPoints());
    std::vector<int> faces; // of the factory, by polygon
    for (int face = 0; face < _factory->GetNumFaces(); ++face) {
        if (_factory->GetFaces().IsHole(face)) {
            continue;
        }
        patches.push_back(
            {_forest->GetTessellation(face, LevelTessellation::Options().SetFacetSize(0)),
             {},
             {},
             {},
             {}});
        Patch &patch = patches.back();
        evaluate(*_factory, face, _points, &patch);
        LevelTessellation const &tessellation = patch.tessellation;
        patch.points.resize(std::size_t(tessellation.GetNumCoords()));
        int const numBoundary = _forest->GetBoundaryPoints(face, patch.points.data());
        std::iota(patch.points.begin() + numBoundary, patch.points.end(), numPoints);
        numPoints += tessellation.GetNumInteriorCoords();
        mesh.positions.resize(3 * std::size_t(numPoints));
        for (std::size_t place = 0; place < patch.points.size(); ++place) {
            std::copy_n(&patch.p[3 * place], 3,
                        &mesh.positions[3 * std::size_t(patch.points[place])]);
        }
        std::vector<int> numbers(std::size_t(tessellation.GetNumFacets()));
        tessellation.GetFacetSizes(numbers.data());
        mesh.faceSizes.insert(mesh.faceSizes.end(), numbers.begin(), numbers.end());
        faces.insert(faces.end(), numbers.size(), face);
        numbers.resize(std::size_t(tessellation.GetNumFacetVertices()));
        tessellation.GetFacets(numbers.data());
        for (int const place : numbers) {
            corners.push_back(place);
            mesh.faceVertices.push_back(patch.points[std::size_t(place)]);
        }
        AddPatchCreases(base, face, tessellation, patch.points, &mesh.tags);
    }
    _baseFaces.resize(faces.size());
    std::transform(faces.begin(), faces.end(), _baseFaces.begin(),
                   [&](int face) { return _factory->GetFaceBaseFace(face); });
    if (faces.empty()) {
        return;
    }
    FarExt::CallStatus status;
    _polygons = FarExt::TopologyRefinerFactory::Create(DescribeTopology(mesh), {}, {}, &status);
    if (!_polygons) {
        throw std::runtime_error(status.GetErrorMessage());
    }
    FarExt::TopologyLevel const &level = _polygons->GetLevel(0);
    _surface = std::make_unique<Surface>(level);

    // A side has the derivatives of the face that comes last: their normals are the same.
    FarExt::LimitSides const &sides = _surface->GetSides();
    std::vector<float> du(3 * std::size_t(sides.GetNumSides()));
    std::vector<float> dv(du.size());
    auto place = corners.begin();
    auto patch = patches.begin();
    for (int polygon = 0; polygon < level.GetNumFaces(); ++polygon) {
        if (polygon > 0 && faces[std::size_t(polygon)] != faces[std::size_t(polygon) - 1]) {
            ++patch;
        }
        for (int local = 0; local < level.GetFaceVertices(polygon).size(); ++local, ++place) {
            std::size_t const from = 3 * std::size_t(*place);
            std::size_t const to = 3 * std::size_t(sides.FindSide(level, polygon, local));
            std::copy_n(&patch->du[from], 3, &du[to]);
            std::copy_n(&patch->dv[from], 3, &dv[to]);
        }
    }
    _surface->SetPositions(mesh.positions.data(), du.data(), dv.data());
}

} // namespace OpenSubdivHex::Tools

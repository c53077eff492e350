// SPDX-License-Identifier: Apache-2.0
#include "picture.h"

#include "far_ext/topologyRefinerFactory.h"
#include "tools/mesh/fileError.h"
#include "tools/mesh/topologyDescriptor.h"

#ifdef HEXREFINE_HAS_RENDERER
#include "tools/render/pngFile.h"
#include "tools/render/renderer.h"
#include "tools/render/unitSize.h"

#include <algorithm>
#include <iterator>
#endif

namespace OpenSubdivHex::Tools {

#ifdef HEXREFINE_HAS_RENDERER

bool HasRenderer() { return true; }

void WritePicture(FarExt::TopologyLevel const &level, std::vector<float> positions,
                  std::vector<int> const &regions, std::string const &path) {
    ScaleToUnitSize(&positions);
    constexpr int kWidth = 800;
    constexpr int kHeight = 600;
    Surface surface(level, !regions.empty());
    surface.SetPositions(positions.data());
    Scene scene;
    scene.Build(&surface, {}, 0);
    Camera const camera(View(), positions, float(kWidth) / kHeight);
    RenderOptions options;
    options.hasRegions = !regions.empty();
    options.regions = regions;
    WritePng(Render(scene, camera, options, kWidth, kHeight), path);
}

void WriteCellPicture(Mesh const &mesh, AdaptiveCamera const &camera,
                      std::vector<int> const &regions, std::string const &path) {
    // Eye and target are scaled with the mesh; they may be farther away than floats can say.
    std::vector<double> places(mesh.positions.begin(), mesh.positions.end());
    places.insert(places.end(), camera.eye, camera.eye + 3);
    places.insert(places.end(), camera.target, camera.target + 3);
    ScaleToUnitSize(&places);
    Mesh faces;
    faces.faceSizes = mesh.faceSizes;
    faces.faceVertices = mesh.faceVertices;
    faces.tags = mesh.tags;
    std::transform(places.begin(), places.end(), std::back_inserter(faces.positions),
                   [](double place) { return float(place); });
    Vec3 const eye = GetVec3(faces.positions.data(), mesh.GetNumVertices());
    Vec3 const target = GetVec3(faces.positions.data(), mesh.GetNumVertices() + 1);
    faces.positions.resize(mesh.positions.size());

    FarExt::CallStatus status;
    auto const refiner =
        FarExt::TopologyRefinerFactory::Create(DescribeTopology(faces), {}, {}, &status);
    if (!refiner) {
        throw FileError(path, "cannot be made: " + status.GetErrorMessage());
    }
    Surface surface(refiner->GetLevel(0), !regions.empty());
    surface.SetPositions(faces.positions.data());
    Scene scene;
    scene.Build(&surface, {}, 0);
    RenderOptions options;
    options.hasRegions = !regions.empty();
    options.hasWireframe = options.hasRegions;
    options.lineWidth = 1;
    options.regions = regions;
    Camera const view(eye, target, camera.fieldOfView, float(camera.width) / float(camera.height));
    WritePng(Render(scene, view, options, camera.width, camera.height), path);
}

#else

bool HasRenderer() { return false; }

void WritePicture(FarExt::TopologyLevel const &, std::vector<float>, std::vector<int> const &,
                  std::string const &path) {
    throw FileError(path, "cannot be made: this program was built without Embree and libpng");
}

void WriteCellPicture(Mesh const &, AdaptiveCamera const &, std::vector<int> const &,
                      std::string const &path) {
    throw FileError(path, "cannot be made: this program was built without Embree and libpng");
}

#endif

} // namespace OpenSubdivHex::Tools

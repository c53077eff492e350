// SPDX-License-Identifier: Apache-2.0
#include "picture.h"

#include "far_ext/topologyRefinerFactory.h"
#include "tools/render/pngFile.h"

#include <algorithm>
#include <stdexcept>

namespace OpenSubdivHex::Regression {

namespace {

using namespace Tools;

std::vector<float> getPositions(PolygonMesh const &mesh) {
    std::vector<float> positions;
    for (Eigen::Vector3d const &position : mesh.positions) {
        // The third axis is up in the meshes, the second in the renderer.
        positions.insert(positions.end(),
                         {float(position.y()), float(position.z()), float(position.x())});
    }
    return positions;
}

std::unique_ptr<FarExt::TopologyRefiner> createTopology(PolygonMesh const &mesh) {
    std::vector<int> sizes;
    for (int face = 0; face < mesh.GetNumFaces(); ++face) {
        sizes.push_back(mesh.GetFaceSize(face));
    }
    Far::TopologyDescriptor descriptor;
    descriptor.numVertices = mesh.GetNumVertices();
    descriptor.numFaces = mesh.GetNumFaces();
    descriptor.numVertsPerFace = sizes.data();
    descriptor.vertIndicesPerFace = mesh.faceVertices.data();
    FarExt::CallStatus status;
    auto refiner = FarExt::TopologyRefinerFactory::Create(descriptor, Sdc::Options(), &status);
    if (!refiner) {
        throw std::runtime_error(status.GetErrorMessage());
    }
    return refiner;
}

std::string encodeBase64(std::string const &bytes) {
    constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::size_t const count = std::min<std::size_t>(3, bytes.size() - i);
        unsigned triple = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            triple = triple << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        }
        for (std::size_t k = 0; k < 4; ++k) {
            text += k <= count ? kDigits[triple >> (18 - 6 * k) & 63] : '=';
        }
    }
    return text;
}

} // namespace

std::string DrawMesh(PolygonMesh const &mesh, PolygonMesh const &frame,
                     PictureOptions const &options, Settings const &settings) {
    auto const refiner = createTopology(mesh);
    Surface surface(refiner->GetLevel(0));
    surface.SetPositions(getPositions(mesh).data());
    Scene scene;
    scene.Build(&surface, {}, 0);

    RenderOptions renderOptions;
    renderOptions.look = options.look;
    renderOptions.hasWireframe = options.hasWireframe;
    renderOptions.isTinted = options.isTinted;
    renderOptions.lineWidth = 1.2f;
    renderOptions.numSamples = settings.numSamples;
    Camera const camera(options.view, getPositions(frame), float(options.aspect));
    int const width = settings.pictureWidth;
    int const height = std::max(1, int(width / options.aspect));
    std::string const png = EncodePng(Render(scene, camera, renderOptions, width, height));
    return "<img width=\"" + std::to_string(width) + "\" height=\"" + std::to_string(height) +
           "\" alt=\"refined mesh\" src=\"data:image/png;base64," + encodeBase64(png) + "\">";
}

} // namespace OpenSubdivHex::Regression

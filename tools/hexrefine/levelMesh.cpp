// SPDX-License-Identifier: Apache-2.0
#include "levelMesh.h"

#include "osd_ext/polygonIndices.h"

#include <cstdint>
#include <cstring>
#include <map>
#include <numeric>
#include <utility>

namespace OpenSubdivHex::Tools {

namespace {

/// A number for each base face, the same for those that no label and no property tells apart; empty
/// where faces have neither.
std::vector<int> findClasses(Mesh const &mesh) {
    std::vector<int> classes = mesh.faceLabels;
    for (FaceProperty const &property : mesh.faceProperties) {
        classes.resize(property.values.size(), 0);
        std::map<std::pair<int, std::uint64_t>, int> known;
        for (std::size_t face = 0; face < classes.size(); ++face) {
            std::uint64_t bits = 0; // a number may be none
            std::memcpy(&bits, &property.values[face], sizeof bits);
            classes[face] =
                known.try_emplace({classes[face], bits}, int(known.size())).first->second;
        }
    }
    return classes;
}

/// \p sides is null where no channel has their values.
void copyFaces(FarExt::TopologyLevel const &level, FarExt::LimitSides const *sides, Mesh *mesh) {
    std::vector<int> const classes = findClasses(*mesh);
    OsdExt::DrawOptions options;
    options.cutBaseFaces = false;
    options.labels = OpenSubdiv::Far::ConstIndexArray(classes.data(), int(classes.size()));
    options.cutCreases = OsdExt::CreaseCuts::None;
    options.sides = sides;
    options.fvarChannels.resize(mesh->channels.size() - (sides ? 1 : 0));
    std::iota(options.fvarChannels.begin(), options.fvarChannels.end(), 0);
    OsdExt::PolygonIndices polygons = OsdExt::CreatePolygonIndices(level, options);
    mesh->faceSizes = std::move(polygons.sizes);
    mesh->faceVertices = std::move(polygons.vertices);
    mesh->baseFaces = classes.empty() ? std::vector<int>() : std::move(polygons.baseFaces);
    for (std::size_t i = 0; i < polygons.fvarValues.size(); ++i) {
        mesh->channels[i].faceValues = std::move(polygons.fvarValues[i]);
    }
    if (sides) {
        mesh->channels.back().faceValues = std::move(polygons.sides);
    }
}

} // namespace

void CopyFaces(FarExt::TopologyLevel const &level, Mesh *mesh) { copyFaces(level, nullptr, mesh); }

void CopyFaces(FarExt::TopologyLevel const &level, FarExt::LimitSides const &sides, Mesh *mesh) {
    copyFaces(level, &sides, mesh);
}

} // namespace OpenSubdivHex::Tools

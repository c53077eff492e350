// SPDX-License-Identifier: Apache-2.0
#include "levelMesh.h"

#include "osd_ext/polygonIndices.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <map>
#include <numeric>
#include <utility>

namespace OpenSubdivHex::Tools {

std::vector<int> FindFaceClasses(Mesh const &mesh) {
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

namespace {

/// The elements of \p from, of face i from firsts[i] on, face by face in the order \p faces.
std::vector<int> permute(std::vector<int> const &from, std::vector<std::size_t> const &firsts,
                         std::vector<std::size_t> const &faces) {
    std::vector<int> result;
    result.reserve(from.size());
    for (std::size_t face : faces) {
        result.insert(result.end(), from.begin() + std::ptrdiff_t(firsts[face]),
                      from.begin() + std::ptrdiff_t(firsts[face + 1]));
    }
    return result;
}

} // namespace

void SortFacesByLabel(Mesh *mesh) {
    if (mesh->faceLabels.empty()) {
        return;
    }
    std::size_t const numFaces = mesh->faceSizes.size();
    std::vector<std::size_t> firstCorners(numFaces + 1); // of faces
    std::vector<std::size_t> places(mesh->labels.size() + 1);
    auto const getLabel = [&](std::size_t face) {
        return std::size_t(mesh->faceLabels[std::size_t(mesh->GetBaseFace(int(face)))]);
    };
    for (std::size_t face = 0; face < numFaces; ++face) {
        firstCorners[face + 1] = firstCorners[face] + std::size_t(mesh->faceSizes[face]);
        ++places[getLabel(face) + 1];
    }
    std::partial_sum(places.begin(), places.end(), places.begin());
    std::vector<std::size_t> order(numFaces);
    for (std::size_t face = 0; face < numFaces; ++face) {
        order[places[getLabel(face)]++] = face;
    }
    if (std::is_sorted(order.begin(), order.end())) {
        return;
    }
    mesh->faceVertices = permute(mesh->faceVertices, firstCorners, order);
    for (FVarChannel &channel : mesh->channels) {
        channel.faceValues = permute(channel.faceValues, firstCorners, order);
    }
    std::vector<int> sizes(numFaces);
    std::vector<int> baseFaces(numFaces);
    for (std::size_t i = 0; i < numFaces; ++i) {
        sizes[i] = mesh->faceSizes[order[i]];
        baseFaces[i] = mesh->GetBaseFace(int(order[i]));
    }
    mesh->faceSizes = std::move(sizes);
    mesh->baseFaces = std::move(baseFaces);
}

namespace {

/// Returns the data of vertices, \p width numbers each, in the order \p verts.
std::vector<float> gather(std::vector<float> const &from, std::size_t width,
                          std::vector<int> const &verts) {
    std::vector<float> result;
    result.reserve(width * verts.size());
    for (int vert : verts) {
        auto const first = from.begin() + std::ptrdiff_t(width * std::size_t(vert));
        result.insert(result.end(), first, first + std::ptrdiff_t(width));
    }
    return result;
}

/// Makes what vertices have that of \p drawn, and with it properties of the values of channels.
void separateVertices(OsdExt::DrawnVertices const &drawn, bool hasSides, Mesh *mesh) {
    mesh->positions = gather(mesh->positions, 3, drawn.vertices);
    for (VertexProperty &property : mesh->vertexProperties) {
        property.values = gather(property.values, 1, drawn.vertices);
    }
    for (std::size_t i = 0; i < mesh->channels.size(); ++i) {
        FVarChannel const &channel = mesh->channels[i];
        bool const isOfSides = hasSides && i + 1 == mesh->channels.size();
        std::vector<int> const &values = isOfSides ? drawn.sides : drawn.fvarValues[i];
        for (int k = 0; k < channel.width; ++k) {
            VertexProperty property{GetPropertyName(channel.kind, k), NumberType::Float, {}};
            property.values.reserve(values.size());
            for (int value : values) {
                property.values.push_back(
                    channel.values[std::size_t(value * std::int64_t(channel.width) + k)]);
            }
            mesh->vertexProperties.push_back(std::move(property));
        }
    }
    mesh->channels.clear();
}

/// \p sides is null where no channel has their values.
void copyFaces(FarExt::TopologyLevel const &level, FarExt::LimitSides const *sides, bool isSeparate,
               Mesh *mesh) {
    std::vector<int> const classes = FindFaceClasses(*mesh);
    OsdExt::DrawOptions options;
    options.cutBaseFaces = false;
    options.labels = OpenSubdiv::Far::ConstIndexArray(classes.data(), int(classes.size()));
    options.cutCreases = OsdExt::CreaseCuts::NoCreases;
    options.sides = sides;
    options.separateVertices = isSeparate;
    options.fvarChannels.resize(mesh->channels.size() - (sides ? 1 : 0));
    std::iota(options.fvarChannels.begin(), options.fvarChannels.end(), 0);
    OsdExt::PolygonIndices polygons = OsdExt::CreatePolygonIndices(level, options);
    mesh->faceSizes = std::move(polygons.sizes);
    mesh->faceVertices = std::move(polygons.vertices);
    mesh->baseFaces = classes.empty() ? std::vector<int>() : std::move(polygons.baseFaces);
    if (isSeparate) {
        separateVertices(polygons.drawnVertices, sides != nullptr, mesh);
    }
    for (std::size_t i = 0; i < polygons.fvarValues.size() && !isSeparate; ++i) {
        mesh->channels[i].faceValues = std::move(polygons.fvarValues[i]);
    }
    if (sides && !isSeparate) {
        mesh->channels.back().faceValues = std::move(polygons.sides);
    }
    // Faces that are not refined stay in the order of the file.
    if (level.GetDepth() > 0) {
        SortFacesByLabel(mesh);
    }
}

} // namespace

void CopyFaces(FarExt::TopologyLevel const &level, Mesh *mesh) {
    copyFaces(level, nullptr, false, mesh);
}

void CopyFaces(FarExt::TopologyLevel const &level, FarExt::LimitSides const &sides, Mesh *mesh) {
    copyFaces(level, &sides, false, mesh);
}

void CopySeparateFaces(FarExt::TopologyLevel const &level, FarExt::LimitSides const *sides,
                       Mesh *mesh) {
    copyFaces(level, sides, true, mesh);
}

} // namespace OpenSubdivHex::Tools

// SPDX-License-Identifier: Apache-2.0
#include "objShape.h"

#include <tiny_obj_loader.h>

#include <stdexcept>

namespace OpenSubdivHex::Regression {

Shape LoadObjShape(std::string name, std::string const &path) {
    tinyobj::ObjReaderConfig config;
    config.triangulate = false;
    tinyobj::ObjReader reader;
    if (!reader.ParseFromFile(path, config)) {
        throw std::runtime_error(path + ": " + reader.Error());
    }
    Shape shape;
    shape.name = std::move(name);
    shape.positions.assign(reader.GetAttrib().vertices.begin(), reader.GetAttrib().vertices.end());
    FVarChannel uvs;
    uvs.values.assign(reader.GetAttrib().texcoords.begin(), reader.GetAttrib().texcoords.end());
    bool everyCornerHasUv = true;
    for (tinyobj::shape_t const &object : reader.GetShapes()) {
        for (auto size : object.mesh.num_face_vertices) {
            shape.faceSizes.push_back(int(size));
        }
        for (tinyobj::index_t const &corner : object.mesh.indices) {
            shape.faceVertices.push_back(corner.vertex_index);
            uvs.valueIndices.push_back(corner.texcoord_index);
            everyCornerHasUv = everyCornerHasUv && corner.texcoord_index >= 0;
        }
    }
    if (everyCornerHasUv) {
        shape.fvarChannels.push_back(std::move(uvs));
    }
    return shape;
}

} // namespace OpenSubdivHex::Regression

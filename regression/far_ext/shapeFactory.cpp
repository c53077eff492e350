// SPDX-License-Identifier: Apache-2.0
#include "shapeFactory.h"

#include <algorithm>

namespace OpenSubdivHex::FarExt {

using Regression::FVarChannel;
using Regression::Shape;

template <>
bool MeshRefinerFactory<Shape>::resizeComponentTopology(BaseTopology &base, Shape const &shape) {
    setNumBaseVertices(base, shape.GetNumVertices());
    setNumBaseFaces(base, shape.GetNumFaces());
    for (int face = 0; face < shape.GetNumFaces(); ++face) {
        setNumBaseFaceVertices(base, face, shape.faceSizes[std::size_t(face)]);
    }
    return true;
}

template <>
bool MeshRefinerFactory<Shape>::assignComponentTopology(BaseTopology &base, Shape const &shape) {
    auto next = shape.faceVertices.begin();
    for (int face = 0; face < getNumBaseFaces(base); ++face) {
        IndexArray verts = getBaseFaceVertices(base, face);
        std::copy_n(next, verts.size(), verts.begin());
        next += verts.size();
    }
    return true;
}

template <>
bool MeshRefinerFactory<Shape>::assignComponentTags(BaseTopology &base, Shape const &shape) {
    for (std::size_t i = 0; i < shape.creaseSharpness.size(); ++i) {
        int const *const verts = &shape.creaseVertexPairs[2 * i];
        setBaseEdgeSharpness(base, findBaseEdge(base, verts[0], verts[1]),
                             shape.creaseSharpness[i]);
    }
    for (std::size_t i = 0; i < shape.cornerSharpness.size(); ++i) {
        setBaseVertexSharpness(base, shape.cornerVertices[i], shape.cornerSharpness[i]);
    }
    for (int face : shape.holeFaces) {
        setBaseFaceHole(base, face, true);
    }
    return true;
}

template <>
bool MeshRefinerFactory<Shape>::assignFaceVaryingTopology(BaseTopology &base, Shape const &shape) {
    for (FVarChannel const &fvar : shape.fvarChannels) {
        int const channel = createBaseFVarChannel(base, int(fvar.values.size()) / fvar.width);
        auto next = fvar.valueIndices.begin();
        for (int face = 0; face < getNumBaseFaces(base); ++face) {
            IndexArray values = getBaseFaceFVarValues(base, face, channel);
            std::copy_n(next, values.size(), values.begin());
            next += values.size();
        }
    }
    return true;
}

} // namespace OpenSubdivHex::FarExt

// SPDX-License-Identifier: Apache-2.0
#include "shapeDescriptor.h"

namespace OpenSubdivHex::Regression {

namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;

ShapeDescriptor::ShapeDescriptor(Shape const &shape) {
    _descriptor.numVertices = shape.GetNumVertices();
    _descriptor.numFaces = shape.GetNumFaces();
    _descriptor.numVertsPerFace = shape.faceSizes.data();
    _descriptor.vertIndicesPerFace = shape.faceVertices.data();
    _descriptor.numCreases = int(shape.creaseSharpness.size());
    _descriptor.creaseVertexIndexPairs = shape.creaseVertexPairs.data();
    _descriptor.creaseWeights = shape.creaseSharpness.data();
    _descriptor.numCorners = int(shape.cornerSharpness.size());
    _descriptor.cornerVertexIndices = shape.cornerVertices.data();
    _descriptor.cornerWeights = shape.cornerSharpness.data();
    _descriptor.numHoles = int(shape.holeFaces.size());
    _descriptor.holeIndices = shape.holeFaces.data();
    _descriptor.isLeftHanded = shape.leftHanded;
    for (FVarChannel const &channel : shape.fvarChannels) {
        _fvarChannels.emplace_back();
        _fvarChannels.back().numValues = int(channel.values.size()) / channel.width;
        _fvarChannels.back().valueIndices = channel.valueIndices.data();
    }
    _descriptor.numFVarChannels = int(_fvarChannels.size());
    _descriptor.fvarChannels = _fvarChannels.data();
}

std::unique_ptr<Far::TopologyRefiner> CreateFarRefiner(Shape const &shape, Sdc::Options options) {
    using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
    ShapeDescriptor const descriptor(shape);
    return std::unique_ptr<Far::TopologyRefiner>(
        Factory::Create(descriptor.Get(), Factory::Options(Sdc::SCHEME_CATMARK, options)));
}

} // namespace OpenSubdivHex::Regression

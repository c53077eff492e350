// SPDX-License-Identifier: Apache-2.0
#include "farBase.h"

#include <opensubdiv/far/topologyRefinerFactory.h>

namespace OpenSubdivHex::FarExt::internal {

namespace {

using Far::Index;

/// A descriptor that has its creases assigned below.
struct Mesh {
    Far::TopologyDescriptor const &descriptor;
};

/// What Far does of a descriptor.
struct DescriptorFactory : Far::TopologyRefinerFactory<Far::TopologyDescriptor> {
    using Base = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
    using Base::assignComponentTags;
    using Base::assignComponentTopology;
    using Base::assignFaceVaryingTopology;
    using Base::resizeComponentTopology;
};

Index findEdge(Far::TopologyLevel const &level, Index v0, Index v1) {
    for (Index const edge : {level.FindEdge(v0, v1), level.FindEdge(v1, v0)}) {
        if (edge != Far::INDEX_INVALID) {
            return edge;
        }
    }
    for (Index face = 0; face < level.GetNumFaces(); ++face) {
        Far::ConstIndexArray const verts = level.GetFaceVertices(face);
        for (int i = 0; i < verts.size(); ++i) {
            Index const end = verts[(i + 1) % verts.size()];
            if ((verts[i] == v0 && end == v1) || (verts[i] == v1 && end == v0)) {
                return level.GetFaceEdges(face)[i];
            }
        }
    }
    return Far::INDEX_INVALID;
}

} // namespace

} // namespace OpenSubdivHex::FarExt::internal

namespace OpenSubdiv::OPENSUBDIV_VERSION::Far {

using OpenSubdivHex::FarExt::internal::DescriptorFactory;
using OpenSubdivHex::FarExt::internal::findEdge;
using OpenSubdivHex::FarExt::internal::Mesh;

template <>
bool TopologyRefinerFactory<Mesh>::resizeComponentTopology(TopologyRefiner &refiner,
                                                           Mesh const &mesh) {
    return DescriptorFactory::resizeComponentTopology(refiner, mesh.descriptor);
}

template <>
bool TopologyRefinerFactory<Mesh>::assignComponentTopology(TopologyRefiner &refiner,
                                                           Mesh const &mesh) {
    return DescriptorFactory::assignComponentTopology(refiner, mesh.descriptor);
}

template <>
bool TopologyRefinerFactory<Mesh>::assignComponentTags(TopologyRefiner &refiner, Mesh const &mesh) {
    TopologyDescriptor others = mesh.descriptor;
    others.numCreases = 0;
    for (int i = 0; i < mesh.descriptor.numCreases; ++i) {
        Index const *verts = mesh.descriptor.creaseVertexIndexPairs + 2 * std::ptrdiff_t(i);
        setBaseEdgeSharpness(refiner, findEdge(refiner.GetLevel(0), verts[0], verts[1]),
                             mesh.descriptor.creaseWeights[i]);
    }
    return DescriptorFactory::assignComponentTags(refiner, others);
}

template <>
bool TopologyRefinerFactory<Mesh>::assignFaceVaryingTopology(TopologyRefiner &refiner,
                                                             Mesh const &mesh) {
    return DescriptorFactory::assignFaceVaryingTopology(refiner, mesh.descriptor);
}

} // namespace OpenSubdiv::OPENSUBDIV_VERSION::Far

namespace OpenSubdivHex::FarExt::internal {

std::unique_ptr<Far::TopologyRefiner> CreateFarBase(Far::TopologyDescriptor const &descriptor,
                                                    Sdc::Options sdcOptions) {
    using FarFactory = Far::TopologyRefinerFactory<Mesh>;
    return std::unique_ptr<Far::TopologyRefiner>(
        FarFactory::Create({descriptor}, FarFactory::Options(Sdc::SCHEME_CATMARK, sdcOptions)));
}

} // namespace OpenSubdivHex::FarExt::internal

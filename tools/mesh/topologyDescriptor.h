// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_TOPOLOGY_DESCRIPTOR_H
#define OPENSUBDIVHEX_TOOLS_TOPOLOGY_DESCRIPTOR_H

#include "mesh.h"

#include <opensubdiv/far/topologyDescriptor.h>

namespace OpenSubdivHex::Tools {

/// The topology of \p mesh as OpenSubdiv's factories take it, with creases, corners and holes and
/// without face-varying channels.  It points into \p mesh.
inline OpenSubdiv::Far::TopologyDescriptor DescribeTopology(Mesh const &mesh) {
    OpenSubdiv::Far::TopologyDescriptor descriptor;
    descriptor.numVertices = mesh.GetNumVertices();
    descriptor.numFaces = mesh.GetNumFaces();
    descriptor.numVertsPerFace = mesh.faceSizes.data();
    descriptor.vertIndicesPerFace = mesh.faceVertices.data();
    descriptor.numCreases = mesh.tags.GetNumCreases();
    descriptor.creaseVertexIndexPairs = mesh.tags.creaseVertices.data();
    descriptor.creaseWeights = mesh.tags.creaseSharpness.data();
    descriptor.numCorners = mesh.tags.GetNumCorners();
    descriptor.cornerVertexIndices = mesh.tags.cornerVertices.data();
    descriptor.cornerWeights = mesh.tags.cornerSharpness.data();
    descriptor.numHoles = mesh.tags.GetNumHoles();
    descriptor.holeIndices = mesh.tags.holes.data();
    return descriptor;
}

/// The channels of \p mesh, to be pointed to by the descriptor's fvarChannels.  They point into
/// \p mesh.
inline std::vector<OpenSubdiv::Far::TopologyDescriptor::FVarChannel>
DescribeChannels(Mesh const &mesh) {
    std::vector<OpenSubdiv::Far::TopologyDescriptor::FVarChannel> channels(mesh.channels.size());
    for (std::size_t i = 0; i < channels.size(); ++i) {
        channels[i].numValues = mesh.channels[i].GetNumValues();
        channels[i].valueIndices = mesh.channels[i].faceValues.data();
    }
    return channels;
}

} // namespace OpenSubdivHex::Tools

#endif

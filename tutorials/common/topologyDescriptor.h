// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TUTORIALS_TOPOLOGY_DESCRIPTOR_H
#define OPENSUBDIVHEX_TUTORIALS_TOPOLOGY_DESCRIPTOR_H

#include "mesh.h"

#include <opensubdiv/far/topologyDescriptor.h>

namespace OpenSubdivHex::Tutorials {

/// The topology of \p mesh as OpenSubdiv's factories take it.  It points into \p mesh.
inline OpenSubdiv::Far::TopologyDescriptor DescribeTopology(Mesh const &mesh) {
    OpenSubdiv::Far::TopologyDescriptor descriptor;
    descriptor.numVertices = mesh.GetNumVertices();
    descriptor.numFaces = mesh.GetNumFaces();
    descriptor.numVertsPerFace = mesh.faceSizes.data();
    descriptor.vertIndicesPerFace = mesh.faceVertices.data();
    return descriptor;
}

} // namespace OpenSubdivHex::Tutorials

#endif

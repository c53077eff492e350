// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_CATMARK_REFINER_H
#define OPENSUBDIVHEX_TOOLS_CATMARK_REFINER_H

#include "fileError.h"
#include "topologyDescriptor.h"

#include <opensubdiv/far/topologyRefinerFactory.h>

#include <memory>
#include <string>

namespace OpenSubdivHex::Tools {

/// \brief OpenSubdiv's refiner of a mesh of quads by Catmull-Clark, for Bfr's surfaces.
///
/// Throws FileError for faces of other sizes, where (u, v) of Bfr are not those of BfrExt, and for what
/// OpenSubdiv refuses.
inline std::unique_ptr<OpenSubdiv::Far::TopologyRefiner>
CreateCatmarkRefiner(Mesh const &mesh, OpenSubdiv::Sdc::Options options, std::string const &input) {
    for (int face = 0; face < mesh.GetNumFaces(); ++face) {
        int const size = mesh.faceSizes[std::size_t(face)];
        if (size != 4) {
            throw FileError(input, "face " + std::to_string(face) + " has " + std::to_string(size) +
                                       " sides, but Bfr's (u, v) are the same in quads alone");
        }
    }
    using Factory = OpenSubdiv::Far::TopologyRefinerFactory<OpenSubdiv::Far::TopologyDescriptor>;
    std::unique_ptr<OpenSubdiv::Far::TopologyRefiner> refiner(Factory::Create(
        DescribeTopology(mesh), Factory::Options(OpenSubdiv::Sdc::SCHEME_CATMARK, options)));
    if (!refiner) {
        throw FileError(input, "OpenSubdiv makes no refiner of it");
    }
    return refiner;
}

} // namespace OpenSubdivHex::Tools

#endif

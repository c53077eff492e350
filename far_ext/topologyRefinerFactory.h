// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_TOPOLOGY_REFINER_FACTORY_H
#define OPENSUBDIVHEX_FAR_EXT_TOPOLOGY_REFINER_FACTORY_H

#include "topologyRefiner.h"

#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefiner.h>

namespace OpenSubdivHex::FarExt {

/// \brief Makes a TopologyRefiner from a base mesh as OpenSubdiv describes it.
///
/// Level 0 keeps the base's numbering of vertices, edges, faces and corners.
class TopologyRefinerFactory {
public:
    struct Options {
        SchemeOptions schemeOptions;
    };

    /// \brief Takes level 0 of \p base, which need not be refined and may have any Sdc scheme type
    /// that accepts its faces (Catmark takes all).
    ///
    /// The boundary rule is that of base.GetSchemeOptions(); VTX_BOUNDARY_NONE, the paper's rule,
    /// is the one supported.
    ///
    /// \return  null on failure: InvalidTopology (no faces, a face with fewer than three vertices
    ///          or with a repeated vertex, two faces that run an edge in the same direction) or
    ///          Unsupported (another boundary rule; non-manifold edges and vertices; crease and
    ///          corner sharpness).
    static std::unique_ptr<TopologyRefiner> Create(Far::TopologyRefiner const &base,
                                                   Options options, Status *status = nullptr);
    static std::unique_ptr<TopologyRefiner> Create(Far::TopologyRefiner const &base,
                                                   Status *status = nullptr) {
        return Create(base, Options(), status);
    }

    /// \brief The same from a descriptor, as Far's factory takes it, with the boundary and crease
    /// options \p sdcOptions.
    ///
    /// Additionally refuses, with InvalidTopology, vertex indices out of range.
    static std::unique_ptr<TopologyRefiner> Create(Far::TopologyDescriptor const &descriptor,
                                                   Sdc::Options sdcOptions, Options options,
                                                   Status *status = nullptr);
    static std::unique_ptr<TopologyRefiner> Create(Far::TopologyDescriptor const &descriptor,
                                                   Sdc::Options sdcOptions = Sdc::Options(),
                                                   Status *status = nullptr) {
        return Create(descriptor, sdcOptions, Options(), status);
    }
};

} // namespace OpenSubdivHex::FarExt

#endif

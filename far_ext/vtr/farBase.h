// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_FAR_BASE_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_FAR_BASE_H

#include "far_ext/status.h"

#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefiner.h>

#include <memory>

namespace OpenSubdivHex::FarExt::internal {

/// \brief The refiner that Far's factory makes of a descriptor, with all creases.
///
/// Far itself looks for creases in the edges that it lists for a vertex; it prints that there is no
/// such edge, and drops the crease, where a face has the vertex several times and these lists lack
/// some edges.  Every crease of \p descriptor is an edge of a face.
///
/// \return  null if Far refuses the mesh
std::unique_ptr<Far::TopologyRefiner> CreateFarBase(Far::TopologyDescriptor const &descriptor,
                                                    Sdc::Options sdcOptions);

} // namespace OpenSubdivHex::FarExt::internal

#endif

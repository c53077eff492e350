// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_FAR_BASE_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_FAR_BASE_H

#include "baseMesh.h"

#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefiner.h>

namespace OpenSubdivHex::FarExt::internal {

/// @name Base meshes as Far has them
/// Each reads all of the base into \p mesh, whose options are those of the base.  A CallStatus that is Ok
/// may have warnings.
/// @{

/// The base level of a refiner, with its own numbers of edges.
CallStatus ReadRefiner(Far::TopologyRefiner const &base, BaseMesh &mesh);

/// A descriptor, whose edges are numbered as Far does.
CallStatus ReadDescriptor(Far::TopologyDescriptor const &descriptor, BaseMesh &mesh);
/// @}

} // namespace OpenSubdivHex::FarExt::internal

#endif

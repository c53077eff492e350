// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_INPUT_CHECKS_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_INPUT_CHECKS_H

#include "hierarchy.h"

#include "far_ext/hexSchemeOptions.h"

#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyLevel.h>

namespace OpenSubdivHex::FarExt::internal {

/// @name What the input of a refiner may be
/// Each returns Ok, or a Status that names the component and what is wrong with it.
/// @{

/// Options that are none of their enumerations' values.
Status CheckOptions(HexSchemeOptions schemeOptions, Sdc::Options sdcOptions);
/// All of a descriptor that Far would crash on, print about or drop.
Status CheckDescriptor(Far::TopologyDescriptor const &descriptor);
/// The faces and the sharpness of a base level.
Status CheckBase(Far::TopologyLevel const &base);
/// Features that the scheme has no rules for.
Status CheckScheme(HexSchemeOptions schemeOptions, Hierarchy const &base);
/// @}

} // namespace OpenSubdivHex::FarExt::internal

#endif

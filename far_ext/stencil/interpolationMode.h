// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_STENCIL_INTERPOLATION_MODE_H
#define OPENSUBDIVHEX_FAR_EXT_STENCIL_INTERPOLATION_MODE_H

#include "far_ext/rules/mask.h"
#include "far_ext/stencilTableFactory.h"
#include "far_ext/topologyRefiner.h"

namespace OpenSubdivHex::FarExt::internal {

/// InvalidArgument where a channel is none of the \p numChannels face-varying ones of a mesh.
OPENSUBDIVHEX_API CallStatus CheckChannel(int channel, int numChannels);
/// By which masks the values of a channel, which is in range, are interpolated.
OPENSUBDIVHEX_API Interpolation GetChannelInterpolation(TopologyRefiner const &refiner,
                                                        int channel);

/// InvalidArgument for a mode that is none, and for face-varying data of a channel that the mesh has not.
OPENSUBDIVHEX_API CallStatus CheckStencilMode(TopologyRefiner const &refiner, StencilMode mode,
                                              int fvarChannel);
/// By which masks data are interpolated, with a mode for which CheckStencilMode() is well.
OPENSUBDIVHEX_API Interpolation GetModeInterpolation(TopologyRefiner const &refiner,
                                                     StencilMode mode, int fvarChannel);

} // namespace OpenSubdivHex::FarExt::internal

#endif

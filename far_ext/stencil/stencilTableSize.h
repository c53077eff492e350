// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_STENCIL_STENCIL_TABLE_SIZE_H
#define OPENSUBDIVHEX_FAR_EXT_STENCIL_STENCIL_TABLE_SIZE_H

#include "far_ext/stencilTableFactory.h"

#include <cstddef>

namespace OpenSubdivHex::FarExt::internal {

struct StencilPlan;

/// \brief Estimates the size of the table that \p plan asks for, with weights of \p weightBytes.
///
/// \return  TooLarge when the faces that are looked at alone are
CallStatus EstimateTableSize(StencilPlan const &plan, std::size_t weightBytes,
                             StencilTableSize &size);

} // namespace OpenSubdivHex::FarExt::internal

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_STENCIL_TABLE_SIZE_H
#define OPENSUBDIVHEX_FAR_EXT_STENCIL_TABLE_SIZE_H

#include "status.h"

#include <cstddef>
#include <cstdint>

namespace OpenSubdivHex::FarExt {

/// \brief What a stencil table holds and takes: see StencilTableFactoryReal::EstimateSize.
struct StencilTableSize {
    std::int64_t numStencils = 0;
    std::int64_t numWeights = 0;
    std::int64_t numBytes = 0;     ///< of the table's arrays
    std::int64_t numPeakBytes = 0; ///< of all that its making takes at once, the table included
};

namespace internal {

struct StencilPlan;

/// \brief Estimates the size of the table that \p plan asks for, with weights of \p weightBytes.
///
/// \return  TooLarge when the faces that are looked at alone are
Status EstimateTableSize(StencilPlan const &plan, std::size_t weightBytes, StencilTableSize &size);

} // namespace internal

} // namespace OpenSubdivHex::FarExt

#endif

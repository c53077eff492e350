// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_REPORT_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_REPORT_H

#include "far_ext/status.h"

namespace OpenSubdivHex::FarExt::internal {

/// Assigns \p result to \p status (when given) and sends a failure to the installed callback.
/// Returns result.IsOk().
OPENSUBDIVHEX_API bool Report(CallStatus const &result, CallStatus *status);

/// A failure that no single component is to blame for.
inline CallStatus Failure(StatusCode code, std::string message) {
    return CallStatus(code, ComponentType::NoComponent, Far::INDEX_INVALID, std::move(message));
}

/// Whether \p value, which a cast may have made of any number, is one of an enumeration that goes
/// from 0 to \p last.
template <typename ENUM>
bool IsInEnum(int value, ENUM last) {
    return 0 <= value && value <= int(last);
}

} // namespace OpenSubdivHex::FarExt::internal

#endif

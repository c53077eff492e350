// SPDX-License-Identifier: Apache-2.0
#include "status.h"

#include "far_ext/vtr/report.h"

namespace OpenSubdivHex::FarExt {

namespace {
bool callbackInstalled = false;
}

void SetErrorCallback(Far::ErrorCallbackFunc callback) {
    Far::SetErrorCallback(callback);
    callbackInstalled = (callback != nullptr);
}

namespace internal {

bool Report(CallStatus const &result, CallStatus *status) {
    if (status) {
        *status = result;
    }
    if (!result.IsOk() && callbackInstalled) {
        Far::Error(Far::FAR_RUNTIME_ERROR, "%s", result.GetErrorMessage().c_str());
    }
    return result.IsOk();
}

} // namespace internal
} // namespace OpenSubdivHex::FarExt

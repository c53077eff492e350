// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_EMBREE_ERROR_H
#define OPENSUBDIVHEX_TOOLS_EMBREE_ERROR_H

#include <embree3/rtcore.h>

#include <new>
#include <stdexcept>
#include <string>

namespace OpenSubdivHex::Tools {

/// Throws std::bad_alloc if \p device had no memory since the last call, and std::runtime_error after
/// any other error.
inline void ThrowEmbreeError(RTCDevice device) {
    RTCError const error = rtcGetDeviceError(device);
    if (error == RTC_ERROR_OUT_OF_MEMORY) {
        throw std::bad_alloc();
    }
    if (error != RTC_ERROR_NONE) {
        throw std::runtime_error("error " + std::to_string(error) + " of Embree");
    }
}

} // namespace OpenSubdivHex::Tools

#endif

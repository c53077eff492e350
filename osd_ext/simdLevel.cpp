// SPDX-License-Identifier: Apache-2.0
#include "simdLevel.h"

#include <atomic>

namespace OpenSubdivHex::OsdExt {
namespace {

SimdLevel detectMaxSimdLevel() {
#ifdef OPENSUBDIVHEX_HAS_X86_KERNELS
    // These ask the operating system, too, whether it saves the registers.
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
        return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl")
                   ? SimdLevel::Avx512
                   : SimdLevel::Avx2;
    }
#endif
    return SimdLevel::Portable;
}

std::atomic<SimdLevel> &currentSimdLevel() {
    static std::atomic<SimdLevel> level(GetMaxSimdLevel());
    return level;
}

} // namespace

SimdLevel GetMaxSimdLevel() {
    static SimdLevel const kLevel = detectMaxSimdLevel();
    return kLevel;
}

SimdLevel GetSimdLevel() { return currentSimdLevel(); }

bool SetSimdLevel(SimdLevel level) {
    if (level > GetMaxSimdLevel()) {
        return false;
    }
    currentSimdLevel() = level;
    return true;
}

} // namespace OpenSubdivHex::OsdExt

// SPDX-License-Identifier: Apache-2.0
#include "simdLevel.h"

#include <atomic>
#include <cstdlib>
#include <cstring>

namespace OpenSubdivHex::OsdExt {
namespace {

constexpr SimdLevel kSimdLevels[] = {SimdLevel::Portable, SimdLevel::Avx2, SimdLevel::Avx512};

SimdLevel detectMaxSimdLevel() noexcept {
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

bool findLevel(char const *name, SimdLevel *level) noexcept {
    for (SimdLevel const known : kSimdLevels) {
        if (std::strcmp(name, GetSimdLevelName(known)) == 0) {
            *level = known;
            return true;
        }
    }
    return false;
}

// Without memory, since the first who asks may be a thread in a loop that throws nothing.
SimdLevel readInitialSimdLevel() noexcept {
    SimdLevel level = GetMaxSimdLevel();
    char const *const name = std::getenv("OPENSUBDIVHEX_SIMD");
    bool const isUsable = name && findLevel(name, &level) && level <= GetMaxSimdLevel();
    return isUsable ? level : GetMaxSimdLevel();
}

std::atomic<SimdLevel> &currentSimdLevel() noexcept {
    static std::atomic<SimdLevel> level(readInitialSimdLevel());
    return level;
}

} // namespace

SimdLevel GetMaxSimdLevel() noexcept {
    static SimdLevel const kLevel = detectMaxSimdLevel();
    return kLevel;
}

SimdLevel GetSimdLevel() noexcept { return currentSimdLevel(); }

bool SetSimdLevel(SimdLevel level) noexcept {
    if (level < SimdLevel::Portable || level > GetMaxSimdLevel()) {
        return false;
    }
    currentSimdLevel() = level;
    return true;
}

char const *GetSimdLevelName(SimdLevel level) {
    switch (level) {
    case SimdLevel::Avx512:
        return "avx512";
    case SimdLevel::Avx2:
        return "avx2";
    case SimdLevel::Portable:
        break;
    }
    return "portable";
}

bool FindSimdLevel(std::string const &name, SimdLevel *level) {
    return name.find('\0') == std::string::npos && findLevel(name.c_str(), level);
}

} // namespace OpenSubdivHex::OsdExt

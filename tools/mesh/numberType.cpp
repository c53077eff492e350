// SPDX-License-Identifier: Apache-2.0
#include "numberType.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>

namespace OpenSubdivHex::Tools {

namespace {

struct TypeTraits {
    char const *name;
    char const *alias;
    std::size_t size;
    double min, max; ///< of integers
};

template <typename T>
constexpr TypeTraits makeTraits(char const *name, char const *alias) {
    return {name, alias, sizeof(T), double(std::numeric_limits<T>::lowest()),
            double(std::numeric_limits<T>::max())};
}

/// In the order of NumberType.
constexpr TypeTraits kTypes[] = {
    makeTraits<std::int8_t>("char", "int8"),    makeTraits<std::uint8_t>("uchar", "uint8"),
    makeTraits<std::int16_t>("short", "int16"), makeTraits<std::uint16_t>("ushort", "uint16"),
    makeTraits<std::int32_t>("int", "int32"),   makeTraits<std::uint32_t>("uint", "uint32"),
    makeTraits<float>("float", "float32"),      makeTraits<double>("double", "float64")};

TypeTraits const &getTraits(NumberType type) { return kTypes[std::size_t(type)]; }

} // namespace

bool FindNumberType(std::string_view word, NumberType *type) {
    auto const found =
        std::find_if(std::begin(kTypes), std::end(kTypes), [word](TypeTraits const &traits) {
            return word == traits.name || word == traits.alias;
        });
    if (found == std::end(kTypes)) {
        return false;
    }
    *type = NumberType(found - std::begin(kTypes));
    return true;
}

char const *GetName(NumberType type) { return getTraits(type).name; }

std::size_t GetSize(NumberType type) { return getTraits(type).size; }

double GetMin(NumberType type) { return getTraits(type).min; }

double GetMax(NumberType type) { return getTraits(type).max; }

double RoundTo(NumberType type, double value) {
    return IsInteger(type) ? std::clamp(std::round(value), GetMin(type), GetMax(type)) : value;
}

} // namespace OpenSubdivHex::Tools

// SPDX-License-Identifier: Apache-2.0
//
// Floats as text: the same as std::to_chars makes of them.
#include "floatText.h"

#include <gtest/gtest.h>

#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>

namespace OpenSubdivHex::Tutorials {

namespace {

float makeFloat(std::uint32_t bits) {
    float value = 0;
    std::memcpy(&value, &bits, sizeof value);
    return value;
}

std::uint32_t getBits(float value) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    return bits;
}

void expectSameText(float value) {
    constexpr char kGuard = '?';
    char expected[2 * kMaxFloatText];
    std::string const text(expected, std::to_chars(expected, std::end(expected), value).ptr);
    char printed[kMaxFloatText + 1];
    printed[kMaxFloatText] = kGuard;
    char const *const end = PrintFloat(printed, value);
    ASSERT_EQ(std::string(printed, end - printed), text);
    ASSERT_EQ(printed[kMaxFloatText], kGuard) << text;
}

void expectSameTexts(float value) {
    for (float sign : {1.0F, -1.0F}) {
        float const infinity = std::numeric_limits<float>::infinity();
        expectSameText(sign * value);
        expectSameText(sign * std::nextafter(value, infinity));
        expectSameText(sign * std::nextafter(value, -infinity));
    }
}

} // namespace

TEST(FloatText, SpecialValues) {
    expectSameTexts(0);
    expectSameTexts(std::numeric_limits<float>::infinity());
    expectSameTexts(std::numeric_limits<float>::quiet_NaN());
    expectSameTexts(std::numeric_limits<float>::max());
    expectSameTexts(std::numeric_limits<float>::min());
}

TEST(FloatText, PowersAndTheirNeighbours) {
    for (int exponent = -149; exponent < 128; ++exponent) {
        expectSameTexts(std::ldexp(1.0F, exponent));
    }
    for (int exponent = -45; exponent < 39; ++exponent) {
        expectSameTexts(float(std::pow(10.0, exponent)));
    }
}

TEST(FloatText, ShortNumbers) {
    for (int i = 1; i < 100000; ++i) {
        for (float unit : {1e-4F, 1e-2F, 1.0F}) {
            expectSameTexts(float(i) * unit);
        }
        expectSameTexts(float(i) / 16384); // halves at many places
    }
}

// Of floats of any kind, and more of those that most coordinates are.
TEST(FloatText, ManyFloats) {
    for (std::uint64_t bits = 0; bits <= 0xffffffff; bits += 10007) {
        expectSameText(makeFloat(std::uint32_t(bits)));
    }
    for (std::uint32_t bits = getBits(0.0009F); bits < getBits(110000.0F); bits += 211) {
        expectSameText(makeFloat(bits));
    }
}

} // namespace OpenSubdivHex::Tutorials

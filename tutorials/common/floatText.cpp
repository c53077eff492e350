// SPDX-License-Identifier: Apache-2.0
#include "floatText.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace OpenSubdivHex::Tutorials {

namespace {

/// From here to there the shortest text is never one with an exponent.
constexpr float kMinFixed = 1e-3F;
constexpr float kMaxFixed = 1e5F;

/// So many digits tell any float from its neighbours.
constexpr int kNumDigits = 9;

constexpr double kPowersOf10[] = {1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11};
constexpr double kInversePowersOf10[] = {1e0, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8};

/// The number digits / 10^scale.
struct Decimal {
    std::int32_t digits; ///< kNumDigits, the first of them not 0
    int scale;
    int numZeros; ///< at the end of the digits
};

/// \brief Finds the shortest decimal that reads as \p value, kMinFixed to kMaxFixed, and of these
/// the nearest.
///
/// \return  false, rarely, where it takes another look at how halves are rounded
bool findShortest(float value, Decimal *result) {
    // No float below those nearest to the powers of 10 reads as one.
    int scale = kNumDigits + 2;
    for (float power : {1e-2F, 1e-1F, 1e0F, 1e1F, 1e2F, 1e3F, 1e4F}) {
        scale -= value >= power ? 1 : 0;
    }
    std::uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    bits &= 0xff800000;
    float lowerPowerOf2 = 0;
    std::memcpy(&lowerPowerOf2, &bits, sizeof bits);
    // Exact, as all that follows: 24 bits of a float times 26 bits of a power of 5.
    double const scaled = double(value) * kPowersOf10[scale];
    // A number nearer than half the way to the next float, 3 to 60 here, reads as this one.  That
    // half way is no integer; and the nearer float below a power of 2 makes no text longer here.
    double const tolerance = double(lowerPowerOf2) * 0x1p-24 * kPowersOf10[scale];

    auto const findNearest = [scaled](int numZeros) {
        return double(std::int32_t(scaled * kInversePowersOf10[numZeros] + 0.5)) *
               kPowersOf10[numZeros];
    };
    auto const isNear = [=](double number) { return std::abs(number - scaled) < tolerance; };
    // With more zeros the nearest number is farther away.  Up to two are as likely as not, so that
    // branches would be taken at random.
    int numZeros = int(isNear(findNearest(1))) + int(isNear(findNearest(2)));
    if (isNear(findNearest(3))) {
        numZeros = 3;
        while (numZeros + 1 < kNumDigits && isNear(findNearest(numZeros + 1))) {
            ++numZeros;
        }
    }
    double const nearest = findNearest(numZeros);
    *result = {std::int32_t(nearest), scale, numZeros};
    return 2 * std::abs(nearest - scaled) != kPowersOf10[numZeros];
}

constexpr std::array<char, 200> makePairs() {
    std::array<char, 200> pairs = {};
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        pairs[i] = char('0' + (i % 2 == 0 ? i / 20 : i / 2 % 10));
    }
    return pairs;
}
constexpr std::array<char, 200> kPairs = makePairs();

/// Prints kNumDigits digits.
void printDigits(char *out, std::uint32_t digits) {
    auto const printPair = [](char *place, std::uint32_t pair) {
        std::memcpy(place, &kPairs[2 * pair], 2);
    };
    std::uint32_t const high = digits / 10000;
    std::uint32_t const low = digits % 10000;
    out[0] = char('0' + high / 10000);
    printPair(out + 1, high % 10000 / 100);
    printPair(out + 3, high % 100);
    printPair(out + 5, low / 100);
    printPair(out + 7, low % 100);
}

} // namespace

char *PrintFloat(char *out, float value) {
    float const magnitude = std::abs(value);
    Decimal decimal{};
    if (!(magnitude >= kMinFixed && magnitude < kMaxFixed) || !findShortest(magnitude, &decimal)) {
        return std::to_chars(out, out + kMaxFloatText, value).ptr;
    }
    *out = '-'; // to stay, or to be printed over
    out += std::signbit(value) ? 1 : 0;
    if (decimal.scale >= kNumDigits) {
        std::memcpy(out, "0.00", 4);
        out += 2 + decimal.scale - kNumDigits;
        printDigits(out, std::uint32_t(decimal.digits));
        return out + kNumDigits - decimal.numZeros;
    }
    // The first digits are the whole part, the others follow the point, moved to the front.
    auto const unit = std::uint32_t(kPowersOf10[decimal.scale]);
    auto const unitFraction = std::uint32_t(kPowersOf10[kNumDigits - decimal.scale]);
    out = std::to_chars(out, out + kNumDigits, std::uint32_t(decimal.digits) / unit).ptr;
    *out = '.';
    printDigits(out + 1, std::uint32_t(decimal.digits) % unit * unitFraction);
    int const numFraction = decimal.scale - decimal.numZeros;
    return numFraction <= 0 ? out : out + 1 + numFraction;
}

} // namespace OpenSubdivHex::Tutorials

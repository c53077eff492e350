// SPDX-License-Identifier: Apache-2.0
#include "latticeWeights.h"

#include "limitKernel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

namespace OpenSubdivHex::OsdExt::internal {

using FarExt::internal::LatticeFaces;
using FarExt::internal::LatticeOrbits;
using FarExt::internal::LatticePatch;
using FarExt::internal::LimitWeights;

namespace {

using Complex = std::complex<double>;

// Whether the vertices of an orbit depend on an orbit of sources.
bool dependsOn(LatticePatch const &patch, LatticeFaces::Orbit const &of, int orbit) {
    constexpr double kNothing = 1e-12;
    int const size = patch.GetFaceSize();
    auto const first = of.weights.begin() + std::ptrdiff_t(orbit) * size;
    return std::any_of(first, first + size, [](LimitWeights const &weights) {
        return std::any_of(weights.begin(), weights.end(),
                           [](double weight) { return std::abs(weight) > kNothing; });
    });
}

// Whether any output depends on an orbit of sources.
bool isUsed(LatticeFaces::Set const &set, int orbit) {
    return std::any_of(set.orbits.begin(), set.orbits.end(), [&](LatticeFaces::Orbit const &of) {
        return dependsOn(set.patch, of, orbit);
    });
}

// Keeps some orbits, those that are used first, and says whether these are all that are.
template <typename IS_USED>
bool keepUsed(std::vector<int> &orbits, int count, IS_USED isOrbitUsed) {
    auto const numUsed =
        std::stable_partition(orbits.begin(), orbits.end(), isOrbitUsed) - orbits.begin();
    orbits.resize(std::size_t(count));
    return numUsed <= count;
}

std::vector<int> findHalves(LatticeFaces::Set const &set, Far::Index face) {
    Far::Index const *const outputs =
        set.outputs.data() + std::size_t(face) * std::size_t(set.numOutputs);
    int const faceSize = set.patch.GetFaceSize();
    Far::Index const standIn = set.GetStandIn(std::size_t(face));
    std::vector<int> halves;
    for (int pair = 0; pair < CountPairs(set); ++pair) {
        Far::Index const *const images = outputs + std::ptrdiff_t(2 * pair + 1) * faceSize;
        if (std::all_of(images, images + faceSize,
                        [&](Far::Index vert) { return vert == standIn; })) {
            halves.push_back(pair);
        }
    }
    return halves;
}

/// The rows of one output of an orbit, taken apart as LatticeSources are.
class RowWaves {
public:
    RowWaves(SourceOrbits const &sources, LatticePatch const &patch,
             LatticeFaces::Orbit const &orbit, std::size_t sum)
        : _sources(sources), _patch(patch), _orbit(orbit), _sum(sum) {}

    /// For the part that is the same in the mirror, the waves of a frequency of all orbits on axes and
    /// sums, then of all differences.
    std::vector<double> FindEven(int frequency) const {
        return find(frequency, [](Complex wave, Complex ofImage) {
            Complex const sum = wave + std::conj(ofImage);
            return std::array<double, 2>{sum.real() / 2, sum.imag() / 2};
        });
    }
    /// For the part that changes its sign.
    std::vector<double> FindOdd(int frequency) const {
        return find(frequency, [](Complex wave, Complex ofImage) {
            Complex const difference = wave - std::conj(ofImage);
            return std::array<double, 2>{-difference.imag() / 2, difference.real() / 2};
        });
    }

private:
    Complex findWave(int orbit, int frequency) const {
        int const faceSize = _patch.GetFaceSize();
        LimitWeights const *weights = _orbit.weights.data() + std::ptrdiff_t(orbit) * faceSize;
        Complex result = 0;
        for (int i = 0; i < faceSize; ++i, ++weights) {
            result += (*weights)[_sum] * _patch.Turn(1.0 / faceSize, frequency * i);
        }
        return result;
    }

    // combine(wave, ofImage) gives the weights of a sum and of a difference.
    template <typename COMBINE>
    std::vector<double> find(int frequency, COMBINE combine) const {
        std::vector<double> sums;
        std::vector<double> differences;
        for (int const orbit : _sources.axes) {
            Complex const wave = findWave(orbit, frequency);
            sums.push_back(combine(wave, wave)[0]);
        }
        for (int const orbit : _sources.pairs) {
            auto const weights =
                combine(findWave(orbit, frequency), findWave(orbit + 1, frequency));
            sums.push_back(weights[0]);
            differences.push_back(weights[1]);
        }
        sums.insert(sums.end(), differences.begin(), differences.end());
        return sums;
    }

    SourceOrbits const &_sources;
    LatticePatch const &_patch;
    LatticeFaces::Orbit const &_orbit;
    std::size_t _sum;
};

// Adds entries begin to end - 1 of some rows: of each entry those of all rows.
void addRows(std::vector<std::vector<double>> const &rows, int begin, int end, double factor,
             std::vector<float> &weights) {
    for (int i = begin; i < end; ++i) {
        for (std::vector<double> const &row : rows) {
            weights.push_back(float(factor * row[std::size_t(i)]));
        }
    }
}

} // namespace

SourceOrbits GetAllSourceOrbits(LatticePatch const &patch) {
    SourceOrbits all;
    for (int i = 0; i < patch.GetNumAxes(); ++i) {
        all.axes.push_back(i);
    }
    for (int i = 0; i < patch.GetNumPairs(); ++i) {
        all.pairs.push_back(patch.GetNumAxes() + 2 * i);
    }
    return all;
}

std::optional<SourceOrbits> FindCompactSourceOrbits(LatticeFaces::Set const &set) {
    using OfCompact = LatticeOrbits<3, true>; // others have as many
    SourceOrbits compact = GetAllSourceOrbits(set.patch);
    bool const areEnough = keepUsed(compact.axes, OfCompact::kNumAxes,
                                    [&](int orbit) { return isUsed(set, orbit); }) &&
                           keepUsed(compact.pairs, OfCompact::kNumPairs, [&](int orbit) {
                               return isUsed(set, orbit) || isUsed(set, orbit + 1);
                           });
    return areEnough ? std::optional<SourceOrbits>(compact) : std::nullopt;
}

int CountPairs(LatticeFaces::Set const &set) {
    return int(std::count_if(set.orbits.begin(), set.orbits.end(),
                             [](auto const &orbit) { return orbit.isPair; }));
}

std::map<std::vector<int>, std::vector<Far::Index>> GroupByHalves(LatticeFaces::Set const &set) {
    std::map<std::vector<int>, std::vector<Far::Index>> facesWithHalves;
    for (Far::Index face = 0; face < Far::Index(set.faces.size()); ++face) {
        facesWithHalves[findHalves(set, face)].push_back(face);
    }
    return facesWithHalves;
}

bool DependsOnThese(SourceOrbits const &sources, LatticePatch const &patch,
                    LatticeFaces::Orbit const &orbit) {
    int const numOrbits = patch.GetNumPlaces() / patch.GetFaceSize();
    std::vector<unsigned char> isSource(std::size_t(numOrbits), 0);
    for (int const axis : sources.axes) {
        isSource[std::size_t(axis)] = 1;
    }
    for (int const pair : sources.pairs) {
        isSource[std::size_t(pair)] = isSource[std::size_t(pair) + 1] = 1;
    }
    for (int i = 0; i < numOrbits; ++i) {
        if (!isSource[std::size_t(i)] && dependsOn(patch, orbit, i)) {
            return false;
        }
    }
    return true;
}

LatticeFaces::Orbit MakePair(LatticeFaces::Orbit const &orbit) {
    LatticeFaces::Orbit result = orbit;
    if (orbit.isPair) {
        return result;
    }
    auto const &[ofDu, ofDv] = orbit.derivatives;
    for (LimitWeights &weights : result.weights) {
        auto const [point, along, across] = weights;
        weights = {point, ofDu[0] * along + ofDu[1] * across, ofDv[0] * along + ofDv[1] * across};
    }
    result.isPair = true;
    return result;
}

void AddOrbitWeights(SourceOrbits const &sources, LatticePatch const &patch,
                     LatticeFaces::Orbit const &orbit, std::vector<float> &weights) {
    auto const numSums = int(sources.axes.size() + sources.pairs.size());
    int const size = numSums + int(sources.pairs.size());
    auto const addRowsOf = [&](int frequency, std::vector<std::vector<double>> &even,
                               std::vector<std::vector<double>> &odd) {
        for (int i = 0; i < LimitTask::kMaxOutputs; ++i) {
            RowWaves const row(sources, patch, orbit, std::size_t(i));
            bool const isAcross = !orbit.isPair && i == LimitTask::kMaxOutputs - 1;
            if (!isAcross) {
                even.push_back(row.FindEven(frequency));
            }
            if (orbit.isPair || isAcross) {
                odd.push_back(row.FindOdd(frequency));
            }
        }
    };
    // Frequencies of one wave: what is even there has sums alone, and what is odd differences.
    auto const addSingle = [&](int frequency) {
        std::vector<std::vector<double>> even;
        std::vector<std::vector<double>> odd;
        addRowsOf(frequency, even, odd);
        addRows(even, 0, numSums, 1, weights);
        addRows(odd, numSums, size, 1, weights);
    };
    addSingle(0);
    if (patch.GetFaceSize() % 2 == 0) {
        addSingle(patch.GetFaceSize() / 2);
    }
    // For other frequencies the conjugate, which has the same weights, is added, too.
    for (int frequency = 1; 2 * frequency < patch.GetFaceSize(); ++frequency) {
        std::vector<std::vector<double>> both;
        addRowsOf(frequency, both, both);
        addRows(both, 0, size, 2, weights);
    }
    for (auto const &ofDerivative : orbit.derivatives) {
        weights.insert(weights.end(), {float(ofDerivative[0]), float(ofDerivative[1])});
    }
}

} // namespace OpenSubdivHex::OsdExt::internal

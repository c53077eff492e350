// SPDX-License-Identifier: Apache-2.0
#include "latticeLimit.h"

#include "far_ext/vtr/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numeric>

namespace OpenSubdivHex::OsdExt::internal {

using Far::Index;
using FarExt::internal::Buffer;
using FarExt::internal::LatticeFaces;
using FarExt::internal::LatticeOrbits;
using FarExt::internal::LatticePatch;
using FarExt::internal::LimitWeights;

namespace {

using Complex = std::complex<double>;

/// The orbits of sources that are read, by their numbers; of a pair that of the first.
struct SourceOrbits {
    std::vector<int> axes;
    std::vector<int> pairs;
    bool isCompact = false;
};

// Whether any output depends on an orbit of sources.
bool isUsed(LatticeFaces::Set const &set, int orbit) {
    constexpr double kNothing = 1e-12;
    int const size = set.patch.GetFaceSize();
    return std::any_of(set.orbits.begin(), set.orbits.end(), [&](LatticeFaces::Orbit const &of) {
        auto const first = of.weights.begin() + std::ptrdiff_t(orbit) * size;
        return std::any_of(first, first + size, [](LimitWeights const &weights) {
            return std::any_of(weights.begin(), weights.end(),
                               [](double weight) { return std::abs(weight) > kNothing; });
        });
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

// Those of a compact patch if no others are used, else all.
SourceOrbits findSourceOrbits(LatticeFaces::Set const &set) {
    SourceOrbits all;
    for (int i = 0; i < set.patch.GetNumAxes(); ++i) {
        all.axes.push_back(i);
    }
    for (int i = 0; i < set.patch.GetNumPairs(); ++i) {
        all.pairs.push_back(set.patch.GetNumAxes() + 2 * i);
    }
    using OfCompact = LatticeOrbits<3, true>; // others have as many
    SourceOrbits compact = all;
    bool const areEnough = keepUsed(compact.axes, OfCompact::kNumAxes,
                                    [&](int orbit) { return isUsed(set, orbit); }) &&
                           keepUsed(compact.pairs, OfCompact::kNumPairs, [&](int orbit) {
                               return isUsed(set, orbit) || isUsed(set, orbit + 1);
                           });
    compact.isCompact = true;
    return areEnough ? compact : all;
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

// Weights in the order in which LatticeKernel reads them.
void addOrbit(SourceOrbits const &sources, LatticePatch const &patch,
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
    // Of the others the conjugate, which has the same weights, is added, too.
    for (int frequency = 1; 2 * frequency < patch.GetFaceSize(); ++frequency) {
        std::vector<std::vector<double>> both;
        addRowsOf(frequency, both, both);
        addRows(both, 0, size, 2, weights);
    }
    for (auto const &ofDerivative : orbit.derivatives) {
        weights.insert(weights.end(), {float(ofDerivative[0]), float(ofDerivative[1])});
    }
}

// Some of the entries of all faces, which have count each, as entries of groups of faces: of each entry
// those of all faces, the last of which fills the last group up.
template <typename T, typename CONVERT>
void group(Buffer<Index> const &entries, int count, std::vector<int> const &some, Buffer<T> &result,
           CONVERT convert) {
    constexpr std::size_t kSize = RegularFaceGroup::kSize;
    std::size_t const numFaces = entries.size() / std::size_t(count);
    std::size_t const numGroups = (numFaces + kSize - 1) / kSize;
    std::size_t const size = numGroups * kSize * some.size();
    result.Resize(size + LatticeTask::kNumAhead);
    std::fill_n(result.data() + size, LatticeTask::kNumAhead, T(0));
    FarExt::internal::ParallelFor(Index(numGroups), [&](Index i) {
        std::size_t const first = std::size_t(i) * kSize;
        T *next = result.data() + first * some.size();
        for (int const k : some) {
            for (std::size_t face = first; face < first + kSize; ++face) {
                *next++ = convert(
                    entries[std::min(face, numFaces - 1) * std::size_t(count) + std::size_t(k)]);
            }
        }
    });
}

} // namespace

void LatticeLimit::Prepare(LatticeFaces const &faces) {
    for (LatticeFaces::Set const &of : faces.GetSets()) {
        Set &set = _sets.emplace_back();
        set.faceSize = of.patch.GetFaceSize();
        set.numPairs = int(std::count_if(of.orbits.begin(), of.orbits.end(),
                                         [](auto const &orbit) { return orbit.isPair; }));
        set.numAxes = int(of.orbits.size()) - set.numPairs;
        constexpr Index kSize = RegularFaceGroup::kSize;
        set.numGroups = (Index(of.faces.size()) + kSize - 1) / kSize;
        SourceOrbits const sources = findSourceOrbits(of);
        set.isCompact = sources.isCompact;
        std::vector<int> places;
        auto const addPlaces = [&](int orbit) {
            for (int i = 0; i < set.faceSize; ++i) {
                places.push_back(orbit * set.faceSize + i);
            }
        };
        for (int const orbit : sources.axes) {
            addPlaces(orbit);
        }
        for (int const orbit : sources.pairs) {
            addPlaces(orbit);
            addPlaces(orbit + 1);
        }
        group(of.sources, of.patch.GetNumPlaces(), places, set.places, [](Index vert) {
            return std::uint32_t(vert) * std::uint32_t(RegularFaceGroup::kPointStride);
        });
        std::vector<int> outputs(std::size_t(of.numOutputs));
        std::iota(outputs.begin(), outputs.end(), 0);
        group(of.outputs, of.numOutputs, outputs, set.verts, [](Index vert) { return vert; });
        for (LatticeFaces::Orbit const &orbit : of.orbits) {
            addOrbit(sources, of.patch, orbit, set.weights);
        }
    }
}

void LatticeLimit::Evaluate(LimitTask const &common) const {
    for (Set const &set : _sets) {
        LatticeTask task;
        static_cast<LimitTask &>(task) = common;
        task.faceSize = set.faceSize;
        task.isCompact = set.isCompact;
        task.numPairs = set.numPairs;
        task.numAxes = set.numAxes;
        task.places = set.places.data();
        task.verts = set.verts.data();
        task.weights = set.weights.data();
        EvaluateLimit(task, set.numGroups);
    }
}

} // namespace OpenSubdivHex::OsdExt::internal

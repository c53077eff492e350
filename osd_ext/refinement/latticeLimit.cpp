// SPDX-License-Identifier: Apache-2.0
#include "latticeLimit.h"

#include "far_ext/vtr/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

namespace OpenSubdivHex::OsdExt::internal {

using Far::Index;
using FarExt::internal::Buffer;
using FarExt::internal::LatticeFaces;
using FarExt::internal::LatticePatch;

namespace {

constexpr double kPi = 3.14159265358979323846;

using Complex = std::complex<double>;

/// The rows of one output of an orbit, taken apart as LatticeSources are.
class RowWaves {
public:
    RowWaves(LatticePatch const &patch, LatticeFaces::Orbit const &orbit, std::size_t sum)
        : _patch(patch), _orbit(orbit), _sum(sum) {}

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
        int const size = _patch.GetFaceSize();
        FarExt::internal::LimitWeights const *weights =
            _orbit.weights.data() + std::ptrdiff_t(orbit) * size;
        Complex result = 0;
        for (int i = 0; i < size; ++i, ++weights) {
            result += (*weights)[_sum] * std::polar(1.0 / size, 2 * kPi * frequency * i / size);
        }
        return result;
    }

    // combine(wave, ofImage) gives the weights of a sum and of a difference.
    template <typename COMBINE>
    std::vector<double> find(int frequency, COMBINE combine) const {
        std::vector<double> sums;
        std::vector<double> differences;
        for (int i = 0; i < _patch.GetNumAxes(); ++i) {
            Complex const wave = findWave(i, frequency);
            sums.push_back(combine(wave, wave)[0]);
        }
        for (int i = 0; i < _patch.GetNumPairs(); ++i) {
            int const orbit = _patch.GetNumAxes() + 2 * i;
            auto const weights =
                combine(findWave(orbit, frequency), findWave(orbit + 1, frequency));
            sums.push_back(weights[0]);
            differences.push_back(weights[1]);
        }
        sums.insert(sums.end(), differences.begin(), differences.end());
        return sums;
    }

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
void addOrbit(LatticePatch const &patch, LatticeFaces::Orbit const &orbit,
              std::vector<float> &weights) {
    int const numSums = patch.GetNumAxes() + patch.GetNumPairs();
    int const size = numSums + patch.GetNumPairs();
    RowWaves const rows[] = {{patch, orbit, 0}, {patch, orbit, 1}, {patch, orbit, 2}};
    // Frequencies of one wave: what is even there has sums alone, and what is odd differences.
    auto const addSingle = [&](int frequency) {
        std::vector<std::vector<double>> even;
        std::vector<std::vector<double>> odd;
        for (int i = 0; i < LimitTask::kMaxOutputs; ++i) {
            bool const isAcross = !orbit.isPair && i == LimitTask::kMaxOutputs - 1;
            if (!isAcross) {
                even.push_back(rows[i].FindEven(frequency));
            }
            if (orbit.isPair || isAcross) {
                odd.push_back(rows[i].FindOdd(frequency));
            }
        }
        addRows(even, 0, numSums, 1, weights);
        addRows(odd, numSums, size, 1, weights);
    };
    addSingle(0);
    if (patch.GetFaceSize() % 2 == 0) {
        addSingle(patch.GetFaceSize() / 2);
    }
    std::vector<std::vector<double>> ofWaves;
    for (int i = 0; i < LimitTask::kMaxOutputs; ++i) {
        bool const isAcross = !orbit.isPair && i == LimitTask::kMaxOutputs - 1;
        if (!isAcross) {
            ofWaves.push_back(rows[i].FindEven(1));
        }
        if (orbit.isPair || isAcross) {
            ofWaves.push_back(rows[i].FindOdd(1));
        }
    }
    addRows(ofWaves, 0, size, 2, weights);
    for (auto const &ofDerivative : orbit.derivatives) {
        weights.insert(weights.end(), {float(ofDerivative[0]), float(ofDerivative[1])});
    }
}

// Entries of all faces, count for each, as entries of groups of faces: of each entry those of all
// faces, the last of which fills the last group up.
template <typename T, typename CONVERT>
void group(Buffer<Index> const &entries, int count, Buffer<T> &result, CONVERT convert) {
    constexpr std::size_t kSize = RegularFaceGroup::kSize;
    std::size_t const numFaces = entries.size() / std::size_t(count);
    std::size_t const numGroups = (numFaces + kSize - 1) / kSize;
    result.Resize(numGroups * kSize * std::size_t(count));
    FarExt::internal::ParallelFor(Index(numGroups), [&](Index i) {
        std::size_t const first = std::size_t(i) * kSize;
        T *next = result.data() + first * std::size_t(count);
        for (std::size_t k = 0; k < std::size_t(count); ++k) {
            for (std::size_t face = first; face < first + kSize; ++face) {
                *next++ = convert(entries[std::min(face, numFaces - 1) * std::size_t(count) + k]);
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
        group(of.sources, of.patch.GetNumPlaces(), set.places, [](Index vert) {
            return std::uint32_t(vert) * std::uint32_t(RegularFaceGroup::kPointStride);
        });
        group(of.outputs, of.numOutputs, set.verts, [](Index vert) { return vert; });
        for (LatticeFaces::Orbit const &orbit : of.orbits) {
            addOrbit(of.patch, orbit, set.weights);
        }
    }
}

void LatticeLimit::Evaluate(LimitTask const &common) const {
    for (Set const &set : _sets) {
        LatticeTask task;
        static_cast<LimitTask &>(task) = common;
        task.faceSize = set.faceSize;
        task.numPairs = set.numPairs;
        task.numAxes = set.numAxes;
        task.places = set.places.data();
        task.verts = set.verts.data();
        task.weights = set.weights.data();
        EvaluateLimit(task, set.numGroups);
    }
}

} // namespace OpenSubdivHex::OsdExt::internal

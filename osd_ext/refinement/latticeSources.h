// SPDX-License-Identifier: Apache-2.0
//
// Sources of the kernel of lattice faces: compiled once per SIMD level with the kernel, by the rules of
// limitKernelTemplate.h.
#ifndef OPENSUBDIVHEX_OSD_EXT_REFINEMENT_LATTICE_SOURCES_H
#define OPENSUBDIVHEX_OSD_EXT_REFINEMENT_LATTICE_SOURCES_H

#include "latticeWaves.h"

#include "far_ext/limit/latticePatch.h"

#include <cstdint>

namespace OpenSubdivHex::OsdExt::internal {
namespace {

/// \brief The waves of all sources of some faces, as the weights of LatticeWeights take them.
///
/// The two orbits of a pair become their sum, which is like an orbit on an axis, and their
/// difference, which changes its sign in the mirror: its waves are turned by a quarter, so that one
/// weight stands for cosine and sine.
template <class SIMD, int FACE_SIZE, bool IS_COMPACT>
struct LatticeSources {
    using T = typename SIMD::Vector;
    using Orbits = FarExt::internal::LatticeOrbits<FACE_SIZE, IS_COMPACT>;
    static constexpr int kNumSums = Orbits::kNumAxes + Orbits::kNumPairs;
    static constexpr int kNumDifferences = Orbits::kNumPairs;
    static constexpr int kSize = kNumSums + kNumDifferences;

    T mean[kSize];
    T cosine[kNumFrequencies<FACE_SIZE>][kSize];
    T sine[kNumFrequencies<FACE_SIZE>][kSize];
    T alternating[kSize];
};

/// Reads the sources of some faces.
template <class SIMD, class ACCESS, int FACE_SIZE>
struct LatticeLoader {
    using Vector = typename SIMD::Vector;

    /// Loads the values of an orbit.
    OPENSUBDIVHEX_INLINE void Load(int orbit, Vector (&x)[FACE_SIZE]) const {
        std::uint32_t const *place = places + orbit * FACE_SIZE * RegularFaceGroup::kSize;
        for (int corner = 0; corner < FACE_SIZE; ++corner, place += RegularFaceGroup::kSize) {
            float const *sources[SIMD::kNumFaces];
            for (int i = 0; i < SIMD::kNumFaces; ++i) {
                sources[i] = ACCESS::AtPlace(values, place[i]);
            }
            x[corner] = ACCESS::template Load<SIMD>(sources, length);
        }
    }

    Elements<float const> const &values;
    int length; ///< of the elements
    std::uint32_t const *places;
};

/// Adds the waves of orbits to LatticeSources.
template <class SIMD, int FACE_SIZE, bool IS_COMPACT>
struct LatticeSourceWriter {
    using Vector = typename SIMD::Vector;
    using Sources = LatticeSources<SIMD, FACE_SIZE, IS_COMPACT>;

    OPENSUBDIVHEX_INLINE void SetAxis(int axis, Vector const (&x)[FACE_SIZE]) {
        set(axis, findWaves<SIMD>(x));
    }
    OPENSUBDIVHEX_INLINE void SetPair(int pair, Vector const (&x)[FACE_SIZE],
                                      Vector const (&y)[FACE_SIZE]) {
        Vector sums[FACE_SIZE];
        Vector differences[FACE_SIZE];
        for (int corner = 0; corner < FACE_SIZE; ++corner) {
            sums[corner] = x[corner] + y[corner];
            differences[corner] = x[corner] - y[corner];
        }
        set(Sources::Orbits::kNumAxes + pair, findWaves<SIMD>(sums));
        LatticeWaves<SIMD, FACE_SIZE> waves = findWaves<SIMD>(differences);
        for (int k = 0; k < kNumFrequencies<FACE_SIZE>; ++k) {
            Vector const cosine = waves.cosine[k];
            waves.cosine[k] = SIMD::Spread(0) - waves.sine[k];
            waves.sine[k] = cosine;
        }
        set(Sources::kNumSums + pair, waves);
    }

    Sources &sources;

private:
    OPENSUBDIVHEX_INLINE void set(int i, LatticeWaves<SIMD, FACE_SIZE> const &waves) {
        sources.mean[i] = waves.mean;
        for (int k = 0; k < kNumFrequencies<FACE_SIZE>; ++k) {
            sources.cosine[k][i] = waves.cosine[k];
            sources.sine[k][i] = waves.sine[k];
        }
        if constexpr (FACE_SIZE % 2 == 0) {
            sources.alternating[i] = waves.alternating;
        }
    }
};

template <class SIMD, class ACCESS, int FACE_SIZE, bool IS_COMPACT>
OPENSUBDIVHEX_INLINE void loadSources(LatticeLoader<SIMD, ACCESS, FACE_SIZE> const &loader,
                                      LatticeSources<SIMD, FACE_SIZE, IS_COMPACT> &result) {
    using Vector = typename SIMD::Vector;
    using Orbits = typename LatticeSources<SIMD, FACE_SIZE, IS_COMPACT>::Orbits;
    LatticeSourceWriter<SIMD, FACE_SIZE, IS_COMPACT> writer{result};
    Vector x[FACE_SIZE];
    for (int i = 0; i < Orbits::kNumAxes; ++i) {
        loader.Load(i, x);
        writer.SetAxis(i, x);
    }
    for (int i = 0; i < Orbits::kNumPairs; ++i) {
        Vector y[FACE_SIZE];
        loader.Load(Orbits::kNumAxes + 2 * i, x);
        loader.Load(Orbits::kNumAxes + 2 * i + 1, y);
        writer.SetPair(i, x, y);
    }
}

} // namespace
} // namespace OpenSubdivHex::OsdExt::internal

#endif

// SPDX-License-Identifier: Apache-2.0
//
// What the kernel of lattice faces reads: compiled once per SIMD level with it, by the rules of
// limitKernelTemplate.h.
#ifndef OPENSUBDIVHEX_OSD_EXT_REFINEMENT_LATTICE_SOURCES_H
#define OPENSUBDIVHEX_OSD_EXT_REFINEMENT_LATTICE_SOURCES_H

#include "latticeWaves.h"

#include "far_ext/limit/latticePatch.h"

#include <cstdint>
#include <type_traits>

namespace OpenSubdivHex::OsdExt::internal {
namespace {

/// \brief The waves of all sources of some faces, as the weights of LatticeWeights take them.
///
/// Of the two orbits of a pair these are their sum, which is like an orbit on an axis, and their
/// difference, which changes its sign in the mirror: its waves are turned by a quarter, so that one
/// weight stands for cosine and sine.
template <class SIMD, int FACE_SIZE, LatticeSourceKind KIND>
struct LatticeSources {
    using T = typename SIMD::Vector;
    /// Those that are read, and what they become.
    using Read = FarExt::internal::LatticeOrbits<FACE_SIZE, KIND == LatticeSourceKind::Compact>;
    using Orbits = std::conditional_t<KIND == LatticeSourceKind::Joined,
                                      FarExt::internal::JoinedOrbits<FACE_SIZE>, Read>;
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

    /// Those of an orbit.
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
template <class SIMD, int FACE_SIZE, LatticeSourceKind KIND>
struct LatticeSourceWriter {
    using Vector = typename SIMD::Vector;
    using Sources = LatticeSources<SIMD, FACE_SIZE, KIND>;

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

/// Sources as they are.
template <class SIMD, class ACCESS, int FACE_SIZE, LatticeSourceKind KIND>
OPENSUBDIVHEX_INLINE void loadSources(LatticeLoader<SIMD, ACCESS, FACE_SIZE> const &loader,
                                      LatticeTask const &,
                                      LatticeSources<SIMD, FACE_SIZE, KIND> &result) {
    using Vector = typename SIMD::Vector;
    using Orbits = typename LatticeSources<SIMD, FACE_SIZE, KIND>::Orbits;
    LatticeSourceWriter<SIMD, FACE_SIZE, KIND> writer{result};
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

/// All sources, the outer ones joined as GetJoinedSourceOrbits() says: of triangles,
template <class SIMD, class ACCESS>
OPENSUBDIVHEX_INLINE void loadSources(LatticeLoader<SIMD, ACCESS, 3> const &loader,
                                      LatticeTask const &task,
                                      LatticeSources<SIMD, 3, LatticeSourceKind::Joined> &result) {
    using Vector = typename SIMD::Vector;
    LatticeSourceWriter<SIMD, 3, LatticeSourceKind::Joined> writer{result};
    Vector const weight = SIMD::Spread(task.outerWeights[0]);
    Vector const halfWeight = SIMD::Spread(task.outerWeights[0] / 2);
    Vector x[3];
    Vector y[3];
    Vector joined[3];
    // Orbits 5 and 6.
    loader.Load(5, x);
    loader.Load(6, y);
    for (int i = 0; i < 3; ++i) {
        joined[i] = x[(i + 1) % 3] + y[(i + 2) % 3];
    }
    writer.SetAxis(3, joined);
    for (int i = 0; i < 3; ++i) {
        joined[i] = (y[(i + 1) % 3] - x[i]) + (x[(i + 2) % 3] - y[i]);
    }
    // Orbits 2, 7 and 8.
    loader.Load(2, x);
    for (int i = 0; i < 3; ++i) {
        joined[i] = SIMD::MultiplyAdd(halfWeight, joined[i], x[i]);
    }
    loader.Load(7, x);
    loader.Load(8, y);
    for (int i = 0; i < 3; ++i) {
        addProduct<SIMD>(joined[i], weight, x[i] + y[i]);
    }
    writer.SetAxis(2, joined);
    loader.Load(0, x);
    writer.SetAxis(0, x);
    loader.Load(1, x);
    writer.SetAxis(1, x);
    loader.Load(3, x);
    loader.Load(4, y);
    writer.SetPair(0, x, y);
}
/// of quads,
template <class SIMD, class ACCESS>
OPENSUBDIVHEX_INLINE void loadSources(LatticeLoader<SIMD, ACCESS, 4> const &loader,
                                      LatticeTask const &task,
                                      LatticeSources<SIMD, 4, LatticeSourceKind::Joined> &result) {
    using Vector = typename SIMD::Vector;
    LatticeSourceWriter<SIMD, 4, LatticeSourceKind::Joined> writer{result};
    Vector const weight = SIMD::Spread(task.outerWeights[0]);
    Vector const ofOther = SIMD::Spread(task.outerWeights[1]);
    Vector x[4];
    Vector y[4];
    loader.Load(0, x);
    writer.SetAxis(0, x);
    loader.Load(1, x);
    writer.SetAxis(1, x);
    loader.Load(2, x);
    loader.Load(3, y);
    writer.SetPair(0, x, y);
    Vector outer[4];
    Vector ofMirror[4];
    loader.Load(4, x);
    loader.Load(5, y);
    loader.Load(6, outer);
    loader.Load(7, ofMirror);
    for (int i = 0; i < 4; ++i) {
        addProduct<SIMD>(x[i], weight, outer[i]);
        addProduct<SIMD>(x[i], ofOther, ofMirror[(i + 1) % 4]);
        addProduct<SIMD>(y[i], weight, ofMirror[i]);
        addProduct<SIMD>(y[i], ofOther, outer[(i + 3) % 4]);
    }
    writer.SetPair(1, x, y);
}
/// and of hexagons.
template <class SIMD, class ACCESS>
OPENSUBDIVHEX_INLINE void loadSources(LatticeLoader<SIMD, ACCESS, 6> const &loader,
                                      LatticeTask const &task,
                                      LatticeSources<SIMD, 6, LatticeSourceKind::Joined> &result) {
    using Vector = typename SIMD::Vector;
    LatticeSourceWriter<SIMD, 6, LatticeSourceKind::Joined> writer{result};
    Vector const weight = SIMD::Spread(task.outerWeights[0]);
    Vector x[6];
    Vector y[6];
    Vector joined[6];
    loader.Load(0, x);
    writer.SetAxis(0, x);
    loader.Load(1, x);
    writer.SetAxis(1, x);
    loader.Load(2, joined);
    loader.Load(5, x);
    loader.Load(6, y);
    for (int i = 0; i < 6; ++i) {
        addProduct<SIMD>(joined[i], weight, x[i] + y[i]);
    }
    writer.SetAxis(2, joined);
    loader.Load(3, x);
    loader.Load(4, y);
    writer.SetPair(0, x, y);
}

} // namespace
} // namespace OpenSubdivHex::OsdExt::internal

#endif

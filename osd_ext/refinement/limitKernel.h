// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_REFINEMENT_LIMIT_KERNEL_H
#define OPENSUBDIVHEX_OSD_EXT_REFINEMENT_LIMIT_KERNEL_H

#include "refinementKernel.h"

#include "far_ext/limit/regularFaces.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace OpenSubdivHex::OsdExt::internal {

/// Numbers one by one, as SIMD levels have vectors of them.
struct Scalar {
    using Vector = float;
};

/// Kinds of sources of a mask: vertices of the face, their neighbours, pairs.
constexpr int kNumRegularSources = 3;

/// For the waves of a symmetric mask; alternating pairs have no part.
template <class SIMD>
struct SymmetricWeights {
    using T = typename SIMD::Vector;
    T mean[kNumRegularSources];
    T cosine1[kNumRegularSources];
    T sine1[kNumRegularSources];
    T cosine2[kNumRegularSources];
    T sine2[kNumRegularSources];
    T alternating[kNumRegularSources - 1];
    T tip;
};

/// For the waves of a mask that changes its sign; only the pairs' alternating one has a part.
template <class SIMD>
struct AntisymmetricWeights {
    using T = typename SIMD::Vector;
    T cosineOfSine1[kNumRegularSources];
    T sineOfCosine1[kNumRegularSources];
    T cosineOfSine2[kNumRegularSources];
    T sineOfCosine2[kNumRegularSources];
    T alternatingOfPairs;
};

/// \brief A RegularFaceMask by the waves that FaceWaves tells of, with derivatives along and across the axis of each
/// corner, from which du and dv are turned.
template <class SIMD>
struct RegularLimitWeights {
    using T = typename SIMD::Vector;
    SymmetricWeights<SIMD> point;
    SymmetricWeights<SIMD> along;
    AntisymmetricWeights<SIMD> across;
    T duOfAcross;       ///< du = along + duOfAcross across
    T dvOfDu;           ///< dv = across + dvOfDu du
    T othersOfTip;      ///< of the point: the three others of the face beyond
    T othersOfTipAlong; ///< the same along the axis
    T tipAcross;        ///< "next" has it, and "previous" with the opposite sign
};

RegularLimitWeights<Scalar> MakeRegularLimitWeights(FarExt::internal::RegularFaceMask const &mask);

/// \brief Some regular faces, side by side: as many as the widest vectors hold, the last ones of a
/// level filled up by repeating one.
///
/// Instead of vertices there are their places in arrays of points, which have this stride: so that
/// evaluating points, as is mostly done, takes no products.
struct RegularFaceGroup {
    static constexpr int kSize = 4;
    static constexpr int kPointStride = 3;
    using Places = std::uint32_t[FarExt::internal::kRegularFaceSize][kSize];

    Places verts;
    Places neighbors; ///< these as in RegularFace
    Places next;
    Places previous;
    Places others[FarExt::internal::RegularFace::kNumOthers];
    Far::Index firstCorners[kSize];
};

std::vector<RegularFaceGroup>
MakeRegularFaceGroups(FarExt::internal::Level const &level,
                      std::vector<FarExt::internal::RegularFace> const &faces);

/// \brief Some vertices of one type, side by side; the last ones of a type filled up likewise.
struct VertexGroup {
    static constexpr int kSize = RegularFaceGroup::kSize;

    Far::Index verts[kSize];
    int numSources;
    std::size_t firstPlace;  ///< of the first source of all; those of the next follow
    std::size_t firstWeight; ///< of the first source: of the point, du and dv; then the next one's
};

/// \brief A task of the kernels: outputs at points, from some sources.
struct LimitTask {
    static constexpr int kMaxOutputs = FarExt::internal::RegularFaceMask::kNumSums;

    /// Goes on to the floats behind \p count.
    void Skip(int count) {
        length -= count;
        values.data += count;
        for (int i = 0; i < numOutputs; ++i) { // the others are null
            outputs[i].data += count;
        }
    }

    int length;
    Elements<float const> values; ///< of the level of the sources
    bool isReadBehind;            ///< whether one float may be read behind the last of the values
    Elements<float> outputs[kMaxOutputs]; ///< points, du, dv
    int numOutputs;                       ///< 1 or 3
};

/// \brief The limit that faces of a level give: outputs are by corner.
struct RegularLimitTask : LimitTask {
    RegularFaceGroup const *groups;
    RegularLimitWeights<Scalar> const *weights;
};

/// \brief The limit at vertices of a level.
struct VertexLimitTask : LimitTask {
    VertexGroup const *groups;
    std::uint32_t const *places; ///< as in RegularFaceGroup
    float const *weights;
};

/// \brief The limit in lattice faces of one size, RegularFaceGroup::kSize of them at a time: outputs are by
/// vertex.
struct LatticeTask : LimitTask {
    static constexpr int kNumDerivatives = 4; ///< weights of derivatives in terms of others

    /// Number of orbits of outputs.
    int GetNumOrbits() const { return 2 * numPairs + numHalves + numAxes; }

    int faceSize;
    bool isCompact; ///< whether the nearest sources alone have weights
    int numPairs;   ///< orbits of outputs, these first
    int numHalves;  ///< pairs without their mirror images
    int numAxes;
    std::uint32_t const
        *places; ///< by group, those of all sources of its faces, as in RegularFaceGroup
    Far::Index const *verts; ///< by group, those of all outputs
    /// By pair, half and axis, whether vertices of a face follow one another: of pairs, behind each mirror
    /// image that of the corner before; of others, all.
    unsigned char const *areConsecutive;
    /// By group, vertices in whose cache lines all outputs are.  Memory is asked for some groups before it is
    /// written, since the order of orbits is far from its own: with outputs that are in no cache
    /// benchmark limit, length 3, is 1.3 to 1.8 times as fast.
    Far::Index const *ahead;
    Far::Index const
        *firstAhead;      ///< of each group, and of numGroupsAhead + 1 behind the last: none
    int numGroupsAhead;   ///< from that which is made to that for which memory is asked
    float const *weights; ///< those of LatticeLimit
};

/// \brief The kernels of one SimdLevel; all are instances of limitKernelTemplate.h.
struct LimitKernel {
    /// Writes the outputs of groups [begin, end).
    void (*evaluateFaces)(RegularLimitTask const &task, Far::Index begin, Far::Index end);
    /// Evaluates vertices [begin, end).
    void (*evaluateVertices)(VertexLimitTask const &task, Far::Index begin, Far::Index end);
    /// Evaluates lattice faces [begin, end).
    void (*evaluateLattice)(LatticeTask const &task, Far::Index begin, Far::Index end);
};

extern LimitKernel const kLimitKernelPortable;
extern LimitKernel const kLimitKernelAvx2;
extern LimitKernel const kLimitKernelAvx512;

/// @name All faces or groups, in parallel, with the kernel of the SimdLevel in use
/// @{
void EvaluateLimit(RegularLimitTask const &task, Far::Index numGroups);
void EvaluateLimit(VertexLimitTask const &task, Far::Index numGroups);
void EvaluateLimit(LatticeTask const &task, Far::Index numGroups);
/// @}

} // namespace OpenSubdivHex::OsdExt::internal

#endif

// SPDX-License-Identifier: Apache-2.0
//
// Hexagons of which some have dense rules.  It is compiled once per SIMD level, by the rules of
// limitKernelTemplate.h; products are rounded at all levels, so that results are the same.
#ifndef OPENSUBDIVHEX_OSD_EXT_REFINEMENT_DENSE_FACE_KERNEL_TEMPLATE_H
#define OPENSUBDIVHEX_OSD_EXT_REFINEMENT_DENSE_FACE_KERNEL_TEMPLATE_H

#include "denseFaceKernel.h"
#include "plainFaceKernel.h"

#include <algorithm>
#include <cstddef>

namespace OpenSubdivHex::OsdExt::internal {
namespace {

/// \brief The portable SIMD level, whose vectors hold a quad of one row.
///
/// The types of other SIMD levels hold quads of some rows, which are summed up side by side; they have the same
/// functions, for COUNT rows, kNumRows at most.
struct OneRow {
    static constexpr int kNumRows = 1;

    /// The weights of a mask, as they are used for all faces of a run.
    struct Mask {
        explicit Mask(DenseFaceMask const &mask) : weights(mask.weights) {}
        template <int FIRST, int COUNT>
        OPENSUBDIVHEX_INLINE Quad Get(int vert) const {
            return weights[vert][FIRST];
        }

        Quad const (*weights)[DenseFaceMask::kRowStride];
    };
    template <int COUNT>
    static OPENSUBDIVHEX_INLINE Quad Spread(Quad const &quad) {
        return quad;
    }
    template <int COUNT>
    static OPENSUBDIVHEX_INLINE void Store(Quad *quads, Quad const &vector) {
        *quads = vector;
    }
};

// The sums of the rows from FIRST on, in the order of the vertices, as those of weighted faces.
template <class ROWS, int FIRST = 0>
OPENSUBDIVHEX_INLINE void sumDenseRows(typename ROWS::Mask const &mask, Quad const *v,
                                       Quad *points) {
    constexpr int kRest = DenseFaceMask::kSize - FIRST;
    if constexpr (kRest > 0) {
        constexpr int kCount = kRest < ROWS::kNumRows ? kRest : ROWS::kNumRows;
        auto const weigh = [&](int vert) {
            return mask.template Get<FIRST, kCount>(vert) * ROWS::template Spread<kCount>(v[vert]);
        };
        auto sum = weigh(0);
        for (int vert = 1; vert < DenseFaceMask::kSize; ++vert) {
            sum = sum + weigh(vert);
        }
        ROWS::template Store<kCount>(points + FIRST, sum);
        sumDenseRows<ROWS, FIRST + kCount>(mask, v, points);
    }
}
template <class ROWS>
OPENSUBDIVHEX_INLINE void sumDenseRows(typename ROWS::Mask const &mask, QuadPair const *v,
                                       QuadPair *points) {
    constexpr int kSize = DenseFaceMask::kSize;
    constexpr Quad QuadPair::*kHalves[] = {&QuadPair::first, &QuadPair::second};
    for (Quad QuadPair::*const half : kHalves) {
        Quad halves[kSize];
        Quad sums[kSize];
        for (int i = 0; i < kSize; ++i) {
            halves[i] = v[i].*half;
        }
        sumDenseRows<ROWS>(mask, halves, sums);
        for (int i = 0; i < kSize; ++i) {
            points[i].*half = sums[i];
        }
    }
}

template <class ACCESS, class ROWS>
OPENSUBDIVHEX_INLINE void
refineDenseFace(typename ROWS::Mask const &mask, Elements<float const> const &src,
                Elements<float> const &dst, Far::Index const *verts, std::ptrdiff_t corner) {
    constexpr int kSize = DenseFaceMask::kSize;
    using Value = decltype(ACCESS::Load(src, 0));
    Value v[kSize];
    for (int i = 0; i < kSize; ++i) {
        v[i] = ACCESS::Load(src, verts[i]);
    }
    Value points[kSize];
    sumDenseRows<ROWS>(mask, v, points);
    for (int i = 0; i + 1 < kSize; ++i) {
        ACCESS::Store(dst, corner + i, points[i]);
    }
    ACCESS::StoreExactly(dst, corner + kSize - 1, points[kSize - 1]);
}

// Runs are mostly short: what a run takes is kept small.
template <class ACCESS, class ROWS, bool HAS_OPPOSITE>
void refineDenseFaces(DenseFaceTask const &task) {
    constexpr int kSize = DenseFaceMask::kSize;
    PlainFaceQuads const plain(*task.plainMask);
    Elements<float const> const src = task.src;
    // The next face reads and writes there.
    Elements<float> dst = {ACCESS::At(task.dst, task.firstCorner), task.dst.stride};
    Far::Index const *verts = task.verts + task.firstCorner;
    Far::Index const *const firstVerts = verts;
    auto const getVerts = [&](Far::Index face) {
        return firstVerts + std::ptrdiff_t(face - task.begin) * kSize;
    };
    Far::Index const *const endVerts = getVerts(task.end);
    DenseFaceMask const *const masks = task.masks;
    for (auto const *run = task.runs; verts < endVerts; ++run) {
        Far::Index const *const behind = getVerts(std::min(run[1].begin, task.end));
        if (run->rule == FarExt::internal::RefinementRules::kCirculant) {
            std::ptrdiff_t const count = behind - verts;
            refineUnrolledFaces<ACCESS, kSize, HAS_OPPOSITE>(plain, src, verts, dst, 0, count);
            verts = behind;
            dst.data = ACCESS::At(dst, count);
            continue;
        }
        typename ROWS::Mask const mask(masks[run->rule]);
        do {
            refineDenseFace<ACCESS, ROWS>(mask, src, dst, verts, 0);
            verts += kSize;
            dst.data = ACCESS::At(dst, kSize);
        } while (verts < behind);
    }
}

template <class ACCESS, class ROWS>
void refineFaces(DenseFaceTask const &task) {
    if (task.plainMask->opposite != 0) {
        refineDenseFaces<ACCESS, ROWS, true>(task);
    } else {
        refineDenseFaces<ACCESS, ROWS, false>(task);
    }
}

template <class ROWS>
constexpr DenseFaceKernels kKernelsOfRows = {
    {refineFaces<Access<1, true>, ROWS>, refineFaces<Access<2, true>, ROWS>,
     refineFaces<Access<3, true>, ROWS>, refineFaces<Access<4, true>, ROWS>},
    {refineFaces<Access<1, false>, ROWS>, refineFaces<Access<2, false>, ROWS>,
     refineFaces<Access<3, false>, ROWS>, refineFaces<Access<4, false>, ROWS>,
     refineFaces<Access<5, false>, ROWS>, refineFaces<Access<6, false>, ROWS>,
     refineFaces<Access<7, false>, ROWS>, refineFaces<Access<8, false>, ROWS>}};

} // namespace
} // namespace OpenSubdivHex::OsdExt::internal

#endif

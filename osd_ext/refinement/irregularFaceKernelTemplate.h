// SPDX-License-Identifier: Apache-2.0
//
// Hexagons of which some are irregular.  It is compiled once per SIMD level, by the rules of
// limitKernelTemplate.h; products are rounded at all levels, so that results are the same.
#ifndef OPENSUBDIVHEX_OSD_EXT_REFINEMENT_IRREGULAR_FACE_KERNEL_TEMPLATE_H
#define OPENSUBDIVHEX_OSD_EXT_REFINEMENT_IRREGULAR_FACE_KERNEL_TEMPLATE_H

#include "irregularFaceKernel.h"
#include "plainFaceKernel.h"

#include <cstddef>
#include <utility>

namespace OpenSubdivHex::OsdExt::internal {
namespace {

/// \brief The portable SIMD level, whose vectors hold a quad of one row.
///
/// Those of other levels hold quads of some rows, which are summed up side by side; they have the same
/// functions, for COUNT rows, kNumRows at most.
struct OneRow {
    static constexpr int kNumRows = 1;

    template <int COUNT>
    static OPENSUBDIVHEX_INLINE Quad Load(Quad const *quads) {
        return *quads;
    }
    template <int COUNT>
    static OPENSUBDIVHEX_INLINE Quad Spread(Quad const &quad) {
        return quad;
    }
    template <int COUNT>
    static OPENSUBDIVHEX_INLINE void Store(Quad *quads, Quad const &vector) {
        *quads = vector;
    }
};

// Rows one by one skip the vertices that weigh nothing in a pattern.  Rows side by side take all: so there
// are kernels for fewer patterns, and most faces have that of the face before.
template <class ROWS>
constexpr bool kSkipsVertices = ROWS::kNumRows == 1;

template <class ROWS>
OPENSUBDIVHEX_INLINE int getPattern(IrregularFaceMask const &mask) {
    return kSkipsVertices<ROWS> ? mask.pattern : mask.rowPattern;
}
template <class ROWS, int PATTERN>
constexpr int kKernelPattern = kSkipsVertices<ROWS> ? PATTERN
                                                    : IrregularFaceMask::FindRowPattern(PATTERN);

template <class ROWS, int PATTERN>
constexpr bool hasWeight(int row, int vert) {
    return !kSkipsVertices<ROWS> ||
           IrregularFaceMask::HasWeight(PATTERN, IrregularFaceMask::FindCornerOfRow(PATTERN, row),
                                        vert);
}
template <class ROWS, int PATTERN>
constexpr int findFirstVertex(int row) {
    int vert = 0;
    while (!hasWeight<ROWS, PATTERN>(row, vert)) {
        ++vert;
    }
    return vert;
}

// The sums of rows [FIRST, FIRST + COUNT) of those with weights of their own, in the order of the vertices,
// as those of weighted faces.
template <class ROWS, int PATTERN, int FIRST, int COUNT, int... VERT>
OPENSUBDIVHEX_INLINE void sumRows(IrregularFaceMask const &mask, Quad const *v, Quad *points,
                                  std::integer_sequence<int, VERT...>) {
    constexpr int kFirstVertex = findFirstVertex<ROWS, PATTERN>(FIRST);
    auto const weigh = [&](int vert) {
        return ROWS::template Load<COUNT>(mask.weights[vert] + FIRST) *
               ROWS::template Spread<COUNT>(v[vert]);
    };
    auto sum = weigh(kFirstVertex);
    (
        [&] {
            if constexpr (VERT > kFirstVertex && hasWeight<ROWS, PATTERN>(FIRST, VERT)) {
                sum = sum + weigh(VERT);
            }
        }(),
        ...);
    ROWS::template Store<COUNT>(points + FIRST, sum);
}

// Those of all rows with weights of their own from row FIRST on, one behind the other.
template <class ROWS, int PATTERN, int FIRST = 0>
OPENSUBDIVHEX_INLINE void sumWeightedRows(IrregularFaceMask const &mask, Quad const *v,
                                          Quad *points) {
    constexpr int kRest = IrregularFaceMask::CountRows(PATTERN) - FIRST;
    if constexpr (kRest > 0) {
        constexpr int kCount = kRest < ROWS::kNumRows ? kRest : ROWS::kNumRows;
        sumRows<ROWS, PATTERN, FIRST, kCount>(
            mask, v, points, std::make_integer_sequence<int, IrregularFaceMask::kSize>());
        sumWeightedRows<ROWS, PATTERN, FIRST + kCount>(mask, v, points);
    }
}
template <class ROWS, int PATTERN>
OPENSUBDIVHEX_INLINE void sumWeightedRows(IrregularFaceMask const &mask, QuadPair const *v,
                                          QuadPair *points) {
    constexpr int kSize = IrregularFaceMask::kSize;
    constexpr int kNumRows = IrregularFaceMask::CountRows(PATTERN);
    constexpr Quad QuadPair::*kHalves[] = {&QuadPair::first, &QuadPair::second};
    for (Quad QuadPair::*const half : kHalves) {
        Quad halves[kSize];
        Quad sums[kSize];
        for (int i = 0; i < kSize; ++i) {
            halves[i] = v[i].*half;
        }
        sumWeightedRows<ROWS, PATTERN>(mask, halves, sums);
        for (int i = 0; i < kNumRows; ++i) {
            points[i].*half = sums[i];
        }
    }
}

template <class ACCESS, class ROWS, int PATTERN>
OPENSUBDIVHEX_INLINE void
refineIrregularFace(IrregularFaceMask const &mask, PlainFaceQuads const &plain,
                    Elements<float const> const &src, Elements<float> const &dst,
                    Far::Index const *verts, std::ptrdiff_t corner) {
    constexpr int kSize = IrregularFaceMask::kSize;
    using Value = decltype(ACCESS::Load(src, 0));
    Value v[kSize];
    for (int i = 0; i < kSize; ++i) {
        v[i] = ACCESS::Load(src, verts[i]);
    }
    Value const all = sumAll<kSize>(plain, v);
    Value weighted[kSize];
    sumWeightedRows<ROWS, PATTERN>(mask, v, weighted);
    Value const *next = weighted;
    for (int i = 0; i < kSize; ++i) {
        bool const isPlain = IrregularFaceMask::kPatterns[PATTERN][i] == IrregularFaceMask::kPlain;
        Value const point = isPlain ? sumPlainRow<kSize, false>(plain, all, v, i) : *next++;
        if (i + 1 < kSize) {
            ACCESS::Store(dst, corner + i, point);
        } else {
            ACCESS::StoreExactly(dst, corner + i, point);
        }
    }
}

// What is left of the faces when all before an irregular one are done.
struct RestOfFaces {
    Far::Index corner;
    IrregularRun const *irregular;
};

// Irregular faces of one pattern, with the plain ones between them and behind, until there is another
// pattern, or the end.  At irregular vertices types change from face to face, or a face stands alone: going
// on to the next run takes a fifth of the instructions of a face, and going on in a run no branch.
template <class ACCESS, class ROWS, int PATTERN>
RestOfFaces refinePattern(IrregularFaceTask const &task, PlainFaceQuads const plain,
                          RestOfFaces rest) {
    constexpr int kSize = IrregularFaceMask::kSize;
    Elements<float const> const src = task.src;
    Elements<float> const dst = task.dst;
    Far::Index const *const verts = task.verts;
    IrregularFaceMask const *const masks = task.masks;
    int const *const types = task.types;
    Far::Index const end = task.end;
    do {
        IrregularRun const &run = *rest.irregular;
        int const *type = types + run.firstType + (rest.corner - run.begin) / kSize;
        std::ptrdiff_t const runEnd = run.end < end ? run.end : end;
        for (std::ptrdiff_t corner = rest.corner; corner != runEnd; corner += kSize) {
            prefetchAhead(verts + corner);
            prefetchAhead(ACCESS::At(dst, corner));
            refineIrregularFace<ACCESS, ROWS, PATTERN>(masks[*type++], plain, src, dst,
                                                       verts + corner, corner);
        }
        ++rest.irregular;
        rest.corner = rest.irregular->begin < end ? rest.irregular->begin : end;
        refineUnrolledFaces<ACCESS, kSize, false>(plain, src, verts, dst, runEnd, rest.corner);
    } while (rest.corner != end &&
             getPattern<ROWS>(masks[types[rest.irregular->firstType]]) == PATTERN);
    return rest;
}

// refinePattern by pattern.  Behind pointers the compiler keeps the patterns apart: together with them
// plain faces take a tenth longer.
template <class ACCESS, class ROWS, int... PATTERN>
auto getPatternKernel(int pattern, std::integer_sequence<int, PATTERN...>) {
    using Kernel = RestOfFaces (*)(IrregularFaceTask const &, PlainFaceQuads, RestOfFaces);
    static constexpr Kernel kKernels[] = {
        refinePattern<ACCESS, ROWS, kKernelPattern<ROWS, PATTERN>>...};
    return kKernels[pattern];
}

template <class ACCESS, class ROWS>
void refineFaces(IrregularFaceTask const &task) {
    PlainFaceQuads const plain(*task.plainMask);
    RestOfFaces rest = {task.irregular->begin, task.irregular};
    if (rest.corner < task.begin) {
        rest.corner = task.begin;
    } else if (rest.corner > task.end) {
        rest.corner = task.end;
    }
    refineUnrolledFaces<ACCESS, IrregularFaceMask::kSize, false>(plain, task.src, task.verts,
                                                                 task.dst, task.begin, rest.corner);
    while (rest.corner != task.end) {
        auto const refine = getPatternKernel<ACCESS, ROWS>(
            getPattern<ROWS>(task.masks[task.types[rest.irregular->firstType]]),
            std::make_integer_sequence<int, IrregularFaceMask::kNumPatterns>());
        rest = refine(task, plain, rest);
    }
}

template <class ROWS>
constexpr IrregularFaceKernels kKernelsOfRows = {
    {refineFaces<Access<1, true>, ROWS>, refineFaces<Access<2, true>, ROWS>,
     refineFaces<Access<3, true>, ROWS>, refineFaces<Access<4, true>, ROWS>},
    {refineFaces<Access<1, false>, ROWS>, refineFaces<Access<2, false>, ROWS>,
     refineFaces<Access<3, false>, ROWS>, refineFaces<Access<4, false>, ROWS>,
     refineFaces<Access<5, false>, ROWS>, refineFaces<Access<6, false>, ROWS>,
     refineFaces<Access<7, false>, ROWS>, refineFaces<Access<8, false>, ROWS>}};

} // namespace
} // namespace OpenSubdivHex::OsdExt::internal

#endif

// SPDX-License-Identifier: Apache-2.0
//
// Plain faces of 3 to 6 sides: compiled once per SIMD level with the kernels of irregular faces, and by the
// rules of limitKernelTemplate.h.
#ifndef OPENSUBDIVHEX_OSD_EXT_REFINEMENT_PLAIN_FACE_KERNEL_H
#define OPENSUBDIVHEX_OSD_EXT_REFINEMENT_PLAIN_FACE_KERNEL_H

#include "elementAccess.h"

#include <cstddef>
#include <cstdint>

namespace OpenSubdivHex::OsdExt::internal {
namespace {

// The weights of a plain face, in registers.
struct PlainFaceQuads {
    explicit PlainFaceQuads(PlainFaceMask const &mask)
        : self(Spread(mask.self)), neighbor(Spread(mask.neighbor)), opposite(Spread(mask.opposite)),
          all(Spread(mask.all)) {}

    Quad self;
    Quad neighbor;
    Quad opposite;
    Quad all;
};

// The F-vertex of corner i of a plain face with points v.
template <int SIZE, bool HAS_OPPOSITE, class VALUE>
OPENSUBDIVHEX_INLINE VALUE sumPlainRow(PlainFaceQuads const &mask, VALUE const &all, VALUE const *v,
                                       int i) {
    VALUE point = all + mask.self * v[i];
    if (SIZE > PlainFaceMask::kMinSize) {
        point = point + mask.neighbor * (v[(i + SIZE - 1) % SIZE] + v[(i + 1) % SIZE]);
    }
    if (HAS_OPPOSITE) {
        point = point + mask.opposite * v[(i + SIZE / 2) % SIZE];
    }
    return point;
}

// The part that all corners of a plain face share.
template <int SIZE, class VALUE>
OPENSUBDIVHEX_INLINE VALUE sumAll(PlainFaceQuads const &mask, VALUE const *v) {
    VALUE sum = v[0] + v[1];
    for (int i = 2; i < SIZE; ++i) {
        sum = sum + v[i];
    }
    return mask.all * sum;
}

template <class ACCESS, int SIZE, bool HAS_OPPOSITE, class VERTICES>
OPENSUBDIVHEX_INLINE void refineUnrolledFace(PlainFaceQuads const &mask,
                                             Elements<float const> const &src, VERTICES verts,
                                             Elements<float> const &dst, std::ptrdiff_t corner) {
    decltype(ACCESS::Load(src, 0)) v[SIZE];
    for (int i = 0; i < SIZE; ++i) {
        v[i] = ACCESS::Load(src, verts[i]);
    }
    auto const all = sumAll<SIZE>(mask, v);
    for (int i = 0; i < SIZE; ++i) {
        auto const point = sumPlainRow<SIZE, HAS_OPPOSITE>(mask, all, v, i);
        if (i + 1 < SIZE) {
            ACCESS::Store(dst, corner + i, point);
        } else {
            ACCESS::StoreExactly(dst, corner + i, point);
        }
    }
}

// Faces of which verts has the vertices by corner, from corner begin to end - 1.
template <class ACCESS, int SIZE, bool HAS_OPPOSITE>
OPENSUBDIVHEX_INLINE void refineUnrolledFaces(PlainFaceQuads const &mask,
                                              Elements<float const> const &src,
                                              Far::Index const *verts, Elements<float> const &dst,
                                              std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t corner = begin; corner != end; corner += SIZE) {
        refineUnrolledFace<ACCESS, SIZE, HAS_OPPOSITE>(mask, src, verts + corner, dst, corner);
    }
}

} // namespace
} // namespace OpenSubdivHex::OsdExt::internal

#endif

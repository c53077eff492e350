// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_REFINEMENT_IRREGULAR_FACE_KERNEL_H
#define OPENSUBDIVHEX_OSD_EXT_REFINEMENT_IRREGULAR_FACE_KERNEL_H

#include "elementAccess.h"

#include <cstddef>
#include <type_traits>
#include <utility>

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

// The points of an irregular face, and the masks that its corners have.
template <class VALUE>
struct IrregularFace {
    IrregularFaceMask const &mask;
    PlainFaceQuads const &plain;
    VALUE const *v;
    VALUE all; ///< the plain part that all corners share
};

// How far vertex number vert of a hexagon is behind corner number corner.
constexpr int getPlace(int vert, int corner) {
    return (vert - corner + IrregularFaceMask::kSize) % IrregularFaceMask::kSize;
}

// The first vertex that a row with weights for places has one for.
constexpr int findFirstVertex(unsigned places, int corner) {
    int vert = 0;
    while ((places >> getPlace(vert, corner) & 1) == 0) {
        ++vert;
    }
    return vert;
}

// Adds the point of a vertex behind the first, if the row of corner I has a weight for it.
template <unsigned PLACES, int I, int VERT, class VALUE>
OPENSUBDIVHEX_INLINE void addVertex(IrregularFace<VALUE> const &face, VALUE &point) {
    constexpr int kPlace = getPlace(VERT, I);
    if constexpr (VERT > findFirstVertex(PLACES, I) && (PLACES >> kPlace & 1) != 0) {
        point = point + face.mask.rows[I][kPlace] * face.v[VERT];
    }
}

// The F-vertex of corner I, the row of which has weights for PLACES: a sum in the order of the
// vertices, as that of faces with weights of their own.
template <unsigned PLACES, int I, class VALUE>
OPENSUBDIVHEX_INLINE VALUE sumRow(IrregularFace<VALUE> const &face) {
    if constexpr (PLACES == IrregularFaceMask::kPlain) {
        return sumPlainRow<IrregularFaceMask::kSize, false>(face.plain, face.all, face.v, I);
    } else {
        constexpr int kFirst = findFirstVertex(PLACES, I);
        VALUE point = face.mask.rows[I][getPlace(kFirst, I)] * face.v[kFirst];
        addVertex<PLACES, I, 1>(face, point);
        addVertex<PLACES, I, 2>(face, point);
        addVertex<PLACES, I, 3>(face, point);
        addVertex<PLACES, I, 4>(face, point);
        addVertex<PLACES, I, 5>(face, point);
        return point;
    }
}

template <class ACCESS, int PATTERN, int... I>
OPENSUBDIVHEX_INLINE void
refineIrregularFace(IrregularFaceMask const &mask, PlainFaceQuads const &plain,
                    Elements<float const> const src, Elements<float> const dst,
                    Far::Index const *verts, std::ptrdiff_t corner,
                    std::integer_sequence<int, I...>) {
    decltype(ACCESS::Load(src, 0)) const v[] = {ACCESS::Load(src, verts[I])...};
    IrregularFace<std::remove_const_t<std::remove_reference_t<decltype(v[0])>>> const face = {
        mask, plain, v, plain.all * (v[0] + v[1] + v[2] + v[3] + v[4] + v[5])};
    auto const refine = [&](auto local) {
        if constexpr (local + 1 < int(sizeof...(I))) {
            ACCESS::Store(dst, corner + local,
                          sumRow<IrregularFaceMask::kPatterns[PATTERN][local], local>(face));
        } else {
            ACCESS::StoreExactly(dst, corner + local,
                                 sumRow<IrregularFaceMask::kPatterns[PATTERN][local], local>(face));
        }
    };
    (refine(std::integral_constant<int, I>()), ...);
}

} // namespace
} // namespace OpenSubdivHex::OsdExt::internal

#endif

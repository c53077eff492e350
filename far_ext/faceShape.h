// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_FACE_SHAPE_H
#define OPENSUBDIVHEX_FAR_EXT_FACE_SHAPE_H

namespace OpenSubdivHex::FarExt {

/// \brief What a face that has a surface looks like: a polygon, or half of one.
///
/// Hexagonal steps divide a polygon into *sectors*, one for each edge, the triangles of the edge with the centre.  The
/// centre of half a polygon is the middle of the *long edge*, its edge 0, along which the whole was cut: edge 0 has no
/// sector then.
struct FaceShape {
    /// Of \p numVertices vertices.
    constexpr FaceShape(int numVertices = 0, bool isHalfPolygon = false)
        : size(numVertices), isHalf(isHalfPolygon) {}

    /// The first edge that has a sector.
    constexpr int GetFirstSector() const { return isHalf ? 1 : 0; }
    /// The edges that have one.
    constexpr int GetNumSectors() const { return size - GetFirstSector(); }
    /// \brief The sector that begins at the line from the centre to a corner.
    ///
    /// At corner 0 of half a polygon none begins: it is the last one, which ends there.
    constexpr int GetSectorOfCorner(int corner) const {
        return isHalf && corner == 0 ? size - 1 : corner;
    }

    /// Whether two are the same.
    friend constexpr bool operator==(FaceShape const &a, FaceShape const &b) {
        return a.size == b.size && a.isHalf == b.isHalf;
    }
    /// Whether they are not.
    friend constexpr bool operator!=(FaceShape const &a, FaceShape const &b) { return !(a == b); }
    /// An order.
    friend constexpr bool operator<(FaceShape const &a, FaceShape const &b) {
        return a.size != b.size ? a.size < b.size : a.isHalf < b.isHalf;
    }

    int size;    ///< vertices
    bool isHalf; ///< half a polygon
};

} // namespace OpenSubdivHex::FarExt

#endif

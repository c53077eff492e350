// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_SECTORS_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_SECTORS_H

#include "far_ext/indexing.h"

namespace OpenSubdivHex::BfrExt::internal {

using FarExt::FaceShape;

/// \brief A place of a face: a sector, and coordinates there, what the start and the end of the sector's edge weigh beside
/// the centre.
///
/// The long edge of half a polygon, on which the centre lies, has no sector.  It runs through sector 1, where its end weighs
/// from -1, at corner 0, to 1, at corner 1; what is below zero lies on the side of the last sector, too.
template <typename COORDS>
struct SectorPlace {
    int sector;
    COORDS coords;
};

/// The place of an edge whose start and end weigh so much, or of one shrunk towards the centre.
template <typename COORDS, typename NUMBER>
SectorPlace<COORDS> PlaceOnEdge(FaceShape shape, int edge, NUMBER start, NUMBER end) {
    if (edge < shape.GetFirstSector()) {
        return {1, {end - start, 0}};
    }
    return {edge, {start, end}};
}

/// \brief The one name of a place that several sectors have, but for the centre.
///
/// On the line from the centre to a corner it is in the sector that begins there, GetSectorOfCorner().
template <typename COORDS>
SectorPlace<COORDS> NameOf(FaceShape shape, SectorPlace<COORDS> const &place) {
    auto const &[sector, coords] = place;
    if (coords[0] == 0 && !(shape.isHalf && sector + 1 == shape.size)) {
        return {(sector + 1) % shape.size, {coords[1], 0}};
    }
    if (coords[0] < 0) {
        return {shape.size - 1, {0, -coords[0]}};
    }
    return place;
}

/// Where a place lies on the border of a face.
template <typename NUMBER>
struct EdgePlace {
    int edge;   ///< -1 inside of the face
    NUMBER end; ///< what the end of the edge weighs
};

/// \brief The edge that a place, by its name, lies on; of a corner that which begins there.
///
/// \param one  what all weights sum to
template <typename COORDS, typename NUMBER>
EdgePlace<NUMBER> FindOnEdge(FaceShape shape, SectorPlace<COORDS> const &place, NUMBER one) {
    auto const &[sector, coords] = place;
    if (shape.isHalf && coords[0] == 0 && sector + 1 == shape.size) {
        return {0, (one - coords[1]) / 2};
    }
    if (coords[0] + coords[1] == one) {
        return {sector, coords[1]};
    }
    if (shape.isHalf && coords[1] == 0 && sector == 1) {
        return {0, (one + coords[0]) / 2};
    }
    return {-1, 0};
}

} // namespace OpenSubdivHex::BfrExt::internal

#endif

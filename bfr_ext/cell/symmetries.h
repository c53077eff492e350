// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_SYMMETRIES_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_SYMMETRIES_H

#include "cellStencil.h"

#include <array>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief Motions that map a base face and its patch onto themselves, and points and places onto each
/// other.
///
/// What all of them together make of something are its *images*: image number i is what symmetries 0
/// and 1 make of it as far as bits 0 and 1 of i say, so that image 0 is itself.
class Symmetries {
public:
    static constexpr std::size_t kMaxImages = 4;
    /// By image.
    using Images = std::array<int, kMaxImages>;

    /// What they are like, where the face has them.
    enum class Kind {
        Reflections, ///< that which exchanges u and 1 - u; with an even number of sides, that which
                     ///< exchanges what lies below and above the centre, too
        HalfTurn     ///< these two together, with an even number of sides
    };

    /// Those of a type of base faces all of whose patch's faces have the same size, as in a lattice.
    Symmetries(CellType const &type, Kind kind);

    /// 1, 2 or 4.
    std::size_t GetNumImages() const { return std::size_t(1) << _reflections.size(); }
    /// By point of the type, its images.
    std::vector<Images> const &GetPointImages() const { return _pointImages; }
    /// By place, its images among the places; -1 where there is none.
    std::vector<Images> FindPlaceImages(std::vector<BasePoint> const &places) const;

private:
    int const _faceSize;
    // By symmetry, which reflections it is made of: what a corner and its image add up to in each.
    std::vector<std::vector<int>> _reflections;
    std::vector<Images> _pointImages;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_BASE_FACE_MAP_H
#define OPENSUBDIVHEX_FAR_EXT_BASE_FACE_MAP_H

#include "topologyRefiner.h"

#include <cstddef>
#include <vector>

namespace OpenSubdivHex::FarExt {

/// \brief Maps the faces of all levels to their base faces.  For few faces TopologyLevel::GetFaceBaseFace answers without a
/// map, in a step for each level.
///
/// \code
///     FarExt::BaseFaceMap const map(*refiner);
///     int const material = materials[map.GetBaseFace(face)];
/// \endcode
///
/// One map of the last level serves all levels: an F-face has the index and the base faces of the face that made it.
///
/// Takes 4 bytes for each face of the last level, and 12 for each that two base faces share.  The map does not refer to the
/// refiner, and is out of date when the refiner refines again.
class OPENSUBDIVHEX_API BaseFaceMap {
public:
    /// A face.
    using Index = Far::Index;

    /// A hexagon with a half in each of two base faces.
    struct SplitFace {
        Index face;         ///< the hexagon
        Index baseFaces[2]; ///< of half 0 and half 1, as in kHexagonHalves
    };

    /// \brief Maps the faces of levels 0 ... \p maxLevel, at most refiner.GetMaxLevel().
    ///
    /// In parallel, with the same bits for any number of threads.  std::bad_alloc passes through.
    BaseFaceMap(TopologyRefiner const &refiner, int maxLevel);
    /// The base faces of all levels.
    explicit BaseFaceMap(TopologyRefiner const &refiner)
        : BaseFaceMap(refiner, refiner.GetMaxLevel()) {}
    /// The base faces of levels up to \p level.
    explicit BaseFaceMap(TopologyLevel const &level);

    /// Faces of the last level that is mapped.
    int GetNumFaces() const { return int(_baseFaces.size()); }

    /// As TopologyLevel::IsFaceBaseSplit.
    bool IsSplit(Index f) const { return _baseFaces[std::size_t(f)] < 0; }
    /// As TopologyLevel::GetFaceBaseFace.
    Index GetBaseFace(Index f, int half = 0) const {
        Index const entry = _baseFaces[std::size_t(f)];
        Index const split = ~entry;
        return entry >= 0 ? entry : _splitFaces[std::size_t(split)].baseFaces[half];
    }

    /// All split faces, ascending; those of coarser levels come first.
    std::vector<SplitFace> const &GetSplitFaces() const { return _splitFaces; }

private:
    void addLevel(internal::Refinement const &refinement);

    // By face: its base face, or ~i when it is _splitFaces[i].
    std::vector<Index> _baseFaces;
    std::vector<SplitFace> _splitFaces;
};

} // namespace OpenSubdivHex::FarExt

#endif

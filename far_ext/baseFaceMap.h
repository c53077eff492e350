// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_BASE_FACE_MAP_H
#define OPENSUBDIVHEX_FAR_EXT_BASE_FACE_MAP_H

#include "topologyRefiner.h"

#include <cstddef>
#include <vector>

namespace OpenSubdivHex::FarExt {

/// \brief The base faces of all faces of all levels, for those who ask for many:
/// TopologyLevel::GetFaceBaseFace answers without a map, but takes a step for each level.
///
/// An F-face has the index of the face that it was made of, and its base faces.  So one map of the
/// last level serves all levels: face f of any level that has it lies in the same base faces.
///
/// Takes 4 bytes for each face of the last level, and 12 for each that two base faces share.  Nothing
/// refers to the refiner afterwards; the map is out of date when that refines again.
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
    /// Those of all levels.
    explicit BaseFaceMap(TopologyRefiner const &refiner)
        : BaseFaceMap(refiner, refiner.GetMaxLevel()) {}
    /// Those up to \p level.
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

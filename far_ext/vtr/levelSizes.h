// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_LEVEL_SIZES_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_LEVEL_SIZES_H

#include "level.h"

#include "far_ext/hexSchemeOptions.h"

#include <string>

namespace OpenSubdivHex::FarExt::internal {

/// \brief The sizes of a level, in 64 bits.
struct LevelSizes {
    std::int64_t vertices;
    std::int64_t edges;
    std::int64_t faces;
    std::int64_t corners;
    std::int64_t freeBoundaries;
    std::int64_t sharpBoundariesA;
    std::int64_t sharpBoundariesB;
};

LevelSizes GetSizes(Level const &level);

/// The sizes of the level that the hexagonal refinement makes of a level of \p parent sizes.
LevelSizes GetHexagonalSizes(LevelSizes const &parent);

/// \brief Sizes that are known of a level before it is made, with what tells those of the next.
struct ExpectedSizes {
    explicit ExpectedSizes(Level const &level);
    /// Needed before other refinements than hexagonal ones.
    void CountFans(Level const &level);

    bool IsClosed() const { return interiorEdges == sizes.edges; }
    /// Goes on to the child.  Exact where the level is closed, and for Hexagonal and DooSabin;
    /// with borders TriHex may make fewer.  Truncate makes more where it cuts polygons.
    void Refine(StepType step);
    /// Lower bound for refinement by coplanar faces, whichever edges are flat.
    void RefineToLeast(bool closeGaps);

    LevelSizes sizes;
    std::int64_t interiorEdges = 0;
    std::int64_t closedVertices = 0; ///< with faces all around
    std::int64_t closedCorners = 0;  ///< of these faces
    std::int64_t digons = 0;         ///< closed vertices with two faces
};

/// \brief Checks the sizes of the levels of a refinement, and their sums, against 32 bits.
///
/// The first level that exceeds them is to end it, so that 64 bits suffice for the sums.
class SizeChecker {
public:
    /// \p place, such as " in face-varying channel 0", goes into messages behind the count.
    SizeChecker(LevelSizes const &baseSizes, std::string place)
        : _total(baseSizes), _place(std::move(place)) {}

    /// Adds the next level.  Returns TooLarge, with the level and the count, or Ok.
    CallStatus Add(LevelSizes const &sizes);

private:
    int _level = 0;
    LevelSizes _total;
    std::string _place;
};

} // namespace OpenSubdivHex::FarExt::internal

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_LEVEL_REFINER_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_LEVEL_REFINER_H

#include "hierarchy.h"
#include "levelSizes.h"
#include "polygonRefinement.h"

namespace OpenSubdivHex::FarExt::internal {

/// \brief Adds levels to a hierarchy, one after the other: of the mesh and, beside it, of all its
/// face-varying channels.
class LevelRefiner {
public:
    /// Begins behind level 0 of \p hierarchy, to which it refers.
    LevelRefiner(Hierarchy &hierarchy, TagOptions tagOptions);

    /// \brief Checks the sizes of the levels behind the last one, up to \p refinementLevel, as far
    /// as they are known before any is made: all, but for tri-hex refinements of a mesh with
    /// borders, truncations that cut polygons, and what follows them.
    CallStatus CheckSizes(HexSchemeOptions schemeOptions, Far::ConstIndexArray faceLabels,
                          int refinementLevel) const;
    /// CheckSizes() for refinement by coplanar faces: finds sizes that are too large whichever edges are
    /// flat.
    CallStatus CheckLeastSizes(bool closeGaps, int refinementLevel) const;

    /// \brief Makes the next level, by the hexagonal refinement where \p rules ask for no other
    /// polygons.
    ///
    /// \return  TooLarge, and no level was added, as where std::bad_alloc is thrown
    CallStatus AddLevel(PolygonRules const &rules, bool fullTopology);

private:
    CallStatus addHexagonalLevel(bool fullTopology);
    CallStatus addPolygonLevel(PolygonRules const &rules, bool fullTopology);
    CallStatus addTruncation(Far::ConstIndexArray faceLabels, bool fullTopology);
    template <class REFINER>
    CallStatus addLevels(std::deque<REFINER> &refiners, bool fullTopology);
    bool isSizeOpen(StepType step, bool hasLabels, ExpectedSizes const &sizes) const;
    void relateChannels();

    Hierarchy &_hierarchy;
    int _numLevels = 1; ///< behind which the next is added
    TagOptions const _tagOptions;
    std::vector<SizeChecker> _checkers; ///< of the mesh, then of each channel
};

} // namespace OpenSubdivHex::FarExt::internal

#endif

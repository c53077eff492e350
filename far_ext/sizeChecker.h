// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_SIZE_CHECKER_H
#define OPENSUBDIVHEX_FAR_EXT_SIZE_CHECKER_H

#include "topologyRefinement.h"

#include <string>

namespace OpenSubdivHex::FarExt::internal {

/// \brief Checks the sizes of the levels of a refinement, and their sums, against 32 bits.
///
/// The first level that exceeds them is to end it, so that 64 bits suffice for the sums.
class SizeChecker {
public:
    /// \p place, such as " in face-varying channel 0", goes into messages behind the count.
    SizeChecker(LevelSizes const &baseSizes, std::string place)
        : _total(baseSizes), _place(std::move(place)) {}

    /// Adds the next level.  Returns TooLarge, with the level and the count, or Ok.
    Status Add(LevelSizes const &sizes);

private:
    int _level = 0;
    LevelSizes _total;
    std::string _place;
};

} // namespace OpenSubdivHex::FarExt::internal

#endif

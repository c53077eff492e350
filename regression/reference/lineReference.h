// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_REFERENCE_LINE_REFERENCE_H
#define OPENSUBDIVHEX_REGRESSION_REFERENCE_LINE_REFERENCE_H

#include "taggedRules.h"

#include <optional>
#include <vector>

namespace OpenSubdivHex::Regression {

/// The hexagonal steps behind a truncation that have such rules.
inline constexpr int kNumLineSteps = 3;

/// \brief Says of the edges of lines, which a truncation made, how sharp the regular line is there: as the least sharp of the
/// edge and the next ones at its ends, but not at all where one of these is as long, or short, as it.
void BeginRegularLines(TaggedMesh &mesh);

/// The row of a corner beside a line.
struct LineRule {
    std::vector<double>
        weights;     ///< of the face from the corner on; none where the row tells V' alone
    bool isMirrored; ///< they go back around the face
    bool isOfHalf;   ///< of half a hexagon
    std::optional<double> weightOfPoint; ///< where the corner's vertex is moved
    double share;
};

/// \brief The rule of a corner beside a line, found by what lies around it.  Between lines it is that of the sharpest, whose
/// share is what it is sharper than all others.
///
/// \param corner   of a face, or of half of it
/// \param hexagon  where the corners of its hexagon are, if it has one, from any on; of those on a line between two
///                 halves one
/// \param place    of the corner there
std::optional<LineRule> FindLineRule(TaggedMesh const &mesh, TaggedRules::Side corner,
                                     std::vector<TaggedRules::Side> const &hexagon, int place);

} // namespace OpenSubdivHex::Regression

#endif

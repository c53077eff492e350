// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_REFERENCE_LINE_REFERENCE_H
#define OPENSUBDIVHEX_REGRESSION_REFERENCE_LINE_REFERENCE_H

#include "taggedRules.h"

#include <optional>
#include <vector>

namespace OpenSubdivHex::Regression {

/// \brief How regular the line is in the pieces of it that a truncation makes: each gets the least sharpness of its own and of
/// the next pieces, but 0 where these are not long beside a short one, or short beside a long one.
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

/// \brief The rule beside the sharpest line at a corner, by what lies around it; its share is what that is sharper than all
/// others.
///
/// \param corner   of a face, or of half of it
/// \param hexagon  where the corners of its hexagon are, if it has one, from any on; of those on a line between two
///                 halves one
/// \param place    of the corner there
std::optional<LineRule> FindLineRule(TaggedMesh const &mesh, TaggedRules::Side corner,
                                     std::vector<TaggedRules::Side> const &hexagon, int place);

} // namespace OpenSubdivHex::Regression

#endif

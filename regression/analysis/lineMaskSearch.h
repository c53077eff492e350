// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_ANALYSIS_LINE_MASK_SEARCH_H
#define OPENSUBDIVHEX_REGRESSION_ANALYSIS_LINE_MASK_SEARCH_H

#include "tableSearch.h"

#include <vector>

namespace OpenSubdivHex::Regression {

/// \brief A search for the masks beside lines of truncated meshes (far_ext/rules/lineRows.inl).
///
/// The control mesh is a strip of equilateral triangles in the plane, with its border on a line, lifted to a bowl and
/// two saddles.  Their second derivatives are estimated at the vertices of a refined level, in the two rows of
/// triangles beside the border and one period along it.  Searched for are the weights with the least mean square, by
/// area, of what these deviate by from their mean at the same distance from the border; and, as smaller parts, of what
/// that mean deviates by from the exact one, and of what the weights differ by from those of later levels.  Points on
/// the line are not searched for: they follow from the line alone.
///
/// It begins with the masks of hexagons and half hexagons, and V', of later levels.  Judge() looks at the first two rows
/// of tori of triangles beside a crease and a border, at level 5.
class LineMaskSearch : public TableSearch {
public:
    /// \param level  at which surfaces are judged: 4 or more
    explicit LineMaskSearch(int level);

protected:
    Eigen::VectorXd measureLifts(SearchRows const &rows) const override;
    Eigen::VectorXd measureMore(SearchRows const &rows,
                                Eigen::VectorXd const &weights) const override;
    std::vector<Entry> judgeMore(SearchRows const &rows) const override;
    void print(SearchRows const &rows) const override;

private:
    void chooseVertices();

    Shape const _shape;
    MaskedSurface _surface;
    MaskPoints const _lifted;
    // By chosen vertex; the sum of areas is 1, and groups are by distance from the border.
    std::vector<int> _groups;
    std::vector<double> _areas;
    std::vector<double> _areasOfGroups;
    PlaneDerivatives _derivatives;
};

} // namespace OpenSubdivHex::Regression

#endif

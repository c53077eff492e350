// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_ANALYSIS_LINE_MASK_SEARCH_H
#define OPENSUBDIVHEX_REGRESSION_ANALYSIS_LINE_MASK_SEARCH_H

#include <Eigen/Core>

#include <memory>
#include <string>
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
/// The weights of rows, and of V', sum up to 1 at most.
class LineMaskSearch {
public:
    /// \param level  at which surfaces are judged: 4 or more
    explicit LineMaskSearch(int level);
    ~LineMaskSearch();
    LineMaskSearch(LineMaskSearch const &) = delete;
    LineMaskSearch &operator=(LineMaskSearch const &) = delete;

    /// The free weights: those that the library has.
    Eigen::VectorXd GetShipped() const;
    /// Where a search begins: with the masks of hexagons and half hexagons, and V', of later levels.
    Eigen::VectorXd GetStart() const;

    /// The measure that a search makes small.
    Eigen::VectorXd Measure(Eigen::VectorXd const &weights) const;

    /// How uneven a surface is.
    struct Entry {
        std::string name;
        double unevenness;
    };
    /// How uneven the first two rows of tori of triangles are beside a crease and a border, at level 5.
    std::vector<Entry> Judge(Eigen::VectorXd const &weights) const;

    /// In the parts that the library keeps.
    Eigen::VectorXd Round(Eigen::VectorXd weights) const;
    /// Prints the rows as lineRows.inl has them.
    void Print(Eigen::VectorXd const &weights) const;

private:
    class Implementation;
    std::unique_ptr<Implementation> _implementation;
};

} // namespace OpenSubdivHex::Regression

#endif

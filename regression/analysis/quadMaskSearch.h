// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_ANALYSIS_QUAD_MASK_SEARCH_H
#define OPENSUBDIVHEX_REGRESSION_ANALYSIS_QUAD_MASK_SEARCH_H

#include <Eigen/Core>

#include <memory>
#include <string>
#include <vector>

namespace OpenSubdivHex::Regression {

/// \brief A search for the masks of quads by paths (far_ext/rules/quadRows.inl), of the flags at base vertices with
/// as many faces.
///
/// The control mesh is a MakeVertexDisk() of quads in the plane, lifted to a bowl and two saddles, of which second
/// derivatives are estimated at the vertices of a refined level.  Searched for are the weights with the least mean
/// square, by area, of what these deviate by.
///
/// - With four faces it is looked at the eighth of a face that all others are images of.  There are also the masks in
///   quads at the levels that have masks of their own, and conditions on the masks of all later levels: around a
///   vertex and around a quad, bowls and saddles have the square of the subdominant eigenvalue, so that curvature
///   is bounded.
/// - With three, five and six it is looked at half a face, nearer places more than their area; the height of bowls
///   is free.  The masks of flags at four faces are the library's.
///
/// Rows that the weights leave to 1 have at least 0 there.
class QuadMaskSearch {
public:
    /// \param numFaces  3 to 6
    /// \param level     at which surfaces are judged: 5 or more with four faces, else 4 or more
    QuadMaskSearch(int numFaces, int level);
    ~QuadMaskSearch();
    QuadMaskSearch(QuadMaskSearch const &) = delete;
    QuadMaskSearch &operator=(QuadMaskSearch const &) = delete;

    /// The free weights: those that the library has.
    Eigen::VectorXd GetShipped() const;
    /// Where a search begins: with four faces the masks and V' of FaceMask::Smooth where nothing is irregular; with
    /// others the rows of four with the same paths.
    Eigen::VectorXd GetStart() const;

    /// The measure that a search makes small.
    Eigen::VectorXd Measure(Eigen::VectorXd const &weights) const;

    /// How uneven a surface is.
    struct Entry {
        std::string name;
        double unevenness;
    };
    /// \brief The root of the mean square that Measure() has, and how uneven level 5 of other control meshes is: of tori
    /// within parallels, or of spheres of quads with such vertices.
    std::vector<Entry> Judge(Eigen::VectorXd const &weights) const;

    /// In the parts that the library keeps.
    Eigen::VectorXd Round(Eigen::VectorXd weights) const;
    /// Prints the rows as quadRows.inl has them, and the masks in quads as mask.cpp.
    void Print(Eigen::VectorXd const &weights) const;

private:
    class Implementation;
    std::unique_ptr<Implementation> _implementation;
};

} // namespace OpenSubdivHex::Regression

#endif

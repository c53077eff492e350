// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_ANALYSIS_QUAD_MASK_SEARCH_H
#define OPENSUBDIVHEX_REGRESSION_ANALYSIS_QUAD_MASK_SEARCH_H

#include "tableSearch.h"

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
/// It begins, with four faces, with the masks and V' of FaceMask::Smooth where nothing is irregular; with others with
/// the rows of four that have the same paths.  Judge() looks at level 5 of other control meshes: of tori within
/// parallels, or of spheres of quads with such vertices.
class QuadMaskSearch : public TableSearch {
public:
    /// \param numFaces  3 to 6
    /// \param level     at which surfaces are judged: 5 or more with four faces, else 4 or more
    QuadMaskSearch(int numFaces, int level);

protected:
    Eigen::VectorXd measureLifts(SearchRows const &rows) const override;
    Eigen::VectorXd measureMore(SearchRows const &rows,
                                Eigen::VectorXd const &weights) const override;
    std::vector<Entry> judgeMore(SearchRows const &rows) const override;
    void print(SearchRows const &rows) const override;

private:
    bool isRegular() const;
    SearchRows makeStart() const;
    void chooseVertices();
    void findCenters();

    int const _numFaces;
    Shape const _shape;
    MaskedSurface _surface;
    MaskPoints const _lifted;
    std::vector<double> _areas; // by chosen vertex; their sum is 1
    PlaneDerivatives _derivatives;
    std::vector<MeshCenter> _centers; // at the first level with constant masks
};

} // namespace OpenSubdivHex::Regression

#endif

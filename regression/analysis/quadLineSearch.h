// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_ANALYSIS_QUAD_LINE_SEARCH_H
#define OPENSUBDIVHEX_REGRESSION_ANALYSIS_QUAD_LINE_SEARCH_H

#include "evenness.h"
#include "tableSearch.h"

#include <vector>

namespace OpenSubdivHex::Regression {

/// \brief A search for the masks beside lines of quads (far_ext/rules/quadLineRows.inl), by the paths of flags at vertices
/// with as many quads on a side of the line.
///
/// The control mesh lies in a plane, with its border on a line: a strip of quads for two, else half a disk (MakeVertexDisk).
/// It is lifted to x^2, x y and y^2, with x along the line.  Searched for are the weights with the least mean square, by
/// area, of what second derivatives deviate by: those of x^2 from their mean at the same distance from the border, or in
/// the same ring around the vertex, and from the exact ones; those of x y from the exact ones; those of y^2 from their mean,
/// and in the strip from min(y, 1) across, since no border knows how a surface bends there.
///
/// With two quads a part of the measure is how uneven the first row is beside creases and borders of two tori: lines of
/// few edges are bent in ways that quadratics do not have.
///
/// It begins with the masks where no row is.  Judge() looks at three tori, two tubes and half disks, at level 5.
class QuadLineSearch : public TableSearch {
public:
    /// \param numQuads  on a side of the line at the vertex: 2 to 4
    /// \param level     at which surfaces are judged: 4 or more
    QuadLineSearch(int numQuads, int level);

protected:
    Eigen::VectorXd measureLifts(SearchRows const &rows) const override;
    Eigen::VectorXd measureMore(SearchRows const &rows,
                                Eigen::VectorXd const &weights) const override;
    std::vector<Entry> judgeMore(SearchRows const &rows) const override;
    void print(SearchRows const &rows) const override;

private:
    struct TorusRow {
        MaskedSurface surface;
        VertexGroups chosen;
    };
    bool isStrip() const;
    void chooseVertices();
    void addTorusRow(Shape const &torus, int numU, double line, double rowWidth, int level);

    int const _numQuads;
    Shape const _shape;
    MaskedSurface _surface;
    MaskPoints const _lifted;
    // By chosen vertex; the sum of areas is 1.
    std::vector<double> _areas;
    std::vector<double> _heights; // over the border
    Eigen::MatrixXd _means;       // functions of which deviations have no part: orthonormal columns
    PlaneDerivatives _derivatives;
    std::vector<TorusRow> _torusRows;
};

} // namespace OpenSubdivHex::Regression

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_ANALYSIS_QUAD_MASK_SEARCH_H
#define OPENSUBDIVHEX_REGRESSION_ANALYSIS_QUAD_MASK_SEARCH_H

#include "surfaceLevels.h"

#include <Eigen/Core>

#include <memory>
#include <string>
#include <vector>

namespace OpenSubdivHex::Regression {

/// \brief The free weights of FaceMask::Smooth at the first two levels of quads: those of
/// FarExt::ComputeIrregularVertexMask() for a vertex among quads and of
/// FarExt::ComputeQuadNeighborMask() that follow from nothing.
///
/// In their order: at level 1 c1 and a2 of the F-vertex at the vertex; at level 2 the same, the
/// weights of N, A and M in that at N, and the second to the last beside a quad.  The others are 0,
/// or what is left to 1; those beside a quad at level 1 keep curvature bounded there, and V' has the
/// weight that it has at all levels.
using QuadWeights = Eigen::Matrix<double, 12, 1>;

/// Those that the library has.
QuadWeights GetShippedQuadWeights();

/// The masks of all hexagons and of vertices that are not among quads: where a search begins.
QuadWeights GetPlainQuadWeights();

/// \brief What a search makes small: how uneven curvature is on surfaces of quads, as a function of
/// their weights.
///
/// Mean curvature along the parallels of three tori; and, as a small part, Gaussian curvature of two
/// saddles and mean curvature of a bowl, of which quads of a plane are the control points.
class QuadJudge {
public:
    /// \param level  at which surfaces are judged, 3 or more
    explicit QuadJudge(int level);
    ~QuadJudge();
    QuadJudge(QuadJudge const &) = delete;
    QuadJudge &operator=(QuadJudge const &) = delete;

    /// \brief The deviations at all places, as MeasureDeviations(), each surface by its weight; and
    /// what weights are below 0, by one that keeps them from it.
    Eigen::VectorXd Measure(QuadWeights const &weights);

    /// The surfaces, and how uneven each has been when Measure() was last called.
    struct Entry {
        std::string name;
        double unevenness;
    };
    std::vector<Entry> GetEntries() const;

private:
    class Surface;
    std::vector<std::unique_ptr<Surface>> _surfaces;
};

/// \brief Weights for which the norm of what \p judge measures is smaller than for \p weights: by
/// Levenberg and Marquardt's method, with weights kept from falling below 0.
///
/// \param maxSteps  it ends before where steps gain nothing
QuadWeights SearchQuadWeights(QuadWeights weights, int maxSteps, QuadJudge &judge);

/// Rounded to 128ths.
QuadWeights RoundQuadWeights(QuadWeights const &weights);

} // namespace OpenSubdivHex::Regression

#endif

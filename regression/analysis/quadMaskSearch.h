// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_ANALYSIS_QUAD_MASK_SEARCH_H
#define OPENSUBDIVHEX_REGRESSION_ANALYSIS_QUAD_MASK_SEARCH_H

#include "surfaceLevels.h"

#include <Eigen/Core>

#include <memory>
#include <string>
#include <vector>

namespace OpenSubdivHex::Regression {

/// \brief The free weights of FaceMask::Smooth at the first levels of quads: some of those of
/// FarExt::ComputeIrregularVertexMask() for a vertex among quads and of FarExt::ComputeQuadMask().
///
/// The others are 0, the same on both sides of a symmetric mask, or what is left to 1; those of V' are
/// what they are at all levels.
using QuadWeights = Eigen::VectorXd;

/// Those that the library has.
QuadWeights GetShippedQuadWeights();

/// The masks of later levels, but for what is not free in those of the first: where a search begins.
QuadWeights GetPlainQuadWeights();

/// \brief What a search makes small: how uneven curvature is on surfaces of quads, as a function of
/// their weights.
///
/// Mean curvature along the parallels of three tori; and, as smaller parts, of the first two rows beside
/// the border of the same tori without a row, and of bowls, and Gaussian curvature of saddles, whose control
/// points are quads of a plane with three, four and five around the vertex in the middle.
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
/// \param maxSteps   it ends before where steps gain nothing
/// \param firstFree  those before it stay as they are
QuadWeights SearchQuadWeights(QuadWeights weights, int maxSteps, QuadJudge &judge,
                              int firstFree = 0);

/// \brief Rounded to 256ths, level after level: those of the next are searched for again when one is
/// rounded.
///
/// \param maxSteps  as of SearchQuadWeights()
QuadWeights RoundQuadWeights(QuadWeights weights, int maxSteps, QuadJudge &judge);

} // namespace OpenSubdivHex::Regression

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_ANALYSIS_MASK_SEARCH_H
#define OPENSUBDIVHEX_REGRESSION_ANALYSIS_MASK_SEARCH_H

#include "evenness.h"

#include "far_ext/rules/mask.h"
#include "regression/shapes/featureShapes.h"

#include <Eigen/Core>

#include <memory>
#include <string>
#include <vector>

namespace OpenSubdivHex::Regression {

/// \brief For which masks of FaceMask::Smooth at the first levels weights are searched for: those of
/// FarExt::ComputeIrregularVertexMask() for such a vertex, and with four quads around it those beside quads of
/// FarExt::ComputeQuadMask(), too.
struct SearchedMasks {
    int numFaces;
    FarExt::FacesAround facesAround;

    bool AreOfQuads() const { return facesAround == FarExt::FacesAround::Quads; }
};

/// \brief The free weights of these masks.
///
/// The others are 0, the same on both sides of a symmetric mask, or what is left to 1; those of V' are
/// what they are at all levels.
using MaskWeights = Eigen::VectorXd;

/// The weights that the library has.
MaskWeights GetShippedWeights(SearchedMasks const &searched);

/// The masks of later levels, but for what is not free in those of the first: where a search begins.
MaskWeights GetPlainWeights(SearchedMasks const &searched);

/// \brief The measure that a search makes small: how uneven curvature is on some surfaces, as a function of weights.
///
/// For quads mean curvature along the parallels of three tori; and, as smaller parts, of the first two rows
/// beside the border of the same tori without a row, and of bowls, and Gaussian curvature of saddles, whose
/// control points are quads of a plane with three, four and five around the vertex in the middle.
///
/// For a vertex among others bowls and saddles in hexagons, and with five faces and more in quads; with four
/// an octahedron, too.  Among triangles a bowl and saddles in triangles; with five an icosahedron, and with
/// six a torus, too.
class MaskJudge {
public:
    /// \param level  at which surfaces are judged, 3 or more
    MaskJudge(SearchedMasks const &searched, int level);
    ~MaskJudge();
    MaskJudge(MaskJudge const &) = delete;
    MaskJudge &operator=(MaskJudge const &) = delete;

    /// \brief The deviations at all places, as MeasureDeviations(), each surface by its weight; and
    /// what weights are below 0, by one that keeps them from it.
    Eigen::VectorXd Measure(MaskWeights const &weights);

    /// The surfaces, and how uneven each has been when Measure() was last called.
    struct Entry {
        std::string name;
        double unevenness;
    };
    std::vector<Entry> GetEntries() const;

    SearchedMasks const &GetSearched() const { return _searched; }

private:
    class Surface;
    Surface &add(std::string const &name, Shape const &shape, int level, Curvature curvature,
                 double weight);
    void addRipple(Tiling tiling, int level, double ofBowl, double ofSaddle);
    void addQuads(int level);
    void addVertex(int level);

    SearchedMasks _searched;
    std::vector<std::unique_ptr<Surface>> _surfaces;
};

/// Prints the masks that the weights are of, in 256ths: one on a line, level after level, as mask.cpp has them.
void PrintMasks(SearchedMasks const &searched, MaskWeights const &weights);

/// FindLeastSquares() of what \p judge measures.
MaskWeights SearchWeights(MaskWeights const &weights, int maxSteps, MaskJudge &judge,
                          int firstFree = 0);

/// \brief Rounded to 256ths, level after level: those of the next are searched for again when one is
/// rounded.
///
/// \param maxSteps  as of SearchWeights()
MaskWeights RoundWeights(MaskWeights weights, int maxSteps, MaskJudge &judge);

} // namespace OpenSubdivHex::Regression

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_RATE_EVALUATOR_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_RATE_EVALUATOR_H

#include "bfrPlace.h"
#include "borderEvaluator.h"
#include "patchEvaluator.h"

#include <opensubdiv/bfr/tessellation.h>

#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief Evaluates a Bfr::Tessellation, with rates of segments, of a base face that a BorderEvaluator has.
///
/// BorderEvaluator makes the points on the border.  Other results have dense matrices: one for each pair of inner
/// rates for the places inside, and one for each rate for derivatives on an edge.  So tessellations with other rates
/// on the edges share the matrix of the inside.  The type of the face keeps the matrices; for a plain face that is
/// not in a lattice, the types of its children do, which are few.  Matrices stand in blocks of places, and where there are many blocks, they are
/// made each time and not kept.
template <typename REAL>
class RateEvaluator {
public:
    /// \param results  points; derivatives by u and v, or two times null
    RateEvaluator(Bfr::Tessellation const &tessellation, BorderEvaluator<REAL> &border,
                  REAL *const results[3], std::ptrdiff_t resultStride);

    /// Evaluates a face with points \p stride numbers apart.
    void Evaluate(CellType const &type, REAL const *points, std::ptrdiff_t stride);
    /// Evaluates a plain one, of whose rings the border has the points.
    void Evaluate(PlainFaceType const &type);

private:
    // The face, or a child of it.
    struct Source {
        PlaceSource<REAL> places;
        std::size_t child; // of the face
    };
    // Matrices with a row for each place.
    struct Matrices {
        std::size_t GetHeapSize() const { return GetHeapSizes(ofPlaces, runs); }

        typename PlaceSource<REAL>::Matrices ofPlaces;
        std::vector<PlaceRun> runs; ///< none: all places in turn
    };

    Pair getInnerCoord(std::size_t place);
    Matrices makeInside(Source const &source, std::size_t begin, std::size_t end,
                        bool hasDerivatives);
    template <typename FUNCTION>
    void forEachEdge(FUNCTION const &function) const;
    void evaluateBorder(int edge, int rate, int first) const;
    // The kind of face, with its parameterization.
    int getFaceKey() const;
    FaceShape getShape(Source const &source) const;
    void evaluateInside(Source const &source);
    void evaluateInside(Source const &source, PatternOf of);
    void evaluateDerivativesOnEdge(Source const &source, int edge, int rate, int first) const;
    void sumUp(Source const &source, Matrices const &matrices, bool areDerivatives,
               int firstPlace) const;
    REAL *getResult(std::size_t kind, int place) const {
        return _results[kind] + std::ptrdiff_t(place) * _resultStride;
    }

    Bfr::Tessellation const &_tessellation;
    BorderEvaluator<REAL> &_border;
    REAL *const _results[3];
    std::ptrdiff_t const _resultStride;
    // The places inside.  By direction, the number of segments of a quad that has some; else 0.  With the number of
    // places, it tells all of them.
    std::size_t const _numInner;
    int _innerRates[2] = {};
    std::vector<double> _innerCoords; // none until they are asked for
};

extern template class RateEvaluator<float>;
extern template class RateEvaluator<double>;

} // namespace OpenSubdivHex::BfrExt::internal

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_RATE_EVALUATOR_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_RATE_EVALUATOR_H

#include "bfrPlace.h"
#include "borderEvaluator.h"

#include <opensubdiv/bfr/tessellation.h>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief Points of a base face, and where the points and derivatives go that are made of them.
template <typename REAL>
struct RateSums {
    REAL const *points;
    std::ptrdiff_t stride; ///< from one point to the next, in numbers
    std::size_t size;      ///< of a point
    REAL *const *results;  ///< points; derivatives by u and v, or two times null
    std::ptrdiff_t resultStride;
};

/// \brief Evaluates the places of a Bfr::Tessellation of a face, with rates of segments.
///
/// BorderEvaluator makes the points on the border.  All else has dense matrices, which the type of the face
/// keeps: one of the places inside for each pair of inner rates, and of derivatives on an edge one for each
/// rate.  So faces with other rates on their edges share that of the inside.  Matrices stand in blocks of places,
/// and where there are many blocks, they are made each time and not kept.
///
/// \param border  has the face
template <typename REAL>
void EvaluateRates(CellType const &type, Bfr::Tessellation const &tessellation,
                   RateSums<REAL> const &sums, BorderEvaluator<REAL> &border);

extern template void EvaluateRates(CellType const &, Bfr::Tessellation const &,
                                   RateSums<float> const &, BorderEvaluator<float> &);
extern template void EvaluateRates(CellType const &, Bfr::Tessellation const &,
                                   RateSums<double> const &, BorderEvaluator<double> &);

} // namespace OpenSubdivHex::BfrExt::internal

#endif

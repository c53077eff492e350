// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_PATCH_EVALUATOR_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_PATCH_EVALUATOR_H

#include "cellPlan.h"
#include "placeSource.h"
#include "plainFace.h"

#include <deque>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief Evaluates the inside of base faces: their points are refined to those of leaves, whose places
/// are summed up by the matrices of their types.
template <typename REAL>
class PatchEvaluator {
public:
    /// \brief Writes the points at the places of a plan, where their numbers say; of a plan for derivatives, those by u
    /// and by v.
    ///
    /// \param size          numbers of a point
    /// \param stride        from one control point to the next
    /// \param results       one array, or two
    /// \param resultStride  from one place to the next
    void Evaluate(CellType const &type, CellPlan const &plan, int size, REAL const *controlPoints,
                  std::ptrdiff_t stride, REAL *const *results, std::ptrdiff_t resultStride);
    /// Overload for a plain face, from the points of its rings; the plan is not empty.
    void Evaluate(PlainFaceType const &type, RingValues<REAL> &values, CellPlan const &plan,
                  REAL *const *results, std::ptrdiff_t resultStride);

private:
    void begin(CellPlan const &plan, std::size_t size, REAL *const *results,
               std::ptrdiff_t resultStride);
    void descend(CellType const &type, CellPlan const &plan, std::size_t node, std::size_t depth);
    void descendToChildren(CellType const &type, CellPlan const &plan, std::size_t node,
                           std::size_t depth);
    void evaluateLeaf(PlaceSource<REAL> const &source, CellPlan::Node const &leaf);
    void turnDerivatives(CellPlan::Node const &leaf) const;
    void evaluateCorners(CellType const &type, CellPlan::Node const &cell, REAL const *points);
    void evaluateCorner(PlaceSource<REAL> const &source, PlaceMatrix<REAL> const &derivatives,
                        CellPlan::CornerPlace const &corner);
    void writeDerivatives(CellPlan::CornerPlace const &corner);
    std::vector<REAL> &getPoints(std::size_t place, std::size_t numPoints);

    std::size_t _size = 0; // of a point
    std::size_t _paddedSize = 0;
    std::deque<std::vector<REAL>> _points; // by depth, of a cell and of its children
    std::vector<int> _indices;
    std::vector<REAL> _derivatives; // at a corner, by its two coordinates
    bool _hasDerivatives = false;
    REAL *_results[2] = {}; // points, or derivatives
    std::ptrdiff_t _resultStride = 0;
};

extern template class PatchEvaluator<float>;
extern template class PatchEvaluator<double>;

} // namespace OpenSubdivHex::BfrExt::internal

#endif

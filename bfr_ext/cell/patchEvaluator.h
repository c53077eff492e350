// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_PATCH_EVALUATOR_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_PATCH_EVALUATOR_H

#include "cellPlan.h"
#include "plainFace.h"

#include <deque>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief Evaluates the inside of base faces: their points are refined to those of leaves, whose places
/// are summed up by the matrices of their types.
template <typename REAL>
class PatchEvaluator {
public:
    /// \brief Writes the points at the places of a plan, where their numbers say.
    ///
    /// \param size          numbers of a point
    /// \param stride        from one control point to the next
    /// \param resultStride  from one place to the next
    void Evaluate(CellType const &type, CellPlan const &plan, int size, REAL const *controlPoints,
                  std::ptrdiff_t stride, REAL *results, std::ptrdiff_t resultStride);

    /// Overload with the derivatives by u and v.
    ///
    /// \param plan  one for derivatives
    void EvaluateDerivatives(CellType const &type, CellPlan const &plan, int size,
                             REAL const *controlPoints, std::ptrdiff_t stride, REAL *du, REAL *dv,
                             std::ptrdiff_t resultStride);

    /// @name The same of plain faces, from the points of their rings
    /// @{

    void Evaluate(PlainFaceType const &type, RingValues<REAL> &values, CellPlan const &plan,
                  REAL *results, std::ptrdiff_t resultStride);
    void EvaluateDerivatives(PlainFaceType const &type, RingValues<REAL> &values,
                             CellPlan const &plan, REAL *du, REAL *dv, std::ptrdiff_t resultStride);
    /// @}

private:
    void evaluate(CellType const &type, CellPlan const &plan, int size, REAL const *controlPoints,
                  std::ptrdiff_t stride);
    void evaluate(PlainFaceType const &type, RingValues<REAL> &values, CellPlan const &plan);
    void descend(CellType const &type, CellPlan const &plan, std::size_t node, std::size_t depth);
    void descendToChildren(CellType const &type, CellPlan const &plan, std::size_t node,
                           std::size_t depth);
    void evaluateLeaf(CellType const &type, RingCell const *ringCell, CellPlan::Node const &leaf,
                      REAL const *points, std::ptrdiff_t stride, int const *indices);
    void turnDerivatives(CellPlan::Node const &leaf) const;
    void evaluateCorners(CellType const &type, CellPlan::Node const &cell, REAL const *points);
    void evaluateCorners(FaceRings const &face, RingValues<REAL> &values,
                         CellPlan::Node const &cell);
    void evaluateCorners(RingCell const &child, CellPlan::Node const &cell, REAL const *points);
    void evaluateCorner(PlaceMatrix<REAL> const &derivatives, CellPlan::CornerPlace const &corner,
                        REAL const *points);
    std::vector<REAL> &getPoints(std::size_t place, std::size_t numPoints);

    std::size_t _size = 0; // of a point
    std::size_t _paddedSize = 0;
    std::deque<std::vector<REAL>> _points; // by depth, of a cell and of its children
    std::vector<int> _indices;
    std::vector<REAL> _along; // derivatives at a corner, by two coordinates
    REAL *_results = nullptr; // points
    REAL *_derivatives[2] = {};
    std::ptrdiff_t _resultStride = 0;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif

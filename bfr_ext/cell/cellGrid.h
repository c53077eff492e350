// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_CELL_GRID_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_CELL_GRID_H

#include "baseType.h"
#include "cellMeasures.h"
#include "patchEvaluator.h"
#include "refinedCells.h"

#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief The cells up to two steps from a cell on, and where their corners are among the places of its LeafPlaces: from
/// the surface at these places, the *samples*, a cell and its children are measured.
///
/// Samples of a cell are made as the places of a leaf of tessellations are, those of a base face as its tessellation of level 2
/// is: in single precision, which the cells up to two steps on can do with.  They are relative to the first point and the
/// size of all, but of rings that faces share, whose points are as precise as those of the mesh.
///
/// One thread uses it at a time.
class CellGrid {
public:
    /// \param shape  of whole cells; of size 0: of half cells
    explicit CellGrid(FaceShape shape);
    /// The grid of the calling thread.
    static CellGrid &Get(FaceShape shape);

    /// Children of the cell, without their own.
    int GetNumChildren() const { return int(_cells[0].children.size()); }

    /// Writes the samples of a cell that is no base face, three numbers each.
    void Sample(CellValues const &cell, std::vector<double> &samples);
    /// Overload for a base face.
    ///
    /// \param controlPoints  three numbers each, without gaps
    /// \param shared         sources of its rings, without points where faces share none
    void Sample(BaseFace const &face, double const *controlPoints, RingSources<float> const &shared,
                std::vector<double> &samples);

    /// Measures the cell, but where it faces.
    void Measure(std::vector<double> const &samples, CellMeasures &cell) const;
    /// \brief Measures the GetNumChildren() children, given the measures of the cell.
    ///
    /// \param isSharp  whether something sharp is near
    void MeasureChildren(std::vector<double> const &samples, CellMeasures const &cell, bool isSharp,
                         CellMeasures *children) const;
    /// \brief Finds where the cell, 0, or a child, from 1 on, faces.
    ///
    /// \param normals  of the surface at its corners, of any length
    CellFacing FindFacing(std::vector<double> const &samples, int cell,
                          std::vector<Vector3> normals) const;

private:
    static constexpr int kNumSteps = 2;

    struct Cell {
        std::vector<int> corners;  // as samples
        std::vector<int> samples;  // in the cell
        std::vector<int> children; // in the grid
        double factor; // of the range of heights, and of how far samples are from the center
    };
    template <typename FUNCTION>
    void sample(double const *points, std::size_t stride, int numPoints,
                std::vector<double> &samples, FUNCTION const &evaluate);
    int add(CellOutline<Pair> const &outline, int numSteps);
    void measure(std::vector<double> const &samples, Cell const &cell,
                 CellMeasures &measures) const;

    FaceShape const _shape;
    LeafPlaces const _places;
    std::vector<Cell> _cells;
    CellPlan const _plan;       // of cells, and of base faces in lattices
    CellPlan const _planOfBase; // of other base faces
    PatchEvaluator<float> _evaluator;
    RingValues<float> _ringValues;
    std::vector<float> _points;
    std::vector<float> _samples;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_CELL_VALUES_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_CELL_VALUES_H

#include "baseType.h"
#include "cellStencil.h"

#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief A cell of a base face with the values of its patch, which are refined from cell to cell.
///
/// CellStencil and PatchEvaluator have what a place is in terms of the control points, once for all cells
/// of a type.  Trees hardly have places in common, and their cells are met in the order of refinement:
/// there it is less work to refine values.
///
/// The children of a cell share points, so that those of all are made when the first child is asked for.  Those
/// of a plain base face outside of lattices are made by its rings, without a CellType of the face.
class CellValues {
public:
    /// The values of a base face, whose control points are \p length numbers each, without gaps.
    void SetBase(BaseType const &type, double const *controlPoints, int length);
    /// \brief A child, in the order of RefineCell().
    ///
    /// \param parent  another object
    void SetChild(CellValues const &parent, int child);

    /// The type of a plain base face is made on demand.
    CellType const &GetType() const { return _plain ? _plain->Get() : *_type; }
    int GetNumChildren() const;
    /// The shape of a whole cell; of size 0 of others.
    FaceShape GetShape() const {
        return _plain ? FaceShape(GetNumChildren() - 1) : _type->GetShape();
    }
    int GetLevel() const { return _level; }

    /// Points of the patch's vertices, valid until the cell is set again.
    int GetNumPoints() const { return _numPoints; }
    /// The numbers of a point, those of the next being GetPaddedSize() behind them.
    double const *GetPoint(int point) const {
        return _points.data() + std::size_t(point) * _paddedSize;
    }
    /// A multiple of StepMatrix::kPadding.
    std::size_t GetPaddedSize() const { return _paddedSize; }

    /// Writes the surface at a corner, where it is that of the type.
    void EvaluateCorner(int corner, double *p) const;
    /// Writes the derivatives by u and v there.
    void EvaluateCorner(int corner, double *du, double *dv) const;

private:
    void refine() const;
    void findCoords(CellValues const &parent, int child);
    void sum(std::vector<double> const &weights, std::vector<double> const &points,
             double *result) const;

    CellType const *_type = nullptr;
    PlainFaceType const *_plain = nullptr; // of a base face that is plain, in place of the type
    int _level = 0;
    int _length = 0;
    std::size_t _paddedSize = 0;
    int _numPoints = 0;
    FaceShape _faceShape; // of the base face
    int _sector = 0;      // of a half cell
    Pair _toCoords[2] =
        {}; // of a half cell: the derivatives of its coordinates by those of the sector
    std::vector<double> _points;
    bool _isInner = false; // refined by rings, with other masks than those of the type
    mutable bool _isRefined = false;
    mutable std::vector<double> _refined; // the points of all children
    std::vector<int> _indices;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif

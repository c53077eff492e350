// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_FACE_PATCHES_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_FACE_PATCHES_H

#include "bfrPlace.h"
#include "patchSums.h"
#include "placeKernel.h"

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

class BaseType;

/// \brief The first level whose cells can be the patches of a base face, and the last one.
inline constexpr int kFirstPatchLevel = 2;
inline constexpr int kLastPatchLevel = 6;

/// \brief Finds the patch of a place of a base face, with derivatives as far as \p numDerivatives asks: 0, 1 or 2.
///
/// Patches, one or more for each cell of a level, are in the order of the cells: depth first, with children in the order of
/// RefineCell().
PatchPlace FindPatchPlace(BfrPlace const &ofFace, FaceShape shape, int level, int numDerivatives);

/// \brief Gregory patches as sums of points of a cell.
template <typename REAL>
class PatchRows {
public:
    /// None.
    PatchRows() = default;
    /// \param rows  by patch those of its kNumPatchPoints points, weights of all points of the cell
    explicit PatchRows(std::vector<std::vector<double>> rows);

    std::size_t GetHeapSize() const { return GetHeapSizes(_blocks, _columns, _weights); }
    std::vector<PatchBlock<REAL>> const &GetBlocks() const { return _blocks; }

private:
    std::vector<PatchBlock<REAL>> _blocks; // by patch, of the numbers below
    std::vector<int> _columns;             // by patch those whose weights are not 0
    std::vector<REAL, RegisterAllocator<REAL>> _weights;
};

/// \brief The Gregory patches in a child of a base face as sums of points that the step of the child makes.
template <typename REAL>
class ChildPatches;

/// \brief The Gregory patches of a level in a base face, and the points that they are sums of.
///
/// Patches are sums of the points of the first level whose cells have few types: in lattices of the control points; else, of
/// rings in what these give, and of two steps where there are no rings.
template <typename REAL>
class FacePatches {
public:
    /// Those of a type, made on demand.
    static FacePatches const &Get(BaseType const &type, int level);

    std::size_t GetHeapSize() const { return GetHeapSizes(_ofLattice, _otherParts, _sources); }
    /// Points that the patches are sums of; 0: of the control points.
    int GetNumPoints() const { return int(_sources.size()); }
    /// \brief Makes these, outside of lattices, from the control points, of \p size numbers each, from one to the next by
    /// \p stride.
    ///
    /// \param type  that of the constructor
    void MakePoints(BaseType const &type, REAL const *control, int size, std::ptrdiff_t stride,
                    REAL *points) const;
    /// Evaluates the patch of a place: the point, and derivatives by u and v as far as \p numDerivatives asks:
    /// 0, 1 or 2.
    ///
    /// \param level    that of the patches
    /// \param points   those of MakePoints() or, in lattices, the control points
    /// \param results  the point; by u, by v; by u twice, by u and v, by v twice
    void Evaluate(Bfr::Parameterization const &parameterization, FaceShape shape, int level,
                  Pair const &uv, int numDerivatives, REAL const *points, int size,
                  std::ptrdiff_t stride, REAL *const *results) const;

private:
    // The patches of a child, or all, and the points that they are sums of.
    struct Part {
        PatchBlock<REAL> const *blocks;
        int firstPoint;
        int numPoints;
    };

    FacePatches(BaseType const &type, int level);

    void add(std::vector<PatchBlock<REAL>> const &blocks, int numPoints);
    // getSource: which point one of the child's is.
    template <typename GET>
    void addChild(ChildPatches<REAL> const &child, GET const &getSource);
    Part const &getPart(std::size_t number) const {
        return number < _parts.size() ? _parts[number] : _otherParts[number - _parts.size()];
    }
    // The part that has a patch, and the patch there.
    std::pair<Part const *, PatchBlock<REAL> const *> findBlock(int level, int patch) const;

    // What evaluation reads comes first, and lies together: types of faces are mostly not in the cache.
    int _numInFirst = 0; // patches of the first part
    int _numParts = 0;
    std::array<Part, 5> _parts; // of a face of up to four sides all
    std::vector<Part> _otherParts;
    std::vector<int>
        _sources; // by point: which of those of all rings, or row of the step of its child
    PatchRows<REAL> _ofLattice;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif

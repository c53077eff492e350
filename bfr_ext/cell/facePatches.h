// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_FACE_PATCHES_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_FACE_PATCHES_H

#include "bfrPlace.h"
#include "patchSums.h"
#include "placeKernel.h"

#include <cstddef>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

class BaseType;

/// \brief The first level whose cells can be the patches of a base face, and the last one.
inline constexpr int kFirstPatchLevel = 2;
inline constexpr int kLastPatchLevel = 6;

/// \brief How many Gregory patches the cells of a level are in a base face.
///
/// They are in the order of the cells: depth first, with children in the order of RefineCell().
int GetNumFacePatches(FaceShape shape, int level);

/// Finds the patch of a place of a base face, with derivatives as far as \p numDerivatives asks: 0, 1 or 2.
PatchPlace FindPatchPlace(BfrPlace const &ofFace, FaceShape shape, int level, int numDerivatives);

/// \brief The Gregory patches of a level in a base face as sums of its control points.
///
/// Base faces in lattices have them: there few types serve all faces, whose patches need no points of their own.
template <typename REAL>
class PatchRows {
public:
    /// Those of a type, made on demand; without patches where faces of the type have patch points.
    static PatchRows const &Get(BaseType const &type, int level);

    /// None.
    PatchRows() = default;
    /// \param rows  by patch those of its kNumPatchPoints points, weights of all control points
    explicit PatchRows(std::vector<std::vector<double>> const &rows);

    std::size_t GetHeapSize() const { return GetHeapSizes(_patches, _columns, _weights); }
    bool IsEmpty() const { return _patches.empty(); }
    PatchBlock<REAL> operator[](int patch) const {
        Patch const &of = _patches[std::size_t(patch)];
        return {_weights.data() + of.firstWeight, _columns.data() + of.firstColumn, of.numColumns};
    }
    /// Control points that patches are sums of lie before it.
    int GetEndOfPoints() const { return _endOfPoints; }

private:
    struct Patch {
        std::size_t firstWeight;
        std::size_t firstColumn;
        int numColumns;
    };

    void add(std::vector<double> const *points);

    std::vector<Patch> _patches;
    std::vector<int> _columns; // by patch those whose weights are not 0
    std::vector<REAL, RegisterAllocator<REAL>> _weights;
    int _endOfPoints = 0;
};

/// \brief Makes the points of patches of a face from its control points, where it has any.
///
/// \param control  points of the type, of \p size numbers each, from one to the next by \p stride
/// \param wanted   the patches, ascending; null: all
/// \param points   kNumPatchPoints for each patch of the face; those of other patches are left as they are
template <typename REAL>
void MakeFacePatchPoints(BaseType const &type, int level, REAL const *control, int size,
                         std::ptrdiff_t stride, std::vector<int> const *wanted, REAL *points);

/// \brief Evaluates the patch of a place: the point, and derivatives by u and v as far as NUM_DERIVATIVES asks:
/// 0, 1 or 2.
///
/// \param rows     those of the face
/// \param points   the control points or, where there are no rows, those of all patches
/// \param results  the point; by u, by v; by u twice, by u and v, by v twice
template <int NUM_DERIVATIVES, typename REAL>
void EvaluatePlace(Bfr::Parameterization const &parameterization, FaceShape shape, Pair const &uv,
                   int level, PatchRows<REAL> const &rows, REAL const *points, int size,
                   std::ptrdiff_t stride, REAL *const *results);

} // namespace OpenSubdivHex::BfrExt::internal

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_PATCH_PATCH_DEVIATION_H
#define OPENSUBDIVHEX_FAR_EXT_PATCH_PATCH_DEVIATION_H

#include "patchCells.h"

#include "far_ext/topologyRefiner.h"

#include <array>
#include <vector>

namespace OpenSubdivHex::FarExt::internal {

/// \brief How far patches are from the limit surface, for given positions of the control vertices.
///
/// It compares them at the vertices that two more steps make inside of each cell, at right angles to
/// the patch.
class PatchDeviation {
public:
    using Index = Far::Index;
    using Vector = std::array<double, 3>;

    /// \param positions  x, y, z of the control vertices
    /// \param eye        x, y, z, or null: distances are in terms of that from the eye
    /// \param lastLevel  of cells that are measured; the refiner has two levels more
    PatchDeviation(TopologyRefiner const &refiner, float const *positions, float const *eye,
                   int lastLevel);

    /// \brief The largest distance in the cells of each of some faces of a level, which ascend; infinite for
    /// faces that are made of kites.
    CallStatus Measure(int depth, std::vector<Index> const &faces,
                       std::vector<double> &distances) const;

private:
    TopologyRefiner const &_refiner;
    bool const _hasEye;
    Vector _eye{};
    std::vector<std::vector<Vector>> _positions; // by level
};

} // namespace OpenSubdivHex::FarExt::internal

#endif

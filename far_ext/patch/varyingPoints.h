// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_PATCH_VARYING_POINTS_H
#define OPENSUBDIVHEX_FAR_EXT_PATCH_VARYING_POINTS_H

#include "patchBuilder.h"

#include "far_ext/topologyRefiner.h"

namespace OpenSubdivHex::FarExt::internal {

/// \brief Linear data at the corners of patches: those of vertices, or values, and means of these at the middles
/// of sides and at the centres of faces that are made of kites.
class VaryingPoints {
public:
    using Index = Far::Index;

    /// \param channel  a face-varying channel, of whose value mesh the cells are; -1: varying data
    VaryingPoints(TopologyRefiner const &refiner, int channel, PatchCells const &cells);

    /// Four for each patch, in the order of its corners.
    std::vector<Index> const &GetPatchPoints() const { return _patchPoints; }

    /// In terms of the control vertices, or values.
    template <typename REAL>
    CallStatus MakeStencils(PointStencils<REAL> &stencils) const;

private:
    // The mean of some vertices of the last level, which have the indices of those of any level.
    Index addPoint(std::vector<Index> const &verts);

    TopologyRefiner const &_refiner;
    int const _channel;
    int const _lastLevel;
    std::vector<Index> _patchPoints;
    std::vector<int> _firstVerts = {0}; // by point, and the end
    std::vector<Index> _verts;
};

} // namespace OpenSubdivHex::FarExt::internal

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_PATCH_PATCH_BUILDER_H
#define OPENSUBDIVHEX_FAR_EXT_PATCH_PATCH_BUILDER_H

#include "patchCells.h"
#include "patchConstants.h"

#include "far_ext/limit/limitMask.h"

#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace OpenSubdivHex::FarExt::internal {

/// Points of a Gregory patch.
inline constexpr int kNumPatchPoints = 20;

/// \brief The stencils of points, in the order of the points.
template <typename REAL>
struct PointStencils {
    std::vector<int> sizes;
    std::vector<Far::Index> indices;
    std::vector<REAL> weights;
};

/// \brief How long ago a level and its vertices were made, which constants of patches depend on: for levels
/// that are not numbered as those of a hierarchy.
struct PatchAges {
    int steps = 0;               ///< of the level, behind the surface level
    std::vector<int> ofVertices; ///< steps since a vertex was made; -1: one of the surface level
};

/// \brief Makes Gregory patches of cells: numbers their points, and makes the stencils of these.
///
/// Points are, in this order: the vertices at corners of cells, ascending; level by level those of
/// edges, diagonals, and faces that are made of kites.  Those of a face-varying channel are in the space of its
/// values, and cells are faces of its value mesh.
class PatchBuilder {
public:
    using Index = Far::Index;

    /// \param channel  of \p hierarchy, or -1 for its mesh
    PatchBuilder(Hierarchy const &hierarchy, int channel, Sdc::Options sdcOptions,
                 HexSchemeOptions const &schemeOptions, PatchCells const &cells,
                 PatchConstants constants);
    /// With the constants of the mask.
    PatchBuilder(Hierarchy const &hierarchy, int channel, Sdc::Options sdcOptions,
                 HexSchemeOptions const &schemeOptions, PatchCells const &cells)
        : PatchBuilder(hierarchy, channel, sdcOptions, schemeOptions, cells,
                       PatchConstants(schemeOptions.faceMask)) {}
    ~PatchBuilder();

    /// Takes the ages of the only level that has cells from here, not from the numbering of levels.
    void SetAges(PatchAges ages) { _ages = std::move(ages); }

    /// Has limits found by a finder with the same options, on the calling thread alone.
    void SetMaskFinder(LimitMaskFinder &finder) { _maskFinder = &finder; }

    /// Finds all limits that points are made of, and numbers the points.
    CallStatus Build();

    /// kNumPatchPoints for each patch, in the order of the cells.
    std::vector<Index> const &GetPatchPoints() const { return _patchPoints; }
    Index GetNumPoints() const { return _numPoints; }

    /// Stencils of all points; TooLarge if there are too many weights.
    template <typename REAL>
    CallStatus MakeStencils(PointStencils<REAL> &stencils) const;

private:
    class LevelBuilder;
    // A point at a vertex, from the first level where cells have it.
    struct VertexPoint {
        LevelBuilder const *level;
        Index row;
    };

    Hierarchy const &_hierarchy;
    int const _channel;
    Sdc::Options const _sdcOptions;
    HexSchemeOptions const _schemeOptions;
    PatchCells const &_cells;
    PatchConstants const _constants;
    std::optional<PatchAges> _ages;
    LimitMaskFinder *_maskFinder = nullptr;
    std::vector<std::unique_ptr<LevelBuilder>> _levels;
    std::vector<VertexPoint> _vertexPoints;
    std::vector<char> _isInSeveralLevels; // by vertex: then its tangents are the limit's
    std::vector<Index> _patchPoints;
    Index _numPoints = 0;
};

} // namespace OpenSubdivHex::FarExt::internal

#endif

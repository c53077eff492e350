// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_BASE_MESH_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_BASE_MESH_H

#include "baseEdges.h"
#include "hierarchy.h"

#include "far_ext/status.h"

#include <opensubdiv/far/topologyRefiner.h>

#include <memory>

namespace OpenSubdivHex::FarExt::internal {

/// \brief Level 0 in the making, whatever mesh it comes from: counts, faces, edges, tags and channels,
/// in this order.
///
/// Errors are found when a step is completed.  Each function that returns a CallStatus gives
/// the first cause for a refusal, after which nothing else is called.
class BaseMesh {
public:
    using Index = Far::Index;

    explicit BaseMesh(Sdc::Options sdcOptions) : _sdcOptions(sdcOptions) {}

    Sdc::Options GetSchemeOptions() const { return _sdcOptions; }
    Level &GetLevel() { return *_level; }
    Level const &GetLevel() const { return *_level; }

    /// @name Faces
    /// @{
    void SetNumVertices(Index count) { _level->numVertices = count; }
    void SetNumFaces(Index count);
    /// By face, to be written once the number of faces is set.
    Index *GetFaceSizes() { return _level->faceFirstCorner.data() + 1; }
    /// Makes offsets of the sizes, and room for the vertices of the faces.
    CallStatus CompleteSizes();
    /// Whether faces may have the vertices that are now in faceVerts.
    CallStatus CheckFaces();
    /// @}

    /// @name Edges: one of these is called
    /// @{
    /// Finds the edges, as Far would.
    CallStatus CompleteTopology();
    /// \brief Takes the edges of \p base, which has the same faces, if they are equal.
    ///
    /// \return  whether it has; else the level has its faces alone, and no vertex twice in any
    bool CompleteTopology(Far::TopologyLevel const &base);
    CallStatus CompleteTopology(Buffer<EdgeSides> edges, std::vector<ApartSide> sides);
    /// @}

    /// @name Tags
    /// A sharpness is 0 or more; those of boundaries and of edges that come apart do not matter.
    /// @{
    Index GetNumBaseEdges() const { return _numBaseEdges; }
    /// An edge of the base between two vertices, INDEX_INVALID if there is none.
    Index FindEdge(Index v0, Index v1) const;
    void SetEdgeSharpness(Index edge, float sharpness);
    void SetVertexSharpness(Index vert, float sharpness);
    void SetHole(Index face, bool isHole);
    void CompleteTags();
    /// @}

    /// \brief Adds a face-varying channel.
    ///
    /// \param faceValues  by corner, each below \p numValues
    CallStatus AddChannel(Index numValues, Buffer<Index> faceValues,
                          Sdc::Options::FVarLinearInterpolation interpolation);

    std::unique_ptr<Hierarchy> Release() { return std::move(_hierarchy); }

private:
    BoundaryKind getBoundary() const {
        bool const isFree =
            _sdcOptions.GetVtxBoundaryInterpolation() == Sdc::Options::VTX_BOUNDARY_NONE;
        return isFree ? kFreeBoundary : kSharpBoundaryA;
    }
    CallStatus checkValences(CallStatus status);
    void findNonManifoldVertices();
    bool isPinned(Index vert) const;
    CallStatus followVertex(Index vert, int channel, Index const *faceValues,
                            std::vector<float> &sharpness) const;

    Sdc::Options _sdcOptions;
    std::unique_ptr<Hierarchy> _hierarchy = std::make_unique<Hierarchy>();
    Level *_level = &_hierarchy->mesh.levels.emplace_back();
    Index _numBaseEdges = 0;
    std::vector<Index> _fannedVerts;   // with several fans
    std::vector<Index> _isolatedVerts; // without faces
    std::vector<Index> _repeatedVerts; // that a face has several times; ascending
};

} // namespace OpenSubdivHex::FarExt::internal

#endif

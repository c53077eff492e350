// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_FOREST_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_FOREST_H

#include "levelTessellation.h"

#include "far_ext/surfaceFaces.h"
#include "far_ext/topologyRefiner.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace OpenSubdivHex::BfrExt {

/// \brief A watertight tessellation of a mesh: a tree of cells for each base face, and a polyline for each edge.
///
/// \code
///     BfrExt::CellForest forest(*refiner);
///     forest.SetTree(face, tree); // some faces, in any order
///     forest.MatchEdges();
///     BfrExt::LevelTessellation const tessellation = forest.GetTessellation(face);
/// \endcode
///
/// After MatchEdges() a face needs nothing of its neighbours.
///
/// Points that faces share are numbered: the base vertices first, in their order, then the inner points of edge 0 in the
/// direction of the edge, then those of edge 1, and so on.  A non-manifold edge has come apart into one edge for each face:
/// these edges get the same polyline, but each its own points.
///
/// Forests are values; one that was moved from can only be assigned to.  Several threads may read a forest, and SetTree() may
/// be called by several for different faces.
/// Arguments are not checked; std::bad_alloc passes through.
class OPENSUBDIVHEX_API CellForest {
public:
    /// A face or an edge of the base mesh.
    using Index = Far::Index;
    /// A point that faces share, of which there may be more than an int counts.
    using Number = std::int64_t;

    /// \brief No face is refined.
    ///
    /// Base faces and edges are those of SurfaceFactory::GetFaces(), of the surface level, to which it refers and
    /// which the refiner has.
    explicit CellForest(FarExt::TopologyRefiner const &refiner);
    /// A copy of all trees and polylines.
    CellForest(CellForest const &other);
    /// \copydoc CellForest(CellForest const &)
    CellForest &operator=(CellForest const &other);
    /// A forest that was moved from can only be assigned to.
    CellForest(CellForest &&other) noexcept;
    /// \copydoc CellForest(CellForest &&)
    CellForest &operator=(CellForest &&other) noexcept;
    ~CellForest();

    /// Base faces and edges.
    FarExt::SurfaceFaces const &GetFaces() const;
    /// Base faces.
    int GetNumFaces() const { return GetFaces().GetNumFaces(); }
    /// Sets the tree of a face, for as many vertices as the face has.
    void SetTree(Index face, CellTree tree);
    /// The tree of a face.
    CellTree const &GetTree(Index face) const;

    /// Sets points that an edge has in addition to those of its faces' cells, in the direction of the edge.
    void SetEdge(Index edge, Polyline polyline);
    /// What SetEdge() was given last.
    Polyline const &GetEdge(Index edge) const;
    /// \brief Finds the polylines of all edges: each gets the points that the trees of its faces have on the edge.
    ///
    /// Call it after SetTree() and SetEdge().  A tree for another number of vertices than its face has is ignored.
    void MatchEdges();
    /// Whether the tree of the face was there when MatchEdges() was called last, and is for as many vertices.
    bool IsMatched(Index face) const;
    /// The polyline of an edge, in the direction of the edge.
    Polyline const &GetPolyline(Index edge) const;
    /// The polylines of the edges of a face, in the direction of the face.
    std::vector<Polyline> GetFacePolylines(Index face) const;
    /// The tessellation of a face; invalid where not IsMatched().
    LevelTessellation
    GetTessellation(Index face,
                    LevelTessellation::Options options = LevelTessellation::Options()) const;
    /// \brief Writes numbers that tell the tessellation of a face, after MatchEdges(): faces with the same numbers have the
    /// same tessellation.
    void GetTessellationKey(Index face, std::vector<int> &key) const;
    /// \brief Finds the faces whose tessellations, GetTessellation(), differ from those in another forest.
    ///
    /// Where positions are the same, the points and facets of all other faces are the same, to the bit: a renderer keeps
    /// them, and takes the patches of these faces from PatchStream::Run().  It uses the threads of FarExt::Executor.
    ///
    /// \param previous  of a mesh with the same faces; both after MatchEdges()
    /// \return          ascending; all faces if \p previous has other counts of faces or edges
    std::vector<Index> FindChangedFaces(CellForest const &previous) const;

    /// Points that faces share, or might share: base vertices and the inner points of edges.
    Number GetNumBoundaryPoints() const;
    /// The first inner point of an edge; those of GetPolyline() follow one another.
    Number GetFirstEdgePoint(Index edge) const;
    /// \brief Writes the numbers of the points on the boundary of a face, in the order of its
    /// tessellation's coordinates: for LevelTessellation::TransformFacetCoordIndices().
    /// \return  how many they are; 0, with nothing written, where GetNumBoundaryPoints() is above 2^31 - 1
    int GetBoundaryPoints(Index face, int points[]) const;

private:
    struct Data;

    std::unique_ptr<Data> _data;
};

} // namespace OpenSubdivHex::BfrExt

#endif

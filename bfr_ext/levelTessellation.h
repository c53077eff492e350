// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_LEVEL_TESSELLATION_H
#define OPENSUBDIVHEX_BFR_EXT_LEVEL_TESSELLATION_H

#include "cellTree.h"
#include "parameterization.h"

#include <memory>

namespace OpenSubdivHex::BfrExt {

namespace internal {
class FaceSections;
class TessellationData;
} // namespace internal

/// \brief A base face cut into facets by levels of refinement, as Bfr::Tessellation cuts it by rates: (u, v) at which a
/// Surface is evaluated, and the facets between them.
///
/// \code
///     BfrExt::LevelTessellation const tessellation(surface.GetParameterization(), 3); // level 3
///     surface.Evaluate(tessellation, control, 3, points, 3);
///     tessellation.GetFacets(facets); // triangles
/// \endcode
///
/// The points are vertices of refined levels, the facets cells: the F-face and the halves of hexagons that these levels
/// have in the face.  At level d = 0, 1, 2 ... an edge has 1, 1, 3, 5, 11, 21, 43 ... segments; each level has the points of
/// the one before.
///
/// Cells are refined to the level of the inside, except those whose refinement would give an edge of the face more points
/// than its level has; or a CellTree says which cells are refined.  A cell beside smaller ones, or beside an edge of a finer
/// level, has their points in its own sides.  So neighbours that take the same level, or Polyline, for their edge fit
/// without gaps, whatever their other levels and trees.
///
/// A PatchStream cuts a face that is too large for its memory into *sections*: polygons in the plane of the face, which fit
/// together as faces do.  The tessellation of a section is a part of the face's, with the same (u, v) and facets.  The one
/// exception: a hexagon between two sections comes as two halves, as hexagons between two faces do.
///
/// Nothing is changed after construction: several threads may use it.  Copies share what it has.  std::bad_alloc
/// passes through.
class OPENSUBDIVHEX_API LevelTessellation {
public:
    /// The last level, of the inside and of edges.
    static constexpr int kLastLevel = CellTree::kLastLevel;

    /// \brief The size of facets, and strides, as in Bfr.
    class Options {
    public:
        /// Triangles, without gaps.
        Options() : _facetSize(3), _facetStride(0), _coordStride(0) {}

        /// \brief Sets the size of facets: 3 for triangles, 4 for cells as they are, where these are
        /// quads, and else triangles with INDEX_INVALID as their last index; 0 for polygons of any
        /// size.
        Options &SetFacetSize(int size) {
            _facetSize = size;
            return *this;
        }
        /// The size that was set.
        int GetFacetSize() const { return _facetSize; }
        /// Sets the distance from one facet to the next, in indices; 0: the size of facets.  Ignored for
        /// polygons.
        Options &SetFacetStride(int stride) {
            _facetStride = stride;
            return *this;
        }
        /// The distance that was set.
        int GetFacetStride() const { return _facetStride; }
        /// Sets the distance from one pair of coordinates to the next, in numbers; 0: 2.
        Options &SetCoordStride(int stride) {
            _coordStride = stride;
            return *this;
        }
        /// The distance that was set.
        int GetCoordStride() const { return _coordStride; }

    private:
        int _facetSize;
        int _facetStride;
        int _coordStride;
    };

    /// \brief One level everywhere, 0 ... kLastLevel.
    ///
    /// The tessellation is invalid for other levels, for an invalid parameterization, for another facet size than 0, 3 and
    /// 4, for a stride less than the size of what it separates, and for cells whose triangles would have more than 2^31 - 1
    /// indices.
    LevelTessellation(Parameterization const &parameterization, int level,
                      Options options = Options());
    /// \brief Levels of the edges and of the inside.
    ///
    /// \param numLevels  1: one level for all; the number of edges: a level for each edge, edge i running from vertex i to
    ///                   the next, and for the inside the largest of them; one more: a level for each edge, then the
    ///                   level of the inside
    LevelTessellation(Parameterization const &parameterization, int numLevels, int const levels[],
                      Options options = Options());

    /// \brief The cells of a tree, beside neighbours with trees of their own.
    ///
    /// It is invalid, too, where a polyline lacks a point that the tree has there.
    ///
    /// \param tree     is copied
    /// \param edges    tree.GetFaceSize() polylines, one for each edge, in the direction of the face: that of the tree
    ///                 (CellTree::GetEdgePolyline()), merged with the neighbour's (Polyline::Merge()); null: those of
    ///                 the tree alone
    /// \param options  the size of facets, and strides
    explicit LevelTessellation(CellTree const &tree, Polyline const edges[] = nullptr,
                               Options options = Options());

    /// Moving copies.
    LevelTessellation(LevelTessellation const &) = default;
    /// \copydoc LevelTessellation(LevelTessellation const &)
    LevelTessellation &operator=(LevelTessellation const &) = default;
    ~LevelTessellation() = default;

    /// A section of a face, as PatchStream makes it.
    LevelTessellation(internal::FaceSections const &sections, int section, Options options);

    /// Whether the arguments were as they have to be.
    bool IsValid() const;

    /// The parameterization of the face.
    Parameterization GetParameterization() const;
    /// Vertices of the face.
    int GetFaceSize() const;
    /// The shape of the face.
    FarExt::FaceShape GetFaceShape() const;
    /// Writes the levels of the edges and of the inside.
    /// \return  how many they are: GetFaceSize() + 1, or 0 of a tree
    int GetLevels(int levels[]) const;
    /// Whether all of them are the same; not of a tree.
    bool IsUniform() const;

    /// How many sections the face is cut into: 1 if it is not.
    int GetNumSections() const;
    /// Which of them this is.
    int GetSection() const;
    /// Edges of the boundary: those of the face, or of the section.  Each edge of a section lies on an
    /// edge of the face, or is that of one other section, too, with the same places.
    int GetNumEdges() const;

    /// @name Coordinates
    /// Points on the boundary come first, from vertex 0 on around the face, or the section: each vertex, then the inner
    /// points of the edge behind it.
    /// @{

    /// All places.
    int GetNumCoords() const;
    /// Numbers from one pair to the next.
    int GetCoordStride() const;
    /// Places on the boundary.
    int GetNumBoundaryCoords() const;
    /// Places inside.
    int GetNumInteriorCoords() const { return GetNumCoords() - GetNumBoundaryCoords(); }
    /// Places of an edge, without its ends.
    int GetNumEdgeCoords(int edge) const {
        return GetVertexPlace(edge + 1) - GetVertexPlace(edge) - 1;
    }
    /// Which of the places a vertex of the boundary is; of the number of edges: GetNumBoundaryCoords().
    int GetVertexPlace(int vertex) const;

    /// Writes u and v of all places, in the parameterization of the face.
    /// \tparam REAL  float or double
    /// \return       how many they are, as do the following
    template <typename REAL>
    int GetCoords(REAL coordTuples[]) const {
        return writeCoords(0, GetNumCoords(), coordTuples);
    }
    /// Writes all places in the plane of FarExt::TopologyLevel::GetFaceBaseCoords(), in which facets can be drawn:
    /// triangles and quads have the same coordinates there, others no sub-faces.
    template <typename REAL>
    int GetPlaneCoords(REAL coordTuples[]) const;
    /// Writes those of the boundary.
    template <typename REAL>
    int GetBoundaryCoords(REAL coordTuples[]) const {
        return writeCoords(0, GetNumBoundaryCoords(), coordTuples);
    }
    /// Writes those inside.
    template <typename REAL>
    int GetInteriorCoords(REAL coordTuples[]) const {
        return writeCoords(GetNumBoundaryCoords(), GetNumCoords(), coordTuples);
    }
    /// Writes that of a vertex of the boundary.
    template <typename REAL>
    int GetVertexCoord(int vertex, REAL coord[]) const {
        int const place = GetVertexPlace(vertex);
        return writeCoords(place, place + 1, coord);
    }
    /// Writes those of an edge, without its ends, from vertex \p edge to the next.
    template <typename REAL>
    int GetEdgeCoords(int edge, REAL coordTuples[]) const {
        return writeCoords(GetVertexPlace(edge) + 1, GetVertexPlace(edge + 1), coordTuples);
    }
    /// @}

    /// @name Facets
    /// They are counter-clockwise in the plane of GetPlaneCoords().
    /// @{

    /// All facets.
    int GetNumFacets() const;
    /// 3, 4, or 0 for polygons.
    int GetFacetSize() const;
    /// Indices from one facet to the next; 0 for polygons.
    int GetFacetStride() const;
    /// The largest size of a facet; 0 where there is none.
    int GetMaxFacetSize() const;
    /// Writes the sizes of all facets.
    /// \return  GetNumFacets()
    int GetFacetSizes(int sizes[]) const;
    /// Sum of the sizes of all facets: what GetFacets() writes of polygons.
    int GetNumFacetVertices() const;
    /// Writes the levels of the cells that the facets are, or lie in.
    /// \return  GetNumFacets()
    int GetFacetLevels(int levels[]) const;
    /// Writes which coordinates the facets have: one facet every GetFacetStride() indices, polygons
    /// one behind the other.
    /// \return  GetNumFacets()
    int GetFacets(int facetTuples[]) const;

    /// Adds an offset to all indices of facets that GetFacets() wrote.
    void TransformFacetCoordIndices(int facetTuples[], int commonOffset) const;
    /// Replaces those of the boundary by \p boundaryIndices, and adds an offset to those inside.
    void TransformFacetCoordIndices(int facetTuples[], int const boundaryIndices[],
                                    int interiorOffset) const;
    /// Replaces those of the boundary and those inside.
    void TransformFacetCoordIndices(int facetTuples[], int const boundaryIndices[],
                                    int const interiorIndices[]) const;
    /// @}

    /// Its data, for the classes of this library.
    internal::TessellationData const &GetData() const { return *_data; }

private:
    template <typename REAL>
    int writeCoords(int begin, int end, REAL coordTuples[]) const;

    std::shared_ptr<internal::TessellationData const> _data; // never null: copied where it is moved
};

} // namespace OpenSubdivHex::BfrExt

#endif

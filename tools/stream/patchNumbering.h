// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_PATCH_NUMBERING_H
#define OPENSUBDIVHEX_TOOLS_PATCH_NUMBERING_H

#include "bfr_ext/patchStream.h"

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

namespace OpenSubdivHex::Tools {

/// \brief Numbers of all points and facets of a stream, whoever makes its patches: what patches share
/// has one number.
///
/// Points of base vertices come first, in the order of these; then those inside of edges, edge by edge,
/// in the direction of the edge (its first face runs so); then those inside of faces, face by face, in
/// the order of their tessellation.  Facets are in the order of faces.  Base vertices and edges without
/// a patch, in holes alone, have no points.
///
/// Faces that come in sections have the vertices of these first, then the points inside of their edges, then
/// those inside of sections, section by section, as their facets are.  So the numbers of such faces depend
/// on PatchStream::Options::SetMaxMemory().
///
/// Each shared point *belongs* to one patch, that of the first face around which is no hole, and of its
/// first section there: who writes the points that belong to its patches, and no others, writes all of
/// them once.
///
/// It takes some numbers for each component of the base mesh, and for each section.  Nothing is changed
/// after construction: several threads may use it.  std::bad_alloc passes through.
class PatchNumbering {
public:
    /// A component of the base mesh.
    using Index = Far::Index;
    /// A point or facet of the stream, of which there may be more than an int counts.
    using Number = std::int64_t;

    /// \brief Numbers the patches of a stream, which it does not need later; its factory must live as
    /// long.
    ///
    /// \return  null on failure: those of PatchStream::Run() for all faces, before any patch
    template <typename REAL>
    static std::unique_ptr<PatchNumbering> Create(BfrExt::PatchStream<REAL> const &stream,
                                                  FarExt::CallStatus *status = nullptr);

    /// Points of all patches.
    Number GetNumPoints() const { return _firstPointOfFace.back(); }
    /// Facets of all patches.
    Number GetNumFacets() const { return _firstFacet.back(); }
    /// Sum of the sizes of all facets.
    Number GetNumFacetVertices() const { return _firstFacetVertex.back(); }
    /// The largest size of a facet.
    int GetMaxFacetSize() const { return _maxFacetSize; }

    /// The first facet of a face; of the number of faces: GetNumFacets().
    Number GetFirstFacet(Index face) const { return _firstFacet[std::size_t(face)]; }
    /// The sum of the sizes of the facets of all faces before.
    Number GetFirstFacetVertex(Index face) const { return _firstFacetVertex[std::size_t(face)]; }
    /// The first point inside of a face.
    Number GetFirstInteriorPoint(Index face) const { return _firstPointOfFace[std::size_t(face)]; }
    /// The first facet of a patch: of a face, or of one of its sections.
    Number GetFirstFacet(Index face, int section) const;
    /// The sum of the sizes of the facets of all patches before, in the same order.
    Number GetFirstFacetVertex(Index face, int section) const;

    /// \brief Places of a patch, one after the other, whose points follow one another.
    struct Run {
        int place;    ///< the first of them
        int count;    ///< how many they are
        int step;     ///< 1, or -1 where they run against the edge that they lie on
        Number point; ///< the point of the first
        bool isOwn;   ///< whether they belong to the patch
    };
    /// \brief Lists the runs of a patch: all of its places, in their order.
    ///
    /// \param face          the base face
    /// \param tessellation  its tessellation in the stream, or that of a section
    /// \param runs          is replaced
    void GetRuns(Index face, BfrExt::LevelTessellation const &tessellation,
                 std::vector<Run> &runs) const;
    /// Writes the point of each place of a patch: tessellation.GetNumCoords() numbers.
    void GetPoints(Index face, BfrExt::LevelTessellation const &tessellation,
                   Number points[]) const;

private:
    class SectionNumbers;

    explicit PatchNumbering(BfrExt::SurfaceFactory const &factory) : _factory(factory) {}

    Index findVertexOwner(Index vert) const;
    Index findEdgeOwner(Index edge) const;
    bool isVertexOwn(Index face, int local) const;
    Run makeEdgeRun(Index face, int local, int place, int first, int count) const;
    SectionNumbers const *findSections(Index face) const;

    BfrExt::SurfaceFactory const &_factory;
    int _maxFacetSize = 0;
    std::vector<Number> _pointOfVertex;
    std::vector<Number> _firstPointOfEdge; // by edge; then their end
    std::vector<Number> _firstPointOfFace;
    std::vector<Number> _firstFacet;
    std::vector<Number> _firstFacetVertex;
    std::map<Index, std::shared_ptr<SectionNumbers const>> _sections; // of faces that come in some
};

} // namespace OpenSubdivHex::Tools

#endif

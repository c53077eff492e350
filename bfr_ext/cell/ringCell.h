// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_RING_CELL_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_RING_CELL_H

#include "sharedRings.h"
#include "vertexRings.h"

#include <memory>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief Vertices that a step makes as sums of the points of rings, in the order of the rings.
class RingPlaces {
public:
    /// Has no places.
    RingPlaces() = default;
    /// \param verts  of the level that the step makes
    /// \param rings  which have all of these
    RingPlaces(std::vector<Far::Index> const &verts, std::vector<RingLayout> const &rings);

    /// \brief By *column*, in the order of rings, which of the vertices it is.
    std::vector<int> const &GetColumns() const { return _columns; }
    std::size_t GetHeapSize() const { return GetHeapSizes(_columns, _places, _ends); }
    /// \brief By column, its place behind the begin of the block of its ring's face 0.
    ///
    /// A ring has places without a column where it has a vertex twice, since two edges join the same
    /// vertices.
    std::vector<int> const &GetPlaces() const { return _places; }
    /// \brief Writes by column which of the points of rings it is.
    ///
    /// \param getPoints  gives by ring its RingPoints, seen from its face 0
    template <typename GET>
    void FindIndices(GET const &getPoints, int *indices) const {
        std::size_t begin = 0;
        for (std::size_t ring = 0; ring < _ends.size(); ++ring) {
            std::size_t const end = _ends[ring];
            findIndices(getPoints(int(ring)), _places.data() + begin, end - begin, indices + begin);
            begin = end;
        }
    }
    /// Weights by column from those by vertex.
    std::vector<double> Order(std::vector<double> const &weights) const;
    /// Appends all that tells them from others.
    void AddKey(std::vector<int> &key) const;

private:
    // Writes which points some places of a ring are, four at a time, the last four of which may be written twice: loops of
    // different lengths cost more than sums.
    static void findIndices(RingPoints const &points, int const *places, std::size_t count,
                            int *to) {
        constexpr std::size_t kStep = 4;
        // Places behind the last point of the ring count from its first one; without a comparison, with which compilers
        // find one place at a time.
        auto const find = [&](int place) {
            int const behind = points.offset + place - points.count;
            return points.first + behind + (points.count & (behind >> 31));
        };
        auto const findFour = [&](std::size_t first) {
            int found[kStep];
            for (std::size_t i = 0; i < kStep; ++i) {
                found[i] = find(places[first + i]);
            }
            std::copy_n(found, kStep, to + first);
        };
        if (count < kStep) {
            std::transform(places, places + count, to, find);
            return;
        }
        for (std::size_t first = 0; first + kStep < count; first += kStep) {
            findFour(first);
        }
        findFour(count - kStep);
    }

    std::vector<int> _columns;
    std::vector<int> _places;
    std::vector<std::size_t> _ends; // by ring, of columns
};

/// \brief A product of the first step of a plain base face: one of its cells, or the long edge of one of its
/// edges, or one of its V-vertices, the points of which are points of rings.
///
/// Rings, and so the sizes of some faces, identify them: there are far fewer of them than types of
/// base faces.
///
/// Where rings have a second step, the masks of cells behind the first one depend on all neighbours of the
/// vertices, and what the second step makes of them does not.  Such a cell has sums of what that makes, and the
/// type of any cell that has the same there; a V-vertex is taken for what it becomes.
class RingCell {
public:
    /// \param points  of the type
    /// \param inner   what the step of the type makes, by row of it, if that is what sums are of
    explicit RingCell(CellType const &type, RingPlaces points, RingPlaces inner = {})
        : _type(type), _points(std::move(points)), _inner(std::move(inner)),
          _patterns(type.GetMemory()) {}

    /// An inner cell may have the type of another one that is equal behind the step: before the step, only the
    /// order of rows is the cell's own.
    CellType const &GetType() const { return _type; }
    /// All that a cell is but its type.
    std::vector<int> GetKey() const;
    /// Whether its sums are of what the step of the type makes, and not of the points of the type.
    bool IsInner() const { return !_inner.GetColumns().empty(); }
    StencilOf GetSources() const { return IsInner() ? StencilOf::Step : StencilOf::Points; }
    /// The places of the cell's points.
    RingPlaces const &GetPlaces() const { return IsInner() ? _inner : _points; }
    std::vector<int> const &GetColumns() const { return GetPlaces().GetColumns(); }
    /// The points of the type.
    RingPlaces const &GetPoints() const { return _points; }
    /// The weights of the surface at a V-vertex, by column.
    template <typename REAL>
    std::vector<REAL> const &GetVertexWeights() const;

    std::size_t GetHeapSize() const { return GetHeapSizes(_points, _inner); }
    /// Its matrices, made on demand.
    PatternTable &GetPatterns() const { return _patterns; }

private:
    CellType const &_type;
    RingPlaces const _points;
    RingPlaces const _inner;
    mutable PatternTable _patterns;
};

/// Product of the first step of an edge of plain base faces, seen from one of them.
struct RingEdge {
    RingCell const *half; ///< the cell on the side of the face
    /// The long edge, as the face runs, and against it.
    RingCell const *longEdges[2];
};

/// Product of the first step of a plain base face.  There are far fewer of them than types of base faces.
struct RingFace {
    explicit RingFace(MemoryCount &memory) : patterns(memory) {}

    std::size_t GetHeapSize() const { return GetHeapSizes(edges, vVertices); }

    RingCell const *whole = nullptr;
    std::vector<RingEdge> edges;
    /// By vertex, and by how many of its faces lie before this one.
    std::vector<std::vector<RingCell const *>> vVertices;
    /// What is made of all of these cells on demand.
    mutable PatternTable patterns;
};

/// The cells of plain base faces with some rules.  Any number of threads may use it.
class RingCells {
public:
    /// Tells rings from others.
    using Key = std::vector<int>;

    RingCells(CellTypes &types, CellRules const &rules)
        : _types(types), _masks(rules, types.GetMemory()), _found(types.GetMemory()),
          _faces(types.GetMemory()), _latticeItems(types.GetMemory()) {}

    CellRules const &GetRules() const { return _masks.GetRules(); }
    RingMasks &GetMasks() { return _masks; }
    MemoryCount &GetMemory() { return _types.GetMemory(); }

    /// \brief Finds a cell by its kind and the rings that tell what it is.
    ///
    /// \param make  gives the cell and, in vertices of the same level, the rings that have its points
    template <typename MAKE>
    RingCell const &Find(FarExt::internal::CellKind kind, Key const &key, MAKE const &make) {
        return *find<RingCell const *>(_found, int(kind), key, [&]() -> RingCell const * {
            auto [cell, layouts] = make();
            return &find(cell, layouts);
        });
    }
    /// Finds what make() gave of a face whose vertices have rings that are told by \p key.
    template <typename MAKE>
    RingFace const &FindFace(Key const &key, MAKE const &make) {
        return *find<std::unique_ptr<RingFace const>>(_faces, 0, key, make);
    }

    /// \brief Returns the first result of make() for a kind of items in the lattice of a size of faces: mostly all
    /// look like it.
    template <typename MAKE>
    CellType const &FindLatticeItem(FarExt::internal::CellKind kind, int faceSize,
                                    MAKE const &make) {
        return *find<CellType const *>(_latticeItems, int(kind), {faceSize}, make);
    }

private:
    template <typename FOUND, typename MAKE>
    static FOUND const &find(PatternTable &table, int kind, Key const &key, MAKE const &make) {
        return table.Get<FOUND>(kind, key.data(), key.data() + key.size(), make);
    }
    std::unique_ptr<RingCell const> make(FarExt::internal::CellPatch const &cell,
                                         std::vector<RingLayout> const &rings);
    RingCell const &find(FarExt::internal::CellPatch const &cell,
                         std::vector<RingLayout> const &rings);

    CellTypes &_types;
    RingMasks _masks;
    PatternTable _found; // pointers, by kind and rings
    PatternTable _faces;
    PatternTable _latticeItems; // pointers to types
};

/// \brief An edge or a vertex of a base face that has rings of its own, since the face itself is not plain or
/// not asked for them.
///
/// It is kept with its type: all faces around a vertex of many, or those of whole strips of edges, share it.
struct RingItem {
    std::size_t GetHeapSize() const { return rings.GetHeapSize(); }

    VertexRings rings;              ///< of the start of the edge and of its end, or of the vertex
    RingCell const *cell = nullptr; ///< null where the edge or vertex is in a lattice, or not plain

    /// Returns the item of a type; \p patch is of this type.
    static RingItem const &Get(CellType const &type, FarExt::internal::CellPatch const &patch,
                               RingCells &cells);
};

/// A plain base face that is not in a lattice, with its rings: those of its vertices in turn, each from
/// the face on.
class FaceRings {
public:
    /// \param cell  the face with its patch
    FaceRings(FarExt::internal::CellPatch const &cell, RingCells &cells);

    VertexRings const &GetRings() const { return _rings; }
    /// What is made on demand: the edges and vertices that are in a lattice.
    PatternTable &GetPatterns() const { return _patterns; }
    /// What all faces with these children share, made on demand: patches.
    PatternTable &GetPatternsOfChildren() const { return _cells->patterns; }
    std::size_t GetHeapSize() const { return internal::GetHeapSize(_rings); }
    /// Whether a vertex and its neighbours are in a regular lattice, or both vertices of an edge.
    bool IsVertexInLattice(int vert) const {
        return _rings.GetRings()[std::size_t(vert)].isInLattice;
    }
    bool IsEdgeInLattice(int edge) const {
        return IsVertexInLattice(edge) &&
               IsVertexInLattice(edge + 1 < int(_cells->edges.size()) ? edge + 1 : 0);
    }
    /// A child of the face, in the order of RefineCell().
    RingCell const &GetChild(std::size_t child) const {
        return child == 0 ? *_cells->whole : *_cells->edges[child - 1].half;
    }
    /// \brief Writes which points of rings a child has.
    ///
    /// \param places     those of the child, or of the points of its type
    /// \param getPoints  gives the RingPoints of a ring, seen from a face
    template <typename GET>
    void FindChildIndices(std::size_t child, RingPlaces const &places, GET const &getPoints,
                          int *indices) const {
        int const numRings = int(_cells->edges.size());
        int const first = child == 0 ? 0 : int(child) - 1;
        places.FindIndices(
            [&](int ring) {
                int const own = first + ring;
                return getPoints(own < numRings ? own : own - numRings, 0);
            },
            indices);
    }

    /// The long edge of an edge, which may run against the face; null where it is in a lattice.
    RingCell const *GetLongEdge(int edge, bool isReversed) const {
        return IsEdgeInLattice(edge)
                   ? nullptr
                   : _cells->edges[std::size_t(edge)].longEdges[isReversed ? 1 : 0];
    }
    /// \brief Writes which points of rings a long edge has.
    ///
    /// \param getPoints  as of FindChildIndices()
    template <typename GET>
    void FindLongEdgeIndices(int edge, bool isReversed, GET const &getPoints, int *indices) const {
        int const next = edge + 1 < int(_cells->edges.size()) ? edge + 1 : 0;
        int const verts[2] = {isReversed ? next : edge, isReversed ? edge : next};
        // The face to the left of the edge is the first of both rings: this one, or that across the edge.
        int const faces[2] = {isReversed ? 1 : 0, isReversed ? -1 : 0};
        GetLongEdge(edge, isReversed)
            ->GetPlaces()
            .FindIndices([&](int ring) { return getPoints(verts[ring], faces[ring]); }, indices);
    }

    /// The V-vertex of a vertex with so many faces before this one; null where it is in a lattice.
    RingCell const *GetVVertex(int vert, int turn) const {
        return IsVertexInLattice(vert) ? nullptr
                                       : _cells->vVertices[std::size_t(vert)][std::size_t(turn)];
    }

private:
    class Maker;

    VertexRings _rings;
    RingFace const *_cells;
    mutable PatternTable _patterns;
};

/// \brief The points that a face has, or an item of a face.
///
/// \tparam REAL  precision
template <typename REAL>
struct RingSources {
    /// Number of a point of the face, or of the mesh.
    Far::Index GetPoint(std::size_t i) const {
        int const ofFace = indices ? indices[i] : int(i);
        return meshPoints ? meshPoints[ofFace] : ofFace;
    }

    REAL const *points;
    std::ptrdiff_t stride; ///< from one to the next, in numbers
    std::size_t size;      ///< of a point
    std::size_t numPoints;
    int const *indices; ///< which points of the face they are, or null: all in turn
    /// Which points of the mesh those of the face are, or null: \c points has those of the face.
    Far::Index const *meshPoints = nullptr;
    /// Of the points of the mesh, or null.
    SharedRings<REAL> *shared = nullptr;
};

/// The points of rings, evaluated when they are asked for.
template <typename REAL>
class RingValues {
public:
    /// \param turns    by ring, of its face 0, from -1 to the number of faces; null: 0
    /// \param sources  of the rings, which must live as long
    void Set(VertexRings const &rings, int const *turns, RingSources<REAL> const &sources);

    std::size_t GetSize() const { return _sources.size; }
    /// From one point to the next.
    std::size_t GetPaddedSize() const { return _paddedSize; }
    /// The points of all rings, of the last step.
    REAL const *GetPoints() {
        for (std::size_t ring = 0; ring < _ownRings.size(); ++ring) {
            find(ring);
        }
        return getPoints();
    }
    /// Where among them those of a ring lie, seen from a face.
    RingPoints GetPointsOfRing(int ring, int face) {
        find(std::size_t(ring));
        OwnRing const &own = _ownRings[std::size_t(ring)];
        RingPoints points = _rings->GetPoints(ring, own.turn, face, _rings->GetLastStep());
        points.first = own.first;
        return points;
    }
    /// Finds which of them a child of the face has that has the rings.
    void FindChildIndices(FaceRings const &face, std::size_t child, std::vector<int> &indices) {
        RingPlaces const &places = face.GetChild(child).GetPlaces();
        indices.resize(places.GetColumns().size());
        face.FindChildIndices(
            child, places, [&](int ring, int ofRing) { return GetPointsOfRing(ring, ofRing); },
            indices.data());
    }
    /// \brief Writes the point of the surface at the vertex of a ring.
    ///
    /// \param vVertex  from the face on that comes first in the vertex's order
    void EvaluateVertex(RingCell const &vVertex, int ring, REAL *result);

private:
    struct OwnRing {
        int turn;
        int first; // point, of the last step; -1: not made
    };

    REAL const *getPoints() const {
        return _sources.shared ? _sources.shared->GetPoints() : _points.data();
    }
    Far::Index getVertex(std::size_t ring) const {
        return _sources.GetPoint(std::size_t(_rings->GetVertex(ring)));
    }
    void find(std::size_t ring);
    REAL const *findForVertex(std::size_t ring);
    REAL *makeOwn(std::size_t ring);
    void make(std::size_t ring, REAL *last);

    VertexRings const *_rings = nullptr;
    RingSources<REAL> _sources = {};
    std::size_t _paddedSize = 0;
    std::vector<OwnRing> _ownRings; // by ring
    bool _hasControlPoints = false;
    std::vector<REAL> _controlPoints;
    std::vector<REAL> _firstStep; // of a ring
    std::vector<REAL> _points;    // of the last step
};

extern template class RingValues<float>;
extern template class RingValues<double>;

} // namespace OpenSubdivHex::BfrExt::internal

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_CELL_PLAN_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_CELL_PLAN_H

#include "cellStencil.h"
#include "placeKernel.h"

#include <map>
#include <memory>
#include <tuple>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief The places of the vertices that a cell has some steps on: those inside of it first, then those
/// on its sides and its corners, since other cells may have these.
class LeafPlaces {
public:
    /// A place in a cell; of no matter in half cells: the sector.
    using Place = SectorPlace<Pair>;

    /// \param shape  of a whole cell; of size 0: of half cells
    LeafPlaces(FaceShape shape, int numSteps);

    int GetNumSteps() const { return _numSteps; }
    std::size_t GetSize() const { return _places.size(); }
    Place const &operator[](std::size_t row) const { return _places[row]; }
    std::vector<Place> const &GetAll() const { return _places; }
    std::size_t Find(Place const &place) const { return _rows.at(getKey(place)); }

private:
    using Key = std::tuple<int, double, double>;

    // The groups of places that half cells have, in their order.
    enum Group { kInside, kLastSide, kFirstCorner, kFirstSide, kSecondSide, kThirdSide, kCorners };

    Key getKey(Place const &place) const;
    static Group findGroup(Pair const &coords);
    void add(Place const &place);
    void refine(CellOutline<Pair> const &root, int numSteps);

    FaceShape const _shape;
    int const _numSteps;
    std::vector<Place> _places;
    std::map<Key, std::size_t> _rows;
};

/// Sorts runs by their rows, and joins those that follow one another.
void JoinRuns(std::vector<PlaceRun> &runs);

/// \brief Which cells the places inside of a base face lie in: a base face is taken apart step by step
/// into *leaves*, cells whose places are made at once, by a dense matrix of the cell's type
/// (PlaceMatrix).
///
/// A place that several leaves have belongs to that which CellStencil follows it to, so that it is made
/// once.  Derivatives are those of the first cell that has the place as a corner, as far as that makes a
/// difference.  Base faces in lattices are leaves themselves as long as their places are few; others are not: there are
/// many types of these, and few of the cells in them.
///
/// Beside vertices of many faces a matrix would have a column for each of hundreds of points, and each face there has
/// types of its own: leaves of such types are *taken apart* by further steps, whose matrices are sparse.
class CellPlan {
public:
    /// A place that is a corner of a cell.
    struct CornerPlace {
        std::size_t corner;
        int place;
        Pair toCoords[2]; ///< of u and v: the derivatives by them of what the corner's are by
    };
    struct Apart;
    /// A cell with places, and which child of the cell before it is.
    struct Node {
        std::size_t child = 0;
        bool isWhole = true;
        int depth = 0;
        int numSteps = 0; ///< that are left
        /// Derivatives of the leaf's coordinates by u and v: coordinates in a half cell, or the whole cell's own u and v.
        Pair toCoords[2] = {{1, 0}, {0, 1}};
        std::vector<std::size_t> children = {};
        /// For leaves: their places, and the rows that the plan's places have, ascending; a base face may have none.
        LeafPlaces const *leaf = nullptr;
        std::vector<PlaceRun> runs = {};
        /// The corners of cells that are no leaves, in plans for derivatives and where no steps are left.
        std::vector<CornerPlace> corners = {};
        std::shared_ptr<Apart> apart = {}; ///< of leaves with steps left
    };
    /// Points inside of the face, all points, or derivatives.
    enum class Use { Points, AllPoints, Derivatives };

    /// \param shape        of a whole cell; of size 0: of half cells
    /// \param level        that of the places, at most
    /// \param places       with Use::Points, those on the border of the face are made apart
    /// \param isInLattice  whether many faces are of the type of the base face; of half cells: true
    CellPlan(FaceShape shape, int level, std::vector<LeafPlaces::Place> const &places, Use use,
             bool isInLattice);

    /// Whether it is for derivatives.
    bool HasDerivatives() const { return _use == Use::Derivatives; }
    /// Whether no place is in a child of node 0, nor at a corner of it.
    bool IsEmpty() const { return _nodes[0].corners.empty() && _nodes[0].children.empty(); }
    /// Node 0 is the face, or the cell.
    Node const &operator[](std::size_t node) const { return _nodes[node]; }
    /// \brief The plan of a leaf's places whose leaves are its children, or else have the places at their corners; made
    /// when it is first asked for.
    ///
    /// Any number of threads may ask.
    ///
    /// \param leaf  of this plan, with steps left
    CellPlan const &TakeApart(Node const &leaf) const;

private:
    CellPlan(CellPlan const &plan, Node const &leaf);
    void addPlace(LeafPlaces::Place place, Pair const (&toCoords)[2], int number);
    void finish();
    bool addCorner(std::size_t node, LeafPlaces::Place const &place, Pair const (&toCoords)[2],
                   int number);
    void setLeaf(Node &node);
    std::size_t findChild(std::size_t node, CellStep const &step, Pair const (&toCoords)[2]);

    FaceShape const _shape;
    Use const _use;
    bool const _isOfLeaf; // one that is taken apart
    std::vector<Node> _nodes;
    std::map<int, std::unique_ptr<LeafPlaces const>> _wholePlaces; // by steps
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif

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
/// on each of its sides, and its corners, since other cells may have these.
class LeafPlaces {
public:
    /// A place in a cell; of no matter in half cells: the sector.
    struct Place {
        int sector;
        Pair coords;
    };

    /// \param faceSize  of a whole cell; 0: of half cells
    LeafPlaces(int faceSize, int numSteps);

    int GetNumSteps() const { return _numSteps; }
    std::size_t GetSize() const { return _places.size(); }
    Place const &operator[](std::size_t row) const { return _places[row]; }
    std::size_t Find(Place const &place) const { return _rows.at(getKey(place)); }

private:
    using Key = std::tuple<int, double, double>;

    Key getKey(Place const &place) const;
    static int findGroup(Pair const &coords);
    void add(Place const &place);
    void refineWhole(double scale, int numSteps);
    void refineHalf(int sector, std::array<Pair, 4> const &corners, int numSteps);

    int const _faceSize;
    int const _numSteps;
    std::vector<Place> _places;
    std::map<Key, std::size_t> _rows;
};

/// \brief Which cells the places inside of a base face lie in: a base face is taken apart step by step
/// into *leaves*, cells whose places are made at once, by a dense matrix of the cell's type
/// (PlaceMatrix).
///
/// A place that several leaves have belongs to that which CellStencil follows it to, so that it is made
/// once.  No base face is a leaf: there are many types of these, and few of the cells in them.
class CellPlan {
public:
    /// A cell with places, and which child of the cell before it is.
    struct Node {
        std::size_t child;
        bool isWhole;
        int numSteps; ///< that are left
        std::vector<std::size_t> children;
        /// Of leaves, with the rows that are of places, ascending.
        LeafPlaces const *leaf;
        std::vector<PlaceOfRow> rows;
    };

    /// \param level   that of the places, at most
    /// \param places  those inside of the face, from place number \p first on
    CellPlan(int faceSize, int level, std::vector<LeafPlaces::Place> const &places, int first);

    /// Node 0 is the face.
    Node const &operator[](std::size_t node) const { return _nodes[node]; }
    /// Memory, in bytes.
    std::size_t GetSize() const;

private:
    std::size_t findChild(std::size_t node, CellStep const &step);

    int const _faceSize;
    std::vector<Node> _nodes;
    std::map<std::pair<int, int>, std::unique_ptr<LeafPlaces const>> _leafPlaces;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif

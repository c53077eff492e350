// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_CELL_PLAN_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_CELL_PLAN_H

#include "cellStencil.h"

#include <map>
#include <memory>
#include <tuple>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief The places of the vertices that a cell has some steps on, in groups of which a user may want
/// some: those inside of it, on each of its sides, and its corners.
///
/// A whole cell, which no other shares its sides with, has one group.
class LeafPlaces {
public:
    static constexpr std::size_t kNumGroups = 9;

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
    /// The first place of a group; of kNumGroups: their end.
    std::size_t GetFirst(std::size_t group) const { return _groupFirsts[group]; }

private:
    using Key = std::tuple<int, double, double>;

    Key getKey(Place const &place) const;
    static std::size_t findGroup(Pair const &coords);
    void add(Place const &place);
    void refineWhole(double scale, int numSteps);
    void refineHalf(int sector, std::array<Pair, 4> const &corners, int numSteps);

    int const _faceSize;
    int const _numSteps;
    std::vector<Place> _places;
    std::map<Key, std::size_t> _rows;
    std::size_t _groupFirsts[kNumGroups + 1];
};

/// \brief Which cells the places inside of a base face lie in: a base face is taken apart step by step
/// into *leaves*, cells whose places are made at once, by a dense matrix of the cell's type
/// (LeafMatrix).
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
        /// Of leaves: the places of rows, or -1; and which groups have any, bit by bit.
        LeafPlaces const *leaf;
        std::vector<int> placesOfRows;
        unsigned groups;
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

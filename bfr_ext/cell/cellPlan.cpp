// SPDX-License-Identifier: Apache-2.0
#include "cellPlan.h"

#include <algorithm>
#include <cmath>

namespace OpenSubdivHex::BfrExt::internal {

namespace {

// Matrices with more rows than this makes leave the cache, and those with fewer are taken too often.
constexpr int kNumStepsOfHalves = 4;
constexpr int kNumStepsOfWholes = 3;
constexpr int kNumStepsOfFaces = 5; // in lattices

// Sorts runs by their rows, and joins those that follow one another.
void joinRuns(std::vector<PlaceRun> &runs) {
    std::sort(runs.begin(), runs.end(),
              [](PlaceRun const &a, PlaceRun const &b) { return a.row < b.row; });
    std::size_t numJoined = 0;
    for (PlaceRun const &run : runs) {
        if (numJoined > 0) {
            PlaceRun &last = runs[numJoined - 1];
            if (run.row == last.row + last.count && run.place == last.place + last.count &&
                run.row % PlaceRun::kMaxBlock != 0) {
                last.count += run.count;
                continue;
            }
        }
        runs[numJoined++] = run;
    }
    runs.resize(numJoined);
    runs.shrink_to_fit();
}

} // namespace

LeafPlaces::LeafPlaces(FaceShape shape, int numSteps) : _shape(shape), _numSteps(numSteps) {
    if (shape.size > 0) {
        for (int corner = 0; corner < shape.size; ++corner) {
            add(PlaceOnEdge<Pair>(shape, corner, 1.0, 0.0));
        }
        refine({-1, {{{1, 0}}}}, numSteps);
        // Points on the sides come last: tessellations have them apart, or first.
        std::stable_partition(_places.begin(), _places.end(), [&](Place const &place) {
            return FindOnEdge(shape, place, 1.0).edge < 0;
        });
    } else {
        for (Pair const &corner : HalfCell::kCorners) {
            add({0, corner});
        }
        refine({0,
                {HalfCell::kCorners[0], HalfCell::kCorners[1], HalfCell::kCorners[2],
                 HalfCell::kCorners[3]}},
               numSteps);
        std::stable_sort(_places.begin(), _places.end(), [&](Place const &a, Place const &b) {
            Group const group = findGroup(a.coords);
            Group const other = findGroup(b.coords);
            // Along the first side they are in the order in which edges have them.
            return group != other ? group < other
                                  : group == kFirstSide && a.coords[0] < b.coords[0];
        });
    }
    for (std::size_t row = 0; row < _places.size(); ++row) {
        _rows[getKey(_places[row])] = row;
    }
}

// On the line from the centre to a corner, the sector is that which begins there.
LeafPlaces::Key LeafPlaces::getKey(Place const &place) const {
    Place const name = _shape.size > 0 ? NameOf(_shape, place) : place;
    return {name.sector, name.coords[0], name.coords[1]};
}

// Rows that are wanted are mostly the first ones: of what is not inside, cells have the last side most.
LeafPlaces::Group LeafPlaces::findGroup(Pair const &coords) {
    double const x = coords[0];
    double const h = coords[1];
    auto const *const corner =
        std::find(std::begin(HalfCell::kCorners), std::end(HalfCell::kCorners), coords);
    if (corner != std::end(HalfCell::kCorners)) {
        return corner == std::begin(HalfCell::kCorners) ? kFirstCorner : kCorners;
    }
    if (h == 0) {
        return kFirstSide;
    }
    if (h == 0.5) {
        return kThirdSide;
    }
    return x == 0.5 * h ? kLastSide : x == 1 - 0.5 * h ? kSecondSide : kInside;
}

void LeafPlaces::add(Place const &place) {
    if (_rows.emplace(getKey(place), 0).second) {
        // Derivatives are from the side of the sector that begins at the line.
        _places.push_back(_shape.size > 0 ? NameOf(_shape, place) : place);
    }
}

// Level by level, since tessellations have places in that order.
void LeafPlaces::refine(Cell const &root, int numSteps) {
    std::vector<Cell> cells = {root};
    for (; numSteps > 0; --numSteps) {
        std::vector<Cell> children;
        for (Cell const &cell : cells) {
            if (cell.sector < 0) {
                double const scale = cell.corners[0][0];
                children.push_back({-1, {{{scale / 2, 0}}}});
                for (int corner = 0; corner < _shape.size; ++corner) {
                    add(PlaceOnEdge<Pair>(_shape, corner, scale / 2, 0.0));
                    if (corner >= _shape.GetFirstSector()) {
                        children.push_back({corner, HalfCell::GetCornersAtEdge<Pair>(scale)});
                    }
                }
                continue;
            }
            for (std::size_t i = 0; i < 4; ++i) {
                children.push_back({cell.sector, HalfCell::GetCornersOfChild(cell.corners, i)});
            }
            for (Pair const &inner : children[children.size() - 4].corners) {
                add({cell.sector, inner});
            }
        }
        cells.swap(children);
    }
}

CellPlan::CellPlan(FaceShape shape, int level, std::vector<LeafPlaces::Place> const &places,
                   Use use, bool isInLattice)
    : _shape(shape) {
    _nodes.push_back({0, true, 0, level, {}, nullptr, {}, {{1, 0}, {0, 1}}, {}});
    if (isInLattice && level <= kNumStepsOfFaces) {
        setLeaf(_nodes[0]);
    }
    for (std::size_t i = 0; i < places.size(); ++i) {
        LeafPlaces::Place place = places[i];
        if (use == Use::Points && FindOnEdge(shape, place, 1.0).edge >= 0) {
            continue;
        }
        BasePoint const base = MakeBasePoint(shape, place.sector, place.coords);
        Pair toCoords[2] = {base.toCoords[0], base.toCoords[1]};
        std::size_t node = 0;
        bool isCorner = false;
        while (!_nodes[node].leaf) {
            isCorner = use == Use::Derivatives && addCorner(node, place, toCoords, int(i));
            if (isCorner) {
                break;
            }
            CellStep const step = FindCellStep(_nodes[node].isWhole ? shape : FaceShape(),
                                               place.sector, place.coords);
            place.coords = step.map->Apply(place.coords);
            Pair const before[2] = {toCoords[0], toCoords[1]};
            for (std::size_t k = 0; k < 4; ++k) {
                toCoords[k / 2][k % 2] = step.map->rows[k / 2][0] * before[0][k % 2] +
                                         step.map->rows[k / 2][1] * before[1][k % 2];
            }
            node = findChild(node, step, toCoords);
        }
        if (isCorner) {
            continue;
        }
        Node &leaf = _nodes[node];
        if (!leaf.isWhole) {
            place.sector = 0;
        }
        leaf.runs.push_back({int(leaf.leaf->Find(place)), int(i), 1});
    }
    for (Node &node : _nodes) {
        joinRuns(node.runs);
        node.corners.shrink_to_fit();
    }
    _nodes.shrink_to_fit();
}

// Adds a place to the corners of a cell, or returns false where it is none.
bool CellPlan::addCorner(std::size_t node, LeafPlaces::Place const &place,
                         Pair const (&toCoords)[2], int number) {
    Node &cell = _nodes[node];
    int const corner =
        FindCellCorner(cell.isWhole ? _shape : FaceShape(), place.sector, place.coords);
    if (corner < 0) {
        return false;
    }
    CornerPlace result = {std::size_t(corner), number, {toCoords[0], toCoords[1]}};
    if (cell.isWhole) {
        // The corner has the coordinates of its own sector.
        BasePoint const own = MakeBasePoint(_shape, _shape.GetSectorOfCorner(corner), {});
        for (std::size_t i = 0; i < 2; ++i) {
            for (std::size_t k = 0; k < 2; ++k) {
                result.toCoords[i][k] = std::ldexp(own.toCoords[i][k], cell.depth);
            }
        }
    }
    cell.corners.push_back(result);
    return true;
}

// The derivatives are those of the coordinates in it, if it is a half cell.
std::size_t CellPlan::findChild(std::size_t node, CellStep const &step, Pair const (&toCoords)[2]) {
    for (std::size_t const child : _nodes[node].children) {
        if (_nodes[child].child == step.child) {
            return child;
        }
    }
    Node child = {step.child,
                  step.isChildWhole,
                  _nodes[node].depth + 1,
                  _nodes[node].numSteps - 1,
                  {},
                  nullptr,
                  {},
                  {toCoords[0], toCoords[1]},
                  {}};
    if (child.isWhole) {
        double const scale = std::ldexp(1.0, child.depth);
        child.toCoords[0] = {scale, 0};
        child.toCoords[1] = {0, scale};
    }
    if (child.numSteps <= (child.isWhole ? kNumStepsOfWholes : kNumStepsOfHalves)) {
        setLeaf(child);
    }
    _nodes[node].children.push_back(_nodes.size());
    _nodes.push_back(std::move(child));
    return _nodes.size() - 1;
}

void CellPlan::setLeaf(Node &node) {
    FaceShape const shape = node.isWhole ? _shape : FaceShape();
    std::unique_ptr<LeafPlaces const> &leafPlaces = _leafPlaces[{shape, node.numSteps}];
    if (!leafPlaces) {
        leafPlaces = std::make_unique<LeafPlaces>(shape, node.numSteps);
    }
    node.leaf = leafPlaces.get();
}

} // namespace OpenSubdivHex::BfrExt::internal

// SPDX-License-Identifier: Apache-2.0
#include "cellPlan.h"

#include <algorithm>
#include <cmath>
#include <mutex>

namespace OpenSubdivHex::BfrExt::internal {

namespace {

// Matrices with more rows than this makes leave the cache, and those with fewer are taken too often.
constexpr int kNumStepsOfHalves = 4;
constexpr int kNumStepsOfWholes = 3;
constexpr int kNumStepsOfFaces = 5; // in lattices

LeafPlaces const &getHalfPlaces(int numSteps) {
    static std::array<LeafPlaces, kNumStepsOfHalves + 1> const kPlaces = {
        LeafPlaces(FaceShape(), 0), LeafPlaces(FaceShape(), 1), LeafPlaces(FaceShape(), 2),
        LeafPlaces(FaceShape(), 3), LeafPlaces(FaceShape(), 4)};
    return kPlaces[std::size_t(numSteps)];
}

} // namespace

void JoinRuns(std::vector<PlaceRun> &runs) {
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

struct CellPlan::Apart {
    std::once_flag once;
    std::unique_ptr<CellPlan const> plan;
};

LeafPlaces::LeafPlaces(FaceShape shape, int numSteps) : _shape(shape), _numSteps(numSteps) {
    auto const root = CellOutline<Pair>::MakeRoot(shape);
    for (int corner = 0; corner < root.GetNumCorners(shape); ++corner) {
        add(root.GetCorner(shape, corner));
    }
    refine(root, numSteps);
    if (shape.size > 0) {
        // Points on the sides come last: tessellations have them apart, or first.
        std::stable_partition(_places.begin(), _places.end(), [&](Place const &place) {
            return FindOnEdge(shape, place, 1.0).edge < 0;
        });
    } else {
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
void LeafPlaces::refine(CellOutline<Pair> const &root, int numSteps) {
    std::vector<CellOutline<Pair>> cells = {root};
    for (; numSteps > 0; --numSteps) {
        std::vector<CellOutline<Pair>> children;
        for (CellOutline<Pair> const &cell : cells) {
            for (int i = 0; i < cell.GetNumChildren(_shape); ++i) {
                children.push_back(cell.GetChild(_shape, i));
                // Only the first child has corners that the cell has not.
                for (int corner = 0; i == 0 && corner < cell.GetNumCorners(_shape); ++corner) {
                    add(children.back().GetCorner(_shape, corner));
                }
            }
        }
        cells.swap(children);
    }
}

CellPlan::CellPlan(FaceShape shape, int level, std::vector<LeafPlaces::Place> const &places,
                   Use use, bool isInLattice)
    : _shape(shape), _use(use), _isOfLeaf(false) {
    _nodes.push_back({0, shape.size > 0, 0, level});
    if (isInLattice && level <= kNumStepsOfFaces) {
        setLeaf(_nodes[0]);
    }
    for (std::size_t i = 0; i < places.size(); ++i) {
        LeafPlaces::Place const &place = places[i];
        if (use != Use::Points || FindOnEdge(shape, place, 1.0).edge < 0) {
            BasePoint const point = shape.size > 0
                                        ? MakeBasePoint(shape, place.sector, place.coords)
                                        : BasePoint{0, place.coords, {{1, 0}, {0, 1}}};
            addPlace(place, point.toCoords, int(i));
        }
    }
    finish();
}

CellPlan::CellPlan(CellPlan const &plan, Node const &leaf)
    : _shape(plan._shape), _use(plan._use), _isOfLeaf(true) {
    _nodes.push_back(
        {0, leaf.isWhole, leaf.depth, leaf.numSteps, {leaf.toCoords[0], leaf.toCoords[1]}});
    for (PlaceRun const &run : leaf.runs) {
        for (int i = 0; i < run.count; ++i) {
            LeafPlaces::Place const &place = (*leaf.leaf)[std::size_t(run.row) + std::size_t(i)];
            Pair toCoords[2] = {leaf.toCoords[0], leaf.toCoords[1]};
            if (leaf.isWhole) {
                std::copy_n(MakeBasePoint(_shape, place.sector, place.coords, leaf.depth).toCoords,
                            2, toCoords);
            }
            addPlace(place, toCoords, run.place + i);
        }
    }
    finish();
}

CellPlan const &CellPlan::TakeApart(Node const &leaf) const {
    std::call_once(leaf.apart->once, [&] { leaf.apart->plan.reset(new CellPlan(*this, leaf)); });
    return *leaf.apart->plan;
}

// Adds a place of node 0, with the derivatives of its coordinates by u and v.
void CellPlan::addPlace(LeafPlaces::Place place, Pair const (&toCoords)[2], int number) {
    Pair ofNode[2] = {toCoords[0], toCoords[1]};
    std::size_t node = 0;
    while (!_nodes[node].leaf) {
        bool const mayBeCorner = _use == Use::Derivatives || _nodes[node].numSteps == 0;
        if (mayBeCorner && addCorner(node, place, ofNode, number)) {
            return;
        }
        CellStep const step =
            FindCellStep(_nodes[node].isWhole ? _shape : FaceShape(), place.sector, place.coords);
        place.coords = step.map->Apply(place.coords);
        Multiply(step.map->rows, ofNode, ofNode);
        node = findChild(node, step, ofNode);
    }
    Node &leaf = _nodes[node];
    if (!leaf.isWhole) {
        place.sector = 0;
    }
    leaf.runs.push_back({int(leaf.leaf->Find(place)), number, 1});
}

void CellPlan::finish() {
    for (Node &node : _nodes) {
        JoinRuns(node.runs);
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
        std::copy_n(MakeCornerPoint(_shape, corner, cell.depth).toCoords, 2, result.toCoords);
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
                  {toCoords[0], toCoords[1]}};
    if (child.isWhole) {
        double const scale = std::ldexp(1.0, child.depth);
        child.toCoords[0] = {scale, 0};
        child.toCoords[1] = {0, scale};
    }
    // A leaf that is taken apart has only corners in the end.
    int const maxNumSteps = child.isWhole ? kNumStepsOfWholes : kNumStepsOfHalves;
    if (child.numSteps <= maxNumSteps && !(_isOfLeaf && child.numSteps == 0)) {
        setLeaf(child);
    }
    _nodes[node].children.push_back(_nodes.size());
    _nodes.push_back(std::move(child));
    return _nodes.size() - 1;
}

void CellPlan::setLeaf(Node &node) {
    if (node.isWhole) {
        std::unique_ptr<LeafPlaces const> &places = _wholePlaces[node.numSteps];
        if (!places) {
            places = std::make_unique<LeafPlaces>(_shape, node.numSteps);
        }
        node.leaf = places.get();
    } else {
        node.leaf = &getHalfPlaces(node.numSteps);
    }
    if (node.numSteps > 0) {
        node.apart = std::make_shared<Apart>();
    }
}

} // namespace OpenSubdivHex::BfrExt::internal

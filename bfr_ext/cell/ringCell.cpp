// SPDX-License-Identifier: Apache-2.0
#include "ringCell.h"

#include "patchCorners.h"

#include <algorithm>
#include <cassert>
#include <optional>

namespace OpenSubdivHex::BfrExt::internal {

using FarExt::internal::CellKind;
using FarExt::internal::CellPatch;
using FarExt::internal::CellRefinement;

namespace {

using Cell = std::pair<CellPatch, std::vector<RingLayout>>;

// The place of the vertex of a ring; others are behind the begin of the block of face 0.
constexpr int kRingCenter = -1;

CellRefinement refine(CellPatch const &cell, CellRules const &rules) {
    return RefineCell(cell, rules.sdcOptions, rules.hexSchemeOptions, rules.interpolation);
}

// The vertices of the level that a step makes, by row of it.
std::vector<Far::Index> findStepVertices(CellRefinement const &refinement) {
    std::vector<Far::Index> verts(refinement.step.firsts.size() - 1);
    for (std::size_t child = 0; child < refinement.children.size(); ++child) {
        std::vector<Far::Index> const &sources = refinement.children[child].patch.sources;
        for (std::size_t i = 0; i < sources.size(); ++i) {
            verts[std::size_t(refinement.rows[child][i])] = sources[i];
        }
    }
    return verts;
}

// Tells the cells that rings of the first step make: the sizes of faces, and the vertices, by when they occur first.
RingCells::Key findKey(std::vector<RingLayout> const &rings) {
    RingCells::Key key;
    std::vector<int> numbers; // by vertex
    int numVerts = 0;
    auto const addVertex = [&](int vert) {
        auto const place = std::size_t(vert);
        numbers.resize(std::max(numbers.size(), place + 1), -1);
        if (numbers[place] < 0) {
            numbers[place] = numVerts++;
        }
        key.push_back(numbers[place]);
    };
    for (RingLayout const &ring : rings) {
        key.push_back(int(ring.faceSizes.size()));
        key.insert(key.end(), ring.faceSizes.begin(), ring.faceSizes.end());
        addVertex(ring.center);
        std::for_each(ring.verts.begin(), ring.verts.end(), addVertex);
        key.insert(key.end(), ring.flags.begin(), ring.flags.end());
    }
    return key;
}

// Tells the rings of a plain base face: the faces at its vertices, which come first in its patch.
RingCells::Key findKey(CellPatch const &cell, PatchCorners const &corners, bool hasFlags) {
    int const numEdges = cell.GetNumCorners();
    RingCells::Key key;
    std::vector<int> ring;
    int first = 0;
    for (int const size : cell.patch.faceSizes) {
        int const *const verts = &cell.patch.faceVerts[std::size_t(first)];
        if (std::all_of(verts, verts + size, [&](int vert) { return vert >= numEdges; })) {
            break;
        }
        key.push_back(size);
        key.insert(key.end(), verts, verts + size);
        for (int i = 0; hasFlags && i < size; ++i) {
            key.push_back(corners.FindFlag(first + i, ring));
        }
        first += size;
    }
    return key;
}

// Product of the first step of an edge or a vertex.
Cell makeItemCell(CellPatch const &item, CellRules const &rules) {
    return {std::move(refine(item, rules).children[0]),
            FindRingLayouts(item.patch, item.locals, false)};
}

CellKind getChildKind(CellKind kind) { return kind == CellKind::Edge ? CellKind::LongEdge : kind; }

} // namespace

// Most points are in several rings.  What is in the first two is taken from there, and the rest from where
// its place is the least, which does not depend on the numbers of faces in these rings.
RingPlaces::RingPlaces(std::vector<Far::Index> const &verts, std::vector<RingLayout> const &rings) {
    constexpr int kNumFirstRings = 2;
    struct Column {
        int ring;
        int place;
        int point;
    };
    std::vector<Column> columns;
    for (std::size_t point = 0; point < verts.size(); ++point) {
        int const vert = verts[point];
        Column column = {-1, 0, int(point)};
        if (vert == rings[0].center) {
            column = {0, kRingCenter, int(point)};
        }
        for (int ring = 0; ring < int(rings.size()); ++ring) {
            std::vector<int> const &ofRing = rings[std::size_t(ring)].verts;
            int const place = int(std::find(ofRing.begin(), ofRing.end(), vert) - ofRing.begin());
            if (place < int(ofRing.size()) &&
                (column.ring < 0 || (column.ring >= kNumFirstRings && place < column.place))) {
                column = {ring, place, int(point)};
            }
        }
        assert(column.ring >= 0);
        columns.push_back(column);
    }
    std::sort(columns.begin(), columns.end(), [](Column const &a, Column const &b) {
        return std::make_pair(a.ring, a.place) < std::make_pair(b.ring, b.place);
    });
    assert(columns[0].place == kRingCenter);
    for (Column const &column : columns) {
        _columns.push_back(column.point);
        _ends.resize(std::size_t(column.ring) + 1, _places.size());
        if (column.place != kRingCenter) {
            _places.push_back(column.place);
            ++_ends.back();
        }
    }
}

void RingPlaces::Order(std::vector<double> const &weights, std::vector<double> &result) const {
    result.resize(_columns.size());
    for (std::size_t column = 0; column < _columns.size(); ++column) {
        result[column] = weights[std::size_t(_columns[column])];
    }
}

template <typename REAL>
std::vector<REAL> const &RingCell::GetVertexWeights() const {
    return _patterns.Get<std::vector<REAL>>(
        PatternTable::GetKind<REAL>(PatternOf::VertexWeights), nullptr, nullptr, [&] {
            std::vector<double> weights;
            GetPlaces().Order(_type.GetCornerPoints()[0], weights);
            return std::vector<REAL>(weights.begin(), weights.end());
        });
}

void RingPlaces::AddKey(std::vector<int> &key) const {
    key.insert(key.end(), _columns.begin(), _columns.end());
    key.insert(key.end(), _places.begin(), _places.end());
    key.insert(key.end(), _ends.begin(), _ends.end());
}

std::vector<int> RingCell::GetKey() const {
    std::vector<int> key;
    _points.AddKey(key);
    _inner.AddKey(key);
    return key;
}

std::unique_ptr<RingCell const> RingCells::make(CellPatch cell,
                                                std::vector<RingLayout> const &rings) {
    RingPlaces points(cell.patch.sources, rings);
    if (!_masks.AreUsed()) {
        CellType const &type = _types.Find(std::move(cell), GetRules());
        return std::make_unique<RingCell const>(type, RingStep::First, std::move(points));
    }
    CellRefinement refinement = refine(cell, GetRules());
    std::vector<RingLayout> const inner = FindInnerLayouts(cell.patch, rings);
    if (cell.kind == CellKind::Vertex) {
        points = RingPlaces(refinement.children[0].patch.sources, inner);
        CellType const &type = _types.Find(std::move(refinement.children[0]), GetRules());
        return std::make_unique<RingCell const>(type, RingStep::Second, std::move(points));
    }
    RingPlaces ofStep(findStepVertices(refinement), inner);
    CellType const &type = _types.Find(std::move(cell), GetRules());
    return std::make_unique<RingCell const>(type, std::move(points), std::move(ofStep));
}

// Rings that differ only where the cell does not depend on them are equal.
RingCell const &RingCells::find(CellPatch cell, std::vector<RingLayout> const &rings) {
    std::unique_ptr<RingCell const> ringCell = make(std::move(cell), rings);
    CellType const &type = ringCell->GetType();
    std::vector<int> const key = ringCell->GetKey();
    constexpr int kKind = PatternTable::GetKind<double>(PatternOf::RingCell);
    return *type.GetPatterns().Get<std::unique_ptr<RingCell const>>(
        kKind, key.data(), key.data() + key.size(), [&] { return std::move(ringCell); });
}

RingItem const &RingItem::Get(CellType const &type, CellPatch const &patch, RingCells &cells) {
    constexpr int kKind = PatternTable::GetKind<double>(PatternOf::RingItem);
    return type.GetPatterns().Get<RingItem>(kKind, nullptr, nullptr, [&] {
        RingItem item;
        bool const isPlain =
            item.rings.Init(PatchCorners(patch.patch), patch.locals, cells.GetMasks());
        auto const &ofItem = item.rings.GetRings();
        bool const isInLattice = std::all_of(ofItem.begin(), ofItem.end(),
                                             [](Ring const &ring) { return ring.isInLattice; });
        if (!isPlain || isInLattice) {
            return RingItem();
        }
        item.cell = &cells.Find(
            getChildKind(patch.kind),
            findKey(FindRingLayouts(patch.patch, patch.locals, cells.GetMasks().AreUsed())),
            [&] { return makeItemCell(patch, cells.GetRules()); });
        return item;
    });
}

// Makes the cells of a face.
class FaceRings::Maker {
public:
    Maker(CellPatch const &cell, RingCells &cells)
        : _cell(cell), _cells(cells), _numEdges(cell.GetNumCorners()),
          _layouts(FindRingLayouts(cell.patch, cell.locals, cells.GetMasks().AreUsed())) {}

    RingFace Make() {
        RingFace face = {&findChild(CellKind::Whole, findKey(_layouts), 0, 0), {}, {}};
        for (int i = 0; i < _numEdges; ++i) {
            face.edges.push_back(makeEdge(i));
            face.vVertices.push_back(makeVVertices(i));
        }
        face.edges.shrink_to_fit();
        face.vVertices.shrink_to_fit();
        return face;
    }

private:
    RingLayout const &getLayout(int vert) const { return _layouts[std::size_t(vert % _numEdges)]; }

    // The layouts of all vertices, from a vertex on.
    std::vector<RingLayout> getLayouts(int firstRing) const {
        std::vector<RingLayout> layouts = _layouts;
        std::rotate(layouts.begin(), layouts.begin() + firstRing, layouts.end());
        return layouts;
    }

    CellRefinement const &getRefinement() {
        if (!_refinement) {
            _refinement = refine(_cell, _cells.GetRules());
        }
        return *_refinement;
    }

    RingEdge makeEdge(int edge) {
        RingLayout const &start = getLayout(edge);
        RingLayout const &end = getLayout(edge + 1);
        RingCells::Key const key = findKey({start, end});
        RingCell const &half = findChild(CellKind::Half, key, std::size_t(edge) + 1, edge);
        RingCell const &longEdge = findItem(CellKind::LongEdge, key, edge, 0);
        RingCell const &reversed =
            findItem(CellKind::LongEdge, findKey({end.From(1), start.From(-1)}), edge, 1);
        return {&half, {&longEdge, &reversed}};
    }

    std::vector<RingCell const *> makeVVertices(int vert) {
        RingLayout const &ring = getLayout(vert);
        int const numTurns = int(ring.faceSizes.size());
        std::vector<RingCell const *> result;
        result.reserve(std::size_t(numTurns));
        for (int turn = 0; turn < numTurns; ++turn) {
            result.push_back(
                &findItem(CellKind::Vertex, findKey({ring.From(-turn)}), _numEdges + vert, turn));
        }
        return result;
    }

    RingCell const &findChild(CellKind kind, RingCells::Key const &key, std::size_t child,
                              int firstRing) {
        return _cells.Find(kind, key, [&] {
            return Cell{getRefinement().children[child], getLayouts(firstRing)};
        });
    }

    // By edge, then by vertex.
    RingCell const &findItem(CellKind kind, RingCells::Key const &key, int item, int turn) {
        return _cells.Find(kind, key, [&] {
            std::vector<int> turns(2 * std::size_t(_numEdges));
            turns[std::size_t(item)] = turn;
            return makeItemCell(
                GatherBorder(_cell, turns.data(), _cells.GetRules().sdcOptions)[std::size_t(item)],
                _cells.GetRules());
        });
    }

    CellPatch const &_cell;
    RingCells &_cells;
    int const _numEdges;
    std::vector<RingLayout> const _layouts;
    std::optional<CellRefinement> _refinement;
};

FaceRings::FaceRings(CellPatch const &cell, RingCells &cells) : _patterns(cells.GetMemory()) {
    PatchCorners const corners(cell.patch);
    bool const isPlain = _rings.Init(corners, cell.locals, cells.GetMasks());
    assert(isPlain);
    static_cast<void>(isPlain);
    _cells = &cells.FindFace(findKey(cell, corners, cells.GetMasks().AreUsed()),
                             [&] { return Maker(cell, cells).Make(); });
}

void FaceRings::findIndices(std::size_t child, RingPlaces const &places, RingStep step,
                            int *indices) const {
    int const numRings = int(_rings.GetRings().size());
    int const first = child == 0 ? 0 : int(child) - 1;
    auto const getBlock = [&](int ring) {
        int const own = first + ring;
        return _rings.GetBlock(own < numRings ? own : own - numRings, 0, step);
    };
    places.FindIndices(_rings.GetCenter(first, 0, step), getBlock, indices);
}

// The face to the left of the edge is the first of both rings: this one, or that across the edge.
void FaceRings::FindLongEdgeIndices(int edge, bool isReversed, int *indices) const {
    int const next = edge + 1 < int(_rings.GetRings().size()) ? edge + 1 : 0;
    int const start = isReversed ? next : edge;
    int const first = isReversed ? 1 : 0;
    int const end = isReversed ? edge : next;
    RingStep const step = _rings.GetLastStep();
    auto const getBlock = [&](int ring) {
        return ring == 0 ? _rings.GetBlock(start, first, step) : _rings.GetBlock(end, -first, step);
    };
    GetLongEdge(edge, isReversed)
        ->GetPlaces()
        .FindIndices(_rings.GetCenter(start, first, step), getBlock, indices);
}

template <typename REAL>
void RingValues<REAL>::Set(VertexRings const &rings, std::size_t numPoints, int const *indices,
                           REAL const *points, std::ptrdiff_t stride, std::size_t size) {
    _rings = &rings;
    _size = size;
    _paddedSize = StepMatrix::GetPaddedSize(size);
    auto const grow = [](std::vector<REAL> &numbers, std::size_t count) {
        numbers.resize(std::max(numbers.size(), count));
    };
    grow(_controlPoints, (numPoints + 1) * _paddedSize);
    grow(_points, rings.GetNumPoints() * _paddedSize);
    grow(_center, _paddedSize);
    REAL *to = _controlPoints.data();
    for (std::size_t i = 0; i < numPoints; ++i, to += _paddedSize) {
        std::ptrdiff_t const point = indices ? indices[i] : std::ptrdiff_t(i);
        StepMatrix::Pad(points + point * stride, size, to);
    }
    std::fill_n(to, _paddedSize, REAL(0));
    _hasAll = false;
    _lastRing = -1;
}

template <typename REAL>
void RingValues<REAL>::EvaluateVertex(RingCell const &vVertex, int ring, int firstFace,
                                      REAL *result) {
    if (!_hasAll && _lastRing != ring) {
        _lastRing = ring;
        _rings->ApplyRing(std::size_t(ring), _controlPoints.data(), _paddedSize, _points.data());
    }
    Ring const &ofRing = _rings->GetRings()[std::size_t(ring)];
    std::vector<REAL> const &weights = vVertex.GetVertexWeights<REAL>();
    std::vector<int> const &places = vVertex.GetPlaces().GetPlaces();
    assert(weights.size() == places.size() + 1);
    RingStep const step = _rings->GetLastStep();
    _rings->ApplyCenter(ring, firstFace, _controlPoints.data(), _points.data(), _paddedSize,
                        _center.data());
    std::size_t const first = ofRing.GetOffset(firstFace, step);
    std::size_t const numPoints = ofRing.GetOffset(ofRing.GetNumFaces(), step);
    constexpr std::size_t kNumSums = 4; // that do not wait for each other
    std::size_t const numInFours = places.size() / kNumSums * kNumSums;
    constexpr std::size_t kLanes = Lanes<REAL>::kCount;
    for (std::size_t lane = 0; lane < _size; lane += kLanes) {
        REAL const *const blocks = &_points[_rings->GetBlock(ring, 0, step) * _paddedSize] + lane;
        Lanes<REAL> sums[kNumSums] = {Lanes<REAL>::Load(&_center[lane]) * weights[0]};
        auto const add = [&](std::size_t k, Lanes<REAL> &sum) {
            std::size_t const place = first + std::size_t(places[k]);
            REAL const *const point =
                blocks + (place < numPoints ? place : place - numPoints) * _paddedSize;
            sum = sum + Lanes<REAL>::Load(point) * weights[1 + k];
        };
        for (std::size_t k = 0; k < numInFours; k += kNumSums) {
            for (std::size_t i = 0; i < kNumSums; ++i) {
                add(k + i, sums[i]);
            }
        }
        for (std::size_t k = numInFours; k < places.size(); ++k) {
            add(k, sums[k - numInFours]);
        }
        Lanes<REAL> const sum = (sums[0] + sums[1]) + (sums[2] + sums[3]);
        std::copy_n(sum.values, std::min(kLanes, _size - lane), result + lane);
    }
}

template class RingValues<float>;
template class RingValues<double>;

} // namespace OpenSubdivHex::BfrExt::internal

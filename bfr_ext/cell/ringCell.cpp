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

CellRefinement refine(CellPatch const &cell, CellRules const &rules, bool hasStep) {
    return RefineCell(cell, rules.sdcOptions, rules.hexSchemeOptions, rules.interpolation, hasStep);
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
        std::for_each(ring.verts.begin(), ring.verts.end(), addVertex);
        key.insert(key.end(), ring.flags.begin(), ring.flags.end());
    }
    return key;
}

// Tells the rings of a plain base face: the faces at its vertices, which come first in its patch.
RingCells::Key findKey(CellPatch const &cell, PatchCorners const &corners, bool hasFlags) {
    int const numEdges = cell.GetNumCorners();
    RingCells::Key key;
    key.reserve(cell.patch.faceSizes.size() + cell.patch.faceVerts.size());
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
    return {std::move(refine(item, rules, false).children[0]),
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
    for (Column const &column : columns) {
        _columns.push_back(column.point);
        _ends.resize(std::size_t(column.ring) + 1, _places.size());
        _places.push_back(column.place);
        ++_ends.back();
    }
}

std::vector<double> RingPlaces::Order(std::vector<double> const &weights) const {
    std::vector<double> result(_columns.size());
    for (std::size_t column = 0; column < _columns.size(); ++column) {
        result[column] = weights[std::size_t(_columns[column])];
    }
    return result;
}

template <typename REAL>
std::vector<REAL> const &RingCell::GetVertexWeights() const {
    return _patterns.Get<std::vector<REAL>>(
        PatternTable::GetKind<REAL>(PatternOf::VertexWeights), nullptr, nullptr, [&] {
            std::vector<double> const weights = GetPlaces().Order(_type.GetCornerPoints()[0]);
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

std::unique_ptr<RingCell const> RingCells::make(CellPatch const &cell,
                                                std::vector<RingLayout> const &rings) {
    RingPlaces points(cell.patch.sources, rings);
    if (!_masks.HaveSecondStep()) {
        CellType const &type = _types.Find(cell, GetRules());
        return std::make_unique<RingCell const>(type, std::move(points));
    }
    CellRefinement const refinement = refine(cell, GetRules(), cell.kind != CellKind::Vertex);
    std::vector<RingLayout> const inner = FindInnerLayouts(cell.patch, rings);
    if (cell.kind == CellKind::Vertex) {
        CellPatch const &child = refinement.children[0];
        return std::make_unique<RingCell const>(_types.Find(child, GetRules()),
                                                RingPlaces(child.patch.sources, inner));
    }
    RingPlaces ofStep(findStepVertices(refinement), inner);
    CellType const &type = _types.Find(cell, GetRules());
    type.MakeChildren(refinement);
    return std::make_unique<RingCell const>(type, std::move(points), std::move(ofStep));
}

// Rings that differ only where the cell does not depend on them are equal.
RingCell const &RingCells::find(CellPatch const &cell, std::vector<RingLayout> const &rings) {
    std::unique_ptr<RingCell const> ringCell = make(cell, rings);
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
            findKey(FindRingLayouts(patch.patch, patch.locals, cells.GetMasks().HaveSecondStep())),
            [&] { return makeItemCell(patch, cells.GetRules()); });
        return item;
    });
}

// Makes the cells of a face.
class FaceRings::Maker {
public:
    Maker(CellPatch const &cell, RingCells &cells)
        : _cell(cell), _cells(cells), _numEdges(cell.GetNumCorners()),
          _layouts(FindRingLayouts(cell.patch, cell.locals, cells.GetMasks().HaveSecondStep())) {}

    std::unique_ptr<RingFace const> Make() {
        auto face = std::make_unique<RingFace>(_cells.GetMemory());
        face->whole = &findChild(CellKind::Whole, findKey(_layouts), 0, 0);
        for (int i = 0; i < _numEdges; ++i) {
            face->edges.push_back(makeEdge(i));
            face->vVertices.push_back(makeVVertices(i));
        }
        face->edges.shrink_to_fit();
        face->vVertices.shrink_to_fit();
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
            _refinement = refine(_cell, _cells.GetRules(), false);
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
            return makeItemCell(GatherBorder(_cell, turns.data(), _cells.GetRules().sdcOptions,
                                             item)[std::size_t(item)],
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
    _cells = &cells.FindFace(findKey(cell, corners, cells.GetMasks().HaveSecondStep()),
                             [&] { return Maker(cell, cells).Make(); });
}

template <typename REAL>
void RingValues<REAL>::Set(VertexRings const &rings, int const *turns,
                           RingSources<REAL> const &sources) {
    _rings = &rings;
    _sources = sources;
    _paddedSize = StepMatrix::GetPaddedSize(sources.size);
    if (_sources.shared && !_sources.shared->HasRoom(rings.GetNumPoints(), _paddedSize)) {
        _sources.shared = nullptr;
    }
    _ownRings.resize(rings.GetRings().size());
    for (std::size_t ring = 0; ring < _ownRings.size(); ++ring) {
        _ownRings[ring] = {turns ? rings.GetRings()[ring].GetTurn(turns[ring]) : 0, -1};
    }
    _hasControlPoints = false;
}

template <typename REAL>
void RingValues<REAL>::find(std::size_t ring) {
    OwnRing &own = _ownRings[ring];
    if (own.first >= 0) {
        return;
    }
    if (!_sources.shared) {
        own.first = int((makeOwn(ring) - _points.data()) / std::ptrdiff_t(_paddedSize));
        return;
    }
    std::size_t const numPoints = _rings->GetRings()[ring].GetNumPoints(_rings->GetLastStep());
    own.first = int(_sources.shared->FindRing(getVertex(ring), numPoints, _paddedSize,
                                              [&](REAL *points) { make(ring, points); }));
}

// A ring of which nothing but the surface at its vertex is asked for is not worth sharing.
template <typename REAL>
REAL const *RingValues<REAL>::findForVertex(std::size_t ring) {
    if (_sources.shared && _ownRings[ring].first < 0 &&
        !_sources.shared->HasRing(getVertex(ring), _paddedSize)) {
        return makeOwn(ring);
    }
    find(ring);
    return getPoints() + std::size_t(_ownRings[ring].first) * _paddedSize;
}

template <typename REAL>
REAL *RingValues<REAL>::makeOwn(std::size_t ring) {
    std::size_t const first =
        _rings->GetRings()[ring].firstPoints[std::size_t(_rings->GetLastStep())];
    _points.resize(std::max(_points.size(), _rings->GetNumPoints() * _paddedSize));
    make(ring, &_points[first * _paddedSize]);
    return &_points[first * _paddedSize];
}

// Writes the points of the last step.
template <typename REAL>
void RingValues<REAL>::make(std::size_t ring, REAL *last) {
    auto const grow = [](std::vector<REAL> &numbers, std::size_t count) {
        numbers.resize(std::max(numbers.size(), count));
    };
    if (!_hasControlPoints) {
        _hasControlPoints = true;
        grow(_controlPoints, (_sources.numPoints + 1) * _paddedSize);
        REAL *to = _controlPoints.data();
        for (std::size_t i = 0; i < _sources.numPoints; ++i, to += _paddedSize) {
            StepMatrix::Pad(_sources.points +
                                std::ptrdiff_t(_sources.GetPoint(i)) * _sources.stride,
                            _sources.size, to);
        }
        std::fill_n(to, _paddedSize, REAL(0));
    }
    REAL *first = last;
    if (_rings->GetLastStep() != RingStep::First) {
        grow(_firstStep, _rings->GetRings()[ring].GetNumPoints(RingStep::First) * _paddedSize);
        first = _firstStep.data();
    }
    _rings->Apply(ring, _ownRings[ring].turn, _controlPoints.data(), _paddedSize, first, last);
}

template <typename REAL>
void RingValues<REAL>::EvaluateVertex(RingCell const &vVertex, int ring, REAL *result) {
    std::vector<REAL> const &weights = vVertex.GetVertexWeights<REAL>();
    std::vector<int> const &places = vVertex.GetPlaces().GetPlaces();
    assert(weights.size() == places.size());
    constexpr std::size_t kNumSums = 4; // that do not wait for each other
    std::size_t const numInFours = places.size() / kNumSums * kNumSums;
    constexpr std::size_t kLanes = Lanes<REAL>::kCount;
    REAL const *const points = findForVertex(std::size_t(ring));
    for (std::size_t lane = 0; lane < _sources.size; lane += kLanes) {
        Lanes<REAL> sums[kNumSums] = {};
        auto const add = [&](std::size_t k, Lanes<REAL> &sum) {
            REAL const *const point = points + std::size_t(places[k]) * _paddedSize;
            sum = sum + Lanes<REAL>::Load(point + lane) * weights[k];
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
        std::copy_n(sum.values, std::min(kLanes, _sources.size - lane), result + lane);
    }
}

template class RingValues<float>;
template class RingValues<double>;

} // namespace OpenSubdivHex::BfrExt::internal

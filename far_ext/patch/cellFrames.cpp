// SPDX-License-Identifier: Apache-2.0
#include "cellFrames.h"

#include "patchCells.h"

#include "far_ext/limit/limitPatch.h"
#include "far_ext/vtr/parallel.h"
#include "far_ext/vtr/pi.h"

#include <algorithm>
#include <cmath>
#include <complex>

namespace OpenSubdivHex::FarExt::internal {

using Far::Index;
using Sdc::Crease;

namespace {

using Complex = std::complex<double>;

bool isBreak(FanItem const &item) { return !item.isFace && Crease::IsInfinite(item.sharpness); }

// Whether a vertex has one fan that is closed, and no edge or diagonal that is sharp for ever.
bool hasNoBeginning(Level const &level, Index vert) {
    if (level.IsNonManifold(vert)) {
        return false;
    }
    for (Index const edge : level.GetVertexEdges(vert)) {
        if (level.IsBoundary(edge) || Crease::IsInfinite(level.GetEdgeSharpness(edge))) {
            return false;
        }
    }
    if (level.diagonalSharpness.empty()) {
        return true;
    }
    for (Index k = level.vertFirstFace[vert]; k < level.vertFirstFace[vert + 1]; ++k) {
        Index const face = level.vertFaces[k];
        int const local = level.vertFaceLocals[k];
        if (Crease::IsInfinite(level.GetDiagonalSharpness(face)) &&
            (local == kDiagonalStart || local == level.GetDiagonalEnd(face))) {
            return false;
        }
    }
    return true;
}

// Whether the vertex is a corner once semi-sharp edges have faded.
bool isCornerForEver(Level const &level, Index vert, std::vector<VertexSide> const &sides) {
    SharpVertex const *const sharp = level.FindSharpVertex(vert);
    if (!sharp || sharp->rule != Crease::RULE_CORNER) {
        return false;
    }
    if (level.IsNonManifold(vert) || Crease::IsInfinite(level.GetVertexSharpness(vert))) {
        return true;
    }
    bool hasSemiSharp = Crease::IsSemiSharp(level.GetVertexSharpness(vert));
    int numBreaks = 0;
    for (VertexSide const &side : sides) {
        for (FanItem const &item : side.items) {
            numBreaks += isBreak(item);
            hasSemiSharp |= !item.isFace && Crease::IsSemiSharp(item.sharpness);
        }
    }
    // Every such edge ends one side and begins another, but for the two of a boundary.
    bool const isOpen =
        std::any_of(level.GetVertexEdges(vert).begin(), level.GetVertexEdges(vert).end(),
                    [&](Index edge) { return level.IsBoundary(edge); });
    return !hasSemiSharp || (isOpen ? numBreaks + 2 : numBreaks) > 4;
}

// The side that begins with the edge, or diagonal, with which another one ends; -1: none.
int findSideBehind(std::vector<VertexSide> const &sides, VertexSide const &side) {
    FanItem const &end = side.items.back();
    auto const found = std::find_if(sides.begin(), sides.end(), [&](VertexSide const &other) {
        FanItem const &begin = other.items.front();
        return other.fan == side.fan && !begin.isFace && begin.neighbor == end.neighbor &&
               begin.isLong == end.isLong;
    });
    return end.isFace || found == sides.end() ? -1 : int(found - sides.begin());
}

} // namespace

CellFrames::CellFrames(Level const &level, LimitRows const &rows, std::vector<Index> const &verts)
    : _level(level), _turns(std::size_t(level.numVertices), 0) {
    auto const numVerts = Index(verts.size());
    struct Range {
        std::vector<SharpCorner> corners;
        double doubt = 0;
    };
    struct State {
        IndexMap places;
        int turnOfRegular = -1;
    };
    std::vector<Range> ranges(std::size_t(GetNumParallelRanges(numVerts, kShortParallelRange)));
    ParallelForRange(
        numVerts, [] { return State(); },
        [&](State &state, Index begin, Index end) {
            Range &range = ranges[std::size_t(begin / kShortParallelRange)];
            for (Index i = begin; i < end; ++i) {
                Index const vert = verts[std::size_t(i)];
                if (level.GetNumVertexFaces(vert) == 0) {
                    continue;
                }
                if (!hasNoBeginning(level, vert)) {
                    _turns[std::size_t(vert)] = kIsSharp;
                    addSides(vert, range.corners);
                    continue;
                }
                int const numDirections = 2 * level.GetNumVertexFaces(vert);
                Index regularSources[PlainNeighborhoodGatherer::kNumRegular];
                LimitRow const row = rows.GetRow(vert, 0, regularSources);
                // Regular vertices have one mask, from the first of their faces on.
                bool const isRegular = row.sources == regularSources;
                if (isRegular && state.turnOfRegular >= 0) {
                    _turns[std::size_t(vert)] = state.turnOfRegular;
                    continue;
                }
                double doubt = 0;
                double const turn =
                    findTurn(vert, row, state.places, doubt) * numDirections / (2 * kPi);
                auto const nearest = int(std::lround(turn));
                range.doubt = std::max({range.doubt, 2 * std::abs(turn - nearest), doubt});
                int const found = ((nearest % numDirections) + numDirections) % numDirections;
                _turns[std::size_t(vert)] = found;
                state.turnOfRegular = isRegular ? found : state.turnOfRegular;
            }
        },
        kShortParallelRange);
    for (Range const &range : ranges) {
        _sharpCorners.insert(_sharpCorners.end(), range.corners.begin(), range.corners.end());
        _largestDoubt = std::max(_largestDoubt, range.doubt);
    }
    std::sort(_sharpCorners.begin(), _sharpCorners.end(),
              [](SharpCorner const &a, SharpCorner const &b) {
                  return a.corner != b.corner ? a.corner < b.corner : a.half < b.half;
              });
}

// Where the first edge of the vertex lies, in terms of du and dv.
double CellFrames::findTurn(Index vert, LimitRow const &row, IndexMap &places,
                            double &doubt) const {
    // A layout in the plane, with the first edge along the x axis.
    std::vector<Complex> layout = {0};
    places.Clear();
    places.FindOrSet(vert, 0);
    auto const place = [&](Index v, Complex at) {
        if (places.FindOrSet(v, Index(layout.size())) == Index(layout.size())) {
            layout.push_back(at);
        }
    };
    int const numFaces = _level.GetNumVertexFaces(vert);
    double const unit = 2 * kPi / numFaces;
    Index const first = _level.vertFirstFace[vert];
    auto const vertexOf = [&](int i, int step) {
        Index const face = _level.vertFaces[first + i];
        int const size = _level.GetFaceSize(face);
        return _level.GetFaceVertices(face)[(_level.vertFaceLocals[first + i] + step) % size];
    };
    for (int i = 0; i < numFaces; ++i) {
        place(vertexOf(i, 1), std::polar(1.0, i * unit));
    }
    for (int i = 0; i < numFaces; ++i) {
        int const last = _level.GetFaceSize(_level.vertFaces[first + i]) - 2;
        for (int k = 1; k < last; ++k) {
            double const part = double(k) / last;
            place(vertexOf(i, k + 1), std::polar(1 + std::sin(kPi * part), (i + part) * unit));
        }
    }
    constexpr double kFar = 2.6;
    for (int i = 0; i < numFaces; ++i) {
        Index const neighbor = vertexOf(i, 1);
        for (Index const face : _level.GetVertexFaces(neighbor)) {
            for (Index const v : _level.GetFaceVertices(face)) {
                place(v, std::polar(kFar, i * unit));
            }
        }
    }
    // Derivatives of the layout: with an even map, du is at some angle, and dv at right angles.
    Complex sums[2] = {0, 0};
    for (int i = 0; i < row.size; ++i) {
        if (Index const at = places.Find(row.sources[i]); at != Far::INDEX_INVALID) {
            sums[0] += row.du[i] * layout[std::size_t(at)];
            sums[1] += row.dv[i] * layout[std::size_t(at)];
        }
    }
    Complex const even = sums[0] - Complex(0, 1) * sums[1];
    Complex const odd = sums[0] + Complex(0, 1) * sums[1];
    doubt = std::abs(odd) / std::abs(even);
    return -std::arg(even);
}

void CellFrames::addSides(Index vert, std::vector<SharpCorner> &corners) const {
    std::vector<VertexSide> const sides = FindVertexSides(_level, vert);
    bool const isCorner = isCornerForEver(_level, vert, sides);
    for (int i = 0; i < int(sides.size()); ++i) {
        VertexSide const &side = sides[std::size_t(i)];
        double size = 0;
        for (FanItem const &item : side.items) {
            size += item.isFace ? (item.isHalf ? 0.5 : 1) : 0;
        }
        double const angleOfSide = side.isAllAround ? 2 * kPi
                                   : isCorner       ? std::min(kPi, kPi / 3 * size)
                                                    : kPi;
        double angle = 0;
        for (FanItem const &item : side.items) {
            if (item.isFace) {
                double const end = angle + (item.isHalf ? 0.5 : 1) * angleOfSide / size;
                corners.push_back({item.corner, item.half, i, angle, end, -1});
                angle = end;
            }
        }
        // On the wide side of a corner du is along the edge where it begins, and dv into the side.
        if (isCorner && !side.isAllAround && size >= 2) {
            corners.back().sideOfEnd = findSideBehind(sides, side);
        }
    }
}

double CellFrames::GetEdgeAngle(Index vert, int i) const {
    int const numFaces = _level.GetNumVertexFaces(vert);
    return (_turns[std::size_t(vert)] + 2 * i) % (2 * numFaces) * (kPi / numFaces);
}

CornerFrame CellFrames::Get(Index face, int local, int half) const {
    Index const corner = _level.faceFirstCorner[face] + local;
    Index const vert = _level.faceVerts[corner];
    // Two cells of a face meet at the ends of its diagonal: seen from the first half 1 comes first, from the other
    // half 0.
    FaceCells const cells = FindFaceCells(_level, face);
    bool const isCut = cells.IsCut() && (local == kDiagonalStart || local == cells.diagonalEnd);
    bool const isFirst = (half == 1) == (local == kDiagonalStart);
    auto const part = [&](double begin, double end) {
        double const middle = (begin + end) / 2;
        return isFirst ? std::make_pair(begin, middle) : std::make_pair(middle, end);
    };
    int const turn = _turns[std::size_t(vert)];
    if (turn != kIsSharp) {
        int const numFaces = _level.GetNumVertexFaces(vert);
        Index k = _level.vertFirstFace[vert];
        while (_level.GetVertexCorner(k) != corner) {
            ++k;
        }
        double const unit = kPi / numFaces;
        int const begin = turn + 2 * int(k - _level.vertFirstFace[vert]);
        auto const angles =
            isCut ? std::make_pair(begin + (isFirst ? 0 : 1), begin + (isFirst ? 1 : 2))
                  : std::make_pair(begin, begin + 2);
        int const all = 2 * numFaces; // the same angles for the same directions
        int const from = angles.first % all;
        return {vert, 0, from * unit, (from + angles.second - angles.first) * unit};
    }
    auto found = std::lower_bound(
        _sharpCorners.begin(), _sharpCorners.end(), corner,
        [](SharpCorner const &sharp, Index wanted) { return sharp.corner < wanted; });
    if (found->half >= 0 && found->half != half) {
        ++found;
    }
    if (found->half < 0 && isCut) {
        auto const angles = part(found->begin, found->end);
        return {vert, found->side, angles.first, angles.second, isFirst ? -1 : found->sideOfEnd};
    }
    return {vert, found->side, found->begin, found->end, found->sideOfEnd};
}

} // namespace OpenSubdivHex::FarExt::internal

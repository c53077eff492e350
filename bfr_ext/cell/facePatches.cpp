// SPDX-License-Identifier: Apache-2.0
#include "facePatches.h"

#include "baseType.h"
#include "lanes.h"
#include "placeKernel.h"
#include "refinedCells.h"

#include "far_ext/patch/cellPatchPoints.h"
#include "far_ext/vtr/inline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>
#include <utility>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

using FarExt::internal::CellKind;
using FarExt::internal::GetNumCellPatches;
using FarExt::internal::PatchAges;

namespace {

int getNumHalfPatches(int level) { return 1 << 2 * level; }

// Steps since the corners of a cell were made; -1: they are vertices of the base face.
using CornerAges = std::vector<int>;

int getNextAge(int age) { return age < 0 ? age : age + 1; }

// The corners of the cell that an edge of a cell makes.
CornerAges findEdgeAges(CornerAges const &ages, std::size_t edge) {
    return {getNextAge(ages[edge]), getNextAge(ages[(edge + 1) % ages.size()]), 0, 0};
}

// Older ones have the same constants.
PatchAges limitAges(int steps, CornerAges ages) {
    using FarExt::internal::PatchSite;
    for (int &age : ages) {
        age = std::min(age, PatchSite::kMaxAge);
    }
    return {std::min(steps, PatchSite::kMaxSteps), std::move(ages)};
}

// Calls function(child, ages of its corners) for the children of a cell that makes so many.
template <typename FUNCTION>
void forEachChild(bool isWhole, int numChildren, CornerAges const &ages, FUNCTION const &function) {
    function(0, CornerAges(ages.size(), 0));
    for (int child = 1; child < numChildren; ++child) {
        function(child, findEdgeAges(ages, std::size_t(isWhole ? child - 1 : child)));
    }
}

// The rows of the points of all patches that a cell is, some levels on.
std::vector<std::vector<double>> findRows(CellType const &type, int steps, CornerAges const &ages,
                                          int numLevels) {
    std::vector<std::vector<double>> rows;
    if (numLevels == 0) {
        std::vector<double> const all = type.FindPatchPoints(limitAges(steps, ages));
        auto const numPoints = std::size_t(type.GetNumPoints());
        for (std::size_t i = 0; i < all.size(); i += numPoints) {
            rows.emplace_back(all.begin() + std::ptrdiff_t(i),
                              all.begin() + std::ptrdiff_t(i + numPoints));
        }
        return rows;
    }
    std::vector<CellType::Child> const &children = type.GetChildren();
    forEachChild(type.IsWhole(), int(children.size()), ages, [&](int i, CornerAges const &ofChild) {
        CellType::Child const &child = children[std::size_t(i)];
        for (std::vector<double> const &row :
             findRows(*child.type, steps + 1, ofChild, numLevels - 1)) {
            rows.emplace_back();
            child.step.ApplyLeft(row, rows.back());
        }
    });
    return rows;
}

// The same as a matrix, which all cells of the type have whose corners are as old.
template <typename REAL>
PlaceMatrix<REAL> const &getMatrix(CellType const &type, int steps, CornerAges const &ages,
                                   int numLevels) {
    PatchAges const limited = limitAges(steps, ages);
    std::vector<int> key = limited.ofVertices;
    key.push_back(limited.steps);
    key.push_back(numLevels);
    return type.GetPatterns().Get<PlaceMatrix<REAL>>(
        PatternTable::GetKind<REAL>(PatternOf::PatchPoints), key.data(), key.data() + key.size(),
        [&] {
            std::vector<std::vector<double>> const rows = findRows(type, steps, ages, numLevels);
            PlaceMatrix<REAL> matrix(rows.size(), std::size_t(type.GetNumPoints()));
            for (std::size_t i = 0; i < rows.size(); ++i) {
                matrix.Set(i, rows[i]);
            }
            return matrix;
        });
}

// Refines the points of cells as far as their types are many, and makes those of patches by matrices of these.
template <typename REAL>
class PointMaker {
public:
    PointMaker(RefinedCells &cells, int level, int size, std::ptrdiff_t stride, REAL *points)
        : _cells(cells), _level(level), _size(size), _stride(stride), _points(points) {}

    void Make(std::size_t cell, CornerAges const &ages) {
        if (_cells[cell].GetLevel() == RefinedCells::kFirstCommonLevel) {
            add(_cells[cell], ages);
            return;
        }
        bool const isWhole = _cells[cell].GetLevel() == 0 || _cells[cell].GetType().IsWhole();
        std::size_t const first = _cells.GetFirstChild(cell);
        std::size_t const numCells = _cells.GetSize();
        forEachChild(isWhole, _cells.GetNumChildren(cell), ages,
                     [&](int child, CornerAges const &ofChild) {
                         Make(first + std::size_t(child), ofChild);
                         _cells.Drop(numCells);
                     });
    }

private:
    void add(CellValues const &values, CornerAges const &ages) {
        PlaceMatrix<REAL> const &matrix =
            getMatrix<REAL>(values.GetType(), values.GetLevel(), ages, _level - values.GetLevel());
        std::size_t const padded = values.GetPaddedSize();
        double const *const point = values.GetPoint(0);
        _values.assign(point, point + std::size_t(values.GetNumPoints()) * padded);
        SumUpPlaces(matrix, {_values.data(), std::ptrdiff_t(padded), std::size_t(_size), nullptr,
                             _points, _stride});
        _points += std::ptrdiff_t(matrix.GetNumPlaces()) * _stride;
    }

    RefinedCells &_cells;
    int const _level;
    int const _size;
    std::ptrdiff_t const _stride;
    REAL *_points;
    std::vector<REAL> _values;
};

// The coordinates of a cell in which a patch is a bilinear quadrilateral, and where a place is in it.
struct Quadrilateral {
    double s;
    double t;
    Pair bySt[2]; // derivatives of the first coordinate, and of the second, by s and t
    Pair mixed;   // by s and t
};

Quadrilateral findInTrapezoid(Pair const &coords) {
    double const h = coords[1];
    double const s = (coords[0] - 0.5 * h) / (1 - h);
    return {s, 2 * h, {{1 - h, 0.25 - 0.5 * s}, {0, 0.5}}, {-0.5, 0}};
}

// The kite between the middles of two edges, by which coordinates are, the centre, and a corner, which is
// (1 + m) times the sum of the two middles.
Quadrilateral findInKite(Pair const &coords, double m) {
    // a = 1 - s and b = 1 - t: the coordinates are b (1 + m a) and a (1 + m b).
    double const difference = coords[0] - coords[1];
    double const linear = 1 + m * difference;
    double const a = 2 * coords[1] / (linear + std::sqrt(linear * linear + 4 * m * coords[1]));
    double const b = a + difference;
    return {1 - a, 1 - b, {{-m * b, -(1 + m * a)}, {-(1 + m * b), -m * a}}, {m, m}};
}

} // namespace

int GetNumFacePatches(int size, int level) {
    int numPatches = GetNumCellPatches(CellKind::Whole, size);
    for (int i = 0; i < level; ++i) {
        numPatches += size * getNumHalfPatches(i);
    }
    return numPatches;
}

namespace {

// The linear part of a map from the coordinates in a sector.
using Linear = std::array<Pair, 2>;

// To those in a half cell of the same size, behind steps that turn it by so many sixths of a full turn.
constexpr Linear kFromSectorTo[6] = {{{{-0.5, 0.5}, {-1, -1}}}, {{{-1, -0.5}, {0, -1}}},
                                     {{{-0.5, -1}, {1, 0}}},    {{{0.5, -0.5}, {1, 1}}},
                                     {{{1, 0.5}, {0, 1}}},      {{{0.5, 1}, {-1, 0}}}};

// From the coordinates in the sector of a whole cell to those that the shape of its patches is given by: the
// number of the patch among those of the cell, where the place is in it, and the map between them.
Quadrilateral findInWhole(int size, int sector, Pair const &coords, int &patch, Linear &linear) {
    auto const map = [&](Pair const &toStart, Pair const &toEnd, Pair const &center) {
        linear = {{{toStart[0], toEnd[0]}, {toStart[1], toEnd[1]}}};
        return CellMap{{linear[0], linear[1]}, center}.Apply(coords);
    };
    if (size == 4) {
        constexpr Pair kCorners[4] = {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}};
        Pair const st = map(kCorners[sector], kCorners[(sector + 1) % 4], {0.5, 0.5});
        return {st[0], st[1], {{1, 0}, {0, 1}}, {0, 0}};
    }
    if (FarExt::HasHalves(size)) {
        patch = FarExt::GetHalfOfEdge(sector);
        // Of a half, whose long edge is the diagonal, from the centre of that on, around from its end.
        constexpr Pair kCorners[4] = {{0.5, 0}, {0.25, 0.5}, {-0.25, 0.5}, {-0.5, 0}};
        int const local = sector % FarExt::kDiagonalEnd;
        return findInTrapezoid(map(kCorners[local], kCorners[local + 1], {0.5, 0}));
    }
    double const cosine = std::cos(FarExt::internal::kPi / size);
    double const corner = 0.5 / (cosine * cosine);
    bool const isAtStart = coords[0] >= coords[1];
    patch = isAtStart ? sector : (sector + 1) % size;
    return findInKite(isAtStart ? map({corner, corner}, {2 - corner, -corner}, {0, 0})
                                : map({-corner, 2 - corner}, {corner, corner}, {0, 0}),
                      corner - 1);
}

// The derivatives of the coordinates that a map makes of those in a sector, by u and v: once, and by both.
struct ByUv {
    ByUv(Linear const &linear, double scale, BfrPlace const &place, bool hasSubFaces) {
        for (std::size_t i = 0; i < 2; ++i) {
            // By the coordinates of the plane, which in triangles and quads are u and v.
            Pair by;
            for (std::size_t k = 0; k < 2; ++k) {
                by[k] = scale * (linear[i][0] * place.point.toCoords[0][k] +
                                 linear[i][1] * place.point.toCoords[1][k]);
            }
            first[i] = by;
            if (hasSubFaces) {
                auto const &[x, y] = place.toOwn;
                first[i] = {by[0] * x[0] + by[1] * y[0], by[0] * x[1] + by[1] * y[1]};
                mixed[i] = by[0] * place.mixed[0] + by[1] * place.mixed[1];
            }
        }
    }

    Pair first[2];
    Pair mixed = {0, 0};
};

} // namespace

PatchPlace FindPatchPlace(BfrPlace const &ofFace, int size, int level, int numDerivatives) {
    int const sector = ofFace.point.sector;
    Pair coords = ofFace.point.coords;
    int left = level;
    for (; left > 0 && coords[0] + coords[1] <= 0.5; --left) {
        coords = {2 * coords[0], 2 * coords[1]};
    }
    PatchPlace place = {};
    Quadrilateral in;
    Linear linear;
    // Each step halves cells, but that from the sector to the half cell, which is part of the map.
    int const numHalvings = left == 0 ? level : level - 1;
    if (left == 0) {
        in = findInWhole(size, sector, coords, place.patch, linear);
    } else {
        --left;
        coords = HalfCell::kFromSector.Apply(coords);
        place.patch = GetNumFacePatches(size, left) + sector * getNumHalfPatches(left);
        int turn = 0;
        while (left > 0) {
            --left;
            int const child = HalfCell::FindChild(coords);
            place.patch += child * getNumHalfPatches(left);
            coords = HalfCell::kChildren[child].Apply(coords);
            turn += HalfCell::kTurns[child];
        }
        linear = kFromSectorTo[turn % 6];
        in = findInTrapezoid(coords);
    }
    place.s = in.s;
    place.t = in.t;
    if (numDerivatives == 0) {
        return place;
    }
    ByUv const cell(linear, double(1 << numHalvings), ofFace, size > 4);
    double const factor = 1 / (in.bySt[0][0] * in.bySt[1][1] - in.bySt[0][1] * in.bySt[1][0]);
    auto const solve = [&](double first, double second) {
        return Pair{(in.bySt[1][1] * first - in.bySt[0][1] * second) * factor,
                    (in.bySt[0][0] * second - in.bySt[1][0] * first) * factor};
    };
    for (std::size_t k = 0; k < 2; ++k) {
        Pair const byUv = solve(cell.first[0][k], cell.first[1][k]);
        place.first[0][k] = byUv[0];
        place.first[1][k] = byUv[1];
    }
    if (numDerivatives == 1) {
        return place;
    }
    Pair const bend = solve(in.mixed[0], in.mixed[1]);
    auto const &[s, t] = place.first;
    double const products[3] = {2 * s[0] * t[0], s[0] * t[1] + s[1] * t[0], 2 * s[1] * t[1]};
    for (std::size_t i = 0; i < 3; ++i) {
        place.second[i] = {-bend[0] * products[i], -bend[1] * products[i]};
    }
    Pair const mixed = solve(cell.mixed[0], cell.mixed[1]);
    place.second[1] = {place.second[1][0] + mixed[0], place.second[1][1] + mixed[1]};
    return place;
}

namespace {

// From the control points of a face that few are alike.
template <typename TYPE, typename REAL>
void makePoints(TYPE const &type, int faceSize, int level, REAL const *control, int size,
                std::ptrdiff_t stride, REAL *points) {
    // What they have taken of memory is kept for the next face.
    static thread_local RefinedCells cells;
    static thread_local std::vector<double> packed;
    packed.clear();
    for (int i = 0; i < type.GetNumPoints(); ++i) {
        REAL const *const point = control + i * stride;
        packed.insert(packed.end(), point, point + size);
    }
    cells.SetBase(type, packed.data(), size);
    PointMaker<REAL>(cells, level, size, stride, points)
        .Make(RefinedCells::kBase, CornerAges(std::size_t(faceSize), -1));
}

} // namespace

template <typename REAL>
void MakeFacePatchPoints(BaseType const &type, int faceSize, int level, REAL const *control,
                         int size, std::ptrdiff_t stride, REAL *points) {
    if (PlainFaceType const *const plain = type.GetPlain()) {
        makePoints(*plain, faceSize, level, control, size, stride, points);
    } else if (type.IsInLattice()) {
        SumUpPlaces(getMatrix<REAL>(*type, 0, CornerAges(std::size_t(faceSize), -1), level),
                    {control, stride, std::size_t(size), nullptr, points, stride});
    } else {
        makePoints(*type, faceSize, level, control, size, stride, points);
    }
}

namespace {

// The cubic Bernstein polynomials and their derivatives, by order.
template <typename REAL>
struct Bernstein {
    explicit Bernstein(REAL s) {
        REAL const r = 1 - s;
        REAL const all[3][4] = {{r * r * r, 3 * r * r * s, 3 * r * s * s, s * s * s},
                                {-3 * r * r, 3 * r * (r - 2 * s), 3 * s * (2 * r - s), 3 * s * s},
                                {6 * r, 6 * (s - 2 * r), 6 * (r - 2 * s), 6 * s}};
        std::copy(&all[0][0], &all[0][0] + 12, &weights[0][0]);
    }

    REAL weights[3][4];
};

template <typename REAL>
OPENSUBDIVHEX_INLINE Lanes<REAL> sum(REAL const (&weights)[4], Lanes<REAL> const *points) {
    return points[0] * weights[0] + points[1] * weights[1] +
           (points[2] * weights[2] + points[3] * weights[3]);
}

// Some numbers of the points of a patch, as a bicubic patch has them at a place.
template <typename REAL>
class PatchLanes {
public:
    // \param numLanes    how many numbers of a point are there
    // \param isFollowed  whether all points but the last have numbers behind them that nobody writes
    OPENSUBDIVHEX_INLINE PatchLanes(REAL s, REAL t, REAL const *points, std::ptrdiff_t stride,
                                    int numLanes, bool isFollowed) {
        auto const share = [](REAL a, REAL b) { return a + b > 0 ? a / (a + b) : REAL(0.5); };
        auto const get = [&](int i) {
            REAL const *const point = points + i * stride;
            if (isFollowed && i + 1 < kNumPatchPoints) {
                return Lanes<REAL>::Load(point);
            }
            Lanes<REAL> result = {};
            std::copy_n(point, numLanes, result.values);
            return result;
        };
        auto const blend = [&](int corner, REAL first) {
            return get(5 * corner + 3) * first + get(5 * corner + 4) * (1 - first);
        };
        constexpr int kBorder[4][4] = {
            {0, 1, 7, 5}, {2, -1, -1, 6}, {16, -1, -1, 12}, {15, 17, 11, 10}};
        for (int row = 0; row < 4; ++row) {
            for (int column = 0; column < 4; ++column) {
                if (kBorder[row][column] >= 0) {
                    _grid[row][column] = get(kBorder[row][column]);
                }
            }
        }
        _grid[1][1] = blend(0, share(s, t));
        _grid[1][2] = blend(1, share(t, 1 - s));
        _grid[2][2] = blend(2, share(1 - s, 1 - t));
        _grid[2][1] = blend(3, share(1 - t, s));
    }

    // The rows, by t, of a derivative by s.
    OPENSUBDIVHEX_INLINE void FindRows(REAL const (&weights)[4], Lanes<REAL> *rows) const {
        for (int row = 0; row < 4; ++row) {
            rows[row] = sum(weights, _grid[row]);
        }
    }

private:
    Lanes<REAL> _grid[4][4];
};

template <int NUM_DERIVATIVES, typename REAL>
void evaluateLanes(PatchPlace const &place, REAL const *points, std::ptrdiff_t stride, int numLanes,
                   bool isFollowed, int lane, REAL *const *results) {
    auto const s = REAL(place.s);
    auto const t = REAL(place.t);
    Bernstein<REAL> const byS(s);
    Bernstein<REAL> const byT(t);
    PatchLanes<REAL> const patch(s, t, points + lane, stride, numLanes, isFollowed);
    auto const write = [&](int result, Lanes<REAL> const &values) {
        std::copy_n(values.values, numLanes, results[result] + lane);
    };
    Lanes<REAL> rows[3][4]; // by derivatives by s
    for (int order = 0; order <= NUM_DERIVATIVES; ++order) {
        patch.FindRows(byS.weights[order], rows[order]);
    }
    write(0, sum(byT.weights[0], rows[0]));
    if constexpr (NUM_DERIVATIVES > 0) {
        Lanes<REAL> const ds = sum(byT.weights[0], rows[1]);
        Lanes<REAL> const dt = sum(byT.weights[1], rows[0]);
        auto const &[toS, toT] = place.first;
        write(1, ds * REAL(toS[0]) + dt * REAL(toT[0]));
        write(2, ds * REAL(toS[1]) + dt * REAL(toT[1]));
        if constexpr (NUM_DERIVATIVES > 1) {
            Lanes<REAL> const dss = sum(byT.weights[0], rows[2]);
            Lanes<REAL> const dst = sum(byT.weights[1], rows[1]);
            Lanes<REAL> const dtt = sum(byT.weights[2], rows[0]);
            constexpr std::size_t kBy[3][2] = {{0, 0}, {0, 1}, {1, 1}};
            for (std::size_t k = 0; k < 3; ++k) {
                auto const [i, j] = kBy[k];
                write(int(3 + k),
                      dss * REAL(toS[i] * toS[j]) + dst * REAL(toS[i] * toT[j] + toS[j] * toT[i]) +
                          dtt * REAL(toT[i] * toT[j]) +
                          (ds * REAL(place.second[k][0]) + dt * REAL(place.second[k][1])));
            }
        }
    }
}

} // namespace

template <typename REAL>
void EvaluatePatch(PatchPlace const &place, int numDerivatives, REAL const *points, int size,
                   std::ptrdiff_t stride, REAL *const *results) {
    constexpr int kLanes = int(Lanes<REAL>::kCount);
    REAL const *const first = points + std::ptrdiff_t(place.patch) * kNumPatchPoints * stride;
    for (int lane = 0; lane < size; lane += kLanes) {
        int const numLanes = std::min(kLanes, size - lane);
        bool const isFollowed = lane + kLanes <= size || stride == size;
        auto const evaluate = [&](auto numLanesOfAll) {
            constexpr int kNum = decltype(numLanesOfAll)::value;
            int const number = kNum > 0 ? kNum : numLanes;
            if (numDerivatives == 0) {
                evaluateLanes<0>(place, first, stride, number, isFollowed, lane, results);
            } else if (numDerivatives == 1) {
                evaluateLanes<1>(place, first, stride, number, isFollowed, lane, results);
            } else {
                evaluateLanes<2>(place, first, stride, number, isFollowed, lane, results);
            }
        };
        if (numLanes == 3) { // by far the most
            evaluate(std::integral_constant<int, 3>());
        } else {
            evaluate(std::integral_constant<int, 0>());
        }
    }
}

template void MakeFacePatchPoints(BaseType const &, int, int, float const *, int, std::ptrdiff_t,
                                  float *);
template void MakeFacePatchPoints(BaseType const &, int, int, double const *, int, std::ptrdiff_t,
                                  double *);
template void EvaluatePatch(PatchPlace const &, int, float const *, int, std::ptrdiff_t,
                            float *const *);
template void EvaluatePatch(PatchPlace const &, int, double const *, int, std::ptrdiff_t,
                            double *const *);

} // namespace OpenSubdivHex::BfrExt::internal

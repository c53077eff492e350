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
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

using FarExt::internal::FaceCells;
using FarExt::internal::MakeFaceCells;
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

// Calls function(child, ages of its corners) for the children of a cell that makes so many; \p shape is that of a whole
// cell, or of size 0.
template <typename FUNCTION>
void forEachChild(FaceShape shape, int numChildren, CornerAges const &ages,
                  FUNCTION const &function) {
    function(0, CornerAges(ages.size(), 0));
    int const firstEdge = shape.size == 0 ? 1 : shape.GetFirstSector();
    for (int child = 1; child < numChildren; ++child) {
        int const edge = child - 1 + firstEdge;
        function(child, findEdgeAges(ages, std::size_t(edge)));
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
    forEachChild(type.GetShape(), int(children.size()), ages,
                 [&](int i, CornerAges const &ofChild) {
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

// Sums up the points of consecutive patches of a face, as far as they are wanted.
template <typename REAL>
class PatchSummer {
public:
    PatchSummer(std::vector<int> const *wanted, int size, std::ptrdiff_t stride, REAL *points)
        : _wanted(wanted), _size(size), _stride(stride), _points(points) {}

    // Whether one of the next patches is wanted; if not, they are skipped.
    bool SkipUnlessWanted(int numPatches) {
        if (!_wanted || findWanted(_patch) != findWanted(_patch + numPatches)) {
            return true;
        }
        _patch += numPatches;
        return false;
    }
    // Those that a matrix makes.
    void SumUp(PlaceMatrix<REAL> const &matrix, REAL const *points, std::ptrdiff_t stride) {
        auto const numPatches = int(matrix.GetNumPlaces()) / kNumPatchPoints;
        PlaceSums<REAL> sums = {points,
                                stride,
                                std::size_t(_size),
                                nullptr,
                                _points + std::ptrdiff_t(_patch) * kNumPatchPoints * _stride,
                                _stride};
        if (_wanted) {
            _runs.clear();
            auto const end = findWanted(_patch + numPatches);
            for (auto patch = findWanted(_patch); patch != end; ++patch) {
                addRuns((*patch - _patch) * kNumPatchPoints);
            }
            sums.runs = _runs.data();
            sums.numRuns = _runs.size();
        }
        SumUpPlaces(matrix, sums);
        _patch += numPatches;
    }

private:
    std::vector<int>::const_iterator findWanted(int patch) const {
        return std::lower_bound(_wanted->begin(), _wanted->end(), patch);
    }
    // The rows of a patch, and where they go: each to its own place.
    void addRuns(int row) {
        for (int const end = row + kNumPatchPoints; row < end;) {
            int const next = std::min(end, (row / PlaceRun::kMaxBlock + 1) * PlaceRun::kMaxBlock);
            _runs.push_back({row, row, next - row});
            row = next;
        }
    }

    std::vector<int> const *const _wanted;
    int const _size;
    std::ptrdiff_t const _stride;
    REAL *const _points;
    int _patch = 0; // the next one
    std::vector<PlaceRun> _runs;
};

// Refines the points of cells as far as their types are many, and makes those of patches by matrices of these.
template <typename REAL>
class PointMaker {
public:
    PointMaker(RefinedCells &cells, int level, PatchSummer<REAL> &summer)
        : _cells(cells), _level(level), _summer(summer) {}

    void Make(std::size_t cell, CornerAges const &ages) {
        FaceShape const shape = _cells[cell].GetShape();
        int const numLevels = _level - _cells[cell].GetLevel();
        if (!_summer.SkipUnlessWanted(shape.size > 0 ? GetNumFacePatches(shape, numLevels)
                                                     : getNumHalfPatches(numLevels))) {
            return;
        }
        if (_cells[cell].GetLevel() == RefinedCells::kFirstCommonLevel) {
            add(_cells[cell], ages);
            return;
        }
        std::size_t const first = _cells.GetFirstChild(cell);
        std::size_t const numCells = _cells.GetSize();
        forEachChild(shape, _cells.GetNumChildren(cell), ages,
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
        _summer.SumUp(matrix, _values.data(), std::ptrdiff_t(padded));
    }

    RefinedCells &_cells;
    int const _level;
    PatchSummer<REAL> &_summer;
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

int GetNumFacePatches(FaceShape shape, int level) {
    // A sector has 1 + 4 + 16 ... half cells.
    return MakeFaceCells(shape).GetNumPatches() +
           shape.GetNumSectors() * (getNumHalfPatches(level) - 1) / 3;
}

namespace {

// The linear part of a map from the coordinates in a sector.
using Linear = std::array<Pair, 2>;

// To those in a half cell of the same size, behind steps that turn it by so many sixths of a full turn.
constexpr Linear kFromSectorTo[6] = {{{{-0.5, 0.5}, {-1, -1}}}, {{{-1, -0.5}, {0, -1}}},
                                     {{{-0.5, -1}, {1, 0}}},    {{{0.5, -0.5}, {1, 1}}},
                                     {{{1, 0.5}, {0, 1}}},      {{{0.5, 1}, {-1, 0}}}};

// The kite with these corners in the plane that has a place.
Quadrilateral findInKite(Pair const (&corners)[4], Pair const &place) {
    // A + s B + t C + s t D, by Newton's method.
    Pair b;
    Pair c;
    Pair d;
    for (std::size_t i = 0; i < 2; ++i) {
        b[i] = corners[1][i] - corners[0][i];
        c[i] = corners[3][i] - corners[0][i];
        d[i] = corners[2][i] - corners[1][i] - c[i];
    }
    Quadrilateral in = {0.5, 0.5, {}, d};
    constexpr int kMaxSteps = 20;
    constexpr double kConverged = 1e-14;
    for (int step = 0; step < kMaxSteps; ++step) {
        Pair missing;
        for (std::size_t i = 0; i < 2; ++i) {
            in.bySt[i] = {b[i] + in.t * d[i], c[i] + in.s * d[i]};
            missing[i] = place[i] - (corners[0][i] + in.s * in.bySt[i][0] + in.t * c[i]);
        }
        auto const &[x, y] = in.bySt;
        double const determinant = x[0] * y[1] - x[1] * y[0];
        double const stepS = (missing[0] * y[1] - x[1] * missing[1]) / determinant;
        double const stepT = (x[0] * missing[1] - missing[0] * y[0]) / determinant;
        in.s += stepS;
        in.t += stepT;
        if (std::abs(stepS) + std::abs(stepT) < kConverged) {
            break;
        }
    }
    return in;
}

// From the coordinates in the sector of a side of half a polygon that is made of kites: in its plane, where it has the
// radius 1, and the middle of its first side is 0.
Quadrilateral findInHalf(int numCorners, int side, Pair const &coords, int &kite, Linear &linear) {
    double const unit = FarExt::internal::kPi / (numCorners - 1);
    auto const getCorner = [&](int i) {
        double const angle = unit * ((i + numCorners - 1) % numCorners);
        return Pair{std::cos(angle), std::sin(angle)};
    };
    Pair const start = getCorner(side);
    Pair const end = getCorner(side + 1);
    linear = {{{start[0], end[0]}, {start[1], end[1]}}};
    Pair const place = CellMap{{linear[0], linear[1]}, {0, 0}}.Apply(coords);
    auto const getMiddle = [](Pair const &p, Pair const &q) {
        return Pair{0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])};
    };
    auto const getMiddleOfSide = [&](int i) {
        return i % numCorners == 0 ? Pair{0, 0} : getMiddle(getCorner(i), getCorner(i + 1));
    };
    Pair const across = getMiddle(getCorner((numCorners + 1) / 2), getCorner(numCorners / 2 + 1));
    Pair const center = {across[0] / 3, across[1] / 3};
    auto const cross = [&](Pair const &to) {
        return (to[0] - center[0]) * (place[1] - center[1]) -
               (to[1] - center[1]) * (place[0] - center[0]);
    };
    double best = 0;
    for (int i = 0; i < numCorners; ++i) {
        double const inside =
            std::min(cross(getMiddleOfSide(i + numCorners - 1)), -cross(getMiddleOfSide(i)));
        if (i == 0 || inside > best) {
            best = inside;
            kite = i;
        }
    }
    Pair const corners[4] = {getCorner(kite), getMiddleOfSide(kite), center,
                             getMiddleOfSide(kite + numCorners - 1)};
    return findInKite(corners, place);
}

// From the coordinates in the sector of a whole cell to those that the shape of its patches is given by: the
// number of the patch among those of the cell, where the place is in it, and the map between them.
Quadrilateral findInWhole(FaceShape shape, int sector, Pair const &coords, int &patch,
                          Linear &linear) {
    int const size = shape.size;
    FaceCells const face = MakeFaceCells(shape);
    int const half = face.GetHalfOfEdge(sector);
    if (shape.isHalf && face.HasKites(half)) {
        return findInHalf(size, sector, coords, patch, linear);
    }
    auto const map = [&](Pair const &toStart, Pair const &toEnd, Pair const &center) {
        linear = {{{toStart[0], toEnd[0]}, {toStart[1], toEnd[1]}}};
        return CellMap{{linear[0], linear[1]}, center}.Apply(coords);
    };
    if (size == 4 && !shape.isHalf) {
        constexpr Pair kCorners[4] = {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}};
        Pair const st = map(kCorners[sector], kCorners[(sector + 1) % 4], {0.5, 0.5});
        return {st[0], st[1], {{1, 0}, {0, 1}}, {0, 0}};
    }
    if (face.AreHalves()) {
        patch = half;
        // Of a half, whose long edge is the diagonal, from the centre of that on, around from its end.
        constexpr Pair kCorners[4] = {{0.5, 0}, {0.25, 0.5}, {-0.25, 0.5}, {-0.5, 0}};
        int const local = face.GetSideOfEdge(sector) - 1;
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

PatchPlace FindPatchPlace(BfrPlace const &ofFace, FaceShape shape, int level, int numDerivatives) {
    int const sector = ofFace.point.sector;
    Pair coords = ofFace.point.coords;
    int left = level;
    for (; left > 0 && coords[0] + coords[1] <= 0.5; --left) {
        coords = {2 * coords[0], 2 * coords[1]};
    }
    PatchPlace place;
    place.patch = 0;
    Quadrilateral in;
    Linear linear;
    // Each step halves cells, but that from the sector to the half cell, which is part of the map.
    int const numHalvings = left == 0 ? level : level - 1;
    if (left == 0) {
        in = findInWhole(shape, sector, coords, place.patch, linear);
    } else {
        --left;
        coords = HalfCell::kFromSector.Apply(coords);
        place.patch = GetNumFacePatches(shape, left) +
                      (sector - shape.GetFirstSector()) * getNumHalfPatches(left);
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
    ByUv const cell(linear, double(1 << numHalvings), ofFace, shape.size > 4);
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
                std::ptrdiff_t stride, PatchSummer<REAL> &summer) {
    // Their memory is kept for the next face.
    static thread_local RefinedCells cells;
    static thread_local std::vector<double> packed;
    packed.clear();
    for (int i = 0; i < type.GetNumPoints(); ++i) {
        REAL const *const point = control + i * stride;
        packed.insert(packed.end(), point, point + size);
    }
    cells.SetBase(type, packed.data(), size);
    PointMaker<REAL>(cells, level, summer)
        .Make(RefinedCells::kBase, CornerAges(std::size_t(faceSize), -1));
}

} // namespace

template <typename REAL>
void MakeFacePatchPoints(BaseType const &type, int faceSize, int level, REAL const *control,
                         int size, std::ptrdiff_t stride, std::vector<int> const *wanted,
                         REAL *points) {
    PatchSummer<REAL> summer(wanted, size, stride, points);
    if (PlainFaceType const *const plain = type.GetPlain()) {
        makePoints(*plain, faceSize, level, control, size, stride, summer);
    } else if (type.IsInLattice()) {
        summer.SumUp(getMatrix<REAL>(*type, 0, CornerAges(std::size_t(faceSize), -1), level),
                     control, stride);
    } else {
        makePoints(*type, faceSize, level, control, size, stride, summer);
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

// Some numbers of the points of a patch, summed up row by row, by t, as those of a bicubic patch.
//
// IS_PACKED: points are three numbers each, without gaps; else numLanes of them are lanes.
template <int NUM_DERIVATIVES, bool IS_PACKED, typename REAL>
class PatchSums {
public:
    OPENSUBDIVHEX_INLINE PatchSums(REAL s, REAL t, REAL const *points, std::ptrdiff_t stride,
                                   int numLanes)
        : _byS(s), _byT(t), _points(points), _stride(IS_PACKED ? 3 : stride),
          _numLanes(IS_PACKED ? 3 : numLanes) {
        addRow<0>(load(0), load(1), load(7), load(5));
        addRow<1>(load(2), blend(3, s, t), blend(8, t, 1 - s), load(6));
        addRow<2>(load(16), blend(18, 1 - t, s), blend(13, 1 - s, 1 - t), load(12));
        addRow<3>(load(15), load(17), load(11), load(10));
    }

    Lanes<REAL> point = {};
    Lanes<REAL> ds = {};
    Lanes<REAL> dt = {};
    Lanes<REAL> dss = {};
    Lanes<REAL> dst = {};
    Lanes<REAL> dtt = {};

private:
    OPENSUBDIVHEX_INLINE Lanes<REAL> load(int i) const {
        REAL const *const from = _points + i * _stride;
        if constexpr (IS_PACKED) {
            return i + 1 < kNumPatchPoints ? Lanes<REAL>::Load(from) // with a number of the next
                                           : Lanes<REAL>{{from[0], from[1], from[2], 0}};
        }
        Lanes<REAL> result = {};
        std::copy_n(from, _numLanes, result.values);
        return result;
    }

    // The two points inside of a corner; where both distances are 0, their mean.
    OPENSUBDIVHEX_INLINE Lanes<REAL> blend(int first, REAL ofFirst, REAL ofSecond) const {
        constexpr REAL kLeast = std::numeric_limits<REAL>::min();
        REAL const share = (ofFirst + kLeast) / (ofFirst + ofSecond + 2 * kLeast);
        return load(first) * share + load(first + 1) * (1 - share);
    }

    template <int ROW>
    OPENSUBDIVHEX_INLINE void addRow(Lanes<REAL> const &a, Lanes<REAL> const &b,
                                     Lanes<REAL> const &c, Lanes<REAL> const &d) {
        auto const sum = [&](REAL const(&weights)[4]) {
            return a * weights[0] + b * weights[1] + (c * weights[2] + d * weights[3]);
        };
        Lanes<REAL> const ofPoint = sum(_byS.weights[0]);
        point = point + ofPoint * _byT.weights[0][ROW];
        if constexpr (NUM_DERIVATIVES > 0) {
            Lanes<REAL> const ofDs = sum(_byS.weights[1]);
            ds = ds + ofDs * _byT.weights[0][ROW];
            dt = dt + ofPoint * _byT.weights[1][ROW];
            if constexpr (NUM_DERIVATIVES > 1) {
                dss = dss + sum(_byS.weights[2]) * _byT.weights[0][ROW];
                dst = dst + ofDs * _byT.weights[1][ROW];
                dtt = dtt + ofPoint * _byT.weights[2][ROW];
            }
        }
    }

    Bernstein<REAL> const _byS;
    Bernstein<REAL> const _byT;
    REAL const *const _points;
    std::ptrdiff_t const _stride;
    int const _numLanes;
};

template <int NUM_DERIVATIVES, bool IS_PACKED, typename REAL>
void evaluateLanes(PatchPlace const &place, REAL const *points, std::ptrdiff_t stride, int numLanes,
                   REAL *const *results, int firstResult) {
    PatchSums<NUM_DERIVATIVES, IS_PACKED, REAL> const sums(REAL(place.s), REAL(place.t), points,
                                                           stride, numLanes);
    auto const write = [&](int result, Lanes<REAL> const &values) {
        std::copy_n(values.values, IS_PACKED ? 3 : numLanes, results[result] + firstResult);
    };
    write(0, sums.point);
    if constexpr (NUM_DERIVATIVES > 0) {
        auto const &[toS, toT] = place.first;
        write(1, sums.ds * REAL(toS[0]) + sums.dt * REAL(toT[0]));
        write(2, sums.ds * REAL(toS[1]) + sums.dt * REAL(toT[1]));
        if constexpr (NUM_DERIVATIVES > 1) {
            constexpr std::size_t kBy[3][2] = {{0, 0}, {0, 1}, {1, 1}};
            for (std::size_t k = 0; k < 3; ++k) {
                auto const [i, j] = kBy[k];
                write(int(3 + k), sums.dss * REAL(toS[i] * toS[j]) +
                                      sums.dst * REAL(toS[i] * toT[j] + toS[j] * toT[i]) +
                                      sums.dtt * REAL(toT[i] * toT[j]) +
                                      (sums.ds * REAL(place.second[k][0]) +
                                       sums.dt * REAL(place.second[k][1])));
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
        auto const evaluate = [&](auto isPacked) {
            constexpr bool kIsPacked = decltype(isPacked)::value;
            auto const evaluateTo = [&](auto number) {
                evaluateLanes<decltype(number)::value, kIsPacked>(place, first + lane, stride,
                                                                  numLanes, results, lane);
            };
            if (numDerivatives == 0) {
                evaluateTo(std::integral_constant<int, 0>());
            } else if (numDerivatives == 1) {
                evaluateTo(std::integral_constant<int, 1>());
            } else {
                evaluateTo(std::integral_constant<int, 2>());
            }
        };
        if (size == 3 && stride == 3) { // by far the most
            evaluate(std::true_type());
        } else {
            evaluate(std::false_type());
        }
    }
}

template void MakeFacePatchPoints(BaseType const &, int, int, float const *, int, std::ptrdiff_t,
                                  std::vector<int> const *, float *);
template void MakeFacePatchPoints(BaseType const &, int, int, double const *, int, std::ptrdiff_t,
                                  std::vector<int> const *, double *);
template void EvaluatePatch(PatchPlace const &, int, float const *, int, std::ptrdiff_t,
                            float *const *);
template void EvaluatePatch(PatchPlace const &, int, double const *, int, std::ptrdiff_t,
                            double *const *);

} // namespace OpenSubdivHex::BfrExt::internal

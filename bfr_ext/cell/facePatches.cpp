// SPDX-License-Identifier: Apache-2.0
#include "facePatches.h"

#include "baseType.h"

#include "far_ext/vtr/inline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <tuple>
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

// What cells of a type share whose corners are as old.
std::vector<int> makeKey(PatchAges const &ages, int numLevels) {
    std::vector<int> key = ages.ofVertices;
    key.push_back(ages.steps);
    key.push_back(numLevels);
    return key;
}

// The rows of the points of all patches that a cell is, some levels on.
std::vector<std::vector<double>> findRows(CellType const &type, int steps, CornerAges const &ages,
                                          int numLevels) {
    std::vector<std::vector<double>> rows;
    if (numLevels == 0) {
        PatchAges const limited = limitAges(steps, ages);
        std::vector<int> const key = makeKey(limited, 0);
        auto const &all = type.GetPatterns().Get<std::vector<double>>(
            PatternTable::GetKind<double>(PatternOf::PatchPoints), key.data(),
            key.data() + key.size(), [&] { return type.FindPatchPoints(limited); });
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

// Returns the columns of a patch's points that count.  Others together weigh no more than rounding; they are added to the
// column that weighs most, so that weights have the same sums.
template <typename REAL>
std::vector<int> takeColumns(std::vector<double> *rows) {
    constexpr double kRounding = 32 * std::numeric_limits<REAL>::epsilon();
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    std::vector<double> weights(rows->size(), 0);
    for (int row = 0; row < kNumPatchPoints; ++row) {
        for (std::size_t column = 0; column < weights.size(); ++column) {
            double const weight = std::abs(rows[row][column]);
            // Weights that are not numbers are the largest.
            weights[column] = std::isnan(weight) ? kInfinity : std::max(weights[column], weight);
        }
    }
    std::vector<int> columns(weights.size());
    std::iota(columns.begin(), columns.end(), 0);
    std::stable_sort(columns.begin(), columns.end(), [&](int a, int b) {
        return weights[std::size_t(a)] > weights[std::size_t(b)];
    });
    auto const first = std::size_t(columns[0]);
    double left = kRounding;
    while ((left -= weights[std::size_t(columns.back())]) >= 0) {
        for (int row = 0; row < kNumPatchPoints; ++row) {
            rows[row][first] += rows[row][std::size_t(columns.back())];
        }
        columns.pop_back();
    }
    std::sort(columns.begin(), columns.end());
    return columns;
}

// Returns the patches that cells of the type have some levels on, where their corners are as old.
template <typename REAL>
PatchRows<REAL> const &getRows(CellType const &type, int steps, CornerAges const &ages,
                               int numLevels) {
    std::vector<int> const key = makeKey(limitAges(steps, ages), numLevels);
    return type.GetPatterns().Get<PatchRows<REAL>>(
        PatternTable::GetKind<REAL>(PatternOf::PatchRows), key.data(), key.data() + key.size(),
        [&] { return PatchRows<REAL>(findRows(type, steps, ages, numLevels)); });
}

} // namespace

template <typename REAL>
class ChildPatches {
public:
    // order: by place, which of the points of the child, or of the rows of its step, patches are sums of; null: all in turn.
    ChildPatches(CellType const &child, StencilOf of, int level, std::vector<int> const *order)
        : _numbers(of == StencilOf::Step ? child.GetStep().GetNumRows()
                                         : std::size_t(child.GetNumPoints()),
                   -1) {
        CornerAges const ages = child.IsWhole() ? CornerAges(std::size_t(child.GetNumCorners()), 0)
                                                : CornerAges{-1, -1, 0, 0};
        if (of == StencilOf::Step) {
            std::vector<CellType::Child> const &children = child.GetChildren();
            forEachChild(child.GetShape(), int(children.size()), ages,
                         [&](int i, CornerAges const &ofChild) {
                             CellType::Child const &next = children[std::size_t(i)];
                             add(getRows<REAL>(*next.type, 2, ofChild, level - 2),
                                 [&](std::size_t point) { return next.step.GetMatrixRow(point); });
                         });
        } else {
            add(getRows<REAL>(child, 1, ages, level - 1), [](std::size_t point) { return point; });
        }
        _columns.shrink_to_fit();
        int const *columns = _columns.data();
        for (PatchBlock<REAL> &block : _blocks) {
            block.columns = columns;
            columns += block.numColumns;
        }
        if (order) {
            std::vector<int> places(_numbers.size());
            for (std::size_t i = 0; i < order->size(); ++i) {
                places[std::size_t((*order)[i])] = int(i);
            }
            for (int &source : _sources) {
                source = places[std::size_t(source)];
            }
        }
        _numbers = {};
        _blocks.shrink_to_fit();
        _sources.shrink_to_fit();
    }

    std::size_t GetHeapSize() const { return GetHeapSizes(_blocks, _sources, _columns); }
    // By patch.
    std::vector<PatchBlock<REAL>> const &GetBlocks() const { return _blocks; }
    // The points, as places of the order.
    std::vector<int> const &GetSources() const { return _sources; }

private:
    // getNumber: of a point of the cell, among all.
    template <typename GET>
    void add(PatchRows<REAL> const &ofCell, GET const &getNumber) {
        for (PatchBlock<REAL> const &block : ofCell.GetBlocks()) {
            _blocks.push_back(block);
            for (int i = 0; i < block.numColumns; ++i) {
                std::size_t const point = getNumber(std::size_t(block.columns[i]));
                int &number = _numbers[point];
                if (number < 0) {
                    number = int(_sources.size());
                    _sources.push_back(int(point));
                }
                _columns.push_back(number);
            }
        }
    }

    std::vector<PatchBlock<REAL>> _blocks;
    std::vector<int> _columns; // of all blocks, among the sources
    std::vector<int> _sources;
    std::vector<int> _numbers; // by point, among the sources; while these are made
};

namespace {

// Those of a child, kept with it.
template <typename REAL, typename CHILD>
ChildPatches<REAL> const &getPatches(CHILD const &child, CellType const &type, StencilOf of,
                                     int level, std::vector<int> const *order) {
    return child.GetPatterns().template Get<ChildPatches<REAL>>(
        PatternTable::GetKind<REAL>(PatternOf::ChildPatches), &level, &level + 1,
        [&] { return ChildPatches<REAL>(type, of, level, order); });
}

template <typename REAL>
ChildPatches<REAL> const &getPatches(CellType const &child, int level) {
    return getPatches<REAL>(child, child, StencilOf::Step, level, nullptr);
}

template <typename REAL>
ChildPatches<REAL> const &getPatches(RingCell const &child, int level) {
    return getPatches<REAL>(child, child.GetType(), child.GetSources(), level, &child.GetColumns());
}

// Makes the points that patches of base faces outside of lattices are sums of; scratch memory is kept for the next face.
template <typename REAL>
class PointMaker {
public:
    // size: of a point; stride: from one to the next; points: where they go
    void Init(int size, std::ptrdiff_t stride, REAL *points) {
        _size = std::size_t(size);
        _paddedSize = StepMatrix::GetPaddedSize(_size);
        _stride = stride;
        _points = points;
    }

    // sources: of the points, here and below
    void MakeOfRings(PlainFaceType const &type, std::vector<int> const &sources,
                     REAL const *control) {
        _rings.Set(type.GetRings().GetRings(), nullptr,
                   {control, _stride, _size, std::size_t(type.GetNumPoints()), nullptr});
        REAL const *const ofRings = _rings.GetPoints();
        for (int const source : sources) {
            write(ofRings + std::size_t(source) * _paddedSize);
        }
    }

    // getNumPoints: of a child
    template <typename GET>
    void MakeOfSteps(CellType const &type, int const *sources, GET const &getNumPoints,
                     REAL const *control) {
        auto const numPoints = std::size_t(type.GetNumPoints());
        grow(_ofChild, numPoints);
        for (std::size_t i = 0; i < numPoints; ++i) {
            StepMatrix::Pad(control + std::ptrdiff_t(i) * _stride, _size,
                            &_ofChild[i * _paddedSize]);
        }
        StepMatrix const &step = type.GetStep();
        grow(_ofFace, step.GetNumRows());
        step.Apply(_ofChild.data(), _paddedSize, _ofFace.data());
        for (std::size_t i = 0; i < type.GetChildren().size(); ++i) {
            CellType::Child const &child = type.GetChildren()[i];
            grow(_ofChild, child.step.GetNumRows());
            child.step.CopyPoints(_ofFace.data(), _paddedSize, _ofChild.data());
            StepMatrix const &ofChild = child.type->GetStep();
            grow(_refined, ofChild.GetNumRows());
            ofChild.Apply(_ofChild.data(), _paddedSize, _refined.data());
            int const *const end = sources + getNumPoints(i);
            for (; sources != end; ++sources) {
                write(&_refined[std::size_t(*sources) * _paddedSize]);
            }
        }
    }

private:
    void write(REAL const *point) {
        StepMatrix::Pad(point, _size, _points);
        _points += _stride;
    }
    void grow(std::vector<REAL> &numbers, std::size_t numPoints) const {
        numbers.resize(std::max(numbers.size(), numPoints * _paddedSize));
    }

    std::size_t _size = 0;
    std::size_t _paddedSize = 0;
    std::ptrdiff_t _stride = 0;
    REAL *_points = nullptr; // the next one
    RingValues<REAL> _rings;
    std::vector<REAL> _ofFace;  // what its step makes
    std::vector<REAL> _ofChild; // points before its step
    std::vector<REAL> _refined;
};

// The coordinates of a cell in which a patch is a bilinear quadrilateral, and where a place is in it.
struct Quadrilateral {
    double s;
    double t;
    Pair byCoords[2]; // derivatives of s, and of t, by the coordinates
    Pair mixed;       // of the coordinates by s and t
};

OPENSUBDIVHEX_INLINE Quadrilateral findInTrapezoid(Pair const &coords) {
    double const h = coords[1];
    double const byLength = 1 / (1 - h);
    double const s = (coords[0] - 0.5 * h) * byLength;
    return {s, 2 * h, {{byLength, (s - 0.5) * byLength}, {0, 2}}, {-0.5, 0}};
}

// The kite between the middles of two edges, by which coordinates are, the centre, and a corner, which is
// (1 + m) times the sum of the two middles.
Quadrilateral findInKite(Pair const &coords, double m) {
    // a = 1 - s and b = 1 - t: the coordinates are b (1 + m a) and a (1 + m b).
    double const difference = coords[0] - coords[1];
    double const linear = 1 + m * difference;
    double const a = 2 * coords[1] / (linear + std::sqrt(linear * linear + 4 * m * coords[1]));
    double const b = a + difference;
    double const factor = 1 / (1 + m * (a + b));
    return {1 - a,
            1 - b,
            {{m * a * factor, -(1 + m * a) * factor}, {-(1 + m * b) * factor, m * b * factor}},
            {m, m}};
}

// A half cell of a level.
struct SectorCell {
    CellMap map; // from coordinates in the sector to those in the cell
    // Patches of sectors before those of the step that made the cell, and of that step, and those before the cell.
    int numBeforeStep;
    int numInStep;
    int numBefore;
};

// The half cells of a level in the sector of an edge of a base face, by place.
//
// Lines parallel to the sides of the sector divide it into triangles.  A half cell is three of them, and the one at the
// centre is the sector of a whole cell.
class SectorCells {
public:
    static SectorCells const &Get(int level) {
        static std::vector<SectorCells> const kAll = makeAll();
        return kAll[std::size_t(level - kFirstPatchLevel)];
    }

    // Null: in the whole cell.
    OPENSUBDIVHEX_INLINE SectorCell const *Find(Pair const &coords) const {
        // Coordinates that are not numbers lie in the last triangles.
        double const a = coords[0] * _width;
        double const b = coords[1] * _width;
        int const i = int(std::min(double(_width - 1), a));
        int const k = int(std::min(double(_width - 1), b));
        // The upper triangle lies beyond the diagonal.
        int const isUpper = int(std::min(double(_width), a + b)) - (i + k);
        int const cell = _ofTriangles[2 * (i * _width + k) + isUpper];
        return cell < 0 ? nullptr : &_cells[std::size_t(cell)];
    }

private:
    static std::vector<SectorCells> makeAll() {
        std::vector<SectorCells> all;
        for (int level = kFirstPatchLevel; level <= kLastPatchLevel; ++level) {
            all.push_back(SectorCells(level));
        }
        return all;
    }

    explicit SectorCells(int level)
        : _width(1 << level), _cells(std::size_t(getNumHalfPatches(level) - 1) / 3) {
        _ofTriangles.reserve(2 * std::size_t(_width) * std::size_t(_width));
        for (int i = 0; i < _width; ++i) {
            for (int k = 0; k < _width; ++k) {
                for (double const middle : {1.0 / 3, 2.0 / 3}) {
                    // Triangles beyond the edge have places by rounding alone, of the cell at the edge.
                    double const scale = 1 / std::max(double(_width), i + k + 2 * middle);
                    _ofTriangles.push_back(
                        add(level, {(i + middle) * scale, (k + middle) * scale}));
                }
            }
        }
    }

    // Adds the cell that has a place; -1: the whole cell.
    int add(int level, Pair coords) {
        CellMap map = {{{1, 0}, {0, 1}}, {0, 0}};
        auto const go = [&](CellMap const &next) {
            map = Concatenate(map, next);
            coords = next.Apply(coords);
        };
        int left = level;
        while (left > 0 && coords[0] + coords[1] <= 0.5) {
            go(kToFFace);
            --left;
        }
        if (left == 0) {
            return -1;
        }
        --left;
        go(HalfCell::kFromSector);
        SectorCell cell = {{}, (getNumHalfPatches(left) - 1) / 3, getNumHalfPatches(left), 0};
        while (left > 0) {
            --left;
            int const child = HalfCell::FindChild(coords);
            cell.numBefore += child * getNumHalfPatches(left);
            go(HalfCell::kChildren[child]);
        }
        cell.map = map;
        int const number = cell.numBeforeStep + cell.numBefore;
        _cells[std::size_t(number)] = cell;
        return number;
    }

    int _width; // triangles at a side
    std::vector<SectorCell> _cells;
    std::vector<std::int16_t> _ofTriangles; // two of each parallelogram
};

// The linear part of a map from the coordinates in a sector.
using Linear = std::array<Pair, 2>;

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
        Pair bySt[2];
        Pair missing;
        for (std::size_t i = 0; i < 2; ++i) {
            bySt[i] = {b[i] + in.t * d[i], c[i] + in.s * d[i]};
            missing[i] = place[i] - (corners[0][i] + in.s * bySt[i][0] + in.t * c[i]);
        }
        auto const &[x, y] = bySt;
        double const factor = 1 / (x[0] * y[1] - x[1] * y[0]);
        in.byCoords[0] = {y[1] * factor, -x[1] * factor};
        in.byCoords[1] = {-y[0] * factor, x[0] * factor};
        auto const getStep = [&](Pair const &by) {
            return by[0] * missing[0] + by[1] * missing[1];
        };
        double const stepS = getStep(in.byCoords[0]);
        double const stepT = getStep(in.byCoords[1]);
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
        // The corners of a half from the centre of its long edge, the diagonal, on, around from the end of that edge.
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

// The derivatives of a coordinate, which a map makes of those in a sector, by u and v: once, and by both.
struct ByUv {
    OPENSUBDIVHEX_INLINE ByUv(Pair const &row, BfrPlace const &place, bool hasSubFaces)
        // By the coordinates of the plane, which in triangles and quads are u and v.
        : u(row[0] * place.point.toCoords[0][0] + row[1] * place.point.toCoords[1][0]),
          v(row[0] * place.point.toCoords[0][1] + row[1] * place.point.toCoords[1][1]) {
        if (hasSubFaces) {
            auto const &[x, y] = place.toOwn;
            mixed = u * place.mixed[0] + v * place.mixed[1];
            std::tie(u, v) = std::pair(u * x[0] + v * y[0], u * x[1] + v * y[1]);
        }
    }

    double u;
    double v;
    double mixed = 0;
};

// Adds where the place is in its patch, whose cell has coordinates that are a linear map from those in the sector.
template <bool HAS_SECOND>
OPENSUBDIVHEX_INLINE void addPlace(Quadrilateral const &in, Linear const &linear,
                                   BfrPlace const &ofFace, bool hasSubFaces, PatchPlace &place) {
    // Gregory patches have poles beyond their corners.
    place.s = std::min(std::max(in.s, 0.0), 1.0);
    place.t = std::min(std::max(in.t, 0.0), 1.0);
    ByUv const x(linear[0], ofFace, hasSubFaces);
    ByUv const y(linear[1], ofFace, hasSubFaces);
    auto const toSt = [&](double first, double second) {
        return Pair{in.byCoords[0][0] * first + in.byCoords[0][1] * second,
                    in.byCoords[1][0] * first + in.byCoords[1][1] * second};
    };
    Pair const byU = toSt(x.u, y.u);
    Pair const byV = toSt(x.v, y.v);
    place.first[0] = {byU[0], byV[0]};
    place.first[1] = {byU[1], byV[1]};
    if constexpr (HAS_SECOND) {
        Pair const bend = toSt(in.mixed[0], in.mixed[1]);
        auto const &[s, t] = place.first;
        double const products[3] = {2 * s[0] * t[0], s[0] * t[1] + s[1] * t[0], 2 * s[1] * t[1]};
        for (std::size_t i = 0; i < 3; ++i) {
            place.second[i] = {-bend[0] * products[i], -bend[1] * products[i]};
        }
        Pair const mixed = toSt(x.mixed, y.mixed);
        place.second[1] = {place.second[1][0] + mixed[0], place.second[1][1] + mixed[1]};
    }
}

// The place in a whole or half cell of a level, but for its patch in a half cell.
template <bool HAS_SECOND>
void findInMiddle(BfrPlace const &ofFace, FaceShape shape, int level, PatchPlace &place) {
    double const scale = 1 << level;
    auto const [a, b] = ofFace.point.coords;
    place.patch = 0;
    Linear linear;
    Quadrilateral const in =
        findInWhole(shape, ofFace.point.sector, {scale * a, scale * b}, place.patch, linear);
    for (Pair &row : linear) {
        row = {scale * row[0], scale * row[1]};
    }
    addPlace<HAS_SECOND>(in, linear, ofFace, shape.size > 4, place);
}
template <bool HAS_SECOND>
OPENSUBDIVHEX_INLINE void findInHalfCell(BfrPlace const &ofFace, FaceShape shape,
                                         CellMap const &map, PatchPlace &place) {
    addPlace<HAS_SECOND>(findInTrapezoid(map.Apply(ofFace.point.coords)),
                         {map.rows[0], map.rows[1]}, ofFace, shape.size > 4, place);
}

// Finds the place in its patch.  Calls function() as soon as the number of the patch is known, if it is a half cell.
template <typename FUNCTION>
OPENSUBDIVHEX_INLINE void findPatchPlace(BfrPlace const &ofFace, FaceShape shape, int level,
                                         int numDerivatives, PatchPlace &place,
                                         FUNCTION const &function) {
    SectorCell const *const cell = SectorCells::Get(level).Find(ofFace.point.coords);
    if (!cell) {
        numDerivatives > 1 ? findInMiddle<true>(ofFace, shape, level, place)
                           : findInMiddle<false>(ofFace, shape, level, place);
        return;
    }
    place.patch =
        MakeFaceCells(shape).GetNumPatches() + shape.GetNumSectors() * cell->numBeforeStep +
        (ofFace.point.sector - shape.GetFirstSector()) * cell->numInStep + cell->numBefore;
    function();
    numDerivatives > 1 ? findInHalfCell<true>(ofFace, shape, cell->map, place)
                       : findInHalfCell<false>(ofFace, shape, cell->map, place);
}

} // namespace

PatchPlace FindPatchPlace(BfrPlace const &ofFace, FaceShape shape, int level, int numDerivatives) {
    PatchPlace place;
    findPatchPlace(ofFace, shape, level, numDerivatives, place, [] {});
    return place;
}

namespace {

// Asks for numbers, so that they are on their way while the place in a patch is computed: benchmark places of surfaces is
// 1.5 times as fast.  GCC leaves out a call that does nothing else and is not inlined.
template <typename T>
OPENSUBDIVHEX_INLINE void prefetch([[maybe_unused]] T const *numbers,
                                   [[maybe_unused]] std::ptrdiff_t count) {
#if defined(__GNUC__)
    constexpr std::ptrdiff_t kLine = 64 / sizeof(T);
    for (std::ptrdiff_t i = 0; i < count - 1; i += kLine) {
        __builtin_prefetch(numbers + i);
    }
    __builtin_prefetch(numbers + count - 1);
#endif
}

} // namespace

template <typename REAL>
PatchRows<REAL>::PatchRows(std::vector<std::vector<double>> rows) {
    std::vector<std::size_t> firstWeights;
    for (std::size_t first = 0; first < rows.size(); first += kNumPatchPoints) {
        std::vector<double> *const points = &rows[first];
        std::size_t const firstColumn = _columns.size();
        std::vector<int> const used = takeColumns<REAL>(points);
        _columns.insert(_columns.end(), used.begin(), used.end());
        int const numUsed = int(_columns.size() - firstColumn);
        int const numColumns = PatchBlock<REAL>::GetPaddedSize(numUsed);
        _columns.resize(firstColumn + std::size_t(numColumns), _columns[firstColumn]);
        firstWeights.push_back(_weights.size());
        _weights.resize(_weights.size() + std::size_t(kNumPatchPoints * numColumns));
        REAL *const to = _weights.data() + firstWeights.back();
        for (int row = 0; row < kNumPatchPoints; ++row) {
            for (int i = 0; i < numUsed; ++i) {
                auto const column = std::size_t(_columns[firstColumn + std::size_t(i)]);
                double weight = points[PatchRow::kPoints[row]][column];
                if (row >= PatchRow::kNumBicubic) {
                    int const second = PatchRow::kOfCorners[row - PatchRow::kNumBicubic];
                    weight -= points[PatchRow::kPoints[second]][column];
                }
                to[PatchBlock<REAL>::GetPlace(row, i)] = REAL(weight);
            }
        }
        _blocks.push_back({nullptr, nullptr, numColumns});
    }
    int const *columns = _columns.data();
    for (std::size_t patch = 0; patch < _blocks.size(); ++patch) {
        _blocks[patch].weights = _weights.data() + firstWeights[patch];
        _blocks[patch].columns = columns;
        columns += _blocks[patch].numColumns;
    }
}

template <typename REAL>
FacePatches<REAL> const &FacePatches<REAL>::Get(BaseType const &type, int level) {
    PlainFaceType const *const plain = type.GetPlain();
    PatternTable &patterns =
        plain ? plain->GetRings().GetPatternsOfChildren() : type->GetPatterns();
    return patterns.Get<FacePatches>(PatternTable::GetKind<REAL>(PatternOf::FacePatches), &level,
                                     &level + 1, [&] { return FacePatches(type, level); });
}

template <typename REAL>
FacePatches<REAL>::FacePatches(BaseType const &type, int level) {
    if (PlainFaceType const *const plain = type.GetPlain()) {
        FaceRings const &face = plain->GetRings();
        VertexRings const &rings = face.GetRings();
        std::vector<int> indices;
        for (std::size_t i = 0; i <= rings.GetRings().size(); ++i) {
            RingPlaces const &places = face.GetChild(i).GetPlaces();
            indices.resize(places.GetColumns().size());
            face.FindChildIndices(
                i, places,
                [&](int ring, int ofRing) {
                    return rings.GetPoints(ring, 0, ofRing, rings.GetLastStep());
                },
                indices.data());
            addChild(getPatches<REAL>(face.GetChild(i), level),
                     [&](int source) { return indices[std::size_t(source)]; });
        }
    } else if (type.IsInLattice()) {
        CornerAges const ages(std::size_t(type->GetNumCorners()), -1);
        _ofLattice = PatchRows<REAL>(findRows(*type, 0, ages, level));
        add(_ofLattice.GetBlocks(), type->GetNumPoints());
    } else {
        for (CellType::Child const &child : type->GetChildren()) {
            addChild(getPatches<REAL>(*child.type, level), [](int source) { return source; });
        }
    }
    _sources.shrink_to_fit();
    _otherParts.shrink_to_fit();
}

template <typename REAL>
void FacePatches<REAL>::add(std::vector<PatchBlock<REAL>> const &blocks, int numPoints) {
    Part const part = {blocks.data(), GetNumPoints(), numPoints};
    auto const number = std::size_t(_numParts++);
    if (number == 0) {
        _numInFirst = int(blocks.size());
    }
    if (number < _parts.size()) {
        _parts[number] = part;
    } else {
        _otherParts.push_back(part);
    }
}

template <typename REAL>
template <typename GET>
void FacePatches<REAL>::addChild(ChildPatches<REAL> const &child, GET const &getSource) {
    add(child.GetBlocks(), int(child.GetSources().size()));
    for (int const source : child.GetSources()) {
        _sources.push_back(getSource(source));
    }
}

template <typename REAL>
void FacePatches<REAL>::MakePoints(BaseType const &type, REAL const *control, int size,
                                   std::ptrdiff_t stride, REAL *points) const {
    static thread_local PointMaker<REAL> maker;
    maker.Init(size, stride, points);
    if (PlainFaceType const *const plain = type.GetPlain()) {
        maker.MakeOfRings(*plain, _sources, control);
    } else {
        maker.MakeOfSteps(
            *type, _sources.data(), [&](std::size_t child) { return getPart(child).numPoints; },
            control);
    }
}

template <typename REAL>
auto FacePatches<REAL>::findBlock(int level, int patch) const
    -> std::pair<Part const *, PatchBlock<REAL> const *> {
    if (patch < _numInFirst) {
        return {&_parts[0], _parts[0].blocks + patch};
    }
    int const levels = 2 * (level - 1);
    int const behindFirst = patch - _numInFirst;
    Part const &part = getPart(1 + std::size_t(behindFirst >> levels));
    return {&part, part.blocks + (behindFirst & ((1 << levels) - 1))};
}

template <typename REAL>
void FacePatches<REAL>::Evaluate(Bfr::Parameterization const &parameterization, FaceShape shape,
                                 int level, Pair const &uv, int numDerivatives, REAL const *points,
                                 int size, std::ptrdiff_t stride, REAL *const *results) const {
    prefetch(&_numInFirst,
             (sizeof(_numInFirst) + sizeof(_numParts) + sizeof(_parts)) / sizeof(int));
    BfrPlace const ofFace = FindBfrPlace(parameterization, shape, uv, 0);
    PatchPlace place;
    constexpr int kUsualGroups = 3; // of the columns of a patch
    findPatchPlace(ofFace, shape, level, numDerivatives, place, [&] {
        auto const [part, block] = findBlock(level, place.patch);
        constexpr int kGroup = PatchBlock<REAL>::kGroup;
        prefetch(block->columns, kUsualGroups * kGroup);
        prefetch(points + part->firstPoint * stride, part->numPoints * stride);
        prefetch(block->weights, kNumPatchPoints * kGroup); // of the first group
    });
    auto const [part, block] = findBlock(level, place.patch);
    SumUpPatch(
        {place, numDerivatives, *block, points + part->firstPoint * stride, size, stride, results});
}

template class PatchRows<float>;
template class FacePatches<float>;
template class PatchRows<double>;
template class FacePatches<double>;

} // namespace OpenSubdivHex::BfrExt::internal

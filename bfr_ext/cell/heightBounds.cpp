// SPDX-License-Identifier: Apache-2.0
#include "heightBounds.h"

#include "cellBounds.h"
#include "latticePlaces.h"

#include <algorithm>
#include <cmath>

namespace OpenSubdivHex::BfrExt::internal {

namespace {

// Of the intervals of a half cell that is one part, of what is bounded in all; its long side is 1.
constexpr double kMaxRadius = 0.03;
constexpr int kMinDepth = 2;
constexpr int kMaxDepth = 8;
constexpr int kMaxRest = 64;  // cells that may be left at the last depth
constexpr int kNumSteps = 24; // after which intervals are as wide as they are

Pair add(Pair const &p, Pair const &q) { return {p[0] + q[0], p[1] + q[1]}; }
Pair subtract(Pair const &p, Pair const &q) { return {p[0] - q[0], p[1] - q[1]}; }

// In the middle of a cell, around which numbers are small.
Pair getCenter() { return ToLattice({0.5, 0.25}); }

// Twice the area to the left of an edge.
double getArea(Pair const &start, Pair const &end, Pair const &p) {
    Pair const along = subtract(end, start);
    Pair const across = subtract(p, start);
    return along[0] * across[1] - along[1] * across[0];
}

// Heights at the corners of a half cell are those of a linear function if the first edge is twice the
// one across.  Else they miss it by a defect; this makes of them the closest that do not.
void removeDefect(std::array<double, 4> &heights) {
    constexpr std::array<double, 4> kDefect = {-1, 1, -2, 2};
    constexpr double kSquareOfDefect = 10;
    double defect = 0;
    for (std::size_t k = 0; k < heights.size(); ++k) {
        defect += kDefect[k] * heights[k];
    }
    for (std::size_t k = 0; k < heights.size(); ++k) {
        heights[k] -= kDefect[k] * defect / kSquareOfDefect;
    }
}

} // namespace

// What places in a child are in the plane of the cell.
struct HeightBounds::ChildMap {
    explicit ChildMap(std::size_t child) {
        // Steps turn places and make them larger.
        CellMap const &toChild = HalfCell::kChildren[child];
        double const determinant =
            toChild.rows[0][0] * toChild.rows[1][1] - toChild.rows[0][1] * toChild.rows[1][0];
        auto const toParent = [&](Pair const &p) {
            Pair const d = subtract({p[0], p[1] / ToLattice({0, 1})[1]}, toChild.shift);
            return ToLattice(
                {(toChild.rows[1][1] * d[0] - toChild.rows[0][1] * d[1]) / determinant,
                 (toChild.rows[0][0] * d[1] - toChild.rows[1][0] * d[0]) / determinant});
        };
        Pair const center = getCenter();
        Pair const origin = toParent(center);
        Pair const x = subtract(toParent(add(center, {1, 0})), origin);
        Pair const y = subtract(toParent(add(center, {0, 1})), origin);
        shift = subtract(origin, center);
        rows[0] = {x[0], y[0]};
        rows[1] = {x[1], y[1]};
    }

    Pair Apply(Pair const &p) const {
        return {shift[0] + rows[0][0] * p[0] + rows[0][1] * p[1],
                shift[1] + rows[1][0] * p[0] + rows[1][1] * p[1]};
    }
    // A term of the cell, as factors of those of the child.
    Terms GetTerm(std::size_t term) const {
        Terms const x = {shift[0], rows[0][0], rows[0][1], 0, 0, 0};
        Terms const y = {shift[1], rows[1][0], rows[1][1], 0, 0, 0};
        auto const multiply = [](Terms const &a, Terms const &b) {
            return Terms{a[0] * b[0], a[0] * b[1] + a[1] * b[0], a[0] * b[2] + a[2] * b[0],
                         a[1] * b[1], a[1] * b[2] + a[2] * b[1], a[2] * b[2]};
        };
        switch (term) {
        case 0:
            return {1, 0, 0, 0, 0, 0};
        case 1:
            return x;
        case 2:
            return y;
        case 3:
            return multiply(x, x);
        case 4:
            return multiply(x, y);
        default:
            return multiply(y, y);
        }
    }

    Pair rows[2];
    Pair shift;
};

// How a function comes close to heights in cells of a type, and what the surface has for it.
class HeightBounds::Fit {
public:
    explicit Fit(CellType const &type);

    // That of a type, which is found once.
    static Fit const &Find(CellType const &type) {
        return type.GetPatterns().Get<Fit>(PatternTable::GetKind<double>(PatternOf::HeightFit),
                                           nullptr, nullptr, [&] { return Fit(type); });
    }

    // Of a half cell, how far the surface may be from what a term becomes.
    double GetMaxRadius() const { return *std::max_element(_radii.begin(), _radii.end()); }
    // What the points have for the terms, padded.
    std::vector<double> GetValues() const;

    Terms FindFunction(double const *heights) const;
    // Writes what heights have besides a function of the places.
    void Subtract(double const *heights, Terms const &function, double *result) const;
    // Of a half cell, what the surface is for some heights, and something in a range besides.
    Terms FindSurface(std::vector<double> const &heights, Range &rests,
                      std::vector<double> &scratch) const;

private:
    // Bounds the sum of what heights have besides a function.
    Range findRests(double const *heights, Terms const &function,
                    std::vector<double> &scratch) const;

    Terms _shifts = {};         // of the surface from a term, in half cells
    Terms _radii = {};          // and how far it may be from there
    std::vector<double> _fit;   // by point and term, padded: the factors of q as sums of heights
    std::vector<double> _terms; // by term and point
    std::vector<double> _maxWeights; // m
};

// Finds the parts of a cell.
class HeightBounds::Maker {
public:
    Maker(CellType const &type, Fit const &fit)
        : _size(std::size_t(type.GetNumPoints())), _firstTerm(StepMatrix::GetPaddedSize(_size)),
          _width(_firstTerm + kPadded) {
        // Of each point, what it is itself, and what the terms are at its place.
        std::vector<double> const terms = fit.GetValues();
        std::vector<double> values(_size * _width);
        for (std::size_t i = 0; i < _size; ++i) {
            values[i * _width + i] = 1;
            std::copy_n(&terms[i * kPadded], kPadded, &values[i * _width + _firstTerm]);
        }
        while (_maxDepth < kMaxDepth && countRest(type, 1, _maxDepth + 1) <= kMaxRest) {
            ++_maxDepth;
        }
        descend(type, 1, values);
    }

    std::vector<Corners> parts;
    std::vector<std::vector<double>> samples;
    std::vector<std::vector<double>> rests;

private:
    // What a cell so many steps on is close to, as one part; null where it is not.
    static Fit const *findFit(CellType const &type, int depth) {
        if (type.IsWhole() || depth < kMinDepth) {
            return nullptr;
        }
        Fit const &fit = Fit::Find(type);
        return fit.GetMaxRadius() <= kMaxRadius ? &fit : nullptr;
    }

    // How many cells are left at the last depth, of the children of a cell that are made at some depth.
    static int countRest(CellType const &type, int depth, int last) {
        int count = 0;
        for (CellType::Child const &child : type.GetChildren()) {
            if (!findFit(*child.type, depth)) {
                count += depth == last ? 1 : countRest(*child.type, depth + 1, last);
            }
        }
        return count;
    }

    void descend(CellType const &type, int depth, std::vector<double> const &values) {
        StepMatrix const &step = type.GetStep();
        std::vector<double> refined(step.GetNumRows() * _width);
        step.Apply(values.data(), _width, refined.data());
        for (CellType::Child const &child : type.GetChildren()) {
            std::vector<double> ofChild(std::size_t(child.type->GetNumPoints()) * _width);
            child.step.CopyPoints(refined.data(), _width, ofChild.data());
            if (Fit const *const fit = findFit(*child.type, depth)) {
                addPart(*child.type, *fit, ofChild);
            } else if (depth == _maxDepth) {
                addConstant(*child.type, ofChild);
            } else {
                descend(*child.type, depth + 1, ofChild);
            }
        }
    }

    // Of the points of a part, for a point or term of the cell.
    void getHeights(std::vector<double> const &values, std::size_t column) {
        _heights.clear();
        for (std::size_t i = column; i < values.size(); i += _width) {
            _heights.push_back(values[i]);
        }
    }

    // Calls function(column) for points and terms, which gives how far the surface is from linear.
    template <typename FUNCTION>
    void addRests(FUNCTION const &function) {
        std::vector<double> row;
        for (std::size_t i = 0; i < _size; ++i) {
            row.push_back(function(i));
        }
        for (std::size_t k = 1; k < kNumTerms; ++k) {
            row.push_back(function(_firstTerm + k));
        }
        rests.push_back(std::move(row));
    }

    std::vector<double> findCorner(CellType const &type, std::size_t corner,
                                   std::vector<double> const &values) const {
        std::vector<double> const &weights = type.GetCornerPoints()[corner];
        std::vector<double> row(_width);
        for (std::size_t i = 0; i < weights.size(); ++i) {
            for (std::size_t k = 0; k < _width; ++k) {
                row[k] += weights[i] * values[i * _width + k];
            }
        }
        return row;
    }

    // The number of a sample, which is added if it is new.
    std::size_t findSample(std::vector<double> const &row) {
        constexpr double kTolerance = 1e-9;
        auto const isSame = [&](std::vector<double> const &other) {
            return std::equal(other.begin(), other.end(), row.begin(),
                              [](double a, double b) { return std::abs(a - b) < kTolerance; });
        };
        auto const found = std::find_if(samples.begin(), samples.end(), isSame);
        auto const number = std::size_t(found - samples.begin());
        if (found == samples.end()) {
            samples.emplace_back(row.begin(), row.begin() + std::ptrdiff_t(_size));
        }
        return number;
    }

    void addPart(CellType const &type, Fit const &fit, std::vector<double> const &values) {
        static std::array<Pair, kNumCorners> const kPlaces = getCorners();
        std::array<std::vector<double>, kNumCorners> corners;
        Corners numbers;
        for (std::size_t k = 0; k < kNumCorners; ++k) {
            corners[k] = findCorner(type, k, values);
            numbers[k] = findSample(corners[k]);
        }
        parts.push_back(numbers);
        addRests([&](std::size_t column) {
            getHeights(values, column);
            Range ofSurface = {0, 0};
            Terms function = fit.FindSurface(_heights, ofSurface, _scratch);
            std::array<double, kNumCorners> linear;
            for (std::size_t k = 0; k < kNumCorners; ++k) {
                linear[k] = corners[k][column];
            }
            removeDefect(linear);
            Pair const slope = {(linear[1] - linear[0]) / (kPlaces[1][0] - kPlaces[0][0]),
                                (linear[3] - linear[0] + linear[2] - linear[1]) /
                                    (2 * (kPlaces[3][1] - kPlaces[0][1]))};
            function[0] -= linear[0] - slope[0] * kPlaces[0][0] - slope[1] * kPlaces[0][1];
            function[1] -= slope[0];
            function[2] -= slope[1];
            Range const range = findRange(function);
            return std::max(range.max + ofSurface.max, -(range.min + ofSurface.min));
        });
    }

    // Of a small part that is not close to a function.
    void addConstant(CellType const &type, std::vector<double> const &values) {
        std::vector<double> const corner = findCorner(type, 0, values);
        std::size_t const number = findSample(corner);
        parts.push_back({number, number, number, number});
        CellBounds const &weights = CellBounds::Find(type);
        addRests([&](std::size_t column) {
            getHeights(values, column);
            double const height = corner[column];
            return std::max(weights.GetMax(_heights, height) - height,
                            height - weights.GetMin(_heights, height));
        });
    }

    std::size_t const _size;      // points of the cell
    std::size_t const _firstTerm; // of columns
    std::size_t const _width;
    int _maxDepth = kMinDepth;
    std::vector<double> _heights;
    std::vector<double> _scratch;
};

HeightBounds::HeightBounds(CellType const &type) : _fit(Fit::Find(type)) {
    Maker maker(type, _fit);
    auto const fill = [](std::vector<std::vector<double>> const &rows) {
        PlaceMatrix<double> matrix(rows.size(), rows[0].size());
        for (std::size_t i = 0; i < rows.size(); ++i) {
            matrix.Set(i, rows[i]);
        }
        return matrix;
    };
    _parts = std::move(maker.parts);
    _samples = fill(maker.samples);
    _rests = fill(maker.rests);
}

HeightBounds const &HeightBounds::Find(CellType const &type) {
    return type.GetPatterns().Get<HeightBounds>(
        PatternTable::GetKind<double>(PatternOf::HeightBounds), nullptr, nullptr,
        [&] { return HeightBounds(type); });
}

HeightBounds::Terms HeightBounds::getTerms(Pair const &place) {
    auto const [x, y] = place;
    return {1, x, y, x * x, x * y, y * y};
}

std::array<Pair, HeightBounds::kNumCorners> HeightBounds::getCorners() {
    std::array<Pair, kNumCorners> corners;
    for (std::size_t i = 0; i < kNumCorners; ++i) {
        corners[i] = subtract(ToLattice(HalfCell::kCorners[i]), getCenter());
    }
    return corners;
}

std::vector<Pair> HeightBounds::placePoints(CellType const &type) {
    std::vector<Pair> places = PlacePoints(type.GetCell());
    for (Pair &place : places) {
        place = subtract(place, getCenter());
    }
    return places;
}

HeightBounds::Intervals const &HeightBounds::findIntervals(CellType const &type, int numSteps) {
    return type.GetPatterns().Get<Intervals>(
        PatternTable::GetKind<double>(PatternOf::TermIntervals), &numSteps, &numSteps + 1,
        [&] { return numSteps == 0 ? boundAny(type) : boundBySteps(type, numSteps); });
}

// The surface has what the points have, and all of the cell is within the largest distance of a corner from the
// middle.
HeightBounds::Intervals HeightBounds::boundAny(CellType const &type) {
    double radius = 0;
    for (Pair const &corner : getCorners()) {
        radius = std::max(radius, std::hypot(corner[0], corner[1]));
    }
    std::vector<Pair> const places = placePoints(type);
    Intervals result = {};
    for (std::size_t k = 1; k < kNumTerms; ++k) {
        double largest = 0;
        for (Pair const &place : places) {
            largest = std::max(largest, std::abs(getTerms(place)[k]));
        }
        largest += k < 3 ? radius : radius * radius;
        result[k] = {-largest, largest};
    }
    return result;
}

HeightBounds::Intervals HeightBounds::boundBySteps(CellType const &type, int numSteps) {
    std::vector<Pair> const places = placePoints(type);
    std::vector<CellType::Child> const &children = type.GetChildren();
    Intervals result = {};
    for (std::size_t i = 0; i < children.size(); ++i) {
        CellType const &childType = *children[i].type;
        ChildMap const map(i);
        std::vector<Pair> const childPlaces = placePoints(childType);
        std::array<std::vector<double>, kNumTerms> rests; // e, by point
        for (std::size_t point = 0; point < childPlaces.size(); ++point) {
            Terms sums = {};
            children[i].step.ForEachEntry(point, [&](std::size_t parentPoint, double weight) {
                Terms const terms = getTerms(places[parentPoint]);
                for (std::size_t k = 0; k < kNumTerms; ++k) {
                    sums[k] += weight * terms[k];
                }
            });
            Terms const terms = getTerms(map.Apply(childPlaces[point]));
            for (std::size_t k = 0; k < kNumTerms; ++k) {
                rests[k].push_back(sums[k] - terms[k]);
            }
        }
        CellBounds const &weights = CellBounds::Find(childType);
        Intervals const &ofChild = findIntervals(childType, numSteps - 1);
        for (std::size_t k = 1; k < kNumTerms; ++k) {
            auto const [least, largest] = std::minmax_element(rests[k].begin(), rests[k].end());
            double const middle = (*least + *largest) / 2;
            Range sum = {weights.GetMin(rests[k], middle), weights.GetMax(rests[k], middle)};
            Terms const term = map.GetTerm(k);
            for (std::size_t other = 1; other < kNumTerms; ++other) {
                double const ends[2] = {term[other] * ofChild[other].min,
                                        term[other] * ofChild[other].max};
                sum = {sum.min + std::min(ends[0], ends[1]), sum.max + std::max(ends[0], ends[1])};
            }
            result[k] =
                i == 0 ? sum
                       : Range{std::min(result[k].min, sum.min), std::max(result[k].max, sum.max)};
        }
    }
    return result;
}

// By functions that are orthogonal and of length 1 where points count by their largest weights.
HeightBounds::Fit::Fit(CellType const &type) : _maxWeights(CellBounds::Find(type).GetWeights()) {
    std::vector<Pair> const places = placePoints(type);
    std::size_t const size = places.size();
    std::array<std::vector<double>, kNumTerms> functions; // by point
    std::array<Terms, kNumTerms> factors = {};            // of terms in them
    auto const multiply = [&](std::vector<double> const &a, std::vector<double> const &b) {
        double sum = 0;
        for (std::size_t i = 0; i < size; ++i) {
            sum += _maxWeights[i] * a[i] * b[i];
        }
        return sum;
    };
    for (std::size_t k = 0; k < kNumTerms; ++k) {
        for (Pair const &place : places) {
            functions[k].push_back(getTerms(place)[k]);
            _terms.push_back(functions[k].back());
        }
        factors[k][k] = 1;
        for (std::size_t other = 0; other < k; ++other) {
            double const product = multiply(functions[k], functions[other]);
            for (std::size_t i = 0; i < size; ++i) {
                functions[k][i] -= product * functions[other][i];
            }
            for (std::size_t term = 0; term < kNumTerms; ++term) {
                factors[k][term] -= product * factors[other][term];
            }
        }
        double const length = std::sqrt(multiply(functions[k], functions[k]));
        for (double &value : functions[k]) {
            value /= length;
        }
        for (double &factor : factors[k]) {
            factor /= length;
        }
    }
    _fit.resize(size * kPadded);
    for (std::size_t i = 0; i < size; ++i) {
        for (std::size_t k = 0; k < kNumTerms; ++k) {
            for (std::size_t term = 0; term < kNumTerms; ++term) {
                _fit[i * kPadded + term] += _maxWeights[i] * functions[k][i] * factors[k][term];
            }
        }
    }
    if (type.IsWhole()) {
        return;
    }
    Intervals const &intervals = findIntervals(type, kNumSteps);
    for (std::size_t k = 0; k < kNumTerms; ++k) {
        _shifts[k] = (intervals[k].min + intervals[k].max) / 2;
        _radii[k] = (intervals[k].max - intervals[k].min) / 2;
    }
}

std::vector<double> HeightBounds::Fit::GetValues() const {
    std::size_t const size = _maxWeights.size();
    std::vector<double> values(size * kPadded);
    for (std::size_t i = 0; i < size; ++i) {
        for (std::size_t k = 0; k < kNumTerms; ++k) {
            values[i * kPadded + k] = _terms[k * size + i];
        }
    }
    return values;
}

// At the corners, and where it is extreme along sides and inside.
HeightBounds::Range HeightBounds::findRange(Terms const &quadratic) {
    static std::array<Pair, kNumCorners> const kCorners = getCorners();
    auto const evaluate = [&](Pair const &p) {
        auto const [x, y] = p;
        return quadratic[0] + x * (quadratic[1] + x * quadratic[3] + y * quadratic[4]) +
               y * (quadratic[2] + y * quadratic[5]);
    };
    std::array<double, kNumCorners> values;
    std::transform(kCorners.begin(), kCorners.end(), values.begin(), evaluate);
    auto const [least, largest] = std::minmax_element(values.begin(), values.end());
    Range range = {*least, *largest};
    auto const addHeight = [&](double value) {
        range.min = std::min(range.min, value);
        range.max = std::max(range.max, value);
    };
    for (std::size_t k = 0; k < kNumCorners; ++k) {
        std::size_t const next = (k + 1) % kNumCorners;
        auto const [dx, dy] = subtract(kCorners[next], kCorners[k]);
        // values[k] + t slope + t^2 bend
        double const bend =
            quadratic[3] * dx * dx + quadratic[4] * dx * dy + quadratic[5] * dy * dy;
        double const slope = values[next] - values[k] - bend;
        if (slope * bend < 0 && std::abs(slope) < 2 * std::abs(bend)) {
            addHeight(values[k] - slope * slope / (4 * bend));
        }
    }
    double const determinant = 4 * quadratic[3] * quadratic[5] - quadratic[4] * quadratic[4];
    if (determinant > 0) {
        double const x = quadratic[4] * quadratic[2] - 2 * quadratic[5] * quadratic[1];
        double const y = quadratic[4] * quadratic[1] - 2 * quadratic[3] * quadratic[2];
        Pair const extreme = {x / determinant, y / determinant};
        bool isInside = true;
        for (std::size_t k = 0; k < kNumCorners; ++k) {
            isInside =
                isInside && getArea(kCorners[k], kCorners[(k + 1) % kNumCorners], extreme) > 0;
        }
        if (isInside) {
            addHeight(evaluate(extreme));
        }
    }
    return range;
}

HeightBounds::Terms HeightBounds::Fit::FindFunction(double const *heights) const {
    double sums[kPadded] = {};
    for (std::size_t i = 0; i < _maxWeights.size(); ++i) {
        for (std::size_t k = 0; k < kPadded; ++k) {
            sums[k] += heights[i] * _fit[i * kPadded + k];
        }
    }
    Terms function;
    std::copy_n(sums, kNumTerms, function.begin());
    return function;
}

void HeightBounds::Fit::Subtract(double const *heights, Terms const &function,
                                 double *result) const {
    std::size_t const size = _maxWeights.size();
    double const *terms[kNumTerms];
    for (std::size_t k = 0; k < kNumTerms; ++k) {
        terms[k] = &_terms[k * size];
    }
    for (std::size_t i = 0; i < size; ++i) {
        result[i] = heights[i] - (function[0] + function[1] * terms[1][i] +
                                  function[2] * terms[2][i] + function[3] * terms[3][i] +
                                  function[4] * terms[4][i] + function[5] * terms[5][i]);
    }
}

HeightBounds::Range HeightBounds::Fit::findRests(double const *heights, Terms const &function,
                                                 std::vector<double> &scratch) const {
    std::size_t const size = _maxWeights.size();
    scratch.resize(size);
    Subtract(heights, function, scratch.data());
    constexpr std::size_t kLanes = 4; // so that sums need not wait for each other
    double below[kLanes] = {};
    double above[kLanes] = {};
    double sumBelow[kLanes] = {};
    double sumAbove[kLanes] = {};
    for (std::size_t i = 0; i < size; ++i) {
        std::size_t const lane = i % kLanes;
        double const least = std::min(scratch[i], 0.0);
        double const largest = std::max(scratch[i], 0.0);
        below[lane] = std::min(below[lane], least);
        above[lane] = std::max(above[lane], largest);
        sumBelow[lane] += _maxWeights[i] * least;
        sumAbove[lane] += _maxWeights[i] * largest;
    }
    Range sum = {0, 0};
    Range rests = {0, 0};
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        rests = {std::min(rests.min, below[lane]), std::max(rests.max, above[lane])};
        sum = {sum.min + sumBelow[lane], sum.max + sumAbove[lane]};
    }
    return {std::max(rests.min, sum.min), std::min(rests.max, sum.max)};
}

HeightBounds::Terms HeightBounds::Fit::FindSurface(std::vector<double> const &heights, Range &rests,
                                                   std::vector<double> &scratch) const {
    Terms function = FindFunction(heights.data());
    rests = findRests(heights.data(), function, scratch);
    for (std::size_t k = 1; k < kNumTerms; ++k) {
        double const radius = std::abs(function[k]) * _radii[k];
        rests = {rests.min - radius, rests.max + radius};
        function[0] += function[k] * _shifts[k];
    }
    return function;
}

HeightBounds::Ranges HeightBounds::GetRanges(double const *heights,
                                             std::vector<double> &scratch) const {
    std::size_t const numPoints = _samples.GetNumPoints();
    std::size_t const numColumns = _rests.GetNumPoints();
    scratch.resize(numColumns + _samples.GetNumPlaces() + _parts.size());
    double *const sizes = scratch.data();
    double *const samples = sizes + numColumns;
    double *const rests = samples + _samples.GetNumPlaces();
    Terms const function = _fit.FindFunction(heights);
    _fit.Subtract(heights, function, sizes);
    std::copy(function.begin() + 1, function.end(), sizes + numPoints);
    std::transform(sizes, samples, sizes, [](double size) { return std::abs(size); });
    SumUpPlaces(_samples, {heights, 1, 1, nullptr, samples, 1});
    SumUpPlaces(_rests, {sizes, 1, 1, nullptr, rests, 1});
    auto const [least, largest] = std::minmax_element(samples, rests);
    Ranges result = {{*least, *largest}, {*least, *largest}};
    for (std::size_t part = 0; part < _parts.size(); ++part) {
        std::array<double, kNumCorners> linear;
        for (std::size_t k = 0; k < kNumCorners; ++k) {
            linear[k] = samples[_parts[part][k]];
        }
        removeDefect(linear);
        for (double const height : linear) {
            result.bound.min = std::min(result.bound.min, height - rests[part]);
            result.bound.max = std::max(result.bound.max, height + rests[part]);
        }
    }
    return result;
}

} // namespace OpenSubdivHex::BfrExt::internal

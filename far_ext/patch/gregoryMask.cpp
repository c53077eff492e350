// SPDX-License-Identifier: Apache-2.0
#include "gregoryMask.h"

#include "far_ext/vtr/pi.h"

#include <cmath>
#include <complex>
#include <utility>

namespace OpenSubdivHex::FarExt::internal {

namespace {

using Point = GregoryMask::Point;

Point operator+(Point a, Point const &b) {
    for (std::size_t i = 0; i < a.size(); ++i) {
        a[i] += b[i];
    }
    return a;
}
Point operator*(double s, Point a) {
    for (double &x : a) {
        x *= s;
    }
    return a;
}
Point operator-(Point const &a, Point const &b) { return a + -1.0 * b; }

enum Row { kRow0, kRow1, kRowM, kRowCenter };

Point makePoint(int row) {
    Point point{};
    point[3 * std::size_t(row)] = 1;
    return point;
}

// t(angle) of a row.
Point makeDerivative(int row, double angle) {
    Point point{};
    point[3 * std::size_t(row) + 1] = std::cos(angle);
    point[3 * std::size_t(row) + 2] = std::sin(angle);
    return point;
}

// A cubic with a patch on its left, and a quadratic: the derivative across, to the left.
struct Curve {
    Point points[4];
    Point across[3];
};

// How long, in the direction of c' and at right angles to it, the derivative of a patch is that
// leaves the curve at its ends: a and b of a D + b c'.
struct Inward {
    double across[2];
    double along[2];
};

// c' is 3 times the difference of points.
Point makeTangent(Curve const &curve, int i) {
    return 3.0 * (curve.points[i + 1] - curve.points[i]);
}

Curve makeCurve(CurveShape const &shape, int row0, int row1, double signOfM) {
    CurveEnd const *const ends = shape.ends;
    Curve curve;
    curve.points[0] = makePoint(row0);
    curve.points[3] = makePoint(row1);
    curve.points[1] = curve.points[0] + ends[0].length / 3 * makeDerivative(row0, ends[0].angle);
    curve.points[2] = curve.points[3] + ends[1].length / 3 * makeDerivative(row1, ends[1].angle);
    curve.across[0] = ends[0].unit * makeDerivative(row0, ends[0].angle + kPi / 2);
    curve.across[2] = ends[1].unit * makeDerivative(row1, ends[1].angle - kPi / 2);
    // In the middle a quadratic is a quarter of its ends and half of its second coefficient.
    Point const middle = 2 * signOfM * shape.unit * makeDerivative(kRowM, 0);
    Point const ofEnds = 0.5 * (curve.across[0] + curve.across[2]);
    curve.across[1] = (1 + shape.blend) * middle - (1 + 2 * shape.blend) * ofEnds;
    return curve;
}

constexpr double kUnits[2] = {1, 1};

// The lengths of c' at both ends are \p lengths in the terms that \p neighbors have.
Inward makeInward(CurveNeighbor const neighbors[2], double const lengths[2],
                  double const units[2] = kUnits) {
    Inward inward{};
    double const directions[2] = {1, -1};
    for (int end = 0; end < 2; ++end) {
        CurveNeighbor const &neighbor = neighbors[end];
        inward.across[end] = neighbor.length * std::sin(neighbor.angle) / units[end];
        inward.along[end] =
            directions[end] * neighbor.length * std::cos(neighbor.angle) / lengths[end];
    }
    return inward;
}

// The derivative inwards is a cubic, whose coefficients 1 and 2 are three times the differences from
// the points of the curve to the inner points.
std::pair<Point, Point> makeInnerPoints(Curve const &curve, Inward const &inward) {
    double const *const a = inward.across;
    double const *const b = inward.along;
    Point const *const d = curve.across;
    Point const c[3] = {makeTangent(curve, 0), makeTangent(curve, 1), makeTangent(curve, 2)};
    Point const first = a[1] * d[0] + 2 * a[0] * d[1] + b[1] * c[0] + 2 * b[0] * c[1];
    Point const second = 2 * a[1] * d[1] + a[0] * d[2] + 2 * b[1] * c[1] + b[0] * c[2];
    return {curve.points[1] + 1.0 / 9 * first, curve.points[2] + 1.0 / 9 * second};
}

void addInnerPoints(Curve const &curve, Inward const &inward, GregoryMask &mask) {
    auto const points = makeInnerPoints(curve, inward);
    mask.points.push_back(points.first);
    mask.points.push_back(points.second);
}

Curve reverse(Curve const &curve) {
    Curve result = curve;
    for (int i = 0; i < 4; ++i) {
        result.points[i] = curve.points[3 - i];
    }
    for (int i = 0; i < 3; ++i) {
        result.across[i] = -1.0 * curve.across[2 - i];
    }
    return result;
}

// Both halves of a curve, with c' as it is on the whole: their own is half of it.
std::pair<Curve, Curve> halve(Curve const &curve) {
    Point const *const p = curve.points;
    Point const q0 = 0.5 * (p[0] + p[1]);
    Point const q1 = 0.5 * (p[1] + p[2]);
    Point const q2 = 0.5 * (p[2] + p[3]);
    Point const r0 = 0.5 * (q0 + q1);
    Point const r1 = 0.5 * (q1 + q2);
    Point const middle = 0.5 * (r0 + r1);
    Point const *const d = curve.across;
    Point const d0 = 0.5 * (d[0] + d[1]);
    Point const d1 = 0.5 * (d[1] + d[2]);
    Point const across = 0.5 * (d0 + d1);
    return {{{p[0], q0, r0, middle}, {d[0], d0, across}},
            {{middle, r1, q2, p[3]}, {across, d1, d[2]}}};
}

} // namespace

void AddCurvePoints(CurveShape const &shape, GregoryMask &mask) {
    Curve const curve = makeCurve(shape, kRow0, kRow1, 1);
    mask.points.push_back(curve.points[1]);
    mask.points.push_back(curve.points[2]);
}

void AddInnerPoints(CurveShape const &shape, CurveNeighbor const neighbors[2], double signOfM,
                    bool isReverse, GregoryMask &mask) {
    Curve const curve = isReverse ? makeCurve(shape, kRow1, kRow0, signOfM)
                                  : makeCurve(shape, kRow0, kRow1, signOfM);
    double const lengths[2] = {shape.ends[0].length, shape.ends[1].length};
    double const units[2] = {shape.ends[0].unit, shape.ends[1].unit};
    addInnerPoints(curve, makeInward(neighbors, lengths, units), mask);
}

KiteSide MakeKiteSide(int numSides, int side) {
    double const apothem = 1 / (2 * std::tan(kPi / numSides));
    double const angle = 2 * kPi / numSides;
    return {1, 2 * std::sin(kPi / numSides),      apothem,        0,
            1, 2 * kPi * (side + 0.5) / numSides, {angle, angle}, {apothem, apothem}};
}

namespace {

using Place = std::complex<double>;

// Half a regular polygon over its first side, whose middle is 0.
class HalfPolygon {
public:
    explicit HalfPolygon(int numCorners)
        : _numCorners(numCorners), _unit(kPi / (numCorners - 1)),
          _radius(1 / (2 * std::sin(_unit / 2))) {}

    double GetRadius() const { return _radius; }
    Place GetCorner(int i) const { return std::polar(_radius, _unit * (i - 1)); }
    // From the first side to the corner across, or the middle of the side across.
    double GetHeight() const {
        return _numCorners % 2 == 1 ? _radius : _radius * std::cos(_unit / 2);
    }
    Place GetCenter() const { return {0, kPartOfCenter * GetHeight()}; }
    Place GetMiddle(int side) const {
        side %= _numCorners;
        return side == 0 ? Place(0) : 0.5 * (GetCorner(side) + GetCorner(side + 1));
    }

    static constexpr double kPartOfCenter = 1.0 / 3;

private:
    int const _numCorners;
    double const _unit;
    double const _radius;
};

// The angle from a direction to another one, counter-clockwise.
double findAngle(Place from, Place to) {
    double const angle = std::arg(to / from);
    return angle < 0 ? angle + 2 * kPi : angle;
}

// The point in the middle of a curve, the derivative along it, and that across.
struct CurveMiddle {
    CurveMiddle(CurveShape const &shape, double signOfM) {
        Curve const half = halve(makeCurve(shape, kRow0, kRow1, signOfM)).first;
        point = half.points[3];
        along = 2 * makeTangent(half, 2);
        across = half.across[2];
    }

    Point point;
    Point along;
    Point across;
};

// The cubic from the middle of the first side of half a polygon to what is across, and its derivative to the right, which is
// linear.  The derivatives across are by a side of length 1.
HalfCenter makeHalfCenter(HalfPolygon const &polygon, CurveMiddle const &longSide,
                          CurveMiddle const &opposite) {
    constexpr double t = HalfPolygon::kPartOfCenter;
    double const height = polygon.GetHeight();
    HalfCenter center;
    center.sums[0][0] = (2 * t * t * t - 3 * t * t + 1) * longSide.point +
                        height * (t * t * t - 2 * t * t + t) * longSide.across;
    center.sums[1][0] = (3 * t * t - 2 * t * t * t) * opposite.point +
                        height * (t * t * t - t * t) * opposite.across;
    center.sums[0][1] = (1 - t) / (2 * polygon.GetRadius()) * longSide.along;
    center.sums[1][1] = t * opposite.along;
    center.sums[0][2] =
        6 * (t * t - t) / height * longSide.point + (3 * t * t - 4 * t + 1) * longSide.across;
    center.sums[1][2] =
        6 * (t - t * t) / height * opposite.point + (3 * t * t - 2 * t) * opposite.across;
    return center;
}

} // namespace

KiteSide MakeHalfKiteSide(int numCorners, int side) {
    HalfPolygon const polygon(numCorners);
    Place const center = polygon.GetCenter();
    Place const middle = polygon.GetMiddle(side);
    Place const ofSide =
        polygon.GetCorner(side + 1) - (side == 0 ? -polygon.GetCorner(1) : polygon.GetCorner(side));
    Place const spoke = center - middle;
    Place const turned = spoke * std::conj(ofSide) / std::abs(spoke * ofSide);
    Place const before = polygon.GetMiddle(side + numCorners - 1) - center;
    Place const behind = polygon.GetMiddle(side + 1) - center;
    return {std::abs(ofSide),
            1,
            std::abs(spoke),
            turned.real(),
            turned.imag(),
            std::arg(-spoke),
            {findAngle(before, -spoke), findAngle(-spoke, behind)},
            {std::abs(before), std::abs(behind)}};
}

HalfCenter MakeHalfCenter(int numCorners, CurveShape const &longSide, double signOfM,
                          double angle) {
    CurveMiddle const ofLong(longSide, signOfM);
    CurveMiddle opposite = ofLong;
    opposite.point = makePoint(kRow0);
    opposite.along = makeDerivative(kRow0, angle + kPi / 2);
    opposite.across = -1.0 * makeDerivative(kRow0, angle);
    return makeHalfCenter(HalfPolygon(numCorners), ofLong, opposite);
}

HalfCenter MakeHalfCenter(int numCorners, CurveShape const &longSide, double signOfM,
                          CurveShape const &across, double signOfMAcross) {
    // It runs the other way.
    CurveMiddle opposite(across, signOfMAcross);
    opposite.along = -1.0 * opposite.along;
    opposite.across = -1.0 * opposite.across;
    return makeHalfCenter(HalfPolygon(numCorners), CurveMiddle(longSide, signOfM), opposite);
}

std::vector<double> FindWeightsAcross(int numCorners) {
    constexpr int kHalfHexagon = 4;
    if (numCorners == kHalfHexagon) {
        double const weight = 1 / std::sqrt(3.0);
        return {-weight, -weight, weight, weight};
    }
    // The eigenvector of the mask: see FaceLimitMaskFinder.
    HalfPolygon const polygon(numCorners);
    std::vector<double> weights = {0, 0};
    double const unit = 2 / (polygon.GetRadius() * polygon.GetRadius() * (numCorners - 1));
    for (int i = 2; i < numCorners; ++i) {
        double const weight = unit * polygon.GetCorner(i).imag();
        weights.push_back(weight);
        weights[0] -= weight / 2;
    }
    weights[1] = weights[0];
    return weights;
}

void AddKitePoints(CurveShape const &shape, CurveNeighbor const neighbors[2],
                   SpokeShape const &spoke, KiteSide const &side, double signOfM,
                   GregoryMask &mask) {
    Curve const whole = makeCurve(shape, kRow0, kRow1, signOfM);
    auto const halves = halve(whole);
    Curve const &first = halves.first;
    Curve const &second = halves.second;
    for (Point const &point :
         {first.points[1], first.points[2], first.points[3], second.points[1], second.points[2]}) {
        mask.points.push_back(point);
    }
    // At the middle the frame is c' of the whole, which is as long as the side there, and D.  Sides of kites are
    // half as long.
    double const half = side.length / 2;
    double const lengths[2] = {spoke.lengths[0] * side.spoke, spoke.lengths[1] * side.spoke};
    double const angle = std::atan2(side.across, side.along);
    CurveNeighbor const atMiddleOfFirst = {kPi - angle, lengths[0]};
    CurveNeighbor const atMiddleOfSecond = {angle, lengths[0]};
    CurveNeighbor const before = {neighbors[0].angle, neighbors[0].length / 2};
    CurveNeighbor const behind = {neighbors[1].angle, neighbors[1].length / 2};
    CurveNeighbor const ofFirst[2] = {before, atMiddleOfFirst};
    CurveNeighbor const ofSecond[2] = {atMiddleOfSecond, behind};
    double const firstLengths[2] = {shape.ends[0].length / 2, half};
    double const secondLengths[2] = {half, shape.ends[1].length / 2};
    addInnerPoints(first, makeInward(ofFirst, firstLengths), mask);
    addInnerPoints(second, makeInward(ofSecond, secondLengths), mask);

    Point const along = 2 / side.length * makeTangent(first, 2);
    Point const &across = first.across[2];
    Curve line;
    line.points[0] = first.points[3];
    line.points[3] = makePoint(kRowCenter);
    line.points[1] = line.points[0] + lengths[0] / 3 * (side.across * across + side.along * along);
    line.points[2] =
        line.points[3] + lengths[1] * side.unit / 3 * makeDerivative(kRowCenter, side.direction);
    // To the left of the line, which leads to the centre, lies the first half.
    line.across[0] = side.along * across - side.across * along;
    line.across[2] = side.unit * makeDerivative(kRowCenter, side.direction - kPi / 2);
    line.across[1] = (1 + spoke.blend) / 2 * (line.across[0] + line.across[2]);
    mask.points.push_back(line.points[1]);
    mask.points.push_back(line.points[2]);
    CurveNeighbor const lineBefore = {side.angles[0], spoke.lengths[1] * side.besides[0]};
    CurveNeighbor const lineBehind = {side.angles[1], spoke.lengths[1] * side.besides[1]};
    CurveNeighbor const ofLine[2] = {{kPi - angle, half}, lineBefore};
    addInnerPoints(line, makeInward(ofLine, lengths), mask);
    // Seen from the kite on the other side, the line leads from the centre to the middle.
    CurveNeighbor const fromCenter[2] = {lineBehind, {angle, half}};
    double const reversed[2] = {lengths[1], lengths[0]};
    auto const points = makeInnerPoints(reverse(line), makeInward(fromCenter, reversed));
    mask.points.push_back(points.second);
    mask.points.push_back(points.first);
}

} // namespace OpenSubdivHex::FarExt::internal

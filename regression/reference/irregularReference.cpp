// SPDX-License-Identifier: Apache-2.0
#include "irregularReference.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <complex>

namespace OpenSubdivHex::Regression {

namespace {

using Point = Eigen::RowVectorXd;

double const kPi = std::acos(-1.0);

/// \brief What one step does to waves of frequency \p w around the vertex.
///
/// Neighbour N of hexagon j is n e^j, its A and C are a e^j and c e^j, with e = exp(2 pi i w/k): the
/// step takes (V, n, a, c) to what they are in the hexagons that edges make.  V is 0 unless w is 0.
/// The hexagon of the edge V-N lies between those before and behind that edge: it has their new
/// points beside V as its N and M, and theirs beside the end of the edge as its A and C.  Seen from
/// there the ring is turned by half a hexagon.
Eigen::Matrix4cd stepOfWave(IrregularRule const &rule, int numFaces, int w) {
    using Complex = std::complex<double>;
    using Row = Eigen::Matrix<Complex, 1, 4>;
    Complex const e = std::polar(1.0, 2 * kPi * w / numFaces);
    // The new points beside V, N and M of hexagon 0.
    double const *v = rule.ofV;
    double const *n = rule.ofN;
    Row besideV, besideN, besideM;
    besideV << v[0], v[1] + v[5] * e, v[2], v[4];
    besideN << n[0], n[1] + n[5] * e, n[2], n[4];
    besideM << n[0], n[1] * e + n[5], n[4], n[2];
    Row before; // the hexagon before: all but V is turned back
    before << 1, 1.0 / e, 1.0 / e, 1.0 / e;
    Eigen::Matrix4cd step;
    Row const old = Row::Unit(0);
    step.row(0) = (1 - rule.meanWeight) * old + (w == 0 ? rule.meanWeight : 0) * besideV;
    step.row(1) = besideV.cwiseProduct(before);
    step.row(2) = besideM.cwiseProduct(before);
    step.row(3) = besideN;
    step.bottomRows(3) *= std::polar(1.0, kPi * w / numFaces);
    if (w != 0) {
        step.row(0) = old;
        step.col(0) = old.transpose();
    }
    return step;
}

/// 0 where x is an eigenvalue; linear in the weights of V and of V' each.
double characteristic(IrregularRule const &rule, int numFaces, int w, double x) {
    Eigen::Matrix4cd const step = stepOfWave(rule, numFaces, w);
    return (step - x * Eigen::Matrix4cd::Identity()).determinant().real();
}

void setWeightsOfV(double side, double next, IrregularRule &rule) {
    double const weights[] = {1 - 2 * side - 2 * next, side, next, 0, next, side};
    std::copy(std::begin(weights), std::end(weights), rule.ofV);
}

/// \brief The weights for which waves of frequency 1 shrink by \p lambda, and those of frequency 0
/// and 2 by its square: a surface of bounded curvature.
void balance(int numFaces, double lambda, IrregularRule &rule) {
    Eigen::Matrix2d factors;
    Eigen::Vector2d right;
    for (int w : {1, 2}) {
        auto const measure = [&](double side, double next) {
            setWeightsOfV(side, next, rule);
            return characteristic(rule, numFaces, w, w == 1 ? lambda : lambda * lambda);
        };
        double const constant = measure(0, 0);
        factors.row(w - 1) << measure(1, 0) - constant, measure(0, 1) - constant;
        right[w - 1] = -constant;
    }
    Eigen::Vector2d const weights = factors.fullPivLu().solve(right);
    setWeightsOfV(weights[0], weights[1], rule);
    auto const measure = [&](double meanWeight) {
        rule.meanWeight = meanWeight;
        return characteristic(rule, numFaces, 0, lambda * lambda);
    };
    double const constant = measure(0);
    rule.meanWeight = constant / (constant - measure(1));
}

void setWeightsOfN(double const (&in32nds)[6], IrregularRule &rule) {
    for (int i = 0; i < 6; ++i) {
        rule.ofN[i] = in32nds[i] / 32;
    }
}

/// Among quads, the first two levels: the new points have other weights, in 128ths of V, N, A, B, C
/// and M; V' stays.
void setWeightsAmongQuads(int numSteps, IrregularRule &rule) {
    double const ofV[2][6] = {{24, 45, 7, 0, 7, 45}, {46, 41, 0, 0, 0, 41}};
    double const ofN[6] = {4, 76, 18, 0, 0, 30};
    for (int i = 0; i < 6; ++i) {
        rule.ofV[i] = ofV[numSteps - 1][i] / 128;
        if (numSteps == 2) {
            rule.ofN[i] = ofN[i] / 128;
        }
    }
}

/// Weights in 128ths by distance around the hexagon, along the edge to the quad first.
double const kWeightsBesideQuad[2][6] = {{72, 24, 0, 8, 24, 0}, {63, 29, 5, 6, 16, 9}};

} // namespace

IrregularRule MakeIrregularRule(int numFaces, int numSteps, bool isAmongQuads) {
    IrregularRule rule{};
    if (numFaces == 4) {
        setWeightsOfN({4, 14, 9, 0, 0, 5}, rule);
        balance(4, 4.0 / 7, rule);
        if (isAmongQuads && numSteps <= 2) {
            setWeightsAmongQuads(numSteps, rule);
        }
        return rule;
    }
    setWeightsOfN({4, 15, 8, 0, 0, 5}, rule);
    if (numFaces == 5) {
        balance(5, 4.0 / 7, rule);
        return rule;
    }
    // Along the edges alone.
    double const c = std::cos(kPi / numFaces);
    double const s = std::min(std::cos(2 * kPi / numFaces) / (c * c), 0.77);
    setWeightsOfV(s / 2, 0, rule);
    rule.meanWeight = 1 - s * c * c;
    return rule;
}

Point NewIrregularPoint(IrregularRule const &rule, std::vector<Point> const &face, int i,
                        int vertex) {
    // Around the face from V on, towards the corner where the point is.
    bool const isBackwards = (i + 1) % 6 == vertex;
    Point sum = Point::Zero(face[0].size());
    for (int j = 0; j < 6; ++j) {
        sum +=
            (i == vertex ? rule.ofV : rule.ofN)[j] * face[(vertex + (isBackwards ? 6 - j : j)) % 6];
    }
    return sum;
}

std::optional<Point> NewPointBesideQuad(int numSteps, std::vector<Point> const &face, int i,
                                        int edge) {
    if (numSteps > 2) {
        return {};
    }
    Point sum = Point::Zero(face[0].size());
    for (int j = 0; j < 6; ++j) {
        sum += kWeightsBesideQuad[numSteps - 1][j] / 128 * face[(i + (i == edge ? j : 6 - j)) % 6];
    }
    return sum;
}

} // namespace OpenSubdivHex::Regression

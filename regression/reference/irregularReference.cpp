// SPDX-License-Identifier: Apache-2.0
#include "irregularReference.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <complex>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

namespace OpenSubdivHex::Regression {

namespace {

using Point = Eigen::RowVectorXd;

double const kPi = std::acos(-1.0);

/// \brief The matrix of one step for waves of frequency \p w around the vertex.
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

/// In the first levels the new points have other weights, in 256ths: of V, N, A, B, C and M.
struct FirstParts {
    double ofV[6];
    double ofN[6];
};
/// By level.
using FirstLevels = std::vector<FirstParts>;
/// By number of faces.
std::map<int, FirstLevels> const kQuads = {{4,
                                            {{{52, 87, 15, 0, 15, 87}, {32, 112, 72, 0, 0, 40}},
                                             {{96, 74, 0, 12, 0, 74}, {39, 128, 25, 33, 0, 31}},
                                             {{82, 69, 18, 0, 18, 69}, {37, 99, 78, 0, 0, 42}}}}};
std::map<int, FirstLevels> const kOthers = {{4,
                                             {{{88, 64, 20, 0, 20, 64}, {36, 116, 56, 0, 28, 20}},
                                              {{88, 56, 28, 0, 28, 56}, {56, 112, 52, 0, 36, 0}}}},
                                            {5,
                                             {{{68, 94, 0, 0, 0, 94}, {23, 159, 0, 34, 11, 29}},
                                              {{74, 78, 13, 0, 13, 78}, {41, 127, 35, 8, 14, 31}}}},
                                            {6,
                                             {{{62, 97, 0, 0, 0, 97}, {26, 157, 6, 25, 19, 23}},
                                              {{76, 90, 0, 0, 0, 90}, {40, 144, 8, 18, 10, 36}}}},
                                            {7,
                                             {{{56, 100, 0, 0, 0, 100}, {27, 151, 20, 14, 21, 23}},
                                              {{82, 87, 0, 0, 0, 87}, {43, 141, 0, 35, 0, 37}}}},
                                            {8,
                                             {{{54, 101, 0, 0, 0, 101}, {25, 152, 11, 37, 0, 31}},
                                              {{88, 84, 0, 0, 0, 84}, {39, 137, 0, 50, 0, 30}}}}};
std::map<int, FirstLevels> const kTriangles = {
    {5,
     {{{50, 87, 16, 0, 16, 87}, {1, 111, 79, 0, 0, 65}},
      {{92, 69, 13, 0, 13, 69}, {45, 118, 45, 0, 0, 48}}}},
    {6,
     {{{30, 113, 0, 0, 0, 113}, {1, 128, 59, 0, 0, 68}},
      {{90, 83, 0, 0, 0, 83}, {39, 128, 48, 0, 0, 41}}}},
    {7,
     {{{34, 100, 11, 0, 11, 100}, {1, 106, 73, 0, 0, 76}},
      {{78, 80, 9, 0, 9, 80}, {43, 124, 58, 0, 0, 31}}}},
    {8,
     {{{30, 103, 10, 0, 10, 103}, {1, 106, 73, 0, 0, 76}},
      {{98, 66, 13, 0, 13, 66}, {40, 121, 68, 0, 0, 27}}}}};

/// V' stays as in later levels.
void setFirstWeights(int numFaces, int numSteps, FormerFaces formerFaces, IrregularRule &rule) {
    bool const areFourQuads = numFaces == 4 && formerFaces == FormerFaces::Quads;
    bool const areTriangles = numFaces > 4 && formerFaces == FormerFaces::Triangles;
    std::map<int, FirstLevels> const &table = areFourQuads   ? kQuads
                                              : areTriangles ? kTriangles
                                                             : kOthers;
    auto const found = table.find(numFaces);
    if (found == table.end() || numSteps > int(found->second.size())) {
        return;
    }
    FirstParts const &parts = found->second[numSteps - 1];
    for (int i = 0; i < 6; ++i) {
        rule.ofV[i] = parts.ofV[i] / 256;
        rule.ofN[i] = parts.ofN[i] / 256;
    }
}

/// Weights in 256ths: of a quad by distance around it; of a hexagon beside it, for the new points at an end
/// of the edge that they share, along that edge first, and one edge away, away from it first.
struct QuadParts {
    double inQuad[4];
    std::vector<std::array<double, 6>> beside;
};
std::vector<QuadParts> const kQuadParts = {
    {{127, 55, 19, 55}, {{137, 58, 0, 14, 47, 0}}},
    {{122, 54, 26, 54}, {{137, 63, 0, 22, 21, 13}, {97, 46, 21, 0, 33, 59}}},
    {{116, 54, 32, 54}, {{142, 68, 0, 9, 37, 0}}},
};

} // namespace

IrregularRule MakeIrregularRule(int numFaces, int numSteps, FormerFaces formerFaces) {
    IrregularRule rule{};
    if (numFaces == 4) {
        setWeightsOfN({4, 14, 9, 0, 0, 5}, rule);
    } else {
        setWeightsOfN({4, 15, 8, 0, 0, 5}, rule);
    }
    if (numFaces <= 5) {
        balance(numFaces, 4.0 / 7, rule);
    } else {
        // Along the edges alone.
        double const c = std::cos(kPi / numFaces);
        double const s = std::min(std::cos(2 * kPi / numFaces) / (c * c), 0.77);
        setWeightsOfV(s / 2, 0, rule);
        rule.meanWeight = 1 - s * c * c;
    }
    setFirstWeights(numFaces, numSteps, formerFaces, rule);
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
    if (numSteps < 1 || numSteps > int(kQuadParts.size())) {
        return {};
    }
    // Seen from the edge: its ends are 0 and 1, and 2 and 5 are one edge away.
    int const place = (i - edge + 6) % 6;
    auto const &rows = kQuadParts[numSteps - 1].beside;
    std::size_t const row = place == 0 || place == 1 ? 0 : place == 2 || place == 5 ? 1 : 2;
    if (row >= rows.size()) {
        return {};
    }
    bool const isMirrored = place == 1 || place == 5;
    Point sum = Point::Zero(face[0].size());
    for (int j = 0; j < 6; ++j) {
        sum += rows[row][j] / 256 * face[(i + (isMirrored ? 6 - j : j)) % 6];
    }
    return sum;
}

namespace {

struct PathRow {
    double ofVertex;
    std::vector<double> weights; // none of quads
};
/// By the kind of a quad's vertex and the name of a path's row.
using PathRows = std::map<std::pair<char, std::string>, PathRow>;

PathRows readPathRows() {
    constexpr double kParts = 4096;
    std::ifstream file(REFERENCE_QUAD_ROWS);
    PathRows rows;
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line);
        char kind = 0;
        std::string path;
        double part = 0;
        if (line[0] != '#' && words >> kind >> path >> part) {
            PathRow &row = rows[{kind, path}];
            row.ofVertex = part / kParts;
            while (words >> part) {
                row.weights.push_back(part / kParts);
            }
        }
    }
    if (rows.empty()) {
        throw std::runtime_error("There are no rows in " REFERENCE_QUAD_ROWS);
    }
    return rows;
}

bool isAll(char digit, std::string const &digits) {
    return std::all_of(digits.begin(), digits.end(), [digit](char d) { return d == digit; });
}

/// The name of a path's row: from four steps on the digits before the last two are a star, where they are all alike.
std::string rowOfPath(QuadPath const &quadPath) {
    std::string const &path = quadPath.steps;
    if (path.size() < 2) {
        return {};
    }
    std::string const digits = path.substr(1);
    if (digits.size() < 4) {
        return digits;
    }
    std::string const before = digits.substr(0, digits.size() - 2);
    std::string const last = digits.substr(digits.size() - 2);
    return isAll('0', before)                     ? "0*" + last
           : isAll('3', before) && path[0] == '4' ? "3*" + last
                                                  : "";
}

} // namespace

QuadPath Shorten(QuadPath const &path) {
    std::string const row = rowOfPath(path);
    if (path.steps.size() <= 4) {
        return path;
    }
    return row.empty() ? QuadPath()
                       : QuadPath{path.steps.substr(0, 1) + row[0] + row[0] + row.substr(2),
                                  path.sharpness};
}

namespace {

/// Finds the row of a corner; null where its paths have none.
PathRow const *findRow(QuadPath const &out, QuadPath const &in) {
    static PathRows const rows = readPathRows();
    std::string const ofOut = rowOfPath(out);
    std::string const ofIn = rowOfPath(in);
    if (ofOut.empty() || ofIn.empty()) {
        return nullptr;
    }
    std::string const row = std::min(ofOut, ofIn);
    bool const isStar = row.size() > 3;
    if (isStar && ofOut[0] != ofIn[0]) {
        return nullptr;
    }
    char kind = '4';
    char const kindOfOut = out.steps[0];
    if (!isStar && kindOfOut == in.steps[0]) {
        // At a vertex of another kind, and beside it.
        std::string const before = row.substr(0, row.size() - 1);
        if (kindOfOut == 'o' && isAll('3', before) && (row.back() == '3' || row.back() == '1')) {
            return nullptr;
        }
        kind = kindOfOut == 'o' ? '4' : kindOfOut;
    }
    for (char const wanted : {kind, '4'}) {
        if (auto const found = rows.find({wanted, row}); found != rows.end()) {
            return &found->second;
        }
    }
    return nullptr;
}

} // namespace

std::optional<Point> NewPointByPath(std::vector<Point> const &face, int i, QuadPath const &out,
                                    QuadPath const &in) {
    PathRow const *const row = findRow(out, in);
    if (!row || row->weights.empty()) {
        return {};
    }
    bool const isBackwards = rowOfPath(in) < rowOfPath(out);
    Point sum = Point::Zero(face[0].size());
    for (int j = 0; j < 6; ++j) {
        sum += row->weights[j] * face[(i + (isBackwards ? 6 - j : j)) % 6];
    }
    return sum;
}

std::optional<double> WeightByPath(QuadPath const &out, QuadPath const &in) {
    PathRow const *const row = findRow(out, in);
    return row ? std::optional<double>(row->ofVertex) : std::nullopt;
}

Point NewPointOfQuad(int numSteps, std::vector<Point> const &face, int i) {
    double const plain[4] = {144, 48, 16, 48};
    bool const isFirst = numSteps >= 1 && numSteps <= int(kQuadParts.size());
    double const *const parts = isFirst ? kQuadParts[numSteps - 1].inQuad : plain;
    Point sum = Point::Zero(face[0].size());
    for (int j = 0; j < 4; ++j) {
        sum += parts[j] / 256 * face[(i + j) % 4];
    }
    return sum;
}

} // namespace OpenSubdivHex::Regression

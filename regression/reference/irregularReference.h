// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_REFERENCE_IRREGULAR_REFERENCE_H
#define OPENSUBDIVHEX_REGRESSION_REFERENCE_IRREGULAR_REFERENCE_H

#include <Eigen/Core>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

namespace OpenSubdivHex::Regression {

/// The kind of all faces of a vertex before the first hexagonal step.
enum class FormerFaces { Mixed, Triangles, Quads };

/// The kind of faces whose sizes are getSize(0 ... numFaces - 1).
template <typename GetSize>
FormerFaces FindFormerFaces(int numFaces, GetSize const &getSize) {
    bool areTriangles = true;
    bool areQuads = true;
    for (int i = 0; i < numFaces; ++i) {
        areTriangles = areTriangles && getSize(i) == 3;
        areQuads = areQuads && getSize(i) == 4;
    }
    return areTriangles ? FormerFaces::Triangles
           : areQuads   ? FormerFaces::Quads
                        : FormerFaces::Mixed;
}

/// \brief The rules of the mask Smooth around a vertex where four hexagons or more meet, at a level
/// that some hexagonal steps made.
///
/// The vertices of a hexagon are named from the vertex on: V, N, A, B, C, M.
struct IrregularRule {
    double ofV[6];     ///< the new point beside V: weights of V, N, A, B, C, M
    double ofN[6];     ///< that beside N: of V, N, A, B, C, M; beside M it is mirrored
    double meanWeight; ///< V' = (1 - meanWeight) V + meanWeight (mean of the new points beside V)
};

/// The masks of a vertex with \p numFaces hexagons, four or more, at a level made by \p numSteps steps, one or
/// more.
///
/// \param formerFaces  of the vertex, before these steps
IrregularRule MakeIrregularRule(int numFaces, int numSteps, FormerFaces formerFaces);

/// \brief The new point beside corner \p i of a hexagon, from the values at its corners.
///
/// \param vertex  the corner, \p i or one next to it, where the rule's vertex is
Eigen::RowVectorXd NewIrregularPoint(IrregularRule const &rule,
                                     std::vector<Eigen::RowVectorXd> const &face, int i,
                                     int vertex);

/// \brief The new point beside corner \p i of a hexagon that has a quad across the edge from corner
/// \p edge to the next.
///
/// \return  nothing where the level has no such rule
std::optional<Eigen::RowVectorXd>
NewPointBesideQuad(int numSteps, std::vector<Eigen::RowVectorXd> const &face, int i, int edge);

/// \brief An end of an edge of a face, as what steps made of one in a quad: the kind of the quad's vertex, 3 to 6 by the
/// number of quads there, or o for others, and a digit for each step; empty where it came from none.
///
/// 0: in the smaller copy of the face.  In the hexagon made for its edge: 1 at the new point, along the copy; 2 there,
/// towards the old vertex; 3 at the old vertex, towards that point.
struct QuadPath {
    std::string steps;
    float sharpness = 0; ///< of the sharpest at the quad's vertex, less one for each step

    bool IsEmpty() const { return steps.empty(); }
    double GetShare() const { return sharpness < 1 ? 1 - double(sharpness) : 0; }
    /// After another step.
    QuadPath Append(char digit) const {
        return IsEmpty() ? *this : QuadPath{steps + digit, sharpness > 1 ? sharpness - 1 : 0};
    }
};

/// \brief An end of an edge of a face, as what steps made of one in a quad beside a smooth line; empty where it came from none,
/// and from three steps on.
struct LinePath {
    std::string flag;    ///< where it was in the quad: see quadLineRows.txt
    std::string steps;   ///< as of QuadPath
    float sharpness = 0; ///< of the line, less one for each step
    float cross = 0;     ///< likewise, of the sharpest other thing that is in the way of the line

    bool IsEmpty() const { return flag.empty(); }
    float GetShare() const {
        return std::max(0.0f, std::min(1.0f, sharpness) - std::min(1.0f, cross));
    }
    /// After another step.
    LinePath Append(char digit) const {
        constexpr float kInfinite = 10;
        auto const next = [](float of) { return of >= kInfinite ? of : std::max(0.0f, of - 1); };
        return IsEmpty() || steps.size() == 2
                   ? LinePath()
                   : LinePath{flag, steps + digit, next(sharpness), next(cross)};
    }
};

/// The paths of such an end from two lines: one that it was at the other end of an edge from, and one that it was at.
struct LinePaths {
    LinePath away;
    LinePath at;

    LinePaths Append(char digit) const { return {away.Append(digit), at.Append(digit)}; }
};

/// A path of at most four steps that has the same rows, now and after any more steps; empty where it has none any more.
QuadPath Shorten(QuadPath const &path);

/// The point beside corner \p i of a hexagon by the paths of its edges there; nothing where they have no rule.
std::optional<Eigen::RowVectorXd> NewPointByPath(std::vector<Eigen::RowVectorXd> const &face, int i,
                                                 QuadPath const &out, QuadPath const &in);
/// The weight of that point, or of one in a quad, where the corner's vertex is moved; nothing where they have no rule.
std::optional<double> WeightByPath(QuadPath const &out, QuadPath const &in);

/// The new point beside corner \p i of a quad.
Eigen::RowVectorXd NewPointOfQuad(int numSteps, std::vector<Eigen::RowVectorXd> const &face, int i);

} // namespace OpenSubdivHex::Regression

#endif

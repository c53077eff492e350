// SPDX-License-Identifier: Apache-2.0
#include "oracle.h"

#include "far_ext/stencilTableFactory.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

namespace OpenSubdivHex::Regression {

using FarExt::TopologyLevel;

namespace {

/// \brief A case with its faces in another order, begun elsewhere and perhaps turned over, and
/// other numbers for its vertices.
struct Reordered {
    Reordered(OracleCase const &original, std::vector<int> const &faceOrder, Dice &dice,
              bool isTurnedOver)
        : oracleCase(original), vertices(std::size_t(original.shape.GetNumVertices())),
          isReversed(isTurnedOver) {
        Shape const &from = original.shape;
        Shape &to = oracleCase.shape;
        std::iota(vertices.begin(), vertices.end(), 0);
        for (std::size_t i = vertices.size(); i > 1; --i) {
            std::swap(vertices[i - 1], vertices[std::size_t(dice.Roll(int(i)))]);
        }
        for (std::size_t v = 0; v < vertices.size(); ++v) {
            std::copy_n(&from.positions[3 * v], 3, &to.positions[3 * std::size_t(vertices[v])]);
        }
        for (auto *indices : {&to.creaseVertexPairs, &to.cornerVertices}) {
            for (int &v : *indices) {
                v = vertices[std::size_t(v)];
            }
        }
        std::vector<int> firsts{0};
        for (int size : from.faceSizes) {
            firsts.push_back(firsts.back() + size);
        }
        corners.resize(from.faceVertices.size());
        to.faceSizes.clear();
        to.faceVertices.clear();
        std::vector<std::vector<int>> values(from.fvarChannels.size());
        to.holeFaces.clear();
        for (std::size_t f = 0; f < faceOrder.size(); ++f) {
            int const face = faceOrder[f];
            int const size = from.faceSizes[std::size_t(face)];
            int const start = dice.Roll(size);
            for (int i = 0; i < size; ++i) {
                int const place = ((isReversed ? -i : i) + start + size) % size;
                auto const corner = std::size_t(firsts[std::size_t(face)] + place);
                corners[corner] = int(to.faceVertices.size());
                to.faceVertices.push_back(vertices[std::size_t(from.faceVertices[corner])]);
                for (std::size_t c = 0; c < values.size(); ++c) {
                    values[c].push_back(from.fvarChannels[c].valueIndices[corner]);
                }
            }
            to.faceSizes.push_back(size);
            if (std::count(from.holeFaces.begin(), from.holeFaces.end(), face) > 0) {
                to.holeFaces.push_back(int(f));
            }
        }
        for (std::size_t c = 0; c < values.size(); ++c) {
            to.fvarChannels[c].valueIndices = values[c];
        }
    }

    OracleCase oracleCase;
    std::vector<int> vertices; ///< the new number of each vertex
    std::vector<int> corners;  ///< the new number of each corner, where faces are right-handed
    bool isReversed;
};

/// The limit points of the vertices of level 0.
ReferenceValues limitPoints(FarExt::TopologyRefiner const &refiner, ReferenceValues const &base) {
    FarExt::LimitStencilTableFactoryReal<double>::Options options;
    options.level = 0;
    options.generate1stDerivatives = false;
    auto const table =
        FarExt::LimitStencilTableFactoryReal<double>::Create(refiner, options, nullptr);
    ReferenceValues points = ReferenceValues::Zero(base.rows(), base.cols());
    for (int i = 0; table && i < table->GetNumStencils(); ++i) {
        int const offset = table->GetOffsets()[std::size_t(i)];
        for (int k = offset; k < offset + table->GetSizes()[std::size_t(i)]; ++k) {
            points.row(i) += table->GetWeights()[std::size_t(k)] *
                             base.row(table->GetControlIndices()[std::size_t(k)]);
        }
    }
    return points;
}

/// Whether a value comes back behind others around a vertex.  Which of its faces have it in common then
/// depends on the face that comes first, as in Far.
bool comesBack(TopologyLevel const &base, int vert, int channel) {
    auto const faces = base.GetVertexFaces(vert);
    auto const locals = base.GetVertexFaceLocalIndices(vert);
    std::vector<int> runs;
    for (int i = 0; i < faces.size(); ++i) {
        int const value = base.GetFaceFVarValues(faces[i], channel)[locals[i]];
        if (runs.empty() || runs.back() != value) {
            runs.push_back(value);
        }
    }
    return std::set<int>(runs.begin(), runs.end()).size() < runs.size();
}

void checkOrder(OracleLevels const &levels, Reordered const &other, ReferenceValues const *limits) {
    FarExt::CallStatus status;
    auto const refiner = CreateRefiner(other.oracleCase, &status);
    if (!refiner) {
        Fail("refused in another order: ", status.GetErrorMessage());
    }
    ReferenceValues const base = GetPositions(other.oracleCase.shape);
    double const allowed = other.oracleCase.GetTolerance(1e-12) * std::max(1.0, GetSize(base));
    auto const others = InterpolateLevels(*refiner, base);
    auto const &own = levels.values[0].levels;
    auto const check = [&](Eigen::RowVectorXd const &a, Eigen::RowVectorXd const &b,
                           std::string const &what) {
        if (!(GetDifference(a, b) <= allowed)) {
            Fail(what, " is ", a, ", and ", b, " in another order of faces and vertices");
        }
    };
    if (others.size() != own.size() || others.back().rows() != own.back().rows()) {
        Fail("another number of vertices in another order of faces and vertices");
    }
    int const numVertices = int(other.vertices.size());
    ReferenceValues const otherLimits = limits ? limitPoints(*refiner, base) : ReferenceValues();
    for (int v = 0; v < numVertices; ++v) {
        // A coplanar refinement drops vertices.
        int ownV = v;
        int otherV = other.vertices[std::size_t(v)];
        for (std::size_t level = 1; level < own.size(); ++level) {
            ownV = levels.refiner.GetLevel(int(level) - 1).GetVertexChildVertex(ownV);
            otherV = refiner->GetLevel(int(level) - 1).GetVertexChildVertex(otherV);
            if (ownV < 0 || otherV < 0) {
                break;
            }
            check(own[level].row(ownV), others[level].row(otherV),
                  "vertex " + std::to_string(v) + " at level " + std::to_string(level));
        }
        if (limits) {
            check(limits->row(v), otherLimits.row(other.vertices[std::size_t(v)]),
                  "the limit of vertex " + std::to_string(v));
        }
    }
    if (own.size() < 2) {
        return;
    }
    bool const isTruncation = levels.oracleCase.firstStep == FarExt::FirstStep::Truncate;
    // The edge that begins in a corner is another where faces are turned over.
    if (levels.oracleCase.shape.leftHanded || (isTruncation && other.isReversed)) {
        return;
    }
    std::size_t const perCorner =
        isTruncation ? 2 : 1; // vertices of F-faces, that of a corner last
    int const firstFVertex = levels.refiner.GetLevel(0).GetFaceChildVertices(0)[int(perCorner) - 1];
    for (std::size_t c = 0; c < other.corners.size(); ++c) {
        check(own[1].row(firstFVertex + int(c)), others[1].row(firstFVertex + other.corners[c]),
              "the point at corner " + std::to_string(c));
    }
    for (std::size_t i = 2; i < levels.values.size(); ++i) {
        int const channel = levels.values[i].channel;
        auto const otherValues = InterpolateLevels(*refiner, levels.values[i].levels[0],
                                                   ValueKind::FaceVarying, channel);
        // The faces come first in level 1, corner by corner.
        auto const valuesOf = [channel](TopologyLevel const &level, int numFaces) {
            std::vector<int> values;
            for (int f = 0; f < numFaces; ++f) {
                auto const face = level.GetFaceFVarValues(f, channel);
                values.insert(values.end(), face.begin(), face.end());
            }
            return values;
        };
        int const numFaces = levels.oracleCase.shape.GetNumFaces();
        std::vector<int> const ownCorners = valuesOf(levels.refiner.GetLevel(1), numFaces);
        std::vector<int> const otherCorners = valuesOf(refiner->GetLevel(1), numFaces);
        auto const place = [=](std::size_t corner) { return perCorner * corner + perCorner - 1; };
        for (std::size_t c = 0; c < other.corners.size(); ++c) {
            // A truncation alone has new values on edges.
            int const vert = levels.oracleCase.shape.faceVertices[c];
            if (isTruncation && comesBack(levels.refiner.GetLevel(0), vert, channel)) {
                continue;
            }
            check(levels.values[i].levels[1].row(ownCorners[place(c)]),
                  otherValues[1].row(otherCorners[place(std::size_t(other.corners[c]))]),
                  "the value of channel " + std::to_string(channel) + " at corner " +
                      std::to_string(c));
        }
    }
}

} // namespace

void CheckOrders(OracleLevels const &levels, Dice &dice) {
    bool const hasLimits = levels.refiner.GetHexSchemeOptions().IsHexagonal() &&
                           !levels.oracleCase.isCoplanar && dice.IsOneOf(8);
    ReferenceValues limits;
    if (hasLimits) {
        limits = limitPoints(levels.refiner, levels.values[0].levels[0]);
    }
    auto const check = [&](std::vector<int> const &order) {
        Reordered const other(levels.oracleCase, order, dice, dice.IsOneOf(2));
        checkOrder(levels, other, hasLimits ? &limits : nullptr);
    };
    std::vector<int> order(std::size_t(levels.oracleCase.shape.GetNumFaces()));
    std::iota(order.begin(), order.end(), 0);
    if (order.size() <= 4 && dice.IsOneOf(8)) {
        do {
            check(order);
        } while (std::next_permutation(order.begin(), order.end()));
        return;
    }
    for (std::size_t i = order.size(); i > 1; --i) {
        std::swap(order[i - 1], order[std::size_t(dice.Roll(int(i)))]);
    }
    check(order);
}

} // namespace OpenSubdivHex::Regression

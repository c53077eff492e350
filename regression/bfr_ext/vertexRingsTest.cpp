// SPDX-License-Identifier: Apache-2.0
//
// Steps by rings of plain faces, against steps of their patches.
#include "bfr_ext/cell/plainFace.h"
#include "far_ext/vtr/hierarchy.h"
#include "regression/far_ext/referenceMatch.h"
#include "regression/shapes/flatShapes.h"
#include "regression/shapes/meshOperations.h"
#include "regression/shapes/shapeDescriptor.h"
#include "regression/shapes/torus.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <string>

namespace OpenSubdivHex::Regression::vertexRingsTest {

using BfrExt::internal::CellRules;
using BfrExt::internal::CellType;
using BfrExt::internal::CellTypes;
using BfrExt::internal::ChildStep;
using BfrExt::internal::FaceRings;
using BfrExt::internal::PlainFaceGatherer;
using BfrExt::internal::PlainFaceType;
using BfrExt::internal::RingCell;
using BfrExt::internal::RingItem;
using BfrExt::internal::RingPlaces;
using BfrExt::internal::RingSources;
using BfrExt::internal::RingStep;
using BfrExt::internal::RingValues;
using BfrExt::internal::StepMatrix;

namespace {

constexpr std::size_t kSize = 5; // of points, which is more than is computed with at once

/// Points of a mesh by chance.
std::vector<double> makePoints(int numVertices) {
    std::mt19937 random;
    std::uniform_real_distribution<double> between(-1, 1);
    std::vector<double> points(kSize * std::size_t(numVertices));
    std::generate(points.begin(), points.end(), [&] { return between(random); });
    return points;
}

/// Some points of an array, in an order.
std::vector<double> pick(std::vector<double> const &points, std::size_t stride,
                         std::vector<int> const &indices) {
    std::vector<double> result;
    for (int const index : indices) {
        auto const first = points.begin() + std::ptrdiff_t(std::size_t(index) * stride);
        result.insert(result.end(), first, first + std::ptrdiff_t(kSize));
    }
    return result;
}

/// Overload for points of rings, padded, by point of a cell's type or by point that its step makes.
std::vector<double> pickCell(RingPlaces const &places, double const *points,
                             std::vector<int> const &indices) {
    std::vector<int> ofType(indices.size());
    for (std::size_t column = 0; column < indices.size(); ++column) {
        ofType[std::size_t(places.GetColumns()[column])] = indices[column];
    }
    std::size_t const stride = StepMatrix::GetPaddedSize(kSize);
    std::size_t const last = std::size_t(*std::max_element(indices.begin(), indices.end()));
    return pick({points, points + (last + 1) * stride}, stride, ofType);
}

/// Points without gaps, with what they are filled up with, and behind them a point of zeros.
std::vector<double> pad(std::vector<double> const &points) {
    std::vector<double> result;
    for (std::size_t i = 0; i < points.size(); i += kSize) {
        result.insert(result.end(), &points[i], &points[i] + kSize);
        result.resize(result.size() + StepMatrix::GetPaddedSize(kSize) - kSize);
    }
    result.resize(result.size() + StepMatrix::GetPaddedSize(kSize));
    return result;
}

RingSources<double> getSources(std::vector<double> const &points, std::size_t numPoints,
                               int const *indices) {
    return {points.data(), kSize, kSize, numPoints, indices};
}

/// Points one behind the other, in order.
std::vector<int> makeNumbers(std::size_t count) {
    std::vector<int> numbers(count);
    std::iota(numbers.begin(), numbers.end(), 0);
    return numbers;
}

/// The points that a step makes of points of a type, without gaps.
std::vector<double> step(CellType const &type, std::vector<double> const &points) {
    std::size_t const padded = StepMatrix::GetPaddedSize(kSize);
    std::vector<double> own(std::size_t(type.GetNumPoints()) * padded);
    for (std::size_t i = 0; i < std::size_t(type.GetNumPoints()); ++i) {
        std::copy_n(&points[i * kSize], kSize, &own[i * padded]);
    }
    std::vector<double> ofStep(type.GetStep().GetNumRows() * padded);
    type.GetStep().Apply(own.data(), padded, ofStep.data());
    return pick(ofStep, padded, makeNumbers(type.GetStep().GetNumRows()));
}

/// These points, by point of a child.
std::vector<double> stepTo(CellType const &type, std::size_t child,
                           std::vector<double> const &points) {
    ChildStep const &to = type.GetChildren()[child].step;
    std::vector<double> const padded = pad(step(type, points)); // of which CopyPoints() takes some
    std::vector<double> own(to.GetNumRows() * StepMatrix::GetPaddedSize(kSize));
    to.CopyPoints(padded.data(), StepMatrix::GetPaddedSize(kSize), own.data());
    return pick(own, StepMatrix::GetPaddedSize(kSize), makeNumbers(to.GetNumRows()));
}

/// Expects that two types are the same or, behind another step, that what they become is.
void expectAlike(RingCell const &cell, CellType const &type) {
    if (!cell.IsInner()) {
        EXPECT_EQ(&cell.GetType(), &type);
        return;
    }
    auto const &children = cell.GetType().GetChildren();
    ASSERT_EQ(children.size(), type.GetChildren().size());
    for (std::size_t i = 0; i < children.size(); ++i) {
        EXPECT_EQ(children[i].type, type.GetChildren()[i].type) << "of children, number " << i;
    }
}

void expectNear(std::vector<double> const &points, std::vector<double> const &expected) {
    ASSERT_EQ(points.size(), expected.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        ASSERT_NEAR(points[i], expected[i], 1e-14) << "number " << i;
    }
}

/// Expects that rings have the points of all cells of plain faces, and that what has rings of its own gets
/// the same from all faces, to the bit.
class Rings {
public:
    explicit Rings(CellRules const &rules) : _rules(rules) {}

    /// \return  how many faces have rings
    int Expect(Shape const &shape) {
        auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0);
        FarExt::internal::Level const &level = refiner->GetHierarchy().mesh.levels[0];
        BfrExt::internal::FaceWalk const walk(level);
        std::vector<double> const points = makePoints(level.numVertices);
        PlainFaceGatherer gatherer;
        int numFaces = 0;
        for (int face = 0; face < level.numFaces && !testing::Test::HasFailure(); ++face) {
            SCOPED_TRACE(face);
            std::vector<Far::Index> indices;
            PlainFaceType const *const plain =
                gatherer.Find(_types.GetPlainFaces(_rules), walk, face, indices);
            if (!plain || plain->IsInLattice()) {
                continue;
            }
            ++numFaces;
            int const numPoints = plain->GetNumPoints();
            std::vector<int> const turns(indices.begin() + numPoints, indices.end());
            indices.resize(std::size_t(numPoints));
            expectFace(*plain, turns, pick(points, kSize, indices));
        }
        return numFaces;
    }

    /// Edges and vertices of these that are in a lattice.
    int numLatticeItems = 0;

private:
    void expectFace(PlainFaceType const &plain, std::vector<int> const &turns,
                    std::vector<double> const &points) {
        FaceRings const &face = plain.GetRings();
        CellType const &type = plain.Get();
        RingValues<double> values;
        values.Set(face.GetRings(), &turns[std::size_t(type.GetNumCorners())],
                   getSources(points, std::size_t(type.GetNumPoints()), nullptr));
        std::vector<double> unturned(face.GetRings().GetNumPoints() * values.GetPaddedSize());
        face.GetRings().Apply(pad(points).data(), values.GetPaddedSize(), unturned.data());
        std::vector<int> indices;
        for (std::size_t child = 0; child < type.GetChildren().size(); ++child) {
            RingCell const &cell = face.GetChild(child);
            CellType const &ofChild = *type.GetChildren()[child].type;
            SCOPED_TRACE("child " + std::to_string(child));
            ASSERT_EQ(_isInner, cell.IsInner());
            expectAlike(cell, ofChild);
            std::vector<double> const expected = stepTo(type, child, points);
            indices.resize(cell.GetPoints().GetColumns().size());
            face.FindChildIndices(
                child, cell.GetPoints(),
                [&](int ring, int ofRing) {
                    return face.GetRings().GetPoints(ring, 0, ofRing, RingStep::First);
                },
                indices.data());
            expectNear(pickCell(cell.GetPoints(), unturned.data(), indices), expected);
            values.FindChildIndices(face, child, indices);
            expectNear(pickCell(cell.GetPlaces(), values.GetPoints(), indices),
                       cell.IsInner() ? step(ofChild, expected) : expected);
        }
        int const numEdges = type.GetNumCorners();
        for (int edge = 0; edge < numEdges; ++edge) {
            expectEdge(type, face, edge, turns, values, points);
            ASSERT_EQ(face.IsEdgeInLattice(edge), !face.GetLongEdge(edge, false));
            if (face.IsEdgeInLattice(edge)) {
                expectLatticeItem(plain, edge, turns);
            }
        }
        for (int vert = 0; vert < numEdges; ++vert) {
            expectVertex(type, face, vert, turns, values, points);
            ASSERT_EQ(face.IsVertexInLattice(vert), !face.GetVVertex(vert, 0));
            if (face.IsVertexInLattice(vert)) {
                expectLatticeItem(plain, numEdges + vert, turns);
            }
        }
    }

    void expectLatticeItem(PlainFaceType const &plain, int item, std::vector<int> const &turns) {
        ++numLatticeItems;
        auto const number = std::size_t(item);
        CellType::BorderItem const &own = plain.GetLatticeItem(turns.data(), number);
        CellType::BorderItem const &expected = plain.Get().GetBorderItem(turns.data(), number);
        EXPECT_EQ(own.type, expected.type) << "item " << item;
        EXPECT_EQ(own.points, expected.points) << "item " << item;
        EXPECT_EQ(own.isReversed, expected.isReversed) << "item " << item;
        EXPECT_EQ(own.rings, expected.rings) << "item " << item;
    }

    void expectEdge(CellType const &type, FaceRings const &face, int edge,
                    std::vector<int> const &turns, RingValues<double> &values,
                    std::vector<double> const &points) {
        CellType::BorderItem const &item = type.GetBorderItem(turns.data(), std::size_t(edge));
        RingCell const *const cell = face.GetLongEdge(edge, item.isReversed);
        ASSERT_EQ(item.type->IsInLattice(), cell == nullptr) << "edge " << edge;
        ASSERT_EQ(item.rings == nullptr, cell == nullptr) << "edge " << edge;
        if (!cell) {
            return;
        }
        ASSERT_EQ(cell, item.rings->cell);
        std::vector<int> indices(cell->GetColumns().size());
        double const *const ofRings = values.GetPoints();
        face.FindLongEdgeIndices(
            edge, item.isReversed,
            [&](int ring, int ofRing) { return values.GetPointsOfRing(ring, ofRing); },
            indices.data());
        std::vector<double> const ofFace = pickCell(cell->GetPlaces(), ofRings, indices);
        // From the face on that is left of the edge.
        int const numEdges = type.GetNumCorners();
        int const start = turns[std::size_t(numEdges + edge)];
        int const end = turns[std::size_t(numEdges + (edge + 1) % numEdges)];
        int const ownTurns[2] = {item.isReversed ? end + 1 : start,
                                 item.isReversed ? start - 1 : end};
        RingValues<double> ownValues;
        ownValues.Set(item.rings->rings, ownTurns,
                      getSources(points, item.points.size(), item.points.data()));
        double const *const own = ownValues.GetPoints();
        cell->GetPlaces().FindIndices([&](int ring) { return ownValues.GetPointsOfRing(ring, 0); },
                                      indices.data());
        EXPECT_EQ(ofFace, pickCell(cell->GetPlaces(), own, indices)) << "edge " << edge;
        CellType const &longEdge = *item.type->GetChildren()[0].type;
        expectAlike(*cell, longEdge);
        std::vector<double> const expected =
            stepTo(*item.type, 0, pick(points, kSize, item.points));
        expectNear(ofFace, cell->IsInner() ? step(longEdge, expected) : expected);
    }

    void expectVertex(CellType const &type, FaceRings const &face, int vert,
                      std::vector<int> const &turns, RingValues<double> &values,
                      std::vector<double> const &points) {
        auto const place = std::size_t(type.GetNumCorners()) + std::size_t(vert);
        CellType::BorderItem const &item = type.GetBorderItem(turns.data(), place);
        RingCell const *const cell = face.GetVVertex(vert, turns[place]);
        ASSERT_EQ(item.type->IsInLattice(), cell == nullptr) << "vertex " << vert;
        ASSERT_EQ(item.rings == nullptr, cell == nullptr) << "vertex " << vert;
        if (!cell) {
            return;
        }
        ASSERT_EQ(cell, item.rings->cell);
        std::vector<double> ofFace(kSize);
        values.EvaluateVertex(*cell, vert, ofFace.data());
        RingValues<double> ownValues;
        ownValues.Set(item.rings->rings, nullptr,
                      getSources(points, item.points.size(), item.points.data()));
        std::vector<double> own(kSize);
        ownValues.EvaluateVertex(*cell, 0, own.data());
        EXPECT_EQ(ofFace, own) << "vertex " << vert;
        std::vector<double> expected(kSize);
        std::vector<double> const &weights = type.GetCornerPoints()[std::size_t(vert)];
        for (std::size_t i = 0; i < weights.size(); ++i) {
            for (std::size_t k = 0; k < kSize; ++k) {
                expected[k] += weights[i] * points[i * kSize + k];
            }
        }
        expectNear(ofFace, expected);
    }

    CellRules const _rules;
    bool const _isInner = _rules.hexSchemeOptions.faceMask == FarExt::FaceMask::Smooth;
    CellTypes _types;
};

class VertexRingsTest : public testing::TestWithParam<FarExt::FaceMask> {
protected:
    CellRules makeRules() const {
        CellRules rules;
        rules.hexSchemeOptions.faceMask = GetParam();
        return rules;
    }
};

} // namespace

TEST_P(VertexRingsTest, HaveThePointsOfTheirSteps) {
    Rings rings(makeRules());
    int numFaces = 0;
    for (Shape const &shape : GetShapes()) {
        SCOPED_TRACE(shape.name);
        numFaces += shape.GetNumFaces() < 1000 ? rings.Expect(shape) : 0;
    }
    EXPECT_GT(numFaces, 100);
    Shape const triangles = MakeTorus(9, 8, TorusFaces::IrregularTriangles);
    EXPECT_GT(rings.Expect(triangles), 0);
    EXPECT_GT(rings.Expect(MakeDual("dual", triangles)), 0);
    EXPECT_GT(rings.Expect(MakeChamfered("chamfered", MakeTorus(7, 6, TorusFaces::Quads))), 0);
    // Beside its corners are edges and vertices in the lattice of the rest.
    EXPECT_GT(rings.Expect(MakeBox(6, 6, 6)), 0);
    EXPECT_GT(rings.numLatticeItems, 100);
}

INSTANTIATE_TEST_SUITE_P(Masks, VertexRingsTest,
                         testing::Values(FarExt::FaceMask::Average, FarExt::FaceMask::Smooth));

} // namespace OpenSubdivHex::Regression::vertexRingsTest

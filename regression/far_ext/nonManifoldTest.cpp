// SPDX-License-Identifier: Apache-2.0
//
// Meshes at the edge of what is taken: soups of faces under all their orders, inconsistent
// orientation, vertices that a face has several times or that have tens of thousands of faces.
#include "expectations.h"

#include "regression/reference/largestValue.h"
#include "regression/shapes/shapeDescriptor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numeric>
#include <random>
#include <set>

namespace OpenSubdivHex::Regression::nonManifoldTest {

using FarExt::CallStatus;
using FarExt::TopologyRefinerFactory;

namespace {

using Faces = std::vector<std::vector<int>>;

constexpr auto kNone = Sdc::Options::VTX_BOUNDARY_NONE;
constexpr auto kEdgeOnly = Sdc::Options::VTX_BOUNDARY_EDGE_ONLY;

Sdc::Options boundary(Sdc::Options::VtxBoundaryInterpolation rule) {
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(rule);
    return options;
}

void setFaces(Faces const &faces, Shape &shape) {
    shape.faceSizes.clear();
    shape.faceVertices.clear();
    for (std::vector<int> const &face : faces) {
        shape.faceSizes.push_back(int(face.size()));
        shape.faceVertices.insert(shape.faceVertices.end(), face.begin(), face.end());
    }
}

Faces getFaces(Shape const &shape) {
    Faces faces;
    auto vertex = shape.faceVertices.begin();
    for (int size : shape.faceSizes) {
        faces.emplace_back(vertex, vertex + size);
        vertex += size;
    }
    return faces;
}

Shape makeShape(std::vector<double> const &positions, Faces const &faces) {
    Shape shape;
    shape.positions = positions;
    setFaces(faces, shape);
    return shape;
}

/// The shape with its faces in another order: face i was face order[i].
Shape reorder(Shape const &shape, std::vector<int> const &order) {
    Shape result = shape;
    Faces const faces = getFaces(shape);
    Faces moved;
    result.holeFaces.clear();
    for (int face : order) {
        if (std::count(shape.holeFaces.begin(), shape.holeFaces.end(), face) > 0) {
            result.holeFaces.push_back(int(moved.size()));
        }
        moved.push_back(faces[face]);
    }
    setFaces(moved, result);
    return result;
}

void expectEqualToReference(Shape const &shape, Sdc::Options options, int numLevels) {
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, numLevels, options);
    ASSERT_TRUE(refiner);
    ASSERT_NO_FATAL_FAILURE(ExpectValid(*refiner));
    TaggedMatch const match(shape, *refiner);
    ASSERT_EQ(match.GetError(), "");
    ReferenceValues const positions = GetPositions(shape);
    ASSERT_NO_FATAL_FAILURE(
        ExpectLevelsEqual(InterpolateLevels(*refiner, positions),
                          match.InterpolateAll(ReferenceMask::Smooth, positions), 1e-12));
}

/// Random numbers that are the same everywhere.
class Random {
public:
    explicit Random(unsigned seed) : _engine(seed) {}

    /// 0 ... end - 1.
    int Below(int end) { return int(_engine() % unsigned(end)); }
    double Coordinate() { return Below(4001) / 1000.0 - 2; }
    template <typename T>
    void Shuffle(std::vector<T> &items) {
        for (int i = int(items.size()) - 1; i > 0; --i) {
            std::swap(items[i], items[Below(i + 1)]);
        }
    }

private:
    std::mt19937 _engine;
};

/// Few vertices, so that faces meet in all ways, with tags on some edges and vertices.
Shape makeSoup(Random &random, bool repeatsVertices) {
    int const numVertices = 4 + random.Below(4);
    Faces faces(2 + random.Below(5));
    std::vector<int> vertices(numVertices);
    std::iota(vertices.begin(), vertices.end(), 0);
    for (std::vector<int> &face : faces) {
        random.Shuffle(vertices);
        face.assign(vertices.begin(),
                    vertices.begin() + 3 + random.Below(numVertices - 2 > 3 ? 3 : 2));
        if (repeatsVertices && random.Below(2) == 0) {
            face.insert(face.begin() + random.Below(int(face.size()) + 1),
                        face[random.Below(int(face.size()))]);
        }
    }
    Shape shape;
    for (int i = 0; i < 3 * numVertices; ++i) {
        shape.positions.push_back(random.Coordinate());
    }
    setFaces(faces, shape);
    float const sharpnesses[] = {0.5f, 0.75f, 1.5f, 2.25f, 10};
    std::set<std::pair<int, int>> creases;
    for (int i = random.Below(4); i > 0; --i) {
        std::vector<int> const &face = faces[random.Below(int(faces.size()))];
        int const corner = random.Below(int(face.size()));
        auto const pair = std::minmax(face[corner], face[(corner + 1) % face.size()]);
        if (pair.first != pair.second && creases.insert(pair).second) {
            shape.creaseVertexPairs.insert(shape.creaseVertexPairs.end(),
                                           {pair.first, pair.second});
            shape.creaseSharpness.push_back(sharpnesses[random.Below(5)]);
        }
    }
    if (random.Below(3) == 0) {
        shape.cornerVertices.push_back(random.Below(numVertices));
        shape.cornerSharpness.push_back(sharpnesses[random.Below(5)]);
    }
    if (random.Below(3) == 0) {
        shape.holeFaces.push_back(random.Below(int(faces.size())));
    }
    return shape;
}

Sdc::Options makeOptions(Random &random) {
    Sdc::Options options = boundary(kBoundaries[random.Below(3)]);
    options.SetCreasingMethod(random.Below(2) == 0 ? Sdc::Options::CREASE_UNIFORM
                                                   : Sdc::Options::CREASE_CHAIKIN);
    return options;
}

/// All orders of a few faces; of more the first, the last and some others.
std::vector<std::vector<int>> makeOrders(int numFaces, Random &random) {
    constexpr int kMaxOrders = 24;
    std::vector<int> order(numFaces);
    std::iota(order.begin(), order.end(), 0);
    std::vector<std::vector<int>> orders;
    do {
        orders.push_back(order);
    } while (int(orders.size()) <= kMaxOrders && std::next_permutation(order.begin(), order.end()));
    if (int(orders.size()) > kMaxOrders) {
        orders.resize(1);
        while (int(orders.size()) < kMaxOrders) {
            random.Shuffle(order);
            orders.push_back(order);
        }
    }
    return orders;
}

/// The F-vertices of a level 1 as the original order of faces has them.
ReferenceValues toOriginalOrder(Shape const &shape, std::vector<int> const &order,
                                ReferenceValues const &values) {
    int const numVertices = shape.GetNumVertices();
    std::vector<int> firstCorner(order.size() + 1, 0);
    for (std::size_t f = 0; f < order.size(); ++f) {
        firstCorner[f + 1] = firstCorner[f] + shape.faceSizes[f];
    }
    ReferenceValues result = values;
    int corner = numVertices;
    for (int face : order) {
        for (int i = 0; i < shape.faceSizes[face]; ++i) {
            result.row(numVertices + firstCorner[face] + i) = values.row(corner++);
        }
    }
    return result;
}

void expectSoupsEqualToReference(unsigned firstSeed, int count, bool repeatsVertices) {
    for (unsigned seed = firstSeed; seed < firstSeed + unsigned(count); ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        Random random(seed);
        Shape const soup = makeSoup(random, repeatsVertices);
        Sdc::Options const options = makeOptions(random);
        SCOPED_TRACE(testing::PrintToString(getFaces(soup)));
        ASSERT_NO_FATAL_FAILURE(expectEqualToReference(soup, options, 3));
        ReferenceValues first;
        for (std::vector<int> const &order : makeOrders(soup.GetNumFaces(), random)) {
            SCOPED_TRACE(testing::Message() << "order " << testing::PrintToString(order));
            Shape const reordered = reorder(soup, order);
            ASSERT_NO_FATAL_FAILURE(expectEqualToReference(reordered, options, 1));
            auto const refiner = CreateRefiner(reordered, ReferenceMask::Smooth, 1, options);
            ReferenceValues const values = toOriginalOrder(
                soup, order, InterpolateLevels(*refiner, GetPositions(reordered))[1]);
            first = first.size() == 0 ? values : first;
            ASSERT_LT(GetLargestValue(values - first), 1e-13);
        }
    }
}

/// The number in the environment, for longer runs by hand, or else \p count.
int getCount(int count) {
    char const *const more = std::getenv("OPENSUBDIVHEX_SOUPS");
    return more ? std::atoi(more) : count;
}

} // namespace

TEST(NonManifold, SoupsEqualReferenceInEveryOrderOfFaces) {
    ASSERT_NO_FATAL_FAILURE(expectSoupsEqualToReference(1, getCount(300), false));
}

TEST(NonManifold, SoupsOfFacesThatRepeatVerticesEqualReference) {
    ASSERT_NO_FATAL_FAILURE(expectSoupsEqualToReference(100001, getCount(300), true));
}

TEST(NonManifold, TwoEdgesThatCameApartAreACurveInEveryOrderOfFaces) {
    Shape const shape = makeShape(
        {.36, -1.08, -2.84, .42, .23, 1.79, -.32, .88, -.87, -1.13, -.30, .23, -.01, 1.14, 1.22},
        {{0, 3, 4, 1}, {4, 3, 1}, {2, 0, 4}, {2, 4, 0}, {1, 2, 0}, {2, 1, 3, 4}});
    ReferenceValues const positions = GetPositions(shape);
    Eigen::RowVector3d const expected =
        (6 * positions.row(4) + positions.row(3) + positions.row(2)) / 8;
    std::vector<int> order(shape.GetNumFaces());
    std::iota(order.begin(), order.end(), 0);
    do {
        auto const refiner =
            CreateRefiner(reorder(shape, order), ReferenceMask::Average, 1, boundary(kEdgeOnly));
        ASSERT_LT((InterpolateLevels(*refiner, positions)[1].row(4) - expected).norm(), 1e-14)
            << testing::PrintToString(order);
    } while (std::next_permutation(order.begin(), order.end()));
}

TEST(NonManifold, SectorsDoNotDependOnTheOrderOfFans) {
    Shape const shape = makeShape({0, 0, 0, 1, 0, 0, 0, 1, .2, -1, 0, .1, 0, -1, .3, .5, 0, 1},
                                  {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}, {0, 1, 5}});
    ReferenceValues const positions = GetPositions(shape);
    ReferenceValues first;
    for (std::vector<int> order : {std::vector<int>{0, 1, 2, 3, 4}, {4, 0, 1, 2, 3}}) {
        Shape const reordered = reorder(shape, order);
        ASSERT_NO_FATAL_FAILURE(expectEqualToReference(reordered, boundary(kNone), 3));
        auto const refiner = CreateRefiner(reordered, ReferenceMask::Average, 1, boundary(kNone));
        ReferenceValues const values =
            toOriginalOrder(shape, order, InterpolateLevels(*refiner, positions)[1]);
        first = first.size() == 0 ? values : first;
        EXPECT_LT(GetLargestValue(values - first), 1e-14);
    }
}

namespace {

/// A strip of quads around a circle, turned over once on the way.
Shape makeMoebiusStrip(int numFaces) {
    Shape shape;
    for (int i = 0; i < numFaces; ++i) {
        double const angle = 2 * std::acos(-1.0) * i / numFaces;
        for (double side : {-0.4, 0.4}) {
            double const radius = 2 + side * std::cos(angle / 2);
            shape.positions.insert(
                shape.positions.end(),
                {radius * std::cos(angle), radius * std::sin(angle), side * std::sin(angle / 2)});
        }
    }
    Faces faces;
    for (int i = 0; i + 1 < numFaces; ++i) {
        faces.push_back({2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1});
    }
    faces.push_back({2 * numFaces - 2, 1, 0, 2 * numFaces - 1});
    setFaces(faces, shape);
    return shape;
}

/// The edges that two faces run in the same direction.
std::set<std::pair<int, int>> findInconsistentEdges(Shape const &shape) {
    std::map<std::pair<int, int>, int> uses;
    for (std::vector<int> const &face : getFaces(shape)) {
        for (std::size_t i = 0; i < face.size(); ++i) {
            ++uses[{face[i], face[(i + 1) % face.size()]}];
        }
    }
    std::set<std::pair<int, int>> result;
    for (auto const &[edge, count] : uses) {
        if (count == 2) {
            result.insert(edge);
        }
    }
    return result;
}

/// The mesh is refined as given, and its status says which edges are inconsistent.
void expectRefinedWithWarning(Shape const &shape, Sdc::Options options) {
    ASSERT_NO_FATAL_FAILURE(expectEqualToReference(shape, options, 3));
    ShapeDescriptor const descriptor(shape);
    CallStatus status;
    auto const refiner = TopologyRefinerFactory::Create(descriptor.Get(), options, &status);
    ASSERT_TRUE(refiner);
    EXPECT_TRUE(status.IsOk());
    EXPECT_EQ(status.GetErrorMessage(), "");
    std::set<std::pair<int, int>> const edges = findInconsistentEdges(shape);
    ASSERT_EQ(status.GetWarnings().size(), edges.empty() ? 0 : 1);
    refiner->RefineUniform(1);
    for (int f = 0; f < shape.GetNumFaces(); ++f) {
        auto const verts = refiner->GetLevel(0).GetFaceVertices(f);
        EXPECT_EQ(std::vector<int>(verts.begin(), verts.end()), getFaces(shape)[f]);
        for (int i = 0; i < verts.size(); ++i) {
            EXPECT_EQ(refiner->GetLevel(1).GetFaceVertices(f)[i],
                      refiner->GetLevel(0).GetFaceChildVertices(f)[i]);
        }
    }
    if (edges.empty()) {
        return;
    }
    FarExt::Warning const &warning = status.GetWarnings()[0];
    EXPECT_EQ(warning.code, FarExt::WarningCode::InconsistentOrientation);
    EXPECT_EQ(warning.component, FarExt::ComponentType::Edge);
    EXPECT_EQ(warning.count, std::int64_t(edges.size()));
    auto const verts = refiner->GetLevel(0).GetEdgeVertices(warning.index);
    EXPECT_EQ(edges.count({verts[0], verts[1]}) + edges.count({verts[1], verts[0]}), 1);
    for (int e = 0; e < warning.index; ++e) {
        auto const other = refiner->GetLevel(0).GetEdgeVertices(e);
        EXPECT_EQ(edges.count({other[0], other[1]}) + edges.count({other[1], other[0]}), 0);
    }
    for (std::string const &word :
         {"run " + std::to_string(edges.size()) + " edge", "edge " + std::to_string(warning.index),
          "vertices " + std::to_string(verts[0]) + " and " + std::to_string(verts[1])}) {
        EXPECT_NE(warning.message.find(word), std::string::npos) << warning.message;
    }
}

} // namespace

TEST(NonManifold, MoebiusStripsAreRefinedAsFarDoes) {
    for (int numFaces : {3, 4, 5, 8, 13}) {
        for (auto rule : kBoundaries) {
            SCOPED_TRACE(testing::Message() << numFaces << " faces, boundary " << rule);
            Shape const strip = makeMoebiusStrip(numFaces);
            EXPECT_EQ(findInconsistentEdges(strip).size(), 1U);
            ASSERT_NO_FATAL_FAILURE(expectRefinedWithWarning(strip, boundary(rule)));
        }
    }
}

TEST(NonManifold, CubesWithFlippedFacesAreRefinedAsFarDoes) {
    for (unsigned flipped = 0; flipped < 64; ++flipped) {
        SCOPED_TRACE(testing::Message() << "flipped " << flipped);
        Shape cube = GetShape("cube");
        Faces faces = getFaces(cube);
        for (std::size_t f = 0; f < faces.size(); ++f) {
            if ((flipped >> f) % 2 != 0) {
                std::reverse(faces[f].begin(), faces[f].end());
            }
        }
        setFaces(faces, cube);
        ASSERT_NO_FATAL_FAILURE(expectRefinedWithWarning(cube, boundary(kEdgeOnly)));
    }
}

TEST(NonManifold, FarPinsAndCurvesTheSameVertices) {
    // Far's own values on sharp lines, where its masks and those of level 1 here are the same.
    for (unsigned seed = 1; seed < 400; ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        Random random(seed);
        Shape const soup = makeSoup(random, false);
        Sdc::Options const options = boundary(kEdgeOnly);
        auto const base = CreateFarRefiner(soup, options);
        auto const refiner = CreateRefiner(soup, ReferenceMask::Average, 1, options);
        for (int v = 0; v < soup.GetNumVertices(); ++v) {
            Far::TopologyLevel const &level = base->GetLevel(0);
            if (level.IsVertexNonManifold(v)) {
                ASSERT_EQ(level.GetVertexSharpness(v), refiner->GetLevel(0).GetVertexSharpness(v))
                    << "vertex " << v;
                ASSERT_EQ(level.GetVertexRule(v), refiner->GetLevel(0).GetVertexRule(v));
            }
        }
    }
}

TEST(NonManifold, ChannelWithoutSeamsMovesAsVerticesDoOrIsRefused) {
    int numRefused = 0;
    int numTaken = 0;
    for (unsigned seed = 1; seed <= unsigned(getCount(300)); ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        Random random(seed);
        Shape soup = makeSoup(random, seed % 4 == 0);
        Sdc::Options options = makeOptions(random);
        // Values at borders then do as vertices do.
        options.SetFVarLinearInterpolation(Sdc::Options::FVAR_LINEAR_NONE);
        soup.fvarChannels.push_back({3, soup.positions, soup.faceVertices});
        ShapeDescriptor const descriptor(soup);
        CallStatus status;
        if (!TopologyRefinerFactory::Create(descriptor.Get(), options, &status)) {
            ++numRefused;
            EXPECT_EQ(status.GetCode(), FarExt::StatusCode::Unsupported)
                << status.GetErrorMessage();
            EXPECT_EQ(status.GetComponentType(), FarExt::ComponentType::Vertex);
            EXPECT_NE(status.GetErrorMessage().find("channel 0"), std::string::npos);
            continue;
        }
        ++numTaken;
        constexpr int kNumLevels = 3;
        auto const refiner = CreateRefiner(soup, ReferenceMask::Cosine, kNumLevels, options);
        ReferenceValues const positions = GetPositions(soup);
        auto const points = InterpolateLevels(*refiner, positions);
        auto const values = InterpolateLevels(*refiner, positions, ValueKind::FaceVarying);
        for (int depth = 1; depth <= kNumLevels; ++depth) {
            FarExt::TopologyLevel const &level = refiner->GetLevel(depth);
            for (int f = 0; f < level.GetNumFaces(); ++f) {
                for (int i = 0; i < level.GetFaceVertices(f).size(); ++i) {
                    ASSERT_LT((values[depth].row(level.GetFaceFVarValues(f)[i]) -
                               points[depth].row(level.GetFaceVertices(f)[i]))
                                  .norm(),
                              1e-12)
                        << "level " << depth << ", face " << f << ", corner " << i << " of "
                        << testing::PrintToString(getFaces(soup));
                }
            }
        }
    }
    EXPECT_GT(numRefused, numTaken / 50);
    EXPECT_GT(numTaken, numRefused);
}

TEST(NonManifold, ChannelWithoutSeamsIsRefusedWhereChaikinsRuleJoinsFans) {
    // Two fans that meet in vertex 0, each with a crease.
    Shape shape = makeShape({0, 0, 0, 1, 0, 0, 1, 1, .2, 0, 1, .1, -1, 0, .3, -1, -1, 0, 0, -1, .5},
                            {{0, 1, 2}, {0, 2, 3}, {0, 4, 5}, {0, 5, 6}});
    shape.fvarChannels.push_back({3, shape.positions, shape.faceVertices});
    Sdc::Options options = boundary(kEdgeOnly);
    options.SetFVarLinearInterpolation(Sdc::Options::FVAR_LINEAR_NONE);
    shape.creaseVertexPairs = {0, 2};
    shape.creaseSharpness = {2.5f};
    for (auto method : {Sdc::Options::CREASE_UNIFORM, Sdc::Options::CREASE_CHAIKIN}) {
        options.SetCreasingMethod(method);
        EXPECT_TRUE(CreateRefiner(shape, ReferenceMask::Average, 1, options));
    }
    shape.creaseVertexPairs = {0, 2, 5, 0};
    shape.creaseSharpness = {2.5f, 1.25f};
    ShapeDescriptor const descriptor(shape);
    CallStatus status;
    EXPECT_FALSE(TopologyRefinerFactory::Create(descriptor.Get(), options, &status));
    EXPECT_EQ(status.GetCode(), FarExt::StatusCode::Unsupported);
    EXPECT_EQ(status.GetComponentType(), FarExt::ComponentType::Vertex);
    EXPECT_EQ(status.GetComponentIndex(), 0);
    for (char const *word : {"channel 0", "vertex 0", "CREASE_CHAIKIN"}) {
        EXPECT_NE(status.GetErrorMessage().find(word), std::string::npos)
            << status.GetErrorMessage();
    }
    // Creases in one fan alone, one of them infinitely sharp in the other, and the other method.
    shape.creaseSharpness = {2.5f, 10};
    EXPECT_TRUE(CreateRefiner(shape, ReferenceMask::Average, 1, options));
    shape.creaseSharpness = {2.5f, 1.25f};
    options.SetCreasingMethod(Sdc::Options::CREASE_UNIFORM);
    EXPECT_TRUE(CreateRefiner(shape, ReferenceMask::Average, 1, options));
}

TEST(NonManifold, ChannelOfAFaceThatRepeatsAVertexStaysThere) {
    // Far, which takes vertex 4 for manifold, looks at one of its two corners in the last face.
    Shape shape = makeShape({0, 0, 0, 1, 0, 0, 2, 0, 1, 0, 1, 0, 1, 1, 0, 3, 1, 2},
                            {{3, 4, 5}, {0, 5, 4}, {4, 3, 2, 4, 1, 0}});
    Sdc::Options options = boundary(kNone);
    options.SetFVarLinearInterpolation(Sdc::Options::FVAR_LINEAR_CORNERS_PLUS1);
    shape.fvarChannels.push_back({3, shape.positions, shape.faceVertices});
    auto const refiner = CreateRefiner(shape, ReferenceMask::Average, 3, options);
    TaggedMatch const match(shape, *refiner, 0);
    ASSERT_EQ(match.GetError(), "");
    ReferenceValues const positions = GetPositions(shape);
    auto const values = InterpolateLevels(*refiner, positions, ValueKind::FaceVarying);
    ASSERT_NO_FATAL_FAILURE(
        ExpectLevelsEqual(values, match.InterpolateAll(ReferenceMask::Average, positions), 1e-12));
}

TEST(NonManifold, CreaseAtAVertexThatAFaceRepeatsIsKept) {
    // Far's list of edges of vertex 0 lacks the crease.
    Shape shape = makeShape({0, 0, 0, 1, 0, 0, 0, 1, 0, -1, 0, .2, 0, -1, .4, 1, 1, 0, -1, 1, 1},
                            {{0, 1, 5}, {2, 0, 6}, {0, 3, 6}, {4, 3, 0, 2, 1, 0}});
    for (std::vector<int> const &pair : {std::vector<int>{0, 1}, {1, 0}}) {
        shape.creaseVertexPairs = pair;
        shape.creaseSharpness = {2.5f};
        testing::internal::CaptureStderr();
        testing::internal::CaptureStdout();
        auto const refiner = CreateRefiner(shape, ReferenceMask::Average, 0, boundary(kEdgeOnly));
        EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
        EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
        int numCreases = 0;
        for (int e = 0; e < refiner->GetLevel(0).GetNumEdges(); ++e) {
            numCreases += refiner->GetLevel(0).GetEdgeSharpness(e) == 2.5f;
        }
        EXPECT_EQ(numCreases, 1);
        ASSERT_NO_FATAL_FAILURE(expectEqualToReference(shape, boundary(kEdgeOnly), 3));
    }
}

TEST(NonManifold, ChannelOfADegenerateEdgeIsValid) {
    // The value of vertex 1 has both of its corners in the first face, joined by the other face.
    Shape shape = makeShape({0, 0, 0, 1, 0, 0, 0, 1, .5}, {{0, 1, 1, 2}, {2, 1, 0}});
    shape.fvarChannels.push_back({3, shape.positions, shape.faceVertices});
    for (auto rule : kBoundaries) {
        Sdc::Options options = boundary(rule);
        options.SetFVarLinearInterpolation(Sdc::Options::FVAR_LINEAR_NONE);
        auto const refiner = CreateRefiner(shape, ReferenceMask::Average, 3, options);
        ASSERT_TRUE(refiner);
        ASSERT_NO_FATAL_FAILURE(ExpectValid(*refiner));
        TaggedMatch const match(shape, *refiner, 0);
        ASSERT_EQ(match.GetError(), "");
        ReferenceValues const positions = GetPositions(shape);
        ASSERT_NO_FATAL_FAILURE(
            ExpectLevelsEqual(InterpolateLevels(*refiner, positions, ValueKind::FaceVarying),
                              match.InterpolateAll(ReferenceMask::Average, positions), 1e-12));
    }
}

TEST(NonManifold, OneCreaseBoundsNoSector) {
    // Three faces all around vertex 0 with one crease, as in a mesh of them alone, and another face.
    Faces faces = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}};
    Shape shape = makeShape({0, 0, 1, 1, 0, 0, -.5, .8, 0, -.5, -.9, 0, 1, 0, 2, 0, 1, 2}, faces);
    shape.creaseVertexPairs = {0, 1};
    shape.creaseSharpness = {1.5f};
    shape.cornerVertices = {0};
    shape.cornerSharpness = {10};
    ReferenceValues const positions = GetPositions(shape);
    Sdc::Options const options = boundary(Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
    auto const alone = CreateRefiner(shape, ReferenceMask::Average, 1, options);
    faces.push_back({0, 4, 5});
    setFaces(faces, shape);
    auto const refiner = CreateRefiner(shape, ReferenceMask::Average, 1, options);
    ReferenceValues const expected = InterpolateLevels(*alone, positions)[1];
    ReferenceValues const actual = InterpolateLevels(*refiner, positions)[1];
    EXPECT_LT(GetLargestValue(actual.topRows(expected.rows()) - expected), 1e-14);
    ASSERT_NO_FATAL_FAILURE(expectEqualToReference(shape, options, 3));
}

TEST(NonManifold, HolesOfABaseRefinerAreKeptButAtFreeBorders) {
    // Far makes holes of all faces at a border, so that only those elsewhere tell.
    int numKept = 0;
    for (unsigned seed = 1; seed < 2000; ++seed) {
        Random random(seed);
        Shape const soup = makeSoup(random, false);
        auto const base = CreateFarRefiner(soup, boundary(kNone));
        auto const refiner = TopologyRefinerFactory::Create(*base);
        ASSERT_TRUE(refiner);
        for (int f = 0; f < soup.GetNumFaces(); ++f) {
            bool isAtBorder = false;
            for (int v : base->GetLevel(0).GetFaceVertices(f)) {
                isAtBorder = isAtBorder || base->GetLevel(0).IsVertexBoundary(v);
            }
            bool const isHole =
                std::count(soup.holeFaces.begin(), soup.holeFaces.end(), f) > 0 && !isAtBorder;
            ASSERT_EQ(refiner->GetLevel(0).IsFaceHole(f), isHole) << "seed " << seed;
            numKept += isHole ? 1 : 0;
        }
    }
    EXPECT_GT(numKept, 10);
}

TEST(NonManifold, VertexOfTensOfThousandsOfFacesEqualsReference) {
    // More than 16 bits with a sign count, in one open fan.
    constexpr int kNumFaces = 33000;
    Shape fan;
    fan.positions = {0, 0, 1};
    for (int i = 0; i <= kNumFaces; ++i) {
        double const angle = 3.0 * i / kNumFaces;
        fan.positions.insert(fan.positions.end(), {std::cos(angle), std::sin(angle), 0});
    }
    Faces faces;
    for (int i = 1; i <= kNumFaces; ++i) {
        faces.push_back({0, i, i + 1});
    }
    setFaces(faces, fan);
    for (auto rule : {kNone, kEdgeOnly}) {
        ASSERT_NO_FATAL_FAILURE(expectEqualToReference(fan, boundary(rule), 1));
    }
}

TEST(NonManifold, VertexThatAFaceRepeatsIsTagged) {
    Shape const shape =
        makeShape({0, 0, 0, 1, 0, 0, 2, 0, 0, 0, 1, 0, 1, 1, 0}, {{0, 3, 4}, {4, 3, 2, 4, 1, 0}});
    auto const refiner = CreateRefiner(shape, ReferenceMask::Average, 2, boundary(kEdgeOnly));
    ASSERT_NO_FATAL_FAILURE(ExpectValid(*refiner));
    EXPECT_TRUE(refiner->GetLevel(0).IsVertexNonManifold(4));
    EXPECT_EQ(refiner->GetLevel(0).GetVertexRule(4), Sdc::Crease::RULE_CORNER);
    EXPECT_EQ(InterpolateLevels(*refiner, GetPositions(shape))[2].row(4),
              GetPositions(shape).row(4));
}

} // namespace OpenSubdivHex::Regression::nonManifoldTest

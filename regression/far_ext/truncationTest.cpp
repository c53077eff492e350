// SPDX-License-Identifier: Apache-2.0
//
// FirstStep::Truncate: every shape, tag and channel against the reference, its numbering, and the
// labels that it keeps apart.
#include "expectations.h"

#include "far_ext/baseFaceMap.h"
#include "regression/shapes/featureShapes.h"
#include "regression/shapes/shapeDescriptor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>

namespace OpenSubdivHex::Regression::truncationTest {

using FarExt::FirstStep;
using FarExt::HexSchemeOptions;
using FarExt::TopologyLevel;
using FarExt::TopologyRefiner;

namespace {

constexpr Sdc::Options::FVarLinearInterpolation kLinearInterpolations[] = {
    Sdc::Options::FVAR_LINEAR_NONE,          Sdc::Options::FVAR_LINEAR_CORNERS_ONLY,
    Sdc::Options::FVAR_LINEAR_CORNERS_PLUS1, Sdc::Options::FVAR_LINEAR_CORNERS_PLUS2,
    Sdc::Options::FVAR_LINEAR_BOUNDARIES,    Sdc::Options::FVAR_LINEAR_ALL};

HexSchemeOptions getSchemeOptions() {
    HexSchemeOptions options;
    options.firstStep = FirstStep::Truncate;
    return options;
}

std::unique_ptr<TopologyRefiner> createRefiner(Shape const &shape, ReferenceMask mask, int level,
                                               Sdc::Options options = Sdc::Options()) {
    return CreateRefiner(shape, mask, level, options, getSchemeOptions());
}

/// Calls check(shape, options) for all shapes, boundary rules and, with creases, creasing methods.
template <typename CHECK>
void forEach(CHECK const &check) {
    for (Shape const &shape : GetAllShapes()) {
        for (auto boundary : kBoundaries) {
            for (auto method : {Sdc::Options::CREASE_UNIFORM, Sdc::Options::CREASE_CHAIKIN}) {
                if (shape.creaseSharpness.empty() && method != Sdc::Options::CREASE_UNIFORM) {
                    continue;
                }
                SCOPED_TRACE(testing::Message()
                             << shape.name << ", boundary " << boundary << ", creases " << method);
                Sdc::Options options;
                options.SetVtxBoundaryInterpolation(boundary);
                options.SetCreasingMethod(method);
                check(shape, options);
                if (testing::Test::HasFatalFailure()) {
                    return;
                }
            }
        }
    }
}

/// The numbers that INDEXING.md gives to what a truncation makes of level 0.
class Numbering {
public:
    explicit Numbering(TopologyRefiner const &refiner)
        : _parent(refiner.GetLevel(0)), _child(refiner.GetLevel(1)) {
        for (int v = 0; v < _parent.GetNumVertices(); ++v) {
            if (int const cVert = _parent.GetVertexChildVertex(v); cVert >= 0) {
                EXPECT_EQ(cVert, _numVVertices++);
            }
        }
        int numBoundaries = 0;
        for (int e = 0; e < _parent.GetNumEdges(); ++e) {
            if (_parent.IsEdgeBoundary(e)) {
                _boundaries[e] = numBoundaries++;
            }
            EXPECT_EQ(_parent.GetEdgeChildFace(e), Far::INDEX_INVALID);
        }
        EXPECT_EQ(_child.GetNumVertices(),
                  _numVVertices + _parent.GetNumFaceVertices() + numBoundaries);
    }

    void ExpectFFaces() const {
        for (int f = 0; f < _parent.GetNumFaces(); ++f) {
            auto const vertices = _child.GetFaceVertices(f);
            auto const edges = _child.GetFaceEdges(f);
            int const size = _parent.GetFaceVertices(f).size();
            ASSERT_EQ(_child.GetFaceFirstCorner(f), 2 * _parent.GetFaceFirstCorner(f));
            ASSERT_EQ(vertices.size(), 2 * size);
            ASSERT_EQ(_child.GetFaceKind(f), FarExt::FaceKind::Face);
            for (int i = 0; i < size; ++i) {
                int const corner = _parent.GetFaceFirstCorner(f) + i;
                int const edge = _parent.GetFaceEdges(f)[i];
                ASSERT_EQ(vertices[2 * i + 1], fVertex(corner));
                ASSERT_EQ(vertices[(2 * i + 2) % (2 * size)], otherVertex(f, i));
                ASSERT_EQ(edges[2 * i], corner);
                ASSERT_EQ(edges[2 * i + 1], _parent.GetNumFaceVertices() + edge);
            }
        }
    }

    /// V-faces follow the vertices, and spokes the edges, each with its first end first; then the long edges of half
    /// faces.
    void ExpectVFaces() const {
        int lastVertex = 0;
        std::vector<int> longEdges;
        for (int f = _parent.GetNumFaces(); f < _child.GetNumFaces(); ++f) {
            ASSERT_EQ(_child.GetFaceKind(f), FarExt::FaceKind::Vertex);
            int const vertex = _child.GetFaceParentVertex(f);
            ASSERT_GE(vertex, lastVertex);
            lastVertex = vertex;
            auto const vertices = _child.GetFaceVertices(f);
            int const corner = vertices[vertices.size() - 1] - _numVVertices;
            ASSERT_GE(corner, 0);
            ASSERT_LT(corner, _parent.GetNumFaceVertices());
            int const face = _child.GetFaceParentFace(f);
            int const local = corner - _parent.GetFaceFirstCorner(face);
            ASSERT_EQ(_parent.GetFaceVertices(face)[local], vertex);
            ASSERT_EQ(_child.GetFaceBaseFace(f), face);
            ASSERT_EQ(_child.GetFaceEdges(f)[vertices.size() - 1], corner);
            int const cVert = _parent.GetVertexChildVertex(vertex);
            if (_child.IsFaceHalf(f)) {
                ASSERT_LT(cVert, 0);
                longEdges.push_back(_child.GetFaceEdges(f)[0]);
                ASSERT_TRUE(_child.IsEdgeBoundary(longEdges.back()));
            }
            if (cVert >= 0 && vertices[vertices.size() - 2] != cVert) {
                ADD_FAILURE() << "face " << f << " has its V-vertex elsewhere";
            }
        }
        int spoke = _parent.GetNumFaceVertices() + _parent.GetNumEdges();
        for (int e = 0; e < _parent.GetNumEdges(); ++e) {
            auto const ends = _parent.GetEdgeVertices(e);
            int const face = _parent.GetEdgeFaces(e)[0];
            int const local = _parent.GetEdgeFaceLocalIndices(e)[0];
            int const beside[] = {fVertex(_parent.GetFaceFirstCorner(face) + local),
                                  otherVertex(face, local)};
            for (int i : {0, 1}) {
                int const cVert = _parent.GetVertexChildVertex(ends[i]);
                int const edge = cVert < 0 ? -1 : _child.FindEdge(cVert, beside[i]);
                if (edge >= 0) {
                    ASSERT_EQ(edge, spoke++);
                    ASSERT_EQ(_child.GetEdgeVertices(edge)[0], _child.IsEdgeBoundary(edge)
                                                                   ? _child.GetEdgeVertices(edge)[0]
                                                                   : cVert);
                }
            }
        }
        for (int edge : longEdges) {
            ASSERT_EQ(edge, spoke++);
        }
        ASSERT_EQ(spoke, _child.GetNumEdges());
    }

private:
    int fVertex(int corner) const { return _numVVertices + corner; }
    /// At the far end of the edge from a corner.
    int otherVertex(int face, int local) const {
        int const edge = _parent.GetFaceEdges(face)[local];
        if (_parent.IsEdgeBoundary(edge)) {
            return fVertex(_parent.GetNumFaceVertices() + _boundaries.at(edge));
        }
        auto const faces = _parent.GetEdgeFaces(edge);
        auto const locals = _parent.GetEdgeFaceLocalIndices(edge);
        int const other = faces[0] == face && locals[0] == local ? 1 : 0;
        return fVertex(_parent.GetFaceFirstCorner(faces[other]) + locals[other]);
    }

    TopologyLevel const &_parent;
    TopologyLevel const &_child;
    std::map<int, int> _boundaries;
    int _numVVertices = 0;
};

} // namespace

TEST(Truncation, EqualsReference) {
    forEach([](Shape const &shape, Sdc::Options options) {
        ExpectMeshEqual(shape, GetTestLevel(shape, 3, 6000), options, getSchemeOptions());
    });
}

TEST(Truncation, FaceVaryingEqualsReference) {
    int seed = 0;
    forEach([&seed](Shape const &shape, Sdc::Options options) {
        for (auto linear : kLinearInterpolations) {
            options.SetFVarLinearInterpolation(linear);
            ReferenceMask const mask = kMasks[std::size_t(seed++ % 3)];
            auto const refiner = createRefiner(shape, mask, GetTestLevel(shape, 3, 3000), options);
            for (int channel = 0; channel < int(shape.fvarChannels.size()); ++channel) {
                SCOPED_TRACE(testing::Message() << "channel " << channel << ", linear " << linear);
                TaggedMatch const match(shape, *refiner, channel);
                ASSERT_EQ(match.GetError(), "");
                ReferenceValues const values = GetValues(shape.fvarChannels[std::size_t(channel)]);
                ASSERT_NO_FATAL_FAILURE(
                    ExpectChannelValuesEqual(*refiner, match, mask, values, channel));
            }
        }
    });
}

TEST(Truncation, HasDocumentedNumbering) {
    forEach([](Shape const &shape, Sdc::Options options) {
        auto const refiner = createRefiner(shape, ReferenceMask::Smooth, 1, options);
        Numbering const numbering(*refiner);
        ASSERT_NO_FATAL_FAILURE(numbering.ExpectFFaces());
        ASSERT_NO_FATAL_FAILURE(numbering.ExpectVFaces());
    });
}

namespace {

/// Triangles around vertex 0, of which two spokes are a crease, \p before faces apart; and a second ring of them, so
/// that only the outermost vertices are on a border.
Shape makeCreasedDisc(int before, int behind, float sharpness) {
    Shape shape;
    int const n = before + behind;
    shape.positions = {0, 0, 0};
    for (int ring : {1, 2}) {
        for (int i = 0; i < n; ++i) {
            double const angle = 2 * std::acos(-1.0) * (i + 0.5 * ring) / n;
            shape.positions.insert(shape.positions.end(), {ring * std::cos(angle),
                                                           ring * std::sin(angle), 0.1 * ring * i});
        }
    }
    for (int i = 0; i < n; ++i) {
        int const a = 1 + i;
        int const b = 1 + (i + 1) % n;
        shape.faceSizes.insert(shape.faceSizes.end(), {3, 3, 3});
        shape.faceVertices.insert(shape.faceVertices.end(),
                                  {0, a, b, a, a + n, b, b, a + n, b + n});
    }
    shape.creaseVertexPairs = {0, 1, 0, 1 + before};
    shape.creaseSharpness = {sharpness, sharpness};
    return shape;
}

} // namespace

// Where a crease passes a vertex, its polygon is crossed from one of the edges to the other.
TEST(Truncation, CreasesPassVertices) {
    for (auto [before, behind] : {std::pair(2, 2), {3, 3}, {2, 4}, {5, 3}}) {
        for (float sharpness : {10.0f, 2.5f, 0.5f}) {
            SCOPED_TRACE(testing::Message() << before << " and " << behind << ", " << sharpness);
            Shape const shape = makeCreasedDisc(before, behind, sharpness);
            auto const refiner = createRefiner(shape, ReferenceMask::Smooth, 2);
            TopologyLevel const &base = refiner->GetLevel(0);
            ASSERT_EQ(base.GetVertexChildVertex(0), Far::INDEX_INVALID);
            TopologyLevel const &level = refiner->GetLevel(1);
            int face = 0;
            while (level.GetFaceParentVertex(face) != 0) {
                ++face;
            }
            for (int depth : {1, 2}) { // it keeps its index
                TopologyLevel const &topology = refiner->GetLevel(depth);
                int const end = topology.GetFaceDiagonalEnd(face);
                ASSERT_EQ(topology.GetFaceVertices(face).size(), before + behind);
                ASSERT_TRUE(end == before || end == behind);
                float const left = sharpness == 10 ? 10 : std::max(0.0f, sharpness - float(depth));
                EXPECT_EQ(topology.GetFaceDiagonalSharpness(face), left);
                EXPECT_FALSE(topology.IsFaceHalf(face));
                EXPECT_TRUE(topology.IsFaceBaseSplit(face));
                // Half 1 is behind vertex 0 and lies in the faces that begin there.
                int const faces[] = {topology.GetFaceBaseFace(face, 0),
                                     topology.GetFaceBaseFace(face, 1)};
                bool const isFirst = end == before && (before != behind || faces[1] / 3 < before);
                EXPECT_EQ(faces[0] / 3 < before, !isFirst);
                EXPECT_EQ(faces[1] / 3 < before, isFirst);
            }
            auto const verts = level.GetFaceVertices(face);
            int const end = level.GetFaceDiagonalEnd(face);
            auto const values = InterpolateLevels(*refiner, GetPositions(shape));
            for (int local : {0, end}) {
                EXPECT_EQ(level.GetVertexRule(verts[local]),
                          sharpness == 0.5f ? Sdc::Crease::RULE_SMOOTH : Sdc::Crease::RULE_CREASE);
                if (sharpness < 1) {
                    continue;
                }
                double const distances[] = {
                    (values[1].row(verts[local]) - values[0].row(1) / 3).norm(),
                    (values[1].row(verts[local]) - values[0].row(1 + before) / 3).norm()};
                EXPECT_LT(std::min(distances[0], distances[1]), 1e-15);
            }
        }
    }
}

// One face on a side, another sharp edge, a sharp vertex, a seam alone, or a value that stays: the vertex is kept; and where
// there is something to keep apart for longer than the crease is sharp.
TEST(Truncation, KeepsVerticesOfOtherLines) {
    auto const isKept = [](Shape const &shape) {
        auto const refiner = createRefiner(shape, ReferenceMask::Smooth, 1);
        return refiner->GetLevel(0).GetVertexChildVertex(0) >= 0;
    };
    Shape const passed = makeCreasedDisc(3, 3, 10);
    EXPECT_FALSE(isKept(passed));
    EXPECT_TRUE(isKept(makeCreasedDisc(1, 4, 10)));
    EXPECT_FALSE(isKept(makeCreasedDisc(64, 2, 10)));
    EXPECT_TRUE(isKept(makeCreasedDisc(65, 2, 10)));
    for (auto const &[before, behind] : {std::pair(3, 3), {2, 4}}) {
        for (float const sharpness : {10.0f, 9.0f}) {
            Shape withHoles = makeCreasedDisc(before, behind, sharpness);
            for (int face = 0; face < before; ++face) {
                withHoles.holeFaces.push_back(3 * face);
            }
            EXPECT_EQ(isKept(withHoles), sharpness < 10);
        }
    }
    Shape corner = passed;
    corner.creaseVertexPairs.insert(corner.creaseVertexPairs.end(), {0, 2});
    corner.creaseSharpness.push_back(10);
    EXPECT_TRUE(isKept(corner));
    Shape sharp = passed;
    sharp.cornerVertices = {0};
    sharp.cornerSharpness = {1};
    EXPECT_TRUE(isKept(sharp));
    Shape hole = passed;
    hole.holeFaces = {3};
    EXPECT_TRUE(isKept(hole));
    // A seam along both edges of the crease, or along one of them.
    for (bool isWhole : {true, false}) {
        Shape seam = passed;
        FVarChannel channel;
        channel.valueIndices = seam.faceVertices;
        int numValues = seam.GetNumVertices();
        for (int v : {0, 1, 4}) { // other values on one side of the line
            for (int f = 0; f < seam.GetNumFaces(); ++f) {
                for (int i = 3 * f; i < 3 * f + 3; ++i) {
                    bool const isBefore = f / 3 < 3;
                    bool const isOther = isWhole ? isBefore : isBefore && v == 1;
                    if (seam.faceVertices[std::size_t(i)] == v && isOther) {
                        channel.valueIndices[std::size_t(i)] = numValues;
                    }
                }
            }
            ++numValues;
        }
        channel.values.assign(2 * std::size_t(numValues), 0);
        seam.fvarChannels = {channel};
        EXPECT_EQ(isKept(seam), !isWhole);
    }
}

TEST(Truncation, MakesHexagonsOfTriangles) {
    Shape const icosahedron = MakeIcosahedron();
    auto const refiner = createRefiner(icosahedron, ReferenceMask::Smooth, 3);
    TopologyLevel const &level = refiner->GetLevel(1);
    EXPECT_EQ(level.GetNumVertices(), 60);
    EXPECT_EQ(level.GetNumEdges(), 90);
    EXPECT_EQ(level.GetNumFaces(), 32);
    for (int depth = 1; depth <= 3; ++depth) {
        TopologyLevel const &topology = refiner->GetLevel(depth);
        int numPentagons = 0;
        for (int f = 0; f < topology.GetNumFaces(); ++f) {
            int const size = topology.GetFaceVertices(f).size();
            ASSERT_TRUE(size == 5 || size == 6);
            numPentagons += size == 5;
        }
        EXPECT_EQ(numPentagons, 12);
        for (int v = 0; v < topology.GetNumVertices(); ++v) {
            ASSERT_EQ(topology.GetVertexFaces(v).size(), 3);
        }
    }
}

// A sharp rule reproduces linear functions, along lines and across.
TEST(Truncation, ReproducesLinearFunctions) {
    Shape shape = GetShape("triangleGrid");
    for (std::size_t i = 0; i < shape.positions.size(); i += 3) {
        shape.positions[i + 2] = 1 + 2 * shape.positions[i] - 3 * shape.positions[i + 1];
    }
    for (auto boundary :
         {Sdc::Options::VTX_BOUNDARY_EDGE_ONLY, Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER}) {
        Sdc::Options options;
        options.SetVtxBoundaryInterpolation(boundary);
        auto const refiner = createRefiner(shape, ReferenceMask::Smooth, 3, options);
        for (ReferenceValues const &values : InterpolateLevels(*refiner, GetPositions(shape))) {
            for (Eigen::Index row = 0; row < values.rows(); ++row) {
                ASSERT_NEAR(values(row, 2), 1 + 2 * values(row, 0) - 3 * values(row, 1), 1e-12);
            }
        }
    }
}

TEST(Truncation, KeepsLabelsApart) {
    for (Shape const &shape : GetAllShapes()) {
        SCOPED_TRACE(shape.name);
        auto const refiner = createRefiner(shape, ReferenceMask::Smooth, 0);
        TopologyRefiner::UniformOptions options(GetTestLevel(shape, 3, 6000));
        options.fullTopologyInLastLevel = true;
        for (int f = 0; f < shape.GetNumFaces(); ++f) {
            options.faceLabels.push_back(f * f % 3);
        }
        ASSERT_TRUE(refiner->RefineUniform(options));
        EXPECT_EQ(refiner->GetUniformOptions().faceLabels, options.faceLabels);
        ASSERT_NO_FATAL_FAILURE(ExpectValid(*refiner));
        if (refiner->GetMaxLevel() == 0) {
            continue;
        }
        // All faces around the vertex of a V-face that its own F-vertices lie between have its label.
        TopologyLevel const &base = refiner->GetLevel(0);
        TopologyLevel const &level = refiner->GetLevel(1);
        for (int e = 0; e < level.GetNumEdges(); ++e) {
            auto const faces = level.GetEdgeFaces(e);
            if (e < base.GetNumFaceVertices()) {
                // Between an F-face and the V-face of a vertex of its base face.
                ASSERT_EQ(options.faceLabels[std::size_t(level.GetFaceBaseFace(faces[0]))],
                          options.faceLabels[std::size_t(level.GetFaceBaseFace(faces[1]))]);
            }
        }
        // Where all labels are the same nothing is cut for them.
        int const numFaces = level.GetNumFaces();
        options.faceLabels.assign(options.faceLabels.size(), 7);
        ASSERT_TRUE(refiner->RefineUniform(options));
        int const numUncut = refiner->GetLevel(1).GetNumFaces();
        options.faceLabels.clear();
        ASSERT_TRUE(refiner->RefineUniform(options));
        EXPECT_EQ(refiner->GetLevel(1).GetNumFaces(), numUncut);
        EXPECT_LE(numUncut, numFaces);
    }
}

// Faces of Doo-Sabin and tri-hex lie across base faces of any labels; hexagons have halves.
TEST(Truncation, OtherStepsRefuseLabelsThatDiffer) {
    using FarExt::SchemeType;
    ShapeDescriptor const descriptor(GetShape("cube"));
    for (SchemeType const type :
         {SchemeType::Hexagonal, SchemeType::DooSabin, SchemeType::TriHex}) {
        for (FarExt::FirstStep const firstStep :
             {FarExt::FirstStep::Same, FarExt::FirstStep::TriHex, FarExt::FirstStep::Truncate}) {
            FarExt::TopologyRefinerFactory::Options factoryOptions;
            factoryOptions.hexSchemeOptions.schemeType = type;
            factoryOptions.hexSchemeOptions.firstStep = firstStep;
            auto const refiner = FarExt::TopologyRefinerFactory::Create(
                descriptor.Get(), Sdc::Options(), factoryOptions);
            ASSERT_TRUE(refiner);
            for (int level = 0; level <= 3; ++level) {
                TopologyRefiner::UniformOptions options(level);
                options.faceLabels.assign(6, 3);
                EXPECT_TRUE(refiner->RefineUniform(options));
                options.faceLabels[5] = 4;
                int const firstOther = firstStep == FarExt::FirstStep::TriHex ? 1
                                       : type == SchemeType::Hexagonal        ? 100
                                       : firstStep == FarExt::FirstStep::Same ? 1
                                                                              : 2;
                FarExt::CallStatus status;
                EXPECT_EQ(refiner->RefineUniform(options, &status), level < firstOther);
                EXPECT_EQ(refiner->GetMaxLevel(), level);
                if (level >= firstOther) {
                    EXPECT_EQ(status.GetCode(), FarExt::StatusCode::Unsupported);
                    EXPECT_EQ(status.GetComponentIndex(), firstOther);
                    EXPECT_EQ(status.GetErrorMessage(),
                              std::string("labels of base faces differ, which steps of ") +
                                  (refiner->GetHexSchemeOptions().GetStepOfLevel(firstOther) ==
                                           FarExt::StepType::TriHex
                                       ? "tri-hex"
                                       : "Doo-Sabin") +
                                  " do not keep apart");
                }
            }
        }
    }
}

TEST(Truncation, ChecksTheNumberOfLabels) {
    auto const refiner = createRefiner(GetShape("cube"), ReferenceMask::Smooth, 2);
    TopologyRefiner::UniformOptions options(1);
    options.faceLabels = {1, 2, 3};
    FarExt::CallStatus status;
    EXPECT_FALSE(refiner->RefineUniform(options, &status));
    EXPECT_EQ(status.GetCode(), FarExt::StatusCode::InvalidArgument);
    EXPECT_NE(status.GetErrorMessage().find("3 labels of 6"), std::string::npos)
        << status.GetErrorMessage();
    EXPECT_EQ(refiner->GetMaxLevel(), 2);
}

TEST(Truncation, RefinesAgainAfterOtherSteps) {
    Shape const &shape = GetShape("truncatedCube");
    auto const refiner = createRefiner(shape, ReferenceMask::Smooth, 3);
    ReferenceValues const positions = GetPositions(shape);
    std::vector<ReferenceValues> const first = InterpolateLevels(*refiner, positions);
    ASSERT_TRUE(refiner->RefineUniform(1));
    EXPECT_FALSE(refiner->GetLevel(1).HasFullTopology());
    ASSERT_NO_FATAL_FAILURE(ExpectValid(*refiner));
    EXPECT_EQ(InterpolateLevels(*refiner, positions)[1], first[1]);
    FarExt::CallStatus status;
    EXPECT_FALSE(refiner->RefineUniform(40, &status));
    EXPECT_EQ(status.GetCode(), FarExt::StatusCode::TooLarge);
    EXPECT_EQ(refiner->GetMaxLevel(), 1);
    EXPECT_FALSE(refiner->RefineCoplanar(shape.positions.data(), 1, &status));
    EXPECT_EQ(status.GetCode(), FarExt::StatusCode::Unsupported);
}

} // namespace OpenSubdivHex::Regression::truncationTest

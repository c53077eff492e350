// SPDX-License-Identifier: Apache-2.0
//
// Properties of sharpness that fades, and of wide sectors, whatever the rules are in detail.
#include "properties.h"

#include "regression/reference/largestValue.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <set>

namespace OpenSubdivHex::Regression::sharpnessPropertyTest {

using FarExt::TopologyLevel;
using IndexArray = Far::ConstIndexArray;

TEST(Property, SharpnessTwoIsSharpForTwoLevels) {
    for (char const *name :
         {"creaseLoopClosed", "creaseLoopQuads", "creaseLoopTriangles", "crossingQuads",
          "creaseMeetsBorderTriangles", "junctionQuads", "wideSectors", "cornersQuads"}) {
        for (ReferenceMask mask : kMasks) {
            for (auto method : {Sdc::Options::CREASE_UNIFORM, Sdc::Options::CREASE_CHAIKIN}) {
                SCOPED_TRACE(name);
                Shape infinite = GetFeatureShape(name);
                std::fill(infinite.creaseSharpness.begin(), infinite.creaseSharpness.end(),
                          kInfinite);
                std::fill(infinite.cornerSharpness.begin(), infinite.cornerSharpness.end(),
                          kInfinite);
                Shape two = infinite;
                std::fill(two.creaseSharpness.begin(), two.creaseSharpness.end(), 2.0f);
                std::fill(two.cornerSharpness.begin(), two.cornerSharpness.end(), 2.0f);
                Shape smooth = infinite;
                smooth.creaseVertexPairs.clear();
                smooth.creaseSharpness.clear();
                smooth.cornerVertices.clear();
                smooth.cornerSharpness.clear();
                Sdc::Options options = MakeBoundaryOptions(kEdgeOnly);
                options.SetCreasingMethod(method);
                auto const infiniteLevels = RefinePositions(infinite, mask, 3, options);
                auto const refiner = CreateRefiner(two, mask, 3, options);
                auto const levels = InterpolateLevels(*refiner, GetPositions(two));
                EXPECT_EQ(levels[1], infiniteLevels[1]);
                EXPECT_EQ(levels[2], infiniteLevels[2]);
                EXPECT_GT((levels[3] - infiniteLevels[3]).norm(), 1e-5);
                // From there on it is smooth.
                auto const smoothRefiner = CreateRefiner(smooth, mask, 3, options);
                FarExt::PrimvarRefinerReal<double> const primvarRefiner(*smoothRefiner);
                std::vector<ValueRow<double>> src(levels[2].rows());
                std::vector<ValueRow<double>> dst(levels[3].rows());
                for (Eigen::Index i = 0; i < levels[2].rows(); ++i) {
                    src[i].value = levels[2].row(i).array();
                }
                for (auto &row : dst) {
                    row.value.resize(3);
                }
                primvarRefiner.Interpolate(3, src, dst);
                for (Eigen::Index i = 0; i < levels[3].rows(); ++i) {
                    ASSERT_EQ(levels[3].row(i), dst[i].value.matrix());
                }
                TopologyLevel const &last = refiner->GetLevel(3);
                for (int f = 0; f < last.GetNumFaces(); ++f) {
                    ASSERT_EQ(last.GetFaceDiagonalSharpness(f), 0);
                }
                for (int e = 0; e < last.GetNumEdges(); ++e) {
                    ASSERT_EQ(last.GetEdgeSharpness(e), last.IsEdgeBoundary(e) ? kInfinite : 0);
                }
            }
        }
    }
}

namespace {

/// The vertices around \p start in an order that depends on the topology alone, up to \p numRings
/// rings of faces away: breadth-first, each face from where it was entered, from the first
/// boundary edge on.
std::vector<int> neighborhood(TopologyLevel const &level, int start, int numRings) {
    struct Entry {
        int face;
        int place;
        int ring;
    };
    std::vector<int> vertices;
    std::set<int> seen;
    std::set<int> seenFaces;
    std::deque<Entry> queue{
        {level.GetVertexFaces(start)[0], level.GetVertexFaceLocalIndices(start)[0], 0}};
    std::map<int, int> ringOf{{start, 0}};
    seenFaces.insert(queue.front().face);
    while (!queue.empty()) {
        Entry const entry = queue.front();
        queue.pop_front();
        IndexArray const verts = level.GetFaceVertices(entry.face);
        IndexArray const edges = level.GetFaceEdges(entry.face);
        int nearest = numRings;
        for (int v : verts) {
            if (ringOf.count(v) != 0) {
                nearest = std::min(nearest, ringOf[v]);
            }
        }
        if (nearest >= numRings) {
            continue;
        }
        for (int i = 0; i < verts.size(); ++i) {
            int const v = verts[(entry.place + i) % verts.size()];
            ringOf.try_emplace(v, nearest + 1);
            if (seen.insert(v).second) {
                vertices.push_back(v);
            }
        }
        for (int i = 0; i < verts.size(); ++i) {
            int const edge = edges[(entry.place + i) % verts.size()];
            if (level.IsEdgeBoundary(edge)) {
                continue;
            }
            int const side = level.GetEdgeFaces(edge)[0] == entry.face ? 1 : 0;
            int const face = level.GetEdgeFaces(edge)[side];
            if (seenFaces.insert(face).second) {
                // Around the start first: its faces must be entered in order.
                Entry const next{face, level.GetEdgeFaceLocalIndices(edge)[side], 0};
                if (level.GetFaceVertices(face).FindIndex(start) >= 0) {
                    queue.push_front(next);
                } else {
                    queue.push_back(next);
                }
            }
        }
    }
    return vertices;
}

/// The eigenvalues by size of two steps at a border vertex of \p numFaces triangles, for data that
/// is zero along the border.
std::vector<double> crossEigenvalues(ReferenceMask mask, int numFaces) {
    // A fan within a ring of quads, so that other borders are far.
    Shape shape;
    shape.positions = {0, 0, 0};
    for (int ring = 1; ring <= 2; ++ring) {
        for (int i = 0; i <= numFaces; ++i) {
            double const angle = std::acos(-1.0) * i / numFaces;
            shape.positions.insert(shape.positions.end(),
                                   {ring * std::cos(angle), ring * std::sin(angle), 0});
        }
    }
    for (int i = 0; i < numFaces; ++i) {
        int const outer = numFaces + 2 + i;
        shape.faceSizes.insert(shape.faceSizes.end(), {3, 4});
        shape.faceVertices.insert(shape.faceVertices.end(), {0, 1 + i, 2 + i});
        shape.faceVertices.insert(shape.faceVertices.end(), {1 + i, outer, outer + 1, 2 + i});
    }
    int const first = 3;
    auto const refiner = CreateRefiner(shape, mask, first + 2, MakeBoundaryOptions(kEdgeOnly));
    std::vector<int> const from = neighborhood(refiner->GetLevel(first), 0, 2);
    std::vector<int> const to = neighborhood(refiner->GetLevel(first + 2), 0, 2);
    EXPECT_EQ(from.size(), to.size());
    if (from.size() != to.size()) {
        return {};
    }
    std::vector<int> inner; // places of the vertices inside
    for (std::size_t i = 0; i < from.size(); ++i) {
        bool const isInside = !refiner->GetLevel(first).IsVertexBoundary(from[i]);
        EXPECT_EQ(isInside, !refiner->GetLevel(first + 2).IsVertexBoundary(to[i]));
        if (isInside) {
            inner.push_back(int(i));
        }
    }
    auto const n = Eigen::Index(inner.size());
    FarExt::PrimvarRefinerReal<double> const primvarRefiner(*refiner);
    ValueRow<double> const zero{Eigen::Array<double, 1, Eigen::Dynamic>::Zero(n)};
    std::vector<ValueRow<double>> src(refiner->GetLevel(first).GetNumVertices(), zero);
    for (Eigen::Index i = 0; i < n; ++i) {
        src[from[inner[i]]].value[i] = 1;
    }
    for (int level = first + 1; level <= first + 2; ++level) {
        std::vector<ValueRow<double>> dst(refiner->GetLevel(level).GetNumVertices(), zero);
        primvarRefiner.Interpolate(level, src, dst);
        src = std::move(dst);
    }
    Eigen::MatrixXd matrix(n, n);
    for (Eigen::Index i = 0; i < n; ++i) {
        matrix.row(i) = src[to[inner[i]]].value.matrix();
    }
    std::vector<double> sizes;
    Eigen::VectorXcd const eigenvalues =
        Eigen::EigenSolver<Eigen::MatrixXd>(matrix, false).eigenvalues();
    for (auto const &value : eigenvalues) {
        sizes.push_back(std::sqrt(std::abs(value)));
    }
    std::sort(sizes.rbegin(), sizes.rend());
    return sizes;
}

} // namespace

TEST(Property, WideSectorsConvergeAsTheirBorder) {
    // The claim of ComputeSectorShrink: per step, the first mode across has 1/2, the next less, so that there
    // is a tangent plane.  With a quarter curvature would be bounded; with more it grows by four times that.
    std::map<int, double> const ofNumFaces = {
        {3, 0.418}, {4, 0.452}, {5, 0.469}, {6, 0.478}, {8, 0.487}};
    for (ReferenceMask mask : kMasks) {
        for (int numFaces = 3; numFaces <= 12; ++numFaces) {
            std::vector<double> const sizes = crossEigenvalues(mask, numFaces);
            ASSERT_GE(sizes.size(), 2u);
            EXPECT_NEAR(sizes[0], 0.5, 0.003) << ToString(mask) << " " << numFaces;
            EXPECT_LT(sizes[1], 0.498) << ToString(mask) << " " << numFaces;
            auto const found = ofNumFaces.find(numFaces);
            if (found != ofNumFaces.end()) {
                EXPECT_NEAR(sizes[1], found->second, 0.005) << ToString(mask) << " " << numFaces;
            }
        }
    }
}

namespace {

/// The shape with \p excess above the whole part of all finite sharpness.
Shape withExcess(Shape shape, float excess) {
    for (std::vector<float> *tags : {&shape.creaseSharpness, &shape.cornerSharpness}) {
        for (float &sharpness : *tags) {
            if (sharpness < kInfinite) {
                sharpness = std::floor(sharpness) + excess;
            }
        }
    }
    return shape;
}

} // namespace

TEST(Property, FadingCreasesDoNotPop) {
    // The limit from above is what is there without the rest of sharpness.  Not so with
    // CREASE_CHAIKIN: Sdc::Crease takes the mean of those edges at a vertex that are sharp at all.
    constexpr float kExcess = 1e-4f;
    ForEachFeature([&](Shape const &shape, Sdc::Options options) {
        if (options.GetCreasingMethod() == Sdc::Options::CREASE_CHAIKIN) {
            return;
        }
        auto const before =
            RefinePositions(withExcess(shape, kExcess), ReferenceMask::Smooth, 3, options);
        auto const after = RefinePositions(withExcess(shape, 0), ReferenceMask::Smooth, 3, options);
        for (std::size_t level = 0; level < before.size(); ++level) {
            ASSERT_LE(GetLargestValue(before[level] - after[level]), 5 * kExcess)
                << "level " << level;
        }
    });
}

} // namespace OpenSubdivHex::Regression::sharpnessPropertyTest

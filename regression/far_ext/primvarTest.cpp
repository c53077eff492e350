// SPDX-License-Identifier: Apache-2.0
#include "referenceMatch.h"

#include "far_ext/primvarRefiner.h"
#include "regression/reference/largestValue.h"
#include "regression/shapes/torus.h"

#include <gtest/gtest.h>

#include <numeric>

namespace OpenSubdivHex::Regression::primvarTest {

using FarExt::PrimvarRefinerReal;

namespace {

/// Three numbers with the interface that Far's primvar refiner asks for.
template <typename REAL>
struct Element {
    void Clear() { value[0] = value[1] = value[2] = 0; }
    void AddWithWeight(Element const &other, REAL weight) {
        for (int k = 0; k < 3; ++k) {
            value[k] += weight * other.value[k];
        }
    }
    /// Not zero, so that an element that is never cleared shows.
    REAL value[3] = {REAL(17), REAL(-23), REAL(41)};
};

template <typename REAL>
std::vector<Element<REAL>> toElements(ReferenceValues const &values) {
    std::vector<Element<REAL>> elements(values.rows());
    for (Eigen::Index i = 0; i < values.rows(); ++i) {
        for (int k = 0; k < 3; ++k) {
            elements[i].value[k] = REAL(values(i, k));
        }
    }
    return elements;
}

template <typename REAL>
ReferenceValues toValues(std::vector<Element<REAL>> const &elements) {
    ReferenceValues values(elements.size(), 3);
    for (Eigen::Index i = 0; i < values.rows(); ++i) {
        for (int k = 0; k < 3; ++k) {
            values(i, k) = double(elements[i].value[k]);
        }
    }
    return values;
}

/// Compares every level with the reference; \p tolerance is relative to the size of the values.
template <typename REAL>
void expectEqual(FarExt::TopologyRefiner const &refiner, bool varying,
                 std::vector<ReferenceValues> const &expected, double tolerance) {
    PrimvarRefinerReal<REAL> const primvarRefiner(refiner);
    EXPECT_EQ(&primvarRefiner.GetTopologyRefiner(), &refiner);
    std::vector<Element<REAL>> src = toElements<REAL>(expected[0]);
    for (int level = 1; level < int(expected.size()); ++level) {
        std::vector<Element<REAL>> dst(refiner.GetLevel(level).GetNumVertices());
        if (varying) {
            primvarRefiner.InterpolateVarying(level, src, dst);
        } else {
            primvarRefiner.Interpolate(level, src, dst);
        }
        ASSERT_EQ(Eigen::Index(dst.size()), expected[level].rows());
        ASSERT_LE(GetLargestValue(toValues(dst) - expected[level]),
                  tolerance * GetSize(expected[0]))
            << "level " << level;
        src = std::move(dst);
    }
}

/// Vertex and varying data of every shape, level and mask, in the precision of REAL.
template <typename REAL>
void expectEveryShapeEqual(double tolerance) {
    for (Shape const &shape : GetManifoldShapes()) {
        SCOPED_TRACE(shape.name);
        ReferenceMatch const match(shape, GetTestLevel(shape, 3, 80000));
        ASSERT_EQ(match.GetError(), "");
        ReferenceValues const positions = GetPositions(shape);
        std::vector<ReferenceValues> const varying = match.InterpolateVaryingAll(positions);
        for (ReferenceMask mask : kMasks) {
            SCOPED_TRACE(ToString(mask));
            auto const refiner = CreateRefiner(shape, mask, match.GetMaxLevel());
            ASSERT_NO_FATAL_FAILURE(expectEqual<REAL>(
                *refiner, false, match.InterpolateAll(mask, positions), tolerance));
            ASSERT_NO_FATAL_FAILURE(expectEqual<REAL>(*refiner, true, varying, tolerance));
        }
    }
}

} // namespace

TEST(Primvar, DoubleEqualsReference) { expectEveryShapeEqual<double>(1e-12); }

TEST(Primvar, FloatEqualsReference) { expectEveryShapeEqual<float>(1e-6); }

// More than a million face-vertices, of a torus and of a real mesh where its folder is there.
TEST(Primvar, LargeMeshesEqualReference) {
    std::vector<Shape> shapes = {MakeTorus(48, 61, TorusFaces::IrregularTriangles)};
    for (Shape const &shape : GetManifoldShapes()) {
        if (shape.name == "spot") {
            shapes.push_back(shape);
        }
    }
    for (Shape const &shape : shapes) {
        SCOPED_TRACE(shape.name);
        ReferenceMatch const match(shape, 3);
        ASSERT_EQ(match.GetError(), "");
        auto const refiner = CreateRefiner(shape, ReferenceMask::Average, 3);
        FarExt::TopologyLevel const &level = refiner->GetLevel(3);
        int const numEdges = shape.GetNumFaces() / 2 * 3;
        EXPECT_EQ(level.GetNumVertices(), shape.GetNumVertices() + 2 * numEdges * 21);
        EXPECT_EQ(level.GetNumFaces(), shape.GetNumFaces() + numEdges * 21);
        EXPECT_GT(level.GetNumFaceVertices(), 1000000);
        EXPECT_EQ(level.GetNumBoundaryEdges(), 0);
        expectEqual<double>(*refiner, false,
                            match.InterpolateAll(ReferenceMask::Average, GetPositions(shape)),
                            1e-12);
    }
}

TEST(Primvar, LastLevelNeedsFaceVerticesOnly) {
    Shape const &shape = GetShape("mixedPatch");
    ReferenceMatch const match(shape, 2);
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0);
    ASSERT_TRUE(refiner->RefineUniform(2));
    expectEqual<double>(*refiner, false,
                        match.InterpolateAll(ReferenceMask::Smooth, GetPositions(shape)), 1e-12);
}

TEST(Primvar, FaceUniform) {
    for (Shape const &shape : GetManifoldShapes()) {
        SCOPED_TRACE(shape.name);
        auto const refiner = CreateRefiner(shape, ReferenceMask::Average, GetTestLevel(shape, 3));
        PrimvarRefinerReal<double> const primvarRefiner(*refiner);
        std::vector<int> src(shape.GetNumFaces());
        for (int f = 0; f < shape.GetNumFaces(); ++f) {
            src[f] = f;
        }
        for (int level = 1; level <= refiner->GetMaxLevel(); ++level) {
            FarExt::TopologyLevel const &parent = refiner->GetLevel(level - 1);
            FarExt::TopologyLevel const &child = refiner->GetLevel(level);
            std::vector<int> dst(child.GetNumFaces(), -1);
            primvarRefiner.InterpolateFaceUniform(level, src, dst);
            for (int f = 0; f < parent.GetNumFaces(); ++f) {
                ASSERT_EQ(dst[f], src[f]);
            }
            for (int f = 0; f < child.GetNumFaces(); ++f) {
                ASSERT_EQ(dst[f], child.GetFaceBaseFace(f));
                if (child.IsFaceBaseSplit(f) && child.HasFullTopology()) {
                    auto const faces = child.GetEdgeFaces(child.GetFaceEdges(f)[1]);
                    int const across = faces[faces[0] == f ? 1 : 0];
                    ASSERT_EQ(dst[across], child.GetFaceBaseFace(f, 1));
                }
            }
            // Data that differs from face to face goes to the children of each.
            std::vector<int> faces(parent.GetNumFaces());
            std::iota(faces.begin(), faces.end(), 0);
            primvarRefiner.InterpolateFaceUniform(level, faces, dst);
            for (int f = 0; f < child.GetNumFaces(); ++f) {
                int const pFace = child.GetFaceParentFace(f);
                ASSERT_TRUE(dst[f] == pFace || parent.IsFaceBaseSplit(pFace));
                ASSERT_EQ(parent.GetFaceBaseFace(dst[f]), child.GetFaceBaseFace(f));
            }
            src.resize(dst.size());
            for (int f = 0; f < child.GetNumFaces(); ++f) {
                src[f] = child.GetFaceBaseFace(f);
            }
        }
    }
}

} // namespace OpenSubdivHex::Regression::primvarTest

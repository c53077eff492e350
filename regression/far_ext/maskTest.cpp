// SPDX-License-Identifier: Apache-2.0
#include "far_ext/rules/mask.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace OpenSubdivHex::Regression::maskTest {

using FarExt::FaceMask;
using FarExt::Interpolation;

namespace {

double const kPi = std::acos(-1.0);

std::vector<double> faceMask(FaceMask mask, int n,
                             Interpolation interpolation = Interpolation::Vertex) {
    std::vector<double> weights(n);
    FarExt::ComputeFaceVertexMask(mask, interpolation, n, weights.data());
    return weights;
}

/// Row i holds the weights of the face's vertices in new point i, as the paper prints matrices.
Eigen::MatrixXd faceMatrix(FaceMask mask, int n) {
    std::vector<double> const weights = faceMask(mask, n);
    Eigen::MatrixXd matrix(n, n);
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
            matrix(i, j) = weights[(j - i + n) % n];
        }
    }
    return matrix;
}

void expectWeights(FaceMask mask, std::vector<double> expected, double denominator) {
    for (double &weight : expected) {
        weight /= denominator;
    }
    EXPECT_EQ(faceMask(mask, int(expected.size())), expected);
}

/// Compares the spectrum of the face matrix with \p eigenvalue of frequency 0 ... n-1.
void expectEigenvalues(FaceMask mask, int n, std::function<double(int)> const &eigenvalue) {
    std::vector<double> expected;
    for (int k = 0; k < n; ++k) {
        expected.push_back(eigenvalue(k));
    }
    std::sort(expected.begin(), expected.end());
    Eigen::VectorXd const actual =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(faceMatrix(mask, n)).eigenvalues();
    for (int k = 0; k < n; ++k) {
        EXPECT_NEAR(actual[k], expected[k], 1e-14) << "n = " << n << ", eigenvalue " << k;
    }
}

/// The frequency and its mirror image are the same.
int frequency(int k, int n) { return std::min(k, n - k); }

} // namespace

TEST(Mask, PaperMatrices) {
    expectWeights(FaceMask::Average, {14, 5, 5}, 24);
    expectWeights(FaceMask::Average, {9, 3, 1, 3}, 16);
    expectWeights(FaceMask::Average, {13, 4, 1, 1, 1, 4}, 24);
    Eigen::MatrixXd m4(4, 4);
    m4 << 9, 3, 1, 3, 3, 9, 3, 1, 1, 3, 9, 3, 3, 1, 3, 9;
    EXPECT_EQ(faceMatrix(FaceMask::Average, 4), m4 / 16);
}

TEST(Mask, CosineAndSmooth) {
    expectWeights(FaceMask::Cosine, {4, 1, 1}, 6);
    expectWeights(FaceMask::Cosine, {9, 3, 1, 3}, 16);
    expectWeights(FaceMask::Cosine, {11, 4, 2, 1, 2, 4}, 24);
    expectWeights(FaceMask::Smooth, {4, 1, 1}, 6);
    expectWeights(FaceMask::Smooth, {9, 3, 1, 3}, 16);
    expectWeights(FaceMask::Smooth, {7, 3, 1, 1, 1, 3}, 16);
}

TEST(Mask, FormulasForAllSizes) {
    for (int n = 3; n <= 400; ++n) {
        std::vector<double> const averages = faceMask(FaceMask::Average, n);
        std::vector<double> const cosines = faceMask(FaceMask::Cosine, n);
        std::vector<double> const smooths = faceMask(FaceMask::Smooth, n);
        for (int j = 0; j < n; ++j) {
            double const theta = 2 * kPi * j / n;
            double const average = (j == 0 ? 0.5 : 0.0) + (j == 1 ? 0.125 : 0.0) +
                                   (j == n - 1 ? 0.125 : 0.0) + 0.25 / n;
            double const cosine = (j == 0 ? 0.25 : 0.0) + (3 + 2 * std::cos(theta)) / (4 * n);
            double const smooth =
                n < 5 ? cosine
                      : (j == 0 ? 0.125 : 0.0) +
                            (0.875 + 0.75 * std::cos(theta) + 0.25 * std::cos(2 * theta)) / n;
            ASSERT_NEAR(averages[j], average, 1e-15) << n << " " << j;
            ASSERT_NEAR(cosines[j], cosine, 1e-15) << n << " " << j;
            ASSERT_NEAR(smooths[j], smooth, 1e-15) << n << " " << j;
        }
    }
}

TEST(Mask, NonNegativeSymmetricSumOne) {
    for (FaceMask mask : {FaceMask::Average, FaceMask::Cosine, FaceMask::Smooth}) {
        for (Interpolation interpolation : {Interpolation::Vertex, Interpolation::Varying}) {
            for (int n = 3; n <= 400; ++n) {
                std::vector<double> const weights = faceMask(mask, n, interpolation);
                double sum = 0;
                for (int j = 0; j < n; ++j) {
                    ASSERT_GE(weights[j], 0) << n << " " << j;
                    ASSERT_EQ(weights[j], weights[(n - j) % n]) << n << " " << j;
                    sum += weights[j];
                }
                ASSERT_NEAR(sum, 1, 1e-13) << n;
            }
        }
    }
}

TEST(Mask, AverageEigenvalues) {
    for (int n = 3; n <= 24; ++n) {
        expectEigenvalues(FaceMask::Average, n, [n](int k) {
            return k == 0 ? 1 : 0.5 + 0.25 * std::cos(2 * kPi * k / n);
        });
    }
    // As the paper prints them.
    std::vector<double> const paper = {1, 0.625, 0.375, 0.25, 0.375, 0.625};
    expectEigenvalues(FaceMask::Average, 6, [&](int k) { return paper[k]; });
}

TEST(Mask, CosineEigenvalues) {
    for (int n = 3; n <= 24; ++n) {
        expectEigenvalues(FaceMask::Cosine, n, [n](int k) {
            return k == 0 ? 1 : frequency(k, n) == 1 ? 0.5 : 0.25;
        });
    }
}

TEST(Mask, SmoothEigenvalues) {
    for (int n = 5; n <= 24; ++n) {
        expectEigenvalues(FaceMask::Smooth, n, [n](int k) {
            return k == 0 ? 1 : std::max(0.125, std::pow(0.5, frequency(k, n)));
        });
    }
}

TEST(Mask, Varying) {
    for (int n = 3; n <= 12; ++n) {
        std::vector<double> const weights = faceMask(FaceMask::Smooth, n, Interpolation::Varying);
        for (int j = 0; j < n; ++j) {
            EXPECT_DOUBLE_EQ(weights[j], (j == 0 ? 0.5 : 0.0) + 0.5 / n);
        }
    }
}

TEST(Mask, VertexMask) {
    for (int k = 0; k <= 400; ++k) {
        auto const vertex = FarExt::ComputeVertexVertexMask(Interpolation::Vertex, k);
        EXPECT_EQ(vertex.vertexWeight, 1.0 / (k + 1));
        EXPECT_EQ(vertex.faceWeight, 1.0 / (k + 1));
        auto const varying = FarExt::ComputeVertexVertexMask(Interpolation::Varying, k);
        EXPECT_EQ(varying.vertexWeight, 1);
        EXPECT_EQ(varying.faceWeight, 0);
    }
}

namespace {

void expectSameAround(FarExt::IrregularVertexMask const &mask,
                      FarExt::IrregularVertexMask const &expected) {
    for (int i = 0; i < 6; ++i) {
        EXPECT_EQ(mask.atVertex[i], expected.atVertex[i]);
        EXPECT_EQ(mask.atNeighbor[i], expected.atNeighbor[i]);
    }
    EXPECT_EQ(mask.vertex.vertexWeight, expected.vertex.vertexWeight);
    EXPECT_EQ(mask.vertex.faceWeight, expected.vertex.faceWeight);
}

/// Compares the weights of F-vertices.
double findLargestDifference(FarExt::IrregularVertexMask const &a,
                             FarExt::IrregularVertexMask const &b) {
    double result = 0;
    for (int i = 0; i < 6; ++i) {
        result = std::max({result, std::abs(a.atVertex[i] - b.atVertex[i]),
                           std::abs(a.atNeighbor[i] - b.atNeighbor[i])});
    }
    return result;
}

} // namespace

// Smooth around irregular vertices: averages of what is there, the same at all levels but for the first
// ones.
TEST(Mask, IrregularVertices) {
    for (int numFaces = FarExt::kMinIrregularFaces; numFaces <= 400; ++numFaces) {
        for (int numSteps = 1; numSteps <= 5; ++numSteps) {
            auto const mask = FarExt::ComputeIrregularVertexMask(numFaces, numSteps);
            for (auto const &weights : {mask.atVertex, mask.atNeighbor}) {
                EXPECT_NEAR(std::accumulate(weights, weights + 6, 0.0), 1, 1e-15);
                EXPECT_GE(*std::min_element(weights, weights + 6), -1e-16) << numFaces;
            }
            for (int i = 1; i < 3; ++i) {
                EXPECT_EQ(mask.atVertex[i], mask.atVertex[6 - i]);
            }
            EXPECT_NEAR(mask.vertex.vertexWeight + numFaces * mask.vertex.faceWeight, 1, 1e-15);
            EXPECT_GE(mask.vertex.vertexWeight, 0);
            EXPECT_GE(mask.vertex.faceWeight, 0);
            if (numFaces > 8 || numSteps >= 3) {
                expectSameAround(mask, FarExt::ComputeIrregularVertexMask(numFaces, 6));
            }
        }
    }
}

TEST(Mask, IrregularVerticesBeforeAnyStep) {
    using FarExt::FacesAround;
    for (int const numSteps : {0, -1, -1000}) {
        for (FacesAround const facesAround :
             {FacesAround::Others, FacesAround::Quads, FacesAround::Triangles}) {
            for (int numFaces = 4; numFaces <= 8; ++numFaces) {
                expectSameAround(
                    FarExt::ComputeIrregularVertexMask(numFaces, numSteps, facesAround),
                    FarExt::ComputeIrregularVertexMask(numFaces, 1000));
            }
        }
    }
}

// In the first levels F-vertices have other weights, by what the faces were: with four faces quads or not,
// with more triangles or not.
TEST(Mask, IrregularVerticesByFacesAround) {
    using FarExt::FacesAround;
    for (int numFaces = 4; numFaces <= 8; ++numFaces) {
        FacesAround const own = numFaces == 4 ? FacesAround::Quads : FacesAround::Triangles;
        auto const last = FarExt::ComputeIrregularVertexMask(numFaces, 6);
        for (FacesAround facesAround : {FacesAround::Others, own}) {
            SCOPED_TRACE(::testing::Message() << numFaces << ", " << int(facesAround));
            int const numFirst = facesAround == FacesAround::Quads ? 3 : 2;
            for (int numSteps = 1; numSteps <= 5; ++numSteps) {
                auto const mask =
                    FarExt::ComputeIrregularVertexMask(numFaces, numSteps, facesAround);
                if (numSteps > numFirst) {
                    expectSameAround(mask, last);
                    continue;
                }
                for (auto const &weights : {mask.atVertex, mask.atNeighbor}) {
                    EXPECT_EQ(std::accumulate(weights, weights + 6, 0.0), 1);
                    EXPECT_GE(*std::min_element(weights, weights + 6), 0);
                }
                EXPECT_EQ(mask.atVertex[1], mask.atVertex[5]);
                EXPECT_EQ(mask.atVertex[2], mask.atVertex[4]);
                EXPECT_GT(findLargestDifference(mask, last), 0.01);
                EXPECT_EQ(mask.vertex.faceWeight, last.vertex.faceWeight);
                EXPECT_EQ(mask.vertex.vertexWeight, last.vertex.vertexWeight);
                if (facesAround == own) {
                    auto const others = FarExt::ComputeIrregularVertexMask(numFaces, numSteps);
                    EXPECT_GT(findLargestDifference(mask, others), 0.01);
                }
            }
        }
    }
}

// To the digits of the derivation: a, c1, a2 at the vertex, the weight of the faces in V'.
TEST(Mask, IrregularVerticesByFaces) {
    struct Row {
        int numFaces;
        double self, side, next, faces;
    };
    for (Row const &row :
         {Row{4, .299888, .301130, .048926, .601633}, Row{5, .328654, .317734, .017939, .556553},
          Row{6, 1 / 3.0, 1 / 3.0, 0, 0.5}, Row{7, .231914, .384043, 0, .376510},
          Row{8, .23, .385, 0, 1 - .77 * (2 + std::sqrt(2.0)) / 4}}) {
        auto const mask = FarExt::ComputeIrregularVertexMask(row.numFaces, 3);
        EXPECT_NEAR(mask.atVertex[0], row.self, 6e-7) << row.numFaces;
        EXPECT_NEAR(mask.atVertex[1], row.side, 6e-7);
        EXPECT_NEAR(mask.atVertex[2], row.next, 6e-7);
        EXPECT_EQ(mask.atVertex[3], 0);
        EXPECT_NEAR(mask.vertex.faceWeight * row.numFaces, row.faces, 6e-7);
        double const four[] = {14, 9, 0, 0, 5, 4};
        double const more[] = {15, 8, 0, 0, 5, 4};
        for (int i = 0; i < 6; ++i) {
            EXPECT_EQ(32 * mask.atNeighbor[i], row.numFaces == 4 ? four[i] : more[i]);
        }
    }
}

// In quads and beside them, averages of what is there; before the first steps and behind them the masks
// of all faces.
TEST(Mask, Quads) {
    std::vector<double> const plain = faceMask(FaceMask::Smooth, 4);
    int const numRows[] = {0, 1, 2, 1, 0, 0};
    for (int numSteps = 0; numSteps <= FarExt::kNumStepsToConstantMasks + 1; ++numSteps) {
        SCOPED_TRACE(numSteps);
        FarExt::QuadMask const mask = FarExt::ComputeQuadMask(numSteps);
        EXPECT_EQ(mask.numRows, numRows[numSteps]);
        EXPECT_EQ(std::accumulate(mask.inQuad, mask.inQuad + 4, 0.0), 1);
        EXPECT_GE(*std::min_element(mask.inQuad, mask.inQuad + 4), 0);
        EXPECT_EQ(mask.inQuad[1], mask.inQuad[3]);
        bool const isPlain = numSteps == 0 || numSteps >= FarExt::kNumStepsToConstantMasks;
        EXPECT_EQ(std::equal(plain.begin(), plain.end(), mask.inQuad), isPlain);
        for (int i = 0; i < mask.numRows; ++i) {
            double const *const row = mask.beside[i];
            EXPECT_EQ(std::accumulate(row, row + 6, 0.0), 1);
            EXPECT_GE(*std::min_element(row, row + 6), 0);
        }
    }
}

TEST(Mask, HalfFaceByHand) {
    // Cosine, n = 6, (11 4 2 1 2 4)/24 on the hexagon V, Q* = (3V + W)/2 - P, P* = (V + 3W)/2 - Q,
    // W, Q, P.  For Q: 11 Q + 4 (W + P) + 2 (V + P*) + Q*
    //   = V (2 + 1 + 3/2) + W (4 + 3 + 1/2) + Q (11 - 2) + P (4 - 1).
    double weights[4][4];
    FarExt::ComputeHalfFaceVertexMask(FaceMask::Cosine, Interpolation::Vertex, 4, &weights[0][0]);
    double const expected[4][4] = {
        {18, 6, 0, 0}, {6, 18, 0, 0}, {4.5, 7.5, 9, 3}, {7.5, 4.5, 3, 9}};
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) {
            EXPECT_DOUBLE_EQ(weights[i][j], expected[i][j] / 24) << i << " " << j;
        }
    }
}

TEST(Mask, HalfFacesReproduceLinearFunctions) {
    for (int n = 3; n <= 65; ++n) {
        SCOPED_TRACE(n);
        // Half of a regular polygon around the origin: V = (1, 0), W = (-1, 0), the others below.
        std::vector<double> x, y;
        for (int i = 0; i < n; ++i) {
            double const angle = i == 0 ? 0 : kPi * (1 + double(i - 1) / (n - 1));
            x.push_back(std::cos(angle));
            y.push_back(std::sin(angle));
        }
        for (FaceMask mask : {FaceMask::Average, FaceMask::Cosine, FaceMask::Smooth}) {
            for (Interpolation interpolation : {Interpolation::Vertex, Interpolation::Varying}) {
                auto const size = std::size_t(n);
                std::vector<double> weights(size * size);
                FarExt::ComputeHalfFaceVertexMask(mask, interpolation, n, weights.data());
                std::vector<double> const whole = faceMask(mask, 2 * (n - 1), interpolation);
                double scale = 0; // of the polygon's mask about its centre, which Smooth has at 1/2
                for (std::size_t j = 0; j < whole.size(); ++j) {
                    scale += whole[j] * std::cos(2 * kPi * double(j) / double(whole.size()));
                }
                for (std::size_t i = 0; i < size; ++i) {
                    double sum = 0, sumX = 0, sumY = 0;
                    for (std::size_t j = 0; j < size; ++j) {
                        double const weight = weights[i * size + j];
                        EXPECT_GE(weight, 0);
                        sum += weight;
                        sumX += weight * x[j];
                        sumY += weight * y[j];
                    }
                    EXPECT_NEAR(sum, 1, 1e-14);
                    EXPECT_NEAR(sumX, (i < 2 ? 0.5 : scale) * x[i], 1e-14);
                    EXPECT_NEAR(sumY, scale * y[i], 1e-14);
                }
            }
        }
    }
}

// Smooth's: along the side 1, 1/2, and across it 1/2, 1/4, then 1/8 or 1/6 for all that is left.
TEST(Mask, HalfFacesBoundCurvature) {
    for (int n : {3, 4, 5, 6, 9, 17, 33, 65}) {
        SCOPED_TRACE(n);
        Eigen::MatrixXd matrix(n, n);
        std::vector<double> weights(std::size_t(n) * std::size_t(n));
        FarExt::ComputeHalfFaceVertexMask(FaceMask::Smooth, Interpolation::Vertex, n,
                                          weights.data());
        for (int i = 0; i < n; ++i) {
            for (int j = 0; j < n; ++j) {
                matrix(i, j) = weights[std::size_t(i * n + j)];
            }
        }
        std::vector<double> moduli;
        for (std::complex<double> value : matrix.eigenvalues()) {
            moduli.push_back(std::abs(value));
        }
        std::sort(moduli.rbegin(), moduli.rend());
        std::vector<double> expected{1, 0.5, 0.5, 0.25};
        expected.resize(std::size_t(n), n < 7 ? 1 / 8.0 : 1 / 6.0);
        for (std::size_t i = 0; i < std::size_t(n); ++i) {
            EXPECT_NEAR(moduli[i], expected[i], 1e-7) << i;
        }
    }
}

TEST(Mask, SectorShrink) {
    for (int k = 3; k <= 40; ++k) {
        double const c = std::cos(kPi / k);
        EXPECT_NEAR(FarExt::ComputeSectorShrink(FaceMask::Average, k), 1 / (0.98 + 0.305 * c),
                    1e-15);
        for (FaceMask mask : {FaceMask::Cosine, FaceMask::Smooth}) {
            EXPECT_NEAR(FarExt::ComputeSectorShrink(mask, k), 1 / (1.31 + 0.515 * c), 1e-15);
        }
    }
}

TEST(Mask, Truncation) {
    for (int k = 2; k <= 64; ++k) {
        SCOPED_TRACE(k);
        FarExt::TruncateMask const mask = FarExt::ComputeTruncateMask(k);
        EXPECT_NEAR(mask.vertexWeight + 2 * mask.besideWeight + mask.aroundWeight, 1, 1e-15);
        EXPECT_GE(mask.vertexWeight, 0);
        EXPECT_GT(mask.besideWeight, 0);
        EXPECT_EQ(mask.aroundWeight > 0, k >= 3 && k <= FarExt::kMaxTruncatedAround);
    }
}

// New points of regular triangles all have the same second moments, 2/9 in each direction.
TEST(Mask, TruncatedTrianglesKeepQuadratics) {
    FarExt::TruncateMask const mask = FarExt::ComputeTruncateMask(6);
    double sum[2] = {0, 0};
    double square[3] = {0, 0, 0};
    for (int i = 0; i < 6; ++i) {
        // The edge in question goes to (1, 0), between faces 0 and 5.
        double const angle = (2 * i + 1) * kPi / 6;
        double const weight = mask.aroundWeight / 6 + (i % 5 == 0 ? mask.besideWeight : 0);
        for (double const to : {angle - kPi / 6, angle + kPi / 6}) {
            double const x = std::cos(to);
            double const y = std::sin(to);
            sum[0] += weight / 3 * x;
            sum[1] += weight / 3 * y;
            square[0] += weight / 3 * x * x;
            square[1] += weight / 3 * x * y;
            square[2] += weight / 3 * y * y;
        }
    }
    EXPECT_NEAR(sum[0], 1 / 3.0, 1e-15);
    EXPECT_NEAR(sum[1], 0, 1e-15);
    EXPECT_NEAR(square[0] - 1 / 9.0, 2 / 9.0, 1e-15);
    EXPECT_NEAR(square[1], 0, 1e-15);
    EXPECT_NEAR(square[2], 2 / 9.0, 1e-15);
}

} // namespace OpenSubdivHex::Regression::maskTest

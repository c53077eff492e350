// SPDX-License-Identifier: Apache-2.0
//
// The eigenvalues, limit masks and characteristic maps of the schemes against the numbers that they
// are known or derived to have.
#include "spectrum.h"

#include "regression/reference/largestValue.h"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace OpenSubdivHex::Regression::spectrumTest {

namespace {

using FarExt::FaceMask;
using FarExt::FirstStep;
using FarExt::HexSchemeOptions;
using FarExt::SchemeType;

constexpr FaceMask kMasks[] = {FaceMask::Average, FaceMask::Cosine, FaceMask::Smooth};
constexpr int kMinOrder = 3;
constexpr int kMaxOrder = 12;
double const kPi = std::acos(-1.0);

HexSchemeOptions hexagonal(FaceMask mask) { return {mask, SchemeType::Hexagonal, FirstStep::Same}; }
HexSchemeOptions triHexFirst(FaceMask mask) {
    return {mask, SchemeType::Hexagonal, FirstStep::TriHex};
}
HexSchemeOptions dooSabin(FaceMask mask) { return {mask, SchemeType::DooSabin, FirstStep::Same}; }
HexSchemeOptions triHex() { return {FaceMask::Average, SchemeType::TriHex, FirstStep::Same}; }

std::vector<HexSchemeOptions> allSchemes() {
    std::vector<HexSchemeOptions> schemes{triHex()};
    for (FaceMask mask : kMasks) {
        schemes.insert(schemes.end(), {hexagonal(mask), triHexFirst(mask), dooSabin(mask)});
    }
    return schemes;
}

std::string describe(HexSchemeOptions const &scheme, CenterKind kind, int order) {
    return "scheme " + std::to_string(int(scheme.schemeType)) + ", mask " +
           std::to_string(int(scheme.faceMask)) +
           (scheme.firstStep == FirstStep::TriHex ? ", tri-hex first" : "") +
           (kind == CenterKind::Vertex ? ", vertex " : ", face ") + std::to_string(order);
}

/// Calls \p check for every scheme, mask and center.
template <class CHECK>
void forAll(CHECK const &check) {
    for (HexSchemeOptions const &scheme : allSchemes()) {
        for (CenterKind kind : {CenterKind::Vertex, CenterKind::Face}) {
            for (int order = kMinOrder; order <= kMaxOrder; ++order) {
                SCOPED_TRACE(describe(scheme, kind, order));
                check(MakeLocalSubdivision(scheme, kind, order), order);
            }
        }
    }
}

double computeSubdominant(HexSchemeOptions const &scheme, CenterKind kind, int order) {
    return ComputeSpectrum(MakeLocalSubdivision(scheme, kind, order)).subdominant;
}

/// The eigenvalues of the first n x n block, descending.
std::vector<double> computeFaceEigenvalues(LocalSubdivision const &face) {
    Eigen::MatrixXd const block = face.matrix.topLeftCorner(face.order, face.order);
    Eigen::VectorXcd const values = Eigen::EigenSolver<Eigen::MatrixXd>(block).eigenvalues();
    std::vector<double> real;
    for (std::complex<double> value : values) {
        EXPECT_NEAR(value.imag(), 0, 1e-12);
        real.push_back(value.real());
    }
    std::sort(real.rbegin(), real.rend());
    return real;
}

void expectNear(std::vector<double> const &values, std::vector<double> const &expected) {
    ASSERT_EQ(values.size(), expected.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        EXPECT_NEAR(values[i], expected[i], 1e-12) << i;
    }
}

/// The eigenvalues are 1/2, 1/2 and the next 1/4, which has as many eigenvectors as its multiplicity,
/// one for each frequency.
void expectBoundedCurvature(LocalSubdivision const &center) {
    SCOPED_TRACE(center.order);
    Spectrum const spectrum = ComputeSpectrum(center);
    EXPECT_NEAR(spectrum.subdominant, 0.5, 1e-10);
    EXPECT_NEAR(spectrum.next, 0.25, 1e-10);
    EXPECT_NEAR(spectrum.GetCurvatureGrowth(), 1, 1e-9);
    std::vector<int> counts(std::size_t(center.order), 0);
    for (Eigenvalue const &eigenvalue : ComputeEigenvalues(center)) {
        if (std::abs(std::abs(eigenvalue.value) - 0.25) < 1e-6) {
            EXPECT_EQ(++counts[eigenvalue.frequency], 1);
        }
    }
}

} // namespace

TEST(Spectrum, MatricesAreAffineAndSymmetric) {
    forAll([](LocalSubdivision const &subdivision, int) {
        Eigen::MatrixXd const &matrix = subdivision.matrix;
        Eigen::VectorXd const ones = Eigen::VectorXd::Ones(matrix.cols());
        EXPECT_LT(GetLargestValue(matrix * ones - ones), 1e-12);
        EXPECT_GE(matrix.minCoeff(), 0);
        std::vector<int> const &rotation = subdivision.rotation;
        double largest = 0;
        for (int i = 0; i < matrix.rows(); ++i) {
            for (int j = 0; j < matrix.cols(); ++j) {
                largest =
                    std::max(largest, std::abs(matrix(rotation[i], rotation[j]) - matrix(i, j)));
            }
        }
        EXPECT_LT(largest, 1e-12);
        EXPECT_EQ(subdivision.faces[0][0], 0);
    });
}

TEST(Spectrum, CentersBecomeWhatTheSchemesMakeOfThem) {
    forAll([](LocalSubdivision const &subdivision, int order) {
        int const size = int(subdivision.faces[0].size());
        if (subdivision.centerKind == CenterKind::Face) {
            EXPECT_EQ(size, subdivision.order);
            EXPECT_TRUE(subdivision.order == order || subdivision.order == 2 * order);
        } else {
            EXPECT_EQ(subdivision.order, order);
            EXPECT_EQ(size, 6);
        }
    });
    int const order = 5;
    auto const make = [&](HexSchemeOptions const &scheme) {
        return MakeLocalSubdivision(scheme, CenterKind::Vertex, order);
    };
    EXPECT_EQ(make(hexagonal(FaceMask::Smooth)).centerKind, CenterKind::Vertex);
    EXPECT_EQ(make(dooSabin(FaceMask::Smooth)).order, order);
    EXPECT_EQ(make(triHex()).order, 2 * order);
    EXPECT_EQ(make(triHexFirst(FaceMask::Smooth)).order, 2 * order);
}

// Section 6.1 of the paper prints the matrices of a quad and of a hexagon and their eigenvalues.
TEST(Spectrum, PaperMatrices) {
    LocalSubdivision const quad =
        MakeLocalSubdivision(hexagonal(FaceMask::Average), CenterKind::Face, 4);
    Eigen::RowVector4d quadRow;
    quadRow << 9, 3, 1, 3;
    EXPECT_LT((16 * quad.matrix.block(0, 0, 1, 4) - quadRow).norm(), 1e-12);
    expectNear(computeFaceEigenvalues(quad), {1, 0.5, 0.5, 0.25});

    LocalSubdivision const hexagon =
        MakeLocalSubdivision(hexagonal(FaceMask::Average), CenterKind::Face, 6);
    Eigen::Matrix<double, 1, 6> hexagonRow;
    hexagonRow << 13, 4, 1, 1, 1, 4;
    EXPECT_LT((24 * hexagon.matrix.block(0, 0, 1, 6) - hexagonRow).norm(), 1e-12);
    expectNear(computeFaceEigenvalues(hexagon), {1, 0.625, 0.625, 0.375, 0.375, 0.25});
}

TEST(Spectrum, FaceEigenvaluesFollowTheMasks) {
    for (int n = kMinOrder; n <= kMaxOrder; ++n) {
        SCOPED_TRACE(n);
        std::vector<double> average{1}, cosine{1, 0.5, 0.5}, smooth{1, 0.5, 0.5};
        for (int m = 1; m < n; ++m) {
            average.push_back(0.5 + 0.25 * std::cos(2 * kPi * m / n));
        }
        std::sort(average.rbegin(), average.rend());
        cosine.resize(std::size_t(n), 0.25);
        smooth.resize(std::size_t(n), n < 5 ? 0.25 : 0.125);
        if (n >= 5) {
            smooth[3] = smooth[4] = 0.25;
        }
        std::vector<double> const expected[] = {average, cosine, smooth};
        for (FaceMask mask : kMasks) {
            for (HexSchemeOptions const &scheme : {hexagonal(mask), dooSabin(mask)}) {
                LocalSubdivision const face = MakeLocalSubdivision(scheme, CenterKind::Face, n);
                EXPECT_EQ(face.matrix.topRightCorner(n, face.GetNumVertices() - n).norm(), 0);
                expectNear(computeFaceEigenvalues(face), expected[int(mask)]);
            }
        }
        // A vertex of tri-hex is P = (A + B + centroid)/3, turned by half a side.
        EXPECT_NEAR(computeSubdominant(triHex(), CenterKind::Face, n), 2.0 / 3 * std::cos(kPi / n),
                    1e-12);
    }
}

TEST(Spectrum, SubdominantEigenvalues) {
    struct Row {
        int order;
        double values[3]; // Average, Cosine, Smooth
    };
    for (Row const &row : {Row{3, {0.4405, 0.5, 0.5}}, Row{4, {0.493, 0.562, 4.0 / 7}},
                           Row{6, {0.535, 0.613, 1 / std::sqrt(3.0)}}}) {
        for (FaceMask mask : kMasks) {
            double const tolerance = row.order == 3 ? 5e-5 : 6e-4;
            EXPECT_NEAR(computeSubdominant(hexagonal(mask), CenterKind::Vertex, row.order),
                        row.values[int(mask)], tolerance)
                << row.order;
        }
    }
    for (Row const &row :
         {Row{3, {0.375, 0.5, 0.5}}, Row{4, {0.5, 0.5, 0.5}}, Row{5, {0.577, 0.5, 0.5}},
          Row{6, {0.625, 0.5, 0.5}}, Row{8, {0.677, 0.5, 0.5}}}) {
        for (FaceMask mask : kMasks) {
            EXPECT_NEAR(computeSubdominant(hexagonal(mask), CenterKind::Face, row.order),
                        row.values[int(mask)], 5e-4)
                << row.order;
        }
    }
}

TEST(Spectrum, LimitMasksOfVertices) {
    // Weights of the vertex, each neighbour, each vertex next to these, each opposite in a face.
    struct Row {
        int order;
        double values[3][4];
    };
    Row const rows[] = {{3,
                         {{.55607, .10689, .01446, .01180},
                          {.45756, .11353, .02596, .01460},
                          {.44736, .12069, .02228, .01811}}},
                        {4,
                         {{.54009, .08305, .01123, .00917},
                          {.44159, .08765, .02004, .01127},
                          {.391345, .126877, .012643, 0}}}};
    for (Row const &row : rows) {
        for (FaceMask mask : kMasks) {
            LocalSubdivision const vertex =
                MakeLocalSubdivision(hexagonal(mask), CenterKind::Vertex, row.order);
            Eigen::VectorXd const weights = ComputeLimitMask(vertex);
            EXPECT_NEAR(weights.sum(), 1, 1e-12);
            EXPECT_LT((vertex.matrix.transpose() * weights - weights).norm(), 1e-12);

            double const *const expected = row.values[int(mask)];
            std::vector<bool> isPrinted(weights.size(), false);
            for (int i = 0; i < row.order; ++i) {
                int const places[6] = {0, 1, 2, 3, 2, 1}; // in a hexagon that begins at the vertex
                for (int j = 0; j < 6; ++j) {
                    int const local = vertex.faces[i][j];
                    EXPECT_NEAR(weights(local), expected[places[j]], 5.1e-6) << row.order;
                    isPrinted[local] = true;
                }
            }
            for (int i = 0; i < weights.size(); ++i) {
                EXPECT_TRUE(isPrinted[i] || (weights(i) > -1e-15 && weights(i) < 4e-4))
                    << weights(i);
            }
        }
    }
}

TEST(Spectrum, LimitOfAFaceIsItsCentroid) {
    for (HexSchemeOptions const &scheme : allSchemes()) {
        for (int n = kMinOrder; n <= kMaxOrder; ++n) {
            LocalSubdivision const face = MakeLocalSubdivision(scheme, CenterKind::Face, n);
            Eigen::VectorXd centroid = Eigen::VectorXd::Zero(face.GetNumVertices());
            centroid.head(n).setConstant(1.0 / n);
            EXPECT_LT((ComputeLimitMask(face) - centroid).norm(), 1e-10)
                << describe(scheme, CenterKind::Face, n);
        }
    }
}

// All schemes have a tangent plane everywhere, but for tri-hex at triangles.
TEST(Spectrum, TangentPlanes) {
    forAll([](LocalSubdivision const &subdivision, int order) {
        Spectrum const spectrum = ComputeSpectrum(subdivision);
        EXPECT_NEAR(spectrum.dominant, 1, 1e-12);
        bool const isTriangle =
            subdivision.centerKind == CenterKind::Face && order == 3 && subdivision.order == 3;
        if (isTriangle && std::abs(spectrum.subdominant - 1.0 / 3) < 1e-9) {
            EXPECT_FALSE(spectrum.HasTangentPlane()); // both 1/3
        } else {
            EXPECT_TRUE(spectrum.HasTangentPlane()) << spectrum.subdominant << " " << spectrum.next;
        }

        Eigen::VectorXcd const map = ComputeCharacteristicMap(subdivision);
        EXPECT_TRUE(IsRegular(subdivision, map));
        std::complex<double> const factor =
            std::polar(spectrum.subdominant, 2 * kPi * subdivision.turn / subdivision.order);
        EXPECT_LT((subdivision.matrix * map - factor * map).norm(), 1e-9 * map.norm());
    });
    EXPECT_FALSE(
        ComputeSpectrum(MakeLocalSubdivision(triHex(), CenterKind::Face, 3)).HasTangentPlane());
}

TEST(Spectrum, FoldedMapsAreNotRegular) {
    LocalSubdivision const face =
        MakeLocalSubdivision(hexagonal(FaceMask::Smooth), CenterKind::Face, 5);
    Eigen::VectorXcd const map = ComputeCharacteristicMap(face);
    EXPECT_FALSE(IsRegular(face, map.conjugate()));
    Eigen::VectorXcd folded = map;
    std::swap(folded(0), folded(1));
    EXPECT_FALSE(IsRegular(face, folded));

    // Twice around the center.
    LocalSubdivision const vertex =
        MakeLocalSubdivision(hexagonal(FaceMask::Smooth), CenterKind::Vertex, 12);
    Eigen::VectorXcd const once = ComputeCharacteristicMap(vertex);
    EXPECT_FALSE(IsRegular(vertex, once.cwiseProduct(once)));
}

// After a tri-hex step all vertices have three faces; Cosine and Smooth then have bounded curvature
// everywhere, at vertices and at all faces.
TEST(Spectrum, TriHexFirstBoundsCurvature) {
    for (FaceMask mask : {FaceMask::Cosine, FaceMask::Smooth}) {
        std::vector<LocalSubdivision> centers{
            MakeLocalSubdivision(hexagonal(mask), CenterKind::Vertex, 3)};
        for (int order = kMinOrder; order <= kMaxOrder; ++order) {
            for (CenterKind kind : {CenterKind::Vertex, CenterKind::Face}) {
                centers.push_back(MakeLocalSubdivision(triHexFirst(mask), kind, order));
                EXPECT_EQ(centers.back().centerKind, CenterKind::Face);
            }
        }
        for (LocalSubdivision const &center : centers) {
            expectBoundedCurvature(center);
        }
    }
}

// So after a truncation, where a vertex becomes a face with as many sides.
TEST(Spectrum, TruncateFirstBoundsCurvature) {
    HexSchemeOptions const scheme{FaceMask::Smooth, SchemeType::Hexagonal, FirstStep::Truncate};
    for (int order : {3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 16, 32, 64}) {
        LocalSubdivision const center = MakeLocalSubdivision(scheme, CenterKind::Vertex, order);
        EXPECT_EQ(center.centerKind, CenterKind::Face);
        EXPECT_EQ(center.order, order);
        expectBoundedCurvature(center);
    }
    for (int order = kMinOrder; order <= kMaxOrder; ++order) {
        LocalSubdivision const center = MakeLocalSubdivision(scheme, CenterKind::Face, order);
        EXPECT_EQ(center.order, 2 * order);
        expectBoundedCurvature(center);
    }
}

// Smooth's masks around irregular vertices: eigenvalues by frequency, and the limits that they give.
TEST(Spectrum, IrregularVerticesOfSmooth) {
    struct Row {
        int order;
        std::vector<double> eigenvalues[3]; // of frequencies 0, 1 and 2, some of them
        double limit[3];                    // the vertex, each neighbour, each next to these
        double p, f;                        // of the tangents
    };
    Row const rows[] = {
        {4,
         {{.326531, .135770}, {.571429, .137046, -.282612}, {.326531, -.326531, 0}},
         {.391345, .126877, .012643},
         .157311,
         .140040},
        {5,
         {{.326531, .185297}, {.571429, .192956, -.250281}, {.326531, .126013, -.256173}},
         {.457419, .101238, .003639},
         .053506,
         .126464},
        {6, {{.333333, .25}, {.577350, .25, -.25}, {.333333, .25, -.25}}, {.5, 1 / 12.0, 0}, 0, 0},
        {7,
         {{.478894, .25}, {.692021, .25, -.25}, {.478894, .25, -.25}},
         {.445042, .079280, 0},
         0,
         0}};
    constexpr double kDigits = 6e-7;
    for (Row const &row : rows) {
        SCOPED_TRACE(row.order);
        LocalSubdivision const vertex =
            MakeLocalSubdivision(hexagonal(FaceMask::Smooth), CenterKind::Vertex, row.order);
        Spectrum const spectrum = ComputeSpectrum(vertex);
        EXPECT_NEAR(spectrum.subdominant, row.eigenvalues[1][0], kDigits);
        EXPECT_NEAR(spectrum.next, spectrum.subdominant * spectrum.subdominant, 1e-12);
        std::vector<Eigenvalue> const eigenvalues = ComputeEigenvalues(vertex);
        for (int frequency = 0; frequency < 3; ++frequency) {
            for (double expected : row.eigenvalues[frequency]) {
                EXPECT_TRUE(std::any_of(eigenvalues.begin(), eigenvalues.end(),
                                        [&](Eigenvalue const &eigenvalue) {
                                            return eigenvalue.frequency == frequency &&
                                                   std::abs(eigenvalue.value - expected) < kDigits;
                                        }))
                    << expected << ", frequency " << frequency;
            }
        }
        // By place in a hexagon that begins at the vertex; the tangents as complex numbers.
        Eigen::VectorXd limit = Eigen::VectorXd::Zero(vertex.GetNumVertices());
        Eigen::VectorXcd tangent = Eigen::VectorXcd::Zero(vertex.GetNumVertices());
        double const angle = 2 * kPi / row.order;
        for (int i = 0; i < row.order; ++i) {
            std::vector<int> const &face = vertex.faces[i];
            limit(face[0]) = row.limit[0];
            limit(face[1]) = row.limit[1];
            limit(face[2]) = limit(face[4]) = row.limit[2];
            tangent(face[1]) = std::polar(1.0, angle * i);
            tangent(face[2]) = std::polar(row.p, angle * (i + 0.25) + row.f);
            tangent(face[4]) = std::polar(row.p, angle * (i + 0.75) - row.f);
        }
        EXPECT_LT(GetLargestValue(ComputeLimitMask(vertex) - limit), kDigits);
        std::complex<double> const factor = std::polar(spectrum.subdominant, -angle * vertex.turn);
        EXPECT_LT(GetLargestValue(vertex.matrix.transpose() * tangent - factor * tangent),
                  2 * kDigits);
    }
}

// Without it curvature is unbounded at vertices with more than three faces, with Smooth with more
// than seven, and with Average also at the regular ones.
TEST(Spectrum, CurvatureGrowsAtVertices) {
    for (FaceMask mask : {FaceMask::Average, FaceMask::Cosine}) {
        double last = 1;
        for (int order = kMinOrder; order <= kMaxOrder; ++order) {
            Spectrum const spectrum =
                ComputeSpectrum(MakeLocalSubdivision(hexagonal(mask), CenterKind::Vertex, order));
            if (mask != FaceMask::Average && order == 3) {
                EXPECT_NEAR(spectrum.GetCurvatureGrowth(), 1, 1e-9);
            } else {
                EXPECT_GT(spectrum.GetCurvatureGrowth(), last + 0.005) << order;
                last = spectrum.GetCurvatureGrowth();
            }
            EXPECT_EQ(spectrum.nextFrequency, order == 3 ? 0 : 2);
        }
    }
    double last = 1;
    for (int order : {3, 4, 5, 6, 7, 8, 9, 10, 12, 16, 32, 64}) {
        double const growth = ComputeSpectrum(MakeLocalSubdivision(hexagonal(FaceMask::Smooth),
                                                                   CenterKind::Vertex, order))
                                  .GetCurvatureGrowth();
        if (order < 8) {
            EXPECT_NEAR(growth, 1, 1e-9) << order;
        } else {
            EXPECT_GT(growth, last) << order;
            last = growth;
        }
        if (order == 8 || order == 12 || order == 64) {
            EXPECT_NEAR(growth, order == 8 ? 1.08 : order == 12 ? 1.21 : 1.30, 0.005);
        }
    }
}

} // namespace OpenSubdivHex::Regression::spectrumTest

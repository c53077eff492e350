// SPDX-License-Identifier: Apache-2.0
//
// Sums by symmetries of a face, which are those of the stencils, whatever the instructions, and the same bits with
// all that fuse products with them.
#include "bfr_ext/cell/mirrorMatrix.h"
#include "bfr_ext/cell/cellPlan.h"
#include "far_ext/vtr/hierarchy.h"
#include "regression/far_ext/referenceMatch.h"
#include "regression/shapes/meshOperations.h"
#include "regression/shapes/torus.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace OpenSubdivHex::Regression::mirrorMatrixTest {

using BfrExt::internal::BasePoint;
using BfrExt::internal::CellType;
using BfrExt::internal::CellTypes;
using BfrExt::internal::MirrorMatrix;
using BfrExt::internal::PlaceSums;
using BfrExt::internal::Symmetries;

namespace {

using Stencils = std::vector<std::vector<double>>;

/// What stands where no sum goes.
constexpr int kUntouched = -7;

template <typename REAL>
using Function = void (*)(MirrorMatrix<REAL> const &, PlaceSums<REAL> const &);

/// The places in face 0 of a shape, with their stencils.
class Face {
public:
    explicit Face(Shape const &shape) {
        auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0, {});
        FarExt::internal::CellPatch cell;
        GatherBaseCell(refiner->GetHierarchy().mesh.levels[0], 0, {}, cell);
        _type = &_types.Find(std::move(cell), {});
        int const size = _type->GetNumCorners();
        BfrExt::internal::LeafPlaces const places(size, 3);
        BfrExt::internal::CellStencil stencil(*_type);
        for (std::size_t i = 0; i < places.GetSize(); ++i) {
            _places.push_back(
                BfrExt::internal::MakeBasePoint(size, places[i].sector, places[i].coords));
            stencil.Find(_places.back(), true);
            _stencils.push_back(stencil.GetWeights());
            _duStencils.push_back(stencil.GetDuWeights());
        }
    }

    CellType const &GetType() const { return *_type; }
    std::vector<BasePoint> const &GetPlaces() const { return _places; }
    Stencils const &GetStencils() const { return _stencils; }
    Stencils const &GetDuStencils() const { return _duStencils; }

private:
    CellTypes _types;
    CellType const *_type;
    std::vector<BasePoint> _places;
    Stencils _stencils;
    Stencils _duStencils;
};

/// Behind the portable one, those that fuse products.
template <typename REAL>
std::vector<Function<REAL>> getFunctions() {
    std::vector<Function<REAL>> functions = {BfrExt::internal::SumUpPlacesPortable};
#if defined(__x86_64__) && defined(__GNUC__)
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
        functions.push_back(BfrExt::internal::SumUpPlacesAvx2);
    }
    if (__builtin_cpu_supports("avx512f")) {
        functions.push_back(BfrExt::internal::SumUpPlacesAvx512);
    }
#endif
    functions.push_back(BfrExt::internal::SumUpPlaces);
    return functions;
}

/// \param gap        numbers between points, and between results
/// \param tolerance  of the sums of points between -1 and 1
template <typename REAL>
void expectSums(MirrorMatrix<REAL> const &matrix, Stencils const &stencils, std::size_t size,
                std::size_t gap, double tolerance) {
    std::size_t const stride = size + gap;
    std::mt19937 random{unsigned(size)};
    std::uniform_real_distribution<double> uniform(-1, 1);
    std::vector<REAL> points(stencils[0].size() * stride);
    for (REAL &number : points) {
        number = REAL(uniform(random));
    }
    std::vector<REAL> fused;
    std::vector<Function<REAL>> const functions = getFunctions<REAL>();
    for (Function<REAL> const &function : functions) {
        std::vector<REAL> results(stencils.size() * stride + 1, REAL(kUntouched));
        function(matrix, {points.data(), std::ptrdiff_t(stride), size, nullptr, results.data(),
                          std::ptrdiff_t(stride)});
        if (!fused.empty()) {
            ASSERT_EQ(results, fused);
            continue;
        }
        if (&function != functions.data()) {
            fused = results;
        }
        for (std::size_t i = 0; i < results.size(); ++i) {
            std::size_t const place = i / stride;
            std::size_t const component = i % stride;
            if (place == stencils.size() || component >= size) {
                ASSERT_EQ(results[i], REAL(kUntouched));
                continue;
            }
            double sum = 0;
            for (std::size_t point = 0; point < stencils[place].size(); ++point) {
                sum += stencils[place][point] * double(points[point * stride + component]);
            }
            ASSERT_NEAR(double(results[i]), sum, tolerance) << "place " << place;
        }
    }
}

/// \param parity  of the stencils
void expectSums(Face const &face, Symmetries const &symmetries, Stencils const &stencils,
                std::size_t parity) {
    for (std::size_t const first : {std::size_t(0), std::size_t(face.GetType().GetNumCorners())}) {
        Stencils const ofPlaces(stencils.begin() + std::ptrdiff_t(first), stencils.end());
        MirrorMatrix<float> const matrix(symmetries, face.GetPlaces(), first, ofPlaces, parity);
        MirrorMatrix<double> const exact(symmetries, face.GetPlaces(), first, ofPlaces, parity);
        for (std::size_t const size : {1, 3, 4, 6, 8}) {
            for (std::size_t const gap : {0, 2}) {
                SCOPED_TRACE(std::to_string(size) + " numbers");
                expectSums(matrix, ofPlaces, size, gap, 2e-5);
                expectSums(exact, ofPlaces, size, gap, 1e-11);
            }
        }
    }
}

/// \param numImages  those by reflections
void expectSymmetry(Shape const &shape, std::size_t numImages) {
    Face const face(shape);
    ASSERT_TRUE(face.GetType().IsInLattice());
    auto const numPlaces = double(face.GetPlaces().size());
    auto const getNumSlots = [](MirrorMatrix<float> const &matrix) {
        return double(matrix.GetParts()[0].matrix.GetNumPlaces());
    };
    Symmetries const reflections(face.GetType(), Symmetries::Kind::Reflections);
    ASSERT_EQ(reflections.GetNumImages(), numImages);
    expectSums(face, reflections, face.GetStencils(), 0);
    // Those in the middle are images of themselves.
    MirrorMatrix<float> const points(reflections, face.GetPlaces(), 0, face.GetStencils(), 0);
    EXPECT_LT(getNumSlots(points), 1.3 * numPlaces / double(numImages));

    Symmetries const turn(face.GetType(), Symmetries::Kind::HalfTurn);
    ASSERT_EQ(turn.GetNumImages(), numImages / 2);
    std::size_t const odd = turn.GetNumImages() - 1;
    expectSums(face, turn, face.GetDuStencils(), odd);
    MirrorMatrix<float> const derivatives(turn, face.GetPlaces(), 0, face.GetDuStencils(), odd);
    EXPECT_LE(getNumSlots(derivatives), numPlaces / double(turn.GetNumImages()));

    // Stencils that are no images of each other have slots of their own.
    Stencils others = face.GetStencils();
    others[0][0] += 0.25;
    others.back()[1] -= 0.25;
    expectSums(face, reflections, others, 0);
    expectSums(face, reflections, face.GetDuStencils(), 1);
}

} // namespace

TEST(MirrorMatrixTest, GivesTheSumsOfTheStencils) {
    Shape const triangles = MakeTorus(9, 7, TorusFaces::Triangles);
    expectSymmetry(MakeTorus(9, 7, TorusFaces::Quads), 4);
    expectSymmetry(triangles, 2);
    expectSymmetry(MakeDual("hexagons", triangles), 4);
}

} // namespace OpenSubdivHex::Regression::mirrorMatrixTest

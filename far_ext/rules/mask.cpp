// SPDX-License-Identifier: Apache-2.0
#include "far_ext/rules/mask.h"

#include "far_ext/vtr/pi.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace OpenSubdivHex::FarExt {

namespace {

// Cosine in extended precision, so that those of 60 and 90 degrees come out exact in double.
long double cosOfTurn(int j, int n) { return std::cos(2.0L * internal::kLongPi * j / n); }

long double averageWeight(int j, int n) {
    bool const isNeighbor = (j == 1 || j == n - 1);
    if (j == 0) {
        return (2.0L * n + 1) / (4.0L * n);
    }
    return isNeighbor ? (n + 2.0L) / (8.0L * n) : 1 / (4.0L * n);
}

long double cosineWeight(int j, int n) {
    return ((j == 0 ? n : 0) + 3 + 2 * cosOfTurn(j, n)) / (4.0L * n);
}

long double smoothWeight(int j, int n) {
    long double const sum = 7 + 6 * cosOfTurn(j, n) + 2 * cosOfTurn(2 * j, n);
    return ((j == 0 ? n : 0) + sum) / (8.0L * n);
}

// The eigenvalues are 1/2, 1/4 and then 1/6 in place of 1/8: the least for which weights fall all the way around.
long double fallingSmoothWeight(int j, int n) {
    long double const sum = 5 + 4 * cosOfTurn(j, n) + cosOfTurn(2 * j, n);
    return ((j == 0 ? n : 0) + sum) / (6.0L * n);
}

// Sides of the largest polygon whose half has no negative weight by the mask of Smooth.
constexpr int kMaxHalvedBySmooth = 10;

long double varyingWeight(int j, int n) { return ((j == 0 ? n : 0) + 1) / (2.0L * n); }

long double faceWeight(FaceMask mask, Interpolation interpolation, int j, int n) {
    if (interpolation == Interpolation::Varying) {
        return varyingWeight(j, n);
    }
    switch (mask) {
    case FaceMask::Average:
        return averageWeight(j, n);
    case FaceMask::Cosine:
        return cosineWeight(j, n);
    case FaceMask::Smooth:
        return n < 5 ? cosineWeight(j, n) : smoothWeight(j, n);
    }
    return 0;
}

} // namespace

void ComputeFaceVertexMask(FaceMask mask, Interpolation interpolation, int n, double *weights) {
    for (int j = 0; j <= n / 2; ++j) {
        weights[j] = double(faceWeight(mask, interpolation, j, n));
    }
    for (int j = n / 2 + 1; j < n; ++j) {
        weights[j] = weights[n - j];
    }
}

void ComputeHalfFaceVertexMask(FaceMask mask, Interpolation interpolation, int n, double *weights) {
    int const half = n - 1; // sides of the polygon from V to W
    int const size = 2 * half;
    std::vector<long double> ofDistance(static_cast<std::size_t>(size));
    bool const isFalling = mask == FaceMask::Smooth && interpolation == Interpolation::Vertex &&
                           size > kMaxHalvedBySmooth;
    for (int j = 0; j < size; ++j) {
        ofDistance[std::size_t(j)] =
            isFalling ? fallingSmoothWeight(j, size) : faceWeight(mask, interpolation, j, size);
    }
    // Between places in the polygon, that of V being 0, of W half, and then those of the Q.
    auto const weightAt = [&](int from, int to) {
        return ofDistance[std::size_t((to - from + size) % size)];
    };
    auto const setRow = [&](int row, int column, long double weight) {
        weights[std::size_t(row) * std::size_t(n) + std::size_t(column)] = double(weight);
    };
    for (int i = 0; i < 2; ++i) {
        for (int j = 0; j < n; ++j) {
            setRow(i, j, j == i ? 0.75L : j < 2 ? 0.25L : 0.0L);
        }
    }
    for (int i = 2; i < n; ++i) {
        int const place = half + i - 1;
        long double ofV = weightAt(place, 0);
        long double ofW = weightAt(place, half);
        for (int ghost = 1; ghost < half; ++ghost) {
            long double const weight = weightAt(place, ghost);
            long double const c = cosOfTurn(ghost, size);
            ofV += (1 + c) * weight;
            ofW += (1 - c) * weight;
            setRow(i, n - ghost, weightAt(place, size - ghost) - weight);
        }
        setRow(i, 0, ofV);
        setRow(i, 1, ofW);
    }
}

void ComputeTriHexMask(int n, double *weights) {
    std::fill_n(weights, n, 1.0 / (3.0 * n));
    weights[0] = weights[1] = (n + 1) / (3.0 * n);
}

TruncateMask ComputeTruncateMask(int numFaces) {
    constexpr int kMinFitted = 3;
    constexpr TruncateMask kFitted[] = {
        {0, 27 / 64.0, 10 / 64.0},      {1 / 32.0, 12 / 32.0, 7 / 32.0},
        {1 / 14.0, 5 / 14.0, 3 / 14.0}, {1 / 6.0, 1 / 3.0, 1 / 6.0},
        {4 / 16.0, 5 / 16.0, 2 / 16.0}, {20 / 64.0, 19 / 64.0, 6 / 64.0},
    };
    if (numFaces >= kMinFitted && numFaces <= kMaxTruncatedAround) {
        return kFitted[numFaces - kMinFitted];
    }
    double const beside = std::min(0.5, double((4 - 2 * cosOfTurn(1, numFaces)) / 9));
    return {1 - 2 * beside, beside, 0};
}

double ComputeSectorShrink(FaceMask mask, double sectorSize) {
    bool const isAverage = mask == FaceMask::Average;
    double const alpha = isAverage ? 0.98 : 1.31;
    double const beta = isAverage ? 0.305 : 0.515;
    return 1 / (alpha + beta * std::cos(internal::kPi / sectorSize));
}

VertexVertexMask ComputeVertexVertexMask(Interpolation interpolation, int numFaces) {
    if (interpolation == Interpolation::Varying) {
        return {1, 0};
    }
    double const weight = 1.0 / (numFaces + 1);
    return {weight, weight};
}

namespace {

// The weights around an irregular vertex V, with the names of the vertices as in the header.
struct IrregularWeights {
    double atVertex[4];   // of V, of N and of M, of A and of C, of B
    double atNeighbor[4]; // of N, V, A, M
    double ofFaces;       // of the mean of the F-vertices, in V'
};

// The share of a vertex with many faces that goes along its edges; see the header.
constexpr double kMaxSpokeShare = 0.77;

double cosOfHalfTurn(int j, int n) { return double(cosOfTurn(j, 2 * n)); }

// The linear equation of c1 and a2 by which frequency w has the eigenvalue x.
struct EigenEquation {
    EigenEquation(int numFaces, int w, double x, double const atNeighbor[4]) {
        double const c = cosOfHalfTurn(w, numFaces);
        double const d = cosOfHalfTurn(2 * w, numFaces);
        double const n = atNeighbor[0];
        double const a = atNeighbor[2];
        double const m = atNeighbor[3];
        ofSide = 2 * c * (x * x - a * a);
        ofNext = 2 * (x * (n + m * d) + a * c * (n + m));
        right = x * (x * x - a * a);
    }
    double ofSide;
    double ofNext;
    double right;
};

// Four or five faces: lambda and its square are eigenvalues.
IrregularWeights solveWeights(int numFaces, double lambda, double const atNeighbor[4]) {
    double const m = lambda * lambda;
    EigenEquation const first(numFaces, 1, lambda, atNeighbor);
    EigenEquation const second(numFaces, 2, m, atNeighbor);
    double const determinant = first.ofSide * second.ofNext - second.ofSide * first.ofNext;
    double const side = (first.right * second.ofNext - second.right * first.ofNext) / determinant;
    double const next = (first.ofSide * second.right - second.ofSide * first.right) / determinant;
    double const a = atNeighbor[2];
    double const sum = atNeighbor[0] + atNeighbor[3];
    double const ofFaces =
        ((2 * side - m) * (a - m) - 2 * next * sum) / (2 * side * (a - m) - 2 * next * (m + sum));
    return {{1 - 2 * side - 2 * next, side, next, 0},
            {atNeighbor[0], atNeighbor[1], atNeighbor[2], atNeighbor[3]},
            ofFaces};
}

IrregularWeights findWeights(int numFaces) {
    constexpr double kAtNeighborOfFour[4] = {14 / 32.0, 4 / 32.0, 9 / 32.0, 5 / 32.0};
    constexpr double kAtNeighbor[4] = {15 / 32.0, 4 / 32.0, 8 / 32.0, 5 / 32.0};
    constexpr double kLambda = 4 / 7.0;
    if (numFaces == 4) {
        return solveWeights(4, kLambda, kAtNeighborOfFour);
    }
    if (numFaces == 5) {
        return solveWeights(5, kLambda, kAtNeighbor);
    }
    double const c = cosOfHalfTurn(1, numFaces);
    double const share = std::min(cosOfHalfTurn(2, numFaces) / (c * c), kMaxSpokeShare);
    return {{1 - share, share / 2, 0, 0},
            {kAtNeighbor[0], kAtNeighbor[1], kAtNeighbor[2], kAtNeighbor[3]},
            1 - share * c * c};
}

// The first levels, where points are uneven: what F-vertices around a vertex are made of, as in
// IrregularVertexMask, in parts of a whole.
constexpr double kParts = 256;
struct FirstAround {
    int atVertex[6];
    int atNeighbor[6];
};
struct FirstLevels {
    int numFaces;
    FacesAround facesAround;
    int numLevels;
    FirstAround levels[kNumStepsToConstantMasks - 1];
};
constexpr FirstLevels kFirstLevels[] = {
    {4,
     FacesAround::Quads,
     3,
     {{{52, 87, 15, 0, 15, 87}, {112, 72, 0, 0, 40, 32}},
      {{96, 74, 0, 12, 0, 74}, {128, 25, 33, 0, 31, 39}},
      {{82, 69, 18, 0, 18, 69}, {99, 78, 0, 0, 42, 37}}}},
    {4,
     FacesAround::Others,
     2,
     {{{88, 64, 20, 0, 20, 64}, {116, 56, 0, 28, 20, 36}},
      {{88, 56, 28, 0, 28, 56}, {112, 52, 0, 36, 0, 56}}}},
    {5,
     FacesAround::Others,
     2,
     {{{68, 94, 0, 0, 0, 94}, {159, 0, 34, 11, 29, 23}},
      {{74, 78, 13, 0, 13, 78}, {127, 35, 8, 14, 31, 41}}}},
    {6,
     FacesAround::Others,
     2,
     {{{62, 97, 0, 0, 0, 97}, {157, 6, 25, 19, 23, 26}},
      {{76, 90, 0, 0, 0, 90}, {144, 8, 18, 10, 36, 40}}}},
    {7,
     FacesAround::Others,
     2,
     {{{56, 100, 0, 0, 0, 100}, {151, 20, 14, 21, 23, 27}},
      {{82, 87, 0, 0, 0, 87}, {141, 0, 35, 0, 37, 43}}}},
    {8,
     FacesAround::Others,
     2,
     {{{54, 101, 0, 0, 0, 101}, {152, 11, 37, 0, 31, 25}},
      {{88, 84, 0, 0, 0, 84}, {137, 0, 50, 0, 30, 39}}}},
    {5,
     FacesAround::Triangles,
     2,
     {{{50, 87, 16, 0, 16, 87}, {111, 79, 0, 0, 65, 1}},
      {{92, 69, 13, 0, 13, 69}, {118, 45, 0, 0, 48, 45}}}},
    {6,
     FacesAround::Triangles,
     2,
     {{{30, 113, 0, 0, 0, 113}, {128, 59, 0, 0, 68, 1}},
      {{90, 83, 0, 0, 0, 83}, {128, 48, 0, 0, 41, 39}}}},
    {7,
     FacesAround::Triangles,
     2,
     {{{34, 100, 11, 0, 11, 100}, {106, 73, 0, 0, 76, 1}},
      {{78, 80, 9, 0, 9, 80}, {124, 58, 0, 0, 31, 43}}}},
    {8,
     FacesAround::Triangles,
     2,
     {{{30, 103, 10, 0, 10, 103}, {106, 73, 0, 0, 76, 1}},
      {{98, 66, 13, 0, 13, 66}, {121, 68, 0, 0, 27, 40}}}},
};

// The masks in quads and beside them, as in QuadMask.  ./dev masks finds these tables and
// the tables above.  After the first step all corners beside a neighbor of a vertex among quads are at a quad,
// and nothing else is.
struct FirstOfQuads {
    int inQuad[4];
    int numRows;
    int beside[QuadMask::kNumRows][6];
};
constexpr FirstOfQuads kFirstOfQuads[kNumStepsToConstantMasks - 1] = {
    {{127, 55, 19, 55}, 1, {{137, 58, 0, 14, 47, 0}}},
    {{122, 54, 26, 54}, 2, {{137, 63, 0, 22, 21, 13}, {97, 46, 21, 0, 33, 59}}},
    {{116, 54, 32, 54}, 1, {{142, 68, 0, 9, 37, 0}}},
};

template <int SIZE>
void setParts(int const (&parts)[SIZE], double (&weights)[SIZE]) {
    std::transform(parts, parts + SIZE, weights, [](int part) { return part / kParts; });
}

} // namespace

IrregularVertexMask ComputeIrregularVertexMask(int numFaces, int numSteps,
                                               FacesAround facesAround) {
    IrregularWeights const weights = findWeights(numFaces);
    auto const [self, side, next, opposite] = weights.atVertex;
    auto const [n, v, a, m] = weights.atNeighbor;
    IrregularVertexMask mask = {{self, side, next, opposite, next, side},
                                {n, a, 0, 0, m, v},
                                {1 - weights.ofFaces, weights.ofFaces / numFaces}};
    for (FirstLevels const &first : kFirstLevels) {
        if (first.numFaces == numFaces && first.facesAround == facesAround && 1 <= numSteps &&
            numSteps <= first.numLevels) {
            setParts(first.levels[numSteps - 1].atVertex, mask.atVertex);
            setParts(first.levels[numSteps - 1].atNeighbor, mask.atNeighbor);
        }
    }
    return mask;
}

QuadMask ComputeQuadMask(int numSteps) {
    QuadMask mask = {};
    if (numSteps < 1 || numSteps >= kNumStepsToConstantMasks) {
        ComputeFaceVertexMask(FaceMask::Smooth, Interpolation::Vertex, 4, mask.inQuad);
        return mask;
    }
    FirstOfQuads const &first = kFirstOfQuads[numSteps - 1];
    mask.numRows = first.numRows;
    setParts(first.inQuad, mask.inQuad);
    for (int i = 0; i < first.numRows; ++i) {
        setParts(first.beside[i], mask.beside[i]);
    }
    return mask;
}

} // namespace OpenSubdivHex::FarExt

// SPDX-License-Identifier: Apache-2.0
#include "mask.h"

#include <algorithm>
#include <cmath>

namespace OpenSubdivHex::FarExt {

namespace {

// Cosine in extended precision, so that those of 60 and 90 degrees come out exact in double.
long double cosOfTurn(int j, int n) {
    return std::cos(2.0L * 3.141592653589793238462643383279502884L * j / n);
}

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

void ComputeHalfFaceVertexMask(FaceMask mask, Interpolation interpolation, double *weights) {
    long double w[4]; // by distance in the completed hexagon
    for (int j = 0; j < 4; ++j) {
        w[j] = faceWeight(mask, interpolation, j, 6);
    }
    long double const atLong = w[1] + 1.5L * w[2] + 0.5L * w[3]; // the end beside the corner
    long double const atOther = 1.5L * (w[2] + w[3]);
    long double const atSelf = w[0] - w[2];
    long double const atTwin = w[1] - w[3];
    long double const rows[4][4] = {{0.75L, 0.25L, 0, 0},
                                    {0.25L, 0.75L, 0, 0},
                                    {atOther, atLong, atSelf, atTwin},
                                    {atLong, atOther, atTwin, atSelf}};
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) {
            weights[4 * i + j] = double(rows[i][j]);
        }
    }
}

void ComputeTriHexMask(int n, double *weights) {
    std::fill_n(weights, n, 1.0 / (3.0 * n));
    weights[0] = weights[1] = (n + 1) / (3.0 * n);
}

double ComputeSectorShrink(FaceMask mask, double sectorSize) {
    bool const isAverage = mask == FaceMask::Average;
    double const alpha = isAverage ? 0.98 : 1.31;
    double const beta = isAverage ? 0.305 : 0.515;
    return 1 / (alpha + beta * std::cos(3.14159265358979323846 / sectorSize));
}

VertexVertexMask ComputeVertexVertexMask(Interpolation interpolation, int numFaces) {
    if (interpolation == Interpolation::Varying) {
        return {1, 0};
    }
    double const weight = 1.0 / (numFaces + 1);
    return {weight, weight};
}

} // namespace OpenSubdivHex::FarExt

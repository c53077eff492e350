// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_ANALYSIS_SPECTRUM_H
#define OPENSUBDIVHEX_REGRESSION_ANALYSIS_SPECTRUM_H

#include "localSubdivision.h"

#include <complex>
#include <vector>

namespace OpenSubdivHex::Regression {

/// \brief An eigenvalue of a local subdivision matrix and the symmetry of its eigenvectors.
struct Eigenvalue {
    /// Without the step's turn: real in theory for the schemes here wherever it matters.
    std::complex<double> value;
    /// How often the eigenvector's phase turns on one way around the center, 0 ... order / 2.
    int frequency = 0;
    /// 2 for those that the frequency -frequency shares, else 1.
    int multiplicity = 1;
};

/// All eigenvalues, by descending modulus, found frequency by frequency.
std::vector<Eigenvalue> ComputeEigenvalues(LocalSubdivision const &subdivision);

/// \brief The eigenvalues that tell how smooth the surface is at the center (Reif 1995; Doo and
/// Sabin 1978).
struct Spectrum {
    double dominant = 0;    ///< of frequency 0: 1
    double subdominant = 0; ///< the largest modulus of frequency 1
    /// The largest modulus of all others.
    double next = 0;
    int nextFrequency = 0;

    /// Whether the subdominant is a pair of frequency 1 and strictly between the others: with a
    /// characteristic map that does not fold, the surface has a tangent plane.
    bool HasTangentPlane() const {
        constexpr double kMargin = 1e-6;
        return subdominant < dominant - kMargin && next < subdominant - kMargin;
    }
    /// \brief The factor by which curvature at the center changes with every step.
    ///
    /// Above 1 the curvature is unbounded, below 1 the surface is flat there.  At 1 it is bounded,
    /// unless eigenvectors are missing: then every step adds as much again.
    double GetCurvatureGrowth() const { return next / (subdominant * subdominant); }
};

Spectrum ComputeSpectrum(LocalSubdivision const &subdivision);

/// The weights of the vertices of the neighbourhood for the limit of the center vertex, or of all
/// vertices of the center face, which shrinks to a point: the left eigenvector of 1.
Eigen::VectorXd ComputeLimitMask(LocalSubdivision const &subdivision);

/// \brief Positions of the vertices in the plane, as complex numbers, that a step scales down by
/// the subdominant eigenvalue (and turns): the characteristic map (Reif 1995).  The first vertex
/// besides a center vertex, or of a center face, has the position 1.
Eigen::VectorXcd ComputeCharacteristicMap(LocalSubdivision const &subdivision);

/// Whether all faces of the neighbourhood are convex, counter-clockwise polygons in the plane of
/// \p map, and those around the center go around it once: it does not fold.
bool IsRegular(LocalSubdivision const &subdivision, Eigen::VectorXcd const &map);

} // namespace OpenSubdivHex::Regression

#endif

// SPDX-License-Identifier: Apache-2.0
#include "spectrum.h"

#include <Eigen/Dense>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace OpenSubdivHex::Regression {

namespace {

double const kPi = std::acos(-1.0);

/// \brief The part of a matrix that acts on values which change by a constant factor, of modulus 1,
/// with each step of a turn.
///
/// The vertices that turn into each other are an orbit; the values of one stand for all.
struct FrequencyBlock {
    std::vector<std::vector<int>> orbits;
    Eigen::MatrixXcd matrix;
};

std::complex<double> unitVector(double angle) { return std::polar(1.0, angle); }

FrequencyBlock makeBlock(LocalSubdivision const &subdivision, int frequency) {
    FrequencyBlock block;
    std::vector<bool> isSeen(subdivision.GetNumVertices(), false);
    for (int first = 0; first < subdivision.GetNumVertices(); ++first) {
        std::vector<int> orbit;
        for (int vertex = first; !isSeen[vertex]; vertex = subdivision.rotation[vertex]) {
            isSeen[vertex] = true;
            orbit.push_back(vertex);
        }
        // A vertex in the middle can only have values that do not change.
        if (int(orbit.size()) == subdivision.order || (!orbit.empty() && frequency == 0)) {
            block.orbits.push_back(std::move(orbit));
        }
    }
    double const stepAngle = 2 * kPi * frequency / subdivision.order;
    Eigen::Index const size = Eigen::Index(block.orbits.size());
    block.matrix = Eigen::MatrixXcd::Zero(size, size);
    for (Eigen::Index row = 0; row < size; ++row) {
        for (Eigen::Index column = 0; column < size; ++column) {
            std::vector<int> const &orbit = block.orbits[column];
            for (std::size_t step = 0; step < orbit.size(); ++step) {
                block.matrix(row, column) += subdivision.matrix(block.orbits[row][0], orbit[step]) *
                                             unitVector(double(step) * stepAngle);
            }
        }
    }
    // A child that stands further around has the number of a vertex that does not: the turn back.
    block.matrix *= unitVector(-subdivision.turn * stepAngle);
    return block;
}

} // namespace

std::vector<Eigenvalue> ComputeEigenvalues(LocalSubdivision const &subdivision) {
    std::vector<Eigenvalue> eigenvalues;
    for (int frequency = 0; frequency <= subdivision.order / 2; ++frequency) {
        int const multiplicity = frequency == 0 || 2 * frequency == subdivision.order ? 1 : 2;
        FrequencyBlock const block = makeBlock(subdivision, frequency);
        Eigen::ComplexEigenSolver<Eigen::MatrixXcd> const solver(block.matrix, false);
        for (std::complex<double> value : solver.eigenvalues()) {
            eigenvalues.push_back({value, frequency, multiplicity});
        }
    }
    std::stable_sort(eigenvalues.begin(), eigenvalues.end(),
                     [](Eigenvalue const &a, Eigenvalue const &b) {
                         return std::abs(a.value) > std::abs(b.value);
                     });
    return eigenvalues;
}

Spectrum ComputeSpectrum(LocalSubdivision const &subdivision) {
    Spectrum spectrum;
    bool hasDominant = false;
    bool hasSubdominant = false;
    for (Eigenvalue const &eigenvalue : ComputeEigenvalues(subdivision)) {
        double const modulus = std::abs(eigenvalue.value);
        if (eigenvalue.frequency == 0 && !hasDominant) {
            spectrum.dominant = modulus;
            hasDominant = true;
        } else if (eigenvalue.frequency == 1 && !hasSubdominant) {
            spectrum.subdominant = modulus;
            hasSubdominant = true;
        } else if (modulus > spectrum.next) {
            spectrum.next = modulus;
            spectrum.nextFrequency = eigenvalue.frequency;
        }
    }
    return spectrum;
}

Eigen::VectorXd ComputeLimitMask(LocalSubdivision const &subdivision) {
    Eigen::Index const size = subdivision.GetNumVertices();
    Eigen::MatrixXd equations(size + 1, size);
    equations << subdivision.matrix.transpose() - Eigen::MatrixXd::Identity(size, size),
        Eigen::RowVectorXd::Ones(size);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(size + 1);
    right(size) = 1;
    return equations.colPivHouseholderQr().solve(right);
}

Eigen::VectorXcd ComputeCharacteristicMap(LocalSubdivision const &subdivision) {
    FrequencyBlock const block = makeBlock(subdivision, 1);
    Eigen::ComplexEigenSolver<Eigen::MatrixXcd> const solver(block.matrix);
    Eigen::Index subdominant = 0;
    solver.eigenvalues().cwiseAbs().maxCoeff(&subdominant);
    Eigen::VectorXcd const values = solver.eigenvectors().col(subdominant);

    Eigen::VectorXcd map = Eigen::VectorXcd::Zero(subdivision.GetNumVertices());
    for (std::size_t i = 0; i < block.orbits.size(); ++i) {
        for (std::size_t step = 0; step < block.orbits[i].size(); ++step) {
            map(block.orbits[i][step]) = values(Eigen::Index(i)) / values(0) *
                                         unitVector(2 * kPi * double(step) / subdivision.order);
        }
    }
    return map;
}

bool IsRegular(LocalSubdivision const &subdivision, Eigen::VectorXcd const &map) {
    double around = 0;
    for (std::vector<int> const &face : subdivision.faces) {
        std::size_t const size = face.size();
        double sumOfAngles = 0;
        for (std::size_t i = 0; i < size; ++i) {
            std::complex<double> const before = map(face[(i + size - 1) % size]);
            std::complex<double> const at = map(face[i]);
            std::complex<double> const after = map(face[(i + 1) % size]);
            double const angle = std::arg((after - at) / (at - before));
            if (!(angle > 0)) {
                return false;
            }
            sumOfAngles += angle;
            if (subdivision.centerKind == CenterKind::Vertex && face[i] == 0) {
                around += kPi - angle;
            }
        }
        if (std::abs(sumOfAngles - 2 * kPi) > 1e-6) {
            return false;
        }
    }
    // A convex face in the center goes around it once as it is.
    return subdivision.centerKind == CenterKind::Face || std::abs(around - 2 * kPi) < 1e-6;
}

} // namespace OpenSubdivHex::Regression

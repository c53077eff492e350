// SPDX-License-Identifier: Apache-2.0
//
// Finds the constants of Gregory patches (far_ext/patch/patchConstants.inl) again and prints them.
//
// For each number of steps behind the surface level, the constants of all sites that some meshes have are those
// with the least sum, over the meshes, of the mean squares of distances and of angles between normals, each in
// terms of what it is by the defaults.  A small share is for how far constants are from these, so that those that
// matter little stay.  The method is Levenberg's and Marquardt's, with differences for derivatives.  None of the
// meshes is one of those that patchErrors prints.
#include "searchPatchConstants.h"

#include "patchSamples.h"

#include "far_ext/executor.h"
#include "far_ext/patch/patchBuilder.h"
#include "regression/shapes/featureShapes.h"
#include "regression/shapes/meshOperations.h"
#include "regression/shapes/torus.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <deque>
#include <map>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>

using namespace OpenSubdivHex;
using namespace OpenSubdivHex::Regression;
using FarExt::internal::PatchBuilder;
using FarExt::internal::PatchCells;
using FarExt::internal::PatchConstants;
using FarExt::internal::PatchQuantity;
using FarExt::internal::PatchSite;

namespace {

constexpr std::size_t kMaxNumSamples = 2500;
constexpr double kDegrees = 180 / 3.14159265358979323846; // in a radian

// Each face is cut into quads around its centre.
Shape cutIntoQuads(Shape const &shape) {
    Shape result = shape;
    result.faceSizes.clear();
    result.faceVertices.clear();
    std::map<std::pair<int, int>, int> middles;
    auto const add = [&](std::vector<int> const &verts) {
        Eigen::Vector3d sum(0, 0, 0);
        for (int const vert : verts) {
            sum += Eigen::Map<Eigen::Vector3d const>(shape.positions.data() + 3 * vert);
        }
        sum /= double(verts.size());
        result.positions.insert(result.positions.end(), sum.data(), sum.data() + 3);
        return int(result.positions.size() / 3) - 1;
    };
    int const *first = shape.faceVertices.data();
    for (int const size : shape.faceSizes) {
        std::vector<int> const verts(first, first + size);
        first += size;
        std::vector<int> ofEdges;
        for (int i = 0; i < size; ++i) {
            int const ends[2] = {verts[std::size_t(i)], verts[std::size_t((i + 1) % size)]};
            auto const added = middles.try_emplace(std::minmax(ends[0], ends[1]), 0);
            if (added.second) {
                added.first->second = add({ends[0], ends[1]});
            }
            ofEdges.push_back(added.first->second);
        }
        int const center = add(verts);
        for (int i = 0; i < size; ++i) {
            result.faceVertices.insert(result.faceVertices.end(),
                                       {verts[std::size_t(i)], ofEdges[std::size_t(i)], center,
                                        ofEdges[std::size_t((i + size - 1) % size)]});
            result.faceSizes.push_back(4);
        }
    }
    return result;
}

// Moves vertices by chance, by a share of a mean edge: as meshes of modellers are not even.
Shape shake(Shape shape) {
    constexpr double kShare = 0.05;
    double length = 0;
    std::size_t first = 0;
    auto const at = [&](int vert) {
        return Eigen::Map<Eigen::Vector3d>(shape.positions.data() + 3 * std::ptrdiff_t(vert));
    };
    for (int const size : shape.faceSizes) {
        length += (at(shape.faceVertices[first]) - at(shape.faceVertices[first + 1])).norm() /
                  double(shape.faceSizes.size());
        first += std::size_t(size);
    }
    std::mt19937 random(1); // the same numbers everywhere
    for (double &coordinate : shape.positions) {
        coordinate += kShare * length * (2 * double(random()) / double(random.max()) - 1);
    }
    return shape;
}

// On the unit sphere, then deformed.
Shape roundOff(Shape shape) {
    for (int i = 0; i < shape.GetNumVertices(); ++i) {
        Eigen::Map<Eigen::Vector3d>(shape.positions.data() + 3 * std::ptrdiff_t(i)).normalize();
    }
    Deform(shape);
    return shake(shape);
}

// A piece of a curved surface with a border.
Shape makePiece(Tiling tiling, int size) {
    Shape shape = MakeTiling(tiling, size, size);
    for (int i = 0; i < shape.GetNumVertices(); ++i) {
        double *const p = shape.positions.data() + 3 * std::ptrdiff_t(i);
        double const x = p[0] / size - 0.3;
        double const y = p[1] / size - 0.6;
        p[2] = size * (0.5 * x * x - 0.7 * y * y + 0.4 * x * y + 0.3 * x * x * x);
    }
    return shape;
}

// A quad with a vertex between two of its corners, which two faces have.
void addDoublets(Shape &shape, int distance) {
    std::vector<int> sizes;
    std::vector<int> verts;
    int const *first = shape.faceVertices.data();
    for (std::size_t face = 0; face < shape.faceSizes.size(); ++face) {
        int const size = shape.faceSizes[face];
        if (size != 4 || int(face) % distance != 0) {
            sizes.push_back(size);
            verts.insert(verts.end(), first, first + size);
        } else {
            int const middle = shape.GetNumVertices();
            for (std::size_t k = 0; k < 3; ++k) {
                double sum = 0;
                for (int i = 0; i < 4; ++i) {
                    sum += shape.positions[3 * std::size_t(first[i]) + k] / 4;
                }
                shape.positions.push_back(sum);
            }
            verts.insert(verts.end(), {first[0], first[1], first[2], middle, first[0], middle,
                                       first[2], first[3]});
            sizes.insert(sizes.end(), {4, 4});
        }
        first += size;
    }
    shape.faceSizes = sizes;
    shape.faceVertices = verts;
}

// The errors of one mesh's patches, for given constants.
class Fit {
public:
    // A share of 1 is that of a mesh like others.
    Fit(std::string name, Shape const &shape, int steps, FarExt::FirstStep firstStep, double share)
        : _share(share), _name(std::move(name)),
          _samples(shape, steps + (firstStep == FarExt::FirstStep::Same ? 0 : 1), firstStep, 0,
                   kMaxNumSamples),
          _cells(_samples.GetRefiner().GetHierarchy().mesh, _samples.GetLevel()) {
        std::vector<PatchSamples::Error> const errors =
            measure(PatchConstants(FarExt::FaceMask::Average));
        for (PatchSamples::Error const &error : errors) {
            _squares[0] += error.distance * error.distance;
            _squares[1] += error.normal.squaredNorm() / std::pow(getExcess(error), 2);
        }
        _numSamples = errors.size();
    }

    std::vector<PatchSite> FindSites() const {
        PatchConstants constants(FarExt::FaceMask::Average);
        constants.Set({PatchQuantity::EdgeShare, 0, PatchSite::kVertex}, 0); // so that it is asked
        std::vector<PatchSite> sites;
        constants.Record(&sites);
        measure(constants);
        return sites;
    }
    // Numbers whose squares sum to 2, times the share, with the defaults.
    Eigen::VectorXd Measure(PatchConstants const &constants) const {
        std::vector<PatchSamples::Error> const errors = measure(constants);
        Eigen::VectorXd result(3 * Eigen::Index(errors.size()));
        for (std::size_t i = 0; i < errors.size(); ++i) {
            result[3 * Eigen::Index(i)] = errors[i].distance / std::sqrt(_squares[0]);
            result.segment<2>(3 * Eigen::Index(i) + 1) =
                errors[i].normal / (getExcess(errors[i]) * std::sqrt(_squares[1]));
        }
        return std::sqrt(_share) * result;
    }
    void Print(PatchConstants const &constants) const {
        Eigen::VectorXd const numbers = Measure(constants) / std::sqrt(_share);
        double distances = 0;
        for (Eigen::Index i = 0; i < numbers.size(); i += 3) {
            distances += numbers[i] * numbers[i];
        }
        double const normals = numbers.squaredNorm() - distances;
        auto const number = double(_numSamples);
        std::printf("  %-24s distance %.2f, of %.2f; normals %.3f, of %.3f\n", _name.c_str(),
                    1e6 * std::sqrt(distances * _squares[0] / number),
                    1e6 * std::sqrt(_squares[0] / number),
                    kDegrees * std::sqrt(normals * _squares[1] / number),
                    kDegrees * std::sqrt(_squares[1] / number));
    }

private:
    // Where patches fold over, how much does not matter.
    static double getExcess(PatchSamples::Error const &error) {
        return std::hypot(1, error.GetAngle() * kDegrees / 20);
    }
    std::vector<PatchSamples::Error> measure(PatchConstants const &constants) const {
        FarExt::TopologyRefiner const &refiner = _samples.GetRefiner();
        PatchBuilder builder(refiner.GetHierarchy(), -1, refiner.GetSchemeOptions(),
                             refiner.GetHexSchemeOptions(), _cells, constants);
        FarExt::internal::PointStencils<double> stencils;
        if (!builder.Build().IsOk() || !builder.MakeStencils(stencils).IsOk()) {
            throw std::runtime_error(_name + " has no patches");
        }
        return _samples.Measure(
            _samples.MakePoints(stencils.sizes, stencils.indices, stencils.weights));
    }

    double const _share;
    std::string const _name;
    PatchSamples const _samples;
    PatchCells const _cells;
    double _squares[2] = {0, 0};
    std::size_t _numSamples = 0;
};

std::deque<Fit> makeFits(int steps) {
    auto const same = FarExt::FirstStep::Same;
    auto const truncate = FarExt::FirstStep::Truncate;
    // Later levels have enough patches of few faces.
    int const size = steps < 2 ? 2 : 1;
    int const numAround = 10 * size;
    int const numAcross = 6 * size;
    auto const refine = [&](Shape shape) {
        for (int i = 1; i < size; ++i) {
            shape = cutIntoQuads(shape);
        }
        return shape;
    };
    Shape doublets = roundOff(refine(cutIntoQuads(GetShape("cube"))));
    addDoublets(doublets, 5);
    std::deque<Fit> fits; // which stay where they are
    auto const add = [&](char const *name, Shape const &shape, FarExt::FirstStep firstStep,
                         double share = 1) {
        fits.emplace_back(name, shape, steps, firstStep, share);
    };
    add("torus of quads", MakeTorus(numAround, numAcross, TorusFaces::Quads, 1, 0.4), same);
    add("sphere, 3", roundOff(refine(cutIntoQuads(GetShape("cube")))), same);
    add("sphere, 4", roundOff(refine(cutIntoQuads(GetShape("octahedron")))), same);
    add("sphere, 5", roundOff(refine(cutIntoQuads(GetShape("icosahedron")))), same);
    add("sphere, 6", roundOff(refine(cutIntoQuads(MakeBipyramid(6)))), same);
    add("sphere, 8", roundOff(refine(cutIntoQuads(MakeBipyramid(8)))), same);
    add("sphere, 2", doublets, same, 0.1);
    add("irregular quads",
        shake(cutIntoQuads(MakeTorus(4 * size, 3 * size, TorusFaces::IrregularTriangles))), same);
    add("piece of quads", shake(makePiece(Tiling::Quads, 4 * size)), same);
    add("torus, truncated", MakeTorus(numAround, numAcross, TorusFaces::Triangles), truncate);
    add("irregular, truncated",
        shake(MakeTorus(numAround, numAcross, TorusFaces::IrregularTriangles)), truncate);
    add("sphere, truncated", roundOff(GetShape("icosahedron")), truncate);
    add("piece, truncated", shake(makePiece(Tiling::Triangles, 4 * size)), truncate);
    return fits;
}

double getStep(PatchSite const &site) {
    return site.quantity == PatchQuantity::Blend ? 0.02 : 0.01;
}

// How far constants are from their defaults, in terms of what they are commonly.
constexpr double kShareOfDefaults = 5e-3;
double getRange(PatchSite const &site) { return site.quantity == PatchQuantity::Blend ? 0.3 : 0.1; }

class Search {
public:
    explicit Search(int steps) : _fits(makeFits(steps)) {
        std::map<std::uint64_t, PatchSite> sites;
        for (Fit const &fit : _fits) {
            for (PatchSite const &site : fit.FindSites()) {
                sites.emplace(site.GetKey(), site);
            }
        }
        for (auto const &entry : sites) {
            _sites.push_back(entry.second);
        }
        _values.resize(Eigen::Index(_sites.size()));
        for (std::size_t i = 0; i < _sites.size(); ++i) {
            _values[Eigen::Index(i)] = PatchConstants::GetDefault(_sites[i]);
        }
        std::printf("%d sites; sum of squares %.4f in the library, %.4f where the search begins\n",
                    int(_sites.size()), sum(getShipped()), sum(_values));
    }

    void Run(int maxRounds) {
        constexpr double kEnough = 3e-3; // of the sum
        double damping = 1e-3;
        double current = sum(_values);
        for (int round = 0; round < maxRounds; ++round) {
            Eigen::MatrixXd matrix;
            Eigen::VectorXd gradient;
            linearize(matrix, gradient);
            double next = current;
            for (int i = 0; i < 6 && !(next < current); ++i) {
                Eigen::MatrixXd damped = matrix;
                damped.diagonal() *= 1 + damping;
                Eigen::VectorXd const values = _values - damped.ldlt().solve(gradient);
                next = sum(values);
                if (next < current) {
                    _values = values;
                    damping /= 10;
                } else {
                    damping *= 10;
                }
            }
            std::printf("  round %d: %.4f\n", round, next);
            bool const isEnough = current - next < kEnough * current;
            current = std::min(current, next);
            if (isEnough) {
                break;
            }
        }
        for (Fit const &fit : _fits) {
            fit.Print(makeConstants(_values));
        }
    }

    // Prints the constants that are no defaults.
    void Print() const {
        Eigen::VectorXd const apart = _values - getShipped();
        std::printf(
            "apart from the library's by %.3f, the root of the mean square, and %.3f at most\n",
            std::sqrt(apart.squaredNorm() / double(apart.size())), apart.cwiseAbs().maxCoeff());
        constexpr double kUnit = 0.005;
        char const *const quantities[] = {"kLength", "kBlend", "kEdgeShare", "kDiagonalShare"};
        char const *const kinds[] = {"kEdge",      "kDiagonal", "kLongBoundary",
                                     "kSharpEdge", "kVertex",   "kSpoke"};
        for (std::size_t i = 0; i < _sites.size(); ++i) {
            PatchSite const &site = _sites[i];
            double const value = kUnit * std::round(_values[Eigen::Index(i)] / kUnit);
            if (std::abs(value - PatchConstants::GetDefault(site)) < kUnit / 2) {
                continue;
            }
            std::printf("    {{%s, %d, %s, %d, %d, %d, %d, %s, %s, %d}, %.10g},\n",
                        quantities[int(site.quantity)], site.steps, kinds[int(site.kind)],
                        site.vert, site.otherVert, site.smallFace, site.largeFace,
                        site.isBesideOther ? "true" : "false",
                        site.isOtherBesideOther ? "true" : "false", site.surfaceFace, value);
        }
        std::fflush(stdout);
    }

private:
    Eigen::VectorXd getShipped() const {
        PatchConstants const shipped(FarExt::FaceMask::Smooth);
        Eigen::VectorXd values = _values;
        std::transform(_sites.begin(), _sites.end(), values.begin(),
                       [&shipped](PatchSite const &site) { return shipped.Get(site); });
        return values;
    }
    PatchConstants makeConstants(Eigen::VectorXd const &values) const {
        PatchConstants constants(FarExt::FaceMask::Average);
        for (std::size_t i = 0; i < _sites.size(); ++i) {
            constants.Set(_sites[i], values[Eigen::Index(i)]);
        }
        return constants;
    }
    Eigen::VectorXd findDistances(Eigen::VectorXd const &values) const {
        Eigen::VectorXd result = values;
        for (std::size_t i = 0; i < _sites.size(); ++i) {
            double &value = result[Eigen::Index(i)];
            value = (value - PatchConstants::GetDefault(_sites[i])) / getRange(_sites[i]);
        }
        return result;
    }
    double sum(Eigen::VectorXd const &values) const {
        double result = kShareOfDefaults * findDistances(values).squaredNorm();
        PatchConstants const constants = makeConstants(values);
        for (Fit const &fit : _fits) {
            result += fit.Measure(constants).squaredNorm();
        }
        return result;
    }
    void linearize(Eigen::MatrixXd &matrix, Eigen::VectorXd &gradient) const {
        Eigen::Index const size = _values.size();
        matrix = Eigen::MatrixXd::Zero(size, size);
        gradient = kShareOfDefaults * findDistances(_values);
        for (Eigen::Index i = 0; i < size; ++i) {
            double const range = getRange(_sites[std::size_t(i)]);
            gradient[i] /= range;
            matrix(i, i) = kShareOfDefaults / (range * range);
        }
        for (Fit const &fit : _fits) {
            std::map<std::uint64_t, PatchSite> ofFit;
            for (PatchSite const &site : fit.FindSites()) {
                ofFit.emplace(site.GetKey(), site);
            }
            Eigen::VectorXd const numbers = fit.Measure(makeConstants(_values));
            std::vector<Eigen::Index> columns;
            for (Eigen::Index i = 0; i < size; ++i) {
                if (ofFit.count(_sites[std::size_t(i)].GetKey()) != 0) {
                    columns.push_back(i);
                }
            }
            Eigen::MatrixXd derivatives(numbers.size(), Eigen::Index(columns.size()));
            for (std::size_t k = 0; k < columns.size(); ++k) {
                Eigen::VectorXd values = _values;
                double const step = getStep(_sites[std::size_t(columns[k])]);
                values[columns[k]] += step;
                derivatives.col(Eigen::Index(k)) =
                    (fit.Measure(makeConstants(values)) - numbers) / step;
            }
            Eigen::MatrixXd const product = derivatives.transpose() * derivatives;
            Eigen::VectorXd const ofNumbers = derivatives.transpose() * numbers;
            for (std::size_t k = 0; k < columns.size(); ++k) {
                gradient[columns[k]] += ofNumbers[Eigen::Index(k)];
                for (std::size_t l = 0; l < columns.size(); ++l) {
                    matrix(columns[k], columns[l]) += product(Eigen::Index(k), Eigen::Index(l));
                }
            }
        }
    }

    std::deque<Fit> const _fits;
    std::vector<PatchSite> _sites;
    Eigen::VectorXd _values;
};

} // namespace

void Regression::SearchPatchConstants(int steps, int maxRounds) {
    FarExt::SetNumThreads(1); // PatchConstants::Record
    Search search(steps);
    search.Run(maxRounds);
    search.Print();
}

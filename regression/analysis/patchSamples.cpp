// SPDX-License-Identifier: Apache-2.0
#include "patchSamples.h"

#include "far_ext/patchTableFactory.h"
#include "far_ext/primvarRefiner.h"
#include "far_ext/stencilTableFactory.h"
#include "far_ext/topologyRefinerFactory.h"
#include "regression/shapes/shapeDescriptor.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace OpenSubdivHex::Regression {

namespace {

using Vector = PatchSamples::Vector;

constexpr int kNumSteps = 2; // from patches to the vertices that they are compared to

struct Point {
    void Clear() { p.setZero(); }
    void AddWithWeight(Point const &other, double weight) { p += weight * other.p; }
    Vector p = Vector::Zero();
};

template <typename TABLE>
Vector sum(TABLE const &table, std::vector<double> const &weights, int row,
           std::vector<Point> const &points) {
    Vector result = Vector::Zero();
    int const offset = table.GetOffsets()[std::size_t(row)];
    for (int k = offset; k < offset + table.GetSizes()[std::size_t(row)]; ++k) {
        result += weights[std::size_t(k)] *
                  points[std::size_t(table.GetControlIndices()[std::size_t(k)])].p;
    }
    return result;
}

struct PatchPoint {
    Vector p;
    Vector ds;
    Vector dt;
};

class Patches {
public:
    Patches(Far::PatchTable const &table, int numControl, std::vector<Vector> const &points)
        : _table(table), _numControl(numControl), _points(points) {}

    PatchPoint Evaluate(int patch, double s, double t) const {
        double weights[3][20];
        _table.EvaluateBasis<double>(FarExt::PatchMap::GetHandle(patch), s, t, weights[0],
                                     weights[1], weights[2]);
        auto const verts = _table.GetPatchVertices(0, patch);
        PatchPoint point = {Vector::Zero(), Vector::Zero(), Vector::Zero()};
        for (int i = 0; i < 20; ++i) {
            Vector const &p = _points[std::size_t(verts[i] - _numControl)];
            point.p += weights[0][i] * p;
            point.ds += weights[1][i] * p;
            point.dt += weights[2][i] * p;
        }
        return point;
    }

private:
    Far::PatchTable const &_table;
    int const _numControl;
    std::vector<Vector> const &_points;
};

// The nearest place of a patch, from one that is near.
PatchPoint findNearest(Patches const &patches, int patch, double s, double t, Vector const &p) {
    double const firstS = s;
    double const firstT = t;
    PatchPoint best = patches.Evaluate(patch, s, t);
    constexpr int kMaxSteps = 4;
    constexpr double kFarthest = 0.3;
    constexpr double kNear = 1e-4;
    for (int i = 0; i < kMaxSteps; ++i) {
        Vector const difference = p - best.p;
        Eigen::Matrix2d metric;
        metric << best.ds.dot(best.ds), best.ds.dot(best.dt), best.ds.dot(best.dt),
            best.dt.dot(best.dt);
        Eigen::Vector2d const step =
            metric.inverse() * Eigen::Vector2d(difference.dot(best.ds), difference.dot(best.dt));
        double const nextS = std::clamp(s + step[0], 0.0, 1.0);
        double const nextT = std::clamp(t + step[1], 0.0, 1.0);
        if (!(std::abs(nextS - firstS) < kFarthest && std::abs(nextT - firstT) < kFarthest)) {
            break;
        }
        PatchPoint const next = patches.Evaluate(patch, nextS, nextT);
        if (!((p - next.p).norm() < (p - best.p).norm())) {
            break;
        }
        best = next;
        s = nextS;
        t = nextT;
        if (step.norm() < kNear) {
            break;
        }
    }
    return best;
}

} // namespace

PatchSamples::PatchSamples(Shape const &shape, int level, FarExt::FirstStep firstStep,
                           double tolerance, std::size_t maxNumSamples)
    : _level(level) {
    FarExt::TopologyRefinerFactory::Options options;
    options.hexSchemeOptions.faceMask = FarExt::FaceMask::Smooth;
    options.hexSchemeOptions.firstStep = firstStep;
    OpenSubdiv::Sdc::Options sdcOptions;
    sdcOptions.SetVtxBoundaryInterpolation(OpenSubdiv::Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    ShapeDescriptor const descriptor(shape);
    _refiner = FarExt::TopologyRefinerFactory::Create(descriptor.Get(), sdcOptions, options);
    FarExt::TopologyRefiner::UniformOptions uniform(level + kNumSteps);
    uniform.fullTopologyInLastLevel = true;
    if (!_refiner || !_refiner->RefineUniform(uniform)) {
        throw std::runtime_error(shape.name + " is not refined");
    }
    Eigen::AlignedBox3d box;
    for (std::size_t i = 0; i < std::size_t(shape.GetNumVertices()); ++i) {
        double const *const p = shape.positions.data() + 3 * i;
        _control.emplace_back(p[0], p[1], p[2]);
        box.extend(_control.back());
    }
    _size = box.diagonal().norm();
    std::vector<float> const positions(shape.positions.begin(), shape.positions.end());
    FarExt::PatchTableFactory::Options patchOptions(level);
    patchOptions.SetPatchPrecision<double>();
    if (tolerance > 0) {
        patchOptions.minIsolationLevel = _refiner->GetHexSchemeOptions().GetSurfaceLevel();
        patchOptions.tolerance = tolerance * _size;
        patchOptions.positions = positions.data();
    }
    _table = FarExt::PatchTableFactory::Create(*_refiner, patchOptions);
    if (!_table) {
        throw std::runtime_error(shape.name + " has no patches");
    }
    findSamples(patchOptions);
    if (std::size_t const number = _samples.size(); number > maxNumSamples) {
        for (std::size_t i = 0; i < maxNumSamples; ++i) {
            _samples[i] = _samples[i * number / maxNumSamples];
        }
        _samples.resize(maxNumSamples);
    }
}

void PatchSamples::findSamples(FarExt::PatchTableFactory::Options const &options) {
    int const fineLevel = _level + kNumSteps;
    std::vector<Point> fine;
    for (Vector const &p : _control) {
        fine.push_back({p});
    }
    FarExt::PrimvarRefinerReal<double> const primvarRefiner(*_refiner);
    for (int i = 1; i <= fineLevel; ++i) {
        std::vector<Point> next(std::size_t(_refiner->GetLevel(i).GetNumVertices()));
        primvarRefiner.Interpolate(i, fine, next);
        fine.swap(next);
    }
    FarExt::PatchMap const map(*_refiner, options);
    FarExt::LimitStencilTableFactoryReal<double>::Options limitOptions;
    limitOptions.level = fineLevel;
    limitOptions.factorizeIntermediateLevels = false;
    auto const limit =
        FarExt::LimitStencilTableFactoryReal<double>::Create(*_refiner, limitOptions);
    FarExt::TopologyLevel const &topology = _refiner->GetLevel(fineLevel);
    std::vector<char> isDone(fine.size(), 0);
    for (int face = 0; face < topology.GetNumFaces(); ++face) {
        auto const verts = topology.GetFaceVertices(face);
        int const ofSurface = topology.GetFaceSurfaceFace(face);
        if (verts.size() != 6 || topology.GetFaceSurfaceFace(face, 1) != ofSurface) {
            continue;
        }
        double uv[12];
        topology.GetFaceSurfaceCoords(face, 0, uv);
        for (int i = 0; i < verts.size(); ++i) {
            char &isVertexDone = isDone[std::size_t(verts[i])];
            auto const place = map.FindPlace(ofSurface, uv[2 * i], uv[2 * i + 1]);
            if (isVertexDone || place.patch == Far::INDEX_INVALID) {
                continue;
            }
            isVertexDone = 1;
            Vector const normal = sum(*limit, limit->GetDuWeights(), verts[i], fine)
                                      .cross(sum(*limit, limit->GetDvWeights(), verts[i], fine));
            _samples.push_back({place.patch, place.s, place.t,
                                sum(*limit, limit->GetWeights(), verts[i], fine),
                                normal.normalized()});
        }
    }
}

std::vector<Vector> PatchSamples::MakePoints(std::vector<int> const &sizes,
                                             std::vector<int> const &indices,
                                             std::vector<double> const &weights) const {
    std::vector<Vector> points;
    std::size_t k = 0;
    for (int const size : sizes) {
        Vector point = Vector::Zero();
        for (std::size_t const end = k + std::size_t(size); k < end; ++k) {
            point += weights[k] * _control[std::size_t(indices[k])];
        }
        points.push_back(point);
    }
    return points;
}

auto PatchSamples::Measure(std::vector<Vector> const &points) const -> std::vector<Error> {
    Patches const patches(*_table, int(_control.size()), points);
    std::vector<Error> errors;
    errors.reserve(_samples.size());
    for (Sample const &sample : _samples) {
        PatchPoint const point = findNearest(patches, sample.patch, sample.s, sample.t, sample.p);
        Vector const normal = point.ds.cross(point.dt).normalized();
        // The angle, in the direction in which the normal leans.
        Vector const x = sample.normal.unitOrthogonal();
        Vector const y = sample.normal.cross(x);
        Eigen::Vector2d const leaning(normal.dot(x), normal.dot(y));
        double const angle = std::atan2(leaning.norm(), normal.dot(sample.normal));
        errors.push_back({(point.p - sample.p).dot(normal) / _size,
                          leaning.norm() > 0 ? Eigen::Vector2d(angle / leaning.norm() * leaning)
                                             : Eigen::Vector2d(0, 0)});
    }
    return errors;
}

} // namespace OpenSubdivHex::Regression

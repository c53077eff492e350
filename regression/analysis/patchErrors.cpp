// SPDX-License-Identifier: Apache-2.0
//
// Prints how far the patches of some meshes are from the limit surface: distances in millionths of the diagonal
// of the box, and angles between normals in degrees, as root mean squares and at most.  Takes some minutes.
#include "far_ext/limitStencilTableFactory.h"
#include "far_ext/patchMap.h"
#include "far_ext/patchTableFactory.h"
#include "far_ext/primvarRefiner.h"
#include "far_ext/topologyRefinerFactory.h"
#include "regression/shapes/shapeDescriptor.h"

#include <Eigen/Geometry>

#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

using namespace OpenSubdivHex;
using namespace OpenSubdivHex::Regression;

namespace {

using Vector = Eigen::Vector3d;

constexpr double kPi = 3.14159265358979323846;

struct Point {
    void Clear() { p.setZero(); }
    void AddWithWeight(Point const &other, double weight) { p += weight * other.p; }
    Vector p = Vector::Zero();
};

Shape makeTorus(int numU, int numV) {
    Shape shape;
    constexpr double kRadius = 0.4;
    for (int i = 0; i < numU; ++i) {
        for (int j = 0; j < numV; ++j) {
            double const u = 2 * kPi * i / numU;
            double const v = 2 * kPi * j / numV;
            double const radius = 1 + kRadius * std::cos(v);
            shape.positions.insert(
                shape.positions.end(),
                {radius * std::cos(u), radius * std::sin(u), kRadius * std::sin(v)});
            int const next = (i + 1) % numU;
            int const nextV = (j + 1) % numV;
            shape.faceVertices.insert(
                shape.faceVertices.end(),
                {numV * i + j, numV * next + j, numV * next + nextV, numV * i + nextV});
            shape.faceSizes.push_back(4);
        }
    }
    return shape;
}

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
    Patches(FarExt::TopologyRefiner const &refiner,
            FarExt::PatchTableFactory::Options const &options, std::vector<Point> const &control)
        : _numControl(int(control.size())),
          _table(FarExt::PatchTableFactory::Create(refiner, options)) {
        if (!_table) {
            throw std::runtime_error("no patches");
        }
        auto const &stencils = *_table->GetLocalPointStencilTable<double>();
        for (int i = 0; i < stencils.GetNumStencils(); ++i) {
            _points.push_back(sum(stencils, stencils.GetWeights(), i, control));
        }
    }

    int GetNum() const { return _table->GetNumPatchesTotal(); }
    PatchPoint Evaluate(int patch, double s, double t) const {
        double weights[3][20];
        _table->EvaluateBasis<double>(FarExt::PatchMap::GetHandle(patch), s, t, weights[0],
                                      weights[1], weights[2]);
        auto const verts = _table->GetPatchVertices(0, patch);
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
    int const _numControl;
    std::unique_ptr<Far::PatchTable const> const _table;
    std::vector<Vector> _points;
};

// The nearest place of a patch, from one that is near.
PatchPoint findNearest(Patches const &patches, FarExt::PatchMap::Place const &place,
                       Vector const &p) {
    double s = place.s;
    double t = place.t;
    PatchPoint best = patches.Evaluate(place.patch, s, t);
    constexpr int kNumSteps = 4;
    constexpr double kFarthest = 0.3;
    for (int i = 0; i < kNumSteps; ++i) {
        Vector const difference = p - best.p;
        Eigen::Matrix2d metric;
        metric << best.ds.dot(best.ds), best.ds.dot(best.dt), best.ds.dot(best.dt),
            best.dt.dot(best.dt);
        Eigen::Vector2d const step =
            metric.inverse() * Eigen::Vector2d(difference.dot(best.ds), difference.dot(best.dt));
        double const nextS = s + step[0];
        double const nextT = t + step[1];
        if (!(std::abs(nextS - place.s) < kFarthest && std::abs(nextT - place.t) < kFarthest)) {
            break;
        }
        PatchPoint const next = patches.Evaluate(place.patch, nextS, nextT);
        if (!((p - next.p).norm() < (p - best.p).norm())) {
            break;
        }
        best = next;
        s = nextS;
        t = nextT;
    }
    return best;
}

// Compares patches to the limits of the vertices that two more steps make, but for those on the edges of
// faces.  With a tolerance, patches are of levels 0 to level.
void printErrors(char const *name, Shape const &shape, int level, bool isTruncated,
                 double tolerance) {
    constexpr int kNumSteps = 2;
    FarExt::TopologyRefinerFactory::Options options;
    options.schemeOptions.faceMask = FarExt::FaceMask::Smooth;
    options.schemeOptions.firstStep =
        isTruncated ? FarExt::FirstStep::Truncate : FarExt::FirstStep::Same;
    OpenSubdiv::Sdc::Options sdcOptions;
    sdcOptions.SetVtxBoundaryInterpolation(OpenSubdiv::Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    ShapeDescriptor const descriptor(shape);
    auto const refiner =
        FarExt::TopologyRefinerFactory::Create(descriptor.Get(), sdcOptions, options);
    int const fineLevel = level + kNumSteps;
    FarExt::TopologyRefiner::UniformOptions uniform(fineLevel);
    uniform.fullTopologyInLastLevel = true;
    if (!refiner || !refiner->RefineUniform(uniform)) {
        throw std::runtime_error("not refined");
    }
    Eigen::AlignedBox3d box;
    std::vector<Point> control(std::size_t(shape.GetNumVertices()));
    std::vector<float> positions;
    for (std::size_t i = 0; i < control.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            positions.push_back(float(shape.positions[3 * i + k]));
            control[i].p[Eigen::Index(k)] = shape.positions[3 * i + k];
        }
        box.extend(control[i].p);
    }
    double const size = box.diagonal().norm();
    std::vector<Point> fine = control;
    FarExt::PrimvarRefinerReal<double> const primvarRefiner(*refiner);
    for (int i = 1; i <= fineLevel; ++i) {
        std::vector<Point> next(std::size_t(refiner->GetLevel(i).GetNumVertices()));
        primvarRefiner.Interpolate(i, fine, next);
        fine.swap(next);
    }
    FarExt::PatchTableFactory::Options patchOptions(level);
    patchOptions.SetPatchPrecision<double>();
    if (tolerance > 0) {
        patchOptions.minIsolationLevel = refiner->GetHexSchemeOptions().GetSurfaceLevel();
        patchOptions.tolerance = tolerance * size;
        patchOptions.positions = positions.data();
    }
    Patches const patches(*refiner, patchOptions, control);
    FarExt::PatchMap const map(*refiner, patchOptions);
    FarExt::LimitStencilTableFactoryReal<double>::Options limitOptions;
    limitOptions.level = fineLevel;
    limitOptions.factorizeIntermediateLevels = false;
    auto const limit = FarExt::LimitStencilTableFactoryReal<double>::Create(*refiner, limitOptions);
    FarExt::TopologyLevel const &topology = refiner->GetLevel(fineLevel);
    std::vector<char> isDone(fine.size(), 0);
    double sums[2] = {0, 0};
    double largest[2] = {0, 0};
    double number = 0;
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
            Vector const p = sum(*limit, limit->GetWeights(), verts[i], fine);
            Vector const normal = sum(*limit, limit->GetDuWeights(), verts[i], fine)
                                      .cross(sum(*limit, limit->GetDvWeights(), verts[i], fine));
            PatchPoint const point = findNearest(patches, place, p);
            Vector const own = point.ds.cross(point.dt);
            double const errors[2] = {1e6 * (p - point.p).norm() / size,
                                      std::atan2(own.cross(normal).norm(), own.dot(normal)) * 180 /
                                          kPi};
            for (int k = 0; k < 2; ++k) {
                sums[k] += errors[k] * errors[k];
                largest[k] = std::max(largest[k], errors[k]);
            }
            ++number;
        }
    }
    std::printf(
        "%-20s level %d%s: %6d patches, distance %.2f (at most %.0f), normals %.3f (at most "
        "%.1f)\n",
        name, level, tolerance > 0 ? " and before" : "", patches.GetNum(),
        std::sqrt(sums[0] / number), largest[0], std::sqrt(sums[1] / number), largest[1]);
    std::fflush(stdout);
}

} // namespace

int main() {
    Shape const torus = makeTorus(14, 8);
    for (int level = 1; level <= 3; ++level) {
        printErrors("torus of quads", torus, level, false, 0);
    }
    printErrors("suzanne", GetShape("suzanne"), 2, false, 0);
    printErrors("suzanne, 1e-4", GetShape("suzanne"), 3, false, 1e-4);
    printErrors("spot, truncated", GetShape("spot"), 1, true, 0);
    return 0;
}

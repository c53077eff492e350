// SPDX-License-Identifier: Apache-2.0
#include "patchDeviation.h"

#include "patchBuilder.h"

#include "far_ext/limit/limitRows.h"
#include "far_ext/primvarRefiner.h"
#include "far_ext/vtr/indexSet.h"
#include "far_ext/vtr/parallel.h"

#include <cmath>
#include <limits>

namespace OpenSubdivHex::FarExt::internal {

using Far::Index;

namespace {

using Vector = PatchDeviation::Vector;

struct Position {
    void Clear() { value = {}; }
    void AddWithWeight(Position const &other, double weight) {
        for (std::size_t i = 0; i < 3; ++i) {
            value[i] += weight * other.value[i];
        }
    }
    Vector value{};
};

void add(Vector &a, double factor, Vector const &b) {
    for (std::size_t i = 0; i < 3; ++i) {
        a[i] += factor * b[i];
    }
}
Vector cross(Vector const &a, Vector const &b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double dot(Vector const &a, Vector const &b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// A point of a Gregory patch, with its derivatives as of the bicubic patch that it is there.
struct PatchPoint {
    Vector p{};
    Vector ds{};
    Vector dt{};
};

PatchPoint evaluate(Vector const *points, double s, double t) {
    constexpr int kGrid[4][4] = {{0, 1, 7, 5}, {2, 3, 8, 6}, {16, 18, 13, 12}, {15, 17, 11, 10}};
    double const places[2][2] = {{1 - s, s}, {1 - t, t}};
    double weights[2][4];
    double derivatives[2][4];
    for (int k = 0; k < 2; ++k) {
        double const a = places[k][0];
        double const b = places[k][1];
        double const w[4] = {a * a * a, 3 * a * a * b, 3 * a * b * b, b * b * b};
        double const d[4] = {-3 * a * a, 3 * a * a - 6 * a * b, 6 * a * b - 3 * b * b, 3 * b * b};
        std::copy_n(w, 4, weights[k]);
        std::copy_n(d, 4, derivatives[k]);
    }
    auto const share = [](double a, double b) { return a + b > 0 ? a / (a + b) : 1; };
    double const shares[4] = {share(s, t), share(t, 1 - s), share(1 - s, 1 - t), share(1 - t, s)};
    PatchPoint result;
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column) {
            int const i = kGrid[row][column];
            Vector point = points[i];
            bool const isInner = (row == 1 || row == 2) && (column == 1 || column == 2);
            if (isInner) {
                double const first = shares[i / 5];
                point = {};
                add(point, first, points[i]);
                add(point, 1 - first, points[i + 1]);
            }
            add(result.p, weights[0][column] * weights[1][row], point);
            add(result.ds, derivatives[0][column] * weights[1][row], point);
            add(result.dt, weights[0][column] * derivatives[1][row], point);
        }
    }
    return result;
}

// A vertex in a cell, and where it is in the patch.
struct Sample {
    Index vert;
    double s;
    double t;
};

// Gathers the vertices that two steps make in a cell of four corners.
class SampleGatherer {
public:
    SampleGatherer(MeshLevels const &mesh, bool isHalf) : _mesh(mesh), _isHalf(isHalf) {}

    struct Point {
        double x;
        double y;
    };
    struct Corners {
        Index face;
        int locals[4];
        Point places[4];
        bool isHalf;
    };

    void Gather(int level, Corners const &cell, int numSteps, std::vector<Sample> &samples) const {
        Level const &parent = _mesh.levels[std::size_t(level)];
        Refinement const &refinement = _mesh.refinements[std::size_t(level)];
        Corners child = cell;
        Point center = {0, 0};
        int const numOfCenter = cell.isHalf ? 2 : 4;
        for (int i = 0; i < numOfCenter; ++i) {
            center.x += cell.places[i].x / numOfCenter;
            center.y += cell.places[i].y / numOfCenter;
        }
        for (int i = 0; i < 4; ++i) {
            Point const place = {(cell.places[i].x + center.x) / 2,
                                 (cell.places[i].y + center.y) / 2};
            child.places[i] = place;
            Index const corner = parent.faceFirstCorner[cell.face] + cell.locals[i];
            samples.push_back(toSample(refinement.GetCornerChildVertex(corner), place));
        }
        if (numSteps == 1) {
            return;
        }
        Gather(level + 1, child, numSteps - 1, samples);
        for (int i = cell.isHalf ? 1 : 0; i < 4; ++i) {
            int const local = cell.locals[i];
            Index const edge = parent.faceEdges[parent.faceFirstCorner[cell.face] + local];
            bool const isFirst =
                parent.edgeFaces[edge][0] == cell.face && parent.edgeFaceLocals[edge][0] == local;
            int const next = (i + 1) % 4;
            Corners ofEdge = {
                refinement.GetEdgeChildFace(edge),
                {0, 1, 2, 3},
                {cell.places[i], cell.places[next], child.places[next], child.places[i]},
                true};
            if (HasHalves(refinement.child->GetFaceSize(ofEdge.face))) {
                std::copy_n(kHexagonHalves[isFirst ? 0 : 1], 4, ofEdge.locals);
            }
            Gather(level + 1, ofEdge, numSteps - 1, samples);
        }
    }

private:
    // In the unit square, or in half a hexagon with sides of length 1, over its long side.
    Sample toSample(Index vert, Point place) const {
        if (!_isHalf) {
            return {vert, place.x, place.y};
        }
        double const t = place.y / (std::sqrt(3.0) / 2);
        return {vert, (place.x - t / 2) / (2 - t), t};
    }

    MeshLevels const &_mesh;
    bool const _isHalf;
};

} // namespace

PatchDeviation::PatchDeviation(TopologyRefiner const &refiner, float const *positions,
                               float const *eye, int lastLevel)
    : _refiner(refiner), _hasEye(eye != nullptr) {
    if (eye) {
        std::copy_n(eye, 3, _eye.begin());
    }
    std::vector<Position> current(std::size_t(refiner.GetLevel(0).GetNumVertices()));
    for (std::size_t i = 0; i < current.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            current[i].value[k] = double(positions[3 * i + k]);
        }
    }
    PrimvarRefinerReal<double> const primvarRefiner(refiner);
    for (int level = 0; level <= lastLevel + 2; ++level) {
        if (level > 0) {
            std::vector<Position> next(std::size_t(refiner.GetLevel(level).GetNumVertices()));
            primvarRefiner.Interpolate(level, current, next);
            current.swap(next);
        }
        _positions.emplace_back();
        for (Position const &position : current) {
            _positions.back().push_back(position.value);
        }
    }
}

CallStatus PatchDeviation::Measure(int depth, std::vector<Index> const &faces,
                                   std::vector<double> &distances) const {
    Hierarchy const &hierarchy = _refiner.GetHierarchy();
    MeshLevels const &mesh = hierarchy.mesh;
    Level const &level = mesh.levels[std::size_t(depth)];
    distances.assign(faces.size(), std::numeric_limits<double>::infinity());
    // The patches of faces that have one for a cell.
    std::vector<Index> measured;
    std::vector<std::size_t> numbers;
    for (std::size_t i = 0; i < faces.size(); ++i) {
        FaceCells const ofFace = FindFaceCells(level, faces[i]);
        if (!ofFace.HasKites(0) && !ofFace.HasKites(1)) {
            measured.push_back(faces[i]);
            numbers.push_back(i);
        }
    }
    PatchCells const cells(mesh, depth, measured);
    PatchBuilder builder(hierarchy, -1, _refiner.GetSchemeOptions(), _refiner.GetHexSchemeOptions(),
                         cells);
    CallStatus status = builder.Build();
    PointStencils<double> stencils;
    if (status.IsOk()) {
        status = builder.MakeStencils(stencils);
    }
    if (!status.IsOk()) {
        return status;
    }
    std::vector<Vector> points;
    std::size_t weight = 0;
    for (int size : stencils.sizes) {
        points.emplace_back();
        for (int k = 0; k < size; ++k, ++weight) {
            add(points.back(), stencils.weights[weight],
                _positions[0][std::size_t(stencils.indices[weight])]);
        }
    }
    // The vertices in each cell, and their limits.
    std::vector<std::vector<Sample>> samples;
    std::vector<Index> verts;
    for (PatchCell const &cell : cells.GetCells(depth)) {
        int const size = level.GetFaceSize(cell.face);
        bool const isHalf = HasHalves(size) || level.IsHalfFace(cell.face);
        double const height = std::sqrt(3.0) / 2;
        SampleGatherer::Corners corners =
            isHalf ? SampleGatherer::Corners{cell.face,
                                             {0, 1, 2, 3},
                                             {{0, 0}, {2, 0}, {1.5, height}, {0.5, height}},
                                             true}
                   : SampleGatherer::Corners{
                         cell.face, {0, 1, 2, 3}, {{0, 0}, {1, 0}, {1, 1}, {0, 1}}, false};
        if (HasHalves(size)) {
            std::copy_n(kHexagonHalves[cell.half], 4, corners.locals);
        }
        samples.emplace_back();
        SampleGatherer(mesh, isHalf).Gather(depth, corners, 2, samples.back());
        for (Sample const &sample : samples.back()) {
            verts.push_back(sample.vert);
        }
    }
    SortUnique(verts);
    LimitRows rows(mesh.levels[std::size_t(depth) + 2], _refiner.GetSchemeOptions(),
                   _refiner.GetHexSchemeOptions());
    if (status = rows.Find(verts); !status.IsOk()) {
        return status;
    }
    std::vector<Vector> const &positions = _positions[std::size_t(depth) + 2];
    std::vector<double> ofCells(samples.size(), 0);
    ParallelFor(Index(samples.size()), [&](Index i) {
        Vector ofPatch[kNumPatchPoints];
        for (int k = 0; k < kNumPatchPoints; ++k) {
            ofPatch[k] = points[std::size_t(
                builder.GetPatchPoints()[std::size_t(kNumPatchPoints) * std::size_t(i) +
                                         std::size_t(k)])];
        }
        for (Sample const &sample : samples[std::size_t(i)]) {
            Index sources[PlainNeighborhoodGatherer::kNumRegular];
            LimitRow const row = rows.GetRow(sample.vert, 0, sources);
            Vector difference{};
            for (int k = 0; k < row.size; ++k) {
                add(difference, row.weights[k], positions[std::size_t(row.sources[k])]);
            }
            PatchPoint const point = evaluate(ofPatch, sample.s, sample.t);
            add(difference, -1, point.p);
            Vector const normal = cross(point.ds, point.dt);
            double const length = std::sqrt(dot(normal, normal));
            double distance = length > 0 ? std::abs(dot(difference, normal)) / length
                                         : std::sqrt(dot(difference, difference));
            if (_hasEye) {
                Vector toEye = _eye;
                add(toEye, -1, point.p);
                distance /= std::sqrt(dot(toEye, toEye));
            }
            ofCells[std::size_t(i)] = std::max(ofCells[std::size_t(i)], distance);
        }
    });
    std::size_t cell = 0;
    for (std::size_t i = 0; i < measured.size(); ++i) {
        distances[numbers[i]] = 0;
        for (; cell < ofCells.size() && cells.GetCells(depth)[cell].face == measured[i]; ++cell) {
            distances[numbers[i]] = std::max(distances[numbers[i]], ofCells[cell]);
        }
    }
    return status;
}

} // namespace OpenSubdivHex::FarExt::internal

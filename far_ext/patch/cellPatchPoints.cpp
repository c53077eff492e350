// SPDX-License-Identifier: Apache-2.0
#include "cellPatchPoints.h"

#include "far_ext/executor.h"
#include "far_ext/vtr/hexRefinement.h"

#include <algorithm>
#include <cassert>

namespace OpenSubdivHex::FarExt::internal {

using Far::Index;

namespace {

// A corner of a quadrilateral as weights of the corners of the cell.
using CornerWeights = std::vector<double>;

// The corners of the patches of a cell, each four, in terms of those of the cell.
std::vector<CornerWeights> findPatchCorners(CellPatch const &cell) {
    int const numCorners = cell.GetNumCorners();
    std::vector<CornerWeights> corners;
    auto const add = [&](std::vector<int> const &ofCell) {
        corners.emplace_back(std::size_t(numCorners));
        for (int const corner : ofCell) {
            corners.back()[std::size_t(corner)] += 1 / double(ofCell.size());
        }
    };
    FaceCells const cells = MakeFaceCells({numCorners, cell.kind != CellKind::Whole});
    for (int half = 0; half < (cells.IsCut() ? 2 : 1); ++half) {
        int const size = cells.GetNumCorners(half);
        std::vector<int> ofCell(static_cast<std::size_t>(size));
        for (int i = 0; i < size; ++i) {
            ofCell[std::size_t(i)] = cells.GetLocal(half, i);
        }
        auto const at = [&](int i) { return ofCell[std::size_t((i + size) % size)]; };
        if (!cells.HasKites(half)) {
            for (int const corner : ofCell) {
                add({corner});
            }
            continue;
        }
        // As VaryingPoints has it.
        std::vector<int> const center =
            cells.AreHalves()
                ? std::vector<int>{at(0), at(0), at(1), at(1), at((size + 1) / 2), at(size / 2 + 1)}
                : ofCell;
        for (int i = 0; i < size; ++i) {
            add({at(i)});
            add({at(i), at(i + 1)});
            add(center);
            add({at(i - 1), at(i)});
        }
    }
    return corners;
}

void findBilinearPoints(CellPatch const &cell, std::vector<double> &rows) {
    // Where the points of a Gregory patch are, by corner.
    constexpr double kThird = 1.0 / 3;
    constexpr double kPlaces[5][2] = {
        {0, 0}, {kThird, 0}, {0, kThird}, {kThird, kThird}, {kThird, kThird}};
    std::size_t const numPoints = cell.patch.sources.size();
    std::vector<CornerWeights> const corners = findPatchCorners(cell);
    rows.assign(corners.size() * 5 * numPoints, 0.0);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        std::size_t const patch = i / 4 * 4;
        for (std::size_t k = 0; k < 5; ++k) {
            double const s = kPlaces[k][0];
            double const t = kPlaces[k][1];
            // From this corner on around the patch.
            double const weights[4] = {(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t};
            double *const row = rows.data() + (5 * i + k) * numPoints;
            for (std::size_t j = 0; j < 4; ++j) {
                CornerWeights const &corner = corners[patch + (i + j) % 4];
                for (std::size_t l = 0; l < corner.size(); ++l) {
                    row[cell.corners[l]] += weights[j] * corner[l];
                }
            }
        }
    }
}

} // namespace

CallStatus FindCellPatchPoints(CellPatch const &cell, LimitMaskFinder &finder,
                               Interpolation interpolation, PatchAges const &ages,
                               std::vector<double> &rows) {
    if (interpolation == Interpolation::Varying) {
        findBilinearPoints(cell, rows);
        return CallStatus();
    }
    ExecutorScope const alone(nullptr, 1);
    Hierarchy hierarchy;
    MeshLevels &mesh = hierarchy.mesh;
    mesh.levels.resize(2);
    mesh.refinements.resize(1);
    BuildPatchLevel(cell.patch, mesh.levels[0]);
    RefineHexagonally(mesh.levels[0], {finder.GetSdcOptions(), finder.GetFaceMask()}, true,
                      mesh.refinements[0], mesh.levels[1]);
    bool const isWhole = cell.kind == CellKind::Whole;
    assert(!isWhole || cell.locals[0] == 0);
    PatchCells const cells =
        isWhole ? PatchCells(mesh, 0, std::vector<Index>{0}) : PatchCells(mesh, 0, PatchCell{0, 0});
    PatchBuilder builder(hierarchy, -1, finder.GetSdcOptions(), finder.GetSchemeOptions(), cells);
    builder.SetMaskFinder(finder);
    PatchAges ofVertices = {ages.steps,
                            std::vector<int>(std::size_t(mesh.levels[0].numVertices), 0)};
    for (std::size_t i = 0; i < cell.corners.size(); ++i) {
        ofVertices.ofVertices[std::size_t(cell.corners[i])] = ages.ofVertices[i];
    }
    builder.SetAges(std::move(ofVertices));
    PointStencils<double> stencils;
    CallStatus status = builder.Build();
    if (status.IsOk()) {
        status = builder.MakeStencils(stencils);
    }
    if (!status.IsOk()) {
        return status;
    }
    std::vector<std::size_t> firsts = {0};
    for (int const size : stencils.sizes) {
        firsts.push_back(firsts.back() + std::size_t(size));
    }
    std::size_t const numPoints = cell.patch.sources.size();
    std::vector<Index> const &points = builder.GetPatchPoints();
    rows.assign(points.size() * numPoints, 0.0);
    for (std::size_t i = 0; i < points.size(); ++i) {
        auto const point = std::size_t(points[i]);
        for (std::size_t k = firsts[point]; k < firsts[point + 1]; ++k) {
            rows[i * numPoints + std::size_t(stencils.indices[k])] = stencils.weights[k];
        }
    }
    return status;
}

} // namespace OpenSubdivHex::FarExt::internal

// SPDX-License-Identifier: Apache-2.0
#include "varyingPoints.h"

#include "far_ext/stencilTableFactory.h"

#include <algorithm>
#include <map>
#include <utility>

namespace OpenSubdivHex::FarExt::internal {

using Far::Index;

namespace {

// Sorts by index, with one term for each.
void sumEqual(std::vector<std::pair<Index, double>> &terms) {
    std::stable_sort(terms.begin(), terms.end(),
                     [](auto const &a, auto const &b) { return a.first < b.first; });
    std::size_t size = 0;
    for (auto const &term : terms) {
        if (size > 0 && terms[size - 1].first == term.first) {
            terms[size - 1].second += term.second;
        } else {
            terms[size++] = term;
        }
    }
    terms.resize(size);
}

} // namespace

VaryingPoints::VaryingPoints(TopologyRefiner const &refiner, int channel, PatchCells const &cells)
    : _refiner(refiner), _channel(channel), _lastLevel(cells.GetLastLevel()) {
    MeshLevels const &mesh = refiner.GetHierarchy().GetMesh(channel);
    std::vector<Index> pointOfVertex(std::size_t(mesh.levels[std::size_t(_lastLevel)].numVertices),
                                     Far::INDEX_INVALID);
    auto const getVertexPoint = [&](Index vert) {
        Index &point = pointOfVertex[std::size_t(vert)];
        if (point == Far::INDEX_INVALID) {
            point = addPoint({vert});
        }
        return point;
    };
    for (int depth = cells.GetFirstLevel(); depth <= _lastLevel; ++depth) {
        Level const &level = mesh.levels[std::size_t(depth)];
        std::map<Index, Index> pointOfEdge;
        for (PatchCell const &cell : cells.GetCells(depth)) {
            FaceCells const faceCells = FindFaceCells(level, cell.face);
            auto const size = std::size_t(faceCells.GetNumCorners(cell.half));
            std::vector<Index> verts(size);
            for (std::size_t i = 0; i < size; ++i) {
                verts[i] = level.GetFaceVertices(cell.face)[faceCells.GetLocal(cell.half, int(i))];
            }
            if (!faceCells.HasKites(cell.half)) {
                for (Index const vert : verts) {
                    _patchPoints.push_back(getVertexPoint(vert));
                }
                continue;
            }
            // The centre of half a polygon lies at a third of the line to the corner or side across.
            std::size_t const across = size / 2 + 1;
            std::size_t const beforeAcross = (size + 1) / 2;
            Index const center = addPoint(
                faceCells.AreHalves() ? std::vector<Index>{verts[0], verts[0], verts[1], verts[1],
                                                           verts[beforeAcross], verts[across]}
                                      : verts);
            auto const getMiddle = [&](std::size_t i) {
                // Diagonals behind edges.
                Index const edge = faceCells.IsCut() && i == 0
                                       ? level.numEdges + cell.face
                                       : level.faceEdges[level.faceFirstCorner[cell.face] +
                                                         faceCells.GetLocal(cell.half, int(i))];
                auto const added = pointOfEdge.try_emplace(edge, Far::INDEX_INVALID);
                if (added.second) {
                    added.first->second = addPoint({verts[i], verts[(i + 1) % size]});
                }
                return added.first->second;
            };
            for (std::size_t i = 0; i < size; ++i) {
                _patchPoints.push_back(getVertexPoint(verts[i]));
                _patchPoints.push_back(getMiddle(i));
                _patchPoints.push_back(center);
                _patchPoints.push_back(getMiddle((i + size - 1) % size));
            }
        }
    }
}

Index VaryingPoints::addPoint(std::vector<Index> const &verts) {
    _verts.insert(_verts.end(), verts.begin(), verts.end());
    _firstVerts.push_back(int(_verts.size()));
    return Index(_firstVerts.size()) - 2;
}

template <typename REAL>
CallStatus VaryingPoints::MakeStencils(PointStencils<REAL> &stencils) const {
    typename StencilTableFactoryReal<REAL>::Options options;
    options.interpolationMode = _channel < 0 ? INTERPOLATE_VARYING : INTERPOLATE_FACE_VARYING;
    options.fvarChannel = std::max(_channel, 0);
    options.generateIntermediateLevels = false;
    options.generateControlVerts = _lastLevel == 0;
    options.maxLevel = _lastLevel;
    CallStatus status;
    auto const table = StencilTableFactoryReal<REAL>::Create(_refiner, options, &status);
    if (!table) {
        return status;
    }
    // In level 0 the table has the values of the user.
    auto const getRow = [&](Index vert) {
        return _channel < 0 || _lastLevel > 0
                   ? vert
                   : _refiner.GetHierarchy().channels[std::size_t(_channel)].valuesOfVertices[vert];
    };
    std::vector<std::pair<Index, double>> terms;
    stencils.sizes.reserve(_firstVerts.size() - 1);
    for (std::size_t point = 0; point + 1 < _firstVerts.size(); ++point) {
        terms.clear();
        double const weight = 1.0 / (_firstVerts[point + 1] - _firstVerts[point]);
        for (int i = _firstVerts[point]; i < _firstVerts[point + 1]; ++i) {
            auto const row = std::size_t(getRow(_verts[std::size_t(i)]));
            int const begin = table->GetOffsets()[row];
            for (int k = begin; k < begin + table->GetSizes()[row]; ++k) {
                terms.emplace_back(table->GetControlIndices()[std::size_t(k)],
                                   weight * double(table->GetWeights()[std::size_t(k)]));
            }
        }
        if (weight < 1) {
            sumEqual(terms);
        }
        stencils.sizes.push_back(int(terms.size()));
        for (auto const &term : terms) {
            stencils.indices.push_back(term.first);
            stencils.weights.push_back(REAL(term.second));
        }
    }
    return CallStatus();
}

template CallStatus VaryingPoints::MakeStencils(PointStencils<float> &) const;
template CallStatus VaryingPoints::MakeStencils(PointStencils<double> &) const;

} // namespace OpenSubdivHex::FarExt::internal

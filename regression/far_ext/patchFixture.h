// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_FAR_EXT_PATCH_FIXTURE_H
#define OPENSUBDIVHEX_REGRESSION_FAR_EXT_PATCH_FIXTURE_H

#include "far_ext/patchTableFactory.h"
#include "regression/reference/reference.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <vector>

namespace OpenSubdivHex::Regression {

/// A point of a patch, with its derivatives by s and t.
struct PatchPoint {
    Eigen::Vector3d p;
    Eigen::Vector3d ds;
    Eigen::Vector3d dt;

    Eigen::Vector3d GetNormal() const { return ds.cross(dt).normalized(); }
};

/// A place of a patch, of which getPoint(i) is point number i.
template <typename GET_POINT>
PatchPoint EvaluatePatch(Far::PatchTable const &table, Far::Index patch, double s, double t,
                         GET_POINT const &getPoint) {
    constexpr int kNumPoints = 20;
    double weights[3][kNumPoints];
    table.EvaluateBasis<double>(FarExt::PatchMap::GetHandle(patch), s, t, weights[0], weights[1],
                                weights[2]);
    Eigen::Vector3d sums[3];
    for (int k = 0; k < 3; ++k) {
        sums[k].setZero();
        for (int i = 0; i < kNumPoints; ++i) {
            sums[k] += weights[k][i] * getPoint(i);
        }
    }
    return {sums[0], sums[1], sums[2]};
}

/// The cells of a face: itself, or the halves on both sides of an infinitely sharp diagonal, and of hexagons.
struct CellsOfFace {
    CellsOfFace(FarExt::TopologyLevel const &level, Far::Index face)
        : size(level.GetFaceVertices(face).size()) {
        if (Sdc::Crease::IsInfinite(level.GetFaceDiagonalSharpness(face))) {
            end = level.GetFaceDiagonalEnd(face);
        } else if (size == 6) {
            end = 3;
        }
    }

    int GetNum() const { return end > 0 ? 2 : 1; }
    int GetNumCorners(int half) const {
        return end > 0 ? FarExt::GetHalfSize(half, size, end) : size;
    }
    int GetLocal(int half, int corner) const {
        return end > 0 ? FarExt::GetPlaceInHalves(half, corner, end) : corner;
    }
    bool HasKites(int half) const { return GetNumCorners(half) != 4; }
    int GetHalfOfEdge(int local) const { return local < end ? 1 : 0; }
    /// The side of its cell that an edge is.
    int GetSide(int local) const {
        return end == 0 ? local : local < end ? local + 1 : local + 1 - end;
    }

    int size;
    int end = 0; ///< of the diagonal
};

/// \brief The patches of one level in double precision: which cell each belongs to, and what they are for
/// given positions, by Far's own basis.
class PatchSurface {
public:
    using Index = Far::Index;

    /// A cell, and its first patch.
    struct Cell {
        Index face;
        int half;
        Index firstPatch;
    };

    /// \p positions are those of the control vertices; patches are of \p level.
    PatchSurface(FarExt::TopologyRefiner const &refiner, int level,
                 ReferenceValues const &positions)
        : _level(refiner.GetLevel(level)), _numControlVerts(refiner.GetLevel(0).GetNumVertices()) {
        FarExt::PatchTableFactory::Options options(level);
        options.SetPatchPrecision<double>();
        FarExt::CallStatus status;
        _table = FarExt::PatchTableFactory::Create(refiner, options, &status);
        if (!_table) {
            ADD_FAILURE() << status.GetErrorMessage();
            return;
        }
        auto const &stencils = *_table->GetLocalPointStencilTable<double>();
        _points = ReferenceValues::Zero(stencils.GetNumStencils(), positions.cols());
        for (int i = 0; i < stencils.GetNumStencils(); ++i) {
            int const offset = stencils.GetOffsets()[std::size_t(i)];
            for (int k = offset; k < offset + stencils.GetSizes()[std::size_t(i)]; ++k) {
                _points.row(i) += stencils.GetWeights()[std::size_t(k)] *
                                  positions.row(stencils.GetControlIndices()[std::size_t(k)]);
            }
        }
        _firstPatches.assign(2 * std::size_t(_level.GetNumFaces()), Far::INDEX_INVALID);
        Index numPatches = 0;
        for (Index face = 0; face < _level.GetNumFaces(); ++face) {
            CellsOfFace const cells(_level, face);
            for (int half = 0; half < cells.GetNum(); ++half) {
                if (cells.GetNum() == 2 ? !_level.IsFaceHole(face, half)
                                        : !_level.IsFaceHole(face)) {
                    _firstPatches[2 * std::size_t(face) + std::size_t(half)] = numPatches;
                    numPatches += cells.HasKites(half) ? cells.GetNumCorners(half) : 1;
                }
            }
        }
        EXPECT_EQ(_table->GetNumPatchesTotal(), numPatches);
    }

    bool IsValid() const { return bool(_table); }
    Far::PatchTable const &GetTable() const { return *_table; }
    ReferenceValues const &GetPoints() const { return _points; }
    FarExt::TopologyLevel const &GetLevel() const { return _level; }

    /// INDEX_INVALID for a hole.
    Index GetFirstPatch(Index face, int half) const {
        return _firstPatches[2 * std::size_t(face) + std::size_t(half)];
    }
    /// By number among the local points.
    Index GetPoint(Index patch, int i) const {
        return _table->GetPatchVertices(0, patch)[i] - _numControlVerts;
    }

    PatchPoint Evaluate(Index patch, double s, double t) const {
        return EvaluatePatch(*_table, patch, s, t, [&](int i) -> Eigen::Vector3d {
            return _points.row(GetPoint(patch, i)).transpose();
        });
    }

    /// \brief At a part of the way along an edge or, with \p local < 0, along the diagonal of the half, as the
    /// cell on one of its sides has it; \p half is of no matter for edges.
    PatchPoint EvaluateSide(Index face, int local, int half, double part) const {
        CellsOfFace const cells(_level, face);
        int side = 0;
        if (local >= 0) {
            half = cells.GetHalfOfEdge(local);
            side = cells.GetSide(local);
        }
        Index patch = GetFirstPatch(face, half);
        if (!cells.HasKites(half)) {
            double const s[] = {part, 1, 1 - part, 0};
            double const t[] = {0, part, 1, 1 - part};
            return Evaluate(patch, s[side], t[side]);
        }
        return part < 0.5
                   ? Evaluate(patch + side, 2 * part, 0)
                   : Evaluate(patch + (side + 1) % cells.GetNumCorners(half), 0, 2 - 2 * part);
    }

    /// Whether there are patches on a side of an edge.
    bool HasSide(Index edge, int side) const {
        auto const faces = _level.GetEdgeFaces(edge);
        if (side >= faces.size()) {
            return false;
        }
        int const local = _level.GetEdgeFaceLocalIndices(edge)[side];
        return GetFirstPatch(faces[side], CellsOfFace(_level, faces[side]).GetHalfOfEdge(local)) !=
               Far::INDEX_INVALID;
    }

private:
    FarExt::TopologyLevel const &_level;
    Index const _numControlVerts;
    std::unique_ptr<Far::PatchTable const> _table;
    ReferenceValues _points;
    std::vector<Index> _firstPatches; // by face and half
};

} // namespace OpenSubdivHex::Regression

#endif

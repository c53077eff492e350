// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_PATCH_EVALUATOR_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_PATCH_EVALUATOR_H

#include "cellPlan.h"
#include "laneKernel.h"

#include <memory>
#include <unordered_map>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief The stencils of a leaf's places as a dense matrix: a row for each place.
template <typename REAL>
struct LeafMatrix {
    LeafMatrix(CellType const &type, LeafPlaces const &places);
    /// That of a type, made when it is first asked for.
    static LeafMatrix const &Get(CellType const &type, LeafPlaces const &places);

    std::size_t numColumns;
    std::vector<REAL> weights;
};

/// \brief Evaluates the inside of many base faces: leaves of one type are collected, from wherever they
/// are, and evaluated kNumLanes at a time.
///
/// A number depends on its own face alone, not on what it is evaluated with.
template <typename REAL>
class PatchEvaluator {
public:
    static constexpr std::size_t kNumLanes = 16;

    /// \param pointSize  numbers of a point
    /// \param maxMemory  bytes that are kept at most beyond Finish()
    PatchEvaluator(int pointSize, std::size_t maxMemory);

    /// \brief Takes a face, whose points are there after Finish() at the latest.
    ///
    /// \param plan           lives until then
    /// \param controlPoints  without gaps
    /// \param result         by place
    void Add(CellType const &type, CellPlan const &plan, REAL const *controlPoints, REAL *result);
    void Finish();

    /// Memory for the points of leaves, in bytes.
    std::size_t GetSize() const { return _memory; }

private:
    // The leaves of a type that wait for others, side by side.
    struct Bucket {
        LeafMatrix<REAL> const *matrix;
        LeafPlaces const *places; // of the plan that made the bucket; all have the same
        std::vector<REAL> block;
        std::size_t numLanes;
        CellPlan::Node const *leaves[kNumLanes];
        REAL *results[kNumLanes];
    };
    struct Key {
        bool operator==(Key const &other) const {
            return type == other.type && numSteps == other.numSteps;
        }
        CellType const *type;
        int numSteps;
    };
    struct Hash {
        std::size_t operator()(Key const &key) const {
            return std::hash<void const *>()(key.type) ^ std::size_t(key.numSteps);
        }
    };

    void descend(CellType const &type, CellPlan const &plan, std::size_t node, std::size_t depth,
                 REAL *result);
    void addLeaf(CellType const &type, CellPlan::Node const &leaf, REAL const *points,
                 REAL *result);
    void evaluate(Bucket &bucket);
    void evaluateRows(Bucket const &bucket, std::size_t begin, std::size_t end);

    std::size_t const _size; // of a point
    std::size_t const _maxMemory;
    std::size_t _memory = 0;
    std::size_t const _stride; // of points in _points, which is padded for whole registers
    std::vector<std::vector<REAL>> _points; // by depth
    std::unordered_map<Key, std::unique_ptr<Bucket>, Hash> _buckets;
    std::vector<Bucket *> _waiting;
    std::vector<REAL> _sums;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif

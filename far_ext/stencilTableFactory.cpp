// SPDX-License-Identifier: Apache-2.0
#include "stencilTableFactory.h"

#include "far_ext/stencil/interpolationMode.h"
#include "far_ext/stencil/stencilMultiplier.h"
#include "far_ext/vtr/report.h"

#include <algorithm>
#include <numeric>

namespace OpenSubdivHex::FarExt {

using Far::ConstIndexArray;
using Far::Index;
using internal::SpareStencils;
using internal::StencilPlaces;
using internal::StencilPlan;
using internal::StencilSelection;
using internal::SymbolicTable;

namespace {

// The arrays of Far's tables are protected; a derived class may fill them.
template <typename REAL>
class WritableTable : public StencilTableTypes<REAL>::Table {
public:
    WritableTable(int numControlVertices, std::vector<int> &&sizes, std::size_t numWeights) {
        this->_numControlVertices = numControlVertices;
        this->_sizes = std::move(sizes);
        internal::ResizeLarge(this->_offsets, this->_sizes.size());
        internal::ResizeLarge(this->_indices, numWeights);
        internal::ResizeLarge(this->_weights, numWeights);
    }

    int const *GetRowSizes() const { return this->_sizes.data(); }
    Index *GetRowOffsets() { return this->_offsets.data(); }
    REAL *GetRowWeights() { return this->_weights.data(); }
    Index *GetRowIndices() { return this->_indices.data(); }
};

// The rows of a selection's table, out of all rows that are made for it.
struct KeptRows {
    std::vector<Index> controls;          // control vertices, whose stencils come first
    std::vector<std::vector<Index>> rows; // of the refinement that makes each level, ascending
    std::vector<Index> indices;           // of each source
};

// Fills an empty table; of all that is made, it has the kept rows, or all when there are none.
template <typename REAL>
class TableFiller {
public:
    TableFiller(SymbolicTable const &symbolic, KeptRows const *kept, WritableTable<REAL> &table)
        : _symbolic(symbolic), _plan(symbolic.GetPlan()), _kept(kept), _table(table) {}

    void Fill() {
        fillControlRows();
        SpareStencils<REAL> spares[2]; // of the level before, too
        internal::FillStencils<REAL>(_symbolic, [&](int level) {
            SpareStencils<REAL> &spare = spares[level % 2];
            spare = SpareStencils<REAL>();
            return level < _plan.firstStored
                       ? spare.Place(_symbolic.GetSupports(level).OfVertices())
                   : _kept ? placeKept(level, spare)
                           : placeAll(level);
        });
    }

private:
    void fillControlRows() {
        for (Index i = 0; i < _plan.numControlStencils; ++i) {
            place(1);
            _table.GetRowIndices()[i] = _kept ? _kept->controls[i] : i;
            _table.GetRowWeights()[i] = REAL(1);
        }
    }

    // Gives the next stencil of the table its place.
    Index place(int size) {
        Index const offset = _nextOffset;
        _table.GetRowOffsets()[_nextStencil++] = offset;
        _nextOffset += size;
        return offset;
    }

    StencilPlaces<REAL> placeAll(int level) {
        Index const numRows = _symbolic.GetRows(level).GetNumRows();
        int const *const sizes = _table.GetRowSizes() + _nextStencil;
        Index *const offsets = _table.GetRowOffsets() + _nextStencil;
        std::exclusive_scan(sizes, sizes + numRows, offsets, _nextOffset);
        if (numRows > 0) {
            _nextOffset = offsets[numRows - 1] + sizes[numRows - 1];
        }
        _nextStencil += numRows;
        return {offsets, _table.GetRowWeights(), _table.GetRowIndices(), nullptr, nullptr};
    }

    StencilPlaces<REAL> placeKept(int level, SpareStencils<REAL> &spare) {
        Index const numRows = _symbolic.GetRows(level).GetNumRows();
        int const *const sizes = _symbolic.GetSizes(level);
        spare.offsets.Resize(numRows);
        Index numSpare = 0;
        Index row = 0;
        auto const placeSpare = [&](Index end) {
            for (; row < end; ++row) {
                spare.offsets[row] = ~numSpare;
                numSpare += sizes[row];
            }
        };
        for (Index const keptRow : _kept->rows[level]) {
            placeSpare(keptRow);
            spare.offsets[row++] = place(sizes[keptRow]);
        }
        placeSpare(numRows);
        spare.weights.Resize(numSpare);
        return {spare.offsets.data(), _table.GetRowWeights(), _table.GetRowIndices(),
                _kept->indices.data(), spare.weights.data()};
    }

    SymbolicTable const &_symbolic;
    StencilPlan const &_plan;
    KeptRows const *_kept;
    WritableTable<REAL> &_table;
    Index _nextStencil = 0;
    Index _nextOffset = 0;
};

template <typename REAL>
std::unique_ptr<WritableTable<REAL>> buildTable(SymbolicTable &symbolic) {
    auto table = std::make_unique<WritableTable<REAL>>(
        symbolic.GetPlan().GetNumVertices(0), symbolic.TakeSizes(), symbolic.GetNumWeights());
    TableFiller<REAL>(symbolic, nullptr, *table).Fill();
    return table;
}

// Overload for kept rows.
template <typename REAL>
std::unique_ptr<WritableTable<REAL>> buildTable(SymbolicTable const &symbolic,
                                                KeptRows const &kept) {
    StencilPlan const &plan = symbolic.GetPlan();
    std::size_t numStencils = kept.controls.size();
    for (std::vector<Index> const &rows : kept.rows) {
        numStencils += rows.size();
    }
    std::vector<int> sizes(kept.controls.size(), 1);
    sizes.reserve(numStencils);
    for (int level = plan.firstStored; level <= plan.lastLevel; ++level) {
        int const *const ofRows = symbolic.GetSizes(level);
        for (Index row : kept.rows[level]) {
            sizes.push_back(ofRows[row]);
        }
    }
    std::size_t const numWeights = std::accumulate(sizes.begin(), sizes.end(), std::size_t(0));
    auto table =
        std::make_unique<WritableTable<REAL>>(plan.GetNumVertices(0), std::move(sizes), numWeights);
    TableFiller<REAL>(symbolic, &kept, *table).Fill();
    return table;
}

// Where the wanted vertices of each level are among those that a selection makes.
std::vector<std::vector<Index>> findRows(StencilPlan const &plan, StencilSelection const &selection,
                                         std::vector<std::vector<Index>> const &wanted) {
    std::vector<std::vector<Index>> rows(wanted.size());
    for (int level = plan.firstStored; level <= plan.lastLevel; ++level) {
        std::vector<Index> const made =
            internal::GetMadeVertices(plan.GetRefinement(level), selection.parts[level - 1]);
        rows[level].reserve(wanted[level].size());
        // Both ascend.
        auto next = made.begin();
        for (Index vert : wanted[level]) {
            next = std::find(next, made.end(), vert);
            rows[level].push_back(Index(next - made.begin()));
        }
    }
    return rows;
}

template <typename OPTIONS>
StencilPlan makePlan(TopologyRefiner const &refiner, OPTIONS const &options) {
    StencilPlan plan = {refiner.GetHierarchy(), refiner.GetHexSchemeOptions()};
    plan.channel = options.interpolationMode == INTERPOLATE_FACE_VARYING ? options.fvarChannel : -1;
    plan.interpolation =
        internal::GetModeInterpolation(refiner, options.interpolationMode, plan.channel);
    plan.factorize = options.factorizeIntermediateLevels;
    plan.lastLevel = std::min(options.maxLevel, refiner.GetMaxLevel());
    plan.firstStored = options.generateIntermediateLevels ? 1 : std::max(1, plan.lastLevel);
    plan.firstBuilt = plan.factorize ? 1 : plan.firstStored;
    if (options.generateControlVerts) {
        plan.numControlStencils = plan.GetNumVertices(0);
    }
    return plan;
}

CallStatus checkBaseFaces(TopologyRefiner const &refiner, ConstIndexArray baseFaces) {
    Index const numFaces = refiner.GetLevel(0).GetNumFaces();
    for (Index face : baseFaces) {
        if (face < 0 || face >= numFaces) {
            return CallStatus(StatusCode::InvalidArgument, ComponentType::Face, face,
                              "there is no base face " + std::to_string(face) + "; the mesh has " +
                                  std::to_string(numFaces));
        }
    }
    return CallStatus();
}

template <typename OPTIONS>
CallStatus checkOptions(TopologyRefiner const &refiner, OPTIONS const &options) {
    if (options.maxLevel < 0) {
        return CallStatus(StatusCode::InvalidArgument, ComponentType::Level, options.maxLevel,
                          "maxLevel " + std::to_string(options.maxLevel) + " is negative");
    }
    return internal::CheckStencilMode(refiner, options.interpolationMode, options.fvarChannel);
}

} // namespace

namespace internal {

CallStatus CheckStencilMode(TopologyRefiner const &refiner, StencilMode mode, int fvarChannel) {
    if (!IsInEnum(mode, INTERPOLATE_FACE_VARYING)) {
        return Failure(StatusCode::InvalidArgument,
                       "there is no interpolationMode " + std::to_string(int(mode)));
    }
    return mode == INTERPOLATE_FACE_VARYING
               ? CheckChannel(fvarChannel, refiner.GetNumFVarChannels())
               : CallStatus();
}

Interpolation GetModeInterpolation(TopologyRefiner const &refiner, StencilMode mode,
                                   int fvarChannel) {
    if (mode == INTERPOLATE_FACE_VARYING) {
        return GetChannelInterpolation(refiner, fvarChannel);
    }
    return mode == INTERPOLATE_VARYING ? Interpolation::Varying : Interpolation::Vertex;
}

} // namespace internal

template <typename REAL>
auto StencilTableFactoryReal<REAL>::Create(TopologyRefiner const &refiner, Options options,
                                           CallStatus *status) -> std::unique_ptr<Table const> {
    if (!internal::Report(checkOptions(refiner, options), status)) {
        return nullptr;
    }
    StencilPlan const plan = makePlan(refiner, options);
    SymbolicTable symbolic(plan);
    if (!internal::Report(symbolic.Form(), status)) {
        return nullptr;
    }
    return buildTable<REAL>(symbolic);
}

template <typename REAL>
auto StencilTableFactoryReal<REAL>::CreateOfFaces(TopologyRefiner const &refiner,
                                                  ConstIndexArray baseFaces, Options options,
                                                  CallStatus *status)
    -> std::unique_ptr<Table const> {
    CallStatus result = checkOptions(refiner, options);
    if (result.IsOk()) {
        result = checkBaseFaces(refiner, baseFaces);
    }
    if (result.IsOk() && !options.factorizeIntermediateLevels) {
        result = CallStatus(StatusCode::Unsupported, ComponentType::NoComponent, Far::INDEX_INVALID,
                            "stencils of some base faces must be factorized");
    }
    if (!internal::Report(result, status)) {
        return nullptr;
    }
    StencilPlan plan = makePlan(refiner, options);
    KeptRows kept;
    if (options.generateControlVerts) {
        kept.controls = GetVerticesOfFaces(refiner, baseFaces, options, 0);
        plan.numControlStencils = Index(kept.controls.size());
    }
    auto const wanted = internal::FindVerticesOfBaseFaces(plan, baseFaces);
    StencilSelection const selection(plan, wanted);
    kept.rows = findRows(plan, selection, wanted);
    kept.indices = selection.indices;
    SymbolicTable symbolic(plan, selection);
    if (!internal::Report(symbolic.Form(), status)) {
        return nullptr;
    }
    return buildTable<REAL>(symbolic, kept);
}

template <typename REAL>
std::vector<Index> StencilTableFactoryReal<REAL>::GetVerticesOfFaces(TopologyRefiner const &refiner,
                                                                     ConstIndexArray baseFaces,
                                                                     Options options, int level,
                                                                     CallStatus *status) {
    CallStatus result = checkOptions(refiner, options);
    if (result.IsOk()) {
        result = checkBaseFaces(refiner, baseFaces);
    }
    if (result.IsOk() && (level < 0 || level > refiner.GetMaxLevel())) {
        result = CallStatus(StatusCode::InvalidArgument, ComponentType::Level, level,
                            "there is no level " + std::to_string(level) + "; the last is " +
                                std::to_string(refiner.GetMaxLevel()));
    }
    if (!internal::Report(result, status)) {
        return {};
    }
    StencilPlan const plan = makePlan(refiner, options);
    return internal::FindVerticesOfFaces(
        plan.hierarchy, level, plan.channel,
        internal::FindFacesOfBaseFaces(plan.hierarchy.mesh, baseFaces, level)[level]);
}

template <typename REAL>
StencilTableSize StencilTableFactoryReal<REAL>::GetSize(TopologyRefiner const &refiner,
                                                        Options options, CallStatus *status) {
    CallStatus result = checkOptions(refiner, options);
    if (!result.IsOk()) {
        internal::Report(result, status);
        return {};
    }
    StencilPlan const plan = makePlan(refiner, options);
    SymbolicTable symbolic(plan);
    if (!internal::Report(symbolic.Form(), status)) {
        return {};
    }
    StencilTableSize size;
    size.numStencils = std::int64_t(symbolic.TakeSizes().size());
    size.numWeights = symbolic.GetNumWeights();
    size.numBytes = size.numStencils * std::int64_t(sizeof(int) + sizeof(Index)) +
                    size.numWeights * std::int64_t(sizeof(Index) + sizeof(REAL));
    return size;
}

template class StencilTableFactoryReal<float>;
template class StencilTableFactoryReal<double>;

} // namespace OpenSubdivHex::FarExt

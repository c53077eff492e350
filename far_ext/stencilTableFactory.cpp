// SPDX-License-Identifier: Apache-2.0
#include "stencilTableFactory.h"

#include "parallel.h"
#include "symbolicTable.h"

#include <algorithm>
#include <numeric>

namespace OpenSubdivHex::FarExt {

using Far::ConstIndexArray;
using Far::Index;
using internal::StencilPlan;
using internal::StencilSelection;
using internal::StencilStep;
using internal::StepSupports;
using internal::Support;
using internal::SymbolicTable;

namespace {

// As many weights as the smallest vector registers hold; loops go by whole ones.
constexpr int kVector = 4;

// Calls function(begin) for vectors that together are 0 ... size; the last may overlap the one
// before.  A size of less than a vector is not for it.
template <typename FUNCTION>
void forEachVector(int size, FUNCTION function) {
    int const last = size - kVector;
    for (int begin = 0; begin < last; begin += kVector) {
        function(begin);
    }
    function(last);
}

// As std::copy_n, faster for some ten elements.
template <typename T>
void copyShort(T const *src, int size, T *dst) {
    if (size < kVector) {
        std::copy_n(src, size, dst);
        return;
    }
    forEachVector(size, [=](int begin) { std::copy_n(src + begin, kVector, dst + begin); });
}

// The stencils of one step.  A row begins at entry offsets[row] of weights and indices; one that
// the table does not have, at entry ~offsets[row] of spareWeights.
template <typename REAL>
struct StepRows {
    REAL *GetWeights(Index row) const {
        Index const offset = offsets[row];
        return offset < 0 ? spareWeights + ~offset : weights + offset;
    }
    void StoreIndices(Index row, Support sources) const {
        Index const offset = offsets[row];
        if (offset < 0) {
            return;
        }
        if (!indexOfSource) {
            copyShort(sources.begin(), sources.size(), indices + offset);
            return;
        }
        std::transform(sources.begin(), sources.end(), indices + offset,
                       [this](Index source) { return indexOfSource[source]; });
    }

    Index const *offsets;
    REAL *weights;
    Index *indices;
    Index const *indexOfSource; // null: sources are indices
    REAL *spareWeights;
};

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

// What a table of a selection has of all that is made for it.
struct KeptRows {
    std::vector<Index> controls;          // control vertices, whose stencils come first
    std::vector<std::vector<Index>> rows; // of the step that makes each level, ascending
    std::vector<Index> indices;           // of each source
};

// What is needed of the stencils of a step to make the next, beside what is in the table.
template <typename REAL>
struct SpareRows {
    internal::Buffer<Index> offsets;
    internal::Buffer<REAL> weights;
};

// The F-vertices of a plain face: rows of the face's circulant mask times its vertices' rows.
template <int SIZE, typename REAL>
void multiplyPlain(double const *mask, REAL const *const *parents, int width, REAL *const *rows) {
    double weights[SIZE];
    std::copy_n(mask, SIZE, weights);
    forEachVector(width, [&](int begin) {
#ifdef _OPENMP
#pragma omp simd
#endif
        for (int k = begin; k < begin + kVector; ++k) {
            double values[SIZE];
            for (int j = 0; j < SIZE; ++j) {
                values[j] = double(parents[j][k]);
            }
            for (int i = 0; i < SIZE; ++i) {
                double sum = weights[0] * values[i];
                for (int j = 1; j < SIZE; ++j) {
                    sum += weights[j] * values[(i + j) % SIZE];
                }
                rows[i][k] = REAL(sum);
            }
        }
    });
}

// Makes the stencils of a step of those of the step before (none: its rows are sources).
//
// Sums are formed in double, in an order that the topology fixes, and rounded once, so that the
// weights of a stencil sum to 1 as well as REAL can.
template <typename REAL>
class StepBuilder {
public:
    StepBuilder(StencilStep const &step, StepSupports const &pSupports,
                StepSupports const &supports, StepRows<REAL> const *pRows,
                StepRows<REAL> const &rows)
        : _step(step), _pSupports(pSupports), _supports(supports), _pRows(pRows), _rows(rows) {}

    // numSources is more than any index in a stencil.
    void Fill(Index numSources) const {
        auto const makeScratch = [numSources] { return Scratch(numSources); };
        constexpr Index kRange = StepSupports::kRange;
        internal::ParallelForRange(
            _step.GetNumFaces(), makeScratch,
            [this](Scratch &scratch, Index begin, Index end) {
                for (Index face = begin; face < end; ++face) {
                    fillFace(face, scratch);
                }
            },
            kRange);
        // V-vertices average F-vertices.
        internal::ParallelForRange(
            _step.GetNumVVertices(), makeScratch,
            [this](Scratch &scratch, Index begin, Index end) {
                for (Index vVertex = begin; vVertex < end; ++vVertex) {
                    if (vVertex + kAhead < end) {
                        prefetchFaceRows(vVertex + kAhead);
                    }
                    fillVVertex(vVertex, scratch);
                }
            },
            kRange);
    }

private:
    // What one thread works on.  What it writes most is in buffers, which share no cache lines with
    // those of another: benchmark table/hexagon/small/warm with 2 threads is 1.1 times as fast.
    struct Scratch {
        explicit Scratch(Index numSources) : position(numSources), sumOfSource(numSources) {}

        std::vector<int> position;         // of each source in the support of the face
        std::vector<double> sumOfSource;   // all 0 between two V-vertices
        internal::Buffer<Index> sources;   // of a V-vertex, see StepSupports
        std::vector<double> mask;          // of a corner, see RefinementMask
        std::vector<double> sums;          // one dense stencil
        internal::Buffer<REAL> block;      // of dense stencils
        std::vector<REAL const *> parents; // dense stencils of a face's vertices over its support
        std::vector<REAL *> rows;          // those of its F-vertices
    };

    void fillFace(Index face, Scratch &scratch) const;
    void fillSourceFace(Index face, Scratch &scratch) const;
    void loadParents(Index face, Scratch &scratch) const;
    void multiply(Index face, Scratch &scratch) const;
    // Benchmark table/quad/large/warm: 1.2 times as fast with it.
    void prefetchFaceRows(Index vVertex) const {
        constexpr std::size_t kBytes = 96; // of most rows and their sources
        _step.ForEachVertexFace(_step.GetVVertexParent(vVertex), [this](Index face, Index row) {
            internal::Prefetch(_rows.GetWeights(row), kBytes);
            internal::Prefetch(_supports.OfFaces()[face].begin(), kBytes);
        });
    }
    static constexpr Index kAhead = 8;
    void fillVVertex(Index vVertex, Scratch &scratch) const;

    REAL const *parentWeights(Index vert) const {
        static constexpr REAL kOne[] = {REAL(1)};
        return _pRows ? _pRows->GetWeights(vert) : kOne;
    }

    StencilStep const &_step;
    StepSupports const &_pSupports;
    StepSupports const &_supports;
    StepRows<REAL> const *_pRows;
    StepRows<REAL> const _rows;
};

// The vertices are sources themselves: the mask is the stencil.
template <typename REAL>
void StepBuilder<REAL>::fillSourceFace(Index face, Scratch &scratch) const {
    Index const *const verts = _step.GetFaceVertices(face);
    int const size = _step.GetFaceSize(face);
    int const width = _supports.OfFaces()[face].size();
    for (int i = 0; i < size; ++i) {
        double const *mask = _step.GetFaceVertexWeights(face, i, scratch.mask);
        scratch.sums.assign(width, 0.0);
        for (int j = 0; j < size; ++j) {
            scratch.sums[scratch.position[_pSupports.OfVertices()[verts[j]][0]]] += mask[j];
        }
        std::transform(scratch.sums.begin(), scratch.sums.end(), scratch.rows[i],
                       [](double weight) { return REAL(weight); });
    }
}

// Finds the stencils of a face's vertices over its support, or makes them.
template <typename REAL>
void StepBuilder<REAL>::loadParents(Index face, Scratch &scratch) const {
    Index const *const verts = _step.GetFaceVertices(face);
    int const size = _step.GetFaceSize(face);
    Support const support = _supports.OfFaces()[face];
    int const width = support.size();
    scratch.parents.resize(size);
    scratch.block.Resize(std::size_t(size) * width);
    int const *const position = scratch.position.data();
    REAL *dense = scratch.block.data();
    for (int j = 0; j < size; ++j, dense += width) {
        Support const pSupport = _pSupports.OfVertices()[verts[j]];
        REAL const *const weights = _pRows->GetWeights(verts[j]);
        if (pSupport == support) {
            scratch.parents[j] = weights;
            continue;
        }
        std::fill_n(dense, width, REAL(0));
        for (int k = 0; k < pSupport.size(); ++k) {
            dense[position[pSupport[k]]] = weights[k];
        }
        scratch.parents[j] = dense;
    }
}

// The face mask times the stencils of the face's vertices.
template <typename REAL>
void StepBuilder<REAL>::multiply(Index face, Scratch &scratch) const {
    int const size = _step.GetFaceSize(face);
    int const width = _supports.OfFaces()[face].size();
    REAL const *const *const parents = scratch.parents.data();
    REAL *const *const rows = scratch.rows.data();
    if (width >= kVector && _step.IsFacePlain(face)) {
        double const *const mask = _step.GetPlainFaceWeights(size);
        switch (size) {
        case 3:
            return multiplyPlain<3>(mask, parents, width, rows);
        case 4:
            return multiplyPlain<4>(mask, parents, width, rows);
        case 5:
            return multiplyPlain<5>(mask, parents, width, rows);
        case 6:
            return multiplyPlain<6>(mask, parents, width, rows);
        }
    }
    scratch.sums.resize(width);
    double *const sums = scratch.sums.data();
    for (int i = 0; i < size; ++i) {
        double const *mask = _step.GetFaceVertexWeights(face, i, scratch.mask);
        std::transform(parents[0], parents[0] + width, sums,
                       [weight = mask[0]](REAL value) { return weight * double(value); });
        for (int j = 1; j < size; ++j) {
            for (int k = 0; k < width; ++k) {
                sums[k] += mask[j] * double(parents[j][k]);
            }
        }
        std::transform(sums, sums + width, rows[i], [](double weight) { return REAL(weight); });
    }
}

// The stencils of a face's F-vertices are the face mask times the stencils of its vertices.
template <typename REAL>
void StepBuilder<REAL>::fillFace(Index face, Scratch &scratch) const {
    Support const support = _supports.OfFaces()[face];
    Index const firstRow = _step.GetFaceFirstRow(face);
    int const size = _step.GetFaceSize(face);
    scratch.rows.resize(size);
    for (int i = 0; i < size; ++i) {
        scratch.rows[i] = _rows.GetWeights(firstRow + i);
        _rows.StoreIndices(firstRow + i, support);
    }
    for (int k = 0; k < support.size(); ++k) {
        scratch.position[support[k]] = k;
    }
    if (_pRows) {
        loadParents(face, scratch);
        multiply(face, scratch);
    } else {
        fillSourceFace(face, scratch);
    }
}

// The stencil of a V-vertex is a sum of those of the step before and of F-vertices.
template <typename REAL>
void StepBuilder<REAL>::fillVVertex(Index vVertex, Scratch &scratch) const {
    double *const sumOfSource = scratch.sumOfSource.data();
    Index const pVert = _step.GetVVertexParent(vVertex);
    internal::RefinementMask::VertexMask const mask = _step.GetVertexMask(pVert);
    auto const add = [=](double weight, REAL const *weights, Support sources) {
        for (int k = 0; k < sources.size(); ++k) {
            sumOfSource[sources[k]] += weight * double(weights[k]);
        }
    };
    // The neighbors first, so that it does not matter which of them is left and right.
    for (int i = 0; i < mask.numNeighbors; ++i) {
        Index const neighbor = mask.neighbors[i];
        add(mask.neighborWeights[i], parentWeights(neighbor), _pSupports.OfVertices()[neighbor]);
    }
    add(mask.vertexWeight, parentWeights(pVert), _pSupports.OfVertices()[pVert]);
    if (mask.faceWeight > 0) {
        _step.ForEachVertexFace(pVert, [&](Index face, Index row) {
            add(mask.faceWeight, _rows.GetWeights(row), _supports.OfFaces()[face]);
        });
    }
    Support const support = _supports.OfVVertex(vVertex, scratch.sources);
    REAL *const weights = _rows.GetWeights(vVertex);
    for (int k = 0; k < support.size(); ++k) {
        double &sum = sumOfSource[support[k]];
        weights[k] = REAL(sum);
        sum = 0;
    }
    _rows.StoreIndices(vVertex, support);
}

// Fills an empty table; of all that is made, it has the kept rows, or all when there are none.
template <typename REAL>
class TableBuilder {
public:
    TableBuilder(SymbolicTable const &symbolic, KeptRows const *kept, WritableTable<REAL> &table)
        : _symbolic(symbolic), _plan(symbolic.GetPlan()), _kept(kept), _table(table) {}

    void Fill() {
        fillControlRows();
        SpareRows<REAL> pSpare;
        StepRows<REAL> pRows{};
        for (int level = _plan.firstBuilt; level <= _plan.lastLevel; ++level) {
            bool const isStored = level >= _plan.firstStored;
            SpareRows<REAL> spare;
            StepRows<REAL> const rows = !isStored ? placeUnstored(level, spare)
                                        : _kept   ? placeKept(level, spare)
                                                  : placeAll(level);
            StepBuilder<REAL>(_symbolic.GetStep(level), _symbolic.GetParentSupports(level),
                              _symbolic.GetSupports(level),
                              _plan.HasParentStencils(level) ? &pRows : nullptr, rows)
                .Fill(_symbolic.GetNumSources(level));
            pRows = rows;
            pSpare = std::move(spare);
        }
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

    StepRows<REAL> placeAll(int level) {
        Index const numRows = _symbolic.GetStep(level).GetNumRows();
        int const *const sizes = _table.GetRowSizes() + _nextStencil;
        Index *const offsets = _table.GetRowOffsets() + _nextStencil;
        std::exclusive_scan(sizes, sizes + numRows, offsets, _nextOffset);
        if (numRows > 0) {
            _nextOffset = offsets[numRows - 1] + sizes[numRows - 1];
        }
        _nextStencil += numRows;
        return {offsets, _table.GetRowWeights(), _table.GetRowIndices(), nullptr, nullptr};
    }

    StepRows<REAL> placeUnstored(int level, SpareRows<REAL> &spare) const {
        std::vector<Support> const &supports = _symbolic.GetSupports(level).OfVertices();
        spare.offsets.Resize(supports.size());
        Index numSpare = 0;
        for (std::size_t row = 0; row < supports.size(); ++row) {
            spare.offsets[row] = ~numSpare;
            numSpare += supports[row].size();
        }
        spare.weights.Resize(numSpare);
        return {spare.offsets.data(), nullptr, nullptr, nullptr, spare.weights.data()};
    }

    StepRows<REAL> placeKept(int level, SpareRows<REAL> &spare) {
        Index const numRows = _symbolic.GetStep(level).GetNumRows();
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
    TableBuilder<REAL>(symbolic, nullptr, *table).Fill();
    return table;
}

// The same of kept rows.
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
    TableBuilder<REAL>(symbolic, &kept, *table).Fill();
    return table;
}

// The vertices of each level, or their values, in the faces that lie in base faces; those of levels
// that the table does not have are left out.
std::vector<std::vector<Index>> findVerticesOfBaseFaces(StencilPlan const &plan,
                                                        ConstIndexArray baseFaces) {
    auto const faces = internal::FindFacesOfBaseFaces(plan.refiner, baseFaces, plan.lastLevel);
    std::vector<std::vector<Index>> verts(faces.size());
    for (int level = plan.firstStored; level <= plan.lastLevel; ++level) {
        verts[level] =
            internal::FindVerticesOfFaces(plan.refiner.GetLevel(level), plan.channel, faces[level]);
    }
    return verts;
}

// Where the wanted vertices of each level are among those that a selection makes.
std::vector<std::vector<Index>> findRows(StencilPlan const &plan, StencilSelection const &selection,
                                         std::vector<std::vector<Index>> const &wanted) {
    std::vector<std::vector<Index>> rows(wanted.size());
    for (int level = plan.firstStored; level <= plan.lastLevel; ++level) {
        std::vector<Index> const made =
            internal::FindMadeVertices(plan.GetLevel(level - 1), selection.parts[level - 1]);
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
    int const channel =
        options.interpolationMode == INTERPOLATE_FACE_VARYING ? options.fvarChannel : -1;
    bool const isLinear = options.interpolationMode == INTERPOLATE_VARYING ||
                          (channel >= 0 && refiner.GetFVarLinearInterpolation(channel) ==
                                               Sdc::Options::FVAR_LINEAR_ALL);
    int const lastLevel = std::min(options.maxLevel, refiner.GetMaxLevel());
    int const firstStored = options.generateIntermediateLevels ? 1 : std::max(1, lastLevel);
    StencilPlan plan = {refiner,
                        channel,
                        isLinear ? Interpolation::Varying : Interpolation::Vertex,
                        options.factorizeIntermediateLevels,
                        lastLevel,
                        firstStored,
                        options.factorizeIntermediateLevels ? 1 : firstStored,
                        0};
    if (options.generateControlVerts) {
        plan.numControlStencils = plan.GetNumVertices(0);
    }
    return plan;
}

Status checkBaseFaces(TopologyRefiner const &refiner, ConstIndexArray baseFaces) {
    Index const numFaces = refiner.GetLevel(0).GetNumFaces();
    for (Index face : baseFaces) {
        if (face < 0 || face >= numFaces) {
            return Status(StatusCode::InvalidArgument, ComponentType::Face, face,
                          "there is no base face " + std::to_string(face) + "; the mesh has " +
                              std::to_string(numFaces));
        }
    }
    return Status();
}

template <typename OPTIONS>
Status checkOptions(TopologyRefiner const &refiner, OPTIONS const &options) {
    if (options.maxLevel < 0) {
        return Status(StatusCode::InvalidArgument, ComponentType::Level, options.maxLevel,
                      "maxLevel " + std::to_string(options.maxLevel) + " is negative");
    }
    if (!internal::IsInEnum(options.interpolationMode, INTERPOLATE_FACE_VARYING)) {
        return Status(StatusCode::InvalidArgument, ComponentType::None, Far::INDEX_INVALID,
                      "there is no interpolationMode " +
                          std::to_string(int(options.interpolationMode)));
    }
    bool const hasChannel =
        0 <= options.fvarChannel && options.fvarChannel < refiner.GetNumFVarChannels();
    if (options.interpolationMode == INTERPOLATE_FACE_VARYING && !hasChannel) {
        return Status(StatusCode::InvalidArgument, ComponentType::None, Far::INDEX_INVALID,
                      "there is no face-varying channel " + std::to_string(options.fvarChannel) +
                          "; the mesh has " + std::to_string(refiner.GetNumFVarChannels()));
    }
    return Status();
}

} // namespace

template <typename REAL>
auto StencilTableFactoryReal<REAL>::Create(TopologyRefiner const &refiner, Options options,
                                           Status *status) -> std::unique_ptr<Table const> {
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
                                                  Status *status) -> std::unique_ptr<Table const> {
    Status result = checkOptions(refiner, options);
    if (result.IsOk()) {
        result = checkBaseFaces(refiner, baseFaces);
    }
    if (result.IsOk() && !options.factorizeIntermediateLevels) {
        result = Status(StatusCode::Unsupported, ComponentType::None, Far::INDEX_INVALID,
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
    auto const wanted = findVerticesOfBaseFaces(plan, baseFaces);
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
                                                                     Status *status) {
    Status result = checkOptions(refiner, options);
    if (result.IsOk()) {
        result = checkBaseFaces(refiner, baseFaces);
    }
    if (result.IsOk() && (level < 0 || level > refiner.GetMaxLevel())) {
        result = Status(StatusCode::InvalidArgument, ComponentType::Level, level,
                        "there is no level " + std::to_string(level) + "; the last is " +
                            std::to_string(refiner.GetMaxLevel()));
    }
    if (!internal::Report(result, status)) {
        return {};
    }
    StencilPlan const plan = makePlan(refiner, options);
    return internal::FindVerticesOfFaces(
        refiner.GetLevel(level), plan.channel,
        internal::FindFacesOfBaseFaces(refiner, baseFaces, level)[level]);
}

template <typename REAL>
StencilTableSize StencilTableFactoryReal<REAL>::EstimateSize(TopologyRefiner const &refiner,
                                                             Options options, Status *status) {
    Status result = checkOptions(refiner, options);
    if (!result.IsOk()) {
        internal::Report(result, status);
        return {};
    }
    StencilPlan const plan = makePlan(refiner, options);
    StencilTableSize size;
    if (!internal::Report(internal::EstimateTableSize(plan, sizeof(REAL), size), status)) {
        return {};
    }
    return size;
}

template class StencilTableFactoryReal<float>;
template class StencilTableFactoryReal<double>;

} // namespace OpenSubdivHex::FarExt

// SPDX-License-Identifier: Apache-2.0
#include "stencilTableFactory.h"

#include "fvarLevel.h"
#include "parallel.h"
#include "stencilSelection.h"
#include "stencilSupports.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <numeric>

namespace OpenSubdivHex::FarExt {

using Far::ConstIndexArray;
using Far::Index;
using internal::StencilStep;
using internal::StepSupports;
using internal::Support;

namespace {

constexpr std::int64_t kMaxCount = StepSupports::kMaxNumWeights;

Status checkCount(int level, std::int64_t count, char const *name) {
    if (count <= kMaxCount) {
        return Status();
    }
    return Status(StatusCode::TooLarge, ComponentType::Level, level,
                  "the stencil table would have at least " + std::to_string(count) + " " + name +
                      " up to level " + std::to_string(level) + ", more than the " +
                      std::to_string(kMaxCount) + " that Far's 32-bit offsets reach");
}

// The stencils of one step: entries [offsets[row], offsets[row] + size) of weights and, where they
// are wanted, of indices belong to a row.
template <typename REAL>
struct StepRows {
    Index *offsets;
    Index *indices; // null: only the weights are stored
    REAL *weights;
};

// Sizes a vector without touching its memory in pages of 4 KiB, or by one thread alone.
template <typename T>
void resizeLarge(std::vector<T> &array, std::size_t size) {
    array.reserve(size);
    internal::PrepareArray(array.data(), size * sizeof(T));
    array.resize(size);
}

// The arrays of Far's tables are protected; a derived class may fill them.
template <typename REAL>
class WritableTable : public StencilTableTypes<REAL>::Table {
public:
    WritableTable(int numControlVertices, std::vector<int> sizes, std::size_t numWeights) {
        this->_numControlVertices = numControlVertices;
        this->_sizes = std::move(sizes);
        resizeLarge(this->_offsets, this->_sizes.size());
        resizeLarge(this->_indices, numWeights);
        resizeLarge(this->_weights, numWeights);
    }

    int const *GetRowSizes(Index first) const { return this->_sizes.data() + first; }
    // The stencils from number first on.
    StepRows<REAL> GetRows(Index first) {
        return {this->_offsets.data() + first, this->_indices.data(), this->_weights.data()};
    }
};

// The weights alone of the stencils of a step that does not go into the table.
template <typename REAL>
struct TemporaryRows {
    TemporaryRows(std::size_t numStencils, std::size_t numWeights) {
        offsets.Resize(numStencils);
        weights.Resize(numWeights);
    }
    StepRows<REAL> GetRows() { return {offsets.data(), nullptr, weights.data()}; }

    internal::Buffer<Index> offsets;
    internal::Buffer<REAL> weights;
};

template <typename REAL>
void fillControlRows(StepRows<REAL> const &rows, Index numControlVertices) {
    for (Index vert = 0; vert < numControlVertices; ++vert) {
        rows.offsets[vert] = vert;
        rows.indices[vert] = vert;
        rows.weights[vert] = REAL(1);
    }
}

// The F-vertices of a plain face: rows of the face's circulant mask times its vertices' rows.  The
// rows of both are stride apart.
template <int SIZE, typename REAL>
void multiplyPlain(double const *mask, double const *block, std::size_t stride, REAL *result) {
    double weights[SIZE];
    std::copy_n(mask, SIZE, weights);
#ifdef _OPENMP
#pragma omp simd
#endif
    for (std::size_t k = 0; k < stride; ++k) {
        double values[SIZE];
        for (int j = 0; j < SIZE; ++j) {
            values[j] = block[j * stride + k];
        }
        for (int i = 0; i < SIZE; ++i) {
            double sum = weights[0] * values[i];
            for (int j = 1; j < SIZE; ++j) {
                sum += weights[j] * values[(i + j) % SIZE];
            }
            result[i * stride + k] = REAL(sum);
        }
    }
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
        internal::ParallelForRange(_step.GetNumFaces(), makeScratch,
                                   [this](Scratch &scratch, Index begin, Index end) {
                                       for (Index face = begin; face < end; ++face) {
                                           fillFace(face, scratch);
                                       }
                                   });
        // V-vertices average F-vertices.
        internal::ParallelForRange(
            _step.GetNumVVertices(), makeScratch, [this](Scratch &scratch, Index begin, Index end) {
                auto group = _supports.OfGroups(begin / internal::kParallelRange).begin();
                while (begin < end) {
                    begin = fillVVertices(begin, end, *group++, scratch);
                }
            });
    }

private:
    // What one thread works on.
    struct Scratch {
        explicit Scratch(Index numSources) : position(numSources), group(numSources) {}

        std::vector<int> position;  // of each source in the support of the face
        std::vector<double> mask;   // of a corner, see RefinementMask
        std::vector<int> positions; // of a parent's sources
        std::vector<double> block;  // dense stencils of a face's vertices over its support
        std::vector<REAL> result;   // one or more rows

        internal::VVertexGroup group;
        std::vector<double> sums; // one dense stencil
        std::vector<Index> rowIndices;
    };

    void fillFace(Index face, Scratch &scratch) const;
    void fillSourceFace(Index face, Scratch &scratch) const;
    void loadParents(Index face, std::size_t stride, Scratch &scratch) const;
    void multiply(Index face, std::size_t stride, Scratch &scratch) const;
    Index fillVVertices(Index begin, Index end, Support all, Scratch &scratch) const;

    // The weights of a row of the step before; only sources have none.
    REAL const *parentWeights(Index row) const { return _pRows->weights + _pRows->offsets[row]; }

    REAL const *termWeights(internal::VVertexGroup::Term const &term) const {
        static constexpr REAL kOne[] = {REAL(1)};
        return term.isFVertex ? _rows.weights + _rows.offsets[term.row]
               : _pRows       ? parentWeights(term.row)
                              : kOne;
    }

    void storeFaceRow(Index face, int corner, REAL const *weights) const {
        Support const support = _supports.OfFaces()[face];
        Index const offset = _rows.offsets[_step.GetFaceFirstRow(face) + corner];
        std::copy_n(weights, support.size(), _rows.weights + offset);
        if (_rows.indices) {
            std::copy(support.begin(), support.end(), _rows.indices + offset);
        }
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
    scratch.positions.resize(size);
    for (int j = 0; j < size; ++j) {
        scratch.positions[j] = scratch.position[_pSupports.OfVertices()[verts[j]][0]];
    }
    int const width = _supports.OfFaces()[face].size();
    scratch.result.resize(width);
    for (int i = 0; i < size; ++i) {
        double const *mask = _step.GetFaceVertexWeights(face, i, scratch.mask);
        scratch.sums.assign(width, 0.0);
        for (int j = 0; j < size; ++j) {
            scratch.sums[scratch.positions[j]] += mask[j];
        }
        std::transform(scratch.sums.begin(), scratch.sums.end(), scratch.result.begin(),
                       [](double weight) { return REAL(weight); });
        storeFaceRow(face, i, scratch.result.data());
    }
}

// Makes the stencils of a face's vertices dense over its support.
template <typename REAL>
void StepBuilder<REAL>::loadParents(Index face, std::size_t stride, Scratch &scratch) const {
    Index const *const verts = _step.GetFaceVertices(face);
    int const size = _step.GetFaceSize(face);
    Support const support = _supports.OfFaces()[face];
    scratch.block.resize(size * stride);
    scratch.positions.resize(support.size());
    Support located = support;
    for (int j = 0; j < size; ++j) {
        Support const pSupport = _pSupports.OfVertices()[verts[j]];
        REAL const *weights = parentWeights(verts[j]);
        double *const dense = scratch.block.data() + j * stride;
        if (pSupport == support) {
            double *const end = std::transform(weights, weights + support.size(), dense,
                                               [](REAL weight) { return double(weight); });
            std::fill(end, dense + stride, 0.0);
            continue;
        }
        std::fill(dense, dense + stride, 0.0);
        if (!(pSupport == located)) {
            std::transform(pSupport.begin(), pSupport.end(), scratch.positions.begin(),
                           [&](Index source) { return scratch.position[source]; });
            located = pSupport;
        }
        int const *const positions = scratch.positions.data();
        for (int k = 0; k < pSupport.size(); ++k) {
            dense[positions[k]] = double(weights[k]);
        }
    }
}

// The face mask times the dense stencils of the face's vertices.
template <typename REAL>
void StepBuilder<REAL>::multiply(Index face, std::size_t stride, Scratch &scratch) const {
    int const size = _step.GetFaceSize(face);
    scratch.result.resize(size * stride);
    REAL *result = scratch.result.data();
    if (_step.IsFacePlain(face)) {
        double const *const mask = _step.GetPlainFaceWeights(size);
        switch (size) {
        case 3:
            return multiplyPlain<3>(mask, scratch.block.data(), stride, result);
        case 4:
            return multiplyPlain<4>(mask, scratch.block.data(), stride, result);
        case 5:
            return multiplyPlain<5>(mask, scratch.block.data(), stride, result);
        case 6:
            return multiplyPlain<6>(mask, scratch.block.data(), stride, result);
        }
    }
    scratch.sums.resize(stride);
    double *const sums = scratch.sums.data();
    for (int i = 0; i < size; ++i) {
        double const *mask = _step.GetFaceVertexWeights(face, i, scratch.mask);
        double const *parent = scratch.block.data();
        std::transform(parent, parent + stride, sums,
                       [weight = mask[0]](double value) { return weight * value; });
        for (int j = 1; j < size; ++j) {
            parent += stride;
            for (std::size_t k = 0; k < stride; ++k) {
                sums[k] += mask[j] * parent[k];
            }
        }
        result =
            std::transform(sums, sums + stride, result, [](double weight) { return REAL(weight); });
    }
}

// The stencils of a face's F-vertices are the face mask times the stencils of its vertices.
template <typename REAL>
void StepBuilder<REAL>::fillFace(Index face, Scratch &scratch) const {
    Support const support = _supports.OfFaces()[face];
    for (int k = 0; k < support.size(); ++k) {
        scratch.position[support[k]] = k;
    }
    if (!_pRows) {
        fillSourceFace(face, scratch);
        return;
    }
    // Whole vectors are faster; what is behind the support stays 0.
    constexpr std::size_t kVector = 4;
    std::size_t const stride = (support.size() + kVector - 1) / kVector * kVector;
    loadParents(face, stride, scratch);
    multiply(face, stride, scratch);
    for (int i = 0; i < _step.GetFaceSize(face); ++i) {
        storeFaceRow(face, i, scratch.result.data() + i * stride);
    }
}

// The stencils of a group of V-vertices are sums of those of the step before and of F-vertices.
template <typename REAL>
Index StepBuilder<REAL>::fillVVertices(Index begin, Index end, Support all,
                                       Scratch &scratch) const {
    internal::VVertexGroup &group = scratch.group;
    Index const groupEnd =
        group.Take(_step, _pSupports.OfVertices(), _supports.OfFaces(), begin, end, true);
    group.Locate(all.begin(), all.size());
    // One more than is kept: see ForEachSource.
    scratch.rowIndices.resize(std::size_t(all.size()) + 1);
    scratch.result.resize(std::size_t(all.size()) + 1);
    Index *const rowIndices = scratch.rowIndices.data();
    REAL *const rowWeights = scratch.result.data();
    for (int i = 0; i < groupEnd - begin; ++i) {
        scratch.sums.assign(all.size(), 0.0);
        double *const sums = scratch.sums.data();
        auto const *const termsEnd = group.EndTerms(i);
        for (auto const *term = group.BeginTerms(i); term != termsEnd; ++term) {
            int const *const positions = group.GetPositions(term->support);
            int const size = group.GetSupports()[term->support].size();
            REAL const *const weights = termWeights(*term);
            double const weight = term->weight;
            if (term + 1 != termsEnd && term[1].support == term->support) {
                // Mostly the vertex itself and the F-face: half the scattered writes.
                REAL const *const nextWeights = termWeights(*++term);
                double const nextWeight = term->weight;
                for (int k = 0; k < size; ++k) {
                    sums[positions[k]] +=
                        weight * double(weights[k]) + nextWeight * double(nextWeights[k]);
                }
                continue;
            }
            for (int k = 0; k < size; ++k) {
                sums[positions[k]] += weight * double(weights[k]);
            }
        }
        int const size = group.ForEachSource(i, [=](int n, int k) {
            rowIndices[n] = all[k];
            rowWeights[n] = REAL(sums[k]);
        });
        Index const offset = _rows.offsets[begin + i];
        std::copy_n(rowWeights, size, _rows.weights + offset);
        if (_rows.indices) {
            std::copy_n(rowIndices, size, _rows.indices + offset);
        }
    }
    return groupEnd;
}

// Which levels of which mesh the options ask for.
struct Plan {
    template <typename OPTIONS>
    Plan(TopologyRefiner const &topologyRefiner, OPTIONS const &options)
        : refiner(topologyRefiner),
          channel(options.interpolationMode == INTERPOLATE_FACE_VARYING ? options.fvarChannel : -1),
          interpolation(isLinear(options.interpolationMode) ? Interpolation::Varying
                                                            : Interpolation::Vertex),
          factorize(options.factorizeIntermediateLevels),
          lastLevel(std::min(options.maxLevel, refiner.GetMaxLevel())),
          firstStored(options.generateIntermediateLevels ? 1 : std::max(1, lastLevel)),
          firstBuilt(factorize ? 1 : firstStored),
          numControlStencils(options.generateControlVerts ? GetNumVertices(0) : 0) {}

    // The level of the mesh or, for face-varying stencils, of the value mesh.
    TopologyLevel GetLevel(int level) const {
        TopologyLevel const &mesh = refiner.GetLevel(level);
        return channel < 0 ? mesh
                           : TopologyLevel(&mesh.GetTopology().fvarLevels[channel]->topology);
    }
    // What a stencil is made for, and what stencils refer to.
    Index GetNumVertices(int level) const {
        TopologyLevel const &mesh = refiner.GetLevel(level);
        return channel < 0 ? mesh.GetNumVertices() : mesh.GetNumFVarValues(channel);
    }
    // What the vertices of a level stand for as sources; of values, those that the user has.
    std::vector<Index> GetSources(int level) const {
        std::vector<Index> sources(GetLevel(level).GetNumVertices());
        std::iota(sources.begin(), sources.end(), 0);
        return GetSources(level, std::move(sources));
    }
    std::vector<Index> GetSources(int level, std::vector<Index> verts) const {
        if (channel >= 0 && level == 0) {
            internal::Buffer<Index> const &values =
                refiner.GetLevel(0).GetTopology().fvarLevels[channel]->valuesOfVertices;
            std::transform(verts.begin(), verts.end(), verts.begin(),
                           [&](Index vert) { return values[vert]; });
        }
        return verts;
    }
    // How many sources the stencils of a level have to choose from.
    Index GetNumSources(int level) const { return GetNumVertices(factorize ? 0 : level - 1); }

    // Whether the stencils of a level are made from those of the level before.
    bool HasParentStencils(int level) const { return factorize && level > firstBuilt; }

    TopologyRefiner const &refiner;
    int channel; // face-varying channel, or -1
    Interpolation interpolation;
    bool factorize;
    int lastLevel;
    int firstStored; // in the table, behind the control vertices
    int firstBuilt;  // as a source of later levels, or to be stored
    Index numControlStencils;

private:
    bool isLinear(StencilMode mode) const {
        return mode == INTERPOLATE_VARYING ||
               (channel >= 0 &&
                refiner.GetFVarLinearInterpolation(channel) == Sdc::Options::FVAR_LINEAR_ALL);
    }
};

// The part of a refinement that makes some vertices, in terms of the control vertices.
struct Selection {
    // wanted: vertices of each level of the plan, ascending.
    Selection(Plan const &plan, std::vector<std::vector<Index>> wanted) {
        std::vector<TopologyLevel> levels;
        for (int level = 0; level <= plan.lastLevel; ++level) {
            levels.push_back(plan.GetLevel(level));
        }
        parts = internal::FindStencilParts(levels, plan.refiner.GetHexSchemeOptions(),
                                           plan.interpolation, std::move(wanted));
        if (!parts.empty()) {
            sources = plan.GetSources(0, parts[0].verts);
        }
        indices = sources;
        std::sort(indices.begin(), indices.end());
        indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
        for (Index &source : sources) {
            source =
                Index(std::lower_bound(indices.begin(), indices.end(), source) - indices.begin());
        }
    }

    std::vector<internal::StencilStep::Part> parts; // of the steps that make levels 1, 2 ...
    std::vector<Index> sources;                     // of parts[0].verts, as numbers in indices
    std::vector<Index> indices;                     // ascending; what the stencils refer to
};

// The supports of all stencils, and the sizes of those to be stored.
class SymbolicTable {
public:
    explicit SymbolicTable(Plan const &plan) : _plan(plan) {
        _sources.resize(plan.factorize ? 1 : plan.lastLevel - plan.firstBuilt + 1);
        for (int level = plan.firstBuilt; level <= plan.lastLevel; ++level) {
            _steps.emplace_back(plan.GetLevel(level - 1), plan.refiner.GetHexSchemeOptions(),
                                plan.interpolation);
            if (!plan.HasParentStencils(level)) {
                _sources[level - plan.firstBuilt] = {plan.GetSources(level - 1),
                                                     plan.GetNumSources(level)};
            }
        }
    }
    // Of a part, for a plan that is factorized.
    SymbolicTable(Plan const &plan, Selection const &selection) : _plan(plan) {
        _sources.push_back({selection.sources, Index(selection.indices.size())});
        for (int level = 1; level <= plan.lastLevel; ++level) {
            _steps.emplace_back(plan.GetLevel(level - 1), plan.refiner.GetHexSchemeOptions(),
                                plan.interpolation, selection.parts[level - 1]);
        }
    }

    // Forms all supports, or says what is too large.
    Status Form();

    Plan const &GetPlan() const { return _plan; }
    StencilStep const &GetStep(int level) const { return _steps[level - _plan.firstBuilt]; }
    StepSupports const &GetSupports(int level) const { return _supports[level - _plan.firstBuilt]; }
    // Those of the level before, or the sources.
    StepSupports const &GetParentSupports(int level) const {
        return _plan.HasParentStencils(level) ? GetSupports(level - 1)
                                              : _sourceSupports[getSourceNumber(level)];
    }
    Index GetNumSources(int level) const { return _sources[getSourceNumber(level)].number; }
    std::int64_t GetNumWeights() const { return _numWeights; }
    std::vector<int> const &GetSizes() const { return _sizes; }
    std::vector<int> TakeSizes() { return std::move(_sizes); }

private:
    struct Sources {
        std::vector<Index> ofVertices;
        Index number = 0;
    };
    int getSourceNumber(int level) const { return _plan.factorize ? 0 : level - _plan.firstBuilt; }

    Plan const &_plan;
    std::deque<StencilStep> _steps; // plan.firstBuilt ... plan.lastLevel
    std::vector<Sources> _sources;  // one, or as many as steps
    std::deque<StepSupports> _sourceSupports;
    std::deque<StepSupports> _supports; // as many as steps
    std::vector<int> _sizes;
    std::int64_t _numWeights = 0;
};

Status SymbolicTable::Form() {
    std::int64_t numStencils = _plan.numControlStencils;
    for (int level = _plan.firstStored; level <= _plan.lastLevel; ++level) {
        numStencils += GetStep(level).GetNumRows();
        if (Status status = checkCount(level, numStencils, "stencils"); !status.IsOk()) {
            return status;
        }
    }
    resizeLarge(_sizes, std::size_t(numStencils));
    std::fill_n(_sizes.begin(), _plan.numControlStencils, 1);
    _numWeights = _plan.numControlStencils;
    int *nextSize = _sizes.data() + _plan.numControlStencils;
    for (int level = _plan.firstBuilt; level <= _plan.lastLevel; ++level) {
        bool const isStored = level >= _plan.firstStored;
        bool const hasParents = _plan.HasParentStencils(level);
        if (!hasParents) {
            _sourceSupports.push_back(
                StepSupports::MakeSources(_sources[getSourceNumber(level)].ofVertices));
        }
        _supports.emplace_back(GetStep(level), hasParents ? &GetStep(level - 1) : nullptr,
                               GetParentSupports(level), GetNumSources(level),
                               _plan.factorize && level < _plan.lastLevel,
                               isStored ? nextSize : nullptr);
        std::int64_t const numLevelWeights = _supports.back().GetNumWeights();
        if (isStored) {
            nextSize += GetStep(level).GetNumRows();
            _numWeights += numLevelWeights;
        }
        Status status = checkCount(level, std::max(_numWeights, numLevelWeights), "weights");
        if (!status.IsOk()) {
            return status;
        }
    }
    return Status();
}

template <typename REAL>
std::unique_ptr<WritableTable<REAL>> buildTable(SymbolicTable &symbolic) {
    Plan const &plan = symbolic.GetPlan();
    auto table = std::make_unique<WritableTable<REAL>>(plan.GetNumVertices(0), symbolic.TakeSizes(),
                                                       symbolic.GetNumWeights());
    fillControlRows(table->GetRows(0), plan.numControlStencils);
    Index nextStencil = plan.numControlStencils;
    Index nextOffset = plan.numControlStencils;

    std::unique_ptr<TemporaryRows<REAL>> previous, current; // of levels that are not stored
    StepRows<REAL> pRows{};
    for (int level = plan.firstBuilt; level <= plan.lastLevel; ++level) {
        StencilStep const &step = symbolic.GetStep(level);
        StepSupports const &supports = symbolic.GetSupports(level);
        previous = std::move(current);
        StepRows<REAL> rows;
        if (level >= plan.firstStored) {
            rows = table->GetRows(nextStencil);
            int const *const sizes = table->GetRowSizes(nextStencil);
            for (Index row = 0; row < step.GetNumRows(); ++row) {
                rows.offsets[row] = nextOffset;
                nextOffset += sizes[row];
            }
            nextStencil += step.GetNumRows();
        } else {
            current =
                std::make_unique<TemporaryRows<REAL>>(step.GetNumRows(), supports.GetNumWeights());
            rows = current->GetRows();
            Index offset = 0;
            for (Index row = 0; row < step.GetNumRows(); ++row) {
                rows.offsets[row] = offset;
                offset += supports.OfVertices()[row].size();
            }
        }
        StepBuilder<REAL>(step, symbolic.GetParentSupports(level), supports,
                          plan.HasParentStencils(level) ? &pRows : nullptr, rows)
            .Fill(symbolic.GetNumSources(level));
        pRows = rows;
    }
    return table;
}

// The vertices of each level, or their values, in the faces that lie in base faces; those of levels
// that the table does not have are left out.
std::vector<std::vector<Index>> findVerticesOfBaseFaces(Plan const &plan,
                                                        ConstIndexArray baseFaces) {
    auto const faces = internal::FindFacesOfBaseFaces(plan.refiner, baseFaces, plan.lastLevel);
    std::vector<std::vector<Index>> verts(faces.size());
    for (int level = plan.firstStored; level <= plan.lastLevel; ++level) {
        verts[level] =
            internal::FindVerticesOfFaces(plan.refiner.GetLevel(level), plan.channel, faces[level]);
    }
    return verts;
}

// Copies the stencils of wanted vertices, and control stencils, from a table of a selection.
template <typename REAL>
std::unique_ptr<WritableTable<REAL>>
selectRows(Plan const &plan, SymbolicTable const &symbolic, Selection const &selection,
           std::vector<Index> const &controls, std::vector<std::vector<Index>> const &wanted,
           WritableTable<REAL> &all) {
    std::vector<Index> rows; // of all
    Index firstRow = 0;
    for (int level = plan.firstStored; level <= plan.lastLevel; ++level) {
        // Both ascend.
        std::vector<Index> const made =
            internal::FindMadeVertices(plan.GetLevel(level - 1), selection.parts[level - 1]);
        auto next = made.begin();
        for (Index vert : wanted[level]) {
            next = std::lower_bound(next, made.end(), vert);
            rows.push_back(firstRow + Index(next - made.begin()));
        }
        firstRow += symbolic.GetStep(level).GetNumRows();
    }
    int const *const allSizes = all.GetRowSizes(0);
    StepRows<REAL> const allRows = all.GetRows(0);
    std::vector<int> sizes(controls.size() + rows.size(), 1);
    std::transform(rows.begin(), rows.end(), sizes.begin() + std::ptrdiff_t(controls.size()),
                   [&](Index row) { return allSizes[row]; });
    std::int64_t const numWeights = std::accumulate(sizes.begin(), sizes.end(), std::int64_t(0));
    auto table =
        std::make_unique<WritableTable<REAL>>(plan.GetNumVertices(0), std::move(sizes), numWeights);
    StepRows<REAL> result = table->GetRows(0);
    Index offset = 0;
    for (Index control : controls) {
        *result.offsets++ = offset;
        result.indices[offset] = control;
        result.weights[offset++] = REAL(1);
    }
    for (Index row : rows) {
        Index const *const indices = allRows.indices + allRows.offsets[row];
        *result.offsets++ = offset;
        std::copy_n(allRows.weights + allRows.offsets[row], allSizes[row], result.weights + offset);
        std::transform(indices, indices + allSizes[row], result.indices + offset,
                       [&](Index source) { return selection.indices[source]; });
        offset += allSizes[row];
    }
    return table;
}

// How many weights a step's stencils have.
struct StepWeights {
    double ofFVertices = 0;
    double ofVVertices = 0;
    double Total() const { return ofFVertices + ofVVertices; }
};

// The sizes of stencils that refer to the level before, if faces share no more than edges.
StepWeights countUnfactorizedWeights(Plan const &plan, int level) {
    TopologyLevel const pLevel = plan.GetLevel(level - 1);
    internal::LevelTopology const &topology = pLevel.GetTopology();
    internal::RefinementMask const mask(pLevel, plan.refiner.GetHexSchemeOptions(),
                                        plan.interpolation);
    StepWeights result;
    for (Index face = 0; face < pLevel.GetNumFaces(); ++face) {
        double const size = pLevel.GetFaceVertices(face).size();
        result.ofFVertices += size * size;
    }
    for (Index cVert = 0; cVert < topology.numVVertices; ++cVert) {
        Index const pVert = topology.GetVVertexParent(cVert);
        auto const weights = mask.GetVertexMask(pVert);
        ConstIndexArray const faces = pLevel.GetVertexFaces(pVert);
        if (!(weights.faceWeight > 0) || faces.empty()) {
            result.ofVVertices += 1 + weights.numNeighbors;
            continue;
        }
        // The vertex, its neighbors, and the rest of each face.
        result.ofVVertices += 1 + pLevel.GetVertexEdges(pVert).size();
        for (Index face : faces) {
            result.ofVVertices += pLevel.GetFaceVertices(face).size() - 3;
        }
    }
    return result;
}

// Estimates the sizes of stencils from those of some faces.
class WeightSampler {
public:
    explicit WeightSampler(Plan const &plan) : _plan(plan) {}

    // Forms the supports of the first levels of the sample.
    Status Form();
    StepWeights Estimate(int level) const;

private:
    static constexpr int kMaxSampledLevel = 4;
    static constexpr Index kMaxSampledFaces = 128;
    static constexpr Index kMaxLargeFaces = 32;

    // Faces, and how many corners and vertices of a level they have; a vertex counts as a part for
    // each of its faces.
    struct Stratum {
        std::vector<Index> baseFaces;
        std::vector<std::vector<Index>> faces; // of the mesh, or the value mesh, by level
        double numCorners = 0;
        double numVerts = 0;
        StepWeights weights; // of the stencils made of these
    };

    void countIsolated();
    void takeSample();
    std::vector<Index> getFaces(int level, std::vector<Index> const &meshFaces) const;
    std::vector<Index> findMade(int level) const;
    void count(int level, std::vector<Index> const &made, int const *sizes, Stratum &stratum) const;
    StepWeights average(int level) const;

    Plan const &_plan;
    Stratum _large;  // the faces with the most sides, when they have far more than others
    Stratum _sample; // of the rest
    std::vector<Index> _numIsolated;    // V-vertices without a face, by level, from 1 on
    std::vector<StepWeights> _averages; // by level, from 1 on: per stencil
};

void WeightSampler::countIsolated() {
    TopologyLevel const base = _plan.GetLevel(0);
    std::vector<Index> isolated;
    for (Index vert = 0; vert < base.GetNumVertices(); ++vert) {
        if (base.GetVertexFaces(vert).empty()) {
            isolated.push_back(vert);
        }
    }
    for (int level = 1; level <= _plan.lastLevel; ++level) {
        TopologyLevel const pLevel = _plan.GetLevel(level - 1);
        for (Index &vert : isolated) {
            vert = pLevel.GetVertexChildVertex(vert);
        }
        isolated.erase(std::remove(isolated.begin(), isolated.end(), Far::INDEX_INVALID),
                       isolated.end());
        _numIsolated.push_back(Index(isolated.size()));
    }
}

void WeightSampler::takeSample() {
    TopologyLevel const &base = _plan.refiner.GetLevel(0);
    Index const numFaces = base.GetNumFaces();
    std::vector<Index> faces(numFaces);
    std::iota(faces.begin(), faces.end(), 0);
    if (numFaces > kMaxSampledFaces) {
        auto const isLarge = [&](Index face) {
            return std::int64_t(base.GetFaceVertices(face).size()) * numFaces >
                   2 * std::int64_t(base.GetNumFaceVertices());
        };
        auto const largeEnd = std::stable_partition(faces.begin(), faces.end(), isLarge);
        std::stable_sort(faces.begin(), largeEnd, [&](Index a, Index b) {
            return base.GetFaceVertices(a).size() > base.GetFaceVertices(b).size();
        });
        auto const numLarge = std::min(largeEnd - faces.begin(), std::ptrdiff_t(kMaxLargeFaces));
        _large.baseFaces.assign(faces.begin(), faces.begin() + numLarge);
        faces.erase(faces.begin(), faces.begin() + numLarge);
        std::sort(faces.begin(), faces.end());
    }
    auto const numRest = std::int64_t(faces.size());
    std::int64_t const numSampled = std::min(numRest, std::int64_t(kMaxSampledFaces));
    for (std::int64_t i = 0; i < numSampled; ++i) {
        // One in each of equal ranges, at places in them that no regular numbering of the mesh
        // meets: the fractional parts of multiples of the golden ratio.
        std::int64_t const begin = i * numRest / numSampled;
        std::int64_t const end = (i + 1) * numRest / numSampled;
        double const golden = 0.6180339887498949 * double(i);
        double const place = (golden - std::floor(golden)) * double(end - begin);
        _sample.baseFaces.push_back(faces[begin + std::int64_t(place)]);
    }
}

// The faces of the value mesh that faces of the mesh have.
std::vector<Index> WeightSampler::getFaces(int level, std::vector<Index> const &meshFaces) const {
    if (_plan.channel < 0) {
        return meshFaces;
    }
    internal::FVarLevel const &channel =
        *_plan.refiner.GetLevel(level).GetTopology().fvarLevels[_plan.channel];
    std::vector<Index> faces;
    for (Index face : meshFaces) {
        faces.push_back(channel.valueFaces[face]);
        if (internal::FVarLevel::SplitFace const *split = channel.FindSplitFace(face)) {
            faces.push_back(split->valueFaces[1]);
        }
    }
    return faces;
}

// The vertices made of the corners, one for each face, and the vertices of all strata.
std::vector<Index> WeightSampler::findMade(int level) const {
    TopologyLevel const pLevel = _plan.GetLevel(level - 1);
    internal::LevelTopology const &topology = pLevel.GetTopology();
    std::vector<Index> verts;
    for (Stratum const *stratum : {&_large, &_sample}) {
        for (Index pFace : stratum->faces[level - 1]) {
            verts.push_back(topology.GetCornerChildVertex(pLevel.GetFaceFirstCorner(pFace)));
            for (Index pVert : pLevel.GetFaceVertices(pFace)) {
                if (Index const cVert = topology.GetVertexChildVertex(pVert);
                    cVert != Far::INDEX_INVALID) {
                    verts.push_back(cVert);
                }
            }
        }
    }
    std::sort(verts.begin(), verts.end());
    verts.erase(std::unique(verts.begin(), verts.end()), verts.end());
    return verts;
}

void WeightSampler::count(int level, std::vector<Index> const &made, int const *sizes,
                          Stratum &stratum) const {
    TopologyLevel const pLevel = _plan.GetLevel(level - 1);
    internal::LevelTopology const &topology = pLevel.GetTopology();
    auto const sizeOf = [&](Index cVert) {
        return sizes[std::lower_bound(made.begin(), made.end(), cVert) - made.begin()];
    };
    stratum.numCorners = stratum.numVerts = 0;
    stratum.weights = StepWeights();
    for (Index pFace : stratum.faces[level - 1]) {
        Index const first = pLevel.GetFaceFirstCorner(pFace);
        ConstIndexArray const pVerts = pLevel.GetFaceVertices(pFace);
        stratum.numCorners += pVerts.size();
        stratum.weights.ofFVertices +=
            double(pVerts.size()) * sizeOf(topology.GetCornerChildVertex(first));
        for (Index pVert : pVerts) {
            Index const cVert = topology.GetVertexChildVertex(pVert);
            if (cVert != Far::INDEX_INVALID) {
                double const share = 1.0 / pLevel.GetVertexFaces(pVert).size();
                stratum.numVerts += share;
                stratum.weights.ofVVertices += share * sizeOf(cVert);
            }
        }
    }
}

// What the large faces do not have is as in the sample.
StepWeights WeightSampler::average(int level) const {
    internal::LevelTopology const &parent = _plan.GetLevel(level - 1).GetTopology();
    auto const combine = [](double all, double large, double largeWeights, double sampled,
                            double sampledWeights) {
        double const rest = sampled > 0 ? (all - large) * sampledWeights / sampled : 0;
        return all > 0 ? (largeWeights + rest) / all : 0;
    };
    return {combine(parent.numCorners, _large.numCorners, _large.weights.ofFVertices,
                    _sample.numCorners, _sample.weights.ofFVertices),
            combine(parent.numVVertices - _numIsolated[level - 1], _large.numVerts,
                    _large.weights.ofVVertices, _sample.numVerts, _sample.weights.ofVVertices)};
}

Status WeightSampler::Form() {
    Plan plan = _plan;
    plan.firstStored = 1;
    plan.lastLevel = std::min(_plan.lastLevel, kMaxSampledLevel);
    plan.numControlStencils = 0;
    if (plan.lastLevel == 0) {
        return Status();
    }
    countIsolated();
    takeSample();
    for (Stratum *stratum : {&_large, &_sample}) {
        auto const meshFaces = internal::FindFacesOfBaseFaces(
            plan.refiner,
            ConstIndexArray(stratum->baseFaces.data(), int(stratum->baseFaces.size())),
            plan.lastLevel - 1);
        for (int level = 0; level < plan.lastLevel; ++level) {
            stratum->faces.push_back(getFaces(level, meshFaces[level]));
        }
    }
    std::vector<std::vector<Index>> wanted(1);
    for (int level = 1; level <= plan.lastLevel; ++level) {
        wanted.push_back(findMade(level));
    }
    Selection const selection(plan, std::move(wanted));
    SymbolicTable symbolic(plan, selection);
    if (Status status = symbolic.Form(); !status.IsOk()) {
        return status;
    }
    int const *sizes = symbolic.GetSizes().data();
    for (int level = 1; level <= plan.lastLevel; ++level) {
        std::vector<Index> const made =
            internal::FindMadeVertices(_plan.GetLevel(level - 1), selection.parts[level - 1]);
        count(level, made, sizes, _large);
        count(level, made, sizes, _sample);
        _averages.push_back(average(level));
        sizes += symbolic.GetStep(level).GetNumRows();
    }
    return Status();
}

StepWeights WeightSampler::Estimate(int level) const {
    internal::LevelTopology const &parent = _plan.GetLevel(level - 1).GetTopology();
    int const numSampled = int(_averages.size());
    StepWeights average = _averages[std::min(level, numSampled) - 1];
    if (level > numSampled) {
        // Supports grow towards a limit, each level by half as much as the one before.
        StepWeights const &before = _averages[numSampled - 2];
        double const growth = 1 - std::ldexp(1.0, numSampled - level);
        average.ofFVertices += growth * (average.ofFVertices - before.ofFVertices);
        average.ofVVertices += growth * (average.ofVVertices - before.ofVVertices);
    }
    Index const numIsolated = _numIsolated[level - 1];
    return {average.ofFVertices * parent.numCorners,
            average.ofVVertices * (parent.numVVertices - numIsolated) + numIsolated};
}

// Bytes that the supports of a step take, by what StepSupports keeps.
double estimateSupportBytes(Plan const &plan, int level, StepWeights const &weights) {
    TopologyLevel const pLevel = plan.GetLevel(level - 1);
    double const cornersPerFace = double(pLevel.GetNumFaceVertices()) / pLevel.GetNumFaces();
    // The groups of V-vertices hold about half as much as these do.
    bool const keepsVertices = plan.factorize && level < plan.lastLevel;
    double const numSources =
        weights.ofFVertices / cornersPerFace + weights.ofVVertices * (keepsVertices ? 1.5 : 0.5);
    double const numSupports =
        pLevel.GetNumFaces() + (keepsVertices ? double(plan.GetNumVertices(level)) : 0);
    return numSources * sizeof(Index) + numSupports * sizeof(Support);
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
    Plan const plan(refiner, options);
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
    bool const hasControls = options.generateControlVerts;
    options.generateControlVerts = false;
    Plan const plan(refiner, options);
    std::vector<Index> controls;
    if (hasControls) {
        controls = GetVerticesOfFaces(refiner, baseFaces, options, 0);
    }
    auto const wanted = findVerticesOfBaseFaces(plan, baseFaces);
    Selection const selection(plan, wanted);
    SymbolicTable symbolic(plan, selection);
    if (!internal::Report(symbolic.Form(), status)) {
        return nullptr;
    }
    auto const all = buildTable<REAL>(symbolic);
    return selectRows(plan, symbolic, selection, controls, wanted, *all);
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
    Plan const plan(refiner, options);
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
    Plan const plan(refiner, options);
    WeightSampler sampler(plan);
    if (plan.factorize) {
        result = sampler.Form();
    }
    if (!internal::Report(result, status)) {
        return {};
    }
    StencilTableSize size;
    size.numStencils = plan.numControlStencils;
    double numWeights = plan.numControlStencils;
    double numSupportBytes = 0;
    double numRowBytes = 0; // of the level before the last, when it is not in the table
    double numSourceBytes = 0;
    for (int level = plan.firstBuilt; level <= plan.lastLevel; ++level) {
        StepWeights const weights =
            plan.factorize ? sampler.Estimate(level) : countUnfactorizedWeights(plan, level);
        if (level >= plan.firstStored) {
            size.numStencils += plan.GetNumVertices(level);
            numWeights += weights.Total();
        } else if (level == plan.lastLevel - 1) {
            numRowBytes =
                weights.Total() * sizeof(REAL) + double(plan.GetNumVertices(level)) * sizeof(Index);
        }
        numSupportBytes += estimateSupportBytes(plan, level, weights);
        if (!plan.HasParentStencils(level)) {
            numSourceBytes +=
                double(plan.GetNumVertices(level - 1)) * (3 * sizeof(Index) + sizeof(Support));
        }
    }
    size.numWeights = std::llround(numWeights);
    size.numBytes = size.numStencils * std::int64_t(sizeof(int) + sizeof(Index)) +
                    size.numWeights * std::int64_t(sizeof(Index) + sizeof(REAL));
    size.numPeakBytes =
        size.numBytes + std::llround(numSupportBytes + numRowBytes + numSourceBytes);
    return size;
}

template class StencilTableFactoryReal<float>;
template class StencilTableFactoryReal<double>;

} // namespace OpenSubdivHex::FarExt

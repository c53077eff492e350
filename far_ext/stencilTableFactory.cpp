// SPDX-License-Identifier: Apache-2.0
#include "stencilTableFactory.h"

#include "fvarLevel.h"
#include "parallel.h"
#include "refinementMask.h"

#include <algorithm>
#include <deque>
#include <numeric>

namespace OpenSubdivHex::FarExt {

using Far::ConstIndexArray;
using Far::Index;
using internal::RefinementMask;

namespace {

constexpr std::int64_t kMaxCount = std::numeric_limits<Index>::max();

Status checkCount(int level, std::int64_t count, char const *name) {
    if (count <= kMaxCount) {
        return Status();
    }
    return Status(StatusCode::TooLarge, ComponentType::Level, level,
                  "the stencil table would have at least " + std::to_string(count) + " " + name +
                      " up to level " + std::to_string(level) + ", more than the " +
                      std::to_string(kMaxCount) + " that Far's 32-bit offsets reach");
}

// The stencils of one level within a table: entries [offsets[v], offsets[v] + sizes[v]) of indices
// and weights belong to vertex v.
template <typename REAL>
struct LevelRows {
    int *sizes;
    Index *offsets;
    Index *indices;
    REAL *weights;
};

// The arrays of Far's tables are protected; a derived class may fill them.
template <typename REAL>
class WritableTable : public StencilTableTypes<REAL>::Table {
public:
    WritableTable(int numControlVertices, std::size_t numStencils, std::size_t numWeights) {
        this->_numControlVertices = numControlVertices;
        this->_sizes.resize(numStencils);
        this->_offsets.resize(numStencils);
        this->_indices.resize(numWeights);
        this->_weights.resize(numWeights);
    }

    // The stencils from number first on.
    LevelRows<REAL> GetRows(Index first) {
        return {this->_sizes.data() + first, this->_offsets.data() + first, this->_indices.data(),
                this->_weights.data()};
    }
};

// Merges two ascending lists into a third, whose end it returns.
Index *mergeLists(ConstIndexArray list0, ConstIndexArray list1, Index *result) {
    Index const *i0 = list0.begin();
    Index const *i1 = list1.begin();
    while (i0 != list0.end() && i1 != list1.end()) {
        Index const value0 = *i0;
        Index const value1 = *i1;
        *result++ = std::min(value0, value1);
        i0 += value0 <= value1;
        i1 += value1 <= value0;
    }
    result = std::copy(i0, list0.end(), result);
    return std::copy(i1, list1.end(), result);
}

// Forms the union of ascending lists.
class UnionBuilder {
public:
    void Begin() { _lists.clear(); }
    // A list that is the one added last is passed over.
    void Add(ConstIndexArray list) {
        if (_lists.empty() || _lists.back().begin() != list.begin()) {
            _lists.push_back(list);
        }
    }
    ConstIndexArray GetUnion() {
        std::size_t size = 0;
        for (ConstIndexArray list : _lists) {
            size += list.size();
        }
        if (_lists.size() > kMaxMerged) {
            _result.clear();
            for (ConstIndexArray list : _lists) {
                _result.insert(_result.end(), list.begin(), list.end());
            }
            std::sort(_result.begin(), _result.end());
            _result.erase(std::unique(_result.begin(), _result.end()), _result.end());
            return ConstIndexArray(_result.data(), int(_result.size()));
        }
        _result.resize(std::max(_result.size(), size));
        _merged.resize(std::max(_merged.size(), size));
        ConstIndexArray all = _lists.front();
        for (std::size_t i = 1; i < _lists.size(); ++i) {
            Index const *end = mergeLists(all, _lists[i], _merged.data());
            _merged.swap(_result);
            all = ConstIndexArray(_result.data(), int(end - _result.data()));
        }
        return all;
    }

private:
    static constexpr std::size_t kMaxMerged = 16; // more lists are sorted together

    std::vector<ConstIndexArray> _lists;
    std::vector<Index> _result;
    std::vector<Index> _merged;
};

// Lists of source vertices, made in parallel and stored one after the other.
class SupportLists {
public:
    // Appends count lists; makeList(builder, i) gives number i.
    template <typename FUNCTION>
    void Append(Index count, FUNCTION makeList) {
        std::size_t const begin = _firsts.size() - 1;
        _firsts.resize(begin + count + 1);
        std::vector<std::vector<Index>> ranges(internal::GetNumParallelRanges(count));
        internal::ParallelForRange(
            count, [] { return UnionBuilder(); },
            [&](UnionBuilder &builder, Index rangeBegin, Index rangeEnd) {
                std::vector<Index> &range = ranges[rangeBegin / internal::kParallelRange];
                for (Index i = rangeBegin; i < rangeEnd; ++i) {
                    builder.Begin();
                    makeList(builder, i);
                    ConstIndexArray const list = builder.GetUnion();
                    range.insert(range.end(), list.begin(), list.end());
                    _firsts[begin + i + 1] = list.size();
                }
            });
        for (std::size_t i = begin; i + 1 < _firsts.size(); ++i) {
            _firsts[i + 1] += _firsts[i];
        }
        _indices.resize(_firsts.back());
        internal::ParallelForRange(
            count, [] { return 0; },
            [&](int, Index rangeBegin, Index) {
                std::vector<Index> &range = ranges[rangeBegin / internal::kParallelRange];
                std::copy(range.begin(), range.end(),
                          _indices.begin() + std::ptrdiff_t(_firsts[begin + rangeBegin]));
                std::vector<Index>().swap(range);
            });
    }

    ConstIndexArray operator[](std::size_t i) const {
        return ConstIndexArray(_indices.data() + _firsts[i], int(_firsts[i + 1] - _firsts[i]));
    }

private:
    std::vector<std::size_t> _firsts = {0};
    std::vector<Index> _indices;
};

// Which source vertices each stencil of a level depends on, in ascending lists.  All F-vertices
// of a parent face share one list; every V-vertex has its own.
class LevelSupports {
public:
    // A level that is its own source: vertex v depends on source v alone, or on sources[v].
    explicit LevelSupports(std::vector<Index> sources) : _sources(std::move(sources)) {}

    // The level that refinement makes of pLevel, the supports of whose vertices are pSupports.
    // The lists of V-vertices are not made when GetNumWeights exceeds what fits without them.
    LevelSupports(TopologyLevel const &pLevel, LevelSupports const &pSupports,
                  RefinementMask const &mask)
        : _numParentFaces(pLevel.GetNumFaces()), _numVVertices(pLevel.GetTopology().numVVertices) {
        _lists.Append(_numParentFaces, [&](UnionBuilder &sources, Index pFace) {
            for (Index pVert : pLevel.GetFaceVertices(pFace)) {
                sources.Add(pSupports.OfVertex(pLevel, pVert));
            }
        });
        for (Index pFace = 0; pFace < _numParentFaces; ++pFace) {
            _numWeights +=
                std::int64_t(pLevel.GetFaceVertices(pFace).size()) * OfParentFace(pFace).size();
        }
        if (std::int64_t const numLeast = _numWeights + countLeastVertexWeights(pLevel, mask);
            numLeast > kMaxCount) {
            _numWeights = numLeast;
            return;
        }
        _lists.Append(_numVVertices, [&](UnionBuilder &sources, Index cVert) {
            Index const pVert = pLevel.GetTopology().GetVVertexParent(cVert);
            auto const weights = mask.GetVertexMask(pVert);
            sources.Add(pSupports.OfVertex(pLevel, pVert));
            for (int i = 0; i < weights.numNeighbors; ++i) {
                sources.Add(pSupports.OfVertex(pLevel, weights.neighbors[i]));
            }
            if (weights.faceWeight > 0) {
                for (Index pFace : pLevel.GetVertexFaces(pVert)) {
                    sources.Add(OfParentFace(pFace));
                }
            }
        });
        for (Index cVert = 0; cVert < _numVVertices; ++cVert) {
            _numWeights += OfVVertex(cVert).size();
        }
    }

    // The support of all F-vertices of a face of the parent level, and of a V-vertex.
    ConstIndexArray OfParentFace(Index pFace) const { return _lists[pFace]; }
    ConstIndexArray OfVVertex(Index cVert) const { return _lists[_numParentFaces + cVert]; }

    // The support of a vertex of the level itself, which is given.
    ConstIndexArray OfVertex(TopologyLevel const &level, Index vert) const {
        if (!_sources.empty()) {
            return ConstIndexArray(&_sources[vert], 1);
        }
        return vert < _numVVertices ? OfVVertex(vert) : OfParentFace(fFaceOf(level, vert));
    }

    // Sum of the sizes of the supports of all vertices of the level.
    std::int64_t GetNumWeights() const { return _numWeights; }

private:
    // A lower bound: the support of a smooth V-vertex is at least that of each of its faces.
    std::int64_t countLeastVertexWeights(TopologyLevel const &pLevel,
                                         RefinementMask const &mask) const {
        std::int64_t count = 0;
        if (_numWeights < kMaxCount / 8) {
            return count; // far from the limit: not worth a look at every vertex
        }
        for (Index cVert = 0; cVert < _numVVertices; ++cVert) {
            Index const pVert = pLevel.GetTopology().GetVVertexParent(cVert);
            int most = 0;
            if (mask.GetVertexMask(pVert).faceWeight > 0) {
                for (Index pFace : pLevel.GetVertexFaces(pVert)) {
                    most = std::max(most, OfParentFace(pFace).size());
                }
            }
            count += most;
        }
        return count;
    }

    // The F-face around an F-vertex has the index of the parent face, less than any E-face.
    static Index fFaceOf(TopologyLevel const &level, Index fVertex) {
        ConstIndexArray const faces = level.GetVertexFaces(fVertex);
        return *std::min_element(faces.begin(), faces.end());
    }

    std::vector<Index> _sources; // of a level that is its own source
    Index _numParentFaces = 0;
    Index _numVVertices = 0;
    std::int64_t _numWeights = 0;
    SupportLists _lists; // of parent faces, then of parent vertices
};

template <typename REAL>
void fillControlRows(LevelRows<REAL> const &rows, Index numControlVertices) {
    for (Index vert = 0; vert < numControlVertices; ++vert) {
        rows.sizes[vert] = 1;
        rows.offsets[vert] = vert;
        rows.indices[vert] = vert;
        rows.weights[vert] = REAL(1);
    }
}

// Writes the stencils of the level that refinement makes of pLevel, given those of pLevel (none:
// its vertices are sources, as pSupports says).
//
// Sums are formed in double, in an order that the topology fixes, and rounded once, so that the
// weights of a stencil sum to 1 as well as REAL can.
template <typename REAL>
class LevelBuilder {
public:
    LevelBuilder(TopologyLevel const &pLevel, LevelSupports const &pSupports,
                 LevelSupports const &supports, RefinementMask const &mask,
                 LevelRows<REAL> const *pRows, LevelRows<REAL> const &rows)
        : _pLevel(pLevel), _pTopology(pLevel.GetTopology()), _pSupports(pSupports),
          _supports(supports), _mask(mask), _pRows(pRows), _rows(rows) {}

    // numSources is more than any index in a stencil.
    void Fill(Index numSources, Index firstOffset) {
        fillSizesAndOffsets(firstOffset);
        auto const makeScratch = [numSources] { return Scratch(numSources); };
        internal::ParallelForRange(_pLevel.GetNumFaces(), makeScratch,
                                   [this](Scratch &scratch, Index begin, Index end) {
                                       for (Index pFace = begin; pFace < end; ++pFace) {
                                           fillFace(pFace, scratch);
                                       }
                                   });
        internal::ParallelForRange(_pTopology.numVVertices, makeScratch,
                                   [this](Scratch &scratch, Index begin, Index end) {
                                       for (Index cVert = begin; cVert < end; ++cVert) {
                                           fillVVertex(cVert, scratch);
                                       }
                                   });
    }

private:
    // What one thread works on.
    struct Scratch {
        explicit Scratch(Index numSources) : position(numSources) {}

        // Where each source of the support stands in it.
        void Locate(ConstIndexArray support) {
            for (int k = 0; k < support.size(); ++k) {
                position[support[k]] = k;
            }
        }

        std::vector<int> position;       // by source
        std::vector<double> mask;        // of a corner, see RefinementMask
        std::vector<double> parentBlock; // dense stencils of a face's vertices over its support
        std::vector<double> row;         // one dense stencil
    };

    void fillSizesAndOffsets(Index firstOffset);
    void fillFace(Index pFace, Scratch &scratch) const;
    void fillVVertex(Index cVert, Scratch &scratch) const;

    // Adds weight times the stencil of a row to a dense row over the located support.
    // clang-tidy 14 does not see the write, whose factors depend on REAL.
    static void addRow(LevelRows<REAL> const &rows, Index row, double weight,
                       // NOLINTNEXTLINE(readability-non-const-parameter)
                       Scratch const &scratch, double *dense) {
        Index const *indices = rows.indices + rows.offsets[row];
        REAL const *weights = rows.weights + rows.offsets[row];
        for (int k = 0; k < rows.sizes[row]; ++k) {
            dense[scratch.position[indices[k]]] += weight * double(weights[k]);
        }
    }
    void addParent(Index pVert, double weight, Scratch const &scratch, double *dense) const {
        if (_pRows) {
            addRow(*_pRows, pVert, weight, scratch, dense);
        } else {
            Index const source = _pSupports.OfVertex(_pLevel, pVert)[0];
            dense[scratch.position[source]] += weight;
        }
    }
    void storeRow(ConstIndexArray support, std::vector<double> const &dense, Index row) const {
        std::copy(support.begin(), support.end(), _rows.indices + _rows.offsets[row]);
        std::transform(dense.begin(), dense.end(), _rows.weights + _rows.offsets[row],
                       [](double weight) { return REAL(weight); });
    }

    TopologyLevel const &_pLevel;
    internal::LevelTopology const &_pTopology;
    LevelSupports const &_pSupports;
    LevelSupports const &_supports;
    RefinementMask const &_mask;
    LevelRows<REAL> const *_pRows;
    LevelRows<REAL> const _rows;
};

template <typename REAL>
void LevelBuilder<REAL>::fillSizesAndOffsets(Index firstOffset) {
    internal::ParallelFor(_pTopology.numVVertices, [this](Index cVert) {
        _rows.sizes[cVert] = _supports.OfVVertex(cVert).size();
    });
    internal::ParallelFor(_pLevel.GetNumFaces(), [this](Index pFace) {
        Index const first = _pTopology.GetCornerChildVertex(_pLevel.GetFaceFirstCorner(pFace));
        std::fill_n(_rows.sizes + first, _pLevel.GetFaceVertices(pFace).size(),
                    _supports.OfParentFace(pFace).size());
    });
    Index offset = firstOffset;
    Index const numVertices = _pTopology.GetCornerChildVertex(_pLevel.GetNumFaceVertices());
    for (Index cVert = 0; cVert < numVertices; ++cVert) {
        _rows.offsets[cVert] = offset;
        offset += _rows.sizes[cVert];
    }
}

// The stencils of a face's F-vertices are the face mask times the stencils of its vertices.
template <typename REAL>
void LevelBuilder<REAL>::fillFace(Index pFace, Scratch &scratch) const {
    ConstIndexArray const pVerts = _pLevel.GetFaceVertices(pFace);
    ConstIndexArray const support = _supports.OfParentFace(pFace);
    std::size_t const width = support.size();
    scratch.Locate(support);
    scratch.row.resize(width);
    double *const row = scratch.row.data();
    if (!_pRows) {
        // The vertices are sources themselves: the mask is the stencil.
        for (int i = 0; i < pVerts.size(); ++i) {
            Index const corner = _pLevel.GetFaceFirstCorner(pFace) + i;
            double const *mask = _mask.GetFaceVertexWeights(pFace, i, scratch.mask);
            std::fill_n(row, width, 0.0);
            for (int j = 0; j < pVerts.size(); ++j) {
                addParent(pVerts[j], mask[j], scratch, row);
            }
            storeRow(support, scratch.row, _pTopology.GetCornerChildVertex(corner));
        }
        return;
    }
    scratch.parentBlock.assign(pVerts.size() * width, 0.0);
    for (int j = 0; j < pVerts.size(); ++j) {
        addParent(pVerts[j], 1.0, scratch, scratch.parentBlock.data() + j * width);
    }
    for (int i = 0; i < pVerts.size(); ++i) {
        Index const corner = _pLevel.GetFaceFirstCorner(pFace) + i;
        double const *mask = _mask.GetFaceVertexWeights(pFace, i, scratch.mask);
        double const *parent = scratch.parentBlock.data();
        for (std::size_t k = 0; k < width; ++k) {
            row[k] = mask[0] * parent[k];
        }
        for (int j = 1; j < pVerts.size(); ++j) {
            parent += width;
            for (std::size_t k = 0; k < width; ++k) {
                row[k] += mask[j] * parent[k];
            }
        }
        storeRow(support, scratch.row, _pTopology.GetCornerChildVertex(corner));
    }
}

template <typename REAL>
void LevelBuilder<REAL>::fillVVertex(Index cVert, Scratch &scratch) const {
    Index const pVert = _pTopology.GetVVertexParent(cVert);
    ConstIndexArray const support = _supports.OfVVertex(cVert);
    scratch.Locate(support);
    scratch.row.assign(support.size(), 0.0);
    double *const row = scratch.row.data();

    auto const mask = _mask.GetVertexMask(pVert);
    addParent(pVert, mask.vertexWeight, scratch, row);
    for (int i = 0; i < mask.numNeighbors; ++i) {
        addParent(mask.neighbors[i], mask.neighborWeights[i], scratch, row);
    }
    if (mask.faceWeight > 0) {
        for (int i = 0; i < _pLevel.GetVertexFaces(pVert).size(); ++i) {
            Index const corner = _pLevel.GetVertexCorner(pVert, i);
            addRow(_rows, _pTopology.GetCornerChildVertex(corner), mask.faceWeight, scratch, row);
        }
    }
    storeRow(support, scratch.row, cVert);
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
    // A level whose vertices are their own sources; of values, those that the user has.
    LevelSupports GetSources(int level) const {
        if (channel >= 0 && level == 0) {
            internal::Buffer<Index> const &values =
                refiner.GetLevel(0).GetTopology().fvarLevels[channel]->valuesOfVertices;
            return LevelSupports(std::vector<Index>(values.begin(), values.end()));
        }
        std::vector<Index> sources(GetNumVertices(level));
        std::iota(sources.begin(), sources.end(), 0);
        return LevelSupports(std::move(sources));
    }
    // The masks of the step that makes a level.
    RefinementMask GetMask(int level) const {
        return RefinementMask(GetLevel(level - 1), refiner.GetHexSchemeOptions(), interpolation);
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

// The supports of all stencils, and the size of the table.
struct SymbolicTable {
    // The parent supports of a level: of the level before when stencils are factorized.
    LevelSupports const &ParentsOf(Plan const &plan, int level) const {
        return plan.HasParentStencils(level)
                   ? Of(plan, level - 1)
                   : sources[plan.factorize ? 0 : level - plan.firstBuilt];
    }
    LevelSupports const &Of(Plan const &plan, int level) const {
        return levels[level - plan.firstBuilt];
    }

    std::deque<LevelSupports> sources;
    std::deque<LevelSupports> levels; // plan.firstBuilt ... plan.lastLevel
    std::int64_t numStencils = 0;
    std::int64_t numWeights = 0;
};

Status buildSupports(Plan const &plan, SymbolicTable &result) {
    result.numStencils = plan.numControlStencils;
    result.numWeights = plan.numControlStencils;
    for (int level = plan.firstBuilt; level <= plan.lastLevel; ++level) {
        TopologyLevel const pLevel = plan.GetLevel(level - 1);
        if (!plan.HasParentStencils(level)) {
            result.sources.push_back(plan.GetSources(level - 1));
        }
        LevelSupports const &pSupports = result.ParentsOf(plan, level);
        LevelSupports supports(pLevel, pSupports, plan.GetMask(level));
        std::int64_t const numLevelWeights = supports.GetNumWeights();
        if (level >= plan.firstStored) {
            result.numStencils += plan.GetNumVertices(level);
            result.numWeights += numLevelWeights;
        }
        Status status = checkCount(level, result.numStencils, "stencils");
        if (status.IsOk()) {
            status = checkCount(level, std::max(result.numWeights, numLevelWeights), "weights");
        }
        if (!status.IsOk()) {
            return status;
        }
        result.levels.push_back(std::move(supports));
    }
    return Status();
}

template <typename REAL>
std::unique_ptr<WritableTable<REAL>> buildTable(Plan const &plan, SymbolicTable const &symbolic) {
    Index const numControlVertices = plan.GetNumVertices(0);
    auto table = std::make_unique<WritableTable<REAL>>(numControlVertices, symbolic.numStencils,
                                                       symbolic.numWeights);
    fillControlRows(table->GetRows(0), plan.numControlStencils);
    Index nextStencil = plan.numControlStencils;
    Index nextOffset = plan.numControlStencils;

    std::unique_ptr<WritableTable<REAL>> previous, current; // of levels that are not stored
    LevelRows<REAL> pRows{};
    for (int level = plan.firstBuilt; level <= plan.lastLevel; ++level) {
        TopologyLevel const pLevel = plan.GetLevel(level - 1);
        LevelSupports const &supports = symbolic.Of(plan, level);
        Index const numStencils = plan.GetNumVertices(level);
        Index const numWeights = Index(supports.GetNumWeights());
        bool const isStored = level >= plan.firstStored;

        previous.swap(current);
        if (!isStored) {
            current =
                std::make_unique<WritableTable<REAL>>(numControlVertices, numStencils, numWeights);
        }
        LevelRows<REAL> const rows = isStored ? table->GetRows(nextStencil) : current->GetRows(0);
        RefinementMask const mask = plan.GetMask(level);
        LevelBuilder<REAL>(pLevel, symbolic.ParentsOf(plan, level), supports, mask,
                           plan.HasParentStencils(level) ? &pRows : nullptr, rows)
            .Fill(plan.GetNumSources(level), isStored ? nextOffset : 0);
        pRows = rows;
        if (isStored) {
            nextStencil += numStencils;
            nextOffset += numWeights;
        }
    }
    return table;
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
    SymbolicTable symbolic;
    if (!internal::Report(buildSupports(plan, symbolic), status)) {
        return nullptr;
    }
    return buildTable<REAL>(plan, symbolic);
}

template class StencilTableFactoryReal<float>;
template class StencilTableFactoryReal<double>;

} // namespace OpenSubdivHex::FarExt

// SPDX-License-Identifier: Apache-2.0
#include "stencilTableFactory.h"

#include "fvarLevel.h"
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
                  "the stencil table would have " + std::to_string(count) + " " + name +
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

// Forms unions of lists of source vertices: a mark per source tells what was seen already.
class UnionBuilder {
public:
    explicit UnionBuilder(Index numSources) : _seenIn(numSources, -1) {}

    void Begin() {
        ++_current;
        _members.clear();
    }
    void Add(ConstIndexArray list) {
        for (Index source : list) {
            if (_seenIn[source] != _current) {
                _seenIn[source] = _current;
                _members.push_back(source);
            }
        }
    }
    int GetSize() const { return int(_members.size()); }
    void CopySorted(Index *result) {
        std::sort(_members.begin(), _members.end());
        std::copy(_members.begin(), _members.end(), result);
    }

private:
    std::vector<Index> _seenIn;
    Index _current = -1;
    std::vector<Index> _members;
};

// Which source vertices each stencil of a level depends on, in ascending lists.  All F-vertices
// of a parent face share one list; every V-vertex has its own.
class LevelSupports {
public:
    // A level that is its own source: vertex v depends on source v alone, or on sources[v].
    LevelSupports(Index numSources, std::vector<Index> sources)
        : _numSources(numSources), _indices(std::move(sources)) {}

    // The level that refinement makes of pLevel, the supports of whose vertices are pSupports.
    // The lists of V-vertices, by far the longer, are only counted: FillVertexLists makes them, once
    // GetNumWeights is known to fit.
    LevelSupports(TopologyLevel const &pLevel, LevelSupports const &pSupports,
                  RefinementMask const &mask)
        : _isIdentity(false), _numSources(pSupports._numSources),
          _numParentFaces(pLevel.GetNumFaces()) {
        _firsts.reserve(std::size_t(pLevel.GetNumFaces()) + pLevel.GetNumVertices() + 1);
        UnionBuilder sources(_numSources);
        for (Index pFace = 0; pFace < pLevel.GetNumFaces(); ++pFace) {
            uniteFace(pLevel, pSupports, pFace, sources);
            addCount(sources.GetSize(), pLevel.GetFaceVertices(pFace).size());
        }
        if (_numWeights > kMaxCount) {
            return;
        }
        _indices.resize(_firsts.back());
        for (Index pFace = 0; pFace < pLevel.GetNumFaces(); ++pFace) {
            uniteFace(pLevel, pSupports, pFace, sources);
            sources.CopySorted(_indices.data() + _firsts[pFace]);
        }
        for (Index pVert = 0; pVert < pLevel.GetNumVertices(); ++pVert) {
            uniteVertex(pLevel, pSupports, mask, pVert, sources);
            addCount(sources.GetSize(), 1);
        }
    }

    void FillVertexLists(TopologyLevel const &pLevel, LevelSupports const &pSupports,
                         RefinementMask const &mask) {
        _indices.resize(_firsts.back());
        UnionBuilder sources(_numSources);
        for (Index pVert = 0; pVert < pLevel.GetNumVertices(); ++pVert) {
            uniteVertex(pLevel, pSupports, mask, pVert, sources);
            sources.CopySorted(_indices.data() + _firsts[_numParentFaces + pVert]);
        }
    }

    // The support of all F-vertices of a face of the parent level, and of the V-vertex of a vertex.
    ConstIndexArray OfParentFace(Index pFace) const { return list(pFace); }
    ConstIndexArray OfParentVertex(Index pVert) const { return list(_numParentFaces + pVert); }

    // The support of a vertex of the level itself, which is given.
    ConstIndexArray OfVertex(TopologyLevel const &level, Index vert) const {
        if (_isIdentity) {
            return ConstIndexArray(&_indices[vert], 1);
        }
        Index const numVVertices = Index(_firsts.size() - 1) - _numParentFaces;
        return vert < numVVertices ? OfParentVertex(vert) : OfParentFace(fFaceOf(level, vert));
    }

    Index GetNumSources() const { return _numSources; }
    // Sum of the sizes of the supports of all vertices of the level.
    std::int64_t GetNumWeights() const { return _numWeights; }

private:
    // The F-face around an F-vertex has the index of the parent face, less than any E-face.
    static Index fFaceOf(TopologyLevel const &level, Index fVertex) {
        ConstIndexArray const faces = level.GetVertexFaces(fVertex);
        return *std::min_element(faces.begin(), faces.end());
    }

    ConstIndexArray list(std::size_t i) const {
        return ConstIndexArray(_indices.data() + _firsts[i], int(_firsts[i + 1] - _firsts[i]));
    }

    // A list that so many stencils share.
    void addCount(int size, int numStencils) {
        _firsts.push_back(_firsts.back() + size);
        _numWeights += std::int64_t(size) * numStencils;
    }

    static void uniteFace(TopologyLevel const &pLevel, LevelSupports const &pSupports, Index pFace,
                          UnionBuilder &sources) {
        sources.Begin();
        for (Index pVert : pLevel.GetFaceVertices(pFace)) {
            sources.Add(pSupports.OfVertex(pLevel, pVert));
        }
    }
    void uniteVertex(TopologyLevel const &pLevel, LevelSupports const &pSupports,
                     RefinementMask const &mask, Index pVert, UnionBuilder &sources) const {
        auto const weights = mask.GetVertexMask(pLevel, pVert);
        sources.Begin();
        sources.Add(pSupports.OfVertex(pLevel, pVert));
        for (int i = 0; i < weights.numNeighbors; ++i) {
            sources.Add(pSupports.OfVertex(pLevel, weights.neighbors[i]));
        }
        if (weights.faceWeight > 0) {
            for (Index pFace : pLevel.GetVertexFaces(pVert)) {
                sources.Add(OfParentFace(pFace));
            }
        }
    }

    bool _isIdentity = true;
    Index _numSources;
    Index _numParentFaces = 0;
    std::int64_t _numWeights = 0;
    std::vector<std::size_t> _firsts = {0}; // of the lists: parent faces, then parent vertices
    std::vector<Index> _indices;
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
template <typename REAL>
class LevelBuilder {
public:
    LevelBuilder(TopologyLevel const &pLevel, LevelSupports const &pSupports,
                 LevelSupports const &supports, RefinementMask const &mask,
                 LevelRows<REAL> const *pRows, LevelRows<REAL> const &rows)
        : _pLevel(pLevel), _indexing(pLevel.GetChildIndexing()), _pSupports(pSupports),
          _supports(supports), _mask(mask), _pRows(pRows), _rows(rows),
          _position(supports.GetNumSources()) {}

    void Fill(Index firstOffset) {
        fillSizesAndOffsets(firstOffset);
        for (Index pFace = 0; pFace < _pLevel.GetNumFaces(); ++pFace) {
            fillFace(pFace);
        }
        for (Index pVert = 0; pVert < _pLevel.GetNumVertices(); ++pVert) {
            fillVertex(pVert);
        }
    }

private:
    void fillSizesAndOffsets(Index firstOffset);
    void fillFace(Index pFace);
    void fillVertex(Index pVert);

    // Where each source of the support stands in it.
    void locate(ConstIndexArray support) {
        for (int k = 0; k < support.size(); ++k) {
            _position[support[k]] = k;
        }
    }

    // Adds weight times the stencil of a row to a dense row over the located support.  Sums are in
    // double and rounded once, so that the weights of a stencil sum to 1 as well as REAL can.
    void addRow(LevelRows<REAL> const &rows, Index row, double weight, double *dense) const {
        Index const *indices = rows.indices + rows.offsets[row];
        REAL const *weights = rows.weights + rows.offsets[row];
        for (int k = 0; k < rows.sizes[row]; ++k) {
            dense[_position[indices[k]]] += weight * double(weights[k]);
        }
    }
    void storeRow(ConstIndexArray support, Index row) const {
        std::copy(support.begin(), support.end(), _rows.indices + _rows.offsets[row]);
        std::transform(_row.begin(), _row.end(), _rows.weights + _rows.offsets[row],
                       [](double weight) { return REAL(weight); });
    }
    void addParent(Index pVert, double weight, double *dense) const {
        if (_pRows) {
            addRow(*_pRows, pVert, weight, dense);
        } else {
            dense[_position[_pSupports.OfVertex(_pLevel, pVert)[0]]] += weight;
        }
    }

    TopologyLevel const &_pLevel;
    HexIndexing const _indexing;
    LevelSupports const &_pSupports;
    LevelSupports const &_supports;
    RefinementMask const &_mask;
    LevelRows<REAL> const *_pRows;
    LevelRows<REAL> const _rows;

    std::vector<int> _position; // by source
    std::vector<double> _scratch;
    std::vector<double> _parentBlock; // dense stencils of a face's vertices over the face's support
    std::vector<double> _row;         // one dense stencil
};

template <typename REAL>
void LevelBuilder<REAL>::fillSizesAndOffsets(Index firstOffset) {
    for (Index pVert = 0; pVert < _pLevel.GetNumVertices(); ++pVert) {
        _rows.sizes[_indexing.GetVertexChildVertex(pVert)] = _supports.OfParentVertex(pVert).size();
    }
    for (Index pFace = 0; pFace < _pLevel.GetNumFaces(); ++pFace) {
        Index const first = _indexing.GetCornerChildVertex(_pLevel.GetFaceFirstCorner(pFace));
        std::fill_n(_rows.sizes + first, _pLevel.GetFaceVertices(pFace).size(),
                    _supports.OfParentFace(pFace).size());
    }
    Index offset = firstOffset;
    Index const numVertices = _indexing.GetCornerChildVertex(_pLevel.GetNumFaceVertices());
    for (Index cVert = 0; cVert < numVertices; ++cVert) {
        _rows.offsets[cVert] = offset;
        offset += _rows.sizes[cVert];
    }
}

// The stencils of a face's F-vertices are the face mask times the stencils of its vertices.
template <typename REAL>
void LevelBuilder<REAL>::fillFace(Index pFace) {
    ConstIndexArray const pVerts = _pLevel.GetFaceVertices(pFace);
    ConstIndexArray const support = _supports.OfParentFace(pFace);
    std::size_t const width = support.size();
    locate(support);
    _parentBlock.assign(pVerts.size() * width, 0.0);
    for (int j = 0; j < pVerts.size(); ++j) {
        addParent(pVerts[j], 1.0, _parentBlock.data() + j * width);
    }
    for (int i = 0; i < pVerts.size(); ++i) {
        Index const corner = _pLevel.GetFaceFirstCorner(pFace) + i;
        double const *mask = _mask.GetFaceVertexWeights(_pLevel, pFace, i, _scratch);
        _row.assign(width, 0.0);
        for (int j = 0; j < pVerts.size(); ++j) {
            double const *parent = _parentBlock.data() + j * width;
            for (std::size_t k = 0; k < width; ++k) {
                _row[k] += mask[j] * parent[k];
            }
        }
        storeRow(support, _indexing.GetCornerChildVertex(corner));
    }
}

template <typename REAL>
void LevelBuilder<REAL>::fillVertex(Index pVert) {
    ConstIndexArray const support = _supports.OfParentVertex(pVert);
    locate(support);
    _row.assign(support.size(), 0.0);

    auto const mask = _mask.GetVertexMask(_pLevel, pVert);
    addParent(pVert, mask.vertexWeight, _row.data());
    for (int i = 0; i < mask.numNeighbors; ++i) {
        addParent(mask.neighbors[i], mask.neighborWeights[i], _row.data());
    }
    if (mask.faceWeight > 0) {
        for (int i = 0; i < _pLevel.GetVertexFaces(pVert).size(); ++i) {
            Index const corner = _pLevel.GetVertexCorner(pVert, i);
            addRow(_rows, _indexing.GetCornerChildVertex(corner), mask.faceWeight, _row.data());
        }
    }
    storeRow(support, _indexing.GetVertexChildVertex(pVert));
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
        Index const numSources = GetNumVertices(level);
        if (channel >= 0 && level == 0) {
            internal::Buffer<Index> const &values =
                refiner.GetLevel(0).GetTopology().fvarLevels[channel]->valuesOfVertices;
            return LevelSupports(numSources, std::vector<Index>(values.begin(), values.end()));
        }
        std::vector<Index> sources(numSources);
        std::iota(sources.begin(), sources.end(), 0);
        return LevelSupports(numSources, std::move(sources));
    }

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

Status buildSupports(Plan const &plan, RefinementMask const &mask, SymbolicTable &result) {
    result.numStencils = plan.numControlStencils;
    result.numWeights = plan.numControlStencils;
    for (int level = plan.firstBuilt; level <= plan.lastLevel; ++level) {
        TopologyLevel const pLevel = plan.GetLevel(level - 1);
        if (!plan.HasParentStencils(level)) {
            result.sources.push_back(plan.GetSources(level - 1));
        }
        LevelSupports const &pSupports = result.ParentsOf(plan, level);
        LevelSupports supports(pLevel, pSupports, mask);
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
        supports.FillVertexLists(pLevel, pSupports, mask);
        result.levels.push_back(std::move(supports));
    }
    return Status();
}

template <typename REAL>
std::unique_ptr<WritableTable<REAL>> buildTable(Plan const &plan, RefinementMask const &mask,
                                                SymbolicTable const &symbolic) {
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
        LevelBuilder<REAL>(pLevel, symbolic.ParentsOf(plan, level), supports, mask,
                           plan.HasParentStencils(level) ? &pRows : nullptr, rows)
            .Fill(isStored ? nextOffset : 0);
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
    RefinementMask const mask(refiner.GetLevel(0), refiner.GetHexSchemeOptions().faceMask,
                              plan.interpolation);
    SymbolicTable symbolic;
    if (!internal::Report(buildSupports(plan, mask, symbolic), status)) {
        return nullptr;
    }
    return buildTable<REAL>(plan, mask, symbolic);
}

template class StencilTableFactoryReal<float>;
template class StencilTableFactoryReal<double>;

} // namespace OpenSubdivHex::FarExt

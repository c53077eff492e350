// SPDX-License-Identifier: Apache-2.0
#include "stencilTableFactory.h"

#include "far_ext/limit/latticeStencils.h"
#include "far_ext/limit/limitMultiplier.h"
#include "far_ext/limit/plainFaces.h"
#include "far_ext/stencil/levelStencils.h"
#include "far_ext/vtr/hierarchy.h"
#include "far_ext/vtr/parallel.h"
#include "far_ext/vtr/report.h"

#include <atomic>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

namespace OpenSubdivHex::FarExt {

using Far::Index;
using internal::FaceLimitMaskFinder;
using internal::LatticeFaces;
using internal::Level;
using internal::LevelStencils;
using internal::LimitMask;
using internal::LimitRow;
using internal::LimitRows;
using internal::PlainFaces;

LimitSides::LimitSides(TopologyLevel const &level)
    : _isValid(level.HasFullTopology()), _numVertices(_isValid ? level.GetNumVertices() : 0) {
    if (!_isValid) {
        return;
    }
    internal::Level const &topology = level.GetLevel();
    for (internal::SharpVertex const &sharp : topology.sharpVerts) {
        auto const sides = internal::FindVertexSides(topology, sharp.vert);
        if (sides.size() < 2) {
            continue;
        }
        std::size_t const firstCorner = _corners.size();
        for (int side = 0; side < int(sides.size()); ++side) {
            if (side > 0) {
                _furtherSides.push_back({sharp.vert, side});
            }
            Index const index = side == 0 ? sharp.vert : GetNumSides() - 1;
            for (internal::FanItem const &item : sides[side].items) {
                if (item.isFace) {
                    addCorner(firstCorner, item.corner, item.half, index);
                }
            }
        }
    }
    std::sort(_corners.begin(), _corners.end(),
              [](Corner const &a, Corner const &b) { return a.corner < b.corner; });
}

// A corner with two halves comes twice, and not always one after the other.
void LimitSides::addCorner(std::size_t begin, Index corner, int half, Index side) {
    for (std::size_t i = begin; i < _corners.size() && half >= 0; ++i) {
        if (_corners[i].corner == corner) {
            _corners[i].sides[half] = side;
            return;
        }
    }
    _corners.push_back({corner, {side, side}});
}

bool LimitSides::IsOf(TopologyLevel const &level) const {
    LimitSides const own(level);
    return _isValid && own._isValid && own._numVertices == _numVertices &&
           own._furtherSides == _furtherSides && own._corners == _corners;
}

Index LimitSides::FindSide(TopologyLevel const &level, Index face, int local, int half) const {
    auto const found =
        std::lower_bound(_corners.begin(), _corners.end(), level.GetFaceFirstCorner(face) + local,
                         [](Corner const &entry, Index corner) { return entry.corner < corner; });
    return found != _corners.end() && found->corner == level.GetFaceFirstCorner(face) + local
               ? found->sides[half]
               : level.GetFaceVertices(face)[local];
}

namespace {

// The arrays of Far's tables are protected, those of derivatives private.
template <typename REAL>
class WritableLimitTable : public LimitStencilTableTypes<REAL>::Table {
public:
    explicit WritableLimitTable(int numControlVertices)
        : LimitStencilTableTypes<REAL>::Table(numControlVertices, {}, {}, {}, {}, {}, {}, {}, {},
                                              {}, false, 0) {}

    void Resize(std::size_t numStencils, std::size_t numWeights, bool hasDerivatives) {
        internal::ResizeLarge(this->_offsets, numStencils);
        internal::ResizeLarge(this->_indices, numWeights);
        internal::ResizeLarge(this->_weights, numWeights);
        if (hasDerivatives) {
            internal::ResizeLarge(duWeights(), numWeights);
            internal::ResizeLarge(dvWeights(), numWeights);
        }
    }

    std::vector<int> &GetRowSizes() { return this->_sizes; }
    std::vector<int> &GetRowOffsets() { return this->_offsets; }

    internal::LimitStencilPlace<REAL> GetPlace(Index row) {
        auto const offset = std::size_t(this->_offsets[std::size_t(row)]);
        bool const hasDerivatives = !duWeights().empty();
        return {this->_indices.data() + offset, this->_weights.data() + offset,
                hasDerivatives ? duWeights().data() + offset : nullptr,
                hasDerivatives ? dvWeights().data() + offset : nullptr};
    }

private:
    // Far's accessors give members of this object as const.  It is not const itself: so they may be written.
    std::vector<REAL> &duWeights() { return const_cast<std::vector<REAL> &>(this->GetDuWeights()); }
    std::vector<REAL> &dvWeights() { return const_cast<std::vector<REAL> &>(this->GetDvWeights()); }
};

// Sources of most vertices of a level, in levels before.
struct EarlierLimits {
    EarlierLimits(internal::MeshLevels const &mesh, int level) : lattice(mesh, level) {}

    CallStatus Find(internal::MeshLevels const &mesh, HexSchemeOptions const &schemeOptions,
                    LimitRows &rows) {
        CallStatus result = lattice.FindMasks(schemeOptions, rows);
        if (!result.IsOk()) {
            return result;
        }
        plain.emplace(mesh, rows.GetLevel().depth, lattice.GetMarks());
        return plain->FindRows(schemeOptions, rows);
    }

    LatticeFaces lattice;
    std::optional<PlainFaces> plain;
};

// The rows of a table, in its order: those of vertices, further sides and face centres.
class PointRows {
public:
    PointRows(LimitRows const *vertexRows, LimitSides const *sides,
              FaceLimitMaskFinder const *faceMasks, Level const &level)
        : _vertexRows(vertexRows), _sides(sides), _faceMasks(faceMasks), _level(level),
          _numSides(!vertexRows ? 0
                    : sides     ? sides->GetNumSides()
                                : level.numVertices) {}

    std::int64_t GetNumRows() const {
        return std::int64_t(_numSides) + (_faceMasks ? _level.numFaces : 0);
    }
    // Rows of vertices.
    Index GetNumVertexRows() const { return _vertexRows ? _level.numVertices : 0; }

    // Memory that a row refers to.
    struct Scratch {
        Index sources[internal::PlainNeighborhoodGatherer::kNumRegular];
        LimitMask mask;
        std::map<int, LimitMask> plainMasks; // of faces, by size
    };

    // In terms of the vertices of the level; not that of a vertex which is made otherwise.
    LimitRow GetRow(Index row, Scratch &scratch) const {
        if (row < _numSides) {
            return _vertexRows->GetRow(_sides ? _sides->GetVertex(row) : row,
                                       _sides ? _sides->GetLocalSide(row) : 0, scratch.sources);
        }
        Index const face = row - _numSides;
        LimitMask const &mask = findFaceMask(face, scratch);
        LimitMask::Tangents const &tangents = mask.sides.front();
        return {_level.GetFaceSize(face), _level.GetFaceVertices(face).begin(), mask.weights.data(),
                tangents.du.data(), tangents.dv.data()};
    }

private:
    LimitMask const &findFaceMask(Index face, Scratch &scratch) const {
        if (!_faceMasks->IsPlain(face)) {
            scratch.mask = _faceMasks->Find(face);
            return scratch.mask;
        }
        LimitMask &mask = scratch.plainMasks[_level.GetFaceSize(face)];
        if (mask.weights.empty()) {
            mask = _faceMasks->Find(face);
        }
        return mask;
    }

    LimitRows const *const _vertexRows;
    LimitSides const *const _sides;
    FaceLimitMaskFinder const *const _faceMasks;
    Level const &_level;
    Index const _numSides;
};

// Rows that are made together: vertices in a plain face, or some rows that are near one another.
struct RowGroup {
    PlainFaces::Face const *face = nullptr;
    int first = 0; ///< of the outputs of the face, or of a list of rows
};

// The rows of a table, but for those of lattices, in groups.
class RowGroups {
public:
    RowGroups(internal::MeshLevels const &mesh, int level, PointRows const &rows,
              EarlierLimits const *earlier) {
        if (earlier) {
            for (PlainFaces::Face const &face : earlier->plain->GetFaces()) {
                int const numOutputs =
                    earlier->plain->GetTypes()[std::size_t(face.type)].numOutputs;
                for (int first = 0; first < numOutputs; first += internal::kMaxLimitRows) {
                    _groups.push_back({&face, first});
                }
            }
            addVertices(mesh, level, earlier->plain->GetOthers());
        } else if (rows.GetNumVertexRows() > 0) {
            std::vector<Index> verts(std::size_t(rows.GetNumVertexRows()));
            std::iota(verts.begin(), verts.end(), 0);
            addVertices(mesh, level, verts);
        }
        auto const numRows = Index(rows.GetNumRows());
        for (Index row = rows.GetNumVertexRows(); row < numRows; ++row) {
            _groups.push_back({nullptr, Index(_rows.size())});
            _rows.push_back(row);
        }
        _numGroups = Index(_groups.size());
        _groups.push_back({nullptr, Index(_rows.size())});
    }

    Index GetNum() const { return _numGroups; }
    RowGroup const &Get(Index group) const { return _groups[std::size_t(group)]; }
    // The rows of a group without a face.
    Far::ConstIndexArray GetRows(Index group) const {
        Index const first = Get(group).first;
        return {_rows.data() + first, Get(group + 1).first - first};
    }

private:
    // F-vertices of one face go together.
    void addVertices(internal::MeshLevels const &mesh, int level, std::vector<Index> const &verts) {
        constexpr int kMaxVertices = 8;
        // Vertices are numbered as those of the levels before, as far as all of these make V-vertices.
        int child = level;
        while (child > 0 && !mesh.refinements[std::size_t(child) - 1].isTruncation &&
               mesh.levels[std::size_t(child)].numVVertices ==
                   mesh.levels[std::size_t(child) - 1].numVertices) {
            --child;
        }
        Index end = mesh.levels[std::size_t(child)].numVertices; // of the vertices of a level
        Index endOfFace = 0;
        int numTogether = 0;
        for (Index const vert : verts) {
            while (vert >= end) {
                end = mesh.levels[std::size_t(++child)].numVertices;
            }
            if (vert >= endOfFace || numTogether == kMaxVertices) {
                _groups.push_back({nullptr, Index(_rows.size())});
                numTogether = 0;
            }
            if (vert >= endOfFace) {
                endOfFace = findEndOfFace(mesh, child, vert);
            }
            _rows.push_back(vert);
            ++numTogether;
        }
    }

    static Index findEndOfFace(internal::MeshLevels const &mesh, int child, Index vert) {
        internal::Refinement const *const refinement =
            child > 0 ? &mesh.refinements[std::size_t(child) - 1] : nullptr;
        if (!refinement || refinement->isTruncation || vert < refinement->child->numVVertices) {
            return vert + 1;
        }
        Level const &parent = *refinement->parent;
        Index const corner = refinement->GetChildVertexCorner(vert);
        return vert + parent.faceFirstCorner[parent.FindFaceOfCorner(corner) + 1] - corner;
    }

    std::vector<RowGroup> _groups;
    Index _numGroups = 0;
    std::vector<Index> _rows;
};

// Makes a table of rows: first the sizes of all stencils, then the stencils.
template <typename REAL>
class TableBuilder {
    using Multiplier = internal::LimitMultiplier<REAL>;
    using Columns = typename Multiplier::Columns;
    using RowBits = typename Multiplier::RowBits;
    using SharedRows = typename Multiplier::SharedRows;
    using LatticeStencils = internal::LatticeStencils<REAL>;

public:
    TableBuilder(internal::MeshLevels const &mesh, int level, PointRows const &rows,
                 EarlierLimits const *earlier, Index numIndices, bool hasDerivatives)
        : _level(level), _rows(rows), _plain(earlier ? &*earlier->plain : nullptr),
          _groups(mesh, level, rows, earlier), _numIndices(numIndices),
          _hasDerivatives(hasDerivatives), _table(new WritableLimitTable<REAL>(numIndices)) {
        if (earlier) {
            _lattice.emplace(earlier->lattice, hasDerivatives);
            for (PlainFaces::Type const &type : _plain->GetTypes()) {
                _sharedRows.push_back(shareRows(type));
            }
        }
    }

    // Makes the stencils of which those of rows are combined, when the rows are to be factorized.
    CallStatus FormStencils(internal::Hierarchy const &hierarchy,
                            HexSchemeOptions const &schemeOptions) {
        std::vector<std::vector<Index>> wanted = findSources(hierarchy.mesh);
        while (!wanted.empty() && wanted.back().empty()) {
            wanted.pop_back();
        }
        if (wanted.size() < 2) {
            return CallStatus(); // the control vertices themselves
        }
        _stencils.emplace(hierarchy, schemeOptions, std::move(wanted));
        return _stencils->Form();
    }

    CallStatus Build() {
        std::vector<int> &sizes = _table->GetRowSizes();
        auto const numRows = std::size_t(_rows.GetNumRows());
        internal::ResizeLarge(sizes, numRows);
        if (_lattice) {
            _lattice->CountSizes(sizes.data());
        }
        std::vector<KeptColumns> kept(
            std::size_t(internal::GetNumParallelRanges(_groups.GetNum(), kRange)));
        forEachGroup([&](Multiplier &multiplier, Index const *rows, Index group) {
            Columns const columns = multiplier.FindColumns();
            kept[std::size_t(group / kRange)].Add(columns);
            for (int row = 0; row < multiplier.GetNumRows(); ++row) {
                if (rows[row] != Far::INDEX_INVALID) {
                    sizes[std::size_t(rows[row])] =
                        int(std::count_if(columns.rows, columns.rows + columns.size,
                                          [row](RowBits bits) { return (bits >> row & 1) != 0; }));
                }
            }
        });
        std::int64_t const numWeights =
            std::accumulate(sizes.begin(), sizes.end(), std::int64_t(0));
        if (numWeights > std::numeric_limits<Index>::max()) {
            return CallStatus(StatusCode::TooLarge, ComponentType::Level, _level,
                              "the limit stencils of level " + std::to_string(_level) +
                                  " would have " + std::to_string(numWeights) +
                                  " weights, more than Far's 32-bit offsets reach");
        }
        _table->Resize(numRows, std::size_t(numWeights), _hasDerivatives);
        std::exclusive_scan(sizes.begin(), sizes.end(), _table->GetRowOffsets().begin(), 0);
        if (_lattice) {
            _lattice->Fill([&](Index row) { return _table->GetPlace(row); });
        }
        forEachGroup([&](Multiplier &multiplier, Index const *rows, Index group) {
            internal::LimitStencilPlace<REAL> places[internal::kMaxLimitRows] = {};
            for (int row = 0; row < multiplier.GetNumRows(); ++row) {
                if (rows[row] != Far::INDEX_INVALID) {
                    places[row] = _table->GetPlace(rows[row]);
                }
            }
            multiplier.Fill(kept[std::size_t(group / kRange)].Get(group % kRange), places);
        });
        return CallStatus();
    }

    std::unique_ptr<WritableLimitTable<REAL>> TakeTable() { return std::move(_table); }

private:
    // The columns of the groups of a range.
    struct KeptColumns {
        void Add(Columns const &columns) {
            firsts.push_back(indices.size());
            indices.insert(indices.end(), columns.indices, columns.indices + columns.size);
            rows.insert(rows.end(), columns.rows, columns.rows + columns.size);
        }
        Columns Get(Index group) const {
            std::size_t const first = firsts[std::size_t(group)];
            std::size_t const end = std::size_t(group) + 1 < firsts.size()
                                        ? firsts[std::size_t(group) + 1]
                                        : indices.size();
            return {indices.data() + first, rows.data() + first, int(end - first)};
        }

        std::vector<std::size_t> firsts;
        std::vector<Index> indices;
        std::vector<RowBits> rows;
    };

    // Scratch memory of a thread.
    struct State {
        Multiplier multiplier;
        PointRows::Scratch scratch;
        Index rows[internal::kMaxLimitRows]; // of the table, by row of the multiplier
    };

    // The rows of a type, as many at a time as a group has.
    std::vector<SharedRows> shareRows(PlainFaces::Type const &type) const {
        std::vector<SharedRows> result;
        Multiplier multiplier(nullptr, 0, _hasDerivatives);
        std::vector<Index> numbers(std::size_t(type.numSources));
        std::iota(numbers.begin(), numbers.end(), 0);
        std::vector<double> weights[3];
        for (int output = 0; output < type.numOutputs; ++output) {
            for (std::size_t sum = 0; sum < 3; ++sum) {
                weights[sum].clear();
                for (internal::LimitWeights const &ofSource : type.rows[std::size_t(output)]) {
                    weights[sum].push_back(ofSource[sum]);
                }
            }
            multiplier.AddRow({type.numSources, numbers.data(), weights[0].data(),
                               weights[1].data(), weights[2].data()},
                              0);
            if (multiplier.GetNumRows() == internal::kMaxLimitRows ||
                output + 1 == type.numOutputs) {
                result.push_back(multiplier.ShareRows());
                multiplier.Clear();
            }
        }
        return result;
    }

    // The vertices of each level that rows are in terms of, ascending.
    std::vector<std::vector<Index>> findSources(internal::MeshLevels const &mesh) const {
        // Set by several threads.
        std::vector<std::vector<std::atomic<unsigned char>>> marks(std::size_t(_level) + 1);
        for (std::size_t level = 0; level < marks.size(); ++level) {
            marks[level] = std::vector<std::atomic<unsigned char>>(
                std::size_t(mesh.levels[level].numVertices));
        }
        auto const mark = [&](int level, Index const *verts, int numVerts) {
            for (int i = 0; i < numVerts; ++i) {
                marks[std::size_t(level)][std::size_t(verts[i])].store(1,
                                                                       std::memory_order_relaxed);
            }
        };
        internal::ParallelForRange(
            _groups.GetNum(), [] { return PointRows::Scratch(); },
            [&](PointRows::Scratch &scratch, Index begin, Index end) {
                for (Index i = begin; i < end; ++i) {
                    RowGroup const &group = _groups.Get(i);
                    if (group.face) {
                        mark(_plain->GetLevel(), _plain->GetSources(*group.face),
                             getType(group).numSources);
                        continue;
                    }
                    for (Index const row : _groups.GetRows(i)) {
                        LimitRow const limitRow = _rows.GetRow(row, scratch);
                        mark(_level, limitRow.sources, limitRow.size);
                    }
                }
            },
            kRange);
        std::vector<std::vector<Index>> sources;
        sources.reserve(marks.size());
        for (auto const &ofLevel : marks) {
            sources.push_back(internal::ParallelSelect(Index(ofLevel.size()), [&](Index vert) {
                return ofLevel[std::size_t(vert)].load(std::memory_order_relaxed) != 0;
            }));
        }
        return sources;
    }

    Index getFirstSource(int level) const { return _stencils ? _stencils->GetFirst(level) : 0; }

    PlainFaces::Type const &getType(RowGroup const &group) const {
        return _plain->GetTypes()[std::size_t(group.face->type)];
    }

    void setRows(Index number, State &state) const {
        RowGroup const &group = _groups.Get(number);
        if (group.face) {
            state.multiplier.SetRows(
                _sharedRows[std::size_t(group.face->type)]
                           [std::size_t(group.first / internal::kMaxLimitRows)],
                _plain->GetSources(*group.face), getFirstSource(_plain->GetLevel()));
            std::copy_n(_plain->GetOutputs(*group.face) + group.first,
                        state.multiplier.GetNumRows(), state.rows);
            return;
        }
        state.multiplier.Clear();
        Index *next = state.rows;
        for (Index const row : _groups.GetRows(number)) {
            state.multiplier.AddRow(_rows.GetRow(row, state.scratch), getFirstSource(_level));
            *next++ = row;
        }
    }

    // Calls function(multiplier, rows, group) for each group: the multiplier has those rows of it.
    template <typename FUNCTION>
    void forEachGroup(FUNCTION function) {
        internal::ParallelForRange(
            _groups.GetNum(),
            [&] {
                return State{
                    Multiplier(_stencils ? &*_stencils : nullptr, _numIndices, _hasDerivatives),
                    {},
                    {}};
            },
            [&](State &state, Index begin, Index end) {
                for (Index group = begin; group < end; ++group) {
                    setRows(group, state);
                    function(state.multiplier, state.rows, group);
                }
            },
            kRange);
    }

    static constexpr Index kRange = 64; // groups, which take some microseconds each

    int const _level;
    PointRows const &_rows;
    PlainFaces const *const _plain;
    RowGroups const _groups;
    Index const _numIndices;
    bool const _hasDerivatives;
    std::unique_ptr<WritableLimitTable<REAL>> _table;
    std::optional<LatticeStencils> _lattice;
    std::vector<std::vector<SharedRows>> _sharedRows; // by type
    std::optional<LevelStencils> _stencils;
};

template <typename OPTIONS>
CallStatus checkLimitOptions(TopologyRefiner const &refiner, OPTIONS const &options) {
    CallStatus result = internal::CheckLimitLevel(refiner.GetHierarchy(),
                                                  refiner.GetHexSchemeOptions(), options.level);
    if (!result.IsOk()) {
        return result;
    }
    auto const fail = [&](std::string const &message) {
        return CallStatus(StatusCode::InvalidArgument, ComponentType::Level, options.level,
                          message);
    };
    std::string const level = "level " + std::to_string(options.level);
    if (!options.generateVertices && !options.generateFaceCenters) {
        return fail("neither vertices nor face centers of " + level + " are asked for");
    }
    if (!options.generateVertices && options.generateFurtherSides) {
        return fail("further sides of vertices of " + level + " are asked for without vertices");
    }
    return CallStatus();
}

CallStatus checkNumRows(int level, std::int64_t numRows) {
    if (numRows < std::numeric_limits<Index>::max()) {
        return CallStatus();
    }
    return CallStatus(StatusCode::TooLarge, ComponentType::Level, level,
                      "the limit table of level " + std::to_string(level) + " would have " +
                          std::to_string(numRows) + " stencils, more than 32-bit indices reach");
}

} // namespace

template <typename REAL>
auto LimitStencilTableFactoryReal<REAL>::Create(TopologyRefiner const &refiner, Options options,
                                                CallStatus *status)
    -> std::unique_ptr<Table const> {
    if (options.level == -1) {
        options.level = refiner.GetMaxLevel();
    }
    if (!internal::Report(checkLimitOptions(refiner, options), status)) {
        return nullptr;
    }
    TopologyLevel const &topologyLevel = refiner.GetLevel(options.level);
    Level const &level = topologyLevel.GetLevel();
    HexSchemeOptions const schemeOptions = refiner.GetHexSchemeOptions();
    internal::MeshLevels const &mesh = refiner.GetHierarchy().mesh;
    bool const hasStencils = options.factorizeIntermediateLevels && options.level > 0;
    std::optional<LimitRows> vertexRows;
    std::optional<EarlierLimits> earlier;
    if (options.generateVertices) {
        vertexRows.emplace(level, refiner.GetSchemeOptions(), schemeOptions);
        if (hasStencils) {
            earlier.emplace(mesh, options.level);
        }
        CallStatus const result =
            earlier ? earlier->Find(mesh, schemeOptions, *vertexRows) : vertexRows->Find();
        if (!internal::Report(result, status)) {
            return nullptr;
        }
    }
    std::optional<LimitSides> sides;
    if (options.generateFurtherSides) {
        sides.emplace(topologyLevel);
    }
    std::optional<FaceLimitMaskFinder> faceMasks;
    if (options.generateFaceCenters) {
        faceMasks.emplace(level, refiner.GetSchemeOptions(),
                          internal::GetStepsToLimit(schemeOptions));
    }
    EarlierLimits const *const ofEarlier = earlier ? &*earlier : nullptr;
    PointRows const rows(vertexRows ? &*vertexRows : nullptr, sides ? &*sides : nullptr,
                         faceMasks ? &*faceMasks : nullptr, level);
    if (!internal::Report(checkNumRows(options.level, rows.GetNumRows()), status)) {
        return nullptr;
    }
    TableBuilder<REAL> builder(mesh, options.level, rows, ofEarlier,
                               refiner.GetLevel(hasStencils ? 0 : options.level).GetNumVertices(),
                               options.generate1stDerivatives);
    if (hasStencils &&
        !internal::Report(builder.FormStencils(refiner.GetHierarchy(), schemeOptions), status)) {
        return nullptr;
    }
    if (!internal::Report(builder.Build(), status)) {
        return nullptr;
    }
    return builder.TakeTable();
}

template class LimitStencilTableFactoryReal<float>;
template class LimitStencilTableFactoryReal<double>;

} // namespace OpenSubdivHex::FarExt

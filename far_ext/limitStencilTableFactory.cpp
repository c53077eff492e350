// SPDX-License-Identifier: Apache-2.0
#include "limitStencilTableFactory.h"

#include "far_ext/limit/latticeStencils.h"
#include "far_ext/limit/limitMultiplier.h"
#include "far_ext/limit/regularFaces.h"
#include "far_ext/limit/regularVertices.h"
#include "far_ext/stencil/levelStencils.h"
#include "far_ext/vtr/hierarchy.h"
#include "far_ext/vtr/parallel.h"

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
using internal::RegularFace;
using internal::RegularFaces;
using internal::RegularVertices;

LimitSides::LimitSides(TopologyLevel const &level) : _numVertices(level.GetNumVertices()) {
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
            for (internal::RingItem const &item : sides[side].items) {
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

    typename internal::LimitMultiplier<REAL>::Place GetPlace(Index row) {
        auto const offset = std::size_t(this->_offsets[std::size_t(row)]);
        bool const hasDerivatives = !duWeights().empty();
        return {this->_indices.data() + offset, this->_weights.data() + offset,
                hasDerivatives ? duWeights().data() + offset : nullptr,
                hasDerivatives ? dvWeights().data() + offset : nullptr};
    }

private:
    // What the accessors refer to is constant by its type alone, the table being none.
    std::vector<REAL> &duWeights() { return const_cast<std::vector<REAL> &>(this->GetDuWeights()); }
    std::vector<REAL> &dvWeights() { return const_cast<std::vector<REAL> &>(this->GetDvWeights()); }
};

// What the limit of the vertices of a level follows from, in terms of control vertices or of levels
// before.
struct EarlierLimits {
    EarlierLimits(internal::MeshLevels const &mesh, int level) : lattice(mesh, level) {}

    Status Find(internal::MeshLevels const &mesh, HexSchemeOptions const &schemeOptions,
                LimitRows &rows) {
        Status result = lattice.FindMasks(schemeOptions, rows);
        if (!result.IsOk()) {
            return result;
        }
        faces.emplace(mesh, rows.GetLevel().depth, lattice.GetMarks());
        result = faces->FindMasks(schemeOptions, rows);
        if (result.IsOk()) {
            verts.emplace(mesh, schemeOptions, rows, faces->GetOthers());
        }
        return result;
    }

    LatticeFaces lattice;
    std::optional<RegularFaces> faces;
    std::optional<RegularVertices> verts;
};

// The rows of a table, in its order: those of vertices, further sides and face centres.  Each is in
// terms of the vertices of some level.
class PointRows {
public:
    // None, for a row that is made otherwise.
    static constexpr int kNoLevel = -1;

    PointRows(LimitRows const *vertexRows, EarlierLimits const *earlier, LimitSides const *sides,
              FaceLimitMaskFinder const *faceMasks, Level const &level)
        : _vertexRows(vertexRows), _earlier(earlier), _sides(sides), _faceMasks(faceMasks),
          _level(level), _numSides(!vertexRows ? 0
                                   : sides     ? sides->GetNumSides()
                                               : level.numVertices) {}

    std::int64_t GetNumRows() const {
        return std::int64_t(_numSides) + (_faceMasks ? _level.numFaces : 0);
    }
    // Of vertices.
    Index GetNumVertexRows() const { return _vertexRows ? _level.numVertices : 0; }

    // Once their number is checked.
    void FindLevels() {
        _levels.assign(std::size_t(GetNumRows()), _level.depth);
        if (!_earlier) {
            return;
        }
        std::vector<unsigned char> const &ofLattice = _earlier->lattice.GetMarks();
        internal::ParallelFor(Index(ofLattice.size()), [&](Index vert) {
            if (ofLattice[std::size_t(vert)]) {
                _levels[std::size_t(vert)] = kNoLevel;
            }
        });
        for (RegularFaces::OfLevel const &ofLevel : _earlier->faces->GetLevels()) {
            for (RegularFaces::Set const *set : {&ofLevel.fVertices, &ofLevel.ownVertices}) {
                internal::ParallelFor(Index(set->faces.size()), [&](Index i) {
                    RegularFace const &face = set->faces[std::size_t(i)];
                    face.ForEachCorner([&](int corner) {
                        _levels[std::size_t(set->firstVertex + face.firstCorner + corner)] =
                            kNoLevel;
                    });
                });
            }
        }
        for (int level = 0; level < _level.depth; ++level) {
            for (Index const vert : _earlier->verts->GetVertices(level)) {
                _levels[std::size_t(vert)] = level;
            }
        }
    }
    // The level of the vertices of a row.
    int GetLevel(Index row) const { return _levels[std::size_t(row)]; }

    // What a row refers to.
    struct Scratch {
        Index sources[internal::PlainNeighborhoodGatherer::kNumRegular];
        LimitMask mask;
        std::map<int, LimitMask> plainMasks; // of faces, by size
    };

    // That of a row which has a level.
    LimitRow GetRow(Index row, Scratch &scratch) const {
        if (row < _numSides) {
            Index const vert = _sides ? _sides->GetVertex(row) : row;
            return GetLevel(row) < _level.depth
                       ? _earlier->verts->GetRow(GetLevel(row), vert, scratch.sources)
                       : _vertexRows->GetRow(vert, _sides ? _sides->GetLocalSide(row) : 0,
                                             scratch.sources);
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
    EarlierLimits const *const _earlier;
    LimitSides const *const _sides;
    FaceLimitMaskFinder const *const _faceMasks;
    Level const &_level;
    Index const _numSides;
    std::vector<int> _levels; // by row
};

// Rows that are made together: the limits that a regular face gives, or some that are near one another.
struct RowGroup {
    Index first; ///< that of the face's corner 0, or the number in a list of rows
    RegularFace const *face = nullptr; ///< of one of the sets
    int set = -1;                      ///< its number, or -1
};

// The rows in a table that have a level, in groups: the F-vertices of a face are near one another.
class RowGroups {
public:
    RowGroups(internal::MeshLevels const &mesh, int level, PointRows const &rows,
              std::vector<RegularFaces::Set const *> const &sets) {
        for (std::size_t i = 0; i < sets.size(); ++i) {
            for (RegularFace const &face : sets[i]->faces) {
                _groups.push_back({sets[i]->firstVertex + face.firstCorner, &face, int(i)});
            }
        }
        addVertices(mesh, level, rows);
        auto const numRows = Index(rows.GetNumRows());
        for (Index row = rows.GetNumVertexRows(); row < numRows; ++row) {
            addRows(row, row + 1, rows);
        }
        _numGroups = Index(_groups.size());
        _groups.push_back({Index(_rows.size())});
    }

    Index GetNum() const { return _numGroups; }
    RowGroup const &Get(Index group) const { return _groups[std::size_t(group)]; }
    // Of a group without a face.
    Far::ConstIndexArray GetRows(Index group) const {
        Index const first = Get(group).first;
        return {_rows.data() + first, Get(group + 1).first - first};
    }

private:
    // Those of the rows that have a level.
    void addRows(Index begin, Index end, PointRows const &rows) {
        auto const first = Index(_rows.size());
        for (Index row = begin; row < end; ++row) {
            if (rows.GetLevel(row) == PointRows::kNoLevel) {
                continue;
            }
            if ((Index(_rows.size()) - first) % internal::kMaxLimitRows == 0) {
                _groups.push_back({Index(_rows.size())});
            }
            _rows.push_back(row);
        }
    }

    void addVertices(internal::MeshLevels const &mesh, int level, PointRows const &rows) {
        Index const numVertices = rows.GetNumVertexRows();
        // Vertices are numbered as those of the levels before, as far as all of these make V-vertices.
        int firstLevel = level;
        while (firstLevel > 0 && !mesh.refinements[std::size_t(firstLevel) - 1].isTruncation &&
               mesh.levels[std::size_t(firstLevel)].numVVertices ==
                   mesh.levels[std::size_t(firstLevel) - 1].numVertices) {
            --firstLevel;
        }
        Index const numFirst =
            std::min(numVertices, mesh.levels[std::size_t(firstLevel)].numVertices);
        for (Index row = 0; row < numFirst; ++row) {
            addRows(row, row + 1, rows);
        }
        for (int child = firstLevel + 1; child <= level && numVertices > 0; ++child) {
            Level const &parent = mesh.levels[std::size_t(child) - 1];
            for (Index face = 0; face < parent.numFaces; ++face) {
                addRows(parent.numVertices + parent.faceFirstCorner[face],
                        parent.numVertices + parent.faceFirstCorner[face + 1], rows);
            }
        }
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
    using FaceRows = internal::RegularFaceRows;
    using LatticeStencils = internal::LatticeStencils<REAL>;

public:
    TableBuilder(internal::MeshLevels const &mesh, int level, PointRows const &rows,
                 EarlierLimits const *earlier, Index numIndices, bool hasDerivatives)
        : _level(level), _rows(rows), _numIndices(numIndices), _hasDerivatives(hasDerivatives),
          _table(new WritableLimitTable<REAL>(numIndices)) {
        std::vector<RegularFaces::Set const *> sets;
        if (earlier) {
            _lattice.emplace(earlier->lattice, hasDerivatives);
            std::vector<RegularFaces::OfLevel> const &levels = earlier->faces->GetLevels();
            for (std::size_t i = 0; i < levels.size(); ++i) {
                for (RegularFaces::Set const *set :
                     {&levels[i].fVertices, &levels[i].ownVertices}) {
                    if (!set->faces.empty()) {
                        sets.push_back(set);
                        _regularRows.push_back({&mesh.levels[i], {}});
                        shareRows(*set, _regularRows.back());
                    }
                }
            }
        }
        _groups.emplace(mesh, level, rows, sets);
    }

    // Makes the stencils of which those of rows are combined, when the rows are to be factorized.
    Status FormStencils(internal::Hierarchy const &hierarchy,
                        HexSchemeOptions const &schemeOptions) {
        std::vector<std::vector<Index>> wanted = findSources(hierarchy.mesh);
        while (!wanted.empty() && wanted.back().empty()) {
            wanted.pop_back();
        }
        if (wanted.size() < 2) {
            return Status(); // the control vertices themselves
        }
        _stencils.emplace(hierarchy, schemeOptions, std::move(wanted));
        return _stencils->Form();
    }

    Status Build() {
        std::vector<int> &sizes = _table->GetRowSizes();
        auto const numRows = std::size_t(_rows.GetNumRows());
        internal::ResizeLarge(sizes, numRows);
        if (_lattice) {
            _lattice->CountSizes(sizes.data());
        }
        std::vector<KeptColumns> kept(
            std::size_t(internal::GetNumParallelRanges(_groups->GetNum(), kRange)));
        forEachGroup([&](Multiplier &multiplier, Index const *rows, Index group) {
            Columns const columns = multiplier.FindColumns();
            kept[std::size_t(group / kRange)].Add(columns);
            for (int row = 0; row < multiplier.GetNumRows(); ++row) {
                sizes[std::size_t(rows[row])] =
                    int(std::count_if(columns.rows, columns.rows + columns.size,
                                      [row](RowBits bits) { return (bits >> row & 1) != 0; }));
            }
        });
        std::int64_t const numWeights =
            std::accumulate(sizes.begin(), sizes.end(), std::int64_t(0));
        if (numWeights > std::numeric_limits<Index>::max()) {
            return Status(StatusCode::TooLarge, ComponentType::Level, _level,
                          "the limit stencils of level " + std::to_string(_level) + " would have " +
                              std::to_string(numWeights) +
                              " weights, more than Far's 32-bit offsets reach");
        }
        _table->Resize(numRows, std::size_t(numWeights), _hasDerivatives);
        std::exclusive_scan(sizes.begin(), sizes.end(), _table->GetRowOffsets().begin(), 0);
        if (_lattice) {
            _lattice->Fill([&](Index row) { return _table->GetPlace(row); });
        }
        forEachGroup([&](Multiplier &multiplier, Index const *rows, Index group) {
            typename Multiplier::Place places[internal::kMaxLimitRows];
            for (int row = 0; row < multiplier.GetNumRows(); ++row) {
                places[row] = _table->GetPlace(rows[row]);
            }
            multiplier.Fill(kept[std::size_t(group / kRange)].Get(group % kRange), places);
        });
        return Status();
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

    // Of a set of regular faces.
    struct RegularRows {
        Level const *level;
        std::map<unsigned, typename Multiplier::SharedRows> ofCorners; // by RegularFace::corners
    };

    // What a thread makes rows with.
    struct State {
        Multiplier multiplier;
        PointRows::Scratch scratch;
        Index rows[internal::kMaxLimitRows]; // of the table, by row of the multiplier
    };

    // The rows of all kinds of faces of a set: some have fewer corners.
    void shareRows(RegularFaces::Set const &set, RegularRows &regular) const {
        FaceRows const rows(set.mask);
        Multiplier multiplier(nullptr, 0, _hasDerivatives);
        for (RegularFace const &face : set.faces) {
            if (regular.ofCorners.count(face.corners) > 0) {
                continue;
            }
            multiplier.Clear();
            face.ForEachCorner([&](int corner) {
                Index numbers[FaceRows::kNumSources];
                multiplier.AddRow(rows.GetRow(corner, numbers), 0);
            });
            regular.ofCorners.emplace(face.corners, multiplier.ShareRows());
        }
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
            _groups->GetNum(), [] { return PointRows::Scratch(); },
            [&](PointRows::Scratch &scratch, Index begin, Index end) {
                for (Index i = begin; i < end; ++i) {
                    RowGroup const &group = _groups->Get(i);
                    if (group.face) {
                        Level const &level = *_regularRows[std::size_t(group.set)].level;
                        Index sources[FaceRows::kNumFaceSources];
                        FaceRows::GetFaceSources(level, *group.face, sources);
                        mark(level.depth, sources, FaceRows::kNumFaceSources);
                        continue;
                    }
                    for (Index const row : _groups->GetRows(i)) {
                        LimitRow const limitRow = _rows.GetRow(row, scratch);
                        mark(_rows.GetLevel(row), limitRow.sources, limitRow.size);
                    }
                }
            },
            kRange);
        std::vector<std::vector<Index>> sources;
        for (auto const &ofLevel : marks) {
            sources.push_back(internal::ParallelSelect(Index(ofLevel.size()), [&](Index vert) {
                return ofLevel[std::size_t(vert)].load(std::memory_order_relaxed) != 0;
            }));
        }
        return sources;
    }

    Index getFirstSource(int level) const { return _stencils ? _stencils->GetFirst(level) : 0; }

    void setRows(Index number, State &state) const {
        RowGroup const &group = _groups->Get(number);
        Index *next = state.rows;
        if (group.face) {
            RegularRows const &regular = _regularRows[std::size_t(group.set)];
            Index sources[FaceRows::kNumFaceSources];
            FaceRows::GetFaceSources(*regular.level, *group.face, sources);
            state.multiplier.SetRows(regular.ofCorners.at(group.face->corners), sources,
                                     getFirstSource(regular.level->depth));
            group.face->ForEachCorner([&](int corner) { *next++ = group.first + corner; });
            return;
        }
        state.multiplier.Clear();
        for (Index const row : _groups->GetRows(number)) {
            state.multiplier.AddRow(_rows.GetRow(row, state.scratch),
                                    getFirstSource(_rows.GetLevel(row)));
            *next++ = row;
        }
    }

    // Calls function(multiplier, rows, group) for each group: the multiplier has those rows of it.
    template <typename FUNCTION>
    void forEachGroup(FUNCTION function) {
        internal::ParallelForRange(
            _groups->GetNum(),
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
    Index const _numIndices;
    bool const _hasDerivatives;
    std::unique_ptr<WritableLimitTable<REAL>> _table;
    std::optional<LatticeStencils> _lattice;
    std::vector<RegularRows> _regularRows; // by set
    std::optional<RowGroups> _groups;
    std::optional<LevelStencils> _stencils;
};

template <typename OPTIONS>
Status checkOptions(TopologyRefiner const &refiner, OPTIONS const &options) {
    Status result = internal::CheckLimitLevel(refiner.GetHierarchy(), refiner.GetHexSchemeOptions(),
                                              options.level);
    if (!result.IsOk()) {
        return result;
    }
    auto const fail = [&](std::string const &message) {
        return Status(StatusCode::InvalidArgument, ComponentType::Level, options.level, message);
    };
    std::string const level = "level " + std::to_string(options.level);
    if (!options.generateVertices && !options.generateFaceCenters) {
        return fail("neither vertices nor face centers of " + level + " are asked for");
    }
    if (!options.generateVertices && options.generateFurtherSides) {
        return fail("further sides of vertices of " + level + " are asked for without vertices");
    }
    return Status();
}

Status checkNumRows(int level, std::int64_t numRows) {
    if (numRows < std::numeric_limits<Index>::max()) {
        return Status();
    }
    return Status(StatusCode::TooLarge, ComponentType::Level, level,
                  "the limit table of level " + std::to_string(level) + " would have " +
                      std::to_string(numRows) + " stencils, more than 32-bit indices reach");
}

} // namespace

template <typename REAL>
auto LimitStencilTableFactoryReal<REAL>::Create(TopologyRefiner const &refiner, Options options,
                                                Status *status) -> std::unique_ptr<Table const> {
    if (!internal::Report(checkOptions(refiner, options), status)) {
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
        Status const result =
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
    PointRows rows(vertexRows ? &*vertexRows : nullptr, ofEarlier, sides ? &*sides : nullptr,
                   faceMasks ? &*faceMasks : nullptr, level);
    if (!internal::Report(checkNumRows(options.level, rows.GetNumRows()), status)) {
        return nullptr;
    }
    rows.FindLevels();
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

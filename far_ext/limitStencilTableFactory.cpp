// SPDX-License-Identifier: Apache-2.0
#include "limitStencilTableFactory.h"

#include "far_ext/limit/limitMultiplier.h"
#include "far_ext/limit/regularFaces.h"
#include "far_ext/stencil/levelStencils.h"
#include "far_ext/vtr/hierarchy.h"
#include "far_ext/vtr/parallel.h"

#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

namespace OpenSubdivHex::FarExt {

using Far::Index;
using internal::FaceLimitMaskFinder;
using internal::Level;
using internal::LevelStencils;
using internal::LimitMask;
using internal::LimitRow;
using internal::LimitRows;
using internal::RegularFace;
using internal::RegularFaces;

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

    // What a row refers to.
    struct Scratch {
        Index sources[internal::PlainNeighborhoodGatherer::kNumRegular];
        LimitMask mask;
        std::map<int, LimitMask> plainMasks; // of faces, by size
    };

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

// Of the regular faces of a level, those that give the limit of their F-vertices or of their own.
struct RegularKind {
    int level = 0;
    bool isOwn = false;

    RegularFaces::Set const &GetSet(std::vector<RegularFaces::OfLevel> const &levels) const {
        RegularFaces::OfLevel const &ofLevel = levels[std::size_t(level)];
        return isOwn ? ofLevel.ownVertices : ofLevel.fVertices;
    }
};

// Rows of a table that are near one another, up to the first one of the next group.
struct RowGroup {
    Index first;
    RegularFace const *face = nullptr; ///< that gives the limit of some of them, by corner
    RegularKind kind = {};
};

// The faces of a set one after the other, in the order of their corners.
class RegularFaceReader {
public:
    RegularFaceReader(std::vector<RegularFaces::OfLevel> const &levels, RegularKind kind)
        : _kind(kind) {
        if (std::size_t(kind.level) < levels.size()) {
            std::vector<RegularFace> const &faces = kind.GetSet(levels).faces;
            _next = faces.data();
            _end = _next + faces.size();
        }
    }

    // Adds a group if the next face is that with this first corner.
    bool AddGroup(Index firstCorner, Index firstRow, std::vector<RowGroup> &groups) {
        bool const isFound = _next != _end && _next->firstCorner == firstCorner;
        if (isFound) {
            groups.push_back({firstRow, _next++, _kind});
        }
        return isFound;
    }

private:
    RegularKind _kind;
    RegularFace const *_next = nullptr;
    RegularFace const *_end = nullptr;
};

// Cuts the rows of a table into groups: the F-vertices that the steps before made of the same face.
std::vector<RowGroup> makeGroups(internal::MeshLevels const &mesh, int level, Index numVertexRows,
                                 Index numRows,
                                 std::vector<RegularFaces::OfLevel> const &regularLevels) {
    std::vector<RowGroup> groups;
    // Vertices are numbered as those of the levels before, as far as all of these make V-vertices.
    int firstLevel = level;
    while (firstLevel > 0 && !mesh.refinements[std::size_t(firstLevel) - 1].isTruncation &&
           mesh.levels[std::size_t(firstLevel)].numVVertices ==
               mesh.levels[std::size_t(firstLevel) - 1].numVertices) {
        --firstLevel;
    }
    Index const numFirst =
        std::min(numVertexRows, mesh.levels[std::size_t(firstLevel)].numVertices);
    groups.reserve(std::size_t(numFirst) + 1);
    for (Index row = 0; row < numFirst; ++row) {
        groups.push_back({row});
    }
    for (int child = firstLevel + 1; child <= level && numVertexRows > 0; ++child) {
        Level const &parent = mesh.levels[std::size_t(child) - 1];
        // An F-face has its vertices' corners in the order of those that they were made of.
        RegularFaceReader fVertices(regularLevels, {child - 1, false});
        RegularFaceReader ownVertices(regularLevels, {child, true});
        for (Index face = 0; face < parent.numFaces; ++face) {
            Index const begin = parent.faceFirstCorner[face];
            Index const end = parent.faceFirstCorner[face + 1];
            Index const firstRow = parent.numVertices + begin;
            if (fVertices.AddGroup(begin, firstRow, groups) ||
                ownVertices.AddGroup(begin, firstRow, groups)) {
                continue;
            }
            for (Index row = firstRow; row < parent.numVertices + end;
                 row += internal::kMaxLimitRows) {
                groups.push_back({row});
            }
        }
    }
    Index const numVertices = mesh.levels[std::size_t(level)].numVertices;
    for (Index row = std::min(numVertexRows, numVertices); row < numRows; ++row) {
        groups.push_back({row});
    }
    groups.push_back({numRows});
    return groups;
}

// Makes a table of rows: first the sizes of all stencils, then the stencils.
template <typename REAL>
class TableBuilder {
    using Multiplier = internal::LimitMultiplier<REAL>;
    using Columns = typename Multiplier::Columns;
    using RowBits = typename Multiplier::RowBits;
    using FaceRows = internal::RegularFaceRows;

public:
    TableBuilder(PointRows const &rows, std::vector<RowGroup> const &groups,
                 LevelStencils const *stencils, int level, Index numIndices, bool hasDerivatives)
        : _rows(rows), _groups(groups), _stencils(stencils), _level(level),
          _firstSource(stencils ? stencils->GetFirst(level) : 0), _numIndices(numIndices),
          _hasDerivatives(hasDerivatives), _table(new WritableLimitTable<REAL>(numIndices)) {}

    /// The rows of the regular faces in groups, if there are any.
    void SetRegularRows(internal::MeshLevels const &mesh,
                        std::vector<RegularFaces::OfLevel> const &regularLevels) {
        for (std::size_t i = 0; i < regularLevels.size(); ++i) {
            for (bool const isOwn : {false, true}) {
                RegularRows regular = {&mesh.levels[i], _stencils->GetFirst(int(i)), {}};
                addRows(RegularKind{int(i), isOwn}.GetSet(regularLevels), regular);
                _regularRows.push_back(std::move(regular));
            }
        }
    }

    Status Build() {
        std::vector<int> &sizes = _table->GetRowSizes();
        auto const numRows = std::size_t(_rows.GetNumRows());
        internal::ResizeLarge(sizes, numRows);
        std::vector<KeptColumns> kept(
            std::size_t(internal::GetNumParallelRanges(getNumGroups(), kRange)));
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

    // Of a RegularKind.
    struct RegularRows {
        Level const *level;
        Index firstSource; // that of vertex 0 of the level
        std::map<unsigned, typename Multiplier::SharedRows> ofCorners; // by RegularFace::corners
    };

    // What a thread makes rows with.
    struct State {
        Multiplier multiplier;
        PointRows::Scratch scratch;
        Index rows[internal::kMaxLimitRows]; // of the table, by row of the multiplier
    };

    Index getNumGroups() const { return Index(_groups.size()) - 1; }

    // Adds the rows of all kinds of faces of a set: some have fewer corners.
    void addRows(RegularFaces::Set const &set, RegularRows &regular) const {
        FaceRows const rows(set.mask);
        Multiplier multiplier(_stencils, 0, _hasDerivatives);
        for (RegularFace const &face : set.faces) {
            if (regular.ofCorners.count(face.corners) > 0) {
                continue;
            }
            multiplier.Clear();
            for (int corner = 0; corner < internal::kRegularFaceSize; ++corner) {
                if (face.HasCorner(corner)) {
                    Index numbers[FaceRows::kNumSources];
                    multiplier.AddRow(rows.GetRow(corner, numbers), 0);
                }
            }
            regular.ofCorners.emplace(face.corners, multiplier.ShareRows());
        }
    }

    void setRows(std::size_t number, State &state) {
        RowGroup const &group = _groups[number];
        Index *next = state.rows;
        if (group.face) {
            RegularRows const &regular =
                _regularRows[2 * std::size_t(group.kind.level) + std::size_t(group.kind.isOwn)];
            Index sources[FaceRows::kNumFaceSources];
            FaceRows::GetFaceSources(*regular.level, *group.face, sources);
            state.multiplier.SetRows(regular.ofCorners.at(group.face->corners), sources,
                                     regular.firstSource, group.face->HasAllCorners());
            for (int corner = 0; corner < internal::kRegularFaceSize; ++corner) {
                if (group.face->HasCorner(corner)) {
                    *next++ = group.first + corner;
                }
            }
        } else {
            state.multiplier.Clear();
        }
        for (Index row = group.first; row < _groups[number + 1].first; ++row) {
            if (!group.face || !group.face->HasCorner(row - group.first)) {
                state.multiplier.AddRow(_rows.GetRow(row, state.scratch), _firstSource);
                *next++ = row;
            }
        }
    }

    // Calls function(multiplier, rows, group) for each group: the multiplier has those rows of it.
    template <typename FUNCTION>
    void forEachGroup(FUNCTION function) {
        internal::ParallelForRange(
            getNumGroups(),
            [&] {
                return State{Multiplier(_stencils, _numIndices, _hasDerivatives), {}, {}};
            },
            [&](State &state, Index begin, Index end) {
                for (Index group = begin; group < end; ++group) {
                    setRows(std::size_t(group), state);
                    function(state.multiplier, state.rows, group);
                }
            },
            kRange);
    }

    static constexpr Index kRange = 64; // groups, which take some microseconds each

    PointRows const &_rows;
    std::vector<RowGroup> const &_groups;
    std::vector<RegularRows> _regularRows; // by level, of F-vertices and own ones
    LevelStencils const *const _stencils;
    int const _level;
    Index const _firstSource; // that of vertex 0 of the level
    Index const _numIndices;
    bool const _hasDerivatives;
    std::unique_ptr<WritableLimitTable<REAL>> _table;
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
    std::optional<RegularFaces> regularFaces;
    if (options.generateVertices) {
        vertexRows.emplace(level, refiner.GetSchemeOptions(), schemeOptions);
        if (hasStencils) {
            regularFaces.emplace(mesh, options.level);
        }
        Status const result =
            regularFaces ? regularFaces->FindMasks(schemeOptions, *vertexRows) : vertexRows->Find();
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
    PointRows const rows(vertexRows ? &*vertexRows : nullptr, sides ? &*sides : nullptr,
                         faceMasks ? &*faceMasks : nullptr, level);
    if (!internal::Report(checkNumRows(options.level, rows.GetNumRows()), status)) {
        return nullptr;
    }

    std::vector<RegularFaces::OfLevel> const noLevels;
    auto const &regularLevels = regularFaces ? regularFaces->GetLevels() : noLevels;
    std::optional<LevelStencils> stencils;
    if (hasStencils) {
        stencils.emplace(refiner.GetHierarchy(), schemeOptions, options.level);
        if (!internal::Report(stencils->Form(), status)) {
            return nullptr;
        }
    }
    std::vector<RowGroup> const groups =
        makeGroups(mesh, options.level, options.generateVertices ? level.numVertices : 0,
                   Index(rows.GetNumRows()), regularLevels);
    TableBuilder<REAL> builder(rows, groups, stencils ? &*stencils : nullptr, options.level,
                               refiner.GetLevel(hasStencils ? 0 : options.level).GetNumVertices(),
                               options.generate1stDerivatives);
    builder.SetRegularRows(mesh, regularLevels);
    if (!internal::Report(builder.Build(), status)) {
        return nullptr;
    }
    return builder.TakeTable();
}

template class LimitStencilTableFactoryReal<float>;
template class LimitStencilTableFactoryReal<double>;

} // namespace OpenSubdivHex::FarExt

// SPDX-License-Identifier: Apache-2.0
#include "limitStencilTableFactory.h"

#include "stencilTableFactory.h"

#include "far_ext/limit/limitMask.h"
#include "far_ext/vtr/hierarchy.h"
#include "far_ext/vtr/parallel.h"

#include <limits>

namespace OpenSubdivHex::FarExt {

using Far::Index;
using internal::LimitMask;
using internal::LimitPatch;

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

// The options of the steps from a level on to its limit, the first of which is not that of level 0.
HexSchemeOptions hexagonalSteps(TopologyRefiner const &refiner) {
    HexSchemeOptions options = refiner.GetHexSchemeOptions();
    options.triHexFirst = false;
    return options;
}

// The rows of a table, or of a range of them.
template <typename REAL>
struct Rows {
    std::vector<int> sizes;
    std::vector<Index> indices;
    std::vector<REAL> weights;
    std::vector<REAL> duWeights;
    std::vector<REAL> dvWeights;
};

// The arrays of Far's tables are protected, those of derivatives can be set by this constructor
// alone.
template <typename REAL>
class WritableLimitTable : public LimitStencilTableTypes<REAL>::Table {
public:
    WritableLimitTable(int numControlVertices, std::vector<Index> const &offsets,
                       Rows<REAL> const &rows)
        : LimitStencilTableTypes<REAL>::Table(numControlVertices, offsets, rows.sizes, rows.indices,
                                              rows.weights, rows.duWeights, rows.dvWeights, {}, {},
                                              {}, false, 0) {
        // Far leaves room for stencils that it was not asked to copy.
        this->_sizes.shrink_to_fit();
        this->_offsets.shrink_to_fit();
        this->_indices.shrink_to_fit();
        this->_weights.shrink_to_fit();
    }
};

// Multiplies limit masks by the stencils of a level.
template <typename REAL>
class RowBuilder {
public:
    explicit RowBuilder(Far::StencilTableReal<double> const &stencils)
        : _stencils(stencils), _sums(stencils.GetNumControlVertices()) {}

    // The weights of verts[i] are weights[i], and du[i] and dv[i] where tangents are given.
    template <typename VERTS>
    void Add(VERTS const &verts, std::vector<double> const &weights,
             LimitMask::Tangents const *tangents, Rows<REAL> &rows) {
        for (int i = 0; i < int(weights.size()); ++i) {
            Sums const factors = {weights[i], tangents ? tangents->du[i] : 0,
                                  tangents ? tangents->dv[i] : 0, true};
            if (factors.weight != 0 || factors.du != 0 || factors.dv != 0) {
                addStencil(verts[i], factors);
            }
        }
        std::sort(_columns.begin(), _columns.end());
        rows.sizes.push_back(int(_columns.size()));
        for (Index column : _columns) {
            Sums &sums = _sums[column];
            rows.indices.push_back(column);
            rows.weights.push_back(REAL(sums.weight));
            if (tangents) {
                rows.duWeights.push_back(REAL(sums.du));
                rows.dvWeights.push_back(REAL(sums.dv));
            }
            sums = {};
        }
        _columns.clear();
    }

private:
    struct Sums {
        double weight = 0;
        double du = 0;
        double dv = 0;
        bool isUsed = false;
    };

    void addStencil(Index vert, Sums const &factors) {
        int const offset = _stencils.GetOffsets()[vert];
        for (int k = offset; k < offset + _stencils.GetSizes()[vert]; ++k) {
            Index const column = _stencils.GetControlIndices()[k];
            double const weight = _stencils.GetWeights()[k];
            Sums &sums = _sums[column];
            if (!sums.isUsed) {
                sums.isUsed = true;
                _columns.push_back(column);
            }
            sums.weight += factors.weight * weight;
            sums.du += factors.du * weight;
            sums.dv += factors.dv * weight;
        }
    }

    Far::StencilTableReal<double> const &_stencils;
    std::vector<Sums> _sums; // by control vertex; zero between rows
    std::vector<Index> _columns;
};

// Appends rows, made in parallel, to a table.
template <typename REAL>
class TableBuilder {
public:
    TableBuilder(TopologyRefiner const &refiner, int level,
                 Far::StencilTableReal<double> const &stencils, bool hasDerivatives)
        : _refiner(refiner), _level(refiner.GetHierarchy().mesh.levels[std::size_t(level)]),
          _stencils(stencils), _hasDerivatives(hasDerivatives) {}

    Status AddSides(LimitSides const *sides) {
        struct State {
            internal::LimitPatchGatherer gatherer;
            internal::LimitMaskFinder finder;
            RowBuilder<REAL> builder;
            LimitPatch patch;
        };
        Index const numVertices = _level.numVertices;
        auto const addSide = [&](State &state, Index vert, int side, Rows<REAL> &rows) -> Status {
            if (_level.GetNumVertexFaces(vert) == 0) {
                LimitMask::Tangents const none = {{0}, {0}};
                state.builder.Add(&vert, {1.0}, derivativesOf(none), rows);
                return Status();
            }
            state.gatherer.Gather(vert, state.patch);
            LimitMask const *const mask = state.finder.Find(state.patch);
            if (!mask) {
                return Status(StatusCode::Unsupported, ComponentType::Vertex, vert,
                              "the limit of vertex " + std::to_string(vert) + " of level " +
                                  std::to_string(_level.depth) +
                                  " cannot be computed: the steps around it do not converge");
            }
            state.builder.Add(state.patch.sources, mask->weights,
                              derivativesOf(mask->sides[state.patch.sides[side]]), rows);
            return Status();
        };
        return addRows(
            sides ? sides->GetNumSides() : numVertices,
            [&] {
                return State{internal::LimitPatchGatherer(_level),
                             internal::LimitMaskFinder(_refiner.GetSchemeOptions(),
                                                       hexagonalSteps(_refiner)),
                             RowBuilder<REAL>(_stencils),
                             {}};
            },
            [&](State &state, Index i, Rows<REAL> &rows) {
                return addSide(state, sides ? sides->GetVertex(i) : i,
                               sides ? sides->GetLocalSide(i) : 0, rows);
            });
    }

    Status AddFaceCenters() {
        internal::FaceLimitMaskFinder const finder(_level, _refiner.GetSchemeOptions(),
                                                   hexagonalSteps(_refiner));
        return addRows(
            _level.numFaces, [&] { return RowBuilder<REAL>(_stencils); },
            [&](RowBuilder<REAL> &builder, Index face, Rows<REAL> &rows) {
                LimitMask const mask = finder.Find(face);
                builder.Add(_level.GetFaceVertices(face), mask.weights,
                            derivativesOf(mask.sides.front()), rows);
                return Status();
            });
    }

    std::unique_ptr<WritableLimitTable<REAL>> Make() {
        std::vector<Index> offsets;
        offsets.reserve(_rows.sizes.size());
        Index offset = 0;
        for (int size : _rows.sizes) {
            offsets.push_back(offset);
            offset += size;
        }
        return std::make_unique<WritableLimitTable<REAL>>(_stencils.GetNumControlVertices(),
                                                          offsets, _rows);
    }

private:
    LimitMask::Tangents const *derivativesOf(LimitMask::Tangents const &tangents) const {
        return _hasDerivatives ? &tangents : nullptr;
    }

    // The status is that of the first row that fails.
    template <typename MAKE_STATE, typename ADD_ROW>
    Status addRows(Index count, MAKE_STATE makeState, ADD_ROW addRow) {
        std::vector<Rows<REAL>> ranges(internal::GetNumParallelRanges(count));
        std::vector<Status> statuses(ranges.size());
        internal::ParallelForRange(count, makeState, [&](auto &state, Index begin, Index end) {
            std::size_t const range = std::size_t(begin / internal::kParallelRange);
            for (Index i = begin; i < end && statuses[range].IsOk(); ++i) {
                statuses[range] = addRow(state, i, ranges[range]);
            }
        });
        for (Status const &status : statuses) {
            if (!status.IsOk()) {
                return status;
            }
        }
        for (Rows<REAL> const &rows : ranges) {
            _numWeights += std::int64_t(rows.weights.size());
        }
        if (_numWeights > std::numeric_limits<Index>::max()) {
            return Status(StatusCode::TooLarge, ComponentType::Level, _level.depth,
                          "the limit stencils of level " + std::to_string(_level.depth) +
                              " would have at least " + std::to_string(_numWeights) +
                              " weights, more than Far's 32-bit offsets reach");
        }
        reserve(&_rows.indices);
        reserve(&_rows.weights);
        reserve(&_rows.duWeights);
        reserve(&_rows.dvWeights);
        for (Rows<REAL> &rows : ranges) {
            append(rows.sizes, _rows.sizes);
            append(rows.indices, _rows.indices);
            append(rows.weights, _rows.weights);
            append(rows.duWeights, _rows.duWeights);
            append(rows.dvWeights, _rows.dvWeights);
            rows = {};
        }
        return Status();
    }
    template <typename T>
    void reserve(std::vector<T> *array) const {
        array->reserve(std::size_t(_numWeights));
    }
    template <typename T>
    static void append(std::vector<T> const &from, std::vector<T> &to) {
        to.insert(to.end(), from.begin(), from.end());
    }

    TopologyRefiner const &_refiner;
    internal::Level const &_level;
    Far::StencilTableReal<double> const &_stencils;
    bool const _hasDerivatives;
    std::int64_t _numWeights = 0;
    Rows<REAL> _rows;
};

template <typename OPTIONS>
Status checkOptions(TopologyRefiner const &refiner, OPTIONS const &options) {
    auto const fail = [&](std::string const &message) {
        return Status(StatusCode::InvalidArgument, ComponentType::Level, options.level, message);
    };
    std::string const level = "level " + std::to_string(options.level);
    if (options.level < 0 || options.level > refiner.GetMaxLevel()) {
        return fail(level + " is not one of the levels 0 to " +
                    std::to_string(refiner.GetMaxLevel()) + " of the refiner");
    }
    HexSchemeOptions const scheme = refiner.GetHexSchemeOptions();
    if (scheme.GetSchemeOfLevel(options.level + 1) != SchemeType::Hexagonal) {
        return Status(StatusCode::Unsupported, ComponentType::Level, options.level,
                      level +
                          " is not refined by hexagonal steps, which alone have limit stencils");
    }
    if (!refiner.GetLevel(options.level).HasFullTopology()) {
        return fail(level + " has no full topology: see UniformOptions::fullTopologyInLastLevel");
    }
    if (!options.generateVertices && !options.generateFaceCenters) {
        return fail("neither vertices nor face centers of " + level + " are asked for");
    }
    if (!options.generateVertices && options.generateFurtherSides) {
        return fail("further sides of vertices of " + level + " are asked for without vertices");
    }
    return Status();
}

} // namespace

template <typename REAL>
auto LimitStencilTableFactoryReal<REAL>::Create(TopologyRefiner const &refiner, Options options,
                                                Status *status) -> std::unique_ptr<Table const> {
    if (!internal::Report(checkOptions(refiner, options), status)) {
        return nullptr;
    }
    StencilTableFactoryReal<double>::Options levelOptions;
    levelOptions.generateControlVerts = options.level == 0;
    levelOptions.generateIntermediateLevels = false;
    levelOptions.maxLevel = options.level;
    auto const stencils = StencilTableFactoryReal<double>::Create(refiner, levelOptions, status);
    if (!stencils) {
        return nullptr;
    }
    std::unique_ptr<LimitSides> sides;
    if (options.generateFurtherSides) {
        sides = std::make_unique<LimitSides>(refiner.GetLevel(options.level));
    }
    TableBuilder<REAL> builder(refiner, options.level, *stencils, options.generate1stDerivatives);
    Status result;
    if (options.generateVertices) {
        result = builder.AddSides(sides.get());
    }
    if (result.IsOk() && options.generateFaceCenters) {
        result = builder.AddFaceCenters();
    }
    if (!internal::Report(result, status)) {
        return nullptr;
    }
    return builder.Make();
}

template class LimitStencilTableFactoryReal<float>;
template class LimitStencilTableFactoryReal<double>;

} // namespace OpenSubdivHex::FarExt

// SPDX-License-Identifier: Apache-2.0
#include "limitRows.h"

#include "far_ext/executor.h"
#include "far_ext/vtr/parallel.h"

#include <algorithm>
#include <numeric>
#include <string>
#include <unordered_map>

namespace OpenSubdivHex::FarExt::internal {

using Far::Index;

HexSchemeOptions GetStepsToLimit(HexSchemeOptions schemeOptions) {
    schemeOptions.firstStep = FirstStep::Same;
    return schemeOptions;
}

CallStatus CheckLimitLevel(Hierarchy const &hierarchy, HexSchemeOptions const &schemeOptions,
                           int level) {
    auto const fail = [level](StatusCode code, std::string const &message) {
        return CallStatus(code, ComponentType::Level, level,
                          "level " + std::to_string(level) + message);
    };
    int const maxLevel = hierarchy.numLevels - 1;
    if (level < 0 || level > maxLevel) {
        return fail(StatusCode::InvalidArgument, " is not one of the levels 0 to " +
                                                     std::to_string(maxLevel) + " of the refiner");
    }
    if (schemeOptions.GetStepOfLevel(level + 1) != StepType::Hexagonal) {
        return fail(StatusCode::Unsupported,
                    " is not refined by hexagonal steps, which alone have limits");
    }
    if (!hierarchy.mesh.levels[std::size_t(level)].hasFullTopology) {
        return fail(StatusCode::InvalidArgument,
                    " has no full topology: see UniformOptions::fullTopologyInLastLevel");
    }
    return CallStatus();
}

/// Scratch memory of one thread.
class LimitRows::Finder {
public:
    explicit Finder(LimitRows const &rows)
        : _level(rows._level), _plainGatherer(rows._level),
          _gatherer(rows._level, rows._sdcOptions, rows._schemeOptions.faceMask),
          _ownFinder(rows._sdcOptions, rows._schemeOptions),
          _finder(rows._maskFinder ? *rows._maskFinder : _ownFinder) {}

    /// Adds what a vertex has to a range that has nothing of it.
    void Add(Index vert, Range &range) {
        int const firstSource = int(range.sources.size());
        if (_level.GetNumVertexFaces(vert) == 0) {
            range.sources.push_back(vert);
            add(vert, findIsolated(), firstSource, {0}, range);
        } else if (_plainGatherer.IsRegular(vert)) {
            range.firstRegular = vert;
        } else if (ComesApart(_level, vert)) {
            ForEachFan(_level, vert, [&](VertexFan const &fan) {
                _gatherer.GatherFan(_level.GetVertexCorner(fan.begin), _patch);
                addPatch(vert, range);
            });
        } else if (!_plainGatherer.Gather(vert, _neighborhood)) {
            _gatherer.Gather(vert, _patch);
            addPatch(vert, range);
        } else {
            range.sources.insert(range.sources.end(), _neighborhood.sources.begin(),
                                 _neighborhood.sources.end());
            add(vert, findPlain(vert), firstSource, {0}, range);
        }
    }

    /// The mask of a patch.
    std::shared_ptr<LimitMask const> Find(Index vert) {
        _gatherer.Gather(vert, _patch);
        return _finder.Find(_patch);
    }

private:
    void addPatch(Index vert, Range &range) {
        int const firstSource = int(range.sources.size());
        range.sources.insert(range.sources.end(), _patch.sources.begin(), _patch.sources.end());
        add(vert, _finder.Find(_patch), firstSource, _patch.sides, range);
    }

    // The vertex, or a fan of it, whose sources are there.
    void add(Index vert, std::shared_ptr<LimitMask const> mask, int firstSource,
             std::vector<int> const &sides, Range &range) const {
        if (!mask) {
            range.status =
                CallStatus(StatusCode::Unsupported, ComponentType::Vertex, vert,
                           "the limit of vertex " + std::to_string(vert) + " of level " +
                               std::to_string(_level.depth) +
                               " cannot be computed: the steps around it do not converge");
        }
        range.entries.push_back(
            {vert, std::move(mask), firstSource, int(range.sides.size()), int(sides.size())});
        range.sides.insert(range.sides.end(), sides.begin(), sides.end());
    }

    // A vertex without faces stays where it is.
    std::shared_ptr<LimitMask const> findIsolated() {
        if (!_isolated) {
            _isolated = std::make_shared<LimitMask const>(LimitMask{{1}, {{{0}, {0}}}});
        }
        return _isolated;
    }

    std::shared_ptr<LimitMask const> findPlain(Index vert) {
        if (_plainMasks.size() > LimitMaskFinder::kMaxMasks) {
            _plainMasks.clear();
        }
        std::shared_ptr<LimitMask const> &mask = _plainMasks[_neighborhood.key];
        if (!mask) {
            mask = Find(vert);
        }
        return mask;
    }

    Level const &_level;
    PlainNeighborhoodGatherer _plainGatherer;
    PlainNeighborhood _neighborhood;
    LimitPatchGatherer _gatherer;
    LimitPatch _patch;
    LimitMaskFinder _ownFinder;
    LimitMaskFinder &_finder;
    std::unordered_map<std::string, std::shared_ptr<LimitMask const>> _plainMasks; // by key
    std::shared_ptr<LimitMask const> _isolated;
};

LimitRows::LimitRows(Level const &level, Sdc::Options sdcOptions,
                     HexSchemeOptions const &schemeOptions)
    : _level(level), _sdcOptions(sdcOptions), _schemeOptions(GetStepsToLimit(schemeOptions)) {}

LimitRows::~LimitRows() = default;

CallStatus LimitRows::Find() {
    std::vector<Index> verts(std::size_t(_level.numVertices));
    std::iota(verts.begin(), verts.end(), 0);
    return Find(verts);
}

namespace {

CallStatus checkSizes(Level const &level) {
    auto const fail = [&](ComponentType type, Index index, std::string const &name, int size,
                          std::string const &parts) {
        return CallStatus(StatusCode::Unsupported, type, index,
                          "there are no limits at " + name + " " + std::to_string(index) +
                              " of level " + std::to_string(level.depth) + ", which has " +
                              std::to_string(size) + " " + parts + ", more than " +
                              std::to_string(kMaxFacesAtLimit));
    };
    for (Index vert = 0; vert < level.numVertices; ++vert) {
        if (level.GetNumVertexFaces(vert) <= kMaxFacesAtLimit) {
            continue;
        }
        if (int const size = CountFacesTogether(level, vert); size > kMaxFacesAtLimit) {
            return fail(ComponentType::Vertex, vert, "vertex", size, "faces");
        }
    }
    for (Index face = 0; face < level.numFaces; ++face) {
        if (int const size = level.GetFaceSize(face); size > kMaxFacesAtLimit) {
            return fail(ComponentType::Face, face, "face", size, "vertices");
        }
    }
    return CallStatus();
}

} // namespace

auto LimitRows::Range::FindEntry(Index vert) const -> std::vector<Entry>::const_iterator {
    auto const found =
        std::lower_bound(entries.begin(), entries.end(), vert,
                         [](Entry const &entry, Index index) { return entry.vert < index; });
    return found != entries.end() && found->vert == vert ? found : entries.end();
}

CallStatus LimitRows::Find(std::vector<Index> const &verts) {
    if (_ranges.empty()) {
        if (CallStatus result = checkSizes(_level); !result.IsOk()) {
            return result;
        }
        _ranges.resize(std::size_t(GetNumParallelRanges(_level.numVertices, kRange)));
    }
    ParallelForRange(
        _level.numVertices, [&] { return Finder(*this); },
        [&](Finder &finder, Index begin, Index end) {
            // Patches are small: their loops gain nothing by help, and lose much where that is busy.
            ExecutorScope const alone(nullptr, 1);
            Range &range = _ranges[std::size_t(begin / kRange)];
            std::size_t const numKnown = range.entries.size();
            std::size_t known = 0;
            auto vert = std::lower_bound(verts.begin(), verts.end(), begin);
            for (; vert != verts.end() && *vert < end && range.status.IsOk(); ++vert) {
                while (known < numKnown && range.entries[known].vert < *vert) {
                    ++known;
                }
                if (known == numKnown || range.entries[known].vert != *vert) {
                    finder.Add(*vert, range);
                }
            }
            auto const first = range.entries.begin();
            std::inplace_merge(first, first + std::ptrdiff_t(numKnown), range.entries.end(),
                               [](Entry const &a, Entry const &b) { return a.vert < b.vert; });
        },
        kRange);
    for (Range const &range : _ranges) {
        if (!range.status.IsOk()) {
            return range.status;
        }
        if (!_regularMask && range.firstRegular != Far::INDEX_INVALID) {
            _regularMask = Finder(*this).Find(range.firstRegular);
        }
    }
    return CallStatus();
}

LimitRow LimitRows::GetRow(Index vert, int side,
                           Index regularSources[PlainNeighborhoodGatherer::kNumRegular]) const {
    Range const &range = _ranges[std::size_t(vert / kRange)];
    auto entry = range.FindEntry(vert);
    if (entry == range.entries.end()) {
        PlainNeighborhoodGatherer::GatherRegular(_level, vert, regularSources);
        LimitMask::Tangents const &tangents = _regularMask->sides[0];
        return {PlainNeighborhoodGatherer::kNumRegular, regularSources,
                _regularMask->weights.data(), tangents.du.data(), tangents.dv.data()};
    }
    for (; side >= entry->numSides; ++entry) {
        side -= entry->numSides;
    }
    LimitMask const &mask = *entry->mask;
    LimitMask::Tangents const &tangents =
        mask.sides[std::size_t(range.sides[std::size_t(entry->firstSide) + std::size_t(side)])];
    return {int(mask.weights.size()), range.sources.data() + entry->firstSource,
            mask.weights.data(), tangents.du.data(), tangents.dv.data()};
}

} // namespace OpenSubdivHex::FarExt::internal

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

/// What one thread finds masks with.
class LimitRows::Finder {
public:
    Finder(LimitRows const &rows, std::vector<VertexMark> const &marks)
        : _level(rows._level), _marks(marks), _plainGatherer(rows._level),
          _gatherer(rows._level, rows._sdcOptions, rows._schemeOptions.faceMask),
          _finder(rows._sdcOptions, rows._schemeOptions) {}

    /// Adds what a vertex has to a range.
    void Add(Index vert, Range &range) {
        if (_level.GetNumVertexFaces(vert) == 0) {
            range.sources.push_back(vert);
            add(vert, findIsolated(), {0}, range);
        } else if (_plainGatherer.IsRegular(vert, _marks)) {
            range.firstRegular = vert;
        } else if (ComesApart(_level, vert)) {
            ForEachFan(_level, vert, [&](VertexFan const &fan) {
                _gatherer.GatherFan(_level.GetVertexCorner(fan.begin), _patch);
                addPatch(vert, range);
            });
        } else if (!_plainGatherer.Gather(vert, _marks, _neighborhood)) {
            _gatherer.Gather(vert, _patch);
            addPatch(vert, range);
        } else {
            range.sources.insert(range.sources.end(), _neighborhood.sources.begin(),
                                 _neighborhood.sources.end());
            add(vert, findPlain(vert), {0}, range);
        }
    }

    /// That of a patch.
    std::shared_ptr<LimitMask const> Find(Index vert) {
        _gatherer.Gather(vert, _patch);
        return _finder.Find(_patch);
    }

private:
    void addPatch(Index vert, Range &range) {
        range.sources.insert(range.sources.end(), _patch.sources.begin(), _patch.sources.end());
        add(vert, _finder.Find(_patch), _patch.sides, range);
    }

    void add(Index vert, std::shared_ptr<LimitMask const> mask, std::vector<int> const &sides,
             Range &range) const {
        if (!mask) {
            range.status =
                CallStatus(StatusCode::Unsupported, ComponentType::Vertex, vert,
                           "the limit of vertex " + std::to_string(vert) + " of level " +
                               std::to_string(_level.depth) +
                               " cannot be computed: the steps around it do not converge");
        }
        range.verts.push_back(vert);
        range.masks.push_back(std::move(mask));
        range.firstSources.push_back(int(range.sources.size()));
        range.sides.insert(range.sides.end(), sides.begin(), sides.end());
        range.firstSides.push_back(int(range.sides.size()));
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
    std::vector<VertexMark> const &_marks;
    PlainNeighborhoodGatherer _plainGatherer;
    PlainNeighborhood _neighborhood;
    LimitPatchGatherer _gatherer;
    LimitPatch _patch;
    LimitMaskFinder _finder;
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

CallStatus LimitRows::Find(std::vector<Index> const &verts) {
    if (CallStatus result = checkSizes(_level); !result.IsOk()) {
        return result;
    }
    std::vector<VertexMark> const marks = MarkFeatures(_level);
    _ranges.assign(std::size_t(GetNumParallelRanges(_level.numVertices, kRange)), Range());
    _regularMask.reset();
    ParallelForRange(
        _level.numVertices, [&] { return Finder(*this, marks); },
        [&](Finder &finder, Index begin, Index end) {
            // Patches are small: their loops gain nothing by help, and lose much where that is busy.
            ExecutorScope const alone(nullptr, 1);
            Range &range = _ranges[std::size_t(begin / kRange)];
            range.firstSources.push_back(0);
            range.firstSides.push_back(0);
            auto vert = std::lower_bound(verts.begin(), verts.end(), begin);
            for (; vert != verts.end() && *vert < end && range.status.IsOk(); ++vert) {
                finder.Add(*vert, range);
            }
        },
        kRange);
    for (Range const &range : _ranges) {
        if (!range.status.IsOk()) {
            return range.status;
        }
        if (!_regularMask && range.firstRegular != Far::INDEX_INVALID) {
            _regularMask = Finder(*this, marks).Find(range.firstRegular);
        }
    }
    return CallStatus();
}

LimitRow LimitRows::GetRow(Index vert, int side,
                           Index regularSources[PlainNeighborhoodGatherer::kNumRegular]) const {
    Range const &range = _ranges[std::size_t(vert / kRange)];
    auto const found = std::lower_bound(range.verts.begin(), range.verts.end(), vert);
    if (found == range.verts.end() || *found != vert) {
        PlainNeighborhoodGatherer::GatherRegular(_level, vert, regularSources);
        LimitMask::Tangents const &tangents = _regularMask->sides[0];
        return {PlainNeighborhoodGatherer::kNumRegular, regularSources,
                _regularMask->weights.data(), tangents.du.data(), tangents.dv.data()};
    }
    auto i = std::size_t(found - range.verts.begin());
    for (; side >= range.firstSides[i + 1] - range.firstSides[i]; ++i) {
        side -= range.firstSides[i + 1] - range.firstSides[i];
    }
    LimitMask const &mask = *range.masks[i];
    int const *const sides = range.sides.data() + range.firstSides[i];
    LimitMask::Tangents const &tangents = mask.sides[std::size_t(sides[side])];
    return {int(mask.weights.size()), range.sources.data() + range.firstSources[i],
            mask.weights.data(), tangents.du.data(), tangents.dv.data()};
}

} // namespace OpenSubdivHex::FarExt::internal

// SPDX-License-Identifier: Apache-2.0
#include "levelRefiner.h"

#include "hexRefinement.h"
#include "truncationRefinement.h"

namespace OpenSubdivHex::FarExt::internal {

namespace {

// An element of a deque, perhaps a new one behind its last.
template <typename T>
T &getOrAdd(std::deque<T> &deque, std::size_t i) {
    return i < deque.size() ? deque[i] : deque.emplace_back();
}

// The level behind the last one in use, and what leads to it.  Their memory is that of an earlier
// refinement, where there was one.
struct NextLevel {
    NextLevel(MeshLevels &mesh, int numLevels)
        : parent(mesh.levels[std::size_t(numLevels) - 1]),
          child(getOrAdd(mesh.levels, std::size_t(numLevels))),
          refinement(getOrAdd(mesh.refinements, std::size_t(numLevels) - 1)) {}

    Level const &parent;
    Level &child;
    Refinement &refinement;
};

} // namespace

LevelRefiner::LevelRefiner(Hierarchy &hierarchy, TagOptions tagOptions)
    : _hierarchy(hierarchy), _tagOptions(tagOptions) {
    _checkers.emplace_back(GetSizes(hierarchy.mesh.levels[0]), "");
    for (std::size_t channel = 0; channel < hierarchy.channels.size(); ++channel) {
        _checkers.emplace_back(GetSizes(hierarchy.channels[channel].values.levels[0]),
                               " in face-varying channel " + std::to_string(channel));
    }
}

// Whether the sizes behind a step depend on more than those before it: of tri-hex on borders, of a
// truncation on where it cuts polygons, too.
bool LevelRefiner::isSizeOpen(StepType step, bool hasLabels, ExpectedSizes const &sizes) const {
    Level const &base = _hierarchy.mesh.levels[0];
    bool const isCut = hasLabels || sizes.digons > 0 || !base.edgeSharpness.empty() ||
                       !base.vertSharpness.empty() || !base.faceHoles.empty() ||
                       !base.nonManifoldVerts.empty() || !_hierarchy.channels.empty();
    return (step == StepType::TriHex && !sizes.IsClosed()) ||
           (step == StepType::Truncate && (isCut || !sizes.IsClosed()));
}

CallStatus LevelRefiner::CheckSizes(HexSchemeOptions schemeOptions, Far::ConstIndexArray faceLabels,
                                    int refinementLevel) const {
    for (std::size_t i = 0; i < _checkers.size(); ++i) {
        SizeChecker checker = _checkers[i];
        Level const &last = _hierarchy.GetMesh(int(i) - 1).levels[std::size_t(_numLevels) - 1];
        ExpectedSizes sizes(last);
        if (!schemeOptions.IsHexagonal()) {
            sizes.CountFans(last);
        }
        for (int level = last.depth + 1; level <= refinementLevel; ++level) {
            StepType const step = schemeOptions.GetStepOfLevel(level);
            if (isSizeOpen(step, !faceLabels.empty(), sizes)) {
                break;
            }
            sizes.Refine(step);
            if (CallStatus status = checker.Add(sizes.sizes); !status.IsOk()) {
                return status;
            }
        }
    }
    return CallStatus();
}

CallStatus LevelRefiner::CheckLeastSizes(bool closeGaps, int refinementLevel) const {
    Level const &base = _hierarchy.mesh.levels[0];
    ExpectedSizes sizes(base);
    sizes.CountFans(base);
    SizeChecker checker(sizes.sizes, " or more");
    CallStatus status;
    for (int level = 1; level <= refinementLevel && status.IsOk(); ++level) {
        sizes.RefineToLeast(closeGaps);
        status = checker.Add(sizes.sizes);
    }
    return status;
}

CallStatus LevelRefiner::AddLevel(PolygonRules const &rules, bool fullTopology) {
    bool const isPlain = rules.step == StepType::Hexagonal && rules.flatEdges.empty();
    CallStatus status = isPlain ? addHexagonalLevel(fullTopology)
                        : rules.step == StepType::Truncate
                            ? addTruncation(rules.faceLabels, fullTopology)
                            : addPolygonLevel(rules, fullTopology);
    if (status.IsOk()) {
        relateChannels();
        _hierarchy.numLevels = ++_numLevels;
    }
    return status;
}

CallStatus LevelRefiner::addHexagonalLevel(bool fullTopology) {
    auto const refine = [&](MeshLevels &mesh, SizeChecker &checker) {
        NextLevel next(mesh, _numLevels);
        CallStatus status = checker.Add(GetHexagonalSizes(GetSizes(next.parent)));
        if (status.IsOk()) {
            RefineHexagonally(next.parent, _tagOptions, fullTopology, next.refinement, next.child);
        }
        return status;
    };
    CallStatus status = refine(_hierarchy.mesh, _checkers[0]);
    for (std::size_t i = 0; i < _hierarchy.channels.size() && status.IsOk(); ++i) {
        status = refine(_hierarchy.channels[i].values, _checkers[i + 1]);
    }
    return status;
}

CallStatus LevelRefiner::addPolygonLevel(PolygonRules const &rules, bool fullTopology) {
    std::size_t const last = std::size_t(_numLevels) - 1;
    Level const &mesh = _hierarchy.mesh.levels[last];
    std::deque<PolygonRefiner> refiners;
    refiners.emplace_back(mesh, rules, _tagOptions);
    for (FVarChannel const &channel : _hierarchy.channels) {
        refiners.emplace_back(channel.values.levels[last],
                              GetRulesOfChannel(mesh, rules, channel.levels[last]), _tagOptions);
    }
    return addLevels(refiners, fullTopology);
}

CallStatus LevelRefiner::addTruncation(Far::ConstIndexArray faceLabels, bool fullTopology) {
    Level const &mesh = _hierarchy.mesh.levels[0];
    EndCuts const cuts = FindEndCuts(_hierarchy, faceLabels);
    std::deque<TruncationRefiner> refiners;
    refiners.emplace_back(mesh, cuts, _tagOptions);
    for (FVarChannel const &channel : _hierarchy.channels) {
        refiners.emplace_back(channel.values.levels[0],
                              GetEndCutsOfChannel(mesh, cuts, channel.levels[0]), _tagOptions);
    }
    return addLevels(refiners, fullTopology);
}

// Adds the levels of the mesh and of each channel, whose refiners have counted them.
template <class REFINER>
CallStatus LevelRefiner::addLevels(std::deque<REFINER> &refiners, bool fullTopology) {
    for (std::size_t i = 0; i < refiners.size(); ++i) {
        if (CallStatus status = _checkers[i].Add(refiners[i].GetSizes()); !status.IsOk()) {
            return status;
        }
    }
    auto const refine = [&](REFINER &refiner, MeshLevels &levels) {
        NextLevel next(levels, _numLevels);
        refiner.Refine(fullTopology, next.refinement, next.child);
    };
    refine(refiners[0], _hierarchy.mesh);
    for (std::size_t i = 0; i < _hierarchy.channels.size(); ++i) {
        refine(refiners[i + 1], _hierarchy.channels[i].values);
    }
    return CallStatus();
}

void LevelRefiner::relateChannels() {
    auto const child = std::size_t(_numLevels);
    for (FVarChannel &channel : _hierarchy.channels) {
        FVarLevel &cLevel = getOrAdd(channel.levels, child);
        RefineFVarLevel(_hierarchy.mesh.refinements[child - 1],
                        channel.values.refinements[child - 1], channel.levels[child - 1], cLevel);
    }
}

} // namespace OpenSubdivHex::FarExt::internal

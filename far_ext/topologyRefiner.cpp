// SPDX-License-Identifier: Apache-2.0
#include "topologyRefiner.h"

#include "far_ext/stencil/interpolationMode.h"
#include "far_ext/vtr/coplanarEdges.h"
#include "far_ext/vtr/levelRefiner.h"
#include "far_ext/vtr/report.h"

#include <algorithm>
#include <utility>

namespace OpenSubdivHex::FarExt {

using internal::Hierarchy;
using internal::LevelRefiner;
using internal::PolygonRules;

namespace {

CallStatus checkLevel(int refinementLevel) {
    if (refinementLevel >= 0) {
        return CallStatus();
    }
    return CallStatus(StatusCode::InvalidArgument, ComponentType::Level, refinementLevel,
                      "refinement level " + std::to_string(refinementLevel) + " is negative");
}

CallStatus checkLabels(Far::ConstIndexArray labels, int numFaces, HexSchemeOptions schemeOptions,
                       int refinementLevel) {
    if (labels.empty()) {
        return CallStatus();
    }
    if (labels.size() == numFaces) {
        bool const areSame = std::all_of(labels.begin(), labels.end(),
                                         [&](int label) { return label == labels[0]; });
        // The first step, and those behind it.
        for (int level = 1; level <= std::min(refinementLevel, 2) && !areSame; ++level) {
            StepType const step = schemeOptions.GetStepOfLevel(level);
            if (step == StepType::DooSabin || step == StepType::TriHex) {
                return CallStatus(StatusCode::Unsupported, ComponentType::Level, level,
                                  std::string("labels of base faces differ, which steps of ") +
                                      (step == StepType::TriHex ? "tri-hex" : "Doo-Sabin") +
                                      " do not keep apart");
            }
        }
        return CallStatus();
    }
    return CallStatus(StatusCode::InvalidArgument, ComponentType::NoComponent, Far::INDEX_INVALID,
                      "there are " + std::to_string(labels.size()) + " labels of " +
                          std::to_string(numFaces) + " base faces");
}

// Whether check(level), which goes through the sizes of the levels up to that one, and the number of
// levels let a refiner refine so far.
template <typename CHECK>
CallStatus checkSizes(int refinementLevel, CHECK check) {
    constexpr int kLastLevel = TopologyRefiner::kLastLevel;
    CallStatus status = check(std::min(refinementLevel, kLastLevel));
    if (!status.IsOk() || refinementLevel <= kLastLevel) {
        return status;
    }
    return CallStatus(StatusCode::TooLarge, ComponentType::Level, refinementLevel,
                      "refinement level " + std::to_string(refinementLevel) + " is beyond level " +
                          std::to_string(kLastLevel) + ", the last that is made");
}

} // namespace

TopologyRefiner::TopologyRefiner(std::unique_ptr<Hierarchy> base, Sdc::Options sdcOptions,
                                 HexSchemeOptions schemeOptions)
    : _hierarchy(std::move(base)), _sdcOptions(sdcOptions), _schemeOptions(schemeOptions) {
    _hierarchy->surfaceLevel = schemeOptions.GetSurfaceLevel();
    _levels.emplace_back(*_hierarchy, 0);
}

TopologyRefiner::~TopologyRefiner() = default;

bool TopologyRefiner::HasHoles() const { return !_hierarchy->mesh.levels[0].faceHoles.empty(); }

void TopologyRefiner::Unrefine() {
    _levels.erase(_levels.begin() + 1, _levels.end());
    _hierarchy->numLevels = 1;
    ++_numRefinements;
    _isUniform = true;
    _uniformOptions = UniformOptions(0);
}

// Calls refine(), which adds levels to the base; when it fails or throws, the base alone is left.
template <typename REFINE>
CallStatus TopologyRefiner::replaceLevels(REFINE refine) {
    Unrefine();
    try {
        CallStatus status = refine();
        if (!status.IsOk()) {
            Unrefine();
            return status;
        }
        for (int level = 1; level < _hierarchy->numLevels; ++level) {
            _levels.emplace_back(*_hierarchy, level);
        }
        return status;
    } catch (...) {
        Unrefine();
        throw;
    }
}

bool TopologyRefiner::RefineUniform(UniformOptions options, CallStatus *status) {
    int const refinementLevel = options.refinementLevel;
    LevelRefiner refiner(*_hierarchy, {_sdcOptions, _schemeOptions.faceMask});
    Far::ConstIndexArray const labels(options.faceLabels.data(), int(options.faceLabels.size()));
    CallStatus result = checkLevel(refinementLevel);
    if (result.IsOk()) {
        result = checkLabels(labels, GetLevel(0).GetNumFaces(), _schemeOptions, refinementLevel);
    }
    if (result.IsOk()) {
        result = checkSizes(refinementLevel, [&](int level) {
            return refiner.CheckSizes(_schemeOptions, labels, level);
        });
    }
    if (!result.IsOk()) {
        return internal::Report(result, status);
    }
    result = replaceLevels([&] {
        CallStatus levelStatus;
        for (int level = 1; level <= refinementLevel && levelStatus.IsOk(); ++level) {
            PolygonRules rules;
            rules.step = _schemeOptions.GetStepOfLevel(level);
            rules.faceLabels = labels;
            bool const isLast = level == refinementLevel;
            levelStatus = refiner.AddLevel(rules, !isLast || options.fullTopologyInLastLevel);
            if (level == _schemeOptions.GetSurfaceLevel() && !isLast && levelStatus.IsOk()) {
                // All sizes are known by now, of borders and cut polygons too.
                levelStatus = refiner.CheckSizes(_schemeOptions, labels, refinementLevel);
            }
        }
        return levelStatus;
    });
    if (result.IsOk()) {
        _uniformOptions = std::move(options);
    }
    return internal::Report(result, status);
}

template <typename REAL>
bool TopologyRefiner::refineCoplanar(REAL const *restPositions, CoplanarOptions const &options,
                                     CallStatus *status) {
    LevelRefiner refiner(*_hierarchy, {_sdcOptions, _schemeOptions.faceMask});
    internal::CoplanarEdges edges(*_hierarchy, _schemeOptions, options.angleTolerance);
    CallStatus result = checkLevel(options.refinementLevel);
    if (result.IsOk()) {
        result = edges.Begin(restPositions);
    }
    if (result.IsOk()) {
        result = checkSizes(options.refinementLevel, [&](int level) {
            return refiner.CheckLeastSizes(options.closeGaps, level);
        });
    }
    if (!result.IsOk()) {
        return internal::Report(result, status);
    }
    result = replaceLevels([&] {
        CallStatus levelStatus;
        for (int level = 1; level <= options.refinementLevel && levelStatus.IsOk(); ++level) {
            if (level > 1) {
                edges.Refine();
            }
            PolygonRules rules;
            rules.flatEdges = edges.FindFlat();
            rules.closeGaps = options.closeGaps;
            bool const isLast = level == options.refinementLevel;
            levelStatus = refiner.AddLevel(rules, !isLast || options.fullTopologyInLastLevel);
        }
        return levelStatus;
    });
    if (result.IsOk()) {
        _isUniform = false;
    }
    return internal::Report(result, status);
}

bool TopologyRefiner::RefineCoplanar(float const *restPositions, CoplanarOptions options,
                                     CallStatus *status) {
    return refineCoplanar(restPositions, options, status);
}

bool TopologyRefiner::RefineCoplanar(double const *restPositions, CoplanarOptions options,
                                     CallStatus *status) {
    return refineCoplanar(restPositions, options, status);
}

Sdc::Options::FVarLinearInterpolation
TopologyRefiner::GetFVarLinearInterpolation(int channel) const {
    return _hierarchy->channels[std::size_t(channel)].linearInterpolation;
}

int TopologyRefiner::GetNumFVarValuesTotal(int channel) const {
    int sum = 0;
    for (TopologyLevel const &level : _levels) {
        sum += level.GetNumFVarValues(channel);
    }
    return sum;
}

int TopologyRefiner::GetNumVerticesTotal() const { return total(&TopologyLevel::GetNumVertices); }
int TopologyRefiner::GetNumEdgesTotal() const { return total(&TopologyLevel::GetNumEdges); }
int TopologyRefiner::GetNumFacesTotal() const { return total(&TopologyLevel::GetNumFaces); }
int TopologyRefiner::GetNumFaceVerticesTotal() const {
    return total(&TopologyLevel::GetNumFaceVertices);
}

int TopologyRefiner::total(int (TopologyLevel::*count)() const) const {
    int sum = 0;
    for (TopologyLevel const &level : _levels) {
        sum += (level.*count)();
    }
    return sum;
}

namespace internal {

CallStatus CheckChannel(int channel, int numChannels) {
    if (0 <= channel && channel < numChannels) {
        return CallStatus();
    }
    return Failure(StatusCode::InvalidArgument, "there is no face-varying channel " +
                                                    std::to_string(channel) + "; the mesh has " +
                                                    std::to_string(numChannels));
}

Interpolation GetChannelInterpolation(TopologyRefiner const &refiner, int channel) {
    return refiner.GetFVarLinearInterpolation(channel) == Sdc::Options::FVAR_LINEAR_ALL
               ? Interpolation::Varying
               : Interpolation::Vertex;
}

} // namespace internal

} // namespace OpenSubdivHex::FarExt

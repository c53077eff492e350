// SPDX-License-Identifier: Apache-2.0
#include "refinementEvaluator.h"

#include "far_ext/fvarLevel.h"
#include "far_ext/parallel.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

namespace OpenSubdivHex::OsdExt {

using Far::Index;
using FarExt::ComponentType;
using FarExt::Status;
using FarExt::StatusCode;
using FarExt::TopologyLevel;
using FarExt::TopologyRefiner;
using FarExt::internal::FVarLevel;

namespace {

Status invalidArgument(std::string const &message) {
    return Status(StatusCode::InvalidArgument, ComponentType::None, Far::INDEX_INVALID, message);
}

// The meshes that are refined, by level: those of the refiner, or the value meshes of a channel.
std::vector<TopologyLevel> getMeshes(TopologyRefiner const &refiner,
                                     RefinementEvaluator::Options options) {
    std::vector<TopologyLevel> meshes;
    for (int level = 0; level < refiner.GetNumLevels(); ++level) {
        TopologyLevel const &mesh = refiner.GetLevel(level);
        if (options.interpolationMode == FarExt::INTERPOLATE_FACE_VARYING) {
            meshes.emplace_back(
                &mesh.GetTopology().fvarLevels[std::size_t(options.fvarChannel)]->topology);
        } else {
            meshes.push_back(mesh);
        }
    }
    return meshes;
}

FarExt::Interpolation getInterpolation(TopologyRefiner const &refiner,
                                       RefinementEvaluator::Options options) {
    bool const isLinear =
        options.interpolationMode == FarExt::INTERPOLATE_VARYING ||
        (options.interpolationMode == FarExt::INTERPOLATE_FACE_VARYING &&
         refiner.GetFVarLinearInterpolation(options.fvarChannel) == Sdc::Options::FVAR_LINEAR_ALL);
    return isLinear ? FarExt::Interpolation::Varying : FarExt::Interpolation::Vertex;
}

void copyElements(internal::Elements<float const> src, int length, Index count,
                  Index const *sources, float scale, internal::Elements<float> dst) {
    FarExt::internal::ParallelFor(count, [&](Index i) {
        float const *const from = src.data + (sources ? sources[i] : i) * src.stride;
        std::transform(from, from + length, dst.data + i * dst.stride,
                       [scale](float value) { return scale * value; });
    });
}

// Control values are multiplied by it before sums of them are too large for floats where their mean
// is not: one of a face, or of a vertex and its faces, has less than 2^17 values.
constexpr float kScaleOfLarge = 0x1p-17f;

bool hasLarge(internal::Elements<float const> src, int length, Index begin, Index end) {
    constexpr float kLarge = std::numeric_limits<float>::max() * kScaleOfLarge;
    bool const isPacked = src.stride == length;
    std::ptrdiff_t const size = isPacked ? std::ptrdiff_t(end - begin) * length : length;
    int result = 0;
    for (Index i = begin; i < (isPacked ? begin + 1 : end); ++i) {
        float const *const values = src.data + i * src.stride;
        for (std::ptrdiff_t k = 0; k < size; ++k) {
            result |= int(std::fabs(values[k]) > kLarge);
        }
    }
    return result != 0;
}

float findScale(internal::Elements<float const> src, int length, Index count) {
    std::atomic<bool> isLarge = false;
    auto const check = [&](Index begin, Index end) {
        if (hasLarge(src, length, begin, end)) {
            isLarge = true;
        }
    };
    // Small meshes do without a parallel region, which takes longer than they do.
    if (count <= FarExt::internal::kParallelRange) {
        check(0, count);
    } else {
        FarExt::internal::ParallelForRange(count, check);
    }
    return isLarge ? kScaleOfLarge : 1.0f;
}

// Of elements behind one another.
void undoScale(float scale, internal::Elements<float> dst, int length, std::int64_t count) {
    if (scale != 1) {
        for (std::int64_t i = 0; i < count; ++i) {
            float *const element = dst.data + i * dst.stride;
            std::transform(element, element + length, element,
                           [scale](float value) { return value / scale; });
        }
    }
}

} // namespace

std::unique_ptr<RefinementEvaluator> RefinementEvaluator::Create(TopologyRefiner const &refiner,
                                                                 Options options, Status *status) {
    Status result;
    if (!FarExt::internal::IsInEnum(options.interpolationMode, FarExt::INTERPOLATE_FACE_VARYING)) {
        result = invalidArgument("there is no interpolationMode " +
                                 std::to_string(int(options.interpolationMode)));
    } else if (options.interpolationMode == FarExt::INTERPOLATE_FACE_VARYING &&
               (options.fvarChannel < 0 || options.fvarChannel >= refiner.GetNumFVarChannels())) {
        result = invalidArgument("there is no face-varying channel " +
                                 std::to_string(options.fvarChannel) + " among the refiner's " +
                                 std::to_string(refiner.GetNumFVarChannels()));
    }
    if (!FarExt::internal::Report(result, status)) {
        return nullptr;
    }
    return std::unique_ptr<RefinementEvaluator>(new RefinementEvaluator(refiner, options));
}

RefinementEvaluator::RefinementEvaluator(TopologyRefiner const &refiner, Options options)
    : _refiner(refiner), _numRefinements(refiner.GetNumRefinements()) {
    std::vector<TopologyLevel> const meshes = getMeshes(refiner, options);
    _steps.resize(meshes.size() - 1);
    internal::TileMap tileMap(
        meshes[0],
        internal::GetNumTiles(meshes[std::size_t(std::max(0, refiner.GetMaxLevel() - 1))]));
    for (std::size_t level = 0; level < _steps.size(); ++level) {
        if (level > 0) {
            tileMap.Refine(meshes[level - 1]);
        }
        FarExt::internal::RefinementMask const mask(meshes[level], refiner.GetHexSchemeOptions(),
                                                    getInterpolation(refiner, options));
        internal::MakeRefinementStep(mask, meshes[level], tileMap, _steps[level]);
    }
    for (TopologyLevel const &mesh : meshes) {
        _numElements.push_back(mesh.GetNumVertices());
    }
    if (options.interpolationMode == FarExt::INTERPOLATE_FACE_VARYING) {
        FVarLevel const &values =
            *refiner.GetLevel(0).GetTopology().fvarLevels[std::size_t(options.fvarChannel)];
        _numElements[0] = values.numValues;
        if (values.numValues != values.topology.numVertices) {
            _valuesOfVertices = &values.valuesOfVertices;
        }
    }
}

std::int64_t RefinementEvaluator::GetNumElementsAllLevels() const {
    return std::accumulate(_numElements.begin() + 1, _numElements.end(), std::int64_t(0));
}

Status RefinementEvaluator::check(float const *src, Osd::BufferDescriptor const &srcDesc,
                                  float const *dst, Osd::BufferDescriptor const &dstDesc, int level,
                                  std::int64_t numWritten) const {
    if (_refiner.GetNumRefinements() != _numRefinements) {
        return invalidArgument("the refiner has refined again since the evaluator was made");
    }
    if (level < 0 || level > GetMaxLevel()) {
        return Status(StatusCode::InvalidArgument, ComponentType::Level, level,
                      "level " + std::to_string(level) + " is not between 0 and " +
                          std::to_string(GetMaxLevel()));
    }
    if (numWritten > 0 && (!src || !dst)) {
        return invalidArgument(std::string("the ") + (src ? "destination" : "source") + " is null");
    }
    if (srcDesc.length < 1 || srcDesc.length != dstDesc.length) {
        return invalidArgument("the lengths of source and destination are " +
                               std::to_string(srcDesc.length) + " and " +
                               std::to_string(dstDesc.length) + ": not the same, or less than 1");
    }
    for (Osd::BufferDescriptor const *desc : {&srcDesc, &dstDesc}) {
        if (desc->stride < desc->length || desc->offset < 0) {
            return invalidArgument("a descriptor has stride " + std::to_string(desc->stride) +
                                   " for length " + std::to_string(desc->length) + " and offset " +
                                   std::to_string(desc->offset));
        }
    }
    return Status();
}

// The control values by vertex of the mesh of level 0, multiplied by \p scale.
auto RefinementEvaluator::toVertices(Source src, int length, float scale) -> Source {
    if (!_valuesOfVertices && scale == 1) {
        return src;
    }
    Index const numVertices =
        _valuesOfVertices ? Index(_valuesOfVertices->size()) : GetNumElements(0);
    _controlValues.Resize(std::size_t(numVertices) * std::size_t(length));
    copyElements(src, length, numVertices, _valuesOfVertices ? _valuesOfVertices->data() : nullptr,
                 scale, {_controlValues.data(), length});
    return {_controlValues.data(), length};
}

bool RefinementEvaluator::Evaluate(float const *src, Osd::BufferDescriptor const &srcDesc,
                                   float *dst, Osd::BufferDescriptor const &dstDesc, int level,
                                   Status *status) {
    bool const isLevel = level >= 0 && level <= GetMaxLevel();
    std::int64_t const numWritten = isLevel ? GetNumElements(level) : 0;
    if (!FarExt::internal::Report(check(src, srcDesc, dst, dstDesc, level, numWritten), status)) {
        return false;
    }
    int const length = srcDesc.length;
    Source values = {src + srcDesc.offset, srcDesc.stride};
    Destination const result = {dst + dstDesc.offset, dstDesc.stride};
    if (level == 0) {
        copyElements(values, length, GetNumElements(0), nullptr, 1, result);
        return true;
    }
    float const scale = findScale(values, length, GetNumElements(0));
    values = toVertices(values, length, scale);
    // The levels grow: the last two below the one asked for have room for those before.
    for (int below = std::max(1, level - 2); below < level; ++below) {
        _scratch[below % 2].Resize(std::size_t(GetNumElements(below)) * std::size_t(length));
    }
    std::vector<internal::RefinementTask> tasks;
    for (int step = 0; step < level; ++step) {
        int const made = step + 1;
        Destination const next =
            made == level ? result : Destination{_scratch[made % 2].data(), length};
        tasks.push_back({&_steps[std::size_t(step)], values, next});
        values = {next.data, next.stride};
    }
    internal::RefineElements(tasks, length);
    undoScale(scale, result, length, numWritten);
    return true;
}

bool RefinementEvaluator::EvaluateAllLevels(float const *src, Osd::BufferDescriptor const &srcDesc,
                                            float *dst, Osd::BufferDescriptor const &dstDesc,
                                            Status *status) {
    if (!FarExt::internal::Report(
            check(src, srcDesc, dst, dstDesc, GetMaxLevel(), GetNumElementsAllLevels()), status)) {
        return false;
    }
    if (GetMaxLevel() == 0) {
        return true;
    }
    int const length = srcDesc.length;
    Source values = {src + srcDesc.offset, srcDesc.stride};
    float const scale = findScale(values, length, GetNumElements(0));
    values = toVertices(values, length, scale);
    Destination const result = {dst + dstDesc.offset, dstDesc.stride};
    Destination next = result;
    std::vector<internal::RefinementTask> tasks;
    for (int step = 0; step < GetMaxLevel(); ++step) {
        tasks.push_back({&_steps[std::size_t(step)], values, next});
        values = {next.data, next.stride};
        next.data += GetNumElements(step + 1) * next.stride;
    }
    internal::RefineElements(tasks, length);
    undoScale(scale, result, length, GetNumElementsAllLevels());
    return true;
}

} // namespace OpenSubdivHex::OsdExt

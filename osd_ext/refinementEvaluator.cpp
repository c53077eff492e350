// SPDX-License-Identifier: Apache-2.0
#include "refinementEvaluator.h"

#include "far_ext/stencil/interpolationMode.h"
#include "far_ext/vtr/hierarchy.h"
#include "far_ext/vtr/parallel.h"
#include "far_ext/vtr/report.h"
#include "osd_ext/refinement/evaluationChecks.h"
#include "osd_ext/refinement/preparedLimit.h"
#include "osd_ext/refinement/refinementKernel.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

namespace OpenSubdivHex::OsdExt {

using Far::Index;
using FarExt::CallStatus;
using FarExt::StatusCode;
using FarExt::TopologyRefiner;
using FarExt::internal::FVarChannel;
using FarExt::internal::MeshLevels;

namespace {

CallStatus invalidArgument(std::string const &message) {
    return FarExt::internal::Failure(StatusCode::InvalidArgument, message);
}

template <class FLOAT>
internal::Elements<FLOAT> getElements(internal::BufferView<FLOAT *> const &view) {
    return {view.buffer + view.desc.offset, view.desc.stride};
}

void copyElements(internal::Elements<float const> src, int length, Index count,
                  Index const *sources, float scale, internal::Elements<float> dst) {
    if (!sources && scale == 1 && src.stride == length && dst.stride == length) {
        FarExt::internal::ParallelForRange(count, [&](Index begin, Index end) {
            std::copy(src.data + std::ptrdiff_t(begin) * length,
                      src.data + std::ptrdiff_t(end) * length,
                      dst.data + std::ptrdiff_t(begin) * length);
        });
        return;
    }
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

// For consecutive elements.
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

class RefinementEvaluator::Impl {
public:
    using Source = internal::Elements<float const>;
    using Destination = internal::Elements<float>;

    Impl(TopologyRefiner const &refiner, Options options);

    CallStatus Check(RefinementEvaluator::Source const &src,
                     RefinementEvaluator::Destination const &dst, int level,
                     std::int64_t numWritten) const;
    void Evaluate(Source values, Destination result, int length, int level);
    void EvaluateAllLevels(Source values, Destination result, int length);

    /// Finds the masks of a level, unless it has.
    CallStatus PrepareLimit(int level);
    /// The outputs are those of PreparedLimit.
    void EvaluateLimit(Source values, std::vector<Destination> const &outputs, int length,
                       int level);

    TopologyRefiner const &refiner;
    std::vector<int> numElements; // by level

    int GetMaxLevel() const { return int(numElements.size()) - 1; }

private:
    Source toVertices(Source src, int length, float scale);
    void resizeScratch(int length, int last);

    int const _numRefinements; // of the refiner, when the evaluator was made
    bool const _isOfVertices;  // not of face-varying values, nor varying
    std::vector<internal::PreparedRefinement> _refinements; // by level of the parent

    // For a face-varying channel some of whose values several vertices of its value mesh share: the
    // value of each vertex, see FarExt::internal::FVarLevel.
    FarExt::internal::Buffer<Index> const *_valuesOfVertices = nullptr;

    FarExt::internal::Buffer<float> _controlValues; // by vertex of that value mesh
    // Levels below the one asked for, by whether they are odd; that one, too, for its limit.
    FarExt::internal::Buffer<float> _scratch[2];

    std::vector<std::unique_ptr<internal::PreparedLimit>> _limits; // by level; null: not yet asked
};

RefinementEvaluator::Impl::Impl(TopologyRefiner const &topologyRefiner, Options options)
    : refiner(topologyRefiner), _numRefinements(refiner.GetNumRefinements()),
      _isOfVertices(options.interpolationMode == FarExt::INTERPOLATE_VERTEX) {
    bool const isFaceVarying = options.interpolationMode == FarExt::INTERPOLATE_FACE_VARYING;
    int const maxLevel = refiner.GetMaxLevel();
    MeshLevels const &mesh =
        refiner.GetHierarchy().GetMesh(isFaceVarying ? options.fvarChannel : -1);
    _refinements.resize(std::size_t(maxLevel));
    FarExt::Interpolation const interpolation = FarExt::internal::GetModeInterpolation(
        refiner, options.interpolationMode, options.fvarChannel);
    for (std::size_t level = 0; level < _refinements.size(); ++level) {
        internal::PrepareRefinement(FarExt::internal::GetRules(mesh.levels[level],
                                                               refiner.GetHexSchemeOptions(),
                                                               interpolation),
                                    mesh.refinements[level], _refinements[level]);
    }
    for (int level = 0; level <= maxLevel; ++level) {
        numElements.push_back(mesh.levels[std::size_t(level)].numVertices);
    }
    if (isFaceVarying) {
        FVarChannel const &channel =
            refiner.GetHierarchy().channels[std::size_t(options.fvarChannel)];
        numElements[0] = channel.numValues;
        if (channel.numValues != mesh.levels[0].numVertices) {
            _valuesOfVertices = &channel.valuesOfVertices;
        }
    }
}

CallStatus RefinementEvaluator::Impl::Check(RefinementEvaluator::Source const &src,
                                            RefinementEvaluator::Destination const &dst, int level,
                                            std::int64_t numWritten) const {
    if (refiner.GetNumRefinements() != _numRefinements) {
        return invalidArgument("the refiner has refined again since the evaluator was made");
    }
    if (CallStatus status = internal::CheckLevel(level, GetMaxLevel()); !status.IsOk()) {
        return status;
    }
    if (numWritten > 0 && (!src.buffer || !dst.buffer)) {
        return invalidArgument(std::string("the ") + (src.buffer ? "destination" : "source") +
                               " is null");
    }
    return internal::CheckDescriptors(src.desc, dst.desc);
}

// The control values by vertex of the mesh of level 0, multiplied by scale.
auto RefinementEvaluator::Impl::toVertices(Source src, int length, float scale) -> Source {
    if (!_valuesOfVertices && scale == 1) {
        return src;
    }
    Index const numVertices = _valuesOfVertices ? Index(_valuesOfVertices->size()) : numElements[0];
    _controlValues.Resize(std::size_t(numVertices) * std::size_t(length) + 1);
    copyElements(src, length, numVertices, _valuesOfVertices ? _valuesOfVertices->data() : nullptr,
                 scale, {_controlValues.data(), length});
    return {_controlValues.data(), length};
}

// For levels 1 ... last, which grow: the last two have room for those before, and for one float behind
// the last, which may be read.
void RefinementEvaluator::Impl::resizeScratch(int length, int last) {
    for (int level = std::max(1, last - 1); level <= last; ++level) {
        _scratch[level % 2].Resize(
            std::size_t(numElements[std::size_t(level)]) * std::size_t(length) + 1);
    }
}

void RefinementEvaluator::Impl::Evaluate(Source values, Destination result, int length, int level) {
    if (level == 0) {
        copyElements(values, length, numElements[0], nullptr, 1, result);
        return;
    }
    float const scale = findScale(values, length, numElements[0]);
    values = toVertices(values, length, scale);
    resizeScratch(length, level - 1);
    std::vector<internal::RefinementTask> tasks;
    for (int made = 1; made <= level; ++made) {
        Destination const next =
            made == level ? result : Destination{_scratch[made % 2].data(), length};
        tasks.push_back({&_refinements[std::size_t(made) - 1], values, next});
        values = {next.data, next.stride};
    }
    internal::RefineElements(tasks, length);
    undoScale(scale, result, length, numElements[std::size_t(level)]);
}

void RefinementEvaluator::Impl::EvaluateAllLevels(Source values, Destination result, int length) {
    float const scale = findScale(values, length, numElements[0]);
    values = toVertices(values, length, scale);
    Destination next = result;
    std::vector<internal::RefinementTask> tasks;
    for (int made = 1; made <= GetMaxLevel(); ++made) {
        tasks.push_back({&_refinements[std::size_t(made) - 1], values, next});
        values = {next.data, next.stride};
        next.data += numElements[std::size_t(made)] * next.stride;
    }
    internal::RefineElements(tasks, length);
    undoScale(scale, result, length,
              std::accumulate(numElements.begin() + 1, numElements.end(), std::int64_t(0)));
}

CallStatus RefinementEvaluator::Impl::PrepareLimit(int level) {
    if (!_isOfVertices) {
        return invalidArgument("there is a limit for INTERPOLATE_VERTEX alone");
    }
    _limits.resize(numElements.size());
    std::unique_ptr<internal::PreparedLimit> &limit = _limits[std::size_t(level)];
    if (limit) {
        return CallStatus();
    }
    FarExt::internal::Hierarchy const &hierarchy = refiner.GetHierarchy();
    CallStatus result =
        FarExt::internal::CheckLimitLevel(hierarchy, refiner.GetHexSchemeOptions(), level);
    if (!result.IsOk()) {
        return result;
    }
    FarExt::internal::LimitRows rows(hierarchy.mesh.levels[std::size_t(level)],
                                     refiner.GetSchemeOptions(), refiner.GetHexSchemeOptions());
    auto prepared = std::make_unique<internal::PreparedLimit>();
    result = prepared->Prepare(hierarchy.mesh, refiner.GetHexSchemeOptions(), rows);
    if (result.IsOk()) {
        limit = std::move(prepared);
    }
    return result;
}

void RefinementEvaluator::Impl::EvaluateLimit(Source values,
                                              std::vector<Destination> const &outputs, int length,
                                              int level) {
    internal::PreparedLimit const &limit = *_limits[std::size_t(level)];
    float const scale = findScale(values, length, numElements[0]);
    values = toVertices(values, length, scale);
    if (level > 0 && limit.IsNeeded(0) && values.data != _controlValues.data()) {
        // Only our own memory may be read behind its values.
        _controlValues.Resize(std::size_t(numElements[0]) * std::size_t(length) + 1);
        copyElements(values, length, numElements[0], nullptr, 1, {_controlValues.data(), length});
        values = {_controlValues.data(), length};
    }
    Source const controlValues = values;
    int const last = limit.GetLastLevel();
    resizeScratch(length, last);
    for (int made = 0; made <= last; ++made) {
        if (made > 0) {
            Destination const next = {_scratch[made % 2].data(), length};
            internal::RefineElements({{&_refinements[std::size_t(made) - 1], values, next}},
                                     length);
            values = {next.data, next.stride};
        }
        limit.Evaluate(made, values, level > 0, length, outputs);
    }
    limit.EvaluateLattice(controlValues, length, outputs);
    for (Destination const &output : outputs) {
        undoScale(scale, output, length, numElements[std::size_t(level)]);
    }
}

std::unique_ptr<RefinementEvaluator>
RefinementEvaluator::Create(TopologyRefiner const &refiner, Options options, CallStatus *status) {
    CallStatus const result =
        FarExt::internal::CheckStencilMode(refiner, options.interpolationMode, options.fvarChannel);
    if (!FarExt::internal::Report(result, status)) {
        return nullptr;
    }
    return std::unique_ptr<RefinementEvaluator>(
        new RefinementEvaluator(std::make_unique<Impl>(refiner, options)));
}

RefinementEvaluator::RefinementEvaluator(std::unique_ptr<Impl> impl) : _impl(std::move(impl)) {}

RefinementEvaluator::~RefinementEvaluator() = default;

TopologyRefiner const &RefinementEvaluator::GetTopologyRefiner() const { return _impl->refiner; }

int RefinementEvaluator::GetMaxLevel() const { return _impl->GetMaxLevel(); }

int RefinementEvaluator::GetNumElements(int level) const {
    return _impl->numElements[std::size_t(level)];
}

std::int64_t RefinementEvaluator::GetNumElementsAllLevels() const {
    return std::accumulate(_impl->numElements.begin() + 1, _impl->numElements.end(),
                           std::int64_t(0));
}

bool RefinementEvaluator::evaluate(Source const &src, Destination const &dst, int level,
                                   CallStatus *status) {
    bool const isLevel = level >= 0 && level <= GetMaxLevel();
    std::int64_t const numWritten = isLevel ? GetNumElements(level) : 0;
    if (!FarExt::internal::Report(_impl->Check(src, dst, level, numWritten), status)) {
        return false;
    }
    _impl->Evaluate(getElements(src), getElements(dst), src.desc.length, level);
    return true;
}

bool RefinementEvaluator::evaluateAllLevels(Source const &src, Destination const &dst,
                                            CallStatus *status) {
    CallStatus const result = _impl->Check(src, dst, GetMaxLevel(), GetNumElementsAllLevels());
    if (!FarExt::internal::Report(result, status)) {
        return false;
    }
    if (GetMaxLevel() > 0) {
        _impl->EvaluateAllLevels(getElements(src), getElements(dst), src.desc.length);
    }
    return true;
}

bool RefinementEvaluator::evaluateLimit(Source const &src, std::vector<Destination> const &outputs,
                                        int level, CallStatus *status) {
    bool const isLevel = level >= 0 && level <= GetMaxLevel();
    std::int64_t const numWritten = isLevel ? GetNumElements(level) : 0;
    CallStatus result;
    for (Destination const &output : outputs) {
        if (result.IsOk()) {
            result = _impl->Check(src, output, level, numWritten);
        }
    }
    if (result.IsOk()) {
        result = _impl->PrepareLimit(level);
    }
    if (!FarExt::internal::Report(result, status)) {
        return false;
    }
    if (numWritten > 0) {
        std::vector<internal::Elements<float>> elements(outputs.size());
        std::transform(outputs.begin(), outputs.end(), elements.begin(), getElements<float>);
        _impl->EvaluateLimit(getElements(src), elements, src.desc.length, level);
    }
    return true;
}

} // namespace OpenSubdivHex::OsdExt

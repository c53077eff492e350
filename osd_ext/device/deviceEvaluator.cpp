// SPDX-License-Identifier: Apache-2.0
#include "deviceEvaluator.h"

#include "far_ext/stencil/interpolationMode.h"
#include "far_ext/vtr/hierarchy.h"
#include "far_ext/vtr/report.h"
#include "osd_ext/refinement/evaluationChecks.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

namespace OpenSubdivHex::OsdExt::internal {

using FarExt::CallStatus;
using FarExt::StatusCode;
using FarExt::internal::FVarChannel;
using FarExt::internal::MeshLevels;
using FarExt::internal::Refinement;
using FarExt::internal::RefinementRules;

namespace {

constexpr auto kWord = std::int64_t(sizeof(std::uint32_t));

template <class RECORD>
constexpr auto kWordsOf = std::int64_t(sizeof(RECORD)) / kWord;

// Positions in arrays of the device are kept in 32 bits.
CallStatus checkPositions(std::int64_t count, std::string const &what) {
    constexpr std::int64_t kMax = std::numeric_limits<std::uint32_t>::max();
    return count <= kMax ? CallStatus()
                         : FarExt::internal::Failure(StatusCode::TooLarge,
                                                     what + " are " + std::to_string(count) +
                                                         ", more than the " + std::to_string(kMax) +
                                                         " that positions of 32 bits reach");
}

void setCorners(DeviceRefinement const &refinement, DeviceTask &task) {
    task.parameters.numConsecutiveCorners = refinement.numConsecutiveCorners;
    task.parameters.firstConsecutiveVertex = refinement.firstConsecutiveVertex;
    task.parameters.firstListedVertex = refinement.firstListedVertex;
}

bool isUnrolled(DeviceFaceRun const &run) {
    return !run.isWeighted && kMinUnrolledFace <= run.size && run.size <= kMaxUnrolledFace;
}

} // namespace

DeviceEvaluator::DeviceEvaluator(std::unique_ptr<Device> device,
                                 FarExt::TopologyRefiner const &refiner)
    : _device(std::move(device)), _refiner(refiner), _numRefinements(refiner.GetNumRefinements()),
      _indices(*_device), _weights(*_device), _controlValues(*_device), _evenLevel(*_device),
      _oddLevel(*_device) {}

CallStatus DeviceEvaluator::Prepare(Options options) {
    CallStatus status = FarExt::internal::CheckStencilMode(_refiner, options.interpolationMode,
                                                           options.fvarChannel);
    if (status.IsOk()) {
        status = _device->CheckContext();
    }
    if (!status.IsOk()) {
        return status;
    }
    bool const isFaceVarying = options.interpolationMode == FarExt::INTERPOLATE_FACE_VARYING;
    _isFaceVarying = isFaceVarying;
    _isOfVertices = options.interpolationMode == FarExt::INTERPOLATE_VERTEX;
    MeshLevels const &mesh =
        _refiner.GetHierarchy().GetMesh(isFaceVarying ? options.fvarChannel : -1);
    std::vector<Refinement const *> refinements;
    std::vector<std::shared_ptr<RefinementRules const>> rules;
    FarExt::Interpolation const interpolation = FarExt::internal::GetModeInterpolation(
        _refiner, options.interpolationMode, options.fvarChannel);
    for (int level = 0; level <= _refiner.GetMaxLevel(); ++level) {
        FarExt::internal::Level const &ofMesh = mesh.levels[std::size_t(level)];
        _numElements.push_back(ofMesh.numVertices);
        _numTriangles.push_back(std::int64_t(ofMesh.numCorners) -
                                2 * std::int64_t(ofMesh.numFaces));
        if (level < _refiner.GetMaxLevel()) {
            refinements.push_back(&mesh.refinements[std::size_t(level)]);
            rules.push_back(
                FarExt::internal::GetRules(ofMesh, _refiner.GetHexSchemeOptions(), interpolation));
        }
    }
    std::vector<std::int32_t> values;
    if (isFaceVarying) {
        FVarChannel const &channel =
            _refiner.GetHierarchy().channels[std::size_t(options.fvarChannel)];
        _numElements[0] = channel.numValues;
        if (channel.numValues != mesh.levels[0].numVertices) {
            _numValueVertices = mesh.levels[0].numVertices;
            values.assign(channel.valuesOfVertices.begin(), channel.valuesOfVertices.end());
        }
    }
    std::vector<float> weights;
    status = MakeDeviceRefinements(
        refinements, rules, weights, _refinements,
        [&](std::size_t numIndices, std::function<void(std::int32_t *)> const &fill) {
            return loadIndices(numIndices, fill, values);
        });
    if (status.IsOk()) {
        status = _device->CheckSize(std::int64_t(weights.size()) * kWord,
                                    "the weights of the refinements");
    }
    if (!status.IsOk()) {
        return status;
    }
    _weights.Resize(std::int64_t(weights.size()) * kWord);
    _weights.Write(0, weights);
    return _device->EndFrame();
}

// The indices of the refinements, then what they list, then the values of vertices.
CallStatus DeviceEvaluator::loadIndices(std::size_t numIndices,
                                        std::function<void(std::int32_t *)> const &fill,
                                        std::vector<std::int32_t> const &values) {
    auto next = std::int64_t(numIndices);
    auto const take = [&](std::int64_t count) {
        auto const first = std::uint32_t(next);
        next += count;
        return first;
    };
    for (DeviceRefinement const &refinement : _refinements) {
        std::uint32_t const corners =
            take(kWordsOf<DeviceCorner> * std::int64_t(refinement.corners.size()));
        _places.push_back(
            {corners, take(kWordsOf<DeviceVertex> * std::int64_t(refinement.vertices.size()))});
    }
    _firstValue = take(std::int64_t(values.size()));
    CallStatus status = checkPositions(next, "the indices of the refinements");
    if (status.IsOk()) {
        status = _device->CheckSize(next * kWord, "the indices of the refinements");
    }
    if (!status.IsOk()) {
        return status;
    }
    _indices.Resize(next * kWord);
    if (numIndices > 0) {
        _device->Fill(_indices.GetName(), std::int64_t(numIndices) * kWord,
                      [&](void *memory) { fill(static_cast<std::int32_t *>(memory)); });
    }
    for (std::size_t i = 0; i < _refinements.size(); ++i) {
        _indices.Write(_places[i].corners * kWord, _refinements[i].corners);
        _indices.Write(_places[i].vertices * kWord, _refinements[i].vertices);
    }
    _indices.Write(_firstValue * kWord, values);
    return status;
}

std::int64_t DeviceEvaluator::GetNumElementsAllLevels() const {
    return std::accumulate(_numElements.begin() + 1, _numElements.end(), std::int64_t(0));
}

std::int64_t DeviceEvaluator::GetNumDeviceBytes() const {
    std::int64_t result = _indices.GetNumBytes() + _weights.GetNumBytes();
    for (auto const &faces : _faces) {
        result += faces ? faces->indices.GetNumBytes() : 0;
    }
    for (auto const &limit : _limits) {
        result += limit ? limit->indices.GetNumBytes() + limit->weights.GetNumBytes() : 0;
    }
    return result;
}

CallStatus DeviceEvaluator::check(Values const &src, std::vector<Values> const &outputs, int level,
                                  std::int64_t numWritten) const {
    CallStatus status = CheckLevel(level, GetMaxLevel());
    auto const checkBuffer = [&](Values const &values, std::int64_t count,
                                 std::string const &what) {
        if (status.IsOk() && count > 0) {
            std::int64_t const end = values.desc.offset +
                                     (count - 1) * std::int64_t(values.desc.stride) +
                                     values.desc.length;
            status = _device->CheckBuffer(values.buffer, end, what);
        }
    };
    for (Values const &output : outputs) {
        if (status.IsOk()) {
            status = CheckDescriptors(src.desc, output.desc);
        }
    }
    checkBuffer(src, numWritten > 0 ? GetNumElements(0) : 0, "source");
    char const *const names[] = {"destination", "destination of du", "destination of dv"};
    for (std::size_t i = 0; i < outputs.size(); ++i) {
        checkBuffer(outputs[i], numWritten, names[i]);
    }
    return status;
}

DeviceTask DeviceEvaluator::makeTask(DeviceKernel kernel, int length, Elements const &src,
                                     Elements const &dst) const {
    DeviceTask task{kernel, length};
    task.sources = src.buffer;
    task.results = dst.buffer;
    task.indices = _indices.GetName();
    task.weights = _weights.GetName();
    task.listedVertices = _indices.GetName();
    task.parameters.sourceOffset = std::uint64_t(src.offset);
    task.parameters.sourceStride = std::uint64_t(src.stride);
    task.parameters.resultOffset = std::uint64_t(dst.offset);
    task.parameters.resultStride = std::uint64_t(dst.stride);
    return task;
}

void DeviceEvaluator::Frame::Add(DeviceTask &task, std::uint32_t count) {
    task.count = count;
    if (count > 0) {
        _steps.push_back({task, false});
    }
}

void DeviceEvaluator::Frame::Wait() {
    if (!_steps.empty()) {
        _steps.back().isAwaited = true;
    }
}

CallStatus DeviceEvaluator::Frame::Run(Device &device) const {
    for (Step const &step : _steps) {
        CallStatus status = device.Prepare(step.task.kernel, step.task.length, step.task.faceSize);
        if (!status.IsOk()) {
            return status;
        }
    }
    for (Step const &step : _steps) {
        device.Run(step.task);
        if (step.isAwaited) {
            device.Wait();
        }
    }
    return device.EndFrame();
}

// The control values by vertex of the mesh of level 0.
auto DeviceEvaluator::toVertices(Frame &frame, Elements const &src, int length) -> Elements {
    if (_numValueVertices == 0) {
        return src;
    }
    _controlValues.Resize(std::int64_t(_numValueVertices) * length * kWord);
    Elements const result = {_controlValues.GetName(), 0, length};
    DeviceTask task = makeTask(DeviceKernel::Copy, length, src, result);
    task.parameters.hasIndices = 1;
    task.parameters.firstIndex = _firstValue;
    frame.Add(task, std::uint32_t(_numValueVertices));
    frame.Wait();
    return result;
}

auto DeviceEvaluator::getScratch(int level, int length) -> Elements {
    return {(level % 2 == 0 ? _evenLevel : _oddLevel).GetName(), 0, length};
}

// For levels 1 ... last, which grow: the last two have room for those before.  They are no larger than
// results, which have been checked.
void DeviceEvaluator::resizeScratch(int length, int last) {
    for (int level = std::max(1, last - 1); level <= last; ++level) {
        (level % 2 == 0 ? _evenLevel : _oddLevel)
            .Resize(std::int64_t(GetNumElements(level)) * length * kWord);
    }
}

void DeviceEvaluator::refine(Frame &frame, std::size_t number, Elements const &src,
                             Elements const &dst, int length) {
    DeviceRefinement const &refinement = _refinements[number];
    auto const makeTaskOf = [&](DeviceKernel kernel) {
        DeviceTask task = makeTask(kernel, length, src, dst);
        task.parameters.firstFVertex = std::uint32_t(refinement.numVVertices);
        setCorners(refinement, task);
        return task;
    };
    for (DeviceFaceRun const &faceRun : refinement.faceRuns) {
        DeviceTask task = makeTaskOf(isUnrolled(faceRun)  ? DeviceKernel::FaceRun
                                     : faceRun.isWeighted ? DeviceKernel::WeightedFaceRun
                                                          : DeviceKernel::AnyFaceRun);
        task.faceSize = isUnrolled(faceRun) ? faceRun.size : 0;
        task.parameters.faceSize = std::uint32_t(faceRun.size);
        task.parameters.firstCorner = faceRun.firstCorner;
        task.parameters.firstWeight = faceRun.firstWeight;
        task.parameters.weightOfAll = faceRun.all;
        task.parameters.weightOfSelf = faceRun.self;
        task.parameters.weightOfNeighbors = faceRun.neighbor;
        task.parameters.weightOfOpposite = faceRun.opposite;
        frame.Add(task, faceRun.count);
    }
    if (!refinement.corners.empty()) {
        // Some corners are made again behind the runs that they are in.
        frame.Wait();
        DeviceTask task = makeTaskOf(DeviceKernel::Corners);
        task.parameters.firstIndex = _places[number].corners;
        frame.Add(task, std::uint32_t(refinement.corners.size()));
    }
    frame.Wait();
    for (DeviceVertexRun const &vertexRun : refinement.vertexRuns) {
        DeviceTask task = makeTaskOf(DeviceKernel::VertexRun);
        task.parameters.firstIndex = vertexRun.firstIndex;
        task.parameters.firstVertex = vertexRun.firstVertex;
        task.parameters.addsInTurn = vertexRun.addsInTurn ? 1 : 0;
        task.parameters.vertexWeight = refinement.vertexWeight;
        task.parameters.averagesFaces = refinement.averagesFaces ? 1 : 0;
        frame.Add(task, vertexRun.count);
    }
    DeviceTask task = makeTaskOf(DeviceKernel::Vertices);
    task.parameters.firstIndex = _places[number].vertices;
    frame.Add(task, std::uint32_t(refinement.vertices.size()));
    frame.Wait();
}

CallStatus DeviceEvaluator::Evaluate(Values const &src, Values const &dst, int level) {
    bool const isLevel = level >= 0 && level <= GetMaxLevel();
    std::int64_t const numWritten = isLevel ? GetNumElements(level) : 0;
    int const length = src.desc.length;
    CallStatus status = check(src, {dst}, level, numWritten);
    if (!status.IsOk() || numWritten == 0) {
        return status;
    }
    Frame frame;
    Elements values = {src.buffer, src.desc.offset, src.desc.stride};
    Elements const result = {dst.buffer, dst.desc.offset, dst.desc.stride};
    if (level == 0) {
        DeviceTask task = makeTask(DeviceKernel::Copy, length, values, result);
        frame.Add(task, std::uint32_t(numWritten));
        frame.Wait();
        return frame.Run(*_device);
    }
    resizeScratch(length, level - 1);
    values = toVertices(frame, values, length);
    for (int made = 1; made <= level; ++made) {
        Elements const next = made == level ? result : getScratch(made, length);
        refine(frame, std::size_t(made) - 1, values, next, length);
        values = next;
    }
    return frame.Run(*_device);
}

CallStatus DeviceEvaluator::EvaluateAllLevels(Values const &src, Values const &dst) {
    std::int64_t const numWritten = GetNumElementsAllLevels();
    int const length = src.desc.length;
    CallStatus status = check(src, {dst}, GetMaxLevel(), numWritten);
    if (!status.IsOk() || numWritten == 0) {
        return status;
    }
    Frame frame;
    Elements values = toVertices(frame, {src.buffer, src.desc.offset, src.desc.stride}, length);
    Elements next = {dst.buffer, dst.desc.offset, dst.desc.stride};
    for (int made = 1; made <= GetMaxLevel(); ++made) {
        refine(frame, std::size_t(made) - 1, values, next, length);
        values = next;
        next.offset += GetNumElements(made) * next.stride;
    }
    return frame.Run(*_device);
}

// Late preparation needs the unchanged refiner.
CallStatus DeviceEvaluator::checkRefiner() const {
    return _refiner.GetNumRefinements() == _numRefinements
               ? CallStatus()
               : FarExt::internal::Failure(
                     StatusCode::InvalidArgument,
                     "the refiner has refined again since the evaluator was made");
}

// Finds the masks of a level, unless it has, and loads them.
CallStatus DeviceEvaluator::prepareLimit(int level) {
    _limits.resize(_numElements.size());
    std::unique_ptr<Limit> &limit = _limits[std::size_t(level)];
    if (limit) {
        return CallStatus();
    }
    CallStatus status = checkRefiner();
    if (!status.IsOk()) {
        return status;
    }
    FarExt::internal::Hierarchy const &hierarchy = _refiner.GetHierarchy();
    status = FarExt::internal::CheckLimitLevel(hierarchy, _refiner.GetHexSchemeOptions(), level);
    if (!status.IsOk()) {
        return status;
    }
    FarExt::internal::LimitRows rows(hierarchy.mesh.levels[std::size_t(level)],
                                     _refiner.GetSchemeOptions(), _refiner.GetHexSchemeOptions());
    DeviceLimit prepared;
    status = MakeDeviceLimit(hierarchy.mesh, _refiner.GetHexSchemeOptions(), rows, prepared);
    if (!status.IsOk()) {
        return status;
    }
    std::int64_t const firstOwnFace =
        kWordsOf<DeviceRegularFace> * std::int64_t(prepared.regularFaces.size());
    std::int64_t const firstVertex =
        firstOwnFace + kWordsOf<DeviceOwnFace> * std::int64_t(prepared.ownFaces.size());
    std::int64_t const firstSource =
        firstVertex + kWordsOf<DeviceLimitVertex> * std::int64_t(prepared.vertices.size());
    std::int64_t const firstLatticeIndex = firstSource + std::int64_t(prepared.sources.size());
    std::int64_t const numIndices =
        firstLatticeIndex + std::int64_t(prepared.latticeIndices.size());
    status = _device->CheckSize(numIndices * kWord, "the indices of the limit");
    if (status.IsOk()) {
        status = _device->CheckSize(std::int64_t(prepared.weights.size()) * kWord,
                                    "the weights of the limit");
    }
    if (!status.IsOk()) {
        return status;
    }
    auto result = std::make_unique<Limit>(*_device);
    for (DeviceLimitVertex &vertex : prepared.vertices) {
        vertex.firstIndex += std::uint32_t(firstSource);
    }
    result->firstOwnFace = std::uint32_t(firstOwnFace);
    result->firstVertex = std::uint32_t(firstVertex);
    result->firstLatticeIndex = std::uint32_t(firstLatticeIndex);
    result->levels = std::move(prepared.levels);
    result->lattices = std::move(prepared.lattices);
    result->indices.Resize(numIndices * kWord);
    result->indices.Write(0, prepared.regularFaces);
    result->indices.Write(firstOwnFace * kWord, prepared.ownFaces);
    result->indices.Write(firstVertex * kWord, prepared.vertices);
    result->indices.Write(firstSource * kWord, prepared.sources);
    result->indices.Write(firstLatticeIndex * kWord, prepared.latticeIndices);
    result->weights.Resize(std::int64_t(prepared.weights.size()) * kWord);
    result->weights.Write(0, prepared.weights);
    limit = std::move(result);
    return status;
}

CallStatus DeviceEvaluator::EvaluateLimit(Values const &src, std::vector<Values> const &outputs,
                                          int level) {
    bool const isLevel = level >= 0 && level <= GetMaxLevel();
    std::int64_t const numWritten = isLevel ? GetNumElements(level) : 0;
    int const length = src.desc.length;
    CallStatus status = check(src, outputs, level, numWritten);
    if (status.IsOk() && !_isOfVertices) {
        status = FarExt::internal::Failure(StatusCode::InvalidArgument,
                                           "there is a limit for INTERPOLATE_VERTEX alone");
    }
    if (status.IsOk()) {
        status = prepareLimit(level);
    }
    if (!status.IsOk() || numWritten == 0) {
        return status;
    }
    std::vector<Elements> elements(outputs.size());
    std::transform(outputs.begin(), outputs.end(), elements.begin(), [](Values const &output) {
        return Elements{output.buffer, output.desc.offset, output.desc.stride};
    });
    Frame frame;
    evaluateLimit(frame, {src.buffer, src.desc.offset, src.desc.stride}, elements, length, level);
    return frame.Run(*_device);
}

// The last level from which any limit follows.
int DeviceEvaluator::Limit::GetLastLevel() const {
    int level = int(levels.size()) - 1;
    auto const isNeeded = [](DeviceLimit::OfLevel const &of) {
        return of.fVertices.count > 0 || of.ownVertices.count > 0 || of.numVertices > 0;
    };
    while (level > 0 && !isNeeded(levels[std::size_t(level)])) {
        --level;
    }
    return level;
}

// Level by level, and of each the limits that its faces make, then those of other vertices; last those in
// lattice faces.  Faces make vertices, too, that are made again behind them.
void DeviceEvaluator::evaluateLimit(Frame &frame, Elements const &src,
                                    std::vector<Elements> const &outputs, int length, int level) {
    Limit const &limit = *_limits[std::size_t(level)];
    int const last = limit.GetLastLevel();
    resizeScratch(length, last);
    Elements values = src;
    auto const runSet = [&](DeviceTask &task, DeviceLimit::Set const &set) {
        task.parameters.firstFVertex = set.firstVertex;
        std::copy(std::begin(set.weights), std::end(set.weights), task.parameters.regularWeights);
        runLimit(frame, task, limit, outputs, set.count);
    };
    for (int i = 0; i <= last; ++i) {
        DeviceLimit::OfLevel const &sets = limit.levels[std::size_t(i)];
        if (i > 0) {
            Elements const next = getScratch(i, length);
            refine(frame, std::size_t(i) - 1, values, next, length);
            values = next;
        }
        if (sets.fVertices.count > 0) {
            DeviceTask task = makeTask(DeviceKernel::RegularLimit, length, values, outputs[0]);
            setCorners(_refinements[std::size_t(i)], task);
            task.parameters.firstIndex = sets.fVertices.firstFace * kWordsOf<DeviceRegularFace>;
            runSet(task, sets.fVertices);
        }
        DeviceTask task = makeTask(DeviceKernel::OwnLimit, length, values, outputs[0]);
        task.parameters.firstIndex =
            limit.firstOwnFace + sets.ownVertices.firstFace * kWordsOf<DeviceOwnFace>;
        runSet(task, sets.ownVertices);
        if (sets.numVertices > 0) {
            frame.Wait();
            task = makeTask(DeviceKernel::VertexLimit, length, values, outputs[0]);
            task.parameters.firstIndex =
                limit.firstVertex + sets.firstVertex * kWordsOf<DeviceLimitVertex>;
            runLimit(frame, task, limit, outputs, sets.numVertices);
        }
        frame.Wait();
    }
    evaluateLattices(frame, src, outputs, length, limit);
    frame.Wait();
}

// Some floats at a time, so that invocations can be counted, of some orbits, whose weights are parameters.
void DeviceEvaluator::evaluateLattices(Frame &frame, Elements src, std::vector<Elements> outputs,
                                       int length, Limit const &limit) {
    constexpr int kMaxFloats = kMaxCompiledLength;
    constexpr std::uint32_t kMaxOrbits = 4;
    for (; length > 0; length -= kMaxFloats) {
        auto const numFloats = std::uint32_t(std::min(length, kMaxFloats));
        for (DeviceLimit::Lattice const &lattice : limit.lattices) {
            std::size_t const numWeights = lattice.weights.size() / lattice.numOrbits;
            DeviceTask task = makeTask(DeviceKernel::LatticeLimit, 1, src, outputs[0]);
            task.faceSize = lattice.faceSize;
            DeviceParameters &parameters = task.parameters;
            parameters.numFaces = lattice.numFaces;
            parameters.numFloats = numFloats;
            parameters.firstIndex = limit.firstLatticeIndex + lattice.firstIndex;
            parameters.firstOutput = limit.firstLatticeIndex + lattice.firstOutput;
            for (std::uint32_t first = 0; first < lattice.numOrbits; first += kMaxOrbits) {
                parameters.numOrbits = std::min(lattice.numOrbits - first, kMaxOrbits);
                parameters.numPairs =
                    std::min(lattice.numPairs - std::min(lattice.numPairs, first), kMaxOrbits);
                std::copy_n(lattice.weights.begin() + std::ptrdiff_t(first * numWeights),
                            parameters.numOrbits * numWeights, parameters.latticeWeights);
                // Fits: a face has more indices than floats, and 32 bits reach them (MakeDeviceLimit).
                runLimit(frame, task, limit, outputs, lattice.numFaces * numFloats);
                parameters.firstOutput +=
                    std::uint64_t(parameters.numOrbits + parameters.numPairs) *
                    std::uint64_t(lattice.faceSize) * lattice.numFaces;
            }
        }
        src.offset += kMaxFloats;
        for (Elements &output : outputs) {
            output.offset += kMaxFloats;
        }
    }
}

void DeviceEvaluator::runLimit(Frame &frame, DeviceTask &task, Limit const &limit,
                               std::vector<Elements> const &outputs, std::uint32_t count) {
    task.indices = limit.indices.GetName();
    task.weights = limit.weights.GetName();
    if (outputs.size() > 1) {
        task.parameters.hasDerivatives = 1;
        task.duResults = outputs[1].buffer;
        task.dvResults = outputs[2].buffer;
        task.parameters.duOffset = std::uint64_t(outputs[1].offset);
        task.parameters.duStride = std::uint64_t(outputs[1].stride);
        task.parameters.dvOffset = std::uint64_t(outputs[2].offset);
        task.parameters.dvStride = std::uint64_t(outputs[2].stride);
    }
    frame.Add(task, count);
}

// Loads the faces of a level, unless it has.
CallStatus DeviceEvaluator::prepareFaces(int level) {
    _faces.resize(_numElements.size());
    if (_faces[std::size_t(level)]) {
        return CallStatus();
    }
    CallStatus status = checkRefiner();
    if (!status.IsOk()) {
        return status;
    }
    MeshLevels const &mesh = _refiner.GetHierarchy().mesh;
    FarExt::internal::Level const &ofMesh = mesh.levels[std::size_t(level)];
    auto faces = std::make_unique<Faces>(*_device);
    if (level > 0 && ofMesh.isHexagonal) {
        faces->numConsecutiveCorners =
            std::uint32_t(ofMesh.faceFirstCorner[std::size_t(ofMesh.numFFaces)]);
        faces->firstConsecutiveVertex =
            std::uint32_t(mesh.refinements[std::size_t(level) - 1].GetCornerChildVertex(0));
    }
    constexpr std::size_t kFewRuns = 8;
    for (Far::Index face = 0; face < ofMesh.numFaces && faces->runs.size() <= kFewRuns; ++face) {
        auto const size = std::uint32_t(ofMesh.GetFaceSize(face));
        if (faces->runs.empty() || faces->runs.back().size != size) {
            faces->runs.push_back({std::uint32_t(face), 0,
                                   std::uint32_t(ofMesh.faceFirstCorner[std::size_t(face)]), size});
        }
        ++faces->runs.back().count;
    }
    std::vector<Far::Index> indices;
    if (faces->runs.size() > kFewRuns) {
        faces->runs.clear();
        indices.assign(ofMesh.faceFirstCorner.begin(), ofMesh.faceFirstCorner.end());
    }
    faces->firstListedVertex = std::uint32_t(indices.size());
    indices.insert(indices.end(), ofMesh.faceVerts.begin() + faces->numConsecutiveCorners,
                   ofMesh.faceVerts.end());
    status = _device->CheckSize(std::int64_t(indices.size()) * kWord, "the faces of the level");
    if (!status.IsOk()) {
        return status;
    }
    faces->indices.Resize(std::int64_t(indices.size()) * kWord);
    faces->indices.Write(0, indices);
    _faces[std::size_t(level)] = std::move(faces);
    return status;
}

CallStatus DeviceEvaluator::MakeTriangleIndices(DeviceBufferName dst, int level, int vertexOffset) {
    CallStatus status = CheckLevel(level, GetMaxLevel());
    if (status.IsOk() && _isFaceVarying) {
        status = FarExt::internal::Failure(StatusCode::InvalidArgument,
                                           "there are no triangles of face-varying values");
    }
    if (status.IsOk() && vertexOffset < 0) {
        status = FarExt::internal::Failure(StatusCode::InvalidArgument,
                                           "the vertex offset is " + std::to_string(vertexOffset) +
                                               ", and vertices would be negative");
    }
    if (status.IsOk() && GetNumTriangles(level) > 0) {
        status = _device->CheckBuffer(dst, 3 * GetNumTriangles(level), "destination");
    }
    if (status.IsOk()) {
        status = prepareFaces(level);
    }
    if (!status.IsOk()) {
        return status;
    }
    Faces const &faces = *_faces[std::size_t(level)];
    Frame frame;
    DeviceTask task = makeTask(DeviceKernel::Triangles, 1, {0, 0, 1}, {0, 0, 1});
    task.indices = faces.indices.GetName();
    task.listedVertices = faces.indices.GetName();
    task.triangles = dst;
    task.parameters.numConsecutiveCorners = faces.numConsecutiveCorners;
    task.parameters.firstConsecutiveVertex = faces.firstConsecutiveVertex;
    task.parameters.firstListedVertex = faces.firstListedVertex;
    task.parameters.vertexOffset = std::uint32_t(vertexOffset);
    for (Faces::Run const &faceRun : faces.runs) {
        task.parameters.firstFace = faceRun.firstFace;
        task.parameters.firstCorner = faceRun.firstCorner;
        task.parameters.faceSize = faceRun.size;
        frame.Add(task, faceRun.count);
    }
    if (faces.runs.empty()) {
        task.parameters.hasIndices = 1;
        frame.Add(task, faces.firstListedVertex > 0 ? faces.firstListedVertex - 1 : 0);
    }
    frame.Wait();
    return frame.Run(*_device);
}

} // namespace OpenSubdivHex::OsdExt::internal

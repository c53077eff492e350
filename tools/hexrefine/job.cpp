// SPDX-License-Identifier: Apache-2.0
#include "job.h"

#include "creaseAngle.h"
#include "degenerateFaces.h"
#include "hints.h"
#include "levelMesh.h"
#include "libraryPaths.h"
#include "normals.h"
#include "picture.h"
#include "pictureColors.h"
#include "tagText.h"

#include "far_ext/topologyRefinerFactory.h"
#include "tools/mesh/fileError.h"
#include "tools/mesh/meshCheck.h"
#include "tools/mesh/meshContent.h"
#include "tools/mesh/meshText.h"
#include "tools/mesh/meshWriter.h"
#include "tools/mesh/program.h"
#include "tools/mesh/ruleNames.h"
#include "tools/mesh/topologyDescriptor.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <new>
#include <utility>

namespace OpenSubdivHex::Tools {

namespace {

constexpr char kName[] = "hexrefine";

FarExt::HexSchemeOptions findSchemeOptions(Statistics const &statistics) {
    FarExt::HexSchemeOptions options;
    options.faceMask = FindRule<FarExt::FaceMask>(kMaskNames, statistics.mask);
    options.schemeType = FindRule<FarExt::SchemeType>(
        kSchemeNames, statistics.scheme == "hex" ? "hexagonal" : statistics.scheme);
    options.firstStep = FindRule<FarExt::FirstStep>(kFirstStepNames, statistics.firstStep);
    return options;
}

/// The data of \p mesh.
std::vector<Primvar> findPrimvars(Mesh *mesh) {
    std::vector<Primvar> primvars = {{FarExt::INTERPOLATE_VERTEX, 0, 3, {&mesh->positions}}};
    if (!mesh->vertexProperties.empty()) {
        primvars.push_back({FarExt::INTERPOLATE_VARYING, 0, 1, {}});
        for (VertexProperty &property : mesh->vertexProperties) {
            primvars.back().arrays.push_back(&property.values);
        }
    }
    for (FVarChannel &channel : mesh->channels) {
        primvars.push_back({FarExt::INTERPOLATE_FACE_VARYING,
                            int(&channel - mesh->channels.data()),
                            channel.width,
                            {&channel.values}});
    }
    return primvars;
}

/// Adds to vertices the mean of the normals on their sides, as properties.
void addMeanNormals(FarExt::LimitSides const &sides, std::vector<float> const &normals,
                    Mesh *mesh) {
    std::vector<float> means(mesh->positions.size());
    for (int side = 0; side < sides.GetNumSides(); ++side) {
        for (std::size_t k = 0; k < 3; ++k) {
            means[3 * std::size_t(sides.GetVertex(side)) + k] += normals[3 * std::size_t(side) + k];
        }
    }
    Normalize(&means);
    for (int k = 0; k < 3; ++k) {
        VertexProperty property{GetPropertyName(FVarKind::Normal, k), NumberType::Float, {}};
        for (std::size_t i = std::size_t(k); i < means.size(); i += 3) {
            property.values.push_back(means[i]);
        }
        mesh->vertexProperties.push_back(std::move(property));
    }
}

/// The names of those values of channels that files like \p path have no place for as properties of vertices.
std::vector<std::string> findValuesNotHeld(std::string const &path,
                                           std::vector<FVarChannel> const &channels) {
    Mesh properties;
    for (FVarChannel const &channel : channels) {
        for (int k = 0; k < channel.width; ++k) {
            properties.vertexProperties.push_back(
                {GetPropertyName(channel.kind, k), NumberType::Float, {}});
        }
    }
    return RemoveWhatIsNotHeld(path, &properties);
}

} // namespace

Job::Job(Arguments const &arguments, Progress &progress)
    : _arguments(arguments), _progress(progress) {
    _statistics.scheme = arguments.scheme;
    _statistics.firstStep = arguments.firstStep.value_or("none");
    if (arguments.isCoplanar) {
        _statistics.coplanar = {arguments.tolerance, arguments.hasOpenGaps};
    }
    _statistics.mask = arguments.mask.value_or(arguments.IsLikeRenderer() ? "smooth" : "average");
    _statistics.evaluator = isAdaptive() ? "surface" : arguments.evaluator;
    _statistics.input = arguments.input;
}

void Job::Read() {
    measure("reading", &_statistics.milliseconds.read,
            [&] { _mesh = ReadInput(kName, _arguments.input); });
    _regions = FindRegions(_arguments.pngColors, _mesh, _arguments.input);
    if (_arguments.IsLikeRenderer() && !_arguments.firstStep && IsOfTriangles(_mesh)) {
        _statistics.firstStep = "truncate";
    }
}

void Job::Validate() {
    measure("validating", &_statistics.milliseconds.validate, [&] {
        if (_arguments.creaseAngle) {
            AddCreases(*_arguments.creaseAngle, &_mesh);
        }
        Sdc::Options const sdcOptions = chooseOptions();
        _tagText = _arguments.printsTags ? FormatTags(_mesh, sdcOptions) : "";
        _statistics.notRead = _mesh.notRead;
        if (_arguments.isLimit || isAdaptive()) {
            removeNormals();
        }
        removeWhatIsNotWritten();
        _statistics.attributes = CountAttributes(_mesh);
        createRefiner(sdcOptions);
        requireFaces();
        _statistics.boundary = kBoundaryNames[sdcOptions.GetVtxBoundaryInterpolation()];
        _statistics.creasingMethod = kCreasingMethodNames[sdcOptions.GetCreasingMethod()];
        _statistics.fvarInterpolation =
            kFVarInterpolationNames[sdcOptions.GetFVarLinearInterpolation()];
    });
}

void Job::Refine() {
    measure("refining", &_statistics.milliseconds.refine, [&] {
        // With --adaptive, level 0 is enough where it is the surface level.
        if (!isAdaptive() || getLastLevel() > 0) {
            refineTopology();
        }
    });
    _statistics.levels = CountLevels(*_refiner);
    _statistics.creases = _mesh.tags.GetNumCreases();
    _statistics.corners = _mesh.tags.GetNumCorners();
    _statistics.holes = CountHoles(*_refiner);
    _statistics.channels = CountChannels(*_refiner, _mesh);
}

void Job::Evaluate() {
    if (getLastLevel() > 0) {
        evaluateLevel();
    }
    if (isAdaptive()) {
        refineCells();
    } else if (getLastLevel() > 0) {
        NormalizeNormals(&_mesh);
    }
    if (_arguments.isLimit) {
        evaluateLimit();
    }
    CheckFinite(_mesh, _arguments.input, "level " + std::to_string(getLastLevel()) + ": ");
}

void Job::Draw() {
    if (_arguments.png.empty()) {
        return;
    }
    measure("rendering", &_statistics.milliseconds.render, [&] {
        if (isAdaptive()) {
            drawCells();
        } else {
            WritePicture(_refiner->GetLevel(getLastLevel()), _mesh.positions, _regions,
                         _arguments.png);
        }
    });
}

void Job::Write() {
    if (_arguments.output.empty()) {
        return;
    }
    measure("writing", &_statistics.milliseconds.write, [&] {
        if (!isAdaptive()) {
            copyFaces();
        }
        if (isAdaptive()) {
            _cells->Write();
        } else {
            WriteMesh(_mesh, _arguments.output);
        }
    });
}

template <typename WORK>
void Job::measure(char const *phase, double *milliseconds, WORK &&work) {
    _progress.SetPhase(phase);
    auto const start = std::chrono::steady_clock::now();
    work();
    auto const time = std::chrono::steady_clock::now() - start;
    *milliseconds += std::chrono::duration<double, std::milli>(time).count();
}

bool Job::isAdaptive() const { return _arguments.adaptive.isAdaptive; }

// Cells begin with the faces of the surface level.
int Job::getLastLevel() const {
    return isAdaptive() ? _refiner->GetHexSchemeOptions().GetSurfaceLevel() : _arguments.level;
}

// Evaluators of tables give no status.
void Job::requireDone(bool isDone, FarExt::CallStatus const &status) const {
    if (!isDone) {
        throw FileError(_arguments.input,
                        status.IsOk() ? "--evaluator " + _arguments.evaluator + " gives no values"
                                      : status.GetErrorMessage());
    }
}

void Job::warn(std::string const &message) const { PrintWarning(kName, _arguments.input, message); }

// The rules: those of the command line, else those of the file, else those of --like, else those of Sdc::Options.
Sdc::Options Job::chooseOptions() const {
    MeshTags const &tags = _mesh.tags;
    Sdc::Options options;
    if (_arguments.IsLikeRenderer()) {
        options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
        options.SetFVarLinearInterpolation(Sdc::Options::FVAR_LINEAR_BOUNDARIES);
    }
    auto boundary = tags.boundary.value_or(options.GetVtxBoundaryInterpolation());
    if (_arguments.boundary) {
        boundary = FindRule<decltype(boundary)>(kBoundaryNames, *_arguments.boundary);
    }
    auto fvarInterpolation = tags.fvarInterpolation.value_or(options.GetFVarLinearInterpolation());
    if (_arguments.fvarInterpolation) {
        fvarInterpolation = FindRule<decltype(fvarInterpolation)>(kFVarInterpolationNames,
                                                                  *_arguments.fvarInterpolation);
    }
    options.SetVtxBoundaryInterpolation(boundary);
    options.SetFVarLinearInterpolation(fvarInterpolation);
    options.SetCreasingMethod(tags.creasingMethod.value_or(options.GetCreasingMethod()));
    return options;
}

void Job::removeWhatIsNotWritten() {
    if (_arguments.output.empty()) {
        return;
    }
    for (FVarChannel const &channel : _mesh.channels) {
        _statistics.channelsLeftOut.push_back(GetName(channel.kind));
    }
    std::vector<FVarChannel> separated; // which will be properties of vertices
    if (_arguments.isSeparate) {
        separated.swap(_mesh.channels);
    }
    _statistics.notWritten = RemoveWhatIsNotHeld(_arguments.output, &_mesh);
    if (_arguments.isSeparate) {
        std::vector<std::string> const notHeld = findValuesNotHeld(_arguments.output, separated);
        _statistics.notWritten.insert(_statistics.notWritten.end(), notHeld.begin(), notHeld.end());
        _mesh.channels = std::move(separated);
    }
    if (!_mesh.channels.empty()) {
        _statistics.channelsLeftOut.clear(); // a format holds all or none
    }
    _statistics.outputFormat = std::filesystem::path(_arguments.output).extension().string();
    _mesh.materialLibraries =
        MoveLibraries(std::move(_mesh.materialLibraries), _arguments.input, _arguments.output);
}

// Removes the normals of corners and of vertices, and names them, where vertices come to lie on the limit surface:
// its normals are others.
void Job::removeNormals() {
    std::vector<FVarChannel> &channels = _mesh.channels;
    std::vector<VertexProperty> &properties = _mesh.vertexProperties;
    std::size_t const numBefore = channels.size() + properties.size();
    channels.erase(
        std::remove_if(channels.begin(), channels.end(),
                       [](FVarChannel const &channel) { return channel.kind == FVarKind::Normal; }),
        channels.end());
    properties.erase(std::remove_if(properties.begin(), properties.end(), IsNormal),
                     properties.end());
    if (channels.size() + properties.size() < numBefore) {
        _statistics.notRead.emplace_back(_arguments.isLimit
                                             ? "normals, those of --limit replace them"
                                             : "normals, which are not those of the surface");
    }
}

void Job::createRefiner(Sdc::Options sdcOptions) {
    Far::TopologyDescriptor descriptor = DescribeTopology(_mesh);
    auto const channels = DescribeChannels(_mesh);
    descriptor.numFVarChannels = int(channels.size());
    descriptor.fvarChannels = channels.data();
    FarExt::TopologyRefinerFactory::Options options;
    options.hexSchemeOptions = findSchemeOptions(_statistics);
    FarExt::CallStatus status;
    _refiner = FarExt::TopologyRefinerFactory::Create(descriptor, sdcOptions, options, &status);
    if (!_refiner) {
        throw FileError(_arguments.input, status.GetErrorMessage());
    }
    for (FarExt::Warning const &warning : status.GetWarnings()) {
        warn(warning.message);
    }
    std::string const degenerateFaces = DescribeDegenerateFaces(_mesh);
    if (!degenerateFaces.empty()) {
        warn(degenerateFaces);
    }
    _hints =
        FindHints(_mesh, *_refiner, isAdaptive() ? _arguments.adaptive.maxLevel : _arguments.level,
                  _arguments.mask || _arguments.IsLikeRenderer(),
                  _arguments.firstStep || _arguments.isCoplanar);
}

void Job::requireFaces() const {
    char const *const task = !_arguments.output.empty() ? "write"
                             : !_arguments.png.empty()  ? "draw"
                                                        : nullptr;
    if (task && _mesh.tags.GetNumHoles() == _mesh.GetNumFaces()) {
        throw FileError(_arguments.input,
                        std::string("all faces are holes, none is left to ") + task);
    }
}

// The positions of the mesh are the rest pose.
void Job::refineTopology() {
    FarExt::CallStatus status;
    bool const needsFullTopology = _arguments.isLimit || isAdaptive() || !_arguments.png.empty();
    FarExt::TopologyRefiner::UniformOptions uniformOptions(getLastLevel());
    uniformOptions.fullTopologyInLastLevel = needsFullTopology;
    if (_refiner->GetHexSchemeOptions().firstStep == FarExt::FirstStep::Truncate) {
        uniformOptions.faceLabels = FindFaceClasses(_mesh);
    }
    FarExt::TopologyRefiner::CoplanarOptions options(getLastLevel());
    options.angleTolerance = _arguments.tolerance;
    options.closeGaps = !_arguments.hasOpenGaps;
    options.fullTopologyInLastLevel = needsFullTopology;
    bool const isDone = _arguments.isCoplanar
                            ? _refiner->RefineCoplanar(_mesh.positions.data(), options, &status)
                            : _refiner->RefineUniform(uniformOptions, &status);
    if (!isDone) {
        throw FileError(_arguments.input, status.GetErrorMessage());
    }
}

// All values but positions that --limit replaces.
void Job::evaluateLevel() {
    for (Primvar const &primvar : findPrimvars(&_mesh)) {
        if (!_arguments.isLimit || primvar.mode != FarExt::INTERPOLATE_VERTEX) {
            evaluatePrimvar(primvar);
        }
    }
}

void Job::evaluatePrimvar(Primvar const &primvar) {
    auto &milliseconds = _statistics.milliseconds;
    FarExt::CallStatus status;
    if (!NeedsStencils(_arguments.evaluator)) {
        measure("evaluating", &milliseconds.evaluate, [&] {
            requireDone(EvaluateLevels(*_refiner, _arguments.evaluator, primvar, &status), status);
        });
        return;
    }
    std::unique_ptr<Far::StencilTable const> table;
    measure("building stencils", &milliseconds.stencils, [&] {
        table = CreateStencils(*_refiner, primvar, &status);
        requireDone(table != nullptr, status);
    });
    if (primvar.mode == FarExt::INTERPOLATE_VERTEX) {
        _statistics.stencils = table->GetNumStencils();
        _statistics.weights = std::int64_t(table->GetWeights().size());
    }
    measure("evaluating", &milliseconds.evaluate,
            [&] { requireDone(EvaluateStencils(*table, _arguments.evaluator, primvar), status); });
}

// Replaces the positions by limit points, and finds the normals.
void Job::evaluateLimit() {
    auto &milliseconds = _statistics.milliseconds;
    _sides.emplace(_refiner->GetLevel(getLastLevel()));
    FarExt::CallStatus status;
    // Tables alone have further sides.
    bool const fromLevel0 = NeedsStencils(_arguments.evaluator);
    if (!fromLevel0 && _sides->GetNumSides() == _sides->GetNumVertices()) {
        measure("evaluating", &milliseconds.evaluate, [&] {
            requireDone(EvaluateLimit(*_refiner, _arguments.evaluator, &_mesh.positions, &_normals,
                                      &status),
                        status);
        });
        return;
    }
    // Where vertices of large faces depend on all of level 0, a table of these is too large to make for one use.
    if (!fromLevel0 && getLastLevel() > 0) {
        evaluatePrimvar(findPrimvars(&_mesh).front());
    }
    std::unique_ptr<Far::LimitStencilTable const> table;
    measure("building limit stencils", &milliseconds.stencils, [&] {
        table = CreateLimitStencils(*_refiner, fromLevel0, &status);
        requireDone(table != nullptr, status);
    });
    _statistics.stencils = table->GetNumStencils();
    _statistics.weights = std::int64_t(table->GetWeights().size());
    measure("evaluating", &milliseconds.evaluate, [&] {
        requireDone(
            EvaluateLimit(*table, *_sides, _arguments.evaluator, &_mesh.positions, &_normals),
            status);
    });
}

void Job::refineCells() {
    measure("evaluating", &_statistics.milliseconds.evaluate, [&] {
        _cells.emplace(_mesh, _arguments.output, !_arguments.png.empty());
        _cells->Refine(_arguments.adaptive, *_refiner, _arguments.input);
        _statistics.adaptive = _cells->GetStatistics();
    });
    AdaptiveStatistics const &cells = _cells->GetStatistics();
    if (cells.facesNotRead > 0 && !_arguments.output.empty()) {
        warn(std::to_string(cells.facesNotRead) + (cells.facesNotRead == 1 ? " face" : " faces") +
             " of the output with more than " + std::to_string(AdaptiveStatistics::kMaxReadSize) +
             " vertices, which hexrefine does not read again, the first in face " +
             std::to_string(cells.firstNotRead) + " with " +
             std::to_string(cells.sizeOfFirstNotRead) + " vertices");
    }
}

void Job::drawCells() const {
    try {
        WriteCellPicture(_cells->GetMesh(), _cells->GetCamera(),
                         FindCellRegions(_arguments.pngColors, _regions, _cells->GetMesh(),
                                         _cells->GetFaceLevels()),
                         _arguments.png);
    } catch (std::bad_alloc const &) {
        throw FileError(_arguments.png, "not enough memory for a picture of " +
                                            _arguments.adaptive.resolution + " pixels");
    }
}

// Replaces the faces of level 0 by those of the last level.  The normals of --limit come with them: those of
// each side of a vertex where the file takes them, else their mean.
void Job::copyFaces() {
    FarExt::TopologyLevel const &level = _refiner->GetLevel(getLastLevel());
    FarExt::LimitSides const *const sides = _sides ? &*_sides : nullptr;
    bool const hasSides =
        sides && (_arguments.isSeparate || FindMeshFormat(_arguments.output) == MeshFormat::Obj);
    if (hasSides) {
        _mesh.channels.push_back({FVarKind::Normal, 3, std::move(_normals), {}});
    }
    if (_arguments.isSeparate) {
        CopySeparateFaces(level, sides, &_mesh);
    } else if (hasSides) {
        CopyFaces(level, *sides, &_mesh);
    } else {
        CopyFaces(level, &_mesh);
        if (sides) {
            addMeanNormals(*sides, _normals, &_mesh);
        }
    }
}

} // namespace OpenSubdivHex::Tools

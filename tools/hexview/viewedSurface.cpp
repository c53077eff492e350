// SPDX-License-Identifier: Apache-2.0
#include "viewedSurface.h"

#include "shaders.h"

#include "far_ext/stencilTableFactory.h"
#include "far_ext/topologyRefinerFactory.h"
#include "osd_ext/polygonIndices.h"
#include "tools/hexrefine/creaseAngle.h"
#include "tools/mesh/topologyDescriptor.h"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <stdexcept>

namespace OpenSubdivHex::Tools {

namespace {

using OsdExt::DrawnFaces;
using OsdExt::PolygonIndices;

Osd::BufferDescriptor const kPacked(0, kLength, kLength);

[[noreturn]] void fail(FarExt::CallStatus const &status) {
    throw std::runtime_error(status.GetErrorMessage());
}

std::unique_ptr<FarExt::TopologyRefiner> makeRefiner(Mesh const &mesh,
                                                     SurfaceSettings const &settings) {
    Mesh creased = mesh;
    if (settings.creaseAngle) {
        AddCreases(*settings.creaseAngle, &creased);
    }
    Far::TopologyDescriptor descriptor = DescribeTopology(creased);
    auto const channels = DescribeChannels(creased);
    descriptor.numFVarChannels = int(channels.size());
    descriptor.fvarChannels = channels.data();
    Sdc::Options sdcOptions;
    sdcOptions.SetVtxBoundaryInterpolation(settings.boundary);
    sdcOptions.SetFVarLinearInterpolation(
        mesh.tags.fvarInterpolation.value_or(sdcOptions.GetFVarLinearInterpolation()));
    sdcOptions.SetCreasingMethod(mesh.tags.creasingMethod.value_or(sdcOptions.GetCreasingMethod()));
    FarExt::TopologyRefinerFactory::Options options;
    options.hexSchemeOptions = settings.scheme;
    FarExt::CallStatus status;
    auto refiner = FarExt::TopologyRefinerFactory::Create(descriptor, sdcOptions, options, &status);
    // Cells begin with the faces of the surface level.
    FarExt::TopologyRefiner::UniformOptions uniform(
        settings.isAdaptive ? settings.scheme.GetSurfaceLevel() : settings.level);
    if (settings.arePatches && !settings.isAdaptive) {
        uniform = FarExt::PatchTableFactory::Options(settings.level).GetRefineUniformOptions();
    }
    uniform.fullTopologyInLastLevel = true;
    if (!refiner || !refiner->RefineUniform(uniform, &status)) {
        fail(status);
    }
    return refiner;
}

/// The channel with texture coordinates; -1 if there is none.
int findUvChannel(Mesh const &mesh) {
    auto const found =
        std::find_if(mesh.channels.begin(), mesh.channels.end(),
                     [](FVarChannel const &channel) { return channel.kind == FVarKind::Uv; });
    return found == mesh.channels.end() ? -1 : int(found - mesh.channels.begin());
}

/// The texture coordinates of the last level.
std::vector<float> evaluateCoords(FarExt::TopologyRefiner const &refiner, Mesh const &mesh,
                                  int channel) {
    OsdExt::RefinementEvaluator::Options options;
    options.interpolationMode = FarExt::INTERPOLATE_FACE_VARYING;
    options.fvarChannel = channel;
    FarExt::CallStatus status;
    auto const evaluator = OsdExt::RefinementEvaluator::Create(refiner, options, &status);
    FVarChannel const &values = mesh.channels[std::size_t(channel)];
    Osd::BufferDescriptor const desc(0, values.width, values.width);
    int const level = refiner.GetMaxLevel();
    std::vector<float> result;
    if (evaluator) {
        result.resize(std::size_t(evaluator->GetNumElements(level)) * std::size_t(values.width));
    }
    if (!evaluator ||
        !evaluator->Evaluate(values.values.data(), desc, result.data(), desc, level, &status)) {
        fail(status);
    }
    return result;
}

/// The last level of a refiner.
DrawnTopology makeTopology(FarExt::TopologyRefiner const &refiner, Mesh const &mesh,
                           SurfaceSettings const &settings) {
    FarExt::TopologyLevel const &level = refiner.GetLevel(settings.level);
    FarExt::LimitSides const sides(level);
    OsdExt::DrawOptions drawOptions;
    drawOptions.sides = &sides;
    drawOptions.splitVertices = true;
    int const channel = findUvChannel(mesh);
    if (channel >= 0) {
        drawOptions.fvarChannels.push_back(channel);
    } else {
        drawOptions.generateBaseCoords = settings.scheme.IsHexagonal();
    }
    FarExt::CallStatus status;
    PolygonIndices polygons = OsdExt::CreatePolygonIndices(level, drawOptions, &status);
    if (!status.IsOk()) {
        fail(status);
    }
    OsdExt::TriangleIndices triangles = OsdExt::CreateTriangleIndices(polygons);
    DrawnTopology result;
    result.coords.resize(2 * triangles.vertices.size());
    if (channel >= 0) {
        std::vector<float> const values = evaluateCoords(refiner, mesh, channel);
        auto const width = std::size_t(mesh.channels[std::size_t(channel)].width);
        for (std::size_t i = 0; i < triangles.vertices.size(); ++i) {
            std::copy_n(values.begin() +
                            std::ptrdiff_t(width * std::size_t(triangles.fvarValues[0][i])),
                        2, result.coords.begin() + std::ptrdiff_t(2 * i));
        }
    } else if (!triangles.baseCoords.empty()) {
        result.coords = std::move(triangles.baseCoords);
    }
    for (int side = 0; side < sides.GetNumSides(); ++side) {
        result.sideVertices.push_back(unsigned(sides.GetVertex(side)));
    }
    for (int const face : triangles.baseFaces) {
        result.triangleFaces.push_back(face);
        result.triangleFaces.push_back(settings.level);
    }
    result.polygonSizes = std::move(polygons.sizes);
    result.polygonSides = std::move(polygons.vertices);
    result.triangleSides = std::move(triangles.vertices);
    return result;
}

bool areEqual(BfrExt::Camera const &a, BfrExt::Camera const &b) {
    auto const areSame = [](double const(&x)[3], double const(&y)[3]) {
        return std::equal(std::begin(x), std::end(x), std::begin(y));
    };
    return areSame(a.eye, b.eye) && areSame(a.target, b.target) && areSame(a.up, b.up) &&
           a.fieldOfView == b.fieldOfView && a.width == b.width && a.height == b.height;
}

double getMilliseconds(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
        .count();
}

} // namespace

ViewedSurface::ViewedSurface(Mesh mesh)
    : _mesh(std::move(mesh)), _controlPoints(_mesh.positions),
      _normalProgram({{GL_COMPUTE_SHADER, {kNormalShader}}}) {
    int const *vert = _mesh.faceVertices.data();
    for (int const size : _mesh.faceSizes) {
        for (int i = 0; i < size; ++i) {
            _controlEdges.push_back(unsigned(vert[i]));
            _controlEdges.push_back(unsigned(vert[(i + 1) % size]));
        }
        vert += size;
    }
}

void ViewedSurface::Refine(SurfaceSettings const &settings) {
    auto refiner = makeRefiner(_mesh, settings);
    if (settings.isAdaptive || settings.arePatches) {
        std::unique_ptr<CellView> cells;
        std::unique_ptr<PatchView> patches;
        if (settings.isAdaptive) {
            cells = std::make_unique<CellView>(_mesh, std::move(refiner), findUvChannel(_mesh));
        } else {
            patches = std::make_unique<PatchView>(*refiner, settings.level);
        }
        _settings = settings;
        _refiner.reset();
        _cpuEvaluator.reset();
        _glEvaluator.reset();
        _glTable.reset();
        _tableEvaluator.reset();
        _cells = std::move(cells);
        _patches = std::move(patches);
        if (_patches) {
            Evaluate();
        }
        return;
    }
    FarExt::TopologyLevel const &level = refiner->GetLevel(settings.level);
    FarExt::CallStatus status;

    // The evaluator, and with it all that may be refused.
    std::unique_ptr<OsdExt::RefinementEvaluator> cpuEvaluator;
    std::unique_ptr<OsdExt::GLRefinementEvaluator> glEvaluator;
    std::unique_ptr<Osd::GLStencilTableSSBO> glTable;
    std::unique_ptr<Osd::GLComputeEvaluator> tableEvaluator;
    if (settings.evaluator == ViewEvaluator::Cpu) {
        cpuEvaluator = OsdExt::RefinementEvaluator::Create(*refiner, &status);
        std::vector<float> points(std::size_t(kLength * level.GetNumVertices()));
        if (!cpuEvaluator || (settings.isLimit && !cpuEvaluator->EvaluateLimit(
                                                      _controlPoints.data(), kPacked, points.data(),
                                                      kPacked, settings.level, &status))) {
            fail(status);
        }
    } else if (settings.evaluator == ViewEvaluator::OpenGl) {
        glEvaluator = OsdExt::GLRefinementEvaluator::Create(*refiner, &status);
        GlArray control;
        GlArray points;
        control.Assign(_controlPoints);
        points.Resize(std::size_t(kLength * level.GetNumVertices()));
        if (!glEvaluator ||
            (settings.isLimit && !glEvaluator->EvaluateLimit(&control, kPacked, &points, kPacked,
                                                             settings.level, &status))) {
            fail(status);
        }
    } else {
        if (settings.isLimit) {
            FarExt::LimitStencilTableFactory::Options options;
            options.level = settings.level;
            auto const table = FarExt::LimitStencilTableFactory::Create(*refiner, options, &status);
            glTable =
                table ? OsdExt::CreateGLStencilTable<Osd::GLStencilTableSSBO>(*table) : nullptr;
        } else {
            FarExt::StencilTableFactory::Options options;
            options.generateIntermediateLevels = false;
            options.generateControlVerts = settings.level == 0;
            auto const table = FarExt::StencilTableFactory::Create(*refiner, options, &status);
            glTable =
                table ? OsdExt::CreateGLStencilTable<Osd::GLStencilTableSSBO>(*table) : nullptr;
        }
        if (!glTable) {
            fail(status);
        }
        tableEvaluator.reset(Osd::GLComputeEvaluator::Create(
            kPacked, kPacked, Osd::BufferDescriptor(), Osd::BufferDescriptor()));
    }

    DrawnTopology const drawn = makeTopology(*refiner, _mesh, settings);
    _settings = settings;
    _refiner = std::move(refiner);
    _cpuEvaluator = std::move(cpuEvaluator);
    _glEvaluator = std::move(glEvaluator);
    _glTable = std::move(glTable);
    _tableEvaluator = std::move(tableEvaluator);
    _cells.reset();
    _patches.reset();
    _points.Resize(std::size_t(kLength * level.GetNumVertices()));
    _normals.Resize(4 * drawn.sideVertices.size());
    setTopology(drawn);
    Evaluate();
}

void ViewedSurface::setTopology(DrawnTopology const &drawn) {
    // The neighbours of each side in the polygons around it, and the edges.
    std::size_t const numSides = drawn.sideVertices.size();
    std::vector<unsigned> firstFans(numSides + 1, 0);
    for (int const side : drawn.polygonSides) {
        ++firstFans[std::size_t(side) + 1];
    }
    for (std::size_t i = 0; i < numSides; ++i) {
        firstFans[i + 1] += firstFans[i];
    }
    std::vector<unsigned> next(firstFans.begin(), firstFans.end() - 1);
    std::vector<unsigned> fans(2 * drawn.polygonSides.size());
    std::vector<unsigned> edges;
    int const *polygon = drawn.polygonSides.data();
    for (int const size : drawn.polygonSizes) {
        for (int i = 0; i < size; ++i) {
            auto const before = unsigned(polygon[(i + size - 1) % size]);
            auto const behind = unsigned(polygon[(i + 1) % size]);
            unsigned const fan = next[std::size_t(polygon[i])]++;
            fans[2 * fan] = before;
            fans[2 * fan + 1] = behind;
            edges.push_back(unsigned(polygon[i]));
            edges.push_back(behind);
        }
        polygon += size;
    }
    _numFaces = int(drawn.polygonSizes.size());
    _sideVertices.Assign(drawn.sideVertices);
    _firstFans.Assign(firstFans);
    _fans.Assign(fans);
    _cornerSides.Assign(drawn.triangleSides);
    _coords.Assign(drawn.coords);
    _faces.Assign(drawn.triangleFaces);
    _edgeSides.Assign(edges);
}

void ViewedSurface::Follow(BfrExt::Camera const &camera, CellSettings const &settings,
                           bool isFrozen) {
    if (!_cells) {
        return;
    }
    bool const isSame = areEqual(camera, _camera) &&
                        settings.pixelError == _cellSettings.pixelError &&
                        settings.maxLevel == _cellSettings.maxLevel &&
                        settings.isCulling == _cellSettings.isCulling;
    bool const isRefining = !_cells->IsRefined() || (!isFrozen && (!isSame || _hasMoved));
    if (!isRefining && !_hasMoved) {
        return;
    }
    auto const start = std::chrono::steady_clock::now();
    if (isRefining) {
        auto const options = BfrExt::View::Options()
                                 .SetFlatness(double(settings.pixelError))
                                 .SetMaxLevel(settings.maxLevel)
                                 .SetCulling(settings.isCulling);
        BfrExt::View const view(camera, options);
        if (!view.IsValid()) {
            throw std::runtime_error("the camera sees nothing");
        }
        _cells->Refine(view, _controlPoints);
        setTopology(_cells->GetTopology());
        _camera = camera;
        _cellSettings = settings;
    }
    _cells->Evaluate(_controlPoints);
    _points.Assign(_cells->GetPoints());
    _normals.Assign(_cells->GetNormals());
    makeNormals(true);
    glFinish();
    _hasMoved = false;
    _milliseconds = getMilliseconds(start);
}

void ViewedSurface::Evaluate() {
    if (_cells) {
        _hasMoved = true;
        return;
    }
    glFinish();
    auto const start = std::chrono::steady_clock::now();
    if (_patches) {
        _patches->Evaluate(_controlPoints);
        glFinish();
        _milliseconds = getMilliseconds(start);
        return;
    }
    if (_cpuEvaluator) {
        std::vector<float> points(_points.GetSize());
        if (_settings.isLimit) {
            _cpuEvaluator->EvaluateLimit(_controlPoints.data(), kPacked, points.data(), kPacked,
                                         _settings.level);
        } else {
            _cpuEvaluator->Evaluate(_controlPoints.data(), kPacked, points.data(), kPacked,
                                    _settings.level);
        }
        _points.Assign(points);
    } else {
        _controlArray.Assign(_controlPoints);
        if (_glEvaluator && _settings.isLimit) {
            _glEvaluator->EvaluateLimit(&_controlArray, kPacked, &_points, kPacked,
                                        _settings.level);
        } else if (_glEvaluator) {
            _glEvaluator->Evaluate(&_controlArray, kPacked, &_points, kPacked, _settings.level);
        } else {
            OsdExt::EvalStencilsInRanges(*_tableEvaluator, &_controlArray, kPacked, &_points,
                                         kPacked, *_glTable);
        }
    }
    makeNormals(false);
    glFinish();
    _milliseconds = getMilliseconds(start);
}

// The normals, unless they are there, and then the mean curvature.
void ViewedSurface::makeNormals(bool areNormalsThere) const {
    constexpr GLuint kGroup = 64;
    constexpr GLuint kMaxGroups = 65535;
    auto const numSides = GLuint(_sideVertices.GetSize());
    GLuint const numGroups = (numSides + kGroup - 1) / kGroup;
    GLuint const numRows = (numGroups + kMaxGroups - 1) / kMaxGroups;
    Bind();
    _firstFans.Bind(kFirstFanArray);
    _fans.Bind(kFanArray);
    _normalProgram.Use();
    glUniform1ui(_normalProgram["count"], numSides);
    for (int pass = areNormalsThere ? 1 : 0; pass < 2; ++pass) {
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
        glUniform1i(_normalProgram["areNormalsThere"], pass);
        if (numRows > 0) {
            glDispatchCompute((numGroups + numRows - 1) / numRows, numRows, 1);
        }
    }
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

void ViewedSurface::Bind() const {
    _points.Bind(kPointArray);
    _sideVertices.Bind(kSideVertexArray);
    _normals.Bind(kNormalArray);
    _cornerSides.Bind(kCornerSideArray);
    _coords.Bind(kCoordArray);
    _faces.Bind(kFaceArray);
}

void ViewedSurface::BindEdges() const { _edgeSides.Bind(kCornerSideArray); }

} // namespace OpenSubdivHex::Tools

// SPDX-License-Identifier: Apache-2.0
//
// Tutorial description:
//
//     A renderer with hexagonal subdivision surfaces, on Embree's ray tracing kernels.
//
//     The constructor of Panel has what a renderer does at load time: the refiner, the limit
//     stencil table, the buffers and the triangle indices, all made once.  Panel::Update has the work
//     of each frame: it evaluates the table for the frame's control positions and hands the
//     refined triangles to the ray tracer.  With --adaptive there is no table: for each frame the mesh
//     is refined as far as its camera needs (cellSurface.h).  The rest of this file is about options;
//     the pictures themselves are made in tools/render (scene.h, renderer.h).
//
#include "cellSurface.h"
#include "far_ext/stencilTableFactory.h"
#include "far_ext/topologyRefinerFactory.h"
#include "tools/mesh/boundaryRule.h"
#include "tools/mesh/fileError.h"
#include "tools/mesh/meshReader.h"
#include "tools/mesh/meshText.h"
#include "tools/mesh/program.h"
#include "tools/mesh/ruleNames.h"
#include "tools/mesh/topologyDescriptor.h"
#include "tools/render/pngFile.h"
#include "tools/render/renderer.h"
#include "tools/render/unitSize.h"
#include "tools/render/viewOption.h"

#include <opensubdiv/osd/cpuEvaluator.h>
#include <opensubdiv/osd/cpuVertexBuffer.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <new>

namespace OpenSubdivHex::Tools {

namespace {

namespace Osd = OpenSubdiv::Osd;

constexpr char kName[] = "osd_ext_2_1_render";

// Settings that may differ from one panel of a picture to the next.
struct PanelSettings {
    int level = 4;
    bool isAdaptive = false;
    double pixelError = 0.5;
    FarExt::FaceMask mask = FarExt::FaceMask::Smooth;
    FarExt::FirstStep firstStep = FarExt::FirstStep::Same;
    Sdc::Options::VtxBoundaryInterpolation boundary = Sdc::Options::VTX_BOUNDARY_NONE;
    bool hasWireframe = false;
    bool isTinted = false;
    bool hasRegions = false;
    bool isFlat = false;
    bool isZebra = false;
    bool hasCage = false;
    bool hidesSurface = false;
};

struct Arguments {
    std::string input;
    std::string output;
    PanelSettings settings;
    std::vector<std::string> panelTexts;
    std::vector<PanelSettings> panels;
    int numColumns = 0; // 0: all panels in one row
    std::string size = "1000x750";
    int width = 0;
    int height = 0;
    int numSamples = 16;
    float lineWidth = RenderOptions().lineWidth;
    View view;
    bool hasNoGround = false;
    int numFrames = 0;
    std::string animation = "turntable";

    int GetNumPanels() const { return int(panels.size()); }
    int GetNumColumns() const {
        return numColumns > 0 ? std::min(numColumns, GetNumPanels()) : GetNumPanels();
    }
    int GetNumRows() const { return (GetNumPanels() + GetNumColumns() - 1) / GetNumColumns(); }
};

void addPanelOptions(CLI::App &app, PanelSettings *settings) {
    app.add_option("-l,--level", settings->level, "Number of refinement steps")
        ->check(CLI::Range(0, std::numeric_limits<int>::max()))
        ->capture_default_str();
    app.add_flag("--adaptive", settings->isAdaptive,
                 "Refine parts of the mesh as far as the camera needs them, in place of --level");
    app.add_option("--pixel-error", settings->pixelError,
                   "How many pixels the polygons of --adaptive may be away from the surface")
        ->check(MakeRange(0.001, 1000))
        ->capture_default_str();
    app.add_option("--mask", settings->mask, "Mask of the face points: average, cosine or smooth")
        ->transform(CLI::Transformer(Tools::MapRules<FarExt::FaceMask>(Tools::kMaskNames)))
        ->type_name("NAME")
        ->default_str("smooth");
    app.add_option("--first-step", settings->firstStep,
                   "How level 1 is made: none (as the others), tri-hex or truncate")
        ->transform(CLI::Transformer(Tools::MapRules<FarExt::FirstStep>(Tools::kFirstStepNames)))
        ->type_name("NAME")
        ->default_str("none");
    app.add_option("--boundary", settings->boundary,
                   "Rule for boundaries: none, edge-only or edge-and-corner")
        ->transform(CLI::Transformer(
            Tools::MapRules<Sdc::Options::VtxBoundaryInterpolation>(Tools::kBoundaryNames)))
        ->type_name("NAME")
        ->default_str("none");
    app.add_flag("--wireframe", settings->hasWireframe, "Draw the edges of the refined polygons");
    app.add_flag("--tint", settings->isTinted,
                 "Draw polygons that are no hexagons in a colour of their own");
    app.add_flag("--regions", settings->hasRegions,
                 "Draw what is refined of each face of the control mesh in a colour of its own");
    CLI::Option *const flat =
        app.add_flag("--flat", settings->isFlat, "Light each polygon by one normal");
    app.add_flag("--zebra", settings->isZebra, "Draw reflection lines, which show smoothness")
        ->excludes(flat);
    app.add_flag("--cage", settings->hasCage, "Draw the edges of the control mesh as rods");
    app.add_flag("--hide-surface", settings->hidesSurface, "Do not draw the surface");
}

void addOptions(CLI::App &app, Arguments *arguments) {
    app.add_option("INPUT", arguments->input, "Control mesh: .obj, .off or .ply")
        ->type_name("FILE")
        ->required();
    app.add_option("-o,--output", arguments->output,
                   "Picture to write; with --frames, OUT.png makes OUT_0001.png and so on")
        ->check(MakePngFile())
        ->type_name("FILE")
        ->required();
    addPanelOptions(app, &arguments->settings);
    app.add_option("--panel", arguments->panelTexts,
                   "Panel of the picture; repeat it for more, side by side.  SETTINGS are "
                   "those of the options from --level to --hide-surface that differ, as in "
                   "level=2,wireframe,mask=cosine")
        ->type_name("SETTINGS")
        ->allow_extra_args(false);
    app.add_option("--columns", arguments->numColumns, "Panels in a row (default: all)")
        ->check(CLI::Range(1, std::numeric_limits<int>::max()));
    app.add_option("--size", arguments->size, "Size of the picture in pixels")
        ->check([arguments](std::string const &text) {
            std::size_t const cross = text.find('x');
            constexpr int kMaxSize = 20000;
            bool const isSize = cross != std::string::npos &&
                                ParseInt(text.substr(0, cross), &arguments->width) &&
                                ParseInt(text.substr(cross + 1), &arguments->height) &&
                                std::min(arguments->width, arguments->height) > 0 &&
                                std::max(arguments->width, arguments->height) <= kMaxSize;
            return isSize ? std::string() : "'" + text + "' is not WIDTHxHEIGHT";
        })
        ->type_name("WxH")
        ->force_callback()
        ->capture_default_str();
    app.add_option("--samples", arguments->numSamples, "Samples per pixel")
        ->check(CLI::Range(1, 4096))
        ->capture_default_str();
    app.add_option("--line-width", arguments->lineWidth, "Width of the wireframe in pixels")
        ->check(MakePositive())
        ->capture_default_str();
    AddViewOption(app, &arguments->view);
    app.add_flag("--no-ground", arguments->hasNoGround, "No ground for shadows to fall on");
    app.add_option("--frames", arguments->numFrames, "Number of pictures of an animation")
        ->check(CLI::Range(1, 9999));
    app.add_option("--animate", arguments->animation,
                   "What moves: the camera around the mesh, or the control mesh")
        ->check(CLI::IsMember({"turntable", "twist"}))
        ->capture_default_str();
    app.footer("Exit status: 0 success, 1 bad input or failed output, 2 bad usage.");
}

// Checks options that depend on each other; throws CLI::ValidationError.
void checkArguments(Arguments const &arguments) {
    if (arguments.width < arguments.GetNumColumns() || arguments.height < arguments.GetNumRows()) {
        throw CLI::ValidationError("--size", arguments.size + " is too small for the panels");
    }
}

// The settings of a panel: those of the whole picture and what \p text says.
PanelSettings parsePanel(std::string const &text, PanelSettings settings) {
    CLI::App app("", "--panel " + text);
    app.set_help_flag();
    addPanelOptions(app, &settings);
    std::vector<std::string> options; // CLI11 takes them from the back
    for (std::string const &setting : CLI::detail::split(text, ',')) {
        options.insert(options.begin(), "--" + setting);
    }
    app.parse(options);
    return settings;
}

struct Bounds {
    Vec3 low;
    Vec3 high;
};

// Least and largest coordinates.
Bounds findBounds(std::vector<float> const &points) {
    Vec3 low = GetVec3(points.data(), 0);
    Vec3 high = low;
    for (int i = 1; i < int(points.size() / 3); ++i) {
        Vec3 const point = GetVec3(points.data(), i);
        low = {std::min(low.x, point.x), std::min(low.y, point.y), std::min(low.z, point.z)};
        high = {std::max(high.x, point.x), std::max(high.y, point.y), std::max(high.z, point.z)};
    }
    return {low, high};
}

// The control positions at a time between 0 and 1, when they are as at 0 again: twisted and bent,
// the more so the higher a vertex lies in the bounds of what is shown.
std::vector<float> twist(std::vector<float> const &positions, Bounds const &bounds, float time) {
    auto const &[low, high] = bounds;
    float const height = std::max(high.y - low.y, 1e-20f);
    float const wave = std::sin(6.2831853f * time);
    std::vector<float> twisted;
    for (int i = 0; i < int(positions.size() / 3); ++i) {
        Vec3 const point = GetVec3(positions.data(), i);
        float const part = (point.y - low.y) / height;
        Vec3 const turned = RotateAroundVertical(point, 70 * wave * part, 0.5f * (low + high));
        twisted.insert(twisted.end(),
                       {turned.x + 0.25f * height * wave * part * part, turned.y, turned.z});
    }
    return twisted;
}

double getMilliseconds(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
        .count();
}

// The control mesh, refined and looked at in one way.
class Panel {
public:
    // Throws FileError.
    Panel(Mesh const &mesh, Bounds const &bounds, PanelSettings const &settings,
          std::string const &input)
        : _settings(settings), _rodRadius(0.005f * Length(bounds.high - bounds.low)) {
        auto const start = std::chrono::steady_clock::now();
        Sdc::Options sdcOptions;
        sdcOptions.SetVtxBoundaryInterpolation(settings.boundary);
        FarExt::TopologyRefinerFactory::Options refinerOptions;
        refinerOptions.hexSchemeOptions.faceMask = settings.mask;
        refinerOptions.hexSchemeOptions.firstStep = settings.firstStep;
        FarExt::CallStatus status;
        _refiner = FarExt::TopologyRefinerFactory::Create(DescribeTopology(mesh), sdcOptions,
                                                          refinerOptions, &status);
        if (!_refiner) {
            throw FileError(input, status.GetErrorMessage());
        }
        if (settings.isAdaptive) {
            // Surfaces begin with the faces of level 0 or, behind a first step, of level 1.
            FarExt::TopologyRefiner::UniformOptions refineOptions(
                refinerOptions.hexSchemeOptions.GetSurfaceLevel());
            refineOptions.fullTopologyInLastLevel = true;
            if (!_refiner->RefineUniform(refineOptions, &status)) {
                throw FileError(input, status.GetErrorMessage());
            }
            try {
                _cells = std::make_unique<CellSurface>(*_refiner);
            } catch (std::runtime_error const &error) {
                RequireBoundaryRule(*_refiner, input);
                throw FileError(input, error.what());
            }
            std::printf("adaptive: prepared in %.0f ms\n", getMilliseconds(start));
        } else {
            refine(mesh, input);
            std::printf("level %d: %d vertices, %d triangles, made in %.0f ms\n", settings.level,
                        _refiner->GetLevel(settings.level).GetNumVertices(),
                        _surface->GetTriangles().GetNumTriangles(), getMilliseconds(start));
        }
    }

    // Whether frames differ where the control positions do not.
    bool DependsOnCamera() const { return _cells != nullptr; }

    // Makes the scene of a frame from its control positions, for a picture of a camera.
    void Update(std::vector<float> const &positions, Camera const &camera, int height) {
        if (_cells) {
            _cells->Update(positions, camera, height, _settings.pixelError);
            std::printf("adaptive: %d polygons\n", int(_cells->GetBaseFaces().size()));
        } else if (_table) {
            _controlBuffer->UpdateData(positions.data(), 0, _controlBuffer->GetNumVertices());
            Osd::BufferDescriptor const desc(0, 3, 3);
            Osd::CpuEvaluator::EvalStencils(_controlBuffer.get(), desc, _pointBuffer.get(), desc,
                                            _duBuffer.get(), desc, _dvBuffer.get(), desc,
                                            _table.get());
            _surface->SetPositions(_pointBuffer->BindCpuBuffer(), _duBuffer->BindCpuBuffer(),
                                   _dvBuffer->BindCpuBuffer());
        } else {
            _surface->SetPositions(positions.data());
        }
        Surface const *const surface = _cells ? _cells->GetSurface() : _surface.get();
        _scene.Build(_settings.hidesSurface ? nullptr : surface,
                     _settings.hasCage ? findRods(positions) : std::vector<float>(), _rodRadius);
    }

    Image Draw(Camera const &camera, RenderOptions options, int width, int height) const {
        options.hasWireframe = _settings.hasWireframe;
        options.isTinted = _settings.isTinted;
        options.hasRegions = _settings.hasRegions;
        if (_cells) {
            options.regions = _cells->GetBaseFaces();
        }
        options.look = _settings.isZebra  ? SurfaceLook::Zebra
                       : _settings.isFlat ? SurfaceLook::Flat
                                          : SurfaceLook::Smooth;
        return Render(_scene, camera, options, width, height);
    }

private:
    // Refines to the level of the settings, with a table of its limit points.
    void refine(Mesh const &mesh, std::string const &input) {
        FarExt::CallStatus status;
        FarExt::TopologyRefiner::UniformOptions refineOptions(_settings.level);
        refineOptions.fullTopologyInLastLevel = true;
        if (!_refiner->RefineUniform(refineOptions, &status)) {
            throw FileError(input, status.GetErrorMessage());
        }
        _surface =
            std::make_unique<Surface>(_refiner->GetLevel(_settings.level), _settings.hasRegions);
        if (_settings.level == 0) {
            return;
        }
        // Points of the limit surface, with a normal for each side of a crease.
        FarExt::LimitStencilTableFactory::Options tableOptions;
        tableOptions.level = _settings.level;
        tableOptions.generateFurtherSides = true;
        _table = FarExt::LimitStencilTableFactory::Create(*_refiner, tableOptions, &status);
        if (!_table) {
            throw FileError(input, status.GetErrorMessage());
        }
        _controlBuffer.reset(Osd::CpuVertexBuffer::Create(3, mesh.GetNumVertices()));
        for (auto *buffer : {&_pointBuffer, &_duBuffer, &_dvBuffer}) {
            buffer->reset(Osd::CpuVertexBuffer::Create(3, _table->GetNumStencils()));
        }
    }

    // Both ends of each edge of the control mesh.
    std::vector<float> findRods(std::vector<float> const &positions) const {
        FarExt::TopologyLevel const &base = _refiner->GetLevel(0);
        std::vector<float> ends;
        for (int edge = 0; edge < base.GetNumEdges(); ++edge) {
            for (int vertex : base.GetEdgeVertices(edge)) {
                auto const position = positions.begin() + 3 * std::ptrdiff_t(vertex);
                ends.insert(ends.end(), position, position + 3);
            }
        }
        return ends;
    }

    PanelSettings const _settings;
    float const _rodRadius;
    std::unique_ptr<FarExt::TopologyRefiner> _refiner;
    std::unique_ptr<Far::LimitStencilTable const> _table; // null for level 0
    std::unique_ptr<Osd::CpuVertexBuffer> _controlBuffer;
    std::unique_ptr<Osd::CpuVertexBuffer> _pointBuffer;
    std::unique_ptr<Osd::CpuVertexBuffer> _duBuffer;
    std::unique_ptr<Osd::CpuVertexBuffer> _dvBuffer;
    std::unique_ptr<Surface> _surface;
    std::unique_ptr<CellSurface> _cells; // in place of the surface, with --adaptive
    Scene _scene;
};

// OUT.png, or OUT_0001.png for the first of several frames.
std::string findFramePath(Arguments const &arguments, int frame) {
    if (arguments.numFrames == 0) {
        return arguments.output;
    }
    char number[16];
    std::snprintf(number, sizeof number, "_%04d", frame + 1);
    std::filesystem::path const path(arguments.output);
    std::filesystem::path result = path;
    return result.replace_filename(path.stem().string() + number + ".png").string();
}

void run(Arguments const &arguments) {
    Mesh mesh = ReadInput(kName, arguments.input);
    std::vector<int> const shown = FindShownVertices(mesh);
    ScaleToUnitSize(shown, &mesh.positions);
    Bounds const bounds = findBounds(GatherPositions(shown, mesh.positions));
    std::vector<std::unique_ptr<Panel>> panels;
    for (PanelSettings const &settings : arguments.panels) {
        panels.push_back(std::make_unique<Panel>(mesh, bounds, settings, arguments.input));
    }

    int const numFrames = std::max(arguments.numFrames, 1);
    bool const isTurntable = arguments.animation == "turntable";
    auto const getTime = [&](int frame) { return float(frame) / float(numFrames); };
    auto const getPositions = [&](int frame) {
        return isTurntable || frame == 0 ? mesh.positions
                                         : twist(mesh.positions, bounds, getTime(frame));
    };
    Vec3 const center = 0.5f * (bounds.low + bounds.high);

    // One camera that sees what is shown of the control mesh whole in every frame.
    std::vector<float> points;
    for (int frame = 0; frame < numFrames; ++frame) {
        std::vector<float> const positions = getPositions(frame);
        float const degrees = isTurntable ? -360 * getTime(frame) : 0;
        for (int const i : shown) {
            Vec3 const point = RotateAroundVertical(GetVec3(positions.data(), i), degrees, center);
            points.insert(points.end(), {point.x, point.y, point.z});
        }
    }
    int const numColumns = arguments.GetNumColumns();
    int const numRows = arguments.GetNumRows();
    Camera const firstCamera(arguments.view, points,
                             float(arguments.width) * float(numRows) /
                                 (float(arguments.height) * float(numColumns)));

    RenderOptions options;
    options.numSamples = arguments.numSamples;
    options.lineWidth = arguments.lineWidth;
    options.hasGround = !arguments.hasNoGround;
    for (int frame = 0; frame < numFrames; ++frame) {
        Camera camera = firstCamera;
        if (isTurntable) {
            camera.Orbit(360 * getTime(frame), center);
        }
        double updateTime = 0;
        double renderTime = 0;
        Image picture(arguments.width, arguments.height);
        for (int i = 0; i < arguments.GetNumPanels(); ++i) {
            // Panels differ by a pixel where they do not divide the picture evenly.
            int const column = i % numColumns;
            int const row = i / numColumns;
            int const left = column * arguments.width / numColumns;
            int const top = row * arguments.height / numRows;
            int const right = (column + 1) * arguments.width / numColumns;
            int const bottom = (row + 1) * arguments.height / numRows;
            auto start = std::chrono::steady_clock::now();
            if (frame == 0 || !isTurntable || panels[i]->DependsOnCamera()) {
                panels[i]->Update(getPositions(frame), camera, bottom - top);
                updateTime += getMilliseconds(start);
            }
            start = std::chrono::steady_clock::now();
            PasteImage(panels[i]->Draw(camera, options, right - left, bottom - top), left, top,
                       &picture);
            renderTime += getMilliseconds(start);
        }
        std::string const path = findFramePath(arguments, frame);
        WritePng(picture, path);
        std::printf("wrote %s: evaluated in %.0f ms, rendered in %.0f ms\n",
                    EscapeControls(path).c_str(), updateTime, renderTime);
    }
}

} // namespace

} // namespace OpenSubdivHex::Tools

int main(int argc, char **argv) {
    using namespace OpenSubdivHex::Tools;

    Arguments arguments;
    CLI::App app("Renders a polygon mesh, refined with the hexagonal subdivision scheme.", kName);
    addOptions(app, &arguments);
    return RunProgram(app, argc, argv, [&] {
        for (std::string const &text : arguments.panelTexts) {
            arguments.panels.push_back(parsePanel(text, arguments.settings));
        }
        if (arguments.panels.empty()) {
            arguments.panels.push_back(arguments.settings);
        }
        checkArguments(arguments);
        try {
            run(arguments);
        } catch (std::bad_alloc const &) {
            throw FileError(arguments.input, "not enough memory");
        }
    });
}

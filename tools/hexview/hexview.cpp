// SPDX-License-Identifier: Apache-2.0
//
// hexview: shows a mesh and its refined levels in a window, or draws a picture of them.
#include "offscreen.h"
#include "surfacePainter.h"
#include "viewedSurface.h"
#include "window.h"

#include "far_ext/version.h"
#include "tools/hexrefine/ruleNames.h"
#include "tools/mesh/fileError.h"
#include "tools/mesh/meshReader.h"
#include "tools/mesh/program.h"
#include "tools/render/pngFile.h"

namespace OpenSubdivHex::Tools {

namespace {

std::vector<std::string> const kSchemeNames = {"hexagonal", "doo-sabin", "tri-hex"};
std::vector<std::string> const kFirstStepNames = {"none", "tri-hex", "truncate"};
std::vector<std::string> const kMaskNames = {"average", "cosine", "smooth"};
std::vector<std::string> const kEvaluatorNames = {"cpu", "opengl", "tables"};
std::vector<std::string> const kShadingNames = {"smooth",    "facets",     "reflection",
                                                "curvature", "base-faces", "checker"};

struct Arguments {
    std::string input;
    int level = 2;
    std::string scheme = "hexagonal";
    std::string firstStep = "none";
    std::string mask = "smooth";
    std::optional<std::string> boundary;
    bool isLimit = false;
    std::optional<double> creaseAngle;
    std::string evaluator = "cpu";
    std::string shading = "smooth";
    bool hasNoEdges = false;
    bool hasControlMesh = false;
    float azimuth = OrbitCamera().azimuth;
    float elevation = OrbitCamera().elevation;
    int width = 1200;
    int height = 900;
    std::string png;
};

void addOptions(CLI::App &app, Arguments *arguments) {
    constexpr int kMaxLevel = 10;
    constexpr int kMaxPixels = 8192;
    app.add_option("INPUT", arguments->input, "Mesh to show: .obj, .off or .ply")
        ->type_name("FILE")
        ->required();
    app.add_option("-l,--level", arguments->level, "Number of refinement steps")
        ->check(CLI::Range(0, kMaxLevel))
        ->capture_default_str();
    app.add_option("--scheme", arguments->scheme, "Subdivision scheme")
        ->check(CLI::IsMember(kSchemeNames))
        ->capture_default_str();
    app.add_option("--first-step", arguments->firstStep,
                   "What makes level 1 in place of the scheme: truncate is for meshes of triangles")
        ->check(CLI::IsMember(kFirstStepNames))
        ->capture_default_str();
    app.add_option("--mask", arguments->mask, "Mask of the face points")
        ->check(CLI::IsMember(kMaskNames))
        ->capture_default_str();
    app.add_option("--boundary", arguments->boundary,
                   "Rule for boundaries, before that of the file")
        ->check(CLI::IsMember(kBoundaryNames))
        ->default_str("the file's, or edge-and-corner");
    app.add_flag("--limit", arguments->isLimit, "Push the vertices to the limit surface");
    app.add_option("--crease-angle", arguments->creaseAngle,
                   "Makes creases of the edges between faces whose normals differ by more than so "
                   "many degrees")
        ->check(CLI::Range(0.0, 180.0))
        ->type_name("DEG");
    app.add_option("--evaluator", arguments->evaluator,
                   "Who makes the vertices: the CPU level by level, OpenGL level by level, or "
                   "OpenSubdiv's evaluator of OpenGL from a stencil table")
        ->check(CLI::IsMember(kEvaluatorNames))
        ->capture_default_str();
    app.add_option("--shading", arguments->shading, "What the faces show")
        ->check(CLI::IsMember(kShadingNames))
        ->capture_default_str();
    app.add_flag("--no-edges", arguments->hasNoEdges, "Draws no edges of faces");
    app.add_flag("--control-mesh", arguments->hasControlMesh, "Draws the control mesh");
    app.add_option("--azimuth", arguments->azimuth, "Where the eye is, around the vertical axis")
        ->check(CLI::Range(-360.0f, 360.0f))
        ->type_name("DEG")
        ->capture_default_str();
    app.add_option("--elevation", arguments->elevation, "Where the eye is, above the horizon")
        ->check(CLI::Range(-89.0f, 89.0f))
        ->type_name("DEG")
        ->capture_default_str();
    app.add_option("--width", arguments->width, "Pixels of the window or the picture")
        ->check(CLI::Range(1, kMaxPixels))
        ->capture_default_str();
    app.add_option("--height", arguments->height, "Pixels of the window or the picture")
        ->check(CLI::Range(1, kMaxPixels))
        ->capture_default_str();
    app.add_option("--png", arguments->png, "File for a picture, without a window")
        ->type_name("FILE");
    app.set_version_flag("--version", "hexview " OPENSUBDIVHEX_VERSION);
    app.footer(
        "In the window: drag to turn, the wheel to come nearer, drag vertices of the control "
        "mesh.\nKeys: 0 to 7 level, Tab shading, E edges, C control mesh, A animation, Esc "
        "end.\nExit status: 0 success, 1 bad input or failed output, 2 bad usage.");
}

SurfaceSettings findSettings(Arguments const &arguments, MeshTags const &tags) {
    SurfaceSettings settings;
    settings.level = arguments.level;
    settings.scheme.schemeType = FindRule<FarExt::SchemeType>(kSchemeNames, arguments.scheme);
    settings.scheme.firstStep = FindRule<FarExt::FirstStep>(kFirstStepNames, arguments.firstStep);
    settings.scheme.faceMask = FindRule<FarExt::FaceMask>(kMaskNames, arguments.mask);
    settings.boundary = tags.boundary.value_or(settings.boundary);
    if (arguments.boundary) {
        settings.boundary =
            FindRule<decltype(settings.boundary)>(kBoundaryNames, *arguments.boundary);
    }
    settings.isLimit = arguments.isLimit;
    settings.creaseAngle = arguments.creaseAngle;
    settings.evaluator = FindRule<ViewEvaluator>(kEvaluatorNames, arguments.evaluator);
    return settings;
}

void run(Arguments const &arguments) {
    Mesh const mesh = ReadMesh(arguments.input);
    SurfaceSettings const settings = findSettings(arguments, mesh.tags);
    DrawSettings drawSettings;
    drawSettings.shading = FindRule<Shading>(kShadingNames, arguments.shading);
    drawSettings.hasEdges = !arguments.hasNoEdges;
    drawSettings.hasControlMesh = arguments.hasControlMesh;
    OrbitCamera camera = OrbitCamera::Around(mesh.positions);
    camera.azimuth = arguments.azimuth;
    camera.elevation = arguments.elevation;
    if (arguments.png.empty()) {
        ShowWindow(mesh, arguments.input, settings, drawSettings, camera, arguments.width,
                   arguments.height);
        return;
    }
    Offscreen const offscreen(arguments.width, arguments.height);
    ViewedSurface surface(mesh);
    try {
        surface.Refine(settings);
    } catch (std::runtime_error const &error) {
        throw FileError(arguments.input, error.what());
    }
    SurfacePainter painter;
    painter.Draw(surface, camera, drawSettings, arguments.width, arguments.height);
    WritePng(offscreen.Read(), arguments.png);
}

} // namespace

} // namespace OpenSubdivHex::Tools

int main(int argc, char const *const *argv) {
    using namespace OpenSubdivHex::Tools;
    CLI::App app("Shows a mesh refined with the hexagonal scheme", "hexview");
    Arguments arguments;
    addOptions(app, &arguments);
    return RunProgram(app, argc, argv, [&] { run(arguments); });
}

// SPDX-License-Identifier: Apache-2.0
//
// hexview: shows a mesh and its refined levels in a window, or draws a picture of them.
#include "animation.h"
#include "surfacePainter.h"
#include "viewedSurface.h"
#include "window.h"

#include "far_ext/version.h"
#include "tools/gl/offscreen.h"
#include "tools/mesh/fileError.h"
#include "tools/mesh/meshReader.h"
#include "tools/mesh/program.h"
#include "tools/mesh/ruleNames.h"
#include "tools/render/pngFile.h"
#include "tools/render/unitSize.h"

namespace OpenSubdivHex::Tools {

namespace {

constexpr char kName[] = "hexview";

std::vector<std::string> const kEvaluatorNames = {"cpu", "opengl", "tables"};
std::vector<std::string> const kShadingNames = {"smooth",     "facets",  "reflection", "curvature",
                                                "base-faces", "checker", "levels"};

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
    bool isAdaptive = false;
    CellSettings cells;
    bool arePatches = false;
    PatchSettings patches;
    std::string shading = "smooth";
    bool hasNoEdges = false;
    bool hasControlMesh = false;
    float azimuth = OrbitCamera().azimuth;
    float elevation = OrbitCamera().elevation;
    float distance = OrbitCamera().distance;
    int width = 1200;
    int height = 900;
    std::string png;
    int numFrames = 0;
};

void addOptions(CLI::App &app, Arguments *arguments) {
    constexpr int kMaxLevel = 10;
    constexpr int kMaxPixels = 8192;
    constexpr int kMaxFrames = 64;
    constexpr int kMaxRate = 32; // OpenGL has 64, of sides that are cut in two
    app.add_option("INPUT", arguments->input, "Mesh to show: .obj, .off or .ply")
        ->type_name("FILE")
        ->required();
    auto *const level = app.add_option("-l,--level", arguments->level, "Number of refinement steps")
                            ->check(CLI::Range(0, kMaxLevel))
                            ->capture_default_str();
    app.add_option("--scheme", arguments->scheme, "Subdivision scheme")
        ->check(CLI::IsMember(kSchemeNames))
        ->capture_default_str();
    app.add_option("--first-step", arguments->firstStep,
                   "What makes level 1 in place of the scheme: truncate is for meshes of triangles")
        ->check(CLI::IsMember(kFirstStepNames))
        ->capture_default_str();
    app.add_option("--mask", arguments->mask,
                   "Mask of the face points: smooth by default, since hexview is for pictures; "
                   "hexrefine and the libraries begin with the paper's average")
        ->check(CLI::IsMember(kMaskNames))
        ->capture_default_str();
    app.add_option(
           "--boundary", arguments->boundary,
           "Rule for boundaries, before that of the file; hexrefine and the libraries begin "
           "with the paper's none")
        ->check(CLI::IsMember(kBoundaryNames))
        ->default_str("the file's, or edge-and-corner");
    auto *const limit =
        app.add_flag("--limit", arguments->isLimit, "Push the vertices to the limit surface");
    app.add_option("--crease-angle", arguments->creaseAngle,
                   "Makes creases of the edges between faces whose normals differ by more than so "
                   "many degrees")
        ->check(MakeRange(0, 180))
        ->type_name("DEG");
    auto *const evaluator =
        app.add_option("--evaluator", arguments->evaluator,
                       "Who makes the vertices: the CPU level by level, OpenGL level by level, or "
                       "OpenSubdiv's evaluator of OpenGL from a stencil table")
            ->check(CLI::IsMember(kEvaluatorNames))
            ->capture_default_str();
    auto *const adaptive = app.add_flag("--adaptive", arguments->isAdaptive,
                                        "Refine parts of the mesh as far as the view needs them, "
                                        "with vertices on the limit surface and without gaps")
                               ->excludes(level)
                               ->excludes(limit)
                               ->excludes(evaluator);
    auto *const patches =
        app.add_flag("--patches", arguments->arePatches,
                     "Draw the patches of the level, by OpenSubdiv's shaders: the limit surface, "
                     "tessellated by OpenGL")
            ->excludes(limit)
            ->excludes(evaluator)
            ->excludes(adaptive);
    auto *const rate = app.add_option("--rate", arguments->patches.rate,
                                      "Segments of each side of a patch; sides at faces that are "
                                      "neither quads nor hexagons have half as many")
                           ->check(MakeRange(1, kMaxRate))
                           ->needs(patches)
                           ->capture_default_str();
    app.add_option("--edge-pixels", arguments->patches.edgePixels,
                   "In place of a rate, as many segments as are so many pixels long")
        ->check(MakeRange(1, 1000))
        ->type_name("PIXELS")
        ->needs(patches)
        ->excludes(rate)
        ->each([arguments](std::string const &) { arguments->patches.isByPixels = true; });
    app.add_option("--pixel-error", arguments->cells.pixelError,
                   "How many pixels faces may be away from the limit surface")
        ->check(MakeRange(1e-3, 1e3))
        ->type_name("PIXELS")
        ->needs(adaptive)
        ->capture_default_str();
    app.add_option("--max-level", arguments->cells.maxLevel, "The last level that --adaptive makes")
        ->check(CLI::Range(0, BfrExt::CellTree::kLastLevel))
        ->needs(adaptive)
        ->capture_default_str();
    app.add_flag("--cull", arguments->cells.isCulling,
                 "Leave coarse what is outside of the picture or faces away")
        ->needs(adaptive);
    app.add_option("--shading", arguments->shading, "What the faces show")
        ->check(CLI::IsMember(kShadingNames))
        ->capture_default_str();
    app.add_flag("--no-edges", arguments->hasNoEdges, "Draws no edges of faces");
    app.add_flag("--control-mesh", arguments->hasControlMesh, "Draws the control mesh");
    app.add_option("--azimuth", arguments->azimuth, "Where the eye is, around the vertical axis")
        ->check(MakeRange(-360, 360))
        ->type_name("DEG")
        ->capture_default_str();
    app.add_option("--elevation", arguments->elevation, "Where the eye is, above the horizon")
        ->check(MakeRange(-89, 89))
        ->type_name("DEG")
        ->capture_default_str();
    app.add_option("--distance", arguments->distance,
                   "How far the eye is: from 1 it sees all, however the mesh turns")
        ->check(MakeRange(0.05, 20))
        ->capture_default_str();
    app.add_option("--width", arguments->width, "Pixels of the window or the picture")
        ->check(CLI::Range(1, kMaxPixels))
        ->capture_default_str();
    app.add_option("--height", arguments->height, "Pixels of the window or the picture")
        ->check(CLI::Range(1, kMaxPixels))
        ->capture_default_str();
    auto *const png =
        app.add_option("--png", arguments->png, "File for a picture, without a window")
            ->check(MakePngFile())
            ->type_name("FILE");
    app.add_option("--frames", arguments->numFrames,
                   "Draws so many pictures beside each other, from one end of the animation, which "
                   "twists the control mesh, to the other")
        ->check(CLI::Range(1, kMaxFrames))
        ->needs(png);
    app.callback([arguments] {
        // Three bytes a pixel, and as many again for the file.
        constexpr std::int64_t kMaxBytes = std::int64_t(1) << 30;
        std::int64_t const numBytes =
            std::int64_t(3) * arguments->width * arguments->height * arguments->numFrames;
        if (numBytes > kMaxBytes) {
            throw CLI::ValidationError("--frames",
                                       std::to_string(arguments->numFrames) + " pictures of " +
                                           std::to_string(arguments->width) + " by " +
                                           std::to_string(arguments->height) + " pixels take " +
                                           std::to_string(numBytes >> 20) + " MiB, and " +
                                           std::to_string(kMaxBytes >> 20) + " MiB is the most");
        }
    });
    app.set_version_flag("--version", "hexview " OPENSUBDIVHEX_VERSION);
    app.footer(
        "In the window: drag to turn, the wheel to come nearer, drag vertices of the control "
        "mesh.\nKeys: 0 to 7 level, P patches, V adaptive, F freeze its cells, Tab shading, E "
        "edges, C "
        "control "
        "mesh,\nA animation, Esc end.\nExit status: 0 success, 1 bad input or failed output, 2 bad "
        "usage.");
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
    settings.isAdaptive = arguments.isAdaptive;
    settings.cells = arguments.cells;
    settings.arePatches = arguments.arePatches;
    return settings;
}

// The twist of each picture: none of a single one, else from one end of the animation to the other.
std::vector<float> findTwists(int numFrames) {
    std::vector<float> twists = {0};
    if (numFrames > 0) {
        twists.resize(std::size_t(numFrames));
    }
    float const halfTurn = std::acos(-1.0f);
    for (int i = 0; i < numFrames && numFrames > 1; ++i) {
        twists[std::size_t(i)] = std::sin(halfTurn * (float(i) / float(numFrames - 1) - 0.5f));
    }
    return twists;
}

void run(Arguments const &arguments) {
    Mesh mesh = ReadInput(kName, arguments.input);
    std::vector<int> const shown = FindShownVertices(mesh);
    ScaleToUnitSize(shown, &mesh.positions);
    SurfaceSettings const settings = findSettings(arguments, mesh.tags);
    DrawSettings drawSettings;
    drawSettings.shading = FindRule<Shading>(kShadingNames, arguments.shading);
    drawSettings.hasEdges = !arguments.hasNoEdges;
    drawSettings.hasControlMesh = arguments.hasControlMesh;
    drawSettings.patches = arguments.patches;
    OrbitCamera camera = OrbitCamera::Around(GatherPositions(shown, mesh.positions));
    camera.azimuth = arguments.azimuth;
    camera.elevation = arguments.elevation;
    camera.distance = arguments.distance;
    if (arguments.png.empty()) {
        ShowWindow(mesh, arguments.input, settings, drawSettings, camera, arguments.width,
                   arguments.height);
        return;
    }
    Offscreen const offscreen(arguments.width, arguments.height);
    ViewedSurface surface(mesh);
    SurfacePainter painter;
    std::vector<float> const twists = findTwists(arguments.numFrames);
    Image image(int(twists.size()) * arguments.width, arguments.height);
    try {
        surface.Refine(settings);
        for (std::size_t i = 0; i < twists.size(); ++i) {
            if (twists.size() > 1) {
                surface.GetControlPoints() = TwistPoints(mesh.positions, camera, twists[i]);
                surface.Evaluate();
            }
            surface.Follow(camera.ForPicture(arguments.width, arguments.height), settings.cells);
            painter.Draw(surface, camera, drawSettings, arguments.width, arguments.height);
            PasteImage(offscreen.Read(), int(i) * arguments.width, 0, &image);
        }
    } catch (std::runtime_error const &error) {
        throw FileError(arguments.input, error.what());
    }
    WritePng(image, arguments.png);
}

} // namespace

} // namespace OpenSubdivHex::Tools

int main(int argc, char const *const *argv) {
    using namespace OpenSubdivHex::Tools;
    CLI::App app("Shows a mesh refined with the hexagonal scheme", kName);
    Arguments arguments;
    addOptions(app, &arguments);
    return RunProgram(app, argc, argv, [&] { run(arguments); });
}

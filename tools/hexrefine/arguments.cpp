// SPDX-License-Identifier: Apache-2.0
#include "arguments.h"

#include "picture.h"
#include "pictureColors.h"

#include "far_ext/version.h"
#include "osd_ext/simdLevel.h"
#include "tools/mesh/meshText.h"
#include "tools/mesh/meshWriter.h"
#include "tools/mesh/outputFile.h"
#include "tools/mesh/program.h"
#include "tools/mesh/ruleNames.h"

#include <cstdlib>

namespace OpenSubdivHex::Tools {

namespace {

std::string checkAngle(std::string const &word) {
    float angle = 0;
    return ParseFiniteFloat(word, &angle) && angle >= 0 && angle <= 180
               ? ""
               : "'" + word + "' is not an angle from 0 to 180";
}

std::string checkSimdLevel(std::string const &word) {
    OsdExt::SimdLevel const max = OsdExt::GetMaxSimdLevel();
    OsdExt::SimdLevel level = max;
    if (!OsdExt::FindSimdLevel(word, &level)) {
        return "'" + word + "' is not portable, avx2 or avx512";
    }
    return level <= max ? ""
                        : "there is no " + word + " here, at most " + OsdExt::GetSimdLevelName(max);
}

bool isNumberOfSteps(std::string const &word) {
    int level = 0;
    return ParseInt(word, &level) && level >= 0;
}

void addFileOptions(CLI::App &app, Arguments *arguments) {
    app.option_defaults()->group("Files");
    app.add_option("INPUT", arguments->input, "Mesh to refine: .obj, .off or .ply")
        ->type_name("FILE")
        ->required();
    app.add_option(
           "-o,--output", arguments->output,
           "File for the last level: .obj, .off or .ply (binary); none: nothing is written. "
           "What its format does not hold is named by the summary. Holes are left out")
        ->check(MakeMeshFile())
        ->type_name("FILE");
    app.add_flag("--separate-vertices", arguments->isSeparate,
                 "Write a vertex of .ply and .off files once for each of its texture coordinates "
                 "and normals, at seams and, with --limit, at sharp creases");
    app.add_option("--png", arguments->png, "File for a ray traced picture of the last level")
        ->check(MakePngFile())
        ->check([](std::string const &) {
            return std::string(HasRenderer() ? "" : "this program was built without Embree");
        })
        ->type_name("FILE");
    app.add_option(
           "--png-colors", arguments->pngColors,
           "What has a colour of its own in the picture: each face of INPUT, all faces of a "
           "material, group or object of an .obj file, or the levels of --adaptive")
        ->check(CLI::IsMember(kPictureColors))
        ->needs("--png");
}

void addSurfaceOptions(CLI::App &app, Arguments *arguments) {
    app.option_defaults()->group("Surface");
    app.add_option(
           "--like", arguments->like,
           "Defaults of the options below: those of the paper, or what renderers want, "
           "which is --mask smooth, --boundary edge-and-corner, --fvar-interpolation boundaries "
           "and, where nine of ten faces are triangles, --first-step truncate. hexview and the "
           "Blender add-on are for "
           "pictures and begin with smooth; this program and the libraries in C++ and "
           "Python begin with the paper")
        ->check(CLI::IsMember({kLikePaper, kLikeRenderer}))
        ->capture_default_str();
    app.add_option("--mask", arguments->mask,
                   "Mask of the face points: average is the paper's, smooth is the smoothest")
        ->check(CLI::IsMember(kMaskNames))
        ->default_str("average, or that of --like");
    app.add_option("--boundary", arguments->boundary,
                   "Rule for boundaries, before that of the file: none is the paper's, the border "
                   "moves inward; else it becomes a smooth curve, with corners where vertices have "
                   "one face")
        ->check(CLI::IsMember(kBoundaryNames))
        ->default_str("the file's, or none, or that of --like");
    app.add_option(
           "--first-step", arguments->firstStep,
           "Make level 1 by another step, after which vertices have three faces each: "
           "truncate, which cuts off corners, for meshes of triangles; tri-hex, which takes "
           "what the scheme of that name does")
        ->check(CLI::IsMember(kFirstStepNames))
        ->default_str("none, or that of --like");
    app.add_option("--crease-angle", arguments->creaseAngle,
                   "Makes infinitely sharp creases of the edges between faces whose normals differ "
                   "by more than so many degrees, 0 to 180; other creases are those of the file")
        ->check(checkAngle)
        ->type_name("DEG");
    app.add_option("--fvar-interpolation", arguments->fvarInterpolation,
                   "Where texture coordinates and normals are interpolated linearly, before what "
                   "the file says; all is everywhere, so that textures slide a little on faces")
        ->check(CLI::IsMember(kFVarInterpolationNames))
        ->default_str("the file's, or all, or that of --like");
    app.add_option("--scheme", arguments->scheme,
                   "Subdivision scheme; hex is short for hexagonal. The others drop border faces "
                   "and take neither creases, corners, texture coordinates nor normals")
        ->check(CLI::IsMember({"hex", "hexagonal", "doo-sabin", "tri-hex"}))
        ->capture_default_str();
    auto *const coplanar =
        app.add_flag("--coplanar", arguments->isCoplanar,
                     "Make quads instead of hexagons of edges between faces with the same normal, "
                     "and polygons that close the gaps beside them");
    app.add_option("--tolerance", arguments->tolerance,
                   "Largest angle in degrees, 0 to 180, between normals that --coplanar takes for "
                   "the same")
        ->check(checkAngle)
        ->type_name("DEG")
        ->needs(coplanar)
        ->capture_default_str();
    app.add_flag("--open-gaps", arguments->hasOpenGaps, "Leave the gaps of --coplanar open")
        ->needs(coplanar);
}

void addLevelOptions(CLI::App &app, Arguments *arguments) {
    app.option_defaults()->group("Refinement");
    app.add_option("-l,--level", arguments->level, "Number of refinement steps")
        ->check([](std::string const &word) {
            return isNumberOfSteps(word) ? std::string()
                                         : "'" + word + "' is not a number of steps, 0 or more";
        })
        ->capture_default_str();
    app.add_flag("--limit", arguments->isLimit,
                 "Push the vertices to the limit surface and write its normals: to both sides of "
                 "sharp creases in .obj files, their mean at each vertex in .ply and .off files; "
                 "colours and other numbers of vertices stay as they are");
    app.option_defaults()->group("Refinement for a camera");
    AddAdaptiveOptions(app, &arguments->adaptive);
}

void addComputationOptions(CLI::App &app, Arguments *arguments) {
    app.option_defaults()->group("Computation");
    app.add_option("--evaluator", arguments->evaluator,
                   "How values are computed. refinement: level by level without a table, the "
                   "fastest; stencil: from a stencil table; stencil-cpu, stencil-omp: from a table "
                   "by OpenSubdiv's evaluators; primvar: level by level by the primvar refiner")
        ->check(CLI::IsMember({kRefinement, kStencil, kStencilCpu, kStencilOmp, kPrimvar}))
        ->check([](std::string const &evaluator) {
#ifdef HEXREFINE_HAS_OPENMP
            static_cast<void>(evaluator);
            return std::string();
#else
            return std::string(evaluator == kStencilOmp
                                   ? "stencil-omp is not in this program, built without OpenMP"
                                   : "");
#endif
        })
        ->capture_default_str();
    app.add_option("--threads", arguments->numThreads,
                   "Number of threads, 1 to 1024; the result does not depend on it")
        ->check([](std::string const &word) {
            int numThreads = 0;
            if (!ParseInt(word, &numThreads) || numThreads < 1 || numThreads > 1024) {
                return "'" + word + "' is not a number of threads, 1 to 1024";
            }
            return std::string();
        })
        ->default_str(
#ifdef _OPENMP
            "OMP_NUM_THREADS, or that of the processors"
#else
            "that of the processors"
#endif
        );
    app.add_option("--simd", arguments->simd,
                   "Instructions of --evaluator stencil, and of --limit by it or by refinement: "
                   "portable, avx2 or avx512")
        ->check(checkSimdLevel)
        ->type_name("LEVEL")
        ->default_str("that of OPENSUBDIVHEX_SIMD, or the highest of the processor");
}

void addReportOptions(CLI::App &app, Arguments *arguments) {
    app.option_defaults()->group("Report");
    app.add_option("--stats", arguments->stats, "File for statistics as JSON; - is standard output")
        ->type_name("FILE|-");
    app.add_flag("--tags", arguments->printsTags,
                 "Print creases, corners, holes, rules and channels, as lines for an .obj file");
    app.add_flag("--quiet", arguments->isQuiet, "Print no summary and no hints, show no progress");
}

/// No file may be written twice, or be the input and something else than a mesh.
void checkFiles(Arguments const &arguments) {
    struct File {
        char const *option;
        std::string path;
    };
    File const files[] = {{"INPUT", arguments.input},
                          {"--output", arguments.output},
                          {"--png", arguments.png},
                          {"--stats", arguments.stats == "-" ? "" : arguments.stats}};
    for (File const &file : files) {
        for (File const *other = files; other != &file; ++other) {
            bool const isMesh = &file == files + 1 && other == files;
            if (!isMesh && !file.path.empty() && !other->path.empty() &&
                IsSameOutput(file.path, other->path)) {
                throw CLI::ValidationError(file.option, "'" + file.path + "' is the file of " +
                                                            other->option + ", too");
            }
        }
    }
}

/// Throws CLI::ValidationError where options do not go together.
void checkOptions(CLI::App const &app, Arguments const &arguments) {
    checkFiles(arguments);
    if (arguments.printsTags && arguments.stats == "-") {
        throw CLI::ValidationError("--tags", "standard output is taken by --stats -");
    }
    if (arguments.isCoplanar &&
        (arguments.scheme != "hex" || arguments.firstStep.value_or("none") != "none")) {
        throw CLI::ValidationError("--coplanar", "is for the hexagonal scheme alone");
    }
    if (arguments.IsLikeRenderer() && (arguments.isCoplanar || arguments.scheme != "hex")) {
        throw CLI::ValidationError(
            "--like", std::string(kLikeRenderer) + " is not for " +
                          (arguments.isCoplanar ? "--coplanar" : "--scheme " + arguments.scheme));
    }
    // The library takes a name that it cannot use for none.
    char const *const simd = std::getenv("OPENSUBDIVHEX_SIMD");
    std::string const simdError = simd ? checkSimdLevel(simd) : "";
    if (!arguments.simd && !simdError.empty()) {
        throw CLI::ValidationError("OPENSUBDIVHEX_SIMD", simdError);
    }
    if (arguments.isSeparate &&
        (arguments.output.empty() || FindMeshFormat(arguments.output) == MeshFormat::Obj)) {
        throw CLI::ValidationError("--separate-vertices",
                                   "is for an --output that is a .ply or .off file");
    }
    CheckAdaptiveOptions(app, arguments.adaptive);
    if (arguments.adaptive.isAdaptive && arguments.scheme != "hex") {
        throw CLI::ValidationError("--scheme", arguments.scheme + " is not for --adaptive");
    }
    if (arguments.scheme == "tri-hex" && app.count("--mask") > 0) {
        throw CLI::ValidationError("--mask", "has no effect with --scheme tri-hex");
    }
    if (arguments.simd && arguments.evaluator != kStencil &&
        !(arguments.isLimit && arguments.evaluator == kRefinement)) {
        throw CLI::ValidationError(
            "--simd", "has no effect on --evaluator " + arguments.evaluator +
                          (arguments.evaluator == kRefinement ? " without --limit" : ""));
    }
    if (arguments.pngColors == kLevelColors && !arguments.adaptive.isAdaptive) {
        throw CLI::ValidationError("--png-colors", "levels are those of --adaptive");
    }
}

} // namespace

void AddOptions(CLI::App &app, Arguments *arguments) {
    addFileOptions(app, arguments);
    addLevelOptions(app, arguments);
    addSurfaceOptions(app, arguments);
    addComputationOptions(app, arguments);
    addReportOptions(app, arguments);
    app.callback([arguments, &app] {
        if (arguments->scheme == "hexagonal") {
            arguments->scheme = "hex";
        }
        checkOptions(app, *arguments);
    });
    app.option_defaults()->group("Options");
    app.set_version_flag("--version", "hexrefine " OPENSUBDIVHEX_VERSION);
    app.footer("Examples:\n"
               "  hexrefine cage.obj --like renderer -l 3 --limit -o smooth.ply\n"
               "      a smooth surface with its normals, three levels fine\n"
               "  hexrefine cage.obj -l 2 -o refined.obj\n"
               "      as the paper has it\n"
               "  hexrefine cage.obj --like renderer --adaptive --camera 0,1,5,0,0,0 -o seen.ply\n"
               "      as fine as the camera at 0, 1, 5 needs it\n"
               "  hexrefine cage.obj -l 3 --quiet --stats -\n"
               "      what the levels have, as JSON\n"
               "\n"
               "Hints on what is likely wrong go to standard error, once each.\n"
               "Exit status: 0 success, 1 bad input or failed output, 2 bad usage.");
}

} // namespace OpenSubdivHex::Tools

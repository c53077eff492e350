// SPDX-License-Identifier: Apache-2.0
//
// hexrefine: refines a polygon mesh with the hexagonal scheme and writes the result.
//
// Mesh file -> Far::TopologyDescriptor -> FarExt::TopologyRefiner -> OsdExt::RefinementEvaluator,
// or Far::StencilTable and an evaluator -> mesh file.
#include "adaptive.h"
#include "creaseAngle.h"
#include "degenerateFaces.h"
#include "evaluation.h"
#include "far_ext/threads.h"
#include "far_ext/topologyRefinerFactory.h"
#include "far_ext/version.h"
#include "levelMesh.h"
#include "libraryPaths.h"
#include "normals.h"
#include "osd_ext/simdLevel.h"
#include "picture.h"
#include "pictureColors.h"
#include "progress.h"
#include "statistics.h"
#include "tagText.h"
#include "tools/mesh/fileError.h"
#include "tools/mesh/meshCheck.h"
#include "tools/mesh/meshContent.h"
#include "tools/mesh/meshReader.h"
#include "tools/mesh/meshText.h"
#include "tools/mesh/meshWriter.h"
#include "tools/mesh/outputFile.h"
#include "tools/mesh/program.h"
#include "tools/mesh/ruleNames.h"
#include "tools/mesh/topologyDescriptor.h"

#ifdef _OPENMP
#include <omp.h>
#endif

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <new>

namespace OpenSubdivHex::Tools {

namespace {

struct Arguments {
    std::string input;
    int level = 1;
    std::string output;
    std::string mask = "average";
    std::string scheme = "hex";
    std::string firstStep = "none";
    bool isCoplanar = false;
    double tolerance = FarExt::TopologyRefiner::CoplanarOptions(0).angleTolerance;
    bool hasOpenGaps = false;
    std::optional<std::string> boundary;
    std::optional<double> creaseAngle;
    std::optional<std::string> fvarInterpolation;
    std::string evaluator = kRefinement;
    std::optional<int> numThreads;
    std::optional<std::string> simd;
    std::string png;
    std::string pngColors;
    std::string stats;
    bool isLimit = false;
    bool isSeparate = false;
    AdaptiveArguments adaptive;
    bool printsTags = false;
    bool isQuiet = false;
};

/// Runs \p work and gives the milliseconds it took.
template <typename WORK>
double measure(Progress &progress, std::string const &phase, WORK &&work) {
    progress.SetPhase(phase);
    auto const start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
        .count();
}

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

void addSchemeOptions(CLI::App &app, Arguments *arguments) {
    app.add_option("--scheme", arguments->scheme,
                   "Subdivision scheme; hex is short for hexagonal. The others drop border faces "
                   "and take neither creases, corners, texture coordinates nor normals")
        ->check(CLI::IsMember({"hex", "hexagonal", "doo-sabin", "tri-hex"}))
        ->capture_default_str();
    app.add_option(
           "--first-step", arguments->firstStep,
           "Make level 1 by another step, after which vertices have three faces each: "
           "truncate, which cuts off corners, for meshes of triangles; tri-hex, which takes "
           "what the scheme of that name does")
        ->check(CLI::IsMember(kFirstStepNames))
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

void addOptions(CLI::App &app, Arguments *arguments) {
    app.add_option("INPUT", arguments->input, "Mesh to refine: .obj, .off or .ply")
        ->type_name("FILE")
        ->required();
    app.add_option("-l,--level", arguments->level, "Number of refinement steps")
        ->check([](std::string const &word) {
            int level = 0;
            return std::string(ParseInt(word, &level) && level >= 0
                                   ? ""
                                   : "'" + word + "' is not a number of steps, 0 or more");
        })
        ->capture_default_str();
    app.add_option(
           "-o,--output", arguments->output,
           "File for the last level: .obj, .off or .ply (binary); none: nothing is "
           "written. It keeps what its format holds, and the summary names the rest: .obj "
           "texture coordinates, normals, colours, objects, groups and materials (a hexagon "
           "that a seam crosses is written as two quads), .ply all numbers of vertices and "
           "faces, .off colours. Holes are left out")
        ->check([](std::string const &path) {
            return FindMeshFormat(path) ? std::string()
                                        : "'" + path + "' is not a " + kMeshExtensions + " file";
        })
        ->type_name("FILE");
    app.add_option("--mask", arguments->mask,
                   "Mask of the face points: average is the paper's, smooth is the smoothest")
        ->check(CLI::IsMember(kMaskNames))
        ->capture_default_str();
    addSchemeOptions(app, arguments);
    app.add_option("--boundary", arguments->boundary,
                   "Rule for boundaries, before that of the file: none is the paper's, the border "
                   "moves inward; else it becomes a smooth curve, with corners where vertices have "
                   "one face")
        ->check(CLI::IsMember(kBoundaryNames))
        ->default_str("the file's, or none");
    app.add_option("--crease-angle", arguments->creaseAngle,
                   "Makes infinitely sharp creases of the edges between faces whose normals differ "
                   "by more than so many degrees, 0 to 180; other creases are those of the file")
        ->check(checkAngle)
        ->type_name("DEG");
    app.add_option("--fvar-interpolation", arguments->fvarInterpolation,
                   "Where texture coordinates and normals are interpolated linearly, before what "
                   "the file says; all is everywhere")
        ->check(CLI::IsMember(kFVarInterpolationNames))
        ->default_str("the file's, or all");
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
    app.add_flag("--limit", arguments->isLimit,
                 "Push the vertices to the limit surface and write its normals: to both sides of "
                 "sharp creases in .obj files, their mean at each vertex in .ply and .off files; "
                 "colours and other numbers of vertices stay as they are");
    app.add_flag("--separate-vertices", arguments->isSeparate,
                 "Write a vertex of .ply and .off files once for each of its texture coordinates "
                 "and normals, at seams and, with --limit, at sharp creases; the first of each lie "
                 "where they are without this");
    AddAdaptiveOptions(app, &arguments->adaptive);
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
    app.add_option("--png", arguments->png, "File for a ray traced picture of the last level")
        ->check([](std::string const &name) {
            if (std::filesystem::path(name).extension() != ".png") {
                return "'" + name + "' is not a .png file";
            }
            return std::string(HasRenderer() ? "" : "this program was built without Embree");
        })
        ->type_name("FILE");
    app.add_option(
           "--png-colors", arguments->pngColors,
           "What has a colour of its own in the picture: each face of INPUT with what is "
           "refined from it, all faces of a material, group or object of an .obj file, or the "
           "levels of --adaptive")
        ->check(CLI::IsMember(kPictureColors))
        ->needs("--png");
    app.add_option("--stats", arguments->stats, "File for statistics as JSON; - is standard output")
        ->type_name("FILE|-");
    app.add_flag("--tags", arguments->printsTags,
                 "Print creases, corners, holes, rules and channels, as lines for an .obj file");
    app.add_flag("--quiet", arguments->isQuiet, "Print no summary and show no progress");
    app.callback([arguments, &app] {
        checkFiles(*arguments);
        if (arguments->printsTags && arguments->stats == "-") {
            throw CLI::ValidationError("--tags", "standard output is taken by --stats -");
        }
        if (arguments->scheme == "hexagonal") {
            arguments->scheme = "hex";
        }
        if (arguments->isCoplanar &&
            (arguments->scheme != "hex" || arguments->firstStep != "none")) {
            throw CLI::ValidationError("--coplanar", "is for the hexagonal scheme alone");
        }
        // The library takes a name that it cannot use for none.
        char const *const simd = std::getenv("OPENSUBDIVHEX_SIMD");
        std::string const simdError = simd ? checkSimdLevel(simd) : "";
        if (!arguments->simd && !simdError.empty()) {
            throw CLI::ValidationError("OPENSUBDIVHEX_SIMD", simdError);
        }
        if (arguments->isSeparate &&
            (arguments->output.empty() || FindMeshFormat(arguments->output) == MeshFormat::Obj)) {
            throw CLI::ValidationError("--separate-vertices",
                                       "is for an --output that is a .ply or .off file");
        }
        CheckAdaptiveOptions(app, arguments->adaptive);
        if (arguments->scheme == "tri-hex" && app.count("--mask") > 0) {
            throw CLI::ValidationError("--mask", "has no effect with --scheme tri-hex");
        }
        if (arguments->simd && arguments->evaluator != kStencil &&
            !(arguments->isLimit && arguments->evaluator == kRefinement)) {
            throw CLI::ValidationError(
                "--simd", "has no effect on --evaluator " + arguments->evaluator +
                              (arguments->evaluator == kRefinement ? " without --limit" : ""));
        }
        if (arguments->pngColors == kLevelColors && !arguments->adaptive.isAdaptive) {
            throw CLI::ValidationError("--png-colors", "levels are those of --adaptive");
        }
    });
    app.set_version_flag("--version", "hexrefine " OPENSUBDIVHEX_VERSION);
    app.footer("Exit status: 0 success, 1 bad input or failed output, 2 bad usage.");
}

FarExt::HexSchemeOptions findSchemeOptions(Arguments const &arguments) {
    FarExt::HexSchemeOptions options;
    options.faceMask = FindRule<FarExt::FaceMask>(kMaskNames, arguments.mask);
    options.schemeType = FindRule<FarExt::SchemeType>(
        kSchemeNames, arguments.scheme == "hex" ? "hexagonal" : arguments.scheme);
    options.firstStep = FindRule<FarExt::FirstStep>(kFirstStepNames, arguments.firstStep);
    return options;
}

/// The rules: those of the command line, else those of the file, else the paper's boundary and
/// what Sdc::Options has.
Sdc::Options chooseOptions(Arguments const &arguments, MeshTags const &tags) {
    Sdc::Options options;
    auto boundary = tags.boundary.value_or(Sdc::Options::VTX_BOUNDARY_NONE);
    if (arguments.boundary) {
        boundary = FindRule<decltype(boundary)>(kBoundaryNames, *arguments.boundary);
    }
    auto fvarInterpolation = tags.fvarInterpolation.value_or(options.GetFVarLinearInterpolation());
    if (arguments.fvarInterpolation) {
        fvarInterpolation = FindRule<decltype(fvarInterpolation)>(kFVarInterpolationNames,
                                                                  *arguments.fvarInterpolation);
    }
    options.SetVtxBoundaryInterpolation(boundary);
    options.SetFVarLinearInterpolation(fvarInterpolation);
    options.SetCreasingMethod(tags.creasingMethod.value_or(options.GetCreasingMethod()));
    return options;
}

/// Prints a line, unless there is no \p message.
void warn(std::string const &input, std::string const &message) {
    if (!message.empty()) {
        std::cerr << "hexrefine: " << EscapeControls(input + ": warning: " + message) << "\n";
    }
}

/// The base mesh as the library takes it, validated.
std::unique_ptr<FarExt::TopologyRefiner> createRefiner(Arguments const &arguments, Mesh const &mesh,
                                                       Sdc::Options sdcOptions) {
    Far::TopologyDescriptor descriptor = DescribeTopology(mesh);
    auto const channels = DescribeChannels(mesh);
    descriptor.numFVarChannels = int(channels.size());
    descriptor.fvarChannels = channels.data();
    FarExt::TopologyRefinerFactory::Options options;
    options.schemeOptions = findSchemeOptions(arguments);
    FarExt::Status status;
    auto refiner = FarExt::TopologyRefinerFactory::Create(descriptor, sdcOptions, options, &status);
    if (!refiner) {
        throw FileError(arguments.input, status.GetMessage());
    }
    for (FarExt::Warning const &warning : status.GetWarnings()) {
        warn(arguments.input, warning.message);
    }
    warn(arguments.input, DescribeDegenerateFaces(mesh));
    return refiner;
}

/// To a level; the positions of \p mesh are the rest pose.
void refine(Arguments const &arguments, Mesh const &mesh, int level,
            FarExt::TopologyRefiner *refiner) {
    FarExt::Status status;
    bool const needsFullTopology =
        arguments.isLimit || arguments.adaptive.isAdaptive || !arguments.png.empty();
    FarExt::TopologyRefiner::UniformOptions uniformOptions(level);
    uniformOptions.fullTopologyInLastLevel = needsFullTopology;
    if (refiner->GetHexSchemeOptions().firstStep == FarExt::FirstStep::Truncate) {
        uniformOptions.faceLabels = FindFaceClasses(mesh);
    }
    FarExt::TopologyRefiner::CoplanarOptions options(level);
    options.angleTolerance = arguments.tolerance;
    options.closeGaps = !arguments.hasOpenGaps;
    options.fullTopologyInLastLevel = needsFullTopology;
    bool const isDone = arguments.isCoplanar
                            ? refiner->RefineCoplanar(mesh.positions.data(), options, &status)
                            : refiner->RefineUniform(uniformOptions, &status);
    if (!isDone) {
        throw FileError(arguments.input, status.GetMessage());
    }
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

/// Throws FileError unless \p isDone, with \p status, which evaluators of tables give none of.
void requireDone(Arguments const &arguments, bool isDone, FarExt::Status const &status) {
    if (!isDone) {
        throw FileError(arguments.input,
                        status.IsOk() ? "--evaluator " + arguments.evaluator + " gives no values"
                                      : status.GetMessage());
    }
}

/// Replaces the positions of \p mesh by limit points, and gives the normal on each side.
std::vector<float> evaluateLimit(Arguments const &arguments, FarExt::TopologyRefiner const &refiner,
                                 FarExt::LimitSides const &sides, Mesh *mesh, Progress &progress,
                                 Statistics *statistics) {
    auto &milliseconds = statistics->milliseconds;
    FarExt::Status status;
    auto const require = [&](bool isDone) { requireDone(arguments, isDone, status); };
    std::vector<float> normals;
    // Tables alone have further sides.
    if (!NeedsStencils(arguments.evaluator) && sides.GetNumSides() == sides.GetNumVertices()) {
        milliseconds.evaluate += measure(progress, "evaluating", [&] {
            require(
                EvaluateLimit(refiner, arguments.evaluator, &mesh->positions, &normals, &status));
        });
        return normals;
    }
    std::unique_ptr<Far::LimitStencilTable const> table;
    milliseconds.stencils += measure(progress, "building limit stencils", [&] {
        table = CreateLimitStencils(refiner, &status);
        require(table != nullptr);
    });
    statistics->stencils = table->GetNumStencils();
    statistics->weights = std::int64_t(table->GetWeights().size());
    milliseconds.evaluate += measure(progress, "evaluating", [&] {
        require(EvaluateLimit(*table, sides, arguments.evaluator, &mesh->positions, &normals));
    });
    return normals;
}

/// The faces of the last level and, where the file takes them, the normals on each side; else their
/// mean at each vertex.
void copyFacesWithNormals(Arguments const &arguments, FarExt::TopologyLevel const &level,
                          FarExt::LimitSides const &sides, std::vector<float> normals, Mesh *mesh) {
    if (arguments.isSeparate || FindMeshFormat(arguments.output) == MeshFormat::Obj) {
        mesh->channels.push_back({FVarKind::Normal, 3, std::move(normals), {}});
        if (arguments.isSeparate) {
            CopySeparateFaces(level, &sides, mesh);
        } else {
            CopyFaces(level, sides, mesh);
        }
        return;
    }
    CopyFaces(level, mesh);
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

/// Replaces the values of \p mesh by those of the last level, but for positions on the limit.
void evaluate(Arguments const &arguments, FarExt::TopologyRefiner const &refiner, Mesh *mesh,
              Progress &progress, Statistics *statistics) {
    auto &milliseconds = statistics->milliseconds;
    for (Primvar const &primvar : findPrimvars(mesh)) {
        bool const isPosition = primvar.mode == FarExt::INTERPOLATE_VERTEX;
        if (arguments.isLimit && isPosition) {
            continue;
        }
        FarExt::Status status;
        auto const require = [&](bool isDone) { requireDone(arguments, isDone, status); };
        if (!NeedsStencils(arguments.evaluator)) {
            milliseconds.evaluate += measure(progress, "evaluating", [&] {
                require(EvaluateLevels(refiner, arguments.evaluator, primvar, &status));
            });
            continue;
        }
        std::unique_ptr<Far::StencilTable const> table;
        milliseconds.stencils += measure(progress, "building stencils", [&] {
            table = CreateStencils(refiner, primvar, &status);
            require(table != nullptr);
        });
        if (isPosition) {
            statistics->stencils = table->GetNumStencils();
            statistics->weights = std::int64_t(table->GetWeights().size());
        }
        milliseconds.evaluate += measure(progress, "evaluating", [&] {
            require(EvaluateStencils(*table, arguments.evaluator, primvar));
        });
    }
}

/// Removes from \p mesh what will not be written.
void removeWhatIsNotWritten(Arguments const &arguments, Mesh *mesh, Statistics *statistics) {
    if (arguments.output.empty()) {
        return;
    }
    for (FVarChannel const &channel : mesh->channels) {
        statistics->channelsLeftOut.push_back(GetName(channel.kind));
    }
    std::vector<FVarChannel> separated; // which will be properties of vertices
    if (arguments.isSeparate) {
        separated.swap(mesh->channels);
    }
    statistics->notWritten = RemoveWhatIsNotHeld(arguments.output, mesh);
    if (arguments.isSeparate) {
        mesh->channels = std::move(separated);
    }
    if (!mesh->channels.empty()) {
        statistics->channelsLeftOut.clear(); // a format holds all or none
    }
    statistics->outputFormat = std::filesystem::path(arguments.output).extension().string();
    mesh->materialLibraries =
        MoveLibraries(std::move(mesh->materialLibraries), arguments.input, arguments.output);
}

/// \brief Makes room for the normals of --limit: those of vertices are removed, and named.  Throws
/// FileError if there are face-varying ones, which may have seams that the limit has not.
void removeNormals(Arguments const &arguments, Mesh *mesh, Statistics *statistics) {
    for (FVarChannel const &channel : mesh->channels) {
        if (channel.kind == FVarKind::Normal) {
            throw FileError(arguments.input,
                            "has normals of its own, which those of --limit would replace");
        }
    }
    std::vector<VertexProperty> &properties = mesh->vertexProperties;
    auto const end = std::remove_if(properties.begin(), properties.end(), IsNormal);
    if (end != properties.end()) {
        properties.erase(end, properties.end());
        statistics->notRead.emplace_back("normals, those of --limit replace them");
    }
}

void print(std::string const &text) {
    std::cout << text;
    FlushOutput();
}

void writeStatistics(Statistics const &statistics, std::string const &path) {
    if (path == "-") {
        print(FormatJson(statistics));
        return;
    }
    OutputFile file(path);
    file.Write(FormatJson(statistics));
    file.Commit();
}

/// Sets the level that --simd names, which is checked.
void setSimdLevel(std::string const &name) {
    OsdExt::SimdLevel level = OsdExt::GetSimdLevel();
    OsdExt::FindSimdLevel(name, &level);
    OsdExt::SetSimdLevel(level);
}

void run(Arguments const &arguments) {
    Statistics statistics;
    statistics.scheme = arguments.scheme;
    statistics.firstStep = arguments.firstStep;
    if (arguments.isCoplanar) {
        statistics.coplanar = {arguments.tolerance, arguments.hasOpenGaps};
    }
    statistics.mask = arguments.mask;
    statistics.evaluator = arguments.adaptive.isAdaptive ? "surface" : arguments.evaluator;
    statistics.input = arguments.input;
    auto &milliseconds = statistics.milliseconds;
    std::string tagText;
    {
        Progress progress(!arguments.isQuiet && Progress::IsTerminal());

        Mesh mesh;
        milliseconds.read = measure(progress, "reading", [&] { mesh = ReadMesh(arguments.input); });

        std::vector<int> const regions = FindRegions(arguments.pngColors, mesh, arguments.input);

        std::unique_ptr<FarExt::TopologyRefiner> refiner;
        milliseconds.validate = measure(progress, "validating", [&] {
            if (arguments.creaseAngle) {
                AddCreases(*arguments.creaseAngle, &mesh);
            }
            Sdc::Options const sdcOptions = chooseOptions(arguments, mesh.tags);
            tagText = arguments.printsTags ? FormatTags(mesh, sdcOptions) : "";
            statistics.notRead = mesh.notRead;
            removeWhatIsNotWritten(arguments, &mesh, &statistics);
            if (arguments.isLimit) {
                removeNormals(arguments, &mesh, &statistics);
            }
            statistics.attributes = CountAttributes(mesh);
            refiner = createRefiner(arguments, mesh, sdcOptions);
            statistics.boundary = kBoundaryNames[sdcOptions.GetVtxBoundaryInterpolation()];
            statistics.creasingMethod = kCreasingMethodNames[sdcOptions.GetCreasingMethod()];
            statistics.fvarInterpolation =
                kFVarInterpolationNames[sdcOptions.GetFVarLinearInterpolation()];
        });

        bool const isAdaptive = arguments.adaptive.isAdaptive;
        // Cells begin with the faces of the surface level.
        int const lastDepth =
            isAdaptive ? refiner->GetHexSchemeOptions().GetSurfaceLevel() : arguments.level;
        milliseconds.refine = measure(progress, "refining", [&] {
            if (!isAdaptive || lastDepth > 0) {
                refine(arguments, mesh, lastDepth, refiner.get());
            }
        });
        statistics.levels = CountLevels(*refiner);
        statistics.creases = mesh.tags.GetNumCreases();
        statistics.corners = mesh.tags.GetNumCorners();
        statistics.holes = CountHoles(*refiner);
        statistics.channels = CountChannels(*refiner, mesh);

        std::optional<AdaptiveRefinement> cells;
        if (lastDepth > 0) {
            evaluate(arguments, *refiner, &mesh, progress, &statistics);
        }
        if (isAdaptive) {
            milliseconds.evaluate += measure(progress, "evaluating", [&] {
                cells.emplace(mesh, arguments.output, !arguments.png.empty());
                cells->Refine(arguments.adaptive, *refiner, arguments.input);
                statistics.adaptive = cells->GetStatistics();
            });
        } else if (lastDepth > 0) {
            NormalizeNormals(&mesh);
        }
        FarExt::TopologyLevel const &lastLevel = refiner->GetLevel(lastDepth);
        std::optional<FarExt::LimitSides> sides;
        std::vector<float> normals;
        if (arguments.isLimit) {
            sides.emplace(lastLevel);
            normals = evaluateLimit(arguments, *refiner, *sides, &mesh, progress, &statistics);
        }
        CheckFinite(mesh, arguments.input, "level " + std::to_string(lastDepth) + ": ");

        if (!arguments.png.empty()) {
            milliseconds.render = measure(progress, "rendering", [&] {
                if (isAdaptive) {
                    try {
                        WriteCellPicture(cells->GetMesh(), cells->GetCamera(),
                                         FindCellRegions(arguments.pngColors, regions,
                                                         cells->GetMesh(), cells->GetFaceLevels()),
                                         arguments.png);
                    } catch (std::bad_alloc const &) {
                        throw FileError(arguments.png, "not enough memory for a picture of " +
                                                           arguments.adaptive.resolution +
                                                           " pixels");
                    }
                    return;
                }
                WritePicture(refiner->GetLevel(arguments.level), mesh.positions, regions,
                             arguments.png);
            });
        }
        if (!arguments.output.empty()) {
            milliseconds.write = measure(progress, "writing", [&] {
                if (sides) {
                    copyFacesWithNormals(arguments, lastLevel, *sides, std::move(normals), &mesh);
                } else if (arguments.isSeparate) {
                    CopySeparateFaces(lastLevel, nullptr, &mesh);
                } else if (!isAdaptive) {
                    CopyFaces(lastLevel, &mesh);
                }
                if (isAdaptive ? cells->GetStatistics().faces == 0 : mesh.faceSizes.empty()) {
                    throw FileError(arguments.input, "all faces are holes, none is left to write");
                }
                if (isAdaptive) {
                    cells->Write();
                } else {
                    WriteMesh(mesh, arguments.output);
                }
            });
        }
    }

    if (arguments.printsTags) {
        print(tagText);
    }
    if (!arguments.stats.empty()) {
        writeStatistics(statistics, arguments.stats);
    }
    if (!arguments.isQuiet && arguments.stats != "-") {
        std::string summary = FormatSummary(statistics);
        for (std::string const &path : {arguments.output, arguments.png}) {
            summary += path.empty() ? "" : "wrote " + EscapeControls(path) + "\n";
        }
        print(summary);
    }
}

} // namespace

} // namespace OpenSubdivHex::Tools

int main(int argc, char **argv) {
    using namespace OpenSubdivHex::Tools;

    Arguments arguments;
    CLI::App app("Refines a polygon mesh with the hexagonal vertex-to-vertex subdivision scheme.",
                 "hexrefine");
    addOptions(app, &arguments);
    return RunProgram(app, argc, argv, [&] {
        if (arguments.numThreads) {
            OpenSubdivHex::FarExt::SetNumThreads(*arguments.numThreads);
#ifdef _OPENMP
            omp_set_num_threads(*arguments.numThreads); // of Osd's evaluator
#endif
        }
        if (arguments.simd) {
            setSimdLevel(*arguments.simd);
        }
        try {
            run(arguments);
        } catch (std::bad_alloc const &) {
            std::string const what =
                arguments.adaptive.isAdaptive
                    ? "--adaptive up to level " + std::to_string(arguments.adaptive.maxLevel)
                    : "level " + std::to_string(arguments.level);
            throw FileError(arguments.input, "not enough memory for " + what);
        }
    });
}

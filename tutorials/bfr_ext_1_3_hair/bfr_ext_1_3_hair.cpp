// SPDX-License-Identifier: Apache-2.0
//
// Tutorial description:
//
//     Hair: roots at any places of a mesh, which follow its animation.
//
//     A root is a face and a (u, v) in it.  BfrExt::SurfacePlaces takes all roots once, in any order;
//     each frame it is given the control points, and writes points and first derivatives: du x dv is the
//     normal that a hair grows along, du the direction that it is combed to.
//
//     With --bfr the same roots grow on OpenSubdiv's Catmull-Clark surface, by its own Bfr::Surface: what
//     SurfacePlaces does is written out there (BfrPlaces).  Both use the same threads.
//
#include "bfr_ext/surfaceFactory.h"
#include "bfr_ext/surfacePlaces.h"
#include "far_ext/executor.h"
#include "far_ext/topologyRefinerFactory.h"
#include "tools/mesh/catmarkRefiner.h"
#include "tools/mesh/fileError.h"
#include "tools/mesh/meshReader.h"
#include "tools/mesh/meshText.h"
#include "tools/mesh/meshWriter.h"
#include "tools/mesh/program.h"
#include "tools/mesh/topologyDescriptor.h"
#include "tools/render/vec3.h"

#include <opensubdiv/bfr/refinerSurfaceFactory.h>
#include <opensubdiv/bfr/surface.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <memory>
#include <numeric>
#include <random>
#include <stdexcept>
#include <string>

namespace OpenSubdivHex::Tools {

namespace {

namespace Bfr = OpenSubdiv::Bfr;

constexpr char kName[] = "bfr_ext_1_3_hair";

struct Arguments {
    std::string input;
    std::string output;
    int numHairs = 100000;
    int numFrames = 12;
    int numThreads = 0;
    bool hasBfr = false;
};

/// Places of a mesh.
struct Roots {
    std::vector<int> faces;
    std::vector<float> uvs;

    int GetNumRoots() const { return int(faces.size()); }
};

/// Roots in a frame: x y z for each.
struct GrownRoots {
    explicit GrownRoots(int numRoots)
        : points(3 * std::size_t(numRoots)), du(points.size()), dv(points.size()) {}

    Vec3 GetNormal(int root) const {
        return Normalize(Cross(GetVec3(du.data(), root), GetVec3(dv.data(), root)));
    }

    std::vector<float> points, du, dv;
};

/// Twice the area of a face.
float computeArea(Mesh const &mesh, int const *vertices, int size) {
    Vec3 sum;
    for (int i = 2; i < size; ++i) {
        Vec3 const start = GetVec3(mesh.positions.data(), vertices[0]);
        sum = sum + Cross(GetVec3(mesh.positions.data(), vertices[i - 1]) - start,
                          GetVec3(mesh.positions.data(), vertices[i]) - start);
    }
    return Length(sum);
}

/// Roots at random places, as many on a face as its area asks for, in no order.
Roots plantRoots(Mesh const &mesh, BfrExt::SurfaceFactory const &factory, int numRoots,
                 std::string const &input) {
    std::vector<float> areas;
    int const *vertices = mesh.faceVertices.data();
    for (int face = 0; face < mesh.GetNumFaces(); ++face) {
        int const size = mesh.faceSizes[std::size_t(face)];
        areas.push_back(factory.GetLevel().IsFaceHole(face) ? 0
                                                            : computeArea(mesh, vertices, size));
        vertices += size;
    }
    double const sum = std::accumulate(areas.begin(), areas.end(), 0.0);
    if (!(sum > 0) || !std::isfinite(sum)) {
        throw FileError(input, sum > 0 ? "the areas of faces are beyond the range of floats"
                                       : "all faces are holes, or without an area");
    }
    Roots roots;
    std::mt19937 random(1);
    std::discrete_distribution<int> choose(areas.begin(), areas.end());
    std::uniform_real_distribution<float> share(0, 1);
    for (int i = 0; i < numRoots; ++i) {
        int const face = choose(random);
        BfrExt::Parameterization const parameterization = factory.GetFaceParameterization(face);
        float uv[2] = {share(random), share(random)};
        if (parameterization.HasSubFaces()) {
            std::uniform_int_distribution<int> subFace(0, parameterization.GetFaceSize() - 1);
            float const inSubFace[2] = {uv[0], uv[1]};
            parameterization.ConvertNormalizedSubFaceToCoord(subFace(random), inSubFace, uv);
        } else if (parameterization.GetFaceSize() == 3 && uv[0] + uv[1] > 1) {
            uv[0] = 1 - uv[0];
            uv[1] = 1 - uv[1];
        }
        roots.faces.push_back(face);
        roots.uvs.insert(roots.uvs.end(), uv, uv + 2);
    }
    return roots;
}

/// The control points of a frame: the mesh sways from side to side.
std::vector<float> sway(std::vector<float> positions, float time) {
    for (std::size_t i = 0; i < positions.size(); i += 3) {
        positions[i] += 0.3F * std::sin(6.2831853F * time + positions[i + 1]);
    }
    return positions;
}

/// SurfacePlaces by Bfr, on OpenSubdiv's surface.
class BfrPlaces {
public:
    BfrPlaces(Bfr::RefinerSurfaceFactory<> const &factory, Roots const &roots)
        : _roots(roots), _order(roots.faces.size()) {
        std::iota(_order.begin(), _order.end(), 0);
        std::stable_sort(_order.begin(), _order.end(), [&](int a, int b) {
            return roots.faces[std::size_t(a)] < roots.faces[std::size_t(b)];
        });
        int lastFace = -1;
        for (std::size_t i = 0; i < _order.size(); ++i) {
            int const face = roots.faces[std::size_t(_order[i])];
            if (face != lastFace) {
                _firstPlaces.push_back(i);
                _surfaces.emplace_back();
                if (!factory.InitVertexSurface(face, &_surfaces.back())) {
                    throw std::runtime_error("face " + std::to_string(face) +
                                             " has no surface in Bfr");
                }
                lastFace = face;
            }
        }
        _firstPlaces.push_back(_order.size());
    }

    void Evaluate(float const *positions, GrownRoots *grown) const {
        constexpr int kNumTogether = 16; // surfaces that a thread takes
        int const numSurfaces = int(_surfaces.size());
        FarExt::ParallelFor((numSurfaces + kNumTogether - 1) / kNumTogether, [&](int range) {
            std::vector<float> patchPoints;
            int const end = std::min((range + 1) * kNumTogether, numSurfaces);
            for (auto i = std::size_t(range * kNumTogether); i < std::size_t(end); ++i) {
                Bfr::Surface<float> const &surface = _surfaces[i];
                patchPoints.resize(3 * std::size_t(surface.GetNumPatchPoints()));
                surface.PreparePatchPoints(positions, 3, patchPoints.data(), 3);
                for (std::size_t k = _firstPlaces[i]; k < _firstPlaces[i + 1]; ++k) {
                    auto const root = std::size_t(_order[k]);
                    surface.Evaluate(&_roots.uvs[2 * root], patchPoints.data(), 3,
                                     &grown->points[3 * root], &grown->du[3 * root],
                                     &grown->dv[3 * root]);
                }
            }
        });
    }

private:
    Roots const &_roots;
    std::vector<int> _order; // of roots: by face
    std::vector<Bfr::Surface<float>> _surfaces;
    std::vector<std::size_t> _firstPlaces; // in the order, of each surface, and the end
};

/// Hairs as blades, two quads and a triangle each, that bend to where they are combed.
Mesh growBlades(GrownRoots const &grown, int numRoots, float length, float width) {
    constexpr int kNumVertices = 7; // three pairs, and the tip
    constexpr int kFaceSizes[] = {4, 4, 3};
    constexpr int kFaceVertices[] = {0, 1, 3, 2, 2, 3, 5, 4, 4, 5, 6};
    Mesh blades;
    auto const addPoint = [&](Vec3 point) {
        blades.positions.insert(blades.positions.end(), {point.x, point.y, point.z});
    };
    for (int root = 0; root < numRoots; ++root) {
        Vec3 const start = GetVec3(grown.points.data(), root);
        Vec3 const normal = grown.GetNormal(root);
        Vec3 const comb = Normalize(GetVec3(grown.du.data(), root));
        Vec3 const across = width * Cross(normal, comb);
        auto const bend = [&](float t) {
            return start + length * ((t - 0.4F * t * t) * normal + t * t * comb);
        };
        for (float const t : {0.0F, 0.35F, 0.7F}) {
            addPoint(bend(t) - (1 - t) * across);
            addPoint(bend(t) + (1 - t) * across);
        }
        addPoint(bend(1));
        blades.faceSizes.insert(blades.faceSizes.end(), std::begin(kFaceSizes),
                                std::end(kFaceSizes));
        for (int const vertex : kFaceVertices) {
            blades.faceVertices.push_back(kNumVertices * root + vertex);
        }
    }
    return blades;
}

template <typename FUNCTION>
double measure(FUNCTION const &function) {
    auto const start = std::chrono::steady_clock::now();
    function();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
        .count();
}

double findMedian(std::vector<double> values) {
    auto const middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

void run(Arguments const &arguments) {
    FarExt::ExecutorScope const threads(nullptr, arguments.numThreads);
    Mesh const mesh = ReadInput(kName, arguments.input);
    Sdc::Options sdcOptions;
    sdcOptions.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
    FarExt::TopologyRefinerFactory::Options options;
    options.hexSchemeOptions.faceMask = FarExt::FaceMask::Smooth;
    FarExt::CallStatus status;
    auto const refiner = FarExt::TopologyRefinerFactory::Create(DescribeTopology(mesh), sdcOptions,
                                                                options, &status);
    auto const factory = refiner ? BfrExt::SurfaceFactory::Create(*refiner, &status) : nullptr;
    if (!factory) {
        throw FileError(arguments.input, status.GetErrorMessage());
    }

    std::unique_ptr<Far::TopologyRefiner> bfrRefiner;
    if (arguments.hasBfr) {
        bfrRefiner = CreateCatmarkRefiner(mesh, sdcOptions, arguments.input);
    }

    // Once.
    Roots const roots = plantRoots(mesh, *factory, arguments.numHairs, arguments.input);
    int const numRoots = roots.GetNumRoots();
    std::unique_ptr<BfrExt::SurfacePlaces<float>> places;
    double const making = measure([&] {
        places = BfrExt::SurfacePlaces<float>::Create(*factory, numRoots, roots.faces.data(),
                                                      roots.uvs.data(), &status);
    });
    if (!places) {
        throw FileError(arguments.input, status.GetErrorMessage());
    }
    std::printf("%d roots on %d faces, made in %.1f ms", numRoots, mesh.GetNumFaces(), making);
    std::unique_ptr<Bfr::RefinerSurfaceFactory<>> bfrFactory;
    std::unique_ptr<BfrPlaces> bfrPlaces;
    if (bfrRefiner) {
        bfrFactory = std::make_unique<Bfr::RefinerSurfaceFactory<>>(*bfrRefiner);
        std::printf(", Bfr: %.1f ms",
                    measure([&] { bfrPlaces = std::make_unique<BfrPlaces>(*bfrFactory, roots); }));
    }
    std::printf("\n");

    // Each frame.  The first one makes what faces that look alike have in common, too.
    GrownRoots grown(numRoots);
    GrownRoots bfrGrown(arguments.hasBfr ? numRoots : 0);
    std::vector<double> times;
    std::vector<double> bfrTimes;
    for (int frame = 0; frame < arguments.numFrames; ++frame) {
        std::vector<float> const positions =
            sway(mesh.positions, float(frame) / float(arguments.numFrames));
        times.push_back(measure([&] {
            places->Evaluate(positions.data(), 3, grown.points.data(), grown.du.data(),
                             grown.dv.data(), 3);
        }));
        std::printf("frame %d: %.2f ms", frame, times.back());
        if (bfrPlaces) {
            bfrTimes.push_back(measure([&] { bfrPlaces->Evaluate(positions.data(), &bfrGrown); }));
            std::printf(", Bfr: %.2f ms", bfrTimes.back());
        }
        std::printf("\n");
    }
    std::printf("median: %.0f ns a root", 1e6 * findMedian(times) / numRoots);
    if (bfrPlaces) {
        std::printf(", Bfr: %.0f ns", 1e6 * findMedian(bfrTimes) / numRoots);
    }
    std::printf("\n");

    int numNormals = 0;
    for (int root = 0; root < numRoots; ++root) {
        numNormals += std::fabs(Length(grown.GetNormal(root)) - 1) < 1e-5F;
    }
    std::printf("%d hairs, %d with a normal\n", numRoots, numNormals);
    if (numNormals != numRoots) {
        throw FileError(arguments.input, "the surface has no normal at some roots");
    }
    if (!arguments.output.empty()) {
        auto const [low, high] = std::minmax_element(mesh.positions.begin(), mesh.positions.end());
        float const size = *high - *low;
        WriteMesh(growBlades(grown, numRoots, 0.05F * size, 0.0005F * size), arguments.output);
        std::printf("wrote the last frame to %s\n", EscapeControls(arguments.output).c_str());
    }
}

} // namespace

} // namespace OpenSubdivHex::Tools

int main(int argc, char **argv) {
    using namespace OpenSubdivHex::Tools;

    Arguments arguments;
    CLI::App app("Grows hair at random places of a mesh, which follows its animation.", kName);
    app.add_option("INPUT", arguments.input, "Control mesh: .obj, .off or .ply")
        ->type_name("FILE")
        ->required();
    app.add_option("-o,--output", arguments.output,
                   "Hairs of the last frame to write: .obj, .off or .ply")
        ->check(MakeMeshFile())
        ->type_name("FILE");
    app.add_option("--hairs", arguments.numHairs, "Number of hairs")
        ->check(CLI::Range(1, 100000000))
        ->capture_default_str();
    app.add_option("--frames", arguments.numFrames, "Number of frames")
        ->check(CLI::Range(1, 10000))
        ->capture_default_str();
    app.add_option("--threads", arguments.numThreads, "Number of threads; 0: the machine's")
        ->check(CLI::Range(0, 1024))
        ->capture_default_str();
    app.add_flag("--bfr", arguments.hasBfr,
                 "Times OpenSubdiv's Catmull-Clark surface beside, for meshes of quads");
    app.footer("Exit status: 0 success, 1 bad input or failed output, 2 bad usage.");
    return RunProgram(app, argc, argv, [&] { run(arguments); });
}

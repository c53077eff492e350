// SPDX-License-Identifier: Apache-2.0
//
// Tutorial description:
//
//     A path tracer that makes of the surface what its rays come near to, when they do, and forgets it.
//
//     The picture is made by a stream of patches whose sink is Embree (patchScene.h): at
//     first there is a box for each base face.  When a ray hits a box, the patch in it is made, with a
//     level for each edge that follows from its size in the picture; and patches that no ray has needed
//     for long are forgotten when they would take more memory than they may.  Since a patch is the same
//     bits whenever it is made, the picture does not depend on that; but if what most rays need is
//     forgotten each time, it takes long.
//
#include "patchScene.h"

#include "bfr_ext/patchStream.h"
#include "far_ext/executor.h"
#include "far_ext/topologyRefinerFactory.h"
#include "tools/mesh/fileError.h"
#include "tools/mesh/meshReader.h"
#include "tools/mesh/program.h"
#include "tools/mesh/topologyDescriptor.h"
#include "tools/render/camera.h"
#include "tools/render/pngFile.h"
#include "tools/render/unitSize.h"
#include "tools/render/viewOption.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>

namespace OpenSubdivHex::Tools {

namespace {

constexpr char kName[] = "osd_ext_2_2_stream";
constexpr float kPi = 3.14159265F;
constexpr Vec3 kSurfaceColor{0.62F, 0.25F, 0.12F};
constexpr Vec3 kGroundColor{0.55F, 0.55F, 0.55F};
constexpr Vec3 kSunLight{1.7F, 1.6F, 1.45F};
constexpr float kSunSize = 0.06F; // radius by distance
constexpr int kNumBounces = 3;    // of light that reaches the camera
constexpr float kStart = 1e-4F;   // of rays, from what they leave
constexpr int kLastLevel = 9;

struct Arguments {
    std::string input;
    std::string output;
    int width = 600;
    int height = 450;
    int numSamples = 16;
    double facetPixels = 1;
    double megabytes = 64;
    View view;
};

/// Numbers from 0 to 1, the same for the same sample of the same pixel.
class Random {
public:
    Random(int pixel, int sample)
        : _state(std::uint64_t(pixel) * 0x9e3779b97f4a7c15 + std::uint64_t(sample)) {}

    float Get() {
        // SplitMix64.
        std::uint64_t bits = _state += 0x9e3779b97f4a7c15;
        bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9;
        bits = (bits ^ (bits >> 27)) * 0x94d049bb133111eb;
        return float((bits ^ (bits >> 31)) >> 40) * 0x1p-24F;
    }

private:
    std::uint64_t _state;
};

/// Two directions that are at right angles to a third and to each other.
void findAxes(Vec3 direction, Vec3 *first, Vec3 *second) {
    Vec3 const other = std::fabs(direction.x) > 0.7F ? Vec3{0, 1, 0} : Vec3{1, 0, 0};
    *first = Normalize(Cross(direction, other));
    *second = Cross(direction, *first);
}

/// Light of the sky, when it is not the sun's.
Vec3 getSky(Vec3 direction) {
    return Mix({0.75F, 0.76F, 0.78F}, {0.42F, 0.55F, 0.80F}, std::fmax(direction.y, 0.0F));
}

/// The surface, and a plane below it.
class PathTracer {
public:
    PathTracer(PatchScene const &scene, float ground) : _scene(scene), _ground(ground) {}

    /// The light that comes to a place from a direction.
    Vec3 Trace(Vec3 origin, Vec3 direction, Random &random) const {
        Vec3 const sun = Normalize({0.45F, 0.8F, 0.55F});
        Vec3 light;
        Vec3 weight{1, 1, 1};
        for (int bounce = 0; bounce <= kNumBounces; ++bounce) {
            Vec3 point;
            Vec3 normal;
            Vec3 color;
            if (!findHit(origin, direction, &point, &normal, &color)) {
                return light + weight * getSky(direction);
            }
            weight = weight * color;
            origin = point + kStart * normal;
            Vec3 first;
            Vec3 second;
            findAxes(sun, &first, &second);
            float const radius = kSunSize * std::sqrt(random.Get());
            float const angle = 2 * kPi * random.Get();
            Vec3 const toSun = Normalize(sun + radius * std::cos(angle) * first +
                                         radius * std::sin(angle) * second);
            float const cosine = Dot(normal, toSun);
            if (cosine > 0 && !_scene.IsOccluded(origin, toSun, 1e6F)) {
                light = light + cosine * (weight * kSunLight);
            }
            // On: as the light of a matt surface is spread.
            findAxes(normal, &first, &second);
            float const height = random.Get();
            float const turn = 2 * kPi * random.Get();
            float const across = std::sqrt(height);
            direction =
                Normalize(across * std::cos(turn) * first + across * std::sin(turn) * second +
                          std::sqrt(1 - height) * normal);
        }
        return light;
    }

private:
    bool findHit(Vec3 origin, Vec3 direction, Vec3 *point, Vec3 *normal, Vec3 *color) const {
        PatchScene::Hit hit;
        bool const isSurface = _scene.Intersect(origin, direction, &hit);
        float const distance = (_ground - origin.y) / direction.y;
        if (direction.y < 0 && distance > 0 &&
            (!isSurface || distance < Dot(hit.point - origin, direction))) {
            *point = origin + distance * direction;
            *normal = {0, 1, 0};
            *color = kGroundColor;
            return true;
        }
        if (isSurface) {
            *point = hit.point;
            *normal = Dot(hit.normal, direction) > 0 ? -hit.normal : hit.normal;
            *color = kSurfaceColor;
        }
        return isSurface;
    }

    PatchScene const &_scene;
    float const _ground;
};

std::uint8_t toByte(float light) {
    float const mapped = 1 - std::exp(-1.1F * light);
    return std::uint8_t(std::lround(255 * std::pow(mapped, 1 / 2.2F)));
}

void run(Arguments const &arguments) {
    Mesh mesh = ReadInput(kName, arguments.input);
    std::vector<int> const shown = FindShownVertices(mesh);
    ScaleToUnitSize(shown, &mesh.positions);
    std::vector<float> const points = GatherPositions(shown, mesh.positions);
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
    FarExt::TopologyLevel const &base = refiner->GetLevel(0);
    Camera const camera(arguments.view, points, float(arguments.width) / float(arguments.height));

    // An edge becomes about two to the power of its level segments; a face is as fine as its edges.
    auto const getEdgeLevel = [&](int edge) {
        Far::ConstIndexArray const ends = base.GetEdgeVertices(edge);
        Vec3 const start = GetVec3(mesh.positions.data(), ends[0]);
        Vec3 const end = GetVec3(mesh.positions.data(), ends[1]);
        float const height = camera.GetPictureHeight(0.5F * (start + end));
        double const pixels =
            double(Length(end - start) / std::fmax(height, 1e-6F)) * arguments.height;
        double const level = std::ceil(std::log2(pixels / arguments.facetPixels + 1e-9));
        return int(std::min(std::max(level, 1.0), double(kLastLevel)));
    };
    auto const getFaceLevel = [&](int face) {
        int level = 0;
        for (int const edge : base.GetFaceEdges(face)) {
            level = std::max(level, getEdgeLevel(edge));
        }
        return level;
    };
    BfrExt::PatchStream<float> const stream(*factory,
                                            BfrExt::PatchLevels(getFaceLevel, getEdgeLevel));
    PatchScene const scene(stream, mesh.positions, std::size_t(arguments.megabytes * 1e6), [&] {
        std::fprintf(stderr,
                     "%s: warning: patches are made again and again, which takes long, since "
                     "--memory, %g megabytes, is less than what the picture needs\n",
                     kName, arguments.megabytes);
    });

    float ground = points[1];
    for (std::size_t i = 1; i < points.size(); i += 3) {
        ground = std::min(ground, points[i]);
    }
    PathTracer const tracer(scene, ground);
    Image image(arguments.width, arguments.height);
    FarExt::ParallelFor(arguments.height, [&](int y) {
        for (int x = 0; x < arguments.width; ++x) {
            int const pixel = y * arguments.width + x;
            Vec3 light;
            for (int sample = 0; sample < arguments.numSamples; ++sample) {
                Random random(pixel, sample);
                float const u = (float(x) + random.Get()) / float(arguments.width);
                float const v = (float(y) + random.Get()) / float(arguments.height);
                light =
                    light + tracer.Trace(camera.GetPosition(), camera.GetDirection(u, v), random);
            }
            light = (1 / float(arguments.numSamples)) * light;
            std::uint8_t *const bytes = image.GetPixel(x, y);
            bytes[0] = toByte(light.x);
            bytes[1] = toByte(light.y);
            bytes[2] = toByte(light.z);
        }
    });
    WritePng(image, arguments.output);
    PatchScene::Statistics const statistics = scene.GetStatistics();
    std::printf(
        "%lld of %d faces were needed, %lld patches made, %lld of them again, %lld forgotten, "
        "%lld triangles made, %.1f megabytes at most\n",
        static_cast<long long>(statistics.numFaces), base.GetNumFaces(),
        static_cast<long long>(statistics.numMade),
        static_cast<long long>(statistics.numMade - statistics.numFaces),
        static_cast<long long>(statistics.numForgotten),
        static_cast<long long>(statistics.numTriangles), double(statistics.peakMemory) / 1e6);
}

} // namespace

} // namespace OpenSubdivHex::Tools

int main(int argc, char **argv) {
    using namespace OpenSubdivHex::Tools;

    Arguments arguments;
    CLI::App app("Traces paths of light, with patches of a surface that are made when a ray needs "
                 "them.",
                 kName);
    app.add_option("INPUT", arguments.input, "Control mesh: .obj, .off or .ply")
        ->type_name("FILE")
        ->required();
    app.add_option("-o,--output", arguments.output, "Picture to write, a .png file")
        ->check(MakePngFile())
        ->type_name("FILE")
        ->required();
    app.add_option("--width", arguments.width, "Width of the picture in pixels")
        ->check(CLI::Range(1, 20000))
        ->capture_default_str();
    app.add_option("--height", arguments.height, "Height of the picture in pixels")
        ->check(CLI::Range(1, 20000))
        ->capture_default_str();
    app.add_option("--samples", arguments.numSamples, "Paths per pixel")
        ->check(CLI::Range(1, 65536))
        ->capture_default_str();
    app.add_option("--facet-pixels", arguments.facetPixels, "Length of a facet's sides in pixels")
        ->check(MakeRange(0.01, 1000))
        ->capture_default_str();
    app.add_option(
           "--memory", arguments.megabytes,
           "Megabytes that patches may take; with less than the picture needs they are made "
           "again and again, which takes long and is said on standard error")
        ->check(MakeRange(0, 1e6))
        ->capture_default_str();
    AddViewOption(app, &arguments.view);
    app.footer("Exit status: 0 success, 1 bad input or failed output, 2 bad usage.");
    return RunProgram(app, argc, argv, [&] { run(arguments); });
}

// SPDX-License-Identifier: Apache-2.0
//
// Tutorial description:
//
//     Rays: what they hit is a coarse tessellation, what is shaded is the surface itself.
//
//     Each face is cut into some triangles, for Embree (facetScene.h), and has its patch points made once.
//     A ray that hits a triangle learns the face and (u, v); BfrExt::Surface::Evaluate() gives point and
//     derivatives of the surface there, and du x dv is the normal.  So pictures have no facets but in the
//     outline.
//
//     With --bfr OpenSubdiv's Catmull-Clark surface stands beside, by its own Bfr::Surface.  The program is
//     the same for both, but for tessellate(): evaluating all points of a tessellation is one call here.
//
#include "facetScene.h"

#include "bfr_ext/surfaceFactory.h"
#include "far_ext/executor.h"
#include "far_ext/topologyRefinerFactory.h"
#include "tools/mesh/catmarkRefiner.h"
#include "tools/mesh/fileError.h"
#include "tools/mesh/meshReader.h"
#include "tools/mesh/meshText.h"
#include "tools/mesh/program.h"
#include "tools/mesh/topologyDescriptor.h"
#include "tools/render/camera.h"
#include "tools/render/pngFile.h"
#include "tools/render/unitSize.h"
#include "tools/render/viewOption.h"

#include <opensubdiv/bfr/refinerSurfaceFactory.h>
#include <opensubdiv/bfr/surface.h>
#include <opensubdiv/bfr/tessellation.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>

namespace OpenSubdivHex::Tools {

namespace {

namespace Bfr = OpenSubdiv::Bfr;

constexpr char kName[] = "bfr_ext_1_4_rays";

struct Arguments {
    std::string input;
    std::string output;
    int width = 600;
    int height = 450;
    int numSamples = 2; // along each side of a pixel
    int rate = 8;
    int numThreads = 0;
    bool hasBfr = false;
    View view;
};

/// Writes the facets of a tessellation, with memory for their points.
void setFacets(Bfr::Tessellation const &tessellation, FaceFacets *face) {
    face->parameterization = BfrExt::Parameterization(tessellation.GetParameterization());
    face->coords.resize(2 * std::size_t(tessellation.GetNumCoords()));
    tessellation.GetCoords(face->coords.data());
    for (std::size_t i = 0; i < face->coords.size(); i += 2) {
        face->parameterization.ConvertToPlane(&face->coords[i], &face->coords[i]);
    }
    face->facets.resize(3 * std::size_t(tessellation.GetNumFacets()));
    tessellation.GetFacets(face->facets.data());
    face->points.resize(3 * std::size_t(tessellation.GetNumCoords()));
}

/// Cuts a face by a rate for all edges.
void tessellate(BfrExt::Surface<float> const &surface, int rate, float const *controlPoints,
                FaceFacets *face) {
    Bfr::Tessellation const tessellation(surface.GetParameterization(), rate);
    setFacets(tessellation, face);
    surface.Evaluate(tessellation, controlPoints, 3, face->points.data(), 3);
}

void tessellate(Bfr::Surface<float> const &surface, int rate, float const *patchPoints,
                FaceFacets *face) {
    Bfr::Tessellation const tessellation(surface.GetParameterization(), rate);
    setFacets(tessellation, face);
    std::vector<float> coords(2 * std::size_t(tessellation.GetNumCoords()));
    tessellation.GetCoords(coords.data());
    for (std::size_t i = 0; i < std::size_t(tessellation.GetNumCoords()); ++i) {
        surface.Evaluate(&coords[2 * i], patchPoints, 3, &face->points[3 * i]);
    }
}

/// \brief The surfaces of all faces, with their patch points.
///
/// \tparam SURFACE  BfrExt::Surface<float> or Bfr::Surface<float>
template <typename SURFACE>
struct Surfaces {
    std::vector<SURFACE> surfaces; // invalid ones of holes
    std::vector<std::vector<float>> patchPoints;

    Surfaces() = default;
    /// \param init  makes the surface of a face that is no hole: init(face, surface)
    template <typename INIT>
    Surfaces(INIT const &init, Mesh const &mesh)
        : surfaces(std::size_t(mesh.GetNumFaces())), patchPoints(surfaces.size()) {
        std::vector<bool> isHole(surfaces.size());
        for (int const hole : mesh.tags.holes) {
            isHole[std::size_t(hole)] = true;
        }
        for (std::size_t face = 0; face < surfaces.size(); ++face) {
            if (!isHole[face]) {
                init(int(face), &surfaces[face]);
            }
        }
        FarExt::ParallelFor(mesh.GetNumFaces(), [&](int face) {
            SURFACE const &surface = surfaces[std::size_t(face)];
            if (surface.IsValid()) {
                std::vector<float> &points = patchPoints[std::size_t(face)];
                points.resize(3 * std::size_t(surface.GetNumPatchPoints()));
                surface.PreparePatchPoints(mesh.positions.data(), 3, points.data(), 3);
            }
        });
    }

    double GetMegabytes() const {
        std::size_t size = 0;
        for (auto const &points : patchPoints) {
            size += points.size() * sizeof(float);
        }
        return double(size) / 1e6;
    }
};

struct ShadingPoint {
    Vec3 point;
    Vec3 normal;
};

template <typename FUNCTION>
double measure(FUNCTION const &function) {
    auto const start = std::chrono::steady_clock::now();
    function();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
        .count();
}

/// Light that leaves the surface towards the camera; the sun's where nothing is in the way.
Vec3 shade(FacetScene const &scene, FacetScene::Hit const &hit, ShadingPoint const &surface,
           Camera const &camera) {
    constexpr Vec3 kColor{0.62F, 0.25F, 0.12F};
    constexpr Vec3 kSky{0.50F, 0.56F, 0.66F};
    constexpr Vec3 kGround{0.22F, 0.20F, 0.18F};
    Vec3 const toCamera = Normalize(camera.GetPosition() - surface.point);
    // Both sides are lit.
    Vec3 const normal = Dot(surface.normal, toCamera) < 0 ? -surface.normal : surface.normal;
    Vec3 const toSun = Normalize(camera.GetUp() - camera.GetRight() + 0.8F * toCamera);
    Vec3 light = kColor * Mix(kGround, kSky, 0.5F + 0.5F * normal.y);
    float const cosine = Dot(normal, toSun);
    // From a little above the facet, which may lie below or above the surface.
    Vec3 const origin = hit.point + 0.2F * hit.side * normal;
    if (cosine > 0 && !scene.IsOccluded(origin, toSun)) {
        float const highlight =
            std::pow(std::fmax(Dot(normal, Normalize(toSun + toCamera)), 0.0F), 60.0F);
        light = light + cosine * (1.1F * kColor + 0.5F * highlight * Vec3{1, 1, 1});
    }
    return light;
}

std::uint8_t toByte(float light) {
    return std::uint8_t(std::lround(255 * std::pow(std::fmin(light, 1.0F), 1 / 2.2F)));
}

/// Draws the picture of the surfaces that init(face, surface) makes; raises *distance to the largest one
/// of a hit from the surface's point, in sides of the facet.
template <typename SURFACE, typename INIT>
Image draw(char const *name, INIT const &init, Mesh const &mesh, Camera const &camera,
           Arguments const &arguments, float *distance) {
    Surfaces<SURFACE> surfaces;
    double const preparing = measure([&] { surfaces = Surfaces<SURFACE>(init, mesh); });
    std::vector<FaceFacets> facets(surfaces.surfaces.size());
    double const tessellating = measure([&] {
        FarExt::ParallelFor(mesh.GetNumFaces(), [&](int number) {
            auto const face = std::size_t(number);
            if (surfaces.surfaces[face].IsValid()) {
                // Control points are the first ones of patch points.
                tessellate(surfaces.surfaces[face], arguments.rate,
                           surfaces.patchPoints[face].data(), &facets[face]);
            }
        });
    });
    std::optional<FacetScene> scene;
    double const building = measure([&] { scene.emplace(facets); });

    // All rays, by sample from the upper left.
    int const numColumns = arguments.width * arguments.numSamples;
    int const numRows = arguments.height * arguments.numSamples;
    std::vector<FacetScene::Hit> hits(std::size_t(numColumns) * std::size_t(numRows));
    double const tracing = measure([&] {
        FarExt::ParallelFor(numRows, [&](int y) {
            for (int x = 0; x < numColumns; ++x) {
                hits[std::size_t(y) * std::size_t(numColumns) + std::size_t(x)] = scene->Intersect(
                    camera.GetPosition(), camera.GetDirection((float(x) + 0.5F) / float(numColumns),
                                                              (float(y) + 0.5F) / float(numRows)));
            }
        });
    });

    // The surface where they hit it.
    std::vector<ShadingPoint> points(hits.size());
    double const evaluating = measure([&] {
        FarExt::ParallelFor(numRows, [&](int y) {
            auto const begin = std::size_t(y) * std::size_t(numColumns);
            for (std::size_t i = begin; i < begin + std::size_t(numColumns); ++i) {
                if (hits[i].face < 0) {
                    continue;
                }
                auto const face = std::size_t(hits[i].face);
                float p[3], du[3], dv[3];
                surfaces.surfaces[face].Evaluate(hits[i].uv, surfaces.patchPoints[face].data(), 3,
                                                 p, du, dv);
                points[i] = {GetVec3(p, 0), Normalize(Cross(GetVec3(du, 0), GetVec3(dv, 0)))};
            }
        });
    });
    std::size_t numHits = 0;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        if (hits[i].face >= 0) {
            ++numHits;
            *distance = std::max(*distance, Length(points[i].point - hits[i].point) / hits[i].side);
        }
    }
    std::printf("%s: %d faces prepared in %.1f ms, %.1f MB; cut in %.1f ms, built in %.1f ms; "
                "%zu rays traced in %.0f ms; %zu hits evaluated in %.1f ms, %.0f ns each\n",
                name, mesh.GetNumFaces(), preparing, surfaces.GetMegabytes(), tessellating,
                building, hits.size(), tracing, numHits, evaluating,
                1e6 * evaluating / double(std::max(numHits, std::size_t(1))));

    Image image(arguments.width, arguments.height);
    FarExt::ParallelFor(arguments.height, [&](int y) {
        for (int x = 0; x < arguments.width; ++x) {
            Vec3 sum;
            for (int sample = 0; sample < arguments.numSamples * arguments.numSamples; ++sample) {
                int const row = y * arguments.numSamples + sample / arguments.numSamples;
                int const column = x * arguments.numSamples + sample % arguments.numSamples;
                auto const i = std::size_t(row) * std::size_t(numColumns) + std::size_t(column);
                sum = sum + (hits[i].face < 0 ? Vec3{1, 1, 1}
                                              : shade(*scene, hits[i], points[i], camera));
            }
            Vec3 const light = (1 / float(arguments.numSamples * arguments.numSamples)) * sum;
            std::uint8_t *const bytes = image.GetPixel(x, y);
            bytes[0] = toByte(light.x);
            bytes[1] = toByte(light.y);
            bytes[2] = toByte(light.z);
        }
    });
    return image;
}

void run(Arguments const &arguments) {
    FarExt::ExecutorScope const threads(nullptr, arguments.numThreads);
    Mesh mesh = ReadInput(kName, arguments.input);
    std::vector<int> const shown = FindShownVertices(mesh);
    ScaleToUnitSize(shown, &mesh.positions);
    Camera const camera(arguments.view, GatherPositions(shown, mesh.positions),
                        float(arguments.width) / float(arguments.height));
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
    float distance = 0;
    auto const init = [&](int face, BfrExt::Surface<float> *surface) {
        if (!factory->InitVertexSurface(face, surface, &status)) {
            throw FileError(arguments.input, status.GetErrorMessage());
        }
    };
    Image picture =
        draw<BfrExt::Surface<float>>("hexagonal", init, mesh, camera, arguments, &distance);
    if (bfrRefiner) {
        Bfr::RefinerSurfaceFactory<> const bfrFactory(*bfrRefiner);
        auto const bfrInit = [&](int face, Bfr::Surface<float> *surface) {
            if (!bfrFactory.InitVertexSurface(face, surface)) {
                throw FileError(arguments.input,
                                "face " + std::to_string(face) + " has no surface in Bfr");
            }
        };
        Image const left = picture;
        picture = Image(2 * arguments.width, arguments.height);
        PasteImage(left, 0, 0, &picture);
        PasteImage(draw<Bfr::Surface<float>>("Bfr's Catmull-Clark", bfrInit, mesh, camera,
                                             arguments, &distance),
                   arguments.width, 0, &picture);
    }
    WritePng(picture, arguments.output);
    std::printf("wrote %s: %d pictures, points within %.1f of a facet's side from the rays' hits\n",
                EscapeControls(arguments.output).c_str(), arguments.hasBfr ? 2 : 1,
                std::ceil(10 * double(distance)) / 10);
}

} // namespace

} // namespace OpenSubdivHex::Tools

int main(int argc, char **argv) {
    using namespace OpenSubdivHex::Tools;

    Arguments arguments;
    CLI::App app("Traces rays, and shades the surface itself where they hit its facets.", kName);
    app.add_option("INPUT", arguments.input, "Control mesh: .obj, .off or .ply")
        ->type_name("FILE")
        ->required();
    app.add_option("-o,--output", arguments.output, "Picture to write, a .png file")
        ->check(MakePngFile())
        ->type_name("FILE")
        ->required();
    app.add_option("--width", arguments.width, "Width of the picture in pixels")
        ->check(CLI::Range(1, 4000))
        ->capture_default_str();
    app.add_option("--height", arguments.height, "Height of the picture in pixels")
        ->check(CLI::Range(1, 4000))
        ->capture_default_str();
    app.add_option("--samples", arguments.numSamples, "Rays along each side of a pixel")
        ->check(CLI::Range(1, 4))
        ->capture_default_str();
    app.add_option("--rate", arguments.rate, "Segments that each edge is cut into")
        ->check(CLI::Range(1, 256))
        ->capture_default_str();
    app.add_option("--threads", arguments.numThreads, "Number of threads; 0: the machine's")
        ->check(CLI::Range(0, 1024))
        ->capture_default_str();
    app.add_flag("--bfr", arguments.hasBfr,
                 "Draws OpenSubdiv's Catmull-Clark surface beside, for meshes of quads");
    AddViewOption(app, &arguments.view);
    app.footer("Exit status: 0 success, 1 bad input or failed output, 2 bad usage.");
    return RunProgram(app, argc, argv, [&] { run(arguments); });
}

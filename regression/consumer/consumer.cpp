// SPDX-License-Identifier: Apache-2.0
//
// A program that already refines a cube with Far and Osd, and now with the hexagonal scheme too.
// Exits with 1 when a result is not what the schemes prescribe.

#include <bfr_ext/surfaceFactory.h>
#include <far_ext/primvarRefiner.h>
#include <far_ext/stencilTableFactory.h>
#include <far_ext/topologyRefinerFactory.h>
#include <far_ext/version.h>
#include <osd_ext/polygonIndices.h>
#include <osd_ext/stencilEvaluator.h>

#include <opensubdiv/far/stencilTableFactory.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefinerFactory.h>
#include <opensubdiv/osd/cpuEvaluator.h>
#include <opensubdiv/osd/cpuVertexBuffer.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <vector>

namespace Far = OpenSubdiv::Far;
namespace Osd = OpenSubdiv::Osd;
namespace Sdc = OpenSubdiv::Sdc;
namespace FarExt = OpenSubdivHex::FarExt;
namespace OsdExt = OpenSubdivHex::OsdExt;
namespace BfrExt = OpenSubdivHex::BfrExt;

namespace {

constexpr int kLevel = 2;

constexpr int kVertsPerFace[] = {4, 4, 4, 4, 4, 4};
constexpr int kFaceVerts[] = {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4,
                              2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5};
constexpr float kPositions[] = {-1, -1, -1, 1, -1, -1, -1, 1, -1, 1, 1, -1,
                                -1, -1, 1,  1, -1, 1,  -1, 1, 1,  1, 1, 1};

struct Point {
    void Clear() { x = y = z = 0; }
    void AddWithWeight(Point const &p, float weight) {
        x += weight * p.x;
        y += weight * p.y;
        z += weight * p.z;
    }
    float x = 0, y = 0, z = 0;
};

int numFailures = 0;

void expect(bool holds, char const *what) {
    std::printf("%-4s %s\n", holds ? "ok" : "FAIL", what);
    numFailures += holds ? 0 : 1;
}

// Unchanged code of the program: it serves a table of either scheme.
std::vector<float> evaluate(Far::StencilTable const &table) {
    int const numVertices = table.GetNumControlVertices();
    std::unique_ptr<Osd::CpuVertexBuffer> src(Osd::CpuVertexBuffer::Create(3, numVertices));
    std::unique_ptr<Osd::CpuVertexBuffer> dst(
        Osd::CpuVertexBuffer::Create(3, table.GetNumStencils()));
    src->UpdateData(kPositions, 0, numVertices);
    Osd::BufferDescriptor const desc(0, 3, 3);
    Osd::CpuEvaluator::EvalStencils(src.get(), desc, dst.get(), desc, &table);
    float const *values = dst->BindCpuBuffer();
    return std::vector<float>(values, values + 3 * std::size_t(table.GetNumStencils()));
}

float largest(std::vector<float> const &values) {
    float result = 0;
    for (float value : values) {
        result = std::max(result, std::abs(value));
    }
    return result;
}

void checkCatmark(Far::TopologyRefiner &refiner) {
    refiner.RefineUniform(Far::TopologyRefiner::UniformOptions(kLevel));
    Far::StencilTableFactory::Options options;
    options.generateIntermediateLevels = false;
    std::unique_ptr<Far::StencilTable const> table(
        Far::StencilTableFactory::Create(refiner, options));
    std::vector<float> const values = evaluate(*table);
    expect(values.size() == 3 * 98, "Catmull-Clark: 98 vertices at level 2");
    expect(largest(values) < 1, "Catmull-Clark: all within the cube");
}

std::vector<Point> interpolate(FarExt::TopologyRefiner const &refiner) {
    std::vector<Point> points(8);
    for (std::size_t i = 0; i < points.size(); ++i) {
        points[i].x = kPositions[3 * i];
        points[i].y = kPositions[3 * i + 1];
        points[i].z = kPositions[3 * i + 2];
    }
    FarExt::PrimvarRefiner primvarRefiner(refiner);
    for (int level = 1; level <= refiner.GetMaxLevel(); ++level) {
        std::vector<Point> next(std::size_t(refiner.GetLevel(level).GetNumVertices()));
        primvarRefiner.Interpolate(level, points, next);
        points.swap(next);
    }
    return points;
}

void checkHex(Far::TopologyRefiner const &base) {
    FarExt::CallStatus status;
    std::unique_ptr<FarExt::TopologyRefiner> const refiner =
        FarExt::TopologyRefinerFactory::Create(base, &status);
    if (!refiner || !refiner->RefineUniform({kLevel}, &status)) {
        expect(false, status.GetErrorMessage().c_str());
        return;
    }
    FarExt::TopologyLevel const &level = refiner->GetLevel(kLevel);
    expect(level.GetNumVertices() == 128, "hexagonal: 128 vertices at level 2");
    expect(level.GetNumFaces() == 66, "hexagonal: 66 faces at level 2");

    FarExt::StencilTableFactory::Options options;
    options.generateIntermediateLevels = false;
    std::unique_ptr<Far::StencilTable const> const table =
        FarExt::StencilTableFactory::Create(*refiner, options);
    std::vector<float> const values = evaluate(*table);
    std::vector<Point> const points = interpolate(*refiner);
    expect(values.size() == 3 * points.size(), "hexagonal: one stencil per vertex");
    float difference = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        difference = std::max({difference, std::abs(values[3 * i] - points[i].x),
                               std::abs(values[3 * i + 1] - points[i].y),
                               std::abs(values[3 * i + 2] - points[i].z)});
    }
    expect(difference < 1e-6f, "hexagonal: stencils equal primvar refinement");

    // Corner (1, 1, 1): its level 1 neighbours are (1/2, 1/2, 1) and permutations, so that it goes
    // to 3/4 (1, 1, 1).
    options.generateIntermediateLevels = true;
    std::vector<float> const all =
        evaluate(*FarExt::StencilTableFactory::Create(*refiner, options));
    expect(all.size() == 3 * (32 + 128), "hexagonal: 32 + 128 stencils in levels 1 and 2");
    bool isRight = true;
    for (int i = 21; i < 24; ++i) {
        isRight = isRight && std::abs(all[std::size_t(i)] - 0.75f) < 1e-6f;
    }
    expect(isRight, "hexagonal: the corner goes to 3/4 of itself");

    auto const buffer = OsdExt::CreateInPlaceBuffer<Osd::CpuVertexBuffer>(*table, 3);
    buffer->UpdateData(kPositions, 0, 8);
    bool const isEvaluated = OsdExt::EvalStencilsInPlace<Osd::CpuEvaluator>(*table, buffer.get());
    expect(isEvaluated && std::equal(values.begin(), values.end(), buffer->BindCpuBuffer() + 3 * 8),
           "hexagonal: in place as from buffer to buffer");
    // n - 2 triangles per face: the corners less two per face.
    expect(OsdExt::CreateTriangleIndices(level).GetNumTriangles() ==
               level.GetNumFaceVertices() - 2 * level.GetNumFaces(),
           "hexagonal: n - 2 triangles per face");

    // The limit of a face's centre is its centroid.
    BfrExt::Surface<float> surface;
    auto const factory = BfrExt::SurfaceFactory::Create(*refiner);
    if (!factory || !factory->InitVertexSurface(0, &surface)) {
        expect(false, "hexagonal: a face has a surface");
        return;
    }
    std::vector<float> patchPoints(3 * std::size_t(surface.GetNumPatchPoints()));
    surface.PreparePatchPoints(kPositions, 3, patchPoints.data(), 3);
    float uv[2];
    surface.GetParameterization().GetCenterCoord(uv);
    float point[3];
    surface.Evaluate(uv, patchPoints.data(), 3, point);
    expect(std::abs(point[0]) < 1e-6f && std::abs(point[1]) < 1e-6f &&
               std::abs(point[2] + 1) < 1e-3f,
           "hexagonal: the surface of a face has its centroid");
}

} // namespace

static_assert(OPENSUBDIVHEX_VERSION_NUMBER >= 100, "the release that the package asks for");

int main() {
    expect(std::strcmp(OPENSUBDIVHEX_VERSION, PACKAGE_VERSION) == 0,
           "the headers have the version of the package");
    Far::TopologyDescriptor descriptor;
    descriptor.numVertices = 8;
    descriptor.numFaces = 6;
    descriptor.numVertsPerFace = kVertsPerFace;
    descriptor.vertIndicesPerFace = kFaceVerts;

    using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
    std::unique_ptr<Far::TopologyRefiner> const refiner(
        Factory::Create(descriptor, Factory::Options(Sdc::SCHEME_CATMARK, Sdc::Options())));
    if (!refiner) {
        expect(false, "Far takes the cube");
        return 1;
    }
    checkHex(*refiner);
    checkCatmark(*refiner);
    return numFailures == 0 ? 0 : 1;
}

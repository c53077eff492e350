// SPDX-License-Identifier: Apache-2.0
//
// Tutorial description:
//
//     Draws the patches of a mesh: OpenSubdiv's shaders tessellate them on the device.
//
//     FarExt::PatchTableFactory makes a Far::PatchTable, and Osd::GLPatchTable puts it into buffers of
//     OpenGL.  Osd::GLSLPatchShaderSource has the shaders; they ask the program for some functions, its camera
//     among them.  In each frame of an animation only the points of the patches are made anew.
//
//     The program has no window: it writes a picture.  usage: osd_ext_3_2_draw MESH PICTURE.png
//
#include "far_ext/patchTableFactory.h"
#include "far_ext/topologyRefinerFactory.h"
#include "osd_ext/cpuEvaluator.h"
#include "tools/gl/glObjects.h"
#include "tools/gl/offscreen.h"
#include "tools/gl/orbitCamera.h"
#include "tools/gl/patchDrawing.h"
#include "tools/mesh/meshReader.h"
#include "tools/mesh/topologyDescriptor.h"
#include "tools/render/pngFile.h"

#include <opensubdiv/osd/cpuVertexBuffer.h>
#include <opensubdiv/osd/glPatchTable.h>
#include <opensubdiv/osd/glslPatchShaderSource.h>

#include <glm/gtc/type_ptr.hpp>

#include <cstdio>
#include <exception>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

using namespace OpenSubdivHex;
namespace Osd = OpenSubdiv::Osd;

namespace {

constexpr int kWidth = 800;
constexpr int kHeight = 600;

// Declarations that OpenSubdiv's shaders need.
constexpr char kClient[] = R"(
uniform mat4 view;
uniform mat4 lens;
uniform int firstPatch; // of the draw call
mat4 OsdModelViewMatrix() { return view; }
mat4 OsdProjectionMatrix() { return lens; }
mat4 OsdModelViewProjectionMatrix() { return lens * view; }
float OsdTessLevel() { return 8.0; } // segments of each side of a patch
int OsdGregoryQuadOffsetBase() { return 0; }
int OsdPrimitiveIdBase() { return firstPatch; }
int OsdBaseVertex() { return 0; }
)";

// Their output is the input here: place and normal in the space of the eye, and (s, t) in the patch.
constexpr char kFragmentShader[] = R"(
in block { OutputVertex v; } inpt;
out vec4 color;

void main() {
    vec3 toEye = normalize(-inpt.v.position.xyz);
    float light = abs(dot(normalize(inpt.v.normal), toEye));
    vec2 st = inpt.v.tessCoord;
    vec2 pixels = min(st, 1.0 - st) / fwidth(st);
    vec3 paint = min(pixels.x, pixels.y) < 0.6 ? vec3(0.25, 0.20, 0.15) : vec3(0.92, 0.72, 0.46);
    color = vec4(paint * (0.25 + 0.75 * light), 1.0);
}
)";

std::unique_ptr<Far::PatchTable const> makePatches(Tools::Mesh const &mesh) {
    FarExt::TopologyRefinerFactory::Options options;
    options.hexSchemeOptions.faceMask =
        FarExt::FaceMask::Smooth; // patches are closest to this surface
    FarExt::CallStatus status;
    auto const refiner = FarExt::TopologyRefinerFactory::Create(Tools::DescribeTopology(mesh),
                                                                Sdc::Options(), options, &status);
    FarExt::PatchTableFactory::Options const patchOptions(1); // the faces of level 1
    std::unique_ptr<Far::PatchTable const> table;
    if (refiner && refiner->RefineUniform(patchOptions.GetRefineUniformOptions(), &status)) {
        table = FarExt::PatchTableFactory::Create(*refiner, patchOptions, &status);
    }
    if (!table) {
        throw std::runtime_error(status.GetErrorMessage());
    }
    return table;
}

// The control vertices, and behind them the points of patches.
std::unique_ptr<Osd::CpuVertexBuffer> evaluate(Far::PatchTable const &table,
                                               Tools::Mesh const &mesh) {
    int const numControl = mesh.GetNumVertices();
    std::unique_ptr<Osd::CpuVertexBuffer> points(
        Osd::CpuVertexBuffer::Create(3, numControl + table.GetNumLocalPoints()));
    points->UpdateData(mesh.positions.data(), 0, numControl);
    Osd::BufferDescriptor const control(0, 3, 3);
    Osd::BufferDescriptor const local(3 * numControl, 3, 3);
    OsdExt::CpuEvaluator::EvalStencils(points.get(), control, points.get(), local,
                                       table.GetLocalPointStencilTable());
    return points;
}

Tools::ViewProgram makeProgram() {
    using Source = Osd::GLSLPatchShaderSource;
    auto const type = Far::PatchDescriptor::GREGORY_BASIS;
    std::string const head = "#version 430\n" + Source::GetCommonShaderSource() + kClient;
    std::string const vertex = head + Source::GetVertexShaderSource(type);
    std::string const control = head + Source::GetTessControlShaderSource(type);
    std::string const evaluation = head + Source::GetTessEvalShaderSource(type);
    std::string const fragment = head + kFragmentShader;
    return Tools::ViewProgram({{GL_VERTEX_SHADER, {vertex.c_str()}},
                               {GL_TESS_CONTROL_SHADER, {control.c_str()}},
                               {GL_TESS_EVALUATION_SHADER, {evaluation.c_str()}},
                               {GL_FRAGMENT_SHADER, {fragment.c_str()}}});
}

void draw(Far::PatchTable const &patches, Osd::CpuVertexBuffer &points,
          Tools::OrbitCamera const &camera) {
    // Made once, and kept while the mesh moves.
    std::unique_ptr<Osd::GLPatchTable> const table(Osd::GLPatchTable::Create(&patches));
    Tools::ViewProgram const program = makeProgram();

    // Each frame has new points.
    Tools::GlArray pointArray;
    float const *const first = points.BindCpuBuffer();
    pointArray.Assign(std::vector<float>(first, first + 3 * points.GetNumVertices()));

    glViewport(0, 0, kWidth, kHeight);
    glClearColor(1, 1, 1, 1);
    glEnable(GL_DEPTH_TEST);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    program.Use();
    glm::mat4 const view = camera.GetView();
    glm::mat4 const lens = camera.GetLens(float(kWidth) / kHeight);
    glUniformMatrix4fv(program["view"], 1, GL_FALSE, glm::value_ptr(view));
    glUniformMatrix4fv(program["lens"], 1, GL_FALSE, glm::value_ptr(lens));
    glUniform1i(program["OsdPatchParamBuffer"], 0);
    GLuint vertexArray = 0;
    glGenVertexArrays(1, &vertexArray);
    glBindVertexArray(vertexArray);
    glBindBuffer(GL_ARRAY_BUFFER, pointArray.BindVBO());
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
    Tools::DrawPatches(*table, program["firstPatch"]);
    glDeleteVertexArrays(1, &vertexArray);
}

int countDrawn(Tools::Image &image) {
    int count = 0;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            std::uint8_t const *const pixel = image.GetPixel(x, y);
            count += pixel[0] != 255 || pixel[1] != 255 || pixel[2] != 255;
        }
    }
    return count;
}

void run(std::string const &input, std::string const &output) {
    Tools::Mesh const mesh = Tools::ReadMesh(input);
    std::unique_ptr<Far::PatchTable const> const patches = makePatches(mesh);
    std::unique_ptr<Osd::CpuVertexBuffer> const points = evaluate(*patches, mesh);
    Tools::Offscreen const offscreen(kWidth, kHeight);
    draw(*patches, *points, Tools::OrbitCamera::Around(mesh.positions));
    Tools::Image image = offscreen.Read();
    Tools::WritePng(image, output);
    std::printf("%d patches, %.0f %% of the picture\n", patches->GetNumPatchesTotal(),
                100.0 * countDrawn(image) / (kWidth * kHeight));
}

} // namespace

int main(int argc, char **argv) {
    if (argc != 3) {
        std::fprintf(stderr, "usage: osd_ext_3_2_draw MESH PICTURE.png\n");
        return 2;
    }
    try {
        run(argv[1], argv[2]);
    } catch (std::exception const &error) {
        std::fprintf(stderr, "osd_ext_3_2_draw: %s\n", error.what());
        return 1;
    }
    return 0;
}

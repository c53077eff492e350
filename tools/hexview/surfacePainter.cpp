// SPDX-License-Identifier: Apache-2.0
#include "surfacePainter.h"

#include "shaders.h"

#include <opensubdiv/osd/glslPatchShaderSource.h>

#include <glm/gtc/type_ptr.hpp>

#include <algorithm>

namespace OpenSubdivHex::Tools {

SurfacePainter::SurfacePainter()
    : _surfaceProgram({{GL_VERTEX_SHADER, {kSurfaceVertexShader}},
                       {GL_FRAGMENT_SHADER, {kVersion, kShading, kSurfaceFragmentShader}}}),
      _edgeProgram(
          {{GL_VERTEX_SHADER, {kEdgeVertexShader}}, {GL_FRAGMENT_SHADER, {kEdgeFragmentShader}}}),
      _controlProgram({{GL_VERTEX_SHADER, {kControlVertexShader}},
                       {GL_FRAGMENT_SHADER, {kControlFragmentShader}}}) {
    glGenVertexArrays(1, &_vertexArray);
}

SurfacePainter::~SurfacePainter() { glDeleteVertexArrays(1, &_vertexArray); }

void SurfacePainter::Draw(ViewedSurface &surface, OrbitCamera const &camera,
                          DrawSettings const &settings, int width, int height) {
    glViewport(0, 0, width, height);
    glClearColor(1, 1, 1, 1);
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_TRUE);
    glDisable(GL_CULL_FACE);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glBindVertexArray(_vertexArray);
    glm::mat4 const projection = camera.GetProjection(float(width) / float(std::max(height, 1)));
    PatchView const *const patches = surface.GetPatches();
    if (settings.hasFaces && patches) {
        drawPatches(*patches, camera, settings, width, height);
    } else if (settings.hasFaces) {
        surface.Bind();
        _surfaceProgram.Use();
        glUniformMatrix4fv(_surfaceProgram["projection"], 1, GL_FALSE, glm::value_ptr(projection));
        setShading(_surfaceProgram, camera, settings.shading);
        // A pixel of an edge is up to one beside the faces that it lies between: where these are steep,
        // they would hide it.
        glEnable(GL_POLYGON_OFFSET_FILL);
        glPolygonOffset(1, 1);
        glDrawArrays(GL_TRIANGLES, 0, 3 * surface.GetNumTriangles());
        glDisable(GL_POLYGON_OFFSET_FILL);
    }
    if (settings.hasEdges && !patches) {
        surface.Bind();
        surface.BindEdges();
        _edgeProgram.Use();
        glUniformMatrix4fv(_edgeProgram["projection"], 1, GL_FALSE, glm::value_ptr(projection));
        glUniform4f(_edgeProgram["lineColor"], 0.25f, 0.20f, 0.15f, 1);
        glDrawArrays(GL_LINES, 0, 2 * surface.GetNumEdges());
    }
    if (settings.hasControlMesh) {
        drawControlMesh(surface, projection, settings.chosenVertex);
    }
    glBindVertexArray(0);
    glUseProgram(0);
}

void SurfacePainter::setShading(ViewProgram const &program, OrbitCamera const &camera,
                                Shading shading) {
    glUniform3fv(program["eye"], 1, glm::value_ptr(camera.GetEye()));
    glUniform3fv(program["up"], 1, glm::value_ptr(camera.GetUp()));
    glUniform1f(program["size"], camera.size);
    glUniform1i(program["shading"], int(shading));
}

// OpenSubdiv's shaders take a rate, or segments for the height of the picture, which is 2 in the cube of OpenGL.
void SurfacePainter::drawPatches(PatchView const &patches, OrbitCamera const &camera,
                                 DrawSettings const &settings, int width, int height) {
    bool const isByPixels = settings.patches.isByPixels;
    std::unique_ptr<ViewProgram> &program = _patchPrograms[isByPixels ? 1 : 0];
    if (!program) {
        using Source = OpenSubdiv::Osd::GLSLPatchShaderSource;
        auto const type = OpenSubdiv::Far::PatchDescriptor::GREGORY_BASIS;
        std::string const head = std::string(kVersion) +
                                 (isByPixels ? "#define OSD_ENABLE_SCREENSPACE_TESSELLATION\n"
                                               "#define OSD_FRACTIONAL_EVEN_SPACING\n"
                                             : "") +
                                 "#define OSD_COMPUTE_NORMAL_DERIVATIVES\n" +
                                 Source::GetCommonShaderSource() + kPatchClient;
        std::string const vertex = head + Source::GetVertexShaderSource(type);
        std::string const control = head + Source::GetTessControlShaderSource(type);
        std::string const evaluation = head + Source::GetTessEvalShaderSource(type);
        std::string const fragment = head + kShading + kPatchFragmentShader;
        program = std::make_unique<ViewProgram>(
            std::vector<ViewProgram::Shader>{{GL_VERTEX_SHADER, {vertex.c_str()}},
                                             {GL_TESS_CONTROL_SHADER, {control.c_str()}},
                                             {GL_TESS_EVALUATION_SHADER, {evaluation.c_str()}},
                                             {GL_FRAGMENT_SHADER, {fragment.c_str()}}});
    }
    program->Use();
    setShading(*program, camera, settings.shading);
    glUniformMatrix4fv((*program)["view"], 1, GL_FALSE, glm::value_ptr(camera.GetView()));
    float const aspect = float(width) / float(std::max(height, 1));
    glUniformMatrix4fv((*program)["lens"], 1, GL_FALSE, glm::value_ptr(camera.GetLens(aspect)));
    glUniform1f((*program)["rate"], isByPixels ? float(height) / 2 / settings.patches.edgePixels
                                               : settings.patches.rate);
    glUniform1i((*program)["hasEdges"], settings.hasEdges ? 1 : 0);
    glUniform1i((*program)["OsdPatchParamBuffer"], 0);
    patches.Draw(*program);
}

void SurfacePainter::drawControlMesh(ViewedSurface &surface, glm::mat4 const &projection,
                                     int chosenVertex) {
    _controlPoints.Assign(surface.GetControlPoints());
    _controlEnds.Assign(surface.GetControlEdges());
    _controlPoints.Bind(kPointArray);
    _controlEnds.Bind(kCornerSideArray);
    _controlProgram.Use();
    glUniformMatrix4fv(_controlProgram["projection"], 1, GL_FALSE, glm::value_ptr(projection));
    glUniform1i(_controlProgram["chosen"], -1);
    glUniform1i(_controlProgram["areEnds"], 1);
    glUniform4f(_controlProgram["lineColor"], 0.15f, 0.35f, 0.75f, 1);
    glDrawArrays(GL_LINES, 0, GLsizei(surface.GetControlEdges().size()));
    glEnable(GL_PROGRAM_POINT_SIZE);
    glUniform1i(_controlProgram["chosen"], chosenVertex);
    glUniform1i(_controlProgram["areEnds"], 0);
    glDrawArrays(GL_POINTS, 0, GLsizei(surface.GetControlPoints().size() / 3));
    glDisable(GL_PROGRAM_POINT_SIZE);
}

} // namespace OpenSubdivHex::Tools

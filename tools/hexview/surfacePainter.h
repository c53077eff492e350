// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_HEXVIEW_SURFACE_PAINTER_H
#define OPENSUBDIVHEX_TOOLS_HEXVIEW_SURFACE_PAINTER_H

#include "viewedSurface.h"

#include "tools/gl/glObjects.h"
#include "tools/gl/orbitCamera.h"

#include <glm/glm.hpp>

#include <memory>

namespace OpenSubdivHex::Tools {

/// How faces are drawn; in the numbers of kSurfaceFragmentShader.
enum class Shading { Smooth, Facets, Reflection, Curvature, BaseFaces, Checker, Levels };

/// Settings of a drawing.
struct DrawSettings {
    Shading shading = Shading::Smooth;
    bool hasFaces = true;
    bool hasEdges = true;
    bool hasControlMesh = false;
    int chosenVertex = -1; ///< of the control mesh
    PatchSettings patches; ///< of a surface of patches
};

/// \brief Draws surfaces into the current framebuffer.
class SurfacePainter {
public:
    SurfacePainter();
    ~SurfacePainter();
    SurfacePainter(SurfacePainter const &) = delete;
    SurfacePainter &operator=(SurfacePainter const &) = delete;

    /// Clears a picture of \p width by \p height pixels, and draws.
    void Draw(ViewedSurface &surface, OrbitCamera const &camera, DrawSettings const &settings,
              int width, int height);

private:
    void drawControlMesh(ViewedSurface &surface, glm::mat4 const &projection, int chosenVertex);
    void drawPatches(PatchView const &patches, OrbitCamera const &camera,
                     DrawSettings const &settings, int width, int height);
    static void setShading(ViewProgram const &program, OrbitCamera const &camera, Shading shading);

    GLuint _vertexArray = 0; // without attributes
    GlArray _controlPoints;
    GlArray _controlEnds;
    ViewProgram _surfaceProgram;
    ViewProgram _edgeProgram;
    ViewProgram _controlProgram;
    std::unique_ptr<ViewProgram>
        _patchPrograms[2]; // by rate and by pixels; made when they are used
};

} // namespace OpenSubdivHex::Tools

#endif

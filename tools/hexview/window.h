// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_HEXVIEW_WINDOW_H
#define OPENSUBDIVHEX_TOOLS_HEXVIEW_WINDOW_H

#include "surfacePainter.h"

#include <string>

namespace OpenSubdivHex::Tools {

/// \brief Shows a mesh in a window until that is closed.  Throws std::runtime_error where there is no
/// window with OpenGL 4.3.
///
/// \param name  of the mesh
void ShowWindow(Mesh const &mesh, std::string const &name, SurfaceSettings const &settings,
                DrawSettings const &drawSettings, OrbitCamera const &camera, int width, int height);

} // namespace OpenSubdivHex::Tools

#endif

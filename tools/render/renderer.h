// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_RENDERER_H
#define OPENSUBDIVHEX_TOOLS_RENDERER_H

#include "camera.h"
#include "image.h"
#include "scene.h"

#include <vector>

namespace OpenSubdivHex::Tools {

enum class SurfaceLook {
    Smooth, ///< by the vertex normals
    Flat,   ///< one normal for each polygon
    Zebra   ///< reflection lines: as smooth as the normals, one order rougher than the surface
};

struct RenderOptions {
    SurfaceLook look = SurfaceLook::Smooth;
    bool hasWireframe = false; ///< draws the edges of the polygons
    bool isTinted = false;     ///< colours faces that are no hexagons
    bool hasRegions = false;   ///< colours the region of each face of the control mesh
    /// A number for each of these faces, of which those with the same have one colour; empty: each has
    /// its own.
    std::vector<int> regions{};
    float lineWidth = 1.5f; ///< of the wireframe, in pixels
    bool hasGround = true;  ///< shadows fall on a plane below the scene
    int numSamples = 16;    ///< per pixel; each with four rays to the key light and to the sky
};

/// \brief Ray traces \p scene: a soft key light from the upper left and a bright sky, before a
/// light background that the ground fades into.
///
/// The lights turn with the camera.  All sample patterns are fixed and pixels do not depend on each
/// other: the picture is the same for any number of threads, and the machine's threads are used.
Image Render(Scene const &scene, Camera const &camera, RenderOptions const &options, int width,
             int height);

} // namespace OpenSubdivHex::Tools

#endif

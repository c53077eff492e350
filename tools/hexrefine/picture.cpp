// SPDX-License-Identifier: Apache-2.0
#include "picture.h"

#include "tools/mesh/fileError.h"

#ifdef HEXREFINE_HAS_RENDERER
#include "tools/render/pngFile.h"
#include "tools/render/renderer.h"
#include "tools/render/unitSize.h"
#endif

namespace OpenSubdivHex::Tools {

#ifdef HEXREFINE_HAS_RENDERER

bool HasRenderer() { return true; }

void WritePicture(FarExt::TopologyLevel const &level, std::vector<float> positions,
                  std::vector<int> const &regions, std::string const &path) {
    ScaleToUnitSize(&positions);
    constexpr int kWidth = 800;
    constexpr int kHeight = 600;
    Surface surface(level, !regions.empty());
    surface.SetPositions(positions.data());
    Scene scene;
    scene.Build(&surface, {}, 0);
    Camera const camera(View(), positions, float(kWidth) / kHeight);
    RenderOptions options;
    options.hasRegions = !regions.empty();
    options.regions = regions;
    WritePng(Render(scene, camera, options, kWidth, kHeight), path);
}

#else

bool HasRenderer() { return false; }

void WritePicture(FarExt::TopologyLevel const &, std::vector<float>, std::vector<int> const &,
                  std::string const &path) {
    throw FileError(path, "cannot be made: this program was built without Embree and libpng");
}

#endif

} // namespace OpenSubdivHex::Tools

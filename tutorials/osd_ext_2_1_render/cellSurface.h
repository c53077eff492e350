// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TUTORIALS_CELL_SURFACE_H
#define OPENSUBDIVHEX_TUTORIALS_CELL_SURFACE_H

#include "bfr_ext/surfaceFactory.h"
#include "bfr_ext/view.h"
#include "osd_ext/refinementEvaluator.h"
#include "tools/render/camera.h"
#include "tools/render/surface.h"

#include <memory>
#include <optional>
#include <vector>

namespace OpenSubdivHex::Tools {

/// \brief The limit surface of a mesh, refined as far as a camera needs it: for each frame anew.
///
/// From frame to frame it keeps what does not depend on camera and positions, the types of the mesh's
/// faces, and the trees of the last frame, so that cells do not flicker.
class CellSurface {
public:
    /// \brief Prepares the surfaces of all faces.
    ///
    /// \param refiner  of the control mesh, refined to the surface level; must live as long.  Throws
    ///                 std::runtime_error where a face has no surface
    explicit CellSurface(FarExt::TopologyRefiner const &refiner);

    /// \brief Makes the polygons of a frame.
    ///
    /// \param positions   of the control mesh
    /// \param camera      of the picture
    /// \param height      of the picture, in pixels
    /// \param pixelError  how many pixels polygons may be from the surface
    void Update(std::vector<float> const &positions, Camera const &camera, int height,
                double pixelError);

    /// The polygons, and the normals of the surface at their vertices.  Null if all faces are holes.
    Surface const *GetSurface() const { return _surface.get(); }
    /// The face of the control mesh that each polygon lies in.
    std::vector<int> const &GetBaseFaces() const { return _baseFaces; }

private:
    BfrExt::SurfaceFactoryCache _cache;
    std::unique_ptr<BfrExt::SurfaceFactory> _factory;
    std::unique_ptr<OsdExt::RefinementEvaluator> _evaluator; // to a surface level beyond 0
    std::vector<float> _points;                              // of the surface level
    std::optional<BfrExt::ViewBounds> _bounds;               // of cells, from frame to frame
    std::optional<BfrExt::CellForest> _forest;
    std::unique_ptr<FarExt::TopologyRefiner> _polygons; // as a mesh that is not refined
    std::unique_ptr<Surface> _surface;
    std::vector<int> _baseFaces;
};

} // namespace OpenSubdivHex::Tools

#endif

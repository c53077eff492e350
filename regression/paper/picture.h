// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_PAPER_PICTURE_H
#define OPENSUBDIVHEX_REGRESSION_PAPER_PICTURE_H

#include "regression/analysis/surfaceLevels.h"
#include "settings.h"
#include "tools/render/camera.h"
#include "tools/render/renderer.h"

#include <string>

namespace OpenSubdivHex::Regression {

/// \brief How a mesh is looked at.
struct PictureOptions {
    Tools::View view;
    Tools::SurfaceLook look = Tools::SurfaceLook::Flat;
    bool hasWireframe = false;
    bool isTinted = false; ///< colours faces that are no hexagons
    double aspect = 1.25;  ///< width by height
};

/// \brief A ray traced picture of \p mesh as an img element with the PNG inside.
///
/// \param frame  the mesh that fills the picture, so that pictures of several levels agree
std::string DrawMesh(PolygonMesh const &mesh, PolygonMesh const &frame,
                     PictureOptions const &options, Settings const &settings);

} // namespace OpenSubdivHex::Regression

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CAMERA_H
#define OPENSUBDIVHEX_BFR_EXT_CAMERA_H

namespace OpenSubdivHex::BfrExt {

/// \brief A pinhole camera, as in glTF and USD.
struct Camera {
    double eye[3] = {0, 0, 1};    ///< where it is
    double target[3] = {0, 0, 0}; ///< what is in the middle of the picture
    /// A direction that is upright in the picture.  Where the camera looks along it, -z takes its
    /// place, or y for a look more along z than along y: so a look down has x to the right.
    double up[3] = {0, 1, 0};
    double fieldOfView = 40; ///< degrees, of the height of the picture; between 0 and 180
    int width = 1280;        ///< pixels
    int height = 720;        ///< pixels
};

} // namespace OpenSubdivHex::BfrExt

#endif

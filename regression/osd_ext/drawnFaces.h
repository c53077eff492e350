// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_OSD_EXT_DRAWN_FACES_H
#define OPENSUBDIVHEX_REGRESSION_OSD_EXT_DRAWN_FACES_H

#include "osd_ext/polygonIndices.h"

#include <string>

namespace OpenSubdivHex::Regression {

/// \brief Compares the polygons and triangles that draw a level with what its accessors say of each
/// face and half.
///
/// \return  empty when all are as they are to be
std::string FindDrawingError(FarExt::TopologyLevel const &level,
                             OsdExt::DrawOptions const &options);

} // namespace OpenSubdivHex::Regression

#endif

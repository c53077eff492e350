// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_SHAPES_OBJ_SHAPE_H
#define OPENSUBDIVHEX_REGRESSION_SHAPES_OBJ_SHAPE_H

#include "shapes.h"

namespace OpenSubdivHex::Regression {

/// \brief Reads an OBJ file; all its objects become one shape, n-gons stay whole, and texture
/// coordinates, when every corner has one, become a face-varying channel of width 2.
///
/// Throws std::runtime_error if the file cannot be read.
Shape LoadObjShape(std::string name, std::string const &path);

} // namespace OpenSubdivHex::Regression

#endif

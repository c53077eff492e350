// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_PAPER_MESHES_H
#define OPENSUBDIVHEX_REGRESSION_PAPER_MESHES_H

#include "regression/shapes/shapes.h"

namespace OpenSubdivHex::Regression {

/// The pentagonal solid of the page, of radius about 1.
Shape MakeDodecahedron();

/// A mesh of tutorials/meshes, z up as the other shapes.
Shape LoadTutorialMesh(std::string const &name);

} // namespace OpenSubdivHex::Regression

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_FAR_EXT_SHAPE_FACTORY_H
#define OPENSUBDIVHEX_REGRESSION_FAR_EXT_SHAPE_FACTORY_H

#include "far_ext/topologyRefinerFactory.h"
#include "regression/shapes/shapes.h"

/// @name Shapes as a mesh class of a user's own, which is not left-handed
/// @{
namespace OpenSubdivHex::FarExt {

template <>
bool MeshRefinerFactory<Regression::Shape>::resizeComponentTopology(BaseTopology &base,
                                                                    Regression::Shape const &shape);
template <>
bool MeshRefinerFactory<Regression::Shape>::assignComponentTopology(BaseTopology &base,
                                                                    Regression::Shape const &shape);
template <>
bool MeshRefinerFactory<Regression::Shape>::assignComponentTags(BaseTopology &base,
                                                                Regression::Shape const &shape);
template <>
bool MeshRefinerFactory<Regression::Shape>::assignFaceVaryingTopology(
    BaseTopology &base, Regression::Shape const &shape);

} // namespace OpenSubdivHex::FarExt
/// @}

#endif

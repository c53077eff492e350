// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_STENCIL_SELECTION_H
#define OPENSUBDIVHEX_FAR_EXT_STENCIL_SELECTION_H

#include "stencilStep.h"
#include "topologyRefiner.h"

#include <vector>

namespace OpenSubdivHex::FarExt::internal {

/// Of levels 0 ... \p lastLevel, the faces whose GetFaceBaseFace() is one of \p baseFaces, in
/// ascending order.  The work is proportional to their number, but for a logarithm where there are V-faces.
std::vector<std::vector<Far::Index>>
FindFacesOfBaseFaces(TopologyRefiner const &refiner, Far::ConstIndexArray baseFaces, int lastLevel);

/// The vertices of faces of a level or, with a \p channel of 0 or more, their values; ascending.
std::vector<Far::Index> FindVerticesOfFaces(TopologyLevel const &mesh, int channel,
                                            std::vector<Far::Index> const &faces);

/// \brief The least parts of all steps that make wanted vertices.
///
/// \param levels  all levels, of the mesh or of the value mesh of a channel
/// \param wanted  by level, ascending
/// \return        the part of the step that makes level i + 1, for each level but the last
std::vector<StencilStep::Part> FindStencilParts(std::vector<TopologyLevel> const &levels,
                                                SchemeOptions schemeOptions,
                                                Interpolation interpolation,
                                                std::vector<std::vector<Far::Index>> wanted);

/// The vertices that a part of the step from \p pLevel makes: see StencilStep.  Ascending.
std::vector<Far::Index> FindMadeVertices(TopologyLevel const &pLevel,
                                         StencilStep::Part const &part);

} // namespace OpenSubdivHex::FarExt::internal

#endif

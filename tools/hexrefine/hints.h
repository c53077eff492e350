// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_HINTS_H
#define OPENSUBDIVHEX_TOOLS_HINTS_H

#include "far_ext/topologyRefiner.h"
#include "tools/mesh/mesh.h"

#include <string>
#include <vector>

namespace OpenSubdivHex::Tools {

/// Whether truncation is for a mesh: nine of ten faces, or more, are triangles.
bool IsOfTriangles(Mesh const &mesh);

/// \brief Sentences on what is likely wrong with a mesh or with the choices for it, each once.
///
/// \param mesh      of level 0
/// \param refiner   of \p mesh, with the scheme that was chosen
/// \param maxLevel  the last level that is made
/// \param isMaskChosen,isFirstStepChosen  whether the user named a mask, or a first step
std::vector<std::string> FindHints(Mesh const &mesh, FarExt::TopologyRefiner const &refiner,
                                   int maxLevel, bool isMaskChosen, bool isFirstStepChosen);

} // namespace OpenSubdivHex::Tools

#endif

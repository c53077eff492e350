// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_NON_MANIFOLD_H
#define OPENSUBDIVHEX_TOOLS_NON_MANIFOLD_H

#include "far_ext/topologyLevel.h"
#include "tools/mesh/mesh.h"

#include <string>

namespace OpenSubdivHex::Tools {

/// \brief A sentence that counts and names the non-manifold edges of a mesh, which come apart, and its
/// faces that have a vertex several times; empty without any.
///
/// Edges that two faces run in the same direction are left out: the library warns of these.
///
/// \param base  level 0 of \p mesh
std::string DescribeWhatComesApart(Mesh const &mesh, FarExt::TopologyLevel const &base);

} // namespace OpenSubdivHex::Tools

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_PICTURE_H
#define OPENSUBDIVHEX_TOOLS_PICTURE_H

#include "adaptive.h"
#include "far_ext/topologyLevel.h"

#include <string>
#include <vector>

namespace OpenSubdivHex::Tools {

/// Whether this program has the renderer, which needs Embree and libpng.
bool HasRenderer();

/// \brief Ray traces a level, which has full topology, and writes the picture, 800 x 600 pixels, to
/// \p path.
///
/// \param positions  x y z of each vertex of the level
/// \param regions    of FindRegions(); empty: all faces have the colour of clay
///
/// Throws FileError.
void WritePicture(FarExt::TopologyLevel const &level, std::vector<float> positions,
                  std::vector<int> const &regions, std::string const &path);

/// \brief Ray traces cells as their camera sees them.
///
/// \param mesh     their faces
/// \param regions  a number for each face, the same for those that get one colour; then faces have
///                 their edges drawn, too.  Empty: all have the colour of clay
///
/// Throws FileError.
void WriteCellPicture(Mesh const &mesh, AdaptiveCamera const &camera,
                      std::vector<int> const &regions, std::string const &path);

} // namespace OpenSubdivHex::Tools

#endif

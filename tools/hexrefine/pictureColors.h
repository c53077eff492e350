// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_PICTURE_COLORS_H
#define OPENSUBDIVHEX_TOOLS_PICTURE_COLORS_H

#include "tools/mesh/mesh.h"

#include <string>
#include <vector>

namespace OpenSubdivHex::Tools {

/// Values of --color: the parts of a mesh that get a colour each.
inline std::vector<std::string> const kPictureColors = {"base-faces", "materials", "groups",
                                                        "objects", "levels"};
/// The value for which --adaptive is needed.
inline char const *const kLevelColors = "levels";

/// \brief A number for each face of a control mesh, the same for those that get one colour.
///
/// \param colors  one of kPictureColors, or empty, for which there are no numbers
/// \param path    the file of the mesh
///
/// Throws FileError where no face has such a thing.
std::vector<int> FindRegions(std::string const &colors, Mesh const &mesh, std::string const &path);

/// \brief Returns these numbers for each of the faces that \p mesh has now.
///
/// \param regions     of FindRegions()
/// \param faceLevels  by face; taken for kLevelColors
std::vector<int> FindCellRegions(std::string const &colors, std::vector<int> const &regions,
                                 Mesh const &mesh, std::vector<int> const &faceLevels);

} // namespace OpenSubdivHex::Tools

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_LIBRARY_PATHS_H
#define OPENSUBDIVHEX_TOOLS_LIBRARY_PATHS_H

#include <string>
#include <vector>

namespace OpenSubdivHex::Tools {

/// \brief Returns the paths for mtllib statements of the OBJ file \p output: they lead to the same files as
/// \p libraries, the paths in the OBJ file \p input.  Relative paths count from the folder of their
/// file.
///
/// A statement names one file, with spaces or without, where there is such a file, else several: those
/// that are there, and those whose names end in .mtl; words behind these name a file each.  In the same
/// folder it stays as it is.
std::vector<std::string> MoveLibraries(std::vector<std::string> libraries, std::string const &input,
                                       std::string const &output);

} // namespace OpenSubdivHex::Tools

#endif

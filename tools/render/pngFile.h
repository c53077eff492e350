// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_PNG_FILE_H
#define OPENSUBDIVHEX_TOOLS_PNG_FILE_H

#include "image.h"

#include <string>

namespace OpenSubdivHex::Tools {

/// \p image as the content of a PNG file.  Throws std::runtime_error.
std::string EncodePng(Image const &image);

/// Writes \p image, all or nothing.  Throws FileError.
void WritePng(Image const &image, std::string const &path);

} // namespace OpenSubdivHex::Tools

#endif

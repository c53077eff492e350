// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_PLY_HEADER_H
#define OPENSUBDIVHEX_TOOLS_PLY_HEADER_H

#include "numberType.h"

#include <string>
#include <string_view>
#include <vector>

namespace OpenSubdivHex::Tools::internal {

/// A number, or a list of numbers, that every item of an element has.
struct PlyProperty {
    std::string name;
    NumberType type;
    bool isList = false;
    NumberType countType = NumberType::UChar; ///< of the length of a list, an integer type
};

/// A kind of items in a file, such as vertices.
struct PlyElement {
    std::string name;
    int count;
    std::vector<PlyProperty> properties{}; ///< whose names differ
};

struct PlyHeader {
    bool isText = false;
    bool isBigEndian = false;
    int numLines = 0;
    std::vector<PlyElement> elements{}; ///< in the order of their items, with names that differ
    std::string textureFile{};          ///< that a comment of MeshLab names
    std::string_view body{};            ///< the content behind the header
};

/// Parses the header at the beginning of \p content, the content of the file \p path.  Throws
/// FileError with the line.
PlyHeader ParsePlyHeader(std::string const &path, std::string_view content);

} // namespace OpenSubdivHex::Tools::internal

#endif

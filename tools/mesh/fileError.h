// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_FILE_ERROR_H
#define OPENSUBDIVHEX_TOOLS_FILE_ERROR_H

#include <stdexcept>
#include <string>
#include <string_view>

namespace OpenSubdivHex::Tools {

/// \brief \p text with its control characters, which names of files may have, written as in C, so
/// that it is one line and tells a terminal nothing.
inline std::string EscapeControls(std::string_view text) {
    constexpr char kDigits[] = "0123456789abcdef";
    std::string result;
    for (char c : text) {
        auto const code = static_cast<unsigned char>(c);
        if (c == '\n') {
            result += "\\n";
        } else if (code < 0x20 || code == 0x7f) {
            result += {'\\', 'x', kDigits[code / 16], kDigits[code % 16]};
        } else {
            result += c;
        }
    }
    return result;
}

/// \brief A file could not be read or written; what() is one line, "FILE: cause", whatever
/// characters the two have.
class FileError : public std::runtime_error {
public:
    FileError(std::string const &path, std::string const &cause)
        : std::runtime_error(EscapeControls(path + ": " + cause)) {}
};

} // namespace OpenSubdivHex::Tools

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TUTORIALS_FILE_ERROR_H
#define OPENSUBDIVHEX_TUTORIALS_FILE_ERROR_H

#include <stdexcept>
#include <string>

namespace OpenSubdivHex::Tutorials {

/// \brief A file could not be read or written; what() is one line, "FILE: cause".
class FileError : public std::runtime_error {
public:
    FileError(std::string const &path, std::string const &cause)
        : std::runtime_error(path + ": " + cause) {}
};

} // namespace OpenSubdivHex::Tutorials

#endif

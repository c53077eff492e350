// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_FUZZ_DAMAGED_FILE_H
#define OPENSUBDIVHEX_REGRESSION_FUZZ_DAMAGED_FILE_H

#include <cstddef>
#include <cstdint>
#include <string>

namespace OpenSubdivHex::Regression {

/// \brief The content of a mesh file, with a name that says which format it has.
struct DamagedFile {
    std::string name;
    std::string content;
};

/// \brief A small OBJ, OFF or PLY file to which \p data says what to do: words and bytes replaced,
/// put in, left out, moved.  Few bytes do little, so that many files still are meshes; no bytes do
/// nothing.  With some first bytes the file is the others, as they are.
DamagedFile MakeDamagedFile(std::uint8_t const *data, std::size_t size);

} // namespace OpenSubdivHex::Regression

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_PACKED_CELL_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_PACKED_CELL_H

#include "far_ext/limit/cellPatch.h"

#include <string>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief Appends a number in as many bytes as it takes, small ones, of either sign, in one.
void PackNumber(int number, std::string &bytes);

/// \brief Appends a cell in little memory.  Cells with the same bytes look alike.
void PackCell(FarExt::internal::CellPatch const &cell, std::string &bytes);

/// \brief Makes the cell that PackCell() wrote at the begin of \p bytes.  The sources of its patch are the numbers of
/// the points themselves.
FarExt::internal::CellPatch UnpackCell(std::string const &bytes);

} // namespace OpenSubdivHex::BfrExt::internal

#endif

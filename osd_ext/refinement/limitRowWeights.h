// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_REFINEMENT_LIMIT_ROW_WEIGHTS_H
#define OPENSUBDIVHEX_OSD_EXT_REFINEMENT_LIMIT_ROW_WEIGHTS_H

#include "far_ext/limit/limitRows.h"

#include <cstddef>
#include <string>
#include <unordered_map>
#include <vector>

namespace OpenSubdivHex::OsdExt::internal {

/// \brief The weights of LimitRows in single precision: of each part of a row those of the point, du and dv.
///
/// Rows whose weights have the same bits share them, whichever threads have found their masks.
class LimitRowWeights {
public:
    /// Adds the weights of a row, unless they are there.
    /// \return  where they begin
    std::size_t Add(FarExt::internal::LimitRow const &row);

    /// All of them, in the order in which they were added.
    std::vector<float> const &Get() const { return _weights; }

private:
    std::vector<float> _weights;
    std::unordered_map<std::string, std::size_t> _firsts; // by the bytes of the weights
    /// By the address of a mask: a row is looked at once.  The sides of a vertex share the weights of its point.
    std::unordered_map<double const *, std::size_t> _firstOfMask;
};

} // namespace OpenSubdivHex::OsdExt::internal

#endif

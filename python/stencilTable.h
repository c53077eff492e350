// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_PYTHON_STENCIL_TABLE_H
#define OPENSUBDIVHEX_PYTHON_STENCIL_TABLE_H

#include <opensubdiv/far/stencilTable.h>

#include <memory>
#include <variant>

namespace OpenSubdivHex::Python {

namespace Far = OpenSubdiv::Far;

/// \brief A stencil table of either precision, as Python sees it.
struct StencilTable {
    template <typename REAL>
    using Pointer = std::shared_ptr<Far::StencilTableReal<REAL> const>;

    virtual ~StencilTable() = default;

    std::variant<Pointer<float>, Pointer<double>> table;
    /// Elements that the indices refer to: control vertices, or those of the level before.
    int numSources = 0;
    /// Whether all stencils refer to the same elements: not where each level does to that before.
    bool isMatrix = true;
};

/// \brief One of limit points, and their derivatives where they were asked for.
struct LimitStencilTable : StencilTable {
    bool hasDerivatives = false;
};

} // namespace OpenSubdivHex::Python

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_SHAPES_H
#define OPENSUBDIVHEX_TOOLS_SHAPES_H

#include "mesh.h"

namespace OpenSubdivHex::Tools {

/// The cube of side 2 around the origin: 8 vertices, 12 edges, 6 faces.
inline Mesh MakeCube() {
    return {{-1, -1, 1, 1, -1, 1, -1, 1, 1, 1, 1, 1, -1, 1, -1, 1, 1, -1, -1, -1, -1, 1, -1, -1},
            {4, 4, 4, 4, 4, 4},
            {0, 1, 3, 2, 2, 3, 5, 4, 4, 5, 7, 6, 6, 7, 1, 0, 1, 7, 5, 3, 6, 0, 2, 4}};
}

} // namespace OpenSubdivHex::Tools

#endif

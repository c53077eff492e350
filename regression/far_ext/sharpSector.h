// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_FAR_EXT_SHARP_SECTOR_H
#define OPENSUBDIVHEX_REGRESSION_FAR_EXT_SHARP_SECTOR_H

#include "far_ext/stencilTableFactory.h"

namespace OpenSubdivHex::Regression {

/// The faces around a vertex on infinitely sharp edges, on one of its sides.
struct SharpSector {
    /// \p side is a number of \p sides.
    SharpSector(FarExt::TopologyLevel const &level, FarExt::LimitSides const &sides, int side) {
        int const vert = sides.GetVertex(side);
        for (int edge : level.GetVertexEdges(vert)) {
            numSharp += level.IsEdgeInfSharp(edge);
        }
        for (int i = 0; i < level.GetVertexFaces(vert).size(); ++i) {
            int const face = level.GetVertexFaces(vert)[i];
            int const local = level.GetVertexFaceLocalIndices(vert)[i];
            bool const isCut = Sdc::Crease::IsInfinite(level.GetFaceDiagonalSharpness(face)) &&
                               (local == 0 || local == level.GetFaceDiagonalEnd(face));
            numSharp += isCut;
            bool const isHalf = level.IsFaceHalf(face) && local < 2;
            for (int half : {0, 1}) {
                size += sides.FindSide(level, face, local, isCut ? half : 0) == side
                            ? (isHalf ? 0.25 : 0.5)
                            : 0;
            }
        }
        isCorner = numSharp > 2 || level.IsVertexInfSharp(vert);
    }

    int numSharp = 0; ///< sharp edges and diagonals all around
    double size = 0;  ///< faces of the side; half hexagons count half
    bool isCorner;
};

} // namespace OpenSubdivHex::Regression

#endif

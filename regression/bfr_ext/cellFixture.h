// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_BFR_EXT_CELL_FIXTURE_H
#define OPENSUBDIVHEX_REGRESSION_BFR_EXT_CELL_FIXTURE_H

#include "bfr_ext/cellForest.h"

#include <random>

namespace OpenSubdivHex::Regression {

/// A tree in which cells up to a level are refined by chance.
inline BfrExt::CellTree MakeRandomTree(int faceSize, std::mt19937 &random) {
    BfrExt::CellTree tree(faceSize);
    int const lastLevel = int(random() % 7);
    unsigned const chance = 25 + random() % 35;
    for (int cell = 0; cell < tree.GetNumCells() && tree.GetNumCells() < 400; ++cell) {
        if (tree.GetLevel(cell) < lastLevel && random() % 100 < chance + (cell == 0 ? 30 : 0)) {
            tree.Refine(cell);
        }
    }
    return tree;
}

/// Such a tree for each face.
inline BfrExt::CellForest MakeRandomForest(FarExt::TopologyRefiner const &refiner, unsigned seed) {
    std::mt19937 random(seed);
    BfrExt::CellForest forest(refiner);
    for (int face = 0; face < forest.GetNumFaces(); ++face) {
        forest.SetTree(face,
                       MakeRandomTree(refiner.GetLevel(0).GetFaceVertices(face).size(), random));
    }
    forest.MatchEdges();
    return forest;
}

} // namespace OpenSubdivHex::Regression

#endif

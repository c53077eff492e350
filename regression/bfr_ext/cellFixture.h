// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_BFR_EXT_CELL_FIXTURE_H
#define OPENSUBDIVHEX_REGRESSION_BFR_EXT_CELL_FIXTURE_H

#include "bfr_ext/cellForest.h"

#include <random>

namespace OpenSubdivHex::Regression {

/// A tree in which cells up to a level are refined by chance.
inline BfrExt::CellTree MakeRandomTree(FarExt::FaceShape shape, std::mt19937 &random) {
    BfrExt::CellTree tree(shape);
    int const lastLevel = int(random() % 7);
    unsigned const chance = 25 + random() % 35;
    for (int cell = 0; cell < tree.GetNumCells() && tree.GetNumCells() < 400; ++cell) {
        if (tree.GetLevel(cell) < lastLevel && random() % 100 < chance + (cell == 0 ? 30 : 0)) {
            tree.Refine(cell);
        }
    }
    return tree;
}

/// A tree with cells enough to come in sections, of all levels from 4 to 9, side by side.
inline BfrExt::CellTree MakeLargeTree(FarExt::FaceShape shape, unsigned seed) {
    std::mt19937 random(seed);
    BfrExt::CellTree tree(shape, 4);
    for (int cell = 0; cell < tree.GetNumCells() && tree.GetNumLeaves() < 20000; ++cell) {
        int const level = tree.GetLevel(cell);
        if (level >= 4 && level < 9 && random() % 100 < (level < 6 ? 75 : 60)) {
            tree.Refine(cell);
        }
    }
    return tree;
}

/// A random tree for each face.
inline BfrExt::CellForest MakeRandomForest(FarExt::TopologyRefiner const &refiner, unsigned seed) {
    std::mt19937 random(seed);
    BfrExt::CellForest forest(refiner);
    for (int face = 0; face < forest.GetNumFaces(); ++face) {
        forest.SetTree(face, MakeRandomTree(forest.GetTree(face).GetFaceShape(), random));
    }
    forest.MatchEdges();
    return forest;
}

} // namespace OpenSubdivHex::Regression

#endif

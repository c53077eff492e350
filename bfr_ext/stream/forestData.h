// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_STREAM_FOREST_DATA_H
#define OPENSUBDIVHEX_BFR_EXT_STREAM_FOREST_DATA_H

#include "bfr_ext/cellForest.h"

#include "far_ext/surfaceFaces.h"

#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// The data of a CellForest.
struct ForestData {
    using Index = CellForest::Index;

    /// No face is refined.
    explicit ForestData(FarExt::SurfaceFaces const &ofMesh);

    int GetNumFaces() const { return int(trees.size()); }
    CellTree const &GetTree(Index face) const { return trees[std::size_t(face)]; }
    /// Writes what tells the tessellation of a face.
    void GetKey(Index face, std::vector<int> &key) const;

    FarExt::SurfaceFaces faces;
    std::vector<CellTree> trees;
    std::vector<char> isMatched;                 // by face; where it is not known, too, it is false
    std::vector<Polyline> edges;                 // what was set
    std::vector<Polyline> polylines;             // the same with the points of faces
    std::vector<CellForest::Number> firstPoints; // by edge; then their end
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif

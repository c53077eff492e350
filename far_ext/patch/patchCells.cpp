// SPDX-License-Identifier: Apache-2.0
#include "patchCells.h"

namespace OpenSubdivHex::FarExt::internal {

using Far::Index;

PatchCells::PatchCells(MeshLevels const &mesh, int level) : _firstLevel(level) {
    Level const &topology = mesh.levels[std::size_t(level)];
    std::vector<unsigned char> marks(std::size_t(topology.numFaces), 0);
    for (Index face = 0; face < topology.numFaces; ++face) {
        int const numHalves = HasHalves(topology.GetFaceSize(face)) ? 2 : 1;
        unsigned const holes = topology.GetHoles(face);
        for (int half = 0; half < numHalves; ++half) {
            bool const isHole = numHalves == 1 ? holes == kHole : (holes >> half & 1) != 0;
            if (!isHole) {
                marks[std::size_t(face)] |= 1 << half;
            }
        }
    }
    _marks.push_back(std::move(marks));
    addCells(mesh, level);
}

void PatchCells::addCells(MeshLevels const &mesh, int level) {
    Level const &topology = mesh.levels[std::size_t(level)];
    std::vector<PatchCell> cells;
    for (Index face = 0; face < topology.numFaces; ++face) {
        for (int half = 0; half < 2; ++half) {
            if (HasCell(level, face, half)) {
                cells.push_back({face, half});
                _numPatches += internal::GetNumPatches(topology.GetFaceSize(face));
            }
        }
    }
    _cells.push_back(std::move(cells));
}

} // namespace OpenSubdivHex::FarExt::internal

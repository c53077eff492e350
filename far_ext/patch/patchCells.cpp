// SPDX-License-Identifier: Apache-2.0
#include "patchCells.h"

namespace OpenSubdivHex::FarExt::internal {

using Far::Index;

namespace {

constexpr unsigned char kBothHalves = 3;

// The bits of all cells of a face.
unsigned char getAllCells(Level const &level, Index face) {
    return FindFaceCells(level, face).IsCut() ? kBothHalves : 1;
}

std::vector<unsigned char> makeAllCells(Level const &level) {
    std::vector<unsigned char> marks(std::size_t(level.numFaces));
    for (Index face = 0; face < level.numFaces; ++face) {
        marks[std::size_t(face)] = getAllCells(level, face);
    }
    return marks;
}

// The cells that the refined faces of a level make.
std::vector<unsigned char> makeChildren(Refinement const &refinement,
                                        std::vector<unsigned char> const &refined) {
    Level const &parent = *refinement.parent;
    Level const &child = *refinement.child;
    std::vector<unsigned char> marks(std::size_t(child.numFaces), 0);
    for (Index face = 0; face < parent.numFaces; ++face) {
        marks[std::size_t(face)] = refined[std::size_t(face)] ? getAllCells(child, face) : 0;
    }
    for (Index edge = 0; edge < parent.numEdges; ++edge) {
        Index const cFace = refinement.GetEdgeChildFace(edge);
        for (int side = 0; side < 2; ++side) {
            Index const face = parent.edgeFaces[edge][side];
            if (cFace != Far::INDEX_INVALID && face >= 0 && refined[std::size_t(face)]) {
                bool const isCut = HasHalves(child.GetFaceSize(cFace));
                marks[std::size_t(cFace)] |= 1 << (isCut ? side : 0);
            }
        }
    }
    return marks;
}

} // namespace

FaceCells FindFaceCells(Level const &level, Index face) {
    int const size = level.GetFaceSize(face);
    CrossedFace const *const crossed = level.FindCrossedFace(face);
    return crossed && Sdc::Crease::IsInfinite(level.GetDiagonalSharpness(face))
               ? FaceCells{size, crossed->end, false}
               : MakeFaceCells({size, level.IsHalfFace(face)});
}

PatchCells::PatchCells(MeshLevels const &mesh, int level) : _firstLevel(level) {
    addCells(mesh, level, makeAllCells(mesh.levels[std::size_t(level)]));
}

PatchCells::PatchCells(MeshLevels const &mesh, int level, PatchCell cell) : _firstLevel(level) {
    Marks marks(std::size_t(mesh.levels[std::size_t(level)].numFaces), 0);
    marks[std::size_t(cell.face)] = static_cast<unsigned char>(1 << cell.half);
    addCells(mesh, level, std::move(marks));
}

PatchCells::PatchCells(MeshLevels const &mesh, int level, std::vector<Index> const &faces)
    : _firstLevel(level) {
    Level const &topology = mesh.levels[std::size_t(level)];
    Marks marks(std::size_t(topology.numFaces), 0);
    for (Index const face : faces) {
        marks[std::size_t(face)] = getAllCells(topology, face);
    }
    addCells(mesh, level, std::move(marks));
}

PatchCells::PatchCells(MeshLevels const &mesh, int firstLevel, int lastLevel,
                       FindRefined const &findRefined)
    : _firstLevel(firstLevel) {
    // By level and face.
    enum Answer : unsigned char { kUnknown, kNo, kYes };
    std::vector<std::vector<unsigned char>> answers;
    for (int level = firstLevel; level < lastLevel; ++level) {
        answers.emplace_back(std::size_t(mesh.levels[std::size_t(level)].numFaces), kUnknown);
    }
    std::vector<Marks> existing(std::size_t(lastLevel - firstLevel) + 1);
    std::vector<Marks> allRefined(existing.size());
    existing[0] = makeAllCells(mesh.levels[std::size_t(firstLevel)]);
    int depth = firstLevel;
    while (depth < lastLevel) {
        auto const i = std::size_t(depth - firstLevel);
        Level const &level = mesh.levels[std::size_t(depth)];
        std::vector<Index> open;
        for (Index face = 0; face < level.numFaces; ++face) {
            if (existing[i][std::size_t(face)] != 0 && answers[i][std::size_t(face)] == kUnknown &&
                level.GetHoles(face) != kHole) {
                open.push_back(face);
            }
        }
        if (!open.empty()) {
            Marks const wanted = findRefined(depth, open);
            for (std::size_t k = 0; k < open.size(); ++k) {
                answers[i][std::size_t(open[k])] = wanted[k] ? kYes : kNo;
            }
        }
        // A half that is to be refined needs the other one, and so the face beyond its edge.
        bool isComplete = true;
        Marks refined(std::size_t(level.numFaces), 0);
        for (Index face = 0; face < level.numFaces; ++face) {
            unsigned char const cells = existing[i][std::size_t(face)];
            if (cells == 0 || answers[i][std::size_t(face)] != kYes) {
                continue;
            }
            if (cells == getAllCells(level, face)) {
                refined[std::size_t(face)] = 1;
                continue;
            }
            Refinement const &fromParent = mesh.refinements[std::size_t(depth) - 1];
            Index const edge = fromParent.GetEFaceParent(face);
            Index const beyond = fromParent.parent->edgeFaces[edge][cells == 1 ? 1 : 0];
            answers[i - 1][std::size_t(beyond)] = kYes;
            isComplete = false;
        }
        if (!isComplete) {
            // From the level before on again, whose face beyond may itself be a half.
            --depth;
            continue;
        }
        existing[i + 1] = makeChildren(mesh.refinements[std::size_t(depth)], refined);
        allRefined[i] = std::move(refined);
        ++depth;
    }
    for (int level = firstLevel; level <= lastLevel; ++level) {
        auto const i = std::size_t(level - firstLevel);
        for (std::size_t face = 0; face < allRefined[i].size(); ++face) {
            existing[i][face] = allRefined[i][face] ? 0 : existing[i][face];
        }
        addCells(mesh, level, std::move(existing[i]));
    }
    while (_cells.size() > 1 && _cells.back().empty()) {
        _cells.pop_back();
        _marks.pop_back();
    }
}

PatchCells::PatchCells(FVarChannel const &channel, MeshLevels const &mesh, PatchCells const &ofMesh,
                       std::vector<Index> &patches)
    : _firstLevel(ofMesh._firstLevel) {
    for (int depth = _firstLevel; depth <= ofMesh.GetLastLevel(); ++depth) {
        FVarLevel const &level = channel.levels[std::size_t(depth)];
        auto const getCell = [&](PatchCell const &cell) {
            auto const [face, half] = level.GetValueCell({cell.face, cell.half});
            return PatchCell{face, half};
        };
        Marks marks(std::size_t(level.values->numFaces), 0);
        for (PatchCell const &cell : ofMesh.GetCells(depth)) {
            PatchCell const ofValues = getCell(cell);
            marks[std::size_t(ofValues.face)] |= 1 << ofValues.half;
        }
        std::vector<Index> firsts(2 * marks.size());
        auto next = Index(_numPatches);
        for (std::size_t face = 0; face < marks.size(); ++face) {
            for (std::size_t half = 0; half < 2; ++half) {
                firsts[2 * face + half] = next;
                next += (marks[face] >> half & 1) != 0
                            ? FindFaceCells(*level.values, Index(face)).GetNumPatches(int(half))
                            : 0;
            }
        }
        for (PatchCell const &cell : ofMesh.GetCells(depth)) {
            PatchCell const ofValues = getCell(cell);
            Index const first = firsts[2 * std::size_t(ofValues.face) + std::size_t(ofValues.half)];
            int const numPatches =
                FindFaceCells(mesh.levels[std::size_t(depth)], cell.face).GetNumPatches(cell.half);
            for (int i = 0; i < numPatches; ++i) {
                patches.push_back(first + i);
            }
        }
        addCells(channel.values, depth, std::move(marks));
    }
}

// Cells that exist, except holes.
void PatchCells::addCells(MeshLevels const &mesh, int level, Marks existing) {
    Level const &topology = mesh.levels[std::size_t(level)];
    std::vector<PatchCell> cells;
    for (Index face = 0; face < topology.numFaces; ++face) {
        unsigned char &marks = existing[std::size_t(face)];
        FaceCells const faceCells = FindFaceCells(topology, face);
        unsigned const holes = topology.GetHoles(face);
        marks &= ~(faceCells.IsCut() ? holes : holes == kHole ? 1u : 0u);
        for (int half = 0; half < 2; ++half) {
            if ((marks >> half & 1) != 0) {
                cells.push_back({face, half});
                _numPatches += faceCells.GetNumPatches(half);
            }
        }
    }
    _cells.push_back(std::move(cells));
    _marks.push_back(std::move(existing));
}

} // namespace OpenSubdivHex::FarExt::internal

// SPDX-License-Identifier: Apache-2.0
#include "refinementKernel.h"

#include "denseFaceKernel.h"
#include "plainFaceKernel.h"

#include "far_ext/indexing.h"
#include "far_ext/vtr/parallel.h"

#include <functional>

namespace OpenSubdivHex::OsdExt::internal {

using Far::Index;
using FarExt::EFaceSide;
using FarExt::HexIndexing;
using FarExt::kEFaceSideA;
using FarExt::kEFaceSideB;
using FarExt::internal::Level;
using FarExt::internal::RefinementRules;

namespace {

constexpr int kFVertexFaces = 3; // around an F-vertex

// The vertices of F-faces, which follow one another.
struct ConsecutiveVertices {
    Index operator[](int i) const { return first + i; }

    Index first;
};

// A plain face of any size.
template <class ACCESS>
void refinePlainFace(PlainFaceMask const &mask, Elements<float const> const &src,
                     Index const *verts, int size, Elements<float> const &dst, Index corner) {
    auto all = ACCESS::LoadExactly(src, verts[0]);
    for (int i = 1; i < size; ++i) {
        all = all + ACCESS::LoadExactly(src, verts[i]);
    }
    all = Spread(mask.all) * all;
    for (int i = 0; i < size; ++i) {
        auto const neighbors = ACCESS::LoadExactly(src, verts[i == 0 ? size - 1 : i - 1]) +
                               ACCESS::LoadExactly(src, verts[i + 1 == size ? 0 : i + 1]);
        auto const point = all + Spread(mask.self) * ACCESS::LoadExactly(src, verts[i]) +
                           Spread(mask.neighbor) * neighbors;
        ACCESS::StoreExactly(dst, corner + i, point);
    }
}

// The F-vertex of a corner with weights for the vertices of its face.
template <class ACCESS>
void refineWeightedCorner(float const *weights, Elements<float const> const &src,
                          Index const *verts, int size, Elements<float> const &dst, Index corner) {
    int j = 0;
    while (weights[j] == 0) {
        ++j;
    }
    auto point = Spread(weights[j]) * ACCESS::LoadExactly(src, verts[j]);
    for (++j; j < size; ++j) {
        // What weighs nothing has no part in the sign of a zero either.
        if (weights[j] != 0) {
            point = point + Spread(weights[j]) * ACCESS::LoadExactly(src, verts[j]);
        }
    }
    ACCESS::StoreExactly(dst, corner, point);
}

// A face with a row of weights for each corner, rowStride floats apart.
template <class ACCESS>
void refineWeightedFace(float const *weights, std::ptrdiff_t rowStride,
                        Elements<float const> const &src, Index const *verts, int size,
                        Elements<float> const &dst, Index corner) {
    for (int i = 0; i < size; ++i, weights += rowStride) {
        refineWeightedCorner<ACCESS>(weights, src, verts, size, dst, corner + i);
    }
}

// Hexagons of a run, some of which have dense rules.
template <class ACCESS>
void refineDenseFaces(RefinementTask const &task, PlainFaceMask const &faceMask,
                      RefinementRules::FaceRun const *rules, IndexRun run) {
    PreparedRefinement const &refinement = *task.refinement;
    Level const &parent = *refinement.parent;
    DenseFaceKernels const &kernels = GetDenseFaceKernels();
    DenseFaceKernels::Kernel const *const byWidth =
        ACCESS::kIsPacked ? kernels.packed : kernels.strided;
    byWidth[ACCESS::kWidth - 1]({&faceMask, refinement.denseMasks.data(), rules, run.begin, run.end,
                                 parent.faceFirstCorner[std::size_t(run.begin)],
                                 parent.faceVerts.data(), task.src, task.FVertices()});
}

// Faces of 3 to 6 sides.
template <class ACCESS, int SIZE, bool HAS_OPPOSITE>
void refineUnrolledFaces(RefinementTask const &task, PlainFaceMask const &faceMask, IndexRun run) {
    PreparedRefinement const &refinement = *task.refinement;
    Level const &parent = *refinement.parent;
    if constexpr (SIZE == DenseFaceMask::kSize) {
        RefinementRules::FaceRun const *const rules = refinement.rules->FindRun(run.begin);
        if (rules->rule != RefinementRules::kCirculant || rules[1].begin < run.end) {
            return refineDenseFaces<ACCESS>(task, faceMask, rules, run);
        }
    }
    Index const begin = parent.faceFirstCorner[std::size_t(run.begin)];
    Index const end = parent.faceFirstCorner[std::size_t(run.end)];
    PlainFaceQuads const mask(faceMask);
    Elements<float const> const src = task.src;
    Elements<float> const dst = task.FVertices();
    if (run.begin < GetNumFFaces(parent)) {
        HexIndexing const indexing = refinement.before->ChildIndexing();
        for (Index corner = begin; corner < end; corner += SIZE) {
            prefetchAhead(ACCESS::At(dst, corner));
            refineUnrolledFace<ACCESS, SIZE, HAS_OPPOSITE>(
                mask, src, ConsecutiveVertices{indexing.GetCornerChildVertex(corner)}, dst, corner);
        }
        return;
    }
    refineUnrolledFaces<ACCESS, SIZE, HAS_OPPOSITE>(mask, src, parent.faceVerts.data(), dst, begin,
                                                    end);
}

template <class ACCESS>
void refinePlainFaces(RefinementTask const &task, IndexRun run) {
    Level const &parent = *task.refinement->parent;
    Index const *const firstCorner = parent.faceFirstCorner.data() + run.begin;
    int const size = firstCorner[1] - firstCorner[0];
    PlainFaceMask const &mask = task.refinement->masks.faces[std::size_t(size)];
    switch (mask.weights.empty() ? size : 0) {
    case 3:
        return refineUnrolledFaces<ACCESS, 3, false>(task, mask, run);
    case 4:
        return refineUnrolledFaces<ACCESS, 4, false>(task, mask, run);
    case 5:
        return refineUnrolledFaces<ACCESS, 5, false>(task, mask, run);
    case 6:
        return mask.opposite != 0 ? refineUnrolledFaces<ACCESS, 6, true>(task, mask, run)
                                  : refineUnrolledFaces<ACCESS, 6, false>(task, mask, run);
    default:
        break;
    }
    Index corner = *firstCorner;
    for (Index face = run.begin; face < run.end; ++face, corner += size) {
        Index const *const verts = parent.faceVerts.data() + corner;
        if (mask.weights.empty()) {
            refinePlainFace<ACCESS>(mask, task.src, verts, size, task.FVertices(), corner);
        } else {
            refineWeightedFace<ACCESS>(mask.weights.data() + size, -1, task.src, verts, size,
                                       task.FVertices(), corner);
        }
    }
}

// V-vertices with three faces, the F-vertices that the faces of a run of \p level made.  SIZE is
// that of the faces, 0 for any.  sumPoints(first, size, prev, i) sums the F-vertices around the vertex of
// corner first + i of a face of so many, before which it has corner first + prev.
template <class ACCESS, int SIZE, class SUM_POINTS>
inline void refineFVerticesOf(RefinementTask const &task, Level const &level, IndexRun run,
                              SUM_POINTS sumPoints) {
    Index const *const firstCorner = level.faceFirstCorner.data() + run.begin;
    int const size = SIZE != 0 ? SIZE : firstCorner[1] - firstCorner[0];
    Quad const inverse = Spread(task.refinement->masks.verticesInverse[kFVertexFaces]);
    Index const end = firstCorner[run.end - run.begin];
    Elements<float const> const src = task.src;
    Elements<float> const dst = task.dst;
    HexIndexing const indexing = level.ChildIndexing();
    for (Index first = *firstCorner; first < end; first += size) {
        Index const vert = indexing.GetCornerChildVertex(first);
        prefetchAhead(ACCESS::At(dst, vert));
        for (int i = 0; i < size; ++i) {
            int const prev = (i == 0 ? size : i) - 1;
            auto const point =
                inverse * (ACCESS::Load(src, vert + i) + sumPoints(first, size, prev, i));
            if (i + 1 < size) {
                ACCESS::Store(dst, vert + i, point);
            } else {
                ACCESS::StoreExactly(dst, vert + i, point);
            }
        }
    }
}

// F-vertices of the parent that the vertices of a tile average.  The faces that have them are in the tile, and one
// thread makes all of a face: so what is read besides is of the same face.
template <class ACCESS>
auto loadCorner(Elements<float const> const &fVertices, Index firstCorner, int local,
                int faceSize) {
    return local + 1 < faceSize ? ACCESS::Load(fVertices, firstCorner + local)
                                : ACCESS::LoadWithBefore(fVertices, firstCorner + local);
}

// Those that E-faces have, all of which are hexagons but the last ones.
template <class ACCESS>
class EFacePoints {
public:
    EFacePoints(RefinementTask const &task, Level const &before)
        : _points(asConst(task.FVertices())), _indexing(before.ChildIndexing()) {}

    // That of corner \p local of the E-face of \p edge.
    auto Load(Index edge, int local) const {
        return loadCorner<ACCESS>(_points, _indexing.GetEdgeChildFirstCorner(edge, 0, 0), local,
                                  HexIndexing::kNumEFaceCorners);
    }

private:
    Elements<float const> const _points;
    HexIndexing const _indexing;
};

// Which side of its edge a face is, by corner: F-faces and E-faces of a hexagonal refinement.
struct SidesOfFFace {
    static constexpr EFaceSide const &Of(int) { return kEFaceSideA; }
};
struct SidesOfEFace {
    static constexpr EFaceSide const &Of(int i) {
        return FarExt::IsEFaceSideA(i) ? kEFaceSideA : kEFaceSideB;
    }
};

// From the corner of an E-face where a side starts to that where it ends.
constexpr int kFromStartToEnd = kEFaceSideA.endFVertex - kEFaceSideA.startFVertex;
static_assert(kFromStartToEnd == kEFaceSideB.endFVertex - kEFaceSideB.startFVertex);

// The F-vertices of the level before: each has the F-face of its face, and the E-faces of the edges
// that end and start at its corner.
template <class ACCESS, int SIZE, class SIDES>
void refineNewVertices(RefinementTask const &task, IndexRun run) {
    Level const &before = *task.refinement->before;
    Elements<float const> const fVertices = asConst(task.FVertices());
    EFacePoints<ACCESS> const ePoints(task, before);
    Index const *const faceEdges = before.faceEdges.data();
    refineFVerticesOf<ACCESS, SIZE>(task, before, run, [=](Index first, int size, int prev, int i) {
        Index const *const edges = faceEdges + first;
        return loadCorner<ACCESS>(fVertices, first, i, size) +
               (ePoints.Load(edges[prev], SIDES::Of(prev).endFVertex) +
                ePoints.Load(edges[i], SIDES::Of(i).startFVertex));
    });
}

// The same where the numbering does not tell which corners of the E-faces they are.
template <class ACCESS, int SIZE>
void refineListedVertices(RefinementTask const &task, IndexRun run) {
    Elements<float const> const fVertices = asConst(task.FVertices());
    Index const *const startCorners = task.refinement->startCorners.data();
    refineFVerticesOf<ACCESS, SIZE>(
        task, *task.refinement->before, run, [=](Index first, int size, int prev, int i) {
            Index const *const starts = startCorners + first;
            return loadCorner<ACCESS>(fVertices, first, i, size) +
                   (ACCESS::Load(fVertices, starts[prev] + kFromStartToEnd) +
                    ACCESS::LoadWithBefore(fVertices, starts[i]));
        });
}

// Those of the level before that one: each has the E-faces of its spoke and of two edges of its
// F-face, all numbered by corners.
template <class ACCESS, int SIZE>
void refineOlderVertices(RefinementTask const &task, IndexRun run) {
    Level const &before = *task.refinement->before;
    HexIndexing const indexing = task.refinement->beforeThat->ChildIndexing();
    EFacePoints<ACCESS> const ePoints(task, before);
    refineFVerticesOf<ACCESS, SIZE>(
        task, *task.refinement->beforeThat, run, [=](Index first, int /*size*/, int prev, int i) {
            // Each edge runs as the F-face does, from the F-vertex of its corner, and a spoke to that.
            return ePoints.Load(indexing.GetCornerChildEdge(first + i), kEFaceSideA.startVertex) +
                   (ePoints.Load(indexing.GetCornerChildEdge(first + prev), kEFaceSideA.endVertex) +
                    ePoints.Load(indexing.GetCornerChildSpoke(first + i), kEFaceSideA.endVertex));
        });
}

template <class ACCESS>
void refineVertexRun(RefinementTask const &task, VertexRun const &run) {
    if (!task.refinement->masks.averagesFaces) {
        for (Index vert = run.begin; vert < run.end; ++vert) {
            ACCESS::StoreExactly(task.dst, vert, ACCESS::LoadExactly(task.src, vert));
        }
        return;
    }
    Elements<float const> const fVertices = asConst(task.FVertices());
    float const *const inverses = task.refinement->masks.verticesInverse.data();
    Index const *const firstFaces = task.refinement->parent->vertFirstFace.data();
    Index const *corners = task.refinement->vertCorners.data() + run.firstCorner;
    for (Index vert = run.begin; vert < run.end; ++vert) {
        int const numFaces = firstFaces[vert + 1] - firstFaces[vert];
        auto sum = ACCESS::Load(task.src, vert);
        if (numFaces == kFVertexFaces) {
            sum = sum + ACCESS::LoadExactly(fVertices, corners[0]);
            sum = sum + ACCESS::LoadExactly(fVertices, corners[1]);
            sum = sum + ACCESS::LoadExactly(fVertices, corners[2]);
        } else {
            for (int i = 0; i < numFaces; ++i) {
                sum = sum + ACCESS::LoadExactly(fVertices, corners[i]);
            }
        }
        corners += numFaces;
        ACCESS::StoreExactly(task.dst, vert, Spread(inverses[numFaces]) * sum);
    }
}

template <class ACCESS>
void refineWeightedVertex(RefinementTask const &task, WeightedVertex const &vertex) {
    auto point = Spread(vertex.vertexWeight) * ACCESS::LoadExactly(task.src, vertex.vert);
    if (vertex.neighborWeights[0] != 0) {
        // Two neighbors that may change places.
        auto const atNeighbor = [&](int i) {
            return Spread(vertex.neighborWeights[i]) *
                   ACCESS::LoadExactly(task.src, vertex.neighbors[i]);
        };
        point = (atNeighbor(0) + atNeighbor(1)) + point;
    }
    Level const &parent = *task.refinement->parent;
    Index const *const firstFace = parent.vertFirstFace.data() + vertex.vert;
    if (vertex.faceWeight != 0 && firstFace[0] < firstFace[1]) {
        Elements<float const> const fVertices = asConst(task.FVertices());
        auto sum = ACCESS::LoadExactly(fVertices, parent.GetVertexCorner(firstFace[0]));
        for (Index k = firstFace[0] + 1; k < firstFace[1]; ++k) {
            sum = sum + ACCESS::LoadExactly(fVertices, parent.GetVertexCorner(k));
        }
        point = point + Spread(vertex.faceWeight) * sum;
    }
    ACCESS::StoreExactly(task.dst, vertex.child, point);
}

int getFaceSize(Level const &level, IndexRun run) {
    Index const *const firstCorner = level.faceFirstCorner.data() + run.begin;
    return firstCorner[1] - firstCorner[0];
}
bool areHexagons(Level const &level, IndexRun run) {
    return getFaceSize(level, run) == HexIndexing::kNumEFaceCorners;
}

template <class ACCESS>
struct FaceKernel {
    static void Run(RefinementTask const &task, IndexRun const *begin, IndexRun const *end) {
        for (; begin < end; ++begin) {
            refinePlainFaces<ACCESS>(task, *begin);
        }
    }
    static void Run(RefinementTask const &task, WeightedFace const *begin,
                    WeightedFace const *end) {
        for (; begin < end; ++begin) {
            refineWeightedFace<ACCESS>(task.refinement->faceWeights.data() + begin->firstWeight,
                                       begin->size, task.src, begin->verts, begin->size,
                                       task.FVertices(), begin->corner);
        }
    }
};
template <class ACCESS>
struct ListedVertexKernel {
    static void Run(RefinementTask const &task, ListedVertex const *begin,
                    ListedVertex const *end) {
        for (; begin < end; ++begin) {
            Index const *const sources = task.refinement->listedSources.data() + begin->firstSource;
            float const *const weights = task.refinement->listedWeights.data() + begin->firstSource;
            auto point = Spread(weights[0]) * ACCESS::LoadExactly(task.src, sources[0]);
            for (int i = 1; i < begin->numSources; ++i) {
                point = point + Spread(weights[i]) * ACCESS::LoadExactly(task.src, sources[i]);
            }
            ACCESS::StoreExactly(task.dst, begin->child, point);
        }
    }
};
template <class ACCESS>
struct VertexKernel {
    static void Run(RefinementTask const &task, VertexRun const *begin, VertexRun const *end) {
        for (; begin < end; ++begin) {
            refineVertexRun<ACCESS>(task, *begin);
        }
    }
    static void Run(RefinementTask const &task, WeightedVertex const *begin,
                    WeightedVertex const *end) {
        for (; begin < end; ++begin) {
            refineWeightedVertex<ACCESS>(task, *begin);
        }
    }
};

template <class ACCESS>
struct NewVertexKernel {
    static void Run(RefinementTask const &task, IndexRun const *begin, IndexRun const *end) {
        for (; begin < end; ++begin) {
            Level const &before = *task.refinement->before;
            if (!task.refinement->startCorners.empty()) {
                switch (getFaceSize(before, *begin)) {
                case 3:
                    refineListedVertices<ACCESS, 3>(task, *begin);
                    break;
                case 4:
                    refineListedVertices<ACCESS, 4>(task, *begin);
                    break;
                case 6:
                    refineListedVertices<ACCESS, 6>(task, *begin);
                    break;
                default:
                    refineListedVertices<ACCESS, 0>(task, *begin);
                }
            } else if (begin->begin >= GetNumFFaces(before)) {
                refineNewVertices<ACCESS, HexIndexing::kNumEFaceCorners, SidesOfEFace>(task,
                                                                                       *begin);
            } else if (areHexagons(before, *begin)) {
                refineNewVertices<ACCESS, HexIndexing::kNumEFaceCorners, SidesOfFFace>(task,
                                                                                       *begin);
            } else {
                refineNewVertices<ACCESS, 0, SidesOfFFace>(task, *begin);
            }
        }
    }
};
template <class ACCESS>
struct OlderVertexKernel {
    static void Run(RefinementTask const &task, IndexRun const *begin, IndexRun const *end) {
        for (; begin < end; ++begin) {
            Level const &level = *task.refinement->beforeThat;
            if (areHexagons(level, *begin)) {
                refineOlderVertices<ACCESS, HexIndexing::kNumEFaceCorners>(task, *begin);
            } else {
                refineOlderVertices<ACCESS, 0>(task, *begin);
            }
        }
    }
};

// Elements of any length, up to eight floats at a time.
template <template <class> class KERNEL, class ITEM>
void runKernel(RefinementTask task, int length, ITEM const *begin, ITEM const *end) {
    if (task.src.stride == length && task.dst.stride == length) {
        switch (length) {
        case 1:
            return KERNEL<Access<1, true>>::Run(task, begin, end);
        case 2:
            return KERNEL<Access<2, true>>::Run(task, begin, end);
        case 3:
            return KERNEL<Access<3, true>>::Run(task, begin, end);
        case 4:
            return KERNEL<Access<4, true>>::Run(task, begin, end);
        default:
            break;
        }
    }
    for (; length > kQuadPair; length -= kQuadPair) {
        KERNEL<Access<kQuadPair, false>>::Run(task, begin, end);
        task.src.data += kQuadPair;
        task.dst.data += kQuadPair;
    }
    switch (length) {
    case 1:
        return KERNEL<Access<1, false>>::Run(task, begin, end);
    case 2:
        return KERNEL<Access<2, false>>::Run(task, begin, end);
    case 3:
        return KERNEL<Access<3, false>>::Run(task, begin, end);
    case 4:
        return KERNEL<Access<4, false>>::Run(task, begin, end);
    case 5:
        return KERNEL<Access<5, false>>::Run(task, begin, end);
    case 6:
        return KERNEL<Access<6, false>>::Run(task, begin, end);
    case 7:
        return KERNEL<Access<7, false>>::Run(task, begin, end);
    case 8:
        return KERNEL<Access<8, false>>::Run(task, begin, end);
    default:
        break;
    }
}

template <template <class> class KERNEL, class ITEM>
void runKernel(RefinementTask const &task, int length, Groups<ITEM> const &groups, int group) {
    if (!groups.IsEmpty()) {
        runKernel<KERNEL>(task, length, groups.Begin(group), groups.End(group));
    }
}

void refineVertices(RefinementTask const &task, int length, int group) {
    PreparedRefinement const &groups = *task.refinement;
    runKernel<NewVertexKernel>(task, length, groups.newVertexFaces, group);
    runKernel<OlderVertexKernel>(task, length, groups.olderVertexFaces, group);
    runKernel<VertexKernel>(task, length, groups.vertexRuns, group);
    runKernel<VertexKernel>(task, length, groups.weightedVertices, group);
}

// Calls function(group) for groups [begin, end), in parallel.  It throws nothing.
template <typename FUNCTION>
void forEachGroup(int begin, int end, FUNCTION const &function) {
    auto const work = [&](FarExt::internal::RangeQueue &queue, int worker) {
        for (int group = 0; queue.Take(worker, &group);) {
            function(begin + group);
        }
    };
    FarExt::internal::ForEachRange(end - begin, 1, std::cref(work));
}

} // namespace

void RefineElements(std::vector<RefinementTask> const &tasks, int length) {
    for (RefinementTask const &task : tasks) {
        PreparedRefinement const &refinement = *task.refinement;
        forEachGroup(0, refinement.numTiles, [&](int tile) {
            runKernel<ListedVertexKernel>(task, length, refinement.listedVertices, tile);
            runKernel<FaceKernel>(task, length, refinement.faceRuns, tile);
            runKernel<FaceKernel>(task, length, refinement.weightedFaces, tile);
            refineVertices(task, length, tile);
        });
        // Their F-vertices are in several tiles, which are done by now.
        forEachGroup(refinement.numTiles, refinement.GetNumVertexGroups(),
                     [&](int group) { refineVertices(task, length, group); });
    }
}

} // namespace OpenSubdivHex::OsdExt::internal

// SPDX-License-Identifier: Apache-2.0
#include "refinementKernel.h"

#include "far_ext/indexing.h"
#include "far_ext/vtr/parallel.h"
#include "osd_ext/simd/quad.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <functional>

namespace OpenSubdivHex::OsdExt::internal {

using Far::Index;
using FarExt::EFaceSide;
using FarExt::HexIndexing;
using FarExt::kEFaceSideA;
using FarExt::kEFaceSideB;
using FarExt::internal::Level;

namespace {

constexpr int kMinPlainSize = 3;
constexpr int kFVertexFaces = 3; // around an F-vertex

constexpr int kQuadPair = 8;

// Asks for memory that is read or written soon, one line in each turn of a loop over it: benchmark
// table-free, large meshes, 1.1 times as fast with it.
template <class T>
inline void prefetchAhead([[maybe_unused]] T const *place) {
#if defined(__GNUC__)
    constexpr std::uintptr_t kBytesAhead = 4096;
    // A number, since a pointer may not lead behind the end of its array.
    __builtin_prefetch(
        reinterpret_cast<void const *>(reinterpret_cast<std::uintptr_t>(place) + kBytesAhead));
#endif
}

// Eight floats.
struct QuadPair {
    Quad first;
    Quad second;
};
inline QuadPair operator+(QuadPair const &a, QuadPair const &b) {
    return {a.first + b.first, a.second + b.second};
}
inline QuadPair operator*(Quad const &a, QuadPair const &b) { return {a * b.first, a * b.second}; }

// Reads WIDTH floats, 1 to 8, and not one more.
template <int WIDTH>
inline auto loadExactly(float const *src) {
    if constexpr (WIDTH > kQuad) {
        return QuadPair{LoadFloats<kQuad>(src), LoadFloats<WIDTH - kQuad>(src + kQuad)};
    } else {
        return LoadFloats<WIDTH>(src);
    }
}
template <int WIDTH>
inline void storeExactly(float *dst, Quad const &quad) {
    StoreFloats<WIDTH>(dst, quad);
}
template <int WIDTH>
inline void storeExactly(float *dst, QuadPair const &pair) {
    StoreFloats<kQuad>(dst, pair.first);
    StoreFloats<WIDTH - kQuad>(dst + kQuad, pair.second);
}

// Whether one float more may be read than is used, while another thread may be writing it.  It is what
// ThreadSanitizer looks for.
#if defined(__SANITIZE_THREAD__)
constexpr bool kReadsMore = false;
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
constexpr bool kReadsMore = false;
#else
constexpr bool kReadsMore = true;
#endif
#else
constexpr bool kReadsMore = true;
#endif

// How elements of WIDTH floats are read and written.  A quad of three packed floats takes in the
// first of the next element.
template <int WIDTH, bool IS_PACKED>
struct Access {
    static constexpr int kReach = kReadsMore && IS_PACKED && WIDTH == 3 ? kQuad : WIDTH;

    template <class FLOAT>
    static FLOAT *At(Elements<FLOAT> const &elements, std::ptrdiff_t i) {
        return elements.data + i * (IS_PACKED ? WIDTH : elements.stride);
    }
    static auto LoadExactly(Elements<float const> const &src, std::ptrdiff_t i) {
        return loadExactly<WIDTH>(At(src, i));
    }
    static auto Load(Elements<float const> const &src, std::ptrdiff_t i) {
        return loadExactly<kReach>(At(src, i));
    }
    template <class QUADS>
    static void StoreExactly(Elements<float> const &dst, std::ptrdiff_t i, QUADS const &quads) {
        storeExactly<WIDTH>(At(dst, i), quads);
    }
    // The next element must be stored afterwards.
    template <class QUADS>
    static void Store(Elements<float> const &dst, std::ptrdiff_t i, QUADS const &quads) {
        storeExactly<kReach>(At(dst, i), quads);
    }
};

Elements<float const> asConst(Elements<float> const &elements) {
    return {elements.data, elements.stride};
}

// The vertices of F-faces, which follow one another.
struct ConsecutiveVertices {
    Index operator[](int i) const { return first + i; }

    Index first;
};

// The weights of a plain face, in registers.
struct PlainFaceQuads {
    explicit PlainFaceQuads(PlainFaceMask const &mask)
        : self(Spread(mask.self)), neighbor(Spread(mask.neighbor)), opposite(Spread(mask.opposite)),
          all(Spread(mask.all)) {}

    Quad self;
    Quad neighbor;
    Quad opposite;
    Quad all;
};

// A plain face of 3 to 6 sides.
template <class ACCESS, int SIZE, bool HAS_OPPOSITE, class VERTICES>
inline void refineUnrolledFace(PlainFaceQuads const &mask, Elements<float const> const &src,
                               VERTICES verts, Elements<float> const &dst, Index corner) {
    decltype(ACCESS::Load(src, 0)) v[SIZE];
    for (int i = 0; i < SIZE; ++i) {
        v[i] = ACCESS::Load(src, verts[i]);
    }
    auto sum = v[0] + v[1];
    for (int i = 2; i < SIZE; ++i) {
        sum = sum + v[i];
    }
    auto const all = mask.all * sum;
    for (int i = 0; i < SIZE; ++i) {
        auto point = all + mask.self * v[i];
        if (SIZE > kMinPlainSize) {
            point = point + mask.neighbor * (v[(i + SIZE - 1) % SIZE] + v[(i + 1) % SIZE]);
        }
        if (HAS_OPPOSITE) {
            point = point + mask.opposite * v[(i + SIZE / 2) % SIZE];
        }
        if (i + 1 < SIZE) {
            ACCESS::Store(dst, corner + i, point);
        } else {
            ACCESS::StoreExactly(dst, corner + i, point);
        }
    }
}

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

// Plain faces of 3 to 6 sides.
template <class ACCESS, int SIZE, bool HAS_OPPOSITE>
void refineUnrolledFaces(RefinementTask const &task, PlainFaceMask const &faceMask, IndexRun run) {
    PlainFaceQuads const mask(faceMask);
    Elements<float const> const src = task.src;
    Elements<float> const dst = task.FVertices();
    Level const &parent = *task.refinement->parent;
    Index corner = parent.faceFirstCorner[std::size_t(run.begin)];
    Index const end = parent.faceFirstCorner[std::size_t(run.end)];
    if (run.begin < GetNumFFaces(parent)) {
        HexIndexing const indexing = task.refinement->before->ChildIndexing();
        for (; corner < end; corner += SIZE) {
            prefetchAhead(ACCESS::At(dst, corner));
            refineUnrolledFace<ACCESS, SIZE, HAS_OPPOSITE>(
                mask, src, ConsecutiveVertices{indexing.GetCornerChildVertex(corner)}, dst, corner);
        }
    } else {
        Index const *verts = parent.faceVerts.data() + corner;
        for (; corner < end; corner += SIZE, verts += SIZE) {
            prefetchAhead(verts);
            prefetchAhead(ACCESS::At(dst, corner));
            refineUnrolledFace<ACCESS, SIZE, HAS_OPPOSITE>(mask, src, verts, dst, corner);
        }
    }
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
// that of the faces, 0 for any.  sumPoints(first, prev, i) sums the F-vertices around the vertex of
// corner first + i, before which the face has corner first + prev.
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
            auto const point = inverse * (ACCESS::Load(src, vert + i) + sumPoints(first, prev, i));
            if (i + 1 < size) {
                ACCESS::Store(dst, vert + i, point);
            } else {
                ACCESS::StoreExactly(dst, vert + i, point);
            }
        }
    }
}

// The F-vertices of the parent that E-faces have, all of which are hexagons but the last ones.
template <class ACCESS>
class EFacePoints {
public:
    EFacePoints(RefinementTask const &task, Level const &before)
        : _points(asConst(task.FVertices())), _indexing(before.ChildIndexing()) {}

    // That of corner \p local of the E-face of \p edge.
    auto Load(Index edge, int local) const {
        return ACCESS::Load(_points, _indexing.GetEdgeChildFirstCorner(edge, 0, 0) + local);
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
    refineFVerticesOf<ACCESS, SIZE>(task, before, run, [=](Index first, int prev, int i) {
        Index const *const edges = faceEdges + first;
        return ACCESS::Load(fVertices, first + i) +
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
        task, *task.refinement->before, run, [=](Index first, int prev, int i) {
            Index const *const starts = startCorners + first;
            return ACCESS::Load(fVertices, first + i) +
                   (ACCESS::Load(fVertices, starts[prev] + kFromStartToEnd) +
                    ACCESS::Load(fVertices, starts[i]));
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
        task, *task.refinement->beforeThat, run, [=](Index first, int prev, int i) {
            // Each edge runs as the F-face does, from the F-vertex of its corner, and a spoke to that.
            return ePoints.Load(indexing.GetCornerChildEdge(first + i), kEFaceSideA.startVertex) +
                   (ePoints.Load(indexing.GetCornerChildEdge(first + prev), kEFaceSideA.endVertex) +
                    ePoints.Load(indexing.GetCornerChildSpoke(first + i), kEFaceSideA.endVertex));
        });
}

template <class ACCESS>
void refinePlainVertices(RefinementTask const &task, VertexRun const &run) {
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
            sum = sum + ACCESS::Load(fVertices, corners[0]);
            sum = sum + ACCESS::Load(fVertices, corners[1]);
            sum = sum + ACCESS::Load(fVertices, corners[2]);
        } else {
            for (int i = 0; i < numFaces; ++i) {
                sum = sum + ACCESS::Load(fVertices, corners[i]);
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
    static void Run(RefinementTask const &task, WeightedCorner const *begin,
                    WeightedCorner const *end) {
        for (; begin < end; ++begin) {
            refineWeightedCorner<ACCESS>(task.refinement->faceWeights.data() + begin->firstWeight,
                                         task.src, begin->verts, begin->size, task.FVertices(),
                                         begin->corner);
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
            refinePlainVertices<ACCESS>(task, *begin);
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
    PreparedRefinement const &refinement = *task.refinement;
    runKernel<NewVertexKernel>(task, length, refinement.newVertexFaces, group);
    runKernel<OlderVertexKernel>(task, length, refinement.olderVertexFaces, group);
    runKernel<VertexKernel>(task, length, refinement.plainVertices, group);
    runKernel<VertexKernel>(task, length, refinement.weightedVertices, group);
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
            runKernel<FaceKernel>(task, length, refinement.plainFaces, tile);
            runKernel<FaceKernel>(task, length, refinement.weightedFaces, tile);
            runKernel<FaceKernel>(task, length, refinement.weightedCorners, tile);
            refineVertices(task, length, tile);
        });
        // Their F-vertices are in several tiles, which are done by now.
        forEachGroup(refinement.numTiles, refinement.GetNumVertexGroups(),
                     [&](int group) { refineVertices(task, length, group); });
    }
}

} // namespace OpenSubdivHex::OsdExt::internal

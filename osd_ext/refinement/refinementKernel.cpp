// SPDX-License-Identifier: Apache-2.0
#include "refinementKernel.h"

#include "denseFaceKernel.h"
#include "plainFaceKernel.h"

#include "far_ext/vtr/parallel.h"

#include <functional>

namespace OpenSubdivHex::OsdExt::internal {

using Far::Index;
using FarExt::internal::kFVertexFaces;
using FarExt::internal::Level;
using FarExt::internal::RefinementRules;

namespace {

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
        // Zero weights are skipped: they would change the sign of a zero.
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
    refineUnrolledFaces<ACCESS, SIZE, HAS_OPPOSITE>(mask, task.src, parent.faceVerts.data(),
                                                    task.FVertices(), begin, end);
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

// A plain vertex, of the F-vertices at the corners around it.  Nearly all have three.
template <class ACCESS>
OPENSUBDIVHEX_INLINE auto sumOfPlain(float const *inverses, Elements<float const> const &src,
                                     Elements<float const> const &fVertices, Index vert,
                                     Index const *corners, int numFaces) {
    auto sum = ACCESS::Load(src, vert);
    if (numFaces == kFVertexFaces) {
        sum = sum + (ACCESS::Load(fVertices, corners[0]) +
                     (ACCESS::Load(fVertices, corners[1]) + ACCESS::Load(fVertices, corners[2])));
    } else {
        for (int i = 0; i < numFaces; ++i) {
            sum = sum + ACCESS::Load(fVertices, corners[i]);
        }
    }
    return Spread(inverses[numFaces]) * sum;
}

// A vertex with weights for itself and for each of these F-vertices, which are summed up from the last one on.  All
// weights of three are read at once: reads bound this kernel (benchmark all levels, Smooth/quad/small: 1.1 times as fast).
template <class ACCESS>
OPENSUBDIVHEX_INLINE auto sumOfWeighted(float const *weights, Elements<float const> const &src,
                                        Elements<float const> const &fVertices, Index vert,
                                        Index const *corners, int numFaces) {
    auto const load = [&](int i) { return ACCESS::Load(fVertices, corners[i]); };
    auto const own = ACCESS::Load(src, vert);
    if (numFaces == kFVertexFaces) {
        Quad const all = LoadFloats<1 + kFVertexFaces>(weights);
        return SpreadElement<0>(all) * own +
               (SpreadElement<1>(all) * load(0) +
                (SpreadElement<2>(all) * load(1) + SpreadElement<3>(all) * load(2)));
    }
    auto sum = Spread(weights[numFaces]) * load(numFaces - 1);
    for (int i = numFaces - 2; i >= 0; --i) {
        sum = sum + Spread(weights[i + 1]) * load(i);
    }
    return Spread(weights[0]) * own + sum;
}

// It also reads vertices of faces that are done, and of the level before.
template <class ACCESS>
void refineVertexRun(RefinementTask const &task, VertexRun run) {
    PreparedRefinement const &refinement = *task.refinement;
    Elements<float const> const src = task.src;
    Elements<float> const dst = task.dst;
    if (!refinement.masks.averagesFaces) {
        for (Index vert = run.begin; vert < run.end; ++vert) {
            ACCESS::StoreExactly(dst, vert, ACCESS::LoadExactly(src, vert));
        }
        return;
    }
    Elements<float const> const fVertices = asConst(task.FVertices());
    Index const *const firstFaces = refinement.parent->vertFirstFace.data();
    Index const *corners = refinement.vertCorners.data() + firstFaces[run.begin];
    float const *const inverses = refinement.masks.verticesInverse.data();
    float const *const weights = refinement.vertexWeights.data();
    int const *const positions = refinement.rules->GetWeightsOfVertices();
    Index const last = run.end - 1;
    if (run.haveThreeFaces) {
        auto const refine = [&](auto const &sum) {
            for (Index vert = run.begin; vert < last; ++vert, corners += kFVertexFaces) {
                ACCESS::Store(dst, vert, sum(vert));
            }
            ACCESS::StoreExactly(dst, last, sum(last));
        };
        if (run.haveWeights) {
            refine([&](Index vert) {
                return sumOfWeighted<ACCESS>(weights + positions[vert], src, fVertices, vert,
                                             corners, kFVertexFaces);
            });
        } else {
            refine([&](Index vert) {
                return sumOfPlain<ACCESS>(inverses, src, fVertices, vert, corners, kFVertexFaces);
            });
        }
        return;
    }
    for (Index vert = run.begin; vert < run.end; ++vert) {
        int const numFaces = firstFaces[vert + 1] - firstFaces[vert];
        int const position = run.haveWeights ? positions[vert] : RefinementRules::kPlain;
        ACCESS::StoreExactly(
            dst, vert,
            position == RefinementRules::kPlain
                ? sumOfPlain<ACCESS>(inverses, src, fVertices, vert, corners, numFaces)
                : sumOfWeighted<ACCESS>(weights + position, src, fVertices, vert, corners,
                                        numFaces));
        corners += numFaces;
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
        auto const load = [&](Index k) {
            return ACCESS::LoadExactly(fVertices, parent.GetVertexCorner(k));
        };
        if (vertex.firstFaceWeight != WeightedVertex::kEqual) {
            // From the last one on, as in runs.
            Index const last = firstFace[1] - 1;
            float const *weight = task.refinement->vertexWeights.data() + vertex.firstFaceWeight +
                                  (last - firstFace[0]);
            auto sum = Spread(*weight) * load(last);
            for (Index k = last - 1; k >= firstFace[0]; --k) {
                sum = sum + Spread(*--weight) * load(k);
            }
            point = point + sum;
        } else {
            auto sum = load(firstFace[0]);
            for (Index k = firstFace[0] + 1; k < firstFace[1]; ++k) {
                sum = sum + load(k);
            }
            point = point + Spread(vertex.faceWeight) * sum;
        }
    }
    ACCESS::StoreExactly(task.dst, vertex.child, point);
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

// Calls function(group) for all of so many groups, in parallel.  It throws nothing.
template <typename FUNCTION>
void forEachGroup(int numGroups, FUNCTION const &function) {
    auto const work = [&](FarExt::internal::RangeQueue &queue, int worker) {
        for (int group = 0; queue.Take(worker, &group);) {
            function(group);
        }
    };
    FarExt::internal::ForEachRange(numGroups, 1, std::cref(work));
}

} // namespace

void RefineElements(std::vector<RefinementTask> const &tasks, int length) {
    for (RefinementTask const &task : tasks) {
        PreparedRefinement const &refinement = *task.refinement;
        forEachGroup(refinement.listedVertices.GetNumGroups(), [&](int group) {
            runKernel<ListedVertexKernel>(task, length, refinement.listedVertices, group);
        });
        forEachGroup(refinement.faceRuns.GetNumGroups(), [&](int group) {
            runKernel<FaceKernel>(task, length, refinement.faceRuns, group);
            runKernel<FaceKernel>(task, length, refinement.weightedFaces, group);
        });
        forEachGroup(refinement.vertexRuns.GetNumGroups(), [&](int group) {
            runKernel<VertexKernel>(task, length, refinement.vertexRuns, group);
            runKernel<VertexKernel>(task, length, refinement.weightedVertices, group);
        });
    }
}

} // namespace OpenSubdivHex::OsdExt::internal

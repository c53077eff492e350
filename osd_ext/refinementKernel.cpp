// SPDX-License-Identifier: Apache-2.0
#include "refinementKernel.h"

#include "far_ext/parallel.h"

#include <algorithm>
#include <cstring>
#include <numeric>

namespace OpenSubdivHex::OsdExt::internal {

using Far::Index;
using FarExt::TopologyLevel;
using FarExt::internal::LevelTopology;
using FarExt::internal::RefinementMask;

namespace {

constexpr int kMinPlainSize = 3;
constexpr int kMaxUnrolledSize = 6;
/// Corners of a tile, a sixteenth of the level's between these bounds: 1.5 MiB of new points of
/// length 3 at most.
constexpr Index kMinTileCorners = 16384;
constexpr Index kMaxTileCorners = 131072;
constexpr Index kTilesPerLevel = 16;
/// Vertices that a thread takes at a time of those between the tiles.
constexpr int kVertexBatch = 1024;
/// Tiles that a TileMap distinguishes, and the least faces of the level that they are made of.
constexpr Index kNumMapTiles = 1024;
constexpr Index kMinMapFaces = 4 * kNumMapTiles;

constexpr int kPacket = 4;
constexpr int kPacketPair = 8;

// Four floats in a register.
#if defined(__GNUC__)
using Packet = float __attribute__((vector_size(kPacket * sizeof(float))));

inline Packet spread(float value) { return Packet{value, value, value, value}; }
#else
struct Packet {
    float values[kPacket];
};

template <class FUNCTION>
inline Packet forEachFloat(FUNCTION function) {
    Packet result;
    for (int i = 0; i < kPacket; ++i) {
        result.values[i] = function(i);
    }
    return result;
}
inline Packet spread(float value) {
    return forEachFloat([&](int) { return value; });
}
inline Packet operator+(Packet const &a, Packet const &b) {
    return forEachFloat([&](int i) { return a.values[i] + b.values[i]; });
}
inline Packet operator*(Packet const &a, Packet const &b) {
    return forEachFloat([&](int i) { return a.values[i] * b.values[i]; });
}
#endif

// Eight floats.
struct PacketPair {
    Packet first;
    Packet second;
};
inline PacketPair operator+(PacketPair const &a, PacketPair const &b) {
    return {a.first + b.first, a.second + b.second};
}
inline PacketPair operator*(Packet const &a, PacketPair const &b) {
    return {a * b.first, a * b.second};
}

// Reads the first WIDTH floats, 1 to 4, and not one more; the others are 0.
template <int WIDTH>
inline Packet loadNarrow(float const *src) {
    if constexpr (WIDTH == kPacket) {
        Packet result;
        std::memcpy(&result, src, sizeof(result));
        return result;
    } else {
        return Packet{src[0], WIDTH > 1 ? src[1] : 0, WIDTH > 2 ? src[2] : 0, 0};
    }
}
// The same for 1 to 8.
template <int WIDTH>
inline auto loadExactly(float const *src) {
    if constexpr (WIDTH > kPacket) {
        return PacketPair{loadNarrow<kPacket>(src), loadNarrow<WIDTH - kPacket>(src + kPacket)};
    } else {
        return loadNarrow<WIDTH>(src);
    }
}
template <int WIDTH, class PACKET>
inline void storeExactly(float *dst, PACKET const &packet) {
    std::memcpy(dst, &packet, WIDTH * sizeof(float));
}

// How elements of WIDTH floats are read and written.  A packet of three packed floats takes in the
// first of the next element.
template <int WIDTH, bool IS_PACKED>
struct Access {
    static constexpr int kReach = IS_PACKED && WIDTH == 3 ? kPacket : WIDTH;

    template <class FLOAT>
    static FLOAT *At(Elements<FLOAT> const &elements, Index i) {
        return elements.data + std::ptrdiff_t(i) * (IS_PACKED ? WIDTH : elements.stride);
    }
    static auto LoadExactly(Elements<float const> const &src, Index i) {
        return loadExactly<WIDTH>(At(src, i));
    }
    static auto Load(Elements<float const> const &src, Index i) {
        return loadExactly<kReach>(At(src, i));
    }
    template <class PACKET>
    static void StoreExactly(Elements<float> const &dst, Index i, PACKET const &packet) {
        storeExactly<WIDTH>(At(dst, i), packet);
    }
    // The next element must be stored afterwards.
    template <class PACKET>
    static void Store(Elements<float> const &dst, Index i, PACKET const &packet) {
        storeExactly<kReach>(At(dst, i), packet);
    }
};

// One refinement of some of the floats of all elements.
struct Task {
    RefinementStep const &step;
    Elements<float const> src;
    Elements<float> dst;

    // The F-vertices, by corner.
    Elements<float> FVertices() const {
        return {dst.data + std::ptrdiff_t(step.numVVertices) * dst.stride, dst.stride};
    }
};

Elements<float const> asConst(Elements<float> const &elements) {
    return {elements.data, elements.stride};
}

// A plain face of 3 to 6 sides.
template <class ACCESS, int SIZE, bool HAS_OPPOSITE>
inline void refineUnrolledFace(PlainFaceMask const &mask, Elements<float const> const &src,
                               Index const *verts, Elements<float> const &dst, Index corner) {
    decltype(ACCESS::Load(src, 0)) v[SIZE];
    for (int i = 0; i < SIZE; ++i) {
        v[i] = ACCESS::Load(src, verts[i]);
    }
    auto sum = v[0] + v[1];
    for (int i = 2; i < SIZE; ++i) {
        sum = sum + v[i];
    }
    Packet const self = spread(mask.self);
    Packet const neighbor = spread(mask.neighbor);
    auto const all = spread(mask.all) * sum;
    for (int i = 0; i < SIZE; ++i) {
        auto point = all + self * v[i];
        if (SIZE > kMinPlainSize) {
            point = point + neighbor * (v[(i + SIZE - 1) % SIZE] + v[(i + 1) % SIZE]);
        }
        if (HAS_OPPOSITE) {
            point = point + spread(mask.opposite) * v[(i + SIZE / 2) % SIZE];
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
    all = spread(mask.all) * all;
    for (int i = 0; i < size; ++i) {
        auto const neighbors = ACCESS::LoadExactly(src, verts[i == 0 ? size - 1 : i - 1]) +
                               ACCESS::LoadExactly(src, verts[i + 1 == size ? 0 : i + 1]);
        auto const point = all + spread(mask.self) * ACCESS::LoadExactly(src, verts[i]) +
                           spread(mask.neighbor) * neighbors;
        ACCESS::StoreExactly(dst, corner + i, point);
    }
}

// A face with a row of weights for each corner, rowStep floats apart.
template <class ACCESS>
void refineWeightedFace(float const *weights, std::ptrdiff_t rowStep,
                        Elements<float const> const &src, Index const *verts, int size,
                        Elements<float> const &dst, Index corner) {
    for (int i = 0; i < size; ++i, weights += rowStep) {
        auto point = spread(weights[0]) * ACCESS::LoadExactly(src, verts[0]);
        for (int j = 1; j < size; ++j) {
            point = point + spread(weights[j]) * ACCESS::LoadExactly(src, verts[j]);
        }
        ACCESS::StoreExactly(dst, corner + i, point);
    }
}

template <class ACCESS>
void refinePlainFaces(Task const &task, IndexRun run) {
    Elements<float> const dst = task.FVertices();
    LevelTopology const &parent = *task.step.parent;
    Index const *const firstCorners = parent.faceFirstCorner.data();
    Index corner = firstCorners[run.begin];
    for (Index face = run.begin; face < run.end; ++face) {
        Index const *const verts = parent.faceVerts.data() + corner;
        Index const nextCorner = firstCorners[face + 1];
        int const size = nextCorner - corner;
        PlainFaceMask const &mask = task.step.masks.faces[std::size_t(size)];
        switch (mask.weights.empty() ? size : 0) {
        case 3:
            refineUnrolledFace<ACCESS, 3, false>(mask, task.src, verts, dst, corner);
            break;
        case 4:
            refineUnrolledFace<ACCESS, 4, false>(mask, task.src, verts, dst, corner);
            break;
        case 5:
            refineUnrolledFace<ACCESS, 5, false>(mask, task.src, verts, dst, corner);
            break;
        case 6:
            if (mask.opposite != 0) {
                refineUnrolledFace<ACCESS, 6, true>(mask, task.src, verts, dst, corner);
            } else {
                refineUnrolledFace<ACCESS, 6, false>(mask, task.src, verts, dst, corner);
            }
            break;
        default:
            if (mask.weights.empty()) {
                refinePlainFace<ACCESS>(mask, task.src, verts, size, dst, corner);
            } else {
                refineWeightedFace<ACCESS>(mask.weights.data() + size, -1, task.src, verts, size,
                                           dst, corner);
            }
        }
        corner = nextCorner;
    }
}

template <class ACCESS>
void refinePlainVertices(Task const &task, IndexRun run) {
    if (!task.step.masks.averagesFaces) {
        for (Index vert = run.begin; vert < run.end; ++vert) {
            ACCESS::StoreExactly(task.dst, vert, ACCESS::LoadExactly(task.src, vert));
        }
        return;
    }
    Elements<float const> const fVertices = asConst(task.FVertices());
    float const *const inverses = task.step.masks.verticesInverse.data();
    Index const *const firstFaces = task.step.parent->vertFirstFace.data();
    Index const *corners = task.step.vertCorners.data() + firstFaces[run.begin];
    for (Index vert = run.begin; vert < run.end; ++vert) {
        int const numFaces = firstFaces[vert + 1] - firstFaces[vert];
        auto sum = ACCESS::Load(task.src, vert);
        if (numFaces == 3) {
            sum = sum + ACCESS::Load(fVertices, corners[0]);
            sum = sum + ACCESS::Load(fVertices, corners[1]);
            sum = sum + ACCESS::Load(fVertices, corners[2]);
        } else {
            for (int i = 0; i < numFaces; ++i) {
                sum = sum + ACCESS::Load(fVertices, corners[i]);
            }
        }
        corners += numFaces;
        ACCESS::StoreExactly(task.dst, vert, spread(inverses[numFaces]) * sum);
    }
}

template <class ACCESS>
void refineWeightedVertex(Task const &task, WeightedVertex const &vertex) {
    auto point = spread(vertex.vertexWeight) * ACCESS::LoadExactly(task.src, vertex.vert);
    for (int i = 0; i < 2; ++i) {
        if (vertex.neighborWeights[i] != 0) {
            point = point + spread(vertex.neighborWeights[i]) *
                                ACCESS::LoadExactly(task.src, vertex.neighbors[i]);
        }
    }
    Index const *const firstFace = task.step.parent->vertFirstFace.data() + vertex.vert;
    if (vertex.faceWeight != 0 && firstFace[0] < firstFace[1]) {
        Elements<float const> const fVertices = asConst(task.FVertices());
        Index const *const corners = task.step.vertCorners.data();
        auto sum = ACCESS::LoadExactly(fVertices, corners[firstFace[0]]);
        for (Index k = firstFace[0] + 1; k < firstFace[1]; ++k) {
            sum = sum + ACCESS::LoadExactly(fVertices, corners[k]);
        }
        point = point + spread(vertex.faceWeight) * sum;
    }
    ACCESS::StoreExactly(task.dst, vertex.child, point);
}

template <class ACCESS>
struct FaceKernel {
    static void Run(Task const &task, IndexRun const *begin, IndexRun const *end) {
        for (; begin < end; ++begin) {
            refinePlainFaces<ACCESS>(task, *begin);
        }
    }
    static void Run(Task const &task, WeightedFace const *begin, WeightedFace const *end) {
        for (; begin < end; ++begin) {
            refineWeightedFace<ACCESS>(task.step.faceWeights.data() + begin->firstWeight,
                                       begin->size, task.src, begin->verts, begin->size,
                                       task.FVertices(), begin->corner);
        }
    }
};
template <class ACCESS>
struct VertexKernel {
    static void Run(Task const &task, IndexRun const *begin, IndexRun const *end) {
        for (; begin < end; ++begin) {
            refinePlainVertices<ACCESS>(task, *begin);
        }
    }
    static void Run(Task const &task, WeightedVertex const *begin, WeightedVertex const *end) {
        for (; begin < end; ++begin) {
            refineWeightedVertex<ACCESS>(task, *begin);
        }
    }
};

// Elements of any length, up to eight floats at a time.
template <template <class> class KERNEL, class ITEM>
void runKernel(Task task, int length, ITEM const *begin, ITEM const *end) {
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
    for (; length > kPacketPair; length -= kPacketPair) {
        KERNEL<Access<kPacketPair, false>>::Run(task, begin, end);
        task.src.data += kPacketPair;
        task.dst.data += kPacketPair;
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
void runKernel(Task const &task, int length, Groups<ITEM> const &groups, int group) {
    runKernel<KERNEL>(task, length, groups.Begin(group), groups.End(group));
}

PlainFaceMask makePlainFaceMask(double const *weights, int size) {
    PlainFaceMask mask;
    bool const hasOpposite = size == kMaxUnrolledSize;
    bool isOrdinary = weights[1] == weights[size - 1];
    for (int j = 2; j <= size - 2; ++j) {
        isOrdinary &= weights[j] == weights[2] || (hasOpposite && j == size / 2);
    }
    if (!isOrdinary) {
        mask.weights.assign(weights, weights + size);
        mask.weights.insert(mask.weights.end(), weights, weights + size);
        return mask;
    }
    double const all = weights[size > kMinPlainSize ? 2 : 1];
    mask.self = float(weights[0] - all);
    mask.neighbor = float(weights[1] - all);
    mask.opposite = hasOpposite ? float(weights[size / 2] - all) : 0;
    mask.all = float(all);
    return mask;
}

constexpr int kNoGroup = -1;

// Sorts items into groups, in the order in which they stand: number i is in group groupOf[i].
template <class ITEM>
Groups<ITEM> makeGroups(std::vector<ITEM> const &items, std::vector<int> const &groupOf,
                        int numGroups) {
    Groups<ITEM> groups;
    groups.firsts.assign(std::size_t(numGroups) + 1, 0);
    for (int const group : groupOf) {
        ++groups.firsts[std::size_t(group) + 1];
    }
    std::partial_sum(groups.firsts.begin(), groups.firsts.end(), groups.firsts.begin());
    groups.items.Resize(items.size());
    std::vector<std::size_t> next = groups.firsts;
    for (std::size_t i = 0; i < items.size(); ++i) {
        groups.items[next[std::size_t(groupOf[i])]++] = items[i];
    }
    return groups;
}

// The same for items that stand for some of all indices, whose groups are given.
template <class ITEM>
Groups<ITEM> makeGroups(std::vector<ITEM> const &items, std::vector<Index> const &indices,
                        std::vector<int> const &groupOfIndex, int numGroups) {
    std::vector<int> groupOf;
    groupOf.reserve(indices.size());
    for (Index const index : indices) {
        groupOf.push_back(groupOfIndex[std::size_t(index)]);
    }
    return makeGroups(items, groupOf, numGroups);
}

// The runs of indices of a group, for all groups; without those of kNoGroup.
Groups<IndexRun> makeRuns(std::vector<int> const &groupOf, int numGroups) {
    std::vector<IndexRun> runs;
    std::vector<int> groupOfRun;
    for (std::size_t begin = 0; begin < groupOf.size();) {
        std::size_t end = begin + 1;
        while (end < groupOf.size() && groupOf[end] == groupOf[begin]) {
            ++end;
        }
        if (groupOf[begin] != kNoGroup) {
            runs.push_back({Index(begin), Index(end)});
            groupOfRun.push_back(groupOf[begin]);
        }
        begin = end;
    }
    return makeGroups(runs, groupOfRun, numGroups);
}

// The tile that all faces of a vertex are in; batches from numTiles on for vertices without one.
std::vector<int> makeVertexGroups(LevelTopology const &parent, std::vector<int> const &tileOfFace,
                                  int numTiles, int *numGroups) {
    std::vector<int> groupOfVertex(std::size_t(parent.numVertices));
    FarExt::internal::ParallelFor(parent.numVertices, [&](Index vert) {
        int &group = groupOfVertex[std::size_t(vert)];
        group = kNoGroup;
        Index const *const begin = parent.vertFaces.data() + parent.vertFirstFace[vert];
        Index const *const end = parent.vertFaces.data() + parent.vertFirstFace[vert + 1];
        if (begin != end) {
            int const first = tileOfFace[std::size_t(*begin)];
            if (std::all_of(begin, end,
                            [&](Index face) { return tileOfFace[std::size_t(face)] == first; })) {
                group = first;
            }
        }
    });
    int numOthers = 0;
    for (int &group : groupOfVertex) {
        if (group == kNoGroup) {
            group = numTiles + numOthers++ / kVertexBatch;
        }
    }
    *numGroups = numTiles + (numOthers + kVertexBatch - 1) / kVertexBatch;
    return groupOfVertex;
}

void sortUnique(std::vector<Index> &indices) {
    std::sort(indices.begin(), indices.end());
    indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
}

// The faces that need weights of their own, or exact access (see RefinementStep).
std::vector<Index> findWeightedFaces(RefinementMask const &mask, TopologyLevel const &parent) {
    std::vector<Index> faces = mask.FindFeatureFaces();
    if (parent.GetNumVertices() > 0) {
        for (Index const face : parent.GetVertexFaces(parent.GetNumVertices() - 1)) {
            if (parent.GetFaceVertices(face).size() <= kMaxUnrolledSize) {
                faces.push_back(face);
            }
        }
    }
    sortUnique(faces);
    return faces;
}

std::vector<Index> findWeightedVertices(RefinementMask const &mask, TopologyLevel const &parent) {
    LevelTopology const &topology = parent.GetTopology();
    if (!topology.vVertexParents.empty()) {
        // All, since those that are plain keep their index.
        return std::vector<Index>(topology.vVertexParents.begin(), topology.vVertexParents.end());
    }
    std::vector<Index> verts;
    if (topology.numVVertices > 0) {
        verts = mask.FindFeatureVertices();
        verts.push_back(topology.numVertices - 1);
        if (topology.numCorners > 0) {
            verts.push_back(topology.faceVerts[topology.numCorners - 1]);
        }
        sortUnique(verts);
    }
    return verts;
}

// Groups all faces of the level, and makes the weights of those that need their own.
void makeFaces(RefinementMask const &mask, TopologyLevel const &parent, std::vector<int> tileOfFace,
               int numTiles, RefinementStep &step) {
    std::vector<Index> const indices = findWeightedFaces(mask, parent);
    std::vector<WeightedFace> weighted;
    std::vector<double> scratch;
    for (Index const face : indices) {
        Far::ConstIndexArray const verts = parent.GetFaceVertices(face);
        int const size = verts.size();
        weighted.push_back(
            {parent.GetFaceFirstCorner(face), size, verts.begin(), step.faceWeights.size()});
        for (int corner = 0; corner < size; ++corner) {
            double const *const weights = mask.GetFaceVertexWeights(face, corner, scratch);
            step.faceWeights.insert(step.faceWeights.end(), weights, weights + size);
        }
    }
    step.weightedFaces = makeGroups(weighted, indices, tileOfFace, numTiles);
    for (Index const face : indices) {
        tileOfFace[std::size_t(face)] = kNoGroup;
    }
    step.plainFaces = makeRuns(tileOfFace, numTiles);
}

// The same for the vertices.
void makeVertices(RefinementMask const &mask, TopologyLevel const &parent,
                  std::vector<int> groupOfVertex, int numGroups, RefinementStep &step) {
    LevelTopology const &topology = parent.GetTopology();
    if (step.masks.averagesFaces) {
        step.vertCorners.Resize(topology.vertFaces.size());
        FarExt::internal::ParallelFor(topology.numCorners, [&](Index k) {
            step.vertCorners[std::size_t(k)] = topology.GetVertexCorner(k);
        });
    }
    std::vector<Index> const indices = findWeightedVertices(mask, parent);
    std::vector<WeightedVertex> weighted;
    for (Index const vert : indices) {
        RefinementMask::VertexMask const weights = mask.GetVertexMask(vert);
        WeightedVertex vertex = {vert,
                                 topology.GetVertexChildVertex(vert),
                                 float(weights.vertexWeight),
                                 float(weights.faceWeight),
                                 {vert, vert},
                                 {0, 0}};
        for (int i = 0; i < weights.numNeighbors; ++i) {
            vertex.neighbors[i] = weights.neighbors[i];
            vertex.neighborWeights[i] = float(weights.neighborWeights[i]);
        }
        weighted.push_back(vertex);
    }
    step.weightedVertices = makeGroups(weighted, indices, groupOfVertex, numGroups);
    for (Index const vert : indices) {
        groupOfVertex[std::size_t(vert)] = kNoGroup;
    }
    if (topology.numVVertices < topology.numVertices) {
        std::fill(groupOfVertex.begin(), groupOfVertex.end(), kNoGroup);
    }
    step.plainVertices = makeRuns(groupOfVertex, numGroups);
}

PlainMasks makePlainMasks(RefinementMask const &mask, TopologyLevel const &parent) {
    PlainMasks masks;
    int maxValence = 0;
    for (Index vert = 0; vert < parent.GetNumVertices(); ++vert) {
        maxValence = std::max(maxValence, parent.GetVertexFaces(vert).size());
    }
    for (int numFaces = 0; numFaces <= maxValence; ++numFaces) {
        FarExt::VertexVertexMask const vertexMask = mask.GetPlainVertexMask(numFaces);
        masks.verticesInverse.push_back(float(vertexMask.vertexWeight));
    }
    masks.averagesFaces = mask.GetPlainVertexMask(1).faceWeight != 0;
    for (Index const size : parent.GetTopology().faceSizes) {
        masks.faces.resize(std::size_t(size) + 1);
        masks.faces[std::size_t(size)] = makePlainFaceMask(mask.GetPlainFaceWeights(size), size);
    }
    return masks;
}

} // namespace

TileMap::TileMap(TopologyLevel const &base) : _faceOrder(std::size_t(base.GetNumFaces())) {
    std::iota(_faceOrder.begin(), _faceOrder.end(), 0);
    makeTiles(base);
}

// Cuts the order of the faces into pieces of as many corners each, if there are enough faces.
void TileMap::makeTiles(TopologyLevel const &level) {
    if (level.GetNumFaces() < kMinMapFaces) {
        return;
    }
    _tileOfFace.resize(_faceOrder.size());
    std::int64_t numCorners = 0;
    for (Index const face : _faceOrder) {
        _tileOfFace[std::size_t(face)] =
            std::uint16_t(numCorners * kNumMapTiles / level.GetNumFaceVertices());
        numCorners += level.GetFaceVertices(face).size();
    }
    _faceOrder = {};
}

void TileMap::Refine(TopologyLevel const &parent) {
    LevelTopology const &topology = parent.GetTopology();
    TopologyLevel const child(topology.child);
    Index const firstVFace = child.GetNumFaces() - child.GetTopology().numVFaces;
    if (!_tileOfFace.empty()) {
        // Each face is where its parent is.
        std::vector<std::uint16_t> tiles(std::size_t(child.GetNumFaces()));
        std::copy(_tileOfFace.begin(), _tileOfFace.end(), tiles.begin());
        FarExt::internal::ParallelFor(topology.numEdges, [&](Index edge) {
            if (Index const cFace = topology.GetEdgeChildFace(edge); cFace != Far::INDEX_INVALID) {
                Index const pFace = topology.edgeFaces[2 * std::size_t(edge)];
                tiles[std::size_t(cFace)] = _tileOfFace[std::size_t(pFace)];
            }
        });
        for (Index cFace = firstVFace; cFace < child.GetNumFaces(); ++cFace) {
            tiles[std::size_t(cFace)] = _tileOfFace[std::size_t(child.GetFaceParentFace(cFace))];
        }
        _tileOfFace.swap(tiles);
        return;
    }
    // In the order, each face is replaced by its children.
    std::vector<std::vector<Index>> vFacesOf(std::size_t(topology.numFaces));
    for (Index cFace = firstVFace; cFace < child.GetNumFaces(); ++cFace) {
        vFacesOf[std::size_t(child.GetFaceParentFace(cFace))].push_back(cFace);
    }
    std::vector<Index> order;
    order.reserve(std::size_t(child.GetNumFaces()));
    for (Index const face : _faceOrder) {
        order.push_back(topology.faceChildFaces[std::size_t(face)]);
        for (Index const edge : parent.GetFaceEdges(face)) {
            Index const cFace = topology.GetEdgeChildFace(edge);
            if (cFace != Far::INDEX_INVALID && topology.edgeFaces[2 * std::size_t(edge)] == face) {
                order.push_back(cFace);
            }
        }
        std::vector<Index> const &vFaces = vFacesOf[std::size_t(face)];
        order.insert(order.end(), vFaces.begin(), vFaces.end());
    }
    _faceOrder.swap(order);
    makeTiles(child);
}

std::vector<int> TileMap::GetTiles(int numTiles) const {
    if (_tileOfFace.empty()) {
        std::vector<int> result(_faceOrder.size());
        for (std::size_t i = 0; i < _faceOrder.size(); ++i) {
            result[std::size_t(_faceOrder[i])] = int(i * std::size_t(numTiles) / _faceOrder.size());
        }
        return result;
    }
    std::vector<int> result(_tileOfFace.size());
    FarExt::internal::ParallelFor(Index(result.size()), [&](Index face) {
        result[std::size_t(face)] = _tileOfFace[std::size_t(face)] * numTiles / int(kNumMapTiles);
    });
    return result;
}

void MakeRefinementStep(RefinementMask const &mask, TopologyLevel const &parent,
                        TileMap const &tileMap, RefinementStep &step) {
    LevelTopology const &topology = parent.GetTopology();
    step.numVVertices = topology.numVVertices;
    step.masks = makePlainMasks(mask, parent);
    step.parent = &topology;
    Index const numTileCorners =
        std::clamp(topology.numCorners / kTilesPerLevel, kMinTileCorners, kMaxTileCorners);
    int const numTiles = std::min(topology.numCorners / numTileCorners + 1, kNumMapTiles);
    std::vector<int> tileOfFace = tileMap.GetTiles(numTiles);
    int numVertexGroups;
    std::vector<int> groupOfVertex =
        makeVertexGroups(topology, tileOfFace, numTiles, &numVertexGroups);
    makeFaces(mask, parent, std::move(tileOfFace), numTiles, step);
    makeVertices(mask, parent, std::move(groupOfVertex), numVertexGroups, step);
}

void RefineElements(RefinementStep const &step, int length, Elements<float const> src,
                    Elements<float> dst) {
    Task const task = {step, src, dst};
    int const numTiles = step.plainFaces.GetNumGroups();
    int const numVertexGroups = step.plainVertices.GetNumGroups();
#ifdef _OPENMP
#pragma omp parallel if (numTiles > 2)
#endif
    {
#ifdef _OPENMP
#pragma omp for schedule(dynamic)
#endif
        for (int tile = 0; tile < numTiles; ++tile) {
            runKernel<FaceKernel>(task, length, step.plainFaces, tile);
            runKernel<FaceKernel>(task, length, step.weightedFaces, tile);
            runKernel<VertexKernel>(task, length, step.plainVertices, tile);
            runKernel<VertexKernel>(task, length, step.weightedVertices, tile);
        }
#ifdef _OPENMP
#pragma omp for schedule(dynamic)
#endif
        for (int group = numTiles; group < numVertexGroups; ++group) {
            runKernel<VertexKernel>(task, length, step.plainVertices, group);
            runKernel<VertexKernel>(task, length, step.weightedVertices, group);
        }
    }
}

} // namespace OpenSubdivHex::OsdExt::internal

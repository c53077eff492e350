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
/// Indices before the vertices of a face or the corners of a vertex in a record.
constexpr int kRecordHead = 2;

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
void refinePlainFaces(Task const &task, Index const *begin, Index const *end) {
    Elements<float> const dst = task.FVertices();
    while (begin < end) {
        Index const corner = begin[0];
        int const size = begin[1];
        Index const *const verts = begin + kRecordHead;
        begin = verts + size;
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
    }
}

template <class ACCESS>
void refinePlainVertices(Task const &task, Index const *begin, Index const *end) {
    Elements<float const> const fVertices = asConst(task.FVertices());
    float const *const inverses = task.step.masks.verticesInverse.data();
    while (begin < end) {
        Index const vert = begin[0];
        int const numFaces = begin[1];
        Index const *const corners = begin + kRecordHead;
        begin = corners + numFaces;
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
    if (vertex.faceWeight != 0 && vertex.numFaces > 0) {
        Elements<float const> const fVertices = asConst(task.FVertices());
        Index const *const corners = task.step.weightedCorners.data() + vertex.firstCorner;
        auto sum = ACCESS::LoadExactly(fVertices, corners[0]);
        for (int i = 1; i < vertex.numFaces; ++i) {
            sum = sum + ACCESS::LoadExactly(fVertices, corners[i]);
        }
        point = point + spread(vertex.faceWeight) * sum;
    }
    ACCESS::StoreExactly(task.dst, vertex.child, point);
}

template <class ACCESS>
struct FaceKernel {
    static void Run(Task const &task, Index const *begin, Index const *end) {
        refinePlainFaces<ACCESS>(task, begin, end);
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
    static void Run(Task const &task, Index const *begin, Index const *end) {
        refinePlainVertices<ACCESS>(task, begin, end);
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

// Sorts records into groups, in the order in which they stand.  Number i has sizeAt(i) items, which
// writeAt(i, items) makes; those of group kNoGroup are left out.
template <class ITEM, class SIZE_AT, class WRITE_AT>
Groups<ITEM> makeGroups(std::vector<int> const &groupOf, int numGroups, SIZE_AT sizeAt,
                        WRITE_AT writeAt) {
    Groups<ITEM> groups;
    groups.firsts.assign(std::size_t(numGroups) + 1, 0);
    for (std::size_t i = 0; i < groupOf.size(); ++i) {
        if (groupOf[i] != kNoGroup) {
            groups.firsts[std::size_t(groupOf[i]) + 1] += std::size_t(sizeAt(Index(i)));
        }
    }
    std::partial_sum(groups.firsts.begin(), groups.firsts.end(), groups.firsts.begin());
    groups.items.Resize(groups.firsts.back());
    std::vector<std::size_t> next = groups.firsts;
    for (std::size_t i = 0; i < groupOf.size(); ++i) {
        if (groupOf[i] != kNoGroup) {
            std::size_t &first = next[std::size_t(groupOf[i])];
            writeAt(Index(i), groups.items.data() + first);
            first += std::size_t(sizeAt(Index(i)));
        }
    }
    return groups;
}

// Groups of one item for each of the indices.
template <class ITEM>
Groups<ITEM> makeItemGroups(std::vector<ITEM> const &items, std::vector<Index> const &indices,
                            std::vector<int> const &groupOfIndex, int numGroups) {
    std::vector<int> groupOf;
    groupOf.reserve(indices.size());
    for (Index const index : indices) {
        groupOf.push_back(groupOfIndex[std::size_t(index)]);
    }
    return makeGroups<ITEM>(
        groupOf, numGroups, [](Index) { return 1; },
        [&](Index i, ITEM *item) { *item = items[std::size_t(i)]; });
}

// The tile of each face, by cutting faceOrder into pieces.
std::vector<int> makeFaceTiles(LevelTopology const &parent, std::vector<Index> const &faceOrder,
                               int *numTiles) {
    Index const numTileCorners =
        std::clamp(parent.numCorners / kTilesPerLevel, kMinTileCorners, kMaxTileCorners);
    std::vector<int> tileOfFace(std::size_t(parent.numFaces));
    int tile = 0;
    Index numCorners = 0;
    for (Index const face : faceOrder) {
        if (numCorners >= numTileCorners) {
            ++tile;
            numCorners = 0;
        }
        tileOfFace[std::size_t(face)] = tile;
        numCorners += parent.faceFirstCorner[face + 1] - parent.faceFirstCorner[face];
    }
    *numTiles = tile + 1;
    return tileOfFace;
}

// The tile that all faces of a vertex are in; batches from numTiles on for vertices without one.
std::vector<int> makeVertexGroups(LevelTopology const &parent, std::vector<int> const &tileOfFace,
                                  int numTiles, int *numGroups) {
    std::vector<int> groupOfVertex(std::size_t(parent.numVertices), kNoGroup);
    FarExt::internal::ParallelFor(parent.numVertices, [&](Index vert) {
        Index const *const begin = parent.vertFaces.data() + parent.vertFirstFace[vert];
        Index const *const end = parent.vertFaces.data() + parent.vertFirstFace[vert + 1];
        if (begin != end) {
            int const first = tileOfFace[std::size_t(*begin)];
            if (std::all_of(begin, end,
                            [&](Index face) { return tileOfFace[std::size_t(face)] == first; })) {
                groupOfVertex[std::size_t(vert)] = first;
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
    step.weightedFaces = makeItemGroups(weighted, indices, tileOfFace, numTiles);
    for (Index const face : indices) {
        tileOfFace[std::size_t(face)] = kNoGroup;
    }
    step.plainFaces = makeGroups<Index>(
        tileOfFace, numTiles,
        [&](Index face) { return kRecordHead + parent.GetFaceVertices(face).size(); },
        [&](Index face, Index *record) {
            Far::ConstIndexArray const verts = parent.GetFaceVertices(face);
            record[0] = parent.GetFaceFirstCorner(face);
            record[1] = verts.size();
            std::copy(verts.begin(), verts.end(), record + kRecordHead);
        });
}

// The same for the vertices.
void makeVertices(RefinementMask const &mask, TopologyLevel const &parent,
                  std::vector<int> groupOfVertex, int numGroups, RefinementStep &step) {
    bool const haveFaces = mask.GetPlainVertexMask(1).faceWeight != 0; // else all vertices stay
    auto numFacesOf = [&](Index vert) {
        return haveFaces ? parent.GetVertexFaces(vert).size() : 0;
    };
    std::vector<Index> const indices = findWeightedVertices(mask, parent);
    std::vector<WeightedVertex> weighted;
    for (Index const vert : indices) {
        RefinementMask::VertexMask const weights = mask.GetVertexMask(vert);
        WeightedVertex vertex = {vert,
                                 parent.GetTopology().GetVertexChildVertex(vert),
                                 numFacesOf(vert),
                                 step.weightedCorners.size(),
                                 float(weights.vertexWeight),
                                 float(weights.faceWeight),
                                 {vert, vert},
                                 {0, 0}};
        for (int i = 0; i < weights.numNeighbors; ++i) {
            vertex.neighbors[i] = weights.neighbors[i];
            vertex.neighborWeights[i] = float(weights.neighborWeights[i]);
        }
        for (int i = 0; i < vertex.numFaces; ++i) {
            step.weightedCorners.push_back(parent.GetVertexCorner(vert, i));
        }
        weighted.push_back(vertex);
    }
    step.weightedVertices = makeItemGroups(weighted, indices, groupOfVertex, numGroups);
    for (Index const vert : indices) {
        groupOfVertex[std::size_t(vert)] = kNoGroup;
    }
    if (parent.GetTopology().numVVertices < parent.GetNumVertices()) {
        std::fill(groupOfVertex.begin(), groupOfVertex.end(), kNoGroup);
    }
    step.plainVertices = makeGroups<Index>(
        groupOfVertex, numGroups, [&](Index vert) { return kRecordHead + numFacesOf(vert); },
        [&](Index vert, Index *record) {
            record[0] = vert;
            record[1] = numFacesOf(vert);
            for (int i = 0; i < record[1]; ++i) {
                record[kRecordHead + i] = parent.GetVertexCorner(vert, i);
            }
        });
}

} // namespace

namespace {

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
    for (Index const size : parent.GetTopology().faceSizes) {
        masks.faces.resize(std::size_t(size) + 1);
        masks.faces[std::size_t(size)] = makePlainFaceMask(mask.GetPlainFaceWeights(size), size);
    }
    return masks;
}

} // namespace

void MakeRefinementStep(RefinementMask const &mask, TopologyLevel const &parent,
                        std::vector<Index> const &faceOrder, RefinementStep &step) {
    LevelTopology const &topology = parent.GetTopology();
    step.numVVertices = topology.numVVertices;
    step.masks = makePlainMasks(mask, parent);
    int numTiles;
    int numVertexGroups;
    std::vector<int> tileOfFace = makeFaceTiles(topology, faceOrder, &numTiles);
    std::vector<int> groupOfVertex =
        makeVertexGroups(topology, tileOfFace, numTiles, &numVertexGroups);
    makeFaces(mask, parent, std::move(tileOfFace), numTiles, step);
    makeVertices(mask, parent, std::move(groupOfVertex), numVertexGroups, step);
}

std::vector<Index> RefineFaceOrder(TopologyLevel const &parent,
                                   std::vector<Index> const &faceOrder) {
    LevelTopology const &topology = parent.GetTopology();
    std::vector<Index> result;
    TopologyLevel const child(topology.child);
    Index const numVFaces = child.GetTopology().numVFaces;
    Index const firstVFace = child.GetNumFaces() - numVFaces;
    // The V-faces by their parent faces.
    std::vector<int> parentOfVFace;
    parentOfVFace.reserve(std::size_t(numVFaces));
    for (Index i = 0; i < numVFaces; ++i) {
        parentOfVFace.push_back(child.GetFaceParentFace(firstVFace + i));
    }
    Groups<Index> const vFaces = makeGroups<Index>(
        parentOfVFace, topology.numFaces, [](Index) { return 1; },
        [firstVFace](Index i, Index *face) { *face = firstVFace + i; });

    result.reserve(std::size_t(child.GetNumFaces()));
    for (Index const face : faceOrder) {
        result.push_back(topology.faceChildFaces[std::size_t(face)]);
        result.insert(result.end(), vFaces.Begin(face), vFaces.End(face));
        for (Index const edge : parent.GetFaceEdges(face)) {
            Index const cFace = topology.GetEdgeChildFace(edge);
            if (cFace != Far::INDEX_INVALID && topology.edgeFaces[2 * std::size_t(edge)] == face) {
                result.push_back(cFace);
            }
        }
    }
    return result;
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

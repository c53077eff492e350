// SPDX-License-Identifier: Apache-2.0
#include "vertexRings.h"

#include "patchCorners.h"

#include <algorithm>
#include <utility>

namespace OpenSubdivHex::BfrExt::internal {

using FarExt::VertexVertexMask;
using FarExt::internal::LimitPatch;

namespace {

// Whether no masks are made by anything but sizes of faces and numbers of faces around vertices.
bool hasFeatures(LimitPatch const &patch) {
    auto const hasTags = [](auto const &tags) {
        return std::any_of(tags.begin(), tags.end(), [](float tag) { return tag != 0; });
    };
    return hasTags(patch.edgeSharpness) || hasTags(patch.diagonalSharpness) ||
           hasTags(patch.vertSharpness) || !patch.nonManifoldVerts.empty() ||
           !patch.lineCorners.empty() || !patch.sharpVerts.empty() || patch.HasCornerTags() ||
           !patch.irregularVerts.empty() || patch.numHexagonalSteps != 0 ||
           // A half face, which has masks of its own.
           std::find(patch.otherCorners.begin(), patch.otherCorners.end(),
                     FarExt::internal::kSharpBoundaryB) != patch.otherCorners.end();
}

} // namespace

// Writes the program of the rings of a patch.
class VertexRings::Builder {
public:
    // Its memory is kept for the next patch.
    struct Scratch {
        // A mask that the patch has, by what tells it from others of its kind.
        struct Found {
            int numFaces;
            int size;
            Number mask;
        };

        std::vector<Mask const *> masks;
        std::vector<Found> faces;
        std::vector<Found> vertices;
        std::vector<Found> neighbors;
        std::vector<int> key;
        std::vector<Number> program; // and what longer ones before had behind it
        std::vector<int> ring;
        std::vector<int> sizes;
        std::vector<Number> around; // the points around a neighbour, and one whose numbers are 0
    };

    Builder(VertexRings &rings, PatchCorners const &corners, RingMasks &masks, Scratch &scratch)
        : _rings(rings), _corners(corners), _masks(masks), _scratch(scratch) {
        _scratch.masks.clear();
        _scratch.faces.clear();
        _scratch.vertices.clear();
        _scratch.neighbors.clear();
        std::vector<Number> &around = _scratch.around;
        around.resize(std::max(around.size(), corners.GetPatch().faceVerts.size() + 1));
    }

    bool Add(int firstCorner) {
        std::vector<int> &corners = _scratch.ring;
        if (_programSize > kLastNumber || !_corners.FindRing(firstCorner, corners)) {
            return false;
        }
        int const numFaces = int(corners.size());
        _rings._firsts.push_back(std::uint32_t(_programSize));
        Number *const header = extendProgram(kRingHeaderSize);
        header[kVertex] = Number(_corners.GetVertex(firstCorner));
        header[kVertexMask] = findMask(RingMasks::Of::FirstVertex, _scratch.vertices, numFaces, 0);
        _latticeSize = _corners.GetFaceSize(firstCorner);
        _isInLattice = isRegular(numFaces, _latticeSize);
        std::vector<int> &sizes = _scratch.sizes;
        sizes.clear();
        // The neighbour where a face begins is the last corner of the face before.
        int before = corners.back();
        for (int const corner : corners) {
            int const size = _corners.GetFaceSize(corner);
            Number neighbor;
            if (!findNeighbor(_corners.GetBefore(before), neighbor)) {
                return false;
            }
            _isInLattice = _isInLattice && size == _latticeSize;
            sizes.push_back(size);
            Mask const &ofNeighbor = *_scratch.masks[neighbor];
            Number *to = extendProgram(kFaceHeaderSize + std::size_t(size - 1) +
                                       ofNeighbor.numSteps.size() + ofNeighbor.places.size());
            to[kFaceSize] = Number(size);
            to[kFaceMask] = findMask(RingMasks::Of::FirstFace, _scratch.faces, 1, size);
            to[kNeighborMask] = neighbor;
            to[kNumRuns] = Number(ofNeighbor.numSteps.size());
            to += kFaceHeaderSize;
            for (int i = 1; i < size; ++i) {
                *to++ = Number(_corners.GetVertex(_corners.GetNext(corner, i)));
            }
            Number const *place = ofNeighbor.places.data();
            for (Number const numSteps : ofNeighbor.numSteps) {
                *to++ = numSteps;
                for (std::size_t i = 0; i < numSteps * kRunStep; ++i) {
                    *to++ = _scratch.around[*place++];
                }
            }
            before = corner;
        }
        Ring ring = {RingFaceSizes(sizes), {_rings._numPoints, 0}, _isInLattice};
        _rings._numPoints += ring.GetNumPoints(RingStep::First);
        _rings._rings.push_back(std::move(ring));
        return true;
    }

    void Finish() {
        _rings._masks = _scratch.masks;
        auto const program = _scratch.program.begin();
        _rings._program.assign(program, program + std::ptrdiff_t(_programSize));
    }

private:
    using Found = Scratch::Found;

    Number *extendProgram(std::size_t count) {
        std::size_t const first = _programSize;
        _programSize += count;
        if (_scratch.program.size() < _programSize) {
            _scratch.program.resize(2 * _programSize);
        }
        return &_scratch.program[first];
    }

    // Whether so many faces meet at a vertex as in the lattice that may be there.
    bool isRegular(int numFaces, int size) const {
        return size == _latticeSize && numFaces == CellType::GetLatticeValence(_latticeSize);
    }

    // Finds a mask for so many faces, which have a size where it matters: mostly one that the patch has already, which
    // takes less time than to find it in the table of all.
    Number findMask(RingMasks::Of of, std::vector<Found> &ofKind, int numFaces, int size) {
        for (Found const &found : ofKind) {
            if (found.numFaces == numFaces && found.size == size) {
                return found.mask;
            }
        }
        _scratch.key.assign(std::size_t(numFaces), size);
        ofKind.push_back({numFaces, size, addMask(of)});
        return ofKind.back().mask;
    }
    // Adds the mask of faces with the sizes of the key.
    Number addMask(RingMasks::Of of) {
        std::vector<int> const &sizes = _scratch.key;
        _scratch.masks.push_back(&_masks.Find<Mask>(of, sizes, [&]() -> Mask {
            switch (of) {
            case RingMasks::Of::FirstFace:
                return {RingMasks::Weights(makeFace(sizes[0])), {}, {}};
            case RingMasks::Of::FirstNeighbor:
                return makeNeighbor(sizes);
            default: {
                VertexVertexMask const mask = getVertexMask(int(sizes.size()));
                return {RingMasks::Weights({mask.vertexWeight, mask.faceWeight}), {}, {}};
            }
            }
        }));
        return Number(_scratch.masks.size() - 1);
    }
    VertexVertexMask getVertexMask(int numFaces) const {
        return FarExt::ComputeVertexVertexMask(_masks.GetRules().interpolation, numFaces);
    }
    std::vector<double> makeFace(int size) const {
        CellRules const &rules = _masks.GetRules();
        std::vector<double> weights(std::size_t(size), 0.0);
        FarExt::ComputeFaceVertexMask(rules.hexSchemeOptions.faceMask, rules.interpolation, size,
                                      weights.data());
        return weights;
    }

    // Finds the mask of a neighbour from a corner on, and the points around it, those at the vertex of the ring first;
    // false where there is a boundary.
    bool findNeighbor(int firstCorner, Number &mask) {
        int const size = _corners.GetFaceSize(firstCorner);
        bool areSame = true;
        int numFaces = 0;
        Number *end = _scratch.around.data();
        int corner = firstCorner;
        do {
            int const ofFace = _corners.GetFaceSize(corner);
            areSame = areSame && ofFace == size;
            for (int i = 1; i + 1 < ofFace; ++i) {
                *end++ = Number(_corners.GetVertex(_corners.GetNext(corner, i)));
            }
            corner = _corners.GetNextAround(corner);
            ++numFaces;
        } while (corner >= 0 && corner != firstCorner);
        if (corner < 0) {
            return false;
        }
        *end = Number(_corners.GetPatch().sources.size());
        _isInLattice = _isInLattice && areSame && isRegular(numFaces, size);
        if (areSame) {
            mask = findMask(RingMasks::Of::FirstNeighbor, _scratch.neighbors, numFaces, size);
            return true;
        }
        _scratch.key.clear();
        for (int i = 0; i < numFaces; ++i, corner = _corners.GetNextAround(corner)) {
            _scratch.key.push_back(_corners.GetFaceSize(corner));
        }
        mask = addMask(RingMasks::Of::FirstNeighbor);
        return true;
    }

    // Sums up what the faces around a neighbour give to each of their points; runs are in the order of their first points.
    Mask makeNeighbor(std::vector<int> const &sizes) const {
        struct Point {
            Number place;
            double weight;
        };
        VertexVertexMask const mask = getVertexMask(int(sizes.size()));
        double ownWeight = mask.vertexWeight;
        std::vector<Point> points;
        double lastBefore = makeFace(sizes.back()).back();
        for (int const size : sizes) {
            std::vector<double> const ofFace = makeFace(size);
            ownWeight += mask.faceWeight * ofFace[0];
            double weight = mask.faceWeight * ofFace[1] + mask.faceWeight * lastBefore;
            for (std::size_t i = 1; i + 1 < ofFace.size(); ++i) {
                points.push_back({Number(points.size()), weight});
                weight = mask.faceWeight * ofFace[i + 1];
            }
            lastBefore = ofFace.back();
        }
        auto const zero = Number(points.size());
        std::vector<double> weights = {ownWeight};
        std::vector<Number> numSteps;
        std::vector<Number> places;
        while (!points.empty()) {
            double const weight = points[0].weight;
            auto const rest =
                std::stable_partition(points.begin(), points.end(),
                                      [&](Point const &point) { return point.weight == weight; });
            auto const numPoints = std::size_t(rest - points.begin());
            std::size_t const ofRun = (numPoints + kRunStep - 1) / kRunStep;
            std::for_each(points.begin(), rest,
                          [&](Point const &point) { places.push_back(point.place); });
            places.resize(places.size() + ofRun * kRunStep - numPoints, zero);
            weights.push_back(weight);
            numSteps.push_back(Number(ofRun));
            points.erase(points.begin(), rest);
        }
        return {RingMasks::Weights(std::move(weights)), std::move(numSteps), std::move(places)};
    }

    VertexRings &_rings;
    PatchCorners const &_corners;
    RingMasks &_masks;
    Scratch &_scratch;
    std::size_t _programSize = 0;
    // The ring that is added: the size of its first face, and whether it is in a lattice so far.
    int _latticeSize = 0;
    bool _isInLattice = false;
};

bool VertexRings::Init(PatchCorners const &ofPatch, std::vector<int> const &corners,
                       RingMasks &masks) {
    if (hasFeatures(ofPatch.GetPatch()) || ofPatch.GetPatch().sources.size() > kLastNumber) {
        return false;
    }
    static thread_local Builder::Scratch scratch;
    Builder builder(*this, ofPatch, masks, scratch);
    _rings.reserve(corners.size());
    _firsts.reserve(corners.size());
    for (int const corner : corners) {
        if (!builder.Add(corner)) {
            return false;
        }
    }
    builder.Finish();
    if (masks.HaveSecondStep()) {
        for (Ring &ring : _rings) {
            ring.firstPoints[std::size_t(RingStep::Second)] = _numPoints;
            _numPoints += ring.GetNumPoints(RingStep::Second);
        }
        return _inner.Init(ofPatch, corners, masks);
    }
    return true;
}

// Writes the block of a face but for the vertex of the ring, and returns where the points of the next one begin.
template <std::size_t PADDED_SIZE, typename REAL>
VertexRings::Number const *VertexRings::applyFace(Number const *program, Lanes<REAL> const &center,
                                                  REAL const *points, std::size_t paddedSize,
                                                  REAL *result) const {
    std::size_t const stride = PADDED_SIZE == 0 ? paddedSize : PADDED_SIZE;
    std::size_t const faceSize = program[kFaceSize];
    REAL const *const mask = _masks[program[kFaceMask]]->weights.Get(REAL());
    Number const *const verts = program + kFaceHeaderSize; // behind that which has the ring
    auto const load = [&](std::size_t point) { return Lanes<REAL>::Load(points + point * stride); };
    auto const store = [&](Lanes<REAL> const &sum, std::size_t place) {
        sum.Store(result + place * stride);
    };
    REAL const *weight = _masks[program[kNeighborMask]]->weights.Get(REAL());
    Lanes<REAL> sum = load(verts[0]) * *weight;
    Number const *run = verts + (faceSize - 1);
    for (std::size_t i = program[kNumRuns]; i > 0; --i) {
        std::size_t numSteps = *run++;
        static_assert(kRunStep == 4);
        auto const loadStep = [&] {
            return (load(run[0]) + load(run[1])) + (load(run[2]) + load(run[3]));
        };
        Lanes<REAL> ofPoints = loadStep();
        for (run += kRunStep; --numSteps > 0; run += kRunStep) {
            ofPoints = ofPoints + loadStep();
        }
        sum = sum + ofPoints * *++weight;
    }
    store(sum, 1);
    auto const getVertex = [&](std::size_t place) {
        std::size_t const corner = place < faceSize ? place : place - faceSize;
        return corner == 0 ? center : load(verts[corner - 1]);
    };
    // Masks are symmetrical.
    for (std::size_t corner = 0; corner < faceSize; ++corner) {
        Lanes<REAL> ofCorner = getVertex(corner) * mask[0];
        std::size_t i = 1;
        for (; 2 * i < faceSize; ++i) {
            ofCorner =
                ofCorner + (getVertex(corner + i) + getVertex(corner + faceSize - i)) * mask[i];
        }
        if (2 * i == faceSize) {
            ofCorner = ofCorner + getVertex(corner + i) * mask[i];
        }
        store(ofCorner, kNumOthers + corner);
    }
    return run;
}

template <std::size_t PADDED_SIZE, typename REAL>
void VertexRings::apply(std::size_t number, int turn, REAL const *points, std::size_t paddedSize,
                        REAL *first, REAL *second) const {
    std::size_t const stride = PADDED_SIZE == 0 ? paddedSize : PADDED_SIZE;
    Ring const &ring = _rings[number];
    Number const *const program = &_program[_firsts[number]];
    REAL const *const weights = _masks[program[kVertexMask]]->weights.Get(REAL());
    int const numFaces = ring.GetNumFaces();
    int const firstFace = ring.GetFirstFace(turn);
    REAL *const begin = first + ring.GetBlock(turn, 0, RingStep::First) * stride;
    for (std::size_t lane = 0; lane < stride; lane += Lanes<REAL>::kCount) {
        auto const center = Lanes<REAL>::Load(points + program[kVertex] * stride + lane);
        Number const *face = program + kRingHeaderSize;
        REAL *block = begin;
        for (int i = 0; i < numFaces; ++i) {
            std::size_t const size = kNumOthers + std::size_t(face[kFaceSize]);
            block = i == firstFace ? first : block;
            face = applyFace<PADDED_SIZE>(face, center, points + lane, paddedSize, block + lane);
            block += size * stride;
        }
        // Calls function(block) for all blocks in the vertex's order.
        auto const forEachBlock = [&](auto const &function) {
            REAL *ofFace = first + lane;
            for (int i = 0, ofRing = firstFace; i < numFaces; ++i) {
                function(ofFace);
                ofFace += ring.GetBlockSize(ofRing, RingStep::First) * stride;
                ofRing = ofRing + 1 < numFaces ? ofRing + 1 : 0;
            }
        };
        auto sum = Lanes<REAL>::Load(first + lane + kNumOthers * stride);
        forEachBlock([&](REAL const *ofFace) {
            if (ofFace != first + lane) {
                sum = sum + Lanes<REAL>::Load(ofFace + kNumOthers * stride);
            }
        });
        sum = center * weights[0] + sum * weights[1];
        forEachBlock([&](REAL *ofFace) { sum.Store(ofFace); });
    }
    if (_inner.IsUsed()) {
        _inner.Apply<PADDED_SIZE>(ring, number, turn, paddedSize, first, second);
    }
}

template <typename REAL>
void VertexRings::Apply(std::size_t ring, int turn, REAL const *points, std::size_t paddedSize,
                        REAL *first, REAL *second) const {
    if (paddedSize == StepMatrix::kPadding) {
        apply<StepMatrix::kPadding>(ring, turn, points, paddedSize, first, second);
    } else {
        apply<0>(ring, turn, points, paddedSize, first, second);
    }
}

template void VertexRings::Apply(std::size_t, int, float const *, std::size_t, float *,
                                 float *) const;
template void VertexRings::Apply(std::size_t, int, double const *, std::size_t, double *,
                                 double *) const;

} // namespace OpenSubdivHex::BfrExt::internal

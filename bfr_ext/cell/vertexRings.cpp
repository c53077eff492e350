// SPDX-License-Identifier: Apache-2.0
#include "vertexRings.h"

#include "patchCorners.h"

#include <algorithm>
#include <cstring>
#include <limits>

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
        struct Point {
            Number point;
            double weight;
        };

        std::vector<Number> program;
        std::vector<double> weights;
        std::vector<std::pair<int, int>> masks; // by size, the first of its weights
        std::vector<int> ring;
        std::vector<int> faceSizes;
        std::vector<int> neighborRing;
        std::vector<Point> points; // as many as the patch has corners at least
    };

    Builder(VertexRings &rings, PatchCorners const &corners, CellRules const &rules,
            Scratch &scratch)
        : _rings(rings), _corners(corners), _rules(rules), _scratch(scratch),
          _zero(int(corners.GetPatch().sources.size())) {
        _isInRange = std::size_t(_zero) <= kLastNumber;
        _scratch.program.clear();
        _scratch.weights.clear();
        _scratch.masks.clear();
        _scratch.points.resize(
            std::max(_scratch.points.size(), corners.GetPatch().faceVerts.size()));
    }

    bool Add(int firstCorner) {
        std::vector<int> &corners = _scratch.ring;
        if (_scratch.program.size() > kLastNumber || !_corners.FindRing(firstCorner, corners)) {
            return false;
        }
        _rings._firsts.push_back(std::uint32_t(_scratch.program.size()));
        std::vector<int> &sizes = _scratch.faceSizes;
        sizes.clear();
        _latticeSize = _corners.GetFaceSize(firstCorner);
        _isInLattice = isRegular(corners);
        VertexVertexMask const mask = getVertexMask(corners);
        add(_corners.GetVertex(firstCorner));
        add(int(corners.size()));
        add(findWeight(mask.vertexWeight));
        add(findWeight(mask.faceWeight));
        // The neighbour where a face begins is the last corner of the face before.
        int before = corners.back();
        for (int const corner : corners) {
            int const size = _corners.GetFaceSize(corner);
            sizes.push_back(size);
            add(size);
            add(findMask(size));
            for (int i = 1; i < size; ++i) {
                add(_corners.GetVertex(_corners.GetNext(corner, i)));
            }
            if (!addNeighbor(_corners.GetBefore(before))) {
                return false;
            }
            before = corner;
        }
        Ring ring = {RingFaceSizes(sizes), {_rings._numPoints, 0}, _isInLattice};
        _rings._numPoints += ring.GetNumPoints(RingStep::First);
        _rings._rings.push_back(std::move(ring));
        return _isInRange;
    }

    void Finish() {
        std::vector<double> const &weights = _scratch.weights;
        std::vector<float> const floats(weights.begin(), weights.end());
        std::vector<std::byte> &block = _rings._block;
        auto const getNumBytes = [](auto const &array) {
            constexpr std::size_t kUnit = sizeof(double);
            return (array.size() * sizeof(array[0]) + kUnit - 1) / kUnit * kUnit;
        };
        _rings._firstOfProgram = std::uint32_t(getNumBytes(floats));
        _rings._firstDouble = _rings._firstOfProgram + std::uint32_t(getNumBytes(_scratch.program));
        block.resize(_rings._firstDouble + getNumBytes(weights));
        auto const copy = [&](auto const &array, std::size_t first) {
            std::memcpy(&block[first], array.data(), array.size() * sizeof(array[0]));
        };
        copy(floats, 0);
        copy(_scratch.program, _rings._firstOfProgram);
        copy(weights, _rings._firstDouble);
    }

private:
    static constexpr std::size_t kLastNumber = std::numeric_limits<Number>::max();

    Number toNumber(int number) {
        _isInRange = _isInRange && std::size_t(number) <= kLastNumber;
        return Number(number);
    }
    void add(int number) { _scratch.program.push_back(toNumber(number)); }

    // Whether so many faces meet at a vertex as in a lattice, all of them of its size.
    bool isRegular(std::vector<int> const &corners) const {
        return int(corners.size()) == CellType::GetLatticeValence(_latticeSize) &&
               std::all_of(corners.begin(), corners.end(), [&](int corner) {
                   return _corners.GetFaceSize(corner) == _latticeSize;
               });
    }

    VertexVertexMask getVertexMask(std::vector<int> const &corners) const {
        return FarExt::ComputeVertexVertexMask(_rules.interpolation, int(corners.size()));
    }

    // The first of the weights of a face's mask.
    int findMask(int size) {
        for (auto const &[other, first] : _scratch.masks) {
            if (other == size) {
                return first;
            }
        }
        int const first = int(_scratch.weights.size());
        _scratch.weights.resize(_scratch.weights.size() + std::size_t(size));
        FarExt::ComputeFaceVertexMask(_rules.hexSchemeOptions.faceMask, _rules.interpolation, size,
                                      &_scratch.weights[std::size_t(first)]);
        _scratch.masks.emplace_back(size, first);
        return first;
    }
    int findWeight(double weight) {
        std::vector<double> &weights = _scratch.weights;
        auto const found = std::find(weights.begin(), weights.end(), weight);
        if (found == weights.end()) {
            weights.push_back(weight);
            return int(weights.size()) - 1;
        }
        return int(found - weights.begin());
    }

    // A V-vertex in terms of the patch: first its own weight, and then runs of points that have the same
    // weight, those at the vertex of the ring first.
    bool addNeighbor(int firstCorner) {
        std::vector<int> &corners = _scratch.neighborRing;
        if (!_corners.FindRing(firstCorner, corners)) {
            return false;
        }
        _isInLattice = _isInLattice && isRegular(corners);
        VertexVertexMask const mask = getVertexMask(corners);
        double ownWeight = mask.vertexWeight;
        Scratch::Point *const points = _scratch.points.data();
        Scratch::Point *end = points;
        int sizeBefore = _corners.GetFaceSize(corners.back());
        int maskBefore = findMask(sizeBefore);
        for (int const corner : corners) {
            int const size = _corners.GetFaceSize(corner);
            int const ofFace = size == sizeBefore ? maskBefore : findMask(size);
            double const *const weights = _scratch.weights.data();
            ownWeight += mask.faceWeight * weights[ofFace];
            double weight = mask.faceWeight * weights[ofFace + 1] +
                            mask.faceWeight * weights[maskBefore + sizeBefore - 1];
            for (int i = 1; i + 1 < size; ++i, ++end) {
                end->point = Number(_corners.GetVertex(_corners.GetNext(corner, i)));
                end->weight = weight;
                weight = mask.faceWeight * weights[ofFace + i + 1];
            }
            sizeBefore = size;
            maskBefore = ofFace;
        }
        add(findWeight(ownWeight));
        // Runs of the weight of the first point that is left.
        std::vector<Number> &program = _scratch.program;
        std::size_t const first = program.size();
        program.resize(first + 1 + std::size_t(end - points) * (kRunHeaderSize + kRunStep));
        Number &numRuns = program[first];
        Number *to = &numRuns + 1;
        for (; end != points; ++numRuns) {
            double const weight = points->weight;
            Number *const run = to;
            run[kRunWeight] = toNumber(findWeight(weight));
            to += kRunHeaderSize;
            Scratch::Point *rest = points;
            for (Scratch::Point const *point = points; point != end; ++point) {
                if (point->weight == weight) {
                    *to++ = point->point;
                } else {
                    *rest++ = *point;
                }
            }
            end = rest;
            while (std::size_t(to - run - kRunHeaderSize) % kRunStep != 0) {
                *to++ = Number(_zero);
            }
            run[kNumSteps] = Number(std::size_t(to - run - kRunHeaderSize) / kRunStep);
        }
        program.resize(std::size_t(to - program.data()));
        return true;
    }

    VertexRings &_rings;
    PatchCorners const &_corners;
    CellRules const &_rules;
    Scratch &_scratch;
    int const _zero; // the point behind those of the patch
    bool _isInRange = true;
    // The ring that is added: the size of its first face, and whether it is in a lattice so far.
    int _latticeSize = 0;
    bool _isInLattice = false;
};

bool VertexRings::Init(PatchCorners const &ofPatch, std::vector<int> const &corners,
                       InnerMasks &masks) {
    if (hasFeatures(ofPatch.GetPatch())) {
        return false;
    }
    static thread_local Builder::Scratch scratch;
    Builder builder(*this, ofPatch, masks.GetRules(), scratch);
    _firsts.reserve(corners.size());
    _rings.reserve(corners.size());
    for (int const corner : corners) {
        if (!builder.Add(corner)) {
            return false;
        }
    }
    builder.Finish();
    if (masks.AreUsed()) {
        for (Ring &ring : _rings) {
            ring.firstPoints[std::size_t(RingStep::Second)] = _numPoints;
            _numPoints += ring.GetNumPoints(RingStep::Second);
        }
        return _inner.Init(ofPatch, corners, masks);
    }
    return true;
}

// Writes the block of a face but for the vertex of the ring, and returns where the program goes on.
template <std::size_t PADDED_SIZE, typename REAL>
VertexRings::Number const *VertexRings::applyFace(Number const *program, REAL const *weights,
                                                  Lanes<REAL> const &center, REAL const *points,
                                                  std::size_t paddedSize, REAL *result) {
    std::size_t const stride = PADDED_SIZE == 0 ? paddedSize : PADDED_SIZE;
    std::size_t const faceSize = program[kFaceSize];
    REAL const *const mask = weights + program[kMask];
    Number const *const verts = program + kFaceHeaderSize; // behind that which has the ring
    Number const *const neighbor = verts + (faceSize - 1);
    auto const load = [&](std::size_t point) { return Lanes<REAL>::Load(points + point * stride); };
    auto const store = [&](Lanes<REAL> const &sum, std::size_t place) {
        sum.Store(result + place * stride);
    };
    Lanes<REAL> sum = load(verts[0]) * weights[neighbor[kOwnWeight]];
    Number const *run = neighbor + kNeighborHeaderSize;
    for (std::size_t i = neighbor[kNumRuns]; i > 0; --i) {
        REAL const weight = weights[run[kRunWeight]];
        std::size_t numSteps = run[kNumSteps];
        run += kRunHeaderSize;
        static_assert(kRunStep == 4);
        auto const loadStep = [&] {
            return (load(run[0]) + load(run[1])) + (load(run[2]) + load(run[3]));
        };
        Lanes<REAL> ofPoints = loadStep();
        for (run += kRunStep; --numSteps > 0; run += kRunStep) {
            ofPoints = ofPoints + loadStep();
        }
        sum = sum + ofPoints * weight;
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
    REAL const *const weights = getWeights(REAL());
    Number const *const program = getProgram() + _firsts[number];
    Ring const &ring = _rings[number];
    int const numFaces = ring.GetNumFaces();
    int const firstFace = ring.GetFirstFace(turn);
    REAL *const begin = first + ring.GetBlock(turn, 0, RingStep::First) * stride;
    for (std::size_t lane = 0; lane < stride; lane += Lanes<REAL>::kCount) {
        auto const center = Lanes<REAL>::Load(points + program[kVertex] * stride + lane);
        Number const *face = program + kRingHeaderSize;
        REAL *block = begin;
        for (int i = 0; i < numFaces; ++i) {
            block = i == firstFace ? first : block;
            std::size_t const size = kNumOthers + std::size_t(face[kFaceSize]);
            face = applyFace<PADDED_SIZE>(face, weights, center, points + lane, paddedSize,
                                          block + lane);
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
        sum = center * weights[program[kVertexWeight]] + sum * weights[program[kFaceWeight]];
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

// SPDX-License-Identifier: Apache-2.0
#include "latticeFaces.h"

#include "faceDescendants.h"

#include "far_ext/vtr/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>
#include <utility>

namespace OpenSubdivHex::FarExt::internal {

using Far::Index;

namespace {

using Point = LatticePatch::Point;

constexpr Index kRange = 64;        ///< of faces, which take some microseconds each
constexpr double kSamePoint = 1e-6; ///< in a plane where edges of level 0 are 1 long

bool areEqual(PatchWeights const &a, PatchWeights const &b) {
    for (std::size_t i = 0; i < a.size(); ++i) {
        for (std::size_t k = 0; k < a[i].size(); ++k) {
            if (!(std::abs(a[i][k] - b[i][k]) < kWeightTolerance)) {
                return false;
            }
        }
    }
    return true;
}

/// Numbers of points that are near to given ones.
class PointFinder {
public:
    explicit PointFinder(std::vector<Point> const &points) {
        for (std::size_t i = 0; i < points.size(); ++i) {
            _sorted.push_back({points[i], int(i)});
        }
        std::sort(_sorted.begin(), _sorted.end(), [](Numbered const &a, Numbered const &b) {
            return a.point.real() < b.point.real();
        });
    }

    /// -1 where there is none.
    int Find(Point point) const {
        auto next = std::lower_bound(
            _sorted.begin(), _sorted.end(), point.real() - kSamePoint,
            [](Numbered const &numbered, double x) { return numbered.point.real() < x; });
        for (; next != _sorted.end() && next->point.real() < point.real() + kSamePoint; ++next) {
            if (std::abs(next->point - point) < kSamePoint) {
                return next->number;
            }
        }
        return -1;
    }

private:
    struct Numbered {
        Point point;
        int number;
    };
    std::vector<Numbered> _sorted;
};

/// Where a derivative, or the point, of a row leads in the plane of the patch.
Point findPoint(LatticePatch const &patch, PatchWeights const &weights, std::size_t sum) {
    Point result = 0;
    for (std::size_t place = 0; place < weights.size(); ++place) {
        result += weights[place][sum] * patch.GetPoints()[place];
    }
    return result;
}

using Directions = std::array<Point, 2>;

/// Two directions in the plane in terms of two others.
void solve(Directions const &directions, Directions const &others, double (&result)[2][2]) {
    double const area = std::imag(std::conj(others[0]) * others[1]);
    for (std::size_t i = 0; i < directions.size(); ++i) {
        result[i][0] = std::imag(std::conj(directions[i]) * others[1]) / area;
        result[i][1] = std::imag(std::conj(others[0]) * directions[i]) / area;
    }
}

/// Whether what is along the axis is the same in the mirror, and what is across changes its sign.
bool isMirrorSymmetric(LatticePatch const &patch, PatchWeights const &weights) {
    PatchWeights mirrored(weights.size());
    for (std::size_t i = 0; i < weights.size(); ++i) {
        LimitWeights const &of = weights[i];
        mirrored[std::size_t(patch.MirrorPlace(int(i)))] = {of[0], of[1], -of[2]};
    }
    return areEqual(mirrored, weights);
}

/// Returns the weights of the vertex to which a vertex, or its mirror image, comes as the face turns.
PatchWeights turn(LatticePatch const &patch, PatchWeights const &weights, bool isMirrored,
                  int turns) {
    PatchWeights result(weights.size());
    for (int place = 0; place < patch.GetNumPlaces(); ++place) {
        int const to = patch.TurnPlace(isMirrored ? patch.MirrorPlace(place) : place, turns);
        result[std::size_t(to)] = weights[std::size_t(place)];
    }
    return result;
}

/// With other derivatives, factors[i] being the i-th in terms of those that there are.
PatchWeights combine(PatchWeights weights, double const (&factors)[2][2]) {
    for (LimitWeights &ofPlace : weights) {
        ofPlace = {ofPlace[0], factors[0][0] * ofPlace[1] + factors[0][1] * ofPlace[2],
                   factors[1][0] * ofPlace[1] + factors[1][1] * ofPlace[2]};
    }
    return weights;
}

Directions findDirections(LatticePatch const &patch, PatchWeights const &weights) {
    return {findPoint(patch, weights, 1), findPoint(patch, weights, 2)};
}

/// The orbit of a vertex on the axis, with derivatives along and across that are as long as du and dv.
LatticeFaces::Orbit makeAxis(LatticePatch const &patch, PatchWeights const &weights) {
    Directions const directions = findDirections(patch, weights);
    double const length = std::sqrt(std::abs(std::imag(std::conj(directions[0]) * directions[1])));
    Directions const axis = {length, Point(0, length)};
    double ofAxis[2][2];
    solve(axis, directions, ofAxis);
    LatticeFaces::Orbit orbit = {false, combine(weights, ofAxis), {}};
    solve(directions, axis, orbit.derivatives);
    return orbit;
}

/// \brief Finds the orbits of the vertices in a face by their points, and that the weights of all follow
/// from those of one of an orbit.
class OrbitFinder {
public:
    /// \param weights  the rows of the vertices, by number; they are referred to, as is the patch
    OrbitFinder(LatticePatch const &patch, std::vector<PatchWeights> const &weights)
        : _patch(patch), _weights(weights), _points(findPoints(patch, weights)), _finder(_points),
          _isFound(weights.size(), 0) {}

    /// Whether each vertex is of an orbit, and any orbit is on an axis.
    bool Find() {
        for (std::size_t i = 0; i < _weights.size(); ++i) {
            if (!_isFound[i] && !addOrbitOf(i)) {
                return false;
            }
        }
        return !_axes.orbits.empty();
    }

    /// Orbits of pairs come first.
    std::vector<LatticeFaces::Orbit> GetOrbits() const {
        return joined(_pairs.orbits, _axes.orbits);
    }
    /// By output of the orbits, the number of the vertex.
    std::vector<int> GetOrder() const { return joined(_pairs.numbers, _axes.numbers); }

private:
    /// Orbits of a kind, and the numbers of all their vertices in turn.
    struct Kind {
        std::vector<LatticeFaces::Orbit> orbits;
        std::vector<int> numbers;
    };

    static std::vector<Point> findPoints(LatticePatch const &patch,
                                         std::vector<PatchWeights> const &weights) {
        std::vector<Point> points;
        points.reserve(weights.size());
        for (PatchWeights const &ofVertex : weights) {
            points.push_back(findPoint(patch, ofVertex, 0));
        }
        return points;
    }
    template <typename T>
    static std::vector<T> joined(std::vector<T> first, std::vector<T> const &second) {
        first.insert(first.end(), second.begin(), second.end());
        return first;
    }

    bool addOrbitOf(std::size_t number) {
        int first = int(number);
        bool isPair = true;
        for (int turns = 0; turns < _patch.GetFaceSize(); ++turns) {
            Point const turned = _patch.Turn(_points[number], turns);
            if (std::abs(turned.imag()) < kSamePoint && (isPair || turned.real() > 0)) {
                first = _finder.Find(turned);
                isPair = false;
            }
        }
        if (first < 0) {
            return false;
        }
        return isPair ? addPair(std::size_t(first)) : addAxis(std::size_t(first));
    }

    bool addPair(std::size_t first) {
        Point const image = std::conj(_points[first]);
        int const mirrored = _finder.Find(image);
        if (mirrored < 0) {
            return false;
        }
        Directions const directions = findDirections(_patch, _weights[first]);
        Directions const ofImage = findDirections(_patch, _weights[std::size_t(mirrored)]);
        LatticeFaces::Orbit orbit = {true, _weights[first], {}};
        solve(ofImage, {std::conj(directions[0]), std::conj(directions[1])}, orbit.derivatives);
        constexpr double kSame[2][2] = {{1, 0}, {0, 1}};
        if (!addTurns(orbit.weights, _points[first], false, kSame, _pairs.numbers) ||
            !addTurns(orbit.weights, image, true, orbit.derivatives, _pairs.numbers)) {
            return false;
        }
        _pairs.orbits.push_back(std::move(orbit));
        return true;
    }

    bool addAxis(std::size_t first) {
        LatticeFaces::Orbit orbit = makeAxis(_patch, _weights[first]);
        if (!addTurns(orbit.weights, _points[first], false, orbit.derivatives, _axes.numbers) ||
            !isMirrorSymmetric(_patch, orbit.weights)) {
            return false;
        }
        _axes.orbits.push_back(std::move(orbit));
        return true;
    }

    /// Adds the vertices that one, or its mirror image, comes to as the face turns, if they have its
    /// weights.
    ///
    /// \param derivatives  theirs in terms of its own
    bool addTurns(PatchWeights const &first, Point point, bool isMirrored,
                  double const (&derivatives)[2][2], std::vector<int> &numbers) {
        for (int turns = 0; turns < _patch.GetFaceSize(); ++turns) {
            int const number = _finder.Find(_patch.Turn(point, turns));
            if (number < 0 ||
                !areEqual(combine(turn(_patch, first, isMirrored, turns), derivatives),
                          _weights[std::size_t(number)])) {
                return false;
            }
            _isFound[std::size_t(number)] = 1;
            numbers.push_back(number);
        }
        return true;
    }

    LatticePatch const &_patch;
    std::vector<PatchWeights> const &_weights;
    std::vector<Point> const _points;
    PointFinder const _finder;
    std::vector<unsigned char> _isFound;
    Kind _pairs;
    Kind _axes;
};

/// A mark for each output of a set, whether it is the mirror image of another.
std::vector<unsigned char> markMirrored(LatticeFaces::Set const &set) {
    std::vector<unsigned char> marks;
    marks.reserve(std::size_t(set.numOutputs));
    for (LatticeFaces::Orbit const &orbit : set.orbits) {
        std::size_t const numTurns = std::size_t(set.patch.GetFaceSize());
        marks.insert(marks.end(), numTurns, 0);
        marks.insert(marks.end(), orbit.isPair ? numTurns : 0, 1);
    }
    return marks;
}

} // namespace

/// The first face of a set, and what is found for it.
struct LatticeFaces::Sample {
    std::vector<int> numbers; ///< by output of ForEachDescendant(), among those that differ
    std::vector<Index> verts; ///< that differ
    std::vector<PatchWeights> weights;

    std::vector<int> order; ///< by output of a set, its number
};

LatticeFaces::LatticeFaces(MeshLevels const &mesh, int level) : _mesh(mesh), _level(level) {
    for (int i = 1; i <= level; ++i) {
        if (!mesh.levels[std::size_t(i)].isHexagonal) {
            return;
        }
    }
    if (level > 0) {
        findFaces(3);
        findFaces(4);
        findFaces(6);
    }
}

void LatticeFaces::findFaces(int faceSize) {
    Level const &level = _mesh.levels[0];
    LatticePatch const patch(faceSize);
    std::vector<VertexMark> const &marks = GetVertexMarks(level);
    auto const isOfLattice = [&](Index vert) {
        Far::ConstIndexArray const faces = level.GetVertexFaces(vert);
        return faces.size() == patch.GetValence() &&
               (marks.empty() || marks[std::size_t(vert)] != VertexMark::Feature) &&
               std::all_of(faces.begin(), faces.end(),
                           [&](Index face) { return level.GetFaceSize(face) == faceSize; });
    };
    std::vector<unsigned char> isVertexOfLattice(std::size_t(level.numVertices));
    ParallelFor(level.numVertices,
                [&](Index vert) { isVertexOfLattice[std::size_t(vert)] = isOfLattice(vert); });
    auto const gather = [&](Index face, Index *verts) {
        return level.GetFaceSize(face) == faceSize &&
               patch.Gather(
                   level, face,
                   [&](Index vert) { return isVertexOfLattice[std::size_t(vert)] != 0; }, verts);
    };
    std::vector<Index> faces = ParallelSelect(
        level.numFaces,
        [&](Index face) {
            Index verts[LatticePatch::kMaxPlaces];
            return gather(face, verts);
        },
        kRange);
    if (faces.empty()) {
        return;
    }
    Set &set = _sets.emplace_back(Set{patch, std::move(faces), {}, {}, 0, {}, {}, {}, {}});
    auto const numPlaces = std::size_t(patch.GetNumPlaces());
    set.sources.Resize(set.faces.size() * numPlaces);
    ParallelFor(Index(set.faces.size()), [&](Index i) {
        gather(set.faces[std::size_t(i)], set.sources.data() + std::size_t(i) * numPlaces);
    });
}

PatchWeights LatticeFaces::getRow(LatticePatch const &patch, Orbit const &orbit, bool isMirrored,
                                  int turns) {
    PatchWeights weights = turn(patch, orbit.weights, isMirrored, turns);
    bool const isAsGiven = orbit.isPair && !isMirrored;
    return isAsGiven ? weights : combine(std::move(weights), orbit.derivatives);
}

CallStatus LatticeFaces::FindMasks(HexSchemeOptions const &schemeOptions, LimitRows &rows) {
    if (_sets.empty()) {
        return CallStatus();
    }
    std::vector<Sample> samples(_sets.size());
    std::vector<Index> verts;
    for (std::size_t i = 0; i < _sets.size(); ++i) {
        std::unordered_map<Index, int> numbers;
        Sample &sample = samples[i];
        ForEachDescendant(_mesh, 0, _level, _sets[i].faces.front(), [&](Index vert) {
            auto const [found, isNew] = numbers.emplace(vert, int(sample.verts.size()));
            if (isNew) {
                sample.verts.push_back(vert);
            }
            sample.numbers.push_back(found->second);
        });
        verts.insert(verts.end(), sample.verts.begin(), sample.verts.end());
    }
    std::vector<Index> ofSets(_sets.size(), Far::INDEX_INVALID); // a vertex of level 0 for each
    for (Index vert = 0; vert < _mesh.levels[0].numVertices; ++vert) {
        if (Set const *const set = FindPlace(vert).set) {
            Index &ofSet = ofSets[std::size_t(set - _sets.data())];
            if (ofSet < 0) {
                ofSet = vert;
                verts.push_back(vert);
            }
        }
    }
    std::sort(verts.begin(), verts.end());
    verts.erase(std::unique(verts.begin(), verts.end()), verts.end());
    CallStatus status = rows.Find(verts);
    if (!status.IsOk()) {
        return status;
    }
    std::vector<Set> sets;
    for (std::size_t i = 0; i < _sets.size(); ++i) {
        Set &set = _sets[i];
        PatchRows patchRows(_mesh, schemeOptions, 0, _level, set.sources.data(),
                            set.patch.GetNumPlaces());
        Index sources[PlainNeighborhoodGatherer::kNumRegular];
        for (Index const vert : samples[i].verts) {
            samples[i].weights.push_back(patchRows.Find(rows.GetRow(vert, 0, sources)));
        }
        if (ofSets[i] >= 0) {
            setVertexMask(schemeOptions, rows, ofSets[i], set);
        }
        if (setOrbits(samples[i], set)) {
            setOutputs(samples[i], set);
            sets.push_back(std::move(set));
        }
    }
    _sets = std::move(sets);
    if (!_sets.empty()) {
        setVertices();
    }
    return status;
}

// The face that begins at a vertex with the first of its edges.
LatticeFaces::VertexPlace LatticeFaces::FindPlace(Index vert) const {
    Level const &level = _mesh.levels[0];
    Far::ConstIndexArray const edges = level.GetVertexEdges(vert);
    if (edges.empty()) {
        return {nullptr, 0, 0};
    }
    int const side = level.edgeVerts[edges[0]][0] == vert ? 0 : 1;
    Index const face = level.edgeFaces[edges[0]][side];
    for (Set const &set : _sets) {
        auto const found = std::lower_bound(set.faces.begin(), set.faces.end(), face);
        if (found != set.faces.end() && *found == face) {
            return {&set, std::size_t(found - set.faces.begin()),
                    level.GetSideCorner(edges[0], side) - level.faceFirstCorner[face]};
        }
    }
    return {nullptr, 0, 0};
}

void LatticeFaces::setVertexMask(HexSchemeOptions const &schemeOptions, LimitRows const &rows,
                                 Index vert, Set &set) const {
    Index sources[LatticePatch::kMaxPlaces];
    VertexPlace const place = FindPlace(vert);
    getSources(place, sources);
    Index regularSources[PlainNeighborhoodGatherer::kNumRegular];
    PatchWeights const weights =
        PatchRows(_mesh, schemeOptions, 0, _level, sources, set.patch.GetNumPlaces())
            .Find(rows.GetRow(vert, 0, regularSources));
    LimitMask::Tangents tangents;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        LimitWeights const &ofPlace = weights[i];
        if (ofPlace[0] != 0 || ofPlace[1] != 0 || ofPlace[2] != 0) {
            set.vertexPlaces.push_back(int(i));
            set.vertexMask.weights.push_back(ofPlace[0]);
            tangents.du.push_back(ofPlace[1]);
            tangents.dv.push_back(ofPlace[2]);
        }
    }
    set.vertexMask.sides.push_back(std::move(tangents));
    Orbit corners = makeAxis(set.patch, weights);
    if (isMirrorSymmetric(set.patch, corners.weights)) {
        set.corners = std::move(corners);
    }
}

// The sources of a face, turned so that a vertex is at its first corner.
void LatticeFaces::getSources(VertexPlace const &of, Index *sources) {
    LatticePatch const &patch = of.set->patch;
    Index const *const ofFace =
        of.set->sources.data() + of.face * std::size_t(patch.GetNumPlaces());
    for (int place = 0; place < patch.GetNumPlaces(); ++place) {
        sources[place] = ofFace[patch.TurnPlace(place, of.corner)];
    }
}

// Whether there are orbits, which make the rows of all outputs.
bool LatticeFaces::setOrbits(Sample &sample, Set &set) {
    bool const hasAllRows =
        std::none_of(sample.weights.begin(), sample.weights.end(),
                     [](PatchWeights const &weights) { return weights.empty(); });
    OrbitFinder finder(set.patch, sample.weights);
    if (!hasAllRows || !finder.Find()) {
        return false;
    }
    set.orbits = finder.GetOrbits();
    sample.order = finder.GetOrder();
    set.numOutputs = int(sample.order.size());
    return true;
}

void LatticeFaces::setOutputs(Sample const &sample, Set &set) {
    // By number, the places among the outputs.
    std::vector<std::vector<int>> places(sample.verts.size());
    for (std::size_t i = 0; i < sample.order.size(); ++i) {
        places[std::size_t(sample.order[i])].push_back(int(i));
    }
    auto const numOutputs = std::size_t(set.numOutputs);
    set.outputs.Resize(set.faces.size() * numOutputs);
    ParallelForRange(
        Index(set.faces.size()), [] { return Nothing(); },
        [&](Nothing, Index begin, Index end) {
            for (Index i = begin; i < end; ++i) {
                Index *const outputs = set.outputs.data() + std::size_t(i) * numOutputs;
                auto number = sample.numbers.begin();
                ForEachDescendant(_mesh, 0, _level, set.faces[std::size_t(i)], [&](Index vert) {
                    for (int const place : places[std::size_t(*number)]) {
                        outputs[place] = vert;
                    }
                    ++number;
                });
            }
        },
        kRange);
    _marks.resize(std::size_t(_mesh.levels[std::size_t(_level)].numVertices), 0);
    std::size_t const inside = numOutputs - std::size_t(set.patch.GetFaceSize());
    std::vector<unsigned char> const isMirrored = markMirrored(set);
    // In the order of the faces, whatever the threads.
    auto const claim = [&](bool ofMirrored) {
        for (std::size_t i = 0; i < set.faces.size(); ++i) {
            Index *const outputs = set.outputs.data() + i * numOutputs;
            for (std::size_t k = 0; k < numOutputs; ++k) {
                if ((isMirrored[k] != 0) == ofMirrored) {
                    unsigned char &mark = _marks[std::size_t(outputs[k])];
                    outputs[k] = mark && k < inside ? outputs[inside] : outputs[k];
                    mark = 1;
                }
            }
        }
    };
    claim(false);
    claim(true);
}

void LatticeFaces::setVertices() {
    for (Index vert = 0; vert < _mesh.levels[0].numVertices; ++vert) {
        Set const *const set = FindPlace(vert).set;
        if (set && !set->vertexPlaces.empty()) {
            _verts.push_back(vert);
            _marks[std::size_t(vert)] = 1;
        }
    }
}

LimitRow LatticeFaces::GetRow(Index vert, Index sources[LatticePatch::kMaxPlaces]) const {
    VertexPlace const place = FindPlace(vert);
    Index ofFace[LatticePatch::kMaxPlaces];
    getSources(place, ofFace);
    Set const &set = *place.set;
    for (std::size_t i = 0; i < set.vertexPlaces.size(); ++i) {
        sources[i] = ofFace[set.vertexPlaces[i]];
    }
    LimitMask::Tangents const &tangents = set.vertexMask.sides[0];
    return {int(set.vertexPlaces.size()), sources, set.vertexMask.weights.data(),
            tangents.du.data(), tangents.dv.data()};
}

} // namespace OpenSubdivHex::FarExt::internal

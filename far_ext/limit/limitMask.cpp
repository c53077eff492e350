// SPDX-License-Identifier: Apache-2.0
#include "limitMask.h"

#include "far_ext/vtr/hash.h"
#include "far_ext/vtr/lineFeatures.h"
#include "far_ext/vtr/pi.h"
#include "patchCycle.h"

#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>

namespace OpenSubdivHex::FarExt::internal {

namespace {

using Far::Index;
using Sdc::Crease;
using Vector = std::vector<double>;

double dot(Vector const &a, Vector const &b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        sum += a[i] * b[i];
    }
    return sum;
}

void addScaled(Vector &a, double factor, double const *b) {
    for (std::size_t i = 0; i < a.size(); ++i) {
        a[i] += factor * b[i];
    }
}

void addScaled(Vector &a, double factor, Vector const &b) { addScaled(a, factor, b.data()); }

void scale(Vector &a, double factor) {
    for (double &x : a) {
        x *= factor;
    }
}

void normalize(Vector &a) { scale(a, 1 / std::sqrt(dot(a, a))); }

double sum(Vector const &a) { return dot(a, Vector(a.size(), 1.0)); }

// Where an eigenvalue is close to the next, iteration is slow, but patches are small.
constexpr int kMaxIterations = 20000;
constexpr double kConverged = 1e-15;

// Calls step(), which returns by how much it changed vectors with \p size elements and of length 1,
// until that is as little as rounding lets it be.  Returns whether it came so far.
template <typename STEP>
bool iterate(int size, STEP step) {
    for (int i = 0; i < kMaxIterations; ++i) {
        if (step() < kConverged * size) {
            return true;
        }
    }
    return false;
}

// Assigns next to vector and returns how far they were apart.
double replace(Vector &vector, Vector &next) {
    addScaled(vector, -1, next);
    double const change = std::sqrt(dot(vector, vector));
    vector.swap(next);
    return change;
}

// The elements of some vertices.
template <typename T>
std::vector<T> gather(std::vector<T> const &vector, std::vector<Index> const &verts) {
    std::vector<T> result;
    result.reserve(verts.size());
    for (Index vert : verts) {
        result.push_back(vector[vert]);
    }
    return result;
}

// A left and a right eigenvector of the same eigenvalue.
struct Mode {
    Vector left;
    Vector right;
};

// Removes from a left vector what belongs to the mode.
void deflate(Vector &left, Mode const &mode) { addScaled(left, -dot(left, mode.right), mode.left); }

// The mode of the eigenvalue 1: all rows of a step sum to 1.
bool findPointMode(PatchCycle &cycle, int numVerts, Mode &mode) {
    mode = {Vector(numVerts, 0.0), Vector(numVerts, 1.0)};
    mode.left[0] = 1;
    Vector next;
    return iterate(numVerts, [&] {
        next = mode.left;
        cycle.ApplyLeft(next);
        scale(next, 1 / sum(next));
        return replace(mode.left, next);
    });
}

// Where the vertices of a patch of hexagons, of its part on one side of vertex 0, lie in the plane:
// vertex 0 at the origin, its neighbours at the distance 1.  A side fills half the plane, from the
// x axis on, or at a corner as much as it would in the lattice, unless it is all around.
struct Layout {
    Layout(Level const &level, VertexSide const &side, bool isCorner)
        : x(level.numVertices, 0.0), y(level.numVertices, 0.0), isPlaced(level.numVertices, false),
          isInside(level.numVertices, false) {
        for (FanItem const &item : side.items) {
            size += item.isFace ? (item.isHalf ? 0.5 : 1) : 0;
        }
        double const angleOfSide = side.isAllAround ? 2 * kPi
                                   : isCorner       ? std::min(kPi, kPi / 3 * size)
                                                    : kPi;
        double const unit = angleOfSide / size;
        isPlaced[0] = true;
        double angle = 0;
        for (FanItem const &item : side.items) {
            if (!item.isFace) {
                place(item.neighbor, item.isLong ? 2 : 1, angle, !isBreak(item));
                continue;
            }
            double const end = angle + (item.isHalf ? 0.5 : 1) * unit;
            placeFace(level, item, angle, end);
            angle = end;
        }
        for (FanItem const &item : side.items) {
            if (!item.isFace && !item.isLong) {
                placeOuterFaces(level, item.neighbor, !isBreak(item));
            }
        }
    }

    // Leaves out all but some vertices.
    void Keep(std::vector<Index> const &verts) {
        x = gather(x, verts);
        y = gather(y, verts);
        isInside = gather(isInside, verts);
        isPlaced = gather(isPlaced, verts);
    }

    double size = 0; // in faces; half faces count half
    Vector x;
    Vector y;
    std::vector<bool> isPlaced;
    std::vector<bool> isInside; // not on the sharp edges that bound the side, nor beyond

private:
    static bool isBreak(FanItem const &item) { return Crease::IsInfinite(item.sharpness); }

    void place(Index vert, double radius, double angle, bool inside) {
        if (!isPlaced[vert]) {
            isPlaced[vert] = true;
            isInside[vert] = inside;
            x[vert] = radius * std::cos(angle);
            y[vert] = radius * std::sin(angle);
        }
    }

    // The vertices of a face between the edges at angles begin and end.
    void placeFace(Level const &level, FanItem const &item, double begin, double end) {
        Index const face = level.FindFaceOfCorner(item.corner);
        Index const first = level.faceFirstCorner[face];
        std::vector<Index> verts;
        if (item.half >= 0) {
            int const diagonalEnd = level.GetDiagonalEnd(face);
            int const numOfHalf = GetHalfSize(item.half, level.GetFaceSize(face), diagonalEnd);
            for (int i = 0; i < numOfHalf; ++i) {
                verts.push_back(
                    level.faceVerts[first + GetPlaceInHalves(item.half, i, diagonalEnd)]);
            }
        } else {
            verts.assign(level.faceVerts.begin() + first,
                         level.faceVerts.begin() + level.faceFirstCorner[face + 1]);
        }
        std::rotate(verts.begin(), std::find(verts.begin(), verts.end(), 0), verts.end());
        // The other end of the last edge is placed later, but at the same place.  A vertex is as far
        // away in a half as in the whole: the layout has the symmetry of the patch.
        int const last = int(verts.size()) - 2;
        double const angleInFace = item.isHalf ? kPi / 2 : kPi;
        for (int i = 1; i < last; ++i) {
            double const part = double(i) / last;
            place(verts[i + 1], 1 + std::sin(angleInFace * part), begin + part * (end - begin),
                  true);
        }
    }

    // The faces of a neighbour beyond those of vertex 0.
    void placeOuterFaces(Level const &level, Index neighbor, bool inside) {
        constexpr double kFar = 2.6;
        double const angle = std::atan2(y[neighbor], x[neighbor]);
        for (Index k = level.vertFirstFace[neighbor]; k < level.vertFirstFace[neighbor + 1]; ++k) {
            Index const face = level.vertFaces[k];
            Index const *const begin = level.faceVerts.data() + level.faceFirstCorner[face];
            Index const *const end = level.faceVerts.data() + level.faceFirstCorner[face + 1];
            if (std::find(begin, end, 0) == end) {
                std::for_each(begin, end, [&](Index vert) { place(vert, kFar, angle, inside); });
            }
        }
    }
};

// Finds the masks of the tangents on one side of a vertex.
//
// At a vertex of a crease or a corner they depend on that side alone.  What lies beyond is left out: a
// corner of many creases has as many sides.
class TangentFinder {
public:
    TangentFinder(Level const &level, VertexSide const &side, FaceMask faceMask, PatchCycle &cycle,
                  Mode const &pointMode)
        : _side(side), _faceMask(faceMask), _rule(findRule(level)), _numVerts(level.numVertices),
          _layout(level, side, _rule == Crease::RULE_CORNER), _cycle(cycle),
          _verts(cycle.Confine(findSupport(pointMode), _rule == Crease::RULE_CORNER)),
          _pointMode({gather(pointMode.left, _verts), gather(pointMode.right, _verts)}) {
        _layout.Keep(_verts);
    }

    // Returns whether the iterations converge to tangents with different directions.
    bool Find(LimitMask::Tangents &tangents) {
        LimitMask::Tangents found = {_layout.x, _layout.y};
        bool hasConverged = false;
        if (!dependsOnSide()) {
            hasConverged = iterateBoth(found, [this](Vector &left) { removePoint(left); });
        } else if (_side.isAllAround) {
            hasConverged = findAllAround(found);
        } else {
            hasConverged = findAlong(_side.items.front(), found.du) && findAcross(found);
        }
        if (!hasConverged || !scaleToLayout(found)) {
            return false;
        }
        tangents = {scatter(found.du), scatter(found.dv)};
        return true;
    }

private:
    static Crease::Rule findRule(Level const &level) {
        SharpVertex const *const sharp = level.FindSharpVertex(0);
        return sharp ? sharp->rule : Crease::RULE_SMOOTH;
    }

    bool dependsOnSide() const {
        return _rule == Crease::RULE_CORNER || _rule == Crease::RULE_CREASE;
    }

    // The vertices that vectors have before they are iterated.
    std::vector<Index> findSupport(Mode const &pointMode) const {
        std::vector<Index> verts;
        for (Index vert = 0; vert < _numVerts; ++vert) {
            if (!dependsOnSide() || vert == 0 || pointMode.left[vert] != 0 ||
                _layout.isInside[vert]) {
                verts.push_back(vert);
            }
        }
        for (FanItem const &item : _side.items) {
            if (!item.isFace) {
                verts.push_back(item.neighbor);
            }
        }
        SortUnique(verts);
        return verts;
    }

    Vector scatter(Vector const &vector) const {
        Vector result(_numVerts, 0.0);
        for (std::size_t i = 0; i < vector.size(); ++i) {
            result[_verts[i]] = vector[i];
        }
        return result;
    }

    void removePoint(Vector &left) const { deflate(left, _pointMode); }

    // As if what is on sharp edges and beyond did not move.
    void keepInside(Vector &vector) const {
        for (std::size_t i = 0; i < vector.size(); ++i) {
            if (!_layout.isInside[i]) {
                vector[i] = 0;
            }
        }
    }

    // A sharp curve depends on itself only: its first mode is the tangent.
    bool findAlong(FanItem const &edge, Vector &tangent) {
        tangent.assign(_layout.x.size(), 0.0);
        auto const place = std::lower_bound(_verts.begin(), _verts.end(), edge.neighbor);
        tangent[place - _verts.begin()] = 1;
        return iterateOne(tangent, [this](Vector &left) { removePoint(left); });
    }

    bool findAcross(LimitMask::Tangents &tangents) {
        Vector &dv = tangents.dv;
        bool const isNarrow = _layout.size < (_rule == Crease::RULE_CREASE ? 1.5 : 2);
        if (_rule == Crease::RULE_CREASE && !(isNarrow && _faceMask == FaceMask::Average)) {
            return findBesideCurve(tangents.du, dv);
        }
        if (_rule == Crease::RULE_CORNER && isNarrow) {
            return findAlong(_side.items.back(), dv);
        }
        // To the middle of the faces.  At a wide corner the mode across is the largest, and the
        // tangents of both curves make no plane with it: du may be that of either.  On one face
        // beside a crease the eigenvalues across and of the curve's bend are .3273 and .3062 with
        // Average: what the mode across is shows after dozens of levels alone.
        bool const hasConverged = iterateOne(dv, [this](Vector &left) { keepInside(left); });
        dv[0] = -sum(dv);
        return hasConverged;
    }

    // The next mode beside the tangent of the curve.  Of a crease where several sheets meet each
    // has copies of the curve's vertices, which have the same values but modes of their own.
    bool findBesideCurve(Vector const &du, Vector &dv) {
        Vector copy;
        if (!findAlong(_side.items.back(), copy)) {
            return false;
        }
        removeDirection(copy, du);
        bool const isCopy = dot(copy, copy) > kLeastDifference;
        if (isCopy) {
            normalize(copy);
        }
        keepInside(dv);
        return iterateOne(dv, [&](Vector &left) {
            removePoint(left);
            removeDirection(left, du);
            if (isCopy) {
                removeDirection(left, copy);
            }
        });
    }

    static void removeDirection(Vector &vector, Vector const &direction) {
        addScaled(vector, -dot(vector, direction), direction);
    }

    // The faces around a vertex that does not depend on them approach a cone, whose tip has no
    // tangent plane: the plane of the next modes is that at right angles to the axis of a regular
    // cone.  With a sharp edge among the faces du is along it, and dv across.
    bool findAllAround(LimitMask::Tangents &tangents) {
        Mode axis;
        if (!findAxis(axis)) {
            return false;
        }
        auto const reduce = [&](Vector &left) {
            keepInside(left);
            deflate(left, axis);
        };
        FanItem const &first = _side.items.front();
        bool const hasEdge = !first.isFace && Crease::IsInfinite(first.sharpness);
        if (!(hasEdge ? findAlong(first, tangents.du) && iterateOne(tangents.dv, reduce)
                      : iterateBoth(tangents, reduce))) {
            return false;
        }
        for (Vector *tangent : {&tangents.du, &tangents.dv}) {
            (*tangent)[0] -= sum(*tangent);
        }
        return true;
    }

    // The largest mode inside, away from the vertex on all sides at once.
    bool findAxis(Mode &axis) {
        auto const reduce = [this](Vector &vector) { keepInside(vector); };
        axis.left.assign(_layout.x.size(), 1.0);
        axis.right.assign(_layout.x.size(), 1.0);
        bool const hasConverged = iterateOne(axis.left, reduce) &&
                                  iterateOne(axis.right, reduce, &PatchCycle::ApplyRight);
        scale(axis.left, 1 / dot(axis.left, axis.right));
        return hasConverged;
    }

    // Tends to the mode of the largest eigenvalue that reduce(vector) leaves.
    template <typename REDUCE>
    bool iterateOne(Vector &vector, REDUCE reduce,
                    void (PatchCycle::*apply)(Vector &) = &PatchCycle::ApplyLeft) {
        reduce(vector);
        normalize(vector);
        Vector next;
        return iterate(_numVerts, [&] {
            next = vector;
            (_cycle.*apply)(next);
            reduce(next);
            normalize(next);
            return replace(vector, next);
        });
    }

    // Simultaneous iteration, to the space of the modes of the two largest eigenvalues.
    template <typename REDUCE>
    bool iterateBoth(LimitMask::Tangents &tangents, REDUCE reduce) {
        Vector &du = tangents.du;
        Vector &dv = tangents.dv;
        auto const orthonormalize = [&] {
            reduce(du);
            normalize(du);
            reduce(dv);
            removeDirection(dv, du);
            normalize(dv);
        };
        orthonormalize();
        return iterate(_numVerts, [&] {
            LimitMask::Tangents const previous = {du, dv};
            _cycle.ApplyLeft(du);
            _cycle.ApplyLeft(dv);
            orthonormalize();
            return std::max(measureDistance(du, previous), measureDistance(dv, previous));
        });
    }

    // The distance of a vector from the span of both tangents.
    static double measureDistance(Vector vector, LimitMask::Tangents const &tangents) {
        removeDirection(vector, tangents.du);
        removeDirection(vector, tangents.dv);
        return std::sqrt(dot(vector, vector));
    }

    // Makes the masks those of the derivatives by x and y of the layout.  Returns whether these are
    // far enough from the same direction.
    bool scaleToLayout(LimitMask::Tangents &tangents) const {
        normalize(tangents.du);
        normalize(tangents.dv);
        double const ux = dot(tangents.du, _layout.x);
        double const uy = dot(tangents.du, _layout.y);
        double const vx = dot(tangents.dv, _layout.x);
        double const vy = dot(tangents.dv, _layout.y);
        double const determinant = ux * vy - uy * vx;
        Vector const du = tangents.du;
        scale(tangents.du, vy / determinant);
        addScaled(tangents.du, -uy / determinant, tangents.dv);
        scale(tangents.dv, ux / determinant);
        addScaled(tangents.dv, -vx / determinant, du);
        return std::abs(determinant) > kLeastDeterminant;
    }

    static constexpr double kLeastDeterminant = 1e-3;
    static constexpr double kLeastDifference = 1e-12; // squared, of directions that are different

    VertexSide const &_side;
    FaceMask const _faceMask;
    Crease::Rule const _rule;
    Index const _numVerts; // of the patch
    Layout _layout;
    PatchCycle &_cycle;
    std::vector<Index> const _verts; // that vectors have
    Mode const _pointMode;
};

using Node = LimitMaskFinder::Node;

// The mask of the first of nodes, whose last step leads back to it; nothing where iterations do not
// converge.
std::optional<LimitMask> solve(std::vector<Node> const &nodes, FaceMask faceMask) {
    Level level;
    BuildPatchLevel(nodes.front().patch, level);
    PatchCycle once;
    for (Node const &node : nodes) {
        once.Add(node.step);
    }
    Mode pointMode;
    if (!findPointMode(once, level.numVertices, pointMode)) {
        return {};
    }
    LimitMask mask;
    mask.weights = pointMode.left;
    std::vector<VertexSide> const sides = FindVertexSides(level, 0);
    for (int first = 0; first < int(sides.size()); ++first) {
        // The sides of a symmetric patch may come back in another order: round and round, until
        // this one is itself again.
        PatchCycle cycle;
        int side = first;
        do {
            for (Node const &node : nodes) {
                cycle.Add(node.step);
                side = node.step.sides[side];
            }
        } while (side != first);
        mask.sides.emplace_back();
        if (!TangentFinder(level, sides[first], faceMask, cycle, pointMode)
                 .Find(mask.sides.back())) {
            return {};
        }
    }
    return mask;
}

// The mask of a patch, from that of the patch which the step leads to.  There all lengths are half.
LimitMask stepMask(PatchRefinement const &step, LimitMask const &cMask) {
    LimitMask mask;
    step.ApplyLeft(cMask.weights, mask.weights);
    for (int cSide : step.sides) {
        LimitMask::Tangents tangents;
        step.ApplyLeft(cMask.sides[cSide].du, tangents.du);
        step.ApplyLeft(cMask.sides[cSide].dv, tangents.dv);
        scale(tangents.du, 2);
        scale(tangents.dv, 2);
        mask.sides.push_back(std::move(tangents));
    }
    return mask;
}

bool isOnFreeBoundary(Level const &level, Index vert) {
    for (Index k = level.vertFirstEdge[vert]; k < level.vertFirstEdge[vert + 1]; ++k) {
        if (level.edgeFaces[level.vertEdges[k]][1] == kFreeBoundary) {
            return true;
        }
    }
    return false;
}

// The vertex itself, and the mean plane of its faces: du across them from the last neighbour to the
// first, dv to their centroids.  All around, both are means by the cosine and the sine.
LimitMask makeFreeBoundaryMask(Level const &level) {
    LimitMask mask;
    mask.weights.assign(level.numVertices, 0.0);
    mask.weights[0] = 1;
    for (VertexSide const &side : FindVertexSides(level, 0)) {
        LimitMask::Tangents tangents = {Vector(level.numVertices, 0.0),
                                        Vector(level.numVertices, 0.0)};
        auto const numFaces = double(std::count_if(
            side.items.begin(), side.items.end(), [](FanItem const &item) { return item.isFace; }));
        double const angleOfFace = (side.isAllAround ? 2 : 1) * kPi / numFaces;
        if (!side.isAllAround) {
            tangents.du[side.items.front().neighbor] += 0.5;
            tangents.du[side.items.back().neighbor] -= 0.5;
        }
        double angle = 0;
        for (FanItem const &item : side.items) {
            if (item.isFace) {
                Index const face = level.FindFaceOfCorner(item.corner);
                Index const first = level.faceFirstCorner[face];
                Index const end = level.faceFirstCorner[face + 1];
                double const weight = std::sin(angle + angleOfFace / 2) / numFaces;
                for (Index corner = first; corner < end; ++corner) {
                    tangents.dv[level.faceVerts[corner]] += weight / double(end - first);
                }
                tangents.dv[0] -= weight;
                angle += angleOfFace;
            } else if (side.isAllAround) {
                tangents.du[item.neighbor] += std::cos(angle) / numFaces;
                tangents.du[0] -= std::cos(angle) / numFaces;
            }
        }
        mask.sides.push_back(std::move(tangents));
    }
    return mask;
}

} // namespace

std::size_t LimitMaskFinder::Hash::operator()(std::vector<int> const &signature) const {
    std::uint64_t hash = signature.size();
    for (int const number : signature) {
        hash = AddToHash(hash, std::uint64_t(number));
    }
    return std::size_t(hash);
}

auto LimitMaskFinder::Find(LimitPatch const &patch) -> MaskPointer {
    if (auto const found = _masks.find(patch.signature); found != _masks.end()) {
        return found->second;
    }
    if (_masks.size() > kMaxMasks) {
        _masks.clear();
    }
    Level level;
    BuildPatchLevel(patch, level);
    if (isOnFreeBoundary(level, 0)) {
        return _masks
            .emplace(patch.signature,
                     std::make_shared<LimitMask const>(makeFreeBoundaryMask(level)))
            .first->second;
    }
    std::vector<Node> nodes;
    nodes.push_back({patch, {}});
    while (int(nodes.size()) <= kMaxSteps) {
        LimitPatch next;
        nodes.back().step = RefinePatch(nodes.back().patch, _sdcOptions, _schemeOptions, next);
        auto const begin = std::find_if(nodes.begin(), nodes.end(), [&](Node const &node) {
            return node.patch.signature == next.signature;
        });
        if (begin != nodes.end()) {
            if (!addCycle({begin, nodes.end()})) {
                return nullptr;
            }
            nodes.erase(begin, nodes.end());
        }
        if (auto const known = _masks.find(next.signature); known != _masks.end()) {
            return addStepsBefore(nodes, known->second);
        }
        nodes.push_back({std::move(next), {}});
    }
    return nullptr;
}

// Any patch of the cycle gives one result: it begins with the least signature.
bool LimitMaskFinder::addCycle(std::vector<Node> nodes) {
    auto const least =
        std::min_element(nodes.begin(), nodes.end(), [](Node const &a, Node const &b) {
            return a.patch.signature < b.patch.signature;
        });
    std::rotate(nodes.begin(), least, nodes.end());
    std::optional<LimitMask> solution = solve(nodes, _schemeOptions.faceMask);
    if (!solution) {
        return false;
    }
    auto const mask = std::make_shared<LimitMask const>(std::move(*solution));
    _masks.insert_or_assign(nodes.front().patch.signature, mask);
    nodes.erase(nodes.begin()); // keeps the steps of the others, which lead back to it
    addStepsBefore(nodes, mask);
    return true;
}

// The mask of the first of the nodes, whose last step leads to a patch of the given mask.
auto LimitMaskFinder::addStepsBefore(std::vector<Node> const &nodes, MaskPointer mask)
    -> MaskPointer {
    for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) {
        mask = std::make_shared<LimitMask const>(stepMask(node->step, *mask));
        _masks.insert_or_assign(node->patch.signature, mask);
    }
    return mask;
}

namespace {

// Both have the diagonal, or the B edge, from V to W, then Q and P.  The mean of Q and P approaches
// that of V and W, so that the difference of these means is the tangent across; see mask.h.
void addHalfTangents(std::vector<int> const &corners, LimitMask &mask) {
    std::size_t const size = mask.weights.size();
    LimitMask::Tangents tangents = {Vector(size, 0.0), Vector(size, 0.0)};
    tangents.du[corners[0]] = -0.5;
    tangents.du[corners[1]] = 0.5;
    // Half a regular polygon in a circle of radius 1.
    auto const numEdges = int(corners.size()) - 1;
    long double sum = 0;
    for (int i = 1; i < numEdges; ++i) {
        long double const across = 2.0L / numEdges * std::sin(kLongPi * i / numEdges);
        tangents.dv[corners[std::size_t(i) + 1]] = double(across);
        sum += across;
    }
    tangents.dv[corners[0]] = tangents.dv[corners[1]] = -double(sum / 2);
    mask.sides.push_back(std::move(tangents));
}

LimitMask makePlainFaceMask(int size) {
    LimitMask mask;
    mask.weights.assign(size, 1.0 / size);
    LimitMask::Tangents tangents;
    for (int i = 0; i < size; ++i) {
        tangents.du.push_back(2.0 / size * std::cos(2 * kPi * i / size));
        tangents.dv.push_back(2.0 / size * std::sin(2 * kPi * i / size));
    }
    mask.sides.push_back(std::move(tangents));
    return mask;
}

} // namespace

LimitMask FaceLimitMaskFinder::Find(Index face) const {
    int const size = _level.GetFaceSize(face);
    bool const isHalf = _level.IsHalfFace(face);
    bool const isInHalves = isHalf || Crease::IsInfinite(_level.GetDiagonalSharpness(face));
    if (isInHalves ? isBesideLine(face) : !IsPlain(face)) {
        return findAfterStep(face);
    }
    if (!isInHalves) {
        return makePlainFaceMask(size);
    }
    LimitMask mask;
    if (isHalf) {
        mask.weights.assign(size, 0.0);
        mask.weights[0] = mask.weights[1] = 0.5;
        std::vector<int> corners(std::size_t(size), 0);
        std::iota(corners.begin(), corners.end(), 0);
        addHalfTangents(corners, mask);
    } else {
        int const diagonalEnd = _level.GetDiagonalEnd(face);
        mask.weights.assign(size, 0.0);
        mask.weights[kDiagonalStart] = mask.weights[diagonalEnd] = 0.5;
        for (int half : {0, 1}) {
            std::vector<int> corners(std::size_t(GetHalfSize(half, size, diagonalEnd)));
            for (std::size_t i = 0; i < corners.size(); ++i) {
                corners[i] = GetPlaceInHalves(half, int(i), diagonalEnd);
            }
            addHalfTangents(corners, mask);
        }
    }
    // The F-face has no vertex with one face.
    Index const first = _level.faceFirstCorner[face];
    bool const isBesideOneFace = !FindCornerTags(_level.sectorCorners, first, first + size).empty();
    return isBesideOneFace ? stepBack(std::move(mask), face) : mask;
}

// The F-face is a level of its own here: it has no sector corners and no irregular ones, a diagonal that
// is less sharp, flags from quads, and a place beside a line.
LimitMask FaceLimitMaskFinder::findAfterStep(Index face) const {
    int const size = _level.GetFaceSize(face);
    Index const first = _level.faceFirstCorner[face];
    Level child;
    child.depth = _level.depth + 1;
    child.numFaces = 1;
    child.numCorners = size;
    child.faceFirstCorner.Resize(2);
    child.faceFirstCorner[0] = 0;
    child.faceFirstCorner[1] = size;
    child.faceVerts.Resize(size);
    std::iota(child.faceVerts.data(), child.faceVerts.data() + size, 0);
    child.faceSizes = {size};
    child.diagonalSharpness.Resize(1);
    child.diagonalSharpness[0] =
        Crease(_sdcOptions).SubdivideUniformSharpness(_level.GetDiagonalSharpness(face));

    if (CrossedFace const *const crossed = _level.FindCrossedFace(face)) {
        child.crossedFaces = {{0, crossed->end}};
    }
    child.numHexagonalSteps = _level.numHexagonalSteps + 1;
    if (size == HexIndexing::kNumEFaceCorners) {
        for (QuadCorner const &quad : FindCornerTags(_level.quadCorners, first, first + size)) {
            QuadFlags const flags = AppendToQuadFlags(quad.flags, _level.numHexagonalSteps, 0, 0);
            if (flags.HasAny()) {
                child.quadCorners.push_back({quad.corner - first, flags});
            }
        }
    }
    for (QuadLineCorner const &tag : FindCornerTags(_level.quadLineCorners, first, first + size)) {
        QuadLineFlags const flags =
            AppendToQuadLineFlags(tag.flags, _level.numHexagonalSteps, 0, 0);
        if (flags.HasAny()) {
            child.quadLineCorners.push_back({tag.corner - first, flags});
        }
    }
    for (LineRowCorner const &tag : FindCornerTags(_level.lineRowCorners, first, first + size)) {
        if (auto ofFFace = FindLineRowOfFFace(tag, size, _sdcOptions);
            ofFFace && child.numHexagonalSteps < kNumLineSteps) {
            ofFFace->corner = tag.corner - first;
            child.lineRowCorners.push_back(*ofFFace);
        }
    }
    if (_level.IsHalfFace(face)) {
        child.numSharpBoundariesB = 1;
        child.halfFaces.Assign(std::vector<Index>{0});
        child.faceEdges.Resize(std::size_t(size));
        std::iota(child.faceEdges.data(), child.faceEdges.data() + size, 0);
        child.edgeFaces.Resize(std::size_t(size));
        std::fill_n(child.edgeFaces.data(), size, IndexPair{0, kFreeBoundary});
        child.edgeFaces[kHalfFaceLongEdge][1] = kSharpBoundaryB;
    }
    return stepBack(FaceLimitMaskFinder(child, _sdcOptions, _schemeOptions).Find(0), face);
}

// Makes the mask of the F-face that of the face.
LimitMask FaceLimitMaskFinder::stepBack(LimitMask mask, Index face) const {
    mask.weights = stepBack(mask.weights, face);
    for (LimitMask::Tangents &tangents : mask.sides) {
        tangents.du = stepBack(tangents.du, face);
        tangents.dv = stepBack(tangents.dv, face);
        scale(tangents.du, 2);
        scale(tangents.dv, 2);
    }
    return mask;
}

// Makes of weights of the F-face's vertices those of the face's.
Vector FaceLimitMaskFinder::stepBack(Vector const &cWeights, Index face) const {
    Vector result(cWeights.size(), 0.0);
    FaceRule const rule = _rules->GetFaceRule(face);
    for (int i = 0; i < rule.GetSize(); ++i) {
        addScaled(result, cWeights[i], rule.GetRow(i));
    }
    return result;
}

} // namespace OpenSubdivHex::FarExt::internal

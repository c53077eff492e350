// SPDX-License-Identifier: Apache-2.0
#include "limitMask.h"

#include <cmath>
#include <numeric>

namespace OpenSubdivHex::FarExt::internal {

namespace {

using Far::Index;
using Sdc::Crease;
using Vector = std::vector<double>;

constexpr double kPi = 3.14159265358979323846;

// Steps that lead from a patch back to one that looks the same, as one linear map.
class Cycle {
public:
    void Add(LimitStep const &step) { _steps.push_back(&step); }
    int GetSize() const { return int(_steps.size()); }

    void ApplyLeft(Vector &left) {
        for (auto step = _steps.rbegin(); step != _steps.rend(); ++step) {
            (*step)->ApplyLeft(left, _scratch);
            left.swap(_scratch);
        }
    }
    void ApplyRight(Vector &right) {
        for (LimitStep const *step : _steps) {
            step->ApplyRight(right, _scratch);
            right.swap(_scratch);
        }
    }

private:
    std::vector<LimitStep const *> _steps;
    Vector _scratch;
};

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

// A left and a right eigenvector of the same eigenvalue.
struct Mode {
    Vector left;
    Vector right;
};

// Removes from a left vector what belongs to the modes.
void deflate(Vector &left, std::vector<Mode> const &modes) {
    for (Mode const &mode : modes) {
        addScaled(left, -dot(left, mode.right), mode.left);
    }
}

// The mode of the eigenvalue 1: all rows of a step sum to 1.
Mode findPointMode(Cycle &cycle, int numVerts) {
    Mode mode = {Vector(numVerts, 0.0), Vector(numVerts, 1.0)};
    mode.left[0] = 1;
    Vector next;
    for (int i = 0; i < kMaxIterations; ++i) {
        next = mode.left;
        cycle.ApplyLeft(next);
        scale(next, 1 / sum(next));
        addScaled(mode.left, -1, next);
        double const change = std::sqrt(dot(mode.left, mode.left));
        mode.left.swap(next);
        if (change < kConverged) {
            break;
        }
    }
    return mode;
}

// The mode of the largest eigenvalue that modes leave, from start vectors with a part in it.
Mode findNextMode(Cycle &cycle, std::vector<Mode> const &modes, Vector left, Vector right) {
    Vector next;
    double const converged = kConverged * double(left.size());
    double change = 1;
    for (int i = 0; i < kMaxIterations && change >= converged; ++i) {
        deflate(left, modes);
        normalize(left);
        next = left;
        cycle.ApplyLeft(next);
        deflate(next, modes);
        normalize(next);
        addScaled(left, -1, next);
        change = std::sqrt(dot(left, left));
        left.swap(next);
    }
    change = 1;
    for (int i = 0; i < kMaxIterations && change >= converged; ++i) {
        for (Mode const &mode : modes) {
            addScaled(right, -dot(right, mode.left), mode.right);
        }
        normalize(right);
        next = right;
        cycle.ApplyRight(next);
        normalize(next);
        addScaled(right, -1, next);
        change = std::sqrt(dot(right, right));
        right.swap(next);
    }
    scale(left, 1 / dot(left, right));
    return {left, right};
}

// Where the vertices of a patch of hexagons, of its part on one side of vertex 0, lie in the plane:
// vertex 0 at the origin, its neighbours at the distance 1.  A side fills half the plane, from the
// x axis on, or at a corner as much as it would in the lattice, unless it is all around.
struct Layout {
    Layout(LevelTopology const &level, VertexSide const &side, bool isCorner)
        : x(level.numVertices, 0.0), y(level.numVertices, 0.0), isPlaced(level.numVertices, false),
          isInside(level.numVertices, false) {
        for (RingItem const &item : side.items) {
            size += item.isFace ? (item.isHalf ? 0.5 : 1) : 0;
        }
        double const angleOfSide = side.isAllAround ? 2 * kPi
                                   : isCorner       ? std::min(kPi, kPi / 3 * size)
                                                    : kPi;
        double const unit = angleOfSide / size;
        isPlaced[0] = true;
        double angle = 0;
        for (RingItem const &item : side.items) {
            if (!item.isFace) {
                place(item.neighbor, item.isLong ? 2 : 1, angle, !isBreak(item));
                continue;
            }
            double const end = angle + (item.isHalf ? 0.5 : 1) * unit;
            placeFace(level, item, angle, end);
            angle = end;
        }
        for (RingItem const &item : side.items) {
            if (!item.isFace && !item.isLong) {
                placeOuterFaces(level, item.neighbor, !isBreak(item));
            }
        }
    }

    double size = 0; // in faces; half faces count half
    Vector x;
    Vector y;
    std::vector<bool> isPlaced;
    std::vector<bool> isInside; // not on the sharp edges that bound the side, nor beyond

private:
    static bool isBreak(RingItem const &item) { return Crease::IsInfinite(item.sharpness); }

    void place(Index vert, double radius, double angle, bool inside) {
        if (!isPlaced[vert]) {
            isPlaced[vert] = true;
            isInside[vert] = inside;
            x[vert] = radius * std::cos(angle);
            y[vert] = radius * std::sin(angle);
        }
    }

    // The vertices of a face between the edges at angles begin and end.
    void placeFace(LevelTopology const &level, RingItem const &item, double begin, double end) {
        Index const face = FindFaceOfCorner(level, item.corner);
        Index const first = level.faceFirstCorner[face];
        std::vector<Index> verts;
        if (item.half >= 0) {
            for (int corner : kHexagonHalves[item.half]) {
                verts.push_back(level.faceVerts[first + corner]);
            }
        } else {
            verts.assign(level.faceVerts.begin() + first,
                         level.faceVerts.begin() + level.faceFirstCorner[face + 1]);
        }
        std::rotate(verts.begin(), std::find(verts.begin(), verts.end(), 0), verts.end());
        // The other end of the last edge is placed later, but at the same place.
        int const last = int(verts.size()) - 2;
        for (int i = 1; i < last; ++i) {
            double const part = double(i) / last;
            place(verts[i + 1], 1 + std::sin(kPi * part), begin + part * (end - begin), true);
        }
    }

    // What the faces of a neighbour have beyond those of vertex 0.
    void placeOuterFaces(LevelTopology const &level, Index neighbor, bool inside) {
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
class TangentFinder {
public:
    TangentFinder(LevelTopology const &level, VertexSide const &side, Cycle &cycle,
                  Mode const &pointMode)
        : _level(level), _side(side), _rule(findRule(level)),
          _layout(level, side, _rule == Crease::RULE_CORNER), _cycle(cycle), _modes({pointMode}) {}

    LimitMask::Tangents Find() {
        LimitMask::Tangents tangents = {Vector(_level.numVertices, 0.0),
                                        Vector(_level.numVertices, 0.0)};
        if (_side.isAllAround && _rule == Crease::RULE_CORNER) {
            removeConeMode();
        }
        bool const isBounded = startAlongCurve(tangents.du);
        for (Index vert = 0; vert < _level.numVertices; ++vert) {
            if (!isBounded) {
                tangents.du[vert] = _layout.x[vert];
            }
            tangents.dv[vert] = _layout.isInside[vert] ? _layout.y[vert] : 0;
        }
        iterate(tangents, isBounded);
        bool const isCorner = _rule == Crease::RULE_CORNER;
        if (isBounded && (isCorner ? _layout.size >= 2 : _layout.size < 1.5)) {
            takeChord(tangents.dv);
        }
        scaleToLayout(tangents);
        return tangents;
    }

private:
    static Crease::Rule findRule(LevelTopology const &level) {
        SharpVertex const *const sharp = level.FindSharpVertex(0);
        return sharp ? sharp->rule : Crease::RULE_SMOOTH;
    }

    // The faces around a corner without sharp edges approach a cone, whose tip has no tangent
    // plane: the plane of the next modes is that at right angles to the axis of a regular cone.
    void removeConeMode() {
        Vector start(_level.numVertices, 0.0);
        for (Index vert = 1; vert < _level.numVertices; ++vert) {
            start[vert] = _layout.isPlaced[vert];
        }
        _modes.push_back(findNextMode(_cycle, _modes, start, start));
    }

    // What lies on a sharp curve depends on the curve alone, so that du stays on it: on the edge
    // where the side begins and, at a crease, on that where it ends.
    bool startAlongCurve(Vector &du) const {
        RingItem const &begin = _side.items.front();
        RingItem const &end = _side.items.back();
        bool const hasBegin = !begin.isFace && Crease::IsInfinite(begin.sharpness);
        bool const hasEnd = !end.isFace && Crease::IsInfinite(end.sharpness);
        if (_side.isAllAround || (!hasBegin && !hasEnd)) {
            return false;
        }
        if (hasBegin) {
            du[begin.neighbor] += 1;
        }
        if (hasEnd && (!hasBegin || _rule == Crease::RULE_CREASE)) {
            du[end.neighbor] -= 1;
        }
        du[0] -= sum(du);
        return true;
    }

    // Simultaneous iteration: du tends to the left eigenvector of the largest eigenvalue that its
    // start has a part in, both together to the space of the two largest.  With du on a curve, that
    // one is the curve's own.
    void iterate(LimitMask::Tangents &tangents, bool isBounded) {
        Vector du = tangents.du;
        Vector dv = tangents.dv;
        orthonormalize(du, dv);
        double const converged = kConverged * double(du.size());
        for (int i = 0; i < kMaxIterations; ++i) {
            tangents = {du, dv};
            _cycle.ApplyLeft(du);
            _cycle.ApplyLeft(dv);
            orthonormalize(du, dv);
            if (measureDistance(du, tangents, isBounded) < converged &&
                measureDistance(dv, tangents, false) < converged) {
                break;
            }
        }
        tangents = {du, dv};
    }

    // On a narrow side the modes of the curve bury that across it.  At a wide corner both sharp
    // edges may have the same direction.  Then dv is no eigenvector but goes to the middle of the
    // faces around; their weights are those of the eigenvector on a curve that does not move.
    void takeChord(Vector &dv) {
        auto const removeCurve = [this](Vector &vector) {
            for (std::size_t i = 0; i < vector.size(); ++i) {
                if (!_layout.isInside[i]) {
                    vector[i] = 0;
                }
            }
            normalize(vector);
        };
        dv = _layout.y;
        removeCurve(dv);
        double const converged = kConverged * double(dv.size());
        double change = 1;
        for (int i = 0; i < kMaxIterations && change >= converged; ++i) {
            Vector next = dv;
            _cycle.ApplyLeft(next);
            removeCurve(next);
            addScaled(dv, -1, next);
            change = std::sqrt(dot(dv, dv));
            dv.swap(next);
        }
        dv[0] = -sum(dv);
    }

    void orthonormalize(Vector &du, Vector &dv) const {
        deflate(du, _modes);
        normalize(du);
        deflate(dv, _modes);
        addScaled(dv, -dot(du, dv), du);
        normalize(dv);
    }

    // Of a vector from the span of both tangents, or from that of du.
    static double measureDistance(Vector vector, LimitMask::Tangents const &tangents, bool fromDu) {
        double const du = dot(vector, tangents.du);
        double const dv = fromDu ? 0 : dot(vector, tangents.dv);
        addScaled(vector, -du, tangents.du);
        addScaled(vector, -dv, tangents.dv);
        return std::sqrt(dot(vector, vector));
    }

    // Makes the masks those of the derivatives by x and y of the layout.
    void scaleToLayout(LimitMask::Tangents &tangents) const {
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
    }

    LevelTopology const &_level;
    VertexSide const &_side;
    Crease::Rule const _rule;
    Layout const _layout;
    Cycle &_cycle;
    std::vector<Mode> _modes;
};

using Node = LimitMaskFinder::Node;

// The mask of the first of nodes, whose last step leads back to it.
LimitMask solve(std::vector<Node> const &nodes) {
    LevelTopology level;
    BuildPatchLevel(nodes.front().patch, level);
    Cycle once;
    for (Node const &node : nodes) {
        once.Add(node.step);
    }
    Mode const pointMode = findPointMode(once, level.numVertices);
    LimitMask mask;
    mask.weights = pointMode.left;
    std::vector<VertexSide> const sides = FindVertexSides(level, 0);
    for (int first = 0; first < int(sides.size()); ++first) {
        // The sides of a symmetric patch may come back in another order: round and round, until
        // this one is itself again.
        Cycle cycle;
        int side = first;
        do {
            for (Node const &node : nodes) {
                cycle.Add(node.step);
                side = node.step.sides[side];
            }
        } while (side != first);
        mask.sides.push_back(TangentFinder(level, sides[first], cycle, pointMode).Find());
    }
    return mask;
}

// The mask of a patch, from that of the patch which the step leads to.  There all lengths are half.
LimitMask stepBack(LimitStep const &step, LimitMask const &cMask) {
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

bool isOnFreeBoundary(LevelTopology const &level, Index vert) {
    for (Index k = level.vertFirstEdge[vert]; k < level.vertFirstEdge[vert + 1]; ++k) {
        if (level.edgeFaces[2 * std::size_t(level.vertEdges[k]) + 1] == kFreeBoundary) {
            return true;
        }
    }
    return false;
}

// The vertex itself, and the mean plane of its faces: du across them from the last neighbour to the
// first, dv to their centroids.
LimitMask makeFreeBoundaryMask(LevelTopology const &level) {
    LimitMask mask;
    mask.weights.assign(level.numVertices, 0.0);
    mask.weights[0] = 1;
    for (VertexSide const &side : FindVertexSides(level, 0)) {
        LimitMask::Tangents tangents = {Vector(level.numVertices, 0.0),
                                        Vector(level.numVertices, 0.0)};
        tangents.du[side.items.front().neighbor] += 0.5;
        tangents.du[side.items.back().neighbor] -= 0.5;
        auto const numFaces = std::count_if(side.items.begin(), side.items.end(),
                                            [](RingItem const &item) { return item.isFace; });
        int i = 0;
        for (RingItem const &item : side.items) {
            if (item.isFace) {
                Index const face = FindFaceOfCorner(level, item.corner);
                Index const first = level.faceFirstCorner[face];
                Index const end = level.faceFirstCorner[face + 1];
                double const weight =
                    std::sin(kPi * (i++ + 0.5) / double(numFaces)) / double(numFaces);
                for (Index corner = first; corner < end; ++corner) {
                    tangents.dv[level.faceVerts[corner]] += weight / double(end - first);
                }
                tangents.dv[0] -= weight;
            }
        }
        mask.sides.push_back(std::move(tangents));
    }
    return mask;
}

} // namespace

LimitMask const &LimitMaskFinder::Find(LimitPatch const &patch) {
    if (auto const found = _masks.find(patch.signature); found != _masks.end()) {
        return found->second;
    }
    if (_masks.size() > kMaxMasks) {
        _masks.clear();
    }
    LevelTopology level;
    BuildPatchLevel(patch, level);
    if (isOnFreeBoundary(level, 0)) {
        return _masks.emplace(patch.signature, makeFreeBoundaryMask(level)).first->second;
    }
    std::vector<Node> nodes;
    nodes.push_back({patch, {}});
    for (;;) {
        LimitPatch next;
        nodes.back().step = RefinePatch(nodes.back().patch, _sdcOptions, _schemeOptions, next);
        auto const begin = std::find_if(nodes.begin(), nodes.end(), [&](Node const &node) {
            return node.patch.signature == next.signature;
        });
        if (begin != nodes.end()) {
            addCycle({begin, nodes.end()});
            nodes.erase(begin, nodes.end());
        }
        if (auto const known = _masks.find(next.signature); known != _masks.end()) {
            return addStepsBefore(nodes, known->second);
        }
        nodes.push_back({std::move(next), {}});
    }
}

// The same for any patch that the cycle was found from: it begins with the least signature.
void LimitMaskFinder::addCycle(std::vector<Node> nodes) {
    auto const least =
        std::min_element(nodes.begin(), nodes.end(), [](Node const &a, Node const &b) {
            return a.patch.signature < b.patch.signature;
        });
    std::rotate(nodes.begin(), least, nodes.end());
    LimitMask const &mask =
        _masks.insert_or_assign(nodes.front().patch.signature, solve(nodes)).first->second;
    nodes.erase(nodes.begin()); // keeps the steps of the others, which lead back to it
    addStepsBefore(nodes, mask);
}

// The mask of the first of the nodes, whose last step leads to a patch of the given mask.
LimitMask const &LimitMaskFinder::addStepsBefore(std::vector<Node> const &nodes,
                                                 LimitMask const &lastMask) {
    LimitMask const *mask = &lastMask;
    for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) {
        mask = &_masks.insert_or_assign(node->patch.signature, stepBack(node->step, *mask))
                    .first->second;
    }
    return *mask;
}

namespace {

// Both have the diagonal, or the B edge, from V to W, then Q and P.  The mean of Q and P approaches
// that of V and W, so that the difference of these means is the tangent across; see mask.h.
void addHalfTangents(int const corners[4], LimitMask &mask) {
    std::size_t const size = mask.weights.size();
    LimitMask::Tangents tangents = {Vector(size, 0.0), Vector(size, 0.0)};
    double const across = 1 / std::sqrt(3.0); // half a regular hexagon with edges of length 1
    tangents.du[corners[0]] = -0.5;
    tangents.du[corners[1]] = 0.5;
    tangents.dv[corners[0]] = tangents.dv[corners[1]] = -across;
    tangents.dv[corners[2]] = tangents.dv[corners[3]] = across;
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
    LevelTopology const &topology = _level.GetTopology();
    int const size = _level.GetFaceVertices(face).size();
    if (topology.IsHalfFace(face)) {
        LimitMask mask;
        mask.weights = {0.5, 0.5, 0, 0};
        int const corners[4] = {0, 1, 2, 3};
        addHalfTangents(corners, mask);
        return mask;
    }
    float const diagonal = topology.GetDiagonalSharpness(face);
    if (Crease::IsInfinite(diagonal)) {
        LimitMask mask;
        mask.weights.assign(size, 0.0);
        mask.weights[kDiagonalStart] = mask.weights[kDiagonalEnd] = 0.5;
        for (auto const &half : kHexagonHalves) {
            addHalfTangents(half, mask);
        }
        return mask;
    }
    Index const first = topology.faceFirstCorner[face];
    bool const hasSector = !topology.GetSectorCorners(first, first + size).empty();
    return hasSector || Crease::IsSharp(diagonal) ? findAfterStep(face) : makePlainFaceMask(size);
}

// The F-face is a level of its own here: it has no sector corners, and a diagonal that is less
// sharp.
LimitMask FaceLimitMaskFinder::findAfterStep(Index face) const {
    int const size = _level.GetFaceVertices(face).size();
    LevelTopology child;
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
        Crease(_sdcOptions).SubdivideUniformSharpness(_level.GetFaceDiagonalSharpness(face));

    LimitMask mask =
        FaceLimitMaskFinder(TopologyLevel(&child), _sdcOptions, _schemeOptions).Find(0);
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
    Vector scratch;
    for (int i = 0; i < int(cWeights.size()); ++i) {
        addScaled(result, cWeights[i], _mask.GetFaceVertexWeights(face, i, scratch));
    }
    return result;
}

} // namespace OpenSubdivHex::FarExt::internal

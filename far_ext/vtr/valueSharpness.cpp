// SPDX-License-Identifier: Apache-2.0
#include "valueSharpness.h"

#include "indexSet.h"
#include "parallel.h"

#include <algorithm>

namespace OpenSubdivHex::FarExt::internal {

namespace {

using Far::Index;
using Sdc::Crease;
using Interpolation = Sdc::Options::FVarLinearInterpolation;

float const kSmooth = Crease::SHARPNESS_SMOOTH;
float const kInfinite = Crease::SHARPNESS_INFINITE;

// The faces of a vertex that have one value, one after the other unless the value comes back.
struct Span {
    Index value;
    int numFaces = 0;
    int numRuns = 0;        // of faces without others between
    bool isParted = false;  // by a seam that ends at the vertex, or by an infinitely sharp crease
    bool isCreased = false; // by a semi-sharp crease
};

// The values at one vertex after the other.
class VertexValues {
public:
    VertexValues(Level const &mesh, Index const *faceValues, Interpolation interpolation)
        : _mesh(mesh), _faceValues(faceValues), _interpolation(interpolation) {}

    // Sets the sharpness of the vertex's corners.
    void SetSharpness(Index vert, std::vector<float> &sharpness);

private:
    void gather(Index vert);
    void findSpans();
    void inspectEdges();
    bool isSeam(int face) const;
    bool isSeamAtNonManifold() const;
    bool meetsBoundary(Index vert) const;
    bool staysAsOne() const;
    float getSharpness(Span const &span, Span const *other, float vertSharpness) const;

    int size() const { return int(_corners.size()); }
    Index value(int face) const { return _faceValues[_corners[std::size_t(face)]]; }
    // The face before one, counter-clockwise; -1 before the first face of an open fan.
    int prev(int face) const { return face > 0 ? face - 1 : _isClosed ? size() - 1 : -1; }

    Level const &_mesh;
    Index const *_faceValues;
    Interpolation _interpolation;
    // The corners of the vertex, and the corners before and behind them in their faces.
    std::vector<Index> _corners;
    std::vector<Index> _prevCorners;
    std::vector<Index> _nextCorners;
    bool _isClosed = false; // of a manifold vertex
    std::vector<Span> _spans;
    std::vector<int> _spanOfFace;
};

void VertexValues::gather(Index vert) {
    _corners.clear();
    _prevCorners.clear();
    _nextCorners.clear();
    for (Index k = _mesh.vertFirstFace[vert]; k < _mesh.vertFirstFace[vert + 1]; ++k) {
        Index const face = _mesh.vertFaces[k];
        Index const corner = _mesh.GetVertexCorner(k);
        _corners.push_back(corner);
        _prevCorners.push_back(_mesh.GetPrevCorner(face, corner));
        _nextCorners.push_back(_mesh.GetNextCorner(face, corner));
    }
    _isClosed = _mesh.GetVertexEdges(vert).size() == size();
}

// Whether the values on both sides of the edge before a face differ, at the vertex or at the edge's
// other end.
bool VertexValues::isSeam(int face) const {
    int const before = prev(face);
    return before >= 0 &&
           (value(face) != value(before) || _faceValues[_nextCorners[std::size_t(face)]] !=
                                                _faceValues[_prevCorners[std::size_t(before)]]);
}

// Variant for any edge of a non-manifold vertex that has one value: edges of one line count as one.
bool VertexValues::isSeamAtNonManifold() const {
    struct End {
        Index line;
        Index value; // at the other end
    };
    std::vector<End> ends;
    for (int i = 0; i < size(); ++i) {
        auto const add = [&](Index edge, Index other) {
            Index const line = _mesh.GetEdgeLine(edge);
            ends.push_back({line == Far::INDEX_INVALID ? edge : line, _faceValues[other]});
        };
        add(_mesh.faceEdges[_corners[std::size_t(i)]], _nextCorners[std::size_t(i)]);
        add(_mesh.faceEdges[_prevCorners[std::size_t(i)]], _prevCorners[std::size_t(i)]);
    }
    std::sort(ends.begin(), ends.end(), [](End const &a, End const &b) { return a.line < b.line; });
    auto const differ = [](End const &a, End const &b) {
        return a.line == b.line && a.value != b.value;
    };
    return std::adjacent_find(ends.begin(), ends.end(), differ) != ends.end();
}

// Whether the vertex has an edge that has one face in the base.
bool VertexValues::meetsBoundary(Index vert) const {
    Far::ConstIndexArray const edges = _mesh.GetVertexEdges(vert);
    std::vector<Index> lines;
    for (Index edge : edges) {
        if (_mesh.IsBoundary(edge)) {
            lines.push_back(_mesh.GetEdgeLine(edge));
            if (lines.back() == Far::INDEX_INVALID) {
                return true;
            }
        }
    }
    std::sort(lines.begin(), lines.end());
    for (std::size_t i = 0; i < lines.size(); ++i) {
        bool const isAlone = (i == 0 || lines[i - 1] != lines[i]) &&
                             (i + 1 == lines.size() || lines[i + 1] != lines[i]);
        if (isAlone) {
            return true;
        }
    }
    return false;
}

// A value that comes back behind another one has one span, with one exception that is Far's: where
// there are two spans so far, the second of them ends with its first run.
void VertexValues::findSpans() {
    _spans.clear();
    _spanOfFace.clear();
    for (int face = 0; face < size(); ++face) {
        std::size_t span = 0;
        if (face > 0 && value(face) == value(face - 1)) {
            span = std::size_t(_spanOfFace.back());
        } else {
            while (span < _spans.size() &&
                   (_spans[span].value != value(face) || (span == 1 && _spans.size() == 2))) {
                ++span;
            }
        }
        if (span == _spans.size()) {
            _spans.push_back({value(face)});
        }
        _spanOfFace.push_back(int(span));
        ++_spans[span].numFaces;
    }
}

// Separators of the spans of faces.  A single span all around begins at a seam.
void VertexValues::inspectEdges() {
    bool isCut = !_isClosed || _spans.size() > 1;
    for (int face = 0; face < size(); ++face) {
        Span &span = _spans[std::size_t(_spanOfFace[std::size_t(face)])];
        int const before = prev(face);
        if (before < 0 || _spanOfFace[std::size_t(before)] != _spanOfFace[std::size_t(face)]) {
            ++span.numRuns;
        } else if (!isCut && isSeam(face)) {
            isCut = true;
            ++span.numRuns;
        } else {
            float const sharpness =
                _mesh.GetEdgeSharpness(_mesh.faceEdges[_corners[std::size_t(face)]]);
            span.isParted = span.isParted || isSeam(face) || Crease::IsInfinite(sharpness);
            span.isCreased = span.isCreased || Crease::IsSemiSharp(sharpness);
        }
    }
}

// Whether the interpolation keeps all values of the vertex in place because of how many they are.
bool VertexValues::staysAsOne() const {
    if (_interpolation < Sdc::Options::FVAR_LINEAR_CORNERS_PLUS1) {
        return false;
    }
    bool const isJunction = _spans.size() > 2;
    bool const isDart = _spans.size() == 1 && _isClosed;
    bool const isConcave =
        _spans.size() == 2 && (_spans[0].numFaces == 1 || _spans[1].numFaces == 1);
    return isJunction ||
           (_interpolation == Sdc::Options::FVAR_LINEAR_CORNERS_PLUS2 && (isDart || isConcave));
}

// From FVAR_LINEAR_CORNERS_PLUS1 on, one of two values depends on the other; without such a value, other is null.
float VertexValues::getSharpness(Span const &span, Span const *other, float vertSharpness) const {
    auto const isBroken = [](Span const &any) { return any.numRuns > 1 || any.isParted; };
    bool const isCorner = span.numFaces == 1 && _interpolation != Sdc::Options::FVAR_LINEAR_NONE;
    if (isBroken(span) || isCorner || (other && isBroken(*other))) {
        return kInfinite;
    }
    return span.isCreased || (other && other->isCreased) ? vertSharpness : kSmooth;
}

void VertexValues::SetSharpness(Index vert, std::vector<float> &sharpness) {
    gather(vert);
    float const vertSharpness = _mesh.GetVertexSharpness(vert);
    auto const setAll = [&](float value) {
        for (Index corner : _corners) {
            sharpness[corner] = value;
        }
    };
    bool isMatching = true; // as if there were no values but one for each vertex
    for (int face = 0; face < size() && isMatching; ++face) {
        isMatching = value(face) == value(0) && !isSeam(face);
    }
    bool const isNonManifold = _mesh.IsNonManifold(vert);
    bool const isBoundaryLinear = _interpolation == Sdc::Options::FVAR_LINEAR_BOUNDARIES;
    if (isNonManifold) {
        bool isOneValue = true;
        for (int face = 1; face < size(); ++face) {
            isOneValue = isOneValue && value(face) == value(0);
        }
        isMatching = isOneValue && !isSeamAtNonManifold();
    }
    if (isMatching) {
        bool const isCorner =
            size() == 1 && !isNonManifold && _interpolation != Sdc::Options::FVAR_LINEAR_NONE;
        bool const stays = isCorner || (isBoundaryLinear && meetsBoundary(vert));
        setAll(stays ? kInfinite : vertSharpness);
        return;
    }
    if (isNonManifold || isBoundaryLinear || Crease::IsInfinite(vertSharpness)) {
        setAll(kInfinite);
        return;
    }
    findSpans();
    inspectEdges();
    if (staysAsOne()) {
        setAll(kInfinite);
        return;
    }
    bool const isDependent =
        _spans.size() == 2 && _interpolation >= Sdc::Options::FVAR_LINEAR_CORNERS_PLUS1;
    for (int face = 0; face < size(); ++face) {
        int const span = _spanOfFace[std::size_t(face)];
        Span const *const other = isDependent ? &_spans[std::size_t(1 - span)] : nullptr;
        float const own = getSharpness(_spans[std::size_t(span)], other, vertSharpness);
        sharpness[_corners[std::size_t(face)]] = std::max(own, vertSharpness);
    }
}

// The vertices whose values may have a sharpness, ascending.
std::vector<Index> findVertices(Level const &mesh, std::vector<Index> const &seams) {
    std::vector<Index> result = mesh.nonManifoldVerts;
    auto const addEnds = [&](auto const &edges) {
        for (Index edge : edges) {
            result.insert(result.end(), mesh.edgeVerts[edge].begin(), mesh.edgeVerts[edge].end());
        }
    };
    addEnds(seams);
    addEnds(mesh.boundaryEdges);
    std::vector<Index> const sharp =
        ParallelSelect(Index(mesh.vertSharpness.size()),
                       [&](Index vert) { return Crease::IsSharp(mesh.vertSharpness[vert]); });
    result.insert(result.end(), sharp.begin(), sharp.end());
    SortUnique(result, mesh.numVertices);
    return result;
}

} // namespace

std::vector<float> FindValueSharpness(Level const &mesh, Index const *faceValues,
                                      std::vector<Index> const &seams,
                                      Interpolation interpolation) {
    std::vector<float> sharpness(mesh.numCorners, 0.0f);
    if (interpolation != Sdc::Options::FVAR_LINEAR_ALL) {
        std::vector<Index> const verts = findVertices(mesh, seams);
        ParallelForRange(
            Index(verts.size()), [&] { return VertexValues(mesh, faceValues, interpolation); },
            [&](VertexValues &values, Index begin, Index end) {
                for (Index i = begin; i < end; ++i) {
                    values.SetSharpness(verts[std::size_t(i)], sharpness);
                }
            });
    }
    return sharpness;
}

} // namespace OpenSubdivHex::FarExt::internal

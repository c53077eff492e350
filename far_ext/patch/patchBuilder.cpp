// SPDX-License-Identifier: Apache-2.0
#include "patchBuilder.h"

#include "cellFrames.h"
#include "gregoryMask.h"
#include "limitStencils.h"

#include "far_ext/limit/limitMask.h"
#include "far_ext/limit/rowSteps.h"
#include "far_ext/vtr/baseCoords.h"
#include "far_ext/vtr/parallel.h"
#include "far_ext/vtr/pi.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <optional>
#include <string>
#include <tuple>
#include <unordered_map>

namespace OpenSubdivHex::FarExt::internal {

using Far::Index;
using Sdc::Crease;

namespace {

// The masks that patches have in common, each once.
class MaskCache {
public:
    // Key of a mask.
    class Key {
    public:
        Key &operator<<(double number) {
            char bytes[sizeof number];
            std::memcpy(bytes, &number, sizeof number);
            _bytes.append(bytes, sizeof number);
            return *this;
        }

    private:
        friend class MaskCache;
        std::string _bytes;
    };

    template <typename MAKE>
    GregoryMask const *Find(Key const &key, MAKE const &make) {
        auto const added = _masks.try_emplace(key._bytes);
        if (added.second) {
            make(added.first->second);
        }
        return &added.first->second; // elements stay where they are
    }

private:
    std::unordered_map<std::string, GregoryMask> _masks;
};

// Points of one curve, or of one side of a face with kites: a mask of some rows.
struct PointGroup {
    Index rows[GregoryMask::kNumRows]; // INDEX_INVALID behind the last
    GregoryMask const *mask;
};

} // namespace

/// \brief The patches of one level: which limits they are made of, and which points they have.
class PatchBuilder::LevelBuilder {
public:
    /// \param coarser  that of the level before, if it has patches
    LevelBuilder(PatchBuilder &builder, int level, LevelBuilder const *coarser)
        : _builder(builder), _coarser(coarser), _cells(builder._cells), _depth(level),
          _surfaceDepth(builder._schemeOptions.GetSurfaceLevel()),
          _mesh(builder._hierarchy.GetMesh(builder._channel)),
          _level(_mesh.levels[std::size_t(level)]), _toChild(_mesh.refinements[std::size_t(level)]),
          _toLimit(GetStepsToLimit(builder._schemeOptions)),
          _rows(_level, builder._sdcOptions, builder._schemeOptions),
          _faceMasks(_level, builder._sdcOptions, _toLimit),
          _childFaceMasks(*_toChild.child, builder._sdcOptions, _toLimit),
          _rules(GetRules(_level, builder._schemeOptions, Interpolation::Vertex)) {
        if (builder._maskFinder) {
            _rows.SetMaskFinder(*builder._maskFinder);
        }
    }

    /// Finds the limits at the corners of cells.
    CallStatus FindLimits();
    /// Finds where cells meet those of the level before, which has found its limits.
    CallStatus FindBorders();
    /// The vertices at corners of cells, ascending.
    std::vector<Index> const &GetVertices() const { return _verts; }
    /// Numbers the points of curves from \p firstPoint on; returns the end.
    Index AddPoints(Index firstPoint);
    /// Makes the stencils of the limits.
    CallStatus FormStencils();
    /// Adds the points of all patches.
    void AddPatches(std::vector<Index> const &pointOfVertex, std::vector<Index> &points) const;

    /// The group of each vertex point, or of number GetVertices().size() and more the others.
    PointGroup const &GetGroup(std::size_t i) const { return _groups[i]; }
    std::size_t GetNumGroups() const { return _groups.size(); }
    LimitStencils const &GetStencils() const { return _stencils; }
    Index FindRow(CornerFrame const &frame) const {
        return isOfVertex(frame) ? _rowOfVertex[std::size_t(frame.vert)] : findFurtherRow(frame);
    }

private:
    // An edge or a diagonal.
    struct CurvePoints {
        Index points[2] = {Far::INDEX_INVALID, Far::INDEX_INVALID}; // beside its two vertices
        // Points of the patch on each side, in the order of the side.
        Index inner[2] = {Far::INDEX_INVALID, Far::INDEX_INVALID};
        // For sides of faces with kites: the five points of the halves, and the side in whose order they are.
        Index halves = Far::INDEX_INVALID;
        int sideOfHalves = 0;
        Index rowOfM = Far::INDEX_INVALID; // of side 0, or of both if it is not sharp
        Index secondRowOfM = Far::INDEX_INVALID;
    };
    // Sources of the middle of a curve, or of the centre of a cell.
    struct CenterRow {
        enum Kind { kEdge, kEdgeSide, kDiagonal, kDiagonalSide, kCenter, kHalfCenter } kind;
        Index index; // of a half cell in _halfCenters
        int side;
    };
    // The centre of a half cell in terms of other rows: those of its long side, and those of what lies across.
    struct HalfCenterRows {
        Index rows[2][3]; // INDEX_INVALID behind the last
        HalfCenter center;
    };
    // A diagonal that is an edge of the level before, where that has a cell on its other side: the curve is
    // as it is there.
    struct Border {
        Index edge;
        CurveShape shape; // from the first vertex of the edge, in terms of the limits of this level
    };
    // A direction at a vertex.
    struct Direction {
        Index vert;
        int side;
        double angle;
    };
    // A side of a cell: one side of an edge or a diagonal.
    struct CellSide {
        bool isDiagonal;
        Index index; // of the edge, or of the face
        int side;
    };
    // A curve as the cell on one of its sides has it.
    struct CellCurve {
        CurveShape shape;
        CurveNeighbor neighbors[2];
        Index rows[2];
    };

    int getSize(Index face) const { return _level.GetFaceSize(face); }
    bool isCell(Index face, int half) const { return _cells.HasCell(_depth, face, half); }
    FaceCells getCells(Index face) const { return FindFaceCells(_level, face); }
    int getNumCorners(PatchCell const &cell) const {
        return getCells(cell.face).GetNumCorners(cell.half);
    }
    bool hasKites(PatchCell const &cell) const { return getCells(cell.face).HasKites(cell.half); }
    // Sides of the polygon that a half cell is half of, or of another cell.
    int getNumSidesOfPolygon(PatchCell const &cell) const {
        int const numCorners = getNumCorners(cell);
        return getCells(cell.face).AreHalves() ? 2 * (numCorners - 1) : numCorners;
    }
    // The place in the face of a cell's corner.
    int getLocal(Index face, int half, int corner) const {
        FaceCells const cells = getCells(face);
        int const numCorners = cells.GetNumCorners(half);
        return cells.GetLocal(half, (corner + numCorners) % numCorners);
    }
    CellSide getCellSide(Index face, int half, int side) const;
    // The cell on a side of an edge or diagonal, and which of its sides that is.
    PatchCell getCell(CellSide const &curve, int *side) const;
    bool hasSide(CellSide const &curve) const {
        return curve.isDiagonal || _level.edgeFaces[curve.index][curve.side] >= 0;
    }
    bool isSharp(CellSide const &curve) const {
        return curve.isDiagonal ? Crease::IsInfinite(_level.GetDiagonalSharpness(curve.index))
                                : _level.IsBoundary(curve.index) ||
                                      Crease::IsInfinite(_level.GetEdgeSharpness(curve.index));
    }
    CornerFrame getFrame(Index face, int half, int corner) const {
        return _frames->Get(face, getLocal(face, half, corner), half);
    }
    double getLength(Index face, int half, int side, int end) const;
    int getSteps() const { return _builder._ages ? _builder._ages->steps : _depth - _surfaceDepth; }
    int findAge(Index vert) const;
    std::uint8_t findVertexCode(Index vert) const;
    bool findBesideOther(Index vert) const;
    std::uint8_t getVertexCode(Index vert) const { return _codes[std::size_t(vert)].code; }
    bool isBesideOther(Index vert) const { return _codes[std::size_t(vert)].isBesideOther; }
    // By PatchSite::surfaceFace.
    std::uint8_t getSurfaceFace(Index face, int half) const {
        return _surfaceFaces[2 * std::size_t(face) + std::size_t(half)];
    }
    std::uint8_t getSurfaceFace(CellSide curve) const;
    PatchSite getSite(PatchQuantity quantity, CellSide const &curve, Index vert, Index other) const;
    void addShares(Index vert, LimitStencils::KeptRow &kept) const;
    CellCurve getCellCurve(PatchCell cell, int side) const;
    SpokeShape getSpoke(PatchCell const &cell) const;
    Border const *findBorder(Index face) const {
        auto const found = _borders.find(face);
        return found != _borders.end() ? &found->second : nullptr;
    }
    CallStatus formDirections(std::vector<Direction> const &directions,
                              std::vector<std::vector<std::pair<Index, double>>> &result) const;
    static void addToKey(CellCurve const &curve, MaskCache::Key &key) {
        key << curve.shape.blend << curve.shape.unit;
        for (int end = 0; end < 2; ++end) {
            key << curve.shape.ends[end].unit << curve.shape.ends[end].angle
                << curve.shape.ends[end].length << curve.neighbors[end].angle
                << curve.neighbors[end].length;
        }
    }
    CurvePoints &getPoints(CellSide const &curve) {
        return (curve.isDiagonal ? _diagonals : _edges)[std::size_t(curve.index)];
    }
    CurvePoints const &getPoints(CellSide const &curve) const {
        return (curve.isDiagonal ? _diagonals : _edges)[std::size_t(curve.index)];
    }
    static bool isOfVertex(CornerFrame const &frame) {
        return frame.side == 0 && frame.sideOfEnd < 0;
    }
    static bool isBefore(CornerFrame const &a, CornerFrame const &b) {
        return std::tie(a.vert, a.side, a.sideOfEnd) < std::tie(b.vert, b.side, b.sideOfEnd);
    }
    Index findFurtherRow(CornerFrame const &frame) const;
    void addTurned(CornerFrame const &frame, LimitRow const &row,
                   LimitStencils::KeptRow &kept) const;
    Index addCenterRow(CenterRow const &row) {
        _centerRows.push_back(row);
        return Index(_numVertexRows + Index(_centerRows.size()) - 1);
    }
    Index addGroup(PointGroup const &group);
    void addCurve(bool isDiagonal, Index index);
    // Whether the next level has a cell on the other side of an edge.
    bool hasFinerCell(CellSide const &curve) const {
        Index const cFace =
            curve.isDiagonal ? Far::INDEX_INVALID : _toChild.GetEdgeChildFace(curve.index);
        return cFace != Far::INDEX_INVALID && HasHalves(_toChild.child->GetFaceSize(cFace)) &&
               _cells.HasCell(_depth + 1, cFace, 1 - curve.side);
    }
    void addSides(CellSide const *sides, int numSides, bool isShared, CurvePoints &points);
    void addKites(PatchCell const &cell);
    Index addHalfCenter(PatchCell const &cell);
    // The row of the derivative across the middle of a curve, on one side of it.
    Index getRowOfM(CellSide const &curve) const {
        CurvePoints const &points = getPoints(curve);
        return curve.side == 0 ? points.rowOfM : points.secondRowOfM;
    }
    // -1 where that is the derivative away from the cell.
    double getSignOfM(CellSide const &curve) const {
        return !isSharp(curve) && curve.side == 1 ? -1 : 1;
    }
    LimitRow getRow(Index number, LimitStencils::KeptRow &kept) const;
    void addAcross(std::vector<Index> const &verts, double factor, bool isOfChild,
                   LimitStencils::KeptRow &kept) const;
    void addOfChild(Index cVert, double du, LimitStencils::KeptRow &kept) const;

    PatchBuilder &_builder;
    LevelBuilder const *const _coarser;
    PatchCells const &_cells;
    int const _depth;
    int const _surfaceDepth;
    MeshLevels const &_mesh;
    Level const &_level;
    Refinement const &_toChild;
    HexSchemeOptions const _toLimit;
    LimitRows _rows;
    FaceLimitMaskFinder const _faceMasks;
    FaceLimitMaskFinder const _childFaceMasks;
    std::shared_ptr<RefinementRules const> const _rules;
    std::optional<CellFrames> _frames;

    std::vector<Index> _verts;
    // Arguments of constants, by vertex.
    struct VertexCode {
        std::uint8_t code;
        bool isBesideOther;
    };
    std::vector<VertexCode> _codes;
    std::vector<std::uint8_t> _surfaceFaces; // by face and half
    std::vector<Index> _rowOfVertex;
    // Ascending.  Corners of a side have one row, but for the last one of a wide corner.
    std::vector<CornerFrame> _furtherRows;
    Index _numVertexRows = 0;
    std::vector<CenterRow> _centerRows;
    std::vector<HalfCenterRows> _halfCenters;

    std::unordered_map<Index, Border> _borders; // by face
    std::vector<CurvePoints> _edges;
    std::vector<CurvePoints> _diagonals; // by face
    std::vector<Index> _centers;         // of kites, by face and half
    std::vector<PointGroup> _groups;
    MaskCache _masks;
    Index _numPoints = 0;
    LimitStencils _stencils;
};

CallStatus PatchBuilder::LevelBuilder::FindLimits() {
    std::vector<unsigned char> marks(std::size_t(_level.numVertices), 0);
    for (PatchCell const &cell : _cells.GetCells(_depth)) {
        for (int corner = 0; corner < getNumCorners(cell); ++corner) {
            int const local = getLocal(cell.face, cell.half, corner);
            marks[std::size_t(_level.GetFaceVertices(cell.face)[local])] = 1;
        }
    }
    _verts = ParallelSelect(_level.numVertices,
                            [&](Index vert) { return marks[std::size_t(vert)] != 0; });
    if (CallStatus result = _rows.Find(_verts); !result.IsOk()) {
        return result;
    }
    _codes.resize(std::size_t(_level.numVertices));
    ParallelFor(Index(_verts.size()), [&](Index i) {
        Index const vert = _verts[std::size_t(i)];
        _codes[std::size_t(vert)] = {findVertexCode(vert), findBesideOther(vert)};
    });
    _surfaceFaces.assign(2 * std::size_t(_level.numFaces), 0);
    if (_depth > _surfaceDepth) {
        SurfaceFaces const faces(_mesh.levels[std::size_t(_surfaceDepth)]);
        ParallelFor(2 * _level.numFaces, [&](Index i) {
            Index const face = FindBaseFace(_mesh, _surfaceDepth, _depth, {i / 2, i % 2});
            _surfaceFaces[std::size_t(i)] =
                std::uint8_t(std::min(faces.GetShape(face).size, PatchSite::kMaxSurfaceFaceSize));
        });
    }
    _frames.emplace(_level, _rows, _verts);
    _rowOfVertex.assign(std::size_t(_level.numVertices), Far::INDEX_INVALID);
    for (Index vert : _verts) {
        _rowOfVertex[std::size_t(vert)] = _numVertexRows++;
    }
    for (PatchCell const &cell : _cells.GetCells(_depth)) {
        for (int corner = 0; corner < getNumCorners(cell); ++corner) {
            CornerFrame const frame = getFrame(cell.face, cell.half, corner);
            if (!isOfVertex(frame)) {
                _furtherRows.push_back(frame);
            }
        }
    }
    std::sort(_furtherRows.begin(), _furtherRows.end(), isBefore);
    _furtherRows.erase(std::unique(_furtherRows.begin(), _furtherRows.end(),
                                   [](CornerFrame const &a, CornerFrame const &b) {
                                       return !isBefore(a, b) && !isBefore(b, a);
                                   }),
                       _furtherRows.end());
    _numVertexRows += Index(_furtherRows.size());
    return CallStatus();
}

Index PatchBuilder::LevelBuilder::findFurtherRow(CornerFrame const &frame) const {
    auto const found = std::lower_bound(_furtherRows.begin(), _furtherRows.end(), frame, isBefore);
    return Index(_verts.size()) + Index(found - _furtherRows.begin());
}

auto PatchBuilder::LevelBuilder::getCellSide(Index face, int half, int side) const -> CellSide {
    FaceCells const cells = getCells(face);
    if (cells.IsCut() && side == 0) {
        return {true, face, half};
    }
    int const local = getLocal(face, half, side);
    Index const edge = _level.faceEdges[_level.faceFirstCorner[face] + local];
    bool const isFirst =
        _level.edgeFaces[edge][0] == face && _level.edgeFaceLocals[edge][0] == local;
    return {false, edge, isFirst ? 0 : 1};
}

PatchCell PatchBuilder::LevelBuilder::getCell(CellSide const &curve, int *side) const {
    if (curve.isDiagonal) {
        *side = 0;
        return {curve.index, curve.side};
    }
    Index const face = _level.edgeFaces[curve.index][curve.side];
    int const local = _level.edgeFaceLocals[curve.index][curve.side];
    FaceCells const cells = getCells(face);
    *side = cells.GetSideOfEdge(local);
    return {face, cells.GetHalfOfEdge(local)};
}

// How long the derivative of a cell's side is at its start or end.
double PatchBuilder::LevelBuilder::getLength(Index face, int half, int side, int end) const {
    int const numCorners = getNumCorners({face, half});
    side = (side + numCorners) % numCorners;
    Index const vert = _level.GetFaceVertices(face)[getLocal(face, half, side + end)];
    CellSide const curve = getCellSide(face, half, side);
    if (Border const *const border = curve.isDiagonal ? findBorder(face) : nullptr) {
        // From its start half 1 runs against the edge.
        return border->shape.ends[half == 0 ? end : 1 - end].length;
    }
    bool const isLong = curve.isDiagonal || _level.IsSharpBoundaryB(curve.index);
    Index const other = _level.GetFaceVertices(face)[getLocal(face, half, side + 1 - end)];
    return (isLong ? 2 : 1) *
           _builder._constants.Get(getSite(PatchQuantity::Length, curve, vert, other));
}

// Steps since a vertex was made; -1: it is one of the surface level.
int PatchBuilder::LevelBuilder::findAge(Index vert) const {
    if (_builder._ages) {
        return _builder._ages->ofVertices[std::size_t(vert)];
    }
    int depth = _surfaceDepth;
    while (vert >= _mesh.levels[std::size_t(depth)].numVertices) {
        ++depth;
    }
    return depth == _surfaceDepth ? -1 : _depth - depth;
}

std::uint8_t PatchBuilder::LevelBuilder::findVertexCode(Index vert) const {
    if (_level.FindSharpVertex(vert)) {
        return PatchSite::kSharp;
    }
    int const age = findAge(vert);
    return age < 0 ? std::uint8_t(PatchSite::kBase +
                                  std::min(_level.GetNumVertexFaces(vert), PatchSite::kMaxFaces))
                   : std::uint8_t(std::min(age, PatchSite::kMaxAge));
}

bool PatchBuilder::LevelBuilder::findBesideOther(Index vert) const {
    Far::ConstIndexArray const faces = _level.GetVertexFaces(vert);
    return std::any_of(faces.begin(), faces.end(), [this](Index face) {
        return _level.IsHalfFace(face) ? hasKites({face, 0}) : !HasHalves(getSize(face));
    });
}

std::uint8_t PatchBuilder::LevelBuilder::getSurfaceFace(CellSide curve) const {
    std::uint8_t result = PatchSite::kMaxSurfaceFaceSize;
    for (curve.side = 0; curve.side < 2; ++curve.side) {
        if (hasSide(curve)) {
            int ofCell = 0;
            PatchCell const cell = getCell(curve, &ofCell);
            result = std::min(result, getSurfaceFace(cell.face, cell.half));
        }
    }
    return result;
}

PatchSite PatchBuilder::LevelBuilder::getSite(PatchQuantity quantity, CellSide const &curve,
                                              Index vert, Index other) const {
    int const steps = getSteps();
    PatchSite site;
    site.quantity = quantity;
    site.steps = std::uint8_t(std::min(steps, PatchSite::kMaxSteps));
    site.vert = getVertexCode(vert);
    site.otherVert = getVertexCode(other);
    site.isBesideOther = isBesideOther(vert);
    site.isOtherBesideOther = isBesideOther(other);
    site.surfaceFace = getSurfaceFace(curve);
    if (curve.isDiagonal) {
        site.kind = PatchSite::kDiagonal;
        return site;
    }
    site.kind = _level.IsSharpBoundaryB(curve.index) ? PatchSite::kLongBoundary
                : isSharp(curve)                     ? PatchSite::kSharpEdge
                                                     : PatchSite::kEdge;
    // Behind the surface level faces are hexagons, and few quads and others.
    auto const getFaceSize = [&](int side) {
        Index const face = _level.edgeFaces[curve.index][side];
        if (face < 0) {
            return steps == 0 ? 0 : kHexagon;
        }
        int ofCell = 0;
        int const size = getNumSidesOfPolygon(getCell({false, curve.index, side}, &ofCell));
        return steps == 0                      ? std::min(size, PatchSite::kMaxFaceSize)
               : size == kHexagon || size == 4 ? size
                                               : 5;
    };
    int const sizes[2] = {getFaceSize(0), getFaceSize(1)};
    site.smallFace = std::uint8_t(std::min(sizes[0], sizes[1]));
    site.largeFace = std::uint8_t(std::max(sizes[0], sizes[1]));
    return site;
}

// In place of as much of the limit's derivatives, mean differences to neighbours: these, too, are derivatives
// of what is linear.
void PatchBuilder::LevelBuilder::addShares(Index vert, LimitStencils::KeptRow &kept) const {
    int const numFaces = _level.GetNumVertexFaces(vert);
    if (_level.FindSharpVertex(vert) || _frames->HasBeginning(vert)) {
        return;
    }
    Index const first = _level.vertFirstFace[vert];
    for (Index k = first; k < first + numFaces; ++k) {
        Index const edge = _level.faceEdges[_level.GetVertexCorner(k)];
        if (Crease::IsSharp(_level.GetEdgeSharpness(edge)) ||
            Crease::IsSharp(_level.GetDiagonalSharpness(_level.vertFaces[k]))) {
            return;
        }
    }
    PatchSite site;
    site.quantity = PatchQuantity::EdgeShare;
    site.steps = std::uint8_t(std::min(getSteps(), PatchSite::kMaxSteps));
    site.kind = PatchSite::kVertex;
    site.vert = getVertexCode(vert);
    site.isBesideOther = isBesideOther(vert);
    site.surfaceFace = PatchSite::kMaxSurfaceFaceSize;
    for (Index const face : _level.GetVertexFaces(vert)) {
        for (int half = 0; half < 2; ++half) {
            site.surfaceFace = std::min(site.surfaceFace, getSurfaceFace(face, half));
        }
    }
    double const ofEdges = _builder._constants.Get(site);
    site.quantity = PatchQuantity::DiagonalShare;
    double const ofDiagonals = site.isBesideOther ? 0 : _builder._constants.Get(site);
    if (ofEdges == 0 && ofDiagonals == 0) {
        return;
    }
    for (int sum : {1, 2}) {
        for (double &weight : kept.weights[sum]) {
            weight *= 1 - ofEdges - ofDiagonals;
        }
    }
    auto const add = [&](Index neighbor, double angle, double share) {
        double const du = share * std::cos(angle);
        double const dv = share * std::sin(angle);
        kept.Add(neighbor, 0, du, dv);
        kept.Add(vert, 0, -du, -dv);
    };
    for (int i = 0; i < numFaces; ++i) {
        Index const face = _level.vertFaces[first + i];
        int const local = _level.vertFaceLocals[first + i];
        int const size = getSize(face);
        double const angle = _frames->GetEdgeAngle(vert, i);
        auto const getNeighbor = [&](int step) {
            return _level.GetFaceVertices(face)[(local + step) % size];
        };
        add(getNeighbor(1), angle, 2 * ofEdges / numFaces);
        if (ofDiagonals != 0) {
            // Twice as far away.
            add(getNeighbor(kDiagonalEnd), angle + kPi / numFaces, ofDiagonals / numFaces);
        }
    }
}

auto PatchBuilder::LevelBuilder::getCellCurve(PatchCell cell, int side) const -> CellCurve {
    CellCurve result;
    Index verts[2];
    for (int end = 0; end < 2; ++end) {
        CornerFrame const frame = getFrame(cell.face, cell.half, side + end);
        verts[end] = frame.vert;
        result.rows[end] = FindRow(frame);
        result.shape.ends[end] = {end == 0 ? frame.begin : frame.end,
                                  getLength(cell.face, cell.half, side, end)};
        // The side before its end, and the side behind its start.
        result.neighbors[end] = {
            frame.end - frame.begin,
            getLength(cell.face, cell.half, side + (end == 0 ? -1 : 1), 1 - end)};
    }
    if (Border const *const border =
            getCells(cell.face).IsCut() && side == 0 ? findBorder(cell.face) : nullptr) {
        for (int end = 0; end < 2; ++end) {
            result.shape.ends[end].unit = border->shape.ends[cell.half == 0 ? end : 1 - end].unit;
        }
        result.shape.blend = border->shape.blend;
        result.shape.unit = border->shape.unit;
        return result;
    }
    // Equal for both sides: the older vertex comes first.
    result.shape.blend = _builder._constants.Get(
        getSite(PatchQuantity::Blend, getCellSide(cell.face, cell.half, side),
                std::min(verts[0], verts[1]), std::max(verts[0], verts[1])));
    return result;
}

// Weights of control vertices for the derivatives in some directions.
CallStatus PatchBuilder::LevelBuilder::formDirections(
    std::vector<Direction> const &directions,
    std::vector<std::vector<std::pair<Index, double>>> &result) const {
    LimitStencils stencils;
    CallStatus status =
        stencils.Form(_builder._hierarchy, _builder._channel, _builder._schemeOptions, _depth,
                      Index(directions.size()), [&](Index number, LimitStencils::KeptRow &kept) {
                          Direction const &direction = directions[std::size_t(number)];
                          Index sources[PlainNeighborhoodGatherer::kNumRegular];
                          LimitRow const row =
                              _rows.GetRow(direction.vert, direction.side, sources);
                          kept.Clear();
                          for (int i = 0; i < row.size; ++i) {
                              kept.Add(row.sources[i], 0,
                                       std::cos(direction.angle) * row.du[i] +
                                           std::sin(direction.angle) * row.dv[i],
                                       0);
                          }
                          return kept.Get();
                      });
    for (std::size_t i = 0; i < directions.size() && status.IsOk(); ++i) {
        LimitStencils::Stencil const stencil = stencils.Get(Index(i));
        result.emplace_back();
        for (int k = 0; k < stencil.size; ++k) {
            result.back().emplace_back(stencil.indices[k], stencil.weights[1][k]);
        }
    }
    return status;
}

SpokeShape PatchBuilder::LevelBuilder::getSpoke(PatchCell const &cell) const {
    PatchSite site;
    site.steps = std::uint8_t(std::min(_depth - _surfaceDepth, PatchSite::kMaxSteps));
    site.kind = PatchSite::kSpoke;
    site.smallFace = std::uint8_t(std::min(getNumSidesOfPolygon(cell), PatchSite::kMaxFaceSize));
    SpokeShape spoke{};
    std::uint8_t const ends[2] = {PatchSite::kMiddle, PatchSite::kCenter};
    for (int end = 0; end < 2; ++end) {
        site.vert = ends[end];
        spoke.lengths[end] = _builder._constants.Get(site);
    }
    site.quantity = PatchQuantity::Blend;
    site.vert = 0;
    spoke.blend = _builder._constants.Get(site);
    return spoke;
}

CallStatus PatchBuilder::LevelBuilder::FindBorders() {
    if (!_coarser) {
        return CallStatus();
    }
    Refinement const &fromParent = _mesh.refinements[std::size_t(_depth) - 1];
    std::vector<Direction> directions;
    std::vector<Direction> coarseDirections;
    std::vector<Index> faces;
    for (PatchCell const &cell : _cells.GetCells(_depth)) {
        if (cell.face < _level.numFFaces || !HasHalves(getSize(cell.face)) ||
            isCell(cell.face, 1 - cell.half)) {
            continue;
        }
        CellSide const beyond = {false, fromParent.GetEFaceParent(cell.face), 1 - cell.half};
        int sideBeyond = 0;
        PatchCell const cellBeyond = _coarser->getCell(beyond, &sideBeyond);
        if (!_coarser->isCell(cellBeyond.face, cellBeyond.half)) {
            continue; // a hole
        }
        CellCurve const coarse = _coarser->getCellCurve(cellBeyond, sideBeyond);
        Border border = {beyond.index, coarse.shape};
        for (int end = 0; end < 2; ++end) {
            // Both run from the first vertex of the edge, or back: half 0 and side 0 do.
            int const ofOwn = cell.half == 0 ? end : 1 - end;
            int const ofCoarse = beyond.side == 0 ? end : 1 - end;
            border.shape.ends[end] = coarse.shape.ends[ofCoarse];
            auto const getDirection = [&](LevelBuilder const &level, PatchCell of, int side,
                                          int atEnd) {
                CornerFrame const frame = level.getFrame(of.face, of.half, side + atEnd);
                if (atEnd == 1 && frame.sideOfEnd >= 0) {
                    return Direction{frame.vert, frame.sideOfEnd, 0};
                }
                return Direction{frame.vert, frame.side, atEnd == 0 ? frame.begin : frame.end};
            };
            directions.push_back(getDirection(*this, cell, 0, ofOwn));
            coarseDirections.push_back(getDirection(*_coarser, cellBeyond, sideBeyond, ofCoarse));
        }
        faces.push_back(cell.face);
        _borders.emplace(cell.face, border);
    }
    std::vector<std::vector<std::pair<Index, double>>> weights;
    std::vector<std::vector<std::pair<Index, double>>> coarseWeights;
    CallStatus status = formDirections(directions, weights);
    if (status.IsOk()) {
        status = _coarser->formDirections(coarseDirections, coarseWeights);
    }
    for (std::size_t i = 0; i < faces.size() && status.IsOk(); ++i) {
        Border &border = _borders.at(faces[i]);
        bool const isSharp = _coarser->isSharp({false, border.edge, 0});
        for (std::size_t end = 0; end < 2; ++end) {
            // How many times as long the derivative is in terms of the level before.
            auto const &fine = weights[2 * i + end];
            double product = 0;
            double square = 0;
            auto coarse = coarseWeights[2 * i + end].begin();
            auto const last = coarseWeights[2 * i + end].end();
            for (auto const &weight : fine) {
                while (coarse != last && coarse->first < weight.first) {
                    ++coarse;
                }
                product += coarse != last && coarse->first == weight.first
                               ? weight.second * coarse->second
                               : 0;
                square += weight.second * weight.second;
            }
            double const ratio = square > 0 ? product / square : 2;
            border.shape.ends[end].length *= ratio;
            border.shape.ends[end].unit = isSharp ? 1 : ratio;
        }
        // The middle is the same limit, of a level on which lengths are half.
        border.shape.unit = isSharp ? 1 : 2;
    }
    return status;
}

Index PatchBuilder::LevelBuilder::addGroup(PointGroup const &group) {
    Index const first = _numPoints;
    _groups.push_back(group);
    _numPoints += Index(group.mask->points.size());
    return first;
}

Index PatchBuilder::LevelBuilder::AddPoints(Index firstPoint) {
    _numPoints = firstPoint;
    _edges.resize(std::size_t(_level.numEdges));
    _diagonals.resize(std::size_t(_level.numFaces));
    _centers.assign(2 * std::size_t(_level.numFaces), Far::INDEX_INVALID);
    for (Index edge = 0; edge < _level.numEdges; ++edge) {
        addCurve(false, edge);
    }
    for (Index face = 0; face < _level.numFaces; ++face) {
        if (getCells(face).IsCut()) {
            addCurve(true, face);
        }
    }
    for (PatchCell const &cell : _cells.GetCells(_depth)) {
        if (hasKites(cell)) {
            addKites(cell);
        }
    }
    return _numPoints;
}

void PatchBuilder::LevelBuilder::addCurve(bool isDiagonal, Index index) {
    // The sides where there are patches.
    CellSide sides[2];
    int numSides = 0;
    for (int side = 0; side < 2; ++side) {
        CellSide const curve = {isDiagonal, index, side};
        int ofCell = 0;
        if (hasSide(curve)) {
            PatchCell const cell = getCell(curve, &ofCell);
            if (isCell(cell.face, cell.half)) {
                sides[numSides++] = curve;
            }
        }
    }
    if (numSides == 0) {
        return;
    }
    CurvePoints &points = getPoints(sides[0]);
    if (Border const *const border = isDiagonal ? findBorder(index) : nullptr) {
        CurvePoints const &ofEdge = _coarser->_edges[std::size_t(border->edge)];
        std::copy_n(ofEdge.points, 2, points.points);
    }
    bool const isShared = !isSharp(sides[0]);
    if (isShared) {
        points.rowOfM = points.secondRowOfM =
            addCenterRow({isDiagonal ? CenterRow::kDiagonal : CenterRow::kEdge, index, 0});
        addSides(sides, numSides, true, points);
        return;
    }
    for (int i = 0; i < numSides; ++i) {
        (sides[i].side == 0 ? points.rowOfM : points.secondRowOfM) = addCenterRow(
            {isDiagonal ? CenterRow::kDiagonalSide : CenterRow::kEdgeSide, index, sides[i].side});
        addSides(sides + i, 1, false, points);
    }
}

// The points of one curve for patches on some of its sides, which have the same tangent planes.
void PatchBuilder::LevelBuilder::addSides(CellSide const *sides, int numSides, bool isShared,
                                          CurvePoints &points) {
    MaskCache::Key key;
    bool needsPoints = false;
    struct Side {
        CellCurve curve;
        int side;
        bool hasInner;
    } found[2];
    int numFound = 0;
    for (int i = 0; i < numSides; ++i) {
        int ofCell = 0;
        PatchCell const cell = getCell(sides[i], &ofCell);
        if (!hasKites(cell)) {
            found[numFound++] = {getCellCurve(cell, ofCell), sides[i].side, true};
            needsPoints = needsPoints || points.points[0] == Far::INDEX_INVALID;
        } else if (numSides == 1 && hasFinerCell(sides[i])) {
            found[numFound++] = {getCellCurve(cell, ofCell), sides[i].side, false};
            needsPoints = true;
        }
    }
    if (numFound == 0) {
        return;
    }
    // In the order of the first one of the sides.
    CellCurve const &first = found[0].curve;
    double const signs[2] = {isShared && found[0].side == 1 ? -1.0 : 1.0,
                             isShared && found[0].side == 0 ? -1.0 : 1.0};
    key << needsPoints << numFound << signs[0] << found[0].hasInner;
    for (int i = 0; i < numFound; ++i) {
        addToKey(found[i].curve, key);
    }
    GregoryMask const *const known = _masks.Find(key, [&](GregoryMask &made) {
        if (needsPoints) {
            AddCurvePoints(first.shape, made);
        }
        for (int i = 0; i < numFound; ++i) {
            if (!found[i].hasInner) {
                continue;
            }
            AddInnerPoints(found[i].curve.shape, found[i].curve.neighbors, signs[i], i > 0, made);
        }
    });
    Index next =
        addGroup({{first.rows[0], first.rows[1],
                   found[0].side == 0 ? points.rowOfM : points.secondRowOfM, Far::INDEX_INVALID},
                  known});
    if (needsPoints) {
        points.points[found[0].side] = next++;
        points.points[1 - found[0].side] = next++;
    }
    for (int i = 0; i < numFound; ++i) {
        if (found[i].hasInner) {
            points.inner[found[i].side] = next;
            next += 2;
        }
    }
}

void PatchBuilder::LevelBuilder::addKites(PatchCell const &cell) {
    int const size = getNumCorners(cell);
    bool const isHalf = getCells(cell.face).AreHalves();
    Index const rowOfCenter =
        isHalf ? addHalfCenter(cell) : addCenterRow({CenterRow::kCenter, cell.face, 0});
    SpokeShape const spoke = getSpoke(cell);
    for (int i = 0; i < size; ++i) {
        CellSide const side = getCellSide(cell.face, cell.half, i);
        CurvePoints &points = getPoints(side);
        CellCurve const curve = getCellCurve(cell, i);
        bool const hasHalves = points.halves != Far::INDEX_INVALID;
        double const sign = getSignOfM(side);
        MaskCache::Key key;
        key << size << isHalf << i << sign << hasHalves;
        addToKey(curve, key);
        GregoryMask const *const mask = _masks.Find(key, [&](GregoryMask &made) {
            KiteSide const ofKites = isHalf ? MakeHalfKiteSide(size, i) : MakeKiteSide(size, i);
            AddKitePoints(curve.shape, curve.neighbors, spoke, ofKites, sign, made);
            if (hasHalves) {
                made.points.erase(made.points.begin(), made.points.begin() + kNumHalfPoints);
            }
        });
        Index first =
            addGroup({{curve.rows[0], curve.rows[1], getRowOfM(side), rowOfCenter}, mask});
        if (!hasHalves) {
            points.halves = first;
            points.sideOfHalves = side.side;
            first += kNumHalfPoints;
        }
        points.inner[side.side] = first;
    }
    GregoryMask const *const center = _masks.Find(
        MaskCache::Key() << size, [](GregoryMask &made) { made.points.push_back({1}); });
    _centers[2 * std::size_t(cell.face) + std::size_t(cell.half)] = addGroup(
        {{rowOfCenter, Far::INDEX_INVALID, Far::INDEX_INVALID, Far::INDEX_INVALID}, center});
}

Index PatchBuilder::LevelBuilder::addHalfCenter(PatchCell const &cell) {
    int const size = getNumCorners(cell);
    auto const fillRows = [&](int side, CellCurve const &curve, Index *rows) {
        rows[0] = curve.rows[0];
        rows[1] = curve.rows[1];
        rows[2] = getRowOfM(getCellSide(cell.face, cell.half, side));
        return getSignOfM(getCellSide(cell.face, cell.half, side));
    };
    HalfCenterRows result;
    CellCurve const longSide = getCellCurve(cell, 0);
    double const sign = fillRows(0, longSide, result.rows[0]);
    if (size % 2 == 1) {
        CornerFrame const frame = getFrame(cell.face, cell.half, (size + 1) / 2);
        result.rows[1][0] = FindRow(frame);
        result.rows[1][1] = result.rows[1][2] = Far::INDEX_INVALID;
        result.center = MakeHalfCenter(size, longSide.shape, sign, (frame.begin + frame.end) / 2);
    } else {
        CellCurve const across = getCellCurve(cell, size / 2);
        double const signAcross = fillRows(size / 2, across, result.rows[1]);
        result.center = MakeHalfCenter(size, longSide.shape, sign, across.shape, signAcross);
    }
    _halfCenters.push_back(result);
    return addCenterRow({CenterRow::kHalfCenter, Index(_halfCenters.size()) - 1, 0});
}

void PatchBuilder::LevelBuilder::addOfChild(Index cVert, double du,
                                            LimitStencils::KeptRow &kept) const {
    ForEachParentWeight(_toChild, *_rules, cVert,
                        [&](Index vert, double weight) { kept.Add(vert, 0, du * weight, 0); });
}

// From the long side of half a regular polygon inwards, whose other sides are 1 long.
void PatchBuilder::LevelBuilder::addAcross(std::vector<Index> const &verts, double factor,
                                           bool isOfChild, LimitStencils::KeptRow &kept) const {
    std::vector<double> const weights = FindWeightsAcross(int(verts.size()));
    for (std::size_t i = 0; i < verts.size(); ++i) {
        double const du = factor * weights[i];
        if (isOfChild) {
            addOfChild(verts[i], du, kept);
        } else {
            kept.Add(verts[i], 0, du, 0);
        }
    }
}

// Du and dv by which the edge at the end of the frame is along its curve, and that at its begin where \p row has it.
void PatchBuilder::LevelBuilder::addTurned(CornerFrame const &frame, LimitRow const &row,
                                           LimitStencils::KeptRow &kept) const {
    double const begin[2] = {std::cos(frame.begin), std::sin(frame.begin)};
    double const end[2] = {std::cos(frame.end), std::sin(frame.end)};
    double const determinant = begin[0] * end[1] - begin[1] * end[0];
    for (int i = 0; i < row.size; ++i) {
        double const atBegin = (begin[0] * row.du[i] + begin[1] * row.dv[i]) / determinant;
        kept.Add(row.sources[i], row.weights[i], end[1] * atBegin, -end[0] * atBegin);
    }
    Index sources[PlainNeighborhoodGatherer::kNumRegular];
    LimitRow const ofCurve = _rows.GetRow(frame.vert, frame.sideOfEnd, sources);
    for (int i = 0; i < ofCurve.size; ++i) {
        double const atEnd = ofCurve.du[i] / determinant;
        kept.Add(ofCurve.sources[i], 0, -begin[1] * atEnd, begin[0] * atEnd);
    }
}

LimitRow PatchBuilder::LevelBuilder::getRow(Index number, LimitStencils::KeptRow &kept) const {
    kept.Clear();
    if (number < _numVertexRows) {
        bool const isFirst = number < Index(_verts.size());
        CornerFrame const vertex = isFirst ? CornerFrame{_verts[std::size_t(number)], 0, 0, 0}
                                           : _furtherRows[std::size_t(number) - _verts.size()];
        Index sources[PlainNeighborhoodGatherer::kNumRegular];
        LimitRow const row = _rows.GetRow(vertex.vert, vertex.side, sources);
        if (vertex.sideOfEnd >= 0) {
            addTurned(vertex, row, kept);
        } else {
            kept.Append(row);
        }
        if (isFirst && _builder._constants.HasShares() &&
            !_builder._isInSeveralLevels[std::size_t(vertex.vert)]) {
            addShares(vertex.vert, kept);
        }
        return kept.Get();
    }
    CenterRow const &row = _centerRows[std::size_t(number - _numVertexRows)];
    Level const &child = *_toChild.child;
    switch (row.kind) {
    case CenterRow::kEdge: {
        // On the next level edges are half as long, and the diagonal is the edge.
        Index const cFace = _toChild.GetEdgeChildFace(row.index);
        Far::ConstIndexArray const verts = child.GetFaceVertices(cFace);
        LimitMask const mask = _childFaceMasks.Find(cFace);
        for (int i = 0; i < verts.size(); ++i) {
            if (double const dv = mask.sides[0].dv[std::size_t(i)]; dv != 0) {
                addOfChild(verts[i], -2 * dv, kept);
            }
        }
        break;
    }
    case CenterRow::kEdgeSide: {
        if (_level.IsSharpBoundaryB(row.index)) {
            auto const ofFace = _level.GetFaceVertices(_level.edgeFaces[row.index][0]);
            addAcross({ofFace.begin(), ofFace.end()}, 1, false, kept);
            break;
        }
        Index const cFace = _toChild.GetEdgeChildFace(row.index);
        Far::ConstIndexArray const verts = child.GetFaceVertices(cFace);
        std::vector<Index> ofHalf(4);
        for (int i = 0; i < 4; ++i) {
            ofHalf[std::size_t(i)] =
                verts[HasHalves(verts.size()) ? kHexagonHalves[row.side][i] : i];
        }
        addAcross(ofHalf, 2, true, kept);
        break;
    }
    case CenterRow::kDiagonal: {
        Far::ConstIndexArray const verts = _level.GetFaceVertices(row.index);
        LimitMask const mask = _faceMasks.Find(row.index);
        for (int i = 0; i < verts.size(); ++i) {
            kept.Add(verts[i], 0, -mask.sides[0].dv[std::size_t(i)], 0);
        }
        break;
    }
    case CenterRow::kDiagonalSide: {
        Far::ConstIndexArray const verts = _level.GetFaceVertices(row.index);
        std::vector<Index> ofHalf;
        for (int i = 0; i < getNumCorners({row.index, row.side}); ++i) {
            ofHalf.push_back(verts[getLocal(row.index, row.side, i)]);
        }
        addAcross(ofHalf, 1, false, kept);
        break;
    }
    case CenterRow::kCenter: {
        Far::ConstIndexArray const verts = _level.GetFaceVertices(row.index);
        LimitMask const mask = _faceMasks.Find(row.index);
        for (int i = 0; i < verts.size(); ++i) {
            auto const k = std::size_t(i);
            kept.Add(verts[i], mask.weights[k], mask.sides[0].du[k], mask.sides[0].dv[k]);
        }
        break;
    }
    case CenterRow::kHalfCenter: {
        HalfCenterRows const &halfCenter = _halfCenters[std::size_t(row.index)];
        LimitStencils::KeptRow keptOfTerms;
        for (int group = 0; group < 2; ++group) {
            GregoryMask::Point const(&sums)[3] = halfCenter.center.sums[group];
            for (std::size_t k = 0; k < 3 && halfCenter.rows[group][k] != Far::INDEX_INVALID; ++k) {
                LimitRow const terms = getRow(halfCenter.rows[group][k], keptOfTerms);
                for (int i = 0; i < terms.size; ++i) {
                    auto const sum = [&](std::size_t j) {
                        return sums[j][3 * k] * terms.weights[i] +
                               sums[j][3 * k + 1] * terms.du[i] + sums[j][3 * k + 2] * terms.dv[i];
                    };
                    kept.Add(terms.sources[i], sum(0), sum(1), sum(2));
                }
            }
        }
        break;
    }
    }
    return kept.Get();
}

CallStatus PatchBuilder::LevelBuilder::FormStencils() {
    return _stencils.Form(
        _builder._hierarchy, _builder._channel, _builder._schemeOptions, _depth,
        _numVertexRows + Index(_centerRows.size()),
        [this](Index number, LimitStencils::KeptRow &kept) { return getRow(number, kept); });
}

void PatchBuilder::LevelBuilder::AddPatches(std::vector<Index> const &pointOfVertex,
                                            std::vector<Index> &points) const {
    auto const getVertexPoint = [&](Index face, int half, int corner) {
        Index const vert = _level.GetFaceVertices(face)[getLocal(face, half, corner)];
        return pointOfVertex[std::size_t(vert)];
    };
    // A side of a patch: points on it beside its start and end, then inner points there.
    auto const setSide = [](Index *patch, int side, Index const(&ofSide)[4]) {
        int const next = (side + 1) % 4;
        patch[5 * side + 1] = ofSide[0];
        patch[5 * next + 2] = ofSide[1];
        patch[5 * side + 3] = ofSide[2];
        patch[5 * next + 4] = ofSide[3];
    };
    for (PatchCell const &cell : _cells.GetCells(_depth)) {
        Index const face = cell.face;
        int const size = getNumCorners(cell);
        if (!hasKites(cell)) {
            std::size_t const first = points.size();
            points.resize(first + kNumPatchPoints);
            for (int side = 0; side < 4; ++side) {
                CellSide const curve = getCellSide(face, cell.half, side);
                CurvePoints const &ofCurve = getPoints(curve);
                Index const inner = ofCurve.inner[curve.side];
                points[first + 5 * std::size_t(side)] = getVertexPoint(face, cell.half, side);
                setSide(
                    points.data() + first, side,
                    {ofCurve.points[curve.side], ofCurve.points[1 - curve.side], inner, inner + 1});
            }
            continue;
        }
        for (int i = 0; i < size; ++i) {
            struct Side {
                Index halves[kNumHalfPoints];
                Index inner;
            } sides[2]; // that behind the corner, and that before it
            for (int k = 0; k < 2; ++k) {
                CellSide const curve =
                    getCellSide(face, cell.half, k == 0 ? i : (i + size - 1) % size);
                CurvePoints const &ofCurve = getPoints(curve);
                bool const isReverse = ofCurve.sideOfHalves != curve.side;
                for (int j = 0; j < kNumHalfPoints; ++j) {
                    sides[k].halves[j] = ofCurve.halves + (isReverse ? kNumHalfPoints - 1 - j : j);
                }
                sides[k].inner = ofCurve.inner[curve.side];
            }
            Index const *const behind = sides[0].halves;
            Index const *const before = sides[1].halves;
            Index const in = sides[0].inner;
            Index const inBefore = sides[1].inner;
            std::size_t const first = points.size();
            points.resize(first + kNumPatchPoints);
            Index *const patch = points.data() + first;
            patch[0] = getVertexPoint(face, cell.half, i);
            patch[5] = behind[2];
            patch[10] = _centers[2 * std::size_t(face) + std::size_t(cell.half)];
            patch[15] = before[2];
            setSide(patch, 0, {behind[0], behind[1], in, in + 1});
            setSide(patch, 1, {in + 4, in + 5, in + 6, in + 7});
            setSide(patch, 2, {inBefore + 5, inBefore + 4, inBefore + 9, inBefore + 8});
            setSide(patch, 3, {before[3], before[4], inBefore + 2, inBefore + 3});
        }
    }
}

PatchBuilder::PatchBuilder(Hierarchy const &hierarchy, int channel, Sdc::Options sdcOptions,
                           HexSchemeOptions const &schemeOptions, PatchCells const &cells,
                           PatchConstants constants)
    : _hierarchy(hierarchy), _channel(channel), _sdcOptions(sdcOptions),
      _schemeOptions(schemeOptions), _cells(cells), _constants(std::move(constants)) {}

PatchBuilder::~PatchBuilder() = default;

CallStatus PatchBuilder::Build() {
    for (int level = _cells.GetFirstLevel(); level <= _cells.GetLastLevel(); ++level) {
        LevelBuilder const *const coarser = _levels.empty() ? nullptr : _levels.back().get();
        _levels.push_back(std::make_unique<LevelBuilder>(*this, level, coarser));
        if (CallStatus result = _levels.back()->FindLimits(); !result.IsOk()) {
            return result;
        }
        if (CallStatus result = _levels.back()->FindBorders(); !result.IsOk()) {
            return result;
        }
    }
    MeshLevels const &mesh = _hierarchy.GetMesh(_channel);
    auto const numVertices =
        std::size_t(mesh.levels[std::size_t(_cells.GetLastLevel())].numVertices);
    std::vector<Index> pointOfVertex(numVertices, Far::INDEX_INVALID);
    _isInSeveralLevels.assign(numVertices, 0);
    for (auto const &level : _levels) {
        for (Index const vert : level->GetVertices()) {
            if (pointOfVertex[std::size_t(vert)] == Far::INDEX_INVALID) {
                pointOfVertex[std::size_t(vert)] = _numPoints++;
                _vertexPoints.push_back({level.get(), level->FindRow({vert, 0, 0, 0})});
            } else {
                _isInSeveralLevels[std::size_t(vert)] = 1;
            }
        }
    }
    for (auto const &level : _levels) {
        _numPoints = level->AddPoints(_numPoints);
    }
    _patchPoints.reserve(std::size_t(kNumPatchPoints * _cells.GetNumPatches()));
    for (auto const &level : _levels) {
        if (CallStatus result = level->FormStencils(); !result.IsOk()) {
            return result;
        }
        level->AddPatches(pointOfVertex, _patchPoints);
    }
    return CallStatus();
}

namespace {

// Sums rows by masks.
template <typename REAL>
class GroupSums {
public:
    void Add(LimitStencils const &stencils, PointGroup const &group, PointStencils<REAL> &result) {
        int numRows = 0;
        while (numRows < GregoryMask::kNumRows && group.rows[numRows] != Far::INDEX_INVALID) {
            _rows[numRows] = stencils.Get(group.rows[numRows]);
            ++numRows;
        }
        mergeColumns(numRows);
        spreadTerms(numRows);
        std::size_t const numColumns = _columns.size();
        for (GregoryMask::Point const &point : group.mask->points) {
            unsigned rows = 0;
            _sums.assign(numColumns, 0.0);
            for (int i = 0; i < 3 * numRows; ++i) {
                double const factor = point[std::size_t(i)];
                if (factor == 0) {
                    continue;
                }
                rows |= 1u << (i / 3);
                double const *const terms = _terms.data() + std::size_t(i) * numColumns;
                for (std::size_t k = 0; k < numColumns; ++k) {
                    _sums[k] += factor * terms[k];
                }
            }
            std::size_t const first = result.indices.size();
            result.indices.resize(first + numColumns);
            result.weights.resize(first + numColumns);
            std::size_t next = first;
            for (std::size_t k = 0; k < numColumns; ++k) {
                result.indices[next] = _columns[k].index;
                result.weights[next] = REAL(_sums[k]);
                next += (_columns[k].rows & rows) != 0 ? 1 : 0;
            }
            result.indices.resize(next);
            result.weights.resize(next);
            result.sizes.push_back(int(next - first));
        }
    }

private:
    struct Column {
        Index index;
        unsigned rows; // a bit for each that has it
    };

    // The indices that any row has, ascending.
    void mergeColumns(int numRows) {
        _columns.clear();
        int positions[GregoryMask::kNumRows] = {};
        for (;;) {
            Index least = std::numeric_limits<Index>::max();
            for (int row = 0; row < numRows; ++row) {
                if (positions[row] < _rows[row].size) {
                    least = std::min(least, _rows[row].indices[positions[row]]);
                }
            }
            if (least == std::numeric_limits<Index>::max()) {
                return;
            }
            Column column = {least, 0};
            for (int row = 0; row < numRows; ++row) {
                int &position = positions[row];
                if (position < _rows[row].size && _rows[row].indices[position] == least) {
                    column.rows |= 1u << row;
                    ++position;
                }
            }
            _columns.push_back(column);
        }
    }

    // The weights of all rows, by column.
    void spreadTerms(int numRows) {
        std::size_t const numColumns = _columns.size();
        _terms.assign(3 * std::size_t(numRows) * numColumns, 0.0);
        for (int row = 0; row < numRows; ++row) {
            int position = 0;
            double *const terms = _terms.data() + 3 * std::size_t(row) * numColumns;
            for (std::size_t k = 0; k < numColumns; ++k) {
                if ((_columns[k].rows >> row & 1) == 0) {
                    continue;
                }
                for (std::size_t sum = 0; sum < 3; ++sum) {
                    terms[sum * numColumns + k] = _rows[row].weights[sum][position];
                }
                ++position;
            }
        }
    }

    LimitStencils::Stencil _rows[GregoryMask::kNumRows];
    std::vector<Column> _columns;
    std::vector<double> _terms; // by row, by sum, by column
    std::vector<double> _sums;
};

} // namespace

template <typename REAL>
CallStatus PatchBuilder::MakeStencils(PointStencils<REAL> &stencils) const {
    // Groups of all levels, behind the vertices.
    std::vector<Index> firsts = {Index(_vertexPoints.size())};
    for (auto const &level : _levels) {
        firsts.push_back(firsts.back() + Index(level->GetNumGroups()));
    }
    GregoryMask vertexMask;
    vertexMask.points.push_back({1});
    constexpr Index kRange = 256;
    std::vector<PointStencils<REAL>> ranges(
        std::size_t(GetNumParallelRanges(firsts.back(), kRange)));
    ParallelForRange(
        firsts.back(), [] { return GroupSums<REAL>(); },
        [&](GroupSums<REAL> &sums, Index begin, Index end) {
            PointStencils<REAL> &range = ranges[std::size_t(begin / kRange)];
            std::size_t level = 0;
            for (Index i = begin; i < end; ++i) {
                if (i < firsts[0]) {
                    VertexPoint const &point = _vertexPoints[std::size_t(i)];
                    sums.Add(
                        point.level->GetStencils(),
                        {{point.row, Far::INDEX_INVALID, Far::INDEX_INVALID, Far::INDEX_INVALID},
                         &vertexMask},
                        range);
                    continue;
                }
                while (i >= firsts[level + 1]) {
                    ++level;
                }
                sums.Add(_levels[level]->GetStencils(),
                         _levels[level]->GetGroup(std::size_t(i - firsts[level])), range);
            }
        },
        kRange);
    std::vector<std::size_t> firstPoints = {0};
    std::vector<std::size_t> firstWeights = {0};
    for (PointStencils<REAL> const &range : ranges) {
        firstPoints.push_back(firstPoints.back() + range.sizes.size());
        firstWeights.push_back(firstWeights.back() + range.weights.size());
    }
    if (firstWeights.back() > std::size_t(std::numeric_limits<Index>::max())) {
        return CallStatus(StatusCode::TooLarge, ComponentType::Level, _cells.GetLastLevel(),
                          "the patch points of level " + std::to_string(_cells.GetLastLevel()) +
                              " would have " + std::to_string(firstWeights.back()) +
                              " weights, more than Far's 32-bit offsets reach");
    }
    ResizeLarge(stencils.sizes, firstPoints.back());
    ResizeLarge(stencils.indices, firstWeights.back());
    ResizeLarge(stencils.weights, firstWeights.back());
    ParallelForRange(
        Index(ranges.size()), [] { return Nothing(); },
        [&](Nothing, Index begin, Index end) {
            for (auto i = std::size_t(begin); i < std::size_t(end); ++i) {
                PointStencils<REAL> &range = ranges[i];
                std::copy(range.sizes.begin(), range.sizes.end(),
                          stencils.sizes.begin() + std::ptrdiff_t(firstPoints[i]));
                std::copy(range.indices.begin(), range.indices.end(),
                          stencils.indices.begin() + std::ptrdiff_t(firstWeights[i]));
                std::copy(range.weights.begin(), range.weights.end(),
                          stencils.weights.begin() + std::ptrdiff_t(firstWeights[i]));
                range = PointStencils<REAL>();
            }
        },
        1);
    return CallStatus();
}

template CallStatus PatchBuilder::MakeStencils(PointStencils<float> &) const;
template CallStatus PatchBuilder::MakeStencils(PointStencils<double> &) const;

} // namespace OpenSubdivHex::FarExt::internal

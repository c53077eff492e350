// SPDX-License-Identifier: Apache-2.0
#include "primvarRefiner.h"

#include "baseFaceMap.h"
#include "far_ext/limit/limitRows.h"
#include "far_ext/stencil/interpolationMode.h"
#include "far_ext/vtr/hierarchy.h"
#include "far_ext/vtr/parallel.h"
#include "far_ext/vtr/refinementRows.h"
#include "far_ext/vtr/report.h"

#include <algorithm>

namespace OpenSubdivHex::FarExt {

using Far::Index;
using internal::Cell;
using internal::Hierarchy;
using internal::Level;
using internal::Refinement;
using internal::RefinementRows;

/// The edge of half 1 of a hexagon that is parallel to the diagonal.
constexpr int kHalf1Edge = 1;

/// Where Rows are read from: the F-vertices face by face, then the V-vertices.
struct PrimvarRefinerBase::Rows::Reader {
    /// A vertex of the level before, and a point of the level itself.
    struct Source {
        Index index;
    };
    struct Point {
        void Clear() const { rows->_rows.push_back({point, 0, 0}); }
        void AddWithWeight(Source source, double weight) const {
            ++rows->_rows.back().numSources;
            Add(source.index, weight);
        }
        void AddWithWeight(Point other, double weight) const {
            ++rows->_rows.back().numPoints;
            Add(other.point, weight);
        }
        void Add(Index index, double weight) const {
            rows->_sources.push_back(index);
            rows->_weights.push_back(weight);
        }

        Rows *rows;
        Index point;
    };
    struct SourceOfVertex {
        Source operator[](Index vert) const { return {valueOfVertex ? valueOfVertex[vert] : vert}; }

        Index const *valueOfVertex; ///< null: vertices are their own sources
    };
    struct Points {
        Point operator[](Index point) const { return {rows, point}; }

        Rows *rows;
    };

    Reader(Hierarchy const &hierarchy, HexSchemeOptions schemeOptions, int level,
           Interpolation interpolation, int channel)
        : refinementRows(hierarchy.GetMesh(channel).refinements[std::size_t(level) - 1],
                         schemeOptions, interpolation),
          sources{channel >= 0 && level == 1
                      ? hierarchy.channels[std::size_t(channel)].valuesOfVertices.data()
                      : nullptr} {}

    RefinementRows const refinementRows;
    SourceOfVertex const sources;
    Index nextFace = 0;
    Index nextVVertex = 0;
};

PrimvarRefinerBase::Rows::Rows(TopologyRefiner const &refiner, int level, Data data, int channel)
    : _reader(std::make_unique<Reader>(refiner.GetHierarchy(), refiner.GetHexSchemeOptions(), level,
                                       data == Data::FaceVarying
                                           ? internal::GetChannelInterpolation(refiner, channel)
                                       : data == Data::Varying ? Interpolation::Varying
                                                               : Interpolation::Vertex,
                                       channel)) {}

PrimvarRefinerBase::Rows::~Rows() = default;

bool PrimvarRefinerBase::Rows::Next() {
    constexpr Index kNumComponents = 64;
    RefinementRows const &rows = _reader->refinementRows;
    Reader::Points points = {this};
    _rows.clear();
    _sources.clear();
    _weights.clear();
    if (Index const begin = _reader->nextFace; begin < rows.GetNumFaces()) {
        _reader->nextFace = std::min(rows.GetNumFaces(), begin + kNumComponents);
        internal::InterpolateFaces<double>(rows, begin, _reader->nextFace, _reader->sources,
                                           points);
    } else {
        Index const vVertex = _reader->nextVVertex;
        _reader->nextVVertex = std::min(rows.GetNumVVertices(), vVertex + kNumComponents);
        internal::InterpolateVVertices<double>(rows, vVertex, _reader->nextVVertex,
                                               _reader->sources, points);
    }
    return !_rows.empty();
}

std::vector<Index> PrimvarRefinerBase::findUniformSources(TopologyRefiner const &refiner,
                                                          int level) {
    Refinement const &refinement = refiner.GetHierarchy().mesh.refinements[std::size_t(level) - 1];
    Level const &parent = *refinement.parent;
    BaseFaceMap const map(refiner, level - 1);
    std::vector<Index> sources(std::size_t(refinement.child->numFaces));
    internal::ParallelFor(refinement.child->numFaces, [&](Index cFace) {
        Cell const cell = refinement.GetParentCell({cFace, 0});
        Index source = cell.face;
        if (cFace >= refinement.child->numFFaces && cell.half == 1 && map.IsSplit(cell.face)) {
            // This edge lies inside of the base face, and a hexagon or F-face across it does, too.
            Index const edge = parent.faceEdges[parent.faceFirstCorner[cell.face] + kHalf1Edge];
            Index const baseFace = map.GetBaseFace(cell.face, 1);
            source = parent.edgeFaces[edge][parent.edgeFaces[edge][0] == cell.face ? 1 : 0];
            if (map.GetBaseFace(source) != baseFace) {
                source = baseFace; // a quad or V-face is there; F-faces keep their index
            }
        }
        sources[std::size_t(cFace)] = source;
    });
    return sources;
}

PrimvarRefinerBase::LimitRows::LimitRows(TopologyRefiner const &refiner) : _refiner(refiner) {}

PrimvarRefinerBase::LimitRows::~LimitRows() = default;

bool PrimvarRefinerBase::LimitRows::Find(CallStatus *status) {
    Hierarchy const &hierarchy = _refiner.GetHierarchy();
    int const level = _refiner.GetMaxLevel();
    if (!internal::Report(
            internal::CheckLimitLevel(hierarchy, _refiner.GetHexSchemeOptions(), level), status)) {
        return false;
    }
    _rows = std::make_unique<internal::LimitRows>(hierarchy.mesh.levels[std::size_t(level)],
                                                  _refiner.GetSchemeOptions(),
                                                  _refiner.GetHexSchemeOptions());
    _sources.resize(internal::PlainNeighborhoodGatherer::kNumRegular);
    return internal::Report(_rows->Find(), status);
}

Index PrimvarRefinerBase::LimitRows::GetNumVertices() const {
    return _refiner.GetLevel(_refiner.GetMaxLevel()).GetNumVertices();
}

PrimvarRefinerBase::LimitRows::Row PrimvarRefinerBase::LimitRows::GetRow(Index vert) {
    internal::LimitRow const row = _rows->GetRow(vert, 0, _sources.data());
    return {row.size, row.sources, row.weights, row.du, row.dv};
}

} // namespace OpenSubdivHex::FarExt

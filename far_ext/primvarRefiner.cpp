// SPDX-License-Identifier: Apache-2.0
#include "primvarRefiner.h"

#include "far_ext/vtr/hierarchy.h"
#include "far_ext/vtr/refinementRows.h"

#include <algorithm>

namespace OpenSubdivHex::FarExt::internal {

using Far::Index;

/// Where PrimvarRows are read from: the F-vertices face by face, then the V-vertices.
struct PrimvarRows::Reader {
    /// A vertex of the level before, and a point of the level itself.
    struct Source {
        Index index;
    };
    struct Point {
        void Clear() { rows->_rows.push_back({point, 0, 0}); }
        void AddWithWeight(Source source, double weight) {
            ++rows->_rows.back().numSources;
            add(source.index, weight);
        }
        void AddWithWeight(Point other, double weight) {
            ++rows->_rows.back().numPoints;
            add(other.point, weight);
        }
        void add(Index index, double weight) {
            rows->_sources.push_back(index);
            rows->_weights.push_back(weight);
        }

        PrimvarRows *rows;
        Index point;
    };
    struct Sources {
        Source operator[](Index vert) const { return {valueOfVertex ? valueOfVertex[vert] : vert}; }

        Index const *valueOfVertex; ///< null: vertices are their own sources
    };
    struct Points {
        Point operator[](Index point) const { return {rows, point}; }

        PrimvarRows *rows;
    };

    RefinementRows const refinementRows;
    Sources const sources;
    Index nextFace = 0;
    Index nextVVertex = 0;
};

PrimvarRows::PrimvarRows(TopologyRefiner const &refiner, int level, Interpolation interpolation,
                         int channel) {
    Hierarchy const &hierarchy = refiner.GetHierarchy();
    bool const hasValues = channel >= 0 && level == 1;
    _reader.reset(new Reader{
        {hierarchy.GetMesh(channel).refinements[std::size_t(level) - 1],
         refiner.GetHexSchemeOptions(), interpolation},
        {hasValues ? hierarchy.channels[std::size_t(channel)].valuesOfVertices.data() : nullptr}});
}

PrimvarRows::~PrimvarRows() = default;

bool PrimvarRows::Next() {
    constexpr Index kNumComponents = 64;
    RefinementRows const &rows = _reader->refinementRows;
    Reader::Points points = {this};
    _rows.clear();
    _sources.clear();
    _weights.clear();
    if (Index const begin = _reader->nextFace; begin < rows.GetNumFaces()) {
        _reader->nextFace = std::min(rows.GetNumFaces(), begin + kNumComponents);
        InterpolateFaces<double>(rows, begin, _reader->nextFace, _reader->sources, points);
    } else {
        Index const vVertex = _reader->nextVVertex;
        _reader->nextVVertex = std::min(rows.GetNumVVertices(), vVertex + kNumComponents);
        InterpolateVVertices<double>(rows, vVertex, _reader->nextVVertex, _reader->sources, points);
    }
    return !_rows.empty();
}

} // namespace OpenSubdivHex::FarExt::internal

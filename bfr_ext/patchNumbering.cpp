// SPDX-License-Identifier: Apache-2.0
#include "patchNumbering.h"

#include "cell/faceSections.h"

#include "far_ext/vtr/report.h"

#include <algorithm>
#include <array>
#include <map>

namespace OpenSubdivHex::BfrExt {

using FarExt::CallStatus;
using FarExt::TopologyLevel;

namespace {

// How many of what a tessellation has.
struct PatchCounts {
    explicit PatchCounts(LevelTessellation const &tessellation)
        : numInteriorPoints(tessellation.GetNumInteriorCoords()),
          numFacets(tessellation.GetNumFacets()),
          numFacetVertices(tessellation.GetNumFacetVertices()), maxFacetSize(0) {
        std::vector<int> sizes(std::size_t(tessellation.GetNumFacets()));
        tessellation.GetFacetSizes(sizes.data());
        maxFacetSize = sizes.empty() ? 0 : *std::max_element(sizes.begin(), sizes.end());
    }

    int numInteriorPoints;
    int numFacets;
    int numFacetVertices;
    int maxFacetSize;
};

} // namespace

/// \brief Numbers of what the sections of a face have, from the first of the face on.
class PatchNumbering::SectionNumbers {
public:
    /// \param makeTessellation  of a section, which is forgotten again
    template <typename MAKE>
    SectionNumbers(internal::FaceSections const &sections, MAKE const &makeTessellation);

    /// The first point inside of a section; of their number: the points inside of the face.
    Number GetFirstPoint(int section) const { return _firstPoint[std::size_t(section)]; }
    Number GetFirstFacet(int section) const { return _firstFacet[std::size_t(section)]; }
    Number GetFirstFacetVertex(int section) const {
        return _firstFacetVertex[std::size_t(section)];
    }
    int GetMaxFacetSize() const { return _maxFacetSize; }
    int GetNumSections() const { return int(_firstPoint.size()) - 1; }

    /// \brief A vertex of a section or, behind it, what lies inside of an edge.
    struct Item {
        int edge;      ///< of the face, on which it lies; -1 inside
        int edgePoint; ///< on an edge of the face: its first point, -1 being the vertex of the face
        Number point;  ///< inside: the first point, in the direction of the section
        bool isOwn;    ///< whether it belongs to the section, among those of the face
        bool isBackwards;
    };
    /// The items of a section: two for each of its edges.
    Item const *GetItems(int section) const {
        return _items.data() + _firstItem[std::size_t(section)];
    }

private:
    int _maxFacetSize = 0;
    std::vector<Number> _firstPoint;
    std::vector<Number> _firstFacet = {0};
    std::vector<Number> _firstFacetVertex = {0};
    std::vector<std::size_t> _firstItem;
    std::vector<Item> _items;
};

template <typename MAKE>
PatchNumbering::SectionNumbers::SectionNumbers(internal::FaceSections const &sections,
                                               MAKE const &makeTessellation) {
    using internal::CellMesh;
    std::vector<CellMesh::Vertex> const &verts = sections.GetVertices();
    // Vertices inside, in the order of the first sections that have them.
    Number next = 0;
    std::vector<Number> pointOfVertex(verts.size(), -1);
    std::vector<bool> isTaken(verts.size());
    for (int section = 0; section < sections.GetNumSections(); ++section) {
        std::vector<int> const polygon = sections.GetPolygon(section);
        _firstItem.push_back(_items.size());
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            auto const vert = std::size_t(polygon[i]);
            CellMesh::Vertex const &start = verts[vert];
            CellMesh::Vertex const &end = verts[std::size_t(polygon[(i + 1) % polygon.size()])];
            Item item = {-1, 0, 0, !isTaken[vert], false};
            isTaken[vert] = true;
            Item edge = {-1, 0, -1, true, false};
            if (sections.IsOnEdge(start)) {
                item.edge = start.sector;
                item.edgePoint =
                    start.b == 0
                        ? -1
                        : sections.CountPointsBefore(start.sector, sections.GetPlaceOnEdge(start));
                if (sections.AreOnEdge(start, end)) {
                    edge.edge = start.sector;
                    edge.edgePoint = item.edgePoint + 1;
                }
            } else {
                if (item.isOwn) {
                    pointOfVertex[vert] = next++;
                }
                item.point = pointOfVertex[vert];
            }
            _items.push_back(item);
            _items.push_back(edge);
        }
    }
    // Edges inside, by their vertices: the second section has them backwards.
    std::map<std::pair<int, int>, Number> firstPointOfEdge;
    std::vector<int> numInteriorPoints;
    for (int section = 0; section < sections.GetNumSections(); ++section) {
        LevelTessellation const tessellation = makeTessellation(section);
        PatchCounts const counts(tessellation);
        _firstFacet.push_back(_firstFacet.back() + counts.numFacets);
        _firstFacetVertex.push_back(_firstFacetVertex.back() + counts.numFacetVertices);
        _maxFacetSize = std::max(_maxFacetSize, counts.maxFacetSize);
        numInteriorPoints.push_back(counts.numInteriorPoints);
        std::vector<int> const polygon = sections.GetPolygon(section);
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            Item &edge = _items[_firstItem[std::size_t(section)] + 2 * i + 1];
            if (edge.edge >= 0) {
                continue;
            }
            int const start = polygon[i];
            int const end = polygon[(i + 1) % polygon.size()];
            int const count = tessellation.GetNumEdgeCoords(int(i));
            auto const other = firstPointOfEdge.find({end, start});
            if (other != firstPointOfEdge.end()) {
                edge.point = other->second + count - 1;
                edge.isOwn = false;
                edge.isBackwards = true;
                firstPointOfEdge.erase(other);
            } else {
                edge.point = next;
                firstPointOfEdge.emplace(std::make_pair(start, end), next);
                next += count;
            }
        }
    }
    for (int const count : numInteriorPoints) {
        _firstPoint.push_back(next);
        next += count;
    }
    _firstPoint.push_back(next);
}

template <typename REAL>
std::unique_ptr<PatchNumbering> PatchNumbering::Create(PatchStream<REAL> const &stream,
                                                       CallStatus *status) {
    CallStatus const result = stream.checkRange(0, stream.GetFactory().GetNumFaces());
    if (!FarExt::internal::Report(result, status)) {
        return nullptr;
    }
    std::unique_ptr<PatchNumbering> numbering(new PatchNumbering(stream.GetFactory()));
    TopologyLevel const &base = stream.GetFactory().GetLevel();
    Number next = 0;
    for (Index vert = 0; vert < base.GetNumVertices(); ++vert) {
        numbering->_pointOfVertex.push_back(next);
        next += numbering->findOwner(base.GetVertexFaces(vert)) == Far::INDEX_INVALID ? 0 : 1;
    }
    std::array<int, Polyline::kLastLevel + 1> numEdgePoints; // by level
    for (std::size_t level = 0; level < numEdgePoints.size(); ++level) {
        numEdgePoints[level] = Polyline(int(level)).GetNumPoints();
    }
    for (Index edge = 0; edge < base.GetNumEdges(); ++edge) {
        numbering->_firstPointOfEdge.push_back(next);
        if (numbering->findOwner(base.GetEdgeFaces(edge)) == Far::INDEX_INVALID) {
            continue;
        }
        next += stream.GetForest()
                    ? stream.GetForest()->GetPolyline(edge).GetNumPoints()
                    : numEdgePoints[std::size_t(stream.GetLevels().GetEdgeLevel(edge))];
    }
    numbering->_firstPointOfEdge.push_back(next);
    numbering->_firstFacet.push_back(0);
    numbering->_firstFacetVertex.push_back(0);
    std::map<std::vector<int>, PatchCounts> counts;
    std::map<std::vector<int>, std::shared_ptr<SectionNumbers const>> sectionsOfLevels;
    auto const makeSections = [&](Index face) {
        auto const sections = stream.makeSections(face);
        LevelTessellation::Options const options = stream.GetOptions().GetTessellationOptions();
        return std::make_shared<SectionNumbers const>(
            *sections, [&](int section) { return LevelTessellation(*sections, section, options); });
    };
    std::vector<int> levels;
    for (Index face = 0; face < base.GetNumFaces(); ++face) {
        numbering->_firstPointOfFace.push_back(next);
        Number numFacets = 0;
        Number numFacetVertices = 0;
        if (!base.IsFaceHole(face)) {
            auto const add = [&](PatchCounts const &patch) {
                next += patch.numInteriorPoints;
                numFacets = patch.numFacets;
                numFacetVertices = patch.numFacetVertices;
                numbering->_maxFacetSize = std::max(numbering->_maxFacetSize, patch.maxFacetSize);
            };
            stream.getLevels(face, levels);
            if (stream.isCut(face, levels)) {
                std::shared_ptr<SectionNumbers const> ofTree;
                auto &sections = stream.GetForest() ? ofTree : sectionsOfLevels[levels];
                if (!sections) {
                    sections = makeSections(face);
                }
                int const numSections = sections->GetNumSections();
                next += sections->GetFirstPoint(numSections);
                numFacets = sections->GetFirstFacet(numSections);
                numFacetVertices = sections->GetFirstFacetVertex(numSections);
                numbering->_maxFacetSize =
                    std::max(numbering->_maxFacetSize, sections->GetMaxFacetSize());
                numbering->_sections.emplace(face, sections);
            } else if (stream.GetForest()) {
                add(PatchCounts(stream.MakeTessellation(face)));
            } else {
                auto found = counts.find(levels);
                if (found == counts.end()) {
                    found =
                        counts.emplace(levels, PatchCounts(stream.MakeTessellation(face))).first;
                }
                add(found->second);
            }
        }
        numbering->_firstFacet.push_back(numbering->_firstFacet.back() + numFacets);
        numbering->_firstFacetVertex.push_back(numbering->_firstFacetVertex.back() +
                                               numFacetVertices);
    }
    numbering->_firstPointOfFace.push_back(next);
    return numbering;
}

template std::unique_ptr<PatchNumbering> PatchNumbering::Create(PatchStream<float> const &,
                                                                CallStatus *);
template std::unique_ptr<PatchNumbering> PatchNumbering::Create(PatchStream<double> const &,
                                                                CallStatus *);

// The first of the faces that is no hole.
Far::Index PatchNumbering::findOwner(Far::ConstIndexArray faces) const {
    TopologyLevel const &base = _factory.GetLevel();
    auto const found = std::find_if(faces.begin(), faces.end(),
                                    [&](Index face) { return !base.IsFaceHole(face); });
    return found == faces.end() ? Far::INDEX_INVALID : *found;
}

PatchNumbering::SectionNumbers const *PatchNumbering::findSections(Index face) const {
    auto const found = _sections.find(face);
    return found == _sections.end() ? nullptr : found->second.get();
}

PatchNumbering::Number PatchNumbering::GetFirstFacet(Index face, int section) const {
    SectionNumbers const *const sections = findSections(face);
    return GetFirstFacet(face) + (sections ? sections->GetFirstFacet(section) : 0);
}

PatchNumbering::Number PatchNumbering::GetFirstFacetVertex(Index face, int section) const {
    SectionNumbers const *const sections = findSections(face);
    return GetFirstFacetVertex(face) + (sections ? sections->GetFirstFacetVertex(section) : 0);
}

// A face may have a vertex, or an edge, twice: then it belongs to the first place.
bool PatchNumbering::isVertexOwn(Index face, int local) const {
    TopologyLevel const &base = _factory.GetLevel();
    Far::ConstIndexArray const verts = base.GetFaceVertices(face);
    auto const *const begin = verts.begin();
    return std::find(begin, begin + local, verts[local]) == begin + local &&
           findOwner(base.GetVertexFaces(verts[local])) == face;
}

// Points first ... first + count - 1 of an edge, counted in the direction of the face.
PatchNumbering::Run PatchNumbering::makeEdgeRun(Index face, int local, int place, int first,
                                                int count) const {
    TopologyLevel const &base = _factory.GetLevel();
    Far::ConstIndexArray const edges = base.GetFaceEdges(face);
    Index const edge = edges[local];
    Far::ConstIndexArray const edgeFaces = base.GetEdgeFaces(edge);
    bool const isForward = edgeFaces[0] == face && base.GetEdgeFaceLocalIndices(edge)[0] == local;
    auto const *const begin = edges.begin();
    bool const isFirst = std::find(begin, begin + local, edge) == begin + local;
    Number const point = isForward ? _firstPointOfEdge[std::size_t(edge)] + first
                                   : _firstPointOfEdge[std::size_t(edge) + 1] - 1 - first;
    return {place, count, isForward ? 1 : -1, point, isFirst && findOwner(edgeFaces) == face};
}

void PatchNumbering::GetRuns(Index face, LevelTessellation const &tessellation,
                             std::vector<Run> &runs) const {
    runs.clear();
    Far::ConstIndexArray const verts = _factory.GetLevel().GetFaceVertices(face);
    Number const firstPoint = _firstPointOfFace[std::size_t(face)];
    SectionNumbers const *const sections = findSections(face);
    SectionNumbers::Item const *item =
        sections ? sections->GetItems(tessellation.GetSection()) : nullptr;
    int place = 0;
    auto const addVertex = [&](int local) {
        runs.push_back(
            {place, 1, 1, _pointOfVertex[std::size_t(verts[local])], isVertexOwn(face, local)});
    };
    for (int i = 0; i < tessellation.GetNumEdges(); ++i) {
        int const count = tessellation.GetNumEdgeCoords(i);
        if (!sections) {
            addVertex(i);
            ++place;
            if (count > 0) {
                runs.push_back(makeEdgeRun(face, i, place, 0, count));
            }
            place += count;
            continue;
        }
        // The vertex, then what lies inside of the edge.
        for (int const length : {1, count}) {
            if (length == 0) {
                ++item;
                continue;
            }
            if (item->edge < 0) {
                runs.push_back({place, length, item->isBackwards ? -1 : 1, firstPoint + item->point,
                                item->isOwn});
            } else {
                if (item->edgePoint < 0) {
                    addVertex(item->edge);
                } else {
                    runs.push_back(makeEdgeRun(face, item->edge, place, item->edgePoint, length));
                }
                runs.back().isOwn = runs.back().isOwn && item->isOwn;
            }
            place += length;
            ++item;
        }
    }
    runs.push_back(
        {place, tessellation.GetNumInteriorCoords(), 1,
         firstPoint + (sections ? sections->GetFirstPoint(tessellation.GetSection()) : 0), true});
}

void PatchNumbering::GetPoints(Index face, LevelTessellation const &tessellation,
                               Number points[]) const {
    std::vector<Run> runs;
    GetRuns(face, tessellation, runs);
    for (Run const &run : runs) {
        for (int i = 0; i < run.count; ++i) {
            *points++ = run.point + Number(i) * run.step;
        }
    }
}

} // namespace OpenSubdivHex::BfrExt

// SPDX-License-Identifier: Apache-2.0
#include "patchNumbering.h"

#include <algorithm>
#include <array>
#include <map>
#include <mutex>
#include <numeric>
#include <utility>

namespace OpenSubdivHex::Tools {

using BfrExt::LevelTessellation;
using BfrExt::PatchStream;
using BfrExt::Polyline;
using FarExt::CallStatus;
using FarExt::SurfaceFaces;

namespace {

// How many of what a patch has.
struct PatchCounts {
    PatchCounts() = default;
    explicit PatchCounts(LevelTessellation const &tessellation)
        : numInteriorPoints(tessellation.GetNumInteriorCoords()),
          numFacets(tessellation.GetNumFacets()),
          numFacetVertices(tessellation.GetNumFacetVertices()),
          maxFacetSize(tessellation.GetMaxFacetSize()) {}

    int numInteriorPoints = 0;
    int numFacets = 0;
    int numFacetVertices = 0;
    int maxFacetSize = 0;
};

struct SectionCounts {
    SectionCounts() = default;
    explicit SectionCounts(LevelTessellation const &tessellation) : ofPatch(tessellation) {
        for (int edge = 0; edge < tessellation.GetNumEdges(); ++edge) {
            numEdgePoints.push_back(tessellation.GetNumEdgeCoords(edge));
        }
    }

    PatchCounts ofPatch;
    std::vector<int> numEdgePoints; // by edge of the section, without its ends
};

} // namespace

/// \brief Numbers of what the sections of a face have, from the first of the face on.
class PatchNumbering::SectionNumbers {
public:
    /// \param polygons  PatchStream::SectionPolygons of a face of \p faceSize vertices
    /// \param counts    by section
    template <typename POLYGONS>
    SectionNumbers(POLYGONS const &polygons, int faceSize,
                   std::vector<SectionCounts> const &counts);

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

template <typename POLYGONS>
PatchNumbering::SectionNumbers::SectionNumbers(POLYGONS const &polygons, int faceSize,
                                               std::vector<SectionCounts> const &counts) {
    // Calls function(corner, vertex there, vertex behind it) around a section.
    auto const forEachSide = [&](std::size_t section, auto const &function) {
        int const first = polygons.firstCorners[section];
        int const end = polygons.firstCorners[section + 1];
        for (int corner = first; corner < end; ++corner) {
            int const next = corner + 1 == end ? first : corner + 1;
            function(std::size_t(corner), polygons.vertices[std::size_t(corner)],
                     polygons.vertices[std::size_t(next)]);
        }
    };
    // Whether a side lies on the edge of the face that its start lies on.
    auto const isOnEdge = [&](std::size_t start, std::size_t end) {
        int const edge = polygons.edges[start];
        return edge >= 0 &&
               (polygons.edges[end] == edge ||
                (polygons.edges[end] == (edge + 1) % faceSize && polygons.edgePoints[end] == -1));
    };
    // Vertices inside, in the order of the first sections that have them.
    Number next = 0;
    std::vector<Number> pointOfVertex(polygons.edges.size(), -1);
    std::vector<bool> isTaken(polygons.edges.size());
    for (std::size_t section = 0; section < counts.size(); ++section) {
        _firstItem.push_back(_items.size());
        forEachSide(section, [&](std::size_t, int startVertex, int endVertex) {
            auto const start = std::size_t(startVertex);
            Item item = {polygons.edges[start], polygons.edgePoints[start], 0, !isTaken[start],
                         false};
            isTaken[start] = true;
            Item edge = {-1, 0, -1, true, false};
            if (isOnEdge(start, std::size_t(endVertex))) {
                edge.edge = item.edge;
                edge.edgePoint = item.edgePoint + 1;
            }
            if (item.edge < 0) {
                if (item.isOwn) {
                    pointOfVertex[start] = next++;
                }
                item.point = pointOfVertex[start];
            }
            _items.push_back(item);
            _items.push_back(edge);
        });
    }
    // Edges inside, by their vertices: the second section has them backwards.
    std::map<std::pair<int, int>, Number> firstPointOfEdge;
    for (std::size_t section = 0; section < counts.size(); ++section) {
        PatchCounts const &ofPatch = counts[section].ofPatch;
        _firstFacet.push_back(_firstFacet.back() + ofPatch.numFacets);
        _firstFacetVertex.push_back(_firstFacetVertex.back() + ofPatch.numFacetVertices);
        _maxFacetSize = std::max(_maxFacetSize, ofPatch.maxFacetSize);
        auto const firstCorner = std::size_t(polygons.firstCorners[section]);
        forEachSide(section, [&](std::size_t corner, int start, int end) {
            Item &edge = _items[2 * corner + 1];
            if (edge.edge >= 0) {
                return;
            }
            int const count = counts[section].numEdgePoints[corner - firstCorner];
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
        });
    }
    for (SectionCounts const &section : counts) {
        _firstPoint.push_back(next);
        next += section.ofPatch.numInteriorPoints;
    }
    _firstPoint.push_back(next);
}

template <typename REAL>
std::unique_ptr<PatchNumbering> PatchNumbering::Create(PatchStream<REAL> const &stream,
                                                       CallStatus *status) {
    SurfaceFaces const &base = stream.GetFactory().GetFaces();
    struct FaceInSections {
        typename PatchStream<REAL>::SectionPolygons polygons;
        std::vector<SectionCounts> sections;
    };
    std::vector<PatchCounts> counts(std::size_t(base.GetNumFaces()));
    std::map<Index, FaceInSections> inSections;
    std::mutex mutex;
    auto const count = [&](Index face, LevelTessellation const &tessellation) {
        int const numSections = tessellation.GetNumSections();
        if (numSections == 1) {
            counts[std::size_t(face)] = PatchCounts(tessellation);
            return true;
        }
        int const section = tessellation.GetSection();
        SectionCounts ofSection(tessellation);
        typename PatchStream<REAL>::SectionPolygons polygons;
        if (section == 0) {
            polygons = stream.GetSectionPolygons(face);
        }
        std::lock_guard<std::mutex> const lock(mutex);
        FaceInSections &ofFace = inSections[face];
        ofFace.sections.resize(std::size_t(numSections));
        ofFace.sections[std::size_t(section)] = std::move(ofSection);
        if (section == 0) {
            ofFace.polygons = std::move(polygons);
        }
        return true;
    };
    if (!stream.RunTessellations(count, status)) {
        return nullptr;
    }
    std::unique_ptr<PatchNumbering> numbering(new PatchNumbering(stream.GetFactory()));
    numbering->_maxFacetSize =
        std::accumulate(counts.begin(), counts.end(), 0, [](int size, PatchCounts const &patch) {
            return std::max(size, patch.maxFacetSize);
        });
    for (auto &[face, ofFace] : inSections) {
        auto numbers = std::make_shared<SectionNumbers const>(
            ofFace.polygons, base.GetShape(face).size, ofFace.sections);
        numbering->_maxFacetSize = std::max(numbering->_maxFacetSize, numbers->GetMaxFacetSize());
        numbering->_sections.emplace(face, std::move(numbers));
        ofFace = {};
    }
    Number next = 0;
    for (Index vert = 0; vert < stream.GetFactory().GetLevel().GetNumVertices(); ++vert) {
        numbering->_pointOfVertex.push_back(next);
        next += numbering->findVertexOwner(vert) == Far::INDEX_INVALID ? 0 : 1;
    }
    // By level; the long edge of half a polygon has the points of another level.
    std::array<int, Polyline::kLastLevel + 2> numEdgePoints;
    for (std::size_t level = 0; level < numEdgePoints.size(); ++level) {
        numEdgePoints[level] = Polyline(int(level)).GetNumPoints();
    }
    auto const isLongEdge = [&](Index edge) {
        auto const [face, local] = base.GetSide(edge, 0);
        return local == 0 && base.GetShape(face).isHalf;
    };
    for (Index edge = 0; edge < base.GetNumEdges(); ++edge) {
        numbering->_firstPointOfEdge.push_back(next);
        if (numbering->findEdgeOwner(edge) == Far::INDEX_INVALID) {
            continue;
        }
        next += stream.GetForest()
                    ? stream.GetForest()->GetPolyline(edge).GetNumPoints()
                    : numEdgePoints[std::size_t(stream.GetLevels().GetEdgeLevel(edge) +
                                                (isLongEdge(edge) ? 1 : 0))];
    }
    numbering->_firstPointOfEdge.push_back(next);
    numbering->_firstFacet.push_back(0);
    numbering->_firstFacetVertex.push_back(0);
    for (Index face = 0; face < base.GetNumFaces(); ++face) {
        numbering->_firstPointOfFace.push_back(next);
        PatchCounts const &patch = counts[std::size_t(face)];
        Number numPoints = patch.numInteriorPoints;
        Number numFacets = patch.numFacets;
        Number numFacetVertices = patch.numFacetVertices;
        if (SectionNumbers const *const sections = numbering->findSections(face)) {
            int const numSections = sections->GetNumSections();
            numPoints = sections->GetFirstPoint(numSections);
            numFacets = sections->GetFirstFacet(numSections);
            numFacetVertices = sections->GetFirstFacetVertex(numSections);
        }
        next += numPoints;
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
Far::Index PatchNumbering::findVertexOwner(Index vert) const {
    SurfaceFaces const &base = _factory.GetFaces();
    for (Index const face : base.GetVertexFaces(vert)) {
        if (!base.IsHole(face)) {
            return face;
        }
    }
    return Far::INDEX_INVALID;
}

Far::Index PatchNumbering::findEdgeOwner(Index edge) const {
    SurfaceFaces const &base = _factory.GetFaces();
    for (int side = 0; side < 2; ++side) {
        Index const face = base.GetSide(edge, side).face;
        if (face != Far::INDEX_INVALID && !base.IsHole(face)) {
            return face;
        }
    }
    return Far::INDEX_INVALID;
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
    SurfaceFaces const &base = _factory.GetFaces();
    Index const vert = base.GetVertex(face, local);
    for (int before = 0; before < local; ++before) {
        if (base.GetVertex(face, before) == vert) {
            return false;
        }
    }
    return findVertexOwner(vert) == face;
}

// Points first ... first + count - 1 of an edge, counted in the direction of the face.
PatchNumbering::Run PatchNumbering::makeEdgeRun(Index face, int local, int place, int first,
                                                int count) const {
    SurfaceFaces const &base = _factory.GetFaces();
    auto const [edge, isReversed] = base.GetEdge(face, local);
    bool isFirst = true;
    for (int before = 0; before < local; ++before) {
        isFirst = isFirst && base.GetEdge(face, before).edge != edge;
    }
    Number const point = isReversed ? _firstPointOfEdge[std::size_t(edge) + 1] - 1 - first
                                    : _firstPointOfEdge[std::size_t(edge)] + first;
    return {place, count, isReversed ? -1 : 1, point, isFirst && findEdgeOwner(edge) == face};
}

void PatchNumbering::GetRuns(Index face, LevelTessellation const &tessellation,
                             std::vector<Run> &runs) const {
    runs.clear();
    Number const firstPoint = _firstPointOfFace[std::size_t(face)];
    SectionNumbers const *const sections = findSections(face);
    SectionNumbers::Item const *item =
        sections ? sections->GetItems(tessellation.GetSection()) : nullptr;
    int place = 0;
    auto const addVertex = [&](int local) {
        Index const vert = _factory.GetFaces().GetVertex(face, local);
        runs.push_back({place, 1, 1, _pointOfVertex[std::size_t(vert)], isVertexOwn(face, local)});
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

} // namespace OpenSubdivHex::Tools

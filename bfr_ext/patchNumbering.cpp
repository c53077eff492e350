// SPDX-License-Identifier: Apache-2.0
#include "patchNumbering.h"

#include <algorithm>
#include <map>

namespace OpenSubdivHex::BfrExt {

using FarExt::Status;
using FarExt::TopologyLevel;

namespace {

// How many of what a tessellation has.
struct PatchCounts {
    explicit PatchCounts(Tessellation const &tessellation)
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

template <typename REAL>
std::unique_ptr<PatchNumbering> PatchNumbering::Create(PatchStream<REAL> const &stream,
                                                       Status *status) {
    Status const result = stream.check(0, stream.GetFactory().GetNumFaces());
    if (!FarExt::internal::Report(result, status)) {
        return nullptr;
    }
    std::unique_ptr<PatchNumbering> numbering(new PatchNumbering(stream.GetFactory()));
    TopologyLevel const &base = stream.GetFactory().GetMesh().GetLevel(0);
    Number next = 0;
    for (Index vert = 0; vert < base.GetNumVertices(); ++vert) {
        numbering->_pointOfVertex.push_back(next);
        next += numbering->findOwner(base.GetVertexFaces(vert)) == Far::INDEX_INVALID ? 0 : 1;
    }
    // Polylines have the points of tessellations of any face.
    constexpr int kTriangle = 3;
    std::vector<int> numEdgePoints;
    for (Index edge = 0; edge < base.GetNumEdges(); ++edge) {
        numbering->_firstPointOfEdge.push_back(next);
        if (numbering->findOwner(base.GetEdgeFaces(edge)) == Far::INDEX_INVALID) {
            continue;
        }
        if (stream.GetForest()) {
            next += stream.GetForest()->GetPolyline(edge).GetNumPoints();
            continue;
        }
        auto const level = std::size_t(stream.GetLevels().GetEdgeLevel(edge));
        while (numEdgePoints.size() <= level) {
            int const levels[] = {int(numEdgePoints.size()), 0, 0, 0};
            numEdgePoints.push_back(Tessellation(Parameterization(kTriangle), kTriangle + 1, levels)
                                        .GetNumEdgeCoords(0));
        }
        next += numEdgePoints[level];
    }
    numbering->_firstFacet.push_back(0);
    numbering->_firstFacetVertex.push_back(0);
    std::map<std::vector<int>, PatchCounts> counts;
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
            if (stream.GetForest()) {
                add(PatchCounts(stream.MakeTessellation(face)));
            } else {
                stream.getLevels(face, levels);
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
                                                                Status *);
template std::unique_ptr<PatchNumbering> PatchNumbering::Create(PatchStream<double> const &,
                                                                Status *);

// The first of the faces that is no hole.
Far::Index PatchNumbering::findOwner(Far::ConstIndexArray faces) const {
    TopologyLevel const &base = _factory.GetMesh().GetLevel(0);
    auto const found = std::find_if(faces.begin(), faces.end(),
                                    [&](Index face) { return !base.IsFaceHole(face); });
    return found == faces.end() ? Far::INDEX_INVALID : *found;
}

void PatchNumbering::GetRuns(Index face, Tessellation const &tessellation,
                             std::vector<Run> &runs) const {
    runs.clear();
    TopologyLevel const &base = _factory.GetMesh().GetLevel(0);
    Far::ConstIndexArray const verts = base.GetFaceVertices(face);
    Far::ConstIndexArray const edges = base.GetFaceEdges(face);
    int place = 0;
    for (int i = 0; i < verts.size(); ++i) {
        // A face may have a vertex, or an edge, twice: then it belongs to the first place.
        bool const isFirst =
            std::find(verts.begin(), verts.begin() + i, verts[i]) == verts.begin() + i;
        runs.push_back({place, 1, 1, _pointOfVertex[std::size_t(verts[i])],
                        isFirst && findOwner(base.GetVertexFaces(verts[i])) == face});
        ++place;
        int const count = tessellation.GetNumEdgeCoords(i);
        if (count == 0) {
            continue;
        }
        Far::ConstIndexArray const edgeFaces = base.GetEdgeFaces(edges[i]);
        bool const isForward =
            edgeFaces[0] == face && base.GetEdgeFaceLocalIndices(edges[i])[0] == i;
        bool const isFirstEdge =
            std::find(edges.begin(), edges.begin() + i, edges[i]) == edges.begin() + i;
        Number const first = _firstPointOfEdge[std::size_t(edges[i])];
        runs.push_back({place, count, isForward ? 1 : -1, isForward ? first : first + count - 1,
                        isFirstEdge && findOwner(edgeFaces) == face});
        place += count;
    }
    runs.push_back({place, tessellation.GetNumInteriorCoords(), 1,
                    _firstPointOfFace[std::size_t(face)], true});
}

void PatchNumbering::GetPoints(Index face, Tessellation const &tessellation,
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

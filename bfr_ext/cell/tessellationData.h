// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_TESSELLATION_DATA_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_TESSELLATION_DATA_H

#include "bfrPlace.h"
#include "cellMesh.h"
#include "cellPlan.h"
#include "faceSections.h"

#include "bfr_ext/levelTessellation.h"

#include <memory>
#include <mutex>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief The data of a LevelTessellation, which its copies share: places, facets between them, and the plans by
/// which a Surface evaluates the places, made when they are first needed.
///
/// Nothing is changed after a function Set...(): any number of threads may use it then.
class TessellationData {
public:
    /// Places on an edge of the face that follow one another.
    struct BorderRun {
        int edge;
        int index; ///< which point of the edge is the first, -1 being its vertex
        int count;
        int place;
        bool hasWholeEdge; ///< all its points
    };

    /// @name What the constructors of LevelTessellation take, and a section of a face
    /// \return  whether the arguments are as they have to be; else the data are not to be used
    /// @{
    bool SetLevels(Parameterization const &ofFace, int numLevels, int const ofEdges[],
                   LevelTessellation::Options const &options);
    bool SetTree(CellTree const &cells, Polyline const edges[],
                 LevelTessellation::Options const &options);
    bool SetSection(FaceSections const &sections, int number,
                    LevelTessellation::Options const &options);
    /// @}

    FaceShape GetFaceShape() const { return parameterization.GetFaceShape(); }
    int GetFaceSize() const { return parameterization.GetFaceSize(); }
    int GetNumCoords() const { return int(places.size()); }
    int GetNumBoundaryCoords() const {
        return firstEdgeCoords.empty() ? 0 : firstEdgeCoords.back();
    }
    /// The weights of the start and the end of an edge at a place on it, which may be the edge's last.
    Pair GetWeightsOnEdge(std::size_t edge, int place) const {
        LeafPlaces::Place const &inSector = places[std::size_t(place)];
        if (int(edge) >= GetFaceShape().GetFirstSector()) {
            return inSector.coords;
        }
        double const end = FindOnEdge(GetFaceShape(), inSector, 1.0).end;
        return {1 - end, end};
    }

    /// Which cells the places inside lie in.
    CellPlan const &GetCellPlan(bool isInLattice, bool isOfDerivatives) const;
    /// All places, in a face with sub-faces.
    std::vector<BfrPlace> const &GetBfrPlaces() const;

    Parameterization parameterization;
    int facetSize = 3;
    int facetStride = 3;
    int coordStride = 2;
    std::vector<int> levels; ///< of edges, then of the inside; none of a tree
    PlaceLevels placeLevels; ///< of the whole face
    int section = 0;
    int numSections = 1;                   ///< of the face
    std::vector<BorderRun> border;         ///< the places on the border of the face
    std::vector<double> coords;            ///< two of each place
    std::vector<LeafPlaces::Place> places; ///< the same, exactly, in sectors
    std::vector<int> firstEdgeCoords;   ///< by edge, the place of its first vertex; then their end
    std::vector<int> firstFacetIndices; ///< by facet; then their end
    std::vector<int> facetIndices;      ///< of all facets
    std::vector<int> facetLevels;       ///< by facet
    int maxFacetSize = 0;

private:
    bool setOptions(LevelTessellation::Options const &options);
    bool setFace(CellMesh const &mesh);
    bool setCells(CellMesh const &mesh, std::vector<CellMesh::Vertex> const &polygon);
    std::vector<int> setPlaces(CellMesh const &mesh, std::vector<int> const &order);
    bool setFacets(CellMesh const &mesh, std::vector<int> const &placesOfVertices);
    std::vector<double> findRegularCoords() const;

    // [is the face in a lattice][are they for derivatives]
    mutable std::once_flag _oncePlans[2][2];
    mutable std::unique_ptr<CellPlan const> _plans[2][2];
    mutable std::once_flag _onceBfrPlaces;
    mutable std::vector<BfrPlace> _bfrPlaces;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif

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
#include <optional>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief The data of a LevelTessellation, which its copies share: places, facets between them, and the plans by
/// which a Surface evaluates the places, made when they are first needed.
///
/// Nothing is changed after a function Set...(): any number of threads may use it then.
class TessellationData {
public:
    /// Places on an edge of the face that follow one another in a section.
    struct BorderRun {
        int edge;
        int index; ///< which point of the edge is the first, -1 being its vertex
        int count;
        int place;
    };
    /// Further data of the tessellation of a section.
    struct Section {
        int number;
        int count; ///< of the face
        std::vector<BorderRun> border;
    };
    /// The sector of an edge, and what the places of its start and its end weigh beside the centre.
    struct SectorCoords {
        int sector;
        double start;
        double end;
    };
    /// A place that is a corner of a cell.
    struct CellCorner {
        int cell;
        int corner;
        int place;
    };
    /// Further data of the tessellation of a tree.
    struct Tree {
        CellTree cells;
        std::vector<Polyline> edges;
        std::vector<int> edgeLevels;     ///< by edge, that of which it has the polyline; -1: none
        std::vector<CellCorner> corners; ///< of all places that are corners, ascending by cell
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
    /// The level whose polyline an edge has; -1: none.
    int GetEdgeLevel(std::size_t edge) const {
        return tree ? tree->edgeLevels[edge]
                    : FaceSections::GetEdgeLevel(GetFaceShape(), int(edge), levels[edge]);
    }
    /// The weights of the start and the end of an edge at a place on it, which may be the edge's last.
    Pair GetWeightsOnEdge(std::size_t edge, int place) const {
        SectorCoords const &weights = places[std::size_t(place)];
        if (int(edge) >= GetFaceShape().GetFirstSector()) {
            return {weights.start, weights.end};
        }
        SectorPlace<Pair> const inSector = {weights.sector, {weights.start, weights.end}};
        double const end = FindOnEdge(GetFaceShape(), inSector, 1.0).end;
        return {1 - end, end};
    }

    /// Whether there are plans: not of a large tree, nor of its sections.
    bool HasCellPlans() const { return _cellPlans != nullptr; }
    /// Which cells the places inside lie in.
    CellPlan const &GetCellPlan(bool isInLattice, bool isOfDerivatives = false) const;
    /// All places, in a face with sub-faces.
    std::vector<BfrPlace> const &GetBfrPlaces() const;
    /// The places that are corners of the cells that CellStencil has their derivatives from, which with
    /// FaceMask::Average are others in other cells; ascending by cell.
    std::vector<CellCorner> FindCornersOfDerivatives() const;

    Parameterization parameterization;
    int facetSize = 3;
    int facetStride = 3;
    int coordStride = 2;
    std::vector<int> levels; ///< of edges, then of the inside; none of a tree
    std::optional<Tree> tree;
    std::optional<Section> section;
    std::vector<double> coords;         ///< two of each place
    std::vector<SectorCoords> places;   ///< the same, exactly
    std::vector<int> firstEdgeCoords;   ///< by edge, the place of its first vertex; then their end
    std::vector<int> firstFacetIndices; ///< by facet; then their end
    std::vector<int> facetIndices;      ///< of all facets
    std::vector<int> facetLevels;       ///< by facet
    int maxFacetSize = 0;

private:
    // Plans [is the face in a lattice][are they for derivatives].
    struct CellPlans {
        std::once_flag once[2][2];
        std::unique_ptr<CellPlan const> plans[2][2];
    };

    bool setOptions(LevelTessellation::Options const &options);
    bool setCells(CellMesh const &mesh, std::vector<CellMesh::Vertex> const &polygon);
    std::vector<int> setPlaces(CellMesh const &mesh, std::vector<int> const &order);
    bool setFacets(CellMesh const &mesh, std::vector<int> const &placesOfVertices);
    static void sortByCell(std::vector<CellCorner> &corners);
    std::vector<double> findRegularCoords() const;
    int getLevelOfPlaces(bool isOfDerivatives) const;

    std::unique_ptr<CellPlans> _cellPlans;
    mutable std::once_flag _onceBfrPlaces;
    mutable std::vector<BfrPlace> _bfrPlaces;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_HEXVIEW_CELL_VIEW_H
#define OPENSUBDIVHEX_TOOLS_HEXVIEW_CELL_VIEW_H

#include "drawnTopology.h"

#include "bfr_ext/surfaceFactory.h"
#include "bfr_ext/view.h"
#include "far_ext/stencilTableFactory.h"
#include "osd_ext/refinementEvaluator.h"
#include "tools/mesh/mesh.h"

#include <memory>
#include <optional>
#include <vector>

namespace OpenSubdivHex::Tools {

/// \brief The base faces of a mesh, each refined as far as a camera needs it.
class CellView {
public:
    /// \brief Makes the surfaces of all faces of the surface level, to which the refiner is refined.
    ///
    /// \param uvChannel  the channel with texture coordinates; -1 if there is none
    ///
    /// Throws std::runtime_error with the cause where a face has no surface.
    CellView(Mesh const &mesh, std::unique_ptr<FarExt::TopologyRefiner> refiner, int uvChannel);

    /// Counts since Refine().
    struct Statistics {
        BfrExt::View::Counts counts;
        int numPoints = 0;
        int numTypes = 0; ///< of base faces
    };

    /// \brief Finds the cells that a view needs; those of the call before stay refined, by the
    /// hysteresis of the view.  What is drawn is another then.  Control points are those of the mesh.
    void Refine(BfrExt::View const &view, std::vector<float> const &controlPoints);
    /// Whether Refine() has found cells.
    bool IsRefined() const { return _forest.has_value(); }
    Statistics const &GetStatistics() const { return _statistics; }
    /// The topology that Refine() found.
    DrawnTopology const &GetTopology() const { return _topology; }

    /// Makes the points of the limit surface at all vertices, and x y z 0 of the normal of each side.
    void Evaluate(std::vector<float> const &controlPoints);
    std::vector<float> const &GetPoints() const { return _points; }
    std::vector<float> const &GetNormals() const { return _normals; }

private:
    // A base face; a hole has none of this.
    struct Face {
        BfrExt::Surface<float> surface;
        BfrExt::Surface<float> uvSurface;
        std::unique_ptr<BfrExt::LevelTessellation> polygons;
        std::unique_ptr<BfrExt::LevelTessellation> triangles; // of the same places
        std::vector<int> points;                              // by place
        std::vector<int> sides;                               // likewise
    };

    void numberPlaces();
    void findTopology();
    void addTriangles(int number, Face const &face);

    FarExt::TopologyLevel getBase() const { return _refiner->GetLevel(_refiner->GetMaxLevel()); }
    std::vector<float> findPoints(std::vector<float> const &controlPoints) const;

    std::unique_ptr<FarExt::TopologyRefiner> _refiner;
    FarExt::LimitSides _baseSides; // of the vertices of the surface level
    BfrExt::SurfaceFactoryCache _cache;
    std::unique_ptr<BfrExt::SurfaceFactory> _factory;
    std::unique_ptr<OsdExt::RefinementEvaluator>
        _evaluator;          // of points of a surface level beyond 0
    std::vector<float> _uvs; // of the channel; empty without
    int _uvWidth = 0;
    std::vector<Face> _faces;
    std::optional<BfrExt::ViewBounds> _bounds;
    std::optional<BfrExt::CellForest> _forest;
    Statistics _statistics;
    DrawnTopology _topology;
    std::vector<float> _points;
    std::vector<float> _normals;
};

} // namespace OpenSubdivHex::Tools

#endif

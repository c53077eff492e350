// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_HEXVIEW_VIEWED_SURFACE_H
#define OPENSUBDIVHEX_TOOLS_HEXVIEW_VIEWED_SURFACE_H

#include "cellView.h"
#include "drawnTopology.h"
#include "patchView.h"

#include "far_ext/topologyRefiner.h"
#include "osd_ext/glEvaluation.h"
#include "osd_ext/glRefinementEvaluator.h"
#include "osd_ext/refinementEvaluator.h"
#include "tools/gl/glObjects.h"
#include "tools/mesh/mesh.h"

#include <opensubdiv/osd/glComputeEvaluator.h>

#include <memory>
#include <optional>
#include <vector>

namespace OpenSubdivHex::Tools {

/// Who makes the vertices of a level in each frame.
enum class ViewEvaluator {
    Cpu,    ///< OsdExt::RefinementEvaluator
    OpenGl, ///< OsdExt::GLRefinementEvaluator
    Tables  ///< Osd::GLComputeEvaluator, by a stencil table
};

/// How far cells are refined: see BfrExt::View.
struct CellSettings {
    float pixelError = 0.5;
    int maxLevel = 8;
    bool isCulling = false;
};

/// \brief The settings that the topology of a surface depends on.
struct SurfaceSettings {
    int level = 2;
    FarExt::HexSchemeOptions scheme;
    Sdc::Options::VtxBoundaryInterpolation boundary = Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER;
    bool isLimit = false;
    std::optional<double> creaseAngle; ///< degrees
    ViewEvaluator evaluator = ViewEvaluator::Cpu;
    bool isAdaptive =
        false;          ///< in place of level, isLimit and evaluator: cells that a camera needs
    CellSettings cells; ///< for Follow()
    bool arePatches = false; ///< in place of isLimit and evaluator: the patches of the level
};

/// \brief A mesh with its refined level, or the cells that a camera needs, in buffers of OpenGL.
///
/// Vertices are drawn by side: one that a crease splits for shading has several normals.
class ViewedSurface {
public:
    explicit ViewedSurface(Mesh mesh);

    /// \brief Refines anew, and evaluates.  Throws std::runtime_error with the cause, and leaves all
    /// as it was, where the mesh cannot be refined so.
    void Refine(SurfaceSettings const &settings);

    Mesh const &GetMesh() const { return _mesh; }
    /// x y z of each control vertex; followed by Evaluate().
    std::vector<float> &GetControlPoints() { return _controlPoints; }
    /// The edges of the control mesh, two vertices each.
    std::vector<unsigned> const &GetControlEdges() const { return _controlEdges; }

    /// Makes the vertices of the level and their normals from the control points; cells are left to
    /// Follow().
    void Evaluate();
    /// \brief Where there are cells: refines those that a camera needs, unless it is the one of the last
    /// call and so are the control points; and evaluates them.
    ///
    /// \param isFrozen  leaves cells as they are, where there are any
    void Follow(BfrExt::Camera const &camera, CellSettings const &settings, bool isFrozen = false);

    /// Null without cells.
    CellView const *GetCells() const { return _cells.get(); }
    /// Null without patches, which are drawn in place of triangles.
    PatchView const *GetPatches() const { return _patches.get(); }
    int GetNumVertices() const {
        return _patches ? _patches->GetNumPoints() : int(_points.GetSize() / 3);
    }
    int GetNumFaces() const { return _patches ? _patches->GetNumPatches() : _numFaces; }
    int GetNumTriangles() const { return int(_cornerSides.GetSize() / 3); }
    int GetNumEdges() const { return int(_edgeSides.GetSize() / 2); }
    /// Milliseconds of the last Evaluate(), with the normals; of cells, with finding them.
    double GetMilliseconds() const { return _milliseconds; }

    /// Binds the arrays that the shaders of drawings read.
    void Bind() const;
    /// Binds the edges in the place of the corners of triangles.
    void BindEdges() const;

private:
    void setTopology(DrawnTopology const &drawn);
    void makeNormals(bool areNormalsThere) const;

    Mesh _mesh;
    std::vector<float> _controlPoints;
    std::vector<unsigned> _controlEdges;
    SurfaceSettings _settings;

    std::unique_ptr<FarExt::TopologyRefiner> _refiner;
    std::unique_ptr<OsdExt::RefinementEvaluator> _cpuEvaluator;
    std::unique_ptr<OsdExt::GLRefinementEvaluator> _glEvaluator;
    std::unique_ptr<OpenSubdiv::Osd::GLStencilTableSSBO> _glTable;
    std::unique_ptr<OpenSubdiv::Osd::GLComputeEvaluator> _tableEvaluator;
    std::unique_ptr<CellView> _cells;
    std::unique_ptr<PatchView> _patches;
    BfrExt::Camera _camera; // that the cells are for
    CellSettings _cellSettings;
    bool _hasMoved = false; // control points, since Follow()
    int _numFaces = 0;

    GlArray _controlArray;
    GlArray _points;       // of the level
    GlArray _sideVertices; // the vertex of each side
    GlArray _normals;      // by side, with the mean curvature behind
    GlArray _firstFans;    // by side, and the end: positions in _fans
    GlArray _fans;         // the sides before and behind in each polygon around
    GlArray _cornerSides;  // of triangles
    GlArray _coords;       // u and v by corner
    GlArray _faces;        // base face and level by triangle
    GlArray _edgeSides;    // two for each edge that is drawn
    ViewProgram _normalProgram;
    double _milliseconds = 0;
};

} // namespace OpenSubdivHex::Tools

#endif

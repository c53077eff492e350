// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_ANALYSIS_SURFACE_LEVELS_H
#define OPENSUBDIVHEX_REGRESSION_ANALYSIS_SURFACE_LEVELS_H

#include "meshCenter.h"

#include "far_ext/topologyRefiner.h"
#include "regression/shapes/shapes.h"

#include <opensubdiv/sdc/options.h>
#include <opensubdiv/sdc/types.h>

#include <Eigen/Core>

#include <array>
#include <variant>
#include <vector>

namespace OpenSubdivHex::Regression {

/// \brief A refined mesh with positions in double precision, of any scheme.
struct PolygonMesh {
    std::vector<Eigen::Vector3d> positions;
    std::vector<int> faceFirst; ///< number of faces + 1 positions in faceVertices
    std::vector<int> faceVertices;
    std::vector<std::array<int, 2>> edgeFaces; ///< of each edge with two faces
    int numEdges = 0;                          ///< all
    std::vector<int> vertexFirst;              ///< number of vertices + 1 positions in vertexFaces
    std::vector<int> vertexFaces;

    int GetNumVertices() const { return int(positions.size()); }
    int GetNumFaces() const { return int(faceFirst.size()) - 1; }
    int GetFaceSize(int face) const { return faceFirst[face + 1] - faceFirst[face]; }
    int GetFaceVertex(int face, int corner) const { return faceVertices[faceFirst[face] + corner]; }
};

/// One of this library's schemes, or one of OpenSubdiv's: Catmull-Clark or Loop.
using AnyScheme = std::variant<FarExt::HexSchemeOptions, OpenSubdiv::Sdc::SchemeType>;

struct SurfaceLevel {
    PolygonMesh mesh;
    MeshCenter center;
};

/// \brief Levels 0 ... \p maxLevel of a shape, its topology and positions, refined by this library
/// or by Far.  Tags of the shape are obeyed, boundaries refined by the options' defaults.
///
/// \param center  followed from level to level, if any
/// \throws std::runtime_error  for a shape that the scheme does not take, as Loop other faces than
///         triangles, and for a face as center in Loop
std::vector<SurfaceLevel> RefineSurface(Shape const &shape, AnyScheme const &scheme, int maxLevel,
                                        MeshCenter center = MeshCenter(),
                                        OpenSubdiv::Sdc::Options sdcOptions = {});

/// \brief Refines with FaceMask::Smooth, but without its masks around irregular vertices and beside quads:
/// all hexagons without something sharp have one mask.  Shows the effect of these masks.
std::vector<SurfaceLevel> RefineWithOneMask(Shape const &shape, int maxLevel,
                                            OpenSubdiv::Sdc::Options sdcOptions = {});

/// The levels of a refiner of that shape which has been refined, in full, in another way.
std::vector<SurfaceLevel> MakeSurfaceLevels(FarExt::TopologyRefiner const &refiner,
                                            Shape const &shape, MeshCenter center = MeshCenter());

/// \brief A bipyramid over \p n sides whose ring is a saddle and whose upper tip, vertex n + 1, is
/// low: a control mesh that every scheme takes, with an irregular vertex where bowl and saddle mix.
Shape MakeSaddleBipyramid(int n);

} // namespace OpenSubdivHex::Regression

#endif

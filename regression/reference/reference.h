// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_REFERENCE_REFERENCE_H
#define OPENSUBDIVHEX_REGRESSION_REFERENCE_REFERENCE_H

#include "irregularReference.h"

#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/Mesh/Traits.hh>

#include <Eigen/Core>

#include <map>
#include <vector>

namespace OpenSubdivHex::Regression {

struct ReferenceTraits : OpenMesh::DefaultTraits {
    using Point = OpenMesh::Vec3d;
};

/// A polygon mesh with positions in double precision.
struct ReferenceMesh : OpenMesh::PolyMesh_ArrayKernelT<ReferenceTraits> {
    int numSteps = 0; ///< that made it
    /// By vertex of a refined mesh: of those that the base mesh had, what their faces were there.
    std::vector<FormerFaces> formerFaces;
    /// By half-edge of a refined mesh: what it came from at its start, and at its end.
    std::map<int, QuadPath> pathsOfStart;
    std::map<int, QuadPath> pathsOfEnd;
};

/// Values of any width, one row per vertex.
using ReferenceValues = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// The rule for new points.
enum class ReferenceMask { Average, Cosine, Smooth };

/// \brief The origin of a vertex, in terms of the mesh before.
struct ReferenceVertexOrigin {
    bool isFVertex = false; ///< made at a corner of a face, else an old vertex that was moved
    int vertex = -1;        ///< the old vertex; of an F-vertex the one beside it
    int face = -1;          ///< of an F-vertex its face
};

/// \brief The origin of a face, in terms of the mesh before.
struct ReferenceFaceOrigin {
    bool isEFace = false;        ///< made for an edge, else the smaller copy of a face
    int face = -1;               ///< of an F-face
    int edgeVertices[2]{-1, -1}; ///< of an E-face: the ends of the edge, as its first face runs
};

/// \brief One refined mesh and where its parts came from.  The numbering is not that of the
/// library: new points come first (stage 1), then the moved vertices (stage 2).
struct ReferenceLevel {
    ReferenceMesh mesh;
    std::vector<ReferenceVertexOrigin> vertexOrigins;
    std::vector<ReferenceFaceOrigin> faceOrigins;
};

/// \brief The base mesh; vertices and faces keep their numbers.  \p positions are x, y, z each.
///
/// Throws std::runtime_error if OpenMesh does not take a face, as it does not where an edge has
/// more than two faces or two that run it the same way, and if a vertex has more than one fan of
/// faces.
ReferenceMesh MakeReferenceMesh(std::vector<double> const &positions,
                                std::vector<int> const &faceSizes,
                                std::vector<int> const &faceVertices);

/// \brief One step of the paper's scheme, its three stages one after the other, with its rule for
/// boundaries (VTX_BOUNDARY_NONE).  The points of the result are refined positions.
ReferenceLevel Refine(ReferenceMesh const &mesh, ReferenceMask mask);

/// \brief Stages 1 and 2 for any values on the vertices of \p mesh, a row each; \p child must come
/// from Refine(mesh, ...) with any mask.
ReferenceValues Interpolate(ReferenceMesh const &mesh, ReferenceLevel const &child,
                            ReferenceMask mask, ReferenceValues const &values);

/// \brief Linear interpolation: an old vertex keeps its value, a new point is halfway between its
/// vertex and the centroid of its face.
ReferenceValues InterpolateVarying(ReferenceMesh const &mesh, ReferenceLevel const &child,
                                   ReferenceValues const &values);

/// The new point beside corner \p i of a face, from the values at the face's corners.
Eigen::RowVectorXd NewPoint(ReferenceMask mask, std::vector<Eigen::RowVectorXd> const &face, int i);

/// NewPoint() for linear interpolation.
Eigen::RowVectorXd NewVaryingPoint(std::vector<Eigen::RowVectorXd> const &face, int i);

/// The points of a mesh as values of width 3.
ReferenceValues GetPoints(ReferenceMesh const &mesh);

} // namespace OpenSubdivHex::Regression

#endif

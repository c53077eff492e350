// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_REFERENCE_TAGGED_REFERENCE_H
#define OPENSUBDIVHEX_REGRESSION_REFERENCE_TAGGED_REFERENCE_H

#include "reference.h"

#include <vector>

namespace OpenSubdivHex::Regression {

/// Sharpness from which on an edge or vertex stays sharp for ever.
inline constexpr float kInfiniteSharpness = 10;

/// The schemes, each by its definition.
enum class ReferenceScheme { Hexagonal, DooSabin, TriHex, Truncate };

/// \brief A mesh with boundaries, creases, corners, holes and flaws, whose
/// rules are taken at their word: a sharp line goes along edges.
///
/// So a polygon that a crease crosses is two half faces, glued along a *long* edge, until the
/// crease is smooth; a half face at a sharp boundary has a long edge without another side.  A half face
/// of k + 1 vertices is half of a polygon of 2k.  Edges
/// name their sides, so that several may join the same two vertices.
struct TaggedMesh {
    struct Face {
        std::vector<int> vertices;
        std::vector<int> edges;  ///< edge i from vertex i to vertex i + 1
        bool isHalf = false;     ///< half a polygon, mostly a hexagon; edge 0 the long one
        std::vector<bool> holes; ///< by edge: whether the face is a hole there
        /// By place: what the face's edges from there and to there came from; see QuadPath.
        std::vector<QuadPath> pathsOut;
        std::vector<QuadPath> pathsIn;
        std::vector<LinePaths> linesOut; ///< likewise, beside lines of quads
        std::vector<LinePaths> linesIn;
    };
    /// Where a face runs along an edge: from its corner \p place to the next.
    struct Side {
        int face;
        int place;
    };
    struct Edge {
        std::vector<Side> sides; ///< one of a boundary, two of an interior edge
        bool isLong = false;     ///< phase B
        bool isFree = false;     ///< a boundary that follows the paper's rule
        int line = -1; ///< the same for all boundaries of a base edge that came apart; else -1
        float sharpness = 0; ///< infinite for boundaries that are not free
        /// Behind a truncation, of a line: how sharp it is as far as long and short pieces follow one another.
        float regularLine = 0;
    };
    struct Vertex {
        float sharpness = 0;
        bool isNonManifold = false;
        FormerFaces formerFaces = FormerFaces::Mixed; ///< when hexagonal steps began
        std::vector<Side> corners; ///< faces of the vertex, and where it is in them
    };
    /// The origin of a vertex: an old vertex, or the corner of a face.
    struct VertexOrigin {
        int vertex = -1;
        int face = -1;
        int place = -1;
        bool isFar = false; ///< of a truncation: at the end of the edge that begins in the corner
    };
    /// \brief The origin of a face: a face, an edge seen from one of its sides, or a vertex.
    /// A hexagon made for an edge has the side that its first vertices start on.
    struct FaceOrigin {
        int face = -1;
        int edge = -1;
        int vertex = -1;
        int side = 0;
        int mergedWith = -1; ///< of two half faces that became one, the origin of the other
    };

    std::vector<Face> faces;
    std::vector<Edge> edges;
    std::vector<Vertex> vertices;
    bool chaikin = false;
    bool freeBoundaries = false; ///< boundaries that other schemes cut follow the paper's rule

    // For a refined mesh.
    ReferenceScheme madeBy = ReferenceScheme::Hexagonal;
    int numHexagonalSteps = 0; ///< that made it, behind the last step of another scheme
    bool hasFirstLines = true; ///< no step of another scheme made it or a mesh before it
    std::vector<VertexOrigin> vertexOrigins;
    std::vector<int> vVertices;              ///< the child of each parent vertex, or -1
    std::vector<std::vector<int>> fVertices; ///< the new vertex of each corner of each parent face
    std::vector<FaceOrigin> faceOrigins;
    std::vector<FaceOrigin> mergedOrigins; ///< see FaceOrigin::mergedWith

    int GetStart(Side side) const { return faces[side.face].vertices[side.place]; }
    int GetEnd(Side side) const {
        std::vector<int> const &face = faces[side.face].vertices;
        return face[(side.place + 1) % face.size()];
    }
};

/// \brief A base mesh with tags, labels and channels.
struct TaggedBase {
    int numVertices = 0;
    std::vector<int> faceSizes;
    std::vector<int> faceVertices;
    std::vector<int> creasePairs;
    std::vector<float> creaseSharpness;
    std::vector<float> vertexSharpness; ///< by vertex; infinite for those that are to stay
    std::vector<int> holes;
    std::vector<int> nonManifoldPairs; ///< edges that come apart in any case, two vertices each
    bool freeBoundaries = false;       ///< the paper's rule for boundaries
    bool chaikin = false;
};

/// \brief The mesh of a base.  An edge that is no boundary and does not join two faces that run it
/// in opposite directions comes apart into a sharp boundary for each face.
///
/// A vertex where such an edge ends, or whose faces are not one fan, is non-manifold.  It stays,
/// unless exactly two such edges and no boundary end there and it has more faces than the base has
/// edges there: a curve that several sheets share goes on through it.  One that a face has several
/// times stays, and so do the ends of an edge that a face runs twice.
TaggedMesh MakeTaggedMesh(TaggedBase const &base);

/// \brief A face-varying channel as a mesh: that of \p mesh, cut where the values on both sides of
/// an edge differ.  Each fan of faces that share a value is a vertex.
///
/// \param valueIndices     value of each corner, face by face
/// \param valueSharpness   by corner; infinite for values that stay
/// \param valuesOfVertices gets the value of each vertex of the result
TaggedMesh MakeValueMesh(TaggedMesh const &mesh, std::vector<int> const &valueIndices,
                         std::vector<float> const &valueSharpness,
                         std::vector<int> &valuesOfVertices);

/// \brief The effect of a truncation on the polygons of vertices.
struct ReferenceCuts {
    /// By face and place: whether the edge that begins there cuts the polygon of the vertex there.
    std::vector<std::vector<bool>> cuts;
    /// By face and place: whether a sharp line goes through the vertex there, which is not kept: the line
    /// runs through its polygon from one edge to the other.
    std::vector<std::vector<bool>> isPassed;
};

/// \brief Where the truncation of a base mesh cuts polygons, so that faces stay apart which \p values,
/// the value meshes of its channels, or holes part, and that creases go on.
ReferenceCuts FindCuts(TaggedMesh const &mesh, std::vector<TaggedMesh> const &values);

/// How a mesh is refined once.
struct ReferenceStep {
    ReferenceScheme scheme = ReferenceScheme::Hexagonal;
    /// By edge, of a hexagonal step: edges that make a quad of the four points beside them, as
    /// those of faces with the same normal do in the paper's stage 3.  Empty: none.
    std::vector<bool> flatEdges;
    /// Whether polygons close the gaps that quads leave around vertices.  The borders of gaps
    /// follow the paper's rule.
    bool closeGaps = true;
    /// For a truncation.
    ReferenceCuts cuts;
};

/// \brief One step: topology and tags.  Schemes but the hexagonal one drop the faces of boundary
/// edges and boundary vertices.  A vertex between two faces whose polygon would have two sides
/// makes none: the quads at either side of it meet.
TaggedMesh Refine(TaggedMesh const &mesh, ReferenceStep const &step = ReferenceStep());

/// \brief By edge: whether its two faces have normals that make an angle of at most
/// \p angleTolerance degrees, and it lies beside no tag, half face or flaw of the mesh.
std::vector<bool> FindFlatEdges(TaggedMesh const &mesh, ReferenceValues const &positions,
                                double angleTolerance);

/// How many sharp edges make which rule.
enum class TaggedRule { Smooth, Dart, Crease, Corner };
TaggedRule GetRule(TaggedMesh const &mesh, int vertex);

/// Whether the vertex stays for ever: it is infinitely sharp, or more than two such lines meet there.
bool IsPinned(TaggedMesh const &mesh, int vertex);

/// Values of Refine(mesh) from those of \p mesh, a row per vertex.
ReferenceValues Interpolate(TaggedMesh const &mesh, TaggedMesh const &child, ReferenceMask mask,
                            ReferenceValues const &values);
/// Linear, without regard to creases.
ReferenceValues InterpolateVarying(TaggedMesh const &mesh, TaggedMesh const &child,
                                   ReferenceValues const &values);

} // namespace OpenSubdivHex::Regression

#endif

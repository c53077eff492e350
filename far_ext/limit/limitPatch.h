// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_LIMIT_LIMIT_PATCH_H
#define OPENSUBDIVHEX_FAR_EXT_LIMIT_LIMIT_PATCH_H

#include "far_ext/hexSchemeOptions.h"
#include "far_ext/vtr/indexSet.h"
#include "far_ext/vtr/refinement.h"
#include "far_ext/vtr/vertexFan.h"

namespace OpenSubdivHex::FarExt::internal {

/// \brief The neighbourhood that determines the limit at a vertex: the faces around it and around its neighbours.
/// (Not so on free boundaries, where a neighbour stays a neighbour and has another beyond.)
///
/// The patch of a vertex makes the patch of its V-vertex: the faces there are the E-faces of its
/// edges, and the neighbours are its F-vertices, with the F-faces of its faces besides.  Their
/// vertices depend on faces of the parent patch alone, and so do their tags, but for Chaikin's rule,
/// for which it has sharpEnds.  Hence the steps from patch to patch give the limit.
///
/// The patch is a mesh of its own: vertex 0 is the one that it is made for, and it is cut off along
/// free boundaries.  Its numbering and content do not depend on those of the level, as far as that
/// is cheap to achieve: patches that look alike have the same signature.
///
/// A non-manifold vertex that stays a corner in all levels *comes apart* into a vertex for each of its
/// fans: what lies in one of them does not depend on the others, of which a pole may have thousands.
struct LimitPatch : CornerTags {
    using Index = Far::Index;

    std::vector<Index>
        sources; ///< the level's vertex of each vertex of the patch; some may come twice
    /// By side of the level's vertex, the side of vertex 0: in closed fans they begin elsewhere.
    std::vector<int> sides;

    std::vector<int> faceSizes;
    std::vector<Index> faceVerts;     ///< of all faces in turn
    std::vector<Index> otherCorners;  ///< by corner, across the edge from it; or a BoundaryKind
    std::vector<float> edgeSharpness; ///< by corner, of the edge from it; the same on both sides
    std::vector<float> diagonalSharpness;  ///< by face
    std::vector<CrossedFace> crossedFaces; ///< ascending; those with a sharp diagonal
    std::vector<float> vertSharpness;      ///< by vertex
    std::vector<Index> nonManifoldVerts;   ///< ascending
    std::vector<Index> lineCorners;        ///< ascending; those whose edge has a line
    std::vector<Index> lines;              ///< of these, in the order of their first corners
    std::vector<SharpVertex> sharpVerts;   ///< ascending; of vertex 0 and its neighbours
    /// With Chaikin's rule, of the vertices further out where semi-sharp edges of these end.
    std::vector<SharpEnd> sharpEnds;
    std::vector<IrregularVertex> irregularVerts; ///< ascending; of vertex 0 and its neighbours
    /// As of the level, as long as it matters for the masks of this patch or of those that it makes.
    int numHexagonalSteps = 0;
    bool hasFirstLineMasks = false; ///< likewise

    /// All of the above but the sources, the sides, the weights of sharpVerts and irregularVerts, which
    /// follow from the rest.  Which copies of a line's vertices sharpVerts have as neighbors does not.
    std::vector<int> signature;
};

/// Whether a vertex of a level with full topology comes apart in patches.
OPENSUBDIVHEX_API bool ComesApart(Level const &level, Far::Index vert);
/// The faces that the patches around a vertex have together, of one of its fans where it comes apart.
int CountFacesTogether(Level const &level, Far::Index vert);
/// Faces that a vertex may have which comes apart: its fans are looked for among all of them.
inline constexpr int kMaxFacesApart = 4096;

/// \brief Cuts patches out of a level, which has full topology.
class LimitPatchGatherer {
public:
    using Index = Far::Index;

    /// Gathers in a level that is refined with \p faceMask.
    LimitPatchGatherer(Level const &level, Sdc::Options sdcOptions, FaceMask faceMask)
        : _level(level), _creasing(sdcOptions), _faceMask(faceMask) {}

    /// The patch of a vertex, with all of its fans.
    void Gather(Index vert, LimitPatch &patch);
    /// The patch of a vertex that comes apart, with the fan of one of its corners.
    void GatherFan(Index corner, LimitPatch &patch);

    /// \brief Gathers what the surface of a cell depends on: the faces around its corners and around
    /// their neighbours, in one patch without a signature.  Its first vertices are those at the corners, in their order.
    ///
    /// \param locals  the corners, as places in the face, which is face 0 of the patch
    /// \return        where in the face it begins in the patch
    int GatherCell(Index face, int const *locals, int numCorners, LimitPatch &patch);

private:
    void clear(LimitPatch &patch);
    bool comesApart(Index vert);
    Index findKey(Index corner);
    Index findVertex(Index corner);
    Index findEndVertex(Index edge, int end);
    Index findCornerBeside(Index vert, Index neighbor) const;
    Index findEndCorner(Index edge, int end) const;
    Index addVertex(Index corner, LimitPatch &patch);
    template <typename FUNCTION>
    void forEachFanOf(int vert, LimitPatch const &patch, FUNCTION const &function);
    void addNeighborhood(int numCenters, LimitPatch &patch);
    int findCenterEdge(Index neighbor, Index firstEdge, int numEdges, int numCenters);
    void orderFans(LimitPatch &patch);
    int findFirstFace(VertexFan const &fan, int &firstSide);
    void addFace(Index face, int local, bool isRing, LimitPatch &patch);
    void addEdge(Index corner, Index nextCorner, LimitPatch &patch);
    void addTags(LimitPatch &patch);
    void addSharpVertices(LimitPatch &patch);
    void addSharpEnds(LimitPatch &patch);
    void addIrregularVertices(LimitPatch &patch);
    static void addSignature(LimitPatch &patch);
    int countSteps(LimitPatch const &patch) const;
    bool hasIrregularities(LimitPatch const &patch) const;

    Level const &_level;
    Sdc::Crease const _creasing;
    FaceMask const _faceMask;
    Index _whole = Far::INDEX_INVALID; // the vertex that does not come apart
    IndexMap _apart;                   // whether a non-manifold vertex does
    IndexMap _fanKeys;                 // of vertices that do: the key of each of their corners
    // Numbers in the patch.
    IndexMap _verts; // by key
    IndexMap _faces;
    IndexMap _edges; // the first corner of each
    // Vertices, the first ones, all of whose faces are in the patch; 0 until they have numbers.
    int _numComplete = 0;
    std::vector<Index> _corners; // the level's corner of each corner of the patch
    std::vector<Index> _lines;   // the level's line of each line of the patch
    // Positions in vertFaces, and edges, of the vertices that the patch is for.
    std::vector<Index> _ringFaces;
    std::vector<Index> _ringEdges;
    FanItems _fan = {{}, false};
};

/// Makes a level of a patch, with all that a step of refinement needs.
void BuildPatchLevel(LimitPatch const &patch, Level &level);

/// \brief A step from a patch to that of the V-vertex of its vertex 0, as a sparse matrix.
struct PatchRefinement {
    int numParentVerts = 0;
    std::vector<int> firsts; ///< by vertex of the child patch, and the end
    std::vector<int> verts;  ///< of the parent patch
    std::vector<double> weights;
    std::vector<int> sides; ///< which side of the child patch each side of the parent becomes

    /// result = left A: what the vertices of the child patch weigh, in terms of the parent's.
    OPENSUBDIVHEX_API void ApplyLeft(std::vector<double> const &left,
                                     std::vector<double> &result) const;
    /// result = A right: values of the child patch's vertices from those of the parent's.
    void ApplyRight(std::vector<double> const &right, std::vector<double> &result) const;
};

/// The vertices \p cVerts of a child, whose parent is a patch's level, in terms of the parent's.
PatchRefinement MakePatchStep(Refinement const &refinement, HexSchemeOptions const &schemeOptions,
                              Interpolation interpolation, std::vector<Far::Index> const &cVerts);

/// Refines \p pPatch to \p cPatch.
PatchRefinement RefinePatch(LimitPatch const &pPatch, Sdc::Options sdcOptions,
                            HexSchemeOptions const &schemeOptions, LimitPatch &cPatch);

/// \brief The faces at a vertex between two infinitely sharp edges, or all around it: the limit
/// surface has a tangent plane for each.  A fan of faces with fewer than two such edges is one
/// side.
struct VertexSide {
    /// From the edge (or diagonal) where the side begins, counter-clockwise to that where it ends;
    /// of a closed fan that is one side, from its sharp edge, where it has one, to the last face.
    std::vector<FanItem> items;
    bool isAllAround;
    int fan;
};

/// The sides of a vertex, in the order of its fans; in a closed fan from the first sharp edge on.
std::vector<VertexSide> FindVertexSides(Level const &level, Far::Index vert);

} // namespace OpenSubdivHex::FarExt::internal

#endif

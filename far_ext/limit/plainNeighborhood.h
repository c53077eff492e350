// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_LIMIT_PLAIN_NEIGHBORHOOD_H
#define OPENSUBDIVHEX_FAR_EXT_LIMIT_PLAIN_NEIGHBORHOOD_H

#include "far_ext/vtr/indexSet.h"
#include "far_ext/vtr/level.h"

#include <string>
#include <vector>

namespace OpenSubdivHex::FarExt::internal {

/// \brief The neighbourhood that determines the limit at a vertex without features: a short LimitPatch.
///
/// The sources are those of the patch, in the same order, and patches of the same key have the same
/// limit mask.  So the mask of a key is found from the patch of one vertex that has it.
struct PlainNeighborhood {
    std::vector<Far::Index> sources;
    std::string key;
};

/// \brief The features at a vertex, or in the faces around it.
enum class VertexMark : unsigned char {
    Plain,
    Irregular, ///< irregular corners alone
    Feature    ///< something sharp, a boundary or several fans
};

/// \brief A mark for each vertex of a level; none where all are plain.
///
/// Feature are those that are on a boundary or not manifold, sharp, on sharp edges, or in faces that have
/// features; Irregular others in faces with irregular corners.  The level keeps them.
OPENSUBDIVHEX_API std::vector<VertexMark> const &GetVertexMarks(Level const &level);

/// \brief Gathers the neighbourhoods of the vertices of a level, which has full topology.
///
/// A vertex is *regular* when it and its neighbours have three faces each, all these are plain
/// hexagons, and all their vertices are different: two steps after a level nearly all vertices are.
class PlainNeighborhoodGatherer {
public:
    using Index = Far::Index;

    /// Vertices that a regular vertex depends on.
    static constexpr int kNumRegular = 22;

    explicit PlainNeighborhoodGatherer(Level const &level)
        : _level(level), _marks(GetVertexMarks(level)) {}

    /// \brief Gathers the neighbourhood of \p vert.
    ///
    /// \return  false where there is a feature, or something that a key cannot tell; then the
    ///          result is of no use
    bool Gather(Index vert, PlainNeighborhood &result);

    /// \brief The neighbourhood of a face: the faces around its vertices and around their neighbours.  Its vertices
    /// are the first sources, in their order.
    ///
    /// The key tells, too, of which of its vertices the face is the first one.
    bool GatherFace(Index face, PlainNeighborhood &result);

    bool IsRegular(Index vert) const;
    /// The sources alone, of a vertex that is regular.
    static void GatherRegular(Level const &level, Index vert, Index sources[kNumRegular]);

private:
    bool hasFeature(Index vert) const {
        return !_marks.empty() && _marks[std::size_t(vert)] == VertexMark::Feature;
    }
    int findFirstFace(Index vert);
    bool addFace(Index face, int local, PlainNeighborhood &result);
    bool addOuterFaces(int neighbor, PlainNeighborhood &result);
    bool addFacesFrom(Index vert, int first, bool isKeyOfAll, PlainNeighborhood &result);
    bool addFacesAround(Index vert, PlainNeighborhood &result);
    void addCornerTags(Index face, int local, bool isRing, PlainNeighborhood &result) const;

    Level const &_level;
    std::vector<VertexMark> const &_marks;
    IndexMap _numbers;             // of the sources
    std::vector<Index> _faces;     // that have been added, those around the vertex first
    std::vector<Index> _neighbors; // of the vertex
};

} // namespace OpenSubdivHex::FarExt::internal

#endif

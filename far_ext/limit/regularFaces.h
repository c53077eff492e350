// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_LIMIT_REGULAR_FACES_H
#define OPENSUBDIVHEX_FAR_EXT_LIMIT_REGULAR_FACES_H

#include "limitRows.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

namespace OpenSubdivHex::FarExt::internal {

constexpr int kRegularFaceSize = HexIndexing::kNumEFaceCorners;

/// \brief A hexagon all of whose vertices are regular, as PlainNeighborhoodGatherer says: what the
/// limit at its F-vertices depends on, besides its own vertices.  All is given by its corners.
///
///     previous  next         A vertex V of the face has an outer neighbour, beyond which there is
///           \   /            a face that neither has V nor shares an edge with the regular face;
///          neighbor          there it has the vertices "next" and "previous", which the faces across
///             |              the edges behind V and before V have, too.
///             V
///
/// Where only some of its vertices are regular, the others have an outer neighbour perhaps, but no face
/// beyond: there it is the face itself.
struct RegularFace {
    /// Vertices of the face beyond a corner that are in no other face around.
    static constexpr int kNumOthers = 3;

    bool HasCorner(int corner) const { return (corners >> corner & 1) != 0; }
    /// The others of the face beyond a corner, from that behind "previous" on; where there is no face beyond,
    /// any vertices.
    Far::Index GetOther(Level const &level, int corner, int number) const {
        Far::Index const *const verts =
            level.faceVerts.data() + level.faceFirstCorner[beyond[corner]];
        auto const local =
            int(std::find(verts, verts + kRegularFaceSize, neighbors[corner]) - verts);
        return verts[(local + 2 + number) % kRegularFaceSize];
    }

    Far::Index firstCorner;
    unsigned corners; ///< a bit for each corner whose vertex has a limit of the face's mask
    Far::Index neighbors[kRegularFaceSize];
    Far::Index next[kRegularFaceSize];
    Far::Index previous[kRegularFaceSize];
    Far::Index beyond[kRegularFaceSize]; ///< faces
};

/// \brief The limit at the F-vertices of a regular face, or at its own vertices, as sums of vertices of
/// its own level, alike for all regular faces of the level: weights for corner 0, those for the
/// others are as many places further around.
///
/// A pair is "next" of corner i and "previous" of corner i + 1, two vertices of one face.
struct RegularFaceMask {
    static constexpr int kNumSums = 3; ///< of the point, du and dv

    struct Sum {
        double verts[kRegularFaceSize];
        double neighbors[kRegularFaceSize];
        double pairs[kRegularFaceSize];
        double next; ///< of corner 0, on top of what it weighs in its pair
        double previous;
        double others; ///< the others of the face beyond corner 0
    };
    Sum sums[kNumSums];
};

/// \brief The vertices of a level whose limit follows from faces of that level or of one before, for
/// all six of a face together.
///
/// In a regular face these are the F-vertices, so that the level of the face will do, which is
/// smaller.  Other F-vertices are regular, too: where faces near theirs are no hexagons, or have
/// irregular vertices.  Their limit follows from the F-face that they are the vertices of, some of
/// which may be irregular.
class OPENSUBDIVHEX_API RegularFaces {
public:
    using Index = Far::Index;

    /// \brief Faces of a level that have a mask in common.
    struct Set {
        std::vector<RegularFace> faces;
        Index firstVertex = 0; ///< vertex firstVertex + c has the limit of corner c
        RegularFaceMask mask = {};

        std::size_t sample = 0; ///< the face and the corner from which the mask is found
        int sampleCorner = 0;
    };
    struct OfLevel {
        Set fVertices;   ///< regular faces, for their F-vertices
        Set ownVertices; ///< F-faces whose parent is not regular, for their own vertices
    };

    /// Finds the faces of \p level, one for which CheckLimitLevel() is well, and of all before.
    ///
    /// \param isMade  a mark for each vertex of the level whose limit nobody wants, as it is made
    ///                otherwise; empty where there is none
    RegularFaces(MeshLevels const &mesh, int level, std::vector<unsigned char> isMade = {});

    /// \brief Finds the masks of all levels, and the rows that the other vertices of the level need:
    /// what GetOthers() lists.
    ///
    /// Where a mask has not the form of a RegularFaceMask, as that of FaceMask::Cosine has not, no face
    /// is regular.
    CallStatus FindMasks(HexSchemeOptions const &schemeOptions, LimitRows &rows);

    /// By level, from 0 to the last one.
    std::vector<OfLevel> const &GetLevels() const { return _levels; }
    /// The other vertices of the last level, ascending.
    std::vector<Index> const &GetOthers() const { return _others; }

private:
    void setFaces(int level, std::vector<RegularFace> faces, Index firstVertex, Set &set) const;
    bool makesNothing(RegularFace const &face, Index firstVertex) const;
    void listOthers();
    std::optional<RegularFaceMask> findMask(int level, Set const &set,
                                            HexSchemeOptions const &schemeOptions,
                                            LimitRows const &rows) const;

    MeshLevels const &_mesh;
    int const _level;
    std::vector<unsigned char> const _isMade;
    std::vector<OfLevel> _levels;
    std::vector<Index> _others;
};

} // namespace OpenSubdivHex::FarExt::internal

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_LIMIT_REGULAR_FACES_H
#define OPENSUBDIVHEX_FAR_EXT_LIMIT_REGULAR_FACES_H

#include "limitRows.h"

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
struct RegularFace {
    Far::Index firstCorner;
    Far::Index neighbors[kRegularFaceSize];
    Far::Index next[kRegularFaceSize];
    Far::Index previous[kRegularFaceSize];
    Far::Index beyond[kRegularFaceSize]; ///< faces
};

/// \brief The limit at the F-vertices of a regular face as sums of vertices of its own level, alike
/// for all regular faces of the level: weights for the F-vertex of corner 0, those for the others
/// are as many places further around.
///
/// A pair is "next" of corner i and "previous" of corner i + 1, two vertices of one face.  The tip is
/// "next" and "previous" of corner 0, and beyondOfTip times the sum of the face beyond.
struct RegularFaceMask {
    static constexpr int kNumSums = 3; ///< of the point, du and dv

    struct Sum {
        double verts[kRegularFaceSize];
        double neighbors[kRegularFaceSize];
        double pairs[kRegularFaceSize];
        double tip;
    };
    Sum sums[kNumSums];
    double beyondOfTip;
};

/// \brief The rows of the F-vertices of regular faces, in terms of the vertices of their level.
struct RegularFaceRows {
    /// Those of the face, their neighbours, "next", "previous" and the others of the face beyond.
    static constexpr int kNumSources = 4 * kRegularFaceSize + 3;

    explicit RegularFaceRows(RegularFaceMask const &mask);

    /// Of the F-vertex of a corner.  Valid until \p sources are used again.
    LimitRow GetRow(Level const &level, RegularFace const &face, int corner,
                    Far::Index sources[kNumSources]) const;

private:
    double _weights[RegularFaceMask::kNumSums][kNumSources];
};

/// \brief The vertices of a level that steps before made of regular faces: their limit follows from
/// the level of their face, which is smaller, and for all six of a face together.
class OPENSUBDIVHEX_API RegularFaces {
public:
    using Index = Far::Index;

    struct OfLevel {
        std::vector<RegularFace> faces;
        std::size_t sample = 0; ///< the face from which the mask is found
        RegularFaceMask mask = {};
    };

    /// Finds the regular faces of all levels before \p level, one for which CheckLimitLevel() is
    /// well.
    RegularFaces(MeshLevels const &mesh, int level);

    /// \brief Finds the masks of all levels, and the rows that the other vertices of the level need:
    /// what GetOthers() lists.
    ///
    /// Where a mask has not the form of a RegularFaceMask, as that of FaceMask::Cosine has not, no face
    /// is regular.
    Status FindMasks(HexSchemeOptions const &schemeOptions, LimitRows &rows);

    /// By level, from 0 to the one before the last.
    std::vector<OfLevel> const &GetLevels() const { return _levels; }
    /// The other vertices of the last level, ascending.
    std::vector<Index> const &GetOthers() const { return _others; }

private:
    void listOthers();
    std::optional<RegularFaceMask> findMask(int level, HexSchemeOptions const &schemeOptions,
                                            LimitRows const &rows) const;

    MeshLevels const &_mesh;
    int const _level;
    std::vector<OfLevel> _levels;
    std::vector<Index> _others;
};

} // namespace OpenSubdivHex::FarExt::internal

#endif

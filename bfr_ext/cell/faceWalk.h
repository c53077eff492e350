// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_FACE_WALK_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_FACE_WALK_H

#include "far_ext/limit/plainNeighborhood.h"
#include "far_ext/vtr/level.h"

#include <mutex>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief A level as PlainFaceGatherer goes through it, face by face around vertices.
///
/// A *place* is a position in Level::vertFaces: that of a vertex in one of its faces.
class FaceWalk {
public:
    using Index = Far::Index;

    /// What a face has behind one of its vertices.
    struct Next {
        Index vert;
        Index place; ///< of that vertex in the same face
    };

    /// \param level  it has full topology, and must live as long
    explicit FaceWalk(FarExt::internal::Level const &level)
        : _level(level), _marks(FarExt::internal::MarkFeatures(level)) {}
    FaceWalk(FaceWalk const &) = delete;
    FaceWalk &operator=(FaceWalk const &) = delete;

    FarExt::internal::Level const &GetLevel() const { return _level; }
    /// Whether a feature is at a vertex.
    bool IsAtFeature(Index vert) const {
        return !_marks.empty() &&
               _marks[std::size_t(vert)] == FarExt::internal::VertexMark::Feature;
    }
    /// By place; made when it is first asked for, by whichever thread does so.
    Next const *GetNexts() const {
        std::call_once(_once, [this] { findNexts(); });
        return _nexts.data();
    }

private:
    void findNexts() const;

    FarExt::internal::Level const &_level;
    std::vector<FarExt::internal::VertexMark> const _marks; // empty where all vertices are plain
    mutable std::once_flag _once;
    mutable std::vector<Next> _nexts;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif

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

    /// The part of a face behind one of its vertices.
    struct Next {
        Index vert;
        Index place; ///< of that vertex in the same face
    };
    /// The faces of a vertex; none where plain faces have no such vertex: at features, and of too few or too many faces.
    struct Fan {
        int GetNumFaces() const { return end - first; }

        Index first; ///< place
        Index end;   ///< place behind the last
    };
    /// The arrays that the gatherer goes through.
    struct Arrays {
        FarExt::internal::Buffer<Index> places; ///< by corner
        FarExt::internal::Buffer<Next> nexts;   ///< by place
        FarExt::internal::Buffer<Fan> fans;     ///< by vertex
    };
    /// Faces of a vertex up to which it is in one of Arrays::fans.
    static constexpr int kMaxFaces = 255;

    /// \param level  it has full topology, and must live as long
    explicit FaceWalk(FarExt::internal::Level const &level)
        : _level(level), _marks(FarExt::internal::GetVertexMarks(level)) {
        findCrowds();
    }
    FaceWalk(FaceWalk const &) = delete;
    FaceWalk &operator=(FaceWalk const &) = delete;

    FarExt::internal::Level const &GetLevel() const { return _level; }
    /// Whether a feature is at a vertex.
    bool IsAtFeature(Index vert) const {
        return !_marks.empty() &&
               _marks[std::size_t(vert)] == FarExt::internal::VertexMark::Feature;
    }
    /// \brief A vertex with so many faces, or in so large a face, that surfaces around cost too much: the
    /// patch of each has all of them.
    struct Crowd {
        Index vert;
        Index
            face; ///< that which is too large; INDEX_INVALID where the faces of the vertex are too many
        int size;    ///< how many they are, or vertices of the face
        int maxSize; ///< up to which surfaces are made
    };
    /// The first one among the vertices of a face and their neighbours; null where there is none.
    Crowd const *FindCrowd(Index face) const;

    /// Made when they are first asked for, by whichever thread does so.
    Arrays const &GetArrays() const {
        std::call_once(_once, [this] { makeArrays(); });
        return _arrays;
    }

private:
    void findCrowds();
    Crowd const *findCrowdAt(Index vert) const;
    void makeArrays() const;

    FarExt::internal::Level const &_level;
    std::vector<FarExt::internal::VertexMark> const &_marks; // empty where all vertices are plain
    std::vector<Crowd> _crowds;                              // ascending
    mutable std::once_flag _once;
    mutable Arrays _arrays;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif

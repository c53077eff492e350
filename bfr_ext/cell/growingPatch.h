// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_GROWING_PATCH_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_GROWING_PATCH_H

#include <cstddef>
#include <cstdint>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief A patch that grows from a face, the faces of one vertex at a time, no vertices being the same but
/// where that follows from their numbers of faces.
///
/// It is a disc, of which it knows the boundary.  *Inner* vertices are those of the face and then their
/// neighbours, in the order in which they are met; what the others are numbered by is the order, too.
class GrowingPatch {
public:
    static constexpr int kMaxInner = 31;
    static constexpr int kMaxVerts = 256;

    /// \brief Where a vertex that is not inner was met: at an inner one, in the face at a place among those
    /// of that vertex, and the corner there, from the inner vertex on.
    struct Point {
        std::uint8_t vert;
        std::uint8_t place;
        std::uint8_t corner;
    };

    /// \brief Begins with a face of \p size sides.
    ///
    /// \param keepsFaces  for GetFaces(): benchmark making surfaces, irregular, is 1.3 times as fast without
    void Start(int size, bool keepsFaces);
    /// \brief Adds the faces that an inner vertex has not yet.
    ///
    /// \param numFaces  of the vertex
    /// \param sizes     of these faces, by their place; null: all are like the first face
    /// \return          false where no disc has such faces, or it is too large
    bool Add(int inner, int numFaces, std::uint8_t const *sizes);

    int GetNumInner() const { return _numInner; }
    /// Points that were met one behind the other in a face.
    struct Run {
        Point first;
        std::uint8_t numPoints;
    };
    /// Writes where the vertices that are not inner were met, kMaxVerts runs at most.
    /// \return  the end of what was written
    Run *GetRuns(Run *runs) const;
    /// The sizes and the vertices of the faces, inner vertices before others; and by corner, the corner across the edge
    /// from it, or -1.
    void GetFaces(std::vector<int> &sizes, std::vector<int> &verts, std::vector<int> &others) const;

private:
    // A face makes a vertex, or is the last of an inner one, and has three more than it makes at most.
    static constexpr int kMaxFaces = 1 + kMaxInner + kMaxVerts;
    static constexpr int kMaxFaceBytes = 4 * kMaxFaces + kMaxVerts;
    static constexpr int kMaxCorners = kMaxFaceBytes - kMaxFaces;

    struct Vertex {
        int before; // along the boundary
        int behind;
        int numFaces;
        int numFacesBefore; // from where its faces begin to the boundary before
        int inner;          // its number, or kNone
        int same;           // a vertex before, which it turned out to be, or kNone
    };
    static constexpr int kNone = -1;

    void link(int before, int behind) {
        _verts[before].behind = behind;
        _verts[behind].before = before;
    }
    bool isInner(int vert) const { return _verts[vert].inner != kNone; }
    bool isPoint(int vert) const { return !isInner(vert) && _verts[vert].same == kNone; }
    bool addInner(int vert, int numFacesBefore);
    bool addVertex(int last, Point const &point);
    bool join(int before, int behind);
    void keepFace(int vert, int last, int firstMade, int behind);
    void joinEdges(int corner, int other) {
        _others[corner] = std::int16_t(other);
        _others[other] = std::int16_t(corner);
    }

    int _size = 0;
    int _numInner = 0;
    int _numMade = 0;
    bool _keepsFaces = false;
    int _inner[kMaxInner] = {};
    Vertex _verts[kMaxVerts] = {};
    Point _points[kMaxVerts] = {};           // by vertex
    std::uint8_t _faces[kMaxFaceBytes] = {}; // of each its size and vertices
    int _numFaceBytes = 0;
    // By vertex, the corner whose edge is the boundary from there on.
    std::int16_t _corners[kMaxVerts] = {};
    std::int16_t _others[kMaxCorners] = {}; // by corner, that across its edge, or kNone
    int _numCorners = 0;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_DRAWING_VERTEX_SEPARATOR_H
#define OPENSUBDIVHEX_OSD_EXT_DRAWING_VERTEX_SEPARATOR_H

#include "osd_ext/polygonIndices.h"

#include <atomic>
#include <memory>
#include <vector>

namespace OpenSubdivHex::OsdExt::internal {

/// \brief Makes the vertices of polygons those of DrawnVertices, by comparing what their corners have.
///
/// Most vertices have the same in all corners, which is found in parallel; the corners that are left are
/// those along one side of seams and creases or, with places, of edges of the base mesh.
class VertexSeparator {
public:
    using Index = Far::Index;

    /// \param numVertices   the vertices of \p polygons are 0 ... numVertices - 1, plus the offset
    /// \param vertexOffset  DrawOptions::vertexOffset
    VertexSeparator(Index numVertices, Index vertexOffset, PolygonIndices &polygons);

    /// \return  TooLarge where indices do not reach; the polygons are then as they were
    FarExt::CallStatus Run();

private:
    // A vertex that is made, in addition to one that was there.
    struct Added {
        Index vert;   // the one that was there
        Index corner; // the first one that has it
        Index before; // in the list of all that were added to the same vertex, or negative
    };

    Index getVertex(Index corner) const;
    bool isSame(Index a, Index b) const;
    void findBaseFaces();
    void findFirstCorners();
    std::vector<Index> addVertices(std::vector<Index> const &corners);
    void describe();

    Index const _numVertices;
    Index const _vertexOffset;
    PolygonIndices &_polygons;
    std::vector<Index> _baseFaces; // by corner, as far as there are places in these
    std::unique_ptr<std::atomic<Index>[]>
        _firstCorners; // by vertex; the number of corners for none
    std::vector<Added> _added;
};

} // namespace OpenSubdivHex::OsdExt::internal

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_POLYGON_INDICES_H
#define OPENSUBDIVHEX_OSD_EXT_POLYGON_INDICES_H

#include "far_ext/limitStencilTableFactory.h"

#include <vector>

namespace OpenSubdivHex::OsdExt {

/// \brief The creases along which hexagons are cut.
enum class CreaseCuts {
    None,            ///< none cuts
    InfinitelySharp, ///< where LimitSides tells the two sides of a crease apart
    All              ///< semi-sharp ones too, at the levels where they are sharp
};

/// \brief What is drawn of a level, and where hexagons are cut in two: from vertex 0 to vertex 3, into
/// the halves of FarExt::kHexagonHalves.  Only an edge of level 0 ever crosses a face, so that a
/// hexagon is cut only where it has two base faces, or is half a hole; no cut adds vertices.
struct DrawOptions {
    /// Added to every vertex, for levels behind others in one buffer.
    int vertexOffset = 0;

    /// Cuts hexagons that lie in two base faces.  Where it is false, one that is not cut for another
    /// reason counts to the base face of its half 0.
    bool cutBaseFaces = true;
    /// A number for each base face, say that of its material: cuts hexagons whose halves have
    /// different ones.  Empty, or one for each face of level 0; not referred to afterwards.
    Far::ConstIndexArray labels{};
    /// Which creases cut hexagons.
    CreaseCuts cutCreases = CreaseCuts::All;
    /// Channels whose seams cut, in the order of DrawnFaces::fvarValues.
    std::vector<int> fvarChannels{};

    /// The sides of the level's vertices, for DrawnFaces::sides; infinitely sharp creases then cut
    /// in any case.  Null for none.
    FarExt::LimitSides const *sides = nullptr;
    /// Whether the vertices are those of \p sides in place of those of the level: a vertex that a
    /// crease splits for shading is then several, sides->GetNumSides() in all, of which
    /// sides->GetVertex() has the vertex of each.  A limit stencil table with generateFurtherSides
    /// has them in that order.
    bool splitVertices = false;
    /// Whether DrawnFaces::baseCoords are made; cuts as cutBaseFaces does.
    bool generateBaseCoords = false;

    /// Whether holes are drawn.  Else a hexagon with one half in a hole is drawn as the other half.
    bool drawHoles = false;
};

/// \brief Index buffers of drawn faces, without their sizes: by corner, one face after the other, and
/// by face.
struct DrawnFaces {
    /// @name By corner
    /// @{

    /// The vertices of the level, or sides (DrawOptions::splitVertices), plus the offset.
    std::vector<int> vertices;
    /// For each channel of DrawOptions::fvarChannels its values.
    std::vector<std::vector<int>> fvarValues;
    /// The side of the vertex, and so the normal: an index of LimitSides.  Empty without these.
    std::vector<int> sides;
    /// u and v in the base face, as TopologyLevel::GetFaceBaseCoords.  Empty unless asked for.
    std::vector<float> baseCoords;
    /// @}

    /// @name By drawn face
    /// @{

    /// The face of the level that it is, or is a part of.
    std::vector<int> faces;
    /// The face of level 0 that it lies in: TopologyLevel::GetFaceBaseFace.
    std::vector<int> baseFaces;
    /// The label of that.  Empty without labels.
    std::vector<int> labels;
    /// @}
};

/// \brief The faces of a level as polygons.
struct PolygonIndices : DrawnFaces {
    /// Corners of each polygon: those of its face, or four of half a hexagon.
    std::vector<int> sizes;

    /// How many there are.
    int GetNumPolygons() const { return int(sizes.size()); }
};

/// \brief Makes the polygons that draw \p level, in the order of its faces, half 0 before half 1.
///
/// Works in parallel, with the same result for any number of threads; several threads may call it at
/// once.  std::bad_alloc passes through.
///
/// \return  no polygons on failure: InvalidArgument (a channel that the level does not have, labels
///          that are not one for each face of level 0, sides of another level, splitVertices without
///          sides) or Unsupported (generateBaseCoords behind other than hexagonal steps)
OPENSUBDIVHEX_API PolygonIndices CreatePolygonIndices(FarExt::TopologyLevel const &level,
                                                      DrawOptions const &options = DrawOptions(),
                                                      FarExt::Status *status = nullptr);

} // namespace OpenSubdivHex::OsdExt

#endif

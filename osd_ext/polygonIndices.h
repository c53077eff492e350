// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_POLYGON_INDICES_H
#define OPENSUBDIVHEX_OSD_EXT_POLYGON_INDICES_H

#include "far_ext/stencilTableFactory.h"

#include <vector>

namespace OpenSubdivHex::OsdExt {

/// \brief The creases along which hexagons are cut.
enum class CreaseCuts {
    NoCreases,       ///< no crease cuts
    InfinitelySharp, ///< where LimitSides tells the two sides of a crease apart
    All              ///< semi-sharp ones too, at the levels where they are sharp
};

/// \brief Options of CreatePolygonIndices and CreateTriangleIndices: which faces are drawn, and where hexagons are cut.
///
/// A cut goes from vertex 0 to TopologyLevel::GetFaceDiagonalEnd(), 3 in hexagons, and adds no vertex.  It can cut hexagons on
/// edges of level 0 and, behind FirstStep::Truncate, polygons of vertices on a crease.
///
/// \code
///     OsdExt::DrawOptions options;
///     options.fvarChannels = {0};      // texture coordinates
///     options.separateVertices = true; // one index for each corner
///     auto triangles = OsdExt::CreateTriangleIndices(refiner->GetLevel(3), options);
/// \endcode
struct DrawOptions {
    /// Added to every vertex, for levels behind others in one buffer.  Not negative.
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

    /// The sides of the level's vertices (LimitSides::IsOf), for DrawnFaces::sides; infinitely sharp
    /// creases then cut in any case.  Null for none.
    FarExt::LimitSides const *sides = nullptr;
    /// Whether DrawnFaces::vertices are sides in place of vertices of the level: a vertex on a crease is several, one for
    /// each of its normals.  There are sides->GetNumSides() of them, and sides->GetVertex() has the vertex of each.  A limit
    /// stencil table with generateFurtherSides has the same order.
    bool splitVertices = false;
    /// Whether DrawnFaces::vertices are those of DrawnFaces::drawnVertices: each has one value of each of \p fvarChannels, one
    /// of \p sides and, with generateBaseCoords, one place in one base face.  For formats with one index for each corner, such
    /// as the buffers of graphics libraries, and PLY files.
    bool separateVertices = false;
    /// Whether DrawnFaces::baseCoords are made; cuts as cutBaseFaces does.
    bool generateBaseCoords = false;

    /// Whether holes are drawn.  Else a hexagon with one half in a hole is drawn as the other half.
    bool drawHoles = false;
};

/// \brief Vertices for buffers with one index per corner: a vertex at a seam or a crease is several, and with coordinates
/// also one on an edge of the base mesh.
///
/// The vertices of the level (or sides) come first, in their order, so that evaluated values stay in place; each has the
/// attributes of its first corner.  Behind them are the vertices that other corners need, in the order of corners.
struct DrawnVertices {
    /// How many there are.
    int GetNumVertices() const { return int(vertices.size()); }

    /// The vertices of the level, or sides (DrawOptions::splitVertices), without the offset.
    std::vector<int> vertices;
    /// For each channel of DrawOptions::fvarChannels the values; 0 where no drawn face has the vertex.
    std::vector<std::vector<int>> fvarValues;
    /// The sides, as DrawnFaces::sides; the first one where no drawn face has the vertex.
    std::vector<int> sides;
    /// u and v, as DrawnFaces::baseCoords; 0 where no drawn face has the vertex.
    std::vector<float> baseCoords;
    /// The base face that these are in; INDEX_INVALID where no drawn face has the vertex.  Empty
    /// without baseCoords.
    std::vector<int> baseFaces;
};

/// \brief Index buffers of drawn faces, without their sizes: by corner, one face after the other, and
/// by face.
struct DrawnFaces {
    /// @name By corner
    /// @{

    /// The vertices of the level, or sides (DrawOptions::splitVertices), or those of drawnVertices
    /// (DrawOptions::separateVertices), plus the offset.
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

    /// The face of the level that the drawn face is, or is a part of.
    std::vector<int> faces;
    /// The face of level 0 that the drawn face lies in: TopologyLevel::GetFaceBaseFace.
    std::vector<int> baseFaces;
    /// The label of the base face.  Empty without labels.
    std::vector<int> labels;
    /// @}

    /// The separate vertices.  Empty without DrawOptions::separateVertices.
    DrawnVertices drawnVertices;
};

/// \brief The faces of a level as polygons.
struct PolygonIndices : DrawnFaces {
    /// Corners of each polygon: those of its face or, if that is cut, of its half.
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
///          that are not one for each face of level 0, no CreaseCuts, a negative vertexOffset, sides of
///          another level or of one without full topology, splitVertices without sides), Unsupported
///          (generateBaseCoords behind other than hexagonal steps) or TooLarge (a vertexOffset, or
///          separateVertices, by which there are more corners or vertices than 32-bit indices reach)
OPENSUBDIVHEX_API PolygonIndices CreatePolygonIndices(FarExt::TopologyLevel const &level,
                                                      DrawOptions const &options = DrawOptions(),
                                                      FarExt::CallStatus *status = nullptr);

/// \brief Index buffers of the triangles that draw a level: three corners each.
///
/// \code
///     OsdExt::TriangleIndices const triangles = OsdExt::CreateTriangleIndices(refiner->GetLevel(3));
///     Draw(triangles.vertices.data(), triangles.GetNumTriangles());
/// \endcode
struct TriangleIndices : DrawnFaces {
    /// How many there are.
    int GetNumTriangles() const { return int(faces.size()); }
};

/// \brief Triangulates polygons, in their order and orientation.  A polygon of n sides makes n - 2 triangles that zigzag
/// across it, so that no vertex has them all; one of less than three sides makes none.
///
/// Works in parallel, with the same result for any number of threads; several threads may call it at
/// once.  std::bad_alloc passes through.
OPENSUBDIVHEX_API TriangleIndices CreateTriangleIndices(PolygonIndices const &polygons);

/// \brief The triangles of CreatePolygonIndices(level, options, status).
///
/// Hexagons make four triangles, cut or not.
OPENSUBDIVHEX_API TriangleIndices CreateTriangleIndices(FarExt::TopologyLevel const &level,
                                                        DrawOptions const &options = DrawOptions(),
                                                        FarExt::CallStatus *status = nullptr);

} // namespace OpenSubdivHex::OsdExt

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_REFERENCE_CELL_REFERENCE_H
#define OPENSUBDIVHEX_REGRESSION_REFERENCE_CELL_REFERENCE_H

#include "reference.h"

#include <array>
#include <memory>
#include <vector>

namespace OpenSubdivHex::Regression {

/// \brief A base mesh whose faces are refined piece by piece, by keeping books of every line.
///
/// A *line* joins two vertices and belongs to both pieces beside it.  It may come apart in three, at a
/// quarter and at three quarters of its length: whoever looks at it from the other side finds that done.
/// A *piece* is a polygon of lines.  A whole one comes apart in one of half its size and trapezoids at
/// its lines; a trapezoid, whose line 0 is twice as long as that across from it, in one of half its size
/// amid line 0 and three at its other lines.
class CellReference {
public:
    /// The faces of \p base are pieces 0 ...; each begins with the vertex that it has first in
    /// \p faceVertices, which has the vertices of all faces in turn.
    CellReference(ReferenceMesh const &base, std::vector<int> const &faceVertices);
    ~CellReference();

    /// \brief Makes pieces of a piece: the one of half its size first, then those at its lines.
    /// \return  the number of the first, the others following
    int Refine(int piece);

    /// A piece that was not refined.
    struct Polygon {
        int baseFace;
        std::vector<int> vertices; ///< counter-clockwise
        /// Places of these, in the regular polygon that the base face is.
        std::vector<std::array<double, 2>> places;
    };
    /// All pieces that were not refined; two trapezoids of one face whose lines 0 are the same, in one
    /// piece, are a hexagon.
    std::vector<Polygon> GetPolygons() const;

    /// \brief These as a mesh, whose points mean nothing.
    ///
    /// Throws std::runtime_error if OpenMesh does not take a polygon.
    ReferenceMesh MakeMesh() const;

private:
    struct Line;
    struct Side {
        Line *line;
        bool isReversed;
    };
    struct Piece {
        int baseFace;
        bool isWhole;
        bool isRefined;
        std::vector<Side> sides;
        std::vector<std::array<double, 2>> corners;
    };

    Side addLine(int start, int end);
    void divide(Line &line);
    int getStart(Side const &side) const;
    Side getPart(Side const &side, int part) const;
    void appendLine(Side const &side, std::array<double, 2> const &from,
                    std::array<double, 2> const &to, Polygon &polygon) const;

    int _numVertices;
    std::vector<std::unique_ptr<Line>> _lines;
    std::vector<Piece> _pieces;
};

} // namespace OpenSubdivHex::Regression

#endif

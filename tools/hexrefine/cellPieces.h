// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_CELL_PIECES_H
#define OPENSUBDIVHEX_TOOLS_CELL_PIECES_H

#include "bfr_ext/cellForest.h"
#include "bfr_ext/surfaceFactory.h"
#include "tools/mesh/mesh.h"

#include <cstdint>
#include <string>
#include <vector>

namespace OpenSubdivHex::Tools {

/// \brief The cells of a forest as a mesh, made piece by piece: some base faces, which have one label, at a
/// time.
///
/// Vertices of the whole mesh are the *front* first: those on the boundaries of base faces, in the order
/// of the forest, which are known when all pieces are; then those inside of base faces, which pieces have.
/// Faces count the vertices of the whole mesh.  Of values, too, each piece has those that none before had:
/// places of one vertex with the same value share it.  Infinitely sharp edges are creases of the piece that
/// has the first of their faces.
class CellPieces {
public:
    /// \param factory  of the refiner
    /// \param forest   of the same, matched
    /// \param mesh     positions, properties and channels of the surface level, and labels of base faces
    /// \param input    its file, for messages
    ///
    /// All must live as long.
    CellPieces(BfrExt::SurfaceFactory const &factory, BfrExt::CellForest const &forest,
               Mesh const &mesh, std::string const &input);

    /// \brief Makes the next piece, which has properties and channels as the base mesh has.
    ///
    /// Normals are 1 long.  Throws FileError, naming the file, for numbers that are not finite and more
    /// vertices than an int counts.
    ///
    /// \return  false if there is none
    bool MakeNext();
    /// The piece.
    Mesh const &GetPiece() const { return _piece; }
    /// The levels of its faces.
    std::vector<int> const &GetFaceLevels() const { return _faceLevels; }
    /// Gives the front away, behind the last piece: vertices with their properties.
    Mesh TakeFront();

private:
    struct Patch;
    // Values of a channel at vertices of the front, which more than one base face may have.
    struct FrontValues {
        std::vector<std::vector<int>> places; // by vertex: of values in the next two
        std::vector<float> values;            // as they were before they were made 1 long
        std::vector<int> numbers;
        int numValues = 0; // of the whole mesh
    };

    bool hasFace(int face) const { return !_factory.GetFaces().IsHole(face); }
    void numberFront();
    int takeFaces();
    void evaluate(int face, Patch &patch) const;
    void evaluate(BfrExt::Surface<float> const &surface, Patch const &patch,
                  std::vector<float> const &values, int width, std::vector<float> &result) const;
    void clearPiece();
    void add(Patch const &patch);
    void addValues(Patch const &patch, std::vector<int> const &verts, std::size_t channel);

    BfrExt::SurfaceFactory const &_factory;
    BfrExt::CellForest const &_forest;
    Mesh const &_mesh;
    std::string const &_input;
    FarExt::TopologyLevel _level;   // whose faces are refined
    std::vector<float> _properties; // of vertices, by vertex
    std::vector<int> _frontVerts;   // by the forest's numbers of points
    std::vector<FrontValues> _frontValues;
    Mesh _front;
    std::int64_t _numVerts = 0; // so far
    int _nextFace = 0;
    Mesh _piece;
    std::vector<int> _faceLevels;
};

} // namespace OpenSubdivHex::Tools

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_SHAPES_SHAPES_H
#define OPENSUBDIVHEX_REGRESSION_SHAPES_SHAPES_H

#include <string>
#include <vector>

namespace OpenSubdivHex::Regression {

/// \brief One face-varying channel of a Shape, e.g. texture coordinates.
struct FVarChannel {
    int width = 2;                 ///< numbers per value
    std::vector<double> values;    ///< width per value
    std::vector<int> valueIndices; ///< one per entry of Shape::faceVertices
};

/// \brief A base mesh as plain arrays, with all that OpenSubdiv lets a base mesh carry.
struct Shape {
    std::string name;

    std::vector<double> positions; ///< x, y, z per vertex
    std::vector<int> faceSizes;    ///< vertices per face
    std::vector<int> faceVertices; ///< of all faces in turn, in consistent orientation

    std::vector<int> creaseVertexPairs; ///< two vertices per crease edge
    std::vector<float> creaseSharpness; ///< one per crease edge
    std::vector<int> cornerVertices;    ///< vertices with a sharpness
    std::vector<float> cornerSharpness; ///< one per entry of cornerVertices
    std::vector<int> holeFaces;         ///< ascending
    std::vector<FVarChannel> fvarChannels;
    bool leftHanded = false; ///< faces are clockwise seen from outside

    // Computed by GetShapes():
    bool closed = false;   ///< no edge has one face only
    bool manifold = false; ///< every edge has one or two faces, every vertex one fan or no face

    int GetNumVertices() const { return int(positions.size() / 3); }
    int GetNumFaces() const { return int(faceSizes.size()); }
    int GetNumCorners() const { return int(faceVertices.size()); }
};

/// The regular icosahedron.
Shape MakeIcosahedron();

/// A prism over a regular polygon with \p n sides, which is its first face and its last.
Shape MakePrism(int n);

/// \brief A disc: \p n faces around vertex 0, its pole, which each has \p numTimes times, and two rings of as
/// many quads around these.  Faces 0 to \p n - 1 are those at the pole; vertex 1 + i is where two of them meet.
Shape MakePole(int n, int numTimes);
/// \brief The pole of MakePole(n, 1), whose \p n edges to vertices 1, 2 ... are all differently sharp, by up to 3.5.
Shape MakePoleOfSpokes(int n);

/// Two pyramids with \p n sides, base to base; the tips are the last two vertices.
Shape MakeBipyramid(int n);

/// \brief The catalogue that all tests share: made by code, the same on every run.
///
/// Orientation is consistent, and outward for closed shapes.  Positions are deformed by a smooth
/// non-linear map, so that no symmetry cancels the error of a wrong weight.  The meshes spot,
/// suzanne and teapot follow where their folder was there when the build was configured.  The
/// teapot as it comes has vertices where two fans of faces touch; teapotSplit has two vertices
/// there.
std::vector<Shape> const &GetShapes();

/// The manifold shapes of GetShapes(), in the same order.
std::vector<Shape> const &GetManifoldShapes();

/// The shape of that name; throws std::out_of_range if there is none.
Shape const &GetShape(std::string const &name);

/// The largest level, at most \p maxLevel, that has no more than \p maxCorners face-vertices,
/// divided by the build's OPENSUBDIVHEX_TEST_DIVISOR.
int GetTestLevel(Shape const &shape, int maxLevel, double maxCorners = 60000);

} // namespace OpenSubdivHex::Regression

#endif

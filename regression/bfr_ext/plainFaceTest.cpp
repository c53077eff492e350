// SPDX-License-Identifier: Apache-2.0
//
// Plain base faces: what keys tell of them, against the patches of any faces.
#include "bfr_ext/cell/plainFace.h"
#include "bfr_ext/surfaceFactory.h"
#include "far_ext/vtr/hierarchy.h"
#include "regression/far_ext/referenceMatch.h"
#include "regression/shapes/featureShapes.h"
#include "regression/shapes/meshOperations.h"
#include "regression/shapes/shapeDescriptor.h"
#include "regression/shapes/torus.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace OpenSubdivHex::Regression::plainFaceTest {

using BfrExt::internal::CellType;
using BfrExt::internal::CellTypes;
using BfrExt::internal::PlainFaceGatherer;
using BfrExt::internal::PlainFaceType;

namespace {

/// Lets the faces begin at any corner.
void turnFaces(Shape &shape) {
    std::mt19937 random;
    auto first = shape.faceVertices.begin();
    for (int size : shape.faceSizes) {
        std::rotate(first, first + int(random() % unsigned(size)), first + size);
        first += size;
    }
}

Shape makeTurnedTorus(int numU, int numV, TorusFaces faces) {
    Shape shape = MakeTorus(numU, numV, faces);
    turnFaces(shape);
    return shape;
}

/// A torus of triangles, some cut in three, with edges that were turned and some that were taken out.
class RandomTorus {
public:
    explicit RandomTorus(unsigned seed) : _random(seed) {
        Shape const torus = MakeTorus(9, 8, TorusFaces::IrregularTriangles);
        for (std::size_t i = 0; i < torus.faceVertices.size(); i += 3) {
            int const *const verts = &torus.faceVertices[i];
            _faces.emplace_back(verts, verts + 3);
        }
        _positions = torus.positions;
    }

    void TurnEdges(int count) {
        for (int i = 0; i < count; ++i) {
            auto const [first, second] = takePair(true);
            if (second.empty()) {
                return;
            }
            _faces.push_back({first[0], second[2], first[2]});
            _faces.push_back({second[2], first[1], first[2]});
        }
    }
    void CutFaces(int count) {
        for (int i = 0; i < count; ++i) {
            auto const face = std::size_t(_random() % _faces.size());
            std::vector<int> const verts = _faces[face];
            int const vert = int(_positions.size() / 3);
            for (std::size_t k = 0; k < 3; ++k) {
                _positions.push_back((_positions[3 * std::size_t(verts[0]) + k] +
                                      _positions[3 * std::size_t(verts[1]) + k] +
                                      _positions[3 * std::size_t(verts[2]) + k]) /
                                     3);
            }
            _faces[face] = {verts[0], verts[1], vert};
            _faces.push_back({verts[1], verts[2], vert});
            _faces.push_back({verts[2], verts[0], vert});
        }
    }
    void TakeEdgesOut(int count) {
        for (int i = 0; i < count; ++i) {
            auto [first, second] = takePair(false);
            if (second.empty()) {
                return;
            }
            first.insert(first.begin() + 1, second.begin() + 2, second.end());
            _faces.push_back(first);
        }
    }

    Shape Get() const {
        Shape shape;
        shape.name = "random torus";
        shape.positions = _positions;
        for (std::vector<int> const &face : _faces) {
            shape.faceSizes.push_back(int(face.size()));
            shape.faceVertices.insert(shape.faceVertices.end(), face.begin(), face.end());
        }
        turnFaces(shape);
        return shape;
    }

private:
    using Face = std::vector<int>;

    /// Two faces beside an edge, which becomes the first of both, that have nothing else in common, and
    /// whose ends have four faces at least; taken out.  With \p isTurned the vertices across from the edge
    /// share no face.
    std::pair<Face, Face> takePair(bool isTurned) {
        for (int attempt = 0; attempt < 1000; ++attempt) {
            auto const i = std::size_t(_random() % _faces.size());
            Face first = _faces[i];
            std::rotate(first.begin(), first.begin() + int(_random() % first.size()), first.end());
            for (std::size_t k = 0; k < _faces.size(); ++k) {
                Face second = _faces[k];
                auto const start = std::find(second.begin(), second.end(), first[1]);
                if (k == i || start == second.end()) {
                    continue;
                }
                std::rotate(second.begin(), start, second.end());
                int const numCommon = int(std::count_if(second.begin(), second.end(), [&](int v) {
                    return std::find(first.begin(), first.end(), v) != first.end();
                }));
                if (second[1] != first[0] || numCommon != 2 || first.size() + second.size() > 8 ||
                    count({first[0]}) < 4 || count({first[1]}) < 4 ||
                    (isTurned && count({first[2], second[2]}) > 0)) {
                    continue;
                }
                _faces.erase(_faces.begin() + std::ptrdiff_t(std::max(i, k)));
                _faces.erase(_faces.begin() + std::ptrdiff_t(std::min(i, k)));
                return {first, second};
            }
        }
        return {};
    }
    /// Faces that have all of some vertices.
    int count(std::vector<int> const &verts) const {
        return int(std::count_if(_faces.begin(), _faces.end(), [&](Face const &face) {
            return std::all_of(verts.begin(), verts.end(), [&](int vert) {
                return std::find(face.begin(), face.end(), vert) != face.end();
            });
        }));
    }

    std::mt19937 _random;
    std::vector<Face> _faces;
    std::vector<double> _positions;
};

/// All faces of shapes, with types that they share.
struct Faces {
    /// \return  how many of the faces are plain
    int Expect(Shape const &shape) {
        Sdc::Options options;
        options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
        auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0, options);
        FarExt::internal::Level const &level = refiner->GetHierarchy().mesh.levels[0];
        BfrExt::internal::FaceWalk const walk(level);
        PlainFaceGatherer gatherer;
        int numPlain = 0;
        for (int face = 0; face < level.numFaces; ++face) {
            std::vector<Far::Index> points;
            PlainFaceType const *const plain =
                gatherer.Find(types.GetPlainFaces({}), walk, face, points);
            if (!plain) {
                continue;
            }
            ++numPlain;
            FarExt::internal::CellPatch cell;
            FarExt::SurfaceFaces const faces(level);
            FarExt::internal::GatherBaseCell(faces, face, {}, cell);
            std::vector<Far::Index> expected = cell.patch.sources;
            EXPECT_EQ(plain->GetNumPoints(), int(expected.size())) << "face " << face;
            expected.resize(expected.size() + 2 * std::size_t(level.GetFaceSize(face)));
            FarExt::internal::FindBaseCellTurns(faces, face,
                                                expected.data() + cell.patch.sources.size());
            EXPECT_EQ(points, expected) << "face " << face;
            CellType const &type = types.Find(std::move(cell), {});
            EXPECT_EQ(&plain->Get(), &type) << "face " << face;
        }
        return numPlain;
    }

    CellTypes types;
};

} // namespace

TEST(PlainFaceTest, KeysTellPatches) {
    Faces faces;
    for (Shape const &shape : GetShapes()) {
        SCOPED_TRACE(shape.name);
        faces.Expect(shape);
    }
    for (char const *const name : {"mixedSharpnessQuads", "cornersTriangles", "creasedBall"}) {
        SCOPED_TRACE(name);
        faces.Expect(GetFeatureShape(name));
    }
    EXPECT_GT(faces.types.GetSize(), 10u);
}

TEST(PlainFaceTest, FacesOfLatticesArePlain) {
    Faces faces;
    Shape const quads = makeTurnedTorus(9, 7, TorusFaces::Quads);
    Shape const triangles = makeTurnedTorus(8, 9, TorusFaces::Triangles);
    Shape const hexagons = MakeDual("hexagons", triangles);
    for (Shape const *const lattice : {&quads, &triangles, &hexagons}) {
        CellTypes &types = faces.types;
        std::size_t const numBefore = types.GetSize();
        EXPECT_EQ(faces.Expect(*lattice), lattice->GetNumFaces());
        EXPECT_EQ(types.GetSize(), numBefore + 1);
        Shape sharp = *lattice;
        sharp.cornerVertices = {0};
        sharp.cornerSharpness = {1.5F};
        int const numPlain = faces.Expect(sharp);
        EXPECT_GT(numPlain, 0);
        EXPECT_LT(numPlain, lattice->GetNumFaces());
    }
    // On small tori patches have a vertex in several places.
    for (int size = 2; size <= 6; ++size) {
        SCOPED_TRACE(size);
        EXPECT_EQ(faces.Expect(makeTurnedTorus(size, 9, TorusFaces::Quads)), size < 6 ? 0 : 54);
        faces.Expect(makeTurnedTorus(size, 7, TorusFaces::Triangles));
    }
}

TEST(PlainFaceTest, FacesOfIrregularMeshesArePlain) {
    Faces faces;
    for (unsigned seed = 0; seed < 12; ++seed) {
        SCOPED_TRACE(seed);
        RandomTorus torus(seed);
        torus.TurnEdges(int(4 * seed));
        Shape const triangles = torus.Get();
        EXPECT_GT(4 * faces.Expect(triangles), triangles.GetNumFaces());
        faces.Expect(MakeDual("dual", triangles));
        torus.TakeEdgesOut(int(3 * seed));
        Shape const mixed = torus.Get();
        EXPECT_GT(4 * faces.Expect(mixed), mixed.GetNumFaces());
        torus.CutFaces(10);
        faces.Expect(torus.Get());
    }
}

TEST(PlainFaceTest, TypesAreMadeWhenTheyAreAskedFor) {
    Shape const shape = RandomTorus(1).Get();
    auto const refiner = CreateRefiner(shape, ReferenceMask::Smooth, 0);
    BfrExt::SurfaceFactoryCache cache;
    auto const factory = BfrExt::SurfaceFactory::Create(
        *refiner, BfrExt::SurfaceFactory::Options().SetExternalCache(&cache));
    BfrExt::Surface<double> surface;
    ASSERT_TRUE(factory->InitVertexSurface(0, &surface));
    EXPECT_EQ(cache.GetNumTypes(), 1u);
    std::vector<double> points(3 * std::size_t(surface.GetNumPatchPoints()));
    surface.PreparePatchPoints(shape.positions.data(), 3, points.data(), 3);
    std::size_t const numTypes = cache.GetNumTypes();
    EXPECT_GT(numTypes, 1u);
    surface.PreparePatchPoints(shape.positions.data(), 3, points.data(), 3);
    EXPECT_EQ(cache.GetNumTypes(), numTypes);
}

} // namespace OpenSubdivHex::Regression::plainFaceTest

// SPDX-License-Identifier: Apache-2.0
//
// Meshes that are written in pieces, against the same as a whole.
#include "pieceWriter.h"
#include "meshContent.h"
#include "meshFileFixture.h"
#include "meshWriter.h"

#include <filesystem>
#include <random>

namespace OpenSubdivHex::Tools::pieceWriterTest {

namespace {

constexpr int kNumFront = 5;

/// Faces of two labels by turns, with all that a file can have of vertices, corners and faces.
Mesh makeMesh(std::vector<int> const &faceSizes) {
    Mesh mesh;
    mesh.faceSizes = faceSizes;
    mesh.vertexProperties = {{"red", NumberType::UChar, {}}, {"heat", NumberType::Float, {}}};
    mesh.faceProperties = {{"part", NumberType::Short, {}}, {"size", NumberType::Double, {}}};
    mesh.channels = {{FVarKind::Uv, 2, {}, {}}, {FVarKind::Normal, 3, {}, {}}};
    mesh.labels = {{"thing", "left", "blue", "1"}, {"thing", "right", "a b \\", ""}};
    mesh.materialLibraries = {"some.mtl"};
    std::mt19937 random(3);
    int const numVertices = kNumFront + 4 * int(faceSizes.size());
    for (int vert = 0; vert < numVertices; ++vert) {
        for (int k = 0; k < 3; ++k) {
            mesh.positions.push_back(float(random() % 1000) / 7);
        }
        mesh.vertexProperties[0].values.push_back(float(random() % 256));
        mesh.vertexProperties[1].values.push_back(float(random() % 256) / 3);
    }
    for (std::size_t face = 0; face < faceSizes.size(); ++face) {
        mesh.faceProperties[0].values.push_back(double(random() % 100));
        mesh.faceProperties[1].values.push_back(double(random() % 100) / 3);
        mesh.faceLabels.push_back(int(face) % 2);
        for (int corner = 0; corner < faceSizes[face]; ++corner) {
            mesh.faceVertices.push_back(int(random() % unsigned(numVertices)));
        }
        for (FVarChannel &channel : mesh.channels) {
            for (int corner = 0; corner < faceSizes[face]; ++corner) {
                channel.faceValues.push_back(int(random() % 2) + 2 * int(face));
            }
            for (int k = 0; k < 2 * channel.width; ++k) {
                channel.values.push_back(float(random() % 100) / 7);
            }
        }
    }
    return mesh;
}

/// The vertices begin ... end - 1 of a mesh.
Mesh copyVertices(Mesh const &mesh, int begin, int end) {
    Mesh result;
    result.positions.assign(mesh.positions.begin() + 3 * begin, mesh.positions.begin() + 3 * end);
    result.vertexProperties = mesh.vertexProperties;
    for (std::size_t i = 0; i < mesh.vertexProperties.size(); ++i) {
        auto const first = mesh.vertexProperties[i].values.begin();
        result.vertexProperties[i].values.assign(first + begin, first + end);
    }
    return result;
}

/// One face, four vertices and two values of each channel.
Mesh copyPiece(Mesh const &mesh, int face, int firstCorner) {
    Mesh piece = copyVertices(mesh, kNumFront + 4 * face, kNumFront + 4 * face + 4);
    int const size = mesh.faceSizes[std::size_t(face)];
    piece.faceProperties = mesh.faceProperties;
    piece.faceSizes = {size};
    piece.baseFaces = {face};
    auto const first = mesh.faceVertices.begin() + firstCorner;
    piece.faceVertices.assign(first, first + size);
    for (FVarChannel const &channel : mesh.channels) {
        auto const value = channel.values.begin() + 2 * channel.width * face;
        auto const corner = channel.faceValues.begin() + firstCorner;
        piece.channels.push_back({channel.kind,
                                  channel.width,
                                  {value, value + 2 * channel.width},
                                  {corner, corner + size}});
    }
    return piece;
}

/// With its faces in the order of labels.
Mesh sort(Mesh const &mesh) {
    Mesh result = mesh;
    result.faceSizes.clear();
    result.faceVertices.clear();
    for (FVarChannel &channel : result.channels) {
        channel.faceValues.clear();
    }
    for (int label = 0; label < 2; ++label) {
        std::ptrdiff_t corner = 0;
        for (std::size_t face = 0; face < mesh.faceSizes.size(); ++face) {
            int const size = mesh.faceSizes[face];
            if (mesh.faceLabels.empty() ? label == 0 : mesh.faceLabels[face] == label) {
                result.faceSizes.push_back(size);
                result.baseFaces.push_back(int(face));
                auto const append = [&](std::vector<int> const &from, std::vector<int> *to) {
                    to->insert(to->end(), from.begin() + corner, from.begin() + corner + size);
                };
                append(mesh.faceVertices, &result.faceVertices);
                for (std::size_t i = 0; i < mesh.channels.size(); ++i) {
                    append(mesh.channels[i].faceValues, &result.channels[i].faceValues);
                }
            }
            corner += size;
        }
    }
    return result;
}

} // namespace

// A face of 300 corners takes other numbers of corners in all faces of binary files, wherever it comes.
TEST_F(MeshFile, PiecesMakeTheFileOfTheWhole) {
    for (std::vector<int> const &sizes :
         {std::vector<int>{4, 3, 6, 5, 3}, {4, 3, 300, 5}, {300, 4, 3}, {255}}) {
        for (char const *const name : {"pieces.obj", "pieces.off", "pieces.ply"}) {
            SCOPED_TRACE(name);
            Mesh mesh = makeMesh(sizes);
            RemoveWhatIsNotHeld(name, &mesh);
            WriteMesh(sort(mesh), getPath(name));
            std::string const whole = getContent(getPath(name));
            std::filesystem::remove(getPath(name));
            PieceWriter writer(mesh, getPath(name));
            int corner = 0;
            for (int face = 0; face < mesh.GetNumFaces(); ++face) {
                writer.Add(copyPiece(mesh, face, corner));
                corner += mesh.faceSizes[std::size_t(face)];
            }
            EXPECT_FALSE(std::filesystem::exists(getPath(name)));
            writer.Commit(copyVertices(mesh, 0, kNumFront));
            EXPECT_TRUE(getContent(getPath(name)) == whole) << getContent(getPath(name));
        }
    }
}

TEST_F(MeshFile, PiecesThatAreNotAllLeaveTheFile) {
    std::string const path = makeFile("kept.obj", "v 0 0 0\n");
    Mesh const mesh = makeMesh({4, 3});
    {
        PieceWriter writer(mesh, path);
        writer.Add(copyPiece(mesh, 0, 0));
    }
    EXPECT_THROW(PieceWriter(mesh, path).Commit(copyVertices(mesh, 0, kNumFront)), FileError);
    EXPECT_THROW(PieceWriter(mesh, getPath("no/such.obj")), FileError);
    EXPECT_EQ(getContent(path), "v 0 0 0\n");
    std::size_t const numFiles =
        std::size_t(std::distance(std::filesystem::directory_iterator(getPath("")), {}));
    EXPECT_EQ(numFiles, 1u);
}

} // namespace OpenSubdivHex::Tools::pieceWriterTest

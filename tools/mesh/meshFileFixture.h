// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_MESH_FILE_FIXTURE_H
#define OPENSUBDIVHEX_TOOLS_MESH_FILE_FIXTURE_H

#include "fileError.h"
#include "meshReader.h"
#include "testFolder.h"

namespace OpenSubdivHex::Tools {

class MeshFile : public TestFolder {
protected:
    /// Expects that the file is refused with one line: its path, and then \p cause somewhere.
    void expectRefused(std::string const &path, std::string const &cause) const {
        try {
            Mesh const mesh = ReadMesh(path);
            ADD_FAILURE() << path << " was read, with " << mesh.GetNumFaces() << " faces";
        } catch (FileError const &error) {
            std::string const message = error.what();
            EXPECT_EQ(message.rfind(path + ": ", 0), 0u) << message;
            EXPECT_NE(message.find(cause), std::string::npos) << message;
            EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        }
    }
    void expectRefused(std::string const &name, std::string const &content,
                       std::string const &cause) const {
        SCOPED_TRACE(content.substr(0, 400));
        expectRefused(makeFile(name, content), cause);
    }

    void expectFaces(std::string const &name, std::string const &content, int numVertices,
                     std::vector<int> const &faceSizes,
                     std::vector<int> const &faceVertices) const {
        SCOPED_TRACE(content);
        Mesh const mesh = ReadMesh(makeFile(name, content));
        EXPECT_EQ(mesh.GetNumVertices(), numVertices);
        EXPECT_EQ(mesh.faceSizes, faceSizes);
        EXPECT_EQ(mesh.faceVertices, faceVertices);
    }
};

inline bool operator==(VertexProperty const &a, VertexProperty const &b) {
    return a.name == b.name && a.type == b.type && a.values == b.values;
}
inline bool operator==(FaceProperty const &a, FaceProperty const &b) {
    return a.name == b.name && a.type == b.type && a.values == b.values;
}

/// Compares meshes whose faces are their own base faces.
inline void expectEqual(Mesh const &a, Mesh const &b) {
    EXPECT_EQ(a.faceSizes, b.faceSizes);
    EXPECT_EQ(a.faceVertices, b.faceVertices);
    ASSERT_EQ(a.positions.size(), b.positions.size());
    for (std::size_t i = 0; i < a.positions.size(); ++i) {
        ASSERT_EQ(a.positions[i], b.positions[i]) << "coordinate " << i;
    }
    ASSERT_EQ(a.channels.size(), b.channels.size());
    for (std::size_t i = 0; i < a.channels.size(); ++i) {
        EXPECT_EQ(a.channels[i].kind, b.channels[i].kind);
        EXPECT_EQ(a.channels[i].width, b.channels[i].width);
        EXPECT_EQ(a.channels[i].values, b.channels[i].values);
        EXPECT_EQ(a.channels[i].faceValues, b.channels[i].faceValues);
    }
    EXPECT_TRUE(a.vertexProperties == b.vertexProperties);
    EXPECT_TRUE(a.faceProperties == b.faceProperties);
    EXPECT_TRUE(a.labels == b.labels);
    EXPECT_EQ(a.faceLabels, b.faceLabels);
    EXPECT_EQ(a.materialLibraries, b.materialLibraries);
}

} // namespace OpenSubdivHex::Tools

#endif

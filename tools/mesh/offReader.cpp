// SPDX-License-Identifier: Apache-2.0
#include "fileError.h"
#include "meshReader.h"
#include "meshText.h"
#include "openMeshImporter.h"

#include <OpenMesh/Core/IO/reader/OFFReader.hh>

namespace OpenSubdivHex::Tools::internal {

namespace {

/// What the header word of an OFF file says about its vertices.
struct OffHeader {
    bool isKnown;
    bool hasTexcoords;
    bool hasNormals;
};

/// Parses [ST][C][N]OFF.
OffHeader parseHeaderWord(std::string_view word) {
    auto take = [&word](std::string_view prefix) {
        bool const found = word.substr(0, prefix.size()) == prefix;
        word.remove_prefix(found ? prefix.size() : 0);
        return found;
    };
    OffHeader header{};
    header.hasTexcoords = take("ST");
    take("C");
    header.hasNormals = take("N");
    header.isKnown = word == "OFF";
    return header;
}

} // namespace

Mesh ReadOff(std::string const &path, std::string *content) {
    // Before NormalizeText, which refuses binary files with another reason.
    if (std::string_view(*content).substr(0, content->find('\n')).find("BINARY") !=
        std::string_view::npos) {
        throw FileError(path, "is a binary OFF file, only text is supported");
    }
    NormalizeText(path, content);
    BlankComments(content);

    // The header word and the counts, which may share a line; the number of edges may be missing.
    std::string_view body = *content;
    std::vector<std::string_view> words;
    int numLines = 0;
    while (words.size() < 3 && !body.empty()) {
        ++numLines;
        for (std::string_view word : SplitWords(TakeLine(&body))) {
            words.push_back(word);
        }
    }
    OffHeader const header = parseHeaderWord(words.empty() ? std::string_view() : words[0]);
    if (!header.isKnown) {
        throw FileError(path,
                        "does not begin with OFF, COFF, NOFF, STOFF or a combination of them");
    }
    int numVertices = 0;
    int numFaces = 0;
    int numEdges = 0;
    if (words.size() < 3 || words.size() > 4 || !ParseInt(words[1], &numVertices) ||
        !ParseInt(words[2], &numFaces) || numVertices < 0 || numFaces < 0 ||
        (words.size() == 4 && !ParseInt(words[3], &numEdges))) {
        throw FileError(path, "line " + std::to_string(numLines) +
                                  ": the numbers of vertices, faces and edges are expected");
    }

    // OpenMesh skips what follows the coordinates of a vertex.  It takes the colour that may follow
    // a face, in any OFF file, for the next face.
    std::string const openMeshHeader =
        "OFF\n" + std::to_string(numVertices) + " " + std::to_string(numFaces) + " 0\n";
    constexpr int kMaxColorWords = 4;
    OpenMeshInput input{path, openMeshHeader, body};
    input.numHeaderLines = numLines;
    input.numVertices = numVertices;
    input.numFaces = numFaces;
    input.isText = true;
    input.maxVertexExtras =
        kMaxColorWords + (header.hasNormals ? 3 : 0) + (header.hasTexcoords ? 2 : 0);
    input.maxFaceExtras = kMaxColorWords;
    input.skipFaceExtras = true;
    return ReadThroughOpenMesh(OpenMesh::IO::OFFReader(), input);
}

} // namespace OpenSubdivHex::Tools::internal

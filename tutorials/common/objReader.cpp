// SPDX-License-Identifier: Apache-2.0
#include "fileError.h"
#include "meshReader.h"
#include "meshText.h"

#include <tiny_obj_loader.h>

#include <algorithm>
#include <array>
#include <sstream>
#include <utility>

namespace OpenSubdivHex::Tutorials::internal {

namespace {

/// Statements that say nothing about positions and faces.
constexpr std::array<std::string_view, 19> kSkippedStatements = {
    "vt",         "vn",        "vp",     "g",   "o",     "s",        "mg",
    "usemtl",     "mtllib",    "usemap", "lod", "bevel", "c_interp", "d_interp",
    "shadow_obj", "trace_obj", "l",      "p",   "maplib"};

/// Joins lines that end in a backslash with the next, keeping the number of lines.
void joinContinuedLines(std::string *text) {
    if (text->find("\\\n") == std::string::npos) {
        return;
    }
    std::string joined;
    joined.reserve(text->size());
    std::size_t numJoined = 0;
    for (std::size_t i = 0; i < text->size(); ++i) {
        if (text->compare(i, 2, "\\\n") == 0) {
            joined.push_back(' ');
            ++numJoined;
            ++i;
        } else if ((*text)[i] == '\n') {
            joined.append(numJoined + 1, '\n');
            numJoined = 0;
        } else {
            joined.push_back((*text)[i]);
        }
    }
    *text = std::move(joined);
}

/// Whether \p word is `v`, `v/t`, `v//n` or `v/t/n` with ints.
bool isCorner(std::string_view word) {
    int index = 0;
    std::size_t const slash = word.find('/');
    if (!ParseInt(word.substr(0, slash), &index)) {
        return false;
    }
    if (slash == std::string_view::npos) {
        return true;
    }
    std::string_view const rest = word.substr(slash + 1);
    std::size_t const slash2 = rest.find('/');
    if (slash2 == std::string_view::npos) {
        return ParseInt(rest, &index);
    }
    return (slash2 == 0 || ParseInt(rest.substr(0, slash2), &index)) &&
           ParseInt(rest.substr(slash2 + 1), &index);
}

/// The file as tinyobj's callbacks give it, beside what they do not give.
struct ObjContent {
    std::string const &path;
    Mesh mesh;
    std::vector<int> faceLines;
    int numVerticesSoFar = 0;

    [[noreturn]] void Refuse(int line, std::string const &cause) const {
        throw FileError(path, "line " + std::to_string(line) + ": " + cause);
    }
    [[noreturn]] void RefuseIndex(std::size_t face, int index) const {
        Refuse(faceLines[face], "vertex index " + std::to_string(index) + " is out of range");
    }
};

/// \brief Refuses what tinyobj would read as something else without a word, and fills in the
/// positions and the lines of the faces.
///
/// Tinyobj takes a number that it cannot parse, or that is missing, as 0, rounds some numbers to
/// a neighbour of the nearest float, and skips statements that it does not know.
void readStatements(std::string_view text, ObjContent *content) {
    for (int line = 1; !text.empty(); ++line) {
        std::string_view rest = TakeLine(&text);
        std::string_view const statement = TakeWord(&rest);
        std::vector<std::string_view> const words = SplitWords(rest);
        if (statement == "v") {
            if (words.size() < 3) {
                content->Refuse(line, "a vertex needs three coordinates");
            }
            for (std::size_t i = 0; i < words.size(); ++i) {
                float value = 0;
                if (!ParseFiniteFloat(words[i], &value)) {
                    content->Refuse(line, "'" + std::string(words[i]) + "' is not a finite number");
                }
                if (i < 3) {
                    content->mesh.positions.push_back(value);
                }
            }
        } else if (statement == "f") {
            for (std::string_view word : words) {
                if (!isCorner(word)) {
                    content->Refuse(line, "'" + std::string(word) + "' is not a vertex of a face");
                }
            }
            if (words.size() < 3) {
                content->Refuse(line, "a face needs three corners, this one has " +
                                          std::to_string(words.size()));
            }
            content->faceLines.push_back(line);
        } else if (!statement.empty() &&
                   std::find(kSkippedStatements.begin(), kSkippedStatements.end(), statement) ==
                       kSkippedStatements.end()) {
            content->Refuse(line, "statement '" + std::string(statement.substr(0, 40)) +
                                      "' is not supported");
        }
    }
}

void countVertex(void *data, float, float, float, float) {
    ++static_cast<ObjContent *>(data)->numVerticesSoFar;
}

void addFace(void *data, tinyobj::index_t *corners, int numCorners) {
    ObjContent &content = *static_cast<ObjContent *>(data);
    for (int i = 0; i < numCorners; ++i) {
        // Counted from 1, or back from the last vertex so far.
        int const index = corners[i].vertex_index;
        int const vertex = index > 0 ? index - 1 : content.numVerticesSoFar + index;
        if (index == 0 || vertex < 0 || vertex >= content.mesh.GetNumVertices()) {
            content.RefuseIndex(content.mesh.faceSizes.size(), index);
        }
        content.mesh.faceVertices.push_back(vertex);
    }
    content.mesh.faceSizes.push_back(numCorners);
}

} // namespace

Mesh ReadObj(std::string const &path, std::string *content) {
    NormalizeText(path, content);
    BlankComments(content);
    joinContinuedLines(content);
    ObjContent obj{path, {}, {}};
    readStatements(*content, &obj);

    // The callbacks give the corners of a face as they stand.  LoadObj does not: it keeps the
    // number of corners in 8 bits.
    tinyobj::callback_t callbacks;
    callbacks.vertex_cb = &countVertex;
    callbacks.index_cb = &addFace;
    std::istringstream stream(*content);
    std::string warning;
    std::string error;
    if (!tinyobj::LoadObjWithCallback(stream, callbacks, &obj, nullptr, &warning, &error)) {
        throw FileError(path, "cannot be parsed: " + error.substr(0, error.find('\n')));
    }
    if (obj.numVerticesSoFar != obj.mesh.GetNumVertices() ||
        obj.mesh.faceSizes.size() != obj.faceLines.size()) {
        throw FileError(path, "cannot be parsed: vertices or faces were skipped");
    }
    return std::move(obj.mesh);
}

} // namespace OpenSubdivHex::Tutorials::internal

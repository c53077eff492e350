// SPDX-License-Identifier: Apache-2.0
#include "fileError.h"
#include "meshReader.h"
#include "meshText.h"
#include "objLabels.h"
#include "objTags.h"

#include <tiny_obj_loader.h>

#include <algorithm>
#include <array>
#include <sstream>
#include <utility>

namespace OpenSubdivHex::Tools::internal {

namespace {

/// Statements that Mesh has no place for.
constexpr std::array<std::string_view, 12> kStatementsNotRead = {
    "vp",       "mg",         "usemap",    "lod", "bevel", "c_interp",
    "d_interp", "shadow_obj", "trace_obj", "l",   "p",     "maplib"};

/// \brief Overwrites comments with spaces.  A comment goes from # to the end of the line, but in
/// lines that hold a name: these may have a #.
void blankObjComments(std::string *text) {
    std::string_view rest = *text;
    while (!rest.empty()) {
        std::size_t const begin = std::size_t(rest.data() - text->data());
        std::string_view line = TakeLine(&rest);
        std::size_t const comment = line.find('#');
        if (comment != std::string_view::npos && !ObjLabelReader::IsName(TakeWord(&line))) {
            std::size_t const end = std::size_t(rest.data() - text->data()) - 1;
            std::fill(text->begin() + std::ptrdiff_t(begin + comment),
                      text->begin() + std::ptrdiff_t(end), ' ');
        }
    }
}

/// \brief Whether the first line of \p text is a statement rather than the rest of a name: a keyword, and
/// behind it what such a statement begins with.
bool beginsWithStatement(std::string_view text) {
    constexpr std::array<std::string_view, 9> kOfWords = {
        "o", "g", "usemtl", "mtllib", "usemap", "maplib", "shadow_obj", "trace_obj", "t"};
    constexpr std::array<std::string_view, 13> kOfNumbers = {
        "v", "vt", "vn", "vp", "f", "l", "p", "s", "mg", "lod", "bevel", "c_interp", "d_interp"};
    auto const has = [](auto const &keywords, std::string_view word) {
        return std::find(keywords.begin(), keywords.end(), word) != keywords.end();
    };
    std::string_view line = TakeLine(&text);
    std::string_view const keyword = TakeWord(&line);
    std::string_view const next = TakeWord(&line);
    bool const isNumber = next.find_first_of("+-.0123456789") == 0 || next == "on" || next == "off";
    return (has(kOfWords, keyword) && !next.empty()) || (has(kOfNumbers, keyword) && isNumber);
}

/// \brief Joins lines that end in a backslash with the next, keeping the number of lines.
///
/// Names may end in one, as those of folders do: a line that begins with a statement stays, with a
/// warning to \p mesh, since what it says would be lost in the name.
void joinContinuedLines(std::string *text, Mesh *mesh) {
    if (text->find("\\\n") == std::string::npos) {
        return;
    }
    std::string joined;
    joined.reserve(text->size());
    std::size_t begin = 0; // of the line, in what is joined
    std::size_t numJoined = 0;
    int numKept = 0;
    std::string firstKept;
    std::string_view rest = *text;
    for (int number = 1; !rest.empty(); ++number) {
        std::string_view const line = TakeLine(&rest);
        bool const hasBackslash = !line.empty() && line.back() == '\\';
        joined += line.substr(0, line.size() - (hasBackslash ? 1 : 0));
        bool const isEmpty = joined.find_first_not_of(" \t", begin) == std::string::npos;
        if (hasBackslash && (isEmpty || !beginsWithStatement(rest))) {
            joined += ' ';
            ++numJoined;
            continue;
        }
        if (hasBackslash && ++numKept == 1) {
            std::string_view next = rest;
            firstKept = "the backslash at the end of line " + std::to_string(number) +
                        " does not join it with the next, which begins with a statement, '" +
                        std::string(TakeWord(&next)) + "'";
        }
        // A blank, since other readers may join lines, too.
        joined += hasBackslash ? "\\ " : "";
        joined.append(numJoined + 1, '\n');
        numJoined = 0;
        begin = joined.size();
    }
    if (numKept > 0) {
        mesh->warnings.push_back(
            firstKept +
            (numKept == 1 ? "" : ", the first of " + std::to_string(numKept) + " such lines"));
    }
    *text = std::move(joined);
}

constexpr char kVertexName[] = "vertex";

/// Data of corners beside their vertices.
struct Attribute {
    FVarKind kind;
    char const *name;
    std::size_t minNumbers;      ///< that a value needs, of 3
    std::vector<float> values{}; ///< x y z of each
    std::vector<int> faceValues{};
    int numValuesSoFar = 0;
    int firstFaceWith = -1;
    int firstFaceWithout = -1;

    int GetNumValues() const { return int(values.size() / 3); }
};

/// The file as tinyobj's callbacks give it, beside what they do not give.
struct ObjContent {
    std::string const &path;
    Mesh mesh{};
    std::vector<int> faceLines{};
    int numVerticesSoFar = 0;
    Attribute uvs{FVarKind::Uv, "texture coordinate", 1};
    Attribute normals{FVarKind::Normal, "normal", 3};
    ObjTagReader tags{path};
    ObjLabelReader labels{};
    std::vector<float> weights{}; ///< w of each vertex
    std::vector<float> colors{};  ///< red, green and blue of each vertex
    bool hasWeights = false;      ///< other than 1
    std::size_t numColors = 0;    ///< that the file has

    [[noreturn]] void Refuse(int line, std::string const &cause) const {
        throw FileError(path, "line " + std::to_string(line) + ": " + cause);
    }
    [[noreturn]] void RefuseIndex(int line, char const *name, std::string_view index,
                                  std::string const &more = "") const {
        Refuse(line,
               std::string(name) + " index " + std::string(index) + " is out of range" + more);
    }

    /// The index, from 0, of what a corner of the face that comes next names as \p index: counted
    /// from 1, or back from the last one so far.
    int Resolve(char const *name, int index, int numSoFar, int numTotal) const {
        int const result = index > 0 ? index - 1 : numSoFar + index;
        if (index == 0 || result < 0 || result >= numTotal) {
            RefuseIndex(faceLines[mesh.faceSizes.size()], name, std::to_string(index),
                        ": the file has " + std::to_string(numTotal) + " of them");
        }
        return result;
    }
};

/// Refuses \p word unless it is `v`, `v/t`, `v//n` or `v/t/n` with ints, t and n not 0.
void checkCorner(ObjContent const &content, int line, std::string_view word) {
    std::string_view rest = word;
    for (int i = 0; i < 3; ++i) {
        std::size_t const slash = i < 2 ? rest.find('/') : std::string_view::npos;
        std::string_view const number = rest.substr(0, slash);
        int index = 0;
        bool const isLeftOut = i == 1 && number.empty() && slash != std::string_view::npos;
        char const *const name = i == 0   ? kVertexName
                                 : i == 1 ? content.uvs.name
                                          : content.normals.name;
        if (i > 0 && !isLeftOut && number.empty()) {
            content.Refuse(line, "'" + std::string(word) + "' has no index after '/'");
        }
        if (!isLeftOut && !ParseInt(number, &index)) {
            std::size_t const digits = number.substr(0, 1) == "-" ? 1 : 0;
            if (digits < number.size() &&
                number.find_first_not_of("0123456789", digits) == std::string_view::npos) {
                content.RefuseIndex(line, name, number); // beyond 32 bits
            }
            content.Refuse(line, "'" + std::string(word) + "' is not a vertex of a face");
        }
        if (i > 0 && !isLeftOut && index == 0) {
            // Tinyobj gives 0 for what is left out, too.
            content.RefuseIndex(line, name, "0");
        }
        if (slash == std::string_view::npos) {
            return;
        }
        rest.remove_prefix(slash + 1);
    }
}

float readNumber(ObjContent const &content, int line, std::string_view word) {
    float value = 0;
    if (!ParseFiniteFloat(word, &value)) {
        content.Refuse(line, "'" + std::string(word) + "' is " + NameFloatFailure(word));
    }
    return value;
}

/// `v x y z`, and w or a colour behind.  The w of vertices without is 1, the colour of those
/// without white, as elsewhere.
void readVertex(int line, std::vector<std::string_view> const &words, ObjContent *content) {
    if (words.size() < 3) {
        content->Refuse(line, "a vertex needs three coordinates");
    }
    bool const hasWeight = words.size() == 4;
    bool const hasColor = words.size() == 6;
    if (words.size() > 3 && !hasWeight && !hasColor) {
        content->Refuse(line, "a vertex has three numbers, four with its w or six with its colour, "
                              "this one has " +
                                  std::to_string(words.size()));
    }
    for (std::size_t i = 0; i < 3; ++i) {
        content->mesh.positions.push_back(readNumber(*content, line, words[i]));
    }
    content->weights.push_back(hasWeight ? readNumber(*content, line, words[3]) : 1.0f);
    content->hasWeights = content->hasWeights || content->weights.back() != 1.0f;
    for (std::size_t i = 3; i < 6; ++i) {
        content->colors.push_back(hasColor ? readNumber(*content, line, words[i]) : 1.0f);
    }
    content->numColors += hasColor ? 1 : 0;
}

void readAttribute(ObjContent const &content, int line, std::vector<std::string_view> const &words,
                   Attribute *attribute) {
    if (words.size() < attribute->minNumbers || words.size() > 3) {
        content.Refuse(line, std::string("a ") + attribute->name + " needs " +
                                 (attribute->minNumbers == 3 ? "three" : "one to three") +
                                 " numbers, this one has " + std::to_string(words.size()));
    }
    for (std::size_t i = 0; i < 3; ++i) {
        attribute->values.push_back(i < words.size() ? readNumber(content, line, words[i]) : 0);
    }
}

/// \brief Refuses what tinyobj would read as something else without a word, and fills in the
/// numbers, the tags, the labels and the lines of the faces.
///
/// Tinyobj takes a number that it cannot parse, or that is missing, as 0, rounds some numbers to
/// a neighbour of the nearest float, cuts names at spaces, and skips statements that it does not
/// know.
void readStatements(std::string_view text, ObjContent *content) {
    for (int line = 1; !text.empty(); ++line) {
        std::string_view rest = TakeLine(&text);
        std::string_view const statement = TakeWord(&rest);
        std::vector<std::string_view> const words = SplitWords(rest);
        if (statement == "v") {
            readVertex(line, words, content);
        } else if (statement == "vt") {
            readAttribute(*content, line, words, &content->uvs);
        } else if (statement == "vn") {
            readAttribute(*content, line, words, &content->normals);
        } else if (statement == "f") {
            for (std::string_view word : words) {
                checkCorner(*content, line, word);
            }
            if (words.size() < 3) {
                content->Refuse(line, "a face needs three corners, this one has " +
                                          std::to_string(words.size()));
            }
            content->faceLines.push_back(line);
            content->labels.AddFace();
        } else if (statement == "t") {
            content->tags.Read(line, rest);
        } else if (std::find(kStatementsNotRead.begin(), kStatementsNotRead.end(), statement) !=
                   kStatementsNotRead.end()) {
            AddNotRead("statement " + std::string(statement), &content->mesh);
        } else if (!statement.empty() && !content->labels.Read(statement, rest)) {
            content->Refuse(line, "statement '" + std::string(statement.substr(0, 40)) +
                                      "' is not supported");
        }
    }
}

void countVertex(void *data, float, float, float, float) {
    ++static_cast<ObjContent *>(data)->numVerticesSoFar;
}
void countUv(void *data, float, float, float) {
    ++static_cast<ObjContent *>(data)->uvs.numValuesSoFar;
}
void countNormal(void *data, float, float, float) {
    ++static_cast<ObjContent *>(data)->normals.numValuesSoFar;
}

/// Either all corners of all faces have the attribute, or none.
void addFaceValues(ObjContent const &content, tinyobj::index_t const *corners, int numCorners,
                   int tinyobj::index_t::*index, Attribute *attribute) {
    int const face = content.mesh.GetNumFaces();
    for (int i = 0; i < numCorners; ++i) {
        bool const hasValue = corners[i].*index != 0;
        int &first = hasValue ? attribute->firstFaceWith : attribute->firstFaceWithout;
        first = first < 0 ? face : first;
        if (attribute->firstFaceWith >= 0 && attribute->firstFaceWithout >= 0) {
            int const other =
                content
                    .faceLines[hasValue ? attribute->firstFaceWithout : attribute->firstFaceWith];
            content.Refuse(content.faceLines[face],
                           std::string("a corner has ") + (hasValue ? "a " : "no ") +
                               attribute->name + ", one in line " + std::to_string(other) +
                               (hasValue ? " has none" : " has one"));
        }
        if (hasValue) {
            attribute->faceValues.push_back(content.Resolve(attribute->name, corners[i].*index,
                                                            attribute->numValuesSoFar,
                                                            attribute->GetNumValues()));
        }
    }
}

void addFace(void *data, tinyobj::index_t *corners, int numCorners) {
    ObjContent &content = *static_cast<ObjContent *>(data);
    Mesh &mesh = content.mesh;
    for (int i = 0; i < numCorners; ++i) {
        mesh.faceVertices.push_back(content.Resolve(
            kVertexName, corners[i].vertex_index, content.numVerticesSoFar, mesh.GetNumVertices()));
    }
    addFaceValues(content, corners, numCorners, &tinyobj::index_t::texcoord_index, &content.uvs);
    addFaceValues(content, corners, numCorners, &tinyobj::index_t::normal_index, &content.normals);
    mesh.faceSizes.push_back(numCorners);
}

/// Texture coordinates become two numbers wide, unless the third is used.
void addChannel(Attribute *attribute, Mesh *mesh) {
    if (attribute->faceValues.empty()) {
        if (!attribute->values.empty()) {
            AddNotRead(std::string(attribute->name) + "s that no face has", mesh);
        }
        return;
    }
    FVarChannel channel;
    channel.kind = attribute->kind;
    channel.width = 3;
    channel.values = std::move(attribute->values);
    channel.faceValues = std::move(attribute->faceValues);
    std::vector<float> &values = channel.values;
    bool isFlat = attribute->kind == FVarKind::Uv;
    for (std::size_t i = 2; i < values.size(); i += 3) {
        isFlat = isFlat && values[i] == 0;
    }
    if (isFlat) {
        channel.width = 2;
        for (std::size_t i = 0; i < values.size() / 3; ++i) {
            values[2 * i] = values[3 * i];
            values[2 * i + 1] = values[3 * i + 1];
        }
        values.resize(values.size() / 3 * 2);
    }
    mesh->channels.push_back(std::move(channel));
}

void addVertexProperties(ObjContent *content) {
    Mesh &mesh = content->mesh;
    if (content->hasWeights) {
        mesh.vertexProperties.push_back({"w", NumberType::Float, std::move(content->weights)});
    }
    char const *const names[] = {"red", "green", "blue"};
    for (std::size_t i = 0; i < 3 && content->numColors > 0; ++i) {
        VertexProperty property{names[i], NumberType::Float, {}};
        for (std::size_t place = i; place < content->colors.size(); place += 3) {
            property.values.push_back(content->colors[place]);
        }
        mesh.vertexProperties.push_back(std::move(property));
    }
    std::size_t const numWhite = std::size_t(mesh.GetNumVertices()) - content->numColors;
    if (content->numColors > 0 && numWhite > 0) {
        AddNotRead("lack of colour at " + std::to_string(numWhite) + " vertices (white)", &mesh);
    }
}

} // namespace

Mesh ReadObj(std::string const &path, std::string *content) {
    NormalizeText(path, content);
    blankObjComments(content);
    ObjContent obj{path};
    joinContinuedLines(content, &obj.mesh);
    readStatements(*content, &obj);

    // The callbacks give the corners of a face as they stand.  LoadObj does not: it keeps the
    // number of corners in 8 bits.
    tinyobj::callback_t callbacks;
    callbacks.vertex_cb = &countVertex;
    callbacks.texcoord_cb = &countUv;
    callbacks.normal_cb = &countNormal;
    callbacks.index_cb = &addFace;
    std::istringstream stream(*content);
    std::string warning;
    std::string error;
    if (!tinyobj::LoadObjWithCallback(stream, callbacks, &obj, nullptr, &warning, &error)) {
        throw FileError(path, "cannot be parsed: " + error.substr(0, error.find('\n')));
    }
    if (obj.numVerticesSoFar != obj.mesh.GetNumVertices() ||
        obj.uvs.numValuesSoFar != obj.uvs.GetNumValues() ||
        obj.normals.numValuesSoFar != obj.normals.GetNumValues() ||
        obj.mesh.faceSizes.size() != obj.faceLines.size()) {
        throw FileError(path, "cannot be parsed: vertices, values or faces were skipped");
    }
    addChannel(&obj.uvs, &obj.mesh);
    addChannel(&obj.normals, &obj.mesh);
    addVertexProperties(&obj);
    obj.labels.Finish(&obj.mesh);
    obj.tags.Finish(&obj.mesh);
    return std::move(obj.mesh);
}

} // namespace OpenSubdivHex::Tools::internal

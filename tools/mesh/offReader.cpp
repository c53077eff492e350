// SPDX-License-Identifier: Apache-2.0
#include "fileError.h"
#include "meshReader.h"
#include "meshText.h"
#include "openMeshImporter.h"

#include <OpenMesh/Core/IO/reader/OFFReader.hh>

#include <array>
#include <optional>
#include <utility>

namespace OpenSubdivHex::Tools::internal {

namespace {

/// The header word of an OFF file: the data of its vertices.
struct OffHeader {
    bool isKnown;
    bool hasTexcoords;
    bool hasNormals;
};

/// Takes [ST][C][N]OFF off \p word.  In some files the number of vertices comes behind it without a blank.
OffHeader takeHeader(std::string_view *word) {
    auto take = [word](std::string_view prefix) {
        bool const found = word->substr(0, prefix.size()) == prefix;
        word->remove_prefix(found ? prefix.size() : 0);
        return found;
    };
    OffHeader header{};
    header.hasTexcoords = take("ST");
    take("C"); // colours are known by their numbers: they may stand in any file
    header.hasNormals = take("N");
    header.isKnown = take("OFF") && (word->empty() || word->find_first_of("0123456789") == 0);
    return header;
}

using Words = std::vector<std::string_view>;

/// The colours of vertices or of faces: three or four numbers, integers to 255 or others to 1.
struct Colors {
    static constexpr std::array<char const *, 4> kNames = {"red", "green", "blue", "alpha"};

    /// Reads the next colour, if any; gives what is wrong with it, or nothing.
    std::string Read(Words const &words) {
        hasAny = hasAny || !words.empty();
        if (words.size() > 4) {
            return "too many values";
        }
        areAlike = areAlike && (words.size() == 3 || words.size() == 4) &&
                   (width == 0 || width == words.size());
        width = words.size();
        for (std::string_view word : words) {
            float value = 0;
            if (!ParseFiniteFloat(word, &value)) {
                return "'" + std::string(word.substr(0, 40)) + "', which is " +
                       NameFloatFailure(word);
            }
            int integer = 0;
            areBytes = areBytes && ParseInt(word, &integer) && integer >= 0 && integer <= 255;
            values.push_back(value);
        }
        return "";
    }

    NumberType GetType() const { return areBytes ? NumberType::UChar : NumberType::Float; }

    /// Adds a property for each number of the colours to \p properties; false if these are not
    /// alike, or more of some items than of others.
    template <typename PROPERTY>
    bool AddTo(std::vector<PROPERTY> *properties) const {
        for (std::size_t i = 0; hasAny && areAlike && i < width; ++i) {
            PROPERTY property{kNames[i], GetType(), {}};
            for (std::size_t place = i; place < values.size(); place += width) {
                property.values.push_back(values[place]);
            }
            properties->push_back(std::move(property));
        }
        return !hasAny || areAlike;
    }

    std::vector<float> values{};
    std::size_t width = 0;
    bool hasAny = false;
    bool areAlike = true; ///< as many numbers each
    bool areBytes = true;
};

/// Takes normals, colours and texture coordinates, in this order, behind the coordinates of a
/// vertex, and the colour behind the corners of a face.  OpenMesh has colours in 8 bits alone.
class OffExtras : public ExtrasReader {
public:
    explicit OffExtras(OffHeader const &header) {
        if (header.hasNormals) {
            _normals = {makeProperty("nx"), makeProperty("ny"), makeProperty("nz")};
        }
        if (header.hasTexcoords) {
            _texcoords = {makeProperty("s"), makeProperty("t")};
        }
    }

    std::string ReadVertex(Words const &words) override {
        std::size_t const numOthers = _normals.size() + _texcoords.size();
        if (words.size() < numOthers) {
            return "too few values";
        }
        auto const colors = words.begin() + std::ptrdiff_t(_normals.size());
        auto const texcoords = words.end() - std::ptrdiff_t(_texcoords.size());
        std::string cause = take({words.begin(), colors}, &_normals);
        cause = cause.empty() ? _vertexColors.Read({colors, texcoords}) : cause;
        cause = cause.empty() ? take({texcoords, words.end()}, &_texcoords) : cause;
        return cause;
    }

    std::string ReadFace(Words const &words) override { return _faceColors.Read(words); }

    void AddTo(Mesh *mesh) {
        auto const append = [mesh](std::vector<VertexProperty> &&properties) {
            for (VertexProperty &property : properties) {
                mesh->vertexProperties.push_back(std::move(property));
            }
        };
        append(std::move(_normals));
        if (!_vertexColors.AddTo(&mesh->vertexProperties)) {
            AddNotRead("colours of vertices, not all of which have one alike", mesh);
        }
        append(std::move(_texcoords));
        if (!_faceColors.AddTo(&mesh->faceProperties)) {
            AddNotRead("colours of faces, not all of which have one alike", mesh);
        }
    }

private:
    static VertexProperty makeProperty(char const *name) { return {name, NumberType::Float, {}}; }

    static std::string take(Words const &words, std::vector<VertexProperty> *properties) {
        for (std::size_t i = 0; i < words.size(); ++i) {
            float value = 0;
            if (!ParseFiniteFloat(words[i], &value)) {
                return "'" + std::string(words[i].substr(0, 40)) + "', which is " +
                       NameFloatFailure(words[i]);
            }
            (*properties)[i].values.push_back(value);
        }
        return "";
    }

    std::vector<VertexProperty> _normals{};
    std::vector<VertexProperty> _texcoords{};
    Colors _vertexColors{};
    Colors _faceColors{};
};

} // namespace

Mesh ReadOff(std::string const &path, std::string *content) {
    // Before NormalizeText, which refuses binary files with another reason.
    std::string_view firstLine = SkipByteOrderMark(*content);
    firstLine = firstLine.substr(0, firstLine.find_first_of("\r\n"));
    std::string_view firstWord = TakeWord(&firstLine);
    if (takeHeader(&firstWord).isKnown && TakeWord(&firstLine) == "BINARY") {
        throw FileError(path, "is a binary OFF file, only text is supported");
    }
    NormalizeText(path, content);
    BlankComments(content);

    // The header word and the counts, which may share a line; the number of edges may be missing.
    std::string_view body = *content;
    std::optional<OffHeader> header;
    std::vector<std::string_view> counts;
    int numLines = 0;
    while (counts.size() < 2 && !body.empty()) {
        ++numLines;
        for (std::string_view word : SplitWords(TakeLine(&body))) {
            header = header ? header : takeHeader(&word);
            if (!word.empty()) {
                counts.push_back(word);
            }
        }
    }
    if (!header || !header->isKnown) {
        throw FileError(path,
                        "does not begin with OFF, COFF, NOFF, STOFF or a combination of them");
    }
    int numVertices = 0;
    int numFaces = 0;
    int numEdges = 0;
    std::string const place = "line " + std::to_string(numLines) + ": ";
    if (counts.size() < 2 || counts.size() > 3 || !ParseInt(counts[0], &numVertices) ||
        !ParseInt(counts[1], &numFaces) ||
        (counts.size() == 3 && !ParseInt(counts[2], &numEdges))) {
        throw FileError(path, place + "the numbers of vertices, faces and edges are expected");
    }
    for (auto const &[count, name] : {std::pair(numVertices, "vertices"), {numFaces, "faces"}}) {
        if (count < 0) {
            throw FileError(path, place + std::to_string(count) + " is not a number of " + name);
        }
    }

    std::string const openMeshHeader =
        "OFF\n" + std::to_string(numVertices) + " " + std::to_string(numFaces) + " 0\n";
    OpenMeshInput input{path, openMeshHeader, body};
    input.numHeaderLines = numLines;
    input.numVertices = numVertices;
    input.numFaces = numFaces;
    OffExtras extras(*header);
    Mesh mesh = ReadThroughOpenMesh(OpenMesh::IO::OFFReader(), input, extras);
    extras.AddTo(&mesh);
    return mesh;
}

} // namespace OpenSubdivHex::Tools::internal

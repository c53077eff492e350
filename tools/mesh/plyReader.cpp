// SPDX-License-Identifier: Apache-2.0
#include "fileError.h"
#include "meshReader.h"
#include "meshText.h"
#include "openMeshImporter.h"

#include <OpenMesh/Core/IO/reader/PLYReader.hh>

#include <array>

namespace OpenSubdivHex::Tools::internal {

namespace {

struct TypeName {
    std::string_view name;
    std::string_view alias;
    std::string_view sameWidthCount; ///< a type that OpenMesh takes for the length of a list
};

constexpr std::array<TypeName, 8> kTypes = {{{"char", "int8", "uchar"},
                                             {"uchar", "uint8", "uchar"},
                                             {"short", "int16", "uint16"},
                                             {"ushort", "uint16", "uint16"},
                                             {"int", "int32", "int"},
                                             {"uint", "uint32", "int"},
                                             {"float", "float32", ""},
                                             {"double", "float64", ""}}};

TypeName const *findType(std::string_view word) {
    for (TypeName const &type : kTypes) {
        if (word == type.name || word == type.alias) {
            return &type;
        }
    }
    return nullptr;
}

/// \brief Reads the header and writes one that OpenMesh reads rightly.
///
/// OpenMesh loses its place, without a word, in files with comments before the end of the header,
/// list properties other than the corners, and colours in some types.  The header written has no
/// comments and no names but those of the coordinates and corners; what that does not mend is
/// refused.
class PlyHeader {
public:
    PlyHeader(std::string const &path, std::string_view content) : _path(path), _body(content) {
        std::string_view const magic = nextLine();
        if (magic != "ply" && magic != "PLY") {
            throw FileError(path, "does not begin with 'ply'");
        }
        _header = "ply\n";
        bool hasEnd = false;
        while (!hasEnd && !_body.empty()) {
            std::vector<std::string_view> const words = SplitWords(nextLine());
            hasEnd = !words.empty() && words[0] == "end_header";
            if (!words.empty() && !hasEnd) {
                parseStatement(words);
            }
        }
        if (!hasEnd) {
            refuse("the header has no end");
        }
        if (!_hasFormat || !_hasFaces || _numCoordinates != 3 || !_hasCorners) {
            throw FileError(_path,
                            _hasFaces || !_hasFormat
                                ? "the header lacks the format, x, y and z, or vertex_indices"
                                : "has no faces");
        }
        _header += "end_header\n";
    }

    OpenMeshInput GetInput() const {
        OpenMeshInput input{_path, _header, _body};
        input.numHeaderLines = _numLines;
        input.numVertices = _numVertices;
        input.numFaces = _numFaces;
        input.isText = _isText;
        input.numVertexWords = _numVertexWords;
        input.maxFaceExtras = _numFaceExtras;
        input.mayHaveMore = _hasMore;
        return input;
    }

    bool IsText() const { return _isText; }

private:
    enum class Element { None, Vertex, Face, Later };

    std::string_view nextLine() {
        std::string_view line = TakeLine(&_body);
        if (!line.empty() && line.back() == '\r') {
            line.remove_suffix(1);
        }
        ++_numLines;
        return line;
    }

    [[noreturn]] void refuse(std::string const &cause) const {
        throw FileError(_path, "line " + std::to_string(_numLines) + ": " + cause);
    }

    void parseStatement(std::vector<std::string_view> const &words) {
        if (words[0] == "comment" || words[0] == "obj_info") {
            return;
        }
        if (words[0] == "format" && words.size() == 3 && !_hasFormat) {
            parseFormat(words);
        } else if (words[0] == "element" && words.size() == 3) {
            parseElement(words);
        } else if (words[0] == "property" && words.size() == 3 && findType(words[1])) {
            parseScalar(*findType(words[1]), words[2]);
        } else if (words[0] == "property" && words.size() == 5 && words[1] == "list" &&
                   findType(words[2]) && findType(words[3])) {
            parseList(*findType(words[2]), *findType(words[3]), words[4]);
        } else {
            refuse("'" + std::string(words[0].substr(0, 40)) + "' statement is not valid here");
        }
    }

    void parseFormat(std::vector<std::string_view> const &words) {
        _isText = words[1] == "ascii";
        if ((!_isText && words[1] != "binary_little_endian" && words[1] != "binary_big_endian") ||
            words[2] != "1.0") {
            refuse("format '" + std::string(words[1]) + " " + std::string(words[2]) +
                   "' is not supported");
        }
        _hasFormat = true;
        _header += "format " + std::string(words[1]) + " 1.0\n";
    }

    void parseElement(std::vector<std::string_view> const &words) {
        int count = 0;
        if (!ParseInt(words[2], &count) || count < 0) {
            refuse("'" + std::string(words[2]) + "' is not a number of elements");
        }
        if (words[1] == "vertex" && _element == Element::None) {
            _element = Element::Vertex;
            _numVertices = count;
        } else if (words[1] == "face" && _element == Element::Vertex) {
            _element = Element::Face;
            _hasFaces = true;
            _numFaces = count;
        } else if (_hasFaces && words[1] != "vertex" && words[1] != "face") {
            _element = Element::Later;
            _hasMore = _hasMore || count > 0;
            return;
        } else {
            refuse("element '" + std::string(words[1]) +
                   "' is not supported before the elements 'vertex' and 'face', in this order");
        }
        _header += "element " + std::string(words[1]) + " " + std::to_string(count) + "\n";
    }

    void parseScalar(TypeName const &type, std::string_view name) {
        if (_element == Element::Vertex) {
            ++_numVertexWords;
        }
        bool const isCoordinate =
            _element == Element::Vertex && (name == "x" || name == "y" || name == "z");
        if (isCoordinate) {
            if (type.name != "float" && type.name != "double") {
                refuse("coordinates of type " + std::string(type.name) + " are not supported");
            }
            ++_numCoordinates;
        }
        if (_element == Element::Face) {
            if (!_hasCorners) {
                refuse("face property '" + std::string(name) +
                       "' before the face's vertices is not supported");
            }
            ++_numFaceExtras;
        }
        if (_element == Element::None) {
            refuse("a property needs an element");
        }
        if (_element != Element::Later) {
            _header += "property " + std::string(type.name) + " " +
                       (isCoordinate ? std::string(name) : std::string("skipped")) + "\n";
        }
    }

    void parseList(TypeName const &count, TypeName const &type, std::string_view name) {
        if (_element == Element::Later) {
            return;
        }
        bool const isCorners = name == "vertex_indices" || name == "vertex_index";
        if (_element != Element::Face || !isCorners || _hasCorners) {
            refuse("list property '" + std::string(name) + "' is not supported");
        }
        if (count.sameWidthCount.empty() || type.sameWidthCount.empty()) {
            refuse("the vertices of faces need integer types");
        }
        _hasCorners = true;
        _header += "property list " + std::string(count.sameWidthCount) + " " +
                   std::string(type.name) + " vertex_indices\n";
    }

    std::string const &_path;
    std::string_view _body;
    std::string _header;
    int _numLines = 0;
    Element _element = Element::None;
    bool _hasFormat = false;
    bool _isText = false;
    bool _hasFaces = false;
    bool _hasCorners = false;
    bool _hasMore = false;
    std::size_t _numVertexWords = 0;
    int _numCoordinates = 0;
    int _numVertices = 0;
    int _numFaces = 0;
    int _numFaceExtras = 0;
};

} // namespace

Mesh ReadPly(std::string const &path, std::string *content) {
    if (PlyHeader(path, *content).IsText()) {
        NormalizeText(path, content);
    }
    PlyHeader const header(path, *content);
    return ReadThroughOpenMesh(OpenMesh::IO::PLYReader(), header.GetInput());
}

} // namespace OpenSubdivHex::Tools::internal

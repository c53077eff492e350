// SPDX-License-Identifier: Apache-2.0
#include "plyHeader.h"

#include "fileError.h"
#include "meshText.h"

#include <algorithm>

namespace OpenSubdivHex::Tools::internal {

namespace {

std::string quote(std::string_view word) { return "'" + std::string(word.substr(0, 40)) + "'"; }

template <typename NAMED>
bool hasName(std::vector<NAMED> const &all, std::string_view name) {
    return std::any_of(all.begin(), all.end(), [&](NAMED const &one) { return one.name == name; });
}

class Parser {
public:
    Parser(std::string const &path, std::string_view content) : _path(path) {
        _header.body = SkipByteOrderMark(content);
        // All lines end as the first one does.  In binary files '\n' behind '\r' may be a number's.
        std::size_t const end = _header.body.find_first_of("\r\n");
        std::string_view const lineEnd =
            end == std::string_view::npos ? "\n" : _header.body.substr(end, 2);
        _lineEnd = lineEnd[0] == '\r' && lineEnd != "\r\n" ? '\r' : '\n';
    }

    PlyHeader Run() {
        std::vector<std::string_view> const magic = SplitWords(nextLine());
        if (magic.size() != 1 || (magic[0] != "ply" && magic[0] != "PLY")) {
            throw FileError(_path, "does not begin with 'ply'");
        }
        bool hasEnd = false;
        while (!hasEnd && !_header.body.empty()) {
            std::string_view const line = nextLine();
            std::vector<std::string_view> const words = SplitWords(line);
            hasEnd = !words.empty() && words[0] == "end_header";
            if (!words.empty() && !hasEnd) {
                parseStatement(line, words);
            }
        }
        if (!hasEnd) {
            refuse("the header has no end");
        }
        if (!_hasFormat) {
            throw FileError(_path, "the header lacks the format");
        }
        return std::move(_header);
    }

private:
    std::string_view nextLine() {
        std::string_view line = TakeLine(&_header.body, _lineEnd);
        if (!line.empty() && line.back() == '\r') {
            line.remove_suffix(1);
        }
        ++_header.numLines;
        return line;
    }

    [[noreturn]] void refuse(std::string const &cause) const {
        throw FileError(_path, "line " + std::to_string(_header.numLines) + ": " + cause);
    }

    void parseStatement(std::string_view line, std::vector<std::string_view> const &words) {
        if (words[0] == "comment" || words[0] == "obj_info") {
            if (words.size() > 2 && words[1] == "TextureFile") {
                _header.textureFile = line.substr(std::size_t(words[2].data() - line.data()));
            }
        } else if (words[0] == "format" && words.size() == 3 && !_hasFormat) {
            parseFormat(words);
        } else if (words[0] == "element" && words.size() == 3) {
            parseElement(words);
        } else if (words[0] == "property" && words.size() == 3) {
            addProperty({std::string(words[2]), findType(words[1])});
        } else if (words[0] == "property" && words.size() == 5 && words[1] == "list") {
            PlyProperty const property{std::string(words[4]), findType(words[3]), true,
                                       findType(words[2])};
            if (!IsInteger(property.countType)) {
                refuse("the lengths of lists need an integer type");
            }
            addProperty(property);
        } else {
            refuse(quote(words[0]) + " statement is not valid here");
        }
    }

    void parseFormat(std::vector<std::string_view> const &words) {
        _header.isText = words[1] == "ascii";
        _header.isBigEndian = words[1] == "binary_big_endian";
        if ((!_header.isText && !_header.isBigEndian && words[1] != "binary_little_endian") ||
            words[2] != "1.0") {
            refuse("format '" + std::string(words[1]) + " " + std::string(words[2]) +
                   "' is not supported");
        }
        _hasFormat = true;
    }

    void parseElement(std::vector<std::string_view> const &words) {
        int count = 0;
        if (!ParseInt(words[2], &count) || count < 0) {
            refuse(quote(words[2]) + " is not a number of elements");
        }
        if (hasName(_header.elements, words[1])) {
            refuse("there is an element " + quote(words[1]) + " already");
        }
        _header.elements.push_back({std::string(words[1]), count});
    }

    NumberType findType(std::string_view word) const {
        NumberType type = NumberType::Float;
        if (!FindNumberType(word, &type)) {
            refuse(quote(word) + " is not a type of numbers");
        }
        return type;
    }

    void addProperty(PlyProperty const &property) {
        if (_header.elements.empty()) {
            refuse("a property needs an element");
        }
        PlyElement &element = _header.elements.back();
        if (hasName(element.properties, property.name)) {
            refuse("element " + quote(element.name) + " has a property " + quote(property.name) +
                   " already");
        }
        element.properties.push_back(property);
    }

    std::string const &_path;
    PlyHeader _header;
    char _lineEnd = '\n'; ///< the last character of lines
    bool _hasFormat = false;
};

} // namespace

PlyHeader ParsePlyHeader(std::string const &path, std::string_view content) {
    return Parser(path, content).Run();
}

} // namespace OpenSubdivHex::Tools::internal

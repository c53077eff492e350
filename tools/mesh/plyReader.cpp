// SPDX-License-Identifier: Apache-2.0
//
// PLY files are read here and not by OpenMesh, which keeps neither names nor types of properties,
// has 0 for coordinates that are integers, and loses its place, without a word, behind lists other
// than the corners and colours of some types.
#include "fileError.h"
#include "meshReader.h"
#include "meshText.h"
#include "plyHeader.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace OpenSubdivHex::Tools::internal {

namespace {

/// An item that is being read, for messages: "face 7".
struct Item {
    std::string GetName() const { return element->name + " " + std::to_string(index); }

    PlyElement const *element = nullptr;
    int index = 0;
};

/// Takes numbers off a text in which every item stands on a line of its own.
class TextSource {
public:
    TextSource(std::string const &path, PlyHeader const &header)
        : _path(path), _text(header.body), _numLines(header.numLines) {}

    /// False at the end.
    bool BeginItem(Item const &item) {
        _item = item;
        do {
            if (_text.empty()) {
                return false;
            }
            _line = TakeLine(&_text);
            ++_numLines;
            _word = TakeWord(&_line);
        } while (_word.empty());
        return true;
    }

    void EndItem() const {
        if (!_word.empty()) {
            Refuse("the line of " + _item.GetName() + " has too many values");
        }
    }

    /// Whether there may be \p count more numbers in this item, by its length.
    bool MayHave(double count) const { return count <= double(_line.size() + 1); }

    double Take(NumberType type) {
        if (_word.empty()) {
            Refuse("the line of " + _item.GetName() + " ends too early");
        }
        double number = 0;
        if (!parse(type, &number)) {
            std::string const what = type == NumberType::Float ? NameFloatFailure(_word)
                                     : IsInteger(type)         ? "not a number"
                                                               : "not a finite number";
            Refuse("'" + std::string(_word.substr(0, 40)) + "' is " + what + " of type " +
                   Tools::GetName(type));
        }
        _word = TakeWord(&_line);
        return number;
    }

    bool IsAtEnd() {
        std::string_view rest = _text;
        return TakeWord(&rest).empty();
    }

    [[noreturn]] void Refuse(std::string const &cause) const {
        throw FileError(_path, "line " + std::to_string(_numLines) + ": " + cause);
    }

private:
    bool parse(NumberType type, double *number) const {
        if (type == NumberType::Float) {
            float value = 0;
            bool const isParsed = ParseFiniteFloat(_word, &value);
            *number = value;
            return isParsed;
        }
        bool const hasPlus = _word.front() == '+';
        char const *const begin = _word.data() + (hasPlus ? 1 : 0);
        char const *const end = _word.data() + _word.size();
        if (type == NumberType::Double) {
            auto const result = std::from_chars(begin, end, *number);
            return result.ec == std::errc() && result.ptr == end && std::isfinite(*number);
        }
        std::int64_t integer = 0;
        auto const result = std::from_chars(begin, end, integer);
        *number = double(integer);
        return result.ec == std::errc() && result.ptr == end && *number >= GetMin(type) &&
               *number <= GetMax(type);
    }

    std::string const &_path;
    std::string_view _text; ///< behind the line
    int _numLines;
    std::string_view _line{}; ///< behind the word
    std::string_view _word{}; ///< that is taken next
    Item _item{};
};

/// Reads numbers of a binary file.
class BinarySource {
public:
    BinarySource(std::string const &path, PlyHeader const &header)
        : _path(path), _bytes(header.body), _isBigEndian(header.isBigEndian) {}

    bool BeginItem(Item const &item) {
        _item = item;
        return !_bytes.empty();
    }
    void EndItem() const {}

    bool MayHave(double count) const { return count <= double(_bytes.size()); }

    double Take(NumberType type) {
        switch (type) {
        case NumberType::Char:
            return take<std::int8_t>();
        case NumberType::UChar:
            return take<std::uint8_t>();
        case NumberType::Short:
            return take<std::int16_t>();
        case NumberType::UShort:
            return take<std::uint16_t>();
        case NumberType::Int:
            return take<std::int32_t>();
        case NumberType::UInt:
            return take<std::uint32_t>();
        case NumberType::Float:
            return double(take<float>());
        case NumberType::Double:
            break;
        }
        return take<double>();
    }

    bool IsAtEnd() const { return _bytes.empty(); }

    [[noreturn]] void Refuse(std::string const &cause) const { throw FileError(_path, cause); }

private:
    template <typename T>
    T take() {
        if (_bytes.size() < sizeof(T)) {
            Refuse("ends too early, in " + _item.GetName());
        }
        // Both orders are put together from bytes, so that the machine's own does not matter.
        using Bits = std::conditional_t<
            sizeof(T) == 8, std::uint64_t,
            std::conditional_t<sizeof(T) == 4, std::uint32_t,
                               std::conditional_t<sizeof(T) == 2, std::uint16_t, std::uint8_t>>>;
        std::uint64_t bits = 0;
        for (std::size_t i = 0; i < sizeof(T); ++i) {
            std::size_t const shift = 8 * (_isBigEndian ? sizeof(T) - 1 - i : i);
            bits |= std::uint64_t(static_cast<unsigned char>(_bytes[i])) << shift;
        }
        _bytes.remove_prefix(sizeof(T));
        Bits const narrow = Bits(bits);
        T value;
        std::memcpy(&value, &narrow, sizeof value);
        return value;
    }

    std::string const &_path;
    std::string_view _bytes;
    bool _isBigEndian;
    Item _item{};
};

bool isCorners(PlyProperty const &property) {
    return property.isList &&
           (property.name == "vertex_indices" || property.name == "vertex_index");
}

/// 0 to 2 for x, y and z; else -1.
int findAxis(PlyProperty const &property) {
    constexpr std::string_view kAxes[] = {"x", "y", "z"};
    auto const *const axis = std::find(std::begin(kAxes), std::end(kAxes), property.name);
    return property.isList || axis == std::end(kAxes) ? -1 : int(axis - kAxes);
}

template <typename SOURCE>
class BodyReader {
public:
    BodyReader(std::string const &path, PlyHeader const &header)
        : _path(path), _header(header), _source(path, header) {}

    Mesh Run() {
        PlyElement const *const vertices = find("vertex");
        PlyElement const *const faces = find("face");
        if (!faces) {
            throw FileError(_path, find("tristrips") ? "has no faces, and its element tristrips is "
                                                       "not read"
                                                     : "has no faces");
        }
        if (!vertices || std::count_if(vertices->properties.begin(), vertices->properties.end(),
                                       [](PlyProperty const &property) {
                                           return findAxis(property) >= 0;
                                       }) != 3) {
            throw FileError(_path, "the header lacks vertices with x, y and z");
        }
        auto const corners =
            std::find_if(faces->properties.begin(), faces->properties.end(), isCorners);
        if (corners == faces->properties.end()) {
            throw FileError(_path, "the header lacks faces with vertex_indices");
        }
        if (!IsInteger(corners->type)) {
            throw FileError(_path, "the vertices of faces need an integer type, not " +
                                       std::string(GetName(corners->type)));
        }
        _corners = &*corners;
        _numVertices = vertices->count;
        if (!_header.textureFile.empty()) {
            AddNotRead("texture file " + _header.textureFile, &_mesh);
        }
        for (PlyElement const &element : _header.elements) {
            if (&element == vertices) {
                readVertices(element);
            } else if (&element == faces) {
                readFaces(element);
            } else {
                readOther(element);
            }
        }
        if (!_source.IsAtEnd()) {
            throw FileError(_path, "has more content behind its " +
                                       std::to_string(_header.elements.back().count) + " items '" +
                                       _header.elements.back().name + "'");
        }
        return std::move(_mesh);
    }

private:
    PlyElement const *find(std::string_view name) const {
        for (PlyElement const &element : _header.elements) {
            if (element.name == name) {
                return &element;
            }
        }
        return nullptr;
    }

    /// Calls readItem() for every item of \p element.
    template <typename READ_ITEM>
    void readItems(PlyElement const &element, READ_ITEM readItem) {
        for (int i = 0; i < element.count; ++i) {
            if (!_source.BeginItem({&element, i})) {
                throw FileError(_path, "ends too early: it has " + std::to_string(i) + " of " +
                                           std::to_string(element.count) + " items '" +
                                           element.name + "'");
            }
            readItem(i);
            _source.EndItem();
        }
    }

    int takeCount(PlyProperty const &list, Item const &item) {
        double const count = _source.Take(list.countType);
        constexpr double kMostNumbers = std::numeric_limits<int>::max();
        if (count > kMostNumbers && _source.MayHave(count)) {
            _source.Refuse(item.GetName() + " has a list '" + list.name + "' of " +
                           std::to_string(std::int64_t(count)) + " numbers, more than 2147483647");
        }
        if (count < 0 || !_source.MayHave(count)) {
            _source.Refuse(item.GetName() + " has a list '" + list.name + "' of " +
                           std::to_string(std::int64_t(count)) + " numbers, which are not there");
        }
        return int(count);
    }

    void skipList(PlyProperty const &list, Item const &item) {
        int const count = takeCount(list, item);
        for (int i = 0; i < count; ++i) {
            _source.Take(list.type);
        }
    }

    void readVertices(PlyElement const &element) {
        struct Column {
            int axis;
            std::size_t property; ///< of the mesh
            bool isRounded = false;
        };
        std::vector<Column> columns;
        for (PlyProperty const &property : element.properties) {
            columns.push_back({findAxis(property), _mesh.vertexProperties.size()});
            if (property.isList) {
                AddNotRead("list " + property.name + " of vertices", &_mesh);
            } else if (columns.back().axis < 0) {
                _mesh.vertexProperties.push_back({property.name, property.type, {}});
            }
        }
        readItems(element, [&](int index) {
            std::size_t const place = _mesh.positions.size();
            _mesh.positions.resize(place + 3);
            for (std::size_t i = 0; i < columns.size(); ++i) {
                PlyProperty const &property = element.properties[i];
                if (property.isList) {
                    skipList(property, {&element, index});
                    continue;
                }
                Column &column = columns[i];
                double const number = _source.Take(property.type);
                float const value = float(number);
                if (!std::isfinite(value)) {
                    _source.Refuse("vertex " + std::to_string(index) + " has a " +
                                   (column.axis < 0 ? property.name : "coordinate") + " that is " +
                                   (std::isfinite(number) ? "out of the range of floats"
                                                          : "not a finite number"));
                }
                column.isRounded = column.isRounded || double(value) != number;
                if (column.axis < 0) {
                    _mesh.vertexProperties[column.property].values.push_back(value);
                } else {
                    _mesh.positions[place + std::size_t(column.axis)] = value;
                }
            }
        });
        for (std::size_t i = 0; i < columns.size(); ++i) {
            if (columns[i].isRounded) {
                AddNotRead("digits of " + element.properties[i].name + " that floats do not have",
                           &_mesh);
            }
        }
    }

    void readFaces(PlyElement const &element) {
        for (PlyProperty const &property : element.properties) {
            if (!property.isList) {
                _mesh.faceProperties.push_back({property.name, property.type, {}});
            } else if (&property != _corners) {
                AddNotRead("list " + property.name + " of faces", &_mesh);
            }
        }
        readItems(element, [&](int index) {
            std::size_t scalar = 0;
            for (PlyProperty const &property : element.properties) {
                if (&property == _corners) {
                    readCorners({&element, index});
                } else if (property.isList) {
                    skipList(property, {&element, index});
                } else {
                    double const number = _source.Take(property.type);
                    if (!std::isfinite(number)) {
                        _source.Refuse("face " + std::to_string(index) + " has a " + property.name +
                                       " that is not a finite number");
                    }
                    _mesh.faceProperties[scalar++].values.push_back(number);
                }
            }
        });
    }

    void readCorners(Item const &item) {
        int const count = takeCount(*_corners, item);
        if (count < 3) {
            _source.Refuse(item.GetName() + " has " + std::to_string(count) +
                           " corners, three are needed");
        }
        for (int i = 0; i < count; ++i) {
            double const vertex = _source.Take(_corners->type);
            if (vertex < 0 || vertex >= _numVertices) {
                _source.Refuse(item.GetName() + " has the vertex index " +
                               std::to_string(std::int64_t(vertex)) + ", which is out of range");
            }
            _mesh.faceVertices.push_back(int(vertex));
        }
        _mesh.faceSizes.push_back(count);
    }

    void readOther(PlyElement const &element) {
        if (element.count == 0 || element.properties.empty()) {
            return;
        }
        AddNotRead("element " + element.name, &_mesh);
        readItems(element, [&](int index) {
            for (PlyProperty const &property : element.properties) {
                if (property.isList) {
                    skipList(property, {&element, index});
                } else {
                    _source.Take(property.type);
                }
            }
        });
    }

    std::string const &_path;
    PlyHeader const &_header;
    SOURCE _source;
    PlyProperty const *_corners = nullptr;
    int _numVertices = 0;
    Mesh _mesh;
};

} // namespace

Mesh ReadPly(std::string const &path, std::string *content) {
    if (ParsePlyHeader(path, *content).isText) {
        NormalizeText(path, content);
    }
    PlyHeader const header = ParsePlyHeader(path, *content);
    return header.isText ? BodyReader<TextSource>(path, header).Run()
                         : BodyReader<BinarySource>(path, header).Run();
}

} // namespace OpenSubdivHex::Tools::internal

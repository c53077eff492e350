// SPDX-License-Identifier: Apache-2.0
#include "meshOutput.h"

#include "meshContent.h"

#include "far_ext/executor.h"

#include <algorithm>
#include <charconv>
#include <condition_variable>
#include <cstring>
#include <mutex>
#include <utility>

namespace OpenSubdivHex::Tools {

namespace {

/// Enough for a float or an index and the character before or after it.
constexpr std::size_t kMaxNumber = 16;

/// Items of a text that a thread prints.
constexpr std::size_t kRangeSize = 4096;

/// \brief Writes texts that threads print, in order: who prints the next one writes it, and those
/// behind it that were printed before.
class OrderedWriter {
public:
    OrderedWriter(std::size_t numTexts, std::size_t numThreads, WriteBytes const &write)
        : _write(write), _numTexts(numTexts), _texts(kTextsPerThread * numThreads) {}

    /// Prints and writes texts until none is left; each thread calls it.
    /// \param print  print(index, memory) prints into \p memory, which may be of any size, and
    ///               gives the number of characters
    template <typename PRINT>
    void Work(PRINT print) {
        Text text;
        std::unique_lock<std::mutex> lock(_mutex);
        while (_next < _numTexts && !_hasFailed) {
            // Who prints the one to be written next is at work, and is not this thread.
            if (_next == _numWritten + _texts.size()) {
                _hasRoom.wait(lock);
                continue;
            }
            std::size_t const index = _next++;
            runUnlocked(lock, [&] { text.size = print(index, text.memory); });
            text.isPrinted = true;
            std::swap(text, placeOf(index));
            if (!_isWriting) {
                writePrinted(lock);
            }
        }
    }

private:
    struct Text {
        std::vector<char> memory;
        std::size_t size = 0;
        bool isPrinted = false; ///< and not written yet
    };
    static constexpr std::size_t kTextsPerThread = 4;

    Text &placeOf(std::size_t index) { return _texts[index % _texts.size()]; }

    // One thread at a time writes, while the others print.
    void writePrinted(std::unique_lock<std::mutex> &lock) {
        _isWriting = true;
        while (placeOf(_numWritten).isPrinted && !_hasFailed) {
            Text &text = placeOf(_numWritten);
            runUnlocked(lock, [&] { _write({text.memory.data(), text.size}); });
            text.isPrinted = false;
            ++_numWritten;
            _hasRoom.notify_all();
        }
        _isWriting = false;
    }

    template <typename WORK>
    void runUnlocked(std::unique_lock<std::mutex> &lock, WORK work) {
        lock.unlock();
        try {
            work();
        } catch (...) {
            lock.lock();
            _hasFailed = true;
            _hasRoom.notify_all();
            throw;
        }
        lock.lock();
    }

    WriteBytes const &_write;
    std::size_t const _numTexts;
    std::mutex _mutex; // guards the rest, but for texts that are written or being printed
    std::vector<Text> _texts;
    std::size_t _next = 0;
    std::size_t _numWritten = 0;
    bool _isWriting = false;
    bool _hasFailed = false;
    std::condition_variable _hasRoom;
};

/// \brief Prints \p count items in parallel, and writes them in order.
///
/// \param getMaxSize  most characters of items [begin, end)
/// \param print       prints items [begin, end) to a place for so many, and gives its end
template <typename GET_MAX_SIZE, typename PRINT>
void writeItems(std::size_t count, GET_MAX_SIZE getMaxSize, PRINT print, WriteBytes const &write) {
    if (count == 0) {
        return;
    }
    if (count <= kRangeSize) { // nobody can help
        std::vector<char> memory(getMaxSize(0, count));
        write({memory.data(), std::size_t(print(0, count, memory.data()) - memory.data())});
        return;
    }
    int const numThreads = FarExt::GetNumThreads();
    OrderedWriter writer((count + kRangeSize - 1) / kRangeSize, std::size_t(numThreads), write);
    auto const printRange = [&](std::size_t range, std::vector<char> &memory) {
        std::size_t const begin = range * kRangeSize;
        std::size_t const end = std::min(begin + kRangeSize, count);
        memory.resize(std::max(getMaxSize(begin, end), memory.size()));
        return std::size_t(print(begin, end, memory.data()) - memory.data());
    };
    FarExt::ParallelFor(numThreads, [&](int) { writer.Work(printRange); });
}

template <typename T>
char *printNumber(char *out, T value) {
    return std::to_chars(out, out + kMaxNumber, value).ptr;
}

char *printWord(char *out, std::string_view word) {
    return std::copy(word.begin(), word.end(), out);
}

/// Writes a line for each \p width numbers, "KEYWORD x y z\n", the keyword with its space.
void writeValues(std::string_view keyword, std::vector<float> const &values, int width,
                 WriteBytes const &write) {
    auto const print = [&](std::size_t begin, std::size_t end, char *out) {
        float const *value = values.data() + begin * std::size_t(width);
        for (std::size_t i = begin; i < end; ++i) {
            out = printWord(out, keyword);
            for (int k = 0; k < width; ++k) {
                out = printNumber(out, *value++);
                *out++ = k < width - 1 ? ' ' : '\n';
            }
        }
        return out;
    };
    std::size_t const maxSize = keyword.size() + std::size_t(width) * kMaxNumber;
    writeItems(
        values.size() / std::size_t(width),
        [=](std::size_t begin, std::size_t end) { return (end - begin) * maxSize; }, print, write);
}

/// \brief Prints all faces in parallel.
///
/// \param getMaxFace  most characters for a face, beside those for each of its corners
/// \param maxCorner   most characters for a corner
/// \param printFace   prints a face: its index, its first corner, and where to
template <typename GET_MAX_FACE, typename PRINT_FACE>
void writeFaces(Mesh const &mesh, GET_MAX_FACE getMaxFace, std::size_t maxCorner,
                PRINT_FACE printFace, WriteBytes const &write) {
    std::size_t const numFaces = mesh.faceSizes.size();
    std::vector<std::size_t> firstCorners; // of ranges, and the number of corners
    std::size_t corner = 0;
    for (std::size_t face = 0; face < numFaces; ++face) {
        if (face % kRangeSize == 0) {
            firstCorners.push_back(corner);
        }
        corner += std::size_t(mesh.faceSizes[face]);
    }
    firstCorners.push_back(corner);
    auto const getMaxSize = [&](std::size_t begin, std::size_t end) {
        std::size_t const range = begin / kRangeSize;
        std::size_t size = (firstCorners[range + 1] - firstCorners[range]) * maxCorner;
        for (std::size_t face = begin; face < end; ++face) {
            size += getMaxFace(int(face));
        }
        return size;
    };
    auto const print = [&](std::size_t begin, std::size_t end, char *out) {
        std::size_t firstCorner = firstCorners[begin / kRangeSize];
        for (std::size_t face = begin; face < end; ++face) {
            out = printFace(int(face), firstCorner, out);
            firstCorner += std::size_t(mesh.faceSizes[face]);
        }
        return out;
    };
    writeItems(numFaces, getMaxSize, print, write);
}

/// Numbers that are written beside the position of a vertex.
struct Column {
    enum class Style { Plain, Integer, WithPoint };

    float const *values;
    float divisor = 1;
    Style style = Style::Plain;
};

/// With a point where OFF would take the number for an integer.
char *printWithPoint(char *out, float value) {
    char *const end = printNumber(out, value);
    bool const isInteger =
        std::all_of(out, end, [](char c) { return c == '-' || (c >= '0' && c <= '9'); });
    return isInteger ? printWord(end, ".0") : end;
}

char *printColumn(char *out, Column const &column, std::size_t i) {
    switch (column.style) {
    case Column::Style::Integer:
        return printNumber(out, int(RoundTo(NumberType::UChar, double(column.values[i]))));
    case Column::Style::WithPoint:
        return printWithPoint(out, column.values[i]);
    case Column::Style::Plain:
        break;
    }
    return printNumber(out, column.values[i] / column.divisor);
}

/// Writes a line for each vertex, "v x y z\n", and the numbers of \p columns behind z.
void writeVertices(std::string_view keyword, Mesh const &mesh, std::vector<Column> const &columns,
                   WriteBytes const &write) {
    if (columns.empty()) {
        writeValues(keyword, mesh.positions, 3, write);
        return;
    }
    auto const print = [&](std::size_t begin, std::size_t end, char *out) {
        for (std::size_t i = begin; i < end; ++i) {
            out = printWord(out, keyword);
            for (std::size_t k = 3 * i; k < 3 * i + 3; ++k) {
                out = printNumber(out, mesh.positions[k]);
                *out++ = ' ';
            }
            for (Column const &column : columns) {
                out = printColumn(out, column, i);
                *out++ = ' ';
            }
            out[-1] = '\n';
        }
        return out;
    };
    // Two more than a number: ".0" may come behind it.
    std::size_t const maxSize = keyword.size() + (3 + columns.size()) * (kMaxNumber + 2);
    writeItems(
        mesh.positions.size() / 3,
        [=](std::size_t begin, std::size_t end) { return (end - begin) * maxSize; }, print, write);
}

/// Calls function(keyword, words) for the statements of OBJ that make one label of another.
template <typename FUNCTION>
void forEachChange(FaceLabel const &before, FaceLabel const &label, FUNCTION function) {
    auto const compare = [&](char const *keyword, std::string FaceLabel::*words) {
        if (label.*words != before.*words) {
            function(keyword, label.*words);
        }
    };
    compare("o", &FaceLabel::object);
    compare("g", &FaceLabel::groups);
    compare("usemtl", &FaceLabel::material);
    compare("s", &FaceLabel::smoothing);
}

/// The statements of OBJ that change the label of a face.
class LabelPrinter {
public:
    explicit LabelPrinter(Mesh const &mesh) : _mesh(mesh) {}

    /// Formats the statements before a face.
    std::string Format(int face) const {
        if (_mesh.faceLabels.empty() || (face > 0 && getIndex(face - 1) == getIndex(face))) {
            return "";
        }
        return FormatLabelChange(face > 0 ? getLabel(face - 1) : FaceLabel{}, getLabel(face));
    }

private:
    int getIndex(int face) const { return _mesh.faceLabels[std::size_t(_mesh.GetBaseFace(face))]; }
    FaceLabel const &getLabel(int face) const { return _mesh.labels[std::size_t(getIndex(face))]; }

    Mesh const &_mesh;
};

std::string makeObjHeader(Mesh const &mesh) {
    std::string header;
    for (std::string const &library : mesh.materialLibraries) {
        header += "mtllib " + library + (library.back() == '\\' ? " \n" : "\n");
    }
    return header;
}

void writeObjVertices(Mesh const &mesh, WriteBytes const &write) {
    std::vector<Column> columns;
    for (std::size_t i : FindContent(MeshFormat::Obj, mesh).vertexProperties) {
        VertexProperty const &property = mesh.vertexProperties[i];
        columns.push_back({property.values.data(),
                           IsInteger(property.type) ? float(GetMax(property.type)) : 1.0f});
    }
    writeVertices("v ", mesh, columns, write);
}

void writeObjFaces(Mesh const &mesh, WriteBytes const &write) {
    int const *uvs = nullptr;
    int const *normals = nullptr;
    for (FVarChannel const &channel : mesh.channels) {
        (channel.kind == FVarKind::Uv ? uvs : normals) = channel.faceValues.data();
    }
    LabelPrinter const labels(mesh);
    // Indices count from 1: "f v ...", "f v/t ...", "f v//n ..." or "f v/t/n ...".
    auto const printIndex = [](char *out, int index) {
        return printNumber(out, std::int64_t(index) + 1);
    };
    auto const printFace = [&](int face, std::size_t firstCorner, char *out) {
        out = printWord(out, labels.Format(face));
        *out++ = 'f';
        std::size_t const size = std::size_t(mesh.faceSizes[std::size_t(face)]);
        for (std::size_t i = firstCorner; i < firstCorner + size; ++i) {
            *out++ = ' ';
            out = printIndex(out, mesh.faceVertices[i]);
            if (uvs || normals) {
                *out++ = '/';
            }
            if (uvs) {
                out = printIndex(out, uvs[i]);
            }
            if (normals) {
                *out++ = '/';
                out = printIndex(out, normals[i]);
            }
        }
        *out++ = '\n';
        return out;
    };
    writeFaces(
        mesh, [&](int face) { return 2 + labels.Format(face).size(); }, 3 * kMaxNumber, printFace,
        write);
}

/// The words of OFF's header for what vertices have, in its order.
std::string makeOffWord(Mesh const &mesh, MeshContent const &content) {
    auto const has = [&](char const *name) {
        return std::any_of(content.vertexProperties.begin(), content.vertexProperties.end(),
                           [&](std::size_t i) { return mesh.vertexProperties[i].name == name; });
    };
    return std::string(has("s") ? "ST" : "") + (has("red") ? "C" : "") + (has("nx") ? "N" : "") +
           "OFF\n";
}

std::string makeOffHeader(Mesh const &mesh, MeshCounts const &counts) {
    return makeOffWord(mesh, FindContent(MeshFormat::Off, mesh)) + std::to_string(counts.vertices) +
           " " + std::to_string(counts.faces) + " 0\n";
}

void writeOffVertices(Mesh const &mesh, WriteBytes const &write) {
    MeshContent const content = FindContent(MeshFormat::Off, mesh);
    std::vector<Column> columns;
    for (std::size_t i : content.vertexProperties) {
        VertexProperty const &property = mesh.vertexProperties[i];
        columns.push_back(
            {property.values.data(), 1,
             IsInteger(property.type) ? Column::Style::Integer : Column::Style::WithPoint});
    }
    writeVertices("", mesh, columns, write);
}

void writeOffFaces(Mesh const &mesh, WriteBytes const &write) {
    MeshContent const content = FindContent(MeshFormat::Off, mesh);
    auto const printFace = [&](int face, std::size_t firstCorner, char *out) {
        int const size = mesh.faceSizes[std::size_t(face)];
        out = printNumber(out, size);
        for (std::size_t i = firstCorner; i < firstCorner + std::size_t(size); ++i) {
            *out++ = ' ';
            out = printNumber(out, mesh.faceVertices[i]);
        }
        for (std::size_t i : content.faceProperties) {
            FaceProperty const &property = mesh.faceProperties[i];
            double const value = property.values[std::size_t(mesh.GetBaseFace(face))];
            *out++ = ' ';
            out = IsInteger(property.type) ? printNumber(out, int(RoundTo(property.type, value)))
                                           : printWithPoint(out, float(value));
        }
        *out++ = '\n';
        return out;
    };
    std::size_t const maxFace = 1 + (1 + content.faceProperties.size()) * (kMaxNumber + 2);
    writeFaces(
        mesh, [=](int) { return maxFace; }, kMaxNumber, printFace, write);
}

/// Appends the bytes of \p value, lowest first, whatever the machine's order.
template <typename T>
char *putBytes(char *out, T value) {
    using Bits = std::conditional_t<sizeof(T) == 8, std::uint64_t, std::uint32_t>;
    static_assert(sizeof(T) == sizeof(Bits));
    Bits bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    for (std::size_t i = 0; i < sizeof bits; ++i) {
        *out++ = char(bits >> (8 * i) & 0xff);
    }
    return out;
}

/// Appends a number of a property, rounded to its type.
char *putNumber(char *out, NumberType type, double value) {
    if (type == NumberType::Float) {
        return putBytes(out, float(value));
    }
    if (type == NumberType::Double) {
        return putBytes(out, value);
    }
    auto const integer = std::int64_t(RoundTo(type, value));
    for (std::size_t i = 0; i < GetSize(type); ++i) {
        *out++ = char(integer >> (8 * i) & 0xff);
    }
    return out;
}

/// The lines of the header for those of \p properties that are \p held, and the bytes that an item has of
/// them.
template <typename PROPERTY>
std::pair<std::string, std::size_t> describeProperties(std::vector<PROPERTY> const &properties,
                                                       std::vector<std::size_t> const &held) {
    std::pair<std::string, std::size_t> result;
    for (std::size_t i : held) {
        PROPERTY const &property = properties[i];
        result.first +=
            std::string("property ") + GetName(property.type) + " " + property.name + "\n";
        result.second += GetSize(property.type);
    }
    return result;
}

std::string makePlyHeader(Mesh const &mesh, MeshCounts const &counts) {
    MeshContent const content = FindContent(MeshFormat::Ply, mesh);
    return "ply\nformat binary_little_endian 1.0\nelement vertex " +
           std::to_string(counts.vertices) +
           "\nproperty float x\nproperty float y\nproperty float z\n" +
           describeProperties(mesh.vertexProperties, content.vertexProperties).first +
           "element face " + std::to_string(counts.faces) + "\nproperty list " +
           (counts.hasShortFaces ? "uchar" : "int") + " int " + kPlyFaceVertices + "\n" +
           describeProperties(mesh.faceProperties, content.faceProperties).first + "end_header\n";
}

void writePlyVertices(Mesh const &mesh, WriteBytes const &write) {
    MeshContent const content = FindContent(MeshFormat::Ply, mesh);
    auto const printVertices = [&](std::size_t begin, std::size_t end, char *out) {
        for (std::size_t i = begin; i < end; ++i) {
            for (std::size_t k = 3 * i; k < 3 * i + 3; ++k) {
                out = putBytes(out, mesh.positions[k]);
            }
            for (std::size_t k : content.vertexProperties) {
                VertexProperty const &property = mesh.vertexProperties[k];
                out = putNumber(out, property.type, double(property.values[i]));
            }
        }
        return out;
    };
    // Bytes of a vertex.
    std::size_t const numBytes =
        12 + describeProperties(mesh.vertexProperties, content.vertexProperties).second;
    writeItems(
        std::size_t(mesh.GetNumVertices()),
        [numBytes](std::size_t begin, std::size_t end) { return numBytes * (end - begin); },
        printVertices, write);
}

void writePlyFaces(Mesh const &mesh, bool hasShortFaces, WriteBytes const &write) {
    MeshContent const content = FindContent(MeshFormat::Ply, mesh);
    auto const printFace = [&](int face, std::size_t firstCorner, char *out) {
        int const size = mesh.faceSizes[std::size_t(face)];
        if (hasShortFaces) {
            *out++ = char(size);
        } else {
            out = putBytes(out, size);
        }
        for (std::size_t i = firstCorner; i < firstCorner + std::size_t(size); ++i) {
            out = putBytes(out, mesh.faceVertices[i]);
        }
        for (std::size_t i : content.faceProperties) {
            FaceProperty const &property = mesh.faceProperties[i];
            out =
                putNumber(out, property.type, property.values[std::size_t(mesh.GetBaseFace(face))]);
        }
        return out;
    };
    std::size_t const maxFace =
        4 + describeProperties(mesh.faceProperties, content.faceProperties).second;
    writeFaces(
        mesh, [=](int) { return maxFace; }, 4, printFace, write);
}

} // namespace

std::string FormatLabelChange(FaceLabel const &before, FaceLabel const &label) {
    std::string text;
    forEachChange(before, label, [&](std::string_view keyword, std::string const &words) {
        text += keyword;
        if (!words.empty()) {
            text += ' ';
            text += words;
            // At the end of a line it would join the next one.
            text += words.back() == '\\' ? " " : "";
        }
        text += '\n';
    });
    return text;
}

bool HasShortFaces(Mesh const &mesh) {
    // One byte for the number of corners is what every reader takes, where it is enough.
    return std::all_of(mesh.faceSizes.begin(), mesh.faceSizes.end(),
                       [](int size) { return size < 256; });
}

void WriteHeader(MeshFormat format, Mesh const &mesh, MeshCounts const &counts,
                 WriteBytes const &write) {
    write(format == MeshFormat::Obj   ? makeObjHeader(mesh)
          : format == MeshFormat::Off ? makeOffHeader(mesh, counts)
                                      : makePlyHeader(mesh, counts));
}

void WriteVertices(MeshFormat format, Mesh const &mesh, WriteBytes const &write) {
    switch (format) {
    case MeshFormat::Obj:
        writeObjVertices(mesh, write);
        break;
    case MeshFormat::Off:
        writeOffVertices(mesh, write);
        break;
    case MeshFormat::Ply:
        writePlyVertices(mesh, write);
        break;
    }
}

void WriteValues(MeshFormat format, FVarChannel const &channel, WriteBytes const &write) {
    if (format == MeshFormat::Obj) {
        writeValues(channel.kind == FVarKind::Uv ? "vt " : "vn ", channel.values, channel.width,
                    write);
    }
}

void WriteFaces(MeshFormat format, Mesh const &mesh, bool hasShortFaces, WriteBytes const &write) {
    switch (format) {
    case MeshFormat::Obj:
        writeObjFaces(mesh, write);
        break;
    case MeshFormat::Off:
        writeOffFaces(mesh, write);
        break;
    case MeshFormat::Ply:
        writePlyFaces(mesh, hasShortFaces, write);
        break;
    }
}

} // namespace OpenSubdivHex::Tools

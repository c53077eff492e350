// SPDX-License-Identifier: Apache-2.0
#include "pieceWriter.h"

#include "fileError.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>
#include <numeric>

namespace OpenSubdivHex::Tools {

namespace {

constexpr std::size_t kBufferSize = std::size_t(1) << 20;

MeshFormat findFormat(std::string const &path) {
    std::optional<MeshFormat> const format = FindMeshFormat(path);
    if (!format) {
        throw FileError(path, std::string("is not a ") + kMeshExtensions + " file");
    }
    return *format;
}

/// Few large parts of many small ones.
class WriteBuffer {
public:
    explicit WriteBuffer(OutputFile &file) : _file(file) {}

    void Write(std::string_view bytes) {
        _bytes += bytes;
        if (_bytes.size() >= kBufferSize) {
            Flush();
        }
    }
    void Flush() {
        _file.Write(_bytes);
        _bytes.clear();
    }

private:
    OutputFile &_file;
    std::string _bytes;
};

} // namespace

PieceWriter::ScratchFile::ScratchFile(std::string const &path)
    : _path(path), _file(OpenScratchFile(path)) {}

void PieceWriter::ScratchFile::Write(std::string_view bytes) {
    errno = 0;
    if (std::fwrite(bytes.data(), 1, bytes.size(), _file.get()) != bytes.size()) {
        refuse();
    }
    _size += std::int64_t(bytes.size());
}

void PieceWriter::ScratchFile::Read(std::int64_t offset, std::int64_t size,
                                    WriteBytes const &write) {
    errno = 0;
    if (fseeko(_file.get(), off_t(offset), SEEK_SET) != 0) {
        refuse();
    }
    std::vector<char> bytes(std::min(kBufferSize, std::size_t(size)));
    while (size > 0) {
        std::size_t const count = std::min(bytes.size(), std::size_t(size));
        if (std::fread(bytes.data(), 1, count, _file.get()) != count) {
            refuse();
        }
        write({bytes.data(), count});
        size -= std::int64_t(count);
    }
}

void PieceWriter::ScratchFile::refuse() const {
    throw FileError(_path, std::string("cannot be written: ") + std::strerror(errno));
}

PieceWriter::PieceWriter(Mesh const &mesh, std::string const &path)
    : _mesh(mesh), _path(path), _format(findFormat(path)), _file(path), _vertices(path),
      _faces(path), _numValues(mesh.channels.size()) {
    for (std::size_t i = 0; i < mesh.channels.size(); ++i) {
        _values.push_back(std::make_unique<ScratchFile>(path));
    }
}

void PieceWriter::Add(Mesh const &piece) {
    _counts.vertices += piece.GetNumVertices();
    _counts.faces += piece.GetNumFaces();
    _counts.hasShortFaces = _counts.hasShortFaces && HasShortFaces(piece);
    _numCorners += std::int64_t(piece.faceVertices.size());
    for (std::size_t i = 0; i < _values.size(); ++i) {
        _numValues[i] += piece.channels[i].GetNumValues();
    }
    checkCounts();
    auto const getWrite = [](ScratchFile &file) {
        return [&file](std::string_view bytes) { file.Write(bytes); };
    };
    WriteVertices(_format, piece, getWrite(_vertices));
    for (std::size_t i = 0; i < _values.size(); ++i) {
        WriteValues(_format, piece.channels[i], getWrite(*_values[i]));
    }
    if (piece.faceSizes.empty()) {
        return;
    }
    int const label =
        _mesh.faceLabels.empty() ? -1 : _mesh.faceLabels[std::size_t(piece.GetBaseFace(0))];
    std::int64_t const offset = _faces.GetSize();
    WriteFaces(_format, piece, HasShortFaces(piece), getWrite(_faces));
    _blocks.push_back({label, offset, _faces.GetSize() - offset, HasShortFaces(piece)});
}

// As CheckMesh() has it.
void PieceWriter::checkCounts() const {
    std::int64_t count = std::max(_counts.vertices, _numCorners);
    for (std::int64_t const numValues : _numValues) {
        count = std::max(count, numValues);
    }
    if (count > std::numeric_limits<int>::max()) {
        throw FileError(_path, "has more than 2147483647 vertices, values or face corners");
    }
}

// In binary files, numbers of corners take four bytes where some face of another piece has too many for
// one byte.
void PieceWriter::writeBlock(Block const &block, WriteBytes const &write) {
    if (_format != MeshFormat::Ply || block.hasShortFaces == _counts.hasShortFaces) {
        _faces.Read(block.offset, block.size, write);
        return;
    }
    static constexpr char kZeros[3] = {};
    std::string bytes;
    _faces.Read(block.offset, block.size, [&](std::string_view part) { bytes += part; });
    std::size_t const propertyBytes = std::accumulate(
        _mesh.faceProperties.begin(), _mesh.faceProperties.end(), std::size_t(0),
        [](std::size_t sum, FaceProperty const &property) { return sum + GetSize(property.type); });
    for (std::size_t face = 0; face < bytes.size();) {
        auto const numCorners = static_cast<unsigned char>(bytes[face]);
        std::size_t const size = sizeof(std::int32_t) * numCorners + propertyBytes;
        write({&bytes[face], 1});
        write({kZeros, sizeof kZeros});
        write({&bytes[face + 1], size});
        face += 1 + size;
    }
}

void PieceWriter::Commit(Mesh const &front) {
    _counts.vertices += front.GetNumVertices();
    checkCounts();
    if (_counts.faces == 0) {
        throw FileError(_path, "has no faces");
    }
    WriteBuffer buffer(_file);
    WriteBytes const write = [&](std::string_view bytes) { buffer.Write(bytes); };
    WriteHeader(_format, _mesh, _counts, write);
    WriteVertices(_format, front, write);
    _vertices.Read(0, _vertices.GetSize(), write);
    for (std::unique_ptr<ScratchFile> const &values : _values) {
        values->Read(0, values->GetSize(), write);
    }
    std::stable_sort(_blocks.begin(), _blocks.end(),
                     [](Block const &a, Block const &b) { return a.label < b.label; });
    int label = -1;
    for (Block const &block : _blocks) {
        if (block.label != label) {
            write(FormatLabelChange(label < 0 ? FaceLabel{} : _mesh.labels[std::size_t(label)],
                                    _mesh.labels[std::size_t(block.label)]));
            label = block.label;
        }
        writeBlock(block, write);
    }
    buffer.Flush();
    _file.Commit();
}

} // namespace OpenSubdivHex::Tools

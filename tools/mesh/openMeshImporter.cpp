// SPDX-License-Identifier: Apache-2.0
#include "openMeshImporter.h"

#include "fileError.h"
#include "meshText.h"

#include <OpenMesh/Core/System/omstream.hh>

#include <algorithm>
#include <cmath>

namespace OpenSubdivHex::Tools::internal {

namespace {

using OpenMesh::EdgeHandle;
using OpenMesh::FaceHandle;
using OpenMesh::HalfedgeHandle;
using OpenMesh::VertexHandle;

/// Keeps OpenMesh's readers, which print to std::cerr, quiet in a scope.
class QuietOpenMesh {
public:
    QuietOpenMesh() : _wereEnabled{omerr().is_enabled(), omlog().is_enabled()} {
        omerr().disable();
        omlog().disable();
    }
    ~QuietOpenMesh() {
        if (_wereEnabled[0]) {
            omerr().enable();
        }
        if (_wereEnabled[1]) {
            omlog().enable();
        }
    }
    QuietOpenMesh(QuietOpenMesh const &) = delete;
    QuietOpenMesh &operator=(QuietOpenMesh const &) = delete;

private:
    bool _wereEnabled[2];
};

/// The part of the importer interface that polygons alone do not use.
class PositionImporter : public OpenMesh::IO::BaseImporter {
public:
    using Vec2f = OpenMesh::Vec2f;
    using Vec3d = OpenMesh::Vec3d;
    using Vec3f = OpenMesh::Vec3f;
    using Vec4f = OpenMesh::Vec4f;
    using Vec3uc = OpenMesh::Vec3uc;
    using Vec4uc = OpenMesh::Vec4uc;
    using StatusInfo = OpenMesh::Attributes::StatusInfo;

    HalfedgeHandle add_edge(VertexHandle, VertexHandle) override { return HalfedgeHandle(); }
    FaceHandle add_face(HalfedgeHandle) override { return FaceHandle(); }
    void add_face_texcoords(FaceHandle, VertexHandle, std::vector<Vec2f> const &) override {}
    void add_face_texcoords(FaceHandle, VertexHandle, std::vector<Vec3f> const &) override {}
    void set_face_texindex(FaceHandle, int) override {}
    void set_halfedge(VertexHandle, HalfedgeHandle) override {}
    void set_normal(VertexHandle, Vec3f const &) override {}
    void set_normal(VertexHandle, Vec3d const &) override {}
    void set_color(VertexHandle, Vec3uc const &) override {}
    void set_color(VertexHandle, Vec4uc const &) override {}
    void set_color(VertexHandle, Vec3f const &) override {}
    void set_color(VertexHandle, Vec4f const &) override {}
    void set_texcoord(VertexHandle, Vec2f const &) override {}
    void set_status(VertexHandle, StatusInfo const &) override {}
    void set_next(HalfedgeHandle, HalfedgeHandle) override {}
    void set_face(HalfedgeHandle, FaceHandle) override {}
    void request_face_texcoords2D() override {}
    void set_texcoord(HalfedgeHandle, Vec2f const &) override {}
    void set_texcoord(VertexHandle, Vec3f const &) override {}
    void set_texcoord(HalfedgeHandle, Vec3f const &) override {}
    void set_status(HalfedgeHandle, StatusInfo const &) override {}
    void set_color(EdgeHandle, Vec3uc const &) override {}
    void set_color(EdgeHandle, Vec4uc const &) override {}
    void set_color(EdgeHandle, Vec3f const &) override {}
    void set_color(EdgeHandle, Vec4f const &) override {}
    void set_status(EdgeHandle, StatusInfo const &) override {}
    void set_normal(FaceHandle, Vec3f const &) override {}
    void set_normal(FaceHandle, Vec3d const &) override {}
    void set_color(FaceHandle, Vec3uc const &) override {}
    void set_color(FaceHandle, Vec4uc const &) override {}
    void set_color(FaceHandle, Vec3f const &) override {}
    void set_color(FaceHandle, Vec4f const &) override {}
    void set_status(FaceHandle, StatusInfo const &) override {}
    void add_texture_information(int, std::string) override {}
    size_t n_edges() const override { return 0; }
};

/// Collects positions and faces as the reader meets them.
class PolygonImporter : public PositionImporter {
public:
    PolygonImporter(OpenMeshInput const &input, ExtrasReader &extras)
        : _input(input), _extras(extras),
          _text(std::string(input.header) + std::string(input.body)), _stream(_text),
          _next(input.header.size()) {
        // The readers do not look at the state of the stream: without this they would take what
        // cannot be read as 0 and not stop at the end.
        _stream.exceptions(std::ios::failbit | std::ios::badbit);
    }

    Mesh Read(OpenMesh::IO::BaseReader &reader) {
        QuietOpenMesh const quiet;
        try {
            OpenMesh::IO::Options options;
            if (!reader.read(_stream, *this, options)) {
                throw FileError(_input.path, "has a header that cannot be read");
            }
        } catch (std::ios_base::failure const &) {
            refuseUnreadable();
        }
        checkEnd();
        return std::move(_mesh);
    }

    VertexHandle add_vertex() override {
        _mesh.positions.insert(_mesh.positions.end(), 3, 0.0f);
        return VertexHandle(_mesh.GetNumVertices() - 1);
    }

    VertexHandle add_vertex(Vec3f const &point) override {
        VertexHandle const vertex = add_vertex();
        set_point(vertex, point);
        return vertex;
    }

    void set_point(VertexHandle vertex, Vec3f const &point) override {
        std::string const name = "vertex " + std::to_string(vertex.idx());
        std::vector<std::string_view> const extras = checkLine(name, 3);
        for (int i = 0; i < 3; ++i) {
            if (!std::isfinite(point[i])) {
                refuse(name + " has a coordinate that is not a finite number");
            }
            _mesh.positions[3 * vertex.idx() + i] = point[i];
        }
        requireNone(name, _extras.ReadVertex(extras));
        ++_numVertices;
    }

    FaceHandle add_face(VHandles const &corners) override {
        std::string const name = "face " + std::to_string(_mesh.GetNumFaces());
        std::vector<std::string_view> const extras = checkLine(name, 1 + corners.size());
        if (corners.size() < 3) {
            refuse(name + " has " + std::to_string(corners.size()) + " corners, three are needed");
        }
        for (VertexHandle corner : corners) {
            if (corner.idx() < 0 || corner.idx() >= _mesh.GetNumVertices()) {
                refuse(name + " has the vertex index " + std::to_string(corner.idx()) +
                       ", which is out of range");
            }
            _mesh.faceVertices.push_back(corner.idx());
        }
        requireNone(name, _extras.ReadFace(extras));
        _mesh.faceSizes.push_back(int(corners.size()));
        _stream.seekg(std::streamoff(_next)); // OpenMesh takes extras for the next face
        return FaceHandle(_mesh.GetNumFaces() - 1);
    }

    size_t n_vertices() const override { return _numVertices; }
    size_t n_faces() const override { return _mesh.faceSizes.size(); }

private:
    using PositionImporter::add_face;
    using PositionImporter::add_vertex;

    int lineOf(std::size_t position) const {
        return _input.numHeaderLines + 1 +
               int(std::count(_text.begin() + _input.header.size(), _text.begin() + position,
                              '\n'));
    }

    [[noreturn]] void refuse(std::string const &cause) const {
        throw FileError(_input.path, "line " + std::to_string(lineOf(_start)) + ": " + cause);
    }

    void requireNone(std::string const &name, std::string const &fault) const {
        if (!fault.empty()) {
            refuse("the line of " + name + " has " + fault);
        }
    }

    /// Checks that what was read since the last call is a line's first \p numWords words, gives the
    /// words behind them, and goes on to the next line.
    std::vector<std::string_view> checkLine(std::string const &name, std::size_t numWords) {
        auto const position = std::size_t(_stream.tellg());
        _start = std::min(_text.find_first_not_of(" \t\n", _next), position);
        std::size_t const end = _text.find('\n', _start);
        if (end < position) {
            refuse("the line of " + name + " ends too early");
        }
        // The readers take 1.5.5 for two numbers, and 1x for one.
        std::string_view const line = std::string_view(_text).substr(_start, end - _start);
        std::vector<std::string_view> words = SplitWords(line);
        std::size_t const numRead = SplitWords(line.substr(0, position - _start)).size();
        bool const isAtWordEnd =
            words[numRead - 1].data() + words[numRead - 1].size() == &_text[position];
        if (numRead != numWords || !isAtWordEnd) {
            refuse("the line of " + name + " has something else than numbers");
        }
        _next = end + 1;
        words.erase(words.begin(), words.begin() + std::ptrdiff_t(numRead));
        return words;
    }

    [[noreturn]] void refuseUnreadable() {
        _stream.clear();
        std::size_t const position = std::size_t(_stream.tellg());
        std::string_view rest = std::string_view(_text).substr(position);
        if (!TakeWord(&rest).empty()) {
            throw FileError(_input.path,
                            "line " + std::to_string(lineOf(position)) + ": a number is expected");
        }
        throw FileError(_input.path, "ends too early: " + received());
    }

    std::string received() const {
        return "it has " + std::to_string(n_vertices()) + " of " +
               std::to_string(_input.numVertices) + " vertices and " + std::to_string(n_faces()) +
               " of " + std::to_string(_input.numFaces) + " faces";
    }

    void checkEnd() {
        if (_mesh.GetNumVertices() != _input.numVertices ||
            _mesh.GetNumFaces() != _input.numFaces) {
            throw FileError(_input.path, "ends too early: " + received());
        }
        std::string_view rest = std::string_view(_text).substr(std::min(_next, _text.size()));
        if (!TakeWord(&rest).empty()) {
            throw FileError(_input.path, "has more content behind its " +
                                             std::to_string(_input.numFaces) + " faces");
        }
    }

    OpenMeshInput const &_input;
    ExtrasReader &_extras;
    std::string _text;
    std::istringstream _stream;
    std::size_t _start = 0; ///< where the current vertex or face begins
    std::size_t _next;      ///< the line after it
    Mesh _mesh;
    std::size_t _numVertices = 0; ///< whose coordinates were read
};

} // namespace

Mesh ReadThroughOpenMesh(OpenMesh::IO::BaseReader &reader, OpenMeshInput const &input,
                         ExtrasReader &extras) {
    return PolygonImporter(input, extras).Read(reader);
}

} // namespace OpenSubdivHex::Tools::internal

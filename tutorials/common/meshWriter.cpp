// SPDX-License-Identifier: Apache-2.0
#include "meshWriter.h"

#include "fileError.h"
#include "meshFormat.h"
#include "outputFile.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstring>

namespace OpenSubdivHex::Tutorials {

namespace {

/// Enough for one number and the character before or after it.
constexpr std::size_t kMaxNumber = 32;

template <typename T>
char *printNumber(char *out, T value) {
    return std::to_chars(out, out + kMaxNumber, value).ptr;
}

/// Writes "x y z\n".
void printNumbers(float const *numbers, int count, char *out, OutputFile &file) {
    for (int i = 0; i < count; ++i) {
        out = printNumber(out, numbers[i]);
        *out++ = i < count - 1 ? ' ' : '\n';
    }
    file.Advance(out);
}

/// Writes " v0 v1 ... \n".
void printVertices(int const *vertices, int size, OutputFile &file) {
    for (int i = 0; i < size; ++i) {
        char *out = file.Reserve(kMaxNumber);
        *out++ = ' ';
        file.Advance(printNumber(out, vertices[i]));
    }
    file.Write("\n");
}

/// Writes a line for each \p width numbers, "KEYWORD x y z\n".
void printObjValues(std::string_view keyword, std::vector<float> const &values, int width,
                    OutputFile &file) {
    for (std::size_t i = 0; i < values.size(); i += std::size_t(width)) {
        char *out = file.Reserve(4 * kMaxNumber);
        out = std::copy(keyword.begin(), keyword.end(), out);
        *out++ = ' ';
        printNumbers(&values[i], width, out, file);
    }
}

/// Writes " v", " v/t", " v//n" or " v/t/n", counted from 1; the values are null where there are
/// none.
void printObjCorner(int vertex, int const *uv, int const *normal, OutputFile &file) {
    char *out = file.Reserve(4 * kMaxNumber);
    *out++ = ' ';
    out = printNumber(out, std::int64_t(vertex) + 1);
    if (uv || normal) {
        *out++ = '/';
    }
    if (uv) {
        out = printNumber(out, std::int64_t(*uv) + 1);
    }
    if (normal) {
        *out++ = '/';
        out = printNumber(out, std::int64_t(*normal) + 1);
    }
    file.Advance(out);
}

void writeObj(Mesh const &mesh, OutputFile &file) {
    printObjValues("v", mesh.positions, 3, file);
    int const *uv = nullptr;
    int const *normal = nullptr;
    for (FVarChannel const &channel : mesh.channels) {
        bool const isUv = channel.kind == FVarKind::Uv;
        printObjValues(isUv ? "vt" : "vn", channel.values, channel.width, file);
        (isUv ? uv : normal) = channel.faceValues.data();
    }
    int const *vertex = mesh.faceVertices.data();
    for (int size : mesh.faceSizes) {
        file.Write("f");
        for (int i = 0; i < size; ++i) {
            printObjCorner(*vertex++, uv, normal, file);
            uv = uv ? uv + 1 : nullptr;
            normal = normal ? normal + 1 : nullptr;
        }
        file.Write("\n");
    }
}

void writeOff(Mesh const &mesh, OutputFile &file) {
    file.Write("OFF\n" + std::to_string(mesh.GetNumVertices()) + " " +
               std::to_string(mesh.GetNumFaces()) + " 0\n");
    for (int v = 0; v < mesh.GetNumVertices(); ++v) {
        printNumbers(&mesh.positions[3 * std::size_t(v)], 3, file.Reserve(4 * kMaxNumber), file);
    }
    int const *vertices = mesh.faceVertices.data();
    for (int size : mesh.faceSizes) {
        file.Advance(printNumber(file.Reserve(kMaxNumber), size));
        printVertices(vertices, size, file);
        vertices += size;
    }
}

/// Appends the 4 bytes of \p value, lowest first, whatever the machine's order.
template <typename T>
char *putBytes(char *out, T value) {
    static_assert(sizeof(T) == 4);
    std::uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    for (int i = 0; i < 4; ++i) {
        *out++ = char(bits >> (8 * i) & 0xff);
    }
    return out;
}

void writePly(Mesh const &mesh, OutputFile &file) {
    // One byte for the number of corners is what every reader takes, where it is enough.
    int const maxSize = mesh.faceSizes.empty()
                            ? 0
                            : *std::max_element(mesh.faceSizes.begin(), mesh.faceSizes.end());
    bool const hasShortFaces = maxSize < 256;
    bool const hasNormals = !mesh.vertexNormals.empty();
    file.Write("ply\nformat binary_little_endian 1.0\nelement vertex " +
               std::to_string(mesh.GetNumVertices()) +
               "\nproperty float x\nproperty float y\nproperty float z\n" +
               (hasNormals ? "property float nx\nproperty float ny\nproperty float nz\n" : "") +
               "element face " + std::to_string(mesh.GetNumFaces()) + "\nproperty list " +
               (hasShortFaces ? "uchar" : "int") + " int vertex_indices\nend_header\n");
    for (std::size_t i = 0; i < mesh.positions.size(); i += 3) {
        for (std::vector<float> const *values : {&mesh.positions, &mesh.vertexNormals}) {
            for (std::size_t k = i; k < std::min(i + 3, values->size()); ++k) {
                file.Advance(putBytes(file.Reserve(4), (*values)[k]));
            }
        }
    }
    int const *vertices = mesh.faceVertices.data();
    for (int size : mesh.faceSizes) {
        char *out = file.Reserve(4);
        if (hasShortFaces) {
            *out++ = char(size);
        } else {
            out = putBytes(out, size);
        }
        file.Advance(out);
        for (int i = 0; i < size; ++i) {
            file.Advance(putBytes(file.Reserve(4), vertices[i]));
        }
        vertices += size;
    }
}

} // namespace

bool HasChannels(std::string const &path) { return FindMeshFormat(path) == MeshFormat::Obj; }

void WriteMesh(Mesh const &mesh, std::string const &path) {
    std::optional<MeshFormat> const format = FindMeshFormat(path);
    if (!format) {
        throw FileError(path, std::string("is not a ") + kMeshExtensions + " file");
    }
    OutputFile file(path);
    switch (*format) {
    case MeshFormat::Obj:
        writeObj(mesh, file);
        break;
    case MeshFormat::Off:
        writeOff(mesh, file);
        break;
    case MeshFormat::Ply:
        writePly(mesh, file);
        break;
    }
    file.Commit();
}

} // namespace OpenSubdivHex::Tutorials

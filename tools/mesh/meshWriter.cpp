// SPDX-License-Identifier: Apache-2.0
#include "meshWriter.h"

#include "fileError.h"
#include "meshCheck.h"
#include "meshFormat.h"
#include "outputFile.h"

#include <algorithm>
#include <atomic>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <exception>

namespace OpenSubdivHex::Tools {

namespace {

/// Enough for a float or an index and the character before or after it.
constexpr std::size_t kMaxNumber = 16;

/// Items that a thread prints at a time.
constexpr std::size_t kRangeSize = 4096;

/// \brief Prints \p count items in parallel, and writes them in order: one thread at a time writes,
/// while the others print.
///
/// \param getMaxSize  most characters of items [begin, end)
/// \param print       prints items [begin, end) to a place for so many, and gives its end
template <typename GET_MAX_SIZE, typename PRINT>
void writeItems(std::size_t count, GET_MAX_SIZE getMaxSize, PRINT print, OutputFile &file) {
    std::size_t const numRanges = (count + kRangeSize - 1) / kRangeSize;
    // An exception must not leave a parallel region: the first is kept and thrown behind it.
    std::exception_ptr exception;
    std::atomic<bool> hasFailed = false;
#ifdef _OPENMP
#pragma omp parallel
#endif
    {
        std::vector<char> text;
#ifdef _OPENMP
#pragma omp for ordered schedule(dynamic)
#endif
        for (std::size_t range = 0; range < numRanges; ++range) {
            std::exception_ptr exceptionHere;
            std::size_t size = 0;
            auto const keepException = [&](auto const &work) {
                try {
                    if (!exceptionHere && !hasFailed) {
                        work();
                    }
                } catch (...) {
                    exceptionHere = std::current_exception();
                }
            };
            keepException([&] {
                std::size_t const begin = range * kRangeSize;
                std::size_t const end = std::min(begin + kRangeSize, count);
                text.resize(std::max(getMaxSize(begin, end), text.size()));
                size = std::size_t(print(begin, end, text.data()) - text.data());
            });
#ifdef _OPENMP
#pragma omp ordered
#endif
            {
                keepException([&] { file.Write({text.data(), size}); });
                if (exceptionHere && !hasFailed) {
                    exception = exceptionHere;
                    hasFailed = true;
                }
            }
        }
    }
    if (exception) {
        std::rethrow_exception(exception);
    }
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
                 OutputFile &file) {
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
        [=](std::size_t begin, std::size_t end) { return (end - begin) * maxSize; }, print, file);
}

/// \brief Prints all faces in parallel.
///
/// \param maxFace,maxCorner  most characters for a face, beside those for each of its corners
/// \param printFace          prints a face: its size, its first corner, and where to
template <typename PRINT_FACE>
void writeFaces(Mesh const &mesh, std::size_t maxFace, std::size_t maxCorner, PRINT_FACE printFace,
                OutputFile &file) {
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
        return (end - begin) * maxFace +
               (firstCorners[range + 1] - firstCorners[range]) * maxCorner;
    };
    auto const print = [&](std::size_t begin, std::size_t end, char *out) {
        std::size_t firstCorner = firstCorners[begin / kRangeSize];
        for (std::size_t face = begin; face < end; ++face) {
            int const size = mesh.faceSizes[face];
            out = printFace(size, firstCorner, out);
            firstCorner += std::size_t(size);
        }
        return out;
    };
    writeItems(numFaces, getMaxSize, print, file);
}

void writeObj(Mesh const &mesh, OutputFile &file) {
    writeValues("v ", mesh.positions, 3, file);
    int const *uvs = nullptr;
    int const *normals = nullptr;
    for (FVarChannel const &channel : mesh.channels) {
        bool const isUv = channel.kind == FVarKind::Uv;
        writeValues(isUv ? "vt " : "vn ", channel.values, channel.width, file);
        (isUv ? uvs : normals) = channel.faceValues.data();
    }
    // Indices count from 1: "f v ...", "f v/t ...", "f v//n ..." or "f v/t/n ...".
    auto const printIndex = [](char *out, int index) {
        return printNumber(out, std::int64_t(index) + 1);
    };
    auto const printFace = [&](int size, std::size_t firstCorner, char *out) {
        *out++ = 'f';
        for (std::size_t i = firstCorner; i < firstCorner + std::size_t(size); ++i) {
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
    writeFaces(mesh, 2, 3 * kMaxNumber, printFace, file);
}

void writeOff(Mesh const &mesh, OutputFile &file) {
    file.Write("OFF\n" + std::to_string(mesh.GetNumVertices()) + " " +
               std::to_string(mesh.GetNumFaces()) + " 0\n");
    writeValues("", mesh.positions, 3, file);
    auto const printFace = [&](int size, std::size_t firstCorner, char *out) {
        out = printNumber(out, size);
        for (std::size_t i = firstCorner; i < firstCorner + std::size_t(size); ++i) {
            *out++ = ' ';
            out = printNumber(out, mesh.faceVertices[i]);
        }
        *out++ = '\n';
        return out;
    };
    writeFaces(mesh, kMaxNumber + 1, kMaxNumber, printFace, file);
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
    std::size_t const numFloats = hasNormals ? 6 : 3; // of a vertex
    auto const printVertices = [&](std::size_t begin, std::size_t end, char *out) {
        for (std::size_t i = begin; i < end; ++i) {
            for (std::size_t k = 3 * i; k < 3 * i + 3; ++k) {
                out = putBytes(out, mesh.positions[k]);
            }
            for (std::size_t k = 3 * i; hasNormals && k < 3 * i + 3; ++k) {
                out = putBytes(out, mesh.vertexNormals[k]);
            }
        }
        return out;
    };
    writeItems(
        std::size_t(mesh.GetNumVertices()),
        [numFloats](std::size_t begin, std::size_t end) { return 4 * numFloats * (end - begin); },
        printVertices, file);
    auto const printFace = [&](int size, std::size_t firstCorner, char *out) {
        if (hasShortFaces) {
            *out++ = char(size);
        } else {
            out = putBytes(out, size);
        }
        for (std::size_t i = firstCorner; i < firstCorner + std::size_t(size); ++i) {
            out = putBytes(out, mesh.faceVertices[i]);
        }
        return out;
    };
    writeFaces(mesh, 4, 4, printFace, file);
}

} // namespace

bool HasChannels(std::string const &path) { return FindMeshFormat(path) == MeshFormat::Obj; }

void WriteMesh(Mesh const &mesh, std::string const &path) {
    std::optional<MeshFormat> const format = FindMeshFormat(path);
    if (!format) {
        throw FileError(path, std::string("is not a ") + kMeshExtensions + " file");
    }
    CheckMesh(mesh, path);
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

} // namespace OpenSubdivHex::Tools

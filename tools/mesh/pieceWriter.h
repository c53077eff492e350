// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_PIECE_WRITER_H
#define OPENSUBDIVHEX_TOOLS_PIECE_WRITER_H

#include "meshOutput.h"
#include "outputFile.h"

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace OpenSubdivHex::Tools {

/// \brief Writes a mesh that comes in pieces, as WriteMesh would write the whole, and keeps none of them.
///
/// Each part of the file has a scratch file of its own until all is there.  Functions throw
/// FileError; without Commit() the target stays as it was.
class PieceWriter {
public:
    /// \param mesh  must live as long: the labels and libraries of all pieces
    PieceWriter(Mesh const &mesh, std::string const &path);

    /// \brief Adds vertices, values and faces behind those of the pieces before.
    ///
    /// Its faces count vertices and values of the whole mesh.  Its base faces have one label; faces come
    /// in the order of labels, those with the same in that of pieces, as SortFacesByLabel has them.
    ///
    /// \param piece  has the properties and channels of the mesh, and no label of its own
    void Add(Mesh const &piece);

    /// \brief Puts the file in its place.
    ///
    /// \param front  vertices that come before those of the pieces
    void Commit(Mesh const &front);

private:
    // Bytes that are appended, and read again later.
    class ScratchFile {
    public:
        explicit ScratchFile(std::string const &path);
        void Write(std::string_view bytes);
        std::int64_t GetSize() const { return _size; }
        /// Hands bytes from an offset on to a function, in parts.
        void Read(std::int64_t offset, std::int64_t size, WriteBytes const &write);

    private:
        struct Closer {
            void operator()(std::FILE *file) const { std::fclose(file); }
        };
        [[noreturn]] void refuse() const;

        std::string _path;
        std::unique_ptr<std::FILE, Closer> _file;
        std::int64_t _size = 0;
    };
    // Faces of one piece.
    struct Block {
        int label; // -1: none
        std::int64_t offset;
        std::int64_t size;
        bool hasShortFaces; // HasShortFaces() of the piece
    };

    void checkCounts() const;
    void writeBlock(Block const &block, WriteBytes const &write);

    Mesh const &_mesh;
    std::string const _path;
    MeshFormat const _format;
    OutputFile _file;
    ScratchFile _vertices;
    std::vector<std::unique_ptr<ScratchFile>> _values; // by channel
    ScratchFile _faces;
    std::vector<Block> _blocks;
    MeshCounts _counts;
    std::int64_t _numCorners = 0;
    std::vector<std::int64_t> _numValues; // by channel
};

} // namespace OpenSubdivHex::Tools

#endif

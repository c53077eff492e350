// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_PLY_SINK_H
#define OPENSUBDIVHEX_TOOLS_PLY_SINK_H

#include "patchNumbering.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace OpenSubdivHex::Tools {

/// \brief The sink of a stream that makes a PLY file, patch by patch: every piece of the file has its
/// place before the first patch comes, so threads and processes write it together, each what its
/// patches have, and the file is the same, bit for bit.
///
/// Data of patches are gathered, some megabytes at a time, and written in the order of the file, so that
/// consecutive pieces are written at once.  Flush() writes the rest when the stream has ended.
///
/// It is a binary file, with the byte order of the machine: points with x, y and z, in the numbers of
/// PatchNumbering, and facets.  Points that patches share are in it once.
///
/// \tparam REAL  float or double: the type of x, y and z
template <typename REAL>
class PlySink {
public:
    /// \brief Writes bytes to the file, at an offset; several threads may call it at once, for other
    /// parts of the file.
    ///
    /// \return  false to end the stream
    using Write = std::function<bool(std::uint64_t offset, char const *bytes, std::size_t size)>;

    /// \param numbering  that of the stream; it must live as long
    /// \param write      takes what is to be written
    /// \return  null on failure: TooLarge for more points than the 31 bits of a file's indices count
    static std::unique_ptr<PlySink> Create(PatchNumbering const &numbering, Write write,
                                           FarExt::CallStatus *status = nullptr);

    /// Size of the file, in bytes.
    std::uint64_t GetFileSize() const;
    /// Writes the begin of the file, as one of those who write it has to.
    /// \return  what the function that writes gives
    bool WriteHeader() const { return _write(0, _header.data(), _header.size()); }
    /// \brief Takes what belongs to a patch, and writes it with what other patches have, once that is enough.
    ///
    /// \return  whether what had to be written was; false, with nothing taken, for points that are not of three
    ///          numbers, so that PatchStream::Run() ends
    bool operator()(typename BfrExt::PatchStream<REAL>::Patch const &patch) const;
    /// \brief Writes what patches have left: to be called after each PatchStream::Run(), which takes a copy of the
    /// sink that shares all of it.
    ///
    /// \return  what the function that writes gives
    bool Flush() const;

private:
    using Patch = typename BfrExt::PatchStream<REAL>::Patch;
    using Runs = std::vector<PatchNumbering::Run>;

    // The part of the file that a patch fills.
    struct Piece {
        std::uint64_t offset;
        std::size_t begin; // in the bytes
        std::size_t size;
    };
    struct PatchBytes {
        std::vector<Piece> pieces;
        std::vector<char> bytes;
    };
    // Data not written yet.
    struct Gathered {
        std::mutex mutex;
        std::vector<PatchBytes> patches;
        std::size_t size = 0;
    };
    static constexpr std::size_t kMaxSize = std::size_t(4) << 20;

    PlySink(PatchNumbering const &numbering, Write write);

    std::uint64_t getPointOffset(PatchNumbering::Number point) const;
    std::uint64_t getFacetOffset(Far::Index face, int section) const;
    void addPoints(Patch const &patch, Runs const &runs, PatchBytes &to) const;
    void addFacets(Patch const &patch, Runs const &runs, PatchBytes &to) const;
    bool write(std::vector<PatchBytes> const &patches) const;

    PatchNumbering const &_numbering;
    Write const _write;
    std::size_t _countSize; // bytes of the size of a facet
    std::string _header;
    std::shared_ptr<Gathered> _gathered = std::make_shared<Gathered>(); // of all copies
};

extern template class PlySink<float>;
extern template class PlySink<double>;

} // namespace OpenSubdivHex::Tools

#endif

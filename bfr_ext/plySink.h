// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_PLY_SINK_H
#define OPENSUBDIVHEX_BFR_EXT_PLY_SINK_H

#include "patchNumbering.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace OpenSubdivHex::BfrExt {

/// \brief The sink of a stream that makes a PLY file, patch by patch: every piece of the file has its
/// place before the first patch comes, so threads and processes write it together, each what its
/// patches have, and the file is the same, bit for bit.
///
/// It is a binary file, with the byte order of the machine: points with x, y and z, in the numbers of
/// PatchNumbering, and facets.  Points that patches share are in it once.
///
/// \tparam REAL  float or double: the type of x, y and z
template <typename REAL>
class OPENSUBDIVHEX_API PlySink {
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
    /// \brief Writes what belongs to a patch.
    ///
    /// \return  whether all was written; false, with nothing written, for points that are not of three
    ///          numbers, so that PatchStream::Run() ends
    bool operator()(typename PatchStream<REAL>::Patch const &patch) const;

private:
    PlySink(PatchNumbering const &numbering, Write write);

    std::uint64_t getPointOffset(PatchNumbering::Number point) const;
    std::uint64_t getFacetOffset(Far::Index face, int section) const;
    bool writePoints(typename PatchStream<REAL>::Patch const &patch,
                     std::vector<PatchNumbering::Run> const &runs) const;
    bool writeFacets(typename PatchStream<REAL>::Patch const &patch,
                     std::vector<PatchNumbering::Run> const &runs) const;

    PatchNumbering const &_numbering;
    Write const _write;
    std::size_t _countSize; // bytes of the size of a facet
    std::string _header;
};

extern template class PlySink<float>;
extern template class PlySink<double>;

} // namespace OpenSubdivHex::BfrExt

#endif

// SPDX-License-Identifier: Apache-2.0
#include "plySink.h"

#include "far_ext/vtr/report.h"

#include <cstring>
#include <limits>

namespace OpenSubdivHex::BfrExt {

using FarExt::CallStatus;
using FarExt::StatusCode;

namespace {

constexpr std::size_t kPointSize = 3;
constexpr std::size_t kIndexSize = sizeof(std::int32_t);

char const *getByteOrder() {
    std::uint16_t const number = 1;
    unsigned char first = 0;
    std::memcpy(&first, &number, 1);
    return first == 1 ? "little" : "big";
}

} // namespace

template <typename REAL>
PlySink<REAL>::PlySink(PatchNumbering const &numbering, Write write)
    : _numbering(numbering), _write(std::move(write)),
      _countSize(numbering.GetMaxFacetSize() <= std::numeric_limits<unsigned char>::max()
                     ? 1
                     : kIndexSize) {
    std::string const real = sizeof(REAL) == sizeof(float) ? "float" : "double";
    _header = std::string("ply\nformat binary_") + getByteOrder() + "_endian 1.0\nelement vertex " +
              std::to_string(numbering.GetNumPoints());
    for (char const *const name : {"x", "y", "z"}) {
        _header += "\nproperty " + real + " " + name;
    }
    _header += "\nelement face " + std::to_string(numbering.GetNumFacets()) + "\nproperty list " +
               (_countSize == 1 ? "uchar" : "int") + " int vertex_indices\nend_header\n";
}

template <typename REAL>
std::unique_ptr<PlySink<REAL>> PlySink<REAL>::Create(PatchNumbering const &numbering, Write write,
                                                     CallStatus *status) {
    CallStatus result;
    if (numbering.GetNumPoints() > std::numeric_limits<std::int32_t>::max()) {
        result = FarExt::internal::Failure(
            StatusCode::TooLarge,
            "a PLY file cannot number " + std::to_string(numbering.GetNumPoints()) + " points");
    }
    if (!FarExt::internal::Report(result, status)) {
        return nullptr;
    }
    return std::unique_ptr<PlySink>(new PlySink(numbering, std::move(write)));
}

template <typename REAL>
std::uint64_t PlySink<REAL>::getPointOffset(PatchNumbering::Number point) const {
    return _header.size() + std::uint64_t(point) * kPointSize * sizeof(REAL);
}

template <typename REAL>
std::uint64_t PlySink<REAL>::getFacetOffset(Far::Index face, int section) const {
    return getPointOffset(_numbering.GetNumPoints()) +
           std::uint64_t(_numbering.GetFirstFacet(face, section)) * _countSize +
           std::uint64_t(_numbering.GetFirstFacetVertex(face, section)) * kIndexSize;
}

template <typename REAL>
std::uint64_t PlySink<REAL>::GetFileSize() const {
    return getPointOffset(_numbering.GetNumPoints()) +
           std::uint64_t(_numbering.GetNumFacets()) * _countSize +
           std::uint64_t(_numbering.GetNumFacetVertices()) * kIndexSize;
}

template <typename REAL>
bool PlySink<REAL>::operator()(typename PatchStream<REAL>::Patch const &patch) const {
    if (patch.pointSize != int(kPointSize)) {
        return false;
    }
    std::vector<PatchNumbering::Run> runs;
    _numbering.GetRuns(patch.face, patch.tessellation, runs);
    return writePoints(patch, runs) && writeFacets(patch, runs);
}

template <typename REAL>
bool PlySink<REAL>::writePoints(typename PatchStream<REAL>::Patch const &patch,
                                std::vector<PatchNumbering::Run> const &runs) const {
    std::vector<REAL> reversed;
    for (PatchNumbering::Run const &run : runs) {
        if (!run.isOwn || run.count == 0) {
            continue;
        }
        auto const count = std::size_t(run.count);
        REAL const *points = patch.points + std::size_t(run.place) * kPointSize;
        PatchNumbering::Number first = run.point;
        if (run.step < 0) {
            reversed.clear();
            for (std::size_t i = count; i-- > 0;) {
                reversed.insert(reversed.end(), points + i * kPointSize,
                                points + (i + 1) * kPointSize);
            }
            points = reversed.data();
            first -= run.count - 1;
        }
        if (!_write(getPointOffset(first), reinterpret_cast<char const *>(points),
                    count * kPointSize * sizeof(REAL))) {
            return false;
        }
    }
    return true;
}

template <typename REAL>
bool PlySink<REAL>::writeFacets(typename PatchStream<REAL>::Patch const &patch,
                                std::vector<PatchNumbering::Run> const &runs) const {
    LevelTessellation const &tessellation = patch.tessellation;
    std::vector<std::int32_t> pointsOfPlaces;
    pointsOfPlaces.reserve(std::size_t(tessellation.GetNumCoords()));
    for (PatchNumbering::Run const &run : runs) {
        for (int i = 0; i < run.count; ++i) {
            pointsOfPlaces.push_back(
                std::int32_t(run.point + PatchNumbering::Number(i) * run.step));
        }
    }
    std::vector<int> sizes(std::size_t(tessellation.GetNumFacets()));
    tessellation.GetFacetSizes(sizes.data());
    int const stride = tessellation.GetFacetStride();
    std::vector<int> facets(stride == 0 ? std::size_t(tessellation.GetNumFacetVertices())
                                        : sizes.size() * std::size_t(stride));
    tessellation.GetFacets(facets.data());

    std::vector<char> bytes(sizes.size() * _countSize +
                            std::size_t(tessellation.GetNumFacetVertices()) * kIndexSize);
    char *to = bytes.data();
    int const *facet = facets.data();
    for (std::int32_t const size : sizes) {
        if (_countSize == 1) {
            *to = char(size);
        } else {
            std::memcpy(to, &size, kIndexSize);
        }
        to += _countSize;
        for (int i = 0; i < size; ++i, to += kIndexSize) {
            std::memcpy(to, &pointsOfPlaces[std::size_t(facet[i])], kIndexSize);
        }
        facet += stride == 0 ? size : stride;
    }
    return _write(getFacetOffset(patch.face, tessellation.GetSection()), bytes.data(),
                  bytes.size());
}

template class PlySink<float>;
template class PlySink<double>;

} // namespace OpenSubdivHex::BfrExt

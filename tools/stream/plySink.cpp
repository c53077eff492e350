// SPDX-License-Identifier: Apache-2.0
#include "plySink.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>

namespace OpenSubdivHex::Tools {

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
        result = CallStatus(StatusCode::TooLarge, FarExt::ComponentType::NoComponent, 0,
                            "a PLY file cannot number " + std::to_string(numbering.GetNumPoints()) +
                                " points");
    }
    if (status) {
        *status = result;
    }
    if (!result.IsOk()) {
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
bool PlySink<REAL>::operator()(Patch const &patch) const {
    if (patch.pointSize != int(kPointSize)) {
        return false;
    }
    Runs runs;
    _numbering.GetRuns(patch.face, patch.tessellation, runs);
    PatchBytes ofPatch;
    addPoints(patch, runs, ofPatch);
    addFacets(patch, runs, ofPatch);
    std::vector<PatchBytes> full;
    {
        std::lock_guard<std::mutex> const lock(_gathered->mutex);
        _gathered->size += ofPatch.bytes.size();
        _gathered->patches.push_back(std::move(ofPatch));
        if (_gathered->size >= kMaxSize) {
            full.swap(_gathered->patches);
            _gathered->size = 0;
        }
    }
    return write(full);
}

template <typename REAL>
bool PlySink<REAL>::Flush() const {
    std::vector<PatchBytes> left;
    {
        std::lock_guard<std::mutex> const lock(_gathered->mutex);
        left.swap(_gathered->patches);
        _gathered->size = 0;
    }
    return write(left);
}

// Pieces that follow one another in the file are written together.
template <typename REAL>
bool PlySink<REAL>::write(std::vector<PatchBytes> const &patches) const {
    struct Bytes {
        std::uint64_t offset;
        char const *begin;
        std::size_t size;
    };
    std::vector<Bytes> pieces;
    for (PatchBytes const &patch : patches) {
        for (Piece const &piece : patch.pieces) {
            pieces.push_back({piece.offset, patch.bytes.data() + piece.begin, piece.size});
        }
    }
    std::sort(pieces.begin(), pieces.end(),
              [](Bytes const &a, Bytes const &b) { return a.offset < b.offset; });
    std::vector<char> joined;
    for (std::size_t i = 0; i < pieces.size();) {
        std::uint64_t const offset = pieces[i].offset;
        joined.clear();
        do {
            joined.insert(joined.end(), pieces[i].begin, pieces[i].begin + pieces[i].size);
            ++i;
        } while (i < pieces.size() && pieces[i].offset == offset + joined.size());
        if (!_write(offset, joined.data(), joined.size())) {
            return false;
        }
    }
    return true;
}

// The points that belong to the patch.
template <typename REAL>
void PlySink<REAL>::addPoints(Patch const &patch, Runs const &runs, PatchBytes &to) const {
    constexpr std::size_t kBytesOfPoint = kPointSize * sizeof(REAL);
    for (PatchNumbering::Run const &run : runs) {
        if (!run.isOwn || run.count == 0) {
            continue;
        }
        auto const *const points =
            reinterpret_cast<char const *>(patch.points + std::size_t(run.place) * kPointSize);
        auto const count = std::size_t(run.count);
        PatchNumbering::Number const first = run.step < 0 ? run.point - run.count + 1 : run.point;
        to.pieces.push_back({getPointOffset(first), to.bytes.size(), count * kBytesOfPoint});
        for (std::size_t i = 0; i < count; ++i) {
            char const *const point = points + (run.step < 0 ? count - 1 - i : i) * kBytesOfPoint;
            to.bytes.insert(to.bytes.end(), point, point + kBytesOfPoint);
        }
    }
}

template <typename REAL>
void PlySink<REAL>::addFacets(Patch const &patch, Runs const &runs, PatchBytes &to) const {
    BfrExt::LevelTessellation const &tessellation = patch.tessellation;
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

    std::size_t const numBytes =
        sizes.size() * _countSize + std::size_t(tessellation.GetNumFacetVertices()) * kIndexSize;
    to.pieces.push_back(
        {getFacetOffset(patch.face, tessellation.GetSection()), to.bytes.size(), numBytes});
    to.bytes.resize(to.bytes.size() + numBytes);
    char *next = to.bytes.data() + to.pieces.back().begin;
    int const *facet = facets.data();
    for (std::int32_t const size : sizes) {
        if (_countSize == 1) {
            *next = char(size);
        } else {
            std::memcpy(next, &size, kIndexSize);
        }
        next += _countSize;
        for (int i = 0; i < size; ++i, next += kIndexSize) {
            std::memcpy(next, &pointsOfPlaces[std::size_t(facet[i])], kIndexSize);
        }
        facet += stride == 0 ? size : stride;
    }
}

template class PlySink<float>;
template class PlySink<double>;

} // namespace OpenSubdivHex::Tools

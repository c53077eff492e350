// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_GATHERED_POINTS_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_GATHERED_POINTS_H

#include "baseType.h"
#include "ringCell.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief The control points of a base face: given one behind the other or, where faces share rings, as those of the mesh,
/// from which they are gathered when they are first asked for.
///
/// A thread has one at a time that has gathered points.
template <typename REAL>
class GatheredPoints {
public:
    /// \param points  of the face or, with \p shared, of the mesh
    /// \param stride  from one to the next, in numbers
    /// \param size    of a point
    GatheredPoints(BaseFace const &face, REAL const *points, std::ptrdiff_t stride,
                   std::size_t size, SharedRings<REAL> *shared)
        : _face(face), _points(points), _stride(stride), _size(size), _shared(shared),
          _isGathered(!shared) {}

    BaseFace const &GetFace() const { return _face; }
    std::size_t GetSize() const { return _size; }

    /// @name The points, without those of the mesh between them
    /// @{
    REAL const *Get() {
        if (!_isGathered) {
            gather();
        }
        return _ofFace;
    }
    std::ptrdiff_t GetStride() const { return _shared ? std::ptrdiff_t(_size) : _stride; }
    /// @}

    /// \brief The sources of rings.
    ///
    /// \param indices  which points of the face they are, or null: all in turn
    RingSources<REAL> GetSources(std::size_t numPoints, int const *indices) const {
        return {_points,
                _stride,
                _size,
                numPoints,
                indices,
                _shared ? _face.GetPoints() : nullptr,
                _shared};
    }
    /// Null where faces do not share any.
    SharedRings<REAL> *GetShared() const { return _shared; }

private:
    void gather() {
        // Its memory is kept for the next face.
        static thread_local std::vector<REAL> gathered;
        auto const numPoints = std::size_t(_face.numPoints);
        gathered.resize(std::max(gathered.size(), numPoints * _size));
        for (std::size_t i = 0; i < numPoints; ++i) {
            std::copy_n(_points + std::ptrdiff_t(_face.GetPoints()[i]) * _stride, _size,
                        &gathered[i * _size]);
        }
        _ofFace = gathered.data();
        _isGathered = true;
    }

    BaseFace const &_face;
    REAL const *const _points;
    std::ptrdiff_t const _stride;
    std::size_t const _size;
    SharedRings<REAL> *const _shared;
    bool _isGathered;
    REAL const *_ofFace = _points;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif

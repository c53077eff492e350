// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_STREAM_BOUNDS_DATA_H
#define OPENSUBDIVHEX_BFR_EXT_STREAM_BOUNDS_DATA_H

#include "bfr_ext/cell/cellMeasures.h"
#include "bfr_ext/viewBounds.h"

#include <atomic>
#include <cstddef>
#include <memory>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// The data of a ViewBounds.  Several threads may work at the measures of different faces.
struct BoundsData {
    using Index = ViewBounds::Index;

    BoundsData(SurfaceFactory const &ofMesh, ViewBounds::Options const &ofBounds)
        : factory(ofMesh), options(ofBounds), faces(std::size_t(ofMesh.GetNumFaces())) {}

    /// Forgets what depends on positions that are not those of the last call.
    template <typename REAL>
    void SetPoints(REAL const *meshPoints, std::ptrdiff_t stride);
    /// Counts what a face has come to have, and forgets it if that is too much.
    void Trim(Index face, std::size_t memoryBefore);
    /// Forgets all.
    void Clear();

    SurfaceFactory const &factory;
    ViewBounds::Options const options;
    std::vector<double> points; ///< the positions, once there are some
    std::vector<FaceMeasures> faces;
    std::atomic<std::size_t> memory{0}; ///< that measures take, in bytes

private:
    void forget(std::vector<char> const &isChanged);
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif

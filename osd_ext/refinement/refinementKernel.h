// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_REFINEMENT_REFINEMENT_KERNEL_H
#define OPENSUBDIVHEX_OSD_EXT_REFINEMENT_REFINEMENT_KERNEL_H

#include "preparedRefinement.h"

#include <cstddef>
#include <vector>

namespace OpenSubdivHex::OsdExt::internal {

/// \brief Elements of \c length floats, \c stride floats apart.
template <class FLOAT>
struct Elements {
    FLOAT *data;
    std::ptrdiff_t stride;
};

/// \brief One refinement of the elements of a level to those of the next.
struct RefinementTask {
    /// The F-vertices, by corner.
    Elements<float> FVertices() const {
        return {dst.data + std::ptrdiff_t(refinement->numVVertices) * dst.stride, dst.stride};
    }

    PreparedRefinement const *refinement;
    Elements<float const> src;
    Elements<float> dst;
};

/// \brief Does \p tasks, one after the other: writes all vertices of the levels that they make.
///
/// The order of the arithmetic depends on the topology alone: the result has the same bits for any
/// number of threads, length, stride and place.
void RefineElements(std::vector<RefinementTask> const &tasks, int length);

} // namespace OpenSubdivHex::OsdExt::internal

#endif

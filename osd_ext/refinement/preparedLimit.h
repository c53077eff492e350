// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_REFINEMENT_PREPARED_LIMIT_H
#define OPENSUBDIVHEX_OSD_EXT_REFINEMENT_PREPARED_LIMIT_H

#include "refinementKernel.h"

#include "far_ext/limit/limitRows.h"
#include "osd_ext/stencil/stencilKernel.h"

namespace OpenSubdivHex::OsdExt::internal {

/// \brief The limit of a level prepared for evaluation: stencils of the level's vertices, whose
/// weights are those of their type.  So what a frame reads is mostly indices.
class PreparedLimit {
public:
    /// Of side 0 of each vertex.
    /// \return  TooLarge where the indices of all vertices are more than 2^31 - 1
    FarExt::Status Prepare(FarExt::internal::LimitRows const &rows);

    /// Writes points, and where du is not null both derivatives, of all vertices of the level, whose
    /// values are \p values.
    void Evaluate(Elements<float const> values, int length, Elements<float> points,
                  Elements<float> du, Elements<float> dv) const;

private:
    void addWeights(FarExt::internal::LimitRow const &row);

    FarExt::internal::Buffer<StencilBlock> _blocks; // one for each vertex
    FarExt::internal::Buffer<int> _indices;
    // Of all types in turn.
    std::vector<float> _weights;
    std::vector<float> _duWeights;
    std::vector<float> _dvWeights;
};

} // namespace OpenSubdivHex::OsdExt::internal

#endif

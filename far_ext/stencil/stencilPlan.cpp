// SPDX-License-Identifier: Apache-2.0
#include "stencilPlan.h"

#include <algorithm>
#include <numeric>

namespace OpenSubdivHex::FarExt::internal {

using Far::Index;

std::vector<Index> StencilPlan::GetSources(int level, std::vector<Index> verts) const {
    if (channel >= 0 && level == 0) {
        Buffer<Index> const &values = hierarchy.channels[channel].valuesOfVertices;
        std::transform(verts.begin(), verts.end(), verts.begin(),
                       [&](Index vert) { return values[vert]; });
    }
    return verts;
}

std::vector<Index> StencilPlan::GetSources(int level) const {
    std::vector<Index> verts(GetLevel(level).numVertices);
    std::iota(verts.begin(), verts.end(), 0);
    return GetSources(level, std::move(verts));
}

} // namespace OpenSubdivHex::FarExt::internal

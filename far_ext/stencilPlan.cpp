// SPDX-License-Identifier: Apache-2.0
#include "stencilPlan.h"

#include "fvarLevel.h"

#include <algorithm>
#include <numeric>

namespace OpenSubdivHex::FarExt::internal {

using Far::Index;

TopologyLevel StencilPlan::GetLevel(int level) const {
    TopologyLevel const &mesh = refiner.GetLevel(level);
    return channel < 0 ? mesh : TopologyLevel(&mesh.GetTopology().fvarLevels[channel]->topology);
}

std::vector<Index> StencilPlan::GetSources(int level, std::vector<Index> verts) const {
    if (channel >= 0 && level == 0) {
        Buffer<Index> const &values =
            refiner.GetLevel(0).GetTopology().fvarLevels[channel]->valuesOfVertices;
        std::transform(verts.begin(), verts.end(), verts.begin(),
                       [&](Index vert) { return values[vert]; });
    }
    return verts;
}

std::vector<Index> StencilPlan::GetSources(int level) const {
    std::vector<Index> verts(GetLevel(level).GetNumVertices());
    std::iota(verts.begin(), verts.end(), 0);
    return GetSources(level, std::move(verts));
}

} // namespace OpenSubdivHex::FarExt::internal

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_BFR_EXT_FACETS_H
#define OPENSUBDIVHEX_REGRESSION_BFR_EXT_FACETS_H

#include "bfr_ext/levelTessellation.h"

#include <gtest/gtest.h>
#include <opensubdiv/far/types.h>

#include <algorithm>
#include <vector>

namespace OpenSubdivHex::Regression {

/// The facets of a tessellation as lists of its places.
inline std::vector<std::vector<int>> GetFacets(BfrExt::LevelTessellation const &tessellation) {
    std::vector<int> sizes(std::size_t(tessellation.GetNumFacets()));
    EXPECT_EQ(tessellation.GetFacetSizes(sizes.data()), tessellation.GetNumFacets());
    int const stride = tessellation.GetFacetStride();
    std::vector<int> indices(stride == 0 ? std::size_t(tessellation.GetNumFacetVertices())
                                         : sizes.size() * std::size_t(stride),
                             -7);
    EXPECT_EQ(tessellation.GetFacets(indices.data()), tessellation.GetNumFacets());
    std::vector<std::vector<int>> result;
    auto index = indices.begin();
    for (int const size : sizes) {
        result.emplace_back(index, index + size);
        if (stride > 0) {
            EXPECT_TRUE(
                std::all_of(index + size, index + tessellation.GetFacetSize(),
                            [](int rest) { return rest == OpenSubdiv::Far::INDEX_INVALID; }));
        }
        index += stride == 0 ? size : stride;
    }
    return result;
}

} // namespace OpenSubdivHex::Regression

#endif

// SPDX-License-Identifier: Apache-2.0
#include "stencilEvaluator.h"

#include "osd_ext/stencil/stencilKernel.h"

#include <algorithm>

namespace OpenSubdivHex::OsdExt {

using internal::StencilBlock;
using internal::StencilTask;

CompactStencilTable::CompactStencilTable() = default;
CompactStencilTable::~CompactStencilTable() = default;

int CompactStencilTable::GetNumBlocks() const { return int(_blocks.size()); }

StencilEvaluatorBase::StencilRows CompactStencilTable::getRows() const {
    return {nullptr, nullptr, _indices.data(), _blocks.data()};
}

std::unique_ptr<CompactStencilTable const>
CompactStencilTable::Create(Far::StencilTable const &table) {
    std::unique_ptr<CompactStencilTable> result(new CompactStencilTable());
    result->_numStencils = table.GetNumStencils();
    result->_numControlVertices = table.GetNumControlVertices();
    result->_weights = table.GetWeights();

    // Far's own tables may have no offsets: their stencils follow each other without gaps.
    std::vector<int> const &sizes = table.GetSizes();
    int const *const indices = table.GetControlIndices().data();
    int first = 0;
    std::size_t numIndices = 0;
    for (int i = 0; i < result->_numStencils; ++i) {
        int const size = sizes[std::size_t(i)];
        bool const sharesList =
            i > 0 && sizes[std::size_t(i) - 1] == size &&
            std::equal(indices + first, indices + first + size, indices + first - size);
        bool const fitsBlock =
            sharesList && result->_blocks.back().numStencils < StencilTask::kMaxRows;
        if (fitsBlock) {
            ++result->_blocks.back().numStencils;
        } else {
            int const firstIndex = sharesList ? result->_blocks.back().firstIndex : int(numIndices);
            numIndices += sharesList ? 0 : std::size_t(size);
            result->_blocks.push_back({i, 1, size, firstIndex, first});
        }
        first += size;
    }
    result->_blocks.shrink_to_fit();
    result->_indices.resize(numIndices);
    for (StencilBlock const &block : result->_blocks) {
        std::copy_n(indices + block.firstWeight, block.size,
                    result->_indices.begin() + block.firstIndex);
    }
    return result;
}

std::size_t CompactStencilTable::GetNumBytes() const {
    return _blocks.size() * sizeof(StencilBlock) + _indices.size() * sizeof(int) +
           _weights.size() * sizeof(float);
}

} // namespace OpenSubdivHex::OsdExt

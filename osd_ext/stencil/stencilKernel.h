// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_STENCIL_STENCIL_KERNEL_H
#define OPENSUBDIVHEX_OSD_EXT_STENCIL_STENCIL_KERNEL_H

#include "osd_ext/stencilEvaluator.h"

#include <cstddef>

namespace OpenSubdivHex::OsdExt::internal {

/// \brief The types that evaluators and kernels share.
struct StencilTypes {
    using Rows = StencilEvaluatorBase::StencilRows;
    using Output = StencilEvaluatorBase::StencilOutput;
};
using StencilRows = StencilTypes::Rows;
using StencilOutput = StencilTypes::Output;

/// \brief Stencils in a row that share a list of indices: see CompactStencilTable.
struct StencilBlock {
    int firstStencil;
    int numStencils; ///< StencilTask::kMaxRows at most
    int size;        ///< indices
    int firstIndex;
    int firstWeight; ///< those of all its stencils follow each other
};

/// \brief One evaluation: what the drivers split and the kernels compute.
///
/// Element i of an output becomes the sum of its weights of stencil i times the source elements.
struct StencilTask {
    static constexpr int kMaxOutputs = 6;
    /// Sums that a kernel forms at a time: outputs of a stencil, or stencils of one output.
    static constexpr int kMaxRows = kMaxOutputs;

    struct Output {
        float *dst = nullptr; ///< element 0: the descriptor's offset is applied
        std::ptrdiff_t stride = 0;
        float const *weights = nullptr; ///< as many as indices or, in blocks, per stencil
    };

    float const *src = nullptr; ///< element 0: the descriptor's offset is applied
    std::ptrdiff_t srcStride = 0;
    int length = 0; ///< floats per element, of the source and of all outputs

    StencilRows rows{};

    int numOutputs = 0; ///< 1, 3 or 6; of blocks 1
    Output outputs[kMaxOutputs];
};

/// \brief Makes \p task of the arguments of an evaluator for stencils, or blocks, [start, end).
/// \return  whether StencilEvaluator, which says when it is false, can evaluate them
bool MakeStencilTask(float const *src, Osd::BufferDescriptor const &srcDesc,
                     StencilOutput const *outputs, int numOutputs, StencilRows const &rows,
                     int start, int end, StencilTask *task);

/// Where the indices of stencil \p stencil start; 0 when it need not be known.
std::size_t FindFirstWeight(StencilRows const &rows, int stencil);

/// \brief Evaluates stencils, or blocks of them, [begin, end) in ascending order.
///
/// \param firstWeight  where the indices of stencil \p begin start; read if !rows.HasPlaces() alone
using StencilKernel = void (*)(StencilTask const &task, int begin, int end,
                               std::size_t firstWeight);

/// @name The kernels, one per SimdLevel
/// All are instances of stencilKernelTemplate.h.
/// @{
void EvalStencilsPortable(StencilTask const &task, int begin, int end, std::size_t firstWeight);
void EvalStencilsAvx2(StencilTask const &task, int begin, int end, std::size_t firstWeight);
void EvalStencilsAvx512(StencilTask const &task, int begin, int end, std::size_t firstWeight);
/// @}

/// The kernel of the SimdLevel in use.
StencilKernel GetStencilKernel();

} // namespace OpenSubdivHex::OsdExt::internal

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_CUDA_REFINEMENT_EVALUATOR_H
#define OPENSUBDIVHEX_OSD_EXT_CUDA_REFINEMENT_EVALUATOR_H

#include "cudaEvaluator.h"
#include "refinementEvaluator.h"

#include <memory>

namespace OpenSubdivHex::OsdExt {

/// \brief Addresses on the device, or what Osd::CudaVertexBuffer and CudaVertexBuffer bind.
struct CudaBinding {
    using Source = float const *; ///< control values
    using Buffer = float *;       ///< what is written

    /// The address of the floats of a buffer.
    template <class BUFFER>
    static float *Bind(BUFFER &buffer) {
        return buffer.BindCudaBuffer();
    }
};

/// \brief Evaluates refined levels on a device by CUDA, without a stencil table: RefinementEvaluator
/// for memory of the device.  Programs link OpenSubdivHex::osd_ext_cuda, which is built where CMake's
/// OPENSUBDIVHEX_CUDA is on; it needs the runtime of CUDA alone.
///
/// \code
///     auto const evaluator = OsdExt::CudaRefinementEvaluator::Create(*refiner);
///     evaluator->SetStream(stream);
///     Osd::BufferDescriptor const desc(0, 3, 3);
///     for each frame:
///         evaluator->Evaluate(controlPositions, desc, positions, desc, evaluator->GetMaxLevel());
/// \endcode
///
/// **Device.** The same device of CUDA must be current in all functions.  What an evaluation does is put
/// on the stream, and done when that is: only memory that it takes for the first time is waited for.
/// Errors of a stream show in the call that finds them, perhaps a later one.
///
/// **Frames.** The functions are BufferEvaluator's, for addresses on the device, of buffers that are long
/// enough, and for buffers whose function BindCudaBuffer() returns them, such as Osd::CudaVertexBuffer or
/// CudaVertexBuffer.  Places of elements are computed in 64 bits.  An evaluator is used on one stream at a
/// time.  They fail, too, with
///  - StatusCode::InvalidArgument if an address is none of the device,
///  - StatusCode::Unsupported for an error of CUDA, which is named.
///
/// **Memory.** Memory that the device does not have throws std::bad_alloc, any other error while it is
/// taken or filled std::runtime_error.
class OPENSUBDIVHEX_API CudaRefinementEvaluator
    : public DeviceRefinementEvaluator,
      public BufferEvaluator<CudaRefinementEvaluator, CudaBinding> {
public:
    /// \brief Prepares for the levels that \p refiner has, and loads what the device needs.
    ///
    /// \return  null with
    ///           - StatusCode::InvalidArgument for a channel that is not there, or an
    ///             interpolationMode that is none,
    ///           - StatusCode::Unsupported without a device of CUDA,
    ///           - StatusCode::TooLarge if there are more than 2^32 indices
    static std::unique_ptr<CudaRefinementEvaluator> Create(FarExt::TopologyRefiner const &refiner,
                                                           Options options,
                                                           FarExt::CallStatus *status = nullptr);
    /// Overload with default options.
    static std::unique_ptr<CudaRefinementEvaluator> Create(FarExt::TopologyRefiner const &refiner,
                                                           FarExt::CallStatus *status = nullptr) {
        return Create(refiner, Options(), status);
    }

    /// Where evaluations are put from now on; the default stream at first.
    void SetStream(CudaStream stream);

    /// \brief Writes the triangles of a level, to an address on the device: as
    /// GLRefinementEvaluator::MakeTriangleIndices().
    bool MakeTriangleIndices(unsigned *dst, int level, int vertexOffset = 0,
                             FarExt::CallStatus *status = nullptr);

private:
    friend BufferEvaluator;
    CudaRefinementEvaluator(std::unique_ptr<internal::Device> device,
                            FarExt::TopologyRefiner const &refiner);
};

} // namespace OpenSubdivHex::OsdExt

#endif

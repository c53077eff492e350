// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_CUDA_REFINEMENT_EVALUATOR_H
#define OPENSUBDIVHEX_OSD_EXT_CUDA_REFINEMENT_EVALUATOR_H

#include "cudaStream.h"
#include "refinementEvaluator.h"

#include "far_ext/export.h"
#include "far_ext/status.h"
#include "far_ext/topologyRefiner.h"

#include <opensubdiv/osd/bufferDescriptor.h>

#include <cstdint>
#include <memory>

namespace OpenSubdivHex::OsdExt {

namespace internal {
class CudaDevice;
class DeviceEvaluator;
} // namespace internal

/// \brief What Osd::CudaVertexBuffer and CudaVertexBuffer bind.
struct CudaBinding {
    /// The address of the floats on the device.
    template <class BUFFER>
    static auto Bind(BUFFER &buffer) -> decltype(buffer.BindCudaBuffer()) {
        return buffer.BindCudaBuffer();
    }
};

/// \brief Evaluates refined levels on a device by CUDA, without a stencil table: RefinementEvaluator
/// for memory of the device.  Programs link OpenSubdivHex::osd_ext_cuda, which is built where CMake's
/// OPENSUBDIVHEX_CUDA is on; it needs the runtime of CUDA alone.
///
/// Kernels, what lies on the device and results are those of GLRefinementEvaluator.
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
/// **Elements.** Element j of a buffer is the \c length floats from <tt>offset + j * stride</tt>
/// on, computed in 64 bits.  Nothing else is written.  Source and destination may be one buffer, as
/// long as no float is both read and written.
///
/// **Buffers.** In place of addresses, all functions take buffers whose function BindCudaBuffer()
/// returns them, such as Osd::CudaVertexBuffer or CudaVertexBuffer: see BufferEvaluator.
///
/// **Threads.** An evaluator keeps the levels below the one that was asked for: it must not be used by
/// two threads or on two streams at once.
///
/// **Memory.** Memory that the device does not have throws std::bad_alloc, any other error while it is
/// taken or filled std::runtime_error.
///
/// **Lifetime.** As of GLRefinementEvaluator.
class OPENSUBDIVHEX_API CudaRefinementEvaluator
    : public BufferEvaluator<CudaRefinementEvaluator, CudaBinding> {
public:
    /// What is evaluated.
    using Options = RefinementEvaluator::Options;

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
    /// The same with the default options.
    static std::unique_ptr<CudaRefinementEvaluator> Create(FarExt::TopologyRefiner const &refiner,
                                                           FarExt::CallStatus *status = nullptr) {
        return Create(refiner, Options(), status);
    }

    /// Frees its memory of the device, when that has done what it was asked for.
    ~CudaRefinementEvaluator();

    /// Where evaluations are put from now on; the default stream at first.
    void SetStream(CudaStream stream);

    /// The last level that can be evaluated, that of the refiner when this was made.
    int GetMaxLevel() const;
    /// Elements of a level: its vertices or face-varying values.  Those of level 0 are the source.
    int GetNumElements(int level) const;
    /// Elements of levels 1 ... GetMaxLevel() together.
    std::int64_t GetNumElementsAllLevels() const;
    /// Bytes that lie on the device, but for the levels below the one that was asked for.
    std::int64_t GetNumDeviceBytes() const;

    using BufferEvaluator::Evaluate;
    using BufferEvaluator::EvaluateAllLevels;
    using BufferEvaluator::EvaluateLimit;

    /// \brief Writes the values of one level to elements [0, GetNumElements(level)) of \p dst.
    ///
    /// \param src,dst  addresses on the device, of buffers that are long enough
    /// \param srcDesc,dstDesc  of the same length
    /// \param level    0 ... GetMaxLevel(); 0 copies the control values
    /// \param status   says what was wrong; may be null
    ///
    /// \return  false, with nothing written, with StatusCode::InvalidArgument if \p level is out of
    ///          range, the lengths of the descriptors differ or are less than 1, a stride is less than
    ///          the length, an offset is negative, or an address is null or none of the device; and
    ///          with StatusCode::Unsupported for an error of CUDA, which is named
    bool Evaluate(float const *src, Osd::BufferDescriptor const &srcDesc, float *dst,
                  Osd::BufferDescriptor const &dstDesc, int level,
                  FarExt::CallStatus *status = nullptr);

    /// \brief Writes the values of levels 1 ... GetMaxLevel() to elements
    /// [0, GetNumElementsAllLevels()), level behind level: the order of a stencil table with
    /// intermediate levels.  Fails as Evaluate does.
    bool EvaluateAllLevels(float const *src, Osd::BufferDescriptor const &srcDesc, float *dst,
                           Osd::BufferDescriptor const &dstDesc,
                           FarExt::CallStatus *status = nullptr);

    /// @name The limit surface
    /// As GLRefinementEvaluator::EvaluateLimit.
    ///
    /// \param src          control values
    /// \param dst,du,dv    elements [0, GetNumElements(level)) each
    /// \param srcDesc,dstDesc,duDesc,dvDesc  of the same length
    /// \param level        0 ... GetMaxLevel(), with full topology
    /// \param status       says what was wrong; may be null
    /// \return             as there
    /// @{

    /// The points alone.
    bool EvaluateLimit(float const *src, Osd::BufferDescriptor const &srcDesc, float *dst,
                       Osd::BufferDescriptor const &dstDesc, int level,
                       FarExt::CallStatus *status = nullptr);
    /// The points and their derivatives.
    bool EvaluateLimit(float const *src, Osd::BufferDescriptor const &srcDesc, float *dst,
                       Osd::BufferDescriptor const &dstDesc, float *du,
                       Osd::BufferDescriptor const &duDesc, float *dv,
                       Osd::BufferDescriptor const &dvDesc, int level,
                       FarExt::CallStatus *status = nullptr);
    /// @}

    /// @name Triangles
    /// Of a level whose faces are all drawn whole: those of CreateTriangleIndices() with cutBaseFaces
    /// false, CreaseCuts::NoCreases and drawHoles, in its order.  They are made on the device, those of
    /// F-faces from the numbering alone, those of other faces from their vertices, which the first call
    /// for a level loads; it refers to the refiner that was given.
    /// Triangles of cut faces are CreateTriangleIndices()'s: where faces are cut depends on tags, seams and
    /// base faces, which no device has, and they change with the refinement alone, not with frames.
    /// @{

    /// How many a level has.
    std::int64_t GetNumTriangles(int level) const;
    /// \brief Writes three vertices for each, unsigned integers of 32 bits.
    ///
    /// \param dst           an address on the device
    /// \param level         0 ... GetMaxLevel()
    /// \param vertexOffset  added to every vertex; not negative
    /// \param status        says what was wrong; may be null
    ///
    /// \return  false, with nothing written, with InvalidArgument for a level or a buffer as in
    ///          Evaluate(), a negative offset, for INTERPOLATE_FACE_VARYING, or if the refiner refined or
    ///          unrefined in the meantime; and else as Evaluate
    bool MakeTriangleIndices(unsigned *dst, int level, int vertexOffset = 0,
                             FarExt::CallStatus *status = nullptr);
    /// @}

private:
    CudaRefinementEvaluator(std::unique_ptr<internal::DeviceEvaluator> evaluator,
                            internal::CudaDevice &device);

    std::unique_ptr<internal::DeviceEvaluator> _evaluator;
    internal::CudaDevice &_device; // of that
};

} // namespace OpenSubdivHex::OsdExt

#endif

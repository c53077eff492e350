// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_BUFFER_EVALUATOR_H
#define OPENSUBDIVHEX_OSD_EXT_BUFFER_EVALUATOR_H

#include "far_ext/status.h"

#include <opensubdiv/osd/bufferDescriptor.h>

#include <type_traits>

namespace OpenSubdivHex {

namespace Osd = OpenSubdiv::Osd;

namespace OsdExt {

namespace internal {

/// \brief A buffer and the descriptor of its elements.
template <class BUFFER>
struct BufferView {
    BUFFER buffer;
    Osd::BufferDescriptor desc;
};

} // namespace internal

/// \brief Functions of RefinementEvaluator, GLRefinementEvaluator and CudaRefinementEvaluator that evaluate levels.
///
/// **Buffers.** Sources SRC are of type BINDING::Source, destinations DST, DU and DV of type BINDING::Buffer: floats,
/// addresses or names.  All functions also take pointers to objects that bind one of these, as Osd's vertex buffers do; a
/// null pointer is a null buffer.
///
/// **Elements.** Element j of a buffer is the \c length floats from <tt>offset + j * stride</tt> on.
/// Nothing else is written.  Source and destination may be one buffer, as long as no float is both read
/// and written: the destination may lie behind the source, or beside it in each stride.
///
/// **Return value.** False, with nothing written, with StatusCode::InvalidArgument if
///  - a level is out of range,
///  - the lengths of the descriptors differ, or are less than 1,
///  - a stride is less than the length, or an offset is negative,
///  - a buffer is null, unless there is nothing to write,
///
/// and as the evaluator says.
///
/// \tparam EVALUATOR  the class that has this as its base
/// \tparam BINDING    CpuBinding, GLBinding or CudaBinding
template <class EVALUATOR, class BINDING>
class BufferEvaluator {
public:
    /// \brief Writes the values of one level to elements [0, GetNumElements(level)) of \p dst.
    ///
    /// \param src    control values, GetNumElements(0), without the offset of \p srcDesc
    /// \param dst    without the offset of \p dstDesc
    /// \param srcDesc,dstDesc  of the same length
    /// \param level  0 ... GetMaxLevel(); 0 copies the control values
    /// \param status says what was wrong; may be null
    template <class SRC, class DST>
    bool Evaluate(SRC src, Osd::BufferDescriptor const &srcDesc, DST dst,
                  Osd::BufferDescriptor const &dstDesc, int level,
                  FarExt::CallStatus *status = nullptr) {
        return self().evaluate(from(src, srcDesc), to(dst, dstDesc), level, status);
    }

    /// \brief Writes the values of levels 1 ... GetMaxLevel() to elements
    /// [0, GetNumElementsAllLevels()), level behind level: the order of a stencil table with
    /// intermediate levels.
    template <class SRC, class DST>
    bool EvaluateAllLevels(SRC src, Osd::BufferDescriptor const &srcDesc, DST dst,
                           Osd::BufferDescriptor const &dstDesc,
                           FarExt::CallStatus *status = nullptr) {
        return self().evaluateAllLevels(from(src, srcDesc), to(dst, dstDesc), status);
    }

    /// @name The limit surface
    /// Limit points of the vertices of a level with full topology, and first derivatives on side 0.  The cross product of
    /// the derivatives is the normal.  Results are those of a table of FarExt::LimitStencilTableFactory, except for
    /// rounding, which grows with the level in derivatives, because these are differences of near values.
    ///
    /// The first frame of a level finds the masks, on the processor, and needs the refiner as it was.
    ///
    /// \param src          control values
    /// \param dst,du,dv    elements [0, GetNumElements(level)) each
    /// \param srcDesc,dstDesc,duDesc,dvDesc  of the same length
    /// \param level        0 ... GetMaxLevel()
    /// \param status       says what was wrong; may be null
    ///
    /// \return  false, with nothing written, besides with InvalidArgument for other modes than
    ///          INTERPOLATE_VERTEX or if the refiner refined or unrefined in the meantime, as
    ///          FarExt::LimitStencilTableFactory fails, and with TooLarge where a level up to this one has
    ///          more than 1,431,655,765 vertices
    /// @{

    /// The points alone.
    template <class SRC, class DST>
    bool EvaluateLimit(SRC src, Osd::BufferDescriptor const &srcDesc, DST dst,
                       Osd::BufferDescriptor const &dstDesc, int level,
                       FarExt::CallStatus *status = nullptr) {
        return self().evaluateLimit(from(src, srcDesc), {to(dst, dstDesc)}, level, status);
    }
    /// The points and their derivatives.
    template <class SRC, class DST, class DU, class DV>
    bool EvaluateLimit(SRC src, Osd::BufferDescriptor const &srcDesc, DST dst,
                       Osd::BufferDescriptor const &dstDesc, DU du,
                       Osd::BufferDescriptor const &duDesc, DV dv,
                       Osd::BufferDescriptor const &dvDesc, int level,
                       FarExt::CallStatus *status = nullptr) {
        return self().evaluateLimit(
            from(src, srcDesc), {to(dst, dstDesc), to(du, duDesc), to(dv, dvDesc)}, level, status);
    }
    /// @}

protected:
    ~BufferEvaluator() = default;

private:
    EVALUATOR &self() { return static_cast<EVALUATOR &>(*this); }

    template <class BOUND, class BUFFER>
    static BOUND bind(BUFFER buffer) {
        if constexpr (std::is_convertible_v<BUFFER, BOUND>) {
            return buffer;
        } else {
            return buffer ? BINDING::Bind(*buffer) : BOUND();
        }
    }
    template <class SRC>
    static internal::BufferView<typename BINDING::Source> from(SRC src,
                                                               Osd::BufferDescriptor const &desc) {
        return {bind<typename BINDING::Source>(src), desc};
    }
    template <class DST>
    static internal::BufferView<typename BINDING::Buffer> to(DST dst,
                                                             Osd::BufferDescriptor const &desc) {
        return {bind<typename BINDING::Buffer>(dst), desc};
    }
};

/// \brief Floats, or what Osd::CpuVertexBuffer and the like bind.
struct CpuBinding {
    using Source = float const *; ///< control values
    using Buffer = float *;       ///< what is written

    /// The floats of a buffer.
    template <class BUFFER>
    static float *Bind(BUFFER &buffer) {
        return buffer.BindCpuBuffer();
    }
};

} // namespace OsdExt
} // namespace OpenSubdivHex

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_REFINEMENT_EVALUATOR_H
#define OPENSUBDIVHEX_OSD_EXT_REFINEMENT_EVALUATOR_H

#include "far_ext/export.h"
#include "far_ext/status.h"
#include "far_ext/stencilTableFactory.h"
#include "far_ext/topologyRefiner.h"

#include <opensubdiv/osd/bufferDescriptor.h>

#include <cstdint>
#include <memory>
#include <type_traits>
#include <vector>

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

/// \brief The functions that evaluators of refined levels have in common: RefinementEvaluator,
/// GLRefinementEvaluator and CudaRefinementEvaluator, each of which is its EVALUATOR.
///
/// **Buffers.** Sources, SRC, are BINDING::Source, and destinations, DST, DU and DV, BINDING::Buffer: floats,
/// addresses or names.  In place of them all functions take pointers to objects that bind such, as Osd's
/// vertex buffers do; a null pointer is a buffer that is null.
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
    /// Of the vertices of a level, with full topology, whose values it makes on the way: points, and
    /// first derivatives on side 0, as FarExt::LimitStencilTableFactory says; what comes out is what
    /// its table gives, up to the rounding of floats, of which derivatives have more at each level,
    /// as they are differences of near values.  The cross product of the derivatives is the normal.
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

/// \brief Computes the primvars of refined levels straight from the control values, level by level,
/// without a stencil table: the fastest way to refine a whole mesh again and again.
///
/// Values are those that a stencil table of the same refiner gives, with all rules for
/// boundaries, creases, corners and face-varying seams, up to the rounding of floats (1e-6 of the
/// largest control value), for values up to half of the largest float.  Two meshes that share a
/// sharp border line, with the same sharpness at its vertices, get the same values on it, bit for
/// bit, however either numbers and orients it.
///
/// \code
///     auto const evaluator = RefinementEvaluator::Create(refiner);
///     Osd::BufferDescriptor const desc(0, 3, 3);
///     for each frame:
///         evaluator->Evaluate(controlPositions, desc, positions, desc, refiner.GetMaxLevel());
/// \endcode
///
/// **Frames.** The functions are BufferEvaluator's, for floats and for buffers whose function
/// BindCpuBuffer() returns them, such as Osd::CpuVertexBuffer.  Places of elements are computed in 64 bits,
/// and nothing else is read, not even beside them.  They fail, too, if the refiner refined or unrefined in
/// the meantime.
///
/// **Limits.** A control value that is not a number is in no more of what comes out than with a limit
/// stencil table, but in lattices, where all vertices in a face of level 0 have it.
///
/// Where level 0 is a regular lattice of triangles, quads or hexagons, all vertices come from it:
/// there a frame takes two to four times as long as Evaluate().  Elsewhere most come from hexagons of
/// the levels before, six at a time: four to seven times as long on deep levels, of which the last
/// one is needed for the other vertices alone.  These are those of level 0 and near irregular
/// vertices, irregular faces and features, and all of the first two or three levels of meshes without
/// hexagons: eight to ten times as long.
///
/// The first frame of a level takes as long as eight to forty, and keeps about 21 bytes for each vertex
/// and 100 for each of the others.
///
/// **Threads.** The work runs on the threads of FarExt::GetExecutor(), as many as
/// FarExt::GetNumThreads() says.  Results are the same, bit for bit, for any number of threads, stride
/// and offset, one level or all.  An evaluator keeps the levels below the one that was asked for, in
/// memory that only the first frame takes: it must not be used by two threads at once.  Several
/// evaluators may share a refiner.
///
/// **Memory.** std::bad_alloc passes through, with nothing written.
///
/// **Lifetime.** The evaluator refers to the refiner, and is valid until that refines again or is
/// destroyed.
class OPENSUBDIVHEX_API RefinementEvaluator
    : public BufferEvaluator<RefinementEvaluator, CpuBinding> {
public:
    /// \brief What is evaluated, spelled as in FarExt::StencilTableFactory.
    struct Options {
        /// What the elements are.
        FarExt::StencilMode interpolationMode = FarExt::INTERPOLATE_VERTEX;
        int fvarChannel = 0; ///< for INTERPOLATE_FACE_VARYING, whose elements are the values
    };

    /// \brief Prepares for the levels that \p refiner has.  Takes about a quarter of a byte per
    /// element of levels 1 ... GetMaxLevel(), besides 4 bytes per corner of the first two levels,
    /// or of all that are refined if they have sharp boundaries; and a quarter of the time of a
    /// frame, or up to the whole for two levels.
    ///
    /// \return  null with StatusCode::InvalidArgument for a channel that is not there, or an
    ///          interpolationMode that is none
    static std::unique_ptr<RefinementEvaluator> Create(FarExt::TopologyRefiner const &refiner,
                                                       Options options,
                                                       FarExt::CallStatus *status = nullptr);
    /// The same with the default options.
    static std::unique_ptr<RefinementEvaluator> Create(FarExt::TopologyRefiner const &refiner,
                                                       FarExt::CallStatus *status = nullptr) {
        return Create(refiner, Options(), status);
    }

    ~RefinementEvaluator();

    /// The refiner that was given.
    FarExt::TopologyRefiner const &GetTopologyRefiner() const;

    /// The last level that can be evaluated, that of the refiner.
    int GetMaxLevel() const;
    /// Elements of a level: its vertices or face-varying values.  Those of level 0 are the source.
    int GetNumElements(int level) const;
    /// Elements of levels 1 ... GetMaxLevel() together.
    std::int64_t GetNumElementsAllLevels() const;

private:
    friend BufferEvaluator;
    class Impl;

    explicit RefinementEvaluator(std::unique_ptr<Impl> impl);

    using Source = internal::BufferView<float const *>;
    using Destination = internal::BufferView<float *>;
    bool evaluate(Source const &src, Destination const &dst, int level, FarExt::CallStatus *status);
    bool evaluateAllLevels(Source const &src, Destination const &dst, FarExt::CallStatus *status);
    bool evaluateLimit(Source const &src, std::vector<Destination> const &outputs, int level,
                       FarExt::CallStatus *status);

    std::unique_ptr<Impl> _impl;
};

namespace internal {

class Device;
class DeviceEvaluator;

/// What a device calls a buffer: a name of OpenGL, or an address.
using DeviceBufferName = std::uint64_t;

inline DeviceBufferName GetBufferName(unsigned name) { return name; }
inline DeviceBufferName GetBufferName(void const *address) {
    return DeviceBufferName(reinterpret_cast<std::uintptr_t>(address));
}

/// \brief A buffer on a device and the descriptor of its elements.
struct DeviceValues {
    template <class BUFFER>
    DeviceValues(BufferView<BUFFER> const &view)
        : buffer(GetBufferName(view.buffer)), desc(view.desc) {}

    DeviceBufferName buffer;
    Osd::BufferDescriptor desc;
};

} // namespace internal

/// \brief What GLRefinementEvaluator and CudaRefinementEvaluator have in common: refined levels on a
/// device, without a stencil table.  BufferEvaluator has their functions for frames.
///
/// Control values are refined level by level.  Of the topology, the device has about 8 bytes for
/// each vertex of the last level, where a stencil table has about 200; all else follows from the
/// numbering (far_ext/INDEXING.md).
///
/// **Results.** The sums of RefinementEvaluator, for nearly all vertices in the same order, each
/// product and sum rounded by itself: on every device the same bits.  Values whose sums are too large
/// for a float are not scaled as there.
///
/// **Limits.** In faces of level 0 around which that is a regular lattice of triangles, quads or hexagons,
/// all vertices come from level 0 in closed form, of which the device has 4 to 5 bytes for each of them.
/// Elsewhere six vertices at a time come from a hexagon of a level before, with 5 bytes for each; those
/// near irregular vertices and faces of level 0 and near features are sums over their neighbourhoods,
/// which are listed.
///
/// **Threads.** The levels below the one that was asked for are kept, in buffers that only the first frame
/// takes: an evaluator is used by one thread at a time.
///
/// **Lifetime.** An evaluator keeps what it needs of the refiner, but for limits and triangles: the first
/// call for a level needs the refiner as it was.
class OPENSUBDIVHEX_API DeviceRefinementEvaluator {
public:
    /// What is evaluated.
    using Options = RefinementEvaluator::Options;

    /// The last level that can be evaluated, that of the refiner when this was made.
    int GetMaxLevel() const;
    /// Elements of a level: its vertices or face-varying values.  Those of level 0 are the source.
    int GetNumElements(int level) const;
    /// Elements of levels 1 ... GetMaxLevel() together.
    std::int64_t GetNumElementsAllLevels() const;
    /// Bytes that lie on the device, but for the levels below the one that was asked for.
    std::int64_t GetNumDeviceBytes() const;
    /// Triangles of a level, see MakeTriangleIndices() of the evaluators.
    std::int64_t GetNumTriangles(int level) const;

protected:
    /// On a device; prepare() is still to be called.
    DeviceRefinementEvaluator(std::unique_ptr<internal::Device> device,
                              FarExt::TopologyRefiner const &refiner);
    ~DeviceRefinementEvaluator();

    /// The device that was given.
    internal::Device &getDevice() const;
    /// Loads what the device needs for all levels.
    bool prepare(Options options, FarExt::CallStatus *status);
    /// BufferEvaluator::Evaluate() of what the device calls buffers.
    bool evaluate(internal::DeviceValues const &src, internal::DeviceValues const &dst, int level,
                  FarExt::CallStatus *status);
    /// BufferEvaluator::EvaluateAllLevels() of these.
    bool evaluateAllLevels(internal::DeviceValues const &src, internal::DeviceValues const &dst,
                           FarExt::CallStatus *status);
    /// BufferEvaluator::EvaluateLimit() of these, to the points, or with du and dv behind them.
    bool evaluateLimit(internal::DeviceValues const &src,
                       std::vector<internal::DeviceValues> const &outputs, int level,
                       FarExt::CallStatus *status);
    /// GLRefinementEvaluator::MakeTriangleIndices() of one.
    bool makeTriangleIndices(internal::DeviceBufferName dst, int level, int vertexOffset,
                             FarExt::CallStatus *status);

private:
    std::unique_ptr<internal::DeviceEvaluator> _evaluator;
};

} // namespace OsdExt
} // namespace OpenSubdivHex

#endif

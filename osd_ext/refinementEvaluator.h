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

/// \brief Evaluates refined levels straight from control values, without a stencil table: the fastest way to refine a whole
/// mesh frame after frame.
///
/// Results are those of a stencil table of the same refiner, with all rules for boundaries, creases, corners and
/// face-varying seams, within rounding (1e-6 of the largest control value), for values up to half of the largest float.
/// Two meshes that share a sharp border line, with the same sharpness at its vertices, get bitwise equal values on it,
/// whatever their numbering and orientation.
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
/// **Limits.** A frame of EvaluateLimit() takes longer than one of Evaluate():
///
/// | vertices                                                                    | times            |
/// |-----------------------------------------------------------------------------|------------------|
/// | in a regular lattice of triangles, quads or hexagons of level 0             | 2 to 4           |
/// | in regular hexagons of deep levels, six at a time                           | 4 to 7           |
/// | others: near irregular vertices, irregular faces and features, and all of   | 8 to 10          |
/// | the first two or three levels of meshes without hexagons                    |                  |
///
/// The first frame of a level takes as long as 8 to 40 later ones, and keeps about 21 bytes for each vertex, and 100 for
/// each of the others.  A control value that is not a number reaches no more vertices than with a limit stencil table,
/// except in lattices, where it reaches all vertices in a face of level 0.
///
/// **Threads.** The work runs on the threads of FarExt::GetExecutor(), as many as FarExt::GetNumThreads() says.  Results have
/// the same bits for any number of threads, stride and offset, for one level or all.  Two threads must not use one evaluator
/// at once, because it keeps the levels in between.  Several evaluators may share a refiner.
///
/// **Memory.** std::bad_alloc passes through, with nothing written.
///
/// **Lifetime.** The evaluator refers to the refiner, and is valid until that refines again or is
/// destroyed.
class OPENSUBDIVHEX_API RefinementEvaluator
    : public BufferEvaluator<RefinementEvaluator, CpuBinding> {
public:
    /// \brief The kind of data, spelled as in FarExt::StencilTableFactory.
    struct Options {
        /// The kind of data.
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
    /// Overload with default options.
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

/// A buffer of a device: a name of OpenGL, or an address.
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

/// \brief The common base of GLRefinementEvaluator and CudaRefinementEvaluator: refined levels on a
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
    /// The kind of data, and the channel.
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

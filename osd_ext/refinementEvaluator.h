// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_REFINEMENT_EVALUATOR_H
#define OPENSUBDIVHEX_OSD_EXT_REFINEMENT_EVALUATOR_H

#include "bufferEvaluator.h"

#include "far_ext/stencilTableFactory.h"
#include "far_ext/topologyRefiner.h"

#include <opensubdiv/osd/bufferDescriptor.h>

#include <cstdint>
#include <memory>
#include <vector>

namespace OpenSubdivHex {

namespace Osd = OpenSubdiv::Osd;

namespace OsdExt {

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
/// **Elements.** Element j of a buffer is the \c length floats from <tt>offset + j * stride</tt>
/// on, computed in 64 bits.  Nothing else is read or written, not even beside them.
///
/// **Buffers.** In place of floats, all functions take buffers whose function BindCpuBuffer() returns
/// them, such as Osd::CpuVertexBuffer: see BufferEvaluator.
///
/// **Aliasing.** Source and destination may be one buffer, as long as no float is both read and
/// written: the destination may lie behind the source, or beside it in each stride.
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

    using BufferEvaluator::Evaluate;
    using BufferEvaluator::EvaluateAllLevels;
    using BufferEvaluator::EvaluateLimit;

    /// \brief Writes the values of one level to elements [0, GetNumElements(level)) of \p dst.
    ///
    /// \param src    control values, GetNumElements(0), without the offset of \p srcDesc
    /// \param dst    without the offset of \p dstDesc
    /// \param level  0 ... GetMaxLevel(); 0 copies the control values
    ///
    /// \return  false with StatusCode::InvalidArgument, and nothing written, if
    ///           - \p level is out of range, or the refiner refined or unrefined in the meantime,
    ///           - the lengths of the descriptors differ, or are less than 1,
    ///           - a stride is less than the length, or an offset is negative,
    ///           - \p src or \p dst is null, unless there is nothing to write.
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
    /// Of the vertices of a level, with full topology, whose values it makes on the way: points, and
    /// first derivatives on side 0, as FarExt::LimitStencilTableFactory says; what comes out is what
    /// its table gives, up to the rounding of floats, of which derivatives have more at each level,
    /// as they are differences of near values.
    ///
    /// A control value that is not a number is in no more of what comes out than with that table, but in
    /// lattices, where all vertices in a face of level 0 have it.
    ///
    /// Where level 0 is a regular lattice of triangles, quads or hexagons, all vertices come from it:
    /// there a frame takes two to four times as long as Evaluate().  Elsewhere most come from hexagons of
    /// the levels before, six at a time: four to seven times as long on deep levels, of which the last
    /// one is needed for the other vertices alone.  These are those of level 0 and near irregular
    /// vertices, irregular faces and features, and all of the first two or three levels of meshes without
    /// hexagons: eight to ten times as long.
    ///
    /// The first frame of a level finds the masks, which takes as long as eight to forty, and keeps
    /// about 21 bytes for each vertex and 100 for each of the others.
    ///
    /// \param dst,du,dv  elements [0, GetNumElements(level)) each
    ///
    /// \return  false, with nothing written, as Evaluate; besides with InvalidArgument for other
    ///          modes than INTERPOLATE_VERTEX, as FarExt::LimitStencilTableFactory fails, and with
    ///          TooLarge where a level up to this one has more than 1,431,655,765 vertices
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

private:
    class Impl;

    explicit RefinementEvaluator(std::unique_ptr<Impl> impl);

    struct Output {
        Output(float *buffer, Osd::BufferDescriptor const &bufferDesc)
            : dst(buffer), desc(bufferDesc) {}

        float *dst;
        Osd::BufferDescriptor const &desc;
    };
    bool evaluateLimit(float const *src, Osd::BufferDescriptor const &srcDesc,
                       std::vector<Output> const &outputs, int level, FarExt::CallStatus *status);

    std::unique_ptr<Impl> _impl;
};

} // namespace OsdExt
} // namespace OpenSubdivHex

#endif

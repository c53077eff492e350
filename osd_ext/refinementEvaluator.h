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

} // namespace OsdExt
} // namespace OpenSubdivHex

#endif

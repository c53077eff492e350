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

} // namespace OsdExt
} // namespace OpenSubdivHex

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_DEVICE_REFINEMENT_EVALUATOR_H
#define OPENSUBDIVHEX_OSD_EXT_DEVICE_REFINEMENT_EVALUATOR_H

#include "refinementEvaluator.h"

#include "far_ext/export.h"
#include "far_ext/status.h"
#include "far_ext/topologyRefiner.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace OpenSubdivHex::OsdExt {

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

} // namespace OpenSubdivHex::OsdExt

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_DEVICE_DEVICE_EVALUATOR_H
#define OPENSUBDIVHEX_OSD_EXT_DEVICE_DEVICE_EVALUATOR_H

#include "device.h"
#include "deviceLimit.h"
#include "deviceRefinement.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace OpenSubdivHex::OsdExt::internal {

/// \brief Evaluates levels on any Device, as RefinementEvaluator does on processors.
///
/// On the device there are one array of indices and one of weights for all refinements, two for each
/// level whose limit was asked for, and levels below the one asked for.
class OPENSUBDIVHEX_API DeviceEvaluator {
public:
    using Options = RefinementEvaluator::Options;

    using Values = DeviceValues;

    DeviceEvaluator(std::unique_ptr<Device> device, FarExt::TopologyRefiner const &refiner);

    /// Loads what the device needs for all levels.
    FarExt::CallStatus Prepare(Options options);

    Device &GetDevice() const { return *_device; }
    int GetMaxLevel() const { return int(_numElements.size()) - 1; }
    int GetNumElements(int level) const { return _numElements[std::size_t(level)]; }
    std::int64_t GetNumElementsAllLevels() const;
    std::int64_t GetNumDeviceBytes() const;

    /// @name As in RefinementEvaluator
    /// @{
    FarExt::CallStatus Evaluate(Values const &src, Values const &dst, int level);
    FarExt::CallStatus EvaluateAllLevels(Values const &src, Values const &dst);
    /// \param outputs  the points, or with du and dv behind them
    FarExt::CallStatus EvaluateLimit(Values const &src, std::vector<Values> const &outputs,
                                     int level);
    /// @}

    /// For a level whose faces are all drawn whole.
    std::int64_t GetNumTriangles(int level) const { return _numTriangles[std::size_t(level)]; }
    /// \brief Writes the triangles of a level, three vertices each, as CreateTriangleIndices orders
    /// them.
    ///
    /// \param dst  a buffer of unsigned integers of 32 bits
    FarExt::CallStatus MakeTriangleIndices(DeviceBufferName dst, int level, int vertexOffset);

private:
    // Where the listed corners and vertices of a refinement are among the indices.
    struct Places {
        std::uint32_t corners;
        std::uint32_t vertices;
    };
    struct Elements {
        DeviceBufferName buffer;
        std::int64_t offset;
        std::int64_t stride;
    };
    // The steps of a frame.
    class Frame {
    public:
        // Adds a kernel, unless it has nothing to do.
        void Add(DeviceTask &task, std::uint32_t count);
        // Later steps see earlier writes.
        void Wait();
        // Runs nothing if the device does not take all kernels.
        FarExt::CallStatus Run(Device &device) const;

    private:
        struct Step {
            DeviceTask task;
            bool isAwaited;
        };
        std::vector<Step> _steps;
    };
    // The limit of a level, and its arrays: faces of both kinds, vertices and sources, and lattices in one.
    struct Limit {
        explicit Limit(Device &device) : indices(device), weights(device) {}

        int GetLastLevel() const;

        std::vector<DeviceLimit::OfLevel> levels;
        std::vector<DeviceLimit::Lattice> lattices;
        std::uint32_t firstOwnFace = 0; // these three in indices
        std::uint32_t firstVertex = 0;
        std::uint32_t firstLatticeIndex = 0;
        DeviceBuffer indices;
        DeviceBuffer weights;
    };

    // The faces of a level: the vertices of those that are no F-faces, and, where these are not in a few
    // runs, the first corners of all.
    struct Faces {
        explicit Faces(Device &device) : indices(device) {}

        struct Run {
            std::uint32_t firstFace;
            std::uint32_t count;
            std::uint32_t firstCorner;
            std::uint32_t size;
        };
        std::vector<Run> runs;
        std::uint32_t numConsecutiveCorners = 0;
        std::uint32_t firstConsecutiveVertex = 0;
        std::uint32_t firstListedVertex = 0; // in indices, behind the first corners
        DeviceBuffer indices;
    };

    FarExt::CallStatus loadIndices(std::size_t numIndices,
                                   std::function<void(std::int32_t *)> const &fill,
                                   std::vector<std::int32_t> const &values);
    FarExt::CallStatus check(Values const &src, std::vector<Values> const &outputs, int level,
                             std::int64_t numWritten) const;
    FarExt::CallStatus prepareLimit(int level);
    FarExt::CallStatus prepareFaces(int level);
    FarExt::CallStatus checkRefiner() const;
    DeviceTask makeTask(DeviceKernel kernel, int length, Elements const &src,
                        Elements const &dst) const;
    Elements toVertices(Frame &frame, Elements const &src, int length);
    Elements getScratch(int level, int length);
    void resizeScratch(int length, int last);
    void refine(Frame &frame, std::size_t number, Elements const &src, Elements const &dst,
                int length);
    void evaluateLimit(Frame &frame, Elements const &src, std::vector<Elements> const &outputs,
                       int length, int level);
    void evaluateLattices(Frame &frame, Elements src, std::vector<Elements> outputs, int length,
                          Limit const &limit);
    static void runLimit(Frame &frame, DeviceTask &task, Limit const &limit,
                         std::vector<Elements> const &outputs, std::uint32_t count);

    std::unique_ptr<Device> const _device;
    FarExt::TopologyRefiner const &_refiner; // for limits
    int const _numRefinements;               // of it, when this was made
    bool _isOfVertices = true;               // not of face-varying values, nor varying
    bool _isFaceVarying = false;

    std::vector<int> _numElements;              // by level
    std::vector<DeviceRefinement> _refinements; // by level of the parent
    std::vector<Places> _places;
    DeviceBuffer _indices;
    DeviceBuffer _weights;
    // For a face-varying channel some of whose values several vertices of its value mesh share: the
    // value of each vertex is an index, from here on.
    int _numValueVertices = 0;
    std::uint32_t _firstValue = 0;
    DeviceBuffer _controlValues; // by vertex of that value mesh
    DeviceBuffer _evenLevel;     // levels below the one asked for; that one, too, for its limit
    DeviceBuffer _oddLevel;
    std::vector<std::unique_ptr<Limit>> _limits; // by level; null: not yet asked
    std::vector<std::unique_ptr<Faces>> _faces;  // likewise
    std::vector<std::int64_t> _numTriangles;     // by level
};

} // namespace OpenSubdivHex::OsdExt::internal

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_DEVICE_DEVICE_KERNELS_H
#define OPENSUBDIVHEX_OSD_EXT_DEVICE_DEVICE_KERNELS_H

#include <cstdint>
#include <initializer_list>

// Qualifiers of each kernel function: nvcc compiles them for its devices.
#if defined(__CUDACC__)
#define OPENSUBDIVHEX_KERNEL_FUNCTION __host__ __device__ __forceinline__
#else
#define OPENSUBDIVHEX_KERNEL_FUNCTION inline
#endif

namespace OpenSubdivHex::OsdExt::internal {

/// Parameters of kernels besides their arrays: kernelParameters.inl.
struct DeviceParameters {
    using uint = std::uint32_t;
    using Place = std::uint64_t;

#define PLACE Place
#define PARAMETER(type, name) type name = 0;
#define PARAMETER_ARRAY(type, name, size) type name[size] = {};
#include "kernelParameters.inl"
#undef PARAMETER_ARRAY
#undef PARAMETER
#undef PLACE
};

/// \brief The arrays of kernels, as CUDA and C++ see them; null where a kernel has no use for one.
struct DeviceArguments : DeviceParameters {
    float const *sources = nullptr;
    float *results = nullptr;
    uint const *indices = nullptr;
    float const *weights = nullptr;
    float *duResults = nullptr;
    float *dvResults = nullptr;
    uint const *listedVertices = nullptr;
    uint *triangles = nullptr;
};

/// \brief The kernels, for elements of LENGTH floats and runs of faces with SIZE vertices.
template <int LENGTH, int SIZE>
struct DeviceKernels : DeviceArguments {
#define PLACE Place
#define ARRAY(binding, block, type, name)
#define READ_ARRAY(binding, block, type, name)
#define FUNCTION OPENSUBDIVHEX_KERNEL_FUNCTION
#define REFERENCE(type) type &
#define PRECISE
#include "kernels.inl"
#include "limitKernels.inl"
#undef PRECISE
#undef REFERENCE
#undef FUNCTION
#undef READ_ARRAY
#undef ARRAY
#undef PLACE
};

/// The kernels, in the order in which they stand.
enum class DeviceKernel {
    Copy,
    FaceRun,
    AnyFaceRun,
    WeightedFaceRun,
    Corners,
    VertexRun,
    Vertices,
    RegularLimit,
    OwnLimit,
    LatticeLimit,
    VertexLimit,
    Triangles
};

/// Runs invocation \p i of a kernel.
template <DeviceKernel KERNEL, int LENGTH, int SIZE>
OPENSUBDIVHEX_KERNEL_FUNCTION void RunKernel(DeviceKernels<LENGTH, SIZE> &kernels,
                                             std::uint32_t i) {
    if constexpr (KERNEL == DeviceKernel::Copy) {
        kernels.copyElement(i);
    } else if constexpr (KERNEL == DeviceKernel::FaceRun) {
        kernels.makeFVerticesOfRun(i);
    } else if constexpr (KERNEL == DeviceKernel::AnyFaceRun) {
        kernels.makeFVerticesOfFace(i);
    } else if constexpr (KERNEL == DeviceKernel::WeightedFaceRun) {
        kernels.makeFVerticesByWeights(i);
    } else if constexpr (KERNEL == DeviceKernel::Corners) {
        kernels.makeListedFVertex(i);
    } else if constexpr (KERNEL == DeviceKernel::VertexRun) {
        kernels.makeVVertexOfRun(i);
    } else if constexpr (KERNEL == DeviceKernel::Vertices) {
        kernels.makeListedVVertex(i);
    } else if constexpr (KERNEL == DeviceKernel::RegularLimit) {
        kernels.makeRegularLimit(i);
    } else if constexpr (KERNEL == DeviceKernel::OwnLimit) {
        kernels.makeOwnLimit(i);
    } else if constexpr (KERNEL == DeviceKernel::LatticeLimit) {
        kernels.makeLatticeLimit(i);
    } else if constexpr (KERNEL == DeviceKernel::VertexLimit) {
        kernels.makeListedLimit(i);
    } else {
        kernels.makeTriangles(i);
    }
}

/// The faces of runs that DeviceKernel::FaceRun takes.
constexpr int kMinUnrolledFace = 3;
constexpr int kMaxUnrolledFace = 6;
/// C++ and CUDA have kernels for elements of 1 to this many floats.
constexpr int kMaxCompiledLength = 4;

/// A kernel that C++ and CUDA compile beforehand.
template <DeviceKernel KERNEL, int LENGTH, int SIZE>
struct CompiledKernel {
    using Kernels = DeviceKernels<LENGTH, SIZE>;
    static constexpr DeviceKernel kKernel = KERNEL;
    static constexpr int kLength = LENGTH;
};

/// Calls run(CompiledKernel) for a kernel of up to kMaxCompiledLength floats.
template <int LENGTH, typename RUN>
void RunCompiled(DeviceKernel kernel, int length, int faceSize, RUN const &run) {
    if constexpr (LENGTH < kMaxCompiledLength) {
        if (length > LENGTH) {
            return RunCompiled<LENGTH + 1>(kernel, length, faceSize, run);
        }
    }
    switch (kernel) {
    case DeviceKernel::Copy:
        return run(CompiledKernel<DeviceKernel::Copy, LENGTH, 3>());
    case DeviceKernel::FaceRun:
        return faceSize == 3   ? run(CompiledKernel<DeviceKernel::FaceRun, LENGTH, 3>())
               : faceSize == 4 ? run(CompiledKernel<DeviceKernel::FaceRun, LENGTH, 4>())
               : faceSize == 5 ? run(CompiledKernel<DeviceKernel::FaceRun, LENGTH, 5>())
                               : run(CompiledKernel<DeviceKernel::FaceRun, LENGTH, 6>());
    case DeviceKernel::AnyFaceRun:
        return run(CompiledKernel<DeviceKernel::AnyFaceRun, LENGTH, 3>());
    case DeviceKernel::WeightedFaceRun:
        return run(CompiledKernel<DeviceKernel::WeightedFaceRun, LENGTH, 3>());
    case DeviceKernel::Corners:
        return run(CompiledKernel<DeviceKernel::Corners, LENGTH, 3>());
    case DeviceKernel::VertexRun:
        return run(CompiledKernel<DeviceKernel::VertexRun, LENGTH, 3>());
    case DeviceKernel::Vertices:
        return run(CompiledKernel<DeviceKernel::Vertices, LENGTH, 3>());
    case DeviceKernel::RegularLimit:
        return run(CompiledKernel<DeviceKernel::RegularLimit, LENGTH, 3>());
    case DeviceKernel::OwnLimit:
        return run(CompiledKernel<DeviceKernel::OwnLimit, LENGTH, 3>());
    case DeviceKernel::LatticeLimit:
        return faceSize == 3   ? run(CompiledKernel<DeviceKernel::LatticeLimit, 1, 3>())
               : faceSize == 4 ? run(CompiledKernel<DeviceKernel::LatticeLimit, 1, 4>())
                               : run(CompiledKernel<DeviceKernel::LatticeLimit, 1, 6>());
    case DeviceKernel::VertexLimit:
        return run(CompiledKernel<DeviceKernel::VertexLimit, LENGTH, 3>());
    case DeviceKernel::Triangles:
        return run(CompiledKernel<DeviceKernel::Triangles, 1, 3>());
    }
}

/// \brief Calls run(CompiledKernel, arguments) for elements of any length, in parts of up to
/// kMaxCompiledLength floats.
template <typename RUN>
void RunInParts(DeviceKernel kernel, int length, int faceSize, DeviceArguments arguments,
                RUN const &run) {
    for (; length > 0; length -= kMaxCompiledLength) {
        RunCompiled<1>(kernel, length, faceSize, [&](auto compiled) { run(compiled, arguments); });
        for (std::uint64_t *offset : {&arguments.sourceOffset, &arguments.resultOffset,
                                      &arguments.duOffset, &arguments.dvOffset}) {
            *offset += kMaxCompiledLength;
        }
    }
}

} // namespace OpenSubdivHex::OsdExt::internal

#endif

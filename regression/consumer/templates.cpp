// SPDX-License-Identifier: Apache-2.0
//
// Uses the templates of the public headers, which compilers look at only then: a program of a user who
// switches warnings on.  It is compiled, and does not run.

#include <bfr_ext/surface.h>
#include <far_ext/primvarRefiner.h>
#include <far_ext/stencilTableFactory.h>
#include <far_ext/topologyRefinerFactory.h>
#include <osd_ext/cpuEvaluator.h>
#include <osd_ext/refinementEvaluator.h>
#include <osd_ext/stencilEvaluator.h>
#if __has_include(<osd_ext/cudaEvaluator.h>)
#include <osd_ext/cudaEvaluator.h>
#include <osd_ext/cudaRefinementEvaluator.h>
#endif
#if __has_include(<osd_ext/glRefinementEvaluator.h>)
#include <osd_ext/glRefinementEvaluator.h>
#endif
#if __has_include(<GL/gl.h>)
#include <osd_ext/glEvaluation.h>

#include <opensubdiv/osd/glVertexBuffer.h>
#endif

#include <opensubdiv/osd/cpuVertexBuffer.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <vector>

namespace Far = OpenSubdiv::Far;
namespace Osd = OpenSubdiv::Osd;
namespace FarExt = OpenSubdivHex::FarExt;
namespace OsdExt = OpenSubdivHex::OsdExt;
namespace BfrExt = OpenSubdivHex::BfrExt;

struct Mesh {
    int numVertices;
    std::vector<int> faceSizes;
    std::vector<int> faceVertices;
};

namespace OpenSubdivHex::FarExt {

template <>
bool MeshRefinerFactory<Mesh>::resizeComponentTopology(BaseTopology &base, Mesh const &mesh) {
    setNumBaseVertices(base, mesh.numVertices);
    setNumBaseFaces(base, int(mesh.faceSizes.size()));
    int face = 0;
    for (int const size : mesh.faceSizes) {
        setNumBaseFaceVertices(base, face++, size);
    }
    return true;
}
template <>
bool MeshRefinerFactory<Mesh>::assignComponentTopology(BaseTopology &base, Mesh const &mesh) {
    auto next = mesh.faceVertices.begin();
    for (int face = 0; face < getNumBaseFaces(base); ++face) {
        IndexArray verts = getBaseFaceVertices(base, face);
        std::copy_n(next, verts.size(), verts.begin());
        next += verts.size();
    }
    return true;
}

} // namespace OpenSubdivHex::FarExt

namespace Consumer {

std::unique_ptr<FarExt::TopologyRefiner> makeRefiner(Mesh const &mesh);
std::unique_ptr<FarExt::TopologyRefiner> makeRefiner(Mesh const &mesh) {
    return FarExt::MeshRefinerFactory<Mesh>::Create(mesh);
}

// Elements of either precision.
template <typename REAL>
struct Value {
    void Clear() { value = 0; }
    void AddWithWeight(Value const &other, REAL weight) { value += weight * other.value; }

    REAL value;
};
// An array that counts as Far does.
template <typename REAL>
struct Values {
    Value<REAL> &operator[](int i) { return elements[std::size_t(i)]; }
    Value<REAL> const &operator[](int i) const { return elements[std::size_t(i)]; }

    std::vector<Value<REAL>> elements;
};

template <typename REAL, class ARRAY>
void refinePrimvars(FarExt::TopologyRefiner const &refiner, ARRAY const &src, ARRAY &dst) {
    FarExt::PrimvarRefinerReal<REAL> const primvars(refiner);
    primvars.Interpolate(1, src, dst);
    primvars.InterpolateVarying(1, src, dst);
    primvars.InterpolateFaceUniform(1, src, dst);
    primvars.InterpolateFaceVarying(1, src, dst);
    primvars.Limit(src, dst);
    primvars.Limit(src, dst, dst, dst);
}
template <typename REAL>
void refineAllPrimvars(FarExt::TopologyRefiner const &refiner) {
    std::vector<Value<REAL>> elements;
    refinePrimvars<REAL>(refiner, elements, elements);
    Values<REAL> values;
    refinePrimvars<REAL>(refiner, values, values);
    Value<REAL> *pointer = elements.data();
    refinePrimvars<REAL>(refiner, pointer, pointer);
}
template void refineAllPrimvars<float>(FarExt::TopologyRefiner const &);
template void refineAllPrimvars<double>(FarExt::TopologyRefiner const &);

template <class EVALUATOR, class BUFFER, class TABLE>
void evaluateTable(BUFFER *buffer, TABLE const &table) {
    Osd::BufferDescriptor const desc(0, 3, 3);
    EVALUATOR::EvalStencils(buffer, desc, buffer, desc, &table);
}
template <class EVALUATOR, class BUFFER>
void evaluateTables(FarExt::TopologyRefiner const &refiner, BUFFER *buffer) {
    auto const table = FarExt::StencilTableFactory::Create(refiner);
    evaluateTable<EVALUATOR>(buffer, *table);
    OsdExt::EvalStencils<EVALUATOR>(*table, buffer, buffer);
    OsdExt::EvalStencilsInPlace<EVALUATOR>(*table, buffer);
    OsdExt::CreateInPlaceBuffer<Osd::CpuVertexBuffer>(*table, 3);
    auto const limit = FarExt::LimitStencilTableFactory::Create(refiner, {});
    Osd::BufferDescriptor const desc(0, 3, 3);
    EVALUATOR::EvalStencils(buffer, desc, buffer, desc, buffer, desc, buffer, desc, limit.get());
}
template void evaluateTables<OsdExt::CpuEvaluator>(FarExt::TopologyRefiner const &,
                                                   Osd::CpuVertexBuffer *);
template void evaluateTables<OsdExt::ParallelEvaluator>(FarExt::TopologyRefiner const &,
                                                        Osd::CpuVertexBuffer *);
template void evaluateTable<OsdExt::CpuEvaluator>(Osd::CpuVertexBuffer *,
                                                  OsdExt::CompactStencilTable const &);

template <class EVALUATOR, class BUFFER>
void evaluateLevels(EVALUATOR &evaluator, BUFFER *buffer) {
    Osd::BufferDescriptor const desc(0, 3, 3);
    evaluator.Evaluate(buffer, desc, buffer, desc, 1);
    evaluator.EvaluateAllLevels(buffer, desc, buffer, desc);
    evaluator.EvaluateLimit(buffer, desc, buffer, desc, 1);
    evaluator.EvaluateLimit(buffer, desc, buffer, desc, buffer, desc, buffer, desc, 1);
}
template void evaluateLevels(OsdExt::RefinementEvaluator &, Osd::CpuVertexBuffer *);

#ifdef OPENSUBDIVHEX_OSD_EXT_CUDA_REFINEMENT_EVALUATOR_H
template void evaluateLevels(OsdExt::CudaRefinementEvaluator &, OsdExt::CudaVertexBuffer *);
#endif

#ifdef OPENSUBDIVHEX_OSD_EXT_GL_EVALUATION_H
#ifdef OPENSUBDIVHEX_OSD_EXT_GL_REFINEMENT_EVALUATOR_H
template void evaluateLevels(OsdExt::GLRefinementEvaluator &, Osd::GLVertexBuffer *);
#endif

void evaluateRanges(Osd::GLComputeEvaluator const &evaluator, Osd::GLVertexBuffer *buffer,
                    Far::LimitStencilTable const &limit);
void evaluateRanges(Osd::GLComputeEvaluator const &evaluator, Osd::GLVertexBuffer *buffer,
                    Far::LimitStencilTable const &limit) {
    Osd::BufferDescriptor const desc(0, 3, 3);
    auto const table = OsdExt::CreateGLStencilTable<Osd::GLStencilTableSSBO>(limit);
    OsdExt::EvalStencilsInRanges(evaluator, buffer, desc, buffer, desc, *table);
    OsdExt::EvalStencilsInRanges(evaluator, buffer, desc, buffer, desc, buffer, desc, buffer, desc,
                                 *table);
}
#endif

template <typename REAL, typename REAL_MESH>
void evaluateSurface(BfrExt::Surface<REAL> const &surface, REAL_MESH const *points,
                     REAL *controls) {
    REAL uv[2];
    surface.GetParameterization().GetVertexCoord(0, uv);
    surface.GetParameterization().GetEdgeCoord(0, REAL(0), uv);
    surface.GetParameterization().GetCenterCoord(uv);
    surface.GatherControlPoints(points, 3, controls, 3);
}
template void evaluateSurface(BfrExt::Surface<float> const &, float const *, float *);
template void evaluateSurface(BfrExt::Surface<float> const &, double const *, float *);
template void evaluateSurface(BfrExt::Surface<double> const &, float const *, double *);

} // namespace Consumer

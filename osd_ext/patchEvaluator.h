// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_PATCH_EVALUATOR_H
#define OPENSUBDIVHEX_OSD_EXT_PATCH_EVALUATOR_H

#include "far_ext/export.h"

#include <opensubdiv/osd/bufferDescriptor.h>
#include <opensubdiv/osd/types.h>

namespace OpenSubdivHex {

namespace Osd = OpenSubdiv::Osd;

namespace OsdExt {

namespace internal {
struct PatchTypes;
} // namespace internal

/// \cond  Not for users.
/// \brief The types that PatchEvaluator shares with its evaluators: nothing for users.
class OPENSUBDIVHEX_API PatchEvaluatorBase {
protected:
    /// Where values at places of patches go, or one of their derivatives; null: nowhere.
    struct PatchOutput {
        float *dst;
        Osd::BufferDescriptor desc;
    };

    /// Places of patches to be evaluated, as Osd's evaluators have them.
    struct PatchTask {
        float const *src;
        Osd::BufferDescriptor srcDesc;
        PatchOutput outputs[6]; ///< values; by s and t; by s twice, by s and t, by t twice
        Osd::PatchCoord const *coords;
        Osd::PatchArray const *arrays;
        int const *indices;
        Osd::PatchParam const *params;
    };

    /// Whether the descriptors are ones that can be evaluated, and all is there.
    static bool checkPatchTask(PatchTask const &task, int numCoords);
    /// Evaluates places [begin, end), with the same bits whatever the range.
    static void evaluatePatches(PatchTask const &task, int begin, int end);

private:
    friend struct internal::PatchTypes;
};
/// \endcond

/// \brief Functions of CpuEvaluator and ParallelEvaluator that evaluate patches, with the
/// signatures of Osd::CpuEvaluator.
///
/// \code
///     OsdExt::CpuEvaluator::EvalPatches(points, desc, dst, desc, numCoords, coords, cpuPatchTable);
/// \endcode
///
/// **Tables.** Osd::CpuPatchTable of any Far::PatchTable, of this library or of OpenSubdiv, or a class with
/// its functions.  Patches of the types REGULAR, GREGORY_BASIS and QUADS, which those of Catmull-Clark and
/// of PatchTableFactory are, are evaluated here; others, which those of Loop are, by Osd::CpuEvaluator.
///
/// **Results** are those of Osd::CpuEvaluator except for rounding, with its approximate derivatives of Gregory patches and
/// its scale of derivatives by the depth of patches.  Two patches with the same points on their common side have bitwise
/// equal results there if 1 - s, or 1 - t, is exact.  Osd::CpuEvaluator's differ by 1e-7 of their size.
///
/// **Elements** and **aliasing** are as in StencilEvaluator: elements that are read may not be written.
/// Outputs may be null, and are then left out.
///
/// **Order.** Evaluation is fastest where points of one patch follow one another.
///
/// **Threads.** As in StencilEvaluator: results are the same, bit for bit, for any evaluator and number of
/// threads.
///
/// **Return value.** False, with nothing written, if the lengths of descriptors differ or are less than 1, a
/// stride is less than the length, an offset is negative, or, where there are places, what is to be read
/// is null.  Indices in coordinates, arrays and patches are not checked.
template <class EVALUATOR>
class PatchEvaluator : public PatchEvaluatorBase {
    using Desc = Osd::BufferDescriptor;

public:
    /// @name With buffers
    /// \param srcBuffer,dstBuffer,...  have a function BindCpuBuffer() that returns a float pointer
    /// \param patchCoords              the same, of Osd::PatchCoord
    /// \param instance,deviceContext   not used
    /// @{

    /// Evaluates vertex data at (patch, s, t).
    template <class SRC, class DST, class COORDS, class TABLE>
    static bool EvalPatches(SRC *srcBuffer, Desc const &srcDesc, DST *dstBuffer,
                            Desc const &dstDesc, int numPatchCoords, COORDS *patchCoords,
                            TABLE *patchTable, EVALUATOR const * /*instance*/ = nullptr,
                            void * /*deviceContext*/ = nullptr) {
        return eval(srcBuffer, srcDesc, {bind(dstBuffer, dstDesc)}, numPatchCoords, patchCoords,
                    getVertexPatches(patchTable));
    }
    /// Overload with first derivatives.
    template <class SRC, class DST, class COORDS, class TABLE>
    static bool EvalPatches(SRC *srcBuffer, Desc const &srcDesc, DST *dstBuffer,
                            Desc const &dstDesc, DST *duBuffer, Desc const &duDesc, DST *dvBuffer,
                            Desc const &dvDesc, int numPatchCoords, COORDS *patchCoords,
                            TABLE *patchTable, EVALUATOR const * /*instance*/ = nullptr,
                            void * /*deviceContext*/ = nullptr) {
        return eval(srcBuffer, srcDesc,
                    {bind(dstBuffer, dstDesc), bind(duBuffer, duDesc), bind(dvBuffer, dvDesc)},
                    numPatchCoords, patchCoords, getVertexPatches(patchTable));
    }
    /// Overload with first and second derivatives.
    template <class SRC, class DST, class COORDS, class TABLE>
    static bool EvalPatches(SRC *srcBuffer, Desc const &srcDesc, DST *dstBuffer,
                            Desc const &dstDesc, DST *duBuffer, Desc const &duDesc, DST *dvBuffer,
                            Desc const &dvDesc, DST *duuBuffer, Desc const &duuDesc, DST *duvBuffer,
                            Desc const &duvDesc, DST *dvvBuffer, Desc const &dvvDesc,
                            int numPatchCoords, COORDS *patchCoords, TABLE *patchTable,
                            EVALUATOR const * /*instance*/ = nullptr,
                            void * /*deviceContext*/ = nullptr) {
        return eval(srcBuffer, srcDesc,
                    {bind(dstBuffer, dstDesc), bind(duBuffer, duDesc), bind(dvBuffer, dvDesc),
                     bind(duuBuffer, duuDesc), bind(duvBuffer, duvDesc), bind(dvvBuffer, dvvDesc)},
                    numPatchCoords, patchCoords, getVertexPatches(patchTable));
    }

    /// Evaluates varying data at (patch, s, t).
    template <class SRC, class DST, class COORDS, class TABLE>
    static bool EvalPatchesVarying(SRC *srcBuffer, Desc const &srcDesc, DST *dstBuffer,
                                   Desc const &dstDesc, int numPatchCoords, COORDS *patchCoords,
                                   TABLE *patchTable, EVALUATOR const * /*instance*/ = nullptr,
                                   void * /*deviceContext*/ = nullptr) {
        return eval(srcBuffer, srcDesc, {bind(dstBuffer, dstDesc)}, numPatchCoords, patchCoords,
                    getVaryingPatches(patchTable));
    }
    /// Overload with first derivatives.
    template <class SRC, class DST, class COORDS, class TABLE>
    static bool EvalPatchesVarying(SRC *srcBuffer, Desc const &srcDesc, DST *dstBuffer,
                                   Desc const &dstDesc, DST *duBuffer, Desc const &duDesc,
                                   DST *dvBuffer, Desc const &dvDesc, int numPatchCoords,
                                   COORDS *patchCoords, TABLE *patchTable,
                                   EVALUATOR const * /*instance*/ = nullptr,
                                   void * /*deviceContext*/ = nullptr) {
        return eval(srcBuffer, srcDesc,
                    {bind(dstBuffer, dstDesc), bind(duBuffer, duDesc), bind(dvBuffer, dvDesc)},
                    numPatchCoords, patchCoords, getVaryingPatches(patchTable));
    }

    /// Evaluates a face-varying channel at (patch, s, t).
    template <class SRC, class DST, class COORDS, class TABLE>
    static bool EvalPatchesFaceVarying(SRC *srcBuffer, Desc const &srcDesc, DST *dstBuffer,
                                       Desc const &dstDesc, int numPatchCoords, COORDS *patchCoords,
                                       TABLE *patchTable, int fvarChannel,
                                       EVALUATOR const * /*instance*/ = nullptr,
                                       void * /*deviceContext*/ = nullptr) {
        return eval(srcBuffer, srcDesc, {bind(dstBuffer, dstDesc)}, numPatchCoords, patchCoords,
                    getFVarPatches(patchTable, fvarChannel));
    }
    /// Overload with first derivatives.
    template <class SRC, class DST, class COORDS, class TABLE>
    static bool EvalPatchesFaceVarying(SRC *srcBuffer, Desc const &srcDesc, DST *dstBuffer,
                                       Desc const &dstDesc, DST *duBuffer, Desc const &duDesc,
                                       DST *dvBuffer, Desc const &dvDesc, int numPatchCoords,
                                       COORDS *patchCoords, TABLE *patchTable, int fvarChannel,
                                       EVALUATOR const * /*instance*/ = nullptr,
                                       void * /*deviceContext*/ = nullptr) {
        return eval(srcBuffer, srcDesc,
                    {bind(dstBuffer, dstDesc), bind(duBuffer, duDesc), bind(dvBuffer, dvDesc)},
                    numPatchCoords, patchCoords, getFVarPatches(patchTable, fvarChannel));
    }
    /// @}

    /// @name With pointers
    /// \param src,dst,...       without the offset of their descriptors, which is added
    /// \param patchCoords       (s, t), and handles, which have arrays and patches
    /// \param patchArrays       by array
    /// \param patchIndexBuffer  of source elements, of all patches
    /// \param patchParamBuffer  by patch
    /// @{

    // clang-tidy does not see that pointers in braces are copied.
    // NOLINTBEGIN(readability-non-const-parameter)

    /// Evaluates data at (patch, s, t).
    static bool EvalPatches(float const *src, Desc const &srcDesc, float *dst, Desc const &dstDesc,
                            int numPatchCoords, Osd::PatchCoord const *patchCoords,
                            Osd::PatchArray const *patchArrays, int const *patchIndexBuffer,
                            Osd::PatchParam const *patchParamBuffer) {
        return run({src,
                    srcDesc,
                    {{dst, dstDesc}},
                    patchCoords,
                    patchArrays,
                    patchIndexBuffer,
                    patchParamBuffer},
                   numPatchCoords);
    }
    /// Overload with first derivatives.
    static bool EvalPatches(float const *src, Desc const &srcDesc, float *dst, Desc const &dstDesc,
                            float *du, Desc const &duDesc, float *dv, Desc const &dvDesc,
                            int numPatchCoords, Osd::PatchCoord const *patchCoords,
                            Osd::PatchArray const *patchArrays, int const *patchIndexBuffer,
                            Osd::PatchParam const *patchParamBuffer) {
        return run({src,
                    srcDesc,
                    {{dst, dstDesc}, {du, duDesc}, {dv, dvDesc}},
                    patchCoords,
                    patchArrays,
                    patchIndexBuffer,
                    patchParamBuffer},
                   numPatchCoords);
    }
    /// Overload with first and second derivatives.
    static bool EvalPatches(float const *src, Desc const &srcDesc, float *dst, Desc const &dstDesc,
                            float *du, Desc const &duDesc, float *dv, Desc const &dvDesc,
                            float *duu, Desc const &duuDesc, float *duv, Desc const &duvDesc,
                            float *dvv, Desc const &dvvDesc, int numPatchCoords,
                            Osd::PatchCoord const *patchCoords, Osd::PatchArray const *patchArrays,
                            int const *patchIndexBuffer, Osd::PatchParam const *patchParamBuffer) {
        return run({src,
                    srcDesc,
                    {{dst, dstDesc},
                     {du, duDesc},
                     {dv, dvDesc},
                     {duu, duuDesc},
                     {duv, duvDesc},
                     {dvv, dvvDesc}},
                    patchCoords,
                    patchArrays,
                    patchIndexBuffer,
                    patchParamBuffer},
                   numPatchCoords);
    }
    // NOLINTEND(readability-non-const-parameter)
    /// @}

private:
    // The arrays of a table for one kind of data.
    struct Patches {
        Osd::PatchArray const *arrays = nullptr;
        int const *indices = nullptr;
        Osd::PatchParam const *params = nullptr;
    };
    struct Outputs {
        PatchOutput values[6];
    };

    template <class TABLE>
    static Patches getVertexPatches(TABLE *table) {
        return table ? Patches{table->GetPatchArrayBuffer(), table->GetPatchIndexBuffer(),
                               table->GetPatchParamBuffer()}
                     : Patches();
    }
    template <class TABLE>
    static Patches getVaryingPatches(TABLE *table) {
        return table ? Patches{table->GetVaryingPatchArrayBuffer(),
                               table->GetVaryingPatchIndexBuffer(), table->GetPatchParamBuffer()}
                     : Patches();
    }
    template <class TABLE>
    static Patches getFVarPatches(TABLE *table, int channel) {
        return table ? Patches{table->GetFVarPatchArrayBuffer(channel),
                               table->GetFVarPatchIndexBuffer(channel),
                               table->GetFVarPatchParamBuffer(channel)}
                     : Patches();
    }

    template <class BUFFER>
    static PatchOutput bind(BUFFER *buffer, Desc const &desc) {
        return {buffer ? buffer->BindCpuBuffer() : nullptr, desc};
    }

    template <class SRC, class COORDS>
    static bool eval(SRC *srcBuffer, Desc const &srcDesc, Outputs const &outputs, int numCoords,
                     COORDS *coords, Patches const &patches) {
        PatchTask task = {srcBuffer ? srcBuffer->BindCpuBuffer() : nullptr,
                          srcDesc,
                          {},
                          coords ? static_cast<Osd::PatchCoord const *>(coords->BindCpuBuffer())
                                 : nullptr,
                          patches.arrays,
                          patches.indices,
                          patches.params};
        for (int i = 0; i < 6; ++i) {
            task.outputs[i] = outputs.values[i];
        }
        return run(task, numCoords);
    }

    static bool run(PatchTask const &task, int numCoords) {
        if (!checkPatchTask(task, numCoords)) {
            return false;
        }
        if (numCoords > 0) {
            EVALUATOR::runPatches(task, numCoords);
        }
        return true;
    }
};

} // namespace OsdExt
} // namespace OpenSubdivHex

#endif

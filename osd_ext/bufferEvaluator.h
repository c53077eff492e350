// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_BUFFER_EVALUATOR_H
#define OPENSUBDIVHEX_OSD_EXT_BUFFER_EVALUATOR_H

#include "far_ext/status.h"

#include <opensubdiv/osd/bufferDescriptor.h>

#include <utility>

namespace OpenSubdivHex {

namespace Osd = OpenSubdiv::Osd;

namespace OsdExt {

/// \brief The functions of an evaluator with buffers in place of what these bind, as Osd's vertex
/// buffers do.  A buffer that is null fails as what it binds does when there is none.
///
/// \tparam EVALUATOR  the class that has this as its base
/// \tparam BINDING    has Bind(buffer), for the buffers that fit alone
template <class EVALUATOR, class BINDING>
class BufferEvaluator {
    /// So that what a buffer binds is not taken for one.
    template <class BUFFER>
    using IfBuffer = decltype(BINDING::Bind(std::declval<BUFFER &>()));

public:
    /// EVALUATOR::Evaluate() from and to buffers.
    template <class SRC_BUFFER, class DST_BUFFER, class = IfBuffer<SRC_BUFFER>>
    bool Evaluate(SRC_BUFFER *srcBuffer, Osd::BufferDescriptor const &srcDesc,
                  DST_BUFFER *dstBuffer, Osd::BufferDescriptor const &dstDesc, int level,
                  FarExt::CallStatus *status = nullptr) {
        return self().Evaluate(bind(srcBuffer), srcDesc, bind(dstBuffer), dstDesc, level, status);
    }
    /// EVALUATOR::EvaluateAllLevels() from and to buffers.
    template <class SRC_BUFFER, class DST_BUFFER, class = IfBuffer<SRC_BUFFER>>
    bool EvaluateAllLevels(SRC_BUFFER *srcBuffer, Osd::BufferDescriptor const &srcDesc,
                           DST_BUFFER *dstBuffer, Osd::BufferDescriptor const &dstDesc,
                           FarExt::CallStatus *status = nullptr) {
        return self().EvaluateAllLevels(bind(srcBuffer), srcDesc, bind(dstBuffer), dstDesc, status);
    }
    /// EVALUATOR::EvaluateLimit() from and to buffers.
    template <class SRC_BUFFER, class DST_BUFFER, class = IfBuffer<SRC_BUFFER>>
    bool EvaluateLimit(SRC_BUFFER *srcBuffer, Osd::BufferDescriptor const &srcDesc,
                       DST_BUFFER *dstBuffer, Osd::BufferDescriptor const &dstDesc, int level,
                       FarExt::CallStatus *status = nullptr) {
        return self().EvaluateLimit(bind(srcBuffer), srcDesc, bind(dstBuffer), dstDesc, level,
                                    status);
    }
    /// The same with derivatives.
    template <class SRC_BUFFER, class DST_BUFFER, class = IfBuffer<SRC_BUFFER>>
    bool EvaluateLimit(SRC_BUFFER *srcBuffer, Osd::BufferDescriptor const &srcDesc,
                       DST_BUFFER *dstBuffer, Osd::BufferDescriptor const &dstDesc,
                       DST_BUFFER *duBuffer, Osd::BufferDescriptor const &duDesc,
                       DST_BUFFER *dvBuffer, Osd::BufferDescriptor const &dvDesc, int level,
                       FarExt::CallStatus *status = nullptr) {
        return self().EvaluateLimit(bind(srcBuffer), srcDesc, bind(dstBuffer), dstDesc,
                                    bind(duBuffer), duDesc, bind(dvBuffer), dvDesc, level, status);
    }

protected:
    ~BufferEvaluator() = default;

private:
    EVALUATOR &self() { return static_cast<EVALUATOR &>(*this); }

    template <class BUFFER>
    static IfBuffer<BUFFER> bind(BUFFER *buffer) {
        return buffer ? BINDING::Bind(*buffer) : IfBuffer<BUFFER>();
    }
};

/// \brief What Osd::CpuVertexBuffer and the like bind.
struct CpuBinding {
    /// The floats.
    template <class BUFFER>
    static auto Bind(BUFFER &buffer) -> decltype(buffer.BindCpuBuffer()) {
        return buffer.BindCpuBuffer();
    }
};

} // namespace OsdExt
} // namespace OpenSubdivHex

#endif

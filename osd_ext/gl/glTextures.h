// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_GL_GL_TEXTURES_H
#define OPENSUBDIVHEX_OSD_EXT_GL_GL_TEXTURES_H

#include "osd_ext/device/device.h"

#include <epoxy/gl.h>

#include <cstdint>
#include <optional>

namespace OpenSubdivHex::OsdExt::internal {

/// \brief The arrays that kernels read as textures, where that is faster: Mesa's drivers for the processor
/// fetch texels for several invocations at once, but read arrays for one after the other.
class GlTextures {
public:
    GlTextures() = default;
    GlTextures(GlTextures const &) = delete;
    GlTextures &operator=(GlTextures const &) = delete;
    ~GlTextures();

    /// Whether kernels should read textures.
    bool AreFaster() { return getMaxTexels() > 0; }
    /// \brief Binds the arrays of a task, each at the number of its binding, and the weights, four at once, at 4.
    ///
    /// The weights are bound wherever textures are faster, even if other arrays are too large.
    ///
    /// \return  false if the kernel has to read arrays, textures being no faster or smaller than one of
    ///          these
    bool Bind(DeviceTask const &task);
    /// Binds none.
    void Unbind();

private:
    // Of the largest texture; 0 where arrays are read as fast.
    std::int64_t getMaxTexels();
    void setBuffers(DeviceTask const &task);

    static constexpr int kNumBindings = 8;

    std::optional<std::int64_t> _maxTexels;
    GLuint _names[kNumBindings] = {};
    bool _areBound = false;
};

} // namespace OpenSubdivHex::OsdExt::internal

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_GL_PATCH_DRAWING_H
#define OPENSUBDIVHEX_TOOLS_GL_PATCH_DRAWING_H

#include <opensubdiv/osd/glPatchTable.h>

#include <epoxy/gl.h>

#include <algorithm>
#include <cstddef>

namespace OpenSubdivHex::Tools {

/// \brief Draws all patches of a table of FarExt::PatchTableFactory by the program in use.
///
/// Attribute 0 reads the points, and the program has OpenSubdiv's vertex and tessellation shaders, whose
/// OsdPatchParamBuffer is texture unit 0.
///
/// \param firstPatch  the uniform that OsdPrimitiveIdBase() returns in the shaders
inline void DrawPatches(OpenSubdiv::Osd::GLPatchTable const &table, GLint firstPatch) {
    OpenSubdiv::Osd::PatchArray const &array = table.GetPatchArrays().front();
    int const numPoints = array.GetDescriptor().GetNumControlVertices();
    // Mesa's driver for processors splits calls of more than 1,024 vertices, and counts primitives anew in each part.
    int const numPerCall = 1024 / numPoints;
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_BUFFER, table.GetPatchParamTextureBuffer());
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, table.GetPatchIndexBuffer());
    glPatchParameteri(GL_PATCH_VERTICES, numPoints);
    for (int first = 0; first < array.GetNumPatches(); first += numPerCall) {
        int const count = std::min(numPerCall, array.GetNumPatches() - first);
        std::size_t const place = sizeof(GLuint) * std::size_t(numPoints) * std::size_t(first);
        glUniform1i(firstPatch, first);
        glDrawElements(GL_PATCHES, count * numPoints, GL_UNSIGNED_INT,
                       reinterpret_cast<void const *>(place));
    }
    glBindTexture(GL_TEXTURE_BUFFER, 0);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, 0);
}

} // namespace OpenSubdivHex::Tools

#endif

// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_HEXVIEW_PATCH_VIEW_H
#define OPENSUBDIVHEX_TOOLS_HEXVIEW_PATCH_VIEW_H

#include "far_ext/patchTableFactory.h"
#include "far_ext/topologyRefiner.h"
#include "tools/gl/glObjects.h"

#include <opensubdiv/osd/glPatchTable.h>

#include <memory>
#include <vector>

namespace OpenSubdivHex::Tools {

/// How finely the device tessellates patches.
struct PatchSettings {
    float rate = 8;          ///< segments of each side of a patch
    bool isByPixels = false; ///< in place of rate, as many as make segments of edgePixels
    float edgePixels = 8;
};

/// \brief The patches of a level in buffers of OpenGL, for OpenSubdiv's shaders.  A context is current.
class PatchView {
public:
    /// Throws std::runtime_error with the cause where the mesh has no patches of this level.
    PatchView(FarExt::TopologyRefiner const &refiner, int level);

    /// Makes the points of the patches from x y z of each control vertex.
    void Evaluate(std::vector<float> const &controlPoints);

    int GetNumPatches() const { return _numPatches; }
    int GetNumPoints() const { return _numPoints; }

    /// Draws the patches by \p program, which is in use and has OpenSubdiv's vertex and tessellation shaders, into
    /// the vertex array that is bound; shaders read kCoordArray and kFaceArray by patch.
    void Draw(ViewProgram const &program) const;

private:
    std::unique_ptr<Far::PatchTable const> _patches;
    std::unique_ptr<OpenSubdiv::Osd::GLPatchTable> _table;
    int _numPatches = 0;
    int _numPoints = 0;
    std::vector<float> _values; // of control vertices, then of points
    GlArray _points;
    GlArray _coords; // u and v of the four corners of each patch
    GlArray _faces;  // base face and level of each patch
};

} // namespace OpenSubdivHex::Tools

#endif

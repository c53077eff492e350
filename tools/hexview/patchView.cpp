// SPDX-License-Identifier: Apache-2.0
#include "patchView.h"

#include "drawnTopology.h"
#include "shaders.h"

#include "far_ext/patchTableFactory.h"
#include "osd_ext/cpuEvaluator.h"
#include "tools/gl/patchDrawing.h"

#include <algorithm>
#include <stdexcept>

namespace OpenSubdivHex::Tools {

PatchView::PatchView(FarExt::TopologyRefiner const &refiner, int level) {
    FarExt::PatchTableFactory::Options const options(level);
    FarExt::CallStatus status;
    _patches = FarExt::PatchTableFactory::Create(refiner, options, &status);
    if (!_patches) {
        throw std::runtime_error(status.GetErrorMessage());
    }
    FarExt::PatchMap const map(refiner, options); // refuses what the factory refuses
    _table.reset(OpenSubdiv::Osd::GLPatchTable::Create(_patches.get()));
    _numPatches = _patches->GetNumPatchesTotal();
    _numPoints = _patches->GetNumLocalPoints();
    std::vector<float> coords;
    std::vector<int> faces;
    for (int patch = 0; patch < _numPatches; ++patch) {
        coords.insert(coords.end(), map.GetCoords(patch).begin(), map.GetCoords(patch).end());
        faces.push_back(map.GetBaseFace(patch));
        faces.push_back(level);
    }
    _coords.Assign(coords);
    _faces.Assign(faces);
}

void PatchView::Evaluate(std::vector<float> const &controlPoints) {
    using OpenSubdiv::Osd::BufferDescriptor;
    _values.resize(controlPoints.size() + std::size_t(kLength * _numPoints));
    std::copy(controlPoints.begin(), controlPoints.end(), _values.begin());
    BufferDescriptor const control(0, kLength, kLength);
    BufferDescriptor const points(int(controlPoints.size()), kLength, kLength);
    Far::StencilTable const &stencils = *_patches->GetLocalPointStencilTable();
    OsdExt::ParallelEvaluator::EvalStencils(
        _values.data(), control, _values.data(), points, stencils.GetSizes().data(),
        stencils.GetOffsets().data(), stencils.GetControlIndices().data(),
        stencils.GetWeights().data(), 0, stencils.GetNumStencils());
    _points.Assign(_values);
}

void PatchView::Draw(ViewProgram const &program) const {
    _coords.Bind(kCoordArray);
    _faces.Bind(kFaceArray);
    glBindBuffer(GL_ARRAY_BUFFER, _points.BindVBO());
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(0, kLength, GL_FLOAT, GL_FALSE, 0, nullptr);
    DrawPatches(*_table, program["firstPatch"]);
    glDisableVertexAttribArray(0);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
}

} // namespace OpenSubdivHex::Tools

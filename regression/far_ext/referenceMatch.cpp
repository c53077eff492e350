// SPDX-License-Identifier: Apache-2.0
#include "referenceMatch.h"

#include "regression/shapes/shapeDescriptor.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>

namespace OpenSubdivHex::Regression {

FarExt::FaceMask ToFaceMask(ReferenceMask mask) {
    switch (mask) {
    case ReferenceMask::Average:
        return FarExt::FaceMask::Average;
    case ReferenceMask::Cosine:
        return FarExt::FaceMask::Cosine;
    case ReferenceMask::Smooth:
        return FarExt::FaceMask::Smooth;
    }
    throw std::invalid_argument("no such mask");
}

char const *ToString(ReferenceMask mask) {
    switch (mask) {
    case ReferenceMask::Average:
        return "Average";
    case ReferenceMask::Cosine:
        return "Cosine";
    case ReferenceMask::Smooth:
        return "Smooth";
    }
    throw std::invalid_argument("no such mask");
}

std::unique_ptr<FarExt::TopologyRefiner> CreateRefiner(Shape const &shape, ReferenceMask mask,
                                                       int level, Sdc::Options sdcOptions,
                                                       FarExt::HexSchemeOptions schemeOptions) {
    FarExt::TopologyRefinerFactory::Options options;
    options.hexSchemeOptions = schemeOptions;
    options.hexSchemeOptions.faceMask = ToFaceMask(mask);
    FarExt::CallStatus status;
    ShapeDescriptor const descriptor(shape);
    auto refiner =
        FarExt::TopologyRefinerFactory::Create(descriptor.Get(), sdcOptions, options, &status);
    if (!refiner) {
        throw std::runtime_error(shape.name + ": " + status.GetErrorMessage());
    }
    FarExt::TopologyRefiner::UniformOptions uniformOptions(level);
    uniformOptions.fullTopologyInLastLevel = true;
    if (!refiner->RefineUniform(uniformOptions, &status)) {
        throw std::runtime_error(shape.name + ": " + status.GetErrorMessage());
    }
    return refiner;
}

ReferenceValues GetPositions(Shape const &shape) {
    return Eigen::Map<ReferenceValues const>(shape.positions.data(), shape.GetNumVertices(), 3);
}

double GetSize(ReferenceValues const &values) { return values.cwiseAbs().maxCoeff(); }

ReferenceMatch::ReferenceMatch(Shape const &shape, int numLevels) {
    auto const refiner = CreateRefiner(shape, ReferenceMask::Average, numLevels);
    _levels.emplace_back();
    _levels[0].mesh = MakeReferenceMesh(shape.positions, shape.faceSizes, shape.faceVertices);
    _vertices.emplace_back(shape.GetNumVertices());
    _faces.emplace_back(shape.GetNumFaces());
    std::iota(_vertices[0].begin(), _vertices[0].end(), 0);
    std::iota(_faces[0].begin(), _faces[0].end(), 0);
    for (int level = 1; level <= numLevels; ++level) {
        _levels.push_back(Refine(_levels[level - 1].mesh, ReferenceMask::Average));
        if (!matchLevel(refiner->GetLevel(level - 1), level)) {
            return;
        }
    }
}

bool ReferenceMatch::matchLevel(FarExt::TopologyLevel const &pLevel, int level) {
    std::vector<int> const &pVertices = _vertices[level - 1];
    std::vector<int> const &pFaces = _faces[level - 1];
    std::vector<int> vertices;
    std::vector<int> faces;
    for (ReferenceVertexOrigin const &origin : _levels[level].vertexOrigins) {
        int const vertex = pVertices[origin.vertex];
        if (!origin.isFVertex) {
            vertices.push_back(vertex);
            continue;
        }
        int const face = pFaces[origin.face];
        int const place = pLevel.GetFaceVertices(face).FindIndex(vertex);
        if (place < 0) {
            _error = "level " + std::to_string(level) + ": face " + std::to_string(face) +
                     " has no vertex " + std::to_string(vertex);
            return false;
        }
        vertices.push_back(pLevel.GetNumVertices() + pLevel.GetFaceFirstCorner(face) + place);
    }
    for (ReferenceFaceOrigin const &origin : _levels[level].faceOrigins) {
        if (!origin.isEFace) {
            faces.push_back(pFaces[origin.face]);
            continue;
        }
        int const edge =
            pLevel.FindEdge(pVertices[origin.edgeVertices[0]], pVertices[origin.edgeVertices[1]]);
        if (edge < 0) {
            _error = "level " + std::to_string(level) + ": an edge is not there";
            return false;
        }
        faces.push_back(pLevel.GetNumFaces() + edge);
    }
    _vertices.push_back(std::move(vertices));
    _faces.push_back(std::move(faces));
    return true;
}

ReferenceValues ReferenceMatch::toLibraryOrder(ReferenceValues const &values, int level) const {
    ReferenceValues result(values.rows(), values.cols());
    for (Eigen::Index i = 0; i < values.rows(); ++i) {
        result.row(_vertices[level][i]) = values.row(i);
    }
    return result;
}

std::vector<ReferenceValues> ReferenceMatch::InterpolateAll(ReferenceMask mask,
                                                            ReferenceValues const &base) const {
    std::vector<ReferenceValues> result{base};
    ReferenceValues values = base;
    for (int level = 1; level <= GetMaxLevel(); ++level) {
        values = Interpolate(GetMesh(level - 1), _levels[level], mask, values);
        result.push_back(toLibraryOrder(values, level));
    }
    return result;
}

std::vector<ReferenceValues>
ReferenceMatch::InterpolateVaryingAll(ReferenceValues const &base) const {
    std::vector<ReferenceValues> result{base};
    ReferenceValues values = base;
    for (int level = 1; level <= GetMaxLevel(); ++level) {
        values = InterpolateVarying(GetMesh(level - 1), _levels[level], values);
        result.push_back(toLibraryOrder(values, level));
    }
    return result;
}

} // namespace OpenSubdivHex::Regression

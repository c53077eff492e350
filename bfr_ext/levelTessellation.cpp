// SPDX-License-Identifier: Apache-2.0
#include "cell/tessellationData.h"

#include "far_ext/vtr/basePolygon.h"

#include <algorithm>
#include <utility>

#include <opensubdiv/far/types.h>

namespace OpenSubdivHex::BfrExt {

using internal::TessellationData;

namespace {

// Returns the data that set(data) fills; empty data where it returns false.
template <typename SET>
std::shared_ptr<TessellationData const> makeData(SET const &set) {
    auto data = std::make_shared<TessellationData>();
    return set(*data) ? std::move(data) : std::make_shared<TessellationData>();
}

} // namespace

LevelTessellation::LevelTessellation(Parameterization const &parameterization, int level,
                                     Options options)
    : LevelTessellation(parameterization, 1, &level, options) {}

LevelTessellation::LevelTessellation(Parameterization const &parameterization, int numLevels,
                                     int const levels[], Options options)
    : _data(makeData([&](TessellationData &data) {
          return data.SetLevels(parameterization, numLevels, levels, options);
      })) {}

LevelTessellation::LevelTessellation(CellTree const &tree, Polyline const edges[], Options options)
    : _data(makeData([&](TessellationData &data) { return data.SetTree(tree, edges, options); })) {}

LevelTessellation::LevelTessellation(internal::FaceSections const &sections, int section,
                                     Options options)
    : _data(makeData(
          [&](TessellationData &data) { return data.SetSection(sections, section, options); })) {}

bool LevelTessellation::IsValid() const { return !_data->places.empty(); }

Parameterization LevelTessellation::GetParameterization() const { return _data->parameterization; }

int LevelTessellation::GetFaceSize() const { return _data->GetFaceSize(); }
FarExt::FaceShape LevelTessellation::GetFaceShape() const { return _data->GetFaceShape(); }

int LevelTessellation::GetNumSections() const { return _data->numSections; }

int LevelTessellation::GetSection() const { return _data->section; }

int LevelTessellation::GetNumEdges() const {
    return std::max(int(_data->firstEdgeCoords.size()) - 1, 0);
}

int LevelTessellation::GetNumCoords() const { return _data->GetNumCoords(); }

int LevelTessellation::GetCoordStride() const { return _data->coordStride; }

int LevelTessellation::GetNumBoundaryCoords() const { return _data->GetNumBoundaryCoords(); }

int LevelTessellation::GetVertexPlace(int vertex) const {
    return _data->firstEdgeCoords[std::size_t(vertex)];
}

int LevelTessellation::GetNumFacets() const {
    return std::max(int(_data->firstFacetIndices.size()) - 1, 0);
}

int LevelTessellation::GetFacetSize() const { return _data->facetSize; }

int LevelTessellation::GetFacetStride() const { return _data->facetStride; }

int LevelTessellation::GetMaxFacetSize() const { return _data->maxFacetSize; }

int LevelTessellation::GetNumFacetVertices() const { return int(_data->facetIndices.size()); }

template <typename REAL>
int LevelTessellation::writeCoords(int begin, int end, REAL coordTuples[]) const {
    for (int i = begin; i < end; ++i, coordTuples += _data->coordStride) {
        coordTuples[0] = REAL(_data->coords[2 * std::size_t(i)]);
        coordTuples[1] = REAL(_data->coords[2 * std::size_t(i) + 1]);
    }
    return end - begin;
}

template int LevelTessellation::writeCoords(int, int, float[]) const;
template int LevelTessellation::writeCoords(int, int, double[]) const;

template <typename REAL>
int LevelTessellation::GetPlaneCoords(REAL coordTuples[]) const {
    FarExt::internal::BasePolygon const polygon(_data->GetFaceShape());
    for (auto const &[sector, inSector] : _data->places) {
        polygon.Write(sector, {inSector[0], inSector[1]}, coordTuples);
        coordTuples += _data->coordStride;
    }
    return GetNumCoords();
}

template int LevelTessellation::GetPlaneCoords(float[]) const;
template int LevelTessellation::GetPlaneCoords(double[]) const;

int LevelTessellation::GetLevels(int levels[]) const {
    std::copy(_data->levels.begin(), _data->levels.end(), levels);
    return int(_data->levels.size());
}

bool LevelTessellation::IsUniform() const {
    return !_data->levels.empty() &&
           std::all_of(_data->levels.begin(), _data->levels.end(),
                       [&](int level) { return level == _data->levels[0]; });
}

namespace {

// Calls function(begin, end) with the indices of each facet.
template <typename FUNCTION>
void forEachFacet(TessellationData const &data, FUNCTION const &function) {
    for (std::size_t i = 0; i + 1 < data.firstFacetIndices.size(); ++i) {
        function(data.facetIndices.data() + data.firstFacetIndices[i],
                 data.facetIndices.data() + data.firstFacetIndices[i + 1]);
    }
}

template <typename FUNCTION>
void transform(TessellationData const &data, int facetTuples[], FUNCTION const &function) {
    forEachFacet(data, [&](int const *begin, int const *end) {
        std::transform(facetTuples, facetTuples + (end - begin), facetTuples, function);
        facetTuples += data.facetSize == 0 ? end - begin : data.facetStride;
    });
}

} // namespace

int LevelTessellation::GetFacetSizes(int sizes[]) const {
    forEachFacet(*_data, [&](int const *begin, int const *end) { *sizes++ = int(end - begin); });
    return GetNumFacets();
}

int LevelTessellation::GetFacetLevels(int levels[]) const {
    std::copy(_data->facetLevels.begin(), _data->facetLevels.end(), levels);
    return GetNumFacets();
}

int LevelTessellation::GetFacets(int facetTuples[]) const {
    forEachFacet(*_data, [&](int const *begin, int const *end) {
        int *const endOfFacet = std::copy(begin, end, facetTuples);
        facetTuples += _data->facetSize == 0 ? end - begin : _data->facetStride;
        if (end - begin < _data->facetSize) {
            *endOfFacet = OpenSubdiv::Far::INDEX_INVALID; // a triangle among quads
        }
    });
    return GetNumFacets();
}

void LevelTessellation::TransformFacetCoordIndices(int facetTuples[], int commonOffset) const {
    transform(*_data, facetTuples, [=](int index) { return index + commonOffset; });
}

void LevelTessellation::TransformFacetCoordIndices(int facetTuples[], int const boundaryIndices[],
                                                   int interiorOffset) const {
    int const numBoundary = GetNumBoundaryCoords();
    transform(*_data, facetTuples, [=](int index) {
        return index < numBoundary ? boundaryIndices[index] : index + interiorOffset;
    });
}

void LevelTessellation::TransformFacetCoordIndices(int facetTuples[], int const boundaryIndices[],
                                                   int const interiorIndices[]) const {
    int const numBoundary = GetNumBoundaryCoords();
    transform(*_data, facetTuples, [=](int index) {
        return index < numBoundary ? boundaryIndices[index] : interiorIndices[index - numBoundary];
    });
}

} // namespace OpenSubdivHex::BfrExt

// SPDX-License-Identifier: Apache-2.0
#include "normals.h"

#include "evaluation.h"

#include <algorithm>

namespace OpenSubdivHex::Tools {

bool IsNormal(VertexProperty const &property) {
    bool result = false;
    for (int k = 0; k < 3; ++k) {
        result = result || property.name == GetPropertyName(FVarKind::Normal, k);
    }
    return result;
}

namespace {

/// Whether \p property is a part of a normal that is not rounded to integers.
bool isFloatNormal(VertexProperty const &property) {
    return IsNormal(property) && !IsInteger(property.type);
}

/// Makes the normals that vertices have as properties 1 long.
void normalizeProperties(Mesh *mesh) {
    if (!HasFloatNormals(*mesh)) {
        return;
    }
    std::vector<VertexProperty *> normal;
    for (VertexProperty &property : mesh->vertexProperties) {
        if (isFloatNormal(property)) {
            normal.push_back(&property);
        }
    }
    std::vector<float> vectors(mesh->positions.size());
    for (std::size_t i = 0; i < vectors.size(); ++i) {
        vectors[i] = normal[i % 3]->values[i / 3];
    }
    Normalize(&vectors);
    for (std::size_t i = 0; i < vectors.size(); ++i) {
        normal[i % 3]->values[i / 3] = vectors[i];
    }
}

} // namespace

bool HasFloatNormals(Mesh const &mesh) {
    return std::count_if(mesh.vertexProperties.begin(), mesh.vertexProperties.end(),
                         isFloatNormal) >= 3;
}

void NormalizeNormals(Mesh *mesh) {
    for (FVarChannel &channel : mesh->channels) {
        if (channel.kind == FVarKind::Normal) {
            Normalize(&channel.values);
        }
    }
    normalizeProperties(mesh);
}

} // namespace OpenSubdivHex::Tools

// SPDX-License-Identifier: Apache-2.0
#include "normals.h"

#include "evaluation.h"

namespace OpenSubdivHex::Tools {

bool IsNormal(VertexProperty const &property) {
    bool result = false;
    for (int k = 0; k < 3; ++k) {
        result = result || property.name == GetPropertyName(FVarKind::Normal, k);
    }
    return result;
}

namespace {

/// Makes the normals that vertices have as properties 1 long.
void normalizeProperties(Mesh *mesh) {
    std::vector<VertexProperty *> normal;
    for (VertexProperty &property : mesh->vertexProperties) {
        if (IsNormal(property) && !IsInteger(property.type)) {
            normal.push_back(&property);
        }
    }
    if (normal.size() < 3) {
        return;
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

void NormalizeNormals(Mesh *mesh) {
    for (FVarChannel &channel : mesh->channels) {
        if (channel.kind == FVarKind::Normal) {
            Normalize(&channel.values);
        }
    }
    normalizeProperties(mesh);
}

} // namespace OpenSubdivHex::Tools

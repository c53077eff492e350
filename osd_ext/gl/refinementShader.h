// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_GL_REFINEMENT_SHADER_H
#define OPENSUBDIVHEX_OSD_EXT_GL_REFINEMENT_SHADER_H

namespace OpenSubdivHex::OsdExt::internal {

/// Invocations of a group.
inline constexpr int kShaderGroup = 64;

/// \brief The shader of all kernels.  Before it stand its version and the definitions of
///  - GROUP   kShaderGroup
///  - LENGTH  floats of an element
///  - SIZE    of the faces of FACE_RUN
///  - one of  COPY, FACE_RUN, CORNERS, VERTEX_RUN, VERTICES.
///
/// Elements are added in the order in which their indices stand, and \c precise keeps compilers from
/// other sums: the same buffers give the same bits.
inline constexpr char const *kRefinementShader = R"(
layout(local_size_x = GROUP) in;
layout(std430, binding = 0) readonly buffer Sources { float sources[]; };
layout(std430, binding = 1) buffer Results { float results[]; };
layout(std430, binding = 2) readonly buffer Indices { uint indices[]; };
layout(std430, binding = 3) readonly buffer Weights { float weights[]; };

uniform uint count; // of what the kernel works on
uniform uint sourceOffset;
uniform uint sourceStride;
uniform uint resultOffset; // of the first V-vertex of the level that is made
uniform uint resultStride;
uniform uint firstFVertex; // behind that
uniform uint firstIndex;   // position in indices or, of consecutive vertices, the first
uniform bool areConsecutive;
uniform uint firstCorner; // of a run of faces
uniform uint firstWeight;
uniform uint firstVertex; // of a run of vertices
uniform float vertexWeight;
uniform bool averagesFaces;

struct Element { float x[LENGTH]; };

Element getZero() {
    Element e;
    for (int k = 0; k < LENGTH; ++k) {
        e.x[k] = 0.0;
    }
    return e;
}
Element getSource(uint i) {
    Element e;
    uint place = sourceOffset + i * sourceStride;
    for (int k = 0; k < LENGTH; ++k) {
        e.x[k] = sources[place + uint(k)];
    }
    return e;
}
Element getFVertex(uint corner) {
    Element e;
    uint place = resultOffset + (firstFVertex + corner) * resultStride;
    for (int k = 0; k < LENGTH; ++k) {
        e.x[k] = results[place + uint(k)];
    }
    return e;
}
void add(inout Element e, float weight, Element other) {
    for (int k = 0; k < LENGTH; ++k) {
        precise float sum = e.x[k] + weight * other.x[k];
        e.x[k] = sum;
    }
}
void store(uint i, Element e) {
    uint place = resultOffset + i * resultStride;
    for (int k = 0; k < LENGTH; ++k) {
        results[place + uint(k)] = e.x[k];
    }
}

void main() {
    uint i = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * uint(GROUP) +
             gl_LocalInvocationID.x;
    if (i >= count) {
        return;
    }
#if defined(COPY)
    store(i, getSource(areConsecutive ? i : indices[firstIndex + i]));

#elif defined(FACE_RUN)
    Element v[SIZE];
    for (int j = 0; j < SIZE; ++j) {
        uint place = firstIndex + i * uint(SIZE) + uint(j);
        v[j] = getSource(areConsecutive ? place : indices[place]);
    }
    for (int c = 0; c < SIZE; ++c) {
        Element e = getZero();
        for (int j = 0; j < SIZE; ++j) {
            add(e, weights[firstWeight + uint(SIZE - c + j)], v[j]);
        }
        store(firstFVertex + firstCorner + i * uint(SIZE) + uint(c), e);
    }

#elif defined(CORNERS)
    uint place = firstIndex + 4u * i;
    uint size = indices[place + 1u];
    uint firstVert = indices[place + 2u];
    uint first = indices[place + 3u];
    Element e = getZero();
    for (uint j = 0u; j < size; ++j) {
        float weight = weights[first + j];
        if (weight != 0.0) {
            add(e, weight, getSource(indices[firstVert + j]));
        }
    }
    store(firstFVertex + indices[place], e);

#elif defined(VERTEX_RUN)
    Element e = getSource(firstVertex + i);
    if (averagesFaces) {
        for (uint j = 0u; j < 3u; ++j) {
            add(e, 1.0, getFVertex(indices[firstIndex + 3u * i + j]));
        }
        for (int k = 0; k < LENGTH; ++k) {
            e.x[k] *= vertexWeight;
        }
    }
    store(firstVertex + i, e);

#elif defined(VERTICES)
    uint place = firstIndex + 5u * i;
    uint numSources = indices[place + 1u];
    uint numCorners = indices[place + 2u];
    uint next = indices[place + 3u];
    uint first = indices[place + 4u];
    Element e = getZero();
    for (uint j = 0u; j < numSources; ++j) {
        add(e, weights[first + j], getSource(indices[next + j]));
    }
    if (numCorners > 0u) {
        Element sum = getZero();
        for (uint j = 0u; j < numCorners; ++j) {
            add(sum, 1.0, getFVertex(indices[next + numSources + j]));
        }
        add(e, weights[first + numSources], sum);
    }
    store(indices[place], e);
#endif
}
)";

} // namespace OpenSubdivHex::OsdExt::internal

#endif

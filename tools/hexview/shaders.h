// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_HEXVIEW_SHADERS_H
#define OPENSUBDIVHEX_TOOLS_HEXVIEW_SHADERS_H

namespace OpenSubdivHex::Tools {

/// The bindings of the arrays of a ViewedSurface.
enum ArrayBinding : unsigned {
    kPointArray,
    kSideVertexArray,
    kNormalArray,
    kFirstFanArray,
    kFanArray,
    kCornerSideArray,
    kCoordArray,
    kFaceArray
};

/// The version of all shaders of drawings.
inline constexpr char const *kVersion = "#version 430\n";

/// \brief The normal of each side: the sum of the vector areas that it spans with its neighbours in
/// the polygons around.  Once all normals are there, the mean curvature: the mean of the normal
/// curvatures towards the neighbours.
inline constexpr char const *kNormalShader = R"(#version 430
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Points { float points[]; };
layout(std430, binding = 1) readonly buffer SideVertices { uint sideVertices[]; };
layout(std430, binding = 2) buffer Normals { vec4 normals[]; };
layout(std430, binding = 3) readonly buffer FirstFans { uint firstFans[]; };
layout(std430, binding = 4) readonly buffer Fans { uint fans[]; };
uniform uint count;
uniform bool areNormalsThere;

vec3 getPoint(uint side) {
    uint place = 3u * sideVertices[side];
    return vec3(points[place], points[place + 1u], points[place + 2u]);
}

void main() {
    uint side = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * 64u;
    if (side >= count) {
        return;
    }
    vec3 point = getPoint(side);
    vec3 normal = normals[side].xyz;
    vec3 area = vec3(0.0);
    float curvature = 0.0;
    uint first = firstFans[side];
    uint last = firstFans[side + 1u];
    for (uint i = first; i < last; ++i) {
        uint next = fans[2u * i + 1u];
        vec3 edge = getPoint(next) - point;
        if (areNormalsThere) {
            float square = dot(edge, edge);
            curvature += square > 0.0 ? dot(normals[next].xyz - normal, edge) / square : 0.0;
        } else {
            area += cross(edge, getPoint(fans[2u * i]) - point);
        }
    }
    if (areNormalsThere) {
        normals[side].w = last > first ? curvature / float(last - first) : 0.0;
    } else {
        float size = length(area);
        normals[side] = vec4(size > 0.0 ? area / size : vec3(0.0), 0.0);
    }
}
)";

/// Corners of triangles, without vertex attributes.
inline constexpr char const *kSurfaceVertexShader = R"(#version 430
layout(std430, binding = 0) readonly buffer Points { float points[]; };
layout(std430, binding = 1) readonly buffer SideVertices { uint sideVertices[]; };
layout(std430, binding = 2) readonly buffer Normals { vec4 normals[]; };
layout(std430, binding = 5) readonly buffer CornerSides { uint cornerSides[]; };
layout(std430, binding = 6) readonly buffer Coords { vec2 coords[]; };
layout(std430, binding = 7) readonly buffer Faces { uvec2 faces[]; };
uniform mat4 projection;
out vec3 position;
out vec3 normal;
out float curvature;
out vec2 coord;
flat out uvec2 face; // base face and level

void main() {
    uint corner = uint(gl_VertexID);
    uint side = cornerSides[corner];
    uint place = 3u * sideVertices[side];
    position = vec3(points[place], points[place + 1u], points[place + 2u]);
    normal = normals[side].xyz;
    curvature = normals[side].w;
    coord = coords[corner];
    face = faces[corner / 3u];
    gl_Position = projection * vec4(position, 1.0);
}
)";

/// Colours of places: for fragment shaders, behind their version.
inline constexpr char const *kShading = R"(
uniform vec3 eye;
uniform vec3 up;
uniform float size; // of the mesh
uniform int shading;

const vec3 kPaint = vec3(0.92, 0.72, 0.46);

vec3 getHue(float hue) {
    return clamp(abs(fract(hue + vec3(0.0, 2.0, 1.0) / 3.0) * 6.0 - 3.0) - 1.0, 0.0, 1.0);
}

// Colours that differ, golden ratio apart.
vec3 getFaceColor(uint number) {
    return mix(vec3(0.9), getHue(fract(float(number) * 0.618034)), 0.55);
}

// From blue over green and yellow to red, a step for each level, and round again.
vec3 getLevelColor(uint level) {
    return mix(vec3(0.95), getHue(0.66 - 0.11 * float(level % 7u)), 0.7);
}

// The colour of a place; its curvature is the mean one, and it has a base face and a level.
vec4 shade(vec3 position, vec3 normal, float curvature, vec2 coord, uvec2 face) {
    vec3 toEye = normalize(eye - position);
    vec3 n = shading == 1 ? normalize(cross(dFdx(position), dFdy(position))) : normalize(normal);
    if (dot(n, toEye) < 0.0) {
        n = -n;
    }
    vec3 light = normalize(toEye + 0.6 * up + 0.4 * cross(up, toEye));
    float diffuse = 0.40 + 0.60 * max(dot(n, light), 0.0);
    vec3 paint = kPaint;
    if (shading == 2) { // lines of light, all around
        vec3 r = reflect(-toEye, n);
        float angle = atan(dot(r, up), length(r - dot(r, up) * up));
        float wave = sin(angle * 18.0);
        float width = fwidth(angle * 18.0);
        paint = vec3(mix(0.12, 0.95, smoothstep(-width, width, wave)));
        diffuse = 0.85;
    } else if (shading == 3) { // blue is hollow, red round
        float t = clamp(curvature * size * 0.12, -1.0, 1.0);
        paint = t < 0.0 ? mix(vec3(0.95), vec3(0.10, 0.25, 0.75), -t)
                        : mix(vec3(0.95), vec3(0.80, 0.15, 0.10), t);
    } else if (shading == 4) {
        paint = getFaceColor(face.x);
    } else if (shading == 5) {
        vec2 squares = floor(coord * 8.0);
        paint = mod(squares.x + squares.y, 2.0) < 0.5 ? vec3(0.92) : vec3(0.25, 0.40, 0.55);
    } else if (shading == 6) {
        paint = getLevelColor(face.y);
    }
    vec3 halfway = normalize(light + toEye);
    float gloss = shading == 2 ? 0.0 : 0.25 * pow(max(dot(n, halfway), 0.0), 40.0);
    return vec4(paint * diffuse + gloss, 1.0);
}
)";

inline constexpr char const *kSurfaceFragmentShader = R"(
in vec3 position;
in vec3 normal;
in float curvature;
in vec2 coord;
flat in uvec2 face;
out vec4 color;

void main() {
    color = shade(position, normal, curvature, coord, face);
}
)";

/// Definitions that OpenSubdiv's shaders of patches need: the camera, and how finely they tessellate.
inline constexpr char const *kPatchClient = R"(
uniform mat4 view;
uniform mat4 lens;
uniform float rate;
uniform int firstPatch; // of the call
mat4 OsdModelViewMatrix() { return view; }
mat4 OsdProjectionMatrix() { return lens; }
mat4 OsdModelViewProjectionMatrix() { return lens * view; }
float OsdTessLevel() { return rate; }
int OsdGregoryQuadOffsetBase() { return 0; }
int OsdPrimitiveIdBase() { return firstPatch; }
int OsdBaseVertex() { return 0; }
)";

/// Behind OpenSubdiv's common source, kPatchClient and kShading.  The mean curvature is that of the patch.
inline constexpr char const *kPatchFragmentShader = R"(
in block { OutputVertex v; } inpt;
layout(std430, binding = 6) readonly buffer Coords { vec2 coords[]; };
layout(std430, binding = 7) readonly buffer Faces { uvec2 faces[]; };
uniform bool hasEdges;
out vec4 color;

void main() {
    mat3 turn = transpose(mat3(view));
    vec3 position = turn * (inpt.v.position.xyz - view[3].xyz);
    vec3 normal = inpt.v.normal;
    vec3 du = inpt.v.tangent;
    vec3 dv = inpt.v.bitangent;
    float e = dot(du, du);
    float f = dot(du, dv);
    float g = dot(dv, dv);
    float square = e * g - f * f;
    float curvature = square > 0.0 ? (dot(inpt.v.Nu, du) * g + dot(inpt.v.Nv, dv) * e -
                                      (dot(inpt.v.Nu, dv) + dot(inpt.v.Nv, du)) * f) / (2.0 * square)
                                   : 0.0;
    vec2 st = inpt.v.tessCoord;
    int number = int(inpt.v.patchCoord.w);
    vec2 coord = mix(mix(coords[4 * number], coords[4 * number + 1], st.x),
                     mix(coords[4 * number + 3], coords[4 * number + 2], st.x), st.y);
    color = shade(position, turn * normal, curvature, coord, faces[number]);
    vec2 pixels = min(st, 1.0 - st) / max(fwidth(st), vec2(1e-6));
    if (hasEdges && min(pixels.x, pixels.y) < 0.6) {
        color = vec4(0.25, 0.20, 0.15, 1.0);
    }
}
)";

/// Edges of polygons.
inline constexpr char const *kEdgeVertexShader = R"(#version 430
layout(std430, binding = 0) readonly buffer Points { float points[]; };
layout(std430, binding = 1) readonly buffer SideVertices { uint sideVertices[]; };
layout(std430, binding = 5) readonly buffer EdgeSides { uint edgeSides[]; };
uniform mat4 projection;

void main() {
    uint place = 3u * sideVertices[edgeSides[gl_VertexID]];
    vec3 position = vec3(points[place], points[place + 1u], points[place + 2u]);
    gl_Position = projection * vec4(position, 1.0);
    gl_Position.z -= 2e-4 * gl_Position.w; // before the faces
}
)";

/// Vertices and edges of the control mesh.
inline constexpr char const *kControlVertexShader = R"(#version 430
layout(std430, binding = 0) readonly buffer Points { float points[]; };
layout(std430, binding = 5) readonly buffer Ends { uint ends[]; };
uniform mat4 projection;
uniform bool areEnds;
uniform int chosen; // vertex
out float isChosen;

void main() {
    uint vert = areEnds ? ends[gl_VertexID] : uint(gl_VertexID);
    gl_Position = projection * vec4(points[3u * vert], points[3u * vert + 1u],
                                    points[3u * vert + 2u], 1.0);
    gl_Position.z -= 4e-4 * gl_Position.w;
    isChosen = int(vert) == chosen ? 1.0 : 0.0;
    gl_PointSize = int(vert) == chosen ? 11.0 : 6.0;
}
)";

inline constexpr char const *kControlFragmentShader = R"(#version 430
in float isChosen;
uniform vec4 lineColor;
out vec4 color;

void main() {
    color = mix(lineColor, vec4(0.9, 0.1, 0.1, 1.0), isChosen);
}
)";

inline constexpr char const *kEdgeFragmentShader = R"(#version 430
uniform vec4 lineColor;
out vec4 color;

void main() {
    color = lineColor;
}
)";

} // namespace OpenSubdivHex::Tools

#endif

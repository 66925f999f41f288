#version 450 core
// Rectangles of the view, two triangles each: one program shades those where features are blurred, another the
// others.
#include "include/gpu_layout.glsl"

layout(location = 0) uniform int firstRect;
layout(location = 1) uniform vec2 viewSize;  // pixels

void main() {
    const ivec4 rect = texelFetch(rectTexels, firstRect + gl_InstanceID);
    const vec2 corner = vec2((gl_VertexID & 1) == 0 ? rect.x : rect.z, (gl_VertexID & 2) == 0 ? rect.y : rect.w);
    gl_Position = vec4(2.0 * corner.x / viewSize.x - 1.0, 1.0 - 2.0 * corner.y / viewSize.y, 0.0, 1.0);
}

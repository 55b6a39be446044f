// SPDX-License-Identifier: GPL-3.0-or-later
// A quad over the whole pixels that a shape can touch. Attributes are passed flat, as integers: interpolated values
// differ in their last bits between CPUs. Only the place is interpolated, which is half a pixel away from a wrong one.
#version 330 core

uniform ivec2 size; // of the picture, in pixels

layout(location = 0) in ivec4 bounds;
layout(location = 1) in ivec4 axis;
layout(location = 2) in ivec4 extents;
layout(location = 3) in ivec4 paint;

noperspective out vec2 place;
flat out ivec4 shape_axis;
flat out ivec4 shape_extents;
flat out ivec4 shape_paint;

void main() {
    ivec2 at = ivec2((gl_VertexID & 1) == 0 ? bounds.x : bounds.z, (gl_VertexID & 2) == 0 ? bounds.y : bounds.w);
    gl_Position = vec4(2.0 * vec2(at) / vec2(size) - 1.0, 0.0, 1.0);
    place = vec2(at - bounds.xy);
    shape_axis = axis;
    shape_extents = extents;
    shape_paint = paint;
}

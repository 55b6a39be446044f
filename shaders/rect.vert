// SPDX-License-Identifier: GPL-3.0-or-later
// A rectangle of whole pixels.
#version 330 core

uniform ivec2 size; // of the picture, in pixels

layout(location = 0) in ivec4 rect; // left, top, right, bottom, in pixels
layout(location = 1) in int paint;  // 0xRRGGBB

flat out vec4 fill;

void main() {
    ivec2 at = ivec2((gl_VertexID & 1) == 0 ? rect.x : rect.z, (gl_VertexID & 2) == 0 ? rect.y : rect.w);
    gl_Position = vec4(2.0 * vec2(at) / vec2(size) - 1.0, 0.0, 1.0);
    fill = vec4(ivec4(paint >> 16 & 255, paint >> 8 & 255, paint & 255, 255)) / 255.0;
}

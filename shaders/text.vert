// SPDX-License-Identifier: GPL-3.0-or-later
// A quad over the whole pixels of a glyph's bitmap.
#version 330 core

uniform ivec2 size; // of the picture, in pixels

layout(location = 0) in ivec4 box;   // left, top, width, height, in pixels
layout(location = 1) in ivec3 glyph; // first texel of the bitmap, texels of its rows, colour as 0xRRGGBB

flat out ivec4 glyph_box;
flat out ivec3 glyph_look;

void main() {
    ivec2 at = box.xy + ivec2((gl_VertexID & 1) == 0 ? 0 : box.z, (gl_VertexID & 2) == 0 ? 0 : box.w);
    gl_Position = vec4(2.0 * vec2(at) / vec2(size) - 1.0, 0.0, 1.0);
    glyph_box = box;
    glyph_look = glyph;
}

// SPDX-License-Identifier: GPL-3.0-or-later
// A glyph at whole pixels: one texel per pixel, unfiltered.
#version 330 core

uniform usamplerBuffer bitmaps; // all glyphs, one after another, row by row; alpha 0..255

flat in ivec4 glyph_box;
flat in ivec3 glyph_look;

out vec4 color;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy) - glyph_box.xy;
    int alpha = int(texelFetch(bitmaps, glyph_look.x + pixel.y * glyph_look.y + pixel.x).r);
    color = vec4(ivec4(glyph_look.z >> 16 & 255, glyph_look.z >> 8 & 255, glyph_look.z & 255, alpha)) / 255.0;
}

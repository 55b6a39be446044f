// SPDX-License-Identifier: GPL-3.0-or-later
// A rounded box by its signed distance. All lengths are integers in 1/65536 pixel, and so is all arithmetic: no
// rounding, no fused multiply-add, no library function can change a bit of the result on any machine.
#version 330 core

flat in ivec2 corner;      // the pixel from which the positions below count
flat in ivec4 shape_axis;  // direction of the local x axis (x, y; y down); local position of the corner's centre
flat in ivec4 shape_form;  // half width, half height, corner radius, width of the outline
flat in ivec4 shape_paint; // fill, outline, band along the local top, as 0xRRGGBB; thickness of the band;
                           // bit 24 of the fill: the outline alone

out vec4 color;

const int PIXEL = 65536;
const int LEVELS = 51; // of coverage; 255 / 51 is whole, so that alpha is exact in eight bits

// Length of v, of which no component is above `limit`.
int length_of(ivec2 v, int limit) {
    int shift = limit < 64 * PIXEL ? 8 : 12; // so that the squares fit
    ivec2 w = v >> shift;
    int square = w.x * w.x + w.y * w.y;
    int root = int(sqrt(float(square)));
    // Whatever sqrt rounds to, these two lines make it the whole root.
    if (root * root > square) root--;
    if ((root + 1) * (root + 1) <= square) root++;
    return root << shift;
}

// Distance to the outline of the box, negative inside.
int box_distance(ivec2 at, ivec2 half_size, int radius) {
    ivec2 q = abs(at) - half_size + radius;
    if (q.x <= 0 || q.y <= 0) return max(q.x, q.y) - radius;
    if (max(q.x, q.y) > radius + 2 * PIXEL) return 2 * PIXEL;
    return length_of(q, radius + 2 * PIXEL) - radius;
}

// How much of a pixel lies inside, of LEVELS, where its centre is at this distance.
int coverage(int distance) {
    int inside = clamp(PIXEL / 2 - distance, 0, PIXEL);
    return (inside * LEVELS + PIXEL / 2) >> 16;
}

ivec3 unpack(int rgb) { return ivec3(rgb >> 16, rgb >> 8, rgb) & 255; }

ivec3 blend(ivec3 below, ivec3 above, int level) {
    return (below * (LEVELS - level) + above * level + LEVELS / 2) / LEVELS;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy) - corner;
    ivec2 axis = shape_axis.xy;
    ivec2 at = shape_axis.zw + ivec2(axis.x * pixel.x + axis.y * pixel.y, axis.y * pixel.x - axis.x * pixel.y);
    int distance = box_distance(at, shape_form.xy, shape_form.z);
    ivec3 inner = blend(unpack(shape_paint.x), unpack(shape_paint.z), coverage(shape_form.y - shape_paint.w - at.y));
    int inside = coverage(distance + shape_form.w);
    ivec3 painted = blend(unpack(shape_paint.y), inner, inside);
    int level = coverage(distance) - (shape_paint.x >> 24) * inside;
    color = vec4(vec3(painted), float(level * (255 / LEVELS))) / 255.0;
}

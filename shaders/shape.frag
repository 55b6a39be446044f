// SPDX-License-Identifier: GPL-3.0-or-later
// A rounded box from its signed distance. Lengths are integers in 1/65536 pixel. Arithmetic is on integers, on floats
// that hold integers below 2^24, or ends in rounding far from a border: no rounding error, fused multiply-add or
// library function can change a bit of the result on any machine.
#version 330 core

noperspective in vec2 place; // of the pixel's centre, from the corner of the quad; its whole part counts
flat in ivec4 shape_axis;    // direction of the local x axis (x, y; y down); local position of the first pixel's centre
flat in ivec4 shape_extents; // half width, half height, corner radius, outline width
flat in ivec4 shape_paint;   // fill, outline, band colour, as 0xRRGGBB; band thickness along the local top;
                             // bit 24 of the fill: outline only

out vec4 color;

const int PIXEL = 65536;
const float LEVELS = 51.0; // of coverage; 255 / 51 is an integer, so alpha is exact in eight bits

// Length of v, whose components are at most `limit`.
int length_of(ivec2 v, int limit) {
    int shift = limit < 64 * PIXEL ? 8 : 12; // so that the squares do not overflow
    ivec2 w = v >> shift;
    int square = w.x * w.x + w.y * w.y;
    int root = int(sqrt(float(square)));
    // Correct the root to the exact integer root, however sqrt rounds.
    int above = square - root * root;
    root += above < 0 ? -1 : above > 2 * root ? 1 : 0;
    return root << shift;
}

// Signed distance to the outline of the box, negative inside.
int box_distance(ivec2 at, ivec2 half_size, int radius) {
    ivec2 q = abs(at) - half_size + radius;
    if (q.x <= 0 || q.y <= 0) return max(q.x, q.y) - radius;
    if (max(q.x, q.y) > radius + 2 * PIXEL) return 2 * PIXEL;
    return length_of(q, radius + 2 * PIXEL) - radius;
}

// Coverage of a pixel, 0 to LEVELS, from the distance of its centre.
float coverage(int distance) {
    float inside = float(clamp(PIXEL / 2 - distance, 0, PIXEL));
    return floor((inside * LEVELS + float(PIXEL / 2)) * (1.0 / float(PIXEL)));
}

vec3 unpack(int rgb) { return vec3(ivec3(rgb >> 16, rgb >> 8, rgb) & 255); }

// The mean, rounded. It is at least 0.5 / LEVELS away from a half, so the error of the factor does not show.
vec3 blend(vec3 below, vec3 above, float level) {
    return floor((below * LEVELS + (above - below) * level) * (1.0 / LEVELS) + 0.5);
}

void main() {
    ivec2 pixel = ivec2(place);
    ivec2 axis = shape_axis.xy;
    ivec2 at = shape_axis.zw + ivec2(axis.x * pixel.x + axis.y * pixel.y, axis.y * pixel.x - axis.x * pixel.y);
    int distance = box_distance(at, shape_extents.xy, shape_extents.z);
    vec3 inner = blend(unpack(shape_paint.x), unpack(shape_paint.z), coverage(shape_extents.y - shape_paint.w - at.y));
    float inside = coverage(distance + shape_extents.w);
    vec3 painted = blend(unpack(shape_paint.y), inner, inside);
    float level = coverage(distance) - float(shape_paint.x >> 24) * inside;
    color = vec4(painted, level * (255.0 / LEVELS)) * (1.0 / 255.0); // rounded to bytes
}

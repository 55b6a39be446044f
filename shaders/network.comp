// SPDX-License-Identifier: GPL-3.0-or-later
// A network of layers (src/nets/nets.h) on a row of a batch, of which an invocation computes up to GROUP outputs, with
// the sums in the order of C. The host puts before this GROUP; of the network INPUTS, OUTPUTS, LAST (inputs of the last
// layer), LAST_KIND (its Activation), WIDEST (of the others), PARAMETERS, and LAYERS, a LAYER for each but the last;
// and REAL, the type of the layers.
layout(local_size_x = GROUP) in;
layout(std430, binding = 0) readonly buffer Network { float numbers[]; };  // its block
layout(std430, binding = 1) readonly buffer Inputs { float inputs[]; };    // [INPUTS, rows]
layout(std430, binding = 2) writeonly buffer Outputs { float outputs[]; }; // [OUTPUTS, rows]
uniform ivec2 size;                                                        // rows

// Other than in C, a device may lose NaN.
REAL activate(int kind, REAL x) {
    if (kind == 1) return REAL(1.0 / (1.0 + exp(-float(x))));
    if (kind == 2) return REAL(1.0 - 2.0 / (exp(2.0 * float(x)) + 1.0));
    return kind == 3 ? max(x, REAL(0.0)) : x;
}

REAL x[WIDEST], y[WIDEST];

REAL neuron(int at, int from, int to, int j) {
    REAL sum = REAL(numbers[at + from * to + j]);
    for (int i = 0; i < from; i++) sum += REAL(numbers[at + j * from + i]) * x[i];
    return sum;
}

// Constant sizes let the compiler unroll loops, and keep x and y in registers. Of x = y, Mesa
// 25.0 makes one array for all layers.
#define LAYER(from, to, kind)                                                     \
    for (int j = 0; j < to; j++) y[j] = activate(kind, neuron(at, from, to, j)); \
    for (int j = 0; j < to; j++) x[j] = y[j];                                     \
    at += (from + 1) * to;

void main() {
    const int rows = size.x, scales = PARAMETERS + INPUTS, results = scales + INPUTS;
    const int row = int((gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * GROUP + gl_LocalInvocationID.x);
    if (row >= rows) return;
    int at = 0;
    for (int i = 0; i < INPUTS; i++)
        x[i] = REAL((inputs[i * rows + row] - numbers[PARAMETERS + i]) * numbers[scales + i]);
    LAYERS
    const int first = int(gl_WorkGroupID.z) * GROUP;
    for (int k = first; k < min(first + GROUP, OUTPUTS); k++) {
        const float result = float(activate(LAST_KIND, neuron(at, LAST, OUTPUTS, k)));
        outputs[k * rows + row] = result / numbers[results + OUTPUTS + k] + numbers[results + k];
    }
}

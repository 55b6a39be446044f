/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loops over particles and edges, compiled once for each instruction set (CMakeLists.txt) from gns_kernels_code.h. All
   perform the same operations in the same order, so they have the same bits. Rows are items, features are innermost. */
#pragma once

typedef struct GnsKernels {
    const char *name;
    /* out[rows, outputs] = biases[outputs] + in[rows, inputs] weights[inputs, outputs]; biases NULL: adds to out. */
    void (*multiply)(float *out, const float *in, const float *weights, const float *biases, int rows, int inputs,
                     int outputs);
    /* gradient[inputs, outputs] += in^T slopes, over in[rows, inputs] and slopes[rows, outputs]. */
    void (*add_gradient)(float *gradient, const float *in, const float *slopes, int rows, int inputs, int outputs);
    /* out[rows, width] += of[at[row], width] */
    void (*add_rows)(float *out, const float *of, const int *at, int rows, int width);
    /* out[at[row], width] += of[rows, width] */
    void (*add_to_rows)(float *out, const float *of, const int *at, int rows, int width);
    void (*relu)(float *values, int count);
    /* Layer norm (Ba, Kiros, Hinton 2016) of values[rows, width], which become the normalised ones; inverse[rows] is
       1 / deviation; out = normalised * gain + offset. */
    void (*normalise)(float *values, float *inverse, float *out, const float *gain, const float *offset, int rows,
                      int width);
    /* From d loss / d out to d loss / d values, before the norm: slopes[rows, width] in place. */
    void (*normalise_back)(float *slopes, const float *normalised, const float *inverse, const float *gain, int rows,
                           int width);
} GnsKernels;

extern const GnsKernels gns_kernels_scalar, gns_kernels_avx2;

/* The kernels that this CPU supports, widest first; ends with NULL. */
enum { GNS_KERNELS_MAX = 2 };
void gns_kernels_list(const GnsKernels *list[GNS_KERNELS_MAX + 1]);

/* The first of the list. */
const GnsKernels *gns_kernels_best(void);

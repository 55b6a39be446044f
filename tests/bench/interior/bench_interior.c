/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Microseconds of the linear algebra of interior-point steps on the contact graphs of pyramids with 10 to 5,050 boxes:
   the analysis (order of elimination and pattern), the factorization and one solution, by each set of kernels. The
   kernels take turns. Values do not matter for the time: every edge has the same blocks. */
#include "report.h"

#include "interior/interior.h"

#include <stdio.h>
#include <stdlib.h>

enum { SIZES = 4, SAMPLES = 15, ROWS_MAX = 100, BOXES_MAX = ROWS_MAX * (ROWS_MAX + 1) / 2 };

static const int rows[SIZES] = {4, 11, 31, ROWS_MAX};

static BlockEdge edges[3 * BOXES_MAX];
static Vec4 x[BOXES_MAX + 1];

static void give_up(void) {
    fprintf(stderr, "out of memory\n");
    exit(3);
}

/* Box i of row r (from below, with `base` - r boxes) rests on boxes i and i + 1 of the row below and touches its
   neighbour. Returns the number of edges. */
static int pyramid_edges(int base) {
    int count = 0, first = 0;
    for (int r = 0; r < base; r++) {
        const int boxes = base - r;
        for (int i = 0; i < boxes; i++) {
            if (i + 1 < boxes) edges[count++] = (BlockEdge){first + i, first + i + 1};
            for (int k = 0; r + 1 < base && i > 0 && k < 2; k++)
                edges[count++] = (BlockEdge){first + i - 1 + k, first + boxes + i - 1};
        }
        first += boxes;
    }
    return count;
}

/* Positive diagonals that exceed the rest of their rows. */
static void fill(BlockLu *lu) {
    for (int i = 0; i < lu->count + 2 * lu->below + 3; i++) lu->blocks[i] = (Block3){0};
    for (int k = 0; k < lu->count; k++) {
        for (int c = 0; c < 3; c++) lu->blocks[k].column[c][c] = 10;
        x[k] = (Vec4){1, 2, 3, 0};
    }
    for (int e = 0; e < lu->edge_count; e++)
        for (int c = 0; c < 3; c++) {
            lu->blocks[lu->places[e].row_a].column[c][c] = -1;
            lu->blocks[lu->places[e].row_b].column[c][c] = -0.9;
        }
}

static double since(double start) { return 1e6 * (processor_seconds() - start); }

static void measure(int base) {
    static const char *const parts[] = {"factorization", "solution"};
    const InteriorKernels *const kernels[2] = {&interior_scalar, interior_best()};
    const int boxes = base * (base + 1) / 2, edge_count = pyramid_edges(base), passes = 1 + 2000 / boxes;
    Samples analysis = {0}, times[2][2] = {{{0}}};
    BlockLu lu = {0};
    for (int sample = 0; sample < SAMPLES; sample++) {
        double start = processor_seconds();
        for (int pass = 0; pass < passes; pass++) {
            lu.edge_count = -1; /* forget the last analysis */
            if (!block_lu_analyse(&lu, boxes, edges, edge_count)) give_up();
        }
        samples_add(&analysis, since(start) / passes);
        for (int k = 0; k < 2; k++) {
            double factor = 0, solve = 0;
            for (int pass = 0; pass < passes; pass++) {
                fill(&lu);
                start = processor_seconds();
                kernels[k]->factor(&lu);
                factor += since(start);
                start = processor_seconds();
                kernels[k]->solve(&lu, x);
                solve += since(start);
            }
            samples_add(&times[k][0], factor / passes);
            samples_add(&times[k][1], solve / passes);
        }
    }
    char figure[64];
    snprintf(figure, sizeof figure, "%d boxes analysis", boxes);
    report_line("interior", "all kernels", figure, "us", &analysis);
    for (int part = 0; part < 2; part++)
        for (int k = 0; k < 2; k++) {
            snprintf(figure, sizeof figure, "%d boxes %s", boxes, parts[part]);
            report_line("interior", k == 0 ? "scalar kernel" : "best kernel", figure, "us", &times[k][part]);
        }
    block_lu_free(&lu);
}

int main(void) {
    report_header();
    for (int i = 0; i < SIZES; i++) measure(rows[i]);
    return 0;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Microseconds of the linear algebra of interior-point steps on the contact graphs of pyramids with 10 to 5,050 boxes:
   the analysis (order of elimination and pattern), the factorization with the pattern of the one before, and one
   solution, beside SuiteSparse: AMD, which only chooses an order, KLU, UMFPACK, and CHOLMOD, which gets the symmetric
   part of the matrix and needs half the work. They take turns. The linear algebra of a step is an analysis and an
   iteration's factorization and two solutions, a few times. */
#include "rival_suitesparse.h"
#include "report.h"

#include "methods/interior_point_internal.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SIZES = 4, SAMPLES = 9, PARTS = 3, KERNELS = 2, METHODS = KERNELS + RIVALS, ROWS_MAX = 100 };
enum { BOXES_MAX = ROWS_MAX * (ROWS_MAX + 1) / 2, TIMED = 4000 };

static const int rows[SIZES] = {4, 11, 31, ROWS_MAX};
static const char *const parts[PARTS] = {"analysis", "factorization", "solution"};
static const char *const own[KERNELS] = {"scalar kernel", "best kernel"};
static const double limit = 0.5; /* the own kernel stays where it takes at most half the time of the best library */

static BlockEdge edges[3 * BOXES_MAX];
static Vec4 x[BOXES_MAX + 1];

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

static Block3 block_of(int a, int b) {
    Block3 block = {0};
    for (int c = 0; c < 3; c++)
        for (int r = 0; r < 3; r++) block.column[c][r] = matrix_value(a, b, r, c);
    return block;
}

static void fill(BlockLu *lu) {
    for (int i = 0; i < lu->count + 2 * lu->below + 3; i++) lu->blocks[i] = (Block3){0};
    for (int k = 0; k < lu->count; k++) {
        lu->blocks[lu->position[k]] = block_of(k, k);
        x[k] = (Vec4){1, 2, 3, 0};
    }
    for (int e = 0; e < lu->edge_count; e++) {
        lu->blocks[lu->places[e].row_a] = block_of(edges[e].a, edges[e].b);
        lu->blocks[lu->places[e].row_b] = block_of(edges[e].b, edges[e].a);
    }
}

static double since(double start) { return 1e6 * (processor_seconds() - start); }

typedef struct Times {
    Samples of[METHODS][PARTS];
} Times;

static void measure_own(BlockLu *lu, int boxes, int edge_count, int passes, Times *times) {
    const InteriorKernels *const kernels[KERNELS] = {&interior_scalar, interior_best()};
    for (int k = 0; k < KERNELS; k++) {
        double spent[PARTS] = {0};
        for (int pass = 0; pass < passes; pass++) {
            double start = processor_seconds();
            lu->edge_count = -1; /* forget the last analysis */
            if (!block_lu_analyse(lu, boxes, edges, edge_count)) give_up("out of memory");
            spent[0] += since(start);
            fill(lu);
            start = processor_seconds();
            kernels[k]->factor(lu);
            spent[1] += since(start);
            start = processor_seconds();
            kernels[k]->solve(lu, x);
            spent[2] += since(start);
        }
        for (int part = 0; part < PARTS; part++) samples_add(&times->of[k][part], spent[part] / passes);
    }
}

static void measure_rival(const Rival *rival, const Matrix *matrix, int passes, Samples times[PARTS]) {
    void (*const work[PARTS])(const Matrix *) = {rival->analyse, rival->factor, rival->solve};
    for (int part = 0; part < PARTS; part++) {
        if (work[part] == NULL) continue;
        work[part](matrix); /* factors for the first time */
        const double start = processor_seconds();
        for (int pass = 0; pass < passes; pass++) work[part](matrix);
        samples_add(&times[part], since(start) / passes);
    }
}

/* The libraries solve the same matrix. */
static void check(const BlockLu *lu, const Matrix *matrix, const char *name) {
    for (int i = 0; i < lu->count; i++)
        for (int r = 0; r < 3; r++)
            if (!(fabs(x[lu->position[i]][r] - matrix->x[3 * i + r]) < 1e-12)) give_up(name);
}

/* An iteration's factorization and two solutions, of the fastest rival. */
static void report_step(const Times *times, int boxes) {
    double best = INFINITY;
    char name[64];
    for (int m = KERNELS; m < METHODS; m++) {
        const Samples *factor = &times->of[m][1], *solve = &times->of[m][2];
        if (factor->count > 0) best = fmin(best, samples_median(factor) + 2 * samples_median(solve));
    }
    const Samples *mine = times->of[1];
    snprintf(name, sizeof name, "interior iteration over SuiteSparse, %d boxes", boxes);
    report_target(name, (samples_median(&mine[1]) + 2 * samples_median(&mine[2])) / best, "at most", limit);
}

static void report(const Times *times, int boxes) {
    char figure[64];
    for (int part = 0; part < PARTS; part++)
        for (int m = 0; m < METHODS; m++) {
            if (times->of[m][part].count == 0) continue;
            snprintf(figure, sizeof figure, "%d boxes %s", boxes, parts[part]);
            report_line("interior", m < KERNELS ? own[m] : rivals[m - KERNELS].name, figure, "us", &times->of[m][part]);
        }
    report_step(times, boxes);
}

static void measure(int base) {
    static const Times none;
    const int boxes = base * (base + 1) / 2, edge_count = pyramid_edges(base), passes = 1 + TIMED / boxes;
    Matrix matrix = matrix_make(boxes, edges, edge_count);
    BlockLu lu = {0};
    Times times = none;
    for (int sample = 0; sample < SAMPLES; sample++) {
        measure_own(&lu, boxes, edge_count, passes, &times);
        for (int r = 0; r < RIVALS; r++) measure_rival(&rivals[r], &matrix, passes, times.of[KERNELS + r]);
    }
    fill(&lu);
    interior_best()->factor(&lu);
    for (int k = 0; k < boxes; k++)
        for (int c = 0; c < 3; c++) x[lu.position[k]][c] = matrix.right[3 * k + c];
    interior_best()->solve(&lu, x);
    for (int r = 1; r + 1 < RIVALS; r++) { /* CHOLMOD has another matrix */
        rivals[r].solve(&matrix);
        check(&lu, &matrix, rivals[r].name);
    }
    for (int r = 0; r < RIVALS; r++) rivals[r].end();
    report(&times, boxes);
    block_lu_free(&lu);
    matrix_free(&matrix);
}

int main(void) {
    report_header();
    for (int i = 0; i < SIZES; i++) measure(rows[i]);
    return 0;
}

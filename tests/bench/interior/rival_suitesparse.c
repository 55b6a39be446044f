/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "rival_suitesparse.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <suitesparse/amd.h>
#include <suitesparse/cholmod.h>
#include <suitesparse/klu.h>
#include <suitesparse/umfpack.h>

static void must(int works, const char *what) {
    if (works) return;
    fprintf(stderr, "%s failed\n", what);
    exit(3);
}

static void *take(size_t count, size_t size) {
    void *memory = calloc(count + 1, size);
    must(memory != NULL, "malloc");
    return memory;
}

double matrix_value(int a, int b, int r, int c) {
    if (a == b && r == c) return 60;
    return (a < b ? 0.9 : 1) * ((a + b + 3 * r + c) % 7 - 3) / 3;
}

static int compare(const void *x, const void *y) { return *(const int *)x - *(const int *)y; }

/* Columns of nodes with the diagonal, sorted. */
static void make_graph(Matrix *m, const BlockEdge *edges, int edge_count) {
    int *column = m->node_column = take((size_t)m->nodes + 1, sizeof *column);
    int *row = m->node_row = take((size_t)m->nodes + 2 * (size_t)edge_count, sizeof *row);
    for (int i = 0; i < m->nodes; i++) column[i + 1] = 1;
    for (int i = 0; i < edge_count; i++) {
        column[edges[i].a + 1]++;
        column[edges[i].b + 1]++;
    }
    for (int i = 0; i < m->nodes; i++) column[i + 1] += column[i];
    int *next = take((size_t)m->nodes, sizeof *next);
    memcpy(next, column, (size_t)m->nodes * sizeof *next);
    for (int i = 0; i < m->nodes; i++) row[next[i]++] = i;
    for (int i = 0; i < edge_count; i++) {
        row[next[edges[i].a]++] = edges[i].b;
        row[next[edges[i].b]++] = edges[i].a;
    }
    for (int i = 0; i < m->nodes; i++)
        qsort(row + column[i], (size_t)(column[i + 1] - column[i]), sizeof *row, compare);
    free(next);
}

Matrix matrix_make(int nodes, const BlockEdge *edges, int edge_count) {
    Matrix m = {.rows = 3 * nodes, .nodes = nodes};
    make_graph(&m, edges, edge_count);
    const size_t values = 9 * (size_t)m.node_column[nodes];
    m.column = take((size_t)m.rows + 1, sizeof *m.column);
    m.row = take(values, sizeof *m.row);
    m.value = take(values, sizeof *m.value);
    m.symmetric = take(values, sizeof *m.symmetric);
    m.right = take((size_t)m.rows, sizeof *m.right);
    m.x = take((size_t)m.rows, sizeof *m.x);
    int at = 0;
    for (int column = 0; column < m.rows; column++) {
        const int b = column / 3, c = column % 3;
        for (int x = m.node_column[b]; x < m.node_column[b + 1]; x++)
            for (int r = 0; r < 3; r++, at++) {
                const int a = m.node_row[x];
                m.row[at] = 3 * a + r;
                m.value[at] = matrix_value(a, b, r, c);
                m.symmetric[at] = (m.value[at] + matrix_value(b, a, c, r)) / 2;
            }
        m.column[column + 1] = at;
        m.right[column] = 1 + column % 3;
    }
    return m;
}

void matrix_free(Matrix *m) {
    void *arrays[] = {m->column, m->row, m->value, m->symmetric, m->right, m->x, m->node_column, m->node_row};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) free(arrays[i]);
}

static void amd_analyse(const Matrix *m) {
    int *order = take((size_t)m->nodes, sizeof *order);
    must(amd_order(m->nodes, m->node_column, m->node_row, order, NULL, NULL) >= AMD_OK, "AMD");
    free(order);
}

static void nothing(void) {}

static klu_common klu;
static klu_symbolic *klu_pattern;
static klu_numeric *klu_factors;

static void klu_end(void) {
    klu_free_numeric(&klu_factors, &klu);
    klu_free_symbolic(&klu_pattern, &klu);
}

static void klu_analyse_matrix(const Matrix *m) {
    klu_end();
    klu_defaults(&klu);
    klu_pattern = klu_analyze(m->rows, m->column, m->row, &klu);
    must(klu_pattern != NULL, "KLU");
}

/* The first factorization after an analysis also finds the pivots; those of further iterations do not. */
static void klu_factor_matrix(const Matrix *m) {
    if (klu_factors == NULL) klu_factors = klu_factor(m->column, m->row, m->value, klu_pattern, &klu);
    must(klu_factors != NULL && klu_refactor(m->column, m->row, m->value, klu_pattern, klu_factors, &klu), "KLU");
}

static void klu_solve_matrix(const Matrix *m) {
    memcpy(m->x, m->right, (size_t)m->rows * sizeof *m->x);
    must(klu_solve(klu_pattern, klu_factors, m->rows, 1, m->x, &klu), "KLU");
}

static void *umfpack_pattern, *umfpack_factors;
static double umfpack_control[UMFPACK_CONTROL];

static void umfpack_end(void) {
    if (umfpack_factors != NULL) umfpack_di_free_numeric(&umfpack_factors);
    if (umfpack_pattern != NULL) umfpack_di_free_symbolic(&umfpack_pattern);
}

static void umfpack_analyse(const Matrix *m) {
    umfpack_end();
    umfpack_di_defaults(umfpack_control);
    umfpack_control[UMFPACK_IRSTEP] = 0; /* the own solve has no refinement either */
    must(umfpack_di_symbolic(m->rows, m->rows, m->column, m->row, m->value, &umfpack_pattern, umfpack_control, NULL) ==
             UMFPACK_OK,
         "UMFPACK");
}

static void umfpack_factor(const Matrix *m) {
    if (umfpack_factors != NULL) umfpack_di_free_numeric(&umfpack_factors);
    must(umfpack_di_numeric(m->column, m->row, m->value, umfpack_pattern, &umfpack_factors, umfpack_control, NULL) ==
             UMFPACK_OK,
         "UMFPACK");
}

static void umfpack_solve(const Matrix *m) {
    must(umfpack_di_solve(UMFPACK_A, m->column, m->row, m->value, m->x, m->right, umfpack_factors, umfpack_control,
                          NULL) == UMFPACK_OK,
         "UMFPACK");
}

static cholmod_common cholmod;
static cholmod_factor *cholmod_factors;

static cholmod_sparse symmetric_part(const Matrix *m) {
    return (cholmod_sparse){.nrow = (size_t)m->rows,
                            .ncol = (size_t)m->rows,
                            .nzmax = (size_t)m->column[m->rows],
                            .p = m->column,
                            .i = m->row,
                            .x = m->symmetric,
                            .stype = -1,
                            .itype = CHOLMOD_INT,
                            .xtype = CHOLMOD_REAL,
                            .dtype = CHOLMOD_DOUBLE,
                            .sorted = 1,
                            .packed = 1};
}

static void cholmod_end(void) {
    if (cholmod_factors == NULL) return;
    cholmod_free_factor(&cholmod_factors, &cholmod);
    cholmod_finish(&cholmod);
}

static void cholmod_analyse_matrix(const Matrix *m) {
    cholmod_end();
    cholmod_start(&cholmod);
    cholmod.nmethods = 1;
    cholmod.method[0].ordering = CHOLMOD_AMD;
    cholmod_sparse a = symmetric_part(m);
    cholmod_factors = cholmod_analyze(&a, &cholmod);
    must(cholmod_factors != NULL, "CHOLMOD");
}

static void cholmod_factor_matrix(const Matrix *m) {
    cholmod_sparse a = symmetric_part(m);
    must(cholmod_factorize(&a, cholmod_factors, &cholmod), "CHOLMOD");
}

static void cholmod_solve_matrix(const Matrix *m) {
    cholmod_dense right = {.nrow = (size_t)m->rows,
                           .ncol = 1,
                           .nzmax = (size_t)m->rows,
                           .d = (size_t)m->rows,
                           .x = m->right,
                           .xtype = CHOLMOD_REAL,
                           .dtype = CHOLMOD_DOUBLE};
    cholmod_dense *x = cholmod_solve(CHOLMOD_A, cholmod_factors, &right, &cholmod);
    must(x != NULL, "CHOLMOD");
    memcpy(m->x, x->x, (size_t)m->rows * sizeof *m->x);
    cholmod_free_dense(&x, &cholmod);
}

const Rival rivals[RIVALS] = {
    {"AMD", amd_analyse, NULL, NULL, nothing},
    {"KLU", klu_analyse_matrix, klu_factor_matrix, klu_solve_matrix, klu_end},
    {"UMFPACK", umfpack_analyse, umfpack_factor, umfpack_solve, umfpack_end},
    {"CHOLMOD", cholmod_analyse_matrix, cholmod_factor_matrix, cholmod_solve_matrix, cholmod_end}};

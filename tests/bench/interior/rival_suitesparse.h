/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The direct solvers of SuiteSparse, on the same matrices. */
#pragma once
#include "methods/block_lu.h"

/* By compressed columns, with sorted rows. */
typedef struct Matrix {
    int rows, nodes;
    int *column, *row;           /* [rows + 1], [column[rows]] */
    double *value, *symmetric;   /* [column[rows]] the values, and those of the symmetric part */
    double *right;               /* [rows] */
    double *x;                   /* [rows] the last solution */
    int *node_column, *node_row; /* the graph of the nodes, for AMD */
} Matrix;

/* The matrix of one node for each 3 rows. Exits when memory is short. */
Matrix matrix_make(int nodes, const BlockEdge *edges, int edge_count);
void matrix_free(Matrix *matrix);

/* The block of rows of node a and columns of node b, element (r, c): rows are dominated by their diagonal. */
double matrix_value(int a, int b, int r, int c);

/* A part that a library does not have is NULL. Each does its work once more; end() frees. They exit on failure. */
typedef struct Rival {
    const char *name;
    void (*analyse)(const Matrix *matrix);
    void (*factor)(const Matrix *matrix); /* with the last analysis */
    void (*solve)(const Matrix *matrix);
    void (*end)(void);
} Rival;

enum { RIVALS = 4 };
extern const Rival rivals[RIVALS];

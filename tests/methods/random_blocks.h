/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Random matrices of 3 x 3 blocks, sparse and dense. */
#pragma once
#include "testing.h"

#include "engine/uniform.h"
#include "methods/interior_point_internal.h"

enum { NODES_MAX = 160, EDGES_MAX = 700, ROWS_MAX = 3 * NODES_MAX };

typedef struct RandomBlocks {
    int count, edge_count;
    BlockEdge edges[EDGES_MAX];
    Block3 diagonal[NODES_MAX], of_a[EDGES_MAX], of_b[EDGES_MAX]; /* of row a and column b, of row b and column a */
    double dense[ROWS_MAX][ROWS_MAX];
    double right[ROWS_MAX];
} RandomBlocks;

static inline double number(uint32_t *seed, float size) { return (double)uniform(seed, -size, size); }

static inline void add_dense(RandomBlocks *random, int row, int column, const Block3 *block) {
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) random->dense[3 * row + r][3 * column + c] += block->column[c][r];
}

/* Rows dominated by their diagonal. An edge occurs twice now and then, as pairs of three points do. */
static inline void make_blocks(RandomBlocks *random, uint32_t *seed, int count, float density) {
    memset(random, 0, sizeof *random);
    random->count = count;
    for (int a = 0; a < count; a++)
        for (int b = 0; b < count && random->edge_count + 2 < EDGES_MAX; b++) {
            if (a == b || uniform(seed, 0, 1) > density) continue;
            for (int copies = uniform(seed, 0, 1) < 0.1f ? 2 : 1; copies > 0; copies--)
                random->edges[random->edge_count++] = (BlockEdge){a, b};
        }
    for (int i = 0; i < count; i++) {
        for (int c = 0; c < 3; c++)
            for (int r = 0; r < 3; r++) random->diagonal[i].column[c][r] = number(seed, 1) + (r == c ? 60 : 0);
        for (int r = 0; r < 3; r++) random->right[3 * i + r] = number(seed, 1);
        add_dense(random, i, i, &random->diagonal[i]);
    }
    for (int e = 0; e < random->edge_count; e++) {
        for (int c = 0; c < 3; c++)
            for (int r = 0; r < 3; r++) {
                random->of_a[e].column[c][r] = number(seed, 1);
                random->of_b[e].column[c][r] = number(seed, 1);
            }
        add_dense(random, random->edges[e].a, random->edges[e].b, &random->of_a[e]);
        add_dense(random, random->edges[e].b, random->edges[e].a, &random->of_b[e]);
    }
}

/* Adds stiff times j j^T with the signs of a contact between nodes a and b. */
static inline void add_contact(RandomBlocks *random, int e, double stiff, const double j[3]) {
    const int a = random->edges[e].a, b = random->edges[e].b;
    for (int c = 0; c < 3; c++)
        for (int r = 0; r < 3; r++) {
            const double value = stiff * j[r] * j[c];
            random->diagonal[a].column[c][r] += value;
            random->diagonal[b].column[c][r] += value;
            random->of_a[e].column[c][r] -= value;
            random->of_b[e].column[c][r] -= value;
        }
}

/* A chain of unit masses with two contacts between neighbours, of stiffness 1 to 1e12. */
static inline void make_stiff_blocks(RandomBlocks *random, uint32_t *seed, int count) {
    memset(random, 0, sizeof *random);
    random->count = count;
    random->edge_count = count - 1;
    for (int i = 0; i < count; i++)
        for (int r = 0; r < 3; r++) {
            random->diagonal[i].column[r][r] = 1;
            random->right[3 * i + r] = number(seed, 1);
        }
    for (int e = 0; e < random->edge_count; e++) {
        random->edges[e] = (BlockEdge){e, e + 1};
        for (int k = 0; k < 4; k++) {
            const double j[3] = {number(seed, 1), number(seed, 1), number(seed, 1)};
            add_contact(random, e, pow(10, 6 + number(seed, 6)), j);
        }
    }
    for (int i = 0; i < count; i++) add_dense(random, i, i, &random->diagonal[i]);
    for (int e = 0; e < random->edge_count; e++) {
        add_dense(random, e, e + 1, &random->of_a[e]);
        add_dense(random, e + 1, e, &random->of_b[e]);
    }
}

/* Writes the blocks and the right-hand side; after the analysis. */
static inline void load_blocks(BlockLu *lu, const RandomBlocks *random, Vec4 *x) {
    memset(lu->blocks, 0, ((size_t)lu->count + 2 * (size_t)lu->below + 3) * sizeof *lu->blocks);
    for (int i = 0; i < random->count; i++) {
        const double *right = &random->right[3 * i];
        lu->blocks[lu->position[i]] = random->diagonal[i];
        x[lu->position[i]] = (Vec4){right[0], right[1], right[2], 0};
    }
    for (int e = 0; e < random->edge_count; e++)
        for (int c = 0; c < 3; c++) {
            lu->blocks[lu->places[e].row_a].column[c] += random->of_a[e].column[c];
            lu->blocks[lu->places[e].row_b].column[c] += random->of_b[e].column[c];
        }
}

/* Gaussian elimination with exchanges: x replaces random->right. */
static inline void solve_dense(RandomBlocks *random) {
    const int rows = 3 * random->count;
    for (int k = 0; k < rows; k++) {
        int best = k;
        for (int i = k + 1; i < rows; i++)
            if (fabs(random->dense[i][k]) > fabs(random->dense[best][k])) best = i;
        for (int j = 0; j < rows; j++) {
            const double keep = random->dense[k][j];
            random->dense[k][j] = random->dense[best][j];
            random->dense[best][j] = keep;
        }
        const double keep = random->right[k];
        random->right[k] = random->right[best];
        random->right[best] = keep;
        for (int i = k + 1; i < rows; i++) {
            const double by = random->dense[i][k] / random->dense[k][k];
            for (int j = k; j < rows; j++) random->dense[i][j] -= by * random->dense[k][j];
            random->right[i] -= by * random->right[k];
        }
    }
    for (int k = rows - 1; k >= 0; k--) {
        for (int j = k + 1; j < rows; j++) random->right[k] -= random->dense[k][j] * random->right[j];
        random->right[k] /= random->dense[k][k];
    }
}

/* The kernels that this processor supports. */
static inline int list_kernels(const InteriorKernels *list[2]) {
    list[0] = &interior_scalar;
    list[1] = interior_best();
    return list[1] != list[0] ? 2 : 1;
}

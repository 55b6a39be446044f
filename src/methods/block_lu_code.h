/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The numbers of contact graphs and of the factorization; included by interior_code.h and reference_code.h, which are
   compiled once for each instruction set. All perform the same operations in the same order, so they have the same
   bits. */
#include "methods/block_lu.h"
#include "methods/vec4.h"

#include <string.h>

/* The coordinates of a pair: linear velocity of body b minus that of body a, spin of b, spin of a. Turns an impulse in
   these into that on body a. */
static inline Vec4 as_body_a(Vec4 x) { return vec4(x[0], x[1], x[3], x[2]) * vec4(-1, -1, 1, 1); }

/* J_n x and J_t x of four contacts. */
typedef struct Relative {
    Vec4 normal, tangent;
} Relative;

static inline Relative relative(const BlockRows *rows, const BlockPair pairs[BLOCK_PAIRS], const Vec4 *x) {
    const Vec4 a = x[pairs[0].a], b = x[pairs[0].b], c = x[pairs[1].a], d = x[pairs[1].b], ab = b - a, cd = d - c;
    const Vec4 along_x = vec4(ab[0], ab[0], cd[0], cd[0]), along_y = vec4(ab[1], ab[1], cd[1], cd[1]);
    const Vec4 spin_a = vec4(a[2], a[2], c[2], c[2]), spin_b = vec4(b[2], b[2], d[2], d[2]);
    return (Relative){
        (rows->normal_x * along_x + rows->normal_y * along_y) + (rows->normal_b * spin_b + rows->normal_a * spin_a),
        (rows->normal_y * along_x - rows->normal_x * along_y) + (rows->tangent_b * spin_b + rows->tangent_a * spin_a)};
}

/* x += J^T impulses, of a group's pairs */
static inline void block_push(const BlockPair pairs[BLOCK_PAIRS], Vec4 normal, Vec4 tangent, Vec4 *x) {
    for (int half = 0, slot = 0; half < BLOCK_PAIRS; half++, slot += 2) {
        const BlockPair *pair = &pairs[half];
        const Vec4 force = (pair->normal[0] * normal[slot] + pair->tangent[0] * tangent[slot]) +
                           (pair->normal[1] * normal[slot + 1] + pair->tangent[1] * tangent[slot + 1]);
        x[pair->a] += as_body_a(force);
        x[pair->b] += force;
    }
}

/* The masses on the diagonal, and zeros elsewhere. */
static void begin_blocks(BlockGraph *graph) {
    BlockLu *lu = &graph->lu;
    for (int k = 0; k < lu->count; k++) {
        const Vec4 m = graph->masses[k];
        lu->blocks[k] = (Block3){{vec4(m[0], 0, 0, 0), vec4(0, m[1], 0, 0), vec4(0, 0, m[2], 0)}};
    }
    memset(lu->blocks + lu->count, 0, (2 * (size_t)lu->below + 3) * sizeof *lu->blocks);
}

/* Adds a matrix over the coordinates of a pair, given by columns, to the blocks of bodies a and b. */
static inline void block_add_pair(Block3 *blocks, int a, int b, BlockPlace place, const Vec4 columns[4]) {
    Block3 *aa = &blocks[a], *bb = &blocks[b];
    Block3 *ab = &blocks[place.row_a], *ba = &blocks[place.row_b];
    for (int c = 0; c < 2; c++) {
        const Vec4 of_a = as_body_a(columns[c]);
        bb->column[c] += columns[c];
        ba->column[c] -= columns[c];
        ab->column[c] += of_a;
        aa->column[c] -= of_a;
    }
    bb->column[2] += columns[2];
    ba->column[2] += columns[3];
    ab->column[2] += as_body_a(columns[2]);
    aa->column[2] += as_body_a(columns[3]);
}

/* A pair's J^T D J in its own coordinates, by columns: its contact k has D_n = dn[slot + k], D_t = dt[slot + k], and
   friction that follows the normal impulse by s[slot + k]. */
static inline void block_stiffness(const BlockPair *pair, int slot, Vec4 dn, Vec4 dt, Vec4 s, Vec4 columns[4]) {
    for (int c = 0; c < 4; c++) columns[c] = all4(0);
    for (int k = 0; k < 2; k++) {
        const Vec4 along = (pair->normal[k] + pair->tangent[k] * s[slot + k]) * dn[slot + k];
        const Vec4 across = pair->tangent[k] * dt[slot + k];
        const double *n = (const double *)&pair->normal[k], *t = (const double *)&pair->tangent[k];
        for (int c = 0; c < 4; c++) columns[c] += along * n[c] + across * t[c];
    }
}

/* block times the first three numbers of `by`. */
static inline Vec4 block_times(const Block3 *block, const Vec4 *by) {
    const double *x = (const double *)by;
    return block->column[0] * x[0] + block->column[1] * x[1] + block->column[2] * x[2];
}

/* *target -= left right */
static inline void block_subtract(Block3 *target, const Block3 *left, const Block3 *right) {
    for (int c = 0; c < 3; c++) target->column[c] -= block_times(left, &right->column[c]);
}

/* A pivot P = L U by elimination: L has ones on its diagonal. Stored are L^-1 below the diagonal and U^-1 on and above
   it, so a solution has no chain of dependent steps. Not the inverse of P: its rounding errors would grow with the
   square of the condition. The second and third diagonal of U are y1 / x0 and z2 / (x0 y1), so the three divisions do
   not wait for each other. */
static inline Block3 pivot_make(const Block3 *block) {
    const double *x = (const double *)&block->column[0], *y = (const double *)&block->column[1],
                 *z = (const double *)&block->column[2];
    const double y1 = x[0] * y[1] - x[1] * y[0], z1 = x[0] * z[1] - x[1] * z[0];
    const double y2 = x[0] * y[2] - x[2] * y[0], z2 = y1 * (x[0] * z[2] - x[2] * z[0]) - y2 * z1;
    const double over0 = 1 / x[0], over1 = 1 / y1, over2 = x[0] / z2;
    const double l10 = x[1] * over0, l20 = x[2] * over0, l21 = y2 * over1;
    const double u12 = -z1 * over2, u22 = y1 * over2, u02 = -(y[0] * u12 + z[0] * u22) * over0;
    return (Block3){
        {vec4(over0, -l10, l10 * l21 - l20, 0), vec4(-y[0] * over1, x[0] * over1, -l21, 0), vec4(u02, u12, u22, 0)}};
}

/* L^-1 x */
static inline Vec4 pivot_lower(const Block3 *pivot, Vec4 x) {
    const double *first = (const double *)&pivot->column[0], *second = (const double *)&pivot->column[1];
    return x + vec4(0, first[1], first[2], 0) * x[0] + vec4(0, 0, second[2], 0) * x[1];
}

/* U^-1 x */
static inline Vec4 pivot_upper(const Block3 *pivot, Vec4 x) {
    const double *first = (const double *)&pivot->column[0], *second = (const double *)&pivot->column[1];
    return vec4(first[0], 0, 0, 0) * x[0] + vec4(second[0], second[1], 0, 0) * x[1] + pivot->column[2] * x[2];
}

/* block U^-1 */
static inline Block3 over_pivot(const Block3 *block, const Block3 *pivot) {
    const double *first = (const double *)&pivot->column[0], *second = (const double *)&pivot->column[1],
                 *third = (const double *)&pivot->column[2];
    return (Block3){{block->column[0] * first[0], block->column[0] * second[0] + block->column[1] * second[1],
                     block->column[0] * third[0] + block->column[1] * third[1] + block->column[2] * third[2]}};
}

/* Subtracts from column j and row j what the columns before it contribute. */
static inline void block_lu_gather(BlockLu *lu, Block3 *lower, Block3 *upper, int j) {
    const int32_t *find = lu->find, *row = lu->row;
    for (int i = lu->row_start[j]; i < lu->row_start[j + 1]; i++) {
        const int right = lu->in_row[i].block, end = lu->in_row[i].end;
        block_subtract(&lu->blocks[j], &lower[right], &upper[right]);
        for (int left = right + 1; left < end; left++) {
            const int target = find[row[left]];
            block_subtract(&lower[target], &lower[left], &upper[right]);
            block_subtract(&upper[target], &lower[right], &upper[left]);
        }
    }
}

/* Replaces A by L and U with A = L U: L has ones on its diagonal. Column by column: all changes of a block follow each
   other, while it is in the cache. */
static void block_lu_factor(BlockLu *lu) {
    Block3 *diagonal = lu->blocks, *lower = block_lu_lower(lu), *upper = block_lu_upper(lu);
    for (int j = 0; j < lu->count; j++) {
        const int begin = lu->column[j], end = lu->column[j + 1];
        for (int x = begin; x < end; x++) lu->find[lu->row[x]] = x;
        block_lu_gather(lu, lower, upper, j);
        const Block3 pivot = diagonal[j] = pivot_make(&diagonal[j]);
        for (int x = begin; x < end; x++) {
            lower[x] = over_pivot(&lower[x], &pivot);
            for (int c = 0; c < 3; c++) upper[x].column[c] = pivot_lower(&pivot, upper[x].column[c]);
        }
    }
}

/* x[count], by position: on entry the right-hand side. After block_lu_factor(). */
static void block_lu_solve(const BlockLu *lu, Vec4 *x) {
    const Block3 *diagonal = lu->blocks, *lower = block_lu_lower(lu), *upper = block_lu_upper(lu);
    for (int k = 0; k < lu->count; k++) {
        const Vec4 mine = x[k] = pivot_lower(&diagonal[k], x[k]);
        for (int i = lu->column[k]; i < lu->column[k + 1]; i++) x[lu->row[i]] -= block_times(&lower[i], &mine);
    }
    for (int k = lu->count - 1; k >= 0; k--) {
        Vec4 rest = x[k];
        for (int i = lu->column[k]; i < lu->column[k + 1]; i++) rest -= block_times(&upper[i], &x[lu->row[i]]);
        x[k] = pivot_upper(&diagonal[k], rest);
    }
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "interior_training/interior_tape.h"

#include <assert.h>
#include <string.h>

/* Rows of one contact, by body. */
typedef struct Rows {
    double normal_a[3], normal_b[3], tangent_a[3], tangent_b[3];
} Rows;

static const InteriorPair *pair_of(const UnrolledInterior *u, int slot) { return &u->interior.pairs[slot / 2]; }

static int slots_of(const UnrolledInterior *u) { return GROUP_SLOTS * u->interior.group_count; }
static int body_numbers(const UnrolledInterior *u) { return 4 * (u->interior.lu.count + 1); }

static Rows rows_of(const InteriorPair *pair, int slot) {
    const Vec4 n = pair->normal[slot % 2], t = pair->tangent[slot % 2];
    return (Rows){{-n[0], -n[1], n[3]}, {n[0], n[1], n[2]}, {-t[0], -t[1], t[3]}, {t[0], t[1], t[2]}};
}

static double dot3(const double *x, const double *y) { return x[0] * y[0] + x[1] * y[1] + x[2] * y[2]; }
static void add3(double *x, const double *row, double by) {
    for (int c = 0; c < 3; c++) x[c] += row[c] * by;
}

/* x += J_n^T normal + J_t^T tangent; NULL: zeros. The position of bodies that do not move stays zero. */
static void push(const UnrolledInterior *u, const double *normal, const double *tangent, double *x) {
    assert(x != NULL);
    for (int i = 0; i < slots_of(u); i++) {
        const InteriorPair *pair = pair_of(u, i);
        const Rows rows = rows_of(pair, i);
        double *a = x + (ptrdiff_t)4 * pair->a, *b = x + (ptrdiff_t)4 * pair->b;
        if (normal != NULL) add3(a, rows.normal_a, normal[i]), add3(b, rows.normal_b, normal[i]);
        if (tangent != NULL) add3(a, rows.tangent_a, tangent[i]), add3(b, rows.tangent_b, tangent[i]);
    }
    memset(x + body_numbers(u) - 4, 0, 4 * sizeof *x);
}

static double along(const UnrolledInterior *u, int slot, bool tangent, const double *x) {
    const InteriorPair *pair = pair_of(u, slot);
    const Rows rows = rows_of(pair, slot);
    const double *a = x + (ptrdiff_t)4 * pair->a, *b = x + (ptrdiff_t)4 * pair->b;
    return tangent ? dot3(rows.tangent_a, a) + dot3(rows.tangent_b, b)
                   : dot3(rows.normal_a, a) + dot3(rows.normal_b, b);
}

/* block += left right^T */
static void add_outer(Block3 *block, const double *left, const double *right, double by) {
    for (int c = 0; c < 3; c++)
        for (int r = 0; r < 3; r++) block->column[c][r] += left[r] * right[c] * by;
}

/* The four blocks of a contact: by the rows `left` times those `right`. */
static void add_rows(BlockLu *lu, const InteriorPair *pair, const double *left_a, const double *left_b,
                     const double *right_a, const double *right_b, double by) {
    add_outer(&lu->blocks[pair->a], left_a, right_a, by);
    add_outer(&lu->blocks[pair->b], left_b, right_b, by);
    add_outer(&lu->blocks[pair->place.row_a], left_a, right_b, by);
    add_outer(&lu->blocks[pair->place.row_b], left_b, right_a, by);
}

static void factorize(UnrolledInterior *u, const double *dn, const double *dt, const double *s, bool transposed) {
    const Vec4 zero = {0};
    BlockLu *lu = &u->interior.lu;
    for (int i = 0; i < lu->count + 2 * lu->below + 3; i++) lu->blocks[i] = (Block3){{zero, zero, zero}};
    for (int k = 0; k < lu->count; k++)
        for (int c = 0; c < 3; c++) lu->blocks[k].column[c][c] = u->interior.masses[k][c];
    for (int i = 0; i < slots_of(u); i++) {
        const InteriorPair *pair = pair_of(u, i);
        const Rows r = rows_of(pair, i);
        add_rows(lu, pair, r.normal_a, r.normal_b, r.normal_a, r.normal_b, dn[i]);
        add_rows(lu, pair, r.tangent_a, r.tangent_b, r.tangent_a, r.tangent_b, dt[i]);
        if (transposed)
            add_rows(lu, pair, r.normal_a, r.normal_b, r.tangent_a, r.tangent_b, s[i] * dn[i]);
        else
            add_rows(lu, pair, r.tangent_a, r.tangent_b, r.normal_a, r.normal_b, s[i] * dn[i]);
    }
    interior_best()->factor(lu);
}

static void solve(const UnrolledInterior *u, double *x) {
    interior_best()->solve(&u->interior.lu, (Vec4 *)x);
    memset(x + body_numbers(u) - 4, 0, 4 * sizeof *x);
}

void interior_tape_forward(void *context, Tape *tape, const TapeNode *node) {
    UnrolledInterior *u = context;
    double *out = tape->values + node->at;
    const double *a = tape_values(tape, node->a);
    switch (node->operation) {
    case OWN_PUSH:
        memset(out, 0, (size_t)node->length * sizeof *out);
        push(u, a, tape_values(tape, node->b), out);
        break;
    case OWN_NORMAL:
    case OWN_TANGENT:
        for (int i = 0; i < node->length; i++) out[i] = along(u, i, node->operation == OWN_TANGENT, a);
        break;
    default:
        memcpy(out, a, (size_t)node->length * sizeof *out);
        solve(u, out);
        break;
    }
}

/* y* = A^-T x*, A* = -y* x^T, where x is the solution. */
static void solve_back(UnrolledInterior *u, Tape *tape, const TapeNode *node) {
    const int index = (int)tape_values(tape, node->b)[0];
    const struct UnrolledFactor *factor = &u->factors[index];
    const double *dn = tape_values(tape, factor->dn), *dt = tape_values(tape, factor->dt),
                 *s = tape_values(tape, factor->s), *x = tape->values + node->at;
    double *y = tape->slopes + node->at, *by_y = tape_slopes(tape, node->a);
    if (u->transposed != index) factorize(u, dn, dt, s, true);
    u->transposed = index;
    solve(u, y);
    for (int i = 0; i < node->length; i++) by_y[i] += y[i];
    double *by_dn = tape_slopes(tape, factor->dn), *by_dt = tape_slopes(tape, factor->dt),
           *by_s = tape_slopes(tape, factor->s);
    for (int i = 0; i < slots_of(u); i++) {
        const double yn = along(u, i, false, y), yt = along(u, i, true, y);
        const double xn = along(u, i, false, x), xt = along(u, i, true, x);
        by_dn[i] -= (yn + s[i] * yt) * xn;
        by_dt[i] -= yt * xt;
        by_s[i] -= yt * dn[i] * xn;
    }
}

void interior_tape_backward(void *context, Tape *tape, const TapeNode *node) {
    UnrolledInterior *u = context;
    const double *slope = tape->slopes + node->at;
    double *by_a = tape_slopes(tape, node->a);
    switch (node->operation) {
    case OWN_PUSH: {
        double *by_b = tape_slopes(tape, node->b);
        for (int i = 0; i < slots_of(u); i++) {
            by_a[i] += along(u, i, false, slope);
            by_b[i] += along(u, i, true, slope);
        }
        break;
    }
    case OWN_NORMAL: push(u, slope, NULL, by_a); break;
    case OWN_TANGENT: push(u, NULL, slope, by_a); break;
    default: solve_back(u, tape, node); break;
    }
}

TapeId interior_tape_push(UnrolledInterior *u, TapeId normal, TapeId tangent) {
    return tape_own(&u->tape, OWN_PUSH, normal, tangent, body_numbers(u));
}

TapeId interior_tape_normal(UnrolledInterior *u, TapeId x) {
    return tape_own(&u->tape, OWN_NORMAL, x, -1, slots_of(u));
}

TapeId interior_tape_tangent(UnrolledInterior *u, TapeId x) {
    return tape_own(&u->tape, OWN_TANGENT, x, -1, slots_of(u));
}

TapeId interior_tape_factor(UnrolledInterior *u, TapeId dn, TapeId dt, TapeId s) {
    const TapeId id = tape_number(&u->tape, u->factor_count);
    if (id < 0) return id;
    u->factors[u->factor_count++] = (struct UnrolledFactor){dn, dt, s};
    factorize(u, tape_values(&u->tape, dn), tape_values(&u->tape, dt), tape_values(&u->tape, s), false);
    return id;
}

TapeId interior_tape_solve(UnrolledInterior *u, TapeId factor, TapeId y) {
    return tape_own(&u->tape, OWN_SOLVE, y, factor, body_numbers(u));
}

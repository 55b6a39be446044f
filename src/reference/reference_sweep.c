/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A sweep of the reference, pair by pair: the scalar reference implementation. */
#include "reference/reference_units.h"

#include <math.h>

static double along_row(const ReferenceMomentum *body, const double row[3][REFERENCE_LANES], int lane) {
    return row[0][lane] * body->x + row[1][lane] * body->y + row[2][lane] * body->spin;
}

static void apply(ReferenceMomentum *body, const double row[3][REFERENCE_LANES], int lane, double impulse) {
    body->x += row[0][lane] * impulse;
    body->y += row[1][lane] * impulse;
    body->spin += row[2][lane] * impulse;
}

/* p = p' + beta d and d' = beta d - g. */
static double advance(double value, double step, double *direction, double beta) {
    double carried = beta * *direction;
    *direction = (carried + step + reference_floor) - reference_floor;
    return value + carried;
}

static void advance_momentum(ReferenceMomentum *now, ReferenceMomentum *before, ReferenceMomentum *direction,
                             double beta) {
    now->x = before->x = advance(now->x, now->x - before->x, &direction->x, beta);
    now->y = before->y = advance(now->y, now->y - before->y, &direction->y, beta);
    now->spin = before->spin = advance(now->spin, now->spin - before->spin, &direction->spin, beta);
}

static double sum_four(const double *x) { return (x[0] + x[1]) + (x[2] + x[3]); }

static double larger(double x, double y) { return x > y ? x : y; }

/* From a pair's impulses before the visit, and those that solve each row alone at the velocities before the visit: the
   impulses after it and their changes. */
static void solve_pair(const ReferenceGroup *group, int lane, const double *before, const double *wanted, double *sums,
                       double *steps) {
    double limit = 0;
    for (int row = 0, at = 0; row < REFERENCE_ROWS; row++) {
        double total = wanted[row];
        for (int earlier = 0; earlier < row; earlier++) total -= group->coupling[at++][lane] * steps[earlier];
        if (row % 2 == 0) {
            sums[row] = total > 0 ? total : 0;
            limit = group->friction[row / 2][lane] * sums[row];
        } else {
            total = total < limit ? total : limit;
            sums[row] = total > -limit ? total : -limit;
        }
        steps[row] = sums[row] - before[row];
    }
}

/* The pair in one lane of a group. */
static ReferenceSweep visit(Reference *r, int i, int lane, double beta) {
    const ReferenceGroup *group = &r->groups[i];
    ReferenceMomentum a = r->momenta[group->a[lane]], b = r->momenta[group->b[lane]];
    double before[REFERENCE_ROWS], wanted[REFERENCE_ROWS], sums[REFERENCE_ROWS], steps[REFERENCE_ROWS];
    double squares[REFERENCE_ROWS], products[REFERENCE_ROWS], change = 0;
    for (int k = 0; k < REFERENCE_ROWS; k++) {
        const ReferenceRow *row = &group->rows[k];
        before[k] =
            advance(r->sums_before[i].rows[k][lane], r->steps[i].rows[k][lane], &r->direction[i].rows[k][lane], beta);
        wanted[k] = (before[k] + row->target[lane]) - (along_row(&a, row->a, lane) + along_row(&b, row->b, lane));
    }
    solve_pair(group, lane, before, wanted, sums, steps);
    for (int k = 0; k < REFERENCE_ROWS; k++) {
        apply(&a, group->rows[k].a, lane, steps[k]);
        apply(&b, group->rows[k].b, lane, steps[k]);
        r->sums[i].rows[k][lane] = sums[k];
        r->steps[i].rows[k][lane] = steps[k];
        squares[k] = steps[k] * steps[k];
        products[k] = steps[k] * r->direction[i].rows[k][lane];
        change = larger(fabs(steps[k]) * group->rows[k].to_velocity[lane], change);
    }
    r->momenta[group->a[lane]] = a;
    r->momenta[group->b[lane]] = b;
    return (ReferenceSweep){sum_four(squares), sum_four(products), change};
}

ReferenceSweep reference_sweep_scalar(Reference *r, double beta) {
    for (int i = 0; i < r->body_count; i++)
        advance_momentum(&r->momenta[i], &r->momenta_before[i], &r->momenta_direction[i], beta);
    double squared[REFERENCE_LANES] = {0}, along[REFERENCE_LANES] = {0}, change = 0;
    for (int i = 0; i < r->group_count; i++) {
        for (int lane = 0; lane < REFERENCE_LANES && r->groups[i].contacts[0][lane] >= 0; lane++) {
            ReferenceSweep found = visit(r, i, lane, beta);
            squared[lane] += found.squared;
            along[lane] += found.along;
            change = larger(found.change, change);
        }
    }
    return (ReferenceSweep){sum_four(squared), sum_four(along), change};
}

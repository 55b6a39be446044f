/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A sweep of the reference, pair by pair: for every processor. */
#include "solvers/reference_units.h"

#include <math.h>

static double relative_velocity(const ReferenceMomentum *a, const ReferenceMomentum *b, const ReferenceRow *row,
                                int lane) {
    return (row->a[0][lane] * a->x + row->a[1][lane] * a->y + row->a[2][lane] * a->spin) +
           (row->b[0][lane] * b->x + row->b[1][lane] * b->y + row->b[2][lane] * b->spin);
}

static void apply(ReferenceMomentum *a, ReferenceMomentum *b, const ReferenceRow *row, int lane, double impulse) {
    a->x += row->a[0][lane] * impulse;
    a->y += row->a[1][lane] * impulse;
    a->spin += row->a[2][lane] * impulse;
    b->x += row->b[0][lane] * impulse;
    b->y += row->b[1][lane] * impulse;
    b->spin += row->b[2][lane] * impulse;
}

/* One contact, once. Returns by how much its two impulses change. */
static ReferenceImpulse solve_point(ReferenceMomentum *a, ReferenceMomentum *b, const ReferencePoint *point, int lane,
                                    ReferenceImpulse *sum) {
    ReferenceImpulse before = *sum, step;
    double total = before.normal + (point->normal.target[lane] - relative_velocity(a, b, &point->normal, lane));
    sum->normal = total > 0 ? total : 0;
    step.normal = sum->normal - before.normal;
    apply(a, b, &point->normal, lane, step.normal);

    double limit = point->friction[lane] * sum->normal;
    total = before.tangent + (point->tangent.target[lane] - relative_velocity(a, b, &point->tangent, lane));
    total = total < limit ? total : limit;
    sum->tangent = total > -limit ? total : -limit;
    step.tangent = sum->tangent - before.tangent;
    apply(a, b, &point->tangent, lane, step.tangent);
    return step;
}

/* p = p' + beta d and d' = beta d - g. */
static double go_on(double value, double step, double *direction, double beta) {
    double carried = beta * *direction;
    *direction = carried + step;
    return value + carried;
}

static void go_on_momentum(ReferenceMomentum *now, ReferenceMomentum *before, ReferenceMomentum *direction,
                           double beta) {
    now->x = before->x = go_on(now->x, now->x - before->x, &direction->x, beta);
    now->y = before->y = go_on(now->y, now->y - before->y, &direction->y, beta);
    now->spin = before->spin = go_on(now->spin, now->spin - before->spin, &direction->spin, beta);
}

static double larger(double x, double y) { return x > y ? x : y; }

/* One point of one pair in the workspace. */
static ReferenceSweep visit_point(Reference *r, int i, int k, int lane, ReferenceMomentum *a, ReferenceMomentum *b,
                                  double beta) {
    const ReferencePoint *point = &r->groups[i].points[k];
    ReferenceNumbers *before = &r->sums_before[i], *steps = &r->steps[i], *direction = &r->direction[i];
    double *normal = &direction->normal[k][lane], *tangent = &direction->tangent[k][lane];
    ReferenceImpulse sum = {go_on(before->normal[k][lane], steps->normal[k][lane], normal, beta),
                            go_on(before->tangent[k][lane], steps->tangent[k][lane], tangent, beta)};
    ReferenceImpulse step = solve_point(a, b, point, lane, &sum);
    r->sums[i].normal[k][lane] = sum.normal;
    r->sums[i].tangent[k][lane] = sum.tangent;
    steps->normal[k][lane] = step.normal;
    steps->tangent[k][lane] = step.tangent;
    return (ReferenceSweep){step.normal * step.normal + step.tangent * step.tangent,
                            step.normal * *normal + step.tangent * *tangent,
                            larger(fabs(step.normal) * point->normal.to_velocity[lane],
                                   fabs(step.tangent) * point->tangent.to_velocity[lane])};
}

static void visit(Reference *r, int i, int lane, double beta, ReferenceSweep *of_lane) {
    const ReferenceGroup *group = &r->groups[i];
    ReferenceMomentum a = r->momenta[group->a[lane]], b = r->momenta[group->b[lane]];
    ReferenceSweep first = visit_point(r, i, 0, lane, &a, &b, beta), second = visit_point(r, i, 1, lane, &a, &b, beta);
    r->momenta[group->a[lane]] = a;
    r->momenta[group->b[lane]] = b;
    of_lane->squared += first.squared + second.squared;
    of_lane->along += first.along + second.along;
    of_lane->change = larger(larger(first.change, second.change), of_lane->change);
}

ReferenceSweep reference_sweep_plain(Reference *r, double beta) {
    for (int i = 0; i < r->body_count; i++)
        go_on_momentum(&r->momenta[i], &r->momenta_before[i], &r->momenta_direction[i], beta);
    ReferenceSweep of[REFERENCE_LANES] = {{0, 0, 0}};
    for (int i = 0; i < r->group_count; i++)
        for (int lane = 0; lane < REFERENCE_LANES && r->groups[i].contacts[0][lane] >= 0; lane++)
            visit(r, i, lane, beta, &of[lane]);
    return (ReferenceSweep){(of[0].squared + of[1].squared) + (of[2].squared + of[3].squared),
                            (of[0].along + of[1].along) + (of[2].along + of[3].along),
                            larger(larger(of[0].change, of[1].change), larger(of[2].change, of[3].change))};
}

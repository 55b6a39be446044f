/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What kind of difference parts two runs, told from what they state: whatever made them. */
#include "base/base.h"
#include "runs/compare_runs.h"
#include "runs/trajectory.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Run 2 has the states of run 1 `frames` later, with all bits, in at least half of its frames, and something moves. */
static bool offset_by(const Trajectory *a, const Trajectory *b, int frames, int bodies) {
    const int first = frames > 0 ? 0 : -frames, end = a->frames < b->frames - frames ? a->frames : b->frames - frames;
    bool moves = false;
    if (2 * (end - first) < (a->frames < b->frames ? a->frames : b->frames)) return false;
    for (int frame = first; frame < end; frame++)
        for (int body = 0; body < bodies; body++) {
            if (!trajectory_same_states(a, frame, b, frame + frames, body)) return false;
            moves = moves || (frame > first && !trajectory_same_states(a, frame, a, frame - 1, body));
        }
    return moves;
}

static bool both_there(const Trajectory *a, const Trajectory *b, int frame, int body) {
    return trajectory_there(a, frame, body) && trajectory_there(b, frame, body);
}

static double number(const Trajectory *t, int frame, int body, int column) {
    return trajectory_number(t, trajectory_at(t, frame, body), column);
}

/* A column of run 2 is this many times that of run 1, in all states; 1: it is not a multiple. */
static double factor_of(const Trajectory *a, const Trajectory *b, int frames, int column) {
    static const double alike = 1e-6; /* relative: units are constants of some digits */
    double largest = 0, factor = 1;
    const int bodies = a->bodies < b->bodies ? a->bodies : b->bodies;
    for (int frame = 0; frame<frames; frame += frames> 1 ? frames - 1 : 1) /* the first and the last */
        for (int body = 0; body < bodies; body++) {
            if (!both_there(a, b, frame, body) || !(fabs(number(a, frame, body, column)) > largest)) continue;
            largest = fabs(number(a, frame, body, column));
            factor = number(b, frame, body, column) / number(a, frame, body, column);
        }
    if (!(fabs(factor - 1) > alike)) return 1;
    for (int frame = 0; frame < frames; frame++)
        for (int body = 0; body < bodies; body++)
            if (both_there(a, b, frame, body) &&
                !(fabs(number(b, frame, body, column) - factor * number(a, frame, body, column)) <=
                  alike * fabs(factor) * largest))
                return 1;
    return factor;
}

/* Other axes or units: each column is a multiple of the other run's, at least one of them by a factor. */
static bool put_factors(const Trajectory *a, const Trajectory *b, int frames, PartingKind *kind) {
    static const char *const columns[] = {"x", "y", "angle"};
    for (int column = 0; column < 3; column++) {
        const double factor = factor_of(a, b, frames, column);
        if (factor == 1) continue;
        const bool degrees = fabs(factor * acos(-1) / 180 - 1) < 1e-6;
        text_join(kind->text, sizeof kind->text, ", ", "%s ", columns[column]);
        if (fabs(factor + 1) < 1e-6)
            text_add(kind->text, sizeof kind->text, "mirrored");
        else if (degrees)
            text_add(kind->text, sizeof kind->text, "in degrees");
        else
            text_add(kind->text, sizeof kind->text, "times %.6g", factor);
    }
    return kind->text[0] != '\0';
}

/* The bodies moved farther in this step by one factor; 1: not. At least two bodies do. */
static double stretched(const Trajectory *a, const Trajectory *b, int frame, int bodies) {
    double least = INFINITY, most = -INFINITY;
    int count = 0;
    for (int body = 0; frame > 0 && body < bodies; body++) {
        if (!both_there(a, b, frame, body) || !trajectory_there(a, frame - 1, body)) continue;
        const double x = number(a, frame, body, 0) - number(a, frame - 1, body, 0),
                     y = number(a, frame, body, 1) - number(a, frame - 1, body, 1),
                     p = number(b, frame, body, 0) - number(b, frame - 1, body, 0),
                     q = number(b, frame, body, 1) - number(b, frame - 1, body, 1), way = x * x + y * y;
        if (way == 0 && p == 0 && q == 0) continue;
        const double factor = (x * p + y * q) / way;
        least = fmin(least, factor), most = fmax(most, factor);
        count++;
    }
    return count > 1 && most - least < 1e-3 * most ? (least + most) / 2 : 1; /* float32 near the ground has 3 digits */
}

PartingKind trajectory_part_kind(const Trajectory *a, const Trajectory *b, const TrajectoryParting *parting) {
    enum { ROUNDINGS = 8 }; /* units in the last place: a step takes fewer roundings of a coordinate */
    PartingKind kind = {""};
    const PartedBody *first = &parting->first;
    const int bodies = a->bodies > b->bodies ? a->bodies : b->bodies, frame = first->frame, body = first->body;
    if (frame < 0) return kind;
#define SAY(...) return snprintf(kind.text, sizeof kind.text, __VA_ARGS__), kind
    if (trajectory_different_steps(a, b)) SAY("a step: dt is %.9g and %.9g s", (double)a->dt, (double)b->dt);
    for (int frames = 1; frames <= parting->frames / 2; frames++)
        for (int sign = -1; sign <= 1; sign += 2)
            if (offset_by(a, b, sign * frames, bodies))
                SAY("frames: run 2 has the states of run 1 %d frame%s %s", frames, plural(frames),
                    sign > 0 ? "later" : "earlier");
    if (!first->by.in_a || !first->by.in_b) SAY("a body: run %d does not have it", first->by.in_a ? 2 : 1);
    if (a->no_poses || b->no_poses) SAY("a hash: poses are not known");
    for (int run = 0; run < 2; run++)
        for (int column = 0; column < 3; column++)
            if (!isfinite(number(run == 0 ? a : b, frame, body, column)))
                SAY("not finite: %g in run %d", number(run == 0 ? a : b, frame, body, column), run + 1);
    if (put_factors(a, b, parting->frames, &kind)) return kind;
    for (int i = 0; i < bodies && trajectory_has_masses(a) && trajectory_has_masses(b); i++)
        if (a->mass[i] != b->mass[i] && !a->fixed[i])
            SAY("a mass: body %d has %.9g and %.9g kg", i, (double)a->mass[i], (double)b->mass[i]);
    /* In units of the last place of the largest coordinate of a body, and at least of 1 m, rad, m/s or rad/s. */
    const double epsilon = trajectory_both_exact(a, b) ? DBL_EPSILON : (double)FLT_EPSILON, turn = 2 * acos(-1);
    const int columns = trajectory_both_move(a, b) ? STATE_COLUMNS : 3;
    double most = 0, places = 0, turned = 0;
    bool turns = true; /* only angles differ */
    for (int i = 0; i < bodies; i++)
        for (int column = 0; both_there(a, b, frame, i) && column < columns; column++) {
            const int other = column % 3 < 2 ? column - column % 3 + 1 - column % 3 : column; /* y of x */
            const double p = number(a, frame, i, column), q = number(b, frame, i, column);
            if (p == q) continue;
            const double scale = fmax(1, fmax(fabs(p), fabs(number(a, frame, i, other))));
            most = fmax(most, fabs(p - q));
            places = fmax(places, fabs(p - q) / (epsilon * exp2(floor(log2(scale)))));
            turns = turns && column == 2;
            turned = fmax(turned, fabs(remainder(p - q, turn)) / (epsilon * scale));
        }
    if (turns && most > 1 && turned <= ROUNDINGS)
        SAY("whole turns: angles by %.3g turn%s, the poses are the same", most / turn,
            plural(most > turn * 1.5 ? 2 : 1));
    if (most == 0)
        SAY("what numbers do not show: %s", trajectory_both_hashed(a, b) ? "hashes, or a sign of 0" : "a sign of 0");
    if (parting->contacts.reordered) SAY("an order: the contacts of step %d come in another one", parting->step);
    if (places <= ROUNDINGS)
        SAY("roundings: at most %g unit%s in the last place", ceil(places), plural((int)ceil(places)));
    const double factor = stretched(a, b, frame, bodies);
    if (fabs(factor - 1) > 1e-3)
        SAY("a step: every body moves %.4g times as far, as by another length or gravity", factor);
    SAY("motion: more than roundings, in %d bod%s", first->bodies, first->bodies == 1 ? "y" : "ies");
#undef SAY
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/divergence.h"
#include "cli/notes.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

static void print_runs(const char *const paths[2], const Trajectory *a, const Trajectory *b) {
    const Trajectory *const runs[] = {a, b};
    for (int i = 0; i < 2; i++)
        printf("run %d: %s by %s, %d frames of %d bodies (%s)\n", i + 1, runs[i]->scene, runs[i]->method,
               runs[i]->frames, runs[i]->bodies, paths[i]);
    if (a->scene_hash != b->scene_hash && a->scene_hash != 0 && b->scene_hash != 0)
        printf("different scenes: hashes %016" PRIx64 " and %016" PRIx64 "; this may be the cause\n", a->scene_hash,
               b->scene_hash);
    if (!trajectory_both_move(a, b)) printf("only poses are compared: a run has no velocities\n");
    if (a->frames != b->frames)
        printf("different lengths: only the first %d frames are compared\n",
               a->frames < b->frames ? a->frames : b->frames);
}

static void print_body(const Trajectory *a, const PartedBody *parted, bool poses_only) {
    const StateDifference *by = &parted->by;
    printf("frame %d, body %d%s: ", parted->frame, parted->body, parted->body == a->bomb ? " (the bomb)" : "");
    if (by->in_a && by->in_b) printf("%.3g m apart, %.3g rad", by->distance, by->angle);
    if (by->in_a && by->in_b && !poses_only) printf(", %.3g m/s, %.3g rad/s", by->speed, by->spin);
    if (!by->in_a || !by->in_b) printf("only in run %d", by->in_a ? 1 : 2);
    if (parted->bodies > 1) printf("; %d bodies in all", parted->bodies);
    printf("\n");
}

/* The first contact that only one run has, or the one whose impulses differ most. */
static void print_contact(const ContactDifference *contacts) {
    bool only = contacts->only_a + contacts->only_b > 0;
    if (!only && contacts->changed == 0) return;
    const TrajectoryContact *a = only ? &contacts->only : &contacts->largest_a, *b = &contacts->largest_b;
    printf("  contact of bodies %d and %d, feature %08" PRIx32 ", at (%.4g, %.4g) m: ", (int)a->a, (int)a->b,
           a->feature, (double)a->point.x, (double)a->point.y);
    if (only)
        printf("only in run %d\n  normal %.9g N s, tangent %.9g N s\n", contacts->only_first_a ? 1 : 2,
               (double)a->normal_impulse, (double)a->tangent_impulse);
    else
        printf("different impulses\n  normal %.9g and %.9g N s, tangent %.9g and %.9g N s\n", (double)a->normal_impulse,
               (double)b->normal_impulse, (double)a->tangent_impulse, (double)b->tangent_impulse);
}

static void print_hidden(const TrajectoryParting *parting) {
    const ContactDifference *contacts = &parting->contacts;
    printf("contacts of step %d differ: %d in impulse, %d in position, %d in one run only\n", parting->step,
           contacts->changed, contacts->moved, contacts->only_a + contacts->only_b);
}

/* Steps and states before the first frame that differs. */
static void print_cause(const TrajectoryParting *parting) {
    const ContactDifference *contacts = &parting->contacts;
    int frame = parting->first.frame;
    switch (parting->cause) {
    case PART_NONE: return;
    case PART_START: printf("cause: the initial state\n"); return;
    case PART_LAUNCH: printf("cause: the launch\n  all states of frame %d are equal\n", frame - 1); return;
    case PART_HIDDEN:
        printf("cause: the warm start, which no state shows\n  all states of frame %d are equal, but ", frame - 1);
        print_hidden(parting);
        break;
    case PART_CONTACTS:
        printf("cause: collision detection\n  all states of frame %d are equal, but of the contacts of step %d, %d are "
               "only in run 1, %d only in run 2, and %d have another position\n",
               frame - 1, frame, contacts->only_a, contacts->only_b, contacts->moved);
        break;
    case PART_SOLVER:
        printf("cause: the solver\n  all states of frame %d are equal, and so are the %d contacts of step %d, but the "
               "impulses of %d differ\n",
               frame - 1, contacts->count_a, frame, contacts->changed);
        break;
    case PART_ELSEWHERE:
        printf(
            "cause: not the contacts\n  all states of frame %d are equal, and so are the %d contacts of step %d with "
            "their impulses:\n  the bodies were moved differently (another kind of step, or another scene)\n",
            frame - 1, contacts->count_a, frame);
        return;
    case PART_UNKNOWN:
        printf("cause: unknown, as a run has no contacts\n  all states of frame %d are equal\n", frame - 1);
        return;
    }
    print_contact(contacts);
}

static void print_beyond(const Trajectory *a, const TrajectoryParting *parting, double tolerance) {
    if (parting->beyond.frame < 0) {
        printf("centres at most %g m apart: %d frames of %d bodies\n", tolerance, parting->frames, a->bodies);
        return;
    }
    printf("centres more than %g m apart: ", tolerance);
    print_body(a, &parting->beyond, parting->poses_only);
    if (parting->beyond.frame == 0) return;
    if (parting->beyond.frame == parting->first.frame)
        printf("  all states before that step are equal: the cause above\n");
    else
        printf("  the states before that step differ since frame %d: an earlier step is the cause\n",
               parting->first.frame);
    print_contact(&parting->beyond_contacts);
}

static void print_parting(const Trajectory *a, const TrajectoryParting *parting, double tolerance) {
    if (parting->first.frame < 0) {
        printf("equal: %d frames of %d bodies, every bit of pose%s\n", parting->frames, a->bodies,
               parting->poses_only ? "" : " and velocity");
        if (parting->step >= 0) {
            printf("the states do not show it, but ");
            print_hidden(parting);
            print_contact(&parting->contacts);
        }
        return;
    }
    printf("first difference: ");
    print_body(a, &parting->first, parting->poses_only);
    print_cause(parting);
    if (tolerance > 0) print_beyond(a, parting, tolerance);
}

static void print_rate(const Growth *growth, double dt) {
    if (growth->count == 0) {
        printf("%s\n", growth->saturated ? "above 0.1 m at once" : "there are no frames with a distance");
        return;
    }
    printf("from %.2g m in frame %d to %.2g m in frame %d%s", growth->from, growth->first, growth->to, growth->last,
           growth->saturated ? ", then above 0.1 m" : "");
    if (growth->count < GROWTH_MIN_FRAMES) {
        printf("\n  too few frames for a rate: %d of at least %d\n", growth->count, GROWTH_MIN_FRAMES);
        return;
    }
    double doubling = growth_doubling(growth, dt);
    printf("\n  %.3g / s, ", growth->rate);
    if (isfinite(doubling))
        printf("%s every %.3g frames", doubling > 0 ? "doubles" : "halves", fabs(doubling));
    else
        printf("constant");
    printf("; scatter: a factor of %.2g\n", exp(growth->scatter));
}

static void print_growth(const Growth *growth, double dt) {
    printf("growth of the largest distance: ");
    print_rate(growth, dt);
}

static void print_chaos(const Chaos *chaos, const Growth *growth, const Growth *shifted, double dt) {
    static const char *const verdicts[] = {
        [GROWTH_UNKNOWN] = "unknown, one of the two has no rate",
        [GROWTH_NEITHER] = "neither distance doubles in these frames",
        [GROWTH_SAME] = "chaos: grows as fast as a tiny shift",
        [GROWTH_FASTER] = "grows faster than a tiny shift",
        [GROWTH_SLOWER] = "grows more slowly than a tiny shift",
    };
    if (chaos->rerun_differs >= 0)
        printf(
            "note: running the scene again gives another run 1 from frame %d on: another network, or another program\n",
            chaos->rerun_differs);
    printf("shifted run (body %d shifted by %.2g m, the same frames): ", chaos->body, chaos->shift);
    print_rate(shifted, dt);
    printf("verdict: %s\n", verdicts[growth_compare(growth, shifted, dt)]);
}

void diverge_print(const Divergence *d) {
    const Trajectory *a = d->runs[0], *b = d->runs[1];
    print_runs(d->paths, a, b);
    print_parting(a, &d->parting, d->tolerance);
    if (d->parting.first.frame < 0) return;
    print_growth(&d->growth, (double)a->dt);
    if (d->chaos.distance != NULL)
        print_chaos(&d->chaos, &d->growth, &d->shifted, (double)a->dt);
    else if (note_level() > NOTES_QUIET)
        printf("shifted run: give --scene SCENE to measure how a shift of 1e-6 m grows\n");
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where two trajectories differ, and why they part. */
#include "base/base.h"
#include "runs/trajectory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void describe_first(const Trajectory *a, const Trajectory *b, int frame, int body, TrajectoryDifference *d) {
    d->frame = frame;
    d->body = body;
    StateDifference state = trajectory_state_difference(a, b, frame, body);
    if (!state.in_a || !state.in_b)
        snprintf(d->what, sizeof d->what, "body %d exists in frame %d of the %s only", body, frame,
                 state.in_a ? "first" : "second");
    d->distance = state.distance;
    d->angle = state.angle;
    d->speed = state.speed;
}

void trajectory_compare(const Trajectory *a, const Trajectory *b, TrajectoryDifference *d) {
    *d = (TrajectoryDifference){.frame = -1, .body = -1, .max_frame = -1, .max_body = -1, .rollout_mse = NAN};
    d->poses_only = !trajectory_both_move(a, b);
    if (trajectory_different_worlds(a, b, d->what, sizeof d->what)) return;
    int frames = a->frames < b->frames ? a->frames : b->frames;
    int64_t count = 0;
    double squares = 0;
    for (int frame = 0; frame < frames; frame++) {
        for (int body = 0; body < a->bodies; body++) {
            count += !a->fixed[body] && trajectory_has(a, frame, body) && trajectory_has(b, frame, body);
            if (trajectory_same_state(a, b, frame, body)) continue;
            if (d->frame < 0) describe_first(a, b, frame, body, d);
            double apart = trajectory_state_difference(a, b, frame, body).distance;
            if (!a->fixed[body]) squares += apart * apart;
            if (!(apart > d->max_distance)) continue;
            d->max_distance = apart;
            d->max_frame = frame;
            d->max_body = body;
        }
    }
    if (d->frame < 0 && a->frames != b->frames)
        snprintf(d->what, sizeof d->what, "frames: %d and %d", a->frames, b->frames);
    d->equal = d->frame < 0 && d->what[0] == '\0';
    d->rollout_mse = squares / (2 * (double)count);
}

double trajectory_distance(const Trajectory *a, const Trajectory *b, int frame) {
    int bodies = a->bodies < b->bodies ? a->bodies : b->bodies;
    double largest = 0;
    for (int body = 0; body < bodies; body++)
        largest = fmax(largest, trajectory_state_difference(a, b, frame, body).distance);
    return largest;
}

/* Compared as bytes below. */
_Static_assert(sizeof(TrajectoryContact) == 36, "no padding");

/* The contacts of a step, in order. */
typedef struct ContactList {
    int count;
    const TrajectoryContact **items;
} ContactList;

static int order_keys(const TrajectoryContact *x, const TrajectoryContact *y) {
    if (x->a != y->a) return x->a < y->a ? -1 : 1;
    if (x->b != y->b) return x->b < y->b ? -1 : 1;
    return (x->feature > y->feature) - (x->feature < y->feature);
}

/* Contacts with equal keys, which an untrusted file may hold, keep the order of the file. */
static int order_contacts(const void *left, const void *right) {
    const TrajectoryContact *x = *(const TrajectoryContact *const *)left;
    const TrajectoryContact *y = *(const TrajectoryContact *const *)right;
    int order = order_keys(x, y);
    return order != 0 ? order : (x > y) - (x < y);
}

static bool list_contacts(const Trajectory *t, int step, int body, ContactList *list, Error *error) {
    const TrajectoryContact *first = t->contacts + t->contact_start[step];
    size_t count = (size_t)(t->contact_start[step + 1] - t->contact_start[step]);
    *list = (ContactList){0, malloc((count + 1) * sizeof *list->items)};
    if (list->items == NULL) return error_memory(error, "contacts");
    for (size_t i = 0; i < count; i++)
        if (body < 0 || first[i].a == body || first[i].b == body) list->items[list->count++] = &first[i];
    qsort(list->items, (size_t)list->count, sizeof *list->items, order_contacts);
    return true;
}

/* (N s)^2 */
static double impulse_distance(const TrajectoryContact *a, const TrajectoryContact *b) {
    double normal = (double)a->normal_impulse - b->normal_impulse;
    double tangent = (double)a->tangent_impulse - b->tangent_impulse;
    return normal * normal + tangent * tangent;
}

static void add_both(ContactDifference *d, const TrajectoryContact *a, const TrajectoryContact *b) {
    d->moved +=
        memcmp(&a->point, &b->point, sizeof a->point) != 0 || memcmp(&a->normal, &b->normal, sizeof a->normal) != 0;
    if (memcmp(&a->normal_impulse, &b->normal_impulse, sizeof(float)) == 0 &&
        memcmp(&a->tangent_impulse, &b->tangent_impulse, sizeof(float)) == 0)
        return;
    if (d->changed++ > 0 && !(impulse_distance(a, b) > impulse_distance(&d->largest_a, &d->largest_b))) return;
    d->largest_a = *a;
    d->largest_b = *b;
}

static void add_only(ContactDifference *d, const TrajectoryContact *only, int *count) {
    if (d->only_a + d->only_b == 0) {
        d->only = *only;
        d->only_first_a = count == &d->only_a;
    }
    (*count)++;
}

static void compare_runs_merge(const ContactList *a, const ContactList *b, ContactDifference *d) {
    for (int i = 0, k = 0; i < a->count || k < b->count;) {
        int order = i == a->count ? 1 : k == b->count ? -1 : order_keys(a->items[i], b->items[k]);
        if (order == 0) add_both(d, a->items[i], b->items[k]);
        if (order < 0) add_only(d, a->items[i], &d->only_a);
        if (order > 0) add_only(d, b->items[k], &d->only_b);
        i += order <= 0;
        k += order >= 0;
    }
}

/* Most steps, without sorting. */
static bool same_bytes(const Trajectory *a, const Trajectory *b, int step) {
    int64_t count = a->contact_start[step + 1] - a->contact_start[step];
    return count == b->contact_start[step + 1] - b->contact_start[step] &&
           (count == 0 || memcmp(a->contacts + a->contact_start[step], b->contacts + b->contact_start[step],
                                 (size_t)count * sizeof *a->contacts) == 0);
}

bool contact_difference(const Trajectory *a, const Trajectory *b, int step, int body, ContactDifference *difference,
                        Error *error) {
    *difference = (ContactDifference){0};
    if (body < 0 && same_bytes(a, b, step)) {
        difference->count_a = (int)(a->contact_start[step + 1] - a->contact_start[step]);
        return true;
    }
    ContactList of_a, of_b = {0, NULL};
    bool ok = list_contacts(a, step, body, &of_a, error) && list_contacts(b, step, body, &of_b, error);
    if (ok) {
        difference->count_a = of_a.count;
        compare_runs_merge(&of_a, &of_b, difference);
    }
    free(of_a.items);
    free(of_b.items);
    return ok;
}

static bool contacts_differ(const ContactDifference *d) { return d->only_a + d->only_b + d->moved + d->changed > 0; }

static bool apart(const Trajectory *a, const Trajectory *b, int frame, int body, const PoseTolerance *tolerance) {
    const double turn = 2 * acos(-1);
    if (trajectory_same_state(a, b, frame, body)) return false;
    if (!tolerance->given) return true;
    StateDifference by = trajectory_state_difference(a, b, frame, body);
    return !by.in_a || !by.in_b || by.distance > tolerance->distance ||
           fabs(remainder(by.angle, turn)) > tolerance->angle;
}

static void count_frames(const Trajectory *a, const Trajectory *b, const PoseTolerance *tolerance,
                         TrajectoryParting *parting) {
    static const PoseTolerance exact = {0};
    for (int frame = 0; frame < parting->frames; frame++) {
        bool equal = true, within = true;
        for (int body = 0; body < a->bodies && within; body++) {
            equal = equal && !apart(a, b, frame, body, &exact);
            within = equal || !apart(a, b, frame, body, tolerance);
        }
        parting->equal += equal;
        parting->within += within && !equal;
    }
}

/* The first frame from `frame` on in which a body differs. */
static PartedBody find_parted(const Trajectory *a, const Trajectory *b, int frame, int frames,
                              const PoseTolerance *tolerance) {
    PartedBody parted = {.frame = -1, .body = -1};
    for (; parted.frame < 0 && frame < frames; frame++)
        for (int body = 0; body < a->bodies; body++) {
            if (!apart(a, b, frame, body, tolerance) || parted.bodies++ > 0) continue;
            parted.frame = frame;
            parted.body = body;
            parted.by = trajectory_state_difference(a, b, frame, body);
        }
    return parted;
}

/* The first step up to `last` with a contact that differs. */
static bool find_step(const Trajectory *a, const Trajectory *b, int last, TrajectoryParting *parting, Error *error) {
    parting->step = -1;
    for (int step = 1; parting->step < 0 && step <= last; step++) {
        if (!contact_difference(a, b, step, -1, &parting->contacts, error)) return false;
        if (contacts_differ(&parting->contacts)) parting->step = step;
    }
    return true;
}

/* True if every body that differs has just been added. The previous frames are equal, so one run suffices. */
static bool only_launched(const Trajectory *a, const Trajectory *b, int frame) {
    for (int body = 0; body < a->bodies; body++)
        if (trajectory_has(a, frame - 1, body) && !trajectory_same_state(a, b, frame, body)) return false;
    return true;
}

static PartCause find_cause(const Trajectory *a, const Trajectory *b, const TrajectoryParting *parting) {
    int frame = parting->first.frame;
    const ContactDifference *contacts = &parting->contacts;
    if (frame < 0) return PART_NONE;
    if (frame == 0) return PART_START;
    if (only_launched(a, b, frame)) return PART_LAUNCH;
    if (a->no_contacts || b->no_contacts) return PART_UNKNOWN;
    if (parting->step >= 0 && parting->step < frame) return PART_HIDDEN;
    if (parting->step < 0) return parting->no_impulses && parting->contacts.count_a > 0 ? PART_UNKNOWN : PART_ELSEWHERE;
    return contacts->only_a + contacts->only_b + contacts->moved > 0 ? PART_CONTACTS : PART_SOLVER;
}

bool trajectory_part(const Trajectory *a, const Trajectory *b, const PoseTolerance *tolerance,
                     TrajectoryParting *parting, Error *error) {
    int frames = a->frames < b->frames ? a->frames : b->frames;
    *parting = (TrajectoryParting){
        .frames = frames, .poses_only = !trajectory_both_move(a, b), .no_impulses = a->no_impulses || b->no_impulses};
    parting->first = find_parted(a, b, 0, frames, &(PoseTolerance){0});
    parting->beyond = parting->first;
    count_frames(a, b, tolerance, parting);
    if (tolerance->given && parting->first.frame >= 0)
        parting->beyond = find_parted(a, b, parting->first.frame, frames, tolerance);
    int last = parting->first.frame >= 0 ? parting->first.frame : frames - 1;
    bool contacts = !a->no_contacts && !b->no_contacts;
    parting->step = -1;
    if (contacts && !find_step(a, b, last, parting, error)) return false;
    /* Contacts of the body, which the cause depends on. */
    if (contacts && parting->no_impulses && parting->step < 0 && parting->first.frame > 0 &&
        !contact_difference(a, b, parting->first.frame, parting->first.body, &parting->contacts, error))
        return false;
    parting->cause = find_cause(a, b, parting);
    const PartedBody *beyond = &parting->beyond;
    return beyond->frame < 1 || !contacts ||
           contact_difference(a, b, beyond->frame, beyond->body, &parting->beyond_contacts, error);
}

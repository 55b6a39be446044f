/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where two trajectories differ, and why they part. */
#include "base/base.h"
#include "methods/methods.h"
#include "runs/compare_runs.h"
#include "runs/trajectory.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

bool trajectory_both_hashed(const Trajectory *a, const Trajectory *b) { return a->hash != NULL && b->hash != NULL; }

bool trajectory_both_exact(const Trajectory *a, const Trajectory *b) { return a->exact != NULL && b->exact != NULL; }

bool trajectory_both_move(const Trajectory *a, const Trajectory *b) { return !a->no_velocities && !b->no_velocities; }

/* Which columns both runs have. */
static int columns_of(const Trajectory *a, const Trajectory *b) {
    return a->no_poses || b->no_poses ? 0 : trajectory_both_move(a, b) ? STATE_COLUMNS : 3;
}

/* A state in the narrower of the two types of numbers: a float32 is compared with what a float64 rounds to. */
static void take_state(const Trajectory *t, size_t i, bool exact, double state[STATE_COLUMNS]) {
    const Vec2 p = t->position[i], v = t->velocity[i];
    const double rounded[STATE_COLUMNS] = {p.x, p.y, t->angle[i], v.x, v.y, t->angular_velocity[i]};
    for (int column = 0; column < STATE_COLUMNS; column++)
        state[column] = exact ? trajectory_number(t, i, column) : rounded[column];
}

bool trajectory_same_states(const Trajectory *a, int of_a, const Trajectory *b, int of_b, int body) {
    const bool in_a = trajectory_there(a, of_a, body), in_b = trajectory_there(b, of_b, body);
    if (!in_a || !in_b) return in_a == in_b;
    if (trajectory_both_hashed(a, b) && a->hash[trajectory_at(a, of_a, body)] != b->hash[trajectory_at(b, of_b, body)])
        return false;
    const int columns = columns_of(a, b);
    if (columns == 0) return true;
    const bool exact = trajectory_both_exact(a, b);
    double x[STATE_COLUMNS], y[STATE_COLUMNS];
    take_state(a, trajectory_at(a, of_a, body), exact, x);
    take_state(b, trajectory_at(b, of_b, body), exact, y);
    return memcmp(x, y, (size_t)columns * sizeof *x) == 0;
}

StateDifference trajectory_state_difference(const Trajectory *a, const Trajectory *b, int frame, int body) {
    StateDifference d = {.in_a = trajectory_there(a, frame, body), .in_b = trajectory_there(b, frame, body)};
    const int columns = columns_of(a, b);
    if (!d.in_a || !d.in_b || columns == 0) return d;
    double x[STATE_COLUMNS], y[STATE_COLUMNS], by[STATE_COLUMNS] = {0};
    take_state(a, trajectory_at(a, frame, body), trajectory_both_exact(a, b), x);
    take_state(b, trajectory_at(b, frame, body), trajectory_both_exact(a, b), y);
    for (int column = 0; column < columns; column++) by[column] = x[column] - y[column];
    d.distance = sqrt(by[0] * by[0] + by[1] * by[1]);
    d.angle = fabs(by[2]);
    d.speed = sqrt(by[3] * by[3] + by[4] * by[4]);
    d.spin = fabs(by[5]);
    return d;
}

bool trajectory_different_bodies(const Trajectory *a, const Trajectory *b, char *what, size_t size) {
    const bool traces = a->there != NULL || b->there != NULL; /* which may lack bodies, sizes and dt */
    if (!traces && a->bodies != b->bodies) return snprintf(what, size, "bodies: %d and %d", a->bodies, b->bodies) > 0;
    for (int body = 0; body < a->bodies && body < b->bodies; body++) {
        Vec2 p = a->size[body], q = b->size[body];
        if (memcmp(&p, &q, sizeof p) != 0 && p.x > 0 && q.x > 0)
            return snprintf(what, size, "size of body %d: %.9g x %.9g and %.9g x %.9g m", body, (double)p.x,
                            (double)p.y, (double)q.x, (double)q.y) > 0;
        if (a->fixed[body] != b->fixed[body] && !a->fixed_guessed && !b->fixed_guessed)
            return snprintf(what, size, "body %d: %s and %s", body, a->fixed[body] ? "static" : "dynamic",
                            b->fixed[body] ? "static" : "dynamic") > 0;
    }
    if ((a->no_poses && b->hash == NULL) || (b->no_poses && a->hash == NULL))
        return snprintf(what, size, "run %d has hashes only, and run %d has none", a->no_poses ? 1 : 2,
                        a->no_poses ? 2 : 1) > 0;
    return false;
}

bool trajectory_different_steps(const Trajectory *a, const Trajectory *b) {
    return a->dt > 0 && b->dt > 0 && memcmp(&a->dt, &b->dt, sizeof a->dt) != 0;
}

bool trajectory_different_worlds(const Trajectory *a, const Trajectory *b, char *what, size_t size) {
    return trajectory_different_bodies(a, b, what, size) ||
           (trajectory_different_steps(a, b) &&
            snprintf(what, size, "dt: %.9g and %.9g s", (double)a->dt, (double)b->dt) > 0);
}

ComparedText trajectory_compared(const Trajectory *a, const Trajectory *b) {
    ComparedText words = {""};
    const bool poses = !a->no_poses && !b->no_poses;
    if (trajectory_both_hashed(a, b))
        text_add(words.text, sizeof words.text, "the hash of every state%s", poses ? ", and " : "");
    if (poses)
        text_add(words.text, sizeof words.text, "every bit of float%d poses%s", trajectory_both_exact(a, b) ? 64 : 32,
                 trajectory_both_move(a, b) ? " and velocities" : "");
    return words;
}

/* Bodies that at least one of the two has. */
static int most_bodies(const Trajectory *a, const Trajectory *b) {
    return a->bodies > b->bodies ? a->bodies : b->bodies;
}

/* Whether all states of a frame are the same bytes: then they are equal, without a look at each. */
static bool same_bytes(const Trajectory *a, const Trajectory *b, int frame) {
    const size_t i = trajectory_at(a, frame, 0), count = (size_t)a->bodies;
    const int columns = columns_of(a, b);
    if (a->bodies != b->bodies || !trajectory_both_exact(a, b) || columns == 0 ||
        (a->there == NULL) != (b->there == NULL) ||
        (a->there != NULL && memcmp(a->there + i, b->there + i, count) != 0) ||
        (trajectory_both_hashed(a, b) && memcmp(a->hash + i, b->hash + i, count * sizeof *a->hash) != 0))
        return false;
    for (int column = 0; column < columns; column += column % 3 == 0 ? 2 : 1)
        if (memcmp(a->exact + trajectory_exact_at(a, i, column), b->exact + trajectory_exact_at(b, i, column),
                   (column % 3 == 0 ? 2 : 1) * count * sizeof *a->exact) != 0)
            return false;
    return true;
}

void trajectory_compare(const Trajectory *a, const Trajectory *b, TrajectoryDifference *d) {
    *d = (TrajectoryDifference){.frame = -1, .body = -1, .max_frame = -1, .max_body = -1, .rollout_mse = NAN};
    d->poses_only = !trajectory_both_move(a, b);
    if (trajectory_different_worlds(a, b, d->what, sizeof d->what)) return;
    int frames = a->frames < b->frames ? a->frames : b->frames;
    int64_t count = 0;
    double squares = 0;
    for (int frame = 0; frame < frames; frame++) {
        const bool same = same_bytes(a, b, frame);
        for (int body = 0; body < most_bodies(a, b); body++) {
            const bool both = trajectory_there(a, frame, body) && trajectory_there(b, frame, body);
            const bool fixed = both && a->fixed[body] && b->fixed[body];
            count += !fixed && both;
            if (same || trajectory_same_states(a, frame, b, frame, body)) continue;
            const StateDifference state = trajectory_state_difference(a, b, frame, body);
            if (d->frame < 0) { /* the first */
                d->frame = frame;
                d->body = body;
                d->distance = state.distance;
                d->angle = state.angle;
                d->speed = state.speed;
                if (!state.in_a || !state.in_b)
                    snprintf(d->what, sizeof d->what, "body %d exists in frame %d of the %s only", body, frame,
                             state.in_a ? "first" : "second");
            }
            if (!fixed && isfinite(state.distance)) squares += state.distance * state.distance;
            if (!(state.distance > d->max_distance)) continue;
            d->max_distance = state.distance;
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
    double largest = 0;
    const int bodies = same_bytes(a, b, frame) ? 0 : most_bodies(a, b);
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

static void add_only(ContactDifference *d, const TrajectoryContact *only, int *count) {
    assert(only != NULL);
    if (d->only_a + d->only_b == 0) {
        d->only = *only;
        d->only_first_a = count == &d->only_a;
    }
    (*count)++;
}

/* Compares the contacts of a body (-1: all), in the order of bodies a, b and feature. */
static bool contact_difference(const Trajectory *a, const Trajectory *b, int step, int body, ContactDifference *d,
                               Error *error) {
    *d = (ContactDifference){0};
    const int64_t count = a->contact_start[step + 1] - a->contact_start[step];
    if (body < 0 && count == b->contact_start[step + 1] - b->contact_start[step] &&
        (count == 0 || memcmp(a->contacts + a->contact_start[step], b->contacts + b->contact_start[step],
                              (size_t)count * sizeof *a->contacts) == 0)) { /* most steps, without sorting */
        d->count_a = (int)count;
        return true;
    }
    ContactList of_a, of_b = {0, NULL};
    const bool ok = list_contacts(a, step, body, &of_a, error) && list_contacts(b, step, body, &of_b, error);
    if (ok) d->count_a = of_a.count;
    for (int i = 0, k = 0; ok && (i < of_a.count || k < of_b.count);) {
        const TrajectoryContact *x = i < of_a.count ? of_a.items[i] : NULL, *y = k < of_b.count ? of_b.items[k] : NULL;
        const int order = x == NULL ? 1 : y == NULL ? -1 : order_keys(x, y);
        i += order <= 0;
        k += order >= 0;
        if (order != 0) {
            add_only(d, order < 0 ? x : y, order < 0 ? &d->only_a : &d->only_b);
            continue;
        }
        d->reordered =
            d->reordered || x - (a->contacts + a->contact_start[step]) != y - (b->contacts + b->contact_start[step]);
        d->moved +=
            memcmp(&x->point, &y->point, sizeof x->point) != 0 || memcmp(&x->normal, &y->normal, sizeof x->normal) != 0;
        if (memcmp(&x->normal_impulse, &y->normal_impulse, sizeof(float)) == 0 &&
            memcmp(&x->tangent_impulse, &y->tangent_impulse, sizeof(float)) == 0)
            continue;
        if (d->changed++ > 0 && !(impulse_distance(x, y) > impulse_distance(&d->largest_a, &d->largest_b))) continue;
        d->largest_a = *x;
        d->largest_b = *y;
    }
    d->reordered = d->reordered && d->only_a + d->only_b == 0;
    free(of_a.items);
    free(of_b.items);
    return ok;
}

int trajectory_reference(const Trajectory *const *runs, int count) {
    int reference = -1;
    char what[256];
    for (int i = count - 1; i >= 0; i--) {
        const MethodDescription *method = method_describe(runs[i]->method);
        if (method != NULL && method->role == METHOD_REFERENCE) reference = i;
    }
    for (int i = 0; i < count && reference >= 0; i++)
        if (trajectory_different_worlds(runs[reference], runs[i], what, sizeof what)) return -1;
    return count > 1 ? reference : -1;
}

/* The place of a contact in a step of another run, -1: nowhere. The order of contacts changes little. */
static int64_t find_contact(const Trajectory *run, int step, const TrajectoryContact *like, int64_t from) {
    const int64_t first = run->contact_start[step], count = run->contact_start[step + 1] - first;
    for (int64_t k = 0; k < count; k++) {
        const int64_t at = first + (from + k) % count;
        if (order_keys(&run->contacts[at], like) == 0) return at;
    }
    return -1;
}

bool trajectory_same_mode(const Trajectory *a, int step_a, int64_t contact, const Trajectory *b, int step_b) {
    const int64_t other = find_contact(b, step_b, &a->contacts[contact], contact - a->contact_start[step_a]);
    return trajectory_mode(a, step_a, contact) == (other < 0 ? CONTACT_OPEN : trajectory_mode(b, step_b, other));
}

ModeCount trajectory_same_modes(const Trajectory *a, int step_a, const Trajectory *b, int step_b) {
    ModeCount count = {0, 0};
    for (int64_t i = a->contact_start[step_a]; i < a->contact_start[step_a + 1]; i++, count.of++)
        count.same += trajectory_same_mode(a, step_a, i, b, step_b);
    for (int64_t i = b->contact_start[step_b]; i < b->contact_start[step_b + 1]; i++) {
        if (find_contact(a, step_a, &b->contacts[i], i - b->contact_start[step_b]) >= 0) continue;
        count.of++;
        count.same += trajectory_mode(b, step_b, i) == CONTACT_OPEN;
    }
    return count;
}

/* NaN is within no tolerance, nor is a hash. */
static bool is_near(const Trajectory *a, const Trajectory *b, const StateDifference *by,
                    const PoseTolerance *tolerance) {
    return tolerance->given && by->in_a && by->in_b && !a->no_poses && !b->no_poses &&
           by->distance <= tolerance->distance && fabs(remainder(by->angle, 2 * acos(-1))) <= tolerance->angle;
}

static void note(PartedBody *parted, int frame, int body, const StateDifference *by) {
    if (parted->frame < 0) *parted = (PartedBody){frame, body, 0, *by};
    parted->bodies += parted->frame == frame;
}

/* Sets the first differences, in any bit and beyond the tolerance, and counts frames. */
static void find_parted(const Trajectory *a, const Trajectory *b, const PoseTolerance *tolerance,
                        TrajectoryParting *parting) {
    parting->first = parting->beyond = (PartedBody){.frame = -1, .body = -1};
    for (int frame = 0; frame < parting->frames; frame++) {
        bool equal = true, within = true;
        const int bodies = same_bytes(a, b, frame) ? 0 : most_bodies(a, b);
        for (int body = 0; body < bodies; body++) {
            if (trajectory_same_states(a, frame, b, frame, body)) continue;
            const StateDifference by = trajectory_state_difference(a, b, frame, body);
            equal = false;
            note(&parting->first, frame, body, &by);
            if (is_near(a, b, &by, tolerance)) continue;
            within = false;
            note(&parting->beyond, frame, body, &by);
        }
        parting->equal += equal;
        parting->within += within && !equal;
    }
}

static PartCause find_cause(const Trajectory *a, const Trajectory *b, const TrajectoryParting *parting) {
    const int frame = parting->first.frame;
    const ContactDifference *contacts = &parting->contacts;
    if (frame < 0) return PART_NONE;
    if (frame == 0) return PART_START;
    /* Every body that differs has just been added. The previous frames are equal, so one run suffices. */
    bool launched = true;
    for (int body = 0; launched && body < most_bodies(a, b); body++)
        launched = !trajectory_there(a, frame - 1, body) || trajectory_same_states(a, frame, b, frame, body);
    if (launched) return PART_LAUNCH;
    if (a->no_contacts || b->no_contacts) return PART_UNKNOWN;
    if (parting->step < 0) return parting->no_impulses && parting->contacts.count_a > 0 ? PART_UNKNOWN : PART_ELSEWHERE;
    if (contacts->only_a + contacts->only_b + contacts->moved > 0) return PART_CONTACTS;
    return parting->step < frame ? PART_HIDDEN : PART_SOLVER;
}

bool trajectory_part(const Trajectory *a, const Trajectory *b, const PoseTolerance *tolerance,
                     TrajectoryParting *parting, Error *error) {
    int frames = a->frames < b->frames ? a->frames : b->frames;
    *parting = (TrajectoryParting){.frames = frames,
                                   .poses_only = !trajectory_both_move(a, b),
                                   .no_contacts = a->no_contacts || b->no_contacts,
                                   .no_impulses = a->no_impulses || b->no_impulses};
    find_parted(a, b, tolerance, parting);
    int last = parting->first.frame >= 0 ? parting->first.frame : frames - 1;
    bool contacts = !a->no_contacts && !b->no_contacts;
    parting->step = -1;
    for (int step = 1; contacts && parting->step < 0 && step <= last; step++) {
        const ContactDifference *found = &parting->contacts;
        if (!contact_difference(a, b, step, -1, &parting->contacts, error)) return false;
        if (found->only_a + found->only_b + found->moved + found->changed > 0) parting->step = step;
    }
    /* Contacts of the body, which the cause depends on. */
    if (contacts && parting->no_impulses && parting->step < 0 && parting->first.frame > 0 &&
        !contact_difference(a, b, parting->first.frame, parting->first.body, &parting->contacts, error))
        return false;
    parting->cause = find_cause(a, b, parting);
    const PartedBody *beyond = &parting->beyond;
    return beyond->frame < 1 || !contacts ||
           contact_difference(a, b, beyond->frame, beyond->body, &parting->beyond_contacts, error);
}

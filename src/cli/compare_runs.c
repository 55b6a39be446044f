/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How twinbox compare compares two runs: why and how fast they diverge, as text and as JSON. */
#include "base/base.h"
#include "base/json.h"
#include "cli/cli.h"
#include "cli/runs.h"
#include "runs/runs.h"
#include "runs/trajectory.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

typedef struct Comparison {
    const CompareOptions *options;
    Trajectory *runs[2];
    TrajectoryDifference difference;
    bool same_world; /* or what follows is not known: */
    TrajectoryParting parting;
    double *distance; /* [frames of both] */
    Growth growth, shifted;
    Chaos chaos; /* distance NULL: no scene given */
} Comparison;

static bool same_length(const Comparison *c) { return c->runs[0]->frames == c->runs[1]->frames; }

static bool passed(const Comparison *c) {
    return c->same_world && c->parting.beyond.frame < 0 && (same_length(c) || c->options->diverge);
}

static void write_run(JsonWriter *json, const char *key, const char *path, const Trajectory *run) {
    json_begin_object(json, key, JSON_ONE_LINE);
    json_put_text(json, "path", path);
    json_put_text(json, "scene", run->scene);
    json_put_hash(json, "scene_hash", run->scene_hash);
    json_put_text(json, "method", run->method);
    json_put_int(json, "frames", run->frames);
    json_put_int(json, "bodies", run->bodies);
    json_end(json);
}

/* The number of a frame; negative: no frame. */
static void put_frame(JsonWriter *json, const char *key, int frame) {
    if (!json_put_absent(json, key, frame < 0)) json_put_int(json, key, frame);
}

/* The only run that has it. */
static void write_only_in(JsonWriter *json, bool in_first, bool in_second) {
    put_frame(json, "only_in_run", in_first && in_second ? -1 : in_first ? 1 : 2);
}

static void write_parted(JsonWriter *json, const char *key, const Comparison *c, const PartedBody *parted) {
    const Trajectory *a = c->runs[0];
    if (json_put_absent(json, key, parted->frame < 0)) return;
    const bool both = parted->by.in_a && parted->by.in_b, moves = both && !c->parting.poses_only;
    json_begin_object(json, key, JSON_ONE_LINE);
    json_put_int(json, "frame", parted->frame);
    json_put_int(json, "body", parted->body);
    json_put_bool(json, "bomb", parted->body == a->bomb);
    json_put_int(json, "bodies", parted->bodies);
    write_only_in(json, parted->by.in_a, parted->by.in_b);
    json_put_number(json, "distance", both ? parted->by.distance : NAN);
    json_put_number(json, "angle", both ? parted->by.angle : NAN);
    json_put_number(json, "speed", moves ? parted->by.speed : NAN);
    json_put_number(json, "spin", moves ? parted->by.spin : NAN);
    json_end(json);
}

static void write_contact(JsonWriter *json, const ContactDifference *contacts) {
    const bool only = contacts->only_a + contacts->only_b > 0;
    if (json_put_absent(json, "contact", !only && contacts->changed == 0)) return;
    const TrajectoryContact *a = only ? &contacts->only : &contacts->largest_a;
    const TrajectoryContact *b = only ? &contacts->only : &contacts->largest_b;
    const bool in_first = !only || contacts->only_first_a, in_second = !only || !contacts->only_first_a;
    json_begin_object(json, "contact", JSON_ONE_LINE);
    json_put_int(json, "a", a->a);
    json_put_int(json, "b", a->b);
    json_put_int(json, "feature", a->feature);
    json_output_pair(json, "point", (double)a->point.x, (double)a->point.y);
    write_only_in(json, in_first, in_second);
    json_output_pair(json, "normal_impulse", in_first ? (double)a->normal_impulse : 0,
                     in_second ? (double)b->normal_impulse : 0);
    json_output_pair(json, "tangent_impulse", in_first ? (double)a->tangent_impulse : 0,
                     in_second ? (double)b->tangent_impulse : 0);
    json_end(json);
}

static void write_contacts(JsonWriter *json, const char *key, int step, const ContactDifference *contacts) {
    if (json_put_absent(json, key, step < 0)) return;
    json_begin_object(json, key, JSON_ONE_LINE);
    json_put_int(json, "step", step);
    json_put_int(json, "changed", contacts->changed);
    json_put_int(json, "moved", contacts->moved);
    json_put_int(json, "only_in_run_1", contacts->only_a);
    json_put_int(json, "only_in_run_2", contacts->only_b);
    write_contact(json, contacts);
    json_end(json);
}

static void write_growth(JsonWriter *json, const char *key, const Growth *growth, double dt) {
    const bool rate = growth->count >= GROWTH_MIN_FRAMES;
    json_begin_object(json, key, JSON_ONE_LINE);
    put_frame(json, "first", growth->first);
    put_frame(json, "last", growth->last);
    json_put_int(json, "count", growth->count);
    json_put_bool(json, "saturated", growth->saturated);
    json_put_number(json, "from", growth->count > 0 ? growth->from : NAN);
    json_put_number(json, "to", growth->count > 0 ? growth->to : NAN);
    json_put_number(json, "rate", rate ? growth->rate : NAN);
    json_put_number(json, "doubling_frames", rate ? growth_doubling(growth, dt) : NAN);
    json_put_number(json, "scatter_factor", rate ? exp(growth->scatter) : NAN);
    json_end(json);
}

static void write_chaos(JsonWriter *json, const Comparison *c, double dt) {
    static const char *const verdicts[] = {[GROWTH_UNKNOWN] = "unknown",
                                           [GROWTH_NEITHER] = "neither doubles",
                                           [GROWTH_SAME] = "chaos",
                                           [GROWTH_FASTER] = "faster",
                                           [GROWTH_SLOWER] = "slower"};
    json_begin_object(json, "shifted", JSON_LINES);
    json_put_int(json, "body", c->chaos.body);
    json_put_number(json, "shift", c->chaos.shift);
    put_frame(json, "rerun_differs", c->chaos.rerun_differs);
    write_growth(json, "growth", &c->shifted, dt);
    json_put_text(json, "verdict", verdicts[growth_compare(&c->growth, &c->shifted, dt)]);
    json_end(json);
}

static void write_largest(JsonWriter *json, const TrajectoryDifference *difference) {
    if (json_put_absent(json, "largest", difference->max_frame < 0)) return;
    json_begin_object(json, "largest", JSON_ONE_LINE);
    json_put_int(json, "frame", difference->max_frame);
    json_put_int(json, "body", difference->max_body);
    json_put_number(json, "distance", difference->max_distance);
    json_end(json);
}

static void write_comparison(JsonWriter *json, const void *context) {
    static const char *const keys[] = {"expected", "actual"};
    static const char *const causes[] = {[PART_NONE] = "none",
                                         [PART_START] = "initial state",
                                         [PART_LAUNCH] = "launch",
                                         [PART_HIDDEN] = "warm start",
                                         [PART_CONTACTS] = "collision detection",
                                         [PART_SOLVER] = "solver",
                                         [PART_ELSEWHERE] = "not the contacts",
                                         [PART_UNKNOWN] = "unknown"};
    const Comparison *c = context;
    const TrajectoryParting *parting = &c->parting;
    const Trajectory *a = c->runs[0];
    const bool differ = parting->first.frame >= 0, contacts = !a->no_contacts && !c->runs[1]->no_contacts,
               beyond = contacts && c->options->distance > 0 && parting->beyond.frame > 0;
    for (int i = 0; i < 2; i++) write_run(json, keys[i], c->options->paths[i], c->runs[i]);
    json_put_bool(json, "passed", passed(c));
    json_put_text(json, "words", c->difference.what[0] != '\0' ? c->difference.what : NULL);
    json_put_int(json, "frames", parting->frames);
    json_put_number(json, "tolerance", c->options->distance);
    json_put_bool(json, "poses_only", c->difference.poses_only);
    write_parted(json, "first", c, &parting->first);
    write_largest(json, &c->difference);
    json_put_text(json, "cause", c->same_world ? causes[parting->cause] : NULL);
    write_contacts(json, "contacts", parting->step, &parting->contacts);
    write_parted(json, "beyond", c, &parting->beyond);
    write_contacts(json, "beyond_contacts", beyond ? parting->beyond.frame : -1, &parting->beyond_contacts);
    if (!json_put_absent(json, "growth", !differ)) write_growth(json, "growth", &c->growth, (double)a->dt);
    if (!json_put_absent(json, "shifted", !differ || c->chaos.distance == NULL)) write_chaos(json, c, (double)a->dt);
}

static void print_runs(const char *const paths[2], const Trajectory *a, const Trajectory *b) {
    const Trajectory *const runs[] = {a, b};
    for (int i = 0; i < 2; i++)
        printf("run %d: %s by %s, %d frames of %d bodies (%s)\n", i + 1, runs[i]->scene, runs[i]->method,
               runs[i]->frames, runs[i]->bodies, paths[i]);
    if (a->scene_hash != b->scene_hash && a->scene_hash != 0 && b->scene_hash != 0)
        printf("different scenes: hashes %016" PRIx64 " and %016" PRIx64 "; this may be the cause\n", a->scene_hash,
               b->scene_hash);
    if (!trajectory_both_move(a, b)) printf("only poses are compared: a run has no velocities\n");
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

static void print_parting(const Comparison *c) {
    const Trajectory *a = c->runs[0];
    const TrajectoryParting *parting = &c->parting;
    if (!same_length(c))
        printf("different lengths, %d and %d frames: only the first %d are compared\n", a->frames, c->runs[1]->frames,
               parting->frames);
    if (parting->first.frame < 0) {
        printf("equal%s: %d frames of %d bodies, every bit of pose%s\n", same_length(c) ? "" : " as far as both go",
               parting->frames, a->bodies, parting->poses_only ? "" : " and velocity");
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
    if (c->options->distance > 0) print_beyond(a, parting, c->options->distance);
    if (c->difference.max_frame >= 0)
        printf("largest distance: frame %d, body %d: %.3g m apart\n", c->difference.max_frame, c->difference.max_body,
               c->difference.max_distance);
    else /* a turn by 2 pi, or 0 and -0 */
        printf("largest distance: none, every position is the same\n");
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

static void print(const Comparison *c) {
    const Trajectory *a = c->runs[0];
    print_runs(c->options->paths, a, c->runs[1]);
    if (!c->same_world) {
        printf("%s\n", c->difference.what);
        return;
    }
    print_parting(c);
    if (c->parting.first.frame < 0) return;
    printf("growth of the largest distance: ");
    print_rate(&c->growth, (double)a->dt);
    if (c->chaos.distance != NULL)
        print_chaos(&c->chaos, &c->growth, &c->shifted, (double)a->dt);
    else if (a->scene_hash != 0)
        note_print("with --scene SCENE, the growth is compared with that of a shift of 1e-6 m");
}

static bool measure(Comparison *c, Error *error) {
    int frames = c->parting.frames;
    c->distance = malloc((size_t)frames * sizeof *c->distance);
    if (c->distance == NULL) return error_memory(error, "compare");
    for (int frame = 0; frame < frames; frame++)
        c->distance[frame] = trajectory_distance(c->runs[0], c->runs[1], frame);
    /* compare_runs() frees c->distance. NOLINTNEXTLINE(clang-analyzer-unix.Malloc) */
    return growth_measure(c->distance, 0, frames, (double)c->runs[0]->dt, &c->growth, error);
}

/* Over the same frames as the growth of the two runs. */
static bool measure_chaos(Comparison *c, const char *scene, Error *error) {
    int body = chaos_body(c->runs[0], c->parting.first.body, c->parting.first.frame);
    if (body < 0) return error_input(error, scene, "has no body that can move, so none can be shifted");
    bool ok =
        chaos_run(&c->chaos, scene, c->runs[0], body, c->parting.frames, progress_bar_begin(c->runs[0]->scene), error);
    progress_bar_end();
    return ok && growth_measure(c->chaos.distance, c->growth.first, c->growth.end, (double)c->runs[0]->dt, &c->shifted,
                                error);
}

/* Runs of different worlds differ, but no distance of theirs means anything. */
static bool check_worlds(Comparison *c, Error *error) {
    const CompareOptions *options = c->options;
    c->parting = (TrajectoryParting){.first = {.frame = -1}, .beyond = {.frame = -1}, .step = -1};
    c->same_world = !trajectory_different_worlds(c->runs[0], c->runs[1], c->difference.what, sizeof c->difference.what);
    return c->same_world || (!options->diverge && options->scene == NULL && options->csv == NULL) ||
           error_input(error, options->paths[1], "cannot be compared with %s: %s", options->paths[0],
                       c->difference.what);
}

static bool find(Comparison *c, Error *error) {
    const CompareOptions *options = c->options;
    for (int i = 0; i < 2; i++)
        if ((c->runs[i] = trajectory_read(options->paths[i], error)) == NULL) return false;
    trajectory_compare(c->runs[0], c->runs[1], &c->difference);
    if (!check_worlds(c, error)) return false;
    if (!c->same_world) return true;
    if (!trajectory_part(c->runs[0], c->runs[1], options->distance, &c->parting, error) || !measure(c, error) ||
        (options->scene != NULL && !measure_chaos(c, options->scene, error)))
        return false;
    const DistanceTable table = {c->parting.frames, (double)c->runs[0]->dt, c->distance, c->chaos.distance};
    return options->csv == NULL || distance_table_write(&table, options->csv, error);
}

bool compare_runs(const CompareOptions *options, Error *error) {
    Comparison comparison = {.options = options};
    bool ok = find(&comparison, error);
    if (ok && options->json)
        ok = json_output("twinbox compare runs 1", write_comparison, &comparison, error);
    else if (ok)
        print(&comparison);
    ok = ok && passed(&comparison);
    chaos_free(&comparison.chaos);
    free(comparison.distance);
    for (int i = 0; i < 2; i++) trajectory_destroy(comparison.runs[i]);
    return ok;
}

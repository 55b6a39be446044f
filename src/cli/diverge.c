/* SPDX-License-Identifier: GPL-3.0-or-later */
/* twinbox diverge: its result, both forms of it, the command. */
#include "base/base.h"
#include "base/json.h"
#include "cli/cli.h"
#include "cli/options.h"
#include "runs/runs.h"
#include "runs/trajectory.h"
#include "scenes/scenes.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct Divergence {
    const char *const *paths; /* [2] */
    double tolerance;         /* m */
    Trajectory *runs[2];
    TrajectoryParting parting;
    double *distance; /* [frames of both] */
    Growth growth, shifted;
    Chaos chaos; /* distance NULL: no scene given */
} Divergence;

static void write_run(JsonWriter *json, const char *path, const Trajectory *run) {
    json_begin_object(json, NULL, JSON_ONE_LINE);
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
    if (frame >= 0)
        json_put_int(json, key, frame);
    else
        json_put_text(json, key, NULL);
}

/* The only run that has it. */
static void write_only_in(JsonWriter *json, bool in_first, bool in_second) {
    put_frame(json, "only_in_run", in_first && in_second ? -1 : in_first ? 1 : 2);
}

static void write_parted(JsonWriter *json, const char *key, const Divergence *d, const PartedBody *parted) {
    const Trajectory *a = d->runs[0];
    if (parted->frame < 0) {
        json_put_text(json, key, NULL);
        return;
    }
    const bool both = parted->by.in_a && parted->by.in_b, moves = both && !d->parting.poses_only;
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
    if (!only && contacts->changed == 0) {
        json_put_text(json, "contact", NULL);
        return;
    }
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
    if (step < 0) {
        json_put_text(json, key, NULL);
        return;
    }
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

static void write_chaos(JsonWriter *json, const Divergence *d, double dt) {
    static const char *const verdicts[] = {[GROWTH_UNKNOWN] = "unknown",
                                           [GROWTH_NEITHER] = "neither doubles",
                                           [GROWTH_SAME] = "chaos",
                                           [GROWTH_FASTER] = "faster",
                                           [GROWTH_SLOWER] = "slower"};
    json_begin_object(json, "shifted", JSON_LINES);
    json_put_int(json, "body", d->chaos.body);
    json_put_number(json, "shift", d->chaos.shift);
    put_frame(json, "rerun_differs", d->chaos.rerun_differs);
    write_growth(json, "growth", &d->shifted, dt);
    json_put_text(json, "verdict", verdicts[growth_compare(&d->growth, &d->shifted, dt)]);
    json_end(json);
}

static void write_divergence(JsonWriter *json, const void *context) {
    static const char *const causes[] = {[PART_NONE] = "none",
                                         [PART_START] = "initial state",
                                         [PART_LAUNCH] = "launch",
                                         [PART_HIDDEN] = "warm start",
                                         [PART_CONTACTS] = "collision detection",
                                         [PART_SOLVER] = "solver",
                                         [PART_ELSEWHERE] = "not the contacts",
                                         [PART_UNKNOWN] = "unknown"};
    const Divergence *d = context;
    const TrajectoryParting *parting = &d->parting;
    const Trajectory *a = d->runs[0];
    const bool differ = parting->first.frame >= 0, contacts = !a->no_contacts && !d->runs[1]->no_contacts,
               beyond = contacts && d->tolerance > 0 && parting->beyond.frame > 0;
    json_begin_array(json, "runs", JSON_LINES);
    for (int i = 0; i < 2; i++) write_run(json, d->paths[i], d->runs[i]);
    json_end(json);
    json_put_int(json, "frames", parting->frames);
    json_put_number(json, "tolerance", d->tolerance);
    json_put_bool(json, "poses_only", parting->poses_only);
    json_put_bool(json, "diverge", parting->beyond.frame >= 0);
    write_parted(json, "first", d, &parting->first);
    json_put_text(json, "cause", causes[parting->cause]);
    write_contacts(json, "contacts", parting->step, &parting->contacts);
    write_parted(json, "beyond", d, &parting->beyond);
    write_contacts(json, "beyond_contacts", beyond ? parting->beyond.frame : -1, &parting->beyond_contacts);
    if (differ)
        write_growth(json, "growth", &d->growth, (double)a->dt);
    else
        json_put_text(json, "growth", NULL);
    if (differ && d->chaos.distance != NULL)
        write_chaos(json, d, (double)a->dt);
    else
        json_put_text(json, "shifted", NULL);
}

static bool diverge_print_json(const Divergence *divergence, Error *error) {
    return json_output("twinbox diverge 1", write_divergence, divergence, error);
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

static void diverge_print(const Divergence *d) {
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

typedef struct Options {
    const char *paths[2];
    int count;
    double tolerance; /* m */
    const char *scene, *csv;
    bool json;
} Options;

static const Option option_table[] = {
    {"--tolerance", 0, "M",
     "Runs diverge where the centres of a body are more than M metres apart (default: 0, any bit of pose or "
     "velocity)",
     OPTION_DOUBLE(Options, tolerance, 0, (double)FLT_MAX)},
    {"--scene", 0, "SCENE",
     "Scene of the first run: run it again with the same method and one body shifted by 1e-6 m, and compare the "
     "growth. The shifted body is the bomb; before the bomb hits, the first body that differs; without a bomb, the "
     "last body",
     OPTION_PATH(Options, scene)},
    {"--csv", 0, "FILE", "Write frame,time,distance,shifted_distance: the largest distance of any body, s and m",
     OPTION_OUTPUT(Options, csv)},
    {OPTION_JSON(Options, json)},
    {0}};

static const CommandSpec spec = {
    .options = option_table,
    .input = {.value = "RUN RUN", .needed = "two runs (.npz) are needed", OPTION_PATHS(Options, paths, count)},
    .inputs = {2, 2, "run"},
    .help =
        "Find why two runs diverge: the first frame, body and contact that differ, whether the solver or an earlier "
        "step is the cause, and how fast the distance grows from there. Of runs of different lengths, the frames of "
        "the shorter one are compared. Exit status 0: the runs do not diverge beyond the tolerance, 1: they do.\v"
        "Example: twinbox diverge engine.npz momentum.npz --scene scenes/stack.yaml --csv distance.csv"};

static bool read_runs(Divergence *d, const Options *options, Error *error) {
    char what[256];
    for (int i = 0; i < 2; i++)
        if ((d->runs[i] = trajectory_read(options->paths[i], error)) == NULL) return false;
    return !trajectory_different_worlds(d->runs[0], d->runs[1], what, sizeof what) ||
           error_input(error, options->paths[1], "cannot be compared with %s: %s", options->paths[0], what);
}

static bool measure(Divergence *d, Error *error) {
    int frames = d->parting.frames;
    d->distance = malloc((size_t)frames * sizeof *d->distance);
    if (d->distance == NULL) return error_memory(error, "diverge");
    for (int frame = 0; frame < frames; frame++)
        d->distance[frame] = trajectory_distance(d->runs[0], d->runs[1], frame);
    /* command_diverge() frees d->distance. NOLINTNEXTLINE(clang-analyzer-unix.Malloc) */
    return growth_measure(d->distance, 0, frames, (double)d->runs[0]->dt, &d->growth, error);
}

/* Over the same frames as the growth of the two runs. */
static bool measure_chaos(Divergence *d, const char *scene, Error *error) {
    int body = chaos_body(d->runs[0], d->parting.first.body, d->parting.first.frame);
    if (body < 0) return error_input(error, scene, "has no body that can move, so none can be shifted");
    bool ok =
        chaos_run(&d->chaos, scene, d->runs[0], body, d->parting.frames, progress_bar_begin(d->runs[0]->scene), error);
    progress_bar_end();
    return ok && growth_measure(d->chaos.distance, d->growth.first, d->growth.end, (double)d->runs[0]->dt, &d->shifted,
                                error);
}

static bool find(Divergence *d, const Options *options, Error *error) {
    if (!read_runs(d, options, error) ||
        !trajectory_part(d->runs[0], d->runs[1], options->tolerance, &d->parting, error) || !measure(d, error) ||
        (options->scene != NULL && !measure_chaos(d, options->scene, error)))
        return false;
    const DistanceTable table = {d->parting.frames, (double)d->runs[0]->dt, d->distance, d->chaos.distance};
    return options->csv == NULL || distance_table_write(&table, options->csv, error);
}

bool command_diverge(int argc, char **argv, Error *error) {
    Options options = {0};
    if (!options_parse(&spec, argc, argv, &options, error)) return false;
    if (!json_output_check(options.json, error)) return false;
    Divergence divergence = {.paths = options.paths, .tolerance = options.tolerance};
    bool ok = find(&divergence, &options, error);
    if (ok && options.json)
        ok = diverge_print_json(&divergence, error);
    else if (ok)
        diverge_print(&divergence);
    bool same = ok && divergence.parting.beyond.frame < 0;
    chaos_free(&divergence.chaos);
    free(divergence.distance);
    for (int i = 0; i < 2; i++) trajectory_destroy(divergence.runs[i]);
    return same;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How twinbox compare compares two runs: why and how fast they diverge, as text and as JSON. */
#include "base/base.h"
#include "base/file.h"
#include "base/json.h"
#include "base/machine.h"
#include "cli/json_output.h"
#include "cli/larger_commands.h"
#include "cli/notes.h"
#include "cli/progress_bar.h"
#include "runs/compare_runs.h"
#include "runs/divergence.h"
#include "runs/run_files.h"
#include "runs/trajectory.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool same_length(const RunComparison *c) { return c->runs[0]->frames == c->runs[1]->frames; }

static void print_body(FILE *out, const Trajectory *a, const PartedBody *parted, bool poses_only) {
    const StateDifference *by = &parted->by;
    fprintf(out, "frame %d, body %d%s: ", parted->frame, parted->body, parted->body == a->bomb ? " (the bomb)" : "");
    if (by->in_a && by->in_b) fprintf(out, "%.3g m apart, %.3g rad", by->distance, by->angle);
    if (by->in_a && by->in_b && !poses_only) fprintf(out, ", %.3g m/s, %.3g rad/s", by->speed, by->spin);
    if (!by->in_a || !by->in_b) fprintf(out, "only in run %d", by->in_a ? 1 : 2);
    if (parted->bodies > 1) fprintf(out, "; %d bodies in all", parted->bodies);
    fprintf(out, "\n");
}

/* The first contact that only one run has, or the one whose impulses differ most. */
static void print_contact(FILE *out, const ContactDifference *contacts, bool no_impulses) {
    bool only = contacts->only_a + contacts->only_b > 0;
    if (!only && contacts->changed == 0) return;
    const TrajectoryContact *a = only ? &contacts->only : &contacts->largest_a, *b = &contacts->largest_b;
    fprintf(out, "  contact of bodies %d and %d, feature %08" PRIx32 ", at (%.4g, %.4g) m: ", (int)a->a, (int)a->b,
            a->feature, (double)a->point.x, (double)a->point.y);
    if (only) fprintf(out, "only in run %d\n", contacts->only_first_a ? 1 : 2);
    if (no_impulses) return;
    if (only)
        fprintf(out, "  normal %.9g N s, tangent %.9g N s\n", (double)a->normal_impulse, (double)a->tangent_impulse);
    else
        fprintf(out, "different impulses\n  normal %.9g and %.9g N s, tangent %.9g and %.9g N s\n",
                (double)a->normal_impulse, (double)b->normal_impulse, (double)a->tangent_impulse,
                (double)b->tangent_impulse);
}

/* Steps and states before the first frame that differs. */
static void print_cause(FILE *out, const TrajectoryParting *parting) {
    const ContactDifference *contacts = &parting->contacts;
    int frame = parting->first.frame;
    switch (parting->cause) {
    case PART_NONE: return;
    case PART_START: fprintf(out, "cause: the initial state\n"); return;
    case PART_LAUNCH: fprintf(out, "cause: the launch\n  all states of frame %d are equal\n", frame - 1); return;
    case PART_HIDDEN:
        fprintf(out,
                "cause: the warm start, which no state shows\n  all states of frame %d are equal, but %d contacts of "
                "step %d differ in impulse\n",
                frame - 1, contacts->changed, parting->step);
        break;
    case PART_CONTACTS:
        fprintf(
            out,
            "cause: collision detection\n  all states of frame %d are equal, but of the contacts of step %d, %d are "
            "only in run 1, %d only in run 2, and %d have another position\n",
            frame - 1, parting->step, contacts->only_a, contacts->only_b, contacts->moved);
        break;
    case PART_SOLVER:
        fprintf(out,
                "cause: the solver\n  all states of frame %d are equal, and so are the %d contacts of step %d, but the "
                "impulses of %d differ\n",
                frame - 1, contacts->count_a, frame, contacts->changed);
        break;
    case PART_ELSEWHERE:
        if (parting->no_impulses) {
            fprintf(out,
                    "cause: not the contacts\n  all states of frame %d are equal, and body %d has no contact in step "
                    "%d: it was moved differently\n",
                    frame - 1, parting->first.body, frame);
            return;
        }
        fprintf(
            out,
            "cause: not the contacts\n  all states of frame %d are equal, and so are the %d contacts of step %d with "
            "their impulses:\n  the bodies were moved differently (another kind of step, or another scene)\n",
            frame - 1, contacts->count_a, frame);
        return;
    case PART_UNKNOWN:
        if (parting->no_contacts) {
            fprintf(out, "cause: unknown, as a run has no contacts\n  all states of frame %d are equal\n", frame - 1);
            return;
        }
        fprintf(out,
                "cause: unknown, as a run has no impulses: the solver, its warm start or another kind of step\n  all "
                "states of frame %d are equal; body %d has %d contact%s in step %d\n",
                frame - 1, parting->first.body, contacts->count_a, plural(contacts->count_a), frame);
        return;
    }
    print_contact(out, contacts, parting->no_impulses);
}

/* "0.01 m", "0.01 m or 0.1 rad" */
static void print_tolerance(FILE *out, const PoseTolerance *tolerance, const char *join) {
    fprintf(out, "%g m", tolerance->distance);
    if (isfinite(tolerance->angle)) fprintf(out, " %s %g rad", join, tolerance->angle);
}

static void print_beyond(FILE *out, const Trajectory *a, const TrajectoryParting *parting,
                         const PoseTolerance *tolerance) {
    if (parting->beyond.frame < 0) {
        fprintf(out, "equal within the tolerance of ");
        print_tolerance(out, tolerance, "and");
        fprintf(out, ": %d frames of %d bodies; %d of them in every bit of their states\n", parting->frames, a->bodies,
                parting->equal);
        return;
    }
    fprintf(out, "within the tolerance: %d frames, %d of them equal in every bit\ncentres more than ",
            parting->equal + parting->within, parting->equal);
    print_tolerance(out, tolerance, "or turned more than");
    fprintf(out, " apart: ");
    print_body(out, a, &parting->beyond, parting->poses_only);
    if (parting->beyond.frame == 0) return;
    if (parting->beyond.frame == parting->first.frame)
        fprintf(out, "  all states before that step are equal: the cause above\n");
    else
        fprintf(out, "  the states before that step differ since frame %d: an earlier step is the cause\n",
                parting->first.frame);
    print_contact(out, &parting->beyond_contacts, parting->no_impulses);
}

static void print_beyond_chaos(FILE *out, const RunComparison *c) {
    const PartedBody *beyond = &c->parting.beyond;
    int frame = 0;
    while (frame < c->parting.frames && !(c->chaos.distance[frame] >= GROWTH_SATURATED)) frame++;
    if (beyond->frame < 0)
        fprintf(out, "as near as roundings keep the runs: %d frames of %d bodies\n", c->parting.frames,
                c->runs[0]->bodies);
    else {
        fprintf(out, "farther than roundings allow: ");
        print_body(out, c->runs[0], beyond, true);
    }
    if (frame < c->parting.frames)
        fprintf(out, "from frame %d on, one rounding has grown to %g m: later frames tell nothing\n", frame,
                GROWTH_SATURATED);
}

static void print_parting(FILE *out, const RunComparison *c) {
    const Trajectory *a = c->runs[0];
    const TrajectoryParting *parting = &c->parting;
    if (!same_length(c))
        fprintf(out, "different lengths, %d and %d frames: only the first %d are compared\n", a->frames,
                c->runs[1]->frames, parting->frames);
    if (parting->first.frame < 0) {
        fprintf(out, "equal%s: %d frames of %d bodies, %s\n", same_length(c) ? "" : " as far as both go",
                parting->frames, a->bodies, trajectory_compared(a, c->runs[1]).text);
        if (trajectory_different_steps(a, c->runs[1]))
            fprintf(out, "but dt is %.9g and %.9g s\n", (double)a->dt, (double)c->runs[1]->dt);
        if (parting->step >= 0) {
            const ContactDifference *contacts = &parting->contacts;
            fprintf(out,
                    "the states do not show it, but contacts of step %d differ: %d in impulse, %d in position, %d in "
                    "one run only\n",
                    parting->step, contacts->changed, contacts->moved, contacts->only_a + contacts->only_b);
            print_contact(out, contacts, parting->no_impulses);
        }
        return;
    }
    fprintf(out, "compared: %s\nfirst difference: ", trajectory_compared(a, c->runs[1]).text);
    print_body(out, a, &parting->first, parting->poses_only);
    fprintf(out, "kind: %s\n", trajectory_part_kind(a, c->runs[1], parting).text);
    print_cause(out, parting);
    if (c->options->poses.given) print_beyond(out, a, parting, &c->options->poses);
    if (c->options->chaos) print_beyond_chaos(out, c);
    if (c->difference.max_frame >= 0)
        fprintf(out, "largest distance: frame %d, body %d: %.3g m apart\n", c->difference.max_frame,
                c->difference.max_body, c->difference.max_distance);
    else /* a turn by 2 pi, or 0 and -0 */
        fprintf(out, "largest distance: none, every position is the same\n");
    if (c->difference.max_frame >= 0)
        fprintf(out, "mean squared difference of positions: %.3g m^2\n", c->difference.rollout_mse);
}

/* s; of a trace that does not state it, in frames. */
static double step_of(const RunComparison *c) { return c->runs[0]->dt > 0 ? (double)c->runs[0]->dt : 1; }

static void print_rate(FILE *out, const Growth *growth, const char *unit, double dt) {
    if (growth->count == 0) {
        fprintf(out, "%s\n", growth->saturated ? "above 0.1 m at once" : "there are no frames with a distance");
        return;
    }
    fprintf(out, "from %.2g m in frame %d to %.2g m in frame %d%s", growth->from, growth->first, growth->to,
            growth->last, growth->saturated ? ", then above 0.1 m" : "");
    if (growth->count < GROWTH_MIN_FRAMES) {
        fprintf(out, "\n  too few frames for a rate: %d of at least %d\n", growth->count, GROWTH_MIN_FRAMES);
        return;
    }
    double doubling = growth_doubling(growth, dt);
    fprintf(out, "\n  %.3g / %s, ", growth->rate, unit);
    if (isfinite(doubling))
        fprintf(out, "%s every %.3g frames", doubling > 0 ? "doubles" : "halves", fabs(doubling));
    else
        fprintf(out, "constant");
    fprintf(out, "; scatter: a factor of %.2g\n", exp(growth->scatter));
}

static void print_chaos(FILE *out, const Chaos *chaos, const Growth *growth, const Growth *shifted, double dt) {
    static const char *const verdicts[] = {
        [GROWTH_UNKNOWN] = "unknown, one of the two has no rate",
        [GROWTH_NEITHER] = "neither distance doubles in these frames",
        [GROWTH_SAME] = "chaos: grows as fast as a tiny shift",
        [GROWTH_FASTER] = "grows faster than a tiny shift",
        [GROWTH_SLOWER] = "grows more slowly than a tiny shift",
    };
    if (chaos->rerun_differs >= 0)
        fprintf(
            out,
            "note: running the scene again gives another run 1 from frame %d on: another network, or another program\n",
            chaos->rerun_differs);
    fprintf(out, "shifted run (body %d shifted by %.2g m, the same frames): ", chaos->body, chaos->shift);
    print_rate(out, shifted, "s", dt);
    fprintf(out, "verdict: %s\n", verdicts[growth_compare(growth, shifted, dt)]);
}

int compare_runs_others(const RunComparison *c, RunOther others[RUN_OTHERS_MAX]) {
    RunOther all[RUN_OTHERS_MAX] = {{.what = "bomb"}, {.what = "verdict"}, {.what = "camera"}, {.what = "network"}};
    int count = 0;
    for (int i = 0; i < 2; i++) {
        const Trajectory *run = c->runs[i];
        const Vec2 center = run->camera_center, size = run->camera_size;
        text_add(all[0].values[i], sizeof all[0].values[i], run->bomb < 0 ? "none" : "body %d", run->bomb);
        text_add(all[1].values[i], sizeof all[1].values[i], "%s", run->verdict[0] != '\0' ? run->verdict : "none");
        text_add(all[2].values[i], sizeof all[2].values[i], "%g x %g m at (%g, %g) m", (double)size.x, (double)size.y,
                 (double)center.x, (double)center.y);
        if (c->runs[!i]->network_hash != 0 && run->network_hash != 0)
            text_add(all[3].values[i], sizeof all[3].values[i], "%016" PRIx64, run->network_hash);
    }
    for (int i = 0; i < RUN_OTHERS_MAX; i++)
        if (strcmp(all[i].values[0], all[i].values[1]) != 0) others[count++] = all[i];
    return count;
}

static void print_all(FILE *out, const RunComparison *c) {
    const Trajectory *a = c->runs[0], *b = c->runs[1];
    for (int i = 0; i < 2; i++)
        fprintf(out, "run %d: %s by %s, %d frames of %d bodies (%s)\n", i + 1, c->runs[i]->scene, c->runs[i]->method,
                c->runs[i]->frames, c->runs[i]->bodies, c->options->paths[i]);
    if (a->scene_hash != b->scene_hash && a->scene_hash != 0 && b->scene_hash != 0)
        fprintf(out, "different scenes: hashes %016" PRIx64 " and %016" PRIx64 "; this may be the cause\n",
                a->scene_hash, b->scene_hash);
    if ((a->exact == NULL) != (b->exact == NULL) && !a->no_poses && !b->no_poses)
        fprintf(out, "run %d states float64, which is rounded as run %d is\n", a->exact != NULL ? 1 : 2,
                a->exact != NULL ? 2 : 1);
    if (!c->same_world) {
        fprintf(out, "%s\n", c->difference.what);
        return;
    }
    if (c->found_contacts) fprintf(out, "a run has no contacts: those of both are recomputed from the poses\n");
    print_parting(out, c);
    RunOther others[RUN_OTHERS_MAX];
    const int count = compare_runs_others(c, others);
    for (int i = 0; i < count; i++)
        fprintf(out, "not compared: the %s, \"%s\" in run 1, \"%s\" in run 2\n", others[i].what, others[i].values[0],
                others[i].values[1]);
    if (c->parting.first.frame < 0) return;
    fprintf(out, "not compared: contacts and their impulses of later steps\n");
    fprintf(out, "growth of the largest distance: ");
    print_rate(out, &c->growth, a->dt > 0 ? "s" : "frame", step_of(c));
    if (c->chaos.distance != NULL && !c->options->chaos)
        print_chaos(out, &c->chaos, &c->growth, &c->shifted, step_of(c));
}

/* A trace from standard input is compared with one from a file. */
static bool read_run(void *context, int i, Error *error) {
    RunComparison *c = context;
    const char *const *paths = c->options->paths;
    const bool trace = is_trace(paths[i]) || (path_is_standard(paths[i]) && is_trace(paths[1 - i]));
    return (c->runs[i] = trace ? csv_trace_read(paths[i], error) : trajectory_read(paths[i], error)) != NULL;
}

/* A trace need not state sizes that the other run has. */
static void share_sizes(Trajectory *to, const Trajectory *from) {
    for (int body = 0; body < to->bodies && body < from->bodies; body++)
        if (!(to->size[body].x > 0)) to->size[body] = from->size[body];
}

static bool all_boxes(const Trajectory *run) {
    for (int body = 0; body < run->bodies; body++)
        for (int frame = 0; !(run->size[body].x > 0) && frame < run->frames; frame++)
            if (trajectory_there(run, frame, body)) return false;
    return !run->no_poses;
}

/* How far a body is from its place in the other run, m: its centre, or by its turn a corner. */
static double gone(const RunComparison *c, int frame, int body) {
    const StateDifference by = trajectory_state_difference(c->runs[0], c->runs[1], frame, body);
    const Vec2 size = c->runs[0]->size[body];
    return fmax(by.distance, fabs(remainder(by.angle, 2 * acos(-1))) * hypot((double)size.x, (double)size.y) / 2);
}

/* What exceeds the tolerance is the farthest body of the first frame in which one is farther than roundings allow, if
   no body is NaN or missing before. */
static bool judge_chaos(RunComparison *c, Error *error) {
    const int frames = c->parting.frames;
    PartedBody *beyond = &c->parting.beyond;
    double *distance = calloc((size_t)frames, sizeof *distance);
    if (distance == NULL) return error_memory(error, "compare");
    for (int frame = 0; frame < frames; frame++)
        for (int body = 0; body < c->runs[0]->bodies; body++)
            distance[frame] = fmax(distance[frame], gone(c, frame, body));
    const int frame = chaos_exceeded(&c->chaos, distance, frames);
    for (int body = 0; frame >= 0 && (beyond->frame < 0 || frame < beyond->frame) && body < c->runs[0]->bodies; body++)
        if (gone(c, frame, body) == distance[frame])
            *beyond = (PartedBody){.frame = frame,
                                   .body = body,
                                   .bodies = 1,
                                   .by = trajectory_state_difference(c->runs[0], c->runs[1], frame, body)};
    free(distance);
    return true;
}

/* Reads and compares both runs, and measures how their distance grows. */
static bool measure(RunComparison *c, Error *error) {
    const CompareOptions *options = c->options;
    Trajectory *const *runs = c->runs;
    if (!parallel_for(&(ParallelWork){read_run, c}, 2, "compare", NULL, error)) return false;
    share_sizes(runs[0], runs[1]);
    share_sizes(runs[1], runs[0]);
    c->found_contacts = (runs[0]->no_contacts || runs[1]->no_contacts) && all_boxes(runs[0]) && all_boxes(runs[1]);
    for (int i = 0; c->found_contacts && i < 2; i++)
        if (!trajectory_find_contacts(runs[i], error)) return false;
    trajectory_compare(runs[0], runs[1], &c->difference);
    /* Runs of different worlds differ, but no distance of theirs means anything. */
    c->parting = (TrajectoryParting){.first = {.frame = -1}, .beyond = {.frame = -1}, .step = -1};
    c->same_world = !trajectory_different_bodies(runs[0], runs[1], c->difference.what, sizeof c->difference.what);
    if (!c->same_world)
        return (options->scene == NULL && options->csv == NULL) ||
               error_input(error, options->paths[1], "cannot be compared with %s: %s", options->paths[0],
                           c->difference.what);
    /* With chaos as the tolerance: what is NaN or in one run only. */
    const PoseTolerance any = {.given = true, .distance = INFINITY, .angle = INFINITY};
    if (!trajectory_part(runs[0], runs[1], options->chaos ? &any : &options->poses, &c->parting, error)) return false;

    const int frames = c->parting.frames;
    const double dt = step_of(c);
    c->distance = malloc((size_t)frames * sizeof *c->distance);
    if (c->distance == NULL) return error_memory(error, "compare");
    for (int frame = 0; frame < frames; frame++) c->distance[frame] = trajectory_distance(runs[0], runs[1], frame);
    /* compare_runs_free() frees c->distance. NOLINTBEGIN(clang-analyzer-unix.Malloc) */
    if (!growth_measure(c->distance, 0, frames, dt, &c->growth, error)) return false;
    if (options->scene != NULL) { /* chaos, over the same frames as the growth of the two runs */
        const int body = options->chaos ? -1 : chaos_body(runs[0], c->parting.first.body, c->parting.first.frame);
        if (body < 0 && !options->chaos)
            return error_input(error, options->scene, "has no body that can move, so none can be shifted");
        const bool ok =
            chaos_run(&c->chaos, options->scene, runs[0], body, frames, progress_bar_begin(runs[0]->scene), error);
        progress_bar_end();
        if (!ok || !growth_measure(c->chaos.distance, c->growth.first, c->growth.end, dt, &c->shifted, error))
            return false;
        if (options->chaos && !judge_chaos(c, error)) return false;
    }
    const DistanceTable table = {frames, dt, c->distance, c->chaos.distance};
    return options->csv == NULL || distance_table_write(&table, options->csv, error);
    /* NOLINTEND(clang-analyzer-unix.Malloc) */
}

bool compare_runs_make(RunComparison *c, Error *error) {
    const double begun = clock_seconds();
    size_t size;
    if (!measure(c, error)) return false;
    c->seconds = clock_seconds() - begun;
    c->passed = c->same_world && c->parting.beyond.frame < 0 && same_length(c) &&
                !trajectory_different_steps(c->runs[0], c->runs[1]);
    FILE *out = open_memstream(&c->text, &size);
    if (out == NULL) return error_memory(error, "compare");
    print_all(out, c);
    return fclose(out) == 0 || error_memory(error, "compare");
}

void compare_runs_free(RunComparison *c) {
    chaos_free(&c->chaos);
    free(c->distance);
    free(c->text);
    for (int i = 0; i < 2; i++) trajectory_destroy(c->runs[i]);
}

bool compare_runs(const CompareOptions *options, Error *error) {
    RunComparison c = {.options = options};
    bool ok =
        compare_runs_make(&c, error) && (options->report == NULL || compare_runs_report(&c, options->report, error));
    if (ok && options->json) {
        ok = json_output("twinbox compare runs 1", compare_runs_write_json, &c, error);
    } else if (ok) {
        fputs(c.text, stdout); /* it is in the report, too */
        if (c.same_world && c.parting.first.frame >= 0 && c.chaos.distance == NULL && c.runs[0]->scene_hash != 0)
            note_print("with --scene SCENE, the growth is compared with that of a shift of 1e-6 m");
        if (options->report != NULL) printf("report -> %s/report.html\n", options->report);
    }
    ok = ok && c.passed;
    compare_runs_free(&c);
    return ok;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A comparison of two runs for other programs: as JSON, and as the files of a report. */
#include "base/base.h"
#include "base/file.h"
#include "base/json.h"
#include "cli/json_output.h"
#include "cli/larger_commands.h"
#include "pictures/page.h"
#include "regression/report.h"
#include "runs/compare_runs.h"
#include "runs/divergence.h"
#include "runs/trajectory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The number of a frame; negative: no frame. */
static void put_frame(JsonWriter *json, const char *key, int frame) {
    if (!json_put_absent(json, key, frame < 0)) json_put_int(json, key, frame);
}

/* The only run that has it. */
static void write_only_in(JsonWriter *json, bool in_first, bool in_second) {
    put_frame(json, "only_in_run", in_first && in_second ? -1 : in_first ? 1 : 2);
}

static void write_parted(JsonWriter *json, const char *key, const RunComparison *c, const PartedBody *parted) {
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

static void write_contact(JsonWriter *json, const ContactDifference *contacts, bool no_impulses) {
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
    const double none = no_impulses ? NAN : 0;
    json_output_pair(json, "normal_impulse", in_first ? none + (double)a->normal_impulse : none,
                     in_second ? none + (double)b->normal_impulse : none);
    json_output_pair(json, "tangent_impulse", in_first ? none + (double)a->tangent_impulse : none,
                     in_second ? none + (double)b->tangent_impulse : none);
    json_end(json);
}

static void write_contacts(JsonWriter *json, const char *key, int step, const ContactDifference *contacts,
                           bool no_impulses) {
    if (json_put_absent(json, key, step < 0)) return;
    json_begin_object(json, key, JSON_ONE_LINE);
    json_put_int(json, "step", step);
    json_put_int(json, "changed", contacts->changed);
    json_put_int(json, "moved", contacts->moved);
    json_put_int(json, "only_in_run_1", contacts->only_a);
    json_put_int(json, "only_in_run_2", contacts->only_b);
    write_contact(json, contacts, no_impulses);
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

static void write_chaos(JsonWriter *json, const RunComparison *c, double dt) {
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

static const char *const causes[] = {[PART_NONE] = "none",
                                     [PART_START] = "initial state",
                                     [PART_LAUNCH] = "launch",
                                     [PART_HIDDEN] = "warm start",
                                     [PART_CONTACTS] = "collision detection",
                                     [PART_SOLVER] = "solver",
                                     [PART_ELSEWHERE] = "not the contacts",
                                     [PART_UNKNOWN] = "unknown"};

void compare_runs_write_json(JsonWriter *json, const void *context) {
    static const char *const keys[] = {"expected", "actual"};
    const RunComparison *c = context;
    const TrajectoryParting *parting = &c->parting;
    const Trajectory *a = c->runs[0];
    const bool differ = parting->first.frame >= 0, contacts = !a->no_contacts && !c->runs[1]->no_contacts,
               beyond = contacts && c->options->poses.given && parting->beyond.frame > 0;
    for (int i = 0; i < 2; i++) {
        const Trajectory *run = c->runs[i];
        json_begin_object(json, keys[i], JSON_ONE_LINE);
        json_put_text(json, "path", c->options->paths[i]);
        json_put_text(json, "scene", run->scene);
        json_put_hash(json, "scene_hash", run->scene_hash);
        json_put_text(json, "method", run->method);
        json_put_int(json, "frames", run->frames);
        json_put_int(json, "bodies", run->bodies);
        json_end(json);
    }
    json_put_bool(json, "passed", c->passed);
    json_put_text(json, "words", c->difference.what[0] != '\0' ? c->difference.what : NULL);
    json_put_int(json, "frames", parting->frames);
    json_put_number(json, "tolerance", c->options->poses.distance);
    json_put_number(json, "tolerance_angle", c->options->poses.angle);
    json_put_int(json, "frames_equal", parting->equal);
    json_put_int(json, "frames_within", parting->within);
    json_put_bool(json, "poses_only", c->difference.poses_only);
    write_parted(json, "first", c, &parting->first);
    if (!json_put_absent(json, "largest", c->difference.max_frame < 0)) {
        json_begin_object(json, "largest", JSON_ONE_LINE);
        json_put_int(json, "frame", c->difference.max_frame);
        json_put_int(json, "body", c->difference.max_body);
        json_put_number(json, "distance", c->difference.max_distance);
        json_end(json);
    }
    json_put_number(json, "rollout_mse", c->difference.rollout_mse);
    json_put_text(json, "compared", trajectory_compared(a, c->runs[1]).text);
    json_put_text(json, "kind", c->same_world && differ ? trajectory_part_kind(a, c->runs[1], parting).text : NULL);
    json_put_text(json, "cause", c->same_world ? causes[parting->cause] : NULL);
    json_put_bool(json, "contacts_found_again", c->found_contacts);
    json_begin_array(json, "not_compared", JSON_LINES);
    RunOther others[RUN_OTHERS_MAX];
    const int other_count = compare_runs_others(c, others);
    for (int i = 0; i < other_count; i++) {
        json_begin_object(json, NULL, JSON_ONE_LINE);
        json_put_text(json, "what", others[i].what);
        for (int k = 0; k < 2; k++) json_put_text(json, keys[k], others[i].values[k]);
        json_end(json);
    }
    json_end(json);
    write_contacts(json, "contacts", parting->step, &parting->contacts, parting->no_impulses);
    write_parted(json, "beyond", c, &parting->beyond);
    write_contacts(json, "beyond_contacts", beyond ? parting->beyond.frame : -1, &parting->beyond_contacts,
                   parting->no_impulses);
    if (!json_put_absent(json, "growth", !differ))
        write_growth(json, "growth", &c->growth, a->dt > 0 ? (double)a->dt : 1);
    if (!json_put_absent(json, "shifted", !differ || c->chaos.distance == NULL))
        write_chaos(json, c, a->dt > 0 ? (double)a->dt : 1);
}

/* The files of a report: those that pictures have, and a page that plays both runs. */

static const char *cause_of(const RunComparison *c) {
    return c->passed ? (c->parting.first.frame < 0 ? "equal" : "within tolerance") : "physics changed";
}

/* Whether the tolerance is exceeded: there the page of both runs opens, else at the first difference. */
static bool is_beyond(const RunComparison *c) {
    return (c->options->poses.given || c->options->chaos) && c->parting.beyond.frame >= 0;
}

static void write_page(FILE *out, const void *context) {
    const RunComparison *c = context;
    house_page_begin(out, "Comparison of two runs", "pre{white-space:pre-wrap}");
    html_print(out, "<main>\n<h1>Comparison of two runs: %s</h1>\n<pre>%s</pre>\n", cause_of(c), c->text);
    if (c->link.text[0] != '\0')
        html_print(out, "<p><a href=\"%s\">Both runs, at the first difference%s</a></p>\n", c->link.text,
                   is_beyond(c) ? " beyond the tolerance" : "");
    fputs("</main>\n", out);
    house_page_end(out);
}

const char *compare_runs_cause(const RunComparison *c, char *kind, size_t size) {
    static const char *const known[] = {[PART_HIDDEN] = ", first in the warm start",
                                        [PART_CONTACTS] = ", first in collision detection",
                                        [PART_SOLVER] = ", first in the solver",
                                        [PART_UNKNOWN] = NULL};
    const char *cause = known[c->parting.cause];
    snprintf(kind, size, "%s", trajectory_part_kind(c->runs[0], c->runs[1], &c->parting).text);
    return cause != NULL ? cause : "";
}

/* The one case: its file is that of the second run. */
ReportCase compare_runs_case(const void *context, int i) {
    const RunComparison *c = context;
    const PartedBody *parted = &c->parting.beyond;
    const char *const *paths = c->options->paths;
    ReportCase made = {.kind = "trajectories",
                       .name = paths[1],
                       .verdict = cause_of(c),
                       .failed = !c->passed,
                       .paths = {paths[0], paths[1]},
                       .seconds = c->seconds};
    (void)i;
    if (parted->frame >= 0)
        snprintf(made.words.text, sizeof made.words.text,
                 "frame %d, body %d; cause of the first difference: %s; kind: %s", parted->frame, parted->body,
                 causes[c->parting.cause], trajectory_part_kind(c->runs[0], c->runs[1], &c->parting).text);
    else
        snprintf(made.words.text, sizeof made.words.text, "%s", c->difference.what);
    return made;
}

static void write_results(FILE *out, const void *context) {
    json_output_print(out, &(JsonOutput){"twinbox compare runs 1", compare_runs_write_json, context});
}

bool compare_runs_page(RunComparison *c, const char *folder, Error *error) {
    const PartedBody *shown = is_beyond(c) ? &c->parting.beyond : &c->parting.first;
    size_t bytes;
    /* None of equal runs. Contacts that were found again have no impulses to show. */
    for (int i = 0; i < 2; i++) c->runs[i]->no_contacts |= c->found_contacts;
    return shown->frame < 0 ||
           report_write_run(c->runs, shown->frame, shown->body, folder, "run.html", &c->link, &bytes, error);
}

bool compare_runs_report(RunComparison *c, const char *folder, Error *error) {
    const ReportResults results = {.comparison = c,
                                   .count = 1,
                                   .failed = !c->passed,
                                   .notes = c->text,
                                   .seconds = c->seconds,
                                   .at = compare_runs_case,
                                   .write_page = write_page,
                                   .write_json = write_results};
    return compare_runs_page(c, folder, error) && report_write(&results, folder, error);
}

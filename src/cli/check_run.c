/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The verdict on a stored run, for check and import, and what check says of it. */
#include "base/base.h"
#include "base/json.h"
#include "cli/json_output.h"
#include "cli/larger_commands.h"
#include "cli/notes.h"
#include "runs/runs.h"
#include "runs/trajectory.h"
#include "runs/verdict.h"
#include "scenes/scenes.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>

enum { LIMITS = 3, FAILURE_SIZE = 160 };

typedef struct CheckedRun {
    const CheckRunOptions *options;
    const Trajectory *run;
    JudgedRun judged;
    int failed;
    char failures[LIMITS + 1][FAILURE_SIZE];
} CheckedRun;

bool judged_run_find(JudgedRun *judged, const Trajectory *run, const JudgeOptions *options, Error *error) {
    *judged = (JudgedRun){.scene = options->scene != NULL
                                       ? scene_read_with(options->scene, options->set.items, options->set.count, error)
                                       : trajectory_scene(run, error)};
    const RunScene by = {judged->scene, options->scene == NULL, options->skin};
    if (by.scene == NULL || !simulate_verdict_of_run(&judged->verdict, &by, run, error)) return false;
    simulate_verdict_words(&judged->verdict, judged->words);
    return true;
}

void judged_run_print(const JudgedRun *judged, const JudgeOptions *options) {
    const VerdictReading *reading = &judged->verdict.reading;
    printf("    verdict: %s\n    deepest overlap: %.3g m\n", judged->words, reading->deepest);
    if (!isnan(reading->drift))
        printf("    drift after the first %.3g s: %.3g m\n",
               simulate_verdict_falls(&judged->verdict, VERDICT_CREEP_FROM), reading->drift);
    if (isnan(reading->excess))
        printf("    energy gained: unknown without masses\n");
    else
        printf("    energy gained: %.3g J above what start and bomb brought\n", reading->excess);
    if (options->scene == NULL)
        note_print("assumed: bodies of %g kg/m2 and a gravity of %g m/s2; with --scene SCENE they are the scene's",
                   (double)VERDICT_DENSITY, (double)VERDICT_GRAVITY);
}

void judged_run_free(JudgedRun *judged) {
    simulate_verdict_free(&judged->verdict);
    scene_destroy(judged->scene);
}

PRINTF_LIKE(2, 3) static void fail(CheckedRun *checked, const char *format, ...) {
    PRINT_ARGUMENTS(checked->failures[checked->failed++], FAILURE_SIZE, format);
}

/* NaN is no limit. */
static void check_limit(CheckedRun *checked, const char *what, double value, const char *unit, double most) {
    if (value > most) fail(checked, "%s %.4g %s, more than %.4g %s", what, value, unit, most, unit);
}

static bool is_wanted(const char *wanted, Verdict verdict) {
    if (strcmp(wanted, "sound") == 0) return verdict_sound(verdict);
    if (strcmp(wanted, "holds") == 0) return verdict_holds(verdict);
    return strcmp(wanted, verdict_name(verdict)) == 0;
}

static bool check_limits(CheckedRun *checked, Error *error) {
    const CheckRunOptions *options = checked->options;
    const VerdictReading *reading = &checked->judged.verdict.reading;
    const char *word = verdict_name(reading->verdict), *wanted = options->verdict;
    if (!isnan(options->max_drift) && isnan(reading->drift))
        return error_input(error, options->path, "lasts %.3g s: --max-drift needs a run of more than %.3g s",
                           (checked->run->frames - 1) * (double)checked->run->dt,
                           simulate_verdict_falls(&checked->judged.verdict, VERDICT_CREEP_FROM));
    if (!isnan(options->max_gain) && isnan(reading->excess))
        return error_input(error, options->path,
                           "has a bomb, or bodies that start with a speed: --max-gain needs --scene");
    if (wanted != NULL && !is_wanted(wanted, reading->verdict)) fail(checked, "verdict %s, not %s", word, wanted);
    check_limit(checked, "overlap", reading->deepest, "m", options->max_overlap);
    check_limit(checked, "drift", reading->drift, "m", options->max_drift);
    check_limit(checked, "energy gained", reading->excess, "J", options->max_gain);
    return true;
}

static void check_run_print(const CheckedRun *checked) {
    const Trajectory *run = checked->run;
    printf("%s by %s: %d steps of %g s, %d bodies (%s)\n", run->scene, run->method, run->frames - 1, (double)run->dt,
           run->bodies, checked->options->path);
    judged_run_print(&checked->judged, &checked->options->judge);
    for (int i = 0; i < checked->failed; i++) printf("failed: %s\n", checked->failures[i]);
}

static void write_checked(JsonWriter *json, const void *context) {
    const CheckedRun *checked = context;
    json_put_text(json, "run", checked->options->path);
    json_put_bool(json, "passed", checked->failed == 0);
    json_begin_array(json, "failures", JSON_LINES);
    for (int i = 0; i < checked->failed; i++) json_put_text(json, NULL, checked->failures[i]);
    json_end(json);
    simulate_verdict_put(&checked->judged.verdict, json, "verdict");
}

bool check_run(const CheckRunOptions *options, Error *error) {
    Trajectory *run = trajectory_read(options->path, error);
    if (run == NULL) return false;
    CheckedRun checked = {.options = options, .run = run};
    bool ok = judged_run_find(&checked.judged, run, &options->judge, error) && check_limits(&checked, error);
    if (ok && options->json)
        ok = json_output("twinbox check run 1", write_checked, &checked, error);
    else if (ok)
        check_run_print(&checked);
    judged_run_free(&checked.judged);
    trajectory_destroy(run);
    return ok && checked.failed == 0;
}

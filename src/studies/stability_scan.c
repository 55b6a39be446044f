/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A stability study along one parameter: the borders of each method, its refusals and its runs. */
#include "base/base.h"
#include "base/machine.h"
#include "methods/methods.h"
#include "methods/programs.h"
#include "runs/verdict.h"
#include "scenes/scenes.h"
#include "studies/contenders.h"
#include "studies/piece_tables.h"
#include "studies/stability.h"
#include "studies/stability_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Estimated number of runs of a method beyond the coarse scan: a bisection and its seeds. */
enum { RUNS_OF_A_BORDER = 8 };

typedef enum Part { PART_STUDIED, PART_LEFT_OUT, PART_REFUSED } Part;

/* An unshifted run. */
typedef struct ScanRun {
    double value;
    VerdictReading reading;
    const ConvergedRun *beside; /* as of stability_judge() */
} ScanRun;

/* The results of a method. */
typedef struct Result {
    Part part;
    BorderList borders;
    Error reason;  /* of the refusal */
    ScanRun *runs; /* [run_count] */
    size_t run_capacity;
    int run_count;
    double differs; /* value at which a repeated run ended otherwise; NAN: none */
} Result;

typedef struct Run {
    ScanContext *context;
    const StabilityScan *scan; /* of the context */
    int first;                 /* method of the first result */
    RunCounter counter;
    Result *results;
} Run;

static StabilityPlace place_of(const StabilityScan *scan) {
    return (StabilityPlace){scan->scenes, scan->study->scene, scan->study->file};
}

bool stability_scan_run(const StabilityScan *scan, const Method *method, double value, int seed,
                        ConvergedRuns *converged, VerdictReading *reading, const ConvergedRun **beside, Error *error) {
    const StabilityPlace place = place_of(scan);
    Scene *scene = stability_study_scene(scan->study, scan->scenes, value, error);
    if (scene == NULL) return false;
    const JudgedRun run = {method, seed, value, stability_is_struck(&place, scene, scan->study->stands)};
    const bool ok = stability_judge(scene, &run, converged, reading, beside, error);
    scene_destroy(scene);
    return ok;
}

typedef struct ProbeContext {
    Run *run;
    const Method *method;
    Result *result;
} ProbeContext;

static bool probe_value(void *context, double value, int seed, Verdict *verdict, Error *error) {
    const ProbeContext *probed = context;
    Run *run = probed->run;
    VerdictReading reading;
    const ConvergedRun *beside;
    if (!stability_scan_run(run->scan, probed->method, value, seed, &run->context->converged, &reading, &beside, error))
        return false;
    *verdict = reading.verdict;
    Result *result = probed->result;
    if (seed == 0) {
        if (!array_reserve((void **)&result->runs, &result->run_capacity, (size_t)result->run_count + 1,
                           sizeof *result->runs))
            return error_memory(error, "runs");
        result->runs[result->run_count++] = (ScanRun){value, reading, beside};
    }
    return run_counter_add(&run->counter, run->scan->study->name, error);
}

/* Other programs may give another result each time: on both sides of a border it would matter most. Without a side,
   every value was undecided: perhaps for that very reason. */
static bool repeat_runs(const ProbeContext *probed, Error *error) {
    Run *run = probed->run;
    Result *result = probed->result;
    for (int i = 0; i < result->run_count; i++) {
        const ScanRun *first = &result->runs[i];
        VerdictReading again;
        const ConvergedRun *beside;
        bool sides = false, is_side = false;
        for (int k = 0; k < result->borders.count; k++) {
            const Border *border = &result->borders.items[k];
            sides |= !isnan(border->holds_at) || !isnan(border->fails_at);
            is_side |= border->holds_at == first->value || border->fails_at == first->value;
        }
        if (first->reading.verdict == VERDICT_ADAPTER_FAILED || (sides && !is_side)) continue;
        if (!stability_scan_run(run->scan, probed->method, first->value, 0, &run->context->converged, &again, &beside,
                                error) ||
            !run_counter_add(&run->counter, run->scan->study->name, error))
            return false;
        if (again.energy != first->reading.energy || again.steps != first->reading.steps)
            result->differs = first->value;
    }
    return true;
}

static const Contender *contender_of(const Run *run, int i) { return &run->scan->methods->items[run->first + i]; }

static bool study_method(void *context, int i, Error *error) {
    Run *run = context;
    Result *result = &run->results[i];
    const StabilityStudy *study = run->scan->study;
    ProbeContext probed = {run, &contender_of(run, i)->method, result};
    result->differs = NAN;
    if (study->iterations && !stability_takes_iterations(probed.method)) {
        result->part = PART_LEFT_OUT;
        return true;
    }
    /* Both ends of the scan are tried: a network may fit the bodies of one value only. */
    const double ends[] = {study->scan.from, study->scan.to};
    bool applies = true;
    for (int k = 0; applies && k < 2; k++) {
        Scene *scene = stability_study_scene(study, run->scan->scenes, ends[k], &result->reason);
        applies = scene != NULL && stability_applies(probed.method, scene, &result->reason);
        scene_destroy(scene);
    }
    if (!applies) {
        result->part = PART_REFUSED;
        return result->reason.kind == ERROR_INPUT || error_system(error, study->name, "%s", result->reason.message);
    }
    const BorderProbe probe = {probe_value, &probed, study->unshifted ? 1 : BORDER_SEEDS};
    return border_search(&result->borders, &study->scan, &probe, error) &&
           (!probed.method->kind->description->external || repeat_runs(&probed, error));
}

static bool write_border(const Run *run, int i, const Border *border, FILE *lines, Error *error) {
    const Contender *contender = contender_of(run, i);
    const StabilityStudy *study = run->scan->study;
    const BorderRow row = {.study = study->name,
                           .method = contender->name,
                           .setting = contender->setting,
                           .parameter = study->parameter,
                           .unit = scene_parameter_unit(run->context->typical, study->parameter),
                           .holds_at = border != NULL ? border->holds_at : NAN,
                           .fails_at = border != NULL ? border->fails_at : NAN,
                           .verdict = border != NULL ? (int)border->verdict : CELL_NOT_APPLICABLE};
    return piece_tables_print(lines, &border_layout, -1, &row, error);
}

static int by_value(const void *left, const void *right) {
    const ScanRun *a = left, *b = right;
    return (a->value > b->value) - (a->value < b->value);
}

static bool write_run(const Run *run, int i, const ScanRun *scan_run, FILE *lines, Error *error) {
    const Contender *contender = contender_of(run, i);
    const StabilityStudy *study = run->scan->study;
    const VerdictReading *reading = &scan_run->reading;
    const RunRow row = {.study = study->name,
                        .method = contender->name,
                        .setting = contender->setting,
                        .parameter = study->parameter,
                        .unit = scene_parameter_unit(run->context->typical, study->parameter),
                        .value = scan_run->value,
                        .steps = reading->steps,
                        .verdict = (int)reading->verdict,
                        .drift = isfinite(reading->drift) ? reading->drift : NAN,
                        .energy = isfinite(reading->gained) ? reading->gained : NAN,
                        .not_finite = reading->fallbacks.not_finite,
                        .outside_cone = reading->fallbacks.outside_cone,
                        .beyond_training = reading->fallbacks.beyond_training,
                        .by_sweeps = reading->fallbacks.by_sweeps};
    const MethodDescription *method = contender->method.kind->description;
    const bool may_fall_back = method->needs_network || method->falls_back;
    if (may_fall_back && !piece_tables_print(lines, &fallback_layout, -1, &row, error)) return false;
    if (study->rests && !piece_tables_print(lines, &rest_layout, -1, &row, error)) return false;
    MapCell cell = {.map = study->name, /* a run as a cell, without what it showed */
                    .method = row.method,
                    .setting = row.setting,
                    .x_parameter = study->parameter,
                    .x_unit = row.unit,
                    .x = row.value,
                    .y_parameter = study->fixed.name,
                    .y_unit = "",
                    .y = study->fixed.name[0] != '\0' ? study->fixed.value : NAN,
                    .verdict = row.verdict};
    return unconverged_print(lines, -1, &cell, scan_run->beside, error);
}

/* What a program says that it is, and how often its adapter failed, first at the lowest value. */
static bool write_engine(const Run *run, int i, FILE *lines, Error *error) {
    const Contender *contender = contender_of(run, i);
    const Result *result = &run->results[i];
    ProgramName program = {"", ""};
    EngineRow row = {.study = run->scan->study->name,
                     .method = contender->name,
                     .setting = contender->setting,
                     .engine = program.name,
                     .version = program.version,
                     .runs = result->run_count,
                     .reason = "",
                     .differs = result->differs};
    method_program(&contender->method, &program);
    for (int k = 0; k < result->run_count; k++) {
        const VerdictReading *reading = &result->runs[k].reading;
        if (reading->verdict == VERDICT_ADAPTER_FAILED && row.failed++ == 0) row.reason = reading->reason;
    }
    return piece_tables_print(lines, &engine_layout, -1, &row, error);
}

static bool write_result(const Run *run, int i, FILE *lines, Error *error) {
    const Contender *contender = contender_of(run, i);
    Result *result = &run->results[i];
    if (result->part == PART_LEFT_OUT) return true;
    for (int k = 0; result->part == PART_STUDIED && k < result->borders.count; k++)
        if (!write_border(run, i, &result->borders.items[k], lines, error)) return false;
    if (result->run_count > 0) qsort(result->runs, (size_t)result->run_count, sizeof *result->runs, by_value);
    for (int k = 0; k < result->run_count; k++)
        if (!write_run(run, i, &result->runs[k], lines, error)) return false;
    if (contender->method.kind->description->external && !write_engine(run, i, lines, error)) return false;
    if (result->part == PART_STUDIED) return true;
    char *reason = result->reason.message;
    reason[strcspn(reason, "\n")] = '\0';
    const RefusalRow row = {run->scan->study->name, contender->name, contender->setting, reason};
    return write_border(run, i, NULL, lines, error) && piece_tables_print(lines, &refusal_layout, -1, &row, error);
}

bool stability_scan_begin(ScanContext *context, const StabilityScan *scan, Error *error) {
    const StabilityPlace place = place_of(scan);
    *context = (ScanContext){.scan = scan, .typical = stability_scene(&place, NULL, 0, error)};
    return context->typical != NULL;
}

void stability_scan_end(ScanContext *context) {
    converged_runs_free(&context->converged);
    scene_destroy(context->typical);
    *context = (ScanContext){0};
}

bool stability_scan_write(ScanContext *context, int first, int end, FILE *results, const Progress *progress,
                          Error *error) {
    const StabilityStudy *study = context->scan->study;
    const int methods = end - first;
    Run run = {
        .context = context,
        .scan = context->scan,
        .first = first,
        .counter = {.progress = progress, .expected = (double)methods * (study->scan.points + RUNS_OF_A_BORDER)}};
    const ParallelWork work = {study_method, &run};
    run.results = calloc((size_t)methods, sizeof *run.results);
    bool ok = (run.results != NULL || error_memory(error, study->name)) &&
              parallel_for(&work, methods, study->name, NULL, error);
    for (int i = 0; ok && i < methods; i++) ok = write_result(&run, i, results, error);
    for (int i = 0; run.results != NULL && i < methods; i++) free(run.results[i].runs);
    free(run.results);
    return ok;
}

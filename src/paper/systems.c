/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The systems that the paper cites: each with its ablations, beside rivals, on held-out launches of the four scenes. */
#include "base/base.h"
#include "base/csv.h"
#include "base/machine.h"
#include "methods/methods.h"
#include "paper/paper_internal.h"
#include "scenes/scenes.h"
#include "studies/closed_loop.h"
#include "studies/contenders.h"
#include "studies/piece_tables.h"
#include "studies/rollout.h"
#include "studies/statistics.h"
#include "studies/timing.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The methods in the order of the table. The first is the engine, whose time stands beside that of each. In a scene
   without its network a method has no row. */
static const struct {
    const char *system, *method;
} scored[] = {{"rival", "engine"},
              {"rival", "momentum:k=20"},
              {"rival", "interior"},
              {"sain", "sain"},
              {"sain", "sain:net=off"},
              {"hybrid", "hybrid"},
              {"hybrid", "hybrid:net=off"},
              {"gns", "gns"},
              {"gns", "gns:rigid=off"},
              {"gns", "gns:net=off"},
              {"subspace", "subspace"},
              {"subspace", "subspace:net=off"},
              {"subspace", "subspace:components=8"},
              {"subspace", "subspace:components=128"}};

enum { METHODS = sizeof scored / sizeof *scored, ENGINE = 0 };

typedef struct Scored {
    const char *system;
    Contender contender;            /* its method, for timing */
    LaunchLoop loops[LAUNCHED_MAX]; /* [launches] */
} Scored;

/* A scene's scores in progress. */
typedef struct Scores {
    const PaperSize *size;
    Launched launched;
    RunLog engine[LAUNCHED_MAX];           /* [launches] */
    ConvergedLogs converged[LAUNCHED_MAX]; /* [launches] */
    int count;
    Scored methods[METHODS]; /* [count] */
} Scores;

static bool log_launch(void *context, int i, Error *error) {
    Scores *scores = context;
    const Scene *launched = &scores->launched.launches[i];
    return closed_loop_log(&scores->engine[i], "engine", launched, error) &&
           closed_loop_log_converged(&scores->converged[i], launched, error);
}

static bool run_launch(void *context, int i, Error *error) {
    Scores *scores = context;
    const int launch = i % scores->launched.count;
    Scored *method = &scores->methods[i / scores->launched.count];
    Rollout rollout = {0};
    const bool ok =
        closed_loop_launch(&rollout, &method->contender.method, &scores->launched.launches[launch],
                           &scores->engine[launch], &scores->converged[launch], &method->loops[launch], error);
    rollout_free(&rollout);
    return ok;
}

/* Each method is timed in turns with the engine, and not with all others: a method that is slow would let the engine's
   code and data leave the caches. */
static bool time_method(const Scores *scores, const Scored *method, SystemScoreRow *row, Error *error) {
    const Contender *const turns[] = {&scores->methods[ENGINE].contender, &method->contender};
    const Scene *launched = &scores->launched.launches[0];
    const int last = scores->size->system_timed_frames + launched->bomb.frame;
    StepCost costs[2][PHASES];
    if (!timing_of_launch(turns, 2, launched, last < launched->frames ? last : launched->frames,
                          scores->size->system_repetitions, costs, error))
        return false;
    row->us_step = step_cost_mean(costs[1], method->contender.method.kind->description->no_contacts);
    row->us_step_engine = step_cost_mean(costs[0], false);
    return true;
}

static bool write_method(const Scores *scores, int scene, const Scored *method, FILE *lines, Error *error) {
    const int launches = scores->launched.count;
    double engine[LAUNCHED_MAX], converged[LAUNCHED_MAX], steps = 0;
    SystemScoreRow row = {.system = method->system,
                          .method = method->contender.method.text,
                          .scene = scene,
                          .launches = launches,
                          .frames = scores->launched.launches[0].frames};
    if (!time_method(scores, method, &row, error)) return false;
    for (int i = 0; i < launches; i++) {
        const LaunchLoop *loop = &method->loops[i];
        engine[i] = loop->frames_engine;
        converged[i] = loop->frames_converged;
        row.moved += loop->moved / launches;
        row.penetration_max = fmax(row.penetration_max, loop->penetration);
        row.energy_created = fmax(row.energy_created, loop->energy_most - loop->energy_put_in);
        row.momentum_error += loop->momentum_error;
        row.fallback_share += loop->fallen_back;
        steps += loop->steps;
    }
    row.momentum_error = steps > 0 ? row.momentum_error / steps : NAN;
    row.fallback_share = steps > 0 ? row.fallback_share / steps : NAN;
    row.frames_engine = statistics_quantile(engine, statistics_known(engine, launches), 0.5);
    const int known = statistics_known(converged, launches);
    row.frames_converged = statistics_quantile(converged, known, 0.5);
    row.unconverged = launches - known;
    return piece_tables_print(lines, &system_score_layout, -1, &row, error);
}

bool system_scores_write(PaperPlan *plan, const PaperPart *part, FILE *lines, const Progress *progress, Error *error) {
    ProgressStage runs = {.whole = progress, .share = 0.7}, times = {.whole = progress, .begin = 0.7, .share = 0.3};
    const Progress of_runs = {progress_stage, &runs}, of_times = {progress_stage, &times};
    const char *path = plan->datasets.scenes[part->index];
    Scores *scores = calloc(1, sizeof *scores);
    if (scores == NULL) return error_memory(error, path);
    scores->size = plan->size;
    Launched *launched = &scores->launched;
    bool ok = launched_begin(launched, path, plan->size->system_launches, error);
    for (int i = 0; ok && i < METHODS; i++) {
        Scored *method = &scores->methods[scores->count];
        method->system = scored[i].system;
        ok = method_parse(&method->contender.method, scored[i].method, error);
        scores->count += ok && !method_lacks_network(&method->contender.method, launched->scene);
    }
    const int most = plan->size->system_frames;
    for (int i = 0; ok && i < launched->count; i++)
        if (most > 0 && most < launched->launches[i].frames) launched->launches[i].frames = most;

    const ParallelWork logging = {log_launch, scores}, running = {run_launch, scores};
    ok = ok && parallel_for(&logging, launched->count, "launches", NULL, error) &&
         parallel_for(&running, scores->count * launched->count, "runs of systems", &of_runs, error);
    for (int i = 0; ok && i < scores->count; i++)
        ok = write_method(scores, part->index, &scores->methods[i], lines, error) &&
             (progress_report(&of_times, i + 1, scores->count) || error_interrupted(error, "systems", "stopped"));

    for (int i = 0; i < LAUNCHED_MAX; i++) {
        run_log_free(&scores->engine[i]);
        converged_logs_free(&scores->converged[i]);
    }
    launched_free(launched);
    free(scores);
    return ok;
}

#define MOST 1e30

static const CsvColumn columns[] = {
    CSV_MEMBER(SystemScoreRow, system, CSV_NAME, .key = true),
    CSV_MEMBER(SystemScoreRow, method, CSV_TEXT, .maximum = SYSTEM_NAME_SIZE, .key = true),
    CSV_MEMBER(SystemScoreRow, scene, CSV_WORD, .words = paper_scene_names, .key = true),
    CSV_MEMBER(SystemScoreRow, launches, CSV_NUMBER, .minimum = 1, .maximum = LAUNCHED_MAX),
    CSV_MEMBER(SystemScoreRow, frames, CSV_NUMBER, .minimum = 1, .maximum = 1e6),
    CSV_MEMBER(SystemScoreRow, frames_engine, CSV_NUMBER, .maximum = 1e6),
    CSV_MEMBER(SystemScoreRow, frames_converged, CSV_OPTIONAL, .maximum = 1e6),
    CSV_MEMBER(SystemScoreRow, moved, CSV_NUMBER, .maximum = 1e6),
    CSV_MEMBER(SystemScoreRow, penetration_max, CSV_NUMBER, .maximum = MOST),
    CSV_MEMBER(SystemScoreRow, energy_created, CSV_NUMBER, .maximum = MOST),
    CSV_MEMBER(SystemScoreRow, momentum_error, CSV_OPTIONAL, .maximum = MOST),
    CSV_MEMBER(SystemScoreRow, fallback_share, CSV_OPTIONAL, .maximum = 1),
    CSV_MEMBER(SystemScoreRow, unconverged, CSV_OPTIONAL, .maximum = LAUNCHED_MAX, .optional = true),
    CSV_MEMBER(SystemScoreRow, us_step, CSV_OPTIONAL, .maximum = MOST),
    CSV_MEMBER(SystemScoreRow, us_step_engine, CSV_OPTIONAL, .maximum = MOST),
};
const CsvLayout system_score_layout =
    CSV_LAYOUT("system_scores", columns, SystemScoreRow, .min_rows = 1, .max_rows = SYSTEM_SCORES_MAX);

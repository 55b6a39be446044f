/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The frame of the systems that the paper cites: their scores beside those of rivals, their strips, their list. */
#include "base/base.h"
#include "base/csv.h"
#include "base/file.h"
#include "base/machine.h"
#include "figures/figure.h"
#include "figures/sketch.h"
#include "methods/methods.h"
#include "paper/paper.h"
#include "paper/paper_internal.h"
#include "pictures/picture.h"
#include "pictures/player.h"
#include "runs/runs.h"
#include "runs/trajectory.h"
#include "scenes/scenes.h"
#include "studies/closed_loop.h"
#include "studies/contenders.h"
#include "studies/frozen.h"
#include "studies/piece_tables.h"
#include "studies/rollout.h"
#include "studies/statistics.h"
#include "studies/timing.h"

#include <assert.h>
#include <limits.h>
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

static const char *const rivals[] = {"engine", "momentum:k=20", "interior", NULL};

/* Times are beside the engine's, which is the first of the rivals. */
enum { ENGINE = 0 };

/* A method to score. */
typedef struct Scored {
    const char *system;
    Contender contender; /* its method, for timing */
    LaunchLoop *loops;   /* [launches] */
    StepCost closed[PHASES], frozen[PHASES];
} Scored;

/* A scene's scores in progress. */
typedef struct Scores {
    const PaperPlan *plan;
    int scene;
    Launched launched;
    RunLog *engine, *converged; /* [launches] */
    int count;
    Scored *methods; /* [count] */
    LaunchLoop *loops;
} Scores;

static int count_methods(const PaperSystem *const *systems) {
    int count = sizeof rivals / sizeof *rivals - 1;
    for (int i = 0; systems[i] != NULL; i++)
        for (int k = 0; systems[i]->methods[k] != NULL; k++) count++;
    return count;
}

/* Methods without a network for this scene are left out. */
static bool add_methods(Scores *scores, const char *system, const char *const *texts, Error *error) {
    for (; *texts != NULL; texts++) {
        Scored *method = &scores->methods[scores->count];
        method->system = system;
        if (!method_parse(&method->contender.method, *texts, error)) return false;
        if (method_lacks_network(&method->contender.method, scores->launched.scene)) continue;
        method->loops = scores->loops + (size_t)scores->count++ * (size_t)scores->launched.count;
    }
    return true;
}

static void system_shorten(Scores *scores) {
    const int frames = scores->plan->size->system_frames;
    for (int i = 0; i < scores->launched.count; i++)
        if (frames > 0 && frames < scores->launched.launches[i].frames) scores->launched.launches[i].frames = frames;
}

static bool scores_begin(Scores *scores, const PaperPlan *plan, int scene, Error *error) {
    const PaperSystem *const *systems = plan->systems;
    const char *path = plan->datasets.scenes[scene];
    *scores = (Scores){.plan = plan, .scene = scene};
    if (!launched_begin(&scores->launched, path, plan->size->system_launches, error)) return false;
    const size_t most = (size_t)count_methods(systems), launches = (size_t)scores->launched.count;
    scores->methods = calloc(most, sizeof *scores->methods);
    scores->loops = calloc(most * launches, sizeof *scores->loops);
    scores->engine = calloc(launches, sizeof *scores->engine);
    scores->converged = calloc(launches, sizeof *scores->converged);
    if (scores->methods == NULL || scores->loops == NULL || scores->engine == NULL || scores->converged == NULL)
        return error_memory(error, path);
    system_shorten(scores);
    bool ok = add_methods(scores, SYSTEM_RIVAL, rivals, error);
    for (int i = 0; ok && systems[i] != NULL; i++)
        ok = add_methods(scores, systems[i]->name, systems[i]->methods, error);
    return ok;
}

static void scores_end(Scores *scores) {
    for (int i = 0; i < scores->launched.count; i++) {
        if (scores->engine != NULL) run_log_free(&scores->engine[i]);
        if (scores->converged != NULL) run_log_free(&scores->converged[i]);
    }
    free(scores->engine);
    free(scores->converged);
    free(scores->methods);
    free(scores->loops);
    launched_free(&scores->launched);
}

static bool log_launch(void *context, int i, Error *error) {
    Scores *scores = context;
    const Scene *launched = &scores->launched.launches[i];
    return closed_loop_log(&scores->engine[i], "engine", launched, error) &&
           closed_loop_log(&scores->converged[i], "reference", launched, error);
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

/* Each method in turns with the engine, and not with all others: a method that is slow would let the engine's code and
   data leave the caches. */
static bool time_method(const Scores *scores, Scored *method, StepCost engine[PHASES], Error *error) {
    const Contender *const turns[] = {&scores->methods[ENGINE].contender, &method->contender};
    const Scene *launched = &scores->launched.launches[0];
    const int last = scores->plan->size->system_timed_frames + launched->bomb.frame;
    StepCost closed[2][PHASES];
    if (!timing_of_launch(turns, 2, launched, last < launched->frames ? last : launched->frames,
                          scores->plan->size->system_repetitions, closed, error))
        return false;
    memcpy(engine, closed[0], sizeof closed[0]);
    memcpy(method->closed, closed[1], sizeof closed[1]);
    return true;
}

/* Of frames_engine; or of frames_converged. unknown: launches without it. */
static double median_frames(const Scores *scores, const Scored *method, bool converged, int *unknown) {
    double frames[LAUNCHED_MAX];
    const int count = scores->launched.count;
    for (int i = 0; i < count; i++)
        frames[i] = converged ? method->loops[i].frames_converged : method->loops[i].frames_engine;
    const int known = statistics_known(frames, count);
    *unknown = count - known;
    return statistics_quantile(frames, known, 0.5);
}

static void sum_loops(const Scores *scores, const Scored *method, SystemScoreRow *row) {
    double steps = 0;
    for (int i = 0; i < scores->launched.count; i++) {
        const LaunchLoop *loop = &method->loops[i];
        row->moved += loop->moved / scores->launched.count;
        row->penetration_max = fmax(row->penetration_max, loop->penetration);
        row->energy_created = fmax(row->energy_created, loop->energy_most - loop->energy_put_in);
        row->momentum_error += loop->momentum_error;
        row->fallback_share += loop->fallen_back;
        steps += loop->steps;
    }
    row->momentum_error = steps > 0 ? row->momentum_error / steps : NAN;
    row->fallback_share = steps > 0 ? row->fallback_share / steps : NAN;
}

static bool write_method(const Scores *scores, Scored *method, FILE *lines, Error *error) {
    StepCost engine[PHASES];
    int unconverged, none;
    if (!time_method(scores, method, engine, error)) return false;
    const Method *of = &method->contender.method;
    SystemScoreRow row = {.system = method->system,
                          .method = of->text,
                          .scene = scores->scene,
                          .launches = scores->launched.count,
                          .frames = scores->launched.launches[0].frames,
                          .frames_engine = median_frames(scores, method, false, &none),
                          .frames_converged = median_frames(scores, method, true, &unconverged),
                          .us_step = step_cost_mean(method->closed, of->kind->description->no_contacts),
                          .us_step_engine = step_cost_mean(engine, false)};
    row.unconverged = unconverged;
    sum_loops(scores, method, &row);
    return piece_tables_print(lines, &system_score_layout, -1, &row, error);
}

bool system_scores_write(PaperPlan *plan, const PaperPart *part, FILE *lines, const Progress *progress, Error *error) {
    Scores scores;
    ProgressStage runs = {.whole = progress, .share = 0.7}, times = {.whole = progress, .begin = 0.7, .share = 0.3};
    const Progress of_runs = {progress_stage, &runs}, of_times = {progress_stage, &times};
    bool ok = scores_begin(&scores, plan, part->index, error);
    const ParallelWork logging = {log_launch, &scores}, running = {run_launch, &scores};
    ok = ok && parallel_for(&logging, scores.launched.count, "launches", NULL, error) &&
         parallel_for(&running, scores.count * scores.launched.count, "runs of systems", &of_runs, error);
    for (int i = 0; ok && i < scores.count; i++)
        ok = write_method(&scores, &scores.methods[i], lines, error) &&
             (progress_report(&of_times, i + 1, scores.count) || error_interrupted(error, "systems", "stopped"));
    scores_end(&scores);
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

#define SYSTEM_LISTED(name) &system_##name,
const PaperSystem *const paper_systems[] = {SYSTEMS(SYSTEM_LISTED) NULL};

/* The strips. */

const char *const strip_scene_names[STRIP_SCENES + 1] = {"stack", "pyramid", NULL};

enum {
    MOMENTS = 6,
    STRIP_LAUNCHES = 5, /* of which one is shown: the bomb comes from the right, neither flat nor steep */
    SHOWN = 3,
    SHOWN_ENGINE = 0, /* the first of the runs; then the systems' */
    STRIP_CAPTION_SIZE = 400
};

/* s: before the bomb strikes, while boxes fall, and at the end. */
static const double moments[MOMENTS] = {0.3, 0.5, 0.8, 1.2, 2, 5},
                    quick_moments[MOMENTS] = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6};

/* What is shown of each scene, m: where boxes stand, and room for some to fall. */
static const CameraView views[STRIP_SCENES] = {{0, 5.2, 16, 12.6}, {0, 10, 24, 22.4}};

/* The strips of one scene. */
typedef struct Strips {
    const PaperSystem *const *systems;
    int count;
    Scene *scene;
    Scene launched;
    const char *name; /* of the scene */
    const double *times;
    const CameraView *view;
    Trajectory **runs; /* [count + 1] */
} Strips;

static void strips_end(Strips *strips) {
    for (int i = 0; strips->runs != NULL && i <= strips->count; i++) trajectory_destroy(strips->runs[i]);
    free(strips->runs);
    scene_destroy(strips->scene);
}

static bool strips_begin(Strips *strips, const char *scenes, Error *error) {
    char path[PATH_MAX];
    Launch launches[STRIP_LAUNCHES];
    if (!file_path(path, sizeof path, error, "%s/%s.yaml", scenes, strips->name)) return false;
    strips->runs = calloc((size_t)strips->count + 1, sizeof *strips->runs);
    if (strips->runs == NULL) return error_memory(error, path);
    strips->scene = scene_read(path, error);
    if (strips->scene == NULL || !launches_for_scoring(strips->scene, STRIP_LAUNCHES, launches, error)) return false;
    strips->launched = launch_scene(strips->scene, &launches[SHOWN]);
    strips->launched.frames = (int)lround(strips->times[MOMENTS - 1] / (double)strips->scene->dt);
    return true;
}

static const char *method_of(const Strips *strips, int run) {
    return run == SHOWN_ENGINE ? "engine" : strips->systems[run - 1]->methods[0];
}

static bool run_method(void *context, int i, Error *error) {
    const Strips *strips = context;
    Method method;
    return method_parse(&method, method_of(strips, i), error) &&
           (strips->runs[i] = simulate(&strips->launched, &method, NULL, error)) != NULL;
}

static bool write_caption(const Strips *strips, const char *stem, const char *name, Error *error) {
    char path[PATH_MAX], line[STRIP_CAPTION_SIZE];
    const int length = snprintf(
        line, sizeof line,
        "A held-out launch of %s.yaml with the bomb from x = %.2f m, at %d moments: the engine above, %s below.\n",
        strips->name, (double)strips->launched.bomb.x.value, MOMENTS, name);
    return file_path(path, sizeof path, error, "%s.txt", stem) && file_write(path, line, (size_t)length, error);
}

static bool draw_strip(const Strips *strips, int system, const char *folder, Error *error) {
    const char *name = strips->systems[system]->name;
    FigureSpec spec = {.width = FIGURE_PAGE_WIDTH,
                       .points = FIGURE_POINTS,
                       .dpi = SKETCH_DPI,
                       .run_count = 2,
                       .runs = {strips->runs[SHOWN_ENGINE], strips->runs[system + 1]},
                       .paths = {"engine", name},
                       .captions = {"engine", name},
                       .view = *strips->view,
                       .time_count = MOMENTS};
    for (int i = 0; i < MOMENTS; i++) spec.times[i] = strips->times[i];
    char stem[PATH_MAX];
    Sketch sketch = {0};
    const FigureKind *strip = figure_kind("strip", error);
    if (strip == NULL || !file_path(stem, sizeof stem, error, "%s/strip-%s-%s", folder, name, strips->name))
        return false;
    const bool drawn = figure_draw(strip, &sketch, &spec, error) && sketch_draw(&sketch, stem, SKETCH_SVG, error);
    sketch_free(&sketch);
    return drawn && write_caption(strips, stem, name, error);
}

/* Few frames and bodies: some hundred kB. */
static bool write_page(const Strips *strips, const char *folder, Error *error) {
    char path[PATH_MAX];
    PlayerResult result;
    const PlayerOptions options = {.last = -1, .describe = method_describe};
    return file_path(path, sizeof path, error, "%s/strip-%s.html", folder, strips->name) &&
           player_write((const Trajectory *const *)strips->runs, strips->count + 1, &options, path, &result, error);
}

static bool draw_scene(Strips *strips, const char *scenes, const char *folder, Error *error) {
    const ParallelWork running = {run_method, strips};
    bool done = strips_begin(strips, scenes, error) &&
                parallel_for(&running, strips->count + 1, "runs for strips", NULL, error);
    for (int i = 0; done && i < strips->count; i++) done = draw_strip(strips, i, folder, error);
    done = done && write_page(strips, folder, error);
    strips_end(strips);
    return done;
}

bool system_strips_draw(const PaperSystem *const *systems, const char *scenes, bool quick, const char *folder,
                        const Progress *progress, Error *error) {
    int count = 0;
    while (systems[count] != NULL) count++;
    assert(count <= STRIP_SYSTEMS_MAX);
    for (int i = 0; count > 0 && i < STRIP_SCENES; i++) {
        Strips strips = {.systems = systems,
                         .count = count,
                         .name = strip_scene_names[i],
                         .times = quick ? quick_moments : moments,
                         .view = &views[i]};
        if (!progress_report(progress, i, STRIP_SCENES))
            return error_interrupted(error, folder, "stopped; the tables are finished");
        if (!draw_scene(&strips, scenes, folder, error)) return false;
    }
    return true;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What networks of gns cost, whatever they have learned. */
#include "base/base.h"
#include "base/csv.h"
#include "base/machine.h"
#include "engine/engine.h"
#include "learning/gns_training.h"
#include "methods/methods.h"
#include "methods/steppers.h"
#include "nets/kinds.h"
#include "paper/paper.h"
#include "paper/paper_internal.h"
#include "paper/report_internal.h"
#include "runs/runs.h"
#include "scenes/scenes.h"
#include "studies/chart.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct GnsCost {
    int boxes;                 /* of the scene, with the bomb */
    double seconds_a_pass;     /* neighbour search and network for all boxes, one thread */
    double seconds_a_gradient; /* a gradient step of the paper's batch, on all threads */
    double hours;              /* for the paper's number of gradient steps */
} GnsCost;

const double gns_times[GNS_TIMES] = {0.25, 0.5, 0.75, 1, 1.5, 2, 3, 4, 5};

static const double far_enough = 0.5; /* m, as in charts (run_log_moved) */

typedef struct GnsRolloutRollouts {
    const Scene *scene;
    Stepper *teacher;
    World *taught, *learned;
    void *gns;
    bool broken; /* gns came to a state that is NaN or infinite */
    Vec2 *start; /* [2, bodies] places at the launch: of the teacher's run, of gns's */
    int64_t nanoseconds;
} GnsRolloutRollouts;

static bool begin(GnsRolloutRollouts *runs, const char *network, const char *settings, Error *error) {
    Settings given;
    Method teacher;
    runs->start = calloc(2 * (size_t)(runs->scene->body_count + 1), sizeof *runs->start);
    if (runs->start == NULL) return error_memory(error, runs->scene->name);
    if (!settings_parse(&given, settings, stepping_gns.description.settings, "gns", error)) return false;
    if (!settings_default(&given, "network", network))
        return error_input(error, network, "the name is too long for a setting");
    runs->gns = stepping_gns.create(&given, runs->scene, error);
    if (runs->gns == NULL || !method_parse(&teacher, gns_teacher, error)) return false;
    runs->teacher = stepper_create(&teacher, runs->scene, error);
    runs->taught = scene_world(runs->scene, error);
    runs->learned = scene_world(runs->scene, error);
    return runs->teacher != NULL && runs->taught != NULL && runs->learned != NULL;
}

static void end(GnsRolloutRollouts *runs) {
    if (runs->gns != NULL) stepping_gns.destroy(runs->gns);
    stepper_destroy(runs->teacher);
    world_destroy(runs->taught);
    world_destroy(runs->learned);
    free(runs->start);
}

/* A failed step of gns leaves the world as it was, from then on. */
static bool step_learned(GnsRolloutRollouts *runs, int frame, Error *error) {
    Error failure = {0};
    StepMeter meter = {.now = meter_time};
    const Step step = {runs->scene, frame, &meter};
    if (!runs->broken) runs->broken = !stepping_gns.step(runs->gns, runs->learned, &step, &failure);
    if (failure.kind != ERROR_NONE && failure.kind != ERROR_INPUT) return *error = failure, false;
    runs->nanoseconds += meter.solving;
    return frame != runs->scene->bomb.frame || scene_add_bomb(runs->scene, runs->learned, error);
}

static double mean_distance(const GnsRolloutRollouts *runs) {
    const Body *a = world_bodies(runs->taught), *b = world_bodies(runs->learned);
    double sum = 0;
    int count = 0;
    for (int i = 0; i < world_body_count(runs->taught); i++) {
        if (!(a[i].inv_mass > 0)) continue;
        sum += vec2_distance(a[i].position, b[i].position);
        count++;
    }
    return count > 0 ? sum / count : 0;
}

static void note_start(GnsRolloutRollouts *runs) {
    const int count = runs->scene->body_count;
    for (int i = 0; i < count; i++) {
        runs->start[i] = world_bodies(runs->taught)[i].position;
        runs->start[count + i] = world_bodies(runs->learned)[i].position;
    }
}

static double count_moved(const World *world, const Vec2 *start, int count) {
    int moved = 0;
    for (int i = 0; i < count; i++)
        moved += vec2_distance(world_bodies(world)[i].position, start[i]) > far_enough ? 1 : 0;
    return moved;
}

/* Fills the times that have come; all others too after the last frame. */
static void note_times(GnsRollout *rollout, const GnsRolloutRollouts *runs, int frame, int last, int *time) {
    const double seconds = (double)(frame - runs->scene->bomb.frame) * (double)runs->scene->dt;
    const double half = 0.5 * (double)runs->scene->dt;
    for (; *time < GNS_TIMES && (frame == last || seconds >= gns_times[*time] - half); ++*time) {
        rollout->error[*time] = mean_distance(runs);
        rollout->shape[*time] = (double)gns_shape_distance(runs->gns);
    }
}

static bool run(GnsRolloutRollouts *runs, GnsRollout *rollout, Error *error) {
    const Scene *scene = runs->scene;
    const int bodies = scene->body_count;
    int last = scene->bomb.frame + (int)lround(gns_times[GNS_TIMES - 1] / (double)scene->dt), time = 0;
    if (last > scene->frames) last = scene->frames;
    if (scene->bomb.frame == 0) note_start(runs);
    for (int frame = 1; frame <= last; frame++) {
        const Step step = {.scene = scene, .frame = frame};
        if (!simulate_step(runs->teacher, runs->taught, &step, error) || !step_learned(runs, frame, error))
            return false;
        if (frame == scene->bomb.frame) note_start(runs);
        if (frame > scene->bomb.frame) note_times(rollout, runs, frame, last, &time);
    }
    for (int i = 0; i < world_body_count(runs->taught); i++)
        rollout->boxes += world_bodies(runs->taught)[i].inv_mass > 0;
    rollout->moved_teacher = count_moved(runs->taught, runs->start, bodies);
    rollout->moved = count_moved(runs->learned, runs->start + bodies, bodies);
    rollout->seconds_a_step = 1e-9 * (double)runs->nanoseconds / last;
    return true;
}

bool gns_rollout_run(GnsRollout *rollout, const Scene *launched, const char *network, const char *settings,
                     Error *error) {
    GnsRolloutRollouts runs = {.scene = launched};
    *rollout = (GnsRollout){.boxes = 0};
    const bool ok = begin(&runs, network, settings, error) && run(&runs, rollout, error);
    end(&runs);
    return ok;
}

static double since(int64_t begin) { return 1e-9 * (double)(meter_time() - begin); }

/* Weights do not matter for the time; 0 would make all units the same. */
static bool make_net(GnsNet *net, int width, int rounds, Error *error) {
    if (!gns_net_create(net, width, rounds, error)) return false;
    for (int i = 0; i < net->layout.parameters; i++) net->parameters[i] = (float)(i % 7 - 3) / (float)width;
    net->scales = (GnsScales){0.6f, 5, 20, 100, 1000};
    return true;
}

static bool measure(const GnsExamples *examples, GnsNet *net, int steps, GnsCost *cost, Error *error) {
    GnsFit fit;
    double loss;
    bool ok = gns_fit_begin(&fit, examples, net, GNS_PAPER_BATCH, error) && gns_fit_batch(&fit, 0, &loss, error);
    const int64_t begin = meter_time();
    for (int i = 0; ok && i < steps; i++) ok = gns_fit_batch(&fit, (uint64_t)i * GNS_PAPER_BATCH, &loss, error);
    cost->seconds_a_gradient = since(begin) / steps;
    cost->hours = cost->seconds_a_gradient * GNS_PAPER_STEPS / 3600;
    ok = ok && gns_training_time_pass(net, &examples->scenes[0], &cost->seconds_a_pass, &cost->boxes, error);
    gns_fit_free(&fit);
    return ok;
}

/* Measures `count` networks on a launch of a scene; `steps` gradient steps each. */
static bool gns_cost_measure(const char *scene, const int *widths, const int *rounds, int count, int steps,
                             GnsCost *costs, const Progress *progress, Error *error) {
    GnsExamples examples = {.seed = 1};
    Method teacher;
    Scene *read = scene_read(scene, error);
    bool ok = read != NULL && method_parse(&teacher, gns_teacher, error) &&
              gns_examples_add(&examples, read, &teacher, 1, NULL, error);
    for (int i = 0; ok && i < count; i++) {
        GnsNet net;
        ok = make_net(&net, widths[i], rounds[i], error) && measure(&examples, &net, steps, &costs[i], error);
        gns_net_free(&net);
        if (ok && !progress_report(progress, i + 1, count)) ok = error_interrupted(error, "gns", "stopped");
    }
    gns_examples_free(&examples);
    return ok;
}

const char *const gns_measure_words[GNS_MEASURES + 1] = {"rollout", "large", "cost"};

const GnsVariant gns_variants[GNS_VARIANTS] = {{"M = 5", "gns.npz", "", 5},
                                               {"M = 2", "gns-m2.npz", "", 2},
                                               {"M = 1", "gns-m1.npz", "", 1},
                                               {"without noise", "gns-no-noise.npz", "", 5},
                                               {"rigid=off", "gns.npz", "rigid=off", 5}};

static const CsvColumn columns[] = {
    {"measure", CSV_WORD, .offset = offsetof(GnsRow, measure), .words = gns_measure_words, .key = true},
    {"variant", CSV_NAME, .offset = offsetof(GnsRow, variant), .key = true},
    {"scene", CSV_NAME, .offset = offsetof(GnsRow, scene), .key = true},
    {"seconds", CSV_OPTIONAL, .offset = offsetof(GnsRow, seconds), .maximum = 1e6, .key = true},
    {"boxes", CSV_OPTIONAL, .offset = offsetof(GnsRow, boxes), .maximum = 1e6},
    {"error", CSV_OPTIONAL, .offset = offsetof(GnsRow, error), .maximum = 1e30},
    {"shape", CSV_OPTIONAL, .offset = offsetof(GnsRow, shape), .maximum = 1e30},
    {"moved", CSV_OPTIONAL, .offset = offsetof(GnsRow, moved), .maximum = 1e6},
    {"moved_engine", CSV_OPTIONAL, .offset = offsetof(GnsRow, moved_engine), .maximum = 1e6},
    {"ms_step", CSV_OPTIONAL, .offset = offsetof(GnsRow, ms_step), .maximum = 1e12},
    {"ms_gradient", CSV_OPTIONAL, .offset = offsetof(GnsRow, ms_gradient), .maximum = 1e12},
    {"hours", CSV_OPTIONAL, .offset = offsetof(GnsRow, hours), .maximum = 1e12},
};
const CsvLayout gns_table_layout = CSV_LAYOUT("system_gns", columns, GnsRow, .min_rows = 1, .max_rows = GNS_MAX_ROWS);

static const GnsRow empty_row = {.seconds = NAN,
                                 .boxes = NAN,
                                 .error = NAN,
                                 .shape = NAN,
                                 .moved = NAN,
                                 .moved_engine = NAN,
                                 .ms_step = NAN,
                                 .ms_gradient = NAN,
                                 .hours = NAN};

/* Scenes of the rollouts, and of large piles: file below the folder of scenes, name in the table. */
typedef struct Place {
    const char *file, *name;
    int launches, quick_launches;
} Place;

static const Place rollouts[] = {
    {"single.yaml", "single", 8, 1}, {"stack.yaml", "stack", 8, 1}, {"pyramid_settled.yaml", "pyramid_settled", 4, 0}};
static const Place large[] = {{"pyramid.yaml", "pyramid", 2, 1}, {"families/pyramid_18.yaml", "pyramid_18", 4, 0}};

enum { PATH_SIZE = 4096 };

static bool join(char path[PATH_SIZE], const char *folder, const char *name, Error *error) {
    return snprintf(path, PATH_SIZE, "%s/%s", folder, name) < PATH_SIZE ||
           error_input(error, folder, "the name is too long");
}

static Scene *read_scene(const SystemStudy *study, const Place *place, Error *error) {
    char path[PATH_SIZE];
    return join(path, study->scenes, place->file, error) ? scene_read(path, error) : NULL;
}

/* Rollouts of all variants, each launch. */
typedef struct GnsStudyRollouts {
    const SystemStudy *study;
    const Scene *scene;
    const Launch *launches;
    int launch_count;
    GnsRollout *rollouts; /* [GNS_VARIANTS, launch_count] */
} GnsStudyRollouts;

static bool roll(const SystemStudy *study, const Scene *scene, const Launch *launch, const GnsVariant *variant,
                 GnsRollout *rollout, Error *error) {
    char folder[PATH_SIZE], path[PATH_SIZE];
    const Scene launched = launch_scene(scene, launch);
    return join(folder, study->scenes, "networks", error) && join(path, folder, variant->network, error) &&
           gns_rollout_run(rollout, &launched, path, variant->settings, error);
}

static bool roll_one(void *context, int i, Error *error) {
    const GnsStudyRollouts *all = context;
    return roll(all->study, all->scene, &all->launches[i % all->launch_count], &gns_variants[i / all->launch_count],
                &all->rollouts[i], error);
}

static bool print_rollouts(const GnsStudyRollouts *all, const char *scene, int variant, FILE *lines, Error *error) {
    const GnsRollout *runs = all->rollouts + (ptrdiff_t)variant * all->launch_count;
    for (int t = 0; t < GNS_TIMES; t++) {
        GnsRow row = empty_row;
        row.measure = GNS_ROLLOUT;
        row.variant = gns_variants[variant].name;
        row.scene = scene;
        row.seconds = gns_times[t];
        row.boxes = runs[0].boxes;
        row.error = row.shape = 0;
        for (int i = 0; i < all->launch_count; i++) {
            row.error += runs[i].error[t] / all->launch_count;
            row.shape += runs[i].shape[t] / all->launch_count;
        }
        if (!piece_tables_print(lines, &gns_table_layout, -1, &row, error)) return false;
    }
    return true;
}

static bool write_rollouts(const SystemStudy *study, int index, FILE *lines, const Progress *progress, Error *error) {
    const Place *place = &rollouts[index];
    const int count = study->quick ? place->quick_launches : place->launches;
    if (count == 0) return true;
    Scene *scene = read_scene(study, place, error);
    Launch *launches = calloc((size_t)count, sizeof *launches);
    GnsStudyRollouts all = {study, scene, launches, count, calloc((size_t)count * GNS_VARIANTS, sizeof *all.rollouts)};
    bool ok = scene != NULL && ((launches != NULL && all.rollouts != NULL) || error_memory(error, place->name)) &&
              launches_for_scoring(scene, count, launches, error) &&
              parallel_for(&(ParallelWork){roll_one, &all}, count * GNS_VARIANTS, place->name, progress, error);
    for (int v = 0; ok && v < GNS_VARIANTS; v++) ok = print_rollouts(&all, place->name, v, lines, error);
    free(all.rollouts);
    free(launches);
    scene_destroy(scene);
    return ok;
}

/* One after the other, as steps are timed. */
static bool write_large(const SystemStudy *study, int index, FILE *lines, const Progress *progress, Error *error) {
    const Place *place = &large[index];
    const int count = study->quick ? place->quick_launches : place->launches;
    if (count == 0) return true;
    Scene *scene = read_scene(study, place, error);
    Launch *launches = calloc((size_t)count, sizeof *launches);
    bool ok = scene != NULL && (launches != NULL || error_memory(error, place->name)) &&
              launches_for_scoring(scene, count, launches, error);
    GnsRow row = empty_row;
    row.measure = GNS_LARGE;
    row.variant = gns_variants[GNS_SHIPPED].name;
    row.scene = place->name;
    row.seconds = gns_times[GNS_TIMES - 1];
    row.error = row.moved = row.moved_engine = row.ms_step = 0;
    for (int i = 0; ok && i < count; i++) {
        GnsRollout run = {.boxes = 0};
        ok = roll(study, scene, &launches[i], &gns_variants[GNS_SHIPPED], &run, error);
        row.boxes = run.boxes;
        row.error += run.error[GNS_TIMES - 1] / count;
        row.moved += run.moved / count;
        row.moved_engine += run.moved_teacher / count;
        row.ms_step += 1e3 * run.seconds_a_step / count;
        if (ok && !progress_report(progress, i + 1, count)) ok = error_interrupted(error, place->name, "stopped");
    }
    ok = ok && piece_tables_print(lines, &gns_table_layout, -1, &row, error);
    free(launches);
    scene_destroy(scene);
    return ok;
}

static bool write_cost(const SystemStudy *study, int index, FILE *lines, const Progress *progress, Error *error) {
    static const int widths[] = {16, 128}, rounds[] = {5, 10};
    static const Place place = {"pyramid_settled.yaml", "pyramid_settled", 1, 1};
    GnsCost costs[2];
    char path[PATH_SIZE], name[CSV_NAME_SIZE];
    (void)index;
    if (!join(path, study->scenes, place.file, error) ||
        !gns_cost_measure(path, widths, rounds, 2, study->quick ? 1 : 10, costs, progress, error))
        return false;
    for (int i = 0; i < 2; i++) {
        GnsRow row = empty_row;
        snprintf(name, sizeof name, "width %d, M = %d", widths[i], rounds[i]);
        row.measure = GNS_COST;
        row.variant = name;
        row.scene = place.name;
        row.boxes = costs[i].boxes;
        row.ms_step = 1e3 * costs[i].seconds_a_pass;
        row.ms_gradient = 1e3 * costs[i].seconds_a_gradient;
        row.hours = costs[i].hours;
        if (!piece_tables_print(lines, &gns_table_layout, -1, &row, error)) return false;
    }
    return true;
}

static const SystemPart parts[] = {{"rollouts-single", .weight = 2, .quick_weight = 0.3, .write = write_rollouts},
                                   {"rollouts-stack", 10, 0.7, 1, write_rollouts, false},
                                   {"rollouts-pyramid", 30, 0, 2, write_rollouts, false},
                                   {"large-66", 8, 0.5, 0, write_large, true},
                                   {"large-171", 8, 0, 1, write_large, true},
                                   {"cost", 8, 0.5, 0, write_cost, true},
                                   {0}};

const PaperSystem system_gns = {.name = "gns",
                                .methods = SYSTEM_METHODS("gns", "gns:rigid=off", "gns:net=off"),
                                .table = &gns_table_layout,
                                .parts = parts,
                                .claims = gns_claims,
                                .plot = plot_gns};

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The study of gns: rollouts beside the taught runs, and what networks cost, whatever they have learned. */
#include "base/base.h"
#include "base/csv.h"
#include "base/file.h"
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
#include "studies/meter.h"
#include "studies/piece_tables.h"

#include <math.h>
#include <stdlib.h>

/* s after the bomb's launch */
static const double gns_times[GNS_TIMES] = {0.25, 0.5, 0.75, 1, 1.5, 2, 3, 4, 5};

static const double far_enough = 0.5; /* m, as in charts (run_log_moved) */

typedef struct Runs {
    const Scene *scene;
    Stepper *teacher;
    World *taught, *learned;
    void *gns;
    bool broken; /* gns came to a state that is NaN or infinite */
    Vec2 *start; /* [2, bodies] places at the launch: of the teacher's run, of gns's */
    int64_t nanoseconds;
} Runs;

static bool gns_study_begin(Runs *runs, const char *network, const char *settings, Error *error) {
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

static void gns_study_end(Runs *runs) {
    if (runs->gns != NULL) stepping_gns.destroy(runs->gns);
    stepper_destroy(runs->teacher);
    world_destroy(runs->taught);
    world_destroy(runs->learned);
    free(runs->start);
}

/* A failed step of gns leaves the world as it was, from then on. */
static bool step_learned(Runs *runs, int frame, Error *error) {
    Error failure = {0};
    StepMeter meter = {.now = meter_time};
    const Step step = {.scene = runs->scene, .frame = frame, .meter = &meter};
    if (!runs->broken) runs->broken = !stepping_step(&stepping_gns, runs->gns, runs->learned, &step, &failure);
    if (failure.kind != ERROR_NONE && failure.failure == FAILURE_NONE) return *error = failure, false;
    runs->nanoseconds += meter.solving;
    return frame != runs->scene->bomb.frame || scene_add_bomb(runs->scene, runs->learned, error);
}

static double mean_distance(const Runs *runs) {
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

static void note_start(Runs *runs) {
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
static void note_times(GnsRollout *rollout, const Runs *runs, int frame, int last, int *time) {
    const double seconds = (double)(frame - runs->scene->bomb.frame) * (double)runs->scene->dt;
    const double half = 0.5 * (double)runs->scene->dt;
    for (; *time < GNS_TIMES && (frame == last || seconds >= gns_times[*time] - half); ++*time) {
        rollout->error[*time] = mean_distance(runs);
        rollout->shape[*time] = (double)gns_shape_distance(runs->gns);
    }
}

static bool gns_study_run(Runs *runs, GnsRollout *rollout, Error *error) {
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
    Runs runs = {.scene = launched};
    *rollout = (GnsRollout){.boxes = 0};
    const bool ok = gns_study_begin(&runs, network, settings, error) && gns_study_run(&runs, rollout, error);
    gns_study_end(&runs);
    return ok;
}

/* Weights do not matter for the time; 0 would make all units the same. */
static bool make_net(GnsNet *net, int width, int rounds, Error *error) {
    if (!gns_net_create(net, width, rounds, error)) return false;
    for (int i = 0; i < net->layout.parameters; i++) net->parameters[i] = (float)(i % 7 - 3) / (float)width;
    net->scales = (GnsScales){0.6f, 5, 20, 100, 1000};
    return true;
}

/* Time of a pass for all boxes on one thread, and of a gradient step of the paper's batch on all threads. */
static bool gns_study_measure(const GnsExamples *examples, GnsNet *net, int steps, GnsRow *row, Error *error) {
    GnsFit fit;
    double loss, pass = 0;
    int boxes = 0;
    bool ok = gns_fit_begin(&fit, examples, net, GNS_PAPER_BATCH, error) && gns_fit_batch(&fit, 0, &loss, error);
    const int64_t begin = meter_time();
    for (int i = 0; ok && i < steps; i++) ok = gns_fit_batch(&fit, (uint64_t)i * GNS_PAPER_BATCH, &loss, error);
    const double gradient = 1e-9 * (double)(meter_time() - begin) / steps;
    ok = ok && gns_training_time_pass(net, &examples->scenes[0], &pass, &boxes, error);
    row->boxes = boxes;
    row->ms_step = 1e3 * pass;
    row->ms_gradient = 1e3 * gradient;
    row->hours = gradient * GNS_PAPER_STEPS / 3600;
    gns_fit_free(&fit);
    return ok;
}

static const char *const gns_measure_words[GNS_MEASURES + 1] = {"rollout", "large", "cost"};

const GnsVariant gns_variants[GNS_VARIANTS] = {{"M = 5", "gns.npz", "", 5},
                                               {"M = 2", "gns-m2.npz", "", 2},
                                               {"M = 1", "gns-m1.npz", "", 1},
                                               {"without noise", "gns-no-noise.npz", "", 5},
                                               {"rigid=off", "gns.npz", "rigid=off", 5}};

static const CsvColumn columns[] = {
    CSV_MEMBER(GnsRow, measure, CSV_WORD, .words = gns_measure_words, .key = true),
    CSV_MEMBER(GnsRow, variant, CSV_NAME, .key = true),
    CSV_MEMBER(GnsRow, scene, CSV_NAME, .key = true),
    CSV_MEMBER(GnsRow, seconds, CSV_OPTIONAL, .maximum = 1e6, .key = true),
    CSV_MEMBER(GnsRow, boxes, CSV_OPTIONAL, .maximum = 1e6),
    CSV_MEMBER(GnsRow, error, CSV_OPTIONAL, .maximum = 1e30),
    CSV_MEMBER(GnsRow, shape, CSV_OPTIONAL, .maximum = 1e30),
    CSV_MEMBER(GnsRow, moved, CSV_OPTIONAL, .maximum = 1e6),
    CSV_MEMBER(GnsRow, moved_engine, CSV_OPTIONAL, .maximum = 1e6),
    CSV_MEMBER(GnsRow, ms_step, CSV_OPTIONAL, .maximum = 1e12),
    CSV_MEMBER(GnsRow, ms_gradient, CSV_OPTIONAL, .maximum = 1e12),
    CSV_MEMBER(GnsRow, hours, CSV_OPTIONAL, .maximum = 1e12),
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

static Scene *read_scene(const SystemStudy *study, const Place *place, Error *error) {
    char path[CSV_PATH_SIZE];
    return file_path(path, sizeof path, error, "%s/%s", study->scenes, place->file) ? scene_read(path, error) : NULL;
}

/* Rollouts of all variants, each launch. */
typedef struct Rollouts {
    const SystemStudy *study;
    const Scene *scene;
    const Launch *launches;
    int launch_count;
    GnsRollout *rollouts; /* [GNS_VARIANTS, launch_count] */
} Rollouts;

static bool roll(const SystemStudy *study, const Scene *scene, const Launch *launch, const GnsVariant *variant,
                 GnsRollout *rollout, Error *error) {
    char path[CSV_PATH_SIZE];
    const Scene launched = launch_scene(scene, launch);
    return file_path(path, sizeof path, error, "%s/networks/%s", study->scenes, variant->network) &&
           gns_rollout_run(rollout, &launched, path, variant->settings, error);
}

static bool roll_one(void *context, int i, Error *error) {
    const Rollouts *all = context;
    return roll(all->study, all->scene, &all->launches[i % all->launch_count], &gns_variants[i / all->launch_count],
                &all->rollouts[i], error);
}

static bool print_rollouts(const Rollouts *all, const char *scene, int variant, FILE *lines, Error *error) {
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
    Rollouts all = {study, scene, launches, count, calloc((size_t)count * GNS_VARIANTS, sizeof *all.rollouts)};
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
    GnsExamples examples = {.seed = 1};
    Method teacher;
    (void)index;
    Scene *scene = read_scene(study, &place, error);
    bool ok = scene != NULL && method_parse(&teacher, gns_teacher, error) &&
              gns_examples_add(&examples, scene, &teacher, 1, NULL, error);
    for (int i = 0; ok && i < 2; i++) {
        char name[CSV_NAME_SIZE];
        GnsNet net;
        GnsRow row = empty_row;
        snprintf(name, sizeof name, "width %d, M = %d", widths[i], rounds[i]);
        row.measure = GNS_COST;
        row.variant = name;
        row.scene = place.name;
        ok = make_net(&net, widths[i], rounds[i], error) &&
             gns_study_measure(&examples, &net, study->quick ? 1 : 10, &row, error);
        gns_net_free(&net);
        if (ok && !progress_report(progress, i + 1, 2)) ok = error_interrupted(error, "gns", "stopped");
        ok = ok && piece_tables_print(lines, &gns_table_layout, -1, &row, error);
    }
    gns_examples_free(&examples);
    return ok;
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

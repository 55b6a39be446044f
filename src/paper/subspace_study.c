/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The study of subspace: errors and times of its sizes beside those of the engines that it replaces. */
#include "base/base.h"
#include "base/csv.h"
#include "base/file.h"
#include "base/machine.h"
#include "learning/subspace_training.h"
#include "methods/methods.h"
#include "nets/kinds.h"
#include "paper/paper.h"
#include "paper/paper_internal.h"
#include "paper/report_internal.h"
#include "scenes/scenes.h"
#include "studies/contenders.h"
#include "studies/frozen.h"
#include "studies/piece_tables.h"
#include "studies/timing.h"

#include <math.h>
#include <string.h>

enum {
    ENGINES = 3,
    METHODS_MAX = ENGINES + SUBSPACE_PREDICTORS_MAX,
    LAUNCHES = 20,
    QUICK_LAUNCHES = 2,
    QUICK_FRAMES = 60
};

static const char *const engines[ENGINES] = {SUBSPACE_STUDY_OFFLINE, SUBSPACE_OFFLINE, "engine"};

/* A scene's measurements in progress. */
typedef struct Measured {
    int scene, count;
    Launched launched;
    Launch launches[LAUNCHED_MAX];
    SubspaceNet *net;
    PoseRows rows; /* of the offline engine's runs */
    Contender contenders[METHODS_MAX];
    double us_step[METHODS_MAX];
} Measured;

/* Each predictor of the file has a run: the setting asks for as many components or more. */
static bool add_methods(Measured *measured, Error *error) {
    for (; measured->count < ENGINES; measured->count++)
        if (!method_parse(&measured->contenders[measured->count].method, engines[measured->count], error)) return false;
    for (int i = 0; i < measured->net->shape.predictor_count && i < SUBSPACE_PREDICTORS_MAX; i++) {
        static const int asked[SUBSPACE_PREDICTORS_MAX] = {8, 32, SUBSPACE_COMPONENTS_MAX};
        char text[METHOD_TEXT_SIZE];
        snprintf(text, sizeof text, "subspace:components=%d", asked[i]);
        if (!method_parse(&measured->contenders[measured->count++].method, text, error)) return false;
    }
    return true;
}

static bool measured_begin(Measured *measured, const SystemStudy *study, int scene, Error *error) {
    char path[PAPER_PATH_SIZE];
    *measured = (Measured){.scene = scene};
    if (!file_path(path, sizeof path, error, "%s/%s.yaml", study->scenes, paper_scene_names[scene]) ||
        !launched_begin(&measured->launched, path, study->quick ? QUICK_LAUNCHES : LAUNCHES, error))
        return false;
    Scene *all = measured->launched.scene;
    const int most = all->bomb.frame + QUICK_FRAMES;
    if (study->quick && all->frames > most) all->frames = most;
    for (int i = 0; i < measured->launched.count; i++) {
        measured->launched.launches[i].frames = all->frames;
        measured->launches[i] = launch_of(&measured->launched.launches[i]);
    }
    const char *network = scene_network(all, "subspace");
    if (network == NULL) return true; /* it has no rows */
    measured->net = subspace_net_read(network, error);
    return measured->net != NULL && add_methods(measured, error);
}

static void measured_end(Measured *measured) {
    pose_rows_free(&measured->rows);
    subspace_net_destroy(measured->net);
    launched_free(&measured->launched);
}

/* Each method by itself: a slow one would let the others' data leave the caches. */
static bool time_methods(Measured *measured, bool quick, Error *error) {
    const Scene *launched = &measured->launched.launches[0];
    for (int i = 0; i < measured->count; i++) {
        const Contender *contender = &measured->contenders[i];
        StepCost closed[1][PHASES];
        if (!timing_of_launch(&contender, 1, launched, launched->frames, quick ? 1 : 5, closed, error)) return false;
        measured->us_step[i] = step_cost_mean(closed[0], contender->method.kind->description->no_contacts);
    }
    return true;
}

/* Its own runs, as an engine's: chaos alone takes them apart. */
static bool fill_engine(const Measured *measured, SubspaceStudyRow *row, const Progress *progress, Error *error) {
    PoseRows rows;
    SubspaceErrors errors = {NAN, NAN};
    const bool ok = subspace_record(&rows, measured->launched.scene, row->method, measured->launches,
                                    measured->launched.count, progress, error) &&
                    subspace_distance(&measured->rows, &rows, &errors, error);
    row->rms = errors.rms, row->frames_near = errors.frames;
    pose_rows_free(&rows);
    return ok;
}

static bool fill_subspace(const Measured *measured, int predictor, SubspaceStudyRow *row, Error *error) {
    SubspaceScore score;
    if (!subspace_score(measured->net, &measured->net->predictors[predictor], &measured->rows, &score, error))
        return false;
    row->components = score.components;
    row->rms = score.net.rms, row->frames_near = score.net.frames;
    row->floor_rms = score.floor.rms, row->floor_near = score.floor.frames;
    row->linear_rms = score.linear.rms, row->linear_near = score.linear.frames;
    return true;
}

static bool write_rows(const Measured *measured, FILE *lines, const Progress *progress, Error *error) {
    for (int i = 0; i < measured->count; i++) {
        SubspaceStudyRow row = {.scene = measured->scene,
                                .method = measured->contenders[i].method.text,
                                .launches = measured->launched.count,
                                .frames = measured->rows.states - 2,
                                .us_step = measured->us_step[i],
                                .floor_rms = NAN,
                                .floor_near = NAN,
                                .linear_rms = NAN,
                                .linear_near = NAN};
        if (!(i < ENGINES ? fill_engine(measured, &row, progress, error)
                          : fill_subspace(measured, i - ENGINES, &row, error)) ||
            !piece_tables_print(lines, &subspace_study_layout, -1, &row, error))
            return false;
    }
    return true;
}

static bool write_scene(const SystemStudy *study, int index, FILE *lines, const Progress *progress, Error *error) {
    Measured measured;
    bool ok = measured_begin(&measured, study, index, error);
    if (ok && measured.net != NULL)
        ok = subspace_record(&measured.rows, measured.launched.scene, SUBSPACE_OFFLINE, measured.launches,
                             measured.launched.count, progress, error) &&
             time_methods(&measured, study->quick, error) && write_rows(&measured, lines, progress, error);
    measured_end(&measured);
    return ok;
}

const SubspaceStudyRow *subspace_study_find(const SubspaceStudyRow *rows, int count, int scene, const char *method) {
    for (int i = 0; i < count; i++)
        if (rows[i].scene == scene && strcmp(rows[i].method, method) == 0) return &rows[i];
    return NULL;
}

#define MOST 1e30
#define COLUMN(kind, member, ...) CSV_MEMBER(SubspaceStudyRow, member, kind, __VA_ARGS__)

static const CsvColumn columns[] = {
    COLUMN(CSV_WORD, scene, .words = paper_scene_names, .key = true),
    COLUMN(CSV_TEXT, method, .maximum = METHOD_TEXT_SIZE, .key = true),
    COLUMN(CSV_NUMBER, components, .maximum = SUBSPACE_COMPONENTS_MAX),
    COLUMN(CSV_NUMBER, launches, .minimum = 1, .maximum = LAUNCHED_MAX),
    COLUMN(CSV_NUMBER, frames, .maximum = 1e6),
    COLUMN(CSV_OPTIONAL, us_step, .maximum = MOST),
    COLUMN(CSV_NUMBER, rms, .maximum = MOST),
    COLUMN(CSV_NUMBER, frames_near, .maximum = 1e6),
    COLUMN(CSV_OPTIONAL, floor_rms, .maximum = MOST),
    COLUMN(CSV_OPTIONAL, floor_near, .maximum = 1e6),
    COLUMN(CSV_OPTIONAL, linear_rms, .maximum = MOST),
    COLUMN(CSV_OPTIONAL, linear_near, .maximum = 1e6),
};
const CsvLayout subspace_study_layout =
    CSV_LAYOUT("system_subspace", columns, SubspaceStudyRow, .min_rows = 0, .max_rows = SUBSPACE_STUDY_ROWS_MAX);

static const SystemPart parts[] = {
    {"subspace-single", .weight = 1, .quick_weight = 0.1, .index = 0, .write = write_scene, .timed = true},
    {"subspace-stack", .weight = 3, .quick_weight = 0.2, .index = 1, .write = write_scene, .timed = true},
    {"subspace-pyramid", .weight = 15, .quick_weight = 0.5, .index = 2, .write = write_scene, .timed = true},
    {"subspace-pyramid_settled", .weight = 20, .quick_weight = 0.8, .index = 3, .write = write_scene, .timed = true},
    {0}};

const PaperSystem system_subspace = {
    .name = "subspace",
    .methods = SYSTEM_METHODS("subspace", "subspace:net=off", "subspace:components=8", "subspace:components=128"),
    .table = &subspace_study_layout,
    .parts = parts,
    .claims = subspace_claims,
    .plot = plot_subspace};

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A scene of the study: its launches and contenders, and its pieces: a launch with all methods, and the times of all
   methods. */
#include "base/base.h"
#include "base/machine.h"
#include "methods/methods.h"
#include "runs/launch_check.h"
#include "runs/runs.h"
#include "scenes/scenes.h"
#include "studies/chart_table.h"
#include "studies/contenders.h"
#include "studies/launch_scores.h"
#include "studies/rollout.h"
#include "studies/scene_study.h"
#include "studies/timing.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

/* The launches of a scene with a bomb; *count is `standard` if the choice leaves it open. To be freed by the caller.
   NULL with error set for a table or a family that does not fit the scene, and for launches that launches_check()
   refuses. */
static Launch *choose_launches(const LaunchChoice *choice, const Scene *scene, int standard, int *count, Error *error) {
    LaunchTable table = {0};
    if (choice->table != NULL && !launches_read(&table, choice->table, error)) return NULL;
    *count = choice->table != NULL      ? table.count
             : choice->bomb_x.count > 0 ? choice->bomb_x.count
             : choice->count > 0        ? choice->count
                                        : standard;
    Launch *launches = malloc((size_t)*count * sizeof *launches);
    bool ok = launches != NULL || error_memory(error, "launches");
    if (ok && choice->table != NULL)
        ok = launches_for(&table, scene, launches, error);
    else if (ok && choice->bomb_x.count > 0)
        for (int i = 0; i < *count; i++) {
            launches[i] = launch_of(scene);
            launches[i].x = range_value(&choice->bomb_x, i);
        }
    else if (ok)
        ok = launches_for_scoring(scene, *count, launches, error);
    launches_free(&table);
    ok = ok && launches_check(scene, launches, *count, error);
    if (ok) return launches;
    free(launches);
    return NULL;
}

/* A step takes time in proportion to its bodies, its converged solution even more. So larger scenes have fewer launches
   and fewer scored steps after the impact. */
static StudySize size_for(const StudySize *full, const Scene *scene) {
    enum { SMALL = 110, LEAST_LAUNCHES = 4, LEAST_TIMED = 2 }; /* SMALL: bodies */
    StudySize size = *full;
    if (scene->body_count <= SMALL) return size;
    const int launches = size.launches * SMALL / scene->body_count,
              timed = size.timed_launches * SMALL / scene->body_count;
    size.closed.after *= 2;
    size.closed.rest *= 4;
    size.launches = launches > LEAST_LAUNCHES ? launches : LEAST_LAUNCHES;
    size.timed_launches = timed > LEAST_TIMED ? timed : LEAST_TIMED;
    return size;
}

/* Of a contender, for the thread that has locked it. */
struct SharedStepper {
    omp_lock_t taken;
    Stepper *stepper;   /* NULL: not made yet */
    SharedSteps shared; /* the first steps of all launches */
};

static bool try_launch(void *context, int i, Error *error) {
    SceneStudy *study = context;
    const Scene launched = launch_scene(study->scene, &study->launches[i]);
    return launch_find_touch(&launched, "engine", &study->striking[i], error);
}

static bool begin(SceneStudy *study, const char *path, const ContenderList *contenders, const LaunchChoice *launches,
                  Error *error) {
    const Scene *scene = study->scene;
    if (!scene->bomb.present) return error_input(error, path, "the scene has no bomb");
    study->contenders = malloc((size_t)(contenders->count + 1) * sizeof *study->contenders);
    if (study->contenders == NULL) return error_memory(error, "study");
    study->contender_count = contenders_for(contenders, scene, study->contenders);
    for (int i = 0; i < study->contender_count; i++)
        study->no_push_out |= study->contenders[i]->method.kind->description->no_push_out;
    study->steppers = calloc((size_t)study->contender_count + 1, sizeof *study->steppers);
    if (study->steppers == NULL) return error_memory(error, "study");
    for (int i = 0; i < study->contender_count; i++) omp_init_lock(&study->steppers[i].taken);
    study->launches = choose_launches(launches, scene, study->size.launches, &study->launch_count, error);
    if (study->launches == NULL) return false;
    study->shared_steps = scene->frames;
    for (int i = 0; i < study->launch_count; i++)
        if (study->launches[i].frame <= study->shared_steps)
            study->shared_steps = study->launches[i].frame > 0 ? study->launches[i].frame - 1 : 0;
    /* The launches that strike a box: only these have times of an impact. */
    const ParallelWork tries = {try_launch, study};
    study->striking = calloc((size_t)study->launch_count, sizeof *study->striking);
    if (study->striking == NULL) return error_memory(error, "study");
    if (!parallel_for(&tries, study->launch_count, scene->name, NULL, error)) return false;
    for (int i = 0; i < study->launch_count; i++)
        if (study->striking[i] > 0) study->striking[study->striking_count++] = i;
    return study->striking_count > 0 || launches_refuse_misses(scene, study->launches, study->launch_count, error);
}

bool scene_study_begin(SceneStudy *study, const char *path, const ContenderList *contenders,
                       const LaunchChoice *launches, const StudySize *size, Error *error) {
    *study = (SceneStudy){.scene = scene_read(path, error)};
    if (study->scene == NULL) return false;
    study->size = size_for(size, study->scene);
    if (begin(study, path, contenders, launches, error)) return true;
    scene_study_end(study);
    return false;
}

void scene_study_rest(SceneStudy *study) {
    for (int i = 0; study->steppers != NULL && i < study->contender_count; i++) {
        stepper_destroy(study->steppers[i].stepper);
        study->steppers[i].stepper = NULL;
        shared_steps_free(&study->steppers[i].shared);
    }
}

void scene_study_end(SceneStudy *study) {
    scene_study_rest(study);
    for (int i = 0; study->steppers != NULL && i < study->contender_count; i++)
        omp_destroy_lock(&study->steppers[i].taken);
    free(study->steppers);
    shared_steps_free(&study->converged);
    free(study->launches);
    free(study->striking);
    free(study->contenders);
    scene_destroy(study->scene);
    *study = (SceneStudy){0};
}

int scene_study_timed(const SceneStudy *study) {
    const int most = study->size.timed_launches;
    return most < study->striking_count ? most : study->striking_count;
}

/* A launch with all methods. */

typedef struct LaunchPiece {
    SceneStudy *study;
    Scene launched;
    Rollout converged;
    SnapshotList snapshots;
    LaunchSteps steps;
    int first;            /* contender that is tried first */
    bool *chosen;         /* [contenders] */
    LaunchScores *scores; /* [contenders] */
} LaunchPiece;

/* Made when it is first needed. For the thread that has locked the contender, or for a piece that runs alone. */
static Stepper *stepper_of(SceneStudy *study, int contender, Error *error) {
    Stepper **stepper = &study->steppers[contender].stepper;
    if (*stepper == NULL) *stepper = stepper_create(&study->contenders[contender]->method, study->scene, error);
    return *stepper;
}

/* Scores a contender of those that are left: the first from piece->first on that no other thread uses, or else one that
   it waits for. */
static bool score(void *context, int i, Error *error) {
    (void)i;
    LaunchPiece *piece = context;
    SceneStudy *study = piece->study;
    int contender = -1;
    bool free = false;
#pragma omp critical(study_steppers)
    {
        for (int k = 0; !free && k < study->contender_count; k++) {
            const int next = (piece->first + k) % study->contender_count;
            if (piece->chosen[next]) continue;
            free = omp_test_lock(&study->steppers[next].taken) != 0;
            if (free || contender < 0) contender = next;
        }
        piece->chosen[contender] = true;
    }
    struct SharedStepper *own = &study->steppers[contender];
    if (!free) omp_set_lock(&own->taken);
    LaunchScores *scores = &piece->scores[contender];
    Stepper *stepper = stepper_of(study, contender, error);
    Rollout rollout = {0};
    bool ok = stepper != NULL;
    if (study->shared_steps > 0 && contender_shares(study->contenders[contender])) {
        ok = ok &&
             shared_steps_run(&own->shared, stepper, &piece->launched, study->shared_steps, &study->size.closed, error);
        rollout.shared = &own->shared;
    }
    ok = ok &&
         rollout_run(&rollout, stepper, &piece->launched, &study->size.closed, scores->steps[PROTOCOL_CLOSED], error);
    if (ok) scores->measures = run_measures(&rollout.log, &piece->converged.log, &piece->launched);
    if (ok && !stepper_describe(stepper)->whole_scenes)
        ok = snapshots_score(&piece->snapshots, stepper, rollout.world, scores->steps[PROTOCOL_FROZEN], error);
    scores->unconverged = rollout.unconverged;
    rollout_free(&rollout);
    omp_unset_lock(&own->taken);
    return ok;
}

static bool run_converged(LaunchPiece *piece, Error *error) {
    SceneStudy *study = piece->study;
    Method method;
    Stepper *stepper = method_parse(&method, "reference", error) ? stepper_create(&method, study->scene, error) : NULL;
    bool ok = stepper != NULL;
    if (ok && study->shared_steps > 0) {
#pragma omp critical(converged_runs)
        ok = shared_steps_run(&study->converged, stepper, &piece->launched, study->shared_steps, NULL, error);
        piece->converged.shared = &study->converged;
    }
    piece->converged.floors = piece->steps.floors[PROTOCOL_CLOSED];
    ok = ok && rollout_run(&piece->converged, stepper, &piece->launched, &study->size.closed, NULL, error);
    stepper_destroy(stepper);
    return ok;
}

bool launch_piece_write(SceneStudy *study, int launch, FILE *results, const Progress *progress, Error *error) {
    const size_t count = (size_t)study->contender_count + 1;
    const double converged_share = 0.2;       /* about that of the piece that its converged run takes */
    const double golden = 0.6180339887498949; /* neighbouring launches, which run at once, begin far apart */
    LaunchPiece piece = {.study = study,
                         .launched = launch_scene(study->scene, &study->launches[launch]),
                         .snapshots = {.no_push_out = study->no_push_out},
                         .first = (int)(fmod(launch * golden, 1) * study->contender_count),
                         .chosen = calloc(count, sizeof *piece.chosen),
                         .scores = calloc(count, sizeof *piece.scores)};
    piece.snapshots.floors = piece.steps.floors[PROTOCOL_FROZEN];
    ProgressStage stage = {progress, converged_share, 1 - converged_share, false};
    bool ok = (piece.chosen != NULL && piece.scores != NULL) || error_memory(error, "study");
    ok = ok && run_converged(&piece, error) &&
         snapshots_add(&piece.snapshots, &piece.launched, &study->size.frozen, error) &&
         parallel_for(&(ParallelWork){score, &piece}, study->contender_count, study->scene->name,
                      &(Progress){progress_stage, &stage}, error);
    piece.steps.unconverged = piece.snapshots.unconverged;
    piece.steps.run_unconverged = piece.converged.log.unconverged;
    if (ok) launch_scores_write(results, piece.scores, study->contender_count, &piece.steps);
    for (int i = 0; piece.scores != NULL && i < study->contender_count; i++) launch_scores_free(&piece.scores[i]);
    rollout_free(&piece.converged);
    snapshots_free(&piece.snapshots);
    free(piece.chosen);
    free(piece.scores);
    return ok;
}

bool scene_times_write(SceneStudy *study, FILE *results, const Progress *progress, Error *error) {
    const int count = scene_study_timed(study), contenders = study->contender_count;
    Scene *launches = calloc((size_t)count, sizeof *launches);
    Stepper **steppers = calloc((size_t)contenders + 1, sizeof *steppers);
    SnapshotList frozen = {0};
    StepCost(*costs[PROTOCOLS])[PHASES];
    bool ok = launches != NULL && steppers != NULL;
    for (int p = 0; p < PROTOCOLS; p++)
        ok = (costs[p] = calloc((size_t)contenders + 1, sizeof *costs[p])) != NULL && ok;
    if (!ok) error_memory(error, "study");
    for (int i = 0; ok && i < count; i++) {
        const int launch = study->striking[(2 * i + 1) * study->striking_count / (2 * count)];
        launches[i] = launch_scene(study->scene, &study->launches[launch]);
        ok = snapshots_add(&frozen, &launches[i], &study->size.frozen, error);
    }
    for (int i = 0; ok && i < contenders; i++) ok = (steppers[i] = stepper_of(study, i, error)) != NULL;
    const TimingOptions options = {.launches = launches,
                                   .launch_count = count,
                                   .repetitions = study->size.repetitions,
                                   .last_frame = study->scene->frames,
                                   .shared_steps = study->shared_steps,
                                   .steppers = steppers};
    ok = ok && timing_measure(study->contenders, contenders, &options, &frozen, costs[PROTOCOL_CLOSED],
                              costs[PROTOCOL_FROZEN], progress, error);
    for (int i = 0; ok && i < contenders; i++)
        for (int p = 0; p < PROTOCOLS; p++)
            for (int phase = 0; phase < PHASES; phase++) {
                const StepCost *cost = &costs[p][i][phase];
                const double stored[] = {cost->solver, cost->step, cost->engine};
                fwrite(stored, sizeof stored, 1, results);
            }
    for (int p = 0; p < PROTOCOLS; p++) free(costs[p]);
    snapshots_free(&frozen);
    free(steppers);
    free(launches);
    return ok;
}

MethodTimes *scene_times_read(const SceneStudy *study, const char *path, const char *bytes, size_t size, Error *error) {
    double stored[3];
    const size_t count = (size_t)study->contender_count;
    MethodTimes *times = calloc(count + 1, sizeof *times);
    if (times == NULL) return error_memory(error, path), NULL;
    bool whole = size == count * PROTOCOLS * PHASES * sizeof stored;
    for (size_t i = 0; whole && i < count * PROTOCOLS * PHASES; i++) {
        memcpy(stored, bytes + i * sizeof stored, sizeof stored);
        StepCost *cost = &times[i / (PROTOCOLS * PHASES)].costs[i / PHASES % PROTOCOLS][i % PHASES];
        *cost = (StepCost){.solver = stored[0], .step = stored[1], .engine = stored[2]};
        /* What chart.csv can have; NAN is no time. */
        whole = !(cost->solver < 0) && !(cost->step < 0) && !(cost->engine < 0);
    }
    if (whole) return times;
    error_input(error, path, "is no result of times; delete it, and run the command again");
    free(times);
    return NULL;
}

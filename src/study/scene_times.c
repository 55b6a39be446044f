/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/scene_times.h"

#include "common/array.h"
#include "common/parallel.h"
#include "simulate/simulate.h"

#include <stdlib.h>
#include <string.h>

/* About the share of the time that preparations take. */
static const double prepared_share = 0.1;

/* Frames of a run behind the phase "after", so that all three phases are timed. */
enum { FRAMES_BEHIND = 20 };

typedef struct Timed {
    SnapshotList snapshots;
    int touch; /* of the converged run */
} Timed;

typedef struct SceneTimes {
    const SceneStudy *study;
    int count;
    Timed *timed;    /* [count] */
    Scene *launches; /* [count] */
    SnapshotList snapshots;
    StepCost (*costs[PROTOCOLS])[PHASES]; /* [contenders] */
} SceneTimes;

/* The first step in which the bomb touches a box in the converged run; 0 if it does not, or if the state becomes NaN or
   infinite before. */
static bool find_touch(const Scene *launched, int *touch, Error *error) {
    Method method;
    Error failure = {0};
    PhaseTracker tracker = {.impact_frames = launched->bomb.impact_frames};
    Stepper *stepper = method_parse(&method, "reference", error) ? stepper_create(&method, launched, error) : NULL;
    World *world = stepper != NULL ? scene_world(launched, error) : NULL;
    bool ok = world != NULL;
    for (int frame = 1; ok && tracker.touch == 0 && frame <= launched->frames; frame++) {
        ok = simulate_step(stepper, world, &(Step){.scene = launched, .frame = frame}, &failure);
        if (ok) phase_next(&tracker, world_problem(world), frame);
    }
    *touch = tracker.touch;
    world_destroy(world);
    stepper_destroy(stepper);
    if (failure.kind == ERROR_NONE) return ok;
    *error = failure;
    return failure.kind == ERROR_INPUT;
}

static bool prepare_launch(void *context, int i, Error *error) {
    SceneTimes *times = context;
    Timed *timed = &times->timed[i];
    const SceneStudy *study = times->study;
    Scene *launched = &times->launches[i];
    *launched = scene_study_launch(study, (2 * i + 1) * study->launch_count / (2 * times->count)); /* spread evenly */
    return find_touch(launched, &timed->touch, error) &&
           snapshots_add(&timed->snapshots, launched, &study->size.frozen, error);
}

/* Moves the frozen steps of all launches into one list. */
static bool gather_snapshots(SceneTimes *times, Error *error) {
    SnapshotList *all = &times->snapshots;
    for (int i = 0; i < times->count; i++) {
        SnapshotList *list = &times->timed[i].snapshots;
        if (!array_reserve((void **)&all->items, &all->capacity, (size_t)(all->count + list->count) + 1,
                           sizeof *all->items))
            return error_memory(error, "study");
        if (list->count > 0) memcpy(all->items + all->count, list->items, (size_t)list->count * sizeof *all->items);
        all->count += list->count;
        list->count = 0;
    }
    return true;
}

static int last_frame(const SceneTimes *times) {
    const Scene *scene = times->study->scene;
    int last = 0;
    for (int i = 0; i < times->count; i++) {
        const int frame = times->timed[i].touch + scene->bomb.impact_frames + AFTER_FRAMES + FRAMES_BEHIND;
        if (frame > last) last = frame;
    }
    return last < scene->frames ? last : scene->frames;
}

static bool begin(SceneTimes *times, const SceneStudy *study, Error *error) {
    const int most = study->size.timed_launches;
    const size_t contenders = (size_t)study->contender_count + 1;
    *times = (SceneTimes){.study = study, .count = most < study->launch_count ? most : study->launch_count};
    times->timed = calloc((size_t)times->count, sizeof *times->timed);
    times->launches = calloc((size_t)times->count, sizeof *times->launches);
    bool ok = times->timed != NULL && times->launches != NULL;
    for (int p = 0; p < PROTOCOLS; p++) {
        times->costs[p] = calloc(contenders, sizeof *times->costs[p]);
        ok = ok && times->costs[p] != NULL;
    }
    return ok || error_memory(error, "study");
}

static void end(SceneTimes *times) {
    for (int i = 0; times->timed != NULL && i < times->count; i++) snapshots_free(&times->timed[i].snapshots);
    snapshots_free(&times->snapshots);
    for (int p = 0; p < PROTOCOLS; p++) free(times->costs[p]);
    free(times->timed);
    free(times->launches);
}

static bool measure(SceneTimes *times, const Progress *progress, Error *error) {
    const SceneStudy *study = times->study;
    ProgressStage before = {progress, 0, prepared_share, false},
                  then = {progress, prepared_share, 1 - prepared_share, false};
    const ParallelWork work = {prepare_launch, times};
    if (!parallel_for(&work, times->count, study->scene->name, &(Progress){progress_stage, &before}, error) ||
        !gather_snapshots(times, error))
        return false;
    const TimingOptions options = {.launches = times->launches,
                                   .launch_count = times->count,
                                   .repetitions = study->size.repetitions,
                                   .last_frame = last_frame(times)};
    return timing_measure(study->contenders, study->contender_count, &options, &times->snapshots,
                          times->costs[PROTOCOL_CLOSED], times->costs[PROTOCOL_FROZEN],
                          &(Progress){progress_stage, &then}, error);
}

bool scene_times_write(const SceneStudy *study, FILE *results, const Progress *progress, Error *error) {
    SceneTimes times;
    const bool ok = begin(&times, study, error) && measure(&times, progress, error);
    for (int i = 0; ok && i < study->contender_count; i++)
        for (int p = 0; p < PROTOCOLS; p++)
            for (int phase = 0; phase < PHASES; phase++) {
                const StepCost *cost = &times.costs[p][i][phase];
                const double stored[] = {cost->solver, cost->solver_q1, cost->solver_q3, cost->step,
                                         cost->instructions};
                fwrite(stored, sizeof stored, 1, results);
            }
    end(&times);
    return ok;
}

static bool is_time(double value) { return !(value < 0); }

/* What chart.csv can have. */
static bool is_cost(const StepCost *cost) {
    return is_time(cost->solver_q1) && !(cost->solver_q1 > cost->solver) && !(cost->solver > cost->solver_q3) &&
           is_time(cost->step) && is_time(cost->instructions);
}

MethodTimes *scene_times_read(const SceneStudy *study, const char *path, const char *bytes, size_t size, Error *error) {
    double stored[5];
    const size_t count = (size_t)study->contender_count;
    MethodTimes *times = calloc(count + 1, sizeof *times);
    if (times == NULL) {
        error_memory(error, path);
        return NULL;
    }
    bool whole = size == count * PROTOCOLS * PHASES * sizeof stored;
    for (size_t i = 0; whole && i < count * PROTOCOLS * PHASES; i++) {
        memcpy(stored, bytes + i * sizeof stored, sizeof stored);
        StepCost *cost = &times[i / (PROTOCOLS * PHASES)].costs[i / PHASES % PROTOCOLS][i % PHASES];
        *cost = (StepCost){stored[0], stored[1], stored[2], stored[3], .instructions = stored[4]};
        whole = is_cost(cost);
    }
    if (whole) return times;
    error_input(error, path, "is no result of times; delete it, and its shard does it again");
    free(times);
    return NULL;
}

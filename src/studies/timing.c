/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The timing of contenders, in turns: the clock, the steps, their summary. */
#define _GNU_SOURCE
#include "base/base.h"
#include "base/machine.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "methods/steppers.h"
#include "runs/runs.h"
#include "scenes/scenes.h"
#include "studies/chart_table.h"
#include "studies/contenders.h"
#include "studies/timing.h"

#include <assert.h>
#include <math.h>
#include <sched.h>
#include <stdlib.h>
#include <time.h>

/* Nanoseconds. Tests put a clock that counts in the place of the system's (tests/studies/test_times.c). */
static int64_t now(void) {
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (int64_t)time.tv_sec * 1000000000 + time.tv_nsec;
}

/* At least 0, as the overhead itself varies by some nanoseconds. */
static int64_t meter_without(int64_t passed, int64_t overhead) { return passed > overhead ? passed - overhead : 0; }

/* The least times of the steps of a part, in the order in which they run, which all repetitions share. */
typedef struct StepTime {
    int64_t solver, step, engine;
    int protocol;
    Phase phase;
} StepTime;

typedef struct StepLog {
    int count, next;
    StepTime *items; /* [count] */
    size_t capacity;
} StepLog;

static int64_t least(int64_t x, int64_t y) { return x < y ? x : y; }

/* Takes a step and logs its times. */
static bool metered_step(Stepper *stepper, World *world, Step step, int64_t overhead, StepLog *log, Error *error) {
    StepMeter inner = {.now = now};
    if (!array_reserve((void **)&log->items, &log->capacity, (size_t)log->next + 1, sizeof *log->items))
        return error_memory(error, "timing");
    StepTime *cost = &log->items[log->next];
    if (log->next == log->count) *cost = (StepTime){INT64_MAX, INT64_MAX, INT64_MAX, PROTOCOL_CLOSED, PHASE_REST};
    step.meter = &inner;
    int64_t begun = now();
    if (!simulate_step(stepper, world, &step, error)) return false;
    cost->step = least(meter_without(now() - begun, 3 * overhead), cost->step); /* with two calls inside the step */
    cost->solver = least(meter_without(inner.solving, overhead), cost->solver);
    cost->engine = least(inner.reported, cost->engine);
    log->next++;
    if (log->next > log->count) log->count = log->next;
    return true;
}

/* From a step on to the last one, or to the end of the phase after the impact; ends early, too, if the state becomes
   NaN or infinite, or a program fails: *ended. */
static bool run_closed(Stepper *stepper, const Scene *launched, World *world, int first, int last, int64_t overhead,
                       StepLog *log, bool *ended, Error *error) {
    PhaseTracker tracker = {.impact_frames = launched->bomb.impact_frames};
    Error failure = {0};
    for (int frame = first; frame <= last; frame++) {
        if (tracker.touch > 0 && frame >= tracker.touch + tracker.impact_frames + AFTER_FRAMES) break;
        *ended = !metered_step(stepper, world, (Step){.scene = launched, .frame = frame}, overhead, log, &failure);
        if (*ended) break;
        StepTime *cost = &log->items[log->next - 1];
        cost->protocol = PROTOCOL_CLOSED;
        cost->phase = phase_next(&tracker, world_problem(world), frame);
    }
    if (failure.kind == ERROR_NONE || failure.failure != FAILURE_NONE) return true;
    *error = failure;
    return false;
}

/* Some snapshots; ends early if a program fails. */
static bool run_frozen(Stepper *stepper, const SnapshotList *list, int first, int end, World *world, int64_t overhead,
                       StepLog *log, Error *error) {
    Error failure = {0};
    for (int i = first; i < end; i++) {
        const Snapshot *snapshot = &list->items[i];
        const Step step = {.scene = snapshot->scene, .frame = snapshot->frame, .engine_step = true};
        if (!world_copy(world, snapshot->world, &failure) ||
            !metered_step(stepper, world, step, overhead, log, &failure))
            break;
        StepTime *cost = &log->items[log->next - 1];
        cost->protocol = PROTOCOL_FROZEN;
        cost->phase = snapshot->phase;
    }
    if (failure.kind == ERROR_NONE || failure.failure == FAILURE_ADAPTER) return true;
    *error = failure;
    return false;
}

/* One contender. What is measured of it has parts: the steps that all launches share; then, for each launch, its steps
   from there on and an equal part of the frozen steps. */
typedef struct Timed {
    Stepper *stepper;
    World *world;       /* in which it runs */
    World *start;       /* after the shared steps */
    StepMemory memory;  /* the same */
    bool shares, ended; /* there are such steps; one of them failed */
    StepLog *logs;      /* [parts] */
} Timed;

typedef struct Timing {
    const TimingOptions *options;
    const SnapshotList *snapshots;
    int count, parts; /* parts: one more than launches, at least 2 */
    Timed *items;     /* [count] */
    int64_t overhead; /* ns: of reading the clock, which is subtracted from every measurement */
} Timing;

static bool run_shared(const Timing *timing, Timed *timed, StepLog *log, Error *error) {
    const Scene *launched = &timing->options->launches[0];
    if (!timed->shares) return true;
    World *world = scene_world(launched, error);
    const bool ok = world != NULL &&
                    run_closed(timed->stepper, launched, world, 1, timing->options->shared_steps, timing->overhead, log,
                               &timed->ended, error) &&
                    world_copy(timed->start, world, error) && stepper_remember(timed->stepper, &timed->memory, error);
    world_destroy(world);
    return ok;
}

static bool run_launch(const Timing *timing, Timed *timed, int launch, StepLog *log, Error *error) {
    const TimingOptions *options = timing->options;
    if (timed->ended) return true;
    const Scene *launched = &options->launches[launch];
    const int shared = timed->shares ? options->shared_steps : 0;
    World *world = scene_world(launched, error);
    bool ended = false, ok = world != NULL;
    if (timed->shares)
        ok = ok && world_copy(world, timed->start, error) && stepper_recall(timed->stepper, &timed->memory, error);
    ok = ok && run_closed(timed->stepper, launched, world, shared + 1, options->last_frame, timing->overhead, log,
                          &ended, error);
    world_destroy(world);
    return ok;
}

static bool run_part(const Timing *timing, Timed *timed, int part, Error *error) {
    StepLog *log = &timed->logs[part];
    const int launch = part - 1, launches = timing->parts - 1, frozen = timing->snapshots->count;
    log->next = 0;
    if (part == 0) return run_shared(timing, timed, log, error);
    if (timing->options->launch_count > 0 && !run_launch(timing, timed, launch, log, error)) return false;
    return stepper_describe(timed->stepper)->whole_scenes ||
           run_frozen(timed->stepper, timing->snapshots, launch * frozen / launches, (launch + 1) * frozen / launches,
                      timed->world, timing->overhead, log, error);
}

static bool repeat_all(const Timing *timing, const Progress *progress, Error *error) {
    const int repetitions = timing->options->repetitions;
    for (int r = 0; r < repetitions; r++)
        for (int part = 0; part < timing->parts; part++) {
            for (int i = 0; i < timing->count; i++)
                if (!run_part(timing, &timing->items[i], part, error)) return false;
            if (!progress_report(progress, r * timing->parts + part + 1, repetitions * timing->parts))
                return error_interrupted(error, "timing", "stopped in repetition %d of %d", r + 1, repetitions);
        }
    return true;
}

/* Of the steps in a phase. */
static StepCost summarise(const Timing *timing, const Timed *timed, int protocol, int phase) {
    StepCost sum = {0};
    for (int part = 0; part < timing->parts; part++)
        for (int i = 0; i < timed->logs[part].count; i++) {
            const StepTime *time = &timed->logs[part].items[i];
            if (time->protocol != protocol || (int)time->phase != phase) continue;
            sum.step += (double)time->step / 1000;
            sum.solver += (double)time->solver / 1000;
            sum.engine += (double)time->engine / 1000;
            sum.steps++;
        }
    const bool external = stepper_describe(timed->stepper)->external, known = sum.steps > 0 && !external;
    return (StepCost){.solver = known ? sum.solver / sum.steps : (double)NAN,
                      .step = known ? sum.step / sum.steps : (double)NAN,
                      .engine = external && sum.engine > 0 ? sum.engine / sum.steps : (double)NAN,
                      .steps = known ? sum.steps : 0};
}

static bool make_timed(const Timing *timing, const Contender *contender, Timed *timed, Error *error) {
    const Scene *scene = &timing->options->launches[0];
    Stepper *const *steppers = timing->options->steppers;
    timed->stepper =
        steppers != NULL ? steppers[timed - timing->items] : stepper_create(&contender->method, scene, error);
    timed->world = timed->stepper != NULL ? scene_world(scene, error) : NULL;
    timed->start = timed->world != NULL ? scene_world(scene, error) : NULL;
    if (timed->start == NULL) return false;
    timed->shares = contender_shares(contender) && timing->options->shared_steps > 0;
    timed->logs = calloc((size_t)timing->parts, sizeof *timed->logs);
    return timed->logs != NULL || error_memory(error, "timing");
}

static bool measure(Timing *timing, const Contender *const *contenders, const Progress *progress, Error *error) {
    timing->overhead = INT64_MAX;
    for (int i = 0; i < 1000; i++) {
        const int64_t begun = now();
        timing->overhead = least(now() - begun, timing->overhead);
    }
    for (int i = 0; i < timing->count; i++)
        if (!make_timed(timing, contenders[i], &timing->items[i], error)) return false;
    return repeat_all(timing, progress, error);
}

bool timing_measure(const Contender *const *contenders, int count, const TimingOptions *options,
                    const SnapshotList *snapshots, StepCost (*closed)[PHASES], StepCost (*frozen)[PHASES],
                    const Progress *progress, Error *error) {
    Timing timing = {.options = options,
                     .snapshots = snapshots,
                     .count = count,
                     .parts = options->launch_count > 0 ? options->launch_count + 1 : 2,
                     .items = calloc((size_t)count, sizeof *timing.items)};
    /* The thread stays on its core, to avoid the cost of migration, where the system can do that. */
    const int here = sched_getcpu();
    cpu_set_t before, core;
    CPU_ZERO(&core);
    if (here >= 0) CPU_SET((size_t)here, &core);
    const bool pinned =
        here >= 0 && sched_getaffinity(0, sizeof before, &before) == 0 && sched_setaffinity(0, sizeof core, &core) == 0;
    const bool ok =
        timing.items != NULL ? measure(&timing, contenders, progress, error) : error_memory(error, "timing");
    if (pinned) sched_setaffinity(0, sizeof before, &before);
    for (int i = 0; timing.items != NULL && i < count; i++) {
        Timed *timed = &timing.items[i];
        for (int phase = 0; ok && phase < PHASES; phase++) {
            closed[i][phase] = summarise(&timing, timed, PROTOCOL_CLOSED, phase);
            frozen[i][phase] = summarise(&timing, timed, PROTOCOL_FROZEN, phase);
        }
        for (int part = 0; timed->logs != NULL && part < timing.parts; part++) free(timed->logs[part].items);
        if (options->steppers == NULL) stepper_destroy(timed->stepper);
        world_destroy(timed->world);
        world_destroy(timed->start);
        step_memory_free(&timed->memory);
        free(timed->logs);
    }
    free(timing.items);
    return ok;
}

bool timing_of_launch(const Contender *const *contenders, int count, const Scene *launched, int last_frame,
                      int repetitions, StepCost (*closed)[PHASES], Error *error) {
    const TimingOptions options = {
        .launches = launched, .launch_count = 1, .repetitions = repetitions, .last_frame = last_frame};
    StepCost frozen[TIMING_OF_LAUNCH][PHASES];
    assert(count <= TIMING_OF_LAUNCH);
    return timing_measure(contenders, count, &options, &(SnapshotList){0}, closed, frozen, NULL, error);
}

double step_cost_mean(const StepCost costs[PHASES], bool only_solver) {
    double sum = 0;
    int steps = 0;
    for (int phase = 0; phase < PHASES; phase++) {
        if (costs[phase].steps == 0) continue;
        sum += costs[phase].steps * (only_solver ? costs[phase].solver : costs[phase].step);
        steps += costs[phase].steps;
    }
    return steps > 0 ? sum / steps : NAN;
}

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
#include "studies/statistics.h"
#include "studies/timing.h"

#include <assert.h>
#include <math.h>
#include <sched.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* Nanoseconds. Tests put a clock that counts in the place of the system's (tests/studies/test_times.c). */
static int64_t now(void) {
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (int64_t)time.tv_sec * 1000000000 + time.tv_nsec;
}

/* At least 0, as the overhead itself varies by some nanoseconds. */
static int64_t meter_without(int64_t passed, int64_t overhead) { return passed > overhead ? passed - overhead : 0; }

/* The times of steps, in the order in which they ran: the same in all repetitions. */
typedef struct StepTime {
    int64_t solver, step, engine;
    Phase phase;
} StepTime;

typedef struct StepLog {
    int count;
    StepTime *items; /* [count] */
    size_t capacity;
} StepLog;

/* Takes a step and adds its times to the log. */
static bool metered_step(Stepper *stepper, World *world, Step step, int64_t overhead, StepLog *log, Error *error) {
    StepMeter inner = {.now = now};
    if (!array_reserve((void **)&log->items, &log->capacity, (size_t)log->count + 1, sizeof *log->items))
        return error_memory(error, "timing");
    StepTime *cost = &log->items[log->count];
    step.meter = &inner;
    int64_t begun = now();
    if (!simulate_step(stepper, world, &step, error)) return false;
    cost->step = meter_without(now() - begun, 3 * overhead); /* with two calls inside the step */
    cost->solver = meter_without(inner.solving, overhead);
    cost->engine = inner.reported;
    log->count++;
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
        log->items[log->count - 1].phase = phase_next(&tracker, world_problem(world), frame);
    }
    if (failure.kind == ERROR_NONE || failure.failure != FAILURE_NONE) return true;
    *error = failure;
    return false;
}

/* Ends early if a program fails. */
static bool run_frozen(Stepper *stepper, const SnapshotList *list, World *world, int64_t overhead, StepLog *log,
                       Error *error) {
    Error failure = {0};
    for (int i = 0; i < list->count; i++) {
        const Snapshot *snapshot = &list->items[i];
        const Step step = {.scene = snapshot->scene, .frame = snapshot->frame, .engine_step = true};
        if (!world_copy(world, snapshot->world, &failure) ||
            !metered_step(stepper, world, step, overhead, log, &failure))
            break;
        log->items[log->count - 1].phase = snapshot->phase;
    }
    if (failure.kind == ERROR_NONE || failure.failure == FAILURE_ADAPTER) return true;
    *error = failure;
    return false;
}

/* One contender. What is measured of it has parts: the steps that all launches share, the launches from there on, and
   the frozen steps. */
typedef struct Timed {
    Stepper *stepper;
    World *world;       /* in which it runs */
    World *start;       /* after the shared steps */
    StepMemory memory;  /* the same */
    bool shares, ended; /* there are such steps; one of them failed */
    StepLog *logs;      /* [parts][repetitions] */
    bool *due;          /* [parts] to be measured */
} Timed;

typedef struct Timing {
    const TimingOptions *options;
    const SnapshotList *snapshots;
    int count, parts;                     /* parts: launches and two */
    Timed *items;                         /* [count] */
    int64_t overhead;                     /* ns: of reading the clock, which is subtracted from every measurement */
    StepCost (*costs[PROTOCOLS])[PHASES]; /* [count] each: the caller's */
    double *numbers;                      /* scratch, [repetitions] and [count] */
} Timing;

static int protocol_of(const Timing *timing, int part) {
    return part == timing->parts - 1 ? PROTOCOL_FROZEN : PROTOCOL_CLOSED;
}

static StepLog *logs_of(const Timing *timing, const Timed *timed, int part) {
    return timed->logs + part * timing->options->repetitions;
}

static bool run_part(const Timing *timing, Timed *timed, int part, StepLog *log, Error *error) {
    const TimingOptions *options = timing->options;
    log->count = 0;
    if (protocol_of(timing, part) == PROTOCOL_FROZEN)
        return stepper_describe(timed->stepper)->whole_scenes ||
               run_frozen(timed->stepper, timing->snapshots, timed->world, timing->overhead, log, error);
    const int shared = timed->shares ? options->shared_steps : 0;
    const Scene *launched = &options->launches[part > 0 ? part - 1 : 0];
    if (part == 0 ? shared == 0 : timed->ended) return true;
    Stepper *stepper = timed->stepper;
    World *world = scene_world(launched, error);
    if (world == NULL) return false;
    bool ended = false;
    bool ok = true;
    if (part == 0) {
        ok = run_closed(stepper, launched, world, 1, shared, timing->overhead, log, &ended, error) &&
             world_copy(timed->start, world, error) && stepper_remember(stepper, &timed->memory, error);
        timed->ended = ended;
    } else {
        if (shared > 0) ok = world_copy(world, timed->start, error) && stepper_recall(stepper, &timed->memory, error);
        ok = ok && run_closed(stepper, launched, world, shared + 1, options->last_frame, timing->overhead, log, &ended,
                              error);
    }
    world_destroy(world);
    return ok;
}

/* What is due of all contenders, in turns. */
static bool repeat_all(const Timing *timing, const Progress *progress, Error *error) {
    const int repetitions = timing->options->repetitions;
    for (int r = 0; r < repetitions; r++)
        for (int i = 0; i < timing->count; i++) {
            Timed *timed = &timing->items[i];
            for (int part = 0; part < timing->parts; part++)
                if (timed->due[part] && !run_part(timing, timed, part, &logs_of(timing, timed, part)[r], error))
                    return false;
            if (!progress_report(progress, r * timing->count + i + 1, repetitions * timing->count))
                return error_interrupted(error, "timing", "stopped in repetition %d of %d", r + 1, repetitions);
        }
    return true;
}

/* Memory grows and caches fill in the first steps of a stepper: these do not count. */
static bool warm_up(Timing *timing, Error *error) {
    const bool launches = timing->options->launch_count > 0;
    bool ok = true;
    for (int i = 0; ok && i < timing->count; i++) {
        Timed *timed = &timing->items[i];
        StepLog log = {0};
        ok = (!launches || run_part(timing, timed, 0, &log, error)) &&
             run_part(timing, timed, launches ? 1 : timing->parts - 1, &log, error);
        free(log.items);
    }
    return ok;
}

/* Adds the steps of a part in a phase: of each the quartiles and medians over the repetitions. A repetition that
   another process interrupted in a step does not count more than once. */
static void add_part(const Timing *timing, const Timed *timed, int part, int phase, StepCost *sum) {
    const StepLog *logs = logs_of(timing, timed, part);
    const int repetitions = timing->options->repetitions;
    int fewest = logs[0].count;
    for (int r = 1; r < repetitions; r++) fewest = logs[r].count < fewest ? logs[r].count : fewest;
    double *times = timing->numbers;
    for (int i = 0; i < fewest; i++) {
        if ((int)logs[0].items[i].phase != phase) continue;
        for (int r = 0; r < repetitions; r++) times[r] = (double)logs[r].items[i].step / 1000;
        sum->step += statistics_quantile(times, repetitions, 0.5);
        for (int r = 0; r < repetitions; r++) times[r] = (double)logs[r].items[i].solver / 1000;
        sum->solver += statistics_quantile(times, repetitions, 0.5);
        sum->solver_q1 += statistics_quantile(times, repetitions, 0.25);
        sum->solver_q3 += statistics_quantile(times, repetitions, 0.75);
        for (int r = 0; r < repetitions; r++) times[r] = (double)logs[r].items[i].engine / 1000;
        sum->engine += statistics_quantile(times, repetitions, 0.5);
        sum->steps++;
    }
}

static StepCost summarise(const Timing *timing, const Timed *timed, int protocol, int phase) {
    StepCost sum = {0};
    for (int part = 0; part < timing->parts; part++)
        if (protocol_of(timing, part) == protocol) add_part(timing, timed, part, phase, &sum);
    StepCost unknown = {.solver = NAN, .solver_q1 = NAN, .solver_q3 = NAN, .step = NAN, .engine = NAN};
    const bool external = stepper_describe(timed->stepper)->external;
    if (external && sum.engine > 0) unknown.engine = sum.engine / sum.steps;
    if (sum.steps == 0 || external) return unknown;
    return (StepCost){.solver = sum.solver / sum.steps,
                      .solver_q1 = sum.solver_q1 / sum.steps,
                      .solver_q3 = sum.solver_q3 / sum.steps,
                      .step = sum.step / sum.steps,
                      .engine = NAN,
                      .steps = sum.steps};
}

static double distance(const StepCost *cost) { return cost->solver_q3 - cost->solver_q1; }

static double spread(const StepCost *cost) { return distance(cost) / cost->solver; }

/* The largest spread of a contender in a phase that the spreads of the others explain. */
static double largest_spread(const StepCost (*costs)[PHASES], int count, int contender, int phase, double *spreads) {
    int others = 0;
    for (int i = 0; i < count; i++)
        if (i != contender && costs[i][phase].solver > 0) spreads[others++] = spread(&costs[i][phase]);
    const double usual = statistics_quantile(spreads, others, 0.5);
    return others > 0 ? fmax(TIMES_VARY_FACTOR * usual, TIMES_VARY_LEAST) : INFINITY;
}

/* A time that varies more than those of the others: another process may have disturbed it. Then the parts that vary as
   much are due again; there is one, as the spread of all lies between theirs. */
static void summarise_all(const Timing *timing) {
    for (int i = 0; i < timing->count; i++) memset(timing->items[i].due, 0, (size_t)timing->parts * sizeof(bool));
    for (int p = 0; p < PROTOCOLS; p++)
        for (int phase = 0; phase < PHASES; phase++) {
            StepCost(*costs)[PHASES] = timing->costs[p];
            for (int i = 0; i < timing->count; i++) costs[i][phase] = summarise(timing, &timing->items[i], p, phase);
            for (int i = 0; i < timing->count; i++) {
                StepCost *cost = &costs[i][phase];
                const double largest =
                    largest_spread((const StepCost(*)[PHASES])costs, timing->count, i, phase, timing->numbers);
                cost->varies = spread(cost) > largest && distance(cost) > TIMES_VARY_US;
                for (int part = 0; cost->varies && part < timing->parts; part++) {
                    StepCost own = {0};
                    if (protocol_of(timing, part) == p) add_part(timing, &timing->items[i], part, phase, &own);
                    timing->items[i].due[part] |= spread(&own) > largest;
                }
            }
        }
}

static bool make_timed(const Timing *timing, const Contender *contender, Timed *timed, Error *error) {
    const Scene *scene = &timing->options->launches[0];
    Stepper *const *steppers = timing->options->steppers;
    const size_t parts = (size_t)timing->parts, repetitions = (size_t)timing->options->repetitions;
    timed->stepper =
        steppers != NULL ? steppers[timed - timing->items] : stepper_create(&contender->method, scene, error);
    timed->world = timed->stepper != NULL ? scene_world(scene, error) : NULL;
    timed->start = timed->world != NULL ? scene_world(scene, error) : NULL;
    if (timed->start == NULL) return false;
    timed->shares = contender_shares(contender) && timing->options->shared_steps > 0;
    timed->logs = calloc(parts * repetitions, sizeof *timed->logs);
    timed->due = malloc(parts * sizeof *timed->due);
    if (timed->logs == NULL || timed->due == NULL) return error_memory(error, "timing");
    memset(timed->due, true, parts * sizeof *timed->due);
    return true;
}

static bool measure(Timing *timing, const Contender *const *contenders, const Progress *progress, Error *error) {
    timing->overhead = INT64_MAX;
    for (int i = 0; i < 1000; i++) {
        const int64_t begun = now(), passed = now() - begun;
        if (passed < timing->overhead) timing->overhead = passed;
    }
    for (int i = 0; i < timing->count; i++)
        if (!make_timed(timing, contenders[i], &timing->items[i], error)) return false;
    if (!warm_up(timing, error) || !repeat_all(timing, progress, error)) return false;
    summarise_all(timing);
    if (!repeat_all(timing, NULL, error)) return false;
    summarise_all(timing);
    return true;
}

bool timing_measure(const Contender *const *contenders, int count, const TimingOptions *options,
                    const SnapshotList *snapshots, StepCost (*closed)[PHASES], StepCost (*frozen)[PHASES],
                    const Progress *progress, Error *error) {
    Timing timing = {.options = options,
                     .snapshots = snapshots,
                     .count = count,
                     .parts = options->launch_count + 2,
                     .items = calloc((size_t)count, sizeof *timing.items),
                     .costs = {[PROTOCOL_CLOSED] = closed, [PROTOCOL_FROZEN] = frozen},
                     .numbers = malloc((size_t)(options->repetitions + count) * sizeof *timing.numbers)};
    /* The thread stays on its core, to avoid the cost of migration, where the system can do that. */
    const int here = sched_getcpu();
    cpu_set_t before, core;
    CPU_ZERO(&core);
    if (here >= 0) CPU_SET((size_t)here, &core);
    const bool pinned =
        here >= 0 && sched_getaffinity(0, sizeof before, &before) == 0 && sched_setaffinity(0, sizeof core, &core) == 0;
    const bool ok = timing.items != NULL && timing.numbers != NULL ? measure(&timing, contenders, progress, error)
                                                                   : error_memory(error, "timing");
    if (pinned) sched_setaffinity(0, sizeof before, &before);
    for (int i = 0; timing.items != NULL && i < count; i++) {
        Timed *timed = &timing.items[i];
        for (int k = 0; timed->logs != NULL && k < timing.parts * options->repetitions; k++) free(timed->logs[k].items);
        if (options->steppers == NULL) stepper_destroy(timed->stepper);
        world_destroy(timed->world);
        world_destroy(timed->start);
        step_memory_free(&timed->memory);
        free(timed->logs);
        free(timed->due);
    }
    free(timing.items);
    free(timing.numbers);
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

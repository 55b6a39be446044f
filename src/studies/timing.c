/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The timing of contenders, in turns: the clock and the counter of instructions of this thread, the steps, their
   summary. */
#define _GNU_SOURCE
#include "base/base.h"
#include "base/machine.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "runs/runs.h"
#include "scenes/scenes.h"
#include "studies/chart_table.h"
#include "studies/contenders.h"
#include "studies/statistics.h"
#include "studies/timing.h"

#include <assert.h>
#include <linux/perf_event.h>
#include <math.h>
#include <sched.h>
#include <stdlib.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

/* A counter, and what reading it costs, which is subtracted from every measurement. */
typedef struct Meter {
    int64_t (*now)(void);
    int64_t overhead;
} Meter;

/* Nanoseconds. Tests put a clock that counts in the place of the system's (tests/studies/test_times.c). */
static int64_t meter_time(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

static int counter = -1;

static int64_t meter_instructions(void) {
    int64_t count = 0;
    return read(counter, &count, sizeof count) == (ssize_t)sizeof count ? count : 0;
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
static bool metered_step(Stepper *stepper, World *world, Step step, const Meter *meter, StepLog *log, Error *error) {
    StepMeter inner = {.now = meter->now};
    if (!array_reserve((void **)&log->items, &log->capacity, (size_t)log->count + 1, sizeof *log->items))
        return error_memory(error, "timing");
    StepTime *cost = &log->items[log->count];
    step.meter = &inner;
    int64_t begun = meter->now();
    if (!simulate_step(stepper, world, &step, error)) return false;
    cost->step = meter_without(meter->now() - begun, 3 * meter->overhead); /* with two calls inside the step */
    cost->solver = meter_without(inner.solving, meter->overhead);
    cost->engine = inner.reported;
    log->count++;
    return true;
}

/* Ends early if the state becomes NaN or infinite, or a program fails. */
static bool run_closed(Stepper *stepper, const Scene *launched, int last_frame, const Meter *meter, StepLog *log,
                       Error *error) {
    World *world = scene_world(launched, error);
    if (world == NULL) return false;
    PhaseTracker tracker = {.impact_frames = launched->bomb.impact_frames};
    Error failure = {0};
    for (int frame = 1; frame <= last_frame; frame++) {
        if (!metered_step(stepper, world, (Step){.scene = launched, .frame = frame}, meter, log, &failure)) break;
        log->items[log->count - 1].phase = phase_next(&tracker, world_problem(world), frame);
    }
    world_destroy(world);
    if (failure.kind == ERROR_NONE || failure.failure != FAILURE_NONE) return true;
    *error = failure;
    return false;
}

/* Ends early if a program fails. */
static bool run_frozen(Stepper *stepper, const SnapshotList *list, World *world, const Meter *meter, StepLog *log,
                       Error *error) {
    Error failure = {0};
    for (int i = 0; i < list->count; i++) {
        const Snapshot *snapshot = &list->items[i];
        const Step step = {.scene = snapshot->scene, .frame = snapshot->frame, .engine_step = true};
        if (!world_copy(world, snapshot->world, &failure) || !metered_step(stepper, world, step, meter, log, &failure))
            break;
        log->items[log->count - 1].phase = snapshot->phase;
    }
    if (failure.kind == ERROR_NONE || failure.failure == FAILURE_ADAPTER) return true;
    *error = failure;
    return false;
}

/* One contender. */
typedef struct Timed {
    Stepper *stepper;
    StepLog *logs[PROTOCOLS]; /* [repetitions] each */
    double instructions[PROTOCOLS][PHASES];
} Timed;

typedef struct Timing {
    const TimingOptions *options;
    const SnapshotList *snapshots;
    World *world;
    int count;
    Timed *items;                         /* [count] */
    StepCost (*costs[PROTOCOLS])[PHASES]; /* [count] each: the caller's */
    double *numbers;                      /* scratch, [repetitions] and [count] */
} Timing;

static bool is_external(const Timed *timed) { return stepper_describe(timed->stepper)->external; }

static bool run_both(const Timing *timing, const Timed *timed, int launches, const Meter *meter, StepLog *closed,
                     StepLog *frozen, Error *error) {
    for (int i = 0; i < launches; i++)
        if (!run_closed(timed->stepper, &timing->options->launches[i], timing->options->last_frame, meter, closed,
                        error))
            return false;
    return stepper_describe(timed->stepper)->whole_scenes ||
           run_frozen(timed->stepper, timing->snapshots, timing->world, meter, frozen, error);
}

/* All contenders, or those that vary, in turns. */
static bool repeat_all(Timing *timing, bool again, const Meter *meter, const Progress *progress, Error *error) {
    const int repetitions = timing->options->repetitions;
    for (int r = 0; r < repetitions; r++) {
        for (int i = 0; i < timing->count; i++) {
            const Timed *timed = &timing->items[i];
            bool varies = !again; /* there are no costs before the first round */
            for (int p = 0; again && p < PROTOCOLS; p++)
                for (int phase = 0; phase < PHASES; phase++) varies |= timing->costs[p][i][phase].varies;
            if (!varies) continue;
            StepLog *closed = &timed->logs[PROTOCOL_CLOSED][r], *frozen = &timed->logs[PROTOCOL_FROZEN][r];
            closed->count = frozen->count = 0;
            if (!run_both(timing, timed, timing->options->launch_count, meter, closed, frozen, error)) return false;
        }
        if (!progress_report(progress, again ? repetitions : r + 1, repetitions))
            return error_interrupted(error, "timing", "stopped after %d of %d repetitions", r + 1, repetitions);
    }
    return true;
}

/* Memory grows and caches fill in the first steps of a stepper: these do not count. */
static bool warm_up(const Timing *timing, const Meter *meter, Error *error) {
    const int launches = timing->options->launch_count > 0;
    bool ok = true;
    for (int i = 0; ok && i < timing->count; i++) {
        StepLog logs[PROTOCOLS] = {0};
        ok =
            run_both(timing, &timing->items[i], launches, meter, &logs[PROTOCOL_CLOSED], &logs[PROTOCOL_FROZEN], error);
        for (int p = 0; p < PROTOCOLS; p++) free(logs[p].items);
    }
    return ok;
}

/* Means of the solver's instructions in each phase, where the system counts those of this thread. Without repetitions:
   counts do not vary. */
static bool count_instructions(Timing *timing, Error *error) {
    struct perf_event_attr event = {.type = PERF_TYPE_HARDWARE,
                                    .size = sizeof event,
                                    .config = PERF_COUNT_HW_INSTRUCTIONS,
                                    .exclude_kernel = 1,
                                    .exclude_hv = 1};
    const Meter meter = {meter_instructions, 0};
    bool ok = true;
    if (!timing->options->no_instructions) counter = (int)syscall(SYS_perf_event_open, &event, 0, -1, -1, 0);
    for (int i = 0; ok && i < timing->count; i++) {
        StepLog logs[PROTOCOLS] = {0};
        const bool counts = counter >= 0 && !is_external(&timing->items[i]); /* those are not the engine's */
        if (counts)
            ok = run_both(timing, &timing->items[i], timing->options->launch_count, &meter, &logs[PROTOCOL_CLOSED],
                          &logs[PROTOCOL_FROZEN], error);
        for (int p = 0; p < PROTOCOLS; p++) {
            int64_t sums[PHASES] = {0};
            int steps[PHASES] = {0};
            for (int k = 0; k < logs[p].count; k++) {
                sums[logs[p].items[k].phase] += logs[p].items[k].solver;
                steps[logs[p].items[k].phase]++;
            }
            for (int phase = 0; phase < PHASES; phase++)
                timing->items[i].instructions[p][phase] =
                    steps[phase] > 0 ? (double)sums[phase] / steps[phase] : (double)NAN;
            free(logs[p].items);
        }
    }
    if (counter >= 0) close(counter);
    counter = -1;
    return ok;
}

/* Adds the quartiles and medians of step i over the repetitions. A repetition that another process interrupted in this
   step does not count more than once. */
static void add_step(StepCost *sum, const StepLog *logs, int repetitions, int i, double *times) {
    for (int r = 0; r < repetitions; r++) times[r] = (double)logs[r].items[i].step / 1000;
    sum->step += statistics_quantile(times, repetitions, 0.5);
    for (int r = 0; r < repetitions; r++) times[r] = (double)logs[r].items[i].solver / 1000;
    sum->solver += statistics_quantile(times, repetitions, 0.5);
    sum->solver_q1 += statistics_quantile(times, repetitions, 0.25);
    sum->solver_q3 += statistics_quantile(times, repetitions, 0.75);
    for (int r = 0; r < repetitions; r++) times[r] = (double)logs[r].items[i].engine / 1000;
    sum->engine += statistics_quantile(times, repetitions, 0.5);
}

/* times: scratch, [repetitions]. */
static StepCost summarise(const Timed *timed, int protocol, int phase, int repetitions, double *times) {
    const StepLog *logs = timed->logs[protocol];
    StepCost sum = {0};
    int steps = 0, fewest = logs[0].count;
    for (int r = 1; r < repetitions; r++) fewest = logs[r].count < fewest ? logs[r].count : fewest;
    for (int i = 0; i < fewest; i++) {
        if ((int)logs[0].items[i].phase != phase) continue;
        add_step(&sum, logs, repetitions, i, times);
        steps++;
    }
    StepCost unknown = {
        .solver = NAN, .solver_q1 = NAN, .solver_q3 = NAN, .step = NAN, .engine = NAN, .instructions = NAN};
    if (is_external(timed) && sum.engine > 0) unknown.engine = sum.engine / steps;
    if (steps == 0 || is_external(timed)) return unknown;
    return (StepCost){.solver = sum.solver / steps,
                      .solver_q1 = sum.solver_q1 / steps,
                      .solver_q3 = sum.solver_q3 / steps,
                      .step = sum.step / steps,
                      .engine = NAN,
                      .steps = steps,
                      .instructions = timed->instructions[protocol][phase]};
}

static double distance(const StepCost *cost) { return cost->solver_q3 - cost->solver_q1; }

static double spread(const StepCost *cost) { return distance(cost) / cost->solver; }

/* Whether a time varies more than those of the others in that phase: another process may have disturbed it. */
static bool is_disturbed(const StepCost (*costs)[PHASES], int count, int contender, int phase, double *spreads) {
    int others = 0;
    for (int i = 0; i < count; i++)
        if (i != contender && costs[i][phase].solver > 0) spreads[others++] = spread(&costs[i][phase]);
    const double usual = statistics_quantile(spreads, others, 0.5), own = spread(&costs[contender][phase]);
    return own > TIMES_VARY_FACTOR * usual && own > TIMES_VARY_LEAST &&
           distance(&costs[contender][phase]) > TIMES_VARY_US;
}

static void summarise_all(const Timing *timing) {
    for (int p = 0; p < PROTOCOLS; p++)
        for (int phase = 0; phase < PHASES; phase++) {
            StepCost(*costs)[PHASES] = timing->costs[p];
            for (int i = 0; i < timing->count; i++)
                costs[i][phase] = summarise(&timing->items[i], p, phase, timing->options->repetitions, timing->numbers);
            for (int i = 0; i < timing->count; i++)
                costs[i][phase].varies =
                    is_disturbed((const StepCost(*)[PHASES])costs, timing->count, i, phase, timing->numbers);
        }
}

static bool measure(Timing *timing, const Contender *const *contenders, const Progress *progress, Error *error) {
    const Scene *scene = &timing->options->launches[0];
    const size_t repetitions = (size_t)timing->options->repetitions;
    Meter clock = {meter_time, INT64_MAX};
    timing->numbers = malloc((repetitions + (size_t)timing->count) * sizeof *timing->numbers);
    timing->items = calloc((size_t)timing->count, sizeof *timing->items);
    if (timing->items == NULL || timing->numbers == NULL) return error_memory(error, "timing");
    for (int i = 0; i < timing->count; i++) {
        Timed *timed = &timing->items[i];
        timed->stepper = stepper_create(&contenders[i]->method, scene, error);
        if (timed->stepper == NULL) return false;
        for (int p = 0; p < PROTOCOLS; p++) {
            timed->logs[p] = calloc(repetitions, sizeof *timed->logs[p]);
            if (timed->logs[p] == NULL) return error_memory(error, "timing");
        }
    }
    timing->world = scene_world(scene, error);
    if (timing->world == NULL) return false;
    for (int i = 0; i < 1000; i++) {
        const int64_t begun = meter_time(), passed = meter_time() - begun;
        if (passed < clock.overhead) clock.overhead = passed;
    }
    if (!warm_up(timing, &clock, error) || !repeat_all(timing, false, &clock, progress, error) ||
        !count_instructions(timing, error))
        return false;
    summarise_all(timing);
    if (!repeat_all(timing, true, &clock, progress, error)) return false;
    summarise_all(timing);
    return true;
}

bool timing_measure(const Contender *const *contenders, int count, const TimingOptions *options,
                    const SnapshotList *snapshots, StepCost (*closed)[PHASES], StepCost (*frozen)[PHASES],
                    const Progress *progress, Error *error) {
    Timing timing = {.options = options,
                     .snapshots = snapshots,
                     .count = count,
                     .costs = {[PROTOCOL_CLOSED] = closed, [PROTOCOL_FROZEN] = frozen}};
    /* The thread stays on its core, to avoid the cost of migration, where the system can do that. */
    const int here = sched_getcpu();
    cpu_set_t before, core;
    CPU_ZERO(&core);
    if (here >= 0) CPU_SET((size_t)here, &core);
    const bool pinned =
        here >= 0 && sched_getaffinity(0, sizeof before, &before) == 0 && sched_setaffinity(0, sizeof core, &core) == 0;
    const bool ok = measure(&timing, contenders, progress, error);
    if (pinned) sched_setaffinity(0, sizeof before, &before);
    for (int i = 0; timing.items != NULL && i < count; i++) {
        const Timed *timed = &timing.items[i];
        stepper_destroy(timed->stepper);
        for (int p = 0; p < PROTOCOLS; p++) {
            for (int r = 0; timed->logs[p] != NULL && r < options->repetitions; r++) free(timed->logs[p][r].items);
            free(timed->logs[p]);
        }
    }
    free(timing.items);
    free(timing.numbers);
    world_destroy(timing.world);
    return ok;
}

bool timing_of_launch(const Contender *const *contenders, int count, const Scene *launched, int last_frame,
                      int repetitions, StepCost (*closed)[PHASES], Error *error) {
    const TimingOptions options = {.launches = launched,
                                   .launch_count = 1,
                                   .repetitions = repetitions,
                                   .last_frame = last_frame,
                                   .no_instructions = true};
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

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/timing.h"

#include "simulate/simulate.h"
#include "study/meter.h"
#include "study/statistics.h"

#include <math.h>
#include <stdlib.h>

/* A counter, and what reading it costs. */
typedef struct Meter {
    int64_t (*now)(void);
    int64_t overhead;
} Meter;

/* Sums over steps, per phase. */
typedef struct Tally {
    int64_t solver[PHASES], step[PHASES];
    int steps[PHASES];
} Tally;

typedef struct Cost {
    int64_t solver, step;
} Cost;

static bool metered_step(Stepper *stepper, World *world, Step step, const Meter *meter, Cost *cost, Error *error) {
    StepMeter inner = {.now = meter->now};
    step.meter = &inner;
    int64_t begun = meter->now();
    if (!simulate_step(stepper, world, &step, error)) return false;
    cost->step = meter->now() - begun - 3 * meter->overhead; /* with two calls inside the step */
    cost->solver = inner.solving - meter->overhead;
    return true;
}

static void count_step(Tally *tally, const Cost *cost, Phase phase) {
    tally->solver[phase] += cost->solver;
    tally->step[phase] += cost->step;
    tally->steps[phase]++;
}

/* Ends early if the state becomes NaN or infinite. */
static bool run_closed(Stepper *stepper, const Scene *launched, int last_frame, const Meter *meter, Tally *tally,
                       Error *error) {
    World *world = scene_world(launched, error);
    if (world == NULL) return false;
    PhaseTracker tracker = {.impact_frames = launched->bomb.impact_frames};
    Error failure = {0};
    Cost cost;
    for (int frame = 1; frame <= last_frame; frame++) {
        if (!metered_step(stepper, world, (Step){.scene = launched, .frame = frame}, meter, &cost, &failure)) break;
        count_step(tally, &cost, phase_next(&tracker, world_problem(world), frame));
    }
    world_destroy(world);
    if (failure.kind != ERROR_SYSTEM) return true;
    *error = failure;
    return false;
}

static bool run_frozen(Stepper *stepper, const SnapshotList *list, World *world, const Meter *meter, Tally *tally,
                       Error *error) {
    Cost cost;
    for (int i = 0; i < list->count; i++) {
        const Snapshot *snapshot = &list->items[i];
        if (!world_copy(world, snapshot->world, error) ||
            !metered_step(stepper, world, (Step){.scene = snapshot->scene, .frame = snapshot->frame}, meter, &cost,
                          error))
            return false;
        count_step(tally, &cost, snapshot->phase);
    }
    return true;
}

/* One contender. solver, step: means of each repetition [PROTOCOLS][PHASES][repetitions]. */
typedef struct Timed {
    Stepper *stepper;
    double *solver, *step;
    double instructions[PROTOCOLS][PHASES];
} Timed;

typedef struct Timing {
    const TimingOptions *options;
    const SnapshotList *snapshots;
    World *world;
    int count;
    Timed *items; /* [count] */
} Timing;

static bool run_both(const Timing *timing, const Timed *timed, const Meter *meter, Tally tallies[PROTOCOLS],
                     Error *error) {
    for (int i = 0; i < timing->options->launch_count; i++)
        if (!run_closed(timed->stepper, &timing->options->launches[i], timing->options->last_frame, meter,
                        &tallies[PROTOCOL_CLOSED], error))
            return false;
    return run_frozen(timed->stepper, timing->snapshots, timing->world, meter, &tallies[PROTOCOL_FROZEN], error);
}

static double per_step(int64_t sum, int steps) { return steps > 0 ? (double)sum / steps : NAN; }

static bool repeat(Timing *timing, int repetition, const Meter *meter, Error *error) {
    for (int i = 0; i < timing->count; i++) {
        Timed *timed = &timing->items[i];
        Tally tallies[PROTOCOLS] = {0};
        if (!run_both(timing, timed, meter, tallies, error)) return false;
        for (int p = 0; p < PROTOCOLS; p++)
            for (int phase = 0; phase < PHASES; phase++) {
                int at = (p * PHASES + phase) * timing->options->repetitions + repetition;
                timed->solver[at] = per_step(tallies[p].solver[phase], tallies[p].steps[phase]) / 1000;
                timed->step[at] = per_step(tallies[p].step[phase], tallies[p].steps[phase]) / 1000;
            }
    }
    return true;
}

/* Without repetitions: counts do not vary. */
static bool count_instructions(Timing *timing, Error *error) {
    bool can = meter_open_instructions();
    const Meter meter = {meter_instructions, 0};
    bool ok = true;
    for (int i = 0; ok && i < timing->count; i++) {
        Tally tallies[PROTOCOLS] = {0};
        if (can) ok = run_both(timing, &timing->items[i], &meter, tallies, error);
        for (int p = 0; p < PROTOCOLS; p++)
            for (int phase = 0; phase < PHASES; phase++)
                timing->items[i].instructions[p][phase] =
                    can ? per_step(tallies[p].solver[phase], tallies[p].steps[phase]) : NAN;
    }
    if (can) meter_close_instructions();
    return ok;
}

static StepCost summarise(const Timed *timed, int protocol, int phase, int repetitions) {
    double *solver = timed->solver + (protocol * PHASES + phase) * repetitions;
    double *step = timed->step + (protocol * PHASES + phase) * repetitions;
    return isnan(solver[0]) ? (StepCost){NAN, NAN, NAN, NAN, NAN}
                            : (StepCost){.solver = statistics_quantile(solver, repetitions, 0.5),
                                         .solver_q1 = statistics_quantile(solver, repetitions, 0.25),
                                         .solver_q3 = statistics_quantile(solver, repetitions, 0.75),
                                         .step = statistics_quantile(step, repetitions, 0.5),
                                         .instructions = timed->instructions[protocol][phase]};
}

static bool timing_begin(Timing *timing, const Contender *const *contenders, Error *error) {
    const Scene *scene = &timing->options->launches[0];
    size_t samples = (size_t)timing->options->repetitions * PROTOCOLS * PHASES;
    timing->items = calloc((size_t)timing->count, sizeof *timing->items);
    if (timing->items == NULL) return error_memory(error, "timing");
    for (int i = 0; i < timing->count; i++) {
        Timed *timed = &timing->items[i];
        timed->stepper = stepper_create(&contenders[i]->method, scene, error);
        if (timed->stepper == NULL) return false;
        timed->solver = malloc(2 * samples * sizeof *timed->solver);
        if (timed->solver == NULL) return error_memory(error, "timing");
        timed->step = timed->solver + samples;
    }
    timing->world = scene_world(scene, error);
    return timing->world != NULL;
}

static void timing_end(Timing *timing) {
    for (int i = 0; timing->items != NULL && i < timing->count; i++) {
        stepper_destroy(timing->items[i].stepper);
        free(timing->items[i].solver);
    }
    free(timing->items);
    world_destroy(timing->world);
}

static bool measure(Timing *timing, const Progress *progress, Error *error) {
    const int repetitions = timing->options->repetitions;
    const Meter clock = {meter_time, meter_time_overhead()};
    for (int r = 0; r < repetitions; r++) {
        if (!repeat(timing, r, &clock, error)) return false;
        if (!progress_report(progress, r + 1, repetitions))
            return error_input(error, "timing", "stopped after %d of %d repetitions", r + 1, repetitions);
    }
    return count_instructions(timing, error);
}

bool timing_measure(const Contender *const *contenders, int count, const TimingOptions *options,
                    const SnapshotList *snapshots, StepCost (*closed)[PHASES], StepCost (*frozen)[PHASES],
                    const Progress *progress, Error *error) {
    Timing timing = {.options = options, .snapshots = snapshots, .count = count};
    meter_pin();
    bool ok = timing_begin(&timing, contenders, error) && measure(&timing, progress, error);
    meter_unpin();
    for (int i = 0; ok && i < count; i++)
        for (int phase = 0; phase < PHASES; phase++) {
            closed[i][phase] = summarise(&timing.items[i], PROTOCOL_CLOSED, phase, options->repetitions);
            frozen[i][phase] = summarise(&timing.items[i], PROTOCOL_FROZEN, phase, options->repetitions);
        }
    timing_end(&timing);
    return ok;
}

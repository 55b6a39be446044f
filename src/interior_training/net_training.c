/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "interior_training/net_training.h"

#include "common/split_mix.h"
#include "interior_training/first_round.h"
#include "interior_training/recording.h"
#include "solvers/interior_net.h"

#include <stdio.h>
#include <stdlib.h>

static const double first_rate = 0.01, first_weight = 0.6;

typedef struct Trainer {
    const NetTraining *training;
    FirstRound first_round;
    NetState state;
    NetFit fit;
    ImpactProblems problems, held_out;
    ProgressStage stage;
    Progress progress; /* of the stage */
} Trainer;

static bool make_solver(void *context, int number, ContactSolver *solver, Error *error) {
    (void)number;
    return interior_net_make(solver, context, error);
}

/* As they would be read from a file. */
static void round_weights(const double *weights, InteriorNet *net) {
    for (int i = 0; i < INTERIOR_NET_WEIGHTS; i++) net->weights[i] = (double)(float)weights[i];
}

static void next_stage(Trainer *trainer, double share) {
    trainer->stage.begin += trainer->stage.share;
    trainer->stage.share = share;
}

/* Every problem of the round's scenes. */
static bool record(Trainer *trainer, int round, Error *error) {
    const NetTraining *training = trainer->training;
    if (round == 0)
        return first_round_take(&trainer->first_round, FIRST_TRAINED, &trainer->problems, &trainer->progress, error);
    InteriorNet net = {0};
    round_weights(trainer->state.drivers[round], &net);
    const Recording recording = {training->seed, round * training->scenes, training->scenes, make_solver, &net};
    return recording_run(&recording, &trainer->problems, &trainer->progress, error);
}

static bool hold_out(Trainer *trainer, Error *error) {
    ImpactProblems all = {0};
    bool ok = first_round_take(&trainer->first_round, FIRST_HELD_OUT, &all, &trainer->progress, error);
    for (size_t i = 0; ok && i < all.count; i++)
        if (all.items[i].impact)
            ok = impact_problems_add(&trainer->held_out, &all.items[i].problem, all.items[i].reference, true) ||
                 error_memory(error, "interior-net");
    impact_problems_free(&all);
    return ok &&
           (trainer->held_out.count > 0 || error_input(error, "interior-net", "no bomb hits: more scenes needed"));
}

/* Weights of the hidden layer; zero weights of the outputs leave the iterations as they are. */
static void first_weights(double *weights, uint64_t seed) {
    uint64_t state = seed;
    for (int i = 0; i < INTERIOR_NET_WEIGHTS; i++) {
        const double unit = (double)(split_mix(&state) >> 11) * 0x1p-52 - 1;
        weights[i] = i < INTERIOR_NET_OUTPUT_WEIGHTS ? first_weight * unit : 0;
    }
}

static bool score(Trainer *trainer, double loss, Error *error) {
    static const double silent[INTERIOR_NET_WEIGHTS] = {0};
    NetScore result = {
        trainer->state.round, trainer->state.epoch, (int)trainer->problems.count, loss, {{0}, {0}}, {{0}, {0}}};
    if (trainer->training->on_score == NULL) return true;
    if (!net_fit_errors(&trainer->fit, trainer->state.weights, &trainer->held_out, &result.with, error) ||
        !net_fit_errors(&trainer->fit, silent, &trainer->held_out, &result.without, error))
        return false;
    trainer->training->on_score(trainer->training->context, &result);
    return true;
}

/* The rate falls from the round's first to 0 in equal steps. */
static bool fit_round(Trainer *trainer, Error *error) {
    const NetTraining *training = trainer->training;
    NetState *state = &trainer->state;
    const double rate = first_rate / (state->round + 1);
    double loss = 0;
    for (; state->epoch < training->epochs; state->epoch++) {
        if (!progress_report(&trainer->progress, state->epoch, training->epochs)) return true;
        const double left = (double)(training->epochs - state->epoch) / training->epochs;
        if (!net_fit_epoch(&trainer->fit, state, &trainer->problems,
                           training->seed + (uint64_t)(state->round * training->epochs + state->epoch), rate * left,
                           rate * (left - 1.0 / training->epochs), &loss, error))
            return false;
        NetState next = *state;
        next.epoch++;
        if (!net_state_write(&next, training->state_path, error)) return false;
    }
    return score(trainer, loss, error);
}

/* Moments start with the round: its problems are others. */
static void begin_round(NetState *state, int round) {
    state->round = round;
    state->epoch = 0;
    state->steps = 0;
    memset(state->mean, 0, sizeof state->mean);
    memset(state->square, 0, sizeof state->square);
    memcpy(state->drivers[round], state->weights, sizeof state->weights);
}

/* The state is written first: an output folder that cannot be written to is refused before any work. */
static bool begin(Trainer *trainer, Error *error) {
    const NetTraining *training = trainer->training;
    NetState *state = &trainer->state;
    Error failure = {0};
    if (!net_state_read(state, training->state_path, training->command, &failure)) {
        if (failure.kind != ERROR_NONE) {
            *error = failure;
            return false;
        }
        *state = (NetState){0};
        snprintf(state->command, sizeof state->command, "%s", training->command);
        first_weights(state->weights, training->seed);
        begin_round(state, 0);
        if (!net_state_write(state, training->state_path, error)) return false;
    }
    trainer->stage.share = 0.1;
    if (!net_fit_begin(&trainer->fit, error) || !hold_out(trainer, error)) return false;
    for (int round = 0; round < state->round; round++) {
        next_stage(trainer, 0.1 / state->round);
        if (!record(trainer, round, error)) return false;
    }
    return true;
}

static bool run(Trainer *trainer, Error *error) {
    const NetTraining *training = trainer->training;
    NetState *state = &trainer->state;
    if (!begin(trainer, error)) return false;
    const double share = 0.8 / (training->rounds - state->round);
    for (;;) {
        next_stage(trainer, 0.4 * share);
        if (!record(trainer, state->round, error)) return false;
        next_stage(trainer, 0.6 * share);
        if (!fit_round(trainer, error)) return false;
        if (trainer->stage.stopped || state->round + 1 == training->rounds) return true;
        begin_round(state, state->round + 1);
        if (!net_state_write(state, training->state_path, error)) return false;
    }
}

bool net_training_run(const NetTraining *training, InteriorNet *net, const Progress *progress, Error *error) {
    Trainer *trainer = calloc(1, sizeof *trainer);
    if (trainer == NULL) return error_memory(error, "interior-net");
    trainer->training = training;
    first_round_make(&trainer->first_round, training);
    trainer->stage.whole = progress;
    trainer->progress = (Progress){progress_stage, &trainer->stage};
    bool ok = run(trainer, error);
    *net = (InteriorNet){0};
    round_weights(trainer->state.weights, net);
    if (ok && trainer->stage.stopped)
        ok = error_interrupted(error, training->state_path, "stopped; the same command continues");
    net_fit_free(&trainer->fit);
    impact_problems_free(&trainer->problems);
    impact_problems_free(&trainer->held_out);
    free(trainer);
    return ok;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "relation_training/relation_training.h"

#include "learning/fit_state.h"
#include "relation_training/relation_launches.h"

#include <stdlib.h>
#include <string.h>

static const double first_rate = 0.003;

/* The weights of the state: of each form, those in training, then those that drove each round but the first. */
enum { SETS = 1 + RELATION_ROUNDS_MAX };

typedef struct Trainer {
    const RelationTraining *training;
    RelationNetworks *networks;
    int weights; /* of a form */
    FitState state;
    ImpactProblems first, held_out; /* of the first round */
    RelationSamples samples, held_out_samples;
    RelationFit fit;
    ProgressStage stage;
    Progress progress; /* of the stage */
} Trainer;

static size_t set_at(const Trainer *trainer, int form, int set) {
    return ((size_t)form * SETS + (size_t)set) * (size_t)trainer->weights;
}

static int stage_form(const Trainer *trainer) { return trainer->state.stage / trainer->training->rounds; }

static int stage_round(const Trainer *trainer) { return trainer->state.stage % trainer->training->rounds; }

/* Adam over the weights in training. */
static Adam active(const Trainer *trainer, int64_t steps) {
    const Adam *all = &trainer->state.adam;
    const size_t at = set_at(trainer, stage_form(trainer), 0);
    return adam_over(all->weights + at, all->mean + at, all->square + at, trainer->weights, steps, all->square_decay);
}

static void next_stage(Trainer *trainer, double share) {
    trainer->stage.begin += trainer->stage.share;
    trainer->stage.share = share;
}

/* Ranges and normalisation follow from the samples; the driver's weights from the state. */
static bool record_round(Trainer *trainer, int form, int round, Error *error) {
    const RelationTraining *training = trainer->training;
    RelationNetwork *network = &trainer->networks->forms[form];
    ImpactProblems problems = {0};
    if (round == 0) {
        trainer->samples.form = (RelationForm)form;
        trainer->held_out_samples.form = (RelationForm)form;
        if (!relation_samples_add(&trainer->held_out_samples, &trainer->held_out, true, error) ||
            !relation_samples_add(&trainer->samples, &trainer->first, false, error))
            return false;
        relation_normalise(network, &trainer->samples);
    } else {
        relation_set_weights(network, trainer->state.adam.weights + set_at(trainer, form, round));
        const RelationDriver driver = {network, (RelationForm)form};
        const RelationLaunches launches = {
            training->scenes, training->scene_count, training->launches, training->rounds, round, false, &driver};
        const bool ok = relation_launches_record(&launches, &problems, &trainer->progress, error) &&
                        relation_samples_add(&trainer->samples, &problems, false, error);
        impact_problems_free(&problems);
        if (!ok) return false;
    }
    relation_set_ranges(network, &trainer->samples);
    return true;
}

static bool report(Trainer *trainer, double loss, Error *error) {
    const RelationTraining *training = trainer->training;
    const int form = stage_form(trainer);
    RelationScore score = {
        (RelationForm)form, stage_round(trainer), trainer->samples.problems, trainer->samples.count, loss, {0, 0, 0}};
    if (training->on_score == NULL) return true;
    if (!relation_fit_errors(&trainer->fit, trainer->state.adam.weights + set_at(trainer, form, 0),
                             &trainer->held_out_samples, &score.held_out, error))
        return false;
    training->on_score(training->context, &score);
    return true;
}

/* The rate falls from the first to 0 in equal steps; each round begins with half that of the round before. */
static bool fit_round(Trainer *trainer, Error *error) {
    const RelationTraining *training = trainer->training;
    const uint64_t seed = training->seed + (uint64_t)(trainer->state.stage + 1) * 1000003;
    const double rate = first_rate / (1 << stage_round(trainer));
    Adam adam = active(trainer, trainer->state.adam.steps);
    double loss = 0, sum = 0;
    for (int step = (int)adam.steps; step < training->steps; step++) {
        if (!relation_fit_step(&trainer->fit, &adam, seed, step, rate * (1 - (double)step / training->steps), &loss,
                               error))
            return false;
        sum += loss;
        if ((step + 1) % training->saved != 0 && step + 1 < training->steps) continue;
        trainer->state.adam.steps = adam.steps;
        if (!fit_state_write(&trainer->state, training->state_path, error)) return false;
        if (!progress_report(&trainer->progress, step + 1, training->steps)) return true;
        loss = sum / training->saved;
        sum = 0;
    }
    return report(trainer, loss, error);
}

static bool run_stage(Trainer *trainer, Error *error) {
    const int form = stage_form(trainer);
    RelationNetwork *network = &trainer->networks->forms[form];
    if (trainer->samples.count == 0) return error_input(error, "sain", "no box is touched: more launches needed");
    if (!relation_fit_begin(&trainer->fit, network, &trainer->samples, trainer->training->batch, error)) return false;
    const bool ok = fit_round(trainer, error);
    relation_fit_free(&trainer->fit);
    relation_set_weights(network, trainer->state.adam.weights + set_at(trainer, form, 0));
    return ok;
}

/* What drives the round is what was trained before it. Moments start with the round: its samples are others. */
static bool begin_stage(Trainer *trainer, int stage, Error *error) {
    Adam *all = &trainer->state.adam;
    trainer->state.stage = stage;
    const int form = stage_form(trainer), round = stage_round(trainer);
    double *weights = all->weights + set_at(trainer, form, 0);
    if (round > 0)
        memcpy(all->weights + set_at(trainer, form, round), weights, (size_t)trainer->weights * sizeof *weights);
    else
        relation_first_weights(&trainer->networks->forms[form], trainer->training->seed, weights);
    adam_restart(all);
    return fit_state_write(&trainer->state, trainer->training->state_path, error);
}

/* The samples of the rounds of a form up to this one, and the form's network as it was. */
static bool gather(Trainer *trainer, int form, int last, Error *error) {
    relation_samples_free(&trainer->samples);
    relation_samples_free(&trainer->held_out_samples);
    for (int round = 0; round <= last; round++)
        if (!record_round(trainer, form, round, error)) return false;
    return true;
}

static bool record_first(Trainer *trainer, Error *error) {
    const RelationTraining *training = trainer->training;
    const RelationLaunches
        first = {training->scenes, training->scene_count, training->launches, training->rounds, 0, false, NULL},
        others = {training->scenes, training->scene_count, training->launches / 4 + 1, 1, 0, true, NULL};
    return relation_launches_record(&first, &trainer->first, &trainer->progress, error) &&
           relation_launches_record(&others, &trainer->held_out, &trainer->progress, error);
}

/* The state is written first: an output folder that cannot be written to is refused before any work. */
static bool begin(Trainer *trainer, Error *error) {
    bool found;
    for (int f = 0; f < RELATION_FORMS; f++)
        if (!relation_network_create(&trainer->networks->forms[f], error)) return false;
    trainer->weights = relation_weight_count(&trainer->networks->forms[0]);
    trainer->state.command = trainer->training->command;
    if (!adam_create(&trainer->state.adam, (int64_t)set_at(trainer, RELATION_FORMS, 0), ADAM_SQUARE_DECAY, error) ||
        !fit_state_read(&trainer->state, trainer->training->state_path, &found, error) ||
        (!found && !begin_stage(trainer, 0, error)))
        return false;
    const int stages = RELATION_FORMS * trainer->training->rounds;
    if (trainer->state.stage >= stages || trainer->state.adam.steps > trainer->training->steps)
        return error_input(error, trainer->training->state_path, "stage %d, step %lld is not one of this training",
                           (int)trainer->state.stage, (long long)trainer->state.adam.steps);
    trainer->stage.share = 0.05;
    return record_first(trainer, error);
}

/* A form whose training is over before this run: its network follows from samples and weights. */
static bool restore_form(Trainer *trainer, int form, Error *error) {
    if (!gather(trainer, form, trainer->training->rounds - 1, error)) return false;
    relation_set_weights(&trainer->networks->forms[form], trainer->state.adam.weights + set_at(trainer, form, 0));
    return true;
}

static bool run(Trainer *trainer, Error *error) {
    const int rounds = trainer->training->rounds, stages = RELATION_FORMS * rounds;
    if (!begin(trainer, error)) return false;
    for (int form = 0; form < stage_form(trainer); form++)
        if (!restore_form(trainer, form, error)) return false;
    const double share = 0.95 / (stages - trainer->state.stage);
    bool gathered = false;
    for (;;) {
        next_stage(trainer, 0.2 * share);
        if (stage_round(trainer) == 0 || !gathered) {
            if (!gather(trainer, stage_form(trainer), stage_round(trainer), error)) return false;
        } else if (!record_round(trainer, stage_form(trainer), stage_round(trainer), error)) {
            return false;
        }
        gathered = true;
        next_stage(trainer, 0.8 * share);
        if (!run_stage(trainer, error)) return false;
        if (trainer->stage.stopped || trainer->state.stage + 1 == stages) return true;
        if (!begin_stage(trainer, trainer->state.stage + 1, error)) return false;
    }
}

bool relation_training_run(const RelationTraining *training, RelationNetworks *networks, const Progress *progress,
                           Error *error) {
    Trainer trainer = {.training = training, .networks = networks, .stage = {.whole = progress}};
    trainer.progress = (Progress){progress_stage, &trainer.stage};
    *networks = (RelationNetworks){0};
    bool ok = run(&trainer, error);
    if (ok && trainer.stage.stopped)
        ok = error_interrupted(error, training->state_path, "stopped; the same command continues");
    adam_free(&trainer.state.adam);
    relation_samples_free(&trainer.samples);
    relation_samples_free(&trainer.held_out_samples);
    impact_problems_free(&trainer.first);
    impact_problems_free(&trainer.held_out);
    return ok;
}

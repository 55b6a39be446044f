/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Training of sain: samples, recorded problems, and the rounds of each form. */
#include "learning/sain_training.h"

#include "base/base.h"
#include "base/machine.h"
#include "engine/engine.h"
#include "learning/learning.h"
#include "learning/scene_training.h"
#include "methods/methods.h"
#include "methods/pair.h"
#include "methods/reference.h"
#include "methods/sain.h"
#include "methods/sain_view.h"
#include "runs/runs.h"
#include "scenes/scenes.h"

#include <stdlib.h>
#include <string.h>

void sain_samples_free(SainSamples *samples) {
    free(samples->items);
    free(samples->rows);
    *samples = (SainSamples){.form = samples->form};
}

/* The engine of sain, and what it fills. */
typedef struct Engine {
    ContactSolver solver;
    PairMoment moment;
    SainView view;
} Engine;

static void sain_training_end(Engine *engine) {
    solver_destroy(&engine->solver);
    pair_moment_free(&engine->moment);
    sain_view_free(&engine->view);
}

static bool sain_training_look(Engine *engine, const ContactProblem *problem, SainForm form, Error *error) {
    if (!pair_moment_reserve(&engine->moment, problem)) return error_memory(error, "sain");
    ContactSolution solution = pair_moment_solution(&engine->moment);
    return solver_engine.solve(engine->solver.state, problem, &solution, error) &&
           (sain_view_make(&engine->view, problem, solution.velocities, form) || error_memory(error, "sain"));
}

static bool sain_training_reserve(SainSamples *samples, const SainView *view) {
    return array_reserve((void **)&samples->items, &samples->item_capacity,
                         samples->count + (size_t)view->body_count + 1, sizeof *samples->items) &&
           array_reserve((void **)&samples->rows, &samples->row_capacity,
                         samples->row_count + (size_t)view->row_count + 1, sizeof *samples->rows);
}

static void add_body(SainSamples *samples, const SainView *view, int b, const ReferenceVelocity *converged) {
    const SainBody *body = &view->bodies[b];
    SainSample *sample = &samples->items[samples->count++];
    double target[SAIN_OUTPUTS];
    *sample = (SainSample){.first = (int)samples->row_count, .rows = body->rows, .scale = body->scale};
    sain_target(body, converged->x, converged->y, converged->spin, target);
    for (int o = 0; o < SAIN_OUTPUTS; o++) sample->target[o] = (float)target[o];
    for (int i = 0; i < SAIN_BODY_INPUTS; i++) sample->body[i] = view->body_inputs[i * view->body_count + b];
    for (int r = body->first; r < body->first + body->rows; r++, samples->row_count++)
        for (int i = 0; i < SAIN_PAIR_INPUTS; i++)
            samples->rows[samples->row_count].numbers[i] = view->pair_inputs[i * view->row_count + r];
}

bool sain_samples_add(SainSamples *samples, const ImpactProblems *problems, bool impacts_only, Error *error) {
    Engine engine = {0};
    samples->unconverged += problems->unconverged;
    bool ok = solver_with(&engine.solver, &solver_engine, SAIN_ENGINE_SETTINGS, error);
    for (size_t p = 0; ok && p < problems->count; p++) {
        const ImpactProblem *item = &problems->items[p];
        if (impacts_only && !item->impact) continue;
        ok = sain_training_look(&engine, &item->problem, samples->form, error) &&
             (sain_training_reserve(samples, &engine.view) || error_memory(error, "sain"));
        for (int b = 0; ok && b < engine.view.body_count; b++)
            add_body(samples, &engine.view, b, &item->reference[engine.view.bodies[b].body]);
        samples->problems += engine.view.body_count > 0;
    }
    sain_training_end(&engine);
    return ok;
}

/* Every so many frames after the impact and at rest; they differ little. */
enum { AFTER_STEP = 6, REST_EVERY = 30, FACTORIZATIONS_MAX = 120 /* 95% of the impacts on pyramids take fewer */ };

static const double converged = 1e-6; /* m/s */

/* Launches of a scene. */
typedef struct Runs {
    const SainLaunches *from;
    const Scene *scene;
    Launch *launches;
    ImpactProblems *of; /* [launches] */
} Runs;

/* One launch. */
typedef struct Run {
    ImpactProblems *problems;
    Reference reference;
    PhaseTracker tracker;
    bool driven; /* by a network, which may fail: the run ends there */
} Run;

static bool sain_training_keep(Run *run, const ContactProblem *problem, int frame, Error *error) {
    const Phase phase = phase_next(&run->tracker, problem, frame);
    const bool wanted = phase == PHASE_IMPACT ||
                        (phase == PHASE_AFTER ? (frame - run->tracker.touch) % AFTER_STEP : frame % REST_EVERY) == 0;
    if (!wanted || problem->contact_count == 0) return true;
    if (!reference_solve_to(&run->reference, problem, converged, FACTORIZATIONS_MAX, error)) return false;
    if (!(run->reference.residual <= converged)) {
        run->problems->unconverged++;
        return true;
    }
    return impact_problems_add(run->problems, problem, run->reference.velocities, phase == PHASE_IMPACT) ||
           error_memory(error, "recording");
}

static bool is_over(const Run *run, int frame) {
    return run->tracker.touch > 0 && frame >= run->tracker.touch + run->tracker.impact_frames + AFTER_FRAMES;
}

static bool run_world(Run *run, const Scene *scene, World *world, const ContactSolver *solver, Error *error) {
    for (int frame = 1; frame <= scene->frames && !is_over(run, frame); frame++) {
        Error failure = {0};
        if (!world_step(world, solver->kind->solve, solver->state, scene->dt, &failure))
            return (run->driven && failure.failure != FAILURE_NONE) || (*error = failure, false);
        if (!sain_training_keep(run, world_problem(world), frame, error)) return false;
        if (frame == scene->bomb.frame && !scene_add_bomb(scene, world, error)) return false;
    }
    return true;
}

static bool make_solver(const SainDriver *driver, int i, ContactSolver *solver, Error *error) {
    if (driver != NULL) return sain_make(solver, driver->network, driver->form, error);
    return i % 2 == 0 ? solver_with(solver, &solver_engine, SAIN_ENGINE_SETTINGS, error)
                      : solver_with(solver, &solver_momentum, "k=50", error);
}

static bool piece(void *context, int i, Error *error) {
    const Runs *runs = context;
    const Scene launched = launch_scene(runs->scene, &runs->launches[i]);
    ContactSolver solver = {0};
    Run run = {.problems = &runs->of[i],
               .tracker = {.impact_frames = launched.bomb.impact_frames},
               .driven = runs->from->driver != NULL};
    World *world = scene_world(&launched, error);
    const bool ok = world != NULL && make_solver(runs->from->driver, i, &solver, error) &&
                    run_world(&run, &launched, world, &solver, error);
    world_destroy(world);
    solver_destroy(&solver);
    reference_free(&run.reference);
    return ok;
}

/* Launches rise along the family: a round takes one in `rounds`, so that each covers the family. */
static bool choose_launches(const Runs *runs, Error *error) {
    const SainLaunches *from = runs->from;
    const int all = from->rounds * from->launches;
    if (!(from->held_out ? launches_for_scoring : launches_for_training)(runs->scene, all, runs->launches, error))
        return false;
    for (int i = 0; i < from->launches; i++) runs->launches[i] = runs->launches[i * from->rounds + from->round];
    return launches_check(runs->scene, runs->launches, from->launches, error);
}

/* Appends to the problems in the order of launches and frames, for any number of threads. */
static bool record_scene(const SainLaunches *from, const Scene *scene, ImpactProblems *problems,
                         const Progress *progress, Error *error) {
    const size_t count = (size_t)from->launches;
    Runs runs = {from, scene, malloc((size_t)from->rounds * count * sizeof *runs.launches),
                 calloc(count + 1, sizeof *runs.of)};
    bool ok = (runs.launches != NULL && runs.of != NULL) || error_memory(error, scene->name);
    ok = ok && choose_launches(&runs, error) &&
         parallel_for(&(ParallelWork){piece, &runs}, from->launches, "launches", progress, error);
    for (size_t i = 0; runs.of != NULL && i < count; i++) {
        if (ok) ok = impact_problems_move(problems, &runs.of[i]) || error_memory(error, "recording");
        impact_problems_free(&runs.of[i]);
    }
    free(runs.launches);
    free(runs.of);
    return ok;
}

bool sain_launches_record(const SainLaunches *launches, ImpactProblems *problems, const Progress *progress,
                          Error *error) {
    for (int s = 0; s < launches->scene_count; s++)
        if (!record_scene(launches, launches->scenes[s], problems, progress, error)) return false;
    return true;
}

static const double first_rate = 0.003;

/* The weights of the state: of each form, those in training, then those that drove each round but the first. */
enum { SETS = 1 + SAIN_ROUNDS_MAX };

typedef struct Trainer {
    const SainTraining *training;
    SainNetworks *networks;
    int weights; /* of a form */
    Fit fit;
    ImpactProblems first, held_out; /* of the first round */
    SainSamples samples, held_out_samples;
    SainFit batches;
} Trainer;

static size_t set_at(const Trainer *trainer, int form, int set) {
    return ((size_t)form * SETS + (size_t)set) * (size_t)trainer->weights;
}

static int stage_form(const Trainer *trainer) { return trainer->fit.stage / trainer->training->rounds; }

static int stage_round(const Trainer *trainer) { return trainer->fit.stage % trainer->training->rounds; }

/* Ranges and normalisation follow from the samples; the driver's weights from the state. */
static bool record_round(Trainer *trainer, int form, int round, Error *error) {
    const SainTraining *training = trainer->training;
    SainNetwork *network = &trainer->networks->forms[form];
    ImpactProblems problems = {0};
    if (round == 0) {
        trainer->samples.form = (SainForm)form;
        trainer->held_out_samples.form = (SainForm)form;
        if (!sain_samples_add(&trainer->held_out_samples, &trainer->held_out, true, error) ||
            !sain_samples_add(&trainer->samples, &trainer->first, false, error))
            return false;
        sain_normalise(network, &trainer->samples);
    } else {
        sain_set_weights(network, trainer->fit.adam.weights + set_at(trainer, form, round));
        const SainDriver driver = {network, (SainForm)form};
        const SainLaunches launches = {
            training->scenes, training->scene_count, training->launches, training->rounds, round, false, &driver};
        const bool ok = sain_launches_record(&launches, &problems, &trainer->fit.progress, error) &&
                        sain_samples_add(&trainer->samples, &problems, false, error);
        impact_problems_free(&problems);
        if (!ok) return false;
    }
    sain_set_ranges(network, &trainer->samples);
    return true;
}

static bool sain_training_report(Trainer *trainer, double loss, Error *error) {
    const SainTraining *training = trainer->training;
    const int form = stage_form(trainer);
    SainScore score = {.form = (SainForm)form,
                       .round = stage_round(trainer),
                       .problems = trainer->samples.problems,
                       .bodies = trainer->samples.count,
                       .unconverged = trainer->samples.unconverged + trainer->held_out_samples.unconverged,
                       .loss = loss};
    if (training->on_score == NULL) return true;
    if (!sain_fit_errors(&trainer->batches, trainer->fit.adam.weights + set_at(trainer, form, 0),
                         &trainer->held_out_samples, &score.held_out, error))
        return false;
    training->on_score(training->context, &score);
    return true;
}

/* The rate falls from the first to 0 in equal steps; each round begins with half that of the round before. */
static bool sain_training_step(void *context, Adam *adam, double *loss, Error *error) {
    Trainer *trainer = context;
    const SainTraining *training = trainer->training;
    const uint64_t seed = training->seed + (uint64_t)(trainer->fit.stage + 1) * 1000003;
    const double rate = first_rate / (1 << stage_round(trainer)) * (1 - (double)adam->steps / training->steps);
    double batch_loss;
    if (!sain_fit_step(&trainer->batches, adam, seed, adam->steps, rate, &batch_loss, error)) return false;
    *loss += batch_loss;
    return true;
}

static bool fit_round(Trainer *trainer, Error *error) {
    const SainTraining *training = trainer->training;
    const FitSteps steps = {training->steps, training->saved, sain_training_step, NULL, trainer};
    const int64_t at = (int64_t)set_at(trainer, stage_form(trainer), 0);
    double loss;
    return fit_run(&trainer->fit, at, trainer->weights, &steps, &loss, error) &&
           sain_training_report(trainer, loss / training->saved, error);
}

static bool run_stage(Trainer *trainer, Error *error) {
    const int form = stage_form(trainer);
    SainNetwork *network = &trainer->networks->forms[form];
    if (trainer->samples.count == 0) return error_input(error, "sain", "no box is touched: more launches needed");
    if (!sain_fit_begin(&trainer->batches, network, &trainer->samples, trainer->training->batch, error)) return false;
    const bool ok = fit_round(trainer, error);
    sain_fit_free(&trainer->batches);
    sain_set_weights(network, trainer->fit.adam.weights + set_at(trainer, form, 0));
    return ok;
}

/* What drives the round is what was trained before it. */
static bool begin_stage(Trainer *trainer, int stage, Error *error) {
    fit_stage(&trainer->fit, stage);
    const int form = stage_form(trainer), round = stage_round(trainer);
    double *sets = trainer->fit.adam.weights, *weights = sets + set_at(trainer, form, 0);
    if (round > 0)
        memcpy(sets + set_at(trainer, form, round), weights, (size_t)trainer->weights * sizeof *weights);
    else
        sain_first_weights(&trainer->networks->forms[form], trainer->training->seed, weights);
    return fit_write(&trainer->fit, error);
}

/* The samples of the rounds of a form up to this one, and the form's network as it was. */
static bool sain_training_gather(Trainer *trainer, int form, int last, Error *error) {
    sain_samples_free(&trainer->samples);
    sain_samples_free(&trainer->held_out_samples);
    for (int round = 0; round <= last; round++)
        if (!record_round(trainer, form, round, error)) return false;
    return true;
}

static bool record_first(Trainer *trainer, Error *error) {
    const SainTraining *training = trainer->training;
    const SainLaunches
        first = {training->scenes, training->scene_count, training->launches, training->rounds, 0, false, NULL},
        others = {training->scenes, training->scene_count, training->launches / 4 + 1, 1, 0, true, NULL};
    return sain_launches_record(&first, &trainer->first, &trainer->fit.progress, error) &&
           sain_launches_record(&others, &trainer->held_out, &trainer->fit.progress, error);
}

static bool sain_training_begin(Trainer *trainer, Error *error) {
    Fit *fit = &trainer->fit;
    bool found;
    for (int f = 0; f < SAIN_FORMS; f++)
        if (!sain_network_create(&trainer->networks->forms[f], error)) return false;
    trainer->weights = sain_weight_count(&trainer->networks->forms[0]);
    if (!fit_begin(fit, (int64_t)set_at(trainer, SAIN_FORMS, 0), &found, error)) return false;
    const int stages = SAIN_FORMS * trainer->training->rounds;
    if (fit->stage >= stages || fit->adam.steps > trainer->training->steps)
        return error_input(error, fit->path, "stage %d, step %lld is not one of this training", (int)fit->stage,
                           (long long)fit->adam.steps);
    progress_next_stage(&fit->share, 0.05);
    return record_first(trainer, error) &&
           (found || begin_stage(trainer, 0, error)); /* a refused launch leaves no state */
}

/* A form whose training is over before this run: its network follows from samples and weights. */
static bool restore_form(Trainer *trainer, int form, Error *error) {
    if (!sain_training_gather(trainer, form, trainer->training->rounds - 1, error)) return false;
    sain_set_weights(&trainer->networks->forms[form], trainer->fit.adam.weights + set_at(trainer, form, 0));
    return true;
}

static bool run_sain_training(Trainer *trainer, Error *error) {
    const int rounds = trainer->training->rounds, stages = SAIN_FORMS * rounds;
    if (!sain_training_begin(trainer, error)) return false;
    for (int form = 0; form < stage_form(trainer); form++)
        if (!restore_form(trainer, form, error)) return false;
    const double share = 0.95 / (stages - trainer->fit.stage);
    bool gathered = false;
    for (;;) {
        progress_next_stage(&trainer->fit.share, 0.2 * share);
        if (stage_round(trainer) == 0 || !gathered) {
            if (!sain_training_gather(trainer, stage_form(trainer), stage_round(trainer), error)) return false;
        } else if (!record_round(trainer, stage_form(trainer), stage_round(trainer), error)) {
            return false;
        }
        gathered = true;
        progress_next_stage(&trainer->fit.share, 0.8 * share);
        if (!run_stage(trainer, error)) return false;
        if (trainer->fit.stage + 1 == stages) return true;
        if (!begin_stage(trainer, trainer->fit.stage + 1, error)) return false;
    }
}

bool sain_training_run(const SainTraining *training, SainNetworks *networks, const Progress *progress, Error *error) {
    Trainer trainer = {.training = training, .networks = networks};
    fit_init(&trainer.fit, training->command, training->state_path, progress);
    *networks = (SainNetworks){0};
    const bool ok = run_sain_training(&trainer, error);
    fit_free(&trainer.fit);
    sain_samples_free(&trainer.samples);
    sain_samples_free(&trainer.held_out_samples);
    impact_problems_free(&trainer.first);
    impact_problems_free(&trainer.held_out);
    return ok;
}

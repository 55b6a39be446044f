/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Training of hybrid, launch after launch. */
#include "learning/hybrid_training.h"

#include "base/base.h"
#include "base/file.h"
#include "base/machine.h"
#include "engine/engine.h"
#include "learning/learning.h"
#include "learning/scene_training.h"
#include "learning/scene_training_internal.h"
#include "methods/hybrid.h"
#include "methods/hybrid_memory.h"
#include "methods/methods.h"
#include "methods/pair.h"
#include "nets/kinds.h"
#include "runs/runs.h"
#include "scenes/scenes.h"

#include <stdlib.h>
#include <string.h>

enum { STORE_EVERY = 50 }; /* launches */

typedef struct Trainer {
    const Scene *scene;
    const HybridTraining *training;
    World *prefix;
    Launch *launches; /* [training->launches] */
    AskedSteps asked; /* of the launch; at first of all launches so far */
    ContactSolver interior;
    PairMoment answer, converged; /* work space */
    HybridMemory *memory;         /* NULL until the directions are fitted */
} Trainer;

/* Depends on the seed and i only. */
Launch hybrid_launch(const Scene *scene, uint64_t seed, int i, bool turns) {
    const SceneBomb *bomb = &scene->bomb;
    uint64_t state = seed;
    state = split_mix(&state) + (uint64_t)i;
    Launch launch = launch_of(scene);
    launch.x = scene_span_at(&bomb->x, random_unit(&state));
    const double rotation = random_unit(&state), spin = random_unit(&state);
    launch.rotation = scene_span_at(&bomb->rotation, rotation);
    launch.spin = scene_span_at(&bomb->spin, spin);
    if (turns) launch_turn(&launch, scene, rotation, spin);
    return launch;
}

static void draw_launches(Trainer *trainer) {
    const HybridTraining *training = trainer->training;
    for (int i = 0; i < training->launches; i++)
        trainer->launches[i] =
            hybrid_launch(trainer->scene, training->seed, i, training->turned_from >= 0 && i >= training->turned_from);
}

static bool fit_keys(Trainer *trainer, Error *error) {
    const AskedSteps *asked = &trainer->asked;
    if (asked->count == 0)
        return error_input(error, trainer->scene->name, "no launch has an impact whose residual reaches the gate");
    const ContactProblem *first = &asked->items[0].problem;
    HybridMemory *memory = trainer->memory =
        hybrid_memory_create(first->body_count, first->bomb, trainer->training->components, error);
    if (memory == NULL) return false;
    memory->gate = hybrid_gate;
    memory->tolerance = trainer->training->tolerance;
    snprintf(memory->scene, sizeof memory->scene, "%s", trainer->scene->name);
    snprintf(memory->command, sizeof memory->command, "%s", trainer->training->command);
    const size_t width = (size_t)memory->numbers;
    float *others = malloc((size_t)asked->count * width * sizeof *others);
    if (others == NULL) return error_memory(error, "hybrid");
    for (int i = 0; i < asked->count; i++)
        memcpy(others + (size_t)i * width, asked->items[i].others, width * sizeof *others);
    const bool ok = key_fit(memory, others, asked->count, trainer->training->seed, error);
    free(others);
    return ok;
}

static bool hybrid_training_check(Trainer *trainer, SolvedStep *step, int entry, HybridLaunch *launch, Error *error) {
    if (!pair_moment_reserve(&trainer->converged, step->problem)) return error_memory(error, "hybrid");
    ContactSolution converged = pair_moment_solution(&trainer->converged),
                    answer = pair_moment_solution(&trainer->answer);
    if (!trainer->interior.kind->solve(trainer->interior.state, step->problem, &converged, error)) return false;
    step->solution = &converged;
    launch->error += (double)entry_check(trainer->memory, entry, step, &answer);
    step->solution = NULL;
    launch->checked++;
    return true;
}

static bool learn_step(Trainer *trainer, const AskedStep *asked, bool checks, HybridLaunch *launch, Error *error) {
    float key[HYBRID_KEY_MAX];
    hybrid_memory_key(trainer->memory, asked->bomb, asked->others, key);
    SolvedStep step = {&asked->problem, &asked->solution, {asked->hash, asked->problem.contact_count, key}};
    if (!pair_moment_reserve(&trainer->answer, &asked->problem)) return error_memory(error, "hybrid");
    if (asked->entry >= 0) return !checks || hybrid_training_check(trainer, &step, asked->entry, launch, error);
    ContactSolution answer = pair_moment_solution(&trainer->answer);
    Lesson lesson;
    if (!entry_learn(trainer->memory, &step, trainer->training->limit, &answer, &lesson, error)) return false;
    launch->grown += lesson == LESSON_GROWN;
    launch->added += lesson == LESSON_ADDED;
    launch->full += lesson == LESSON_FULL;
    return true;
}

/* Runs a launch and learns from it. The launches before the directions are fitted are learned together. */
static bool do_launch(Trainer *trainer, int i, Error *error) {
    HybridLaunch launch = {.number = i + 1};
    const int before = trainer->asked.count, last = trainer->training->launches - 1;
    const int64_t steps_before = trainer->asked.steps;
    const double seconds_before = trainer->asked.seconds;
    if (!launch_steps_run(trainer->scene, trainer->prefix, &trainer->launches[i], trainer->memory,
                          trainer->training->steps, &trainer->asked, error))
        return false;
    launch.asked = trainer->asked.count - before;
    launch.steps = trainer->asked.steps - steps_before;
    const double copying = trainer->asked.seconds - seconds_before;
    for (int k = before; k < trainer->asked.count; k++) launch.answered += trainer->asked.items[k].entry >= 0;
    const double begin = clock_thread_seconds();
    const bool first = trainer->memory == NULL;
    if (first && (i + 1 == HYBRID_FIRST || i == last) && !fit_keys(trainer, error)) return false;
    if (trainer->memory != NULL) {
        const bool checks = i % HYBRID_CHECK_EVERY == 0;
        for (int k = 0; k < trainer->asked.count; k++)
            if (!learn_step(trainer, &trainer->asked.items[k], checks, &launch, error)) return false;
        asked_steps_clear(&trainer->asked);
        trainer->memory->launches = i + 1;
    }
    launch.learning += clock_thread_seconds() - begin + copying;
    launch.memory = trainer->memory;
    const HybridTraining *training = trainer->training;
    return training->on_launch == NULL || training->on_launch(training->context, &launch, error);
}

/* A state of the same command, or nothing. */
static bool resume(Trainer *trainer, Error *error) {
    const HybridTraining *training = trainer->training;
    bool there;
    if (training->state_path == NULL) return true;
    if (!file_find(training->state_path, &there, error)) return false;
    if (!there) return true;
    trainer->memory = hybrid_memory_read(training->state_path, error);
    if (trainer->memory == NULL) return false;
    if (strcmp(trainer->memory->command, training->command) == 0 && trainer->memory->launches <= training->launches)
        return true;
    hybrid_memory_destroy(trainer->memory);
    trainer->memory = NULL;
    return true;
}

static bool hybrid_training_store(const Trainer *trainer, Error *error) {
    const HybridMemory *memory = trainer->memory;
    if (trainer->training->state_path == NULL || memory == NULL || memory->entry_count == 0) return true;
    return hybrid_memory_write(memory, trainer->training->state_path, error);
}

static bool hybrid_training_train(Trainer *trainer, const Progress *progress, Error *error) {
    const int launches = trainer->training->launches;
    if (!launches_check(trainer->scene, trainer->launches, launches, error) || !resume(trainer, error)) return false;
    trainer->prefix = hybrid_prefix(trainer->scene, error);
    if (trainer->prefix == NULL || !hybrid_make(&trainer->interior, NULL, NULL, error)) return false;
    for (int i = trainer->memory != NULL ? trainer->memory->launches : 0; i < launches; i++) {
        if (!do_launch(trainer, i, error)) return false;
        const bool goes_on = progress_report(progress, i + 1, launches);
        if ((!goes_on || (i + 1) % STORE_EVERY == 0) && !hybrid_training_store(trainer, error)) return false;
        if (!goes_on) break;
    }
    return trainer->memory != NULL || error_interrupted(error, "hybrid", "stopped before anything was learned");
}

HybridMemory *hybrid_training_run(const Scene *scene, const HybridTraining *training, const Progress *progress,
                                  Error *error) {
    if (!scene->bomb.present) return error_input(error, scene->name, "has no bomb to launch"), NULL;
    Trainer trainer = {.scene = scene,
                       .training = training,
                       .launches = malloc((size_t)training->launches * sizeof *trainer.launches)};
    bool ok = trainer.launches != NULL || error_memory(error, "hybrid");
    if (ok) {
        draw_launches(&trainer);
        ok = hybrid_training_train(&trainer, progress, error);
    }
    world_destroy(trainer.prefix);
    solver_destroy(&trainer.interior);
    asked_steps_free(&trainer.asked);
    free(trainer.launches);
    pair_moment_free(&trainer.answer);
    pair_moment_free(&trainer.converged);
    if (ok) return trainer.memory;
    hybrid_memory_destroy(trainer.memory);
    return NULL;
}

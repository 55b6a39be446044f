/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "relation_training/relation_samples.h"

#include "common/array.h"
#include "solvers/solvers.h"

#include <stdlib.h>

void relation_samples_free(RelationSamples *samples) {
    free(samples->items);
    free(samples->rows);
    *samples = (RelationSamples){.form = samples->form};
}

/* The engine of sain, and what it fills. */
typedef struct Engine {
    void *state;
    ContactSolution solution;
    size_t velocity_capacity, impulse_capacity;
    RelationView view;
} Engine;

static bool begin(Engine *engine, Error *error) {
    Settings settings;
    if (!settings_parse(&settings, RELATION_ENGINE_SETTINGS, solver_engine.description.settings, "sain", error))
        return false;
    engine->state = solver_engine.create(&settings, error);
    return engine->state != NULL;
}

static void end(Engine *engine) {
    if (engine->state != NULL) solver_engine.destroy(engine->state);
    free(engine->solution.velocities);
    free(engine->solution.impulses);
    relation_view_free(&engine->view);
}

static bool look(Engine *engine, const ContactProblem *problem, RelationForm form, Error *error) {
    ContactSolution *solution = &engine->solution;
    return (array_reserve((void **)&solution->velocities, &engine->velocity_capacity, (size_t)problem->body_count + 1,
                          sizeof *solution->velocities) &&
            array_reserve((void **)&solution->impulses, &engine->impulse_capacity, (size_t)problem->contact_count + 1,
                          sizeof *solution->impulses) &&
            solver_engine.solve(engine->state, problem, solution, error) &&
            relation_view_make(&engine->view, problem, solution->velocities, form)) ||
           error_memory(error, "sain");
}

static bool reserve(RelationSamples *samples, const RelationView *view) {
    return array_reserve((void **)&samples->items, &samples->item_capacity,
                         samples->count + (size_t)view->body_count + 1, sizeof *samples->items) &&
           array_reserve((void **)&samples->rows, &samples->row_capacity,
                         samples->row_count + (size_t)view->row_count + 1, sizeof *samples->rows);
}

static void add_body(RelationSamples *samples, const RelationView *view, int b, const ReferenceVelocity *converged) {
    const RelationBody *body = &view->bodies[b];
    RelationSample *sample = &samples->items[samples->count++];
    double target[RELATION_OUTPUTS];
    *sample = (RelationSample){.first = (int)samples->row_count, .rows = body->rows, .scale = body->scale};
    relation_target(body, converged->x, converged->y, converged->spin, target);
    for (int o = 0; o < RELATION_OUTPUTS; o++) sample->target[o] = (float)target[o];
    for (int i = 0; i < RELATION_BODY_INPUTS; i++) sample->body[i] = view->body_inputs[i * view->body_count + b];
    for (int r = body->first; r < body->first + body->rows; r++, samples->row_count++)
        for (int i = 0; i < RELATION_PAIR_INPUTS; i++)
            samples->rows[samples->row_count].numbers[i] = view->pair_inputs[i * view->row_count + r];
}

bool relation_samples_add(RelationSamples *samples, const ImpactProblems *problems, bool impacts_only, Error *error) {
    Engine engine = {0};
    bool ok = begin(&engine, error);
    for (size_t p = 0; ok && p < problems->count; p++) {
        const ImpactProblem *item = &problems->items[p];
        if (impacts_only && !item->impact) continue;
        ok = look(&engine, &item->problem, samples->form, error) &&
             (reserve(samples, &engine.view) || error_memory(error, "sain"));
        for (int b = 0; ok && b < engine.view.body_count; b++)
            add_body(samples, &engine.view, b, &item->reference[engine.view.bodies[b].body]);
        samples->problems += engine.view.body_count > 0;
    }
    end(&engine);
    return ok;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Simulator-augmented interaction networks. The engine solves each step with 10 sweeps; then a network corrects the
   velocity and the spin of each body that touches another:

       e_rs = relation(r, s),   v_r = v_r(engine) + scale_r * object(r, sum over s of e_rs)

   for each receiver r and each sender s that touches it (relation/relation_view.h). It is trained on the converged
   solution minus the engine's (relation_training/relation_training.h). Impulses, the warm start of the next step, stay
   those of the engine. Two ablations have networks of their own in the same file: engine=off sees the velocities before
   the step and predicts their whole change, without impulses (an interaction network); engine=shuffled sees, and
   corrects, what the engine did to another body. Source: Ajay, Bauza, Wu, Fazeli, Tenenbaum, Rodriguez, Kaelbling,
   "Combining Physical Simulators and Object-Based Networks for Control" (2019), arXiv 1904.06580. Their network
   corrects poses of two pushed discs at the rate of a controller; here velocities, as positions follow from them.

   A body whose inputs are beyond those of the training data keeps what the engine did; without an engine its inputs are
   moved to the ends of their ranges. An answer that is NaN, infinite or larger than in training is discarded.

   Fails where a correction depends on bodies further away: a message crosses one contact in a step, an impact the whole
   stack. Corrections are no impulses: they create momentum, and may push boxes into each other. */
#include "solvers/sain.h"

#include "common/names.h"
#include "solvers/solvers.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct Sain {
    RelationNetworks own; /* empty if the network is another's */
    const RelationNetwork *network;
    RelationForm form;
    bool predicts;
    void *engine; /* state of solver_engine */
    RelationView view;
    RelationAnswers answers;
} Sain;

static const SettingSpec settings[] = {
    {"network", "file of the trained networks (default: the scene's)"},
    {"engine", "on|off|shuffled: what the network knows of the engine: all, nothing, or what it did to another body "
               "(default: on)"},
    {"net", "on|off: off is the engine alone (default: on)"},
    {NULL, NULL}};

static void destroy(void *state) {
    Sain *solver = state;
    if (solver == NULL) return;
    relation_networks_destroy(&solver->own);
    if (solver->engine != NULL) solver_engine.destroy(solver->engine);
    relation_view_free(&solver->view);
    relation_answers_free(&solver->answers);
    free(solver);
}

static Sain *make(Error *error) {
    Settings of_engine;
    Sain *solver = calloc(1, sizeof *solver);
    if (solver == NULL) {
        error_memory(error, "sain");
        return NULL;
    }
    solver->predicts = true;
    if (settings_parse(&of_engine, RELATION_ENGINE_SETTINGS, solver_engine.description.settings, "sain", error))
        solver->engine = solver_engine.create(&of_engine, error);
    if (solver->engine != NULL) return solver;
    destroy(solver);
    return NULL;
}

static bool read_form(const Settings *chosen, RelationForm *form, Error *error) {
    const char *name = settings_get(chosen, "engine");
    if (name == NULL) return true;
    NameList known = {0};
    for (RelationForm f = 0; f < RELATION_FORMS; f++) {
        name_list_add(&known, relation_form_names[f]);
        if (strcmp(relation_form_names[f], name) != 0) continue;
        *form = f;
        return true;
    }
    return error_unknown(error, "engine", name, "a form of sain", &known);
}

static void *create(const Settings *chosen, Error *error) {
    const char *path = settings_get(chosen, "network");
    if (path == NULL) {
        error_input(error, "sain", "the scene names no network for it: use sain:network=FILE");
        return NULL;
    }
    Sain *solver = make(error);
    if (solver == NULL) return NULL;
    if (read_form(chosen, &solver->form, error) && settings_bool(chosen, "net", &solver->predicts, error) &&
        relation_networks_read(&solver->own, path, error)) {
        solver->network = &solver->own.forms[solver->form];
        return solver;
    }
    destroy(solver);
    return NULL;
}

bool sain_make(ContactSolver *solver, const RelationNetwork *network, RelationForm form, Error *error) {
    Sain *state = make(error);
    if (state == NULL) return false;
    state->network = network;
    state->form = form;
    *solver = (ContactSolver){&solver_sain, state};
    return true;
}

/* Without an engine: velocities before the step, no impulses. */
static void forget_engine(const ContactProblem *problem, ContactSolution *solution) {
    for (int i = 0; i < problem->body_count; i++)
        solution->velocities[i] = (BodyVelocity){problem->bodies[i].velocity, problem->bodies[i].angular_velocity};
    for (int i = 0; i < problem->contact_count; i++) solution->impulses[i] = (ContactImpulse){0, 0};
}

/* All are finite and within the limits of the training data. */
static bool is_usable(const float *outputs, const float *limit, const BodyVelocity *velocity) {
    for (int o = 0; o < RELATION_OUTPUTS; o++)
        if (!(fabsf(outputs[o]) <= limit[o])) return false;
    return isfinite(velocity->linear.x) && isfinite(velocity->linear.y) && isfinite(velocity->angular);
}

/* N s: the momentum that the step's impulses do not account for. */
static float created_momentum(const ProblemBody *body, const BodyVelocity *velocity, const BodyVelocity *by_impulses) {
    const Vec2 change = vec2_sub(velocity->linear, by_impulses->linear);
    return body->inv_mass > 0.0f ? sqrtf(vec2_dot(change, change)) / body->inv_mass : 0.0f;
}

static void correct(Sain *solver, const ContactProblem *problem, ContactSolution *solution) {
    const RelationView *view = &solver->view;
    bool all_known = true;
    for (int b = 0; b < view->body_count; b++) {
        const RelationBody *body = &view->bodies[b];
        const float *outputs = solver->answers.outputs + (ptrdiff_t)b * RELATION_OUTPUTS;
        const BodyVelocity velocity = relation_corrected(body, outputs), before = solution->velocities[body->body];
        all_known = all_known && solver->answers.known[b];
        if (!solver->answers.known[b] && solver->form != RELATION_ALONE) continue;
        if (!is_usable(outputs, solver->network->limit, &velocity)) {
            solution->fallbacks.not_finite++;
            continue;
        }
        solution->velocities[body->body] = velocity;
        solution->momentum_error += created_momentum(&problem->bodies[body->body], &velocity, &before);
    }
    solution->fallbacks.beyond_training = !all_known;
}

static bool solve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    Sain *solver = state;
    const bool alone = solver->form == RELATION_ALONE && solver->predicts;
    if (alone)
        forget_engine(problem, solution);
    else if (!solver_engine.solve(solver->engine, problem, solution, error))
        return false;
    if (!solver->predicts) return true;
    if (!relation_view_make(&solver->view, problem, solution->velocities, solver->form) ||
        !relation_answer(&solver->answers, solver->network, &solver->view, alone))
        return error_memory(error, "sain");
    solution->momentum_error = 0;
    solution->fallbacks = (NetworkFallbacks){0};
    correct(solver, problem, solution);
    return true;
}

const ContactSolverKind solver_sain = {
    .description = {.name = "sain",
                    .summary = "10 sweeps of the engine, then a network corrects each body that touches another",
                    .caption = "engine corrected by an interaction network",
                    .look = {METHOD_ORANGE, METHOD_TRIANGLE},
                    .settings = settings,
                    .needs_network = true,
                    .twin = "sain:net=off",
                    .chart = METHOD_RUNS("", "engine=off", "engine=shuffled", "net=off"),
                    .chart_quick = METHOD_NO_RUNS,
                    .stability = METHOD_NO_RUNS},
    .create = create,
    .solve = solve,
    .destroy = destroy};

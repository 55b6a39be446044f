/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/base.h"
#include "base/npz.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "methods/relation_view.h"
#include "methods/solvers.h"
#include "nets/nets.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { RELATION_LAYERS = 3, OBJECT_LAYERS = 2 };

bool relation_network_create(RelationNetwork *network, Error *error) {
    static const int relation[RELATION_LAYERS + 1] = {RELATION_PAIR_INPUTS, RELATION_HIDDEN, RELATION_HIDDEN,
                                                      RELATION_EFFECTS},
                                                object[OBJECT_LAYERS + 1] = {RELATION_OBJECT_INPUTS, RELATION_HIDDEN,
                                                                             RELATION_OUTPUTS};
    *network = (RelationNetwork){.relation = network_create(RELATION_LAYERS, relation, error)};
    if (network->relation != NULL) network->object = network_create(OBJECT_LAYERS, object, error);
    if (network->object == NULL) return false;
    for (int l = 0; l < RELATION_LAYERS; l++) network->relation->activations[l] = ACTIVATION_TANH;
    network->object->activations[0] = ACTIVATION_TANH;
    return true;
}

void relation_network_destroy(RelationNetwork *network) {
    network_destroy(network->relation);
    network_destroy(network->object);
    *network = (RelationNetwork){0};
}

void relation_networks_destroy(RelationNetworks *networks) {
    for (int f = 0; f < RELATION_FORMS; f++) relation_network_destroy(&networks->forms[f]);
}

void relation_answers_free(RelationAnswers *answers) {
    free(answers->outputs);
    free(answers->known);
    free(answers->effects);
    free(answers->inputs);
    free(answers->columns);
    free(answers->scratch);
    *answers = (RelationAnswers){0};
}

static bool reserve(RelationAnswers *answers, const RelationNetwork *network, const RelationView *view) {
    const size_t bodies = (size_t)view->body_count + 1, rows = (size_t)view->row_count + 1,
                 relation = network_batch_scratch(network->relation), object = network_batch_scratch(network->object);
    return array_reserve((void **)&answers->outputs, &answers->output_capacity, bodies * RELATION_OUTPUTS,
                         sizeof(float)) &&
           array_reserve((void **)&answers->known, &answers->known_capacity, bodies, sizeof(bool)) &&
           array_reserve((void **)&answers->effects, &answers->effect_capacity, rows * RELATION_EFFECTS,
                         sizeof(float)) &&
           array_reserve((void **)&answers->inputs, &answers->input_capacity, bodies * RELATION_OBJECT_INPUTS,
                         sizeof(float)) &&
           array_reserve((void **)&answers->columns, &answers->column_capacity, bodies * RELATION_OUTPUTS,
                         sizeof(float)) &&
           array_reserve((void **)&answers->scratch, &answers->scratch_capacity, relation > object ? relation : object,
                         sizeof(float));
}

/* A NaN counts as outside, and is moved to the lower end. */
static bool check(float *numbers, int stride, int count, const float *low, const float *high, bool clamp) {
    bool inside = true;
    for (int i = 0; i < count; i++) {
        float *x = &numbers[i * stride];
        if (*x >= low[i] && *x <= high[i]) continue;
        inside = false;
        if (clamp) *x = *x > high[i] ? high[i] : low[i];
    }
    return inside;
}

static void check_ranges(RelationAnswers *answers, const RelationNetwork *network, RelationView *view, bool clamp) {
    for (int b = 0; b < view->body_count; b++) {
        const RelationBody *body = &view->bodies[b];
        bool known = check(view->body_inputs + b, view->body_count, RELATION_BODY_INPUTS, network->body_low,
                           network->body_high, clamp);
        for (int r = body->first; r < body->first + body->rows; r++)
            known = check(view->pair_inputs + r, view->row_count, RELATION_PAIR_INPUTS, network->pair_low,
                          network->pair_high, clamp) &&
                    known;
        answers->known[b] = known;
    }
}

/* Body inputs, and the sums of effects in the order of the rows. */
static void fill_object_inputs(RelationAnswers *answers, const RelationView *view) {
    const int bodies = view->body_count;
    memcpy(answers->inputs, view->body_inputs, (size_t)bodies * RELATION_BODY_INPUTS * sizeof *answers->inputs);
    for (int e = 0; e < RELATION_EFFECTS; e++) {
        const float *effects = answers->effects + (ptrdiff_t)e * view->row_count;
        float *sums = answers->inputs + (ptrdiff_t)(RELATION_BODY_INPUTS + e) * bodies;
        for (int b = 0; b < bodies; b++) {
            const RelationBody *body = &view->bodies[b];
            float sum = 0;
            for (int r = body->first; r < body->first + body->rows; r++) sum += effects[r];
            sums[b] = sum;
        }
    }
}

bool relation_answer(RelationAnswers *answers, const RelationNetwork *network, RelationView *view, bool clamp) {
    if (!reserve(answers, network, view)) return false;
    check_ranges(answers, network, view, clamp);
    if (view->body_count == 0) return true;
    network_predict_batch(network->relation, view->pair_inputs, answers->scratch, answers->effects, view->row_count);
    fill_object_inputs(answers, view);
    network_predict_batch(network->object, answers->inputs, answers->scratch, answers->columns, view->body_count);
    for (int b = 0; b < view->body_count; b++)
        for (int o = 0; o < RELATION_OUTPUTS; o++)
            answers->outputs[b * RELATION_OUTPUTS + o] = answers->columns[o * view->body_count + b];
    return true;
}

/* Files of sain: .npz with version, kind ("sain"), command, and as float32 for each form F = on, off, shuffled:
   F_pair_weights and F_body_weights, weights and biases of the relation and the object network, each as one vector
   (nets/nets.h); offsets and scales of their inputs, F_pair_offset, F_pair_scale, F_body_offset, F_body_scale;
   ranges, F_pair_low, F_pair_high, F_body_low, F_body_high; F_limit. */

#define KIND "sain"

enum { FORM_ARRAYS = 11, ARRAYS = RELATION_FORMS * FORM_ARRAYS };

/* One list for writing and reading. */
static void list_form(RelationNetwork *network, const char *form, FileFloats list[FORM_ARRAYS]) {
    Network *relation = network->relation, *object = network->object;
    const FileFloats all[FORM_ARRAYS] = {
        {"pair_weights", 1, {network_parameter_count(relation)}, relation->weights[0], &float_any},
        {"pair_offset", 1, {RELATION_PAIR_INPUTS}, relation->input.offset, &float_any},
        {"pair_scale", 1, {RELATION_PAIR_INPUTS}, relation->input.scale, &float_positive},
        {"body_weights", 1, {network_parameter_count(object)}, object->weights[0], &float_any},
        {"body_offset", 1, {RELATION_OBJECT_INPUTS}, object->input.offset, &float_any},
        {"body_scale", 1, {RELATION_OBJECT_INPUTS}, object->input.scale, &float_positive},
        {"pair_low", 1, {RELATION_PAIR_INPUTS}, network->pair_low, &float_any},
        {"pair_high", 1, {RELATION_PAIR_INPUTS}, network->pair_high, &float_any},
        {"body_low", 1, {RELATION_BODY_INPUTS}, network->body_low, &float_any},
        {"body_high", 1, {RELATION_BODY_INPUTS}, network->body_high, &float_any},
        {"limit", 1, {RELATION_OUTPUTS}, network->limit, &float_not_negative},
    };
    for (int i = 0; i < FORM_ARRAYS; i++) {
        list[i] = all[i];
        snprintf(list[i].name, sizeof list[i].name, "%.8s_%.12s", form, all[i].name);
    }
}

static void list_floats(RelationNetworks *networks, FileFloats list[ARRAYS]) {
    for (int f = 0; f < RELATION_FORMS; f++)
        list_form(&networks->forms[f], relation_form_names[f], list + f * FORM_ARRAYS);
}

bool relation_networks_write(const RelationNetworks *networks, const char *path, Error *error) {
    const int32_t version = RELATION_VERSION;
    RelationNetworks copy = *networks; /* the list has pointers that are not const */
    FileFloats list[ARRAYS];
    list_floats(&copy, list);
    NpzArray arrays[3 + ARRAYS] = {{.name = "version", .type = NPZ_INT32, .data = &version},
                                   {.name = "kind", .type = NPZ_TEXT, .data = KIND},
                                   {.name = "command", .type = NPZ_TEXT, .data = networks->command}};
    for (int i = 0; i < ARRAYS; i++) arrays[3 + i] = file_floats_array(&list[i]);
    return npz_write(path, arrays, 3 + ARRAYS, error);
}

static bool create_forms(RelationNetworks *networks, Error *error) {
    for (int f = 0; f < RELATION_FORMS; f++)
        if (!relation_network_create(&networks->forms[f], error)) return false;
    return true;
}

bool relation_networks_read(RelationNetworks *networks, const char *path, Error *error) {
    *networks = (RelationNetworks){0};
    NpzFile *file = npz_open(path, error);
    if (file == NULL) return false;
    FileFloats list[ARRAYS];
    bool ok = npz_check_kind(file, KIND, RELATION_VERSION, error) && create_forms(networks, error);
    if (ok) {
        list_floats(networks, list);
        ok = file_floats_read(file, list, ARRAYS, error) &&
             npz_read_text(file, "command", networks->command, sizeof networks->command, error);
    }
    npz_close(file);
    if (!ok) relation_networks_destroy(networks);
    return ok;
}

/* Simulator-augmented interaction networks. The engine solves each step with 10 sweeps; then a network corrects the
   velocity and the spin of each body that touches another:

       e_rs = relation(r, s),   v_r = v_r(engine) + scale_r * object(r, sum over s of e_rs)

   for each receiver r and each sender s that touches it (methods/relation_view.h). It is trained on the converged
   solution minus the engine's (learning/sain_training.h). Impulses, the warm start of the next step, stay
   those of the engine. Two ablations have networks of their own in the same file: engine=off sees the velocities before
   the step and predicts their whole change, without impulses (an interaction network); engine=shuffled sees, and
   corrects, what the engine did to another body. Source: Ajay, Bauza, Wu, Fazeli, Tenenbaum, Rodriguez, Kaelbling,
   "Combining Physical Simulators and Object-Based Networks for Control" (2019), arXiv 1904.06580. Their network
   corrects poses of two pushed discs at the rate of a controller; here velocities, as positions follow from them.

   A body whose inputs are beyond those of the training data keeps what the engine did; without an engine its inputs are
   moved to the ends of their ranges. An answer that is NaN, infinite or larger than in training is discarded.

   Fails where a correction depends on bodies further away: a message crosses one contact in a step, an impact the whole
   stack. Corrections are no impulses: they create momentum, and may push boxes into each other. */

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

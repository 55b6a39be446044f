/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Simulator-augmented interaction networks. The engine solves each step with 10 sweeps; then a network corrects the
   velocity and the spin of each body that touches another:

       e_rs = relation(r, s),   v_r = v_r(engine) + scale_r * object(r, sum over s of e_rs)

   for each receiver r and each sender s that touches it (methods/sain_view.h). It is trained on the converged
   solution minus the engine's (learning/sain_training.h). Impulses, the warm start of the next step, stay
   those of the engine. Source: Ajay, Bauza, Wu, Fazeli, Tenenbaum, Rodriguez, Kaelbling,
   "Combining Physical Simulators and Object-Based Networks for Control" (2019), arXiv 1904.06580. Their network
   corrects poses of two pushed discs at the rate of a controller; here velocities, as positions follow from them.

   A body whose inputs are beyond those of the training data keeps what the engine did. An answer that is NaN, infinite
   or larger than in training is discarded.

   Fails where a correction depends on bodies further away: a message crosses one contact in a step, an impact the whole
   stack. Corrections are no impulses: they create momentum, and may push boxes into each other. */
#include "base/base.h"
#include "base/npz.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "methods/sain.h"
#include "methods/sain_view.h"
#include "nets/nets.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SAIN_LAYERS = 3, OBJECT_LAYERS = 2 };

bool sain_network_create(SainNetwork *network, Error *error) {
    static const int relation[SAIN_LAYERS + 1] = {SAIN_PAIR_INPUTS, SAIN_HIDDEN, SAIN_HIDDEN, SAIN_EFFECTS},
                                            object[OBJECT_LAYERS + 1] = {SAIN_OBJECT_INPUTS, SAIN_HIDDEN, SAIN_OUTPUTS};
    *network = (SainNetwork){.relation = network_create(SAIN_LAYERS, relation, error)};
    if (network->relation != NULL) network->object = network_create(OBJECT_LAYERS, object, error);
    if (network->object == NULL) return false;
    for (int l = 0; l < SAIN_LAYERS; l++) network->relation->activations[l] = ACTIVATION_TANH;
    network->object->activations[0] = ACTIVATION_TANH;
    return true;
}

void sain_network_destroy(SainNetwork *network) {
    network_destroy(network->relation);
    network_destroy(network->object);
    *network = (SainNetwork){0};
}

void sain_answers_free(SainAnswers *answers) {
    free(answers->arrays.memory);
    *answers = (SainAnswers){0};
}

/* False for a NaN, too. */
static bool in_range(const float *numbers, int stride, int count, const float *low, const float *high) {
    for (int i = 0; i < count; i++)
        if (!(numbers[i * stride] >= low[i] && numbers[i * stride] <= high[i])) return false;
    return true;
}

bool sain_answer(SainAnswers *answers, const SainNetwork *network, const SainView *view) {
    const size_t bodies = (size_t)view->body_count + 1, rows = (size_t)view->row_count + 1,
                 relation = network_batch_scratch(network->relation), object = network_batch_scratch(network->object);
    if (!ARRAY_BLOCK_RESERVE(&answers->arrays, ARRAY_PART(answers->outputs, bodies * SAIN_OUTPUTS),
                             ARRAY_PART(answers->known, bodies), ARRAY_PART(answers->effects, rows * SAIN_EFFECTS),
                             ARRAY_PART(answers->inputs, bodies * SAIN_OBJECT_INPUTS),
                             ARRAY_PART(answers->columns, bodies * SAIN_OUTPUTS),
                             ARRAY_PART(answers->scratch, relation > object ? relation : object)))
        return false;
    const int count = view->body_count;
    for (int b = 0; b < count; b++) {
        const SainBody *body = &view->bodies[b];
        bool known = in_range(view->body_inputs + b, count, SAIN_BODY_INPUTS, network->body_low, network->body_high);
        for (int r = body->first; known && r < body->first + body->rows; r++)
            known = in_range(view->pair_inputs + r, view->row_count, SAIN_PAIR_INPUTS, network->pair_low,
                             network->pair_high);
        answers->known[b] = known;
    }
    if (count == 0) return true;
    network_predict_batch(network->relation, view->pair_inputs, answers->scratch, answers->effects, view->row_count);

    /* The object network sees the body's inputs, and the sums of effects in the order of the rows. */
    memcpy(answers->inputs, view->body_inputs, (size_t)count * SAIN_BODY_INPUTS * sizeof *answers->inputs);
    for (int e = 0; e < SAIN_EFFECTS; e++) {
        const float *effects = answers->effects + (ptrdiff_t)e * view->row_count;
        for (int b = 0; b < count; b++) {
            const SainBody *body = &view->bodies[b];
            float sum = 0;
            for (int r = body->first; r < body->first + body->rows; r++) sum += effects[r];
            answers->inputs[(SAIN_BODY_INPUTS + e) * count + b] = sum;
        }
    }
    network_predict_batch(network->object, answers->inputs, answers->scratch, answers->columns, count);
    for (int b = 0; b < count; b++)
        for (int o = 0; o < SAIN_OUTPUTS; o++) answers->outputs[b * SAIN_OUTPUTS + o] = answers->columns[o * count + b];
    return true;
}

/* Files of sain: kind "sain". Weights and biases of a network are one vector. */

static int list_fields(void *of, NetField *fields) {
    SainNetwork *network = of;
    const Network *pair = network->relation, *body = network->object;
    const struct {
        const char *name;
        int count;
        float *data;
        const FloatBounds *range;
    } floats[] = {{"on_pair_weights", network_parameter_count(pair), pair->weights[0], &float_any},
                  {"on_pair_offset", SAIN_PAIR_INPUTS, pair->input.offset, &float_any},
                  {"on_pair_scale", SAIN_PAIR_INPUTS, pair->input.scale, &float_positive},
                  {"on_body_weights", network_parameter_count(body), body->weights[0], &float_any},
                  {"on_body_offset", SAIN_OBJECT_INPUTS, body->input.offset, &float_any},
                  {"on_body_scale", SAIN_OBJECT_INPUTS, body->input.scale, &float_positive},
                  {"on_pair_low", SAIN_PAIR_INPUTS, network->pair_low, &float_any},
                  {"on_pair_high", SAIN_PAIR_INPUTS, network->pair_high, &float_any},
                  {"on_body_low", SAIN_BODY_INPUTS, network->body_low, &float_any},
                  {"on_body_high", SAIN_BODY_INPUTS, network->body_high, &float_any},
                  {"on_limit", SAIN_OUTPUTS, network->limit, &float_not_negative}};
    const int count = sizeof floats / sizeof *floats;
    fields[0] = (NetField){"command", NPZ_TEXT, 0, {sizeof network->command}, .data = network->command};
    for (int i = 0; i < count; i++) {
        fields[1 + i] =
            (NetField){"", NPZ_FLOAT32, 1, {floats[i].count}, .data = floats[i].data, .range = floats[i].range};
        snprintf(fields[1 + i].name, sizeof fields->name, "%s", floats[i].name);
    }
    return 1 + count;
}

static const NetFileKind kind = {"sain", SAIN_VERSION, list_fields, NULL, NULL, NULL};

bool sain_network_write(const SainNetwork *network, const char *path, Error *error) {
    return net_file_write(&kind, network, path, error);
}

bool sain_network_read(SainNetwork *network, const char *path, Error *error) {
    const bool ok = sain_network_create(network, error) && net_file_read(&kind, network, path, error);
    if (!ok) sain_network_destroy(network);
    return ok;
}

typedef struct Sain {
    SainNetwork own; /* empty if the network is another's */
    const SainNetwork *network;
    bool predicts;
    void *engine; /* state of solver_engine */
    SainView view;
    SainAnswers answers;
} Sain;

static const SettingSpec settings[] = {
    {"network", "file of the trained networks (default: the scene's)", SETTING_OWN},
    {"net", "on|off: off is the engine alone (default: on)", SETTING_BOOL(Sain, predicts)},
    {0}};

static void destroy(void *state) {
    Sain *solver = state;
    if (solver == NULL) return;
    sain_network_destroy(&solver->own);
    if (solver->engine != NULL) solver_engine.destroy(solver->engine);
    sain_view_free(&solver->view);
    sain_answers_free(&solver->answers);
    free(solver);
}

static Sain *make_sain(Error *error) {
    Settings of_engine;
    Sain *solver = calloc(1, sizeof *solver);
    if (solver == NULL) {
        error_memory(error, "sain");
        return NULL;
    }
    solver->predicts = true;
    if (settings_parse(&of_engine, SAIN_ENGINE_SETTINGS, solver_engine.description.settings, "sain", error))
        solver->engine = solver_engine.create(&of_engine, error);
    if (solver->engine != NULL) return solver;
    destroy(solver);
    return NULL;
}

static void *create(const Settings *chosen, Error *error) {
    const char *path = method_network(chosen, NULL, "sain", error);
    Sain *solver = path != NULL ? make_sain(error) : NULL;
    if (solver == NULL) return NULL;
    solver->network = &solver->own;
    if (settings_read(chosen, settings, solver, error) && sain_network_read(&solver->own, path, error)) return solver;
    destroy(solver);
    return NULL;
}

bool sain_make(ContactSolver *solver, const SainNetwork *network, Error *error) {
    Sain *state = make_sain(error);
    if (state == NULL) return false;
    state->network = network;
    *solver = (ContactSolver){&solver_sain, state};
    return true;
}

/* Adds the answers to the velocities of the bodies that they are usable for: finite, and within the limits of the
   training data. */
static void correct(Sain *solver, const ContactProblem *problem, ContactSolution *solution) {
    const SainView *view = &solver->view;
    bool all_known = true;
    for (int b = 0; b < view->body_count; b++) {
        const SainBody *body = &view->bodies[b];
        const float *outputs = solver->answers.outputs + (ptrdiff_t)b * SAIN_OUTPUTS;
        const BodyVelocity velocity = sain_corrected(body, outputs), before = solution->velocities[body->body];
        all_known = all_known && solver->answers.known[b];
        if (!solver->answers.known[b]) continue;
        bool usable = isfinite(velocity.linear.x) && isfinite(velocity.linear.y) && isfinite(velocity.angular);
        for (int o = 0; o < SAIN_OUTPUTS; o++) usable = usable && fabsf(outputs[o]) <= solver->network->limit[o];
        if (!usable) {
            solution->fallbacks.not_finite++;
            continue;
        }
        const Vec2 change = vec2_sub(velocity.linear, before.linear);
        const float inv_mass = problem->bodies[body->body].inv_mass;
        solution->velocities[body->body] = velocity;
        if (inv_mass > 0) solution->momentum_error += sqrtf(vec2_dot(change, change)) / inv_mass; /* no impulse's */
    }
    solution->fallbacks.beyond_training = !all_known;
}

static bool solve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    Sain *solver = state;
    if (!solver_engine.solve(solver->engine, problem, solution, error)) return false;
    if (!solver->predicts) return true;
    if (!sain_view_make(&solver->view, problem, solution->velocities) ||
        !sain_answer(&solver->answers, solver->network, &solver->view))
        return error_memory(error, "sain");
    solution->momentum_error = 0;
    solution->fallbacks = (Fallbacks){0};
    correct(solver, problem, solution);
    return true;
}

const ContactSolverKind solver_sain = {
    .description = {.name = "sain",
                    .summary = "10 sweeps of the engine, then a network corrects each body that touches another",
                    .caption = "engine corrected by an interaction network",
                    .settings = settings,
                    .needs_network = true,
                    .twin = "sain:net=off",
                    .chart = METHOD_RUNS("", "net=off"),
                    .chart_quick = METHOD_NO_RUNS,
                    .stability = METHOD_NO_RUNS},
    .create = create,
    .solve = solve,
    .destroy = destroy};

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rates of right predictions of a network, of the constant predictor and of the engine with fewer sweeps. */
#include "base/base.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "methods/pair.h"
#include "methods/pair_net.h"
#include "methods/reference.h"
#include "methods/sweeps.h"
#include "paper/paper_internal.h"
#include "scenes/scenes.h"
#include "studies/frozen.h"
#include "studies/rollout.h"

#include <math.h>
#include <stdlib.h>

const char *const rate_definition_names[RATE_DEFINITIONS + 1] = {"range", "absolute", "bodies"};

static const double near_share = 0.05, near_velocity = 0.1; /* of the range; m/s */

/* Errors of all columns for one pair, compared with the engine. */
typedef struct PairError {
    Vec2 error[RATE_COLUMNS]; /* m/s */
    Phase phase;
} PairError;

/* One network in one scene. */
typedef struct Rating {
    const Scene *scene;
    PairNetwork network;
    World *world;
    bool warm; /* no network: the warm start */
    double weights[PHASES];
    ContactSolver solvers[RATE_COLUMNS]; /* kind NULL: no solver */
    PairMoment results[RATE_COLUMNS];
    PairMoment now; /* in the middle of a step */
    float least[2], most[2];
    PairError *pairs;
    size_t pair_count, pair_capacity;
    double right[PHASES][RATE_COLUMNS], bodies[PHASES][RATE_COLUMNS];
} Rating;

static bool add_engine(Rating *rating, RateColumn column, const char *text, Error *error) {
    Method method;
    return method_parse(&method, text, error) &&
           method_create_solver(&method, rating->scene, &rating->solvers[column], error);
}

static bool add_network(Rating *rating, RateColumn column, const char *name, const char *path, Error *error) {
    Method method;
    return method_with_network(&method, name, path, error) &&
           method_create_solver(&method, rating->scene, &rating->solvers[column], error);
}

static bool add_networks(Rating *rating, const char *path, Error *error) {
    if (!pair_network_read(&rating->network, path, error)) return false;
    const PairTarget target = rating->network.target;
    /* Such a network would need the impulses at points and does not predict them. */
    if (target == TARGET_IMPULSE && pair_views[rating->network.view].by_contact) return true;
    const bool points = target == TARGET_POINTS;
    return add_network(rating, RATE_NETWORK, points ? "contact-net" : "pair-net", path, error) &&
           add_network(rating, RATE_CONSTANT, points ? "contact-net:net=off" : "pair-net:net=off", path, error);
}

static bool pair_rates_begin(Rating *rating, const char *path, const Sampling *sampling, Error *error) {
    rating->weights[PHASE_IMPACT] = 1;
    rating->weights[PHASE_AFTER] = sampling->after;
    rating->weights[PHASE_REST] = sampling->rest;
    rating->warm = path == NULL;
    rating->world = scene_world(rating->scene, error);
    if (rating->world == NULL) return false;
    for (int k = 0; k < 2; k++) rating->least[k] = INFINITY, rating->most[k] = -INFINITY;
    if (rating->warm)
        rating->network.view = PAIR_NEIGHBOURS, rating->network.target = TARGET_POINTS;
    else if (!add_networks(rating, path, error))
        return false;
    return add_engine(rating, RATE_ENGINE1, "engine:k=1", error) &&
           add_engine(rating, RATE_ENGINE4, "engine:k=4", error) &&
           add_engine(rating, RATE_ENGINE10, "engine:k=10", error);
}

static void pair_rates_end(Rating *rating) {
    if (!rating->warm) pair_network_free(&rating->network);
    for (int c = 0; c < RATE_COLUMNS; c++) {
        if (rating->solvers[c].kind != NULL) rating->solvers[c].kind->destroy(rating->solvers[c].state);
        pair_moment_free(&rating->results[c]);
    }
    pair_moment_free(&rating->now);
    world_destroy(rating->world);
    free(rating->pairs);
}

static const SequentialOptions engine_options = {.accumulate = true, .warm = true};

/* Solves the problem with every column that can. */
static bool solve_all(Rating *rating, const ContactProblem *problem, Error *error) {
    for (int c = 0; c < RATE_COLUMNS; c++) {
        const ContactSolver *solver = &rating->solvers[c];
        if (!pair_moment_reserve(&rating->results[c], problem)) return error_memory(error, "rates");
        ContactSolution solution = pair_moment_solution(&rating->results[c]);
        if (rating->warm && c == RATE_NETWORK) sequential_impulses_begin(problem, &engine_options, &solution);
        if (solver->kind != NULL && !solver->kind->solve(solver->state, problem, &solution, error)) return false;
    }
    return true;
}

static Vec2 pair_rates_relative(const float changes[PAIR_CHANGES]) {
    return vec2(changes[3] - changes[0], changes[4] - changes[1]);
}

/* The same for a network's outputs. */
static Vec2 relative_output(const PairNetwork *network, const float *outputs, int step) {
    if (network->network->widths[network->network->layers] == 2) return vec2(outputs[0], outputs[step]);
    return vec2(outputs[3 * step] - outputs[0], outputs[4 * step] - outputs[step]);
}

static bool add_pair(Rating *rating, const PairError *pair, Vec2 truth, Error *error) {
    if (!array_reserve((void **)&rating->pairs, &rating->pair_capacity, rating->pair_count + 1, sizeof *pair))
        return error_memory(error, "rates");
    rating->pairs[rating->pair_count++] = *pair;
    rating->least[0] = fminf(rating->least[0], truth.x), rating->most[0] = fmaxf(rating->most[0], truth.x);
    rating->least[1] = fminf(rating->least[1], truth.y), rating->most[1] = fmaxf(rating->most[1], truth.y);
    return true;
}

/* The change of a pair's relative velocity by a column's solution. */
static Vec2 solved_change(const Rating *rating, const ContactProblem *problem, RateColumn column, int first) {
    const ContactSolution solution = pair_moment_solution(&rating->results[column]);
    const PairTarget target = rating->network.target == TARGET_NET ? TARGET_NET : TARGET_PAIR;
    float changes[PAIR_CHANGES];
    pair_step_changes(problem, &solution, first, rating->network.view, target, changes);
    return pair_rates_relative(changes);
}

static bool rate_pairs(Rating *rating, const ContactProblem *problem, Phase phase, Error *error) {
    const bool by_solution = rating->network.target == TARGET_POINTS;
    int pairs = 0;
    const float *outputs = NULL;
    if (!by_solution && (outputs = pair_network_predict(&rating->network, problem, &pairs)) == NULL)
        return problem->contact_count == 0 || error_memory(error, "rates");
    for (int first = 0; first < problem->contact_count; first += pair_contact_count(problem, first)) {
        PairError pair = {.phase = phase};
        const Vec2 truth = solved_change(rating, problem, RATE_ENGINE10, first);
        for (RateColumn c = by_solution ? RATE_NETWORK : RATE_ENGINE1; c < RATE_COLUMNS; c++)
            pair.error[c] = vec2_sub(solved_change(rating, problem, c, first), truth);
        if (!by_solution) {
            pair.error[RATE_NETWORK] = vec2_sub(relative_output(&rating->network, outputs++, pairs), truth);
            pair.error[RATE_CONSTANT] =
                vec2_sub(relative_output(&rating->network, rating->network.network->output_mean, 1), truth);
        }
        if (!add_pair(rating, &pair, truth, error)) return false;
    }
    return true;
}

/* The engine's sweeps, visit by visit. */
static bool rate_visits(Rating *rating, const ContactProblem *problem, Phase phase, Error *error) {
    PairNetwork *network = &rating->network;
    if (!pair_moment_reserve(&rating->now, problem)) return error_memory(error, "rates");
    ContactSolution now = pair_moment_solution(&rating->now);
    sequential_impulses_begin(problem, &engine_options, &now);
    for (int sweep = 0; sweep < rating->scene->iterations; sweep++)
        for (int first = 0, count; first < problem->contact_count; first += count) {
            const ContactPoint *contact = &problem->contacts[first];
            count = pair_contact_count(problem, first);
            float outputs[PAIR_CHANGES], changes[PAIR_CHANGES] = {0};
            pair_network_predict_one(network, problem, &rating->now, first, outputs);
            const Vec2 before = vec2_sub(now.velocities[contact->b].linear, now.velocities[contact->a].linear);
            sequential_impulses_visit(problem, &engine_options, first, count, &now);
            const Vec2 after = vec2_sub(now.velocities[contact->b].linear, now.velocities[contact->a].linear);
            changes[3] = after.x - before.x;
            changes[4] = after.y - before.y;
            if (pair_views[network->view].by_contact) pair_to_contact_frame(contact, changes);
            const Vec2 truth = pair_rates_relative(changes);
            PairError pair = {.phase = phase};
            pair.error[RATE_NETWORK] = vec2_sub(relative_output(network, outputs, 1), truth);
            pair.error[RATE_CONSTANT] = vec2_sub(relative_output(network, network->network->output_mean, 1), truth);
            if (!add_pair(rating, &pair, truth, error)) return false;
        }
    return true;
}

/* Whether a column has a solution of the step. */
static bool takes_steps(const Rating *rating, int column) {
    return rating->solvers[column].kind != NULL || (rating->warm && column == RATE_NETWORK);
}

static void rate_bodies(Rating *rating, const ContactProblem *problem, const Snapshot *snapshot) {
    for (int c = 0; c < RATE_COLUMNS; c++) {
        if (!takes_steps(rating, c)) continue;
        SolutionError found = solution_error(problem, rating->results[c].velocities, snapshot->reference);
        rating->right[snapshot->phase][c] += found.right;
        rating->bodies[snapshot->phase][c] += found.counted;
    }
}

static bool rate_snapshot(Rating *rating, const Snapshot *snapshot, Error *error) {
    ContactProblem problem;
    ContactSolution *unused;
    if (!world_copy(rating->world, snapshot->world, error) ||
        !world_begin_step(rating->world, rating->scene->dt, &problem, &unused, error) ||
        !solve_all(rating, &problem, error))
        return false;
    rate_bodies(rating, &problem, snapshot);
    return rating->network.target == TARGET_IMPULSE ? rate_visits(rating, &problem, snapshot->phase, error)
                                                    : rate_pairs(rating, &problem, snapshot->phase, error);
}

static bool is_right(const Rating *rating, RateDefinition definition, Vec2 error) {
    if (definition == RATE_ABSOLUTE) return vec2_distance(error, vec2(0, 0)) <= near_velocity;
    return fabs((double)error.x) <= near_share * (double)(rating->most[0] - rating->least[0]) &&
           fabs((double)error.y) <= near_share * (double)(rating->most[1] - rating->least[1]);
}

/* From right[PHASES], count[PHASES]: the shares of each phase and of all. */
static void set_shares(const Rating *rating, const double *right, const double *count, RateDefinition definition,
                       RateColumn column, PairRates *rates) {
    double all_right = 0, all_count = 0;
    for (int phase = 0; phase < PHASES; phase++) {
        rates->share[definition][phase][column] = count[phase] > 0 ? right[phase] / count[phase] : NAN;
        all_right += rating->weights[phase] * right[phase];
        all_count += rating->weights[phase] * count[phase];
    }
    rates->share[definition][RATE_ALL][column] = all_count > 0 ? all_right / all_count : NAN;
}

static void count_pairs(const Rating *rating, RateDefinition definition, RateColumn column, PairRates *rates) {
    double right[PHASES] = {0}, count[PHASES] = {0};
    for (size_t i = 0; i < rating->pair_count; i++) {
        const PairError *pair = &rating->pairs[i];
        right[pair->phase] += is_right(rating, definition, pair->error[column]);
        count[pair->phase]++;
    }
    set_shares(rating, right, count, definition, column, rates);
}

static void pair_rates_summarise(const Rating *rating, PairRates *rates) {
    for (RateColumn c = 0; c < RATE_COLUMNS; c++) {
        double right[PHASES], bodies[PHASES];
        for (int phase = 0; phase < PHASES; phase++) {
            right[phase] = rating->right[phase][c];
            bodies[phase] = rating->bodies[phase][c];
        }
        set_shares(rating, right, bodies, RATE_BODIES, c, rates);
        count_pairs(rating, RATE_RANGE, c, rates);
        count_pairs(rating, RATE_ABSOLUTE, c, rates);
    }
    if (!rating->warm) return;
    for (int definition = 0; definition < RATE_BODIES; definition++)
        for (int phase = 0; phase < RATE_PHASES; phase++) rates->share[definition][phase][RATE_CONSTANT] = NAN;
}

bool pair_rates_measure(const char *path, const Scene *scene, const SnapshotList *lists, int count,
                        const Sampling *sampling, PairRates *rates, Error *error) {
    Rating rating = {.scene = scene};
    bool ok = pair_rates_begin(&rating, path, sampling, error);
    for (int i = 0; ok && i < count; i++)
        for (int s = 0; ok && s < lists[i].count; s++) ok = rate_snapshot(&rating, &lists[i].items[s], error);
    if (ok) pair_rates_summarise(&rating, rates);
    pair_rates_end(&rating);
    return ok;
}

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
#include "studies/rollout.h"

#include <math.h>
#include <stdlib.h>

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
    bool warm;                           /* no network: the warm start */
    ContactSolver solvers[RATE_COLUMNS]; /* kind NULL: no solver */
    PairMoment results[RATE_COLUMNS];
    PairMoment now;          /* in the middle of a step */
    float least[2], most[2]; /* of the engine's changes */
    PairError *pairs;
    size_t pair_count, pair_capacity;
    double right[PHASES][RATE_COLUMNS], bodies[PHASES][RATE_COLUMNS];
} Rating;

static bool add_solver(Rating *rating, RateColumn column, const char *name, const char *path, Error *error) {
    Method method;
    return (path != NULL ? method_with_network(&method, name, path, error) : method_parse(&method, name, error)) &&
           method_create_solver(&method, rating->scene, &rating->solvers[column], error);
}

static bool begin_rating(Rating *rating, const char *path, Error *error) {
    rating->warm = path == NULL;
    rating->world = scene_world(rating->scene, error);
    if (rating->world == NULL) return false;
    for (int k = 0; k < 2; k++) rating->least[k] = INFINITY, rating->most[k] = -INFINITY;
    if (rating->warm) {
        rating->network.view = PAIR_NEIGHBOURS, rating->network.target = TARGET_POINTS;
    } else {
        if (!pair_network_read(&rating->network, path, error)) return false;
        const bool points = rating->network.target == TARGET_POINTS;
        if (network_takes_steps(rating->network.target, rating->network.view) &&
            (!add_solver(rating, RATE_NETWORK, points ? "contact-net" : "pair-net", path, error) ||
             !add_solver(rating, RATE_CONSTANT, points ? "contact-net:net=off" : "pair-net:net=off", path, error)))
            return false;
    }
    return add_solver(rating, RATE_ENGINE1, "engine:k=1", NULL, error) &&
           add_solver(rating, RATE_ENGINE4, "engine:k=4", NULL, error) &&
           add_solver(rating, RATE_ENGINE10, "engine:k=10", NULL, error);
}

static const SequentialOptions engine_options = {.accumulate = true, .warm = true};

static Vec2 relative(const float changes[PAIR_CHANGES]) {
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
    return relative(changes);
}

static bool rate_pairs(Rating *rating, const ContactProblem *problem, Phase phase, Error *error) {
    const PairNetwork *network = &rating->network;
    const bool by_solution = network->target == TARGET_POINTS;
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
            pair.error[RATE_NETWORK] = vec2_sub(relative_output(network, outputs++, pairs), truth);
            pair.error[RATE_CONSTANT] = vec2_sub(relative_output(network, network->network->output_mean, 1), truth);
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
            const Vec2 truth = relative(changes);
            PairError pair = {.phase = phase};
            pair.error[RATE_NETWORK] = vec2_sub(relative_output(network, outputs, 1), truth);
            pair.error[RATE_CONSTANT] = vec2_sub(relative_output(network, network->network->output_mean, 1), truth);
            if (!add_pair(rating, &pair, truth, error)) return false;
        }
    return true;
}

/* A sampled step is solved by every column that can, then its bodies and its pairs are rated. */
static bool rate_step(Rating *rating, const Snapshot *snapshot, Error *error) {
    const Phase phase = snapshot->phase;
    ContactProblem problem;
    ContactSolution *unused;
    if (!world_copy(rating->world, snapshot->world, error) ||
        !world_begin_step(rating->world, rating->scene->dt, &problem, &unused, error))
        return false;
    for (int c = 0; c < RATE_COLUMNS; c++) {
        const ContactSolver *solver = &rating->solvers[c];
        const bool warm = rating->warm && c == RATE_NETWORK;
        if (!pair_moment_reserve(&rating->results[c], &problem)) return error_memory(error, "rates");
        ContactSolution solution = pair_moment_solution(&rating->results[c]);
        if (warm) sequential_impulses_begin(&problem, &engine_options, &solution);
        if (solver->kind != NULL && !solver->kind->solve(solver->state, &problem, &solution, error)) return false;
        if (solver->kind == NULL && !warm) continue;
        const SolutionError found = solution_error(&problem, rating->results[c].velocities, snapshot->reference);
        rating->right[phase][c] += found.right;
        rating->bodies[phase][c] += found.counted;
    }
    return rating->network.target == TARGET_IMPULSE ? rate_visits(rating, &problem, phase, error)
                                                    : rate_pairs(rating, &problem, phase, error);
}

/* The shares of each phase, and of all frames. */
static void set_shares(const Sampling *sampling, const double right[PHASES], const double count[PHASES],
                       double share[RATE_PHASES][RATE_COLUMNS], RateColumn column) {
    const double weights[PHASES] = {[PHASE_IMPACT] = 1, [PHASE_AFTER] = sampling->after, [PHASE_REST] = sampling->rest};
    double all_right = 0, all_count = 0;
    for (int phase = 0; phase < PHASES; phase++) {
        share[phase][column] = count[phase] > 0 ? right[phase] / count[phase] : NAN;
        all_right += weights[phase] * right[phase];
        all_count += weights[phase] * count[phase];
    }
    share[RATE_ALL][column] = all_count > 0 ? all_right / all_count : NAN;
}

static void find_shares(const Rating *rating, const Sampling *sampling, PairRates *rates) {
    const double range[2] = {near_share * (double)(rating->most[0] - rating->least[0]),
                             near_share * (double)(rating->most[1] - rating->least[1])};
    for (RateColumn c = 0; c < RATE_COLUMNS; c++) {
        double right[RATE_DEFINITIONS][PHASES] = {{0}}, pairs[PHASES] = {0}, bodies[PHASES];
        for (int phase = 0; phase < PHASES; phase++) {
            right[RATE_BODIES][phase] = rating->right[phase][c];
            bodies[phase] = rating->bodies[phase][c];
        }
        for (size_t i = 0; i < rating->pair_count; i++) {
            const PairError *pair = &rating->pairs[i];
            const Vec2 error = pair->error[c];
            right[RATE_ABSOLUTE][pair->phase] += vec2_distance(error, vec2(0, 0)) <= near_velocity;
            right[RATE_RANGE][pair->phase] += fabs((double)error.x) <= range[0] && fabs((double)error.y) <= range[1];
            pairs[pair->phase]++;
        }
        for (RateDefinition definition = 0; definition < RATE_DEFINITIONS; definition++)
            set_shares(sampling, right[definition], definition == RATE_BODIES ? bodies : pairs,
                       rates->share[definition], c);
    }
    /* The warm start has no mean that is always predicted. */
    for (int definition = 0; rating->warm && definition < RATE_BODIES; definition++)
        for (int phase = 0; phase < RATE_PHASES; phase++) rates->share[definition][phase][RATE_CONSTANT] = NAN;
}

bool pair_rates_measure(const char *path, const Scene *scene, const SnapshotList *lists, int count,
                        const Sampling *sampling, PairRates *rates, Error *error) {
    Rating rating = {.scene = scene};
    bool ok = begin_rating(&rating, path, error);
    for (int i = 0; ok && i < count; i++)
        for (int s = 0; ok && s < lists[i].count; s++) ok = rate_step(&rating, &lists[i].items[s], error);
    if (ok) find_shares(&rating, sampling, rates);
    if (!rating.warm) pair_network_free(&rating.network);
    for (int c = 0; c < RATE_COLUMNS; c++) {
        if (rating.solvers[c].kind != NULL) rating.solvers[c].kind->destroy(rating.solvers[c].state);
        pair_moment_free(&rating.results[c]);
    }
    pair_moment_free(&rating.now);
    world_destroy(rating.world);
    free(rating.pairs);
    return ok;
}

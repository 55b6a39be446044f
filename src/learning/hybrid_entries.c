/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the memory of hybrid learns from a step, and the runs whose steps it learns. */
#include "base/base.h"
#include "base/machine.h"
#include "engine/engine.h"
#include "learning/hybrid_training.h"
#include "learning/scene_training_internal.h"
#include "methods/hybrid.h"
#include "methods/hybrid_memory.h"
#include "methods/methods.h"
#include "methods/sweeps.h"
#include "nets/kernels.h"
#include "nets/kinds.h"
#include "scenes/scenes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* An ellipsoid grows by steps of at most this: farther points are accurate by chance. m/s; 2 are 17 cm of the bomb's
   place. */
static const float step_max = 2;
/* Share of the neighbours' mean squared distance that is added to the normal equations: neighbours in one direction
   leave them singular. */
static const double ridge = 1e-4;

float velocity_error(const ContactProblem *problem, const BodyVelocity *a, const BodyVelocity *b) {
    double sum = 0;
    int count = 0;
    for (int i = 0; i < problem->body_count; i++) {
        if (problem->bodies[i].inv_mass == 0) continue;
        const double x = (double)(a[i].linear.x - b[i].linear.x), y = (double)(a[i].linear.y - b[i].linear.y),
                     spin = (double)(a[i].angular - b[i].angular);
        sum += x * x + y * y + spin * spin / 6;
        count++;
    }
    return count > 0 ? (float)sqrt(sum / count) : 0;
}

/* An entry in the making. */
typedef struct NewEntry {
    int count; /* neighbours */
    int32_t near[HYBRID_NEAR];
    float from[HYBRID_NEAR][HYBRID_KEY_MAX]; /* x_j - x0 */
    float distance[HYBRID_NEAR];             /* its squared length */
    float weights[HYBRID_NEAR * HYBRID_KEY_MAX];
    double images[HYBRID_NEAR][HYBRID_NEAR]; /* products of the velocity changes that P_j - P0 make */
    float metric[HYBRID_KEY_MAX * (HYBRID_KEY_MAX + 1) / 2];
} NewEntry;

static void insert_neighbour(NewEntry *fit, const HybridMemory *memory, int entry, const float *key) {
    const float *other = memory->keys + (size_t)entry * (size_t)memory->key_size;
    float from[HYBRID_KEY_MAX], distance = 0;
    for (int i = 0; i < memory->key_size; i++) {
        from[i] = other[i] - key[i];
        distance += from[i] * from[i];
    }
    int at = fit->count < HYBRID_NEAR ? fit->count++ : HYBRID_NEAR;
    if (at == HYBRID_NEAR && !(distance < fit->distance[--at])) return;
    for (; at > 0 && distance < fit->distance[at - 1]; at--) {
        fit->near[at] = fit->near[at - 1];
        fit->distance[at] = fit->distance[at - 1];
        for (int i = 0; i < memory->key_size; i++) fit->from[at][i] = fit->from[at - 1][i];
    }
    fit->near[at] = entry;
    fit->distance[at] = distance;
    for (int i = 0; i < memory->key_size; i++) fit->from[at][i] = from[i];
}

/* Within 2 step_max: between them both ellipsoids can reach. */
static void find_neighbours(NewEntry *fit, const HybridMemory *memory, const HybridQuery *query) {
    fit->count = 0;
    int count;
    const int32_t *entries = hybrid_memory_about(memory, query, 2 * step_max, &count);
    for (int i = 0; i < count; i++) insert_neighbour(fit, memory, entries[i], query->key);
    while (fit->count > 0 && fit->distance[fit->count - 1] > 4 * step_max * step_max) fit->count--;
}

/* Inverts a symmetric positive definite matrix in place, by Gauss and Jordan. */
static void hybrid_entries_invert(double matrix[HYBRID_NEAR][HYBRID_NEAR], int count) {
    for (int p = 0; p < count; p++) {
        const double pivot = 1 / matrix[p][p];
        matrix[p][p] = 1;
        for (int j = 0; j < count; j++) matrix[p][j] *= pivot;
        for (int i = 0; i < count; i++) {
            if (i == p) continue;
            const double factor = matrix[i][p];
            matrix[i][p] = 0;
            for (int j = 0; j < count; j++) matrix[i][j] -= factor * matrix[p][j];
        }
    }
}

/* Rows of (D^T D + ridge)^-1 D^T, with the neighbours' x_j - x0 as columns of D. */
static void fit_weights(NewEntry *fit, int key_size) {
    double normal[HYBRID_NEAR][HYBRID_NEAR], trace = 0;
    for (int n = 0; n < fit->count; n++)
        for (int m = 0; m < fit->count; m++) {
            normal[n][m] = 0;
            for (int i = 0; i < key_size; i++) normal[n][m] += (double)fit->from[n][i] * (double)fit->from[m][i];
            trace += n == m ? normal[n][n] : 0;
        }
    for (int n = 0; n < fit->count; n++) normal[n][n] += ridge * trace / fit->count + 1e-12;
    hybrid_entries_invert(normal, fit->count);
    for (int n = 0; n < HYBRID_NEAR; n++)
        for (int i = 0; i < key_size; i++) {
            double sum = 0;
            for (int m = 0; n < fit->count && m < fit->count; m++) sum += normal[n][m] * (double)fit->from[m][i];
            fit->weights[n * key_size + i] = (float)sum;
        }
}

/* The velocity changes of P_j - P0; velocities[body_count] are 0 before. */
static void push_difference(const HybridMemory *memory, int entry, const SolvedStep *step, BodyVelocity *velocities) {
    const ContactImpulse *other = memory->impulses + memory->entry_begin[entry];
    for (int i = 0; i < step->problem->contact_count; i++) {
        const ContactImpulse own = step->solution->impulses[i];
        const ContactImpulse difference = {other[i].normal - own.normal, other[i].tangent - own.tangent};
        contact_push(velocities, &step->problem->contacts[i], step->problem->bodies, difference);
    }
}

static bool find_images(NewEntry *fit, const HybridMemory *memory, const SolvedStep *step) {
    const size_t bodies = (size_t)step->problem->body_count;
    BodyVelocity *changes = calloc(HYBRID_NEAR * bodies, sizeof *changes);
    if (changes == NULL) return false;
    int moving = 0;
    for (size_t i = 0; i < bodies; i++) moving += step->problem->bodies[i].inv_mass > 0;
    for (int n = 0; n < fit->count; n++) push_difference(memory, fit->near[n], step, changes + (size_t)n * bodies);
    for (int n = 0; n < fit->count; n++)
        for (int m = 0; m < fit->count; m++) {
            double sum = 0;
            for (size_t i = 0; i < bodies; i++) {
                const BodyVelocity *a = &changes[(size_t)n * bodies + i], *b = &changes[(size_t)m * bodies + i];
                sum += (double)(a->linear.x * b->linear.x + a->linear.y * b->linear.y + a->angular * b->angular / 6);
            }
            fit->images[n][m] = moving > 0 ? sum / moving : 0;
        }
    free(changes);
    return true;
}

/* M = A^T A / tolerance^2 + 1 / tolerance^2, A here of velocities: inside the ellipsoid the linear term is at most the
   tolerance, as in Pope (1997), and in directions that A does not know bodies are taken to follow the state one to
   one. */
static void make_metric(NewEntry *fit, const HybridMemory *memory) {
    const int size = memory->key_size;
    const double unit = 1 / ((double)memory->tolerance * (double)memory->tolerance);
    float *metric = fit->metric;
    for (int i = 0; i < size; i++)
        for (int j = 0; j <= i; j++) {
            double sum = i == j ? 1 : 0;
            for (int n = 0; n < fit->count; n++)
                for (int m = 0; m < fit->count; m++)
                    sum += (double)fit->weights[n * size + i] * fit->images[n][m] * (double)fit->weights[m * size + j];
            *metric++ = (float)(unit * sum);
        }
}

static bool hybrid_entries_add(HybridMemory *memory, const SolvedStep *step, Error *error) {
    NewEntry fit;
    find_neighbours(&fit, memory, &step->query);
    for (int n = fit.count; n < HYBRID_NEAR; n++) fit.near[n] = -1;
    fit_weights(&fit, memory->key_size);
    if (!find_images(&fit, memory, step)) return error_memory(error, "hybrid");
    make_metric(&fit, memory);
    const HybridEntry entry = {step->solution->impulses, fit.near, fit.weights, fit.metric,
                               memory->tolerance * memory->tolerance};
    return hybrid_memory_add(memory, &step->query, &entry, error);
}

static float error_of(const HybridMemory *memory, int entry, const SolvedStep *step, ContactSolution *answer) {
    hybrid_answer(memory, entry, step->query.key, step->problem, answer);
    return velocity_error(step->problem, answer->velocities, step->solution->velocities);
}

static bool is_near(const HybridMemory *memory, int entry, const float *key) {
    const float *centre = memory->keys + (size_t)entry * (size_t)memory->key_size;
    float sum = 0;
    for (int i = 0; i < memory->key_size; i++) sum += (key[i] - centre[i]) * (key[i] - centre[i]);
    return sum <= step_max * step_max;
}

bool entry_learn(HybridMemory *memory, const SolvedStep *step, size_t limit, ContactSolution *answer, Lesson *lesson,
                 Error *error) {
    const int entry = hybrid_memory_nearest(memory, &step->query, step_max);
    *lesson = LESSON_KNOWN;
    if (entry >= 0 && hybrid_memory_distance(memory, entry, step->query.key) <= 1) return true;
    if (entry >= 0 && is_near(memory, entry, step->query.key) &&
        error_of(memory, entry, step, answer) <= memory->tolerance) {
        hybrid_memory_stretch(memory, entry, step->query.key);
        *lesson = LESSON_GROWN;
        return true;
    }
    *lesson = LESSON_FULL;
    if (memory->entry_count == HYBRID_ENTRIES_MAX || step->query.contacts > HYBRID_CONTACTS_MAX ||
        hybrid_memory_bytes(memory) + hybrid_memory_entry_bytes(memory, step->query.contacts) > limit)
        return true;
    *lesson = LESSON_ADDED;
    return hybrid_entries_add(memory, step, error);
}

float entry_check(HybridMemory *memory, int entry, const SolvedStep *step, ContactSolution *answer) {
    const float wrong = error_of(memory, entry, step, answer);
    if (!(wrong <= memory->tolerance)) hybrid_memory_stretch(memory, entry, step->query.key);
    return wrong;
}

/* principal_fit() gives each component the variance 1; in a key all have the same unit, m/s. */
static void take_directions(HybridMemory *memory, const Projection *projection) {
    for (int c = 0; c < memory->components; c++) {
        double squares = 0;
        for (int i = 0; i < memory->numbers; i++) {
            const double row = (double)projection->rows[i * projection->to + c];
            squares += row * row;
        }
        const double factor = squares > 0 ? 1 / sqrt(squares) : 0;
        for (int i = 0; i < memory->numbers; i++)
            memory->rows[i * memory->components + c] =
                (float)(factor * (double)projection->rows[i * projection->to + c]);
    }
}

static void take_mean(HybridMemory *memory, const float *others, int count) {
    for (int i = 0; i < memory->numbers; i++) {
        double sum = 0;
        for (int s = 0; s < count; s++) sum += (double)others[(size_t)s * (size_t)memory->numbers + (size_t)i];
        memory->centre[i] = (float)(sum / count);
    }
}

bool key_fit(HybridMemory *memory, const float *others, int count, uint64_t seed, Error *error) {
    const size_t width = (size_t)memory->numbers, numbers = (size_t)count * width;
    const int to = (memory->components + ROW_LANES - 1) / ROW_LANES * ROW_LANES;
    Projection projection = {.from = memory->numbers,
                             .to = to,
                             .rows = calloc(width * (size_t)to, sizeof(float)),
                             .centre = calloc((size_t)to, sizeof(float))};
    int64_t *begin = malloc(((size_t)count + 1) * sizeof *begin);
    int32_t *column = malloc(numbers * sizeof *column);
    bool ok = (projection.rows != NULL && projection.centre != NULL && begin != NULL && column != NULL) ||
              error_memory(error, "hybrid");
    for (int s = 0; ok && s <= count; s++) begin[s] = (int64_t)s * memory->numbers;
    for (size_t i = 0; ok && i < numbers; i++) column[i] = (int32_t)(i % width);
    const SparseRows rows = {count, memory->numbers, begin, column, others};
    ok = ok && principal_fit(&rows, seed, &projection, error);
    if (ok) {
        take_mean(memory, others, count);
        take_directions(memory, &projection);
    }
    free(begin);
    free(column);
    free(projection.rows);
    free(projection.centre);
    return ok;
}

void asked_steps_clear(AskedSteps *steps) {
    for (int i = 0; i < steps->count; i++) free(steps->items[i].block);
    steps->count = 0;
    steps->steps = 0;
    steps->seconds = 0;
}

void asked_steps_free(AskedSteps *steps) {
    asked_steps_clear(steps);
    free(steps->items);
    *steps = (AskedSteps){0};
}

/* A copy in the block; *at moves on. */
static void *hybrid_entries_keep(char **at, const void *data, size_t size) {
    void *to = *at;
    if (size > 0) memcpy(to, data, size);
    *at += size;
    return to;
}

static bool see(void *context, const HybridStep *step, Error *error) {
    AskedSteps *steps = context;
    const double begin = clock_thread_seconds();
    const size_t bodies = (size_t)step->problem->body_count, contacts = (size_t)step->problem->contact_count;
    const size_t numbers = HYBRID_NUMBERS * (bodies - 1);
    if (!array_reserve((void **)&steps->items, &steps->capacity, (size_t)steps->count + 1, sizeof *steps->items))
        return error_memory(error, "hybrid");
    AskedStep *copy = &steps->items[steps->count];
    *copy = (AskedStep){.problem = *step->problem, .hash = step->query.hash, .entry = step->entry};
    /* All parts consist of four-byte numbers. */
    char *at = copy->block =
        malloc(bodies * (sizeof(ProblemBody) + sizeof(BodyVelocity)) +
               contacts * (sizeof(ContactPoint) + sizeof(ContactImpulse)) + numbers * sizeof(float));
    if (at == NULL) return error_memory(error, "hybrid");
    steps->count++;
    copy->problem.bodies = hybrid_entries_keep(&at, step->problem->bodies, bodies * sizeof(ProblemBody));
    copy->problem.contacts = hybrid_entries_keep(&at, step->problem->contacts, contacts * sizeof(ContactPoint));
    copy->solution.velocities = hybrid_entries_keep(&at, step->solution->velocities, bodies * sizeof(BodyVelocity));
    copy->solution.impulses = hybrid_entries_keep(&at, step->solution->impulses, contacts * sizeof(ContactImpulse));
    copy->others = hybrid_entries_keep(&at, step->others, numbers * sizeof(float));
    memcpy(copy->bomb, step->bomb, sizeof copy->bomb);
    steps->seconds += clock_thread_seconds() - begin;
    return true;
}

World *hybrid_prefix(const Scene *scene, Error *error) {
    ContactSolver solver = {0};
    World *prefix = hybrid_make(&solver, NULL, NULL, error) ? launch_prefix(scene, &solver, error) : NULL;
    solver_destroy(&solver);
    return prefix;
}

static bool count_step(void *context, const ContactProblem *problem, Phase phase, int since, Error *error) {
    (void)problem, (void)phase, (void)since, (void)error;
    ((AskedSteps *)context)->steps++;
    return true;
}

bool launch_steps_run(const Scene *scene, const World *prefix, const Launch *launch, const HybridMemory *memory,
                      int steps, AskedSteps *asked, Error *error) {
    ContactSolver solver = {0};
    const bool ok = hybrid_make(&solver, memory, &(HybridWatch){see, asked}, error) &&
                    launch_run(scene, launch, prefix, &solver, steps, count_step, asked, error);
    solver_destroy(&solver);
    return ok;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A memory answers familiar impacts; others are solved to convergence. A step whose warm start has a residual of the
   gate or more is looked up in the memory (methods/hybrid_memory.h): an entry with the same contacts whose ellipsoid of
   accuracy contains the state answers with its impulses and a linear map,

       P = P0 + A (x - x0)     if (x - x0)^T M (x - x0) <= 1,

   clamped to the friction cones. Impulses act on both bodies alike, so momentum is conserved whatever is stored. All
   other steps are solved by `interior:near=0.001` (interior.c). The memory does not change while it answers: the same
   file gives the same run. It grows between launches (learning/hybrid_training.c).

   Sources: Pope, "Computationally efficient implementation of combustion chemistry using in situ adaptive tabulation"
   (1997); Lu, Pope, "An improved algorithm for in situ adaptive tabulation" (2009). The combination of engine and
   memory is the paper's description of Ajay et al. (2019). Fails where impacts do not come back: in a pile each impact
   has contacts of its own, and a new family of launches starts from nothing. Where an ellipsoid grew over a place it
   was never checked at, an answer can be wrong by more than the tolerance, and nothing tells at run time. */
#include "base/base.h"
#include "base/hash.h"
#include "engine/engine.h"
#include "methods/hybrid_memory.h"
#include "methods/methods.h"
#include "methods/residual.h"
#include "methods/scene_net.h"
#include "methods/sweeps.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define CONVERGED "near=0.001" /* settings of interior */

const float hybrid_gate = 0.3f;

/* m/s and rad/s: no answer is trusted beyond it. */
static const float speed_max = 1e4f;

/* What decides whether two steps have the same contacts, for the hash: no padding. */
typedef struct ContactWords {
    int32_t a, b;
    uint32_t feature;
    float friction;
} ContactWords;

typedef struct BodyWords {
    float width, height, inv_mass, inv_inertia;
} BodyWords;

typedef struct Hybrid {
    HybridMemory *own;          /* or NULL */
    char *path;                 /* of its file, or NULL */
    const HybridMemory *memory; /* the same, or the caller's; NULL: empty */
    bool retrieves;
    HybridWatch watch; /* see NULL: none */
    void *interior;    /* state of solver_interior */
    float *others;     /* [6 (body_count - 1)] */
    char *words;       /* BodyWords[body_count], dt, ContactWords[contact_count] */
    ArrayBlock arrays; /* others and words */
    float bomb[HYBRID_NUMBERS], key[HYBRID_KEY_MAX];
} Hybrid;

static const SettingSpec settings[] = {
    {"network", "file of the memory (default: the scene's; without one nothing is answered)", SETTING_OWN},
    {"net", "on|off: off solves every step to convergence, as interior:near=0.001 (default: on)",
     SETTING_BOOL(Hybrid, retrieves)},
    {0}};

static void destroy(void *state) {
    Hybrid *hybrid = state;
    if (hybrid == NULL) return;
    hybrid_memory_destroy(hybrid->own);
    free(hybrid->path);
    if (hybrid->interior != NULL) solver_interior.destroy(hybrid->interior);
    free(hybrid->arrays.memory);
    free(hybrid);
}

static Hybrid *make_hybrid(Error *error) {
    Settings converged;
    const MethodDescription *interior = &solver_interior.description;
    if (!settings_parse(&converged, CONVERGED, interior->settings, interior->name, error)) return NULL;
    Hybrid *hybrid = calloc(1, sizeof *hybrid);
    if (hybrid == NULL) {
        error_memory(error, "hybrid");
        return NULL;
    }
    hybrid->retrieves = true;
    hybrid->interior = solver_interior.create(&converged, error);
    if (hybrid->interior != NULL) return hybrid;
    destroy(hybrid);
    return NULL;
}

static void *create(const Settings *chosen, Error *error) {
    Hybrid *hybrid = make_hybrid(error);
    const char *path = settings_get(chosen, "network");
    if (hybrid == NULL) return NULL;
    bool ok = settings_read(chosen, settings, hybrid, error);
    if (ok && path != NULL)
        ok = ((hybrid->path = strdup(path)) != NULL || error_memory(error, "hybrid")) &&
             (hybrid->memory = hybrid->own = hybrid_memory_read(path, error)) != NULL;
    if (ok) return hybrid;
    destroy(hybrid);
    return NULL;
}

bool hybrid_make(ContactSolver *solver, const HybridMemory *memory, const HybridWatch *watch, Error *error) {
    Hybrid *hybrid = make_hybrid(error);
    *solver = (ContactSolver){&solver_hybrid, hybrid};
    if (hybrid == NULL) return false;
    hybrid->memory = memory;
    if (watch != NULL) hybrid->watch = *watch;
    return true;
}

/* Before the bomb appears there is one body less. */
static bool fits(const Hybrid *hybrid, const ContactProblem *problem, Error *error) {
    const HybridMemory *memory = hybrid->memory;
    const char *where = hybrid->path != NULL ? hybrid->path : "hybrid";
    const int bodies = problem->bomb < 0 ? memory->body_count - 1 : memory->body_count;
    if (problem->body_count != bodies)
        return error_input(error, where, "the memory is of the scene %s of %d bodies; this one has %d", memory->scene,
                           bodies, problem->body_count);
    if (problem->bomb < 0 || problem->bomb == memory->bomb) return true;
    return error_input(error, where, "the memory is of the scene %s, with the bomb as body %d; here it is body %d",
                       memory->scene, memory->bomb, problem->bomb);
}

/* Fills `others`, and the key if there is a memory. False when memory is short. */
static bool make_query(Hybrid *hybrid, const ContactProblem *problem, HybridQuery *query) {
    const size_t bodies = (size_t)problem->body_count, contacts = (size_t)problem->contact_count;
    const size_t words = bodies * sizeof(BodyWords) + sizeof problem->dt + contacts * sizeof(ContactWords);
    if (!ARRAY_BLOCK_RESERVE(&hybrid->arrays, ARRAY_PART(hybrid->others, bodies * HYBRID_NUMBERS),
                             ARRAY_PART(hybrid->words, words)))
        return false;
    float *others = hybrid->others;
    char *at = hybrid->words;
    for (int i = 0; i < problem->body_count; i++, at += sizeof(BodyWords)) {
        const ProblemBody *body = &problem->bodies[i];
        memcpy(at, &(BodyWords){body->size.x, body->size.y, body->inv_mass, body->inv_inertia}, sizeof(BodyWords));
        if (i == problem->bomb) continue;
        hybrid_memory_numbers(body, body->angle, problem->dt, others);
        others += HYBRID_NUMBERS;
    }
    memcpy(at, &problem->dt, sizeof problem->dt);
    at += sizeof problem->dt;
    for (int i = 0; i < problem->contact_count; i++, at += sizeof(ContactWords)) {
        const ContactPoint *contact = &problem->contacts[i];
        const bool of_bomb = contact->a == problem->bomb || contact->b == problem->bomb;
        const uint32_t feature = of_bomb ? scene_view_feature(problem, contact) : contact->feature;
        memcpy(at, &(ContactWords){contact->a, contact->b, feature, contact->friction}, sizeof(ContactWords));
    }
    const ProblemBody *bomb = &problem->bodies[problem->bomb];
    hybrid_memory_numbers(bomb, scene_view_angle(bomb), problem->dt, hybrid->bomb);
    *query = (HybridQuery){hash_xxh3(hybrid->words, words), problem->contact_count, NULL};
    if (hybrid->memory == NULL) return true;
    hybrid_memory_key(hybrid->memory, hybrid->bomb, hybrid->others, hybrid->key);
    query->key = hybrid->key;
    return true;
}

void hybrid_answer(const HybridMemory *memory, int entry, const float *key, const ContactProblem *problem,
                   ContactSolution *solution) {
    contact_solution_begin(problem, solution);
    hybrid_memory_answer(memory, entry, key, solution->impulses);
    for (int i = 0; i < problem->contact_count; i++) {
        ContactImpulse *impulse = &solution->impulses[i], given = *impulse;
        impulse->normal = given.normal > 0 ? given.normal : 0;
        const float most = problem->contacts[i].friction * impulse->normal;
        impulse->tangent = contact_clamp(given.tangent, -most, most);
        solution->fallbacks.outside_cone += given.normal != impulse->normal || given.tangent != impulse->tangent;
        contact_push(solution->velocities, &problem->contacts[i], problem->bodies, *impulse);
    }
}

/* The fallbacks so far are added to those of interior. */
static bool converge(Hybrid *hybrid, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    const Fallbacks before = solution->fallbacks;
    solution->fallbacks = (Fallbacks){0};
    if (!solver_interior.solve(hybrid->interior, problem, solution, error)) return false;
    fallbacks_add(&solution->fallbacks, &before);
    return true;
}

static bool solve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    Hybrid *hybrid = state;
    if (hybrid->memory != NULL && !fits(hybrid, problem, error)) return false;
    solution->fallbacks = (Fallbacks){0};
    const bool asks = hybrid->retrieves && (hybrid->memory != NULL || hybrid->watch.see != NULL);
    if (!asks || problem->bomb < 0) return converge(hybrid, problem, solution, error);
    sequential_impulses_begin(problem, &(SequentialOptions){.accumulate = true, .warm = true}, solution);
    if (!residual_reaches_scalar(problem, solution, hybrid->memory != NULL ? hybrid->memory->gate : hybrid_gate))
        return converge(hybrid, problem, solution, error);
    HybridQuery query;
    if (!make_query(hybrid, problem, &query)) return error_memory(error, "hybrid");
    HybridStep step = {problem, solution, query, hybrid->bomb, hybrid->others, -1};
    if (hybrid->memory != NULL) step.entry = hybrid_memory_find(hybrid->memory, &step.query);
    if (step.entry >= 0) {
        hybrid_answer(hybrid->memory, step.entry, step.query.key, problem, solution);
        bool bounded = true; /* which a NaN is not */
        for (int i = 0; i < problem->body_count; i++) {
            const BodyVelocity *v = &solution->velocities[i];
            bounded = bounded && fabsf(v->linear.x) <= speed_max && fabsf(v->linear.y) <= speed_max &&
                      fabsf(v->angular) <= speed_max;
        }
        if (!bounded) {
            solution->fallbacks = (Fallbacks){.not_finite = 1};
            step.entry = -1;
        }
    } else {
        solution->fallbacks.beyond_training = 1;
    }
    if (step.entry < 0 && !converge(hybrid, problem, solution, error)) return false;
    return hybrid->watch.see == NULL || hybrid->watch.see(hybrid->watch.context, &step, error);
}

const ContactSolverKind solver_hybrid = {
    .description = {.name = "hybrid",
                    .summary = "a memory answers familiar impacts; others are solved to convergence",
                    .caption = "memory of solved impacts",
                    .settings = settings,
                    .falls_back = true,
                    .needs_network = true,
                    .twin = "hybrid:net=off",
                    .chart = METHOD_RUNS("", "net=off"),
                    .chart_quick = METHOD_NO_RUNS,
                    .stability = METHOD_NO_RUNS},
    .create = create,
    .solve = solve,
    .destroy = destroy};

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A memory of solved impacts of one scene, in the manner of in-situ adaptive tabulation. An entry holds a key x0 (the
   state before the step), the converged impulses P0, a linear map A, and an ellipsoid of accuracy
   { x : (x - x0)^T M (x - x0) <= 1 }. Inside it the answer is

       P = P0 + A (x - x0),   A (x - x0) = sum over up to HYBRID_NEAR entries j of (w_j . (x - x0)) (P_j - P0)

   The rows w_j are a least-squares fit over the neighbours when the entry is added: a map of that rank needs no more
   memory than the rows, and an answer is an affine combination of solutions. An ellipsoid grows to the smallest one of
   the same centre that holds a new point, too, and shrinks to the largest one that it contains with the point on its
   border.

   The key: the bomb's state, the components of the other bodies' states along principal directions, and their distance
   from the space of these directions. All in m/s (hybrid_memory_numbers). Which contacts exist, with the bodies' sizes
   and masses, is a 64-bit hash: entries with another one never answer; their number of contacts is compared, too.

   Sources: Pope, "Computationally efficient implementation of combustion chemistry using in situ adaptive tabulation"
   (1997), 3 (entries, ellipsoids, growth). Lu, Pope, "An improved algorithm for in situ adaptive tabulation" (2009)
   (checks of retrieved answers). Other than there, entries are found by hash and by the first
   number of their keys instead of in a tree: few share their contacts. */
#pragma once
#include "base/base.h"
#include "engine/engine.h"
#include "methods/methods.h"

#include <stddef.h>

enum {
    HYBRID_VERSION = 1,
    HYBRID_BODIES_MAX = 256,
    HYBRID_NUMBERS = 6, /* of a body: x, y, angle, velocity x, y, spin */
    HYBRID_COMPONENTS_MAX = 32,
    HYBRID_KEY_MAX = HYBRID_NUMBERS + HYBRID_COMPONENTS_MAX + 1,
    HYBRID_NEAR = 3,
    HYBRID_ENTRIES_MAX = 1000000,
    HYBRID_CONTACTS_MAX = 20000,
    HYBRID_TEXT_SIZE = 512
};

/* The entries of a set, by rising first number of their keys: a launch family moves the bomb's x most. */
typedef struct HybridList {
    int32_t *entries; /* [count] */
    int count;
    size_t capacity;
    float reach; /* (m/s)^2: the largest of its entries */
} HybridList;

typedef struct HybridMemory {
    int body_count, bomb, components;
    int numbers, key_size, metric_size; /* of the other bodies; of a key; of the lower triangle of M, row after row */
    float gate;                         /* m/s: RMS residual of the warm start from which on a step asks the memory */
    float tolerance;                    /* m/s: RMS error of the bodies' velocities that the ellipsoids keep */
    int launches;                       /* learned so far */
    char scene[HYBRID_TEXT_SIZE], command[HYBRID_TEXT_SIZE];
    float *centre, *rows; /* [numbers], [numbers, components] principal directions: orthonormal columns, or 0 */

    int set_count;         /* sets of contacts */
    uint64_t *set_hash;    /* [set_count] */
    int32_t *set_contacts; /* [set_count] number of contacts */
    HybridList *set_lists; /* [set_count] */

    int entry_count;
    int32_t *entry_set;       /* [entry_count] its set */
    size_t *entry_begin;      /* [entry_count] of its impulses */
    float *keys;              /* [entry_count, key_size] x0 */
    float *metrics;           /* [entry_count, metric_size] M */
    float *reach;             /* [entry_count] (m/s)^2: no point of the ellipsoid is farther from x0 */
    int32_t *near;            /* [entry_count, HYBRID_NEAR] entries j of the same set, or -1 */
    float *weights;           /* [entry_count, HYBRID_NEAR, key_size] w_j */
    ContactImpulse *impulses; /* [impulse_count] P0 of all entries */
    size_t impulse_count, set_capacity, entry_capacity, impulse_capacity;

    int32_t *table; /* [table_size] open addressing by hash: a set, or -1; table_size is a power of two */
    size_t table_size;
} HybridMemory;

/* An empty memory with directions of 0. ERROR_INPUT if a number is out of bounds. */
HybridMemory *hybrid_memory_create(int body_count, int bomb, int components, Error *error);
void hybrid_memory_destroy(HybridMemory *memory);

/* The memory's size, and what an entry of so many contacts would add, bytes. */
size_t hybrid_memory_bytes(const HybridMemory *memory);
size_t hybrid_memory_entry_bytes(const HybridMemory *memory, int contacts);

/* The state of a body in m/s: metres times the rate at which position correction pushes overlaps apart, angles and
   spins times half the size. `angle` replaces the body's. */
void hybrid_memory_numbers(const ProblemBody *body, float angle, float dt, float numbers[HYBRID_NUMBERS]);

/* key[key_size] from the numbers of the bomb and of the other bodies in order [numbers]. */
void hybrid_memory_key(const HybridMemory *memory, const float *bomb, const float *others, float *key);

typedef struct HybridQuery {
    uint64_t hash; /* of the contacts and what is constant */
    int contacts;
    const float *key; /* [key_size] finite */
} HybridQuery;

/* The entry whose ellipsoid contains the query, the most central one if there are several; or -1. */
int hybrid_memory_find(const HybridMemory *memory, const HybridQuery *query);

/* The entries with these contacts whose first number is within `radius` (m/s) of the query's: [*count], or NULL. */
const int32_t *hybrid_memory_about(const HybridMemory *memory, const HybridQuery *query, float radius, int *count);

/* The most central of them, inside its ellipsoid or not, or -1. */
int hybrid_memory_nearest(const HybridMemory *memory, const HybridQuery *query, float radius);

/* (x - x0)^T M (x - x0) of an entry */
float hybrid_memory_distance(const HybridMemory *memory, int entry, const float *key);

/* impulses[contacts of the entry]; they may leave their friction cones. */
void hybrid_memory_answer(const HybridMemory *memory, int entry, const float *key, ContactImpulse *impulses);

/* What an entry has besides the query. */
typedef struct HybridEntry {
    const ContactImpulse *impulses; /* [contacts] */
    const int32_t *near;            /* [HYBRID_NEAR] */
    const float *weights;           /* [HYBRID_NEAR, key_size] */
    const float *metric;            /* [metric_size] */
    float reach;                    /* (m/s)^2 */
} HybridEntry;

/* False with error set when memory is short. */
bool hybrid_memory_add(HybridMemory *memory, const HybridQuery *query, const HybridEntry *entry, Error *error);

/* Puts the key on the border of the entry's ellipsoid: the smallest growth, or the smallest cut that does so. Nothing
   happens if the key is the entry's own. */
void hybrid_memory_stretch(HybridMemory *memory, int entry, const float *key);

bool hybrid_memory_write(const HybridMemory *memory, const char *path, Error *error);

/* ERROR_INPUT, naming the file, if it is damaged, of another version or kind, has inconsistent shapes, a NaN or
   infinite number, a set that is there twice or an entry of an unknown set. */
HybridMemory *hybrid_memory_read(const char *path, Error *error);

/* The method hybrid with a memory that its caller fills, for learning. */

/* A step that asked the memory. */
typedef struct HybridStep {
    const ContactProblem *problem;
    const ContactSolution *solution;
    HybridQuery query;   /* key NULL if there is no memory */
    const float *bomb;   /* [6] its numbers */
    const float *others; /* [6 (body_count - 1)] the numbers of the bodies but the bomb */
    int entry;           /* that answered, or -1: solved to convergence */
} HybridStep;

/* Called after each such step; false with error set stops the step. */
typedef struct HybridWatch {
    bool (*see)(void *context, const HybridStep *step, Error *error);
    void *context;
} HybridWatch;

/* m/s: the gate, RMS residual of the warm start, where no memory sets it. As in scene-net: below it at rest, above
   during a shock. */
extern const float hybrid_gate;

/* memory: the caller's, or NULL: no step is answered. It must outlive the solver, and may grow between launches. watch:
   or NULL. */
bool hybrid_make(ContactSolver *solver, const HybridMemory *memory, const HybridWatch *watch, Error *error);

/* The answer of an entry: impulses clamped to their friction cones, and the velocities that follow; adds to
   fallbacks.outside_cone. The problem has the entry's contacts. */
void hybrid_answer(const HybridMemory *memory, int entry, const float *key, const ContactProblem *problem,
                   ContactSolution *solution);

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Training of hybrid: what its memory learns from a step, and launch after launch.

   A solved impact that the memory does not answer teaches it a larger ellipsoid, or a new entry. Source: Pope (1997),
   3, and Lu, Pope (2009) for the checks of answers; the linear map is a fit over neighbours instead of a derivative
   (hybrid_memory.h). A derivative by finite differences would take a converged solve for each direction of the key,
   most of which no launch takes, and the contacts change their features under small turns. The fit takes none, and is
   exact along the launches. */
#include "learning/hybrid_training.h"

#include "base/base.h"
#include "base/machine.h"
#include "base/random.h"
#include "engine/engine.h"
#include "learning/launches.h"
#include "learning/principal.h"
#include "methods/hybrid_memory.h"
#include "methods/pair.h"
#include "methods/sweeps.h"
#include "runs/launch_check.h"
#include "scenes/scenes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    KEY_LAUNCHES = 40, /* the first, whose keys find the directions */
    CHECK_EVERY = 10
};

/* An ellipsoid grows by steps of at most this: farther points are accurate by chance. m/s; 2 are 17 cm of the bomb's
   place. */
static const float step_max = 2;
/* Share of the neighbours' mean squared distance that is added to the normal equations: neighbours in one direction
   leave them singular. */
static const double ridge = 1e-4;
/* Relative to the largest: smaller variances of keys are rounding. */
static const double least_variance = 1e-10;

/* A step that asked the memory, with copies of all. */
typedef struct AskedStep {
    ContactProblem problem;
    ContactSolution solution; /* its arrays are in `block`, as `others` */
    HybridQuery query;        /* its key: once there is a memory */
    float bomb[HYBRID_NUMBERS];
    float *others; /* [6 (body_count - 1)] */
    int entry;     /* that answered, or -1: the solution is converged */
    char *block;
} AskedStep;

typedef struct Trainer {
    const Scene *scene;
    const HybridTraining *training;
    World *past;
    AskedStep *asked; /* [asked_count] of the launch; at first of all launches so far */
    int asked_count;
    size_t asked_capacity;
    ContactSolver interior;
    PairMoment answer, converged; /* work space */
    HybridMemory *memory;         /* NULL until the directions are fitted */
} Trainer;

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

/* The nearest entries within 2 step_max: between them both ellipsoids can reach. */
static void find_neighbours(NewEntry *fit, const HybridMemory *memory, const HybridQuery *query) {
    const size_t size = (size_t)memory->key_size;
    int count;
    const int32_t *entries = hybrid_memory_about(memory, query, 2 * step_max, &count);
    fit->count = 0;
    for (int e = 0; e < count; e++) {
        const float *other = memory->keys + (size_t)entries[e] * size;
        float from[HYBRID_KEY_MAX], distance = 0;
        for (size_t i = 0; i < size; i++) {
            from[i] = other[i] - query->key[i];
            distance += from[i] * from[i];
        }
        int at = fit->count < HYBRID_NEAR ? fit->count++ : HYBRID_NEAR;
        if (at == HYBRID_NEAR && !(distance < fit->distance[--at])) continue;
        for (; at > 0 && distance < fit->distance[at - 1]; at--) {
            fit->near[at] = fit->near[at - 1];
            fit->distance[at] = fit->distance[at - 1];
            memcpy(fit->from[at], fit->from[at - 1], size * sizeof *from);
        }
        fit->near[at] = entries[e];
        fit->distance[at] = distance;
        memcpy(fit->from[at], from, size * sizeof *from);
    }
    while (fit->count > 0 && fit->distance[fit->count - 1] > 4 * step_max * step_max) fit->count--;
    for (int n = fit->count; n < HYBRID_NEAR; n++) fit->near[n] = -1;
}

/* Rows of (D^T D + ridge)^-1 D^T, with the neighbours' x_j - x0 as columns of D; the inverse by Gauss and Jordan. */
static void fit_weights(NewEntry *fit, int key_size) {
    double normal[HYBRID_NEAR][HYBRID_NEAR], trace = 0;
    const int count = fit->count;
    for (int n = 0; n < count; n++)
        for (int m = 0; m < count; m++) {
            normal[n][m] = 0;
            for (int i = 0; i < key_size; i++) normal[n][m] += (double)fit->from[n][i] * (double)fit->from[m][i];
            trace += n == m ? normal[n][n] : 0;
        }
    for (int n = 0; n < count; n++) normal[n][n] += ridge * trace / count + 1e-12;
    for (int p = 0; p < count; p++) {
        const double pivot = 1 / normal[p][p];
        normal[p][p] = 1;
        for (int j = 0; j < count; j++) normal[p][j] *= pivot;
        for (int i = 0; i < count; i++) {
            if (i == p) continue;
            const double factor = normal[i][p];
            normal[i][p] = 0;
            for (int j = 0; j < count; j++) normal[i][j] -= factor * normal[p][j];
        }
    }
    for (int n = 0; n < HYBRID_NEAR; n++)
        for (int i = 0; i < key_size; i++) {
            double sum = 0;
            for (int m = 0; n < count && m < count; m++) sum += normal[n][m] * (double)fit->from[m][i];
            fit->weights[n * key_size + i] = (float)sum;
        }
}

/* Products of the velocity changes that P_j - P0 make, means over the bodies that move. */
static bool find_images(NewEntry *fit, const HybridMemory *memory, const AskedStep *step) {
    const ContactProblem *problem = &step->problem;
    const size_t bodies = (size_t)problem->body_count;
    BodyVelocity *changes = calloc(HYBRID_NEAR * bodies, sizeof *changes);
    if (changes == NULL) return false;
    int moving = 0;
    for (size_t i = 0; i < bodies; i++) moving += problem->bodies[i].inv_mass > 0;
    for (int n = 0; n < fit->count; n++) {
        const ContactImpulse *other = memory->impulses + memory->entry_begin[fit->near[n]];
        for (int i = 0; i < problem->contact_count; i++) {
            const ContactImpulse own = step->solution.impulses[i];
            contact_push(changes + (size_t)n * bodies, &problem->contacts[i], problem->bodies,
                         (ContactImpulse){other[i].normal - own.normal, other[i].tangent - own.tangent});
        }
    }
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

/* Of a step, solved to convergence. */
static bool add_entry(HybridMemory *memory, const AskedStep *step, Error *error) {
    NewEntry fit;
    find_neighbours(&fit, memory, &step->query);
    fit_weights(&fit, memory->key_size);
    if (!find_images(&fit, memory, step)) return error_memory(error, "hybrid");
    /* M = A^T A / tolerance^2 + 1 / tolerance^2, A here of velocities: inside the ellipsoid the linear term is at most
       the tolerance, as in Pope (1997), and in directions that A does not know bodies are taken to follow the state one
       to one. */
    const int size = memory->key_size;
    const double unit = 1 / ((double)memory->tolerance * (double)memory->tolerance);
    float *metric = fit.metric;
    for (int i = 0; i < size; i++)
        for (int j = 0; j <= i; j++) {
            double sum = i == j ? 1 : 0;
            for (int n = 0; n < fit.count; n++)
                for (int m = 0; m < fit.count; m++)
                    sum += (double)fit.weights[n * size + i] * fit.images[n][m] * (double)fit.weights[m * size + j];
            *metric++ = (float)(unit * sum);
        }
    const HybridEntry entry = {step->solution.impulses, fit.near, fit.weights, fit.metric,
                               memory->tolerance * memory->tolerance};
    return hybrid_memory_add(memory, &step->query, &entry, error);
}

/* Of an entry's answer, RMS over the dynamic bodies of |dv|^2 + dspin^2 / 6, as in methods/reference.h, m/s. */
static float error_of(const HybridMemory *memory, int entry, const AskedStep *step, ContactSolution *answer) {
    const ContactProblem *problem = &step->problem;
    const BodyVelocity *a = answer->velocities, *b = step->solution.velocities;
    double sum = 0;
    int count = 0;
    hybrid_answer(memory, entry, step->query.key, problem, answer);
    for (int i = 0; i < problem->body_count; i++) {
        if (problem->bodies[i].inv_mass == 0) continue;
        const double x = (double)(a[i].linear.x - b[i].linear.x), y = (double)(a[i].linear.y - b[i].linear.y),
                     spin = (double)(a[i].angular - b[i].angular);
        sum += x * x + y * y + spin * spin / 6;
        count++;
    }
    return count > 0 ? (float)sqrt(sum / count) : 0;
}

static bool is_near(const HybridMemory *memory, int entry, const float *key) {
    const float *centre = memory->keys + (size_t)entry * (size_t)memory->key_size;
    float sum = 0;
    for (int i = 0; i < memory->key_size; i++) sum += (key[i] - centre[i]) * (key[i] - centre[i]);
    return sum <= step_max * step_max;
}

static bool learn_step(Trainer *trainer, AskedStep *step, bool checks, HybridLaunch *launch, Error *error) {
    HybridMemory *memory = trainer->memory;
    float key[HYBRID_KEY_MAX];
    hybrid_memory_key(memory, step->bomb, step->others, key);
    step->query.key = key;
    if (!pair_moment_reserve(&trainer->answer, &step->problem) ||
        !pair_moment_reserve(&trainer->converged, &step->problem))
        return error_memory(error, "hybrid");
    ContactSolution answer = pair_moment_solution(&trainer->answer);

    /* An answer is checked, and its ellipsoid shrinks if it was wrong. */
    if (step->entry >= 0) {
        if (!checks) return true;
        step->solution = pair_moment_solution(&trainer->converged);
        if (!trainer->interior.kind->solve(trainer->interior.state, &step->problem, &step->solution, error))
            return false;
        const float wrong = error_of(memory, step->entry, step, &answer);
        if (!(wrong <= memory->tolerance)) hybrid_memory_stretch(memory, step->entry, key);
        launch->error += (double)wrong;
        launch->checked++;
        return true;
    }

    /* A step that was not answered may be known by now, from the steps before it. */
    const int entry = hybrid_memory_nearest(memory, &step->query, step_max);
    if (entry >= 0 && hybrid_memory_distance(memory, entry, key) <= 1) return true;
    const float wrong = entry >= 0 && is_near(memory, entry, key) ? error_of(memory, entry, step, &answer) : INFINITY;
    if (wrong <= memory->tolerance) {
        hybrid_memory_stretch(memory, entry, key);
        launch->grown++;
        launch->grown_error = fmaxf(launch->grown_error, wrong);
        return true;
    }
    if (memory->entry_count == HYBRID_ENTRIES_MAX || step->query.contacts > HYBRID_CONTACTS_MAX ||
        hybrid_memory_bytes(memory) + hybrid_memory_entry_bytes(memory, step->query.contacts) >
            trainer->training->limit) {
        launch->full++;
        return true;
    }
    launch->added++;
    return add_entry(memory, step, error);
}

/* Makes the memory: its centre is the mean of the bodies' numbers in the steps so far, its rows are their strongest
   directions. */
static bool fit_keys(Trainer *trainer, Error *error) {
    const HybridTraining *training = trainer->training;
    if (trainer->asked_count == 0)
        return error_input(error, trainer->scene->name, "no launch has an impact whose residual reaches the gate");
    const ContactProblem *first = &trainer->asked[0].problem;
    HybridMemory *memory = trainer->memory =
        hybrid_memory_create(first->body_count, first->bomb, training->components, error);
    if (memory == NULL) return false;
    memory->gate = hybrid_gate;
    memory->tolerance = training->tolerance;
    snprintf(memory->scene, sizeof memory->scene, "%s", trainer->scene->name);
    const size_t width = (size_t)memory->numbers, count = (size_t)trainer->asked_count;
    float *others = malloc(count * width * sizeof *others);
    double *mean = malloc((2 + width) * width * sizeof *mean), *values = mean + width, *vectors = values + width;
    bool ok = (others != NULL && mean != NULL) || error_memory(error, "hybrid");
    for (size_t i = 0; ok && i < count; i++)
        memcpy(others + i * width, trainer->asked[i].others, width * sizeof *others);
    const PrincipalRows rows = {others, count, memory->numbers, 1};
    if (ok) principal_mean(&rows, mean);
    ok = ok && principal_components(&rows, mean, values, vectors, error);
    for (size_t i = 0; ok && i < width; i++) {
        memory->centre[i] = (float)mean[i];
        for (size_t c = 0; c < (size_t)memory->components; c++)
            memory->rows[i * (size_t)memory->components + c] =
                c < width && values[c] > least_variance * values[0] ? (float)vectors[c * width + i] : 0;
    }
    free(others);
    free(mean);
    return ok;
}

static void forget_asked(Trainer *trainer) {
    for (int i = 0; i < trainer->asked_count; i++) {
        problem_copy_free(&trainer->asked[i].problem);
        free(trainer->asked[i].block);
    }
    trainer->asked_count = 0;
}

static bool keep_asked(void *context, const HybridStep *step, Error *error) {
    Trainer *trainer = context;
    const size_t bodies = (size_t)step->problem->body_count, contacts = (size_t)step->problem->contact_count;
    const size_t velocities = bodies * sizeof(BodyVelocity), impulses = contacts * sizeof(ContactImpulse),
                 numbers = HYBRID_NUMBERS * (bodies - 1) * sizeof(float);
    if (!array_reserve((void **)&trainer->asked, &trainer->asked_capacity, (size_t)trainer->asked_count + 1,
                       sizeof *trainer->asked))
        return error_memory(error, "hybrid");
    AskedStep *copy = &trainer->asked[trainer->asked_count++];
    *copy = (AskedStep){.query = step->query, .entry = step->entry};
    copy->block = malloc(velocities + impulses + numbers + 1); /* all of four-byte numbers */
    if (!problem_copy(&copy->problem, step->problem) || copy->block == NULL) return error_memory(error, "hybrid");
    copy->solution.velocities = (BodyVelocity *)copy->block;
    copy->solution.impulses = (ContactImpulse *)(copy->block + velocities);
    copy->others = (float *)(copy->block + velocities + impulses);
    memcpy(copy->solution.velocities, step->solution->velocities, velocities);
    if (impulses > 0) memcpy(copy->solution.impulses, step->solution->impulses, impulses);
    memcpy(copy->others, step->others, numbers);
    memcpy(copy->bomb, step->bomb, sizeof copy->bomb);
    return true;
}

static bool make_hybrid(void *context, int i, ContactSolver *solver, Error *error) {
    Trainer *trainer = context;
    (void)i;
    return hybrid_make(solver, trainer->memory, &(HybridWatch){keep_asked, trainer}, error);
}

/* Launch i depends on the seed and i only. */
static Launch draw_launch(const Trainer *trainer, int i) {
    const SceneBomb *bomb = &trainer->scene->bomb;
    uint64_t state = trainer->training->seed;
    state = split_mix(&state) + (uint64_t)i;
    Launch launch = launch_of(trainer->scene);
    launch.x = scene_span_at(&bomb->x, random_unit(&state));
    launch.rotation = scene_span_at(&bomb->rotation, random_unit(&state));
    launch.spin = scene_span_at(&bomb->spin, random_unit(&state));
    return launch;
}

/* Runs a launch and learns from it. The launches before the directions are fitted are learned together. */
static bool do_launch(Trainer *trainer, const Launch *drawn, int i, Error *error) {
    const HybridTraining *training = trainer->training;
    const LaunchWatch watch = {.scene = trainer->scene,
                               .launches = drawn,
                               .count = 1,
                               .impact_frames = training->steps,
                               .after_frames = 1,
                               .may_fail = true,
                               .make = make_hybrid,
                               .context = trainer,
                               .past = trainer->past};
    HybridLaunch launch = {.number = i + 1};
    const int before = trainer->asked_count;
    if (!launches_observe(&watch, NULL, NULL, error)) return false;
    launch.asked = trainer->asked_count - before;
    for (int k = before; k < trainer->asked_count; k++) launch.answered += trainer->asked[k].entry >= 0;
    if (trainer->memory == NULL && (i + 1 == KEY_LAUNCHES || i == training->launches - 1) && !fit_keys(trainer, error))
        return false;
    if (trainer->memory != NULL) {
        for (int k = 0; k < trainer->asked_count; k++)
            if (!learn_step(trainer, &trainer->asked[k], i % CHECK_EVERY == 0, &launch, error)) return false;
        forget_asked(trainer);
        trainer->memory->launches = i + 1;
    }
    launch.memory = trainer->memory;
    if (training->on_launch != NULL) training->on_launch(training->context, &launch);
    return true;
}

static bool train(Trainer *trainer, const Progress *progress, Error *error) {
    const int count = trainer->training->launches;
    Launch *launches = malloc((size_t)count * sizeof *launches);
    if (launches == NULL) return error_memory(error, "hybrid");
    for (int i = 0; i < count; i++) launches[i] = draw_launch(trainer, i);
    bool ok = launches_check(trainer->scene, launches, count, error) &&
              hybrid_make(&trainer->interior, NULL, NULL, error) &&
              (trainer->past = launches_past(trainer->scene, &trainer->interior, error)) != NULL;
    for (int i = 0; ok && i < count; i++) {
        ok = do_launch(trainer, &launches[i], i, error);
        if (ok && !progress_report(progress, i + 1, count)) break;
    }
    free(launches);
    return ok && (trainer->memory != NULL || error_interrupted(error, "hybrid", "stopped before anything was learned"));
}

HybridMemory *hybrid_training_run(const Scene *scene, const HybridTraining *training, const Progress *progress,
                                  Error *error) {
    if (!scene->bomb.present) return error_input(error, scene->name, "has no bomb to launch"), NULL;
    Trainer trainer = {.scene = scene, .training = training};
    const bool ok = train(&trainer, progress, error);
    forget_asked(&trainer);
    free(trainer.asked);
    world_destroy(trainer.past);
    solver_destroy(&trainer.interior);
    pair_moment_free(&trainer.answer);
    pair_moment_free(&trainer.converged);
    if (ok) return trainer.memory;
    hybrid_memory_destroy(trainer.memory);
    return NULL;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "impact_training/impact_problems.h"

#include "common/memory_stream.h"
#include "common/array.h"
#include "dynamics/problem_bytes.h"
#include "simulate/phases.h"
#include "simulate/simulate.h"

#include <stdlib.h>
#include <string.h>

#define CONVERGED 1e-3 /* m/s: far below the residuals after the numbers of sweeps that are fitted */

typedef struct Recording {
    ImpactProblems *problems;
    PhaseTracker tracker;
} Recording;

static void free_item(ImpactProblem *item) {
    free((void *)item->problem.bodies);
    free((void *)item->problem.contacts);
    free(item->reference);
}

void impact_problems_free(ImpactProblems *problems) {
    for (size_t i = 0; i < problems->count; i++) free_item(&problems->items[i]);
    free(problems->items);
    *problems = (ImpactProblems){0};
}

bool impact_problems_add(ImpactProblems *problems, const ContactProblem *problem, const ReferenceVelocity *reference,
                         bool impact) {
    if (!array_reserve((void **)&problems->items, &problems->capacity, problems->count + 1, sizeof *problems->items))
        return false;
    size_t bodies = (size_t)problem->body_count, contacts = (size_t)problem->contact_count;
    ProblemBody *body_copy = malloc((bodies + 1) * sizeof *body_copy);
    ContactPoint *contact_copy = malloc((contacts + 1) * sizeof *contact_copy);
    ImpactProblem item = {*problem, malloc((bodies + 1) * sizeof *item.reference), impact};
    item.problem.bodies = body_copy;
    item.problem.contacts = contact_copy;
    problems->items[problems->count++] = item;
    if (body_copy == NULL || contact_copy == NULL || item.reference == NULL) return false;
    memcpy(body_copy, problem->bodies, bodies * sizeof *body_copy);
    memcpy(contact_copy, problem->contacts, contacts * sizeof *contact_copy);
    if (reference != NULL) memcpy(item.reference, reference, bodies * sizeof *reference);
    return true;
}

bool impact_problems_move(ImpactProblems *problems, ImpactProblems *from) {
    const bool ok = array_reserve((void **)&problems->items, &problems->capacity, problems->count + from->count,
                                  sizeof *problems->items);
    if (ok && from->count > 0)
        memcpy(problems->items + problems->count, from->items, from->count * sizeof *from->items);
    if (ok) {
        problems->count += from->count;
        from->count = 0;
    }
    impact_problems_free(from);
    return ok;
}

static bool observe(void *context, int frame, const World *world, Error *error) {
    Recording *recording = context;
    const ContactProblem *problem = world_problem(world);
    PhaseTracker *tracker = &recording->tracker;
    Phase phase = phase_next(tracker, problem, frame);
    bool sampled = phase == PHASE_AFTER && (frame - tracker->touch - tracker->impact_frames) % AFTER_STEP == 0;
    if (phase != PHASE_IMPACT && !sampled) return true;
    return impact_problems_add(recording->problems, problem, NULL, phase == PHASE_IMPACT) ||
           error_memory(error, "recording");
}

static bool run_launches(ImpactProblems *problems, const Scene *scene, const FloatRange *bomb_x, Error *error) {
    Method engine;
    if (!method_parse(&engine, "engine", error)) return false;
    for (int i = 0; i < bomb_x->count; i++) {
        Scene launch = *scene;
        launch.bomb.body.position.x = range_value(bomb_x, i);
        Recording recording = {problems, {.impact_frames = scene->bomb.impact_frames}};
        if (!simulate_observed(&launch, &engine, &(StepObserver){observe, &recording}, error)) return false;
    }
    return problems->count > 0 || error_input(error, scene->name, "no launch touches a box");
}

/* Removes the problems that do not converge. */
static bool solve_references(ImpactProblems *problems, const Progress *progress, Error *error) {
    Reference reference = {0};
    size_t kept = 0, done = 0;
    bool ok = true;
    for (; ok && done < problems->count; done++) {
        ImpactProblem *item = &problems->items[done];
        ok = reference_solve(&reference, &item->problem, NULL, error);
        if (ok && !progress_report(progress, (double)done, (double)problems->count))
            ok = error_interrupted(error, "recording", "stopped");
        if (!ok) break;
        memcpy(item->reference, reference.velocities, (size_t)item->problem.body_count * sizeof *item->reference);
        ImpactProblem moved = *item;
        if (reference.residual <= CONVERGED)
            problems->items[kept++] = moved;
        else
            free_item(&moved);
    }
    if (ok) problems->count = kept;
    for (; !ok && done < problems->count; done++) problems->items[kept++] = problems->items[done];
    problems->count = kept;
    reference_free(&reference);
    return ok;
}

bool impact_problems_record(ImpactProblems *problems, const Scene *scene, const FloatRange *bomb_x,
                            const Progress *progress, Error *error) {
    *problems = (ImpactProblems){0};
    if (!scene->bomb.present) return error_input(error, scene->name, "has no bomb to launch");
    bool ok = run_launches(problems, scene, bomb_x, error) && solve_references(problems, progress, error);
    if (ok && problems->count == 0) ok = error_input(error, scene->name, "no reference converged");
    if (!ok) impact_problems_free(problems);
    return ok;
}

void impact_problems_write(const ImpactProblems *problems, FILE *out) {
    for (size_t i = 0; i < problems->count; i++) {
        const ImpactProblem *item = &problems->items[i];
        const int32_t impact = item->impact;
        fwrite(&impact, sizeof impact, 1, out);
        problem_bytes_write(&item->problem, out);
        stream_put(out, item->reference, sizeof *item->reference, (size_t)item->problem.body_count);
    }
}

static bool read_item(ImpactProblems *problems, ProblemBytes *bytes, Error *error) {
    int32_t impact = 0;
    ContactProblem problem = {0};
    bool ok = problem_bytes_take(bytes, &impact, 1, sizeof impact, error) && problem_bytes_read(&problem, bytes, error);
    if (ok && impact != 0 && impact != 1) ok = problem_bytes_refuse(bytes, error);
    ok = ok && (impact_problems_add(problems, &problem, NULL, impact == 1) || error_memory(error, bytes->path));
    ok = ok && problem_bytes_take(bytes, problems->items[problems->count - 1].reference, (size_t)problem.body_count,
                                  sizeof(ReferenceVelocity), error);
    problem_bytes_free(&problem);
    return ok;
}

bool impact_problems_read(ImpactProblems *problems, const char *data, size_t size, const char *path, Error *error) {
    ProblemBytes bytes = {data, size, path};
    bool ok = true;
    while (ok && bytes.left > 0) ok = read_item(problems, &bytes, error);
    return ok;
}

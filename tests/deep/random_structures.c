/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runs random structures by the reference and counts the steps that do not converge. Prints a line for each structure
   that has some, with the count of those that converge without position correction: with it, they may have no solution.
   Arguments: the first seed and how many (default: all). Exit status 1 if more than 0.1% of the steps are left. */
#include "random_structures.h"

#include "engine/engine.h"
#include "methods/reference.h"

typedef struct Tally {
    Reference reference;
    int steps, failed, first, unpushed; /* unpushed: of the failed, those that converge without position correction */
    long factorizations;
    double worst;
} Tally;

/* Whether the step converges without position correction. */
static bool converges_unpushed(const ContactProblem *problem) {
    Error error = {0};
    Reference reference = {0};
    ContactPoint *contacts = calloc((size_t)problem->contact_count, sizeof *contacts);
    if (contacts == NULL) abort();
    for (int i = 0; i < problem->contact_count; i++) {
        contacts[i] = problem->contacts[i];
        contacts[i].bias = fminf(contacts[i].bias, 0);
    }
    ContactProblem plain = *problem;
    plain.contacts = contacts;
    if (!reference_solve(&reference, &plain, NULL, &error)) abort();
    const bool converged = reference_converged(&reference);
    reference_free(&reference);
    free(contacts);
    return converged;
}

static bool solve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    Tally *tally = state;
    if (!reference_solve(&tally->reference, problem, NULL, error)) return false;
    tally->steps++;
    tally->factorizations += tally->reference.factorizations;
    if (!reference_converged(&tally->reference)) {
        tally->unpushed += converges_unpushed(problem);
        if (tally->failed++ == 0) tally->first = tally->steps;
        if (!(tally->reference.residual <= tally->worst)) tally->worst = tally->reference.residual;
    }
    reference_round(&tally->reference, problem, solution);
    return true;
}

int main(int argc, char **argv) {
    const int first = argc > 2 ? atoi(argv[1]) : 0, count = argc > 2 ? atoi(argv[2]) : STRUCTURES;
    long steps = 0, failed = 0, unpushed = 0, factorizations = 0;
    int bad = 0;
    for (int seed = first; seed < first + count; seed++) {
        Error error = {0};
        Tally tally = {0};
        Scene *scene = random_structure(seed);
        World *world = scene_world(scene, &error);
        bool ok = world != NULL;
        for (int i = 0; ok && i < scene->frames; i++) ok = world_step(world, solve, &tally, scene->dt, &error);
        if (!ok) printf("%s: %s\n", scene->name, error.message);
        if (!ok || tally.failed > 0) {
            printf("%-12s %2d bodies, friction %.2f: %d of %d steps, first %d, largest residual %.1e; %d "
                   "converge without position correction\n",
                   scene->name, scene->body_count, (double)scene->bodies[0].friction, tally.failed, tally.steps,
                   tally.first, tally.worst, tally.unpushed);
            bad++;
        }
        fflush(stdout);
        steps += tally.steps;
        failed += tally.failed;
        unpushed += tally.unpushed;
        factorizations += tally.factorizations;
        reference_free(&tally.reference);
        world_destroy(world);
        scene_destroy(scene);
    }
    printf("%d structures, %ld steps, %ld factorizations: %ld steps (%.3f%%) of %d structures did not converge; "
           "%ld of them do without position correction\n",
           count, steps, factorizations, failed, 100.0 * (double)failed / (double)steps, bad, unpushed);
    return 1000 * failed > steps;
}

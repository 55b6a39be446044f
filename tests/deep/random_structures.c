/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runs random structures by the reference and counts the steps that do not converge. Prints a line for each structure that
   has some. Arguments: the first seed and how many (default: all). Exit status 1 if more than 0.5% of the steps are left. */
#include "random_structures.h"

#include "engine/engine.h"
#include "methods/reference.h"

typedef struct Tally {
    Reference reference;
    int steps, failed, first;
    long factorizations;
    double worst;
} Tally;

static bool solve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    Tally *tally = state;
    if (!reference_solve(&tally->reference, problem, NULL, error)) return false;
    tally->steps++;
    tally->factorizations += tally->reference.factorizations;
    if (!(tally->reference.residual <= REFERENCE_TOLERANCE)) {
        if (tally->failed++ == 0) tally->first = tally->steps;
        if (!(tally->reference.residual <= tally->worst)) tally->worst = tally->reference.residual;
    }
    reference_round(&tally->reference, problem, solution);
    return true;
}

int main(int argc, char **argv) {
    const int first = argc > 2 ? atoi(argv[1]) : 0, count = argc > 2 ? atoi(argv[2]) : STRUCTURES;
    long steps = 0, failed = 0, factorizations = 0;
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
            printf("%-12s %2d bodies, friction %.2f: %d of %d steps, first %d, largest residual %.1e\n", scene->name,
                   scene->body_count, (double)scene->bodies[0].friction, tally.failed, tally.steps, tally.first,
                   tally.worst);
            bad++;
        }
        fflush(stdout);
        steps += tally.steps;
        failed += tally.failed;
        factorizations += tally.factorizations;
        reference_free(&tally.reference);
        world_destroy(world);
        scene_destroy(scene);
    }
    printf("%d structures, %ld steps, %ld factorizations: %ld steps (%.3f%%) of %d structures did not converge\n",
           count, steps, factorizations, failed, 100.0 * (double)failed / (double)steps, bad);
    return 200 * failed > steps;
}

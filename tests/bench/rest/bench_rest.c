/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Microseconds of the solver at rest: interior and the engine with 10 iterations, in scenes that both hold. Each method
   settles its own world for ten seconds; then the contact problems of the next steps are solved many times. The methods
   take turns. */
#include "report.h"

#include "scenes/scenes.h"
#include "methods/methods.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { CASES = 8, METHODS = 2, RUNS = 31, SETTLED = 600, STEPS = 10, SOLVES = 20 };

static const struct {
    const ContactSolverKind *kind;
    const char *settings, *name;
} methods[METHODS] = {{&solver_interior, "", "interior"}, {&solver_engine, "k=10", "engine:k=10"}};

static const struct {
    const char *name, *scene;
    SceneSetting setting;
} cases[CASES] = {{"10 boxes", "at_rest", {"height", 10}},
                  {"pyramid of 8 rows", "pyramid_rows", {"rows", 8}},
                  {"pyramid of 12 rows", "pyramid_rows", {"rows", 12}},
                  {"pyramid of 20 rows", "pyramid_rows", {"rows", 20}},
                  {"pyramid of 30 rows", "pyramid_rows", {"rows", 30}},
                  {"card house", "card_house", {"friction", 0.6}},
                  {"plate", "plate", {"ratio", 20}},
                  {"gate", "gate", {"mass", 20}}};

typedef struct Contender {
    ContactSolver solver;
    World *world;
    ContactSolution found;
} Contender;

static Scene *read_scene(int i) {
    char path[512];
    snprintf(path, sizeof path, "%s/scenes/stability/%s.yaml", SOURCE_DIR, cases[i].scene);
    Error error = {0};
    Scene *scene = scene_read_with(path, &cases[i].setting, 1, &error);
    if (scene == NULL) give_up(error.message);
    return scene;
}

static void step(Contender *method, float dt) {
    Error error = {0};
    if (!world_step(method->world, method->solver.kind->solve, method->solver.state, dt, &error))
        give_up(error.message);
}

static Contender settle(int k, const Scene *scene) {
    Error error = {0};
    Settings settings;
    Contender method = {{methods[k].kind, NULL}, scene_world(scene, &error), {0}};
    if (method.world == NULL ||
        !settings_parse(&settings, methods[k].settings, methods[k].kind->description.settings, methods[k].name, &error))
        give_up(error.message);
    method.solver.state = methods[k].kind->create(&settings, &error);
    if (method.solver.state == NULL) give_up(error.message);
    world_set_contacts(method.world, (ContactRules){.mend = !methods[k].kind->description.lite_contacts});
    for (int i = 0; i < SETTLED; i++) step(&method, scene->dt);
    const ContactProblem *problem = world_problem(method.world);
    method.found = (ContactSolution){
        .velocities = calloc((size_t)problem->body_count, sizeof *method.found.velocities),
        .impulses = calloc(8 * (size_t)problem->body_count, sizeof *method.found.impulses), /* more may close */
    };
    if (method.found.velocities == NULL || method.found.impulses == NULL) exit(3);
    return method;
}

static double microseconds(Contender *method) {
    Error error = {0};
    const ContactProblem *problem = world_problem(method->world);
    const double start = processor_seconds();
    for (int i = 0; i < SOLVES; i++)
        if (!method->solver.kind->solve(method->solver.state, problem, &method->found, &error)) give_up(error.message);
    return 1e6 * (processor_seconds() - start) / SOLVES;
}

static void measure(int i) {
    Scene *scene = read_scene(i);
    Samples samples[METHODS] = {0}, ratios = {0};
    Contender of[METHODS];
    for (int k = 0; k < METHODS; k++) of[k] = settle(k, scene);
    for (int run = 0; run < RUNS; run++) {
        double sum[METHODS] = {0};
        for (int s = 0; s < STEPS; s++)
            for (int k = 0; k < METHODS; k++) {
                step(&of[k], scene->dt);
                sum[k] += microseconds(&of[k]) / STEPS;
            }
        for (int k = 0; k < METHODS; k++) samples_add(&samples[k], sum[k]);
        samples_add(&ratios, sum[0] / sum[1]);
    }
    for (int k = 0; k < METHODS; k++) {
        report_line("rest", methods[k].name, cases[i].name, "us/step", &samples[k]);
        of[k].solver.kind->destroy(of[k].solver.state);
        world_destroy(of[k].world);
        free(of[k].found.velocities);
        free(of[k].found.impulses);
    }
    char name[64];
    snprintf(name, sizeof name, "at rest, %s: time of interior / engine", cases[i].name);
    report_target(name, samples_median(&ratios), "at most", 1.5);
    scene_destroy(scene);
}

int main(void) {
    report_header();
    for (int i = 0; i < CASES; i++) measure(i);
    return 0;
}

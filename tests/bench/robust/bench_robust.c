/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Microseconds per step of robust and of the engine with 10 iterations, in the four scenes that robust is made for. A
   sample is the mean over the steps of one run; the methods take turns. Measured twice: over the whole minute, in which
   the engine's boxes fall or explode, and over the first half second, while they stand. The worse of the two counts. */
#include "report.h"

#include "simulate/simulate.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { CASES = 4, METHODS = 2, RUNS = 31, PARTS = 2 };

static const char *const methods[METHODS] = {"robust", "engine:k=10"};

static const struct {
    const char *name, *scene;
    SceneSetting settings[2];
    int count;
} cases[CASES] = {{"20 boxes", "stack_height", {{"height", 20}}, 1},
                  {"200:1 on one", "heavy_on_one", {{"ratio", 200}}, 1},
                  {"50:1 on nine", "heavy_on_nine", {{"ratio", 50}}, 1},
                  {"10 boxes at 30 Hz", "time_step", {{"rate", 30}, {"height", 10}}, 2}};

static const struct {
    const char *name;
    double seconds;
} parts[PARTS] = {{"for a minute", 60}, {"for half a second", 0.5}};

static void give_up(const Error *error) {
    fprintf(stderr, "%s\n", error->message);
    exit(3);
}

static Scene *read_scene(int i) {
    char path[512];
    snprintf(path, sizeof path, "%s/scenes/stability/%s.yaml", SOURCE_DIR, cases[i].scene);
    Error error = {0};
    Scene *scene = scene_read_with(path, cases[i].settings, cases[i].count, &error);
    if (scene == NULL) give_up(&error);
    return scene;
}

static double microseconds_a_step(const Scene *scene, const char *text, int steps) {
    Error error = {0};
    Method method;
    if (!method_parse(&method, text, &error)) give_up(&error);
    World *world = scene_world(scene, &error);
    Stepper *stepper = world != NULL ? stepper_create(&method, scene, &error) : NULL;
    if (stepper == NULL) give_up(&error);
    double start = processor_seconds();
    for (int frame = 1; frame <= steps; frame++)
        if (!simulate_step(stepper, world, &(Step){.scene = scene, .frame = frame}, &error)) give_up(&error);
    double seconds = processor_seconds() - start;
    stepper_destroy(stepper);
    world_destroy(world);
    return 1e6 * seconds / steps;
}

/* The ratio of the time of robust to that of the engine. */
static double measure(int i, int part) {
    Scene *scene = read_scene(i);
    int steps = (int)(parts[part].seconds / (double)scene->dt + 0.5);
    Samples samples[METHODS] = {0}, ratios = {0};
    for (int run = 0; run < RUNS; run++) {
        for (int k = 0; k < METHODS; k++) samples_add(&samples[k], microseconds_a_step(scene, methods[k], steps));
        samples_add(&ratios, samples[0].values[run] / samples[1].values[run]);
    }
    scene_destroy(scene);
    char figure[64];
    snprintf(figure, sizeof figure, "%s %s", cases[i].name, parts[part].name);
    for (int k = 0; k < METHODS; k++) report_line("robust", methods[k], figure, "us/step", &samples[k]);
    return samples_median(&ratios);
}

int main(void) {
    double worse[CASES] = {0};
    report_header();
    for (int i = 0; i < CASES; i++)
        for (int part = 0; part < PARTS; part++) worse[i] = fmax(worse[i], measure(i, part));
    for (int i = 0; i < CASES; i++) {
        char name[64];
        snprintf(name, sizeof name, "robust / engine, %s", cases[i].name);
        report_target(name, worse[i], "at most", 1);
    }
    return 0;
}

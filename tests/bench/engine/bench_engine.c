/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Microseconds per step of twinbox, Chipmunk2D and Box2D 2.4: the same boxes, friction 0.2, 10 iterations, no sleeping,
   1/60 s, one thread. A sample is the mean over the timed steps of one run; the engines take turns. */
#include "report.h"
#include "rival.h"

#include "scenes/scenes.h"
#include "runs/runs.h"

#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { RIVALS = 3, SIZES = 4, LAUNCHES = 201, ROLLOUTS_REPEATED = 5 };

static const Rival *const rivals[RIVALS] = {&rival_twinbox, &rival_chipmunk, &rival_box2d};

static Scene *read_scene(const char *name) {
    char path[512];
    snprintf(path, sizeof path, "%s/scenes/%s.yaml", SOURCE_DIR, name);
    Error error = {0};
    Scene *scene = scene_read(path, &error);
    if (scene == NULL) give_up(error.message);
    return scene;
}

/* A run and its timed steps. */
typedef struct Course {
    const char *name;
    const Scene *scene;
    int bomb_after; /* the step after which the bomb is added; -1: never */
    int first, end; /* steps */
    int runs;
} Course;

static void add_box(const Rival *rival, void *world, const BodyDef *def) {
    const RivalBox box = {def->fixed,      def->size.x,     def->size.y,     def->mass,      def->friction,
                          def->position.x, def->position.y, def->velocity.x, def->velocity.y};
    rival->add(world, &box);
}

static double run_course(const Course *course, const Rival *rival) {
    void *world = rival->create();
    for (int i = 0; i < course->scene->body_count; i++) add_box(rival, world, &course->scene->bodies[i]);
    BodyDef bomb = scene_bomb_body(course->scene);
    double start = 0;
    for (int step = 0; step < course->end; step++) {
        if (step == course->bomb_after) add_box(rival, world, &bomb);
        if (step == course->first) start = processor_seconds();
        rival->step(world);
    }
    double seconds = processor_seconds() - start;
    rival->destroy(world);
    return 1e6 * seconds / (course->end - course->first);
}

static void measure(const Course *course, Samples samples[RIVALS]) {
    memset(samples, 0, RIVALS * sizeof *samples);
    for (int run = 0; run < course->runs; run++)
        for (int i = 0; i < RIVALS; i++) samples_add(&samples[i], run_course(course, rivals[i]));
    for (int i = 0; i < RIVALS; i++) report_line("engine", rivals[i]->name, course->name, "us/step", &samples[i]);
}

/* The median of the ratios run by run: a slow phase of the machine slows both. */
static double ratio(const Samples *ours, const Samples *theirs) {
    Samples ratios = {0};
    for (int i = 0; i < ours->count; i++) samples_add(&ratios, ours->values[i] / theirs->values[i]);
    return samples_median(&ratios);
}

static void scenes_against_chipmunk(double ratios[4], const char *names[4]) {
    Scene *single = read_scene("single"), *stack = read_scene("stack"), *pyramid = read_scene("pyramid_settled");
    const Course courses[4] = {{"single", single, 0, 0, 300, 41},
                               {"stack", stack, 0, 0, 300, 31},
                               {"pyramid settled", pyramid, -1, 120, 180, 31},
                               {"pyramid struck", pyramid, 180, 180, 300, 31}};
    for (int i = 0; i < 4; i++) {
        Samples samples[RIVALS];
        measure(&courses[i], samples);
        ratios[i] = ratio(&samples[0], &samples[1]);
        names[i] = courses[i].name;
    }
    scene_destroy(single);
    scene_destroy(stack);
    scene_destroy(pyramid);
}

/* The pyramid with `base` boxes in the lowest row, touching from the start: it is at rest after a second. */
static void make_pyramid(Scene *scene, int base) {
    BodyDef ground = scene->bodies[0], box = scene->bodies[1];
    ground.size.x = 4.0f * (float)base;
    scene->body_count = 1 + base * (base + 1) / 2;
    scene->bodies = realloc(scene->bodies, (size_t)scene->body_count * sizeof *scene->bodies);
    if (scene->bodies == NULL) abort();
    BodyDef *next = scene->bodies;
    *next++ = ground;
    for (int row = 0; row < base; row++) {
        for (int i = row; i < base; i++, next++) {
            *next = box;
            next->position.x = 1.125f * ((float)i - 0.5f * (float)row) - 0.5f * 1.125f * (float)base;
            next->position.y = 0.5f + (float)row;
        }
    }
}

/* The exponent of time over bodies (least squares of logarithms), and the worst ratio to Box2D. */
static void scaling(double *exponent, double *worst) {
    const int bases[SIZES] = {10, 20, 40, 80}, runs[SIZES] = {21, 11, 7, 5};
    double x[SIZES], y[SIZES], mean_x = 0, mean_y = 0, xx = 0, xy = 0;
    *worst = 0;
    Scene *scene = read_scene("pyramid");
    for (int i = 0; i < SIZES; i++) {
        char name[32];
        snprintf(name, sizeof name, "pyramid base %d", bases[i]);
        make_pyramid(scene, bases[i]);
        const Course course = {name, scene, -1, 60, 120, runs[i]};
        Samples samples[RIVALS];
        measure(&course, samples);
        x[i] = log(scene->body_count);
        y[i] = log(samples_median(&samples[0]));
        mean_x += x[i] / SIZES;
        mean_y += y[i] / SIZES;
        *worst = fmax(*worst, ratio(&samples[0], &samples[2]));
    }
    scene_destroy(scene);
    for (int i = 0; i < SIZES; i++) {
        xx += (x[i] - mean_x) * (x[i] - mean_x);
        xy += (x[i] - mean_x) * (y[i] - mean_y);
    }
    *exponent = xy / xx;
}

static bool ignore_step(void *context, int frame, const World *world, Error *error) {
    (void)context, (void)frame, (void)world, (void)error;
    return true;
}

static double roll_out(const Scene *scene, int threads) {
    double start = clock_seconds();
#pragma omp parallel for schedule(dynamic) num_threads(threads)
    for (int i = 0; i < LAUNCHES; i++) {
        Error error = {0};
        Scene launch = *scene;
        launch.bomb.x.value = -5.0f + 0.05f * (float)i;
        Method method;
        const StepObserver observer = {ignore_step, NULL};
        if (!method_parse(&method, "engine", &error) || !simulate_observed(&launch, &method, &observer, &error))
            give_up(error.message);
    }
    return clock_seconds() - start;
}

static double rollouts(void) {
    Scene *scene = read_scene("pyramid");
    Samples one = {0}, two = {0};
    for (int i = 0; i < ROLLOUTS_REPEATED; i++) {
        samples_add(&one, roll_out(scene, 1));
        samples_add(&two, roll_out(scene, 2));
    }
    scene_destroy(scene);
    report_line("engine", "one thread", "201 launches of pyramid", "s", &one);
    report_line("engine", "two threads", "201 launches of pyramid", "s", &two);
    return ratio(&one, &two);
}

int main(void) {
    double ratios[4], exponent, worst;
    const char *names[4];
    report_header();
    scenes_against_chipmunk(ratios, names);
    scaling(&exponent, &worst);
    double speedup = rollouts();
    for (int i = 0; i < 4; i++) {
        char name[64];
        snprintf(name, sizeof name, "step of %s: time / Chipmunk2D", names[i]);
        report_target(name, ratios[i], "at most", 0.40);
    }
    report_target("exponent of time over bodies", exponent, "at most", 1.1);
    report_target("step of the slowest size: time / Box2D 2.4", worst, "at most", 1.0);
    report_target("rollouts, two threads / one", speedup, "at least", 1.9);
    return 0;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The binary form of twinbox's protocol for engines (README.md), in C and C++ for little-endian machines. An adapter defines the
   functions below, and its main() calls serve(). */
#pragma once
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

typedef struct ServeScene {
    float gravity_x, gravity_y, dt; /* m/s^2, s */
    uint32_t iterations;            /* of twinbox's own solvers */
} ServeScene;

typedef struct ServeBody {
    float fixed, width, height, x, y, angle, vx, vy, omega, mass, friction; /* fixed: 0 or 1; mass 0 if fixed */
} ServeBody;

typedef struct ServeState {
    float x, y, angle, vx, vy, omega;
} ServeState;

static void world_begin(const ServeScene *scene); /* instead of the world before, if there was one */
static void world_add(const ServeBody *body);
static void world_remove(void); /* the last body */
static void world_step(void);
static ServeState world_state(uint32_t body);

static char serve_hello[4096];
static FILE *serve_answers;

/* The number in a setting of the method, exec:PROGRAM,KEY=NUMBER. */
static inline double serve_setting(const char *key, double standard) {
    char text[80];
    snprintf(text, sizeof text, "\"%s\": \"", key);
    const char *at = strstr(serve_hello, text);
    return at != NULL ? atof(at + strlen(text)) : standard;
}

/* Ends with the input. */
static void serve_read(void *to, size_t size) {
    if (fread(to, 1, size, stdin) != size) exit(0);
}

static uint64_t serve_ns(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (uint64_t)now.tv_sec * 1000000000 + (uint64_t)now.tv_nsec;
}

static void serve_step(uint32_t scene, uint32_t frame, uint32_t bodies) {
    const uint64_t begun = serve_ns();
    world_step();
    const uint64_t ns = serve_ns() - begun;
    const uint32_t head[4] = {scene, frame, bodies, 0};
    fwrite(head, sizeof head, 1, serve_answers);
    fwrite(&ns, sizeof ns, 1, serve_answers);
    for (uint32_t i = 0; i < bodies; i++) {
        const ServeState state = world_state(i);
        fwrite(&state, sizeof state, 1, serve_answers);
    }
    fflush(serve_answers);
}

static int serve(const char *name, const char *version) {
    uint32_t head[6], bodies = 0;
    ServeScene scene;
    serve_answers = fdopen(dup(STDOUT_FILENO), "w");
    dup2(STDERR_FILENO, STDOUT_FILENO); /* what an engine prints is no answer */
    if (serve_answers == NULL || fgets(serve_hello, sizeof serve_hello, stdin) == NULL) return 1;
    fprintf(serve_answers, "{\"twinbox\": 1, \"name\": \"%s\", \"version\": \"%s\", \"form\": \"binary\"}\n", name,
            version);
    fflush(serve_answers);
    for (;;) {
        serve_read(head, sizeof head); /* scene, frame, steps, added, removed, iterations */
        serve_read(&scene, 3 * sizeof(float));
        scene.iterations = head[5];
        if (head[1] == 0) {
            world_begin(&scene);
            bodies = 0;
        }
        for (uint32_t i = 0; i < head[4]; i++) world_remove();
        for (uint32_t i = 0; i < head[3]; i++) {
            ServeBody body;
            serve_read(&body, sizeof body);
            world_add(&body);
        }
        bodies += head[3] - head[4];
        for (uint32_t k = 1; k <= head[2]; k++) serve_step(head[0], head[1] + k, bodies);
    }
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scenes, and the values of their parameters (--set). */
#include "fuzz.h"

#include "cli/options.h"

#include <math.h>
#include <string.h>

static void check_body(const BodyDef *body) {
    if (!(body->size.x > 0 && body->size.y > 0 && (body->fixed || body->mass > 0)))
        fuzz_fail("a body of %g x %g m, %g kg", (double)body->size.x, (double)body->size.y, (double)body->mass);
    if (!isfinite(body->position.x) || !isfinite(body->position.y) || !isfinite(body->angle) ||
        !isfinite(body->velocity.x) || !isfinite(body->velocity.y) || !isfinite(body->angular_velocity))
        fuzz_fail("a state is NaN or infinite");
}

/* What runs rely on. */
static void check_scene(const Scene *scene) {
    Error error = {0};
    if (!(scene->dt >= SCENE_MIN_DT && scene->dt <= SCENE_MAX_DT)) fuzz_fail("dt %g", (double)scene->dt);
    if (scene->body_count < 1 || scene->body_count > SCENE_MAX_BODIES || scene->frames < 1 ||
        scene->frames > SCENE_MAX_FRAMES || scene->iterations < 1 || scene->iterations > SCENE_MAX_ITERATIONS)
        fuzz_fail("%d bodies, %d frames, %d iterations", scene->body_count, scene->frames, scene->iterations);
    for (int i = 0; i < scene->body_count; i++) check_body(&scene->bodies[i]);
    if (scene->bomb.present) {
        const BodyDef bomb = scene_bomb_body(scene);
        check_body(&bomb);
    }
    World *world = scene_world(scene, &error);
    if (world == NULL) fuzz_fail("no world: %s", error.message);
    world_destroy(world);
}

static void read_scene(const char *path, const SceneSettings *set) {
    Error error = {0};
    Scene *scene = FUZZ_READ(scene_read_with(path, set->items, set->count, &error), path);
    if (scene != NULL) check_scene(scene);
    scene_destroy(scene);
}

void fuzz_scene(const uint8_t *data, size_t size) {
    read_scene(fuzz_file("scene.yaml", data, size), &(SceneSettings){.count = 0});
}

/* A line is the value of one --set. */
void fuzz_set(const uint8_t *data, size_t size) {
    static const char scene[] = "parameters:\n"
                                "  rate: {value: 60, from: 30, to: 2000, unit: 1/s}\n"
                                "  height: {value: 3, from: 1, to: 5, step: 1}\n"
                                "  mass: {value: 2, from: 0.001, to: 1e6}\n"
                                "gravity: [0, -10]\ndt: 1/$rate\niterations: 10\nwarm_starting: on\n"
                                "accumulate_impulses: on\nposition_correction: on\nframes: 30\n"
                                "bodies:\n  - {static: true, size: [100, 20], position: [0, -10]}\n"
                                "  - {mass: $mass, size: [1, 1], position: [0, $height]}\n";
    static const Option option = {"--set", .read = option_set};
    SceneSettings set = {.count = 0};
    Error error = {0};
    char text[4096];
    fuzz_text(text, sizeof text, data, size);
    for (char *line = text, *end; line != NULL; line = end) {
        end = strchr(line, '\n');
        if (end != NULL) *end++ = '\0';
        fuzz_begin();
        const bool ok = option_set(&option, line, &set, &error);
        fuzz_end(ok, &error, "--set");
        if (!ok) return;
    }
    read_scene(fuzz_file("set.yaml", scene, sizeof scene - 1), &set);
}

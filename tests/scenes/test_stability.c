/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The scenes of scenes/stability, each at both ends of each of its parameters: they can be read, and begin at rest. */
#include "owned.h"

#include "engine/engine.h"
#include "scenes/scenes.h"

#include <glob.h>

enum { LEAST_SCENES = 20 };

/* What position correction leaves as it is (Catto 2006), and what decimals of a file are off by. */
static const float slop = 0.01F, decimals = 1e-4F;

static Scene *read_with(const char *path, const SceneSetting *settings, int count) {
    Error error = {0};
    Scene *scene = scene_read_with(path, settings, count, &error);
    assert_ok(scene != NULL, error);
    return scene;
}

static Box box_of(const BodyDef *body) { return box_make(body->position, body->size, body->angle); }

/* All but what is there to overlap: nothing deeper than the slop, the bomb included. */
static void check_overlaps(const Scene *scene) {
    const BodyDef bomb = scene_bomb_body(scene);
    int count = scene->body_count + scene->bomb.present;
    for (int b = 0; b < count; b++) {
        const BodyDef *body = b < scene->body_count ? &scene->bodies[b] : &bomb;
        Box box = box_of(body);
        bool touches = b == scene->body_count || body->fixed;
        for (int a = 0; a < count; a++) {
            if (a == b) continue;
            Box other = box_of(a < scene->body_count ? &scene->bodies[a] : &bomb);
            Manifold manifold;
            manifold_compute(&manifold, &other, &box);
            touches |= manifold.count > 0;
            bool fixed = body->fixed && a < scene->body_count && scene->bodies[a].fixed;
            for (int i = 0; i < manifold.count && !fixed; i++)
                if (manifold.points[i].separation < -slop - decimals && strcmp(scene->name, "overlap") != 0)
                    fail_msg("%s: bodies %d and %d begin %g m deep", scene->name, a, b,
                             (double)-manifold.points[i].separation);
        }
        /* beyond_training is stack.yaml, whose boxes are dropped. */
        if (!touches && strcmp(scene->name, "beyond_training") != 0)
            fail_msg("%s: body %d stands on nothing", scene->name, b);
    }
}

static void check_ends(const char *path) {
    OWN(Scene) *scene = read_with(path, NULL, 0);
    assert_true(scene->parameter_count > 0);
    check_overlaps(scene);
    for (int i = 0; i < scene->parameter_count; i++) {
        const SceneParameter *parameter = &scene->parameters[i];
        assert_true(parameter->from < parameter->to);
        for (int end = 0; end <= 1; end++) {
            SceneSetting setting = {.value = end == 0 ? parameter->from : parameter->to};
            strcpy(setting.name, parameter->name);
            OWN(Scene) *other = read_with(path, &setting, 1);
            if (setting.value != parameter->value && scene_hash(other) == scene_hash(scene))
                fail_msg("%s: %s changes nothing", scene->name, parameter->name);
            check_overlaps(other);
        }
    }
}

TEST(every_scene_begins_at_rest_at_all_ends) {
    glob_t found;
    assert_int_equal(glob(SOURCE_DIR "/scenes/stability/*.yaml", 0, NULL, &found), 0);
    assert_true(found.gl_pathc >= LEAST_SCENES);
    for (size_t i = 0; i < found.gl_pathc; i++) check_ends(found.gl_pathv[i]);
    globfree(&found);
}

/* A network of a scene knows it by its bodies and bomb. */
TEST(beyond_training_is_the_stack_itself) {
    OWN(Scene) *stack = read_with(SOURCE_DIR "/scenes/stack.yaml", NULL, 0);
    OWN(Scene) *beyond = read_with(SOURCE_DIR "/scenes/stability/beyond_training.yaml", NULL, 0);
    assert_int_equal(scene_hash(beyond), scene_hash(stack));
    assert_int_equal(beyond->frames, stack->frames);
    assert_int_equal(beyond->network_count, stack->network_count + 1); /* scene-net, which is what is tested there */
    assert_non_null(scene_network(beyond, "scene-net"));
    for (int i = 0; i < stack->network_count; i++) {
        const char *method = stack->networks[i].method, *path = scene_network(beyond, method);
        assert_non_null(path);
        assert_string_equal(strrchr(path, '/'), strrchr(scene_network(stack, method), '/'));
    }
}

RUN_TESTS(NULL, NULL)

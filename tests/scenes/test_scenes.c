/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every key of the format; hash and world of a scene. (The bodies of those in scenes/: their runs in
   golden/trajectories.) */
#include "scene_text.h"
#include "made.h"

static Scene *shipped(const char *name) {
    Scene *scene = scene_named(name);
    assert_string_equal(scene->name, name);
    return scene;
}

/* Bit for bit: == on floats would let -0 pass for 0. */
static void assert_same_float(float found, float expected) {
    if (memcmp(&found, &expected, sizeof found) != 0)
        fail_msg("found %.9g, expected %.9g", (double)found, (double)expected);
}

static void assert_same_vector(Vec2 found, Vec2 expected) {
    assert_same_float(found.x, expected.x);
    assert_same_float(found.y, expected.y);
}

static void assert_same_body(const BodyDef *found, const BodyDef *expected) {
    assert_same_vector(found->size, expected->size);
    assert_int_equal(found->fixed, expected->fixed);
    assert_same_float(found->mass, expected->mass);
    assert_same_float(found->friction, expected->friction);
    assert_same_vector(found->position, expected->position);
    assert_same_float(found->angle, expected->angle);
    assert_same_vector(found->velocity, expected->velocity);
    assert_same_float(found->angular_velocity, expected->angular_velocity);
}

static BodyDef unit_box(float mass, float x, float y) {
    return (BodyDef){.size = {1, 1}, .mass = mass, .friction = 0.2f, .position = {x, y}};
}

TEST(scenes_name_the_network_beside_them) {
    OWN(Scene) *scene = shipped("single");
    assert_string_equal(scene_network(scene, "pair-net"), SOURCE_DIR "/scenes/networks/pair-net.npz");
    assert_null(scene_network(scene, "pair"));
}

TEST(every_key_reaches_its_member) {
    OWN(Scene) *scene =
        good_scene("networks: {b-2: /absolute.npz}\n"
                   "bomb: {rotation: 0.5, spin: -2, velocity: [3, 4], friction: 0, mass: 7, size: [2, 3],\n"
                   "  y: 6, x: 5, frame: 9, impact_frames: 3}\n"
                   "bodies:\n"
                   "- {friction: 1.5, spin: 0.25, velocity: [1, 2], angle: 1e-1, position: [3, 4], mass: 5,\n"
                   "   size: [6, 7], static: no}\n"
                   "camera: {size: [8, 9], center: [-1, -2]}\n"
                   "frames: 9\nposition_correction: no\naccumulate_impulses: false\nwarm_starting: off\n"
                   "iterations: 3\ndt: 1/120\ngravity: [1, 2]\n");
    const BodyDef body = {.size = {6, 7},
                          .mass = 5,
                          .friction = 1.5f,
                          .position = {3, 4},
                          .angle = 0.1f,
                          .velocity = {1, 2},
                          .angular_velocity = 0.25f};
    const BodyDef bomb = {
        .size = {2, 3}, .mass = 7, .position = {5, 6}, .angle = 0.5f, .velocity = {3, 4}, .angular_velocity = -2};
    assert_same_body(&scene->bodies[0], &body);
    BodyDef found = scene_bomb_body(scene);
    assert_same_body(&found, &bomb);
    assert_int_equal(scene->bomb.frame, 9);
    assert_int_equal(scene->bomb.impact_frames, 3);
    assert_same_vector(scene->camera_center, vec2(-1, -2));
    assert_same_vector(scene->camera_size, vec2(8, 9));
    assert_int_equal(scene->frames, 9);
    assert_false(scene->warm_starting || scene->accumulate_impulses || scene->position_correction);
    assert_int_equal(scene->iterations, 3);
    assert_same_float(scene->dt, 1.0f / 120.0f);
    assert_same_vector(scene->gravity, vec2(1, 2));
    assert_string_equal(scene_network(scene, "b-2"), "/absolute.npz");
}

TEST(keys_left_out_have_defaults) {
    OWN(Scene) *scene = good_scene(BODY("mass: 5, size: [6, 7], position: [3, 4]"));
    const BodyDef body = {.size = {6, 7}, .mass = 5, .friction = 0.2f, .position = {3, 4}};
    assert_same_body(&scene->bodies[0], &body);
    assert_false(scene->bomb.present);
    assert_true(scene->warm_starting && scene->accumulate_impulses && scene->position_correction);
    assert_same_vector(scene->camera_size, vec2(0, 0));
    assert_int_equal(scene->network_count, 0);
}

TEST(rows_go_by_their_spacing) {
    OWN(Scene) *scene =
        good_scene(BASE GROUND "  - {pattern: row, count: 100, spacing: [0.3, -0.1], mass: 1, size: [1, 1],\n"
                               "     position: [0.7, 2], angle: 0.5, velocity: [1, 2], spin: 3}\n"
                               "overlaps: allowed\n");
    assert_int_equal(scene->body_count, 101);
    for (int i = 0; i < 100; i++) {
        BodyDef box = unit_box(1, 0.7f + 0.3f * (float)i, 2 + -0.1f * (float)i);
        box.angle = 0.5f;
        box.velocity = vec2(1, 2);
        box.angular_velocity = 3;
        assert_same_body(&scene->bodies[1 + i], &box);
    }
}

TEST(line_ends_and_byte_order_mark_do_not_matter) {
    OWN(Scene) *unix_ends = good_scene(BODY("mass: 5, size: [6, 7], position: [3, 4]"));
    OWN(Scene) *dos_ends = good_scene("\xef\xbb\xbfgravity: [0, -10]\r\ndt: 1/60\r\niterations: 10\r\nframes: 300\r\n"
                                      "bodies:\r\n  - mass: 5\r\n    size: [6, 7]\r\n    position: [3, 4]\r\n");
    assert_int_equal(scene_hash(unix_ends), scene_hash(dos_ends));
}

/* The first of each list, and that with one value changed at a time. */
static const char *const variants[] = {
    "gravity: [0, -10]\ndt: 1/60\niterations: 10\nframes: 300\n",
    "gravity: [1, -10]\ndt: 1/60\niterations: 10\nframes: 300\n",
    "gravity: [0, -9]\ndt: 1/60\niterations: 10\nframes: 300\n",
    "gravity: [0, -10]\ndt: 1/61\niterations: 10\nframes: 300\n",
    "gravity: [0, -10]\ndt: 1/60\niterations: 11\nframes: 300\n",
    BASE "warm_starting: off\n",
    BASE "accumulate_impulses: off\n",
    BASE "position_correction: off\n",
};

static const char *const bodies[] = {
    "{mass: 1, size: [1, 1], position: [0, 0]}",
    "{mass: 2, size: [1, 1], position: [0, 0]}",
    "{static: on, size: [1, 1], position: [0, 0]}",
    "{mass: 1, size: [2, 1], position: [0, 0]}",
    "{mass: 1, size: [1, 2], position: [0, 0]}",
    "{mass: 1, size: [1, 1], position: [1, 0]}",
    "{mass: 1, size: [1, 1], position: [0, 1]}",
    "{mass: 1, size: [1, 1], position: [0, 0], angle: 1}",
    "{mass: 1, size: [1, 1], position: [0, 0], velocity: [1, 0]}",
    "{mass: 1, size: [1, 1], position: [0, 0], velocity: [0, 1]}",
    "{mass: 1, size: [1, 1], position: [0, 0], spin: 1}",
    "{mass: 1, size: [1, 1], position: [0, 0], friction: 0.3}",
    "{mass: 1, size: [1, 1], position: [0, 0], until: 1}",
    "{mass: 1, size: [1, 1], position: [0, 0], until: 2}",
    "{mass: 1, size: [1, 1], position: [0, 0], pattern: row, count: 2, spacing: [0, 0]}",
};

static const char *const bombs[] = {
    "{x: 1, y: 1, size: [1, 1], mass: 1}",
    "{x: 2, y: 1, size: [1, 1], mass: 1}",
    "{x: 1, y: 2, size: [1, 1], mass: 1}",
    "{x: 1, y: 1, size: [2, 1], mass: 1}",
    "{x: 1, y: 1, size: [1, 1], mass: 2}",
    "{x: 1, y: 1, size: [1, 1], mass: 1, friction: 0.3}",
    "{x: 1, y: 1, size: [1, 1], mass: 1, rotation: 1}",
    "{x: 1, y: 1, size: [1, 1], mass: 1, spin: 1}",
    "{x: 1, y: 1, size: [1, 1], mass: 1, frame: 1}",
    "{x: 1, y: 1, size: [1, 1], mass: 1, velocity: [1, 0]}",
    "{x: 1, y: 1, size: [1, 1], mass: 1, velocity: {times_position: -1.5}}",
};

#define COUNT(array) (sizeof(array) / sizeof *(array))

static uint64_t hash_text(const char *text) {
    OWN(Scene) *scene = good_scene(text);
    uint64_t hash = scene_hash(scene);
    return hash;
}

static uint64_t hash_of(const char *base, const char *body, const char *bomb) {
    const char *text = printed("%soverlaps: allowed\nbodies:\n  - %s\n%s%s\n", base, body,
                               bomb == NULL ? "" : "bomb: ", bomb == NULL ? "" : bomb);
    return hash_text(text);
}

TEST(hash_changes_with_every_physical_value) {
    uint64_t hashes[COUNT(variants) + COUNT(bodies) + COUNT(bombs)];
    size_t count = 0;
    for (size_t i = 0; i < COUNT(variants); i++) hashes[count++] = hash_of(variants[i], bodies[0], NULL);
    for (size_t i = 1; i < COUNT(bodies); i++) hashes[count++] = hash_of(BASE, bodies[i], NULL);
    for (size_t i = 0; i < COUNT(bombs); i++) hashes[count++] = hash_of(BASE, bodies[0], bombs[i]);
    for (size_t i = 0; i < count; i++)
        for (size_t j = 0; j < i; j++)
            if (hashes[i] == hashes[j]) fail_msg("scenes %zu and %zu have the same hash", j, i);
}

TEST(hash_keeps_with_all_else) {
    uint64_t hash = hash_of(BASE, bodies[0], bombs[0]);
    assert_int_equal(hash, hash_text("# comment\nframes: 200 # not physics\niterations: +10\ndt: 1/60\n"
                                     "gravity: [0.0,\n  -1e1]\ncamera: {center: [1, 1], size: [2, 2]}\n"
                                     "networks: {pair-net: x.npz}\nbomb:\n  mass: 1\n  size: [1, 1]\n  y: 1\n  x: 1\n"
                                     "  impact_frames: 9\n"
                                     "bodies: [{position: [0, 0], friction: 0.2, size: [1, 1], mass: 1.0}]\n"));
    Scene *scene = shipped("single");
    uint64_t without_mass = scene_hash(scene);
    scene->bodies[0].mass = 7; /* the ground is static */
    assert_int_equal(scene_hash(scene), without_mass);
    scene_destroy(scene);
    /* The velocity counts and not the law that gave it. */
    assert_int_equal(hash_of(BASE, bodies[0], "{x: 2, y: 4, size: [1, 1], mass: 1, velocity: [-3, -6]}"),
                     hash_of(BASE, bodies[0], "{x: 2, y: 4, size: [1, 1], mass: 1, velocity: {times_position: -1.5}}"));
}

TEST(world_has_the_bodies_in_order_and_the_bomb_last) {
    OWN(Scene) *scene = shipped("pyramid");
    OWN(World) *world = world_of(scene);
    assert_int_equal(world_body_count(world), 68);
    for (int i = 0; i < 67; i++) assert_same_vector(world_bodies(world)[i].position, scene->bodies[i].position);
    assert_same_vector(world_bodies(world)[67].position, vec2(scene->bomb.x.value, 15));
    assert_same_vector(world_bodies(world)[67].velocity, vec2(-1.5f * scene->bomb.x.value, -22.5f));
}

TEST(world_has_no_bomb_before_its_frame) {
    OWN(Scene) *scene = shipped("pyramid_settled");
    OWN(World) *world = world_of(scene);
    assert_int_equal(world_body_count(world), 67);
    scene->bomb.x.value = -4;
    assert_ok(scene_add_bomb(scene, world, &error), error);
    assert_int_equal(world_body_count(world), 68);
    assert_same_vector(world_bodies(world)[67].velocity, vec2(6, -22.5f));
}

RUN_TESTS(NULL, NULL)

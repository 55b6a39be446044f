/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scenes from the ends of what a file may hold (scenes/scene_read.c): thin and huge boxes, feathers under a million
   tonnes, shots and spins beyond all reason, half of it inside each other. What a method makes of them may be nonsense;
   it may not be a number that is none, nor be kept where a step is refused. */
#include "made.h"

#include "engine/uniform.h"

enum { SCENES = 200, STEPS = 30, BOXES_MAX = 8 };

/* Evenly over the powers of ten from low to high, and now and then one of these. */
static float any_of(uint32_t *seed, float low, float high) {
    float kind = uniform(seed, 0, 1);
    if (kind < 0.15f) return low;
    if (kind < 0.3f) return high;
    return low * powf(high / low, uniform(seed, 0, 1));
}

static float any_rate(uint32_t *seed, float high) {
    float kind = uniform(seed, 0, 1), size = any_of(seed, 1e-3f, high);
    return kind < 0.8f ? 0 : kind < 0.9f ? size : -size;
}

/* A heap on a ground of its size, so that most things touch. */
static void make_scene(Scene *scene, BodyDef bodies[BOXES_MAX], uint32_t *seed) {
    float size = uniform(seed, 0, 1) < 0.5f ? 1 : any_of(seed, 1e-3f, 1e3f), base = any_rate(seed, SCENE_MAX_POSITION);
    *scene = (Scene){.name = "hostile",
                     .gravity = {any_rate(seed, 1e4f), uniform(seed, 0, 1) < 0.5f ? -10 : -any_of(seed, 1e-3f, 1e4f)},
                     .dt = uniform(seed, 0, 1) < 0.5f ? 1.0f / 60.0f : any_of(seed, SCENE_MIN_DT, SCENE_MAX_DT),
                     .iterations = 10,
                     .warm_starting = uniform(seed, 0, 1) < 0.8f,
                     .accumulate_impulses = uniform(seed, 0, 1) < 0.8f,
                     .position_correction = true,
                     .frames = STEPS,
                     .body_count = BOXES_MAX,
                     .bodies = bodies};
    for (int i = 0; i < BOXES_MAX; i++) {
        bool plain = uniform(seed, 0, 1) < 0.5f;
        bodies[i] = (BodyDef){.size = {size, plain ? size : any_of(seed, 1e-3f, 1e4f)},
                              .mass = any_of(seed, 1e-6f, 1e9f),
                              .friction = any_of(seed, 1e-3f, 10),
                              .position = {base, size * ((float)i - 0.5f)},
                              .angle = plain ? 0 : any_rate(seed, 1e4f),
                              .velocity = {any_rate(seed, 1e4f), any_rate(seed, 1e4f)},
                              .angular_velocity = plain ? 0 : any_rate(seed, 1e4f)};
    }
    bodies[0].fixed = true;
}

/* 1e9 kg on feathers, one of them as wide as a mountain: float32 cannot add up what passes through them, and a thousand
   of the engine's sweeps make more of it each time. */
static void make_heap(Scene *scene, BodyDef bodies[BOXES_MAX]) {
    const BodyDef heap[] = {
        {.size = {20, 1}, .fixed = true, .position = {0, -0.5f}},
        {.size = {1, 1},
         .mass = 3.22629e-5f,
         .friction = 3.05375f,
         .position = {-0.239625f, 0.5f},
         .velocity = {-0.00137693f, 6355.13f}},
        {.size = {1, 1}, .mass = 85.2385f, .friction = 0.0925949f, .position = {0, 1.5f}},
        {.size = {1e4f, 1e4f},
         .mass = 1.24614e-4f,
         .friction = 0.455041f,
         .position = {-0.355312f, 2.5f},
         .angle = -0.0733413f},
        {.size = {1, 1}, .mass = 1e9f, .friction = 0.2f, .position = {-0.324474f, 3.5f}, .velocity = {0, 0.291656f}},
        {.size = {1.89503f, 1},
         .mass = 29346.3f,
         .friction = 0.2f,
         .position = {0, 4.5f},
         .velocity = {6111.7f, 0},
         .angular_velocity = 90.4525f}};
    memcpy(bodies, heap, sizeof heap);
    *scene = (Scene){.name = "heap",
                     .gravity = {0, -10},
                     .dt = 4.57902e-4f,
                     .iterations = 1000,
                     .accumulate_impulses = true,
                     .position_correction = true,
                     .frames = STEPS,
                     .body_count = sizeof heap / sizeof *heap,
                     .bodies = bodies};
}

static void assert_finite(const World *world, const char *method, int scene, int step) {
    const Body *bodies = world_bodies(world);
    for (int i = 0; i < world_body_count(world); i++) {
        const Body *body = &bodies[i];
        const float numbers[] = {body->position.x, body->position.y, body->angle,
                                 body->velocity.x, body->velocity.y, body->angular_velocity};
        for (int k = 0; k < 6; k++)
            if (!isfinite(numbers[k])) fail_msg("%s, scene %d, step %d: body %d is nowhere", method, scene, step, i);
    }
    const ContactSolution *solution = world_solution(world);
    for (int i = 0; i < world_problem(world)->contact_count; i++)
        if (!isfinite(solution->impulses[i].normal) || !isfinite(solution->impulses[i].tangent))
            fail_msg("%s, scene %d, step %d: impulse %d is none", method, scene, step, i);
}

/* True where a step was refused. */
static bool run_scene(const Scene *scene, int number, const Method *method) {
    Error error = {0};
    OWN(World) *world = world_of(scene);
    OWN(Stepper) *stepper = stepper_of(scene, method);
    bool ok = true;
    for (int step = 1; ok && step <= scene->frames; step++) {
        ok = simulate_step(stepper, world, &(Step){.scene = scene, .frame = step}, &error);
        if (ok)
            assert_finite(world, method->text, number, step);
        else
            assert_error(error, ERROR_INPUT, "is NaN or infinite");
    }
    return !ok;
}

static bool needs_files(const Method *method, const Scene *scene) {
    return method_lacks_network(method, scene) || strcmp(method->text, "playback") == 0;
}

/* The reference is held to fewer scenes: it takes its time. */
TEST(no_method_leaves_the_finite_numbers) {
    for (const MethodKind *kind = method_kinds; kind->description != NULL; kind++) {
        Scene scene;
        BodyDef bodies[BOXES_MAX];
        uint32_t seed = 11;
        if (kind->description->external) continue;
        const Method method = method_named(kind->description->name);
        make_heap(&scene, bodies);
        if (needs_files(&method, &scene)) continue;
        run_scene(&scene, -1, &method);
        const int scenes = kind->description->role == METHOD_REFERENCE ? SCENES / 40 : SCENES;
        for (int i = 0; i < scenes; i++) {
            make_scene(&scene, bodies, &seed);
            run_scene(&scene, i, &method);
        }
    }
}

/* So there is something to refuse. */
TEST(a_step_that_blows_up_is_refused) {
    Scene scene;
    BodyDef bodies[BOXES_MAX];
    make_heap(&scene, bodies);
    const Method method = method_named("engine");
    assert_true(run_scene(&scene, -1, &method));
}

RUN_TESTS(NULL, NULL)

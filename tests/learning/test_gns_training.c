/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Small complete trainings of gns, and their examples. */
#include "trainings.h"
#include "owned.h"

#include "learning/gns_training.h"

#include <omp.h>

static Scene *small_scene(void) {
    const char *path = temporary_path("small.yaml");
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs("gravity: [0, -10]\ndt: 1/60\niterations: 10\nframes: 40\nbodies:\n"
          "  - {static: true, size: [100, 20], position: [0, -10]}\n"
          "  - {mass: 2, size: [1, 1], position: [0, 0.6]}\n"
          "bomb: {x: {from: -1, to: 1}, y: 8, size: [1, 1], mass: 5, velocity: {times_position: -1.5}}\n",
          file);
    fclose(file);
    return scene_from(path);
}

static GnsScore scored;

static void keep_score(void *context, const GnsScore *score) {
    (void)context;
    scored = *score;
}

static GnsTraining small(void) {
    return (GnsTraining){.width = 16,
                         .rounds = 2,
                         .steps = 300,
                         .batch = 2,
                         .launches = 2,
                         .radius = 0.6f,
                         .noise = 0.05f,
                         .rate = 0.002,
                         .seed = 3,
                         .on_score = keep_score};
}

/* Trains on the small scene; the caller frees the net. */
static bool train(GnsTraining training, GnsNet *net, const Progress *progress, Error *error) {
    Scene *scenes[] = {small_scene()};
    training.scenes = scenes;
    training.scene_count = 1;
    return gns_training_run(&training, net, progress, error);
}

TEST(same_bits_for_any_threads) {
    OWN(GnsNet) one, three;
    const int threads = omp_get_max_threads();
    omp_set_num_threads(1);
    assert_ok(train(small(), &one, NULL, &error), error);
    omp_set_num_threads(3);
    assert_ok(train(small(), &three, NULL, &error), error);
    omp_set_num_threads(threads);
    assert_memory_equal(&one.scales, &three.scales, sizeof one.scales);
    assert_memory_equal(one.parameters, three.parameters, (size_t)one.layout.parameters * sizeof(float));
}

/* Boxes that are moved by noise are other examples: other weights. */
TEST(noise_is_trained_on) {
    OWN(GnsNet) some, none;
    GnsTraining training = small();
    training.steps = 3;
    assert_ok(train(training, &some, NULL, &error), error);
    training.noise = 0;
    assert_ok(train(training, &none, NULL, &error), error);
    assert_memory_not_equal(some.parameters, none.parameters, (size_t)some.layout.parameters * sizeof(float));
}

/* As many batches are scored as are trained on here, by weights that do not move: of the same examples both errors
   would be one. */
TEST(held_out_examples_are_others) {
    OWN(GnsNet) net;
    GnsTraining training = small();
    training.steps = 64;
    training.rate = 1e-12;
    assert_ok(train(training, &net, NULL, &error), error);
    assert_int_equal(scored.steps, 64);
    assert_true(fabs(scored.held_out / scored.loss - 1) > 1e-3);
}

/* After its two launches and an epoch. */
TEST(a_stopped_training_keeps_its_net) {
    OWN(GnsNet) whole, part;
    int left = 4;
    assert_ok(train(small(), &whole, NULL, &error), error);
    assert_ok(train(small(), &part, &(Progress){stop_at, &left}, &error), error);
    assert_memory_not_equal(whole.parameters, part.parameters, (size_t)part.layout.parameters * sizeof(float));
    left = 1;
    gns_net_free(&part);
    assert_false(train(small(), &part, &(Progress){stop_at, &left}, &error));
    assert_error(error, ERROR_INTERRUPTED, "launches: error: stopped after");
}

typedef struct Recorded {
    GnsExamples examples;
    GnsExample example;
} Recorded;

static void record(Recorded *recorded, float noise) {
    Error error = {0};
    *recorded = (Recorded){.examples = {.noise = noise, .seed = 8}};
    const Method method = method_named("engine");
    assert_ok(gns_examples_add(&recorded->examples, small_scene(), &method, 2, NULL, &error), error);
}

static void release(Recorded *recorded) {
    gns_examples_free(&recorded->examples);
    gns_example_free(&recorded->example);
}

/* A velocity plus its target acceleration and gravity is the true next velocity less a tenth of what the noise moved
   the particle by, per step. */
TEST(targets_lead_to_the_true_velocity) {
    static Recorded clean, noisy;
    record(&clean, 0);
    record(&noisy, 0.2f);
    double noise = 0;
    int count = 0;
    for (uint64_t number = 0; number < 200; number++) {
        assert_true(gns_example_make(&clean.example, &clean.examples, number));
        assert_true(gns_example_make(&noisy.example, &noisy.examples, number));
        const Scene *scene = clean.example.from->scene;
        assert_int_equal(clean.example.particles.bodies, noisy.example.particles.bodies);
        for (int i = 0; i < gns_particle_count(&clean.example.particles); i++) {
            const Vec2 before = clean.example.particles.velocity[i][GNS_HISTORY - 1];
            const Vec2 other = noisy.example.particles.velocity[i][GNS_HISTORY - 1];
            const float *target = clean.example.targets + (ptrdiff_t)i * GNS_OUTPUTS;
            const float *corrected = noisy.example.targets + (ptrdiff_t)i * GNS_OUTPUTS;
            const Vec2 moved = vec2_sub(noisy.example.particles.position[i], clean.example.particles.position[i]);
            const double part = 0.1 / (double)scene->dt;
            assert_near(before.x + scene->dt * target[0],
                        (double)(other.x + scene->dt * corrected[0]) + part * (double)moved.x, 1e-4);
            assert_near(before.y + scene->dt * target[1],
                        (double)(other.y + scene->dt * corrected[1]) + part * (double)moved.y, 1e-4);
            noise += (double)((other.x - before.x) * (other.x - before.x));
            count++;
        }
    }
    assert_near(sqrt(noise / count), 0.2, 0.01);
    release(&clean);
    release(&noisy);
}

/* In free flight the target of a box's centre is 0, from the first step on: before it exists, a body flies with its
   start velocity. */
TEST(free_flight_has_no_target) {
    static Recorded clean;
    record(&clean, 0);
    int flights = 0;
    for (uint64_t number = 0; number < 100; number++) {
        assert_true(gns_example_make(&clean.example, &clean.examples, number));
        for (int i = 0; i < clean.example.particles.bodies; i++) {
            if (clean.example.particles.position[i * BOX_PARTICLES].y < 3) continue;
            const float *target =
                clean.example.targets + (ptrdiff_t)(i * BOX_PARTICLES + BOX_PARTICLES / 2) * GNS_OUTPUTS;
            assert_near(hypot((double)target[0], (double)target[1]), 0, 0.05); /* positions are float32 */
            flights++;
        }
    }
    assert_true(flights > 5);
    release(&clean);
}

RUN_TESTS(NULL, NULL)

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The reference converges in every step of the scenes: struck, falling and at rest. */
#include "made.h"
#include "sanitized.h"

#include "methods/reference.h"

typedef struct Steps {
    Reference reference;
    int solved, by_interior_points;
} Steps;

static bool converge(void *context, int frame, const World *world, Error *error) {
    Steps *steps = context;
    if (!reference_solve(&steps->reference, world_problem(world), NULL, error)) return false;
    if (!(steps->reference.residual <= REFERENCE_TOLERANCE))
        fail_msg("step %d: residual %g after %d attempts", frame, steps->reference.residual, steps->reference.attempts);
    steps->solved++;
    steps->by_interior_points += steps->reference.attempts > 0;
    return true;
}

static void run_scene(const char *name, const char *method_name, float bomb_x, Steps *steps) {
    Error error = {0};
    OWN(Scene) *scene = scene_named(name);
    scene->bomb.x.value = bomb_x;
    if (scene->frames > 260) scene->frames = 260;
    Method method = method_named(method_name);
    assert_ok(simulate_observed(scene, &method, &(StepObserver){converge, steps}, &error), error);
}

static void every_step_converges(const char *method) {
    static const float places[] = {-5, -2.65f, -0.825f, -0.3f, 2.05f, 2.675f, 4.4f};
    Steps steps = {0};
    for (size_t k = 0; k < sizeof places / sizeof *places; k += (size_t)sampled(3)) {
        run_scene("stack", method, places[k], &steps);
        run_scene("pyramid_settled", method, places[k], &steps);
    }
    assert_true(steps.by_interior_points > 100);
    assert_true(steps.solved - steps.by_interior_points > 500);
    reference_free(&steps.reference);
}

TEST(every_step_of_the_engine_converges) { every_step_converges("engine"); }

TEST(every_step_in_closed_loop_converges) { every_step_converges("reference"); }

RUN_TESTS(NULL, NULL)

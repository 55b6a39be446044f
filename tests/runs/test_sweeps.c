/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The fast sweeps have the bits of the plain text, frame by frame of the scenes. */
#include "made.h"
#include "sanitized.h"

#include "methods/kernels.h"
#include "methods/reference_kernels.h"

typedef struct KernelChoice {
    Sweeps engine[SWEEP_KERNELS], momentum[SWEEP_KERNELS];
    ReferenceKernels reference;
} KernelChoice;

static bool agree(void *context, int frame, const World *world, Error *error) {
    (void)error;
    const ContactProblem *problem = world_problem(world);
    static const float factors[19] = {0,    0.2f, 0.4f, 0.5f, 0.6f, 0.7f, 0.8f, 0.8f, 0.8f, 0.9f,
                                      0.9f, 0.9f, 0.9f, 0,    0.9f, 0.9f, 0.9f, 0.9f, 0.9f};
    KernelChoice *kernels = context;
    assert_kernels_agree(kernels->engine, problem, &engine_options, 10);
    assert_momentum_kernels_agree(kernels->momentum, problem, true, factors, 19);
    if (frame % 8 == 0) assert_reference_kernels_agree(&kernels->reference, problem);
    return true;
}

static void run_scene(const char *name, float bomb_x) {
    Error error = {0};
    OWN(Scene) *scene = scene_named(name);
    scene->bomb.x.value = bomb_x;
    Method method = method_named("engine");
    KernelChoice kernels = {.reference = {.plain = {.scalar = true}}};
    assert_ok(simulate_observed(scene, &method, &(StepObserver){agree, &kernels}, &error), error);
    free_kernels(kernels.engine);
    free_kernels(kernels.momentum);
    reference_kernels_free(&kernels.reference);
}

TEST(every_frame_has_the_bits_of_the_plain_text) {
    const char *const names[] = {"single", "stack", "pyramid", "pyramid_settled"};
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 5; k += sampled(3)) run_scene(names[i], -5 + 2.35f * (float)k);
}

RUN_TESTS(NULL, NULL)

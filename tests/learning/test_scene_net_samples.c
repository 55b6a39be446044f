/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Samples: copies, labels of the reference, inputs of a network. */
#include "impacts.h"
#include "owned.h"

#include <omp.h>

enum { LAUNCHES = 4 };

TEST(a_sample_is_a_copy) {
    ProblemBody bodies[2] = {{.inv_mass = 1}, {.inv_mass = 2}};
    ContactPoint contact = {.a = 0, .b = 1, .feature = 5};
    const ContactProblem problem = {
        .body_count = 2, .contact_count = 1, .bomb = 1, .bodies = bodies, .contacts = &contact};
    OWN(SceneNetSamples) samples = {0}, more = {0};
    for (int i = 0; i < 20; i++) assert_true(scene_net_samples_add(&samples, &problem, i, 2 * i));
    bodies[1].inv_mass = 9;
    contact.feature = 9;
    for (int i = 20; i < 22; i++) assert_true(scene_net_samples_add(&more, &problem, i, 2 * i));
    assert_true(scene_net_samples_move(&samples, &more));
    assert_int_equal(more.count, 0);
    assert_true(scene_net_samples_move(&samples, &more));
    assert_int_equal(samples.count, 22);
    for (int i = 0; i < 22; i++) {
        const SceneNetSample *sample = &samples.items[i];
        assert_int_equal(sample->launch, i);
        assert_int_equal(sample->since, 2 * i);
        assert_int_equal(sample->problem.contacts[0].feature, i < 20 ? 5 : 9);
        assert_true(sample->problem.bodies[1].inv_mass == (i < 20 ? 2 : 9));
    }
}

/* A launch without impacts has no samples; an impact may have no contacts. */
TEST(empty_samples_can_be_moved) {
    OWN(SceneNetSamples) samples = {0}, none = {0};
    const ProblemBody body = {.inv_mass = 1};
    assert_true(scene_net_samples_move(&samples, &none));
    assert_int_equal(samples.count, 0);
    assert_true(scene_net_samples_add(&samples, &(ContactProblem){.body_count = 1, .bodies = &body}, 0, 0));
    assert_int_equal(samples.items[0].problem.contact_count, 0);
}

TEST(labels_are_the_references) {
    const int threads = omp_get_max_threads();
    OWN(Reference) reference = {0};
    for (int t = 1; t <= 2; t++) {
        omp_set_num_threads(t);
        OWN(SceneNetSamples) samples = labelled_impacts(LAUNCHES);
        for (int i = 0; i < samples.count; i++) {
            const SceneNetSample *sample = &samples.items[i];
            const ContactProblem *problem = &sample->problem;
            assert_ok(reference_solve(&reference, problem, NULL, &error), error);
            assert_memory_equal(sample->reference, reference.velocities,
                                (size_t)problem->body_count * sizeof *sample->reference);
            for (int k = 0; k < problem->contact_count; k++) {
                assert_true(sample->goal[k].normal == (float)reference.impulses[k].normal);
                assert_true(sample->goal[k].tangent == (float)reference.impulses[k].tangent);
            }
            assert_int_equal(sample->unrolled.contact_count, problem->contact_count);
        }
    }
    omp_set_num_threads(threads);
}

static bool stop(void *context, double done, double total) {
    (void)context, (void)done, (void)total;
    return false;
}

TEST(only_samples_from_the_given_index_are_labelled) {
    SceneNetSamples samples = {0};
    record_impacts(&samples, LAUNCHES, 0);
    const int half = samples.count / 2;
    const Progress stopping = {stop, NULL};
    assert_ok(scene_net_samples_label(&samples, half, NULL, &error), error);
    for (int i = 0; i < samples.count; i++) assert_int_equal(samples.items[i].goal != NULL, i >= half);
    scene_net_samples_free(&samples);
    record_impacts(&samples, LAUNCHES, 0);
    assert_false(scene_net_samples_label(&samples, 0, &stopping, &error));
    assert_error(error, ERROR_INTERRUPTED, "labels: error: stopped after");
    scene_net_samples_free(&samples);
}

typedef struct Wedge {
    SceneNetSamples samples;
    Reference reference;
    int solved;
} Wedge;

static bool keep_step(void *context, int frame, const World *world, Error *error) {
    Wedge *wedge = context;
    const ContactProblem *problem = world_problem(world);
    if (!reference_solve(&wedge->reference, problem, NULL, error)) return false;
    wedge->solved += wedge->reference.residual <= 1e-9;
    return scene_net_samples_add(&wedge->samples, problem, frame, 0);
}

/* A box in a V that its friction holds apart from: steps with a solution and without. */
TEST(samples_without_a_solution_are_left_out_and_counted) {
    Wedge wedge = {.solved = 0};
    OWN(Scene) *scene = scene_from(SOURCE_DIR "/tests/methods/scenes/wedge.yaml");
    const Method engine = method_named("engine");
    assert_ok(simulate_observed(scene, &engine, &(StepObserver){keep_step, &wedge}, &error), error);
    const int all = wedge.samples.count;
    assert_int_equal(all, scene->frames);
    assert_in_range(wedge.solved, 10, all - 10);
    assert_ok(scene_net_samples_label(&wedge.samples, 0, NULL, &error), error);
    assert_int_equal(wedge.samples.count, wedge.solved);
    assert_int_equal(wedge.samples.unconverged, all - wedge.solved);
    for (int i = 0; i < wedge.samples.count; i++) {
        const SceneNetSample *sample = &wedge.samples.items[i];
        assert_ok(reference_solve(&wedge.reference, &sample->problem, NULL, &error), error);
        assert_true(wedge.reference.residual <= 1e-9);
        assert_memory_equal(sample->reference, wedge.reference.velocities,
                            (size_t)sample->problem.body_count * sizeof *sample->reference);
        assert_true(i == 0 || sample->launch > sample[-1].launch);
    }
    OWN(SceneNetSamples) moved = {.unconverged = 2};
    assert_true(scene_net_samples_move(&moved, &wedge.samples));
    assert_int_equal(moved.unconverged, 2 + all - wedge.solved);
    reference_free(&wedge.reference);
}

TEST(inputs_are_those_of_the_network) {
    OWN(SceneNetSamples) shaped = labelled_impacts(LAUNCHES), samples = {0};
    OWN(SceneNet) *network = network_for(&shaped);
    record_impacts(&samples, LAUNCHES, 0);
    assert_int_equal(samples.count, shaped.count);
    assert_ok(scene_net_samples_compute_inputs(&samples, 3, network, &error), error);
    for (int i = 0; i < samples.count; i++) {
        assert_int_equal(samples.items[i].inputs != NULL, i >= 3);
        if (i < 3) continue;
        assert_memory_equal(samples.items[i].inputs, shaped.items[i].inputs,
                            (size_t)scene_net_inputs(network) * sizeof(float));
    }
}

RUN_TESTS(NULL, NULL)

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The initial network: slots, caps and scales against independent counts; the distribution of its inputs and
   outputs. */
#include "impacts.h"
#include "owned.h"

enum { LAUNCHES = 20 };

static SceneNetSamples samples;
static SceneNet *network;

FIXTURE(begin) {
    samples = labelled_impacts(LAUNCHES);
    network = network_for(&samples);
}

FIXTURE(end) {
    scene_net_destroy(network);
    scene_net_samples_free(&samples);
}

static const ContactPoint *contact_in(const SceneNetSample *sample, int a, int b, uint32_t feature) {
    for (int k = 0; k < sample->step.problem.contact_count; k++) {
        const ContactPoint *contact = &sample->step.problem.contacts[k];
        if (contact->a == a && contact->b == b && scene_view_feature(&sample->step.problem, contact) == feature)
            return contact;
    }
    return NULL;
}

static int samples_with(int a, int b, uint32_t feature) {
    int count = 0;
    for (int i = 0; i < samples.count; i++) count += contact_in(&samples.items[i], a, b, feature) != NULL;
    return count;
}

static bool is_below(const Slot *x, const Slot *y) {
    if (x->a != y->a) return x->a < y->a;
    return x->b != y->b ? x->b < y->b : x->feature < y->feature;
}

TEST(slots_are_contacts_of_at_least_three_samples) {
    int left_out = 0, known = 0;
    for (int i = 0; i < samples.count; i++)
        for (int k = 0; k < samples.items[i].step.problem.contact_count; k++) {
            const ContactPoint *contact = &samples.items[i].step.problem.contacts[k];
            const uint32_t feature = scene_view_feature(&samples.items[i].step.problem, contact);
            const bool slot = scene_net_find(network, contact->a, contact->b, feature) >= 0;
            assert_int_equal(slot, samples_with(contact->a, contact->b, feature) >= 3);
            left_out += !slot;
            known += slot;
        }
    assert_true(left_out > 0 && known > 100);
    for (int i = 0; i < network->slot_count; i++) {
        const Slot *slot = &network->slots[i];
        assert_true(i == 0 || is_below(slot - 1, slot));
        assert_true(samples_with(slot->a, slot->b, slot->feature) >= 3);
    }
    assert_int_equal(network->body_count, samples.items[0].step.problem.body_count);
    assert_int_equal(network->bomb, samples.items[0].step.problem.bomb);
}

TEST(caps_are_the_largest_warm_impulses_at_the_touch) {
    int capped = 0, larger_later = 0;
    for (int i = 0; i < network->slot_count; i++) {
        const Slot *slot = &network->slots[i];
        float before = 0, ever = 0;
        for (int k = 0; k < samples.count; k++) {
            const ContactPoint *contact = contact_in(&samples.items[k], slot->a, slot->b, slot->feature);
            if (contact == NULL) continue;
            ever = fmaxf(ever, contact->warm_normal);
            if (samples.items[k].step.since == 0) before = fmaxf(before, contact->warm_normal);
        }
        assert_true(network->cap[i] == before);
        capped += before > 0;
        larger_later += ever > before;
    }
    assert_true(capped > 5 && larger_later > 5);
}

/* mean(sqrt(|goal - base|))^2 + 0.05 N s. */
TEST(scales_are_how_far_the_goal_is) {
    for (int i = 0; i < network->slot_count; i++) {
        const Slot *slot = &network->slots[i];
        double sum = 0;
        int count = 0;
        for (int k = 0; k < samples.count; k++) {
            const SceneNetSample *sample = &samples.items[k];
            const ContactPoint *contact = contact_in(sample, slot->a, slot->b, slot->feature);
            if (contact == NULL) continue;
            const long at = contact - sample->step.problem.contacts;
            sum += sqrt(hypot((double)(sample->step.impulses[at].normal - sample->view.base[at].normal),
                              (double)(sample->step.impulses[at].tangent - sample->view.base[at].tangent)));
            count++;
        }
        const double expected = sum / count * (sum / count) + 0.05;
        assert_near(network->scale[i], expected, 1e-6 * expected);
    }
}

/* Components of each projection are white up to the rounding of its packed rows; those beyond its rank are 0. */
TEST(inputs_have_mean_0_and_variance_1_or_0) {
    int moving = 0;
    for (int c = 0; c < scene_net_inputs(network); c++) {
        double sum = 0, squares = 0;
        for (int i = 0; i < samples.count; i++) {
            const double x = (double)samples.items[i].inputs[c];
            sum += x;
            squares += x * x;
        }
        const double mean = sum / samples.count, variance = squares / samples.count - mean * mean;
        assert_near(mean, 0, 1e-4);
        assert_near(variance, variance > 0.5, 0.05);
        moving += variance > 0.5;
        if (c >= SLOT_BODY_NUMBERS && c < ROW_LANES) assert_true(squares == 0);
    }
    assert_true(moving > scene_net_inputs(network) / 2);
}

/* Otherwise the network could not know where the bomb struck. */
TEST(every_launch_has_different_inputs) {
    for (int i = 0; i < samples.count; i++)
        for (int k = 0; k < i; k++)
            assert_memory_not_equal(samples.items[i].inputs, samples.items[k].inputs,
                                    (size_t)scene_net_inputs(network) * sizeof(float));
}

TEST(initial_outputs_are_near_0) {
    float first[SCENE_NET_WIDTH_MAX], second[SCENE_NET_WIDTH_MAX], outputs[200];
    double sum = 0;
    int count = 0;
    for (int i = 0; i < samples.count; i++) {
        const SceneNetView *slots = &samples.items[i].view.slots;
        assert_in_range(slots->slot_count, 1, 100);
        scene_net_predict(network, samples.items[i].inputs, slots, first, second, outputs);
        for (int k = 0; k < 2 * slots->slot_count; k++)
            sum += fabs((double)(outputs[k] / network->scale[slots->slots[k / 2]]));
        count += 2 * slots->slot_count;
    }
    assert_true(sum / count > 0.001 && sum / count < 0.2);
}

TEST(samples_without_slots_are_refused) {
    SceneNetSamples few = {0};
    RecordedSteps steps = {0};
    OWN(Reference) reference = {0};
    const LaunchStep step = {.problem = &samples.items[0].step.problem, .steps = &steps, .reference = &reference};
    assert_refused(scene_net_from_samples(&few, &small_widths, 1, &error),
                   "no launch has an impact whose residual reaches the gate");
    error = (Error){0};
    assert_ok(reference_solve(&reference, step.problem, NULL, &error), error);
    for (int i = 0; i < 2; i++) assert_ok(launch_step_record(&step, true, &error), error);
    assert_true(scene_net_samples_take(&few, &steps));
    recorded_steps_free(&steps);
    assert_refused(scene_net_from_samples(&few, &small_widths, 1, &error), "0 slots");
    scene_net_samples_free(&few);
}

RUN_TESTS(begin, end)

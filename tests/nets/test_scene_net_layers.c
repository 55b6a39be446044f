/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "scene_net_layers.h"
#include "owned.h"

enum { BODIES = 5, STATE = SLOT_BODY_NUMBERS * (BODIES - 1), INPUTS = ROW_LANES + 16 + 32 + 48, HIDDEN = 64 };

/* A view with its arrays; of all slots, unless a test changes it. */
typedef struct SeenScene {
    float bomb[SLOT_BODY_NUMBERS], state[STATE], ones[FIVE_SLOTS], warm[2 * FIVE_SLOTS];
    int32_t slots[FIVE_SLOTS], impulses[2 * FIVE_SLOTS];
    SceneNetView view;
} SeenScene;

static void see(SeenScene *scene, int count, const int32_t *slots) {
    for (int i = 0; i < count; i++) {
        scene->slots[i] = slots[i];
        scene->ones[i] = 1;
        for (int k = 0; k < 2; k++) scene->impulses[2 * i + k] = 2 * slots[i] + k;
    }
    scene->view =
        (SceneNetView){scene->bomb, scene->state, count, scene->slots, scene->impulses, scene->ones, scene->warm};
}

static const int32_t all_slots[FIVE_SLOTS] = {0, 1, 2, 3, 4, 5, 6, 7, 8}, few_slots[] = {7, 1, 4};

static void make_scene(SeenScene *scene, uint32_t *seed) {
    fill(scene->bomb, SLOT_BODY_NUMBERS, -1, 1, seed);
    fill(scene->state, STATE, -1, 1, seed);
    fill(scene->warm, 2 * FIVE_SLOTS, 0, 1, seed);
    see(scene, FIVE_SLOTS, all_slots);
}

/* Every pair, in both orders, with every feature that some pair has and some that none has. */
TEST(every_slot_is_found_and_no_other) {
    const uint32_t features[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, UINT32_MAX - 1, UINT32_MAX};
    uint32_t seed = 1;
    OWN(SceneNet) *network = make_scene_net(&five_shape, five_slots, &seed);
    int found = 0;
    for (int a = 0; a < BODIES; a++)
        for (int b = 0; b < BODIES; b++)
            for (size_t f = 0; f < sizeof features / sizeof features[0]; f++) {
                const int slot = scene_net_find(network, a, b, features[f]);
                if (slot < 0) continue;
                assert_true(five_slots[slot].a == a && five_slots[slot].b == b &&
                            five_slots[slot].feature == features[f]);
                found++;
            }
    assert_int_equal(found, FIVE_SLOTS);
}

TEST(a_new_network_is_zero_and_has_its_own_slots) {
    Slot slots[FIVE_SLOTS];
    memcpy(slots, five_slots, sizeof slots);
    OWN(SceneNet) *network = scene_net_create(&five_shape, slots, &error);
    assert_ok(network != NULL, error);
    memset(slots, 0, sizeof slots);
    assert_memory_equal(network->slots, five_slots, sizeof five_slots);
    assert_int_equal(scene_net_inputs(network), INPUTS);
    assert_int_equal(scene_net_hidden(network), HIDDEN);
    assert_int_equal(network->parameter_count,
                     (INPUTS + 1) * HIDDEN + (HIDDEN + 1) * HIDDEN + (HIDDEN + 1) * 2 * FIVE_SLOTS);
    for (size_t p = 0; p < network->parameter_count; p++) assert_true(network->parameters[p] == 0);
    for (int i = 0; i < FIVE_SLOTS; i++) assert_true(network->scale[i] == 0 && network->cap[i] == 0);
    for (int i = 0; i < INPUTS; i++) assert_true(network->low[i] == 0 && network->high[i] == 0);
}

static double packed_number(const PackedRows *packed, int row, int column) {
    return (double)packed->units[row] * (double)packed->numbers[row * packed->width + column];
}

static double *project(const Projection *projection, const int32_t *index, const float *numbers, int count,
                       double *out) {
    for (int c = 0; c < projection->to; c++) {
        out[c] = -(double)projection->centre[c];
        for (int i = 0; i < count; i++)
            out[c] += (double)numbers[i] * packed_number(&projection->packed, index != NULL ? index[i] : i, c);
    }
    return out + projection->to;
}

static void run_layer(const SceneNetLayer *layer, const double *in, double *out) {
    for (int o = 0; o < layer->to; o++) {
        double sum = (double)layer->biases[o];
        for (int i = 0; i < layer->from; i++) sum += packed_number(&layer->packed, i, o) * in[i];
        out[o] = tanh(sum);
    }
}

/* The formula at SceneNet, for every slot of the network. */
static void predict(const SceneNet *network, const SceneNetView *view, double inputs[INPUTS],
                    double outputs[2 * FIVE_SLOTS]) {
    double first[HIDDEN], second[HIDDEN];
    double *next = project(&network->bomb_state, NULL, view->bomb, SLOT_BODY_NUMBERS, inputs);
    next = project(&network->state, NULL, view->state, STATE, next);
    next = project(&network->present, view->slots, view->ones, view->slot_count, next);
    project(&network->warm, view->impulses, view->warm, 2 * view->slot_count, next);
    run_layer(&network->first, inputs, first);
    run_layer(&network->second, first, second);
    for (int i = 0; i < 2 * FIVE_SLOTS; i++) {
        double sum = (double)network->biases[i];
        for (int h = 0; h < HIDDEN; h++) sum += packed_number(&network->packed, i, h) * second[h];
        outputs[i] = (double)network->scale[i / 2] * sum;
    }
}

/* About a hundred additions, each off by at most 2^-24 of a partial sum of a few units. */
static const double rounding = 1e-5;

TEST(a_prediction_is_the_formula) {
    uint32_t seed = 4;
    OWN(SceneNet) *network = make_scene_net(&five_shape, five_slots, &seed);
    for (int test = 0; test < 20; test++) {
        SeenScene scene;
        float inputs[INPUTS], first[HIDDEN], second[HIDDEN], outputs[2 * FIVE_SLOTS];
        double exact_inputs[INPUTS], exact[2 * FIVE_SLOTS];
        make_scene(&scene, &seed);
        if (test % 2 == 1) see(&scene, 3, few_slots);
        scene_net_look(network, &scene.view, inputs);
        scene_net_predict(network, inputs, &scene.view, first, second, outputs);
        predict(network, &scene.view, exact_inputs, exact);
        for (int i = 0; i < INPUTS; i++) assert_near(inputs[i], exact_inputs[i], rounding);
        for (int i = 0; i < 2 * scene.view.slot_count; i++)
            assert_near(outputs[i], exact[2 * scene.slots[i / 2] + i % 2], rounding);
    }
}

/* A step without contacts. */
TEST(no_slots_are_none) {
    SeenScene scene;
    uint32_t seed = 6;
    OWN(SceneNet) *network = make_scene_net(&five_shape, five_slots, &seed);
    float inputs[INPUTS], first[HIDDEN], second[HIDDEN], none = 5;
    make_scene(&scene, &seed);
    see(&scene, 0, NULL);
    scene_net_look(network, &scene.view, inputs);
    for (int c = 0; c < network->present.to; c++)
        assert_true(inputs[ROW_LANES + network->state.to + c] == -network->present.centre[c]);
    scene_net_predict(network, inputs, &scene.view, first, second, &none);
    assert_true(none == 5);
}

static void refuse(SceneNetShape shape, const Slot *slots, const char *text) {
    Error error = {0};
    assert_refused(scene_net_create(&shape, slots, &error), text);
}

TEST(slots_that_do_not_rise_are_refused) {
    const SceneNetShape three = {4, 0, 3, 16, 16, 16, 16};
    refuse(three, (const Slot[]){{1, 1, 0}, {1, 2, 0}, {1, 3, 0}}, "slot 0");
    refuse(three, (const Slot[]){{1, 0, 0}, {1, 2, 0}, {1, 3, 0}}, "slot 0");
    refuse(three, (const Slot[]){{-1, 2, 0}, {1, 2, 0}, {1, 3, 0}}, "slot 0");
    refuse(three, (const Slot[]){{0, 1, 0}, {1, 2, 0}, {1, 4, 0}}, "slot 2");
    refuse(three, (const Slot[]){{0, 3, 0}, {1, 2, 0}, {0, 3, 1}}, "slot 2");
    refuse(three, (const Slot[]){{0, 3, 0}, {0, 2, 1}, {1, 3, 0}}, "slot 1");
    refuse(three, (const Slot[]){{0, 3, 5}, {0, 3, 4}, {1, 3, 0}}, "slot 1");
    refuse(three, (const Slot[]){{0, 3, 5}, {0, 3, 5}, {1, 3, 0}}, "slot 1");
}

RUN_TESTS(NULL, NULL)

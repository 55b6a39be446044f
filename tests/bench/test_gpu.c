/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Networks by the compute shader against those in C, by Mesa's software renderer in each context. Where none has
   compute shaders, the test is skipped. */
#include "testing.h"

#include "gpu/gpu.h"

#include <math.h>

enum { PAIRS = 100000, WORLDS = 1000, GPUS = 2, LINE = GPU_GROUPS * GPU_GROUP + 1 };

static const double tolerance = 1e-5; /* of the output's range */

static Gpu gpus[GPUS];
static int gpu_count;
static float in[2 * LINE], out[2 * LINE], expected[2 * LINE], scratch[1 << 15]; /* of all tests */

/* In [-2, 2], by Knuth's multiplicative hash. */
static float number_of(size_t i) { return (float)((uint32_t)i * 2654435761u >> 8) * 0x1p-22f - 2; }

/* Of an output of some rows, over its range. Where NAN is expected, it does not matter. */
static double difference(const float *actual, const float *wanted, size_t count) {
    double low = INFINITY, high = count > 1 ? -INFINITY : 1, most = 0;
    for (size_t i = 0; i < count; i++) {
        if (isnan(wanted[i])) continue;
        low = fmin(low, wanted[i]);
        high = fmax(high, wanted[i]);
        assert_true(isfinite(actual[i]));
        most = fmax(most, fabs((double)actual[i] - wanted[i]));
    }
    assert_true(high > low && most <= tolerance * (high - low));
    return most / (high - low);
}

/* Destroys the network. */
static void compare_pairs(const Gpu *gpu, const char *name, Network *network, size_t rows) {
    Error error = {0};
    GpuNet net;
    double most = 0;
    assert_ok(network != NULL && gpu_network(&net, gpu, network, false, &error), error);
    assert_true(network_batch_scratch(network) <= sizeof scratch / sizeof *scratch);
    for (size_t i = 0; i < rows * net.inputs; i++)
        in[i] = number_of(i) / network->input.scale[i / rows] + network->input.offset[i / rows];
    network_predict_batch(network, in, scratch, expected, (int)rows);
    assert_ok(gpu_run(&net, in, out, rows, &error), error);
    for (size_t k = 0; k < net.outputs; k++) most = fmax(most, difference(out + k * rows, expected + k * rows, rows));
    print_message("%s: %.2g of the output's range\n", name, most);
    gpu_net_free(&net);
    network_destroy(network);
}

/* Inputs within the range of the training, and some of the network's slots. */
static void compare_scene(const Gpu *gpu, const char *path) {
    static float outputs[2 * SLOTS_MAX];
    static float inputs[4 * SCENE_NET_WIDTH_MAX], first[SCENE_NET_WIDTH_MAX], second[SCENE_NET_WIDTH_MAX];
    static int32_t slots[SLOTS_MAX], impulses[2 * SLOTS_MAX];
    Error error = {0};
    GpuNet net;
    SceneNet *network = scene_net_read(path, &error);
    Network *layers = network != NULL ? gpu_scene_layers(network, &error) : NULL;
    assert_ok(layers != NULL && gpu_network(&net, gpu, layers, false, &error), error);
    for (size_t i = 0; i < WORLDS * net.outputs; i++) expected[i] = NAN;
    for (size_t w = 0; w < WORLDS; w++) {
        SceneNetView view = {.slots = slots, .impulses = impulses};
        for (int s = (int)w % 7; s < network->slot_count; s += 1 + (int)w % 5) slots[view.slot_count++] = s;
        for (int k = 0; k < 2 * view.slot_count; k++) impulses[k] = 2 * slots[k / 2] + k % 2;
        for (size_t i = 0; i < net.inputs; i++)
            inputs[i] = network->low[i] + (number_of(w * 7919 + i) + 2) / 4 * (network->high[i] - network->low[i]);
        scene_net_predict(network, inputs, &view, first, second, outputs);
        for (size_t i = 0; i < net.inputs; i++) in[i * WORLDS + w] = inputs[i];
        for (int k = 0; k < 2 * view.slot_count; k++) expected[(size_t)impulses[k] * WORLDS + w] = outputs[k];
    }
    assert_ok(gpu_run(&net, in, out, WORLDS, &error), error);
    print_message("%s: %.2g of the range\n", network->scene, difference(out, expected, WORLDS * net.outputs));
    gpu_net_free(&net);
    network_destroy(layers);
    scene_net_destroy(network);
}

static const Gpu *use(int i) {
    Error error = {0};
    assert_ok(context_make_current(&gpus[i].context, &error), error);
    return &gpus[i];
}

TEST(shipped_networks_have_the_outputs_of_C) {
    static const char *const names[] = {"pair-net", "pair-net-six", "contact-net"};
    for (int i = 0; i < gpu_count; i++) {
        const Gpu *gpu = use(i);
        for (int n = 0; n < 3; n++) {
            char path[512];
            snprintf(path, sizeof path, SOURCE_DIR "/scenes/networks/%s.npz", names[n]);
            compare_pairs(gpu, names[n], network_read(path, &error), PAIRS);
        }
        compare_scene(gpu, SOURCE_DIR "/scenes/networks/scene-stack.npz");
        compare_scene(gpu, SOURCE_DIR "/scenes/networks/scene-pyramid_settled.npz");
    }
}

/* Any weights, and tanh. */
static Network *made(int layers, int width) {
    Error error = {0};
    int widths[NETWORK_MAX_LAYERS + 1];
    for (int l = 0; l <= layers; l++) widths[l] = width;
    Network *network = network_create(layers, widths, &error);
    assert_ok(network != NULL, error);
    for (int l = 0; l < layers; l++) network->activations[l] = ACTIVATION_TANH;
    for (int i = 0; i < network_parameter_count(network); i++) network->weights[0][i] = number_of((size_t)i) / 8;
    return network;
}

TEST(any_batch_is_right_or_refused) {
    Network *network = made(1, 2);
    for (int i = 0; i < gpu_count; i++) {
        GpuNet net;
        compare_pairs(use(i), "a pair", made(1, 2), 1);
        compare_pairs(use(i), "a pair more than a line of groups", made(1, 2), LINE);
        assert_ok(gpu_network(&net, &gpus[i], network, false, &error) && gpu_run(&net, NULL, NULL, 0, &error), error);
        assert_refused(gpu_run(&net, NULL, NULL, (size_t)gpus[i].buffer_bytes, &error), "a buffer of the device has");
        assert_refused(gpu_run(&net, NULL, NULL, SIZE_MAX, &error), "a buffer of the device has");
        gpu_net_free(&net);
    }
    network_destroy(network);
}

TEST(any_network_is_right_or_refused) {
    static Slot slots[NETWORK_MAX_WIDTH];
    for (uint32_t i = 0; i < NETWORK_MAX_WIDTH; i++) slots[i] = (Slot){0, 1, i};
    SceneNet *scene_net = scene_net_create(&(SceneNetShape){2, 1, NETWORK_MAX_WIDTH, 16, 16, 16, 16}, slots, &error);
    Network *wide = made(1, 1000), *deep = made(5, 128);
    assert_ok(scene_net != NULL, error);
    assert_refused(gpu_scene_layers(scene_net, &error) != NULL, "width 8192 of layer 3; expected 1 to 4096");
    for (int i = 0; i < gpu_count; i++) {
        GpuNet net;
        assert_refused(gpu_network(&net, use(i), wide, false, &error),
                       "takes 65064 turns of loops; the shader takes up to 60000");
        assert_refused(gpu_network(&net, use(i), deep, false, &error), "takes 74432 turns");
        compare_pairs(use(i), "three layers of 128", made(3, 128), GPU_GROUP + 1);
    }
    network_destroy(wide), network_destroy(deep);
    scene_net_destroy(scene_net);
}

int main(void) {
    for (int i = 0; context_kinds[i] != NULL; i++) {
        Error error = {0};
        Context context;
        if (context_create(&context, context_kinds[i]->choice, &error))
            gpu_count += gpu_open(&gpus[gpu_count], context, &error);
    }
    if (gpu_count == 0) return 77;
    const int failed = _cmocka_run_group_tests("tests", tests_of_file, test_count, NULL, NULL);
    for (int i = 0; i < gpu_count; i++) gpu_close(&gpus[i]);
    return failed;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "made.h"

#include "files.h"

#include "figures/figures_internal.h"
#include "figures/run_figure.h"

#include <math.h>
#include <stdlib.h>

#define NETWORKS SOURCE_DIR "/scenes/networks/"

static FigureSpec spec_for(const char *path) {
    return (FigureSpec){.width = FIGURE_PAGE_WIDTH, .points = FIGURE_POINTS, .dpi = 100, .network = path};
}

/* 3-2-1: weights 1 to 6 of alternating signs, then 4 and -8. */
static const char *write_small(const char *inputs) {
    Error error = {0};
    Network *network = network_sized(2, (const int[]){3, 2, 1});
    for (int i = 0; i < 6; i++) network->weights[0][i] = (float)(i + 1) * (i % 2 == 0 ? 1.0f : -1.0f);
    network->weights[1][0] = 4, network->weights[1][1] = -8;
    network->activations[0] = ACTIVATION_TANH;
    network->activations[1] = ACTIVATION_LINEAR;
    snprintf(network->inputs, sizeof network->inputs, "%s", inputs);
    snprintf(network->outputs, sizeof network->outputs, "%s", "dv");
    const char *path = temporary_path("small.npz");
    assert_ok(network_write(network, path, &error), error);
    network_destroy(network);
    return path;
}

TEST(every_weight_is_a_line_the_strongest_last) {
    const FigureSpec spec = spec_for(write_small("dx dy spin"));
    Sketch sketch;
    draw_kind(&sketch, "network", &spec);
    static const double rising[] = {1, -2, 3, -4, 4, 5, -6, -8};
    int lines = 0, dots = 0;
    for (size_t i = 0; i < sketch.mark_count; i++) {
        const SketchMark *mark = &sketch.marks[i];
        dots += mark->kind == MARK_PATH && mark->closed;
        if (mark->kind != MARK_PATH || mark->closed || lines == 8) continue;
        double share = rising[lines++] / 8;
        assert_near(mark->pen.width, 0.5 + 4 * fabs(share), 1e-9);
        /* Of two equal weights, the first layer's comes first. */
        assert_int_equal(mark->pen.line, weight_colour(share));
    }
    assert_int_equal(lines, 8);
    assert_int_equal(dots, 6);
    assert_int_equal(count_texts(&sketch, "small.npz: 3-2-1, 11 parameters"), 1);
    static const char *const words[] = {"3 inputs", "2 units", "1 output", "tanh", "linear",
                                        "dx",       "dy",      "spin",     "dv",   "weight 8.00"};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (count_texts(&sketch, words[i]) != 1) fail_msg("'%s' is not there once", words[i]);
    sketch_free(&sketch);
}

TEST(inputs_without_names_have_numbers) {
    const FigureSpec spec = spec_for(write_small("dx dy"));
    Sketch sketch;
    draw_kind(&sketch, "network", &spec);
    assert_int_equal(count_texts(&sketch, "dx"), 0);
    assert_int_equal(count_texts(&sketch, "3"), 1);
    sketch_free(&sketch);
}

/* White, blue and orange; equal magnitudes have similar grey levels, which darken with the weight. In grey, above 0
   is darker than below. */
static double grey(uint32_t colour) {
    return 0.299 * (colour >> 16 & 255) + 0.587 * (colour >> 8 & 255) + 0.114 * (colour & 255);
}

TEST(colours_tell_sign_and_size) {
    assert_int_equal(weight_colour(0), 0xFFFFFF);
    assert_int_equal(weight_colour(1), 0x004C80);
    assert_int_equal(weight_colour(-1), 0xE69F00);
    assert_int_equal(weight_colour(3), 0x004C80);
    for (double share = 0.1; share <= 1; share += 0.1) {
        assert_true(grey(weight_colour(share)) < grey(weight_colour(share - 0.1)));
        assert_true(grey(weight_colour(-share)) < grey(weight_colour(0.1 - share)));
        assert_true(grey(weight_colour(share)) < grey(weight_colour(-share)));
    }
}

TEST(wide_layers_are_matrices) {
    Network *network = network_sized(1, (const int[]){50, 2});
    network->weights[0][0] = 2, network->weights[0][50 + 49] = -1;
    const char *path = temporary_path("wide.npz");
    assert_ok(network_write(network, path, &error), error);
    network_destroy(network);
    const FigureSpec spec = spec_for(path);
    Sketch sketch;
    draw_kind(&sketch, "network", &spec);
    assert_int_equal(count_marks(&sketch, MARK_IMAGE), 1);
    assert_int_equal(count_texts(&sketch, "50 to 2, max |w| 2"), 1);
    const Image *image = nth_mark(&sketch, MARK_IMAGE, 0)->image;
    const uint8_t first[] = {0x00, 0x4C, 0x80, 255}, last[] = {0xF2, 0xCF, 0x80, 255}, none[] = {255, 255, 255, 255};
    const size_t row = 4 * (size_t)image->width;
    const uint8_t *end = image->pixels + row * (size_t)image->height;
    assert_memory_equal(image->pixels, first, 4);
    assert_memory_equal(end - 4, last, 4); /* half of the largest */
    assert_memory_equal(end - row, none, 4);
    assert_memory_equal(image->pixels + row - 4, none, 4);
    sketch_free(&sketch);
}

/* 37 weights share a pixel: the largest is shown, which is the first, not the last. */
TEST(of_weights_in_a_pixel_the_largest_shows) {
    Network *network = network_sized(1, (const int[]){4096, 1});
    for (int i = 0; i < 4096; i++) network->weights[0][i] = 0.25f;
    network->weights[0][0] = -1;
    const char *path = temporary_path("wide.npz");
    assert_ok(network_write(network, path, &error), error);
    network_destroy(network);
    FigureSpec spec = spec_for(path);
    spec.dpi = 50;
    Sketch sketch;
    draw_kind(&sketch, "network", &spec);
    const Image *image = nth_mark(&sketch, MARK_IMAGE, 0)->image;
    const uint8_t first[] = {0xE6, 0x9F, 0x00, 255};
    assert_in_range(image->width, 60, 120);
    assert_memory_equal(image->pixels, first, 4);
    sketch_free(&sketch);
}

TEST(the_networks_that_ship_are_shown) {
    static const struct {
        const char *path, *title;
        int pictures;
    } networks[] = {
        {NETWORKS "pair-net.npz", "pair-net.npz: 10-10-2, 132 parameters", 0},
        {NETWORKS "contact-net.npz", "contact-net.npz: 32-24-12-4, 1144 parameters", 0},
        {NETWORKS "scene-stack.npz", "scene-stack.npz: 12 bodies, 315 contacts, 24438 parameters", 7},
    };
    for (int i = 0; i < 3; i++)
        for (int column = 0; column < 2; column++) {
            FigureSpec spec = spec_for(networks[i].path);
            Sketch sketch;
            if (column) spec.width = FIGURE_COLUMN_WIDTH;
            draw_kind(&sketch, "network", &spec);
            assert_int_equal(count_marks(&sketch, MARK_IMAGE), networks[i].pictures);
            if (!column) assert_int_equal(count_texts(&sketch, networks[i].title), 1);
            sketch_free(&sketch);
        }
}

TEST(damaged_files_are_refused) {
    size_t size;
    char *whole = read_whole(NETWORKS "pair-net.npz", &size);
    const char *path = temporary_path("cut.npz");
    assert_ok(file_write(path, whole, size / 2, &error), error);
    free(whole);
    FigureSpec spec = spec_for(path);
    expect_kind_refused("network", &spec, "cut.npz: error:");
    spec.network = NETWORKS "sain.npz";
    expect_kind_refused("network", &spec, "sain.npz: error: contains no network with layers");
    spec.network = temporary_path("nowhere.npz");
    expect_kind_refused("network", &spec, "nowhere.npz");
    spec = spec_for(NETWORKS "contact-net.npz");
    spec.width = 40, spec.points = 14;
    expect_kind_refused("network", &spec, "the names of inputs and outputs leave");
}

RUN_TESTS(NULL, NULL)

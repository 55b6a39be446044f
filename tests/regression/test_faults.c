/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The limits that golden/README.md suggests, on charts: seeded faults fail, what renderers do otherwise passes. */
#include "made.h"

#include "figures/sketch.h"
#include "regression/antialias.h"
#include "regression/limits.h"

#include <math.h>

/* Ten pixels per mm: 800 x 600. */
static const SketchOutput output = {254, false, false};
static const double PIXEL = 0.1;

typedef enum Fault { NO_FAULT, LABEL_MISSING, TEXT_SHIFTED, RING_LOST, THIN_LINE_LOST, FAULTS } Fault;

static Image *draw_chart(Fault fault) {
    Sketch sketch;
    Error error = {0};
    Point curve[40];
    const TextStyle style = {8, TEXT_LEFT, 0x1A1A1A, 0, false};
    const Pen thin = pen_line(BOX_COLOUR, 1, NULL), ring = pen_line(NETWORK_COLOUR, 1, NULL),
              axis = pen_line(0, 1, NULL);
    sketch_begin(&sketch, 80, 60);
    sketch_rectangle(&sketch, (Point){10, 10}, (Point){75, 52}, &axis);
    for (int i = 0; i < 40; i++) curve[i] = (Point){11 + 1.6 * i, 30 + 15 * sin(0.2 * i)};
    sketch_path(&sketch, curve, 40, &thin);
    if (fault != THIN_LINE_LOST) sketch_line(&sketch, (Point){12, 15}, (Point){70, 21}, &thin);
    for (int i = 0; i < 40; i += 5)
        if (fault != RING_LOST || i != 20) sketch_dot(&sketch, curve[i], 1, &ring);
    if (fault != LABEL_MISSING) sketch_text(&sketch, (Point){50, 40}, &style, "k=100");
    sketch_text(&sketch, (Point){20 + (fault == TEXT_SHIFTED ? PIXEL : 0), 3}, &style, "Solver time per step");
    const char *path = temporary_path("chart.png");
    assert_ok(sketch_write(&sketch, path, &output, &error), error);
    sketch_free(&sketch);
    return image_of(path);
}

/* Every channel off by at most `most`: another renderer rounds otherwise, or dithers. */
static void add_noise(Image *image, int most) {
    uint32_t state = 1;
    for (size_t i = 0; i < 4 * (size_t)image->width * (size_t)image->height; i++) {
        state = state * 1664525 + 1013904223;
        const int value = image->pixels[i] + (int)((state >> 16) % (2 * (unsigned)most + 1)) - most;
        if (i % 4 != 3) image->pixels[i] = (uint8_t)(value < 0 ? 0 : value > 255 ? 255 : value);
    }
}

static bool passes(const Image *a, const Image *b, const Tolerance *tolerance) {
    uint8_t *masked = calloc((size_t)a->width * (size_t)a->height, 1);
    ImageDifference difference;
    Error error = {0};
    assert_non_null(masked);
    assert_ok(!tolerance->antialias || antialias_mark(a, b, masked, &error), error);
    image_compare_masked(a, b, masked, tolerance->tolerance, &difference);
    free(masked);
    return tolerance_holds(tolerance, &difference);
}

enum { NOISES = 3, SUGGESTED = 2 };

static const Tolerance suggested[SUGGESTED] = {
    {.given = LIMIT_TOLERANCE, .tolerance = 3},
    {.given = LIMIT_TOLERANCE | LIMIT_ANTIALIAS, .tolerance = 3, .antialias = true},
};

TEST(suggested_limits_catch_faults_and_pass_noise) {
    Image *chart = draw_chart(NO_FAULT);
    for (int i = 0; i < SUGGESTED; i++) {
        for (Fault fault = NO_FAULT; fault < FAULTS; fault++) {
            Image *other = draw_chart(fault);
            if (passes(chart, other, &suggested[i]) != (fault == NO_FAULT)) fail_msg("limit %d, fault %d", i, fault);
            image_destroy(other);
        }
        for (int most = 1; most <= NOISES; most++) {
            Image *other = draw_chart(NO_FAULT);
            add_noise(other, most);
            if (!passes(chart, other, &suggested[i])) fail_msg("limit %d, noise of %d", i, most);
            image_destroy(other);
        }
    }
    image_destroy(chart);
}

RUN_TESTS(NULL, NULL)

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bodies on a transparent background: alpha, and which bodies are drawn. */
#include "made.h"

#include "pictures/mesa.h"
#include "pictures/runs.h"
#include "pictures/render.h"

enum { SIDE = 200 };

/* 20 pixels per metre; the ground's top is row 160. */
static const Camera camera = {20, 100, 160};

static Image *shoot(const Trajectory *run, int frame, uint32_t fill, StillParts parts) {
    Error error = {0};
    Still *still = still_create(SIDE, SIDE, &error);
    Image *image = image_sized(SIDE, SIDE);
    const StillShot shot = {run, frame, {fill, fill, fill}, parts, camera, LOOK_NO_LABELS, 0};
    assert_ok(still != NULL && still_draw(still, &shot, image, &error), error);
    still_destroy(still);
    return image;
}

static void expect_pixel(const Image *image, int x, int y, unsigned rgba) {
    const uint8_t *p = image->pixels + 4 * (y * SIDE + x);
    unsigned found = (unsigned)p[0] << 24 | (unsigned)p[1] << 16 | (unsigned)p[2] << 8 | p[3];
    if (found != rgba) fail_msg("pixel (%d, %d) is %08x, not %08x", x, y, found, rgba);
}

TEST(bodies_stand_on_nothing) {
    OWN(Trajectory) *run = run_make("engine", 3);
    Image *image = shoot(run, 0, 0x0072B2, STILL_ALL);
    expect_pixel(image, 60, 150, 0x0072B2FF);  /* the middle of the first box */
    expect_pixel(image, 100, 150, 0x00000000); /* between the boxes */
    expect_pixel(image, 100, 180, 0xD3D8DFFF); /* the ground */
    expect_pixel(image, 120, 48, 0x00000000);  /* the bomb appears later */
    image_destroy(image);
    image = shoot(run, 0, 0xE69F00, STILL_MOVING);
    expect_pixel(image, 60, 150, 0xE69F00FF);
    expect_pixel(image, 100, 180, 0x00000000);
    image_destroy(image);
    image = shoot(run, 2, 0x0072B2, STILL_FIXED);
    expect_pixel(image, 60, 150, 0x00000000);
    expect_pixel(image, 100, 180, 0xD3D8DFFF);
    image_destroy(image);
}

/* Alpha sums to the boxes' areas (corners are round): an edge within a pixel counts in part. */
TEST(alpha_is_coverage) {
    OWN(Trajectory) *run = run_make("engine", 8);
    OWN(Image) *image = shoot(run, 7, 0x0072B2, STILL_MOVING);
    double sum = 0;
    int partial = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        int alpha = image->pixels[4 * i + 3];
        sum += alpha / 255.0;
        partial += alpha > 0 && alpha < 255;
    }
    const double area = 20 * 20 * (1 + 2 + 1.5 * 1.5);
    assert_true(sum > 0.97 * area && sum < area);
    assert_true(partial > 50);
}

TEST(sizes_are_limited) {
    assert_refused(still_create(RENDER_SIDE_MAX + 1, 10, &error), "(got 8193 x 10)");
    assert_refused(still_create(10, 0, &error), "(got 10 x 0)");
}

RUN_TESTS(NULL, NULL)

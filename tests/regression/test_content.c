/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What happened in pictures of which nothing else is known. Each is drawn from seeds, so the right name is known:
   glyphs of random pixels and discs with exact coverage, on plain, shaded and patterned ground. */
#include "content_changes.h"
#include "made.h"

#include <math.h>

enum { WIDTH = 160, HEIGHT = 120, SEEDS = 50 };

static uint64_t random_state;

static int any_below(int count) {
    random_state = random_state * 6364136223846793005U + 1442695040888963407U;
    return (int)((random_state >> 33) % (uint64_t)count);
}

static Image *ground_of(int kind) {
    Image *image = image_sized(WIDTH, HEIGHT);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            const int level = kind == 0 ? 250 : kind == 1 ? 250 - x / 4 : (x + y) / 8 % 2 == 0 ? 235 : 250;
            memset(image->pixels + 4 * (y * WIDTH + x), level, 3);
            image->pixels[4 * (y * WIDTH + x) + 3] = 255;
        }
    return image;
}

static void cover(Image *image, int x, int y, double share, const uint8_t colour[3]) {
    uint8_t *pixel = image->pixels + 4 * (y * WIDTH + x);
    for (int c = 0; c < 3; c++) pixel[c] = (uint8_t)(pixel[c] + share * (colour[c] - pixel[c]) + 0.5);
}

/* Letters of random pixels, three wide, seven high; the same for the same text. */
static void write_text(Image *image, int left, int top, unsigned text, const uint8_t colour[3]) {
    for (int letter = 0; letter < 6; letter++)
        for (int i = 0; i < 21; i++) {
            const unsigned bits = (text + (unsigned)letter) * 2654435761U, more = bits * 2246822519U;
            if (((bits & more) >> 7 >> i) % 2 != 0) cover(image, left + 4 * letter + i % 3, top + i / 3, 1, colour);
        }
}

/* A disc by the share of each pixel that lies in it, at 16 x 16 points. */
static void draw_disc(Image *image, double x, double y, double radius, const uint8_t colour[3]) {
    enum { POINTS = 16 };
    for (int row = (int)(y - radius) - 1; row <= (int)(y + radius) + 1; row++)
        for (int column = (int)(x - radius) - 1; column <= (int)(x + radius) + 1; column++) {
            int inside = 0;
            for (int i = 0; i < POINTS * POINTS; i++) {
                const double dx = column + (i % POINTS + 0.5) / POINTS - x,
                             dy = row + ((double)(i / POINTS) + 0.5) / POINTS - y;
                inside += dx * dx + dy * dy < radius * radius;
            }
            cover(image, column, row, (double)inside / (POINTS * POINTS), colour);
        }
}

static void fill(Image *image, int left, int top, int right, int bottom, const uint8_t colour[3]) {
    for (int y = top; y < bottom; y++)
        for (int x = left; x < right; x++) cover(image, x, y, 1, colour);
}

static const uint8_t black[3] = {20, 20, 20}, blue[3] = {0, 114, 178}, red[3] = {214, 39, 40};

static ChangeKind kind_of(Image *a, Image *b) {
    const FrameChanges changes = changes_of(a, b);
    assert_true(changes.region_change[0] >= 0);
    return changes.list[changes.region_change[0]].kind;
}

/* Most of 50 have this name, and the others say that they are unsure. */
static void assert_named(ChangeKind wanted, int least, Image *(*draw)(unsigned seed, bool second)) {
    int right = 0;
    for (unsigned seed = 0; seed < SEEDS; seed++) {
        const ChangeKind found = kind_of(draw(seed, false), draw(seed, true));
        right += found == wanted;
        if (found != wanted && found != CHANGE_UNSURE) fail_msg("seed %u: kind %d, not %d", seed, found, wanted);
    }
    if (right < least) fail_msg("%d of %d have the right name", right, SEEDS);
}

static Image *scene_of(unsigned seed) {
    random_state = seed;
    Image *image = ground_of(any_below(3));
    write_text(image, 8, 8, (unsigned)any_below(1000), black);
    draw_disc(image, 130, 20, 8, blue);
    return image;
}

static Image *draw_added(unsigned seed, bool second) {
    Image *image = scene_of(seed);
    const int x = 40 + any_below(60), y = 30 + any_below(60);
    if (second && seed % 2 == 0) write_text(image, x, y, (unsigned)any_below(1000), black);
    if (second && seed % 2 != 0) draw_disc(image, x, y, 4 + any_below(12), red);
    return image;
}

static Image *draw_removed(unsigned seed, bool second) { return draw_added(seed, !second); }

static Image *draw_recoloured(unsigned seed, bool second) {
    Image *image = scene_of(seed);
    const int x = 40 + any_below(60), y = 30 + any_below(60);
    const uint8_t *colour = second ? (seed % 3 == 0 ? red : black) : blue;
    if (seed % 2 == 0) write_text(image, x, y, (unsigned)any_below(1000), colour);
    if (seed % 2 != 0) draw_disc(image, x, y, 4 + any_below(12), colour);
    return image;
}

static Image *draw_replaced(unsigned seed, bool second) {
    Image *image = scene_of(seed);
    const int x = 40 + any_below(60), y = 30 + any_below(60);
    write_text(image, x, y, (unsigned)any_below(1000) + (second ? 5000 : 0), black);
    return image;
}

static Image *draw_noise(unsigned seed, bool second) {
    Image *image = scene_of(seed);
    const int most = 1 + any_below(3), every = 1 + 3 * any_below(2);
    for (int i = 0; second && i < 4 * WIDTH * HEIGHT; i++) {
        const int level = image->pixels[i] + any_below(2 * most + 1) - most;
        if (i % 4 != 3 && any_below(every) == 0)
            image->pixels[i] = (uint8_t)(level < 0 ? 0 : level > 255 ? 255 : level);
    }
    return image;
}

TEST(content_appears) { assert_named(CHANGE_APPEARED, SEEDS - 1, draw_added); }
TEST(content_vanishes) { assert_named(CHANGE_DISAPPEARED, SEEDS - 1, draw_removed); }
TEST(colours_change) { assert_named(CHANGE_COLOUR, SEEDS, draw_recoloured); }
TEST(a_text_is_replaced) { assert_named(CHANGE_REPLACED, SEEDS - 5, draw_replaced); }
TEST(noise_is_no_change) { assert_named(CHANGE_NOISE, SEEDS, draw_noise); }

/* Measured exactly by whole pixels, with and without overlap, and nearly else. */
TEST(content_moves) {
    static const double distances[][2] = {{1, 0}, {0, -1}, {3, 2}, {-7, 4}, {30, 0}, {-33, 20}};
    for (int i = 0; i < 6 * SEEDS; i++) {
        const double *by = distances[i % 6];
        Image *images[2];
        for (int side = 0; side < 2; side++) {
            images[side] = scene_of((unsigned)i);
            const int x = 50 + any_below(30), y = 40 + any_below(30);
            const int right = side == 0 ? 0 : (int)by[0], down = side == 0 ? 0 : (int)by[1];
            if (i % 2 == 0) write_text(images[side], x + right, y + down, (unsigned)any_below(1000), black);
            if (i % 2 != 0) draw_disc(images[side], x + right, y + down, 4 + any_below(8), red);
        }
        const FrameChanges changes = changes_of(images[0], images[1]);
        const Change *change = &changes.list[changes.region_change[0]];
        if (change->kind != CHANGE_MOVED || fabs(change->right - by[0]) > 0.3 || fabs(change->up + by[1]) > 0.3)
            fail_msg("seed %d, (%g, %g): kind %d, (%g, %g)", i, by[0], by[1], change->kind, change->right, -change->up);
    }
}

TEST(content_moves_by_a_part_of_a_pixel) {
    for (int i = 0; i < SEEDS; i++) {
        const double right = 0.05 * (1 + i % 10), down = 0.05 * (i % 7), radius = 4 + i % 9;
        Image *a = ground_of(0), *b = ground_of(0);
        draw_disc(a, 60, 50, radius, i % 2 == 0 ? red : blue);
        draw_disc(b, 60 + right, 50 + down, radius, i % 2 == 0 ? red : blue);
        const FrameChanges changes = changes_of(a, b);
        const Change *change = &changes.list[changes.region_change[0]];
        assert_int_equal(change->kind, CHANGE_MOVED);
        assert_near(change->right, right, 0.05 + 0.3 * right);
        assert_near(change->up, -down, 0.05 + 0.3 * down);
    }
}

/* Another rasterizer moves each thing by its own part of a pixel; a camera moves all by the same. */
TEST(what_moves_apart_is_noise) {
    for (int apart = 0; apart < 2; apart++) {
        Image *images[2] = {ground_of(0), ground_of(0)};
        for (int side = 0; side < 2; side++)
            for (int i = 0; i < 6; i++) {
                const double right = side * (apart ? 0.15 * (i - 2.5) : 0.3),
                             down = side * (apart ? 0.1 * (i % 3) : 0.2);
                draw_disc(images[side], 25 + 50 * (i % 3) + right, 30 + 60 * (double)(i / 3) + down, 9,
                          i % 2 == 0 ? red : blue);
            }
        assert_int_equal(kind_of(images[0], images[1]), apart ? CHANGE_NOISE : CHANGE_MOVED);
    }
}

/* Two edges tell how far a plain box moved. One edge tells nothing: the box may have grown. */
TEST(a_box_moves_or_grows) {
    for (int by = 1; by <= 3; by++) {
        Image *a = ground_of(0), *b = ground_of(0), *grown = ground_of(0);
        fill(a, 30, 30, 90, 80, blue);
        fill(b, 30 + by, 30, 90 + by, 80, blue);
        fill(grown, 30, 30, 90 + by, 80, blue);
        Image *again = ground_of(0);
        fill(again, 30, 30, 90, 80, blue);
        const FrameChanges changes = changes_of(a, b);
        assert_int_equal(changes.list[0].kind, CHANGE_MOVED);
        assert_near(changes.list[0].right, by, 0.01);
        assert_int_equal(kind_of(again, grown), CHANGE_UNSURE);
    }
}

/* In a row of equal boxes, one that vanishes is not one that moved to the next. */
TEST(a_pattern_is_no_movement) {
    static const uint8_t grey[3] = {100, 100, 100};
    Image *images[2] = {ground_of(0), ground_of(0)};
    for (int side = 0; side < 2; side++) {
        fill(images[side], 0, 0, WIDTH, HEIGHT, grey);
        for (int i = 0; i < 7; i++)
            if (side == 0 || i != 3) {
                fill(images[side], 10 + 20 * i, 40, 24 + 20 * i, 54, black);
                fill(images[side], 12 + 20 * i, 42, 22 + 20 * i, 52, red);
            }
    }
    assert_int_equal(kind_of(images[0], images[1]), CHANGE_DISAPPEARED);
}

/* Noise everywhere does not hide what else changed. */
TEST(a_change_in_noise_is_found) {
    for (unsigned seed = 0; seed < SEEDS; seed++) {
        Image *a = draw_noise(seed, false), *b = draw_noise(seed, true);
        draw_disc(b, 80, 70, 9, red);
        const FrameChanges changes = changes_of(a, b);
        const int last = changes.regions.kept - 1;
        assert_true(last >= 1);
        assert_int_equal(changes.list[changes.region_change[0]].kind, CHANGE_APPEARED);
        assert_int_equal(changes.list[changes.region_change[last]].kind, CHANGE_NOISE);
    }
}

/* Another background, or another light: most pixels change, and no ground is left. */
TEST(most_of_a_picture_changes) {
    for (unsigned seed = 0; seed < SEEDS; seed++) {
        Image *a = scene_of(seed), *b = scene_of(seed), *c = scene_of(seed), *d = scene_of(seed + SEEDS);
        for (int i = 0; i < 4 * WIDTH * HEIGHT; i++)
            if (i % 4 != 3) b->pixels[i] = (uint8_t)(b->pixels[i] * 0.8 + 20);
        for (int i = 0; i < WIDTH * HEIGHT; i++)
            for (int k = 0; k < 3; k++) d->pixels[4 * i + k] = (uint8_t)any_below(256);
        assert_int_equal(kind_of(a, b), CHANGE_COLOUR);
        assert_int_equal(kind_of(c, d), CHANGE_UNSURE);
    }
}

RUN_TESTS(NULL, NULL)

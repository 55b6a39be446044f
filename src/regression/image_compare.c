/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The numbers of the comments are those of the header. */
#include "pixels/png.h"
#include "regression/compare.h"
#include "regression/internal.h"

#include <stdlib.h>
#include <string.h>

enum { CHANNELS = 4, REACH = 3, SIDE = 2 * REACH + 1, CENTER = REACH };

/* A pixel's neighbourhood, premultiplied by alpha; beyond the edges of the picture, the pixels at its edges. */
typedef struct Block {
    int at[SIDE][SIDE][CHANNELS];
} Block;

static int inside(int i, int count) { return i < 0 ? 0 : i >= count ? count - 1 : i; }

static void load(const Image *image, int x, int y, int reach, Block *block) {
    for (int dy = -reach; dy <= reach; dy++)
        for (int dx = -reach; dx <= reach; dx++) {
            size_t row = (size_t)inside(y + dy, image->height) * (size_t)image->width;
            const uint8_t *p = image->pixels + 4 * (row + (size_t)inside(x + dx, image->width));
            int *to = block->at[CENTER + dy][CENTER + dx];
            for (int c = 0; c < 3; c++) to[c] = p[3] == 255 ? p[c] : (p[c] * p[3] + 127) / 255;
            to[3] = p[3];
        }
}

/* One channel of a window of 3 x 3 pixels. */
typedef struct Window {
    int middle, least, most, sum;
} Window;

static Window window_of(const Block *block, int channel) {
    Window window = {block->at[CENTER][CENTER][channel], 255, 0, 0};
    for (int y = CENTER - 1; y <= CENTER + 1; y++)
        for (int x = CENTER - 1; x <= CENTER + 1; x++) {
            int value = block->at[y][x][channel];
            if (value < window.least) window.least = value;
            if (value > window.most) window.most = value;
            window.sum += value;
        }
    return window;
}

/* Levels, of 255. Less is the gradient of an area: there, a change by one or two levels looks like a movement. */
enum { LEAST_CONTRAST = 16 };

/* Differences up to this look equal beside a contrast: renderers round, and areas have gradients. */
static int slack(int contrast) { return 2 + contrast / 16; }

static bool is_within(int value, const Window *window, int more) {
    return value >= window->least - more && value <= window->most + more;
}

/* What holds for all channels. */
typedef struct AntialiasChange {
    bool explained;       /* 1 and 2 */
    int slacks[CHANNELS]; /* by channel */
} AntialiasChange;

static AntialiasChange examine(const Block *a, const Block *b) {
    AntialiasChange change = {true, {0}};
    int largest = 0;
    for (int c = 0; c < CHANNELS; c++) {
        Window p = window_of(a, c), q = window_of(b, c);
        int most = p.most > q.most ? p.most : q.most, least = p.least < q.least ? p.least : q.least;
        int contrast = most - least, more = change.slacks[c] = slack(contrast);
        if (contrast > largest) largest = contrast;
        int difference = abs(p.middle - q.middle), sums = abs(p.sum - q.sum);
        bool edge = is_within(p.middle, &q, more) && is_within(q.middle, &p, more);
        bool line = 20 * sums <= 9 * contrast + 60; /* sums / 3 <= 0.15 contrast + 1 */
        change.explained = change.explained && 10 * difference <= 6 * contrast + 10 && (edge || line);
    }
    change.explained = change.explained && largest >= LEAST_CONTRAST;
    return change;
}

static bool look_equal(const int *a, const int *b, const int *more) {
    for (int c = 0; c < CHANNELS; c++)
        if (abs(a[c] - b[c]) > more[c]) return false;
    return true;
}

/* Whether three of the eight neighbours of (x, y) look like it. */
static bool is_flat(const Block *block, int x, int y, const int *more) {
    int equal = -1; /* itself */
    for (int i = y - 1; i <= y + 1; i++)
        for (int j = x - 1; j <= x + 1; j++) equal += look_equal(block->at[i][j], block->at[y][x], more);
    return equal >= 3;
}

/* 3. */
static bool share_side(const Block *a, const Block *b, const int *more) {
    for (int y = 1; y < SIDE - 1; y++)
        for (int x = 1; x < SIDE - 1; x++)
            if (look_equal(a->at[y][x], b->at[y][x], more) && is_flat(a, x, y, more) && is_flat(b, x, y, more))
                return true;
    return false;
}

static bool moved(const Image *expected, const Image *actual, int x, int y) {
    Block a, b;
    load(expected, x, y, 1, &a);
    load(actual, x, y, 1, &b);
    AntialiasChange change = examine(&a, &b);
    if (!change.explained) return false;
    load(expected, x, y, REACH, &a);
    load(actual, x, y, REACH, &b);
    return share_side(&a, &b, change.slacks);
}

void antialias_mark(const Image *expected, const Image *actual, uint8_t *masked) {
    size_t width = (size_t)expected->width;
    for (int y = 0; y < expected->height; y++) {
        const uint8_t *a = expected->pixels + 4 * width * (size_t)y, *b = actual->pixels + 4 * width * (size_t)y;
        uint8_t *row = masked + width * (size_t)y;
        if (memcmp(a, b, 4 * width) == 0) continue;
        for (int x = 0; x < expected->width; x++)
            if (row[x] == IGNORED_NOT && memcmp(a + 4 * x, b + 4 * x, 4) != 0 && moved(expected, actual, x, y))
                row[x] = IGNORED_EDGE;
    }
}

static int deep_difference(const Image *a, const Image *b, size_t i) {
    int deep_a = a->pixels16 != NULL ? a->pixels16[i] : a->pixels[i] * 257;
    int deep_b = b->pixels16 != NULL ? b->pixels16[i] : b->pixels[i] * 257;
    return (abs(deep_a - deep_b) + 256) / 257;
}

int image_pixel_difference(const Image *a, const Image *b, size_t pixel) {
    bool deep = a->pixels16 != NULL || b->pixels16 != NULL;
    int largest = 0;
    for (size_t i = 4 * pixel; i < 4 * pixel + 4; i++) {
        int difference = deep ? deep_difference(a, b, i) : abs(a->pixels[i] - b->pixels[i]);
        if (difference > largest) largest = difference;
    }
    return largest;
}

static void count_pixel(ImageDifference *difference, int x, int y, int here, int tolerance) {
    if (difference->pixels++ == 0) {
        difference->first_x = difference->left = x, difference->right = x + 1;
        difference->first_y = difference->top = y;
    }
    if (here > difference->largest) difference->largest = here;
    difference->beyond += here > tolerance;
    if (x < difference->left) difference->left = x;
    if (x >= difference->right) difference->right = x + 1;
    difference->bottom = y + 1;
}

static bool equal_row(const Image *a, const Image *b, size_t first) {
    if (a == b) return true;
    return a->pixels16 == NULL && b->pixels16 == NULL &&
           memcmp(a->pixels + 4 * first, b->pixels + 4 * first, 4 * (size_t)a->width) == 0;
}

size_t image_next_difference(const Image *a, const Image *b, size_t first, size_t x) {
    enum { PART = 16 };
    const uint8_t *p = a->pixels + 4 * first, *q = b->pixels + 4 * first;
    size_t width = (size_t)a->width;
    if (a->pixels16 != NULL || b->pixels16 != NULL || x >= width || memcmp(p + 4 * x, q + 4 * x, 4) != 0) return x;
    while (x + PART <= width && memcmp(p + 4 * x, q + 4 * x, (size_t)4 * PART) == 0) x += PART;
    while (x < width && memcmp(p + 4 * x, q + 4 * x, 4) == 0) x++;
    return x;
}

static int64_t count_masked(const uint8_t *masked, size_t pixels) {
    int64_t count = 0;
    for (size_t i = 0; masked != NULL && i < pixels; i++) count += masked[i] == IGNORED_MASK;
    return count;
}

void image_compare_masked(const Image *a, const Image *b, const uint8_t *masked, int tolerance,
                          ImageDifference *difference) {
    bool same_size = a->width == b->width && a->height == b->height;
    *difference = (ImageDifference){.same_size = same_size, .first_x = -1, .first_y = -1};
    if (!same_size) return;
    size_t width = (size_t)a->width, all = width * (size_t)a->height;
    difference->counted = (int64_t)all - count_masked(masked, all);
    for (int y = 0; y < a->height; y++) {
        size_t first = (size_t)y * width;
        if (equal_row(a, b, first)) continue;
        for (size_t x = image_next_difference(a, b, first, 0); x < width;
             x = image_next_difference(a, b, first, x + 1)) {
            int here = image_pixel_difference(a, b, first + x);
            Ignored ignored = masked == NULL ? IGNORED_NOT : (Ignored)masked[first + x];
            if (here > 0 && ignored == IGNORED_NOT) count_pixel(difference, (int)x, y, here, tolerance);
            difference->moved += here > 0 && ignored == IGNORED_EDGE;
        }
    }
    difference->equal = difference->pixels == 0;
}

void image_compare(const Image *a, const Image *b, ImageDifference *difference) {
    image_compare_masked(a, b, NULL, 0, difference);
}

static int smaller(int a, int b) { return a < b ? a : b; }

/* Rows are copied in place: the first byte of a row never lies after its new place. */
static void cut(Image *image, int width, int height) {
    size_t from = 4 * (size_t)image->width, to = 4 * (size_t)width;
    for (int y = 0; y < height && width < image->width; y++) {
        memmove(image->pixels + (size_t)y * to, image->pixels + (size_t)y * from, to);
        if (image->pixels16 == NULL) continue;
        memmove(image->pixels16 + (size_t)y * to, image->pixels16 + (size_t)y * from, to * sizeof *image->pixels16);
    }
    image->width = width;
    image->height = height;
}

void image_cut_to_overlap(Image *a, Image *b) {
    int width = smaller(a->width, b->width), height = smaller(a->height, b->height);
    cut(a, width, height);
    cut(b, width, height);
}

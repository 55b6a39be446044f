/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The numbers of the comments are those of the header. */
#include "image/antialias.h"

#include "image/mask.h"

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
typedef struct Change {
    bool explained;       /* 1 and 2 */
    int slacks[CHANNELS]; /* by channel */
} Change;

static Change examine(const Block *a, const Block *b) {
    Change change = {true, {0}};
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
    Change change = examine(&a, &b);
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

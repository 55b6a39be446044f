/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which differing pixels lie along edges: the numbers 1 to 4 are those of the definition in the header. */
#include "regression/antialias.h"

#include "base/base.h"
#include "base/numbers.h"
#include "pixels/png.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CHANNELS = 4, REACH = EDGE_REACH, SIDE = EDGE_ROWS };

/* Four pixels. */
typedef uint8_t Bytes __attribute__((vector_size(16)));
typedef uint32_t Pixels __attribute__((vector_size(16)));
typedef uint16_t Sums __attribute__((vector_size(32)));

static inline Bytes larger_of(Bytes a, Bytes b) {
    Bytes more = (Bytes)(a > b);
    return (a & more) | (b & ~more);
}

static inline Bytes smaller_of(Bytes a, Bytes b) { return a ^ b ^ larger_of(a, b); }

static inline Bytes difference_of(Bytes a, Bytes b) {
    const Bytes most = larger_of(a, b);
    return most - (a ^ b ^ most);
}

static inline Bytes load(const uint8_t *p) {
    Bytes bytes;
    memcpy(&bytes, p, sizeof bytes);
    return bytes;
}

static inline bool any(Pixels pixels) {
    uint64_t halves[2];
    memcpy(halves, &pixels, sizeof halves);
    return (halves[0] | halves[1]) != 0;
}

/* Most pixels are equal, four parts of four at once. */
void image_levels(const uint8_t *a, const uint8_t *b, size_t count, uint8_t *levels) {
    enum { PART = 4, PARTS = 4 };
    size_t x = 0;
    memset(levels, 0, count);
    for (; x + PART * PARTS <= count; x += PART * PARTS) {
        const uint8_t *const p = a + CHANNELS * x, *const q = b + CHANNELS * x;
        const Bytes some = (load(p) ^ load(q)) | (load(p + 16) ^ load(q + 16)),
                    others = (load(p + 32) ^ load(q + 32)) | (load(p + 48) ^ load(q + 48));
        if (!any((Pixels)(some | others))) continue;
        for (size_t part = 0; part < PARTS; part++) {
            const Bytes difference = difference_of(load(p + 16 * part), load(q + 16 * part));
            const Bytes half = larger_of(difference, (Bytes)((Pixels)difference >> 16));
            const Pixels whole = (Pixels)larger_of(half, (Bytes)((Pixels)half >> 8));
            for (size_t i = 0; i < PART; i++) levels[x + PART * part + i] = (uint8_t)whole[i];
        }
    }
    for (; x < count; x++)
        for (size_t i = CHANNELS * x; i < CHANNELS * (x + 1); i++)
            levels[x] = (uint8_t)int_max(levels[x], abs(a[i] - b[i]));
}

bool edge_rows_create(EdgeRows *edges, int width, int height) {
    *edges = (EdgeRows){.width = width, .height = height};
    edges->stride = CHANNELS * ((size_t)width + 2 * REACH) + sizeof(Bytes);
    for (int i = 0; i < SIDE; i++) edges->numbers[i] = -1;
    return (edges->memory = calloc(SIDE, edges->stride)) != NULL;
}

static uint8_t *slot_of(const EdgeRows *edges, int y) { return edges->memory + (size_t)(y % SIDE) * edges->stride; }

uint8_t *edge_rows_place(EdgeRows *edges, int y) {
    edges->numbers[y % SIDE] = -1;
    return slot_of(edges, y) + CHANNELS * REACH;
}

/* Multiplies by alpha, and repeats the pixels at the ends. */
void edge_rows_add(EdgeRows *edges, int y) {
    const size_t width = (size_t)edges->width;
    uint8_t *const first = slot_of(edges, y) + CHANNELS * REACH, *const last = first + CHANNELS * (width - 1);
    Bytes all = {255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255};
    size_t x = 0;
    for (; x + 4 <= width; x += 4) all &= load(first + CHANNELS * x);
    bool opaque = ((Pixels)all >> 24)[0] == 255;
    for (int i = 1; i < 4; i++) opaque = opaque && all[4 * i + 3] == 255;
    for (uint8_t *p = opaque ? first + CHANNELS * x : first; p <= last; p += CHANNELS)
        for (int c = 0; c < 3 && p[3] != 255; c++) p[c] = (uint8_t)((p[c] * p[3] + 127) / 255);
    for (int i = 1; i <= REACH; i++) {
        memcpy(first - CHANNELS * i, first, CHANNELS);
        memcpy(last + CHANNELS * i, last, CHANNELS);
    }
    edges->numbers[y % SIDE] = y;
}

static int inside(int i, int count) { return i < 0 ? 0 : i >= count ? count - 1 : i; }

void edge_rows_load(EdgeRows *edges, const Image *image, int y) {
    const size_t bytes = CHANNELS * (size_t)edges->width;
    for (int i = -REACH; i <= REACH; i++) {
        const int number = inside(y + i, edges->height);
        if (edges->numbers[number % SIDE] == number) continue;
        memcpy(edge_rows_place(edges, number), image->pixels + bytes * (size_t)number, bytes);
        edge_rows_add(edges, number);
    }
}

/* A window of 3 x 3 pixels, by channel. */
typedef struct Window {
    uint8_t middle[16], least[16], most[16];
    uint16_t sum[16];
} Window;

static inline void window_of(const EdgeRows *edges, int x, Window *window) {
    const uint8_t *const *rows = edges->rows + REACH - 1;
    const size_t at = 4 * ((size_t)x + REACH - 1);
    const Bytes a = load(rows[0] + at), b = load(rows[1] + at), c = load(rows[2] + at);
    Bytes least = smaller_of(smaller_of(a, b), c), most = larger_of(larger_of(a, b), c);
    Sums sum = __builtin_convertvector(a, Sums) + __builtin_convertvector(b, Sums) + __builtin_convertvector(c, Sums);
    const Pixels low = (Pixels)least, high = (Pixels)most;
    least = smaller_of(smaller_of(least, (Bytes)__builtin_shufflevector(low, low, 1, 2, 3, 3)),
                       (Bytes)__builtin_shufflevector(low, low, 2, 3, 3, 3));
    most = larger_of(larger_of(most, (Bytes)__builtin_shufflevector(high, high, 1, 2, 3, 3)),
                     (Bytes)__builtin_shufflevector(high, high, 2, 3, 3, 3));
    memcpy(window->middle, rows[1] + at + 4, 4);
    memcpy(window->least, &least, sizeof least);
    memcpy(window->most, &most, sizeof most);
    memcpy(window->sum, &sum, sizeof sum);
    for (int i = 0; i < CHANNELS; i++)
        window->sum[i] = (uint16_t)(window->sum[i] + window->sum[i + 4] + window->sum[i + 8]);
}

/* Levels, of 255. Less is the gradient of an area: there, a change by one or two levels looks like a movement. */
enum { LEAST_CONTRAST = 16 };

static bool is_within(int value, const Window *window, int channel, int more) {
    return value >= window->least[channel] - more && value <= window->most[channel] + more;
}

/* By channel, how much the sums of 5 x 5 pixels differ at least, in windows around the pixel and its eight neighbours;
   0 where one window has more and another less. */
static void least_changes(const EdgeRows *a, const EdgeRows *b, int x, int least[CHANNELS]) {
    int rows[SIDE][3][CHANNELS] = {0};
    for (int i = 0; i < SIDE; i++) {
        const uint8_t *p = a->rows[i] + 4 * (size_t)x, *q = b->rows[i] + 4 * (size_t)x;
        for (int k = 0; k < SIDE * CHANNELS; k++)
            for (int at = 0; at < 3; at++)
                if (k / CHANNELS >= at && k / CHANNELS < at + SIDE - 2) rows[i][at][k % CHANNELS] += p[k] - q[k];
    }
    for (int c = 0; c < CHANNELS; c++) {
        int low = INT32_MAX, high = INT32_MIN;
        for (int window = 0; window < 9; window++) {
            int sum = 0;
            for (int i = 0; i < SIDE - 2; i++) sum += rows[window / 3 + i][window % 3][c];
            if (sum < low) low = sum;
            if (sum > high) high = sum;
        }
        least[c] = low > 0 ? low : high < 0 ? -high : 0;
    }
}

/* Orders colours by a channel; those that are equal in it by all, so that it does not matter which picture has one. */
static bool is_less(const uint8_t *a, const uint8_t *b, int channel) {
    return a[channel] != b[channel] ? a[channel] < b[channel] : memcmp(a, b, CHANNELS) < 0;
}

/* Whether all colours are mixtures of two, but for the rounding of each. */
static bool are_mixtures(const uint8_t *const *colours, int count, double rounding) {
    uint8_t low[CHANNELS], high[CHANNELS];
    memcpy(low, colours[0], CHANNELS);
    memcpy(high, colours[0], CHANNELS);
    for (int i = 1; i < count; i++)
        for (int c = 0; c < CHANNELS; c++) {
            const uint8_t value = colours[i][c];
            low[c] = value < low[c] ? value : low[c];
            high[c] = value > high[c] ? value : high[c];
        }
    int widest = 0;
    for (int c = 1; c < CHANNELS; c++)
        if (high[c] - low[c] > high[widest] - low[widest]) widest = c;
    const uint8_t *one = colours[0], *other = one;
    for (int i = 1; i < count; i++) {
        if (is_less(colours[i], one, widest)) one = colours[i];
        if (is_less(other, colours[i], widest)) other = colours[i];
    }
    const int most = other[widest] - one[widest];
    for (int i = 0; i < count; i++) {
        const int part = colours[i][widest] - one[widest];
        for (int c = 0; c < CHANNELS; c++)
            if (abs((colours[i][c] - one[c]) * most - part * (other[c] - one[c])) > rounding * most) return false;
    }
    return true;
}

/* 4. The colour and the part that its widest channel tells are off by a level each at most; what both pictures show
   lies between ends that each has rounded: half a level more. */
static bool keeps_colours(const EdgeRows *a, const EdgeRows *b, int x) {
    enum { WINDOW = 9, WIDE = 25 };
    const uint8_t *both[2 * WINDOW], *wide[2][WIDE];
    for (int i = 0; i < WIDE; i++) {
        const int row = REACH - 2 + i / 5, at = CHANNELS * (x + REACH - 2 + i % 5);
        wide[0][i] = a->rows[row] + at;
        wide[1][i] = b->rows[row] + at;
    }
    for (int i = 0; i < WINDOW; i++) {
        const int middle = 5 * (1 + i / 3) + 1 + i % 3;
        both[i] = wide[0][middle];
        both[WINDOW + i] = wide[1][middle];
    }
    return are_mixtures(both, 2 * WINDOW, 2.5) || !are_mixtures(both, WINDOW, 2) ||
           !are_mixtures(both + WINDOW, WINDOW, 2) || !are_mixtures(wide[0], WIDE, 2) ||
           !are_mixtures(wide[1], WIDE, 2);
}

static int contrast_of(const Window *p, const Window *q, int c) {
    const int most = p->most[c] > q->most[c] ? p->most[c] : q->most[c],
              least = p->least[c] < q->least[c] ? p->least[c] : q->least[c];
    return most - least;
}

/* 1, for all channels. slacks: by channel, the differences that look equal beside the contrast: renderers round, and
   areas have gradients. */
static bool is_bounded(const Window *p, const Window *q, uint8_t slacks[CHANNELS]) {
    int largest = 0;
    for (int c = 0; c < CHANNELS; c++) {
        const int contrast = contrast_of(p, q, c);
        if (10 * abs(p->middle[c] - q->middle[c]) > 6 * contrast + 10) return false;
        if (contrast > largest) largest = contrast;
        slacks[c] = (uint8_t)(2 + contrast / 16);
    }
    return largest >= LEAST_CONTRAST;
}

/* 2, for all channels. changes: of larger windows, by channel; NULL: not known. */
static bool is_explained(const Window *p, const Window *q, const uint8_t slacks[CHANNELS], const int *changes) {
    for (int c = 0; c < CHANNELS; c++) {
        const int more = slacks[c], sums = abs(p->sum[c] - q->sum[c]);
        const int change = changes != NULL && changes[c] < sums ? changes[c] : sums;
        const bool edge = is_within(p->middle[c], q, c, more) && is_within(q->middle[c], p, c, more);
        const bool line = 20 * change <= 9 * contrast_of(p, q, c) + 60; /* change / 3 <= 0.15 contrast + 1 */
        if (!edge && !line) return false;
    }
    return true;
}

/* All bits of the pixels that look equal. */
static inline Pixels look_equal(Bytes a, Bytes b, Bytes more) {
    return (Pixels)((Pixels)(Bytes)(difference_of(a, b) > more) == 0);
}

/* All bits of those of four pixels, from column x of row i, that three of their eight neighbours look like. */
static inline Pixels are_flat(const EdgeRows *edges, int i, size_t x, Bytes more) {
    const Bytes middle = load(edges->rows[i] + 4 * x);
    Pixels count = {0};
    for (int dy = -1; dy <= 1; dy++)
        for (size_t dx = 0; dx < 3; dx++)
            count -= look_equal(load(edges->rows[i + dy] + 4 * (x + dx - 1)), middle, more);
    return (Pixels)(count > 3); /* with itself */
}

/* 3. */
static inline bool share_side(const EdgeRows *a, const EdgeRows *b, int x, const uint8_t slacks[CHANNELS]) {
    uint32_t of_pixel;
    memcpy(&of_pixel, slacks, sizeof of_pixel);
    const Bytes more = (Bytes)((Pixels){0} + of_pixel);
    for (int i = 1; i < SIDE - 1; i++)
        for (size_t dx = 1; dx <= 2; dx++) { /* five pixels: the first four, and the last four */
            const size_t at = (size_t)x + dx;
            Pixels found = look_equal(load(a->rows[i] + 4 * at), load(b->rows[i] + 4 * at), more);
            if (any(found) && any(found &= are_flat(a, i, at, more)) && any(found & are_flat(b, i, at, more)))
                return true;
        }
    return false;
}

/* Twice the colours of the sides, on average of both pictures: flat ones that they share, within two pixels. False if
   there are not two. */
static bool find_sides(const EdgeRows *a, const EdgeRows *b, int x, const uint8_t slacks[CHANNELS],
                       int sides[2][CHANNELS]) {
    uint32_t of_pixel;
    memcpy(&of_pixel, slacks, sizeof of_pixel);
    const Bytes more = (Bytes)((Pixels){0} + of_pixel);
    int farthest = -1;
    for (int i = 1; i < SIDE - 1; i++)
        for (size_t dx = 1; dx < SIDE - 1; dx++) {
            const size_t at = (size_t)x + dx;
            const uint8_t *p = a->rows[i] + 4 * at, *q = b->rows[i] + 4 * at;
            if (look_equal(load(p), load(q), more)[0] == 0 || are_flat(a, i, at, more)[0] == 0 ||
                are_flat(b, i, at, more)[0] == 0)
                continue;
            int distance = 0, colour[CHANNELS];
            for (int c = 0; c < CHANNELS; c++) {
                colour[c] = p[c] + q[c];
                distance += farthest < 0 ? 0 : abs(colour[c] - sides[0][c]);
            }
            if (farthest < 0) memcpy(sides[0], colour, sizeof colour);
            if (distance > farthest) memcpy(sides[1], colour, sizeof colour);
            farthest = int_max(farthest, distance);
        }
    return farthest >= 2 * LEAST_CONTRAST;
}

/* The same as the second part of 2, for a line whose sides differ: in one of the windows of 5 x 5 pixels around the
   pixel and its neighbours, the sums of b less a are what it takes to move an edge or a line between two sides by half
   a pixel at most: one side's colour gives way to the other's. */
static bool lies_between(const EdgeRows *a, const EdgeRows *b, int x, const Window *p, const Window *q,
                         const uint8_t slacks[CHANNELS]) {
    static const double MOST = 0.5 * 7; /* of the longest edge in a window */
    int sides[2][CHANNELS] = {{0}};
    if (!find_sides(a, b, x, slacks, sides)) return false;
    for (int window = 0; window < 9; window++) {
        int sums[CHANNELS] = {0};
        for (int i = window / 3; i < window / 3 + SIDE - 2; i++)
            for (int k = 0; k < (SIDE - 2) * CHANNELS; k++) {
                const size_t at = 4 * ((size_t)x + (size_t)(window % 3)) + (size_t)k;
                sums[k % CHANNELS] += b->rows[i][at] - a->rows[i][at];
            }
        double steps[CHANNELS], product = 0, square = 0;
        for (int c = 0; c < CHANNELS; c++) {
            steps[c] = (sides[1][c] - sides[0][c]) / 2.0;
            product += sums[c] * steps[c], square += steps[c] * steps[c];
        }
        const double moved = product / square;
        bool fits = fabs(moved) <= MOST;
        for (int c = 0; fits && c < CHANNELS; c++)
            fits = 20 * fabs(sums[c] - moved * steps[c]) <= 9 * contrast_of(p, q, c) + 60;
        if (fits) return true;
    }
    return false;
}

void edge_rows_mark(EdgeRows *a, EdgeRows *b, int y, const uint8_t *levels, uint8_t *masked) {
    for (int i = 0; i < SIDE; i++) {
        a->rows[i] = slot_of(a, inside(y - REACH + i, a->height));
        b->rows[i] = slot_of(b, inside(y - REACH + i, b->height));
    }
    for (int x = 0; x < a->width; x++) {
        Window p, q;
        uint8_t slacks[CHANNELS];
        int changes[CHANNELS];
        if (levels[x] == 0 || masked[x] != IGNORED_NOT) continue;
        window_of(a, x, &p);
        window_of(b, x, &q);
        if (!is_bounded(&p, &q, slacks) || !share_side(a, b, x, slacks)) continue;
        bool explained = is_explained(&p, &q, slacks, NULL);
        if (!explained) {
            least_changes(a, b, x, changes);
            explained = is_explained(&p, &q, slacks, changes) || lies_between(a, b, x, &p, &q, slacks);
        }
        if (explained && keeps_colours(a, b, x)) masked[x] = IGNORED_EDGE;
    }
}

bool antialias_mark(const Image *expected, const Image *actual, uint8_t *masked, Error *error) {
    const size_t width = (size_t)expected->width;
    EdgeRows a = {0}, b = {0};
    uint8_t *levels = malloc(width);
    const bool ok = (levels != NULL && edge_rows_create(&a, expected->width, expected->height) &&
                     edge_rows_create(&b, expected->width, expected->height)) ||
                    error_memory(error, "image");
    for (int y = 0; ok && y < expected->height; y++) {
        const size_t first = CHANNELS * width * (size_t)y;
        if (memcmp(expected->pixels + first, actual->pixels + first, CHANNELS * width) == 0) continue;
        image_levels(expected->pixels + first, actual->pixels + first, width, levels);
        edge_rows_load(&a, expected, y);
        edge_rows_load(&b, actual, y);
        edge_rows_mark(&a, &b, y, levels, masked + width * (size_t)y);
    }
    free(a.memory);
    free(b.memory);
    free(levels);
    return ok;
}

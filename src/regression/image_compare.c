/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Two pictures pixel by pixel, and the edges that antialias_mark() finds: the numbers 1 to 4 are those of its
   definition in regression_internal.h. */
#include "base/numbers.h"
#include "pixels/png.h"
#include "regression/compare.h"
#include "regression/regression_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CHANNELS = 4, REACH = 3, SIDE = 2 * REACH + 1 };

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

static inline Bytes image_compare_load(const uint8_t *p) {
    Bytes bytes;
    memcpy(&bytes, p, sizeof bytes);
    return bytes;
}

/* The rows of a picture around one, premultiplied by alpha; beyond its edges, the pixels at its edges. */
typedef struct Around {
    const Image *image;
    uint8_t *memory;           /* SIDE rows, by number modulo SIDE */
    size_t stride;             /* bytes: REACH pixels, a row, REACH pixels and room for a vector */
    int numbers[SIDE];         /* of the rows in memory */
    const uint8_t *rows[SIDE]; /* from y - REACH on; [4 * x] is REACH pixels left of pixel x */
} Around;

static int image_compare_inside(int i, int count) { return i < 0 ? 0 : i >= count ? count - 1 : i; }

static void premultiply(const uint8_t *p, uint8_t *to) {
    for (int c = 0; c < 3; c++) to[c] = p[3] == 255 ? p[c] : (uint8_t)((p[c] * p[3] + 127) / 255);
    to[3] = p[3];
}

static bool around_create(Around *around, const Image *image) {
    *around = (Around){.image = image, .stride = 4 * ((size_t)image->width + 2 * REACH) + sizeof(Bytes)};
    for (int i = 0; i < SIDE; i++) around->numbers[i] = -1;
    return (around->memory = calloc(SIDE, around->stride)) != NULL;
}

static void around_move(Around *around, int y) {
    const Image *image = around->image;
    for (int i = 0; i < SIDE; i++) {
        const int number = image_compare_inside(y - REACH + i, image->height), slot = number % SIDE;
        uint8_t *row = around->memory + (size_t)slot * around->stride;
        around->rows[i] = row;
        if (around->numbers[slot] == number) continue;
        around->numbers[slot] = number;
        const uint8_t *from = image->pixels + 4 * (size_t)number * (size_t)image->width;
        for (int x = -REACH; x < image->width + REACH; x++, row += 4)
            premultiply(from + 4 * image_compare_inside(x, image->width), row);
    }
}

/* A window of 3 x 3 pixels, by channel. */
typedef struct Window {
    uint8_t middle[16], least[16], most[16];
    uint16_t sum[16];
} Window;

static inline void window_of(const Around *around, int x, Window *window) {
    const uint8_t *const *rows = around->rows + REACH - 1;
    const size_t at = 4 * ((size_t)x + REACH - 1);
    const Bytes a = image_compare_load(rows[0] + at), b = image_compare_load(rows[1] + at),
                c = image_compare_load(rows[2] + at);
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

/* Differences up to this look equal beside a contrast: renderers round, and areas have gradients. */
static int slack(int contrast) { return 2 + contrast / 16; }

static bool is_within(int value, const Window *window, int channel, int more) {
    return value >= window->least[channel] - more && value <= window->most[channel] + more;
}

/* By channel, how much the sums of 5 x 5 pixels differ at least, in windows around the pixel and its eight neighbours;
   0 where one window has more and another less. */
static void least_changes(const Around *a, const Around *b, int x, int least[CHANNELS]) {
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

/* The colours of windows of 3 x 3 pixels. */
typedef struct Colours {
    int count;
    const uint8_t *list[18];
} Colours;

static void add_colours(const Around *around, int x, Colours *colours) {
    for (int i = 0; i < 9; i++)
        colours->list[colours->count++] = around->rows[REACH - 1 + i / 3] + 4 * (x + REACH - 1 + i % 3);
}

/* Orders colours by a channel; those that are equal in it by all, so that it does not matter which picture has one. */
static bool is_less(const uint8_t *a, const uint8_t *b, int channel) {
    return a[channel] != b[channel] ? a[channel] < b[channel] : memcmp(a, b, CHANNELS) < 0;
}

/* The channel in which colours differ most. */
static int widest_channel(const Colours *colours) {
    uint8_t low[CHANNELS], high[CHANNELS];
    memcpy(low, colours->list[0], CHANNELS);
    memcpy(high, colours->list[0], CHANNELS);
    for (int i = 1; i < colours->count; i++)
        for (int c = 0; c < CHANNELS; c++) {
            const uint8_t value = colours->list[i][c];
            low[c] = value < low[c] ? value : low[c];
            high[c] = value > high[c] ? value : high[c];
        }
    int widest = 0;
    for (int c = 1; c < CHANNELS; c++)
        if (high[c] - low[c] > high[widest] - low[widest]) widest = c;
    return widest;
}

/* Whether all are mixtures of two, as far as rounding shows. */
static bool are_mixtures(const Colours *colours) {
    enum { ROUNDING = 2 };
    const int channel = widest_channel(colours);
    const uint8_t *one = colours->list[0], *other = one;
    for (int i = 1; i < colours->count; i++) {
        if (is_less(colours->list[i], one, channel)) one = colours->list[i];
        if (is_less(other, colours->list[i], channel)) other = colours->list[i];
    }
    const int most = other[channel] - one[channel];
    for (int i = 0; i < colours->count; i++) {
        const int part = colours->list[i][channel] - one[channel];
        for (int c = 0; c < CHANNELS; c++)
            if (abs((colours->list[i][c] - one[c]) * most - part * (other[c] - one[c])) > ROUNDING * most) return false;
    }
    return true;
}

/* 4. */
static bool keeps_colours(const Around *a, const Around *b, int x) {
    Colours of_a = {0}, of_b = {0}, both = {0};
    add_colours(a, x, &of_a);
    add_colours(b, x, &of_b);
    add_colours(a, x, &both);
    add_colours(b, x, &both);
    return are_mixtures(&both) || !are_mixtures(&of_a) || !are_mixtures(&of_b);
}

static int contrast_of(const Window *p, const Window *q, int c) {
    const int most = p->most[c] > q->most[c] ? p->most[c] : q->most[c],
              least = p->least[c] < q->least[c] ? p->least[c] : q->least[c];
    return most - least;
}

/* 1, for all channels. slacks: by channel. */
static bool is_bounded(const Window *p, const Window *q, uint8_t slacks[CHANNELS]) {
    int largest = 0;
    for (int c = 0; c < CHANNELS; c++) {
        const int contrast = contrast_of(p, q, c);
        if (10 * abs(p->middle[c] - q->middle[c]) > 6 * contrast + 10) return false;
        if (contrast > largest) largest = contrast;
        slacks[c] = (uint8_t)slack(contrast);
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
static inline Pixels are_flat(const Around *around, int i, size_t x, Bytes more) {
    const Bytes middle = image_compare_load(around->rows[i] + 4 * x);
    Pixels count = {0};
    for (int dy = -1; dy <= 1; dy++)
        for (size_t dx = 0; dx < 3; dx++)
            count -= look_equal(image_compare_load(around->rows[i + dy] + 4 * (x + dx - 1)), middle, more);
    return (Pixels)(count > 3); /* with itself */
}

static inline bool any(Pixels pixels) {
    uint64_t halves[2];
    memcpy(halves, &pixels, sizeof halves);
    return (halves[0] | halves[1]) != 0;
}

/* 3. */
static inline bool share_side(const Around *a, const Around *b, int x, const uint8_t slacks[CHANNELS]) {
    uint32_t of_pixel;
    memcpy(&of_pixel, slacks, sizeof of_pixel);
    const Bytes more = (Bytes)((Pixels){0} + of_pixel);
    for (int i = 1; i < SIDE - 1; i++)
        for (size_t dx = 1; dx <= 2; dx++) { /* five pixels: the first four, and the last four */
            const size_t at = (size_t)x + dx;
            Pixels found =
                look_equal(image_compare_load(a->rows[i] + 4 * at), image_compare_load(b->rows[i] + 4 * at), more);
            if (any(found) && any(found &= are_flat(a, i, at, more)) && any(found & are_flat(b, i, at, more)))
                return true;
        }
    return false;
}

/* Twice the colours of the sides, on average of both pictures: flat ones that they share, within two pixels. False if
   there are not two. */
static bool find_sides(const Around *a, const Around *b, int x, const uint8_t slacks[CHANNELS],
                       int sides[2][CHANNELS]) {
    uint32_t of_pixel;
    memcpy(&of_pixel, slacks, sizeof of_pixel);
    const Bytes more = (Bytes)((Pixels){0} + of_pixel);
    int farthest = -1;
    for (int i = 1; i < SIDE - 1; i++)
        for (size_t dx = 1; dx < SIDE - 1; dx++) {
            const size_t at = (size_t)x + dx;
            const uint8_t *p = a->rows[i] + 4 * at, *q = b->rows[i] + 4 * at;
            if (look_equal(image_compare_load(p), image_compare_load(q), more)[0] == 0 ||
                are_flat(a, i, at, more)[0] == 0 || are_flat(b, i, at, more)[0] == 0)
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

/* Whether the sums of 5 x 5 pixels, b less a, are what it takes to move an edge or a line between two sides by half a
   pixel at most: one side's colour gives way to the other's. */
static bool moves_between(const int sums[CHANNELS], int sides[2][CHANNELS], const Window *p, const Window *q) {
    static const double MOST = 0.5 * 7; /* of the longest edge in a window */
    double steps[CHANNELS], product = 0, square = 0;
    for (int c = 0; c < CHANNELS; c++) {
        steps[c] = (sides[1][c] - sides[0][c]) / 2.0;
        product += sums[c] * steps[c], square += steps[c] * steps[c];
    }
    const double moved = product / square;
    bool fits = fabs(moved) <= MOST;
    for (int c = 0; fits && c < CHANNELS; c++)
        fits = 20 * fabs(sums[c] - moved * steps[c]) <= 9 * contrast_of(p, q, c) + 60;
    return fits;
}

/* The same as the second part of 2, for a line whose sides differ: in one of the windows around the pixel and its
   neighbours. */
static bool lies_between(const Around *a, const Around *b, int x, const Window *p, const Window *q,
                         const uint8_t slacks[CHANNELS]) {
    int sides[2][CHANNELS] = {{0}};
    if (!find_sides(a, b, x, slacks, sides)) return false;
    for (int window = 0; window < 9; window++) {
        int sums[CHANNELS] = {0};
        for (int i = window / 3; i < window / 3 + SIDE - 2; i++)
            for (int k = 0; k < (SIDE - 2) * CHANNELS; k++) {
                const size_t at = 4 * ((size_t)x + (size_t)(window % 3)) + (size_t)k;
                sums[k % CHANNELS] += b->rows[i][at] - a->rows[i][at];
            }
        if (moves_between(sums, sides, p, q)) return true;
    }
    return false;
}

static void mark_row(const Around *a, const Around *b, const uint8_t *levels, int width, uint8_t *masked) {
    Window p, q;
    uint8_t slacks[CHANNELS];
    int changes[CHANNELS];
    for (int x = 0; x < width; x++) {
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
    Around a, b = {.memory = NULL};
    uint8_t *levels = malloc(width);
    const bool ok =
        (around_create(&a, expected) && around_create(&b, actual) && levels != NULL) || error_memory(error, "image");
    for (int y = 0; ok && y < expected->height; y++) {
        const size_t first = 4 * width * (size_t)y;
        if (memcmp(expected->pixels + first, actual->pixels + first, 4 * width) == 0) continue;
        image_levels(expected->pixels + first, actual->pixels + first, width, levels);
        around_move(&a, y);
        around_move(&b, y);
        mark_row(&a, &b, levels, expected->width, masked + width * (size_t)y);
    }
    free(a.memory);
    free(b.memory);
    free(levels);
    return ok;
}

int image_channel_difference(const Image *a, size_t i, const Image *b, size_t j) {
    if (a->pixels16 == NULL && b->pixels16 == NULL) return abs(a->pixels[i] - b->pixels[j]);
    int deep_a = a->pixels16 != NULL ? a->pixels16[i] : a->pixels[i] * 257;
    int deep_b = b->pixels16 != NULL ? b->pixels16[j] : b->pixels[j] * 257;
    return (abs(deep_a - deep_b) + 256) / 257;
}

int image_pixel_difference(const Image *a, const Image *b, size_t pixel) {
    int largest = 0;
    for (size_t i = 4 * pixel; i < 4 * pixel + 4; i++) {
        int difference = image_channel_difference(a, i, b, i);
        if (difference > largest) largest = difference;
    }
    return largest;
}

/* Four pixels at once. */
void image_levels(const uint8_t *a, const uint8_t *b, size_t count, uint8_t *levels) {
    size_t x = 0;
    for (; x + 4 <= count; x += 4) {
        const Bytes difference = difference_of(image_compare_load(a + 4 * x), image_compare_load(b + 4 * x));
        const Bytes half = larger_of(difference, (Bytes)((Pixels)difference >> 16));
        const Pixels whole = (Pixels)larger_of(half, (Bytes)((Pixels)half >> 8));
        for (size_t i = 0; i < 4; i++) levels[x + i] = (uint8_t)whole[i];
    }
    for (; x < count; x++) {
        int largest = 0;
        for (size_t i = 4 * x; i < 4 * x + 4; i++) {
            const int difference = abs(a[i] - b[i]);
            if (difference > largest) largest = difference;
        }
        levels[x] = (uint8_t)largest;
    }
}

enum { FEW = 240 }; /* pixels whose counts fit into a byte */

/* Adds the levels of few pixels from x on. */
static void count_few(ImageDifference *difference, int x, int y, const uint8_t *levels, int count, int tolerance) {
    uint8_t differing = 0, beyond = 0, largest = 0;
    for (int i = 0; i < count; i++) {
        differing = (uint8_t)(differing + (levels[i] > 0));
        beyond = (uint8_t)(beyond + (levels[i] > tolerance));
        largest = levels[i] > largest ? levels[i] : largest;
    }
    if (differing == 0) return;
    int first = 0, last = count - 1;
    while (levels[first] == 0) first++;
    while (levels[last] == 0) last--;
    if (difference->pixels == 0) {
        difference->first_x = difference->left = x + first;
        difference->first_y = difference->top = y;
    }
    difference->pixels += differing;
    difference->beyond += beyond;
    if (largest > difference->largest) difference->largest = largest;
    if (x + first < difference->left) difference->left = x + first;
    if (x + last >= difference->right) difference->right = x + last + 1;
    difference->bottom = y + 1;
}

void image_count_levels(ImageDifference *difference, int y, const uint8_t *levels, int count, int tolerance) {
    for (int x = 0; x < count; x += FEW)
        count_few(difference, x, y, levels + x, count - x < FEW ? count - x : FEW, tolerance);
}

static bool is_deep(const Image *a, const Image *b) { return a->pixels16 != NULL || b->pixels16 != NULL; }

bool image_row_differs(const Image *a, const Image *b, int y) {
    const size_t bytes = 4 * (size_t)a->width, first = (size_t)y * bytes;
    return a != b && (is_deep(a, b) || memcmp(a->pixels + first, b->pixels + first, bytes) != 0);
}

int64_t image_find_levels(const Image *a, const Image *b, const uint8_t *masked, size_t first, size_t count,
                          uint8_t *levels) {
    int64_t moved = 0;
    if (is_deep(a, b))
        for (size_t i = 0; i < count; i++) levels[i] = (uint8_t)image_pixel_difference(a, b, first + i);
    else
        image_levels(a->pixels + 4 * first, b->pixels + 4 * first, count, levels);
    for (size_t i = 0; masked != NULL && i < count; i++) {
        if (masked[first + i] == IGNORED_NOT) continue;
        moved += levels[i] > 0 && masked[first + i] != IGNORED_MASK;
        levels[i] = 0;
    }
    return moved;
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
    uint8_t levels[FEW];
    difference->counted = (int64_t)all - count_masked(masked, all);
    for (int y = 0; y < a->height; y++) {
        if (!image_row_differs(a, b, y)) continue;
        for (int x = 0; x < a->width; x += FEW) {
            const int count = a->width - x < FEW ? a->width - x : FEW;
            difference->moved += image_find_levels(a, b, masked, (size_t)y * width + (size_t)x, (size_t)count, levels);
            count_few(difference, x, y, levels, count, tolerance);
        }
    }
    difference->equal = difference->pixels == 0;
}

void image_compare(const Image *a, const Image *b, ImageDifference *difference) {
    image_compare_masked(a, b, NULL, 0, difference);
}

/* Rows are copied in place: the first byte of a row never lies after its new place. */
static void image_compare_cut(Image *image, int width, int height) {
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
    int width = int_min(a->width, b->width), height = int_min(a->height, b->height);
    image_compare_cut(a, width, height);
    image_compare_cut(b, width, height);
}

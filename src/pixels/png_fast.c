/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From filtered rows to pixels: one file, or two that are mostly equal. */
#include "base/base.h"
#include "base/machine.h"
#include "pixels/pixels_internal.h"
#include "pixels/png.h"

#ifdef __SSE2__
#include <emmintrin.h>
#endif
#include <stdlib.h>
#include <string.h>

typedef uint8_t Bytes __attribute__((vector_size(16)));

/* The row filters of PNG (specification, section 9). */

enum { NONE, SUB, UP, AVERAGE, PAETH };

/* Compiled once for each step, as a constant. */
static inline void add_left(const uint8_t *restrict from, size_t bytes, size_t step, uint8_t *restrict row) {
    uint8_t left[4] = {0};
    for (size_t i = 0; i + step <= bytes; i += step)
        for (size_t c = 0; c < step; c++) row[i + c] = left[c] = (uint8_t)(from[i + c] + left[c]);
}

typedef uint32_t Pixels __attribute__((vector_size(16)));

/* Four pixels of four bytes at once: sums of neighbours, then of pairs, then with all before. */
static void add_left_rgba(const uint8_t *restrict from, size_t bytes, uint8_t *restrict row) {
    static const Pixels not_first = {0, UINT32_MAX, UINT32_MAX, UINT32_MAX}, last_two = {0, 0, UINT32_MAX, UINT32_MAX};
    Pixels before = {0};
    size_t i = 0;
    for (; i + sizeof before <= bytes; i += sizeof before) {
        Pixels pixels;
        memcpy(&pixels, from + i, sizeof pixels);
        pixels = (Pixels)((Bytes)pixels + (Bytes)(__builtin_shufflevector(pixels, pixels, 0, 0, 1, 2) & not_first));
        pixels = (Pixels)((Bytes)pixels + (Bytes)(__builtin_shufflevector(pixels, pixels, 0, 0, 0, 1) & last_two));
        pixels = (Pixels)((Bytes)pixels + (Bytes)before);
        memcpy(row + i, &pixels, sizeof pixels);
        before = __builtin_shufflevector(pixels, pixels, 3, 3, 3, 3);
    }
    for (; i < bytes; i++) row[i] = (uint8_t)(from[i] + (i < 4 ? 0 : row[i - 4]));
}

static inline void add_average(const uint8_t *restrict from, const uint8_t *restrict above, size_t bytes, size_t step,
                               uint8_t *restrict row) {
    uint8_t left[4] = {0};
    for (size_t i = 0; i + step <= bytes; i += step)
        for (size_t c = 0; c < step; c++) row[i + c] = left[c] = (uint8_t)(from[i + c] + (left[c] + above[i + c]) / 2);
}

#ifdef __SSE2__
/* A pixel of at most four bytes at once; beyond a row, up to three bytes are read and written. */
static inline __m128i load_pixel(const uint8_t *p) {
    int pixel;
    memcpy(&pixel, p, sizeof pixel);
    return _mm_unpacklo_epi8(_mm_cvtsi32_si128(pixel), _mm_setzero_si128());
}

static inline __m128i absolute(__m128i x) { return _mm_max_epi16(x, _mm_sub_epi16(_mm_setzero_si128(), x)); }

static inline __m128i choose(__m128i mask, __m128i yes, __m128i no) {
    return _mm_or_si128(_mm_and_si128(mask, yes), _mm_andnot_si128(mask, no));
}

static inline void add_paeth_sse2(const uint8_t *from, const uint8_t *above, size_t bytes, size_t step, uint8_t *row) {
    const __m128i low = _mm_set1_epi16(255);
    __m128i left = _mm_setzero_si128(), corner = left;
    for (size_t i = 0; i < bytes; i += step) {
        const __m128i up = load_pixel(above + i), by_left = _mm_sub_epi16(up, corner),
                      by_up = _mm_sub_epi16(left, corner);
        const __m128i to_left = absolute(by_left), to_up = absolute(by_up),
                      to_corner = absolute(_mm_add_epi16(by_left, by_up));
        const __m128i least = _mm_min_epi16(to_left, _mm_min_epi16(to_up, to_corner));
        const __m128i nearest =
            choose(_mm_cmpeq_epi16(least, to_left), left, choose(_mm_cmpeq_epi16(least, to_up), up, corner));
        left = _mm_and_si128(_mm_add_epi16(load_pixel(from + i), nearest), low);
        corner = up;
        const int pixel = _mm_cvtsi128_si32(_mm_packus_epi16(left, left));
        memcpy(row + i, &pixel, sizeof pixel);
    }
}
#endif

static inline void add_paeth(const uint8_t *restrict from, const uint8_t *restrict above, size_t bytes, size_t step,
                             uint8_t *restrict row) {
    int left[4] = {0}, corner[4] = {0};
    for (size_t i = 0; i + step <= bytes; i += step)
        for (size_t c = 0; c < step; c++) {
            int up = above[i + c];
            /* The neighbour nearest to left + up - corner; the first of these where they tie. */
            const int to_left = abs(up - corner[c]), to_up = abs(left[c] - corner[c]),
                      to_corner = abs(left[c] + up - 2 * corner[c]);
            const int nearest = to_up <= to_corner ? up : corner[c], distance = to_up <= to_corner ? to_up : to_corner;
            row[i + c] = (uint8_t)(from[i + c] + (to_left <= distance ? left[c] : nearest));
            left[c] = row[i + c], corner[c] = up;
        }
}

/* Filters that refer to the left. */
static inline bool unfilter_step(int filter, const uint8_t *from, const uint8_t *above, size_t bytes, size_t step,
                                 uint8_t *row) {
    if (filter == SUB)
        add_left(from, bytes, step, row);
    else if (filter == AVERAGE)
        add_average(from, above, bytes, step, row);
#ifdef __SSE2__
    else if (filter == PAETH && step >= 3)
        add_paeth_sse2(from, above, bytes, step, row);
#endif
    else if (filter == PAETH)
        add_paeth(from, above, bytes, step, row);
    else
        return false;
    return true;
}

/* row[bytes] = the row that `filtered`, a filter's number and `bytes` bytes, stands for. above[bytes]: the row above,
   zeros for the first. step: 1 to 4, bytes per pixel. No two of the arrays overlap. False for an unknown filter. */
static bool unfilter_row(const uint8_t *filtered, const uint8_t *restrict above, size_t bytes, int step,
                         uint8_t *restrict row) {
    int filter = filtered[0];
    const uint8_t *restrict from = filtered + 1;
    if (filter == NONE)
        memcpy(row, from, bytes);
    else if (filter == UP)
        for (size_t i = 0; i < bytes; i++) row[i] = (uint8_t)(from[i] + above[i]);
    else if (filter == SUB && step == 4)
        add_left_rgba(from, bytes, row);
    else
        return step == 4   ? unfilter_step(filter, from, above, bytes, 4, row)
               : step == 3 ? unfilter_step(filter, from, above, bytes, 3, row)
               : step == 2 ? unfilter_step(filter, from, above, bytes, 2, row)
                           : unfilter_step(filter, from, above, bytes, 1, row);
    return true;
}

/* Rows as RGBA. */

enum { OPAQUE = 255 };

/* Compilers make one load of it, and one store of the next. */
static uint32_t load(const uint8_t *p) {
    return (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

static void store(uint32_t pixel, uint8_t *rgba) {
    pixel |= (uint32_t)OPAQUE << 24;
    rgba[0] = (uint8_t)pixel, rgba[1] = (uint8_t)(pixel >> 8);
    rgba[2] = (uint8_t)(pixel >> 16), rgba[3] = (uint8_t)(pixel >> 24);
}

#ifdef TWINBOX_AVX
/* Sixteen bytes hold five pixels, of which four are taken. Returns how many pixels are done. */
__attribute__((target("ssse3"))) static size_t expand_rgb_ssse3(const uint8_t *restrict row, size_t width,
                                                                uint8_t *restrict rgba) {
    static const Bytes opaque = {0, 0, 0, OPAQUE, 0, 0, 0, OPAQUE, 0, 0, 0, OPAQUE, 0, 0, 0, OPAQUE};
    size_t x = 0;
    for (; x + 6 <= width; x += 4) {
        Bytes bytes;
        memcpy(&bytes, row + 3 * x, sizeof bytes);
        bytes =
            __builtin_shufflevector(bytes, (Bytes){0}, 0, 1, 2, 16, 3, 4, 5, 16, 6, 7, 8, 16, 9, 10, 11, 16) | opaque;
        memcpy(rgba + 4 * x, &bytes, sizeof bytes);
    }
    return x;
}
#endif

/* Four pixels are three words. */
static void expand_rgb(const uint8_t *restrict row, size_t width, uint8_t *restrict rgba) {
    size_t x = 0;
#ifdef TWINBOX_AVX
    if (__builtin_cpu_supports("ssse3")) x = expand_rgb_ssse3(row, width, rgba);
    row += 3 * x, rgba += 4 * x;
#endif
    for (; x + 4 <= width; x += 4, row += 12, rgba += 16) {
        uint32_t a = load(row), b = load(row + 4), c = load(row + 8);
        store(a, rgba);
        store(a >> 24 | b << 8, rgba + 4);
        store(b >> 16 | c << 16, rgba + 8);
        store(c >> 8, rgba + 12);
    }
    for (; x < width; x++, row += 3, rgba += 4)
        store((uint32_t)row[0] | (uint32_t)row[1] << 8 | (uint32_t)row[2] << 16, rgba);
}

/* Sample x of one channel; the first is in the highest bits of a byte. */
static unsigned sample(const uint8_t *row, size_t x, unsigned depth) {
    size_t bit = x * depth;
    return (unsigned)row[bit / 8] >> (8 - depth - bit % 8) & ((1u << depth) - 1);
}

/* rgba[4 * width] for a row. False if a colour is not in the palette. */
static bool expand_row(const PngLayout *layout, const uint8_t *restrict row, uint8_t *restrict rgba) {
    const size_t width = layout->width;
    const unsigned depth = (unsigned)layout->depth, scale = 255 / ((1u << depth) - 1);
    unsigned most = 0;
    switch (layout->color) {
    case PNG_PALETTE:
        for (size_t x = 0; x < width; x++) {
            const unsigned index = sample(row, x, depth);
            memcpy(rgba + 4 * x, layout->palette[index], 4);
            if (index > most) most = index;
        }
        return most < (unsigned)layout->colors;
    case PNG_GREY:
        for (size_t x = 0; x < width; x++) {
            const unsigned value = sample(row, x, depth);
            rgba[4 * x] = rgba[4 * x + 1] = rgba[4 * x + 2] = (uint8_t)(value * scale);
            rgba[4 * x + 3] = layout->has_clear && value == layout->clear[0] ? 0 : OPAQUE;
        }
        break;
    case PNG_GREY_ALPHA:
        for (size_t x = 0; x < width; x++) {
            rgba[4 * x] = rgba[4 * x + 1] = rgba[4 * x + 2] = row[2 * x];
            rgba[4 * x + 3] = row[2 * x + 1];
        }
        break;
    case PNG_RGB:
        expand_rgb(row, width, rgba);
        for (size_t x = 0; layout->has_clear && x < width; x++)
            if (memcmp(rgba + 4 * x, layout->clear, 3) == 0) rgba[4 * x + 3] = 0;
        break;
    default: memcpy(rgba, row, 4 * width); break;
    }
    return true;
}

/* Two files, or one, band by band. A second thread does what the second file needs: it decompresses the next band while
   the first file's is unfiltered, and where bands differ, both are unfiltered at once. As long as the compressed bytes
   of both files are the same, it decompresses for both. */

enum { SLACK = 16 /* vectors read and write beyond a row */ };

typedef struct Side {
    PngRows *rows;
    uint8_t *filtered[2]; /* [band, 1 + bytes], in turns */
    uint8_t *above;       /* [kept, bytes] the last rows before the band; behind them: */
    uint8_t *band;        /* [band, bytes] unfiltered */
    uint8_t *memory;
    bool failed; /* a colour is not in the palette: while the second thread may set rows->damaged */
} Side;

/* Work on the second file. */
typedef struct Task {
    int slot;  /* of `filtered` */
    int count; /* rows to decompress; 0: unfilter the band in work */
} Task;

typedef struct Scan {
    Side sides[2];
    int files, band; /* files; rows of a band */
    int top, count;  /* of the band in work */
    int kept;        /* rows above the band, of which unfiltering needs one */
    int next, since; /* the row after the last one that was given; equal rows since one that differs */
    bool alike;      /* the layouts are the same, so that equal bytes are equal pixels */
    bool equal;      /* the last row */
    bool joined;     /* the compressed bytes are the same up to the band in work */
    const RowSink *sink;
    Background *background; /* or NULL */
    Task task;              /* the one that the second thread has, also where the scan fails */
} Scan;

enum { FAR_AWAY = ROWS_ALL - 1 }; /* from a row that differs */

static void decompress(Side *side, int slot, int count) {
    PngRows *rows = side->rows;
    rows->damaged = rows->damaged || !png_rows_read(rows, side->filtered[slot], (size_t)count * (rows->bytes + 1));
}

static void unfilter(Side *side, const uint8_t *filtered, int count) {
    PngRows *rows = side->rows;
    const size_t bytes = rows->bytes;
    for (int y = 0; y < count; y++) {
        uint8_t *row = side->band + (size_t)y * bytes;
        rows->damaged =
            rows->damaged || !unfilter_row(filtered + (size_t)y * (bytes + 1), row - bytes, bytes, rows->step, row);
    }
}

static bool do_task(void *context, void *item, Error *error) {
    const Task *task = item;
    Side *side = &((Scan *)context)->sides[1];
    (void)error;
    if (task->count > 0)
        decompress(side, task->slot, task->count);
    else
        unfilter(side, side->filtered[task->slot], ((Scan *)context)->count);
    return true;
}

/* Gives the second thread work, or does it at once. */
static void give(Scan *scan, int slot, int count) {
    Error ignored = {0};
    scan->task = (Task){slot, count};
    if (scan->background != NULL)
        (void)background_give(scan->background, &scan->task, &ignored);
    else
        (void)do_task(scan, &scan->task, &ignored);
}

static void finish(const Scan *scan) {
    Error ignored = {0};
    if (scan->background != NULL) (void)background_wait(scan->background, &ignored);
}

static bool expand(Scan *scan, int side, int y, const uint8_t *row, uint8_t **rgba) {
    *rgba = scan->sink->place(scan->sink->context, side, scan->top + y);
    Side *from = &scan->sides[side];
    from->failed = *rgba != NULL && !expand_row(&from->rows->layout, row, *rgba);
    return *rgba != NULL && !from->failed;
}

/* Hands a row of the band, or one above it, to the sink. same: it is equal in both files. */
static bool deliver_row(Scan *scan, int y, bool same) {
    const Side *first = &scan->sides[0], *second = &scan->sides[1];
    const ptrdiff_t bytes = (ptrdiff_t)first->rows->bytes;
    const uint8_t *a = first->band + y * bytes, *b = same ? a : second->band + y * (ptrdiff_t)second->rows->bytes;
    uint8_t *rgba = NULL, *other = NULL;
    scan->equal = same || (scan->alike && memcmp(a, b, (size_t)bytes) == 0);
    if (!expand(scan, 0, y, a, &rgba) || (!scan->equal && !expand(scan, 1, y, b, &other))) return false;
    if (other != NULL && !scan->alike) scan->equal = memcmp(rgba, other, 4 * (size_t)first->rows->layout.width) == 0;
    scan->sink->row(scan->sink->context, scan->top + y, rgba, scan->equal ? rgba : other);
    scan->next = scan->top + y + 1;
    return true;
}

/* Hands the rows of the band to the sink, and before rows that may differ, those above that it wants. same: those of
   both files are equal. */
static bool deliver(Scan *scan, bool same) {
    const int around = scan->sink->around, left_out = scan->top - scan->next;
    for (int y = same ? 0 : left_out < scan->kept ? -left_out : -scan->kept; y < 0; y++)
        if (around > 0 && !deliver_row(scan, y, true)) return false;
    for (int y = 0; y < scan->count; y++) {
        const bool wanted = !same || scan->since < around || scan->sides[0].rows->layout.color == PNG_PALETTE;
        if (wanted && !deliver_row(scan, y, same)) return false;
        scan->equal |= same;
        scan->since = !scan->equal ? 0 : scan->since < FAR_AWAY ? scan->since + 1 : FAR_AWAY;
    }
    return true;
}

static int rows_from(const Scan *scan, int top) {
    const int left = (int)scan->sides[0].rows->layout.height - top;
    return left < scan->band ? left : scan->band;
}

/* The rows after the band in work. */
static void give_next(Scan *scan, int slot) {
    const int count = rows_from(scan, scan->top + scan->count);
    if (scan->files > 1 && count > 0) give(scan, slot, count);
}

/* The rows of the first file, and those of the second in `slot`. */
static bool scan_band(Scan *scan, int slot) {
    Side *first = &scan->sides[0], *second = &scan->sides[1];
    const size_t size = (size_t)scan->count * (first->rows->bytes + 1);
    if (!scan->joined) decompress(first, 0, scan->count);
    finish(scan);
    /* As long as both files have been equal, the first one's rows are not stored. */
    if (scan->joined && second->rows->twin == NULL) {
        first->rows->damaged = !png_rows_read_parted(first->rows, second->filtered[slot], first->filtered[0], size);
        scan->joined = false;
    }
    if (scan->joined) first->rows->damaged = second->rows->damaged;
    if (first->rows->damaged || second->rows->damaged) return false;

    /* Equal bytes below equal rows are equal rows. */
    const bool same = scan->files == 1 || scan->joined ||
                      (scan->alike && scan->equal && memcmp(first->filtered[0], second->filtered[slot], size) == 0);
    if (!same) give(scan, slot, 0);
    if (same) give_next(scan, 1 - slot);
    unfilter(first, scan->joined ? second->filtered[slot] : first->filtered[0], scan->count);
    if (!same) finish(scan);
    if (first->rows->damaged || (!same && second->rows->damaged)) return false;
    if (!same) give_next(scan, 1 - slot);
    if (!deliver(scan, same)) return false;

    /* The last rows of the band and above it stay, of the second file those of the first where they are equal. */
    for (int i = scan->files - 1; i >= 0; i--) {
        const Side *from = same ? first : &scan->sides[i];
        const size_t bytes = from->rows->bytes;
        memmove(scan->sides[i].above, from->above + (size_t)scan->count * bytes, (size_t)scan->kept * bytes);
    }
    return true;
}

static bool start(Scan *scan, size_t band, bool threads) {
    Error ignored = {0};
    Side *sides = scan->sides;
    const PngLayout *a = &sides[0].rows->layout, *b = &sides[1].rows->layout; /* of one file: itself */
    const size_t fit = band / (sides[0].rows->bytes + 1);
    if (scan->files > 1 && (a->width != b->width || a->height != b->height)) return false;
    scan->alike = a->color == b->color && a->depth == b->depth && a->colors == b->colors &&
                  memcmp(a->palette, b->palette, sizeof a->palette) == 0 && a->has_clear == b->has_clear &&
                  memcmp(a->clear, b->clear, sizeof a->clear) == 0;
    scan->band = fit < 1 ? 1 : fit < a->height ? (int)fit : (int)a->height;
    for (int i = 0; i < scan->files; i++) {
        Side *side = &sides[i];
        const size_t bytes = side->rows->bytes, stored = (size_t)scan->band * (bytes + 1) + SLACK,
                     all = (size_t)(scan->band + scan->kept) * bytes;
        side->memory = calloc((i > 0 ? 2 : 1) * stored + all + SLACK, 1);
        if (side->memory == NULL) return false;
        side->above = side->memory;
        side->band = side->above + (size_t)scan->kept * bytes;
        side->filtered[0] = side->memory + all + SLACK;
        side->filtered[1] = side->filtered[0] + (i > 0 ? stored : 0);
        if (!png_rows_start(side->rows)) return false;
    }
    scan->joined = scan->files > 1 && scan->alike;
    if (scan->joined) sides[1].rows->twin = sides[0].rows;
    if (threads && scan->files > 1 && scan->band < (int)a->height)
        scan->background = background_start(do_task, scan, &ignored); /* without it, one thread does all */
    return scan->sink->begin(scan->sink->context, (int)a->width, (int)a->height);
}

bool png_fast_scan_rows(PngRows *const rows[], int files, size_t band, bool threads, const RowSink *sink) {
    const int around = sink->around;
    Scan scan = {.files = files, .equal = true, .sink = sink, .since = FAR_AWAY};
    scan.kept = around > 1 && around < ROWS_ALL ? around : 1; /* none is left out of all */
    for (int i = 0; i < 2; i++) scan.sides[i].rows = rows[i < files ? i : 0];
    bool ok = start(&scan, band, threads);
    if (ok) give_next(&scan, 0);
    for (int slot = 0; ok && (scan.count = rows_from(&scan, scan.top)) > 0; scan.top += scan.count, slot = 1 - slot)
        ok = scan_band(&scan, slot);
    if (ok) {
        ok = files == 1 || png_rows_end(rows[1]);
        rows[0]->damaged = scan.sides[1].rows->twin != NULL; /* the same up to a sound end: parted there */
        ok = !rows[0]->damaged && png_rows_end(rows[0]) && ok;
    }
    background_stop(scan.background);
    for (int i = 0; i < files; i++) {
        rows[i]->damaged = rows[i]->damaged || scan.sides[i].failed;
        free(scan.sides[i].memory);
    }
    return ok;
}

bool png_fast_scan(const uint8_t *const data[], const size_t sizes[], int files, int64_t max_pixels, size_t band,
                   bool threads, const RowSink *sink) {
    PngRows rows[2] = {0};
    bool ok = true;
    for (int i = 0; i < files; i++) {
        png_source_of(&rows[i].source, data[i], sizes[i]);
        ok = ok && png_rows_open(&rows[i], max_pixels);
    }
    ok = ok && png_fast_scan_rows((PngRows *const[]){&rows[0], &rows[1]}, files, band, threads, sink);
    for (int i = 0; i < files; i++) png_rows_close(&rows[i]);
    return ok;
}

/* Pictures in memory: the second is made when a row differs. */

static bool begin_images(void *context, int width, int height) {
    Image **images = context;
    images[0] = image_create_unset(width, height, &(Error){0});
    if (images[0] != NULL) image_provide(images[0]);
    return images[0] != NULL;
}

static uint8_t *place_in_image(void *context, int side, int y) {
    Image **images = context;
    const size_t above = (size_t)y * (size_t)images[0]->width * 4;
    if (images[side] == NULL) {
        if ((images[1] = image_create_unset(images[0]->width, images[0]->height, &(Error){0})) == NULL) return NULL;
        image_provide(images[1]);
        memcpy(images[1]->pixels, images[0]->pixels, above);
    }
    return images[side]->pixels + above;
}

static void keep_row(void *context, int y, const uint8_t *a, const uint8_t *b) {
    Image **images = context;
    const size_t bytes = (size_t)images[0]->width * 4;
    if (a == b && images[1] != NULL) memcpy(images[1]->pixels + (size_t)y * bytes, a, bytes);
}

static bool decode_files(const uint8_t *const data[], const size_t sizes[], int files, int64_t max_pixels,
                         Image *images[2]) {
    const RowSink sink = {begin_images, place_in_image, keep_row, images, ROWS_ALL};
    images[0] = images[1] = NULL;
    if (png_fast_scan(data, sizes, files, max_pixels, PNG_BAND, false, &sink)) return true;
    image_destroy_pair(images);
    images[0] = images[1] = NULL;
    return false;
}

bool png_fast_decode(const uint8_t *data, size_t size, int64_t max_pixels, Image **image) {
    Image *images[2];
    const bool ok = decode_files(&data, &size, 1, max_pixels, images);
    *image = images[0];
    return ok;
}

bool png_fast_decode_pair(const uint8_t *const data[2], const size_t sizes[2], int64_t max_pixels, Image *images[2]) {
    const bool ok = decode_files(data, sizes, 2, max_pixels, images);
    if (images[1] == NULL) images[1] = images[0];
    return ok;
}

/* Pixels that nobody keeps. */

static bool begin_row(void *context, int width, int height) {
    (void)height;
    return (*(uint8_t **)context = malloc((size_t)width * 4)) != NULL;
}

static uint8_t *place_in_row(void *context, int side, int y) {
    (void)side, (void)y;
    return *(uint8_t **)context;
}

static void drop_row(void *context, int y, const uint8_t *a, const uint8_t *b) {
    (void)context, (void)y, (void)a, (void)b;
}

bool png_fast_check_rows(PngRows *rows) {
    uint8_t *row = NULL;
    const RowSink sink = {begin_row, place_in_row, drop_row, &row, 0};
    bool ok = png_fast_scan_rows(&rows, 1, PNG_BAND, false, &sink);
    free(row);
    return ok;
}

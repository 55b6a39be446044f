/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The limits of a comparison: how they are read and told, and whether a difference is within them. */
#include "base/base.h"
#include "base/file.h"
#include "pixels/png.h"
#include "regression/compare.h"
#include "regression/flip.h"
#include "regression/regression_internal.h"
#include "regression/regression.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool given(const Tolerance *tolerance, unsigned limits) { return (tolerance->given & limits) != 0; }

void tolerance_override(Tolerance *tolerance, const Tolerance *over) {
    tolerance->given |= over->given;
    if (given(over, LIMIT_FUZZY)) tolerance->fuzzy = over->fuzzy, tolerance->share = over->share;
    if (given(over, LIMIT_TOLERANCE)) tolerance->tolerance = over->tolerance;
    if (given(over, LIMIT_BEYOND)) tolerance->beyond = over->beyond;
    if (given(over, LIMIT_FLIP_MEAN)) tolerance->flip_mean = over->flip_mean;
    if (given(over, LIMIT_FLIP_P99)) tolerance->flip_p99 = over->flip_p99;
    if (given(over, LIMIT_ANTIALIAS)) tolerance->antialias = over->antialias;
    if (given(over, LIMIT_SHIFT)) tolerance->shift = over->shift;
    if (given(over, LIMIT_SIZE)) tolerance->size = over->size;
}

static bool is_within(int64_t pixels, const PixelLimit *limit, double counted) {
    return (double)pixels <= (limit->number ? limit->most : limit->most * counted);
}

bool tolerance_holds(const Tolerance *tolerance, const ImageDifference *difference, const FlipSummary *flip) {
    double counted = (double)difference->counted;
    if (difference->pixels == 0) return true;
    if (!given(tolerance, LIMIT_FUZZY | LIMIT_TOLERANCE | LIMIT_BEYOND | LIMITS_FLIP)) return false;
    if (given(tolerance, LIMIT_FUZZY) &&
        (difference->largest > tolerance->fuzzy || !is_within(difference->pixels, &tolerance->share, counted)))
        return false;
    if (given(tolerance, LIMIT_TOLERANCE | LIMIT_BEYOND) && !is_within(difference->beyond, &tolerance->beyond, counted))
        return false;
    /* FLIP sees 8 bits: a limit of 0 also means what lies below them. */
    const bool none = tolerance->flip_mean <= 0,
               few = tolerance->flip_p99 > 0 || 100 * (double)difference->pixels <= counted;
    return (!given(tolerance, LIMIT_FLIP_MEAN) || (!none && flip->mean <= tolerance->flip_mean)) &&
           (!given(tolerance, LIMIT_FLIP_P99) || (few && flip->p99 <= tolerance->flip_p99));
}

#define ADD(...) text_join(words.text, sizeof words.text, ", ", __VA_ARGS__)

static ToleranceText pixel_limit_words(const PixelLimit *limit) {
    ToleranceText words = {""};
    if (limit->number)
        ADD("%.0f %s", limit->most, limit->most == 1 ? "pixel" : "pixels");
    else
        ADD("%g%% of the pixels", 100 * limit->most);
    return words;
}

ToleranceText tolerance_words(const Tolerance *tolerance) {
    ToleranceText words = {""};
    if (given(tolerance, LIMIT_FUZZY))
        ADD("differences of at most %d in at most %s", tolerance->fuzzy, pixel_limit_words(&tolerance->share).text);
    if (given(tolerance, LIMIT_TOLERANCE | LIMIT_BEYOND))
        ADD("differences above %d in at most %s", tolerance->tolerance, pixel_limit_words(&tolerance->beyond).text);
    if (given(tolerance, LIMIT_FLIP_MEAN)) ADD("mean FLIP of at most %g", tolerance->flip_mean);
    if (given(tolerance, LIMIT_FLIP_P99)) ADD("99th percentile of FLIP of at most %g", tolerance->flip_p99);
    if (tolerance->antialias) ADD("edges may move within a pixel");
    if (tolerance->shift > 0)
        ADD("content may move by %d %s", tolerance->shift, tolerance->shift == 1 ? "pixel" : "pixels");
    if (tolerance->size > 0)
        ADD("sizes may differ by %d %s", tolerance->size, tolerance->size == 1 ? "pixel" : "pixels");
    if (words.text[0] == '\0') ADD("none");
    return words;
}

bool pixel_limit_parse(PixelLimit *limit, const char *text) {
    int64_t pixels;
    const char *rest;
    if (parse_leading_int(text, 0, INT64_MAX, &pixels, &rest) && strcmp(rest, "px") == 0)
        *limit = (PixelLimit){(double)pixels, true};
    else if (parse_double(text, &limit->most) && limit->most >= 0 && limit->most <= 1)
        limit->number = false;
    else
        return false;
    return true;
}

bool tolerance_parse_flip(Tolerance *tolerance, const char *text) {
    static const char mean[] = "mean=", p99[] = "p99=";
    bool percentile = strncmp(text, p99, sizeof p99 - 1) == 0;
    if (percentile)
        text += sizeof p99 - 1;
    else if (strncmp(text, mean, sizeof mean - 1) == 0)
        text += sizeof mean - 1;
    double limit;
    if (!parse_double(text, &limit) || limit < 0 || limit > 1) return false;
    *(percentile ? &tolerance->flip_p99 : &tolerance->flip_mean) = limit;
    tolerance->given |= percentile ? LIMIT_FLIP_P99 : LIMIT_FLIP_MEAN;
    return true;
}

static bool check_rules(const Regression *regression, Error *error) {
    const char **names = malloc(((size_t)regression->count + 1) * sizeof *names);
    if (names == NULL) return error_memory(error, "rules");
    for (int i = 0; i < regression->count; i++) names[i] = frame_name(&regression->frames[i]);
    bool ok = rules_check_names(regression->rules, names, regression->count, error);
    free(names);
    return ok;
}

bool regression_read_rules(Regression *regression, Error *error) {
    const ImageSequence *expected = regression->sequences[EXPECTED];
    char found[PATH_MAX];
    const char *path = regression->options.rules;
    if (path == NULL) {
        if (!file_path(found, sizeof found, error, "%s/%s", expected->folder, RULES_NAME)) return false;
        bool there;
        if (!file_find(found, &there, error)) return false;
        if (!there) return true;
        path = found;
    }
    regression->rules = rules_read(path, error);
    return regression->rules != NULL && (expected->single || check_rules(regression, error));
}

/* Rules first, then what the options give. */
static Tolerance regression_tolerance(const Regression *regression, const RegressionFrame *frame) {
    Tolerance tolerance = {0};
    rules_override(regression->rules, frame_name(frame), &tolerance);
    tolerance_override(&tolerance, &regression->options.tolerance);
    return tolerance;
}

static bool has_masks(const Regression *regression, const RegressionFrame *frame) {
    const Mask *mask = regression->options.mask;
    return (mask != NULL && mask->count > 0) || rules_have_masks(regression->rules, frame_name(frame));
}

static bool has_regions(const Regression *regression, const RegressionFrame *frame) {
    return rules_have_regions(regression->rules, frame_name(frame));
}

int regression_level(const Regression *regression, const RegressionFrame *frame) {
    return regression_tolerance(regression, frame).tolerance;
}

bool regression_needs_rows_alone(Regression *regression, const RegressionFrame *frame, bool *alone, Error *error) {
    const Tolerance tolerance = regression_tolerance(regression, frame);
    bool named = false;
    *alone = !has_masks(regression, frame) && !has_regions(regression, frame) && !tolerance.antialias &&
             tolerance.shift == 0 && (tolerance.given & LIMITS_FLIP) == 0;
    if (*alone && !regression_may_name(regression, frame, &named, error)) return false;
    *alone = *alone && !named;
    return true;
}

bool regression_may_hide_all(const Regression *regression, const RegressionFrame *frame, int width, int height) {
    const Mask *mask = regression->options.mask;
    const double hidden = mask == NULL ? 0 : mask_most_hidden(mask, width, height);
    return hidden + rules_most_hidden(regression->rules, frame_name(frame), width, height) >= (double)width * height;
}

static bool draw_masks(const Regression *regression, const RegressionFrame *frame, const Image *expected,
                       uint8_t *masked, Error *error) {
    const Mask *mask = regression->options.mask;
    const char *path = frame->at[EXPECTED]->path;
    return (mask == NULL || mask_draw(mask, expected, path, masked, error)) &&
           rules_draw_masks(regression->rules, frame_name(frame), expected, path, masked, error);
}

static void cut_mask(uint8_t *masked, int width, const Image *to) {
    for (int y = 0; y < to->height && to->width < width; y++)
        memmove(masked + (size_t)y * (size_t)to->width, masked + (size_t)y * (size_t)width, (size_t)to->width);
}

bool tolerance_mark(const Tolerance *tolerance, const Image *expected, const Image *actual, uint8_t *masked,
                    Error *error) {
    if (tolerance->antialias && !antialias_mark(expected, actual, masked, error)) return false;
    if (tolerance->shift > 0) shift_mark(expected, actual, tolerance->shift, tolerance->tolerance, masked);
    return true;
}

static bool mark_allowed(const Regression *regression, const RegressionFrame *frame, const Image *expected,
                         const Image *actual, uint8_t *masked, Error *error) {
    const Tolerance tolerance = regression_tolerance(regression, frame);
    return rules_mark_regions(regression->rules, frame_name(frame), expected, actual, masked, error) &&
           tolerance_mark(&tolerance, expected, actual, masked, error);
}

bool regression_ignore(const Regression *regression, const RegressionFrame *frame, Image *expected, Image *actual,
                       uint8_t **masked, Error *error) {
    const Tolerance tolerance = regression_tolerance(regression, frame);
    bool masks = has_masks(regression, frame),
         allowed = tolerance.antialias || tolerance.shift > 0 || has_regions(regression, frame);
    int width = expected->width;
    *masked = NULL;
    if ((masks || allowed) && (*masked = calloc((size_t)width * (size_t)expected->height, 1)) == NULL)
        return error_memory(error, frame_name(frame));
    if (masks && !draw_masks(regression, frame, expected, *masked, error)) {
        free(*masked);
        *masked = NULL;
        return false;
    }
    image_cut_to_overlap(expected, actual);
    if (masks) cut_mask(*masked, width, expected);
    if (!allowed || mark_allowed(regression, frame, expected, actual, *masked, error)) return true;
    free(*masked);
    *masked = NULL;
    return false;
}

/* Whether width and height differ by at most this. */
static bool near_size(const RegressionFrame *frame, int most) {
    const RegressionFile *a = &frame->files[EXPECTED], *b = &frame->files[ACTUAL];
    return abs(a->width - b->width) <= most && abs(a->height - b->height) <= most;
}

bool regression_accepts_size(const Regression *regression, const RegressionFrame *frame) {
    return near_size(frame, regression_tolerance(regression, frame).size);
}

void regression_compare(const Regression *regression, RegressionFrame *frame, const Image *expected,
                        const Image *actual, const uint8_t *masked) {
    ImageDifference *difference = &frame->difference;
    int tolerance = regression_tolerance(regression, frame).tolerance;
    image_compare_masked(expected, actual, masked, tolerance, difference);
    difference->same_size = near_size(frame, 0);
    difference->equal = difference->equal && difference->same_size;
}

/* Ignored pixels count as equal. */
static bool limits_measure(RegressionFrame *frame, const Image *expected, Image *actual, const uint8_t *masked,
                           Error *error) {
    FlipSummary flip;
    image_copy_masked(expected, actual, masked);
    if (!flip_compare(expected, actual, FLIP_PIXELS_PER_DEGREE, NULL, &flip, error)) return false;
    frame->flip = flip.mean, frame->flip_p99 = flip.p99;
    return true;
}

bool regression_decide(const Regression *regression, RegressionFrame *frame, const Image *expected, Image *actual,
                       const uint8_t *masked, Error *error) {
    const ImageDifference *difference = &frame->difference;
    const Tolerance tolerance = regression_tolerance(regression, frame);
    const bool resized = !difference->same_size && !regression_accepts_size(regression, frame);
    if ((resized || difference->pixels > 0) && (tolerance.given & LIMITS_FLIP) != 0 &&
        !limits_measure(frame, expected, actual, masked, error))
        return false;
    if (resized)
        frame->pixels = PIXELS_RESIZED;
    else if (difference->pixels == 0)
        frame->pixels = difference->moved > 0 || !difference->same_size ? PIXELS_WITHIN : PIXELS_EQUAL;
    else
        frame->pixels = tolerance_holds(&tolerance, difference, &(FlipSummary){frame->flip, frame->flip_p99})
                            ? PIXELS_WITHIN
                            : PIXELS_DIFFER;
    return true;
}

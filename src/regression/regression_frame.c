/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "regression/regression_frame.h"

#include "common/hash.h"
#include "image/png_check.h"
#include "regression/regression_changes.h"
#include "regression/regression_limits.h"
#include "regression/regression_states.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

static bool judge_pixels(Regression *regression, RegressionFrame *frame, uint8_t *const data[SIDES],
                         Image *const images[SIDES], Error *error) {
    Image *expected = images[EXPECTED], *actual = images[ACTUAL];
    uint8_t *masked;
    if (!regression_ignore(regression, frame, expected, actual, &masked, error)) return false;
    regression_compare(regression, frame, expected, actual, masked);
    bool hidden = frame->difference.counted == 0 && frame->difference.same_size;
    bool ok = hidden
                  ? error_input(error, frame->at[EXPECTED]->path, "the masks hide all its pixels: nothing is compared")
                  : regression_decide(regression, frame, expected, actual, masked, error);
    if (ok && frame->difference.pixels > 0)
        ok = regression_find_changes(regression, frame, data, (const Image *const[SIDES]){expected, actual}, masked,
                                     error);
    free(masked);
    return ok;
}

static bool decode_and_judge(Regression *regression, RegressionFrame *frame, uint8_t *const data[SIDES], Error *error) {
    Image *images[SIDES];
    RegressionFile *files = frame->files;
    bool ok = image_decode_png_pair((const uint8_t *const[]){data[EXPECTED], data[ACTUAL]},
                                    (const size_t[]){files[EXPECTED].size, files[ACTUAL].size},
                                    (const char *const[]){frame->at[EXPECTED]->path, frame->at[ACTUAL]->path},
                                    regression->options.max_pixels, images, error);
    for (RegressionSide side = EXPECTED; ok && side < SIDES; side++)
        files[side].width = images[side]->width, files[side].height = images[side]->height;
    ok = ok && judge_pixels(regression, frame, data, images, error);
    image_destroy_pair(images);
    return ok;
}

/* A missing or extra frame is decoded too, to detect damaged files. */
static bool judge_alone(const RegressionOptions *options, RegressionFrame *frame, RegressionSide side,
                        const uint8_t *data, Error *error) {
    assert(frame->at[side] != NULL);
    RegressionFile *file = &frame->files[side];
    Image *image = image_decode_png(data, file->size, frame->at[side]->path, options->max_pixels, error);
    if (image == NULL) return false;
    file->width = image->width, file->height = image->height;
    image_destroy(image);
    frame->pixels = side == EXPECTED ? PIXELS_MISSING : PIXELS_EXTRA;
    return true;
}

/* Decoded only to find out whether the masks hide everything: that must not stay unknown until something changes. */
static bool judge_same_bytes(Regression *regression, RegressionFrame *frame, uint8_t *const data[SIDES], Error *error) {
    RegressionFile *a = &frame->files[EXPECTED], *b = &frame->files[ACTUAL];
    if (!png_check(data[EXPECTED], a->size, frame->at[EXPECTED]->path, &a->width, &a->height, error)) return false;
    b->width = a->width, b->height = a->height;
    if (regression_may_hide_all(regression, frame, a->width, a->height))
        return decode_and_judge(regression, frame, data, error);
    frame->pixels = PIXELS_EQUAL;
    frame->difference = (ImageDifference){.equal = true, .same_size = true, .first_x = -1, .first_y = -1};
    return true;
}

/* Whether the overlap is so small a part of the larger picture that it says nothing; and decoding both would let a small
   file cost what the largest picture costs. */
static bool is_far(const RegressionFile *a, const RegressionFile *b) {
    const int64_t LEAST_PART = 16;
    const int64_t width = a->width < b->width ? a->width : b->width,
                  height = a->height < b->height ? a->height : b->height;
    const int64_t of_a = (int64_t)a->width * a->height, of_b = (int64_t)b->width * b->height;
    return width * height < (of_a > of_b ? of_a : of_b) / LEAST_PART;
}

/* By the headers alone. False: the pictures have to be decoded, or cannot. */
static bool have_far_sizes(RegressionFrame *frame, uint8_t *const data[SIDES]) {
    for (RegressionSide side = EXPECTED; side < SIDES; side++) {
        RegressionFile *file = &frame->files[side];
        if (!png_size(data[side], file->size, &file->width, &file->height)) return false;
    }
    return is_far(&frame->files[EXPECTED], &frame->files[ACTUAL]);
}

static bool judge_sizes(const Regression *regression, RegressionFrame *frame, uint8_t *const data[SIDES],
                        Error *error) {
    for (RegressionSide side = EXPECTED; side < SIDES; side++) {
        RegressionFile *file = &frame->files[side];
        const char *path = frame->at[side]->path;
        if (!png_check(data[side], file->size, path, &file->width, &file->height, error) ||
            !png_check_pixels(file->width, file->height, regression->options.max_pixels, path, error))
            return false;
    }
    frame->pixels = PIXELS_RESIZED;
    frame->sizes_alone = true;
    frame->difference = (ImageDifference){.first_x = -1, .first_y = -1};
    return true;
}

static bool judge(Regression *regression, RegressionFrame *frame, uint8_t *const data[SIDES], Error *error) {
    const RegressionOptions *options = &regression->options;
    for (RegressionSide side = EXPECTED; side < SIDES; side++)
        if (data[1 - side] == NULL) return judge_alone(options, frame, side, data[side], error);
    if (!regression_judge_states(regression, frame, data, error)) return false;
    const RegressionFile *a = &frame->files[EXPECTED], *b = &frame->files[ACTUAL];
    if (a->size == b->size && memcmp(data[EXPECTED], data[ACTUAL], a->size) == 0)
        return judge_same_bytes(regression, frame, data, error);
    if (!png_display_compare(data[EXPECTED], a->size, data[ACTUAL], b->size, &frame->metadata, error)) return false;
    frame->metadata_failed = options->strict_metadata && frame->metadata.text[0] != '\0';
    return have_far_sizes(frame, data) ? judge_sizes(regression, frame, data, error)
                                       : decode_and_judge(regression, frame, data, error);
}

static bool compare_files(Regression *regression, RegressionFrame *frame, Error *error) {
    uint8_t *data[SIDES] = {NULL, NULL};
    bool ok = true;
    for (RegressionSide side = EXPECTED; ok && side < SIDES; side++) {
        if (frame->at[side] == NULL) continue;
        RegressionFile *file = &frame->files[side];
        ok = (data[side] = image_load_png(frame->at[side]->path, &file->size, error)) != NULL;
        if (ok) file->hash = hash_xxh3(data[side], file->size);
    }
    ok = ok && judge(regression, frame, data, error);
    for (RegressionSide side = EXPECTED; side < SIDES; side++) free(data[side]);
    return ok;
}

static bool is_closer(const RegressionFrame *a, const RegressionFrame *b) {
    const ImageDifference *x = &a->difference, *y = &b->difference;
    if (frame_failed(a) != frame_failed(b)) return frame_failed(b);
    if (x->same_size != y->same_size) return x->same_size;
    return x->pixels != y->pixels ? x->pixels < y->pixels : x->largest < y->largest;
}

bool regression_compare_frame(Regression *regression, RegressionFrame *frame, Error *error) {
    const RegressionFrame fresh = *frame;
    if (!compare_files(regression, frame, error)) return false;
    for (const SequenceFrame *other = frame->base->next; other != NULL && frame_failed(frame); other = other->next) {
        RegressionFrame attempt = fresh;
        attempt.at[EXPECTED] = other;
        bool ok = compare_files(regression, &attempt, error), closer = ok && is_closer(&attempt, frame);
        free(closer ? frame->changes : attempt.changes);
        if (closer) *frame = attempt;
        if (!ok) return false;
    }
    return true;
}

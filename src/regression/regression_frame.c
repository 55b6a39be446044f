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
    return decode_and_judge(regression, frame, data, error);
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

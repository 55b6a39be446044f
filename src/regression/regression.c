/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "regression/regression.h"

#include "common/clock.h"
#include "common/parallel.h"
#include "regression/regression_causes.h"
#include "regression/regression_frame.h"
#include "regression/regression_limits.h"
#include "regression/regression_states.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* If a frame cannot be read, the others are still compared: the reported error must not depend on the threads. */
static bool compare_frame(void *context, int i, Error *error) {
    Regression *regression = context;
    RegressionFrame *frame = &regression->frames[i];
    const double begun = clock_seconds();
    Error read_error = {0};
    bool ok = regression_compare_frame(regression, frame, &read_error);
    frame->seconds = clock_seconds() - begun;
    if (!ok && read_error.kind == ERROR_INPUT && (frame->read_error = strdup(read_error.message)) != NULL) return true;
    if (!ok) *error = read_error;
    return ok;
}

static bool report_read_errors(const Regression *regression, Error *error) {
    int first = -1, count = 0;
    for (int i = regression->count - 1; i >= 0; i--)
        if (regression->frames[i].read_error != NULL) first = i, count++;
    if (first < 0) return true;
    error->kind = ERROR_INPUT;
    snprintf(error->message, sizeof error->message, "%s", regression->frames[first].read_error);
    if (count > 1) error_add(error, "\n(further frames that cannot be compared: %d)", count - 1);
    return false;
}

bool frame_failed(const RegressionFrame *frame) {
    return frame->pixels >= PIXELS_DIFFER || frame->states == STATES_DIFFER || frame->metadata_failed;
}

static void count_first(int *count, int *first, int i) {
    (*count)++;
    if (*first < 0) *first = i;
}

static void count_frame(Regression *regression, int i) {
    const RegressionFrame *frame = &regression->frames[i];
    bool pictures = frame->pixels == PIXELS_DIFFER || frame->pixels == PIXELS_RESIZED;
    regression->by_verdict[frame->pixels]++;
    if (frame_failed(frame)) count_first(&regression->failed, &regression->first, i);
    if (frame->states == STATES_DIFFER) count_first(&regression->physics, &regression->first_physics, i);
    bool view = pictures && frame->other_view && frame->states != STATES_DIFFER;
    regression->view += view;
    regression->elsewhere += pictures && !view && frame->states == STATES_DIFFER_ELSEWHERE;
    if (pictures && !view && frame->states == STATES_EQUAL)
        count_first(&regression->renderer, &regression->first_renderer, i);
    regression->unknown += pictures && !view && frame->states == STATES_UNKNOWN;
    if (frame->metadata.text[0] != '\0') count_first(&regression->metadata, &regression->first_metadata, i);
    regression->metadata_failed += frame->metadata_failed && !pictures && frame->states != STATES_DIFFER;
    regression->other_accepted += !frame_failed(frame) && frame->at[EXPECTED] != frame->base;
}

static bool same_sequence(const RegressionFrame *a, const RegressionFrame *b) {
    return sequence_compare_stems(a->base, b->base) == 0;
}

/* Sets STATES_DIFFER_ELSEWHERE (see StateVerdict) in the frames of one sequence. */
static void judge_sequence(RegressionFrame *const *frames, int count) {
    bool physics = false, same_framing = false;
    for (int i = 0; i < count; i++) {
        physics = physics || frames[i]->run_differs || frames[i]->states == STATES_DIFFER;
        bool same = frames[i]->at[EXPECTED] == frames[i]->base && frames[i]->pixels == PIXELS_EQUAL;
        same_framing = same_framing || (same && frames[i]->states == STATES_EQUAL);
    }
    for (int i = 0; physics && !same_framing && i < count; i++)
        if (frames[i]->states == STATES_EQUAL) frames[i]->states = STATES_DIFFER_ELSEWHERE;
}

/* Ignores missing and extra frames; their names may have another stem. */
static bool judge_sequences(Regression *regression, Error *error) {
    RegressionFrame **paired = malloc(((size_t)regression->count + 1) * sizeof *paired);
    if (paired == NULL) return error_memory(error, "frames");
    int count = 0;
    for (int i = 0; i < regression->count; i++)
        if (regression->frames[i].pixels < PIXELS_MISSING) paired[count++] = &regression->frames[i];
    for (int first = 0, end = 0; first < count; first = end) {
        while (end < count && same_sequence(paired[first], paired[end])) end++;
        judge_sequence(paired + first, end - first);
    }
    free(paired);
    return true;
}

static void count(Regression *regression) {
    regression->first = regression->first_physics = regression->first_renderer = regression->first_run = -1;
    regression->first_metadata = -1;
    for (int i = 0; i < regression->count; i++) count_frame(regression, i);
    for (int i = 0; i < regression->run_count; i++) {
        const RegressionRun *runs = regression->runs;
        if (runs[i].difference.equal) continue;
        regression->run_failed++;
        int first = regression->first_run;
        if (first < 0 || (unsigned)runs[i].difference.frame < (unsigned)runs[first].difference.frame)
            regression->first_run = i;
    }
}

static bool pair_frames(Regression *regression, Error *error) {
    SequencePair *pairs =
        image_sequence_pair(regression->sequences[EXPECTED], regression->sequences[ACTUAL], &regression->count, error);
    if (pairs == NULL) return false;
    regression->frames = calloc((size_t)regression->count + 1, sizeof *regression->frames);
    for (int i = 0; regression->frames != NULL && i < regression->count; i++)
        regression->frames[i] = (RegressionFrame){.base = pairs[i].a != NULL ? pairs[i].a : pairs[i].b,
                                                  .at = {pairs[i].a, pairs[i].b},
                                                  .flip = NAN,
                                                  .flip_p99 = NAN};
    free(pairs);
    return regression->frames != NULL || error_memory(error, "frames");
}

/* A folder without pictures is an error, not a difference, unless neither has any and trajectories are compared. */
static bool refuse_empty(const Regression *regression, Error *error) {
    bool runs_alone = regression->count == 0 && regression->run_count > 0;
    for (RegressionSide side = EXPECTED; side < SIDES; side++) {
        const ImageSequence *sequence = regression->sequences[side];
        if (sequence->count == 0 && !runs_alone)
            return error_input(error, sequence->folder, "no PNG files (such as frame_000000.png) in this folder%s",
                               sequence->skipped > 0 ? ", only in its subfolders" : "");
    }
    return true;
}

bool regression_run(Regression *regression, const char *expected, const char *actual, const RegressionOptions *options,
                    const Progress *progress, Error *error) {
    *regression = (Regression){.options = *options};
    const double begun = clock_seconds();
    const ParallelWork work = {compare_frame, regression};
    bool ok = (regression->sequences[EXPECTED] = image_sequence_open(expected, !options->flat, error)) != NULL &&
              (regression->sequences[ACTUAL] = image_sequence_open(actual, !options->flat, error)) != NULL &&
              pair_frames(regression, error) && regression_find_runs(regression, error) &&
              refuse_empty(regression, error) && regression_read_rules(regression, error) &&
              parallel_for(&work, regression->count, actual, progress, error) &&
              report_read_errors(regression, error) && judge_sequences(regression, error);
    if (ok) count(regression);
    ok = ok && regression_measure_first(regression, error) && regression_find_causes(regression, error);
    regression->seconds = clock_seconds() - begun;
    if (!ok) regression_free(regression);
    return ok;
}

void regression_free(Regression *regression) {
    for (int i = 0; i < regression->run_count; i++) {
        free(regression->runs[i].name);
        free(regression->runs[i].differs);
    }
    for (int i = 0; regression->frames != NULL && i < regression->count; i++) {
        free(regression->frames[i].read_error);
        free(regression->frames[i].changes);
    }
    free(regression->frames);
    free(regression->runs);
    free(regression->causes);
    shown_free(&regression->shown);
    rules_destroy(regression->rules);
    for (RegressionSide side = EXPECTED; side < SIDES; side++) image_sequence_close(regression->sequences[side]);
    *regression = (Regression){0};
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The causes of failed frames: a view, states that differ, a body or another part that changed; each with its
   frames. */
#include "base/base.h"
#include "regression/naming.h"
#include "regression/regression.h"
#include "regression/regression_internal.h"
#include "regression/sequence.h"
#include "regression/view.h"
#include "runs/trajectory.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Adds a frame to a cause. Frames are added in order, and neighbours form a range. */
static void add(Regression *regression, int frame, const char *what, double most, bool of_view) {
    const RegressionFrame *at = &regression->frames[frame];
    int i = 0;
    while (i < regression->cause_count && strcmp(regression->causes[i].what, what) != 0) i++;
    if (i == CAUSES_MAX) {
        regression->causes_left_out++;
        return;
    }
    RegressionCause *cause = &regression->causes[i];
    if (i == regression->cause_count) {
        *cause = (RegressionCause){.of_view = of_view, .order = i};
        snprintf(cause->what, sizeof cause->what, "%s", what);
        regression->cause_count++;
    }
    cause->most = fmax(cause->most, most);
    if (cause->count > 0 && cause->last == frame) return;
    const bool next =
        cause->count++ > 0 && frame == cause->last + 1 && !at->alone && sequence_same(at[-1].base, at->base);
    cause->last = frame;
    if (!next && cause->range_count++ < CAUSE_RANGES) cause->ranges[cause->range_count - 1][0] = frame;
    if (cause->range_count <= CAUSE_RANGES) cause->ranges[cause->range_count - 1][1] = frame;
}

/* A picture that is a case of its own says what differs in its own words. */
static void add_causes(Regression *regression, int frame) {
    const RegressionFrame *at = &regression->frames[frame];
    const FrameChanges *changes = at->changes;
    if (at->pixels >= PIXELS_MISSING || !frame_failed(at)) return;
    if (at->pixels == PIXELS_RESIZED && !at->alone) add(regression, frame, "sizes differ", 0, false);
    if ((at->pixels == PIXELS_DIFFER || at->pixels == PIXELS_RESIZED) && at->other_view) {
        ShownFolder *folders[SIDES];
        for (RegressionSide side = EXPECTED; side < SIDES; side++)
            folders[side] = shown_find(&regression->shown, at->at[side]->path, &(Error){0}); /* known by now */
        if (folders[EXPECTED] != NULL && folders[ACTUAL] != NULL) {
            const ViewText words = view_difference(&folders[EXPECTED]->view, &folders[ACTUAL]->view);
            char what[sizeof regression->causes->what];
            snprintf(what, sizeof what, "%s; render with --view-from %s%s", words.text, folders[EXPECTED]->path,
                     folders[EXPECTED]->view.panels[0].run);
            add(regression, frame, what, 0, true);
        }
    }
    if (at->states == STATES_DIFFER && !at->alone) {
        char what[96] = "states differ";
        const TrajectoryDifference *first =
            regression->first_run >= 0 ? &regression->runs[regression->first_run].difference : NULL;
        if (first != NULL && first->body >= 0)
            snprintf(what, sizeof what, "states differ, body %d first", first->body);
        else if (first == NULL && at->panel > 0)
            snprintf(what, sizeof what, "states differ in panel %d", at->panel);
        add(regression, frame, what, 0, false);
    }
    if (at->states == STATES_DIFFER || at->pixels != PIXELS_DIFFER || at->other_view) return;
    for (int i = 0; changes != NULL && i < changes->count; i++) {
        const Change *change = &changes->list[i];
        add(regression, frame, change_cause(change).text,
            change->kind == CHANGE_MOVED ? fmax(fabs(change->right), fabs(change->up)) : 0, false);
    }
    if ((changes == NULL || changes->count == 0) && !at->alone) add(regression, frame, "pixels differ", 0, false);
}

/* "frame 3", but "frames 3 to 5"; the number if there are too many ranges. */
static void put_frames(const Regression *regression, bool numbered, RegressionCause *cause) {
    const char *before = !numbered ? "" : cause->count == 1 ? "frame " : "frames ";
    for (int i = 0; i < cause->range_count && i < CAUSE_RANGES; i++)
        for (int end = 0; end < (cause->ranges[i][1] > cause->ranges[i][0] ? 2 : 1); end++) {
            const RegressionFrame *at = &regression->frames[cause->ranges[i][end]];
            text_add(cause->frames, sizeof cause->frames, "%s", end == 1 ? " to " : i == 0 ? before : ", ");
            if (numbered)
                text_add(cause->frames, sizeof cause->frames, "%" PRId64, at->at[EXPECTED]->number);
            else
                text_add(cause->frames, sizeof cause->frames, "%.40s", frame_name(at));
        }
    if (cause->range_count > CAUSE_RANGES)
        text_add(cause->frames, sizeof cause->frames, " ... (%d frames)", cause->count);
}

static int view_first(const void *a, const void *b) {
    const RegressionCause *x = a, *y = b;
    if (x->of_view != y->of_view) return x->of_view ? -1 : 1;
    return x->order - y->order;
}

bool regression_find_causes(Regression *regression, Error *error) {
    regression->causes = calloc(CAUSES_MAX, sizeof *regression->causes);
    if (regression->causes == NULL) return error_memory(error, "causes");
    for (int i = 0; i < regression->count; i++) add_causes(regression, i);
    /* If all frames belong to one sequence of numbered pictures, numbers are enough. */
    const SequenceFrame *first = NULL;
    bool numbered = true;
    for (int i = 0; i < regression->count; i++) {
        const SequenceFrame *at = regression->frames[i].at[EXPECTED];
        if (first == NULL) first = at;
        numbered = numbered && (at == NULL || sequence_same(at, first));
    }
    numbered = numbered && first != NULL;
    for (int i = 0; i < regression->cause_count; i++) put_frames(regression, numbered, &regression->causes[i]);
    qsort(regression->causes, (size_t)regression->cause_count, sizeof *regression->causes, view_first);
    return true;
}

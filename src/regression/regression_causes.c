/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "regression/regression_causes.h"

#include "common/text_add.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { RANGES = 4 };

typedef struct Causes {
    Regression *regression;
    bool numbered; /* all frames belong to one sequence of numbered pictures */
} Causes;

static bool is_numbered(const Regression *regression) {
    const SequenceFrame *first = NULL;
    for (int i = 0; i < regression->count; i++) {
        const SequenceFrame *at = regression->frames[i].at[EXPECTED];
        if (at == NULL) continue;
        if (first == NULL) first = at;
        if (at->number < 0 || at->stem != first->stem || memcmp(at->name, first->name, (size_t)at->stem) != 0)
            return false;
    }
    return first != NULL;
}

static void put_name(const Causes *causes, RegressionCause *cause, int frame) {
    const RegressionFrame *at = &causes->regression->frames[frame];
    if (causes->numbered)
        text_add(cause->frames, sizeof cause->frames, "%" PRId64, at->at[EXPECTED]->number);
    else
        text_add(cause->frames, sizeof cause->frames, "%.40s", frame_name(at));
}

/* Adds a frame; frames are added in order. Neighbours form a range. */
static void add_frame(const Causes *causes, RegressionCause *cause, int frame) {
    bool next = cause->count > 0 && frame == cause->last + 1;
    cause->last = frame;
    if (cause->count++ == 0 && causes->numbered) text_add(cause->frames, sizeof cause->frames, "frame ");
    if (next && cause->ranges <= RANGES) {
        cause->frames[cause->written] = '\0';
        text_add(cause->frames, sizeof cause->frames, " to ");
        put_name(causes, cause, frame);
        return;
    }
    if (!next && ++cause->ranges == RANGES + 1) text_add(cause->frames, sizeof cause->frames, " ...");
    if (next || cause->ranges > RANGES) return;
    if (cause->ranges > 1) text_add(cause->frames, sizeof cause->frames, ", ");
    put_name(causes, cause, frame);
    cause->written = (int)strlen(cause->frames);
}

/* "frame 3", but "frames 3 to 5"; the number if there are too many ranges. */
static void finish(const Causes *causes, RegressionCause *cause) {
    char whole[sizeof cause->frames];
    if (cause->ranges > RANGES) text_add(cause->frames, sizeof cause->frames, " (%d frames)", cause->count);
    if (!causes->numbered || cause->count == 1) return;
    snprintf(whole, sizeof whole, "frames%.*s", (int)sizeof whole - 7, cause->frames + strlen("frame"));
    memcpy(cause->frames, whole, sizeof whole);
}

static void add_cause(const Causes *causes, int frame, const char *what, double most, bool of_view) {
    Regression *regression = causes->regression;
    int at = 0;
    while (at < regression->cause_count && strcmp(regression->causes[at].what, what) != 0) at++;
    if (at == CAUSES_MAX) {
        regression->causes_left_out++;
        return;
    }
    RegressionCause *cause = &regression->causes[at];
    if (at == regression->cause_count) {
        *cause = (RegressionCause){.of_view = of_view, .last = -2};
        snprintf(cause->what, sizeof cause->what, "%s", what);
        regression->cause_count++;
    }
    cause->most = fmax(cause->most, most);
    if (cause->count == 0 || cause->last != frame) add_frame(causes, cause, frame);
}

static void add_view(const Causes *causes, int frame) {
    const RegressionFrame *at = &causes->regression->frames[frame];
    const ShownFolder *folders[SIDES];
    for (RegressionSide side = EXPECTED; side < SIDES; side++)
        folders[side] = shown_find(&causes->regression->shown, at->at[side]->path);
    if (folders[EXPECTED] == NULL || folders[ACTUAL] == NULL) return;
    ViewText words = view_difference(&folders[EXPECTED]->view, &folders[ACTUAL]->view);
    char what[sizeof causes->regression->causes->what];
    snprintf(what, sizeof what, "%s; render with --view-from %s%s", words.text, folders[EXPECTED]->path,
             folders[EXPECTED]->view.panels[0].run);
    add_cause(causes, frame, what, 0, true);
}

static void add_physics(const Causes *causes, int frame) {
    const Regression *regression = causes->regression;
    const RegressionFrame *at = &regression->frames[frame];
    char what[96] = "states differ";
    const TrajectoryDifference *first =
        regression->first_run >= 0 ? &regression->runs[regression->first_run].difference : NULL;
    if (first != NULL && first->body >= 0)
        snprintf(what, sizeof what, "states differ, body %d first", first->body);
    else if (first == NULL && at->panel > 0)
        snprintf(what, sizeof what, "states differ in panel %d", at->panel);
    add_cause(causes, frame, what, 0, false);
}

/* The named changes, or that there is a difference. */
static void add_changes(const Causes *causes, int frame) {
    const FrameChanges *changes = causes->regression->frames[frame].changes;
    bool named = changes != NULL && changes->count > 0;
    for (int i = 0; named && i < changes->count; i++) {
        const Change *change = &changes->list[i];
        double most = change->kind == CHANGE_MOVED ? fmax(fabs(change->right), fabs(change->up)) : 0;
        add_cause(causes, frame, change_cause(change).text, most, false);
    }
    if (!named) add_cause(causes, frame, "pixels differ", 0, false);
}

static void add_causes(const Causes *causes, int frame) {
    const RegressionFrame *at = &causes->regression->frames[frame];
    bool pictures = at->pixels == PIXELS_DIFFER || at->pixels == PIXELS_RESIZED;
    if (at->pixels >= PIXELS_MISSING) return;
    if (at->pixels == PIXELS_RESIZED) add_cause(causes, frame, "sizes differ", 0, false);
    if (pictures && at->other_view) add_view(causes, frame);
    if (at->states == STATES_DIFFER)
        add_physics(causes, frame);
    else if (at->pixels == PIXELS_DIFFER && !at->other_view)
        add_changes(causes, frame);
}

static int view_first(const void *a, const void *b) {
    const RegressionCause *x = a, *y = b;
    if (x->of_view != y->of_view) return x->of_view ? -1 : 1;
    return x->ranges - y->ranges; /* `ranges` holds the order of discovery here */
}

bool regression_find_causes(Regression *regression, Error *error) {
    const Causes causes = {regression, is_numbered(regression)};
    regression->causes = calloc(CAUSES_MAX, sizeof *regression->causes);
    if (regression->causes == NULL) return error_memory(error, "causes");
    for (int i = 0; i < regression->count; i++) add_causes(&causes, i);
    for (int i = 0; i < regression->cause_count; i++) {
        finish(&causes, &regression->causes[i]);
        regression->causes[i].ranges = i;
    }
    qsort(regression->causes, (size_t)regression->cause_count, sizeof *regression->causes, view_first);
    return true;
}

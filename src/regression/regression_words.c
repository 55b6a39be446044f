/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The results of a comparison as text. */
#include "regression/regression.h"

#include <inttypes.h>
#include <stdarg.h>
#include <string.h>

bool regression_passed(const Regression *regression) { return regression->failed == 0 && regression->run_failed == 0; }

const char *frame_name(const RegressionFrame *frame) { return frame->base->name; }

const char *frame_verdict(const RegressionFrame *frame) {
    switch (frame->pixels) {
    case PIXELS_MISSING: return "missing";
    case PIXELS_EXTRA: return "extra";
    case PIXELS_DIFFER:
    case PIXELS_RESIZED:
        if (frame->states == STATES_DIFFER) return "physics changed";
        if (frame->other_view) return "view changed";
        if (frame->states == STATES_UNKNOWN) return "pictures differ";
        return frame->states == STATES_EQUAL ? "renderer changed" : "run changed";
    case PIXELS_EQUAL:
    case PIXELS_WITHIN: break;
    }
    if (frame->states == STATES_DIFFER) return "physics changed";
    if (frame->metadata_failed) return "metadata changed";
    return frame->pixels == PIXELS_EQUAL ? "equal" : "within tolerance";
}

static void add(RegressionText *text, const char *between, const char *format, ...) PRINTF_LIKE(3, 4);
static void add(RegressionText *text, const char *between, const char *format, ...) {
    size_t used = strlen(text->text);
    va_list arguments;
    va_start(arguments, format);
    if (used > 0) {
        snprintf(text->text + used, sizeof text->text - used, "%s", between);
        used = strlen(text->text);
    }
    vsnprintf(text->text + used, sizeof text->text - used, format, arguments);
    va_end(arguments);
}

/* The name of the largest region that has one. */
static void add_changes(RegressionText *words, const RegressionFrame *frame) {
    const FrameChanges *changes = frame->changes;
    for (int i = 0; changes != NULL && i < changes->regions.kept; i++) {
        if (changes->region_change[i] < 0) continue;
        int others = changes->count - 1;
        add(words, ": ", "%s", change_words(&changes->list[changes->region_change[i]]).text);
        if (others > 0) add(words, ", ", "and %d more %s", others, others == 1 ? "change" : "changes");
        return;
    }
}

static void add_difference(RegressionText *words, const ImageDifference *difference) {
    if (difference->pixels == 0)
        add(words, "", "equal pixels");
    else
        add(words, "", "%" PRId64 " %s (%.3g%%) by at most %d, first at (%d, %d)", difference->pixels,
            difference->pixels == 1 ? "pixel differs" : "pixels differ",
            100 * (double)difference->pixels / (double)difference->counted, difference->largest, difference->first_x,
            difference->first_y);
    if (difference->moved > 0)
        add(words, "; ", "%" PRId64 " %s of edges ignored", difference->moved,
            difference->moved == 1 ? "pixel" : "pixels");
}

RegressionText frame_words(const RegressionFrame *frame) {
    RegressionText words = {""};
    const ImageDifference *difference = &frame->difference;
    const RegressionFile *a = &frame->files[EXPECTED], *b = &frame->files[ACTUAL];
    switch (frame->pixels) {
    case PIXELS_MISSING: add(&words, "", "no actual picture"); break;
    case PIXELS_EXTRA: add(&words, "", "no expected picture"); break;
    case PIXELS_RESIZED:
        add(&words, "", "sizes differ: %d x %d and %d x %d pixels", a->width, a->height, b->width, b->height);
        if (frame->sizes_alone) break;
        add(&words, "; ", "overlap: ");
        add_difference(&words, difference);
        break;
    case PIXELS_EQUAL: add(&words, "", "equal pixels"); break;
    case PIXELS_WITHIN:
    case PIXELS_DIFFER: add_difference(&words, difference);
    }
    if (frame->panel > 0) add(&words, ", ", "states differ in panel %d", frame->panel);
    if (frame->other_view && frame->states != STATES_DIFFER)
        add(&words, ", ", "the camera differs");
    else if (frame->states == STATES_DIFFER_ELSEWHERE && frame_failed(frame))
        add(&words, ", ", "states equal in this frame but not in the whole run, which sets camera and scales");
    add_changes(&words, frame);
    if (frame->metadata.text[0] != '\0') add(&words, ", ", "metadata differs: %s", frame->metadata.text);
    if (frame->at[EXPECTED] != NULL && frame->at[EXPECTED] != frame->base)
        add(&words, "; ", frame_failed(frame) ? "closest accepted picture: %s" : "accepted picture: %s",
            frame->at[EXPECTED]->name + frame->at[EXPECTED]->folder);
    return words;
}

RegressionText cause_words(const RegressionCause *cause) {
    RegressionText words = {""};
    add(&words, "", "%s: %s", cause->frames, cause->what);
    if (cause->most > 0)
        add(&words, " ", "at most %.*f px", cause->most < 0.1 ? 2 : cause->most < 9.95 ? 1 : 0, cause->most);
    return words;
}

RegressionText run_words(const RegressionRun *run) {
    RegressionText words = {""};
    const TrajectoryDifference *d = &run->difference;
    if (d->equal) {
        add(&words, "", "equal states");
        return words;
    }
    if (d->what[0] != '\0') add(&words, "", "%s", d->what);
    if (d->frame >= 0)
        add(&words, "; ", "from frame %d, body %d: %g m apart, %g rad, %g m/s", d->frame, d->body, d->distance,
            d->angle, d->speed);
    if (d->max_frame >= 0)
        add(&words, "; ", "farthest in frame %d, body %d: %g m", d->max_frame, d->max_body, d->max_distance);
    return words;
}

static void add_count(RegressionText *text, int count, const char *what) {
    if (count > 0) add(text, ", ", "%d %s %s", count, count == 1 ? "frame" : "frames", what);
}

RegressionText regression_verdict(const Regression *regression) {
    RegressionText verdict = {""};
    bool physics = regression->physics > 0 || regression->elsewhere > 0 || regression->run_failed > 0;
    bool renderer = regression->renderer > 0;
    if (physics || renderer)
        add(&verdict, ", ", "%s",
            physics && renderer ? "physics and renderer changed"
            : physics           ? "physics changed"
                                : "renderer changed");
    if (regression->view > 0 && !physics) add(&verdict, ", ", "view changed");
    if (regression->unknown > 0) add(&verdict, ", ", "pictures differ (cause unknown: no states)");
    if (regression->metadata_failed > 0) add(&verdict, ", ", "metadata changed");
    add_count(&verdict, regression->by_verdict[PIXELS_MISSING], "missing");
    add_count(&verdict, regression->by_verdict[PIXELS_EXTRA], "extra");
    if (verdict.text[0] == '\0') add(&verdict, "", "equal");
    return verdict;
}

RegressionText regression_begin(const Regression *regression) {
    RegressionText begin = {""};
    if (regression->first_run >= 0) {
        const RegressionRun *run = &regression->runs[regression->first_run];
        add(&begin, "\n", "physics changed first in %s: %s", run->name, run_words(run).text);
    } else if (regression->first_physics >= 0) {
        const RegressionFrame *frame = &regression->frames[regression->first_physics];
        add(&begin, "\n", "physics changed first in %s, panel %d", frame_name(frame), frame->panel);
    }
    if (regression->first_renderer >= 0)
        add(&begin, "\n", "renderer changed first in %s", frame_name(&regression->frames[regression->first_renderer]));
    return begin;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The results of a comparison as text. */
#include "base/base.h"
#include "pixels/png.h"
#include "regression/compare.h"
#include "regression/internal.h"
#include "regression/naming.h"
#include "regression/regression.h"
#include "runs/trajectory.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdlib.h>
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

static void regression_words_add(RegressionText *text, const char *between, const char *format, ...) PRINTF_LIKE(3, 4);
static void regression_words_add(RegressionText *text, const char *between, const char *format, ...) {
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
        regression_words_add(words, ": ", "%s", change_words(&changes->list[changes->region_change[i]]).text);
        if (others > 0) regression_words_add(words, ", ", "and %d more %s", others, others == 1 ? "change" : "changes");
        return;
    }
}

static void add_difference(RegressionText *words, const ImageDifference *difference) {
    if (difference->pixels == 0)
        regression_words_add(words, "", "equal pixels");
    else
        regression_words_add(words, "", "%" PRId64 " %s (%.3g%%) by at most %d, first at (%d, %d)", difference->pixels,
                             difference->pixels == 1 ? "pixel differs" : "pixels differ",
                             100 * (double)difference->pixels / (double)difference->counted, difference->largest,
                             difference->first_x, difference->first_y);
    if (difference->moved > 0)
        regression_words_add(words, "; ", "%" PRId64 " %s of edges ignored", difference->moved,
                             difference->moved == 1 ? "pixel" : "pixels");
}

RegressionText frame_words(const RegressionFrame *frame) {
    RegressionText words = {""};
    const ImageDifference *difference = &frame->difference;
    const RegressionFile *a = &frame->files[EXPECTED], *b = &frame->files[ACTUAL];
    switch (frame->pixels) {
    case PIXELS_MISSING: regression_words_add(&words, "", "no actual picture"); break;
    case PIXELS_EXTRA: regression_words_add(&words, "", "no expected picture"); break;
    case PIXELS_RESIZED:
        regression_words_add(&words, "", "sizes differ: %d x %d and %d x %d pixels", a->width, a->height, b->width,
                             b->height);
        if (frame->sizes_alone) break;
        regression_words_add(&words, "; ", "overlap: ");
        add_difference(&words, difference);
        break;
    case PIXELS_EQUAL: regression_words_add(&words, "", "equal pixels"); break;
    case PIXELS_WITHIN:
    case PIXELS_DIFFER: add_difference(&words, difference);
    }
    if (frame->panel > 0) regression_words_add(&words, ", ", "states differ in panel %d", frame->panel);
    if (frame->other_view && frame->states != STATES_DIFFER)
        regression_words_add(&words, ", ", "the camera differs");
    else if (frame->states == STATES_DIFFER_ELSEWHERE && frame_failed(frame))
        regression_words_add(&words, ", ",
                             "states equal in this frame but not in the whole run, which sets camera and scales");
    add_changes(&words, frame);
    if (frame->metadata.text[0] != '\0')
        regression_words_add(&words, ", ", "metadata differs: %s", frame->metadata.text);
    if (frame->at[EXPECTED] != NULL && frame->at[EXPECTED] != frame->base)
        regression_words_add(&words, "; ",
                             frame_failed(frame) ? "closest accepted picture: %s" : "accepted picture: %s",
                             frame->at[EXPECTED]->name + frame->at[EXPECTED]->folder);
    return words;
}

RegressionText cause_words(const RegressionCause *cause) {
    RegressionText words = {""};
    regression_words_add(&words, "", "%s: %s", cause->frames, cause->what);
    if (cause->most > 0)
        regression_words_add(&words, " ", "at most %.*f px",
                             cause->most < 0.1    ? 2
                             : cause->most < 9.95 ? 1
                                                  : 0,
                             cause->most);
    return words;
}

RegressionText run_words(const RegressionRun *run) {
    RegressionText words = {""};
    const TrajectoryDifference *d = &run->difference;
    if (d->equal) {
        regression_words_add(&words, "", "equal states");
        return words;
    }
    if (d->what[0] != '\0') regression_words_add(&words, "", "%s", d->what);
    if (d->frame >= 0)
        regression_words_add(&words, "; ", "from frame %d, body %d: %g m apart, %g rad, %g m/s", d->frame, d->body,
                             d->distance, d->angle, d->speed);
    if (d->max_frame >= 0)
        regression_words_add(&words, "; ", "farthest in frame %d, body %d: %g m", d->max_frame, d->max_body,
                             d->max_distance);
    return words;
}

static void add_count(RegressionText *text, int count, const char *what) {
    if (count > 0) regression_words_add(text, ", ", "%d %s %s", count, count == 1 ? "frame" : "frames", what);
}

RegressionText regression_verdict(const Regression *regression) {
    RegressionText verdict = {""};
    bool physics = regression->physics > 0 || regression->elsewhere > 0 || regression->run_failed > 0;
    bool renderer = regression->renderer > 0;
    if (physics || renderer)
        regression_words_add(&verdict, ", ", "%s",
                             physics && renderer ? "physics and renderer changed"
                             : physics           ? "physics changed"
                                                 : "renderer changed");
    if (regression->view > 0 && !physics) regression_words_add(&verdict, ", ", "view changed");
    if (regression->unknown > 0) regression_words_add(&verdict, ", ", "pictures differ (cause unknown: no states)");
    if (regression->metadata_failed > 0) regression_words_add(&verdict, ", ", "metadata changed");
    add_count(&verdict, regression->by_verdict[PIXELS_MISSING], "missing");
    add_count(&verdict, regression->by_verdict[PIXELS_EXTRA], "extra");
    if (verdict.text[0] == '\0') regression_words_add(&verdict, "", "equal");
    return verdict;
}

RegressionText regression_begin(const Regression *regression) {
    RegressionText begin = {""};
    if (regression->first_run >= 0) {
        const RegressionRun *run = &regression->runs[regression->first_run];
        regression_words_add(&begin, "\n", "physics changed first in %s: %s", run->name, run_words(run).text);
    } else if (regression->first_physics >= 0) {
        const RegressionFrame *frame = &regression->frames[regression->first_physics];
        regression_words_add(&begin, "\n", "physics changed first in %s, panel %d", frame_name(frame), frame->panel);
    }
    if (regression->first_renderer >= 0)
        regression_words_add(&begin, "\n", "renderer changed first in %s",
                             frame_name(&regression->frames[regression->first_renderer]));
    return begin;
}

/* The texts of a picture. */
typedef struct Texts {
    char part[32], frame[32], card[32], states[512];
} Texts;

static bool read_texts(Texts *texts, const uint8_t *data, size_t size, Error *error) {
    return image_find_text(data, size, "Part", texts->part, sizeof texts->part, error) &&
           image_find_text(data, size, "Frame", texts->frame, sizeof texts->frame, error) &&
           image_find_text(data, size, "Card", texts->card, sizeof texts->card, error) &&
           image_find_text(data, size, "State", texts->states, sizeof texts->states, error);
}

/* The frame number of a picture of a stored frame; -1 for others: interpolated poses, other programs. */
static int64_t stored_frame(const Texts *texts) {
    const char *frame = texts->frame;
    return texts->part[0] == '\0' && frame[0] >= '0' && frame[0] <= '9' ? strtoll(frame, NULL, 10) : -1;
}

/* The run of this name if the picture shows it: if its state in this frame is one of those that the picture's text
   names. An overlay has more states than panels, and a difference one more; so any of them will do. Else NULL. */
static const Trajectory *known_run(const ShownFolder *folder, const char *name, int64_t frame, const char *states) {
    const Trajectory *run = shown_run(folder, name);
    char hash[20];
    if (run == NULL || frame < 0 || run->frames < 1) return NULL;
    snprintf(hash, sizeof hash, "%016" PRIx64,
             trajectory_frame_hash(run, frame < run->frames ? (int)frame : run->frames - 1));
    return strstr(states, hash) != NULL ? run : NULL;
}

static bool name_changes(const ShownFolder *const folders[SIDES], const Texts texts[SIDES],
                         const Image *const images[SIDES], const uint8_t *masked, FrameChanges *changes, Error *error) {
    const FrameView *view = &folders[EXPECTED]->view;
    NamingScene scene = {.view = view};
    for (RegressionSide side = EXPECTED; side < SIDES; side++) {
        const char *states = texts[side].states;
        const int64_t number = stored_frame(&texts[side]);
        if (side == EXPECTED) scene.frame = (int)number;
        for (int i = 0; number == scene.frame && i < view->panel_count; i++) {
            const ViewPanel *panel = &view->panels[i];
            scene.runs[i][side] = known_run(folders[side], panel->run, number, states);
            for (int k = 0; side == EXPECTED && k < panel->outline_count; k++)
                scene.outlines[i][k] = known_run(folders[side], panel->outlines[k], number, states);
        }
    }
    return naming_find(&scene, images[EXPECTED], images[ACTUAL], masked, changes, error);
}

bool regression_find_changes(Regression *regression, RegressionFrame *frame, uint8_t *const data[SIDES],
                             const Image *const images[SIDES], const uint8_t *masked, Error *error) {
    const ShownFolder *folders[SIDES];
    FrameChanges *changes = frame->changes = calloc(1, sizeof *frame->changes);
    if (changes == NULL) return error_memory(error, frame_name(frame));
    memset(changes->region_change, -1, sizeof changes->region_change);
    if (!image_regions_find(images[EXPECTED], images[ACTUAL], masked, &frame->difference, &changes->regions, error))
        return false;
    for (RegressionSide side = EXPECTED; side < SIDES; side++)
        if ((folders[side] = shown_find(&regression->shown, frame->at[side]->path)) == NULL)
            return error_memory(error, frame_name(frame));
    const FrameView *a = &folders[EXPECTED]->view, *b = &folders[ACTUAL]->view;
    if (a->width != images[EXPECTED]->width || a->height != images[EXPECTED]->height) return true;
    if (b->width != a->width || b->height != a->height) return true;
    Texts texts[SIDES];
    for (RegressionSide side = EXPECTED; side < SIDES; side++)
        if (!read_texts(&texts[side], data[side], frame->files[side].size, error)) return false;
    if (texts[EXPECTED].card[0] != '\0' || texts[ACTUAL].card[0] != '\0') return true; /* it has a layout of its own */
    frame->other_view = view_difference(a, b).text[0] != '\0';
    if (frame->other_view) return true;
    return name_changes(folders, texts, images, masked, changes, error);
}

/* What a comparison left out, or let pass although it is not equal. */

/* Adds a line if there is anything to count. */
static void regression_notes_add(RegressionText *notes, int count, const char *format, ...) PRINTF_LIKE(3, 4);
static void regression_notes_add(RegressionText *notes, int count, const char *format, ...) {
    size_t used = strlen(notes->text), room = sizeof notes->text - used;
    va_list arguments;
    if (count == 0) return;
    va_start(arguments, format);
    if (used > 0 && room > 1) notes->text[used++] = '\n', room--;
    vsnprintf(notes->text + used, room, format, arguments);
    va_end(arguments);
}

RegressionText regression_notes(const Regression *regression) {
    RegressionText notes = {""};
    enum { NAME = 100 }; /* of each name, so that all notes fit */
    const ImageSequence *const *sides = (const ImageSequence *const *)regression->sequences;
    bool same = sides[EXPECTED]->device == sides[ACTUAL]->device && sides[EXPECTED]->inode == sides[ACTUAL]->inode;
    regression_notes_add(&notes, same, "expected and actual are the same %s",
                         sides[EXPECTED]->single ? "file" : "folder");
    int accepted = regression->other_accepted, metadata = regression->metadata;
    regression_notes_add(&notes, accepted, "%d frame%s passed by another accepted picture", accepted, plural(accepted));
    if (metadata > 0) {
        const RegressionFrame *first = &regression->frames[regression->first_metadata];
        regression_notes_add(&notes, metadata, "metadata differs in %d frame%s, first in %.*s: %s%s", metadata,
                             plural(metadata), (int)utf8_cut(frame_name(first), NAME), frame_name(first),
                             first->metadata.text,
                             regression->options.strict_metadata ? "" : " (--metadata strict fails)");
    }
    int left_out = regression->runs_left_out, foreign = regression->runs_foreign;
    const char *expected = regression->sequences[EXPECTED]->folder;
    regression_notes_add(&notes, left_out, "not compared: %d .npz file%s only in %.*s", left_out, plural(left_out),
                         (int)utf8_cut(expected, NAME), expected);
    regression_notes_add(&notes, foreign, "not compared: %d .npz file%s without a trajectory", foreign,
                         plural(foreign));
    for (RegressionSide side = EXPECTED; side < SIDES; side++) {
        const ImageSequence *sequence = regression->sequences[side];
        regression_notes_add(&notes, sequence->skipped,
                             "not compared: %d picture%s in subfolders of %.*s (--no-recursive)", sequence->skipped,
                             plural(sequence->skipped), (int)utf8_cut(sequence->folder, NAME), sequence->folder);
    }
    return notes;
}

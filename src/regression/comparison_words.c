/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A comparison in words: changes and regions, frames, runs, causes, the verdict, notes. */
#include "base/base.h"
#include "pixels/png.h"
#include "regression/naming.h"
#include "regression/regression.h"
#include "runs/compare_runs.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

#define ADD(words, ...) text_add((words)->text, sizeof(words)->text, __VA_ARGS__)
/* JOIN(words, between, format, ...) */
#define JOIN(words, ...) text_join((words)->text, sizeof(words)->text, __VA_ARGS__)

/* Of a movement, to a sensible number of digits. */
static void add_pixels(ChangeText *text, double pixels) {
    ADD(text, " %.*f px", pixels < 0.1 ? 2 : pixels < 9.95 ? 1 : 0, pixels);
}

static void add_subject(ChangeText *text, const Change *change) {
    static const char *const names[] = {[SUBJECT_HEADER] = "header",     [SUBJECT_CAPTION] = "caption",
                                        [SUBJECT_AXIS] = "axis",         [SUBJECT_LEGEND] = "legend",
                                        [SUBJECT_TIMELINE] = "timeline", [SUBJECT_MARKS] = "marks",
                                        [SUBJECT_BODY] = "body",         [SUBJECT_BACKGROUND] = "background",
                                        [SUBJECT_PAGE] = "page",         [SUBJECT_FIXED] = "static body",
                                        [SUBJECT_BOMB] = "bomb",         [SUBJECT_GROUND] = "ground"};
    if (change->subject == SUBJECT_BODIES)
        ADD(text, "%d more %s", change->body, change->body == 1 ? "body" : "bodies");
    else
        ADD(text, "%s", names[change->subject]);
    if (change->subject == SUBJECT_BODY || change->subject == SUBJECT_FIXED) ADD(text, " %d", change->body);
    if (change->subject == SUBJECT_BOMB || change->subject == SUBJECT_GROUND) ADD(text, " (body %d)", change->body);
    if (change->panel > 0) ADD(text, " of panel %d", change->panel);
}

/* " moved 0.4 px right", " moved 3 px right and 2 px up, turned 4 degrees". */
static void add_movement(ChangeText *text, const Change *change) {
    const double SMALL = 0.005; /* pixels; smaller movements round to 0.00 */
    const double ALONG = 0.25;  /* a movement's smaller part is left out below this share of the larger */
    const double SEEN_TURN = 0.001, DEGREES = 57.29577951308232;
    const double right = fabs(change->right), up = fabs(change->up);
    const bool has_right = right >= SMALL && right >= ALONG * up, has_up = up >= SMALL && up >= ALONG * right;
    const bool turns = fabs(change->turn) >= SEEN_TURN;
    if (has_right || has_up) ADD(text, " moved");
    if (has_right) add_pixels(text, right), ADD(text, " %s", change->right > 0 ? "right" : "left");
    if (has_right && has_up) ADD(text, " and");
    if (has_up) add_pixels(text, up), ADD(text, " %s", change->up > 0 ? "up" : "down");
    if (turns) ADD(text, "%s turned %.3g degrees", has_right || has_up ? "," : "", DEGREES * fabs(change->turn));
    if (!has_right && !has_up && !turns) ADD(text, " moved less than 0.01 px");
}

ChangeText change_words(const Change *change) {
    ChangeText text = {""};
    add_subject(&text, change);
    if (change->kind == CHANGE_MOVED && change->subject != SUBJECT_BODIES)
        add_movement(&text, change);
    else
        ADD(&text, "%s",
            change->kind == CHANGE_MOVED         ? " moved"
            : change->kind == CHANGE_APPEARED    ? " only in the actual run"
            : change->kind == CHANGE_DISAPPEARED ? " only in the expected run"
            : change->subject <= SUBJECT_BODIES  ? " changed"
                                                 : "");
    return text;
}

ChangeText change_cause(const Change *change) {
    const bool several = change->subject == SUBJECT_BODIES;
    if (change->kind != CHANGE_MOVED && !several) return change_words(change);
    ChangeText text = {""};
    if (several)
        ADD(&text, "other bodies");
    else
        add_subject(&text, change);
    ADD(&text, change->kind == CHANGE_MOVED ? " moved" : " changed");
    return text;
}

/* Whether nearly all of these pixels differ as those along edges may. */
static bool are_edges(int64_t edges, int64_t pixels) { return 10 * edges >= 9 * pixels; }

ChangeText region_name(const FrameChanges *changes, int region) {
    ChangeText text = {""};
    const ImageRegion *r = &changes->regions.list[region];
    const int change = changes->region_change[region], others = changes->region_others[region];
    if (change >= 0) text = change_words(&changes->list[change]);
    if (change >= 0 && others > 0) ADD(&text, ", and %d more %s", others, others == 1 ? "change" : "changes");
    if (change < 0 && are_edges(r->edges, r->pixels)) ADD(&text, "noise along edges");
    return text;
}

ChangeText region_words(const FrameChanges *changes, int region) {
    ChangeText text = {""};
    const ImageRegion *r = &changes->regions.list[region];
    const ChangeText name = region_name(changes, region);
    ADD(&text, "%d x %d pixels at (%d, %d), %" PRId64 " of them %s by at most %d", r->right - r->left,
        r->bottom - r->top, r->left, r->top, r->pixels, r->pixels == 1 ? "differs" : "differ", r->largest);
    if (name.text[0] != '\0') ADD(&text, ": %s", name.text);
    return text;
}

bool run_failed(const RegressionRun *run) {
    return run->read_error != NULL || run->alone[EXPECTED] || run->alone[ACTUAL] ||
           !(run->difference.equal || run->within);
}

const char *run_verdict(const RegressionRun *run) {
    if (run->read_error != NULL) return "not comparable";
    if (run->alone[EXPECTED]) return "missing";
    if (run->alone[ACTUAL]) return "extra";
    return run->difference.equal ? "equal" : run->within ? "within tolerance" : "physics changed";
}

bool regression_passed(const Regression *regression) { return regression->failed == 0 && regression->run_failed == 0; }

const char *frame_name(const RegressionFrame *frame) { return frame->base->name; }

const char *frame_verdict(const RegressionFrame *frame) {
    switch (frame->pixels) {
    case PIXELS_MISSING: return "missing";
    case PIXELS_EXTRA: return "extra";
    case PIXELS_UNREAD: return "not comparable";
    case PIXELS_DIFFER:
    case PIXELS_RESIZED:
        if (frame->states == STATES_DIFFER) return "physics changed";
        if (frame->other_view) return "view changed";
        if (frame->states == STATES_UNKNOWN) return "pictures differ";
        return frame->states == STATES_EQUAL ? "renderer changed" : "run changed";
    case PIXELS_EQUAL:
    case PIXELS_WITHIN: break;
    }
    if (frame->states_failed) return "physics changed";
    if (frame->metadata_failed) return "metadata changed";
    return frame->pixels == PIXELS_EQUAL && frame->states != STATES_DIFFER ? "equal" : "within tolerance";
}

/* What differs, where that has a name: the largest region's change; or what all of it looks like. */
static void add_name(RegressionText *words, const RegressionFrame *frame) {
    enum { SEEN = 16 }; /* levels; less, everywhere, is noise */
    const ImageDifference *difference = &frame->difference;
    const FrameChanges *changes = frame->changes;
    if (changes == NULL || difference->pixels == 0) return;
    for (int i = 0; i < changes->regions.kept; i++) {
        const int others = changes->count - 1;
        if (changes->region_change[i] < 0) continue;
        JOIN(words, ": ", "%s", change_words(&changes->list[changes->region_change[i]]).text);
        if (others > 0) JOIN(words, ", ", "and %d more %s", others, others == 1 ? "change" : "changes");
        return;
    }
    if (are_edges(changes->regions.edges, difference->pixels))
        JOIN(words, ": ", "noise along edges");
    else if (2 * difference->pixels > difference->counted && difference->largest >= SEEN && difference->counted > 1)
        JOIN(words, ": ", "the whole picture is another");
}

RegressionText frame_words(const RegressionFrame *frame) {
    RegressionText words = {""};
    const ImageDifference *difference = &frame->difference;
    const RegressionFile *a = &frame->files[EXPECTED], *b = &frame->files[ACTUAL];
    switch (frame->pixels) {
    case PIXELS_MISSING: JOIN(&words, "", "no actual picture"); break;
    case PIXELS_EXTRA: JOIN(&words, "", "no expected picture"); break;
    case PIXELS_UNREAD: JOIN(&words, "", "%s", frame->read_error); break;
    case PIXELS_EQUAL: JOIN(&words, "", "equal pixels"); break;
    case PIXELS_WITHIN:
    case PIXELS_DIFFER:
    case PIXELS_RESIZED:
        if (!difference->same_size)
            JOIN(&words, "", "sizes differ: %d x %d and %d x %d pixels", a->width, a->height, b->width, b->height);
        if (frame->sizes_alone) break;
        if (!difference->same_size) JOIN(&words, "; ", "overlap: ");
        if (difference->pixels == 0)
            JOIN(&words, "", "equal pixels");
        else
            JOIN(&words, "", "%" PRId64 " %s (%.3g%%) by at most %d, first at (%d, %d)", difference->pixels,
                 difference->pixels == 1 ? "pixel differs" : "pixels differ",
                 100 * (double)difference->pixels / (double)difference->counted, difference->largest,
                 difference->first_x, difference->first_y);
        if (difference->moved > 0)
            JOIN(&words, "; ", "%" PRId64 " %s as limits allow", difference->moved,
                 difference->moved == 1 ? "pixel differs" : "pixels differ");
    }
    if (frame->panel > 0) JOIN(&words, ", ", "states differ in panel %d", frame->panel);
    if (frame->other_view && frame->states != STATES_DIFFER)
        JOIN(&words, ", ", "the camera differs");
    else if (frame->states == STATES_DIFFER_ELSEWHERE && frame_failed(frame))
        JOIN(&words, ", ", "states equal in this frame but not in the whole run, which sets camera and scales");
    add_name(&words, frame);
    if (frame->metadata.text[0] != '\0') JOIN(&words, ", ", "metadata differs: %s", frame->metadata.text);
    if (frame->at[EXPECTED] != NULL && frame->at[EXPECTED] != frame->base)
        JOIN(&words, "; ", frame_failed(frame) ? "closest accepted picture: %s" : "accepted picture: %s",
             frame->at[EXPECTED]->name + frame->at[EXPECTED]->folder);
    return words;
}

RegressionText case_words(const RegressionFrame *frame) {
    RegressionText words = frame_words(frame);
    const ImageRegions *regions = frame->changes != NULL ? &frame->changes->regions : NULL;
    if (regions == NULL || regions->kept == 0) return words;
    const ImageRegion *r = &regions->list[0];
    JOIN(&words, "; ", regions->count > 1 ? "%" PRId64 " regions, the largest" : "one region", regions->count);
    JOIN(&words, " ", "of %d x %d pixels at (%d, %d)", r->right - r->left, r->bottom - r->top, r->left, r->top);
    return words;
}

RegressionText cause_words(const RegressionCause *cause) {
    RegressionText words = {""};
    JOIN(&words, "", "%s: %s", cause->frames, cause->what);
    if (cause->most > 0)
        JOIN(&words, " ", "at most %.*f px", cause->most < 0.1 ? 2 : cause->most < 9.95 ? 1 : 0, cause->most);
    return words;
}

RegressionText run_words(const RegressionRun *run) {
    RegressionText words = {""};
    const TrajectoryDifference *d = &run->difference;
    if (run->read_error != NULL) JOIN(&words, "", "%s", run->read_error);
    if (run->read_error != NULL) return words;
    if (d->equal) {
        JOIN(&words, "", "%s",
             run->alone[EXPECTED] ? "only in the expected folder"
             : run->alone[ACTUAL] ? "only in the actual folder"
                                  : "equal states");
        return words;
    }
    if (d->what[0] != '\0') JOIN(&words, "", "%s", d->what);
    if (run->beyond.frame >= 0)
        JOIN(&words, "; ", "beyond the tolerance from frame %d, body %d: %g m apart, %g rad", run->beyond.frame,
             run->beyond.body, run->beyond.by.distance, run->beyond.by.angle);
    if (d->frame >= 0)
        JOIN(&words, "; ", "from frame %d, body %d: %g m apart, %g rad, %g m/s", d->frame, d->body, d->distance,
             d->angle, d->speed);
    if (d->max_frame >= 0)
        JOIN(&words, "; ", "farthest in frame %d, body %d: %g m", d->max_frame, d->max_body, d->max_distance);
    return words;
}

RegressionText run_verdicts(const RegressionRun *run) {
    RegressionText words = {""};
    const char *before = run->verdicts[EXPECTED], *now = run->verdicts[ACTUAL];
    if (strcmp(before, now) != 0)
        JOIN(&words, "", "verdict before: %s; now: %s", before[0] != '\0' ? before : "none",
             now[0] != '\0' ? now : "none");
    return words;
}

static void add_count(RegressionText *text, int count, const char *one, const char *more, const char *what) {
    if (count > 0) JOIN(text, ", ", "%d %s %s", count, count == 1 ? one : more, what);
}

RegressionText regression_verdict(const Regression *regression) {
    RegressionText verdict = {""};
    const int *alone = regression->runs_alone, unread = regression->runs_unread,
              runs_changed = regression->run_failed - alone[EXPECTED] - alone[ACTUAL] - unread;
    bool physics = regression->physics > 0 || regression->elsewhere > 0 || runs_changed > 0;
    bool renderer = regression->renderer > 0;
    if (physics || renderer)
        JOIN(&verdict, ", ", "%s",
             physics && renderer ? "physics and renderer changed"
             : physics           ? "physics changed"
                                 : "renderer changed");
    if (regression->view > 0 && !physics) JOIN(&verdict, ", ", "view changed");
    if (regression->unknown > 0)
        JOIN(&verdict, ", ", regression->film ? "pictures differ (cause unknown: no states)" : "pictures differ");
    if (regression->metadata_failed > 0) JOIN(&verdict, ", ", "metadata changed");
    add_count(&verdict, regression->by_verdict[PIXELS_MISSING], "frame", "frames", "missing");
    add_count(&verdict, regression->by_verdict[PIXELS_EXTRA], "frame", "frames", "extra");
    add_count(&verdict, regression->by_verdict[PIXELS_UNREAD], "frame", "frames", "not comparable");
    add_count(&verdict, alone[EXPECTED], "trajectory", "trajectories", "missing");
    add_count(&verdict, alone[ACTUAL], "trajectory", "trajectories", "extra");
    add_count(&verdict, unread, "trajectory", "trajectories", "not comparable");
    if (verdict.text[0] == '\0') JOIN(&verdict, "", "equal");
    return verdict;
}

RegressionText regression_begin(const Regression *regression) {
    RegressionText begin = {""};
    if (regression->first_run >= 0) {
        const RegressionRun *run = &regression->runs[regression->first_run];
        JOIN(&begin, "\n", "physics changed first in %s: %s", run->name, run_words(run).text);
    }
    if (regression->first_renderer >= 0)
        JOIN(&begin, "\n", "renderer changed first in %s", frame_name(&regression->frames[regression->first_renderer]));
    return begin;
}

/* Why .npz files count as no runs. */
#ifdef TWINBOX_COMPARE_ONLY
#define UNREAD "(this build compares pictures only)"
#else
#define UNREAD "without a trajectory"
#endif

RegressionText regression_limits(const Regression *regression) {
    const PoseTolerance *poses = &regression->options.poses;
    RegressionText words = {""};
    JOIN(&words, "", "%s", tolerance_words(&regression->options.tolerance).text);
    if (poses->given && regression->count == 0) words.text[0] = '\0';
    if (poses->given) JOIN(&words, "; ", "trajectories: at most %g m", poses->distance);
    if (poses->given && isfinite(poses->angle)) JOIN(&words, " ", "and %g rad", poses->angle);
    return words;
}

RegressionText regression_notes(const Regression *regression) {
    RegressionText notes = {""};
    enum { NAME = 100 }; /* of each name, so that all notes fit */
    const ImageSequence *const *sides = (const ImageSequence *const *)regression->sequences;
    bool same = sides[EXPECTED]->device == sides[ACTUAL]->device && sides[EXPECTED]->inode == sides[ACTUAL]->inode;
    if (same) JOIN(&notes, "\n", "expected and actual are the same %s", sides[EXPECTED]->single ? "file" : "folder");
    int accepted = regression->other_accepted, metadata = regression->metadata;
    if (accepted > 0) JOIN(&notes, "\n", "%d frame%s passed by another accepted picture", accepted, plural(accepted));
    if (metadata > 0) {
        const RegressionFrame *first = &regression->frames[regression->first_metadata];
        JOIN(&notes, "\n", "metadata differs in %d frame%s, first in %.*s: %s%s", metadata, plural(metadata),
             (int)utf8_cut(frame_name(first), NAME), frame_name(first), first->metadata.text,
             regression->options.strict ? "" : " (--strict fails)");
    }
    int left_out = regression->runs_left_out, foreign = regression->runs_foreign;
    const char *expected = regression->sequences[EXPECTED]->folder;
    if (left_out > 0)
        JOIN(&notes, "\n", "not compared: %d .npz file%s only in %.*s", left_out, plural(left_out),
             (int)utf8_cut(expected, NAME), expected);
    if (foreign > 0) JOIN(&notes, "\n", "not compared: %d .npz file%s " UNREAD, foreign, plural(foreign));
    for (RegressionSide side = EXPECTED; side < SIDES; side++) {
        const ImageSequence *sequence = regression->sequences[side];
        if (sequence->skipped > 0)
            JOIN(&notes, "\n", "not compared: %d picture%s in subfolders of %.*s (--no-recursive)", sequence->skipped,
                 plural(sequence->skipped), (int)utf8_cut(sequence->folder, NAME), sequence->folder);
        if (sequence->others > 0)
            JOIN(&notes, "\n", "not compared: %d picture%s in %.*s that %s no PNG file%s: %s%s (--strict fails)",
                 sequence->others, plural(sequence->others), (int)utf8_cut(sequence->folder, NAME), sequence->folder,
                 sequence->others == 1 ? "is" : "are", plural(sequence->others), sequence->other_names,
                 sequence->others > 3 ? ", ..." : "");
    }
    return notes;
}

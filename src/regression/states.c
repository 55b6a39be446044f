/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is behind the pictures: the runs, whether their states differ, the names of what changed, and the causes. */
#include "base/base.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/machine.h"
#include "pixels/png.h"
#include "regression/compare.h"
#include "regression/content.h"
#include "regression/regression_internal.h"
#include "regression/naming.h"
#include "regression/regression.h"
#include "runs/trajectory.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* The limit of a trajectory file. */
static const size_t MAX_RUN_SIZE = (size_t)2 << 30;

static bool is_run(const char *name) { return file_name_ends_with(name, ".npz") && name_is_text(name); }

/* Adds a file of one folder. That the other folder has no such file is a failure, unless there are pictures: then the
   runs only explain them. */
static bool add_run(Regression *regression, RegressionSide side, const char *name, Error *error) {
    const RegressionSide other = side == EXPECTED ? ACTUAL : EXPECTED;
    char path[PATH_MAX];
    struct stat status;
    if (!name_is_text(name)) return true; /* of its folder */
    if (!file_path(path, sizeof path, error, "%s/%s", regression->sequences[other]->folder, name)) return false;
    const bool alone = stat(path, &status) != 0;
    if (alone && errno != ENOENT && errno != ENOTDIR)
        return error_system(error, path, "cannot be read: %s", strerror(errno));
    if (!alone && side == ACTUAL) return true; /* added with the expected one */
    if (alone && regression->count > 0) {
        regression->runs_left_out += side == EXPECTED;
        return true;
    }
    RegressionRun *run = &regression->runs[regression->run_count++];
    *run = (RegressionRun){.beyond = {.frame = -1}};
    run->alone[side] = alone;
    run->paths[other] = strdup(path);
    if (!file_path(path, sizeof path, error, "%s/%s", regression->sequences[side]->folder, name)) return false;
    run->paths[side] = strdup(path);
    run->name = strdup(name);
    return (run->name != NULL && run->paths[EXPECTED] != NULL && run->paths[ACTUAL] != NULL) ||
           error_memory(error, name);
}

static bool list_runs(Regression *regression, Error *error) {
    FolderList files[SIDES] = {{0}, {0}};
    bool ok = true;
    for (RegressionSide side = EXPECTED; ok && side < SIDES; side++)
        ok = folder_list(&files[side], regression->sequences[side]->folder, is_run, !regression->options.flat, error);
    regression->runs = calloc(files[EXPECTED].count + files[ACTUAL].count + 1, sizeof *regression->runs);
    ok = ok && (regression->runs != NULL || error_memory(error, "runs"));
    for (RegressionSide side = EXPECTED; side < SIDES; side++) {
        for (size_t i = 0; ok && i < files[side].count; i++)
            ok = add_run(regression, side, files[side].names[i], error);
        folder_list_free(&files[side]);
    }
    return ok;
}

/* Marks the frames that differ; frames beyond the end of the shorter run do. */
static bool mark_frames(RegressionRun *run, const Trajectory *a, const Trajectory *b, Error *error) {
    int common = a->frames < b->frames ? a->frames : b->frames;
    char what[sizeof run->difference.what];
    bool other_worlds = trajectory_different_worlds(a, b, what, sizeof what);
    run->frames = a->frames > b->frames ? a->frames : b->frames;
    run->differs = malloc((size_t)run->frames * sizeof *run->differs);
    if (run->differs == NULL) return error_memory(error, run->name);
    for (int frame = 0; frame < run->frames; frame++) {
        run->differs[frame] = other_worlds || frame >= common;
        for (int body = 0; body < a->bodies && !run->differs[frame]; body++)
            run->differs[frame] = !trajectory_same_state(a, b, frame, body);
    }
    return true;
}

/* Runs that differ, but whose poses are near enough, pass. */
static bool find_beyond(RegressionRun *run, const Trajectory *a, const Trajectory *b, const PoseTolerance *tolerance,
                        Error *error) {
    TrajectoryParting parting;
    char what[sizeof run->difference.what];
    if (trajectory_different_worlds(a, b, what, sizeof what)) return true;
    if (!trajectory_part(a, b, tolerance, &parting, error)) return false;
    run->beyond = parting.beyond;
    run->within = parting.beyond.frame < 0 && a->frames == b->frames;
    return true;
}

static bool compare_run(RegressionRun *run, const PoseTolerance *tolerance, bool *foreign, Error *error) {
    Error failures[SIDES] = {{0}, {0}};
    Trajectory *sides[SIDES];
    for (RegressionSide side = EXPECTED; side < SIDES; side++)
        sides[side] = trajectory_read(run->paths[side], &failures[side]);
    bool ok = sides[EXPECTED] != NULL && sides[ACTUAL] != NULL, system = false;
    for (RegressionSide side = EXPECTED; side < SIDES; side++)
        if (failures[side].kind == ERROR_SYSTEM) *error = failures[side], system = true;
    *foreign = !system && sides[EXPECTED] == NULL && sides[ACTUAL] == NULL;
    if (ok) {
        trajectory_compare(sides[EXPECTED], sides[ACTUAL], &run->difference);
        memcpy(run->scene, sides[EXPECTED]->scene, sizeof run->scene);
        ok = run->difference.equal ||
             (mark_frames(run, sides[EXPECTED], sides[ACTUAL], error) &&
              (!tolerance->given || find_beyond(run, sides[EXPECTED], sides[ACTUAL], tolerance, error)));
    } else if (!*foreign && !system)
        *error = failures[sides[EXPECTED] == NULL ? EXPECTED : ACTUAL];
    for (RegressionSide side = EXPECTED; side < SIDES; side++) trajectory_destroy(sides[side]);
    return ok || *foreign;
}

/* Equal bytes are equal runs, if they are a run; so is a run alone. */
static bool read_run(RegressionRun *run, const char *path, bool *foreign, Error *error) {
    Error failure = {0};
    Trajectory *trajectory = trajectory_read(path, &failure);
    *foreign = trajectory == NULL;
    trajectory_destroy(trajectory);
    run->difference = (TrajectoryDifference){.equal = true, .frame = -1, .body = -1, .max_frame = -1, .max_body = -1};
    if (failure.kind == ERROR_SYSTEM) *error = failure;
    return failure.kind != ERROR_SYSTEM;
}

static bool judge_run(const Regression *regression, RegressionRun *run, bool *foreign, Error *error) {
    for (RegressionSide side = EXPECTED; side < SIDES; side++) {
        if (run->alone[side == EXPECTED ? ACTUAL : EXPECTED]) continue;
        RegressionFile *file = &run->files[side];
        char *data = file_read(run->paths[side], MAX_RUN_SIZE, &file->size, error);
        if (data == NULL) return false;
        file->hash = hash_xxh3(data, file->size);
        bool pointer = !lfs_pointer_refuse(data, file->size, run->paths[side], error);
        free(data);
        if (pointer) return false;
    }
    for (RegressionSide side = EXPECTED; side < SIDES; side++)
        if (run->alone[side]) return read_run(run, run->paths[side], foreign, error);
    const RegressionFile *a = &run->files[EXPECTED], *b = &run->files[ACTUAL];
    bool same = a->hash == b->hash && a->size == b->size;
    return same ? read_run(run, run->paths[EXPECTED], foreign, error)
                : compare_run(run, &regression->options.poses, foreign, error);
}

void regression_free_run(RegressionRun *run) {
    free(run->name);
    for (RegressionSide side = EXPECTED; side < SIDES; side++) free(run->paths[side]);
    free(run->differs);
}

bool regression_find_runs(Regression *regression, Error *error) {
    if (regression->sequences[EXPECTED]->single) return true;
    if (!list_runs(regression, error)) return false;
    int kept = 0;
    bool ok = true;
    for (int i = 0; i < regression->run_count; i++) {
        bool foreign = false;
        RegressionRun run = regression->runs[i];
        double begun = clock_seconds();
        ok = ok && judge_run(regression, &run, &foreign, error);
        run.seconds = clock_seconds() - begun;
        if (foreign) {
            regression->runs_foreign++;
            regression_free_run(&run);
        } else
            regression->runs[kept++] = run;
    }
    regression->run_count = kept;
    return ok;
}

/* The texts of a picture. */
typedef struct Texts {
    char scene[TRAJECTORY_NAME_SIZE], part[32], frame[32], card[32], states[512];
} Texts;

static bool read_texts(Texts *texts, const uint8_t *data, size_t size, Error *error) {
    return image_find_text(data, size, "Scene", texts->scene, sizeof texts->scene, error) &&
           image_find_text(data, size, "Part", texts->part, sizeof texts->part, error) &&
           image_find_text(data, size, "Frame", texts->frame, sizeof texts->frame, error) &&
           image_find_text(data, size, "Card", texts->card, sizeof texts->card, error) &&
           image_find_text(data, size, "State", texts->states, sizeof texts->states, error);
}

/* The first differing panel: "a1 | b2" and "a1 | c3" give 2. */
static int first_panel(const char *a, const char *b) {
    int panel = 1;
    for (; *a != '\0' && *a == *b; a++, b++) panel += *a == '|';
    return panel;
}

static bool in_its_folder(const RegressionRun *run, const SequenceFrame *picture) {
    return file_folder_length(run->name) == (size_t)picture->folder &&
           memcmp(run->name, picture->name, (size_t)picture->folder) == 0;
}

/* Whether a run of the picture's folder and scene (of any scene if the picture names none) differs in this frame.
   *somewhere: in any frame. *known becomes true if its folder has a run. */
static bool runs_differ(const Regression *regression, const SequenceFrame *picture, const Texts *texts, int64_t frame,
                        bool *known, bool *somewhere) {
    bool here = false;
    for (int i = 0; i < regression->run_count; i++) {
        const RegressionRun *run = &regression->runs[i];
        if (!in_its_folder(run, picture)) continue;
        *known = true;
        if (run->differs == NULL || (texts->scene[0] != '\0' && strcmp(texts->scene, run->scene) != 0)) continue;
        int64_t at = frame < run->frames ? frame : run->frames - 1;
        here = here || run->differs[at < 0 ? 0 : at];
        *somewhere = true;
    }
    return here;
}

bool regression_judge_states(const Regression *regression, RegressionFrame *frame, uint8_t *const data[SIDES],
                             Error *error) {
    Texts texts[SIDES];
    for (RegressionSide side = EXPECTED; side < SIDES; side++)
        if (!read_texts(&texts[side], data[side], frame->files[side].size, error)) return false;
    const char *a = texts[EXPECTED].states, *b = texts[ACTUAL].states;
    bool known = a[0] != '\0' && b[0] != '\0', texts_differ = known && strcmp(a, b) != 0;
    if (texts_differ) frame->panel = first_panel(a, b);
    const char *number = texts[EXPECTED].frame;
    int64_t at = number[0] >= '0' && number[0] <= '9' ? strtoll(number, NULL, 10) : frame->base->number;
    bool differs = runs_differ(regression, frame->base, &texts[EXPECTED], at, &known, &frame->run_differs);
    frame->states = texts_differ || differs ? STATES_DIFFER : known ? STATES_EQUAL : STATES_UNKNOWN;
    return true;
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

/* The folders of the frame. */
static bool find_folders(Regression *regression, const RegressionFrame *frame, const ShownFolder *folders[SIDES],
                         Error *error) {
    for (RegressionSide side = EXPECTED; side < SIDES; side++)
        if ((folders[side] = shown_find(&regression->shown, frame->at[side]->path, error)) == NULL) return false;
    return true;
}

bool regression_may_name(Regression *regression, const RegressionFrame *frame, bool *named, Error *error) {
    const ShownFolder *folders[SIDES];
    if (!find_folders(regression, frame, folders, error)) return false;
    *named = folders[EXPECTED]->view.width > 0 && folders[ACTUAL]->view.width > 0;
    return true;
}

bool regression_keep_regions(RegressionFrame *frame, const ImageRegions *regions, Error *error) {
    if ((frame->changes = calloc(1, sizeof *frame->changes)) == NULL) return error_memory(error, frame_name(frame));
    memset(frame->changes->region_change, -1, sizeof frame->changes->region_change);
    frame->changes->regions = *regions;
    return true;
}

/* The names that the views and runs of both folders give. */
static bool name_own(RegressionFrame *frame, const ShownFolder *const folders[SIDES], uint8_t *const data[SIDES],
                     const Image *const images[SIDES], const uint8_t *masked, Error *error) {
    const FrameView *a = &folders[EXPECTED]->view, *b = &folders[ACTUAL]->view;
    if (a->width != images[EXPECTED]->width || a->height != images[EXPECTED]->height) return true;
    if (b->width != a->width || b->height != a->height) return true;
    Texts texts[SIDES];
    for (RegressionSide side = EXPECTED; side < SIDES; side++)
        if (!read_texts(&texts[side], data[side], frame->files[side].size, error)) return false;
    if (texts[EXPECTED].card[0] != '\0' || texts[ACTUAL].card[0] != '\0') return true; /* it has a layout of its own */
    frame->other_view = view_difference(a, b).text[0] != '\0';
    if (frame->other_view) return true;
    return name_changes(folders, texts, images, masked, frame->changes, error);
}

bool regression_find_changes(Regression *regression, RegressionFrame *frame, uint8_t *const data[SIDES],
                             const Image *const images[SIDES], const uint8_t *masked, Error *error) {
    const ShownFolder *folders[SIDES];
    ImageRegions regions;
    return image_regions_find(images[EXPECTED], images[ACTUAL], masked, &frame->difference, &regions, error) &&
           regression_keep_regions(frame, &regions, error) &&
           (!frame_failed(frame) ||
            (find_folders(regression, frame, folders, error) && name_own(frame, folders, data, images, masked, error) &&
             content_name(images[EXPECTED], images[ACTUAL], masked, &frame->difference, frame->changes, error)));
}

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

/* Adds a frame; frames are added in order. Neighbours form a range. */
static void add_frame(const Causes *causes, RegressionCause *cause, int frame) {
    const RegressionFrame *at = &causes->regression->frames[frame];
    const bool next = cause->count++ > 0 && frame == cause->last + 1 && !at->alone &&
                      sequence_compare_stems(at[-1].base, at->base) == 0;
    cause->last = frame;
    if (!next && cause->range_count++ < CAUSE_RANGES) cause->ranges[cause->range_count - 1][0] = frame;
    if (cause->range_count <= CAUSE_RANGES) cause->ranges[cause->range_count - 1][1] = frame;
}

static void put_name(const Causes *causes, RegressionCause *cause, const char *before, int frame) {
    const RegressionFrame *at = &causes->regression->frames[frame];
    if (causes->numbered)
        text_add(cause->frames, sizeof cause->frames, "%s%" PRId64, before, at->at[EXPECTED]->number);
    else
        text_add(cause->frames, sizeof cause->frames, "%s%.40s", before, frame_name(at));
}

/* "frame 3", but "frames 3 to 5"; the number if there are too many ranges. */
static void put_frames(const Causes *causes, RegressionCause *cause) {
    const char *first = !causes->numbered ? "" : cause->count == 1 ? "frame " : "frames ";
    for (int i = 0; i < cause->range_count && i < CAUSE_RANGES; i++) {
        const int *range = cause->ranges[i];
        put_name(causes, cause, i == 0 ? first : ", ", range[0]);
        if (range[1] > range[0]) put_name(causes, cause, " to ", range[1]);
    }
    if (cause->range_count > CAUSE_RANGES)
        text_add(cause->frames, sizeof cause->frames, " ... (%d frames)", cause->count);
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
        *cause = (RegressionCause){.of_view = of_view, .order = at};
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
        folders[side] = shown_find(&causes->regression->shown, at->at[side]->path, &(Error){0}); /* known by now */
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
    if (at->alone) return; /* its own words say it */
    const TrajectoryDifference *first =
        regression->first_run >= 0 ? &regression->runs[regression->first_run].difference : NULL;
    if (first != NULL && first->body >= 0)
        snprintf(what, sizeof what, "states differ, body %d first", first->body);
    else if (first == NULL && at->panel > 0)
        snprintf(what, sizeof what, "states differ in panel %d", at->panel);
    add_cause(causes, frame, what, 0, false);
}

/* The named changes, or that there is a difference. Content of a picture that is a case of its own has no cause beyond
   it. */
static void add_changes(const Causes *causes, int frame) {
    const FrameChanges *changes = causes->regression->frames[frame].changes;
    const bool alone = causes->regression->frames[frame].alone;
    bool named = changes != NULL && changes->count > 0;
    for (int i = 0; named && i < changes->count; i++) {
        const Change *change = &changes->list[i];
        if (alone && change->subject == SUBJECT_CONTENT) continue;
        double most = change->kind == CHANGE_MOVED ? fmax(fabs(change->right), fabs(change->up)) : 0;
        add_cause(causes, frame, change_cause(change).text, most, false);
    }
    if (!named && !alone) add_cause(causes, frame, "pixels differ", 0, false);
}

static void add_causes(const Causes *causes, int frame) {
    const RegressionFrame *at = &causes->regression->frames[frame];
    bool pictures = at->pixels == PIXELS_DIFFER || at->pixels == PIXELS_RESIZED;
    if (at->pixels >= PIXELS_MISSING) return;
    if (at->pixels == PIXELS_RESIZED && !at->alone) add_cause(causes, frame, "sizes differ", 0, false);
    if (pictures && at->other_view) add_view(causes, frame);
    if (at->states == STATES_DIFFER)
        add_physics(causes, frame);
    else if (at->pixels == PIXELS_DIFFER && !at->other_view)
        add_changes(causes, frame);
}

static int view_first(const void *a, const void *b) {
    const RegressionCause *x = a, *y = b;
    if (x->of_view != y->of_view) return x->of_view ? -1 : 1;
    return x->order - y->order;
}

bool regression_find_causes(Regression *regression, Error *error) {
    const Causes causes = {regression, is_numbered(regression)};
    regression->causes = calloc(CAUSES_MAX, sizeof *regression->causes);
    if (regression->causes == NULL) return error_memory(error, "causes");
    for (int i = 0; i < regression->count; i++) add_causes(&causes, i);
    for (int i = 0; i < regression->cause_count; i++) put_frames(&causes, &regression->causes[i]);
    qsort(regression->causes, (size_t)regression->cause_count, sizeof *regression->causes, view_first);
    return true;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is behind the pictures: whether their states differ, and the names of what changed in them. */
#include "base/base.h"
#include "base/file.h"
#include "pixels/png.h"
#include "regression/naming.h"
#include "regression/regression.h"
#include "regression/regression_internal.h"
#include "regression/view.h"
#include "runs/trajectory.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

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

bool regression_judge_states(const Regression *regression, RegressionFrame *frame, uint8_t *const data[SIDES],
                             const Tolerance *limits, Error *error) {
    Texts texts[SIDES];
    for (RegressionSide side = EXPECTED; side < SIDES; side++)
        if (!read_texts(&texts[side], data[side], frame->files[side].size, error)) return false;
    const SequenceFrame *picture = frame->base;
    const char *a = texts[EXPECTED].states, *b = texts[ACTUAL].states;
    const char *number = texts[EXPECTED].frame, *scene = texts[EXPECTED].scene;
    const int64_t at = number[0] >= '0' && number[0] <= '9' ? strtoll(number, NULL, 10) : picture->number;
    bool known = a[0] != '\0' && b[0] != '\0', differs = known && strcmp(a, b) != 0, within = false, beyond = false;
    if (differs) /* the first panel: "a1 | b2" and "a1 | c3" give 2 */
        for (frame->panel = 1; *a != '\0' && *a == *b; a++, b++) frame->panel += *a == '|';
    /* Runs of the picture's folder and scene, or of any scene if the picture names none. */
    for (int i = 0; i < regression->run_count; i++) {
        const RegressionRun *run = &regression->runs[i];
        if (run->read_error != NULL) continue;
        if (file_folder_length(run->name) != (size_t)picture->folder ||
            memcmp(run->name, picture->name, (size_t)picture->folder) != 0)
            continue;
        known = true;
        if (run->differs == NULL || (scene[0] != '\0' && strcmp(scene, run->scene) != 0)) continue;
        const int64_t last = at < run->frames ? at : run->frames - 1;
        frame->run_differs = true;
        if (!run->differs[last < 0 ? 0 : last]) continue;
        differs = true;
        within = within || run->within;
        beyond = beyond || (regression->options.poses.given && !run->within);
    }
    frame->states_failed = differs && (beyond || !(within || limits->given != 0));
    frame->states = differs ? STATES_DIFFER : known ? STATES_EQUAL : STATES_UNKNOWN;
    return true;
}

/* The frame number of a picture of a stored frame; -1 for others: interpolated poses, other programs. */
static int64_t stored_frame(const Texts *texts) {
    const char *frame = texts->frame;
    return texts->part[0] == '\0' && frame[0] >= '0' && frame[0] <= '9' ? strtoll(frame, NULL, 10) : -1;
}

/* *run: the run of this name if the picture shows it: if its state in this frame is one of those that the picture's
   text names. An overlay has more states than panels, and a difference one more; so any of them will do. Else NULL. */
static bool find_shown_run(ShownFolder *folder, const char *name, int frame, const char *states, const Trajectory **run,
                           Error *error) {
    char hash[20];
    if (!shown_run(folder, name, run, error)) return false;
    const Trajectory *found = *run;
    if (found != NULL && found->frames > 0)
        snprintf(hash, sizeof hash, "%016" PRIx64,
                 trajectory_frame_hash(found, frame < found->frames ? frame : found->frames - 1));
    if (found == NULL || found->frames < 1 || strstr(states, hash) == NULL) *run = NULL;
    return true;
}

/* The folders of the frame. */
static bool find_folders(Regression *regression, const RegressionFrame *frame, ShownFolder *folders[SIDES],
                         Error *error) {
    for (RegressionSide side = EXPECTED; side < SIDES; side++)
        if ((folders[side] = shown_find(&regression->shown, frame->at[side]->path, error)) == NULL) return false;
    return true;
}

bool regression_may_name(Regression *regression, const RegressionFrame *frame, bool *named, Error *error) {
    ShownFolder *folders[SIDES];
    const int64_t pixels = (int64_t)frame->files[EXPECTED].width * frame->files[EXPECTED].height;
    if (!find_folders(regression, frame, folders, error)) return false;
    *named = folders[EXPECTED]->view.width > 0 && folders[ACTUAL]->view.width > 0 && pixels <= NAMING_PIXELS_MAX;
    return true;
}

bool regression_keep_regions(RegressionFrame *frame, const ImageRegions *regions, Error *error) {
    if ((frame->changes = calloc(1, sizeof *frame->changes)) == NULL) return error_memory(error, frame_name(frame));
    memset(frame->changes->region_change, -1, sizeof frame->changes->region_change);
    frame->changes->regions = *regions;
    return true;
}

bool regression_name_changes(Regression *regression, RegressionFrame *frame, uint8_t *const data[SIDES],
                             uint8_t *levels, Error *error) {
    ShownFolder *folders[SIDES];
    const RegressionFile *of = &frame->files[EXPECTED];
    Texts texts[SIDES];
    if (!frame_failed(frame)) return true;
    if (!find_folders(regression, frame, folders, error)) return false;
    const FrameView *a = &folders[EXPECTED]->view, *b = &folders[ACTUAL]->view;
    if (a->width != of->width || a->height != of->height || b->width != a->width || b->height != a->height) return true;
    for (RegressionSide side = EXPECTED; side < SIDES; side++)
        if (!read_texts(&texts[side], data[side], frame->files[side].size, error)) return false;
    if (texts[EXPECTED].card[0] != '\0' || texts[ACTUAL].card[0] != '\0') return true; /* it has a layout of its own */
    frame->other_view = view_difference(a, b).text[0] != '\0';
    if (frame->other_view) return true;
    NamingScene scene = {.view = a, .frame = (int)stored_frame(&texts[EXPECTED])};
    const bool same_frame = scene.frame >= 0 && stored_frame(&texts[ACTUAL]) == scene.frame;
    for (RegressionSide side = EXPECTED; same_frame && side < SIDES; side++)
        for (int i = 0; i < a->panel_count; i++) {
            const ViewPanel *panel = &a->panels[i];
            const char *states = texts[side].states;
            if (!find_shown_run(folders[side], panel->run, scene.frame, states, &scene.runs[i][side], error))
                return false;
            for (int k = 0; side == EXPECTED && k < panel->outline_count; k++)
                if (!find_shown_run(folders[side], panel->outlines[k], scene.frame, states, &scene.outlines[i][k],
                                    error))
                    return false;
        }
    return naming_find(&scene, levels, &frame->difference, frame->changes, error);
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "regression/regression_changes.h"

#include "naming/naming.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

static bool has_text(const uint8_t *data, size_t size, const char *key) {
    char text[32];
    image_find_text(data, size, key, text, sizeof text);
    return text[0] != '\0';
}

/* The frame number of a picture of a stored frame; -1 for others: interpolated poses, other programs. */
static int64_t stored_frame(const uint8_t *data, size_t size) {
    char text[32];
    if (has_text(data, size, "Part")) return -1;
    image_find_text(data, size, "Frame", text, sizeof text);
    return text[0] >= '0' && text[0] <= '9' ? strtoll(text, NULL, 10) : -1;
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

static bool name_changes(const ShownFolder *const folders[SIDES], const RegressionFrame *frame,
                         uint8_t *const data[SIDES], const Image *const images[SIDES], const uint8_t *masked,
                         FrameChanges *changes, Error *error) {
    const View *view = &folders[EXPECTED]->view;
    NamingScene scene = {.view = view};
    for (RegressionSide side = EXPECTED; side < SIDES; side++) {
        char states[512];
        size_t size = frame->files[side].size;
        int64_t number = stored_frame(data[side], size);
        image_find_text(data[side], size, "State", states, sizeof states);
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
    const View *a = &folders[EXPECTED]->view, *b = &folders[ACTUAL]->view;
    if (a->width != images[EXPECTED]->width || a->height != images[EXPECTED]->height) return true;
    if (b->width != a->width || b->height != a->height) return true;
    for (RegressionSide side = EXPECTED; side < SIDES; side++)
        if (has_text(data[side], frame->files[side].size, "Card")) return true; /* it has a layout of its own */
    frame->other_view = view_difference(a, b).text[0] != '\0';
    if (frame->other_view) return true;
    return name_changes(folders, frame, data, images, masked, changes, error);
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "regression/regression_changes.h"

#include "naming/naming.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

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
    const View *view = &folders[EXPECTED]->view;
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
    const View *a = &folders[EXPECTED]->view, *b = &folders[ACTUAL]->view;
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

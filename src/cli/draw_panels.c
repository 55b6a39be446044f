/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/draw_panels.h"

#include "cli/progress_bar.h"
#include "render/video.h"

#include <stdio.h>
#include <unistd.h>

RenderOptions draw_panels_defaults(const char *directory) {
    long cores = sysconf(_SC_NPROCESSORS_ONLN);
    return (RenderOptions){.width = 1920,
                           .height = 1080,
                           .first = 0,
                           .last = -1,
                           .jobs = cores < 1                 ? 1
                                   : cores > RENDER_JOBS_MAX ? RENDER_JOBS_MAX
                                                             : (int)cores,
                           .directory = directory};
}

int panels_last_frame(const Panels *panels) {
    int frames = 0;
    for (int i = 0; i < panels->count; i++)
        if (panels->runs[i]->frames > frames) frames = panels->runs[i]->frames;
    return frames - 1;
}

static bool draw(const Panels *panels, const RenderOptions *render, Error *error) {
    ProgressBar bar;
    progress_bar_begin(&bar, "drawing");
    bool ok = render_sequence((const Trajectory *const *)panels->runs, panels->count, render, &bar.progress, error);
    progress_bar_end(&bar);
    return ok;
}

static bool encode(const char *path, const Panels *panels, const RenderOptions *render, Error *error) {
    if (path == NULL) return true;
    VideoOptions video = {.directory = render->directory,
                          .first = render->first,
                          .last = render->last,
                          .frame_rate = 1 / (double)panels->runs[0]->dt,
                          .path = path};
    ProgressBar bar;
    progress_bar_begin(&bar, "encoding");
    bool ok = video_encode(&video, &bar.progress, error);
    progress_bar_end(&bar);
    return ok;
}

/* Frames of an earlier, longer run would pass for this one's. */
static void remove_stale_frames(const RenderOptions *render) {
    char path[4096];
    for (int frame = render->last + 1;; frame++) {
        if (snprintf(path, sizeof path, "%s/frame_%06d.png", render->directory, frame) >= (int)sizeof path) return;
        if (unlink(path) != 0) return;
    }
}

bool draw_panels(const Panels *panels, RenderOptions *render, const char *video, Error *error) {
    int last = panels_last_frame(panels);
    if (render->last < 0) render->last = last;
    if (!draw(panels, render, error)) return false;
    if (render->first == 0 && render->last == last) remove_stale_frames(render);
    return encode(video, panels, render, error);
}

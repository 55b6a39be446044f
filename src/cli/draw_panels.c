/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/draw_panels.h"

#include "cli/notes.h"
#include "cli/progress_bar.h"
#include "common/text_add.h"
#include "render/video.h"
#include "simulate/method.h"

#include <signal.h>
#include <stdlib.h>
#include <string.h>
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
                           .directory = directory,
                           .describe = method_describe};
}

int panels_last_frame(const Panels *panels) {
    int frames = 0;
    for (int i = 0; i < panels->count; i++)
        if (panels->runs[i]->frames > frames) frames = panels->runs[i]->frames;
    return frames - 1;
}

static bool is_output(const char *path) { return strcmp(path, "-") == 0; }

bool draw_videos_use_output(const DrawVideos *videos) {
    for (int i = 0; i < videos->count; i++)
        if (is_output(videos->paths[i])) return true;
    return false;
}

/* What the machine that encodes must have. */
static bool check_place(const char *path, int width, int height, Error *error) {
    if (!is_output(path)) return video_check(path, width, height, error);
    return !isatty(STDOUT_FILENO) ||
           error_input(error, "--video", "'-' writes a video to standard output, which is a terminal");
}

bool draw_videos_check(const DrawVideos *videos, int width, int height, bool of_merge, Error *error) {
    bool files = false;
    for (int i = 0; i < videos->count; i++) {
        const char *path = videos->paths[i];
        for (int k = 0; k < i; k++)
            if (strcmp(path, videos->paths[k]) == 0) return error_input(error, "--video", "'%s' twice", path);
        if (!is_output(path) && !video_check_format(path, width, height, error)) return false;
        if (!of_merge && !check_place(path, width, height, error)) return false;
        files = files || !is_output(path);
    }
    return !files || of_merge || video_check_programs(error);
}

static bool draw(const Panels *panels, const RenderOptions *render, RenderStudy *study, RenderResult *result,
                 Error *error) {
    const Progress *progress = progress_bar_begin("drawing");
    note_verbose("drawing %d panel%s, %d x %d pixels, at most %d process%s", panels->count, plural(panels->count),
                 render->width, render->height, render->jobs, render->jobs == 1 ? "" : "es");
    bool ok =
        render_study((const Trajectory *const *)panels->runs, panels->count, render, study, result, progress, error);
    progress_bar_end();
    return ok;
}

/* A closed pipe is reported as an error; without this, SIGPIPE would end the program. */
static bool write_output(VideoOptions *video, const Progress *progress, Error *error) {
    video->path = "standard output";
    void (*before)(int) = signal(SIGPIPE, SIG_IGN);
    bool ok = video_write_y4m(video, STDOUT_FILENO, progress, error);
    signal(SIGPIPE, before);
    return ok;
}

static bool encode(const char *path, const RenderOptions *render, const RenderResult *result, Error *error) {
    VideoOptions video = {.directory = render->directory,
                          .first = result->first,
                          .last = result->last,
                          .frame_rate = result->rate,
                          .hashes = result->hashes,
                          .path = path,
                          .rate_is_chosen = render->fps > 0};
    const Progress *progress = progress_bar_begin(is_output(path) ? "writing" : "encoding");
    bool ok = is_output(path) ? write_output(&video, progress, error) : video_encode(&video, progress, error);
    progress_bar_end();
    return ok;
}

bool draw_panels(const Panels *panels, const RenderOptions *render, const DrawVideos *videos, RenderStudy *study,
                 RenderResult *result, Error *error) {
    bool ok = draw(panels, render, study, result, error);
    const bool shard = study != NULL && study->pieces.mode == PIECES_SHARD;
    for (int i = 0; ok && !shard && i < videos->count; i++) ok = encode(videos->paths[i], render, result, error);
    free(result->hashes);
    result->hashes = NULL;
    return ok;
}

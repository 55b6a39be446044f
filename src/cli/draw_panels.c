/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Frames and videos of panels, their notes, and what shards of a film share. */
#include "base/base.h"
#include "base/file.h"
#include "base/machine.h"
#include "cli/draw_panels.h"
#include "cli/notes.h"
#include "cli/panels.h"
#include "cli/progress_bar.h"
#include "methods/methods.h"
#include "pictures/picture.h"
#include "pictures/render.h"
#include "runs/pieces.h"
#include "runs/trajectory.h"
#include "scenes/scenes.h"

#include <inttypes.h>
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

bool draw_videos_use_output(const DrawVideos *videos) {
    for (int i = 0; i < videos->count; i++)
        if (path_is_standard(videos->paths[i])) return true;
    return false;
}

/* What the machine that encodes must have. */
static bool check_place(const char *path, int width, int height, Error *error) {
    if (!path_is_standard(path)) return video_check(path, width, height, error);
    return !isatty(STDOUT_FILENO) ||
           error_input(error, "--video", "'-' writes a video to standard output, which is a terminal");
}

bool draw_videos_check(const DrawVideos *videos, int width, int height, bool of_merge, Error *error) {
    bool files = false;
    for (int i = 0; i < videos->count; i++) {
        const char *path = videos->paths[i];
        for (int k = 0; k < i; k++)
            if (strcmp(path, videos->paths[k]) == 0) return error_input(error, "--video", "'%s' twice", path);
        if (!path_is_standard(path) && !video_check_format(path, width, height, error)) return false;
        if (!of_merge && !check_place(path, width, height, error)) return false;
        files = files || !path_is_standard(path);
    }
    return !files || of_merge || video_check_programs(error);
}

static bool draw_panels_draw(const Panels *panels, const RenderOptions *render, RenderStudy *study,
                             RenderResult *result, Error *error) {
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

static bool draw_panels_encode(const char *path, const RenderOptions *render, const RenderResult *result,
                               Error *error) {
    VideoOptions video = {.directory = render->directory,
                          .first = result->first,
                          .last = result->last,
                          .frame_rate = result->rate,
                          .hashes = result->hashes,
                          .path = path,
                          .rate_is_chosen = render->fps > 0};
    const Progress *progress = progress_bar_begin(path_is_standard(path) ? "writing" : "encoding");
    bool ok = path_is_standard(path) ? write_output(&video, progress, error) : video_encode(&video, progress, error);
    progress_bar_end();
    return ok;
}

bool draw_panels(const Panels *panels, const RenderOptions *render, const DrawVideos *videos, RenderStudy *study,
                 RenderResult *result, Error *error) {
    bool ok = draw_panels_draw(panels, render, study, result, error);
    const bool shard = study != NULL && study->pieces.mode == PIECES_SHARD;
    for (int i = 0; ok && !shard && i < videos->count; i++)
        ok = draw_panels_encode(videos->paths[i], render, result, error);
    free(result->hashes);
    result->hashes = NULL;
    return ok;
}

static bool draw_panels_differ(const Trajectory *a, const Trajectory *b) {
    return a->scene_hash != 0 && b->scene_hash != 0 &&
           (a->scene_hash != b->scene_hash || strcmp(a->scene, b->scene) != 0);
}

void note_different_scenes(const Trajectory *const *runs, int count) {
    for (int i = 1; i < count; i++) {
        const Trajectory *a = runs[0], *b = runs[i];
        if (!draw_panels_differ(a, b)) continue;
        if (strcmp(a->scene, b->scene) != 0)
            note_print("the runs are of different scenes: %s (by %s) and %s (by %s)", a->scene, a->method, b->scene,
                       b->method);
        else
            note_print(
                "the runs of %s by %s and by %s are of different scenes: their launches, settings or files differ "
                "(scene_hash %016" PRIx64 " and %016" PRIx64 ")",
                a->scene, a->method, b->method, a->scene_hash, b->scene_hash);
        return;
    }
}

void note_missing_impact(const MomentPlan *plan, int impact) {
    char slow[64] = "nothing is slowed down";
    if (impact >= plan->first && impact <= plan->last) return;
    if (plan->slow > 1)
        snprintf(slow, sizeof slow, "frames %d to %d beside it are slowed down", plan->slow_first, plan->slow_last);
    if (impact < 0)
        note_print("--slow: no run has a contact of the bomb with a box; %s", slow);
    else
        note_print("--slow: frames %d to %d do not contain the impact, frame %d; %s", plan->first, plan->last, impact,
                   slow);
}

bool render_key(StudyKey *key, const Panels *panels, const DrawVideos *videos, const char *costs, Error *error) {
    if (!study_key_begin(key, error)) return false;
    for (int i = 0; i < panels->count; i++)
        if (!study_key_add_input(key, panels->inputs[i], trajectory_hash(panels->runs[i]), error)) return false;
    for (int i = 0; i < videos->count; i++) study_key_add(key, videos->paths[i], strlen(videos->paths[i]));
    return costs == NULL || study_key_add_file(key, costs, error);
}

bool render_check_again(const char *path, Error *error) {
    return path == NULL || !path_is_standard(path) ||
           error_input(error, "--shard", "the merge cannot read standard input again; give the run as a file");
}

bool render_store_runs(void *context, Error *error) {
    const RunsPlace *place = context;
    return panels_store(place->panels, place->directory, error);
}

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

#include <dirent.h>
#include <errno.h>
#include <inttypes.h>
#include <limits.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
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

/* Files in the folder of a sequence that could be mistaken for a part of it. */

enum { SHOWN_MAX = 5, TEXT_SIZE = 1024 };

/* The number of a frame's file, or -1. */
static int frame_of(const char *name) {
    int index = -1;
    char own[SINK_NAME_SIZE];
    if (sscanf(name, "frame_%9d.png", &index) != 1 || index < 0) return -1;
    sink_frame_name(own, index);
    return strcmp(name, own) == 0 ? index : -1;
}

static bool is_of_sequence(const char *name, const RenderResult *result, const Panels *panels) {
    const int frame = frame_of(name);
    if (frame >= 0) return frame >= result->first && frame <= result->last;
    for (int i = 0; i < panels->count; i++) {
        char own[TRAJECTORY_FILE_NAME_SIZE];
        trajectory_file_name((const Trajectory *const *)panels->runs, i, own);
        if (strcmp(name, own) == 0) return true;
    }
    return false;
}

/* False with an error if the system fails. */
static bool look_up(const char *path, struct stat *status, Error *error) {
    *status = (struct stat){.st_ino = 0};
    return stat(path, status) == 0 || errno == ENOENT || errno == ENOTDIR || errno == ELOOP || errno == EACCES ||
           error_system(error, path, "cannot be read: %s", strerror(errno));
}

static bool is_input(const char *directory, const char *name, const Panels *panels, Error *error) {
    char path[PATH_MAX];
    struct stat file, input;
    if (snprintf(path, sizeof path, "%s/%s", directory, name) >= (int)sizeof path || !look_up(path, &file, error))
        return false;
    for (int i = 0; i < panels->count; i++) {
        if (!look_up(panels->inputs[i], &input, error)) return false;
        if (input.st_ino != 0 && input.st_dev == file.st_dev && input.st_ino == file.st_ino) return true;
    }
    return false;
}

static bool foreign_add(FolderList *names, const char *name, Error *error) {
    char *copy = strdup(name);
    if (copy != NULL &&
        array_reserve((void **)&names->names, &names->capacity, names->count + 1, sizeof *names->names)) {
        names->names[names->count++] = copy;
        return true;
    }
    free(copy);
    return error_memory(error, "render");
}

static bool collect_entry(FolderList *names, const char *directory, const char *name, const RenderResult *result,
                          const Panels *panels, Error *error) {
    if (name[0] == '.' || (!file_name_ends_with(name, ".png") && !file_name_ends_with(name, ".npz")) ||
        is_of_sequence(name, result, panels) || is_input(directory, name, panels, error))
        return true;
    return error->kind == ERROR_NONE && foreign_add(names, name, error);
}

static bool foreign_collect(FolderList *names, const char *directory, const RenderResult *result, const Panels *panels,
                            Error *error) {
    DIR *folder = opendir(directory);
    if (folder == NULL) return folder_error(directory, error);
    const struct dirent *entry;
    bool ok = true;
    do {
        errno = 0; /* readdir() returns NULL at the end and on failure */
        entry = readdir(folder);
        if (entry != NULL)
            ok = collect_entry(names, directory, entry->d_name, result, panels, error);
        else if (errno != 0)
            ok = error_system(error, directory, "cannot be read: %s", strerror(errno));
    } while (ok && entry != NULL);
    closedir(folder);
    return ok;
}

static int by_name(const void *a, const void *b) { return strcmp(*(char *const *)a, *(char *const *)b); }

/* Frames that follow each other are named by the first and the last. */
static size_t end_of_range(const FolderList *names, size_t first) {
    size_t last = first;
    const int frame = frame_of(names->names[first]);
    while (frame >= 0 && last + 1 < names->count && frame_of(names->names[last + 1]) == frame + (int)(last + 1 - first))
        last++;
    return last;
}

static void foreign_describe(const FolderList *names, char text[TEXT_SIZE]) {
    size_t i = 0;
    for (int shown = 0; shown < SHOWN_MAX && i < names->count; shown++) {
        const size_t last = end_of_range(names, i);
        text_add(text, TEXT_SIZE, "%s%.100s", shown > 0 ? ", " : "", names->names[i]);
        if (last > i) text_add(text, TEXT_SIZE, "%s%s", last > i + 1 ? " ... " : ", ", names->names[last]);
        i = last + 1;
    }
    if (i < names->count) text_add(text, TEXT_SIZE, " and %zu more", names->count - i);
}

bool note_foreign_files(const char *directory, const RenderResult *result, const Panels *panels, Error *error) {
    FolderList names = {0};
    char text[TEXT_SIZE] = "";
    const bool ok = foreign_collect(&names, directory, result, panels, error);
    if (ok && names.count > 0) {
        qsort(names.names, names.count, sizeof *names.names, by_name);
        foreign_describe(&names, text);
        note_print("%s also has %zu file%s that %s not of this sequence: %s", directory, names.count,
                   plural((int)names.count), names.count > 1 ? "are" : "is", text);
    }
    folder_list_free(&names);
    return ok;
}

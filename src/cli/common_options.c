/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Options that several commands have, and the checks of their outputs. */
#include "base/base.h"
#include "base/file.h"
#include "base/npz.h"
#include "cli/cli.h"
#include "cli/options.h"
#include "pictures/picture.h"
#include "runs/pieces.h"
#include "runs/trajectory.h"

#include <errno.h>
#include <inttypes.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

bool camera_option_read(const Option *option, const char *text, void *value, Error *error) {
    CameraView *view = value;
    double *const numbers[] = {&view->x, &view->y, &view->width, &view->height};
    const char *rest = text;
    for (int i = 0; i < 4; i++) {
        if (!parse_leading_double(rest, numbers[i], &rest) || *rest != (i < 3 ? ',' : '\0'))
            return error_input(error, option->name,
                               "'%s' is not X,Y,W,H, the centre and the size of the view in metres, such as 0,5,16,9",
                               text);
        rest++;
    }
    return camera_view_is_usable(view) ||
           error_input(
               error, option->name,
               "'%s': the size must be from 0.001 to less than 100000 m, the centre nearer than 100000 m to the "
               "origin",
               text);
}

bool camera_option_load(const char *path, const CameraView *view, Trajectory **run, Error *error) {
    *run = NULL;
    if (path == NULL) return true;
    if (view->width > 0) return error_input(error, "--view-from", "cannot be combined with --camera X,Y,W,H");
    *run = trajectory_read(path, error);
    return *run != NULL;
}

bool frames_option_split(const char *text, char separator, int minimum, int maximum, int64_t numbers[2]) {
    const char *middle = text;
    if (*text != separator && !parse_leading_int(text, minimum, maximum, &numbers[0], &middle)) return false;
    return *middle == separator && (middle[1] == '\0' || parse_int(middle + 1, minimum, maximum, &numbers[1]));
}

bool frames_option_read(const Option *option, const char *text, void *value, Error *error) {
    FrameRange *range = value;
    int64_t frames[2] = {0, -1};
    bool ok = strchr(text, ':') != NULL ? strcmp(text, ":") != 0 && frames_option_split(text, ':', 0, INT_MAX, frames)
                                        : parse_int(text, 0, INT_MAX, &frames[0]) && ((frames[1] = frames[0]), true);
    if (!ok || (frames[1] != -1 && frames[1] < frames[0]))
        return error_input(error, option->name, "'%s' is not A:B with frame numbers 0 <= A <= B", text);
    range->first = (int)frames[0];
    range->last = (int)frames[1];
    return true;
}

/* What is given to shard_option_take() by the merge. */
static const PiecesRun *merging;

void shard_option_merge(const PiecesRun *run) { merging = run; }

/* The arguments that all shards have: without --shard, whose value differs. They last as long as the program. */
static bool keep_arguments(PiecesRun *run, int argc, char **argv, Error *error) {
    static char **kept;
    free(kept);
    kept = calloc((size_t)argc + 1, sizeof *kept);
    if (kept == NULL) return error_memory(error, argv[0]);
    run->argv = kept;
    for (int i = 0; i < argc; i++) {
        if (strncmp(argv[i], "--sha", strlen("--sha")) != 0)
            kept[run->argc++] = argv[i];
        else if (strchr(argv[i], '=') == NULL)
            i++;
    }
    return true;
}

bool shard_option_take(PiecesRun *run, const char *option, int argc, char **argv, Error *error) {
    *run = (PiecesRun){0};
    if (merging != NULL) {
        *run = *merging;
        return true;
    }
    if (!shard_request(&run->request, option, error) || !keep_arguments(run, argc, argv, error)) return false;
    if (run->request.source[0] != '\0')
        note_print("shard %d of %d, by %s; --shard 1/1 does all", run->request.shard.number, run->request.shard.count,
                   run->request.source);
    return true;
}

void shard_option_print(const Pieces *pieces, const char *output) {
    printf("shard %d of %d: %" PRId64 " pieces, %" PRId64 " of them done before -> %s\n", pieces->shard.number,
           pieces->shard.count, pieces->own - pieces->waiting, pieces->kept, pieces->folder);
    if (pieces->waiting > 0)
        printf("    %" PRId64 " more need pieces of other shards: run this shard again when those are done\n",
               pieces->waiting);
    printf("    this is one part of %d; when all shards are done: twinbox merge %s\n", pieces->shard.count, output);
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

enum { KIND_SIZE = 64 };

/* Makes a file that goes at once: permissions alone do not tell, as for root, full tables or /proc. `folder` ends in a
   slash or is empty. */
static bool try_folder(const char *folder, const char *path, Error *error) {
    char inside[PATH_MAX];
    if (!file_path(inside, sizeof inside, error, "%sfile", folder)) return false;
    const int file = temporary_nameless(inside);
    if (file < 0) return error_system(error, path, "cannot write: %s", file_make_cause(inside, errno));
    close(file);
    return true;
}

/* /dev/stdout may be a regular file. */
static bool is_standard_output(const struct stat *status) {
    struct stat output;
    return fstat(STDOUT_FILENO, &output) == 0 && output.st_dev == status->st_dev && output.st_ino == status->st_ino;
}

bool output_check_file(const char *path, const char *ending, Error *error) {
    struct stat status;
    char folder[PATH_MAX];
    if (path_is_standard(path)) return true;
    const bool there = stat(path, &status) == 0;
    if (there && S_ISDIR(status.st_mode)) return error_input(error, path, "is a folder; expected the name of a file");
    if (there && (!S_ISREG(status.st_mode) || is_standard_output(&status))) return true;
    if (ending != NULL && !file_name_ends_with(path, ending))
        return error_input(error, path, "the name must end in %s", ending);
    return file_path(folder, sizeof folder, error, "%.*s", (int)file_folder_length(path), path) &&
           try_folder(folder, path, error);
}

/* What an existing file holds: "unknown" if it is not an .npz file. */
static bool find_kind(const char *path, char kind[KIND_SIZE], Error *error) {
    Error failure = {0};
    NpzFile *file = npz_open(path, &failure);
    snprintf(kind, KIND_SIZE, "unknown");
    if (file != NULL && !npz_has(file, "kind") && npz_has(file, "position")) snprintf(kind, KIND_SIZE, "run");
    if (file != NULL && npz_has(file, "kind") && !npz_read_name(file, "kind", kind, KIND_SIZE, &failure))
        snprintf(kind, KIND_SIZE, "unknown");
    npz_close(file);
    if (failure.kind == ERROR_SYSTEM) *error = failure;
    return failure.kind != ERROR_SYSTEM;
}

bool output_check_npz(const char *path, const char *kind, Error *error) {
    struct stat status;
    char found[KIND_SIZE];
    if (!output_check_file(path, ".npz", error)) return false;
    if (path_is_standard(path) || stat(path, &status) != 0 || !S_ISREG(status.st_mode) || status.st_size == 0 ||
        is_standard_output(&status))
        return true;
    if (!find_kind(path, found, error)) return false;
    if (strcmp(found, kind != NULL ? kind : "run") == 0) return true;
    return error_input(error, path,
                       "holds a file of kind '%s', which a file of kind '%s' does not replace; choose another "
                       "name, or remove it",
                       found, kind != NULL ? kind : "run");
}

bool output_check_folder(const char *path, Error *error) {
    struct stat status;
    char folder[PATH_MAX];
    if (!output_check_folder_name(path, error)) return false;
    if (!file_path(folder, sizeof folder - 1, error, "%s", path)) return false;
    size_t length = strlen(folder);
    while (length > 0 && stat(folder, &status) != 0) {
        if (errno == ENOTDIR) return error_system(error, path, "cannot write: a part of the path is not a folder");
        while (length > 0 && folder[length - 1] == '/') length--;
        while (length > 0 && folder[length - 1] != '/') length--;
        folder[length] = '\0';
    }
    if (length > 0 && !S_ISDIR(status.st_mode))
        return error_system(error, path, "cannot write: '%s' is not a folder", folder);
    if (length > 0 && folder[length - 1] != '/') strcat(folder, "/");
    return try_folder(folder, path, error);
}

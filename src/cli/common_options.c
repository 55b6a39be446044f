/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Options that several commands have. */
#include "base/base.h"
#include "cli/common_options.h"
#include "cli/notes.h"
#include "cli/options.h"
#include "runs/pieces.h"
#include "runs/trajectory.h"

#include <inttypes.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

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
               "'%s': the size must be from 0.001 to less than 100000 m, the centre nearer than 100000 m to the origin",
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

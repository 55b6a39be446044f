/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Options that several commands have. */
#include "base/base.h"
#include "cli/common_options.h"
#include "cli/options.h"
#include "runs/pieces.h"
#include "runs/trajectory.h"

#include <inttypes.h>
#include <limits.h>
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

bool shard_option_read(const Option *option, const char *text, void *value, Error *error) {
    int64_t numbers[2];
    const char *rest;
    if (!parse_leading_int(text, 0, INT32_MAX, &numbers[0], &rest) || *rest != '/' ||
        !parse_int(rest + 1, 0, INT32_MAX, &numbers[1]))
        return error_input(error, option->name, "'%s' is not K/N, such as 3/16", text);
    if (numbers[1] < 1 || numbers[1] > SHARDS_MAX)
        return error_input(error, option->name, "'%s': N must be from 1 to %d", text, SHARDS_MAX);
    if (numbers[0] < 1 || numbers[0] > numbers[1])
        return error_input(error, option->name, "'%s': K must be from 1 to N", text);
    *(Shard *)value = (Shard){(int)numbers[0], (int)numbers[1]};
    return true;
}

void shard_option_print(const Pieces *pieces) {
    printf("shard %d of %d: %" PRId64 " pieces, %" PRId64 " of them done before -> %s\n", pieces->shard.number,
           pieces->shard.count, pieces->own - pieces->left, pieces->kept, pieces->folder);
    if (pieces->left > 0)
        printf("    left to the command without --shard, as they are timed or need others: %" PRId64 "\n",
               pieces->left);
    printf("    the same command without --shard does what is missing and writes the results\n");
}

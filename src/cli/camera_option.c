/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/camera_option.h"

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

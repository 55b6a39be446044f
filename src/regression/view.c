/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The view that a manifest describes, how two views differ, and what the pictures of a folder show. */
#include "regression/view.h"

#include "base/base.h"
#include "base/file.h"
#include "base/json.h"
#include "regression/sequence.h"
#include "runs/trajectory.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Members before the view: render writes 13. */
enum { MAX_SIZE = 1 << 26, MAX_SIDE = 1 << 16, MAX_MEMBERS = 32 };
static const double MAX_PLACE = 1e9; /* pixels */

static bool bad(const JsonReader *json, Error *error, const char *what) {
    return json_read_error(json, error, "%s expected", what);
}

static bool read_rectangle(const JsonReader *json, const json_t *item, ViewRect *rect, Error *error) {
    const json_t *value = json_object_get(item, "rectangle");
    int64_t numbers[4];
    if (json_array_size(value) != 4) return bad(json, error, "'rectangle' with four numbers");
    for (size_t i = 0; i < 4; i++) {
        const json_t *number = json_array_get(value, i);
        numbers[i] = json_integer_value(number);
        if (!json_is_integer(number) || numbers[i] < -MAX_SIDE || numbers[i] > MAX_SIDE || (i >= 2 && numbers[i] < 0))
            return bad(json, error, "numbers of pixels in 'rectangle'");
    }
    *rect =
        (ViewRect){(int)numbers[0], (int)numbers[1], (int)(numbers[0] + numbers[2]), (int)(numbers[1] + numbers[3])};
    return true;
}

static bool read_number(const json_t *item, const char *key, double *number) {
    const json_t *value = json_object_get(item, key);
    *number = json_number_value(value);
    return json_is_number(value) && fabs(*number) < MAX_PLACE;
}

static bool read_panel(const JsonReader *json, const json_t *item, ViewPanel *panel, Error *error) {
    const json_t *runs = json_object_get(item, "runs");
    if (json_array_size(runs) < 1 || json_array_size(runs) > VIEW_PANELS_MAX)
        return bad(json, error, "'runs' of a panel");
    for (size_t i = 0; i < json_array_size(runs); i++) {
        const char *run = json_string_value(json_array_get(runs, i));
        if (run == NULL || strlen(run) >= VIEW_NAME_SIZE || strchr(run, '/') != NULL || run[0] == '.' ||
            !name_is_text(run))
            return bad(json, error, "'runs' with file names");
        strcpy(i == 0 ? panel->run : panel->outlines[panel->outline_count++], run);
    }
    if (!read_number(item, "scale", &panel->scale) || panel->scale <= 0 || !read_number(item, "left", &panel->left) ||
        !read_number(item, "top", &panel->top))
        return bad(json, error, "'scale', 'left' and 'top'");
    return read_rectangle(json, item, &panel->rect, error);
}

static bool read_part(const JsonReader *json, const json_t *item, ViewPart *part, Error *error) {
    static const char *const names[] = {"header", "caption", "axis", "legend", "timeline"};
    const char *name = json_string_value(json_object_get(item, "part"));
    const json_t *panel = json_object_get(item, "panel");
    size_t kind = 0;
    while (kind < 5 && (name == NULL || strcmp(name, names[kind]) != 0)) kind++;
    if (kind == 5) return bad(json, error, "'part' with a known name");
    int64_t number = json_is_integer(panel) ? json_integer_value(panel) : -1;
    if (number < -1 || number >= VIEW_PANELS_MAX) return bad(json, error, "number of a panel");
    part->kind = (ViewPartKind)kind;
    part->panel = (int)number + 1;
    return read_rectangle(json, item, &part->rect, error);
}

/* A panel lies within the picture. */
static bool read_view(const JsonReader *json, const json_t *value, FrameView *view, Error *error) {
    const json_t *panels = json_object_get(value, "panels"), *parts = json_object_get(value, "parts");
    if (json_array_size(panels) < 1 || json_array_size(panels) > VIEW_PANELS_MAX ||
        json_array_size(parts) > VIEW_PARTS_MAX)
        return bad(json, error, "'panels' and 'parts' of a view");
    for (size_t i = 0; i < json_array_size(panels); i++) {
        ViewPanel *panel = &view->panels[view->panel_count];
        if (!read_panel(json, json_array_get(panels, i), panel, error)) return false;
        const ViewRect *rect = &panel->rect;
        if (rect->left < 0 || rect->top < 0 || rect->right > view->width || rect->bottom > view->height)
            return bad(json, error, "panels inside the picture");
        view->panel_count++;
    }
    for (size_t i = 0; i < json_array_size(parts); i++)
        if (!read_part(json, json_array_get(parts, i), &view->parts[view->part_count++], error)) return false;
    return true;
}

/* The members before the view, and the view. */
static bool read_members(JsonReader *json, FrameView *view, Error *error) {
    if (!json_read_char(json, '{')) return bad(json, error, "'{'");
    int members = 0;
    for (bool more = true; more && members++ < MAX_MEMBERS;) {
        char key[32];
        const json_t *value = json_read_value(json, error);
        if (value == NULL) return false;
        if (!json_is_string(value)) return bad(json, error, "a key");
        snprintf(key, sizeof key, "%s", json_string_value(value));
        if (strcmp(key, "pictures") == 0) return bad(json, error, "'view' before 'pictures'");
        if (!json_read_char(json, ':')) return bad(json, error, "':'");
        if ((value = json_read_value(json, error)) == NULL) return false;
        if (strcmp(key, "size") == 0) {
            const json_int_t width = json_integer_value(json_array_get(value, 0)),
                             height = json_integer_value(json_array_get(value, 1));
            if (width < 1 || height < 1 || width > MAX_SIDE || height > MAX_SIDE)
                return bad(json, error, "'size' in pixels");
            view->width = (int)width, view->height = (int)height;
        } else if (strcmp(key, "look") == 0) {
            const char *compare = json_string_value(json_object_get(value, "compare"));
            const char *camera = json_string_value(json_object_get(value, "camera"));
            const json_t *show = json_object_get(value, "show");
            view->marks = compare != NULL && strcmp(compare, "split") != 0;
            for (size_t i = 0; i < json_array_size(show); i++) {
                const char *name = json_string_value(json_array_get(show, i));
                view->marks =
                    view->marks || (name != NULL && strcmp(name, "timeline") != 0 && strcmp(name, "distance") != 0);
            }
            view->follows = camera != NULL && (strcmp(camera, "bomb") == 0 || strcmp(camera, "divergence") == 0);
        }
        if (strcmp(key, "view") == 0) return read_view(json, value, view, error);
        if (!json_read_more(json, '}', &more, error)) return false;
    }
    return bad(json, error, "'view'");
}

bool view_read(FrameView *view, const char *path, Error *error) {
    JsonReader json;
    FrameView read = {0};
    *view = read;
    if (!json_read_open(&json, path, MAX_SIZE, error)) return false;
    bool ok = read_members(&json, &read, error);
    json_read_close(&json);
    if (ok) *view = read;
    return ok;
}

ViewText view_difference(const FrameView *expected, const FrameView *actual) {
    ViewText words = {""};
    if (expected->width != actual->width || expected->height != actual->height) return words; /* told by the pictures */
    if (expected->panel_count != actual->panel_count) {
        snprintf(words.text, sizeof words.text, "the number of panels differs: %d and %d", expected->panel_count,
                 actual->panel_count);
        return words;
    }
    for (int i = 0; i < expected->panel_count; i++) {
        const ViewPanel *a = &expected->panels[i], *b = &actual->panels[i];
        if (memcmp(&a->rect, &b->rect, sizeof a->rect) != 0) {
            snprintf(words.text, sizeof words.text,
                     "the place of panel %d differs: (%d, %d) to (%d, %d) and (%d, %d) to (%d, %d)", i + 1,
                     a->rect.left, a->rect.top, a->rect.right, a->rect.bottom, b->rect.left, b->rect.top, b->rect.right,
                     b->rect.bottom);
            return words;
        }
        if (a->scale == b->scale && a->left == b->left && a->top == b->top) continue;
        snprintf(words.text, sizeof words.text,
                 "the camera differs: %g and %g pixels/m, x = y = 0 m at pixel (%g, %g) and (%g, %g)", a->scale,
                 b->scale, a->rect.left + a->left, a->rect.top + a->top, b->rect.left + b->left, b->rect.top + b->top);
        return words;
    }
    return words;
}

/* Damage is not reported: without a view or a run there are fewer names, and the comparison of runs reports a damaged
   run itself. A failing system is: names must not depend on it. */
static bool is_harmless(const Error *failure, Error *error) {
    if (failure->kind == ERROR_SYSTEM) *error = *failure;
    return failure->kind != ERROR_SYSTEM;
}

bool shown_run(ShownFolder *folder, const char *name, const Trajectory **run, Error *error) {
    Error failure = {0};
    *run = NULL;
#pragma omp critical(shown_folders)
    {
        int i = 0;
        char path[PATH_MAX];
        while (i < folder->run_count && strcmp(folder->names[i], name) != 0) i++;
        if (i == folder->run_count && i < VIEW_PANELS_MAX) {
            if (file_path(path, sizeof path, &failure, "%s%s", folder->path, name))
                folder->runs[i] = trajectory_read(path, &failure);
            folder->names[folder->run_count++] = name;
        }
        if (i < folder->run_count) *run = folder->runs[i];
    }
    return is_harmless(&failure, error);
}

static ShownFolder *read_folder(const char *picture, size_t length, Error *error) {
    ShownFolder *folder = calloc(1, sizeof *folder);
    char path[PATH_MAX];
    Error failure = {0};
    bool ok = (folder != NULL && (folder->path = strndup(picture, length)) != NULL) || error_memory(error, picture);
    if (ok && file_path(path, sizeof path, &failure, "%smanifest.json", folder->path))
        (void)view_read(&folder->view, path, &failure);
    ok = ok && is_harmless(&failure, error);
    if (!ok && folder != NULL) free(folder->path);
    if (!ok) free(folder);
    return ok ? folder : NULL;
}

ShownFolder *shown_find(Shown *shown, const char *picture, Error *error) {
    size_t length = file_folder_length(picture);
    ShownFolder *found = NULL;
#pragma omp critical(shown_folders)
    {
        found = shown->first;
        while (found != NULL && (strncmp(found->path, picture, length) != 0 || found->path[length] != '\0'))
            found = found->next;
        if (found == NULL && (found = read_folder(picture, length, error)) != NULL) {
            found->next = shown->first;
            shown->first = found;
        }
    }
    return found;
}

void shown_free(Shown *shown) {
    while (shown->first != NULL) {
        ShownFolder *folder = shown->first;
        shown->first = folder->next;
        for (int i = 0; i < folder->run_count; i++) trajectory_destroy(folder->runs[i]);
        free(folder->path);
        free(folder);
    }
}

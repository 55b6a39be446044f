/* SPDX-License-Identifier: GPL-3.0-or-later */
/* manifest.json: its content, and the file with its journal.

   "view" says what is where in the pictures. Rectangles are [x, y, width, height] in pixels, y down.

   "view": {
     "panels": [
       {"rectangle": [46, 61, 570, 614], "runs": ["stack-engine.npz"], "scale": 36, "left": 195, "top": 596}, ...
     ],
     "parts": [
       {"part": "header", "rectangle": [0, 0, 1280, 49]},
       {"part": "caption", "panel": 0, "rectangle": [46, 34, 570, 26]}, ...
     ]
   }

   The point (X, Y) in metres is at pixel (x + left + scale * X, y + top - scale * Y) of the picture. `runs` are the
   files beside the manifest (trajectory_file_name): the first with filled boxes, the others as outlines. Parts are
   header, caption, axis, legend and timeline. With a moving camera, each picture has its own scale, left and top as
   "camera". */
#include "base/base.h"
#include "base/file.h"
#include "base/json.h"
#include "pictures/pictures_internal.h"
#include "pictures/picture.h"
#include "pictures/render.h"
#include "pictures/render_internal.h"
#include "pixels/gl.h"
#include "runs/trajectory.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static void write_rectangle(JsonWriter *json, const Rect *rect) {
    json_begin_array(json, "rectangle", JSON_ONE_LINE);
    json_put_int(json, NULL, rect->left);
    json_put_int(json, NULL, rect->top);
    json_put_int(json, NULL, rect->right - rect->left);
    json_put_int(json, NULL, rect->bottom - rect->top);
    json_end(json);
}

/* The members scale, left and top. */
static void write_camera(JsonWriter *json, const Camera *camera) {
    json_put_number(json, "scale", camera->scale);
    json_put_number(json, "left", camera->left);
    json_put_number(json, "top", camera->top);
}

static void write_view(JsonWriter *json, const Picture *picture) {
    json_begin_object(json, "view", JSON_LINES);
    json_begin_array(json, "panels", JSON_LINES);
    for (int panel = 0; panel < picture->panel_count; panel++) {
        const int filled = picture_run(picture, panel);
        json_begin_object(json, NULL, JSON_ONE_LINE);
        write_rectangle(json, &picture->layout.panels[panel]);
        json_begin_array(json, "runs", JSON_ONE_LINE);
        for (int i = -1; i < picture->count; i++) { /* the run of the filled boxes first */
            char name[TRAJECTORY_FILE_NAME_SIZE];
            if (i >= 0 && !picture_draws_outlines(picture, panel, i)) continue;
            trajectory_file_name(picture->runs, i < 0 ? filled : i, name);
            json_put_text(json, NULL, name);
        }
        json_end(json);
        write_camera(json, &picture->camera);
        json_end(json);
    }
    json_end(json);
    Part parts[PARTS_MAX];
    const int count = parts_find(picture, parts);
    json_begin_array(json, "parts", JSON_LINES);
    for (int i = 0; i < count; i++) {
        json_begin_object(json, NULL, JSON_ONE_LINE);
        json_put_text(json, "part", part_names[parts[i].kind]);
        if (parts[i].panel >= 0) json_put_int(json, "panel", parts[i].panel);
        write_rectangle(json, &parts[i].rect);
        json_end(json);
    }
    json_end(json);
    json_end(json);
}

enum { FORMAT = 1 };

static void write_runs(JsonWriter *json, const Manifest *manifest) {
    json_begin_array(json, "runs", JSON_LINES);
    for (int i = 0; i < manifest->picture->count; i++) {
        const Trajectory *run = manifest->picture->runs[i];
        json_begin_object(json, NULL, JSON_ONE_LINE);
        json_put_text(json, "scene", run->scene);
        json_put_hash(json, "scene_hash", run->scene_hash);
        json_put_text(json, "method", run->method);
        json_put_text(json, "caption", manifest->options->captions[i]);
        colour_put(json, "colour", picture_body_colors(manifest->picture, i)->fill);
        json_put_text(json, "note", manifest->options->notes[i]);
        json_put_text(json, "cost", manifest->options->look.costs[i]);
        json_put_int(json, "frames", run->frames);
        json_put_int(json, "bomb", run->bomb);
        json_put_hash(json, "hash", trajectory_hash(run));
        if (run->network_hash != 0) json_put_hash(json, "network_hash", run->network_hash);
        json_end(json);
    }
    json_end(json);
}

static void write_look(JsonWriter *json, const RenderLook *look) {
    json_begin_object(json, "look", JSON_LINES);
    json_put_text(json, "compare", look_compare_names[look->compare]);
    json_put_text(json, "camera", look_camera_names[look->camera]);
    json_put_text(json, "theme", look_theme_names[look->theme]);
    if (look->labels != LOOK_NO_LABELS) json_put_text(json, "labels", look_labels_names[look->labels]);
    json_begin_array(json, "show", JSON_ONE_LINE);
    for (int i = 0; look_show_names[i] != NULL; i++)
        if (look->show >> i & 1) json_put_text(json, NULL, look_show_names[i]);
    json_end(json);
    json_end(json);
}

static void write_head(JsonWriter *json, const Manifest *manifest) {
    const RenderOptions *options = manifest->options;
    const MomentPlan *plan = manifest->plan;
    json_begin_object(json, NULL, JSON_LINES);
    json_put_text(json, "twinbox", TWINBOX_VERSION);
    json_put_int(json, "format", FORMAT);
    json_begin_array(json, "size", JSON_ONE_LINE);
    json_put_int(json, NULL, options->width);
    json_put_int(json, NULL, options->height);
    json_end(json);
    json_put_number(json, "dt", (double)manifest->picture->runs[0]->dt);
    json_put_text(json, "png", options->small ? "small" : "fast");
    json_put_text(json, "title", options->title);
    json_put_text(json, "end", options->look.end);
    write_runs(json, manifest);
    write_look(json, &options->look);
    /* The range of frames, and the number of pictures of everything else. */
    json_begin_object(json, "order", JSON_LINES);
    json_put_int(json, "first", plan->first);
    json_put_int(json, "last", plan->last);
    json_put_int(json, "title_card", plan->title);
    json_begin_object(json, "slow", JSON_ONE_LINE);
    json_put_int(json, "times", plan->slow);
    json_put_int(json, "first", plan->slow_first);
    json_put_int(json, "last", plan->slow_last);
    json_end(json);
    json_put_number(json, "rate", plan->rate);
    json_put_number(json, "speed", plan->speed);
    json_put_int(json, "hold", plan->hold);
    json_put_int(json, "end_card", plan->end);
    json_end(json);
    write_view(json, manifest->picture);
    json_begin_array(json, "pictures", JSON_LINES);
}

static void write_picture(JsonWriter *json, const Manifest *manifest, int index, PictureHashes hashes) {
    static const char *const kinds[] = {"frame", "between", "title", "end"};
    const Picture *picture = manifest->picture;
    Moment moment = moments_at(manifest->plan, index);
    char text[SINK_NAME_SIZE];
    sink_frame_name(text, index);
    json_begin_object(json, NULL, JSON_ONE_LINE);
    json_put_text(json, "file", text);
    json_put_text(json, "shows", kinds[moment.kind]);
    json_put_int(json, "frame", moment.frame);
    frame_part_text(text, sizeof text, moment);
    if (moment.kind == MOMENT_BETWEEN) json_put_text(json, "part", text);
    if (picture->path != NULL && (moment.kind == MOMENT_STORED || moment.kind == MOMENT_BETWEEN)) {
        const Camera camera = picture_camera(picture, moment);
        json_begin_object(json, "camera", JSON_ONE_LINE);
        write_camera(json, &camera);
        json_end(json);
    }
    json_begin_array(json, "states", JSON_ONE_LINE);
    for (int i = 0; i < picture->count; i++)
        json_put_hash(json, NULL, trajectory_frame_hash(picture->runs[i], picture_run_frame(picture, i, moment.frame)));
    json_end(json);
    json_put_hash(json, "pixels", hashes.pixels);
    json_put_hash(json, "file_hash", hashes.file);
    json_end(json);
}

/* The text before the first picture. */
static void print_head(FILE *out, const void *manifest) {
    JsonWriter json = {.out = out};
    write_head(&json, manifest);
}

void manifest_print_line(FILE *out, const void *context) {
    const ManifestLine *line = context;
    JsonWriter json = {.out = out};
    write_picture(&json, line->manifest, line->index, line->hashes);
}

/* The head and the lines of known pictures. */
static void print_journal(FILE *out, const void *context) {
    const Manifest *manifest = context;
    fprintf(out, "%s\n", manifest->head);
    for (int i = manifest->first; i <= manifest->last; i++)
        if (manifest->known[i - manifest->first])
            manifest_print_line(out, &(ManifestLine){manifest, i, manifest->hashes[i - manifest->first]});
}

static void print_whole(FILE *out, const void *context) {
    const Manifest *manifest = context;
    JsonWriter json = {.out = out};
    write_head(&json, manifest);
    for (int i = manifest->first; i <= manifest->last; i++)
        write_picture(&json, manifest, i, manifest->hashes[i - manifest->first]);
    json_end(&json);
    json_end(&json);
}

/* On disk: the journal, what remains valid of an earlier manifest, and the frames of an earlier sequence in the folder,
   which could be mistaken for frames of this one. */

/* A line ends in `"pixels": "16 digits", "file_hash": "16 digits"}`. */
enum { FILE_FROM_END = 16 + 2, PIXELS_FROM_END = FILE_FROM_END + 16 + 17 };

/* The start of every manifest. */
static const char signature[] = "{\n  \"twinbox\": \"";

bool manifest_open(Manifest *manifest, const Picture *picture, const RenderOptions *options, const MomentPlan *plan,
                   int first, int last, Error *error) {
    static const char name[] = "manifest.json", ending[] = ".part";
    const size_t count = (size_t)(last - first) + 1, room = strlen(options->directory) + sizeof name + sizeof ending;
    size_t size;
    *manifest =
        (Manifest){.picture = picture, .options = options, .plan = plan, .first = first, .last = last, .out = -1};
    manifest->hashes = calloc(1, count * (sizeof *manifest->hashes + sizeof *manifest->known) + 2 * room);
    if (manifest->hashes == NULL) return error_memory(error, options->directory);
    manifest->known = (bool *)(manifest->hashes + count);
    manifest->path = (char *)(manifest->known + count);
    manifest->journal = manifest->path + room;
    snprintf(manifest->path, room, "%s/%s", options->directory, name);
    snprintf(manifest->journal, room, "%s%s", manifest->path, ending);
    manifest->head = file_print(print_head, manifest, &size);
    return manifest->head != NULL || error_memory(error, options->directory);
}

void manifest_close(Manifest *manifest) {
    if (manifest->out >= 0) close(manifest->out);
    free(manifest->head);
    free(manifest->hashes);
}

/* The index of the frame that a line, without indentation and comma, lists, and its hashes as far as the line has any;
   -1: the line lists no frame. */
static int read_line(const char *line, size_t length, PictureHashes *hashes) {
    static const char start[] = "{\"file\": \"frame_";
    if (length < PIXELS_FROM_END) return -1;
    const char *end = line + length, *number = line + sizeof start - 1;
    *hashes = (PictureHashes){strtoull(end - PIXELS_FROM_END, NULL, 16), strtoull(end - FILE_FROM_END, NULL, 16)};
    if (strncmp(line, start, sizeof start - 1) != 0 || !isdigit((unsigned char)*number)) return -1;
    const long index = strtol(number, NULL, 10);
    return index <= INT32_MAX ? (int)index : -1;
}

/* Takes the hashes from a line, if the line equals the expected one with these hashes. */
static void recall_line(Manifest *manifest, const char *line, size_t length) {
    PictureHashes hashes;
    int index = read_line(line, length, &hashes);
    if (index < manifest->first || index > manifest->last) return;
    size_t size;
    char *expected = file_print(manifest_print_line, &(ManifestLine){manifest, index, hashes}, &size);
    /* `expected` ends with a newline. */
    if (expected != NULL && size == length + 1 && memcmp(expected, line, length) == 0) {
        manifest->hashes[index - manifest->first] = hashes;
        manifest->known[index - manifest->first] = true;
    }
    free(expected);
}

/* False, with `why` set, if the file is missing or of other pictures. */
static bool recall_file(Manifest *manifest, const char *path, char *why, size_t why_size) {
    Error error = {0};
    size_t size, head = strlen(manifest->head), count = (size_t)(manifest->last - manifest->first) + 1;
    char *text = file_read(path, head + 2 * (count + 1) * MANIFEST_LINE_SIZE, &size, &error);
    const bool same = text != NULL && strncmp(text, manifest->head, head) == 0;
    if (text == NULL)
        snprintf(why, why_size, "%s", error.message);
    else if (!same) {
        int line = 1;
        for (const char *a = text, *b = manifest->head; *a == *b && *a != '\0'; a++, b++) line += *a == '\n';
        snprintf(why, why_size, "%s:%d differs: other runs, options or version", path, line);
    }
    /* An incomplete last line was cut off by a kill and is ignored. */
    for (char *line = same ? text + head : NULL, *end; same && (end = strchr(line, '\n')) != NULL; line = end + 1) {
        while (*line == ' ') line++;
        size_t length = (size_t)(end - line);
        if (length > 0 && line[length - 1] == ',') length--;
        line[length] = '\0';
        recall_line(manifest, line, length);
    }
    free(text);
    return same;
}

void manifest_recall(Manifest *manifest, char *why, size_t size) {
    char other[256];
    manifest->valid = recall_file(manifest, manifest->path, why, size);
    bool grows = access(manifest->journal, F_OK) == 0 && recall_file(manifest, manifest->journal, other, sizeof other);
    if (manifest->valid || grows) why[0] = '\0';
}

/* A file that is not a manifest belongs to the user and must not be overwritten. */
static bool check_overwritable(const char *path, Error *error) {
    struct stat status;
    char text[sizeof signature] = "";
    if (lstat(path, &status) != 0)
        return errno == ENOENT || error_system(error, path, "cannot be inspected: %s", strerror(errno));
    int file = open(path, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    const ssize_t size = file >= 0 ? file_read_all(file, text, sizeof text - 1) : -1;
    const int cause = size < 0 ? errno : 0;
    if (file >= 0) close(file);
    if (cause_is_system(cause)) return cause_error(cause, path, error);
    if (size == 0 && S_ISREG(status.st_mode)) return true;
    return (size > 0 && strcmp(text, signature) == 0) ||
           error_input(error, path, "is not a manifest of twinbox; move it away or choose another folder");
}

bool manifest_check(const Manifest *manifest, Error *error) {
    return check_overwritable(manifest->path, error) && check_overwritable(manifest->journal, error);
}

/* Removes the frames that the file, the manifest of an earlier sequence or its journal, lists, that the new sequence
   does not overwrite, and whose bytes are unchanged; files of any other origin stay. What is not a regular file lists
   nothing. */
static bool remove_listed(const Manifest *manifest, const char *path, Error *error) {
    const char *directory = manifest->options->directory;
    struct stat status;
    const int file = open(path, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (file < 0) return errno == ENOENT || errno == ELOOP || file_open_error(path, error);
    const bool regular = fstat(file, &status) == 0 && S_ISREG(status.st_mode);
    FILE *list = regular ? fdopen(file, "r") : NULL;
    if (list == NULL) {
        close(file);
        return !regular || error_memory(error, path);
    }
    /* Lines longer than those that manifests have are read in pieces, none of which looks like one. */
    char line[MANIFEST_LINE_SIZE], frame[PATH_MAX];
    bool ok = true;
    while (ok && fgets(line, sizeof line, list) != NULL) {
        const size_t end = strcspn(line, "\n"), begin = strspn(line, " ");
        if (line[end] == '\0' || begin > end) continue;
        line[end > 0 && line[end - 1] == ',' ? end - 1 : end] = '\0';
        PictureHashes hashes;
        const int index = read_line(line + begin, strlen(line + begin), &hashes);
        if (index >= 0 && (index < manifest->first || index > manifest->last) &&
            sink_frame_path(frame, sizeof frame, directory, index) && sink_frame_is(directory, index, hashes.file))
            ok = file_remove(frame, error);
    }
    if (ok && ferror(list)) ok = error_system(error, path, "cannot read: %s", strerror(errno));
    fclose(list);
    return ok;
}

bool manifest_begin(Manifest *manifest, bool whole, Error *error) {
    /* While both are still those of the earlier sequence: what an interrupted call leaves is then listed for the next
       one. */
    if (whole && !(remove_listed(manifest, manifest->path, error) && remove_listed(manifest, manifest->journal, error)))
        return false;
    size_t size;
    char *text = file_print(print_journal, manifest, &size);
    bool ok =
        text != NULL ? file_write_soon(manifest->journal, text, size, error) : error_memory(error, manifest->journal);
    free(text);
    if (!ok) return false;
    if (!manifest->valid && !file_remove(manifest->path, error)) return false;
    manifest->out = open(manifest->journal, O_WRONLY | O_APPEND | O_NOFOLLOW | O_NOCTTY | O_CLOEXEC);
    return manifest->out >= 0 || error_system(error, manifest->journal, "cannot write: %s", strerror(errno));
}

bool manifest_add(Manifest *manifest, int index, PictureHashes hashes, Error *error) {
    int i = index - manifest->first;
    const PictureHashes *old = &manifest->hashes[i];
    if (manifest->known[i] && old->pixels == hashes.pixels && old->file == hashes.file) return true;
    manifest->hashes[i] = hashes;
    manifest->known[i] = true;
    if (manifest->out < 0) return true;
    size_t size;
    char *line = file_print(manifest_print_line, &(ManifestLine){manifest, index, hashes}, &size);
    if (line == NULL) return error_memory(error, manifest->journal);
    const bool written = file_write_all(manifest->out, line, size) ||
                         error_system(error, manifest->journal, "cannot write: %s", strerror(errno));
    free(line);
    return written;
}

bool manifest_end(Manifest *manifest, Error *error) {
    return file_write_text(manifest->path, print_whole, manifest, error) && file_remove(manifest->journal, error);
}

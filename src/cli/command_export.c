/* SPDX-License-Identifier: GPL-3.0-or-later */
/* twinbox export; and the note about files in the folder of a sequence that could be mistaken for a part of it. */
#include "base/base.h"
#include "base/file.h"
#include "cli/cli.h"
#include "cli/draw_panels.h"
#include "cli/notes.h"
#include "cli/options.h"
#include "cli/panels.h"
#include "pictures/render.h"
#include "runs/runs.h"
#include "runs/trajectory.h"
#include "scenes/scenes.h"

#include <dirent.h>
#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

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

static bool export_add(FolderList *names, const char *name, Error *error) {
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
    return error->kind == ERROR_NONE && export_add(names, name, error);
}

static bool export_collect(FolderList *names, const char *directory, const RenderResult *result, const Panels *panels,
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

static void export_describe(const FolderList *names, char text[TEXT_SIZE]) {
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
    const bool ok = export_collect(&names, directory, result, panels, error);
    if (ok && names.count > 0) {
        qsort(names.names, names.count, sizeof *names.names, by_name);
        export_describe(&names, text);
        note_print("%s also has %zu file%s that %s not of this sequence: %s", directory, names.count,
                   plural((int)names.count), names.count > 1 ? "are" : "is", text);
    }
    folder_list_free(&names);
    return ok;
}

typedef struct Options {
    const char *input, *output;
    bool flat;
    SceneSettings set;
} Options;

static const Option option_table[] = {
    {"--output", 'o', "FILE", "File to write; its ending states the format: .csv or .json",
     OPTION_OUTPUT(Options, output), .needed = "-o FILE is needed"},
    {"--flat", 0, NULL, "The input is a scene: write its bodies as JSON, patterns and parameters written out",
     OPTION_FLAG(Options, flat)},
    {OPTION_SET(Options, set)},
    {0}};

static const CommandSpec spec = {
    .options = option_table,
    .input = {.value = "RUN", .needed = "a run (.npz), or a scene with --flat, is needed", OPTION_PATH(Options, input)},
    .inputs = {1, 1, "run"},
    .help =
        "Write a run for other programs: as CSV, which twinbox import reads back, without contacts; or as JSON.\n"
        "With --flat, write a scene for a program that does not read YAML: gravity, time step, and all bodies and the "
        "bomb with their numbers.\v"
        "Example: twinbox simulate stack -o engine.npz\n"
        "         twinbox export engine.npz -o engine.csv\n"
        "         twinbox export stack --flat -o stack.json"};

static const struct {
    const char *ending;
    bool (*write)(const Trajectory *run, const char *path, Error *error);
} formats[] = {{".csv", csv_run_write}, {".json", json_run_write}};
enum { FORMATS = sizeof formats / sizeof *formats };

/* -1: none has this ending. */
static int find_format(const char *path) {
    if (path_is_standard(path)) return 0;
    for (int i = 0; i < FORMATS; i++)
        if (file_name_ends_with(path, formats[i].ending)) return i;
    return -1;
}

static bool export_scene(const Options *options, Error *error) {
    if (!path_is_standard(options->output) && !file_name_ends_with(options->output, ".json"))
        return error_input(error, options->output, "the name of a flat scene must end in .json");
    Scene *scene = scene_read_with(options->input, options->set.items, options->set.count, error);
    const bool ok = scene != NULL && scene_flat_write(scene, options->output, error);
    if (ok)
        printf("%s: %d bodies%s -> %s\n", scene->name, scene->body_count, scene->bomb.present ? " and a bomb" : "",
               options->output);
    scene_destroy(scene);
    return ok;
}

bool command_export(int argc, char **argv, Error *error) {
    Options options = {0};
    if (!options_parse(&spec, argc, argv, &options, error)) return false;
    if (options.flat) return export_scene(&options, error);
    if (options.set.count > 0) return error_input(error, "--set", "is for a scene: --flat is needed");
    const int format = find_format(options.output);
    if (format < 0) return error_input(error, options.output, "the name must end in .csv or .json");
    Trajectory *run = trajectory_read(options.input, error);
    bool ok = run != NULL && formats[format].write(run, options.output, error);
    if (ok)
        printf("%s by %s: %d frames of %d bodies -> %s\n", run->scene, run->method, run->frames, run->bodies,
               options.output);
    trajectory_destroy(run);
    return ok;
}

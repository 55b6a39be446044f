/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/commands.h"
#include "cli/options.h"
#include "common/standard_io.h"
#include "trajectory/csv_run.h"
#include "trajectory/run_export.h"

#include <stdio.h>
#include <string.h>

typedef struct Options {
    const char *input, *output;
} Options;

static const Option option_table[] = {{"--output", 'o', "FILE",
                                       "File to write; its ending states the format: .csv, .json or .blend.py",
                                       OPTION_OUTPUT(Options, output), .needed = "-o FILE is needed"},
                                      {0}};

static const CommandSpec spec = {
    .options = option_table,
    .input = {.value = "RUN", .needed = "a run (.npz) is needed", OPTION_PATH(Options, input)},
    .inputs = {1, 1, "run"},
    .help =
        "Write a run for other programs: as CSV, which twinbox import reads back; as JSON; or as a script that builds "
        "the run as an animation in Blender. Contacts are left out, but of JSON.\v"
        "Example: twinbox export engine.npz -o engine.csv\n"
        "         twinbox export engine.npz -o engine.blend.py\n"
        "         blender --python engine.blend.py"};

static const struct {
    const char *ending;
    bool (*write)(const Trajectory *run, const char *path, Error *error);
} formats[] = {{".csv", csv_run_write}, {".json", json_run_write}, {".blend.py", blender_run_write}};
enum { FORMATS = sizeof formats / sizeof *formats };

/* -1: none has this ending. */
static int find_format(const char *path) {
    if (path_is_standard(path)) return 0;
    const size_t length = strlen(path);
    for (int i = 0; i < FORMATS; i++) {
        const size_t tail = strlen(formats[i].ending);
        if (length > tail && strcmp(path + length - tail, formats[i].ending) == 0) return i;
    }
    return -1;
}

bool command_export(int argc, char **argv, Error *error) {
    Options options = {0};
    if (!options_parse(&spec, argc, argv, &options, error)) return false;
    const int format = find_format(options.output);
    if (format < 0) return error_input(error, options.output, "the name must end in .csv, .json or .blend.py");
    Trajectory *run = trajectory_read(options.input, error);
    bool ok = run != NULL && formats[format].write(run, options.output, error);
    if (ok)
        printf("%s by %s: %d frames of %d bodies -> %s\n", run->scene, run->method, run->frames, run->bodies,
               options.output);
    trajectory_destroy(run);
    return ok;
}

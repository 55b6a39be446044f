/* SPDX-License-Identifier: GPL-3.0-or-later */
/* twinbox import: a run from CSV becomes .npz, with a verdict. */
#include "base/base.h"
#include "base/file.h"
#include "cli/cli.h"
#include "cli/judge.h"
#include "cli/notes.h"
#include "cli/options.h"
#include "runs/run_files.h"
#include "runs/trajectory.h"
#include "scenes/scenes.h"

#include <string.h>

typedef struct Options {
    const char *input, *output, *sizes;
    float dt; /* s; 0: the file's */
    bool degrees;
    JudgeOptions judge;
} Options;

static const Option option_table[] = {
    {"--output", 'o', "RUN.npz", "Run to write", OPTION_BINARY(Options, output), .needed = "-o RUN.npz is needed"},
    {"--sizes", 0, "FILE.csv", "Sizes of the bodies: body,width,height in m; static, 0 or 1, may follow",
     OPTION_PATH(Options, sizes)},
    {"--dt", 0, "S", "Time step, s: a number or a fraction such as 1/60 (default: the file's)",
     OPTION_FLOAT(Options, dt, SCENE_MIN_DT, SCENE_MAX_DT)},
    OPTIONS_JUDGE(Options, judge),
    {"--degrees", 0, NULL, "Angles and angular velocities of the file are in degrees", OPTION_FLAG(Options, degrees)},
    {0}};

static const CommandSpec spec = {
    .options = option_table,
    .input = {.value = "FILE.csv", .needed = "a CSV file is needed", OPTION_PATH(Options, input)},
    .inputs = {1, 1, "file"},
    .help =
        "Read the run of another program from CSV and store it as a run of twinbox. The columns are frame, body, x, y, "
        "angle, and if known vx, vy, omega; a column time may set the time step. A body has a row in each "
        "frame. Comments above the header may state more:\n\n"
        "  # dt: 1/60\n"
        "  # size: 0,100,20,static\n"
        "  # size: 1,1,1\n"
        "  frame,body,x,y,angle\n"
        "  0,0,0,-10,0\n"
        "  0,1,0,0.51,0\n\n"
        "The other comments are scene, method, bomb and camera. What the file does not state is assumed, and "
        "printed.\v"
        "Example: twinbox simulate stack -o engine.npz\n"
        "         twinbox export engine.npz -o engine.csv\n"
        "         twinbox import engine.csv --dt 1/60 -o again.npz\n"
        "         ./box2d scenes/stack.yaml | twinbox import - -o box2d.npz"};

static bool import_run(const Options *options, Error *error) {
    char name[TRAJECTORY_NAME_SIZE];
    CsvRunNotes notes;
    trajectory_name_from_path(strcmp(options->input, "-") == 0 ? options->output : options->input, name);
    const CsvRunOptions how = {.name = name, .sizes = options->sizes, .dt = options->dt, .degrees = options->degrees};
    Trajectory *run = csv_run_read(options->input, &how, &notes, error);
    JudgedRun judged = {0};
    Error unjudged = {0};
    bool ok = run != NULL;
    if (ok && judged_run_find(&judged, run, &options->judge, &unjudged)) {
        const VerdictReading *reading = &judged.verdict.reading;
        const int last = run->frames - 1;
        trajectory_judge(run, judged.words, reading->frame < last ? reading->frame : last, reading->body);
    } else if (ok && (options->judge.scene != NULL || unjudged.kind != ERROR_INPUT)) {
        /* But a run of bodies that come and go as twinbox's do not is imported without a verdict. */
        *error = unjudged;
        ok = false;
    }
    ok = ok && trajectory_write(run, options->output, error);
    if (ok) {
        printf("%s by %s: %d frames of %d bodies, dt %g s -> %s\n", run->scene, run->method, run->frames, run->bodies,
               (double)run->dt, options->output);
        if (unjudged.kind == ERROR_NONE)
            judged_run_print(&judged, &options->judge);
        else
            printf("    no verdict: %s\n", unjudged.message);
        for (int i = 0; i < notes.count; i++) note_print("assumed: %s", notes.lines[i]);
        if (!path_is_standard(options->output)) next_film(options->output);
    }
    judged_run_free(&judged);
    trajectory_destroy(run);
    return ok;
}

bool command_import(int argc, char **argv, Error *error) {
    Options options = {0};
    if (!options_parse(&spec, argc, argv, &options, error)) return false;
    if (!path_is_standard(options.output) && !file_name_ends_with(options.output, ".npz"))
        return error_input(error, options.output, "the name of a run must end in .npz");
    return import_run(&options, error);
}

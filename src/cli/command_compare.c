/* SPDX-License-Identifier: GPL-3.0-or-later */
/* twinbox compare: its options, and whether it compares pictures or runs. */
#include "base/base.h"
#include "base/file.h"
#include "cli/cli.h"
#include "cli/json_output.h"
#include "cli/larger_commands.h"
#include "cli/notes.h"
#include "cli/options.h"
#include "cli/output_checks.h"
#include "cli/progress_bar.h"
#include "pixels/png.h"
#include "regression/limits.h"
#include "regression/mask.h"
#include "regression/regression.h"
#include "regression/report.h"

#include <inttypes.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static OptionRead read_beyond, read_antialias, read_mask;

static const Option option_table[] = {
    {"--tolerance", 0, "MAX",
     "Pictures: ignore pixels in which no channel differs by more than MAX (0 to 255). Runs, two or those of two "
     "folders: pass them where the centres of a body are at most MAX metres apart; MAX,RAD also limits its rotation; "
     "chaos: as far as roundings grow, which takes --scene "
     "(default: 0, every bit counts). In folders of pictures and runs, a whole number is for the "
     "pictures, any other limit for the runs",
     OPTION_TEXT(CompareOptions, limit)},
    {OPTION_JSON(CompareOptions, json)},
    {.help = "Runs:"},
    {"--scene", 0, "SCENE",
     "Scene of the first run: run it again with the same method and one body shifted by 1e-6 m, and compare the "
     "growth. The shifted body is the bomb; before the bomb hits, the first body that differs; without a bomb, the "
     "last body",
     OPTION_PATH(CompareOptions, scene)},
    {"--csv", 0, "FILE", "Write frame,time,distance,shifted_distance: the largest distance of any body, s and m",
     OPTION_OUTPUT(CompareOptions, csv)},
    {.help = "Pictures:"},
    {"--beyond", 0, "SHARE",
     "Pass frames in which at most this SHARE (0 to 1) of the pixels differs by more than --tolerance, or a number of "
     "pixels: 20px",
     OPTION_READ(read_beyond, CompareOptions, tolerance)},
    {"--antialias", 0, NULL, "Ignore pixels along edges that moved by a part of a pixel, or were sampled otherwise",
     OPTION_READ(read_antialias, CompareOptions, tolerance)},
    {"--rules", 0, "FILE",
     "Limits and masks for files of certain names (default: " RULES_NAME " in EXPECTED, if it is there)",
     OPTION_PATH(CompareOptions, rules)},
    {"--mask", 0, "FILE.png|X,Y,W,H",
     "Pixels to ignore: where this picture is neither black nor transparent, or a rectangle (may be repeated)",
     OPTION_READ(read_mask, CompareOptions, mask)},
    {"--max-pixels", 0, "N", "Refuse larger pictures before decoding them (default: 100000000)",
     OPTION_INT(CompareOptions, max_pixels, 1, INT_MAX)},
    {"--no-recursive", 0, NULL, "Leave out subfolders, and print how many pictures they hold",
     OPTION_FLAG(CompareOptions, flat)},
    {"--strict", 0, NULL,
     "Fail for pictures with equal pixels that display differently (gAMA, iCCP, sRGB, cHRM, cICP, orientation, "
     "resolution, ...), and for pictures that are no PNG files, which are reported otherwise",
     OPTION_FLAG(CompareOptions, strict)},
    {"--report", 0, "DIR",
     "Folder for report.html, junit.xml, results.json, and run-NAME.html for each run that differs; of two runs, "
     "run.html",
     OPTION_TEXT(CompareOptions, report)},
    {"--report-size", 0, "MB",
     "Most that the pictures in the report may take, and as much for its pages of runs (default: 64)",
     OPTION_INT(CompareOptions, megabytes, 1, 1000)},
    {0}};

static const CommandSpec spec = {
    .options = option_table,
    .input = {.value = "EXPECTED ACTUAL...",
              .needed = "two inputs are needed; --help lists the options",
              OPTION_PATHS(CompareOptions, paths, count)},
    .inputs = {2, sizeof((CompareOptions *)NULL)->paths / sizeof(char *), "input"},
    .help =
        "Compare two runs (.npz, or .csv of any program) or two PNG sequences (folders with their subfolders, or "
        "single files). Exit status 0: "
        "equal, 1: different, 2: not comparable.\n"
        "Runs are equal if every bit of all that both state is equal: poses, velocities, hashes of states. Otherwise "
        "the "
        "first frame, body and contact that differ are found, the kind of difference, whether the solver or an earlier "
        "step is the cause, and how fast the distance grows from there.\n"
        "Of three inputs or more, runs or folders of runs, each is compared with the first.\n"
        "Pictures are equal if every decoded pixel is. Frames are matched by name, or by the stem and the number of "
        "their names. Runs that are in both folders, and the states named in twinbox's own pictures, tell whether the "
        "physics or the renderer changed.\v"
        "Example: twinbox simulate stack -o engine.npz\n"
        "         twinbox simulate stack --method momentum:k=20 -o momentum.npz\n"
        "         twinbox compare engine.npz momentum.npz --scene stack --csv apart.csv\n"
        "         twinbox render engine.npz -o expected --frames 30:40\n"
        "         twinbox render momentum.npz -o actual --frames 30:40\n"
        "         twinbox compare expected actual --report out/report"};

/* A file, or "X,Y,W,H". */
static bool read_mask(const Option *option, const char *text, void *value, Error *error) {
    const char *ending = strrchr(text, '.'), *rest = text;
    int numbers[4];
    bool rectangle = true;
    for (int i = 0; rectangle && i < 4; i++) {
        int64_t number = 0;
        rectangle =
            parse_leading_int(rest, i < 2 ? -1000000 : 1, 1000000, &number, &rest) && *rest++ == (i < 3 ? ',' : '\0');
        numbers[i] = (int)number;
    }
    if (rectangle) return mask_add_rectangle(value, numbers[0], numbers[1], numbers[2], numbers[3], error);
    if (ending != NULL && strcasecmp(ending, ".png") == 0) return mask_add_picture(value, text, error);
    return error_input(error, option->name, "'%s' is neither a PNG file nor X,Y,W,H with W and H from 1", text);
}

static bool read_beyond(const Option *option, const char *text, void *value, Error *error) {
    Tolerance *tolerance = value;
    if (!pixel_limit_parse(&tolerance->beyond, text))
        return error_input(error, option->name, "'%s' is not " PIXEL_LIMIT_FORM, text);
    tolerance->given |= LIMIT_BEYOND;
    return true;
}

static bool read_antialias(const Option *option, const char *text, void *value, Error *error) {
    Tolerance *tolerance = value;
    (void)option, (void)text, (void)error;
    tolerance->given |= LIMIT_ANTIALIAS;
    tolerance->antialias = true;
    return true;
}

static bool is_trajectory(const char *path) {
    return path_is_standard(path) || file_name_ends_with(path, ".npz") || is_trace(path); /* pictures come in folders */
}

/* "M" or "M,RAD"; 0 alone is none. */
static bool read_distance(CompareOptions *options, Error *error) {
    PoseTolerance *poses = &options->poses;
    const char *rest;
    *poses = (PoseTolerance){.angle = INFINITY};
    if (options->limit == NULL) return true;
    options->chaos = strcmp(options->limit, "chaos") == 0;
    if (options->chaos)
        return options->scene != NULL || error_input(error, "--tolerance", "chaos is measured with --scene SCENE");
    if (!parse_leading_double(options->limit, &poses->distance, &rest) || !(poses->distance >= 0) ||
        (*rest != '\0' && (*rest != ',' || !parse_double(rest + 1, &poses->angle) || !(poses->angle >= 0))))
        return error_input(error, "--tolerance", "'%.64s' is not a distance in metres, METRES,RADIANS, or chaos",
                           options->limit);
    poses->given = poses->distance > 0 || *rest == ',';
    return true;
}

static bool refuse_pixels(const CompareOptions *options, Error *error) {
    return error_input(error, "--tolerance", "'%.64s' is not a whole number from 0 to 255%s", options->limit,
                       file_name_ends_with(options->paths[0], ".png") ? "" : ", and there are no runs to limit");
}

/* Reads the command line. False with error set if it is wrong, or after --help. */
static bool read_options(CompareOptions *options, int argc, char **argv, Error *error) {
    const char *const *paths = options->paths;
    if (!options_parse(&spec, argc, argv, options, error)) return false;
    if (options->report != NULL && !output_check_folder_name(options->report, error)) return false;
    const bool many = options->count > 2, first = many || is_trajectory(paths[0]),
               second = many || is_trajectory(paths[1]);
    if (first != second)
        return error_input(error, paths[first ? 1 : 0], "is not a run (.npz or .csv), but %s is", paths[first ? 0 : 1]);
    if (first && (options->tolerance.given != 0 || options->rules != NULL || options->mask.count > 0))
        return error_input(error, paths[0], "--rules, masks and limits of pixels apply to pictures only");
    if (!first && (options->scene != NULL || options->csv != NULL))
        return error_input(error, paths[0], "--scene and --csv apply to runs only");
    if (first) return json_output_check(options->json, error) && read_distance(options, error);
    int64_t difference;
    if (options->limit == NULL) return true;
    /* Folders may have pictures, runs or both. */
    const bool poses = read_distance(options, &(Error){0}) && !file_name_ends_with(paths[0], ".png");
    if (!parse_int(options->limit, 0, 255, &difference)) return poses || refuse_pixels(options, error);
    options->tolerance.given |= LIMIT_TOLERANCE;
    options->tolerance.tolerance = (int)difference;
    return true;
}

static bool compare_pictures(const CompareOptions *options, Error *error) {
    const RegressionOptions compared = {.tolerance = options->tolerance,
                                        .poses = options->poses,
                                        .rules = options->rules,
                                        .mask = &options->mask,
                                        .max_pixels = options->max_pixels,
                                        .flat = options->flat,
                                        .strict = options->strict};
    Regression regression;
    bool ok = regression_run(&regression, options->paths[0], options->paths[1], &compared,
                             progress_bar_begin("comparing"), error);
    progress_bar_end();
    if (!ok) return false;
    if (regression.options.poses.given && regression.run_count == 0) {
        regression_free(&regression);
        return refuse_pixels(options, error);
    }
    note_verbose("%d frame%s matched, %d %s; limits of the command line: %s; %.3f s", regression.count,
                 plural(regression.count), regression.run_count,
                 regression.run_count == 1 ? "trajectory" : "trajectories", regression_limits(&regression).text,
                 regression.seconds);
    ok = options->json || compare_print(&regression, error);
    if (ok && options->report != NULL) {
        ok = regression_report_write(&regression, options->report, (size_t)options->megabytes << 20,
                                     progress_bar_begin("report"), error);
        progress_bar_end();
        if (ok && !options->json) printf("report -> %s/report.html\n", options->report);
    }
    ok = ok && (!options->json || compare_json_pictures(&regression, error)) && regression_was_read(&regression, error);
    ok = ok && regression_passed(&regression);
    regression_free(&regression);
    return ok;
}

bool command_compare(int argc, char **argv, Error *error) {
    CompareOptions options = {.max_pixels = IMAGE_MAX_PIXELS, .megabytes = REPORT_MEGABYTES};
    bool same =
        read_options(&options, argc, argv, error) && (options.report == NULL || report_begin(options.report, error));
    same = same && (options.count > 2                 ? compare_many(&options, error)
                    : is_trajectory(options.paths[0]) ? compare_runs(&options, error)
                                                      : compare_pictures(&options, error));
    mask_free(&options.mask);
    return same;
}

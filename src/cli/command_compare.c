/* SPDX-License-Identifier: GPL-3.0-or-later */
/* twinbox compare: its options, and whether it compares pictures or runs. */
#include "base/base.h"
#include "base/file.h"
#include "base/hash.h"
#include "cli/cli.h"
#include "cli/json_output.h"
#include "cli/larger_commands.h"
#include "cli/notes.h"
#include "cli/options.h"
#include "cli/output_checks.h"
#include "cli/progress_bar.h"
#include "pixels/png.h"
#include "regression/compare.h"
#include "regression/regression.h"
#include "regression/report.h"

#include <inttypes.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <time.h>

static OptionRead read_fuzzy, read_beyond, read_flip, read_antialias, read_mask;

static const char *const annotation_kinds[] = {"none", "github", NULL}; /* CompareAnnotations */
static const char *const metadata_kinds[] = {"report", "strict", NULL};

static const Option option_table[] = {
    {"--tolerance", 0, "MAX",
     "Pictures: ignore pixels in which no channel differs by more than MAX (0 to 255). Runs, two or those of two "
     "folders: pass them where the centres of a body are at most MAX metres apart; MAX,RAD also limits its rotation "
     "(default: 0, every bit of pose and velocity counts). In folders of pictures and runs, a whole number is for the "
     "pictures, any other limit for the runs",
     OPTION_TEXT(CompareOptions, limit)},
    {"--watch", 0, NULL,
     "Compare again whenever a file changes, until Ctrl-C; the exit status is that of the last comparison",
     OPTION_FLAG(CompareOptions, watch)},
    {OPTION_JSON(CompareOptions, json)},
    {"--server", 0, NULL,
     "Answer requests, lines of JSON on standard input as of odiff --server, until it ends; takes no inputs",
     OPTION_FLAG(CompareOptions, server)},
    {.help = "Runs:"},
    {"--scene", 0, "SCENE",
     "Scene of the first run: run it again with the same method and one body shifted by 1e-6 m, and compare the "
     "growth. The shifted body is the bomb; before the bomb hits, the first body that differs; without a bomb, the "
     "last body",
     OPTION_PATH(CompareOptions, scene)},
    {"--csv", 0, "FILE", "Write frame,time,distance,shifted_distance: the largest distance of any body, s and m",
     OPTION_OUTPUT(CompareOptions, csv)},
    {.help = "Pictures:"},
    {"--fuzzy", 0, "MAX,SHARE",
     "Pass frames in which no channel differs by more than MAX (0 to 255) and at most this SHARE (0 to 1) of the "
     "pixels differs, or a number of pixels: MAX,20px",
     OPTION_READ(read_fuzzy, CompareOptions, tolerance)},
    {"--beyond", 0, "SHARE",
     "Pass frames in which at most this SHARE (0 to 1) of the pixels differs by more than --tolerance, or a number of "
     "pixels: 20px",
     OPTION_READ(read_beyond, CompareOptions, tolerance)},
    {"--flip", 0, "[p99=]MAX",
     "Pass frames whose FLIP is at most MAX (0 to 1) on average, or at its 99th percentile (may be repeated); "
     "prints FLIP of the first frame that fails",
     OPTION_READ(read_flip, CompareOptions, tolerance)},
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
    {"--metadata", 0, "KIND",
     "report or strict: pictures with equal pixels that display differently (gAMA, iCCP, sRGB, cHRM, cICP, "
     "orientation, resolution, ...) are reported, or fail (default: report)",
     OPTION_ENUM(CompareOptions, metadata, metadata_kinds)},
    {"--report", 0, "DIR",
     "Folder for report.html, junit.xml, results.tap, results.json, and run-NAME.html for each run that differs; of "
     "two runs, run.html",
     OPTION_TEXT(CompareOptions, report)},
    {"--report-size", 0, "MB",
     "Most that the pictures in the report may take, and as much for its pages of runs (default: 64)",
     OPTION_INT(CompareOptions, megabytes, 1, 1000)},
    {"--annotations", 0, "KIND",
     "none, or github: print failures as annotations of GitHub Actions (at most ten) and append a summary to the file "
     "named by GITHUB_STEP_SUMMARY (default: none)",
     OPTION_ENUM(CompareOptions, annotations, annotation_kinds)},
    {0}};

static const CommandSpec spec = {
    .options = option_table,
    .input = {.value = "EXPECTED ACTUAL", OPTION_PATHS(CompareOptions, paths, count)},
    .inputs = {0, 2, "input"}, /* none with --server */
    .help =
        "Compare two runs (.npz) or two PNG sequences (folders with their subfolders, or single files). Exit status 0: "
        "equal, 1: different, 2: not comparable.\n"
        "Runs are equal if every bit of every pose and velocity is equal. Otherwise the first frame, body and contact "
        "that differ are found, whether the solver or an earlier step is the cause, and how fast the distance grows "
        "from there.\n"
        "Pictures are equal if every decoded pixel is. Frames are matched by name, or by the stem and the number of "
        "their names. Runs that are in both folders, and the states named in twinbox's own pictures, tell whether the "
        "physics or the renderer changed.\v"
        "Example: twinbox simulate stack -o engine.npz\n"
        "         twinbox simulate stack --method momentum:k=20 -o momentum.npz\n"
        "         twinbox compare engine.npz momentum.npz --scene stack --csv apart.csv\n"
        "         twinbox render engine.npz -o expected --frames 30:40\n"
        "         twinbox render momentum.npz -o actual --frames 30:40\n"
        "         twinbox compare expected actual --report out/report"};

/* "X,Y,W,H"; false for anything else. */
static bool parse_rectangle(const char *text, int numbers[4]) {
    for (int i = 0; i < 4; i++, text++) {
        int64_t value;
        if (!parse_leading_int(text, i < 2 ? -1000000 : 1, 1000000, &value, &text) || *text != (i < 3 ? ',' : '\0'))
            return false;
        numbers[i] = (int)value;
    }
    return true;
}

static bool read_mask(const Option *option, const char *text, void *value, Error *error) {
    int numbers[4];
    const char *ending = strrchr(text, '.');
    if (parse_rectangle(text, numbers))
        return mask_add_rectangle(value, numbers[0], numbers[1], numbers[2], numbers[3], error);
    if (ending != NULL && strcasecmp(ending, ".png") == 0) return mask_add_picture(value, text, error);
    return error_input(error, option->name, "'%s' is neither a PNG file nor X,Y,W,H with W and H from 1", text);
}

static bool read_fuzzy(const Option *option, const char *text, void *value, Error *error) {
    Tolerance *tolerance = value;
    const char *rest;
    int64_t difference;
    if (!parse_leading_int(text, 0, 255, &difference, &rest) || *rest != ',' ||
        !pixel_limit_parse(&tolerance->share, rest + 1))
        return error_input(error, option->name,
                           "'%s' is not MAX,SHARE with MAX from 0 to 255 and SHARE " PIXEL_LIMIT_FORM, text);
    tolerance->given |= LIMIT_FUZZY;
    tolerance->fuzzy = (int)difference;
    return true;
}

static bool read_beyond(const Option *option, const char *text, void *value, Error *error) {
    Tolerance *tolerance = value;
    if (!pixel_limit_parse(&tolerance->beyond, text))
        return error_input(error, option->name, "'%s' is not " PIXEL_LIMIT_FORM, text);
    tolerance->given |= LIMIT_BEYOND;
    return true;
}

static bool read_flip(const Option *option, const char *text, void *value, Error *error) {
    return tolerance_parse_flip(value, text) ||
           error_input(error, option->name, "'%s' is not MAX, mean=MAX or p99=MAX with MAX from 0 to 1", text);
}

static bool read_antialias(const Option *option, const char *text, void *value, Error *error) {
    Tolerance *tolerance = value;
    (void)option, (void)text, (void)error;
    tolerance->given |= LIMIT_ANTIALIAS;
    tolerance->antialias = true;
    return true;
}

static bool is_trajectory(const char *path) {
    return path_is_standard(path) || file_name_ends_with(path, ".npz"); /* pictures come in folders */
}

/* "M" or "M,RAD"; 0 alone is none. */
static bool read_distance(CompareOptions *options, Error *error) {
    PoseTolerance *poses = &options->poses;
    const char *rest;
    *poses = (PoseTolerance){.angle = INFINITY};
    if (options->limit == NULL) return true;
    if (!parse_leading_double(options->limit, &poses->distance, &rest) || !(poses->distance >= 0) ||
        (*rest != '\0' && (*rest != ',' || !parse_double(rest + 1, &poses->angle) || !(poses->angle >= 0))))
        return error_input(error, "--tolerance", "'%.64s' is not a distance in metres, or METRES,RADIANS",
                           options->limit);
    poses->given = poses->distance > 0 || *rest == ',';
    return true;
}

static bool refuse_pixels(const CompareOptions *options, Error *error) {
    return error_input(error, "--tolerance", "'%.64s' is not a whole number from 0 to 255%s", options->limit,
                       file_name_ends_with(options->paths[0], ".png") ? "" : ", and there are no runs to limit");
}

/* Folders may have pictures, runs or both. */
static bool read_tolerance(CompareOptions *options, Error *error) {
    int64_t difference;
    if (options->limit == NULL) return true;
    const bool poses = read_distance(options, &(Error){0}) && !file_name_ends_with(options->paths[0], ".png");
    if (!parse_int(options->limit, 0, 255, &difference)) return poses || refuse_pixels(options, error);
    options->tolerance.given |= LIMIT_TOLERANCE;
    options->tolerance.tolerance = (int)difference;
    return true;
}

static bool check_runs(CompareOptions *options, Error *error) {
    if (options->tolerance.given != 0 || options->rules != NULL || options->mask.count > 0 || options->annotations != 0)
        return error_input(error, options->paths[0],
                           "--annotations, --rules, masks and limits of pixels apply to pictures only");
    return json_output_check(options->json, error) && read_distance(options, error);
}

static bool check_pictures(CompareOptions *options, Error *error) {
    if (options->scene != NULL || options->csv != NULL)
        return error_input(error, options->paths[0], "--scene and --csv apply to runs only");
    return read_tolerance(options, error);
}

static bool check_inputs(CompareOptions *options, Error *error) {
    const char *const *paths = options->paths;
    const bool first = is_trajectory(paths[0]), second = is_trajectory(paths[1]);
    if (options->report != NULL && !output_check_folder_name(options->report, error)) return false;
    if (first != second)
        return error_input(error, paths[first ? 1 : 0], "is not a trajectory (.npz), but %s is", paths[first ? 0 : 1]);
    return first ? check_runs(options, error) : check_pictures(options, error);
}

/* Reads the command line. False with error set if it is wrong, or after --help. */
static bool compare_options_parse(CompareOptions *options, int argc, char **argv, Error *error) {
    if (!options_parse(&spec, argc, argv, options, error)) return false;
    if (options->server)
        return argc == 2 || error_input(error, "--server", "stands alone; each request has options and files");
    if (options->count != 2) return error_input(error, argv[0], "two inputs are needed; --help lists the options");
    if (options->json && (options->watch || options->annotations != ANNOTATE_NONE))
        return error_input(error, "--json", "cannot be combined with --%s", options->watch ? "watch" : "annotations");
    return check_inputs(options, error);
}

static bool compare_report(Regression *regression, const CompareOptions *options, Error *error) {
    bool ok = regression_report_write(regression, options->report, (size_t)options->megabytes << 20,
                                      progress_bar_begin("report"), error);
    progress_bar_end();
    if (ok && !options->json) printf("report -> %s/report.html\n", options->report);
    return ok;
}

/* A name may look like a command of GitHub's runner. Nobody can name a file by a token that has the time in it. */
static bool print_compare(const CompareOptions *options, const Regression *regression, Error *error) {
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    uint64_t token = hash_xxh3(&now, sizeof now);
    bool github = options->annotations == ANNOTATE_GITHUB;
    if (github) printf("::stop-commands::%016" PRIx64 "\n", token);
    bool ok = compare_print(regression, error);
    RegressionText notes = regression_notes(regression);
    if (notes.text[0] != '\0') printf("%s\n", notes.text);
    if (github) printf("::%016" PRIx64 "::\n", token);
    return ok;
}

static bool compare_annotate(const CompareOptions *options, const Regression *regression, Error *error) {
    const char *summary = getenv("GITHUB_STEP_SUMMARY");
    if (options->annotations != ANNOTATE_GITHUB) return true;
    github_annotate(stdout, regression);
    return summary == NULL || summary[0] == '\0' || github_summary_append(regression, summary, error);
}

static bool compare_pictures(const CompareOptions *options, Error *error) {
    const RegressionOptions compared = {.tolerance = options->tolerance,
                                        .poses = options->poses,
                                        .rules = options->rules,
                                        .mask = &options->mask,
                                        .max_pixels = options->max_pixels,
                                        .flat = options->flat,
                                        .strict_metadata = options->metadata == METADATA_STRICT};
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
    ok = (options->json || print_compare(options, &regression, error)) && regression_passed(&regression);
    if (error->kind == ERROR_NONE && options->report != NULL && !compare_report(&regression, options, error))
        ok = false;
    if (error->kind == ERROR_NONE && options->json && !compare_json_pictures(&regression, error)) ok = false;
    if (error->kind == ERROR_NONE && !compare_annotate(options, &regression, error)) ok = false;
    if (error->kind == ERROR_NONE && !regression_was_read(&regression, error)) ok = false;
    regression_free(&regression);
    return ok;
}

static bool compare_inputs(const CompareOptions *options, Error *error) {
    bool same = is_trajectory(options->paths[0]) ? compare_runs(options, error) : compare_pictures(options, error);
    if (error->kind != ERROR_NONE && options->annotations == ANNOTATE_GITHUB)
        github_annotate_message(stdout, error->message);
    return same;
}

bool command_compare(int argc, char **argv, Error *error) {
    CompareOptions options = {.max_pixels = IMAGE_MAX_PIXELS, .megabytes = REPORT_MEGABYTES};
    bool same = compare_options_parse(&options, argc, argv, error);
    if (same && options.server) return compare_serve(error);
    same = same && (options.watch ? compare_watch(&options, compare_inputs, error) : compare_inputs(&options, error));
    mask_free(&options.mask);
    return same;
}

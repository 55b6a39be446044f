/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/commands.h"
#include "cli/compare_print.h"
#include "cli/options.h"
#include "cli/progress_bar.h"
#include "report/regression_report.h"
#include "trajectory/trajectory.h"

#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

typedef struct Options {
    const char *paths[2], *report;
    int count, megabytes;
    bool fuzzy;         /* given, then: */
    int max_difference; /* of a channel */
    double max_share;   /* of the pixels */
    int max_pixels;
    Mask mask;
} Options;

static OptionRead read_fuzzy, read_mask;

static const Option option_table[] = {
    {"--fuzzy", 0, "MAX,SHARE",
     "Pass frames in which no channel differs by more than MAX (0 to 255) and at most this SHARE (0 to 1) of the "
     "pixels differs",
     .read = read_fuzzy},
    {"--mask", 0, "FILE.png|X,Y,W,H",
     "Pixels to ignore: where this picture is neither black nor transparent, or a rectangle (may be repeated)",
     OPTION_READ(read_mask, Options, mask)},
    {"--max-pixels", 0, "N", "Refuse larger pictures before decoding them (default: 100000000)",
     OPTION_INT(Options, max_pixels, 1, INT_MAX)},
    {"--report", 0, "DIR", "Folder for report.html, junit.xml and results.json", OPTION_TEXT(Options, report)},
    {"--report-size", 0, "MB", "Most that the pictures in the report may take (default: 64)",
     OPTION_INT(Options, megabytes, 1, 1000)},
    {0}};

static const CommandSpec spec = {
    .options = option_table,
    .input = {.value = "EXPECTED ACTUAL", .needed = "two inputs are needed", OPTION_TEXTS(Options, paths, count)},
    .inputs = {2, 2, "input"},
    .help =
        "Compare two trajectories (.npz) or two PNG sequences (folders or single files). Trajectories are equal if "
        "every bit of every pose and velocity is equal; pictures are equal if every decoded pixel is. Frames are "
        "matched by the stem and the number of their names. Trajectories that are in both folders, and the states "
        "named in twinbox's own pictures, tell whether the physics or the renderer changed. Exit status 0: equal, 1: "
        "different, 2: not comparable.\v"
        "Example: twinbox compare golden/frames out/golden/frames --report out/report\n"
        "         twinbox compare expected.npz actual.npz"};

static bool is_trajectory(const char *path) {
    size_t length = strlen(path);
    return length > 4 && strcmp(path + length - 4, ".npz") == 0;
}

static void print_trajectory_difference(const Trajectory *a, const TrajectoryDifference *difference) {
    if (difference->equal) {
        printf("equal: %d frames of %d bodies\n", a->frames, a->bodies);
        return;
    }
    if (difference->what[0] != '\0') printf("%s\n", difference->what);
    if (difference->frame < 0) return;
    printf("first difference: frame %d, body %d: %g m apart, %g rad, %g m/s\n", difference->frame, difference->body,
           difference->distance, difference->angle, difference->speed);
    printf("largest distance: frame %d, body %d: %g m apart\n", difference->max_frame, difference->max_body,
           difference->max_distance);
}

static bool compare_trajectories(const char *const paths[2], Error *error) {
    Trajectory *a = trajectory_read(paths[0], error);
    Trajectory *b = a != NULL ? trajectory_read(paths[1], error) : NULL;
    TrajectoryDifference difference = {0};
    if (b != NULL) {
        trajectory_compare(a, b, &difference);
        print_trajectory_difference(a, &difference);
    }
    trajectory_destroy(a);
    trajectory_destroy(b);
    return difference.equal;
}

/* "X,Y,W,H"; false for anything else. */
static bool parse_rectangle(const char *text, int numbers[4]) {
    char part[16];
    for (int i = 0; i < 4; i++) {
        size_t length = strcspn(text, ",");
        int64_t value;
        if (length >= sizeof part || (text[length] == ',') != (i < 3)) return false;
        memcpy(part, text, length);
        part[length] = '\0';
        if (!parse_int(part, i < 2 ? -1000000 : 1, 1000000, &value)) return false;
        numbers[i] = (int)value;
        text += length + 1;
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
    Options *options = value;
    const char *comma = strchr(text, ',');
    char largest[8] = "";
    int64_t difference;
    double share;
    if (comma != NULL && comma - text < (int)sizeof largest) memcpy(largest, text, (size_t)(comma - text));
    if (!parse_int(largest, 0, 255, &difference) || !parse_double(comma + 1, &share) || share < 0 || share > 1)
        return error_input(error, option->name, "'%s' is not MAX,SHARE with MAX from 0 to 255 and SHARE from 0 to 1",
                           text);
    options->fuzzy = true;
    options->max_difference = (int)difference;
    options->max_share = share;
    return true;
}

static bool report(Regression *regression, const Options *options, Error *error) {
    bool ok = regression_report_write(regression, options->report, (size_t)options->megabytes << 20,
                                      progress_bar_begin("report"), error);
    progress_bar_end();
    if (ok) printf("report -> %s/report.html\n", options->report);
    return ok;
}

static bool compare_pictures(const Options *options, Error *error) {
    const RegressionOptions compared = {options->max_difference, options->max_share, &options->mask,
                                        options->max_pixels};
    Regression regression;
    bool ok = regression_run(&regression, options->paths[0], options->paths[1], &compared,
                             progress_bar_begin("comparing"), error);
    progress_bar_end();
    if (!ok) return false;
    compare_print(&regression);
    ok = regression_passed(&regression);
    if (options->report != NULL && !report(&regression, options, error)) ok = false;
    regression_free(&regression);
    return ok;
}

static bool compare(const Options *options, Error *error) {
    bool first = is_trajectory(options->paths[0]), second = is_trajectory(options->paths[1]);
    if (first != second)
        return error_input(error, options->paths[first ? 1 : 0], "is not a trajectory (.npz), but %s is",
                           options->paths[first ? 0 : 1]);
    if (first && (options->report != NULL || options->fuzzy || options->mask.count > 0))
        return error_input(error, options->paths[0], "--report, --fuzzy and --mask apply to pictures only");
    return first ? compare_trajectories(options->paths, error) : compare_pictures(options, error);
}

bool command_compare(int argc, char **argv, Error *error) {
    Options options = {.max_pixels = IMAGE_MAX_PIXELS, .megabytes = REPORT_MEGABYTES};
    bool same = options_parse(&spec, argc, argv, &options, error) && compare(&options, error);
    mask_free(&options.mask);
    return same;
}

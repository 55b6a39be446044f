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

enum { FUZZY = 256, MASK, MAX_PIXELS, REPORT, REPORT_SIZE };

static const struct argp_option option_table[] = {
    {"fuzzy", FUZZY, "MAX,SHARE", 0,
     "Pass frames in which no channel differs by more than MAX (0 to 255) and at most this SHARE (0 to 1) of the "
     "pixels differs",
     0},
    {"mask", MASK, "FILE.png|X,Y,W,H", 0,
     "Pixels to ignore: where this picture is neither black nor transparent, or a rectangle (may be repeated)", 0},
    {"max-pixels", MAX_PIXELS, "N", 0, "Refuse larger pictures before decoding them (default: 100000000)", 0},
    {"report", REPORT, "DIR", 0, "Folder for report.html, junit.xml and results.json", 0},
    {"report-size", REPORT_SIZE, "MB", 0, "Most that the pictures in the report may take (default: 64)", 0},
    {0}};

typedef struct Options {
    const char *paths[2], *fuzzy, *masks[MASK_PARTS], *max_pixels, *report, *report_size;
    int count, mask_count;
} Options;

static error_t parse(int key, char *value, struct argp_state *state) {
    Options *options = state->input;
    switch (key) {
    case FUZZY: options->fuzzy = value; break;
    case MASK:
        if (options->mask_count == MASK_PARTS) argp_error(state, "at most %d masks", MASK_PARTS);
        options->masks[options->mask_count++] = value;
        break;
    case MAX_PIXELS: options->max_pixels = value; break;
    case REPORT: options->report = value; break;
    case REPORT_SIZE: options->report_size = value; break;
    case ARGP_KEY_ARG:
        if (options->count == 2) argp_error(state, "only two inputs can be compared (third: '%s')", value);
        options->paths[options->count++] = value;
        break;
    case ARGP_KEY_END:
        if (options->count < 2) argp_error(state, "two inputs are needed");
        break;
    default: return ARGP_ERR_UNKNOWN;
    }
    return 0;
}

static const struct argp argp = {
    option_table,
    parse,
    "EXPECTED ACTUAL",
    "Compare two trajectories (.npz) or two PNG sequences (folders or single files). Trajectories are equal if every "
    "bit of every pose and velocity is equal; pictures are equal if every decoded pixel is. Frames are matched by the "
    "stem and the number of their names. Trajectories that are in both folders, and the states named in twinbox's own "
    "pictures, tell whether the physics or the renderer changed. Exit status 0: equal, 1: different, 2: not "
    "comparable.\v"
    "Example: twinbox compare golden/frames out/golden/frames --report out/report\n"
    "         twinbox compare expected.npz actual.npz",
    NULL,
    NULL,
    NULL};

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

static int compare_trajectories(const char *const paths[2], Error *error) {
    Trajectory *a = trajectory_read(paths[0], error);
    Trajectory *b = a != NULL ? trajectory_read(paths[1], error) : NULL;
    TrajectoryDifference difference = {0};
    if (b != NULL) {
        trajectory_compare(a, b, &difference);
        print_trajectory_difference(a, &difference);
    }
    trajectory_destroy(a);
    trajectory_destroy(b);
    return difference.equal ? STATUS_SAME : STATUS_DIFFERENT;
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

static bool read_masks(const Options *options, Mask *mask, Error *error) {
    for (int i = 0; i < options->mask_count; i++) {
        int numbers[4];
        const char *text = options->masks[i], *ending = strrchr(text, '.');
        if (parse_rectangle(text, numbers)) {
            if (!mask_add_rectangle(mask, numbers[0], numbers[1], numbers[2], numbers[3], error)) return false;
        } else if (ending == NULL || strcasecmp(ending, ".png") != 0)
            return error_input(error, "--mask", "'%s' is neither a PNG file nor X,Y,W,H with W and H from 1", text);
        else if (!mask_add_picture(mask, text, error))
            return false;
    }
    return true;
}

static bool read_fuzzy(const char *text, RegressionOptions *options, Error *error) {
    const char *comma = strchr(text, ',');
    char largest[8] = "";
    int64_t value;
    if (comma != NULL && comma - text < (int)sizeof largest) memcpy(largest, text, (size_t)(comma - text));
    if (!parse_int(largest, 0, 255, &value) || !parse_double(comma + 1, &options->max_share) ||
        options->max_share < 0 || options->max_share > 1)
        return error_input(error, "--fuzzy", "'%s' is not MAX,SHARE with MAX from 0 to 255 and SHARE from 0 to 1",
                           text);
    options->max_difference = (int)value;
    return true;
}

static bool read_options(const Options *options, RegressionOptions *compared, int *megabytes, Error *error) {
    int pixels = IMAGE_MAX_PIXELS;
    bool ok =
        (options->fuzzy == NULL || read_fuzzy(options->fuzzy, compared, error)) &&
        (options->max_pixels == NULL || option_int("--max-pixels", options->max_pixels, 1, INT_MAX, &pixels, error)) &&
        (options->report_size == NULL || option_int("--report-size", options->report_size, 1, 1000, megabytes, error));
    compared->max_pixels = pixels;
    return ok;
}

static bool compare_pictures(const Options *options, const RegressionOptions *compared, int megabytes, bool *passed,
                             Error *error) {
    Regression regression;
    ProgressBar bar;
    progress_bar_begin(&bar, "comparing");
    bool ok = regression_run(&regression, options->paths[0], options->paths[1], compared, &bar.progress, error);
    progress_bar_end(&bar);
    if (!ok) return false;
    *passed = regression_passed(&regression);
    compare_print(&regression);
    if (options->report != NULL) {
        progress_bar_begin(&bar, "report");
        ok = regression_report_write(&regression, options->report, (size_t)megabytes << 20, &bar.progress, error);
        progress_bar_end(&bar);
        if (ok) printf("report -> %s/report.html\n", options->report);
    }
    regression_free(&regression);
    return ok;
}

static int compare_sequences(const Options *options, Error *error) {
    Mask mask = {.count = 0};
    RegressionOptions compared = {.mask = &mask};
    int megabytes = REPORT_MEGABYTES;
    bool passed = false;
    bool ok = read_options(options, &compared, &megabytes, error) && read_masks(options, &mask, error) &&
              compare_pictures(options, &compared, megabytes, &passed, error);
    mask_free(&mask);
    return ok && passed ? STATUS_SAME : STATUS_DIFFERENT;
}

int command_compare(int argc, char **argv, Error *error) {
    Options options = {0};
    if (!options_parse(&argp, argc, argv, &options)) return STATUS_DIFFERENT;
    bool first = is_trajectory(options.paths[0]), second = is_trajectory(options.paths[1]);
    if (first != second)
        error_input(error, options.paths[first ? 1 : 0], "is not a trajectory (.npz), but %s is",
                    options.paths[first ? 0 : 1]);
    else if (first && (options.report != NULL || options.fuzzy != NULL || options.mask_count > 0))
        error_input(error, options.paths[0], "--report, --fuzzy and --mask apply to pictures only");
    if (error->kind != ERROR_NONE) return STATUS_DIFFERENT;
    return first ? compare_trajectories(options.paths, error) : compare_sequences(&options, error);
}

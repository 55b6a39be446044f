/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/commands.h"
#include "cli/options.h"
#include "cli/progress_bar.h"
#include "image/sequence.h"
#include "trajectory/trajectory.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

typedef struct Options {
    const char *paths[2];
    int count;
} Options;

static error_t parse(int key, char *value, struct argp_state *state) {
    Options *options = state->input;
    if (key == ARGP_KEY_ARG) {
        if (options->count == 2) argp_error(state, "two things are compared, not more ('%s')", value);
        options->paths[options->count++] = value;
        return 0;
    }
    if (key == ARGP_KEY_END && options->count < 2) argp_error(state, "two things to compare are needed");
    return ARGP_ERR_UNKNOWN;
}

static const struct argp argp = {
    NULL,
    parse,
    "A B",
    "Tell where two trajectories (.npz) or two PNG sequences (folders, or single files) part. Trajectories are equal "
    "when every bit of every pose and velocity is; pictures when every decoded pixel is, frame number by frame "
    "number. Exit status 0: equal, 1: different.\v"
    "Example: twinbox compare golden/trajectories/stack-engine.npz out/stack/stack-engine.npz",
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
    printf("farthest: frame %d, body %d: %g m apart\n", difference->max_frame, difference->max_body,
           difference->max_distance);
}

static int compare_trajectories(const Options *options, Error *error) {
    Trajectory *a = trajectory_read(options->paths[0], error);
    Trajectory *b = a != NULL ? trajectory_read(options->paths[1], error) : NULL;
    TrajectoryDifference difference = {0};
    if (b != NULL) {
        trajectory_compare(a, b, &difference);
        print_trajectory_difference(a, &difference);
    }
    trajectory_destroy(a);
    trajectory_destroy(b);
    return difference.equal ? STATUS_SAME : STATUS_DIFFERENT;
}

static void print_missing(const char *path, int count, int64_t first) {
    if (count > 0) printf("only in %s: %d frames, from %" PRId64 " on\n", path, count, first);
}

static bool print_sequence_difference(const Options *options, const SequenceDifference *difference) {
    print_missing(options->paths[0], difference->only_a, difference->first_only_a);
    print_missing(options->paths[1], difference->only_b, difference->first_only_b);
    const ImageDifference *first = &difference->at_first;
    if (difference->first >= 0 && !first->same_size)
        printf("first difference: frame %" PRId64 ": %d x %d and %d x %d pixels\n", difference->first,
               difference->width_a, difference->height_a, difference->width_b, difference->height_b);
    else if (difference->first >= 0)
        printf("first difference: frame %" PRId64 ": %" PRId64 " pixels, the largest by %d, the first at (%d, %d)\n",
               difference->first, first->pixels, first->largest, first->first_x, first->first_y);
    if (difference->different > 0) printf("%d of %d frames differ\n", difference->different, difference->compared);
    bool equal = difference->different + difference->only_a + difference->only_b == 0;
    if (equal) printf("equal: %d frames\n", difference->compared);
    return equal;
}

static int compare_sequences(const Options *options, Error *error) {
    ImageSequence *a = image_sequence_open(options->paths[0], error);
    ImageSequence *b = a != NULL ? image_sequence_open(options->paths[1], error) : NULL;
    bool equal = false;
    if (b != NULL) {
        ProgressBar bar;
        progress_bar_begin(&bar, "comparing");
        SequenceDifference difference;
        bool ok = image_sequence_compare(a, b, &difference, &bar.progress, error);
        progress_bar_end(&bar);
        equal = ok && print_sequence_difference(options, &difference);
    }
    image_sequence_close(a);
    image_sequence_close(b);
    return equal ? STATUS_SAME : STATUS_DIFFERENT;
}

int command_compare(int argc, char **argv, Error *error) {
    Options options = {0};
    if (!options_parse(&argp, argc, argv, &options)) return STATUS_DIFFERENT;
    bool first = is_trajectory(options.paths[0]), second = is_trajectory(options.paths[1]);
    if (first != second) {
        error_input(error, options.paths[first ? 1 : 0], "is no trajectory (.npz), but %s is",
                    options.paths[first ? 0 : 1]);
        return STATUS_DIFFERENT;
    }
    return first ? compare_trajectories(&options, error) : compare_sequences(&options, error);
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/commands.h"
#include "cli/compare_options.h"
#include "cli/compare_json.h"
#include "cli/compare_print.h"
#include "cli/compare_watch.h"
#include "cli/notes.h"
#include "cli/progress_bar.h"
#include "common/standard_io.h"
#include "common/hash.h"
#include "common/text_add.h"
#include "report/regression_github.h"
#include "report/regression_report.h"
#include "trajectory/trajectory.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static bool is_trajectory(const char *path) {
    size_t length = strlen(path);
    if (path_is_standard(path)) return true; /* pictures come in folders */
    return length > 4 && strcmp(path + length - 4, ".npz") == 0;
}

static void print_trajectory_difference(const Trajectory *a, const TrajectoryDifference *difference) {
    if (difference->poses_only) printf("only poses are compared: a run has no velocities\n");
    if (difference->equal) {
        printf("equal: %d frames of %d bodies\n", a->frames, a->bodies);
        return;
    }
    if (difference->what[0] != '\0') printf("%s\n", difference->what);
    if (difference->frame < 0) return;
    printf("first difference: frame %d, body %d: %g m apart, %g rad", difference->frame, difference->body,
           difference->distance, difference->angle);
    if (!difference->poses_only) printf(", %g m/s", difference->speed);
    printf("\n");
    printf("largest distance: frame %d, body %d: %g m apart\n", difference->max_frame, difference->max_body,
           difference->max_distance);
}

static bool compare_trajectories(const CompareOptions *options, Error *error) {
    const char *const *paths = options->paths;
    Trajectory *a = trajectory_read(paths[0], error);
    Trajectory *b = a != NULL ? trajectory_read(paths[1], error) : NULL;
    TrajectoryDifference difference = {0};
    if (b != NULL) {
        trajectory_compare(a, b, &difference);
        if (options->json)
            compare_json_runs(paths, a, b, &difference, error);
        else
            print_trajectory_difference(a, &difference);
    }
    trajectory_destroy(a);
    trajectory_destroy(b);
    return difference.equal && error->kind == ERROR_NONE;
}

static bool report(Regression *regression, const CompareOptions *options, Error *error) {
    bool ok = regression_report_write(regression, options->report, (size_t)options->megabytes << 20,
                                      progress_bar_begin("report"), error);
    progress_bar_end();
    if (ok && !options->json) printf("report -> %s/report.html\n", options->report);
    return ok;
}

/* A name may look like a command of GitHub's runner. Nobody can name a file by a token that has the time in it. */
static void print(const CompareOptions *options, const Regression *regression) {
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    uint64_t token = hash_xxh3(&now, sizeof now);
    bool github = options->annotations == ANNOTATE_GITHUB;
    if (github) printf("::stop-commands::%016" PRIx64 "\n", token);
    compare_print(regression);
    RegressionText notes = regression_notes(regression);
    if (notes.text[0] != '\0') printf("%s\n", notes.text);
    if (github) printf("::%016" PRIx64 "::\n", token);
}

static bool annotate(const CompareOptions *options, const Regression *regression, Error *error) {
    const char *summary = getenv("GITHUB_STEP_SUMMARY");
    if (options->annotations != ANNOTATE_GITHUB) return true;
    github_annotate(stdout, regression);
    return summary == NULL || summary[0] == '\0' || github_summary_append(regression, summary, error);
}

static bool compare_pictures(const CompareOptions *options, Error *error) {
    const RegressionOptions compared = {.tolerance = options->tolerance,
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
    note_verbose("%d frame%s matched, %d %s; limits of the command line: %s; %.3f s", regression.count,
                 plural(regression.count), regression.run_count,
                 regression.run_count == 1 ? "trajectory" : "trajectories", tolerance_words(&options->tolerance).text,
                 regression.seconds);
    if (!options->json) print(options, &regression);
    ok = regression_passed(&regression);
    if (options->report != NULL && !report(&regression, options, error)) ok = false;
    if (error->kind == ERROR_NONE && options->json && !compare_json_pictures(&regression, error)) ok = false;
    if (error->kind == ERROR_NONE && !annotate(options, &regression, error)) ok = false;
    regression_free(&regression);
    return ok;
}

static bool compare_inputs(const CompareOptions *options, Error *error) {
    bool first = is_trajectory(options->paths[0]), second = is_trajectory(options->paths[1]);
    if (first != second)
        return error_input(error, options->paths[first ? 1 : 0], "is not a trajectory (.npz), but %s is",
                           options->paths[first ? 0 : 1]);
    bool limits = options->tolerance.given != 0 || options->rules != NULL || options->mask.count > 0;
    if (first && (options->report != NULL || limits || options->annotations != 0))
        return error_input(error, options->paths[0],
                           "--report, --annotations, --rules, masks and tolerances apply to pictures only");
    return first ? compare_trajectories(options, error) : compare_pictures(options, error);
}

static bool compare(const CompareOptions *options, Error *error) {
    bool same = compare_inputs(options, error);
    if (error->kind != ERROR_NONE && options->annotations == ANNOTATE_GITHUB)
        github_annotate_message(stdout, "twinbox compare", error->message);
    return same;
}

bool command_compare(int argc, char **argv, Error *error) {
    CompareOptions options;
    bool same = compare_options_parse(&options, argc, argv, error) &&
                (options.watch ? compare_watch(&options, compare, error) : compare(&options, error));
    compare_options_free(&options);
    return same;
}

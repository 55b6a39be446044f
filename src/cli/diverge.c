/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/commands.h"
#include "cli/divergence.h"
#include "cli/json_output.h"
#include "cli/options.h"
#include "cli/progress_bar.h"

#include <float.h>
#include <stdlib.h>

typedef struct Options {
    const char *paths[2];
    int count;
    double tolerance; /* m */
    const char *scene, *csv;
    bool json;
} Options;

static const Option option_table[] = {
    {"--tolerance", 0, "M",
     "Runs diverge where the centres of a body are more than M metres apart (default: 0, any bit of pose or "
     "velocity)",
     OPTION_DOUBLE(Options, tolerance, 0, (double)FLT_MAX)},
    {"--scene", 0, "SCENE",
     "Scene of the first run: run it again with the same method and one body shifted by 1e-6 m, and compare the "
     "growth. The shifted body is the bomb; before the bomb hits, the first body that differs; without a bomb, the "
     "last body",
     OPTION_PATH(Options, scene)},
    {"--csv", 0, "FILE", "Write frame,time,distance,shifted_distance: the largest distance of any body, s and m",
     OPTION_OUTPUT(Options, csv)},
    {OPTION_JSON(Options, json)},
    {0}};

static const CommandSpec spec = {
    .options = option_table,
    .input = {.value = "RUN RUN", .needed = "two runs (.npz) are needed", OPTION_PATHS(Options, paths, count)},
    .inputs = {2, 2, "run"},
    .help =
        "Find why two runs diverge: the first frame, body and contact that differ, whether the solver or an earlier "
        "step is the cause, and how fast the distance grows from there. Of runs of different lengths, the frames of "
        "the shorter one are compared. Exit status 0: the runs do not diverge beyond the tolerance, 1: they do.\v"
        "Example: twinbox diverge engine.npz momentum.npz --scene scenes/stack.yaml --csv distance.csv"};

static bool read_runs(Divergence *d, const Options *options, Error *error) {
    char what[256];
    for (int i = 0; i < 2; i++)
        if ((d->runs[i] = trajectory_read(options->paths[i], error)) == NULL) return false;
    return !trajectory_different_worlds(d->runs[0], d->runs[1], what, sizeof what) ||
           error_input(error, options->paths[1], "cannot be compared with %s: %s", options->paths[0], what);
}

static bool measure(Divergence *d, Error *error) {
    int frames = d->parting.frames;
    d->distance = malloc((size_t)frames * sizeof *d->distance);
    if (d->distance == NULL) return error_memory(error, "diverge");
    for (int frame = 0; frame < frames; frame++)
        d->distance[frame] = trajectory_distance(d->runs[0], d->runs[1], frame);
    /* command_diverge() frees d->distance. NOLINTNEXTLINE(clang-analyzer-unix.Malloc) */
    return growth_measure(d->distance, 0, frames, (double)d->runs[0]->dt, &d->growth, error);
}

/* Over the same frames as the growth of the two runs. */
static bool measure_chaos(Divergence *d, const char *scene, Error *error) {
    int body = chaos_body(d->runs[0], d->parting.first.body, d->parting.first.frame);
    if (body < 0) return error_input(error, scene, "has no body that can move, so none can be shifted");
    bool ok =
        chaos_run(&d->chaos, scene, d->runs[0], body, d->parting.frames, progress_bar_begin(d->runs[0]->scene), error);
    progress_bar_end();
    return ok && growth_measure(d->chaos.distance, d->growth.first, d->growth.end, (double)d->runs[0]->dt, &d->shifted,
                                error);
}

static bool find(Divergence *d, const Options *options, Error *error) {
    if (!read_runs(d, options, error) ||
        !trajectory_part(d->runs[0], d->runs[1], options->tolerance, &d->parting, error) || !measure(d, error) ||
        (options->scene != NULL && !measure_chaos(d, options->scene, error)))
        return false;
    const DistanceTable table = {d->parting.frames, (double)d->runs[0]->dt, d->distance, d->chaos.distance};
    return options->csv == NULL || distance_table_write(&table, options->csv, error);
}

bool command_diverge(int argc, char **argv, Error *error) {
    Options options = {0};
    if (!options_parse(&spec, argc, argv, &options, error)) return false;
    if (!json_output_check(options.json, error)) return false;
    Divergence divergence = {.paths = options.paths, .tolerance = options.tolerance};
    bool ok = find(&divergence, &options, error);
    if (ok && options.json)
        ok = diverge_print_json(&divergence, error);
    else if (ok)
        diverge_print(&divergence);
    bool same = ok && divergence.parting.beyond.frame < 0;
    chaos_free(&divergence.chaos);
    free(divergence.distance);
    for (int i = 0; i < 2; i++) trajectory_destroy(divergence.runs[i]);
    return same;
}

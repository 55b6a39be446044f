/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/commands.h"
#include "cli/installed.h"
#include "cli/options.h"
#include "cli/progress_bar.h"
#include "figure/figure.h"

#include <stdio.h>
#include <string.h>

enum { AT = 256, MOMENTS, WIDTH, DPI, FONT_SIZE, TRANSPARENT, SCENE, BODIES };

static const struct argp_option option_table[] = {
    {"output", 'o', "FILE", 0, "Figure to write: .png, .svg or .pdf", 0},
    {"at", AT, "T,T,...", 0, "Moments to show, seconds from the start of the run, rising", 0},
    {"moments", MOMENTS, "N", 0, "Number of moments instead, evenly spaced from the first to the last", 0},
    {"scene", SCENE, "FILE", 0, "divergence: scene of the first run, for the band of chaos", 0},
    {"bodies", BODIES, "A,B", 0, "narrow-phase: the pair (default: the bomb's first, else the first to touch)", 0},
    {"width", WIDTH, "column|page|MM", 0, "Width: 85 mm, 174 mm (default) or 40 to 400 mm", 1},
    {"dpi", DPI, "N", 0, "Dots per inch of scenes and of PNG (default: 300; 50 to 1200)", 1},
    {"font-size", FONT_SIZE, "PT", 0, "Font size in points (default: 8; 5 to 14)", 1},
    {"transparent", TRANSPARENT, NULL, 0, "Transparent background instead of white", 1},
    {0}};

typedef struct Options {
    const char *kind, *inputs[FIGURE_RUNS_MAX];
    int input_count;
    const char *output, *at, *moments, *scene, *bodies, *width, *dpi, *points;
    bool transparent;
} Options;

static error_t parse(int key, char *value, struct argp_state *state) {
    Options *options = state->input;
    switch (key) {
    case 'o': options->output = value; break;
    case AT: options->at = value; break;
    case MOMENTS: options->moments = value; break;
    case SCENE: options->scene = installed_path(value); break;
    case BODIES: options->bodies = value; break;
    case WIDTH: options->width = value; break;
    case DPI: options->dpi = value; break;
    case FONT_SIZE: options->points = value; break;
    case TRANSPARENT: options->transparent = true; break;
    case ARGP_KEY_ARG:
        if (options->kind == NULL) {
            options->kind = value;
            break;
        }
        if (options->input_count == FIGURE_RUNS_MAX) argp_error(state, "at most %d runs", FIGURE_RUNS_MAX);
        options->inputs[options->input_count++] = installed_path(value);
        break;
    case ARGP_KEY_END:
        if (options->kind == NULL) argp_error(state, "a kind of figure is needed");
        if (options->output == NULL) argp_error(state, "-o FILE is needed");
        break;
    default: return ARGP_ERR_UNKNOWN;
    }
    return 0;
}

enum { HELP_SIZE = 4096 };

/* All kinds, each with an example. */
static void write_help(char help[HELP_SIZE]) {
    const FigureKind *const *kinds = figure_kinds();
    int used =
        snprintf(help, HELP_SIZE,
                 "Draw a figure for a paper from stored runs (.npz). In SVG and PDF, scenes are pixels, text and lines "
                 "are vectors. The same runs give the same bytes.\n");
    for (int i = 0; kinds[i] != NULL; i++)
        used += snprintf(help + used, (size_t)(HELP_SIZE - used), "\n  %-13s %s", kinds[i]->name, kinds[i]->summary);
    for (int i = 0; kinds[i] != NULL; i++)
        used += snprintf(help + used, (size_t)(HELP_SIZE - used), "%s twinbox figure %s",
                         i == 0 ? "\vExample:" : "\n        ", kinds[i]->example);
    snprintf(help + used, (size_t)(HELP_SIZE - used), "\n");
}

static bool read_width(const char *text, double *width, Error *error) {
    float number;
    if (strcmp(text, "column") == 0)
        *width = FIGURE_COLUMN_WIDTH;
    else if (strcmp(text, "page") == 0)
        *width = FIGURE_PAGE_WIDTH;
    else if (option_float("--width", text, (float)FIGURE_WIDTH_MIN, (float)FIGURE_WIDTH_MAX, &number, error))
        *width = (double)number;
    else
        return false;
    return true;
}

static bool read_number(const char *option, const char *text, double least, double largest, double *value,
                        Error *error) {
    float number;
    if (text == NULL) return true;
    if (!option_float(option, text, (float)least, (float)largest, &number, error)) return false;
    *value = (double)number;
    return true;
}

/* "0.5,0.75,1" */
static bool read_times(const char *text, FigureSpec *spec, Error *error) {
    for (const char *rest = text;; rest++) {
        if (spec->time_count == FIGURE_MOMENTS_MAX)
            return error_input(error, "--at", "more than %d moments", FIGURE_MOMENTS_MAX);
        double *time = &spec->times[spec->time_count];
        if (!parse_leading_double(rest, time, &rest) || (*rest != '\0' && *rest != ','))
            return error_input(error, "--at", "'%s' is not a list of seconds such as 0.5,0.75,1", text);
        if (spec->time_count > 0 && *time <= time[-1]) return error_input(error, "--at", "'%s' must rise", text);
        spec->time_count++;
        if (*rest == '\0') return true;
    }
}

/* "3,11" */
static bool read_bodies(const char *text, FigureSpec *spec, Error *error) {
    const char *comma = strchr(text, ',');
    char first[16];
    int64_t bodies[2];
    if (comma == NULL || comma - text >= (int)sizeof first ||
        (snprintf(first, sizeof first, "%.*s", (int)(comma - text), text),
         !parse_int(first, 0, INT32_MAX, &bodies[0])) ||
        !parse_int(comma + 1, 0, INT32_MAX, &bodies[1]) || bodies[0] == bodies[1])
        return error_input(error, "--bodies", "'%s' is not a pair of bodies such as 3,11", text);
    for (int i = 0; i < 2; i++) spec->bodies[i] = (int)bodies[i];
    return true;
}

static bool refuse(const char *option, const FigureKind *kind, Error *error) {
    return error_input(error, option, "does not apply to the kind %s", kind->name);
}

static bool check_inputs(const FigureKind *kind, const Options *options, Error *error) {
    int least = kind->max_runs == 0 ? 1 : kind->min_runs, most = kind->max_runs == 0 ? 1 : kind->max_runs;
    if (options->input_count >= least && options->input_count <= most) return true;
    return error_input(error, "figure", "%s needs %s%d%s, not %d", kind->name, least < most ? "at least " : "", least,
                       kind->max_runs == 0 ? " network (.npz)"
                       : most == 1         ? " run (.npz)"
                                           : " runs (.npz)",
                       options->input_count);
}

static bool read_options(const Options *options, const FigureKind *kind, FigureSpec *spec, SketchOutput *output,
                         Error *error) {
    int moments;
    SketchFormat format;
    *spec =
        (FigureSpec){.width = FIGURE_PAGE_WIDTH, .points = FIGURE_POINTS, .dpi = SKETCH_DPI, .scene = options->scene};
    if (!sketch_format(options->output, &format, error) || !check_inputs(kind, options, error)) return false;
    if (options->at != NULL && !kind->takes_times) return refuse("--at", kind, error);
    if (options->moments != NULL && !kind->takes_moments) return refuse("--moments", kind, error);
    if (options->scene != NULL && !kind->takes_scene) return refuse("--scene", kind, error);
    if (options->bodies != NULL && !kind->takes_bodies) return refuse("--bodies", kind, error);
    if (options->at != NULL && options->moments != NULL)
        return error_input(error, "--moments", "cannot be combined with --at");
    if ((options->width != NULL && !read_width(options->width, &spec->width, error)) ||
        !read_number("--dpi", options->dpi, SKETCH_DPI_MIN, SKETCH_DPI_MAX, &spec->dpi, error) ||
        !read_number("--font-size", options->points, FIGURE_POINTS_MIN, FIGURE_POINTS_MAX, &spec->points, error) ||
        (options->at != NULL && !read_times(options->at, spec, error)) ||
        (options->bodies != NULL && !read_bodies(options->bodies, spec, error)))
        return false;
    if (options->moments != NULL) {
        if (!option_int("--moments", options->moments, 1, FIGURE_MOMENTS_MAX, &moments, error)) return false;
        spec->moments = moments;
    }
    *output = (SketchOutput){spec->dpi, options->transparent};
    return true;
}

static bool draw(const FigureKind *kind, const FigureSpec *spec, const Options *options, const SketchOutput *output,
                 Error *error) {
    Sketch sketch = {0};
    bool ok = kind->draw(&sketch, spec, error) && sketch_check_pixels(sketch.width, sketch.height, spec->dpi, error) &&
              sketch_write(&sketch, options->output, output, error);
    if (ok) printf("%s, %.1f x %.1f mm -> %s\n", kind->name, sketch.width, sketch.height, options->output);
    sketch_free(&sketch);
    return ok;
}

int command_figure(int argc, char **argv, Error *error) {
    Options options = {0};
    char help[HELP_SIZE];
    write_help(help);
    const struct argp argp = {option_table, parse, "KIND RUN...", help, NULL, NULL, NULL};
    if (!options_parse(&argp, argc, argv, &options)) return STATUS_DIFFERENT;
    const FigureKind *kind = figure_kind(options.kind, error);
    FigureSpec spec;
    SketchOutput output;
    if (kind == NULL || !read_options(&options, kind, &spec, &output, error)) return STATUS_DIFFERENT;
    Trajectory *runs[FIGURE_RUNS_MAX] = {NULL};
    bool ok = true;
    if (kind->max_runs == 0) spec.network = options.inputs[0];
    for (int i = 0; ok && kind->max_runs > 0 && i < options.input_count; i++) {
        runs[i] = trajectory_read(options.inputs[i], error);
        spec.runs[i] = runs[i], spec.paths[i] = options.inputs[i];
        spec.run_count++;
        ok = runs[i] != NULL;
    }
    ProgressBar bar;
    progress_bar_begin(&bar, kind->name);
    spec.progress = &bar.progress;
    ok = ok && draw(kind, &spec, &options, &output, error);
    progress_bar_end(&bar);
    for (int i = 0; i < FIGURE_RUNS_MAX; i++) trajectory_destroy(runs[i]);
    return ok ? STATUS_SAME : STATUS_DIFFERENT;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* twinbox figure: the kinds of figures, and their options. */
#include "base/base.h"
#include "base/file.h"
#include "cli/cli.h"
#include "cli/common_options.h"
#include "cli/installed.h"
#include "cli/notes.h"
#include "cli/options.h"
#include "cli/panels.h"
#include "cli/progress_bar.h"
#include "figures/figure.h"
#include "figures/sketch.h"
#include "pictures/picture.h"
#include "pixels/type.h"
#include "runs/runs.h"
#include "runs/trajectory.h"
#include "scenes/scenes.h"

#include <string.h>
#include <unistd.h>

typedef struct Options {
    const char *kind, *inputs[FIGURE_RUNS_MAX], *output;
    int input_count, caption_count;
    FigureSpec figure;
    bool transparent, outlines;
    const char *view_from; /* RUN.npz, or NULL */
} Options;

static OptionRead read_input, read_times, read_bodies, read_width;

static const Option option_table[] = {
    {"--output", 'o', "FILE", "Figure to write: .png, .svg or .pdf", OPTION_OUTPUT(Options, output)},
    {"--at", 0, "T,T,...", "Moments to show, seconds from the start of the run, rising",
     OPTION_READ(read_times, Options, figure)},
    {"--moments", 0, "N", "Number of moments instead, evenly spaced from the first to the last",
     OPTION_INT(Options, figure.moments, 1, FIGURE_MOMENTS_MAX)},
    {"--camera", 0, "X,Y,W,H", CAMERA_OPTION_VIEW, OPTION_READ(camera_option_read, Options, figure.view)},
    {"--view-from", 0, "RUN", "The view of this run (.npz) instead of one for all runs",
     OPTION_PATH(Options, view_from)},
    {"--scene", 0, "SCENE", "divergence: scene of the first run, for the band of chaos",
     OPTION_PATH(Options, figure.scene)},
    {"--bodies", 0, "A,B,...", "strip: show the part of the world with these bodies",
     OPTION_READ(read_bodies, Options, figure)},
    {"--labels", 0, "KIND", "strip: in boxes that are large enough: mass (kg), number, name, or none (default)",
     OPTION_ENUM(Options, figure.labels, look_labels_names)},
    {"--show", 0, "modes", "strip: what contacts do: open, sticks or slips; and how many do it as in the reference",
     OPTION_FLAGS(Options, figure.show, look_show_names)},
    {"--width", 0, "column|page|MM", "Width: 85 mm, 174 mm (default) or 40 to 400 mm",
     OPTION_READ(read_width, Options, figure.width), .least = FIGURE_WIDTH_MIN, .most = FIGURE_WIDTH_MAX, .group = 1},
    {"--height", 0, "MM", "strip: height of the page, 20 to 240 mm (default: as high as its cells)",
     OPTION_DOUBLE(Options, figure.height, FIGURE_HEIGHT_MIN, FIGURE_HEIGHT_MAX)},
    {"--dpi", 0, "N", "Dots per inch of scenes and of PNG (default: 300; 50 to 1200)",
     OPTION_DOUBLE(Options, figure.dpi, SKETCH_DPI_MIN, SKETCH_DPI_MAX)},
    {"--font-size", 0, "PT", "Font size in points (default: 8; 5 to 14)",
     OPTION_DOUBLE(Options, figure.points, FIGURE_POINTS_MIN, FIGURE_POINTS_MAX)},
    {"--transparent", 0, NULL, "Transparent background instead of white", OPTION_FLAG(Options, transparent)},
    {"--caption", 0, "TEXT",
     "Caption of a run, instead of its method's name (may be repeated: one per run, in their order; \"\" keeps the "
     "name)",
     OPTION_TEXTS(Options, figure.captions, caption_count)},
    {OPTION_COLOUR(Options, figure.colours)},
    {"--outlines", 0, NULL, "SVG: text as outlines, for programs that ignore embedded fonts",
     OPTION_FLAG(Options, outlines)},
    {0}};
enum { HELP_SIZE = 5120, KINDS_MAX = 31 };

/* All kinds, each with an example. */
static void write_help(char help[HELP_SIZE]) {
    static const char runs[] = "\vExample: twinbox simulate stack -o engine.npz\n"
                               "         twinbox simulate stack --method momentum:k=20 -o momentum.npz";
    const FigureKind *const *kinds = figure_kinds();
    snprintf(help, HELP_SIZE,
             "Draw a figure for a paper from stored runs (.npz). In SVG and PDF, scenes are pixels, text and lines "
             "are vectors. The same runs give the same bytes.\n");
    for (int i = 0; kinds[i] != NULL; i++) text_add(help, HELP_SIZE, "\n  %-13s %s", kinds[i]->name, kinds[i]->summary);
    for (int i = 0; kinds[i] != NULL; i++)
        text_add(help, HELP_SIZE, "%s\n         twinbox figure %s", i == 0 ? runs : "", kinds[i]->example);
    text_add(help, HELP_SIZE, "\n");
}

/* The kind, then runs. */
static bool read_input(const Option *option, const char *text, void *value, Error *error) {
    Options *options = value;
    if (options->kind != NULL) return option_path(option, text, &options->inputs[options->input_count++], error);
    options->kind = text;
    return true;
}

static bool read_width(const Option *option, const char *text, void *value, Error *error) {
    if (strcmp(text, "column") == 0)
        *(double *)value = FIGURE_COLUMN_WIDTH;
    else if (strcmp(text, "page") == 0)
        *(double *)value = FIGURE_PAGE_WIDTH;
    else
        return option_double(option, text, value, error);
    return true;
}

/* "0.5,0.75,1" */
static bool read_times(const Option *option, const char *text, void *value, Error *error) {
    FigureSpec *spec = value;
    spec->time_count = 0;
    for (const char *rest = text;; rest++) {
        if (spec->time_count == FIGURE_MOMENTS_MAX)
            return error_input(error, option->name, "more than %d moments", FIGURE_MOMENTS_MAX);
        double *time = &spec->times[spec->time_count];
        if (!parse_leading_double(rest, time, &rest) || (*rest != '\0' && *rest != ','))
            return error_input(error, option->name, "'%s' is not a list of seconds such as 0.5,0.75,1", text);
        if (spec->time_count > 0 && *time <= time[-1]) return error_input(error, option->name, "'%s' must rise", text);
        spec->time_count++;
        if (*rest == '\0') return true;
    }
}

static bool has_body(const FigureSpec *spec, int64_t body) {
    for (int i = 0; i < spec->body_count; i++)
        if (spec->bodies[i] == body) return true;
    return false;
}

/* "3,11" */
static bool read_bodies(const Option *option, const char *text, void *value, Error *error) {
    FigureSpec *spec = value;
    spec->body_count = 0;
    for (const char *rest = text;; rest++) {
        int64_t body;
        if (!parse_leading_int(rest, 0, INT32_MAX, &body, &rest) || (*rest != ',' && *rest != '\0') ||
            has_body(spec, body))
            return error_input(error, option->name, "'%s' is not a list of different bodies such as 3,11", text);
        if (spec->body_count == FIGURE_BODIES_MAX)
            return error_input(error, option->name, "more than %d bodies", FIGURE_BODIES_MAX);
        spec->bodies[spec->body_count++] = (int)body;
        if (*rest == '\0') return true;
    }
}

static bool figure_refuse(const char *option, const FigureKind *kind, Error *error) {
    return error_input(error, option, "does not apply to the kind %s", kind->name);
}

static bool check_options(const FigureKind *kind, const Options *options, Error *error) {
    const FigureSpec *figure = &options->figure;
    SketchFormat format;
    if (!sketch_format(options->output, &format, error)) return false;
    if (options->input_count < kind->min_runs || options->input_count > kind->max_runs)
        return error_input(error, "figure", "%s needs %s%d run%s (.npz), not %d", kind->name,
                           kind->min_runs < kind->max_runs ? "at least " : "", kind->min_runs, plural(kind->min_runs),
                           options->input_count);
    if (options->caption_count > options->input_count)
        return error_input(error, "--caption", "%d captions for %d run%s", options->caption_count, options->input_count,
                           plural(options->input_count));
    for (int i = 0; i < options->caption_count; i++)
        if (!caption_check(figure->captions[i], "--caption", error)) return false;
    if (options->outlines && format != SKETCH_SVG)
        return error_input(error, "--outlines", "is for SVG, not for %s", options->output);
    if (figure->time_count > 0 && !kind->takes_times) return figure_refuse("--at", kind, error);
    if (figure->moments > 0 && !kind->takes_moments) return figure_refuse("--moments", kind, error);
    if (figure->scene != NULL && !kind->takes_scene) return figure_refuse("--scene", kind, error);
    if (figure->height > 0 && !kind->takes_height) return figure_refuse("--height", kind, error);
    if (figure->body_count > 0 && figure->view.width > 0)
        return error_input(error, "--bodies", "cannot be combined with --camera");
    if (figure->body_count > 0 && !kind->takes_bodies) return figure_refuse("--bodies", kind, error);
    if (figure->labels != LOOK_NO_LABELS && !kind->takes_labels) return figure_refuse("--labels", kind, error);
    if (figure->show != 0 && !kind->takes_show) return figure_refuse("--show", kind, error);
    if (figure->show & ~(unsigned)SHOW_MODES) return error_input(error, "--show", "a figure shows 'modes' only");
    if (figure->view.width > 0 && !kind->takes_view) return figure_refuse("--camera", kind, error);
    if (options->view_from != NULL && !kind->takes_view) return figure_refuse("--view-from", kind, error);
    return figure->time_count == 0 || figure->moments == 0 ||
           error_input(error, "--moments", "cannot be combined with --at");
}

/* A chart of the scene of a run, if its file is found by its name and has a family of launches. */
static void next_chart(const char *scene) {
    char path[TRAJECTORY_NAME_SIZE + 8];
    snprintf(path, sizeof path, "%s.yaml", scene);
    const char *found = access(path, R_OK) == 0 ? path : scene;
    Scene *file = access(installed_path(found), R_OK) == 0 ? scene_read(installed_path(found), &(Error){0}) : NULL;
    if (file != NULL && file->bomb.present && launch_has_family(file))
        next_print((const char *const[]){"chart", found, "--quick", "-o", next_path(scene, "-chart").text, NULL});
    scene_destroy(file);
}

static bool read_and_draw(const FigureKind *kind, Options *options, Error *error) {
    Trajectory *runs[FIGURE_RUNS_MAX] = {NULL};
    FigureSpec *figure = &options->figure;
    Trajectory *view_from;
    bool ok = camera_option_load(options->view_from, &figure->view, &view_from, error);
    figure->view_from = view_from;
    for (int i = 0; ok && i < options->input_count; i++) {
        runs[i] = trajectory_read(options->inputs[i], error);
        figure->runs[i] = runs[i], figure->paths[i] = options->inputs[i];
        figure->run_count++;
        ok = runs[i] != NULL &&
             (!kind->needs_contacts || !runs[i]->no_contacts || trajectory_find_contacts(runs[i], error)) &&
             type_check(runs[i]->scene, options->inputs[i], error) &&
             type_check(runs[i]->method, options->inputs[i], error);
    }
    if (ok) note_different_scenes(figure->runs, figure->run_count);
    figure->progress = progress_bar_begin(kind->name);
    const SketchOutput output = {figure->dpi, options->transparent, options->outlines};
    Sketch sketch = {0};
    ok = ok && figure_draw(kind, &sketch, figure, error) && sketch_check_texts(&sketch, kind->name, error) &&
         sketch_check_pixels(sketch.width, sketch.height, figure->dpi, error) &&
         sketch_write(&sketch, options->output, &output, error);
    if (ok) printf("%s, %.1f x %.1f mm -> %s\n", kind->name, sketch.width, sketch.height, options->output);
    sketch_free(&sketch);
    progress_bar_end();
    if (ok && !path_is_standard(options->output)) next_chart(runs[0]->scene);
    for (int i = 0; i < FIGURE_RUNS_MAX; i++) trajectory_destroy(runs[i]);
    trajectory_destroy(view_from);
    return ok;
}

bool command_figure(int argc, char **argv, Error *error) {
    Options options = {.figure = {.width = FIGURE_PAGE_WIDTH, .points = FIGURE_POINTS, .dpi = SKETCH_DPI}};
    char help[HELP_SIZE];
    const char *names[KINDS_MAX + 1] = {NULL};
    write_help(help);
    for (int i = 0; i < KINDS_MAX && figure_kinds()[i] != NULL; i++) names[i] = figure_kinds()[i]->name;
    const CommandSpec spec = {
        .options = option_table,
        .input = {.value = "KIND RUN...", .needed = "a kind of figure is needed", .read = read_input, .names = names},
        .inputs = {1, 1 + FIGURE_RUNS_MAX, "argument"},
        .help = help};
    if (!options_parse(&spec, argc, argv, &options, error)) return false;
    const FigureKind *kind = figure_kind(options.kind, error);
    if (kind == NULL) return false;
    if (options.output == NULL) return error_input(error, "figure", "-o FILE is needed");
    return check_options(kind, &options, error) && read_and_draw(kind, &options, error);
}

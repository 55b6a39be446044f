/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The largest distance of any body from its position in the first run, over time. The band shows the distance of the
   first run from copies with one body shifted by a micrometre: two runs inside it diverge no faster than by chaos. */
#include "base/base.h"
#include "base/machine.h"
#include "figures/figure.h"
#include "figures/figures_internal.h"
#include "figures/plot.h"
#include "figures/sketch.h"
#include "methods/methods.h"
#include "pictures/picture.h"
#include "pixels/png.h"
#include "pixels/type.h"
#include "runs/compare_runs.h"
#include "runs/divergence.h"
#include "runs/trajectory.h"

#include <math.h>
#include <stdlib.h>

enum { BAND_BODIES = 5 }; /* bodies shifted, one at a time */

static const uint32_t band_colour = 0xD3D8DF;
static const double sample = 6; /* mm, line sample in the legend */
static const char distance_label[] = "largest distance (m)";

typedef struct Divergence {
    const FigureSpec *spec;
    RunColours colours[FIGURE_RUNS_MAX];
    int frames;                        /* of the first run */
    double *distance[FIGURE_RUNS_MAX]; /* [frames] m; NaN after the end of either run; NULL for the first run */
    double *low, *high;                /* [frames] m, the band; NULL: none. NaN after its end */
    int shifted;                       /* number of bodies shifted for the band */
} Divergence;

/* The bomb, and other bodies spread evenly over the order of bodies. */
static int choose_bodies(const Trajectory *run, int bodies[BAND_BODIES]) {
    int count = 0, others = 0, wanted = BAND_BODIES, seen = 0;
    for (int i = 0; i < run->bodies; i++) others += !run->fixed[i] && i != run->bomb;
    if (run->bomb >= 0 && !run->fixed[run->bomb]) bodies[count++] = run->bomb, wanted--;
    if (wanted > others) wanted = others;
    for (int i = 0; i < run->bodies; i++) {
        if (run->fixed[i] || i == run->bomb) continue;
        /* the k-th of `wanted` has index k (others - 1) / (wanted - 1) */
        int taken = run->bomb >= 0 ? count - 1 : count;
        if (taken < wanted && seen == (wanted > 1 ? taken * (others - 1) / (wanted - 1) : 0)) bodies[count++] = i;
        seen++;
    }
    return count;
}

static bool widen_band(Divergence *d, int body, const Progress *progress, Error *error) {
    Chaos chaos;
    if (!chaos_run(&chaos, d->spec->scene, d->spec->runs[0], body, d->frames, progress, error)) return false;
    bool same = chaos.rerun_differs < 0;
    for (int i = 0; same && i < d->frames; i++) {
        /* a run with NaN or infinite states ends the band */
        double distance = i < chaos.frames ? chaos.distance[i] : NAN;
        bool there = !isnan(distance) && !isnan(d->low[i]);
        /* distance 0: the shifted body appears later */
        d->low[i] = !there ? NAN : distance > 0 ? fmin(d->low[i], distance) : d->low[i];
        d->high[i] = there ? fmax(d->high[i], distance) : NAN;
    }
    int other = chaos.rerun_differs;
    chaos_free(&chaos);
    return same || error_input(error, d->spec->paths[0],
                               "%s run again differs from this run from frame %d on: it was made "
                               "with other options or by another version",
                               d->spec->scene, other);
}

static bool make_band(Divergence *d, Error *error) {
    int bodies[BAND_BODIES] = {0};
    d->low = malloc((size_t)d->frames * sizeof *d->low);
    d->high = malloc((size_t)d->frames * sizeof *d->high);
    if (d->low == NULL || d->high == NULL) return error_memory(error, "figure");
    for (int i = 0; i < d->frames; i++) d->low[i] = HUGE_VAL, d->high[i] = 0;
    d->shifted = choose_bodies(d->spec->runs[0], bodies);
    if (d->shifted == 0) return error_input(error, d->spec->scene, "the scene has no dynamic body to shift");
    for (int i = 0; i < d->shifted; i++) {
        ProgressStage stage = {d->spec->progress, (double)i / d->shifted, 1.0 / d->shifted, false};
        if (!widen_band(d, bodies[i], &(Progress){progress_stage, &stage}, error)) return false;
    }
    return true;
}

static void include(PlotRange *range, const double *values, int count) {
    for (int i = 0; values != NULL && i < count; i++) plot_range_include(range, values[i]);
}

/* The points of a line up to its next gap. */
static int gather_points(const Divergence *d, const PlotPanel *plot, const double *values, int from, Point *points) {
    int count = 0;
    for (int i = from; i < d->frames && values[i] > 0; i++)
        points[count++] = plot_place(plot, i * (double)d->spec->runs[0]->dt, values[i]);
    return count;
}

/* The colour of the method; the dashes tell lines apart in grey. */
static Pen line_pen(const Divergence *d, int run) {
    return pen_line(d->colours[run].light.fill, 2.2, plot_style(run - 1).dashes);
}

static bool ever_diverges(const double *distance, int frames) {
    for (int i = 0; i < frames; i++)
        if (distance[i] > 0) return true;
    return false;
}

/* Rows above the plot, down from `top`, `width` mm wide. Returns their number; without a sketch, it only counts
   them. */
static int draw_legend(const Divergence *d, Sketch *sketch, Point top, double width) {
    const FigureSpec *spec = d->spec;
    const double line = line_height(spec->points), indent = sample + gap_to_text(spec->points);
    int rows = 0;
    for (int i = 1; i <= spec->run_count; i++) {
        const bool band = i == spec->run_count;
        if (band && d->low == NULL) break;
        const RunName first = run_name(spec, spec->runs[0]);
        const WrappedText words =
            band ? wrap_text(spec->points, width - indent, "%s, one of %d bodies shifted by 1 \xC2\xB5m", first.text,
                             d->shifted)
                 : wrap_text(spec->points, width - indent, "%s vs %s%s", run_name(spec, spec->runs[i]).text, first.text,
                             ever_diverges(d->distance[i], d->frames) ? "" : ": identical");
        const Point at = {top.x, top.y - (rows + 0.5) * line}, end = {at.x + sample, at.y};
        rows += words.lines;
        if (sketch == NULL) continue;
        draw_wrapped(sketch, (Point){at.x + indent, at.y}, INK, &words);
        if (band)
            sketch_rectangle(sketch, (Point){at.x, at.y - 0.3 * line}, (Point){end.x, at.y + 0.3 * line},
                             &(Pen){band_colour, 1, NO_COLOUR, 0, NULL});
        else if (ever_diverges(d->distance[i], d->frames)) {
            const Pen pen = line_pen(d, i);
            sketch_line(sketch, at, end, &pen);
        }
    }
    return rows;
}

static bool draw_plot(const Divergence *d, Sketch *sketch, PlotRange range, Error *error) {
    const FigureSpec *spec = d->spec;
    const double shape = 0.55, tallest = 75, line = line_height(spec->points), points = spec->points;
    const double left = plot_left_margin(points), bottom = plot_bottom_margin(points), room = fmax(3, 0.9 * line);
    const double height = fmin(fmax(shape * spec->width, type_width(distance_label, points)), tallest);
    const int touch = trajectory_impact(spec->runs[0]);
    const double above = touch >= 0 ? 1.2 * line : 0;
    const int rows = draw_legend(d, NULL, (Point){0, 0}, spec->width - PAGE_EDGE - left);
    PlotPanel plot = {.box = {left, bottom, spec->width - room - left, height},
                      .x = plot_linear_axis(0, (d->frames - 1) * (double)spec->runs[0]->dt, "time (s)"),
                      .y = plot_log_axis(range.least, range.most, distance_label),
                      .points = points,
                      .guides = true};
    plot.y.powers = true;
    plot_panel_place(&plot);
    sketch_begin(sketch, spec->width, bottom + height + above + rows * line + (touch >= 0 ? 0.6 : 2));
    Point *places = malloc(2 * (size_t)d->frames * sizeof *places);
    if (places == NULL) return error_memory(error, "figure");
    if (d->low != NULL) {
        int first = 0;
        while (first < d->frames && !(d->high[first] > 0)) first++;
        const int count = gather_points(d, &plot, d->high, first, places);
        for (int i = count - 1; i >= 0; i--)
            places[count + (count - 1 - i)] =
                plot_place(&plot, (first + i) * (double)spec->runs[0]->dt, d->low[first + i]);
        /* the outline stays visible while the band has no height */
        sketch_shape(sketch, places, 2 * count, &(Pen){band_colour, 1, band_colour, 2.2, NULL});
    }
    plot_panel_draw(sketch, &plot);
    if (touch >= 0) {
        /* A line, named above the plot, where no line can cross the name. */
        const double half = type_width("impact", points) / 2;
        const double x = plot_axis_place(&plot.x, touch * (double)spec->runs[0]->dt);
        const double middle = fmin(fmax(x, plot.x.from + half), sketch->width - half - PAGE_EDGE);
        const Pen pen = pen_line(INK_SOFT, 1.2, "(4,4)");
        sketch_line(sketch, (Point){x, plot.y.from}, (Point){x, plot.y.to}, &pen);
        sketch_text(sketch, (Point){middle, plot.y.to + 0.7 * line}, &(TextStyle){points, TEXT_CENTER, INK, 0, false},
                    "impact");
    }
    for (int i = 1; i < spec->run_count; i++) {
        const Pen pen = line_pen(d, i);
        for (int k = 0; k < d->frames; k++) {
            const int count = gather_points(d, &plot, d->distance[i], k, places);
            if (count > 1) sketch_path(sketch, places, count, &pen);
            /* A frame alone has no line. */
            if (count == 1)
                plot_mark(sketch, places[0], &(PlotStyle){.symbol = METHOD_CIRCLE, .colour = d->colours[i].light.fill},
                          0.8, 0);
            k += count;
        }
    }
    draw_legend(d, sketch, (Point){left, sketch->height}, spec->width - PAGE_EDGE - left);
    free(places);
    return true;
}

static bool divergence_draw(Sketch *sketch, const FigureSpec *spec, Error *error) {
    Divergence d = {.spec = spec, .frames = spec->runs[0]->frames};
    PlotRange range = plot_range();
    bool done = run_colours(spec, d.colours, error) && run_check_worlds(spec, error);
    for (int i = 1; done && i < spec->run_count; i++) {
        d.distance[i] = malloc((size_t)d.frames * sizeof *d.distance[i]);
        done = d.distance[i] != NULL || error_memory(error, "figure");
        for (int frame = 0; done && frame < d.frames; frame++)
            d.distance[i][frame] =
                frame < spec->runs[i]->frames ? trajectory_distance(spec->runs[0], spec->runs[i], frame) : NAN;
        if (done) include(&range, d.distance[i], d.frames);
    }
    done = done && (spec->scene == NULL || make_band(&d, error));
    if (done) include(&range, d.low, d.frames), include(&range, d.high, d.frames);
    if (done && range.most == 0)
        done =
            error_input(error, spec->paths[1], "never diverges from %s: there is no distance to draw", spec->paths[0]);
    done = done && draw_plot(&d, sketch, range, error);
    for (int i = 0; i < FIGURE_RUNS_MAX; i++) free(d.distance[i]);
    free(d.low);
    free(d.high);
    return done;
}

const FigureKind figure_divergence = {
    .name = "divergence",
    .summary = "distance from the first run over time, with a band of chaotic divergence",
    .example = "divergence engine.npz momentum.npz -o divergence.svg",
    .min_runs = 2,
    .max_runs = FIGURE_RUNS_MAX,
    .takes_scene = true,
    .draw = divergence_draw,
};

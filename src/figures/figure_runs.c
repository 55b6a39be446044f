/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The figures of moments of runs: strobe, strip. */
#include "base/base.h"
#include "engine/engine.h"
#include "figures/figure.h"
#include "figures/figures_internal.h"
#include "figures/labels.h"
#include "figures/sketch.h"
#include "figures/sketch_writers.h"
#include "methods/methods.h"
#include "pictures/picture.h"
#include "pictures/render.h"
#include "pictures/style.h"
#include "pixels/png.h"
#include "pixels/type.h"
#include "runs/compare_runs.h"
#include "runs/trajectory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Many moments of one run in one picture: the last is opaque, earlier ones are paler. */

enum { STROBE_MOMENTS = 9 }; /* by default */

static const double palest = 0.12, before_last = 0.5; /* opacity of the first moment, and of the one before the last */

typedef struct Strobe {
    const FigureSpec *spec;
    const Trajectory *run;
    RunColours colours;
    int frames[FIGURE_MOMENTS_MAX], count;
    WrappedText title;
    RunCells cells;
    Point low;
} Strobe;

static bool draw_moments(Strobe *strobe, Sketch *sketch, Error *error) {
    const int count = strobe->count;
    Image *image =
        run_cells_render(&strobe->cells, strobe->run, strobe->frames[0], &strobe->colours, STILL_FIXED, error);
    bool done = image != NULL;
    for (int i = 0; done && i < count; i++) {
        Image *moment =
            run_cells_render(&strobe->cells, strobe->run, strobe->frames[i], &strobe->colours, STILL_MOVING, error);
        done = moment != NULL;
        double opacity = count > 2 ? palest + (before_last - palest) * i / (count - 2) : palest;
        if (i == count - 1) opacity = 1;
        for (size_t k = 0; done && k < 4 * (size_t)image->width * (size_t)image->height; k += 4) {
            const int alpha = (int)lrint(opacity * moment->pixels[k + 3]);
            if (alpha > 0) pixel_over(image->pixels + k, moment->pixels + k, alpha);
        }
        image_destroy(moment);
    }
    if (done) sketch_image(sketch, image, strobe->low, strobe->cells.width);
    image_destroy(image);
    return done;
}

/* The bomb's centre on the page. False if it does not exist yet or is outside the picture. */
static bool find_bomb(const Strobe *strobe, const View *view, int frame, Point *at) {
    const Trajectory *run = strobe->run;
    if (!trajectory_has(run, frame, run->bomb)) return false;
    *at = view_place(view, run->position[trajectory_at(run, frame, run->bomb)]);
    return at->x > view->low.x && at->x < view->high.x && at->y > view->low.y && at->y < view->high.y;
}

static PageBox box_on_page(const Strobe *strobe, const View *view, int frame, int body) {
    Extent box = extent_empty;
    extent_include(&box, strobe->run, frame, body);
    const Point low = view_place(view, vec2((float)box.left, (float)box.bottom));
    const Point high = view_place(view, vec2((float)box.right, (float)box.top));
    return (PageBox){low.x, low.y, high.x, high.y};
}

/* What times must not cover: bodies of any moment, and edges of the ground. */
static void add_bodies(const Strobe *strobe, const View *view, LabelField *field) {
    const Trajectory *run = strobe->run;
    for (int body = 0; body < run->bodies; body++) {
        for (int i = 0; i < strobe->count && !run->fixed[body]; i++)
            if (trajectory_has(run, strobe->frames[i], body))
                label_add_box(field, box_on_page(strobe, view, strobe->frames[i], body));
        if (!run->fixed[body]) continue;
        const PageBox box = box_on_page(strobe, view, 0, body);
        label_add_segment(field, (Segment){box.left, box.top, box.right, box.top});
        label_add_segment(field, (Segment){box.left, box.bottom, box.left, box.top});
        label_add_segment(field, (Segment){box.right, box.bottom, box.right, box.top});
    }
    field->crossable = field->box_count;
}

/* The bomb's path, and the times at its positions, where there is room. */
static bool draw_bomb(const Strobe *strobe, Sketch *sketch, Error *error) {
    const Trajectory *run = strobe->run;
    if (run->bomb < 0) return true;
    const View view = run_cells_view(&strobe->cells, strobe->low);
    const double points = SMALL_TYPE * strobe->spec->points, height = points * MM_PER_POINT, farthest = 12;
    const double half = 0.5 * (double)run->size[run->bomb].x * view.scale;
    const Pen pen = pen_line(BOMB.line, 1.4, NULL), thin = pen_line(BOMB.line, 0.8, NULL);
    LabelField *field = calloc(1, sizeof *field);
    if (field == NULL) return error_memory(error, "figure");
    field->frame = (PageBox){view.low.x + 0.3, view.low.y + 0.3, view.high.x - 0.3, view.high.y - 0.3};
    Point p, q;
    for (int frame = strobe->frames[0]; frame < strobe->frames[strobe->count - 1]; frame++) {
        if (!find_bomb(strobe, &view, frame, &p) || !find_bomb(strobe, &view, frame + 1, &q)) continue;
        sketch_line(sketch, p, q, &pen);
        label_add_segment(field, (Segment){p.x, p.y, q.x, q.y});
    }
    add_bodies(strobe, &view, field);
    for (int i = strobe->count - 1; i >= 0; i--) {
        char text[32];
        PageBox box;
        Segment leader;
        bool led = false;
        if (!find_bomb(strobe, &view, strobe->frames[i], &p)) continue;
        snprintf(text, sizeof text, "%.2f s", strobe->frames[i] * (double)run->dt);
        const double width = type_width(text, points) + 0.5;
        const LabelWish wish = {p.x, p.y, half, 0, half + farthest, width, height, false, true, true};
        if (!label_place(field, p.x, p.y, 1.1 * half + 0.5, width, height, false, &box) &&
            !label_place_led(field, &wish, &box, &leader, &led))
            continue;
        if (led) draw_leader(sketch, &leader, &box, &thin);
        sketch_text(sketch, (Point){(box.left + box.right) / 2, (box.bottom + box.top) / 2},
                    &(TextStyle){points, TEXT_CENTER, BOMB.line, 0, true}, "%s", text);
    }
    free(field);
    return true;
}

/* Below the picture: the scale, and who has left. Returns the rows; without a sketch, it only counts them. */
static int strobe_foot(const Strobe *strobe, Sketch *sketch) {
    const FigureSpec *spec = strobe->spec;
    const int outside =
        run_count_outside(strobe->run, strobe->frames[strobe->count - 1], &strobe->cells.window, NULL, 0);
    const WrappedText words = wrap_text(spec->points, strobe->cells.width, "%d out of view at the end", outside);
    Flow flow = {.first = {strobe->low.x, strobe->low.y - 0.7 * line_height(spec->points)},
                 .width = strobe->cells.width,
                 .points = spec->points};
    run_cells_scale_bar(&strobe->cells, sketch, &flow);
    if (outside > 0) flow_text(&flow, sketch, INK_SOFT, &words);
    return flow.row + 1;
}

static bool strobe_draw(Sketch *sketch, const FigureSpec *spec, Error *error) {
    Strobe strobe = {.spec = spec, .run = spec->runs[0]};
    const double max_height = 120, max_aspect = 1.2; /* mm; height / width */
    const double line = line_height(spec->points), width = spec->width - 2 * PAGE_EDGE;
    const double height = fmin(max_height, max_aspect * width);
    if (!run_colours(spec, &strobe.colours, error) ||
        !run_frames(spec, STROBE_MOMENTS, 0, strobe.frames, &strobe.count, error))
        return false;
    WorldWindow window = run_window(strobe.spec, strobe.frames, strobe.count);
    run_window_widen(&window, width / height);
    bool done = run_cells_begin(&strobe.cells, &window, width, height, spec->dpi, error);
    if (done) {
        const double dt = (double)strobe.run->dt, first = strobe.frames[0] * dt,
                     last = strobe.frames[strobe.count - 1] * dt;
        const RunName name = run_name(spec, strobe.run);
        strobe.title = strobe.count == 1 ? wrap_text(spec->points, width, "%s, %.2f s", name.text, last)
                                         : wrap_text(spec->points, width, "%s, %d moments from %.2f to %.2f s",
                                                     name.text, strobe.count, first, last);
        strobe.low = (Point){(spec->width - strobe.cells.width) / 2, (strobe_foot(&strobe, NULL) + 0.2) * line};
        sketch_begin(sketch, spec->width, strobe.low.y + strobe.cells.height + (strobe.title.lines + 0.2) * line);
        done = draw_moments(&strobe, sketch, error) && draw_bomb(&strobe, sketch, error);
    }
    if (done) {
        run_cells_frame(&strobe.cells, sketch, strobe.low);
        draw_wrapped(sketch, (Point){strobe.low.x, sketch->height - 0.6 * line}, INK, &strobe.title);
        strobe_foot(&strobe, sketch);
    }
    run_cells_free(&strobe.cells);
    return done;
}

const FigureKind figure_strobe = {
    .name = "strobe",
    .summary = "many moments of a run in one picture, fading",
    .example = "strobe engine.npz --at 0.3,0.4,0.5,0.6 -o strobe.png",
    .min_runs = 1,
    .max_runs = 1,
    .takes_times = true,
    .takes_view = true,
    .takes_moments = true,
    .draw = strobe_draw,
};

/* Moments of runs: a row per run, a column per moment, all with one camera. */

static const double strip_gap = 1.2;                    /* mm: between cells */
static const double least_mark = 0.22, most_mark = 0.5; /* mm: radius of a contact's mark */

enum { STRIP_MOMENTS = 5 }; /* by default */

typedef struct Strip {
    const FigureSpec *spec;
    int frames[FIGURE_MOMENTS_MAX], count;
    RunCells cells;
    RunColours colours[FIGURE_RUNS_MAX];
    double left, top, foot;          /* mm: space beside, above and below the cells */
    double start;                    /* left end of the first cell */
    bool above;                      /* names stand above their rows, not beside them */
    int name_lines;                  /* of the longest name */
    int note_lines[FIGURE_RUNS_MAX]; /* below each row of cells */
    int reference;                   /* row with whose contacts those of the others are compared; -1: none */
    double box;                      /* m, shorter side of the median box */
} Strip;

/* mm: from a row to the next, without notes */
static double row_pitch(const Strip *strip) {
    return strip->cells.height + strip_gap + (strip->above ? strip->name_lines * line_height(strip->spec->points) : 0);
}

/* mm */
static double room_of_notes(const Strip *strip, int first, int end) {
    double room = 0;
    for (int row = first; row < end; row++)
        if (strip->note_lines[row] > 0)
            room += strip->note_lines[row] * line_height(SMALL_TYPE * strip->spec->points) + 0.4;
    return room;
}

static double strip_height(const Strip *strip) {
    const int runs = strip->spec->run_count;
    return strip->top + strip->foot + room_of_notes(strip, 0, runs) + runs * row_pitch(strip) - strip_gap;
}

/* Where the bodies in question are in the first run, at these moments, with a body's room around them. */
static WorldWindow window_of_bodies(const Strip *strip) {
    const FigureSpec *spec = strip->spec;
    const Trajectory *run = spec->runs[0];
    Extent all = extent_empty;
    double margin = 0.2; /* m, at least */
    for (int i = 0; i < spec->body_count; i++) {
        const Vec2 size = run->size[spec->bodies[i]];
        for (int moment = 0; moment < strip->count; moment++)
            extent_include(&all, run, strip->frames[moment], spec->bodies[i]);
        if (!run->fixed[spec->bodies[i]]) margin = fmax(margin, fmin((double)size.x, (double)size.y) / 2);
    }
    if (extent_is_empty(&all)) return run_window(spec, strip->frames, strip->count);
    return (WorldWindow){all.left - margin, all.bottom - margin, all.right - all.left + 2 * margin,
                         all.top - all.bottom + 2 * margin};
}

static int step_of(const Strip *strip, int row, int column) {
    return trajectory_contact_step(strip->spec->runs[row], strip->frames[column]);
}

/* "2 out of view; 41 of 66 contacts as the reference", in lines as wide as a cell; empty if all are there. Of the
   bodies in question, if some are: that others are cut off is meant. */
static WrappedText note_of(const Strip *strip, int row, int column) {
    const FigureSpec *spec = strip->spec;
    const RunCells *cells = &strip->cells;
    const int outside =
        run_count_outside(spec->runs[row], strip->frames[column], &cells->window, spec->bodies, spec->body_count);
    const char *longest = outside > 0 ? "of view" : "reference";
    char text[128] = "";
    if (outside > 0) text_join(text, sizeof text, "; ", "%d out of view", outside);
    if (strip->reference >= 0 && row != strip->reference) {
        const ModeCount count =
            trajectory_same_modes(spec->runs[row], step_of(strip, row, column), spec->runs[strip->reference],
                                  step_of(strip, strip->reference, column));
        text_join(text, sizeof text, "; ", "%d of %d contacts as the reference", count.same, count.of);
    }
    if (text[0] == '\0') return (WrappedText){.lines = 0};
    return wrap_text(text_points(longest, SMALL_TYPE * spec->points, cells->width), cells->width, "%s", text);
}

/* The marks of films (pictures/marks.c) as vectors. */
static void draw_mode(Sketch *sketch, Point at, Vec2 normal, double radius, ContactMode mode, bool wrong) {
    const Pen ring = {0xFFFFFF, 1, ACCENT, 1.4, NULL};
    const Pen filled = {mode == CONTACT_SLIPS ? theme_get(LOOK_LIGHT)->slips : ACCENT, 1, 0xFFFFFF, 1.2, NULL};
    const double bar = mode == CONTACT_SLIPS ? MODE_BAR : 1, wide = bar * MODE_SIDE * radius,
                 high = MODE_SIDE * radius / bar, x = (double)normal.x, y = (double)normal.y;
    Point corners[4];
    for (int i = 0; i < 4; i++) {
        const double along = (i == 1 || i == 2 ? 1 : -1) * wide, up = (i > 1 ? 1 : -1) * high;
        corners[i] = (Point){at.x + along * y + up * x, at.y - along * x + up * y};
    }
    if (wrong) sketch_dot(sketch, at, MODE_WRONG * radius, &ring);
    if (mode == CONTACT_OPEN)
        sketch_dot(sketch, at, radius, &ring);
    else
        sketch_shape(sketch, corners, 4, &filled);
}

/* What contacts do in a cell. */
static void draw_modes(const Strip *strip, Sketch *sketch, int row, int column, Point low) {
    const Trajectory *run = strip->spec->runs[row];
    const View view = run_cells_view(&strip->cells, low);
    const int step = step_of(strip, row, column);
    const double radius = fmin(fmax(DOT_BOX * strip->box * strip->cells.scale, least_mark), most_mark);
    for (int64_t i = run->contact_start[step]; i < run->contact_start[step + 1]; i++) {
        const Point at = view_place(&view, run->contacts[i].point);
        const bool inside = at.x > view.low.x && at.x < view.high.x && at.y > view.low.y && at.y < view.high.y;
        const bool wrong =
            strip->reference >= 0 && !trajectory_same_mode(run, step, i, strip->spec->runs[strip->reference],
                                                           step_of(strip, strip->reference, column));
        if (inside) draw_mode(sketch, at, run->contacts[i].normal, radius, trajectory_mode(run, step, i), wrong);
    }
}

/* What the marks mean, below the scale. Returns the rows; without a sketch, it only counts them. */
static int draw_mode_legend(const Strip *strip, Sketch *sketch, Point first) {
    const FigureSpec *spec = strip->spec;
    Flow flow = {.first = first, .width = spec->width - 2 * PAGE_EDGE, .points = spec->points};
    if ((spec->show & SHOW_MODES) == 0) return 0;
    for (int i = 0; i <= CONTACT_MODES - (strip->reference < 0); i++) {
        const double room = most_mark * (i == CONTACT_MODES ? MODE_WRONG : MODE_SIDE * MODE_BAR),
                     gap = gap_to_text(spec->points);
        const Point at = flow_place(&flow, 2 * room + gap + type_width(mode_words[i], spec->points), 1);
        if (sketch == NULL) continue;
        draw_mode(sketch, (Point){at.x + room, at.y}, vec2(0, 1), most_mark,
                  i < CONTACT_MODES ? (ContactMode)i : CONTACT_STICKS, i == CONTACT_MODES);
        sketch_text(sketch, (Point){at.x + 2 * room + gap, at.y},
                    &(TextStyle){spec->points, TEXT_LEFT, INK_SOFT, 0, false}, "%s", mode_words[i]);
    }
    return flow.row + 1;
}

/* The name of a row's run: beside the row in lines as long as its cells are high, or above it. */
static WrappedText strip_name(const Strip *strip, int row) {
    const double width = strip->above ? strip->spec->width - 2 * PAGE_EDGE : strip->cells.height;
    return wrap_text(strip->spec->points, width, "%s", run_name(strip->spec, strip->spec->runs[row]).text);
}

/* Whether a name can be read when turned: in two lines, none of which ends inside a word or a setting. */
static bool fits_beside(const Strip *strip, int row) {
    const RunName name = run_name(strip->spec, strip->spec->runs[row]);
    for (const char *part = name.text; *part != '\0';) {
        char words[sizeof name.text];
        size_t length = strcspn(part, " :");
        length += part[length] == ':';
        snprintf(words, sizeof words, "%.*s", (int)length, part);
        if (type_width(words, strip->spec->points) > strip->cells.height) return false;
        part += length + (part[length] == ' ');
    }
    return strip_name(strip, row).lines <= 2;
}

/* Cells in the room that names and notes leave. */
static bool lay_out_cells(Strip *strip, Error *error) {
    const FigureSpec *spec = strip->spec;
    const double line = line_height(spec->points), runs = spec->run_count;
    const double names = strip->name_lines * line;
    strip->left = strip->above ? PAGE_EDGE : names + 0.1 * line, strip->top = 1.15 * line;
    strip->foot = (1 + draw_mode_legend(strip, NULL, (Point){0, 0})) * line + 0.6;
    const double width = (spec->width - PAGE_EDGE - strip->left - (strip->count - 1) * strip_gap) / strip->count;
    const double high = (spec->height > 0 ? spec->height : FIGURE_HEIGHT_MAX) - strip->top - strip->foot;
    const double texts = room_of_notes(strip, 0, spec->run_count) + (strip->above ? runs * names : 0);
    const double height = (high - (runs - 1) * strip_gap - texts) / runs;
    WorldWindow window = run_window(spec, strip->frames, strip->count);
    if (spec->body_count > 0) window = window_of_bodies(strip);
    const double least = 5, smallest_time = 0.7; /* mm; share of the font size */
    const double narrowest = fmax(least, smallest_time * type_width("0.00 s ", spec->points) - strip_gap);
    if (!(width >= narrowest && height >= least))
        return error_input(error, "figure",
                           "%d moments of %d runs leave %.1f x %.1f mm per cell at a width of %g mm; at least "
                           "%.1f x %g mm are needed at a font size of %g",
                           strip->count, spec->run_count, fmax(width, 0), fmax(height, 0), spec->width, narrowest,
                           least, spec->points);
    if (spec->height > 0) {
        run_window_widen(&window, width / height);
        window.height = fmax(window.height, window.width / (width / height));
    }
    if (!run_cells_begin(&strip->cells, &window, width, height, spec->dpi, error)) return false;
    strip->cells.labels = spec->labels;
    strip->cells.label_least = FIGURE_POINTS_MIN * spec->dpi / 72;
    if (!sketch_check_pixels(spec->width, strip_height(strip), spec->dpi, error)) return false;
    const double used = strip->left + PAGE_EDGE + strip->count * strip->cells.width + (strip->count - 1) * strip_gap;
    strip->start = (spec->width - used) / 2 + strip->left;
    return true;
}

/* False if it had to. */
static bool grow(int *lines, int needed) {
    const bool enough = needed <= *lines;
    if (!enough) *lines = needed;
    return enough;
}

/* As many lines as names and notes need; more lines leave less room for the cells, and may need more. */
static bool lay_out_lines(Strip *strip, Error *error) {
    strip->name_lines = 1;
    memset(strip->note_lines, 0, sizeof strip->note_lines);
    for (;; run_cells_free(&strip->cells)) {
        bool enough = true;
        if (!lay_out_cells(strip, error)) return false;
        for (int row = 0; row < strip->spec->run_count; row++) {
            if (!strip->above && !fits_beside(strip, row))
                return error_input(error, "figure", "the names have no room beside the rows");
            enough &= grow(&strip->name_lines, strip_name(strip, row).lines);
            for (int column = 0; column < strip->count; column++)
                enough &= grow(&strip->note_lines[row], note_of(strip, row, column).lines);
        }
        if (enough) return true;
    }
}

static Point cell_corner(const Strip *strip, int row, int column) {
    const RunCells *cells = &strip->cells;
    const int below = strip->spec->run_count - 1 - row;
    return (Point){strip->start + column * (cells->width + strip_gap),
                   strip->foot + below * row_pitch(strip) + room_of_notes(strip, row, strip->spec->run_count)};
}

static void strip_draw_texts(const Strip *strip, Sketch *sketch) {
    const FigureSpec *spec = strip->spec;
    const RunCells *cells = &strip->cells;
    const TextStyle turned = {spec->points, TEXT_CENTER, INK, 90, false};
    const double line = line_height(spec->points), above = row_pitch(strip) - strip_gap;
    for (int row = 0; row < spec->run_count; row++) {
        const Point low = cell_corner(strip, row, 0);
        const WrappedText name = strip_name(strip, row);
        const Point first = {low.x - (name.lines - 0.45) * line, low.y + cells->height / 2};
        if (strip->above)
            draw_wrapped(sketch, (Point){low.x, low.y + above - 0.5 * line}, INK, &name);
        else
            sketch_lines(sketch, first, &turned, name.text);
    }
    /* Times above the columns, smaller where these are narrow. */
    const double widest = type_width("0.00 s ", spec->points);
    const double time_points = spec->points * fmin(1, (cells->width + strip_gap) / widest);
    for (int column = 0; column < strip->count; column++) {
        const Point low = cell_corner(strip, 0, column);
        sketch_text(sketch, (Point){low.x + cells->width / 2, low.y + above + strip->top / 2},
                    &(TextStyle){time_points, TEXT_CENTER, INK, 0, false}, "%.2f s",
                    strip->frames[column] * (double)spec->runs[0]->dt);
    }
    Flow foot = {.first = {strip->start, strip->foot - 0.6 - line / 2}, .width = spec->width, .points = spec->points};
    run_cells_scale_bar(cells, sketch, &foot);
    draw_mode_legend(strip, sketch, (Point){foot.first.x, foot.first.y - line});
}

static bool strip_draw(Sketch *sketch, const FigureSpec *spec, Error *error) {
    Strip strip = {.spec = spec, .reference = -1};
    ScaleMeasures measures;
    if (!run_colours(spec, strip.colours, error) || !run_check_worlds(spec, error) ||
        !look_check(&(RenderLook){.labels = spec->labels, .show = spec->show}, spec->runs, spec->run_count, error) ||
        !scales_measure(spec->runs[0], &measures, error))
        return false;
    if (spec->show & SHOW_MODES) strip.reference = trajectory_reference(spec->runs, spec->run_count);
    for (int i = 0; i < spec->body_count; i++)
        if (spec->bodies[i] >= spec->runs[0]->bodies)
            return error_input(error, "--bodies", "there is no body %d; the run has %d bodies", spec->bodies[i],
                               spec->runs[0]->bodies);
    if (!run_frames(spec, STRIP_MOMENTS, 0, strip.frames, &strip.count, error)) return false;
    strip.box = measures.box;
    /* Names stand beside their rows if all have room there. */
    bool done = lay_out_lines(&strip, error);
    if (!done && error->kind == ERROR_INPUT) {
        run_cells_free(&strip.cells);
        *error = (Error){0};
        strip.above = true;
        done = lay_out_lines(&strip, error);
    }
    if (done) sketch_begin(sketch, spec->width, strip_height(&strip));
    for (int row = 0; done && row < spec->run_count; row++)
        for (int column = 0; done && column < strip.count; column++) {
            const Point low = cell_corner(&strip, row, column);
            const WrappedText note = note_of(&strip, row, column);
            Image *image = run_cells_render(&strip.cells, spec->runs[row], strip.frames[column], &strip.colours[row],
                                            STILL_ALL, error);
            done = image != NULL;
            if (!done) break;
            sketch_image(sketch, image, low, strip.cells.width);
            image_destroy(image);
            run_cells_frame(&strip.cells, sketch, low);
            run_cells_label(&strip.cells, sketch, spec->runs[row], strip.frames[column], &strip.colours[row], low);
            if (spec->show & SHOW_MODES) draw_modes(&strip, sketch, row, column, low);
            if (note.lines > 0)
                draw_wrapped(sketch, (Point){low.x, low.y - 0.6 * line_height(note.points)}, INK_SOFT, &note);
        }
    if (done) strip_draw_texts(&strip, sketch);
    run_cells_free(&strip.cells);
    return done;
}

const FigureKind figure_strip = {
    .name = "strip",
    .summary = "moments of runs: a row per run, a column per moment",
    .example = "strip engine.npz momentum.npz --at 0.5,1 -o strip.pdf",
    .min_runs = 1,
    .max_runs = FIGURE_RUNS_MAX,
    .takes_times = true,
    .takes_view = true,
    .takes_moments = true,
    .takes_height = true,
    .takes_bodies = true,
    .takes_labels = true,
    .takes_show = true,
    .draw = strip_draw,
};

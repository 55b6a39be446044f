/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Many moments of one run in one picture: the last is opaque, earlier ones are paler. */
#include "figure/caption.h"
#include "figure/figure_kinds.h"
#include "figure/run_view.h"
#include "picture/style.h"
#include "sketch/label_place.h"
#include "sketch/raster.h"
#include "type/type.h"

#include <math.h>
#include <stdlib.h>

enum { DEFAULT_MOMENTS = 9 };

static const double edge = 0.2;                         /* mm, margin of the page, half a frame line */
static const double max_height = 120, max_aspect = 1.2; /* mm; height / width */
static const double palest = 0.12, before_last = 0.5; /* opacity of the first moment, and of the one before the last */
static const double small_type = 0.85;                /* font size of the times / the figure's font size */

typedef struct Strobe {
    const FigureSpec *spec;
    const Trajectory *run;
    MethodColour colour;
    int frames[FIGURE_MOMENTS_MAX], count;
    RunCells cells;
    Point low;
} Strobe;

static double opacity_of(const Strobe *strobe, int moment) {
    if (moment == strobe->count - 1) return 1;
    return strobe->count > 2 ? palest + (before_last - palest) * moment / (strobe->count - 2) : palest;
}

static void blend_over(Image *image, const Image *upper, double opacity) {
    for (size_t i = 0; i < 4 * (size_t)image->width * (size_t)image->height; i += 4) {
        int alpha = (int)lrint(opacity * upper->pixels[i + 3]);
        if (alpha > 0) pixel_over(image->pixels + i, upper->pixels + i, alpha);
    }
}

static bool draw_moments(Strobe *strobe, Sketch *sketch, Error *error) {
    Image *image = run_cells_render(&strobe->cells, strobe->run, strobe->frames[0], strobe->colour, STILL_FIXED, error);
    bool done = image != NULL;
    for (int i = 0; done && i < strobe->count; i++) {
        Image *moment =
            run_cells_render(&strobe->cells, strobe->run, strobe->frames[i], strobe->colour, STILL_MOVING, error);
        done = moment != NULL;
        if (done) blend_over(image, moment, opacity_of(strobe, i));
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
    *at = view_place(view, run->position[(size_t)frame * (size_t)run->bodies + (size_t)run->bomb]);
    return at->x > view->low.x && at->x < view->high.x && at->y > view->low.y && at->y < view->high.y;
}

static void draw_bomb_path(const Strobe *strobe, Sketch *sketch, const View *view, LabelField *field) {
    const Pen pen = pen_line(BOMB.line, 1.4, NULL);
    Point p, q;
    for (int frame = strobe->frames[0]; frame < strobe->frames[strobe->count - 1]; frame++) {
        if (!find_bomb(strobe, view, frame, &p) || !find_bomb(strobe, view, frame + 1, &q)) continue;
        sketch_line(sketch, p, q, &pen);
        label_add_segment(field, (Segment){p.x, p.y, q.x, q.y});
    }
}

/* The times at the bomb's positions, where there is room. */
static void draw_times(const Strobe *strobe, Sketch *sketch, const View *view, LabelField *field) {
    const Trajectory *run = strobe->run;
    const double points = small_type * strobe->spec->points, height = points * MM_PER_POINT;
    const double half = 0.5 * (double)run->size[run->bomb].x * view->scale;
    Point at;
    for (int i = 0; i < strobe->count; i++)
        if (find_bomb(strobe, view, strobe->frames[i], &at))
            label_add_box(field, (PageBox){at.x - half, at.y - half, at.x + half, at.y + half});
    for (int i = strobe->count - 1; i >= 0; i--) {
        char text[32];
        PageBox box;
        if (!find_bomb(strobe, view, strobe->frames[i], &at)) continue;
        snprintf(text, sizeof text, "%.2f s", strobe->frames[i] * (double)run->dt);
        if (!label_place(field, at.x, at.y, 1.1 * half + 0.5, type_width(text, points) + 0.5, height, false, &box))
            continue;
        sketch_text(sketch, (Point){(box.left + box.right) / 2, (box.bottom + box.top) / 2},
                    &(TextStyle){points, TEXT_CENTER, BOMB.line, 0, true}, "%s", text);
    }
}

static bool draw_bomb(const Strobe *strobe, Sketch *sketch, Error *error) {
    if (strobe->run->bomb < 0) return true;
    const View view = run_cells_view(&strobe->cells, strobe->low);
    LabelField *field = calloc(1, sizeof *field);
    if (field == NULL) return error_memory(error, "figure");
    field->frame = (PageBox){view.low.x + 0.3, view.low.y + 0.3, view.high.x - 0.3, view.high.y - 0.3};
    draw_bomb_path(strobe, sketch, &view, field);
    draw_times(strobe, sketch, &view, field);
    free(field);
    return true;
}

static void draw_texts(const Strobe *strobe, Sketch *sketch) {
    const FigureSpec *spec = strobe->spec;
    const RunCells *cells = &strobe->cells;
    const double line = line_height(spec->points), y = strobe->low.y / 2 - 0.2;
    char title[CAPTION_SIZE + 96];
    const double dt = (double)strobe->run->dt;
    const double first = strobe->frames[0] * dt, last = strobe->frames[strobe->count - 1] * dt;
    if (strobe->count > 1)
        snprintf(title, sizeof title, "%s, %d moments from %.2f to %.2f s", run_name(strobe->spec, strobe->run).text,
                 strobe->count, first, last);
    else
        snprintf(title, sizeof title, "%s, %.2f s", run_name(strobe->spec, strobe->run).text, last);
    text_fit(title, sizeof title, spec->points, cells->width);
    sketch_text(sketch, (Point){strobe->low.x, strobe->low.y + cells->height + 0.6 * line},
                &(TextStyle){spec->points, TEXT_LEFT, INK, 0, false}, "%s", title);
    run_cells_draw_scale_bar(cells, sketch, (Point){strobe->low.x, y}, spec->points);
    int outside = run_count_outside(strobe->run, strobe->frames[strobe->count - 1], &cells->window);
    if (outside > 0)
        sketch_text(sketch, (Point){strobe->low.x + cells->width, y},
                    &(TextStyle){spec->points, TEXT_RIGHT, INK_SOFT, 0, false}, "%d out of view at the end", outside);
}

static bool draw(Sketch *sketch, const FigureSpec *spec, Error *error) {
    Strobe strobe = {.spec = spec, .run = spec->runs[0]};
    const double line = line_height(spec->points), width = spec->width - 2 * edge;
    const double height = fmin(max_height, max_aspect * width);
    run_colours(spec, &strobe.colour);
    if (!run_frames(spec, DEFAULT_MOMENTS, 0, strobe.frames, &strobe.count, error)) return false;
    WorldWindow window = run_window(strobe.spec, strobe.frames, strobe.count);
    run_window_widen(&window, width / height);
    bool done = run_cells_begin(&strobe.cells, &window, width, height, spec->dpi, error);
    if (done) {
        strobe.low = (Point){(spec->width - strobe.cells.width) / 2, 1.2 * line};
        sketch_begin(sketch, spec->width, strobe.cells.height + 2.4 * line);
        done = draw_moments(&strobe, sketch, error) && draw_bomb(&strobe, sketch, error);
    }
    if (done) {
        sketch_rectangle(sketch, strobe.low,
                         (Point){strobe.low.x + strobe.cells.width, strobe.low.y + strobe.cells.height},
                         &(Pen){NO_COLOUR, 1, FRAME, 1.2, NULL});
        draw_texts(&strobe, sketch);
    }
    run_cells_free(&strobe.cells);
    return done;
}

static void caption(FILE *out, const FigureSpec *spec) {
    fputs("One run of the ", out);
    caption_scene(out, spec);
    caption_times(out, spec);
    fputs(" in one picture; earlier moments are paler. Method: ", out);
    caption_run(out, spec, spec->runs[0]);
    fputs(".", out);
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
    .draw = draw,
    .caption = caption,
};

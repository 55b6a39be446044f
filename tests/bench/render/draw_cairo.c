/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The same picture by cairo, written by libpng with its defaults: the rectangles of the drawing, the bodies as rounded
   boxes with outline and band, the text. Prints the seconds that the frames took. */
#include "runs.h"

#include "pictures/picture.h"

#include <cairo.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double PI = 3.14159265358979323846, CORNER = 0.11, OUTLINE = 0.045, BAND = 0.13;

static void set_color(cairo_t *cairo, uint32_t rgb) {
    cairo_set_source_rgb(cairo, (rgb >> 16 & 255) / 255.0, (rgb >> 8 & 255) / 255.0, (rgb & 255) / 255.0);
}

static void draw_rects(cairo_t *cairo, const Drawing *drawing) {
    set_color(cairo, 0xF5F6F8);
    cairo_paint(cairo);
    for (size_t i = 0; i < drawing->rect_count; i++) {
        Rect r = drawing->rects[i].rect;
        set_color(cairo, drawing->rects[i].color);
        cairo_rectangle(cairo, r.left, r.top, r.right - r.left, r.bottom - r.top);
        cairo_fill(cairo);
    }
}

static void rounded_box(cairo_t *cairo, double width, double height, double radius) {
    double x = width / 2 - radius, y = height / 2 - radius;
    cairo_new_sub_path(cairo);
    cairo_arc(cairo, x, -y, radius, -PI / 2, 0);
    cairo_arc(cairo, x, y, radius, 0, PI / 2);
    cairo_arc(cairo, -x, y, radius, PI / 2, PI);
    cairo_arc(cairo, -x, -y, radius, PI, 3 * PI / 2);
    cairo_close_path(cairo);
}

static void draw_body(cairo_t *cairo, double width, double height, bool plain, const uint32_t colors[3]) {
    double side = fmin(width, height), outline = fmin(OUTLINE * side, 3);
    rounded_box(cairo, width - outline, height - outline, plain ? 0 : fmin(CORNER * side, 8));
    set_color(cairo, colors[0]);
    cairo_fill_preserve(cairo);
    set_color(cairo, colors[1]);
    cairo_set_line_width(cairo, outline);
    cairo_stroke(cairo);
    if (plain) return;
    set_color(cairo, colors[2]);
    cairo_rectangle(cairo, outline - width / 2, outline - height / 2, width - 2 * outline, BAND * side);
    cairo_fill(cairo);
}

static void draw_panel(cairo_t *cairo, const Picture *picture, int panel, int frame) {
    static const uint32_t ground[] = {0xD3D8DF, 0x5A6472, 0}, bomb[] = {0xA0200F, 0x4E0A03, 0xFFE9DF};
    static const uint32_t boxes[][3] = {{0x0072B2, 0x00395C, 0x4FA6D8}, {0xE69F00, 0x7A4F00, 0xFFD47A}};
    const Trajectory *run = picture->runs[panel];
    const Camera *camera = &picture->camera;
    Rect rect = picture->layout.panels[panel];
    cairo_save(cairo);
    cairo_rectangle(cairo, rect.left, rect.top, rect.right - rect.left, rect.bottom - rect.top);
    cairo_clip(cairo);
    for (int body = 0; body < run->bodies; body++) {
        if (!trajectory_has(run, frame, body)) continue;
        size_t i = (size_t)frame * (size_t)run->bodies + (size_t)body;
        cairo_save(cairo);
        cairo_translate(cairo, rect.left + camera->left + camera->scale * (double)run->position[i].x,
                        rect.top + camera->top - camera->scale * (double)run->position[i].y);
        cairo_rotate(cairo, -(double)run->angle[i]);
        draw_body(cairo, camera->scale * (double)run->size[body].x, camera->scale * (double)run->size[body].y,
                  run->fixed[body],
                  run->fixed[body]    ? ground
                  : body == run->bomb ? bomb
                                      : boxes[panel]);
        cairo_restore(cairo);
    }
    cairo_restore(cairo);
}

static void draw_text(cairo_t *cairo, double size, double x, double y, const char *text) {
    set_color(cairo, 0x1B2330);
    cairo_set_font_size(cairo, size);
    cairo_move_to(cairo, x, y);
    cairo_show_text(cairo, text);
}

/* Header, titles, and the metres along the axes. */
static void draw_texts(cairo_t *cairo, const Picture *picture, int frame) {
    const Layout *layout = &picture->layout;
    char text[160];
    draw_text(cairo, layout->scene.pixels, layout->left, layout->header_baseline, picture->runs[0]->scene);
    snprintf(text, sizeof text, "distance %.2f m   frame %d   t = %.3f s",
             picture_distance(picture, moment_stored(frame)), frame, frame * (double)picture->runs[0]->dt);
    draw_text(cairo, layout->status.pixels, layout->right - 24 * layout->status.pixels, layout->header_baseline, text);
    for (int i = 0; i < picture->count; i++) {
        Rect rect = layout->panels[i];
        draw_text(cairo, layout->title.pixels, rect.left, rect.top - layout->title_rise, picture->runs[i]->method);
        for (int tick = 0; tick < 16; tick++) {
            snprintf(text, sizeof text, "%d", tick - 8);
            draw_text(cairo, layout->axis.pixels, rect.left + tick * (rect.right - rect.left) / 16.0,
                      rect.bottom + layout->axis_drop, text);
        }
    }
}

int main(int argc, char **argv) {
    Job job = job_read(argc, argv);
    Picture picture;
    Error error = {0};
    const Trajectory *const panels[PANELS] = {job.runs[0], job.runs[1]};
    if (!picture_plan(&picture, panels, PANELS, job.width, job.height, &error)) return 3;
    Drawing drawing = {0};
    cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, job.width, job.height);
    cairo_t *cairo = cairo_create(surface);
    double start = clock_seconds();
    for (int frame = 0; frame < job.frames; frame++) {
        char path[512];
        drawing_clear(&drawing);
        picture_draw(&picture, moment_stored(frame), &drawing);
        draw_rects(cairo, &drawing);
        for (int i = 0; i < PANELS; i++) draw_panel(cairo, &picture, i, frame);
        draw_texts(cairo, &picture, frame);
        snprintf(path, sizeof path, "%s/cairo_%06d.png", job.directory, frame);
        if (cairo_surface_write_to_png(surface, path) != CAIRO_STATUS_SUCCESS) return 3;
    }
    printf("%.6f\n", clock_seconds() - start);
    cairo_destroy(cairo);
    cairo_surface_destroy(surface);
    drawing_free(&drawing);
    job_free(&job);
    return 0;
}

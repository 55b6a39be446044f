/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/file.h"
#include "sketch/sketch_formats.h"
#include "type/type.h"
#include "type/type_check.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const struct {
    const char *ending;
    char *(*write)(const Sketch *sketch, const SketchOutput *output, size_t *size, Error *error);
} formats[SKETCH_FORMATS] = {{".png", sketch_as_png}, {".svg", sketch_as_svg}, {".pdf", sketch_as_pdf}};

bool sketch_format(const char *path, SketchFormat *format, Error *error) {
    const char *ending = strrchr(path + file_folder_length(path), '.');
    for (int i = 0; ending != NULL && i < SKETCH_FORMATS; i++)
        if (strcmp(ending, formats[i].ending) == 0) {
            *format = (SketchFormat)i;
            return true;
        }
    if (strcmp(path, "-") == 0) {
        *format = SKETCH_SVG;
        return true;
    }
    return error_input(error, path, "the name of a figure must end in .png, .svg or .pdf");
}

bool sketch_check_pixels(double width, double height, double dpi, Error *error) {
    double columns = width / 25.4 * dpi, rows = height / 25.4 * dpi;
    return columns * rows <= SKETCH_MAX_PIXELS ||
           error_input(error, "figure",
                       "%.0f x %.0f mm at %g dots per inch are %.0f x %.0f pixels; at most %d are allowed", width,
                       height, dpi, columns, rows, SKETCH_MAX_PIXELS);
}

bool sketch_check_texts(const Sketch *sketch, const char *where, Error *error) {
    bool ok = type_check(sketch->title, where, error);
    for (size_t i = 0; ok && i < sketch->mark_count; i++)
        ok = sketch->marks[i].kind != MARK_TEXT || type_check(sketch->texts + sketch->marks[i].text, where, error);
    return ok;
}

bool sketch_write(const Sketch *sketch, const char *path, const SketchOutput *output, Error *error) {
    SketchFormat format = SKETCH_PNG;
    size_t size;
    if (!sketch_format(path, &format, error)) return false;
    if (sketch->failed) return error_memory(error, path);
    char *data = formats[format].write(sketch, output, &size, error);
    bool done = data != NULL && file_write(path, data, size, error);
    free(data);
    return done;
}

bool sketch_draw(const Sketch *sketch, const char *stem, SketchFormat last, Error *error) {
    const SketchOutput output = {.dpi = SKETCH_DPI};
    for (int i = SKETCH_PNG; i <= (int)last; i++) {
        char path[PATH_MAX];
        if (!file_path(path, sizeof path, error, "%s%s", stem, formats[i].ending)) return false;
        if (!sketch_write(sketch, path, &output, error)) return false;
    }
    return true;
}

FontFile sketch_font(const Sketch *sketch) {
    bool small = true;
    for (size_t i = 0; i < sketch->mark_count && small; i++)
        small = sketch->marks[i].kind != MARK_TEXT || font_file_suffices(sketch->texts + sketch->marks[i].text);
    return font_file(small);
}

size_t *sketch_order(const Sketch *sketch) {
    size_t *order = malloc((sketch->mark_count + 1) * sizeof *order), count = 0;
    for (int layer = 0; order != NULL && layer < SKETCH_LAYERS; layer++)
        for (size_t i = 0; i < sketch->mark_count; i++)
            if ((int)sketch->marks[i].layer == layer) order[count++] = i;
    return order;
}

int pen_dashes(const Pen *pen, double dashes[DASHES_MAX]) {
    if (pen->dashes == NULL) return 0;
    int count = sscanf(pen->dashes, "(%lf,%lf,%lf,%lf)", &dashes[0], &dashes[1], &dashes[2], &dashes[3]);
    for (int i = 0; i < count; i++) dashes[i] *= LINE_UNIT;
    return count > 0 ? count : 0;
}

TextPlace text_place(const Sketch *sketch, const SketchMark *mark) {
    static const double shares[] = {0, 0.5, 1};
    const double angle = mark->style.degrees * M_PI / 180, em = mark->style.points * MM_PER_POINT;
    const double back = shares[mark->style.align] * type_width(sketch->texts + mark->text, mark->style.points);
    const double down = TYPE_MIDDLE * em, c = cos(angle), s = sin(angle);
    return (TextPlace){{mark->at.x - back * c + down * s, mark->at.y - back * s - down * c}, c, s, em};
}

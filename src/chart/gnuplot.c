/* SPDX-License-Identifier: GPL-3.0-or-later */
/* gnuplot works in a temporary folder, so that neither its script nor the fonts' configuration contains a path. */
#include "chart/gnuplot.h"

#include "common/file.h"
#include "chart/gnuplot_folder.h"
#include "chart/pdf_title.h"
#include "common/memory_stream.h"
#include "common/process.h"
#include "sketch/sketch_formats.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { FORMATS = 3, DRAWING_MAX_SIZE = 64 << 20 };

static const char *const endings[FORMATS] = {"png", "svg", "pdf"};

static const double dots_per_mm = 300 / 25.4, pixels_per_mm = 96 / 25.4;

/* The PDF is last. */
static int format_count(const GnuplotDrawing *drawing) { return drawing->without_pdf ? FORMATS - 1 : FORMATS; }

/* Scale factors that make text, lines and points equally large in all formats: text is scaled for 96 dots per inch
   by pngcairo and pdfcairo and for 72 by svg; line widths and point sizes differ as well (measured on gnuplot 5.4). */
static void write_terminal(FILE *script, int format, const GnuplotDrawing *drawing) {
    double w = drawing->width, h = drawing->height;
    switch (format) {
    case 0:
        fprintf(script,
                "set terminal pngcairo size %.0f,%.0f font 'Inter,8' fontscale 3.125 linewidth 2 pointscale 2.8\n",
                w * dots_per_mm, h * dots_per_mm);
        break;
    case 1:
        fprintf(script, "set terminal svg size %.0f,%.0f dynamic font 'sans-serif,8' fontscale 1.333 linewidth 0.64\n",
                w * pixels_per_mm, h * pixels_per_mm);
        break;
    default:
        fprintf(
            script,
            "set terminal pdfcairo size %.2fcm,%.2fcm font 'Inter,8' fontscale 0.75 linewidth 0.96 pointscale 0.67\n",
            w / 10, h / 10);
        break;
    }
}

/* Each format starts with `reset`: settings of the script would persist. */
static char *whole_script(const GnuplotDrawing *drawing, size_t *size) {
    char *text = NULL;
    FILE *script = memory_stream(&text, size);
    if (script == NULL) return NULL;
    for (int format = 0; format < format_count(drawing); format++) {
        fprintf(script, "reset\nset encoding utf8\n");
        write_terminal(script, format, drawing);
        fprintf(script, "set output 'plot.%s'\n", endings[format]);
        fwrite(drawing->script, 1, drawing->script_size, script);
        fprintf(script, "unset output\n");
    }
    bool whole = !ferror(script);
    if (fclose(script) == 0 && whole) return text;
    free(text);
    return NULL;
}

static bool is_installed(Error *error) {
    Process process = {0};
    char text[256];
    Error cause = {0};
    if (process_start(&process, (const char *const[]){"gnuplot", "--version", NULL}, &cause))
        return process_finish(&process, text, sizeof text, error);
    if (process.missing)
        return error_system(error, "gnuplot", "cannot be run; install the Debian package gnuplot-nox to draw charts");
    *error = cause;
    return false;
}

/* A private fontconfig configuration, so that only the embedded font is found. */
static bool install_font(const char *folder, FontFile font, Error *error) {
    static const char configuration[] = "<fontconfig><dir prefix=\"cwd\">.</dir><cachedir>.</cachedir></fontconfig>\n";
    char path[PATH_MAX];
    return file_path(path, sizeof path, error, "%s/Inter.otf", folder) &&
           file_write_soon(path, font.bytes, font.size, error) &&
           file_path(path, sizeof path, error, "%s/fonts.conf", folder) &&
           file_write_soon(path, configuration, sizeof configuration - 1, error);
}

static bool run(const char *folder, const char *script, size_t size, Error *error) {
    char fonts[PATH_MAX], text[1024];
    if (!file_path(fonts, sizeof fonts, error, "FONTCONFIG_FILE=%s/fonts.conf", folder)) return false;
    Process process;
    /* -d: ignore the user's .gnuplot */
    const char *const argv[] = {"env", "-C", folder, fonts, "gnuplot", "-d", "-", NULL};
    if (!process_start(&process, argv, error)) return false;
    process.name = "gnuplot";
    process_write(&process, script, size);
    return process_finish(&process, text, sizeof text, error);
}

static bool is_unknown_svg(Error *error) {
    return error_system(error, "gnuplot", "produced an SVG file of an unknown form");
}

/* Closes a text that replaces *svg. */
static bool exchange(char **svg, FILE *out, char **text, Error *error) {
    const bool whole = !ferror(out);
    if (fclose(out) != 0 || !whole) {
        free(*text);
        return error_memory(error, "SVG file");
    }
    free(*svg);
    *svg = *text;
    return true;
}

/* Inserts the overlay before the SVG's end tag. */
static bool insert_overlay(char **svg, size_t *size, const char *overlay, Error *error) {
    static const char end[] = "</svg>";
    char *last = NULL, *text = NULL;
    for (char *at = *svg; (at = strstr(at, end)) != NULL; at++) last = at;
    if (last == NULL) return is_unknown_svg(error);
    FILE *out = memory_stream(&text, size);
    if (out == NULL) return error_memory(error, "SVG file");
    fprintf(out, "%.*s<g transform=\"scale(%.6f)\">\n%s</g>\n%s", (int)(last - *svg), *svg, pixels_per_mm, overlay,
            last);
    return exchange(svg, out, &text, error);
}

static void put_replaced(FILE *out, const char *text, const char *from, const char *to) {
    for (const char *found; (found = strstr(text, from)) != NULL; text = found + strlen(from))
        fprintf(out, "%.*s%s", (int)(found - text), text, to);
    fputs(text, out);
}

/* Its title, and the fonts of other figures: gnuplot names only one. */
static bool dress_svg(char **svg, size_t *size, const char *title, FontFile font, Error *error) {
    static const char no_title[] = "<title>Gnuplot</title>";
    char *head = strstr(*svg, no_title), *text = NULL;
    if (head == NULL) return is_unknown_svg(error);
    FILE *out = memory_stream(&text, size);
    if (out == NULL) return error_memory(error, "SVG file");
    fprintf(out, "%.*s<title>%s</title>\n", (int)(head - *svg), *svg, title);
    svg_write_font(out, font);
    put_replaced(out, head + strlen(no_title), "font-family=\"sans-serif\"", "font-family=\"" SVG_FONTS "\"");
    return exchange(svg, out, &text, error);
}

static bool dress(const GnuplotDrawing *drawing, FontFile font, char **data, size_t *size, Error *error) {
    return dress_svg(&data[1], &size[1], drawing->title, font, error) &&
           (drawing->without_pdf || pdf_set_title(&data[2], &size[2], drawing->title, error)) &&
           (drawing->overlay == NULL || insert_overlay(&data[1], &size[1], drawing->overlay, error));
}

/* A drawing as gnuplot left it. */
static char *read_drawing(const char *path, const char *ending, size_t *size, Error *error) {
    Error cause = {0};
    char *data = file_read(path, DRAWING_MAX_SIZE, size, &cause);
    if (data != NULL && *size > 0) return data;
    free(data);
    if (cause.kind == ERROR_SYSTEM)
        *error = cause;
    else
        error_system(error, "gnuplot", "produced no %s file", ending);
    return NULL;
}

static bool collect(const char *folder, const GnuplotDrawing *drawing, FontFile font, const char *stem, Error *error) {
    const int formats = format_count(drawing);
    char *data[FORMATS] = {NULL}, path[PATH_MAX];
    size_t size[FORMATS];
    bool done = true;
    for (int i = 0; done && i < formats; i++) {
        done = file_path(path, sizeof path, error, "%s/plot.%s", folder, endings[i]);
        data[i] = done ? read_drawing(path, endings[i], &size[i], error) : NULL;
        done = data[i] != NULL;
    }
    done = done && dress(drawing, font, data, size, error);
    for (int i = 0; done && i < formats; i++) {
        done =
            file_path(path, sizeof path, error, "%s.%s", stem, endings[i]) && file_write(path, data[i], size[i], error);
    }
    for (int i = 0; i < formats; i++) free(data[i]);
    return done;
}

static bool draw_in(const char *folder, const GnuplotDrawing *drawing, const char *stem, Error *error) {
    size_t size;
    char *script = whole_script(drawing, &size);
    if (script == NULL) return error_memory(error, stem);
    const FontFile font = font_file(font_file_suffices(script));
    bool done = install_font(folder, font, error) && run(folder, script, size, error) &&
                collect(folder, drawing, font, stem, error);
    free(script);
    return done;
}

bool gnuplot_draw(const GnuplotDrawing *drawing, const char *stem, Error *error) {
    GnuplotFolder folder;
    if (!is_installed(error) || !gnuplot_folder_make(&folder, error)) return false;
    const bool done = draw_in(folder.path, drawing, stem, error);
    return gnuplot_folder_remove(&folder, error) && done;
}

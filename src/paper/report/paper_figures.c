/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The figures of the study's folder: pictures that somebody drew, and their captions. */
#include "paper/report/paper_files.h"

#include "common/file.h"
#include "common/utf8.h"
#include "image/image.h"

#include <stdio.h>
#include <string.h>

enum { MAX_PICTURE_SIZE = 1 << 24, MAX_CAPTION_SIZE = 2048 };

static const struct {
    const char *name, *alt;
} specs[PAPER_FIGURES] = {
    [FIGURE_LOOP] = {"loop", "The stages of one step of the engine"},
    [FIGURE_NARROW_PHASE] = {"narrow-phase", "Two touching boxes and their axis of least penetration"},
    [FIGURE_DATA] = {"data", "How training data are recorded from the engine"},
    [FIGURE_SCENES] = {"scenes", "The three scenes: a single box, a stack of ten, a pyramid of 66"},
    [FIGURE_LOSS] = {"loss", "Mean squared error over training, beside the paper's and the constant predictor's"},
    [FIGURE_FACTORS] = {"factors", "Error of each network over that of the constant predictor"},
    [FIGURE_RATES] = {"rates", "Share of right predictions by three definitions, at impacts and at rest"},
    [FIGURE_CLOSED_LOOP] = {"closed-loop", "Frames until a run with a network leaves the engine's, and its cost"},
    [FIGURE_LAWS] = {"laws", "Error and violations over the weight of physical laws in the loss"},
    [FIGURE_TRANSFER] = {"transfer", "Error over the number of launches, from scratch and after smaller scenes"},
};

/* Length of the UTF-8 character that text begins with; 0 where it is none, or a control character. */
static size_t character_length(const char *text, size_t size) {
    uint32_t character;
    size_t length = utf8_decode(text, size, &character);
    return length > 0 && character >= 0x20 && character != 0x7f ? length : 0;
}

static bool check_caption(char *caption, size_t size, const char *path, Error *error) {
    if (size > 0 && caption[size - 1] == '\n') caption[--size] = '\0';
    if (size == 0) return error_input(error, path, "an empty caption");
    for (size_t at = 0, length; at < size; at += length) {
        length = character_length(caption + at, size - at);
        if (length == 0) return error_input(error, path, "byte %zu is no text: a caption is one line of UTF-8", at + 1);
    }
    return true;
}

/* Whole and sound, or it would be a hole in the page. */
static bool check_picture(DocumentFigure *figure, const char *path, Error *error) {
    Image *image = image_read_png(path, error);
    if (image == NULL) return false;
    figure->width = image->width;
    figure->height = image->height;
    image_destroy(image);
    return true;
}

static bool read_figure(PaperFiles *files, int i, const char *folder, Error *error) {
    DocumentFigure *figure = &files->figures[i];
    snprintf(files->figure_paths[i], sizeof files->figure_paths[i], "figures/%s.png", specs[i].name);
    char path[PAPER_PATH_SIZE];
    if (!file_path(path, sizeof path, error, "%s/figures/%s.png", folder, specs[i].name)) return false;
    files->pictures[i] = file_read(path, MAX_PICTURE_SIZE, &figure->png_size, error);
    if (files->pictures[i] == NULL || !check_picture(figure, path, error)) return false;
    memcpy(path + strlen(path) - 3, "txt", 3);
    size_t size;
    files->captions[i] = file_read(path, MAX_CAPTION_SIZE, &size, error);
    if (files->captions[i] == NULL || !check_caption(files->captions[i], size, path, error)) return false;
    figure->path = files->figure_paths[i];
    figure->alt = specs[i].alt;
    figure->caption = files->captions[i];
    figure->png = files->pictures[i];
    return true;
}

bool paper_figures_read(PaperFiles *files, const char *folder, Error *error) {
    for (int i = 0; i < PAPER_FIGURES; i++)
        if (!read_figure(files, i, folder, error)) return false;
    return true;
}

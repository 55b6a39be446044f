/* SPDX-License-Identifier: GPL-3.0-or-later */
/* All tables are read before the first figure is drawn. */
#include "figure/result_figures.h"

#include "common/file.h"
#include "figure/figures.h"
#include "figure/gnuplot.h"

#include <limits.h>
#include <stdlib.h>

const char *const figure_targets[] = {"pair", "net", "impulse", "points", NULL};
const char *const figure_scene_names[] = {"single", "stack", "pyramid", "pyramid_settled", NULL};

static const struct {
    const char *name;
    bool (*write)(const char *folder, FigurePage *page, Error *error);
} figures[] = {
    {"loss", figure_loss}, {"factors", figure_factors},   {"rates", figure_rates}, {"closed-loop", figure_closed_loop},
    {"laws", figure_laws}, {"transfer", figure_transfer},
};

enum { FIGURES = sizeof figures / sizeof *figures };

typedef struct Written {
    double width, height; /* mm; 0: left out */
    char *script, *caption;
    size_t script_size, caption_size;
} Written;

static bool write_page(int i, const char *folder, Written *written, Error *error) {
    FigurePage page = {.script = open_memstream(&written->script, &written->script_size),
                       .caption = open_memstream(&written->caption, &written->caption_size)};
    bool room = page.script != NULL && page.caption != NULL;
    bool done = room && figures[i].write(folder, &page, error);
    if (room) page.no_memory |= ferror(page.script) || ferror(page.caption);
    if (page.script != NULL) page.no_memory |= fclose(page.script) != 0;
    if (page.caption != NULL) page.no_memory |= fclose(page.caption) != 0;
    written->width = page.width;
    written->height = page.height;
    return room && !page.no_memory ? done : error_memory(error, folder);
}

static bool draw_page(int i, const char *folder, const Written *written, Error *error) {
    char stem[PATH_MAX], caption[PATH_MAX + 4];
    int length = snprintf(stem, sizeof stem, "%s/figures/%s", folder, figures[i].name);
    if (length < 0 || length >= (int)sizeof stem) return error_input(error, folder, "this path is too long");
    snprintf(caption, sizeof caption, "%s.txt", stem);
    const GnuplotDrawing drawing = {written->width, written->height, written->script, written->script_size,
                                    .without_pdf = true};
    return gnuplot_draw(&drawing, stem, error) && file_write(caption, written->caption, written->caption_size, error);
}

static bool make_folder(const char *folder, Error *error) {
    char path[PATH_MAX];
    int length = snprintf(path, sizeof path, "%s/figures", folder);
    return length > 0 && length < (int)sizeof path ? file_make_directory(path, error)
                                                   : error_input(error, folder, "this path is too long");
}

bool result_figures_draw(const char *folder, Error *error) {
    Written written[FIGURES] = {0};
    bool done = true;
    for (int i = 0; done && i < FIGURES; i++) done = write_page(i, folder, &written[i], error);
    done = done && make_folder(folder, error);
    for (int i = 0; done && i < FIGURES; i++)
        if (written[i].width > 0) done = draw_page(i, folder, &written[i], error);
    for (int i = 0; i < FIGURES; i++) {
        free(written[i].script);
        free(written[i].caption);
    }
    return done;
}

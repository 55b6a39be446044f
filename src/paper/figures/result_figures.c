/* SPDX-License-Identifier: GPL-3.0-or-later */
/* All tables are read before the first figure is drawn. */
#include "paper/figures/result_figures.h"

#include "chart/gnuplot_sheet.h"
#include "common/file.h"
#include "paper/figures/figures.h"

#include <limits.h>

static const struct {
    const char *name;
    bool (*write)(const char *folder, GnuplotPage *page, Error *error);
} figures[] = {
    {"loss", figure_loss}, {"factors", figure_factors},   {"rates", figure_rates}, {"closed-loop", figure_closed_loop},
    {"laws", figure_laws}, {"transfer", figure_transfer},
};

enum { FIGURES = sizeof figures / sizeof *figures };

static bool write_page(int i, const char *folder, GnuplotSheet *sheet, Error *error) {
    bool done = gnuplot_sheet_open(sheet, folder, error) && figures[i].write(folder, &sheet->page, error);
    return done && gnuplot_sheet_close(sheet, folder, error);
}

bool result_figures_draw(const char *folder, Error *error) {
    GnuplotSheet sheets[FIGURES] = {0};
    char path[PATH_MAX];
    if (!file_path(path, sizeof path, error, "%s/figures", folder)) return false;
    bool done = true;
    for (int i = 0; done && i < FIGURES; i++) done = write_page(i, folder, &sheets[i], error);
    done = done && file_make_directory(path, error);
    for (int i = 0; done && i < FIGURES; i++) done = gnuplot_sheet_draw(&sheets[i], path, "", figures[i].name, error);
    for (int i = 0; i < FIGURES; i++) gnuplot_sheet_free(&sheets[i]);
    return done;
}

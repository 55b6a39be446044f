/* SPDX-License-Identifier: GPL-3.0-or-later */
/* All tables are read before the first plot is drawn. */
#include "paper/figures/plots.h"

#include "chart/gnuplot_sheet.h"
#include "common/file.h"
#include "paper/figures/plot_parts.h"

#include <limits.h>

static const struct {
    const char *name;
    bool (*write)(const char *folder, GnuplotPage *page, Error *error);
} plots[] = {
    {"loss", plot_loss}, {"factors", plot_factors},   {"rates", plot_rates}, {"closed-loop", plot_closed_loop},
    {"laws", plot_laws}, {"transfer", plot_transfer},
};

enum { PLOTS = sizeof plots / sizeof *plots };

static bool write_page(int i, const char *folder, GnuplotSheet *sheet, Error *error) {
    bool done = gnuplot_sheet_open(sheet, folder, error) && plots[i].write(folder, &sheet->page, error);
    return done && gnuplot_sheet_close(sheet, folder, error);
}

bool plots_draw(const char *folder, const Progress *progress, Error *error) {
    GnuplotSheet sheets[PLOTS] = {0};
    char path[PATH_MAX];
    if (!file_path(path, sizeof path, error, "%s/figures", folder)) return false;
    bool done = true;
    for (int i = 0; done && i < PLOTS; i++) done = write_page(i, folder, &sheets[i], error);
    done = done && file_make_directory(path, error);
    for (int i = 0; done && i < PLOTS; i++) {
        done =
            progress_report(progress, i, PLOTS) || error_interrupted(error, path, "stopped; the tables are finished");
        done = done && gnuplot_sheet_draw(&sheets[i], path, "", plots[i].name, error);
    }
    for (int i = 0; i < PLOTS; i++) gnuplot_sheet_free(&sheets[i]);
    return done;
}

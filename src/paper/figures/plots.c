/* SPDX-License-Identifier: GPL-3.0-or-later */
/* All tables are read before the first plot is drawn. */
#include "paper/figures/plots.h"

#include "common/file.h"
#include "paper/figures/plot_parts.h"
#include "paper/systems/system.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

typedef struct Plot {
    const char *name;
    bool (*write)(const char *folder, PlotPage *page, Error *error);
    PlotPage page;
} Plot;

static const Plot results[] = {
    {.name = "loss", .write = plot_loss},   {.name = "factors", .write = plot_factors},
    {.name = "rates", .write = plot_rates}, {.name = "closed-loop", .write = plot_closed_loop},
    {.name = "laws", .write = plot_laws},   {.name = "transfer", .write = plot_transfer},
};

enum { RESULTS = sizeof results / sizeof *results, NAME_SIZE = 64 };

/* The plots in progress: of the results, then of the systems. */
typedef struct Plots {
    int count;
    Plot *items;              /* [count] */
    char (*names)[NAME_SIZE]; /* [count] of the systems' */
} Plots;

static bool plots_begin(Plots *plots, Error *error) {
    int systems = 0;
    while (paper_systems[systems] != NULL) systems++;
    plots->items = calloc(RESULTS + (size_t)systems, sizeof *plots->items);
    plots->names = calloc(RESULTS + (size_t)systems, sizeof *plots->names);
    if (plots->items == NULL || plots->names == NULL) return error_memory(error, "figures");
    plots->count = RESULTS + systems;
    memcpy(plots->items, results, sizeof results);
    for (int i = 0; i < systems; i++) {
        char *name = plots->names[i];
        snprintf(name, NAME_SIZE, "system-%s", paper_systems[i]->name);
        plots->items[RESULTS + i] = (Plot){.name = name, .write = paper_systems[i]->plot};
    }
    return true;
}

static void plots_end(Plots *plots) {
    for (int i = 0; i < plots->count; i++) plot_page_free(&plots->items[i].page);
    free(plots->items);
    free(plots->names);
}

bool plots_draw(const char *folder, const Progress *progress, Error *error) {
    Plots plots = {0};
    char path[PATH_MAX];
    bool done = file_path(path, sizeof path, error, "%s/figures", folder) && plots_begin(&plots, error);
    for (int i = 0; done && i < plots.count; i++) done = plots.items[i].write(folder, &plots.items[i].page, error);
    done = done && file_make_directory(path, error);
    for (int i = 0; done && i < plots.count; i++) {
        Plot *plot = &plots.items[i];
        done = progress_report(progress, i, plots.count) ||
               error_interrupted(error, path, "stopped; the tables are finished");
        done = done && plot_page_write(&plot->page, path, "", plot->name, error);
    }
    plots_end(&plots);
    return done;
}

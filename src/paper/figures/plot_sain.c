/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Two panels: the error of sain and its ablations over the number of launches of the stack, on the stack and on the
   settled pyramid. */
#include "chart/gnuplot_axis.h"
#include "paper/figures/plot_parts.h"
#include "paper/systems/sain_study.h"

#include <math.h>

enum { BASELINES = 2, LOOKS = RELATION_FORMS + BASELINES };

/* mm */
static const double width = 174, height = 68, left = 14, gap = 14, right = 2, bottom = 22, top = 7, legend_left = 6,
                    legend_top = 8;

static const char *const titles[SAIN_SCENES] = {"stack, held-out launches", "settled pyramid, never trained on"};

static void gather_looks(GnuplotLook looks[LOOKS]) {
    static const char *const names[RELATION_FORMS] = {"sain", "engine=off: network alone", "engine=shuffled"};
    for (int form = 0; form < RELATION_FORMS; form++) looks[form] = gnuplot_look(form, names[form]);
    looks[RELATION_FORMS] = gnuplot_look_dashed("engine alone, 10 sweeps");
    looks[RELATION_FORMS + 1] = gnuplot_look_thin(gnuplot_look(RELATION_FORMS, "mean correction"));
}

static void draw_series(GnuplotPage *page, const CsvTable *table, SainScene scene, RelationForm form, SainNumber *of,
                        const GnuplotLook *look) {
    gnuplot_series_begin(page);
    for (int launches = 1; launches <= SAIN_MAX_LAUNCHES; launches *= 2)
        gnuplot_point(page, launches, sain_median(table, scene, form, launches, of));
    gnuplot_series_end(page, look);
}

static void draw_axes(GnuplotPage *page, const CsvTable *table, SainScene scene) {
    const char *separator = "";
    double most = 1e-6;
    for (int launches = 1; launches <= SAIN_MAX_LAUNCHES; launches *= 2)
        for (RelationForm form = 0; form < RELATION_FORMS; form++) {
            most =
                fmax(most, sain_median(table, scene, form, launches, sain_error)); /* of a number and NAN, the number */
            if (form == RELATION_ENGINE)
                most = fmax(most, fmax(sain_median(table, scene, form, launches, sain_engine_error),
                                       sain_median(table, scene, form, launches, sain_constant_error)));
        }
    fprintf(page->script, "set logscale x 2\nset xrange [0.8:%g]\nset xtics scale 0.6,0.35 (",
            1.25 * sain_most_launches(table));
    for (int launches = 1; launches <= SAIN_MAX_LAUNCHES; launches *= 2, separator = ", ")
        fprintf(page->script, "%s'%d' %d", separator, launches, launches);
    fprintf(page->script, ")\n");
    gnuplot_axis_label(page, 'x', "Launches of the stack");
    gnuplot_linear_axis(page, 'y', 0, most * 1.08, NULL, scene == SAIN_STACK ? "RMS velocity error (m/s)" : NULL);
}

static void draw_panel(GnuplotPage *page, const CsvTable *table, SainScene scene, const GnuplotLook looks[LOOKS]) {
    const double wide = (page->width - left - gap - right) / SAIN_SCENES;
    gnuplot_panel_begin(page, (GnuplotBox){left + (int)scene * (wide + gap), bottom, wide, height - bottom - top},
                        titles[scene]);
    draw_axes(page, table, scene);
    draw_series(page, table, scene, RELATION_ENGINE, sain_engine_error, &looks[RELATION_FORMS]);
    draw_series(page, table, scene, RELATION_ENGINE, sain_constant_error, &looks[RELATION_FORMS + 1]);
    for (RelationForm form = RELATION_FORMS; form-- > 0;)
        draw_series(page, table, scene, form, sain_error, &looks[form]);
    gnuplot_panel_end(page);
}

bool plot_sain(const char *folder, GnuplotPage *page, Error *error) {
    CsvTable table;
    GnuplotLook looks[LOOKS];
    if (!csv_table_read_from(&table, folder, &sain_layout, error)) return false;
    gather_looks(looks);
    gnuplot_page_begin(page, width, height);
    for (SainScene scene = 0; scene < SAIN_SCENES; scene++) draw_panel(page, &table, scene, looks);
    gnuplot_legend(page, looks, LOOKS, 3, legend_left, legend_top);
    fprintf(page->caption,
            "Velocity error at the impacts of held-out launches, over the number of launches of the stack that sain "
            "and its "
            "ablations were trained on: left on the stack, right on the settled pyramid, which none of them has seen. "
            "Medians over seeds.");
    gnuplot_page_end(page);
    csv_table_free(&table);
    return true;
}

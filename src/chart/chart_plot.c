/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "chart/chart_plot.h"

#include "chart/chart_script.h"
#include "chart/gnuplot.h"
#include "common/file.h"
#include "common/memory_stream.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

static bool draw(const Chart *chart, const char *scene, const char *stem, Error *error) {
    char name[CHART_TEXT_SIZE], title[2 * CHART_TEXT_SIZE], file_title[3 * CHART_TEXT_SIZE];
    chart_plain(name, scene);
    snprintf(title, sizeof title, "%s, %d launches", name, chart->launches);
    snprintf(file_title, sizeof file_title, "Speed and accuracy: %s", title);
    char *text = NULL;
    size_t size = 0;
    FILE *script = memory_stream(&text, &size);
    if (script == NULL) return error_memory(error, stem);
    bool whole = chart_script(chart, title, script) && !ferror(script);
    whole = fclose(script) == 0 && whole;
    const GnuplotDrawing drawing = {
        .width = CHART_WIDTH, .height = CHART_HEIGHT, .script = text, .script_size = size, .title = file_title};
    bool drawn = whole ? gnuplot_draw(&drawing, stem, error) : error_memory(error, stem);
    free(text);
    return drawn;
}

/* A table from another source must not make us write outside the folder. */
static bool check_name(const char *csv_path, const char *scene, Error *error) {
    return (scene[0] != '\0' && strchr(scene, '/') == NULL) ||
           error_input(error, csv_path, "'%s' is not a valid scene name", scene);
}

bool chart_plot(const char *csv_path, const char *scene, const char *folder, Error *error) {
    char stem[PATH_MAX];
    if (!check_name(csv_path, scene, error)) return false;
    if (!file_path(stem, sizeof stem, error, "%s/chart-%s", folder, scene)) return false;
    ChartTable table;
    if (!chart_csv_read(&table, csv_path, error)) return false;
    Chart chart;
    bool drawn = chart_gather(&chart, &table, scene, csv_path, error);
    if (drawn) {
        drawn = draw(&chart, scene, stem, error);
        chart_free(&chart);
    }
    chart_csv_free(&table);
    return drawn;
}

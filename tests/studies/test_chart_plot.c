/* SPDX-License-Identifier: GPL-3.0-or-later */
/* chart.csv: invented numbers, modelled on measured ones; twelve methods. */
#include "charts.h"
#include "files.h"
#include "python.h"

#include "studies/chart.h"
#include "studies/first_line.h"

#include "studies/chart_internal.h"
#include "methods/methods.h"

#include <math.h>

#define SAMPLE SOURCE_DIR "/tests/studies/chart.csv"

static const char *drawn_file(const char *scene, const char *ending) {
    char name[128];
    snprintf(name, sizeof name, "chart-%s.%s", scene, ending);
    return temporary_path(name);
}

static const char *folder(void) {
    temporary_path(""); /* makes it */
    return temporary_folder;
}

static char *read_drawn(const char *scene, const char *ending, size_t *size) {
    return read_whole(drawn_file(scene, ending), size);
}

TEST(three_files_are_drawn) {
    assert_ok(chart_plot(SAMPLE, "pyramid_settled", folder(), &error), error);
    size_t size;
    char *png = read_drawn("pyramid_settled", "png", &size);
    /* 174 mm at 300 dots per inch: 2055; and 115 mm, which the words below need: 1357. */
    assert_memory_equal(png, "\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\x08\x07\0\0\x05\x4d", 24);
    assert_true(size > 50000);
    free(png);
    char *pdf = read_drawn("pyramid_settled", "pdf", &size);
    assert_memory_equal(pdf, "%PDF-", 5);
    assert_true(size > 5000);
    free(pdf);
    expect_first_line("pdfinfo", drawn_file("pyramid_settled", "pdf"),
                      "Title:           Speed and accuracy: pyramid_settled, 40 launches");
    run_python(
        "import sys, xml.etree.ElementTree as tree\n"
        "root = tree.parse(sys.argv[1]).getroot()\n"
        "assert root.tag == '{http://www.w3.org/2000/svg}svg', root.tag\n"
        "assert root[0].text == 'Speed and accuracy: pyramid_settled, 40 launches', root[0].text\n"
        "assert 'font/otf' in root[1].text and 'Arial' in root.get('font-family')\n"
        "texts = ' | '.join(t for e in root.iter('{http://www.w3.org/2000/svg}text') for t in e.itertext())\n"
        "for wanted in ('Impact frames', 'The 60 frames after', 'engine as shipped', 'engine:warm=off',\n"
        "               'momentum-schedule', 'playback', 'pair-net', 'Pareto front of solvers', 'k=100', 'm/s',\n"
        "               'pyramid_settled, 40 launches', 'Beyond the axes: reference (2232 to 2400 µs, below 0.0001 "
        "m/s)'):\n"
        "    assert wanted in texts, (wanted, texts)\n",
        drawn_file("pyramid_settled", "svg"));
}

TEST(the_same_table_gives_the_same_files) {
    static const char *const endings[] = {"png", "svg", "pdf"};
    size_t size[2][3];
    char *data[2][3];
    for (int run = 0; run < 2; run++) {
        assert_ok(chart_plot(SAMPLE, "pyramid_settled", folder(), &error), error);
        for (int i = 0; i < 3; i++) data[run][i] = read_drawn("pyramid_settled", endings[i], &size[run][i]);
    }
    for (int i = 0; i < 3; i++) {
        assert_int_equal(size[0][i], size[1][i]);
        assert_memory_equal(data[0][i], data[1][i], size[0][i]);
        free(data[0][i]);
        free(data[1][i]);
    }
}

#define HEADER                                                                                               \
    "scene,method,setting,protocol,phase,launches,us_solver,us_solver_q1,us_solver_q3,us_step,instructions," \
    "error_mean,error_median,error_p95,error_worst,share_right,penetration_max,drift,energy,moved\n"

static const char *write_rows(const char *lines) {
    Error error = {0};
    char text[20000];
    int length = snprintf(text, sizeof text, "%s%s", HEADER, lines);
    const char *path = temporary_path("rows.csv");
    assert_ok(file_write(path, text, (size_t)length, &error), error);
    return path;
}

static void expect_refused(const char *lines, const char *scene, const char *message) {
    Error error = {0};
    assert_refused(chart_plot(write_rows(lines), scene, folder(), &error), message);
    assert_int_equal(access(drawn_file("single", "png"), F_OK), -1);
}

TEST(tables_without_a_mark_are_refused) {
    static const char none[] = "rows.csv: error: no row of the scene 'single' in closed loop has a time and an error";
    expect_refused("stack,engine,k=10,closed,impact,40,5,4,6,,,1,,,,,,,,\n", "single", none);
    expect_refused("single,engine,k=10,frozen,impact,40,5,4,6,,,1,,,,,,,,\n"
                   "single,engine,k=10,closed,rest,40,5,4,6,,,1,,,,,,,,\n"
                   "single,engine,k=30,closed,impact,40,5,4,6,,,,,,,,,,,\n"
                   "single,engine,k=40,closed,impact,40,,,,,,1,,,,,,,,\n"
                   "single,engine,k=50,closed,impact,40,0,0,0,,,1,,,,,,,,\n",
                   "single", none);
    expect_refused("single,engine,k=10,closed,impact,40,5,4,6,,,-1,,,,,,,,\n", "single",
                   "error_mean: '-1' is less than 0");
    expect_refused("../x,engine,k=10,closed,impact,40,5,4,6,,,1,,,,,,,,\n", "../x", "is not a valid scene name");
    char many[8000] = "";
    for (int i = 0; i <= CHART_MAX_LINES; i++)
        snprintf(many + strlen(many), 200, "single,m%d,,closed,impact,40,5,4,6,,,1,,,,,,,,\n", i);
    expect_refused(many, "single", "at most 32 methods");
}

TEST(one_mark_and_one_panel_are_enough) {
    assert_ok(
        chart_plot(write_rows("stack,engine,k=10,closed,after,40,5,5,5,,,1,,,,,,,,\n"), "stack", folder(), &error),
        error);
    assert_int_equal(access(drawn_file("stack", "png"), F_OK), 0);
}

TEST(times_that_vary_are_noted) {
    size_t size;
    const char *path = temporary_path("chart.csv");
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    fputs(CHART_HEADER ",cpu,us_engine,us_varies\n"
                       "stack,engine,k=10,closed,impact,40,5,5,5,,,1,,,,,,,,,AMD,,0\n"
                       "stack,engine,k=20,closed,impact,40,9,5,9,,,1,,,,,,,,,AMD,,1\n",
          file);
    assert_int_equal(fclose(file), 0);
    assert_ok(chart_plot(path, "stack", folder(), &error), error);
    char *noted = read_drawn("stack", "svg", &size);
    assert_non_null(
        strstr(noted, "Times measured on AMD. 1 of 2 vary more than the others, also when measured again."));
    assert_non_null(strstr(noted, "Times here that vary: engine (1)."));
    free(noted);
}

/* A note names the methods whose errors have another target. Without such methods the chart has no note. */
TEST(a_target_without_push_out_is_noted) {
    static const char rows[] = "stack,engine,k=10,closed,impact,40,5,5,5,,,1,,,,,,,,\n"
                               "stack,soft-step,substeps=4,closed,impact,40,5,5,5,,,1,,,,,,,,\n"
                               "stack,avbd,k=10,closed,impact,40,5,5,5,,,1,,,,,,,,\n";
    const char *const end = strchr(rows, '\n') + 1;
    char engine[200];
    snprintf(engine, sizeof engine, "%.*s", (int)(end - rows), rows);
    size_t size;
    assert_ok(chart_plot(write_rows(rows), "stack", folder(), &error), error);
    char *noted = read_drawn("stack", "svg", &size);
    assert_non_null(strstr(noted, "soft-step, avbd: error against the solution without the velocity that pushes"));
    assert_ok(chart_plot(write_rows(engine), "stack", folder(), &error), error);
    char *silent = read_drawn("stack", "svg", &size);
    assert_null(strstr(silent, "error against"));
    free(noted);
    free(silent);
}

/* The maximum number of methods, with the longest names and settings. */
TEST(a_full_chart_is_drawn) {
    char lines[20000] = "";
    for (int i = 0; i < CHART_MAX_LINES * 5; i++)
        snprintf(lines + strlen(lines), 200,
                 "full,method-with-quite-a-long-name-to-be-cut-%d,k=%d,closed,impact,9,%d,%d,%d,,,%g,,,,,,,,\n",
                 i % CHART_MAX_LINES, i, 9 + i, 8 + i, 11 + i, 1.0 / (1 + i));
    assert_ok(chart_plot(write_rows(lines), "full", folder(), &error), error);
}

/* A table may have any texts: what is drawn of them is text. */
TEST(names_stay_texts) {
    static const char *const names[] = {"'; x='",         "</text><script>", "&amp;",
                                        "`touch victim`", "\xc3\x28'\\",     "%s %d %n"};
    char *lines = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&lines, &size);
    assert_non_null(file);
    for (int i = 0; i < (int)(sizeof names / sizeof *names); i++)
        for (int k = 1; k <= 2; k++) {
            fprintf(file, "hostile,\"%s\",\"k=%d,%s\",closed,impact,40,%d,%d,%d,,,%d,,,,,,,,\n", names[i], k, names[i],
                    5 * k, 4 * k, 6 * k, i + 1);
            fprintf(file, "hostile,\"%s\",\"k=%d,%s\",closed,after,40,1,1,1,,,0,,,,,,,,\n", names[i], k, names[i]);
        }
    fclose(file);
    const char *path = write_rows(lines);
    free(lines);
    assert_ok(chart_plot(path, "hostile", folder(), &error), error);
    run_python("import sys, xml.etree.ElementTree as tree\n"
               "root = tree.parse(sys.argv[1]).getroot()\n"
               "kinds = {e.tag.split('}')[1] for e in root.iter()}\n"
               "assert kinds == {'svg', 'title', 'style', 'rect', 'path', 'text'}, kinds\n"
               "assert any('s ?d ?n' in (e.text or '') for e in root.iter()), 'no name'\n",
               drawn_file("hostile", "svg"));
}

TEST(texts_become_plain) {
    char plain[CHART_TEXT_SIZE];
    chart_plain(plain, "engine, warm=off (k=10)");
    assert_string_equal(plain, "engine, warm=off (k=10)");
    /* Characters that names do not have. */
    chart_plain(plain, "'\"`\\@$#;!|&<>{}^~%\n\x7f\xc3\xff?");
    assert_string_equal(plain, "???????????????????????");
    /* Letters of the font are kept, a letter with its mark too; others, controls and lone marks are not. */
    chart_plain(plain, "\xc3\xa4 a\xcc\x88 \xe6\x97\xa5 \xc2\x85 q\xcc\x88");
    assert_string_equal(plain, "\xc3\xa4 a\xcc\x88 ? ? q?");
    chart_plain(plain, "01234567890123456789012345678901234\xc3\xa4"
                       "6789"); /* not cut within a letter */
    assert_string_equal(plain, "01234567890123456789012345678901234...");
    chart_plain(plain, "0123456789012345678901234567890123456789");
    assert_string_equal(plain, "012345678901234567890123456789012345...");
}

/* The chart of the stack; its marks name texts of the table. */
static Chart gather(CsvTable *table, const char *lines) {
    Error error = {0};
    Chart chart;
    const char *path = write_rows(lines);
    assert_ok(csv_table_read(table, path, &chart_layout, &error), error);
    assert_ok(chart_gather(&chart, table, "stack", path, &error), error);
    return chart;
}

static void free_chart(Chart *chart, CsvTable *table) {
    chart_free(chart);
    csv_table_free(table);
}

TEST(marks_are_gathered_by_line_and_time) {
    CsvTable table;
    Chart chart = gather(&table, "single,engine,k=5,closed,impact,9,2,2,2,,,3,,,,,,,,\n"
                                 "stack,momentum,\"warm=off,k=7,b=0.5\",closed,impact,40,4,3,6,,,2,,,,,,,,\n"
                                 "stack,engine,k=10,closed,impact,40,5,4,6,,,3,,,,,,,,\n"
                                 "stack,engine,k=5,closed,impact,39,2,2,2,,,3,,,,,,,,\n"
                                 "stack,engine,k=5,closed,after,39,2,2,2,,,1e-9,,,,,,,,\n"
                                 "stack,engine,k=6,closed,after,39,2,2,2,,,1e-4,,,,,,,,\n");
    assert_int_equal(chart.line_count, 2);
    assert_string_equal(chart.lines[0].name, "engine");
    assert_string_equal(chart.lines[1].name, "momentum:warm=off");
    assert_int_equal(chart.launches, 40);
    assert_int_equal(chart.lines[0].left_out, 0);
    assert_int_equal(chart.floored, 1); /* 1e-9 */
    const ChartPanel *impact = &chart.panels[0];
    assert_int_equal(impact->count, 3);
    assert_int_equal(chart.panels[1].count, 2);
    assert_true(chart.panels[1].marks[0].error == 1e-4);
    assert_string_equal(impact->marks[0].label, "k=5");
    assert_true(impact->marks[0].on_front && !impact->marks[0].shipped);
    assert_string_equal(impact->marks[1].label, "k=10");
    assert_true(!impact->marks[1].on_front && impact->marks[1].shipped);
    assert_string_equal(impact->marks[2].label, ""); /* alone on its line, which has both settings */
    assert_string_equal(chart.lines[1].common, "k=7, b=0.5");
    assert_string_equal(chart.lines[0].common, "");
    assert_true(chart.us_least == 2 && chart.us_most == 6 && chart.error_least == 1e-4 && chart.error_most == 3);
    free_chart(&chart, &table);
}

/* A baseline a thousand times faster would push the methods that compete into a corner. */
TEST(the_axes_show_what_competes) {
    CsvTable table;
    Chart chart = gather(&table, "stack,engine,k=5,closed,impact,40,20,19,21,,,1,,,,,,,,\n"
                                 "stack,engine,k=100,closed,impact,40,200,190,210,,,0.1,,,,,,,,\n"
                                 "stack,playback,launches=25,closed,impact,40,0.2,0.1,0.3,,,0.05,,,,,,,,\n"
                                 "stack,playback,launches=100,closed,after,40,0.4,0.3,0.5,,,0.01,,,,,,,,\n"
                                 "stack,constant,,closed,impact,40,5,4,6,,,3,,,,,,,,\n"
                                 "stack,reference,,closed,impact,40,400,390,410,,,0,,,,,,,,\n");
    assert_true(chart.us_least == 4 && chart.us_most == 210); /* the constant is near */
    assert_true(chart.error_least == 0.1 && chart.error_most == 3);
    assert_int_equal(chart.panels[0].count, 3);
    assert_int_equal(chart.panels[1].count, 0);
    assert_int_equal(chart.floored, 0);
    const ChartLine *playback = &chart.lines[1];
    assert_int_equal(playback->beyond, 2);
    assert_true(playback->beyond_us[0] == 0.2 && playback->beyond_us[1] == 0.4);
    assert_true(playback->beyond_error[0] == 0.01 && playback->beyond_error[1] == 0.05);
    free_chart(&chart, &table);
    assert_ok(chart_plot(temporary_path("rows.csv"), "stack", folder(), &error), error);
    size_t size;
    char *svg = read_drawn("stack", "svg", &size);
    assert_non_null(strstr(svg, "Beyond the axes: playback (0.2 to 0.4 µs, 0.01 to 0.05 m/s), "
                                "reference (400 µs, below 0.0001 m/s)"));
    free(svg);
}

/* Methods keep their colour, whichever others are in the chart; all lines differ. */
TEST(a_method_has_one_style_in_all_charts) {
    const MethodDescription *engine = method_describe("engine"), *momentum = method_describe("momentum");
    PlotStyle one[2], other[CHART_MAX_LINES];
    plot_method_styles((const MethodDescription *[]){momentum, engine}, 2, one);
    const MethodDescription *many[CHART_MAX_LINES] = {engine, NULL, momentum, momentum};
    plot_method_styles(many, CHART_MAX_LINES, other);
    assert_int_equal(one[0].colour, plot_method_colour(METHOD_GREEN));
    assert_int_equal(one[0].colour, other[2].colour);
    assert_int_equal(one[0].symbol, other[2].symbol);
    assert_int_equal(other[3].colour, other[2].colour); /* a second line of one method: its symbol, open */
    assert_true(other[3].symbol == other[2].symbol && other[3].open && !other[2].open);
    for (int i = 0; i < CHART_MAX_LINES; i++)
        for (int k = 0; k < i; k++)
            assert_true(other[i].symbol != other[k].symbol || other[i].open != other[k].open ||
                        other[i].colour != other[k].colour);
}

/* One mark by the stopping rule between two of a fixed number of sweeps would bend their line. */
TEST(runs_with_a_stopping_rule_are_a_line_of_their_own) {
    CsvTable table;
    Chart chart = gather(&table, "stack,momentum,k=10,closed,impact,40,2,2,2,,,3,,,,,,,,\n"
                                 "stack,momentum,near=0.5,closed,impact,40,3,3,3,,,1,,,,,,,,\n"
                                 "stack,momentum,\"k=5,near=0.1\",closed,impact,40,4,4,4,,,0.5,,,,,,,,\n"
                                 "stack,momentum,k=20,closed,impact,40,5,5,5,,,2,,,,,,,,\n"
                                 "stack,scene-net,,closed,impact,40,5,5,5,,,2,,,,,,,,\n"
                                 "stack,scene-net,near=3,closed,impact,40,4,4,4,,,2,,,,,,,,\n"
                                 "stack,momentum,\"near=0.5,more=96\",closed,impact,40,6,6,6,,,1,,,,,,,,\n"
                                 "stack,scene-net,more=96,closed,impact,40,6,6,6,,,1,,,,,,,,\n");
    assert_int_equal(chart.line_count, 3);
    assert_string_equal(chart.lines[0].name, "momentum");
    assert_string_equal(chart.lines[1].name, "momentum:near");
    assert_string_equal(chart.lines[2].name, "scene-net");
    assert_int_equal(chart.lines[0].marks[0], 2);
    for (int i = 1; i < 3; i++) assert_int_equal(chart.lines[i].marks[0], 3);
    assert_string_equal(chart.panels[0].marks[3].label, "k=5,near=0.1");
    assert_string_equal(chart.lines[1].common, "");
    free_chart(&chart, &table);
}

/* Settings that all marks of a line have stand below the chart, once. */
TEST(labels_name_what_differs) {
    CsvTable table;
    Chart chart = gather(&table, "stack,momentum,\"k=2,near=0.5,more=400\",closed,impact,40,2,2,2,,,3,,,,,,,,\n"
                                 "stack,momentum,\"k=2,near=0.1,more=400\",closed,impact,40,3,3,3,,,1,,,,,,,,\n"
                                 "stack,momentum,\"k=2,near=0.02,more=400\",closed,after,40,4,4,4,,,0.5,,,,,,,,\n"
                                 "stack,engine,k=10,closed,impact,40,2,2,2,,,3,,,,,,,,\n"
                                 "stack,engine,k=100,closed,impact,40,5,5,5,,,2,,,,,,,,\n"
                                 "stack,nncg,k=20,closed,impact,40,5,5,5,,,2,,,,,,,,\n");
    static const char *const labels[] = {"near=0.5", "near=0.1", "k=10", "k=100", "k=20"};
    for (int i = 0; i < 5; i++) assert_string_equal(chart.panels[0].marks[i].label, labels[i]);
    assert_string_equal(chart.panels[1].marks[0].label, "near=0.02");
    assert_string_equal(chart.lines[0].common, "k=2, more=400");
    free_chart(&chart, &table);
    size_t size;
    assert_ok(chart_plot(temporary_path("rows.csv"), "stack", folder(), &error), error);
    char *svg = read_drawn("stack", "svg", &size);
    assert_non_null(strstr(svg, "momentum:near: k=2, more=400"));
    assert_null(strstr(svg, "near=0.5,more"));
    free(svg);
}

/* Methods and settings that are drawn, each once, and no others. */
TEST(a_chart_explains_its_words) {
    static const char *const explained[] = {
        ">engine: physics engine, sequential impulses<",
        ">k: sweeps over all contacts per step<",
        ">nncg: conjugate gradients over sweeps<",
        ">avbd: augmented vertex block descent<",
        ">momentum: sequential impulses with momentum<",
        ">near: sweeps go on while contacts miss their velocity by this, m/s<",
        ">more: sweeps that near may add<",
        ">net=off: without its learned part<",
        ">components: principal components, at most as many as the scene has<",
        ">Velocity error: difference from the converged solution of the same step, RMS over the boxes",
        ">Impact frames: the first after the bomb touches a box. Pareto front: solvers that no other solver beats"};
    size_t size;
    assert_ok(chart_plot(write_rows("stack,engine,k=10,closed,impact,40,5,5,5,,,1,,,,,,,,\n"
                                    "stack,nncg,k=10,closed,impact,40,5,5,5,,,1,,,,,,,,\n"
                                    "stack,avbd,k=10,closed,impact,40,5,5,5,,,1,,,,,,,,\n"
                                    "stack,momentum,\"k=2,near=0.1,more=9\",closed,impact,40,5,5,5,,,1,,,,,,,,\n"
                                    "stack,scene-net,net=off,closed,after,40,5,5,5,,,1,,,,,,,,\n"
                                    "stack,subspace,components=8,closed,after,40,5,5,5,,,1,,,,,,,,\n"
                                    "stack,soft-step,substeps=4,closed,after,40,,,,,,1,,,,,,,,\n"
                                    "stack,unknown,\",,q=1,net\",closed,after,40,5,5,5,,,1,,,,,,,,\n"),
                         "stack", folder(), &error),
              error);
    char *svg = read_drawn("stack", "svg", &size);
    for (size_t i = 0; i < sizeof explained / sizeof *explained; i++) {
        const char *found = strstr(svg, explained[i]);
        if (found == NULL) fail_msg("no '%s'", explained[i]);
        assert_null(strstr(found + 1, explained[i]));
    }
    assert_null(strstr(svg, "substeps:"));
    free(svg);
}

/* Links of chart.html have their places by the height that the words give. */
TEST(marks_stay_on_the_page_of_a_high_chart) {
    CsvTable table;
    Chart chart;
    double left, top;
    assert_ok(csv_table_read(&table, SAMPLE, &chart_layout, &error), error);
    assert_ok(chart_gather(&chart, &table, "pyramid_settled", SAMPLE, &error), error);
    assert_true(chart_height(&chart) > CHART_HEIGHT);
    chart_mark_place(&chart, 0, &(ChartMark){.us = chart.us_least, .error = chart.error_least}, &left, &top);
    /* The panel is 56 mm high and 5.5 mm below the upper edge; the axis ends somewhat below the least error. */
    assert_in_range((int)(top * chart_height(&chart)), 54, 61);
    free_chart(&chart, &table);
}

/* Two names that are equal where they are truncated. */
TEST(truncated_names_stay_distinct) {
    CsvTable table;
    Chart chart = gather(
        &table, "stack,a-name-of-more-than-forty-characters-which-ends-in-1,k=1,closed,impact,9,2,2,2,,,3,,,,,,,,\n"
                "stack,a-name-of-more-than-forty-characters-which-ends-in-2,k=1,closed,impact,9,2,2,2,,,3,,,,,,,,\n");
    assert_int_equal(chart.line_count, 2);
    assert_string_equal(chart.lines[0].name, "a-name-of-more-than-forty-characters...");
    assert_string_equal(chart.lines[1].name, chart.lines[0].name);
    free_chart(&chart, &table);
}

RUN_TESTS(NULL, NULL)

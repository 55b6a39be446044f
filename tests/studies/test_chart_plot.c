/* SPDX-License-Identifier: GPL-3.0-or-later */
/* chart.csv: invented numbers, modelled on measured ones; twelve methods. */
#include "charts.h"
#include "files.h"
#include "owned.h"
#include "python.h"

#include "studies/chart_data.h"
#include "studies/chart_drawing.h"
#include "studies/chart_plot.h"
#include "studies/chart_table.h"
#include "studies/first_line.h"

#include "methods/methods.h"

#define SAMPLE SOURCE_DIR "/tests/studies/chart.csv"

static const ChartLook page = {.size = CHART_PAGE};

static const char *drawn_file(const char *scene, const char *ending) {
    return temporary_path(printed("chart-%s.%s", scene, ending));
}

static const char *folder(void) {
    temporary_path(""); /* makes it */
    return temporary_folder;
}

static char *read_drawn(const char *scene, const char *ending, size_t *size) {
    return read_whole(drawn_file(scene, ending), size);
}

TEST(a_picture_and_its_caption_are_written) {
    assert_ok(chart_plot(SAMPLE, "pyramid_settled", folder(), &page, &error), error);
    size_t size;
    char *png = read_drawn("pyramid_settled", "png", &size);
    /* 174 mm at 300 dots per inch: 2055; and 92 mm: 1087. */
    assert_memory_equal(png, "\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\x08\x07\0\0\x04\x3f", 24);
    assert_true(size > 50000);
    free(png);
    char *pdf = read_drawn("pyramid_settled", "pdf", &size);
    assert_memory_equal(pdf, "%PDF-", 5);
    assert_true(size > 5000);
    free(pdf);
    expect_first_line("pdfinfo", drawn_file("pyramid_settled", "pdf"),
                      "Title:           Speed and accuracy: pyramid_settled, 40 launches");
    run_python("import sys, xml.etree.ElementTree as tree\n"
               "root = tree.parse(sys.argv[1]).getroot()\n"
               "assert root.tag == '{http://www.w3.org/2000/svg}svg', root.tag\n"
               "assert root[0].text == 'Speed and accuracy: pyramid_settled, 40 launches', root[0].text\n"
               "assert 'font/otf' in root[1].text and 'Arial' in root.get('font-family')\n"
               "texts = [t for e in root.iter('{http://www.w3.org/2000/svg}text') for t in e.itertext()]\n"
               "for wanted in ('At the impact', 'In the 60 frames after it', 'engine', 'engine:warm=off', 'momentum',\n"
               "               'momentum-schedule', 'playback', 'pair-net', 'no solver gets here', 'k=100',\n"
               "               'pyramid_settled, 40 launches', '9.4 × the time,', '1/39 of the error'):\n"
               "    assert wanted in texts, (wanted, texts)\n"
               /* Beside a name and a setting: their row over that of the scene's sweeps, in two digits. */
               "import csv\n"
               "rows = [row for row in csv.DictReader(open('" SAMPLE "'))\n"
               "        if row['phase'] in ('impact', 'after') and float(row['error_mean'] or 0) > 0]\n"
               "own = {row['phase']: row for row in rows if (row['method'], row['setting']) == ('engine', '')}\n"
               "def words(row, column):\n"
               "    factor = float(row[column]) / float(own[row['phase']][column])\n"
               "    most = max(factor, 1 / factor)\n"
               "    text = f'{float(f\"{most:.2g}\"):.{1 if most < 9.95 else 0}f}'\n"
               "    return ('1/' + text + ' of the ') if factor < 1 else (text + ' × the ')\n"
               "told = {(row['method'], row['setting'], words(row, 'us_solver') + 'time,', words(row, 'error_mean') + "
               "'error')\n"
               "        for row in rows}\n"
               "found = [tuple(texts[i - 2:i + 2]) for i, text in enumerate(texts) if text.endswith('the time,')]\n"
               "assert len(found) > 3 and told.issuperset(found), set(found) - told\n",
               drawn_file("pyramid_settled", "svg"));
    FREED char *caption = read_drawn("pyramid_settled", "txt", &size);
    assert_non_null(strstr(caption, " Beyond the axes: reference (2232 to 2400 µs, below 0.0001 m/s), constant (0.56"));
    assert_non_null(strstr(caption, "Ring and dotted lines: engine with as many sweeps as the scene sets"));
}

/* The picture's size in pixels, from the head of its file. */
static void expect_size(const ChartLook *look, int width, int height) {
    Error error = {0};
    size_t size;
    assert_ok(chart_plot(SAMPLE, "pyramid_settled", folder(), look, &error), error);
    FREED unsigned char *png = (unsigned char *)read_drawn("pyramid_settled", "png", &size);
    assert_int_equal(png[18] << 8 | png[19], width);
    if (height > 0) assert_int_equal(png[22] << 8 | png[23], height);
    if (height < 0) assert_true((png[22] << 8 | png[23]) > -height);
}

TEST(sizes_are_those_of_a_column_and_a_slide) {
    expect_size(&(ChartLook){.size = CHART_COLUMN}, 1004, 1701);
    expect_size(&(ChartLook){.size = CHART_SLIDE}, 1890, 1063);
    expect_size(&(ChartLook){.words = true}, 2055, -1200);
    size_t size;
    FREED char *svg = read_drawn("pyramid_settled", "svg", &size);
    assert_non_null(strstr(svg, "Velocity error:"));
}

#define HEADER                                                        \
    "scene,method,setting,protocol,phase,launches,us_solver,us_step," \
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
    assert_refused(chart_plot(write_rows(lines), scene, folder(), &page, &error), message);
    assert_int_equal(access(drawn_file("single", "png"), F_OK), -1);
}

TEST(tables_without_a_mark_are_refused) {
    static const char none[] = "rows.csv: error: no row of the scene 'single' in closed loop has a time and an error";
    expect_refused("stack,engine,,closed,impact,40,5,,1,,,,,,,,\n", "single", none);
    expect_refused("single,engine,k=10,frozen,impact,40,5,,1,,,,,,,,\n"
                   "single,engine,,closed,rest,40,5,,1,,,,,,,,\n"
                   "single,engine,k=30,closed,impact,40,5,,,,,,,,,,\n"
                   "single,engine,k=40,closed,impact,40,,,1,,,,,,,,\n"
                   "single,engine,k=50,closed,impact,40,0,,1,,,,,,,,\n",
                   "single", none);
    expect_refused("single,engine,,closed,impact,40,5,,-1,,,,,,,,\n", "single", "error_mean: '-1' is less than 0");
    expect_refused("../x,engine,,closed,impact,40,5,,1,,,,,,,,\n", "../x", "is not a valid scene name");
    char many[8000] = "";
    for (int i = 0; i <= CHART_MAX_LINES; i++)
        snprintf(many + strlen(many), 200, "single,m%d,,closed,impact,40,5,,1,,,,,,,,\n", i);
    expect_refused(many, "single", "at most 32 methods");
}

/* The caption of the drawn stack, to be freed. */
static char *caption_of(const char *path) {
    Error error = {0};
    size_t size;
    assert_ok(chart_plot(path, "stack", folder(), &page, &error), error);
    return read_drawn("stack", "txt", &size);
}

static void expect_caption(const char *path, const char *wanted, const char *unwanted) {
    FREED char *caption = caption_of(path);
    if (strstr(caption, wanted) == NULL) fail_msg("no '%s' in: %s", wanted, caption);
    if (unwanted != NULL) assert_null(strstr(caption, unwanted));
}

/* The caption names the methods whose errors have another target. */
TEST(a_target_without_push_out_is_noted) {
    static const char rows[] = "stack,engine,,closed,impact,40,5,,1,,,,,,,,\n"
                               "stack,soft-step,substeps=4,closed,impact,40,5,,1,,,,,,,,\n"
                               "stack,avbd,k=10,closed,impact,40,5,,1,,,,,,,,\n";
    const char *engine = printed("%.*s", (int)(strchr(rows, '\n') + 1 - rows), rows);
    expect_caption(write_rows(rows), "soft-step, avbd: error against the solution without the velocity that pushes",
                   NULL);
    expect_caption(write_rows(engine), "Velocity error", "error against");
}

/* Above what is drawn at all, the floor is a line, and errors below it are drawn on it: neither is ranked. */
TEST(the_floor_is_a_line_below_which_nothing_is_ranked) {
    static const char head[] = CHART_HEADER ",cpu,us_engine,signorini,cone,dissipation,rollout_mse,floor\n";
    static const char row[] = "stack,%s,,closed,impact,40,%d,,%g,,,,,,,,,,,,,,,%g\n";
    for (int k = 0; k < 2; k++) {
        const double floor = k == 0 ? 1e-5 : 0.003;
        const char *path = temporary_path("chart.csv");
        FILE *file = fopen(path, "wb");
        assert_non_null(file);
        fputs(head, file);
        fprintf(file, row, "engine", 5, 1.0, floor);
        fprintf(file, row, "momentum", 9, 0.0025, floor);
        fprintf(file, row, "interior", 20, 0.0005, floor);
        assert_int_equal(fclose(file), 0);
        OWN(CsvTable) table;
        Chart chart;
        assert_ok(csv_table_read(&table, path, &chart_layout, &error), error);
        assert_ok(chart_gather(&chart, &table, "stack", path, &page, &error), error);
        const ChartMark *marks = chart.panels[0].marks;
        assert_int_equal(chart.panels[0].count, 3);
        assert_near(marks[1].error, k == 0 ? 0.0025 : 0.003, 1e-12);
        assert_near(marks[2].error, k == 0 ? 0.0005 : 0.003, 1e-12);
        assert_int_equal(marks[2].on_front, k == 0); /* else momentum is as right in less time */
        assert_near(chart.floor[0], k == 0 ? 0 : 0.003, 1e-12);
        chart_free(&chart);
        expect_caption(path, "Velocity error", k == 0 ? "floor" : NULL);
        if (k == 1) expect_caption(path, "Line with the name floor: 0.003 m/s at the impact; the error of other", NULL);
        size_t size;
        FREED char *svg = read_drawn("stack", "svg", &size);
        assert_int_equal(strstr(svg, ">floor<") != NULL, k == 1);
    }
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
    char many[200];
    memset(many, 'x', sizeof many - 1), many[sizeof many - 1] = '\0';
    chart_plain(plain, many);
    assert_int_equal(strlen(plain), CHART_TEXT_SIZE - 1);
    assert_string_equal(plain + CHART_TEXT_SIZE - 5, "x...");
    memcpy(many + CHART_TEXT_SIZE - 5, "\xc3\xa4", 2);
    chart_plain(plain, many); /* not cut within a letter */
    assert_string_equal(plain + CHART_TEXT_SIZE - 6, "x...");
}

/* The chart of the stack; its marks name texts of the table. */
static Chart gather(CsvTable *table, const char *lines) {
    Error error = {0};
    Chart chart;
    const char *path = write_rows(lines);
    assert_ok(csv_table_read(table, path, &chart_layout, &error), error);
    assert_ok(chart_gather(&chart, table, "stack", path, &page, &error), error);
    return chart;
}

static void free_chart(Chart *chart, CsvTable *table) {
    chart_free(chart);
    csv_table_free(table);
}

TEST(marks_are_gathered_by_line_and_time) {
    CsvTable table;
    Chart chart = gather(&table, "single,engine,k=5,closed,impact,9,2,,3,,,,,,,,\n"
                                 "stack,momentum,\"warm=off,k=7,b=0.5\",closed,impact,40,4,,2,,,,,,,,\n"
                                 "stack,engine,,closed,impact,40,5,,3,,,,,,,,\n"
                                 "stack,engine,k=5,closed,impact,39,2,,3,,,,,,,,\n"
                                 "stack,engine,k=5,closed,after,39,2,,1e-9,,,,,,,,\n"
                                 "stack,engine,k=6,closed,after,39,2,,1e-4,,,,,,,,\n");
    assert_int_equal(chart.line_count, 2);
    assert_string_equal(chart.lines[0].name, "momentum:warm=off");
    assert_string_equal(chart.lines[1].name, "engine");
    assert_int_equal(chart.launches, 40);
    assert_int_equal(chart.lines[0].left_out, 0);
    assert_int_equal(chart.floored, 1); /* 1e-9 */
    const ChartPanel *impact = &chart.panels[0];
    assert_int_equal(impact->count, 3);
    assert_int_equal(chart.panels[1].count, 2);
    assert_true(chart.panels[1].marks[0].error == 1e-4);
    assert_string_equal(impact->marks[0].label, "k=7,b=0.5");
    assert_string_equal(impact->marks[1].label, "k=5");
    assert_true(impact->marks[1].on_front && !impact->marks[1].baseline);
    assert_string_equal(impact->marks[2].label, "");
    assert_true(!impact->marks[2].on_front && impact->marks[2].baseline && impact->marks[2].beaten);
    assert_true(chart.us_least == 2 && chart.us_most == 5 && chart.error_least == 1e-4 && chart.error_most == 3);
    free_chart(&chart, &table);
}

/* A baseline a thousand times faster would push the coloured curves into a corner. */
TEST(the_axes_show_the_coloured_curves) {
    CsvTable table;
    Chart chart = gather(&table, "stack,engine,k=5,closed,impact,40,20,,1,,,,,,,,\n"
                                 "stack,engine,k=100,closed,impact,40,200,,0.1,,,,,,,,\n"
                                 "stack,playback,launches=25,closed,impact,40,0.2,,0.05,,,,,,,,\n"
                                 "stack,playback,launches=100,closed,after,40,0.4,,0.01,,,,,,,,\n"
                                 "stack,pair-net,net=off,closed,impact,40,5,,3,,,,,,,,\n"
                                 "stack,reference,,closed,impact,40,400,,0,,,,,,,,\n");
    assert_true(chart.us_least == 5 && chart.us_most == 200); /* pair-net is near */
    assert_true(chart.error_least == 0.1 && chart.error_most == 3);
    assert_int_equal(chart.panels[0].count, 3);
    assert_int_equal(chart.panels[1].count, 0);
    assert_int_equal(chart.floored, 0);
    const ChartLine *playback = &chart.lines[1];
    assert_int_equal(playback->beyond, 2);
    assert_true(playback->beyond_us[0] == 0.2 && playback->beyond_us[1] == 0.4);
    assert_true(playback->beyond_error[0] == 0.01 && playback->beyond_error[1] == 0.05);
    free_chart(&chart, &table);
    expect_caption(temporary_path("rows.csv"),
                   "Beyond the axes: playback (0.2 to 0.4 µs, 0.01 to 0.05 m/s), reference (400 µs, below 0.0001 m/s).",
                   NULL);
}

/* Methods keep their colour and symbol, whichever others are in the chart; a second line has another colour and an open
   symbol. */
TEST(a_method_has_one_style_in_all_charts) {
    RunColours two[2], three[3];
    assert_ok(colours_assign((const char *[]){"momentum", "engine"}, 2, NULL, two, &error), error);
    assert_ok(colours_assign((const char *[]){"engine", "momentum:near", "momentum"}, 3, NULL, three, &error), error);
    const PlotStyle one = plot_method_style(&two[0]), same = plot_method_style(&three[2]),
                    other = plot_method_style(&three[1]);
    assert_true(one.colour == same.colour && one.symbol == same.symbol && !same.open);
    assert_true(other.colour != same.colour && other.symbol == same.symbol && other.open);
}

/* A curve has the settings that no other setting of the method beats. */
TEST(what_is_beaten_is_left_out) {
    CsvTable table;
    Chart chart = gather(&table, "stack,momentum,k=10,closed,impact,40,2,,3,,,,,,,,\n"
                                 "stack,momentum,near=0.5,closed,impact,40,3,,1,,,,,,,,\n"
                                 "stack,momentum,k=20,closed,impact,40,5,,2,,,,,,,,\n"
                                 "stack,engine,k=5,closed,impact,40,2,,2,,,,,,,,\n"
                                 "stack,engine,,closed,impact,40,4,,3,,,,,,,,\n");
    assert_int_equal(chart.line_count, 2);
    assert_int_equal(chart.lines[0].marks[0], 2); /* k=20 is slower and less accurate than near=0.5 */
    assert_string_equal(chart.panels[0].marks[1].label, "near=0.5");
    assert_int_equal(chart.lines[1].marks[0], 2); /* the baseline stays */
    assert_true(chart.panels[0].marks[3].beaten && chart.panels[0].marks[3].baseline);
    free_chart(&chart, &table);
}

/* Settings that all marks with the same keys have are not in their labels. */
TEST(labels_name_what_differs) {
    CsvTable table;
    Chart chart = gather(&table, "stack,momentum,\"k=2,near=0.5,more=400\",closed,impact,40,2,,3,,,,,,,,\n"
                                 "stack,momentum,\"k=2,near=0.1,more=400\",closed,impact,40,3,,1,,,,,,,,\n"
                                 "stack,momentum,k=100,closed,impact,40,4,,0.5,,,,,,,,\n"
                                 "stack,momentum,\"k=2,near=0.02,more=400\",closed,after,40,4,,0.5,,,,,,,,\n"
                                 "stack,nncg,\"k=20,more=9\",closed,impact,40,5,,2,,,,,,,,\n");
    static const char *const labels[] = {"near=0.5", "near=0.1", "k=100", "k=20,more=9"};
    for (int i = 0; i < 4; i++) assert_string_equal(chart.panels[0].marks[i].label, labels[i]);
    assert_string_equal(chart.panels[1].marks[0].label, "near=0.02");
    free_chart(&chart, &table);
}

/* Which lines are in colour. */

static const char many_methods[] = "stack,engine,k=10,closed,impact,40,5,,1,,,,,,,,\n"
                                   "stack,nncg,k=10,closed,impact,40,4,,2,,,,,,,,\n"
                                   "stack,avbd,k=10,closed,impact,40,5,,0.9,,,,,,,,\n"
                                   "stack,avbd,k=20,closed,impact,40,8,,0.5,,,,,,,,\n"
                                   "stack,scene-net,,closed,impact,40,5,,0.1,,,,,,,,\n"
                                   "stack,scene-net,net=off,closed,impact,40,5,,0.2,,,,,,,,\n"
                                   "stack,sain,,closed,impact,40,5,,1,,,,,,,,\n"
                                   "stack,sain,net=off,closed,impact,40,5,,1,,,,,,,,\n"
                                   "stack,interior,near=0.002,closed,impact,40,5,,0.01,,,,,,,,\n";

static void expect_ranks(const char *rows, ChartLook look, const int *ranks, int count) {
    Error error = {0};
    CsvTable table;
    Chart chart;
    const char *path = write_rows(rows);
    assert_ok(csv_table_read(&table, path, &chart_layout, &error), error);
    assert_ok(chart_gather(&chart, &table, "stack", path, &look, &error), error);
    assert_int_equal(chart.line_count, count);
    for (int i = 0; i < count; i++)
        if ((int)chart.lines[i].rank != ranks[i])
            fail_msg("%s: rank %d", chart.lines[i].name, (int)chart.lines[i].rank);
    free_chart(&chart, &table);
}

TEST(six_lines_at_most_are_in_colour) {
    enum { G = CHART_GREY, H = CHART_HIDDEN, C = CHART_COLOURED };
    /* The engine, avbd (two corners of the front of those that learn nothing, nncg has one), scene-net and its twin,
       interior. */
    expect_ranks(many_methods, page, (const int[]){C, G, C, C, C, G, H, C}, 8);
    /* sain is asked for: there is no room for both twins. */
    expect_ranks(many_methods, (ChartLook){.highlight = "sain"}, (const int[]){C, G, C, C, C, C, H, C}, 8);
    expect_ranks(many_methods, (ChartLook){.highlight = "nncg,sain:net=off"}, (const int[]){C, C, C, C, H, G, C, C}, 8);
    /* All are, by --methods, with the least of the table for the last: there is no room for a twin. */
    expect_ranks(many_methods, (ChartLook){.chosen = true}, (const int[]){C, C, C, C, H, C, H, C}, 8);
    /* A network that is named by its file is the scene's own, too. */
    expect_ranks("stack,scene-net,network=a/b.npz,closed,impact,40,5,,1,,,,,,,,\n"
                 "stack,scene-net,\"network=a/b.npz,net=off\",closed,impact,40,5,,2,,,,,,,,\n",
                 page, (const int[]){C, C}, 2);
}

/* What lost the scene is drawn if it is asked for. */
TEST(lost_methods_are_shown_on_request) {
    static const char rows[] = "stack,engine,,closed,impact,40,5,,1,,,,,,,,\n"
                               "stack,pair-net,,closed,impact,40,6,,2,,,,,,,,\n"
                               "stack,pair-net,,closed,rest,40,6,,2,,,,,,0.6,,\n";
    const ChartLook asked = {.highlight = "pair-net"};
    size_t size;
    expect_caption(write_rows(rows), "Unstable before the impact, and left out: pair-net (1).", "Crosses");
    assert_ok(chart_plot(write_rows(rows), "stack", folder(), &asked, &error), error);
    FREED char *caption = read_drawn("stack", "txt", &size);
    assert_non_null(strstr(caption, "Crosses: the method lost the scene before the impact."));
    assert_null(strstr(caption, "left out: pair-net"));
}

/* What lost the scene is no part of what is reached: its front, and its curve. */
TEST(curves_and_fronts_join_what_held) {
    static const char rows[] = "stack,engine,k=1,closed,impact,40,10,,3,,,,,,,,\n"
                               "stack,engine,k=5,closed,impact,40,100,,1,,,,,,,,\n"
                               "stack,engine,k=5,closed,rest,40,6,,2,,,,,,0.6,,\n"
                               "stack,engine,k=50,closed,impact,40,1000,,0.5,,,,,,,,\n";
    CsvTable table;
    Chart chart = gather(&table, rows);
    assert_int_equal(chart.front_count[0], 2);
    free_chart(&chart, &table);
    assert_ok(chart_plot(write_rows(rows), "stack", folder(), &(ChartLook){.highlight = "engine"}, &error), error);
    run_python(
        "import re, sys\n"
        "lines = [tuple(map(float, line)) for line in re.findall(r'd=\"M(\\S+) (\\S+)L(\\S+) (\\S+)\" fill=\"none\" '\n"
        "         r'stroke=\"#0072B2\"', open(sys.argv[1]).read())]\n"
        "joined = [line for line in lines if line[2] - line[0] > 3] # not the strokes of a cross\n"
        "assert len(joined) == 1 and joined[0][:2] == lines[0][:2] == lines[0][2:], lines\n",
        drawn_file("stack", "svg"));
}

/* The picture itself says what it leaves out; on recorded steps nothing is lost. */
TEST(what_is_left_out_is_in_the_picture) {
    static const char rows[] = "stack,engine,,closed,impact,40,5,,1,,,,,,,,\n"
                               "stack,pair-net,,frozen,impact,40,6,,2,,,,,,,,\n"
                               "stack,pair-net,,closed,impact,40,6,,2,,,,,,,,\n"
                               "stack,pair-net,,closed,rest,40,6,,2,,,,,,0.6,,\n";
    const ChartLook frozen = {.frozen = true};
    size_t size;
    for (int i = 0; i < 2; i++) {
        assert_ok(chart_plot(write_rows(rows), "stack", folder(), i == 0 ? &page : &frozen, &error), error);
        FREED char *svg = read_drawn("stack", "svg", &size);
        assert_true((strstr(svg, "left out: pair-net (unstable)") != NULL) == (i == 0));
        assert_true((strstr(svg, ">pair-net<") != NULL) == (i == 1));
        assert_true((strstr(svg, ">engine<") != NULL) == (i == 0)); /* it has no frozen row */
        assert_true((strstr(svg, "on the engine's steps") != NULL) == (i == 1));
    }
}

/* A program reports one time; its curve is in colour and no part of the front. */
TEST(programs_are_drawn_with_their_own_time) {
    CsvTable table;
    const char *path = temporary_path("chart.csv");
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    fputs(CHART_HEADER ",cpu,us_engine\n"
                       "stack,engine,,closed,impact,40,5,,1,,,,,,,,,AMD,\n"
                       "stack,exec,\"program=node a.mjs,name=Rapier\",closed,impact,40,,,0.5,,,,,,,,,,2.5\n"
                       "stack,exec,program=silent,closed,impact,40,,,0.5,,,,,,,,,,\n"
                       "stack,exec,program=zero,closed,impact,40,,,0.5,,,,,,,,,,0\n",
          file);
    assert_int_equal(fclose(file), 0);
    assert_ok(csv_table_read(&table, path, &chart_layout, &error), error);
    Chart chart;
    assert_ok(chart_gather(&chart, &table, "stack", path, &page, &error), error);
    assert_int_equal(chart.panels[0].count, 2);
    assert_true(chart.panels[0].marks[1].us == 2.5);
    assert_string_equal(chart.lines[1].name, "Rapier");
    assert_int_equal(chart.lines[1].rank, CHART_COLOURED);
    assert_int_equal(chart.front_count[0], 1);
    assert_true(chart.front[0][0].us == 5);
    assert_int_equal(chart.lines[2].left_out + chart.lines[3].left_out, 2);
    free_chart(&chart, &table);
    expect_caption(path, " Rapier: an external program, by its own clock", NULL);
    expect_caption(path, "Without time or error: exec:program=silent (1), exec:program=zero (1).", NULL);
}

/* What the reference reaches is no place that no solver gets to; a baseline solves nothing. */
TEST(the_front_goes_through_the_reference) {
    CsvTable table;
    const char *path = write_rows("stack,engine,,closed,impact,40,5,,1,,,,,,,,\n"
                                  "stack,reference,,closed,impact,40,50,,0.0001,,,,,,,,\n"
                                  "stack,playback,launches=25,closed,impact,40,1,,0.5,,,,,,,,\n");
    assert_ok(csv_table_read(&table, path, &chart_layout, &error), error);
    Chart chart;
    assert_ok(chart_gather(&chart, &table, "stack", path, &page, &error), error);
    assert_int_equal(chart.front_count[0], 2);
    assert_true(chart.front[0][0].us == 5 && chart.front[0][1].us == 50);
    free_chart(&chart, &table);
}

/* Methods and settings that are drawn, each once, and no others. */
TEST(a_chart_explains_its_words) {
    static const char *const explained[] = {" engine: physics engine, sequential impulses",
                                            " k: sweeps over all contacts per step",
                                            " avbd: augmented vertex block descent",
                                            " near: residual at which iterations stop, m/s",
                                            " net=off: without its learned part",
                                            " Velocity error: difference from the converged solution of the same step"};
    FREED char *caption = caption_of(write_rows(many_methods));
    for (size_t i = 0; i < sizeof explained / sizeof *explained; i++) {
        const char *found = strstr(caption, explained[i]);
        if (found == NULL) fail_msg("no '%s' in: %s", explained[i], caption);
        assert_null(strstr(found + 1, explained[i]));
    }
    assert_null(strstr(caption, "substeps:"));
}

/* Two networks of one name in different folders. */
TEST(equal_names_stay_distinct) {
    CsvTable table;
    Chart chart = gather(&table, "stack,scene-net,network=a/net.npz,closed,impact,9,2,,3,,,,,,,,\n"
                                 "stack,scene-net,network=b/net.npz,closed,impact,9,2,,3,,,,,,,,\n");
    assert_int_equal(chart.line_count, 2);
    assert_string_equal(chart.lines[0].name, "scene-net:net");
    assert_string_equal(chart.lines[1].name, chart.lines[0].name);
    free_chart(&chart, &table);
}

RUN_TESTS(NULL, NULL)

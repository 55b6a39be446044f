/* SPDX-License-Identifier: GPL-3.0-or-later */
/* paper/: tables made up after measured ones, each with all that its figure can show. */
#include "files.h"
#include "owned.h"
#include "python.h"
#include "sanitized.h"

#include "paper/paper_report.h"

#include <sys/stat.h>

static const char *const tables[] = {"table1", "networks", "rates", "closed_loop", "laws", "transfer"};
static const char *const figures[] = {"loss", "factors", "rates", "closed-loop", "laws", "transfer"};

enum { TABLES = sizeof tables / sizeof *tables };

static const char *table_path(const char *table) { return temporary_path(printed("%s.csv", table)); }

static const char *figure_path(const char *figure, const char *ending) {
    return temporary_path(printed("figures/%s.%s", figure, ending));
}

static void write_table(const char *table, const char *text, size_t size) {
    Error error = {0};
    assert_ok(file_write_soon(table_path(table), text, size, &error), error);
}

/* A folder with the sample's tables and no figures. */
static void start_afresh(void) {
    remove_temporary_folder();
    assert_int_equal(mkdir(temporary_folder, 0700), 0);
    for (int i = 0; i < TABLES; i++) {
        size_t size;
        FREED char *text = read_whole(printed("%s/tests/paper/figures/%s.csv", SOURCE_DIR, tables[i]), &size);
        write_table(tables[i], text, size);
    }
}

static void draw(void) {
    Error error = {0};
    assert_ok(plots_draw(temporary_folder, NULL, &error), error);
}

/* Of a PNG: two big-endian numbers behind its signature and the first chunk's head. */
static unsigned number_at(const char *data, int at) {
    const unsigned char *bytes = (const unsigned char *)data + at;
    return (unsigned)bytes[0] << 24 | (unsigned)bytes[1] << 16 | (unsigned)bytes[2] << 8 | bytes[3];
}

static void expect_size(const char *figure, double mm) {
    size_t size;
    FREED char *png = read_whole(figure_path(figure, "png"), &size);
    assert_true(size > 10000);
    assert_memory_equal(png, "\x89PNG\r\n\x1a\n", 8);
    assert_near(number_at(png, 16), mm / 25.4 * 300, 1);
}

static void expect_caption(const char *figure) {
    size_t size;
    FREED char *text = read_whole(figure_path(figure, "txt"), &size);
    assert_true(size > 50);
    assert_ptr_equal(strchr(text, '\n'), text + size - 1);
}

static bool tells_of_values_beyond(const char *figure) {
    FREED char *text = text_of(figure_path(figure, "txt"));
    bool tells = strstr(text, "beyond an axis") != NULL;
    return tells;
}

TEST(all_are_drawn) {
    start_afresh();
    draw();
    for (int i = 0; i < TABLES; i++) {
        expect_size(figures[i], strcmp(figures[i], "transfer") == 0 ? 85 : 174);
        expect_caption(figures[i]);
        assert_false(tells_of_values_beyond(figures[i]));
    }
    run_python(
        "import sys, xml.etree.ElementTree as tree\n"
        "def texts(name):\n"
        "    root = tree.parse(sys.argv[1] + '/figures/' + name + '.svg').getroot()\n"
        "    found = root.iter('{http://www.w3.org/2000/svg}text')\n"
        "    return '|'.join(' '.join(''.join(e.itertext()).split()) for e in found)\n"
        "for name, wanted in (\n"
        "    ('loss', ('Mean squared error', 'Levenberg-Marquardt', \"the paper's Table 1\", 'Training iteration')),\n"
        "    ('factors', ('inputs = raw-unturned', 'best = impulse', '494', 'no result', 'range over the splits')),\n"
        "    ('rates', ('Within 0.1 m/s', 'target-impulse', 'engine, 10 sweeps', 'Right at rest (%)')),\n"
        "    ('closed-loop', ('Frames until divergence by 0.1 m (600: never)', 'contact-net', 'pyramid, settled')),\n"
        "    ('laws', ('Friction cone (N s)', 'all four laws', 'Weight in the loss', 'Momentum (kg m/s)')),\n"
        "    ('transfer', ('RMS velocity error (m/s)', 'from scratch', '128'))):\n"
        "    for text in wanted:\n"
        "        assert text in texts(name), (text, texts(name))\n"
        "assert 'warm-start' not in texts('rates') and 'points' not in texts('loss')\n",
        temporary_folder);
}

/* Nothing is drawn where one of the tables is refused, be it the last. */
static void expect_refused(const char *table, const char *text, const char *message) {
    Error error = {0};
    start_afresh();
    write_table(table, text, strlen(text));
    assert_refused(plots_draw(temporary_folder, NULL, &error), message);
    assert_int_equal(access(temporary_path("figures"), F_OK), -1);
}

#define TABLE1 "network,target,optimizer,iteration,test_range2,train_range2,constant_range2,seed\n"
#define NETWORKS                                                                                                 \
    "network,factor,value,target,parameters,ratio,inputs,data,labels,layers,hidden,output,scale,optimizer,loss," \
    "iterations,test_range2,train_range2,constant_range2,accuracy,ratio_single,ratio_stack,largest,seed\n"
#define NETWORK_END ",,,,,,,,,,,,,,,,,,1\n"
#define RATES "network,scene,definition,phase,rate,constant,engine1,engine4,engine10,seed\n"
#define CLOSED \
    "network,scene,frames_until_apart,us_step,us_step_engine,penetration_max,momentum_error,energy_ratio,seed\n"
#define CLOSED_END ",,,,1\n"
#define LAWS "laws,weight,seed,test_deviation2,constant_deviation2,momentum,energy,approach,cone\n"
#define TRANSFER "start,seed,launches,error_m_s,constant_m_s\n"

TEST(tables_out_of_order_are_refused_with_their_place) {
    expect_refused("table1", "network,target\nbaseline,pair\n", "table1.csv:1:1: error: the column 'seed' is missing");
    expect_refused("table1", TABLE1 "baseline,pair,adam,ten,1,1,1,1\n",
                   "table1.csv:2:20: error: iteration: 'ten' is not");
    expect_refused("table1", TABLE1 "baseline,pair,adam,,1,1,1,1\n",
                   "table1.csv:2:20: error: iteration: the field is empty");
    expect_refused("table1", TABLE1 "baseline,pair,adam,0,inf,1,1,1\n",
                   "table1.csv:2:22: error: test_range2: 'inf' is not a number");
    expect_refused("table1", TABLE1 "baseline,pair,adam,0,1e999,1,1,1\n",
                   "table1.csv:2:22: error: test_range2: '1e999' is not");
    expect_refused("table1", TABLE1 "baseline,pair,adam,0,1,1,-1,1\n",
                   "table1.csv:2:26: error: constant_range2: '-1' is less than 0");
    expect_refused("table1", TABLE1 "baseline,velocity,adam,0,1,1,1,1\n",
                   "table1.csv:2:10: error: target: 'velocity' is not");
    expect_refused("table1", TABLE1 "baseline,pair,sgd,0,1,1,1,1\n",
                   "table1.csv:2:15: error: optimizer: 'sgd' is not one of adam");
    expect_refused("networks", NETWORKS "a,inputs,'; system(1),pair,1,1" NETWORK_END,
                   "networks.csv:2:10: error: value: ''; system(1)' may");
    expect_refused("networks", NETWORKS "a,b,\"`b`\",pair,1,1" NETWORK_END,
                   "networks.csv:2:5: error: value: '`b`' may only");
    expect_refused("rates", RATES "baseline,single,range,impact,1.5,,,,,1\n",
                   "rates.csv:2:30: error: rate: '1.5' is greater than 1");
    expect_refused("rates", RATES "baseline,tower,range,impact,1,,,,,1\n",
                   "rates.csv:2:10: error: scene: 'tower' is not one of");
    expect_refused("closed_loop", CLOSED "baseline,stack,601,1,1" CLOSED_END,
                   "closed_loop.csv:2:16: error: frames_until_apart: '601'");
    expect_refused("closed_loop", CLOSED "baseline,stack,6,1,0" CLOSED_END,
                   "closed_loop.csv:2:20: error: us_step_engine: '0' is less than 1e-06");
    expect_refused("laws", LAWS "none,0,1,1,1,1,1,1\n", "laws.csv:2:1: error: 8 fields, but the header has 9");
    expect_refused("laws", LAWS "gravity,0,1,1,1,1,1,1,1\n",
                   "laws.csv:2:1: error: laws: 'gravity' is not one of momentum");
    expect_refused("transfer", TRANSFER "scratch,1,0,1,1\n", "transfer.csv:2:11: error: launches: '0' is less than 1");
    expect_refused("transfer", TRANSFER, "transfer.csv:2:1: error: the table has no rows");
    expect_refused("transfer", "start,seed,start\n1,1,1\n",
                   "transfer.csv:1:12: error: the column 'start' appears twice");
}

static void write_many(const char *table, const char *header, const char *line, int count) {
    FREED char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    assert_non_null(file);
    fputs(header, file);
    for (int i = 0; i < count; i++) fputs(line, file);
    assert_int_equal(fclose(file), 0);
    write_table(table, text, size);
}

TEST(too_many_lines_are_refused) {
    static const struct {
        const char *table, *header, *line, *message;
        int most;
    } cases[] = {
        {"transfer", TRANSFER, "scratch,1,1,1,1\n", "transfer.csv:20002:1: error: the table has more than 20000 rows",
         20000},
        {"networks", NETWORKS, "a,a,b,pair,1,1" NETWORK_END,
         "networks.csv:2002:1: error: the table has more than 2000 rows", 2000},
        {"closed_loop", CLOSED, "a,stack,1,1,1" CLOSED_END,
         "closed_loop.csv:2002:1: error: the table has more than 2000 rows", 2000},
    };
    for (int i = 0; i < 3; i++) {
        start_afresh();
        write_many(cases[i].table, cases[i].header, cases[i].line, cases[i].most + 1);
        assert_refused(plots_draw(temporary_folder, NULL, &error), cases[i].message);
    }
    for (int i = 0; i < 3; i++) write_many(cases[i].table, cases[i].header, cases[i].line, cases[i].most);
    draw();
}

TEST(a_missing_table_is_refused) {
    for (int i = 0; i < TABLES; i++) {
        error = (Error){0};
        start_afresh();
        assert_int_equal(remove(table_path(tables[i])), 0);
        assert_false(plots_draw(temporary_folder, NULL, &error));
        assert_int_not_equal(error.kind, ERROR_NONE);
        assert_non_null(strstr(error.message, tables[i]));
        assert_int_equal(access(temporary_path("figures"), F_OK), -1);
    }
}

TEST(figures_without_rows_are_left_out) {
    static const struct {
        const char *table, *figure, *text;
    } cases[] = {{"table1", "loss", TABLE1 "best-pair,pair,adam,0,1,1,1,1\nbaseline,points,adam,0,1,1,1,1\n"},
                 {"rates", "rates", RATES "baseline,single,range,after,1,,,,,1\nwarm-start,single,range,rest,1,,,,,\n"},
                 {"laws", "laws", LAWS "engine,,,,,1,1,1,1\n"}};
    start_afresh();
    for (int i = 0; i < 3; i++) write_table(cases[i].table, cases[i].text, strlen(cases[i].text));
    draw();
    for (int i = 0; i < 3; i++) {
        assert_int_equal(access(figure_path(cases[i].figure, "png"), F_OK), -1);
        assert_int_equal(access(figure_path(cases[i].figure, "txt"), F_OK), -1);
    }
    assert_int_equal(access(figure_path("transfer", "png"), F_OK), 0);
}

/* One line each, of nothing, of zeros and numbers next to it, of large ones. */
TEST(odd_numbers_are_drawn) {
    static const struct {
        const char *number, *rate, *divisor, *needed, *launches;
    } cases[] = {{"", "", "", "0", "3"},
                 {"0", "0", "", "0", "3"},
                 {"5e-324", "5e-324", "1e-6", "5e-324", "1"},
                 {"1e6", "1", "1e6", "1e6", "1e6"}};
    for (int i = 0; i < 4; i += sampled(2)) {
        const char *n = cases[i].number, *rate = cases[i].rate, *divisor = cases[i].divisor;
        char text[1024];
        start_afresh();
        snprintf(text, sizeof text, TABLE1 "baseline,pair,adam,%s,%s,,%s,1\n", cases[i].needed, n, n);
        write_table("table1", text, strlen(text));
        snprintf(text, sizeof text, NETWORKS "best,best,,pair,%s,%s" NETWORK_END, n, n);
        write_table("networks", text, strlen(text));
        snprintf(text, sizeof text, RATES "baseline,single,range,rest,%s,%s,%s,%s,%s,1\n", rate, rate, rate, rate,
                 rate);
        write_table("rates", text, strlen(text));
        snprintf(text, sizeof text, CLOSED "a,single,0,%s,%s" CLOSED_END, n, divisor);
        write_table("closed_loop", text, strlen(text));
        snprintf(text, sizeof text, LAWS "all,%s,%s,%s,%s,%s,%s,%s,%s\n", n, n, n, divisor, n, n, n, n);
        write_table("laws", text, strlen(text));
        snprintf(text, sizeof text, TRANSFER "transfer,1,%s,%s,%s\n", cases[i].launches, n, n);
        write_table("transfer", text, strlen(text));
        draw();
        assert_int_equal(tells_of_values_beyond("factors"), i > 0);
    }
}

int main(void) {
    temporary_path(""); /* makes the folder */
    return _cmocka_run_group_tests("tests", tests_of_file, test_count, NULL, NULL);
}

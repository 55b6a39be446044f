/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Errors at equal time, of an invented chart. */
#include "charts.h"
#include "owned.h"

#include "studies/chart_table.h"
#include "studies/equal_time.h"
#include "studies/statistics.h"

OWNED_VALUE(EqualTime, equal_time_free)

/* A row of the impact in closed loop; median and 95th percentile are half and twice the mean. */
#define IMPACT(method, setting, us, mean, half, twice) \
    "tower," method "," setting ",closed,impact,5," us ",9," mean "," half "," twice ",1,1,0,,0,\n"
#define DRIFT(method, setting, drift) "tower," method "," setting ",closed,rest,5,1,9,0.1,0.1,0.1,1,1,0," drift ",0,0\n"

static const char chart[] = IMPACT("engine", "k=10", "4", "2", "1", "4") IMPACT("engine", "k=40", "16", "1", "0.5", "2")
    IMPACT("momentum", "k=20", "8", "0.8", "0.4", "1.6") IMPACT("momentum", "k=50", "20", "0.2", "0.1", "0.4")
        IMPACT("scene-net", "", "10", "0.1", "0.05", "0.2") IMPACT("scene-net", "net=off", "10", "0.5", "0.25", "1")
            IMPACT("interior", "near=0.02", "16", "0.01", "0.005", "0.02")
    /* What no method may be compared with. */
    IMPACT("reference", "", "2", "0.0001", "0.0001", "0.0001") IMPACT("playback", "", "1", "0.01", "0.01", "0.01")
        IMPACT("block", "k=5", "1", "0.01", "0.01", "0.01") DRIFT("block", "k=5", "0.6") DRIFT("engine", "k=10", "0.4");

static CsvTable read_chart(void) {
    CsvTable table;
    Error error = {0};
    assert_ok(csv_table_read(&table, write_chart(chart), &chart_layout, &error), error);
    return table;
}

typedef struct Expected {
    const char *method, *setting, *rival;
    CurveReach reach;
    double rival_error, ratio, time_momentum_20, error_scene_net;
} Expected;

static const Expected expected[] = {
    {"engine", "k=10", "", CURVE_BEFORE, NAN, NAN, 0.5, 20},
    {"engine", "k=40", "interior", CURVE_WITHIN, 0.01, 100, 2, 10},
    /* On the line from (4, 2) to (16, 1), halfway: sqrt(2). */
    {"momentum", "k=20", "engine", CURVE_WITHIN, 1.41421356237, 0.565685424949, 1, 8},
    {"momentum", "k=50", "interior", CURVE_BEYOND, 0.01, 20, 2.5, 2},
    /* Between momentum's (8, 0.8) and (20, 0.2). */
    {"scene-net", "", "momentum", CURVE_WITHIN, 0.570782694569, 0.175198023611, 1.25, 1},
    {"scene-net", "net=off", "momentum", CURVE_WITHIN, 0.570782694569, 0.875990118057, 1.25, 5},
    {"interior", "near=0.02", "momentum", CURVE_WITHIN, 0.280316837778, 0.0356739184105, 2, 0.1},
    {"block", "k=5", "", CURVE_BEFORE, NAN, NAN, 0.125, 0.1},
};

static void assert_same(double found, double value) {
    if (isnan(value))
        assert_true(isnan(found));
    else
        assert_near(found / value, 1, 1e-9);
}

TEST(every_setting_meets_its_best_rival_at_its_time) {
    static const double factors[] = {1, 0.5, 2};
    OWN(CsvTable) rows = read_chart();
    OWN(EqualTime) table;
    /* The line of logarithms from (8, 0.8) to (20, 0.2), at 10 and at 16. */
    assert_near(0.8 * pow(0.25, log(1.25) / log(2.5)), expected[4].rival_error, 1e-11);
    assert_near(0.8 * pow(0.25, log(2) / log(2.5)), expected[6].rival_error, 1e-11);
    assert_ok(equal_time_make(&table, rows.rows, rows.count, &error), error);
    assert_int_equal(table.count, CURVE_STATISTICS * (int)(sizeof expected / sizeof *expected));
    for (int i = 0; i < table.count; i++) {
        const EqualTimeRow *row = &table.rows[i];
        const Expected *want = &expected[i / CURVE_STATISTICS];
        assert_string_equal(row->method, want->method);
        assert_string_equal(row->setting, want->setting);
        assert_int_equal(row->statistic, i % CURVE_STATISTICS);
        if (strcmp(row->method, "block") != 0) {
            assert_string_equal(row->rival, want->rival);
            assert_int_equal(row->reach, want->reach);
            assert_same(row->rival_error, want->rival_error * factors[row->statistic]);
            assert_same(row->error_scene_net, want->error_scene_net);
        }
        assert_same(row->ratio, want->ratio);
        assert_same(row->time_momentum_20, want->time_momentum_20);
        assert_same(row->time_scene_net, row->us_solver / 10);
    }
}

/* At 20 microseconds, the time of momentum with 50 sweeps. */
TEST(methods_are_compared_at_one_time) {
    static const struct {
        const char *method, *rival;
        double error, ratio;
    } methods[] = {
        {"engine", "interior", 1, 100},       {"momentum", "interior", 0.2, 20},
        {"scene-net", "interior", 0.1, 10},   {"scene-net:net=off", "interior", 0.5, 50},
        {"interior", "momentum", 0.01, 0.05}, {"block", "interior", NAN, NAN}, /* lost the scene */
    };
    OWN(CsvTable) rows = read_chart();
    OWN(EqualTime) table;
    assert_ok(equal_time_make(&table, rows.rows, rows.count, &error), error);
    assert_string_equal(table.time, "k=50");
    assert_int_equal(table.method_count, sizeof methods / sizeof *methods);
    for (int i = 0; i < table.method_count; i++) {
        const EqualMethodRow *row = &table.methods[i];
        assert_string_equal(row->method, methods[i].method);
        assert_string_equal(row->rival, methods[i].rival);
        assert_true(row->us_solver == 20);
        assert_same(row->error, methods[i].error);
        assert_same(row->ratio, methods[i].ratio);
    }
}

/* A loss by four remains one where nobody can see it, and is marked; so is what only one of the two is below. */
TEST(errors_below_the_resolution_are_compared_as_they_are) {
    static const char small[] = IMPACT("momentum", "k=50", "20", "4e-5", "4e-5", "8e-5")
        IMPACT("interior", "near=0.02", "20", "1e-5", "2e-4", "3e-5");
    static const struct {
        double ratio;
        ErrorsBelow below;
    } wanted[] = {{4, BELOW_BOTH},    {0.2, BELOW_METHOD}, {8. / 3, BELOW_BOTH},
                  {0.25, BELOW_BOTH}, {5, BELOW_RIVAL},    {0.375, BELOW_BOTH}};
    OWN(CsvTable) rows;
    OWN(EqualTime) table;
    assert_ok(csv_table_read(&rows, write_chart(small), &chart_layout, &error), error);
    assert_ok(equal_time_make(&table, rows.rows, rows.count, &error), error);
    for (int i = 0; i < 6; i++) {
        assert_near(table.rows[i].ratio / wanted[i].ratio, 1, 1e-9);
        assert_int_equal(table.rows[i].below, wanted[i].below);
    }
    assert_int_equal(table.methods[0].below, BELOW_BOTH);
    assert_near(table.methods[0].ratio, 4, 1e-9);
}

/* The ratio stays. */
TEST(errors_below_the_floor_are_marked) {
    static const struct {
        double floor;
        ErrorsBelow below;
    } wanted[] = {{NAN, BELOW_NONE}, {0.005, BELOW_NONE}, {0.3, BELOW_RIVAL}, {0.9, BELOW_BOTH}};
    for (size_t k = 0; k < sizeof wanted / sizeof *wanted; k++) {
        OWN(CsvTable) rows = read_chart();
        OWN(EqualTime) table;
        for (int i = 0; i < rows.count; i++) ((ChartRow *)rows.rows + i)->floor = wanted[k].floor;
        assert_ok(equal_time_make(&table, rows.rows, rows.count, &error), error);
        assert_int_equal(table.methods[3].below, wanted[k].below); /* 0.5 m/s, its rival's 0.01 */
        assert_near(table.methods[3].ratio, 50, 1e-7);
    }
}

/* The most of 20, 50 and 100 sweeps that the chart has. */
TEST(the_time_is_that_of_the_most_sweeps) {
    static const char *const renamed[] = {"k=50", "k=50", "k=20"}, *const settings[] = {"k=100", "k=20", "k=100"};
    for (int k = 0; k < 3; k++) {
        OWN(CsvTable) rows = read_chart();
        OWN(EqualTime) table;
        for (int i = 0; i < rows.count; i++) {
            ChartRow *row = (ChartRow *)rows.rows + i;
            if (strcmp(row->method, "momentum") == 0 && strcmp(row->setting, renamed[k]) == 0)
                row->setting = settings[k];
        }
        assert_ok(equal_time_make(&table, rows.rows, rows.count, &error), error);
        assert_string_equal(table.time, settings[k]);
    }
}

RUN_TESTS(NULL, NULL)

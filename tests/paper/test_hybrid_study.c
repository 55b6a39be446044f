/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The quick learning of the single box, and claims from tables made by hand. */
#include "tables.h"

#include "learning/hybrid_training.h"
#include "paper/paper_internal.h"

#include <time.h>

/* The clock counts: reading it takes a microsecond more than its overhead, so each solution takes one. */
enum { READING = 7 }; /* ns */

int __real_clock_gettime(clockid_t clock, struct timespec *now);
int __wrap_clock_gettime(clockid_t clock, struct timespec *now);
int64_t __wrap_meter_time_overhead(void);

int __wrap_clock_gettime(clockid_t clock, struct timespec *now) {
    static _Thread_local int64_t ticks;
    if (clock != CLOCK_MONOTONIC) return __real_clock_gettime(clock, now);
    ticks += 1000 + READING;
    *now = (struct timespec){.tv_sec = ticks / 1000000000, .tv_nsec = ticks % 1000000000};
    return 0;
}

int64_t __wrap_meter_time_overhead(void) { return READING; }

/* A table from a part's lines, "system_hybrid:...". */
static CsvTable table_of(FILE *lines) {
    Error error = {0};
    CsvTable table;
    char line[1024];
    const char *path = temporary_path("system_hybrid.csv");
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    csv_header_print(file, &hybrid_layout);
    rewind(lines);
    while (fgets(line, sizeof line, lines) != NULL) {
        assert_memory_equal(line, "system_hybrid:", 14);
        fputs(line + 14, file);
    }
    fclose(file);
    assert_ok(csv_table_read(&table, path, &hybrid_layout, &error), error);
    return table;
}

TEST(a_learning_has_rows_that_fit_together) {
    const SystemStudy study = {.scenes = SOURCE_DIR "/scenes", .quick = true, .seed = 1};
    FILE *lines = tmpfile();
    assert_non_null(lines);
    assert_ok(system_hybrid.parts[0].write(&study, system_hybrid.parts[0].index, lines, NULL, &error), error);
    CsvTable table = table_of(lines);
    fclose(lines);
    const HybridRow *rows = table.rows;
    assert_int_equal(table.count, 3);
    assert_near(rows[0].launches, HYBRID_FIRST, 0);
    assert_near(rows[0].share, 0, 0);
    for (int i = 0; i < table.count; i++) {
        assert_int_equal(rows[i].scene, 0);
        assert_int_equal(rows[i].changes, 0);
        assert_true(rows[i].share_all <= rows[i].share);
        assert_near(rows[i].us_step, 1, 1e-9);
        assert_near(rows[i].us_step_solve, 1, 1e-9);
        assert_near(rows[i].us_question, 0, 1e-9);
        assert_true(isnan(rows[i].us_answer) || fabs(rows[i].us_answer - 1) < 1e-9);
        assert_true(isnan(rows[i].us_solve) || fabs(rows[i].us_solve - 1) < 1e-9);
        assert_true(isnan(rows[i].error) || rows[i].error <= rows[i].error_95);
        assert_true(i == 0 || (rows[i].entries > rows[i - 1].entries && rows[i].kib > rows[i - 1].kib &&
                               rows[i].learning_ms > rows[i - 1].learning_ms));
        assert_true(isnan(rows[i].paid) == (rows[i].saved_ms < 0));
    }
    csv_table_free(&table);
}

/* Of the three scenes, before and after a change; the claims' verdicts in order. */
static void expect_verdicts_of(const HybridRow *like, double share_after, const char *verdicts) {
    Error error = {0};
    HybridRow rows[9];
    static const int scenes[] = {0, 1, 3};
    for (int i = 0; i < 9; i++) {
        rows[i] = *like;
        rows[i].scene = scenes[i % 3];
        rows[i].changes = i >= 3;
        rows[i].turned = i >= 6;
        if (i >= 6) rows[i].share = share_after;
    }
    assert_ok(csv_table_write(temporary_path("system_hybrid.csv"), &hybrid_layout, rows, 9, &error), error);
    expect_verdicts(&system_hybrid, verdicts);
}

TEST(verdicts_follow_from_the_table) {
    HybridRow row = {.tolerance = 0.1,
                     .launches = 1000,
                     .share = 0.6,
                     .share_all = 0.1,
                     .error = 0.02,
                     .error_95 = 0.08,
                     .us_answer = 1,
                     .us_solve = 10,
                     .us_question = 1,
                     .us_step = 4,
                     .us_step_solve = 10,
                     .entries = 5,
                     .kib = 6,
                     .learning_ms = 7,
                     .saved_ms = 8,
                     .paid = 300};
    expect_verdicts_of(&row, 0.4, "yes yes yes yes yes");
    row.share = 0.4;
    row.error_95 = 0.2;
    row.us_step = 8;
    row.paid = NAN;
    expect_verdicts_of(&row, 0.1, "no no no no no");
}

RUN_TESTS(NULL, NULL)

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* paper/systems: the study of sain, and its claims on made-up tables. */
#include "tables.h"

#include "paper/paper_internal.h"

/* The same part twice: the same rows, one for each form and scene. */
TEST(a_part_is_repeatable) {
    static char texts[2][2048];
    const SystemStudy study = {SOURCE_DIR "/scenes", true, 1};
    for (int run = 0; run < 2; run++) {
        FILE *lines = tmpfile();
        assert_non_null(lines);
        assert_ok(system_sain.parts[0].write(&study, system_sain.parts[0].index, lines, NULL, &error), error);
        rewind(lines);
        assert_true(fread(texts[run], 1, sizeof texts[run] - 1, lines) > 0);
        fclose(lines);
    }
    assert_string_equal(texts[0], texts[1]);
    int rows = 0;
    for (const char *at = texts[0]; (at = strchr(at, '\n')) != NULL; at++) rows++;
    assert_int_equal(rows, SAIN_FORMS * SAIN_SCENES);
}

/* Errors of the forms: proportional to `on` and so on, in each scene and for each number of launches. */
static void expect_verdicts_of(double on, double off, double shuffled, const char *verdicts) {
    const double errors[SAIN_FORMS] = {on, off, shuffled};
    SainRow rows[SAIN_FORMS * SAIN_SCENES * 2];
    int count = 0;
    Error error = {0};
    for (int launches = 1; launches <= 16; launches *= 16)
        for (int form = 0; form < SAIN_FORMS; form++)
            for (int scene = 0; scene < SAIN_SCENES; scene++)
                rows[count++] = (SainRow){scene, form, launches, 1, errors[form], 2, 3};
    assert_ok(csv_table_write(temporary_path("system_sain.csv"), &sain_layout, rows, count, &error), error);
    expect_verdicts(&system_sain, verdicts);
}

TEST(verdicts_follow_from_the_table) {
    expect_verdicts_of(1, 2, 3, "yes yes yes yes");
    expect_verdicts_of(1.99, 1, 3, "no yes partly partly");
    expect_verdicts_of(5, 4, 4, "no no no no");
}

TEST(medians_leave_out_other_rows) {
    SainRow rows[] = {{SAIN_STACK, SAIN_WITH_ENGINE, 4, 1, 3, 0, 0},
                      {SAIN_STACK, SAIN_WITH_ENGINE, 4, 2, 1, 0, 0},
                      {SAIN_STACK, SAIN_WITH_ENGINE, 4, 3, 2, 0, 0},
                      {SAIN_PYRAMID, SAIN_WITH_ENGINE, 4, 1, 9, 0, 0},
                      {SAIN_STACK, SAIN_ALONE, 4, 1, 9, 0, 0}};
    const CsvTable table = {.rows = rows, .count = 5};
    assert_near(sain_median(&table, SAIN_STACK, SAIN_WITH_ENGINE, 4, sain_error), 2, 0);
    assert_true(isnan(sain_median(&table, SAIN_STACK, SAIN_SHUFFLED, 4, sain_error)));
    assert_int_equal(sain_most_launches(&table), 4);
}

RUN_TESTS(NULL, NULL)

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The report of small tables, with captions but without pictures: it links these only. */
#include "files.h"
#include "owned.h"
#include "tables.h"

#include "base/file.h"
#include "paper/paper_report.h"

static void make_study(void) {
    static const char *const tables[] = {"table1", "networks", "constants", "rates",        "closed_loop",
                                         "laws",   "transfer", "study",     "system_scores"};
    static const char *const figures[] = {"loop",    "narrow-phase", "data",        "scenes", "loss",
                                          "factors", "rates",        "closed-loop", "laws",   "transfer"};
    Error error = {0};
    folder();
    remove(temporary_path("report.md"));
    for (size_t i = 0; i < sizeof tables / sizeof *tables; i++) {
        FREED char *text = text_of(printed("%s/tests/paper/report/%s.csv", SOURCE_DIR, tables[i]));
        write_text(printed("%s.csv", tables[i]), text);
    }
    assert_ok(file_make_directory(temporary_path("figures"), &error), error);
    for (size_t i = 0; i < sizeof figures / sizeof *figures; i++)
        write_text(printed("figures/%s.txt", figures[i]), "Boxes at 5 µs.\n");
}

static void expect_text(const char *text, const char *wanted) {
    if (strstr(text, wanted) == NULL) fail_msg("the report lacks \"%s\"", wanted);
}

TEST(tables_and_captions_are_shown) {
    make_study();
    assert_ok(paper_report_write(folder(), &error), error);
    FREED char *text = text_of(temporary_path("report.md"));
    expect_text(text, "![narrow-phase](figures/narrow-phase.png)\n\nBoxes at 5 µs.\n");
    expect_text(
        text,
        "[transfer.csv](transfer.csv): 12 rows\n\n| start | seed | launches | error\\_m\\_s | constant\\_m\\_s |\n"
        "|---|---|---|---|---|\n| scratch | 1 | 1 | 4 | 3.5 |\n");
    expect_text(text, "| engine |  |  |  |  | 0 | 0.01 | 0.02 | 0 |");
    /* No character of a field has a meaning to Markdown. */
    expect_text(text, "| note | \\<script\\>alert(1)\\</script\\> of a name");
    expect_text(text, "| marks | \\*a\\* \\_b\\_ c\\_d \\[e\\](f) \\| \\`g\\` \\& \\$h\\$ \\~i\\~ \\\\ |");
}

TEST(a_long_table_is_linked_only) {
    make_study();
    FILE *file = fopen(temporary_path("transfer.csv"), "w");
    assert_non_null(file);
    fputs("start,seed,launches,error,constant\n", file);
    for (int i = 0; i < 1000; i++) fprintf(file, "scratch,%d,77,1,2\n", i);
    assert_int_equal(fclose(file), 0);
    assert_ok(paper_report_write(folder(), &error), error);
    FREED char *text = text_of(temporary_path("report.md"));
    expect_text(text, "[transfer.csv](transfer.csv): 1000 rows\n");
    assert_null(strstr(text, "| 77 |"));
}

TEST(nothing_is_written_where_a_part_is_missing) {
    make_study();
    remove(temporary_path("laws.csv"));
    assert_refused(paper_report_write(folder(), &error), "laws.csv: error: cannot open");
    make_study();
    remove(temporary_path("figures/rates.txt"));
    assert_refused(paper_report_write(folder(), &error), "figures/rates.txt: error: cannot open");
    make_study();
    write_text("rates.csv", "network,scene\nx\n");
    assert_refused(paper_report_write(folder(), &error), "rates.csv:2:");
    assert_int_equal(access(temporary_path("report.md"), F_OK), -1);
}

RUN_TESTS(NULL, NULL)

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "folder_faults.h"
#include "testing.h"

#include "common/file.h"
#include "study/study_parts.h"

/* A part that counts its runs. */
typedef struct Counted {
    const char *lines;
    int done;
    bool stopped, fails;
} Counted;

static bool write_counted(void *context, FILE *lines, const Progress *progress, Error *error) {
    Counted *counted = context;
    counted->done++;
    counted->stopped = !progress_report(progress, 1, 2);
    fputs(counted->lines, lines);
    return !counted->fails || error_input(error, "part", "failed");
}

static void open_parts(StudyParts *parts, const char *folder) {
    Error error = {0};
    *parts = (StudyParts){.total = 4};
    assert_ok(study_parts_open(parts, folder, 0x1234, &error), error);
}

static void tables_have_the_order_of_the_parts(void **state) {
    (void)state;
    Error error = {0};
    char folder[300];
    snprintf(folder, sizeof folder, "%s", temporary_path("tables"));
    StudyParts parts;
    open_parts(&parts, folder);
    Counted first = {"a:1,2\nab:3\n", 0, false, false}, second = {"ab:4\na:5,6\n", 0, false, false};
    static const CsvColumn columns[] = {{"x", CSV_INTEGER, .offset = 0}, {"y", CSV_INTEGER, .offset = sizeof(int)}};
    static const CsvLayout layout = CSV_LAYOUT("a", columns, int[2], .max_rows = 9);
    assert_ok(study_parts_do(&parts, &(StudyPart){"first", 1, write_counted, &first}, &error), error);
    assert_ok(study_parts_do(&parts, &(StudyPart){"second", 3, write_counted, &second}, &error), error);
    assert_near(parts.done, 4, 0);
    assert_ok(study_parts_table(&parts, folder, &layout, &error), error);
    char path[sizeof parts.folder + 8];
    size_t size;
    snprintf(path, sizeof path, "%s/a.csv", folder);
    char *text = file_read(path, 1000, &size, &error);
    assert_ok(text != NULL, error);
    assert_string_equal(text, "x,y\n1,2\n5,6\n");
    free(text);
    /* What cannot be removed is reported. */
    snprintf(path, sizeof path, "%s/other", parts.folder);
    assert_ok(file_make_directory(path, &error), error);
    assert_false(study_parts_remove(&parts, &error));
    assert_error(error, ERROR_SYSTEM, "cannot be removed");
    error = (Error){0};
    assert_int_equal(rmdir(path), 0);
    assert_ok(study_parts_remove(&parts, &error), error);
    assert_int_equal(access(parts.folder, F_OK), -1);
    study_parts_close(&parts);
}

static void a_row_is_a_line_with_the_tables_name(void **state) {
    (void)state;
    static const CsvColumn columns[] = {{"x", CSV_TEXT, .offset = 0}};
    static const CsvLayout layout = CSV_LAYOUT("names", columns, const char *, .max_rows = 9);
    Error error = {0};
    char *text = NULL;
    size_t size;
    FILE *lines = open_memstream(&text, &size);
    assert_ok(study_parts_print(lines, &layout, &(const char *){"a,b"}, &error), error);
    assert_false(study_parts_print(lines, &layout, &(const char *){"a\nb"}, &error));
    assert_error(error, ERROR_INPUT, "names: error: x: a control character in 'a?b'");
    fclose(lines);
    assert_string_equal(text, "names:\"a,b\"\nnames:");
    free(text);
}

static void finished_parts_are_not_run_again(void **state) {
    (void)state;
    Error error = {0};
    const char *folder = temporary_path("again");
    Counted counted = {"t:1\n", 0, false, false};
    char *texts[2];
    for (int run = 0; run < 2; run++) {
        StudyParts parts;
        open_parts(&parts, folder);
        assert_ok(study_parts_do(&parts, &(StudyPart){"only", 1, write_counted, &counted}, &error), error);
        texts[run] = strdup(parts.text);
        study_parts_close(&parts);
    }
    assert_int_equal(counted.done, 1);
    assert_string_equal(texts[0], texts[1]);
    free(texts[0]);
    free(texts[1]);
}

static bool stop(void *context, double done, double total) {
    *(double *)context = done / total;
    return false;
}

/* The first part has a weight of a quarter; half of it was run. */
static void an_interrupted_part_is_not_saved(void **state) {
    (void)state;
    Error error = {0};
    const char *folder = temporary_path("cut");
    Counted counted = {"t:1\n", 0, false, false};
    const StudyPart part = {"only", 1, write_counted, &counted};
    StudyParts parts;
    double share = 0;
    open_parts(&parts, folder);
    parts.progress = &(Progress){stop, &share};
    assert_false(study_parts_do(&parts, &part, &error));
    assert_error(error, ERROR_INTERRUPTED, "stopped");
    assert_near(share, 0.125, 0);
    assert_true(counted.stopped);
    study_parts_close(&parts);
    open_parts(&parts, folder);
    error = (Error){0};
    counted.fails = true;
    assert_false(study_parts_do(&parts, &part, &error));
    assert_error(error, ERROR_INPUT, "part: error: failed");
    study_parts_close(&parts);
    open_parts(&parts, folder);
    counted.fails = false;
    error = (Error){0};
    assert_ok(study_parts_do(&parts, &part, &error), error);
    assert_int_equal(counted.done, 3);
    study_parts_close(&parts);
}

/* A part that cannot be read is not done again as if it were missing, and no failure looks like the folder's end. */
static void failures_of_the_folder_are_errors(void **state) {
    (void)state;
    Error error = {0};
    StudyParts parts;
    Counted part = {"a:1\n", 0, false, false};
    open_parts(&parts, temporary_path("faults"));
    assert_ok(study_parts_do(&parts, &(StudyPart){"part", 1, write_counted, &part}, &error), error);
    failing_readdir = 1;
    assert_false(study_parts_remove(&parts, &error));
    assert_error(error, ERROR_SYSTEM, "cannot be read: Input/output error");
    failing_opendir = 1;
    error = (Error){0};
    assert_false(study_parts_remove(&parts, &error));
    assert_error(error, ERROR_SYSTEM, "cannot be read: Input/output error");
    failing_stat = 1;
    error = (Error){0};
    assert_false(study_parts_do(&parts, &(StudyPart){"part", 1, write_counted, &part}, &error));
    assert_error(error, ERROR_SYSTEM, "part: error: cannot be read: Input/output error");
    assert_int_equal(part.done, 1);
    failing_opendir = failing_readdir = failing_stat = 0;
    error = (Error){0};
    assert_ok(study_parts_remove(&parts, &error), error);
    study_parts_close(&parts);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(failures_of_the_folder_are_errors), cmocka_unit_test(tables_have_the_order_of_the_parts),
        cmocka_unit_test(a_row_is_a_line_with_the_tables_name), cmocka_unit_test(finished_parts_are_not_run_again),
        cmocka_unit_test(an_interrupted_part_is_not_saved)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

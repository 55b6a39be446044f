/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "owned.h"

#include "base/csv.h"

static const char *write_table(const char *text, size_t size) {
    return write_bytes(temporary_path("table.csv"), text, size);
}

static Csv read_good(const char *text) {
    Error error = {0};
    Csv csv;
    assert_ok(csv_read(&csv, write_table(text, strlen(text)), 1000, 1, 3, &error), error);
    return csv;
}

TEST(fields_are_found_and_unquoted) {
    static const char *const texts[] = {
        "a,b\n\"x,\"\"y\"\"\",\n\"\",\"c\"\n",
        "a,b\r\n\"x,\"\"y\"\"\",\r\n\"\",\"c\"",
        ("\xef\xbb\xbf"
         "a,b\n\"x,\"\"y\"\"\",\n,\"c\""),
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        Csv csv = read_good(texts[i]);
        assert_int_equal(csv.width, 2);
        assert_int_equal(csv.rows, 3);
        assert_string_equal(csv_text(&csv, 0, 0), "a");
        assert_string_equal(csv_text(&csv, 0, 1), "b");
        assert_string_equal(csv_text(&csv, 1, 0), "x,\"y\"");
        assert_string_equal(csv_text(&csv, 1, 1), "");
        assert_string_equal(csv_text(&csv, 2, 0), "");
        assert_string_equal(csv_text(&csv, 2, 1), "c");
        csv_free(&csv);
    }
}

TEST(errors_name_line_and_column_in_characters) {
    Csv csv = read_good("a,b,c\n\"1,\",\xc3\xa4\xc3\xb6,2\n");
    assert_refused(csv_error(&csv, 1, 2, &error, "not %d", 7), "table.csv:2:9: error: not 7");
    csv_free(&csv);
}

TEST(broken_tables_are_refused_with_their_place) {
#define CASE(text, message) \
    { text, sizeof(text) - 1, message }
    static const struct {
        const char *text;
        size_t size;
        const char *message;
    } cases[] = {
        CASE("", "table.csv:1:1: error: the file is empty"),
        CASE("a,b\n", "table.csv:2:1: error: the table has no rows"),
        CASE("a,b\n1,2,3\n", "table.csv:2:1: error: 3 fields, but the header has 2"),
        CASE("a,b\n1,2\n1\n", "table.csv:3:1: error: 1 field, but the header has 2"),
        CASE("a,b\n\n1,2\n", "table.csv:2:1: error: the line is empty"),
        CASE("\r\na\r\n", "table.csv:1:1: error: the line is empty"),
        CASE("a\n1\n2\n3\n4\n", "table.csv:5:1: error: the table has more than 3 rows"),
        CASE("a,b\n1,2\0\n", "table.csv:2:4: error: control character 0x00"),
        CASE("a,b\n1,\t2\n", "table.csv:2:3: error: control character 0x09"),
        CASE("a,b\n1,2\r", "table.csv:2:4: error: control character 0x0d"),
        CASE("a,b\n1,2\r3\n", "table.csv:2:4: error: control character 0x0d"),
        CASE("a,b\n1,x\"y\"\n", "table.csv:2:4: error: a quote inside a field"),
        CASE("a,b\n1,\"x\n\"\n", "table.csv:2:3: error: this quote is not closed"),
        CASE("a,b\n1,\"x", "table.csv:2:3: error: this quote is not closed"),
        CASE("a,b\n\"1\"2,x\n", "table.csv:2:4: error: expected a comma after the closing quote"),
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Csv csv;
        assert_refused(csv_read(&csv, write_table(cases[i].text, cases[i].size), 1000, 1, 3, &error), cases[i].message);
    }
}

TEST(what_is_put_is_read_again) {
    static const char *const texts[] = {"k=20", "k=20,warm=off", "say \"k\"", "\"", ",", "", " a "};
    enum { COUNT = sizeof texts / sizeof *texts };
    FREED char *data = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&data, &size);
    assert_non_null(file);
    for (int row = 0; row < 2; row++)
        for (int i = 0; i < COUNT; i++) {
            csv_put(file, texts[i], false);
            fputc(i + 1 < COUNT ? ',' : '\n', file);
        }
    fclose(file);
    Csv csv = read_good(data);
    assert_int_equal(csv.width, COUNT);
    for (int i = 0; i < COUNT; i++) assert_string_equal(csv_text(&csv, 1, i), texts[i]);
    csv_free(&csv);
}

RUN_TESTS(NULL, NULL)

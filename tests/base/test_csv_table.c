/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "owned.h"

#include "files.h"
#include "base/csv.h"

typedef enum Colour { RED, GREEN, BLUE } Colour;

typedef struct Row {
    const char *text, *name;
    Colour word;
    int integer;
    float single;
    double number, optional;
} Row;

static const char *const colours[] = {"red", "green", "blue", NULL};

static const CsvColumn columns[] = {
    {"text", CSV_TEXT, .offset = offsetof(Row, text), .maximum = 12, .key = true},
    {"name", CSV_NAME, .offset = offsetof(Row, name), .quoted = true},
    {"word", CSV_WORD, .offset = offsetof(Row, word), .words = colours, .key = true},
    {"integer", CSV_INTEGER, .offset = offsetof(Row, integer), .minimum = -5, .maximum = 1e6},
    {"single", CSV_FLOAT, .offset = offsetof(Row, single), -1e6, 1e6},
    {"number", CSV_NUMBER, .offset = offsetof(Row, number), .minimum = 0, .maximum = INFINITY, .digits = 9},
    {"optional", CSV_OPTIONAL, .offset = offsetof(Row, optional), .minimum = -1, .maximum = 1},
};

enum { TEXT, NAME, WORD, INTEGER, SINGLE, NUMBER, OPTIONAL };

#define HEADER "text,name,word,integer,single,number,optional\n"

/* The same file, by each rule for its header. */
static const CsvLayout all = CSV_LAYOUT("rows", columns, Row, .max_rows = 3);
static const CsvLayout exact = CSV_LAYOUT("rows", columns, Row, .min_rows = 1, .max_rows = 3, .header = CSV_EXACT);
static const CsvLayout subset = CSV_LAYOUT("rows", columns, Row, .min_rows = 1, .max_rows = 3, .header = CSV_SUBSET);

/* The last column came later. */
static const CsvColumn later[] = {
    {"integer", CSV_INTEGER, .offset = offsetof(Row, integer), .maximum = 9},
    {"text", CSV_TEXT, .offset = offsetof(Row, text), .maximum = 12, .optional = true},
};
static const CsvLayout grown = CSV_LAYOUT("rows", later, Row, .max_rows = 3, .header = CSV_EXACT);

static const char *write_file(const char *text) { return write_bytes(temporary_path("rows.csv"), text, strlen(text)); }

static CsvTable read_good(const CsvLayout *layout, const char *text) {
    Error error = {0};
    CsvTable table;
    assert_ok(csv_table_read(&table, write_file(text), layout, &error), error);
    return table;
}

static void expect_refused(const CsvLayout *layout, const char *text, const char *message) {
    Error error = {0};
    CsvTable table;
    assert_refused(csv_table_read(&table, write_file(text), layout, &error), message);
    assert_null(table.rows);
}

TEST(each_kind_fills_its_member) {
    OWN(CsvTable) table = read_good(&exact, HEADER "\"a,\"\"b\xc3\xa4\",x [m],blue,-5,1/3,1e30,-0.5\n,,red,7,2,0,\n");
    const Row *rows = table.rows;
    assert_int_equal(table.count, 2);
    assert_string_equal(rows[0].text, "a,\"b\xc3\xa4");
    assert_string_equal(rows[0].name, "x [m]");
    assert_int_equal(rows[0].word, BLUE);
    assert_int_equal(rows[0].integer, -5);
    assert_true(rows[0].single == 1.0f / 3);
    assert_true(rows[0].number == 1e30 && rows[0].optional == -0.5);
    assert_string_equal(rows[1].text, "");
    assert_string_equal(rows[1].name, "");
    assert_int_equal(rows[1].word, RED);
    assert_true(isnan(rows[1].optional));
}

/* No spreadsheet computes a name; read back, it is the same. Numbers stay numbers. */
TEST(names_are_no_formulas) {
    static const char *const texts[] = {"=1+1", "@SUM(A1)", "+a", "-2-3", "'=x", "-0.5", "a=1"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        const Row row = {.text = texts[i], .name = "", .word = RED};
        const char *path = temporary_path("names.csv");
        assert_ok(csv_table_write(path, &all, &row, 1, &error), error);
        size_t size;
        FREED char *written = read_whole(path, &size);
        const char *field = strchr(written, '\n') + 1;
        assert_int_equal(*field == '\'', i < 5);
        CsvTable table;
        assert_ok(csv_table_read(&table, path, &all, &error), error);
        assert_string_equal(((const Row *)table.rows)->text, texts[i]);
        csv_table_free(&table);
    }
}

TEST(columns_are_found_by_name) {
    CsvTable table =
        read_good(&all, "optional,word,more,more,text,integer,number,single,name\n1,green,,\"x;y\",t,1,2,3,n\n");
    const Row *row = table.rows;
    assert_string_equal(row->text, "t");
    assert_string_equal(row->name, "n");
    assert_true(row->word == GREEN && row->integer == 1 && row->single == 3 && row->number == 2 && row->optional == 1);
    csv_table_free(&table);
    table = read_good(&subset, "number,integer\n2,1\n");
    row = table.rows;
    assert_true(row->number == 2 && row->integer == 1 && row->single == 0 && row->text == NULL);
    assert_int_equal(table.fields[INTEGER], 1);
    assert_int_equal(table.fields[TEXT], -1);
    csv_table_free(&table);
}

TEST(other_headers_are_refused) {
    expect_refused(&all, "text,name\na,b\n", "rows.csv:1:1: error: the column 'word' is missing");
    expect_refused(&all, "name,text,name\na,b,c\n", "rows.csv:1:11: error: the column 'name' appears twice");
    expect_refused(&exact, "text,name\na,b\n", "rows.csv:1:1: error: the column 'word' is missing");
    expect_refused(&exact, "text,word\na,b\n", "rows.csv:1:6: error: column 2 must be 'name' (got 'word')");
    expect_refused(&exact, "text,name,word,integer,single,number,optional,x\n1,2,3,4,5,6,7,8\n",
                   "rows.csv:1:47: error: unknown column 'x'; the columns are text, name, word, integer, single, "
                   "number, optional");
    expect_refused(&exact, "text,name,word,integer,single,number,optional,name\n1,2,3,4,5,6,7,8\n",
                   "rows.csv:1:47: error: the column 'name' appears twice");
    expect_refused(&subset, "word,\n1,2\n", "rows.csv:1:6: error: unknown column ''; the columns are text");
    expect_refused(&subset, "Word\n1\n", "rows.csv:1:1: error: unknown column 'Word'");
    expect_refused(&subset, "word,text,word\n1,2,3\n", "rows.csv:1:11: error: the column 'word' appears twice");
}

TEST(wrong_fields_are_refused_with_their_place) {
    static const struct {
        const char *row, *message;
    } cases[] = {
        {"0123456789abc,n,red,1,2,3,\n", "2:1: error: text: '0123456789abc' is longer than 12 bytes"},
        {"t,0123456789012345678901234567890123456789,red,1,2,3,\n", "2:3: error: name: '01234567890123456789012345678"
                                                                    "90123456789' is longer than 39 bytes"},
        {"t,a;b,red,1,2,3,\n", "2:3: error: name: 'a;b' may only have letters, digits, spaces and -_.,:=+/()*[]"},
        {"\xc3\xa4,\xc3\xa4\xc2\x85,red,1,2,3,\n", "2:3: error: name: '\?\?\?\?' may only have"}, /* a control */
        {"t,n,Red,1,2,3,\n", "2:5: error: word: 'Red' is not one of red, green, blue"},
        {"t,n,,1,2,3,\n", "2:5: error: word: the field is empty"},
        {"t,n,red,1.5,2,3,\n", "2:9: error: integer: '1.5' is not a whole number"},
        {"t,n,red,99999999999,2,3,\n", "2:9: error: integer: '99999999999' is greater than 1e+06"},
        {"t,n,red,-6,2,3,\n", "2:9: error: integer: '-6' is less than -5"},
        {"t,n,red,1, nan,3,\n", "2:11: error: single: ' nan' is not a number"},
        {"t,n,red,1,-2e6,3,\n", "2:11: error: single: '-2e6' is less than -1e+06"},
        {"t,n,red,1,2,,\n", "2:13: error: number: the field is empty"},
        {"t,n,red,1,2,inf,\n", "2:13: error: number: 'inf' is not a number"},
        {"t,n,red,1,2,-0.5,\n", "2:13: error: number: '-0.5' is less than 0"},
        {"t,n,red,1,2,3,1.5\n", "2:15: error: optional: '1.5' is greater than 1"},
        {"t,n,red,1,2,3,x\n", "2:15: error: optional: 'x' is not a number"},
        {"t,n,red,1,2,3\n", "2:1: error: 6 fields, but the header has 7"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        expect_refused(&all, printed(HEADER "%s", cases[i].row), cases[i].message);
    }
}

TEST(rows_are_limited_in_number) {
#define ROW(text) text ",n,red,1,2,3,\n"
    CsvTable table = read_good(&all, HEADER);
    assert_int_equal(table.count, 0);
    csv_table_free(&table);
    expect_refused(&exact, HEADER, "rows.csv:2:1: error: the table has no rows");
    expect_refused(&all, "", "rows.csv:1:1: error: the file is empty");
    table = read_good(&all, HEADER ROW("a") ROW("b") ROW("c"));
    assert_int_equal(table.count, 3);
    csv_table_free(&table);
    expect_refused(&all, HEADER ROW("a") ROW("b") ROW("c") ROW("d"), "rows.csv:5:1: error: the table has more than 3");
}

TEST(keys_are_not_repeated) {
    CsvTable table = read_good(&all, HEADER ROW("b") "b,n,blue,1,2,3,\n" ROW("a"));
    csv_table_free(&table);
    expect_refused(&all, HEADER ROW("b") ROW("a") "b,other,red,2,3,4,0\n",
                   "rows.csv:4:1: error: the row repeats that of line 2");
}

TEST(errors_point_at_a_field) {
    OWN(CsvTable) table = read_good(&subset, "number,name\n2,\"a,b\"\n3,c\n");
    assert_refused(csv_table_error(&table, 1, NAME, &error, "not %d", 7), "rows.csv:3:3: error: not 7");
    assert_refused(csv_table_error(&table, 0, WORD, &error, "no word"), "rows.csv:2:1: error: no word");
}

static const Row written[] = {{"k=20,b=\"c\"", "x [m]", GREEN, -5, 0.1f, 1234567.8912, -0.12345678},
                              {"", "", RED, 0, -3, 0, NAN}};

TEST(written_tables_are_read_back) {
    const char *path = temporary_path("written.csv");
    assert_ok(csv_table_write(path, &exact, written, 2, &error), error);
    assert_file(path, HEADER "\"k=20,b=\"\"c\"\"\",\"x [m]\",green,-5,0.1,1234567.89,-0.123457\n,\"\",red,0,-3,0,\n");
    OWN(CsvTable) table;
    assert_ok(csv_table_read(&table, path, &exact, &error), error);
    const Row *rows = table.rows;
    assert_string_equal(rows[0].text, written[0].text);
    assert_string_equal(rows[0].name, written[0].name);
    assert_true(rows[0].word == GREEN && rows[0].integer == -5 && rows[0].single == 0.1f);
    assert_true(rows[0].number == 1234567.89 && rows[0].optional == -0.123457);
    assert_true(isnan(rows[1].optional));
}

TEST(unreadable_values_are_not_written) {
    Row rows[4] = {written[0], written[0], written[0], written[0]};
    static const char *const messages[] = {"text: a control character in 'a?b'", "number: inf cannot be written",
                                           "number: nan cannot be written", "optional: -inf cannot be written"};
    rows[0].text = "a\nb";
    rows[1].number = INFINITY;
    rows[2].number = NAN;
    rows[3].optional = -INFINITY;
    for (int i = 0; i < 4; i++) {
        const char *path = temporary_path("unwritten.csv");
        assert_refused(csv_table_write(path, &exact, &rows[i], 1, &error), "unwritten.csv: error: ", messages[i]);
        assert_int_equal(access(path, F_OK), -1);
        FREED char *text = NULL;
        size_t size;
        FILE *stream = open_memstream(&text, &size);
        assert_refused(csv_row_print(stream, &exact, &rows[i], &error), messages[i]);
        fclose(stream);
        assert_int_equal(size, 0);
    }
}

TEST(an_optional_column_may_be_missing) {
    CsvTable table = read_good(&grown, "integer\n3\n");
    assert_int_equal(((Row *)table.rows)->integer, 3);
    assert_string_equal(((Row *)table.rows)->text, "");
    csv_table_free(&table);
    table = read_good(&grown, "integer,text\n3,a\n");
    assert_string_equal(((Row *)table.rows)->text, "a");
    csv_table_free(&table);
    assert_refused(csv_table_read(&table, write_file("text\na\n"), &grown, &error),
                   "rows.csv:1:1: error: column 1 must be 'integer' (got 'text')");
}

RUN_TESTS(NULL, NULL)

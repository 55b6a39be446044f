/* SPDX-License-Identifier: GPL-3.0-or-later */
/* CSV files (RFC 4180), as lines of fields (Csv) and as rows of structs (CsvTable). */
#pragma once
#include "base/base.h"

#include <stdio.h>

/* A header line, then rows with the same number of fields. Fields are separated by commas. A field in double quotes may
   contain commas and doubled quotes. */

typedef struct CsvField {
    const char *text; /* without its quotes */
    int column;       /* in the line, in characters from 1 */
} CsvField;

typedef struct Csv {
    char *path;
    int width;        /* fields of each line */
    int rows;         /* lines, the header included: row 0; row i is line i + 1 */
    CsvField *fields; /* [rows][width] */
    char *text;       /* that the fields point into */
} Csv;

/* Reads a file of at most max_size bytes with min_rows (0 or 1) to max_rows lines after the header. Line ends are LF or
   CRLF; a byte order mark is dropped. Refused, with path:line:column: control characters (so no field contains a line
   end), empty lines, lines with more or fewer fields than the header, stray quotes. On failure nothing is to be
   freed. */
bool csv_read(Csv *csv, const char *path, size_t max_size, int min_rows, int max_rows, Error *error);
void csv_free(Csv *csv);

const char *csv_text(const Csv *csv, int row, int field);

/* Sets an input error "path:line:column: error: text"; with column 0 "path:line: error: text". Returns false. */
bool csv_fail(const char *path, int line, int column, Error *error, const char *format, ...) PRINTF_LIKE(5, 6);

/* The same at a field. */
bool csv_error(const Csv *csv, int row, int field, Error *error, const char *format, ...) PRINTF_LIKE(5, 6);

/* A text for a message: all but printable ASCII becomes '?', and a long text ends in "...". */
typedef struct CsvShown {
    char text[48];
} CsvShown;
CsvShown csv_show(const char *text);

/* Writes a field, in quotes if it needs them or `quoted` is set. */
void csv_put(FILE *file, const char *text, bool quoted);

/* Whether a spreadsheet takes the text for a formula, or its first apostrophe for its own. Texts of tables that it does
   are written behind an apostrophe, which it takes for "this is text", and read without. */
bool csv_is_computed(const char *text);

/* Rows of structs, read from and written to CSV files. The module that writes a file declares its layout
   once, as a constant beside the row's struct; writers and readers share it:

     typedef struct RateRow {
         const char *network;
         int phase;   // index into phase_words
         double rate; // 0 to 1, or NAN
     } RateRow;

     static const CsvColumn rate_columns[] = {
         CSV_MEMBER(RateRow, network, CSV_NAME),
         CSV_MEMBER(RateRow, phase, CSV_WORD, .words = phase_words),
         CSV_MEMBER(RateRow, rate, CSV_OPTIONAL, .maximum = 1),
     };
     const CsvLayout rate_layout = CSV_LAYOUT("rates", rate_columns, RateRow, .min_rows = 1, .max_rows = 5000);
*/

enum { CSV_NAME_SIZE = 40, CSV_MAX_COLUMNS = 32, CSV_PATH_SIZE = 4096 };

/* What a field holds, and the type of the member that takes it. */
typedef enum CsvKind {
    CSV_TEXT,    /* const char *: at most `maximum` bytes */
    CSV_NAME,    /* const char *: fewer than CSV_NAME_SIZE bytes, all plain (csv_plain_length) */
    CSV_WORD,    /* int or enum: index into `words` */
    CSV_INTEGER, /* int, from minimum to maximum */
    CSV_FLOAT,   /* float, likewise, read by parse_float(): fractions such as 1/60 are allowed */
    CSV_NUMBER,  /* double, likewise */
    CSV_OPTIONAL /* the same, or NAN: an empty field */
} CsvKind;

typedef struct CsvColumn {
    const char *name;
    CsvKind kind;
    size_t offset;            /* of the member in the row's struct */
    double minimum, maximum;  /* ends included */
    const char *const *words; /* ends in NULL */
    int digits;               /* significant digits of a number as written; 0: 6 */
    bool quoted;              /* a text is written in quotes even if it does not need them */
    bool key;                 /* no two rows may be equal in all columns with this flag */
    bool optional;            /* a file may lack the column, if it is one of the last: older ones do */
} CsvColumn;

/* Which headers are accepted. Members without a column are 0; optional texts are empty, optional figures NaN. */
typedef enum CsvHeader {
    CSV_ALL,   /* all columns, in any order; further columns are ignored */
    CSV_EXACT, /* these columns in this order */
    CSV_SUBSET /* any of the columns, in any order */
} CsvHeader;

struct CsvTable;

typedef struct CsvLayout {
    const char *name; /* of the file: NAME.csv */
    const CsvColumn *columns;
    int column_count; /* at most CSV_MAX_COLUMNS */
    size_t row_size;  /* of the row's struct */
    int min_rows, max_rows;
    CsvHeader header;
    /* Refuses rows that contradict themselves or each other, by csv_table_error(). NULL: nothing more to check. */
    bool (*check)(const struct CsvTable *table, Error *error);
} CsvLayout;

/* An initialiser of a column with the name of its member: CSV_MEMBER(RateRow, rate, CSV_OPTIONAL, .maximum = 1). */
#define CSV_MEMBER(Row, member, sort, ...) \
    { .name = #member, .kind = (sort), .offset = offsetof(Row, member), __VA_ARGS__ }

/* An initialiser: CSV_LAYOUT("rates", rate_columns, RateRow, .min_rows = 1, .max_rows = 5000). */
#define CSV_LAYOUT(file, column_array, Row, ...)                                   \
    {                                                                              \
        .name = (file), .columns = (column_array), .row_size = sizeof(Row),        \
        .column_count = sizeof(column_array) / sizeof *(column_array), __VA_ARGS__ \
    }

typedef struct CsvTable {
    Csv csv; /* texts of rows point into it */
    int count;
    void *rows;                  /* [count] structs, in the file's order */
    int fields[CSV_MAX_COLUMNS]; /* by column of the layout: its field in a line, or -1 */
} CsvTable;

/* Reads a file. Refused, with "path:line:column: error: reason": what csv_read() refuses, a header that the layout does
   not accept, a column that appears twice, fields that are not of their column's kind or range, fewer than min_rows or
   more than max_rows rows, repeated keys, what the layout's check refuses. On failure nothing is to be freed. */
bool csv_table_read(CsvTable *table, const char *path, const CsvLayout *layout, Error *error);

/* The same of folder/NAME.csv. */
bool csv_table_read_from(CsvTable *table, const char *folder, const CsvLayout *layout, Error *error);

void csv_table_free(CsvTable *table);

/* The path folder/NAME.csv. ERROR_INPUT if it is too long. */
bool csv_table_path(char path[CSV_PATH_SIZE], const char *folder, const CsvLayout *layout, Error *error);

/* Sets an error "path:line:column: error: text" at a row, from 0, and a column of the layout. Returns false. */
bool csv_table_error(const CsvTable *table, int row, int column, Error *error, const char *format, ...)
    PRINTF_LIKE(5, 6);

/* Writes the file atomically. Refused, since they could not be read back: control characters in a text, infinite
   numbers, and NAN in a column that is not optional. */
bool csv_table_write(const char *path, const CsvLayout *layout, const void *rows, int count, Error *error);

/* A header line; a row's line. The latter fails where csv_table_write() would, and writes nothing then. */
void csv_header_print(FILE *file, const CsvLayout *layout);
bool csv_row_print(FILE *file, const CsvLayout *layout, const void *row, Error *error);

/* Index of a word in a list that ends in NULL; -1: not there. */
int csv_word(const char *const *words, const char *word);

/* Bytes of the text's first character if it is a letter, a digit, the space, one of -_.,:=+/()*[] or not in ASCII: what
   names consist of. Otherwise, or if it is not UTF-8, 0. */
size_t csv_plain_length(const char *text);

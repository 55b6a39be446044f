/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads RFC 4180 in one pass: fields are unquoted in place and end in NUL. Writes a field. */
#include "base/csv.h"

#include "base/base.h"
#include "base/file.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

bool csv_fail(const char *path, int line, int column, Error *error, const char *format, ...) {
    char where[1280], what[512];
    const int used = snprintf(where, sizeof where, "%.1200s:%d", path, line);
    if (column > 0) snprintf(where + used, sizeof where - (size_t)used, ":%d", column);
    PRINT_ARGUMENTS(what, sizeof what, format);
    return error_input(error, where, "%s", what);
}

/* UTF-8: the bytes after a character's first do not count. */
static bool begins_character(char c) { return ((unsigned char)c & 0xc0) != 0x80; }

static bool check_text(const char *path, const char *text, size_t size, Error *error) {
    int line = 1, column = 1;
    for (size_t i = 0; i < size; i++) {
        unsigned char c = (unsigned char)text[i];
        bool line_end = c == '\n' || (c == '\r' && text[i + 1] == '\n');
        if (!line_end && (c < 0x20 || c == 0x7f))
            return csv_fail(path, line, column, error, "control character 0x%02x", (unsigned)c);
        column += begins_character(text[i]);
        if (c != '\n') continue;
        line++;
        column = 1;
    }
    return true;
}

typedef struct Reader {
    Csv *csv;
    char *at;
    size_t capacity; /* of csv->fields */
    size_t count;    /* fields read */
    int column;
    int max_rows;
} Reader;

static bool fail_csv(const Reader *reader, int column, Error *error, const char *what) {
    return csv_fail(reader->csv->path, reader->csv->rows + 1, column, error, "%s", what);
}

static char csv_step(Reader *reader) {
    reader->column += begins_character(*reader->at);
    return *reader->at++;
}

static bool ends_field(const char *at) { return *at == ',' || *at == '\n' || *at == '\0' || *at == '\r'; }

static char *take_plain(Reader *reader, Error *error) {
    while (!ends_field(reader->at))
        if (csv_step(reader) == '"')
            return fail_csv(reader, reader->column - 1, error, "a quote inside a field that does not begin with one"),
                   NULL;
    return reader->at;
}

static char *take_quoted(Reader *reader, Error *error) {
    int start = reader->column;
    char *write = reader->at;
    csv_step(reader);
    for (;;) {
        if (*reader->at == '\0' || *reader->at == '\n' || *reader->at == '\r')
            return fail_csv(reader, start, error, "this quote is not closed on its line"), NULL;
        char c = csv_step(reader);
        if (c == '"' && *reader->at != '"') break;
        if (c == '"') csv_step(reader);
        *write++ = c;
    }
    if (ends_field(reader->at)) return write;
    return fail_csv(reader, reader->column, error, "expected a comma after the closing quote"), NULL;
}

/* *separator is what ended the field: a comma, or the line. */
static bool take_field(Reader *reader, char *separator, Error *error) {
    Csv *csv = reader->csv;
    void *fields = csv->fields;
    bool room = array_reserve(&fields, &reader->capacity, reader->count + 1, sizeof *csv->fields);
    csv->fields = fields;
    if (!room) return error_memory(error, csv->path);
    csv->fields[reader->count++] = (CsvField){reader->at, reader->column};
    /* Where the field's text, unquoted in place, has to end. */
    char *end = (*reader->at == '"' ? take_quoted : take_plain)(reader, error);
    if (end == NULL) return false;
    if (*reader->at == '\r') reader->at++;
    /* The text's NUL may take the place of what ended it. */
    *separator = *reader->at;
    if (*separator != '\0') csv_step(reader);
    *end = '\0';
    return true;
}

static bool take_row(Reader *reader, Error *error) {
    Csv *csv = reader->csv;
    reader->column = 1;
    if (csv->rows > reader->max_rows)
        return csv_fail(csv->path, csv->rows + 1, 1, error, "the table has more than %d rows", reader->max_rows);
    if (*reader->at == '\n' || *reader->at == '\r') return fail_csv(reader, 1, error, "the line is empty");
    size_t first = reader->count;
    char separator = ',';
    while (separator == ',')
        if (!take_field(reader, &separator, error)) return false;
    int width = (int)(reader->count - first);
    if (csv->rows++ == 0) csv->width = width;
    return width == csv->width || csv_error(csv, csv->rows - 1, 0, error, "%d field%s, but the header has %d", width,
                                            width == 1 ? "" : "s", csv->width);
}

bool csv_read(Csv *csv, const char *path, size_t max_size, int min_rows, int max_rows, Error *error) {
    *csv = (Csv){.path = strdup(path)};
    if (csv->path == NULL) return error_memory(error, path);
    size_t size;
    csv->text = file_read(path, max_size, &size, error);
    bool ok = csv->text != NULL;
    if (ok && strncmp(csv->text, "\xef\xbb\xbf", 3) == 0) memmove(csv->text, csv->text + 3, (size -= 3) + 1);
    ok = ok && check_text(path, csv->text, size, error);
    Reader reader = {.csv = csv, .at = csv->text, .max_rows = max_rows};
    while (ok && *reader.at != '\0') ok = take_row(&reader, error);
    if (ok && csv->rows <= min_rows)
        ok = fail_csv(&reader, 1, error, csv->rows == 0 ? "the file is empty" : "the table has no rows");
    if (!ok) csv_free(csv);
    return ok;
}

void csv_free(Csv *csv) {
    free(csv->fields);
    free(csv->text);
    free(csv->path);
    *csv = (Csv){.path = NULL};
}

static const CsvField *field_at(const Csv *csv, int row, int field) {
    return &csv->fields[(size_t)row * (size_t)csv->width + (size_t)field];
}

const char *csv_text(const Csv *csv, int row, int field) { return field_at(csv, row, field)->text; }

bool csv_error(const Csv *csv, int row, int field, Error *error, const char *format, ...) {
    char what[512];
    PRINT_ARGUMENTS(what, sizeof what, format);
    return csv_fail(csv->path, row + 1, field_at(csv, row, field)->column, error, "%s", what);
}

CsvShown csv_show(const char *text) {
    CsvShown shown;
    size_t length = strlen(text), room = sizeof shown.text - 1;
    bool cut = length > room;
    if (cut) length = room - 3;
    for (size_t i = 0; i < length; i++) shown.text[i] = text[i] >= ' ' && text[i] <= '~' ? text[i] : '?';
    strcpy(shown.text + length, cut ? "..." : "");
    return shown;
}

bool csv_is_computed(const char *text) {
    double number;
    return *text != '\0' && strchr("=+-@'", *text) != NULL && !parse_double(text, &number);
}

void csv_put(FILE *file, const char *text, bool quoted) {
    if (!quoted && text[strcspn(text, ",\"\r\n")] == '\0') {
        fputs(text, file);
        return;
    }
    fputc('"', file);
    for (; *text != '\0'; text++) {
        if (*text == '"') fputc('"', file);
        fputc(*text, file);
    }
    fputc('"', file);
}

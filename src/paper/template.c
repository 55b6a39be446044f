/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Values as Markdown. No character of them has a meaning to Markdown, nor in a table's cell. */
#include "base/base.h"
#include "base/csv.h"
#include "base/file.h"
#include "paper/report_internal.h"

#include <ctype.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_CAPTION_SIZE = 2048 };

static bool is_letter(char c) { return isalnum((unsigned char)c) || (unsigned char)c >= 0x80; }

/* An underscore within a word has no meaning. GitHub also strikes through between tildes and sets maths between
   dollars. */
static void escape(FILE *out, const char *text) {
    for (const char *c = text; *c != '\0'; c++) {
        bool in_word = c > text && is_letter(c[-1]) && is_letter(c[1]);
        if (*c == '<' || *c == '>' || *c == '&')
            fputs(*c == '<' ? "&lt;" : *c == '>' ? "&gt;" : "&amp;", out);
        else if (strchr("\\`*[]|~$", *c) != NULL || (*c == '_' && !in_word))
            fprintf(out, "\\%c", *c);
        else
            fputc(*c, out);
    }
}

/* A field of a CSV file: cut to a name's length, a dash if it is empty. */
static void template_write_text(FILE *out, const char *text) {
    if (*text == '\0')
        fputs("–", out);
    else
        escape(out, csv_show(text).text);
}

/* format: "number", "percent", "score"; false for any other. A dash for NaN and infinite values. */
static bool template_write_number(FILE *out, double value, const char *format) {
    const bool percent = strcmp(format, "percent") == 0, score = strcmp(format, "score") == 0;
    if (!isfinite(value))
        fputs("–", out);
    else if (percent)
        fprintf(out, "%.1f%%", 100 * value);
    else if (score && value < 10) /* as many digits as the paper gives */
        fprintf(out, "%.6f", value);
    else
        fprintf(out, fabs(value) >= 1000 && fabs(value) < 1e7 ? "%.0f" : "%.3g", value);
    return percent || score || strcmp(format, "number") == 0;
}

/* Length of the UTF-8 character at the start of text; 0 for damaged ones and control characters. */
static size_t character_length(const char *text, size_t size) {
    uint32_t character;
    size_t length = utf8_decode(text, size, &character);
    return length > 0 && character >= 0x20 && character != 0x7f ? length : 0;
}

static bool check_line(const char *text, size_t size, const char *what, const char *path, Error *error) {
    for (size_t at = 0, length; at < size; at += length) {
        length = character_length(text + at, size - at);
        if (length == 0) return error_input(error, path, "byte %zu: %s must be one line of UTF-8 text", at + 1, what);
    }
    return true;
}

/* A text of one line; a dash if it is empty. ERROR_INPUT if it is not UTF-8 without control characters; `where` names
   it. */
static bool template_write_line(FILE *out, const char *text, const char *where, Error *error) {
    if (!check_line(text, strlen(text), "a text", where, error)) return false;
    escape(out, *text == '\0' ? "–" : text);
    return true;
}

static bool check_caption(char *caption, size_t size, const char *path, Error *error) {
    if (size > 0 && caption[size - 1] == '\n') caption[--size] = '\0';
    if (size == 0) return error_input(error, path, "the caption is empty");
    return check_line(caption, size, "a caption", path, error);
}

/* The text of a file. ERROR_INPUT if it is not one line of UTF-8 without control characters. */
static bool template_write_caption(FILE *out, const char *path, Error *error) {
    size_t size;
    char *caption = file_read(path, MAX_CAPTION_SIZE, &size, error);
    const bool whole = caption != NULL && check_caption(caption, size, path, error);
    if (whole) escape(out, caption);
    free(caption);
    return whole;
}

enum { MAX_ROWS = 5000, MAX_SIZE = MAX_ROWS * 512, MAX_WORDS = 8, MAX_TAG_SIZE = 200 };

typedef struct Filling {
    const char *folder;
    FILE *out;
    Error *error;
} Filling;

/* Where values are looked up. */
typedef struct Scope {
    const struct Scope *outer;
    const Csv *csv;
    int row; /* 0: the rows are keys and values */
} Scope;

typedef struct Tag {
    char text[MAX_TAG_SIZE];
    char *words[MAX_WORDS + 1]; /* ended by NULL */
    const char *end;            /* in the template: what follows the tag */
} Tag;

static bool template_fail(const Filling *filling, const char *what, const char *text) {
    return error_input(filling->error, "report template", "%s: '%s'", what, text);
}

static const char *skip_line_end(const char *text) { return text + (*text == '\n'); }

static bool read_tag(const Filling *filling, const char *from, Tag *tag) {
    const char *end = strstr(from, "}}");
    const size_t length = end != NULL ? (size_t)(end - from) - 2 : MAX_TAG_SIZE;
    if (length >= MAX_TAG_SIZE) return template_fail(filling, "a tag without }} or too long", "{{");
    memcpy(tag->text, from + 2, length);
    tag->text[length] = '\0';
    tag->end = end + 2;
    int count = 0;
    char *rest;
    for (char *word = strtok_r(tag->text, " ", &rest); word != NULL && count < MAX_WORDS;
         word = strtok_r(NULL, " ", &rest))
        tag->words[count++] = word;
    tag->words[count] = NULL;
    return count > 0 || template_fail(filling, "an empty tag", "{{}}");
}

static bool make_path(const Filling *filling, const char *name, char path[PATH_MAX]) {
    return file_path(path, PATH_MAX, filling->error, "%s/%s", filling->folder, name);
}

static const char *find_in_row(const Csv *csv, int row, const char *name) {
    for (int i = 0; i < csv->width; i++)
        if (strcmp(csv_text(csv, 0, i), name) == 0) return csv_text(csv, row, i);
    return NULL;
}

static const char *find_key(const Csv *csv, const char *name) {
    for (int i = 1; i < csv->rows; i++)
        if (strcmp(csv_text(csv, i, 0), name) == 0) return csv_text(csv, i, 1);
    return NULL;
}

static const char *find_value(const Scope *scope, const char *name) {
    const char *value = NULL;
    for (; scope != NULL && value == NULL; scope = scope->outer)
        value = scope->row > 0 ? find_in_row(scope->csv, scope->row, name) : find_key(scope->csv, name);
    return value;
}

/* name: of a value, or a number itself. NAN for a value that is not a number. */
static bool find_number(const Filling *filling, const Scope *scope, const char *name, double *number) {
    const char *value = find_value(scope, name);
    if (!parse_double(value != NULL ? value : name, number)) *number = NAN;
    return value != NULL || !isnan(*number) || template_fail(filling, "no value has this name", name);
}

static bool fill_number(const Filling *filling, char *name, const char *format, const Scope *scope) {
    double value, divisor = 1;
    char *slash = strchr(name, '/');
    if (slash != NULL) {
        *slash = '\0';
        if (!find_number(filling, scope, slash + 1, &divisor)) return false;
    }
    if (!find_number(filling, scope, name, &value)) return false;
    return template_write_number(filling->out, value / divisor, format) ||
           template_fail(filling, "unknown format", format);
}

static bool fill_value(const Filling *filling, const Tag *tag, const Scope *scope) {
    char path[PATH_MAX];
    if (strcmp(tag->words[0], "caption") == 0 && tag->words[1] != NULL)
        return make_path(filling, tag->words[1], path) && template_write_caption(filling->out, path, filling->error);
    const bool whole = tag->words[1] != NULL && strcmp(tag->words[1], "text") == 0;
    if (tag->words[1] != NULL && !whole) return fill_number(filling, tag->words[0], tag->words[1], scope);
    const char *value = find_value(scope, tag->words[0]);
    if (value == NULL) return template_fail(filling, "no value has this name", tag->words[0]);
    if (whole) return template_write_line(filling->out, value, tag->words[0], filling->error);
    template_write_text(filling->out, value);
    return true;
}

/* words: "single|stack". */
static bool is_among(const char *text, const char *words) {
    const size_t length = strlen(text);
    for (const char *word = words; word != NULL; word = strchr(word, '|')) {
        word += word != words;
        if (strncmp(word, text, length) == 0 && (word[length] == '|' || word[length] == '\0')) return true;
    }
    return false;
}

/* *passes: whether the row passes all filters. */
static bool filter_row(const Filling *filling, const Scope *row, char *const *filters, bool *passes) {
    *passes = true;
    for (; *filters != NULL; filters++) {
        char name[MAX_TAG_SIZE];
        const size_t length = strcspn(*filters, "=");
        snprintf(name, sizeof name, "%.*s", (int)length, *filters);
        const char *own = find_in_row(row->csv, row->row, name);
        const char *wanted = (*filters)[length] == '=' ? *filters + length + 1 : find_value(row->outer, name);
        if (own == NULL || wanted == NULL) return template_fail(filling, "no value to filter by", name);
        *passes &= is_among(own, wanted);
    }
    return true;
}

static bool fill_template(const Filling *filling, const char *from, const char *end, const Scope *scope);

/* end: where the text to repeat ends. */
static bool fill_rows(const Filling *filling, const Tag *tag, const char *end, const Scope *outer) {
    char path[PATH_MAX];
    Csv csv;
    if (!make_path(filling, tag->words[1], path) || !csv_read(&csv, path, MAX_SIZE, 0, MAX_ROWS, filling->error))
        return false;
    bool filled = true, passes;
    for (Scope row = {outer, &csv, 1}; filled && row.row < csv.rows; row.row++)
        filled = filter_row(filling, &row, tag->words + 2, &passes) &&
                 (!passes || fill_template(filling, skip_line_end(tag->end), end, &row));
    csv_free(&csv);
    return filled;
}

static const char each_tag[] = "{{each ", end_tag[] = "{{end}}";

/* The {{end}} of the {{each}} before `from`; NULL if there is none. */
static const char *find_end(const char *from) {
    int depth = 1;
    for (from = strstr(from, "{{"); from != NULL; from = strstr(from + 2, "{{")) {
        if (strncmp(from, each_tag, strlen(each_tag)) == 0) depth++;
        if (strncmp(from, end_tag, strlen(end_tag)) == 0 && --depth == 0) return from;
    }
    return NULL;
}

/* Fills the template up to `end`. */
static bool fill_template(const Filling *filling, const char *from, const char *end, const Scope *scope) {
    for (;;) {
        const char *next = strstr(from, "{{");
        if (next == NULL || next > end) next = end;
        fwrite(from, 1, (size_t)(next - from), filling->out);
        if (next == end) return true;
        Tag tag;
        if (!read_tag(filling, next, &tag)) return false;
        if (strcmp(tag.words[0], "each") == 0) {
            const char *rows_end = find_end(tag.end);
            if (rows_end == NULL || tag.words[1] == NULL)
                return template_fail(filling, "a tag without FILE or {{end}}", "each");
            if (!fill_rows(filling, &tag, rows_end, scope)) return false;
            from = skip_line_end(rows_end + strlen(end_tag));
        } else {
            if (!fill_value(filling, &tag, scope)) return false;
            from = tag.end;
        }
    }
}

bool template_fill(const char *template, const char *folder, const char *values, FILE *out, Error *error) {
    const Filling filling = {folder, out, error};
    char path[PATH_MAX];
    Csv csv;
    if (!make_path(&filling, values, path) || !csv_read(&csv, path, MAX_SIZE, 1, MAX_ROWS, error)) return false;
    const Scope scope = {NULL, &csv, 0};
    const bool filled = fill_template(&filling, template, template + strlen(template), &scope);
    csv_free(&csv);
    return filled;
}

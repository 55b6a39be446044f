/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "paper/report/template.h"

#include "common/csv.h"
#include "common/file.h"
#include "common/utf8.h"
#include "paper/report/template_value.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_ROWS = 5000, MAX_SIZE = MAX_ROWS * 512, MAX_CAPTION_SIZE = 2048, MAX_WORDS = 6, MAX_TAG_SIZE = 200 };

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
    char *words[MAX_WORDS]; /* ended by NULL */
    const char *end;        /* in the template, behind the tag */
} Tag;

static const char end_tag[] = "{{end}}\n";

static bool fail(const Filling *filling, const char *what, const char *tag) {
    return error_input(filling->error, "template of the report", "%s: '%s'", what, tag);
}

static bool read_tag(const Filling *filling, const char *from, Tag *tag) {
    const char *end = strstr(from, "}}");
    size_t length = end != NULL ? (size_t)(end - from) - 2 : MAX_TAG_SIZE;
    if (length >= MAX_TAG_SIZE) return fail(filling, "a tag without }}", "{{");
    memcpy(tag->text, from + 2, length);
    tag->text[length] = '\0';
    tag->end = end + 2;
    int count = 0;
    char *rest;
    for (char *word = strtok_r(tag->text, " ", &rest); word != NULL && count < MAX_WORDS - 1;
         word = strtok_r(NULL, " ", &rest))
        tag->words[count++] = word;
    tag->words[count] = NULL;
    return count > 0 || fail(filling, "an empty tag", "{{}}");
}

static const char *find_in(const Csv *csv, int row, const char *name) {
    for (int i = 0; row > 0 && i < csv->width; i++)
        if (strcmp(csv_text(csv, 0, i), name) == 0) return csv_text(csv, row, i);
    for (int i = 1; row == 0 && i < csv->rows; i++)
        if (strcmp(csv_text(csv, i, 0), name) == 0) return csv_text(csv, i, 1);
    return NULL;
}

static const char *find_value(const Scope *scope, const char *name) {
    const char *value = NULL;
    for (; scope != NULL && value == NULL; scope = scope->outer) value = find_in(scope->csv, scope->row, name);
    return value;
}

static bool fill_value(const Filling *filling, const Tag *tag, const Scope *scope) {
    const char *value = find_value(scope, tag->words[0]);
    if (value == NULL) return fail(filling, "no value", tag->words[0]);
    return template_write_value(filling->out, value, tag->words[1]) || fail(filling, "unknown format", tag->words[1]);
}

static bool make_path(const Filling *filling, const char *name, char path[PATH_MAX]) {
    return snprintf(path, PATH_MAX, "%s/%s", filling->folder, name) < PATH_MAX ||
           error_input(filling->error, filling->folder, "the name is too long");
}

/* Length of the UTF-8 character at the start of text; 0 for damaged ones and control characters. */
static size_t character_length(const char *text, size_t size) {
    uint32_t character;
    size_t length = utf8_decode(text, size, &character);
    return length > 0 && character >= 0x20 && character != 0x7f ? length : 0;
}

static bool check_caption(char *caption, size_t size, const char *path, Error *error) {
    if (size > 0 && caption[size - 1] == '\n') caption[--size] = '\0';
    if (size == 0) return error_input(error, path, "an empty caption");
    for (size_t at = 0, length; at < size; at += length) {
        length = character_length(caption + at, size - at);
        if (length == 0) return error_input(error, path, "byte %zu is no text: a caption is one line of UTF-8", at + 1);
    }
    return true;
}

static bool fill_caption(const Filling *filling, const char *name) {
    char path[PATH_MAX];
    size_t size;
    if (!make_path(filling, name, path)) return false;
    char *caption = file_read(path, MAX_CAPTION_SIZE, &size, filling->error);
    bool whole = caption != NULL && check_caption(caption, size, path, filling->error);
    if (whole) markdown_escape(filling->out, caption);
    free(caption);
    return whole;
}

/* *matches: whether the row passes all filters. */
static bool filter_row(const Filling *filling, const Scope *row, char *const *filters, bool *matches) {
    *matches = true;
    for (; *filters != NULL; filters++) {
        char name[MAX_TAG_SIZE];
        size_t length = strcspn(*filters, "=");
        memcpy(name, *filters, length);
        name[length] = '\0';
        const char *own = find_in(row->csv, row->row, name);
        const char *wanted = (*filters)[length] == '=' ? *filters + length + 1 : find_value(row->outer, name);
        if (own == NULL || wanted == NULL) return fail(filling, "no value to filter by", name);
        *matches &= strcmp(own, wanted) == 0;
    }
    return true;
}

static bool fill(const Filling *filling, const char *from, const char *end, const Scope *scope);

static bool fill_region(const Filling *filling, const Tag *tag, const char *end, const Scope *outer) {
    char path[PATH_MAX];
    Csv csv;
    if (!make_path(filling, tag->words[1], path)) return false;
    if (csv_is_bare(path)) return true;
    if (!csv_read(&csv, path, MAX_SIZE, MAX_ROWS, filling->error)) return false;
    bool filled = true, matches;
    for (Scope row = {outer, &csv, 1}; filled && row.row < csv.rows; row.row++)
        filled = filter_row(filling, &row, tag->words + 2, &matches) &&
                 (!matches || fill(filling, tag->end + 1, end, &row));
    csv_free(&csv);
    return filled;
}

/* The {{end}} of the region that begins here; NULL if there is none. */
static const char *find_end(const char *from) {
    for (int depth = 1;; from += 2) {
        from = strstr(from, "{{");
        if (from == NULL) return NULL;
        if (strncmp(from, "{{each ", 7) == 0) depth++;
        if (strncmp(from, end_tag, strlen(end_tag)) == 0 && --depth == 0) return from;
    }
}

static bool fill(const Filling *filling, const char *from, const char *end, const Scope *scope) {
    for (;;) {
        const char *next = strstr(from, "{{");
        if (next == NULL || next > end) next = end;
        fwrite(from, 1, (size_t)(next - from), filling->out);
        if (next == end) return true;
        Tag tag;
        if (!read_tag(filling, next, &tag)) return false;
        from = tag.end;
        if (strcmp(tag.words[0], "each") == 0) {
            const char *region_end = find_end(from);
            if (region_end == NULL || tag.words[1] == NULL) return fail(filling, "a region without file or end", "each");
            if (!fill_region(filling, &tag, region_end, scope)) return false;
            from = region_end + strlen(end_tag);
        } else if (strcmp(tag.words[0], "caption") == 0 && tag.words[1] != NULL) {
            if (!fill_caption(filling, tag.words[1])) return false;
        } else if (!fill_value(filling, &tag, scope)) {
            return false;
        }
    }
}

bool template_fill(const char *template, const char *folder, const char *values, FILE *out, Error *error) {
    const Filling filling = {folder, out, error};
    char path[PATH_MAX];
    Csv csv;
    if (!make_path(&filling, values, path) || !csv_read(&csv, path, MAX_SIZE, MAX_ROWS, error)) return false;
    const Scope scope = {NULL, &csv, 0};
    bool filled = fill(&filling, template, template + strlen(template), &scope);
    csv_free(&csv);
    return filled;
}

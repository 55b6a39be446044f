/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "paper/report/template_value.h"

#include "common/file.h"
#include "common/utf8.h"
#include "csv/csv.h"

#include <ctype.h>
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

void template_write_text(FILE *out, const char *text) {
    if (*text == '\0')
        fputs("–", out);
    else
        escape(out, csv_show(text).text);
}

bool template_write_number(FILE *out, double value, const char *format) {
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

bool template_write_line(FILE *out, const char *text, const char *where, Error *error) {
    if (!check_line(text, strlen(text), "a text", where, error)) return false;
    escape(out, *text == '\0' ? "–" : text);
    return true;
}

static bool check_caption(char *caption, size_t size, const char *path, Error *error) {
    if (size > 0 && caption[size - 1] == '\n') caption[--size] = '\0';
    if (size == 0) return error_input(error, path, "the caption is empty");
    return check_line(caption, size, "a caption", path, error);
}

bool template_write_caption(FILE *out, const char *path, Error *error) {
    size_t size;
    char *caption = file_read(path, MAX_CAPTION_SIZE, &size, error);
    const bool whole = caption != NULL && check_caption(caption, size, path, error);
    if (whole) escape(out, caption);
    free(caption);
    return whole;
}

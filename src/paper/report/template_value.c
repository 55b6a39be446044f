/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "paper/report/template_value.h"

#include "common/csv.h"
#include "common/parse.h"

#include <ctype.h>
#include <math.h>
#include <string.h>

static bool is_letter(char c) { return isalnum((unsigned char)c) || (unsigned char)c >= 0x80; }

/* An underscore within a word is only an underscore. GitHub strikes through between tildes and sets maths between dollar
   signs. */
void markdown_escape(FILE *out, const char *text) {
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

static void write_number(FILE *out, double value) {
    double size = fabs(value);
    fprintf(out, size >= 1000 && size < 1e7 ? "%.0f" : "%.3g", value);
}

/* As many digits as the paper gives. */
static void write_score(FILE *out, double value) {
    if (value < 10)
        fprintf(out, "%.6f", value);
    else
        write_number(out, value);
}

bool template_write_value(FILE *out, const char *field, const char *format) {
    double value = NAN;
    bool text = format == NULL, number = parse_double(field, &value);
    if (*field == '\0' || (!text && !number))
        fputs("–", out);
    else if (text)
        markdown_escape(out, csv_show(field).text);
    else if (strcmp(format, "number") == 0)
        write_number(out, value);
    else if (strcmp(format, "percent") == 0)
        fprintf(out, "%.1f%%", 100 * value);
    else if (strcmp(format, "score") == 0)
        write_score(out, value);
    else
        return false;
    return true;
}

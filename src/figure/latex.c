/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "figure/latex.h"

#include <string.h>

/* Characters with a meaning, and those that the font encoding OT1 has only in some fonts. */
static const char *command_for(char character) {
    switch (character) {
    case '\\': return "\\textbackslash{}";
    case '~': return "\\textasciitilde{}";
    case '^': return "\\textasciicircum{}";
    case '<': return "\\textless{}";
    case '>': return "\\textgreater{}";
    case '|': return "\\textbar{}";
    default: return NULL;
    }
}

/* Fonts join "--", "''", "``", ",,", "?`" and "!`" to one sign. */
static int joins(char before, char character) {
    return (before == character && strchr("-'`,", character) != NULL) ||
           (character == '`' && (before == '?' || before == '!'));
}

void latex_text(FILE *out, const char *text) {
    for (char before = '\0'; *text != '\0'; before = *text++) {
        const char *command = command_for(*text);
        if (command != NULL) {
            fputs(command, out);
            continue;
        }
        if (strchr("#$%&_{}", *text) != NULL) putc('\\', out);
        if (before != '\0' && joins(before, *text)) fputs("{}", out);
        putc(*text, out);
    }
}

void latex_code(FILE *out, const char *text) {
    fputs("\\texttt{", out);
    latex_text(out, text);
    fputs("}", out);
}

const char *latex_between(int index, int count) {
    if (index == 0) return "";
    return index < count - 1 ? ", " : " and ";
}

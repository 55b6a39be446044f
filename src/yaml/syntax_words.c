/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "yaml/syntax_words.h"

#include <stddef.h>
#include <string.h>

static const struct {
    const char *problem, *words;
} table[] = {
    {"could not find expected ':'", "a key needs a ':' and a blank behind it"},
    {"did not find expected '-' indicator", "expected '- ' for the next item; check the indentation"},
    {"did not find expected ',' or ']'", "expected ',' or ']'"},
    {"did not find expected ',' or '}'", "expected ',' or '}'"},
    {"did not find expected key", "expected a key; check the indentation"},
    {"did not find expected node content", "expected a value"},
    {"found unexpected end of stream", "a text in quotes has no end"},
    {"found unknown escape character", "a text in double quotes has an unknown escape; write \\\\ for a backslash"},
    {"mapping values are not allowed in this context",
     "a key cannot be here; check the indentation, the ':' above, and quotes around texts with ':'"},
    {"block sequence entries are not allowed in this context", "an item '- ' cannot be here; check the indentation"},
};

const char *syntax_words(const char *problem, char at) {
    if (strcmp(problem, "found character that cannot start any token") == 0)
        return at == '\t' ? "a tab must not indent; use blanks" : "a text cannot begin with this character; use quotes";
    for (size_t i = 0; i < sizeof table / sizeof *table; i++)
        if (strcmp(problem, table[i].problem) == 0) return table[i].words;
    return problem;
}

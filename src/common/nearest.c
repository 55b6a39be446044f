/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/nearest.h"

#include <stddef.h>
#include <string.h>

enum { WORD_SIZE = 32 };

static size_t smaller(size_t a, size_t b) { return a < b ? a : b; }

/* The edit distance (Levenshtein 1966), computed row by row. */
static size_t edits(const char *a, const char *b) {
    size_t row[WORD_SIZE], columns = strlen(b);
    for (size_t j = 0; j <= columns; j++) row[j] = j;
    for (size_t i = 0; a[i] != '\0'; i++) {
        size_t diagonal = row[0];
        row[0] = i + 1;
        for (size_t j = 0; j < columns; j++) {
            size_t replaced = diagonal + (a[i] != b[j]);
            diagonal = row[j + 1];
            row[j + 1] = smaller(replaced, 1 + smaller(row[j], diagonal));
        }
    }
    return row[columns];
}

const char *nearest_word(const char *word, const char *const *words, int count) {
    const char *nearest = NULL;
    size_t length = strlen(word), best = 1 + length / 3;
    if (length >= WORD_SIZE) return NULL;
    for (int i = 0; i < count; i++) {
        if (strlen(words[i]) >= WORD_SIZE) continue;
        size_t distance = edits(word, words[i]);
        if (distance > best || (distance == best && nearest != NULL)) continue;
        best = distance;
        nearest = words[i];
    }
    return nearest;
}

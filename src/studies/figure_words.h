/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the words of a figure mean, for its caption: each method by what frames call it, each key of a setting by its
   help, "nncg: conjugate gradients over sweeps". */
#pragma once

#include <stddef.h>

enum { WORDS_MAX = 48, WORD_SIZE = 160 };

/* Zero-initialise. */
typedef struct WordList {
    int count;
    char items[WORDS_MAX][WORD_SIZE];
} WordList;

/* Add what is not there yet; unknown methods and keys have no meaning. The name may have settings, which are
   ignored. */
void words_add(WordList *words, const char *word, const char *meaning);
void words_add_method(WordList *words, const char *name);
void words_add_settings(WordList *words, const char *name, const char *setting);

/* A factor in two digits, without an exponent: "3.8", "980". */
enum { FACTOR_SIZE = 24 };
void factor_text(char text[FACTOR_SIZE], double factor);

/* Ends a caption of `size` bytes with all of them, as far as there is room, and a line end. */
void words_join(const WordList *words, char *caption, size_t size);

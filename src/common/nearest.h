/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Suggestions for mistyped words. Own code: no library in use has an edit distance. */
#pragma once

/* The nearest of the words by edit distance, or NULL if none is near. Words of more than 31 bytes are never near. */
const char *nearest_word(const char *word, const char *const *words, int count);

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a mistyped word most likely stands for. */
#pragma once

/* The nearest of the words, or NULL where none is near. */
const char *nearest_word(const char *word, const char *const *words, int count);

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Completion of command lines. The scripts for the shells (src/cli/completion) call `twinbox completion words`, which
   answers from the option tables. */
#pragma once
#include "cli/options.h"

enum { COMPLETION_WORD_SIZE = 1024 }; /* a longer word has no completion */

/* The words behind "twinbox"; the last one, maybe empty, is being typed. */
typedef struct CompletionWords {
    int count;
    const char *const *words;
} CompletionWords;

/* Prints what the last word may become, one line each: the whole word, a tab, a description. A line
   "<files>BEGIN<tab>npz csv" stands for files with these endings, or with any if none is given, whose names follow BEGIN
   in the word; "<folders>BEGIN" stands for folders. */
void completion_print(const CompletionWords *words);

/* What the value of an option, or an argument, may become. */
typedef struct CompletionValue {
    const Option *option;
    const char *begin; /* what stands before the value in the word: "--method=" */
    const char *typed; /* of the value */
    const char *scene; /* the first scene on the command line, or NULL */
} CompletionValue;
void completion_print_value(const CompletionValue *value);

/* Prints begin, word and ending as a candidate if it begins with what was typed (behind `begin`). */
void completion_offer(const char *begin, const char *typed, const char *word, const char *ending,
                      const char *description);

/* Files: see completion_print(). */
void completion_offer_files(const char *begin, const char *endings);
void completion_offer_folders(const char *begin);

/* A method with settings, "NAME:KEY=VALUE,KEY=VALUE"; with `list`, several separated by commas. */
void completion_print_methods(const char *begin, const char *typed, bool list);

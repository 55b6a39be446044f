/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of the pages of studies, and texts that are complete in memory before they become files. */
#pragma once
#include "base/base.h"
#include "base/csv.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

void study_page_begin(FILE *out, const char *title, const char *style);

/* Begins a part of the page with its heading, without the heading's end. */
void study_page_section(FILE *out, const char *name);

/* A region that can be scrolled, also by the keyboard. */
void study_page_region(FILE *out, const char *style, const char *label, const char *of);

/* How many rows have no page; page: at this place in each row of the table. */
void study_page_left_out(FILE *out, const CsvTable *table, size_t page, size_t row_size, const char *what);

typedef bool TextWrite(void *context, FILE *out, Error *error);

/* The text that `write` writes, to be freed. NULL with error set where it fails; `what` is without memory. */
char *text_print(TextWrite *write, void *context, size_t *size, const char *what, Error *error);

/* Writes it to a file. */
bool text_write(const char *path, TextWrite *write, void *context, Error *error);

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of the pages of studies. */
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

/* failed: set by `put`, with the error. */
bool study_page_write(const char *path, void (*put)(FILE *out, const void *html), const void *html, const bool *failed,
                      Error *error);

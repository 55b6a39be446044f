/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pages of a study, folder/pages/NAME.html, and the table that lists them. Pages are written in parts, one after
   the other, so that a study that is interrupted continues with the page that it was at. */
#pragma once
#include "base/base.h"
#include "base/csv.h"
#include "base/machine.h"
#include "pictures/player.h"
#include "runs/pieces.h"
#include "runs/trajectory.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

/* All pages of a folder together, and the states in one page, which has only every n-th frame if they would take
   more. */
#define PAGE_SET_MAX_BYTES (256 << 20)
#define PAGE_SET_STATE_BYTES (8 << 20)

enum { PAGE_NAME_SIZE = 256 };

/* The caller sets the first five members. */
typedef struct PageSet {
    const char *folder;
    const CsvLayout *layout; /* of the table; its last columns are a link into a page and the page's bytes */
    int parts;
    /* Writes the pages of a part, and the table's rows that list them (piece_tables_print). Parts come in their order,
       but for those that an earlier run did. Rows of one page follow each other; where a page was left out, their last
       columns are empty and 0. */
    bool (*write)(void *context, int part, FILE *rows, const Progress *progress, Error *error);
    void *context;
    Pieces pieces;
    PiecePlan plan;
    int counted;               /* parts whose pages are counted: */
    int64_t bytes;             /* of the pages so far */
    int pages, left_out;       /* left out: beyond PAGE_SET_MAX_BYTES */
    char last[PAGE_NAME_SIZE]; /* the page of the last row that had one */
} PageSet;

/* Writes the pages and the table. key: of the study (runs/pieces.h). */
bool page_set_make(PageSet *set, uint64_t key, const Progress *progress, Error *error);

/* Removes what the parts have left, once all that the caller makes of the table is written. */
bool page_set_end(const PageSet *set, Error *error);

/* For `write`: makes `name` fit a file, and path "pages/NAME.html" of it; writes that page. path is empty and bytes is
   0 if there is no room for it. */
typedef struct PageFile {
    char path[PAGE_NAME_SIZE];
    int bytes;
} PageFile;
bool page_set_write(const PageSet *set, const char *name, const Trajectory *const *runs, int count,
                    const PlayerOptions *options, PageFile *file, Error *error);

/* "pages/NAME.html#t=0.55&body=7&run=1": the moment, and the body in that run of the page. Of a page that was left out,
   empty. */
enum { PAGE_LINK_SIZE = PAGE_NAME_SIZE + PLAYER_LINK_SIZE + 16 };
void page_set_link(char link[PAGE_LINK_SIZE], const PageFile *file, double time, int body, int run);

/* "14 pages of 2.1 MB -> DIR/pages" and what was left out. */
void page_set_print(const PageSet *set, const char *html);

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A text with headings, tables and figures, made once and written in two languages (document_write.h). All texts are
   plain UTF-8; what they hold has no meaning to the languages. */
#pragma once
#include "common/error.h"

#include <stddef.h>

enum { DOCUMENT_TEXT_SIZE = 4096, DOCUMENT_CELL_SIZE = 64 };

typedef enum BlockKind { BLOCK_HEADING, BLOCK_PARAGRAPH, BLOCK_ITEM, BLOCK_LINK, BLOCK_TABLE, BLOCK_FIGURE } BlockKind;

typedef struct DocumentFigure {
    const char *path; /* from where the document lies */
    const char *alt;  /* what it shows, for who cannot see it */
    const char *caption;
    int width, height; /* pixels */
    const void *png;   /* the file's bytes; to outlive the document */
    size_t png_size;
} DocumentFigure;

typedef struct Block {
    BlockKind kind;
    int level;          /* of a heading: 1 is the title */
    char *text;         /* of a table or figure: its caption */
    char *address;      /* of a link; of a figure: its path */
    char *alt;          /* of a figure */
    int columns, cells; /* of a table; the header's are the first */
    int first_cell;     /* in the document */
    unsigned numbers;   /* bit i: column i holds numbers */
    int number;         /* of a figure, from 1 */
    int width, height;  /* of a figure */
    const void *png;
    size_t png_size;
} Block;

typedef struct Document {
    Block *blocks;
    size_t block_count, block_capacity;
    char (*cells)[DOCUMENT_CELL_SIZE];
    size_t cell_count, cell_capacity;
    int figures;
    bool failed; /* memory was short: told once, by document_complete() */
} Document;

void document_free(Document *document);

/* False with error set where any of the calls below could not keep what it was given. */
bool document_complete(const Document *document, const char *where, Error *error);

void document_heading(Document *document, int level, const char *text);
void document_paragraph(Document *document, const char *format, ...) PRINTF_LIKE(2, 3);
void document_item(Document *document, const char *format, ...) PRINTF_LIKE(2, 3);

/* A paragraph that ends in a link; the address is what is shown of it. */
void document_link(Document *document, const char *text, const char *address);

/* Begins a table. columns: "Name|>Test|>Ratio", where '>' marks a column of numbers. Its cells follow, row by row. A
   cell is cut to fit. */
void document_table(Document *document, const char *caption, const char *columns);
void document_cell(Document *document, const char *format, ...) PRINTF_LIKE(2, 3);

/* A text of foreign origin: plain, and cut to a name's length. */
void document_name(Document *document, const char *text);

/* A number with three digits that count; a dash for what is not finite. */
void document_number(Document *document, double value);
void document_percent(Document *document, double share);

/* Numbered in the order of the calls. */
void document_figure(Document *document, const DocumentFigure *figure);

/* The same numbers for sentences. */
typedef struct Shown {
    char text[32];
} Shown;
Shown show_number(double value);
Shown show_percent(double share);

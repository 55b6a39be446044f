/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "paper/report/document.h"

#include "common/array.h"
#include "common/csv.h"

#include <assert.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void document_free(Document *document) {
    for (size_t i = 0; i < document->block_count; i++) {
        free(document->blocks[i].text);
        free(document->blocks[i].address);
        free(document->blocks[i].alt);
    }
    free(document->blocks);
    free(document->cells);
    *document = (Document){.failed = false};
}

bool document_complete(const Document *document, const char *where, Error *error) {
    return !document->failed || error_memory(error, where);
}

/* NULL where there is no memory: the block is then left out. */
static Block *add_block(Document *document, BlockKind kind, const char *text) {
    void *blocks = document->blocks;
    bool room = array_reserve(&blocks, &document->block_capacity, document->block_count + 1, sizeof(Block));
    document->blocks = blocks;
    char *copy = room ? strdup(text) : NULL;
    if (copy == NULL) {
        document->failed = true;
        return NULL;
    }
    Block *block = &document->blocks[document->block_count++];
    *block = (Block){.kind = kind, .text = copy};
    return block;
}

void document_heading(Document *document, int level, const char *text) {
    Block *block = add_block(document, BLOCK_HEADING, text);
    if (block != NULL) block->level = level;
}

static void add_text(Document *document, BlockKind kind, const char *format, va_list arguments) {
    char text[DOCUMENT_TEXT_SIZE];
    vsnprintf(text, sizeof text, format, arguments);
    add_block(document, kind, text);
}

void document_paragraph(Document *document, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    add_text(document, BLOCK_PARAGRAPH, format, arguments);
    va_end(arguments);
}

void document_item(Document *document, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    add_text(document, BLOCK_ITEM, format, arguments);
    va_end(arguments);
}

static void keep(Document *document, char **copy, const char *text) {
    *copy = strdup(text);
    if (*copy == NULL) document->failed = true;
}

void document_link(Document *document, const char *text, const char *address) {
    Block *block = add_block(document, BLOCK_LINK, text);
    if (block != NULL) keep(document, &block->address, address);
}

void document_cell(Document *document, const char *format, ...) {
    void *cells = document->cells;
    bool room = array_reserve(&cells, &document->cell_capacity, document->cell_count + 1, sizeof *document->cells);
    document->cells = cells;
    if (!room || document->failed) {
        document->failed = true;
        return;
    }
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(document->cells[document->cell_count++], sizeof *document->cells, format, arguments);
    va_end(arguments);
    Block *table = &document->blocks[document->block_count - 1];
    assert(table->kind == BLOCK_TABLE);
    table->cells++;
}

void document_table(Document *document, const char *caption, const char *columns) {
    Block *block = add_block(document, BLOCK_TABLE, caption);
    if (block == NULL) return;
    block->first_cell = (int)document->cell_count;
    for (const char *name = columns; name != NULL && !document->failed; block->columns++) {
        if (*name == '>') block->numbers |= 1u << block->columns, name++;
        int length = (int)strcspn(name, "|");
        document_cell(document, "%.*s", length, name);
        name = name[length] == '|' ? name + length + 1 : NULL;
    }
}

void document_name(Document *document, const char *text) { document_cell(document, "%s", csv_show(text).text); }

void document_number(Document *document, double value) { document_cell(document, "%s", show_number(value).text); }

void document_percent(Document *document, double share) { document_cell(document, "%s", show_percent(share).text); }

void document_figure(Document *document, const DocumentFigure *figure) {
    Block *block = add_block(document, BLOCK_FIGURE, figure->caption);
    if (block == NULL) return;
    keep(document, &block->address, figure->path);
    keep(document, &block->alt, figure->alt);
    block->number = ++document->figures;
    block->width = figure->width;
    block->height = figure->height;
    block->png = figure->png;
    block->png_size = figure->png_size;
}

Shown show_number(double value) {
    Shown shown;
    double size = fabs(value);
    if (!isfinite(value))
        strcpy(shown.text, "–");
    else if (size >= 1000 && size < 1e7)
        snprintf(shown.text, sizeof shown.text, "%.0f", value);
    else
        snprintf(shown.text, sizeof shown.text, "%.3g", value);
    return shown;
}

Shown show_percent(double share) {
    Shown shown;
    if (!isfinite(share))
        strcpy(shown.text, "–");
    else
        snprintf(shown.text, sizeof shown.text, "%.1f%%", 100 * share);
    return shown;
}

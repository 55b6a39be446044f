/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A document in Markdown. A block takes one line, so a text can begin nothing within it. */
#include "paper/report/document_write.h"

#include <ctype.h>
#include <string.h>

static bool is_letter(char c) { return isalnum((unsigned char)c) || (unsigned char)c >= 0x80; }

/* An underscore within a word is only an underscore; a tilde pair would strike through. */
static void put(FILE *file, const char *text) {
    for (const char *c = text; *c != '\0'; c++) {
        bool in_word = c > text && is_letter(c[-1]) && is_letter(c[1]);
        if (*c == '<' || *c == '>' || *c == '&')
            fputs(*c == '<' ? "&lt;" : *c == '>' ? "&gt;" : "&amp;", file);
        else if (*c == '\n')
            fputc(' ', file);
        else if (strchr("\\`*[]|~$", *c) != NULL || (*c == '_' && !in_word))
            fprintf(file, "\\%c", *c);
        else
            fputc(*c, file);
    }
}

static void put_rule(const Block *table, FILE *file) {
    for (int i = 0; i < table->columns; i++) fputs(table->numbers >> i & 1 ? "|---:" : "|---", file);
    fputs("|\n", file);
}

static void put_table(const Document *document, const Block *table, FILE *file) {
    fputs("**", file);
    put(file, table->text);
    fputs("**\n\n", file);
    for (int i = 0; i < table->cells; i++) {
        fputs("| ", file);
        put(file, document->cells[table->first_cell + i]);
        fputc(' ', file);
        bool row_ends = (i + 1) % table->columns == 0;
        if (row_ends) fputs("|\n", file);
        if (i + 1 == table->columns) put_rule(table, file);
    }
}

static void put_figure(const Block *figure, FILE *file) {
    fputs("![", file);
    put(file, figure->alt);
    fprintf(file, "](%s)\n\n**Figure %d.** ", figure->address, figure->number);
    put(file, figure->text);
    fputc('\n', file);
}

static void put_block(const Document *document, const Block *block, FILE *file) {
    switch (block->kind) {
    case BLOCK_HEADING: fprintf(file, "%.*s ", block->level, "######"); break;
    case BLOCK_ITEM: fputs("- ", file); break;
    case BLOCK_TABLE: put_table(document, block, file); return;
    case BLOCK_FIGURE: put_figure(block, file); return;
    case BLOCK_LINK:
    case BLOCK_PARAGRAPH: break;
    }
    put(file, block->text);
    if (block->kind == BLOCK_LINK) fprintf(file, " <%s>", block->address);
    fputc('\n', file);
}

void document_write_markdown(const Document *document, FILE *file) {
    for (size_t i = 0; i < document->block_count; i++) {
        const Block *block = &document->blocks[i];
        bool list_goes_on = i > 0 && block->kind == BLOCK_ITEM && block[-1].kind == BLOCK_ITEM;
        if (i > 0 && !list_goes_on) fputc('\n', file);
        put_block(document, block, file);
    }
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A document in HTML5, for phones, screens and paper. */
#include "paper/report/document_write.h"

#include "common/base64.h"
#include "common/html_text.h"

static const char style[] =
    "body{margin:0;background:#fff;color:#1a1a1a;font:16px/1.5 system-ui,-apple-system,\"Segoe UI\",sans-serif}\n"
    "main{max-width:54rem;margin:0 auto;padding:1rem}\n"
    "h1,h2,h3{line-height:1.25}h1{font-size:1.7rem}h2{margin-top:2.5rem;border-bottom:1px solid #ccc}\n"
    "a{color:#0b57a4}nav ol{padding-left:1.5rem}\n"
    ".table{overflow-x:auto;margin:1rem 0}\n"
    "table{border-collapse:collapse;font-size:.875rem;font-variant-numeric:tabular-nums}\n"
    "caption{text-align:left;font-weight:600;padding:.25rem 0}\n"
    "th,td{padding:.25rem .6rem;border-bottom:1px solid #ddd;text-align:left;vertical-align:top}\n"
    "th{border-bottom:2px solid #888}td{white-space:nowrap}\n"
    ".n{text-align:right}\n"
    "figure{margin:1.5rem 0}figcaption{font-size:.9rem;color:#444}\n"
    "img{display:block;width:100%;height:auto}\n"
    "@media print{@page{margin:15mm}body{font-size:10pt}main{max-width:none;padding:0}.table{overflow:visible}\n"
    "table{font-size:7.5pt}td{white-space:normal}th,td{padding:.1rem .3rem}tr,figure{break-inside:avoid}\n"
    "thead{display:table-header-group}h2,h3,caption{break-after:avoid}}\n";

static void put_within(FILE *file, const char *tag, const char *text) {
    fprintf(file, "<%s>", tag);
    html_put(file, text);
    fprintf(file, "</%s>\n", tag);
}

static void put_table(const Document *document, const Block *table, FILE *file) {
    /* A table too wide for the page is scrolled; with a tabindex also by keyboard. */
    fputs("<div class=\"table\" tabindex=\"0\"><table>", file);
    put_within(file, "caption", table->text);
    fputs("<thead>\n", file);
    for (int i = 0; i < table->cells; i++) {
        int column = i % table->columns;
        const char *tag = i < table->columns ? "th" : "td";
        if (i == table->columns) fputs("</thead><tbody>\n", file);
        if (column == 0) fputs("<tr>", file);
        fprintf(file, "<%s%s>", tag, table->numbers >> column & 1 ? " class=\"n\"" : "");
        html_put(file, document->cells[table->first_cell + i]);
        fprintf(file, "</%s>", tag);
        if (column + 1 == table->columns) fputs("</tr>\n", file);
    }
    fputs(table->cells > table->columns ? "</tbody></table></div>\n" : "</thead></table></div>\n", file);
}

static void put_figure(const Block *figure, FILE *file) {
    /* Never larger than its pixels: it would only blur. */
    fprintf(file, "<figure><img width=\"%d\" height=\"%d\" style=\"max-width:%dpx\" alt=\"", figure->width,
            figure->height, figure->width);
    html_put(file, figure->alt);
    fputs("\" src=\"data:image/png;base64,", file);
    base64_put(file, figure->png, figure->png_size);
    fprintf(file, "\">\n<figcaption><b>Figure %d.</b> ", figure->number);
    html_put(file, figure->text);
    fputs("</figcaption></figure>\n", file);
}

static void put_link(const Block *link, FILE *file) {
    fputs("<p>", file);
    html_put(file, link->text);
    fputs(" <a href=\"", file);
    html_put(file, link->address);
    fputs("\">", file);
    html_put(file, link->address);
    fputs("</a></p>\n", file);
}

/* Headings are numbered by their place among the blocks. */
static void put_block(const Document *document, size_t place, FILE *file) {
    const Block *block = &document->blocks[place];
    switch (block->kind) {
    case BLOCK_HEADING:
        fprintf(file, "<h%d id=\"part-%zu\">", block->level, place);
        html_put(file, block->text);
        fprintf(file, "</h%d>\n", block->level);
        break;
    case BLOCK_PARAGRAPH: put_within(file, "p", block->text); break;
    case BLOCK_ITEM: put_within(file, "li", block->text); break;
    case BLOCK_LINK: put_link(block, file); break;
    case BLOCK_TABLE: put_table(document, block, file); break;
    case BLOCK_FIGURE: put_figure(block, file); break;
    }
}

static bool is_item(const Document *document, size_t place) {
    return place < document->block_count && document->blocks[place].kind == BLOCK_ITEM;
}

static void put_contents(const Document *document, FILE *file) {
    fputs("<nav aria-label=\"Contents\"><ol>\n", file);
    for (size_t i = 0; i < document->block_count; i++) {
        const Block *block = &document->blocks[i];
        if (block->kind != BLOCK_HEADING || block->level != 2) continue;
        fprintf(file, "<li><a href=\"#part-%zu\">", i);
        html_put(file, block->text);
        fputs("</a></li>\n", file);
    }
    fputs("</ol></nav>\n", file);
}

void document_write_html(const Document *document, FILE *file) {
    fputs("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
          "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n",
          file);
    put_within(file, "title", document->block_count > 0 ? document->blocks[0].text : "");
    fprintf(file, "<style>\n%s</style>\n</head>\n<body>\n<main>\n", style);
    bool contents = false;
    for (size_t i = 0; i < document->block_count; i++) {
        const Block *block = &document->blocks[i];
        /* Contents stand before the first part. */
        if (!contents && block->kind == BLOCK_HEADING && block->level == 2) {
            put_contents(document, file);
            contents = true;
        }
        if (is_item(document, i) && (i == 0 || !is_item(document, i - 1))) fputs("<ul>\n", file);
        put_block(document, i, file);
        if (is_item(document, i) && !is_item(document, i + 1)) fputs("</ul>\n", file);
    }
    fputs("</main>\n</body>\n</html>\n", file);
}

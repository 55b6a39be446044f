/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Memory for cmark-gfm, which aborts the program where malloc() fails. */
#include "base/base.h"
#include "base/file.h"
#include "paper/paper_report.h"
#include "paper/report_internal.h"
#include "pictures/page.h"
#include "pixels/png.h"
#include "studies/study_page.h"

#include <cmark-gfm-core-extensions.h>
#include <cmark-gfm-extension_api.h>
#include <cmark-gfm.h>
#include <limits.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

typedef struct Block {
    struct Block *next;
    size_t size;
    max_align_t data[];
} Block;

/* cmark-gfm's allocator has no context argument. */
static struct {
    jmp_buf full;
    Block *blocks;
    bool begun; /* the extensions, which stay, are registered */
    bool done;
} memory;

static void *paper_report_take(size_t size) {
    Block *block = size < SIZE_MAX - sizeof *block ? calloc(1, sizeof *block + size) : NULL;
    if (block == NULL) longjmp(memory.full, 1);
    block->size = size;
    block->next = memory.blocks;
    memory.blocks = block;
    return block->data;
}

static void *take_zeros(size_t count, size_t size) {
    return paper_report_take(size > 0 && count > SIZE_MAX / size ? SIZE_MAX : count * size);
}

static void *take_more(void *old, size_t size) {
    void *data = paper_report_take(size);
    if (old == NULL) return data;
    const Block *block = (const Block *)((const char *)old - offsetof(Block, data));
    memcpy(data, old, block->size < size ? block->size : size);
    return data;
}

static void paper_report_keep(void *data) { (void)data; }

static void free_blocks(void) {
    for (Block *block = memory.blocks, *next; block != NULL; block = next) {
        next = block->next;
        free(block);
    }
    memory.blocks = NULL;
}

/* Calls `work`, which may use cmark-gfm's extensions. cmark-gfm's blocks are freed afterwards, as a whole: neither it
   nor `work` frees any. When memory is short, longjmp leaves both: `work` must hold nothing else while it calls
   cmark-gfm. False with error set then; else what `work` returns. Not thread-safe. */
static bool markdown_memory_run(bool (*work)(void *context), void *context, Error *error) {
    cmark_mem *standard = cmark_get_default_mem_allocator();
    const cmark_mem before = *standard;
    *standard = (cmark_mem){take_zeros, take_more, paper_report_keep};
    memory.begun = memory.done = false;
    if (setjmp(memory.full) == 0) {
        cmark_gfm_core_extensions_ensure_registered();
        memory.blocks = NULL;
        memory.begun = true;
        memory.done = work(context);
    } else {
        error_memory(error, "report");
    }
    *standard = before;
    if (memory.begun) free_blocks();
    return memory.done;
}

/* cmark-gfm, the reference implementation of GitHub's Markdown, makes the HTML of each block; what surrounds the blocks
   is written here. */

enum { MAX_PICTURE_SIZE = 1 << 24 };

typedef struct Writing {
    const HtmlPage *page;
    cmark_llist *extensions;
    FILE *out;
    Error *error;
} Writing;

static void write_block(const Writing *writing, cmark_node *block) {
    char *html = cmark_render_html(block, CMARK_OPT_TABLE_PREFER_STYLE_ATTRIBUTES, writing->extensions);
    fputs(html, writing->out);
}

/* Without marks. */
static void write_text(const Writing *writing, cmark_node *node) {
    char *text = cmark_render_plaintext(node, CMARK_OPT_DEFAULT, 0);
    text[strcspn(text, "\n")] = '\0';
    html_put(writing->out, text);
}

static bool is_heading(cmark_node *node, int level) {
    return cmark_node_get_type(node) == CMARK_NODE_HEADING && cmark_node_get_heading_level(node) == level;
}

/* Headings of level 2 have their number as their address. */
static void write_contents(const Writing *writing, cmark_node *document) {
    int part = 0;
    fputs("<nav aria-label=\"Contents\">\n<ol>\n", writing->out);
    for (cmark_node *node = cmark_node_first_child(document); node != NULL; node = cmark_node_next(node)) {
        if (!is_heading(node, 2)) continue;
        fprintf(writing->out, "<li><a href=\"#part-%d\">", ++part);
        write_text(writing, node);
        fputs("</a></li>\n", writing->out);
    }
    fputs("</ol>\n</nav>\n", writing->out);
}

/* A table too wide for the page is scrolled; with a tabindex also by keyboard. heading: what the table is about. */
static void write_table(const Writing *writing, cmark_node *table, cmark_node *heading) {
    fputs("<div class=\"table\" role=\"region\" tabindex=\"0\" aria-label=\"", writing->out);
    if (heading != NULL) write_text(writing, heading);
    fputs("\">\n", writing->out);
    write_block(writing, table);
    fputs("</div>\n", writing->out);
}

/* NULL where the block is not a paragraph that is only an image. */
static cmark_node *image_of(cmark_node *block) {
    if (cmark_node_get_type(block) != CMARK_NODE_PARAGRAPH) return NULL;
    cmark_node *image = cmark_node_first_child(block);
    return cmark_node_get_type(image) == CMARK_NODE_IMAGE && cmark_node_next(image) == NULL ? image : NULL;
}

/* At most two pixels of the picture for each of the page, so that it is sharp on all screens. */
static bool write_picture(const Writing *writing, cmark_node *node, const char *path) {
    size_t size;
    const char *words = cmark_node_get_literal(cmark_node_first_child(node));
    char *png = file_read(path, MAX_PICTURE_SIZE, &size, writing->error);
    Image *image = png != NULL ? image_read_png(path, writing->error) : NULL;
    if (image != NULL) {
        fprintf(writing->out, "<img width=\"%d\" height=\"%d\" style=\"max-width:%dpx\" alt=\"", image->width,
                image->height, (image->width + 1) / 2);
        html_put(writing->out, words);
        fputs("\" src=\"data:image/png;base64,", writing->out);
        base64_put(writing->out, png, size);
        fputs("\">\n", writing->out);
    }
    image_destroy(image);
    free(png);
    return image != NULL;
}

static bool write_figure(const Writing *writing, cmark_node *image, cmark_node *caption) {
    char path[PATH_MAX];
    if (!file_path(path, sizeof path, writing->error, "%s/%s", writing->page->folder, cmark_node_get_url(image)))
        return false;
    fputs("<figure>", writing->out);
    if (!write_picture(writing, image, path)) return false;
    fputs("<figcaption>", writing->out);
    if (caption != NULL) write_block(writing, caption);
    fputs("</figcaption></figure>\n", writing->out);
    return true;
}

static bool write_blocks(const Writing *writing, cmark_node *document) {
    cmark_node *heading = NULL;
    int part = 0;
    for (cmark_node *node = cmark_node_first_child(document); node != NULL; node = cmark_node_next(node)) {
        if (cmark_node_get_type(node) == CMARK_NODE_HEADING) heading = node;
        if (is_heading(node, 2)) {
            if (part++ == 0) write_contents(writing, document);
            fprintf(writing->out, "<div id=\"part-%d\">", part);
            write_block(writing, node);
            fputs("</div>\n", writing->out);
        } else if (image_of(node) != NULL) {
            cmark_node *image = image_of(node);
            node = cmark_node_next(node);
            if (!write_figure(writing, image, node)) return false;
        } else if (strcmp(cmark_node_get_type_string(node), "table") == 0) {
            write_table(writing, node, heading);
        } else {
            write_block(writing, node);
        }
    }
    return true;
}

static bool write_page(const Writing *writing, cmark_node *document) {
    fputs("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
          "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>",
          writing->out);
    write_text(writing, cmark_node_first_child(document));
    fprintf(writing->out, "</title>\n<style>\n%s</style>\n</head>\n<body>\n<main>\n", writing->page->style);
    bool written = write_blocks(writing, document);
    fputs("</main>\n</body>\n</html>\n", writing->out);
    return written;
}

static bool html_page_write_markdown(void *context) {
    Writing *writing = context;
    const char *markdown = writing->page->markdown;
    cmark_parser *parser = cmark_parser_new(CMARK_OPT_DEFAULT);
    cmark_parser_attach_syntax_extension(parser, cmark_find_syntax_extension("table"));
    cmark_parser_feed(parser, markdown, strlen(markdown));
    writing->extensions = cmark_parser_get_syntax_extensions(parser);
    return write_page(writing, cmark_parser_finish(parser));
}

bool html_page_write(const HtmlPage *page, FILE *out, Error *error) {
    Writing writing = {page, NULL, out, error};
    return markdown_memory_run(html_page_write_markdown, &writing, error);
}

static bool fill_markdown(void *folder, FILE *out, Error *error) {
    return template_fill((const char *)paper_report_md_in, folder, "findings/summary.csv", out, error);
}

static bool fill_html(void *page, FILE *out, Error *error) { return html_page_write(page, out, error); }

static bool paper_report_store(const char *text, size_t size, const char *folder, const char *name, Error *error) {
    char path[PATH_MAX];
    return file_path(path, sizeof path, error, "%s/%s", folder, name) && file_write(path, text, size, error);
}

bool paper_report_write(const char *folder, Error *error) {
    size_t size = 0, html_size = 0;
    if (!findings_write(folder, error)) return false;
    char *markdown = text_print(fill_markdown, (void *)folder, &size, "report", error);
    HtmlPage page = {markdown, (const char *)paper_report_css, folder};
    char *html = markdown != NULL ? text_print(fill_html, &page, &html_size, "report", error) : NULL;
    const bool written = html != NULL && paper_report_store(markdown, size, folder, "report.md", error) &&
                         paper_report_store(html, html_size, folder, "report.html", error);
    free(markdown);
    free(html);
    return written;
}

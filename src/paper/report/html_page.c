/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cmark-gfm, the reference implementation of GitHub's Markdown, makes the HTML of each block; what surrounds the blocks
   is written here. */
#include "paper/report/html_page.h"

#include "common/base64.h"
#include "common/file.h"
#include "common/html_text.h"
#include "image/image.h"
#include "paper/report/markdown_memory.h"

#include <cmark-gfm-extension_api.h>
#include <cmark-gfm.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

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

static bool write_markdown(void *context) {
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
    return markdown_memory_run(write_markdown, &writing, error);
}

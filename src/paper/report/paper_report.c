/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "paper/report/paper_report.h"

#include "common/file.h"
#include "common/memory_stream.h"
#include "paper/findings/findings.h"
#include "paper/report/html_page.h"
#include "paper/report/report_files.h"
#include "paper/report/template.h"

#include <limits.h>
#include <stdlib.h>

/* A file that is written into memory first. */
typedef struct Text {
    FILE *out;
    char *data;
    size_t size;
} Text;

static bool text_begin(Text *text, Error *error) {
    text->out = memory_stream(&text->data, &text->size);
    return text->out != NULL || error_memory(error, "report");
}

static bool text_end(Text *text, Error *error) {
    const bool whole = !ferror(text->out);
    return (fclose(text->out) == 0 && whole) || error_memory(error, "report");
}

static bool write_markdown(Text *markdown, const char *folder, Error *error) {
    if (!text_begin(markdown, error)) return false;
    const bool filled =
        template_fill((const char *)paper_report_md_in, folder, "findings/summary.csv", markdown->out, error);
    return text_end(markdown, error) && filled;
}

static bool write_html(const Text *markdown, Text *html, const char *folder, Error *error) {
    if (!text_begin(html, error)) return false;
    const HtmlPage page = {markdown->data, (const char *)paper_report_css, folder};
    const bool written = html_page_write(&page, html->out, error);
    return text_end(html, error) && written;
}

static bool store(const Text *text, const char *folder, const char *name, Error *error) {
    char path[PATH_MAX];
    return file_path(path, sizeof path, error, "%s/%s", folder, name) &&
           file_write(path, text->data, text->size, error);
}

bool paper_report_write(const char *folder, Error *error) {
    Text markdown = {NULL, NULL, 0}, html = {NULL, NULL, 0};
    const bool written = findings_write(folder, error) && write_markdown(&markdown, folder, error) &&
                         write_html(&markdown, &html, folder, error) && store(&markdown, folder, "report.md", error) &&
                         store(&html, folder, "report.html", error);
    free(markdown.data);
    free(html.data);
    return written;
}

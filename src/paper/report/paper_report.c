/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "paper/report/paper_report.h"

#include "common/file.h"
#include "paper/report/document_write.h"
#include "paper/report/paper_parts.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool is_quick(const PaperFiles *files) {
    for (int i = 0; i < files->study_count; i++)
        if (strcmp(files->study[i].key, "quick") == 0) return strcmp(files->study[i].value, "on") == 0;
    return false;
}

static void put_title(Document *document, const PaperFiles *files) {
    document_heading(document, 1, "Can neural networks enhance physics simulations? The paper, reproduced");
    document_link(
        document,
        "Avatavului, Ifrim, Voncilă (2023) trained small networks on pairs of colliding boxes of a physics engine and "
        "put them in the place of its solver. This report repeats what they did, in every reading that their text "
        "allows, and sets beside each figure what always saying the mean would score. The paper:",
        "https://doi.org/10.18662/brain/14.2/445");
    if (is_quick(files))
        document_paragraph(document,
                           "This was a quick run, with few launches and iterations: a trial of the study, whose "
                           "figures stand for nothing.");
}

static void put_all(Document *document, const PaperFiles *files) {
    PaperFindings findings = {0};
    put_title(document, files);
    paper_put_summary(document, files);
    paper_put_readings(document, files);
    paper_put_table1(document, files);
    paper_put_factors(document, files);
    paper_put_rates(document, files);
    paper_put_closed_loop(document, files);
    paper_put_contact_net(document, files);
    paper_put_laws(document, files, &findings);
    paper_put_transfer(document, files, &findings);
    paper_put_aims(document, files);
    paper_put_claims(document, files, &findings);
    paper_put_study(document, files);
}

typedef struct Language {
    const char *name;
    void (*write)(const Document *document, FILE *file);
    char *data;
    size_t size;
} Language;

static bool print(Language *language, const Document *document, Error *error) {
    FILE *file = open_memstream(&language->data, &language->size);
    if (file == NULL) return error_memory(error, language->name);
    language->write(document, file);
    bool whole = !ferror(file);
    return (fclose(file) == 0 && whole) || error_memory(error, language->name);
}

static bool put_file(const Language *language, const char *folder, Error *error) {
    char path[PAPER_PATH_SIZE];
    if (!file_path(path, sizeof path, error, "%s/%s", folder, language->name)) return false;
    return file_write(path, language->data, language->size, error);
}

static bool write_document(const Document *document, const char *folder, Error *error) {
    Language markdown = {"report.md", document_write_markdown, NULL, 0};
    Language html = {"report.html", document_write_html, NULL, 0};
    bool written = document_complete(document, folder, error) && print(&markdown, document, error) &&
                   print(&html, document, error) && put_file(&markdown, folder, error) &&
                   put_file(&html, folder, error);
    free(markdown.data);
    free(html.data);
    return written;
}

bool paper_report_write(const char *folder, Error *error) {
    PaperFiles files;
    if (!paper_files_read(&files, folder, error)) return false;
    Document document = {.failed = false};
    put_all(&document, &files);
    bool written = write_document(&document, folder, error);
    document_free(&document);
    paper_files_free(&files);
    return written;
}
